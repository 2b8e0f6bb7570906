//! Ends of walls in the plane of other walls: one face of the skin that is an end here and a wall there.

use crate::deflate::solid_models::{block, turned, united};
use crate::deflate::support::{deflated, has_topology, near};

/// A floor whose edge lies flush with a cheek that closes a part of it reaches to its own edge elsewhere, and to the cheek's middle there.
#[test]
fn a_floor_flush_with_a_short_cheek_ends_at_its_edge() {
    for (from, to) in [(60.0, 100.0), (30.0, 70.0), (0.0, 25.0)] {
        let floor = block([0.0, 0.0, 0.0], [100.0, 60.0, 2.0]);
        let cheek = block([from, 0.0, 0.0], [to, 2.0, 30.0]);
        let solid = united(&[floor, cheek]);
        for solid in [&solid, &turned(&solid)] {
            let thin = deflated(solid);
            has_topology(&thin, [2, 0, 1, 1]);
            let width = to - from;
            near(thin.report.area, 100.0 * 60.0 - width + width * 29.0, 1e-9);
            near(thin.report.thickness.min, 2.0, 1e-9);
            near(thin.report.thickness.max, 2.0, 1e-9);
        }
    }
}

/// The same with a cheek that stands out beside the floor, flush with it in front and below: each is the other's end.
#[test]
fn a_floor_and_an_ear_flush_with_each_other_end_each_at_its_own_edge() {
    let floor = block([0.0, 0.0, 0.0], [100.0, 60.0, 2.0]);
    let ear = block([80.0, 0.0, 0.0], [130.0, 2.0, 30.0]);
    let solid = united(&[floor, ear]);
    for solid in [&solid, &turned(&solid)] {
        let thin = deflated(solid);
        has_topology(&thin, [2, 0, 1, 1]);
        near(thin.report.area, (100.0 * 60.0 - 20.0) + (20.0 * 29.0 + 30.0 * 30.0), 1e-9);
    }
}

/// Beside a step of the floor's thickness the cheek changes nothing about that.
#[test]
fn a_floor_that_steps_beside_a_flush_cheek_stays_in_one_piece() {
    for (thick, from) in [(3.0, 50.0), (3.0, 60.0), (4.0, 50.0), (4.0, 60.0)] {
        let floor = block([0.0, 0.0, 0.0], [100.0, 60.0, 2.0]);
        let thicker = block([50.0, 0.0, 0.0], [100.0, 60.0, thick]);
        let cheek = block([from, 0.0, 0.0], [100.0, 2.0, 30.0]);
        let thin = deflated(&united(&[floor, thicker, cheek]));
        let r = &thin.report;
        assert_eq!((r.components, r.free_loops, r.steps), (1, 1, 1), "{thick} from {from}");
        assert_eq!((r.self_intersections, r.lost_edges), (0, 0), "{thick} from {from}");
    }
}
