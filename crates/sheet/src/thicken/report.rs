//! What came of thickening.

use glam::DVec3;
use serde::Serialize;

/// What part of a thickened sheet a face is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Role {
    /// The wall on the front of a patch.
    FrontWall,
    /// The wall on the back of a patch.
    BackWall,
    /// The strip along a free edge.
    ThicknessFace,
    /// What closes a hole in the thickness faces.
    Fill,
    /// The outer side of a fold or corner.
    Corner,
}

impl Role {
    /// The name of the group of faces with this role.
    pub fn name(self) -> &'static str {
        match self {
            Self::FrontWall => "front_wall",
            Self::BackWall => "back_wall",
            Self::ThicknessFace => "thickness_faces",
            Self::Fill => "fills",
            Self::Corner => "corners",
        }
    }
}

/// What a face of the solid came from.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub struct Origin {
    /// Its part.
    pub role: Role,
    /// The patch that it belongs to.
    pub patch: u32,
    /// The sheet's face (walls), a face at the edge (thickness faces, corners) or at the node (fills).
    pub face: u32,
}

/// What a place is reported for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum PlaceKind {
    /// The sheet bends more tightly than the offset: the wall on its inner side is cut short.
    TightCurvature,
    /// Sheets nearer than the thickness have grown together.
    Merged,
    /// A mitre longer than the limit was made an arc.
    MitreLimit,
}

/// A place that deserves a look.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct Place {
    /// Why.
    pub kind: PlaceKind,
    /// About where, in millimetres.
    pub at: DVec3,
    /// Patches there.
    pub patches: Vec<u32>,
    /// How many faces of the sheet.
    pub faces: usize,
}

/// Entities taken away (Lee & Kim 2001, fig. 12).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Purged {
    /// Faces with the same region on both sides.
    pub laminar: usize,
    /// Faces between two regions of material.
    pub screen: usize,
    /// Edges left without faces.
    pub wire: usize,
    /// Edges within one face that join two of its loops.
    pub isthmus: usize,
    /// Edges that end within a face.
    pub strut: usize,
    /// Edges between faces in one plane, and nodes on straight edges.
    pub redundant: usize,
}

/// Counts and measures of a thickened sheet; lengths in millimetres.
#[derive(Clone, Debug, Default, PartialEq, Serialize)]
pub struct ThickenReport {
    /// Triangles of the solid.
    pub faces: usize,
    /// Whether every edge has two faces.
    pub closed: bool,
    /// Pairs of faces that cross.
    pub self_intersections: usize,
    /// Volume in mm³.
    pub volume: f64,
    /// Connected solids.
    pub components: usize,
    /// Handles of all of them.
    pub genus: usize,
    /// Thinnest wall, of the faces whose two sides are whole; zero where there is none.
    pub min_wall: f64,
    /// Thickest wall; see [`ThickenReport::min_wall`].
    pub max_wall: f64,
    /// What was taken away.
    pub purged: Purged,
    /// Holes of the thickness faces that were filled.
    pub holes_filled: usize,
    /// Edges and nodes where parts only touched and were joined by a bead.
    pub beads: usize,
    /// Voids that were filled: nearer to the sheet than the depth, left where it bends more tightly than that.
    pub voids_filled: usize,
    /// Patches with faces that were turned so that the sheet has one front; one-sided thickening only.
    pub turned: Vec<u32>,
    /// Places that deserve a look.
    pub places: Vec<Place>,
}
