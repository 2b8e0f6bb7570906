//! Complexes built by operators, and what must hold after every one of them.

pub(crate) mod random_operation;

use mesh_kernel::body::Counts;
use mesh_kernel::complex::{
    CheckOptions, Complex, Delta, EdgeClass, EdgeId, Editor, FaceId, NewFace, Operation, Reason, Record,
    VertexId,
};
use mesh_kernel::glam::DVec3;

/// A small generator: the same sequence for the same seed on every machine.
pub(crate) struct Random(pub u64);

impl Random {
    pub(crate) fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        self.0 >> 33
    }

    pub(crate) fn below(&mut self, n: usize) -> usize {
        (self.next() % n.max(1) as u64) as usize
    }

    pub(crate) fn unit(&mut self) -> f64 {
        self.next() as f64 / (1u64 << 31) as f64
    }

    pub(crate) fn pick<T: Copy>(&mut self, from: &[T]) -> Option<T> {
        if from.is_empty() { None } else { Some(from[self.below(from.len())]) }
    }

    pub(crate) fn place(&mut self) -> DVec3 {
        DVec3::new(self.unit(), self.unit(), self.unit())
    }
}

pub(crate) fn p(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z)
}

pub(crate) fn counts(v: i64, e: i64, f: i64, r: i64, c: i64, ch: i64, cc: i64) -> Counts {
    Counts { v, e, f, r, c, ch, cc }
}

pub(crate) fn delta(v: i64, e: i64, f: i64, r: i64, c: i64, ch: i64, cc: i64) -> Delta {
    Delta { v, e, f, r, c, ch, cc }
}

pub(crate) fn assert_sound(complex: &Complex) {
    assert_eq!(complex.check(), []);
    assert!(complex.counts().identity_holds());
}

pub(crate) fn assert_sound_topology(complex: &Complex) {
    assert_eq!(complex.check_with(CheckOptions { positions: false }), []);
}

/// Equal, positions by their bits.
pub(crate) fn assert_bit_equal(a: &Complex, b: &Complex) {
    assert!(a == b);
    for v in a.vertices() {
        let bits = |c: &Complex| c.position(v).unwrap().to_array().map(f64::to_bits);
        assert_eq!(bits(a), bits(b));
    }
}

/// Adds faces given by corners, vertices and edges made as they come: the first vertex of a component alone, the others at the end
/// of an edge wherever one leads there.
pub(crate) fn add_faces(
    editor: &mut Editor,
    points: &[DVec3],
    faces: &[Vec<Vec<usize>>],
) -> (Vec<VertexId>, Vec<FaceId>) {
    let mut ids: Vec<Option<VertexId>> = vec![None; points.len()];
    let mut made = Vec::new();
    for loops in faces {
        let mut walks = Vec::new();
        for corners in loops {
            for (i, &a) in corners.iter().enumerate() {
                let b = corners[(i + 1) % corners.len()];
                let from = match ids[a] {
                    Some(v) => v,
                    None => editor.make_vertex_complex(points[a]).unwrap(),
                };
                ids[a] = Some(from);
                match ids[b] {
                    None => ids[b] = Some(editor.make_vertex_edge(from, points[b]).unwrap().vertex),
                    Some(to) if editor.complex().edges_between(from, to).is_empty() && from != to => {
                        editor.make_edge(from, to).unwrap();
                    }
                    Some(_) => {}
                }
            }
            let corners: Vec<VertexId> = corners.iter().map(|&i| ids[i].unwrap()).collect();
            walks.push(editor.complex().walk(&corners).unwrap());
        }
        let mut walks = walks.into_iter();
        let mut face = NewFace::new(walks.next().unwrap());
        face.rings.extend(walks);
        made.push(editor.make_face(face).unwrap().face);
    }
    // Points that no face uses have no vertex.
    (ids.into_iter().map(|v| v.unwrap_or(VertexId(u32::MAX))).collect(), made)
}

pub(crate) fn build(points: &[DVec3], faces: &[Vec<usize>]) -> Editor {
    let mut editor = Editor::default();
    let faces: Vec<Vec<Vec<usize>>> = faces.iter().map(|f| vec![f.clone()]).collect();
    add_faces(&mut editor, points, &faces);
    editor
}

/// A profile of nodes and links, extruded along z.
pub(crate) fn extruded(nodes: &[[f64; 2]], links: &[[usize; 2]]) -> Editor {
    let n = nodes.len();
    let mut points: Vec<DVec3> = nodes.iter().map(|[x, y]| p(*x, *y, 0.0)).collect();
    points.extend(nodes.iter().map(|[x, y]| p(*x, *y, 1.0)));
    let faces: Vec<Vec<usize>> = links.iter().map(|&[a, b]| vec![a, b, b + n, a + n]).collect();
    build(&points, &faces)
}

