//! Pieces: allowances and corners, notches across seams, grain, folds, layout.

use crate::surfaces::{column, grid};
use glam::{DVec2, DVec3};
use pattern::*;

fn square(side: f64) -> Patch {
    grid("square", 8, 8, |u, v| DVec3::new(side * u, side * v, 0.0))
}

/// An L of two arms, 200 long and 80 wide.
fn ell() -> Patch {
    let mut patch = grid("ell", 5, 5, |u, v| DVec3::new(200.0 * u, 200.0 * v, 0.0));
    patch.faces.retain(|f| {
        let c = f.iter().map(|&v| patch.positions[v as usize]).sum::<DVec3>() / 3.0;
        c.x < 80.0 || c.y < 80.0
    });
    patch
}

fn piece(patch: Patch) -> Piece {
    let input = PatternInput { patches: vec![patch], ..PatternInput::default() };
    make(&input, &PatternOptions::default()).unwrap().pieces.remove(0)
}

fn area(points: &[DVec2]) -> f64 {
    (0..points.len()).map(|i| 0.5 * points[i].perp_dot(points[(i + 1) % points.len()])).sum()
}

fn with_edges(mut patch: Patch, edges: Vec<EdgeSpec>) -> Patch {
    patch.piece.edges = edges;
    patch
}

fn edge(nodes: Vec<u32>, allowance_mm: f64, corner: CornerStyle) -> EdgeSpec {
    EdgeSpec { chain: EdgeChain::Nodes(nodes), allowance_mm, corner }
}

/// Bottom row of the 8 × 8 square.
fn hem() -> Vec<u32> {
    (0..=8).map(|i| i * 9).collect()
}

#[test]
fn a_square_grows_by_its_allowance_with_sharp_corners() {
    let piece = piece(square(200.0));
    let sewn = piece.sew[0].points();
    assert!((area(&sewn) - 40_000.0).abs() < 1e-3);
    assert_eq!(piece.sew[0].chains.len(), 4);
    assert!(piece.sew[0].chains.iter().all(|c| (c.length - 200.0).abs() < 1e-6));
    assert_eq!(piece.cut.len(), 1);
    assert!((area(&piece.cut[0].points) - 220.0 * 220.0).abs() < 0.01, "{}", area(&piece.cut[0].points));
    assert_eq!(piece.cut[0].points.len(), 4, "straight sides need no points");
    assert!(piece.cut[0].corner.iter().all(|c| *c));
}

#[test]
fn small_pieces_have_outlines_too() {
    for side in [1e-3, 0.3, 1.0, 3.0] {
        for allowance_mm in [0.0, 0.1 * side, 10.0] {
            let mut patch = square(side);
            patch.piece.allowance_mm = allowance_mm;
            let piece = piece(patch);
            let wide = side + 2.0 * allowance_mm;
            assert_eq!(piece.cut.len(), 1);
            let off = area(&piece.cut[0].points) / (wide * wide) - 1.0;
            assert!(off.abs() < 1e-3, "{side} mm with {allowance_mm} mm: {off}");
        }
    }
    // A disk of 0.2 mm across stays one, whatever the tolerance of lines.
    let disk = grid("disk", 1, 40, |u, v| (0.1 * (1.0 - 0.9 * u) * DVec2::from_angle(6.0 * v)).extend(0.0));
    assert!(piece(disk).sew[0].points().len() > 20);
}

#[test]
fn small_holes_are_cut_where_nothing_is_added() {
    let mut plate = grid("plate", 30, 30, |u, v| DVec3::new(15.0 * u, 15.0 * v, 0.0));
    plate.faces.retain(|f| {
        let c = f.iter().map(|&v| plate.positions[v as usize]).sum::<DVec3>() / 3.0;
        (c - DVec3::new(5.25, 5.25, 0.0)).abs().max_element() > 0.25
    });
    plate.piece.allowance_mm = 0.0;
    let piece = piece(plate);
    assert_eq!(piece.cut.len(), 2);
    assert!((area(&piece.cut[1].points) + 0.25).abs() < 1e-6);
}

