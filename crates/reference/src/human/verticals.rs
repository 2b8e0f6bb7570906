//! Lines that run down the body: centre front and back, sides, princess lines; and the shoulder lines they hang from.
//!
//! Each is a graph over the height: a planar coordinate (left for centre and princess lines, front for the sides) is a
//! smooth function of the height through anatomical knots, the other one is read off the outline at that height. Each
//! therefore crosses every level curve once. From the hip down the outline is exchanged for the taut one, which bridges
//! the cleft and the gap between the legs as cloth does.

use mesh_kernel::glam::{DVec2, DVec3};
use rayon::prelude::*;

use super::figure::{Figure, Side, monotone_cubic, ramp, smooth};
use super::girths::TrunkLevels;
use super::marks::Marks;
use super::normals::NormalField;
use super::ring::{breadth_at, depth_at, perimeter};
use crate::model::{FeatureCurve, Features};

/// Distance of the points of a line, millimetres.
const SPACING: f64 = 6.0;
/// Smoothing along a line, in points.
const SIGMA: f64 = 2.0;
/// Where princess lines cross waist and hips, as a part of the half breadth: in front, behind.
const PRINCESS_FRONT: [f64; 2] = [0.54, 0.54];
const PRINCESS_BACK: [f64; 2] = [0.50, 0.54];

/// Outlines at one height.
struct Outline {
    y: f64,
    skin: Option<Vec<DVec2>>,
    taut: Vec<DVec2>,
}

impl Outline {
    fn bounds(&self) -> (DVec2, DVec2) {
        self.taut.iter().fold((DVec2::MAX, DVec2::MIN), |(lo, hi), p| (lo.min(*p), hi.max(*p)))
    }
}

/// Adds the lines.
pub(crate) fn add(
    figure: &Figure<'_>,
    marks: &Marks,
    levels: &TrunkLevels,
    field: &NormalField,
    features: &mut Features,
) -> Result<(), String> {
    let lines = Lines { figure, marks, levels, field, outlines: outlines(figure, marks, levels)? };
    lines.centre(true, features);
    lines.centre(false, features);
    for side in Side::BOTH {
        let line = &marks.shoulder_line[side.index()];
        let normals = line.iter().map(|p| field.at(*p, DVec3::Y)).collect();
        features.curves.insert(
            side.name("shoulder_line"),
            FeatureCurve { closed: false, points: line.clone(), normals: smooth_normals(normals) },
        );
        lines.side(side, features);
        lines.princess(side, true, features);
        lines.princess(side, false, features);
    }
    Ok(())
}

/// Outlines from the shoulders down to the ankles. Where a form ends above the floor (on a pole, say) the last full
/// outline is carried on plumb.
fn outlines(figure: &Figure<'_>, marks: &Marks, levels: &TrunkLevels) -> Result<Vec<Outline>, String> {
    let top = marks.nape.y.max(marks.shoulder_line.iter().flatten().map(|p| p.y).fold(0.0, f64::max));
    let hip_tape = figure.at(levels.hip).envelope().map(|e| perimeter(&e)).ok_or("the hip has no outline")?;
    struct Found {
        y: f64,
        skin: Option<Vec<DVec2>>,
        taut: Option<Vec<DVec2>>,
    }
    let found: Vec<Found> = figure
        .between(0.05 * figure.height, top)
        .par_iter()
        .map(|l| match marks.trunk(l) {
            Some(trunk) => Found { y: l.y, taut: Some(trunk.hull()), skin: Some(trunk.points) },
            None => Found { y: l.y, taut: l.envelope(), skin: None },
        })
        .collect();
    let mut out: Vec<Outline> = Vec::with_capacity(found.len());
    let mut last: Option<Vec<DVec2>> = None;
    for Found { y, skin, taut } in found.into_iter().rev() {
        let below_hip = y < levels.hip;
        let full = taut.filter(|t| !below_hip || perimeter(t) > 0.6 * hip_tape);
        match (full, &last) {
            (Some(taut), _) => {
                last = Some(taut.clone());
                out.push(Outline { y, skin, taut });
            }
            (None, Some(carried)) if below_hip => out.push(Outline { y, skin: None, taut: carried.clone() }),
            _ => {}
        }
    }
    if out.len() < 20 { Err("the trunk has too few outlines".to_owned()) } else { Ok(out) }
}

