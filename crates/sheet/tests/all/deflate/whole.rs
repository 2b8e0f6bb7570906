//! Solids of known middles, deflated.

use crate::deflate::solid_models::{appended, prism, revolved, turned};
use crate::deflate::support::{deflated, has_topology, near};
use mesh_kernel::glam::{DVec2, DVec3};
use mesh_kernel::query::{Adjacency, ClosestPoint, Crossings};
use mesh_kernel::{Group, TriMesh};
use sheet::deflate::{DeflateError, DeflateOptions, Deflated, Nobody, Shape, Step, Steps, Watcher, deflate};
use sheet::thicken::{self, ThickenOptions, thicken};

/// Every node of the sheet is in one of the planes `normal · x = offset`.
#[track_caller]
fn lies_in(thin: &Deflated, planes: &[(DVec3, f64)]) {
    for p in &thin.sheet.positions {
        let off = planes.iter().map(|(n, d)| (n.dot(*p) - d).abs()).fold(f64::MAX, f64::min);
        assert!(off < 1e-9, "{p} is off by {off}");
    }
}

/// An angle of two legs, 2 thick, 40 and 30 to the middle of the bend, 50 long, along z.
const ANGLE: [[f64; 2]; 6] = [[-1., -1.], [40., -1.], [40., 1.], [1., 1.], [1., 30.], [-1., 30.]];
/// A T: a bar of 60 and a stem of 25, all 2 thick.
const TEE: [[f64; 2]; 8] =
    [[-30., -1.], [30., -1.], [30., 1.], [1., 1.], [1., 25.], [-1., 25.], [-1., 1.], [-30., 1.]];
/// A Z of three walls: one edge is hollow on one side, one on the other.
const ZED: [[f64; 2]; 8] =
    [[-30., -1.], [1., -1.], [1., 19.], [30., 19.], [30., 21.], [-1., 21.], [-1., 1.], [-30., 1.]];

#[test]
fn plane_walls_have_exact_middles_however_they_are_meshed() {
    for cells in [1, 7, 50] {
        let angle = deflated(&prism(&ANGLE, 50.0, cells));
        has_topology(&angle, [2, 0, 1, 1]);
        near(angle.report.area, 50.0 * 70.0, 1e-12);
        lies_in(&angle, &[(DVec3::X, 0.0), (DVec3::Y, 0.0)]);
        assert!(angle.thickness.iter().all(|t| (t - 2.0).abs() < 1e-9));

        let zed = deflated(&prism(&ZED, 50.0, cells));
        has_topology(&zed, [3, 0, 1, 1]);
        near(zed.report.area, 50.0 * 80.0, 1e-12);
    }
}

#[test]
fn a_rib_shares_its_nodes_with_the_wall() {
    for cells in [1, 9] {
        let tee = deflated(&prism(&TEE, 40.0, cells));
        has_topology(&tee, [3, 1, 2, 1]);
        near(tee.report.area, 40.0 * 85.0, 1e-12);
        lies_in(&tee, &[(DVec3::X, 0.0), (DVec3::Y, 0.0)]);
        let adjacency = Adjacency::new(&tee.sheet);
        let joint = (0..adjacency.edges().len() as u32).filter(|e| adjacency.half_edges(*e).len() == 3);
        let length: f64 = joint
            .map(|e| {
                let [a, b] = adjacency.edges()[e as usize].map(|v| tee.sheet.positions[v as usize]);
                a.distance(b)
            })
            .sum();
        near(length, 40.0, 1e-12);
    }
}

#[test]
fn ribs_on_both_sides_of_a_wall_are_cut_into_it() {
    // One rib above at x = −10, one below at x = 10: neither side of the bar knows both.
    let profile = [
        [-30., -1.],
        [9., -1.],
        [9., -20.],
        [11., -20.],
        [11., -1.],
        [30., -1.],
        [30., 1.],
        [-9., 1.],
        [-9., 20.],
        [-11., 20.],
        [-11., 1.],
        [-30., 1.],
    ];
    let thin = deflated(&prism(&profile, 40.0, 3));
    has_topology(&thin, [5, 2, 3, 1]);
    near(thin.report.area, 40.0 * (60.0 + 20.0 + 20.0), 1e-12);
}

