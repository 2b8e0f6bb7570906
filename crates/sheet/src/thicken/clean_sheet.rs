//! The sheet that is thickened: nodes in one place are one node, faces without an area and doubles are gone, and every
//! corner knows its thickness.

use glam::DVec3;
use mesh_kernel::TriMesh;

use super::{MAX_THICKNESS, ThickenError, ThickenOptions, Thickness};
use crate::cleaning::{FLAT, doubles, patch_of_faces, weld};

/// A sheet without coincident nodes and without faces that have no area or come twice.
#[derive(Debug)]
pub(super) struct CleanSheet {
    pub(super) positions: Vec<DVec3>,
    pub(super) faces: Vec<[u32; 3]>,
    /// Unit normals of the faces.
    pub(super) normals: Vec<DVec3>,
    /// Patch (group of the input) of every face.
    pub(super) patches: Vec<u32>,
    /// Face of the input.
    pub(super) sources: Vec<u32>,
    /// Full thickness at every corner, in millimetres.
    pub(super) thickness: Vec<[f64; 3]>,
}

impl CleanSheet {
    /// Cleans a sheet and gives every corner its thickness. O(n log n).
    pub(super) fn new(sheet: &TriMesh, options: &ThickenOptions) -> Result<Self, ThickenError> {
        if let Some(node) = sheet.positions.iter().position(|p| !p.is_finite()) {
            return Err(ThickenError::NotFinite { node: node as u32 });
        }
        let size = sheet.bounds().map_or(0.0, |[lo, hi]| (hi - lo).length());
        let patches = patch_of_faces(sheet);
        check_thickness(sheet, &patches, &options.thickness, size)?;
        let (positions, node) = weld(&sheet.positions);
        let mut clean = Self {
            positions,
            faces: Vec::with_capacity(sheet.faces.len()),
            normals: Vec::with_capacity(sheet.faces.len()),
            patches: Vec::with_capacity(sheet.faces.len()),
            sources: Vec::with_capacity(sheet.faces.len()),
            thickness: Vec::with_capacity(sheet.faces.len()),
        };
        let doubled = doubles(sheet, &node);
        for (f, corners) in sheet.faces.iter().enumerate() {
            let normal = sheet.area_normal(f as u32);
            let [a, b, c] = sheet.corners(f as u32);
            let longest =
                (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
            if doubled[f]
                || normal.length().partial_cmp(&(FLAT * longest)) != Some(std::cmp::Ordering::Greater)
            {
                continue;
            }
            clean.faces.push(corners.map(|v| node[v as usize]));
            clean.normals.push(normal.normalize());
            clean.patches.push(patches[f]);
            clean.sources.push(f as u32);
            clean.thickness.push(match &options.thickness {
                Thickness::Constant(t) => [*t; 3],
                Thickness::PerPatch(t) => [t[patches[f] as usize]; 3],
                Thickness::PerNode(t) => corners.map(|v| t[v as usize]),
            });
        }
        if clean.faces.is_empty() { Err(ThickenError::Empty) } else { Ok(clean) }
    }

    /// Refuses faces that are thinner than `least` all over, in millimetres: nothing of them would be left.
    pub(super) fn check_thinnest(&self, least: f64) -> Result<(), ThickenError> {
        let thickest = |t: &[f64; 3]| t.iter().copied().fold(0.0, f64::max);
        match self.thickness.iter().position(|t| thickest(t) < least) {
            Some(f) => Err(ThickenError::ThicknessTooSmall {
                value: thickest(&self.thickness[f]),
                least,
                patch: self.patches[f],
            }),
            None => Ok(()),
        }
    }

    /// The three corners of face `f`.
    pub(super) fn corners(&self, f: usize) -> [DVec3; 3] {
        self.faces[f].map(|v| self.positions[v as usize])
    }

    /// The face that a face of the input became; `None` where it was left out.
    pub(super) fn face_of_source(&self, source: u32) -> Option<usize> {
        self.sources.binary_search(&source).ok()
    }

    /// The patches of some faces, ascending, each once.
    pub(super) fn patches_of(&self, faces: impl IntoIterator<Item = usize>) -> Vec<u32> {
        let mut patches: Vec<u32> = faces.into_iter().map(|f| self.patches[f]).collect();
        patches.sort_unstable();
        patches.dedup();
        patches
    }
}

fn check_thickness(
    sheet: &TriMesh,
    patches: &[u32],
    thickness: &Thickness,
    size: f64,
) -> Result<(), ThickenError> {
    let (given, of, expected) = match thickness {
        Thickness::Constant(t) => (std::slice::from_ref(t), "", 1),
        Thickness::PerPatch(t) => {
            let last = patches.iter().max().map_or(0, |&p| p as usize + 1);
            (t.as_slice(), "patches", last.max(sheet.groups.len()))
        }
        Thickness::PerNode(t) => (t.as_slice(), "nodes", sheet.positions.len()),
    };
    if given.len() != expected {
        return Err(ThickenError::ThicknessCount { of, expected, given: given.len() });
    }
    for (i, &value) in given.iter().enumerate() {
        if !(value.is_finite() && value > 0.0) {
            let index = (!matches!(thickness, Thickness::Constant(_))).then_some(i);
            return Err(ThickenError::ThicknessNotPositive { value, index });
        }
        if value > MAX_THICKNESS * size && size > 0.0 {
            return Err(ThickenError::ThicknessTooLarge { value, size });
        }
    }
    Ok(())
}
