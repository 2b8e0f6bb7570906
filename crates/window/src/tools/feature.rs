//! Feature curves drawn on the body: strokes, plane sections, shortest paths.

use design::draft::{DrawnFeature, Edit};
use glam::{DVec2, DVec3};
use mesh_kernel::query::{plane_section, shortest_path};

use super::{Effect, Event, Ghost, GhostShape, Machine, World};
use crate::model::DRAWN;
use crate::selection::Element;

/// How a curve comes about.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Drawing {
    /// A free stroke on the skin.
    #[default]
    Stroke,
    /// A line across the body: the plane through it and the eye cuts the body.
    Section,
    /// From a place to another on the shortest way.
    Path,
}

impl Drawing {
    pub(crate) const ALL: [(Self, &'static str); 3] =
        [(Self::Stroke, "Free stroke"), (Self::Section, "Plane section"), (Self::Path, "Shortest path")];
}

/// Points of a stroke on the skin nearer to each other than this are one, mm.
const SPACING: f64 = 4.0;
/// A stroke whose ends come as near to each other closes, mm.
const CLOSES: f64 = 20.0;

#[derive(Default)]
pub(super) struct Feature {
    ink: Vec<DVec2>,
    /// Where the shortest path begins.
    from: Option<DVec3>,
}

fn on_body(at: DVec2, world: &World) -> Option<DVec3> {
    world.picker.solids.on_body(&world.picker.eye.ray(at))
}

/// The edit that draws a curve under a name of its own.
fn drawn(points: Vec<DVec3>, closed: bool, world: &World) -> Effect {
    let have = &world.draft.features;
    let name = world.free_name(&format!("{DRAWN}curve"), |n| have.contains_key(n));
    let points = points.iter().map(|p| p.to_array()).collect();
    Effect::Edit(Edit::DrawFeature { name, feature: DrawnFeature { points, closed } })
}

fn stroke(ink: &[DVec2], world: &World) -> Result<Effect, &'static str> {
    let mut points: Vec<DVec3> = Vec::new();
    for at in ink {
        let Some(p) = on_body(*at, world) else { continue };
        if points.last().is_none_or(|last| last.distance(p) > SPACING) {
            points.push(p);
        }
    }
    if points.len() < 2 {
        return Err("the stroke misses the body; draw on its skin");
    }
    let closed = points.len() > 8 && points[0].distance(points[points.len() - 1]) < CLOSES;
    if closed {
        points.pop();
    }
    Ok(drawn(points, closed, world))
}

/// The plane that a line of the picture makes with the eye.
fn section(ink: &[DVec2], world: &World) -> Result<Effect, &'static str> {
    let (Some(a), Some(b)) = (ink.first(), ink.last()) else { return Err("draw a line across the body") };
    let eye = world.picker.eye;
    let (p, q) = (eye.ray(*a), eye.ray(*b));
    let across = if eye.is_parallel() { q.origin - p.origin } else { q.direction };
    let normal = p.direction.cross(across).try_normalize().ok_or("draw a longer line across the body")?;
    let hit = (0..=20).find_map(|k| on_body(a.lerp(*b, 0.5 + 0.025 * f64::from(k) * sign(k)), world));
    let hit = hit.ok_or("the line misses the body; draw it across the skin")?;
    let human = world.model.human().ok_or("the body is not ready yet")?;
    let rings = plane_section(&human.mesh, p.origin, normal);
    let nearest = |points: &[DVec3]| points.iter().map(|r| r.distance(hit)).fold(f64::INFINITY, f64::min);
    let ring = rings.into_iter().min_by(|r, s| nearest(&r.points).total_cmp(&nearest(&s.points)));
    let ring = ring.filter(|r| r.points.len() > 2).ok_or("the plane does not cut the body")?;
    Ok(drawn(ring.points, ring.closed, world))
}

/// Right and left in turns.
fn sign(k: i32) -> f64 {
    if k % 2 == 0 { 1.0 } else { -1.0 }
}

impl Machine for Feature {
    fn on(&mut self, event: Event, world: &World) -> Vec<Effect> {
        let said = |made: Result<Effect, &str>| vec![made.unwrap_or_else(|e| Effect::Problem(e.to_owned()))];
        match (event, world.drawing) {
            (Event::Click { at, .. }, Drawing::Path) => {
                let Some(to) = on_body(at, world) else {
                    return said(Err("there is no body here; click its skin"));
                };
                let Some(from) = self.from.take() else {
                    self.from = Some(to);
                    return Vec::new();
                };
                let mesh = world.model.human().map(|h| &h.mesh);
                let path = mesh.and_then(|mesh| shortest_path(mesh, from, to)).filter(|p| p.len() > 1);
                said(path.map(|p| drawn(p, false, world)).ok_or("no path on the skin joins the two places"))
            }
            (Event::Click { .. }, _) => said(Err("press, draw over the body, and let go")),
            (Event::DragStart { from }, Drawing::Stroke | Drawing::Section) => {
                self.ink = vec![from];
                Vec::new()
            }
            (Event::Drag { to }, Drawing::Stroke | Drawing::Section) if !self.ink.is_empty() => {
                self.ink.push(to);
                Vec::new()
            }
            (Event::DragEnd { to, .. }, drawing) if !self.ink.is_empty() => {
                let mut ink = std::mem::take(&mut self.ink);
                ink.push(to);
                said(if drawing == Drawing::Section { section(&ink, world) } else { stroke(&ink, world) })
            }
            (Event::Cancel, _) => {
                self.ink.clear();
                self.from = None;
                Vec::new()
            }
            _ => Vec::new(),
        }
    }

    fn ghosts(&self, pointer: Option<DVec2>, world: &World) -> Vec<Ghost> {
        let mut out = Vec::new();
        match (world.drawing, self.ink.first(), self.ink.last()) {
            (Drawing::Section, Some(a), Some(b)) => out.push(Ghost::legal(GhostShape::Ink(vec![*a, *b]))),
            (Drawing::Stroke, Some(_), Some(_)) => out.push(Ghost::legal(GhostShape::Ink(self.ink.clone()))),
            _ => {}
        }
        if let Some(from) = self.from {
            out.push(Ghost::legal(GhostShape::Point(from)));
            if let (Some(at), Some(start)) = (pointer, world.picker.eye.camera.project(from)) {
                out.push(Ghost::legal(GhostShape::Ink(vec![start, at])));
            }
        }
        out
    }

    fn next_step(&self, world: &World) -> String {
        match (world.drawing, self.from) {
            (Drawing::Stroke, _) => {
                "draw on the skin; a stroke that comes back to its beginning closes".to_owned()
            }
            (Drawing::Section, _) => {
                "draw a straight line across the body: the plane through it cuts the skin".to_owned()
            }
            (Drawing::Path, None) => "click where the curve begins".to_owned(),
            (Drawing::Path, Some(_)) => "click where the curve ends; Escape starts again".to_owned(),
        }
    }

    fn target(&self, _: DVec2, _: &World) -> Option<Element> {
        None
    }
}
