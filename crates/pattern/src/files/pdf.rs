//! PDF at 1:1: tiles for home printers, or one page for a plotter.
//!
//! Tiles overlap, carry crosses off their middles that fall on each other when glued, and say where they belong.
//! A test square of 50 mm and one of 2 inches stand on the first tile.

use glam::DVec2;
use pdf_writer::{Content, Finish, Name, Pdf, Rect, Ref, Str};

use super::drawing::{Lettering, Meaning, PieceDrawing, Stroke, draw};
use super::lettering::{CAPITALS, advance, touches};
use crate::{
    Pattern,
    pieces::{bounds, inside, lay_out},
};

/// Size of the pages.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Paper {
    /// 210 × 297 mm.
    #[default]
    A4,
    /// 297 × 420 mm.
    A3,
    /// 841 × 1189 mm.
    A0,
    /// 8½ × 11 inch.
    Letter,
    /// One page as wide as the cloth and as long as the layout.
    Plotter,
}

impl Paper {
    /// All papers with the names that the command line uses.
    pub const NAMES: [(&'static str, Paper); 5] = [
        ("a4", Paper::A4),
        ("a3", Paper::A3),
        ("a0", Paper::A0),
        ("letter", Paper::Letter),
        ("plotter", Paper::Plotter),
    ];

    /// Width and height in millimetres; `None` for the plotter.
    pub fn size(self) -> Option<DVec2> {
        match self {
            Paper::A4 => Some(DVec2::new(210.0, 297.0)),
            Paper::A3 => Some(DVec2::new(297.0, 420.0)),
            Paper::A0 => Some(DVec2::new(841.0, 1189.0)),
            Paper::Letter => Some(DVec2::new(215.9, 279.4)),
            Paper::Plotter => None,
        }
    }
}

/// Settings of [`to_pdf`].
#[derive(Clone, Debug, Default)]
pub struct PdfOptions {
    /// Size of the pages.
    pub paper: Paper,
    /// Title, printed on every page.
    pub title: String,
    /// Size, written on the pieces when not empty.
    pub sample_size: String,
}

const POINTS_PER_MM: f64 = 72.0 / 25.4;
/// Unprintable rim of home printers, in millimetres.
const MARGIN: f64 = 10.0;
/// How much of a tile its neighbour shows again, in millimetres.
const OVERLAP: f64 = 10.0;
/// Room for both test squares and their words, in millimetres.
const LEGEND: DVec2 = DVec2::new(160.0, 70.0);
const GAP: f64 = 10.0;
/// Largest page side that readers take without a user unit, in points.
const LONGEST_SIDE: f64 = 14_400.0;

/// The pattern as PDF. Pages without any line or part of a piece are left out. Every byte follows from the arguments.
pub fn to_pdf(pattern: &Pattern, options: &PdfOptions) -> Vec<u8> {
    match options.paper.size() {
        Some(paper) => tiled(pattern, options, paper),
        None => plotter(pattern, options),
    }
}

/// The whole drawing: pieces at their places and the legend.
struct Sheet {
    drawings: Vec<PieceDrawing>,
    outlines: Vec<Vec<DVec2>>,
    size: DVec2,
}

/// The drawing on cloth of a width; its length is rounded up by `round`. The legend stands at the top left, so that
/// the first tile has it.
fn sheet(pattern: &Pattern, options: &PdfOptions, width: f64, round: impl Fn(f64) -> f64) -> Sheet {
    let layout = lay_out(&pattern.pieces, width, GAP, LEGEND);
    let length = round(layout.length);
    let mut drawings = Vec::with_capacity(pattern.pieces.len() + 1);
    let mut outlines: Vec<Vec<DVec2>> = Vec::new();
    for (piece, offset) in pattern.pieces.iter().zip(&layout.offsets) {
        let [low, high] = bounds(piece.cut.iter().flat_map(|c| c.points.iter().copied()));
        let offset = DVec2::new(offset.x, length - offset.y - low.y - high.y);
        drawings.push(draw(piece, offset, &options.sample_size));
        outlines.extend(piece.cut.iter().map(|c| c.points.iter().map(|p| *p + offset).collect()));
    }
    drawings.push(legend(options, DVec2::new(GAP, length - GAP)));
    Sheet { drawings, outlines, size: DVec2::new(layout.width, length) }
}

/// Test squares with their sizes, below and right of a corner.
fn legend(options: &PdfOptions, corner: DVec2) -> PieceDrawing {
    let square = |corner: DVec2, side: f64| Stroke {
        meaning: Meaning::Text,
        points: [DVec2::ZERO, DVec2::X, DVec2::new(1.0, -1.0), DVec2::NEG_Y]
            .map(|d| corner + d * side)
            .to_vec(),
        closed: true,
    };
    let second = corner + DVec2::new(60.0, 0.0);
    let text = |at: DVec2, height: f64, text: &str| Lettering { at, height, text: text.to_owned() };
    let middle = 25.0;
    PieceDrawing {
        strokes: vec![square(corner, 50.0), square(second, 50.8)],
        letters: vec![
            text(corner + DVec2::new(middle, -24.0), 3.0, "50 mm"),
            text(corner + DVec2::new(middle, -31.0), 2.2, "measure before cutting"),
            text(second + DVec2::new(middle, -24.0), 3.0, "2 inch"),
            text(second + DVec2::new(middle, -31.0), 2.2, "print at 100 %"),
            text(corner + DVec2::new(135.0, -25.0), 3.0, &options.title),
        ],
    }
}

fn plotter(pattern: &Pattern, options: &PdfOptions) -> Vec<u8> {
    let sheet = sheet(pattern, options, pattern.layout.width, |length| length);
    let unit = (sheet.size.max_element() * POINTS_PER_MM / LONGEST_SIDE).ceil().max(1.0);
    let scale = POINTS_PER_MM / unit;
    let mut content = Content::new();
    content.transform([scale as f32, 0.0, 0.0, scale as f32, 0.0, 0.0]);
    paint(&mut content, &sheet, [DVec2::ZERO, sheet.size]);
    document(&[Page { size: sheet.size * scale, unit, content: content.finish().to_vec() }])
}

fn tiled(pattern: &Pattern, options: &PdfOptions, paper: DVec2) -> Vec<u8> {
    let window = paper - DVec2::splat(2.0 * MARGIN);
    let step = window - DVec2::splat(OVERLAP);
    // The width, a whole number of tiles, that takes the fewest pages.
    let widest = pattern
        .pieces
        .iter()
        .map(|p| bounds(p.cut.iter().flat_map(|c| c.points.iter().copied())))
        .map(|[l, h]| h.x - l.x)
        .fold(LEGEND.x, f64::max);
    let least = ((widest + 2.0 * GAP - OVERLAP) / step.x).ceil().max(1.0) as usize;
    let mut best: Option<(Sheet, Vec<[usize; 2]>)> = None;
    for columns in least..least + 6 {
        let sheet = sheet(pattern, options, columns as f64 * step.x + OVERLAP, |length| {
            ((length - OVERLAP) / step.y).ceil().max(1.0) * step.y + OVERLAP
        });
        let tiles = used_tiles(&sheet, window, step);
        if best.as_ref().is_none_or(|b| tiles.len() < b.1.len()) {
            best = Some((sheet, tiles));
        }
    }
    let Some((sheet, tiles)) = best else { return document(&[]) };
    let pages: Vec<Page> = tiles
        .iter()
        .enumerate()
        .map(|(i, tile)| {
            let tail = format!("page {} of {}", i + 1, tiles.len());
            let content = tile_content(&sheet, options, window, step, *tile, &tail, &tiles);
            Page { size: paper * POINTS_PER_MM, unit: 1.0, content }
        })
        .collect();
    document(&pages)
}

/// Number of tiles across and up.
fn grid(sheet: &Sheet, step: DVec2) -> [usize; 2] {
    // Both sides are a whole number of steps and one overlap, up to rounding.
    let count = |length: f64, step: f64| ((length - OVERLAP) / step - 1e-6).ceil().max(1.0) as usize;
    [count(sheet.size.x, step.x), count(sheet.size.y, step.y)]
}

/// Tiles `[row from the bottom, column]` that show something, top row first.
fn used_tiles(sheet: &Sheet, window: DVec2, step: DVec2) -> Vec<[usize; 2]> {
    let [columns, rows] = grid(sheet, step);
    let mut tiles = Vec::new();
    for row in (0..rows).rev() {
        for column in 0..columns {
            let low = DVec2::new(column as f64 * step.x, row as f64 * step.y);
            let frame = [low, low + window];
            let crossed = sheet.drawings.iter().flat_map(|d| &d.strokes).any(|s| {
                let n = s.points.len();
                let last = if s.closed { n } else { n - 1 };
                (0..last).any(|i| touches(s.points[i], s.points[(i + 1) % n], frame))
            });
            if crossed || inside(low + 0.5 * window, &sheet.outlines) {
                tiles.push([row, column]);
            }
        }
    }
    tiles
}

fn tile_content(
    sheet: &Sheet,
    options: &PdfOptions,
    window: DVec2,
    step: DVec2,
    [row, column]: [usize; 2],
    tail: &str,
    tiles: &[[usize; 2]],
) -> Vec<u8> {
    let low = DVec2::new(column as f64 * step.x, row as f64 * step.y);
    let [_, rows] = grid(sheet, step);
    let mut content = Content::new();
    let k = POINTS_PER_MM as f32;
    content.save_state();
    content.transform([k, 0.0, 0.0, k, 0.0, 0.0]);
    content.save_state();
    let m = MARGIN as f32;
    content.rect(m, m, window.x as f32, window.y as f32);
    content.clip_nonzero();
    content.end_path();
    content.transform([1.0, 0.0, 0.0, 1.0, (MARGIN - low.x) as f32, (MARGIN - low.y) as f32]);
    paint(&mut content, sheet, [low, low + window]);
    // Crosses on the lines where tiles meet, away from the middle so that a turned page shows.
    grey(&mut content);
    for (other, at) in [
        ([row, column + 1], DVec2::new(step.x + 0.5 * OVERLAP, 0.38 * window.y)),
        ([row, column.wrapping_sub(1)], DVec2::new(0.5 * OVERLAP, 0.38 * window.y)),
        ([row + 1, column], DVec2::new(0.38 * window.x, step.y + 0.5 * OVERLAP)),
        ([row.wrapping_sub(1), column], DVec2::new(0.38 * window.x, 0.5 * OVERLAP)),
    ] {
        if tiles.contains(&other) {
            let p = low + at;
            for d in [DVec2::new(4.0, 0.0), DVec2::new(0.0, 4.0)] {
                line(&mut content, p - d, p + d);
            }
            polyline(
                &mut content,
                &[DVec2::X, DVec2::Y, DVec2::NEG_X, DVec2::NEG_Y].map(|d| p + 2.0 * d),
                true,
            );
        }
    }
    content.restore_state();
    grey(&mut content);
    content.rect(m, m, window.x as f32, window.y as f32);
    content.stroke();
    // Where the neighbours' paper ends: the overlap.
    content.set_dash_pattern([1.0, 2.0], 0.0);
    let corner = DVec2::splat(MARGIN);
    if tiles.contains(&[row, column + 1]) {
        let x = corner.x + step.x;
        line(&mut content, DVec2::new(x, corner.y), DVec2::new(x, corner.y + window.y));
    }
    if tiles.contains(&[row + 1, column]) {
        let y = corner.y + step.y;
        line(&mut content, DVec2::new(corner.x, y), DVec2::new(corner.x + window.x, y));
    }
    content.set_dash_pattern([], 0.0);
    let words = format!("({}, {})  {tail}  {}", rows - row, column + 1, options.title);
    letters(&mut content, DVec2::new(MARGIN, 0.45 * MARGIN), 2.6, &words, false);
    content.restore_state();
    content.finish().to_vec()
}

/// Draws what may show in a frame.
fn paint(content: &mut Content, sheet: &Sheet, [low, high]: [DVec2; 2]) {
    for drawing in &sheet.drawings {
        for stroke in &drawing.strokes {
            let [l, h] = bounds(stroke.points.iter().copied());
            if l.x > high.x || l.y > high.y || h.x < low.x || h.y < low.y {
                continue;
            }
            let [r, g, b] = stroke.meaning.colour().map(|c| f32::from(c) / 255.0);
            content.set_stroke_rgb(r, g, b);
            content.set_line_width(stroke.meaning.width() as f32);
            match stroke.meaning.dashes() {
                Some(dashes) => content.set_dash_pattern(dashes.map(|d| d as f32), 0.0),
                None => content.set_dash_pattern([], 0.0),
            };
            polyline(content, &stroke.points, stroke.closed);
        }
        for one in &drawing.letters {
            // Letters reach to both sides of their middle, at most some way.
            let reach = DVec2::new(0.5 * one.height * one.text.chars().count() as f64, 2.0 * one.height);
            if (one.at + reach).cmplt(low).any() || (one.at - reach).cmpgt(high).any() {
                continue;
            }
            letters(content, one.at, one.height, &one.text, true);
        }
    }
    content.set_dash_pattern([], 0.0);
}

fn grey(content: &mut Content) {
    content.set_stroke_rgb(0.5, 0.5, 0.5);
    content.set_line_width(0.15);
}

fn line(content: &mut Content, a: DVec2, b: DVec2) {
    polyline(content, &[a, b], false);
}

fn polyline(content: &mut Content, points: &[DVec2], closed: bool) {
    for (i, p) in points.iter().enumerate() {
        let (x, y) = (p.x as f32, p.y as f32);
        if i == 0 {
            content.move_to(x, y);
        } else {
            content.line_to(x, y);
        }
    }
    if closed {
        content.close_and_stroke();
    } else {
        content.stroke();
    }
}

/// Text of the given height of capitals, in Helvetica; what its encoding lacks becomes `?`.
fn letters(content: &mut Content, at: DVec2, height: f64, text: &str, centred: bool) {
    let bytes: Vec<u8> =
        text.chars().map(|c| u8::try_from(u32::from(c)).ok().filter(|b| *b >= 32).unwrap_or(b'?')).collect();
    if bytes.is_empty() {
        return;
    }
    let size = height / CAPITALS;
    let width: f64 = bytes.iter().map(|&b| size * advance(b)).sum();
    let x = if centred { at.x - 0.5 * width } else { at.x };
    content.begin_text();
    content.set_fill_rgb(0.0, 0.0, 0.0);
    content.set_font(Name(b"F1"), size as f32);
    content.next_line(x as f32, at.y as f32);
    content.show(Str(&bytes));
    content.end_text();
}

struct Page {
    /// In user units.
    size: DVec2,
    /// Points a user unit.
    unit: f64,
    content: Vec<u8>,
}

fn document(pages: &[Page]) -> Vec<u8> {
    let mut pdf = Pdf::new();
    let (catalog, tree, font) = (Ref::new(1), Ref::new(2), Ref::new(3));
    let page_ref = |i: usize| Ref::new(4 + 2 * i as i32);
    let content_ref = |i: usize| Ref::new(5 + 2 * i as i32);
    pdf.catalog(catalog).pages(tree);
    pdf.pages(tree).kids((0..pages.len()).map(page_ref)).count(pages.len() as i32);
    pdf.type1_font(font).base_font(Name(b"Helvetica")).encoding_predefined(Name(b"WinAnsiEncoding"));
    for (i, one) in pages.iter().enumerate() {
        let mut page = pdf.page(page_ref(i));
        page.media_box(Rect::new(0.0, 0.0, one.size.x as f32, one.size.y as f32));
        if one.unit > 1.0 {
            page.user_unit(one.unit as f32);
        }
        page.parent(tree);
        page.contents(content_ref(i));
        page.resources().fonts().pair(Name(b"F1"), font);
        page.finish();
        pdf.stream(content_ref(i), &one.content);
    }
    pdf.finish()
}
