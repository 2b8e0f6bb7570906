//! What is no upright body is refused with a reason; dress forms are accepted.

use crate::human_common::{features, moved};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DMat3, DVec3};
use reference::dress_form::{DressForm, FormOptions, presets};
use reference::human::{HumanError, HumanOptions, Unit, extract};

/// A closed tube about a chain of `(centre, radii)` rings, `n` nodes a ring.
fn tube(rings: &[(DVec3, f64, f64)], n: u32) -> TriMesh {
    let mut mesh = TriMesh::default();
    for (c, rx, rz) in rings {
        for k in 0..n {
            let a = std::f64::consts::TAU * f64::from(k) / f64::from(n);
            mesh.positions.push(*c + DVec3::new(a.sin() * rx, 0.0, a.cos() * rz));
        }
    }
    let last = rings.len() as u32 - 1;
    for r in 0..last {
        for k in 0..n {
            let (a, b) = (r * n + k, r * n + (k + 1) % n);
            mesh.faces.extend([[a, b, a + n], [b, b + n, a + n]]);
        }
    }
    for (ring, flip) in [(0, true), (last, false)] {
        let centre = mesh.positions.len() as u32;
        mesh.positions.push(rings[ring as usize].0);
        for k in 0..n {
            let (a, b) = (ring * n + k, ring * n + (k + 1) % n);
            mesh.faces.push(if flip { [b, a, centre] } else { [a, b, centre] });
        }
    }
    mesh
}

fn joined(parts: &[TriMesh]) -> TriMesh {
    let mut out = TriMesh::default();
    for p in parts {
        let base = out.positions.len() as u32;
        out.positions.extend(&p.positions);
        out.faces.extend(p.faces.iter().map(|f| f.map(|v| v + base)));
    }
    out
}

fn post(x: f64, z: f64, low: f64, high: f64, radius: f64) -> TriMesh {
    let n = 12;
    let rings: Vec<(DVec3, f64, f64)> = (0..=n)
        .map(|i| (DVec3::new(x, low + (high - low) * f64::from(i) / f64::from(n), z), radius, radius))
        .collect();
    tube(&rings, 16)
}

fn refused(what: &str, mesh: &TriMesh) -> HumanError {
    match extract(mesh, &HumanOptions::default()) {
        Ok(body) => panic!("{what} was taken for a body {:.0} mm high", body.features.height),
        Err(e) => {
            let words = e.to_string();
            assert!(words.len() > 30, "{what}: {words}");
            e
        }
    }
}

fn sphere(radius: f64) -> TriMesh {
    let rings: Vec<(DVec3, f64, f64)> = (1..40)
        .map(|i| {
            let a = std::f64::consts::PI * f64::from(i) / 40.0;
            (DVec3::new(0.0, -radius * a.cos(), 0.0), radius * a.sin(), radius * a.sin())
        })
        .collect();
    tube(&rings, 48)
}

