//! Distance with a sign that agrees with the winding number.
//!
//! The open ball about a point that reaches to the closest point of the mesh holds nothing of the mesh. In a mesh closed
//! by caps over its holes, the winding number therefore is the one just beside the closest face, unless a cap lies
//! between, and it is a whole number that is the same along connected faces that nothing crosses: one number a patch,
//! computed beforehand. The side of the face is that of the pseudonormal (Bærentzen, Aanæs 2005). What the caps add is
//! bounded by their area over the squared distance; while it stays below one half, the sign is certain. Nearer to a hole
//! the caps' own winding number is taken. All other points (with a cap between, at faces that cross others, on the
//! surface) ask the hierarchy of all solid angles.

use std::collections::BTreeMap;
use std::f64::consts::TAU;

use glam::DVec3;

use super::bvh::Bvh;
use super::welded::welded;
use super::winding::half_solid_angle;
use super::{Adjacency, ClosestPoint, Crossings, WindingNumber};
use crate::TriMesh;

/// The closest point of a mesh and the side of it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Signed {
    /// Distance to the mesh, negative inside.
    pub distance: f64,
    /// The closest point.
    pub point: DVec3,
    /// The face that holds it.
    pub face: u32,
    /// Unit normal there, outward where faces look outward: of the face, or the mean of the faces at a side or a node
    /// by angle; zero at a degenerate face.
    pub normal: DVec3,
}

/// A mesh prepared for signed distances.
///
/// *Inside* is where the winding number is above one half: right on meshes with holes, overlaps and loose parts.
#[derive(Clone, Debug)]
pub struct SignedDistance {
    closest: ClosestPoint,
    winding: WindingNumber,
    faces: Vec<[u32; 3]>,
    face_normals: Vec<DVec3>,
    /// Of the half-edges: mean of the two faces' normals where both belong to one patch, else zero.
    edge_normals: Vec<DVec3>,
    /// Of the (welded) nodes: mean of the faces' normals by angle.
    node_normals: Vec<DVec3>,
    /// Whether all faces about the node are one closed fan of one patch.
    node_certain: Vec<bool>,
    /// Winding number just outside each face, in the mesh closed by caps; [`UNKNOWN`] where it is not one number.
    outside: Vec<i32>,
    caps: Vec<Cap>,
    cap_surface: Option<CapSurface>,
    bounds: [DVec3; 2],
    /// Below this distance the side is not taken from a difference of coordinates.
    rounding: f64,
}

/// The cone over one hole: all that matters is how much it can be seen.
#[derive(Clone, Copy, Debug)]
struct Cap {
    centre: DVec3,
    radius: f64,
    /// Area over 4π.
    weight: f64,
}

/// The cones over all holes, cut into small faces.
#[derive(Clone, Debug)]
struct CapSurface {
    closest: ClosestPoint,
    winding: WindingNumber,
}

const UNKNOWN: i32 = i32::MIN;
const MOST_RINGS: f64 = 32.0;
/// More holes than this, and the caps are not worth looking at one by one.
const MOST_CAPS: usize = 256;

