//! The papers' examples, built by operators, with their counts.

use crate::complex::support::*;
use mesh_kernel::complex::{EdgeClass, Editor, FaceKind, Loop, NewFace, SheetCounts, SheetPlan};
use mesh_kernel::glam::DVec3;

fn sheet(editor: &Editor) -> SheetCounts {
    assert_sound(editor.complex());
    let counts = editor.complex().sheet_counts();
    assert!(counts.identity_holds());
    counts
}

/// Free edges that have two faces and more, so that "free" counts what the paper calls so.
fn bend_all(editor: &mut Editor) {
    for e in editor.complex().edges().collect::<Vec<_>>() {
        if editor.complex().uses(e).len() > 1 {
            editor.mbke(e).unwrap();
        }
    }
}

/// A tray with walls on three sides, two corners closed, a flange on seven edges, four of their corners cut.
fn bracket() -> Editor {
    let mut points = vec![
        p(0.0, 0.0, 0.0),
        p(8.0, 0.0, 0.0),
        p(8.0, 6.0, 0.0),
        p(0.0, 6.0, 0.0),
        p(0.0, 0.0, 4.0),
        p(0.0, 6.0, 4.0),
        p(8.0, 0.0, 4.0),
        p(8.0, 6.0, 4.0),
    ];
    let mut faces = vec![vec![0, 1, 2, 3], vec![0, 3, 5, 4], vec![0, 4, 6, 1], vec![3, 2, 7, 5]];
    let mut flange = |a: usize, b: usize, out: DVec3, cut: bool| {
        // Over the edge from b to a, as the old face runs from a to b.
        let (i, along) = (points.len(), (points[a] - points[b]) * 0.1);
        let new = if cut {
            vec![
                points[a] + out,
                points[a] + out * 2.0 - along,
                points[b] + out * 2.0 + along,
                points[b] + out,
            ]
        } else {
            vec![points[a] + out, points[b] + out]
        };
        let corners: Vec<usize> = [b, a].into_iter().chain(i..i + new.len()).collect();
        points.extend(new);
        faces.push(corners);
        i
    };
    // On the base's open side, the tops of the three walls, their two loose ends; a lip on the first flange.
    let first = flange(1, 2, p(0.0, 0.0, -1.0), false);
    flange(5, 4, p(-1.0, 0.0, 0.0), true);
    flange(4, 6, p(0.0, -1.0, 0.0), true);
    flange(7, 5, p(0.0, 1.0, 0.0), false);
    flange(6, 1, p(1.0, -0.5, 0.0), false);
    flange(2, 7, p(1.0, 0.5, 0.0), false);
    flange(first, first + 1, p(1.0, 0.0, 0.0), false);
    build(&points, &faces)
}

#[test]
fn bracket_of_fig_1a() {
    let mut editor = bracket();
    bend_all(&mut editor);
    // The two upright joints at the left are welds.
    let corner = |editor: &Editor, z: [f64; 2], y: f64| {
        let find = |at: DVec3| {
            editor.complex().vertices().find(|v| editor.complex().position(*v) == Some(at)).unwrap()
        };
        editor.complex().edges_between(find(p(0.0, y, z[0])), find(p(0.0, y, z[1])))[0]
    };
    for y in [0.0, 6.0] {
        let e = corner(&editor, [0.0, 4.0], y);
        editor.mwkb(e).unwrap();
    }
    let found = sheet(&editor);
    assert_eq!(found, SheetCounts { s: 1, b: 10, e: 24, w: 2, v: 26, g_nm: 0, m: 0, f: 11 });
    assert_eq!(found.redundant_joints(), 2);
    let plan = SheetPlan { mcv: 1, mev: 25, mef: 11, mgb: 0, mbke: 12, muke: 0, mwkb: 2 };
    assert_eq!(found.plan(), Some(plan));
    assert_eq!(plan.counts(), found);
    // Four holes in one facet, which the paper leaves out: rings. Its counts are the same but for their vertices and edges.
    let base = editor.complex().faces().next().unwrap();
    let mut face = NewFace::new(editor.complex().loops(base)[0].clone());
    for k in 0..4 {
        let at = p(1.0 + f64::from(k) * 1.5, 3.0, 0.0);
        let a = editor.make_vertex_complex(at).unwrap();
        let b = editor.make_vertex_edge(a, at + p(0.5, 0.5, 0.0)).unwrap().vertex;
        let c = editor.make_vertex_edge(b, at + p(0.5, -0.5, 0.0)).unwrap().vertex;
        editor.make_edge_chole(c, a).unwrap();
        face = face.ring(editor.complex().walk(&[a, b, c]).unwrap());
    }
    assert_eq!(editor.kill_face(base).unwrap().kind, FaceKind::Chole);
    let made = editor.make_face(face).unwrap();
    assert_eq!(made.delta, delta(0, 0, 1, 4, -4, -1, 0));
    assert_eq!(editor.complex().counts(), counts(38, 48, 11, 4, 1, 4, 0));
    assert_eq!(sheet(&editor), SheetCounts { s: 1, b: 10, e: 36, w: 2, v: 38, g_nm: 0, m: 0, f: 11 });
}

