//! The reference mesh as the garment meets it: distance with sign, and outward directions smooth enough to push along.

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::SignedDistance;

/// Rounds of neighbour averaging of the mesh's normals: on bodies of some 10 mm edge length this smooths over about
/// 30 mm, more than nipples and fingers' breadths of noise, less than the turn of a shoulder.
const NORMAL_ROUNDS: usize = 6;

/// A body prepared for queries.
pub(crate) struct Skin<'m> {
    mesh: &'m TriMesh,
    distance: SignedDistance,
    normals: Vec<DVec3>,
}

/// The body as seen from one place.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Sight {
    /// Signed distance, mm, negative inside.
    pub(crate) distance: f64,
    /// Nearest place of the skin.
    pub(crate) point: DVec3,
    /// Smoothed outward normal there, unit.
    pub(crate) normal: DVec3,
}

impl<'m> Skin<'m> {
    pub(crate) fn new(mesh: &'m TriMesh) -> Self {
        Self { mesh, distance: SignedDistance::new(mesh), normals: smooth_normals(mesh) }
    }

    /// What lies nearest to `p`.
    pub(crate) fn look(&self, p: DVec3) -> Sight {
        let signed = self.distance.signed(p);
        let corners = self.mesh.corners(signed.face);
        let weights = barycentric(corners, signed.point);
        let ids = self.mesh.faces[signed.face as usize];
        let smooth: DVec3 = ids.iter().zip(weights).map(|(v, w)| w * self.normals[*v as usize]).sum();
        let normal = smooth.try_normalize().unwrap_or(signed.normal);
        Sight { distance: signed.distance, point: signed.point, normal }
    }

    /// Signed distance only, mm.
    pub(crate) fn signed(&self, p: DVec3) -> f64 {
        self.distance.signed(p).distance
    }
}

fn barycentric([a, b, c]: [DVec3; 3], p: DVec3) -> [f64; 3] {
    let (u, v, w) = (b - a, c - a, p - a);
    let (uu, uv, vv, wu, wv) = (u.dot(u), u.dot(v), v.dot(v), w.dot(u), w.dot(v));
    let det = uu * vv - uv * uv;
    if det <= 0.0 {
        return [1.0 / 3.0; 3];
    }
    let s = (wu * vv - wv * uv) / det;
    let t = (wv * uu - wu * uv) / det;
    [1.0 - s - t, s, t]
}

fn smooth_normals(mesh: &TriMesh) -> Vec<DVec3> {
    let mut normals = mesh.node_normals();
    let mut sums = normals.clone();
    for _ in 0..NORMAL_ROUNDS {
        sums.iter_mut().zip(&normals).for_each(|(s, n)| *s = *n);
        for f in &mesh.faces {
            let all: DVec3 = f.iter().map(|v| normals[*v as usize]).sum();
            f.iter().for_each(|v| sums[*v as usize] += all);
        }
        normals.iter_mut().zip(&sums).for_each(|(n, s)| *n = s.normalize_or_zero());
    }
    normals
}
