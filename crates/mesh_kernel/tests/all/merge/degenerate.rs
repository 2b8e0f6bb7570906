//! Pairs of solids that touch, share planes, edges and nodes, or nearly do.
//!
//! `TOILE_MERGE_PAIRS` says how many (default 400); `TOILE_MERGE_SEED` where the numbers begin.

use crate::merge::support::{Random, block, fault, moved, sphere, tetrahedron, volume};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::{DQuat, DVec3};
use mesh_kernel::merge::{Boolean, MergeOptions, boolean};
use rayon::prelude::*;

/// A solid with corners on a coarse lattice, so that chance makes things coincide.
fn lattice_solid(random: &mut Random) -> TriMesh {
    let mut whole = || DVec3::from_array([0; 3].map(|_| (random.next() * 5.0).floor()));
    match (whole().x as u32) % 3 {
        0 => {
            let (a, b) = (whole(), whole());
            block(a.min(b), a.max(b) + 1.0)
        }
        1 => loop {
            let t = [whole(), whole(), whole(), whole()];
            if (t[1] - t[0]).cross(t[2] - t[0]).dot(t[3] - t[0]) != 0.0 {
                break tetrahedron(t);
            }
        },
        _ => {
            let centre = whole();
            sphere(centre, 2.0, 1)
        }
    }
}

/// Something done to the second solid that leaves it nearly where it was.
fn nudged(mesh: &TriMesh, random: &mut Random) -> TriMesh {
    let size = [0.0, 1e-15, 1e-13, 1e-12, 1e-11, 1e-10, 1e-8][random.below(7)];
    let turn = DQuat::from_axis_angle(random.point().normalize_or(DVec3::X), size);
    let shift = random.point() * size;
    match random.below(4) {
        0 => mesh.clone(),
        1 => moved(mesh, |p| turn * p),
        2 => moved(mesh, |p| p + shift),
        _ => {
            let noise: Vec<DVec3> = mesh.positions.iter().map(|_| random.point() * size).collect();
            TriMesh::new(mesh.positions.iter().zip(noise).map(|(p, n)| *p + n).collect(), mesh.faces.clone())
        }
    }
}

fn pair(seed: u64) -> [TriMesh; 2] {
    let mut random = Random::new(seed);
    let one = lattice_solid(&mut random);
    let other = match random.below(3) {
        // The same again, moved along a lattice direction or not.
        0 => {
            let by = DVec3::from_array([0; 3].map(|_| (random.next() * 3.0).floor()));
            moved(&one, |p| p + by)
        }
        _ => lattice_solid(&mut random),
    };
    let other = nudged(&other, &mut random);
    // In half of the cases the planes are no planes of the grid.
    if random.below(2) == 0 {
        return [one, other];
    }
    let (turn, shift) = (random.turn(), random.point() * 100.0);
    [one, other].map(|m| moved(&m, |p| turn * p + shift))
}

fn trouble(seed: u64) -> Option<String> {
    let [one, other] = pair(seed);
    let (a, b) = (volume(&one), volume(&other));
    let mut volumes = [0.0; 3];
    for (k, operation) in [Boolean::Union, Boolean::Intersection, Boolean::Difference].into_iter().enumerate()
    {
        match boolean(&[&one, &other], operation, &MergeOptions::default()) {
            Err(e) => return Some(format!("{seed} {operation:?}: {e}")),
            Ok(solid) => {
                if let Some(fault) = fault(&solid.mesh) {
                    let (beads, doubled) = (solid.beads, solid.doubled_nodes);
                    return Some(format!(
                        "{seed} {operation:?}: {fault}; {beads} beads, {doubled} nodes doubled"
                    ));
                }
                volumes[k] = solid.volume();
            }
        }
    }
    let [union, common, rest] = volumes;
    // Beads where parts touch have some volume.
    let near = |x: f64, y: f64| (x - y).abs() < 1e-4 * (a + b);
    (!near(union + common, a + b) || !near(rest + common, a))
        .then(|| format!("{seed}: volumes {a} {b} → {volumes:?}"))
}

#[test]
fn nearly_degenerate_pairs() {
    let number = |name: &str, default: u64| std::env::var(name).map_or(default, |v| v.parse().unwrap());
    let (first, count) = (number("TOILE_MERGE_SEED", 0), number("TOILE_MERGE_PAIRS", 400));
    let troubles: Vec<String> = (first..first + count).into_par_iter().filter_map(trouble).collect();
    assert!(troubles.is_empty(), "{} of {count}:\n{}", troubles.len(), troubles.join("\n"));
}
