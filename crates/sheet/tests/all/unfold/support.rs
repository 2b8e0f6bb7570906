//! Sheets of polygons for tests, and shared ones.

use std::path::Path;

use glam::DVec3;
use mesh_kernel::{Group, TriMesh};

pub(crate) fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

/// Convex polygons, a group each.
pub(crate) fn polygons(points: &[DVec3], faces: &[Vec<usize>]) -> TriMesh {
    let mut mesh = TriMesh::new(points.to_vec(), Vec::new());
    for (k, face) in faces.iter().enumerate() {
        let first = mesh.faces.len() as u32;
        for i in 1..face.len() - 1 {
            mesh.faces.push([face[0], face[i], face[i + 1]].map(|v| v as u32));
        }
        mesh.groups.push(Group { name: format!("wall{k}"), faces: first..mesh.faces.len() as u32 });
    }
    mesh
}

/// A profile of nodes and links, extruded along z.
pub(crate) fn extruded(nodes: &[[f64; 2]], links: &[[usize; 2]]) -> TriMesh {
    let n = nodes.len();
    let mut points: Vec<DVec3> = nodes.iter().map(|[x, y]| p(*x, *y, 0.0)).collect();
    points.extend(nodes.iter().map(|[x, y]| p(*x, *y, 1.0)));
    let faces: Vec<Vec<usize>> = links.iter().map(|&[a, b]| vec![a, b, b + n, a + n]).collect();
    polygons(&points, &faces)
}

/// Square cells of a grid, given by their lower left corners: nodes and walls.
pub(crate) fn cells(at: &[[i32; 2]]) -> TriMesh {
    let mut nodes: Vec<[i32; 2]> = Vec::new();
    let mut links: Vec<[usize; 2]> = Vec::new();
    let mut node = |q: [i32; 2]| {
        nodes.iter().position(|x| *x == q).unwrap_or_else(|| {
            nodes.push(q);
            nodes.len() - 1
        })
    };
    for [x, y] in at {
        let corners = [[*x, *y], [x + 1, *y], [x + 1, y + 1], [*x, y + 1]].map(&mut node);
        for i in 0..4 {
            let (a, b) = (corners[i], corners[(i + 1) % 4]);
            let link = [a.min(b), a.max(b)];
            if !links.contains(&link) {
                links.push(link);
            }
        }
    }
    let nodes: Vec<[f64; 2]> = nodes.iter().map(|q| q.map(f64::from)).collect();
    extruded(&nodes, &links)
}

/// A sheet of `../shared/sheets`; `None` where the folder is missing and may be.
pub(crate) fn shared(name: &str) -> Option<TriMesh> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/sheets");
    if !folder.is_dir() {
        let required = std::env::var("TOILE_REQUIRE_SHARED").is_ok_and(|v| v == "1");
        assert!(!required, "{} is missing, and TOILE_REQUIRE_SHARED is set", folder.display());
        return None;
    }
    Some(mesh_kernel::files::read(&folder.join(name)).unwrap())
}

/// A flat grid of `n` × `m` cells on a face given by origin and two sides, appended as a group.
pub(crate) fn add_grid(mesh: &mut TriMesh, name: &str, at: DVec3, u: DVec3, v: DVec3, n: u32, m: u32) {
    let (base, first) = (mesh.positions.len() as u32, mesh.faces.len() as u32);
    for j in 0..=m {
        for i in 0..=n {
            mesh.positions.push(at + u * f64::from(i) / f64::from(n) + v * f64::from(j) / f64::from(m));
        }
    }
    for j in 0..m {
        for i in 0..n {
            let a = base + j * (n + 1) + i;
            mesh.faces.extend([[a, a + 1, a + n + 2], [a, a + n + 2, a + n + 1]]);
        }
    }
    mesh.groups.push(Group { name: name.into(), faces: first..mesh.faces.len() as u32 });
}
