//! Features of the models and scans beside the checkout against their true measurements.

use std::fmt::Write as _;
use std::sync::OnceLock;

use crate::human_common::{BODIES, features, read, shared_bodies};
use mesh_kernel::glam::{DMat3, DVec3};
use rayon::prelude::*;
use reference::human::HumanBody;
use serde_json::Value;

/// All bodies with their features, found once.
fn bodies() -> &'static [HumanBody] {
    static FOUND: OnceLock<Vec<HumanBody>> = OnceLock::new();
    FOUND.get_or_init(|| BODIES.par_iter().map(|name| features(&read(name).unwrap())).collect())
}

fn vector(v: &Value) -> DVec3 {
    let c = |i: usize| v[i].as_f64().unwrap();
    DVec3::new(c(0), c(1), c(2)) * 1000.0
}

/// Girths, landmarks, heading of all sixteen bodies, each within its bound; prints the table when it fails.
#[test]
fn features_of_known_bodies_are_where_they_were_measured() {
    let Some(folder) = shared_bodies() else { return };
    let truth: Value =
        serde_json::from_str(&std::fs::read_to_string(folder.join("measurements.json")).unwrap()).unwrap();
    let mut table = String::new();
    let mut faults = Vec::new();
    for (name, body) in BODIES.into_iter().zip(bodies()) {
        let truth = &truth["bodies"][name];
        let noisy = name.starts_with("scan-noisy");
        // The source body's coordinates in the file's frame.
        let angle = truth["placement"]["rotation_about_y_deg"].as_f64().unwrap_or(0.0).to_radians();
        let turn = DMat3::from_rotation_y(angle);
        let shift = if noisy { vector(&truth["placement"]["shift_m"]) } else { DVec3::ZERO };
        let mut fail = |what: &str, off: f64, bound: f64| {
            if off.abs() > bound {
                faults.push(format!("{name}: {what} is off by {off:.1}, more than {bound}"));
            }
        };
        let facing = body.placement.direction_to_file(body.features.facing);
        let heading = facing.cross(turn * DVec3::Z).y.asin().to_degrees();
        fail("heading, degrees,", heading, if facing.dot(turn * DVec3::Z) > 0.0 { 3.0 } else { -1.0 });
        write!(table, "{name:18} heading {heading:+.2}").unwrap();
        for (girth, key) in [("bust", "bust_fullest"), ("waist", "waist_narrowest"), ("hip", "hips_fullest")]
        {
            let off = body.girths[girth] - truth["extremes"][key]["tape_cm"].as_f64().unwrap() * 10.0;
            fail(girth, off, if noisy { 15.0 } else { 9.0 });
            write!(table, " {girth} {off:+.1}").unwrap();
        }
        for (girth, key) in [("neck", "neck"), ("left_thigh", "thigh"), ("left_upper_arm", "upperarm")] {
            let off = body.girths[girth] - truth["loops"][key]["tape_cm"].as_f64().unwrap() * 10.0;
            write!(table, " ({girth} {off:+.0})").unwrap();
        }
        for (point, key) in [
            ("left_armpit", "armpit_left"),
            ("right_armpit", "armpit_right"),
            ("crotch", "crotch"),
            ("nape", "nape"),
            ("front_neck", "front_neck"),
            ("left_shoulder", "shoulder_left"),
            ("right_shoulder", "shoulder_right"),
            ("left_bust", "bust_point_left"),
            ("right_bust", "bust_point_right"),
        ] {
            let found = body.placement.to_file(body.features.points[point].position) * 1000.0;
            let off = found - (turn * vector(&truth["landmarks"][key]) + shift);
            fail(&format!("position of {point}"), off.length(), if noisy { 25.0 } else { 20.0 });
            fail(&format!("height of {point}"), off.y, if noisy { 25.0 } else { 15.0 });
            write!(table, " {point} {:.0} ({:+.0})", off.length(), off.y).unwrap();
        }
        table.push('\n');
    }
    println!("{table}");
    assert!(faults.is_empty(), "{faults:#?}");
}

const LINES: [&str; 8] = [
    "centre_front",
    "centre_back",
    "left_side",
    "right_side",
    "left_princess_front",
    "right_princess_front",
    "left_princess_back",
    "right_princess_back",
];
const LEVELS: [&str; 6] = ["chest", "bust", "underbust", "waist", "high_hip", "hip"];

