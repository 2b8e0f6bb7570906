//! Thin solids made from formulas.

use mesh_kernel::glam::{DMat3, DVec3};
use mesh_kernel::merge::{Boolean, MergeOptions, boolean};
use mesh_kernel::{Group, TriMesh};

/// A profile (anticlockwise in x and y) drawn along z, in a number of cells.
pub(crate) fn prism(profile: &[[f64; 2]], length: f64, cells: u32) -> TriMesh {
    let n = profile.len() as u32;
    let mut mesh = TriMesh::default();
    for k in 0..=cells {
        let z = length * f64::from(k) / f64::from(cells);
        mesh.positions.extend(profile.iter().map(|[x, y]| DVec3::new(*x, *y, z)));
    }
    for k in 0..cells {
        for i in 0..n {
            let [a, b] = [k * n + i, k * n + (i + 1) % n];
            mesh.faces.extend([[a, b, b + n], [a, b + n, a + n]]);
        }
    }
    for [a, b, c] in cap(profile) {
        mesh.faces.extend([[a, c, b], [a + cells * n, b + cells * n, c + cells * n]]);
    }
    mesh
}

/// A profile in radius and height (in either order), turned about z. `ring`: the profile does not touch the axis.
pub(crate) fn revolved(profile: &[[f64; 2]], steps: u32, ring: bool) -> TriMesh {
    let n = profile.len() as u32;
    let mut mesh = TriMesh::default();
    for k in 0..steps {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(steps);
        let at = |[r, z]: [f64; 2]| DVec3::new(r * angle.cos(), r * angle.sin(), z);
        mesh.positions.extend(profile.iter().map(|p| at(*p)));
    }
    for k in 0..steps {
        for i in 0..n {
            let (here, next) = (k * n, (k + 1) % steps * n);
            let j = (i + 1) % n;
            let on_axis = |i: u32| !ring && profile[i as usize][0].abs() < 1e-9;
            let node = |start: u32, i: u32| if on_axis(i) { i } else { start + i };
            match (on_axis(i), on_axis(j)) {
                (true, true) => {}
                (true, false) => mesh.faces.push([node(here, i), node(next, j), node(here, j)]),
                (false, true) => mesh.faces.push([node(here, i), node(next, i), node(here, j)]),
                (false, false) => mesh.faces.extend([
                    [node(here, i), node(next, i), node(next, j)],
                    [node(here, i), node(next, j), node(here, j)],
                ]),
            }
        }
    }
    mesh
}

/// A plate about the origin with a round hole in its middle.
pub(crate) fn plate_with_hole(width: f64, depth: f64, thickness: f64, radius: f64, chords: u32) -> TriMesh {
    let corners = [[-0.5, -0.5], [0.5, -0.5], [0.5, 0.5], [-0.5, 0.5]];
    let outline: Vec<[f64; 2]> = corners.iter().map(|[x, y]| [x * width, y * depth]).collect();
    let ring: Vec<[f64; 2]> = (0..chords)
        .map(|k| std::f64::consts::TAU * f64::from(k) / f64::from(chords))
        .map(|a| [radius * a.cos(), radius * a.sin()])
        .collect();
    let n = chords + 4;
    let mut mesh = TriMesh::default();
    for z in [-0.5, 0.5] {
        let at = |[x, y]: &[f64; 2]| DVec3::new(*x, *y, z * thickness);
        mesh.positions.extend(outline.iter().chain(&ring).map(at));
    }
    // The annulus: each chord with the corner of its quarter, and the outline's sides with the nodes between.
    let quarter = chords / 4;
    let corner = |k: u32| [2, 3, 0, 1][(k / quarter % 4) as usize];
    let mut top = Vec::new();
    for k in 0..chords {
        let (a, b) = (4 + k, 4 + (k + 1) % chords);
        top.push([a, corner(k), b]);
        if (k + 1) % quarter == 0 {
            top.push([b, corner(k), corner(k + 1)]);
        }
    }
    for [a, b, c] in top {
        mesh.faces.extend([[a + n, b + n, c + n], [a, c, b]]);
    }
    for i in 0..4 {
        let j = (i + 1) % 4;
        mesh.faces.extend([[i, j, j + n], [i, j + n, i + n]]);
    }
    for k in 0..chords {
        let (a, b) = (4 + k, 4 + (k + 1) % chords);
        mesh.faces.extend([[b, a, a + n], [b, a + n, b + n]]);
    }
    mesh
}

