//! Strokes that become profiles of edges.

use design::draft::{Edit, edges};
use glam::{DVec2, DVec3};
use sketch::{
    Camera, DrawnOver, PickOptions, PickedEdge, Plane, ProfileOptions, SketchError, SpaceEdge, Stabiliser,
    Stroke, bisecting_plane, drawn_over, fitted_plane, pick_edges, profiles, redrawn,
};
use template::format::{LineSpec, Shape};
use template::lines::{Detail, Profile};

use super::{Effect, Event, Ghost, GhostShape, Machine, World};
use crate::model::Face;
use crate::selection::{Element, Mode};

/// Template edges are chords and may run this deep under the skin that they span, mm.
const SLACK: f64 = 60.0;
/// The pen pulls the ink on a string of this length, points: it takes the hand's tremble.
const STRING: f64 = 2.0;

/// A row of edges bends by less than this share of its length: it counts as straight.
const STRAIGHT: f64 = 0.1;

#[derive(Default)]
pub(super) struct Sketch {
    ink: Option<Stabiliser>,
    pen: DVec2,
    /// The plane of the last stroke with the edges that it meant, to be shown.
    plane: Option<(Plane, Vec<DVec3>)>,
}

/// What a stroke means.
struct Meaning {
    names: Vec<[String; 2]>,
    space: Vec<SpaceEdge>,
    picked: Vec<PickedEdge>,
    plane: Option<Plane>,
}

fn meaning(stroke: &Stroke, world: &World) -> Result<Meaning, SketchError> {
    let ends = |[a, b]: &[String; 2]| Some(SpaceEdge { ends: [world.place(a)?, world.place(b)?] });
    let known = edges(&world.draft.template).into_keys().filter_map(|names| Some((ends(&names)?, names)));
    let (space, names): (Vec<SpaceEdge>, Vec<[String; 2]>) = known.unzip();
    let eye = world.picker.eye;
    let sight = world.picker.solids.seen_by(eye.is_parallel());
    let options = PickOptions { pixel_scale: world.pixel_scale, slack: SLACK };
    let picked = if world.picker.x_ray {
        pick_edges(&eye.camera, stroke, &space, &sketch::Clear, &options)
    } else {
        pick_edges(&eye.camera, stroke, &space, &sight, &options)
    };
    let meant: Vec<SpaceEdge> = picked.iter().map(|p| space[p.edge]).collect();
    let plane = match (&meant[..], picked.first()) {
        ([one], Some(pick)) => {
            Some(bisecting_plane(&eye.camera, one, &normals_at(&names[pick.edge], world))?)
        }
        ([], _) | (_, None) => None,
        (several, _) => Some(plane_of(&eye.camera, several)?),
    };
    Ok(Meaning { names, space, picked, plane })
}

/// The plane that fits several edges best. Edges in a row that is nearly straight fit many planes about as well: where the
/// best one is seen from its edge, the one through the row that faces the eye is taken.
fn plane_of(camera: &Camera, edges: &[SpaceEdge]) -> Result<Plane, SketchError> {
    let fitted = fitted_plane(camera, edges);
    if fitted != Err(SketchError::SeenEdgeOn) {
        return fitted;
    }
    let ends: Vec<DVec3> = edges.iter().flat_map(|e| e.ends).collect();
    let pairs = ends.iter().flat_map(|a| ends.iter().map(move |b| [*a, *b]));
    let farthest = pairs.max_by(|p, q| p[0].distance(p[1]).total_cmp(&q[0].distance(q[1])));
    let Some([a, b]) = farthest else { return fitted };
    let along = (b - a).normalize_or_zero();
    let off = |p: &DVec3| ((*p - a) - along * (*p - a).dot(along)).length();
    if ends.iter().any(|p| off(p) > STRAIGHT * a.distance(b)) {
        return fitted;
    }
    bisecting_plane(camera, &SpaceEdge { ends: [a, b] }, &[])
}

/// Normals of the template's faces at an edge.
fn normals_at(edge: &[String; 2], world: &World) -> Vec<DVec3> {
    let normal = |face: &Face| {
        let p: Vec<DVec3> = face.nodes.iter().filter_map(|n| world.place(n)).collect();
        // Newell's sum: right for faces that are not quite plane.
        (0..p.len()).map(|k| p[k].cross(p[(k + 1) % p.len()])).sum::<DVec3>().try_normalize()
    };
    let has = |face: &&Face| edge.iter().all(|end| face.nodes.contains(end));
    world.model.wires.faces.iter().filter(has).filter_map(normal).collect()
}

