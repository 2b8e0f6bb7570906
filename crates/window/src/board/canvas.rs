//! The drawing board as a widget: events to the tool, the sheet under the hands, and what is drawn.

use eframe::egui::{self, Align2, Color32, FontId, PointerButton, Pos2, Rect, Shape as Ink, Stroke};
use glam::DVec2;
use sketch::{Curve, SnapKind};

use super::pen::{Effect, Event, Tool};
use super::world::{Part, Place};
use super::{Designer, news};
use crate::canvas::{HOVERED, ILLEGAL, LEGAL, SELECTED, named};
use crate::units::LengthUnit;

/// The pointer reaches this far, points.
const REACH: f64 = 9.0;
/// Lines of the grid are at least so far apart, points.
const GRID: f64 = 24.0;
/// Curves are drawn by chords that stay this near to them, points.
const CHORD: f64 = 0.2;
/// Points of the screen a millimetre.
const SCALES: [f64; 2] = [0.01, 400.0];

/// Which part of the plane is seen.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Sheet {
    rect: Rect,
    /// What is in the middle, mm.
    middle: DVec2,
    /// Points of the screen a millimetre.
    scale: f64,
}

impl Default for Sheet {
    fn default() -> Self {
        Self {
            rect: Rect::from_min_size(Pos2::ZERO, egui::vec2(600.0, 400.0)),
            middle: DVec2::ZERO,
            scale: 2.0,
        }
    }
}

impl Sheet {
    fn screen(&self, p: DVec2) -> Pos2 {
        let d = (p - self.middle) * self.scale;
        self.rect.center() + egui::vec2(d.x as f32, -d.y as f32)
    }

    fn mm(&self, p: Pos2) -> DVec2 {
        let d = p - self.rect.center();
        self.middle + DVec2::new(f64::from(d.x), -f64::from(d.y)) / self.scale
    }

    pub(super) fn reach(&self) -> f64 {
        REACH / self.scale
    }

    /// Spacing of the grid, mm: 1, 2 or 5 of the unit and its tenths and tens.
    pub(super) fn grid(&self, unit: LengthUnit) -> f64 {
        let least = GRID / self.scale / unit.millimetres();
        let ten = 10f64.powf(least.log10().floor());
        let steps = [1.0, 2.0, 5.0, 10.0].map(|s| s * ten);
        steps.into_iter().find(|s| *s >= least).unwrap_or(steps[3]) * unit.millimetres()
    }

    /// Shows all of some places; without any, the place where axes meet.
    pub(super) fn frame(&mut self, places: &[DVec2]) {
        let low = places.iter().copied().reduce(DVec2::min);
        let high = places.iter().copied().reduce(DVec2::max);
        let (Some(low), Some(high)) = (low, high) else {
            *self = Self { rect: self.rect, ..Self::default() };
            return;
        };
        let size = (high - low).max(DVec2::splat(20.0)) * 1.2;
        let room = self.rect.size();
        self.middle = 0.5 * (low + high);
        self.scale = (f64::from(room.x) / size.x).min(f64::from(room.y) / size.y).clamp(SCALES[0], SCALES[1]);
    }

    fn line(&self, curve: &Curve) -> Vec<Pos2> {
        self.points(curve, [0.0, 1.0])
    }

    fn points(&self, curve: &Curve, [from, to]: [f64; 2]) -> Vec<Pos2> {
        let inner = curve.parameters(CHORD / self.scale).into_iter().filter(|t| *t > from && *t < to);
        std::iter::once(from).chain(inner).chain([to]).map(|t| self.screen(curve.point(t))).collect()
    }
}

/// What the pointer snaps to, in words.
fn words(kind: SnapKind) -> &'static str {
    match kind {
        SnapKind::Point(_) => "point",
        SnapKind::Crossing(..) => "crossing",
        SnapKind::Middle(_) => "middle",
        SnapKind::Center(_) => "centre",
        SnapKind::Foot(_) => "square on it",
        SnapKind::Touch(_) => "touches",
        SnapKind::LevelOn(_) => "level, on the shape",
        SnapKind::PlumbOn(_) => "plumb, on the shape",
        SnapKind::On(_) => "on the shape",
        SnapKind::Level => "level",
        SnapKind::Plumb => "plumb",
        SnapKind::Grid => "grid",
    }
}

