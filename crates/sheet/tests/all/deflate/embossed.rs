//! Plates with small things on one side: engraved and embossed signs.

use std::collections::BTreeSet;

use crate::deflate::solid_models::turned;
use mesh_kernel::TriMesh;
use mesh_kernel::glam::DVec3;
use sheet::deflate::{DeflateOptions, Deflated, Nobody, Steps, deflate};

const CELL: f64 = 2.2;
const PLATE: f64 = 2.0;
/// Where signs are on the plate, a cell a letter.
const SIGNS: [&str; 13] = [
    "............................",
    "............................",
    "..x......xxxxx..x...x..x....",
    "..x......x...x..x...x..x....",
    "..x......x...x..x...x..x....",
    "..xxxxx..x...x..xxxxx..x....",
    "..x......x...x......x..x....",
    "..x......x...x......x..x....",
    "..xxxxx..xxxxx......x..x....",
    "............................",
    "............................",
    "............................",
    "............................",
];

fn is_sign(i: usize, j: usize) -> bool {
    SIGNS[j].as_bytes()[i] == b'x'
}

fn is_rim(i: usize, j: usize) -> bool {
    i == 0 || j == 0 || i == SIGNS[0].len() - 1 || j == SIGNS.len() - 1
}

/// A sign for the other side.
fn is_mirrored(i: usize, j: usize) -> bool {
    is_sign(SIGNS[0].len() - 1 - i, (j + 1).min(SIGNS.len() - 1))
}

/// Fails unless every level face lies halfway between the two heights of its cell and is as thick; the area of those in some cells.
fn area_in_the_middle(
    thin: &Deflated,
    what: &str,
    heights: impl Fn(usize, usize) -> [f64; 2],
    counts: impl Fn(usize, usize) -> bool,
) -> f64 {
    let mut sum = 0.0;
    for (f, t) in (0u32..).zip(&thin.thickness) {
        let across = thin.sheet.area_normal(f) / 2.0;
        if across.z.abs() < 0.5 * across.length() {
            continue;
        }
        let [p, q, r] = thin.sheet.corners(f);
        let middle = (p + q + r) / 3.0;
        let [i, j] = [middle.x, middle.y].map(|x| (x / CELL) as usize);
        let [low, high] = heights(i, j);
        assert!((middle.z - (low + high) / 2.0).abs() < 1e-9, "{what}: {middle} is not in the middle");
        assert!((t - (high - low)).abs() < 1e-9, "{what}: {t} mm thick at {middle}");
        sum += if counts(i, j) { across.length() } else { 0.0 };
    }
    sum
}

/// What lies between two heights over every cell; nothing where they are the same.
fn between(low: impl Fn(usize, usize) -> f64, high: impl Fn(usize, usize) -> f64) -> TriMesh {
    let (n, m) = (SIGNS[0].len(), SIGNS.len());
    let mut mesh = TriMesh::new(Vec::new(), Vec::new());
    let mut quad = |corners: [DVec3; 4]| {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(corners);
        mesh.faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
    };
    let at = |i: usize, j: usize, z: f64| DVec3::new(CELL * i as f64, CELL * j as f64, z);
    for i in 0..n {
        for j in 0..m {
            let [bottom, top] = [low(i, j), high(i, j)];
            if bottom >= top {
                continue;
            }
            quad([at(i, j, top), at(i + 1, j, top), at(i + 1, j + 1, top), at(i, j + 1, top)]);
            quad([at(i, j, bottom), at(i, j + 1, bottom), at(i + 1, j + 1, bottom), at(i + 1, j, bottom)]);
        }
    }
    // Upright faces between cells: where one is filled and the other is not.
    let levels: BTreeSet<u64> = (0..n * m)
        .flat_map(|k| [low(k % n, k / n), high(k % n, k / n)])
        .map(|z| (z * SCALE).round() as u64)
        .collect();
    let levels: Vec<f64> = levels.into_iter().map(|z| z as f64 / SCALE).collect();
    let mut upright = |a: [usize; 2], b: [usize; 2], from: Option<[usize; 2]>, to: Option<[usize; 2]>| {
        for pair in levels.windows(2) {
            let z = (pair[0] + pair[1]) / 2.0;
            let fills = |cell: [usize; 2]| (low(cell[0], cell[1])..high(cell[0], cell[1])).contains(&z);
            let (from, to) = (from.is_some_and(fills), to.is_some_and(fills));
            let ([a, b], [low, high]) = (if to { [a, b] } else { [b, a] }, [pair[0], pair[1]]);
            if from != to {
                quad([at(a[0], a[1], low), at(b[0], b[1], low), at(b[0], b[1], high), at(a[0], a[1], high)]);
            }
        }
    };
    for i in 0..=n {
        for j in 0..m {
            let [west, east] = [i.checked_sub(1), (i < n).then_some(i)].map(|c| Some([c?, j]));
            upright([i, j + 1], [i, j], west, east);
        }
    }
    for j in 0..=m {
        for i in 0..n {
            let [south, north] = [j.checked_sub(1), (j < m).then_some(j)].map(|c| Some([i, c?]));
            upright([i, j], [i + 1, j], south, north);
        }
    }
    mesh
}

