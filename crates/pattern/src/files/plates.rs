//! Flat plates of sheet metal as DXF and SVG: cut outlines, bend lines, weld marks and texts, each on a layer of its own.

use std::fmt::Write;

use glam::DVec2;

use super::lettering::plain_text;
use super::svg::escaped;

/// A bend line as drawn.
#[derive(Clone, Debug, PartialEq)]
pub struct PlateBend {
    /// Its ends.
    pub ends: [DVec2; 2],
    /// Whether it bends toward who looks at the drawing.
    pub up: bool,
    /// What is written beside it.
    pub text: String,
}

/// An edge that is welded to the edge of the same text.
#[derive(Clone, Debug, PartialEq)]
pub struct PlateWeld {
    /// Its ends.
    pub ends: [DVec2; 2],
    /// Its mark.
    pub text: String,
}

/// A flat plate, ready to be drawn. Millimetres, y up.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct PlateDrawing {
    /// Name.
    pub name: String,
    /// What is cut: the outer outline first, then holes; the first point is not repeated.
    pub outlines: Vec<Vec<DVec2>>,
    /// Bend lines.
    pub bends: Vec<PlateBend>,
    /// Edges to be welded.
    pub welds: Vec<PlateWeld>,
    /// Names of facets and where they stand (their middles).
    pub labels: Vec<(DVec2, String)>,
}

/// The layers of a plate's drawing.
mod layer {
    pub(super) const CUT: &str = "CUT";
    pub(super) const BEND: &str = "BEND";
    pub(super) const WELD: &str = "WELD";
    pub(super) const TEXT: &str = "TEXT";
    /// Names, colours (AutoCAD's numbers) and line types.
    pub(super) const ALL: [(&str, u8, &str); 4] =
        [(CUT, 7, "CONTINUOUS"), (BEND, 5, "DASHED"), (WELD, 1, "CONTINUOUS"), (TEXT, 3, "CONTINUOUS")];
}

/// Colours of bends up and down, AutoCAD's numbers.
const UP_DOWN: [u8; 2] = [5, 6];

/// Plates as DXF of release 12, in millimetres. Coordinates are written in full, so that lengths are exact.
pub fn plates_to_dxf(plates: &[PlateDrawing]) -> String {
    let mut w = Dxf(String::new());
    let [low, high] = bounds(plates);
    w.text(999, "plates of sheet metal, in millimetres");
    w.section("HEADER");
    w.text(9, "$ACADVER");
    w.text(1, "AC1009");
    for (name, p) in [("$EXTMIN", low), ("$EXTMAX", high)] {
        w.text(9, name);
        w.point(10, p);
    }
    w.text(0, "ENDSEC");
    w.tables();
    w.section("ENTITIES");
    let height = letter_height(low, high);
    for plate in plates {
        for outline in &plate.outlines {
            w.polyline(layer::CUT, outline);
        }
        for bend in &plate.bends {
            w.line(layer::BEND, bend.ends, Some(UP_DOWN[usize::from(!bend.up)]));
            w.lettering(beside(bend.ends, height), bend.ends, height, &bend.text);
        }
        for weld in &plate.welds {
            w.line(layer::WELD, weld.ends, None);
            w.lettering(beside(weld.ends, height), weld.ends, height, &weld.text);
        }
        for (at, text) in &plate.labels {
            w.lettering(*at, [*at, *at + DVec2::X], height * 1.5, text);
        }
    }
    w.text(0, "ENDSEC");
    w.text(0, "EOF");
    w.0
}

