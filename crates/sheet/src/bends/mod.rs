//! Bends and welds: what a sheet-metal part's topology tells about its making (Lipson & Shpitalni, sections 3 and 4).
//!
//! [`analyse`] counts a sheet's facets, lines and vertices, proves the identity, and looks for ways to make it: which lines
//! bend and which are welded, from one piece where that is possible.

pub(crate) mod forest;

use mesh_kernel::complex::{SheetCounts, SheetPlan};

use crate::facets::FacetSheet;
use crate::unfold::layout::Flattening;
use crate::unfold::search::{Effort, Search};
use crate::unfold::{Metal, UnfoldError};
use forest::{Forest, PerLine, Roots, largest_forest, spanning_size};

/// Two facets at a line that may be bent there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Join {
    pub(crate) line: u32,
    /// The facets' uses of the line.
    pub(crate) uses: [u32; 2],
    pub(crate) facets: [u32; 2],
}

/// All pairs of facets that can be bent at a line. A facet that runs through under the line cannot: it stays flat there.
pub(crate) fn joins(sheet: &FacetSheet) -> Vec<Join> {
    let mut joins = Vec::new();
    for (number, line) in (0..).zip(&sheet.lines) {
        if !line.straight {
            continue;
        }
        let once = |f: u32| line.uses.iter().filter(|u| u.facet == f).count() == 1;
        for (i, a) in (0..).zip(&line.uses) {
            for (j, b) in (0..).zip(&line.uses).skip(i as usize + 1) {
                if once(a.facet) && once(b.facet) {
                    joins.push(Join { line: number, uses: [i, j], facets: [a.facet, b.facet] });
                }
            }
        }
    }
    joins
}

/// A bend of an assignment.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct BendLine {
    /// The line.
    pub line: u32,
    /// The facets that are one piece across it.
    pub facets: [u32; 2],
}

/// Welds at a line.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct WeldLine {
    /// The line.
    pub line: u32,
    /// How many welds join all facets there.
    pub welds: usize,
    /// How many of them hold the part together; the others close seams.
    pub needed: usize,
}

/// A way to make the part.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Assignment {
    /// Bends, by line.
    pub bends: Vec<BendLine>,
    /// Lines that are welded, by line; one with several facets may be bent too.
    pub welds: Vec<WeldLine>,
    /// Flat plates that it is made from.
    pub pieces: usize,
    /// Welds without which it would fall apart.
    pub needed_welds: usize,
    /// Pairs of facets that lie on each other when flat; `None` where facets are curved and cannot be laid flat.
    pub overlaps: Option<usize>,
}

impl Assignment {
    /// Whether a line bends.
    pub fn bends_at(&self, line: u32) -> bool {
        self.bends.binary_search_by_key(&line, |b| b.line).is_ok()
    }
}

/// Whether a part can be made from one piece by bending alone; each component from one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum OnePiece {
    /// It can; the assignment says how.
    Yes,
    /// Its lines do not bear so many bends (eq. 10, exactly).
    TooFewBends {
        /// Plates that it takes at least.
        pieces: usize,
        /// Whether that is proved; else no better way was found.
        proved: bool,
    },
    /// Its lines would, but every flat sheet tried lies on itself.
    Overlaps {
        /// Flat sheets tried.
        tried: usize,
    },
}

/// What a sheet's topology tells.
#[derive(Clone, Debug, PartialEq)]
pub struct BendAnalysis {
    /// Counts, lines classed as in the first assignment.
    pub counts: SheetCounts,
    /// Bends and welds more than hold the part together: `d = v − e + g_nm − m` (eq. 9).
    pub redundant: i64,
    /// Bends and welds that it takes at least: `f − s` (eq. 8).
    pub least_joints: i64,
    /// Bends that its lines bear at most: the sum of `⌊f_line / 2⌋` (eq. 10).
    pub most_bends: i64,
    /// Operators that build it: `P · M⁻¹`.
    pub plan: Option<SheetPlan>,
    /// Whether bending alone makes it.
    pub one_piece: OnePiece,
    /// Ways to make it, the best first: with few plates, without overlaps, with short welds.
    pub assignments: Vec<Assignment>,
    /// Flat sheets tried.
    pub tried: usize,
}

/// Other ways are looked for in so many orders of the lines, …
const VARIATIONS: usize = 12;

/// … and so many of them kept.
const KEPT: usize = 6;

