//! The drawing board: the design's drawing in the plane, for outlines of sheets, walls and wires.

mod canvas;
mod panels;
pub(crate) mod pen;
mod typed;
mod world;

use std::path::Path;

use design::draft::Edit;
use design::drawings::{self, Making};
use eframe::egui;
use glam::DVec2;
use mesh_kernel::files::write_atomically;
use sketch::{Curve, Drawing, PointId, Rule, Shape, ShapeId};

use crate::designer::Designer;
use canvas::Sheet;
use pen::{Effect, Event, Pen, Tool};
use world::{Part, Place, World};

/// The board's state; the drawing itself is a part of the draft.
pub(crate) struct Board {
    pub(crate) pen: Pen,
    pub(crate) selection: Vec<Part>,
    /// Whether places snap to the grid that is shown.
    pub(crate) snaps_to_grid: bool,
    /// Corners are rounded by this, mm.
    radius: f64,
    /// What is being typed.
    typed: String,
    /// A number was begun on the board: its field wants the keyboard.
    takes_keyboard: bool,
    sheet: Sheet,
    /// Where the pointer is, mm, and what it means.
    pointer: Option<Place>,
}

impl Default for Board {
    fn default() -> Self {
        Self {
            pen: Pen::new(Tool::Select),
            selection: Vec::new(),
            snaps_to_grid: true,
            radius: 10.0,
            typed: String::new(),
            takes_keyboard: false,
            sheet: Sheet::default(),
            pointer: None,
        }
    }
}

impl Board {
    /// The place that the pointer means, mm.
    pub(crate) fn pointer_at(&self) -> Option<DVec2> {
        self.pointer.map(|place| place.at())
    }
}

/// What can be done to selected parts.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Wish {
    Level,
    Plumb,
    Length,
    Parallel,
    Square,
    Equal,
    Fixed,
    Smooth,
    Corner,
    Join,
}

impl Wish {
    pub(crate) const ALL: [(Self, &'static str, &'static str); 10] = [
        (Self::Level, "Level", "The selected lines stay level"),
        (Self::Plumb, "Plumb", "The selected lines stay plumb"),
        (Self::Length, "Keep the length", "The selected lines stay as long as they are"),
        (Self::Parallel, "Parallel", "The selected lines stay parallel"),
        (Self::Square, "Square", "Two selected lines stay square on each other"),
        (Self::Equal, "Equal", "The selected lines stay as long as each other"),
        (Self::Fixed, "Fixed", "The selected points stay where they are"),
        (Self::Smooth, "Smooth point", "Two shapes meet in one direction at the selected points"),
        (Self::Corner, "Corner", "Shapes meet as they like at the selected points"),
        (Self::Join, "Join points", "Two selected points become one, in the place of the first"),
    ];

    /// Whether so many lines and points are selected as it needs.
    fn fits(self, drawing: &Drawing, selection: &[Part]) -> bool {
        let lines = selection.iter().filter(|p| line(drawing, **p).is_some()).count();
        let points = selection.iter().filter(|p| matches!(p, Part::Point(_))).count();
        match self {
            Self::Level | Self::Plumb | Self::Length => lines > 0,
            Self::Parallel | Self::Equal => lines > 1,
            Self::Square => lines == 2,
            Self::Fixed | Self::Smooth | Self::Corner => points > 0,
            Self::Join => points == 2,
        }
    }

