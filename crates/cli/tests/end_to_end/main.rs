//! Runs of the built binary `toile`: exit codes, reports, files.
//!
//! `cargo test --release -p cli` builds the binary first. With `TOILE_BIN` set, another binary is tried instead.
//! Tests on bodies outside the repository (`../shared/bodies`) pass by when the folder is missing, unless
//! `TOILE_REQUIRE_SHARED=1`.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod batch;
mod bodies;
mod call;
mod damaged;
mod deflate;
mod fixtures;
mod forms;
mod models;
mod regenerate;
mod sheet_metal;
mod thicken;
mod threads;
mod words;