/// Levels are told apart to this part of a millimetre.
const SCALE: f64 = 1e6;

/// A plate whose signs are so high, from below.
fn plate(signs: f64) -> TriMesh {
    between(|_, _| 0.0, |i, j| if is_sign(i, j) { signs } else { PLATE })
}

/// A tray whose signs are so thick, seen from outside.
fn tray(signs: f64) -> TriMesh {
    let low = move |i, j| FLOOR + PLATE - if is_sign(i, j) { signs } else { PLATE };
    between(low, move |i, j| FLOOR + PLATE + if is_rim(i, j) { 20.0 } else { 0.0 })
}

/// Where the tray stands: levels are not below 0.
const FLOOR: f64 = 5.0;

#[test]
fn signs_on_a_plate_are_steps() {
    for signs in [1.2, 1.6, 2.4, 2.8] {
        let solid = plate(signs);
        let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        let what = format!("signs {signs}");
        assert_eq!((r.self_intersections, r.lost_edges, r.components), (0, 0, 1), "{what}");
        // Every cell is in the middle of its own thickness.
        let heights = |i, j| [0.0, if is_sign(i, j) { signs } else { PLATE }];
        let [of_signs, of_plate] =
            [true, false].map(|sign| area_in_the_middle(&thin, &what, heights, |i, j| is_sign(i, j) == sign));
        let cells = |sign: bool| {
            let all = (0..SIGNS.len()).flat_map(|j| (0..SIGNS[0].len()).map(move |i| is_sign(i, j)));
            all.filter(|s| *s == sign).count() as f64 * CELL * CELL
        };
        assert!((of_signs - cells(true)).abs() < 1e-6, "{what}: {of_signs} mm² of {}", cells(true));
        assert!((of_plate - cells(false)).abs() < 1e-6, "{what}: {of_plate} mm² of {}", cells(false));
        let other = deflate(&turned(&solid), &DeflateOptions::default(), &Nobody).unwrap();
        assert!((other.report.area / r.area - 1.0).abs() < 1e-6, "{what}");
    }
}

#[test]
fn signs_on_the_outside_of_a_tray_are_steps() {
    for signs in [1.2, 1.6, 2.4, 2.8] {
        let thin = deflate(&tray(signs), &DeflateOptions::default(), &Nobody).unwrap();
        let r = &thin.report;
        let what = format!("signs {signs}");
        assert_eq!((r.self_intersections, r.lost_edges, r.components), (0, 0, 1), "{what}");
        assert_eq!((r.joints, r.free_loops), (0, 1), "{what}");
        let heights = |i, j| [FLOOR + PLATE - if is_sign(i, j) { signs } else { PLATE }, FLOOR + PLATE];
        let of_signs = area_in_the_middle(&thin, &what, heights, is_sign);
        let cells = SIGNS.concat().matches('x').count() as f64 * CELL * CELL;
        assert!((of_signs - cells).abs() < 1e-6, "{what}: {of_signs} mm² of {cells}");
    }
}