#[test]
fn a_thick_base_below_thin_fins_is_a_wall() {
    // A heat sink: a base of 60 and seven fins of 1.2, whose thickness tells nothing of the base's.
    let (base, fin, top) = (5.0, 1.2, 30.0);
    let mut profile = vec![[0.0, 0.0], [60.0, 0.0], [60.0, base]];
    for k in (0..7).rev() {
        let x = 4.0 + 8.0 * f64::from(k);
        profile.extend([[x + fin, base], [x + fin, top], [x, top], [x, base]]);
    }
    profile.push([0.0, base]);
    let thin = deflated(&prism(&profile, 40.0, 1));
    assert_eq!((thin.report.joints, thin.report.components), (7, 1));
    near(thin.report.area, 40.0 * (60.0 + 7.0 * (top - base / 2.0)), 1e-9);
    near(thin.report.thickness.max, base, 1e-9);
    near(thin.report.thickness.min, fin, 1e-9);
}

#[test]
fn turned_and_inside_out_it_is_the_same() {
    let solid = turned(&prism(&TEE, 40.0, 2));
    let thin = deflated(&solid);
    has_topology(&thin, [3, 1, 2, 1]);
    near(thin.report.area, 40.0 * 85.0, 1e-11);
    let mut inside_out = solid.clone();
    inside_out.faces.iter_mut().for_each(|f| f.swap(0, 1));
    near(deflated(&inside_out).report.area, 40.0 * 85.0, 1e-11);
}

#[test]
fn a_wall_with_draft_gets_its_bisector_and_an_even_thickness() {
    // A rib from 4 at the root to 3 at the top, 40 high, on a bar 4 thick.
    let profile =
        [[-30., -2.], [30., -2.], [30., 2.], [2., 2.], [1.5, 42.], [-1.5, 42.], [-2., 2.], [-30., 2.]];
    let thin = deflated(&prism(&profile, 50.0, 1));
    has_topology(&thin, [3, 1, 2, 1]);
    near(thin.report.area, 50.0 * (60.0 + 42.0), 1e-12);
    lies_in(&thin, &[(DVec3::X, 0.0), (DVec3::Y, 0.0)]);
    // It is so in long strips: along the rib nothing changes.
    assert!(thin.sheet.faces.len() < 900, "{} faces", thin.sheet.faces.len());
    for f in 0..thin.sheet.faces.len() as u32 {
        let [a, b, c] = thin.sheet.corners(f);
        let y = (a.y + b.y + c.y) / 3.0;
        if y > 2.0 {
            let heights = [a.y, b.y, c.y];
            let span = heights.iter().copied().fold(f64::MIN, f64::max)
                - heights.iter().copied().fold(f64::MAX, f64::min);
            assert!(span / 40.0 < 0.03 * thin.thickness[f as usize], "{span} mm of {y}");
            near(thin.thickness[f as usize], 4.0 - (y - 2.0) / 40.0, 2e-3);
        }
    }
}

#[test]
fn steps_in_thickness_are_joined_apart_or_aligned() {
    let profile = [[0., 0.], [100., 0.], [100., 4.], [50., 4.], [50., 2.], [0., 2.]];
    let solid = prism(&profile, 40.0, 4);
    let with =
        |steps| deflate(&solid, &DeflateOptions { steps, ..DeflateOptions::default() }, &Nobody).unwrap();
    let joined = with(Steps::Joined);
    has_topology(&joined, [3, 0, 1, 1]);
    near(joined.report.area, 4040.0, 1e-12);
    assert_eq!(joined.report.steps, 1);
    let apart = with(Steps::Apart);
    has_topology(&apart, [2, 0, 2, 2]);
    near(apart.report.area, 4000.0, 1e-12);
    let aligned = with(Steps::Aligned);
    has_topology(&aligned, [1, 0, 1, 1]);
    near(aligned.report.area, 4000.0, 1e-12);
    for thin in [joined, apart, aligned] {
        near(thin.report.thickness.min, 2.0, 1e-9);
        near(thin.report.thickness.max, 4.0, 1e-9);
    }
}

