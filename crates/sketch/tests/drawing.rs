//! Drawings under edits: shapes keep their form, joins stay joined, what is refused changes nothing.

#![allow(clippy::unwrap_used)] // A test that cannot go on fails.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec2;
use proptest::prelude::*;
use sketch::{
    Curve, Drawing, DrawingError, Outline, Path, PointId, Rule, ShapeId, SnapKind, SnapOptions, crossings,
};

fn v(x: f64, y: f64) -> DVec2 {
    DVec2::new(x, y)
}

fn points<const N: usize>(drawing: &mut Drawing, at: [DVec2; N]) -> [PointId; N] {
    at.map(|p| drawing.add_point(p).unwrap())
}

/// A square of 100 mm: its corners and sides.
fn square() -> (Drawing, [PointId; 4], [ShapeId; 4]) {
    let mut drawing = Drawing::default();
    let corners = points(&mut drawing, [v(0.0, 0.0), v(100.0, 0.0), v(100.0, 100.0), v(0.0, 100.0)]);
    let sides = [0, 1, 2, 3].map(|k| drawing.add_line(corners[k], corners[(k + 1) % 4]).unwrap());
    (drawing, corners, sides)
}

/// Farthest that samples of a curve are from others.
fn apart(curve: &Curve, others: &[Curve]) -> f64 {
    (0..=100)
        .map(|k| curve.point(f64::from(k) / 100.0))
        .map(|p| others.iter().map(|o| o.nearest(p).distance).fold(f64::INFINITY, f64::min))
        .fold(0.0, f64::max)
}

fn snap(radius: f64) -> SnapOptions {
    SnapOptions { radius, grid: None, from: None, moving: None }
}

#[test]
fn split_shapes_are_the_same_curve() {
    let mut drawing = Drawing::default();
    let [a, b, c, d, e] =
        points(&mut drawing, [v(0.0, 0.0), v(50.0, 0.0), v(90.0, 40.0), v(120.0, 0.0), v(160.0, 30.0)]);
    let shapes = [
        drawing.add_line(a, b).unwrap(),
        drawing.add_arc(b, v(60.0, 30.0), c).unwrap(),
        drawing.add_bezier(c, v(100.0, 70.0), v(130.0, -40.0), d).unwrap(),
    ];
    for (k, shape) in shapes.into_iter().enumerate() {
        let before = drawing.curve(shape).unwrap();
        drawing.split(shape, 0.3).unwrap();
        let halves: Vec<Curve> =
            [shape, drawing.shapes().last().unwrap().0].map(|id| drawing.curve(id).unwrap()).to_vec();
        assert!(apart(&before, &halves) < 1e-6, "{k}: {}", apart(&before, &halves));
        let length: f64 = halves.iter().map(Curve::length).sum();
        assert!((length - before.length()).abs() < 1e-6 * length, "{k}");
    }
    // A spline gets a point first, and falls apart there the second time.
    let spline = drawing.add_spline(&[a, c, d, e]).unwrap();
    let count = drawing.shapes().count();
    drawing.split(spline, 0.4).unwrap();
    assert_eq!((drawing.shapes().count(), drawing.shape(spline).unwrap().points().len()), (count, 5));
    let Curve::Spline { at, .. } = drawing.curve(spline).unwrap() else { panic!() };
    drawing.split(spline, at[2]).unwrap();
    assert_eq!(drawing.shapes().count(), count + 1);
}

