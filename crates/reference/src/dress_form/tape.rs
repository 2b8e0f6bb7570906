//! Measuring the half mesh with a tape, and bringing it to the asked girths.

use super::curve::Curve;
use super::error::FormError;
use super::field::{ARM, Field};
use super::hull::hull_length;
use super::levels::Levels;
use super::measurements::Resolved;
use super::patch::Patch;
use super::sections::CREASE;

/// Tape girths of the whole form, mirrored from its half, at ascending heights; 0 where nothing is cut. O(faces · levels cut).
pub(super) fn girths(half: &Patch, heights: &[f64]) -> Vec<f64> {
    let mut points: Vec<Vec<[f64; 2]>> = vec![Vec::new(); heights.len()];
    for face in &half.faces {
        let p = face.map(|v| half.positions[v as usize]);
        let low = p[0].y.min(p[1].y).min(p[2].y);
        let high = p[0].y.max(p[1].y).max(p[2].y);
        let first = heights.partition_point(|&y| y < low);
        for (k, &y) in heights.iter().enumerate().skip(first) {
            if y > high {
                break;
            }
            for i in 0..3 {
                let (a, b) = (p[i], p[(i + 1) % 3]);
                if (a.y <= y) != (b.y <= y) {
                    let t = (y - a.y) / (b.y - a.y);
                    let (x, z) = (a.x + t * (b.x - a.x), a.z + t * (b.z - a.z));
                    points[k].extend([[x, z], [-x, z]]);
                }
            }
        }
    }
    points.iter_mut().map(|points| hull_length(points)).collect()
}

/// Curvature of the girth's profile at its extremes, 1/mm: how far the profile at least bends away from a fullest or
/// narrowest girth (0.6 mm at 20 mm).
const BEND: f64 = 0.0015;

/// Factor of width and depth by height that makes the girths right at their levels. Above the bust the trunk stays a little
/// narrower than the bust, so that no other girth than the bust's own is the fullest.
pub(super) fn correction(half: &Patch, field: &Field, m: &Resolved) -> Curve {
    let levels = &field.levels;
    let h = levels.stature;
    let bust = m.bust * 10.0;
    let room = levels.armpit - levels.bust;
    let wanted = [
        (levels.hip, m.hip * 10.0),
        (levels.high_hip, m.high_hip * 10.0),
        (levels.waist, m.waist * 10.0),
        (levels.underbust, m.underbust * 10.0),
        (levels.bust, bust),
    ];
    let upper = [(levels.bust + 0.35 * room, 0.998 * bust), (levels.armpit - UNDERARM * h, 0.993 * bust)];
    let heights: Vec<f64> = wanted.iter().chain(&upper).map(|w| w.0).collect();
    let now = girths(half, &heights);
    let factor = |i: usize, want: f64| want / now[i].max(1.0);
    let mut points: Vec<(f64, f64)> = (0..5).map(|i| (heights[i], factor(i, wanted[i].1))).collect();
    let mut last = points[4].1;
    for (i, (y, most)) in upper.into_iter().enumerate() {
        // Never fuller there than measured, and never more squeezed than the level below by much.
        last = factor(5 + i, most).min(last).max(0.93 * last);
        points.push((y, last));
    }
    points.extend([
        (levels.crotch - 0.03 * h, 1.0),
        (levels.crotch - 0.02 * h, 1.0),
        (levels.armpit, 0.3 + 0.7 * last),
        (levels.shoulder, 1.0),
        (levels.shoulder + 0.01 * h, 1.0),
    ]);
    Curve::through(&points)
}

/// Below the armpit, shares of stature, where the arm already swells the section: no fullest girth is looked for there.
const UNDERARM: f64 = 0.012;

