//! Tests of the sheet crate through its public face, on sheets and solids made here.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod deflate;
mod model;
mod thicken;
mod unfold;
