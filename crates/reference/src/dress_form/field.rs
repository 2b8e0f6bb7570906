//! The form as the zero set of a smooth function of space, negative inside.
//!
//! Parts are first-order distances `f / |∇f|` (Taubin 1994), joined by the quadratic smooth minimum, so that the neck
//! and the arms grow out of the trunk without creases. Symmetric in x.

use mesh_kernel::glam::DVec3;

use super::hull::hull_length;
use super::levels::Levels;
use super::measurements::{Figure, Resolved};
use super::sections::{Sections, smooth_step};

/// A plane that cuts the form flat.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cut {
    pub(super) origin: DVec3,
    /// Unit normal, out of the form.
    pub(super) normal: DVec3,
    /// Only what lies between these heights is cut.
    pub(super) window: [f64; 2],
}

impl Cut {
    /// Height over the plane, positive outside the form.
    pub(super) fn over(&self, p: DVec3) -> f64 {
        (p - self.origin).dot(self.normal)
    }
}

/// Joins two distances with a fillet of size `k`.
fn smooth_min(a: f64, b: f64, k: f64) -> f64 {
    let t = (k - (a - b).abs()).max(0.0) / k;
    a.min(b) - 0.25 * k * t * t
}

/// First-order distance to an ellipsoid with half axes `r` about the origin.
fn ellipsoid(q: DVec3, r: DVec3) -> f64 {
    let s = q / r;
    let k0 = s.length();
    let k1 = (s / r).length();
    if k1 < 1e-12 { -r.min_element() } else { k0 * (k0 - 1.0) / k1 }
}

/// A smooth hill on the front or the back of the trunk.
#[derive(Clone, Copy, Debug)]
struct Hill {
    x: f64,
    y: f64,
    spread_x: f64,
    spread_y: f64,
    height: f64,
}

impl Hill {
    fn at(&self, x: f64, y: f64) -> f64 {
        let (v, w) = ((y - self.y) / self.spread_y, self.spread_x);
        if v.abs() > 3.5 {
            return 0.0;
        }
        let (l, r) = ((x - self.x) / w, (x + self.x) / w);
        let side = (-0.5 * l * l).exp() + if self.x > 0.0 { (-0.5 * r * r).exp() } else { 0.0 };
        self.height * side * (-0.5 * v * v).exp()
    }
}

/// A breast: an ellipsoid whose upper half is longer than its lower one.
#[derive(Clone, Copy, Debug)]
struct Breast {
    centre: DVec3,
    radius: DVec3,
    upper: f64,
    fillet: f64,
}

/// A limb that starts round at `origin` and runs along `axis`.
#[derive(Clone, Copy, Debug)]
struct Stub {
    origin: DVec3,
    axis: DVec3,
    /// Unit vector square to the axis in the plane x = const (neck) or z = const (arm).
    across: DVec3,
    /// Half axes along `across` and square to both.
    radius: [f64; 2],
    /// Where it ends round again; endless limbs end at their plates.
    length: f64,
    fillet: f64,
}

impl Stub {
    fn distance(&self, p: DVec3) -> f64 {
        let d = p - self.origin;
        let along = d.dot(self.axis);
        let u = d.dot(self.across);
        let w = d.dot(self.axis.cross(self.across));
        let back = along.min(0.0) + (along - self.length).max(0.0);
        let r = DVec3::new(self.radius[0], self.radius[1], self.radius[0].max(self.radius[1]));
        ellipsoid(DVec3::new(u, w, back), r)
    }
}

/// The whole form.
#[derive(Clone, Debug)]
pub(super) struct Field {
    pub(super) levels: Levels,
    pub(super) sections: Sections,
    front: Vec<Hill>,
    back: Vec<Hill>,
    breast: Option<Breast>,
    neck: Stub,
    arm: Stub,
    /// Shoulder line: height at x = 0 and fall per unit of x.
    roof: [f64; 2],
    /// Front of the shoulder line, mm.
    roof_ridge: f64,
    head: Option<(DVec3, DVec3)>,
    /// Plates: floor, arm (left one), neck unless there is a head.
    pub(super) cuts: Vec<Cut>,
}