impl SignedDistance {
    /// Prepares the mesh: hierarchies, self-crossings, caps. O(n log n); nodes at the same place count as one.
    pub fn new(mesh: &TriMesh) -> Self {
        let welded = welded(mesh);
        let (adjacency, bvh) = rayon::join(|| Adjacency::new(&welded), || Bvh::new(&welded));
        let face_normals: Vec<DVec3> =
            (0..welded.faces.len() as u32).map(|f| welded.area_normal(f).normalize_or_zero()).collect();
        let (closed, caps) = close(&welded, &adjacency);
        let (crossing, (winding, closest)) = rayon::join(
            || Crossings::with_bvh(bvh.clone(), &closed, welded.faces.len()).self_crossing(),
            || (WindingNumber::with_bvh(bvh.clone(), &welded), ClosestPoint::with_bvh(bvh.clone(), &welded)),
        );
        let mut uncrossed: Vec<bool> = face_normals.iter().map(|n| *n != DVec3::ZERO).collect();
        for face in crossing.into_iter().flat_map(|(f, g)| [f, g]) {
            if let Some(uncrossed) = uncrossed.get_mut(face as usize) {
                *uncrossed = false;
            }
        }
        let cap_faces: Vec<[DVec3; 3]> =
            (welded.faces.len() as u32..closed.faces.len() as u32).map(|f| closed.corners(f)).collect();
        let mut query = Self {
            closest,
            winding,
            cap_surface: None,
            edge_normals: vec![DVec3::ZERO; 3 * welded.faces.len()],
            node_normals: vec![DVec3::ZERO; welded.positions.len()],
            node_certain: vec![false; welded.positions.len()],
            outside: vec![UNKNOWN; welded.faces.len()],
            caps,
            bounds: welded.bounds().unwrap_or([DVec3::ZERO; 2]),
            rounding: 0.0,
            face_normals,
            faces: Vec::new(),
        };
        query.rounding = 1e-12 * query.bounds[0].abs().max(query.bounds[1].abs()).max_element();
        if query.caps.len() <= MOST_CAPS {
            query.number_patches(&welded, &adjacency, &uncrossed, &cap_faces);
        }
        if !query.caps.is_empty() && query.caps.len() <= MOST_CAPS {
            let caps = TriMesh::new(closed.positions, closed.faces[welded.faces.len()..].to_vec());
            query.cap_surface =
                Some(CapSurface { closest: ClosestPoint::new(&caps), winding: WindingNumber::new(&caps) });
        }
        query.normals(&welded, &adjacency);
        query.faces = welded.faces;
        query
    }

    /// The same for a closed mesh of the same faces whose nodes have moved, all finite, but not so far that it crosses itself
    /// where it did not: which side of which face is outside stays as it was. `None` where faces differ or there are
    /// holes. O(n), a quarter of the time of [`Self::new`].
    pub fn moved(&self, mesh: &TriMesh) -> Option<Self> {
        let is_same = self.faces == mesh.faces && self.node_normals.len() == mesh.positions.len();
        if !is_same || !self.caps.is_empty() {
            return None;
        }
        let (adjacency, (closest, winding)) = rayon::join(
            || Adjacency::new(mesh),
            || {
                let bvh = self.closest.bvh().refit(mesh);
                (ClosestPoint::with_bvh(bvh.clone(), mesh), WindingNumber::with_bvh(bvh, mesh))
            },
        );
        let normal = |f: u32| mesh.area_normal(f).normalize_or_zero();
        let mut query = Self {
            closest,
            winding,
            cap_surface: None,
            edge_normals: vec![DVec3::ZERO; 3 * mesh.faces.len()],
            node_normals: vec![DVec3::ZERO; mesh.positions.len()],
            node_certain: vec![false; mesh.positions.len()],
            outside: self.outside.clone(),
            caps: Vec::new(),
            bounds: mesh.bounds().unwrap_or([DVec3::ZERO; 2]),
            rounding: 0.0,
            face_normals: (0..mesh.faces.len() as u32).map(normal).collect(),
            faces: self.faces.clone(),
        };
        query.rounding = 1e-12 * query.bounds[0].abs().max(query.bounds[1].abs()).max_element();
        query.normals(mesh, &adjacency);
        Some(query)
    }

    /// Signed distance, closest point and normal. `distance` is infinite and the normal zero for a mesh without faces or
    /// a point that is not finite.
    pub fn signed(&self, p: DVec3) -> Signed {
        let Some(closest) = self.closest.closest(p) else {
            return Signed { distance: f64::INFINITY, point: p, face: 0, normal: DVec3::ZERO };
        };
        let (normal, certain) = self.normal(closest.face, closest.barycentric);
        let offset = p - closest.point;
        let along = offset.dot(normal);
        let outside = self.outside[closest.face as usize];
        let side_known = certain
            && outside != UNKNOWN
            && closest.distance > self.rounding
            && along.abs() > 1e-6 * closest.distance;
        let beside = outside.saturating_add(i32::from(along < 0.0));
        let inside = if side_known && self.caps_are_far(p, closest.point) {
            Some(beside >= 1)
        } else if side_known {
            self.inside_beside_caps(p, closest.distance, f64::from(beside))
        } else {
            None
        };
        let inside = inside.unwrap_or_else(|| self.winding.is_above(p, 0.5));
        let distance = if inside { -closest.distance } else { closest.distance };
        Signed { distance, point: closest.point, face: closest.face, normal }
    }