/// A closed box of 60 × 40 × 30 with a partition at half its length, as a sheet of eleven patches.
pub(crate) fn boxed() -> TriMesh {
    let mut mesh = TriMesh::default();
    for x in [0.0, 30.0, 60.0] {
        for (y, z) in [(0.0, 0.0), (40.0, 0.0), (40.0, 30.0), (0.0, 30.0)] {
            mesh.positions.push(DVec3::new(x, y, z));
        }
    }
    let mut quad = |[a, b, c, d]: [u32; 4]| {
        let first = mesh.faces.len() as u32;
        mesh.faces.extend([[a, b, c], [a, c, d]]);
        mesh.groups.push(Group { name: format!("wall_{}", mesh.groups.len()), faces: first..first + 2 });
    };
    for x in 0..3 {
        quad([4 * x, 4 * x + 1, 4 * x + 2, 4 * x + 3]);
    }
    for x in 0..2 {
        for i in 0..4 {
            let (a, b) = (4 * x + i, 4 * x + (i + 1) % 4);
            quad([a, b, b + 4, a + 4]);
        }
    }
    mesh
}

/// Area of [`boxed`].
pub(crate) fn boxed_area() -> f64 {
    3.0 * 40.0 * 30.0 + 2.0 * 60.0 * (40.0 + 30.0)
}

/// Turned and moved, so that no wall is parallel to an axis.
pub(crate) fn turned(mesh: &TriMesh) -> TriMesh {
    let turn = DMat3::from_rotation_z(0.7) * DMat3::from_rotation_x(1.1);
    let mut mesh = mesh.clone();
    mesh.positions.iter_mut().for_each(|p| *p = turn * *p + DVec3::new(30.0, -200.0, 55.0));
    mesh
}

/// Both in one mesh.
pub(crate) fn appended(a: &TriMesh, b: &TriMesh) -> TriMesh {
    let mut mesh = a.clone();
    let n = mesh.positions.len() as u32;
    mesh.positions.extend(&b.positions);
    mesh.faces.extend(b.faces.iter().map(|f| f.map(|v| v + n)));
    mesh
}

/// A box between two corners.
pub(crate) fn block([x, y, z]: [f64; 3], to: [f64; 3]) -> TriMesh {
    let profile = [[x, y], [to[0], y], [to[0], to[1]], [x, to[1]]];
    let mut block = prism(&profile, to[2] - z, 1);
    block.positions.iter_mut().for_each(|p| p.z += z);
    block
}

/// Solids in one; what was flush is one face.
pub(crate) fn united(solids: &[TriMesh]) -> TriMesh {
    let all: Vec<&TriMesh> = solids.iter().collect();
    boolean(&all, Boolean::Union, &MergeOptions::default()).unwrap().mesh
}

/// A polygon in triangles, ear by ear.
fn cap(profile: &[[f64; 2]]) -> Vec<[u32; 3]> {
    let at = |v: u32| profile[v as usize];
    let turn = |a: u32, b: u32, c: u32| {
        let ([ax, ay], [bx, by], [cx, cy]) = (at(a), at(b), at(c));
        (bx - ax) * (cy - ay) - (by - ay) * (cx - ax)
    };
    let mut ring: Vec<u32> = (0..profile.len() as u32).collect();
    let mut ears = Vec::new();
    while ring.len() > 3 {
        let n = ring.len();
        let is_ear = |i: &usize| {
            let (a, b, c) = (ring[(i + n - 1) % n], ring[*i], ring[(i + 1) % n]);
            let inside = |v: &u32| {
                ![a, b, c].contains(v)
                    && turn(a, b, *v) >= 0.0
                    && turn(b, c, *v) >= 0.0
                    && turn(c, a, *v) >= 0.0
            };
            turn(a, b, c) > 0.0 && !ring.iter().any(inside)
        };
        let i = (0..n).find(is_ear).expect("a simple polygon has an ear");
        ears.push([ring[(i + n - 1) % n], ring[i], ring[(i + 1) % n]]);
        ring.remove(i);
    }
    ears.push([ring[0], ring[1], ring[2]]);
    ears
}