#[test]
fn an_inward_corner_has_no_wedge() {
    let piece = piece(ell());
    let cut = &piece.cut[0];
    // The L, its six sides offset by 10: outward corners square, the inward one too.
    assert!((area(&piece.sew[0].points()) - (2.0 * 200.0 * 80.0 - 6_400.0)).abs() < 1e-3);
    assert!((area(&cut.points) - (220.0 * 220.0 - 120.0 * 120.0)).abs() < 0.05, "{}", area(&cut.points));
    assert_eq!(cut.points.len(), 6);
}

#[test]
fn corners_take_the_style_asked_for() {
    let cut = |style| {
        let piece = piece(with_edges(square(200.0), vec![edge(hem(), 30.0, style)]));
        (area(&piece.cut[0].points), piece.cut[0].points.len())
    };
    // Mitre: 220 × (200 + 10 + 30).
    let (mitre, points) = cut(CornerStyle::Mitre);
    assert!((mitre - 220.0 * 240.0).abs() < 0.02 && points == 4, "{mitre} {points}");
    // Bevel at the hem's two corners: two triangles of 10 × 30 / 2 less.
    let (bevel, points) = cut(CornerStyle::Bevel);
    assert!((bevel - (mitre - 300.0)).abs() < 0.02 && points == 6, "{bevel} {points}");
    // At a right angle the square and the mirrored corner are the mitre.
    for style in [CornerStyle::Square, CornerStyle::Mirrored] {
        let (a, _) = cut(style);
        assert!((a - mitre).abs() < 0.02, "{style:?} {a} {mitre}");
    }
}

#[test]
fn a_mirrored_hem_lies_flush_when_folded_back() {
    // A skirt that widens downward: the hem's allowance must narrow below the hem line.
    let skirt = grid("skirt", 8, 8, |u, v| {
        let half = 250.0 - 160.0 * v;
        DVec3::new((2.0 * u - 1.0) * half, 300.0 * v, 0.0)
    });
    let hem: Vec<u32> = (0..=8).map(|i| i * 9).collect();
    let piece = piece(with_edges(skirt, vec![edge(hem, 40.0, CornerStyle::Mirrored)]));
    let low = piece.sew[0].points().iter().map(|p| p.y).fold(f64::INFINITY, f64::min);
    let width_at = |y: f64| {
        let points = &piece.cut[0].points;
        let hits: Vec<f64> = (0..points.len())
            .filter_map(|i| {
                let (a, b) = (points[i], points[(i + 1) % points.len()]);
                ((a.y > y) != (b.y > y)).then(|| a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x))
            })
            .collect();
        hits.iter().fold(f64::NEG_INFINITY, |m, x| m.max(*x))
            - hits.iter().fold(f64::INFINITY, |m, x| m.min(*x))
    };
    for d in [5.0, 20.0, 35.0] {
        let (below, above) = (width_at(low - d), width_at(low + d));
        assert!((below - above).abs() < 0.1, "{d} mm off the hem: {below} below, {above} above");
    }
}

#[test]
fn a_narrow_slot_closes_without_crossing() {
    // A U with a slot of 12 mm: its allowances of 10 mm meet and swallow the slot.
    let mut u = grid("u", 10, 10, |u, v| DVec3::new(120.0 * u, 120.0 * v, 0.0));
    u.faces.retain(|f| {
        let c = f.iter().map(|&v| u.positions[v as usize]).sum::<DVec3>() / 3.0;
        !(c.x > 48.0 && c.x < 60.0 && c.y > 36.0)
    });
    let piece = piece(u);
    assert_eq!(piece.cut.len(), 1);
    assert!((area(&piece.cut[0].points) - 140.0 * 140.0).abs() < 0.05, "{}", area(&piece.cut[0].points));
}

#[test]
fn a_neck_hole_is_cut_smaller() {
    let ring = crate::surfaces::tube("ring", 60, 4, |u, v| {
        let (s, c) = (std::f64::consts::TAU * u).sin_cos();
        let r = 200.0 - 100.0 * v;
        DVec3::new(r * c, 0.0, -r * s)
    });
    let piece = piece(ring);
    assert_eq!((piece.sew.len(), piece.cut.len()), (2, 2));
    let [outer, hole] = [area(&piece.cut[0].points), area(&piece.cut[1].points)];
    let circle = |r: f64| std::f64::consts::PI * r * r;
    assert!((outer / circle(210.0) - 1.0).abs() < 0.01, "{outer}");
    assert!((hole / -circle(90.0) - 1.0).abs() < 0.01, "{hole}");
}

