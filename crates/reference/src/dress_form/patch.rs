//! Half a form under work: triangles with neighbours, labelled by the plate that they lie in, and the moves that keep it
//! a manifold: split, collapse, flip.

use mesh_kernel::glam::DVec3;

/// No neighbour: the edge lies in the plane of symmetry.
pub(super) const NONE: u32 = u32::MAX;

/// Corner `c` is corner `c % 3` of face `c / 3`; edge `c` runs from that corner to the next one of the face.
#[derive(Clone, Debug, Default)]
pub(super) struct Patch {
    pub(super) positions: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
    /// 0 skin, 1 + i plate i; dead faces have `DEAD`.
    pub(super) label: Vec<u8>,
    /// The edge on the other side, by edge.
    pub(super) twin: Vec<u32>,
    /// One edge that starts at the node; for nodes in the plane of symmetry the one with no edge before it.
    pub(super) start: Vec<u32>,
}

const DEAD: u8 = u8::MAX;

pub(super) fn next(e: u32) -> u32 {
    if e % 3 == 2 { e - 2 } else { e + 1 }
}

pub(super) fn previous(e: u32) -> u32 {
    if e.is_multiple_of(3) { e + 2 } else { e - 1 }
}

impl Patch {
    pub(super) fn new(positions: Vec<DVec3>, faces: Vec<[u32; 3]>, label: Vec<u8>) -> Self {
        let mut patch = Self { positions, faces, label, twin: Vec::new(), start: Vec::new() };
        patch.connect();
        patch
    }

    /// Drops dead faces and unused nodes and finds all neighbours anew. O(n log n).
    pub(super) fn connect(&mut self) {
        let mut keep = self.label.iter().map(|&l| l != DEAD);
        self.faces.retain(|_| keep.next().unwrap_or(false));
        self.label.retain(|&l| l != DEAD);
        let mut new_node = vec![NONE; self.positions.len()];
        let mut positions = Vec::new();
        for face in &mut self.faces {
            for v in face {
                let slot = &mut new_node[*v as usize];
                if *slot == NONE {
                    *slot = positions.len() as u32;
                    positions.push(self.positions[*v as usize]);
                }
                *v = *slot;
            }
        }
        self.positions = positions;
        let mut edges: Vec<(u32, u32, u32)> = Vec::with_capacity(3 * self.faces.len());
        for e in 0..3 * self.faces.len() as u32 {
            let (a, b) = (self.from(e), self.to(e));
            edges.push((a.min(b), a.max(b), e));
        }
        edges.sort_unstable();
        self.twin = vec![NONE; edges.len()];
        for pair in edges.windows(2) {
            if pair[0].0 == pair[1].0 && pair[0].1 == pair[1].1 {
                self.twin[pair[0].2 as usize] = pair[1].2;
                self.twin[pair[1].2 as usize] = pair[0].2;
            }
        }
        self.start = vec![NONE; self.positions.len()];
        for e in 0..self.twin.len() as u32 {
            let v = self.from(e) as usize;
            if self.start[v] == NONE || self.twin[e as usize] == NONE {
                self.start[v] = e;
            }
        }
    }

    pub(super) fn from(&self, e: u32) -> u32 {
        self.faces[(e / 3) as usize][(e % 3) as usize]
    }

    pub(super) fn to(&self, e: u32) -> u32 {
        self.from(next(e))
    }

    pub(super) fn is_dead(&self, face: u32) -> bool {
        self.label[face as usize] == DEAD
    }

    pub(super) fn length(&self, e: u32) -> f64 {
        self.positions[self.from(e) as usize].distance(self.positions[self.to(e) as usize])
    }

    pub(super) fn normal(&self, face: u32) -> DVec3 {
        let [a, b, c] = self.faces[face as usize].map(|v| self.positions[v as usize]);
        (b - a).cross(c - a)
    }

    /// Whether the edge bounds a plate or lies in the plane of symmetry.
    pub(super) fn is_feature(&self, e: u32) -> bool {
        let t = self.twin[e as usize];
        t == NONE || self.label[(t / 3) as usize] != self.label[(e / 3) as usize]
    }