/// Plates as SVG in true millimetres: a group a plate; classes and colours for cut, bend and weld.
pub fn plates_to_svg(plates: &[PlateDrawing], title: &str) -> String {
    const MARGIN: f64 = 5.0;
    let [low, high] = bounds(plates);
    let size = high - low + DVec2::splat(2.0 * MARGIN);
    let height = letter_height(low, high);
    let thin = (size.max_element() / 800.0).clamp(0.1, 2.0);
    let place = |p: DVec2| DVec2::new(p.x - low.x + MARGIN, high.y - p.y + MARGIN);
    let mut out = String::new();
    let _ = write!(
        out,
        "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{x:.3}mm\" \
         height=\"{y:.3}mm\" viewBox=\"0 0 {x:.3} {y:.3}\">\n<title>{}</title>\n",
        escaped(title),
        x = size.x,
        y = size.y
    );
    let line = |out: &mut String, class: &str, colour: &str, dashes: f64, ends: [DVec2; 2]| {
        let [a, b] = ends.map(place);
        let _ = write!(
            out,
            "<path class=\"{class}\" fill=\"none\" stroke=\"{colour}\" stroke-width=\"{thin:.2}\" d=\"M{} {} L{} {}\"",
            a.x, a.y, b.x, b.y
        );
        if dashes > 0.0 {
            let _ = write!(out, " stroke-dasharray=\"{:.2} {:.2}\"", dashes * thin, 0.6 * dashes * thin);
        }
        out.push_str("/>\n");
    };
    let letters = |out: &mut String, at: DVec2, along: [DVec2; 2], size: f64, text: &str| {
        let at = place(at);
        let _ = writeln!(
            out,
            "<text class=\"text\" x=\"{:.3}\" y=\"{:.3}\" font-size=\"{:.2}\" font-family=\"Helvetica, Arial, sans-serif\" \
             text-anchor=\"middle\" transform=\"rotate({:.2} {:.3} {:.3})\">{}</text>",
            at.x,
            at.y,
            size / 0.72,
            -upright(along),
            at.x,
            at.y,
            escaped(text)
        );
    };
    for (k, plate) in plates.iter().enumerate() {
        let _ = writeln!(
            out,
            "<g id=\"plate-{}\" class=\"plate\" data-name=\"{}\">",
            k + 1,
            escaped(&plate.name)
        );
        // One path, so that holes are holes.
        let _ = write!(
            out,
            "<path class=\"cut\" fill=\"#eef2f6\" fill-rule=\"evenodd\" stroke=\"#000000\" stroke-width=\"{:.2}\" d=\"",
            1.5 * thin
        );
        for outline in &plate.outlines {
            for (k, p) in outline.iter().enumerate() {
                let p = place(*p);
                let _ = write!(out, "{}{} {}", if k == 0 { "M" } else { " L" }, p.x, p.y);
            }
            out.push_str(" Z ");
        }
        out.push_str("\"/>\n");
        for weld in &plate.welds {
            line(&mut out, "weld", "#d02020", 0.0, weld.ends);
            letters(&mut out, beside(weld.ends, height), weld.ends, 0.8 * height, &weld.text);
        }
        for bend in &plate.bends {
            let (class, colour) = if bend.up { ("bend up", "#1040d0") } else { ("bend down", "#a020c0") };
            line(&mut out, class, colour, 8.0, bend.ends);
            letters(&mut out, beside(bend.ends, height), bend.ends, 0.8 * height, &bend.text);
        }
        for (at, text) in &plate.labels {
            letters(&mut out, *at, [*at, *at + DVec2::X], 1.2 * height, text);
        }
        out.push_str("</g>\n");
    }
    out.push_str("</svg>\n");
    out
}

fn bounds(plates: &[PlateDrawing]) -> [DVec2; 2] {
    let mut points = plates.iter().flat_map(|p| p.outlines.iter().flatten());
    let Some(first) = points.next() else { return [DVec2::ZERO; 2] };
    points.fold([*first, *first], |[low, high], p| [low.min(*p), high.max(*p)])
}

/// Letters that can be read beside plates of that size.
fn letter_height(low: DVec2, high: DVec2) -> f64 {
    ((high - low).max_element() / 90.0).max(0.01)
}

/// Where a line's text stands: over its middle.
fn beside([a, b]: [DVec2; 2], height: f64) -> DVec2 {
    let turn = DVec2::from_angle(upright([a, b]).to_radians());
    (a + b) / 2.0 + turn.perp() * (0.4 * height)
}

/// The angle of text along a line, in degrees, never upside down.
fn upright([a, b]: [DVec2; 2]) -> f64 {
    let d = b - a;
    let angle = d.y.atan2(d.x).to_degrees();
    if angle > 90.0 + 1e-9 {
        angle - 180.0
    } else if angle <= -90.0 + 1e-9 {
        angle + 180.0
    } else {
        angle
    }
}

struct Dxf(String);

impl Dxf {
    fn text(&mut self, code: u16, value: &str) {
        let _ = write!(self.0, "{code}\r\n{value}\r\n");
    }

    fn number(&mut self, code: u16, value: i64) {
        let _ = write!(self.0, "{code}\r\n{value}\r\n");
    }

    fn real(&mut self, code: u16, value: f64) {
        // The shortest text that reads back as the same number; no negative zero.
        let _ = write!(self.0, "{code}\r\n{}\r\n", value + 0.0);
    }

    fn point(&mut self, code: u16, p: DVec2) {
        self.real(code, p.x);
        self.real(code + 10, p.y);
        self.real(code + 20, 0.0);
    }

    fn section(&mut self, name: &str) {
        self.text(0, "SECTION");
        self.text(2, name);
    }

