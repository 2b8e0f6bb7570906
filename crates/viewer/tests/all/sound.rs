//! Same bytes, clear refusals, no panics.

use glam::{DVec2, DVec3};
use proptest::prelude::*;
use viewer::{
    Align, Camera, Color, ColorMap, Drawing2d, Hidden, Item2d, Label, Length, Lens, MontageOptions,
    PageOptions, Paint, Pen, RenderError, RenderOptions, Scale, Scene, SceneLine, SceneMesh, View, montage,
    render,
};

/// A bumpy ball with lines over it.
fn ball(n: u32) -> Scene {
    let at = |i: u32, j: u32| {
        let (a, b) = (
            f64::from(i) / f64::from(n) * std::f64::consts::TAU,
            f64::from(j) / f64::from(n) * std::f64::consts::PI,
        );
        let r = 100.0 + 8.0 * (5.0 * a).sin() * (4.0 * b).sin();
        DVec3::new(r * b.sin() * a.sin(), r * b.cos(), r * b.sin() * a.cos())
    };
    let positions = (0..=n).flat_map(|j| (0..=n).map(move |i| at(i, j))).collect();
    let mut faces = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i;
            faces.extend([[a, a + n + 1, a + n + 2], [a, a + n + 2, a + 1]]);
        }
    }
    let lines = (0..8)
        .map(|i| SceneLine {
            hidden: Hidden::Dashed,
            ..SceneLine::new((0..=n).map(|j| at(i * n / 8, j)).collect(), Color::INK, 1.5)
        })
        .collect();
    let label = Label {
        position: at(0, n / 2),
        text: "front · 12 cm²".into(),
        color: Color::INK,
        hidden: Hidden::Faint,
    };
    Scene {
        meshes: vec![SceneMesh::new(positions, faces, Color::SKIN)],
        lines,
        labels: vec![label],
        title: Some("Ball".into()),
        ..Scene::default()
    }
}

#[test]
fn one_thread_and_several_give_the_same_bytes() {
    let scene = ball(40);
    let options = RenderOptions { floor: true, ..RenderOptions::sized(240, 180) };
    let picture = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let camera = Camera::new(View::Iso, Lens::PORTRAIT).fit(&scene, &options).unwrap();
            render(&scene, &camera, &options).unwrap().to_png()
        })
    };
    let first = picture(1);
    assert_eq!(first, picture(1));
    assert_eq!(first, picture(2));
    assert_eq!(first, picture(5));
}

#[test]
fn png_reads_back() {
    let scene = ball(12);
    let options = RenderOptions::sized(97, 61).plain();
    let camera = Camera::new(View::Back, Lens::Orthographic).fit(&scene, &options).unwrap();
    let picture = render(&scene, &camera, &options).unwrap();
    let read = image::load_from_memory(&picture.to_png()).unwrap().to_rgb8();
    assert_eq!((read.width(), read.height()), (97, 61));
    assert_eq!(read.as_raw(), picture.rgb());
}

#[test]
fn every_view_fits_the_whole_scene() {
    let scene = Scene { title: None, labels: vec![], ..ball(24) };
    for view in View::ALL {
        for lens in [Lens::Orthographic, Lens::PORTRAIT, Lens::Perspective { fov: 1.4 }] {
            for (width, height) in [(200, 120), (90, 210)] {
                let options = RenderOptions::sized(width, height).plain();
                let camera = Camera::new(view, lens).fit(&scene, &options).unwrap();
                let image = render(&scene, &camera, &options).unwrap();
                let marked = |x: u32, y: u32| image.pixel(x, y) != Some(Color::PAPER);
                let border = (0..width).any(|x| marked(x, 0) || marked(x, height - 1))
                    || (0..height).any(|y| marked(0, y) || marked(width - 1, y));
                assert!(!border, "{view:?} {lens:?} {width} x {height}");
                let wide = (0..width).filter(|x| (0..height).any(|y| marked(*x, y))).count();
                let high = (0..height).filter(|y| (0..width).any(|x| marked(x, *y))).count();
                let filled = (wide as f64 / f64::from(width)).max(high as f64 / f64::from(height));
                assert!(filled > 0.8, "{view:?} {lens:?} {width} x {height}: {filled}");
            }
        }
    }
}

