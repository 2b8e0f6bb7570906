//! The flat pattern beside the garment: the same selection, the same pointer.

use std::sync::Arc;

use design::pictures::{stretch_percent, stretch_scale};
use design::regenerate::Regenerated;
use eframe::egui::{self, Color32, Pos2, Rect, Shape, Stroke};
use glam::DVec2;
use pattern::{OutlineChain, Piece};
use sketch::polygon_holds;

use crate::designer::Designer;
use crate::selection::Element;
use crate::view::scene::Colouring;

/// Which part of the layout is shown.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatternView {
    /// How much larger than the whole layout in the view.
    zoom: f64,
    /// The layout's place in the view's middle, off its own middle, mm.
    off: DVec2,
}

impl Default for PatternView {
    fn default() -> Self {
        Self { zoom: 1.0, off: DVec2::ZERO }
    }
}

/// Millimetres of the layout to points of the screen.
struct Sheet {
    rect: Rect,
    middle: DVec2,
    scale: f64,
}

impl Sheet {
    fn place(&self, p: DVec2) -> Pos2 {
        let d = (p - self.middle) * self.scale;
        self.rect.center() + egui::vec2(d.x as f32, -d.y as f32)
    }

    fn mm(&self, p: Pos2) -> DVec2 {
        let d = p - self.rect.center();
        self.middle + DVec2::new(f64::from(d.x), -f64::from(d.y)) / self.scale
    }
}

/// A seam's colour: far from its neighbours' in the list, for partners to be found by eye.
fn seam_color(seam: usize, is_dark: bool) -> Color32 {
    let hue = (seam as f32 * 0.618_034).fract();
    let value = if is_dark { 0.95 } else { 0.72 };
    egui::epaint::Hsva::new(hue, 0.75, value, 1.0).into()
}

impl Designer {
    pub(crate) fn pattern_view(&mut self, ui: &mut egui::Ui) {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), egui::Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Pattern view"));
        let made = self.model.cloth.as_ref().and_then(|c| c.made.clone()).or_else(|| self.last_made.clone());
        let Some(made) = made else {
            let text = "the flat pattern appears here when faces are filled";
            ui.painter().text(
                rect.center(),
                egui::Align2::CENTER_CENTER,
                text,
                egui::FontId::proportional(13.0),
                ui.visuals().weak_text_color(),
            );
            return;
        };
        self.last_made = Some(Arc::clone(&made));
        let Some(sheet) = self.sheet(ui, &response, &made) else { return };
        let painter = ui.painter_at(rect);
        let pointer = response.hover_pos().map(|p| sheet.mm(p));
        let is_dark = ui.visuals().dark_mode;
        let mut over: Option<String> = None;
        let mut near_seam: Option<(f64, usize)> = None;
        let hovered = self.hovered_surface();
        for ((piece, flat), offset) in
            made.pattern.pieces.iter().zip(&made.pattern.flats).zip(&made.pattern.layout.offsets)
        {
            let written = self.written(&piece.name);
            let is_chosen = written == self.session.surface;
            let is_hovered = hovered.as_deref() == Some(written.as_str());
            if let Some(p) = pointer {
                let inside = piece.cut.first().is_some_and(|c| polygon_holds(&c.points, p - *offset));
                if inside {
                    over = Some(written.clone());
                }
                for (chain, seam) in seams(piece) {
                    let d = distance(&chain.points, p - *offset);
                    if d * sheet.scale < 6.0 && near_seam.is_none_or(|(best, _)| d < best) {
                        near_seam = Some((d, seam));
                    }
                }
            }
            if self.look.colouring == Colouring::Stretch {
                paint_stretch(&painter, &sheet, flat, *offset);
            }
            paint_piece(&painter, ui, &sheet, piece, *offset, [is_chosen, is_hovered]);
        }
        let shown = near_seam.map(|(_, seam)| seam).or(self.selected_seam(&made));
        for (piece, offset) in made.pattern.pieces.iter().zip(&made.pattern.layout.offsets) {
            for (chain, seam) in seams(piece) {
                let width = if shown == Some(seam) { 4.0 } else { 1.5 };
                let points = chain.points.iter().map(|p| sheet.place(*p + *offset)).collect();
                painter.add(Shape::line(points, Stroke::new(width, seam_color(seam, is_dark))));
            }
        }
        self.hovered_seam = near_seam.map(|(_, seam)| seam).filter(|s| *s < made.garment.seams.len());
        if let Some(seam) = near_seam.and_then(|(_, seam)| made.pattern.seams.get(seam)) {
            let unit = self.preferences.unit;
            let sides: Vec<String> = seam.lengths_2d.iter().map(|l| unit.text(*l)).collect();
            response.clone().on_hover_text_at_pointer(format!("{}: {}", seam.name, sides.join(" / ")));
        }
        if let Some(surface) = over {
            let element = Element::Face { surface, face: 0 };
            if response.clicked() {
                self.select(vec![element.clone()]);
            }
            self.hovered = Some(element);
        }
    }

    /// Where the layout lies in the view, after what hands did.
    fn sheet(&mut self, ui: &egui::Ui, response: &egui::Response, made: &Regenerated) -> Option<Sheet> {
        let rect = response.rect;
        let (mut low, mut high) = (DVec2::INFINITY, DVec2::NEG_INFINITY);
        for (piece, offset) in made.pattern.pieces.iter().zip(&made.pattern.layout.offsets) {
            for p in piece.cut.iter().flat_map(|c| &c.points) {
                (low, high) = (low.min(*p + *offset), high.max(*p + *offset));
            }
        }
        let size = high - low;
        if !size.is_finite() || size.min_element() <= 0.0 {
            return None;
        }
        let fit = (f64::from(rect.width()) / size.x).min(f64::from(rect.height()) / size.y) * 0.96;
        let middle = 0.5 * (low + high);
        let view = &mut self.pattern;
        let sheet = |view: &PatternView| Sheet { rect, middle: middle + view.off, scale: fit * view.zoom };
        if let Some(at) = response.hover_pos() {
            let scroll = f64::from(ui.input(|i| i.smooth_scroll_delta().y));
            if scroll != 0.0 {
                let under = sheet(view).mm(at);
                view.zoom = (view.zoom * (0.004 * scroll).exp()).clamp(0.5, 60.0);
                view.off += under - sheet(view).mm(at);
            }
        }
        if response.dragged() {
            let by = response.drag_delta();
            view.off += DVec2::new(-f64::from(by.x), f64::from(by.y)) / (fit * view.zoom);
        }
        if response.double_clicked() {
            *view = PatternView::default();
        }
        Some(sheet(view))
    }

    /// The written surface of a piece: that of the left half for twins.
    fn written(&self, piece: &str) -> String {
        let surfaces = &self.draft().template.surfaces;
        if surfaces.contains_key(piece) {
            return piece.to_owned();
        }
        let rest = piece.strip_prefix("right_").unwrap_or(piece);
        let left = format!("left_{rest}");
        if surfaces.contains_key(&left) { left } else { rest.to_owned() }
    }

    /// The surface under the pointer in the 3D view.
    fn hovered_surface(&self) -> Option<String> {
        match &self.hovered {
            Some(Element::Face { surface, .. }) => Some(surface.clone()),
            _ => None,
        }
    }

    /// The seam of the joint that is selected.
    fn selected_seam(&self, made: &Regenerated) -> Option<usize> {
        let Some(Element::Joint(k)) = self.session.selection.only() else { return None };
        let joints = crate::selection::joints_of(self.draft());
        let joint = joints.get(*k)?;
        made.garment.seams.iter().position(|seam| {
            let own = seam.sides.iter().map(|s| self.written(&made.garment.surfaces[s.surface].name));
            let own: std::collections::BTreeSet<String> = own.collect();
            joint.name.as_ref() == Some(&seam.name) || own == joint.surfaces.iter().cloned().collect()
        })
    }
}

