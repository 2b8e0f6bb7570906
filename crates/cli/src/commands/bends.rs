//! `toile bends`: what bends and what is welded.

use std::time::Instant;

use design::sheet_metal::{BendsFileReport, SheetReading, bends};

use super::{file_name, read_sheet, unit_of_sheet};
use crate::failure::Failure;
use crate::speech::{Speech, table};
use crate::words::Bends;

pub(crate) fn run(words: &Bends, speech: &Speech) -> Result<(), Failure> {
    let started = Instant::now();
    speech.step("reading");
    let sheet = read_sheet(&words.sheet)?;
    speech.step("looking for ways to bend it");
    let reading = SheetReading {
        unit: unit_of_sheet(words.unit, &words.sheet, &sheet, 0.0).millimetres,
        rule: words.facets.rule(),
    };
    let mut report = bends(&sheet, &reading).map_err(|e| Failure::from(e).about(&words.sheet))?;
    report.file = file_name(&words.sheet);
    report.seconds = started.elapsed().as_secs_f64();
    for warning in &report.warnings {
        speech.warn(warning);
    }
    speech.report(&report, || summary(&report))
}

fn summary(r: &BendsFileReport) -> String {
    let counts = [r.s, r.b, r.e, r.w, r.v, r.g_nm, r.m, r.f, r.d].map(|n| n.to_string()).to_vec();
    let mut text = table(&["s", "b", "e", "w", "v", "g_nm", "m", "f", "d"], &[counts]);
    let o = &r.operators;
    let operators = [o.mcv, o.mev, o.mef, o.mgb, o.mbke, o.muke, o.mwkb].map(|n| n.to_string()).to_vec();
    text.push('\n');
    text.push_str(&table(&["MCV", "MEV", "MEF", "MGB", "MBKE", "MUKE", "MWKB"], &[operators]));
    text.push_str(&format!(
        "\n  one piece: {}; {}\n  f − s = {} bends and welds at least (d = {}: lines over that); the lines bear {} bends\n",
        if r.one_piece { "yes" } else { "no" },
        r.one_piece_reason,
        r.least_joints,
        r.d,
        r.most_bends
    ));
    let place = |ends: &[[f64; 3]; 2]| ends.map(|p| p.map(|x| format!("{x:.2}")).join(" ")).join("  to  ");
    let rows: Vec<Vec<String>> = r
        .bend_lines
        .iter()
        .map(|b| {
            vec![
                b.at.line.clone(),
                b.facets.join(" – "),
                format!("{:.2}", b.angle),
                format!("{:.2}", b.at.length),
                place(&b.at.ends),
            ]
        })
        .collect();
    text.push('\n');
    text.push_str(&table(&["bend", "facets", "degrees", "length", "from … to"], &rows));
    if !r.weld_lines.is_empty() {
        let rows: Vec<Vec<String>> = r
            .weld_lines
            .iter()
            .map(|w| {
                let holds = if w.needed > 0 { "holds the part together" } else { "closes a seam" };
                vec![
                    w.at.line.clone(),
                    w.facets.join(" – "),
                    holds.to_owned(),
                    format!("{:.2}", w.at.length),
                    place(&w.at.ends),
                ]
            })
            .collect();
        text.push('\n');
        text.push_str(&table(&["weld", "facets", "", "length", "from … to"], &rows));
    }
    if !r.alternatives.is_empty() {
        let rows: Vec<Vec<String>> = r
            .alternatives
            .iter()
            .map(|a| {
                vec![
                    a.bends.to_string(),
                    a.needed_welds.to_string(),
                    a.pieces.to_string(),
                    a.overlaps.map_or("–".to_owned(), |n| n.to_string()),
                    a.weld_lines.join(" "),
                ]
            })
            .collect();
        text.push('\n');
        text.push_str(&table(
            &["other ways: bends", "welds needed", "plates", "overlaps", "welds at"],
            &rows,
        ));
    }
    text
}
