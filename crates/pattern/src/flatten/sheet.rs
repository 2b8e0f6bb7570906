//! One open patch on its way to the plane: rest shape, current flat positions, its linear system.

use glam::{DVec2, DVec3};

use super::{
    energy::{self, RestTriangle},
    sparse::{BlockSystem, NotDefinite},
    topology::{NONE, Topology},
};

/// A face's side as an undirected edge.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Side {
    /// Undirected edge.
    pub(crate) edge: u32,
    /// Whether the face runs along the edge's own direction.
    pub(crate) forward: bool,
}

/// Rest shape and topology of patches without unused nodes: a connected one, or several that are sewn together.
pub(crate) struct Sheet {
    /// Positions in space.
    pub(crate) space: Vec<DVec3>,
    pub(crate) faces: Vec<[u32; 3]>,
    pub(crate) rest: Vec<RestTriangle>,
    /// Undirected edges.
    pub(crate) edges: Vec<[u32; 2]>,
    /// Sides of every face: from corner c to the next.
    pub(crate) sides: Vec<[Side; 3]>,
    /// Boundary loops as node cycles.
    pub(crate) loops: Vec<Vec<u32>>,
    /// Sum of areas in space.
    pub(crate) area: f64,
    /// Index of every flat node of the opened patch, [`NONE`] where no face uses it.
    pub(crate) compact: Vec<u32>,
    /// Current flat positions.
    pub(crate) flat: Vec<DVec2>,
    pub(crate) system: BlockSystem,
    /// Weight of the change of area beside the symmetric Dirichlet energy.
    pub(crate) area_weight: f64,
    /// Two nodes far from each other for every connected part: they stop rigid motions.
    pub(crate) pins: Vec<[usize; 2]>,
    /// Pairs of edges that are held to equal lengths.
    pub(crate) holds: Vec<Hold>,
}

/// Two edges held to equal lengths by an augmented Lagrangian.
#[derive(Clone, Debug)]
pub(crate) struct Hold {
    /// Ends of both edges.
    pub(crate) ends: [[u32; 2]; 2],
    /// The two to four different nodes of both.
    pub(crate) nodes: Vec<u32>,
    /// Which of `nodes` the four ends are.
    pub(crate) slots: [[usize; 2]; 2],
    /// System edge of every pair of `nodes`, in the order (0, 1), (0, 2), … (1, 2) …
    pub(crate) edges: Vec<Side>,
    /// Length in space.
    pub(crate) length: f64,
    /// Lagrange multiplier of the difference of lengths over `length`, per `length`².
    pub(crate) multiplier: f64,
}

impl Sheet {
    /// Collects the rest shape of an opened patch; `positions` by its flat nodes.
    pub(crate) fn new(open: &Topology, positions: &[DVec3], area_weight: f64) -> Result<Self, NotDefinite> {
        let mut compact = vec![NONE; open.node_count];
        let mut space = Vec::with_capacity(open.node_count);
        let mut used = vec![false; open.node_count];
        open.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
        for v in 0..open.node_count {
            if used[v] {
                compact[v] = space.len() as u32;
                space.push(positions[v]);
            }
        }
        let faces: Vec<[u32; 3]> = open.faces.iter().map(|f| f.map(|v| compact[v as usize])).collect();
        let rest: Vec<RestTriangle> =
            faces.iter().map(|f| RestTriangle::new(f.map(|v| space[v as usize]))).collect();
        let area = rest.iter().map(|r| r.area).sum();
        let mut edges = Vec::with_capacity(faces.len() * 3 / 2 + 8);
        let mut sides = vec![[Side { edge: 0, forward: true }; 3]; faces.len()];
        for h in 0..open.twin.len() as u32 {
            let t = open.twin[h as usize];
            if t != NONE && t < h {
                continue;
            }
            let edge = edges.len() as u32;
            let (a, b) = (compact[open.origin(h) as usize], compact[open.head(h) as usize]);
            edges.push([a, b]);
            sides[h as usize / 3][h as usize % 3] = Side { edge, forward: true };
            if t != NONE {
                sides[t as usize / 3][t as usize % 3] = Side { edge, forward: false };
            }
        }
        let loops = open
            .boundary_loops()
            .iter()
            .map(|rim| rim.iter().map(|&h| compact[open.origin(h) as usize]).collect())
            .collect();
        let system = BlockSystem::new(&space, &edges)?;
        let flat = vec![DVec2::ZERO; space.len()];
        let pins = vec![far_pair(&space)];
        let holds = Vec::new();
        Ok(Self {
            space,
            faces,
            rest,
            edges,
            sides,
            loops,
            area,
            compact,
            flat,
            system,
            area_weight,
            pins,
            holds,
        })
    }

