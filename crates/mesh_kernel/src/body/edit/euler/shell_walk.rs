//! Walks over the sides of faces, round edges and through joints in radial order.

use std::collections::BTreeSet;

use crate::body::{Body, FaceId, NONE, Side, SurfaceId};

/// A side of a face: the one where its normal looks, or the other.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) struct FaceView {
    pub(super) surface: SurfaceId,
    pub(super) face: u32,
    pub(super) front: bool,
}

impl Body {
    /// Whether one can walk from the front of a face to its back without crossing a face. O(faces of the shell · log, and
    /// times the length of joints passed).
    pub(super) fn sides_are_one(&self, surface: SurfaceId, face: FaceId) -> bool {
        let start = FaceView { surface, face: face.0, front: true };
        let goal = FaceView { front: false, ..start };
        // Most faces have an edge of their own: round it lies the other side.
        if self.neighbours(start).contains(&goal) {
            return true;
        }
        let mut seen = BTreeSet::from([start]);
        let mut open = vec![start];
        while let Some(view) = open.pop() {
            for next in self.neighbours(view) {
                if next == goal {
                    return true;
                }
                if seen.insert(next) {
                    open.push(next);
                }
            }
        }
        false
    }

    /// The sides that bound the same sector at the three edges of a face.
    fn neighbours(&self, view: FaceView) -> [FaceView; 3] {
        [0, 1, 2].map(|i| self.across(view, i))
    }

    fn across(&self, view: FaceView, side: usize) -> FaceView {
        let s = self.surface(view.surface);
        let d = s.face_side(FaceId(view.face), side);
        let joint = s.edge_chain(d.edge()).and_then(|c| s.chain(c).joint.map(|j| (c, j)));
        let Some((chain, joint)) = joint else {
            let other = s.face_left(d.flipped());
            return if other == NONE {
                FaceView { front: !view.front, ..view }
            } else {
                FaceView { face: other, ..view }
            };
        };
        let uses = self.joint(joint).uses();
        let own = uses.iter().position(|u| (u.surface, u.chain) == (view.surface, chain));
        let at = s.chain(chain).edges().iter().position(|x| x.edge() == d.edge());
        let (Some(own), Some(at)) = (own, at) else { return view };
        let k = if uses[own].reversed { s.chain(chain).edges().len() - 1 - at } else { at };
        let along = self.joint_edge(joint, own, k) == d;
        let radial = self.joint(joint).radial();
        let place = radial.iter().position(|x| {
            x.use_index as usize == own && x.side == if along { Side::Left } else { Side::Right }
        });
        let Some(place) = place else { return view };
        // A face that runs along the joint has its normal onwards in the radial order (right hand).
        let onwards = along == view.front;
        let n = radial.len();
        let next = radial[if onwards { place + 1 } else { place + n - 1 } % n];
        let d = self.joint_edge(joint, next.use_index as usize, k);
        let left = next.side == Side::Left;
        let surface = uses[next.use_index as usize].surface;
        let face = self.surface(surface).face_left(if left { d } else { d.flipped() });
        // Onwards one meets the side that looks back, backwards the one that looks onwards.
        FaceView { surface, face, front: left != onwards }
    }
}
