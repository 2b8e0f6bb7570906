//! What comes out: flat patches, finished pieces, seam checks.

use glam::DVec2;
use serde::Serialize;

use crate::input::MarkKind;

/// A complete pattern. Lengths are millimetres.
#[derive(Clone, Debug)]
pub struct Pattern {
    /// One piece a patch, in the patches' order.
    pub pieces: Vec<Piece>,
    /// The flat patches, in the patches' order, turned as their pieces (grain upward).
    pub flats: Vec<Flat>,
    /// Every seam, in the input's order, then the seams that automatic and given cuts made.
    pub seams: Vec<SeamCheck>,
    /// Where the pieces lie on the cloth.
    pub layout: Layout,
    /// What could not be met, in words.
    pub warnings: Vec<String>,
}

/// A patch in the plane. Cuts give one patch node several flat nodes.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Flat {
    /// Position of every flat node.
    pub uv: Vec<DVec2>,
    /// Faces over flat nodes, in the patch's order of faces.
    pub faces: Vec<[u32; 3]>,
    /// Node of the patch that each flat node is; the first `patch nodes` entries are the patch's nodes in order.
    pub node_of: Vec<u32>,
    /// Larger and smaller singular value of the map from space to plane, a face each.
    pub stretch: Vec<[f64; 2]>,
}

impl Flat {
    /// Flat positions of the corners of face `f`.
    #[inline]
    pub fn corners(&self, f: usize) -> [DVec2; 3] {
        self.faces[f].map(|v| self.uv[v as usize])
    }

    /// Flat positions of all corners, what [`mesh_kernel::TriMesh::corner_uvs`] holds.
    pub fn corner_uvs(&self) -> Vec<[DVec2; 3]> {
        (0..self.faces.len()).map(|f| self.corners(f)).collect()
    }
}

/// One finished piece, in its own frame: grain along +y, right side of the cloth up.
#[derive(Clone, Debug, Serialize)]
pub struct Piece {
    /// Name of the patch.
    pub name: String,
    /// Printed name.
    pub label: String,
    /// How many to cut.
    pub quantity: u32,
    /// Material; may be empty.
    pub material: String,
    /// The sewing line: outer loop first (anticlockwise), then holes (clockwise).
    pub sew: Vec<Outline>,
    /// The cut line, with allowance: outer loop first, then holes.
    pub cut: Vec<CutLoop>,
    /// Notches.
    pub notches: Vec<Notch>,
    /// Drill holes.
    pub drills: Vec<Drill>,
    /// Grain line, bottom to top.
    pub grain: [DVec2; 2],
    /// The fold, for pieces cut on the fold.
    pub fold: Option<Vec<DVec2>>,
    /// Lines inside the piece.
    pub lines: Vec<InnerLine>,
    /// Where the text stands (its middle).
    pub text_at: DVec2,
    /// How well it was flattened.
    pub report: PieceReport,
}

/// A closed sewing line made of chains.
#[derive(Clone, Debug, Serialize)]
pub struct Outline {
    /// The chains in order; each starts where the one before ends.
    pub chains: Vec<OutlineChain>,
}

impl Outline {
    /// All points of the loop, the first not repeated.
    pub fn points(&self) -> Vec<DVec2> {
        self.chains.iter().flat_map(|c| c.points[..c.points.len() - 1].iter().copied()).collect()
    }
}

/// A part of a sewing line between two corners, seam ends or changes of allowance.
#[derive(Clone, Debug, Serialize)]
pub struct OutlineChain {
    /// Seams of which this chain is (a part of) a side, with the side's number.
    pub seams: Vec<SeamRef>,
    /// Allowance, in millimetres.
    pub allowance_mm: f64,
    /// Whether it lies on the fold.
    pub on_fold: bool,
    /// Points, first and last included, within the line tolerance of the exact chain.
    pub points: Vec<DVec2>,
    /// Flat nodes of the exact chain, first and last included.
    #[serde(skip)]
    pub nodes: Vec<u32>,
    /// Length of the exact chain, in millimetres.
    pub length: f64,
}