#[test]
fn round_walls_follow_their_tessellation() {
    // A tube of mid radius 20 and a dome of mid radius 30, 2 thick.
    let tube = deflated(&revolved(&[[19., 0.], [21., 0.], [21., 50.], [19., 50.]], 48, true));
    has_topology(&tube, [1, 0, 2, 1]);
    let chords = 48.0 * 2.0 * 20.0 * (std::f64::consts::PI / 48.0).sin();
    near(tube.report.area, 50.0 * chords, 1e-3);
    tube.thickness.iter().for_each(|t| near(*t, 2.0, 4e-3));
    let arc = |r: f64, k: i32| {
        let angle = std::f64::consts::FRAC_PI_2 * f64::from(k) / 12.0;
        [r * angle.sin(), r * angle.cos()]
    };
    let profile: Vec<[f64; 2]> =
        (0..=12).map(|k| arc(29.0, k)).chain((0..=12).rev().map(|k| arc(31.0, k))).collect();
    let dome = deflated(&revolved(&profile, 48, false));
    has_topology(&dome, [1, 0, 1, 1]);
    near(dome.report.area, std::f64::consts::TAU * 900.0, 5e-3);
    for p in &dome.sheet.positions {
        near(p.length(), 30.0, 1e-3);
    }
}

#[test]
fn a_stepped_tube_is_two_tubes_and_a_ring() {
    // The bore is 10; outside, 12 up to half of the height and 14 above, or the other way about.
    for [low, high] in [[12.0, 14.0], [14.0, 12.0]] {
        let profile = [[10.0, 0.0], [low, 0.0], [low, 20.0], [high, 20.0], [high, 40.0], [10.0, 40.0]];
        for steps in [24, 96] {
            let solid = revolved(&profile, steps, true);
            for solid in [&solid, &turned(&solid)] {
                let thin = deflated(solid);
                let r = &thin.report;
                assert_eq!((r.components, r.free_loops, r.self_intersections), (1, 2, 0));
                let chord = (f64::from(steps) / std::f64::consts::PI).recip().cos();
                let (low, high) = ((10.0 + low) / 2.0, (10.0 + high) / 2.0);
                let ring: f64 = high * high - low * low;
                let area = std::f64::consts::PI * (40.0 * (low + high) + ring.abs());
                near(r.area, area, 2.0 * (1.0 - chord) + 0.01);
                near(r.thickness.min, 2.0, 0.02);
                near(r.thickness.max, 4.0, 0.02);
            }
        }
    }
}

#[test]
fn a_thick_end_of_a_thin_tube_is_a_wall() {
    // 4 thick for 35, and 1.5 for 45, stepped on both sides.
    let outline =
        [[12., 0.], [16., 0.], [16., 35.], [15., 35.], [15., 80.], [13.5, 80.], [13.5, 35.], [12., 35.]];
    let thin = deflated(&revolved(&outline, 64, true));
    let area = |f: u32| thin.sheet.area_normal(f).length() / 2.0;
    let volume: f64 = (0u32..).zip(&thin.thickness).map(|(f, t)| area(f) * t).sum();
    near(volume, thin.report.solid_volume, 0.02);
    let thick: f64 = (0u32..).zip(&thin.thickness).filter(|(_, t)| **t > 3.0).map(|(f, _)| area(f)).sum();
    near(thick, std::f64::consts::TAU * 14.0 * 35.0, 0.02);
}

#[test]
fn facets_that_were_divided_where_they_lie_stay_facets() {
    let whole = revolved(&[[19., 0.], [21., 0.], [21., 50.], [19., 50.]], 24, true);
    let divided = divided(&divided(&whole));
    assert_eq!(divided.faces.len(), 16 * whole.faces.len());
    let tube = deflated(&divided);
    has_topology(&tube, [1, 0, 2, 1]);
    near(tube.report.area, deflated(&whole).report.area, 1e-3);
    // A plate folded twice by 30° is three planes nevertheless.
    let fold = [[0., 0.], [40., 0.], [74.641, 20.], [114.641, 20.]];
    let up = [[114.641, 22.], [74.105, 22.], [39.464, 2.], [0., 2.]];
    let plate = deflated(&divided_prism(&fold, &up));
    assert_eq!((plate.report.pairs, plate.report.self_intersections), (3, 0));
}

