//! Pairs of faces whose boxes overlap.
//!
//! Faces are put in the order of a space-filling curve (Morton 1966) and a balanced binary tree is laid over them: made
//! again for the few new faces of every round, it costs little more than a sort. Joining two trees finds all overlapping
//! pairs without asking for each face from the root.

use glam::DVec3;
use rayon::prelude::*;

/// Faces in a leaf.
const LEAF: usize = 4;
/// Levels of the tree whose halves are searched on threads of their own.
const FORKS: u32 = 7;

/// A box, rounded outward.
#[derive(Clone, Copy, Debug)]
struct Bounds {
    lo: [f32; 3],
    hi: [f32; 3],
}

impl Bounds {
    const EMPTY: Self = Self { lo: [f32::INFINITY; 3], hi: [f32::NEG_INFINITY; 3] };

    fn of(corners: [DVec3; 3], margin: f64) -> Self {
        let [a, b, c] = corners;
        let (lo, hi) = (a.min(b).min(c) - margin, a.max(b).max(c) + margin);
        Self {
            lo: lo
                .to_array()
                .map(|x| if f64::from(x as f32) > x { (x as f32).next_down() } else { x as f32 }),
            hi: hi.to_array().map(|x| if f64::from(x as f32) < x { (x as f32).next_up() } else { x as f32 }),
        }
    }

    fn around(self, other: Self) -> Self {
        Self {
            lo: std::array::from_fn(|k| self.lo[k].min(other.lo[k])),
            hi: std::array::from_fn(|k| self.hi[k].max(other.hi[k])),
        }
    }

    #[inline]
    fn meets(&self, other: &Self) -> bool {
        (0..3).all(|k| self.lo[k] <= other.hi[k] && other.lo[k] <= self.hi[k])
    }
}

/// Boxes of faces in a balanced tree.
#[derive(Clone, Debug)]
pub(super) struct BoxTree {
    /// Face numbers in the order of the curve, and their boxes.
    faces: Vec<u32>,
    boxes: Vec<Bounds>,
    /// Heap order: the children of node `i` are `2i + 1` and `2i + 2`; the last level holds the leaves.
    nodes: Vec<Bounds>,
    /// Number of the first leaf.
    first_leaf: usize,
}

impl BoxTree {
    /// A tree over faces with their corners, boxes wider by `margin` all round. O(n log n).
    pub(super) fn new(faces: &[u32], corners: impl Fn(u32) -> [DVec3; 3] + Sync, margin: f64) -> Self {
        let whole = faces
            .par_iter()
            .map(|&f| corners(f))
            .map(|[a, b, c]| (a.min(b).min(c), a.max(b).max(c)))
            .reduce(|| (DVec3::INFINITY, DVec3::NEG_INFINITY), |a, b| (a.0.min(b.0), a.1.max(b.1)));
        let scale = CURVE_CELLS / (whole.1 - whole.0).max_element().max(1.0);
        // The place on the curve, and behind it the number.
        let mut order: Vec<u64> = faces
            .par_iter()
            .map(|&f| {
                let [a, b, c] = corners(f);
                let middle = (a.min(b).min(c) + a.max(b).max(c)) / 2.0;
                u64::from(morton((middle - whole.0) * scale)) << 32 | u64::from(f)
            })
            .collect();
        order.par_sort_unstable();
        let faces: Vec<u32> = order.into_iter().map(|k| k as u32).collect();
        let boxes: Vec<Bounds> = faces.par_iter().map(|&f| Bounds::of(corners(f), margin)).collect();
        let leaves = faces.len().div_ceil(LEAF).next_power_of_two();
        let first_leaf = leaves - 1;
        let mut nodes = vec![Bounds::EMPTY; first_leaf + leaves];
        for (leaf, boxes) in boxes.chunks(LEAF).enumerate() {
            nodes[first_leaf + leaf] = boxes.iter().fold(Bounds::EMPTY, |all, b| all.around(*b));
        }
        for node in (0..first_leaf).rev() {
            nodes[node] = nodes[2 * node + 1].around(nodes[2 * node + 2]);
        }
        Self { faces, boxes, nodes, first_leaf }
    }

