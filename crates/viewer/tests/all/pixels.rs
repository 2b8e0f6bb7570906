//! What single pixels of pictures must show.

use glam::DVec3;
use viewer::{
    Camera, Color, ColorBar, ColorMap, Hidden, Image, KeySign, Label, Legend, LegendKey, Lens, Paint,
    RenderOptions, Reverse, Scale, Scene, SceneLine, SceneMesh, ScenePoint, Shading, View, render,
};

const RED: Color = Color([210, 40, 40]);
const BLUE: Color = Color([40, 60, 210]);

/// A square of side 100 mm about the origin in the plane z = `z`, facing +z.
fn square(z: f64, color: Color) -> SceneMesh {
    let corners = [(-50.0, -50.0), (50.0, -50.0), (50.0, 50.0), (-50.0, 50.0)];
    SceneMesh::new(corners.map(|(x, y)| DVec3::new(x, y, z)).to_vec(), vec![[0, 1, 2], [0, 2, 3]], color)
}

fn scene(meshes: Vec<SceneMesh>) -> Scene {
    Scene { meshes, ..Scene::default() }
}

/// A front view of 100 x 100 pixels that shows ±100 mm: pixel (x, y) sees (2 x - 99, 99 - 2 y).
fn front(scene: &Scene, lens: Lens) -> Image {
    let options = RenderOptions::sized(100, 100).plain();
    let camera = Camera { height: 200.0, ..Camera::new(View::Front, lens) };
    render(scene, &camera, &options).unwrap()
}

fn at(image: &Image, x: u32, y: u32) -> [i32; 3] {
    image.pixel(x, y).unwrap().0.map(i32::from)
}

fn is_reddish(c: [i32; 3]) -> bool {
    c[0] > 2 * c[1] && c[0] > 2 * c[2]
}

fn is_bluish(c: [i32; 3]) -> bool {
    c[2] > 2 * c[1] && c[2] > 2 * c[0]
}

#[test]
fn a_triangle_covers_its_pixels_and_no_others() {
    let triangle = SceneMesh::new(
        vec![DVec3::new(-50.0, -50.0, 0.0), DVec3::new(50.0, -50.0, 0.0), DVec3::new(-50.0, 50.0, 0.0)],
        vec![[0, 1, 2]],
        RED,
    );
    for lens in [Lens::Orthographic, Lens::PORTRAIT] {
        let image = front(&scene(vec![triangle.clone()]), lens);
        let mut covered = 0.0;
        for y in 0..100u32 {
            for x in 0..100u32 {
                let (px, py) = (2.0 * f64::from(x) - 99.0, 99.0 - 2.0 * f64::from(y));
                // Distance to the nearest side, positive inside, in millimetres.
                let inside = (px + 50.0).min(py + 50.0).min(-(px + py) / 2f64.sqrt());
                let color = at(&image, x, y);
                if inside > 2.9 {
                    assert!(is_reddish(color), "{x} {y} {color:?}");
                } else if inside < -2.9 {
                    assert_eq!(color, Color::PAPER.0.map(i32::from), "{x} {y}");
                }
                covered += f64::from(i32::from(Color::PAPER.0[2]) - color[2]);
            }
        }
        let full = f64::from(i32::from(Color::PAPER.0[2]) - at(&image, 30, 65)[2]);
        // 5000 mm² are 1250 pixels; partly covered pixels are encoded, which weighs them a little less.
        assert!((covered / full / 1250.0 - 1.0).abs() < 0.03, "{}", covered / full);
    }
}

#[test]
fn nearer_faces_hide_farther_ones_in_any_order() {
    for lens in [Lens::Orthographic, Lens::PORTRAIT] {
        let (near, far) = (square(10.0, RED), square(-10.0, BLUE));
        for meshes in [vec![near.clone(), far.clone()], vec![far, near]] {
            let image = front(&scene(meshes), lens);
            assert!(is_reddish(at(&image, 50, 50)));
        }
    }
}

#[test]
fn crossing_faces_are_told_apart_by_pixel() {
    let mut tilted = square(0.0, BLUE);
    for p in &mut tilted.positions {
        p.z = 0.5 * p.x;
    }
    let image = front(&scene(vec![square(0.0, RED), tilted]), Lens::Orthographic);
    assert!(is_reddish(at(&image, 40, 50)), "{:?}", at(&image, 40, 50));
    assert!(is_bluish(at(&image, 60, 50)), "{:?}", at(&image, 60, 50));
}

