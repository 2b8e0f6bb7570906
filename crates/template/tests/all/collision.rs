//! T6 on a ball, a ring and an ellipsoid: nothing inside, nothing crossing, the clearance kept, no spikes.

use std::sync::atomic::AtomicBool;

use mesh_kernel::glam::DVec3;
use mesh_kernel::query::SignedDistance;
use template::{
    Garment, Method, Reference, RegenerateOptions, Template, TemplateError, WarmStart, regenerate,
};

use super::model;

/// A flat cloth of 3 × 3 nodes that cuts through whatever lies about the origin at this height.
fn cloth(half: f64, height: f64) -> Template {
    let mut nodes = Vec::new();
    for i in 0..3 {
        for j in 0..3 {
            let (x, z) = (half * (i as f64 - 1.0), half * (j as f64 - 1.0));
            nodes.push(format!(r#""n{i}{j}": {{ "at": "origin", "axes": [{x}, {height}, {z}] }}"#));
        }
    }
    let row = |i: usize| format!(r#"["n{i}0", "n{i}1", "n{i}2"]"#);
    let text = format!(
        r#"{{ "toile_template": 1, "name": "cloth", "level": 4, "clearance": 5, "nodes": {{ {} }},
            "surfaces": {{ "cloth": {{ "rows": [{}, {}, {}] }} }} }}"#,
        nodes.join(", "),
        row(0),
        row(1),
        row(2)
    );
    Template::from_json(&text).unwrap()
}

fn assert_clear(garment: &Garment, clearance: f64) {
    let c = &garment.collision;
    assert_eq!((c.nodes_inside, c.faces_crossing), (0, 0), "{c:?} {:?}", garment.warnings);
    assert!(c.min_distance > clearance - 0.3, "{c:?}");
    assert!(garment.body.check().is_empty());
}

/// Largest turn between neighbouring faces, radians: a spike or a dent turns sharply.
fn sharpest_fold(garment: &Garment) -> f64 {
    let mut worst: f64 = 0.0;
    for (_, s) in garment.body.surfaces() {
        let normal = |f: u32| {
            let [a, b, c] = s.faces()[f as usize].map(|v| s.positions()[v as usize]);
            (b - a).cross(c - a)
        };
        for [l, r] in s.edge_faces() {
            if *l != u32::MAX && *r != u32::MAX {
                worst = worst.max(normal(*l).angle_between(normal(*r)));
            }
        }
    }
    worst
}

#[test]
fn a_cloth_through_a_ball_is_draped_over_it() {
    let (mesh, features) = model::ball();
    let reference = Reference { mesh: &mesh, features: &features };
    // It cuts the ball 40 mm below its top.
    let garment = regenerate(&cloth(260.0, 160.0), &reference, &RegenerateOptions::default()).unwrap();
    assert_clear(&garment, 5.0);
    // The exact distance, by the ball's formula (its mesh lies up to 0.3 mm within).
    for (_, s) in garment.body.surfaces() {
        for p in s.positions() {
            assert!((*p - 1000.0 * DVec3::Y).length() > 204.0, "{p}");
        }
    }
    assert!(garment.collision.largest_push > 30.0);
    assert!(sharpest_fold(&garment) < 0.5, "{}", sharpest_fold(&garment));
}

#[test]
fn a_cloth_through_a_ring_lies_on_both_its_sides() {
    let (mesh, features) = model::ring();
    let reference = Reference { mesh: &mesh, features: &features };
    let garment = regenerate(&cloth(330.0, 40.0), &reference, &RegenerateOptions::default()).unwrap();
    assert_clear(&garment, 5.0);
    assert!(sharpest_fold(&garment) < 0.6, "{}", sharpest_fold(&garment));
}

/// A skirt whose nodes begin 15 mm inside the trunk.
pub(crate) fn skirt(offset: f64, ease: f64) -> Template {
    let node = |name: &str, curve: &str, side: &str, extra: &str| {
        format!(
            r#""{name}": {{ "at": ["{curve}", "{side}"], "normal": {offset}, "ease": "{curve}"{extra} }}"#
        )
    };
    let text = format!(
        r#"{{ "toile_template": 1, "name": "skirt", "mirrored": true, "level": 3, "clearance": 3,
        "nodes": {{ {}, {}, {}, {}, {}, {},
            "front_hem": {{ "at": ["hip", "centre_front"], "centre": true, "normal": 40, "level": {{ "from": "hip", "to": "floor", "t": 0.4 }} }},
            "left_hem": {{ "at": ["hip", "left_side"], "normal": 40, "level": {{ "from": "hip", "to": "floor", "t": 0.4 }} }},
            "back_hem": {{ "at": ["hip", "centre_back"], "centre": true, "normal": 40, "level": {{ "from": "hip", "to": "floor", "t": 0.4 }} }} }},
        "surfaces": {{
            "front": {{ "across_centre": true, "rows": [["front_waist", "left_waist"], ["front_hip", "left_hip"], ["front_hem", "left_hem"]] }},
            "left_back": {{ "rows": [["left_waist", "back_waist"], ["left_hip", "back_hip"], ["left_hem", "back_hem"]] }} }},
        "lines": {{
            "waist_edge": {{ "through": ["front_waist", "left_waist", "back_waist"], "across_centre": true, "closed": true }},
            "hem": {{ "through": ["front_hem", "left_hem", "back_hem"], "across_centre": true, "closed": true }} }},
        "fair_across": [["front", "left_back", "right_back"]],
        "ease": {{ "waist": {{ "ease": {ease} }}, "hip": {{ "ease": {ease} }} }},
        "pieces": {{ "left_back": {{ "label": "Back", "edges": {{ "hem": 30 }} }} }} }}"#,
        node("front_waist", "waist", "centre_front", r#", "centre": true"#),
        node("left_waist", "waist", "left_side", ""),
        node("back_waist", "waist", "centre_back", r#", "centre": true"#),
        node("front_hip", "hip", "centre_front", r#", "centre": true"#),
        node("left_hip", "hip", "left_side", ""),
        node("back_hip", "hip", "centre_back", r#", "centre": true"#),
    );
    Template::from_json(&text).unwrap()
}

#[test]
fn a_skirt_gets_out_of_the_body_and_its_ease() {
    let (mesh, features) = model::trunk();
    let reference = Reference { mesh: &mesh, features: &features };
    for (offset, ease) in [(-15.0, 60.0), (25.0, 60.0), (10.0, 120.0)] {
        let garment = regenerate(&skirt(offset, ease), &reference, &RegenerateOptions::default()).unwrap();
        assert_clear(&garment, 3.0);
        for (name, got) in &garment.ease {
            assert!((got - ease).abs() < 5.0, "{name} from {offset}: {got} instead of {ease}");
        }
        // The hem is level.
        let hem = garment.lines.iter().find(|l| l.name == "hem").unwrap();
        assert!(hem.points.iter().all(|p| (p.y - 0.6 * 850.0).abs() < 1.0), "{:?}", hem.points[0]);
        assert_eq!(hem.points.first(), hem.points.last());
        assert!(sharpest_fold(&garment) < 0.5, "{}", sharpest_fold(&garment));
    }
}

#[test]
fn an_impossible_ease_is_reported() {
    let (mesh, features) = model::trunk();
    let reference = Reference { mesh: &mesh, features: &features };
    let garment = regenerate(&skirt(10.0, -80.0), &reference, &RegenerateOptions::default()).unwrap();
    assert_clear(&garment, 3.0);
    assert!(garment.warnings.iter().any(|w| w.contains("the body needs the room")), "{:?}", garment.warnings);
}

#[test]
fn all_methods_build_and_cancel_stops() {
    let (mesh, features) = model::trunk();
    let reference = Reference { mesh: &mesh, features: &features };
    for method in [Method::Plate, Method::Umbrella { steps: 30 }, Method::UmbrellaLimit] {
        let options = RegenerateOptions { method, ..RegenerateOptions::default() };
        assert_clear(&regenerate(&skirt(15.0, 60.0), &reference, &options).unwrap(), 3.0);
    }
    let stop = AtomicBool::new(true);
    let options = RegenerateOptions { cancel: Some(&stop), ..RegenerateOptions::default() };
    let cancelled = regenerate(&skirt(15.0, 60.0), &reference, &options);
    assert_eq!(cancelled.err(), Some(TemplateError::Cancelled));
}

/// The largest distance of two garments' nodes, which must be as many.
fn apart(a: &Garment, b: &Garment) -> f64 {
    let (a, b) = (a.body.to_tri_mesh(), b.body.to_tri_mesh());
    assert_eq!(a.faces, b.faces);
    a.positions.iter().zip(&b.positions).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max)
}

#[test]
fn previews_that_begin_warm_are_those_that_begin_cold() {
    let (mesh, features) = model::trunk();
    let reference = Reference { mesh: &mesh, features: &features };
    let warm = WarmStart::default();
    let body = SignedDistance::new(&mesh);
    let previewed = |template: &Template, levels: u8, warm: Option<&WarmStart>| {
        let options =
            RegenerateOptions { levels: Some(levels), preview: true, warm, ..RegenerateOptions::default() };
        regenerate(template, &reference, &options).unwrap()
    };
    // Small steps as of a hand, a jump, other faces, and back.
    for (offset, ease, levels) in [
        (10.0, 60.0, 2),
        (10.0, 61.0, 2),
        (14.0, 61.0, 2),
        (14.0, 120.0, 2),
        (14.0, 120.0, 3),
        (-15.0, 60.0, 2),
    ] {
        let template = skirt(offset, ease);
        let (first, next) = (previewed(&template, levels, None), previewed(&template, levels, Some(&warm)));
        for garment in [&first, &next] {
            assert!(garment.ease.values().all(|got| (got - ease).abs() < 3.5), "{:?}", garment.ease);
            let nodes = garment.body.to_tri_mesh().positions;
            let nearest = nodes.iter().map(|p| body.signed(*p).distance).fold(f64::INFINITY, f64::min);
            assert!(nearest > 3.0 - 1.0, "{offset} {ease} {levels}: {nearest} from the skin");
        }
        // The eases may differ by their tolerance, 6 mm round a body: a millimetre outward.
        assert!(apart(&first, &next) < 2.0, "{offset} {ease} {levels}: {}", apart(&first, &next));
    }
    // A whole garment is the same whatever was previewed before.
    let template = skirt(10.0, 60.0);
    let whole = |warm| {
        let options = RegenerateOptions { warm, ..RegenerateOptions::default() };
        regenerate(&template, &reference, &options).unwrap()
    };
    assert_eq!(apart(&whole(None), &whole(Some(&warm))), 0.0);
}
