//! The draw list: body, garment, and the template about them.

use design::pictures::{stretch_percent, stretch_scale};
use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::plane_section;
use viewer::{Color, ColorMap, Hidden, Paint, Scale, SceneLine, SceneMesh, ScenePoint};

use crate::model::Model;

/// What the garment's colours mean.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Colouring {
    /// A colour a surface.
    #[default]
    Patches,
    /// The flat piece against the worn cloth.
    Stretch,
    /// Distance to the body.
    Distance,
}

impl Colouring {
    pub(crate) const ALL: [(Self, &'static str); 3] =
        [(Self::Patches, "Patches"), (Self::Stretch, "Stretch"), (Self::Distance, "Distance")];

    /// What its numbers are shown through, and their unit.
    pub(crate) fn scale(self) -> Option<(Scale, &'static str)> {
        match self {
            Self::Patches => None,
            Self::Stretch => Some((stretch_scale(), "%")),
            Self::Distance => Some((Scale::new(ColorMap::Sequential, 0.0, 80.0), "mm")),
        }
    }
}

/// A plane that cuts the picture: what lies on the eye's side of it is left out.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Section {
    /// 0: across the body's left–right axis, 1: across its height, 2: across front–back.
    pub(crate) axis: usize,
    /// Where it crosses the axis, mm.
    pub(crate) at: f64,
}

impl Section {
    pub(crate) fn normal(self) -> DVec3 {
        [DVec3::X, DVec3::Y, DVec3::Z][self.axis.min(2)]
    }
}

/// What is shown, and how.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Look {
    pub(crate) body: bool,
    pub(crate) garment: bool,
    pub(crate) template: bool,
    pub(crate) x_ray: bool,
    pub(crate) colouring: Colouring,
    pub(crate) section: Option<Section>,
    /// The window is dark: ink is light.
    pub(crate) is_dark: bool,
}

impl Default for Look {
    fn default() -> Self {
        Self {
            body: true,
            garment: true,
            template: true,
            x_ray: false,
            colouring: Colouring::Patches,
            section: None,
            is_dark: false,
        }
    }
}

/// Colours of edges by the number of surfaces that meet there: wires grey, boundaries ink, seams red, three blue, more
/// violet.
pub(crate) fn valence_color(surfaces: usize, is_dark: bool) -> Color {
    let ink = if is_dark { Color([225, 225, 225]) } else { Color::INK };
    match surfaces {
        0 => Color::FAINT_INK,
        1 => ink,
        2 => Color::ACCENT,
        3 => Color([40, 96, 220]),
        _ => Color([150, 60, 190]),
    }
}

/// The body, or the mesh that is none in the colours of its groups; cut where a section asks.
pub(crate) fn body(model: &Model, look: &Look) -> Option<SceneMesh> {
    let body = model.body.as_ref().map(|b| SceneMesh::body(&b.on.body.mesh));
    let body = body.or_else(|| model.seen.as_ref().map(|s| SceneMesh::garment(&s.mesh)));
    body.filter(|_| look.body).map(|mesh| cut_by(look.section, mesh))
}

/// The garment, cut where a section asks.
pub(crate) fn garment(model: &Model, look: &Look) -> Option<SceneMesh> {
    let cloth = model.cloth.as_ref().filter(|_| look.garment)?;
    let mesh = SceneMesh::garment(&cloth.mesh);
    let paint = look.colouring.scale().and_then(|(scale, _)| match look.colouring {
        Colouring::Patches => None,
        Colouring::Distance => (cloth.distances.len() == cloth.mesh.positions.len())
            .then(|| Paint::NodeValues { values: cloth.distances.clone(), scale }),
        Colouring::Stretch => {
            let flats = &cloth.made.as_ref()?.pattern.flats;
            let values: Vec<f64> =
                flats.iter().flat_map(|f| &f.stretch).map(|s| stretch_percent(*s)).collect();
            (values.len() == cloth.mesh.faces.len()).then_some(Paint::FaceValues { values, scale })
        }
    });
    let mesh = match paint {
        Some(paint) => mesh.painted(paint),
        None => mesh,
    };
    Some(cut_by(look.section, mesh))
}

fn cut_by(section: Option<Section>, mut mesh: SceneMesh) -> SceneMesh {
    if let Some(section) = section {
        cut(&mut mesh, section);
    }
    mesh
}

