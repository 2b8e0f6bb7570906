//! Choosing joints, and joining edges by hand.

use std::collections::BTreeSet;

use design::draft::{Edit, edges};
use glam::DVec2;
use template::format::JointSpec;

use super::{Effect, Event, Ghost, GhostShape, Machine, World};
use crate::selection::{Element, Mode, joint_name, joints_of};

#[derive(Default)]
pub(super) struct Joint {
    /// Edges for a joint, in the order of clicks.
    edges: Vec<[String; 2]>,
}

impl Joint {
    /// The edge under the pointer that surfaces share.
    fn loose(at: DVec2, world: &World) -> Option<[String; 2]> {
        let shared = edges(&world.draft.template);
        world.picker.all(at, Mode::Edges).into_iter().find_map(|e| match e {
            Element::Edge(ends) => shared.get(&ends).is_some_and(|s| s.len() > 1).then_some(ends),
            _ => None,
        })
    }
}

/// The chain that edges make, and whether it closes.
fn chain(edges: &[[String; 2]]) -> Option<(Vec<String>, bool)> {
    let mut rest = edges.to_vec();
    let [a, b] = rest.pop()?;
    let mut nodes = vec![a, b];
    while !rest.is_empty() {
        let (first, last) = (nodes[0].clone(), nodes[nodes.len() - 1].clone());
        let k = rest.iter().position(|e| e.contains(&first) || e.contains(&last))?;
        let [p, q] = rest.swap_remove(k);
        let (shared, other) = if p == first || p == last { (p, q) } else { (q, p) };
        if shared == last { nodes.push(other) } else { nodes.insert(0, other) }
    }
    let closed = nodes.len() > 3 && nodes[0] == nodes[nodes.len() - 1];
    if closed {
        nodes.pop();
    }
    Some((nodes, closed))
}

/// The joint that edges would make.
fn made(picked: &[[String; 2]], world: &World) -> Result<JointSpec, String> {
    let (nodes, closed) =
        chain(picked).ok_or("the edges do not follow each other; click a chain of edges")?;
    let shared = edges(&world.draft.template);
    let mut surfaces: Option<BTreeSet<String>> = None;
    for edge in picked {
        let own = shared.get(edge).cloned().unwrap_or_default();
        surfaces = Some(match surfaces {
            Some(all) => all.intersection(&own).cloned().collect(),
            None => own,
        });
    }
    let surfaces: Vec<String> = surfaces.unwrap_or_default().into_iter().collect();
    if surfaces.len() < 2 {
        return Err("no two surfaces share all of these edges".to_owned());
    }
    Ok(JointSpec { name: None, surfaces, nodes, closed })
}

impl Machine for Joint {
    fn on(&mut self, event: Event, world: &World) -> Vec<Effect> {
        match event {
            Event::Click { at, add } => {
                let joint = world.picker.all(at, Mode::Joints).into_iter().next();
                // The joint that is selected already is taken edge by edge, for a joint of their own.
                let is_open = |j: &Element| !self.edges.is_empty() || world.selection.only() == Some(j);
                if let Some(joint) = joint.filter(|j| add || !is_open(j)) {
                    return vec![if add { Effect::Toggle(vec![joint]) } else { Effect::Select(vec![joint]) }];
                }
                match Self::loose(at, world) {
                    Some(edge) => {
                        match self.edges.iter().position(|e| *e == edge) {
                            Some(k) => drop(self.edges.remove(k)),
                            None => self.edges.push(edge),
                        }
                        Vec::new()
                    }
                    None => vec![Effect::Problem(
                        "no joint here, and no edge that several surfaces share; fill faces on both sides first"
                            .to_owned(),
                    )],
                }
            }
            Event::Confirm if !self.edges.is_empty() => match made(&self.edges, world) {
                Ok(joint) => {
                    self.edges.clear();
                    vec![Effect::Edit(Edit::MakeJoint { joint })]
                }
                Err(e) => vec![Effect::Problem(e)],
            },
            Event::Cancel if self.edges.is_empty() => vec![Effect::Select(Vec::new())],
            Event::Cancel => {
                self.edges.clear();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn ghosts(&self, pointer: Option<DVec2>, world: &World) -> Vec<Ghost> {
        let line =
            |ends: &[String; 2]| Some(GhostShape::Line(vec![world.place(&ends[0])?, world.place(&ends[1])?]));
        let mut out: Vec<Ghost> = self.edges.iter().filter_map(line).map(Ghost::legal).collect();
        if let Some(at) = pointer
            && let Some(Element::Joint(k)) = self.target(at, world)
            && let Some(joint) = joints_of(world.draft).get(k)
        {
            let text = format!("{}, {} surfaces", joint_name(joint), joint.surfaces.len());
            out.push(Ghost::legal(GhostShape::Text(at, text)));
        }
        out
    }

    fn next_step(&self, _: &World) -> String {
        match self.edges.len() {
            0 => {
                "click a joint: the inspector splits it; click it again: its edges, for a joint of their own"
                    .to_owned()
            }
            n => format!("{n} edges: Enter joins them; Escape lets them go"),
        }
    }

    fn target(&self, at: DVec2, world: &World) -> Option<Element> {
        let joint = world.picker.all(at, Mode::Joints).into_iter().next();
        joint.or_else(|| Self::loose(at, world).map(Element::Edge))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edges_in_any_order_make_a_chain_or_none() {
        let e = |a: &str, b: &str| [a.to_owned(), b.to_owned()];
        let names = |c: Option<(Vec<String>, bool)>| c.map(|(n, closed)| (n.join(""), closed));
        let open = names(chain(&[e("a", "b"), e("c", "d"), e("b", "c")]));
        assert!(
            open == Some(("abcd".to_owned(), false)) || open == Some(("dcba".to_owned(), false)),
            "{open:?}"
        );
        assert!(
            matches!(names(chain(&[e("a", "b"), e("b", "c"), e("a", "c")])), Some((n, true)) if n.len() == 3)
        );
        assert_eq!(names(chain(&[e("a", "b"), e("c", "d")])), None);
    }
}
