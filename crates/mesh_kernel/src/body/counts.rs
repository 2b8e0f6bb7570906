//! Counts and the Euler–Poincaré identity; enclosed volume.

use super::Body;
use super::homology::ranks;
use super::ids::FaceId;
use super::shells::Shells;
use super::surface::Surface;
use super::welded::Welded;

/// Counts of the body as one complex, nodes and edges on joints counted once.
///
/// `v − e + f − r = c − ch + cc` (Wang et al.; Lee & Kim and Lipson & Shpitalni have it in other letters). The right
/// side is found without the left: components by union–find, independent cycles by ranks over GF(2), voids by the
/// radial order of sheets. So the identity can fail, and then the joints, their radial order or the geometry are broken.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Counts {
    /// Nodes.
    pub v: i64,
    /// Edges.
    pub e: i64,
    /// Faces.
    pub f: i64,
    /// Rings: hole loops inside a face; triangles have none.
    pub r: i64,
    /// Connected components (W: C, L: S, S: s).
    pub c: i64,
    /// Independent cycles that no face fills (W: Ch, L: C, S: g_nm).
    pub ch: i64,
    /// Enclosed voids (W: Cc, L: R, S: m).
    pub cc: i64,
}

impl Counts {
    /// Whether `v − e + f − r = c − ch + cc`.
    pub fn identity_holds(&self) -> bool {
        self.v - self.e + self.f - self.r == self.c - self.ch + self.cc
    }
}

impl std::fmt::Display for Counts {
    fn fmt(&self, out: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let Self { v, e, f, r, c, ch, cc } = self;
        write!(out, "v {v} − e {e} + f {f} − r {r}, c {c} − ch {ch} + cc {cc}")
    }
}

impl Body {
    /// Counts the body as one complex; see [`Counts`]. O(faces), and for bodies with very many patches what the
    /// elimination of their joints costs.
    pub fn counts(&self) -> Counts {
        counts_of(&Welded::new(self))
    }

    /// Volume that every void encloses, in mm³, ordered by the first face that bounds it; empty where nothing is
    /// enclosed. A part that floats in a void is not taken off it. O(faces).
    pub fn void_volumes(&self) -> Vec<f64> {
        let shells = Shells::new(&Welded::new(self));
        let volumes = shells.volumes(self);
        let mut outside = vec![false; shells.count];
        shells.outer(&volumes).into_iter().for_each(|s| outside[s] = true);
        (0..shells.count).filter(|&s| !outside[s]).map(|s| volumes[s]).collect()
    }

    /// Enclosed volume, in mm³; `None` where an edge has one face only, or there is no face at all.
    ///
    /// Where every edge is run over as often one way as the other, the winding says what is inside: the volume is that of
    /// the divergence theorem, negative for a body turned inside out, with cavities taken off. Else it is the sum of all
    /// voids. O(faces).
    pub fn volume(&self) -> Option<f64> {
        let complex = Welded::new(self);
        if complex.face_count() == 0 || (0..complex.edges.len()).any(|e| complex.uses(e).len() == 1) {
            return None;
        }
        let balanced = (0..complex.edges.len())
            .all(|e| complex.uses(e).map(|u| if u.along { 1 } else { -1 }).sum::<i32>() == 0);
        if !balanced {
            return Some(self.void_volumes().iter().sum());
        }
        let origin = self.surfaces.iter().find_map(|s| s.positions.first()).copied().unwrap_or_default();
        let cone = |s: &Surface, face: FaceId| {
            let [a, b, c] = s.corners(face).map(|p| p - origin);
            a.dot(b.cross(c)) / 6.0
        };
        Some(self.surfaces.iter().map(|s| s.live_faces().map(|f| cone(s, f)).sum::<f64>()).sum())
    }
}

pub(crate) fn counts_of(complex: &Welded) -> Counts {
    let ranks = ranks(complex);
    let (v, e, f) = (complex.weld.count as i64, complex.edges.len() as i64, i64::from(complex.face_count()));
    let mut nodes = super::weld::UnionFind::new(complex.weld.count);
    for &[a, b] in &complex.edges {
        nodes.union(a, b);
    }
    let (_, components) = nodes.number();
    Counts {
        v,
        e,
        f,
        r: 0,
        c: components as i64,
        ch: e - i64::from(ranks.first) - i64::from(ranks.second),
        cc: Shells::new(complex).voids() as i64,
    }
}