/// One side of one seam.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
pub struct SeamRef {
    /// Index into [`Pattern::seams`].
    pub seam: usize,
    /// Index of the side.
    pub side: usize,
    /// Whether the chain runs against the seam's direction.
    pub reversed: bool,
}

/// A closed cut line.
#[derive(Clone, Debug, Serialize)]
pub struct CutLoop {
    /// Points, the first not repeated.
    pub points: Vec<DVec2>,
    /// Whether each point is a corner (turn point) or lies on a curve.
    pub corner: Vec<bool>,
}

/// A notch.
#[derive(Clone, Debug, Serialize)]
pub struct Notch {
    /// Name.
    pub name: String,
    /// Single or double.
    pub kind: MarkKind,
    /// Where it meets the sewing line.
    pub sew: DVec2,
    /// Where it meets the cut line.
    pub cut: DVec2,
    /// Unit direction into the piece.
    pub inward: DVec2,
    /// Depth, in millimetres.
    pub depth: f64,
    /// The cuts to make, from the cut line inward: one, or two side by side.
    pub slits: Vec<[DVec2; 2]>,
    /// Seam on which it was matched with the other sides.
    pub seam: Option<SeamRef>,
    /// Name of that seam; empty without.
    pub seam_name: String,
    /// Distance from the seam's start along the sewing line, in millimetres.
    pub along: Option<f64>,
}

/// A drill hole.
#[derive(Clone, Debug, Serialize)]
pub struct Drill {
    /// Name.
    pub name: String,
    /// Place.
    pub at: DVec2,
}

/// A line inside a piece, drawn and not cut.
#[derive(Clone, Debug, Serialize)]
pub struct InnerLine {
    /// Name.
    pub name: String,
    /// Seam of which it is a side, when something is sewn on there.
    pub seam: Option<SeamRef>,
    /// Points.
    pub points: Vec<DVec2>,
}

/// How well one patch was flattened.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct PieceReport {
    /// Area in space, in mm².
    pub area_3d: f64,
    /// Area of the sewn shape, in mm².
    pub area_2d: f64,
    /// Area-weighted mean of |1 − σ| over both singular values.
    pub mean_stretch: f64,
    /// Largest |1 − σ|.
    pub max_stretch: f64,
    /// Area-weighted mean of |1 − σ₁σ₂|.
    pub mean_area_change: f64,
    /// Symmetric Dirichlet energy per area; 4 is perfect.
    pub energy: f64,
    /// Triangles face down.
    pub flipped: usize,
    /// Pairs of boundary edges that cross: the piece lies on itself.
    pub overlaps: usize,
    /// Newton steps taken.
    pub steps: usize,
}

/// One seam: how well its sides fit each other on the pieces.
#[derive(Clone, Debug, Serialize)]
pub struct SeamCheck {
    /// Name.
    pub name: String,
    /// The sides' patches.
    pub patches: Vec<usize>,
    /// Length in space, in millimetres.
    pub length_3d: f64,
    /// Length of each side on its piece, in millimetres.
    pub lengths_2d: Vec<f64>,
    /// Longest less shortest side, in millimetres.
    pub mismatch: f64,
    /// Largest difference between corresponding edges, relative to the edge's length in space.
    pub edge_mismatch: f64,
    /// Largest difference between the sides of a notch's distance from the seam's start, in millimetres.
    pub notch_mismatch: f64,
    /// Whether a cut made this seam (its sides belong to one patch).
    pub from_cut: bool,
}

/// Places of the pieces on the cloth.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct Layout {
    /// Width of the cloth (x), in millimetres; more than asked when a piece is wider.
    pub width: f64,
    /// Length used (y), in millimetres.
    pub length: f64,
    /// What is added to a piece's coordinates, a piece each.
    pub offsets: Vec<DVec2>,
}
