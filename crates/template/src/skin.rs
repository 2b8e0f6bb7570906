//! The reference mesh as the garment meets it: distance with sign, and outward directions smooth enough to push along.

use std::sync::{Arc, OnceLock};

use glam::DVec3;
use mesh_kernel::TriMesh;
use mesh_kernel::query::{Crossings, SignedDistance};

/// Rounds of neighbour averaging of the mesh's normals: on bodies of some 10 mm edge length this smooths over about
/// 30 mm, more than nipples and fingers' breadths of noise, less than the turn of a shoulder.
const NORMAL_ROUNDS: usize = 6;

/// Search structures on a body, for those who place nodes or build garments on it again and again. Cheap to clone.
#[derive(Clone, Debug)]
pub struct Prepared {
    distance: Arc<SignedDistance>,
    normals: Arc<Vec<DVec3>>,
    /// Made when the first garment asks: previews never do.
    crossings: Arc<OnceLock<Crossings>>,
}

impl Prepared {
    /// Prepares a body's mesh. O(n log n).
    pub fn new(mesh: &TriMesh) -> Self {
        let (distance, normals) = rayon::join(|| SignedDistance::new(mesh), || smooth_normals(mesh));
        Self { distance: Arc::new(distance), normals: Arc::new(normals), crossings: Arc::default() }
    }

    /// The same for a body of the same faces whose nodes have moved a little, as [`SignedDistance::moved`] can. O(n).
    pub fn moved(&self, mesh: &TriMesh) -> Option<Self> {
        let (distance, normals) = rayon::join(|| self.distance.moved(mesh), || smooth_normals(mesh));
        Some(Self { distance: Arc::new(distance?), normals: Arc::new(normals), crossings: Arc::default() })
    }

    /// Distance of a place to the body's skin, mm, negative inside. About O(log n).
    pub fn distance(&self, p: DVec3) -> f64 {
        self.distance.signed(p).distance
    }

    /// Crossings of faces with those of `mesh`, which must be the one that was prepared.
    pub(crate) fn crossings(&self, mesh: &TriMesh) -> &Crossings {
        self.crossings.get_or_init(|| Crossings::new(mesh))
    }
}

/// A body with what it was prepared for.
pub(crate) struct Skin<'m> {
    mesh: &'m TriMesh,
    prepared: &'m Prepared,
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
    /// `prepared` must be of the same mesh.
    pub(crate) fn new(mesh: &'m TriMesh, prepared: &'m Prepared) -> Self {
        Self { mesh, prepared }
    }

    /// What lies nearest to `p`.
    pub(crate) fn look(&self, p: DVec3) -> Sight {
        let signed = self.prepared.distance.signed(p);
        let corners = self.mesh.corners(signed.face);
        let weights = barycentric(corners, signed.point);
        let ids = self.mesh.faces[signed.face as usize];
        let smooth: DVec3 =
            ids.iter().zip(weights).map(|(v, w)| w * self.prepared.normals[*v as usize]).sum();
        let normal = smooth.try_normalize().unwrap_or(signed.normal);
        Sight { distance: signed.distance, point: signed.point, normal }
    }

    /// Signed distance only, mm.
    pub(crate) fn signed(&self, p: DVec3) -> f64 {
        self.prepared.distance.signed(p).distance
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
