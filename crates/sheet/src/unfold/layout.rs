//! Where facets lie on the flat sheet, given which joins bend.

use std::collections::BTreeMap;

use glam::DVec2;

use super::allowance::{BendMeasures, Metal};
use super::shape::{FacetShape, TrimmedSide, corners, triangulate, trimmed};
use super::{UnfoldError, overlap};
use crate::bends::Join;
use crate::facets::{FacetSheet, Side};

/// A rigid place in the plane, perhaps upside down.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Placement {
    /// Where the facet's own x axis points.
    axis: DVec2,
    shift: DVec2,
    /// Whether the facet's back is up.
    pub(crate) mirrored: bool,
}

impl Placement {
    const HOME: Self = Self { axis: DVec2::X, shift: DVec2::ZERO, mirrored: false };

    pub(crate) fn apply(&self, p: DVec2) -> DVec2 {
        let p = if self.mirrored { DVec2::new(p.x, -p.y) } else { p };
        self.axis.rotate(p) + self.shift
    }
}

/// A join that is bent.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Bent {
    pub(crate) join: u32,
    pub(crate) measures: BendMeasures,
    /// Whether the second facet turns toward the first one's front.
    pub(crate) to_front: bool,
}

/// Facets laid flat.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    /// Place of every facet.
    pub(crate) placements: Vec<Placement>,
    /// The piece that each facet belongs to, numbered by their largest facets.
    pub(crate) piece: Vec<u32>,
    pub(crate) pieces: usize,
    /// Bends of the forest, then those that close on their own.
    pub(crate) bends: Vec<Bent>,
    /// Trimmed loops of every facet, in its own plane.
    pub(crate) trimmed: Vec<Vec<Vec<TrimmedSide>>>,
    /// The bend at a side of a facet.
    pub(crate) bend_at: BTreeMap<(u32, Side), u32>,
}

/// What does not change while forests are tried.
pub(crate) struct Flattening<'a> {
    pub(crate) sheet: &'a FacetSheet,
    pub(crate) joins: &'a [Join],
    pub(crate) shapes: Vec<FacetShape>,
    /// Measures of every join's bend; `None` where it cannot be bent with this metal.
    pub(crate) measures: Vec<Option<Bent>>,
    pub(crate) tolerance: f64,
    /// Triangles of whole facets.
    whole: Vec<Vec<[DVec2; 3]>>,
    /// Facets, the largest first.
    by_area: Vec<u32>,
}

impl<'a> Flattening<'a> {
    pub(crate) fn new(sheet: &'a FacetSheet, joins: &'a [Join], metal: &Metal) -> Result<Self, UnfoldError> {
        metal.check()?;
        let facets = 0..sheet.facets.len() as u32;
        let shapes: Vec<FacetShape> =
            facets.clone().map(|f| FacetShape::new(sheet, f)).collect::<Result<_, _>>()?;
        let measures = (0..joins.len() as u32).map(|j| bent(sheet, joins, metal, j)).collect();
        let whole = shapes.iter().map(|s| {
            let loops: Vec<Vec<DVec2>> =
                s.loops.iter().map(|l| l.iter().map(|side| side.from).collect()).collect();
            triangulate(&loops)
        });
        let mut by_area: Vec<u32> = facets.collect();
        by_area.sort_by(|a, b| {
            let area = |f: &u32| sheet.facets[*f as usize].area;
            area(b).total_cmp(&area(a)).then(a.cmp(b))
        });
        Ok(Self {
            whole: whole.collect(),
            tolerance: sheet.size * crate::facets::PLANE_TOLERANCE,
            sheet,
            joins,
            shapes,
            measures,
            by_area,
        })
    }

    fn side(&self, join: &Join, which: usize) -> Side {
        let u = self.sheet.lines[join.line as usize].uses[join.uses[which] as usize];
        Side { line: join.line, along: u.along }
    }

    /// The ends of a line on a facet in its own plane, from the line's first node to its last.
    fn line_on(&self, facet: u32, side: Side) -> [DVec2; 2] {
        let all = self.shapes[facet as usize].loops.iter().flatten();
        let flat = all.into_iter().find(|s| s.side == side);
        flat.map_or([DVec2::ZERO; 2], |s| if side.along { [s.from, s.to] } else { [s.to, s.from] })
    }

