//! What can be wrong with a wish for a picture.

/// Why a picture cannot be made.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
pub enum RenderError {
    /// Width or height is zero or too large.
    #[error(
        "a picture of {width} x {height} pixels is not possible: each side must be 1 to {max_side} pixels and all \
         pixels together at most {max_pixels} million"
    )]
    Size {
        /// Width asked for, in pixels.
        width: u32,
        /// Height asked for, in pixels.
        height: u32,
        /// Largest side, in pixels.
        max_side: u32,
        /// Largest number of pixels, in millions.
        max_pixels: u32,
    },
    /// Nothing to see.
    #[error("there is nothing to draw: the scene has no faces, lines or points")]
    Empty,
    /// A coordinate that is no number or too large to be drawn.
    #[error(
        "{what} {index} has a coordinate that is not a number or beyond ±{limit:e} mm; mend the model first",
        limit = mesh_kernel::MAX_COORDINATE
    )]
    Coordinate {
        /// What the coordinate belongs to, such as "node of mesh 0".
        what: String,
        /// Its index there, from 0.
        index: usize,
    },
    /// A face names a node that is not there.
    #[error("face {face} of mesh {mesh} names node {node}, but there are only {nodes} nodes")]
    Index {
        /// Index of the mesh in the scene.
        mesh: usize,
        /// Index of the face.
        face: usize,
        /// The node that it names.
        node: u32,
        /// Number of nodes of the mesh.
        nodes: usize,
    },
    /// Colours or numbers do not match the mesh.
    #[error("mesh {mesh} has {wanted} {of} but {got} colour values")]
    PaintCount {
        /// Index of the mesh in the scene.
        mesh: usize,
        /// "faces" or "nodes".
        of: &'static str,
        /// How many there are.
        wanted: usize,
        /// How many values were given.
        got: usize,
    },
    /// An option outside its range.
    #[error("{option} = {value} is not possible: {range}")]
    Option {
        /// Name of the option.
        option: &'static str,
        /// Its value.
        value: f64,
        /// What is possible.
        range: &'static str,
    },
}

/// Largest side of a picture, in pixels.
pub const MAX_SIDE: u32 = 16_384;
/// Most pixels of a picture, in millions: 64 MPx need some 2 GB while drawing.
pub const MAX_MEGAPIXELS: u32 = 64;

/// Checks a picture's size.
pub(crate) fn check_size(width: u32, height: u32) -> Result<(), RenderError> {
    let pixels = u64::from(width) * u64::from(height);
    if width == 0
        || height == 0
        || width > MAX_SIDE
        || height > MAX_SIDE
        || pixels > u64::from(MAX_MEGAPIXELS) * 1_000_000
    {
        return Err(RenderError::Size { width, height, max_side: MAX_SIDE, max_pixels: MAX_MEGAPIXELS });
    }
    Ok(())
}
