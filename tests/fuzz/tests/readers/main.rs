//! Every reader of the libraries on damaged files. See the crate's documentation.

mod bodies;
mod complexes;
mod designs;
mod finds;
mod journals;
mod meshes;
mod scripts;

use fuzz::{CountingAllocator, Reader, fuzz};

#[global_allocator]
static MEMORY: CountingAllocator = CountingAllocator::new();

#[allow(clippy::print_stdout, reason = "the report of a long run")]
fn run(reader: Reader) {
    let report = fuzz(reader, &MEMORY);
    println!("{report}");
    assert!(report.finds.is_empty(), "{report}");
    assert!(report.refused > report.inputs / 20 && report.refused < report.inputs, "{report}");
}