#[test]
fn what_is_joined_moves_together() {
    let (mut drawing, corners, sides) = square();
    drawing.move_point(corners[2], v(140.0, 90.0)).unwrap();
    assert_eq!(drawing.curve(sides[1]).unwrap().end(), v(140.0, 90.0));
    assert_eq!(drawing.curve(sides[2]).unwrap().start(), v(140.0, 90.0));
    let [outline] = &drawing.outlines().unwrap()[..] else { panic!() };
    let path = Path::of(outline).unwrap();
    assert!(path.closed && path.curves.len() == 4);
    // Points on each other lose a side its length.
    let before = drawing.clone();
    assert!(drawing.move_point(corners[0], v(100.0, 0.0)).is_err());
    assert!(drawing.merge(corners[0], corners[1]).is_err());
    assert_eq!(drawing, before);
    // A corner that is merged closes a row of lines to a triangle.
    drawing.delete_shape(sides[3]).unwrap();
    drawing.merge(corners[0], corners[3]).unwrap();
    let [outline] = &drawing.outlines().unwrap()[..] else { panic!() };
    let path = Path::of(outline).unwrap();
    assert!(path.closed && path.curves.len() == 3);
}

#[test]
fn smooth_points_stay_smooth() {
    let mut drawing = Drawing::default();
    let [a, b, c] = points(&mut drawing, [v(0.0, 0.0), v(50.0, 50.0), v(100.0, 0.0)]);
    let one = drawing.add_bezier(a, v(10.0, 40.0), v(30.0, 60.0), b).unwrap();
    let other = drawing.add_bezier(b, v(80.0, 30.0), v(100.0, 30.0), c).unwrap();
    drawing.set_smooth(b, true).unwrap();
    let bend =
        |d: &Drawing| d.curve(one).unwrap().tangent(1.0).angle_to(d.curve(other).unwrap().tangent(0.0)).abs();
    assert!(bend(&drawing) < 1e-12);
    let length = |d: &Drawing| {
        let Curve::Bezier { points } = d.curve(other).unwrap() else { panic!() };
        points[1].distance(points[0])
    };
    let before = length(&drawing);
    drawing.move_handle(one, 1, v(20.0, 20.0)).unwrap();
    assert!(bend(&drawing) < 1e-12 && (length(&drawing) - before).abs() < 1e-12);
    let Curve::Bezier { points } = drawing.curve(one).unwrap() else { panic!() };
    assert!(points[2].distance(v(20.0, 20.0)) < 1e-12, "the handle under the pointer is where it was put");
    drawing.move_point(b, v(60.0, 20.0)).unwrap();
    assert!(bend(&drawing) < 1e-12);
    // Two lines have nothing that could turn.
    let (mut square, corners, _) = square();
    let before = square.clone();
    assert!(matches!(square.set_smooth(corners[0], true), Err(DrawingError::Kind { .. })));
    assert_eq!(square, before);
}

#[test]
fn rounded_corners_touch_both_sides() {
    for turned in [false, true] {
        let mut drawing = Drawing::default();
        let [a, b, c] = points(&mut drawing, [v(0.0, 0.0), v(100.0, 0.0), v(160.0, 80.0)]);
        let one = if turned { drawing.add_line(b, a) } else { drawing.add_line(a, b) }.unwrap();
        let other = drawing.add_line(b, c).unwrap();
        let arc = drawing.round(b, 12.0).unwrap();
        let Curve::Arc { radius, .. } = drawing.curve(arc).unwrap() else { panic!() };
        assert!((radius - 12.0).abs() < 1e-9);
        for side in [one, other] {
            let (side, arc) = (drawing.curve(side).unwrap(), drawing.curve(arc).unwrap());
            let near = |p: DVec2, q: DVec2| p.distance(q) < 1e-9;
            let meet = [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1.0, 1.0)]
                .into_iter()
                .find(|(s, t)| near(side.point(*s), arc.point(*t)))
                .unwrap();
            assert!(side.tangent(meet.0).perp_dot(arc.tangent(meet.1)).abs() < 1e-9);
        }
        let before = drawing.clone();
        assert!(matches!(drawing.round(a, 5.0), Err(DrawingError::NotACorner { found: 1, .. })));
        assert_eq!(drawing, before);
    }
    let (mut drawing, corners, _) = square();
    match drawing.round(corners[0], 150.0) {
        Err(DrawingError::RoundTooLarge { most, .. }) => assert!((most - 100.0).abs() < 1e-9),
        other => panic!("{other:?}"),
    }
    // All four, and the outline is a rounded square.
    for corner in corners {
        drawing.round(corner, 10.0).unwrap();
    }
    let [outline] = &drawing.outlines().unwrap()[..] else { panic!() };
    let length = Path::of(outline).unwrap().length();
    assert!((length - (4.0 * 80.0 + 2.0 * PI * 10.0)).abs() < 1e-9);
}