#[test]
fn left_is_the_models_left() {
    // A ball at the model's left (+x).
    let mut scene = ball(16);
    for p in &mut scene.meshes[0].positions {
        *p = *p * 0.3 + DVec3::X * 200.0;
    }
    let middle = |view: View| {
        let scene = Scene { meshes: scene.meshes.clone(), ..Scene::default() };
        let options = RenderOptions::sized(100, 100).plain();
        let camera = Camera { height: 600.0, ..Camera::new(view, Lens::Orthographic) };
        let image = render(&scene, &camera, &options).unwrap();
        let marked = |x: u32| (0..100).any(|y| image.pixel(x, y) != Some(Color::PAPER));
        let columns: Vec<u32> = (0..100).filter(|x| marked(*x)).collect();
        f64::from(columns.iter().sum::<u32>()) / columns.len() as f64
    };
    assert!(middle(View::Front) > 70.0);
    assert!(middle(View::Back) < 30.0);
    assert!((middle(View::Left) - 49.5).abs() < 2.0);
    assert!(middle(View::Top) > 70.0);
}

#[test]
fn impossible_wishes_are_refused_with_a_reason() {
    let good = ball(8);
    let options = RenderOptions::sized(32, 32);
    let camera = Camera::new(View::Front, Lens::Orthographic);
    let refuse = |scene: &Scene, options: &RenderOptions| {
        let fitted = camera.clone().fit(scene, options);
        let drawn = render(scene, &camera, options).unwrap_err();
        assert!(!drawn.to_string().is_empty());
        assert!(fitted.is_err() || matches!(drawn, RenderError::Option { .. }));
        drawn
    };
    for (width, height) in [(0, 10), (10, 0), (20_000, 10), (16_000, 16_000)] {
        assert!(matches!(refuse(&good, &RenderOptions::sized(width, height)), RenderError::Size { .. }));
    }
    assert_eq!(refuse(&Scene::default(), &options), RenderError::Empty);
    let mut faceless = good.clone();
    faceless.meshes[0].faces.clear();
    faceless.lines.clear();
    assert_eq!(refuse(&faceless, &options), RenderError::Empty);
    for bad in [f64::NAN, f64::INFINITY, 1e300] {
        let mut broken = good.clone();
        broken.meshes[0].positions[3].y = bad;
        assert!(matches!(refuse(&broken, &options), RenderError::Coordinate { index: 3, .. }));
        let mut broken = good.clone();
        broken.lines[1].points[2].x = bad;
        assert!(matches!(refuse(&broken, &options), RenderError::Coordinate { index: 2, .. }));
    }
    let mut broken = good.clone();
    broken.meshes[0].faces[5] = [0, 1, 9999];
    assert!(matches!(refuse(&broken, &options), RenderError::Index { face: 5, node: 9999, .. }));
    let mut broken = good.clone();
    broken.meshes[0].paint =
        Paint::FaceValues { values: vec![1.0], scale: Scale::new(ColorMap::Ramp, 0.0, 1.0) };
    assert!(matches!(refuse(&broken, &options), RenderError::PaintCount { got: 1, .. }));
    for options in [
        RenderOptions { samples: 0, ..options.clone() },
        RenderOptions { samples: 65, ..options.clone() },
        RenderOptions { scale: f64::NAN, ..options.clone() },
        RenderOptions { line_bias: Some(f64::NAN), ..options.clone() },
    ] {
        assert!(matches!(refuse(&good, &options), RenderError::Option { .. }));
    }
    assert!(Camera::toward(DVec3::ZERO, DVec3::Y, Lens::Orthographic).is_err());
    assert!(Camera::toward(DVec3::Y, DVec3::Y, Lens::Orthographic).is_err());
    assert!(Camera::new(View::Front, Lens::Perspective { fov: f64::NAN }).fit(&good, &options).is_err());
    assert_eq!(Drawing2d::default().render(&PageOptions::default()).unwrap_err(), RenderError::Empty);
    assert_eq!(montage(&[], &MontageOptions::default()).unwrap_err(), RenderError::Empty);
}

