//! Tests of the template crate through its public face, on bodies made here.

mod collision;
mod encoding;
mod fairing;
mod format;
mod human;
mod joints;
mod model;
mod symmetry;