/// The profiles of a stroke as one edit.
fn edit(meaning: &Meaning, stroke: &Stroke, world: &World) -> Result<Option<Edit>, SketchError> {
    let Some(plane) = &meaning.plane else { return Ok(None) };
    let camera = &world.picker.eye.camera;
    let made = profiles(camera, stroke, &meaning.space, &meaning.picked, plane, &ProfileOptions::default())?;
    let lines = &world.draft.template.lines;
    let edits: Vec<Edit> = made
        .into_iter()
        .map(|profile| {
            let nodes = meaning.names[profile.edge].clone();
            let on_edge = |l: &&LineSpec| l.through.len() == 2 && l.through.iter().all(|n| nodes.contains(n));
            let own = lines.iter().find(|(_, l)| on_edge(l)).map(|(name, _)| name.clone());
            let name = own.unwrap_or_else(|| {
                world.free_name(&format!("{}_{}", nodes[0], nodes[1]), |n| lines.contains_key(n))
            });
            Edit::DrawProfile { name, nodes, points: profile.points.iter().map(|p| p.to_array()).collect() }
        })
        .collect();
    Ok(match edits.len() {
        0 => None,
        1 => edits.into_iter().next(),
        n => Some(Edit::Together { label: format!("draw {n} profiles"), edits }),
    })
}

/// The part of a profile that a stroke draws over: the profile's name, the part, and its edge's ends.
struct Over {
    name: String,
    nodes: [String; 2],
    part: DrawnOver,
    ends: [DVec3; 2],
}

/// The curve of a profile where its edge is now.
fn curve(line: &LineSpec, world: &World) -> Option<Profile> {
    let (Some(Shape::Profile(profile)), [a, b]) = (&line.shape, &line.through[..]) else { return None };
    let detail = if profile.turn { Detail::Turned } else { Detail::Kept };
    let drawn = profile.points.iter().map(|p| DVec3::from_array(*p)).collect();
    Some(Profile::new(drawn).moved(world.place(a)?, world.place(b)?, detail))
}

fn over(stroke: &Stroke, world: &World) -> Option<Over> {
    let camera = &world.picker.eye.camera;
    world.draft.template.lines.iter().find_map(|(name, line)| {
        let now = curve(line, world)?;
        let [a, b] = &line.through[..] else { return None };
        let ends = [world.place(a)?, world.place(b)?];
        let part = drawn_over(camera, stroke, now.points(), world.pixel_scale)?;
        let middle = part.parts[1][part.parts[1].len() / 2];
        let is_seen = world.picker.sees(middle, SLACK);
        is_seen.then(|| Over { name: name.clone(), nodes: [a.clone(), b.clone()], part, ends })
    })
}

/// The profile with its part drawn again, as an edit.
fn redraw(over: &Over, stroke: &Stroke, world: &World) -> Result<(Edit, Plane), SketchError> {
    let camera = &world.picker.eye.camera;
    let plane =
        bisecting_plane(camera, &SpaceEdge { ends: over.ends }, &normals_at(&sorted(&over.nodes), world))?;
    let points = redrawn(camera, stroke, &over.part, &plane, &ProfileOptions::default())?;
    let points = points.iter().map(|p| p.to_array()).collect();
    Ok((Edit::DrawProfile { name: over.name.clone(), nodes: over.nodes.clone(), points }, plane))
}

fn sorted([a, b]: &[String; 2]) -> [String; 2] {
    if a <= b { [a.clone(), b.clone()] } else { [b.clone(), a.clone()] }
}

impl Sketch {
    fn stroke(&self) -> Option<Stroke> {
        Stroke::new(self.ink.as_ref()?.points()).ok()
    }
}

