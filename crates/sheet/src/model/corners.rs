//! ROUND and chamfers: an edge between two faces, or a corner of a face, gives way to something wider (Lee & Kim 2001, fig. 4g;
//! Stroud & Nagy 6.5.3.5).

use std::collections::BTreeSet;

use glam::DVec3;
use mesh_kernel::complex::{EdgeId, FaceId, VertexId};

use super::build::{Builder, SAME_POINT, area_vector};
use super::{Model, ModelError};

/// What an edge becomes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Replacement {
    /// An arc of that radius.
    Round(f64),
    /// A plane whose middle is so far from the edge.
    Chamfer(f64),
}

/// An edge between two faces.
struct Fold {
    edge: EdgeId,
    ends: [VertexId; 2],
    faces: [FaceId; 2],
    /// Unit directions into both faces, across the edge.
    inward: [DVec3; 2],
    /// Angle between the faces, in radians.
    angle: f64,
}

impl Model {
    /// Replaces the edges from one point to another, which lie between two faces, by an arc or a plane.
    pub(super) fn replace_edge(
        &mut self,
        from: DVec3,
        to: DVec3,
        with: Replacement,
        name: &str,
    ) -> Result<(), ModelError> {
        let size = match with {
            Replacement::Round(r) | Replacement::Chamfer(r) => r,
        };
        if !(size.is_finite() && size > SAME_POINT) {
            return Err(ModelError::Number { what: "the radius or depth", wanted: "finite and more than 0" });
        }
        let edges = self.edges_along(from, to)?;
        let [edge] = edges[..] else { return Err(ModelError::NoEdge { from, to }) };
        let fold = self.fold(edge)?;
        let half = fold.angle / 2.0;
        let leg = match with {
            Replacement::Round(r) => r / half.tan(),
            Replacement::Chamfer(d) => d / half.cos(),
        };
        let profile = self.profile_across(&fold, with, leg);
        let mut chains: Vec<Vec<DVec3>> = Vec::new();
        for end in 0..2 {
            chains.push(self.chain_at(&fold, end, leg, &profile)?);
        }
        self.put_in(&fold, &chains, name)
    }

    fn fold(&self, edge: EdgeId) -> Result<Fold, ModelError> {
        let complex = self.complex();
        let ends = complex.ends(edge).unwrap_or([VertexId(u32::MAX); 2]);
        let [from, to] = ends.map(|v| self.at(v));
        let (faces, uses) = (complex.faces_of(edge), complex.uses(edge));
        let ([a, b], 2) = (&faces[..], uses.len()) else {
            return Err(ModelError::NotAFold { from, to, faces: uses.len() });
        };
        let d = (to - from).normalize_or_zero();
        let into = |f: FaceId| {
            let normal = area_vector(&self.corners_of(f)[0]).normalize_or_zero();
            let along = uses.iter().any(|u| u.face == f && u.along);
            // The face lies to the left of its walk.
            if along { normal.cross(d) } else { -normal.cross(d) }
        };
        let inward = [into(*a), into(*b)];
        let angle = inward[0].cross(inward[1]).length().atan2(inward[0].dot(inward[1]));
        if !(1e-3..std::f64::consts::PI - 1e-6).contains(&angle) {
            return Err(ModelError::NoAngle { from, to });
        }
        Ok(Fold { edge, ends, faces: [*a, *b], inward, angle })
    }

    /// Offsets from the edge, across it, from the first face to the second.
    fn profile_across(&self, fold: &Fold, with: Replacement, leg: f64) -> Vec<DVec3> {
        let [a, b] = fold.inward.map(|d| d * leg);
        let Replacement::Round(radius) = with else { return vec![a, b] };
        let bisector = (fold.inward[0] + fold.inward[1]).normalize_or_zero();
        let center = bisector * (radius / (fold.angle / 2.0).sin());
        let sweep = std::f64::consts::PI - fold.angle;
        let step = 2.0 * (1.0 - (self.limits.tolerance / radius).min(0.5)).acos();
        let parts = (sweep / step).ceil().clamp(1.0, 64.0) as u32;
        let (u, v) = ((a - center).normalize_or_zero(), (b - center).normalize_or_zero());
        let sine = sweep.sin();
        (0..=parts)
            .map(|k| match k {
                0 => a,
                k if k == parts => b,
                k => {
                    let t = f64::from(k) / f64::from(parts);
                    let slerp = (u * ((1.0 - t) * sweep).sin() + v * (t * sweep).sin()) / sine;
                    center + slerp * radius
                }
            })
            .collect()
    }