#[test]
fn notches_stand_on_both_sides_of_a_seam_at_the_same_distance() {
    let curved = |name: &str, from: f64, to: f64| {
        grid(name, 8, 20, |u, v| {
            let (s, c) = (from + (to - from) * u).sin_cos();
            let r = 110.0 + 25.0 * (3.0 * v).sin();
            DVec3::new(r * s, 300.0 * v, r * c)
        })
    };
    let patches = vec![curved("front", 0.0, 0.8), curved("back", 0.8, 1.6)];
    let sides =
        vec![SeamSide { patch: 0, nodes: column(20, 8) }, SeamSide { patch: 1, nodes: column(20, 0) }];
    let seams = vec![SeamInput { name: "side".to_owned(), sides }];
    let mark = |k: usize, kind| Mark { patch: 0, node: column(20, 8)[k], kind, name: format!("n{k}") };
    let drill = Mark { patch: 1, node: column(20, 4)[10], kind: MarkKind::Drill, name: "pocket".to_owned() };
    let marks = vec![mark(6, MarkKind::Notch), mark(13, MarkKind::DoubleNotch), drill];
    let input = PatternInput { patches, seams, marks, ..PatternInput::default() };
    let pattern = make(&input, &PatternOptions::default()).unwrap();
    let [front, back] = &pattern.pieces[..] else { panic!() };
    assert_eq!((front.notches.len(), back.notches.len()), (2, 2));
    assert!(pattern.seams[0].notch_mismatch < 0.5);
    for (a, b) in front.notches.iter().zip(&back.notches) {
        assert_eq!((&a.name, a.kind), (&b.name, b.kind));
        assert!((a.along.unwrap() - b.along.unwrap()).abs() < 0.01);
        for n in [a, b] {
            assert!((n.cut.distance(n.sew) - 10.0).abs() < 0.2, "on the cut line, an allowance away");
            assert!((n.inward.length() - 1.0).abs() < 1e-9);
            assert_eq!(n.slits.len(), if n.kind == MarkKind::DoubleNotch { 2 } else { 1 });
        }
    }
    assert_eq!(back.drills.len(), 1);
}

#[test]
fn grain_is_vertical_and_faces_are_up() {
    // A patch that lies askew in space, its grain given.
    let grain = DVec3::new(1.0, 2.0, 0.5).normalize();
    let across = grain.any_orthonormal_vector();
    let mut patch = grid("askew", 6, 6, |u, v| 100.0 * u * across + 240.0 * v * grain);
    patch.grain = Some(grain);
    let piece = piece(patch.clone());
    let [low, high] = piece.sew[0]
        .points()
        .iter()
        .fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[l, h], p| [l.min(*p), h.max(*p)]);
    assert!((high - low - DVec2::new(100.0, 240.0)).abs().max_element() < 1e-6, "{low} {high}");
    assert!(piece.grain[0].x == piece.grain[1].x && piece.grain[1].y > piece.grain[0].y);
    assert!(area(&piece.sew[0].points()) > 0.0, "the outside of the cloth is up");
    let input = PatternInput { patches: vec![patch], ..PatternInput::default() };
    let flat = &make(&input, &PatternOptions::default()).unwrap().flats[0];
    for f in 0..flat.faces.len() {
        let [a, b, c] = flat.corners(f);
        assert!((b - a).perp_dot(c - a) > 0.0);
    }
}

#[test]
fn a_fold_gets_no_allowance() {
    let mut patch = square(200.0);
    patch.piece.on_fold = Some(column(8, 0));
    let piece = piece(patch);
    assert!((area(&piece.cut[0].points) - 210.0 * 220.0).abs() < 0.05, "{}", area(&piece.cut[0].points));
    let fold = piece.fold.unwrap();
    assert!((fold[0].distance(*fold.last().unwrap()) - 200.0).abs() < 1e-6);
}

