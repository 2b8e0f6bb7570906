//! Files: tokens of the DXF dialects, sizes of SVG and PDF, JSON that tells what is sewn to what.

use crate::surfaces::{column, grid};
use glam::{DVec2, DVec3};
use pattern::*;

fn sample() -> Pattern {
    let curved = |name: &str, from: f64, to: f64| {
        grid(name, 8, 20, |u, v| {
            let (s, c) = (from + (to - from) * u).sin_cos();
            let r = 110.0 + 25.0 * (3.0 * v).sin();
            DVec3::new(r * s, 300.0 * v, r * c)
        })
    };
    let patches =
        vec![curved("Vorderteil – links", 0.0, 0.8), curved("a very long name of a back panel", 0.8, 1.6)];
    let sides =
        vec![SeamSide { patch: 0, nodes: column(20, 8) }, SeamSide { patch: 1, nodes: column(20, 0) }];
    let seams = vec![SeamInput { name: "side".to_owned(), sides }];
    let marks = vec![
        Mark { patch: 0, node: column(20, 8)[6], kind: MarkKind::Notch, name: "n".to_owned() },
        Mark { patch: 1, node: column(20, 4)[10], kind: MarkKind::Drill, name: "d".to_owned() },
    ];
    let lines = vec![PatchLine { patch: 0, nodes: column(20, 4), name: "centre".to_owned() }];
    let input = PatternInput { patches, seams, marks, lines, ..PatternInput::default() };
    make(&input, &PatternOptions::default()).unwrap()
}

/// Code and value pairs.
fn tokens(dxf: &str) -> Vec<(u32, &str)> {
    let lines: Vec<&str> = dxf.split("\r\n").collect();
    assert_eq!(lines.len() % 2, 1, "pairs and one empty end");
    lines.as_chunks::<2>().0.iter().map(|l| (l[0].parse().unwrap(), l[1])).collect()
}

#[test]
fn every_dialect_has_a_block_and_an_insert_a_piece() {
    let pattern = sample();
    for (name, dialect) in Dialect::NAMES {
        let dxf = to_dxf(&pattern, &DxfOptions { dialect, ..DxfOptions::default() });
        assert!(dxf.is_ascii(), "{name}");
        let tokens = tokens(&dxf);
        let count = |code: u32, value: &str| tokens.iter().filter(|t| **t == (code, value)).count();
        assert_eq!((count(0, "BLOCK"), count(0, "INSERT"), count(0, "EOF")), (2, 2, 1), "{name}");
        assert_eq!(count(2, "TABLES") + count(2, "$MODEL_SPACE"), 0);
        assert_eq!(count(1, "Units: METRIC"), 1);
        assert_eq!(count(9, "$ACADVER"), usize::from(dialect != Dialect::Gerber));
        let longest = if dialect == Dialect::Gerber { 20 } else { 31 };
        let blocks: Vec<&str> = tokens.windows(3).filter(|w| w[0] == (0, "BLOCK")).map(|w| w[2].1).collect();
        for block in &blocks {
            assert!(block.len() <= longest && !block.contains(' '), "{name}: {block}");
            assert_eq!(count(2, block), 2, "one block and one insert");
        }
        assert_ne!(blocks[0].to_lowercase(), blocks[1].to_lowercase());
        // Every layer is a number of the standard.
        for (_, layer) in tokens.iter().filter(|t| t.0 == 8) {
            let layer: u32 = layer.parse().unwrap();
            assert!((1..=15).contains(&layer) || (dialect == Dialect::Astm && (80..=87).contains(&layer)));
        }
        for layer in ["1", "2", "3", "4", "7", "8", "13", "14"] {
            assert!(count(8, layer) > 0, "{name}: layer {layer}");
        }
        assert_eq!(count(1, "Piece Name: Vorderteil _ links"), 1);
        assert!(dxf.len() < 100_000, "{}", dxf.len());
    }
}

