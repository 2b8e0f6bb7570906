//! What the numbers of a file mean, when it does not say.

use mesh_kernel::TriMesh;
use mesh_kernel::files::Format;

/// Millimetres in one unit of a body or a garment: in metres these are a few units large, in centimetres some hundred, in
/// millimetres thousands.
pub fn guess_of_model(model: &TriMesh) -> f64 {
    match extent(model) {
        e if e < METRES_BELOW => 1000.0,
        e if e < 400.0 => 10.0,
        _ => 1.0,
    }
}

/// What one unit of a file's coordinates is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FileUnit {
    /// Its millimetres.
    pub millimetres: f64,
    /// Whether this is only told from the size of what the file holds.
    pub guessed: bool,
}

impl FileUnit {
    /// Millimetres in one unit as `said`, or as the format has it: metres in GLB, else millimetres; `None` for files that
    /// this program alone writes.
    pub fn of_format(said: Option<f64>, format: Option<Format>) -> Self {
        let of_format = if format == Some(Format::Glb) { 1000.0 } else { 1.0 };
        Self { millimetres: said.unwrap_or(of_format), guessed: false }
    }

    /// The same for a sheet that is to become `thickness` millimetres thick.
    ///
    /// Parts are small: a bracket of 80 units is one of 80 mm, where a garment of 80 units would be one of 80 cm. So a sheet
    /// is in millimetres, unless it is a few units large and nothing of that size in millimetres could be so thick: then it
    /// is in metres.
    pub fn of_sheet(said: Option<f64>, format: Option<Format>, sheet: &TriMesh, thickness: f64) -> Self {
        Self::of_small(said, format, sheet, THINNEST_SHEET * thickness)
    }

    /// The same for a mesh of which pattern pieces are to be made: no piece is cut that is only a few millimetres large.
    pub fn of_pieces(said: Option<f64>, format: Option<Format>, mesh: &TriMesh) -> Self {
        Self::of_small(said, format, mesh, f64::INFINITY)
    }

    /// Metres where the model is a few units large and less than `least`.
    fn of_small(said: Option<f64>, format: Option<Format>, model: &TriMesh, least: f64) -> Self {
        let says_nothing = said.is_none() && format.is_some_and(|f| f != Format::Glb);
        if says_nothing && extent(model) < METRES_BELOW.min(least) {
            return Self { millimetres: 1000.0, guessed: true };
        }
        Self::of_format(said, format)
    }

    /// What the user should know about it.
    pub fn warning(self) -> Option<String> {
        self.guessed.then(|| {
            "the file does not say its unit and is taken to be in metres, as garments are; --unit says otherwise"
                .to_owned()
        })
    }
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
        let of = |size: f64, thickness: f64| {
            FileUnit::of_sheet(None, Some(Format::Obj), &triangle(size), thickness).millimetres
        };
        assert_eq!(of(80.0, 2.0), 1.0);
        assert_eq!(of(1.2, 1.0), 1000.0);
        assert_eq!(of(1.0, 0.05), 1.0, "a small sheet, thin enough to be meant");
    }

    #[test]
    fn pieces_are_larger_than_a_few_millimetres() {
        let of = |said, format, size: f64| FileUnit::of_pieces(said, format, &triangle(size));
        let guessed = of(None, Some(Format::Obj), 1.2);
        assert_eq!((guessed.millimetres, guessed.guessed), (1000.0, true));
        assert!(guessed.warning().is_some_and(|w| w.contains("metres")));
        for (said, format, size, millimetres) in [
            (None, Some(Format::Obj), 60.0, 1.0),
            (None, Some(Format::Glb), 0.06, 1000.0),
            (None, Some(Format::Glb), 60.0, 1000.0),
            (Some(1.0), Some(Format::Glb), 1.2, 1.0),
            (Some(25.4), Some(Format::Obj), 1.2, 25.4),
            (None, None, 1.2, 1.0),
        ] {
            let unit = of(said, format, size);
            assert_eq!(unit, FileUnit { millimetres, guessed: false }, "{said:?} {format:?} {size}");
            assert_eq!(unit.warning(), None);
        }
    }
}
