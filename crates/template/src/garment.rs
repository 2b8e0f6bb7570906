//! What regeneration gives: a body of smooth surfaces, and what its nodes mean to a dressmaker.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh_kernel::body::{Body, JointId, SurfaceId};

use crate::collision::CollisionReport;
use crate::format::{Grain, PieceSpec};
use crate::layout::{Layout, LayoutLine, LayoutSurface, swap_side};
use crate::refine::{Refined, Tag};

/// A template built on one body. Positions are millimetres in the frame of the reference mesh.
#[derive(Clone, Debug)]
pub struct Garment {
    /// Name of the template.
    pub name: String,
    /// Surfaces and joints.
    pub body: Body,
    /// One entry a surface, in the order of the body's surfaces.
    pub surfaces: Vec<GarmentSurface>,
    /// One entry a joint: where pieces are sewn together.
    pub seams: Vec<Seam>,
    /// The template's lines, then the edges and joints that have no line of their own.
    pub lines: Vec<GarmentLine>,
    /// Where template nodes came to lie.
    pub marks: Vec<Mark>,
    /// Collision with the reference body.
    pub collision: CollisionReport,
    /// Girth of the garment less girth of the body by ease level, mm. A level that the garment does not reach is absent.
    pub ease: BTreeMap<String, f64>,
    /// What the template asks, mm.
    pub ease_wanted: BTreeMap<String, f64>,
    /// What could not be met or looks odd, in words for people.
    pub warnings: Vec<String>,
    /// Time spent.
    pub seconds: Seconds,
}

/// Seconds a stage took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Seconds {
    /// Search structures on the body.
    pub prepare: f64,
    /// Node placement, joints, splits.
    pub topology: f64,
    /// Factorisations.
    pub factor: f64,
    /// Fairing, collision and ease.
    pub shape: f64,
    /// Everything.
    pub total: f64,
}

/// A surface of the garment.
#[derive(Clone, Debug)]
pub struct GarmentSurface {
    /// Its id in the body.
    pub id: SurfaceId,
    /// Name.
    pub name: String,
    /// The surface that it is the mirror image of, for twins that the program made.
    pub mirrored_of: Option<String>,
    /// 0 lies next to the body, 1 over it.
    pub layer: u8,
    /// How it becomes a pattern piece.
    pub piece: GarmentPiece,
}

/// How a surface becomes a pattern piece, in nodes of the surface.
#[derive(Clone, Debug)]
pub struct GarmentPiece {
    /// Name on the piece; pieces of a pair say their side where they would have the same name.
    pub label: String,
    /// How many to cut.
    pub quantity: u32,
    /// Seam allowance, mm.
    pub allowance: f64,
    /// Edges with an allowance of their own.
    pub edges: Vec<PieceEdge>,
    /// Direction of the grain in space.
    pub grain: DVec3,
    /// Nodes of the edge that lies on the fold.
    pub on_fold: Option<Vec<u32>>,
    /// What it is cut from.
    pub fabric: Option<String>,
}

/// An edge of a piece with its allowance.
#[derive(Clone, Debug, PartialEq)]
pub struct PieceEdge {
    /// Name of the line.
    pub line: String,
    /// Its nodes on the surface, in order.
    pub nodes: Vec<u32>,
    /// Allowance, mm.
    pub allowance: f64,
}

/// Nodes in a row on one surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SurfaceChain {
    /// Index into [`Garment::surfaces`].
    pub surface: usize,
    /// Nodes of the surface; a closed chain repeats its first node at the end.
    pub nodes: Vec<u32>,
}

/// A joint as a seam: nodes of its sides correspond one to one.
#[derive(Clone, Debug)]
pub struct Seam {
    /// Name.
    pub name: String,
    /// The joint.
    pub joint: JointId,
    /// Two sides or more, in the joint's radial order.
    pub sides: Vec<SurfaceChain>,
    /// Length in space, mm.
    pub length: f64,
}

/// A line of the garment.
#[derive(Clone, Debug)]
pub struct GarmentLine {
    /// Name.
    pub name: String,
    /// Whether the template names it (or it is a twin of one that it names).
    pub written: bool,
    /// Its nodes on each surface that it touches.
    pub chains: Vec<SurfaceChain>,
    /// The same as points in space; a closed line repeats its first point at the end. Empty when a surface has only parts.
    pub points: Vec<DVec3>,
}

