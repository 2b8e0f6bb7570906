//! Heights of the body's landmarks as shares of stature.

use super::measurements::{Figure, Resolved};

/// Height of the top of a form without a head (the back edge of its neck plate) over the stature of the person it stands
/// for. The same for every figure, so that a program that sees only the mesh can tell the stature.
pub const HEADLESS_HEIGHT_RATIO: f64 = 0.875;

/// Heights above the floor, millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Levels {
    /// Stature of the person.
    pub stature: f64,
    /// Highest point of the mesh: the crown, or the back edge of the neck plate.
    pub top: f64,
    /// Nape: the neck base at the centre back.
    pub nape: f64,
    /// Neck base at the side, where the shoulder line starts.
    pub neck_side: f64,
    /// Neck base at the centre front.
    pub front_neck: f64,
    /// Shoulder point: top of the arm plate.
    pub shoulder: f64,
    /// Armpit: bottom of the arm plate.
    pub armpit: f64,
    /// Bust points; the fullest of the chest.
    pub bust: f64,
    /// Just below the breasts.
    pub underbust: f64,
    /// Natural waist.
    pub waist: f64,
    /// Top of the hip bones.
    pub high_hip: f64,
    /// Fullest of the seat.
    pub hip: f64,
    /// Where the legs part.
    pub crotch: f64,
    /// Fullest of the thigh.
    pub thigh: f64,
    /// Middle of the knee.
    pub knee: f64,
    /// Fullest of the calf.
    pub calf: f64,
    /// Least girth above the ankle bones.
    pub ankle: f64,
}

/// Shares of stature: nape, neck side, front neck, shoulder, armpit, bust, underbust, waist, hip, crotch, knee.
///
/// Adults: means of ANSUR II (cervicale, suprasternale, acromion, axilla, chest, crotch, knee heights over stature) and,
/// where that survey has none, of the CC0 MakeHuman base mesh. Children: growth moves the trunk's marks up (Snyder et
/// al. 1977, UMTRI child anthropometry); a line between statures of 80 and 150 cm.
fn shares(figure: Figure, stature_cm: f64) -> [f64; 11] {
    const WOMAN: [f64; 11] = [0.846, 0.8405, 0.822, 0.817, 0.757, 0.725, 0.690, 0.622, 0.511, 0.470, 0.280];
    const MAN: [f64; 11] = [0.850, 0.848, 0.825, 0.824, 0.760, 0.737, 0.690, 0.614, 0.519, 0.480, 0.285];
    const TODDLER: [f64; 11] = [0.806, 0.799, 0.783, 0.776, 0.716, 0.690, 0.650, 0.575, 0.434, 0.386, 0.235];
    const YOUTH: [f64; 11] = [0.841, 0.836, 0.818, 0.813, 0.754, 0.730, 0.685, 0.618, 0.511, 0.469, 0.280];
    match figure {
        Figure::Woman => WOMAN,
        Figure::Man => MAN,
        Figure::Child => {
            let t = ((stature_cm - 80.0) / 70.0).clamp(0.0, 1.0);
            std::array::from_fn(|i| TODDLER[i] + t * (YOUTH[i] - TODDLER[i]))
        }
    }
}

/// Arc along the back over its vertical height, nape to waist (the back's curve).
const BACK_ARC: f64 = 1.045;

impl Levels {
    pub(super) fn of(m: &Resolved, head: bool) -> Self {
        let stature = m.height * 10.0;
        let [nape, neck_side, front_neck, shoulder, armpit, bust, underbust, waist, hip, crotch, knee] =
            shares(m.figure, m.height).map(|s| s * stature);
        // A full bust lies a little lower.
        let drop = if m.figure == Figure::Woman {
            ((m.bust - m.underbust) / m.bust - 0.16).clamp(0.0, 0.1) * 0.12
        } else {
            0.0
        };
        let (bust, underbust) = (bust - drop * stature, underbust - 0.6 * drop * stature);
        // The back length moves the waist, within what leaves room for ribs above and hips below.
        let by_back = nape - m.back_length * 10.0 / BACK_ARC;
        let waist = by_back.clamp(waist - 0.025 * stature, waist + 0.022 * stature);
        Self {
            stature,
            top: if head { stature } else { HEADLESS_HEIGHT_RATIO * stature },
            nape,
            neck_side,
            front_neck,
            shoulder,
            armpit,
            bust,
            underbust,
            waist,
            high_hip: hip + 0.5 * (waist - hip),
            hip,
            crotch,
            thigh: crotch - 0.028 * stature,
            knee,
            calf: knee * 0.73,
            ankle: stature * 0.05,
        }
    }

    /// Name and height of every level, from the top down.
    pub fn named(&self) -> [(&'static str, f64); 17] {
        [
            ("stature", self.stature),
            ("top", self.top),
            ("nape", self.nape),
            ("neck_side", self.neck_side),
            ("front_neck", self.front_neck),
            ("shoulder", self.shoulder),
            ("armpit", self.armpit),
            ("bust", self.bust),
            ("underbust", self.underbust),
            ("waist", self.waist),
            ("high_hip", self.high_hip),
            ("hip", self.hip),
            ("crotch", self.crotch),
            ("thigh", self.thigh),
            ("knee", self.knee),
            ("calf", self.calf),
            ("ankle", self.ankle),
        ]
    }
}
