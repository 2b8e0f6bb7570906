//! Edge swap: the other diagonal of the two faces at an edge.
//!
//! ```text
//!        c                 c
//!      /   \             / | \
//!     a-----b    →      a  |  b
//!      \   /             \ | /
//!        d                 d
//! ```
//!
//! Counts do not change (v, e, f + 0). In K3 terms: kill the face on one side with its edge (KEF), make the other edge
//! with a face (MEF).

use super::Editor;
use super::carry_attributes::SwapCarry;
use super::journal::{Attributes, Record};
use super::link_condition::Neighbourhood;
use super::stars::{LAST, NEXT, Stars};
use crate::body::ids::listed;
use crate::body::{EdgeId, JointId, NONE, NodeId, Surface, SurfaceId};

/// Why an edge was not swapped.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum SwapError {
    /// No such edge.
    #[error("surface {surface} has no edge {edge}")]
    NoEdge {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// The edge has not two faces.
    #[error("edge {edge} of surface {surface} has not a face on both sides")]
    NotInside {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
    /// The edge lies on a joint, which holds it to the edges of other sheets.
    #[error(
        "edge {edge} of surface {surface} lies on joint {joint} of surfaces {}; take it off the joint first",
        listed(sheets)
    )]
    OnJoint {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
        /// Joint.
        joint: JointId,
        /// Surfaces that meet there.
        sheets: Vec<SurfaceId>,
    },
    /// The other diagonal is an edge already, in the surface or between nodes that joints make one with these.
    #[error("surface {surface}: nodes {} and {} are joined already, there or through joints; swapping would make the edge twice", nodes[0], nodes[1])]
    EdgeExists {
        /// Surface.
        surface: SurfaceId,
        /// Ends of the other diagonal.
        nodes: [NodeId; 2],
    },
    /// A new face would be turned over or degenerate.
    #[error("swapping edge {edge} of surface {surface} would turn a face over or flatten it")]
    Turns {
        /// Surface.
        surface: SurfaceId,
        /// Edge.
        edge: EdgeId,
    },
}

/// Whether an operator looks at the geometry.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum Guard {
    /// Topology alone decides.
    #[default]
    None,
    /// No new face may be degenerate or look away from a face that it replaces.
    NoTurn,
}

impl Editor {
    /// Swaps an edge for the other diagonal of its two faces; the edge and the faces keep their numbers. The edge turns
    /// anticlockwise: it runs from the corner of its right face to that of its left face.
    ///
    /// # Errors
    /// See [`SwapError`]; nothing is changed then. O(1).
    pub fn swap_edge(&mut self, surface: SurfaceId, edge: EdgeId, guard: Guard) -> Result<(), SwapError> {
        self.can_swap(surface, edge, guard)?;
        let s = self.body.surface(surface);
        let carries =
            !s.attribute_nodes.is_empty() && s.carries_attributes(&[edge.0], &s.edge_faces[edge.index()]);
        let attributes = carries.then(|| Box::new(Attributes::of(s)));
        self.perform(Record::SwapEdge { surface, edge, attributes });
        Ok(())
    }

    fn can_swap(&mut self, surface: SurfaceId, edge: EdgeId, guard: Guard) -> Result<(), SwapError> {
        let missing = SwapError::NoEdge { surface, edge };
        let Some(s) = self.body.surfaces.get(surface.index()) else { return Err(missing) };
        if !s.is_edge(edge) {
            return Err(missing);
        }
        let [left, right] = s.edge_faces[edge.index()];
        if left == NONE || right == NONE {
            return Err(SwapError::NotInside { surface, edge });
        }
        if let Some(joint) = s.edge_chain(edge).and_then(|c| s.chain(c).joint()) {
            let sheets = self.body.joint(joint).uses().iter().map(|u| u.surface).collect();
            return Err(SwapError::OnJoint { surface, edge, joint, sheets });
        }
        let diamond = Diamond::at(s, edge.0);
        let [c, d] = diamond.tips(s);
        let stars = self.stars[surface.index()].get_or_insert_with(|| Stars::new(s));
        if c == d || diamond.joined(s, stars, c, d) {
            return Err(SwapError::EdgeExists { surface, nodes: [NodeId(c), NodeId(d)] });
        }
        let held = stars.is_held(c) || stars.is_held(d);
        if held && Neighbourhood::new(self).joined((surface, c), (surface, d)) {
            return Err(SwapError::EdgeExists { surface, nodes: [NodeId(c), NodeId(d)] });
        }
        let s = self.body.surface(surface);
        if guard == Guard::NoTurn && turns(s, edge, c, d) {
            return Err(SwapError::Turns { surface, edge });
        }
        Ok(())
    }