    /// Where a facet comes to lie beyond a bend.
    fn beyond(&self, join: u32, from: usize, placed: &Placement) -> Placement {
        let j = &self.joins[join as usize];
        let [a, b] = [from, 1 - from].map(|k| (j.facets[k], self.side(j, k)));
        let [l0, l1] = self.line_on(a.0, a.1).map(|p| placed.apply(p));
        let along = (l1 - l0).normalize_or_zero();
        let a_is_left = a.1.along != placed.mirrored;
        let outward = if a_is_left { -along.perp() } else { along.perp() };
        let gap = self.measures[join as usize].map_or(0.0, |m| m.measures.gap());
        let mirrored = b.1.along == a_is_left;
        let flip = |p: DVec2| if mirrored { DVec2::new(p.x, -p.y) } else { p };
        let [m0, m1] = self.line_on(b.0, b.1).map(flip);
        let own = (m1 - m0).normalize_or_zero();
        // Divides one direction by the other.
        let axis = DVec2::new(own.x, -own.y).rotate(along).normalize_or(DVec2::X);
        let shift = (l0 + l1) / 2.0 + outward * gap - axis.rotate((m0 + m1) / 2.0);
        Placement { axis, shift, mirrored }
    }

    /// Lays all facets flat. O(facets + lines).
    pub(crate) fn lay(&self, forest: &[u32]) -> Result<Layout, UnfoldError> {
        let n = self.sheet.facets.len();
        let mut at: Vec<Vec<(usize, u32)>> = vec![Vec::new(); n];
        for &j in forest {
            for k in 0..2 {
                at[self.joins[j as usize].facets[k] as usize].push((k, j));
            }
        }
        let mut piece = vec![u32::MAX; n];
        let mut placements = vec![Placement::HOME; n];
        let mut pieces = 0;
        let mut queue = std::collections::VecDeque::new();
        for &root in &self.by_area {
            if piece[root as usize] != u32::MAX {
                continue;
            }
            piece[root as usize] = pieces;
            queue.push_back(root);
            while let Some(f) = queue.pop_front() {
                for &(k, j) in &at[f as usize] {
                    let next = self.joins[j as usize].facets[1 - k];
                    if piece[next as usize] == u32::MAX {
                        piece[next as usize] = pieces;
                        placements[next as usize] = self.beyond(j, k, &placements[f as usize]);
                        queue.push_back(next);
                    }
                }
            }
            pieces += 1;
        }
        let mut layout = Layout {
            placements,
            piece,
            pieces: pieces as usize,
            bends: forest.iter().filter_map(|&j| self.measures[j as usize]).collect(),
            trimmed: Vec::new(),
            bend_at: BTreeMap::new(),
        };
        for k in 0..layout.bends.len() {
            self.enter(&mut layout, k);
        }
        self.close(&mut layout);
        layout.trimmed = (0..n as u32)
            .map(|f| {
                let setback = |side: Side| {
                    let bend = layout.bend_at.get(&(f, side));
                    bend.map_or(0.0, |&b| layout.bends[b as usize].measures.setback)
                };
                trimmed(&self.shapes[f as usize], setback, &self.sheet.facets[f as usize].name)
            })
            .collect::<Result<_, _>>()?;
        Ok(layout)
    }

    fn enter(&self, layout: &mut Layout, bend: usize) {
        let j = &self.joins[layout.bends[bend].join as usize];
        for k in 0..2 {
            layout.bend_at.insert((j.facets[k], self.side(j, k)), bend as u32);
        }
    }

