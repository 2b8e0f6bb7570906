//! Incidence of one triangle patch: edges, boundary loops, what makes it a disk, and cutting it open.

use std::cmp::Ordering;

use glam::DVec3;

use crate::{PatternError, input::Patch};

/// "No half-edge on the other side".
pub(crate) const NONE: u32 = u32::MAX;

/// Corner after corner `h` in its face; corner `h = 3 f + c` is also the half-edge from it to the next corner.
#[inline]
pub(crate) fn next(h: u32) -> u32 {
    if h % 3 == 2 { h - 2 } else { h + 1 }
}

/// Faces over nodes with the opposite half-edge of every half-edge.
#[derive(Clone, Debug)]
pub(crate) struct Topology {
    pub(crate) faces: Vec<[u32; 3]>,
    pub(crate) node_count: usize,
    /// Opposite half-edge, [`NONE`] on the boundary.
    pub(crate) twin: Vec<u32>,
    /// Half-edges sorted by (smaller node, larger node, half-edge): finds edges by their nodes.
    sorted: Vec<(u32, u32, u32)>,
}

impl Topology {
    #[inline]
    pub(crate) fn origin(&self, h: u32) -> u32 {
        self.faces[h as usize / 3][h as usize % 3]
    }

    #[inline]
    pub(crate) fn head(&self, h: u32) -> u32 {
        self.origin(next(h))
    }

    /// Checks the patch and builds its incidence. O(n log n).
    pub(crate) fn of_patch(patch: &Patch) -> Result<Self, PatternError> {
        let name = || patch.name.clone();
        if patch.faces.is_empty() {
            return Err(PatternError::EmptyPatch { patch: name() });
        }
        if let Some(node) = patch.positions.iter().position(|p| !p.is_finite()) {
            return Err(PatternError::NotFinite { patch: name(), node: node as u32 });
        }
        let nodes = patch.positions.len();
        for (f, face) in patch.faces.iter().enumerate() {
            if let Some(&node) = face.iter().find(|&&v| v as usize >= nodes) {
                return Err(PatternError::NodeOutOfRange {
                    patch: name(),
                    what: format!("triangle {f}"),
                    node,
                    nodes,
                });
            }
            let [a, b, c] = face.map(|v| patch.positions[v as usize]);
            let longest =
                (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
            // Below this a triangle's own plane is lost in the rounding of its coordinates.
            let doubled = (b - a).cross(c - a).length();
            if doubled.partial_cmp(&(1e-10 * longest)) != Some(Ordering::Greater) {
                return Err(PatternError::DegenerateFace {
                    patch: name(),
                    face: f as u32,
                    x: a.x,
                    y: a.y,
                    z: a.z,
                });
            }
        }
        let topology = Self::build(patch.faces.clone(), nodes, |_| false)
            .map_err(|(a, b, faces)| PatternError::NonManifoldEdge { patch: name(), a, b, faces })?;
        let classes = topology.corner_classes();
        if let Some(&extra) = classes.node_of.get(nodes) {
            return Err(PatternError::PinchedNode { patch: name(), node: extra });
        }
        let parts = topology.components();
        if parts > 1 {
            return Err(PatternError::Disconnected { patch: name(), parts });
        }
        Ok(topology)
    }

    /// Pairs half-edges; those for which `open` holds (asked for both of a pair) stay without twin.
    /// Error: nodes of an edge that is not manifold and its number of half-edges.
    pub(crate) fn build(
        faces: Vec<[u32; 3]>,
        node_count: usize,
        open: impl Fn(u32) -> bool,
    ) -> Result<Self, (u32, u32, usize)> {
        let mut sorted: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * faces.len());
        for (f, face) in faces.iter().enumerate() {
            for c in 0..3 {
                let (a, b) = (face[c], face[(c + 1) % 3]);
                sorted.push((a.min(b), a.max(b), (3 * f + c) as u32));
            }
        }
        sorted.sort_unstable();
        let mut twin = vec![NONE; 3 * faces.len()];
        for run in sorted.chunk_by(|x, y| (x.0, x.1) == (y.0, y.1)) {
            let origin = |h: u32| faces[h as usize / 3][h as usize % 3];
            match *run {
                [_] => {}
                [(.., g), (.., h)] if origin(g) != origin(h) => {
                    if !open(g) && !open(h) {
                        twin[g as usize] = h;
                        twin[h as usize] = g;
                    }
                }
                _ => return Err((run[0].0, run[0].1, run.len())),
            }
        }
        Ok(Self { faces, node_count, twin, sorted })
    }

