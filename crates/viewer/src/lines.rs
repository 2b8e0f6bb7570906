//! Lines and points of a scene over its surfaces: crisp widths in pixels, parts behind surfaces told apart.

use glam::{DVec2, DVec3};

use crate::camera::Projector;
use crate::color::Color;
use crate::image::Image;
use crate::painter::{Dash, Painter, Point};
use crate::render::RenderOptions;
use crate::scene::{Hidden, Scene};

/// Strength of hidden lines.
const FAINT: f32 = 0.28;
/// Pieces of one state shorter than this (pixels) take their neighbours' state: a seam that grazes its own surface
/// must not flicker.
const SHORTEST: usize = 4;

/// The surfaces' depth, to ask whether something is hidden.
pub(crate) struct Depth<'a> {
    pub(crate) nearness: &'a [f32],
    pub(crate) width: usize,
    pub(crate) height: usize,
    pub(crate) projector: &'a Projector,
    /// What lies this little behind a surface counts as on it, in millimetres.
    pub(crate) bias: f64,
}

/// A place along a line in the picture.
#[derive(Clone, Copy)]
struct Step {
    at: DVec2,
    visible: bool,
}

impl Depth<'_> {
    /// A place moved towards the eye by the bias, in the picture; `None` behind the eye.
    fn raised(&self, p: DVec3) -> Option<(DVec2, f64)> {
        let at = self.projector.project(p)?.at;
        let (origin, direction) = self.projector.ray(at);
        let forward = (p - origin).dot(direction) - self.bias;
        Some((at, self.projector.project(origin + direction * forward)?.nearness))
    }

    /// Whether the surfaces leave a picture position of this nearness visible. Asks the pixel and its four
    /// neighbours, so that lines on outlines show.
    fn shows(&self, at: DVec2, nearness: f64) -> bool {
        let (x, y) = (at.x.floor() as i64, at.y.floor() as i64);
        [(0, 0), (1, 0), (-1, 0), (0, 1), (0, -1)].iter().any(|(dx, dy)| {
            let (x, y) = (x + dx, y + dy);
            if x < 0 || y < 0 || x >= self.width as i64 || y >= self.height as i64 {
                return (*dx, *dy) == (0, 0);
            }
            nearness >= f64::from(self.nearness[y as usize * self.width + x as usize])
        })
    }

    /// Where a place is in the picture, and whether it is visible; `None` behind the eye.
    pub(crate) fn locate(&self, p: DVec3) -> Option<(Point, bool)> {
        let (at, nearness) = self.raised(p)?;
        Some(([at.x as f32, at.y as f32], self.shows(at, nearness)))
    }

    /// The line as steps of about a pixel; pieces behind the eye are left out.
    fn walk(&self, points: &[DVec3]) -> Vec<Vec<Step>> {
        let mut pieces: Vec<Vec<Step>> = vec![Vec::new()];
        let size = DVec2::new(self.width as f64, self.height as f64);
        let mut last: Option<(DVec2, f64)> = None;
        for p in points {
            let Some((to, near_to)) = self.raised(*p) else {
                last = None;
                pieces.push(Vec::new());
                continue;
            };
            let piece = pieces.last_mut().expect("there is always a piece");
            if let Some((from, near_from)) = last {
                let length = (to - from).length();
                // Far outside the picture a step more or less is not seen.
                let beyond = from.max(to).min_element() < 0.0 || (from.min(to) - size).max_element() > 0.0;
                let steps = if beyond || !length.is_finite() {
                    1
                } else {
                    length.ceil().clamp(1.0, 40_000.0) as usize
                };
                for i in 1..=steps {
                    let t = i as f64 / steps as f64;
                    let at = from.lerp(to, t);
                    piece.push(Step { at, visible: self.shows(at, near_from + (near_to - near_from) * t) });
                }
            } else {
                piece.push(Step { at: to, visible: self.shows(to, near_to) });
            }
            last = Some((to, near_to));
        }
        for piece in &mut pieces {
            settle(piece);
        }
        pieces
    }
}

