//! What a picture shows: the draw list.

use glam::DVec3;
use mesh_kernel::{MAX_COORDINATE, TriMesh};
use rayon::prelude::*;

use crate::color::{Color, cloth_color};
use crate::color_map::Scale;
use crate::error::RenderError;
use crate::legend::Legend;

/// Everything in a picture. All coordinates in millimetres, in one right-handed frame with y up.
#[derive(Clone, Debug, Default)]
pub struct Scene {
    /// Surfaces.
    pub meshes: Vec<SceneMesh>,
    /// Lines on or off the surfaces.
    pub lines: Vec<SceneLine>,
    /// Marked places.
    pub points: Vec<ScenePoint>,
    /// Names at places.
    pub labels: Vec<Label>,
    /// Meaning of colours and lines.
    pub legend: Option<Legend>,
    /// Headline.
    pub title: Option<String>,
}

/// A surface in a picture.
#[derive(Clone, Debug)]
pub struct SceneMesh {
    /// Node positions, in millimetres.
    pub positions: Vec<DVec3>,
    /// Faces, anticlockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// Colour.
    pub paint: Paint,
    /// How light changes over faces.
    pub shading: Shading,
    /// What the reverse of the surface looks like.
    pub reverse: Reverse,
}

/// Colour of a surface.
#[derive(Clone, Debug)]
pub enum Paint {
    /// One colour.
    Solid(Color),
    /// A colour a face.
    Faces(Vec<Color>),
    /// A number a face, shown through a scale; NaN is drawn grey.
    FaceValues {
        /// One number a face.
        values: Vec<f64>,
        /// Numbers to colours.
        scale: Scale,
    },
    /// A number a node, interpolated over faces, shown through a scale; NaN is drawn grey.
    NodeValues {
        /// One number a node.
        values: Vec<f64>,
        /// Numbers to colours.
        scale: Scale,
    },
}

/// How light changes over faces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Shading {
    /// Every face is flat: facets show.
    Flat,
    /// Faces that meet at less than `crease` (radians) look like one smooth surface.
    Smooth {
        /// Angle between face normals above which an edge stays sharp.
        crease: f64,
    },
}

/// What the reverse of a surface looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Reverse {
    /// As the front.
    Same,
    /// The front's colour, darker: the inside of cloth.
    Darker,
    /// Another colour: a lining.
    Colored(Color),
}

impl SceneMesh {
    /// A surface of one colour, smooth up to creases of 40°, darker inside.
    pub fn new(positions: Vec<DVec3>, faces: Vec<[u32; 3]>, color: Color) -> Self {
        Self {
            positions,
            faces,
            paint: Paint::Solid(color),
            shading: Shading::Smooth { crease: 40f64.to_radians() },
            reverse: Reverse::Darker,
        }
    }

    /// A mesh in one colour.
    pub fn of_mesh(mesh: &TriMesh, color: Color) -> Self {
        Self::new(mesh.positions.clone(), mesh.faces.clone(), color)
    }

    /// A body or dress form: skin colour, both sides alike (scans may be wound either way).
    pub fn body(mesh: &TriMesh) -> Self {
        Self {
            reverse: Reverse::Same,
            shading: Shading::Smooth { crease: 60f64.to_radians() },
            ..Self::of_mesh(mesh, Color::SKIN)
        }
    }

    /// A garment: every group in its own colour of cloth; without groups all in the first.
    pub fn garment(mesh: &TriMesh) -> Self {
        let mut colors = vec![cloth_color(0); mesh.faces.len()];
        for (i, group) in mesh.groups.iter().enumerate() {
            for f in group.faces.clone() {
                if let Some(color) = colors.get_mut(f as usize) {
                    *color = cloth_color(i);
                }
            }
        }
        Self { paint: Paint::Faces(colors), ..Self::of_mesh(mesh, cloth_color(0)) }
    }

    /// Positions of the nodes that faces use, each once: files may hold stray ones.
    fn used_positions(&self) -> impl Iterator<Item = DVec3> {
        let mut used = vec![false; self.positions.len()];
        for v in self.faces.iter().flatten() {
            if let Some(used) = used.get_mut(*v as usize) {
                *used = true;
            }
        }
        self.positions.iter().zip(used).filter(|(_, used)| *used).map(|(p, _)| *p)
    }

    /// The same surface with another paint.
    pub fn painted(self, paint: Paint) -> Self {
        Self { paint, ..self }
    }
}

