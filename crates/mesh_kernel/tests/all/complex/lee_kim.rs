//! Lee & Kim's and Lipson & Shpitalni's operators: deltas in both countings, inverses.

use crate::complex::support::*;
use mesh_kernel::complex::{
    Delta, DirectedEdge, EdgeClass, EdgeInFace, Editor, End, FaceId, FaceUse, NewFace, Reason, Refusal,
    RingsTo, SheetCounts, SheetDelta, VertexId,
};
use mesh_kernel::glam::DVec3;

/// Runs an operator, which must change the counts as said; it and what undoes it must give the complex back.
fn step<T>(m: &mut Editor, wanted: Delta, edit: impl FnOnce(&mut Editor) -> Result<T, Refusal>) -> T {
    let (before, done) = (m.complex().clone(), m.journal().done.len());
    let result = edit(m).unwrap();
    let after = m.complex().clone();
    assert_eq!(m.journal().done.len(), done + 1, "one step");
    assert_eq!(Delta::between(&before.counts(), &after.counts()), wanted);
    assert_sound_topology(&after);
    assert!(m.undo());
    assert_bit_equal(m.complex(), &before);
    assert!(m.redo());
    assert_bit_equal(m.complex(), &after);
    result
}

/// The same with Lipson's counts.
fn sheet_step<T>(
    m: &mut Editor,
    sheet: SheetDelta,
    wanted: Delta,
    edit: impl FnOnce(&mut Editor) -> Result<T, Refusal>,
) -> T {
    let before = m.complex().sheet_counts();
    let result = step(m, wanted, edit);
    let after = m.complex().sheet_counts();
    assert_eq!(after - before, sheet);
    assert!(after.identity_holds());
    result
}

fn square(m: &mut Editor, at: DVec3, side: f64) -> ([VertexId; 4], FaceId) {
    let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(|[x, y]| at + p(x, y, 0.0) * side);
    let (v, f) = add_faces(m, &corners, &[vec![vec![0, 1, 2, 3]]]);
    ([v[0], v[1], v[2], v[3]], f[0])
}

fn wire(m: &mut Editor, corners: &[DVec3]) -> Vec<VertexId> {
    let mut v = vec![m.make_vertex_complex(corners[0]).unwrap()];
    for c in &corners[1..] {
        v.push(m.make_vertex_edge(*v.last().unwrap(), *c).unwrap().vertex);
    }
    m.make_edge_chole(*v.last().unwrap(), v[0]).unwrap();
    v
}

