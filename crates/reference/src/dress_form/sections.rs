//! Horizontal sections of trunk and legs: shape by height, size from the girths.
//!
//! A section is the superellipse `(|u − c| / a)^n + |z − z₀| / b)^n = 1` with `u = √(x² + ε²)`. With `c = 0` it is one oval
//! (trunk), with `c > a` two (legs); growing `c / a` from 0 to 1 parts the seat and opens the crotch as a smooth saddle.
//! Depth, parting and power differ between front and back and change smoothly at the side.

use rayon::prelude::*;

use super::curve::Curve;
use super::hull::hull_length;
use super::levels::Levels;
use super::measurements::{Figure, Resolved};

/// One section; millimetres.
#[derive(Clone, Copy, Debug)]
pub(super) struct Section {
    /// Half width `a + c`.
    pub(super) half_width: f64,
    /// Half depth `b`.
    pub(super) half_depth: f64,
    /// Height of the section's middle over the plane z = 0.
    pub(super) centre: f64,
    /// `c / a` in front.
    pub(super) part_front: f64,
    /// `c / a` at the back.
    pub(super) part_back: f64,
    /// Power `n` in front.
    pub(super) power_front: f64,
    /// Power `n` at the back.
    pub(super) power_back: f64,
}

const FIELDS: usize = 7;

impl Section {
    fn to_array(self) -> [f64; FIELDS] {
        [
            self.half_width,
            self.half_depth,
            self.centre,
            self.part_front,
            self.part_back,
            self.power_front,
            self.power_back,
        ]
    }

    fn from_array(a: [f64; FIELDS]) -> Self {
        Self {
            half_width: a[0],
            half_depth: a[1],
            centre: a[2],
            part_front: a[3],
            part_back: a[4],
            power_front: a[5],
            power_back: a[6],
        }
    }

    /// Points (x, z) of the outline, both halves.
    pub(super) fn outline(&self) -> Vec<[f64; 2]> {
        const QUARTER: usize = 32;
        let mut points = Vec::with_capacity(4 * QUARTER + 4);
        for (sign, part, power) in
            [(1.0, self.part_front, self.power_front), (-1.0, self.part_back, self.power_back)]
        {
            let a = self.half_width / (1.0 + part);
            for i in 0..=QUARTER {
                let (s, c) = (i as f64 / QUARTER as f64 * std::f64::consts::FRAC_PI_2).sin_cos();
                let x = part * a + a * c.max(0.0).powf(2.0 / power);
                let z = self.centre + sign * self.half_depth * s.max(0.0).powf(2.0 / power);
                points.push([x, z]);
                points.push([-x, z]);
            }
        }
        points
    }

    /// Front depth of the outline at `x`.
    pub(super) fn front_at(&self, x: f64) -> f64 {
        let a = self.half_width / (1.0 + self.part_front);
        let t = ((x.abs() - self.part_front * a).abs() / a).min(1.0);
        self.centre + self.half_depth * (1.0 - t.powf(self.power_front)).powf(1.0 / self.power_front)
    }
}

/// Sections at all heights of trunk and legs, tabulated.
#[derive(Clone, Debug)]
pub(super) struct Sections {
    step: f64,
    /// Rows over which sizes are smoothed.
    spread: f64,
    table: Vec<[f64; FIELDS]>,
    /// `ε` of the parting, mm.
    pub(super) parting: f64,
}

/// Values of a trunk quantity at crotch, hip, high hip, waist, underbust, bust, armpit, shoulder, nape.
type ByLevel = [f64; 9];

/// Middle of the section over the plane through the ankles, shares of stature; from sections of the CC0 MakeHuman base
/// mesh, the curve of the spine a little straightened as on a dress form.
fn centres(figure: Figure) -> ByLevel {
    match figure {
        Figure::Woman => [0.0165, 0.0120, 0.0210, 0.0310, 0.0325, 0.0275, 0.0200, 0.0050, 0.0040],
        Figure::Man => [0.0120, 0.0095, 0.0150, 0.0220, 0.0200, 0.0180, 0.0130, 0.0010, 0.0030],
        Figure::Child => [0.0145, 0.0120, 0.0200, 0.0270, 0.0215, 0.0165, 0.0120, 0.0030, 0.0040],
    }
}

