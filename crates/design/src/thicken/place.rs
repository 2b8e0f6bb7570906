//! Coordinates of the solid as its file can hold them.

use mesh_kernel::TriMesh;
use mesh_kernel::files::Format;
use mesh_kernel::merge::{MergeError, MergeOptions, Solid, snapped_to_singles, solid_of_chain};

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