/// Counts a sheet and looks for ways to make it. O(facets + lines) a flat sheet tried.
///
/// # Errors
/// [`UnfoldError`] where facets leave nothing to bend; curved facets are analysed without being laid flat.
pub fn analyse(sheet: &FacetSheet, effort: Effort) -> Result<BendAnalysis, UnfoldError> {
    let joins = joins(sheet);
    let counts = sheet.counts(|_| true);
    let enough = spanning_size(&counts);
    let maker = Maker { sheet, joins: &joins };
    let (mut ways, mut tried) = (Vec::new(), 0);
    let largest;
    match Flattening::new(sheet, &joins, &Metal::default()) {
        Ok(flat) => {
            let mut best = true;
            for per_line in [PerLine::Matching, PerLine::One] {
                let mut search = Search::new(&flat, per_line, enough, effort);
                let found = search.run()?;
                tried += found.tried;
                if best {
                    best = found.forest.largest;
                }
                ways.push(maker.assignment(&found.forest, Some(found.overlaps.len())));
            }
            largest = best;
            let search = Search::new(&flat, PerLine::Matching, enough, effort);
            for attempt in 1..VARIATIONS {
                for per_line in [PerLine::Matching, PerLine::One] {
                    let forest =
                        largest_forest(&joins, sheet.facets.len(), &search.order(attempt), per_line, enough);
                    let overlaps = flat.overlaps(&flat.lay(&forest.joins)?).len();
                    tried += 1;
                    if overlaps == 0 {
                        ways.push(maker.assignment(&forest, Some(0)));
                    }
                }
            }
        }
        Err(UnfoldError::Curved { .. }) => {
            let mut order: Vec<u32> = (0..joins.len() as u32).collect();
            let length = |j: &u32| sheet.lines[joins[*j as usize].line as usize].length;
            order.sort_by(|a, b| length(b).total_cmp(&length(a)).then(a.cmp(b)));
            let forests = [PerLine::Matching, PerLine::One]
                .map(|per_line| largest_forest(&joins, sheet.facets.len(), &order, per_line, enough));
            largest = forests[0].largest;
            ways.extend(forests.iter().map(|f| maker.assignment(f, None)));
        }
        Err(error) => return Err(error),
    }
    let first = ways[0].clone();
    let pieces = counts.s.max(0) as usize;
    let one_piece = if first.pieces > pieces {
        OnePiece::TooFewBends { pieces: first.pieces, proved: largest }
    } else if first.overlaps.is_none_or(|o| o == 0) {
        OnePiece::Yes
    } else {
        OnePiece::Overlaps { tried }
    };
    let mut assignments: Vec<Assignment> = Vec::new();
    for way in ways {
        if !assignments.contains(&way) {
            assignments.push(way);
        }
    }
    assignments[1..].sort_by_key(|a| (a.pieces, a.overlaps));
    // The best of every number of plates first, so that none is crowded out.
    let mut seen = Vec::new();
    let (mut kept, mut more) = (Vec::new(), Vec::new());
    for way in assignments {
        if seen.contains(&way.pieces) {
            more.push(way)
        } else {
            seen.push(way.pieces);
            kept.push(way)
        }
    }
    kept.extend(more);
    kept.truncate(KEPT);
    let counts = sheet.counts(|line| kept[0].bends_at(line));
    Ok(BendAnalysis {
        redundant: counts.redundant_joints(),
        least_joints: counts.f - counts.s,
        most_bends: sheet.lines.iter().map(|l| (l.uses.len() / 2) as i64).sum(),
        plan: counts.plan(),
        counts,
        one_piece,
        assignments: kept,
        tried,
    })
}

struct Maker<'a> {
    sheet: &'a FacetSheet,
    joins: &'a [Join],
}

impl Maker<'_> {
    /// A forest of bends, and the welds that it leaves.
    fn assignment(&self, forest: &Forest, overlaps: Option<usize>) -> Assignment {
        let facets = self.sheet.facets.len();
        let mut roots = Roots::new(facets);
        let mut bends: Vec<BendLine> = forest
            .joins
            .iter()
            .map(|&j| {
                let join = &self.joins[j as usize];
                roots.union(join.facets[0], join.facets[1]);
                BendLine { line: join.line, facets: join.facets }
            })
            .collect();
        bends.sort_unstable();
        let pieces = facets - forest.joins.len();
        let mut lines: Vec<u32> = (0..self.sheet.lines.len() as u32).collect();
        let length = |l: &u32| self.sheet.lines[*l as usize].length;
        lines.sort_by(|a, b| length(b).total_cmp(&length(a)).then(a.cmp(b)));
        let (mut welds, mut needed_welds) = (Vec::new(), 0);
        for line in lines {
            let uses = &self.sheet.lines[line as usize].uses;
            if uses.len() < 2 {
                continue;
            }
            let mut there: Vec<u32> = uses.iter().map(|u| u.facet).collect();
            there.sort_unstable();
            there.dedup();
            let bent = bends.iter().filter(|b| b.line == line).count();
            let needed = there[1..].iter().filter(|f| roots.union(there[0], **f)).count();
            needed_welds += needed;
            let count = there.len().saturating_sub(1 + bent);
            if count > 0 {
                welds.push(WeldLine { line, welds: count, needed });
            }
        }
        welds.sort_unstable();
        Assignment { bends, welds, pieces, needed_welds, overlaps }
    }
}