/// Leaves out what lies beyond the plane; faces that it crosses are cut.
fn cut(mesh: &mut SceneMesh, section: Section) {
    let height = |p: DVec3| p.dot(section.normal()) - section.at;
    let mut faces = Vec::new();
    let mut from = Vec::new();
    let mut node_values = match &mesh.paint {
        Paint::NodeValues { values, .. } => Some(values.clone()),
        _ => None,
    };
    for (f, face) in mesh.faces.iter().enumerate() {
        let mut kept: Vec<u32> = Vec::with_capacity(4);
        for k in 0..3 {
            let (a, b) = (face[k] as usize, face[(k + 1) % 3] as usize);
            let (pa, pb) = (mesh.positions[a], mesh.positions[b]);
            let (ha, hb) = (height(pa), height(pb));
            if ha <= 0.0 {
                kept.push(a as u32);
            }
            if (ha <= 0.0) != (hb <= 0.0) {
                let t = ha / (ha - hb);
                kept.push(mesh.positions.len() as u32);
                mesh.positions.push(pa.lerp(pb, t));
                if let Some(values) = &mut node_values {
                    values.push(values[a] + t * (values[b] - values[a]));
                }
            }
        }
        for k in 1..kept.len().saturating_sub(1) {
            faces.push([kept[0], kept[k], kept[k + 1]]);
            from.push(f);
        }
    }
    mesh.faces = faces;
    match &mut mesh.paint {
        Paint::Solid(_) => {}
        Paint::Faces(colors) => *colors = from.iter().map(|f| colors[*f]).collect(),
        Paint::FaceValues { values, .. } => *values = from.iter().map(|f| values[*f]).collect(),
        Paint::NodeValues { values, .. } => *values = node_values.unwrap_or_default(),
    }
}

/// The template's edges by valence, its nodes, drawn curves, and the outline of a section.
pub(crate) fn template_lines(model: &Model, look: &Look) -> (Vec<SceneLine>, Vec<ScenePoint>) {
    let hidden = if look.x_ray { Hidden::Shown } else { Hidden::Faint };
    let mut lines = Vec::new();
    let mut points = Vec::new();
    if look.template {
        for edge in model.wires.edges.iter().chain(&model.wires.twins) {
            let at = |k: usize| model.places.get(&edge.ends[k]).copied();
            let Some((a, b)) = at(0).zip(at(1)) else { continue };
            let color = valence_color(edge.surfaces, look.is_dark);
            lines.push(SceneLine { hidden, ..SceneLine::new(vec![a, b], color, 2.0) });
        }
        let color = valence_color(1, look.is_dark);
        points.extend(model.places.values().map(|p| ScenePoint {
            position: *p,
            color,
            diameter: 8.0,
            hidden,
        }));
        if let Some(human) = model.human() {
            for (_, curve) in human.features.curves.iter().filter(|(n, _)| crate::model::is_drawn(n)) {
                let mut along = curve.points.clone();
                if curve.closed {
                    along.extend(curve.points.first().copied());
                }
                lines.push(SceneLine::new(along, Color([20, 130, 90]), 2.5));
            }
        }
    }
    if let Some(section) = look.section {
        let color = valence_color(1, look.is_dark);
        let mut outline = |mesh: &TriMesh| {
            for ring in plane_section(mesh, section.normal() * section.at, section.normal()) {
                let mut along = ring.points;
                if ring.closed {
                    along.extend(along.first().copied());
                }
                lines.push(SceneLine { hidden: Hidden::Shown, ..SceneLine::new(along, color, 1.5) });
            }
        };
        if let (true, Some(body)) = (look.body, &model.body) {
            outline(&body.on.body.mesh);
        }
        if let (true, Some(seen)) = (look.body, &model.seen) {
            outline(&seen.mesh);
        }
        if let (true, Some(cloth)) = (look.garment, &model.cloth) {
            outline(&cloth.mesh);
        }
    }
    (lines, points)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_section_leaves_what_is_below_and_keeps_colours_with_their_faces() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y].map(|p| 10.0 * p);
        let colors = vec![Color::WHITE, Color::INK];
        let mut mesh = SceneMesh::new(square.to_vec(), vec![[0, 1, 2], [0, 2, 3]], Color::WHITE)
            .painted(Paint::Faces(colors));
        cut(&mut mesh, Section { axis: 1, at: 4.0 });
        let area = |c: Color| {
            let Paint::Faces(colors) = &mesh.paint else { unreachable!() };
            let of = mesh.faces.iter().zip(colors).filter(|(_, own)| **own == c);
            of.map(|(f, _)| {
                let [a, b, c] = f.map(|v| mesh.positions[v as usize]);
                0.5 * (b - a).cross(c - a).length()
            })
            .sum::<f64>()
        };
        assert!((area(Color::WHITE) - 32.0).abs() < 1e-9 && (area(Color::INK) - 8.0).abs() < 1e-9);
        assert!(mesh.faces.iter().flatten().all(|v| mesh.positions[*v as usize].y <= 4.0 + 1e-12));
    }
}
