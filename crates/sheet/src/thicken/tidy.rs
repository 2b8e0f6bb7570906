//! The end of the purge: redundant entities, and slivers, that the union left within single faces and along straight edges.
//!
//! Where pieces crossed, the walls have nodes that no offset made. One that lies within what is left of a single face, or on
//! a straight edge between two, is *redundant* (Lee & Kim 2001, fig. 12): it goes, by the collapse of one of its edges. A
//! sliver that is left has its longest edge swapped. Both only where no face leaves its plane, so that nothing moves.

use std::collections::HashMap;

use glam::DVec3;
use mesh_kernel::merge::Solid;

use super::{OffsetChain, Origin, Role};

/// Farthest that what is taken for one plane or one line may be off it, as a share of the model's size.
const OFF: f64 = 1e-11;
/// A face lower than this share of its longest side is a sliver.
const SLIVER: f64 = 0.01;

/// Takes redundant nodes and slivers away; returns how many edges were taken away or swapped. Near linear.
pub(super) fn tidy(chain: &OffsetChain, solid: &mut Solid) -> usize {
    let Some([lo, hi]) = solid.mesh.bounds() else { return 0 };
    let mut tidy = Tidy::new(chain, solid, OFF * (hi - lo).length());
    let mut done = tidy.collapse_all();
    done += tidy.swap_all();
    let Tidy { faces, origins, .. } = tidy;
    let kept = || (0..faces.len()).filter(|&f| origins[f].is_some());
    let parents = kept().map(|f| solid.parents[f]).collect();
    solid.mesh.faces = kept().map(|f| faces[f]).collect();
    solid.parents = parents;
    done
}

/// The piece of the chain that a face is part of: for walls the face of the sheet, else the patch.
type Piece = (Role, u32, u32);

struct Tidy<'a> {
    at: &'a [DVec3],
    faces: Vec<[u32; 3]>,
    /// `None` for a face that is gone.
    origins: Vec<Option<Piece>>,
    start: Vec<u32>,
    at_start: Vec<u32>,
    /// Faces at nodes where they are not what they were at the start.
    changed: HashMap<u32, Vec<u32>>,
    /// Whether a node was made by the union.
    new: Vec<bool>,
    off: f64,
}

impl<'a> Tidy<'a> {
    fn new(chain: &OffsetChain, solid: &'a Solid, off: f64) -> Self {
        let (at, faces) = (&solid.mesh.positions, &solid.mesh.faces);
        let mut new = vec![true; at.len()];
        for (face, parent) in faces.iter().zip(&solid.parents) {
            let corners = chain.mesh.corners(*parent);
            for &v in face {
                let is_near = |c: &DVec3| c.distance_squared(at[v as usize]) <= off * off;
                if new[v as usize] && corners.iter().any(is_near) {
                    new[v as usize] = false;
                }
            }
        }
        let mut start = vec![0u32; at.len() + 1];
        faces.iter().flatten().for_each(|&v| start[v as usize + 1] += 1);
        for v in 0..at.len() {
            start[v + 1] += start[v];
        }
        let (mut fill, mut at_start) = (start.clone(), vec![0; 3 * faces.len()]);
        for (f, face) in faces.iter().enumerate() {
            for &v in face {
                at_start[fill[v as usize] as usize] = f as u32;
                fill[v as usize] += 1;
            }
        }
        let piece = |parent: &u32| {
            let Origin { role, patch, face } = chain.origins[*parent as usize];
            let is_wall = matches!(role, Role::FrontWall | Role::BackWall);
            Some((role, patch, if is_wall { face } else { u32::MAX }))
        };
        let origins = solid.parents.iter().map(piece).collect();
        Self { at, faces: faces.clone(), origins, start, at_start, changed: HashMap::new(), new, off }
    }

    fn star(&self, v: u32) -> Vec<u32> {
        match self.changed.get(&v) {
            Some(faces) => faces.clone(),
            None => {
                self.at_start[self.start[v as usize] as usize..self.start[v as usize + 1] as usize].to_vec()
            }
        }
    }

    fn set_star(&mut self, v: u32, change: impl FnOnce(&mut Vec<u32>)) {
        let mut star = self.star(v);
        change(&mut star);
        self.changed.insert(v, star);
    }

    fn corners(&self, face: [u32; 3]) -> [DVec3; 3] {
        face.map(|v| self.at[v as usize])
    }

    /// Height over the longest side, 0 for a face without area.
    fn quality(&self, face: [u32; 3]) -> f64 {
        let [a, b, c] = self.corners(face);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        (b - a).cross(c - a).length() / longest.max(f64::MIN_POSITIVE)
    }

    fn normal(&self, face: [u32; 3]) -> DVec3 {
        let [a, b, c] = self.corners(face);
        (b - a).cross(c - a)
    }

    /// Whether `new` lies in the plane of `old`, looking the same way.
    fn stays(&self, old: [u32; 3], new: [u32; 3]) -> bool {
        let normal = self.normal(new).normalize_or_zero();
        let [a, ..] = self.corners(new);
        normal.dot(self.normal(old).normalize_or_zero()) > 0.0
            && self.corners(old).iter().all(|p| normal.dot(*p - a).abs() <= self.off)
    }

    fn collapse_all(&mut self) -> usize {
        let mut queue: Vec<u32> = (0..self.at.len() as u32).rev().filter(|&v| self.new[v as usize]).collect();
        let mut waits = self.new.clone();
        let mut done = 0;
        while let Some(v) = queue.pop() {
            waits[v as usize] = false;
            let star = self.star(v);
            let Some(to) = self.target(v, &star) else { continue };
            done += 1;
            for w in self.collapse(v, to, &star) {
                if self.new[w as usize] && !std::mem::replace(&mut waits[w as usize], true) {
                    queue.push(w);
                }
            }
        }
        done
    }

