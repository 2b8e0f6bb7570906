//! What is written on a piece.

use glam::DVec2;

use crate::{
    Piece,
    pieces::{bounds, inside},
};

/// Lines of text on a piece for people, the name first.
pub(crate) fn lines(piece: &Piece, sample_size: &str) -> Vec<String> {
    let mut lines = vec![piece.label.clone()];
    if !sample_size.is_empty() {
        lines.push(format!("Size {sample_size}"));
    }
    let fold = if piece.fold.is_some() { " on the fold" } else { "" };
    lines.push(format!("Cut {}{fold}", piece.quantity));
    if !piece.material.is_empty() {
        lines.push(piece.material.clone());
    }
    lines
}

/// Room for a text on a piece.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct TextRoom {
    /// Middle of the text.
    pub(crate) middle: DVec2,
    /// Height of its capitals, in millimetres.
    pub(crate) height: f64,
}

/// Heights that are tried, in millimetres: from what is read from afar to what can be printed.
const HEIGHTS: [f64; 9] = [8.0, 7.0, 6.0, 5.0, 4.0, 3.5, 3.0, 2.5, 2.0];
/// Places across a piece, and up it, that are tried.
const PLACES: usize = 24;
/// Room about a text, in heights of its capitals.
const RIM: f64 = 0.5;

/// Where a text whose width and height are `per_height` times that of its capitals crosses no line of the piece: as large
/// as possible, then as near as possible to where it should stand. Where it has no room at all it stands there, small.
pub(crate) fn text_room(piece: &Piece, per_height: DVec2) -> TextRoom {
    let sewn: Vec<Vec<DVec2>> = piece.sew.iter().map(|o| o.points()).collect();
    let [low, high] = bounds(sewn.iter().flatten().copied());
    let mut places: Vec<DVec2> = (0..PLACES * PLACES)
        .map(|i| DVec2::new((i % PLACES) as f64, (i / PLACES) as f64) + 0.5)
        .map(|cell| low + (high - low) * cell / PLACES as f64)
        .collect();
    places.sort_by(|a, b| a.distance(piece.text_at).total_cmp(&b.distance(piece.text_at)));
    places.insert(0, piece.text_at);
    places.retain(|p| inside(*p, &sewn));
    let lines = segments(piece, &sewn);
    let free = |room: &TextRoom| {
        let half = 0.5 * room.height * (per_height + 2.0 * RIM);
        let frame = [room.middle - half, room.middle + half];
        !lines.iter().any(|[a, b]| touches(*a, *b, frame))
    };
    let smallest = HEIGHTS[HEIGHTS.len() - 1];
    HEIGHTS
        .iter()
        .flat_map(|&height| places.iter().map(move |&middle| TextRoom { middle, height }))
        .find(free)
        .unwrap_or(TextRoom { middle: piece.text_at, height: smallest })
}

/// All lines that a text must not cross.
fn segments(piece: &Piece, sewn: &[Vec<DVec2>]) -> Vec<[DVec2; 2]> {
    let closed = |points: &[DVec2]| -> Vec<[DVec2; 2]> {
        (0..points.len()).map(|i| [points[i], points[(i + 1) % points.len()]]).collect()
    };
    let open = |points: &[DVec2]| -> Vec<[DVec2; 2]> { points.windows(2).map(|w| [w[0], w[1]]).collect() };
    let mut out = vec![piece.grain];
    sewn.iter().for_each(|points| out.extend(closed(points)));
    piece.cut.iter().for_each(|c| out.extend(closed(&c.points)));
    piece.lines.iter().for_each(|l| out.extend(open(&l.points)));
    piece.notches.iter().for_each(|n| out.extend(&n.slits));
    piece.drills.iter().for_each(|d| out.push([d.at, d.at]));
    out
}

/// Whether a segment has a point in a box (Liang–Barsky).
pub(crate) fn touches(a: DVec2, b: DVec2, [low, high]: [DVec2; 2]) -> bool {
    let d = b - a;
    let (mut from, mut to) = (0.0f64, 1.0f64);
    for axis in 0..2 {
        if d[axis] == 0.0 {
            if a[axis] < low[axis] || a[axis] > high[axis] {
                return false;
            }
            continue;
        }
        let (s, t) = ((low[axis] - a[axis]) / d[axis], (high[axis] - a[axis]) / d[axis]);
        from = from.max(s.min(t));
        to = to.min(s.max(t));
    }
    from <= to
}

/// Width of a text in Helvetica, in heights of its capitals; rough.
pub(crate) fn helvetica_width(text: &str) -> f64 {
    text.chars().map(|c| u8::try_from(u32::from(c)).map_or(1.0, advance)).sum::<f64>() / CAPITALS
}

/// Height of Helvetica's capitals, in ems.
pub(crate) const CAPITALS: f64 = 0.72;

/// Rough advance of Helvetica's letters, in ems.
pub(crate) fn advance(byte: u8) -> f64 {
    match byte {
        b'i' | b'j' | b'l' | b'I' | b' ' | b'.' | b',' | b':' | b';' | b'f' | b't' | b'(' | b')' | b'-' => {
            0.28
        }
        b'm' | b'w' | b'M' | b'W' => 0.83,
        b'A'..=b'Z' => 0.68,
        _ => 0.55,
    }
}

/// ASCII letters, digits, `-`, `_` and `.`; everything else becomes `_`, common accents their letter.
pub(crate) fn plain(text: &str) -> String {
    let mut out = String::new();
    for c in text.chars() {
        match c {
            'ä' => out.push_str("ae"),
            'ö' => out.push_str("oe"),
            'ü' => out.push_str("ue"),
            'Ä' => out.push_str("Ae"),
            'Ö' => out.push_str("Oe"),
            'Ü' => out.push_str("Ue"),
            'ß' => out.push_str("ss"),
            'à'..='å' => out.push('a'),
            'è'..='ë' => out.push('e'),
            'ì'..='ï' => out.push('i'),
            'ò'..='õ' => out.push('o'),
            'ù'..='û' => out.push('u'),
            'ç' => out.push('c'),
            'ñ' => out.push('n'),
            c if c.is_ascii_alphanumeric() || matches!(c, '-' | '_' | '.') => out.push(c),
            _ => out.push('_'),
        }
    }
    out
}

/// Printable ASCII for free text, other characters as in [`plain`].
pub(crate) fn plain_text(text: &str) -> String {
    text.chars()
        .map(|c| if (' '..='~').contains(&c) { c.to_string() } else { plain(&c.to_string()) })
        .collect()
}
