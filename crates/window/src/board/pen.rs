//! The tools of the drawing board: state machines from events to effects on the drawing, without a window.

use eframe::egui::Key;
use glam::DVec2;
use sketch::{Drawing, DrawingError, PointId, ShapeId, Snap, SnapKind, SnapOptions};

use super::typed::Typed;
use super::world::{Part, Place, World};
use crate::region::Region;

/// What the pointer does on the drawing board.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Tool {
    Select,
    Line,
    Arc,
    Circle,
    Curve,
    Spline,
    Bend,
    Trim,
    Extend,
    Round,
    Split,
}

impl Tool {
    /// Every tool with its name, key, and what it is for.
    pub(crate) const ALL: [(Self, &'static str, Key, &'static str); 11] = [
        (Self::Select, "Select", Key::V, "Select and move points, shapes and handles"),
        (Self::Line, "Line", Key::L, "Draw straight lines end to end"),
        (Self::Arc, "Arc", Key::A, "Draw an arc: both ends, then a place that it runs over"),
        (Self::Circle, "Circle", Key::O, "Draw a circle about a centre"),
        (Self::Curve, "Curve", Key::C, "Draw Bézier curves: clicks make corners, drags pull handles"),
        (Self::Spline, "Spline", Key::S, "Draw a smooth curve through places"),
        (Self::Bend, "Bend", Key::B, "Pull a line or an arc over a place"),
        (Self::Trim, "Trim", Key::T, "Take a part away as far as to the next crossings"),
        (Self::Extend, "Extend", Key::X, "Prolong a line to the next shape"),
        (Self::Round, "Round", Key::R, "Round the corner of two lines"),
        (Self::Split, "Split", Key::P, "Make two shapes of one"),
    ];
}

/// What happens on the board.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Event {
    /// The button went down and up in one place. `add`: Shift is held.
    Click {
        place: Place,
        add: bool,
    },
    /// A drag began.
    DragStart {
        from: Place,
    },
    /// A drag with Ctrl began.
    LassoStart {
        from: Place,
    },
    Drag {
        to: Place,
    },
    DragEnd {
        to: Place,
        add: bool,
    },
    /// A number, with the pointer where it is.
    Typed {
        typed: Typed,
        pointer: Option<DVec2>,
    },
    /// Enter.
    Confirm,
    /// Escape.
    Cancel,
}

/// What a tool wants done.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Effect {
    Draw {
        label: String,
        drawing: Drawing,
    },
    /// A step of a drag: the first is an entry of the history, the others go on it.
    Live {
        label: String,
        drawing: Drawing,
    },
    /// The drag is over.
    Settle,
    Select(Vec<Part>),
    Toggle(Vec<Part>),
    /// Corners are rounded by this from now on, mm.
    Radius(f64),
    /// Why nothing happened, and what to do.
    Problem(String),
}

/// A place that a shape under way goes through: a point of the drawing, or one that is made with the shape.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Anchor {
    at: DVec2,
    point: Option<PointId>,
}

impl Anchor {
    /// Its point, made where there is none; undo may have taken the one that it had.
    fn resolve(&self, drawing: &mut Drawing) -> Result<PointId, DrawingError> {
        // After an undo its number may be another point's.
        let is_here = |p: &PointId| drawing.place(*p).is_ok_and(|q| q.distance(self.at) < 1e-6);
        match self.point.filter(is_here) {
            Some(point) => Ok(point),
            None => drawing.add_point(self.at),
        }
    }
}

#[derive(Clone, Debug, Default, PartialEq)]
enum Drag {
    #[default]
    None,
    /// A part is moved; the drawing as it was, for every step starts from there.
    Part {
        part: Part,
        from: DVec2,
        before: Box<Drawing>,
    },
    /// A line or an arc is bent.
    Bend {
        shape: ShapeId,
        before: Box<Drawing>,
    },
    /// The handle of a new point is pulled.
    Pull {
        at: Place,
        to: DVec2,
    },
    Region(Region),
}

/// A tool at work.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Pen {
    pub(crate) tool: Tool,
    /// Places of the shape under way.
    taken: Vec<Anchor>,
    /// Where a row of lines or curves began: coming back ends it.
    begin: Option<PointId>,
    /// The handle with which the next curve leaves.
    leaves: Option<DVec2>,
    drag: Drag,
}

impl Pen {
    pub(crate) fn new(tool: Tool) -> Self {
        Self { tool, taken: Vec::new(), begin: None, leaves: None, drag: Drag::None }
    }