fn divided_prism(below: &[[f64; 2]], above: &[[f64; 2]]) -> TriMesh {
    divided(&divided(&prism(&[below, above].concat(), 60.0, 3)))
}

/// Every face in four.
fn divided(mesh: &TriMesh) -> TriMesh {
    let adjacency = Adjacency::new(mesh);
    let mut fine = TriMesh::new(mesh.positions.clone(), Vec::new());
    let first = fine.positions.len() as u32;
    let middle = |[a, b]: &[u32; 2]| mesh.positions[*a as usize].midpoint(mesh.positions[*b as usize]);
    fine.positions.extend(adjacency.edges().iter().map(middle));
    for (f, [a, b, c]) in (0..).zip(&mesh.faces) {
        let [p, q, r] = [0, 1, 2].map(|k| first + adjacency.edge_of(3 * f + k).unwrap());
        fine.faces.extend([[*a, p, r], [p, *b, q], [r, q, *c], [p, q, r]]);
    }
    fine
}

/// A dome of mid radius 30 on a pipe of mid radius 30, rounded into a rim with radius 6, 2 thick, in `n` chords a right angle.
fn bell(n: i32) -> Vec<[f64; 2]> {
    let arc = |centre: [f64; 2], r: f64, from: f64, to: f64, k: i32| {
        let angle = from + (to - from) * f64::from(k) / f64::from(n);
        [centre[0] + r * angle.cos(), centre[1] + r * angle.sin()]
    };
    let half = std::f64::consts::FRAC_PI_2;
    let side = |inner: f64| -> Vec<[f64; 2]> {
        let dome = (0..=n).rev().map(move |k| arc([0.0, 0.0], 30.0 + inner, 0.0, half, k));
        let rim = (0..=n).map(move |k| arc([36.0, -40.0], 6.0 - inner, 2.0 * half, 3.0 * half, k));
        dome.chain(rim).chain([[50.0, -46.0 + inner]]).collect()
    };
    side(-1.0).into_iter().chain(side(1.0).into_iter().rev()).collect()
}

#[test]
fn round_faces_are_named_however_they_are_meshed() {
    for (n, around) in [(4, 20), (9, 64)] {
        let solid = turned(&revolved(&bell(n), around, false));
        round_faces_are_named(&solid);
        round_faces_are_named(&divided(&divided(&solid)));
    }

    fn round_faces_are_named(solid: &TriMesh) {
        let thin = deflated(solid);
        let mut kinds: Vec<&str> = thin.report.faces.iter().map(|f| f.shape.name()).collect();
        kinds.sort_unstable();
        let cylinders = ["cylinder"; 3];
        let wanted = [&cylinders[..], &["plane"; 2], &["sphere"; 2], &["torus"; 2]].concat();
        assert_eq!(kinds, wanted, "{:?}", thin.report.faces);
        let middles: Vec<Shape> = thin.report.wall_pairs.iter().map(|w| w.middle).collect();
        assert_eq!(middles.len(), 4, "{middles:?}");
        for wall in &thin.report.wall_pairs {
            near(wall.thickness, 2.0, 1e-6);
            match wall.middle {
                Shape::Cylinder { radius, .. } | Shape::Sphere { radius, .. } => near(radius, 30.0, 1e-6),
                Shape::Torus { major, minor, .. } => {
                    near(major, 36.0, 1e-6);
                    near(minor, 6.0, 1e-6);
                }
                Shape::Plane { .. } => {}
                shape => panic!("{shape:?}"),
            }
        }
    }
}

#[test]
fn a_mesh_of_its_own_has_its_nodes_on_round_middles() {
    let options = DeflateOptions { edge_length: Some(4.0), ..DeflateOptions::default() };
    let tube = revolved(&[[19., 0.], [21., 0.], [21., 50.], [19., 50.]], 24, true);
    let thin = deflate(&tube, &options, &Nobody).unwrap();
    has_topology(&thin, [1, 0, 2, 1]);
    for p in &thin.sheet.positions {
        near(p.x.hypot(p.y), 20.0, 1e-6);
    }
    thin.thickness.iter().for_each(|t| near(*t, 2.0, 1e-6));
    for f in 0..thin.sheet.faces.len() as u32 {
        let [a, b, c] = thin.sheet.corners(f);
        let longest = a.distance(b).max(b.distance(c)).max(c.distance(a));
        assert!(longest < 7.0 && thin.sheet.area_normal(f).length() > 0.25 * longest * longest);
    }
}

