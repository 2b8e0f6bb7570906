//! Cell complexes and their journals, as serde stores them.

use fuzz::{Reader, Reading, Shape};
use mesh_kernel::complex::{CheckOptions, Complex, Editor, Journal, NewFace, VertexId};
use mesh_kernel::glam::DVec3;

use crate::run;

/// A tetrahedron with a wire, a vertex that stands alone, a ring, and free numbers: closed, taken apart and made again.
fn solid() -> Editor {
    let mut editor = Editor::default();
    let a = editor.make_vertex_complex(DVec3::ZERO).expect("a vertex");
    let spoke = |editor: &mut Editor, p| editor.make_vertex_edge(a, p).expect("an edge").vertex;
    let [b, c, d] = [DVec3::X, DVec3::Y, DVec3::Z].map(|p| spoke(&mut editor, p));
    for (p, q) in [(b, c), (c, d), (d, b)] {
        editor.make_edge(p, q).expect("an edge");
    }
    let face = |editor: &mut Editor, corners: &[VertexId]| {
        let walk = editor.complex().walk(corners).expect("edges join them");
        editor.make_face(NewFace::new(walk)).expect("a face")
    };
    for corners in [[a, c, b], [a, b, d], [a, d, c], [b, c, d]] {
        face(&mut editor, &corners);
    }
    let wire = editor.make_vertex_edge(a, DVec3::NEG_X).expect("a wire").vertex;
    editor.make_vertex_edge(wire, DVec3::NEG_Y).expect("a wire");
    editor.make_vertex_complex(DVec3::splat(5.0)).expect("a vertex");
    editor
}

fn reader(
    name: &'static str,
    seeds: Vec<Vec<u8>>,
    read: impl Fn(&[u8]) -> Reading + Send + 'static,
) -> Reader {
    Reader {
        name,
        shape: Shape::Json,
        seeds,
        words: &["null", "0", "1", "2", "free", "bend", "weld", "slots", "4294967295"],
        inputs: 5_000,
        base_memory: 1 << 20,
        memory_factor: 1_000,
        read: Box::new(read),
    }
}

fn of_json(error: &serde_json::Error) -> String {
    error.to_string().chars().take(300).collect()
}

fn topology(complex: &Complex) {
    assert_eq!(complex.check_with(CheckOptions { positions: false }), []);
}

#[test]
fn complex() {
    let mut editor = solid();
    let mut seeds = Vec::new();
    loop {
        seeds.push(serde_json::to_vec(editor.complex()).expect("a complex is written"));
        if !editor.undo() {
            break;
        }
    }
    run(reader("complex", seeds, |bytes| match serde_json::from_slice::<Complex>(bytes) {
        Ok(complex) => {
            topology(&complex);
            let text = serde_json::to_vec(&complex).expect("a complex is written");
            assert!(serde_json::from_slice::<Complex>(&text).expect("what was written is read") == complex);
            let defects = complex.check();
            let _ = complex.counts();
            Reading::Sound(vec![
                complex.vertex_count(),
                complex.edge_count(),
                complex.face_count(),
                defects.len(),
            ])
        }
        Err(error) => Reading::Refused(of_json(&error)),
    }));
}

#[test]
fn complex_journal() {
    let seeds = vec![serde_json::to_vec(solid().journal()).expect("a journal is written")];
    run(reader("complex jrnl", seeds, |bytes| {
        let journal: Journal = match serde_json::from_slice(bytes) {
            Ok(journal) => journal,
            Err(error) => return Reading::Refused(of_json(&error)),
        };
        let mut editor = Editor::default();
        let outcome = editor.replay(&journal);
        topology(editor.complex());
        let sizes = vec![
            editor.complex().vertex_count(),
            editor.complex().face_count(),
            usize::from(outcome.is_ok()),
        ];
        while editor.undo() {}
        assert!(*editor.complex() == Complex::new(), "undone is not the start");
        Reading::Sound(sizes)
    }));
}
