//! Everything that a picture can show, on shapes made here: `showcase OUT_DIR`.
//!
//! Writes `garment.png` (two-sided cloth over a form, seams, hidden lines, labels), `data.png` (numbers as colours, a
//! legend), `pattern.png` (a flat drawing) and `montage.png`.

use std::error::Error;
use std::f64::consts::{PI, TAU};
use std::path::Path;

use glam::{DVec2, DVec3};
use viewer::{
    Align, Camera, Color, ColorBar, ColorMap, Drawing2d, Hidden, Item2d, KeySign, Label, Legend, LegendKey,
    Length, Lens, MontageOptions, PageOptions, Paint, Pen, RenderOptions, Reverse, Scale, Scene, SceneLine,
    SceneMesh, ScenePoint, View, cloth_color, montage, render,
};

/// Radius of the form (mm) at a height (mm): hip, waist, bust, neck.
fn radius(y: f64) -> f64 {
    110.0 + 22.0 * (y / 700.0 * TAU - 0.6).cos() - 70.0 * ((y - 600.0) / 100.0).clamp(0.0, 1.0).powi(2)
}

/// A ring at a height, opened by `part` of the way round, `out` millimetres off the form.
fn place(angle: f64, y: f64, out: f64) -> DVec3 {
    let r = radius(y) + out;
    DVec3::new(1.25 * r * angle.sin(), y, 0.85 * r * angle.cos())
}

/// A patch over angles and heights with nodes on a grid.
fn patch(angles: [f64; 2], heights: [f64; 2], out: f64, color: Color) -> SceneMesh {
    let (columns, rows) = (48u32, 48u32);
    let mut positions = Vec::new();
    for j in 0..=rows {
        for i in 0..=columns {
            let a = angles[0] + (angles[1] - angles[0]) * f64::from(i) / f64::from(columns);
            let y = heights[0] + (heights[1] - heights[0]) * f64::from(j) / f64::from(rows);
            positions.push(place(a, y, out + 0.06 * (300.0 - y).max(0.0) * (1.0 + 0.25 * (9.0 * a).cos())));
        }
    }
    let mut faces = Vec::new();
    for j in 0..rows {
        for i in 0..columns {
            let a = j * (columns + 1) + i;
            let [b, c, d] = [a + 1, a + columns + 2, a + columns + 1];
            faces.extend([[a, b, c], [a, c, d]]);
        }
    }
    SceneMesh::new(positions, faces, color)
}

fn ring(y: f64, out: f64) -> Vec<DVec3> {
    (0..=180).map(|i| place(f64::from(i) / 180.0 * TAU, y, out)).collect()
}

fn main() -> Result<(), Box<dyn Error>> {
    let out = std::env::args().nth(1).ok_or("showcase OUT_DIR")?;
    let out = Path::new(&out);
    let form = SceneMesh { reverse: Reverse::Same, ..patch([0.0, TAU], [0.0, 700.0], 0.0, Color::SKIN) };
    let mut garment =
        Scene { meshes: vec![form.clone()], title: Some("Panels over a form".into()), ..Scene::default() };
    for i in 0..5 {
        let (from, to) = (f64::from(i) * TAU / 6.0, f64::from(i + 1) * TAU / 6.0);
        garment.meshes.push(patch([from, to], [60.0, 520.0], 6.0, cloth_color(i as usize)));
        garment.lines.push(SceneLine::new(
            (0..=60).map(|k| place(from, 300.0 + f64::from(k) / 60.0 * 220.0, 6.0)).collect(),
            Color::SEAM,
            1.6,
        ));
    }
    garment
        .lines
        .push(SceneLine { hidden: Hidden::Dashed, ..SceneLine::new(ring(360.0, 6.0), Color::ACCENT, 1.8) });
    for (name, angle, y) in
        [("bust", 0.6, 480.0), ("waist", 0.0, 360.0), ("side", PI / 2.0, 420.0), ("nape", PI, 620.0)]
    {
        let position = place(angle, y, 6.0);
        garment.points.push(ScenePoint {
            position,
            color: Color::ACCENT,
            diameter: 8.0,
            hidden: Hidden::Faint,
        });
        garment.labels.push(Label { position, text: name.into(), color: Color::INK, hidden: Hidden::Faint });
    }
    garment.legend = Some(Legend {
        bar: None,
        keys: vec![
            LegendKey { text: "seam".into(), color: Color::SEAM, sign: KeySign::Line },
            LegendKey { text: "waist, 36.0 cm".into(), color: Color::ACCENT, sign: KeySign::DashedLine },
            LegendKey { text: "panel".into(), color: cloth_color(0), sign: KeySign::Patch },
        ],
    });
    let options = RenderOptions { floor: true, ..RenderOptions::sized(1024, 768) };
    let camera = Camera::new(View::Iso, Lens::PORTRAIT).fit(&garment, &options)?;
    let first = render(&garment, &camera, &options)?;
    std::fs::write(out.join("garment.png"), first.to_png())?;

    let mut data = Scene { title: Some("Stretch".into()), ..Scene::default() };
    let values: Vec<f64> =
        form.positions.iter().map(|p| 2.5 * (p.x / 60.0).sin() * (p.y / 120.0).cos()).collect();
    let scale = Scale::of(ColorMap::Diverging, &values);
    data.meshes.push(form.painted(Paint::NodeValues { values, scale }));
    data.legend = Some(Legend {
        bar: Some(ColorBar { title: "stretch".into(), unit: "%".into(), scale }),
        keys: vec![LegendKey { text: "no value".into(), color: Color::NO_VALUE, sign: KeySign::Patch }],
    });
    let camera = Camera::new(View::Front, Lens::Orthographic).fit(&data, &options)?;
    let second = render(&data, &camera, &options)?;
    std::fs::write(out.join("data.png"), second.to_png())?;

    let third = pattern().render(&PageOptions { width: 1024, height: 768, ..PageOptions::default() })?;
    std::fs::write(out.join("pattern.png"), third.to_png())?;
    let whole =
        montage(&[("garment", &first), ("data", &second), ("pattern", &third)], &MontageOptions::default())?;
    std::fs::write(out.join("montage.png"), whole.to_png())?;
    Ok(())
}

