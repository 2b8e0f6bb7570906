//! Operators that make and kill faces on edges that are there.

use super::edges::Form;
use super::{EulerError, FaceRole};
use crate::body::edit::Editor;
use crate::body::edit::operation::Operation;
use crate::body::{Body, EdgeId, FaceId, JointId, NONE, NodeId, Surface, SurfaceId};

impl Surface {
    /// Corners of the triangle that runs over three edges in order: corner `i` where side `i` starts.
    fn triangle(&self, sides: [EdgeId; 3]) -> Option<[u32; 3]> {
        let ends = sides.map(|e| self.edges[e.index()]);
        let common = |a: [u32; 2], b: [u32; 2]| a.into_iter().find(|v| b.contains(v));
        let corners = [common(ends[2], ends[0])?, common(ends[0], ends[1])?, common(ends[1], ends[2])?];
        let [a, b, c] = corners;
        let closed = (0..3).all(|i| ends[i].contains(&corners[i]) && ends[i].contains(&corners[(i + 1) % 3]));
        (closed && a != b && b != c && c != a).then_some(corners)
    }

    /// The node at which a joint's chain runs on past the face, with the joint: the boundary edges at both ends of the
    /// face's fan there follow each other on the chain.
    fn joint_past(&self, face: FaceId) -> Option<(NodeId, JointId)> {
        for i in 0..3 {
            let node = NodeId(self.faces[face.index()][i]);
            // Backwards round the node to the boundary edge that ends there.
            let mut into = self.face_side(face, (i + 2) % 3);
            let start = into;
            loop {
                let beyond = self.face_left(into.flipped());
                if beyond == NONE {
                    break;
                }
                let f = FaceId(beyond);
                let Some(k) = self.faces[f.index()].iter().position(|&v| v == node.0) else { break };
                into = self.face_side(f, (k + 2) % 3);
                if into == start {
                    break;
                }
            }
            let Some(chain) = self.edge_chain(into.edge()).map(|c| self.chain(c)) else { continue };
            let (Some(joint), true) = (chain.joint, chain.on_loop.is_some()) else { continue };
            let Some(at) = chain.edges.iter().position(|&d| d == into) else { continue };
            if self.face_left(into.flipped()) == NONE
                && let Some(&next) = chain.edges.get(at + 1)
                && self.next_on_boundary(into) == Some(next)
            {
                return Some((node, joint));
            }
        }
        None
    }
}

impl Body {
    /// A face with the same three nodes in the welded body. O(nodes + faces).
    fn same_face(&self, surface: SurfaceId, corners: [u32; 3]) -> Option<(SurfaceId, FaceId)> {
        let sorted = |mut c: [u32; 3]| {
            c.sort_unstable();
            c
        };
        let weld = self.weld();
        let own = sorted(corners.map(|v| weld.node(surface, v)));
        self.surfaces().find_map(|(id, s)| {
            let same = |f: &FaceId| sorted(s.faces[f.index()].map(|v| weld.node(id, v))) == own;
            s.live_faces().find(same).map(|f| (id, f))
        })
    }
}

fn check_form(
    form: Form<FaceRole>,
    role: FaceRole,
    surface: SurfaceId,
    corners: [u32; 3],
) -> Result<(), EulerError> {
    let nodes = corners.map(NodeId);
    match (form, role) {
        (Form::Strict(FaceRole::Closing), FaceRole::Filling) => Err(EulerError::FillsHole { surface, nodes }),
        (Form::Strict(FaceRole::Filling), FaceRole::Closing) => {
            Err(EulerError::ClosesCavity { surface, nodes })
        }
        _ => Ok(()),
    }
}

impl Editor {
    /// Makes a triangle over three edges, each of which starts where the one before ends: the order of the edges is the
    /// face's anticlockwise turn, and its corner 0 lies where side 0 starts. Says whether the face fills a hole or closes a
    /// cavity. The surface's boundary loops are found anew.
    ///
    /// f + 1, and ch − 1 for [`FaceRole::Filling`], cc + 1 for [`FaceRole::Closing`]. Inverse: [`Editor::kill_face`].
    ///
    /// # Errors
    /// Unknown edges; edges that are no triangle; a face that runs over one in the same direction, or has the same nodes;
    /// an edge on a joint. O(nodes + faces of the body).
    pub fn make_face(
        &mut self,
        surface: SurfaceId,
        sides: [EdgeId; 3],
    ) -> Result<(FaceId, FaceRole), EulerError> {
        self.make_face_as(surface, sides, Form::Free)
    }

    /// Makes a triangle that fills a hole: f + 1, ch − 1. Inverse: [`Editor::kill_face_make_chole`].
    ///
    /// # Errors
    /// As [`Editor::make_face`]; a face that would close a cavity.
    pub fn make_face_kill_chole(
        &mut self,
        surface: SurfaceId,
        sides: [EdgeId; 3],
    ) -> Result<FaceId, EulerError> {
        Ok(self.make_face_as(surface, sides, Form::Strict(FaceRole::Filling))?.0)
    }

    /// Makes a triangle that closes a cavity: f + 1, cc + 1. Inverse: [`Editor::kill_face_kill_cavity`].
    ///
    /// # Errors
    /// As [`Editor::make_face`]; a face that would fill a hole.
    pub fn make_face_make_cavity(
        &mut self,
        surface: SurfaceId,
        sides: [EdgeId; 3],
    ) -> Result<FaceId, EulerError> {
        Ok(self.make_face_as(surface, sides, Form::Strict(FaceRole::Closing))?.0)
    }