    /// Whether the winding number about `p` is above one half.
    pub fn is_inside(&self, p: DVec3) -> bool {
        let in_bounds = p.cmpge(self.bounds[0]).all() && p.cmple(self.bounds[1]).all();
        (in_bounds || !self.caps.is_empty()) && self.signed(p).distance < 0.0
    }

    /// The closest point alone, without a side.
    pub fn closest(&self) -> &ClosestPoint {
        &self.closest
    }

    /// The winding numbers behind the sign.
    pub fn winding(&self) -> &WindingNumber {
        &self.winding
    }

    /// Whether no cap lies between `p` and `q`, and all caps together change the winding number about `p` by less than
    /// one half.
    #[inline]
    fn caps_are_far(&self, p: DVec3, q: DVec3) -> bool {
        let reach = q - p;
        let reach2 = reach.length_squared();
        let mut visible = 0.0;
        for cap in &self.caps {
            let to = cap.centre - p;
            let gap = to.length() - cap.radius;
            if gap <= 0.0 {
                return false;
            }
            visible += cap.weight / (gap * gap);
            if gap * gap <= reach2 {
                let t = (to.dot(reach) / reach2).clamp(0.0, 1.0);
                if (to - reach * t).length_squared() <= cap.radius * cap.radius {
                    return false;
                }
            }
        }
        visible < 0.499
    }

    /// Whether `p` is inside where caps are near: `beside` is the winding number of mesh and caps together at the closest
    /// point, which is `distance` away. `None` where a cap may lie between or the error decides.
    fn inside_beside_caps(&self, p: DVec3, distance: f64, beside: f64) -> Option<bool> {
        let caps = self.cap_surface.as_ref()?;
        if caps.closest.closest_within(p, distance * (1.0 + 1e-9)).is_some() {
            return None;
        }
        [2e-2, 1e-3].into_iter().find_map(|tolerance| {
            let number = caps.winding.winding(p, tolerance);
            let margin = beside - number.value - 0.5;
            (margin.abs() > number.error + 1e-9).then_some(margin > 0.0)
        })
    }

    /// The normal at a point of a face, and whether its sign tells the side.
    #[inline]
    fn normal(&self, face: u32, barycentric: [f64; 3]) -> (DVec3, bool) {
        let zero = barycentric.map(|b| b == 0.0);
        let half_edge = |k: usize| {
            let normal = self.edge_normals[3 * face as usize + k];
            if normal == DVec3::ZERO { (self.face_normals[face as usize], false) } else { (normal, true) }
        };
        let node = |k: usize| {
            let node = self.faces[face as usize][k] as usize;
            (self.node_normals[node], self.node_certain[node])
        };
        match zero {
            [false, false, true] => half_edge(0),
            [true, false, false] => half_edge(1),
            [false, true, false] => half_edge(2),
            [false, true, true] => node(0),
            [true, false, true] => node(1),
            [true, true, _] => node(2),
            [false, false, false] => (self.face_normals[face as usize], true),
        }
    }

