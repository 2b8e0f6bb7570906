//! Random operators on a complex, possible or not.

use mesh_kernel::complex::{
    Complex, Corner, DirectedEdge, EdgeClass, EdgeId, End, FaceCorner, FaceId, FaceUse, Loop, NewFace,
    Operation, RadialOrder, VertexId,
};

use super::Random;

/// How many operators a test shall run.
pub(crate) fn wanted(default: usize) -> usize {
    std::env::var("TOILE_RANDOM_OPERATORS").ok().and_then(|n| n.parse().ok()).unwrap_or(default)
}

pub(crate) fn vertex(c: &Complex, random: &mut Random) -> Option<VertexId> {
    random.pick(&c.vertices().collect::<Vec<_>>())
}

pub(crate) fn edge(c: &Complex, random: &mut Random) -> Option<EdgeId> {
    random.pick(&c.edges().collect::<Vec<_>>())
}

pub(crate) fn face(c: &Complex, random: &mut Random) -> Option<FaceId> {
    random.pick(&c.faces().collect::<Vec<_>>())
}

pub(crate) fn corner(c: &Complex, random: &mut Random, f: FaceId) -> Option<Corner> {
    let loops = c.loops(f);
    Some(match &loops[random.below(loops.len())] {
        Loop::Vertex(v) => Corner::Vertex(*v),
        Loop::Walk(walk) => Corner::Leaving(random.pick(walk)?),
    })
}

/// A walk over edges, each once a direction, until it comes back.
pub(crate) fn closed_walk(c: &Complex, random: &mut Random, taken: &mut Vec<DirectedEdge>) -> Option<Loop> {
    let start = vertex(c, random)?;
    if random.below(12) == 0 {
        return Some(Loop::Vertex(start));
    }
    let mut walk: Vec<DirectedEdge> = Vec::new();
    let mut at = start;
    for _ in 0..16 {
        let ways: Vec<DirectedEdge> = c
            .edges_at(at)
            .iter()
            .map(|&edge| DirectedEdge { edge, reversed: c.ends(edge).unwrap()[1] == at })
            .filter(|d| {
                !taken.contains(d) && (walk.last().is_none_or(|l| l.edge != d.edge) || random.below(20) == 0)
            })
            .collect();
        let d = random.pick(&ways)?;
        taken.push(d);
        walk.push(d);
        at = c.target(d).unwrap();
        // Where a vertex comes again, the part since then is a closed walk.
        if let Some(i) = walk.iter().position(|x| c.origin(*x) == Some(at)) {
            return Some(Loop::Walk(walk.split_off(i)));
        }
    }
    None
}

pub(crate) fn new_face(c: &Complex, random: &mut Random) -> Option<NewFace> {
    let mut taken = Vec::new();
    let outer = closed_walk(c, random, &mut taken)?;
    let mut new = NewFace::new(outer);
    for _ in 0..[0, 0, 0, 1, 2][random.below(5)] {
        if let Some(ring) = closed_walk(c, random, &mut taken) {
            new = new.ring(ring);
        }
    }
    // Random places about all edges.
    let own: Vec<DirectedEdge> = new.loops().flat_map(Loop::edges).copied().collect();
    let mut orders: Vec<RadialOrder> = Vec::new();
    for d in own {
        let u = FaceUse { face: c.next_face(), along: !d.reversed };
        let i = orders.iter().position(|o| o.edge == d.edge).unwrap_or_else(|| {
            orders.push(RadialOrder { edge: d.edge, uses: c.uses(d.edge).to_vec() });
            orders.len() - 1
        });
        let at = random.below(orders[i].uses.len() + 1);
        orders[i].uses.insert(at, u);
    }
    new.radial = orders;
    Some(new)
}

/// A random operator, possible or not.
pub(crate) fn operation(c: &Complex, random: &mut Random) -> Option<Operation> {
    let class = [EdgeClass::Free, EdgeClass::Bend, EdgeClass::Weld][random.below(3)];
    let flip = random.below(2) == 0;
    let end = if random.below(2) == 0 { End::Start } else { End::End };
    let grow = c.vertex_count() < 14;
    Some(match random.below(24) {
        0 if grow => Operation::MakeVertexComplex { position: random.place() },
        1 => Operation::KillVertexComplex { vertex: vertex(c, random)? },
        2 if grow => Operation::MakeVertexEdge {
            from: vertex(c, random)?,
            position: random.place(),
            corner: None,
            inward: flip,
            class,
        },
        3 if grow => {
            let face = face(c, random)?;
            let corner = corner(c, random, face)?;
            let from = match corner {
                Corner::Vertex(v) => v,
                Corner::Leaving(d) => c.origin(d)?,
            };
            let corner = Some(FaceCorner { face, corner });
            Operation::MakeVertexEdge { from, position: random.place(), corner, inward: flip, class }
        }
        4 => Operation::KillVertexEdge { vertex: vertex(c, random)? },
        5 => Operation::KillVertexRing { vertex: vertex(c, random)? },
        6..=9 => {
            let ends = [vertex(c, random)?, vertex(c, random)?];
            if flip {
                Operation::MakeEdgeChole { ends, class }
            } else {
                Operation::MakeEdgeKillComplex { ends, class }
            }
        }
        10 => match flip {
            true => Operation::KillEdgeChole { edge: edge(c, random)? },
            false => Operation::KillEdgeMakeComplex { edge: edge(c, random)? },
        },
        11..=16 => {
            let face = new_face(c, random)?;
            if random.below(3) > 0 {
                Operation::MakeFaceKillChole { face }
            } else {
                Operation::MakeFaceMakeCavity { face }
            }
        }
        17 => match flip {
            true => Operation::KillFaceMakeChole { face: face(c, random)? },
            false => Operation::KillFaceKillCavity { face: face(c, random)? },
        },
        18 if grow => Operation::MakeVertexRing { face: face(c, random)?, position: random.place() },
        19 => {
            let face = face(c, random)?;
            let [from, to] = [corner(c, random, face)?, corner(c, random, face)?];
            Operation::MakeEdgeKillRing { face, from, to, class }
        }
        20 => Operation::KillEdgeMakeRing { edge: edge(c, random)?, ring: end },
        21 if grow => Operation::SplitEdge {
            edge: edge(c, random)?,
            position: random.place(),
            kept: end,
            flipped: flip,
        },
        22 => {
            let kept = edge(c, random)?;
            Operation::MergeEdge { kept, vertex: c.ends(kept)?[random.below(2)] }
        }
        23 => match random.below(3) {
            0 => Operation::MoveVertex { vertex: vertex(c, random)?, position: random.place() },
            1 => Operation::SetEdgeClass { edge: edge(c, random)?, class },
            _ => {
                let edge = edge(c, random)?;
                let mut uses = c.uses(edge).to_vec();
                let (i, j) = (random.below(uses.len()), random.below(uses.len()));
                if uses.len() > 2 {
                    uses.swap(i, j);
                }
                Operation::OrderEdge { order: RadialOrder { edge, uses } }
            }
        },
        _ => return None,
    })
}
