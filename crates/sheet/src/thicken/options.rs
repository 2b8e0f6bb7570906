//! What a thickened sheet should be like.

/// Which sides of the sheet get material.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Side {
    /// Half the thickness on either side.
    #[default]
    Both,
    /// All of it on the side that faces are anticlockwise from.
    Front,
    /// All of it on the other side.
    Back,
}

/// How the outer side of a fold is closed.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Corners {
    /// By an arc about the fold.
    #[default]
    Round,
    /// By extending the walls until they meet, as far as the mitre limit allows.
    Mitre,
}

/// How thick.
#[derive(Clone, Debug, PartialEq)]
pub enum Thickness {
    /// The same everywhere, in millimetres.
    Constant(f64),
    /// A number a patch (group), in millimetres; a step where patches of different thickness meet.
    PerPatch(Vec<f64>),
    /// A number a node, in millimetres, linear over the faces between.
    PerNode(Vec<f64>),
}

/// Options of [`thicken`](super::thicken).
#[derive(Clone, Debug, PartialEq)]
pub struct ThickenOptions {
    /// How thick.
    pub thickness: Thickness,
    /// On which side.
    pub side: Side,
    /// What becomes of folds.
    pub corners: Corners,
    /// Farthest that an arc may be from its chords, in millimetres; `None`: 3.5 % of the radius, 3 chords for a right angle.
    pub chord: Option<f64>,
    /// A mitre longer than this many times the offset is cut to an arc.
    pub mitre_limit: f64,
}

impl ThickenOptions {
    /// Both sides, round corners.
    pub fn new(thickness: f64) -> Self {
        Self {
            thickness: Thickness::Constant(thickness),
            side: Side::default(),
            corners: Corners::default(),
            chord: None,
            mitre_limit: 4.0,
        }
    }
}