    /// What the pointer snaps to, as the tool has it now.
    pub(crate) fn place(&self, pointer: DVec2, world: &World) -> Place {
        let moving = match &self.drag {
            Drag::Part { part: Part::Point(point), .. } => Some(*point),
            _ => None,
        };
        let draws = !matches!(self.tool, Tool::Select | Tool::Trim | Tool::Extend | Tool::Round);
        let snaps = (draws || moving.is_some()) && !matches!(self.drag, Drag::Pull { .. });
        let from = self.taken.last().map(|a| a.at);
        let options = SnapOptions { radius: world.reach, grid: world.grid, from, moving };
        Place { pointer, snap: world.drawing.snap(pointer, &options).filter(|_| snaps) }
    }

    /// Where the shape under way begins or goes on from.
    pub(crate) fn from(&self) -> Option<DVec2> {
        self.taken.last().map(|a| a.at)
    }

    /// Lines from place to place of what is under way, and on to the pointer.
    pub(crate) fn trail(&self, pointer: Option<DVec2>) -> Vec<DVec2> {
        if self.taken.is_empty() {
            return Vec::new();
        }
        self.taken.iter().map(|a| a.at).chain(pointer).collect()
    }

    /// The handles that are being pulled: to the left, the point, to the right.
    pub(crate) fn pulled(&self) -> Option<[DVec2; 3]> {
        match &self.drag {
            Drag::Pull { at, to } => Some([2.0 * at.at() - *to, at.at(), *to]),
            _ => None,
        }
    }

    /// What a box or a lasso goes round.
    pub(crate) fn region(&self) -> Option<&Region> {
        match &self.drag {
            Drag::Region(region) => Some(region),
            _ => None,
        }
    }

    fn rest(&mut self) {
        *self = Self::new(self.tool);
    }

    pub(crate) fn on(&mut self, event: Event, world: &World) -> Vec<Effect> {
        match event {
            Event::Click { place, add } => self.click(place, add, world),
            Event::DragStart { from } => {
                self.start(from, world);
                match self.drag {
                    Drag::Part { part, .. } if !world.selection.contains(&part) => {
                        vec![Effect::Select(vec![part])]
                    }
                    _ => Vec::new(),
                }
            }
            Event::LassoStart { from } => {
                self.drag = Drag::Region(Region::new(from.pointer, true));
                Vec::new()
            }
            Event::Drag { to } => self.dragged(to),
            Event::DragEnd { to, add } => self.dropped(to, add, world),
            Event::Typed { typed, pointer } => self.typed(typed, pointer, world),
            Event::Confirm if self.tool == Tool::Spline && self.taken.len() > 1 => self.spline(false, world),
            Event::Confirm => {
                self.rest();
                Vec::new()
            }
            Event::Cancel => self.cancel(world),
        }
    }

    fn cancel(&mut self, world: &World) -> Vec<Effect> {
        let back = match std::mem::take(&mut self.drag) {
            Drag::Part { before, .. } | Drag::Bend { before, .. } => Some(before),
            _ => None,
        };
        let is_idle = self.taken.is_empty() && back.is_none();
        self.rest();
        match back {
            Some(before) => {
                vec![Effect::Live { label: "move back".to_owned(), drawing: *before }, Effect::Settle]
            }
            None if is_idle && !world.selection.is_empty() => vec![Effect::Select(Vec::new())],
            None => Vec::new(),
        }
    }

    fn click(&mut self, place: Place, add: bool, world: &World) -> Vec<Effect> {
        match self.tool {
            Tool::Select => {
                let picked = world.pick(place.pointer).into_iter().collect();
                vec![if add { Effect::Toggle(picked) } else { Effect::Select(picked) }]
            }
            Tool::Line | Tool::Arc | Tool::Circle | Tool::Spline => self.take(place, world),
            Tool::Curve => self.curve(place, None, world),
            Tool::Bend => problem("drag a line or an arc to bend it"),
            Tool::Round => match world.pick(place.pointer) {
                Some(Part::Point(corner)) => {
                    let radius = world.radius;
                    drawn("round a corner", world, |d| d.round(corner, radius).map(drop))
                }
                _ => problem("click the corner of two lines"),
            },
            Tool::Trim | Tool::Extend | Tool::Split => {
                let Some(shape) = world.shape(place.at()) else { return problem("there is no shape here") };
                let at = place.at();
                match self.tool {
                    Tool::Trim => drawn("trim", world, |d| d.trim(shape, at)),
                    Tool::Extend => drawn("extend a line", world, |d| {
                        let curve = d.curve(shape)?;
                        let is_end = curve.end().distance(at) < curve.start().distance(at);
                        d.extend(shape, usize::from(is_end))
                    }),
                    _ => drawn("split", world, |d| {
                        let t = d.curve(shape)?.nearest(at).t;
                        d.split(shape, t).map(drop)
                    }),
                }
            }
        }
    }