    /// The corners that take the place of an end of the edge: on the two faces' next edges, and between.
    fn chain_at(
        &self,
        fold: &Fold,
        end: usize,
        leg: f64,
        profile: &[DVec3],
    ) -> Result<Vec<DVec3>, ModelError> {
        let at = self.at(fold.ends[end]);
        let along = (self.at(fold.ends[1 - end]) - at).normalize_or_zero();
        let mut next = [DVec3::ZERO; 2];
        for (k, next) in next.iter_mut().enumerate() {
            let (far, length) = self.next_corner(fold, k, end)?;
            let direction = (far - at) / length;
            let across = direction.dot(fold.inward[k]);
            if across <= 1e-9 {
                return Err(ModelError::CornerShared { at });
            }
            let takes = leg / across;
            if takes > length - SAME_POINT {
                return Err(ModelError::TooShort { at, takes, length });
            }
            *next = direction * takes;
        }
        // How far along the edge each point of the profile ends: as the two faces' next edges do, in proportion between.
        let (s, t) = (next[0].dot(along), next[1].dot(along));
        let normal = next[0].cross(next[1]);
        let slope = normal.dot(along);
        let last = profile.len() - 1;
        Ok(profile
            .iter()
            .enumerate()
            .map(|(i, p)| match i {
                0 => at + next[0],
                i if i == last => at + next[1],
                // In the plane of both next edges, where there is one across the edge.
                _ if slope.abs() > 1e-9 * normal.length() => at + *p - along * (p.dot(normal) / slope),
                i => at + *p + along * (s + (t - s) * i as f64 / last as f64),
            })
            .collect())
    }

    /// The corner of a face beside an end of the edge, not on it, and how far it is.
    fn next_corner(&self, fold: &Fold, face: usize, end: usize) -> Result<(DVec3, f64), ModelError> {
        let complex = self.complex();
        let v = fold.ends[end];
        for l in complex.loops(fold.faces[face]) {
            let corners = complex.loop_vertices(l);
            let n = corners.len();
            for i in 0..n {
                if corners[i] == v {
                    for j in [(i + 1) % n, (i + n - 1) % n] {
                        if corners[j] != fold.ends[1 - end] {
                            let far = self.at(corners[j]);
                            return Ok((far, far.distance(self.at(v))));
                        }
                    }
                }
            }
        }
        Err(ModelError::CornerShared { at: self.at(v) })
    }

    /// Takes up all faces at the edge's ends and lays them down with the chains in place of the ends; strips go between.
    fn put_in(&mut self, fold: &Fold, chains: &[Vec<DVec3>], name: &str) -> Result<(), ModelError> {
        let complex = self.complex();
        let mut faces: BTreeSet<FaceId> = fold.faces.into_iter().collect();
        for v in fold.ends {
            faces.extend(complex.edges_at(v).iter().flat_map(|e| complex.faces_of(*e)));
            if !complex.faces_pierced_at(v).is_empty() {
                return Err(ModelError::CornerShared { at: self.at(v) });
            }
        }
        let mut new: Vec<(FaceId, Vec<Vec<DVec3>>)> = Vec::new();
        for &f in &faces {
            let mut loops = Vec::new();
            for l in complex.loops(f) {
                let corners = complex.loop_vertices(l);
                let n = corners.len();
                let mut points = Vec::new();
                for (i, &v) in corners.iter().enumerate() {
                    let Some(end) = fold.ends.iter().position(|e| *e == v) else {
                        points.push(self.at(v));
                        continue;
                    };
                    let chain = &chains[end];
                    if let Some(k) = fold.faces.iter().position(|x| *x == f) {
                        points.push(chain[if k == 0 { 0 } else { chain.len() - 1 }]);
                        continue;
                    }
                    // Another face must go from the one face's next edge to the other's.
                    let beside = [corners[(i + n - 1) % n], corners[(i + 1) % n]].map(|w| self.at(w));
                    let on = |p: DVec3, q: DVec3| {
                        let d = (q - self.at(v)).normalize_or_zero();
                        ((p - self.at(v)).normalize_or_zero() - d).length() < 1e-6
                    };
                    let (first, last) = (chain[0], chain[chain.len() - 1]);
                    if on(first, beside[0]) && on(last, beside[1]) {
                        points.extend(chain);
                    } else if on(last, beside[0]) && on(first, beside[1]) {
                        points.extend(chain.iter().rev());
                    } else {
                        return Err(ModelError::CornerShared { at: self.at(v) });
                    }
                }
                loops.push(points);
            }
            new.push((f, loops));
        }
        let list: Vec<FaceId> = faces.iter().copied().collect();
        let (edges, vertices) = (self.edges_of(&list), self.vertices_of(&list));
        let walks_along = complex.uses(fold.edge).iter().any(|u| u.face == fold.faces[0] && u.along);
        let strips_patch =
            if name.is_empty() { self.tables.patch_of[&fold.faces[0]] } else { self.new_patch(name)? };
        let mut patches = Vec::new();
        for f in &list {
            patches.push(self.tables.patch_of.remove(f).unwrap_or(0));
            self.editor.kill_face(*f)?;
        }
        let dead: BTreeSet<EdgeId> = edges
            .iter()
            .copied()
            .filter(|e| {
                self.complex().ends(*e).is_some_and(|ends| ends.iter().any(|v| fold.ends.contains(v)))
            })
            .collect();
        self.sweep_up(&dead, &vertices)?;
        let known: Vec<VertexId> =
            vertices.iter().copied().filter(|v| self.complex().position(*v).is_some()).collect();
        let mut builder = Builder::on(&mut self.editor, known);
        for (_, loops) in &new {
            builder.face(loops)?;
        }
        let [a, b] = [&chains[0], &chains[1]];
        for i in 0..a.len() - 1 {
            // Strips are turned as the first face, which walks the edge along or against.
            let mut strip = vec![a[i], b[i], b[i + 1], a[i + 1]];
            if walks_along {
                strip.reverse();
            }
            builder.face(&[strip])?;
        }
        let made = builder.faces;
        let (old, strips) = made.split_at(new.len());
        for (f, patch) in old.iter().zip(patches) {
            self.enter([*f], patch);
        }
        self.enter(strips.iter().copied(), strips_patch);
        Ok(())
    }