    /// The neighbour that a node may fall onto with the best faces; none if the node is not redundant.
    fn target(&self, v: u32, star: &[u32]) -> Option<u32> {
        if star.is_empty() {
            return None;
        }
        let (ring, creases) = self.ring(v, star)?;
        let targets = match creases[..] {
            [] => ring,
            [a, b] => {
                let [p, q, r] = [a, v, b].map(|v| self.at[v as usize]);
                let along = (r - p).normalize_or_zero();
                let is_straight = (q - p).cross(along).length() <= self.off && (q - p).dot(r - q) > 0.0;
                if !is_straight {
                    return None;
                }
                vec![a, b]
            }
            _ => return None,
        };
        let worst = star.iter().map(|f| self.quality(self.faces[*f as usize])).fold(f64::INFINITY, f64::min);
        let mut best = None;
        for to in targets {
            let Some(quality) = self.quality_after(v, to, star) else { continue };
            if quality >= worst.min(SLIVER) && best.is_none_or(|(known, _)| quality > known) {
                best = Some((quality, to));
            }
        }
        best.map(|(_, to)| to)
    }

    /// The neighbours of a node, and those at the other end of an edge between two pieces.
    fn ring(&self, v: u32, star: &[u32]) -> Option<(Vec<u32>, Vec<u32>)> {
        let mut ring: Vec<(u32, Piece)> = Vec::with_capacity(2 * star.len());
        for &f in star {
            let piece = self.origins[f as usize]?;
            ring.extend(self.faces[f as usize].iter().filter(|w| **w != v).map(|w| (*w, piece)));
        }
        ring.sort_unstable();
        let mut creases = Vec::new();
        let mut all = Vec::with_capacity(star.len());
        for pair in ring.chunk_by(|a, b| a.0 == b.0) {
            let [(w, one), (_, other)] = *pair else { return None };
            all.push(w);
            if one != other {
                creases.push(w);
            }
        }
        Some((all, creases))
    }

    /// The worst face about `v` after it has fallen onto `to`; none if it may not.
    fn quality_after(&self, v: u32, to: u32, star: &[u32]) -> Option<f64> {
        let about = self.star(to);
        let neighbours = |faces: &[u32]| {
            let mut all: Vec<u32> = faces.iter().flat_map(|f| self.faces[*f as usize]).collect();
            all.sort_unstable();
            all.dedup();
            all
        };
        let others = neighbours(&about);
        let common = neighbours(star).iter().filter(|w| others.binary_search(w).is_ok()).count();
        // The two and the two opposite the edge; of a tetrahedron nothing would be left.
        if common != 4 || star.len() + about.len() < 7 {
            return None;
        }
        let mut worst = f64::INFINITY;
        for &f in star {
            let old = self.faces[f as usize];
            if old.contains(&to) {
                continue;
            }
            let new = old.map(|w| if w == v { to } else { w });
            if !self.stays(old, new) {
                return None;
            }
            worst = worst.min(self.quality(new));
        }
        Some(worst)
    }

    /// Returns the nodes whose faces have changed.
    fn collapse(&mut self, v: u32, to: u32, star: &[u32]) -> Vec<u32> {
        let mut touched: Vec<u32> = star.iter().flat_map(|f| self.faces[*f as usize]).collect();
        touched.sort_unstable();
        touched.dedup();
        touched.retain(|w| *w != v);
        for &f in star {
            let face = self.faces[f as usize];
            if face.contains(&to) {
                self.origins[f as usize] = None;
                for w in face.into_iter().filter(|w| *w != v) {
                    self.set_star(w, |star| star.retain(|g| *g != f));
                }
            } else {
                self.faces[f as usize] = face.map(|w| if w == v { to } else { w });
                self.set_star(to, |star| star.push(f));
            }
        }
        self.changed.insert(v, Vec::new());
        touched
    }

    /// Swaps the longest edges of slivers where that helps.
    fn swap_all(&mut self) -> usize {
        let mut done = 0;
        for f in 0..self.faces.len() as u32 {
            let Some(piece) = self.origins[f as usize] else { continue };
            let face = self.faces[f as usize];
            let quality = self.quality(face);
            if quality >= SLIVER {
                continue;
            }
            let length = |k: &usize| {
                let [a, b] = [face[*k], face[(*k + 1) % 3]].map(|v| self.at[v as usize]);
                a.distance_squared(b)
            };
            let Some(k) = (0..3).max_by(|i, j| length(i).total_cmp(&length(j))) else { continue };
            let [a, b, apex] = [face[k], face[(k + 1) % 3], face[(k + 2) % 3]];
            let Some(g) = self.star(a).into_iter().find(|&g| g != f && self.faces[g as usize].contains(&b))
            else {
                continue;
            };
            let other = self.faces[g as usize];
            let Some(&far) = other.iter().find(|v| **v != a && **v != b) else { continue };
            let is_joined = self.star(apex).iter().any(|h| self.faces[*h as usize].contains(&far));
            let new = [[a, far, apex], [far, b, apex]];
            let worst = new.map(|n| self.quality(n)).into_iter().fold(f64::INFINITY, f64::min);
            if self.origins[g as usize] != Some(piece)
                || is_joined
                || worst <= quality.min(self.quality(other))
                || !new.iter().all(|n| self.stays(face, *n) && self.stays(other, *n))
            {
                continue;
            }
            self.faces[f as usize] = new[0];
            self.faces[g as usize] = new[1];
            self.set_star(a, |star| star.retain(|h| *h != g));
            self.set_star(b, |star| star.retain(|h| *h != f));
            self.set_star(apex, |star| star.push(g));
            self.set_star(far, |star| star.push(f));
            done += 1;
        }
        done
    }
}