/// The side of a round pocket may have nodes between its edges, and facets that run to them from several nodes of an edge.
#[test]
fn sides_of_round_pockets_follow_their_edges() {
    const TURNS: u32 = 96;
    const OUTER: f64 = 30.0;
    const POCKET: f64 = 10.0;
    let floor = 1.2;
    // Rings of nodes from the middle of the bottom to the middle of the floor; of those between the edges some have half as many.
    let between = |s: f64| PLATE + (floor - PLATE) * s;
    let rings = [
        (OUTER, 0.0, 1),
        (OUTER, PLATE, 1),
        (POCKET, PLATE, 1),
        (POCKET, between(0.25), 2),
        (POCKET, between(0.5), 1),
        (POCKET, between(0.75), 2),
        (POCKET, floor, 1),
    ];
    let mut mesh = TriMesh::new(vec![DVec3::ZERO, DVec3::new(0.0, 0.0, floor)], Vec::new());
    let mut rows: Vec<Vec<u32>> = Vec::new();
    for (radius, z, every) in rings {
        let node = |k: u32| {
            let angle = f64::from(k * every) * std::f64::consts::TAU / f64::from(TURNS);
            mesh.positions.push(DVec3::new(radius * angle.cos(), radius * angle.sin(), z));
            mesh.positions.len() as u32 - 1
        };
        rows.push((0..TURNS / every).map(node).collect());
    }
    let ring = |row: &[u32], k: usize| row[k * row.len() / TURNS as usize % row.len()];
    for k in 0..TURNS as usize {
        let mut face = |face: [u32; 3]| {
            if face[0] != face[1] && face[1] != face[2] && face[2] != face[0] {
                mesh.faces.push(face);
            }
        };
        face([0, ring(&rows[0], k + 1), ring(&rows[0], k)]);
        for pair in rows.windows(2) {
            let [a, b] = [k, k + 1].map(|k| ring(&pair[0], k));
            let [c, d] = [k, k + 1].map(|k| ring(&pair[1], k));
            face([a, b, d]);
            face([a, d, c]);
        }
        face([1, ring(&rows[6], k), ring(&rows[6], k + 1)]);
    }
    let thin = deflate(&mesh, &DeflateOptions::default(), &Nobody).unwrap();
    let r = &thin.report;
    assert_eq!((r.self_intersections, r.components, r.free_loops), (0, 1, 1));
    let middles = floor / 2.0 - 1e-9..PLATE / 2.0 + 1e-9;
    assert!(thin.sheet.positions.iter().all(|p| middles.contains(&p.z)), "a node is not between the middles");
    // Area of a regular polygon about a circle of this radius.
    let disc = |radius: f64| {
        f64::from(TURNS) / 2.0 * (std::f64::consts::TAU / f64::from(TURNS)).sin() * radius * radius
    };
    let of = |t: f64| {
        let areas = (0u32..).zip(&thin.thickness).filter(|(_, own)| (*own - t).abs() < 1e-9);
        areas
            .map(|(f, _)| thin.sheet.area_normal(f))
            .filter(|n| n.z.abs() > 0.9 * n.length())
            .map(|n| n.length() / 2.0)
            .sum::<f64>()
    };
    assert!((of(floor) / disc(POCKET) - 1.0).abs() < 1e-2, "{} mm² of {}", of(floor), disc(POCKET));
    assert!((of(PLATE) / (disc(OUTER) - disc(POCKET)) - 1.0).abs() < 1e-2, "{} mm²", of(PLATE));
}

/// Engraved and embossed on both sides, over each other and beside each other.
#[test]
fn signs_on_both_sides_are_steps() {
    for (below, above) in [(0.5, 0.4), (0.5, -0.5), (-0.3, 0.6), (-0.4, -0.6)] {
        for walls in [0.0, 20.0] {
            let what = format!("{below} below, {above} above, walls {walls}");
            let low = |i, j| FLOOR + if is_mirrored(i, j) { below } else { 0.0 };
            let high = |i, j| FLOOR + PLATE - if is_sign(i, j) { above } else { 0.0 };
            let solid = between(low, |i, j| high(i, j) + if is_rim(i, j) { walls } else { 0.0 });
            let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
            let r = &thin.report;
            assert_eq!((r.self_intersections, r.lost_edges, r.components), (0, 0, 1), "{what}");
            // Cells that touch at a corner only and step the same way have an upright edge in common, of four steps.
            let joints = if (below > 0.0) == (above > 0.0) { 0 } else { r.joints };
            assert_eq!((r.joints, r.free_loops), (joints, 1), "{what}");
            let covered = area_in_the_middle(&thin, &what, |i, j| [low(i, j), high(i, j)], |_, _| true);
            let short = if walls > 0.0 { CELL } else { 0.0 };
            let [width, depth] = [SIGNS[0].len(), SIGNS.len()].map(|n| n as f64 * CELL - short);
            assert!((covered - width * depth).abs() < 1e-6, "{what}: {covered} mm² of {}", width * depth);
            let other = deflate(&turned(&solid), &DeflateOptions::default(), &Nobody).unwrap();
            let o = &other.report;
            assert_eq!((o.self_intersections, o.joints, o.free_loops), (0, r.joints, 1), "{what}, turned");
            assert!((o.area / r.area - 1.0).abs() < 1e-6, "{what}: {} mm² turned, {}", o.area, r.area);
        }
    }
}