    /// Bends what lies side by side on the flat sheet anyway, so that it need not be cut and welded: round a hole, or round a
    /// vertex where everything is flat.
    fn close(&self, layout: &mut Layout) {
        for (number, j) in (0..).zip(self.joins) {
            let Some(measures) = self.measures[number as usize] else { continue };
            let [a, b] = j.facets;
            let taken = (0..2).any(|k| layout.bend_at.contains_key(&(j.facets[k], self.side(j, k))));
            if taken || layout.piece[a as usize] != layout.piece[b as usize] {
                continue;
            }
            let wanted = self.beyond(number, 0, &layout.placements[a as usize]);
            let found = layout.placements[b as usize];
            let line = self.line_on(b, self.side(j, 1));
            let near = |p: DVec2| wanted.apply(p).distance(found.apply(p)) <= self.tolerance;
            if wanted.mirrored == found.mirrored && line.into_iter().all(near) {
                layout.bends.push(measures);
                self.enter(layout, layout.bends.len() - 1);
            }
        }
    }

    /// The strip that a bend takes on the flat sheet: along the first facet's line, then back along the second's.
    pub(crate) fn strip(&self, layout: &Layout, bend: u32) -> [DVec2; 4] {
        let j = &self.joins[layout.bends[bend as usize].join as usize];
        let ends = [0, 1].map(|k| {
            let (f, side) = (j.facets[k], self.side(j, k));
            let shape = self.shapes[f as usize].loops.iter().flatten();
            let left = layout.trimmed[f as usize].iter().flatten();
            let found = shape.zip(left).find(|(s, _)| s.side == side).map(|(_, t)| [t.from, t.to]);
            let [from, to] = found.unwrap_or_default().map(|p| layout.placements[f as usize].apply(p));
            if side.along { [from, to] } else { [to, from] }
        });
        let [[a0, a1], [b0, b1]] = ends;
        [a0, a1, b1, b0]
    }

    /// Pairs of facets of one piece that lie on each other, each pair once; strips count for their first facet.
    pub(crate) fn overlaps(&self, layout: &Layout) -> Vec<[u32; 2]> {
        let mut tiles = Vec::new();
        let mut add = |owner: u32, piece: u32, triangle: [DVec2; 3]| {
            tiles.push(overlap::Tile::new(owner, piece, triangle));
        };
        for f in 0..self.sheet.facets.len() as u32 {
            let (place, piece) = (layout.placements[f as usize], layout.piece[f as usize]);
            let bent = layout
                .bends
                .iter()
                .any(|b| b.measures.setback != 0.0 && self.joins[b.join as usize].facets.contains(&f));
            let cut;
            let triangles = if bent {
                let loops: Vec<Vec<DVec2>> = layout.trimmed[f as usize].iter().map(|l| corners(l)).collect();
                cut = triangulate(&loops);
                &cut
            } else {
                &self.whole[f as usize]
            };
            for t in triangles {
                add(f, piece, t.map(|p| place.apply(p)));
            }
        }
        for b in 0..layout.bends.len() as u32 {
            let bend = &layout.bends[b as usize];
            if bend.measures.allowance > 0.0 {
                let [a0, a1, b1, b0] = self.strip(layout, b);
                let f = self.joins[bend.join as usize].facets[0];
                let piece = layout.piece[f as usize];
                add(f, piece, [a0, a1, b1]);
                add(f, piece, [a0, b1, b0]);
            }
        }
        overlap::pairs(tiles, self.tolerance)
    }
}

/// The bend of a join.
fn bent(sheet: &FacetSheet, joins: &[Join], metal: &Metal, number: u32) -> Option<Bent> {
    let j = &joins[number as usize];
    let [a, b] = [0, 1].map(|k| sheet.lines[j.line as usize].uses[j.uses[k] as usize]);
    let [from, to] = sheet.line_ends(j.line);
    let along = if a.along { to - from } else { from - to };
    let front = sheet.facets[a.facet as usize].normal;
    let other = sheet.facets[b.facet as usize].normal;
    let other = if a.along == b.along { -other } else { other };
    let turn = front.cross(other);
    let mut angle = turn.length().atan2(front.dot(other));
    // Facets that lie flat within what rounding does are not bent at all.
    if angle < FLAT_ANGLE {
        angle = 0.0;
    }
    let measures = metal.bend(angle)?;
    Some(Bent { join: number, measures, to_front: along.dot(turn) <= 0.0 })
}

/// Smaller angles between facets, in radians, are rounding of coordinates.
const FLAT_ANGLE: f64 = 1e-6;
