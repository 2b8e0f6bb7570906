//! Normals for shading: smooth over gentle edges, sharp over creases.

use glam::{DVec3, Vec3};
use rayon::prelude::*;

use crate::scene::Shading;

/// A face's normals; all unit vectors, or zero for a face without area.
#[derive(Clone, Copy, Debug)]
pub(crate) struct CornerNormals {
    /// The face's own.
    pub(crate) flat: Vec3,
    /// What light sees at its corners.
    pub(crate) corners: [Vec3; 3],
}

/// Unit normals at the three corners of every face. Smooth shading takes, at every corner, the faces around the node
/// whose normals are within the crease angle of the face's own, weighted by area. Degenerate faces get a zero
/// normal. O(sum of squared node degrees).
pub(crate) fn corner_normals(
    positions: &[DVec3],
    faces: &[[u32; 3]],
    shading: Shading,
) -> Vec<CornerNormals> {
    let face_normals: Vec<(Vec3, f32)> = faces
        .par_iter()
        .map(|f| {
            let [a, b, c] = f.map(|v| positions[v as usize]);
            let n = (b - a).cross(c - a);
            let area = n.length();
            (if area > 0.0 { (n / area).as_vec3() } else { Vec3::ZERO }, area as f32)
        })
        .collect();
    let Shading::Smooth { crease } = shading else {
        return face_normals
            .into_iter()
            .map(|(flat, _)| CornerNormals { flat, corners: [flat; 3] })
            .collect();
    };
    let least = crease.clamp(0.0, std::f64::consts::PI).cos() as f32;

    // Faces around each node, in face order.
    let mut starts = vec![0u32; positions.len() + 1];
    for v in faces.iter().flatten() {
        starts[*v as usize + 1] += 1;
    }
    for i in 1..starts.len() {
        starts[i] += starts[i - 1];
    }
    let mut next = starts.clone();
    let mut around = vec![0u32; faces.len() * 3];
    for (f, face) in faces.iter().enumerate() {
        for v in face {
            around[next[*v as usize] as usize] = f as u32;
            next[*v as usize] += 1;
        }
    }

    faces
        .par_iter()
        .zip(&face_normals)
        .map(|(face, (own, _))| {
            let corners = face.map(|v| {
                let range = starts[v as usize] as usize..starts[v as usize + 1] as usize;
                let sum: Vec3 = around[range]
                    .iter()
                    .map(|g| face_normals[*g as usize])
                    .filter(|(n, _)| n.dot(*own) >= least)
                    .map(|(n, area)| n * area)
                    .sum();
                let smooth = sum.normalize_or_zero();
                if smooth == Vec3::ZERO { *own } else { smooth }
            });
            CornerNormals { flat: *own, corners }
        })
        .collect()
}
