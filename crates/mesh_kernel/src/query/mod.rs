//! Geometric queries on triangle meshes.
//!
//! * [`Geodesics`], [`shortest_path`]: shortest paths on the surface;
//! * [`Adjacency`]: edges, neighbours, boundary loops, components;
//! * [`ClosestPoint`]: the nearest point of a mesh;
//! * [`SignedDistance`]: the same with a side, right on meshes with holes; [`WindingNumber`];
//! * [`Crossings`]: faces that cross faces;
//! * [`SectionStack`], [`plane_section`]: cuts with planes; [`tape_length`]: what a tape measure reads on one.

mod adjacency;
mod bvh;
mod closest;
mod crossing;
mod geodesic;
mod hull;
mod section;
mod signed_distance;
mod strip;
mod triangle_pack;
mod triangle_pair;
mod welded;
mod winding;

pub use adjacency::Adjacency;
pub use closest::{Closest, ClosestPoint};
pub use crossing::Crossings;
pub use geodesic::{Geodesics, SurfacePath, shortest_path};
pub use hull::{convex_hull_in_plane, tape_length};
pub use section::{SectionLoop, SectionStack, plane_section};
pub use signed_distance::{Signed, SignedDistance};
pub use winding::{Winding, WindingNumber, winding_number};
