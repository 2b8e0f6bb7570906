//! Edge collapse: pictures by hand, what is refused and why, and random sequences with splits and swaps.

// A test that cannot go on fails.
#![allow(clippy::unwrap_used)]

mod body_support;

use body_support::{Random, add_attributes, add_wires, random_body};
use mesh_kernel::body::edit::{CollapseOptions, Editor, Guard};
use mesh_kernel::body::{Body, EdgeId, NodeId, SurfaceId};
use proptest::prelude::*;

/// Defects that an operator without a guard may bring about in the geometry; never in the topology.
fn topology_sound(body: &Body) {
    let geometric = ["degenerate_face", "radial_order", "edge_without_length"];
    let defects: Vec<_> = body.check().into_iter().filter(|d| !geometric.contains(&d.code())).collect();
    assert_eq!(defects, []);
}

fn shape(body: &Body) -> [i64; 3] {
    let counts = body.counts();
    [counts.c, counts.ch, counts.cc]
}

/// One random operator; whether it was done.
fn step(editor: &mut Editor, random: &mut Random, guard: Guard) -> bool {
    let surface = SurfaceId(random.below(editor.body().surfaces().len()) as u32);
    let s = editor.body().surface(surface);
    if s.live_counts()[1] == 0 {
        return false;
    }
    let edges = s.edges().len();
    let edge = (0..).map(|_| EdgeId(random.below(edges) as u32)).find(|&e| s.is_edge(e)).unwrap();
    let end = s.edges()[edge.index()][random.below(2)];
    match random.below(8) {
        0 => editor.split_edge(surface, edge, 0.25 + 0.5 * random.unit()).is_ok(),
        1 | 2 => editor.swap_edge(surface, edge, guard).is_ok(),
        _ => {
            let at = [None, Some(0.5), Some(random.unit())][random.below(3)];
            editor.collapse_edge(surface, edge, NodeId(end), &CollapseOptions { at, guard }).is_ok()
        }
    }
}

fn run(kind: u8, seed: u64, steps: usize, guard: Guard, attributes: bool) {
    let mut random = Random(seed ^ 0xc011);
    let mut body = random_body(kind, seed);
    if body.surfaces().len() == 0 {
        return;
    }
    if attributes {
        add_attributes(&mut body, &mut random);
    }
    if seed % 2 == 0 {
        add_wires(&mut body, &mut random);
    }
    if seed % 5 == 0 {
        body.surface_ids().for_each(|s| body.surface_mut(s).store_backup());
    }
    if random.below(2) == 0 && body.face_count() < 100 {
        body.split_all(None).unwrap();
    }
    let mut editor = Editor::new(body);
    let mut states = vec![editor.body().clone()];
    let before = shape(editor.body());
    for _ in 0..steps {
        let done = step(&mut editor, &mut random, guard);
        assert_eq!(editor.undo_len(), states.len() - usize::from(!done));
        if !done {
            assert_eq!(editor.body(), states.last().unwrap());
            continue;
        }
        topology_sound(editor.body());
        assert_eq!(shape(editor.body()), before);
        states.push(editor.body().clone());
    }
    for state in states.iter().rev().skip(1) {
        assert!(editor.undo());
        assert_eq!(editor.body(), state);
    }
    for state in &states[1..] {
        assert!(editor.redo());
        assert_eq!(editor.body(), state);
    }
    let mut body = editor.into_body();
    body.compact();
    topology_sound(&body);
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, ..ProptestConfig::default() })]

    #[test]
    fn what_is_done_can_be_undone(kind in 0u8..5, seed: u64, steps in 1usize..60, guard: bool) {
        run(kind, seed, steps, if guard { Guard::NoTurn } else { Guard::None }, seed % 3 == 0);
    }
}

/// The same for longer: `TOILE_CASES` bodies, from `TOILE_SEED` on.
#[test]
#[ignore = "long"]
fn many_random_bodies() {
    let number = |name: &str, or: u64| std::env::var(name).map_or(or, |v| v.parse().unwrap());
    let (first, cases) = (number("TOILE_SEED", 0), number("TOILE_CASES", 10_000));
    for seed in first..first + cases {
        let mut random = Random(seed);
        let (kind, steps) = (random.below(5) as u8, 1 + random.below(60));
        let guard = [Guard::None, Guard::NoTurn][random.below(2)];
        let ran = std::panic::catch_unwind(|| run(kind, seed, steps, guard, seed % 3 == 0));
        assert!(ran.is_ok(), "seed {seed}");
    }
}
