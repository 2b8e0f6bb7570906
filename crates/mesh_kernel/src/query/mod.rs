//! Geometric queries on triangle meshes.
//!
//! * [`Adjacency`]: edges, neighbours, boundary loops, components;
//! * [`ClosestPoint`]: the nearest point of a mesh;
//! * [`Crossings`]: faces that cross faces;
//! * [`SectionStack`], [`plane_section`]: cuts with planes; [`tape_length`]: what a tape measure reads on one.

mod adjacency;
mod bvh;
mod closest;
mod crossing;
mod hull;
mod section;
mod triangle_pair;

pub use adjacency::Adjacency;
pub use closest::{Closest, ClosestPoint};
pub use crossing::Crossings;
pub use hull::{convex_hull_in_plane, tape_length};
pub use section::{SectionLoop, SectionStack, plane_section};
