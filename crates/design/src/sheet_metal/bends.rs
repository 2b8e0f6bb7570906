//! The report of `toile bends`.

use mesh_kernel::TriMesh;
use serde::Serialize;
use sheet::bends::{Assignment, BendAnalysis, OnePiece, analyse};
use sheet::facets::FacetSheet;
use sheet::unfold::{Effort, UnfoldError};

use super::{OperatorCounts, SheetReading, curved, facets, line_name};

/// What `toile bends` reports. Coordinates are those of the sheet's file, lengths millimetres, angles degrees.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BendsFileReport {
    /// Components.
    pub s: i64,
    /// Bends: lines that bend in the assignment reported.
    pub b: i64,
    /// Free edges.
    pub e: i64,
    /// Welds: all other lines with two facets and more.
    pub w: i64,
    /// Vertices.
    pub v: i64,
    /// Non-manifold genus: holes, those inside facets left out.
    pub g_nm: i64,
    /// Enclosed volumes.
    pub m: i64,
    /// Facets.
    pub f: i64,
    /// Bends and welds more than hold the part together (eq. 9).
    pub d: i64,
    /// Whether `f = s + b + e + w − v − g_nm + m` (eq. 7).
    pub identity_holds: bool,
    /// Bends and welds that it takes at least, `f − s` (eq. 8).
    pub least_joints: i64,
    /// Bends that its lines bear at most (eq. 10).
    pub most_bends: i64,
    /// How many of each operator build it.
    pub operators: OperatorCounts,
    /// Whether every component can be bent from one flat plate.
    pub one_piece: bool,
    /// Why it can, or cannot.
    pub one_piece_reason: String,
    /// Whether eq. 8 and eq. 10 leave it open: bends enough for one piece.
    pub lines_allow_one_piece: bool,
    /// Flat plates of the assignment reported.
    pub pieces: usize,
    /// Bends of the assignment reported.
    pub bend_lines: Vec<BendReport>,
    /// Welds of the assignment reported.
    pub weld_lines: Vec<WeldReport>,
    /// Other ways to make it.
    pub alternatives: Vec<AssignmentReport>,
    /// Holes inside facets, which the paper's counts leave out.
    pub rings: usize,
    /// What the user should know.
    pub warnings: Vec<String>,
    /// The sheet's file.
    pub file: String,
    /// The whole command.
    pub seconds: f64,
}

/// A line of the sheet.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct LineReport {
    /// Its name in drawings.
    pub line: String,
    /// Where it begins and ends, in the file's coordinates.
    pub ends: [[f64; 3]; 2],
    /// Length in millimetres.
    pub length: f64,
}

/// A bend.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct BendReport {
    /// The line.
    #[serde(flatten)]
    pub at: LineReport,
    /// The facets that are one piece across it.
    pub facets: [String; 2],
    /// By what angle the flat plate is bent, in degrees.
    pub angle: f64,
}

/// Welds at a line.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct WeldReport {
    /// The line.
    #[serde(flatten)]
    pub at: LineReport,
    /// The facets there.
    pub facets: Vec<String>,
    /// Welds that join all of them.
    pub welds: usize,
    /// How many of these hold the part together.
    pub needed: usize,
}

/// Another way to make the part.
#[derive(Clone, Debug, PartialEq, Serialize)]
pub struct AssignmentReport {
    /// Bends.
    pub bends: usize,
    /// Welds that hold it together.
    pub needed_welds: usize,
    /// Flat plates.
    pub pieces: usize,
    /// Pairs of facets that lie on each other when flat; `null` where facets are curved.
    pub overlaps: Option<usize>,
    /// Lines that bend, with the facets.
    pub bend_lines: Vec<String>,
    /// Lines that are welded.
    pub weld_lines: Vec<String>,
}

