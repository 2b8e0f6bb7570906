//! DXF for cutting rooms: ASTM D6673 and AAMA-292 and what vendors' programs want of them.
//!
//! One BLOCK a piece and one INSERT each; numeric layers; straight vertices only; no TABLES.

use std::fmt::Write;

use glam::DVec2;

use super::lettering::{plain, plain_text, text_room};
use crate::{Pattern, Piece};

/// Whose reading of the standard.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dialect {
    /// ASTM D6673-10, with validation copies of boundary and sew line.
    #[default]
    Astm,
    /// AAMA-292 (also Lectra): no layers above 15.
    Aama,
    /// Gerber AccuMark: an empty header, names of at most 20 characters.
    Gerber,
    /// CLO and Marvelous Designer: release 10.
    Clo,
    /// Richpeace: release 10, closed lines repeat their first point.
    Richpeace,
}

impl Dialect {
    /// All dialects with the names that the command line uses.
    pub const NAMES: [(&'static str, Dialect); 5] = [
        ("astm", Dialect::Astm),
        ("aama", Dialect::Aama),
        ("gerber", Dialect::Gerber),
        ("clo", Dialect::Clo),
        ("richpeace", Dialect::Richpeace),
    ];

    /// Version of the drawing format in the header, or an empty header.
    fn version(self) -> Option<&'static str> {
        match self {
            Dialect::Gerber => None,
            Dialect::Clo | Dialect::Richpeace => Some("AC1006"),
            Dialect::Astm | Dialect::Aama => Some("AC1009"),
        }
    }

    fn longest_name(self) -> usize {
        if self == Dialect::Gerber { 20 } else { 31 }
    }
}

/// Settings of [`to_dxf`].
#[derive(Clone, Debug)]
pub struct DxfOptions {
    /// Whose reading of the standard.
    pub dialect: Dialect,
    /// Size that the pieces are drawn in.
    pub sample_size: String,
    /// Name of the style (garment).
    pub style_name: String,
}

impl Default for DxfOptions {
    fn default() -> Self {
        Self { dialect: Dialect::default(), sample_size: "M".to_owned(), style_name: "toile".to_owned() }
    }
}

/// Layers of the standard.
mod layer {
    pub(super) const BOUNDARY: u8 = 1;
    pub(super) const TURN: u8 = 2;
    pub(super) const CURVE: u8 = 3;
    pub(super) const NOTCH: u8 = 4;
    pub(super) const FOLD: u8 = 6;
    pub(super) const GRAIN: u8 = 7;
    pub(super) const INTERNAL: u8 = 8;
    pub(super) const CUT_OUT: u8 = 11;
    pub(super) const DRILL: u8 = 13;
    pub(super) const SEW: u8 = 14;
    pub(super) const BOUNDARY_COPY: u8 = 84;
    pub(super) const SEW_COPY: u8 = 87;
}

/// Advance of a letter of the standard's text, in heights; rough.
const LETTER: f64 = 0.8;
/// From line to line, in heights.
const LINE: f64 = 1.5;
/// How deep letters reach below their line, in heights.
const DESCENDER: f64 = 0.3;
/// Height of the style's text, in millimetres.
const STYLE_HEIGHT: f64 = 10.0;

/// Width of a slit notch as noted in files, in millimetres.
const NOTCH_WIDTH: f64 = 0.5;

/// The pattern as DXF text, in millimetres. Every byte follows from the arguments: no dates.
pub fn to_dxf(pattern: &Pattern, options: &DxfOptions) -> String {
    let mut w = Writer { out: String::new(), repeat_first: options.dialect == Dialect::Richpeace };
    let names = block_names(pattern, options);
    let style = style_text(options);
    w.header(extent(pattern, &style), options.dialect.version());
    w.text(0, "SECTION");
    w.text(2, "BLOCKS");
    for (piece, name) in pattern.pieces.iter().zip(&names) {
        w.block(piece, name, options);
    }
    w.text(0, "ENDSEC");
    w.text(0, "SECTION");
    w.text(2, "ENTITIES");
    for (name, offset) in names.iter().zip(&pattern.layout.offsets) {
        w.text(0, "INSERT");
        w.number(8, layer::BOUNDARY.into());
        w.text(2, name);
        w.point(*offset);
    }
    for (at, line) in &style {
        w.lettering(*at, STYLE_HEIGHT, line);
    }
    w.text(0, "ENDSEC");
    w.text(0, "EOF");
    w.out
}

