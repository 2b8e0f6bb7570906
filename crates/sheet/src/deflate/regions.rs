//! Regions of a skin that lie in one plane: plane faces, and facets of curved ones.
//!
//! A plane face is told from a facet of a curved one by its surroundings, not by numbers of triangles: a facet has
//! neighbours about as wide as itself behind its smooth edges, a plane face has none or narrow ones.

use glam::{DMat3, DVec3};
use rayon::prelude::*;

use super::plane::Plane;
use super::solid::{SHARP, SPECK, Solid, longest_side};

/// Faces whose nodes are within this share of the solid's size of one plane are in that plane; single-precision files
/// hold coordinates to 6e-8 of it.
pub(super) const COPLANAR: f64 = 1e-6;
/// Normals in one plane differ by less than this, in radians, where the faces are not so thin that rounding turns them.
const COPLANAR_TURN: f64 = 2e-3;
/// Planes of rounded faces are fitted anew so many times.
const REFITS: usize = 5;
/// A plane face is this many times wider than the facets of the curved faces that it runs into.
pub(super) const WIDER: f64 = 3.0;
/// Or, if it is a low strip, this many times as deep behind its smooth edges.
const DEEPER: f64 = 8.0;
/// So many plane pieces that run into each other are facets of a curved face.
const CHAIN: usize = 6;
/// Or so many, if they fold by less than this, in radians.
const SLIGHT_CHAIN: usize = 3;
const CHORD_FOLD: f64 = 20.0 / 180.0 * std::f64::consts::PI;
/// So many regions are looked at between two facets.
const MOST_BETWEEN: usize = 64;
/// Below this fold, in radians, edges of a plane face say nothing: the surface may just be finely meshed.
const SLIGHT_FOLD: f64 = 1.0 / 180.0 * std::f64::consts::PI;
/// Unless the face is so many times wider than all behind them.
const MUCH_WIDER: f64 = 20.0;
/// Most edges are half of them, as exactly as lengths are known: a facet has two alike.
const HALF: f64 = 0.5 - 1e-6;

const NONE: u32 = u32::MAX;

/// Sets of two and more faces that lie in one plane, whose nodes are off it by up to `tolerance` mm. O(n log n).
pub(super) fn plane_regions(solid: &Solid, tolerance: f64) -> Vec<Vec<u32>> {
    let mut regions = Regions::new(solid, tolerance, true).faces;
    regions.retain(|faces| faces.len() > 1);
    regions
}

/// The plane through the nodes of faces that are nearly in one (least squares, by area); it faces as the first of them.
pub(super) fn fitted_plane(solid: &Solid, faces: &[u32]) -> Plane {
    let flat = mean_plane(solid, faces);
    let corners = || faces.iter().map(|f| (solid.mesh.corners(*f), solid.areas[*f as usize]));
    let weight: f64 = corners().map(|c| 3.0 * c.1).sum();
    let origin = corners().map(|([a, b, c], w)| (a + b + c) * w).sum::<DVec3>() / weight;
    let mut spread = DMat3::ZERO;
    for (corners, w) in corners() {
        for r in corners.map(|p| p - origin) {
            spread += DMat3::from_cols(r * r.x, r * r.y, r * r.z) * w;
        }
    }
    // What is left of the spread about the flat normal in the plane: the lean that makes it least.
    let [x, y] = flat.frame();
    let n = flat.normal;
    let (xx, xy, yy) = (x.dot(spread * x), x.dot(spread * y), y.dot(spread * y));
    let (xn, yn) = (x.dot(spread * n), y.dot(spread * n));
    let square = xx * yy - xy * xy;
    let is_broad = square > 1e-9 * (xx + yy) * (xx + yy);
    if !is_broad {
        return flat;
    }
    let (u, v) = ((xn * yy - yn * xy) / square, (yn * xx - xn * xy) / square);
    let normal = (n - x * u - y * v).normalize_or_zero();
    if normal == DVec3::ZERO { flat } else { Plane { normal, offset: normal.dot(origin) } }
}

/// The plane of faces that are in one.
pub(super) fn mean_plane(solid: &Solid, faces: &[u32]) -> Plane {
    let origin = solid.centroid(faces[0]);
    let (mut normal, mut moment, mut area) = (DVec3::ZERO, DVec3::ZERO, 0.0);
    for &f in faces {
        let a = solid.areas[f as usize];
        let own = solid.normals[f as usize] * a;
        normal += if own.dot(normal) < 0.0 { -own } else { own };
        moment += (solid.centroid(f) - origin) * a;
        area += a;
    }
    let normal = Some(normal.normalize_or_zero()).filter(|n| *n != DVec3::ZERO);
    let normal = normal.unwrap_or(solid.normals[faces[0] as usize]);
    let point = if area > 0.0 { origin + moment / area } else { origin };
    Plane { normal, offset: normal.dot(point) }
}

