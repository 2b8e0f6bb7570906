//! The command line of toile.
fn main() {}
