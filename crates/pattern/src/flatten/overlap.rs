//! Whether a flat piece lies on itself.
//!
//! A map without flips whose boundary does not cross itself is one to one, so that only the boundary is looked at.

use glam::DVec2;
use robust::{Coord, orient2d};

/// Sides of a cut that lie on each other cross by rounding errors; less than this (in mm) is touching.
const TOUCH: f64 = 1e-6;

/// Number of pairs of boundary edges that cross. Signs are exact. O(n log n + pairs overlapping in x).
pub(crate) fn crossings(flat: &[DVec2], loops: &[Vec<u32>]) -> usize {
    let mut edges: Vec<[u32; 2]> = Vec::new();
    for rim in loops {
        edges.extend((0..rim.len()).map(|i| [rim[i], rim[(i + 1) % rim.len()]]));
    }
    let at = |v: u32| flat[v as usize];
    let low = |e: &[u32; 2]| at(e[0]).min(at(e[1]));
    let high = |e: &[u32; 2]| at(e[0]).max(at(e[1]));
    edges.sort_by(|a, b| low(a).x.total_cmp(&low(b).x).then(a.cmp(b)));
    let mut count = 0;
    let mut active: Vec<usize> = Vec::new();
    for (i, e) in edges.iter().enumerate() {
        let (l, h) = (low(e), high(e));
        active.retain(|&k| high(&edges[k]).x >= l.x);
        for &k in &active {
            let g = &edges[k];
            if low(g).y > h.y || high(g).y < l.y || g.iter().any(|v| e.contains(v)) {
                continue;
            }
            count += usize::from(cross([at(e[0]), at(e[1])], [at(g[0]), at(g[1])]));
        }
        active.push(i);
    }
    count
}

fn cross([a, b]: [DVec2; 2], [c, d]: [DVec2; 2]) -> bool {
    let side = |p: DVec2, q: DVec2, r: DVec2| {
        let coord = |v: DVec2| Coord { x: v.x, y: v.y };
        orient2d(coord(p), coord(q), coord(r))
    };
    let (s, t) = (side(a, b, c), side(a, b, d));
    let (u, v) = (side(c, d, a), side(c, d, b));
    let opposite = |p: f64, q: f64| (p > 0.0 && q < 0.0) || (p < 0.0 && q > 0.0);
    opposite(s, t)
        && opposite(u, v)
        && s.abs().min(t.abs()) > TOUCH * a.distance(b)
        && u.abs().min(v.abs()) > TOUCH * c.distance(d)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn square_is_simple_and_bow_tie_is_not() {
        let p = [DVec2::ZERO, DVec2::X, DVec2::ONE, DVec2::Y];
        assert_eq!(crossings(&p, &[vec![0, 1, 2, 3]]), 0);
        assert_eq!(crossings(&p, &[vec![0, 1, 3, 2]]), 1);
    }
}