    /// The drawing with the wish granted, or why it is not.
    fn granted(self, drawing: &Drawing, selection: &[Part]) -> Result<Drawing, String> {
        let mut new = drawing.clone();
        let lines: Vec<ShapeId> = selection.iter().filter_map(|p| line(drawing, *p)).collect();
        let points: Vec<PointId> = selection
            .iter()
            .filter_map(|p| match p {
                Part::Point(point) => Some(*point),
                _ => None,
            })
            .collect();
        let of_line = |id: ShapeId| -> Option<Rule> {
            Some(match self {
                Self::Level => Rule::Level(id),
                Self::Plumb => Rule::Plumb(id),
                Self::Length => Rule::Length(id, drawing.curve(id).ok()?.length()),
                _ => return None,
            })
        };
        let of_pair = |a: ShapeId, b: ShapeId| -> Option<Rule> {
            Some(match self {
                Self::Parallel => Rule::Parallel(a, b),
                Self::Square => Rule::Square(a, b),
                Self::Equal => Rule::Equal(a, b),
                _ => return None,
            })
        };
        let rules: Vec<Rule> = match self {
            Self::Level | Self::Plumb | Self::Length => lines.iter().filter_map(|l| of_line(*l)).collect(),
            Self::Square if lines.len() != 2 => return Err("select two lines first".to_owned()),
            Self::Parallel | Self::Square | Self::Equal => {
                lines.windows(2).filter_map(|w| of_pair(w[0], w[1])).collect()
            }
            Self::Fixed => {
                points.iter().filter_map(|p| Some(Rule::Fixed(*p, drawing.place(*p).ok()?))).collect()
            }
            Self::Smooth | Self::Corner => {
                if points.is_empty() {
                    return Err("select a point first".to_owned());
                }
                let is_smooth = self == Self::Smooth;
                points.iter().try_for_each(|p| new.set_smooth(*p, is_smooth)).map_err(|e| e.to_string())?;
                return Ok(new);
            }
            Self::Join => {
                let [keep, gone] = points[..] else { return Err("select two points first".to_owned()) };
                new.merge(keep, gone).map_err(|e| e.to_string())?;
                return Ok(new);
            }
        };
        if rules.is_empty() {
            let what = match self {
                Self::Fixed => "a point",
                Self::Level | Self::Plumb | Self::Length => "a line",
                _ => "two lines",
            };
            return Err(format!("select {what} first"));
        }
        let known = new.rules().to_vec();
        let news = rules.into_iter().filter(|rule| !known.contains(rule));
        news.into_iter().try_for_each(|rule| new.add_rule(rule)).map_err(|e| e.to_string())?;
        Ok(new)
    }
}

/// The line that a part is.
fn line(drawing: &Drawing, part: Part) -> Option<ShapeId> {
    match part {
        Part::Shape(id) if matches!(drawing.shape(id), Ok(Shape::Line(_))) => Some(id),
        _ => None,
    }
}

/// Curves of a drawing that another one has not.
fn news(before: &Drawing, after: &Drawing) -> Vec<Curve> {
    let is_new = |(id, _): &(ShapeId, &Shape)| before.curve(*id).ok() != after.curve(*id).ok();
    after.shapes().filter(is_new).filter_map(|(id, _)| after.curve(id).ok()).collect()
}

