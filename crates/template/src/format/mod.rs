//! The template file: JSON that a person writes by hand.
//!
//! All lengths are millimetres. *Left* is the person's left (+x), *up* is +y, *front* is +z. A small worked example, a
//! straight skirt of two panels a side on a waistband line:
//!
//! ```
//! let text = r#"{
//!   "toile_template": 1,
//!   "name": "straight skirt",
//!   "mirrored": true,
//!   "level": 3,
//!   "clearance": 4,
//!   "nodes": {
//!     "front_waist":  { "at": ["waist", "centre_front"], "centre": true, "normal": 8, "ease": "waist" },
//!     "left_waist":   { "at": ["waist", "left_side"],    "normal": 8, "ease": "waist" },
//!     "back_waist":   { "at": ["waist", "centre_back"],  "centre": true, "normal": 8, "ease": "waist" },
//!     "front_hip":    { "at": ["hip", "centre_front"],   "centre": true, "normal": 20, "ease": "hip" },
//!     "left_hip":     { "at": ["hip", "left_side"],      "normal": 15, "ease": "hip" },
//!     "back_hip":     { "at": ["hip", "centre_back"],    "centre": true, "normal": 15, "ease": "hip" },
//!     "front_hem":    { "at": ["hip", "centre_front"],   "centre": true, "normal": 40,
//!                       "level": { "from": "hip", "to": "floor", "t": 0.45 } },
//!     "left_hem":     { "at": ["hip", "left_side"], "normal": 40,
//!                       "level": { "from": "hip", "to": "floor", "t": 0.45 } },
//!     "back_hem":     { "at": ["hip", "centre_back"], "centre": true, "normal": 40,
//!                       "level": { "from": "hip", "to": "floor", "t": 0.45 } }
//!   },
//!   "surfaces": {
//!     "left_front": { "rows": [["front_waist", "left_waist"], ["front_hip", "left_hip"], ["front_hem", "left_hem"]] },
//!     "left_back":  { "rows": [["left_waist", "back_waist"], ["left_hip", "back_hip"], ["left_hem", "back_hem"]] }
//!   },
//!   "lines": {
//!     "waist_edge": { "through": ["front_waist", "left_waist", "back_waist"], "across_centre": true, "closed": true },
//!     "hem":        { "through": ["front_hem", "left_hem", "back_hem"], "across_centre": true, "closed": true },
//!     "left_seam":  { "through": ["left_waist", "left_hip", "left_hem"] }
//!   },
//!   "fair_across": [["left_front", "right_front", "left_back", "right_back"]],
//!   "ease": { "waist": { "ease": 20 }, "hip": { "ease": 50 } },
//!   "pieces": {
//!     "left_front": { "label": "Front", "allowance": 10, "edges": { "hem": 30 }, "grain": "down" },
//!     "left_back":  { "label": "Back", "allowance": 10, "edges": { "hem": 30 } }
//!   }
//! }"#;
//! let template = template::Template::from_json(text)?;
//! assert_eq!(template.file().nodes.len(), 9);
//! # Ok::<(), template::TemplateError>(())
//! ```
//!
//! # Mirroring
//! With `"mirrored": true` everything named `left_…` (nodes, surfaces, lines, pieces), or marked `"mirror": true`, gets a
//! twin named `right_…`; write the twin yourself and yours is taken. Names inside (features, nodes, lines) swap `left_`
//! and `right_` too. Nodes on the plane of symmetry say `"centre": true` and stay single.
//!
//! # Grids
//! `rows` lists the surface's nodes row by row; write rows from top to bottom and nodes in the order in which they come
//! from the person's **right to left as seen from outside** (front: centre → left side; back: left side → centre back,
//! that is, anticlockwise seen from above) and the surface faces outward. The program turns a surface that faces the body
//! over, so the order is a convention, not a trap. Rows may have different lengths.

pub(crate) mod check;
pub(crate) mod strict;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use check::DEEPEST;

/// Version of the format that this program writes and reads.
pub const FORMAT_VERSION: u32 = 1;

/// A template as it stands in the file.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct TemplateFile {
    /// Format version: 1.
    pub toile_template: u32,
    /// Name of the garment.
    pub name: String,
    /// A sentence for people.
    #[serde(default, skip_serializing_if = "String::is_empty")]
    pub description: String,
    /// Everything `left_…` or marked `"mirror": true` gets a right twin.
    #[serde(default)]
    pub mirrored: bool,
    /// Only with `mirrored`: make both halves exactly each other's mirror image (default), or with `false` let each
    /// half follow its half of the body.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub symmetric: Option<bool>,
    /// How often every face is split 1→4 (0 to 8).
    #[serde(default = "default_level")]
    pub level: u8,
    /// Only as many of these splits as it takes to stay within this distance of the fully split surfaces, mm (0.01 to 50).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adaptive: Option<f64>,
    /// Wanted distance of the garment's inside to the skin, mm.
    #[serde(default = "default_clearance")]
    pub clearance: f64,
    /// Template nodes by name.
    pub nodes: BTreeMap<String, NodeSpec>,
    /// Surfaces (patches, later pattern pieces) by name.
    pub surfaces: BTreeMap<String, SurfaceSpec>,
    /// Joints; left out, they are found: wherever surfaces share edges.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub joints: Option<Vec<JointSpec>>,
    /// Lines (profiles) on chains of template edges, by name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub lines: BTreeMap<String, LineSpec>,
    /// Groups of surfaces that are smooth across the joints among them.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub fair_across: Vec<Vec<String>>,
    /// Wanted girth eases by level name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub ease: BTreeMap<String, EaseSpec>,
    /// How surfaces become pattern pieces, by surface name.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub pieces: BTreeMap<String, PieceSpec>,
}