    fn make_face_as(
        &mut self,
        surface: SurfaceId,
        sides: [EdgeId; 3],
        form: Form<FaceRole>,
    ) -> Result<(FaceId, FaceRole), EulerError> {
        for edge in sides {
            self.body.checked_edge(surface, edge)?;
        }
        let s = self.body.checked_surface(surface)?;
        let corners = s.triangle(sides).ok_or(EulerError::NoTriangle { surface, edges: sides })?;
        for (edge, corner) in sides.into_iter().zip(corners) {
            if let Some(joint) = s.joint_of(edge) {
                return Err(EulerError::EdgeOnJoint { surface, edge, joint });
            }
            let face = s.edge_faces[edge.index()][usize::from(s.edges[edge.index()][0] != corner)];
            if face != NONE {
                return Err(EulerError::SideTaken { surface, edge, face: FaceId(face) });
            }
        }
        if let Some((surface, face)) = self.body.same_face(surface, corners) {
            return Err(EulerError::FaceExists { surface, face });
        }
        let face = FaceId(s.slots.faces.next(s.faces.len()));
        // Round an edge of its own the face has one side only. Else the face is hung into the surface for the walk, and
        // taken off again.
        let bare = sides.iter().any(|e| self.body.surface(surface).edge_faces[e.index()] == [NONE; 2]);
        let role = if bare {
            FaceRole::Filling
        } else {
            let mut trial = self.trial(surface);
            trial.add_face(corners, sides.map(|e| e.0));
            let mut delta = trial.finish();
            let one = self.body.sides_are_one(surface, face);
            delta.exchange(&mut self.body);
            if one { FaceRole::Filling } else { FaceRole::Closing }
        };
        check_form(form, role, surface, corners)?;
        let operation = || match form {
            Form::Free => Operation::MakeFace { surface, sides },
            Form::Strict(FaceRole::Filling) => Operation::MakeFaceKillChole { surface, sides },
            Form::Strict(FaceRole::Closing) => Operation::MakeFaceMakeCavity { surface, sides },
        };
        self.record(surface, operation, |r| {
            r.add_face(corners, sides.map(|e| e.0));
            r.rebuild_loops();
        });
        Ok((face, role))
    }

    /// Kills a face; its edges stay. Says whether it filled a hole or closed a cavity. The surface's boundary loops are
    /// found anew.
    ///
    /// f − 1, and ch + 1 for [`FaceRole::Filling`], cc − 1 for [`FaceRole::Closing`]. Inverse: [`Editor::make_face`].
    ///
    /// # Errors
    /// Unknown face; an edge on a joint, or a joint that runs past it in a node; attributes in it. O(faces of the body).
    pub fn kill_face(&mut self, surface: SurfaceId, face: FaceId) -> Result<FaceRole, EulerError> {
        self.kill_face_as(surface, face, Form::Free)
    }

    /// Kills a face that fills a hole: f − 1, ch + 1. Inverse: [`Editor::make_face_kill_chole`].
    ///
    /// # Errors
    /// As [`Editor::kill_face`]; a face that closes a cavity.
    pub fn kill_face_make_chole(&mut self, surface: SurfaceId, face: FaceId) -> Result<(), EulerError> {
        self.kill_face_as(surface, face, Form::Strict(FaceRole::Filling)).map(|_| ())
    }

    /// Kills a face that closes a cavity: f − 1, cc − 1. Inverse: [`Editor::make_face_make_cavity`].
    ///
    /// # Errors
    /// As [`Editor::kill_face`]; a face that fills a hole.
    pub fn kill_face_kill_cavity(&mut self, surface: SurfaceId, face: FaceId) -> Result<(), EulerError> {
        self.kill_face_as(surface, face, Form::Strict(FaceRole::Closing)).map(|_| ())
    }

    fn kill_face_as(
        &mut self,
        surface: SurfaceId,
        face: FaceId,
        form: Form<FaceRole>,
    ) -> Result<FaceRole, EulerError> {
        let s = self.body.checked_face(surface, face)?;
        for e in s.face_edges[face.index()] {
            let edge = EdgeId(e);
            if let Some(joint) = s.joint_of(edge) {
                return Err(EulerError::EdgeOnJoint { surface, edge, joint });
            }
        }
        if let Some((node, joint)) = s.joint_past(face) {
            return Err(EulerError::JointPassesFace { surface, face, node, joint });
        }
        if s.carries_attributes(&[], &[face.0]) {
            return Err(EulerError::CarriesAttributes { surface, what: format!("face {face}") });
        }
        let corners = s.faces[face.index()];
        let role = if self.body.sides_are_one(surface, face) { FaceRole::Filling } else { FaceRole::Closing };
        check_form(form, role, surface, corners)?;
        let operation = || match form {
            Form::Free => Operation::KillFace { surface, face },
            Form::Strict(FaceRole::Filling) => Operation::KillFaceMakeChole { surface, face },
            Form::Strict(FaceRole::Closing) => Operation::KillFaceKillCavity { surface, face },
        };
        self.record(surface, operation, |r| {
            r.remove_face(face.0);
            r.rebuild_loops();
        });
        Ok(role)
    }
}
