//! Merging what is no solid: open, crossing, coplanar, non-manifold models; refusals; single precision.

use crate::merge::support::{Random, block, fault, moved, sphere, volume};
use mesh_kernel::TriMesh;
use mesh_kernel::body::Body;
use mesh_kernel::glam::{DQuat, DVec3};
use mesh_kernel::merge::{Boolean, MergeError, MergeOptions, Merged, boolean, merge, snapped_to_singles};
use mesh_kernel::query::Crossings;

/// A plane grid of cells, open.
fn panel(origin: DVec3, u: DVec3, v: DVec3, cells: u32) -> TriMesh {
    let n = cells + 1;
    let at =
        |i: u32, k: u32| origin + u * f64::from(i) / f64::from(cells) + v * f64::from(k) / f64::from(cells);
    let positions = (0..n * n).map(|p| at(p / n, p % n)).collect();
    let faces = (0..cells * cells)
        .flat_map(|c| {
            let a = (c / cells) * n + c % cells;
            [[a, a + n, a + n + 1], [a, a + n + 1, a + 1]]
        })
        .collect();
    TriMesh::new(positions, faces)
}

fn merged(models: &[&TriMesh]) -> Merged {
    let merged = merge(models, &MergeOptions::default()).unwrap();
    let mesh = TriMesh::new(merged.positions.clone(), merged.faces.clone());
    assert_eq!(Crossings::new(&mesh).self_crossing(), []);
    // Every face lies in the planes of all its parents.
    for f in 0..merged.faces.len() as u32 {
        assert!(!merged.parents(f).is_empty());
        for parent in merged.parents(f) {
            let model = merged.model_of(parent.face);
            let source = models[model as usize];
            let own = parent.face - merged.first_faces[model as usize];
            let [a, b, c] = source.corners(own);
            let normal = (b - a).cross(c - a).normalize();
            for p in mesh.corners(f) {
                assert!((p - a).dot(normal).abs() < 1e-7, "{p} is off face {own} of model {model}");
            }
            let same = mesh.area_normal(f).dot(normal) > 0.0;
            assert!(same != parent.reversed);
        }
    }
    merged
}

fn area(merged: &Merged, of: impl Fn(u32) -> bool) -> f64 {
    let mesh = TriMesh::new(merged.positions.clone(), merged.faces.clone());
    (0..merged.faces.len() as u32).filter(|f| of(*f)).map(|f| mesh.area_normal(f).length() / 2.0).sum()
}

#[test]
fn sheets_that_cross_are_joined_where_they_do() {
    let mut random = Random::new(4);
    for cells in [1, 3, 8] {
        for _ in 0..5 {
            let (turn, shift) = (random.turn(), random.point() * 30.0);
            let place = |m: &TriMesh| moved(m, |p| turn * p + shift);
            let flat = place(&panel(DVec3::new(-5.0, -5.0, 0.0), DVec3::X * 10.0, DVec3::Y * 10.0, cells));
            let steep = place(&panel(DVec3::new(-5.0, 0.3, -5.0), DVec3::X * 10.0, DVec3::Z * 10.0, cells));
            let merged = merged(&[&flat, &steep]);
            assert!((area(&merged, |_| true) - 200.0).abs() < 1e-8);
            let whole = TriMesh::new(merged.positions.clone(), merged.faces.clone());
            let body = Body::from_tri_mesh(&whole).unwrap();
            let counts = body.counts();
            assert!(counts.identity_holds());
            assert_eq!((counts.c, counts.ch, counts.cc), (1, 0, 0));
            assert_eq!(body.joint_count(), 1);
        }
    }
}

#[test]
fn what_coincides_has_both_for_parents() {
    let mut random = Random::new(6);
    for k in 0..20 {
        let turn = if k == 0 { DQuat::IDENTITY } else { random.turn() };
        let one = moved(&panel(DVec3::ZERO, DVec3::X * 10.0, DVec3::Y * 10.0, 4), |p| turn * p);
        let other = moved(
            &panel(DVec3::new(2.5, 1.25, 0.0), DVec3::new(6.0, 1.0, 0.0), DVec3::new(-1.0, 6.0, 0.0), 5),
            |p| turn * p,
        );
        let merged = merged(&[&one, &other]);
        let both = area(&merged, |f| merged.parents(f).len() == 2);
        assert!((both - 37.0).abs() < 1e-8, "{both}");
        assert!((area(&merged, |_| true) - 100.0).abs() < 1e-8);
    }
}