    /// What `visit` makes of all pairs of faces whose boxes overlap, each once, in an order that depends on the tree alone.
    pub(super) fn own_pairs<T: Send>(&self, visit: &(impl Fn(u32, u32, &mut Vec<T>) + Sync)) -> Vec<T> {
        self.within(0, FORKS, visit)
    }

    /// The same for pairs of a face of this tree and one of another.
    pub(super) fn pairs_with<T: Send>(
        &self,
        other: &Self,
        visit: &(impl Fn(u32, u32, &mut Vec<T>) + Sync),
    ) -> Vec<T> {
        self.between(0, other, 0, FORKS, visit)
    }

    /// All faces whose box meets the box of three points, in the tree's order.
    pub(super) fn faces_near(&self, corners: [DVec3; 3], mut found: impl FnMut(u32)) {
        let wanted = Bounds::of(corners, 0.0);
        let mut pending = vec![0usize];
        while let Some(node) = pending.pop() {
            if !self.nodes[node].meets(&wanted) {
                continue;
            }
            if node < self.first_leaf {
                pending.extend([2 * node + 2, 2 * node + 1]);
            } else {
                self.leaf(node).filter(|&k| self.boxes[k].meets(&wanted)).for_each(|k| found(self.faces[k]));
            }
        }
    }

    fn leaf(&self, node: usize) -> std::ops::Range<usize> {
        let start = (node - self.first_leaf) * LEAF;
        start.min(self.faces.len())..(start + LEAF).min(self.faces.len())
    }

    fn within<T: Send>(
        &self,
        node: usize,
        forks: u32,
        visit: &(impl Fn(u32, u32, &mut Vec<T>) + Sync),
    ) -> Vec<T> {
        let mut found = Vec::new();
        if forks == 0 || node >= self.first_leaf {
            self.within_serially(node, visit, &mut found);
            return found;
        }
        let (left, right) = (2 * node + 1, 2 * node + 2);
        let ((mut a, b), c) = rayon::join(
            || rayon::join(|| self.within(left, forks - 1, visit), || self.within(right, forks - 1, visit)),
            || self.between(left, self, right, forks - 1, visit),
        );
        a.extend(b);
        a.extend(c);
        a
    }

    fn within_serially<T>(&self, node: usize, visit: &impl Fn(u32, u32, &mut Vec<T>), found: &mut Vec<T>) {
        if node >= self.first_leaf {
            let leaf = self.leaf(node);
            for i in leaf.clone() {
                for k in i + 1..leaf.end {
                    if self.boxes[i].meets(&self.boxes[k]) {
                        visit(self.faces[i], self.faces[k], found);
                    }
                }
            }
            return;
        }
        self.within_serially(2 * node + 1, visit, found);
        self.within_serially(2 * node + 2, visit, found);
        self.between_serially(2 * node + 1, self, 2 * node + 2, visit, found);
    }

    fn between<T: Send>(
        &self,
        node: usize,
        other: &Self,
        other_node: usize,
        forks: u32,
        visit: &(impl Fn(u32, u32, &mut Vec<T>) + Sync),
    ) -> Vec<T> {
        let mut found = Vec::new();
        if !self.nodes[node].meets(&other.nodes[other_node]) {
            return found;
        }
        if forks == 0 || node >= self.first_leaf || other_node >= other.first_leaf {
            self.between_serially(node, other, other_node, visit, &mut found);
            return found;
        }
        let halves = |n| [2 * n + 1, 2 * n + 2];
        let quarters: Vec<Vec<T>> = halves(node)
            .into_par_iter()
            .flat_map(|a| halves(other_node).into_par_iter().map(move |b| (a, b)))
            .map(|(a, b)| self.between(a, other, b, forks - 1, visit))
            .collect();
        quarters.into_iter().for_each(|q| found.extend(q));
        found
    }