/// Every name is there; lines run down without turning back and cross each level curve, on the skin and taut, in a
/// frame that is no flat one and looks outward.
#[test]
fn lines_cross_every_level_once() {
    if shared_bodies().is_none() {
        return;
    }
    for (name, body) in BODIES.into_iter().zip(bodies()) {
        let f = &body.features;
        for curve in ["neck", "neck_base"].into_iter().chain(LEVELS).chain(LINES) {
            assert!(f.curves.contains_key(curve), "{name}: no {curve}");
        }
        for what in [
            "armhole",
            "upper_arm",
            "thigh",
            "shoulder_line",
            "knee",
            "ankle",
            "wrist",
            "elbow",
            "shoulder_line",
        ] {
            for side in ["left", "right"] {
                assert!(f.curves.contains_key(&format!("{side}_{what}")), "{name}: no {side}_{what}");
            }
        }
        for line in LINES {
            let points = &f.curves[line].points;
            assert!(points.windows(2).all(|w| w[1].y < w[0].y + 0.05), "{name}: {line} turns back");
            let bend = points
                .windows(3)
                .map(|w| (w[1] - w[0]).angle_between(w[2] - w[1]).to_degrees())
                .fold(0.0, f64::max);
            // No line leaves the trunk along an arm.
            let widest = points.iter().map(|p| p.x.abs()).fold(0.0, f64::max);
            assert!(widest < 0.16 * f.height, "{name}: {line} strays {widest:.0} mm aside");
            assert!(bend < 40.0, "{name}: {line} has a corner of {bend:.0} degrees");
            assert!(points[points.len() - 1].y < 0.25 * f.height, "{name}: {line} ends above the knee");
            for level in LEVELS {
                for curve in [level.to_owned(), format!("{level}_tape")] {
                    if f.curves[&curve].points[0].y > points[0].y - 1.0 {
                        continue;
                    }
                    let frame =
                        f.crossing(line, &curve).unwrap_or_else(|| panic!("{name}: {line} x {curve}"));
                    let triple = frame.normal.dot(frame.first.cross(frame.second));
                    assert!(triple.abs() > 0.5, "{name}: {line} x {curve}: {triple}");
                    // Down and anticlockwise seen from above: outward is their product.
                    assert!(triple > 0.0, "{name}: {line} x {curve} is left-handed");
                    let other = f.crossing(&curve, line).unwrap();
                    assert!(other.origin.distance(frame.origin) < 1e-9);
                }
            }
        }
        for point in f.points.keys() {
            let frame = f.point_frame(point).unwrap();
            assert!(frame.normal.dot(frame.first.cross(frame.second)) > 0.9, "{name}: {point}");
        }
    }
}

/// The models are mirror images of themselves: so are the frames, within a millimetre and half a degree or so.
#[test]
fn left_and_right_frames_are_mirror_images() {
    if shared_bodies().is_none() {
        return;
    }
    let mirror = |v: DVec3| DVec3::new(-v.x, v.y, v.z);
    let mut worst = (0.0, String::new());
    for (name, body) in BODIES.iter().zip(bodies()).filter(|b| !b.0.starts_with("scan")) {
        let f = &body.features;
        for line in ["side", "princess_front", "princess_back"] {
            for level in LEVELS {
                for curve in [level.to_owned(), format!("{level}_tape")] {
                    let l = f.crossing(&format!("left_{line}"), &curve);
                    let r = f.crossing(&format!("right_{line}"), &curve);
                    let (Some(l), Some(r)) = (l, r) else { continue };
                    let off = mirror(l.origin).distance(r.origin);
                    let turn = mirror(l.normal).angle_between(r.normal).to_degrees();
                    if off > worst.0 {
                        worst = (off, format!("{name} {line} x {curve}: normals turn {turn:.2}"));
                    }
                    assert!(off < 1.0, "{name}: {line} x {curve} differ by {off:.2} mm");
                    assert!(turn < 3.0, "{name}: {line} x {curve}: normals differ by {turn:.1} degrees");
                }
            }
        }
    }
    println!("worst: {worst:?}");
}
