//! From the garment in space to what the pattern room needs: patches, seams, notches, lines.

use mesh_kernel::glam::DVec3;
use pattern::{
    CornerStyle, EdgeChain, EdgeSpec, Mark, MarkKind, Patch, PatchLine, PatternInput, PieceSpec, SeamInput,
    SeamSide,
};
use template::{Garment, SurfaceChain};

/// The garment as input of [`pattern::make`]: a patch a surface, a seam a joint, a notch wherever a template node lies
/// within a seam.
///
/// Notches at the wearer's back are double, by the trade's custom; a seam counts as back when its middle lies behind the
/// middle of the garment.
pub(crate) fn pattern_input(garment: &Garment) -> PatternInput {
    let patches = garment.surfaces.iter().map(|surface| {
        let shape = garment.body.surface(surface.id);
        let piece = &surface.piece;
        let edges = piece.edges.iter().map(|edge| EdgeSpec {
            chain: EdgeChain::Nodes(edge.nodes.clone()),
            allowance_mm: edge.allowance,
            corner: CornerStyle::Mitre,
        });
        Patch {
            name: surface.name.clone(),
            positions: shape.positions().to_vec(),
            faces: shape.faces().to_vec(),
            // The pattern room wants it upward.
            grain: Some(-piece.grain),
            piece: PieceSpec {
                label: piece.label.clone(),
                quantity: piece.quantity,
                material: piece.fabric.clone().unwrap_or_default(),
                allowance_mm: piece.allowance,
                edges: edges.collect(),
                on_fold: piece.on_fold.clone(),
            },
        }
    });
    let side = |chain: &SurfaceChain| SeamSide { patch: chain.surface, nodes: chain.nodes.clone() };
    let seams = garment
        .seams
        .iter()
        .map(|seam| SeamInput { name: seam.name.clone(), sides: seam.sides.iter().map(side).collect() });
    PatternInput {
        patches: patches.collect(),
        seams: seams.collect(),
        marks: notches(garment),
        lines: inner_lines(garment),
        // Slits of the template are joints of a surface with itself already.
        cuts: Vec::new(),
        start: Vec::new(),
    }
}

/// Template nodes strictly within a seam, marked on its first side; the pattern room puts them on the other sides.
fn notches(garment: &Garment) -> Vec<Mark> {
    let middle = depth(garment.surfaces.iter().flat_map(|s| garment.body.surface(s.id).positions()));
    let mut marks = Vec::new();
    for seam in &garment.seams {
        let Some(chain) = seam.sides.first() else { continue };
        let positions = garment.body.surface(garment.surfaces[chain.surface].id).positions();
        let behind = depth(chain.nodes.iter().map(|n| &positions[*n as usize])) < middle;
        let kind = if behind { MarkKind::DoubleNotch } else { MarkKind::Notch };
        let within = &chain.nodes[1..chain.nodes.len().max(2) - 1];
        for mark in garment.marks.iter().filter(|m| m.surface == chain.surface && within.contains(&m.node)) {
            marks.push(Mark { patch: chain.surface, node: mark.node, kind, name: mark.name.clone() });
        }
    }
    marks
}

/// Lines of the template that run inside a patch, seams aside: they are drawn, not cut.
fn inner_lines(garment: &Garment) -> Vec<PatchLine> {
    let mut lines = Vec::new();
    for line in garment.lines.iter().filter(|l| l.written) {
        for chain in &line.chains {
            let shape = garment.body.surface(garment.surfaces[chain.surface].id);
            let index = shape.edge_index();
            let inside = chain.nodes.windows(2).all(|w| {
                index.find(w[0], w[1]).is_some_and(|e| {
                    shape.edge_faces()[e.index()].iter().all(|f| (*f as usize) < shape.faces().len())
                        && shape.edge_chain(e).is_none()
                })
            });
            if inside && chain.nodes.len() > 1 {
                lines.push(PatchLine {
                    patch: chain.surface,
                    nodes: chain.nodes.clone(),
                    name: line.name.clone(),
                });
            }
        }
    }
    lines
}

/// Mean place from back to front.
fn depth<'a>(positions: impl Iterator<Item = &'a DVec3>) -> f64 {
    let (sum, count) = positions.fold((0.0, 0usize), |(s, n), p| (s + p.z, n + 1));
    sum / count.max(1) as f64
}
