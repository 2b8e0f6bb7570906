//! Girths and joints of arms and legs.

use std::collections::VecDeque;

use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::query::plane_section;

use super::figure::{Figure, Side, smooth};
use super::girths::{TiltedPlane, closed, from_front};
use super::marks::Marks;
use super::normals::NormalField;
use super::ring::{Gaps, Ring, depth_at, outer_rings};
use crate::model::{FeaturePoint, Features};

/// Spacing of the points of limb girths, millimetres.
const SPACING: f64 = 5.0;

/// Adds limb girths and joints that exist; warns of missing arms or legs.
pub(crate) fn add(figure: &Figure<'_>, marks: &Marks, field: &NormalField, features: &mut Features) {
    for side in Side::BOTH {
        if marks.legs {
            leg(figure, marks, side, field, features);
        }
        if !arm(figure, marks, side, field, features) {
            features.warnings.push(format!("no free {} was found: its girths are missing", side.name("arm")));
        }
    }
    if !marks.legs {
        features.warnings.push("no two legs were found: their girths are missing".to_owned());
    }
}

fn leg(figure: &Figure<'_>, marks: &Marks, side: Side, field: &NormalField, features: &mut Features) {
    let crotch = marks.crotch_level;
    let girths: Vec<(f64, f64, DVec3)> = figure
        .between(0.03 * figure.height, crotch)
        .iter()
        .filter_map(|l| {
            let r = l.leg(side)?;
            Some((l.y, r.tape(), DVec3::new(r.centroid.x, l.y, r.centroid.y)))
        })
        .collect();
    let narrowest = |low: f64, high: f64| {
        girths.iter().filter(|g| g.0 >= low && g.0 <= high).min_by(|a, b| a.1.total_cmp(&b.1)).map(|g| g.0)
    };
    // The leg is narrowest above the foot; at the knee it has a waist between thigh and calf, shallow or none.
    let ankle = narrowest(0.07 * crotch, 0.25 * crotch);
    let knee = Some(0.625 * crotch);
    let thigh = Some(crotch - 0.03 * marks.stature);
    for (what, y) in [("ankle", ankle), ("knee", knee), ("thigh", thigh)] {
        let Some(y) = y else { continue };
        let near =
            |at: f64| girths.iter().min_by(|a, b| (a.0 - at).abs().total_cmp(&(b.0 - at).abs())).map(|g| g.2);
        let (Some(below), Some(above)) = (near(y - 0.03 * marks.stature), near(y + 0.02 * marks.stature))
        else {
            continue;
        };
        // Square to the leg as seen from the front, halfway: a tape round a spread leg is held between level and square.
        let axis = (above - below).normalize_or(DVec3::Y);
        let level = figure.at(y);
        let Some(ring) = level.leg(side) else { continue };
        let centre = DVec3::new(ring.centroid.x, y, ring.centroid.y);
        let axis = if what == "thigh" { DVec3::Y } else { axis };
        let Some((ring, plane, at)) = around(figure.mesh, centre, axis) else { continue };
        let points = from_front(&shifted(&ring), SPACING);
        let middle = ring.centroid;
        let points = points.into_iter().map(|p| plane.place(p + middle, at)).collect();
        features.curves.insert(side.name(what), closed(points, plane.normal, field));
        if what != "thigh" {
            // The kneecap, the front of the ankle.
            let place = place_of(&ring, &plane, at, 1, field);
            features.points.extend(place.map(|p| (side.name(what), p)));
        }
    }
}

/// The outline with its middle at the origin.
fn shifted(ring: &Ring) -> Vec<DVec2> {
    ring.points.iter().map(|p| *p - ring.centroid).collect()
}

/// The place of a girth straight before its middle (1) or behind it (0).
fn place_of(
    ring: &Ring,
    plane: &TiltedPlane,
    at: f64,
    front: usize,
    field: &NormalField,
) -> Option<FeaturePoint> {
    let middle = plane.place(ring.centroid, at);
    let depth = depth_at(&shifted(ring), 0.0)?[front];
    let place = plane.place(DVec2::new(0.0, depth) + ring.centroid, at);
    Some(field.point(place, place - middle))
}

/// The outline around a centre in the plane square to an axis.
fn around(mesh: &TriMesh, centre: DVec3, axis: DVec3) -> Option<(Ring, TiltedPlane, f64)> {
    let plane = TiltedPlane::new(axis);
    let at = centre.dot(axis);
    let rings = outer_rings(&plane_section(mesh, centre, axis), 20.0, Gaps::Join, |p| plane.flat(p));
    let inside = plane.flat(centre);
    let ring = rings.iter().position(|r| r.contains(inside))?;
    rings.into_iter().nth(ring).map(|r| (r, plane, at))
}

