//! Putting nodes beside the body.

use design::draft::Edit;
use glam::{DVec2, DVec3};
use template::encoding;
use template::format::NodeSpec;

use super::{Effect, Event, Ghost, GhostShape, Machine, World};
use crate::model::{Anchor, OFF_SKIN};
use crate::selection::Element;

/// A feature point within this of the pointer is meant, points.
const SNAP: f64 = 12.0;
/// A node farther than this from every feature point would not follow the body, mm.
const FARTHEST: f64 = 150.0;
/// Places as near to the plane of symmetry lie on it, mm.
const CENTRE: f64 = 8.0;

#[derive(Default)]
pub(super) struct Node;

/// Where a click would put a node.
struct Meant {
    name: String,
    node: NodeSpec,
    place: DVec3,
}

/// The feature point that is meant: the nearest to the pointer, of those as near the one in front.
fn anchor<'a>(at: DVec2, world: &'a World) -> Option<&'a Anchor> {
    let camera = &world.picker.eye.camera;
    let near = world.model.anchors.iter().filter_map(|anchor| {
        let distance = camera.project(anchor.place)?.distance(at);
        let is_near = distance < SNAP && world.picker.sees_node(anchor.place);
        // Two points are one place to the hand.
        is_near.then(|| ((distance / 2.0) as i64, -camera.depth(anchor.place), anchor))
    });
    near.min_by(|a, b| a.0.cmp(&b.0).then(a.1.total_cmp(&b.1))).map(|(.., anchor)| anchor)
}

fn meant(at: DVec2, world: &World) -> Option<Meant> {
    if let Some(anchor) = anchor(at, world) {
        let place = anchor.place + OFF_SKIN * anchor.normal;
        return Some(Meant { name: anchor.name.clone(), node: anchor.node(), place });
    }
    // Anywhere else on the body: beside the nearest feature point, after eq. 1.
    let hit = world.picker.solids.on_body(&world.picker.eye.ray(at))?;
    let mirrored = world.draft.template.mirrored;
    let mut place = if mirrored && hit.x < 0.0 { hit * DVec3::new(-1.0, 1.0, 1.0) } else { hit };
    let is_centre = mirrored && place.x.abs() < CENTRE;
    if is_centre {
        place.x = 0.0;
    }
    let nearest = world
        .model
        .anchors
        .iter()
        .filter(|a| matches!(a.at, template::format::At::Crossing(_)) && (!is_centre || a.is_centre))
        .min_by(|a, b| a.place.distance(place).total_cmp(&b.place.distance(place)))
        .filter(|a| a.place.distance(place) < FARTHEST)?;
    let template::format::At::Crossing([first, second]) = &nearest.at else { return None };
    let frame = world.model.human()?.features.crossing(first, second)?;
    let offset = encoding::encode(&frame, place + OFF_SKIN * nearest.normal)?;
    let tenth = |v: f64| (v * 10.0).round() / 10.0;
    let node = NodeSpec {
        at: Some(nearest.at.clone()),
        centre: is_centre,
        normal: tenth(offset.normal),
        first: tenth(offset.first),
        second: tenth(offset.second),
        ..NodeSpec::default()
    };
    // A twin comes of the name; on the centre there is none.
    let name = format!("{}_beside", nearest.name);
    let name =
        if is_centre || !mirrored || name.starts_with("left_") { name } else { format!("left_{name}") };
    Some(Meant { name, node, place: place + OFF_SKIN * nearest.normal })
}

impl Machine for Node {
    fn on(&mut self, event: Event, world: &World) -> Vec<Effect> {
        let Event::Click { at, .. } = event else { return Vec::new() };
        if world.model.body.is_none() {
            return vec![Effect::Problem("the body is still being made; try again in a moment".to_owned())];
        }
        let Some(meant) = meant(at, world) else {
            let why = "there is no body under the pointer; click one of the crosses, or the body near one";
            return vec![Effect::Problem(why.to_owned())];
        };
        let nodes = &world.draft.template.nodes;
        if nodes.get(&meant.name).is_some_and(|n| n.at == meant.node.at) && anchor(at, world).is_some() {
            let why = format!("there is a node at this feature point already: {}", meant.name);
            return vec![Effect::Select(vec![Element::Node(meant.name)]), Effect::Problem(why)];
        }
        let name = world.free_name(&meant.name, |n| nodes.contains_key(n));
        let select = Effect::Select(vec![Element::Node(name.clone())]);
        vec![Effect::Edit(Edit::CreateNode { name, node: meant.node }), select]
    }

    fn ghosts(&self, pointer: Option<DVec2>, world: &World) -> Vec<Ghost> {
        let Some(at) = pointer else { return Vec::new() };
        let Some(meant) = meant(at, world) else { return Vec::new() };
        let mut out = vec![Ghost::legal(GhostShape::Point(meant.place))];
        if world.draft.template.mirrored && !meant.node.centre {
            out.push(Ghost::legal(GhostShape::Point(meant.place * DVec3::new(-1.0, 1.0, 1.0))));
        }
        out.push(Ghost::legal(GhostShape::Text(at, meant.name)));
        out
    }

    fn next_step(&self, world: &World) -> String {
        let twin = if world.draft.template.mirrored { "; the other half follows" } else { "" };
        format!("click a cross (a feature point), or the body beside one{twin}")
    }

    fn target(&self, _: DVec2, _: &World) -> Option<Element> {
        None
    }
}