    fn between_serially<T>(
        &self,
        node: usize,
        other: &Self,
        other_node: usize,
        visit: &impl Fn(u32, u32, &mut Vec<T>),
        found: &mut Vec<T>,
    ) {
        if !self.nodes[node].meets(&other.nodes[other_node]) {
            return;
        }
        let (inner, other_inner) = (node < self.first_leaf, other_node < other.first_leaf);
        match (inner, other_inner) {
            (false, false) => {
                for i in self.leaf(node) {
                    for k in other.leaf(other_node) {
                        if self.boxes[i].meets(&other.boxes[k]) {
                            visit(self.faces[i], other.faces[k], found);
                        }
                    }
                }
            }
            (true, true) => {
                for a in [2 * node + 1, 2 * node + 2] {
                    for b in [2 * other_node + 1, 2 * other_node + 2] {
                        self.between_serially(a, other, b, visit, found);
                    }
                }
            }
            (true, false) => {
                for a in [2 * node + 1, 2 * node + 2] {
                    self.between_serially(a, other, other_node, visit, found);
                }
            }
            (false, true) => {
                for b in [2 * other_node + 1, 2 * other_node + 2] {
                    self.between_serially(node, other, b, visit, found);
                }
            }
        }
    }
}

/// Cells of the curve along an axis.
const CURVE_CELLS: f64 = ((1u32 << 10) - 1) as f64;

/// The place of a cell on the curve: the bits of its three coordinates by turns.
fn morton(cell: DVec3) -> u32 {
    let spread = |x: f64| {
        let mut x = x as u32 & 0x3ff;
        x = (x | x << 16) & 0x0300_00ff;
        x = (x | x << 8) & 0x0300_f00f;
        x = (x | x << 4) & 0x030c_30c3;
        (x | x << 2) & 0x0924_9249
    };
    spread(cell.x) | spread(cell.y) << 1 | spread(cell.z) << 2
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Small triangles strewn over a cube.
    fn strewn(n: u32, seed: u64) -> Vec<[DVec3; 3]> {
        let mut state = seed;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            (state >> 33) as f64 / f64::from(1u32 << 31)
        };
        (0..n)
            .map(|_| {
                let p = DVec3::new(next(), next(), next()) * 1000.0;
                std::array::from_fn(|_| p + DVec3::new(next(), next(), next()) * 90.0)
            })
            .collect()
    }

    #[test]
    fn every_overlapping_pair_is_found_once() {
        let overlap = |a: &[DVec3; 3], b: &[DVec3; 3]| {
            let bounds = |t: &[DVec3; 3]| (t[0].min(t[1]).min(t[2]), t[0].max(t[1]).max(t[2]));
            let ((al, ah), (bl, bh)) = (bounds(a), bounds(b));
            al.cmple(bh).all() && bl.cmple(ah).all()
        };
        for n in [1, 2, 5, 300] {
            let (one, other) = (strewn(n, 7), strewn(n / 2 + 1, 9));
            let numbers: Vec<u32> = (0..n).collect();
            let tree = BoxTree::new(&numbers, |f| one[f as usize], 0.0);
            let visit = |a: u32, b: u32, out: &mut Vec<(u32, u32)>| out.push((a.min(b), a.max(b)));
            let mut found = tree.own_pairs(&visit);
            found.sort_unstable();
            let pairs = (0..n).flat_map(|a| (a + 1..n).map(move |b| (a, b)));
            // Boxes are rounded outward: none may be missing.
            let wanted: Vec<_> =
                pairs.filter(|&(a, b)| overlap(&one[a as usize], &one[b as usize])).collect();
            assert!(wanted.iter().all(|p| found.binary_search(p).is_ok()));
            assert!(found.windows(2).all(|w| w[0] != w[1]));

            let numbers: Vec<u32> = (0..other.len() as u32).collect();
            let second = BoxTree::new(&numbers, |f| other[f as usize], 0.0);
            let mut found = tree.pairs_with(&second, &|a, b, out: &mut Vec<(u32, u32)>| out.push((a, b)));
            found.sort_unstable();
            for (a, t) in one.iter().enumerate() {
                let mut near = Vec::new();
                second.faces_near(*t, |b| near.push(b));
                for (b, u) in other.iter().enumerate().filter(|(_, u)| overlap(t, u)) {
                    assert!(found.binary_search(&(a as u32, b as u32)).is_ok());
                    assert!(near.contains(&(b as u32)), "{u:?}");
                }
            }
            assert!(found.windows(2).all(|w| w[0] != w[1]));
        }
    }
}