/// Depth over width of the trunk at hip, high hip, waist, underbust, bust (without breasts), armpit for a figure of
/// normal weight, and how fast each grows with girth over stature above 0.44.
fn depths(figure: Figure) -> [[f64; 2]; 6] {
    match figure {
        Figure::Woman => {
            [[0.600, 0.45], [0.660, 0.8], [0.710, 0.9], [0.680, 0.6], [0.665, 0.55], [0.635, 0.5]]
        }
        Figure::Man => {
            [[0.620, 0.45], [0.705, 0.8], [0.700, 1.0], [0.705, 0.6], [0.690, 0.45], [0.650, 0.45]]
        }
        Figure::Child => {
            [[0.630, 0.45], [0.680, 0.8], [0.690, 1.0], [0.730, 0.6], [0.720, 0.45], [0.680, 0.45]]
        }
    }
}

/// Girth of the trunk without breasts at bust level and at the armpit, between underbust (0) and bust (1).
fn rib_shares(figure: Figure) -> [f64; 2] {
    match figure {
        Figure::Woman => [0.40, 0.42],
        Figure::Man => [1.0, 0.92],
        Figure::Child => [1.0, 0.85],
    }
}

impl Sections {
    pub(super) fn new(m: &Resolved, levels: &Levels) -> Self {
        let h = levels.stature;
        let parting = 0.0055 * h;
        let normal = depths(m.figure);
        let depth =
            |i: usize, girth: f64| (normal[i][0] + normal[i][1] * (girth / h - 0.44).max(0.0)).min(0.92);
        // A stout body grows forward more than backward.
        let stout = ((m.waist * 10.0 / h) - 0.46).max(0.0);
        let forward = |y: f64| {
            let below = smooth_step((y - levels.crotch) / (levels.waist - levels.crotch));
            let above = smooth_step((levels.armpit - y) / (levels.armpit - levels.underbust));
            0.11 * stout * h * below * above
        };
        let thigh_half = m.thigh * 10.0 / std::f64::consts::TAU;
        let above = |t: f64| levels.crotch + t * h;
        let part_back = Curve::through(&[
            (levels.crotch, 1.0 + parting / thigh_half),
            (above(0.008), 0.78),
            (above(0.026), 0.52),
            (above(0.055), 0.25),
            (above(0.09), 0.07),
            (above(0.13), 0.0),
        ]);
        let part_front = Curve::through(&[
            (levels.crotch, 1.0 + parting / thigh_half),
            (above(0.008), 0.68),
            (above(0.022), 0.30),
            (above(0.045), 0.08),
            (above(0.075), 0.0),
        ]);
        let centre = Curve::through(&by_level(levels, centres(m.figure).map(|c| c * h)));
        let mut hip_section = Section {
            half_width: 1.0,
            half_depth: depth(0, m.hip * 10.0),
            centre: 0.0,
            part_front: part_front.get(levels.hip),
            part_back: part_back.get(levels.hip),
            power_front: 2.15,
            power_back: 2.15,
        };
        let size = m.hip * 10.0 / hull_length(&mut hip_section.outline());
        hip_section.half_width *= size;
        hip_section.half_depth *= size;
        hip_section.centre = centre.get(levels.hip) + forward(levels.hip);
        let legs = Legs::new(m, levels, parting, &hip_section);
        let table_step = 2.0;
        let girth = Self::girths(m, levels, &legs);
        let trunk_levels =
            [levels.hip, levels.high_hip, levels.waist, levels.underbust, levels.bust, levels.armpit];
        let mut ratio: Vec<(f64, f64)> =
            (0..6).map(|i| (trunk_levels[i], depth(i, girth.get(trunk_levels[i])))).collect();
        // The arms hang outside the ribs: wide chests on narrow shoulders are deep.
        let limit = m.shoulder_width * 5.0 + 0.06 * (levels.shoulder - levels.armpit);
        while ratio[5].1 < 0.95 {
            let unit = Section { half_width: 1.0, half_depth: ratio[5].1, ..hip_section };
            let whole = Section {
                centre: 0.0,
                part_front: 0.0,
                part_back: 0.0,
                power_front: 2.3,
                power_back: 2.5,
                ..unit
            };
            if girth.get(levels.armpit) / hull_length(&mut whole.outline()) <= limit {
                break;
            }
            ratio[5].1 += 0.01;
        }
        ratio[4].1 = ratio[4].1.max(ratio[5].1 - 0.04);
        ratio.push((levels.crotch, 0.5));
        let ratio = Curve::through(&ratio);
        let power_front = Curve::through(&by_level(levels, [2.1, 2.15, 2.2, 2.2, 2.25, 2.3, 2.3, 2.3, 2.2]));
        let power_back = Curve::through(&by_level(levels, [2.1, 2.15, 2.25, 2.35, 2.45, 2.5, 2.5, 2.4, 2.2]));
        let rise = levels.shoulder - levels.armpit;
        let thinning = Curve::through(
            &[(0.0, 1.0), (0.35, 0.96), (0.65, 0.88), (1.0, 0.76), (1.5, 0.58), (2.0, 0.50)]
                .map(|(t, v)| (levels.armpit + t * rise, v)),
        );
        let trunk = |y: f64| {
            let at = y.min(levels.armpit);
            let mut section = Section {
                half_width: 1.0,
                half_depth: ratio.get(at),
                centre: centre.get(y),
                part_front: part_front.get(y),
                part_back: part_back.get(y),
                power_front: power_front.get(y),
                power_back: power_back.get(y),
            };
            let unit = hull_length(&mut Section { centre: 0.0, ..section }.outline());
            if y < levels.hip {
                section.half_width = legs.half_width.get(y);
                section.half_depth = legs.half_depth.get(y);
                section.centre = legs.centre.get(y);
                return section;
            }
            let size = girth.get(at) / unit;
            section.half_width = size;
            section.half_depth *= size * thinning.get(y.max(levels.armpit));
            section.centre += forward(y);
            section
        };
        let count = ((levels.nape + 0.1 * h) / table_step).ceil() as usize + 2;
        let table: Vec<[f64; FIELDS]> = (0..count)
            .into_par_iter()
            .map(|i| {
                let y = i as f64 * table_step;
                if y < levels.crotch { legs.section(y) } else { trunk(y) }.to_array()
            })
            .collect();
        // Less for the parting, which opens the crotch.
        let spread = 0.0085 * h / table_step;
        Self {
            step: table_step,
            spread,
            table: smoothed(&smoothed(&table, spread, &[0, 1, 2, 5, 6]), 0.5 * spread, &[3, 4]),
            parting,
        }
    }

