//! Dress forms measured by other code than the one that builds them.

use mesh_kernel::TriMesh;
use reference::dress_form::{DressForm, FormOptions, Measurements, Preset, presets};

/// Length of the convex hull of the section at height `y`, by the extreme points in 720 directions.
fn tape(mesh: &TriMesh, y: f64) -> f64 {
    let mut points: Vec<(f64, f64)> = Vec::new();
    for f in 0..mesh.faces.len() as u32 {
        let c = mesh.corners(f);
        for i in 0..3 {
            let (a, b) = (c[i], c[(i + 1) % 3]);
            if (a.y - y) * (b.y - y) < 0.0 || a.y == y {
                let t = if a.y == y { 0.0 } else { (y - a.y) / (b.y - a.y) };
                points.push((a.x + t * (b.x - a.x), a.z + t * (b.z - a.z)));
            }
        }
    }
    let turns = 720;
    let mut corners: Vec<(f64, f64)> = Vec::new();
    for k in 0..turns {
        let (s, c) = (std::f64::consts::TAU * f64::from(k) / f64::from(turns)).sin_cos();
        let far = points.iter().copied().max_by(|a, b| (a.0 * c + a.1 * s).total_cmp(&(b.0 * c + b.1 * s)));
        corners.extend(far);
    }
    corners.dedup();
    (0..corners.len()).map(|i| {
        let (a, b) = (corners[i], corners[(i + 1) % corners.len()]);
        (b.0 - a.0).hypot(b.1 - a.1)
    }).sum()
}

fn build(m: &Measurements) -> DressForm {
    DressForm::build(m, &FormOptions::default()).unwrap()
}

fn extreme(mesh: &TriMesh, low: f64, high: f64, largest: bool) -> f64 {
    let mut best = if largest { 0.0 } else { f64::MAX };
    let mut y = low;
    while y <= high {
        let girth = tape(mesh, y);
        if girth > best && largest || girth < best && !largest {
            best = girth;
        }
        y += 5.0;
    }
    best
}

fn check_girths(name: &str, form: &DressForm) {
    let (m, l, mesh) = (&form.measurements, &form.levels, &form.mesh);
    for (what, y, asked) in [
        ("bust", l.bust, m.bust),
        ("underbust", l.underbust, m.underbust),
        ("waist", l.waist, m.waist),
        ("high hip", l.high_hip, m.high_hip),
        ("hip", l.hip, m.hip),
    ] {
        let got = tape(mesh, y);
        assert!((got - 10.0 * asked).abs() < 0.4, "{name}: {what} {got} instead of {}", 10.0 * asked);
    }
    let hip = extreme(mesh, l.crotch + 2.0, l.waist, true);
    assert!(m.waist > m.hip || (hip - 10.0 * m.hip).abs() < 1.0, "{name}: fullest hip {hip}, asked {}", m.hip * 10.0);
    let bust = extreme(mesh, l.underbust, l.armpit - 0.016 * l.stature, true);
    assert!((bust - 10.0 * m.bust).abs() < 1.0, "{name}: fullest bust {bust}, asked {}", m.bust * 10.0);
    if m.waist < m.underbust && m.waist < m.hip {
        let waist = extreme(mesh, l.hip, l.underbust, false);
        assert!((waist - 10.0 * m.waist).abs() < 1.0, "{name}: narrowest {waist}, asked {}", m.waist * 10.0);
    }
    let top = mesh.bounds().unwrap()[1].y;
    assert!((top - l.top).abs() < 0.5, "{name}: top {top} instead of {}", l.top);
    assert!(mesh.bounds().unwrap()[0].y.abs() < 1e-9);
}

#[test]
fn presets_measure_what_they_say() {
    for preset in presets() {
        let form = build(&preset.measurements);
        check_girths(&preset.name, &form);
    }
    assert!(presets().len() > 30);
    assert_eq!(Preset::find("EU 38").unwrap().measurements.bust, Some(88.0));
}