impl Designer {
    pub(crate) fn board_world(&self) -> World<'_> {
        let board = &self.board;
        World {
            drawing: &self.session.draft().drawing,
            selection: &board.selection,
            reach: board.sheet.reach(),
            grid: board.snaps_to_grid.then(|| board.sheet.grid(self.preferences.unit)),
            radius: board.radius,
        }
    }

    pub(crate) fn take_pen(&mut self, tool: Tool) {
        self.board.pen = Pen::new(tool);
        self.notices.forget_problems();
    }

    /// Gives the tool an event, and does what it answers.
    pub(crate) fn board_event(&mut self, event: Event) {
        let mut pen = self.board.pen.clone();
        let effects = pen.on(event, &self.board_world());
        self.board.pen = pen;
        let gesture = egui::Id::unique("drawing board drag");
        for effect in effects {
            match effect {
                Effect::Draw { label, drawing } => self.edit(Edit::Draw { label, drawing }),
                Effect::Live { label, drawing } => self.live(gesture, Edit::Draw { label, drawing }),
                Effect::Settle => self.settle(),
                Effect::Select(parts) => self.board.selection = parts,
                Effect::Toggle(parts) => {
                    for part in parts {
                        self.toggle_part(part);
                    }
                }
                Effect::Radius(radius) => {
                    self.board.radius = radius;
                    self.notices
                        .say(format!("corners are rounded by {}", self.preferences.unit.text(radius)));
                }
                Effect::Problem(text) => self.problem(text),
            }
        }
    }

    fn toggle_part(&mut self, part: Part) {
        let selection = &mut self.board.selection;
        match selection.iter().position(|p| *p == part) {
            Some(k) => drop(selection.remove(k)),
            None => selection.push(part),
        }
    }

    /// The drawing may have changed: what is selected of it may be gone.
    pub(crate) fn follow_drawing(&mut self) {
        let draft = self.session.draft();
        self.board.selection.retain(|part| part.is_in(&draft.drawing));
    }

    pub(crate) fn grant(&mut self, wish: Wish) {
        let name = Wish::ALL.iter().find(|(w, ..)| *w == wish).map_or("", |(_, name, _)| name);
        match wish.granted(&self.session.draft().drawing, &self.board.selection) {
            Ok(drawing) => self.edit(Edit::Draw { label: name.to_lowercase(), drawing }),
            Err(e) => self.problem(e),
        }
    }

    pub(crate) fn delete_parts(&mut self) {
        let mut drawing = self.session.draft().drawing.clone();
        let parts = std::mem::take(&mut self.board.selection);
        if parts.is_empty() {
            return self.problem("nothing is selected");
        }
        for part in &parts {
            // What went with a part before it is gone already.
            let _ = match part {
                Part::Point(point) => drawing.delete_point(*point),
                Part::Shape(shape) => drawing.delete_shape(*shape),
                Part::Handle(..) => Ok(()),
            };
        }
        self.edit(Edit::Draw { label: "delete".to_owned(), drawing });
    }

    pub(crate) fn select_parts(&mut self) {
        let drawing = &self.session.draft().drawing;
        let shapes = drawing.shapes().map(|(id, _)| Part::Shape(id));
        self.board.selection = shapes.chain(drawing.points().map(|(id, _)| Part::Point(id))).collect();
    }

    /// Takes the drawing of a script.
    pub(crate) fn open_drawing(&mut self, path: &Path) {
        let read = std::fs::read_to_string(path).map_err(|e| e.to_string());
        match read.and_then(|text| drawings::of_script(&text).map_err(|e| e.to_string())) {
            Ok((drawing, left_out)) => {
                self.edit(Edit::Draw { label: format!("open {}", path.display()), drawing });
                let left_out = left_out.map_or_else(String::new, |l| format!("; without {l}"));
                self.notices.say(format!("the drawing of {} is on the board{left_out}", path.display()));
                self.show_drawing();
            }
            Err(e) => self.problem(format!("{} was not opened: {e}", path.display())),
        }
    }

    /// Writes a script that makes something of the drawing.
    pub(crate) fn write_script(&mut self, making: Making, path: &Path) {
        let made = drawings::to_script(&self.session.draft().drawing, making).map_err(|e| e.to_string());
        let written = made.and_then(|(text, left_out)| {
            write_atomically(path, text.as_bytes()).map_err(|e| e.to_string())?;
            Ok(left_out)
        });
        match written {
            Ok(left_out) => {
                let left_out = left_out.map_or_else(String::new, |l| format!("; without {l}"));
                self.notices.say(format!("script written to {}{left_out}", path.display()));
            }
            Err(e) => self.problem(format!("no script was written: {e}")),
        }
    }

    /// Moves the sheet so that everything is seen.
    pub(crate) fn show_drawing(&mut self) {
        let drawing = &self.session.draft().drawing;
        let curves = drawing.shapes().filter_map(|(id, _)| drawing.curve(id).ok());
        let along = curves.flat_map(|c| (0..=16).map(move |k| c.point(f64::from(k) / 16.0)));
        let places: Vec<DVec2> = drawing.points().map(|(_, p)| p).chain(along).collect();
        self.board.sheet.frame(&places);
    }
}
