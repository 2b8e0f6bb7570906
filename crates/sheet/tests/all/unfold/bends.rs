//! Facets, counts and the one-piece search on sheets of the papers and on shared ones.

use crate::unfold::support::*;
use sheet::bends::{BendAnalysis, OnePiece, analyse};
use sheet::facets::{FacetRule, FacetSheet};
use sheet::unfold::Effort;

fn analysed(mesh: &mesh_kernel::TriMesh) -> BendAnalysis {
    let sheet = FacetSheet::new(mesh, FacetRule::Auto).unwrap();
    let found = analyse(&sheet, Effort::default()).unwrap();
    assert!(found.counts.identity_holds());
    assert_eq!(found.redundant, found.counts.redundant_joints());
    assert_eq!(found.plan.map(|plan| plan.counts()), Some(found.counts));
    found
}

/// v, free e, f, s, g_nm, m, b + w, d.
fn row(found: &BendAnalysis) -> [i64; 8] {
    let c = found.counts;
    [c.v, c.e, c.f, c.s, c.g_nm, c.m, c.b + c.w, found.redundant]
}

#[test]
fn y_of_fig_7() {
    let y = extruded(&[[0.0, 0.0], [0.0, -1.0], [1.0, 1.0], [-1.0, 1.0]], &[[0, 1], [0, 2], [0, 3]]);
    let found = analysed(&y);
    assert_eq!(row(&found), [8, 9, 3, 1, 0, 0, 1, -1]);
    // One line plays two roles: a bend and a weld.
    assert_eq!(found.one_piece, OnePiece::TooFewBends { pieces: 2, proved: true });
    let way = &found.assignments[0];
    assert_eq!((way.bends.len(), way.needed_welds, way.welds.len()), (1, 1, 1));
    assert_eq!(way.bends[0].line, way.welds[0].line);
}

#[test]
fn corner_of_fig_8() {
    let points = [
        p(0., 0., 0.),
        p(1., 0., 0.),
        p(1., 1., 0.),
        p(0., 1., 0.),
        p(0., 0., 1.),
        p(1., 0., 1.),
        p(0., 1., 1.),
    ];
    let found = analysed(&polygons(&points, &[vec![0, 1, 2, 3], vec![0, 4, 5, 1], vec![0, 3, 6, 4]]));
    assert_eq!(row(&found), [7, 6, 3, 1, 0, 0, 3, 1]);
    assert_eq!(found.one_piece, OnePiece::Yes);
    assert_eq!(found.assignments[0].bends.len(), 2);
}

#[test]
fn three_cells_of_fig_9a_bend_from_one_piece_and_four_of_9b_do_not() {
    let found = analysed(&cells(&[[0, 0], [1, 0], [0, 1]]));
    assert_eq!(row(&found), [16, 20, 10, 1, 3, 0, 8, -1]);
    // Fig. 10: nine bends, and eight bends with one weld, in more than one way.
    assert_eq!(found.one_piece, OnePiece::Yes);
    let roles: Vec<_> =
        found.assignments.iter().map(|a| (a.bends.len(), a.needed_welds, a.overlaps)).collect();
    assert_eq!(roles[0], (9, 0, Some(0)));
    assert!(roles.iter().filter(|r| **r == (8, 1, Some(0))).count() >= 2, "{roles:?}");
    let found = analysed(&cells(&[[0, 0], [1, 0], [0, 1], [1, 1]]));
    assert_eq!(row(&found), [18, 24, 12, 1, 4, 0, 9, -2]);
    assert_eq!((found.least_joints, found.most_bends), (11, 10), "eq. 10 does not hold");
    assert_eq!(found.one_piece, OnePiece::TooFewBends { pieces: 2, proved: true });
}

#[test]
fn box_with_a_partition_of_fig_11() {
    for name in ["box-partition-coarse.obj", "box-partition-meshed.obj"] {
        let Some(mesh) = shared(name) else { return };
        let found = analysed(&mesh);
        assert_eq!(row(&found), [12, 0, 11, 1, 0, 2, 20, 10], "{name}");
        assert_eq!(found.one_piece, OnePiece::Yes);
        assert_eq!((found.counts.b, found.counts.w), (10, 10));
    }
}

#[test]
fn shared_sheets_are_counted_however_finely_they_are_meshed() {
    for (name, wanted) in [
        ("l-shape", [6, 6, 2, 1, 0, 0, 1, 0]),
        ("t-shape", [8, 9, 3, 1, 0, 0, 1, -1]),
        ("x-shape", [10, 12, 4, 1, 0, 0, 1, -2]),
        ("y-extrusion", [8, 9, 3, 1, 0, 0, 1, -1]),
        ("open-box", [8, 4, 5, 1, 0, 0, 8, 4]),
        ("saddle-fin", [8, 9, 3, 1, 0, 0, 1, -1]),
    ] {
        for mesh in ["coarse", "meshed"] {
            let Some(mesh) = shared(&format!("{name}-{mesh}.obj")) else { return };
            assert_eq!(row(&analysed(&mesh)), wanted, "{name}");
        }
    }
}

