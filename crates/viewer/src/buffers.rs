//! A scene's surfaces as graphics processors take them, with the light of [`render`](crate::render) as shader source.

use rayon::prelude::*;

use crate::color::Color;
use crate::normals::corner_normals;
use crate::scene::{Paint, Reverse, SceneMesh};

/// Three corners a face, nothing shared.
///
/// A corner is [`MeshBuffer::STRIDE`] bytes in the machine's byte order: position (three `f32`, mm), unit normal (three
/// `f32`), colour of the front and colour of the reverse (four bytes each, sRGB; the fourth is 255 where the colour means a
/// number, 0 on cloth).
#[derive(Clone, Debug, Default)]
pub struct MeshBuffer {
    /// The corners.
    pub bytes: Vec<u8>,
    /// How many there are.
    pub corners: usize,
}

impl MeshBuffer {
    /// Bytes a corner.
    pub const STRIDE: usize = 32;

    /// GLSL of `vec3 lit(vec3 albedo, vec3 normal, vec3 to_eye, vec3 key, vec3 fill, vec3 up, bool is_data)`: linear light
    /// of a surface, as pictures without soft shadows have it.
    pub const LIGHT: &'static str = "
vec3 lit(vec3 albedo, vec3 normal, vec3 to_eye, vec3 key, vec3 fill, vec3 up, bool is_data) {
    float sum = 0.74 * max((dot(normal, key) + 0.22) / 1.22, 0.0) + 0.14 * max(dot(normal, fill), 0.0)
        + 0.40 * (0.72 + 0.28 * dot(normal, up));
    if (is_data) {
        return albedo * (0.62 + 0.40 * sum);
    }
    return albedo * sum + 0.05 * pow(1.0 - clamp(dot(normal, to_eye), 0.0, 1.0), 4.0);
}
";

    /// The corners of meshes, one mesh after the other. Indices and colour counts must fit, as [`render`](crate::render)
    /// asks too; faces that refer to nodes that there are not are left out. O(faces).
    pub fn of(meshes: &[SceneMesh]) -> Self {
        let mut out = Self::default();
        for mesh in meshes {
            let normals = corner_normals(&mesh.positions, &mesh.faces, mesh.shading);
            let parts: Vec<Vec<u8>> = mesh
                .faces
                .par_chunks(4096)
                .enumerate()
                .map(|(chunk, faces)| {
                    let mut bytes = Vec::with_capacity(faces.len() * 3 * Self::STRIDE);
                    for (k, face) in faces.iter().enumerate() {
                        let f = chunk * 4096 + k;
                        for (corner, v) in face.iter().enumerate() {
                            let Some(p) = mesh.positions.get(*v as usize) else { continue };
                            let numbers = [p.as_vec3().to_array(), normals[f].corners[corner].to_array()];
                            bytes.extend(numbers.iter().flatten().flat_map(|x| x.to_ne_bytes()));
                            let (front, data) = color_of(mesh, f, *v as usize);
                            let reverse = match mesh.reverse {
                                Reverse::Same => front,
                                Reverse::Darker => front.dimmed(0.52),
                                Reverse::Colored(color) => color,
                            };
                            bytes
                                .extend([front, reverse].iter().flat_map(|c| [c.0[0], c.0[1], c.0[2], data]));
                        }
                    }
                    bytes
                })
                .collect();
            out.bytes.extend(parts.into_iter().flatten());
        }
        out.corners = out.bytes.len() / Self::STRIDE;
        out
    }
}

/// A corner's colour, and 255 where it means a number.
fn color_of(mesh: &SceneMesh, face: usize, node: usize) -> (Color, u8) {
    let valued = |value: Option<&f64>, scale: &crate::Scale| match value {
        Some(v) if !v.is_nan() => (scale.color(*v), 255),
        _ => (Color::NO_VALUE, 255),
    };
    match &mesh.paint {
        Paint::Solid(color) => (*color, 0),
        Paint::Faces(colors) => (colors.get(face).copied().unwrap_or(Color::NO_VALUE), 0),
        Paint::FaceValues { values, scale } => valued(values.get(face), scale),
        Paint::NodeValues { values, scale } => valued(values.get(node), scale),
    }
}

#[cfg(test)]
mod tests {
    use glam::DVec3;

    use super::*;

    #[test]
    fn corners_hold_places_normals_and_both_colours() {
        let corners = vec![DVec3::ZERO, DVec3::X, DVec3::Y];
        let mesh = SceneMesh::new(corners, vec![[0, 1, 2]], Color([200, 100, 50]));
        let buffer = MeshBuffer::of(&[mesh.clone(), mesh]);
        assert_eq!((buffer.corners, buffer.bytes.len()), (6, 6 * MeshBuffer::STRIDE));
        let second = &buffer.bytes[MeshBuffer::STRIDE..2 * MeshBuffer::STRIDE];
        let number = |k: usize| f32::from_ne_bytes(second[4 * k..4 * k + 4].try_into().unwrap());
        assert_eq!([0, 1, 2, 3, 4, 5].map(number), [1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        assert_eq!(second[24..28], [200, 100, 50, 0]);
        assert!(second[28] < 200 && second[28] > 100, "the inside is darker");
    }
}
