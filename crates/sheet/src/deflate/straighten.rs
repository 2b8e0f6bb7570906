//! Plane faces of files that round are made plane again.
//!
//! Coordinates with three decimals or six digits, or beside the origin in single precision, are off by more than exact planes
//! bear: faces would fall into splinters that nearly lie in one plane. Nodes go back to where the planes of their faces meet, if
//! these are no farther than some times what the file rounds by.

use glam::DVec3;

use super::plane::Plane;
use super::regions::{COPLANAR, fitted_plane, plane_regions};
use super::replace::on_planes;
use super::solid::Solid;

/// Files that round by more than this share of the solid's size hold shapes that are rough, not rounded.
const MOST: f64 = 2e-5;
/// Less than this share of it does no harm.
const FINE: f64 = 4e-8;
/// Nodes are off their planes by up to so many times what one coordinate is off by.
pub(super) const WITHIN: f64 = 3.0;
/// Faces may be in one plane if that of one is off by no more than so many times that at the other, and leans by no more than this.
const FAR: f64 = 30.0;
const LEAN: f64 = 0.01;
/// One that has more than so many times the faces of another tells by itself whether that is in it.
const MUCH_LARGER: usize = 4;
/// Regions with more than this share of the area may have others in their plane.
const LARGE: f64 = 5e-4;
/// Halves of the last place in single precision, and twice that where decimals went through it.
const SINGLE: f64 = 6e-8;
const THROUGH_SINGLE: f64 = 1.2e-7;
/// Planes of a node meet in a point if the sine of the angle between them is more than this.
const MEETING: f64 = 0.1;

/// The solid with nodes in the planes of their faces, or as it is where its file hardly rounds. O(n log n).
pub(super) fn straightened(mut solid: Solid) -> Solid {
    let rounding = rounding(&solid.mesh.positions, solid.size);
    if rounding < FINE * solid.size {
        return solid;
    }
    solid.rounding = rounding;
    let tolerance = (WITHIN * rounding).max(COPLANAR * solid.size);
    let regions = plane_regions(&solid, tolerance);
    let (planes, of_region) = planes(&solid, &regions, tolerance);
    let mut of_node: Vec<Vec<u32>> = vec![Vec::new(); solid.mesh.positions.len()];
    for (faces, plane) in regions.iter().zip(&of_region) {
        for v in faces.iter().flat_map(|f| solid.mesh.faces[*f as usize]) {
            let own = &mut of_node[v as usize];
            if !own.contains(plane) {
                own.push(*plane);
            }
        }
    }
    let mut farthest: f64 = 0.0;
    let positions = (solid.mesh.positions.iter().zip(&mut of_node))
        .map(|(p, own)| {
            // The largest face first: planes are numbered so.
            own.sort_unstable();
            let to = place(*p, own.iter().map(|k| planes[*k as usize]), WITHIN * WITHIN * rounding);
            farthest = farthest.max(to.distance(*p));
            to
        })
        .collect();
    if farthest < FINE * solid.size {
        return solid;
    }
    // Needles that rounding had turned may come to lie on their neighbours.
    solid.with_nodes_at(positions).unwrap_or(solid)
}

/// By how much the coordinates of a file are off at most, as told by their digits, in mm.
fn rounding(positions: &[DVec3], size: f64) -> f64 {
    let coordinates = || positions.iter().flat_map(|p| p.to_array());
    let largest = coordinates().fold(0.0, |m: f64, x| m.max(x.abs()));
    let most = MOST * size;
    let mut found: f64 = 0.0;
    if coordinates().all(|x| f64::from(x as f32) == x) {
        found = SINGLE * largest;
    }
    // A step is the last decimal of all, or of each by its own magnitude.
    let fits = |step: &dyn Fn(f64) -> f64| {
        coordinates().all(|x| {
            let step = step(x);
            let off = x - (x / step).round() * step;
            off.abs() <= THROUGH_SINGLE * x.abs()
        })
    };
    let place = |x: f64| 10f64.powf(x.log10().ceil());
    let last = (0..8).map(|k| place(2.0 * most) / 10f64.powi(k + 1)).find(|step| fits(&|_| *step));
    let digits = (4..8).map(|k| 10f64.powi(-k)).find(|share| {
        let step = |x: f64| place(x.abs().max(f64::MIN_POSITIVE)).max(1e-30) * share;
        0.5 * place(largest) * share <= most && fits(&step)
    });
    let of_digits = digits.map(|share| 0.5 * place(largest) * share);
    found.max(last.map_or(0.0, |step| step / 2.0)).max(of_digits.unwrap_or(0.0)).min(most)
}

