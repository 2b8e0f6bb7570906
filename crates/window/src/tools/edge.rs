//! Connecting nodes.

use design::draft::Edit;
use glam::DVec2;

use super::{Effect, Event, Ghost, GhostShape, Machine, World};

#[derive(Default)]
pub(super) struct Edge {
    /// The node that the next edge begins at: none or one.
    from: Vec<String>,
}

impl Machine for Edge {
    fn on(&mut self, event: Event, world: &World) -> Vec<Effect> {
        match event {
            Event::Click { at, .. } => {
                let Some(to) = world.node(at) else {
                    return vec![Effect::Problem("there is no node here; N puts nodes".to_owned())];
                };
                // The chain goes on from the node that was reached; the same node again ends it.
                match std::mem::replace(&mut self.from, vec![to.clone()]).pop() {
                    None => Vec::new(),
                    Some(from) if from == to => {
                        self.from.clear();
                        Vec::new()
                    }
                    Some(from) => vec![Effect::Edit(Edit::CreateEdge { from, to })],
                }
            }
            Event::Confirm | Event::Cancel => {
                self.from.clear();
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn ghosts(&self, pointer: Option<DVec2>, world: &World) -> Vec<Ghost> {
        let (Some(at), Some(from)) = (pointer, self.from.first()) else { return Vec::new() };
        let Some(start) = world.place(from) else { return Vec::new() };
        match world.node(at).filter(|to| to != from) {
            Some(to) => {
                let edit = Edit::CreateEdge { from: from.clone(), to: to.clone() };
                let end = world.place(&to).unwrap_or(start);
                vec![Ghost { shape: GhostShape::Line(vec![start, end]), is_legal: world.allows(&edit) }]
            }
            None => {
                let start = world.picker.eye.camera.project(start);
                start.map(|s| Ghost::legal(GhostShape::Ink(vec![s, at]))).into_iter().collect()
            }
        }
    }

    fn next_step(&self, _: &World) -> String {
        match self.from.first() {
            None => "click the node that the edge begins at".to_owned(),
            Some(from) => format!("from {from}: click the next node; Escape or the same node ends the chain"),
        }
    }

    fn collected(&self) -> &[String] {
        &self.from
    }
}