#[test]
fn parts_are_trimmed_at_crossings_and_lines_extended_to_them() {
    let mut drawing = Drawing::default();
    let [a, b, c, d, e, f] = points(
        &mut drawing,
        [v(0.0, 0.0), v(100.0, 0.0), v(30.0, -20.0), v(30.0, 20.0), v(70.0, -20.0), v(70.0, 20.0)],
    );
    let line = drawing.add_line(a, b).unwrap();
    drawing.add_line(c, d).unwrap();
    drawing.add_line(e, f).unwrap();
    drawing.trim(line, v(50.0, 3.0)).unwrap();
    let level: Vec<[f64; 2]> = drawing
        .shapes()
        .map(|(id, _)| drawing.curve(id).unwrap())
        .filter(|c| c.start().y == 0.0 && c.end().y == 0.0)
        .map(|c| [c.start().x, c.end().x])
        .collect();
    assert_eq!(level.len(), 2);
    assert!((level[0][1] - 30.0).abs() < 1e-9 && (level[1][0] - 70.0).abs() < 1e-9);
    drawing.extend(line, 1).unwrap();
    assert!(
        (drawing.curve(line).unwrap().end() - v(70.0, 0.0)).length() < 1e-9,
        "over the line that it ended at"
    );
    assert!(matches!(drawing.extend(line, 0), Err(DrawingError::Kind { .. })), "nothing lies that way");
}

#[test]
fn curves_cross_where_they_do() {
    let circle = Curve::arc(v(0.0, 0.0), 10.0, 0.0, 2.0 * PI).unwrap();
    let line = Curve::line(v(-20.0, 6.0), v(20.0, 6.0)).unwrap();
    let found = crossings(&line, &circle);
    assert_eq!(found.len(), 2);
    assert!((found[0].at - v(-8.0, 6.0)).length() < 1e-9 && (found[1].at - v(8.0, 6.0)).length() < 1e-9);
    let wave =
        Curve::spline(&[v(0.0, 0.0), v(10.0, 10.0), v(20.0, -10.0), v(30.0, 10.0), v(40.0, 0.0)]).unwrap();
    let axis = Curve::line(v(-1.0, 1.0), v(41.0, 1.0)).unwrap();
    let found = crossings(&wave, &axis);
    assert_eq!(found.len(), 4);
    assert!(found.iter().all(|c| (c.at.y - 1.0).abs() < 1e-9 && wave.point(c.t[0]).distance(c.at) < 1e-9));
    assert!(crossings(&line, &Curve::line(v(0.0, 7.0), v(9.0, 7.0)).unwrap()).is_empty());
}