impl Designer {
    pub(crate) fn board_canvas(&mut self, ui: &mut egui::Ui) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, egui::Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Drawing board"));
        self.board.sheet.rect = rect;
        self.move_sheet(ui, &response);
        self.board_hands(ui, &response);
        let at = response.hover_pos().or(response.interact_pointer_pos());
        let pointer = at.map(|p| self.board.sheet.mm(p));
        self.board.pointer = pointer.map(|p| self.board.pen.place(p, &self.board_world()));
        let painter = ui.painter_at(rect);
        self.grid(ui, &painter);
        self.shapes(ui, &painter);
        self.under_way(ui, &painter);
    }

    fn move_sheet(&mut self, ui: &egui::Ui, response: &egui::Response) {
        let sheet = &mut self.board.sheet;
        if response.dragged_by(PointerButton::Middle) || response.dragged_by(PointerButton::Secondary) {
            let by = response.drag_delta();
            sheet.middle += DVec2::new(-f64::from(by.x), f64::from(by.y)) / sheet.scale;
        }
        if let Some(at) = response.hover_pos() {
            let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
            let factor = f64::from(scroll * 0.004).exp() * f64::from(pinch);
            if factor != 1.0 {
                let under = sheet.mm(at);
                sheet.scale = (sheet.scale * factor).clamp(SCALES[0], SCALES[1]);
                sheet.middle += under - sheet.mm(at);
            }
        }
    }

    fn board_hands(&mut self, ui: &egui::Ui, response: &egui::Response) {
        let add = ui.input(|i| i.modifiers.shift);
        let Some(at) = response.interact_pointer_pos() else { return };
        let place = |d: &Self, p: Pos2| d.board.pen.place(d.board.sheet.mm(p), &d.board_world());
        if response.drag_started_by(PointerButton::Primary) {
            let from = ui.input(|i| i.pointer.press_origin()).unwrap_or(at);
            let from = place(self, from);
            let is_lasso = self.board.pen.tool == Tool::Select && ui.input(|i| i.modifiers.command);
            self.board_event(if is_lasso { Event::LassoStart { from } } else { Event::DragStart { from } });
        }
        let to = place(self, at);
        if response.dragged_by(PointerButton::Primary) && response.drag_delta() != egui::Vec2::ZERO {
            self.board_event(Event::Drag { to });
        }
        if response.drag_stopped_by(PointerButton::Primary) {
            self.board_event(Event::DragEnd { to, add });
        } else if response.double_clicked() {
            // Its first click has taken the place.
            self.board_event(Event::Confirm);
        } else if response.clicked_by(PointerButton::Primary) {
            self.board_event(Event::Click { place: to, add });
        }
    }

    fn grid(&self, ui: &egui::Ui, painter: &egui::Painter) {
        let sheet = &self.board.sheet;
        let rect = sheet.rect;
        painter.rect_filled(rect, 0.0, ui.visuals().extreme_bg_color);
        let step = sheet.grid(self.preferences.unit);
        let (low, high) = (sheet.mm(rect.left_bottom()), sheet.mm(rect.right_top()));
        let weak = ui.visuals().weak_text_color();
        let tone = |k: i64| match k {
            0 => weak,
            k if k % 5 == 0 => weak.gamma_multiply(0.35),
            _ => weak.gamma_multiply(0.15),
        };
        let numbers = |low: f64, high: f64| (low / step).ceil() as i64..=(high / step).floor() as i64;
        for k in numbers(low.x, high.x) {
            let x = sheet.screen(DVec2::new(k as f64 * step, 0.0)).x;
            painter.vline(x, rect.y_range(), Stroke::new(1.0, tone(k)));
        }
        for k in numbers(low.y, high.y) {
            let y = sheet.screen(DVec2::new(0.0, k as f64 * step)).y;
            painter.hline(rect.x_range(), y, Stroke::new(1.0, tone(k)));
        }
        let text = format!("grid {}", self.preferences.unit.text(step));
        let at = rect.left_bottom() + egui::vec2(8.0, -6.0);
        painter.text(at, Align2::LEFT_BOTTOM, text, FontId::proportional(12.0), weak);
    }

    fn shapes(&self, ui: &egui::Ui, painter: &egui::Painter) {
        let board = &self.board;
        let drawing = &self.session.draft().drawing;
        let sheet = &board.sheet;
        let ink = ui.visuals().text_color();
        let hovered = board.pointer.and_then(|p| self.board_world().pick(p.pointer));
        let color = |part: Part| {
            if board.selection.contains(&part) {
                Some(SELECTED)
            } else {
                (hovered == Some(part)).then_some(HOVERED)
            }
        };
        for (id, _) in drawing.shapes() {
            let Ok(curve) = drawing.curve(id) else { continue };
            let part = Part::Shape(id);
            let stroke = color(part).map_or(Stroke::new(1.5, ink), |c| Stroke::new(3.0, c));
            painter.add(Ink::line(sheet.line(&curve), stroke));
            named(ui, sheet.screen(curve.point(0.5)), &part.label(drawing));
        }
        for (part, at) in self.board_world().handles() {
            let (Part::Handle(shape, end), to) = (part, sheet.screen(at)) else { continue };
            if let Ok(curve) = drawing.curve(shape) {
                let from = sheet.screen(if end == 0 { curve.start() } else { curve.end() });
                painter.line_segment([from, to], Stroke::new(1.0, ink.gamma_multiply(0.6)));
            }
            painter.rect_filled(
                Rect::from_center_size(to, egui::vec2(7.0, 7.0)),
                0.0,
                color(part).unwrap_or(LEGAL),
            );
            named(ui, to, &part.label(drawing));
        }
        for (id, at) in drawing.points() {
            let (part, at) = (Part::Point(id), sheet.screen(at));
            let fill = color(part).unwrap_or(ink);
            if drawing.is_smooth(id).unwrap_or(false) {
                painter.circle_stroke(at, 6.0, Stroke::new(1.0, fill));
            }
            painter.circle_filled(at, if color(part).is_some() { 5.0 } else { 3.5 }, fill);
            named(ui, at, &part.label(drawing));
        }
    }

    /// What the next click makes, and what the pointer snaps to.
    fn under_way(&self, ui: &egui::Ui, painter: &egui::Painter) {
        let board = &self.board;
        let sheet = &board.sheet;
        let pen = &board.pen;
        if let Some(region) = pen.region() {
            let border = region.border().into_iter().map(|p| sheet.screen(p)).collect();
            painter.add(Ink::line(border, Stroke::new(1.0, LEGAL)));
        }
        if let Some(handles) = pen.pulled() {
            painter.add(Ink::line(handles.map(|p| sheet.screen(p)).to_vec(), Stroke::new(1.0, LEGAL)));
        }
        let Some(place) = board.pointer else {
            for at in pen.trail(None) {
                painter.circle_stroke(sheet.screen(at), 5.0, Stroke::new(1.5, LEGAL));
            }
            return;
        };
        let to = pen.pulled().map_or(place.at(), |[_, at, _]| at);
        let trail: Vec<Pos2> = pen.trail(Some(to)).into_iter().map(|p| sheet.screen(p)).collect();
        painter.add(Ink::line(trail, Stroke::new(1.0, LEGAL.gamma_multiply(0.6))));
        self.next_click(painter, place);
        let at = sheet.screen(place.at());
        let mut texts = Vec::new();
        if let Some(snap) = place.snap {
            let arm = 7.0;
            painter.add(Ink::closed_line(
                [(0.0, -arm), (arm, 0.0), (0.0, arm), (-arm, 0.0)]
                    .map(|(x, y)| at + egui::vec2(x, y))
                    .to_vec(),
                Stroke::new(1.5, LEGAL),
            ));
            named(ui, at, &format!("snaps to {}", words(snap.kind)));
            texts.push(words(snap.kind).to_owned());
        }
        if let Some(from) = pen.from().filter(|_| pen.pulled().is_none()) {
            let step = place.at() - from;
            let length = self.preferences.unit.text(step.length());
            texts.push(format!("{length} @ {:.1}°", step.to_angle().to_degrees()));
        }
        if !texts.is_empty() {
            let galley = painter.layout_no_wrap(texts.join("; "), FontId::proportional(13.0), Color32::WHITE);
            // Left of the pointer where there is no room at its right.
            let room = sheet.rect.right() - at.x - 20.0;
            let left = if galley.size().x > room { -14.0 - galley.size().x } else { 14.0 };
            let back = Rect::from_min_size(at + egui::vec2(left, -26.0), galley.size()).expand(3.0);
            painter.rect_filled(back, 3.0, Color32::from_black_alpha(170));
            painter.galley(back.min + egui::vec2(3.0, 3.0), galley, Color32::WHITE);
        }
    }

    /// A click is tried on a copy: what it would change is shown, red where it would be refused.
    fn next_click(&self, painter: &egui::Painter, place: Place) {
        let world = self.board_world();
        let sheet = &self.board.sheet;
        let tool = self.board.pen.tool;
        if matches!(tool, Tool::Select | Tool::Bend) {
            return;
        }
        if tool == Tool::Trim
            && let Some(shape) = world.shape(place.pointer)
            && let (Ok(curve), Ok(part)) =
                (world.drawing.curve(shape), world.drawing.part(shape, place.pointer))
        {
            painter.add(Ink::line(sheet.points(&curve, part), Stroke::new(4.0, ILLEGAL)));
            return;
        }
        let mut tried = self.board.pen.clone();
        let event = match tried.pulled() {
            Some(_) => Event::DragEnd { to: place, add: false },
            None => Event::Click { place, add: false },
        };
        for effect in tried.on(event, &world) {
            if let Effect::Draw { drawing, .. } = effect {
                for curve in news(world.drawing, &drawing) {
                    painter.add(Ink::line(sheet.line(&curve), Stroke::new(2.0, LEGAL)));
                }
            } else if matches!(effect, Effect::Problem(_)) && !matches!(tool, Tool::Extend | Tool::Split) {
                painter.circle_stroke(sheet.screen(place.at()), 9.0, Stroke::new(1.5, ILLEGAL));
            }
        }
    }
}