/// How deep the shoulder falls before and behind its ridge, share of stature.
const ROOF_FALL: f64 = 0.05;

/// Distance from the ridge at which half of that is reached, share of stature.
const ROOF_REACH: f64 = 0.079;

/// Index of the arm plate in [`Field::cuts`].
pub(super) const ARM: usize = 1;

impl Field {
    pub(super) fn new(m: &Resolved, head: bool) -> Self {
        let levels = Levels::of(m, head);
        let h = levels.stature;
        let sections = Sections::new(m, &levels);
        let (front, back) = hills(m, &levels);

        // Neck: leans forward; the fillet at its foot makes the neck base.
        // The share is measured: neck base tape over the tape round the neck itself.
        let share = match m.figure {
            Figure::Woman => 0.91,
            Figure::Man => 0.845,
            Figure::Child => 0.93,
        };
        let neck_radius = share * m.neck * 10.0 / std::f64::consts::TAU;
        let lean = 0.27_f64;
        let neck_axis = DVec3::new(0.0, lean.cos(), lean.sin());
        let neck_foot = 0.5 * (levels.nape + levels.front_neck);
        let neck_centre = sections.at(levels.nape).centre - 0.0015 * h;
        let sunk = 1.35 * neck_radius;
        let neck = Stub {
            origin: DVec3::new(0.0, neck_foot, neck_centre) - neck_axis * sunk,
            axis: neck_axis,
            across: DVec3::new(0.0, -lean.sin(), lean.cos()),
            radius: [neck_radius * 1.02, neck_radius * 0.98],
            // A head swallows the end.
            length: if head { sunk + 0.09 * h } else { f64::INFINITY },
            fillet: 0.021 * h,
        };

        // Shoulder line from the neck side to the shoulder point.
        let shoulder_x = m.shoulder_width * 5.0;
        let fall = (levels.neck_side - levels.shoulder) / (shoulder_x - neck_radius).max(0.02 * h);
        let roof = [levels.neck_side + fall * neck_radius, fall];

        // Arm plate from the shoulder point to the armpit.
        let chest = sections.at(levels.armpit);
        let height = levels.shoulder - levels.armpit;
        let under_x =
            (chest.half_width + 0.006 * h).clamp(shoulder_x - 0.42 * height, shoulder_x + 0.15 * height);
        let top = DVec3::new(shoulder_x, levels.shoulder, 0.0);
        let bottom = DVec3::new(under_x, levels.armpit, 0.0);
        let along = (top - bottom).normalize();
        let plate_normal = DVec3::new(along.y, -along.x, 0.0);
        let middle = 0.53 * bottom + 0.47 * top + DVec3::Z * (chest.centre - 0.008 * h);
        // Nearly level, so that the underside does not hang below the plate.
        let arm_axis = (DVec3::X + 0.35 * plate_normal).normalize();
        let cos = arm_axis.dot(plate_normal);
        let across = DVec3::new(-arm_axis.y, arm_axis.x, 0.0);
        let half_height = 0.47 * (top - bottom).length() * cos;
        let half_depth =
            (m.upper_arm * 10.0 / std::f64::consts::TAU * 1.0).clamp(0.60 * half_height, 1.15 * half_height);
        let arm = Stub {
            origin: middle - arm_axis * (0.9 * half_height),
            axis: arm_axis,
            across,
            radius: [half_height, half_depth],
            length: f64::INFINITY,
            fillet: 0.026 * h,
        };
        let mut cuts = vec![
            Cut { origin: DVec3::ZERO, normal: DVec3::NEG_Y, window: [f64::NEG_INFINITY, 0.1 * h] },
            Cut {
                origin: middle,
                normal: plate_normal,
                window: [levels.armpit - 0.016 * h, levels.shoulder + 0.03 * h],
            },
        ];
        let mut field = Self {
            levels,
            sections,
            front,
            back,
            breast: None,
            neck,
            arm,
            roof,
            roof_ridge: chest.centre - 0.010 * h,
            head: head.then(|| {
                let size = if m.figure == Figure::Child {
                    1.0 + 0.25 * ((150.0 - m.height) / 70.0).clamp(0.0, 1.0)
                } else {
                    1.0
                };
                let r = DVec3::new(0.046, 0.066, 0.057) * h * size;
                (DVec3::new(0.0, h - r.y, neck_centre + 0.022 * h), r)
            }),
            cuts: Vec::new(),
        };
        if !head {
            let tilt = 0.24_f64;
            let normal = DVec3::new(0.0, tilt.cos(), tilt.sin());
            let back = field.back_of(levels.top);
            cuts.push(Cut { origin: back, normal, window: [levels.shoulder, f64::INFINITY] });
        }
        field.cuts = cuts;
        if m.figure == Figure::Woman {
            field.breast = field.fit_breast(m);
        }
        field
    }