    /// Flat corners of face `f`.
    #[inline]
    pub(crate) fn corners(&self, flat: &[DVec2], f: usize) -> [DVec2; 3] {
        self.faces[f].map(|v| flat[v as usize])
    }

    /// Jacobian of face `f`.
    #[inline]
    pub(crate) fn jacobian(&self, flat: &[DVec2], f: usize) -> [f64; 4] {
        self.rest[f].jacobian(self.corners(flat, f))
    }

    /// Whether every triangle keeps its side up.
    pub(crate) fn is_flip_free(&self, flat: &[DVec2]) -> bool {
        (0..self.faces.len()).all(|f| energy::determinant(self.jacobian(flat, f)) > 0.0)
    }

    /// Excess energy (0 is perfect) without holds.
    pub(crate) fn excess(&self, flat: &[DVec2]) -> f64 {
        (0..self.faces.len()).map(|f| self.rest[f].area * energy::excess(self.jacobian(flat, f))).sum()
    }

    /// What is minimised, without holds: excess energy and weighted change of area.
    pub(crate) fn objective(&self, flat: &[DVec2]) -> f64 {
        (0..self.faces.len())
            .map(|f| {
                let j = self.jacobian(flat, f);
                let area = self.area_weight * energy::area_excess(energy::determinant(j));
                self.rest[f].area * (energy::excess(j) + area)
            })
            .sum()
    }

    /// Adds the element matrix `G H Gᵀ` of face `f` for a Hessian in F, times its area.
    #[inline]
    pub(crate) fn add_face(&mut self, f: usize, h: &[[f64; 4]; 4]) {
        let rest = self.rest[f];
        let (g, area) = (&rest.gradients, rest.area);
        // hg[j][(a, b)][c] = Σ_d H[(a, b), (c, d)] g_j[d]
        let mut hg = [[[0.0; 2]; 4]; 3];
        for j in 0..3 {
            for ab in 0..4 {
                for c in 0..2 {
                    hg[j][ab][c] = area * (h[ab][2 * c] * g[j][0] + h[ab][2 * c + 1] * g[j][1]);
                }
            }
        }
        let block = |i: usize, j: usize| {
            let mut out = [[0.0; 2]; 2];
            for a in 0..2 {
                for c in 0..2 {
                    out[a][c] = g[i][0] * hg[j][2 * a][c] + g[i][1] * hg[j][2 * a + 1][c];
                }
            }
            out
        };
        for i in 0..3 {
            let own = block(i, i);
            self.system.add_node(self.faces[f][i], [own[0][0], own[0][1], own[1][1]]);
            let side = self.sides[f][i];
            self.system.add_edge(side.edge, side.forward, block(i, (i + 1) % 3));
        }
    }
}

/// Two nodes far from each other.
fn far_pair(space: &[DVec3]) -> [usize; 2] {
    let farthest = |from: DVec3| {
        (0..space.len())
            .max_by(|&a, &b| {
                let (p, q) = (space[a].distance_squared(from), space[b].distance_squared(from));
                p.total_cmp(&q).then(b.cmp(&a))
            })
            .unwrap_or(0)
    };
    let a = farthest(space[0]);
    [a, farthest(space[a])]
}