    /// A place for the shape under way.
    fn take(&mut self, place: Place, world: &World) -> Vec<Effect> {
        let new = Anchor { at: place.at(), point: place.point() };
        match (self.tool, &self.taken[..]) {
            (Tool::Line, &[from]) => {
                let mut reached = None;
                let effects = drawn("draw a line", world, |d| {
                    let (a, b) = (from.resolve(d)?, new.resolve(d)?);
                    reached = Some([a, b]);
                    d.add_line(a, b).map(drop)
                });
                if let (Some([a, b]), [Effect::Draw { .. }]) = (reached, &effects[..]) {
                    self.go_on(a, b, new.at, None);
                }
                return effects;
            }
            (Tool::Arc, &[from, to]) => {
                let over = new.at;
                let effects = drawn("draw an arc", world, |d| {
                    let (a, b) = (from.resolve(d)?, to.resolve(d)?);
                    d.add_arc(a, over, b).map(drop)
                });
                return self.done(effects);
            }
            (Tool::Circle, &[center]) => {
                let radius = center.at.distance(new.at);
                let effects = drawn("draw a circle", world, |d| {
                    let center = center.resolve(d)?;
                    d.add_circle(center, radius).map(drop)
                });
                return self.done(effects);
            }
            (Tool::Spline, taken) if taken.len() > 2 && taken[0].at.distance(new.at) <= world.reach => {
                return self.spline(true, world);
            }
            _ => {}
        }
        if self.taken.last().is_some_and(|last| last.at == new.at) {
            return problem("this is the place before; click another one");
        }
        self.taken.push(new);
        Vec::new()
    }

    /// Ends the shape under way when it could be drawn.
    fn done(&mut self, effects: Vec<Effect>) -> Vec<Effect> {
        if matches!(effects[..], [Effect::Draw { .. }]) {
            self.rest();
        } else {
            // The last place was no good; those before stay.
            self.drag = Drag::None;
        }
        effects
    }

    /// The row goes on from the point that was reached, or ends where it began.
    fn go_on(&mut self, from: PointId, reached: PointId, at: DVec2, leaves: Option<DVec2>) {
        let begin = *self.begin.get_or_insert(from);
        if reached == begin {
            self.rest();
        } else {
            self.taken = vec![Anchor { at, point: Some(reached) }];
            self.leaves = leaves;
        }
    }

    /// The next point of a row of Bézier curves; `pull` is where its handle was pulled to.
    fn curve(&mut self, place: Place, pull: Option<DVec2>, world: &World) -> Vec<Effect> {
        let new = Anchor { at: place.at(), point: place.point() };
        let Some(from) = self.taken.last().copied() else {
            (self.taken, self.leaves) = (vec![new], pull);
            return Vec::new();
        };
        let leaves = self.leaves;
        let is_row = self.begin.is_some();
        let mut reached = None;
        let effects = drawn("draw a curve", world, |d| {
            let (a, b) = (from.resolve(d)?, new.resolve(d)?);
            reached = Some([a, b]);
            // Without a handle it leaves straight for the other end.
            let leave = leaves.unwrap_or(from.at.lerp(new.at, 1.0 / 3.0));
            let arrive = pull.map_or(new.at.lerp(from.at, 1.0 / 3.0), |to| 2.0 * new.at - to);
            d.add_bezier(a, leave, arrive, b)?;
            if is_row && leaves.is_some() && d.at_point(a).len() == 2 {
                d.set_smooth(a, true)?;
            }
            Ok(())
        });
        if let (Some([a, b]), [Effect::Draw { .. }]) = (reached, &effects[..]) {
            self.go_on(a, b, new.at, pull);
        }
        effects
    }

    fn spline(&mut self, is_closed: bool, world: &World) -> Vec<Effect> {
        let taken = self.taken.clone();
        let effects = drawn("draw a spline", world, |d| {
            let mut through = Vec::with_capacity(taken.len() + 1);
            for anchor in &taken {
                through.push(anchor.resolve(d)?);
            }
            if is_closed {
                through.extend(through.first().copied());
            }
            d.add_spline(&through).map(drop)
        });
        self.done(effects)
    }

