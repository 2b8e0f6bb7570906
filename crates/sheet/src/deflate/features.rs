//! Small features, told from the mesh alone (Sheen et al. 2008, section 5): fillets and chamfers, through holes, and what stands
//! alone on a wall.
//!
//! Nothing is cut out of the solid. A feature that goes is a set of face groups that the mid-surface is made without, and the
//! outline of the wall about it is left out, so that the wall goes on below.

use std::collections::BTreeSet;

use glam::DVec3;

use super::DeflateOptions;
use super::blends::Blends;
use super::faces::{Face, Faces};
use super::middle::ThicknessStep;
use super::report::Feature;
use super::segments::Segments;
use super::shape::Shape;
use super::solid::Solid;
use super::walls::Walls;

/// A hollow boss has a skin inside and outside, each no larger than that of a cube about it.
const BOTH_SIDES: f64 = 2.0;
/// What stands on a wall is small up to this many thicknesses.
const SMALL: f64 = 10.0;
/// Folds within blends and at their borders are less than this, in radians.
const OBLIQUE: f64 = 70.0 / 180.0 * std::f64::consts::PI;
/// Faces of a hole look at its axis: the mean share of the way that they do.
const HOLLOW: f64 = 0.3;

/// Radii that differ by less than this share are one.
const ONE_RADIUS: f64 = 0.01;
/// What is said of features that have no middle.
const NO_MIDDLE: &str = "no mid-surface can hold it: it goes all the same";

/// What was found, and which groups go with what is removed.
#[derive(Debug)]
pub(super) struct Features {
    pub(super) list: Vec<Feature>,
    /// Whether each group of the solid is left out.
    pub(super) gone: Vec<bool>,
}

/// A set of groups that hang together.
struct Set {
    groups: Vec<u32>,
    /// Groups about it, ascending.
    about: Vec<u32>,
}

impl Features {
    /// Takes back what was to be removed: the mid-surface would not be sound.
    pub(super) fn undo(&mut self) {
        for feature in
            self.list.iter_mut().filter(|f| f.removed && matches!(f.kind, "hole" | "boss" | "pocket"))
        {
            feature.removed = false;
            feature.kept_because = Some("kept: without it the mid-surface would cross itself");
        }
        self.gone.fill(false);
    }

    /// Lists a step in thickness; whether it is to go, which the middles see to.
    pub(super) fn add_step(
        &mut self,
        solid: &Solid,
        segments: &Segments,
        step: &ThicknessStep,
        options: &DeflateOptions,
    ) -> bool {
        let faces = &segments.group(step.group).faces;
        let small = options.simplify.is_some_and(|size| step.height <= size);
        let asked = options.keep.contains(&self.list.len());
        self.list.push(Feature {
            kind: "step",
            at: middle(solid, faces),
            size: step.height,
            faces: faces.len(),
            removed: small && !asked,
            kept_because: asked.then_some("kept as asked"),
        });
        small && !asked
    }

    /// Finds the features and decides which go. O(n log n), and walls times groups about them.
    pub(super) fn new(
        solid: &Solid,
        segments: &Segments,
        walls: &Walls,
        blends: &Blends,
        geometry: &Faces,
        options: &DeflateOptions,
    ) -> Self {
        let links = Links::new(solid, segments);
        let mut found: Vec<(Feature, Vec<u32>)> = Vec::new();
        let is_wall = |g: u32| walls.is_wall[g as usize];
        for set in links.sets(|g| !is_wall(g) && blends.is_blend[g as usize]) {
            if let Some(mut feature) = blend(solid, segments, walls, blends, &set) {
                if feature.kind != "chamfer" {
                    feature.size = radius(segments, geometry, &set.groups).unwrap_or(feature.size);
                }
                found.push((feature, Vec::new()));
            }
        }
        for set in links.sets(|g| !is_wall(g)) {
            if let Some(mut feature) = hole(solid, segments, walls, &set) {
                let round = radius(segments, geometry, &set.groups);
                feature.size = round.map_or(feature.size, |radius| 2.0 * radius);
                found.push((feature, set.groups));
            }
        }
        for g in (0..segments.groups.len() as u32).filter(|g| is_wall(*g)) {
            found.extend(standing_on(solid, segments, walls, &links, g));
        }
        let mut features = Self { list: Vec::new(), gone: vec![false; segments.groups.len()] };
        for (number, (mut feature, groups)) in found.into_iter().enumerate() {
            let small = options.simplify.is_some_and(|size| feature.size <= size);
            // A lump without walls of its own has no middle.
            let lump = feature.kind == "boss" && !groups.iter().any(|g| is_wall(*g));
            let kept = options.keep.contains(&number);
            if !groups.is_empty() {
                if lump {
                    feature.removed = true;
                    feature.kept_because = kept.then_some(NO_MIDDLE);
                    groups.iter().for_each(|g| features.gone[*g as usize] = true);
                } else if kept {
                    feature.kept_because = Some("kept as asked");
                } else if small && feature.kept_because.is_none() {
                    feature.removed = true;
                    groups.iter().for_each(|g| features.gone[*g as usize] = true);
                } else if !small {
                    feature.kept_because = None;
                }
            } else if kept {
                feature.kept_because = Some(NO_MIDDLE);
            }
            features.list.push(feature);
        }
        features
    }
}