#[test]
fn cones_and_whole_rings_have_exact_middles() {
    let options = DeflateOptions { edge_length: Some(4.0), ..DeflateOptions::default() };
    // A funnel that narrows by 3 in 4: walls 2 thick across it are 2.5 apart in radius.
    let funnel = turned(&revolved(&[[10., 0.], [40., 40.], [42.5, 40.], [12.5, 0.]], 40, true));
    let thin = deflate(&funnel, &options, &Nobody).unwrap();
    has_topology(&thin, [1, 0, 2, 1]);
    let cones = thin.report.faces.iter().filter(|f| matches!(f.shape, Shape::Cone { .. })).count();
    assert_eq!(cones, 2, "{:?}", thin.report.faces);
    near(thin.report.area, std::f64::consts::PI * (11.25 + 41.25) * 50.0, 5e-3);
    thin.thickness.iter().for_each(|t| near(*t, 2.0, 1e-6));
    // A hollow ring about a pipe of mid radius 5, 2 thick: a skin outside, and one inside that faces the other way.
    let circle = |r: f64, n: i32| -> Vec<[f64; 2]> {
        let at = |k| std::f64::consts::TAU * f64::from(k) / f64::from(n);
        (0..n).map(|k| [30.0 + r * at(k).cos(), r * at(k).sin()]).collect()
    };
    let mut ring = revolved(&circle(6.0, 24), 72, true);
    let mut hollow = revolved(&circle(4.0, 20), 60, true);
    hollow.faces.iter_mut().for_each(|f| f.swap(1, 2));
    ring = turned(&appended(&ring, &hollow));
    let options = DeflateOptions { edge_length: Some(2.0), ..DeflateOptions::default() };
    let thin = deflate(&ring, &options, &Nobody).unwrap();
    has_topology(&thin, [1, 0, 0, 1]);
    let tori = thin.report.faces.iter().filter(|f| matches!(f.shape, Shape::Torus { .. })).count();
    assert_eq!(tori, 2, "{:?}", thin.report.faces);
    near(thin.report.area, std::f64::consts::TAU * 30.0 * std::f64::consts::TAU * 5.0, 1e-2);
    thin.thickness.iter().for_each(|t| near(*t, 2.0, 1e-6));
}

/// A saddle of 60 × 40 with a fin on its middle line, in cells of `cell` mm: three patches that meet in one joint.
fn saddle_with_fin(cell: f64) -> TriMesh {
    let height = |x: f64, y: f64| 0.008 * x * x - 0.012 * y * y + 0.1 * x;
    let mut mesh = TriMesh::default();
    let mut grid = |name: &str, along: i32, across: i32, at: &dyn Fn(i32, i32) -> DVec3| {
        let start = mesh.positions.len() as u32;
        for i in 0..=along {
            mesh.positions.extend((0..=across).map(|j| at(i, j)));
        }
        let first = mesh.faces.len() as u32;
        let row = across as u32 + 1;
        for i in 0..along as u32 {
            for j in 0..across as u32 {
                let a = start + i * row + j;
                mesh.faces.extend([[a, a + row, a + row + 1], [a, a + row + 1, a + 1]]);
            }
        }
        mesh.groups.push(Group { name: name.into(), faces: first..mesh.faces.len() as u32 });
    };
    let (along, across) = ((60.0 / cell) as i32, (20.0 / cell) as i32);
    let x = |i: i32| f64::from(i) * cell - 30.0;
    for (name, side) in [("left", 1.0), ("right", -1.0)] {
        grid(name, along, across, &|i, j| {
            let y = side * f64::from(j) * cell;
            DVec3::new(x(i), y, height(x(i), y))
        });
    }
    grid("fin", along, (15.0 / cell) as i32, &|i, j| {
        let up = f64::from(j) * cell;
        DVec3::new(x(i), 0.02 * up * up, height(x(i), 0.0) + up)
    });
    mesh
}

