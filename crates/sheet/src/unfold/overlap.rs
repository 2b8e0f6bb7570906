//! Which facets lie on each other on the flat sheet.

use glam::DVec2;

/// A triangle of a facet.
pub(crate) struct Tile {
    owner: u32,
    piece: u32,
    corners: [DVec2; 3],
    low: DVec2,
    high: DVec2,
}

impl Tile {
    pub(crate) fn new(owner: u32, piece: u32, corners: [DVec2; 3]) -> Self {
        let [a, b, c] = corners;
        Self { owner, piece, corners, low: a.min(b).min(c), high: a.max(b).max(c) }
    }

    /// Whether two triangles have more in common than a border as wide as the tolerance: no line parts them (separating axes).
    fn meets(&self, other: &Self, tolerance: f64) -> bool {
        for (one, two) in [(self, other), (other, self)] {
            for i in 0..3 {
                let side = one.corners[(i + 1) % 3] - one.corners[i];
                let Some(axis) = side.perp().try_normalize() else { return false };
                let range = |t: &Self| {
                    let d = t.corners.map(|p| p.dot(axis));
                    (d[0].min(d[1]).min(d[2]), d[0].max(d[1]).max(d[2]))
                };
                let (a, b) = (range(one), range(two));
                if a.1.min(b.1) - a.0.max(b.0) <= tolerance {
                    return false;
                }
            }
        }
        true
    }
}

/// Pairs of owners, ascending, whose tiles in one piece overlap. Sorted by their left ends; O(n log n) where few lie side by
/// side.
pub(crate) fn pairs(mut tiles: Vec<Tile>, tolerance: f64) -> Vec<[u32; 2]> {
    tiles.sort_by(|a, b| a.piece.cmp(&b.piece).then(a.low.x.total_cmp(&b.low.x)).then(a.owner.cmp(&b.owner)));
    let mut found = Vec::new();
    for (i, a) in tiles.iter().enumerate() {
        for b in &tiles[i + 1..] {
            if b.piece != a.piece || b.low.x >= a.high.x - tolerance {
                break;
            }
            if a.owner != b.owner
                && a.low.y < b.high.y - tolerance
                && b.low.y < a.high.y - tolerance
                && a.meets(b, tolerance)
            {
                found.push([a.owner.min(b.owner), a.owner.max(b.owner)]);
            }
        }
    }
    found.sort_unstable();
    found.dedup();
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tile(owner: u32, at: [[f64; 2]; 3]) -> Tile {
        Tile::new(owner, 0, at.map(DVec2::from))
    }

    #[test]
    fn touching_is_no_overlap_and_sharing_a_strip_is() {
        let left = || tile(0, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        let over = || tile(1, [[1.0, 0.0], [1.0, 1.0], [0.0, 1.0]]);
        assert_eq!(pairs(vec![left(), over()], 1e-9), Vec::<[u32; 2]>::new());
        let same = tile(1, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        assert_eq!(pairs(vec![left(), same], 1e-9), [[0, 1]]);
        let shifted = tile(2, [[0.01, 0.0], [1.01, 0.0], [0.01, 1.0]]);
        assert_eq!(pairs(vec![left(), shifted], 1e-9), [[0, 2]]);
    }

    #[test]
    fn other_pieces_do_not_count() {
        let mut a = tile(0, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        let b = tile(1, [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]]);
        a.piece = 1;
        assert!(pairs(vec![a, b], 1e-9).is_empty());
    }
}
