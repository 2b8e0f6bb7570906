//! Geometric queries on triangle meshes.
//!
//! * [`Geodesics`], [`shortest_path`]: shortest paths on the surface;
//! * [`Adjacency`]: edges, neighbours, boundary loops, components;
//! * [`ClosestPoint`]: the nearest point of a mesh;
//! * [`SignedDistance`]: the same with a side, right on meshes with holes; [`WindingNumber`];
//! * [`Crossings`]: faces that cross faces;
//! * [`RayCaster`]: the first face that a ray meets;
//! * [`SectionStack`], [`plane_section`]: cuts with planes; [`tape_length`]: what a tape measure reads on one.
//!
//! Each query is a struct that is prepared once for a mesh and then asked from any number of threads; answers do not
//! depend on their number. Meshes may be open, non-manifold or inconsistently oriented.
//!
//! ```
//! use mesh_kernel::TriMesh;
//! use mesh_kernel::glam::DVec3;
//! use mesh_kernel::query::{SectionStack, SignedDistance, tape_length};
//!
//! // A tetrahedron, faces outward.
//! let positions = vec![DVec3::ZERO, DVec3::X * 10.0, DVec3::Y * 10.0, DVec3::Z * 10.0];
//! let mesh = TriMesh::new(positions, vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]);
//! let query = SignedDistance::new(&mesh);
//! assert_eq!(query.signed(DVec3::new(1.0, 2.0, 3.0)).distance, -1.0);
//!
//! let loops = SectionStack::new(&mesh, DVec3::Y).cut(5.0);
//! let girth = tape_length(&loops[0].points, DVec3::Y);
//! assert!((girth - (10.0 + 50f64.sqrt())).abs() < 1e-12);
//! ```

mod adjacency;
mod bvh;
mod closest;
mod crossing;
mod geodesic;
mod hull;
mod ray;
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
pub use ray::{RayCaster, RayHit};
pub use section::{SectionLoop, SectionStack, plane_section};
pub use signed_distance::{Signed, SignedDistance};
pub(crate) use triangle_pair::faces_meet_beyond_shared;
pub use winding::{Winding, WindingNumber, winding_number};