struct Lines<'a> {
    figure: &'a Figure<'a>,
    marks: &'a Marks,
    levels: &'a TrunkLevels,
    field: &'a NormalField,
    /// From the top down.
    outlines: Vec<Outline>,
}

impl Lines<'_> {
    /// How far the skin is exchanged for the taut outline: 0 at the hip, 1 at the crotch.
    fn tautness(&self, y: f64, from: f64, to: f64) -> f64 {
        1.0 - ramp(to, from.max(to + 1.0), y)
    }

    fn centre(&self, front: bool, features: &mut Features) {
        let start = if front { self.marks.front_neck } else { self.marks.nape };
        // The cleft begins above the hip; in front the taut outline differs only near the crotch.
        let (from, to) = (self.levels.high_hip, self.levels.hip);
        let points = self.down(start, |o| {
            let value = |p: &[DVec2]| depth_at(p, 0.0).map(|d| d[usize::from(front)]);
            let taut = value(&o.taut)?;
            let skin = o.skin.as_deref().and_then(value).unwrap_or(taut);
            let w = self.tautness(o.y, from, to);
            Some(DVec3::new(0.0, o.y, skin + w * (taut - skin)))
        });
        self.insert(if front { "centre_front" } else { "centre_back" }.to_owned(), points, features);
    }

    fn side(&self, side: Side, features: &mut Features) {
        let start = self.marks.armpit[side.index()];
        let middle = |y: f64| self.bounds_at(y).map(|(lo, hi)| (lo.y + hi.y) / 2.0);
        let mut knots: Vec<(f64, f64)> = [
            0.05 * self.figure.height,
            0.5 * self.marks.crotch_level,
            self.marks.crotch_level,
            self.levels.hip.max(self.marks.crotch_level + 20.0),
            self.levels.waist,
        ]
        .into_iter()
        .filter_map(|y| middle(y).map(|z| (y, z)))
        .collect();
        knots.push((start.y, start.z));
        let s = side.sign();
        let points = self.down(start, |o| {
            let z = monotone_cubic(&knots, o.y);
            let value = |p: &[DVec2]| {
                breadth_at(p, z).map(|b| if side == Side::Left { b[1] } else { b[0] }).filter(|x| x * s > 0.0)
            };
            let taut = value(&o.taut)?;
            let skin = o.skin.as_deref().and_then(value).unwrap_or(taut);
            let w = self.tautness(o.y, self.levels.hip, self.marks.crotch_level + 5.0);
            Some(DVec3::new(skin + w * (taut - skin), o.y, z))
        });
        self.insert(side.name("side"), points, features);
    }

    fn princess(&self, side: Side, front: bool, features: &mut Features) {
        let i = side.index();
        let start = middle_of(&self.marks.shoulder_line[i]);
        let s = side.sign();
        let half = |y: f64| self.bounds_at(y).map(|(lo, hi)| if s > 0.0 { hi.x } else { -lo.x });
        let parts = if front { PRINCESS_FRONT } else { PRINCESS_BACK };
        let bust = self.marks.bust[i];
        let mut knots: Vec<(f64, f64)> = [
            (0.05 * self.figure.height, parts[1]),
            (self.levels.hip, parts[1]),
            (self.levels.waist, parts[0]),
        ]
        .into_iter()
        .filter_map(|(y, part)| half(y).map(|b| (y, b * part)))
        .collect();
        if front {
            knots.push((bust.y, bust.x.abs()));
        } else {
            knots.push((self.marks.armpit[i].y, 0.6 * self.marks.armpit[i].x.abs()));
        }
        knots.push((start.y, start.x.abs()));
        let points = self.down(start, |o| {
            let x = s * monotone_cubic(&knots, o.y);
            let value = |p: &[DVec2]| depth_at(p, x).map(|d| d[usize::from(front)]);
            let taut = value(&o.taut)?;
            let skin = o.skin.as_deref().and_then(value).unwrap_or(taut);
            let w = self.tautness(o.y, self.levels.hip, self.marks.crotch_level + 5.0);
            Some(DVec3::new(x, o.y, skin + w * (taut - skin)))
        });
        let name = side.name(if front { "princess_front" } else { "princess_back" });
        self.insert(name, points, features);
    }

    fn bounds_at(&self, y: f64) -> Option<(DVec2, DVec2)> {
        self.outlines.iter().min_by(|a, b| (a.y - y).abs().total_cmp(&(b.y - y).abs())).map(Outline::bounds)
    }

    /// The start and the places on all outlines below it, evenly spaced and smoothed.
    fn down(&self, start: DVec3, place: impl Fn(&Outline) -> Option<DVec3>) -> Vec<DVec3> {
        let mut chain = vec![start];
        chain.extend(self.outlines.iter().filter(|o| o.y < start.y - 1.0).filter_map(place));
        let even = resample(&chain, SPACING);
        smooth_chain(&even, SIGMA)
    }

    fn insert(&self, name: String, points: Vec<DVec3>, features: &mut Features) {
        let normals: Vec<DVec3> = points
            .par_iter()
            .map(|p| {
                let (lo, hi) = self.bounds_at(p.y).unwrap_or((DVec2::ZERO, DVec2::ZERO));
                let mut hint = *p - DVec3::new(0.0, p.y, (lo.y + hi.y) / 2.0);
                if name.starts_with("centre") || name.contains("princess") {
                    // On a broad flat front the way from the middle leans too far aside.
                    hint.x *= 0.5;
                }
                self.field.at(*p, hint)
            })
            .collect();
        features
            .curves
            .insert(name, FeatureCurve { closed: false, points, normals: smooth_normals(normals) });
    }
}