#[test]
fn signs_on_both_sides_obey_what_is_said_of_steps() {
    let solid = between(
        |i, j| FLOOR + if is_mirrored(i, j) { 0.5 } else { 0.0 },
        |i, j| FLOOR + PLATE - if is_sign(i, j) { 0.4 } else { 0.0 },
    );
    let area = (SIGNS[0].len() * SIGNS.len()) as f64 * CELL * CELL;
    let with =
        |steps| deflate(&solid, &DeflateOptions { steps, ..DeflateOptions::default() }, &Nobody).unwrap();
    let apart = with(Steps::Apart).report;
    assert!(apart.components > 1, "{} parts", apart.components);
    assert_eq!((apart.steps, apart.self_intersections, apart.lost_edges), (0, 0, 0));
    assert!((apart.area - area).abs() < 1e-6, "{} mm² of {area}", apart.area);
    let aligned = with(Steps::Aligned);
    let r = &aligned.report;
    assert_eq!((r.components, r.steps, r.self_intersections, r.lost_edges), (1, 0, 0, 0));
    assert!((r.area - area).abs() < 1e-6, "{} mm² of {area}", r.area);
    let middle = FLOOR + PLATE / 2.0;
    assert!(aligned.sheet.positions.iter().all(|p| (p.z - middle).abs() < 1e-9));
    let volume: f64 =
        (0u32..).zip(&aligned.thickness).map(|(f, t)| aligned.sheet.area_normal(f).length() / 2.0 * t).sum();
    assert!((volume / r.solid_volume - 1.0).abs() < 1e-9, "{} of the volume", volume / r.solid_volume);
}

/// A leaf goes on beyond the rim of a wall, set off on one side, and overlaps it on the other one: steps on both sides, and the wall's end
/// is a step where the leaf begins.
#[test]
fn a_leaf_that_goes_on_beyond_a_rim_is_joined_to_it_once() {
    let rim = SIGNS.len() / 2;
    let is_leaf = |i: usize| (8..14).contains(&i);
    let heights = |i: usize, j: usize| match (is_leaf(i), j) {
        (true, 2..4) => [0.0, PLATE + 0.5],
        (false, j) if j < rim => [0.0, PLATE],
        (true, j) if j < rim => [0.0, PLATE + 0.5],
        (true, j) if j < rim + 5 => [0.7, PLATE + 0.5],
        _ => [0.0, 0.0],
    };
    let heights = |i: usize, j: usize| if j < 2 { [0.0, PLATE] } else { heights(i, j) };
    // Two ribs that end at the rim as well.
    let is_rib = |i: usize, j: usize| [3, 20].contains(&i) && j < rim;
    let high = |i: usize, j: usize| if is_rib(i, j) { 20.0 } else { heights(i, j)[1] };
    let solid = between(|i, j| heights(i, j)[0], high);
    let thin = deflate(&solid, &DeflateOptions::default(), &Nobody).unwrap();
    let r = &thin.report;
    assert_eq!((r.self_intersections, r.lost_edges, r.components), (0, 0, 1));
    let area = area_in_the_middle(&thin, "leaf", heights, |_, _| true);
    let cells = (SIGNS[0].len() * rim + 6 * 5) as f64 * CELL * CELL;
    assert!((area - cells).abs() < 1e-9, "{area} mm² of {cells}");
    // Two steps beside the leaf, one at its lower end, and one where it goes on.
    assert_eq!((r.patches, r.steps, r.joints), (11, 4, 2));
}
