//! A bounding volume hierarchy with four children a node.
//!
//! Boxes are f32, rounded outward and relative to the middle of the mesh; what is in the leaves is decided in f64 by
//! the caller. Built top-down by the surface area heuristic in 16 bins (Wald 2007).

use glam::{DVec3, Vec4};

use crate::TriMesh;

/// Most faces in a leaf; every leaf has that many places in [`Bvh::order`].
pub(super) const LEAF: usize = 4;
const BINS: usize = 16;
/// Below this depth of binary splits, ranges are halved, so that the depth stays bounded on any input.
const MAX_SAH_DEPTH: u32 = 40;
/// Room for the pending children of a walk from the root: three a level.
pub(super) const STACK: usize = 3 * (MAX_SAH_DEPTH as usize + 32);

/// Four boxes side by side; an unused slot has an empty box.
#[derive(Clone, Debug)]
#[repr(align(64))]
pub(super) struct Node {
    pub(super) lo: [Vec4; 3],
    pub(super) hi: [Vec4; 3],
    pub(super) children: [Child; 4],
}

/// A node, or a run of faces.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Child(u32);

const LEAF_BIT: u32 = 1 << 31;

impl Child {
    pub(super) const ROOT: Self = Self(0);

    fn leaf(number: usize, count: usize) -> Self {
        Self(LEAF_BIT | (number as u32) << 3 | count as u32)
    }

    /// The places in [`Bvh::order`] of a leaf (beginning at a multiple of [`LEAF`]), or the node's number.
    #[inline]
    pub(super) fn get(self) -> Result<std::ops::Range<usize>, usize> {
        if self.0 & LEAF_BIT == 0 {
            return Err(self.0 as usize);
        }
        let start = ((self.0 & !LEAF_BIT) as usize >> 3) * LEAF;
        Ok(start..start + (self.0 & 7) as usize)
    }
}

/// No face.
pub(super) const VACANT: u32 = u32::MAX;

/// The hierarchy over the faces of a mesh.
#[derive(Clone, Debug)]
pub(super) struct Bvh {
    pub(super) nodes: Vec<Node>,
    /// Face numbers, leaf by leaf; [`VACANT`] in the places that a leaf leaves over.
    pub(super) order: Vec<u32>,
    /// What boxes are relative to.
    pub(super) origin: DVec3,
    /// Largest absolute coordinate of a box.
    pub(super) extent: f64,
}

#[derive(Clone, Copy)]
struct Box3 {
    lo: DVec3,
    hi: DVec3,
}

impl Box3 {
    const EMPTY: Self = Self { lo: DVec3::INFINITY, hi: DVec3::NEG_INFINITY };

    #[inline]
    fn grow(&mut self, other: &Self) {
        self.lo = self.lo.min(other.lo);
        self.hi = self.hi.max(other.hi);
    }

    #[inline]
    fn half_area(&self) -> f64 {
        let d = (self.hi - self.lo).max(DVec3::ZERO);
        d.x * d.y + d.y * d.z + d.z * d.x
    }
}

/// A range of faces yet to be split.
#[derive(Clone, Copy)]
struct Part {
    start: usize,
    end: usize,
    bounds: Box3,
    depth: u32,
}

impl Bvh {
    /// Builds the hierarchy over all faces with finite corners. O(n log n).
    pub(super) fn new(mesh: &TriMesh) -> Self {
        let [lo, hi] = mesh.bounds().unwrap_or([DVec3::ZERO; 2]);
        let origin = Some((lo + hi) / 2.0).filter(|o| o.is_finite()).unwrap_or(DVec3::ZERO);
        let mut boxes = Vec::with_capacity(mesh.faces.len());
        for f in 0..mesh.faces.len() as u32 {
            let [a, b, c] = mesh.corners(f).map(|p| p - origin);
            if a.is_finite() && b.is_finite() && c.is_finite() {
                boxes.push((Box3 { lo: a.min(b).min(c), hi: a.max(b).max(c) }, f));
            }
        }
        let mut bounds = Box3::EMPTY;
        for (face, _) in &boxes {
            bounds.grow(face);
        }
        let extent = bounds.lo.abs().max(bounds.hi.abs()).max_element().max(0.0);
        let extent = if boxes.is_empty() { 0.0 } else { extent };
        let mut bvh =
            Self { nodes: Vec::with_capacity(boxes.len() / 4 + 1), order: Vec::new(), origin, extent };
        let whole = Part { start: 0, end: boxes.len(), bounds, depth: 0 };
        let mut pending = vec![(0usize, whole)];
        bvh.nodes.push(Node::EMPTY);
        while let Some((node, part)) = pending.pop() {
            for (slot, part) in split_in_four(&mut boxes, part).into_iter().enumerate() {
                let count = part.end - part.start;
                let child = if count <= LEAF {
                    let number = bvh.order.len() / LEAF;
                    bvh.order.extend(boxes[part.start..part.end].iter().map(|(_, f)| *f));
                    bvh.order.resize((number + 1) * LEAF, VACANT);
                    Child::leaf(number, count)
                } else {
                    bvh.nodes.push(Node::EMPTY);
                    pending.push((bvh.nodes.len() - 1, part));
                    Child(bvh.nodes.len() as u32 - 1)
                };
                bvh.nodes[node].set(slot, &part.bounds, child);
            }
        }
        bvh
    }