#[test]
fn lee_kim_deltas() {
    let m = &mut Editor::default();
    let a = step(m, delta(1, 0, 0, 0, 1, 0, 0), |m| m.mvs(DVec3::ZERO));
    let b = step(m, delta(1, 0, 0, 0, 1, 0, 0), |m| m.mvs(DVec3::X));
    let link = step(m, delta(0, 1, 0, 0, -1, 0, 0), |m| m.meks(a, b));
    step(m, delta(0, -1, 0, 0, 1, 0, 0), |m| m.kems(link));
    m.undo();
    let c = step(m, delta(1, 1, 0, 0, 0, 0, 0), |m| m.mev(b, p(1.0, 1.0, 0.0)));
    step(m, delta(-1, -1, 0, 0, 0, 0, 0), |m| m.kev(c.vertex));
    m.undo();
    let cycle = step(m, delta(0, 1, 0, 0, 0, 1, 0), |m| m.mec(c.vertex, a));
    step(m, delta(0, -1, 0, 0, 0, -1, 0), |m| m.kec(cycle));
    m.undo();
    let walk = m.complex().walk(&[a, b, c.vertex]).unwrap();
    let f = step(m, delta(0, 0, 1, 0, 0, -1, 0), |m| m.mfkc(NewFace::new(walk.clone())));
    step(m, delta(0, 0, -1, 0, 0, 1, 0), |m| m.kfmc(f));
    m.undo();
    let g = step(m, delta(0, 0, 1, 0, 0, 0, 1), |m| m.mfr(NewFace::new(walk.reversed())));
    step(m, delta(0, 0, -1, 0, 0, 0, -1), |m| m.kfr(g));
    m.undo();
    let h = step(m, delta(1, 0, 0, 1, 0, 0, 0), |m| m.mvl(f, p(0.7, 0.2, 0.0)));
    step(m, delta(-1, 0, 0, -1, 0, 0, 0), |m| m.kvl(h));
    m.undo();
    let [from, to] = [a, h].map(|v| m.complex().corners_at(f, v)[0]);
    let bridge = step(m, delta(0, 1, 0, -1, 0, 0, 0), |m| m.mekl(f, from, to));
    step(m, delta(0, -1, 0, 1, 0, 0, 0), |m| m.keml(bridge, End::End));
    m.undo();
    let s = step(m, delta(1, 1, 0, 0, 0, 0, 0), |m| m.semv(bridge, p(0.3, 0.1, 0.0)));
    step(m, delta(-1, -1, 0, 0, 0, 0, 0), |m| m.jekv(bridge, s.vertex));
    let x = step(m, delta(1, 0, 0, 0, 1, 0, 0), |m| m.mvs(DVec3::Z));
    step(m, delta(-1, 0, 0, 0, -1, 0, 0), |m| m.kvs(x));
    // On wires: the edge that closes a path, and the face.
    let x = m.mvs(p(5.0, 0.0, 0.0)).unwrap();
    let y = m.mev(x, p(6.0, 0.0, 0.0)).unwrap();
    let z = m.mev(y.vertex, p(6.0, 1.0, 0.0)).unwrap();
    let path = [DirectedEdge::along(y.edge), DirectedEdge::along(z.edge)];
    let made = step(m, delta(0, 1, 1, 0, 0, 0, 0), |m| m.mef_wire(z.vertex, x, &path));
    assert_eq!(made.delta, delta(0, 1, 1, 0, 0, 0, 0));
    let wrong = m.mef_wire(z.vertex, x, &path[..1]).unwrap_err();
    assert!(matches!(wrong.reason, Reason::OpenLoop { .. }), "{wrong}");
}

#[test]
fn mef_parts_a_face_and_kef_unites_it_again() {
    let one = delta(0, 1, 1, 0, 0, 0, 0);
    let m = &mut Editor::default();
    let (v, f) = square(m, DVec3::ZERO, 4.0);
    // Two holes, one in each half; a strut; a vertex ring.
    let holes = [p(2.5, 0.5, 0.0), p(0.5, 2.5, 0.0)]
        .map(|at| wire(m, &[at, at + p(0.0, 0.6, 0.0), at + p(0.2, 0.2, 0.0), at + p(0.6, 0.0, 0.0)]));
    m.kill_face(f).unwrap();
    let mut new = NewFace::new(m.complex().walk(&v).unwrap());
    for h in &holes {
        new = new.ring(m.complex().walk(h).unwrap());
    }
    let f = m.make_face(new).unwrap().face;
    m.make_vertex_ring(f, p(1.0, 3.5, 0.0)).unwrap();
    assert_sound(m.complex());
    for reversed in [false, true] {
        let ends = if reversed { [v[2], v[0]] } else { [v[0], v[2]] };
        let [from, to] = ends.map(|v| m.complex().corners_at(f, v)[0]);
        let before = m.complex().clone();
        let at = EdgeInFace { face: f, from, to, rings: RingsTo::ByPosition };
        let made = step(m, one, |m| m.mef(&at));
        assert_eq!((made.kept, made.delta), (f, one));
        assert_sound(m.complex());
        // Each half has the rings that lie in it.
        let rings = |f: FaceId| m.complex().loops(f).len() - 1;
        assert_eq!((rings(made.kept), rings(made.new)), if reversed { (1, 2) } else { (2, 1) });
        step(m, -one, |m| m.kef(made.edge));
        assert_bit_equal(m.complex(), &before);
        // By the caller: as it says.
        let given = EdgeInFace { rings: RingsTo::NewFace(vec![holes[0][1]]), ..at };
        let made = step(m, one, |m| m.mef(&given));
        assert!(m.complex().corners_at(made.new, holes[0][0]).len() == 1);
        m.undo();
    }
    // An edge that parts a notched ring: what it encloses is the new face.
    let [x, y] = [1, 3].map(|i| m.complex().corners_at(f, holes[0][i])[0]);
    let before = m.complex().clone();
    for (from, to) in [(x, y), (y, x)] {
        let made = step(m, one, |m| m.mef(&EdgeInFace { face: f, from, to, rings: RingsTo::ByPosition }));
        assert_eq!((m.complex().loops(made.kept).len(), m.complex().loops(made.new).len()), (4, 1));
        step(m, -one, |m| m.kef(made.edge));
        assert_bit_equal(m.complex(), &before);
    }
    // Refusals.
    let at = |from, to| EdgeInFace { face: f, from, to, rings: RingsTo::ByPosition };
    let outer = m.complex().corners_at(f, v[0])[0];
    assert_eq!(m.mef(&at(outer, x)).unwrap_err().reason, Reason::DifferentLoops(f));
    assert_eq!(m.mef(&at(outer, outer)).unwrap_err().reason, Reason::SelfLoop(v[0]));
    let through = m.make_vertex_ring(f, p(1.0, 1.0, 0.0)).unwrap();
    let [a, c] = [v[0], v[2]].map(|v| m.complex().corners_at(f, v)[0]);
    assert_eq!(m.mef(&at(a, c)).unwrap_err().reason, Reason::SideUnknown { face: f, at: through });
    let e = m.complex().edges_between(v[0], v[1])[0];
    assert_eq!(m.kef(e).unwrap_err().reason, Reason::NotBetweenTwo { edge: e, faces: vec![f] });
}