impl Machine for Sketch {
    fn on(&mut self, event: Event, world: &World) -> Vec<Effect> {
        match event {
            Event::DragStart { from } => {
                let mut ink = Stabiliser::new(STRING * world.pixel_scale);
                ink.push(from);
                (self.ink, self.pen, self.plane) = (Some(ink), from, None);
                Vec::new()
            }
            Event::Drag { to } => {
                self.pen = to;
                if let Some(ink) = &mut self.ink {
                    ink.push(to);
                }
                Vec::new()
            }
            Event::DragEnd { to, .. } => {
                let Some(ink) = self.ink.take() else { return Vec::new() };
                let drawn = Stroke::new(&ink.finish(to)).and_then(|stroke| {
                    let meaning = meaning(&stroke, world)?;
                    if meaning.picked.is_empty()
                        && let Some(over) = over(&stroke, world)
                    {
                        let (edit, plane) = redraw(&over, &stroke, world)?;
                        return Ok((Some(edit), Some((plane, over.ends.to_vec()))));
                    }
                    let edit = edit(&meaning, &stroke, world)?;
                    let ends = meaning.picked.iter().flat_map(|p| meaning.space[p.edge].ends).collect();
                    Ok((edit, meaning.plane.map(|plane| (plane, ends))))
                });
                match drawn {
                    Ok((Some(edit), plane)) => {
                        self.plane = plane;
                        vec![Effect::Edit(edit)]
                    }
                    Ok((None, _)) => vec![Effect::Problem(
                        "the stroke is near both ends of no visible edge, and does not begin and end on a profile; \
                         draw from node to node along an edge of a face, or over a part of a profile"
                            .to_owned(),
                    )],
                    Err(e) => vec![Effect::Problem(e.to_string())],
                }
            }
            Event::Click { at, add } => {
                let edge = world.picker.all(at, Mode::Edges).into_iter().take(1).collect();
                vec![if add { Effect::Toggle(edge) } else { Effect::Select(edge) }]
            }
            Event::Cancel if self.ink.is_some() || self.plane.is_some() => {
                (self.ink, self.plane) = (None, None);
                Vec::new()
            }
            Event::Cancel => vec![Effect::Select(Vec::new())],
            Event::LassoStart { .. } | Event::Confirm => Vec::new(),
        }
    }

    fn ghosts(&self, _: Option<DVec2>, world: &World) -> Vec<Ghost> {
        // Edges are drawn straight; these are the curves that can be drawn over.
        let curves = world.draft.template.lines.values().filter_map(|line| curve(line, world));
        let seen = curves.filter(|c| world.picker.sees(c.place(0.5), SLACK));
        let mut out: Vec<Ghost> = seen.map(|c| Ghost::legal(GhostShape::Thin(c.points().to_vec()))).collect();
        let mut shown = self.plane.clone();
        if let Some(stroke) = self.stroke() {
            // What the stroke so far would replace of a profile.
            let part = over(&stroke, world).map(|o| GhostShape::Line(o.part.parts[1].clone()));
            if let Ok(meaning) = meaning(&stroke, world) {
                for pick in &meaning.picked {
                    out.push(Ghost::legal(GhostShape::Line(meaning.space[pick.edge].ends.to_vec())));
                }
                let ends = meaning.picked.iter().flat_map(|p| meaning.space[p.edge].ends).collect();
                shown = meaning.plane.map(|plane| (plane, ends));
                if let Some(shape) = part.filter(|_| meaning.picked.is_empty()) {
                    out.push(Ghost { shape, is_legal: false });
                }
            }
            let mut ink = stroke.points().to_vec();
            // The ink is never behind the pen.
            ink.push(self.pen);
            out.push(Ghost::legal(GhostShape::Ink(ink)));
        }
        if let Some((plane, ends)) = shown {
            out.push(Ghost::legal(GhostShape::Area(rectangle(&plane, &ends, world))));
        }
        out
    }

    fn next_step(&self, _: &World) -> String {
        if self.ink.is_some() {
            return "draw on to the next node; the shaded plane is the one that the stroke goes on"
                .to_owned();
        }
        "draw from node to node over edges of faces, or over a part of a profile; Delete takes that of the chosen edge"
            .to_owned()
    }

    fn target(&self, at: DVec2, world: &World) -> Option<Element> {
        match self.ink {
            Some(_) => None,
            None => world.picker.all(at, Mode::Edges).into_iter().next(),
        }
    }
}

/// A part of the plane about the edges.
fn rectangle(plane: &Plane, ends: &[DVec3], world: &World) -> Vec<DVec3> {
    let up = world.picker.eye.camera.up;
    let up = (up - plane.normal * up.dot(plane.normal)).normalize_or(DVec3::Y);
    let right = up.cross(plane.normal);
    let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
    for p in ends {
        let at = DVec2::new((*p - plane.point).dot(right), (*p - plane.point).dot(up));
        (low, high) = (low.min(at), high.max(at));
    }
    let air = 0.25 * (high - low).max_element();
    let (low, high) = (low - air, high + air);
    [(low.x, low.y), (high.x, low.y), (high.x, high.y), (low.x, high.y)]
        .map(|(x, y)| plane.point + right * x + up * y)
        .to_vec()
}
