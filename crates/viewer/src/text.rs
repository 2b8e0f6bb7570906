//! Text as filled glyph outlines, at any size and angle.

use std::sync::LazyLock;

use ab_glyph::{Font, FontRef, GlyphId, OutlineCurve};

use crate::color::Color;
use crate::painter::{Painter, Point};

/// Which end of a text, and which height of it, lies at its anchor.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Align {
    /// The text starts at the anchor.
    #[default]
    Start,
    /// The text's middle is at the anchor.
    Middle,
    /// The text ends at the anchor.
    End,
}

/// The proportional face, and the face for what it lacks (arrows, mathematics).
static FACES: LazyLock<[FontRef<'static>; 2]> = LazyLock::new(|| {
    [epaint_default_fonts::UBUNTU_LIGHT, epaint_default_fonts::HACK_REGULAR]
        .map(|bytes| FontRef::try_from_slice(bytes).expect("the built-in fonts are sound"))
});

/// Height of capitals over the font size; ascenders and figures are about as high.
pub(crate) const CAP_HEIGHT: f32 = 0.69;

struct PlacedGlyph {
    face: usize,
    glyph: GlyphId,
    /// Pen position from the text's start, in font sizes.
    pen: f32,
}

fn layout(text: &str) -> (Vec<PlacedGlyph>, f32) {
    let mut pen = 0.0;
    let mut placed: Vec<PlacedGlyph> = Vec::new();
    for c in text.chars().map(|c| if c.is_control() { ' ' } else { c }) {
        let face = usize::from(FACES[0].glyph_id(c).0 == 0 && FACES[1].glyph_id(c).0 != 0);
        let font = &FACES[face];
        let glyph = font.glyph_id(c);
        let units = font.units_per_em().unwrap_or(1000.0);
        if let Some(last) = placed.last().filter(|last| last.face == face) {
            pen += font.kern_unscaled(last.glyph, glyph) / units;
        }
        placed.push(PlacedGlyph { face, glyph, pen });
        pen += font.h_advance_unscaled(glyph) / units;
    }
    (placed, pen)
}

/// Width of a line of text, in pixels for a `size` in pixels.
pub(crate) fn width(text: &str, size: f32) -> f32 {
    layout(text).1 * size
}

/// How a line of text is set.
#[derive(Clone, Copy)]
pub(crate) struct TextStyle {
    /// Font size in pixels.
    pub(crate) size: f32,
    pub(crate) align: Align,
    /// Turned anticlockwise by this angle, in radians.
    pub(crate) angle: f32,
    pub(crate) color: Color,
    /// Width of a light rim that keeps text readable over pictures, in pixels.
    pub(crate) halo: f32,
}

impl TextStyle {
    pub(crate) fn new(size: f32) -> Self {
        Self { size, align: Align::Start, angle: 0.0, color: Color::INK, halo: 0.0 }
    }
}

/// Draws one line of text with its baseline through `at` (pixels).
pub(crate) fn draw(painter: &mut Painter, text: &str, at: Point, style: &TextStyle) {
    let (placed, width) = layout(text);
    let shift = match style.align {
        Align::Start => 0.0,
        Align::Middle => -0.5 * width,
        Align::End => -width,
    };
    let (sin, cos) = style.angle.sin_cos();
    let size = style.size;
    let mut contours: Vec<Vec<[Point; 2]>> = Vec::new();
    for glyph in &placed {
        let font = &FACES[glyph.face];
        let units = font.units_per_em().unwrap_or(1000.0);
        let Some(outline) = font.outline(glyph.glyph) else { continue };
        let place = |x: f32, y: f32| -> Point {
            let (x, y) = ((x / units + glyph.pen + shift) * size, y / units * size);
            [at[0] + x * cos - y * sin, at[1] - x * sin - y * cos]
        };
        contours.push(outline.curves.iter().flat_map(|curve| flatten(curve, size / units, place)).collect());
    }
    if style.halo > 0.0 {
        for contour in &contours {
            for edge in contour {
                painter.cover(edge, 2.0 * style.halo);
            }
        }
        painter.flush(Color::WHITE, 0.85);
    }
    // Twice at light weight: the built-in face is the light cut, small sizes need a little more ink.
    let ink = if size < 20.0 { 2 } else { 1 };
    for contour in &contours {
        for pass in 0..ink {
            painter.fill(contour, style.color, if pass == 0 { 1.0 } else { 0.35 });
        }
    }
}

/// A curve of a glyph as short straight edges; `scale`: pixels a font unit.
fn flatten(curve: &OutlineCurve, scale: f32, place: impl Fn(f32, f32) -> Point) -> Vec<[Point; 2]> {
    let evaluate = |t: f32| -> Point {
        let s = 1.0 - t;
        match curve {
            OutlineCurve::Line(a, b) => place(s * a.x + t * b.x, s * a.y + t * b.y),
            OutlineCurve::Quad(a, b, c) => {
                let [u, v, w] = [s * s, 2.0 * s * t, t * t];
                place(u * a.x + v * b.x + w * c.x, u * a.y + v * b.y + w * c.y)
            }
            OutlineCurve::Cubic(a, b, c, d) => {
                let [u, v, w, z] = [s * s * s, 3.0 * s * s * t, 3.0 * s * t * t, t * t * t];
                place(u * a.x + v * b.x + w * c.x + z * d.x, u * a.y + v * b.y + w * c.y + z * d.y)
            }
        }
    };
    let reach = match curve {
        OutlineCurve::Line(..) => 0.0,
        OutlineCurve::Quad(a, _, c) => (a.x - c.x).abs() + (a.y - c.y).abs(),
        OutlineCurve::Cubic(a, _, _, d) => (a.x - d.x).abs() + (a.y - d.y).abs(),
    };
    let steps = if reach == 0.0 { 1 } else { (2.0 + reach * scale / 4.0).min(24.0) as usize };
    let points: Vec<Point> = (0..=steps).map(|i| evaluate(i as f32 / steps as f32)).collect();
    points.windows(2).map(|pair| [pair[0], pair[1]]).collect()
}
