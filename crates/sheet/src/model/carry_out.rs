//! Carrying commands out: data to calls.

use std::collections::{BTreeMap, BTreeSet};

use glam::DVec3;
use mesh_kernel::complex::EdgeId;
use sketch::Path;

use super::command::{AlongWire, Command, Done};
use super::corners::Replacement;
use super::extrude::{Along, Profile};
use super::wire::{drawn, polyline};
use super::{ExtrusionCase, Model, ModelError};

/// One of a direction and paths.
const WHERE_TO: ModelError =
    ModelError::Number { what: "where to", wanted: "given by one of \"by\", \"along\" and \"path\"" };

impl Model {
    /// What a command does, within a transaction.
    pub(super) fn carry_out(&mut self, command: &Command) -> Result<Done, ModelError> {
        let mut done = Done::default();
        match command {
            Command::Wire { name, drawings, plane, lines } => {
                let mut all = Vec::new();
                for d in drawings {
                    all.push(drawn(d, plane, &self.limits)?);
                }
                for l in lines {
                    all.push(polyline(l, &self.limits)?);
                }
                self.make_wire(name, &all)?;
            }
            Command::Extrude { .. } => done.extrusion = Some(self.extrude(command)?),
            Command::Create { name, outline, holes, plane } => self.create(name, outline, holes, plane)?,
            Command::Add { name, points } => self.add(name, points)?,
            Command::Punch { patch, outline, plane } => {
                self.punch(patch, outline, plane)?;
            }
            Command::Bend { moving, about: [from, to], angle } => {
                finite(&[*from, *to])?;
                self.bend(*from, *to, moving, angle.to_radians())?;
            }
            Command::Sweep { name, edges, by, along, turn } => {
                done.extrusion = Some(self.sweep_edges(name, edges, *by, along.as_deref(), *turn)?);
            }
            Command::Draw { patch, name, outline, plane, by, scale } => {
                self.draw(patch, outline, plane, *by, *scale, name)?;
            }
            Command::Round { edge, corners, radius, name } => {
                if edge.is_none() == corners.is_empty() {
                    return Err(ModelError::Number {
                        what: "what is rounded",
                        wanted: "an edge, or corners",
                    });
                }
                if let Some([from, to]) = edge {
                    finite(&[*from, *to])?;
                    self.replace_edge(*from, *to, Replacement::Round(*radius), name)?;
                }
                for at in corners {
                    self.round_corner(*at, *radius)?;
                }
            }
            Command::Chamfer { edge: [from, to], depth, name } => {
                finite(&[*from, *to])?;
                self.replace_edge(*from, *to, Replacement::Chamfer(*depth), name)?;
            }
            Command::Join { patches, edges, split } => done = self.join(patches, *edges, *split)?,
            Command::Remove { patches } => self.remove(patches)?,
            Command::Partial { patch } => self.make_partial(patch)?,
            Command::AddSolid { solid, to } => self.add_to_partial(solid, to)?,
            Command::Undo {} | Command::Redo {} => {}
        }
        Ok(done)
    }

