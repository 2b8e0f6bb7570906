//! Adaptive splits (T5, beyond the paper): of the splits of a template only those stay that the shape needs.
//!
//! The surfaces are solved on the uniformly split template, whose nodes are exact and whose factor is kept; then every face of
//! every level asks whether it lies near enough to all finest nodes in it. One that does not is split in four, one beside it
//! that has a single split side in two (red-green refinement; Bank, Sherman & Weiser 1983). Nodes are those of the uniform
//! garment, so what stays does not move, and a joint's sides keep their nodes one to one: whether a side is split is asked of
//! its welded middle.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh_kernel::body::{Body, ChainSpec, JointSpec, SurfaceSpec};
use rayon::prelude::*;

use crate::error::TemplateError;
use crate::refine::{NONE, Refined};

/// Which faces of a split template are split themselves: `[level][surface][face]`.
type Splits = Vec<Vec<Vec<bool>>>;

/// Takes splits back wherever what is left lies within `tolerance` (mm) of all nodes of the finest level. Faces that
/// `refused` names, by surface and as welded nodes, are split in spite of that, as long as they can be.
///
/// O(nodes · levels) and the body's building.
///
/// # Errors
/// [`TemplateError::Kernel`].
pub(crate) fn adapted(
    refined: &Refined,
    positions: &[DVec3],
    tolerance: f64,
    mut refused: impl FnMut(&[[u32; 3]]) -> Vec<bool>,
) -> Result<Refined, TemplateError> {
    let adapting = Adapting { refined, positions };
    let mut splits = adapting.wanted(tolerance);
    loop {
        let active = adapting.closed(&mut splits);
        let leaves = adapting.leaves(&splits, &active);
        let all: Vec<[u32; 3]> = leaves.iter().flatten().map(|leaf| leaf.welded).collect();
        let mut refused = refused(&all).into_iter();
        let mut more = false;
        for (s, leaves) in leaves.iter().enumerate() {
            for leaf in leaves.iter().filter(|_| refused.next() == Some(true)) {
                if let Some(split) = splits.get_mut(leaf.level).and_then(|level| level[s].get_mut(leaf.face))
                {
                    more |= !std::mem::replace(split, true);
                }
            }
        }
        if !more {
            return adapting.rebuilt(&leaves, &active);
        }
    }
}

/// A face that stays, and of which face of which level it is all or a part.
struct Leaf {
    level: usize,
    face: usize,
    /// Nodes of the surface.
    nodes: [u32; 3],
    welded: [u32; 3],
}

struct Adapting<'a> {
    refined: &'a Refined,
    positions: &'a [DVec3],
}