    /// Edges that start at `v`, anticlockwise; an open fan starts at the border and leaves out the border edge that ends
    /// at `v` (see [`Patch::closing`]).
    pub(super) fn fan(&self, v: u32, out: &mut Vec<u32>) {
        out.clear();
        let first = self.start[v as usize];
        let mut e = first;
        loop {
            out.push(e);
            let t = self.twin[previous(e) as usize];
            if t == NONE || t == first || out.len() > 64 {
                return;
            }
            e = t;
        }
    }

    /// The border edge that ends at `v`, when its fan is open.
    pub(super) fn closing(&self, fan: &[u32]) -> Option<u32> {
        let last = previous(*fan.last()?);
        (self.twin[last as usize] == NONE).then_some(last)
    }

    fn link(&mut self, a: u32, b: u32) {
        if a != NONE {
            self.twin[a as usize] = b;
        }
        if b != NONE {
            self.twin[b as usize] = a;
        }
    }

    /// Puts a node into edge `e`; returns it. Labels are kept on both sides.
    pub(super) fn split(&mut self, e: u32, position: DVec3) -> u32 {
        let v = self.positions.len() as u32;
        self.positions.push(position);
        self.start.push(NONE);
        let t = self.twin[e as usize];
        let new_e = self.split_side(e, v);
        if t == NONE {
            self.link(e, NONE);
            self.link(new_e, NONE);
            self.start[v as usize] = new_e;
        } else {
            // On the other side `t` runs back: its first part meets the far part of `e`.
            let new_t = self.split_side(t, v);
            self.link(e, new_t);
            self.link(t, new_e);
            self.start[v as usize] = new_e;
        }
        v
    }

    /// Face of edge `e` = (a, b, c) becomes (a, v, c), a new one (v, b, c) is added; returns the new edge v → b.
    fn split_side(&mut self, e: u32, v: u32) -> u32 {
        let (n, p) = (next(e), previous(e));
        let (b, c) = (self.from(n), self.from(p));
        let face = self.faces.len() as u32;
        self.faces.push([v, b, c]);
        self.label.push(self.label[(e / 3) as usize]);
        self.twin.extend([NONE; 3]);
        let (vb, bc, cv) = (3 * face, 3 * face + 1, 3 * face + 2);
        let outer = self.twin[n as usize];
        self.link(bc, outer);
        self.faces[(n / 3) as usize][(n % 3) as usize] = v;
        self.link(n, cv);
        if self.start[b as usize] == n {
            self.start[b as usize] = bc;
        }
        let _ = c;
        vb
    }

    /// Turns the inner edge `e` in its quadrilateral.
    pub(super) fn flip(&mut self, e: u32) {
        let t = self.twin[e as usize];
        let (en, ep, tn, tp) = (next(e), previous(e), next(t), previous(t));
        let (a, b, c, d) = (self.from(e), self.from(t), self.from(ep), self.from(tp));
        let (o_en, o_tn) = (self.twin[en as usize], self.twin[tn as usize]);
        // e: a → b, c left; t: b → a, d. New: e: d → c in (d, c, a)? Faces (a, d, c) and (d, b, c).
        self.faces[(en / 3) as usize][(en % 3) as usize] = d;
        self.faces[(tn / 3) as usize][(tn % 3) as usize] = c;
        // Face of e is now (a, d, c): e = a → d, en = d → c, ep = c → a. Face of t is (b, c, d).
        self.link(e, o_tn);
        self.link(t, o_en);
        self.link(en, tn);
        // Nodes a and b keep an edge: those that may have started with a moved edge get a kept one.
        for (v, old, new) in [(a, tn, e), (b, en, t)] {
            if self.start[v as usize] == old {
                self.start[v as usize] = new;
            }
        }
        let _ = (c, d, tp);
    }

