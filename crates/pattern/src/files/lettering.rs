//! What is written on a piece.

use crate::Piece;

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

/// Height of a piece's letters that leaves room around the text, in millimetres.
pub(crate) fn letter_height(piece: &Piece, lines: &[String]) -> f64 {
    let room = piece.cut.iter().flat_map(|c| &c.points).map(|p| p.distance(piece.text_at));
    let room = room.fold(f64::INFINITY, f64::min);
    let longest = lines.iter().map(|l| l.chars().count()).max().unwrap_or(1).max(4) as f64;
    // Helvetica is about half as wide as high.
    let wide = 2.0 * room / (0.55 * longest);
    let high = 2.0 * room / (1.3 * lines.len() as f64);
    (0.6 * wide.min(high)).clamp(2.0, 8.0)
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
