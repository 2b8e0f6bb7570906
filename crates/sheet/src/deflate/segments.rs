//! Segmentation of a skin into face groups: planes, and smooth pieces between sharp edges.
//!
//! A plane face is told from a facet of a curved one by its surroundings, not by numbers of triangles: a facet has
//! neighbours about as wide as itself behind its smooth edges, a plane face has none or narrow ones.

use glam::DVec3;

use super::plane::Plane;
use super::solid::Solid;

/// Edges that fold by more than this are sharp: no tessellation of a smooth face is so coarse.
pub(super) const SHARP: f64 = 40.0 / 180.0 * std::f64::consts::PI;
/// Faces whose nodes are within this share of the solid's size of one plane are in that plane; single-precision files
/// hold coordinates to 6e-8 of it.
const COPLANAR: f64 = 1e-6;
/// Normals in one plane differ by less than this, in radians, where the faces are not so thin that rounding turns them.
const COPLANAR_TURN: f64 = 2e-3;
/// A plane face is this many times wider than the facets of the curved faces that it runs into.
const WIDER: f64 = 3.0;
/// Below this fold, in radians, edges of a plane face say nothing: the surface may just be finely meshed.
const SLIGHT_FOLD: f64 = 1.0 / 180.0 * std::f64::consts::PI;

const NONE: u32 = u32::MAX;

/// A face group of the skin.
#[derive(Clone, Debug)]
pub(super) struct Group {
    /// Its faces, ascending.
    pub(super) faces: Vec<u32>,
    /// Its plane, if it has one; the normal points outward.
    pub(super) plane: Option<Plane>,
    /// Area in mm².
    pub(super) area: f64,
}

/// The skin cut into groups.
#[derive(Debug)]
pub(super) struct Segments {
    pub(super) groups: Vec<Group>,
    /// Group of every face.
    pub(super) of_face: Vec<u32>,
}

impl Segments {
    /// Cuts a skin into groups. O(n log n).
    pub(super) fn new(solid: &Solid) -> Self {
        let regions = Regions::new(solid);
        let is_plane = regions.planes(solid);
        let mut of_face = vec![NONE; solid.len() as usize];
        let mut groups = Vec::new();
        let mut stack = Vec::new();
        for seed in 0..solid.len() {
            if of_face[seed as usize] != NONE {
                continue;
            }
            let number = groups.len() as u32;
            let region = regions.of_face[seed as usize];
            let plane = is_plane[region as usize];
            let mut faces = Vec::new();
            of_face[seed as usize] = number;
            stack.push(seed);
            while let Some(f) = stack.pop() {
                faces.push(f);
                for h in 3 * f..3 * f + 3 {
                    let g = solid.across(h);
                    let other = regions.of_face[g as usize];
                    let together = if plane {
                        other == region
                    } else {
                        !is_plane[other as usize] && solid.fold_cosine(h) > SHARP.cos()
                    };
                    if of_face[g as usize] == NONE && together {
                        of_face[g as usize] = number;
                        stack.push(g);
                    }
                }
            }
            faces.sort_unstable();
            let area = faces.iter().map(|f| solid.areas[*f as usize]).sum();
            let plane = plane.then(|| fitted_plane(solid, &faces));
            groups.push(Group { faces, plane, area });
        }
        Self { groups, of_face }
    }

    /// The group of a face.
    pub(super) fn of(&self, f: u32) -> u32 {
        self.of_face[f as usize]
    }

    /// A group by its number.
    pub(super) fn group(&self, g: u32) -> &Group {
        &self.groups[g as usize]
    }
}

/// The plane of faces that are in one.
fn fitted_plane(solid: &Solid, faces: &[u32]) -> Plane {
    let origin = solid.centroid(faces[0]);
    let (mut normal, mut moment, mut area) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for &f in faces {
        let a = solid.areas[f as usize];
        normal += solid.normals[f as usize] * a;
        moment += (solid.centroid(f) - origin) * a;
        area += a;
    }
    let normal = Some(normal.normalize_or_zero()).filter(|n| *n != DVec3::ZERO);
    let normal = normal.unwrap_or(solid.normals[faces[0] as usize]);
    let point = if area > 0.0 { origin + moment / area } else { origin };
    Plane { normal, offset: normal.dot(point) }
}

/// Largest connected sets of faces in one plane.
struct Regions {
    of_face: Vec<u32>,
    faces: Vec<Vec<u32>>,
}

