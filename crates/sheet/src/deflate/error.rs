//! Why a solid could not be deflated.

use glam::DVec3;

use super::report::NamedFace;

/// Why a solid could not be deflated. Lengths are millimetres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum DeflateError {
    /// There is nothing to deflate.
    #[error("the solid has no faces with an area")]
    Empty,
    /// A coordinate is not a finite number.
    #[error("node {node} has a coordinate that is no finite number")]
    NotFinite {
        /// The node.
        node: u32,
    },
    /// An option is out of its range.
    #[error("the option {option} is {value}, but must be {wanted}")]
    OptionRange {
        /// Its name.
        option: &'static str,
        /// What it was.
        value: f64,
        /// What it may be.
        wanted: &'static str,
    },
    /// Some edges have one face only.
    #[error("the solid is open: {edges} edges have one face only, first face {} at ({:.3}, {:.3}, {:.3}); close its holes first",
        face + 1, at.x, at.y, at.z)]
    Open {
        /// How many.
        edges: usize,
        /// The face at the first, of the input.
        face: u32,
        /// The middle of the first.
        at: DVec3,
    },
    /// Some edges have more than two faces, or two that are wound differently.
    #[error("the solid is no clean skin: at {edges} edges faces are wound against each other or more than two meet, \
        the first at ({:.3}, {:.3}, {:.3})", at.x, at.y, at.z)]
    NotManifold {
        /// How many.
        edges: usize,
        /// The middle of the first.
        at: DVec3,
    },
    /// Faces cross.
    #[error("the solid crosses itself: {pairs} pairs of faces have more in common than their nodes, \
        first the faces {} and {} at ({:.3}, {:.3}, {:.3})", faces[0] + 1, faces[1] + 1, at.x, at.y, at.z)]
    SelfCrossing {
        /// How many pairs.
        pairs: usize,
        /// The first pair, faces of the input.
        faces: [u32; 2],
        /// About where.
        at: DVec3,
    },
    /// Most of the solid has no wall opposite to it.
    #[error("the solid is not thin: only {:.0} % of its skin has a partner within {max_thickness:.3} mm; without one are \
        {}", 100.0 * paired, named(unpaired))]
    Bulky {
        /// Share of the area that has a partner.
        paired: f64,
        /// The largest thickness that was looked for.
        max_thickness: f64,
        /// Faces without a partner, the largest first.
        unpaired: Vec<NamedFace>,
    },
    /// Both sides of a wall are one, so nothing tells which of its faces to keep.
    #[error("both sides of a wall are one: from ({:.3}, {:.3}, {:.3}) its skin of {area:.1} mm² runs smoothly to its own back, as \
        that of a Möbius strip does", at.x, at.y, at.z)]
    OneSided {
        /// The area of its skin, in mm².
        area: f64,
        /// A point on it.
        at: DVec3,
    },
    /// The caller ended it.
    #[error("cancelled")]
    Cancelled,
}

/// The first few faces of many, for a message.
fn named(faces: &[NamedFace]) -> String {
    const SHOWN: usize = 6;
    let shown: Vec<String> = faces.iter().take(SHOWN).map(ToString::to_string).collect();
    let more = faces.len().saturating_sub(SHOWN);
    shown.join(", ") + &if more > 0 { format!(" and {more} more") } else { String::new() }
}