/// The planes of regions, larger ones first and those that are one within the tolerance only once.
fn planes(solid: &Solid, regions: &[Vec<u32>], tolerance: f64) -> (Vec<Plane>, Vec<u32>) {
    let area = |faces: &Vec<u32>| faces.iter().map(|f| solid.areas[*f as usize]).sum::<f64>();
    let areas: Vec<f64> = regions.iter().map(area).collect();
    let mut order: Vec<usize> = (0..regions.len()).collect();
    order.sort_by(|a, b| areas[*b].total_cmp(&areas[*a]).then(a.cmp(b)));
    let large = LARGE * areas.iter().sum::<f64>();
    let mut found: Vec<Found> = Vec::new();
    let mut searched = 0;
    let mut of_region = vec![0; regions.len()];
    for k in order {
        let own = fitted_plane(solid, &regions[k]);
        let middle = solid.centroid(regions[k][0]);
        let within = |faces: &[u32], plane: &Plane| {
            let mut nodes = faces.iter().flat_map(|f| solid.mesh.corners(*f));
            nodes.all(|p| plane.height(p).abs() < tolerance)
        };
        let holds = |found: &Found| {
            let near = found.plane.normal.cross(own.normal).length() < LEAN
                && found.plane.height(middle).abs() < FAR * tolerance;
            // Far from a small face its plane is off; together with the other face it is not. What is much larger tells it alone.
            near && if found.faces.len() > MUCH_LARGER * regions[k].len() {
                within(&regions[k], &found.plane)
            } else {
                let both = [found.faces.as_slice(), &regions[k]].concat();
                within(&both, &fitted_plane(solid, &both))
            }
        };
        let number = found[..searched].iter().position(holds).unwrap_or_else(|| {
            found.push(Found { plane: own, faces: Vec::new(), fitted: 0 });
            if areas[k] > large {
                searched = found.len();
            }
            found.len() - 1
        });
        found[number].add(solid, &regions[k]);
        of_region[k] = number as u32;
    }
    // All that is in a plane tells it best.
    (found.iter().map(|found| fitted_plane(solid, &found.faces)).collect(), of_region)
}

/// A plane with the faces that are known to be in it.
struct Found {
    plane: Plane,
    faces: Vec<u32>,
    /// How many of the faces it was fitted to.
    fitted: usize,
}

impl Found {
    /// Adds faces; the plane is fitted anew as often as they double.
    fn add(&mut self, solid: &Solid, faces: &[u32]) {
        self.faces.extend(faces);
        if self.faces.len() >= 2 * self.fitted {
            self.plane = fitted_plane(solid, &self.faces);
            self.fitted = self.faces.len();
        }
    }
}

/// A node on as many of its planes as meet in one point near it.
fn place(p: DVec3, planes: impl Iterator<Item = Plane>, reach: f64) -> DVec3 {
    let (mut chosen, mut basis, mut at): (Vec<Plane>, Vec<DVec3>, DVec3) = (Vec::new(), Vec::new(), p);
    for plane in planes {
        let rest = basis.iter().fold(plane.normal, |n, b| n - *b * b.dot(n));
        if rest.length() < MEETING || chosen.len() == 3 {
            continue;
        }
        chosen.push(plane);
        let to = on_planes(p, &chosen);
        if to.distance(p) < reach {
            basis.push(rest.normalize());
            at = to;
        } else {
            chosen.pop();
        }
    }
    at
}
