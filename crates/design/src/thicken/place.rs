//! Coordinates of the solid as its file can hold them.

use std::collections::BTreeMap;

use mesh_kernel::TriMesh;
use mesh_kernel::files::Format;
use mesh_kernel::merge::{MergeError, MergeOptions, Solid, snapped_to_singles, solid_of_chain};
use sheet::thicken::{Origin, Role, ThickenReport, Thickened};

/// The file that a solid goes to.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Target {
    /// Millimetres in one unit of the sheet's file.
    pub(super) unit: f64,
    /// Its format.
    pub(super) format: Format,
}

impl Target {
    /// Millimetres in one unit of the mesh that is handed to the writer. GLB is in metres and has its scale from the
    /// writer.
    pub(super) fn unit_of_file(self) -> f64 {
        if self.format == Format::Glb { 1.0 } else { self.unit }
    }

    /// How far apart two numbers of the file are, in millimetres, where coordinates are the size of `far` millimetres.
    pub(super) fn step(self, far: f64) -> f64 {
        let unit = if self.format == Format::Glb { 1000.0 } else { self.unit };
        let far = far / unit;
        unit * if self.holds_singles() {
            f64::from((far as f32).next_up()) - f64::from(far as f32)
        } else {
            far.next_up() - far
        }
    }

    /// Whether its numbers have seven digits.
    pub(super) fn holds_singles(self) -> bool {
        matches!(self.format, Format::Stl | Format::Glb)
    }
}

/// A solid in millimetres as its file holds it, and the face that each of its faces was part of; `None` where they are
/// the same.
///
/// Rounding moves nodes, and faces that were a hair apart might cross: where coordinates cannot be handed out as they
/// are, the solid is made anew on a grid that the file can hold. Text and PLY in millimetres hold what the solid has.
pub(super) fn in_file(
    solid: &TriMesh,
    target: Target,
    options: &MergeOptions<'_>,
) -> Result<(TriMesh, Option<Vec<u32>>), MergeError> {
    let unit = target.unit_of_file();
    let placed: Solid = match target.format {
        Format::Stl => snapped_to_singles(&scaled(solid, 1.0 / unit), 1.0, options)?,
        Format::Glb => snapped_to_singles(solid, 1e-3, options)?,
        Format::Obj | Format::Ply | Format::Off if unit == 1.0 => return Ok((solid.clone(), None)),
        Format::Obj | Format::Ply | Format::Off => solid_of_chain(&scaled(solid, 1.0 / unit), options)?,
    };
    Ok((placed.mesh, Some(placed.parents)))
}

/// Why a solid is not the same in the coordinates of its file. Lengths in millimetres.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[error(
    "the numbers of the file are {} mm apart at {} mm from the origin, too coarse for {}: {what}; thicken more, or move \
     the sheet nearer to the origin{}",
    three_digits(*step),
    three_digits(*far),
    if *wall > 0.0 { format!("walls of {} mm", three_digits(*wall)) } else { "its walls".to_owned() },
    if *singles { ", or write OBJ, PLY or OFF, which hold finer numbers than STL and GLB" } else { "" }
)]
pub struct Lost {
    /// What is wrong with it.
    pub what: &'static str,
    /// The thinnest wall; 0 where none is whole.
    pub wall: f64,
    /// How far apart two numbers of the file are there.
    pub step: f64,
    /// The largest coordinate.
    pub far: f64,
    /// Whether the numbers have seven digits.
    pub singles: bool,
}

/// A number for a message.
fn three_digits(x: f64) -> String {
    let rounded: f64 = format!("{x:.2e}").parse().unwrap_or(x);
    rounded.to_string()
}

/// A share of the volume that rounding may take or add.
const SHARE: f64 = 0.05;

/// Whether a solid, placed and measured as its file holds it, is still what was made; its faces were part of `parents`.
pub(super) fn check(
    made: &Thickened,
    placed: &TriMesh,
    measured: &ThickenReport,
    parents: &[u32],
    target: Target,
) -> Result<(), Lost> {
    // The walls' area of every patch, in the unit of the mesh.
    let walls = |mesh: &TriMesh, origin: &dyn Fn(usize) -> Origin| -> BTreeMap<u32, f64> {
        let mut areas = BTreeMap::new();
        for f in 0..mesh.faces.len() {
            let Origin { role, patch, .. } = origin(f);
            if matches!(role, Role::FrontWall | Role::BackWall) {
                *areas.entry(patch).or_default() += mesh.area_normal(f as u32).length();
            }
        }
        areas
    };
    let was = walls(&made.solid, &|f| made.origins[f]);
    let is = walls(placed, &|f| made.origins[parents[f] as usize]);
    let half = 0.5 / target.unit_of_file().powi(2);
    let is_lost = |(patch, area): (&u32, &f64)| is.get(patch).copied().unwrap_or(0.0) < half * area;
    let (before, now) = (&made.report, measured);
    let what = if parents.is_empty() {
        "nothing would be left"
    } else if !now.closed {
        "it would not be closed"
    } else if now.components > before.components {
        "walls would fall to pieces"
    } else if made.lost_parts(parents) > 0 {
        "a part of it would be missing"
    } else if was.iter().any(is_lost) {
        "a patch of the sheet would be missing"
    } else if (now.volume - before.volume).abs() > SHARE * before.volume {
        "its volume would be another"
    } else {
        return Ok(());
    };
    let positions = &made.solid.positions;
    let far = positions.iter().fold(0.0f64, |m, p| m.max(p.abs().max_element()));
    Err(Lost { what, wall: before.min_wall, step: target.step(far), far, singles: target.holds_singles() })
}

fn scaled(mesh: &TriMesh, factor: f64) -> TriMesh {
    let mut mesh = mesh.clone();
    mesh.positions.iter_mut().for_each(|p| *p *= factor);
    mesh
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_kernel::glam::DVec3;

    fn tetrahedron() -> TriMesh {
        let positions = vec![DVec3::ZERO, DVec3::X * 10.1, DVec3::Y * 10.3, DVec3::Z * 10.7];
        TriMesh::new(positions, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]])
    }

    #[test]
    fn coordinates_are_what_the_format_can_hold() {
        let place = |format, unit| in_file(&tetrahedron(), Target { unit, format }, &MergeOptions::default());
        let (same, parents) = place(Format::Obj, 1.0).unwrap();
        assert_eq!((same, parents), (tetrahedron(), None));
        let (stl, parents) = place(Format::Stl, 1.0).unwrap();
        assert!(stl.positions.iter().all(|p| p.as_vec3().as_dvec3() == *p));
        assert_eq!(parents.unwrap().len(), 4);
        // A writer multiplies with 1e-3, and single-precision numbers must come of it.
        let (glb, _) = place(Format::Glb, 1000.0).unwrap();
        let rounding = |p: &DVec3| ((*p * 1e-3) - (*p * 1e-3).as_vec3().as_dvec3()).length();
        assert!(glb.positions.iter().all(|p| rounding(p) < 1e-17));
        let (metres, _) = place(Format::Obj, 1000.0).unwrap();
        assert!((metres.bounds().unwrap()[1] - DVec3::new(0.0101, 0.0103, 0.0107)).length() < 1e-12);
    }
}