#[test]
fn a_model_that_touches_itself_in_an_edge_is_right() {
    let mut pair = block(DVec3::ZERO, DVec3::splat(10.0));
    let other = block(DVec3::new(10.0, 10.0, 0.0), DVec3::new(20.0, 20.0, 10.0));
    let first = pair.positions.len() as u32;
    pair.positions.extend(&other.positions);
    pair.faces.extend(other.faces.iter().map(|f| f.map(|v| v + first)));
    let rod = block(DVec3::new(8.0, 8.0, -1.0), DVec3::new(12.0, 12.0, 11.0));
    let solid = boolean(&[&pair, &rod], Boolean::Union, &MergeOptions::default()).unwrap();
    assert_eq!(fault(&solid.mesh), None);
    assert!((solid.volume() - (2000.0 + 16.0 * 12.0 - 2.0 * 4.0 * 10.0)).abs() < 1e-8);
    assert_eq!(solid.beads, 0);
}

#[test]
fn solids_in_voids_and_beside() {
    let shell = boolean(
        &[&sphere(DVec3::ZERO, 10.0, 3), &sphere(DVec3::ZERO, 8.0, 3)],
        Boolean::Difference,
        &MergeOptions::default(),
    )
    .unwrap();
    assert_eq!(fault(&shell.mesh), None);
    let core = sphere(DVec3::ZERO, 3.0, 2);
    let far = sphere(DVec3::X * 40.0, 3.0, 2);
    let all = boolean(&[&shell.mesh, &core, &far], Boolean::Union, &MergeOptions::default()).unwrap();
    let wanted = volume(&shell.mesh) + volume(&core) + volume(&far);
    assert!((all.volume() - wanted).abs() < 1e-9 * wanted);
    let none = boolean(&[&shell.mesh, &core], Boolean::Intersection, &MergeOptions::default()).unwrap();
    assert_eq!(none.mesh.faces.len(), 0);
}

#[test]
fn refusals_say_what_and_where() {
    let open = panel(DVec3::ZERO, DVec3::X, DVec3::Y, 2);
    let solid = block(DVec3::ZERO, DVec3::ONE);
    let options = MergeOptions::default();
    let error = boolean(&[&solid, &open], Boolean::Union, &options).unwrap_err();
    assert!(matches!(error, MergeError::Open { model: 1, .. }), "{error}");
    let mut bad = solid.clone();
    bad.positions[3].y = f64::NAN;
    assert!(matches!(merge(&[&bad], &options), Err(MergeError::NotFinite { .. })));
    bad.positions[3].y = 1e300;
    assert!(matches!(merge(&[&bad], &options), Err(MergeError::NotFinite { .. })));
    let mut bad = solid.clone();
    bad.faces[4][1] = 99;
    let error = merge(&[&solid, &bad], &options).unwrap_err();
    assert_eq!(error, MergeError::NodeOutOfRange { face: 16, node: 99, nodes: 8 });
    let cancelled = MergeOptions { cancelled: &|| true, ..options };
    assert_eq!(merge(&[&solid], &cancelled).unwrap_err(), MergeError::Cancelled);
    let nothing = merge(&[], &options).unwrap();
    assert!(nothing.faces.is_empty());
}

#[test]
fn single_precision_keeps_solids_sound() {
    let mut random = Random::new(12);
    for k in 0..12 {
        let one = sphere(random.point() * 100.0, 20.0, 3);
        let other = moved(&one, |p| p + random_shift(k));
        let union = boolean(&[&one, &other], Boolean::Union, &MergeOptions::default()).unwrap();
        for scale in [1.0, 1e-3] {
            let snapped = snapped_to_singles(&union.mesh, scale, &MergeOptions::default()).unwrap();
            let singles = moved(&snapped.mesh, |p| (p * scale).as_vec3().as_dvec3());
            assert_eq!(fault(&singles), None);
            let exact = snapped.mesh.positions.iter().map(|p| *p * scale);
            assert!(exact.zip(&singles.positions).all(|(p, q)| (p - *q).length() <= 1e-13 * q.length()));
            assert!((snapped.volume() - union.volume()).abs() < 1e-4 * union.volume());
        }
    }
}

#[test]
fn walls_of_a_few_steps_of_single_precision_stay() {
    for (far, wall) in [(0.0, 2e-4), (3e5, 2.0), (1e6, 2.0), (3e6, 4.0)] {
        let corner = DVec3::new(far, far, 0.0);
        let plate = block(corner, corner + DVec3::new(80.0, 60.0, wall));
        let snapped = snapped_to_singles(&plate, 1.0, &MergeOptions::default()).unwrap();
        assert_eq!(fault(&snapped.mesh), None);
        let (found, wanted) = (snapped.volume(), 80.0 * 60.0 * wall);
        assert!((found - wanted).abs() < 0.02 * wanted, "{far}: {found} is not {wanted}");
    }
}

fn random_shift(k: i32) -> DVec3 {
    DVec3::new(1.0, 0.3, -0.7) * 10f64.powi(1 - k)
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    let mut random = Random::new(77);
    let one = sphere(DVec3::ZERO, 10.0, 4);
    let shift = random.point() * 3.0;
    let other = moved(&one, |p| p + shift);
    let run = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| boolean(&[&one, &other], Boolean::Union, &MergeOptions::default()).unwrap())
    };
    assert_eq!(run(1), run(3));
}