    /// The point of the centre back at height `y`, above the shoulders.
    fn back_of(&self, y: f64) -> DVec3 {
        let middle = self.neck.origin + self.neck.axis * ((y - self.neck.origin.y) / self.neck.axis.y);
        let (mut inside, mut outside) = (middle.z, middle.z - 4.0 * self.neck.radius[0]);
        for _ in 0..60 {
            let z = 0.5 * (inside + outside);
            *(if self.bare(DVec3::new(0.0, y, z)) < 0.0 { &mut inside } else { &mut outside }) = z;
        }
        DVec3::new(0.0, y, 0.5 * (inside + outside))
    }

    /// Breasts such that the tape over the bust points reads the bust girth.
    fn fit_breast(&self, m: &Resolved) -> Option<Breast> {
        let levels = &self.levels;
        let h = levels.stature;
        let ribs = self.sections.at(levels.bust);
        let outline = ribs.outline();
        let want = m.bust * 10.0;
        let x = (1.0 * m.bust).min(0.56 * ribs.half_width);
        let side = 0.39 * ribs.half_width;
        let skin = ribs.front_at(x);
        const SINK: f64 = 0.42;
        let shape = |rise: f64| {
            // A small breast is the cap of an ellipsoid that lies deeper.
            let depth = (rise / (1.0 - SINK)).max(0.5 * side);
            (skin + rise - depth, depth)
        };
        // The tape at height y over ribs and breasts with upper half axis `upper`.
        let girth_at = |rise: f64, y: f64, upper: f64| {
            let (z, depth) = shape(rise);
            let shrink = (1.0 - ((y - levels.bust) / upper).powi(2)).max(0.0).sqrt();
            let mut points = if y == levels.bust { outline.clone() } else { self.sections.at(y).outline() };
            for i in 0..=32 {
                let (s, c) = (std::f64::consts::PI * i as f64 / 32.0).sin_cos();
                for sign in [-1.0, 1.0] {
                    points.push([sign * (x + side * shrink * c), z + depth * shrink * s]);
                }
            }
            hull_length(&mut points)
        };
        let girth = |rise: f64| girth_at(rise, levels.bust, h);
        let (mut low, mut high) = (0.0, 0.2 * h);
        if girth(low) >= want {
            return None;
        }
        for _ in 0..50 {
            let middle = 0.5 * (low + high);
            *(if girth(middle) < want { &mut low } else { &mut high }) = middle;
        }
        let (z, depth) = shape(low);
        let below = levels.bust - levels.underbust;
        // As long upward as leaves the bust point the fullest.
        let above = levels.bust + 0.40 * (levels.armpit - levels.bust);
        let (mut short, mut long) = ((1.15 * below).max(0.7 * low), (1.75 * below).max(low));
        for _ in 0..30 {
            let middle = 0.5 * (short + long);
            *(if girth_at(low, above, middle) < 0.995 * want { &mut short } else { &mut long }) = middle;
        }
        Some(Breast {
            centre: DVec3::new(x, levels.bust, z),
            radius: DVec3::new(side, below * 0.80, depth),
            upper: short / (below * 0.80),
            fillet: 0.022 * h,
        })
    }

