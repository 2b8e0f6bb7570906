//! CREATE, ADD, PUNCH, DRAW, and taking faces away (Lee & Kim 2001, fig. 4).

use std::collections::BTreeSet;

use glam::{DVec2, DVec3};
use mesh_kernel::complex::{FaceId, NewFace};
use sketch::{Outline, Path};

use super::build::{Builder, SAME_POINT, area_vector};
use super::{Model, ModelError, WorkPlane};
use crate::unfold::inside;

impl Model {
    /// A closed drawing's corners, anticlockwise on its plane.
    fn loop_of(&self, outline: &Outline) -> Result<Vec<DVec2>, ModelError> {
        Ok(Path::of(outline)?.simple_loop(self.limits.tolerance, self.limits.points)?)
    }

    /// CREATE: a sheet from a drawing, with holes.
    pub(super) fn create(
        &mut self,
        name: &str,
        outline: &Outline,
        holes: &[Outline],
        plane: &WorkPlane,
    ) -> Result<(), ModelError> {
        let plane = plane.squared()?;
        let outer = self.loop_of(outline)?;
        let mut loops = vec![outer];
        for hole in holes {
            let hole = self.loop_of(hole)?;
            if let Some(at) = leaves(&hole, &loops) {
                return Err(ModelError::LeavesFace { patch: name.to_owned(), at: plane.place(at) });
            }
            loops.push(hole);
        }
        let patch = self.new_patch(name)?;
        let loops: Vec<Vec<DVec3>> =
            loops.iter().map(|l| l.iter().map(|p| plane.place(*p)).collect()).collect();
        let mut builder = Builder::on(&mut self.editor, []);
        let face = builder.face(&loops)?;
        self.enter([face], patch);
        Ok(())
    }

    /// ADD: a face through points; it shares vertices and edges with what is there.
    pub(super) fn add(&mut self, name: &str, points: &[DVec3]) -> Result<(), ModelError> {
        if points.len() < 3 || points.len() > self.limits.points || !points.iter().all(|p| p.is_finite()) {
            return Err(ModelError::Number {
                what: "a face",
                wanted: "made of three points and more, of finite numbers",
            });
        }
        let area = area_vector(points);
        let size = points.iter().map(|p| p.distance(points[0])).fold(0.0, f64::max);
        let flat = area.try_normalize().is_some_and(|n| {
            points.iter().all(|p| (*p - points[0]).dot(n).abs() <= 1e-6 * size + SAME_POINT)
        });
        if !flat || area.length() <= SAME_POINT * size {
            return Err(ModelError::Number { what: "a face", wanted: "plane, and larger than nothing" });
        }
        let patch = match self.faces_of(name) {
            Ok(faces) => self.tables.patch_of[&faces[0]],
            Err(_) => self.new_patch(name)?,
        };
        let known: Vec<_> = self.complex().vertices().collect();
        let mut builder = Builder::on(&mut self.editor, known);
        let face = builder.face(&[points.to_vec()])?;
        self.enter([face], patch);
        Ok(())
    }

    /// The face of a patch in which a drawing lies, seen along the plane's normal, and the drawing's corners on it.
    fn drawn_in(
        &self,
        patch: &str,
        outline: &Outline,
        plane: &WorkPlane,
    ) -> Result<(FaceId, Vec<DVec3>), ModelError> {
        let plane = plane.squared()?;
        let drawn: Vec<DVec3> = self.loop_of(outline)?.into_iter().map(|p| plane.place(p)).collect();
        let view = plane.normal();
        let mut outside = drawn[0];
        for face in self.faces_of(patch)? {
            let corners = self.corners_of(face);
            let Some(normal) = area_vector(&corners[0]).try_normalize() else { continue };
            let slope = view.dot(normal);
            if slope.abs() < 1e-6 {
                continue;
            }
            let o = corners[0][0];
            let on: Vec<DVec3> = drawn.iter().map(|p| *p + view * ((o - *p).dot(normal) / slope)).collect();
            let u = normal.any_orthonormal_vector();
            let v = normal.cross(u);
            let flat = |p: &DVec3| DVec2::new((*p - o).dot(u), (*p - o).dot(v));
            let loops: Vec<Vec<DVec2>> = corners.iter().map(|l| l.iter().map(flat).collect()).collect();
            match leaves(&on.iter().map(flat).collect::<Vec<_>>(), &loops) {
                None => return Ok((face, on)),
                Some(at) => outside = o + u * at.x + v * at.y,
            }
        }
        Err(ModelError::LeavesFace { patch: patch.to_owned(), at: outside })
    }