    /// Rounds a corner of a face that no other face shares.
    pub(super) fn round_corner(&mut self, at: DVec3, radius: f64) -> Result<(), ModelError> {
        if !(radius.is_finite() && radius > SAME_POINT) {
            return Err(ModelError::Number { what: "the radius", wanted: "finite and more than 0" });
        }
        let complex = self.complex();
        let vertex = complex.vertices().find(|v| self.at(*v).distance(at) <= SAME_POINT);
        let v = vertex.ok_or(ModelError::NoVertex { at })?;
        let edges = complex.edges_at(v).to_vec();
        let faces: BTreeSet<FaceId> = edges.iter().flat_map(|e| complex.faces_of(*e)).collect();
        let (Some(&face), 1, 2) = (faces.first(), faces.len(), edges.len()) else {
            return Err(ModelError::CornerShared { at });
        };
        let mut loops = self.corners_of(face);
        let normal = area_vector(&loops[0]).normalize_or_zero();
        for corners in &mut loops {
            let n = corners.len();
            let Some(i) = corners.iter().position(|p| p.distance(at) <= SAME_POINT) else { continue };
            let (p, q) = (corners[(i + n - 1) % n], corners[(i + 1) % n]);
            let (u, w) = ((p - at).normalize_or_zero(), (q - at).normalize_or_zero());
            let angle = u.cross(w).length().atan2(u.dot(w));
            if !(1e-3..std::f64::consts::PI - 1e-6).contains(&angle) {
                return Err(ModelError::NoAngle { from: p, to: q });
            }
            let takes = radius / (angle / 2.0).tan();
            for far in [p, q] {
                let length = far.distance(at);
                if takes > length - SAME_POINT {
                    return Err(ModelError::TooShort { at, takes, length });
                }
            }
            let center = at + (u + w).normalize_or_zero() * (radius / (angle / 2.0).sin());
            let start = at + u * takes - center;
            let turn = if (-u).cross(w).dot(normal) >= 0.0 { normal } else { -normal };
            let sweep = std::f64::consts::PI - angle;
            let step = 2.0 * (1.0 - (self.limits.tolerance / radius).min(0.5)).acos();
            let parts = (sweep / step).ceil().clamp(1.0, 64.0) as u32;
            let arc = (0..=parts).map(|k| {
                let angle = sweep * f64::from(k) / f64::from(parts);
                center + start * angle.cos() + turn.cross(start) * angle.sin()
            });
            corners.splice(i..=i, arc.collect::<Vec<_>>());
        }
        let patch = self.tables.patch_of.remove(&face).unwrap_or(0);
        let vertices = self.vertices_of(&[face]);
        self.editor.kill_face(face)?;
        self.sweep_up(&edges.into_iter().collect(), &[v].into())?;
        let known: Vec<VertexId> = vertices.into_iter().filter(|w| *w != v).collect();
        let mut builder = Builder::on(&mut self.editor, known);
        let made = builder.face(&loops)?;
        self.enter([made], patch);
        Ok(())
    }
}