impl Adapting<'_> {
    fn levels(&self) -> usize {
        self.refined.level_faces.len() - 1
    }

    fn surfaces(&self) -> usize {
        self.refined.ids.len()
    }

    fn weld(&self, s: usize, v: u32) -> u32 {
        self.refined.weld[s][v as usize]
    }

    fn at(&self, s: usize, v: u32) -> DVec3 {
        self.positions[self.weld(s, v) as usize]
    }

    /// The middles of a face's sides, in their order; they are nodes of the next level.
    fn middles(&self, level: usize, s: usize, face: usize) -> [u32; 3] {
        self.refined.level_faces[level + 1][s][4 * face + 3]
    }

    /// The faces that are too far from what lies in them.
    fn wanted(&self, tolerance: f64) -> Splits {
        (0..self.levels())
            .map(|level| {
                let of_surface = |s: usize| -> Vec<bool> {
                    let faces = &self.refined.level_faces[level][s];
                    (0..faces.len())
                        .into_par_iter()
                        .map(|f| {
                            let corners = faces[f].map(|v| self.at(s, v));
                            !self.is_near(level, s, f, &corners, [true; 3], tolerance)
                        })
                        .collect()
                };
                (0..self.surfaces()).map(of_surface).collect()
            })
            .collect()
    }

    /// Whether all middles within a face, on all levels below, lie near the triangle `of`. `rim` tells which sides of the
    /// face are on those of the triangle: their middles have to lie near the side, that is near what the neighbour keeps too.
    fn is_near(
        &self,
        level: usize,
        s: usize,
        face: usize,
        of: &[DVec3; 3],
        rim: [bool; 3],
        tolerance: f64,
    ) -> bool {
        if level == self.levels() {
            return true;
        }
        let middles = self.middles(level, s, face);
        let near = |i: usize| {
            let p = self.at(s, middles[i]);
            let distance = if rim[i] {
                (0..3).map(|k| distance_to_segment(p, of[k], of[(k + 1) % 3])).fold(f64::INFINITY, f64::min)
            } else {
                distance_to_triangle(p, of)
            };
            distance <= tolerance
        };
        let child = |i: usize| {
            // Child i is at corner i: it has the halves of sides i and i − 1; that in the middle has none.
            let rim = std::array::from_fn(|k| i < 3 && (k == i || k == (i + 2) % 3) && rim[k]);
            self.is_near(level + 1, s, 4 * face + i, of, rim, tolerance)
        };
        (0..3).all(near) && (0..4).all(child)
    }

    /// Splits until every face has at most one split side, split once; returns the welded nodes in the middle of split sides.
    fn closed(&self, splits: &mut Splits) -> Vec<bool> {
        let mut active = vec![false; self.positions.len()];
        loop {
            // A face has a parent that is split.
            for level in (1..self.levels()).rev() {
                let (above, below) = splits.split_at_mut(level);
                for (parents, children) in above[level - 1].iter_mut().zip(&below[0]) {
                    let of = children.chunks(4).zip(parents);
                    of.for_each(|(four, parent)| *parent |= four.contains(&true));
                }
            }
            for (level, of_level) in splits.iter().enumerate() {
                for (s, of_surface) in of_level.iter().enumerate() {
                    for (f, _) in of_surface.iter().enumerate().filter(|(_, split)| **split) {
                        for m in self.middles(level, s, f) {
                            let w = self.weld(s, m) as usize;
                            active[w] = true;
                            if self.refined.twins[w] != NONE {
                                active[self.refined.twins[w] as usize] = true;
                            }
                        }
                    }
                }
            }
            let mut more = false;
            for (level, of_level) in splits.iter_mut().enumerate() {
                for (s, of_surface) in of_level.iter_mut().enumerate() {
                    for (f, split) in of_surface.iter_mut().enumerate().filter(|(_, split)| !**split) {
                        *split = self.must_split(level, s, f, &active);
                        more |= *split;
                    }
                }
            }
            if !more {
                return active;
            }
        }
    }

    /// Whether two sides are split, or one more than once.
    fn must_split(&self, level: usize, s: usize, face: usize, active: &[bool]) -> bool {
        let is_active = |v: u32| active[self.weld(s, v) as usize];
        let split = self.middles(level, s, face).map(is_active);
        let count = split.iter().filter(|a| **a).count();
        let twice = || {
            level + 1 < self.levels()
                && (0..3).filter(|&i| split[i]).any(|i| {
                    // Halves of side i: side i of the child at corner i, and of that at the next.
                    [i, (i + 1) % 3].iter().any(|&c| is_active(self.middles(level + 1, s, 4 * face + c)[i]))
                })
        };
        count > 1 || twice()
    }

    fn leaves(&self, splits: &Splits, active: &[bool]) -> Vec<Vec<Leaf>> {
        let of_surface = |s: usize| {
            let mut leaves = Vec::new();
            let mut pending: Vec<(usize, usize)> =
                (0..self.refined.level_faces[0][s].len()).rev().map(|f| (0, f)).collect();
            while let Some((level, face)) = pending.pop() {
                if level < self.levels() && splits[level][s][face] {
                    pending.extend((0..4).rev().map(|i| (level + 1, 4 * face + i)));
                    continue;
                }
                let [a, b, c] = self.refined.level_faces[level][s][face];
                let mut keep = |nodes: [u32; 3]| {
                    let welded = nodes.map(|v| self.weld(s, v));
                    leaves.push(Leaf { level, face, nodes, welded });
                };
                let middle = (level < self.levels())
                    .then(|| self.middles(level, s, face))
                    .and_then(|m| (0..3).find(|&i| active[self.weld(s, m[i]) as usize]).map(|i| (i, m[i])));
                match middle {
                    None => keep([a, b, c]),
                    Some((i, m)) => {
                        let [p, q, r] = [[a, b, c], [b, c, a], [c, a, b]][i];
                        keep([p, m, r]);
                        keep([m, q, r]);
                    }
                }
            }
            leaves
        };
        (0..self.surfaces()).map(of_surface).collect()
    }

    /// The body of these faces.
    fn rebuilt(&self, leaves: &[Vec<Leaf>], active: &[bool]) -> Result<Refined, TemplateError> {
        let old = self.refined;
        let kept = |s: usize, v: usize| v < old.level_nodes[0][s] || active[old.weld[s][v] as usize];
        let nodes: Vec<Vec<u32>> = (0..self.surfaces())
            .map(|s| (0..old.weld[s].len()).filter(|&v| kept(s, v)).map(|v| v as u32).collect())
            .collect();
        let number: Vec<Vec<u32>> = (0..self.surfaces())
            .map(|s| {
                let mut number = vec![NONE; old.weld[s].len()];
                nodes[s].iter().zip(0..).for_each(|(&v, i)| number[v as usize] = i);
                number
            })
            .collect();
        let pick = |s: usize, list: &[DVec3]| nodes[s].iter().map(|&v| list[v as usize]).collect();
        let specs: Vec<SurfaceSpec> = old
            .ids
            .iter()
            .enumerate()
            .map(|(s, id)| SurfaceSpec {
                name: old.body.surface(*id).name().to_owned(),
                positions: pick(s, old.body.surface(*id).positions()),
                faces: leaves[s].iter().map(|leaf| leaf.nodes.map(|v| number[s][v as usize])).collect(),
            })
            .collect();
        let rank: BTreeMap<_, _> = old.ids.iter().enumerate().map(|(s, id)| (*id, s)).collect();
        let joints: Vec<JointSpec> = old
            .body
            .joint_ids()
            .map(|joint| {
                let of = old.body.joint(joint);
                let closed = old.body.joint_is_closed(joint);
                let chain = |(k, surface): (usize, usize)| {
                    let nodes = old.body.joint_nodes(joint, k);
                    let open = nodes.len() - usize::from(closed && nodes.first() == nodes.last());
                    let kept = nodes[..open].iter().map(|v| number[surface][*v as usize]);
                    ChainSpec { surface, nodes: kept.filter(|v| *v != NONE).collect(), closed }
                };
                let uses = of.uses().iter().enumerate().map(|(k, one)| (k, rank[&one.surface]));
                JointSpec { name: of.name().map(str::to_owned), chains: uses.map(chain).collect() }
            })
            .collect();
        let body = Body::build(&specs, &joints).map_err(|e| TemplateError::Kernel(e.to_string()))?;
        let ids: Vec<_> = body.surface_ids().collect();
        let edge_lines = ids
            .iter()
            .enumerate()
            .map(|(s, id)| {
                let edges = body.surface(*id).edges().iter();
                edges.map(|e| old.line_of(s, e.map(|v| nodes[s][v as usize]))).collect()
            })
            .collect();
        let faces = ids.iter().map(|id| body.surface(*id).faces().to_vec()).collect();
        Ok(Refined {
            tags: (0..self.surfaces())
                .map(|s| nodes[s].iter().map(|&v| old.tags[s][v as usize]).collect())
                .collect(),
            weld: (0..self.surfaces()).map(|s| nodes[s].iter().map(|&v| self.weld(s, v)).collect()).collect(),
            flat: old.flat.clone(),
            welded_tags: old.welded_tags.clone(),
            twins: old.twins.clone(),
            level_faces: vec![faces],
            level_nodes: vec![nodes.iter().map(Vec::len).collect()],
            edge_lines,
            line_edges: vec![BTreeMap::new(); self.surfaces()],
            body,
            ids,
        })
    }
}

fn distance_to_segment(p: DVec3, a: DVec3, b: DVec3) -> f64 {
    let along = b - a;
    let t = ((p - a).dot(along) / along.length_squared().max(f64::MIN_POSITIVE)).clamp(0.0, 1.0);
    p.distance(a + t * along)
}

fn distance_to_triangle(p: DVec3, [a, b, c]: &[DVec3; 3]) -> f64 {
    let normal = (*b - *a).cross(*c - *a);
    let sides = [(*a, *b), (*b, *c), (*c, *a)];
    if normal != DVec3::ZERO && sides.iter().all(|(q, r)| normal.dot((*r - *q).cross(p - *q)) >= 0.0) {
        return (p - *a).dot(normal.normalize()).abs();
    }
    sides.iter().map(|(q, r)| distance_to_segment(p, *q, *r)).fold(f64::INFINITY, f64::min)
}
