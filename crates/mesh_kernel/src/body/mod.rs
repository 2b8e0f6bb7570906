//! The non-manifold body: surfaces, joints, loops, chains, attributes.
//!
//! A [`Body`] (Wang et al., *Feature based 3D design around a reference model*: BODY) is made of [`Surface`]s,
//! triangle patches in which an edge has at most two faces, and of [`Joint`]s, which say where chains of their edges
//! meet. Everything non-manifold is in the joints: any number of sheets may leave one, in a stored radial order, and
//! a surface may meet a joint twice, at its boundary or inside.
//!
//! Every surface has its own nodes. What joints hold together is found by [`Body::weld`]; the positions of such nodes
//! are kept equal bit for bit.
//!
//! ```
//! use mesh_kernel::body::{Body, ChainSpec, JointSpec, SurfaceSpec};
//! use mesh_kernel::glam::DVec3;
//!
//! // Three flaps on the edge from the origin along z: a T.
//! let flap = |name: &str, apex: DVec3| SurfaceSpec {
//!     name: name.into(),
//!     positions: vec![DVec3::ZERO, DVec3::Z * 40.0, apex],
//!     faces: vec![[0, 1, 2]],
//! };
//! let flaps = [DVec3::X, DVec3::NEG_X, DVec3::Y].map(|d| flap("flap", d * 30.0));
//! let chains = (0..3).map(|surface| ChainSpec { surface, nodes: vec![0, 1], closed: false }).collect();
//! let mut body = Body::build(&flaps, &[JointSpec { name: Some("rib".into()), chains }])?;
//!
//! body.split_all(None)?;
//! assert_eq!(body.to_tri_mesh().faces.len(), 12);
//! assert_eq!(body.to_tri_mesh().positions.len(), 12);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod adjacency;
mod attribute;
mod build;
mod carry;
mod chain;
mod check;
mod compact;
mod counts;
pub mod edit;
mod file;
mod free_boundary;
mod from_tri_mesh;
mod homology;
mod ids;
mod incomplete;
mod joint;
mod mend_lines;
mod mesh_joints;
mod pairing;
pub(crate) mod radial;
mod radial_order;
mod regions;
mod sectors;
mod shells;
mod slots;
mod split_all;
mod surface;
pub(crate) mod weld;
mod welded;

pub use adjacency::EdgeIndex;
pub use attribute::{AttributeEdge, AttributeError, AttributeNode};
pub use build::{BuildError, ChainSpec, JOINT_SNAP, JointLabel, JointSpec, SurfaceSpec};
pub use chain::{Chain, Loop};
pub use check::Defect;
pub use compact::{Compaction, SurfaceCompaction};
pub use counts::Counts;
pub use edit::{FaceSplit, SplitEdge, SplitFaceError};
pub use file::{BODY_FILE_EXTENSION, BODY_FILE_VERSION, BodyFileError};
pub use free_boundary::{BoundaryLine, FreeEdge};
pub use ids::{
    AttributeEdgeId, AttributeNodeId, ChainId, DirectedEdge, EdgeId, FaceId, JointId, LoopId, NONE, NodeId,
    SurfaceId,
};
pub use joint::{Joint, JointUse, Sheet, Side};
pub use pairing::{
    Contact, EdgePairings, Fan, FanKind, NodeFans, Pairing, PairingError, Resolution, Through,
};
pub use radial::order_about_edge;
pub use regions::{FaceSide, FaceUse, Region, Regions};
pub use sectors::{Crossing, EdgeSector, Sector};
pub use split_all::{SplitError, SplitMap, SurfaceSplit};
pub use surface::{Star, Surface};
pub use weld::Weld;

use slots::Slots;

/// A complex of surfaces and the joints where they meet.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Body {
    pub(crate) surfaces: Vec<Surface>,
    pub(crate) joints: Vec<Joint>,
    /// Free numbers of joints.
    pub(crate) joint_slots: Slots,
}

impl Body {
    /// The surfaces in order of their ids.
    pub fn surfaces(&self) -> impl ExactSizeIterator<Item = (SurfaceId, &Surface)> {
        self.surfaces.iter().enumerate().map(|(i, s)| (SurfaceId(i as u32), s))
    }

    /// The ids of the surfaces in order.
    pub fn surface_ids(&self) -> impl ExactSizeIterator<Item = SurfaceId> + use<> {
        (0..self.surfaces.len() as u32).map(SurfaceId)
    }

    /// One surface.
    pub fn surface(&self, id: SurfaceId) -> &Surface {
        &self.surfaces[id.index()]
    }

    /// One surface, to move its nodes and set attributes.
    pub fn surface_mut(&mut self, id: SurfaceId) -> &mut Surface {
        &mut self.surfaces[id.index()]
    }

    /// The surface of that name, the first where several have it.
    pub fn surface_named(&self, name: &str) -> Option<SurfaceId> {
        self.surfaces.iter().position(|s| s.name == name).map(|i| SurfaceId(i as u32))
    }

    /// The joints in order of their ids.
    pub fn joints(&self) -> impl Iterator<Item = (JointId, &Joint)> {
        self.joints
            .iter()
            .enumerate()
            .map(|(i, j)| (JointId(i as u32), j))
            .filter(|(_, j)| !j.uses.is_empty())
    }

    /// The ids of the joints in order.
    pub fn joint_ids(&self) -> impl Iterator<Item = JointId> + use<> {
        let ids: Vec<JointId> = self.joints().map(|(id, _)| id).collect();
        ids.into_iter()
    }

    /// How many joints there are.
    pub fn joint_count(&self) -> usize {
        self.joints.len() - self.joint_slots.free().len()
    }

    /// Whether a joint of that number lives.
    pub fn is_joint(&self, id: JointId) -> bool {
        self.joints.get(id.index()).is_some_and(|j| !j.uses.is_empty())
    }

    /// Whether no number of any kind is free. Bodies are compact until an operator removes something;
    /// [`Body::compact`] closes the gaps.
    pub fn is_compact(&self) -> bool {
        self.joint_slots.is_compact() && self.surfaces.iter().all(Surface::is_compact)
    }

    /// One joint.
    pub fn joint(&self, id: JointId) -> &Joint {
        &self.joints[id.index()]
    }

    /// Area of all surfaces, in mm².
    pub fn area(&self) -> f64 {
        self.surfaces.iter().map(Surface::area).sum()
    }

    /// Faces of all surfaces.
    pub fn face_count(&self) -> usize {
        self.surfaces.iter().map(|s| s.live_counts()[2]).sum()
    }
}
