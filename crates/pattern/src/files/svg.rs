//! SVG in true millimetres: a group a piece, a class and a colour a meaning.

use std::fmt::Write;

use glam::DVec2;

use super::drawing::{Meaning, draw};
use super::lettering::CAPITALS;
use crate::Pattern;

/// Settings of [`to_svg`].
#[derive(Clone, Debug, Default)]
pub struct SvgOptions {
    /// Title of the document.
    pub title: String,
    /// Size, written on the pieces when not empty.
    pub sample_size: String,
}

/// The pattern's layout as SVG; one user unit is one millimetre.
pub fn to_svg(pattern: &Pattern, options: &SvgOptions) -> String {
    let (width, height) = (pattern.layout.width, pattern.layout.length);
    let mut out = String::new();
    let _ = write!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" \
         width=\"{width:.3}mm\" height=\"{height:.3}mm\" viewBox=\"0 0 {width:.3} {height:.3}\">\n"
    );
    if !options.title.is_empty() {
        let _ = writeln!(out, "<title>{}</title>", escaped(&options.title));
    }
    out.push_str("<style>\n");
    for meaning in Meaning::ALL {
        let [r, g, b] = meaning.colour();
        let _ = match meaning {
            Meaning::Text => writeln!(
                out,
                ".text {{ fill: #{r:02x}{g:02x}{b:02x}; font-family: Helvetica, Arial, sans-serif; text-anchor: middle; }}"
            ),
            _ => writeln!(
                out,
                ".{} {{ fill: none; stroke: #{r:02x}{g:02x}{b:02x}; stroke-width: {}; stroke-linejoin: round; }}",
                meaning.class(),
                meaning.width()
            ),
        };
    }
    out.push_str("</style>\n");
    let place = |p: DVec2| DVec2::new(p.x, height - p.y);
    for (i, (piece, offset)) in pattern.pieces.iter().zip(&pattern.layout.offsets).enumerate() {
        let drawing = draw(piece, *offset, &options.sample_size);
        let _ = writeln!(
            out,
            "<g id=\"piece-{}\" class=\"piece\" data-name=\"{}\" data-quantity=\"{}\">",
            i + 1,
            escaped(&piece.label),
            piece.quantity
        );
        for stroke in &drawing.strokes {
            let [r, g, b] = stroke.meaning.colour();
            // Colours stand on the elements too: cutters' programs rarely read style sheets.
            let _ = write!(
                out,
                "<path class=\"{}\" fill=\"none\" stroke=\"#{r:02x}{g:02x}{b:02x}\" stroke-width=\"{}\"",
                stroke.meaning.class(),
                stroke.meaning.width()
            );
            if let Some([dash, gap]) = stroke.meaning.dashes() {
                let _ = write!(out, " stroke-dasharray=\"{dash} {gap}\"");
            }
            out.push_str(" d=\"");
            for (k, p) in stroke.points.iter().enumerate() {
                let p = place(*p);
                let _ = write!(out, "{}{:.3} {:.3}", if k == 0 { "M" } else { " L" }, p.x + 0.0, p.y + 0.0);
            }
            out.push_str(if stroke.closed { " Z\"/>\n" } else { "\"/>\n" });
        }
        for line in &drawing.letters {
            let p = place(line.at);
            let _ = writeln!(
                out,
                "<text class=\"text\" x=\"{:.3}\" y=\"{:.3}\" font-size=\"{:.2}\" font-family=\"Helvetica, Arial, \
                 sans-serif\" text-anchor=\"middle\">{}</text>",
                p.x,
                p.y,
                line.height / CAPITALS,
                escaped(&line.text)
            );
        }
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    out
}

pub(super) fn escaped(text: &str) -> String {
    text.chars()
        .filter(|c| !c.is_control())
        .map(|c| match c {
            '&' => "&amp;".to_owned(),
            '<' => "&lt;".to_owned(),
            '>' => "&gt;".to_owned(),
            '"' => "&quot;".to_owned(),
            c => c.to_string(),
        })
        .collect()
}