    /// Girth by height of the trunk without breasts.
    fn girths(m: &Resolved, levels: &Levels, legs: &Legs) -> Curve {
        let cm = 10.0;
        let [at_bust, at_armpit] =
            rib_shares(m.figure).map(|t| cm * (m.underbust + t * (m.bust - m.underbust)));
        let both = |y: f64| hull_length(&mut legs.section(y).outline());
        let below = levels.crotch - 0.03 * levels.stature;
        let hip = cm * m.hip;
        let mut points = vec![
            (below, both(below).min(0.985 * hip)),
            (levels.crotch, both(levels.crotch).min(0.992 * hip)),
            (levels.hip, hip),
            (levels.high_hip, cm * m.high_hip),
            (levels.waist, cm * m.waist),
            (levels.underbust, cm * m.underbust),
            (levels.bust, at_bust),
            (levels.armpit, at_armpit),
        ];
        // Where the waist is no narrower than the ribs, the natural waist is the crease below the lowest roll.
        if m.waist > 0.985 * m.underbust && m.waist < CREASE * m.underbust && m.waist < m.high_hip {
            let roll = cm * (m.waist.max(m.underbust) + 0.012 * m.waist);
            points.push((levels.waist + 0.5 * (levels.underbust - levels.waist), roll));
        }
        Curve::through(&points)
    }

    /// The section at height `y` (nearest tabulated one outside the table); linear between table rows 2 mm apart.
    pub(super) fn at(&self, y: f64) -> Section {
        let t = (y / self.step).clamp(0.0, (self.table.len() - 1) as f64 - 1e-9);
        let i = t as usize;
        let f = t - i as f64;
        let (a, b) = (&self.table[i], &self.table[i + 1]);
        Section::from_array(std::array::from_fn(|k| a[k] + f * (b[k] - a[k])))
    }

