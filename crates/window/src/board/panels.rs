//! What stands about the drawing board: its parts by name, numbers, rules, and what is typed.

use std::sync::Arc;

use design::draft::Edit;
use eframe::egui;
use glam::DVec2;
use sketch::{Drawing, DrawingError, Path, Rule, Shape, ShapeId};

use super::pen::{Event, Tool};
use super::typed::Typed;
use super::world::Part;
use super::{Designer, Wish};
use crate::panels::section;
use crate::units::LengthUnit;

/// A length that is dragged or typed, in the unit that is shown; typed values may name another.
fn length(value: &mut f64, unit: LengthUnit) -> egui::DragValue<'_> {
    egui::DragValue::new(value)
        .speed(0.2 * unit.millimetres())
        .custom_formatter(move |mm, _| unit.text(mm))
        .custom_parser(move |text| unit.parse(text))
}

impl Designer {
    pub(crate) fn board_panels(&mut self, ui: &mut egui::Ui) {
        egui::Panel::left("parts")
            .default_size(150.0)
            .show(ui, |ui| egui::ScrollArea::vertical().show(ui, |ui| self.parts(ui)));
        egui::Panel::right("rules").default_size(230.0).show(ui, |ui| {
            egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                self.type_field(ui);
                ui.separator();
                self.part_numbers(ui);
                self.rules(ui);
            });
        });
    }

    /// All parts by name: also the way to them for the keyboard.
    fn parts(&mut self, ui: &mut egui::Ui) {
        let draft = Arc::clone(self.session.draft());
        let drawing = &draft.drawing;
        let mut chosen = None;
        let mut list = |ui: &mut egui::Ui, part: Part| {
            let is_on = self.board.selection.contains(&part);
            if ui.selectable_label(is_on, part.label(drawing)).clicked() {
                chosen = Some(part);
            }
        };
        section(ui, "Shapes", drawing.shapes().count(), |ui| {
            drawing.shapes().for_each(|(id, _)| list(ui, Part::Shape(id)));
        });
        section(ui, "Points", drawing.points().count(), |ui| {
            drawing.points().for_each(|(id, _)| list(ui, Part::Point(id)));
        });
        if let Some(part) = chosen {
            if ui.input(|i| i.modifiers.shift) {
                self.toggle_part(part);
            } else {
                self.board.selection = vec![part];
            }
        }
        if drawing.shapes().count() == 0 {
            ui.weak("nothing is drawn yet");
            return;
        }
        ui.separator();
        let outlines = drawing.outlines().unwrap_or_default();
        let closed = outlines.iter().filter(|o| Path::of(o).is_ok_and(|p| p.closed)).count();
        ui.weak(format!("{closed} closed outlines, {} open", outlines.len() - closed));
    }

    /// Numbers for the tool. A digit on the board begins one.
    fn type_field(&mut self, ui: &mut egui::Ui) {
        let label = ui.label("Length or place");
        let hint = "12 in · 40 @ 30 · 40; 20";
        let field = egui::TextEdit::singleline(&mut self.board.typed).hint_text(hint);
        let field = ui.add(field.desired_width(f32::INFINITY)).labelled_by(label.id);
        let entered = field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Enter));
        if entered {
            self.enter_number();
        }
        if std::mem::take(&mut self.board.takes_keyboard) {
            field.request_focus();
            // What is typed next goes behind it.
            let mut state = egui::text_edit::TextEditState::load(ui.ctx(), field.id).unwrap_or_default();
            let end = egui::text::CCursor::new(self.board.typed.chars().count());
            state.cursor.set_char_range(Some(egui::text::CCursorRange::one(end)));
            state.store(ui.ctx(), field.id);
        }
        if self.board.pen.tool == Tool::Round {
            ui.horizontal(|ui| {
                let label = ui.label("Radius");
                let value = length(&mut self.board.radius, self.preferences.unit).range(0.1..=10_000.0);
                ui.add(value).labelled_by(label.id);
            });
        }
    }

    /// Gives the tool the number that was typed.
    fn enter_number(&mut self) {
        let text = std::mem::take(&mut self.board.typed);
        if text.trim().is_empty() {
            return;
        }
        let pointer = self.board.pointer.map(|p| p.at());
        match Typed::parse(&text, self.preferences.unit) {
            Some(typed) => self.board_event(Event::Typed { typed, pointer }),
            None => {
                self.problem(format!("{text} is no length (12 in), direction (40 @ 30) or place (40; 20)"))
            }
        }
    }

    /// A digit that is typed while no field has the keyboard begins a number; whether one began. All that a fast hand typed in
    /// one frame belongs to it, its Enter too.
    pub(crate) fn begin_number(&mut self, context: &egui::Context) -> bool {
        if context.memory(|m| m.focused().is_some()) {
            return false;
        }
        let typed: String = context.input(|i| {
            let texts = i.events.iter().filter_map(|e| match e {
                egui::Event::Text(text) => Some(text.as_str()),
                _ => None,
            });
            texts.collect()
        });
        if !typed.starts_with(|c: char| c.is_ascii_digit() || c == '-') {
            return false;
        }
        self.board.typed = typed;
        if context.input_mut(|i| i.consume_key(egui::Modifiers::NONE, egui::Key::Enter)) {
            self.enter_number();
        } else {
            self.board.takes_keyboard = true;
        }
        true
    }

    /// What a field changes of the drawing.
    fn drawn_by(
        &mut self,
        response: &egui::Response,
        label: &str,
        edit: impl FnOnce(&mut Drawing) -> Result<(), DrawingError>,
    ) {
        if response.changed() {
            let mut drawing = self.session.draft().drawing.clone();
            match edit(&mut drawing) {
                Ok(()) => self.changed(response, Edit::Draw { label: label.to_owned(), drawing }),
                Err(e) => self.problem(e.to_string()),
            }
        } else if response.drag_stopped() {
            self.settle();
        }
    }

    fn part_numbers(&mut self, ui: &mut egui::Ui) {
        let draft = Arc::clone(self.session.draft());
        let drawing = &draft.drawing;
        let unit = self.preferences.unit;
        let [part] = self.board.selection[..] else {
            if !self.board.selection.is_empty() {
                ui.strong(format!("{} selected", self.board.selection.len()));
            }
            return;
        };
        ui.strong(part.label(drawing));
        match part {
            Part::Point(point) => {
                let Ok(at) = drawing.place(point) else { return };
                let mut new = at;
                let moved = |ui: &mut egui::Ui, name: &str, value: &mut f64| {
                    ui.horizontal(|ui| {
                        let label = ui.label(name);
                        ui.add(length(value, unit)).labelled_by(label.id)
                    })
                    .inner
                };
                let across = moved(ui, "across", &mut new.x);
                let up = moved(ui, "up", &mut new.y);
                let response = if up.changed() || up.drag_stopped() { up } else { across };
                self.drawn_by(&response, "move", |d| d.move_point(point, new));
            }
            Part::Shape(shape) => {
                let Ok(curve) = drawing.curve(shape) else { return };
                let long = curve.length();
                if !matches!(drawing.shape(shape), Ok(Shape::Line(_))) {
                    ui.label(format!("{} long", unit.text(long)));
                    if let sketch::Curve::Arc { radius, .. } = curve {
                        ui.label(format!("radius {}", unit.text(radius)));
                    }
                    return;
                }
                let mut new = long;
                let response = ui
                    .horizontal(|ui| {
                        let label = ui.label("length");
                        ui.add(length(&mut new, unit).range(0.001..=f64::MAX)).labelled_by(label.id)
                    })
                    .inner;
                self.drawn_by(&response, "set length", |d| set_length(d, shape, new));
                let step: DVec2 = curve.end() - curve.start();
                ui.weak(format!("{:.1}° from level", step.to_angle().to_degrees()));
            }
            Part::Handle(..) => {}
        }
    }

    /// Rules to be set, and those that hold: of the selection, or all.
    fn rules(&mut self, ui: &mut egui::Ui) {
        if !self.board.selection.is_empty() {
            let mut wish = None;
            ui.horizontal_wrapped(|ui| {
                for (what, name, hint) in Wish::ALL {
                    if what.fits(&self.session.draft().drawing, &self.board.selection)
                        && ui.button(name).on_hover_text(hint).clicked()
                    {
                        wish = Some(what);
                    }
                }
            });
            if let Some(wish) = wish {
                self.grant(wish);
            }
        }
        let draft = Arc::clone(self.session.draft());
        let drawing = &draft.drawing;
        let of_selection = |rule: &Rule| {
            let shapes = rule.shapes().into_iter().map(Part::Shape);
            let mut parts = shapes.chain(rule.points().into_iter().map(Part::Point));
            self.board.selection.is_empty() || parts.any(|p| self.board.selection.contains(&p))
        };
        let shown: Vec<(usize, &Rule)> =
            drawing.rules().iter().enumerate().filter(|(_, r)| of_selection(r)).collect();
        if shown.is_empty() {
            return;
        }
        ui.separator();
        ui.strong("Rules");
        let mut gone = None;
        for (k, rule) in shown {
            let text = rule_words(rule, drawing, self.preferences.unit);
            ui.horizontal(|ui| {
                let delete = format!("Delete rule {text}");
                let button = ui.small_button("×").on_hover_text(&delete);
                button.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, true, &delete));
                if button.clicked() {
                    gone = Some(k);
                }
                ui.label(text);
            });
        }
        if let Some(k) = gone {
            let mut drawing = drawing.clone();
            drawing.delete_rule(k);
            self.edit(Edit::Draw { label: "delete rule".to_owned(), drawing });
        }
    }
}

/// A line gets a length that stays: its rule, new or instead of the one that it has.
fn set_length(drawing: &mut Drawing, line: ShapeId, long: f64) -> Result<(), DrawingError> {
    let old = drawing.rules().iter().position(|r| matches!(r, Rule::Length(id, _) if *id == line));
    if let Some(old) = old {
        drawing.delete_rule(old);
    }
    drawing.add_rule(Rule::Length(line, long))
}

fn rule_words(rule: &Rule, drawing: &Drawing, unit: LengthUnit) -> String {
    let name = |id: ShapeId| Part::Shape(id).label(drawing);
    match *rule {
        Rule::Level(a) => format!("{} is level", name(a)),
        Rule::Plumb(a) => format!("{} is plumb", name(a)),
        Rule::Length(a, long) => format!("{} is {} long", name(a), unit.text(long)),
        Rule::Parallel(a, b) => format!("{} and {} are parallel", name(a), name(b)),
        Rule::Square(a, b) => format!("{} and {} are square", name(a), name(b)),
        Rule::Equal(a, b) => format!("{} and {} are equal", name(a), name(b)),
        Rule::Fixed(point, _) => format!("{} is fixed", Part::Point(point).label(drawing)),
    }
}
