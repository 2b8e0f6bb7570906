//! Non-manifold triangle bodies: surfaces, joints, operators, checks, queries, mesh files.
//!
//! Lengths are millimetres and angles radians everywhere inside; files convert at the door.

pub mod tri_mesh;

pub use glam;
pub use tri_mesh::{Group, TriMesh};
