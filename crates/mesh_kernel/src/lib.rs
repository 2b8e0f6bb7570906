//! Non-manifold triangle bodies: surfaces, joints, operators, checks, queries, mesh files.
//!
//! * [`tri_mesh`]: an indexed triangle soup, what files hold and queries run on;
//! * [`body`]: the non-manifold body: surfaces, joints, loops, chains, attributes;
//! * [`query`]: closest point, inside, plane sections, shortest paths, crossings;
//! * [`files`]: OBJ, PLY, STL, OFF and GLB in and out.
//!
//! Lengths are millimetres and angles radians everywhere inside; files convert at the door.

pub mod body;
pub mod complex;
pub mod files;
pub mod merge;
pub mod query;
pub mod tri_mesh;

pub use glam;
pub use tri_mesh::{Group, MAX_COORDINATE, TriMesh};