    fn extrude(&mut self, command: &Command) -> Result<ExtrusionCase, ModelError> {
        let Command::Extrude {
            name,
            wire,
            outline,
            plane,
            by,
            along,
            path,
            path_plane,
            turn,
            solid,
            edges_along,
        } = command
        else {
            return Ok(ExtrusionCase::Plain);
        };
        let (profile, known, wire_edges) = match (wire, outline) {
            (Some(wire), None) => {
                let found = self.tables.wires.get(wire);
                let wire = found.ok_or_else(|| ModelError::NoWire { name: wire.clone() })?.clone();
                let ends = wire.edges.iter().filter_map(|e| self.complex().ends(*e));
                let known: BTreeSet<_> = ends.flatten().collect();
                (self.profile_of(&wire.edges, &wire.leaves), known, wire.edges)
            }
            (None, Some(outline)) => {
                if *solid {
                    // An outline that crosses itself bounds no material.
                    Path::of(outline)?.simple_loop(self.limits.tolerance, self.limits.points)?;
                }
                let drawing = drawn(outline, plane, &self.limits)?;
                (Profile::of_points(&drawing.points, drawing.closed), BTreeSet::new(), Vec::new())
            }
            _ => {
                return Err(ModelError::Number {
                    what: "what is extruded",
                    wanted: "a \"wire\" or an \"outline\"",
                });
            }
        };
        let drawn_path = match (along, path) {
            (Some(points), None) => Some(polyline(points, &self.limits)?),
            (None, Some(path)) => Some(drawn(path, path_plane, &self.limits)?),
            _ => None,
        };
        let to = match (by, &drawn_path) {
            (Some(by), None) if along.is_none() && path.is_none() => {
                finite(&[*by])?;
                Along::By(*by)
            }
            (None, Some(p)) => Along::Path { points: &p.points, closed: p.closed, turn: *turn },
            _ => return Err(WHERE_TO),
        };
        if let Along::Path { points, .. } = &to {
            distinct(points)?;
        }
        let (case, kept) = self.extrude_profile(name, &profile, &to, *edges_along, *solid, known.clone())?;
        if let Some(wire) = wire {
            // Links that are no sides of sheets go, with what they were cut into.
            let mut gone = BTreeSet::new();
            for (link, ends) in profile.links.iter().enumerate().filter(|(l, _)| !kept.contains(l)) {
                let [from, to] = ends.map(|n| profile.nodes[n]);
                gone.extend(self.edges_along(from, to).unwrap_or_default());
                gone.insert(wire_edges[link]);
            }
            self.tables.wires.remove(wire);
            let others: BTreeSet<EdgeId> =
                self.tables.wires.values().flat_map(|w| &w.edges).copied().collect();
            gone.retain(|e| !others.contains(e));
            self.sweep_up(&gone, &known)?;
        }
        Ok(case)
    }

    fn sweep_edges(
        &mut self,
        name: &str,
        corners: &[DVec3],
        by: Option<DVec3>,
        along: Option<&[DVec3]>,
        turn: bool,
    ) -> Result<ExtrusionCase, ModelError> {
        finite(corners)?;
        let mut edges: Vec<EdgeId> = Vec::new();
        for w in corners.windows(2) {
            edges.extend(self.edges_along(w[0], w[1])?);
        }
        let mut seen = BTreeSet::new();
        edges.retain(|e| seen.insert(*e));
        if edges.is_empty() {
            return Err(ModelError::Number {
                what: "the edges swept",
                wanted: "given by two corners and more",
            });
        }
        let profile = self.profile_of(&edges, &BTreeMap::new());
        let known: BTreeSet<_> = edges.iter().filter_map(|e| self.complex().ends(*e)).flatten().collect();
        let path = along.map(|p| polyline(p, &self.limits)).transpose()?;
        let to = match (by, &path) {
            (Some(by), None) => {
                finite(&[by])?;
                Along::By(by)
            }
            (None, Some(p)) => Along::Path { points: &p.points, closed: p.closed, turn },
            _ => return Err(WHERE_TO),
        };
        if let Along::Path { points, .. } = &to {
            distinct(points)?;
        }
        Ok(self.extrude_profile(name, &profile, &to, AlongWire::Refuse, false, known)?.0)
    }
}

fn finite(points: &[DVec3]) -> Result<(), ModelError> {
    if points.iter().all(|p| p.is_finite()) {
        Ok(())
    } else {
        Err(ModelError::Number { what: "coordinates", wanted: "finite numbers" })
    }
}

fn distinct(path: &[DVec3]) -> Result<(), ModelError> {
    if path.windows(2).any(|w| w[0].distance(w[1]) <= super::SAME_POINT) {
        return Err(ModelError::Number { what: "the path", wanted: "made of points apart from each other" });
    }
    Ok(())
}