    /// PUNCH: a hole in a face. Gives the hole's corners.
    pub(super) fn punch(
        &mut self,
        patch: &str,
        outline: &Outline,
        plane: &WorkPlane,
    ) -> Result<Vec<DVec3>, ModelError> {
        let (face, hole) = self.drawn_in(patch, outline, plane)?;
        let mut loops = self.complex().loops(face).to_vec();
        let normal = area_vector(&self.corners_of(face)[0]);
        let number = self.tables.patch_of[&face];
        let mut ring = hole.clone();
        if area_vector(&ring).dot(normal) > 0.0 {
            ring.reverse();
        }
        let radial: Vec<_> = Vec::new();
        self.editor.kill_face(face)?;
        self.tables.patch_of.remove(&face);
        let mut builder = Builder::on(&mut self.editor, []);
        let walk = builder.walk(&ring)?;
        let outer = loops.remove(0);
        let mut new = NewFace { outer, rings: loops, radial };
        new = new.ring(walk);
        let made = self.editor.make_face(new)?.face;
        self.enter([made], number);
        Ok(hole)
    }

    /// DRAW: a part of a face is moved along a direction, and walls join it to the rest.
    pub(super) fn draw(
        &mut self,
        patch: &str,
        outline: &Outline,
        plane: &WorkPlane,
        by: DVec3,
        scale: f64,
        name: &str,
    ) -> Result<(), ModelError> {
        if !(by.is_finite() && by.length() > SAME_POINT) {
            return Err(ModelError::Number {
                what: "the direction of drawing",
                wanted: "finite and longer than nothing",
            });
        }
        if !(scale.is_finite() && scale > 0.0) {
            return Err(ModelError::Number {
                what: "the scale of the drawn part",
                wanted: "finite and more than 0",
            });
        }
        let rim = self.punch(patch, outline, plane)?;
        let normal = area_vector(&rim);
        if by.dot(normal.normalize_or_zero()).abs() <= SAME_POINT {
            return Err(ModelError::Number {
                what: "the direction of drawing",
                wanted: "out of the face's plane",
            });
        }
        let middle = rim.iter().copied().sum::<DVec3>() / rim.len() as f64;
        let bottom: Vec<DVec3> = rim.iter().map(|p| middle + (*p - middle) * scale + by).collect();
        let walls = self.new_patch(name)?;
        let complex = self.complex();
        let known: BTreeSet<_> = complex
            .vertices()
            .filter(|v| rim.iter().any(|p| self.at(*v).distance(*p) <= SAME_POINT))
            .collect();
        let mut builder = Builder::on(&mut self.editor, known);
        let n = rim.len();
        for i in 0..n {
            let j = (i + 1) % n;
            builder.face(&[vec![rim[i], rim[j], bottom[j], bottom[i]]])?;
        }
        builder.face(&[bottom])?;
        let made = builder.faces;
        self.enter(made, walls);
        Ok(())
    }

    /// Takes patches away: of a volume, what is left is a sheet (Stroud & Nagy 6.3.3).
    pub(super) fn remove(&mut self, patches: &[String]) -> Result<(), ModelError> {
        let mut faces = Vec::new();
        for patch in patches {
            faces.extend(self.faces_of(patch)?);
        }
        let (edges, vertices) = (self.edges_of(&faces), self.vertices_of(&faces));
        for f in faces {
            self.editor.kill_face(f)?;
            self.tables.patch_of.remove(&f);
        }
        let wires: BTreeSet<_> = self.tables.wires.values().flat_map(|w| &w.edges).copied().collect();
        let edges = edges.difference(&wires).copied().collect();
        self.sweep_up(&edges, &vertices)
    }
}

/// A corner of a polygon that does not lie inside some loops, or where it crosses them.
fn leaves(polygon: &[DVec2], loops: &[Vec<DVec2>]) -> Option<DVec2> {
    let size = polygon.iter().chain(loops.iter().flatten()).fold(0.0f64, |m, p| m.max(p.length()));
    let near = SAME_POINT.max(1e-12 * size);
    let ends = |points: &[DVec2], i: usize| [points[i], points[(i + 1) % points.len()]];
    for p in polygon {
        let on_border = loops.iter().any(|l| {
            (0..l.len()).any(|i| {
                let [a, b] = ends(l, i);
                let t = ((*p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
                p.distance(a.lerp(b, t)) <= near
            })
        });
        if on_border || !inside(*p, loops) {
            return Some(*p);
        }
    }
    for i in 0..polygon.len() {
        let [a, b] = ends(polygon, i);
        for l in loops {
            for j in 0..l.len() {
                let [c, d] = ends(l, j);
                let side = |a: DVec2, b: DVec2, p: DVec2| (b - a).perp_dot(p - a);
                if side(a, b, c) * side(a, b, d) <= 0.0 && side(c, d, a) * side(c, d, b) <= 0.0 {
                    let low = a.min(b).max(c.min(d));
                    let high = a.max(b).min(c.max(d));
                    if low.cmple(high).all() {
                        return Some((low + high) / 2.0);
                    }
                }
            }
        }
    }
    // A loop that lies wholly inside the polygon is a hole that it would swallow.
    let polygon = [polygon.to_vec()];
    loops.iter().skip(1).find_map(|l| l.first().copied().filter(|p| inside(*p, &polygon)))
}