#[test]
fn y_of_fig_7() {
    let mut editor = extruded(&[[0.0, 0.0], [0.0, -1.0], [1.0, 1.0], [-1.0, 1.0]], &[[0, 1], [0, 2], [0, 3]]);
    bend_all(&mut editor);
    let counts = sheet(&editor);
    assert_eq!(counts, SheetCounts { s: 1, b: 1, e: 9, w: 0, v: 8, g_nm: 0, m: 0, f: 3 });
    assert_eq!(counts.redundant_joints(), -1);
}

#[test]
fn corner_of_fig_8() {
    let points = box_points(DVec3::ZERO, DVec3::ONE);
    let mut editor = build(&points, &[vec![0, 1, 2, 3], vec![0, 4, 5, 1], vec![0, 3, 7, 4]]);
    bend_all(&mut editor);
    let counts = sheet(&editor);
    assert_eq!(counts, SheetCounts { s: 1, b: 3, e: 6, w: 0, v: 7, g_nm: 0, m: 0, f: 3 });
    assert_eq!(counts.redundant_joints(), 1);
}

#[test]
fn three_cells_of_fig_9a_and_four_of_9b() {
    // Triangle, square, triangle, touching at corners: eight lines, two of them with four facets.
    let nodes =
        [[0.0, 0.0], [1.0, 1.0], [2.0, 0.0], [1.0, -1.0], [-1.0, 1.0], [-1.0, -1.0], [3.0, 1.0], [3.0, -1.0]];
    let mut links = vec![[0, 1], [1, 2], [2, 3], [3, 0], [0, 4], [4, 5], [5, 0], [2, 6], [6, 7], [7, 2]];
    let mut editor = extruded(&nodes, &links);
    bend_all(&mut editor);
    let counts = sheet(&editor);
    assert_eq!(counts, SheetCounts { s: 1, b: 8, e: 20, w: 0, v: 16, g_nm: 3, m: 0, f: 10 });
    assert_eq!(counts.redundant_joints(), -1);
    // One wall more through the square: four holes.
    links.push([1, 3]);
    let mut editor = extruded(&nodes, &links);
    bend_all(&mut editor);
    assert_eq!(sheet(&editor), SheetCounts { s: 1, b: 8, e: 22, w: 0, v: 16, g_nm: 4, m: 0, f: 11 });
}

#[test]
fn box_with_a_partition_of_fig_11() {
    let mut points = box_points(DVec3::ZERO, p(1.0, 1.0, 1.0));
    points.extend([p(2.0, 0.0, 0.0), p(2.0, 1.0, 0.0), p(2.0, 0.0, 1.0), p(2.0, 1.0, 1.0)]);
    let mut faces: Vec<Vec<usize>> = BOX_FACES.iter().map(|f| f.to_vec()).collect();
    faces.extend([
        vec![1, 2, 9, 8],
        vec![5, 10, 11, 6],
        vec![1, 8, 10, 5],
        vec![8, 9, 11, 10],
        vec![9, 2, 6, 11],
    ]);
    let mut editor = build(&points, &faces);
    bend_all(&mut editor);
    let counts = sheet(&editor);
    assert_eq!(counts, SheetCounts { s: 1, b: 20, e: 0, w: 0, v: 12, g_nm: 0, m: 2, f: 11 });
    assert_eq!(counts.redundant_joints(), 10);
    // The partition made last closes a volume too; taken away, one is left.
    let partition = editor.complex().faces().nth(3).unwrap();
    assert_eq!(editor.kill_face(partition).unwrap().kind, FaceKind::Cavity);
    assert_eq!(editor.complex().counts().cc, 1);
}

fn square_torus() -> Editor {
    let ring = |z: f64, a: f64, b: f64| [p(a, a, z), p(b, a, z), p(b, b, z), p(a, b, z)];
    let points =
        [ring(0.0, 0.0, 3.0), ring(1.0, 0.0, 3.0), ring(0.0, 1.0, 2.0), ring(1.0, 1.0, 2.0)].concat();
    let mut faces = Vec::new();
    for k in 0..4 {
        let n = (k + 1) % 4;
        faces.push(vec![k, n, n + 4, k + 4]);
        faces.push(vec![n + 8, k + 8, k + 12, n + 12]);
    }
    // Top and bottom in two halves each, between opposite corners.
    for [x, y, z] in [[0usize, 1, 2], [2, 3, 0]] {
        faces.push(vec![x + 4, y + 4, z + 4, z + 12, y + 12, x + 12]);
        faces.push(vec![z, y, x, x + 8, y + 8, z + 8]);
    }
    build(&points, &faces)
}

