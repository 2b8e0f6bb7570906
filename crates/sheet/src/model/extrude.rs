//! Extrusion of wires, outlines and edges: along a direction or a path.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::complex::{EdgeId, FaceId, VertexId};

use super::build::{Builder, area_vector};
use super::command::AlongWire;
use super::wire::Leave;
use super::{Model, ModelError, pillars, sweep};

/// Which of the cases of fig. 6.18 (Stroud & Nagy) an extrusion was; those that were refused are errors.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum ExtrusionCase {
    /// No edge lay along the direction.
    #[default]
    Plain,
    /// Edges lay along the direction, and sheets on both sides of them overlap there: valid, with these inner edges (middle).
    InnerEdges(Vec<[DVec3; 2]>),
}

/// What is extruded: nodes and links between them.
#[derive(Clone, Debug, Default)]
pub(super) struct Profile {
    pub(super) nodes: Vec<DVec3>,
    pub(super) links: Vec<[usize; 2]>,
    /// How the curve of a link leaves one of its ends.
    pub(super) leaves: BTreeMap<(usize, usize), Leave>,
}

impl Profile {
    /// A polygon or polyline.
    pub(super) fn of_points(points: &[DVec3], closed: bool) -> Self {
        let n = points.len();
        let links = (0..if closed { n } else { n - 1 }).map(|i| [i, (i + 1) % n]).collect();
        Self { nodes: points.to_vec(), links, leaves: BTreeMap::new() }
    }

    /// Its nodes in order, if it is one closed loop.
    fn closed_loop(&self) -> Option<Vec<usize>> {
        let mut at: Vec<Vec<usize>> = vec![Vec::new(); self.nodes.len()];
        for (l, ends) in self.links.iter().enumerate() {
            ends.iter().for_each(|n| at[*n].push(l));
        }
        if at.iter().any(|links| links.len() != 2) || self.links.len() < 3 {
            return None;
        }
        let (mut nodes, mut link) = (vec![self.links[0][0]], 0);
        loop {
            let here = nodes[nodes.len() - 1];
            let next = self.links[link].iter().copied().find(|n| *n != here)?;
            if next == nodes[0] {
                return (nodes.len() == self.nodes.len()).then_some(nodes);
            }
            nodes.push(next);
            link = at[next].iter().copied().find(|l| *l != link)?;
        }
    }
}

/// Where to.
pub(super) enum Along<'a> {
    /// By a vector.
    By(DVec3),
    /// Along a path, turned with it or only shifted.
    Path { points: &'a [DVec3], closed: bool, turn: bool },
}

impl Model {
    /// The profile that some edges are.
    pub(super) fn profile_of(
        &self,
        edges: &[EdgeId],
        leaves: &BTreeMap<(EdgeId, VertexId), Leave>,
    ) -> Profile {
        let complex = self.complex();
        let mut number: BTreeMap<VertexId, usize> = BTreeMap::new();
        let mut profile = Profile::default();
        for &e in edges {
            let Some(ends) = complex.ends(e) else { continue };
            let link = ends.map(|v| {
                *number.entry(v).or_insert_with(|| {
                    profile.nodes.push(complex.position(v).unwrap_or_default());
                    profile.nodes.len() - 1
                })
            });
            for (end, v) in ends.iter().enumerate() {
                if let Some(leave) = leaves.get(&(e, *v)) {
                    profile.leaves.insert((profile.links.len(), end), *leave);
                }
            }
            profile.links.push(link);
        }
        profile
    }

    /// Extrudes a profile to faces of a patch. `known` are vertices that it hangs on; `caps` closes a solid.
    pub(super) fn extrude_profile(
        &mut self,
        name: &str,
        profile: &Profile,
        along: &Along<'_>,
        choice: AlongWire,
        caps: bool,
        known: BTreeSet<VertexId>,
    ) -> Result<(ExtrusionCase, Vec<usize>), ModelError> {
        let mut case = ExtrusionCase::Plain;
        let mut kept = Vec::new();
        let (mut faces, ends) = match along {
            Along::By(by) => {
                let made = pillars::extrude(profile, *by, choice)?;
                case = made.case;
                kept = made.kept;
                let top = profile.nodes.iter().map(|p| *p + *by).collect();
                (made.faces, Some([profile.nodes.clone(), top]))
            }
            Along::Path { points, closed, turn } => {
                let stations = if *turn {
                    sweep::turned(profile, points, *closed)?
                } else {
                    sweep::shifted(profile, points, *closed)
                };
                let ends = match (&stations.nodes[..], closed) {
                    ([first, .., last], false) => Some([first.clone(), last.clone()]),
                    _ => None,
                };
                (stations.faces(profile), ends)
            }
        };
        if faces.len() > self.limits.faces {
            return Err(ModelError::TooFine { points: faces.len(), most: self.limits.faces });
        }
        if caps {
            let order = profile.closed_loop().ok_or(ModelError::NotCapped)?;
            // Links may run against the loop; their faces are turned to agree with it.
            let after: BTreeMap<usize, usize> =
                (0..order.len()).map(|i| (order[i], order[(i + 1) % order.len()])).collect();
            for (link, corners) in &mut faces {
                if after.get(&profile.links[*link][0]) != Some(&profile.links[*link][1]) {
                    corners.reverse();
                }
            }
            if let Some([first, last]) = ends {
                faces.push((usize::MAX, order.iter().rev().map(|&n| first[n]).collect()));
                faces.push((usize::MAX, order.iter().map(|&n| last[n]).collect()));
            }
            let corners: Vec<&Vec<DVec3>> = faces.iter().map(|f| &f.1).collect();
            if volume(&corners) < 0.0 {
                faces.iter_mut().for_each(|f| f.1.reverse());
            }
        }
        let patch = self.new_patch(name)?;
        let mut builder = Builder::on(&mut self.editor, known);
        for (_, corners) in &faces {
            builder.face(std::slice::from_ref(corners))?;
        }
        let made: Vec<FaceId> = builder.faces;
        self.enter(made, patch);
        Ok((case, kept))
    }
}

/// Volume that plane polygons enclose.
fn volume(faces: &[&Vec<DVec3>]) -> f64 {
    let Some(&o) = faces.first().and_then(|f| f.first()) else { return 0.0 };
    faces.iter().map(|f| area_vector(f).dot(f[0] - o)).sum::<f64>() / 6.0
}
