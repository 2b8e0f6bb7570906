//! Selecting, by boxes and lassos too; moving nodes.

use design::draft::Edit;
use glam::{DMat3, DVec2, DVec3};
use template::format::NodeSpec;

use super::{Effect, Event, Ghost, GhostShape, Machine, World};
use crate::region::Region;
use crate::selection::{Element, Mode};

/// Clicks nearer than this to the one before go on to the next element under the pointer, points.
const SAME_PLACE: f64 = 3.0;

#[derive(Default)]
pub(super) struct Select {
    drag: Drag,
    /// Where the last click was, and how many times in a row.
    last: Option<(DVec2, usize)>,
}

#[derive(Default)]
enum Drag {
    #[default]
    None,
    Node(Box<NodeDrag>),
    Region(Region),
}

/// A node that is dragged across the line of sight.
struct NodeDrag {
    name: String,
    node: NodeSpec,
    from: DVec2,
    /// Millimetres a pixel at the node's depth.
    scale: f64,
    /// From millimetres in space to the node's three offsets (eq. 1 solved).
    offsets: DMat3,
    right: DVec3,
    up: DVec3,
}

impl NodeDrag {
    fn start(name: &str, from: DVec2, world: &World) -> Result<Self, String> {
        let Some(node) = world.draft.template.nodes.get(name).cloned() else {
            return Err(format!("{name} is the twin of a node on the left; move that one"));
        };
        let frame = world.model.frame(world.draft, name)?;
        let camera = &world.picker.eye.camera;
        let place = world.place(name).ok_or_else(|| format!("{name} has no place on this body"))?;
        let pixels = camera.scale_at(place).ok_or("the node is behind the eye")?;
        let offsets = DMat3::from_cols(frame.normal, frame.first, frame.second).inverse();
        let (right, up) = (camera.right(), camera.up);
        Ok(Self { name: name.to_owned(), node, from, scale: 1.0 / pixels, offsets, right, up })
    }

    fn edit(&self, to: DVec2) -> Edit {
        let by = (to - self.from) * self.scale;
        let mut move_by = self.right * by.x - self.up * by.y;
        if self.node.centre {
            move_by.x = 0.0;
        }
        let by = self.offsets * move_by;
        let mut node = self.node.clone();
        // Tenths of a millimetre: what a hand can mean.
        let tenth = |v: f64| (v * 10.0).round() / 10.0;
        node.normal = tenth(node.normal + by.x);
        node.first = tenth(node.first + by.y);
        node.second = tenth(node.second + by.z);
        Edit::MoveNode { name: self.name.clone(), node }
    }
}

impl Machine for Select {
    fn on(&mut self, event: Event, world: &World) -> Vec<Effect> {
        match event {
            Event::Click { at, add } => {
                let all = world.picker.all(at, world.mode);
                let turn = match self.last {
                    Some((before, turn)) if before.distance(at) < SAME_PLACE && !add => turn + 1,
                    _ => 0,
                };
                self.last = Some((at, turn));
                let picked = if all.is_empty() { Vec::new() } else { vec![all[turn % all.len()].clone()] };
                if add { vec![Effect::Toggle(picked)] } else { vec![Effect::Select(picked)] }
            }
            Event::DragStart { from } => {
                self.last = None;
                let node = (world.mode == Mode::Nodes).then(|| world.node(from)).flatten();
                let Some(name) = node else {
                    self.drag = Drag::Region(Region::new(from, false));
                    return Vec::new();
                };
                match NodeDrag::start(&name, from, world) {
                    Ok(drag) => {
                        self.drag = Drag::Node(Box::new(drag));
                        vec![Effect::Select(vec![Element::Node(name)])]
                    }
                    Err(e) => vec![Effect::Problem(e)],
                }
            }
            Event::LassoStart { from } => {
                (self.last, self.drag) = (None, Drag::Region(Region::new(from, true)));
                Vec::new()
            }
            Event::Drag { to } => match &mut self.drag {
                Drag::Node(drag) => vec![Effect::Live(drag.edit(to))],
                Drag::Region(region) => {
                    region.reach(to);
                    Vec::new()
                }
                Drag::None => Vec::new(),
            },
            Event::DragEnd { to, add } => match std::mem::take(&mut self.drag) {
                Drag::Node(_) => vec![Effect::Settle],
                Drag::Region(mut region) => {
                    region.reach(to);
                    let inside = world.picker.within(&region, world.mode);
                    if add { vec![Effect::Toggle(inside)] } else { vec![Effect::Select(inside)] }
                }
                Drag::None => Vec::new(),
            },
            Event::Cancel => match std::mem::take(&mut self.drag) {
                Drag::Node(drag) => {
                    let back = Edit::MoveNode { name: drag.name, node: drag.node };
                    vec![Effect::Live(back), Effect::Settle]
                }
                Drag::Region(_) => Vec::new(),
                Drag::None if world.selection.elements.is_empty() => Vec::new(),
                Drag::None => vec![Effect::Select(Vec::new())],
            },
            Event::Confirm => Vec::new(),
        }
    }

    fn ghosts(&self, _: Option<DVec2>, _: &World) -> Vec<Ghost> {
        match &self.drag {
            Drag::Region(region) => vec![Ghost::legal(GhostShape::Region(region.clone()))],
            _ => Vec::new(),
        }
    }

    fn next_step(&self, world: &World) -> String {
        let kind = match world.mode {
            Mode::Nodes => "a node, or drag it to move it",
            Mode::Edges => "an edge",
            Mode::Patches => "a patch",
            Mode::Joints => "a joint",
        };
        format!(
            "click {kind}; again: behind it; Shift adds; drag a box, with Ctrl a lasso; 1 2 3 4 change the kind"
        )
    }

    fn target(&self, at: DVec2, world: &World) -> Option<Element> {
        match self.drag {
            Drag::None => world.picker.all(at, world.mode).into_iter().next(),
            _ => None,
        }
    }
}