#[test]
fn square_torus_of_fig_18a() {
    let editor = square_torus();
    let c = editor.complex().counts();
    assert_eq!(c, counts(16, 28, 12, 0, 1, 2, 1));
    assert_sound(editor.complex());
}

#[test]
fn hexagon_prism_of_fig_18b() {
    let mut points: Vec<DVec3> = Vec::new();
    for z in [0.0, 1.0] {
        points.extend((0..6).map(|k| {
            let t = f64::from(k) * std::f64::consts::TAU / 6.0;
            p(t.cos(), t.sin(), z)
        }));
    }
    let mut faces = vec![vec![5, 4, 3, 2, 1, 0], vec![6, 7, 8, 9, 10, 11]];
    faces.extend([0, 2, 4].map(|k| vec![k, k + 1, k + 7, k + 6]));
    let editor = build(&points, &faces);
    assert_eq!(editor.complex().counts(), counts(12, 18, 5, 0, 1, 2, 0));
    assert_sound(editor.complex());
}

#[test]
fn torus_with_rings_has_the_same_holes() {
    // The same torus with top and bottom whole: faces with a ring.
    let ring = |z: f64, a: f64, b: f64| [p(a, a, z), p(b, a, z), p(b, b, z), p(a, b, z)];
    let points =
        [ring(0.0, 0.0, 3.0), ring(1.0, 0.0, 3.0), ring(0.0, 1.0, 2.0), ring(1.0, 1.0, 2.0)].concat();
    let mut faces = Vec::new();
    for k in 0..4 {
        let n = (k + 1) % 4;
        faces.push(vec![vec![k, n, n + 4, k + 4]]);
        faces.push(vec![vec![n + 8, k + 8, k + 12, n + 12]]);
    }
    let mut editor = Editor::default();
    add_faces(&mut editor, &points, &faces);
    assert_eq!(editor.complex().counts(), counts(16, 24, 8, 0, 2, 2, 0));
    let walk = |editor: &Editor, at: [usize; 4]| {
        let find = |i: usize| {
            editor.complex().vertices().find(|v| editor.complex().position(*v) == Some(points[i])).unwrap()
        };
        editor.complex().walk(&at.map(find)).unwrap()
    };
    // Bottom: joins the two tubes. Both fill a hole.
    let bottom = NewFace::new(walk(&editor, [3, 2, 1, 0])).ring(walk(&editor, [8, 9, 10, 11]));
    let made = editor.make_face(bottom).unwrap();
    assert_eq!((made.kind, made.delta), (FaceKind::Chole, delta(0, 0, 1, 1, -1, -1, 0)));
    // Top: they hang together already, so its ring closes a cycle; the face closes the cavity.
    let top = NewFace::new(walk(&editor, [4, 5, 6, 7])).ring(walk(&editor, [15, 14, 13, 12]));
    let made = editor.make_face(top).unwrap();
    assert_eq!((made.kind, made.delta), (FaceKind::Cavity, delta(0, 0, 1, 1, 0, 1, 1)));
    assert_eq!(editor.complex().counts(), counts(16, 24, 10, 2, 1, 2, 1));
    assert_sound(editor.complex());
}

#[test]
fn nested_and_neighbouring_cavities() {
    let mut editor = Editor::default();
    add_box(&mut editor, DVec3::ZERO, DVec3::splat(9.0));
    add_box(&mut editor, DVec3::splat(1.0), DVec3::splat(3.0));
    add_box(&mut editor, DVec3::splat(2.0), DVec3::splat(1.0));
    add_box(&mut editor, DVec3::splat(6.0), DVec3::splat(1.0));
    assert_eq!(editor.complex().counts(), counts(32, 48, 24, 0, 4, 0, 4));
    assert_sound(editor.complex());
    // A rod from an inner box to the outer one, then between two inner ones.
    let v: Vec<_> = editor.complex().vertices().collect();
    editor.make_edge_kill_complex(v[0], v[8]).unwrap();
    editor.make_edge_kill_complex(v[14], v[24]).unwrap();
    assert_eq!(editor.complex().counts().c, 2);
    editor.make_edge_chole(v[30], v[6]).unwrap();
    assert_eq!(editor.complex().counts(), counts(32, 51, 24, 0, 2, 1, 4));
    assert_sound(editor.complex());
}

