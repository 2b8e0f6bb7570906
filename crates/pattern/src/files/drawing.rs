//! Pieces as lines with a meaning, for SVG and PDF.

use glam::DVec2;

use super::lettering::{helvetica_width, lines, text_room};
use crate::Piece;

/// What a line means. Cutters map power and speed by colour, so every meaning has its own.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Meaning {
    Cut,
    Sew,
    Notch,
    Grain,
    Internal,
    Fold,
    Drill,
    Text,
}

impl Meaning {
    pub(crate) const ALL: [Meaning; 8] = [
        Meaning::Cut,
        Meaning::Sew,
        Meaning::Notch,
        Meaning::Grain,
        Meaning::Internal,
        Meaning::Fold,
        Meaning::Drill,
        Meaning::Text,
    ];

    /// Class name in SVG.
    pub(crate) fn class(self) -> &'static str {
        match self {
            Meaning::Cut => "cut",
            Meaning::Sew => "sew",
            Meaning::Notch => "notch",
            Meaning::Grain => "grain",
            Meaning::Internal => "internal",
            Meaning::Fold => "fold",
            Meaning::Drill => "drill",
            Meaning::Text => "text",
        }
    }

    /// Red, green, blue.
    pub(crate) fn colour(self) -> [u8; 3] {
        match self {
            Meaning::Cut => [0xff, 0x00, 0x00],
            Meaning::Sew => [0x00, 0x00, 0xff],
            Meaning::Notch => [0xff, 0x00, 0xff],
            Meaning::Grain => [0x00, 0x80, 0x00],
            Meaning::Internal => [0xff, 0x80, 0x00],
            Meaning::Fold => [0x00, 0x80, 0x80],
            Meaning::Drill => [0x80, 0x00, 0xff],
            Meaning::Text => [0x00, 0x00, 0x00],
        }
    }

    /// Width of the line, in millimetres.
    pub(crate) fn width(self) -> f64 {
        match self {
            Meaning::Cut => 0.5,
            Meaning::Sew | Meaning::Notch => 0.35,
            _ => 0.25,
        }
    }

    /// Dash and gap, in millimetres.
    pub(crate) fn dashes(self) -> Option<[f64; 2]> {
        match self {
            Meaning::Sew => Some([4.0, 2.0]),
            Meaning::Internal => Some([2.0, 2.0]),
            Meaning::Fold => Some([8.0, 3.0]),
            _ => None,
        }
    }
}

/// A line of a drawing.
pub(crate) struct Stroke {
    pub(crate) meaning: Meaning,
    pub(crate) points: Vec<DVec2>,
    pub(crate) closed: bool,
}

/// A line of text: its middle on the baseline.
pub(crate) struct Lettering {
    pub(crate) at: DVec2,
    pub(crate) height: f64,
    pub(crate) text: String,
}

/// One piece, y up, millimetres.
pub(crate) struct PieceDrawing {
    pub(crate) strokes: Vec<Stroke>,
    pub(crate) letters: Vec<Lettering>,
}

/// From line to line, in heights of capitals.
const LINE: f64 = 1.3;
/// How deep letters reach below their line, in heights of capitals.
const DESCENDER: f64 = 0.3;

/// Draws a piece at its place.
pub(crate) fn draw(piece: &Piece, offset: DVec2, sample_size: &str) -> PieceDrawing {
    let mut strokes = Vec::new();
    let mut add = |meaning: Meaning, points: Vec<DVec2>, closed: bool| {
        let points = points.into_iter().map(|p| p + offset).collect();
        strokes.push(Stroke { meaning, points, closed });
    };
    for cut in &piece.cut {
        add(Meaning::Cut, cut.points.clone(), true);
    }
    for sew in &piece.sew {
        add(Meaning::Sew, sew.points(), true);
    }
    for line in &piece.lines {
        add(Meaning::Internal, line.points.clone(), false);
    }
    for slit in piece.notches.iter().flat_map(|n| &n.slits) {
        add(Meaning::Notch, slit.to_vec(), false);
    }
    for drill in &piece.drills {
        let arm = 3.0;
        add(Meaning::Drill, vec![drill.at - DVec2::X * arm, drill.at + DVec2::X * arm], false);
        add(Meaning::Drill, vec![drill.at - DVec2::Y * arm, drill.at + DVec2::Y * arm], false);
        let circle = (0..24).map(|i| drill.at + DVec2::from_angle(f64::from(i) * 0.2617993877991494) * 1.5);
        add(Meaning::Drill, circle.collect(), true);
    }
    let [bottom, top] = piece.grain;
    add(Meaning::Grain, vec![bottom, top], false);
    let head = (0.1 * bottom.distance(top)).min(8.0);
    for (tip, s) in [(top, -1.0), (bottom, 1.0)] {
        let wing = |side: f64| tip + DVec2::new(0.4 * side * head, s * head);
        add(Meaning::Grain, vec![wing(-1.0), tip, wing(1.0)], false);
    }
    if let Some(fold) = &piece.fold {
        add(Meaning::Fold, fold.clone(), false);
    }
    let lines = lines(piece, sample_size);
    // Under the last line a descender's depth.
    let tall = LINE * (lines.len() as f64 - 1.0) + 1.0 + DESCENDER;
    let wide = lines.iter().map(|l| helvetica_width(l)).fold(0.0, f64::max);
    let room = text_room(piece, DVec2::new(wide, tall));
    let first = room.middle + offset + DVec2::Y * room.height * (0.5 * tall - 1.0);
    let letters = lines
        .into_iter()
        .enumerate()
        .map(|(i, text)| Lettering {
            at: first - DVec2::Y * (LINE * room.height * i as f64),
            height: room.height,
            text,
        })
        .collect();
    PieceDrawing { strokes, letters }
}
