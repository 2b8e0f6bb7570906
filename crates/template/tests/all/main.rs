//! Tests of the template crate through its public face, on bodies made here.

#![allow(clippy::unwrap_used)] // a test that cannot go on fails; its makers of input lie outside #[test]

mod adaptive;
mod collision;
mod encoding;
mod fairing;
mod format;
mod human;
mod joints;
mod model;
mod symmetry;
