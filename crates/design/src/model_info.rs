//! What a model holds: sizes, counts, boundary.

use mesh_kernel::body::Body;
use serde::Serialize;

/// The report of `toile info`; areas and volumes in the file's units.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct ModelInfo {
    /// Patches.
    pub surfaces: usize,
    /// Seams between them.
    pub joints: usize,
    /// Nodes of the whole, those on joints once.
    pub nodes: i64,
    /// Edges of the whole, those on joints once.
    pub edges: i64,
    /// Triangles.
    pub faces: i64,
    /// Loops inside faces (none in triangles).
    pub rings: i64,
    /// Connected parts.
    pub components: i64,
    /// Independent cycles.
    pub cycles: i64,
    /// Enclosed voids.
    pub voids: i64,
    /// Whether `v − e + f − r = C − Ch + Cc`, both sides counted on their own.
    pub identity_holds: bool,
    /// Connected curves of edges with one face.
    pub boundary_loops: usize,
    /// Whether there are none.
    pub closed: bool,
    /// Area.
    pub area: f64,
    /// Volume, when closed.
    pub volume: Option<f64>,
}

impl ModelInfo {
    /// Counts a body. O(n log n).
    pub fn of(body: &Body) -> Self {
        let counts = body.counts();
        let boundary_loops = boundary_curves(body);
        Self {
            surfaces: body.surfaces().len(),
            joints: body.joint_count(),
            nodes: counts.v,
            edges: counts.e,
            faces: counts.f,
            rings: counts.r,
            components: counts.c,
            cycles: counts.ch,
            voids: counts.cc,
            identity_holds: counts.identity_holds(),
            boundary_loops,
            closed: boundary_loops == 0,
            area: body.area(),
            volume: body.volume(),
        }
    }
}

/// Connected parts of the graph of free edges: where sheets meet in a joint, their borders are one curve.
fn boundary_curves(body: &Body) -> usize {
    let weld = body.weld();
    let mut parent: Vec<u32> = (0..weld.count as u32).collect();
    let mut touched = vec![false; weld.count];
    for free in body.free_edges() {
        let ends = body.surface(free.surface).ends(free.edge);
        let [a, b] = ends.map(|n| weld.node(free.surface, n.0));
        touched[a as usize] = true;
        touched[b as usize] = true;
        let (a, b) = (root(&mut parent, a), root(&mut parent, b));
        parent[a.max(b) as usize] = a.min(b);
    }
    (0..weld.count as u32).filter(|&n| touched[n as usize] && root(&mut parent, n) == n).count()
}

fn root(parent: &mut [u32], mut n: u32) -> u32 {
    while parent[n as usize] != n {
        parent[n as usize] = parent[parent[n as usize] as usize];
        n = parent[n as usize];
    }
    n
}

#[cfg(test)]
mod tests {
    use super::*;
    use mesh_kernel::TriMesh;
    use mesh_kernel::glam::DVec3;

    #[test]
    fn three_sheets_at_one_edge_have_one_border() {
        let tip = |angle: f64| DVec3::new(angle.cos(), angle.sin(), 0.0);
        let positions = vec![DVec3::ZERO, DVec3::Z, tip(0.0), tip(2.0), tip(4.0)];
        let mesh = TriMesh::new(positions, vec![[0, 1, 2], [0, 1, 3], [0, 1, 4]]);
        let info = ModelInfo::of(&Body::from_tri_mesh(&mesh).unwrap());
        assert_eq!((info.nodes, info.edges, info.faces), (5, 7, 3));
        assert_eq!((info.joints, info.boundary_loops, info.closed), (1, 1, false));
        assert!(info.identity_holds);
    }

    #[test]
    fn a_tetrahedron_is_closed() {
        let positions = vec![DVec3::ZERO, DVec3::X, DVec3::Y, DVec3::Z];
        let mesh = TriMesh::new(positions, vec![[0, 2, 1], [0, 1, 3], [1, 2, 3], [0, 3, 2]]);
        let info = ModelInfo::of(&Body::from_tri_mesh(&mesh).unwrap());
        assert!(info.closed && info.identity_holds);
        assert_eq!((info.voids, info.components), (1, 1));
        assert!((info.volume.unwrap() - 1.0 / 6.0).abs() < 1e-12);
    }
}
