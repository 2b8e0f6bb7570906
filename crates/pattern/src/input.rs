//! What goes in: patches in space, the seams between them, marks and lines on them.

use glam::DVec3;

use crate::Flat;

/// Everything that [`make`](crate::make) needs.
#[derive(Clone, Debug, Default)]
pub struct PatternInput {
    /// The patches; each becomes one piece.
    pub patches: Vec<Patch>,
    /// What is sewn to what.
    pub seams: Vec<SeamInput>,
    /// Notches and drill holes at nodes. A notch on a seam also appears on the other sides of the seam.
    pub marks: Vec<Mark>,
    /// Inner lines to be drawn on the pieces.
    pub lines: Vec<PatchLine>,
    /// Where patches are to be cut open before flattening: darts, slits, the opening of a tube.
    pub cuts: Vec<PatchLine>,
    /// Flat patches of an earlier run, in the patches' order, to start from; may be empty. One that does not fit (other
    /// faces, or flipped on the new shape) is passed over.
    pub start: Vec<Flat>,
}

/// One surface of the garment: an oriented 2-manifold triangle patch with boundary.
#[derive(Clone, Debug, Default)]
pub struct Patch {
    /// Name, unique among the patches.
    pub name: String,
    /// Node positions, in millimetres.
    pub positions: Vec<DVec3>,
    /// Faces, anticlockwise seen from the outside of the cloth, which becomes the upper side of the piece.
    pub faces: Vec<[u32; 3]>,
    /// Direction of the grain in space; it is projected onto the patch. `None`: the vertical, where the patch has
    /// one, else the longest direction.
    pub grain: Option<DVec3>,
    /// What the piece shall look like.
    pub piece: PieceSpec,
}

/// How the piece of a patch is finished.
#[derive(Clone, Debug)]
pub struct PieceSpec {
    /// Printed name; empty: the patch's name.
    pub label: String,
    /// How many to cut.
    pub quantity: u32,
    /// Material, printed when not empty.
    pub material: String,
    /// Seam allowance in millimetres wherever `edges` says nothing else.
    pub allowance_mm: f64,
    /// Allowance and corners of single boundary chains.
    pub edges: Vec<EdgeSpec>,
    /// A boundary path of nodes that lies on the fold of the cloth: no allowance there, a mirror line instead.
    pub on_fold: Option<Vec<u32>>,
}

impl Default for PieceSpec {
    fn default() -> Self {
        Self {
            label: String::new(),
            quantity: 1,
            material: String::new(),
            allowance_mm: 10.0,
            edges: Vec::new(),
            on_fold: None,
        }
    }
}

/// Allowance along one boundary chain of a patch.
#[derive(Clone, Debug)]
pub struct EdgeSpec {
    /// Which chain.
    pub chain: EdgeChain,
    /// Width in millimetres; 0 cuts on the sewing line.
    pub allowance_mm: f64,
    /// Shape of the allowance at both ends of the chain.
    pub corner: CornerStyle,
}

/// Names a chain of a patch's boundary.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum EdgeChain {
    /// Consecutive boundary nodes, either direction; first = last means a whole loop.
    Nodes(Vec<u32>),
    /// Every side that this patch has of the seam of that name.
    Seam(String),
    /// Every boundary edge that no seam uses (hems, openings).
    Free,
}

/// Shape of the seam allowance where two chains meet in an outward corner.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum CornerStyle {
    /// Both cut lines run on until they meet; blunted where that is farther than the mitre limit.
    #[default]
    Mitre,
    /// Straight from the end of one cut line to the start of the next.
    Bevel,
    /// The allowance of the chain ends square to its sewing line, level with the corner's mitre on the neighbour's
    /// sewing line, so that it lies flush when pressed open.
    Square,
    /// The allowance ends as the mirror image of the neighbouring edge, so that it lies flush when folded back
    /// (hems, sleeve ends).
    Mirrored,
}

/// A seam: two or more sides that are sewn together node to node.
#[derive(Clone, Debug, Default)]
pub struct SeamInput {
    /// Name, unique among the seams.
    pub name: String,
    /// The sides; all have the same number of nodes, in the same direction, and equal lengths in space.
    pub sides: Vec<SeamSide>,
}

/// One side of a seam.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SeamSide {
    /// Index of the patch.
    pub patch: usize,
    /// Nodes of the patch along the seam, consecutive ones joined by an edge; on the boundary or inside.
    pub nodes: Vec<u32>,
}

/// A mark for the maker.
#[derive(Clone, Debug)]
pub struct Mark {
    /// Index of the patch.
    pub patch: usize,
    /// Node of the patch.
    pub node: u32,
    /// What is marked.
    pub kind: MarkKind,
    /// Name, for the reports.
    pub name: String,
}

/// Kinds of marks.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize)]
#[serde(rename_all = "snake_case")]
pub enum MarkKind {
    /// A cut into the allowance, single (by custom: front). Left out at corners, which mark themselves, and inside
    /// the piece.
    Notch,
    /// Two notches side by side (by custom: back).
    DoubleNotch,
    /// A drill hole inside the piece.
    Drill,
}

/// A line along edges of a patch.
#[derive(Clone, Debug, Default)]
pub struct PatchLine {
    /// Index of the patch.
    pub patch: usize,
    /// Consecutive nodes, joined by edges.
    pub nodes: Vec<u32>,
    /// Name, for the reports.
    pub name: String,
}

/// Settings of [`make`](crate::make).
#[derive(Clone, Debug)]
pub struct PatternOptions {
    /// What happens to patches with holes.
    pub holes: HolePolicy,
    /// Whether corresponding seam edges are forced to equal lengths.
    pub match_seams: bool,
    /// What a change of area costs beside stretch in length, 0 or more. Woven cloth gives in shear, not in area: with 0
    /// the pieces are as near to isometric as can be (least symmetric Dirichlet energy), with more they keep their
    /// areas better and shear instead.
    pub area_weight: f64,
    /// A corner of the outline is a turn of more than this, in radians.
    pub corner_angle: f64,
    /// Longest mitre, as a multiple of the wider allowance.
    pub mitre_limit: f64,
    /// How far the drawn lines may leave the exact ones, in millimetres.
    pub line_tolerance_mm: f64,
    /// Length of a notch, in millimetres (never more than the allowance is wide, less 1 mm).
    pub notch_depth_mm: f64,
    /// Width of the cloth on which the pieces are laid out, in millimetres.
    pub fabric_width_mm: f64,
    /// Gap between pieces of the layout, in millimetres.
    pub layout_gap_mm: f64,
}

impl Default for PatternOptions {
    fn default() -> Self {
        Self {
            holes: HolePolicy::Auto,
            match_seams: true,
            area_weight: 2.0,
            corner_angle: 30f64.to_radians(),
            mitre_limit: 3.0,
            line_tolerance_mm: 0.05,
            notch_depth_mm: 5.0,
            fabric_width_mm: 1500.0,
            layout_gap_mm: 10.0,
        }
    }
}

/// What happens to patches with more than one boundary loop.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum HolePolicy {
    /// A hole stays when its rim turns like a hole of a flat piece (a round yoke); a tube is cut open.
    #[default]
    Auto,
    /// Every hole stays; nothing is cut but the given cuts.
    Keep,
    /// Every hole is cut open to the outer rim.
    Cut,
}
