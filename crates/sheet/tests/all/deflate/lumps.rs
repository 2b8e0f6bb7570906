//! Things that are thicker than the walls that they stand on or merge into.

use crate::deflate::solid_models::{block, revolved, turned, united};
use crate::deflate::support::{deflated, has_topology, near};
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use mesh_kernel::merge::{Boolean, MergeOptions, boolean};

/// An open box of 80 × 60 × 30 mm, 2 mm thick, about the origin but for its height.
fn open_box() -> Vec<TriMesh> {
    vec![
        block([-40.0, -30.0, 0.0], [40.0, 30.0, 2.0]),
        block([-40.0, -30.0, 0.0], [-38.0, 30.0, 30.0]),
        block([38.0, -30.0, 0.0], [40.0, 30.0, 30.0]),
        block([-40.0, -30.0, 0.0], [40.0, -28.0, 30.0]),
        block([-40.0, 28.0, 0.0], [40.0, 30.0, 30.0]),
    ]
}

/// A solid block in the corner of a box has no middle; floor and walls go on behind it.
#[test]
fn walls_go_on_behind_a_lump() {
    let mut solids = open_box();
    solids.push(block([-39.0, -29.0, 1.0], [-26.0, -16.0, 20.0]));
    let solid = united(&solids);
    for solid in [&solid, &turned(&solid)] {
        let thin = deflated(solid);
        has_topology(&thin, [5, 0, 1, 1]);
        near(thin.report.area, 78.0 * 58.0 + 2.0 * (78.0 + 58.0) * 29.0, 1e-9);
        // It is told of.
        assert!(!thin.report.unpaired.is_empty());
        assert_eq!(thin.report.bare, []);
    }
}

/// A hollow boss that merges into the wall of a box: behind its hole the wall is thicker than walls are, so that the sheet is not in the middle
/// there. One that is true everywhere else, but without the boss, must not be taken for it.
#[test]
fn a_boss_in_a_wall_is_not_left_out() {
    for (chords, in_hole) in [(24, 24), (56, 72)] {
        let pin = |radius: f64, from: f64, to: f64, chords: u32| {
            let mut pin = revolved(&[[0.0, from], [radius, from], [radius, to], [0.0, to]], chords, false);
            pin.positions.iter_mut().for_each(|p| *p += DVec3::new(-35.0, 5.0, 0.0));
            pin
        };
        let mut solids = open_box();
        solids.push(pin(4.0, 1.0, 21.0, chords));
        let drilled = [united(&solids), pin(2.5, 2.0, 40.0, in_hole)];
        let drilled: Vec<&TriMesh> = drilled.iter().collect();
        let solid = boolean(&drilled, Boolean::Difference, &MergeOptions::default()).unwrap().mesh;
        let thin = deflated(&solid);
        assert_eq!(thin.report.bare, []);
        assert!(thin.report.joints > 0);
        // The boss is a cylinder of radius 3.25, most of which is beside the wall.
        let more = thin.report.area - (78.0 * 58.0 + 2.0 * (78.0 + 58.0) * 29.0);
        assert!(more > 0.6 * std::f64::consts::TAU * 3.25 * 20.0, "{more} mm² of it");
    }
}