#[test]
fn mef_keeps_places_about_edges_and_cavities() {
    // A box with a fin: part every face, then unite again.
    let m = &mut Editor::default();
    let (_, faces) = add_box(m, DVec3::ZERO, DVec3::ONE);
    add_fin(m);
    let before = m.complex().clone();
    let one = delta(0, 1, 1, 0, 0, 0, 0);
    for f in faces {
        let corners = m.complex().loop_vertices(&m.complex().loops(f)[0]);
        let [from, to] = [corners[0], corners[2]].map(|v| m.complex().corners_at(f, v)[0]);
        let made = step(m, one, |m| m.mef(&EdgeInFace { face: f, from, to, rings: RingsTo::ByPosition }));
        assert_sound(m.complex());
        step(m, -one, |m| m.kef(made.edge));
        assert_bit_equal(m.complex(), &before);
        // Faces turned over, and back.
        step(m, Delta::default(), |m| m.flip_face(f));
        let e = m.complex().loops(f)[0]
            .edges()
            .iter()
            .find(|d| m.complex().uses(d.edge).len() == 2)
            .unwrap()
            .edge;
        assert!(matches!(m.kef(e).unwrap_err().reason, Reason::Orientation { .. }));
        assert_sound(m.complex());
        m.flip_face(f).unwrap();
        assert_bit_equal(m.complex(), &before);
    }
}

/// A wall on an upright edge of the box, outside of it.
fn add_fin(m: &mut Editor) {
    let find = |at: DVec3| m.complex().vertices().find(|v| m.complex().position(*v) == Some(at)).unwrap();
    let (a, b) = (find(DVec3::ZERO), find(DVec3::Z));
    let c = m.make_vertex_edge(b, p(-1.0, -1.0, 1.0)).unwrap().vertex;
    let d = m.make_vertex_edge(c, p(-1.0, -1.0, 0.0)).unwrap().vertex;
    m.make_edge_chole(d, a).unwrap();
    m.make_face_kill_chole(NewFace::new(m.complex().walk(&[a, b, c, d]).unwrap())).unwrap();
    assert_sound(m.complex());
}

fn zero() -> SheetCounts {
    SheetCounts::default()
}