#[test]
fn a_fine_mesh_has_no_cracks() {
    // Neighbouring faces share sides at odd slopes; every inner pixel must be wholly covered.
    let n = 37u32;
    let mut positions = Vec::new();
    for j in 0..=n {
        for i in 0..=n {
            let (x, y) = (f64::from(i) / f64::from(n), f64::from(j) / f64::from(n));
            let wiggle = 0.3 / f64::from(n) * (f64::from(i * 7 + j * 13)).sin();
            let inner = i > 0 && j > 0 && i < n && j < n;
            let w = if inner { wiggle } else { 0.0 };
            positions.push(DVec3::new(-80.0 + 160.0 * (x + w), -80.0 + 160.0 * (y - w), 0.0));
        }
    }
    let mut faces = Vec::new();
    for j in 0..n {
        for i in 0..n {
            let a = j * (n + 1) + i;
            faces.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
    }
    let mut mesh = SceneMesh::new(positions, faces, RED);
    mesh.shading = Shading::Flat;
    let image = front(&scene(vec![mesh]), Lens::Orthographic);
    let colour = at(&image, 50, 50);
    for y in 12..88 {
        for x in 12..88 {
            assert_eq!(at(&image, x, y), colour, "{x} {y}");
        }
    }
}

#[test]
fn the_reverse_is_darker_or_as_asked() {
    let mut turned = square(0.0, RED);
    turned.faces = vec![[0, 2, 1], [0, 3, 2]];
    let brightness = |reverse| {
        let mesh = SceneMesh { reverse, ..turned.clone() };
        at(&front(&scene(vec![mesh]), Lens::Orthographic), 50, 50)
    };
    let outside = at(&front(&scene(vec![square(0.0, RED)]), Lens::Orthographic), 50, 50);
    assert_eq!(brightness(Reverse::Same), outside);
    let inside = brightness(Reverse::Darker);
    assert!(is_reddish(inside) && inside[0] * 10 < outside[0] * 9, "{inside:?} {outside:?}");
    assert!(is_bluish(brightness(Reverse::Colored(BLUE))));
}

#[test]
fn numbers_take_their_colours() {
    let scale = Scale::new(ColorMap::Diverging, -1.0, 1.0);
    let by_nodes = square(0.0, RED).painted(Paint::NodeValues { values: vec![-1.0, 1.0, 1.0, -1.0], scale });
    let image = front(&scene(vec![by_nodes]), Lens::Orthographic);
    let (left, middle, right) = (at(&image, 27, 50), at(&image, 50, 50), at(&image, 72, 50));
    assert!(left[2] > left[0] + 60 && right[0] > right[2] + 60, "{left:?} {right:?}");
    let spread = middle.iter().max().unwrap() - middle.iter().min().unwrap();
    assert!(spread < 25, "{middle:?}");

    let by_faces = square(0.0, RED).painted(Paint::FaceValues { values: vec![1.0, f64::NAN], scale });
    let image = front(&scene(vec![by_faces]), Lens::Orthographic);
    let (value, missing) = (at(&image, 65, 60), at(&image, 35, 40));
    assert!(value[0] > value[2] + 60, "{value:?}");
    assert!((missing[0] - missing[2]).abs() < 6, "{missing:?}");
}

#[test]
fn lines_lie_over_their_surface_and_are_hidden_behind_others() {
    let line = |z: f64, hidden| SceneLine {
        hidden,
        ..SceneLine::new(vec![DVec3::new(-80.0, 0.0, z), DVec3::new(80.0, 0.0, z)], Color([0, 120, 0]), 6.0)
    };
    let dark_green = |c: [i32; 3]| c[1] > c[0] + 60 && c[1] > c[2] + 60;
    let picture =
        |line| front(&Scene { lines: vec![line], ..scene(vec![square(0.0, RED)]) }, Lens::Orthographic);
    // On the surface: visible all along.
    let image = picture(line(0.0, Hidden::Omitted));
    assert!((12..88).all(|x| dark_green(at(&image, x, 50)) || dark_green(at(&image, x, 49))));
    // Behind it: only where it sticks out.
    let image = picture(line(-20.0, Hidden::Omitted));
    assert!(dark_green(at(&image, 15, 49)) && dark_green(at(&image, 85, 49)));
    assert!((29..71).all(|x| is_reddish(at(&image, x, 49)) && is_reddish(at(&image, x, 50))));
    // Faint: a trace; dashed: gaps; shown: as in front.
    let image = picture(line(-20.0, Hidden::Faint));
    let trace = at(&image, 50, 49);
    assert!(trace != at(&image, 50, 35) && !dark_green(trace), "{trace:?}");
    let image = picture(SceneLine { width: 2.0, ..line(-20.0, Hidden::Dashed) });
    let plain = at(&image, 50, 35);
    let marked = (27..73).filter(|x| (at(&image, *x, 49)[0] - plain[0]).abs() > 12).count();
    assert!((8..40).contains(&marked), "{marked}");
    let image = picture(line(-20.0, Hidden::Shown));
    assert!((27..73).all(|x| dark_green(at(&image, x, 49)) || dark_green(at(&image, x, 50))));
}

#[test]
fn points_and_labels_show_at_their_places() {
    let position = DVec3::new(20.0, 20.0, 0.0);
    let mut with_point = scene(vec![square(0.0, RED)]);
    with_point.points.push(ScenePoint { position, color: BLUE, diameter: 20.0, hidden: Hidden::Omitted });
    assert!(is_bluish(at(&front(&with_point, Lens::Orthographic), 59, 39)));
    with_point.points[0].position.z = -30.0;
    assert!(is_reddish(at(&front(&with_point, Lens::Orthographic), 59, 39)));

    let mut with_label = scene(vec![square(0.0, RED)]);
    let label = |y: f64| Label {
        position: DVec3::new(-20.0, y, 0.0),
        text: "waist".into(),
        color: Color::INK,
        hidden: Hidden::Shown,
    };
    with_label.labels.push(label(0.0));
    let (without, one) =
        (front(&scene(vec![square(0.0, RED)]), Lens::Orthographic), front(&with_label, Lens::Orthographic));
    let changed =
        |a: &Image, b: &Image| a.rgb().chunks(3).zip(b.rgb().chunks(3)).filter(|(p, q)| p != q).count();
    assert!(changed(&without, &one) > 60);
    // A second label at the same place gets out of the first one's way.
    with_label.labels.push(label(0.0));
    let two = front(&with_label, Lens::Orthographic);
    assert!(changed(&without, &two) > changed(&without, &one) + 50);
}

#[test]
fn legend_and_title_are_drawn_and_get_room() {
    let scale = Scale::new(ColorMap::Sequential, 0.0, 4.0);
    let mut with_legend = scene(vec![square(0.0, RED)]);
    with_legend.title = Some("Stretch".into());
    with_legend.legend = Some(Legend {
        bar: Some(ColorBar { title: "stretch".into(), unit: "%".into(), scale }),
        keys: vec![LegendKey { text: "seam".into(), color: BLUE, sign: KeySign::Patch }],
    });
    let options = RenderOptions::sized(400, 300).plain();
    let camera = Camera::new(View::Front, Lens::Orthographic).fit(&with_legend, &options).unwrap();
    let image = render(&with_legend, &camera, &options).unwrap();
    let whole =
        |image: &Image, of: &dyn Fn([i32; 3]) -> bool, x: std::ops::Range<u32>, y: std::ops::Range<u32>| {
            y.flat_map(|y| x.clone().map(move |x| (x, y))).filter(|(x, y)| of(at(image, *x, *y))).count()
        };
    let dark = |c: [i32; 3]| c.iter().sum::<i32>() < 330;
    assert!(whole(&image, &dark, 0..150, 0..30) > 30, "title");
    assert!(whole(&image, &dark, 300..400, 40..260) > 60, "legend's text");
    let has = |color: Color| (0..300).any(|y| (300..400).any(|x| at(&image, x, y) == color.0.map(i32::from)));
    assert!(has(BLUE), "key");
    let close = |a: [i32; 3], b: Color| (0..3).all(|k| (a[k] - i32::from(b.0[k])).abs() <= 4);
    for t in [0.02, 0.5, 0.98] {
        assert!(
            (0..300).any(|y| (300..400).any(|x| close(at(&image, x, y), ColorMap::Sequential.at(t)))),
            "bar at {t}"
        );
    }
    // The square keeps clear of the legend.
    assert_eq!(whole(&image, &is_reddish, 310..400, 0..300), 0);
    assert!(whole(&image, &is_reddish, 0..310, 0..300) > 10_000);
}

#[test]
fn soft_shadows_darken_corners_only() {
    // A floor and a wall behind it: darker towards their meeting, open far from it.
    let floor = SceneMesh::new(
        vec![
            DVec3::new(-50.0, 0.0, 0.0),
            DVec3::new(-50.0, 0.0, 100.0),
            DVec3::new(50.0, 0.0, 100.0),
            DVec3::new(50.0, 0.0, 0.0),
        ],
        vec![[0, 1, 2], [0, 2, 3]],
        RED,
    );
    let mut wall = square(0.0, RED);
    wall.positions.iter_mut().for_each(|p| p.y += 50.0);
    let corner = scene(vec![floor, wall]);
    let options = RenderOptions::sized(200, 200);
    let camera = Camera::toward(DVec3::new(0.0, 1.0, 1.0), DVec3::Y, Lens::Orthographic).unwrap();
    let camera = camera.fit(&corner, &options).unwrap();
    let soft = render(&corner, &camera, &options).unwrap();
    let plain = render(&corner, &camera, &options.clone().plain()).unwrap();
    // The picture's middle row sees the corner; near the top and bottom it is open.
    let loss = |y: u32| at(&plain, 100, y)[0] - at(&soft, 100, y)[0];
    assert!(loss(99) > 18 && loss(101) > 18, "{} {}", loss(99), loss(101));
    assert!(loss(12) < 10 && loss(187) < 12, "{} {}", loss(12), loss(187));
}
