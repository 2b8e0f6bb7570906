//! Modelling commands as data.

use glam::DVec3;
use mesh_kernel::complex::EdgeId;
use serde::{Deserialize, Serialize};
use sketch::Outline;

use super::{ExtrusionCase, WorkPlane};

/// What is done with edges of a wire that lie along its extrusion and are no sides of sheets (fig. 6.18).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum AlongWire {
    /// The command is refused.
    #[default]
    Refuse,
    /// They stay wires.
    Keep,
    /// They go.
    Drop,
}

/// What becomes of edges in one place when sheets are joined (figs. 6.15–6.16).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum JoinEdges {
    /// One edge of all.
    #[default]
    Merge,
    /// They stay, and share their corners.
    Keep,
}

fn one() -> f64 {
    1.0
}

fn yes() -> bool {
    true
}

/// A modelling command. In JSON an object with `"do"`, the command's name, and its fields. Lengths in millimetres, angles in
/// degrees; points in space are `[x, y, z]`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(tag = "do", rename_all = "snake_case", deny_unknown_fields)]
pub enum Command {
    /// Nodes and links: drawings on a plane, polylines in space. It may branch.
    Wire {
        /// Its name.
        name: String,
        /// Drawings.
        #[serde(default)]
        drawings: Vec<Outline>,
        /// The plane on which they lie.
        #[serde(default)]
        plane: WorkPlane,
        /// Polylines in space; closed where the last point is the first.
        #[serde(default)]
        lines: Vec<Vec<DVec3>>,
    },
    /// A wire or a drawing becomes sheets, or a solid, along a direction or a path.
    Extrude {
        /// Name of the patch.
        name: String,
        /// The wire; it is used up.
        #[serde(default)]
        wire: Option<String>,
        /// Or a drawing.
        #[serde(default)]
        outline: Option<Outline>,
        /// The drawing's plane.
        #[serde(default)]
        plane: WorkPlane,
        /// Direction and distance.
        #[serde(default)]
        by: Option<DVec3>,
        /// Or a path in space.
        #[serde(default)]
        along: Option<Vec<DVec3>>,
        /// Or a path drawn on a plane.
        #[serde(default)]
        path: Option<Outline>,
        /// The path's plane.
        #[serde(default)]
        path_plane: WorkPlane,
        /// Whether the profile turns with the path.
        #[serde(default = "yes")]
        turn: bool,
        /// Whether both ends are closed, so that it is a solid.
        #[serde(default)]
        solid: bool,
        /// What becomes of edges along the direction.
        #[serde(default)]
        edges_along: AlongWire,
    },
    /// A sheet from a drawing.
    Create {
        /// Name of the patch.
        name: String,
        /// Its outline.
        outline: Outline,
        /// Its holes.
        #[serde(default)]
        holes: Vec<Outline>,
        /// The plane of both.
        #[serde(default)]
        plane: WorkPlane,
    },
    /// A face through points, joined to what is there; to a new patch or an old one.
    Add {
        /// Name of the patch.
        name: String,
        /// Its corners.
        points: Vec<DVec3>,
    },
    /// A hole in a patch.
    Punch {
        /// The patch.
        patch: String,
        /// The hole.
        outline: Outline,
        /// Its plane; the hole is projected along the plane's normal.
        #[serde(default)]
        plane: WorkPlane,
    },
    /// A part of a sheet is turned about a line.
    Bend {
        /// The patch that moves, with all that hangs on it.
        moving: String,
        /// The line: an edge, or from border to border of a face, which is cut there (the part to the left of it moves).
        about: [DVec3; 2],
        /// By what angle, right-handed about the line.
        angle: f64,
    },
    /// Edges become faces along a direction or a path.
    Sweep {
        /// Name of the new patch.
        name: String,
        /// Corners along edges that are there.
        edges: Vec<DVec3>,
        /// Direction and distance.
        #[serde(default)]
        by: Option<DVec3>,
        /// Or a path in space.
        #[serde(default)]
        along: Option<Vec<DVec3>>,
        /// Whether the edges turn with the path.
        #[serde(default)]
        turn: bool,
    },
    /// A part of a sheet is moved, and walls join it to the rest.
    Draw {
        /// The patch.
        patch: String,
        /// Name of the new patch: walls and bottom.
        name: String,
        /// What is drawn.
        outline: Outline,
        /// Its plane.
        #[serde(default)]
        plane: WorkPlane,
        /// Direction and distance.
        by: DVec3,
        /// Size of the bottom, as a share of the outline's.
        #[serde(default = "one")]
        scale: f64,
    },
    /// A fold becomes an arc, or corners of a face are rounded.
    Round {
        /// The fold's ends.
        #[serde(default)]
        edge: Option<[DVec3; 2]>,
        /// Or corners.
        #[serde(default)]
        corners: Vec<DVec3>,
        /// The radius.
        radius: f64,
        /// Name of the arc's patch; that of the first face where there is none.
        #[serde(default)]
        name: String,
    },
    /// An edge becomes a plane.
    Chamfer {
        /// The edge's ends.
        edge: [DVec3; 2],
        /// How far the plane's middle is from the edge.
        depth: f64,
        /// Name of the plane's patch; that of the first face where there is none.
        #[serde(default)]
        name: String,
    },
    /// Sheets are joined where they touch.
    Join {
        /// The patches; all where none is named.
        #[serde(default)]
        patches: Vec<String>,
        /// What becomes of edges in one place.
        #[serde(default)]
        edges: JoinEdges,
        /// Whether sheets are first cut where they touch or cross.
        #[serde(default)]
        split: bool,
    },
    /// Patches are taken away; of a volume a sheet is left.
    Remove {
        /// The patches.
        patches: Vec<String>,
    },
    /// Says that a patch has unlimited material behind it.
    Partial {
        /// The patch.
        patch: String,
    },
    /// Adds a solid to a partial model.
    AddSolid {
        /// The solid's patch.
        solid: String,
        /// The partial patch.
        to: String,
    },
    /// Takes the last command back.
    Undo {},
    /// Does the command undone last again.
    Redo {},
}

/// What a command did, besides changing the model.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Done {
    /// Which case an extrusion was.
    pub extrusion: Option<ExtrusionCase>,
    /// Vertices that a join made one with others.
    pub merged_vertices: usize,
    /// Edges that a join made of several.
    pub merged_edges: Vec<EdgeId>,
}

impl Command {
    /// Its name in scripts.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Wire { .. } => "wire",
            Self::Extrude { .. } => "extrude",
            Self::Create { .. } => "create",
            Self::Add { .. } => "add",
            Self::Punch { .. } => "punch",
            Self::Bend { .. } => "bend",
            Self::Sweep { .. } => "sweep",
            Self::Draw { .. } => "draw",
            Self::Round { .. } => "round",
            Self::Chamfer { .. } => "chamfer",
            Self::Join { .. } => "join",
            Self::Remove { .. } => "remove",
            Self::Partial { .. } => "partial",
            Self::AddSolid { .. } => "add_solid",
            Self::Undo {} => "undo",
            Self::Redo {} => "redo",
        }
    }
}
