//! Tools: state machines from events of the pointer to effects on the design.
//!
//! A tool sees the design through a [`World`] and changes nothing itself: it answers every event with [`Effect`]s. So a
//! tool can be tried without a window, and everything that it does is a command that can be undone.

mod edge;
mod face;
mod feature;
mod joint;
mod node;
mod select;
mod sketch;

use design::draft::{Draft, Edit};
use eframe::egui::Key;
use glam::{DVec2, DVec3};

pub(crate) use feature::Drawing;

use crate::model::Model;
use crate::region::Region;
use crate::selection::{Element, Mode, Selection};
use crate::view::pick::Picker;

/// What the pointer does.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tool {
    Select,
    Node,
    Edge,
    Face,
    Sketch,
    Joint,
    Feature,
}

impl Tool {
    /// Every tool with its name, key, and what it is for.
    pub(crate) const ALL: [(Self, &'static str, Key, &'static str); 7] = [
        (Self::Select, "Select", Key::V, "Select, one or by a box or lasso, and move"),
        (Self::Node, "Node", Key::N, "Put nodes at feature points or anywhere on the body"),
        (Self::Edge, "Edge", Key::E, "Connect nodes"),
        (Self::Face, "Face", Key::F, "Fill faces of three or four nodes"),
        (Self::Sketch, "Sketch", Key::K, "Draw the profiles of edges"),
        (Self::Joint, "Joint", Key::J, "Choose joints; join edges that several surfaces share"),
        (Self::Feature, "Curve", Key::D, "Draw feature curves on the body"),
    ];

    /// Its state machine, at rest.
    pub(crate) fn start(self) -> Box<dyn Machine> {
        match self {
            Self::Select => Box::<select::Select>::default(),
            Self::Node => Box::<node::Node>::default(),
            Self::Edge => Box::<edge::Edge>::default(),
            Self::Face => Box::<face::Face>::default(),
            Self::Sketch => Box::<sketch::Sketch>::default(),
            Self::Joint => Box::<joint::Joint>::default(),
            Self::Feature => Box::<feature::Feature>::default(),
        }
    }
}

/// What happens in the 3D view; places are pixels of the view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Event {
    /// The button went down and up in one place. `add`: Shift is held.
    Click {
        at: DVec2,
        add: bool,
    },
    /// A drag began; `from` is where the button went down.
    DragStart {
        from: DVec2,
    },
    /// A drag with Ctrl began.
    LassoStart {
        from: DVec2,
    },
    Drag {
        to: DVec2,
    },
    DragEnd {
        to: DVec2,
        add: bool,
    },
    /// Enter.
    Confirm,
    /// Escape. A tool with nothing under way answers with nothing.
    Cancel,
}

/// What a tool wants done.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Effect {
    Edit(Edit),
    /// A step of a drag: the first is an entry of the history, the others go on it.
    Live(Edit),
    /// The drag is over.
    Settle,
    Select(Vec<Element>),
    Toggle(Vec<Element>),
    /// Why nothing happened, and what to do.
    Problem(String),
}

/// What a tool shows of its next step: not part of the design yet.
#[derive(Clone, Debug)]
pub(crate) struct Ghost {
    pub(crate) shape: GhostShape,
    /// Whether a click here would do it.
    pub(crate) is_legal: bool,
}

#[derive(Clone, Debug)]
pub(crate) enum GhostShape {
    /// A line in space.
    Line(Vec<DVec3>),
    /// A thin line in space: what is there already.
    Thin(Vec<DVec3>),
    /// A filled outline in space.
    Area(Vec<DVec3>),
    Point(DVec3),
    /// A line of the picture: ink.
    Ink(Vec<DVec2>),
    /// A box or a lasso of the picture.
    Region(Region),
    /// Words beside a pixel.
    Text(DVec2, String),
}

impl Ghost {
    pub(crate) fn legal(shape: GhostShape) -> Self {
        Self { shape, is_legal: true }
    }
}

/// What tools may look at.
pub(crate) struct World<'a> {
    pub(crate) draft: &'a Draft,
    pub(crate) model: &'a Model,
    pub(crate) picker: Picker<'a>,
    pub(crate) selection: &'a Selection,
    pub(crate) mode: Mode,
    /// New faces go to this surface.
    pub(crate) surface: &'a str,
    /// How feature curves are drawn.
    pub(crate) drawing: Drawing,
    /// Pixels of the view a pixel of a screen at scale 1.
    pub(crate) pixel_scale: f64,
}

impl World<'_> {
    /// The node that a click means.
    pub(crate) fn node(&self, at: DVec2) -> Option<String> {
        self.picker.nodes(at).into_iter().next()
    }

    pub(crate) fn place(&self, node: &str) -> Option<DVec3> {
        self.model.places.get(node).copied()
    }

    /// Whether an edit would be carried out.
    pub(crate) fn allows(&self, edit: &Edit) -> bool {
        edit.apply(self.draft).is_ok()
    }

    /// A name that no node has: the one asked for, or with a number.
    pub(crate) fn free_name(&self, wanted: &str, is_taken: impl Fn(&str) -> bool) -> String {
        let numbered = (2..).map(|k| format!("{wanted}_{k}"));
        std::iter::once(wanted.to_owned()).chain(numbered).find(|n| !is_taken(n)).unwrap_or_default()
    }
}

/// A tool at work.
pub(crate) trait Machine {
    fn on(&mut self, event: Event, world: &World) -> Vec<Effect>;

    /// What the next step would make; `pointer` is over the view or not.
    fn ghosts(&self, pointer: Option<DVec2>, world: &World) -> Vec<Ghost>;

    /// The next step in words, and what keys change.
    fn next_step(&self, world: &World) -> String;

    /// Nodes that it has collected so far, to be shown as selected.
    fn collected(&self) -> &[String] {
        &[]
    }

    /// What a click here would take, to be lit up.
    fn target(&self, at: DVec2, world: &World) -> Option<Element> {
        world.node(at).map(Element::Node)
    }
}