#[test]
fn shapes_that_are_no_bodies_are_refused() {
    assert!(matches!(refused("a sphere", &sphere(0.85)), HumanError::NotUpright { .. }));
    let block = tube(
        &(0..30).map(|i| (DVec3::new(0.0, 0.06 * f64::from(i), 0.0), 0.25, 0.15)).collect::<Vec<_>>(),
        40,
    );
    assert!(matches!(refused("a pillar", &block), HumanError::NotUpright { .. }));
    // Four legs, a seat, a back.
    let mut chair: Vec<TriMesh> = [(-0.2, -0.2), (0.2, -0.2), (-0.2, 0.2), (0.2, 0.2)]
        .iter()
        .map(|(x, z)| post(*x, *z, 0.0, 0.45, 0.02))
        .collect();
    chair
        .push(tube(&[(DVec3::new(0.0, 0.45, 0.0), 0.25, 0.25), (DVec3::new(0.0, 0.5, 0.0), 0.25, 0.25)], 40));
    chair.push(tube(
        &[(DVec3::new(0.0, 0.5, -0.22), 0.22, 0.02), (DVec3::new(0.0, 1.0, -0.22), 0.22, 0.02)],
        40,
    ));
    assert!(matches!(refused("a chair", &joined(&chair)), HumanError::NotUpright { .. }));
    // A palm with five fingers, 18 cm long, in millimetres: as centimetres it would be a man's height.
    let mut hand: Vec<TriMesh> = (0..4)
        .map(|k| post(-30.0 + 20.0 * f64::from(k), 0.0, 95.0, 180.0 - 8.0 * (f64::from(k) - 1.0).abs(), 8.0))
        .collect();
    hand.push(tube(
        &(0..12)
            .map(|i| (DVec3::new(0.0, 9.0 * f64::from(i), 0.0), 28.0 + f64::from(i), 12.0))
            .collect::<Vec<_>>(),
        40,
    ));
    hand.push(post(55.0, 5.0, 40.0, 95.0, 9.0));
    assert!(matches!(refused("a hand", &joined(&hand)), HumanError::NotUpright { .. }));
    // Two posts, a beam, a knob: legs, trunk and head of sorts, but no shoulders and no arms.
    let gate = joined(&[
        post(-0.12, 0.0, 0.0, 0.8, 0.06),
        post(0.12, 0.0, 0.0, 0.8, 0.06),
        tube(
            &(0..20).map(|i| (DVec3::new(0.0, 0.8 + 0.03 * f64::from(i), 0.0), 0.2, 0.1)).collect::<Vec<_>>(),
            40,
        ),
        post(0.0, 0.0, 1.37, 1.6, 0.07),
    ]);
    refused("a gate", &gate);
}

#[test]
fn damaged_meshes_are_refused() {
    assert_eq!(refused("nothing", &TriMesh::default()), HumanError::Empty);
    let ball = sphere(0.8);
    let mut broken = ball.clone();
    broken.positions[17].y = f64::NAN;
    assert_eq!(refused("a gap", &broken), HumanError::NotFinite { node: 17 });
    let mut broken = ball.clone();
    broken.faces[3][1] = 1 << 30;
    assert_eq!(refused("a wild index", &broken), HumanError::BadIndex { face: 3 });
    let flat = moved(&ball, 1.0, DMat3::from_diagonal(DVec3::new(1.0, 1.0, 0.0)), DVec3::ZERO);
    assert!(matches!(refused("a disc", &flat), HumanError::Flat { .. }));
    assert!(matches!(refused("a speck", &sphere(1e-4)), HumanError::Height { .. }));
    assert!(matches!(
        refused(
            "a tetrahedron",
            &TriMesh::new(
                vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z],
                vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]],
            )
        ),
        HumanError::TooCoarse { faces: 4, .. }
    ));
    // Every node in one place.
    let dot = moved(&ball, 0.0, DMat3::IDENTITY, DVec3::ONE);
    refused("a dot", &dot);
}

#[test]
fn dress_forms_are_bodies() {
    let all = presets();
    for preset in all.iter().step_by(all.len().div_ceil(6)) {
        let options = FormOptions { triangles: 12_000, ..FormOptions::default() };
        let form = DressForm::build(&preset.measurements, &options).unwrap();
        let body = features(&form.mesh);
        let wanted = [
            ("bust", form.measurements.bust),
            ("waist", form.measurements.waist),
            ("hip", form.measurements.hip),
        ];
        for (girth, cm) in wanted {
            let off = body.girths[girth] - cm * 10.0;
            // A trunk whose belly is broader than its chest is narrowest above the waist that was asked for.
            let least = if girth == "waist" { -45.0 } else { -9.0 };
            assert!((least..9.0).contains(&off), "{}: {girth} {off:+.1} mm", preset.name);
        }
        assert_eq!(body.unit, Unit::Millimetre);
        assert!(body.placement.direction_to_file(DVec3::Z).z > 0.999, "{} faces away", preset.name);
        for (side, sign) in [("left", 1.0), ("right", -1.0)] {
            for (point, level) in [("armpit", form.levels.armpit), ("shoulder", form.levels.shoulder)] {
                let p = body.features.points[&format!("{side}_{point}")].position;
                assert!((p.y - level).abs() < 15.0, "{}: {side}_{point} {:.0}", preset.name, p.y - level);
                assert!(p.x * sign > 0.0);
            }
            assert!(body.features.curves.contains_key(&format!("{side}_armhole")));
        }
        // Turned onto another axis and into metres.
        let turn = DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y) * DMat3::from_rotation_y(2.0);
        let changed = features(&moved(&form.mesh, 1e-3, turn, DVec3::new(1.0, 2.0, 3.0)));
        for (name, p) in &body.features.points {
            let there = changed.placement.to_file(changed.features.points[name].position);
            let off =
                there.distance(turn * body.placement.to_file(p.position) * 1e-3 + DVec3::new(1.0, 2.0, 3.0));
            assert!(off < 2e-3, "{}: {name} {:.1} mm", preset.name, off * 1e3);
        }
    }
}

