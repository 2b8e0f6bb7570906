//! T7: one wireframe, four joint configurations, four shapes; and how joints are found.

use std::f64::consts::TAU;

use mesh_kernel::glam::DVec3;
use template::{Garment, Reference, RegenerateOptions, Template, regenerate};

use super::model;

/// Five wings about an upright edge of two spans (`a`, `b`, `c`), curved outward by different amounts.
fn wings(surfaces: &str, rest: &str) -> Garment {
    let mut nodes: Vec<String> = Vec::new();
    for (name, y) in [("a", 100.0), ("b", 0.0), ("c", -100.0)] {
        nodes.push(format!(r#""{name}": {{ "at": "origin", "axes": [0, {y}, 0] }}"#));
        for k in 1..=5 {
            let angle = TAU * (f64::from(k) + 0.15 * f64::from(k * k)) / 7.0;
            let r = 120.0 + 25.0 * f64::from(k) - 0.2 * f64::abs(y);
            let (x, z) = (r * angle.cos(), r * angle.sin());
            nodes.push(format!(r#""{name}{k}": {{ "at": "origin", "axes": [{x}, {y}, {z}] }}"#));
        }
    }
    let text = format!(
        r#"{{ "toile_template": 1, "name": "wings", "level": 3, "nodes": {{ {} }}, "surfaces": {{ {surfaces} }},
            "lines": {{ "spine": {{ "through": ["a", "b", "c"] }} }} {rest} }}"#,
        nodes.join(", ")
    );
    let (mesh, features) = model::nothing();
    let reference = Reference { mesh: &mesh, features: &features };
    let template = Template::from_json(&text).unwrap();
    let garment = regenerate(&template, &reference, &RegenerateOptions::default()).unwrap();
    assert!(garment.body.check().is_empty());
    assert!(garment.body.counts().identity_holds());
    garment
}

fn wing(name: &str, k: u32) -> String {
    format!(r#""{name}": {{ "rows": [["a", "a{k}"], ["b", "b{k}"], ["c", "c{k}"]] }}"#)
}

fn pair(name: &str, k: u32, l: u32) -> String {
    format!(
        r#""{name}": {{ "rows": [["a{k}", "a", "a{l}"], ["b{k}", "b", "b{l}"], ["c{k}", "c", "c{l}"]] }}"#
    )
}

/// Where the middle of wing `k`'s upper cell came to lie: the garment's node nearest to the flat middle.
fn shape(garment: &Garment) -> Vec<DVec3> {
    let mesh = garment.body.to_tri_mesh();
    (1..=5)
        .map(|k| {
            let angle = TAU * (f64::from(k) + 0.15 * f64::from(k * k)) / 7.0;
            let r = 0.5 * (110.0 + 25.0 * f64::from(k));
            let middle = DVec3::new(r * angle.cos(), 50.0, r * angle.sin());
            let near = |p: &&DVec3, q: &&DVec3| p.distance(middle).total_cmp(&q.distance(middle));
            *mesh.positions.iter().min_by(near).unwrap()
        })
        .collect()
}

#[test]
fn four_configurations_give_four_shapes() {
    let five: Vec<String> = (1..=5).map(|k| wing(&format!("m{k}"), k)).collect();
    let one = wings(&five.join(", "), "");
    assert_eq!(one.seams.len(), 1);
    assert_eq!(one.seams[0].sides.len(), 5);

    let two = wings(&[pair("m2", 2, 5), wing("m1", 1), wing("m3", 3), wing("m4", 4)].join(", "), "");
    assert_eq!((two.seams.len(), two.seams[0].sides.len()), (1, 4));

    let three = wings(&[pair("m2", 2, 5), pair("m3", 3, 1), wing("m4", 4)].join(", "), "");
    assert_eq!((three.seams.len(), three.seams[0].sides.len()), (1, 3));

    let split = r#", "joints": [
        { "name": "first", "surfaces": ["m1", "m2", "m3"], "nodes": ["a", "b", "c"] },
        { "name": "second", "surfaces": ["m4", "m5"], "nodes": ["a", "b", "c"] }],
        "fair_across": [["m4", "m5"]]"#;
    let four = wings(&five.join(", "), split);
    assert_eq!(four.seams.len(), 2);

    let shapes = [&one, &two, &three, &four].map(shape);
    for i in 0..4 {
        for j in 0..i {
            let apart = shapes[i].iter().zip(&shapes[j]).map(|(p, q)| p.distance(*q)).fold(0.0, f64::max);
            assert!(apart > 0.05, "configurations {j} and {i} differ by {apart} mm only");
        }
    }
}

#[test]
fn a_tube_opened_along_a_line_is_sewn_to_itself() {
    let ring = |row: &str, y: f64, out: &mut Vec<String>| {
        for k in 0..6 {
            let (s, c) = (TAU * f64::from(k) / 6.0).sin_cos();
            out.push(format!(
                r#""{row}{k}": {{ "at": "origin", "axes": [{}, {y}, {}] }}"#,
                50.0 * s,
                50.0 * c
            ));
        }
    };
    let mut nodes = Vec::new();
    ring("a", 100.0, &mut nodes);
    ring("b", 0.0, &mut nodes);
    let row = |r: &str| (0..7).map(|k| format!(r#""{r}{}""#, k % 6)).collect::<Vec<_>>().join(", ");
    let text = format!(
        r#"{{ "toile_template": 1, "name": "sleeve", "level": 2, "nodes": {{ {} }},
        "surfaces": {{ "sleeve": {{ "rows": [[{}], [{}]], "open_along": ["seam"] }} }},
        "lines": {{ "seam": {{ "through": ["a0", "b0"] }} }} }}"#,
        nodes.join(", "),
        row("a"),
        row("b")
    );
    let (mesh, features) = model::nothing();
    let reference = Reference { mesh: &mesh, features: &features };
    let template = Template::from_json(&text).unwrap();
    let garment = regenerate(&template, &reference, &RegenerateOptions::default()).unwrap();
    assert!(garment.body.check().is_empty());
    assert_eq!(garment.seams.len(), 1);
    let seam = &garment.seams[0];
    assert_eq!(seam.sides.len(), 2);
    assert_eq!(seam.sides[0].surface, seam.sides[1].surface);
    assert_ne!(seam.sides[0].nodes, seam.sides[1].nodes);
    assert_eq!(garment.lines[0].chains.len(), 2, "one chain on each side of the slit");
    // Opened, it is a disk: one boundary loop.
    assert_eq!(garment.body.surface(garment.surfaces[0].id).loops().len(), 1);
}