#[test]
fn the_layout_keeps_pieces_apart_and_on_the_cloth() {
    let patches: Vec<Patch> = (0..14)
        .map(|i| {
            let (w, h) = (80.0 + 37.0 * f64::from(i % 5), 120.0 + 61.0 * f64::from(i % 4));
            let mut p = grid("p", 3, 3, |u, v| DVec3::new(w * u, h * v, 0.0));
            p.name = format!("piece {i}");
            p
        })
        .collect();
    let options = PatternOptions { fabric_width_mm: 900.0, ..PatternOptions::default() };
    let pattern = make(&PatternInput { patches, ..PatternInput::default() }, &options).unwrap();
    let boxes: Vec<[DVec2; 2]> = pattern
        .pieces
        .iter()
        .zip(&pattern.layout.offsets)
        .map(|(p, o)| {
            let points = p.cut[0].points.iter().map(|q| *q + *o);
            points.fold([DVec2::INFINITY, DVec2::NEG_INFINITY], |[l, h], p| [l.min(p), h.max(p)])
        })
        .collect();
    let mut used = 0.0;
    for (i, [l, h]) in boxes.iter().enumerate() {
        used += (*h - *l).element_product();
        assert!(l.min_element() >= 0.0 && h.x <= 900.0 && h.y <= pattern.layout.length);
        for [m, k] in &boxes[..i] {
            assert!(h.x <= m.x || k.x <= l.x || h.y <= m.y || k.y <= l.y, "pieces lie on each other");
        }
    }
    assert!(used > 0.6 * 900.0 * pattern.layout.length, "{}", used / (900.0 * pattern.layout.length));
}

/// Whether a closed polygon crosses itself by more than a rounding error; touching is allowed.
fn crosses_itself(points: &[DVec2]) -> bool {
    let n = points.len();
    let off = |a: DVec2, b: DVec2, c: DVec2| (b - a).perp_dot(c - a) / a.distance(b);
    let opposite = |p: f64, q: f64| p * q < 0.0 && p.abs().min(q.abs()) > 1e-5;
    (0..n).any(|i| {
        (i + 2..n).filter(|j| (j + 1) % n != i).any(|j| {
            let (a, b, c, d) = (points[i], points[i + 1], points[j], points[(j + 1) % n]);
            opposite(off(a, b, c), off(a, b, d)) && opposite(off(c, d, a), off(c, d, b))
        })
    })
}

proptest::proptest! {
    #![proptest_config(proptest::prelude::ProptestConfig { cases: 60, ..Default::default() })]

    /// Whatever the outline and the widths: the cut line is simple and encloses the sewing line.
    #[test]
    fn cut_lines_are_simple(
        radii in proptest::collection::vec(20.0f64..200.0, 5..40),
        widths in proptest::collection::vec(0.0f64..40.0, 40),
        styles in proptest::collection::vec(0usize..4, 40),
    ) {
        // A star: a fan about its middle.
        let n = radii.len();
        let mut patch = Patch { name: "star".to_owned(), ..Patch::default() };
        patch.positions.push(DVec3::ZERO);
        for (i, r) in radii.iter().enumerate() {
            let (s, c) = (std::f64::consts::TAU * i as f64 / n as f64).sin_cos();
            patch.positions.push(DVec3::new(r * c, r * s, 0.0));
        }
        let rim = |i: usize| (1 + i % n) as u32;
        patch.faces = (0..n).map(|i| [0, rim(i), rim(i + 1)]).collect();
        let all = [CornerStyle::Mitre, CornerStyle::Bevel, CornerStyle::Square, CornerStyle::Mirrored];
        patch.piece.edges =
            (0..n).map(|i| edge(vec![rim(i), rim(i + 1)], widths[i], all[styles[i]])).collect();
        let piece = piece(patch);
        proptest::prop_assert!(!crosses_itself(&piece.cut[0].points));
        let (cut, sewn) = (area(&piece.cut[0].points), area(&piece.sew[0].points()));
        proptest::prop_assert!(cut >= sewn - 0.2, "{} {}", cut, sewn);
        proptest::prop_assert_eq!(piece.cut[0].points.len(), piece.cut[0].corner.len());
    }
}