/// A piece with allowance, notch, grain line, name, a hole and a table of colours.
fn pattern() -> Drawing2d {
    let curve = |r: f64| -> Vec<DVec2> {
        (0..=90)
            .map(|i| f64::from(i) / 90.0 * TAU)
            .map(|a| DVec2::new(1.4 * r * a.cos(), r * (a.sin() + 0.25 * (2.0 * a).cos())))
            .collect()
    };
    let hole: Vec<DVec2> =
        (0..24).map(|i| DVec2::from_angle(f64::from(i) / 24.0 * TAU) * 18.0 + 60.0).collect();
    let mut items = vec![
        Item2d::Polygon { rings: vec![curve(160.0), hole], fill: cloth_color(1), opacity: 0.45 },
        Item2d::Polyline { points: curve(170.0), pen: Pen::pixels(Color::INK, 1.6) },
        Item2d::Polyline {
            points: curve(160.0),
            pen: Pen::pixels(Color::SEAM, 1.0).dashed(Length::Pixels(7.0), Length::Pixels(4.0)),
        },
        Item2d::Polyline {
            points: vec![DVec2::new(0.0, -90.0), DVec2::new(0.0, 90.0)],
            pen: Pen::millimetres(Color::ACCENT, 1.0),
        },
        Item2d::Circle { centre: DVec2::new(-90.0, 30.0), radius: 3.0, pen: None, fill: Color::INK },
        Item2d::Circle {
            centre: DVec2::new(-90.0, 30.0),
            radius: 9.0,
            pen: Some(Pen::pixels(Color::INK, 1.2)),
            fill: Color::INK,
        },
    ];
    for (words, y, size, angle) in [
        ("SIDE FRONT", -20.0, 16.0, 0.0),
        ("cut 2 · 10 mm", -42.0, 10.0, 0.0),
        ("grain", 0.0, 10.0, PI / 2.0),
    ] {
        items.push(Item2d::Text {
            at: DVec2::new(if angle == 0.0 { 90.0 } else { -6.0 }, y),
            text: words.into(),
            size: Length::Millimetres(size),
            angle,
            align: Align::Middle,
            color: Color::INK,
        });
    }
    for (row, map) in [ColorMap::Sequential, ColorMap::Diverging, ColorMap::Ramp].into_iter().enumerate() {
        for i in 0..64 {
            let lo = DVec2::new(-240.0 + f64::from(i) * 7.5, -250.0 - 22.0 * row as f64);
            let ring =
                vec![lo, lo + DVec2::new(7.6, 0.0), lo + DVec2::new(7.6, 18.0), lo + DVec2::new(0.0, 18.0)];
            items.push(Item2d::Polygon {
                rings: vec![ring],
                fill: map.at(f64::from(i) / 63.0),
                opacity: 1.0,
            });
        }
    }
    for i in 0..16 {
        let centre = DVec2::new(-225.0 + 30.0 * i as f64, -330.0);
        items.push(Item2d::Circle { centre, radius: 12.0, pen: None, fill: cloth_color(i) });
    }
    Drawing2d { items }
}