/// A template node on a surface.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Mark {
    /// The template node's name.
    pub name: String,
    /// Index into [`Garment::surfaces`].
    pub surface: usize,
    /// Node of that surface.
    pub node: u32,
}

/// Chains of one line's edges on one surface, by following edges in the line's direction.
fn chains_on(refined: &Refined, surface: usize, line: u32) -> Vec<Vec<u32>> {
    let edges = refined.body.surface(refined.ids[surface]).edges();
    let mut parts: Vec<(u32, f64, [u32; 2])> = Vec::new();
    for (e, on) in refined.edge_lines[surface].iter().enumerate() {
        let Some(on) = on.filter(|on| on.line == line) else { continue };
        let [a, b] = edges[e];
        let forth = on.ends[0] < on.ends[1];
        parts.push((on.span, on.ends[0].min(on.ends[1]), if forth { [a, b] } else { [b, a] }));
    }
    parts.sort_by(|p, q| p.0.cmp(&q.0).then(p.1.total_cmp(&q.1)).then(p.2.cmp(&q.2)));
    let mut chains: Vec<Vec<u32>> = Vec::new();
    for (.., [a, b]) in parts {
        match chains.iter_mut().find(|c| c[c.len() - 1] == a) {
            Some(chain) => chain.push(b),
            None => chains.push(vec![a, b]),
        }
    }
    // Parts that begin where another ends (a closed line cut at its first node).
    let mut k = 0;
    while k < chains.len() {
        let start = chains[k][0];
        match (0..chains.len()).find(|o| *o != k && chains[*o][chains[*o].len() - 1] == start) {
            Some(o) => {
                let tail = chains.remove(k);
                let o = if o > k { o - 1 } else { o };
                chains[o].extend(&tail[1..]);
            }
            None => k += 1,
        }
    }
    chains
}

pub(crate) fn lines(refined: &Refined, lines: &[LayoutLine], written: usize) -> Vec<GarmentLine> {
    let mut out = Vec::with_capacity(lines.len());
    for (l, line) in lines.iter().enumerate() {
        let mut chains = Vec::new();
        for surface in 0..refined.ids.len() {
            let found = chains_on(refined, surface, l as u32);
            chains.extend(found.into_iter().map(|nodes| SurfaceChain { surface, nodes }));
        }
        let spans = line.nodes.len() - usize::from(!line.closed);
        out.push(GarmentLine {
            name: line.name.clone(),
            written: l < written,
            points: whole(refined, l as u32, spans),
            chains,
        });
    }
    out
}

/// The line's points in order, from whichever surface has each span.
fn whole(refined: &Refined, line: u32, spans: usize) -> Vec<DVec3> {
    let mut by_span: Vec<Option<Vec<DVec3>>> = vec![None; spans];
    for (surface, id) in refined.ids.iter().enumerate() {
        let s = refined.body.surface(*id);
        let mut parts: Vec<Vec<(f64, DVec3)>> = vec![Vec::new(); spans];
        for (e, on) in refined.edge_lines[surface].iter().enumerate() {
            let Some(on) = on.filter(|on| on.line == line && by_span[on.span as usize].is_none()) else {
                continue;
            };
            for k in 0..2 {
                let p = s.positions()[s.edges()[e][k] as usize];
                parts[on.span as usize].push((on.ends[k], p));
            }
        }
        for (span, mut list) in parts.into_iter().enumerate().filter(|p| !p.1.is_empty()) {
            list.sort_by(|a, b| a.0.total_cmp(&b.0));
            list.dedup_by(|a, b| a.0 == b.0);
            by_span[span] = Some(list.into_iter().map(|p| p.1).collect());
        }
    }
    let mut out: Vec<DVec3> = Vec::new();
    for span in by_span.into_iter().flatten() {
        out.extend(span.into_iter().skip(usize::from(!out.is_empty())));
    }
    out
}