fn default_level() -> u8 {
    4
}

fn default_clearance() -> f64 {
    4.0
}

/// Where a node sits beside the body. Give either `at` or `between`.
///
/// The steps are taken in this order: origin (`at` or `between`), `slide`, offset (`normal`/`first`/`second`, or
/// `axes`), `skin`, `level`, `ease`.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct NodeSpec {
    /// The feature point: the crossing of two feature curves `["waist", "left_side"]`, or a point's name `"left_bust"`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub at: Option<At>,
    /// Instead of `at`: a place between two other nodes of the template (before collision), see `t`. The normal is the
    /// body's nearest one.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub between: Option<[String; 2]>,
    /// Share of the way from the first to the second node of `between`; 0.5 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub t: Option<f64>,
    /// The node lies on the plane of symmetry.
    #[serde(default, skip_serializing_if = "is_false")]
    pub centre: bool,
    /// With `mirrored`: make a twin though the name does not begin with `left_`.
    #[serde(default, skip_serializing_if = "is_false")]
    pub mirror: bool,
    /// Offset along the outward normal, mm (α of eq. 1).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub normal: f64,
    /// Offset along the first curve's tangent, mm (β of eq. 1); along `slide.along` after a slide.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub first: f64,
    /// Offset along the second curve's tangent, mm (γ of eq. 1).
    #[serde(default, skip_serializing_if = "is_zero")]
    pub second: f64,
    /// Offset along the world's axes `[left, up, front]`, mm (eq. 2); added to the other offsets.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub axes: Option<[f64; 3]>,
    /// Moves the origin along a feature curve before the offset is added.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub slide: Option<Slide>,
    /// Replaces the node's height.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub level: Option<Level>,
    /// After the offset: goes to the nearest place of the body and this far out along the smoothed normal, mm.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub skin: Option<f64>,
    /// The ease level whose solver moves this node outward or inward (horizontally).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub ease: Option<String>,
    /// Offsets, slides in mm and `level.plus` grow with the stature (1680 mm: as written).
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub scale: Option<Scale>,
}

fn is_false(v: &bool) -> bool {
    !*v
}

fn is_zero(v: &f64) -> bool {
    *v == 0.0
}

/// A feature point.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(
    untagged,
    expecting = "a pair of feature curves [\"waist\", \"left_side\"] or a feature point's name"
)]
pub enum At {
    /// Where two feature curves cross.
    Crossing([String; 2]),
    /// A named feature point.
    Point(String),
}

/// A walk along a feature curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Slide {
    /// The curve to walk on.
    pub along: String,
    /// The curve that crosses it, or the point near it, to walk to; the shorter way round on a closed curve. Without it
    /// the walk goes in the curve's own direction.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub toward: Option<String>,
    /// How far, mm (negative: the other way). Give this or `fraction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub by: Option<f64>,
    /// How far, as a share of the way to `toward`, or of the curve's length without `toward`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fraction: Option<f64>,
}

/// A height: that of a feature, or between two.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "a feature's name or { \"from\", \"to\", \"t\", \"plus\" }")]
pub enum Level {
    /// The mean height of a feature curve, the height of a feature point, `floor` or `crown`.
    Feature(String),
    /// Between two of them.
    Between(LevelBetween),
}

/// A height between two features' heights.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LevelBetween {
    /// Feature curve, feature point, `floor` or `crown`.
    pub from: String,
    /// The other one; the same as `from` when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub to: Option<String>,
    /// Share of the way from `from` to `to` (below 0 and above 1 allowed).
    #[serde(default)]
    pub t: f64,
    /// Added at the end, upward, mm.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub plus: f64,
}

/// What offsets grow with.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Scale {
    /// The stature, relative to 1680 mm.
    Height,
}

/// A patch: a grid of nodes, or faces one by one.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SurfaceSpec {
    /// A grid: rows of node names from top to bottom.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rows: Option<Vec<Vec<String>>>,
    /// Triangles and quads of node names, all turning the same way; may be given beside `rows`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub faces: Option<Vec<Vec<String>>>,
    /// The patch is what is listed and its mirror image in one, with no joint at the centre.
    #[serde(default, skip_serializing_if = "is_false")]
    pub across_centre: bool,
    /// With `mirrored`: make a twin though the name does not begin with `left_`.
    #[serde(default, skip_serializing_if = "is_false")]
    pub mirror: bool,
    /// What template nodes inside the patch mean to the fairing.
    #[serde(default)]
    pub interior: Interior,
    /// Lines along which the flat piece is slit (darts, cuts).
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub open_along: Vec<String>,
    /// Which layer the patch is: 0 is next to the body, 1 lies over it, and so on. Ease is measured on the lowest layer.
    #[serde(default, skip_serializing_if = "is_zero_u8")]
    pub layer: u8,
}

