//! Front or back: several marks vote, because each alone fails on some body (no feet on a dress form, a flat chest,
//! a large belly).

use mesh_kernel::glam::DVec2;

use super::figure::{Figure, Level};
use super::joins::Proportions;
use super::ring::depth_at;

/// Positive if the body faces +z; near zero if nothing tells.
pub(crate) fn votes(figure: &Figure<'_>, proportions: &Proportions) -> f64 {
    let h = proportions.stature();
    let levels = |from: f64, to: f64| figure.between(proportions.height(from), proportions.height(to));
    let vote = |evidence: Option<f64>, clear: f64, weight: f64| {
        evidence.map_or(0.0, |e| (e / (clear * h)).clamp(-1.0, 1.0) * weight)
    };
    let depths = |from: f64, to: f64| {
        let spans: Vec<[f64; 2]> = levels(from, to).iter().filter_map(midline).collect();
        let n = spans.len() as f64;
        (n > 0.0).then(|| {
            [spans.iter().map(|s| s[0]).sum::<f64>() / n, spans.iter().map(|s| s[1]).sum::<f64>() / n]
        })
    };
    let toes = centre(figure.between(0.0, 0.02 * h)).zip(centre(levels(0.06, 0.10)));
    let mut sum = vote(toes.map(|(f, a)| f.y - a.y), 0.012, 4.0);
    if h < 1.01 * figure.height {
        // The chin overhangs the throat by more than the back of the head overhangs the nape.
        let (face, neck) = (depths(0.88, 0.93), depths(0.845, 0.865));
        sum += vote(face.zip(neck).map(|(f, n)| (f[1] - n[1]) - (n[0] - f[0])), 0.02, 1.0);
    }
    // The chest slopes forward below the neck; the back falls nearly straight.
    let chest = depths(0.70, 0.75);
    let base = depths(0.82, 0.845);
    sum += vote(chest.zip(base).map(|(c, n)| (c[1] - n[1]) - (n[0] - c[0])), 0.02, 1.5);
    // Seat behind, cleft behind, hollow between the breasts in front.
    let (seat, loin) = (depths(0.49, 0.53), depths(0.60, 0.64));
    sum += vote(seat.zip(loin).map(|(s, l)| (l[0] - s[0]) - (s[1] - l[1])), 0.02, 1.0);
    sum += vote(hollow(levels(0.49, 0.54)), 0.008, 1.5);
    sum -= vote(hollow(levels(0.69, 0.74)), 0.012, 1.5);
    sum
}

fn midline(level: &Level) -> Option<[f64; 2]> {
    depth_at(&level.trunk()?.points, 0.0)
}

/// Area centroid of all outlines of some levels.
fn centre(levels: &[Level]) -> Option<DVec2> {
    let (mut area, mut moment) = (0.0, DVec2::ZERO);
    for r in levels.iter().flat_map(|l| &l.rings) {
        area += r.area;
        moment += r.centroid * r.area;
    }
    (area > 0.0).then(|| moment / area)
}

/// How much deeper the skin on the plane of symmetry lies under the taut outline at the back than in front.
fn hollow(levels: &[Level]) -> Option<f64> {
    let gaps: Vec<f64> = levels
        .iter()
        .filter_map(|l| {
            let ring = l.trunk()?;
            let (skin, taut) = (depth_at(&ring.points, 0.0)?, depth_at(&ring.hull(), 0.0)?);
            Some((skin[0] - taut[0]) - (taut[1] - skin[1]))
        })
        .collect();
    (!gaps.is_empty()).then(|| gaps.iter().sum::<f64>() / gaps.len() as f64)
}