pub(crate) fn seams(refined: &Refined) -> Vec<Seam> {
    let body = &refined.body;
    let rank = |id: SurfaceId| refined.ids.iter().position(|i| *i == id).unwrap_or(0);
    body.joint_ids()
        .map(|joint| {
            let uses = body.joint(joint).uses();
            let sides: Vec<SurfaceChain> = (0..uses.len())
                .map(|k| SurfaceChain { surface: rank(uses[k].surface), nodes: body.joint_nodes(joint, k) })
                .collect();
            let length = sides.first().map_or(0.0, |side| {
                let positions = body.surface(refined.ids[side.surface]).positions();
                side.nodes
                    .windows(2)
                    .map(|w| positions[w[0] as usize].distance(positions[w[1] as usize]))
                    .sum()
            });
            Seam { name: body.joint(joint).name().unwrap_or_default().to_string(), joint, sides, length }
        })
        .collect()
}

pub(crate) fn marks(refined: &Refined, layout: &Layout) -> Vec<Mark> {
    let mut out = Vec::new();
    for (surface, tags) in refined.tags.iter().enumerate() {
        for (node, tag) in tags.iter().enumerate() {
            if let Tag::Template(n) = tag {
                let name = layout.nodes[*n as usize].name.clone();
                out.push(Mark { name, surface, node: node as u32 });
            }
        }
    }
    out
}

pub(crate) fn surfaces(refined: &Refined, layout: &Layout, lines: &[GarmentLine]) -> Vec<GarmentSurface> {
    let mut surfaces: Vec<GarmentSurface> = layout
        .surfaces
        .iter()
        .enumerate()
        .map(|(s, surface)| GarmentSurface {
            id: refined.ids[s],
            name: surface.name.clone(),
            mirrored_of: surface.made_from.map(|m| layout.surfaces[m as usize].name.clone()),
            layer: surface.layer,
            piece: piece(refined, layout, surface, s, lines),
        })
        .collect();
    say_sides(&mut surfaces, layout);
    surfaces
}

/// Adds the wearer's side to the printed names of a left and a right piece that have the same one.
fn say_sides(surfaces: &mut [GarmentSurface], layout: &Layout) {
    let other = |s: usize| {
        let swapped = swap_side(&layout.surfaces[s].name);
        let named = || layout.surfaces.iter().position(|o| Some(&o.name) == swapped.as_ref());
        layout.surfaces[s].twin.map(|t| t as usize).or_else(named).filter(|t| *t != s)
    };
    let same: Vec<usize> = (0..surfaces.len())
        .filter(|&s| other(s).is_some_and(|t| surfaces[s].piece.label == surfaces[t].piece.label))
        .collect();
    for s in same {
        let side = if surfaces[s].name.starts_with("right_") { "right" } else { "left" };
        let label = &mut surfaces[s].piece.label;
        *label = format!("{label}, {side}");
    }
}

/// Seam allowance where the template says nothing, mm.
const ALLOWANCE: f64 = 10.0;

fn piece(
    refined: &Refined,
    layout: &Layout,
    surface: &LayoutSurface,
    s: usize,
    lines: &[GarmentLine],
) -> GarmentPiece {
    let default = PieceSpec::default();
    let spec = surface.piece.as_ref().unwrap_or(&default);
    let chains = |name: &String| {
        let line = lines.iter().find(|l| l.name == *name);
        line.into_iter().flat_map(|l| &l.chains).filter(|c| c.surface == s).map(|c| c.nodes.clone())
    };
    let mut edges = Vec::new();
    for (line, allowance) in &spec.edges {
        for nodes in chains(line) {
            edges.push(PieceEdge { line: line.clone(), nodes, allowance: *allowance });
        }
    }
    let place = |name: &String| {
        let n = layout.nodes.iter().position(|n| n.name == *name)? as u32;
        let v = refined.tags[s].iter().position(|t| *t == Tag::Template(n))?;
        Some(refined.body.surface(refined.ids[s]).positions()[v])
    };
    let grain = match &spec.grain {
        Some(Grain::Nodes([a, b])) => place(a).zip(place(b)).and_then(|(a, b)| (b - a).try_normalize()),
        _ => None,
    };
    GarmentPiece {
        label: spec.label.clone().unwrap_or_else(|| surface.name.clone()),
        quantity: spec.quantity.unwrap_or(1),
        allowance: spec.allowance.unwrap_or(ALLOWANCE),
        edges,
        grain: grain.unwrap_or(DVec3::NEG_Y),
        on_fold: spec.on_fold.as_ref().and_then(|l| chains(l).next()),
        fabric: spec.fabric.clone(),
    }
}