#[test]
fn rules_hold_while_points_move() {
    let (mut drawing, corners, sides) = square();
    drawing.add_rule(Rule::Level(sides[0])).unwrap();
    drawing.add_rule(Rule::Square(sides[0], sides[1])).unwrap();
    drawing.add_rule(Rule::Square(sides[1], sides[2])).unwrap();
    drawing.add_rule(Rule::Equal(sides[0], sides[1])).unwrap();
    drawing.add_rule(Rule::Parallel(sides[1], sides[3])).unwrap();
    drawing.add_rule(Rule::Length(sides[0], 60.0)).unwrap();
    for to in [v(10.0, 5.0), v(-70.0, 200.0), v(33.0, -1.0)] {
        drawing.move_point(corners[0], to).unwrap();
        assert_eq!(drawing.place(corners[0]).unwrap(), to);
        let spans = sides.map(|s| {
            let c = drawing.curve(s).unwrap();
            c.end() - c.start()
        });
        assert!(spans[0].y.abs() < 1e-4 && (spans[0].length() - 60.0).abs() < 1e-4, "{spans:?}");
        assert!((spans[1].length() - 60.0).abs() < 1e-4 && spans[0].dot(spans[1]).abs() < 1e-2, "{spans:?}");
        assert!(spans[1].perp_dot(spans[3]).abs() < 1e-2, "{spans:?}");
    }
    // A rule against the others is refused, and so is a move of what is fixed.
    let before = drawing.clone();
    match drawing.add_rule(Rule::Length(sides[1], 61.0)) {
        Err(DrawingError::Rules(..)) => {}
        other => panic!("{other:?}"),
    }
    let at = drawing.place(corners[1]).unwrap();
    assert_eq!(drawing, before);
    drawing.add_rule(Rule::Fixed(corners[1], at)).unwrap();
    assert!(matches!(drawing.move_point(corners[1], at + v(5.0, 0.0)), Err(DrawingError::Rules(..))));
    assert_eq!(drawing.place(corners[1]).unwrap(), at);
}

#[test]
fn the_pointer_snaps_to_what_it_means() {
    let mut drawing = Drawing::default();
    let [a, b, c, d, m] =
        points(&mut drawing, [v(0.0, 0.0), v(100.0, 0.0), v(20.0, -30.0), v(20.0, 30.0), v(60.0, 40.0)]);
    let level = drawing.add_line(a, b).unwrap();
    let plumb = drawing.add_line(c, d).unwrap();
    let circle = drawing.add_circle(m, 20.0).unwrap();
    let kind = |at: DVec2, options: &SnapOptions| drawing.snap(at, options).map(|s| (s.kind, s.at));
    let near = |found: Option<(SnapKind, DVec2)>, kind: SnapKind, at: DVec2| {
        let (k, p) = found.unwrap();
        assert!(k == kind && p.distance(at) < 1e-6, "{k:?} at {p}, not {kind:?} at {at}");
    };
    near(kind(v(99.0, 1.0), &snap(3.0)), SnapKind::Point(b), v(100.0, 0.0));
    near(kind(v(21.0, 1.0), &snap(3.0)), SnapKind::Crossing(level, plumb), v(20.0, 0.0));
    near(kind(v(51.0, -1.0), &snap(3.0)), SnapKind::Middle(level), v(50.0, 0.0));
    near(kind(v(77.0, 1.0), &snap(3.0)), SnapKind::On(level), v(77.0, 0.0));
    assert_eq!(kind(v(80.0, 10.0), &snap(3.0)), None);
    let grid = SnapOptions { grid: Some(10.0), ..snap(3.0) };
    near(kind(v(81.0, 11.0), &grid), SnapKind::Grid, v(80.0, 10.0));
    let from = SnapOptions { from: Some(v(90.0, 25.0)), ..snap(3.0) };
    near(kind(v(89.0, -0.5), &from), SnapKind::Foot(level), v(90.0, 0.0));
    near(kind(v(110.0, 24.0), &from), SnapKind::Level, v(110.0, 25.0));
    // The point of touch of a line from outside a circle.
    let to_center = v(60.0, 40.0) - v(90.0, 25.0);
    let angle = (20.0 / to_center.length()).asin();
    let touch = v(90.0, 25.0)
        + DVec2::from_angle(-angle).rotate(to_center.normalize())
            * (to_center.length_squared() - 400.0).sqrt();
    near(kind(touch + v(0.3, 0.4), &from), SnapKind::Touch(circle), touch);
    // A point under the pointer does not hold itself.
    let moving = SnapOptions { moving: Some(b), ..snap(3.0) };
    assert_eq!(kind(v(99.0, 1.0), &moving), None);
}