/// Gives pieces of one state that are shorter than [`SHORTEST`] steps the state before them.
fn settle(steps: &mut [Step]) {
    let mut start = 0;
    while start < steps.len() {
        let state = steps[start].visible;
        let end = steps[start..].iter().position(|s| s.visible != state).map_or(steps.len(), |n| start + n);
        let inner = start > 0 && end < steps.len();
        if inner && end - start < SHORTEST {
            for s in &mut steps[start..end] {
                s.visible = !state;
            }
        }
        start = end;
    }
}

/// Draws all lines, hidden parts first, then all points.
pub(crate) fn draw(image: &mut Image, scene: &Scene, depth: &Depth, options: &RenderOptions) {
    if scene.lines.is_empty() && scene.points.is_empty() {
        return;
    }
    let unit = options.unit() as f32;
    let mut painter = Painter::new(image);
    let walks: Vec<Vec<Vec<Step>>> = scene.lines.iter().map(|line| depth.walk(&line.points)).collect();
    for hidden_pass in [true, false] {
        for (line, pieces) in scene.lines.iter().zip(&walks) {
            let width = line.width as f32 * unit;
            let shown = line.hidden == Hidden::Shown;
            let (dash, alpha): (Option<Dash>, f32) = match (hidden_pass, line.hidden) {
                (false, _) => (line.dashed.then_some([7.0 * unit, 4.5 * unit]), 1.0),
                (true, Hidden::Omitted | Hidden::Shown) => continue,
                (true, Hidden::Faint) => (None, FAINT),
                (true, Hidden::Dashed) => (Some([4.0 * unit, 4.0 * unit]), 1.6 * FAINT),
            };
            for piece in pieces {
                for run in runs(piece, hidden_pass, shown) {
                    match dash {
                        None => painter.cover(&run, width),
                        Some(dash) => painter.cover_dashed(&run, width, dash),
                    }
                }
            }
            painter.flush(line.color, alpha);
        }
    }
    for point in &scene.points {
        let Some((at, visible)) = depth.locate(point.position) else { continue };
        let alpha = match (visible, point.hidden) {
            (true, _) | (_, Hidden::Shown) => 1.0,
            (false, Hidden::Omitted) => continue,
            (false, Hidden::Faint | Hidden::Dashed) => FAINT,
        };
        let radius = 0.5 * point.diameter as f32 * unit;
        if radius > 2.0 {
            painter.disc(at, radius + 0.9 * unit, Color::WHITE, alpha);
        }
        painter.disc(at, radius, point.color, alpha);
    }
}

/// The parts of a line that are visible (or hidden), thinned to corners that matter.
fn runs(steps: &[Step], hidden: bool, all: bool) -> Vec<Vec<Point>> {
    let mut out: Vec<Vec<Point>> = Vec::new();
    let mut open = false;
    for (i, step) in steps.iter().enumerate() {
        if all || step.visible != hidden {
            let at = [step.at.x as f32, step.at.y as f32];
            if !open {
                // Join to the step before, so that a run does not start a pixel late.
                out.push(if i > 0 {
                    vec![[steps[i - 1].at.x as f32, steps[i - 1].at.y as f32]]
                } else {
                    Vec::new()
                });
            }
            open = true;
            if let Some(run) = out.last_mut() {
                // A step that goes straight on replaces the last corner.
                let n = run.len();
                if n >= 2 && straight(run[n - 2], run[n - 1], at) {
                    run[n - 1] = at;
                } else {
                    run.push(at);
                }
            }
        } else {
            open = false;
        }
    }
    out
}

fn straight(a: Point, b: Point, c: Point) -> bool {
    let (u, v) = ([b[0] - a[0], b[1] - a[1]], [c[0] - b[0], c[1] - b[1]]);
    let cross = (u[0] * v[1] - u[1] * v[0]).abs();
    let dot = u[0] * v[0] + u[1] * v[1];
    dot > 0.0 && cross < 0.02 * u[0].hypot(u[1]).max(1e-6) && v[0].hypot(v[1]) < 1.5
}