/// Analyses the bends and welds of a sheet.
///
/// # Errors
/// [`UnfoldError`]: no facets, curved or closed ones that cannot be counted.
pub fn bends(mesh: &TriMesh, reading: &SheetReading) -> Result<BendsFileReport, UnfoldError> {
    let sheet = facets(mesh, reading)?;
    let found = analyse(&sheet, Effort::default())?;
    let mut warnings: Vec<String> = curved(&sheet).into_iter().collect();
    let rings = sheet.rings();
    if rings > 0 {
        warnings.push(format!(
            "{rings} holes inside facets: their vertices and free edges are counted, their holes are not part of g_nm"
        ));
    }
    let c = found.counts;
    let best = &found.assignments[0];
    let name = |f: u32| sheet.facets[f as usize].name.clone();
    let at = |line: u32| LineReport {
        line: line_name(line),
        ends: sheet.line_ends(line).map(|p| (p / reading.unit).to_array()),
        length: sheet.lines[line as usize].length,
    };
    let bend_lines = best.bends.iter().map(|b| BendReport {
        at: at(b.line),
        facets: b.facets.map(name),
        angle: angle(&sheet, b.line, b.facets).to_degrees(),
    });
    let weld_lines = best.welds.iter().map(|w| {
        let mut there: Vec<u32> = sheet.lines[w.line as usize].uses.iter().map(|u| u.facet).collect();
        there.dedup();
        WeldReport {
            at: at(w.line),
            facets: there.into_iter().map(name).collect(),
            welds: w.welds,
            needed: w.needed,
        }
    });
    Ok(BendsFileReport {
        s: c.s,
        b: c.b,
        e: c.e,
        w: c.w,
        v: c.v,
        g_nm: c.g_nm,
        m: c.m,
        f: c.f,
        d: found.redundant,
        identity_holds: c.identity_holds(),
        least_joints: found.least_joints,
        most_bends: found.most_bends,
        operators: found.plan.map(OperatorCounts::from).unwrap_or_default(),
        one_piece: found.one_piece == OnePiece::Yes,
        one_piece_reason: reason(&found),
        lines_allow_one_piece: found.most_bends >= found.least_joints,
        pieces: best.pieces,
        bend_lines: bend_lines.collect(),
        weld_lines: weld_lines.collect(),
        alternatives: found.assignments[1..].iter().map(|a| alternative(&sheet, a)).collect(),
        rings,
        warnings,
        file: String::new(),
        seconds: 0.0,
    })
}

/// By what angle a plate is bent at a line, in radians.
fn angle(sheet: &FacetSheet, line: u32, facets: [u32; 2]) -> f64 {
    let walk =
        |f: u32| sheet.lines[line as usize].uses.iter().find(|u| u.facet == f).is_some_and(|u| u.along);
    let [a, b] = facets.map(|f| sheet.facets[f as usize].normal);
    let b = if walk(facets[0]) == walk(facets[1]) { -b } else { b };
    a.cross(b).length().atan2(a.dot(b))
}

fn reason(found: &BendAnalysis) -> String {
    let parts =
        if found.counts.s == 1 { "one plate".to_owned() } else { format!("{} plates", found.counts.s) };
    match found.one_piece {
        OnePiece::Yes => format!(
            "{parts} with {} bends, and no facet lies on another when flat",
            found.assignments[0].bends.len()
        ),
        OnePiece::TooFewBends { .. } if found.most_bends < found.least_joints => format!(
            "{} bends are needed, but the lines bear {} at most (eq. 10)",
            found.least_joints, found.most_bends
        ),
        OnePiece::TooFewBends { pieces, proved: true } => {
            format!("no choice of bends joins all facets: {pieces} plates at least")
        }
        OnePiece::TooFewBends { pieces, proved: false } => {
            format!("no choice of bends was found that joins all facets: {pieces} plates")
        }
        OnePiece::Overlaps { tried } => {
            format!("bends would do, but all {tried} flat sheets tried lie on themselves")
        }
    }
}

fn alternative(sheet: &FacetSheet, way: &Assignment) -> AssignmentReport {
    let name = |f: u32| sheet.facets[f as usize].name.as_str();
    AssignmentReport {
        bends: way.bends.len(),
        needed_welds: way.needed_welds,
        pieces: way.pieces,
        overlaps: way.overlaps,
        bend_lines: way
            .bends
            .iter()
            .map(|b| format!("{} {}–{}", line_name(b.line), name(b.facets[0]), name(b.facets[1])))
            .collect(),
        weld_lines: way.welds.iter().map(|w| line_name(w.line)).collect(),
    }
}
