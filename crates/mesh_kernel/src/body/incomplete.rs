//! Bodies built up step by step, without a journal: nodes that stand alone, wires, single faces, joints.
//!
//! A surface is sound at every step (K1: it may be *incomplete*), so a designer can stop anywhere. Whole patches are made
//! faster by [`Body::build`]. Whoever wants to undo works with an [`Editor`], whose operators these are.

use glam::DVec3;

use super::Body;
use super::build::{BuildError, JointLabel, JointSpec, LoopPlaces, make_loop, place_run, run_of};
use super::edit::{Editor, EulerError, FaceSplit, SplitFaceError};
use super::ids::{EdgeId, FaceId, JointId, NodeId, SurfaceId};
use super::joint::Joint;
use super::surface::{NO_CHAIN, Surface};

impl Body {
    /// Runs operators that nobody is going to undo.
    fn edit<T>(&mut self, edit: impl FnOnce(&mut Editor) -> T) -> T {
        let mut editor = Editor::without_journal(std::mem::take(self));
        let result = edit(&mut editor);
        *self = editor.into_body();
        result
    }

    /// Adds an empty surface.
    pub fn add_surface(&mut self, name: &str) -> SurfaceId {
        self.edit(|e| e.add_surface(name))
    }

    /// Adds a node that stands alone: [`Editor::make_vertex_complex`].
    ///
    /// # Errors
    /// Unknown surface; a position that is not finite.
    pub fn add_node(&mut self, surface: SurfaceId, position: DVec3) -> Result<NodeId, EulerError> {
        self.edit(|e| e.make_vertex_complex(surface, position))
    }

    /// Adds an edge without faces, from `a` to `b`: [`Editor::make_edge`].
    ///
    /// # Errors
    /// Unknown ids; one node twice; an edge that is there. O(size of the body).
    pub fn add_edge(&mut self, surface: SurfaceId, a: NodeId, b: NodeId) -> Result<EdgeId, EulerError> {
        Ok(self.edit(|e| e.make_edge(surface, a, b))?.0)
    }

    /// Adds a face with corners `nodes`, anticlockwise seen from outside: [`Editor::make_edge`] for the sides that are
    /// missing and [`Editor::make_face`]. The surface's boundary loops are found anew, and with them its chains on no
    /// joint.
    ///
    /// # Errors
    /// Unknown ids; one node twice; an edge that a face runs over in the same direction, or that lies on a joint. Nothing
    /// is changed then. O(size of the body).
    pub fn add_face(&mut self, surface: SurfaceId, nodes: [NodeId; 3]) -> Result<FaceId, EulerError> {
        self.edit(|e| {
            e.transaction(|e| {
                let mut sides = [EdgeId(0); 3];
                for i in 0..3 {
                    let (a, b) = (nodes[i], nodes[(i + 1) % 3]);
                    let there = e.body().surfaces.get(surface.index()).and_then(|s| s.find_edge(a, b));
                    sides[i] = match there {
                        Some(edge) => edge,
                        None => e.make_edge(surface, a, b)?.0,
                    };
                }
                Ok(e.make_face(surface, sides)?.0)
            })
        })
    }

    /// Splits a face into four: [`Editor::split_face`].
    ///
    /// # Errors
    /// Unknown ids; ids run out. Nothing is changed then. O(edges of the chains concerned).
    pub fn split_face(&mut self, surface: SurfaceId, face: FaceId) -> Result<FaceSplit, SplitFaceError> {
        self.edit(|e| e.split_face(surface, face))
    }

    /// Adds a joint. Boundary loops of its surfaces are cut anew, and with them their chains on no joint.
    ///
    /// # Errors
    /// As [`Body::build`]. Nothing is changed then. O(faces of its surfaces).
    pub fn add_joint(&mut self, spec: &JointSpec) -> Result<JointId, BuildError> {
        let (next, id) = self.with_joint(spec)?;
        *self = next;
        Ok(id)
    }

    /// The body with a joint more.
    pub(super) fn with_joint(&self, spec: &JointSpec) -> Result<(Self, JointId), BuildError> {
        let id = JointId(self.joint_slots.next(self.joints.len()));
        let mut labels: Vec<JointLabel> = self
            .joints
            .iter()
            .enumerate()
            .map(|(index, j)| JointLabel { index, name: j.name.clone() })
            .collect();
        let label = JointLabel { index: id.index(), name: spec.name.clone() };
        match labels.get_mut(id.index()) {
            Some(free) => *free = label.clone(),
            None => labels.push(label.clone()),
        }
        if spec.chains.len() < 2 {
            return Err(BuildError::TooFew { joint: label });
        }
        if let Some(chain) = spec.chains.iter().find(|c| c.surface >= self.surfaces.len()) {
            return Err(BuildError::NoSurface { joint: label, surface: chain.surface });
        }
        let mut touched: Vec<usize> = spec.chains.iter().map(|c| c.surface).collect();
        touched.sort_unstable();
        touched.dedup();
        let mut next = self.clone();
        for &s in &touched {
            next.surfaces[s].drop_loops();
        }
        let mut lengths = Vec::new();
        let mut uses = Vec::new();
        for chain in &spec.chains {
            let surface = &mut next.surfaces[chain.surface];
            let run = run_of(surface, &surface.edge_index(), chain, &label)?;
            lengths.push(run.edges.len());
            let places = LoopPlaces::new(surface.edges.len(), &surface.boundary_cycles());
            uses.push(place_run(surface, &places, run, id.index(), &labels)?);
        }
        if lengths.iter().any(|&n| n != lengths[0]) {
            return Err(BuildError::Lengths { joint: label, lengths });
        }
        for &s in &touched {
            next.surfaces[s].find_loops();
        }
        let joint = Joint { name: spec.name.clone(), uses, radial: Vec::new() };
        match next.joint_slots.take() {
            Some(free) => next.joints[free as usize] = joint,
            None => next.joints.push(joint),
        }
        next.meet(&labels)?;
        next.order_joint(id);
        Ok((next, id))
    }
}

impl Surface {
    /// Forgets loops and the chains on no joint, which come last: chains of joints keep their numbers.
    pub(crate) fn drop_loops(&mut self) {
        let last = self.chains.iter().rposition(|c| c.joint.is_some()).map_or(0, |i| i + 1);
        let free = self.slots.chains.free().iter().max().map_or(0, |&i| i as usize + 1);
        for chain in self.chains.drain(last.max(free)..) {
            for d in chain.edges {
                self.edge_chain[d.edge().index()] = NO_CHAIN;
            }
        }
        debug_assert!(
            self.chains.iter().all(|c| c.joint.is_some() || c.is_free()),
            "chains of joints come first"
        );
        self.chains.iter_mut().for_each(|c| c.on_loop = None);
        self.loops.clear();
    }

    /// Finds boundary loops and cuts them at the chains of joints.
    pub(crate) fn find_loops(&mut self) {
        for cycle in self.boundary_cycles() {
            make_loop(self, &cycle);
        }
    }
}