/// The radius of what is round of some groups, if most of them is.
fn radius(segments: &Segments, geometry: &Faces, groups: &[u32]) -> Option<f64> {
    let mut areas: Vec<(f64, f64)> = Vec::new();
    let own: BTreeSet<u32> = groups.iter().copied().collect();
    let is_own = |face: &&Face| own.contains(&segments.of(face.triangles[0]));
    for face in geometry.list.iter().filter(is_own) {
        let radius = match face.shape {
            Shape::Cylinder { radius, .. } | Shape::Sphere { radius, .. } => radius,
            Shape::Torus { minor, .. } => minor,
            _ => continue,
        };
        match areas.iter_mut().find(|a| (a.0 - radius).abs() < ONE_RADIUS * radius) {
            Some(known) => known.1 += face.area,
            None => areas.push((radius, face.area)),
        }
    }
    let most = areas.into_iter().max_by(|a, b| a.1.total_cmp(&b.1))?;
    (most.1 > 0.5 * area(segments, groups)).then_some(most.0)
}

/// Fillets, rounds and chamfers: strips that walls run into and that no mid-surface can hold.
fn blend(solid: &Solid, segments: &Segments, walls: &Walls, blends: &Blends, set: &Set) -> Option<Feature> {
    let faces: Vec<u32> = set.groups.iter().flat_map(|g| segments.group(*g).faces.iter().copied()).collect();
    let blended =
        faces.iter().flat_map(|f| solid.mesh.faces[*f as usize]).any(|v| !blends.behind(v).is_empty());
    if !blended || !set.about.iter().any(|g| walls.is_wall[*g as usize]) {
        return None;
    }
    let own: BTreeSet<u32> = set.groups.iter().copied().collect();
    let (mut outline, mut concave, mut turn) = (0.0, 0.0, 0.0);
    for h in faces.iter().flat_map(|f| 3 * f..3 * f + 3) {
        let other = segments.of(solid.across(h));
        let length = solid.length(h);
        if !own.contains(&other) {
            outline += length;
        }
        // Folds along the strip add up to its turn; edges within it are met from both sides.
        let cosine = solid.fold_cosine(h).clamp(-1.0, 1.0);
        if cosine > OBLIQUE.cos() {
            let bend = length * cosine.acos() / if own.contains(&other) { 2.0 } else { 1.0 };
            turn += bend;
            concave += if solid.is_convex(h) { 0.0 } else { bend };
        }
    }
    let width = 2.0 * area(segments, &set.groups) / f64::max(outline, f64::MIN_POSITIVE);
    let plane = set.groups.iter().all(|g| segments.group(*g).plane.is_some());
    let kind = match (plane, concave > 0.5 * turn) {
        (true, _) => "chamfer",
        (false, true) => "fillet",
        (false, false) => "round",
    };
    // A strip turns by its width over its radius.
    let size = if plane { width } else { area(segments, &set.groups) / f64::max(turn, f64::MIN_POSITIVE) };
    (size < SMALL * walls.max_thickness).then(|| Feature {
        kind,
        at: middle(solid, &faces),
        size,
        faces: faces.len(),
        removed: true,
        kept_because: None,
    })
}

/// A set of faces without partners between a wall and its partner, hollow all round.
fn hole(solid: &Solid, segments: &Segments, walls: &Walls, set: &Set) -> Option<Feature> {
    let [g, other] = set.about[..] else { return None };
    let pair = walls.partners(g).iter().find(|p| p.partner == other)?;
    let faces: Vec<u32> = set.groups.iter().flat_map(|g| segments.group(*g).faces.iter().copied()).collect();
    let centre = middle(solid, &faces);
    let (mut inward, mut reach) = (0.0, 0.0f64);
    let axis = segments.group(g).plane.map_or(DVec3::ZERO, |p| p.normal);
    for &f in &faces {
        let out = solid.centroid(f) - centre;
        inward -= solid.normals[f as usize].dot(out) * solid.areas[f as usize];
        for p in solid.mesh.corners(f) {
            let p = p - centre;
            reach = reach.max((p - axis * axis.dot(p)).length());
        }
    }
    // A hole goes through: its wall is about as high as the walls that it joins are apart.
    let through = area(segments, &set.groups) > 0.5 * pair.thickness * 4.0 * reach;
    let hollow = inward > HOLLOW * reach * area(segments, &set.groups);
    (hollow && through).then(|| Feature {
        kind: "hole",
        at: centre,
        size: 2.0 * reach,
        faces: faces.len(),
        removed: false,
        kept_because: in_a_plane(segments, &set.about),
    })
}

