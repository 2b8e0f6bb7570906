//! The 3D view as a widget: events to the tool, the eye under the hands, and what is lit up.

use eframe::egui::{self, Align2, Color32, FontId, PointerButton, Pos2, Rect, Shape, Stroke};
use glam::{DVec2, DVec3};

use crate::designer::Designer;
use crate::region::Region;
use crate::selection::Element;
use crate::tools::{Event, Ghost, GhostShape, Tool};

pub(crate) const SELECTED: Color32 = Color32::from_rgb(245, 150, 20);
pub(crate) const HOVERED: Color32 = Color32::from_rgb(255, 205, 90);
pub(crate) const LEGAL: Color32 = Color32::from_rgb(40, 150, 240);
pub(crate) const ILLEGAL: Color32 = Color32::from_rgb(220, 50, 50);

impl Designer {
    pub(crate) fn canvas(&mut self, ui: &mut egui::Ui) {
        let rect = ui.available_rect_before_wrap();
        let response = ui.allocate_rect(rect, egui::Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "3D view"));
        self.turn(ui, &response);
        if let Some(problem) = self.view.paint(ui, rect) {
            self.problem(format!("OpenGL cannot draw the view, the processor does: {problem}"));
        }
        let pixel_scale = f64::from(ui.ctx().zoom_factor());
        self.events(ui, &response, pixel_scale);
        let pointer = response.hover_pos().filter(|_| !response.dragged_by(PointerButton::Secondary));
        let pointer = pointer.or(response.interact_pointer_pos()).map(|p| self.view.local(p));
        // While the eye turns nothing else is asked: every frame counts.
        let is_turning = self.pivot.is_some();
        if let Some(at) = pointer.filter(|_| response.hovered() && !is_turning) {
            self.hovered = self.machine.target(at, &self.world(pixel_scale));
        }
        let painter = ui.painter_at(rect);
        self.lit(&painter);
        if self.tool == Tool::Node {
            self.crosses(ui, &painter);
        }
        for ghost in self.machine.ghosts(pointer, &self.world(pixel_scale)) {
            self.ghost(&painter, &ghost);
        }
        self.legend(ui, &painter, rect);
        if !is_turning {
            self.name_elements(ui, rect);
        }
    }

    /// Turns, moves and zooms.
    fn turn(&mut self, ui: &egui::Ui, response: &egui::Response) {
        let is_eye = |b: PointerButton| response.dragged_by(b) || response.drag_started_by(b);
        if is_eye(PointerButton::Middle) || is_eye(PointerButton::Secondary) {
            let by = response.drag_delta();
            if ui.input(|i| i.modifiers.shift) {
                self.view.eye.pan(by);
            } else {
                let at = ui.input(|i| i.pointer.press_origin()).or(response.interact_pointer_pos());
                let pivot = self.pivot.or_else(|| at.map(|p| self.view.pivot(self.view.local(p))));
                if let Some(pivot) = pivot {
                    self.pivot = Some(pivot);
                    self.view.eye.orbit(by, pivot);
                }
            }
        } else {
            self.pivot = None;
        }
        if let Some(at) = response.hover_pos() {
            let (scroll, pinch) = ui.input(|i| (i.smooth_scroll_delta().y, i.zoom_delta()));
            let factor = f64::from(scroll * 0.004).exp() * f64::from(pinch);
            if factor != 1.0 {
                let local = self.view.local(at);
                self.view.eye.zoom(factor, local);
            }
        }
    }

    fn events(&mut self, ui: &egui::Ui, response: &egui::Response, pixel_scale: f64) {
        let add = ui.input(|i| i.modifiers.shift);
        let Some(at) = response.interact_pointer_pos() else { return };
        let to = self.view.local(at);
        if response.drag_started_by(PointerButton::Primary) {
            // A drag is known by its first movement; what it takes lay where it began.
            let from = ui.input(|i| i.pointer.press_origin()).unwrap_or(at);
            let from = self.view.local(from);
            let is_lasso = self.tool == Tool::Select && ui.input(|i| i.modifiers.command);
            let start = if is_lasso { Event::LassoStart { from } } else { Event::DragStart { from } };
            self.tool_event_at(start, pixel_scale);
        }
        if response.dragged_by(PointerButton::Primary) && (response.drag_delta() != egui::Vec2::ZERO) {
            self.tool_event_at(Event::Drag { to }, pixel_scale);
        }
        if response.drag_stopped_by(PointerButton::Primary) {
            self.tool_event_at(Event::DragEnd { to, add }, pixel_scale);
        } else if response.clicked_by(PointerButton::Primary) {
            self.tool_event_at(Event::Click { at: to, add }, pixel_scale);
        }
    }

    fn on_screen(&self, places: &[DVec3]) -> Vec<Pos2> {
        places.iter().filter_map(|p| self.view.screen(*p)).collect()
    }

    /// What is selected and what is under the pointer.
    fn lit(&self, painter: &egui::Painter) {
        let draft = self.session.draft();
        let show = |element: &Element, color: Color32, width: f32| {
            let at = self.on_screen(&element.places(draft, &self.model.places));
            match element {
                Element::Node(_) => {
                    for p in at {
                        painter.circle(p, width + 2.5, color.gamma_multiply(0.4), Stroke::new(2.0, color));
                    }
                }
                Element::Face { .. } => {
                    area(painter, at, color);
                    if draft.template.mirrored {
                        let twin = element.places(draft, &self.model.places);
                        let twin: Vec<DVec3> = twin.iter().map(|p| *p * DVec3::new(-1.0, 1.0, 1.0)).collect();
                        area(painter, self.on_screen(&twin), color.gamma_multiply(0.5));
                    }
                }
                Element::Edge(_) | Element::Joint(_) => {
                    painter.add(Shape::line(at, Stroke::new(width, color)));
                }
            }
        };
        for element in &self.session.selection.elements {
            show(element, SELECTED, 4.0);
        }
        for name in self.machine.collected() {
            show(&Element::Node(name.clone()), SELECTED, 4.0);
        }
        if let Some(element) = &self.hovered {
            show(element, HOVERED, 3.0);
        }
        let cloth = self.model.cloth.as_ref().and_then(|c| c.made.as_ref());
        if let (Some(seam), Some(made)) = (self.hovered_seam, cloth)
            && let Some(side) = made.garment.seams.get(seam).and_then(|s| s.sides.first())
        {
            let positions = made.garment.body.surface(made.garment.surfaces[side.surface].id).positions();
            let points: Vec<DVec3> = side.nodes.iter().map(|n| positions[*n as usize]).collect();
            painter.add(Shape::line(self.on_screen(&points), Stroke::new(4.0, HOVERED)));
        }
    }

    /// Feature points that can be seen, with names for those who cannot see.
    fn crosses(&self, ui: &egui::Ui, painter: &egui::Painter) {
        let picker = self.picker();
        for anchor in &self.model.anchors {
            let Some(at) = self.view.screen(anchor.place) else { continue };
            if !self.view.rect.contains(at) || !picker.sees_node(anchor.place) {
                continue;
            }
            for arm in [egui::vec2(4.0, 4.0), egui::vec2(4.0, -4.0)] {
                painter.line_segment([at - arm, at + arm], Stroke::new(1.5, LEGAL));
            }
            named(ui, at, &format!("feature point {}", anchor.name));
        }
    }

    fn ghost(&self, painter: &egui::Painter, ghost: &Ghost) {
        let color = if ghost.is_legal { LEGAL } else { ILLEGAL };
        let pixel = |at: &DVec2| self.view.on_screen(*at);
        match &ghost.shape {
            GhostShape::Line(places) => {
                painter.add(Shape::line(self.on_screen(places), Stroke::new(3.0, color)));
            }
            GhostShape::Thin(places) => {
                painter.add(Shape::line(self.on_screen(places), Stroke::new(1.5, color)));
            }
            GhostShape::Area(places) => area(painter, self.on_screen(places), color),
            GhostShape::Point(place) => {
                for p in self.on_screen(&[*place]) {
                    painter.circle(p, 5.0, color.gamma_multiply(0.4), Stroke::new(1.5, color));
                }
            }
            GhostShape::Ink(points) => {
                painter.add(Shape::line(points.iter().map(pixel).collect(), Stroke::new(2.0, color)));
            }
            GhostShape::Region(region) => {
                let border: Vec<Pos2> = region.border().iter().map(pixel).collect();
                // Fills of lassos would need their triangles.
                if let Region::Box(from, to) = region {
                    let rect = Rect::from_two_pos(pixel(from), pixel(to));
                    painter.rect_filled(rect, 0.0, color.gamma_multiply(0.15));
                }
                painter.add(Shape::line(border, Stroke::new(1.0, color)));
            }
            GhostShape::Text(at, text) => {
                let at = pixel(at) + egui::vec2(14.0, -14.0);
                let galley = painter.layout_no_wrap(text.clone(), FontId::proportional(13.0), Color32::WHITE);
                let back = Rect::from_min_size(at, galley.size()).expand(3.0);
                painter.rect_filled(back, 3.0, Color32::from_black_alpha(170));
                painter.galley(at, galley, Color32::WHITE);
            }
        }
    }

    /// What colours mean, where they mean numbers.
    fn legend(&self, ui: &egui::Ui, painter: &egui::Painter, rect: Rect) {
        let Some((scale, unit)) = self.look.colouring.scale() else { return };
        let bar = Rect::from_min_size(rect.left_bottom() + egui::vec2(16.0, -46.0), egui::vec2(180.0, 12.0));
        for k in 0..60 {
            let t = (f64::from(k) + 0.5) / 60.0;
            let [r, g, b] = scale.color(scale.low + t * (scale.high - scale.low)).0;
            let x = bar.left() + bar.width() * k as f32 / 60.0;
            let cell =
                Rect::from_min_size(egui::pos2(x, bar.top()), egui::vec2(bar.width() / 60.0 + 0.5, 12.0));
            painter.rect_filled(cell, 0.0, Color32::from_rgb(r, g, b));
        }
        let color = ui.visuals().text_color();
        for (at, value) in [(bar.left_bottom(), scale.low), (bar.right_bottom(), scale.high)] {
            let text = format!("{value:.0} {unit}");
            painter.text(
                at + egui::vec2(0.0, 3.0),
                Align2::CENTER_TOP,
                text,
                FontId::proportional(12.0),
                color,
            );
        }
    }

    /// A small named rectangle for every node, edge and joint that can be seen: for screen readers, and for tests.
    fn name_elements(&self, ui: &egui::Ui, rect: Rect) {
        if !self.look.template {
            return;
        }
        let picker = self.picker();
        let draft = self.session.draft();
        for (name, place) in &self.model.places {
            if let Some(at) = self.view.screen(*place).filter(|at| rect.contains(*at))
                && picker.sees_node(*place)
            {
                named(ui, at, &format!("node {name}"));
            }
        }
        let middle = |[a, b]: [DVec3; 2]| {
            let at = self.view.screen(a)?.lerp(self.view.screen(b)?, 0.5);
            (rect.contains(at) && picker.sees_edge([a, b])).then_some(at)
        };
        for edge in &self.model.wires.edges {
            let ends = edge.ends.each_ref().map(|n| self.model.places.get(n).copied());
            if let [Some(a), Some(b)] = ends
                && let Some(at) = middle([a, b])
            {
                named(ui, at, &format!("edge {} – {}", edge.ends[0], edge.ends[1]));
            }
        }
        for (k, points) in self.model.wires.joints.iter().enumerate() {
            let seen = points.windows(2).find_map(|w| middle([w[0], w[1]]));
            if let Some(at) = seen {
                named(ui, at, &Element::Joint(k).label(draft));
            }
        }
    }
}

/// A small named rectangle, for screen readers and for tests.
pub(crate) fn named(ui: &egui::Ui, at: Pos2, name: &str) {
    let rect = Rect::from_center_size(at, egui::vec2(8.0, 8.0));
    let response = ui.interact(rect, ui.scope_id().with(name), egui::Sense::hover());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::GraphicsObject, true, name));
}

fn area(painter: &egui::Painter, at: Vec<Pos2>, color: Color32) {
    painter.add(Shape::Path(egui::epaint::PathShape {
        points: at,
        closed: true,
        fill: color.gamma_multiply(0.3),
        stroke: Stroke::new(1.5, color).into(),
    }));
}