    /// Multiplies width and depth of the sections by a factor of height, smoothed, about their middles.
    pub(super) fn scale(&mut self, factor: impl Fn(f64) -> f64) {
        let factors: Vec<[f64; 1]> = (0..self.table.len()).map(|i| [factor(i as f64 * self.step)]).collect();
        for (row, [s]) in self.table.iter_mut().zip(smoothed(&factors, self.spread, &[0])) {
            row[0] *= s;
            row[1] *= s;
        }
    }
}

/// Share of the hip's tape that the trunk's section makes; the seat's own swelling makes the rest.
const SEAT_SHARE: f64 = 0.983;

/// A waist up to this times the underbust is a crease between rolls; a larger one is a belly that goes over into the ribs.
pub(super) const CREASE: f64 = 1.06;

/// Both legs as one parted section.
struct Legs {
    /// Of one leg.
    girth: Curve,
    /// Of both together.
    half_width: Curve,
    half_depth: Curve,
    /// Half the gap between the legs.
    gap: Curve,
    centre: Curve,
}

impl Legs {
    fn new(m: &Resolved, levels: &Levels, parting: f64, hip_section: &Section) -> Self {
        let (h, cm) = (levels.stature, 10.0);
        let girth = Curve::through(&[
            (0.0, cm * m.ankle * 1.06),
            (levels.ankle, cm * m.ankle),
            (levels.calf, cm * m.calf),
            (levels.knee, cm * m.knee),
            (levels.knee + 0.035 * h, cm * (m.knee + 0.08 * (m.thigh - m.knee))),
            (levels.thigh - 0.01 * h, cm * m.thigh * 0.985),
            // The thigh is fullest where it meets the seat.
            (levels.crotch, cm * m.thigh * 1.03),
        ]);
        let gap = Curve::through(&[
            (levels.hip, parting),
            (levels.crotch, parting),
            (levels.crotch - 0.01 * h, parting + 0.0020 * h),
            (levels.thigh, parting + 0.0050 * h),
            (levels.crotch - 0.09 * h, 0.0185 * h),
            (levels.knee, 0.0280 * h),
            (levels.calf, 0.0300 * h),
            (levels.ankle, 0.0420 * h),
            (0.0, 0.0420 * h),
        ]);
        // The outer line runs on from the hip; the thigh's girth then sets its depth. The hull round both thighs, 4 a and
        // one girth, stays inside the hip girth.
        let (thigh, hip) = (cm * m.thigh, cm * m.hip);
        let round = thigh / std::f64::consts::TAU;
        let roomy = (0.972 * hip - 1.03 * thigh) / 4.0 - parting;
        let from_hip = |share: f64, y: f64| {
            let line = 0.5 * (share * SEAT_SHARE * hip_section.half_width - gap.get(y));
            line.clamp(0.84 * round, 1.04 * round).min(roomy)
        };
        let outer = |a: f64, y: f64| (y, 2.0 * a + gap.get(y));
        let from_girth = |aspect: f64, y: f64| {
            let one = leg_section(1.0, 1.0 / aspect, 0.0, 1.0);
            outer(
                girth.get(y) / hull_length(&mut Section { part_front: 0.0, part_back: 0.0, ..one }.outline()),
                y,
            )
        };
        let above_knee = levels.knee + 0.10 * h;
        let half_width = Curve::through(&[
            from_girth(0.85, 0.0),
            from_girth(0.83, levels.ankle),
            from_girth(0.96, levels.calf),
            from_girth(0.94, levels.knee),
            from_girth(0.91, above_knee),
            outer(from_hip(0.955, levels.thigh), levels.thigh),
            outer(from_hip(0.985, levels.crotch), levels.crotch),
            (levels.hip, hip_section.half_width),
            (levels.hip + 0.02 * h, 0.99 * hip_section.half_width),
        ]);
        let crotch_centre = centres(m.figure)[0] * h;
        let centre = Curve::through(&[
            (0.0, 0.004 * h),
            (levels.ankle, 0.004 * h),
            (levels.calf, 0.003 * h),
            (levels.knee, 0.0150 * h),
            (levels.knee + 0.06 * h, 0.0185 * h),
            (levels.crotch - 0.05 * h, crotch_centre.max(0.0175 * h)),
            (levels.crotch, crotch_centre),
            (levels.hip, hip_section.centre),
        ]);
        let mut legs = Self { girth, half_width, half_depth: Curve::through(&[]), gap, centre };
        // Depth from what the girth leaves, at close heights; then on to the hip's depth.
        let mut depths: Vec<(f64, f64)> = (0..=48)
            .map(|i| {
                let y = levels.crotch * f64::from(i) / 48.0;
                (y, legs.depth_for_girth(y))
            })
            .collect();
        depths.push((levels.hip, hip_section.half_depth));
        depths.push((levels.hip + 0.02 * h, 1.015 * hip_section.half_depth));
        legs.half_depth = Curve::through(&depths);
        legs
    }