#[test]
fn hard_geometry_is_drawn_without_complaint() {
    let options = RenderOptions { floor: true, ..RenderOptions::sized(64, 48) };
    let draw = |scene: &Scene, lens| {
        let camera = Camera::new(View::Iso, lens).fit(scene, &options).unwrap();
        render(scene, &camera, &options).unwrap()
    };
    // Ten thousand times the same face; faces without area; one point; a flat scene; far from the origin.
    let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
    let same = SceneMesh::new(corners.clone(), vec![[0, 1, 2]; 10_000], Color::SKIN);
    let thin = SceneMesh::new(corners, vec![[0, 0, 1], [0, 1, 1], [2, 2, 2]], Color::SKIN);
    let mut far = ball(8);
    far.meshes[0].positions.iter_mut().for_each(|p| *p += DVec3::splat(1e6));
    far.lines.clear();
    let point =
        Scene { lines: vec![SceneLine::new(vec![DVec3::ONE; 3], Color::INK, 3.0)], ..Scene::default() };
    for scene in [
        Scene { meshes: vec![same], ..Scene::default() },
        Scene { meshes: vec![thin], ..Scene::default() },
        far,
        point,
    ] {
        for lens in [Lens::Orthographic, Lens::PORTRAIT] {
            draw(&scene, lens);
        }
    }
}

#[test]
fn the_eye_may_be_inside_the_model() {
    let scene = ball(16);
    let options = RenderOptions::sized(64, 64).plain();
    let camera = Camera { height: 40.0, ..Camera::new(View::Front, Lens::Perspective { fov: 1.2 }) };
    let image = render(&scene, &camera, &options).unwrap();
    let empty = (0..64)
        .flat_map(|y| (0..64).map(move |x| (x, y)))
        .filter(|(x, y)| image.pixel(*x, *y) == Some(Color::PAPER));
    assert_eq!(empty.count(), 0, "the ball's inside is all around");
}

#[test]
fn drawings_fill_areas_and_leave_holes() {
    let ring = |r: f64| vec![DVec2::new(-r, -r), DVec2::new(r, -r), DVec2::new(r, r), DVec2::new(-r, r)];
    let fill = Color([20, 160, 60]);
    for reversed in [false, true] {
        let mut hole = ring(20.0);
        if reversed {
            hole.reverse();
        }
        let drawing =
            Drawing2d { items: vec![Item2d::Polygon { rings: vec![ring(50.0), hole], fill, opacity: 1.0 }] };
        let page = PageOptions { width: 120, height: 120, margin: 10.0, ..PageOptions::default() };
        let image = drawing.render(&page).unwrap();
        // One millimetre a pixel: the outline ends at pixel 10 and 110, the hole at 40 and 80.
        for (x, y, inside) in [
            (9, 60, false),
            (10, 60, true),
            (39, 60, true),
            (40, 60, false),
            (60, 60, false),
            (80, 60, true),
            (110, 60, false),
            (60, 100, true),
        ] {
            assert_eq!(image.pixel(x, y) == Some(fill), inside, "{x} {y}");
        }
    }
}

