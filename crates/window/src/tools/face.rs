//! Filling faces.

use design::draft::Edit;
use glam::DVec2;

use super::{Effect, Event, Ghost, GhostShape, Machine, World};

#[derive(Default)]
pub(super) struct Face {
    nodes: Vec<String>,
}

impl Face {
    fn fill(&mut self, world: &World) -> Vec<Effect> {
        let nodes = std::mem::take(&mut self.nodes);
        if nodes.len() < 3 {
            let why = "a face needs three or four nodes; click them one after the other";
            return vec![Effect::Problem(why.to_owned())];
        }
        vec![Effect::Edit(edit(world, nodes)), Effect::Select(Vec::new())]
    }
}

fn edit(world: &World, nodes: Vec<String>) -> Edit {
    Edit::FillFace { surface: world.surface.to_owned(), nodes }
}

impl Machine for Face {
    fn on(&mut self, event: Event, world: &World) -> Vec<Effect> {
        match event {
            Event::Click { at, .. } => {
                let Some(node) = world.node(at) else {
                    return vec![Effect::Problem(
                        "there is no node here; click three or four nodes".to_owned(),
                    )];
                };
                match self.nodes.iter().position(|n| *n == node) {
                    // Back at the beginning: the outline is closed.
                    Some(0) if self.nodes.len() > 2 => self.fill(world),
                    Some(k) => {
                        self.nodes.truncate(k);
                        Vec::new()
                    }
                    None => {
                        self.nodes.push(node);
                        if self.nodes.len() == 4 { self.fill(world) } else { Vec::new() }
                    }
                }
            }
            Event::Confirm => self.fill(world),
            Event::Cancel => {
                self.nodes.clear();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn ghosts(&self, pointer: Option<DVec2>, world: &World) -> Vec<Ghost> {
        let mut nodes = self.nodes.clone();
        if let Some(next) = pointer.and_then(|at| world.node(at)).filter(|n| !nodes.contains(n)) {
            nodes.push(next);
        }
        let places: Vec<_> = nodes.iter().filter_map(|n| world.place(n)).collect();
        if places.len() < 2 {
            return Vec::new();
        }
        let is_legal = nodes.len() < 3 || world.allows(&edit(world, nodes));
        let shape = if places.len() > 2 { GhostShape::Area(places) } else { GhostShape::Line(places) };
        vec![Ghost { shape, is_legal }]
    }

    fn next_step(&self, world: &World) -> String {
        let to = world.surface;
        match self.nodes.len() {
            0 => format!("click the first node of a face of {to}"),
            1 | 2 => format!("click the next node ({} so far); Escape starts again", self.nodes.len()),
            _ => format!("click the fourth node, or Enter fills a triangle of {to}"),
        }
    }

    fn collected(&self) -> &[String] {
        &self.nodes
    }
}