    /// The same hierarchy over the same faces with their nodes elsewhere, finite ones: boxes follow what is in them. The less
    /// the nodes have moved, the better it serves. O(n).
    pub(super) fn refit(&self, mesh: &TriMesh) -> Self {
        let [lo, hi] = mesh.bounds().unwrap_or([DVec3::ZERO; 2]);
        let mut bvh = Self { origin: (lo + hi) / 2.0, ..self.clone() };
        let mut boxes = vec![Box3::EMPTY; bvh.nodes.len()];
        // From the bottom up: children have larger numbers than their parent.
        for number in (0..bvh.nodes.len()).rev() {
            for slot in 0..4 {
                let child = bvh.nodes[number].children[slot];
                let mut bounds = Box3::EMPTY;
                match child.get() {
                    Ok(leaf) => {
                        for f in &bvh.order[leaf] {
                            let [a, b, c] = mesh.corners(*f).map(|p| p - bvh.origin);
                            bounds.grow(&Box3 { lo: a.min(b).min(c), hi: a.max(b).max(c) });
                        }
                    }
                    Err(below) => bounds = boxes[below],
                }
                bvh.nodes[number].set(slot, &bounds, child);
                boxes[number].grow(&bounds);
            }
        }
        bvh.extent = boxes.first().map_or(0.0, |b| b.lo.abs().max(b.hi.abs()).max_element());
        if bvh.order.is_empty() {
            bvh.extent = 0.0;
        }
        bvh
    }
}

impl Node {
    const EMPTY: Self =
        Self { lo: [Vec4::INFINITY; 3], hi: [Vec4::NEG_INFINITY; 3], children: [Child(LEAF_BIT); 4] };

    fn set(&mut self, slot: usize, bounds: &Box3, child: Child) {
        for axis in 0..3 {
            self.lo[axis][slot] = round_down(bounds.lo[axis]);
            self.hi[axis][slot] = -round_down(-bounds.hi[axis]);
        }
        self.children[slot] = child;
    }
}

fn round_down(value: f64) -> f32 {
    let near = value as f32;
    if f64::from(near) > value { near.next_down() } else { near }
}

/// Splits the part with the largest box again and again, until there are four parts or all are leaves.
fn split_in_four(boxes: &mut [(Box3, u32)], part: Part) -> Vec<Part> {
    let mut parts = vec![part];
    while parts.len() < 4 {
        let weight = |p: &Part| if p.end - p.start > LEAF { p.bounds.half_area() } else { -1.0 };
        let largest = (0..parts.len()).max_by(|a, b| weight(&parts[*a]).total_cmp(&weight(&parts[*b])));
        let Some(k) = largest.filter(|k| parts[*k].end - parts[*k].start > LEAF) else { break };
        let [left, right] = split(boxes, parts[k]);
        parts[k] = left;
        parts.insert(k + 1, right);
    }
    parts
}

/// Splits a part in two that are not empty.
fn split(boxes: &mut [(Box3, u32)], part: Part) -> [Part; 2] {
    let faces = &mut boxes[part.start..part.end];
    let mut centres = Box3::EMPTY;
    for (face, _) in faces.iter() {
        let centre = face.lo + face.hi;
        centres.grow(&Box3 { lo: centre, hi: centre });
    }
    let span = centres.hi - centres.lo;
    let mut best: Option<(f64, usize, usize)> = None;
    let scale =
        DVec3::from_array(span.to_array().map(|s| if s > 0.0 { BINS as f64 * 0.999_999 / s } else { 0.0 }));
    let bin = |face: &Box3, axis: usize| {
        (((face.lo[axis] + face.hi[axis] - centres.lo[axis]) * scale[axis]) as usize).min(BINS - 1)
    };
    if part.depth < MAX_SAH_DEPTH && part.end - part.start > 2 {
        for axis in 0..3 {
            if span[axis] <= 0.0 {
                continue;
            }
            let mut bins = [(Box3::EMPTY, 0usize); BINS];
            for (face, _) in faces.iter() {
                let bin = &mut bins[bin(face, axis)];
                bin.0.grow(face);
                bin.1 += 1;
            }
            let mut after = [0.0; BINS];
            let (mut bounds, mut count) = (Box3::EMPTY, 0);
            for k in (1..BINS).rev() {
                bounds.grow(&bins[k].0);
                count += bins[k].1;
                after[k] = if count == 0 { f64::INFINITY } else { bounds.half_area() * count as f64 };
            }
            (bounds, count) = (Box3::EMPTY, 0);
            for k in 1..BINS {
                bounds.grow(&bins[k - 1].0);
                count += bins[k - 1].1;
                let cost = bounds.half_area() * count as f64 + after[k];
                if count > 0 && cost.is_finite() && best.is_none_or(|b| cost < b.0) {
                    best = Some((cost, axis, k));
                }
            }
        }
    }
    let middle = match best {
        Some((_, axis, at)) => {
            // Stable: the order of faces does not depend on how the partition moves them.
            let (left, right): (Vec<_>, Vec<_>) = faces.iter().partition(|(face, _)| bin(face, axis) < at);
            faces[..left.len()].copy_from_slice(&left);
            faces[left.len()..].copy_from_slice(&right);
            left.len()
        }
        None => {
            let axis =
                if span.x >= span.y && span.x >= span.z { 0 } else { 1 + usize::from(span.z > span.y) };
            let key = |f: &(Box3, u32)| f.0.lo[axis] + f.0.hi[axis];
            faces.sort_by(|a, b| key(a).total_cmp(&key(b)).then(a.1.cmp(&b.1)));
            faces.len() / 2
        }
    };
    let bounds = |faces: &[(Box3, u32)]| {
        let mut bounds = Box3::EMPTY;
        for (face, _) in faces {
            bounds.grow(face);
        }
        bounds
    };
    let (left, right) = faces.split_at(middle);
    let at = part.start + middle;
    let depth = part.depth + 1;
    [
        Part { start: part.start, end: at, bounds: bounds(left), depth },
        Part { start: at, end: part.end, bounds: bounds(right), depth },
    ]
}
