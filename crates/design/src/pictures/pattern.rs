//! The laid-out pattern.

use glam::DVec2;
use pattern::{Pattern, Piece};
use viewer::{Align, Color, Drawing2d, Image, Item2d, Length, PageOptions, Pen, RenderError};

use super::{stretch_percent, stretch_scale};

/// Height of the piece names, in millimetres of the pattern.
const NAME_HEIGHT: f64 = 17.0;

/// The pieces as they lie on the cloth: cut lines, sewing lines, notches, grain; colour shows stretch.
///
/// # Errors
/// [`RenderError`] when the layout is too large for a picture or empty.
pub fn pattern_picture(pattern: &Pattern) -> Result<Image, RenderError> {
    let mut drawing = Drawing2d::default();
    let scale = stretch_scale();
    for ((piece, flat), &offset) in pattern.pieces.iter().zip(&pattern.flats).zip(&pattern.layout.offsets) {
        let rings = piece.cut.iter().map(|l| shifted(&l.points, offset)).collect();
        drawing.items.push(Item2d::Polygon { rings, fill: Color::WHITE, opacity: 1.0 });
        drawing.items.push(Item2d::Triangles {
            positions: shifted(&flat.uv, offset),
            faces: flat.faces.clone(),
            colors: flat.stretch.iter().map(|s| scale.color(stretch_percent(*s))).collect(),
        });
        draw_lines(&mut drawing, piece, offset);
    }
    let (width, height) = page_size(&drawing);
    draw_scale(&mut drawing);
    drawing.render(&PageOptions { width, height, ..PageOptions::default() })
}

fn draw_lines(drawing: &mut Drawing2d, piece: &Piece, offset: DVec2) {
    let cut_pen = Pen::pixels(Color::INK, 1.6);
    let sew_pen = Pen::pixels(Color::FAINT_INK, 1.0).dashed(Length::Pixels(5.0), Length::Pixels(3.0));
    let mut line = |points: Vec<DVec2>, pen| drawing.items.push(Item2d::Polyline { points, pen });
    for cut in &piece.cut {
        line(closed(shifted(&cut.points, offset)), cut_pen);
    }
    for sew in &piece.sew {
        line(closed(shifted(&sew.points(), offset)), sew_pen);
    }
    for inner in &piece.lines {
        line(shifted(&inner.points, offset), sew_pen);
    }
    for notch in &piece.notches {
        let from = notch.cut + offset;
        line(vec![from, from + notch.inward * notch.depth], Pen::pixels(Color::ACCENT, 2.0));
    }
    let [from, to] = piece.grain.map(|p| p + offset);
    let along = (to - from).normalize_or_zero();
    let barb = (to - from).length().min(14.0);
    let grain = Pen::pixels(Color::INK, 1.0);
    line(vec![from, to], grain);
    for (tip, back) in [(to, -along), (from, along)] {
        let side = along.perp() * 0.35;
        line(vec![tip + (back + side) * barb, tip, tip + (back - side) * barb], grain);
    }
    drawing.items.push(Item2d::Text {
        at: piece.text_at + offset,
        text: piece.label.clone(),
        size: Length::Millimetres(NAME_HEIGHT),
        angle: 0.0,
        align: Align::Middle,
        color: Color::INK,
    });
}

/// A scale bar of stretch and one of length under the pieces.
fn draw_scale(drawing: &mut Drawing2d) {
    let Some([low, high]) = drawing.bounds() else { return };
    let scale = stretch_scale();
    let (steps, cell) = (40, (high.x - low.x) * 0.3 / 40.0);
    let top = low.y - 40.0;
    let text = |at, text: String| Item2d::Text {
        at,
        text,
        size: Length::Millimetres(NAME_HEIGHT),
        angle: 0.0,
        align: Align::Middle,
        color: Color::INK,
    };
    for i in 0..steps {
        let x = low.x + f64::from(i) * cell;
        let t = (f64::from(i) + 0.5) / f64::from(steps);
        let corner = [(0.0, 0.0), (cell * 1.02, 0.0), (cell * 1.02, -18.0), (0.0, -18.0)];
        drawing.items.push(Item2d::Polygon {
            rings: vec![corner.iter().map(|&(dx, dy)| DVec2::new(x + dx, top + dy)).collect()],
            fill: scale.color(scale.low + t * (scale.high - scale.low)),
            opacity: 1.0,
        });
    }
    for (share, percent) in [(0.0, scale.low), (0.5, 0.0), (1.0, scale.high)] {
        let at = DVec2::new(low.x + share * cell * f64::from(steps), top - 40.0);
        drawing.items.push(text(at, format!("{percent:+.0} %")));
    }
    let middle = DVec2::new(low.x + 0.5 * cell * f64::from(steps), top - 64.0);
    drawing.items.push(text(middle, "flat piece against worn cloth".to_owned()));
    let bar = [DVec2::new(high.x - 100.0, top - 9.0), DVec2::new(high.x, top - 9.0)];
    let pen = Pen::pixels(Color::INK, 1.6);
    drawing.items.push(Item2d::Polyline { points: bar.to_vec(), pen });
    for end in bar {
        let tick = DVec2::Y * 9.0;
        drawing.items.push(Item2d::Polyline { points: vec![end - tick, end + tick], pen });
    }
    drawing.items.push(text(0.5 * (bar[0] + bar[1]) - DVec2::Y * 31.0, "100 mm".to_owned()));
}

/// Pixels that fit the drawing's shape, about two megapixels.
fn page_size(drawing: &Drawing2d) -> (u32, u32) {
    let size = drawing.bounds().map_or(DVec2::ONE, |[low, high]| (high - low).max(DVec2::ONE));
    let aspect = (size.x / (size.y + 120.0)).clamp(0.25, 4.0);
    let height = (2.0e6 / aspect).sqrt();
    ((height * aspect).round() as u32, height.round() as u32)
}

fn shifted(points: &[DVec2], offset: DVec2) -> Vec<DVec2> {
    points.iter().map(|p| *p + offset).collect()
}

fn closed(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.extend(points.first().copied());
    points
}