    /// Half width of one leg at `y`.
    fn one_half_width(&self, y: f64) -> f64 {
        0.5 * (self.half_width.get(y) - self.gap.get(y))
    }

    /// Half depth that gives one leg its girth.
    fn depth_for_girth(&self, y: f64) -> f64 {
        let (a, girth) = (self.one_half_width(y), self.girth.get(y));
        let length = |b: f64| {
            let one = leg_section(a, b, 0.0, 1.0);
            hull_length(&mut Section { part_front: 0.0, part_back: 0.0, ..one }.outline())
        };
        // The length grows near linearly with b: secant.
        let (mut b0, mut b1) = (0.9 * a, 1.1 * a);
        let (mut f0, mut f1) = (length(b0) - girth, length(b1) - girth);
        for _ in 0..6 {
            if (f1 - f0).abs() < 1e-9 {
                break;
            }
            let b2 = (b1 - f1 * (b1 - b0) / (f1 - f0)).clamp(0.4 * a, 2.2 * a);
            (b0, f0, b1) = (b1, f1, b2);
            f1 = length(b1) - girth;
        }
        b1
    }

    fn section(&self, y: f64) -> Section {
        let a = self.one_half_width(y);
        leg_section(
            self.half_width.get(y),
            self.half_depth.get(y),
            self.centre.get(y),
            1.0 + self.gap.get(y) / a,
        )
    }
}

fn leg_section(half_width: f64, half_depth: f64, centre: f64, part: f64) -> Section {
    let power = 2.1;
    Section {
        half_width,
        half_depth,
        centre,
        part_front: part,
        part_back: part,
        power_front: power,
        power_back: power,
    }
}

/// Pairs of height and value at the trunk's levels.
fn by_level(levels: &Levels, values: ByLevel) -> Vec<(f64, f64)> {
    [
        levels.crotch,
        levels.hip,
        levels.high_hip,
        levels.waist,
        levels.underbust,
        levels.bust,
        levels.armpit,
        levels.shoulder,
        levels.nape,
    ]
    .into_iter()
    .zip(values)
    .collect()
}

/// 0 below 0, 1 above 1, smooth between.
pub(super) fn smooth_step(t: f64) -> f64 {
    let t = t.clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// The columns of a table smoothed by a Gaussian of `spread` rows: monotone curves have jumps of curvature that would show
/// as rings.
fn smoothed<const N: usize>(table: &[[f64; N]], spread: f64, columns: &[usize]) -> Vec<[f64; N]> {
    let reach = (3.0 * spread).ceil() as usize;
    let weight: Vec<f64> = (0..=reach).map(|d| (-0.5 * (d as f64 / spread).powi(2)).exp()).collect();
    let last = table.len() - 1;
    (0..table.len())
        .map(|i| {
            let mut row = table[i];
            for &k in columns {
                let (mut sum, mut total) = (0.0, 0.0);
                for (d, w) in weight.iter().enumerate() {
                    for j in [i.saturating_sub(d), (i + d).min(last)] {
                        sum += w * table[j][k];
                        total += w;
                    }
                }
                row[k] = sum / total;
            }
            row
        })
        .collect()
}