#[test]
fn outlines_become_drawings_and_come_back() {
    let outlines = [
        Outline::Rectangle { at: v(0.0, 0.0), size: v(60.0, 40.0), round: 8.0 },
        Outline::Circle { center: v(3.0, 4.0), radius: 5.0 },
        Outline::Path(vec![
            Outline::Line([v(0.0, 0.0), v(50.0, 0.0)]),
            Outline::Bezier(vec![v(50.0, 0.0), v(80.0, 10.0), v(70.0, 60.0), v(40.0, 60.0)]),
            Outline::Spline(vec![v(40.0, 60.0), v(20.0, 50.0), v(10.0, 30.0), v(0.0, 0.0)]),
        ]),
    ];
    for outline in outlines {
        let drawing = Drawing::of(&outline).unwrap();
        let [back] = &drawing.outlines().unwrap()[..] else { panic!("one outline") };
        let (one, other) = (Path::of(&outline).unwrap(), Path::of(back).unwrap());
        assert_eq!((one.closed, one.curves.len()), (other.closed, other.curves.len()));
        assert!((one.length() - other.length()).abs() < 1e-9 * one.length());
        let text = serde_json::to_string(&drawing).unwrap();
        assert_eq!(serde_json::from_str::<Drawing>(&text).unwrap(), drawing);
    }
}

#[test]
fn lines_bend_to_arcs_and_back() {
    let (mut drawing, _, sides) = square();
    drawing.bend(sides[0], v(50.0, -50.0)).unwrap();
    let Curve::Arc { radius, sweep, .. } = drawing.curve(sides[0]).unwrap() else { panic!() };
    assert!((radius - 50.0).abs() < 1e-9 && (sweep.abs() - PI).abs() < 1e-9);
    drawing.bend(sides[0], v(50.0, -50.0 * (2.0f64.sqrt() - 1.0))).unwrap();
    let Curve::Arc { sweep, .. } = drawing.curve(sides[0]).unwrap() else { panic!() };
    assert!((sweep.abs() - FRAC_PI_2).abs() < 1e-9);
    drawing.bend(sides[0], v(30.0, 0.0)).unwrap();
    assert!(matches!(drawing.curve(sides[0]).unwrap(), Curve::Line { .. }));
}

/// An edit by numbers.
#[allow(clippy::too_many_lines)]
fn edit(drawing: &mut Drawing, what: u8, i: usize, j: usize, x: f64, y: f64) -> Result<(), DrawingError> {
    let points: Vec<PointId> = drawing.points().map(|(id, _)| id).collect();
    let shapes: Vec<ShapeId> = drawing.shapes().map(|(id, _)| id).collect();
    let at = v(x, y);
    let point = |k: usize| points.get(k % points.len().max(1)).copied();
    let shape = |k: usize| shapes.get(k % shapes.len().max(1)).copied();
    let (Some(a), Some(b)) = (point(i), point(j)) else { return drawing.add_point(at).map(|_| ()) };
    let lone =
        |s: Option<ShapeId>, f: &mut dyn FnMut(ShapeId) -> Result<(), DrawingError>| s.map_or(Ok(()), f);
    match what % 18 {
        0..=2 => drawing.add_point(at).map(|_| ()),
        3 => drawing.add_line(a, b).map(|_| ()),
        4 => drawing.add_arc(a, at, b).map(|_| ()),
        5 => drawing.add_bezier(a, at, v(y, x), b).map(|_| ()),
        6 => drawing.add_spline(&[a, b, points[(i + j) % points.len()]]).map(|_| ()),
        7 => drawing.add_circle(a, x).map(|_| ()),
        8 => drawing.move_point(a, at),
        9 => lone(shape(i), &mut |s| drawing.split(s, (x / 200.0).abs()).map(|_| ())),
        10 => drawing.merge(a, b),
        11 => lone(shape(i), &mut |s| drawing.trim(s, at)),
        12 => drawing.round(a, x.abs()).map(|_| ()),
        13 => lone(shape(i), &mut |s| drawing.bend(s, at)),
        14 => drawing.set_smooth(a, j.is_multiple_of(2)),
        15 => match (shape(i), shape(j)) {
            (Some(s), Some(t)) => drawing.add_rule(match (x.abs() as u32) % 5 {
                0 => Rule::Level(s),
                1 => Rule::Length(s, y),
                2 => Rule::Parallel(s, t),
                3 => Rule::Square(s, t),
                _ => Rule::Fixed(a, at),
            }),
            _ => Ok(()),
        },
        16 => lone(shape(i), &mut |s| drawing.delete_shape(s)),
        _ => lone(shape(i), &mut |s| drawing.move_handle(s, j % 2, at).and(drawing.extend(s, j % 2))),
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(200))]
    /// Whatever is done, every shape has a curve, every point that a shape needs is there, and what was refused did nothing.
    #[test]
    fn drawings_stay_whole(
        edits in prop::collection::vec((any::<u8>(), 0usize..20, 0usize..20, -100f64..100.0, -100f64..100.0), 1..60)
    ) {
        let mut drawing = Drawing::default();
        for (what, i, j, x, y) in edits {
            let before = drawing.clone();
            if edit(&mut drawing, what, i, j, x, y).is_err() && what % 18 != 17 {
                prop_assert_eq!(&drawing, &before);
            }
            for (id, shape) in drawing.shapes() {
                prop_assert!(shape.points().iter().all(|p| drawing.place(*p).is_ok()));
                let curve = drawing.curve(id);
                prop_assert!(curve.is_ok_and(|c| c.length() > 0.0));
            }
            let _ = drawing.snap(v(x, y), &SnapOptions { radius: 10.0, grid: Some(5.0), from: Some(v(y, x)), moving: None });
        }
        for outline in drawing.outlines().unwrap() {
            let path = Path::of(&outline);
            prop_assert!(path.is_ok(), "{path:?} of {outline:?}");
        }
    }
}