/// Largest connected sets of faces in one plane.
pub(super) struct Regions {
    /// Region of every face.
    pub(super) of_face: Vec<u32>,
    faces: Vec<Vec<u32>>,
    /// Mean normals.
    normals: Vec<DVec3>,
    /// Neighbours behind smooth edges, ordered by region, then by neighbour.
    beside: Vec<Beside>,
}

/// How large a region is, in mm.
#[derive(Clone, Copy, Debug)]
struct Size {
    /// Area over diameter.
    width: f64,
    /// Area over the length of its smooth edges.
    depth: f64,
}

/// A region behind the smooth edges of another.
#[derive(Clone, Copy, Debug)]
struct Beside {
    region: u32,
    other: u32,
    /// Length of the edges in mm.
    length: f64,
    /// Mean fold at them, in radians.
    fold: f64,
}

impl Regions {
    /// Finds them; nodes are off their planes by up to `tolerance` mm. `rounded`: planes of small faces say little of what is far from these,
    /// so that they are fitted anew as regions grow, and needles lie in any plane, however turned. O(n log n).
    pub(super) fn new(solid: &Solid, tolerance: f64, rounded: bool) -> Self {
        let n = solid.len();
        // Large faces first: their planes are the surest.
        let mut seeds: Vec<u32> = (0..n).collect();
        seeds.par_sort_unstable_by(|f, g| {
            solid.areas[*g as usize].total_cmp(&solid.areas[*f as usize]).then(f.cmp(g))
        });
        let mut of_face = vec![NONE; n as usize];
        let mut faces: Vec<Vec<u32>> = Vec::new();
        let mut stack = Vec::new();
        for seed in seeds {
            if of_face[seed as usize] != NONE {
                continue;
            }
            let number = faces.len() as u32;
            let normal = solid.normals[seed as usize];
            let mut plane = Plane { normal, offset: normal.dot(solid.centroid(seed)) };
            let (mut own, mut before) = (vec![seed], 0);
            of_face[seed as usize] = number;
            // What is rounded much has a better plane the more of it is known.
            for _ in 0..if rounded { REFITS } else { 1 } {
                if own.len() == before {
                    break;
                }
                if before > 0 {
                    plane = fitted_plane(solid, &own);
                }
                before = own.len();
                stack.append(&mut own);
                while let Some(f) = stack.pop() {
                    own.push(f);
                    for h in 3 * f..3 * f + 3 {
                        let g = solid.across(h);
                        if of_face[g as usize] == NONE && is_in_plane(solid, g, &plane, tolerance, rounded) {
                            of_face[g as usize] = number;
                            stack.push(g);
                        }
                    }
                }
            }
            faces.push(own);
        }
        let normal = |own: &Vec<u32>| -> DVec3 {
            own.iter().map(|f| solid.normals[*f as usize] * solid.areas[*f as usize]).sum()
        };
        let normals = faces.par_iter().map(|own| normal(own).normalize_or_zero()).collect();
        let beside = Self::smooth_neighbours(solid, &of_face);
        Self { of_face, faces, normals, beside }
    }

    /// Whether each region is a plane face, or else facets of a curved one. O(n).
    pub(super) fn planes(&self, solid: &Solid) -> Vec<bool> {
        let sizes = |(region, faces): (usize, &Vec<u32>)| self.size(solid, region as u32, faces);
        let sizes: Vec<Size> = self.faces.par_iter().enumerate().map(sizes).collect();
        let whole_stars = self.regions_with_whole_stars(solid);
        let mut is_plane: Vec<bool> = (0..self.faces.len())
            .into_par_iter()
            .map(|r| self.looks_plane(r as u32, &sizes, whole_stars[r]))
            .collect();
        self.settle_chains(&mut is_plane, &sizes);
        self.settle_bends(&mut is_plane);
        self.settle_specks(solid, &mut is_plane);
        is_plane
    }