/// A line in space.
#[derive(Clone, Debug)]
pub struct SceneLine {
    /// Corners in millimetres; repeat the first at the end to close it.
    pub points: Vec<DVec3>,
    /// Colour.
    pub color: Color,
    /// Width in pixels of a picture 1024 pixels high; scales with the picture.
    pub width: f64,
    /// Drawn dashed where visible.
    pub dashed: bool,
    /// What becomes of parts behind surfaces.
    pub hidden: Hidden,
}

/// What becomes of the parts of a line or point that lie behind surfaces.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Hidden {
    /// Left out.
    #[default]
    Omitted,
    /// Drawn faint.
    Faint,
    /// Drawn dashed and faint.
    Dashed,
    /// Drawn as if nothing were in front.
    Shown,
}

impl SceneLine {
    /// A visible-only line.
    pub fn new(points: Vec<DVec3>, color: Color, width: f64) -> Self {
        Self { points, color, width, dashed: false, hidden: Hidden::Omitted }
    }
}

/// A marked place.
#[derive(Clone, Debug)]
pub struct ScenePoint {
    /// Where, in millimetres.
    pub position: DVec3,
    /// Colour.
    pub color: Color,
    /// Diameter in pixels of a picture 1024 pixels high; scales with the picture.
    pub diameter: f64,
    /// What becomes of it behind surfaces ([`Hidden::Dashed`] counts as faint).
    pub hidden: Hidden,
}

/// A name at a place.
#[derive(Clone, Debug)]
pub struct Label {
    /// Where, in millimetres.
    pub position: DVec3,
    /// What it says.
    pub text: String,
    /// Colour.
    pub color: Color,
    /// What becomes of it when its place is behind surfaces ([`Hidden::Dashed`] counts as faint).
    pub hidden: Hidden,
}

impl Scene {
    /// Smallest and largest coordinates of everything but labels; `None` when there is nothing. O(n).
    pub fn bounds(&self) -> Option<[DVec3; 2]> {
        self.places()
            .fold(None, |b: Option<[DVec3; 2]>, p| Some(b.map_or([p, p], |[lo, hi]| [lo.min(p), hi.max(p)])))
    }

    /// All places that a camera must see: nodes of faces, line corners, points.
    pub(crate) fn places(&self) -> impl Iterator<Item = DVec3> {
        let nodes = self.meshes.iter().flat_map(|m| m.used_positions());
        let corners = self.lines.iter().flat_map(|l| l.points.iter().copied());
        nodes.chain(corners).chain(self.points.iter().map(|p| p.position))
    }

    /// Checks that the scene can be drawn.
    pub(crate) fn check(&self) -> Result<(), RenderError> {
        let bad = |p: &DVec3| !(p.is_finite() && p.abs().max_element() <= MAX_COORDINATE);
        let first_bad = |what: String, index: Option<usize>| match index {
            Some(index) => Err(RenderError::Coordinate { what, index }),
            None => Ok(()),
        };
        for (m, mesh) in self.meshes.iter().enumerate() {
            let nodes = mesh.positions.len();
            first_bad(format!("node of mesh {m}, index"), mesh.positions.par_iter().position_first(bad))?;
            let out_of_range = |f: &[u32; 3]| f.iter().any(|v| *v as usize >= nodes);
            if let Some(face) = mesh.faces.par_iter().position_first(out_of_range) {
                let node = mesh.faces[face].into_iter().find(|v| *v as usize >= nodes).unwrap_or(0);
                return Err(RenderError::Index { mesh: m, face, node, nodes });
            }
            let (of, wanted, got) = match &mesh.paint {
                Paint::Solid(_) => continue,
                Paint::Faces(colors) => ("faces", mesh.faces.len(), colors.len()),
                Paint::FaceValues { values, .. } => ("faces", mesh.faces.len(), values.len()),
                Paint::NodeValues { values, .. } => ("nodes", nodes, values.len()),
            };
            if wanted != got {
                return Err(RenderError::PaintCount { mesh: m, of, wanted, got });
            }
        }
        for (i, line) in self.lines.iter().enumerate() {
            first_bad(format!("corner of line {i}, index"), line.points.iter().position(bad))?;
        }
        first_bad("point".to_owned(), self.points.iter().position(|p| bad(&p.position)))?;
        first_bad("label".to_owned(), self.labels.iter().position(|l| bad(&l.position)))?;
        if self.places().next().is_none() {
            return Err(RenderError::Empty);
        }
        Ok(())
    }
}