    fn start(&mut self, from: Place, world: &World) {
        self.drag = match self.tool {
            Tool::Select => match world.pick(from.pointer) {
                Some(part) => {
                    Drag::Part { part, from: from.pointer, before: Box::new(world.drawing.clone()) }
                }
                None => Drag::Region(Region::new(from.pointer, false)),
            },
            Tool::Bend => match world.shape(from.pointer) {
                Some(shape) => Drag::Bend { shape, before: Box::new(world.drawing.clone()) },
                None => Drag::None,
            },
            Tool::Curve => Drag::Pull { at: from, to: from.pointer },
            _ => Drag::None,
        };
    }

    fn dragged(&mut self, to: Place) -> Vec<Effect> {
        match &mut self.drag {
            Drag::Part { part, from, before } => {
                let (part, from) = (*part, *from);
                live("move", before, |d| move_part(d, part, to, to.pointer - from))
            }
            Drag::Bend { shape, before } => {
                let shape = *shape;
                live("bend", before, |d| d.bend(shape, to.at()))
            }
            Drag::Pull { to: end, .. } => {
                *end = to.pointer;
                Vec::new()
            }
            Drag::Region(region) => {
                region.reach(to.pointer);
                Vec::new()
            }
            Drag::None => Vec::new(),
        }
    }

    fn dropped(&mut self, to: Place, add: bool, world: &World) -> Vec<Effect> {
        match std::mem::take(&mut self.drag) {
            Drag::Part { part: Part::Point(point), from, before } => {
                // Let go on another point the two become one.
                let mut effects = match to.point().filter(|other| *other != point) {
                    Some(other) => live("move", &before, |d| d.merge(other, point)),
                    None => {
                        live("move", &before, |d| move_part(d, Part::Point(point), to, to.pointer - from))
                    }
                };
                effects.push(Effect::Settle);
                effects
            }
            Drag::Part { .. } | Drag::Bend { .. } => vec![Effect::Settle],
            Drag::Pull { at, .. } => self.curve(at, Some(to.pointer), world),
            Drag::Region(mut region) => {
                region.reach(to.pointer);
                let inside = world.within(&region);
                vec![if add { Effect::Toggle(inside) } else { Effect::Select(inside) }]
            }
            // A drag of a tool that draws by clicks is a click that trembled.
            Drag::None => self.click(to, add, world),
        }
    }

    fn typed(&mut self, typed: Typed, pointer: Option<DVec2>, world: &World) -> Vec<Effect> {
        match (self.tool, typed, &self.taken[..]) {
            (Tool::Round, Typed::Length(radius), _) if radius > 0.0 => return vec![Effect::Radius(radius)],
            (Tool::Arc, Typed::Length(radius), [from, to]) => {
                return match over(from.at, to.at, radius, pointer) {
                    Some(over) => self.take(Place { pointer: over, snap: None }, world),
                    None => problem("the radius is less than half of what is between the arc's ends"),
                };
            }
            (Tool::Line | Tool::Arc | Tool::Circle | Tool::Curve | Tool::Spline, ..) => {}
            _ => return problem("no shape is being drawn that takes a number"),
        }
        let Some(at) = typed.place(self.from(), pointer) else {
            return problem("type the first place as across; up, or click it");
        };
        let near = 1e-9 * (1.0 + at.length());
        let known = world.drawing.points().find(|(_, p)| p.distance(at) <= near);
        let snap = known.map(|(id, at)| Snap { at, kind: SnapKind::Point(id) });
        let place = Place { pointer: at, snap };
        if self.tool == Tool::Curve { self.curve(place, None, world) } else { self.take(place, world) }
    }