impl Regions {
    fn new(solid: &Solid) -> Self {
        let n = solid.len();
        // Large faces first: their planes are the surest.
        let mut seeds: Vec<u32> = (0..n).collect();
        seeds.sort_by(|f, g| solid.areas[*g as usize].total_cmp(&solid.areas[*f as usize]).then(f.cmp(g)));
        let mut of_face = vec![NONE; n as usize];
        let mut faces: Vec<Vec<u32>> = Vec::new();
        let tolerance = COPLANAR * solid.size;
        let mut stack = Vec::new();
        for seed in seeds {
            if of_face[seed as usize] != NONE {
                continue;
            }
            let number = faces.len() as u32;
            let normal = solid.normals[seed as usize];
            let offset = normal.dot(solid.centroid(seed));
            let mut own = Vec::new();
            of_face[seed as usize] = number;
            stack.push(seed);
            while let Some(f) = stack.pop() {
                own.push(f);
                for h in 3 * f..3 * f + 3 {
                    let g = solid.across(h);
                    if of_face[g as usize] != NONE {
                        continue;
                    }
                    let corners = solid.mesh.corners(g);
                    let near = corners.iter().all(|p| (normal.dot(*p) - offset).abs() < tolerance);
                    // A face as thin as the tolerance may stand at any angle and still be near.
                    let turn = solid.normals[g as usize].cross(normal).length();
                    let height = 2.0 * solid.areas[g as usize] / longest_side(&corners);
                    let allowed = COPLANAR_TURN.max(2.0 * tolerance / height.max(f64::MIN_POSITIVE));
                    let same_side = solid.normals[g as usize].dot(normal) > 0.5;
                    if near && turn < allowed && same_side {
                        of_face[g as usize] = number;
                        stack.push(g);
                    }
                }
            }
            faces.push(own);
        }
        Self { of_face, faces }
    }

    /// Whether each region is a plane face, or else facets of a curved one. O(n).
    fn planes(&self, solid: &Solid) -> Vec<bool> {
        let widths: Vec<f64> = self.faces.iter().map(|faces| width(solid, faces)).collect();
        let whole_stars = self.regions_with_whole_stars(solid);
        let mut is_plane: Vec<bool> = (0..self.faces.len())
            .map(|r| self.looks_plane(solid, r as u32, &widths, whole_stars[r]))
            .collect();
        self.settle_bends(solid, &mut is_plane);
        is_plane
    }

    /// Whether some node has nothing but faces of the region about it: in a curved face, every node bends it.
    fn regions_with_whole_stars(&self, solid: &Solid) -> Vec<bool> {
        const MIXED: u32 = u32::MAX - 1;
        let mut region_at = vec![NONE; solid.mesh.positions.len()];
        for (face, &region) in solid.mesh.faces.iter().zip(&self.of_face) {
            for &v in face {
                let at = &mut region_at[v as usize];
                *at = if *at == NONE || *at == region { region } else { MIXED };
            }
        }
        let mut whole = vec![false; self.faces.len()];
        for region in region_at.into_iter().filter(|r| *r < MIXED) {
            whole[region as usize] = true;
        }
        whole
    }

    fn looks_plane(&self, solid: &Solid, region: u32, widths: &[f64], whole_star: bool) -> bool {
        let (mut smooth, mut narrower, mut folds) = (0.0, 0.0, 0.0);
        for &f in &self.faces[region as usize] {
            for h in 3 * f..3 * f + 3 {
                let other = self.of_face[solid.across(h) as usize];
                let cosine = solid.fold_cosine(h);
                if other == region || cosine <= SHARP.cos() {
                    continue;
                }
                let [a, b] = solid.adjacency.ends(h).map(|v| solid.mesh.positions[v as usize]);
                let length = a.distance(b);
                smooth += length;
                folds += length * cosine.clamp(-1.0, 1.0).acos();
                if widths[region as usize] > WIDER * widths[other as usize] {
                    narrower += length;
                }
            }
        }
        if smooth == 0.0 {
            return true;
        }
        let fold = folds / smooth;
        narrower > 0.5 * smooth && fold > SLIGHT_FOLD && self.faces[region as usize].len() > 1
            || whole_star && fold > SLIGHT_FOLD
    }

    /// Facets that run into one other facet only, and that one into no third: a plate bent once, not a curved one.
    fn settle_bends(&self, solid: &Solid, is_plane: &mut [bool]) {
        let smooth_neighbours = |region: u32, is_plane: &[bool]| {
            let mut found: Vec<u32> = Vec::new();
            for &f in &self.faces[region as usize] {
                for h in 3 * f..3 * f + 3 {
                    let other = self.of_face[solid.across(h) as usize];
                    let smooth = other != region && solid.fold_cosine(h) > SHARP.cos();
                    if smooth && !is_plane[other as usize] && !found.contains(&other) {
                        found.push(other);
                    }
                    if found.len() > 1 {
                        return found;
                    }
                }
            }
            found
        };
        let mut settled = Vec::new();
        for region in (0..self.faces.len() as u32).filter(|r| !is_plane[*r as usize]) {
            let alone = match smooth_neighbours(region, is_plane)[..] {
                [] => true,
                [other] => smooth_neighbours(other, is_plane) == [region],
                _ => false,
            };
            if alone {
                settled.push(region);
            }
        }
        for region in settled {
            is_plane[region as usize] = true;
        }
    }
}

fn longest_side([a, b, c]: &[DVec3; 3]) -> f64 {
    a.distance(*b).max(b.distance(*c)).max(c.distance(*a))
}

/// About how wide some faces are: area over diameter.
fn width(solid: &Solid, faces: &[u32]) -> f64 {
    let (mut lo, mut hi) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
    let mut area = 0.0;
    for &f in faces {
        for p in solid.mesh.corners(f) {
            lo = lo.min(p);
            hi = hi.max(p);
        }
        area += solid.areas[f as usize];
    }
    area / (hi - lo).length().max(f64::MIN_POSITIVE)
}