    /// Specks that run smoothly into curved faces, or into each other, along most of their smooth edges belong to these: they are
    /// needles of a tessellation that lie in one plane by chance.
    fn settle_specks(&self, solid: &Solid, is_plane: &mut [bool]) {
        let speck = SPECK * SPECK * solid.size * solid.size;
        let area = |faces: &Vec<u32>| faces.iter().map(|f| solid.areas[*f as usize]).sum::<f64>();
        let is_speck: Vec<bool> =
            self.faces.iter().zip(&*is_plane).map(|(faces, plane)| *plane && area(faces) < speck).collect();
        let runs_on = |region: u32, is_plane: &[bool]| {
            let (mut curved, mut smooth) = (0.0, 0.0);
            for b in self.beside(region) {
                smooth += b.length;
                if !is_plane[b.other as usize] || is_speck[b.other as usize] {
                    curved += b.length;
                }
            }
            smooth > 0.0 && curved >= HALF * smooth
        };
        let curved: Vec<u32> =
            (0..self.faces.len() as u32).filter(|r| is_speck[*r as usize] && runs_on(*r, is_plane)).collect();
        curved.into_iter().for_each(|r| is_plane[r as usize] = false);
    }

    fn size(&self, solid: &Solid, region: u32, faces: &[u32]) -> Size {
        let area: f64 = faces.iter().map(|f| solid.areas[*f as usize]).sum();
        let smooth: f64 = self.beside(region).iter().map(|b| b.length).sum();
        Size { width: width(solid, faces), depth: area / smooth.max(f64::MIN_POSITIVE) }
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

    /// A facet of a curved face has, behind its smooth edges, another about as wide that is turned by less than a sharp edge;
    /// slivers may lie between (a thickened mesh has one at every fold). A plane face that runs into a fillet has not.
    fn looks_plane(&self, region: u32, sizes: &[Size], whole_star: bool) -> bool {
        let beside = self.beside(region);
        let smooth: f64 = beside.iter().map(|b| b.length).sum();
        if smooth == 0.0 {
            return true;
        }
        let fold = beside.iter().map(|b| b.length * b.fold).sum::<f64>() / smooth;
        let widest = beside.iter().map(|b| sizes[b.other as usize].width).fold(0.0, f64::max);
        let tells = fold > SLIGHT_FOLD || sizes[region as usize].width > MUCH_WIDER * widest;
        tells && (whole_star || !self.goes_on(region, sizes))
    }

    /// Whether behind most of its smooth edges there are regions about as wide.
    fn goes_on(&self, region: u32, sizes: &[Size]) -> bool {
        let wide = |b: &&Beside| self.leads_to_a_wide_one(region, b.other, sizes);
        let length = |all: &mut dyn Iterator<Item = &Beside>| all.map(|b| b.length).sum::<f64>();
        let beside = self.beside(region);
        length(&mut beside.iter().filter(wide)) >= HALF * length(&mut beside.iter())
    }

    /// Facets of a curved face that were divided where they lie, as remeshing does, look plane one by one. Many in a row are no
    /// folded plate, nor are those that run into facets that do not look so.
    fn settle_chains(&self, is_plane: &mut [bool], sizes: &[Size]) {
        let is_link: Vec<bool> = (0..self.faces.len() as u32)
            .into_par_iter()
            .map(|r| is_plane[r as usize] && !self.beside(r).is_empty() && self.goes_on(r, sizes))
            .collect();
        let mut seen = vec![false; is_link.len()];
        for first in 0..is_link.len() as u32 {
            if !is_link[first as usize] || seen[first as usize] {
                continue;
            }
            let (mut chain, mut at, mut runs_on, mut fold) = (vec![first], 0, false, 0.0f64);
            seen[first as usize] = true;
            while at < chain.len() {
                let width = sizes[chain[at] as usize].width;
                for b in self.beside(chain[at]) {
                    let ratio = sizes[b.other as usize].width / width;
                    runs_on |= !is_plane[b.other as usize] && (1.0 / WIDER..WIDER).contains(&ratio);
                    if is_link[b.other as usize] {
                        fold = fold.max(b.fold);
                    }
                    if is_link[b.other as usize] && !seen[b.other as usize] {
                        seen[b.other as usize] = true;
                        chain.push(b.other);
                    }
                }
                at += 1;
            }
            let many = if fold < CHORD_FOLD { SLIGHT_CHAIN } else { CHAIN };
            if chain.len() >= many || runs_on {
                chain.iter().for_each(|r| is_plane[*r as usize] = false);
            }
        }
    }

    /// Whether over narrow regions, from one behind an edge of `region` on, a wide one is reached that is not much turned.
    fn leads_to_a_wide_one(&self, region: u32, first: u32, sizes: &[Size]) -> bool {
        let Size { width, depth } = sizes[region as usize];
        let mut seen = vec![region, first];
        let mut at = 1;
        while at < seen.len() && seen.len() < MOST_BETWEEN {
            let r = seen[at];
            at += 1;
            if self.normals[region as usize].dot(self.normals[r as usize]) < SHARP.cos() {
                continue;
            }
            if sizes[r as usize].width >= width / WIDER && sizes[r as usize].depth >= depth / DEEPER {
                return true;
            }
            for b in self.beside(r) {
                if !seen.contains(&b.other) {
                    seen.push(b.other);
                }
            }
        }
        false
    }

    /// The regions behind the smooth edges of one.
    fn beside(&self, region: u32) -> &[Beside] {
        let from = self.beside.partition_point(|b| b.region < region);
        let to = self.beside.partition_point(|b| b.region <= region);
        &self.beside[from..to]
    }

    fn smooth_neighbours(solid: &Solid, of_face: &[u32]) -> Vec<Beside> {
        let smooth = |h: u32| {
            let [region, other] = [h / 3, solid.across(h)].map(|f| of_face[f as usize]);
            let cosine = solid.fold_cosine(h);
            (region != other && cosine > SHARP.cos()).then(|| {
                let fold = cosine.clamp(-1.0, 1.0).acos();
                Beside { region, other, length: solid.length(h), fold }
            })
        };
        let mut all: Vec<Beside> = (0..3 * solid.len()).into_par_iter().filter_map(smooth).collect();
        all.par_sort_by_key(|b| (b.region, b.other));
        let same = |a: &Beside, b: &Beside| (a.region, a.other) == (b.region, b.other);
        let joined = |run: &[Beside]| {
            let length: f64 = run.iter().map(|b| b.length).sum();
            let fold = run.iter().map(|b| b.length * b.fold).sum::<f64>() / length.max(f64::MIN_POSITIVE);
            Beside { length, fold, ..run[0] }
        };
        all.chunk_by(same).map(joined).collect()
    }

    /// Facets that run into one other facet only, and that one into no third: a plate bent once, not a curved one.
    fn settle_bends(&self, is_plane: &mut [bool]) {
        let smooth_neighbours = |region: u32, is_plane: &[bool]| -> Vec<u32> {
            let curved = self.beside(region).iter().filter(|b| !is_plane[b.other as usize]);
            curved.map(|b| b.other).take(2).collect()
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

/// Whether a face lies in a plane. Where coordinates are rounded, needles may be turned over.
fn is_in_plane(solid: &Solid, f: u32, plane: &Plane, tolerance: f64, rounded: bool) -> bool {
    let corners = solid.mesh.corners(f);
    let near = corners.iter().all(|p| plane.height(*p).abs() < tolerance);
    let same_side = || solid.normals[f as usize].dot(plane.normal) > 0.5;
    let is_needle = || rounded && 2.0 * solid.areas[f as usize] < 2.0 * tolerance * longest_side(&corners);
    near && (is_needle() || same_side() && is_turned_little(solid, f, plane.normal, &corners, tolerance))
}

/// Whether a face has about the given normal. One as thin as the tolerance may stand at any angle and still be near.
fn is_turned_little(solid: &Solid, f: u32, normal: DVec3, corners: &[DVec3; 3], tolerance: f64) -> bool {
    let turn = solid.normals[f as usize].cross(normal).length_squared();
    if turn < COPLANAR_TURN * COPLANAR_TURN {
        return true;
    }
    let height = 2.0 * solid.areas[f as usize] / longest_side(corners);
    turn.sqrt() < 2.0 * tolerance / height.max(f64::MIN_POSITIVE)
}

/// About how wide some faces are, in mm: area over diameter.
pub(super) fn width(solid: &Solid, faces: &[u32]) -> f64 {
    let area: f64 = faces.iter().map(|f| solid.areas[*f as usize]).sum();
    let weighed =
        |f: &u32| solid.mesh.corners(*f).into_iter().sum::<DVec3>() * (solid.areas[*f as usize] / 3.0);
    let centre = faces.iter().map(weighed).sum::<DVec3>() / area.max(f64::MIN_POSITIVE);
    // From the node that is farthest from the centre to the one that is farthest from that.
    let farthest = |from: DVec3| {
        let nodes = faces.iter().flat_map(|f| solid.mesh.corners(*f));
        nodes.max_by(|p, q| p.distance_squared(from).total_cmp(&q.distance_squared(from))).unwrap_or(from)
    };
    let end = farthest(centre);
    area / end.distance(farthest(end)).max(f64::MIN_POSITIVE)
}