/// What is said about the style, below the pieces: where each line begins, and the line.
fn style_text(options: &DxfOptions) -> Vec<(DVec2, String)> {
    let entries = [
        ("Style Name", plain_text(&options.style_name)),
        ("Author", "toile".to_owned()),
        ("Product", "toile".to_owned()),
        ("Version", env!("CARGO_PKG_VERSION").to_owned()),
        ("Sample Size", plain_text(&options.sample_size)),
        ("Grade Rule Table", String::new()),
        ("Units", "METRIC".to_owned()),
    ];
    let below = |i: usize| DVec2::new(0.0, -STYLE_HEIGHT * (2.0 + LINE * i as f64));
    entries.iter().enumerate().map(|(i, (key, value))| (below(i), format!("{key}: {value}"))).collect()
}

/// Bounds of all pieces and the text about them.
fn extent(pattern: &Pattern, style: &[(DVec2, String)]) -> [DVec2; 2] {
    let whole = [DVec2::ZERO, DVec2::new(pattern.layout.width, pattern.layout.length)];
    style.iter().fold(whole, |[low, high], (at, line)| {
        let size = STYLE_HEIGHT * DVec2::new(LETTER * line.len() as f64, 1.0);
        [low.min(*at - DVec2::Y * (DESCENDER * STYLE_HEIGHT)), high.max(*at + size)]
    })
}

/// Unique conservative block names `PIECE_SIZE`.
fn block_names(pattern: &Pattern, options: &DxfOptions) -> Vec<String> {
    let longest = options.dialect.longest_name();
    let size = plain(&options.sample_size);
    let mut names: Vec<String> = Vec::new();
    for piece in &pattern.pieces {
        let mut tail = if size.is_empty() { String::new() } else { format!("_{size}") };
        tail.truncate(longest / 2);
        let base = plain(&piece.label);
        let make = |number: usize| {
            let tail = if number > 1 { format!("-{number}{tail}") } else { tail.clone() };
            let room = longest.saturating_sub(tail.len()).max(1);
            let head: String = base.chars().take(room).collect();
            format!("{}{tail}", if head.is_empty() { "P".to_owned() } else { head })
        };
        // Programs compare block names without case.
        let taken = |name: &String| names.iter().any(|n| n.eq_ignore_ascii_case(name));
        let name = (1..).map(make).find(|n| !taken(n)).unwrap_or_default();
        names.push(name);
    }
    names
}

struct Writer {
    out: String,
    repeat_first: bool,
}

impl Writer {
    fn text(&mut self, code: u8, value: &str) {
        let _ = write!(self.out, "{code}\r\n{value}\r\n");
    }

    fn number(&mut self, code: u8, value: i64) {
        let _ = write!(self.out, "{code}\r\n{value}\r\n");
    }

    fn real(&mut self, code: u8, value: f64) {
        // No negative zero, four decimals: a tenth of a micrometre.
        let _ = write!(self.out, "{code}\r\n{:.4}\r\n", (value * 1e4).round() / 1e4 + 0.0);
    }

    fn point(&mut self, p: DVec2) {
        self.real(10, p.x);
        self.real(20, p.y);
    }

    fn header(&mut self, [low, high]: [DVec2; 2], version: Option<&str>) {
        self.text(0, "SECTION");
        self.text(2, "HEADER");
        if let Some(version) = version {
            self.text(9, "$ACADVER");
            self.text(1, version);
            for (name, p) in [("$INSBASE", DVec2::ZERO), ("$EXTMIN", low), ("$EXTMAX", high)] {
                self.text(9, name);
                self.point(p);
                self.real(30, 0.0);
            }
        }
        self.text(0, "ENDSEC");
    }

