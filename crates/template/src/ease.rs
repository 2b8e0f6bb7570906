//! Ease: what a tape measure reads round the garment less what it reads round the body.

use std::collections::BTreeMap;

use glam::DVec3;
use mesh_kernel::query::tape_length;
use reference::FeatureCurve;

/// Girth that one millimetre outward adds all round: the first guess.
const GIRTH_PER_PUSH: f64 = std::f64::consts::TAU;

/// A horizontal section: pieces of it, each a connected curve.
struct Piece {
    points: Vec<DVec3>,
    closed: bool,
}

/// Cuts faces at a height; connected pieces, in order of their first face. O(n + m log m) for m faces cut.
fn cut(positions: &[DVec3], faces: &[[u32; 3]], height: f64) -> Vec<Piece> {
    // A node at the height counts as above, so no case is degenerate.
    let above = |v: u32| positions[v as usize].y >= height;
    let mut index: BTreeMap<[u32; 2], usize> = BTreeMap::new();
    let mut points: Vec<DVec3> = Vec::new();
    let mut links: Vec<[usize; 2]> = Vec::new();
    for f in faces {
        let mut ends = [usize::MAX; 2];
        let mut count = 0;
        for i in 0..3 {
            let (a, b) = (f[i], f[(i + 1) % 3]);
            if above(a) == above(b) {
                continue;
            }
            let key = [a.min(b), a.max(b)];
            let at = *index.entry(key).or_insert_with(|| {
                let (p, q) = (positions[key[0] as usize], positions[key[1] as usize]);
                points.push(p.lerp(q, (height - p.y) / (q.y - p.y)));
                points.len() - 1
            });
            ends[count] = at;
            count += 1;
        }
        if count == 2 {
            links.push(ends);
        }
    }
    let mut parent: Vec<usize> = (0..points.len()).collect();
    fn root(parent: &mut [usize], mut i: usize) -> usize {
        while parent[i] != i {
            parent[i] = parent[parent[i]];
            i = parent[i];
        }
        i
    }
    let mut degree = vec![0u32; points.len()];
    for [a, b] in &links {
        degree[*a] += 1;
        degree[*b] += 1;
        let (a, b) = (root(&mut parent, *a), root(&mut parent, *b));
        parent[a.max(b)] = a.min(b);
    }
    let mut pieces: BTreeMap<usize, Piece> = BTreeMap::new();
    for (i, p) in points.iter().enumerate() {
        let r = root(&mut parent, i);
        let piece = pieces.entry(r).or_insert_with(|| Piece { points: Vec::new(), closed: true });
        piece.points.push(*p);
        piece.closed &= degree[i] >= 2;
    }
    pieces.into_values().collect()
}

/// Mean height by length of a feature curve.
pub(crate) fn mean_height(curve: &FeatureCurve) -> f64 {
    let n = curve.points.len();
    let (mut sum, mut total) = (0.0, 0.0);
    for k in 1..n + usize::from(curve.closed) {
        let (a, b) = (curve.points[k - 1], curve.points[k % n]);
        let length = (b - a).length();
        sum += 0.5 * (a.y + b.y) * length;
        total += length;
    }
    if total > 0.0 { sum / total } else { curve.points[0].y }
}

/// Tape girth of a feature curve, mm.
pub(crate) fn body_girth(curve: &FeatureCurve) -> f64 {
    tape_length(&curve.points, DVec3::Y)
}

/// Tape girth of a garment round the body at the height of a feature curve; `None` when the garment does not go there.
///
/// The tape lies round all pieces of the section that belong to the trunk: closed loops that do not go round the
/// middle of the curve (sleeves) are left out.
pub(crate) fn garment_girth(positions: &[DVec3], faces: &[[u32; 3]], curve: &FeatureCurve) -> Option<f64> {
    let middle = curve.points.iter().sum::<DVec3>() / curve.points.len() as f64;
    let pieces = cut(positions, faces, mean_height(curve));
    let around = |p: &Piece| !p.closed || in_hull(&p.points, middle);
    let points: Vec<DVec3> =
        pieces.iter().filter(|p| around(p)).flat_map(|p| p.points.iter().copied()).collect();
    (points.len() >= 3).then(|| tape_length(&points, DVec3::Y))
}

/// Whether a place lies in the convex hull of points, seen from above: they are not all in one half turn around it.
fn in_hull(points: &[DVec3], middle: DVec3) -> bool {
    let mut angles: Vec<f64> = points.iter().map(|p| (p.x - middle.x).atan2(p.z - middle.z)).collect();
    angles.sort_by(f64::total_cmp);
    let turn = std::f64::consts::TAU;
    let wrap = angles.first().zip(angles.last()).map_or(turn, |(a, b)| a + turn - b);
    angles.windows(2).map(|w| w[1] - w[0]).fold(wrap, f64::max) < std::f64::consts::PI
}

/// One ease level on its way to the wanted girth: secant steps, kept between a push that was too small and one that was
/// too large once both are known.
#[derive(Clone, Debug)]
pub(crate) struct Secant {
    /// Outward offset of the level's nodes now, mm.
    pub(crate) push: f64,
    slope: f64,
    last: Option<[f64; 2]>,
    too_small: Option<f64>,
    too_large: Option<f64>,
}

/// Offsets beyond this are no ease any more, mm.
const FARTHEST: f64 = 45.0;

impl Secant {
    pub(crate) fn new() -> Self {
        Self { push: 0.0, slope: GIRTH_PER_PUSH, last: None, too_small: None, too_large: None }
    }

    /// Begins with the offset and the slope of another search, and that far on.
    pub(crate) fn warm(push: f64, slope: f64, farther: f64) -> Self {
        let push = (push + farther / slope).clamp(-FARTHEST, FARTHEST);
        Self { push, slope, ..Self::new() }
    }

    /// Girth that a millimetre of offset adds.
    pub(crate) fn slope(&self) -> f64 {
        self.slope
    }

    /// Forgets what other garments gave, keeps the offset and the slope.
    pub(crate) fn restart(&mut self) {
        *self = Self { push: self.push, slope: self.slope, ..Self::new() };
    }

    /// Takes a step from what the present offset gave (`girth` less the wanted one); `false` when it cannot move.
    pub(crate) fn step(&mut self, excess: f64) -> bool {
        if let Some([push, old]) = self.last
            && (self.push - push).abs() > 0.05
        {
            // Contact with the body flattens the slope; do not believe in one that would throw the nodes away.
            self.slope = ((excess - old) / (self.push - push)).clamp(2.0, 12.0);
        }
        self.last = Some([self.push, excess]);
        let side = if excess < 0.0 { &mut self.too_small } else { &mut self.too_large };
        *side = Some(self.push);
        let mut next = (self.push - excess / self.slope).clamp(-FARTHEST, FARTHEST);
        if let (Some(small), Some(large)) = (self.too_small, self.too_large) {
            if small >= large {
                // Other levels have moved the girth meanwhile: only the newest side counts.
                if excess < 0.0 { self.too_large = None } else { self.too_small = None }
            } else if next <= small || next >= large {
                next = 0.5 * (small + large);
            }
        }
        let moves = (next - self.push).abs() > 1e-3;
        self.push = next;
        moves
    }
}