    /// Turns the edge by a quarter; once each way is the identity, bit for bit.
    pub(super) fn do_swap(&mut self, surface: SurfaceId, edge: EdgeId, clockwise: bool, carry: bool) {
        let s = &mut self.body.surfaces[surface.index()];
        let carry = if carry { SwapCarry::of(s, edge) } else { None };
        let e = edge.0;
        let Diamond { faces: [left, right], at: [i, j] } = Diamond::at(s, e);
        let (ln, rn) = (s.faces[left as usize], s.faces[right as usize]);
        let (le, re) = (s.face_edges[left as usize], s.face_edges[right as usize]);
        // Corners of the left face from the edge's start: a, b, c; of the right: b, a, d.
        let [a, b, c, d] = [ln[i], ln[NEXT[i]], ln[LAST[i]], rn[LAST[j]]];
        let [bc, ca] = [le[NEXT[i]], le[LAST[i]]];
        let [ad, db] = [re[NEXT[j]], re[LAST[j]]];
        let (new_left, left_sides, new_right, right_sides) = if clockwise {
            ([c, d, b], [e, db, bc], [d, c, a], [e, ca, ad])
        } else {
            ([d, c, a], [e, ca, ad], [c, d, b], [e, db, bc])
        };
        // Corners keep their places in the faces' lists.
        let (mut nodes, mut sides) = ([0; 3], [0; 3]);
        for (k, at) in [i, NEXT[i], LAST[i]].into_iter().enumerate() {
            (nodes[at], sides[at]) = (new_left[k], left_sides[k]);
        }
        (s.faces[left as usize], s.face_edges[left as usize]) = (nodes, sides);
        for (k, at) in [j, NEXT[j], LAST[j]].into_iter().enumerate() {
            (nodes[at], sides[at]) = (new_right[k], right_sides[k]);
        }
        (s.faces[right as usize], s.face_edges[right as usize]) = (nodes, sides);
        // Two of the four other sides change their face.
        let [to_left, to_right] = if clockwise { [db, ca] } else { [ad, bc] };
        for (x, from, to) in [(to_left, right, left), (to_right, left, right)] {
            let faces = &mut s.edge_faces[x as usize];
            faces[usize::from(faces[0] != from)] = to;
        }
        s.edges[edge.index()] = [new_left[0], new_left[1]];
        if let Some(stars) = &mut self.stars[surface.index()] {
            stars.lose(a, e, b, ca);
            stars.lose(b, e, a, bc);
            stars.gain(c, e, d);
            stars.gain(d, e, c);
        }
        if let Some(carry) = carry {
            carry.put(s);
        }
    }
}

/// An edge with both its faces, and its place among the sides of each.
struct Diamond {
    faces: [u32; 2],
    at: [usize; 2],
}

impl Diamond {
    #[inline]
    fn at(s: &Surface, edge: u32) -> Self {
        let faces = s.edge_faces[edge as usize];
        let at = |f: u32| {
            let [x, y, _] = s.face_edges[f as usize];
            if x == edge { 0 } else { 1 + usize::from(y != edge) }
        };
        Self { faces, at: [at(faces[0]), at(faces[1])] }
    }

    /// The corners that are not on the edge.
    #[inline]
    fn tips(&self, s: &Surface) -> [u32; 2] {
        let tip = |k: usize| s.faces[self.faces[k] as usize][LAST[self.at[k]]];
        [tip(0), tip(1)]
    }

    /// Whether an edge joins the two tips.
    #[inline]
    fn joined(&self, s: &Surface, stars: &mut Stars, c: u32, d: u32) -> bool {
        // Round the tip with fewer edges.
        if stars.degree(c) <= stars.degree(d) {
            stars.joined(s, self.faces[0], LAST[self.at[0]], c, d)
        } else {
            stars.joined(s, self.faces[1], LAST[self.at[1]], d, c)
        }
    }
}

fn turns(s: &Surface, edge: EdgeId, c: u32, d: u32) -> bool {
    let p = s.positions();
    let [a, b] = s.edges()[edge.index()];
    let [a, b, c, d] = [a, b, c, d].map(|v| p[v as usize]);
    let normal = |p: glam::DVec3, q: glam::DVec3, r: glam::DVec3| (q - p).cross(r - p);
    let old = [normal(a, b, c), normal(b, a, d)];
    let new = [normal(d, c, a), normal(c, d, b)];
    new.iter().any(|n| old.iter().any(|o| n.dot(*o) <= 0.0))
}