    fn tables(&mut self) {
        self.section("TABLES");
        self.text(0, "TABLE");
        self.text(2, "LTYPE");
        self.number(70, 2);
        for (name, about, dashes) in
            [("CONTINUOUS", "Solid line", &[][..]), ("DASHED", "__ __ __", &[6.0, -3.0][..])]
        {
            self.text(0, "LTYPE");
            self.text(2, name);
            self.number(70, 0);
            self.text(3, about);
            self.number(72, 65);
            self.number(73, dashes.len() as i64);
            self.real(40, dashes.iter().map(|d: &f64| d.abs()).sum());
            for d in dashes {
                self.real(49, *d);
            }
        }
        self.text(0, "ENDTAB");
        self.text(0, "TABLE");
        self.text(2, "LAYER");
        self.number(70, layer::ALL.len() as i64);
        for (name, colour, line) in layer::ALL {
            self.text(0, "LAYER");
            self.text(2, name);
            self.number(70, 0);
            self.number(62, colour.into());
            self.text(6, line);
        }
        self.text(0, "ENDTAB");
        self.text(0, "TABLE");
        self.text(2, "STYLE");
        self.number(70, 1);
        self.text(0, "STYLE");
        self.text(2, "STANDARD");
        self.number(70, 0);
        for (code, value) in [(40, 0.0), (41, 1.0), (50, 0.0)] {
            self.real(code, value);
        }
        self.number(71, 0);
        self.real(42, 2.5);
        self.text(3, "txt");
        self.text(4, "");
        self.text(0, "ENDTAB");
        self.text(0, "ENDSEC");
    }

    fn polyline(&mut self, on: &str, points: &[DVec2]) {
        self.text(0, "POLYLINE");
        self.text(8, on);
        self.number(66, 1);
        self.point(10, DVec2::ZERO);
        self.number(70, 1);
        for p in points {
            self.text(0, "VERTEX");
            self.text(8, on);
            self.point(10, *p);
        }
        self.text(0, "SEQEND");
        self.text(8, on);
    }

    fn line(&mut self, on: &str, [a, b]: [DVec2; 2], colour: Option<u8>) {
        self.text(0, "LINE");
        self.text(8, on);
        if let Some(colour) = colour {
            self.number(62, colour.into());
        }
        self.point(10, a);
        self.point(11, b);
    }

    fn lettering(&mut self, at: DVec2, along: [DVec2; 2], height: f64, text: &str) {
        if text.is_empty() {
            return;
        }
        self.text(0, "TEXT");
        self.text(8, layer::TEXT);
        self.point(10, at);
        self.real(40, height);
        self.text(1, &plain_text(text));
        self.real(50, upright(along));
        // Centred on its second point.
        self.number(72, 1);
        self.point(11, at);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plate() -> PlateDrawing {
        let at = DVec2::new;
        PlateDrawing {
            name: "a & b".into(),
            outlines: vec![vec![at(0., 0.), at(10.000_000_000_1, 0.), at(10., 5.), at(0., 5.)]],
            bends: vec![PlateBend { ends: [at(0., 2.), at(10., 2.)], up: true, text: "up 90°".into() }],
            welds: vec![PlateWeld { ends: [at(0., 0.), at(0., 5.)], text: "W1".into() }],
            labels: vec![(at(5., 3.), "floor".into())],
        }
    }

    #[test]
    fn dxf_holds_every_digit_and_keeps_bends_on_their_own_layer() {
        let text = plates_to_dxf(&[plate()]);
        assert!(text.contains("\r\n10.0000000001\r\n"));
        let lines: Vec<&str> = text.lines().collect();
        let on = |kind: &str, layer: &str| {
            lines.windows(4).filter(|w| w[0] == "0" && w[1] == kind && w[2] == "8" && w[3] == layer).count()
        };
        assert_eq!(
            (on("POLYLINE", "CUT"), on("LINE", "BEND"), on("LINE", "WELD"), on("TEXT", "TEXT")),
            (1, 1, 1, 3)
        );
        assert!(text.is_ascii());
        assert_eq!(plates_to_dxf(&[]).lines().last(), Some("EOF"));
    }

    #[test]
    fn svg_is_in_millimetres_and_escapes_names() {
        let text = plates_to_svg(&[plate()], "t<");
        assert!(text.contains("width=\"20.000mm\"") && text.contains("a &amp; b") && text.contains("t&lt;"));
        assert!(text.contains("class=\"bend up\""));
    }

    #[test]
    fn text_is_never_upside_down() {
        let angle = |x: f64, y: f64| upright([DVec2::ZERO, DVec2::new(x, y)]);
        assert_eq!([angle(1., 0.), angle(-1., 0.), angle(0., 1.), angle(0., -1.)], [0., 0., 90., 90.]);
    }
}