#[test]
fn boundary_is_one_closed_polyline_whose_points_are_turns_or_curves() {
    let pattern = sample();
    let dxf = to_dxf(&pattern, &DxfOptions::default());
    let tokens = tokens(&dxf);
    let mut kinds = std::collections::BTreeMap::new();
    for w in tokens.windows(2).filter(|w| w[0].0 == 0 && w[1].0 == 8) {
        *kinds.entry((w[0].1, w[1].1)).or_insert(0usize) += 1;
    }
    let points: usize = pattern.pieces.iter().map(|p| p.cut[0].points.len()).sum();
    assert_eq!(kinds[&("POLYLINE", "1")], 2);
    assert_eq!(kinds[&("VERTEX", "1")], points);
    assert_eq!(kinds[&("POINT", "2")] + kinds[&("POINT", "3")], points);
    assert_eq!(kinds[&("POINT", "2")], 8, "four corners a piece");
    assert_eq!(kinds[&("POINT", "4")], 2, "a notch on both sides of the seam");
    assert_eq!(kinds[&("LINE", "7")], 2);
    assert_eq!(kinds[&("POLYLINE", "14")], 2);
}

#[test]
fn same_names_do_not_merge() {
    let mut pattern = sample();
    for piece in &mut pattern.pieces {
        piece.label = "Panel".to_owned();
    }
    let dxf = to_dxf(&pattern, &DxfOptions { dialect: Dialect::Gerber, ..DxfOptions::default() });
    assert!(dxf.contains("\r\nPanel_M\r\n") && dxf.contains("\r\nPanel-2_M\r\n"));
}

#[test]
fn svg_is_in_millimetres_with_a_group_a_piece() {
    let pattern = sample();
    let svg = to_svg(&pattern, &SvgOptions { title: "A & B".to_owned(), ..SvgOptions::default() });
    let (w, h) = (pattern.layout.width, pattern.layout.length);
    assert!(svg.contains(&format!("width=\"{w:.3}mm\" height=\"{h:.3}mm\" viewBox=\"0 0 {w:.3} {h:.3}\"")));
    assert_eq!(svg.matches("<g id=\"piece-").count(), 2);
    assert!(svg.contains("A &amp; B") && svg.contains("Vorderteil – links"));
    for (class, colour) in
        [("cut", "#ff0000"), ("sew", "#0000ff"), ("notch", "#ff00ff"), ("grain", "#008000")]
    {
        assert!(svg.contains(&format!("class=\"{class}\" fill=\"none\" stroke=\"{colour}\"")));
    }
}

/// The value of an attribute of an element.
fn attribute<'a>(element: &'a str, name: &str) -> &'a str {
    let from = element.find(&format!(" {name}=\"")).unwrap() + name.len() + 3;
    &element[from..from + element[from..].find('"').unwrap()]
}

#[test]
fn text_crosses_no_line_of_its_piece() {
    // A skirt's panel, whose grain line would have to pass the text, and a narrow one.
    let panel = |name: &str, low: f64, high: f64| {
        grid(name, 4, 12, |u, v| DVec3::new((u - 0.5) * (high + (low - high) * v), 600.0 * v, 0.0))
    };
    let patches = vec![panel("Skirt front", 130.0, 260.0), panel("Band", 45.0, 45.0)];
    let input = PatternInput { patches, ..PatternInput::default() };
    let pattern = make(&input, &PatternOptions::default()).unwrap();
    let options = SvgOptions { sample_size: "MADE TO MEASURE".to_owned(), ..SvgOptions::default() };
    let svg = to_svg(&pattern, &options);
    for piece in svg.split("<g id=").skip(1) {
        let paths: Vec<Vec<DVec2>> = piece
            .split("<path ")
            .skip(1)
            .map(|path| {
                let numbers: Vec<f64> = attribute(&format!(" {path}"), "d")
                    .split(['M', 'L', 'Z', ' '])
                    .filter_map(|word| word.parse().ok())
                    .collect();
                numbers.as_chunks::<2>().0.iter().map(|p| DVec2::from_array(*p)).collect()
            })
            .collect();
        let texts: Vec<&str> = piece.split("<text").skip(1).collect();
        assert_eq!(texts.len(), 3);
        for text in texts {
            let number = |name: &str| attribute(text, name).parse::<f64>().unwrap();
            let said = &text[text.find('>').unwrap() + 1..text.find('<').unwrap()];
            let size = number("font-size");
            // Capitals are wider than this.
            let half = 0.5 * 0.55 * size * said.chars().count() as f64;
            let (x, y) = (number("x"), number("y"));
            for w in paths.iter().flat_map(|p| p.windows(2)) {
                for k in 0..=200 {
                    let p = w[0].lerp(w[1], f64::from(k) / 200.0);
                    let within = (p.x - x).abs() < half && p.y < y && p.y > y - 0.72 * size;
                    assert!(!within, "{said:?} at {x} {y} is crossed at {p}");
                }
            }
        }
    }
}

