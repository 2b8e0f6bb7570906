//! Tests of the pattern crate through its public face, on surfaces made here.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod files;
mod finishing;
mod flattening;
mod refusals;
mod surfaces;