/// Point at half the length of a chain.
fn middle_of(chain: &[DVec3]) -> DVec3 {
    let length: f64 = chain.windows(2).map(|w| w[0].distance(w[1])).sum();
    let mut left = length / 2.0;
    for w in chain.windows(2) {
        let d = w[0].distance(w[1]);
        if left <= d {
            return w[0].lerp(w[1], left / d.max(1e-12));
        }
        left -= d;
    }
    chain.first().copied().unwrap_or(DVec3::ZERO)
}

/// Evenly spaced points along an open chain, both ends kept.
fn resample(chain: &[DVec3], spacing: f64) -> Vec<DVec3> {
    let length: f64 = chain.windows(2).map(|w| w[0].distance(w[1])).sum();
    let count = ((length / spacing).round() as usize).max(2);
    let mut out = Vec::with_capacity(count + 1);
    let mut walked = 0.0;
    for w in chain.windows(2) {
        let d = w[0].distance(w[1]);
        while out.len() < count && length * out.len() as f64 / count as f64 <= walked + d {
            let t = (length * out.len() as f64 / count as f64 - walked) / d.max(1e-12);
            out.push(w[0].lerp(w[1], t.clamp(0.0, 1.0)));
        }
        walked += d;
    }
    out.extend(chain.last());
    out
}

fn smooth_chain(points: &[DVec3], sigma: f64) -> Vec<DVec3> {
    let axis = |f: fn(&DVec3) -> f64| smooth(&points.iter().map(f).collect::<Vec<_>>(), sigma);
    let (x, y, z) = (axis(|p| p.x), axis(|p| p.y), axis(|p| p.z));
    x.into_iter().zip(y).zip(z).map(|((x, y), z)| DVec3::new(x, y, z)).collect()
}

fn smooth_normals(normals: Vec<DVec3>) -> Vec<DVec3> {
    smooth_chain(&normals, SIGMA).into_iter().map(DVec3::normalize_or_zero).collect()
}
