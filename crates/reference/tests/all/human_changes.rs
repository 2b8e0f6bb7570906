//! One body in many disguises: turned, tilted onto other axes, in other units, mirrored, noisy, coarse, fine, holed, in
//! other poses. Its features must move with it.

use std::collections::BTreeMap;

use crate::human_common::{Dice, features, mapped, moved, read, shared_bodies};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DMat3, DVec3};
use reference::human::{HumanBody, HumanOptions, Unit, extract};

/// How far features may lie from where the change took those of the first body, millimetres.
struct Bounds {
    point: f64,
    girth: f64,
    degrees: f64,
}

const SAME: Bounds = Bounds { point: 1.0, girth: 0.5, degrees: 0.1 };
const NEAR: Bounds = Bounds { point: 14.0, girth: 9.0, degrees: 1.0 };
const TRUNK_POINTS: [&str; 10] = [
    "left_armpit",
    "right_armpit",
    "crotch",
    "nape",
    "front_neck",
    "left_shoulder",
    "right_shoulder",
    "left_bust",
    "right_bust",
    "navel",
];

/// Compares features in the file's frame; `map` is the change, in file units.
fn compare(
    what: &str,
    first: &HumanBody,
    changed: &HumanBody,
    map: impl Fn(DVec3) -> DVec3,
    bounds: &Bounds,
    points: &[&str],
) -> Vec<String> {
    let mut faults = Vec::new();
    let mm = changed.unit.millimetres();
    for p in points {
        let wanted = map(first.placement.to_file(first.features.points[*p].position));
        let off = changed.placement.to_file(changed.features.points[*p].position).distance(wanted) * mm;
        if off > bounds.point {
            faults.push(format!("{what}: {p} {off:.1} mm off"));
        }
    }
    for girth in ["bust", "waist", "hip", "underbust"] {
        let off = changed.girths[girth] - first.girths[girth];
        let bound = if girth == "underbust" { 2.0 * bounds.girth } else { bounds.girth };
        if off.abs() > bound {
            faults.push(format!("{what}: {girth} {off:+.1} mm"));
        }
    }
    let direction = |d: DVec3| (map(d) - map(DVec3::ZERO)).normalize();
    let wanted = direction(first.placement.direction_to_file(DVec3::Z));
    let off = changed.placement.direction_to_file(DVec3::Z).angle_between(wanted).to_degrees();
    if off > bounds.degrees {
        faults.push(format!("{what}: facing {off:.2} degrees off"));
    }
    faults
}

