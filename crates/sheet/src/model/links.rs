//! How the sides of sheets are linked about an edge (Stroud & Nagy, figs. 6.15–6.16).
//!
//! A sheet has two sides. Where it is walked along an edge, its front is the *left* link of the edge and its back the *right*
//! one. At a joint the sides that look into one sector are linked: two sheets that run the same way link L1 with R2 and L2 with
//! R1; two that run opposite ways link L1 with L2 and R1 with R2.

use mesh_kernel::complex::{Complex, EdgeId, FaceId, FaceUse};
use serde::Serialize;

/// A side of a sheet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum LinkSide {
    /// The front, from which the sheet's loop is anticlockwise: L, by the direction in which the sheet walks the edge.
    Left,
    /// The back: R.
    Right,
}

/// A side of a face at an edge.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Link {
    /// The face.
    pub face: FaceId,
    /// Its side.
    pub side: LinkSide,
}

/// The sectors about an edge, clockwise for one who looks along it, each with the two sides that look into it. Several edges
/// with the same ends count as one joint whose edges are kept; the first gives the direction. `None` where these have more
/// than two sheets, for they store no common order. O(uses).
pub fn joint_links(complex: &Complex, edges: &[EdgeId]) -> Option<Vec<[Link; 2]>> {
    let first = *edges.first()?;
    let ends = complex.ends(first)?;
    let mut uses: Vec<FaceUse> = Vec::new();
    for &e in edges {
        let own = complex.ends(e)?;
        let turned = own == [ends[1], ends[0]];
        if own != ends && !turned {
            return None;
        }
        uses.extend(complex.uses(e).iter().map(|u| if turned { u.flipped() } else { *u }));
    }
    if edges.len() > 1 && uses.len() > 2 {
        return None;
    }
    // A right hand that turns about the edge leaves a face on its front where that walks along.
    let ahead =
        |u: FaceUse| Link { face: u.face, side: if u.along { LinkSide::Left } else { LinkSide::Right } };
    let behind =
        |u: FaceUse| Link { face: u.face, side: if u.along { LinkSide::Right } else { LinkSide::Left } };
    let n = uses.len();
    Some((0..n).map(|i| [ahead(uses[i]), behind(uses[(i + 1) % n])]).collect())
}