#[test]
fn lipson_tables_1_and_2() {
    let m = &mut Editor::default();
    let none = Delta::default();
    let a = sheet_step(m, SheetDelta { s: 1, v: 1, ..zero() }, delta(1, 0, 0, 0, 1, 0, 0), |m| {
        m.mcv(DVec3::ZERO)
    });
    sheet_step(m, SheetDelta { s: -1, v: -1, ..zero() }, delta(-1, 0, 0, 0, -1, 0, 0), |m| m.kcv(a));
    m.undo();
    let mev = SheetDelta { e: 1, v: 1, ..zero() };
    let b = sheet_step(m, mev, delta(1, 1, 0, 0, 0, 0, 0), |m| m.mev(a, p(4.0, 0.0, 0.0)));
    let c = sheet_step(m, mev, delta(1, 1, 0, 0, 0, 0, 0), |m| m.mev(b.vertex, p(4.0, 4.0, 0.0)));
    let d = sheet_step(m, mev, delta(1, 1, 0, 0, 0, 0, 0), |m| m.mev(c.vertex, p(0.0, 4.0, 0.0)));
    let kev = SheetDelta { e: -1, v: -1, ..zero() };
    sheet_step(m, kev, delta(-1, -1, 0, 0, 0, 0, 0), |m| m.kev(d.vertex));
    m.undo();
    let mef = SheetDelta { e: 1, f: 1, ..zero() };
    let path = [b, c, d].map(|x| DirectedEdge::along(x.edge));
    let first = sheet_step(m, mef, delta(0, 1, 1, 0, 0, 0, 0), |m| m.mef_wire(d.vertex, a, &path));
    let [from, to] = [a, c.vertex].map(|v| m.complex().corners_at(first.kept, v)[0]);
    let at = EdgeInFace { face: first.kept, from, to, rings: RingsTo::ByPosition };
    let parted = sheet_step(m, mef, delta(0, 1, 1, 0, 0, 0, 0), |m| m.mef(&at));
    let kef = SheetDelta { e: -1, f: -1, ..zero() };
    sheet_step(m, kef, delta(0, -1, -1, 0, 0, 0, 0), |m| m.kef(parted.edge));
    m.undo();
    // Labels.
    let e = parted.edge;
    sheet_step(m, SheetDelta { b: 1, e: -1, ..zero() }, none, |m| m.mbke(e));
    assert_eq!(m.mbke(e).unwrap_err().reason, Reason::WrongClass { edge: e });
    sheet_step(m, SheetDelta { b: -1, w: 1, ..zero() }, none, |m| m.mwkb(e));
    sheet_step(m, SheetDelta { b: 1, w: -1, ..zero() }, none, |m| m.kwmb(e));
    sheet_step(m, SheetDelta { b: -1, e: 1, ..zero() }, none, |m| m.kbme(e));
    let free = Reason::NotJoint { edge: b.edge, faces: m.complex().faces_of(b.edge) };
    assert_eq!(m.mbke(b.edge).unwrap_err().reason, free);
    // A ring, its bend, and back.
    let ring = m.make_vertex_ring(parted.kept, p(1.0, 2.5, 0.0)).unwrap();
    let outer = m.complex().corners_at(parted.kept, a)[0];
    let inner = m.complex().corners_at(parted.kept, ring)[0];
    let mgb = SheetDelta { b: 1, g_nm: 1, ..zero() };
    let bend =
        sheet_step(m, mgb, delta(0, 1, 0, -1, 0, 0, 0), |m| m.mgb(parted.kept, outer, inner)).edge.unwrap();
    assert_eq!(m.complex().class(bend), Some(EdgeClass::Bend));
    let kgb = SheetDelta { b: -1, g_nm: -1, ..zero() };
    sheet_step(m, kgb, delta(0, -1, 0, 1, 0, 0, 0), |m| m.kgb(bend, End::End));
    assert_eq!(m.kgb(e, End::End).unwrap_err().reason, Reason::WrongClass { edge: e });
}