/// Chains of a piece's outline that are sides of seams.
fn seams(piece: &Piece) -> impl Iterator<Item = (&OutlineChain, usize)> {
    let chains = piece.sew.iter().flat_map(|outline| &outline.chains);
    chains.filter_map(|chain| Some((chain, chain.seams.first()?.seam)))
}

fn paint_piece(
    painter: &egui::Painter,
    ui: &egui::Ui,
    sheet: &Sheet,
    piece: &Piece,
    offset: DVec2,
    [is_chosen, is_hovered]: [bool; 2],
) {
    let ink = ui.visuals().text_color();
    let color = if is_hovered { ui.visuals().selection.bg_fill } else { ink };
    let width = if is_chosen || is_hovered { 2.0 } else { 1.0 };
    let line = |points: &[DVec2], stroke: Stroke| {
        painter.add(Shape::line(points.iter().map(|p| sheet.place(*p + offset)).collect(), stroke));
    };
    for cut in &piece.cut {
        let mut points = cut.points.clone();
        points.extend(cut.points.first().copied());
        line(&points, Stroke::new(width, color));
    }
    let faint = Stroke::new(1.0, ui.visuals().weak_text_color());
    for inner in &piece.lines {
        line(&inner.points, faint);
    }
    for notch in &piece.notches {
        line(&[notch.cut, notch.cut + notch.inward * notch.depth], Stroke::new(1.5, ink));
    }
    line(&piece.grain, faint);
    let size = (26.0 * sheet.scale).clamp(7.0, 16.0) as f32;
    if 60.0 * sheet.scale > 6.0 {
        painter.text(
            sheet.place(piece.text_at + offset),
            egui::Align2::CENTER_CENTER,
            &piece.label,
            egui::FontId::proportional(size),
            ink,
        );
    }
}

fn paint_stretch(painter: &egui::Painter, sheet: &Sheet, flat: &pattern::Flat, offset: DVec2) {
    let scale = stretch_scale();
    let mut mesh = egui::Mesh::default();
    for (f, stretch) in flat.stretch.iter().enumerate() {
        let [r, g, b] = scale.color(stretch_percent(*stretch)).0;
        let first = mesh.vertices.len() as u32;
        for p in flat.corners(f) {
            mesh.colored_vertex(sheet.place(p + offset), Color32::from_rgb(r, g, b));
        }
        mesh.add_triangle(first, first + 1, first + 2);
    }
    painter.add(Shape::mesh(mesh));
}

/// Distance of a point to a polyline.
fn distance(points: &[DVec2], p: DVec2) -> f64 {
    let to = |w: &[DVec2]| {
        let along = w[1] - w[0];
        let t = ((p - w[0]).dot(along) / along.length_squared().max(1e-12)).clamp(0.0, 1.0);
        (w[0] + along * t).distance(p)
    };
    points.windows(2).map(to).fold(f64::INFINITY, f64::min)
}
