//! Tests of the kernel through its public face.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod body;
mod complex;
mod files;
mod merge;
mod operator_docs;
mod query;
mod shapes;