#[test]
fn the_split_operation_of_fig_12b() {
    // Two plates at one vertex.
    let m = &mut Editor::default();
    let (v, _) = square(m, DVec3::ZERO, 1.0);
    let (w, g) = square(m, DVec3::ONE, 1.0);
    let joined = SheetDelta { s: -1, v: -1, ..zero() };
    sheet_step(m, joined, delta(-1, 0, 0, 0, -1, 0, 0), |m| m.kcv_join(v[2], w[0]));
    assert_sound_topology(m.complex());
    let edges: Vec<_> =
        m.complex().edges_at(v[2]).iter().copied().filter(|e| m.complex().faces_of(*e) == [g]).collect();
    assert_eq!(edges.len(), 2);
    let parted = SheetDelta { s: 1, v: 1, ..zero() };
    let at = DVec3::ONE;
    sheet_step(m, parted, delta(1, 0, 0, 0, 1, 0, 0), |m| m.mcv_split(v[2], &edges, at));
    m.undo();
    // A face whose loop would break.
    let open = m.mcv_split(v[2], &edges[..1], at).unwrap_err();
    assert!(matches!(open.reason, Reason::OpenLoop { .. }), "{open}");
    // Within one component it is another operator.
    let far = w[2];
    let closed = step(m, delta(-1, 0, 0, 0, 0, 1, 0), |m| m.merge_vertices(v[0], far));
    assert_eq!(closed.delta.ch, 1);
    m.undo();
    let not = m.kcv_join(v[0], far).unwrap_err();
    assert!(matches!(not.reason, Reason::WrongDelta { .. }), "{not}");
    assert_eq!(m.merge_vertices(v[0], v[1]).unwrap_err().reason, Reason::SelfLoop(v[0]));
}

/// Two plates, and the edges to be joined: the cases of fig. 6.
#[test]
fn joining_lines_as_in_fig_6() {
    // (a) Two components: both vertices, then the edges.
    let m = &mut Editor::default();
    let (v, f) = square(m, DVec3::ZERO, 1.0);
    let (w, g) = square(m, p(1.0, 0.0, 0.0), 1.0);
    step(m, delta(-2, -1, 0, 0, -1, 0, 0), |m| join(m, [v[1], v[2]], [w[0], w[3]]));
    assert_sound(m.complex());
    let e = m.complex().edges_between(v[1], v[2])[0];
    assert_eq!(m.complex().faces_of(e), [f, g]);
    // A third one, upright: its place is found from the positions.
    let up = [p(1.0, 0.0, 0.0), p(1.0, 1.0, 0.0), p(1.0, 1.0, 1.0), p(1.0, 0.0, 1.0)];
    let (x, _) = add_faces(m, &up, &[vec![vec![0, 1, 2, 3]]]);
    step(m, delta(-2, -1, 0, 0, -1, 0, 0), |m| join(m, [v[1], v[2]], [x[0], x[1]]));
    assert_eq!(m.complex().uses(e).len(), 3);
    assert_sound(m.complex());
    // (d) Both ends of a tube's slit: the last hole of a strip goes, g_nm −1; (b) before that it came.
    let strip = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0], [0.0, 0.0]];
    let links: Vec<[usize; 2]> = (0..4).map(|k| [k, k + 1]).collect();
    let mut tube = extruded(&strip, &links);
    let m = &mut tube;
    let ends: Vec<VertexId> = [DVec3::ZERO, DVec3::Z]
        .iter()
        .flat_map(|at| {
            m.complex().vertices().filter(|v| m.complex().position(*v) == Some(*at)).collect::<Vec<_>>()
        })
        .collect();
    let [a0, a1, b0, b1] = ends[..] else { unreachable!("{ends:?}") };
    step(m, delta(-1, 0, 0, 0, 0, 1, 0), |m| m.merge_vertices(a0, a1));
    step(m, delta(-1, 0, 0, 0, 0, 1, 0), |m| m.merge_vertices(b0, b1));
    let [x, y] = m.complex().edges_between(a0, b0).try_into().unwrap();
    let volume = m.muke(x, y, None).unwrap_err();
    assert!(matches!(volume.reason, Reason::WrongDelta { .. }), "{volume}");
    step(m, delta(0, -1, 0, 0, 0, -1, 0), |m| m.unite_edges(x, y, None));
    assert_eq!(m.complex().counts().ch, 1);
    assert_sound(m.complex());
}

