//! Wires: nodes and links, branching or not (Stroud & Nagy 6.2).

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::complex::{EdgeId, VertexId};
use sketch::{Outline, Path};

use super::build::Builder;
use super::{Limits, Model, ModelError, WorkPlane};

/// How a curve leaves a node, in space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Leave {
    /// Unit tangent.
    pub(super) tangent: DVec3,
    /// Curvature times the direction in which the curve turns, in 1/mm.
    pub(super) curvature: DVec3,
}

/// A wire of a model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Wire {
    /// Its edges, each once.
    pub edges: Vec<EdgeId>,
    /// How curves leave the nodes where they begin and end.
    pub(super) leaves: BTreeMap<(EdgeId, VertexId), Leave>,
}

/// A drawing in space, sampled.
pub(super) struct Drawn {
    pub(super) points: Vec<DVec3>,
    pub(super) closed: bool,
    ends: [Leave; 2],
}

/// Samples a drawing on a plane.
pub(super) fn drawn(drawing: &Outline, plane: &WorkPlane, limits: &Limits) -> Result<Drawn, ModelError> {
    let plane = plane.squared()?;
    let path = Path::of(drawing)?;
    let points: Vec<DVec3> = path
        .sampled_within(limits.tolerance, limits.points)?
        .into_iter()
        .map(|p| plane.place(p.at))
        .collect();
    let ends = path.branches().map(|b| Leave {
        tangent: plane.direction(b.tangent),
        curvature: plane.direction(b.tangent.perp()) * b.curvature,
    });
    Ok(Drawn { points, closed: path.closed, ends })
}

/// A polyline in space, checked.
pub(super) fn polyline(points: &[DVec3], limits: &Limits) -> Result<Drawn, ModelError> {
    if points.len() > limits.points {
        return Err(ModelError::TooFine { points: points.len(), most: limits.points });
    }
    if points.len() < 2 || !points.iter().all(|p| p.is_finite()) {
        return Err(ModelError::Number {
            what: "a line",
            wanted: "made of two points and more, of finite numbers",
        });
    }
    let closed = points.len() > 3 && points[0] == points[points.len() - 1];
    let mut points = points.to_vec();
    let leave =
        |from: DVec3, to: DVec3| Leave { tangent: (to - from).normalize_or_zero(), curvature: DVec3::ZERO };
    let last = points.len() - 1;
    let ends = [leave(points[0], points[1]), leave(points[last], points[last - 1])];
    if closed {
        points.pop();
    }
    Ok(Drawn { points, closed, ends })
}

impl Model {
    /// Makes a wire of drawings and polylines. Nodes in one place are one, links are cut where nodes lie on them.
    pub(super) fn make_wire(&mut self, name: &str, drawings: &[Drawn]) -> Result<(), ModelError> {
        if self.tables.wires.contains_key(name) {
            return Err(ModelError::NameTaken { name: name.to_owned() });
        }
        let mut builder = Builder::on(&mut self.editor, []);
        for p in drawings.iter().flat_map(|d| &d.points) {
            builder.node(*p)?;
        }
        let mut edges: BTreeSet<EdgeId> = BTreeSet::new();
        let mut wire = Wire::default();
        for drawing in drawings {
            let nodes = drawing.points.iter().map(|p| builder.node(*p)).collect::<Result<Vec<_>, _>>()?;
            let count = if drawing.closed { nodes.len() } else { nodes.len() - 1 };
            for i in 0..count {
                let (a, b) = (nodes[i], nodes[(i + 1) % nodes.len()]);
                if a == b {
                    continue;
                }
                let straight = builder.straight(a, b)?;
                if i == 0
                    && let Some(first) = straight.first()
                {
                    wire.leaves.insert((first.edge, a), drawing.ends[0]);
                }
                if i + 1 == count
                    && let Some(last) = straight.last()
                {
                    wire.leaves.insert((last.edge, b), drawing.ends[1]);
                }
                edges.extend(straight.iter().map(|d| d.edge));
            }
        }
        if edges.is_empty() {
            return Err(ModelError::Number { what: "a wire", wanted: "longer than nothing" });
        }
        wire.edges = edges.into_iter().collect();
        self.tables.wires.insert(name.to_owned(), wire);
        Ok(())
    }
}