#[test]
fn a_third_shape_ends_a_smooth_point() {
    let mut drawing = Drawing::default();
    let [a, b, c, d] = points(&mut drawing, [v(0.0, 0.0), v(50.0, 50.0), v(100.0, 0.0), v(50.0, 90.0)]);
    drawing.add_bezier(a, v(10.0, 40.0), v(30.0, 60.0), b).unwrap();
    drawing.add_line(b, c).unwrap();
    drawing.set_smooth(b, true).unwrap();
    drawing.add_line(b, d).unwrap();
    assert!(!drawing.is_smooth(b).unwrap());
    drawing.move_point(b, v(55.0, 45.0)).unwrap();
}

#[test]
fn damaged_drawings_are_not_read() {
    let (mut drawing, corners, sides) = square();
    drawing.add_rule(Rule::Level(sides[0])).unwrap();
    drawing.add_rule(Rule::Fixed(corners[0], v(0.0, 0.0))).unwrap();
    let text = serde_json::to_string(&drawing).unwrap();
    assert_eq!(serde_json::from_str::<Drawing>(&text).unwrap(), drawing);
    let corner = corners[3].number();
    for (good, bad) in [
        (format!("\"line\":[{corner},"), "\"line\":[77,".to_owned()),
        (format!("\"level\":{}", sides[0].number()), "\"level\":77".to_owned()),
        ("\"fixed\":[1".to_owned(), "\"fixed\":[99".to_owned()),
        ("\"smooth\":false".to_owned(), "\"smooth\":true".to_owned()),
        ("\"points\":".to_owned(), "\"dots\":".to_owned()),
    ] {
        let damaged = text.replacen(&good, &bad, 1);
        assert_ne!(damaged, text, "{good}");
        assert!(serde_json::from_str::<Drawing>(&damaged).is_err(), "{bad}");
    }
    // Numbers go on after the newest, whatever the file says.
    let low = text.replace("\"next\":8", "\"next\":1");
    assert_ne!(low, text);
    let mut read: Drawing = serde_json::from_str(&low).unwrap();
    assert_eq!(read.add_point(v(1.0, 1.0)).unwrap().number(), 9);
}