pub(crate) const BOX_FACES: [[usize; 4]; 6] =
    [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [1, 2, 6, 5], [2, 3, 7, 6], [3, 0, 4, 7]];

pub(crate) fn box_points(at: DVec3, size: DVec3) -> Vec<DVec3> {
    let corner = |x: f64, y: f64, z: f64| at + size * DVec3::new(x, y, z);
    vec![
        corner(0.0, 0.0, 0.0),
        corner(1.0, 0.0, 0.0),
        corner(1.0, 1.0, 0.0),
        corner(0.0, 1.0, 0.0),
        corner(0.0, 0.0, 1.0),
        corner(1.0, 0.0, 1.0),
        corner(1.0, 1.0, 1.0),
        corner(0.0, 1.0, 1.0),
    ]
}

pub(crate) fn add_box(editor: &mut Editor, at: DVec3, size: DVec3) -> (Vec<VertexId>, Vec<FaceId>) {
    let faces: Vec<Vec<Vec<usize>>> = BOX_FACES.iter().map(|f| vec![f.to_vec()]).collect();
    add_faces(editor, &box_points(at, size), &faces)
}

/// Applies an operator; its delta must be the one counted, its inverse must give the complex back, undo and redo too.
pub(crate) fn done(editor: &mut Editor, operation: Operation, wanted: Delta) {
    let before = editor.complex().clone();
    assert_eq!(before.can(&operation), Ok(wanted));
    let outcome = editor.apply(&operation).unwrap();
    assert_eq!(outcome.delta, wanted);
    assert_eq!(Delta::between(&before.counts(), &editor.complex().counts()), wanted);
    assert_sound_topology(editor.complex());
    let after = editor.complex().clone();
    let record = editor.journal().done.last().unwrap()[0].clone();
    let mut back = Editor::new(after.clone());
    assert_eq!(back.apply(&record.inverse).unwrap().delta, -wanted);
    assert_bit_equal(back.complex(), &before);
    // The inverse's inverse is the operator.
    let again = back.journal().done.last().unwrap()[0].inverse.clone();
    back.apply(&again).unwrap();
    assert_bit_equal(back.complex(), &after);
    assert!(editor.undo());
    assert_bit_equal(editor.complex(), &before);
    assert!(editor.redo());
    assert_bit_equal(editor.complex(), &after);
    let text = serde_json::to_string(&record).unwrap();
    assert_eq!(serde_json::from_str::<Record>(&text).unwrap(), record);
}

/// The operator must be refused with this reason, and nothing change.
pub(crate) fn refused(editor: &mut Editor, operation: Operation, reason: Reason) {
    let before = editor.clone();
    let refusal = editor.apply(&operation).unwrap_err();
    assert_eq!(refusal.reason, reason);
    assert_eq!(editor.complex().can(&operation), Err(refusal.clone()));
    assert!(*editor == before);
    let text = refusal.to_string();
    assert!(text.starts_with(operation.name()) && text.ends_with(reason.remedy()), "{text}");
}

pub(crate) fn square(editor: &mut Editor) -> ([VertexId; 4], FaceId) {
    let at = [p(0.0, 0.0, 0.0), p(1.0, 0.0, 0.0), p(1.0, 1.0, 0.0), p(0.0, 1.0, 0.0)];
    let (v, f) = add_faces(editor, &at, &[vec![vec![0, 1, 2, 3]]]);
    ([v[0], v[1], v[2], v[3]], f[0])
}

pub(crate) const NO_V: VertexId = VertexId(77);
pub(crate) const NO_E: EdgeId = EdgeId(77);
pub(crate) const NO_F: FaceId = FaceId(77);
pub(crate) const FREE: EdgeClass = EdgeClass::Free;

/// An edge along z with plates to the given directions, and the edge's id.
pub(crate) fn fan(directions: &[[f64; 2]]) -> (Editor, EdgeId, Vec<FaceId>) {
    let nodes: Vec<[f64; 2]> = [[0.0, 0.0]].into_iter().chain(directions.iter().copied()).collect();
    let links: Vec<[usize; 2]> = (1..nodes.len()).map(|k| [0, k]).collect();
    let editor = extruded(&nodes, &links);
    let e = editor.complex().edges().max_by_key(|e| editor.complex().uses(*e).len()).unwrap();
    let faces = editor.complex().faces().collect();
    (editor, e, faces)
}
