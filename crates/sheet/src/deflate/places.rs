//! Places in space, to be found from near by.

use std::collections::BTreeMap;

use glam::DVec3;

/// Segments are points that are this many to a size apart.
const DENSE: f64 = 2.0;
/// What is within the size of a segment is within so many of one of its points.
const NEAR: f64 = 1.05;

/// Points that are found from within a size of them.
pub(super) struct Places {
    cells: BTreeMap<[i64; 3], Vec<DVec3>>,
    size: f64,
}

impl Places {
    /// O(n log n).
    pub(super) fn new(points: impl IntoIterator<Item = DVec3>, size: f64) -> Self {
        let mut places = Self { cells: BTreeMap::new(), size };
        for p in points {
            places.cells.entry(places.cell(p)).or_default().push(p);
        }
        places
    }

    /// All along some segments.
    pub(super) fn along(segments: &[[DVec3; 2]], size: f64) -> Self {
        let points = |&[a, b]: &[DVec3; 2]| {
            let count = (DENSE * a.distance(b) / size).ceil().max(1.0);
            (0..=count as u32).map(move |k| a.lerp(b, f64::from(k) / count))
        };
        Self::new(segments.iter().flat_map(points), NEAR * size)
    }

    /// Whether one is nearer than the size.
    pub(super) fn has(&self, p: DVec3) -> bool {
        let [x, y, z] = self.cell(p);
        let cells =
            (0..27).filter_map(|k| self.cells.get(&[x + k % 3 - 1, y + k / 3 % 3 - 1, z + k / 9 - 1]));
        cells.flatten().any(|q| p.distance(*q) < self.size)
    }

    fn cell(&self, p: DVec3) -> [i64; 3] {
        (p / self.size).floor().to_array().map(|x| x as i64)
    }
}
