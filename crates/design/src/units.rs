//! What the numbers of a file mean, when it does not say.

use mesh_kernel::TriMesh;

/// Millimetres in one unit of a body or a garment: in metres these are a few units large, in centimetres some hundred, in
/// millimetres thousands.
pub fn guess_of_model(model: &TriMesh) -> f64 {
    match extent(model) {
        e if e < METRES_BELOW => 1000.0,
        e if e < 400.0 => 10.0,
        _ => 1.0,
    }
}

/// Millimetres in one unit of a sheet that is to become `thickness` millimetres thick.
///
/// Parts are small: a bracket of 80 units is one of 80 mm, where a garment of 80 units would be one of 80 cm. So a sheet
/// is in millimetres, unless it is a few units large and nothing of that size in millimetres could be so thick: then it is
/// in metres.
pub fn guess_of_sheet(sheet: &TriMesh, thickness: f64) -> f64 {
    let extent = extent(sheet);
    if extent < METRES_BELOW && extent < THINNEST_SHEET * thickness { 1000.0 } else { 1.0 }
}

/// Nothing that is worn or printed is larger than this many metres.
const METRES_BELOW: f64 = 4.0;

/// A sheet is larger than this many times its thickness.
const THINNEST_SHEET: f64 = 10.0;

fn extent(mesh: &TriMesh) -> f64 {
    mesh.bounds().map_or(0.0, |[low, high]| (high - low).max_element())
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_kernel::glam::DVec3;

    fn triangle(size: f64) -> TriMesh {
        TriMesh::new(vec![DVec3::ZERO, DVec3::X * size, DVec3::Y * size], vec![[0, 1, 2]])
    }

    #[test]
    fn a_body_is_told_by_its_height() {
        assert_eq!([1.7, 170.0, 1700.0].map(|h| guess_of_model(&triangle(h))), [1000.0, 10.0, 1.0]);
    }

    #[test]
    fn a_part_is_in_millimetres_and_a_garment_in_metres() {
        assert_eq!(guess_of_sheet(&triangle(80.0), 2.0), 1.0);
        assert_eq!(guess_of_sheet(&triangle(1.2), 1.0), 1000.0);
        assert_eq!(guess_of_sheet(&triangle(1.0), 0.05), 1.0, "a small sheet, thin enough to be meant");
    }
}