/// A dress form whose coordinates are in a unit of so many millimetres.
fn form_in(millimetres: f64) -> TriMesh {
    let options = FormOptions { triangles: 8_000, ..FormOptions::default() };
    let form = DressForm::build(&presets()[0].measurements, &options).unwrap();
    moved(&form.mesh, 1.0 / millimetres, DMat3::IDENTITY, DVec3::ZERO)
}

#[test]
fn inches_are_taken_for_centimetres_with_a_warning_and_read_when_said() {
    let first = features(&form_in(1.0));
    assert!(first.features.warnings.iter().all(|w| !w.contains("inches")), "{:?}", first.features.warnings);
    let inches = form_in(25.4);
    let guessed = features(&inches);
    assert_eq!(guessed.unit, Unit::Centimetre);
    let said = format!("inches ({:.0} mm)", first.features.height);
    assert!(guessed.features.warnings.iter().any(|w| w.contains(&said)), "{:?}", guessed.features.warnings);

    let known =
        extract(&inches, &HumanOptions { unit: Some(Unit::Inch), ..HumanOptions::default() }).unwrap();
    assert!((known.girths["bust"] - first.girths["bust"]).abs() < 0.1);
    assert!(known.features.warnings.iter().all(|w| !w.contains("inches")));
    let p = known.placement.to_file(known.mesh.positions[7]);
    assert!(p.distance(inches.positions[7]) < 1e-9);
}

#[test]
fn other_units_are_refused_for_the_height() {
    // Decimetres, feet: a foot's form is as wide as a person is high in metres, and that is no reason to lay it down.
    for millimetres in [100.0, 304.8] {
        let e = refused("a form in another unit", &form_in(millimetres));
        assert!(matches!(e, HumanError::Height { .. }), "{e}");
    }
    let options = HumanOptions { unit: Some(Unit::Metre), ..HumanOptions::default() };
    let e = extract(&form_in(100.0), &options).unwrap_err();
    assert!(matches!(e, HumanError::HeightInUnit { unit: Unit::Metre, .. }), "{e}");
    assert!(e.to_string().contains("metres high"), "{e}");
}

#[test]
fn a_body_that_lies_where_up_is_known_is_refused() {
    let preset = &presets()[0];
    let options = FormOptions { triangles: 8_000, ..FormOptions::default() };
    let form = DressForm::build(&preset.measurements, &options).unwrap();
    let lying = moved(&form.mesh, 1.0, DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y), DVec3::ZERO);
    let options = HumanOptions { up: Some(DVec3::Y), ..HumanOptions::default() };
    let e = extract(&lying, &options).unwrap_err();
    assert!(matches!(e, HumanError::NotUpright { .. } | HumanError::Height { .. }), "{e}");
    let aslant = moved(&form.mesh, 1.0, DMat3::from_rotation_z(0.9), DVec3::ZERO);
    assert!(extract(&aslant, &HumanOptions::default()).is_err());
}