#[test]
fn features_follow_every_placement() {
    let Some(mesh) = read("female-average") else { return };
    let first = features(&mesh);
    let mut faults = Vec::new();
    let z_up = DMat3::from_cols(DVec3::X, DVec3::Z, -DVec3::Y);
    let x_up = DMat3::from_cols(DVec3::Y, DVec3::X, -DVec3::Z);
    for (degrees, axes, scale, shift) in [
        (17.0_f64, DMat3::IDENTITY, 1.0, DVec3::new(3.0, -2.0, 0.7)),
        (133.0, z_up, 100.0, DVec3::new(0.0, 40.0, 900.0)),
        (-90.0, x_up, 1000.0, DVec3::ZERO),
        (251.0, z_up * DMat3::from_diagonal(DVec3::new(1.0, -1.0, -1.0)), 1000.0, DVec3::splat(77.0)),
        (180.0, DMat3::from_diagonal(DVec3::new(-1.0, -1.0, 1.0)), 1.0, DVec3::ZERO),
    ] {
        let turn = axes * DMat3::from_rotation_y(degrees.to_radians());
        let changed = features(&moved(&mesh, scale, turn, shift));
        let what = format!("turned by {degrees}, scaled by {scale}");
        faults.extend(compare(&what, &first, &changed, |p| turn * p * scale + shift, &SAME, &TRUNK_POINTS));
        let unit = [Unit::Metre, Unit::Centimetre, Unit::Millimetre][scale.log10() as usize * 2 / 3];
        assert_eq!(changed.unit.millimetres() * scale, 1000.0, "{unit:?}");
        // The way back is exact.
        for (p, q) in changed.mesh.positions.iter().zip(&mesh.positions).step_by(997) {
            assert!(changed.placement.to_file(*p).distance(turn * *q * scale + shift) < 1e-9 * scale);
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

#[test]
fn mirrored_bodies_keep_left_on_the_left() {
    let Some(mesh) = read("male-muscular") else { return };
    // One arm is bent away, so that the two sides differ: shorten the left forearm and hand.
    let lame =
        mapped(&mesh, |p| if p.x > 0.33 { DVec3::new(0.33 + (p.x - 0.33) * 0.8, p.y, p.z) } else { p });
    let first = features(&lame);
    let mut mirrored = mapped(&lame, |p| DVec3::new(-p.x, p.y, p.z));
    for f in &mut mirrored.faces {
        f.swap(1, 2);
    }
    let changed = features(&mirrored);
    for (name, p) in &first.features.points {
        let other = match name.split_once('_') {
            Some(("left", rest)) => format!("right_{rest}"),
            Some(("right", rest)) => format!("left_{rest}"),
            _ => name.clone(),
        };
        let q = changed.features.points[&other].position;
        let p = DVec3::new(-p.position.x, p.position.y, p.position.z);
        assert!(p.distance(q) < 3.0, "{name}: {:.1} mm", p.distance(q));
    }
    // Faces turned inside out are turned back.
    let mut inside_out = lame.clone();
    for f in &mut inside_out.faces {
        f.swap(1, 2);
    }
    let changed = features(&inside_out);
    assert_eq!(changed.features, first.features);
    assert_eq!(changed.mesh, first.mesh);
}

fn noisy(mesh: &TriMesh, size: f64) -> TriMesh {
    let normals = mesh.node_normals();
    let mut dice = Dice::new(7);
    let mut out = mesh.clone();
    for (p, n) in out.positions.iter_mut().zip(normals) {
        *p += n * (size * (dice.roll() + dice.roll()))
            + DVec3::new(dice.roll(), dice.roll(), dice.roll()) * size * 0.3;
    }
    out
}

/// Nodes of a cube become one.
fn clustered(mesh: &TriMesh, side: f64) -> TriMesh {
    let mut cells: BTreeMap<[i64; 3], (u32, DVec3, f64)> = BTreeMap::new();
    let key = |p: DVec3| (p / side).floor().to_array().map(|c| c as i64);
    for p in &mesh.positions {
        let next = cells.len() as u32;
        let cell = cells.entry(key(*p)).or_insert((next, DVec3::ZERO, 0.0));
        cell.1 += *p;
        cell.2 += 1.0;
    }
    let mut positions = vec![DVec3::ZERO; cells.len()];
    for (i, sum, n) in cells.values() {
        positions[*i as usize] = *sum / *n;
    }
    let node = |v: u32| cells[&key(mesh.positions[v as usize])].0;
    let faces = mesh
        .faces
        .iter()
        .map(|f| f.map(node))
        .filter(|f| f[0] != f[1] && f[1] != f[2] && f[2] != f[0])
        .collect();
    TriMesh::new(positions, faces)
}

fn holed(mesh: &TriMesh, holes: &[(DVec3, f64)]) -> TriMesh {
    let mut out = mesh.clone();
    out.faces.retain(|f| {
        let c = f.iter().map(|v| mesh.positions[*v as usize]).sum::<DVec3>() / 3.0;
        holes.iter().all(|(at, r)| c.distance(*at) > *r)
    });
    out
}

fn subdivided(mesh: &TriMesh) -> TriMesh {
    let mut out = TriMesh::new(mesh.positions.clone(), Vec::new());
    let mut middles: BTreeMap<(u32, u32), u32> = BTreeMap::new();
    for f in &mesh.faces {
        let m = [0, 1, 2].map(|k| {
            let (a, b) = (f[k], f[(k + 1) % 3]);
            *middles.entry((a.min(b), a.max(b))).or_insert_with(|| {
                out.positions.push((mesh.positions[a as usize] + mesh.positions[b as usize]) / 2.0);
                out.positions.len() as u32 - 1
            })
        });
        out.faces.extend([[f[0], m[0], m[2]], [m[0], f[1], m[1]], [m[2], m[1], f[2]], m]);
    }
    out
}

/// Every face with nodes of its own, as in an STL file.
fn soup(mesh: &TriMesh) -> TriMesh {
    let positions = mesh.faces.iter().flatten().map(|v| mesh.positions[*v as usize]).collect();
    TriMesh::new(positions, (0..mesh.faces.len() as u32).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect())
}

#[test]
fn features_do_not_depend_on_connectivity() {
    if shared_bodies().is_none() {
        return;
    }
    let mut faults = Vec::new();
    for name in ["female-average", "male-heavy"] {
        let mesh = read(name).unwrap();
        let first = features(&mesh);
        let rough = Bounds { point: 25.0, girth: 25.0, degrees: 1.5 };
        let belly = DVec3::new(0.04, 0.60 * first.features.height / 1000.0, 0.13);
        let back = DVec3::new(-0.03, 0.74 * first.features.height / 1000.0, -0.06);
        let crown = DVec3::new(0.0, first.features.height / 1000.0, 0.04);
        for (what, changed, bounds) in [
            ("soup", soup(&mesh), &SAME),
            ("finer", subdivided(&mesh), &SAME),
            ("noisy", noisy(&mesh, 0.0012), &NEAR),
            ("clustered to 12 mm", clustered(&mesh, 0.012), &NEAR),
            ("clustered to 35 mm", clustered(&mesh, 0.035), &rough),
            ("holed", holed(&mesh, &[(belly, 0.03), (back, 0.04), (crown, 0.05)]), &NEAR),
        ] {
            match extract(&changed, &HumanOptions::default()) {
                Ok(found) => faults.extend(compare(
                    &format!("{name} {what} ({} faces)", changed.faces.len()),
                    &first,
                    &found,
                    |p| p,
                    bounds,
                    &TRUNK_POINTS,
                )),
                Err(e) => faults.push(format!("{name} {what}: {e}")),
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// Turns the arms about the shoulders, by an angle upward, blended over the shoulder.
fn posed(mesh: &TriMesh, first: &HumanBody, degrees: f64) -> TriMesh {
    let at = |n: &str| first.placement.to_file(first.features.points[n].position);
    let (shoulder, armpit) = (at("left_shoulder"), at("left_armpit"));
    let joint = shoulder.lerp(armpit, 0.4);
    mapped(mesh, |p| {
        let s = p.x.signum();
        let q = DVec3::new(p.x.abs(), p.y, p.z);
        let from = joint.x - 0.35 * (shoulder.y - armpit.y);
        let to = joint.x + 0.75 * (shoulder.y - armpit.y);
        // Below the armpit only what lies beyond the trunk is arm.
        let t = ((q.x - from) / (to - from)).clamp(0.0, 1.0);
        let beyond = armpit.x + 0.4 * (armpit.y - q.y).max(0.0);
        let w = if q.y < armpit.y && q.x < beyond { 0.0 } else { t * t * (3.0 - 2.0 * t) };
        let turned = joint + DMat3::from_rotation_z(degrees.to_radians() * w) * (q - joint);
        DVec3::new(turned.x * s, turned.y, turned.z)
    })
}

#[test]
fn other_poses_keep_the_trunk() {
    if shared_bodies().is_none() {
        return;
    }
    let trunk = ["crotch", "nape", "front_neck", "left_bust", "right_bust", "navel"];
    let mut faults = Vec::new();
    for name in ["female-plus", "male-average"] {
        let mesh = read(name).unwrap();
        let first = features(&mesh);
        for (what, degrees) in [("T pose", 49.0), ("arms raised a little", 25.0), ("arms down", -24.0)] {
            let bounds = Bounds { point: 20.0, girth: 15.0, degrees: 1.0 };
            match extract(&posed(&mesh, &first, degrees), &HumanOptions::default()) {
                Ok(found) => {
                    let what = format!("{name}, {what}");
                    faults.extend(compare(&what, &first, &found, |p| p, &bounds, &trunk));
                    let arms = Bounds { point: 45.0, ..bounds };
                    let points = ["left_armpit", "right_armpit", "left_shoulder", "right_shoulder"];
                    faults.extend(compare(&what, &first, &found, |p| p, &arms, &points));
                    if !found.features.curves.contains_key("left_upper_arm") {
                        faults.push(format!("{what}: no upper arm: {:?}", found.features.warnings));
                    }
                }
                Err(e) => faults.push(format!("{name}, {what}: {e}")),
            }
        }
    }
    assert!(faults.is_empty(), "{faults:#?}");
}

/// The same bytes on one thread and on two.
#[test]
fn threads_do_not_matter() {
    let Some(mesh) = read("scan-noisy-plus") else { return };
    let on = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| features(&mesh))
    };
    let (one, two) = (on(1), on(2));
    assert_eq!(
        serde_json::to_string(&one.exported()).unwrap(),
        serde_json::to_string(&two.exported()).unwrap()
    );
    assert_eq!(one.features, two.features);
    assert_eq!(one.mesh, two.mesh);
}