/// The correction, and every girth near an extreme held below (above) an arc through it, so that a tape that looks for the
/// fullest or narrowest finds the asked girth.
pub(super) fn level_extremes(half: &Patch, field: &Field, m: &Resolved) -> Curve {
    let levels = &field.levels;
    let h = levels.stature;
    let [hip, waist, bust] = [m.hip * 10.0, m.waist * 10.0, m.bust * 10.0];
    let factor = correction(half, field, m);
    let at = [levels.hip, levels.high_hip, levels.waist, levels.underbust, levels.bust];
    let (low, high) = (levels.crotch - 0.02 * h, levels.armpit);
    let count = ((high - low) / 4.0).ceil() as usize;
    let mut heights: Vec<f64> = (0..=count).map(|i| low + (high - low) * i as f64 / count as f64).collect();
    heights.retain(|y| at.iter().all(|a| (y - a).abs() > 1.0));
    heights.extend(at);
    heights.sort_by(f64::total_cmp);
    let measured = girths(half, &heights);
    let arc = |y: f64, level: f64| 0.5 * BEND * (y - level).powi(2);
    // The ribs above a waist that is no narrower may be narrower again: there the waist is the least up to the lowest roll.
    let ribs = levels.waist + 0.55 * (levels.underbust - levels.waist);
    let underbust = 10.0 * m.underbust;
    let mut points: Vec<(f64, f64)> = heights
        .iter()
        .zip(&measured)
        .map(|(&y, &girth)| {
            let f = factor.get(y);
            let got = girth * f;
            let mut goal = got;
            if y < levels.waist && hip > waist {
                goal = goal.min(hip - arc(y, levels.hip));
            }
            if y > levels.underbust && y < levels.armpit - UNDERARM * h && m.bust > m.underbust {
                goal = goal.min(bust - arc(y, levels.bust));
            }
            let belly = y > levels.waist && m.waist > CREASE * m.underbust;
            if y > levels.hip && y < levels.underbust && waist < hip && !belly {
                let floor = match (y > levels.waist, y > ribs) {
                    (false, _) => (waist + arc(y, levels.waist)).min(hip),
                    (true, false) => (waist + arc(y, levels.waist)).min(underbust.max(waist)),
                    (true, true) => {
                        let t = (y - ribs) / (levels.underbust - ribs);
                        let falling = waist + (underbust - waist).min(0.0) * t * t;
                        (waist + arc(y, levels.waist)).min(falling.max(underbust.min(waist)))
                    }
                };
                goal = goal.max(floor);
            }
            (y, if got > 0.0 { f * goal / got } else { f })
        })
        .collect();
    for y in [
        levels.armpit + 0.25 * (levels.shoulder - levels.armpit),
        levels.shoulder,
        levels.shoulder + 0.01 * h,
    ] {
        points.push((y, factor.get(y)));
    }
    points.push((levels.crotch - 0.03 * h, 1.0));
    Curve::through(&points)
}

/// Scales the half mesh's sections about their middles; plates stay plane.
pub(super) fn warp(half: &mut Patch, field: &Field, factor: &Curve) {
    let levels = &field.levels;
    for p in &mut half.positions {
        // Nothing above the shoulders and on the legs is touched.
        if p.y < levels.crotch - 0.03 * levels.stature || p.y > levels.shoulder {
            continue;
        }
        let f = factor.get(p.y);
        let centre = field.sections.at(p.y).centre;
        p.x *= f;
        p.z = centre + f * (p.z - centre);
    }
    let arm = field.cuts[ARM];
    let mut on_arm = vec![false; half.positions.len()];
    for (face, &label) in half.faces.iter().zip(&half.label) {
        if label as usize == ARM + 1 {
            face.iter().for_each(|&v| on_arm[v as usize] = true);
        }
    }
    for (p, _) in half.positions.iter_mut().zip(&on_arm).filter(|(_, on)| **on) {
        p.x -= arm.over(*p) / arm.normal.x;
    }
}

/// Whether the girths are what was asked for.
pub(super) fn check(half: &Patch, levels: &Levels, m: &Resolved) -> Result<(), FormError> {
    let wanted =
        [("hip", levels.hip, m.hip), ("waist", levels.waist, m.waist), ("bust", levels.bust, m.bust)];
    let got = girths(half, &wanted.map(|w| w.1));
    for ((name, _, wanted), got) in wanted.into_iter().zip(got) {
        let got = got / 10.0;
        if (got - wanted).abs() > 0.1 {
            return Err(FormError::NotReached { name, wanted, got });
        }
    }
    Ok(())
}