    /// Merges node `from(e)` into `to(e)`. The caller has checked [`Patch::may_collapse`].
    pub(super) fn collapse(&mut self, e: u32, fan: &[u32]) {
        let (v, w) = (self.from(e), self.to(e));
        for &g in fan {
            self.faces[(g / 3) as usize][(g % 3) as usize] = w;
        }
        for side in [e, self.twin[e as usize]] {
            if side == NONE {
                continue;
            }
            let (n, p) = (next(side), previous(side));
            let (tn, tp) = (self.twin[n as usize], self.twin[p as usize]);
            self.link(tn, tp);
            let apex = self.from(p);
            self.label[(side / 3) as usize] = DEAD;
            for u in [apex, w] {
                if self.start[u as usize] / 3 == side / 3 {
                    // Any live edge from u; the border rule is mended below.
                    let candidate = [tn, tp]
                        .into_iter()
                        .filter(|&g| g != NONE)
                        .flat_map(|g| [g, next(g)])
                        .find(|&g| self.from(g) == u);
                    self.start[u as usize] = candidate.unwrap_or(NONE);
                }
            }
        }
        self.start[v as usize] = NONE;
        let mut touched = vec![w];
        for &g in fan {
            touched.extend([self.to(g), self.from(previous(g))]);
        }
        for u in touched {
            self.rewind(u);
        }
    }

    /// Turns `start[u]` back to the border when the fan is open.
    fn rewind(&mut self, u: u32) {
        let first = self.start[u as usize];
        if first == NONE {
            return;
        }
        let mut e = first;
        for _ in 0..64 {
            let t = self.twin[e as usize];
            if t == NONE {
                break;
            }
            e = next(t);
            if e == first {
                return;
            }
        }
        self.start[u as usize] = e;
    }

    /// Link condition: the two ends share no neighbours but the apices of the edge's faces.
    pub(super) fn may_collapse(&self, e: u32, around: &mut Vec<u32>, other: &mut Vec<u32>) -> bool {
        let (v, w) = (self.from(e), self.to(e));
        let twin = self.twin[e as usize];
        self.ring(v, around);
        self.ring(w, other);
        let shared = around.iter().filter(|n| other.contains(n)).count();
        let apices = if twin == NONE { 1 } else { 2 };
        let inner_between_borders = twin != NONE && self.on_border(v) && self.on_border(w);
        shared == apices && !inner_between_borders && around.len() > 3
    }

    pub(super) fn on_border(&self, v: u32) -> bool {
        self.twin[self.start[v as usize] as usize] == NONE
    }

    /// Neighbour nodes of `v`.
    pub(super) fn ring(&self, v: u32, out: &mut Vec<u32>) {
        self.fan(v, out);
        let closing = self.closing(out).map(|e| self.from(e));
        for e in out.iter_mut() {
            *e = self.to(*e);
        }
        out.extend(closing);
    }

    /// A place where the patch is no smooth disk with its border in the plane of symmetry: a border elsewhere, a sliver, a
    /// skin that folds back.
    pub(super) fn fault(&self) -> Option<DVec3> {
        let mut edges = 0i64;
        for e in 0..self.twin.len() as u32 {
            let (a, b) = (self.positions[self.from(e) as usize], self.positions[self.to(e) as usize]);
            let t = self.twin[e as usize];
            if t == NONE {
                edges += 1;
                if a.x != 0.0 || b.x != 0.0 {
                    return Some(a);
                }
                continue;
            }
            edges += i64::from(e < t);
            let (m, n) = (self.normal(e / 3), self.normal(t / 3));
            if m.dot(n) < -0.7 * m.length() * n.length() {
                return Some(a);
            }
        }
        if let Some(f) = (0..self.faces.len()).find(|&f| self.quality(self.faces[f]) < 0.05) {
            return Some(self.positions[self.faces[f][0] as usize]);
        }
        let disk = self.positions.len() as i64 - edges + self.faces.len() as i64 == 1;
        if disk { None } else { self.positions.first().copied() }
    }

    /// Twice the inradius over the circumradius: 1 for an equilateral triangle, 0 for a degenerate one.
    pub(super) fn quality(&self, face: [u32; 3]) -> f64 {
        let [p, q, r] = face.map(|v| self.positions[v as usize]);
        let (a, b, c) = (p.distance(q), q.distance(r), r.distance(p));
        let product = a * b * c;
        if product > 0.0 { ((b + c - a) * (c + a - b) * (a + b - c)).max(0.0) / product } else { 0.0 }
    }
}