#[test]
fn curved_sheets_come_back_node_by_node() {
    let sheet = saddle_with_fin(2.5);
    for t in [0.6, 1.8] {
        let solid = thicken(&sheet, &ThickenOptions::new(t), &thicken::Nobody).unwrap().solid;
        let thin = deflated(&solid);
        has_topology(&thin, [3, 1, 2, 1]);
        let distance = |mesh: &TriMesh, p: DVec3| ClosestPoint::new(mesh).closest(p).unwrap().distance;
        // All but what is next to the joint is known exactly.
        let far = sheet.positions.iter().filter(|p| p.y.abs() > 2.6 || p.y > 0.0 && p.y < 2.4);
        let nodes: Vec<f64> = far.map(|p| nearest_node(&thin.sheet, *p) / t).collect();
        assert!(
            nodes.len() > 350 && nodes.iter().all(|d| *d < 1e-6),
            "{t}: {:?}",
            nodes.iter().copied().fold(0.0, f64::max)
        );
        for (mesh, other) in [(&sheet, &thin.sheet), (&thin.sheet, &sheet)] {
            let off = mesh.positions.iter().map(|p| distance(other, *p) / t).fold(0.0, f64::max);
            assert!(off < 0.01, "{t}: {off}");
        }
    }
}

fn nearest_node(mesh: &TriMesh, p: DVec3) -> f64 {
    mesh.positions.iter().map(|q| q.distance(p)).fold(f64::INFINITY, f64::min)
}

#[test]
fn thickened_it_comes_back() {
    // A box with a lid and a partition: closed cells, joints of three.
    let solid = thicken(&crate::deflate::solid_models::boxed(), &ThickenOptions::new(1.5), &thicken::Nobody)
        .unwrap()
        .solid;
    let thin = deflated(&solid);
    near(thin.report.area, crate::deflate::solid_models::boxed_area(), 1e-11);
    assert_eq!((thin.report.patches, thin.report.joints, thin.report.free_loops), (11, 1, 0));
    assert!(thin.thickness.iter().all(|t| (t - 1.5).abs() < 1e-9));
}

#[test]
fn a_finer_mesh_on_request_keeps_joints() {
    let options = DeflateOptions { edge_length: Some(3.0), ..DeflateOptions::default() };
    let thin = deflate(&prism(&TEE, 40.0, 1), &options, &Nobody).unwrap();
    has_topology(&thin, [3, 1, 2, 1]);
    near(thin.report.area, 40.0 * 85.0, 1e-11);
    for f in 0..thin.sheet.faces.len() as u32 {
        let [a, b, c] = thin.sheet.corners(f);
        assert!(a.distance(b).max(b.distance(c)).max(c.distance(a)) < 6.0);
    }
}

#[test]
fn the_same_on_any_number_of_threads() {
    let solid = revolved(&[[19., 0.], [21., 0.], [21., 50.], [19., 50.]], 37, true);
    let on = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let thin = pool.install(|| deflated(&solid));
        (thin.sheet, thin.thickness)
    };
    assert_eq!(on(1), on(3));
}

#[test]
fn what_is_no_thin_solid_is_refused_and_says_why() {
    let refused = |solid: &TriMesh| deflate(solid, &DeflateOptions::default(), &Nobody).unwrap_err();
    let cube = prism(&[[0., 0.], [50., 0.], [50., 50.], [0., 50.]], 50.0, 1);
    match refused(&cube) {
        DeflateError::Bulky { unpaired, paired, .. } => {
            assert_eq!(unpaired.len(), 6);
            assert!(paired < 0.1);
        }
        other => panic!("{other}"),
    }
    let mut open = prism(&TEE, 40.0, 2);
    open.faces.pop();
    assert!(matches!(refused(&open), DeflateError::Open { edges: 3, .. }));
    let mut doubled = prism(&TEE, 40.0, 2);
    doubled.faces.push(doubled.faces[0]);
    assert!(matches!(refused(&doubled), DeflateError::NotManifold { .. }));
    let crossing = appended(&prism(&TEE, 40.0, 2), &prism(&ANGLE, 30.0, 2));
    assert!(!Crossings::new(&crossing).self_crossing().is_empty());
    assert!(matches!(refused(&crossing), DeflateError::SelfCrossing { .. }));
    assert_eq!(refused(&TriMesh::default()), DeflateError::Empty);
    let mut nowhere = prism(&TEE, 40.0, 1);
    nowhere.positions[3].y = f64::NAN;
    assert_eq!(refused(&nowhere), DeflateError::NotFinite { node: 3 });
    let bad = DeflateOptions { edge_length: Some(0.0), ..DeflateOptions::default() };
    let error = deflate(&cube, &bad, &Nobody).unwrap_err();
    assert!(matches!(error, DeflateError::OptionRange { option: "edge_length", .. }));
}