#[test]
fn square_torus_and_hexagon_prism_of_fig_18() {
    let ring = |z: f64, a: f64, b: f64| [p(a, a, z), p(b, a, z), p(b, b, z), p(a, b, z)];
    let points =
        [ring(0.0, 0.0, 3.0), ring(1.0, 0.0, 3.0), ring(0.0, 1.0, 2.0), ring(1.0, 1.0, 2.0)].concat();
    let mut faces = Vec::new();
    for k in 0..4 {
        let n = (k + 1) % 4;
        faces.push(vec![k, n, n + 4, k + 4]);
        faces.push(vec![n + 8, k + 8, k + 12, n + 12]);
    }
    let mut mesh = polygons(&points, &faces);
    // Top and bottom in two halves each, concave: as triangles.
    for [x, y, z] in [[0u32, 1, 2], [2, 3, 0]] {
        for up in [4u32, 0] {
            let first = mesh.faces.len() as u32;
            let inner = up + 8;
            for (a, b) in [(x, y), (y, z)] {
                mesh.faces.extend([[a + up, b + up, b + inner], [a + up, b + inner, a + inner]]);
            }
            mesh.groups.push(mesh_kernel::Group { name: format!("half{x}-{up}"), faces: first..first + 4 });
        }
    }
    let found = analysed(&mesh);
    assert_eq!(row(&found), [16, 0, 12, 1, 2, 1, 28, 17]);
    let mut points = Vec::new();
    for z in [0.0, 1.0] {
        points.extend((0..6).map(|k| {
            let t = f64::from(k) * std::f64::consts::TAU / 6.0;
            p(t.cos(), t.sin(), z)
        }));
    }
    let mut faces = vec![vec![5, 4, 3, 2, 1, 0], vec![6, 7, 8, 9, 10, 11]];
    faces.extend([0, 2, 4].map(|k| vec![k, k + 1, k + 7, k + 6]));
    let found = analysed(&polygons(&points, &faces));
    let c = found.counts;
    assert_eq!([c.v, c.e + c.b + c.w, c.f, c.s, c.m, c.g_nm], [12, 18, 5, 1, 0, 2]);
}

#[test]
fn forty_facets_take_less_than_a_second() {
    // An egg crate: 4 × 3 cells of walls that cross, 31 walls, with a floor in every cell but three: 40 facets.
    let at: Vec<[i32; 2]> = (0..4).flat_map(|x| (0..3).map(move |y| [x, y])).collect();
    let mut mesh = cells(&at);
    let walls = mesh.groups.len();
    for (k, [x, y]) in at.iter().take(9).enumerate() {
        let corners = [[*x, *y], [x + 1, *y], [x + 1, y + 1], [*x, y + 1]];
        let find = |q: &[i32; 2]| {
            let at = p(f64::from(q[0]), f64::from(q[1]), 0.0);
            mesh.positions.iter().position(|p| *p == at).unwrap() as u32
        };
        let [a, b, c, d] = [find(&corners[0]), find(&corners[1]), find(&corners[2]), find(&corners[3])];
        let first = mesh.faces.len() as u32;
        mesh.faces.extend([[a, b, c], [a, c, d]]);
        mesh.groups.push(mesh_kernel::Group { name: format!("floor{k}"), faces: first..first + 2 });
    }
    assert_eq!((walls, mesh.groups.len()), (31, 40));
    let started = std::time::Instant::now();
    let found = analysed(&mesh);
    let seconds = started.elapsed().as_secs_f64();
    println!("40 facets: {:?} in {seconds:.3} s, {} flat sheets tried", found.one_piece, found.tried);
    assert!(seconds < 1.0, "{seconds} s");
}

#[test]
fn a_wall_in_the_middle_of_a_floor_can_only_be_welded() {
    // The floor is one facet on both sides of the wall's foot.
    let mut mesh = mesh_kernel::TriMesh::default();
    add_grid(&mut mesh, "floor", p(0., 0., 0.), p(30., 0., 0.), p(0., 30., 0.), 3, 3);
    add_grid(&mut mesh, "rib", p(10., 10., 0.), p(10., 0., 0.), p(0., 0., 5.), 1, 1);
    let found = analysed(&mesh);
    // The wall's foot is a loop inside the floor that has no hole: a ring less than the holes.
    assert_eq!(row(&found), [8, 7, 2, 1, -1, 0, 1, 0]);
    assert_eq!(found.one_piece, OnePiece::TooFewBends { pieces: 2, proved: true });
}