    /// Trunk and legs alone.
    fn trunk(&self, p: DVec3) -> f64 {
        let s = self.sections.at(p.y);
        let h = self.levels.stature;
        let dz = p.z - s.centre;
        let soft = 0.018 * h;
        let forward = 0.5 + 0.5 * dz / (dz * dz + soft * soft).sqrt();
        let part = s.part_back + forward * (s.part_front - s.part_back);
        let power = s.power_back + forward * (s.power_front - s.power_back);
        let hill = |hills: &[Hill]| hills.iter().map(|hill| hill.at(p.x, p.y)).sum::<f64>();
        let dz = dz - forward * hill(&self.front) + (1.0 - forward) * hill(&self.back);
        let a = s.half_width / (1.0 + part);
        let b = s.half_depth;
        let eps = self.sections.parting;
        let u = (p.x * p.x + eps * eps).sqrt();
        let t = (u - part * a).abs() / a;
        let v = dz.abs() / b;
        let (tp, vp) = (t.powf(power - 1.0), v.powf(power - 1.0));
        let sum = tp * t + vp * v;
        if sum < 1e-6 {
            return -a.min(b);
        }
        let rho = sum.powf(1.0 / power);
        let scale = rho / sum;
        let gradient = (tp / a).hypot(vp / b) * scale;
        (rho - 1.0) / gradient.max(0.35 / a.max(b))
    }

    /// Everything but the ends beyond the plates.
    pub(super) fn bare(&self, p: DVec3) -> f64 {
        let p = DVec3::new(p.x.abs(), p.y, p.z);
        let h = self.levels.stature;
        let mut f = self.trunk(p);
        if p.y < self.levels.waist {
            return f;
        }
        if let Some(breast) = &self.breast {
            let mut r = breast.radius;
            let mut q = p - breast.centre;
            if q.y > 0.0 {
                r.y *= breast.upper;
            }
            // Breasts part towards the sides a little.
            q.x *= 1.0 - 0.10 * smooth_step(q.x / r.x);
            if q.y.abs() < r.y + 0.06 * h {
                f = smooth_min(f, ellipsoid(q, r), breast.fillet);
            }
        }
        if p.y > self.levels.armpit - 0.10 * h {
            let soft = 0.03 * h;
            let x = (p.x * p.x + soft * soft).sqrt();
            // The shoulder falls off before and behind its ridge.
            let (fall, reach) = (ROOF_FALL * h, ROOF_REACH * h);
            let dz = p.z - self.roof_ridge;
            let sum = dz * dz + reach * reach;
            let drop = fall * dz * dz / sum;
            let slope = self.roof[1].hypot(2.0 * fall * dz * reach * reach / (sum * sum));
            let roof = (p.y - self.roof[0] + self.roof[1] * x + drop) / slope.hypot(1.0);
            f = -smooth_min(-f, -roof, 0.032 * h);
            // Wide ribs on narrow shoulders end inside the arm plate.
            if let Some(plate) = self.cuts.get(ARM) {
                let start = self.levels.armpit - 0.045 * h;
                let on = smooth_step((p.y - start) / (0.026 * h));
                let side = plate.over(p) + 0.004 * h - (1.0 - on) * 0.2 * h;
                f = -smooth_min(-f, -side, 0.012 * h);
            }
            // The arm ends a little beyond its plate, wherever that is.
            let arm = match self.cuts.get(ARM) {
                Some(plate) => self.arm.distance(p).max(plate.over(p) - 0.015 * h),
                None => self.arm.distance(p),
            };
            // A tight fillet in the armpit, a wide one over the shoulder.
            let rise = (p.y - self.levels.armpit) / (self.levels.shoulder - self.levels.armpit);
            f = smooth_min(f, arm, self.arm.fillet * (0.35 + 0.65 * smooth_step(rise)));
            f = smooth_min(f, self.neck.distance(p), self.neck.fillet);
            if let Some((centre, radius)) = self.head {
                f = smooth_min(f, ellipsoid(p - centre, radius), 0.03 * h);
            }
        }
        f
    }

