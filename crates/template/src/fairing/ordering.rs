//! Elimination order by geometric nested dissection: halve the nodes by their places, eliminate the halves first and what
//! separates them last (George 1973). On surfaces the factor stays near n log n entries.

use glam::DVec3;

/// Parts below this size are left in their order of coordinates: the factor's small fronts do not gain any more.
const LEAF: usize = 48;

/// An elimination order: `order[new] = old`. The matrix' lower triangle is given by columns. Deterministic;
/// O(n log² n).
pub(super) fn nested_dissection(columns: &[u32], rows: &[u32], places: &[DVec3]) -> Vec<u32> {
    let n = places.len();
    // Neighbours both ways.
    let mut starts = vec![0u32; n + 1];
    let each = |f: &mut dyn FnMut(usize, usize)| {
        for c in 0..n {
            for r in &rows[columns[c] as usize..columns[c + 1] as usize] {
                if *r as usize != c {
                    f(c, *r as usize);
                    f(*r as usize, c);
                }
            }
        }
    };
    each(&mut |a, _| starts[a + 1] += 1);
    for i in 0..n {
        starts[i + 1] += starts[i];
    }
    let mut fill = starts.clone();
    let mut neighbours = vec![0u32; starts[n] as usize];
    each(&mut |a, b| {
        neighbours[fill[a] as usize] = b as u32;
        fill[a] += 1;
    });
    let graph = Graph { starts, neighbours, places };
    let mut nodes: Vec<u32> = (0..n as u32).collect();
    let mut order = vec![0u32; n];
    // 0 outside the part, 1 lower half, 2 upper half
    let mut side = vec![0u8; n];
    // (part of `nodes`, where its order begins); separators are written at the ends of parts.
    let mut stack = vec![(0usize, n, 0usize)];
    while let Some((from, to, at)) = stack.pop() {
        let part = &mut nodes[from..to];
        if part.len() <= LEAF {
            part.sort_unstable();
            order[at..at + part.len()].copy_from_slice(part);
            continue;
        }
        let separator = graph.halve(part, &mut side);
        // `part` is now: lower half, upper half, separator.
        let (lower, upper) = separator;
        let cut = lower + upper;
        order[at + cut..at + part.len()].copy_from_slice(&part[cut..]);
        stack.push((from, from + lower, at));
        stack.push((from + lower, from + cut, at + lower));
    }
    order
}

struct Graph<'a> {
    starts: Vec<u32>,
    neighbours: Vec<u32>,
    places: &'a [DVec3],
}

impl Graph<'_> {
    fn of(&self, v: u32) -> &[u32] {
        &self.neighbours[self.starts[v as usize] as usize..self.starts[v as usize + 1] as usize]
    }

    /// Sorts `part` into lower half, upper half and separator, and tells the sizes of the halves.
    fn halve(&self, part: &mut [u32], side: &mut [u8]) -> (usize, usize) {
        let place = |v: u32| self.places[v as usize];
        let (mut low, mut high) = (DVec3::INFINITY, DVec3::NEG_INFINITY);
        for &v in part.iter() {
            low = low.min(place(v));
            high = high.max(place(v));
        }
        let extent = high - low;
        let axis = if extent.x >= extent.y && extent.x >= extent.z {
            0
        } else if extent.y >= extent.z {
            1
        } else {
            2
        };
        let key = |v: u32| place(v)[axis];
        let half = part.len() / 2;
        part.select_nth_unstable_by(half, |a, b| key(*a).total_cmp(&key(*b)).then(a.cmp(b)));
        for (i, v) in part.iter().enumerate() {
            side[*v as usize] = if i < half { 1 } else { 2 };
        }
        // The separator: nodes of the lower half that touch the upper one.
        let (mut lower, mut upper, mut cut) = (Vec::new(), Vec::new(), Vec::new());
        for &v in part.iter() {
            if side[v as usize] == 2 {
                upper.push(v);
            } else if self.of(v).iter().any(|w| side[*w as usize] == 2) {
                cut.push(v);
            } else {
                lower.push(v);
            }
        }
        for v in part.iter() {
            side[*v as usize] = 0;
        }
        lower.sort_unstable();
        upper.sort_unstable();
        // Along the cut, neighbours follow each other, which keeps the last front's rows together.
        cut.sort_by(|a, b| {
            let (p, q) = (place(*a), place(*b));
            let other = [(axis + 1) % 3, (axis + 2) % 3];
            p[other[0]].total_cmp(&q[other[0]]).then(p[other[1]].total_cmp(&q[other[1]])).then(a.cmp(b))
        });
        let sizes = (lower.len(), upper.len());
        for (slot, v) in part.iter_mut().zip(lower.into_iter().chain(upper).chain(cut)) {
            *slot = v;
        }
        sizes
    }
}