#[test]
fn drawings_measure_in_millimetres() {
    let line = |pen| Drawing2d {
        items: vec![
            Item2d::Polyline { points: vec![DVec2::new(0.0, 0.0), DVec2::new(100.0, 0.0)], pen },
            Item2d::Text {
                at: DVec2::new(50.0, 20.0),
                text: "piece".into(),
                size: Length::Millimetres(10.0),
                angle: 0.3,
                align: Align::Middle,
                color: Color::INK,
            },
        ],
    };
    let page = PageOptions {
        width: 220,
        height: 120,
        margin: 10.0,
        window: Some([DVec2::new(0.0, -25.0), DVec2::new(100.0, 25.0)]),
        ..PageOptions::default()
    };
    // Two pixels a millimetre: a line of 3 mm is 6 pixels thick.
    let image = line(Pen::millimetres(Color::INK, 3.0)).render(&page).unwrap();
    let thick = (45..75).filter(|y| image.pixel(110, *y) == Some(Color::INK)).count();
    assert_eq!(thick, 6);
    let image = line(Pen::pixels(Color::INK, 2.0)).render(&page).unwrap();
    let thick = (45..75).filter(|y| image.pixel(110, *y) == Some(Color::INK)).count();
    assert_eq!(thick, 2);
    let pen = Pen::millimetres(Color::INK, 3.0).dashed(Length::Millimetres(10.0), Length::Millimetres(10.0));
    let image = line(pen).render(&page).unwrap();
    let inked = (0..220).filter(|x| image.pixel(*x, 60) == Some(Color::INK)).count();
    assert!((85..125).contains(&inked), "{inked}");
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(40))]

    /// Any triangles from any side: no panic, and something shows where anything has area in the picture.
    #[test]
    fn any_triangles_can_be_drawn(
        corners in prop::collection::vec((-1e3..1e3f64, -1e3..1e3f64, -1e3..1e3f64), 3..40),
        from in (-1.0..1.0f64, -0.9..0.9f64, 0.1..1.0f64),
        fov in 0.01..2.9f64,
        height in 1.0..5e3f64,
    ) {
        let positions: Vec<DVec3> = corners.iter().map(|(x, y, z)| DVec3::new(*x, *y, *z)).collect();
        let faces = (2..positions.len() as u32).map(|i| [i - 2, i - 1, i]).collect();
        let scene = Scene { meshes: vec![SceneMesh::new(positions, faces, Color::SKIN)], ..Scene::default() };
        let options = RenderOptions::sized(48, 40);
        let camera = Camera::toward(DVec3::from(from), DVec3::Y, Lens::Perspective { fov }).unwrap();
        render(&scene, &Camera { height, ..camera.clone() }, &options).unwrap();
        let image = render(&scene, &camera.fit(&scene, &options).unwrap(), &options).unwrap();
        prop_assert!(image.rgb().chunks(3).any(|p| p != Color::PAPER.0));
    }

    /// Scales always give usable ticks.
    #[test]
    fn ticks_lie_in_their_range(low in -1e6..1e6f64, span in 1e-6..1e6f64, wanted in 1..12usize) {
        let scale = Scale::new(ColorMap::Sequential, low, low + span);
        let ticks = scale.ticks(wanted);
        prop_assert!(ticks.len() <= 2 * wanted + 3);
        prop_assert!(ticks.iter().all(|t| *t >= low - 1e-6 * span - 1e-9 && *t <= low + span + 1e-6 * span + 1e-9));
        prop_assert!(ticks.windows(2).all(|p| p[0] < p[1]));
    }
}

#[test]
fn colour_maps_rise_in_lightness_evenly() {
    let lightness = |map: ColorMap, t: f64| map.at(t).to_oklab()[0];
    for i in 0..100 {
        let (t, u) = (f64::from(i) / 100.0, f64::from(i + 1) / 100.0);
        let step = lightness(ColorMap::Sequential, u) - lightness(ColorMap::Sequential, t);
        assert!((step - 0.0062).abs() < 0.0045, "{t}: {step}");
        assert!(lightness(ColorMap::Ramp, u) < lightness(ColorMap::Ramp, t) + 1e-3);
    }
    for i in 0..50 {
        let t = f64::from(i) / 100.0;
        let (a, b) = (lightness(ColorMap::Diverging, t), lightness(ColorMap::Diverging, 1.0 - t));
        assert!((a - b).abs() < 0.02, "both arms alike at {t}");
    }
    assert_eq!(ColorMap::Sequential.at(f64::NAN), Color::NO_VALUE);
}