    /// Finds the patches (faces joined by sides at which exactly two uncrossed faces of one direction meet) and the
    /// winding number outside each.
    fn number_patches(
        &mut self,
        mesh: &TriMesh,
        adjacency: &Adjacency,
        uncrossed: &[bool],
        cap_faces: &[[DVec3; 3]],
    ) {
        let mut visited = vec![false; mesh.faces.len()];
        for seed in 0..mesh.faces.len() as u32 {
            if visited[seed as usize] || !uncrossed[seed as usize] {
                continue;
            }
            visited[seed as usize] = true;
            let (mut patch, mut done) = (vec![seed], 0);
            while done < patch.len() {
                let face = patch[done];
                done += 1;
                for h in 3 * face..3 * face + 3 {
                    if let Some(other) = across(adjacency, h).map(|h| h / 3)
                        && uncrossed[other as usize]
                        && !visited[other as usize]
                    {
                        visited[other as usize] = true;
                        patch.push(other);
                    }
                }
            }
            // Any face of the patch would do; the largest is the safest against rounding.
            let area = |f: &u32| mesh.area_normal(*f).length_squared();
            let Some(largest) = patch.iter().copied().max_by(|a, b| area(a).total_cmp(&area(b))) else {
                continue;
            };
            let middle = mesh.corners(largest).into_iter().sum::<DVec3>() / 3.0;
            let open = self.winding.sum(middle, 1e-4, Some(largest));
            let capped = cap_faces.iter().map(|cap| half_solid_angle(*cap, middle)).sum::<f64>() / TAU;
            let beside = open.value + capped - 0.5;
            let certain = (beside - beside.round()).abs() + open.error < 0.25 && beside.abs() < 1e6;
            if certain {
                for face in patch {
                    self.outside[face as usize] = beside.round() as i32;
                }
            }
        }
    }

    fn normals(&mut self, mesh: &TriMesh, adjacency: &Adjacency) {
        // Faces about a node, those of them that belong to a patch, and sides that join two such.
        let mut counts = vec![[0u32; 3]; mesh.positions.len()];
        for f in 0..mesh.faces.len() as u32 {
            let normal = self.face_normals[f as usize];
            let known = self.outside[f as usize];
            let corners = mesh.corners(f);
            for k in 0..3u32 {
                let v = mesh.faces[f as usize][k as usize] as usize;
                let to = |other: usize| (corners[other % 3] - corners[k as usize]).normalize_or_zero();
                self.node_normals[v] += normal * to(k as usize + 1).angle_between_unit(to(k as usize + 2));
                counts[v][0] += 1;
                counts[v][1] += u32::from(known != UNKNOWN);
                if let Some(other) = across(adjacency, 3 * f + k).map(|h| h / 3)
                    && known != UNKNOWN
                    && self.outside[other as usize] == known
                {
                    self.edge_normals[(3 * f + k) as usize] =
                        (normal + self.face_normals[other as usize]).normalize_or_zero();
                    counts[v][2] += 1;
                }
            }
        }
        for normal in &mut self.node_normals {
            *normal = normal.normalize_or_zero();
        }
        // With as many joining sides as faces, the faces are closed fans; one fan only if going around visits them all.
        for f in 0..mesh.faces.len() as u32 {
            for k in 0..3u32 {
                let v = mesh.faces[f as usize][k as usize] as usize;
                let [faces, known, joined] = counts[v];
                if self.node_certain[v] || faces != known || faces != joined {
                    continue;
                }
                let mut h = 3 * f + k;
                let mut turned = 0;
                loop {
                    turned += 1;
                    let before = h / 3 * 3 + (h + 2) % 3;
                    match across(adjacency, before) {
                        Some(next) if next != 3 * f + k && turned <= faces => h = next,
                        _ => break,
                    }
                }
                self.node_certain[v] = turned == faces;
            }
        }
    }
}

/// The half-edge across `h` where exactly two faces meet there and run the same way.
fn across(adjacency: &Adjacency, h: u32) -> Option<u32> {
    let edge = adjacency.edge_of(h)?;
    let partner = adjacency.partner(h)?;
    (adjacency.half_edges(edge).len() == 2 && adjacency.ends(h) != adjacency.ends(partner)).then_some(partner)
}

trait AngleBetween {
    /// Angle between unit vectors, accurate at all sizes.
    fn angle_between_unit(self, other: Self) -> f64;
}

impl AngleBetween for DVec3 {
    fn angle_between_unit(self, other: Self) -> f64 {
        self.cross(other).length().atan2(self.dot(other))
    }
}