    /// Closed: the ends stop `margin` beyond the plates.
    pub(super) fn closed(&self, p: DVec3, margin: f64) -> f64 {
        let mut f = self.bare(p);
        let p = DVec3::new(p.x.abs(), p.y, p.z);
        for (i, cut) in self.cuts.iter().enumerate() {
            if i != ARM && (cut.window[0]..=cut.window[1]).contains(&p.y) {
                f = f.max(cut.over(p) - margin);
            }
        }
        f
    }
}

/// What makes a trunk a body and not a tube: shoulder blades, spine, seat, belly, chest.
fn hills(m: &Resolved, levels: &Levels) -> (Vec<Hill>, Vec<Hill>) {
    let h = levels.stature;
    let wide = m.bust * 10.0 / h / 0.56;
    let hill = |x: f64, y: f64, spread_x: f64, spread_y: f64, height: f64| Hill {
        x: x * h,
        y,
        spread_x: spread_x * h,
        spread_y: spread_y * h,
        height: height * h,
    };
    let seat_wide = m.hip * 10.0 / h / 0.6;
    let (seat, chest, blade) = match m.figure {
        Figure::Woman => (0.0090, 0.0, 0.0050),
        Figure::Man => (0.0080, 0.0085, 0.0060),
        Figure::Child => (0.0070, 0.0020, 0.0050),
    };
    let mut back = vec![
        hill(0.047 * wide.sqrt(), levels.armpit + 0.006 * h, 0.027, 0.030, blade),
        hill(0.0, 0.5 * (levels.waist + levels.armpit), 0.011, 0.055, -0.0045),
        hill(0.047 * seat_wide, levels.hip + 0.004 * h, 0.032 * seat_wide, 0.026, seat),
    ];
    let stout = ((m.waist * 10.0 / h) - 0.46).max(0.0);
    let mut front = vec![hill(0.0, levels.high_hip, 0.045, 0.032, 0.003 + 0.020 * stout)];
    if chest > 0.0 {
        front.push(hill(0.047 * wide, levels.bust + 0.006 * h, 0.030, 0.022, chest));
    }
    if m.figure == Figure::Man {
        front.push(hill(0.0, 0.5 * (levels.waist + levels.bust), 0.010, 0.045, -0.0025));
    }
    back.retain(|hill| hill.height != 0.0);
    (front, back)
}

impl Field {
    /// Half width of the form and its range of z, generously, mm.
    pub(super) fn extent(&self) -> (f64, [f64; 2]) {
        let h = self.levels.stature;
        let arm = self.cuts[ARM].origin.x + 0.05 * h;
        let (mut width, mut z) = (arm, [0.0_f64, 0.0_f64]);
        for i in 0..=100 {
            let s = self.sections.at(self.levels.nape * i as f64 / 100.0);
            width = width.max(s.half_width);
            z = [z[0].min(s.centre - s.half_depth), z[1].max(s.centre + s.half_depth)];
        }
        if let Some(breast) = &self.breast {
            z[1] = z[1].max(breast.centre.z + breast.radius.z);
        }
        if let Some((centre, radius)) = self.head {
            z = [z[0].min(centre.z - radius.z), z[1].max(centre.z + radius.z)];
        }
        let arm_half = self.arm.radius[1];
        z = [z[0].min(self.arm.origin.z - arm_half), z[1].max(self.arm.origin.z + arm_half)];
        (width + 0.02 * h, [z[0] - 0.03 * h, z[1] + 0.03 * h])
    }
}
