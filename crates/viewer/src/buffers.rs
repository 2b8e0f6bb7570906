//! A scene's surfaces as graphics processors take them, with the light of [`render`](crate::render) as shader source.

use rayon::prelude::*;

use crate::color::Color;
use crate::normals::corner_normals;
use crate::scene::{Paint, Reverse, SceneMesh};

/// Corners and faces that refer to them. Faces about a node share a corner where they share its normal and colours: what
/// is smooth and of one colour has about one corner a node, a sixth of three a face.
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
    /// Three corners a face.
    pub indices: Vec<u32>,
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
            out.share(mesh, &parts.concat());
        }
        out.corners = out.bytes.len() / Self::STRIDE;
        out
    }

    /// Takes a mesh's corners, three a face, each once.
    fn share(&mut self, mesh: &SceneMesh, corners: &[u8]) {
        const NONE: u32 = u32::MAX;
        let start = self.bytes.len() / Self::STRIDE;
        // The corners at a node as a list: the newest, and from each the one before it.
        let mut newest = vec![NONE; mesh.positions.len()];
        let mut before: Vec<u32> = Vec::new();
        let nodes = mesh.faces.iter().flatten().filter(|v| (**v as usize) < newest.len());
        let nodes: Vec<usize> = nodes.map(|v| *v as usize).collect();
        for (corner, v) in corners.chunks_exact(Self::STRIDE).zip(nodes) {
            let mut at = newest[v];
            while at != NONE {
                let from = (start + at as usize) * Self::STRIDE;
                if self.bytes[from..from + Self::STRIDE] == *corner {
                    break;
                }
                at = before[at as usize];
            }
            if at == NONE {
                at = before.len() as u32;
                before.push(newest[v]);
                newest[v] = at;
                self.bytes.extend_from_slice(corner);
            }
            self.indices.push(start as u32 + at);
        }
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
        assert_eq!(buffer.indices, [0, 1, 2, 3, 4, 5]);
        assert_eq!((buffer.corners, buffer.bytes.len()), (6, 6 * MeshBuffer::STRIDE));
        let second = &buffer.bytes[MeshBuffer::STRIDE..2 * MeshBuffer::STRIDE];
        let number = |k: usize| f32::from_ne_bytes(second[4 * k..4 * k + 4].try_into().unwrap());
        assert_eq!([0, 1, 2, 3, 4, 5].map(number), [1.0, 0.0, 0.0, 0.0, 0.0, 1.0]);
        assert_eq!(second[24..28], [200, 100, 50, 0]);
        assert!(second[28] < 200 && second[28] > 100, "the inside is darker");
    }

    #[test]
    fn what_is_smooth_shares_corners_and_creases_do_not() {
        let square = [DVec3::ZERO, DVec3::X, DVec3::X + DVec3::Y, DVec3::Y];
        let mut mesh = SceneMesh::new(square.to_vec(), vec![[0, 1, 2], [0, 2, 3]], Color::WHITE);
        assert_eq!(MeshBuffer::of(&[mesh.clone()]).corners, 4);
        // Folded by a right angle along the diagonal, nothing is shared.
        mesh.positions[3] = DVec3::new(0.5, 0.5, 0.7);
        assert_eq!(MeshBuffer::of(&[mesh]).corners, 6);
    }
}