    fn block(&mut self, piece: &Piece, name: &str, options: &DxfOptions) {
        self.text(0, "BLOCK");
        self.number(8, layer::BOUNDARY.into());
        self.text(2, name);
        self.number(70, 64);
        self.point(DVec2::ZERO);
        for (i, cut) in piece.cut.iter().enumerate() {
            self.polyline(if i == 0 { layer::BOUNDARY } else { layer::CUT_OUT }, &cut.points, true);
            for (p, corner) in cut.points.iter().zip(&cut.corner) {
                self.mark(if *corner { layer::TURN } else { layer::CURVE }, *p);
            }
        }
        for notch in &piece.notches {
            for [at, inner] in &notch.slits {
                self.mark(layer::NOTCH, *at);
                self.real(30, notch.depth);
                self.real(39, NOTCH_WIDTH);
                self.real(50, (*inner - *at).to_angle().to_degrees());
            }
        }
        if let Some(fold) = &piece.fold
            && let (Some(&a), Some(&b)) = (fold.first(), fold.last())
        {
            self.line(layer::FOLD, a, b);
        }
        self.line(layer::GRAIN, piece.grain[0], piece.grain[1]);
        for inner in &piece.lines {
            self.polyline(layer::INTERNAL, &inner.points, false);
        }
        for drill in &piece.drills {
            self.mark(layer::DRILL, drill.at);
        }
        for sew in &piece.sew {
            self.polyline(layer::SEW, &sew.points(), true);
        }
        if options.dialect == Dialect::Astm {
            // Copies by which a reader can tell whether it rebuilt the curves rightly.
            for cut in piece.cut.iter().take(1) {
                self.polyline(layer::BOUNDARY_COPY, &cut.points, true);
            }
            for sew in &piece.sew {
                self.polyline(layer::SEW_COPY, &sew.points(), true);
            }
        }
        let entries = [
            ("Piece Name", plain_text(&piece.label)),
            ("Size", plain_text(&options.sample_size)),
            ("Quantity", piece.quantity.to_string()),
            ("Annotation", if piece.fold.is_some() { "Cut on fold".to_owned() } else { String::new() }),
            ("Category", String::new()),
            ("Material", plain_text(&piece.material)),
        ]
        .map(|(key, value)| format!("{key}: {value}"));
        let longest = entries.iter().map(String::len).max().unwrap_or(0) as f64;
        let size = DVec2::new(LETTER * longest, LINE * (entries.len() as f64 - 1.0) + 1.0 + DESCENDER);
        let room = text_room(piece, size);
        // Text starts at its insertion point: at the left end of the longest line.
        let first = room.middle + room.height * DVec2::new(-0.5 * size.x, 0.5 * size.y - 1.0);
        for (i, entry) in entries.iter().enumerate() {
            let down = DVec2::NEG_Y * (LINE * room.height * i as f64);
            self.lettering(first + down, room.height, entry);
        }
        self.text(0, "ENDBLK");
        self.number(8, layer::BOUNDARY.into());
    }

    fn polyline(&mut self, on: u8, points: &[DVec2], closed: bool) {
        self.text(0, "POLYLINE");
        self.number(8, on.into());
        self.number(66, 1);
        self.number(70, i64::from(closed));
        let again = if closed && self.repeat_first { points.first() } else { None };
        for p in points.iter().chain(again) {
            self.text(0, "VERTEX");
            self.number(8, on.into());
            self.point(*p);
        }
        self.text(0, "SEQEND");
        self.number(8, on.into());
    }

    fn line(&mut self, on: u8, a: DVec2, b: DVec2) {
        self.text(0, "LINE");
        self.number(8, on.into());
        self.point(a);
        self.real(11, b.x);
        self.real(21, b.y);
    }

    fn mark(&mut self, on: u8, p: DVec2) {
        self.text(0, "POINT");
        self.number(8, on.into());
        self.point(p);
    }

    fn lettering(&mut self, at: DVec2, height: f64, text: &str) {
        self.text(0, "TEXT");
        self.number(8, layer::BOUNDARY.into());
        self.point(at);
        self.real(40, height);
        self.real(50, 0.0);
        self.text(1, text);
        self.text(7, "STANDARD");
    }
}
