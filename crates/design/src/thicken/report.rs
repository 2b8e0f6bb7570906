//! The report of a thickened sheet.

use mesh_kernel::{Group, TriMesh};
use serde::Serialize;
use sheet::thicken::{Origin, PlaceKind, Purged, Role, ThickenReport};

use super::thickness::patch_names;

/// What `toile thicken` reports; lengths in millimetres, whatever the file's unit.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ThickenFileReport {
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
    /// Thinnest wall, where both sides of a face are whole.
    pub min_wall: f64,
    /// Thickest wall.
    pub max_wall: f64,
    /// What was taken away.
    pub purged: Purged,
    /// Holes of the thickness faces that were filled.
    pub holes_filled: usize,
    /// Edges and nodes where parts only touched and were joined by a bead.
    pub beads: usize,
    /// Voids that were filled: nearer to the sheet than the depth.
    pub voids_filled: usize,
    /// Patches that were turned so that the sheet has one front.
    pub turned: Vec<String>,
    /// The whole command.
    pub seconds: f64,
    /// The file of the solid.
    pub file: String,
    /// The sheet.
    pub sheet: SheetFacts,
    /// Triangles of the solid by what they are.
    pub roles: Roles,
    /// Places that deserve a look.
    pub places: Vec<NamedPlace>,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// Where the time went, in the order of the work.
    pub step_seconds: Vec<StepSeconds>,
}

/// The sheet that was thickened.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct SheetFacts {
    /// Its file.
    pub file: String,
    /// Millimetres in one unit of its coordinates.
    pub unit_mm: f64,
    /// Triangles.
    pub faces: usize,
    /// Patches.
    pub patches: usize,
}

/// Triangles of a solid by their part, named as its groups.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct Roles {
    /// Walls on the front.
    pub front_wall: usize,
    /// Walls on the back.
    pub back_wall: usize,
    /// Strips along free edges.
    pub thickness_faces: usize,
    /// What closes holes.
    pub fills: usize,
    /// Outer sides of folds.
    pub corners: usize,
}

/// A place that deserves a look, its patches by name.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct NamedPlace {
    /// Why.
    pub kind: PlaceKind,
    /// About where, in the coordinates of the sheet's file.
    pub at: [f64; 3],
    /// Patches there.
    pub patches: Vec<String>,
    /// How many faces of the sheet.
    pub faces: usize,
}

/// How long a step took.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct StepSeconds {
    /// Its name.
    pub step: &'static str,
    /// By the wall's clock.
    pub seconds: f64,
}

impl ThickenFileReport {
    pub(super) fn new(
        sheet: &TriMesh,
        unit: f64,
        report: &ThickenReport,
        roles: Roles,
        warnings: Vec<String>,
    ) -> Self {
        let names = patch_names(sheet);
        let named = |patch: &u32| names.get(*patch as usize).cloned().unwrap_or_default();
        let places = report.places.iter().map(|place| NamedPlace {
            kind: place.kind,
            at: (place.at / unit).to_array(),
            patches: place.patches.iter().map(named).collect(),
            faces: place.faces,
        });
        Self {
            faces: report.faces,
            closed: report.closed,
            self_intersections: report.self_intersections,
            volume: report.volume,
            components: report.components,
            genus: report.genus,
            min_wall: report.min_wall,
            max_wall: report.max_wall,
            purged: report.purged,
            holes_filled: report.holes_filled,
            beads: report.beads,
            voids_filled: report.voids_filled,
            turned: report.turned.iter().map(named).collect(),
            seconds: 0.0,
            file: String::new(),
            sheet: SheetFacts {
                file: String::new(),
                unit_mm: unit,
                faces: sheet.faces.len(),
                patches: names.len(),
            },
            roles,
            places: places.collect(),
            warnings,
            step_seconds: Vec::new(),
        }
    }
}

/// All roles, in the order of the groups.
const ROLES: [Role; 5] = [Role::FrontWall, Role::BackWall, Role::ThicknessFace, Role::Fill, Role::Corner];

/// The solid with its faces in order of their roles, a group each, and how many there are of each.
pub(super) fn grouped_by_role(solid: TriMesh, origins: &[Origin]) -> (TriMesh, Roles) {
    let mut order: Vec<u32> = (0..solid.faces.len() as u32).collect();
    order.sort_by_key(|&f| origins[f as usize].role);
    let faces = order.iter().map(|&f| solid.faces[f as usize]).collect();
    let mut groups = Vec::new();
    let mut roles = Roles::default();
    let mut first = 0;
    for role in ROLES {
        let count = origins.iter().filter(|o| o.role == role).count();
        *match role {
            Role::FrontWall => &mut roles.front_wall,
            Role::BackWall => &mut roles.back_wall,
            Role::ThicknessFace => &mut roles.thickness_faces,
            Role::Fill => &mut roles.fills,
            Role::Corner => &mut roles.corners,
        } = count;
        if count > 0 {
            groups.push(Group { name: role.name().to_owned(), faces: first..first + count as u32 });
            first += count as u32;
        }
    }
    (TriMesh { positions: solid.positions, faces, groups, corner_uvs: None }, roles)
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_kernel::glam::DVec3;

    #[test]
    fn faces_are_grouped_by_role_and_keep_their_order_within() {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mesh = TriMesh::new(positions, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
        let roles = [Role::Corner, Role::BackWall, Role::Corner, Role::BackWall];
        let origins = roles.map(|role| Origin { role, patch: 0, face: 0 });
        let (mesh, counts) = grouped_by_role(mesh, &origins);
        assert_eq!(mesh.faces, [[0, 1, 3], [0, 3, 2], [0, 2, 1], [1, 2, 3]]);
        let groups: Vec<_> = mesh.groups.iter().map(|g| (g.name.as_str(), g.faces.clone())).collect();
        assert_eq!(groups, [("back_wall", 0..2), ("corners", 2..4)]);
        assert_eq!((counts.back_wall, counts.corners, counts.front_wall), (2, 2, 0));
    }
}