fn join(m: &mut Editor, kept: [VertexId; 2], gone: [VertexId; 2]) -> Result<(), Refusal> {
    m.transaction(|m| {
        m.merge_vertices(kept[0], gone[0])?;
        m.merge_vertices(kept[1], gone[1])?;
        let edges = m.complex().edges_between(kept[0], kept[1]);
        m.unite_edges(edges[0], edges[1], None).map(|_| ())
    })
}

#[test]
fn muke_seals_a_volume_and_kume_opens_it() {
    // (e) A box with one slit.
    let m = &mut Editor::default();
    let (_, faces) = add_box(m, DVec3::ZERO, DVec3::ONE);
    add_fin(m);
    let whole = m.complex().clone();
    let open = SheetDelta { e: 1, m: -1, ..zero() };
    for e in m.complex().edges().collect::<Vec<_>>() {
        let uses = m.complex().uses(e).to_vec();
        if uses.len() < 2 {
            assert!(m.kume(e, &uses).is_err());
            continue;
        }
        for u in &uses {
            let divided = m.complex().clone();
            let class = faces.contains(&u.face);
            if !class {
                // The fin comes off: no volume opens, and no hole is new.
                let off = m.kume(e, &[*u]).unwrap_err();
                assert!(matches!(off.reason, Reason::WrongDelta { .. }), "{off}");
                continue;
            }
            let slit = sheet_step(m, open, delta(0, 1, 0, 0, 0, 0, -1), |m| m.kume(e, &[*u])).edge.unwrap();
            assert_sound(m.complex());
            let shut = SheetDelta { e: -1, m: 1, ..zero() };
            sheet_step(m, shut, delta(0, -1, 0, 0, 0, 0, 1), |m| m.muke(e, slit, None));
            assert_bit_equal(m.complex(), &divided);
        }
        // Its order may be said as well.
        let u = uses[1];
        if faces.contains(&u.face) {
            let order = mesh_kernel::complex::RadialOrder { edge: e, uses: uses.clone() };
            let slit = m.divide_edge(e, &[u]).unwrap().edge.unwrap();
            m.muke(e, slit, Some(order)).unwrap();
        }
    }
    assert_bit_equal(m.complex(), &whole);
    let [e, other] = [0, 1].map(|i| m.complex().edges().nth(i).unwrap());
    assert_eq!(m.unite_edges(e, other, None).unwrap_err().reason, Reason::NotParallel([e, other]));
    assert_eq!(m.unite_edges(e, e, None).unwrap_err().reason, Reason::NotParallel([e, e]));
    let stranger = FaceUse { face: FaceId(99), along: true };
    assert!(matches!(m.divide_edge(e, &[stranger]).unwrap_err().reason, Reason::RadialGiven { .. }));
    m.set_edge_class(e, EdgeClass::Bend).unwrap();
    assert_eq!(m.kume(e, &[]).unwrap_err().reason, Reason::WrongClass { edge: e });
}

#[test]
fn plans_are_the_inverse_of_the_tables() {
    for part in [
        SheetCounts { s: 1, b: 10, e: 24, w: 2, v: 26, g_nm: 0, m: 0, f: 11 },
        SheetCounts { s: 1, b: 8, e: 20, w: 0, v: 16, g_nm: 3, m: 0, f: 10 },
        SheetCounts { s: 1, b: 12, e: 0, w: 8, v: 12, g_nm: 0, m: 2, f: 11 },
        SheetCounts { s: 2, b: 1, e: 13, w: 0, v: 12, g_nm: 0, m: 0, f: 4 },
    ] {
        assert!(part.identity_holds(), "{part}");
        assert_eq!(part.plan().unwrap().counts(), part);
    }
    assert_eq!(SheetCounts { s: 1, f: 5, ..zero() }.plan(), None);
}