fn is_zero_u8(v: &u8) -> bool {
    *v == 0
}

/// What template nodes inside a patch mean to the fairing.
#[derive(Clone, Copy, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum Interior {
    /// The surface goes near them: their pull is elastic, so that no dents show. The default.
    #[default]
    Near,
    /// The surface goes through them, as in the paper.
    Pinned,
    /// They only serve the topology.
    Free,
}

/// A joint given by hand.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct JointSpec {
    /// Name; the surfaces' names when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The surfaces that meet here; a surface may be named twice when it meets the joint on both sides of a slit.
    pub surfaces: Vec<String>,
    /// The chain of template nodes, in the joint's direction.
    pub nodes: Vec<String>,
    /// The chain closes from its last node to its first.
    #[serde(default, skip_serializing_if = "is_false")]
    pub closed: bool,
}

/// A line: a curve on a chain of template edges. New nodes of these edges come to lie on it.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct LineSpec {
    /// The nodes, neighbours joined by a template edge.
    pub through: Vec<String>,
    /// The line closes from its last node to its first.
    #[serde(default, skip_serializing_if = "is_false")]
    pub closed: bool,
    /// The line is what is listed and its mirror image in one.
    #[serde(default, skip_serializing_if = "is_false")]
    pub across_centre: bool,
    /// With `mirrored`: make a twin though the name does not begin with `left_`.
    #[serde(default, skip_serializing_if = "is_false")]
    pub mirror: bool,
    /// The curve's shape; a smooth spline through the nodes when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub shape: Option<Shape>,
    /// Nodes at which the line has a corner.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub corners: Vec<String>,
    /// The line that this one runs into at its last node, smoothly.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub continues: Option<String>,
    /// `true`: the line's nodes stay on the curve. `false`: the curve is where construction starts, and fairing across
    /// the joint may move it. Left out: a line inside a `fair_across` group may move if `shape` is left out, too.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub hold: Option<bool>,
}

/// Shape of a line.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "\"spline\", \"straight\", { \"points\": … } or { \"follow\": … }")]
pub enum Shape {
    /// `"spline"` or `"straight"`.
    Named(NamedShape),
    /// A drawn profile.
    Profile(ProfileShape),
    /// Along a feature curve.
    Follow(FollowShape),
}

/// Shapes that need nothing but a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NamedShape {
    /// An interpolating cubic spline with continuous curvature (centripetal parameters).
    Spline,
    /// Straight between nodes.
    Straight,
}

/// A profile drawn on one template edge (or from the first to the last node of a line): it moves with the edge after
/// eq. 3 of the paper.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ProfileShape {
    /// The curve as it was drawn, mm; its first and last point are the edge's ends as they were then.
    pub points: Vec<[f64; 3]>,
    /// Turn the detail with the edge (beyond the paper).
    #[serde(default, skip_serializing_if = "is_false")]
    pub turn: bool,
}

/// A line along a feature curve.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct FollowShape {
    /// The feature curve.
    pub follow: String,
    /// Distance to the curve, outward, mm; between that of the end nodes when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub clearance: Option<f64>,
}

/// A wanted girth.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct EaseSpec {
    /// Girth of the garment less girth of the body, mm.
    pub ease: f64,
    /// The feature curve around the body; the level's name when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub curve: Option<String>,
    /// The surfaces to measure; the lowest layer's when left out.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub surfaces: Vec<String>,
}

/// How a surface becomes a pattern piece.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PieceSpec {
    /// Name on the piece; the surface's name when left out. Pieces of a pair with one name get `left` and `right` after it.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub label: Option<String>,
    /// How many to cut; 1 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub quantity: Option<u32>,
    /// Seam allowance, mm; 10 when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub allowance: Option<f64>,
    /// Allowances of single edges by line name, mm.
    #[serde(default, skip_serializing_if = "BTreeMap::is_empty")]
    pub edges: BTreeMap<String, f64>,
    /// Grain direction; downward when left out.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub grain: Option<Grain>,
    /// The line that lies on the fabric's fold.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub on_fold: Option<String>,
    /// What it is cut from, for instance `shell` or `lining`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub fabric: Option<String>,
}

/// Grain direction of a piece.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(untagged, expecting = "\"down\" or a pair of nodes")]
pub enum Grain {
    /// From one template node of the surface to another.
    Nodes([String; 2]),
    /// `"down"`: along the vertical.
    Named(NamedGrain),
}

/// Grain directions that need nothing but a name.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum NamedGrain {
    /// Along the vertical.
    Down,
}
