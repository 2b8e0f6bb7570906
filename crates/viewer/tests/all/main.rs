//! Tests of the pictures.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

mod pixels;
mod sound;