#[test]
fn three_to_seven_faces_at_an_edge() {
    for n in 3..=7usize {
        for start in 0..n {
            let mut nodes = vec![[0.0, 0.0]];
            nodes.extend((0..n).map(|k| {
                // Made in a scrambled order; the stored one is that of the angles.
                let t = ((k * 3 + start) % 7) as f64 * 0.9;
                [t.cos(), t.sin()]
            }));
            let links: Vec<[usize; 2]> = (1..=n).map(|k| if k % 2 == 0 { [0, k] } else { [k, 0] }).collect();
            let editor = extruded(&nodes, &links);
            assert_sound(editor.complex());
            let e = editor.complex().edges().find(|e| editor.complex().uses(*e).len() == n).unwrap();
            let uses = editor.complex().uses(e).to_vec();
            for u in &uses {
                assert_eq!(
                    editor.complex().next_use(e, *u),
                    Some(uses[(uses.iter().position(|x| x == u).unwrap() + 1) % n])
                );
            }
            let n = n as i64;
            assert_eq!(editor.complex().counts(), counts(2 * n + 2, 3 * n + 1, n, 0, 1, 0, 0));
        }
    }
}

#[test]
fn a_sheet_in_the_steps_of_lee_and_kim() {
    // A plate with a hole and a rib on it: a wire frame, faces, a ring, a face at an edge with two, a closed region.
    let mut m = Editor::default();
    let mut total = delta(0, 0, 0, 0, 0, 0, 0);
    let a = m.mvs(p(0.0, 0.0, 0.0)).unwrap();
    let b = m.mev(a, p(4.0, 0.0, 0.0)).unwrap().vertex;
    let c = m.mev(b, p(4.0, 4.0, 0.0)).unwrap().vertex;
    let d = m.mev(c, p(0.0, 4.0, 0.0)).unwrap().vertex;
    m.mec(d, a).unwrap();
    let plate = m.mfkc(NewFace::new(m.complex().walk(&[a, b, c, d]).unwrap())).unwrap();
    assert_eq!(m.complex().counts(), counts(4, 4, 1, 0, 1, 0, 0));
    let h = m.mvl(plate, p(1.0, 1.0, 0.0)).unwrap();
    total = total + delta(1, 0, 0, 1, 0, 0, 0);
    assert_eq!(m.complex().counts(), counts(5, 4, 1, 1, 1, 0, 0));
    let [from, to] = [a, h].map(|v| m.complex().corners_at(plate, v)[0]);
    let bridge = m.mekl(plate, from, to).unwrap();
    total = total + delta(0, 1, 0, -1, 0, 0, 0);
    assert_eq!(total, delta(1, 1, 0, 0, 0, 0, 0));
    let middle = m.semv(bridge, p(0.5, 0.5, 0.0)).unwrap();
    assert_eq!(m.complex().counts(), counts(6, 6, 1, 0, 1, 0, 0));
    // A fin over the bridge's half.
    let top = m.mev(middle.vertex, p(0.5, 0.5, 1.0)).unwrap().vertex;
    let rib = m.meks(top, h);
    assert!(rib.is_err(), "they hang together");
    m.mec(top, h).unwrap();
    m.mfkc(NewFace::new(m.complex().walk(&[middle.vertex, h, top]).unwrap())).unwrap();
    assert_eq!(m.complex().counts(), counts(7, 8, 2, 0, 1, 0, 0));
    assert_eq!(m.complex().uses(middle.edge).len(), 3);
    assert_sound(m.complex());
    let before = m.complex().clone();
    while m.undo() {}
    assert_eq!(m.complex(), &Editor::default().into_complex());
    while m.redo() {}
    assert_bit_equal(m.complex(), &before);
}

#[test]
fn a_sphere_from_one_vertex() {
    let mut m = Editor::default();
    let v = m.make_vertex_complex(DVec3::ZERO).unwrap();
    let ball = m.make_face(NewFace::new(Loop::Vertex(v))).unwrap();
    assert_eq!((ball.kind, ball.delta), (FaceKind::Cavity, delta(0, 0, 1, 0, 0, 0, 1)));
    assert_eq!(m.complex().counts(), counts(1, 0, 1, 0, 1, 0, 1));
    // Struts in it, then parted: a classic solid from there on.
    let corner = m.complex().corners_at(ball.face, v)[0];
    let w = m.make_vertex_edge_in_face(ball.face, corner, DVec3::X).unwrap();
    assert_eq!(m.complex().class(w.edge), Some(EdgeClass::Free));
    assert_eq!(m.complex().counts(), counts(2, 1, 1, 0, 1, 0, 1));
    assert_sound(m.complex());
}