#[test]
fn the_extent_of_a_dxf_holds_its_text() {
    let pattern = sample();
    let dxf = to_dxf(&pattern, &DxfOptions { style_name: "long ".repeat(60), ..DxfOptions::default() });
    let tokens = tokens(&dxf);
    let corner = |name: &str| {
        let at = tokens.iter().position(|t| *t == (9, name)).unwrap();
        DVec2::new(tokens[at + 1].1.parse().unwrap(), tokens[at + 2].1.parse().unwrap())
    };
    let (low, high) = (corner("$EXTMIN"), corner("$EXTMAX"));
    let entities = tokens.iter().rposition(|t| *t == (2, "ENTITIES")).unwrap();
    let texts: Vec<_> = tokens[entities..].windows(7).filter(|w| w[0] == (0, "TEXT")).collect();
    assert_eq!(texts.len(), 7);
    for text in texts {
        let number = |i: usize| text[i].1.parse::<f64>().unwrap();
        let (at, height) = (DVec2::new(number(2), number(3)), number(4));
        let end = at + DVec2::new(0.7 * height * text[6].1.len() as f64, height);
        assert!(at.cmpge(low).all() && end.cmple(high).all(), "{text:?} in {low} {high}");
    }
}

/// Page boxes in millimetres.
fn pages(pdf: &[u8]) -> Vec<[f64; 2]> {
    let text = String::from_utf8_lossy(pdf);
    text.match_indices("/MediaBox [")
        .map(|(at, key)| {
            let rest = &text[at + key.len()..];
            let numbers: Vec<f64> =
                rest[..rest.find(']').unwrap()].split_whitespace().map(|n| n.parse().unwrap()).collect();
            [numbers[2] * 25.4 / 72.0, numbers[3] * 25.4 / 72.0]
        })
        .collect()
}

#[test]
fn pdf_pages_have_the_paper_s_size_and_say_where_they_belong() {
    let pattern = sample();
    for (name, paper) in Paper::NAMES {
        let pdf = to_pdf(&pattern, &PdfOptions { paper, ..PdfOptions::default() });
        assert!(pdf.starts_with(b"%PDF-"));
        let pages = pages(&pdf);
        let text = String::from_utf8_lossy(&pdf);
        match paper.size() {
            Some(size) => {
                assert!(!pages.is_empty());
                for [w, h] in &pages {
                    assert!((w - size.x).abs() < 0.01 && (h - size.y).abs() < 0.01, "{name} {w} {h}");
                }
                assert!(text.contains(&format!("page 1 of {}", pages.len())));
            }
            None => {
                assert_eq!(pages.len(), 1);
                assert!((pages[0][0] - pattern.layout.width).abs() < 0.01);
            }
        }
        assert_eq!(text.matches("(50 mm)").count(), 1, "on the first page");
    }
}

#[test]
fn json_tells_what_is_sewn_to_what() {
    let pattern = sample();
    let json = to_json(&pattern, &JsonOptions::default());
    let value: serde_json::Value = serde_json::from_str(&json).unwrap();
    assert_eq!(value["units"], "mm");
    assert_eq!(value["seams"][0]["patches"], serde_json::json!([0, 1]));
    let sides: Vec<u64> = value["pieces"]
        .as_array()
        .unwrap()
        .iter()
        .flat_map(|p| p["sew"][0]["chains"].as_array().unwrap())
        .flat_map(|c| c["seams"].as_array().unwrap())
        .map(|s| s["side"].as_u64().unwrap())
        .collect();
    assert_eq!(sides, [0, 1]);
    assert!(value["pieces"][0]["report"]["area_2d"].as_f64().unwrap() > 0.0);
}