#[test]
fn a_wall_with_one_side_is_refused_as_such() {
    // A band of 20 × 2 that makes half a turn on its way around.
    let section = [[-10., -1.], [10., -1.], [10., 1.], [-10., 1.]];
    let steps = 120u32;
    let corner = |k: u32, c: usize| {
        let angle = std::f64::consts::TAU * f64::from(k) / f64::from(steps);
        let [across, up] = DVec2::from(section[c]).rotate(DVec2::from_angle(angle / 2.0)).to_array();
        DVec3::new((40.0 + across) * angle.cos(), (40.0 + across) * angle.sin(), up)
    };
    let positions = (0..steps).flat_map(|k| (0..4).map(move |c| corner(k, c))).collect();
    // Having come around, every corner is at the one that was opposite to it.
    let node = |k: u32, c: u32| if k < steps { 4 * k + c } else { (c + 2) % 4 };
    let quads = (0..steps).flat_map(|k| (0..4).map(move |c| (k, c, (c + 1) % 4)));
    let quad = |(k, c, d)| [node(k, c), node(k, d), node(k + 1, d), node(k + 1, c)];
    let faces = quads.map(quad).flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    let error = deflate(&TriMesh::new(positions, faces), &DeflateOptions::default(), &Nobody).unwrap_err();
    // Both sides of the wall are one.
    let DeflateError::OneSided { area, .. } = error else { panic!("{error}") };
    near(area, 2.0 * 20.0 * 40.0 * std::f64::consts::TAU, 0.05);
}

#[test]
fn a_watcher_ends_it_at_any_step() {
    struct After(Step, std::sync::atomic::AtomicBool);
    impl Watcher for After {
        fn step(&self, step: Step) {
            self.1.fetch_or(step == self.0, std::sync::atomic::Ordering::Relaxed);
        }
        fn cancelled(&self) -> bool {
            self.1.load(std::sync::atomic::Ordering::Relaxed)
        }
    }
    for step in [Step::Check, Step::Segments, Step::Pairs, Step::Replace, Step::Stitch] {
        let error = deflate(&prism(&TEE, 40.0, 1), &DeflateOptions::default(), &After(step, false.into()));
        assert_eq!(error.unwrap_err(), DeflateError::Cancelled);
    }
}

#[test]
fn small_faces_of_a_large_part_are_exact() {
    // A notch in the border of a large thin plate, and a small tab beside it.
    let profile = [
        [0.0, 0.0],
        [200.0, 0.0],
        [200.0, 1.2],
        [201.0, 1.2],
        [201.0, 0.0],
        [300.0, 0.0],
        [300.0, -0.9],
        [301.1, -0.9],
        [301.1, 0.0],
        [800.0, 0.0],
        [800.0, 600.0],
        [0.0, 600.0],
    ];
    let solid = prism(&profile, 1.0, 1);
    for solid in [&solid, &turned(&solid)] {
        let thin = deflated(solid);
        let r = &thin.report;
        assert_eq!([r.patches, r.joints, r.free_loops, r.components], [1, 0, 1, 1]);
        let wanted = 800.0 * 600.0 - 1.2 + 0.9 * 1.1;
        assert!((r.area - wanted).abs() < 1e-6, "{} mm² instead of {wanted}", r.area);
        assert_eq!(r.faces.len(), 14, "two sides and twelve ends");
    }
}