    /// The next step in words.
    pub(crate) fn next_step(&self) -> &'static str {
        match (self.tool, self.taken.len()) {
            (Tool::Select, _) => {
                "click a point or a shape; Shift adds; drag to move, onto another point to join; drag a box, with Ctrl a lasso"
            }
            (Tool::Line, 0) => "click where the line begins, or type across; up",
            (Tool::Line, _) => {
                "click where it ends, or type a length, 40 @ 30, or across; up; Escape ends the row"
            }
            (Tool::Arc, 0) => "click where the arc begins",
            (Tool::Arc, 1) => "click where it ends, or type how far that is",
            (Tool::Arc, _) => "click a place that it runs over, or type its radius",
            (Tool::Circle, 0) => "click the centre",
            (Tool::Circle, _) => "click a place on the circle, or type its radius",
            (Tool::Curve, 0) => "click a corner, or press and pull a handle out of it",
            (Tool::Curve, _) => "click or pull the next point; the first one closes the row; Escape ends it",
            (Tool::Spline, 0 | 1) => "click places that the curve goes through",
            (Tool::Spline, _) => "click the next place; Enter draws the curve, the first place closes it",
            (Tool::Bend, _) => "drag a line or an arc over a place",
            (Tool::Trim, _) => "click the part that goes; it is shown red",
            (Tool::Extend, _) => "click a line near the end that is prolonged",
            (Tool::Round, _) => "click the corner of two lines; type another radius",
            (Tool::Split, _) => "click where the shape is split",
        }
    }
}

fn problem(text: &str) -> Vec<Effect> {
    vec![Effect::Problem(text.to_owned())]
}

fn drawn(
    label: &str,
    world: &World,
    edit: impl FnOnce(&mut Drawing) -> Result<(), DrawingError>,
) -> Vec<Effect> {
    let mut drawing = world.drawing.clone();
    match edit(&mut drawing) {
        Ok(()) => vec![Effect::Draw { label: label.to_owned(), drawing }],
        Err(e) => vec![Effect::Problem(e.to_string())],
    }
}

fn live(
    label: &str,
    before: &Drawing,
    edit: impl FnOnce(&mut Drawing) -> Result<(), DrawingError>,
) -> Vec<Effect> {
    let mut drawing = before.clone();
    match edit(&mut drawing) {
        Ok(()) => vec![Effect::Live { label: label.to_owned(), drawing }],
        Err(e) => vec![Effect::Problem(e.to_string())],
    }
}

fn move_part(drawing: &mut Drawing, part: Part, to: Place, by: DVec2) -> Result<(), DrawingError> {
    match part {
        Part::Point(point) => drawing.move_point(point, to.at()),
        Part::Handle(shape, end) => drawing.move_handle(shape, end, to.pointer),
        Part::Shape(shape) => {
            let mut points = drawing.shape(shape)?.points().to_vec();
            points.sort_unstable();
            points.dedup();
            let places: Result<Vec<DVec2>, _> = points.iter().map(|p| drawing.place(*p)).collect();
            points.iter().zip(places?).try_for_each(|(point, at)| drawing.move_point(*point, at + by))
        }
    }
}

/// A place on the smaller arc of a radius between two places, on the pointer's side.
fn over(a: DVec2, b: DVec2, radius: f64, pointer: Option<DVec2>) -> Option<DVec2> {
    let half = 0.5 * a.distance(b);
    if radius < half || half == 0.0 {
        return None;
    }
    let rise = radius - (radius * radius - half * half).sqrt();
    let left = (b - a).perp() / (2.0 * half);
    let is_right = pointer.is_some_and(|p| (p - a).dot(left) < 0.0);
    Some(a.midpoint(b) + left * if is_right { -rise } else { rise })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_arc_of_a_typed_radius_lies_on_the_pointers_side() {
        let (a, b) = (DVec2::ZERO, DVec2::new(60.0, 0.0));
        for side in [1.0, -1.0] {
            let over = over(a, b, 50.0, Some(DVec2::new(20.0, 5.0 * side))).unwrap();
            assert!(over.distance(DVec2::new(30.0, 10.0 * side)) < 1e-9, "{over}");
        }
        assert_eq!(over(a, b, 29.0, None), None);
    }

    #[test]
    fn what_undo_took_is_made_again() {
        let empty = Drawing::default();
        let mut pen = Pen::new(Tool::Line);
        let mut draw = |drawing: &Drawing, x: f64| {
            let place = Place { pointer: DVec2::new(x, 0.0), snap: None };
            let world = World { drawing, selection: &[], reach: 2.0, grid: None, radius: 5.0 };
            pen.on(Event::Click { place, add: false }, &world)
        };
        assert_eq!(draw(&empty, 0.0), []);
        let [Effect::Draw { .. }] = &draw(&empty, 10.0)[..] else { panic!() };
        // Back to nothing, and on: the row goes on from where it was.
        let [Effect::Draw { drawing, .. }] = &draw(&empty, 30.0)[..] else { panic!() };
        assert_eq!(drawing.points().map(|(_, p)| p.x).collect::<Vec<_>>(), [10.0, 30.0]);
    }
}
