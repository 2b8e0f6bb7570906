//! Journal files, read and carried out: operators on whatever a file asks for.

// The generators of random bodies and operators are the kernel's own tests'.
#[allow(dead_code, clippy::unwrap_used, reason = "the kernel tests use more of it, and may fail")]
#[path = "../../../../crates/mesh_kernel/tests/all/body/support/mod.rs"]
mod body_support;

use body_support::operations::Source;
use body_support::random_body;
use fuzz::{Reader, Reading, Shape};
use mesh_kernel::body::Body;
use mesh_kernel::body::edit::{Editor, JournalFile, Operation};

use crate::run;

fn seeds() -> Vec<Vec<u8>> {
    (0..12)
        .map(|seed| {
            let mut source = Source::new(seed);
            let mut editor = Editor::new(random_body(seed as u8 % 3, seed));
            for _ in 0..4000 {
                if editor.undo_len() < 8 && editor.body().face_count() < 60 {
                    let operation = source.operation(editor.body());
                    // Refusals are no matter here.
                    let _ = editor.apply(&operation);
                }
            }
            JournalFile::of(&editor).to_bytes().expect("what was done is written")
        })
        .collect()
}

fn reader(name: &'static str, read: impl Fn(&[u8]) -> Reading + Send + 'static) -> Reader {
    Reader {
        name,
        shape: Shape::Json,
        seeds: seeds(),
        words: &[
            "null",
            "compact",
            "split_all",
            "split_face",
            "split_edge",
            "swap_edge",
            "collapse_edge",
            "kill_face",
            "kill_joint",
            "make_joint",
            "make_face",
            "make_edge",
            "group",
            "surface",
            "edge",
            "face",
            "node",
        ],
        inputs: 5_000,
        base_memory: 1 << 16,
        memory_factor: 600,
        read: Box::new(read),
    }
}

#[test]
fn journal() {
    run(reader("journal", |bytes| match JournalFile::from_bytes(bytes) {
        Ok(journal) => {
            let again = journal.to_bytes().expect("what was read is written");
            assert!(JournalFile::from_bytes(&again).expect("what was written is read") == journal);
            Reading::Sound(vec![journal.start.face_count(), journal.operations.len()])
        }
        Err(error) => Reading::Refused(error.to_string()),
    }));
}

/// How often an operation multiplies a body's faces.
fn splits(operation: &Operation) -> usize {
    match operation {
        Operation::Group(all) => all.iter().map(splits).sum(),
        Operation::SplitAll { .. } => 1,
        _ => 0,
    }
}

#[test]
fn replay() {
    let mut reader = reader("replay", |bytes| {
        let journal = match JournalFile::from_bytes(bytes) {
            Ok(journal) => journal,
            Err(error) => return Reading::Refused(error.to_string()),
        };
        if journal.operations.iter().map(splits).sum::<usize>() > 2 || journal.operations.len() > 60 {
            return Reading::Refused("too much work for a test".into());
        }
        let mut editor = Editor::new(journal.start.clone());
        let mut refused = 0;
        for operation in &journal.operations {
            let steps = editor.undo_len();
            let before = editor.body().clone();
            if let Err(refusal) = editor.apply(operation) {
                refused += 1;
                assert!(!refusal.to_string().is_empty());
                assert!(
                    editor.undo_len() == steps && *editor.body() == before,
                    "a refusal changed something"
                );
            }
        }
        let end = editor.body().clone();
        let written = end.to_file_bytes().unwrap_or_else(|error| panic!("no longer a body: {error}"));
        assert!(Body::from_file_bytes(&written).expect("what was written is read") == end);
        let again = JournalFile::of(&editor);
        assert!(again.start == journal.start);
        assert!(*again.replay().expect("what was done can be done again").body() == end);
        while editor.undo() {}
        assert!(*editor.body() == journal.start, "undone is not the start");
        Reading::Sound(vec![end.face_count(), journal.operations.len(), refused, end.joint_count()])
    });
    // Operators make bodies larger than the file that asks for them: two splits sixteen times, and all of it is kept to
    // be undone.
    reader.base_memory = 4 << 20;
    reader.memory_factor = 16 * 600;
    reader.inputs = 3_000;
    run(reader);
}
