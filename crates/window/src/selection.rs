//! What is selected, and of which kind clicks select.

use std::collections::BTreeMap;

use design::draft::{Draft, edges, faces, joints};
use glam::DVec3;
use template::format::JointSpec;

/// A part of a template.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Element {
    Node(String),
    /// Names of both ends, in order.
    Edge([String; 2]),
    /// A face by its number among those of its surface.
    Face {
        surface: String,
        face: usize,
    },
    /// A joint by its number.
    Joint(usize),
}

/// What clicks select.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Mode {
    #[default]
    Nodes,
    Edges,
    Patches,
    Joints,
}

impl Mode {
    pub(crate) const ALL: [(Self, &'static str); 4] = [
        (Self::Nodes, "Nodes"),
        (Self::Edges, "Edges"),
        (Self::Patches, "Patches"),
        (Self::Joints, "Joints"),
    ];
}

/// The joints of a draft: those that are listed, else those that make themselves.
pub(crate) fn joints_of(draft: &Draft) -> Vec<JointSpec> {
    draft.template.joints.clone().unwrap_or_else(|| joints(&draft.template))
}

/// A joint's name for people.
pub(crate) fn joint_name(joint: &JointSpec) -> String {
    joint.name.clone().unwrap_or_else(|| joint.surfaces.join(" + "))
}

impl Element {
    pub(crate) fn edge(a: &str, b: &str) -> Self {
        if a <= b {
            Self::Edge([a.to_owned(), b.to_owned()])
        } else {
            Self::Edge([b.to_owned(), a.to_owned()])
        }
    }

    /// Whether the draft has it; `places` holds the twins of a mirrored template too.
    pub(crate) fn is_in(&self, draft: &Draft, places: &BTreeMap<String, DVec3>) -> bool {
        match self {
            Self::Node(name) => draft.template.nodes.contains_key(name) || places.contains_key(name),
            Self::Edge(ends) => draft.wires.contains(ends) || edges(&draft.template).contains_key(ends),
            Self::Face { surface, face } => {
                draft.template.surfaces.get(surface).is_some_and(|s| *face < faces(s).len())
            }
            Self::Joint(joint) => *joint < joints_of(draft).len(),
        }
    }

    /// What people call it: also the name under which it is found by screen readers.
    pub(crate) fn label(&self, draft: &Draft) -> String {
        match self {
            Self::Node(name) => format!("node {name}"),
            Self::Edge([a, b]) => format!("edge {a} – {b}"),
            Self::Face { surface, face } => format!("face {} of {surface}", face + 1),
            Self::Joint(joint) => {
                let all = joints_of(draft);
                format!("joint {}: {}", joint + 1, all.get(*joint).map(joint_name).unwrap_or_default())
            }
        }
    }

    /// The places of what it consists of, mm.
    pub(crate) fn places(&self, draft: &Draft, places: &BTreeMap<String, DVec3>) -> Vec<DVec3> {
        let of = |names: &[String]| names.iter().filter_map(|n| places.get(n).copied()).collect();
        match self {
            Self::Node(name) => of(std::slice::from_ref(name)),
            Self::Edge(ends) => of(ends),
            Self::Face { surface, face } => {
                let all = draft.template.surfaces.get(surface).map(faces).unwrap_or_default();
                all.get(*face).map(|nodes| of(nodes)).unwrap_or_default()
            }
            Self::Joint(joint) => {
                let all = joints_of(draft);
                let Some(joint) = all.get(*joint) else { return Vec::new() };
                let mut points: Vec<DVec3> = of(&joint.nodes);
                if joint.closed {
                    points.extend(points.first().copied());
                }
                points
            }
        }
    }
}

/// What is selected, in the order in which it was.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct Selection {
    pub(crate) elements: Vec<Element>,
}

impl Selection {
    pub(crate) fn contains(&self, element: &Element) -> bool {
        self.elements.contains(element)
    }

    /// The only one, or nothing.
    pub(crate) fn only(&self) -> Option<&Element> {
        match &self.elements[..] {
            [one] => Some(one),
            _ => None,
        }
    }

    pub(crate) fn replace(&mut self, elements: Vec<Element>) {
        self.elements = elements;
    }

    /// Takes those out that are in, and those in that are out.
    pub(crate) fn toggle(&mut self, elements: Vec<Element>) {
        for element in elements {
            match self.elements.iter().position(|e| *e == element) {
                Some(k) => {
                    self.elements.remove(k);
                }
                None => self.elements.push(element),
            }
        }
    }
}