    /// The one or two half-edges between two nodes. O(log n).
    pub(crate) fn half_edges(&self, a: u32, b: u32) -> impl Iterator<Item = u32> + '_ {
        let key = (a.min(b), a.max(b));
        let start = self.sorted.partition_point(|e| (e.0, e.1) < key);
        self.sorted[start..].iter().take_while(move |e| (e.0, e.1) == key).map(|e| e.2)
    }

    /// Groups the corners of every node into fans that hang together across edges. A node's first fan keeps the
    /// node's number; others get new ones.
    pub(crate) fn corner_classes(&self) -> CornerClasses {
        let corners = 3 * self.faces.len();
        let mut sets = DisjointSets::new(corners);
        for h in 0..corners as u32 {
            let t = self.twin[h as usize];
            if t != NONE && t > h {
                sets.join(h, next(t));
                sets.join(next(h), t);
            }
        }
        let mut node_of: Vec<u32> = (0..self.node_count as u32).collect();
        let mut taken = vec![NONE; self.node_count];
        let mut class = vec![NONE; corners];
        for h in 0..corners as u32 {
            let root = sets.root(h);
            let node = self.origin(h);
            if class[root as usize] == NONE {
                class[root as usize] = if taken[node as usize] == NONE {
                    taken[node as usize] = root;
                    node
                } else {
                    node_of.push(node);
                    node_of.len() as u32 - 1
                };
            }
            class[h as usize] = class[root as usize];
        }
        CornerClasses { class, node_of }
    }

    /// Number of parts connected across edges.
    pub(crate) fn components(&self) -> usize {
        let mut sets = DisjointSets::new(self.faces.len());
        let mut parts = self.faces.len();
        for (h, &t) in self.twin.iter().enumerate() {
            if t != NONE && sets.join(h as u32 / 3, t / 3) {
                parts -= 1;
            }
        }
        parts
    }

    /// Boundary loops as half-edges in walking order (the surface at the left). Loops are ordered by their smallest
    /// half-edge.
    pub(crate) fn boundary_loops(&self) -> Vec<Vec<u32>> {
        let mut seen = vec![false; self.twin.len()];
        let mut loops = Vec::new();
        for start in 0..self.twin.len() as u32 {
            if self.twin[start as usize] != NONE || seen[start as usize] {
                continue;
            }
            let mut one = Vec::new();
            let mut h = start;
            while !seen[h as usize] {
                seen[h as usize] = true;
                one.push(h);
                h = self.next_on_boundary(h);
            }
            loops.push(one);
        }
        loops
    }

    /// The boundary half-edge that follows boundary half-edge `h`.
    fn next_on_boundary(&self, h: u32) -> u32 {
        let mut g = next(h);
        while self.twin[g as usize] != NONE {
            g = next(self.twin[g as usize]);
        }
        g
    }

    /// Genus of a connected patch with the given number of boundary loops.
    pub(crate) fn genus(&self, loops: usize) -> usize {
        let mut used = vec![false; self.node_count];
        self.faces.iter().flatten().for_each(|&v| used[v as usize] = true);
        let nodes = used.iter().filter(|&&u| u).count() as i64;
        let half = self.twin.len() as i64;
        let inner = self.twin.iter().filter(|&&t| t != NONE).count() as i64;
        let edges = half - inner / 2;
        let euler = nodes - edges + self.faces.len() as i64;
        ((2 - loops as i64 - euler) / 2).max(0) as usize
    }

    /// The topology with the marked edges opened and its nodes doubled there.
    pub(crate) fn opened(&self, cut: &[bool]) -> (Self, CornerClasses) {
        let mut open = self.clone();
        for (h, twin) in open.twin.iter_mut().enumerate() {
            if *twin != NONE && (cut[h] || cut[*twin as usize]) {
                *twin = NONE;
            }
        }
        let classes = open.corner_classes();
        for (f, face) in open.faces.iter_mut().enumerate() {
            *face = [classes.class[3 * f], classes.class[3 * f + 1], classes.class[3 * f + 2]];
        }
        open.node_count = classes.node_of.len();
        (open, classes)
    }
}

/// Fans of corners.
#[derive(Clone, Debug)]
pub(crate) struct CornerClasses {
    /// New node of every corner.
    pub(crate) class: Vec<u32>,
    /// Old node of every new node.
    pub(crate) node_of: Vec<u32>,
}

/// Turning angle (sum of π − interior angle) of a boundary loop, in radians, measured on the surface: 2π for the rim
/// of a flat disk, −2π for a hole in it, 0 for the end of a tube.
pub(crate) fn turning(topology: &Topology, positions: &[DVec3], rim: &[u32]) -> f64 {
    let mut total = 0.0;
    for &h in rim {
        // Angles of the faces around the head of h, from h to the next boundary half-edge.
        let mut angle = 0.0;
        let mut g = next(h);
        loop {
            let p = positions[topology.origin(g) as usize];
            let a = positions[topology.head(g) as usize] - p;
            let b = positions[topology.head(next(g)) as usize] - p;
            angle += a.angle_between(b);
            if topology.twin[g as usize] == NONE {
                break;
            }
            g = next(topology.twin[g as usize]);
        }
        total += std::f64::consts::PI - angle;
    }
    total
}

/// Union–find with the smallest member as the root, so that results do not depend on the order of joins.
#[derive(Clone, Debug)]
pub(crate) struct DisjointSets {
    parent: Vec<u32>,
}

impl DisjointSets {
    pub(crate) fn new(n: usize) -> Self {
        Self { parent: (0..n as u32).collect() }
    }

    pub(crate) fn root(&mut self, mut x: u32) -> u32 {
        while self.parent[x as usize] != x {
            self.parent[x as usize] = self.parent[self.parent[x as usize] as usize];
            x = self.parent[x as usize];
        }
        x
    }

    /// Whether they were apart.
    pub(crate) fn join(&mut self, a: u32, b: u32) -> bool {
        let (a, b) = (self.root(a), self.root(b));
        self.parent[a.max(b) as usize] = a.min(b);
        a != b
    }
}