/// The mesh with cones over its holes added behind its own faces, and the cones as seen from afar.
///
/// The sides at which more faces run one way than the other form closed chains whatever the mesh, so that cones over
/// each connected set of them close it: its winding number is a whole number everywhere.
fn close(mesh: &TriMesh, adjacency: &Adjacency) -> (TriMesh, Vec<Cap>) {
    let mut closed = TriMesh::new(mesh.positions.clone(), mesh.faces.clone());
    let mut surplus: Vec<([u32; 2], usize)> = Vec::new();
    for (e, edge) in adjacency.edges().iter().enumerate() {
        let sides = adjacency.half_edges(e as u32);
        let forth = sides.iter().filter(|h| adjacency.ends(**h) == *edge).count();
        let back = sides.len() - forth;
        if forth > back {
            surplus.push((*edge, forth - back));
        } else if back > forth {
            surplus.push(([edge[1], edge[0]], back - forth));
        }
    }
    // Connected sets by their nodes: union and find with path halving.
    let mut parent: Vec<u32> =
        if surplus.is_empty() { Vec::new() } else { (0..mesh.positions.len() as u32).collect() };
    let find = |parent: &mut Vec<u32>, mut v: u32| {
        while parent[v as usize] != v {
            parent[v as usize] = parent[parent[v as usize] as usize];
            v = parent[v as usize];
        }
        v
    };
    for ([a, b], _) in &surplus {
        let (a, b) = (find(&mut parent, *a), find(&mut parent, *b));
        parent[a.max(b) as usize] = a.min(b);
    }
    let mut sets: Vec<(u32, [u32; 2], usize)> =
        surplus.into_iter().map(|(edge, count)| (find(&mut parent, edge[0]), edge, count)).collect();
    sets.sort_by_key(|set| set.0);
    let mut caps = Vec::new();
    for set in sets.chunk_by(|a, b| a.0 == b.0) {
        let ends = || set.iter().flat_map(|(_, edge, _)| edge).map(|v| mesh.positions[*v as usize]);
        let apex = ends().sum::<DVec3>() / (2 * set.len()) as f64;
        let number = closed.positions.len() as u32;
        closed.positions.push(apex);
        let cap_start = closed.faces.len();
        let mut cap = Cap { centre: apex, radius: 0.0, weight: 0.0 };
        // Rings between hole and apex, so that faces of a wide cap are not long and thin.
        let mean_side = set
            .iter()
            .map(|(_, [a, b], _)| closed.positions[*a as usize].distance(closed.positions[*b as usize]))
            .sum::<f64>()
            / set.len() as f64;
        let widest = ends().map(|p| p.distance(apex)).fold(0.0, f64::max);
        let rings = if mean_side > 0.0 {
            (widest / (2.0 * mean_side)).ceil().clamp(1.0, MOST_RINGS) as u32
        } else {
            1
        };
        let mut ring_nodes: BTreeMap<u32, u32> = BTreeMap::new();
        for v in set.iter().flat_map(|(_, edge, _)| *edge) {
            ring_nodes.entry(v).or_insert_with(|| {
                let first = closed.positions.len() as u32;
                for ring in 1..rings {
                    let p = closed.positions[v as usize].lerp(apex, f64::from(ring) / f64::from(rings));
                    closed.positions.push(p);
                }
                first
            });
        }
        let node = |v: u32, ring: u32| match ring {
            0 => v,
            _ if ring == rings => number,
            _ => ring_nodes[&v] + ring - 1,
        };
        for (_, [a, b], count) in set {
            for _ in 0..*count {
                for ring in 0..rings {
                    let quad = [node(*b, ring), node(*a, ring), node(*a, ring + 1), node(*b, ring + 1)];
                    closed.faces.push([quad[0], quad[1], quad[2]]);
                    if ring + 1 < rings {
                        closed.faces.push([quad[0], quad[2], quad[3]]);
                    }
                }
            }
        }
        let cap_faces = &closed.faces[cap_start..];
        cap.weight = cap_faces.iter().map(|face| face_area(&closed, *face)).sum::<f64>() / (2.0 * TAU);
        // A little more than the farthest corner, against rounding.
        cap.radius = widest * (1.0 + 1e-9);
        caps.push(cap);
    }
    (closed, caps)
}

fn face_area(mesh: &TriMesh, face: [u32; 3]) -> f64 {
    let [a, b, c] = face.map(|v| mesh.positions[v as usize]);
    0.5 * (b - a).cross(c - a).length()
}