/// Outlines are left out of plane pieces only.
fn in_a_plane(segments: &Segments, groups: &[u32]) -> Option<&'static str> {
    let plane = groups.iter().all(|g| segments.group(*g).plane.is_some());
    (!plane).then_some("kept: the wall about it is curved")
}

/// What hangs on one wall alone: bosses and the like.
fn standing_on(
    solid: &Solid,
    segments: &Segments,
    walls: &Walls,
    links: &Links,
    g: u32,
) -> Vec<(Feature, Vec<u32>)> {
    let Some(plane) = segments.group(g).plane else { return Vec::new() };
    let partners: Vec<u32> = walls.partners(g).iter().map(|p| p.partner).collect();
    let mut found = Vec::new();
    for set in links.behind(g) {
        // What holds a partner of the wall is the rest of the part.
        let large = SMALL * walls.max_thickness;
        let far_too_large = area(segments, &set.groups) > BOTH_SIDES * 6.0 * large * large;
        if far_too_large || set.groups.iter().any(|s| partners.contains(s)) {
            continue;
        }
        let faces: Vec<u32> =
            set.groups.iter().flat_map(|s| segments.group(*s).faces.iter().copied()).collect();
        let centre = middle(solid, &faces);
        let (mut reach, mut low, mut high) = (0.0f64, 0.0f64, 0.0f64);
        for p in faces.iter().flat_map(|f| solid.mesh.corners(*f)) {
            let height = plane.height(p);
            (low, high) = (low.min(height), high.max(height));
            let p = p - centre;
            reach = reach.max((p - plane.normal * plane.normal.dot(p)).length());
        }
        let kind = if high > -low { "boss" } else { "pocket" };
        let size = (2.0 * reach).max(high - low);
        // Ribs and the like are no small features.
        if size > SMALL * walls.max_thickness {
            continue;
        }
        let feature =
            Feature { kind, at: centre, size, faces: faces.len(), removed: false, kept_because: None };
        found.push((feature, set.groups));
    }
    found
}

fn area(segments: &Segments, groups: &[u32]) -> f64 {
    groups.iter().map(|g| segments.group(*g).area).sum()
}

fn middle(solid: &Solid, faces: &[u32]) -> DVec3 {
    let area: f64 = faces.iter().map(|f| solid.areas[*f as usize]).sum();
    let sum: DVec3 = faces.iter().map(|f| solid.centroid(*f) * solid.areas[*f as usize]).sum();
    sum / area.max(f64::MIN_POSITIVE)
}

/// Which groups have edges in common.
struct Links {
    /// Ascending.
    pairs: Vec<[u32; 2]>,
    groups: usize,
}

impl Links {
    fn new(solid: &Solid, segments: &Segments) -> Self {
        let ends = |h: u32| [h / 3, solid.across(h)].map(|f| segments.of(f));
        let mut pairs: Vec<[u32; 2]> = (0..3 * solid.len()).map(ends).filter(|[a, b]| a != b).collect();
        pairs.sort_unstable();
        pairs.dedup();
        Self { pairs, groups: segments.groups.len() }
    }

    fn of(&self, g: u32) -> impl Iterator<Item = u32> {
        let from = self.pairs.partition_point(|p| p[0] < g);
        self.pairs[from..].iter().take_while(move |p| p[0] == g).map(|p| p[1])
    }

    /// Connected sets of wanted groups.
    fn sets(&self, wanted: impl Fn(u32) -> bool) -> Vec<Set> {
        self.grown((0..self.groups as u32).filter(|g| wanted(*g)).collect(), &wanted)
    }

    /// Connected sets of groups that are left when one is taken out, which touch it.
    fn behind(&self, g: u32) -> Vec<Set> {
        self.grown(self.of(g).collect(), &|other| other != g)
    }

    fn grown(&self, seeds: Vec<u32>, wanted: &dyn Fn(u32) -> bool) -> Vec<Set> {
        let mut seen = vec![false; self.groups];
        let mut sets = Vec::new();
        for seed in seeds {
            if seen[seed as usize] {
                continue;
            }
            seen[seed as usize] = true;
            let mut set = Set { groups: vec![seed], about: Vec::new() };
            let mut at = 0;
            while at < set.groups.len() {
                for other in self.of(set.groups[at]) {
                    if !wanted(other) {
                        set.about.push(other);
                    } else if !seen[other as usize] {
                        seen[other as usize] = true;
                        set.groups.push(other);
                    }
                }
                at += 1;
            }
            set.about.sort_unstable();
            set.about.dedup();
            sets.push(set);
        }
        sets
    }
}