/// Girths of one arm; false if there is none that stands free.
fn arm(figure: &Figure<'_>, marks: &Marks, side: Side, field: &NormalField, features: &mut Features) -> bool {
    let i = side.index();
    let (shoulder, armpit) = (marks.shoulder[i], marks.armpit[i]);
    let Some(mesh) = arm_surface(figure.mesh, shoulder, armpit, side) else { return false };
    let joint = (shoulder + armpit) / 2.0;
    let reach =
        mesh.faces.iter().flatten().map(|v| mesh.positions[*v as usize].distance(joint)).fold(0.0, f64::max);
    if reach < 0.2 * marks.stature {
        return false;
    }
    // Axis: middles of shells about the shoulder joint.
    let shells = 40;
    let mut sums = vec![(DVec3::ZERO, 0.0); shells];
    for f in 0..mesh.faces.len() as u32 {
        let [a, b, c] = mesh.corners(f);
        let middle = (a + b + c) / 3.0;
        let area = mesh.area_normal(f).length();
        let k = ((middle.distance(joint) / reach * shells as f64) as usize).min(shells - 1);
        sums[k].0 += middle * area;
        sums[k].1 += area;
    }
    let axis: Vec<DVec3> = sums.iter().filter(|s| s.1 > 0.0).map(|s| s.0 / s.1).collect();
    if axis.len() < shells / 2 {
        return false;
    }
    let axis: Vec<DVec3> = {
        let part = |f: fn(&DVec3) -> f64| smooth(&axis.iter().map(f).collect::<Vec<_>>(), 1.5);
        let (x, y, z) = (part(|p| p.x), part(|p| p.y), part(|p| p.z));
        (0..axis.len()).map(|k| DVec3::new(x[k], y[k], z[k])).collect()
    };
    let at = |part: f64| {
        let t = (part * (axis.len() - 1) as f64).clamp(0.0, (axis.len() - 1) as f64 - 1e-9);
        let k = t as usize;
        axis[k].lerp(axis[k + 1], t - k as f64)
    };
    let section = |part: f64| {
        let direction = (at(part + 0.05) - at(part - 0.05)).normalize_or(DVec3::X);
        around(&mesh, at(part), direction).map(|(ring, plane, height)| (ring.tape(), ring, plane, height))
    };
    // The wrist is the narrowest place of the outer half before the hand broadens.
    let narrow = (0..=12)
        .map(|k| 0.58 + 0.017 * f64::from(k))
        .filter_map(|part| section(part).map(|s| (part, s.0)))
        .min_by(|a, b| a.1.total_cmp(&b.1));
    let wrist = narrow.map_or(0.72, |n| n.0);
    let first = at(0.0);
    let chord = at(wrist) - first;
    let bend = |part: f64| {
        let d = at(part) - first;
        (d - chord * (d.dot(chord) / chord.length_squared())).length()
    };
    let elbow = (0..=10)
        .map(|k| wrist * (0.45 + 0.02 * f64::from(k)))
        .max_by(|a, b| bend(*a).total_cmp(&bend(*b)))
        .filter(|p| bend(*p) > 0.008 * marks.stature)
        .unwrap_or(0.55 * wrist);
    // The upper arm is measured just below the armpit, square to the arm.
    let upper = {
        let direction = (at(elbow) - at(0.1)).normalize_or(DVec3::X);
        let along = (armpit - first).dot(direction) + 0.052 * marks.stature;
        let centre = (0..=60)
            .map(|k| at(elbow * f64::from(k) / 60.0))
            .min_by(|a, b| {
                ((*a - first).dot(direction) - along)
                    .abs()
                    .total_cmp(&((*b - first).dot(direction) - along).abs())
            })
            .unwrap_or(first);
        around(&mesh, centre, direction)
    };
    let mut add = |what: &str, found: Option<(Ring, TiltedPlane, f64)>, mark: bool| {
        let Some((ring, plane, height)) = found else { return };
        let points = from_front(&shifted(&ring), SPACING);
        let points = points.into_iter().map(|p| plane.place(p + ring.centroid, height)).collect();
        features.curves.insert(side.name(what), closed(points, plane.normal, field));
        if mark {
            // The point of the elbow, the back of the wrist.
            let place = place_of(&ring, &plane, height, 0, field);
            features.points.extend(place.map(|p| (side.name(what), p)));
        }
    };
    add("upper_arm", upper, false);
    add("wrist", section(wrist).map(|s| (s.1, s.2, s.3)), true);
    add("elbow", section(elbow).map(|s| (s.1, s.2, s.3)), true);
    true
}

/// The faces beyond the armhole that hang together with the arm. `None` if they run on into trunk or legs.
fn arm_surface(mesh: &TriMesh, shoulder: DVec3, armpit: DVec3, side: Side) -> Option<TriMesh> {
    let down = (armpit - shoulder).normalize();
    let across = DVec3::X * side.sign();
    let out = (across - down * down.dot(across)).normalize();
    let middle = (shoulder + armpit) / 2.0;
    let reach = shoulder.distance(armpit);
    let beyond: Vec<bool> = (0..mesh.faces.len() as u32)
        .map(|f| {
            let [a, b, c] = mesh.corners(f);
            ((a + b + c) / 3.0 - middle).dot(out) > 2.0
        })
        .collect();
    let mut around: Vec<Vec<u32>> = vec![Vec::new(); mesh.positions.len()];
    for (f, face) in mesh.faces.iter().enumerate() {
        if beyond[f] {
            for v in face {
                around[*v as usize].push(f as u32);
            }
        }
    }
    let start = (0..mesh.faces.len()).filter(|f| beyond[*f]).min_by(|a, b| {
        let away = |f: usize| {
            let [p, q, r] = mesh.corners(f as u32);
            ((p + q + r) / 3.0 - middle - out * (0.3 * reach)).length()
        };
        away(*a).total_cmp(&away(*b))
    })?;
    let mut seen = vec![false; mesh.faces.len()];
    let mut queue = VecDeque::from([start as u32]);
    seen[start] = true;
    while let Some(f) = queue.pop_front() {
        for v in mesh.faces[f as usize] {
            for g in std::mem::take(&mut around[v as usize]) {
                if !seen[g as usize] {
                    seen[g as usize] = true;
                    queue.push_back(g);
                }
            }
        }
    }
    let faces: Vec<[u32; 3]> = (0..mesh.faces.len()).filter(|f| seen[*f]).map(|f| mesh.faces[f]).collect();
    let lowest = faces.iter().flatten().map(|v| mesh.positions[*v as usize].y).fold(f64::INFINITY, f64::min);
    (lowest > 0.4 * armpit.y && faces.len() > 20).then(|| TriMesh::new(mesh.positions.clone(), faces))
}
