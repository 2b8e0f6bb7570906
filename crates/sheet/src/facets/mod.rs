//! Facets, lines and vertices of a sheet: what Lipson & Shpitalni count (sections 3 and 4).
//!
//! A sheet's file holds triangles. A *facet* is a part of the sheet in one piece, between *lines*: plane, or a whole patch of
//! the file. A line is a straight run of edges with the same facets on it (a curved one where a facet is curved); one with a
//! single facet is a free edge, the others are bends or welds. *Vertices* are the ends of lines.
//!
//! How finely the sheet is triangulated does not matter: a wall of a thousand triangles is one facet.

mod error;
mod lines;
mod loops;
mod regions;

pub use error::FacetError;

use std::collections::BTreeSet;

use glam::DVec3;
use mesh_kernel::body::Body;
use mesh_kernel::complex::SheetCounts;
use mesh_kernel::{Group, TriMesh};

use crate::cleaning::{FLAT, doubles, patch_of_faces, weld};

/// Nodes of a facet may be off its plane by this share of the sheet's diagonal: files round coordinates to a millionth.
pub const PLANE_TOLERANCE: f64 = 2e-6;

/// What is one facet.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum FacetRule {
    /// [`Self::Patches`] for a sheet of two groups and more, else [`Self::Planes`].
    #[default]
    Auto,
    /// Every connected part of a group, plane or curved.
    Patches,
    /// Every connected part of a group that lies in one plane.
    Planes,
}

/// A facet.
#[derive(Clone, Debug, PartialEq)]
pub struct Facet {
    /// Name of its group, with a number where the group has several facets.
    pub name: String,
    /// The group of the sheet; the number of groups for faces in none.
    pub group: u32,
    /// Outer loop first, then hole loops; the facet lies to the left of its sides, seen from the tip of its normal.
    pub loops: Vec<Vec<Side>>,
    /// Unit normal, that of the largest triangle where the facet is curved.
    pub normal: DVec3,
    /// Whether it lies in a plane.
    pub plane: bool,
    /// Its triangles.
    pub triangles: Vec<u32>,
    /// Area.
    pub area: f64,
}

/// A line of a facet's loop.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Side {
    /// The line.
    pub line: u32,
    /// Whether the loop walks it from its first node to its last.
    pub along: bool,
}

/// A facet at a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct LineUse {
    /// The facet.
    pub facet: u32,
    /// Whether its loop walks the line from its first node to its last.
    pub along: bool,
}

/// A line.
#[derive(Clone, Debug, PartialEq)]
pub struct Line {
    /// Nodes from end to end.
    pub nodes: Vec<u32>,
    /// Facets there.
    pub uses: Vec<LineUse>,
    /// Whether it is straight; only straight lines bend.
    pub straight: bool,
    /// Length.
    pub length: f64,
}

impl Line {
    /// Its two ends.
    pub fn ends(&self) -> [u32; 2] {
        [self.nodes.first().copied().unwrap_or_default(), self.nodes.last().copied().unwrap_or_default()]
    }

    /// Whether it is a free edge.
    pub fn is_free(&self) -> bool {
        self.uses.len() < 2
    }
}

/// A sheet as facets, lines and vertices.
#[derive(Clone, Debug, PartialEq)]
pub struct FacetSheet {
    /// Nodes, one in a place.
    pub positions: Vec<DVec3>,
    /// Triangles, turned so that all of a facet are seen anticlockwise from the tip of its normal.
    pub triangles: Vec<[u32; 3]>,
    /// The facets, in the order of their first triangles.
    pub facets: Vec<Facet>,
    /// The lines, in the order of their first nodes.
    pub lines: Vec<Line>,
    /// Nodes that are ends of lines, ascending.
    pub vertices: Vec<u32>,
    /// Length of the bounding box's diagonal.
    pub size: f64,
    /// The facets' rule, never [`FacetRule::Auto`].
    pub rule: FacetRule,
    /// Components, holes (Ch) and volumes (Cc) as the kernel finds them on the triangles.
    topology: [i64; 3],
}

impl FacetSheet {
    /// Finds facets, lines and vertices. Doubled triangles and those without an area are left out; groups may be wound as they
    /// like. O(n log n) in triangles.
    ///
    /// # Errors
    /// [`FacetError`].
    pub fn new(mesh: &TriMesh, rule: FacetRule) -> Result<Self, FacetError> {
        let clean = clean(mesh)?;
        let patches = patch_of_faces(mesh);
        let groups: Vec<u32> = clean.sources.iter().map(|&f| patches[f as usize]).collect();
        let distinct: BTreeSet<u32> = groups.iter().copied().collect();
        let rule = match rule {
            FacetRule::Auto if distinct.len() > 1 => FacetRule::Patches,
            FacetRule::Auto => FacetRule::Planes,
            other => other,
        };
        let size = clean.mesh.bounds().map_or(0.0, |[lo, hi]| (hi - lo).length());
        let edges = regions::Edges::new(&clean.mesh.faces);
        let regions = regions::Regions::grow(&clean.mesh, &edges, &groups, rule, size * PLANE_TOLERANCE);
        let body = Body::from_tri_mesh(&grouped(&clean.mesh, &regions))?;
        let counts = body.counts();
        let mut triangles = clean.mesh.faces;
        regions.turn(&mut triangles);
        let named = names(mesh, &groups, &regions);
        if let Some(node) = regions.one_sided(&triangles, &edges) {
            let facet = named[node.1 as usize].clone();
            return Err(FacetError::OneSided { facet, at: clean.mesh.positions[node.0 as usize] });
        }
        let shape = lines::Shape { positions: &clean.mesh.positions, triangles: &triangles, edges: &edges };
        let traced = lines::trace(&shape, &regions);
        let doubled = traced.lines.iter().flat_map(|l| l.uses.windows(2)).find(|w| w[0] == w[1]);
        if let Some(twice) = doubled {
            return Err(FacetError::NotAFacet { facet: named[twice[0].facet as usize].clone() });
        }
        let loops = loops::walk(&shape, &regions, &traced);
        let mut sheet = Self {
            facets: Vec::with_capacity(regions.count),
            vertices: traced.vertices,
            lines: traced.lines,
            positions: clean.mesh.positions,
            triangles,
            size,
            rule,
            topology: [counts.c, counts.ch, counts.cc],
        };
        for (facet, loops) in loops.into_iter().enumerate() {
            let facet = sheet.facet(facet as u32, named[facet].clone(), &groups, &regions, loops)?;
            sheet.facets.push(facet);
        }
        if sheet.counts(|_| true).identity_holds() {
            return Ok(sheet);
        }
        // A facet with handles breaks the identity; only curved ones can have them.
        let curved = sheet.facets.iter().find(|f| !f.plane).or(sheet.facets.first());
        Err(FacetError::NotAFacet { facet: curved.map_or_else(String::new, |f| f.name.clone()) })
    }

    fn facet(
        &self,
        number: u32,
        name: String,
        groups: &[u32],
        regions: &regions::Regions,
        mut loops: Vec<Vec<Side>>,
    ) -> Result<Facet, FacetError> {
        let triangles: Vec<u32> =
            (0..self.triangles.len() as u32).filter(|&t| regions.of[t as usize] == number).collect();
        if loops.is_empty() {
            return Err(FacetError::NotAFacet { facet: name });
        }
        let area_normal = |t: u32| {
            let [a, b, c] = self.triangles[t as usize].map(|v| self.positions[v as usize]);
            (b - a).cross(c - a) / 2.0
        };
        let largest = triangles.iter().copied().max_by(|a, b| {
            area_normal(*a).length_squared().total_cmp(&area_normal(*b).length_squared()).then(b.cmp(a))
        });
        let plane = regions.plane[number as usize];
        let sum: DVec3 = triangles.iter().map(|&t| area_normal(t)).sum();
        let normal = if plane { sum } else { largest.map_or(sum, area_normal) }.normalize_or_zero();
        // The outer loop goes round most, seen from the normal.
        let around = |sides: &[Side]| self.area_vector(sides).dot(normal);
        if let Some(outer) =
            (0..loops.len()).max_by(|&a, &b| around(&loops[a]).total_cmp(&around(&loops[b])).then(b.cmp(&a)))
        {
            loops.swap(0, outer);
        }
        let area = triangles.iter().map(|&t| area_normal(t).length()).sum();
        let group = triangles.first().map_or(0, |&t| groups[t as usize]);
        Ok(Facet { name, group, loops, normal, plane, triangles, area })
    }

    /// Nodes of a loop, each once.
    pub fn loop_nodes(&self, sides: &[Side]) -> Vec<u32> {
        let mut nodes = Vec::new();
        for side in sides {
            let line = &self.lines[side.line as usize].nodes;
            let inner = line.len().saturating_sub(1);
            if side.along {
                nodes.extend(&line[..inner]);
            } else {
                nodes.extend(line[1..].iter().rev());
            }
        }
        nodes
    }

    /// Twice the area vector of a loop.
    fn area_vector(&self, sides: &[Side]) -> DVec3 {
        let at: Vec<DVec3> = self.loop_nodes(sides).into_iter().map(|v| self.positions[v as usize]).collect();
        let Some(&o) = at.first() else { return DVec3::ZERO };
        at.windows(2).map(|w| (w[0] - o).cross(w[1] - o)).sum()
    }

    /// Where a line begins and ends.
    pub fn line_ends(&self, line: u32) -> [DVec3; 2] {
        self.lines[line as usize].ends().map(|v| self.positions[v as usize])
    }

    /// Lipson & Shpitalni's counts, every line with two facets and more given a class: `bends` tells which bend.
    ///
    /// Both sides of the identity are found independently: facets, lines and vertices are counted here; components, holes and
    /// volumes come from union–find, ranks over GF(2) and the radial order of the triangles.
    pub fn counts(&self, bends: impl Fn(u32) -> bool) -> SheetCounts {
        let free = self.lines.iter().filter(|l| l.is_free()).count();
        let bent =
            (0..self.lines.len() as u32).filter(|&l| !self.lines[l as usize].is_free() && bends(l)).count();
        let rings: usize = self.facets.iter().map(|f| f.loops.len() - 1).sum();
        let [s, ch, m] = self.topology;
        SheetCounts {
            s,
            b: bent as i64,
            e: free as i64,
            w: (self.lines.len() - free - bent) as i64,
            v: self.vertices.len() as i64,
            g_nm: ch - rings as i64,
            m,
            f: self.facets.len() as i64,
        }
    }

    /// How many hole loops lie inside facets.
    pub fn rings(&self) -> usize {
        self.facets.iter().map(|f| f.loops.len() - 1).sum()
    }
}

struct Clean {
    mesh: TriMesh,
    /// Face of the input.
    sources: Vec<u32>,
}

fn clean(mesh: &TriMesh) -> Result<Clean, FacetError> {
    if let Some(node) = mesh.positions.iter().position(|p| !p.is_finite()) {
        return Err(FacetError::NotFinite { node: node as u32 });
    }
    let (positions, node) = weld(&mesh.positions);
    let doubled = doubles(mesh, &node);
    let (mut faces, mut sources) = (Vec::new(), Vec::new());
    for (f, corners) in mesh.faces.iter().enumerate() {
        let [a, b, c] = mesh.corners(f as u32);
        let longest = (b - a).length_squared().max((c - b).length_squared()).max((a - c).length_squared());
        if !doubled[f] && mesh.area_normal(f as u32).length() > FLAT * longest {
            faces.push(corners.map(|v| node[v as usize]));
            sources.push(f as u32);
        }
    }
    if faces.is_empty() {
        return Err(FacetError::Empty);
    }
    Ok(Clean { mesh: TriMesh::new(positions, faces), sources })
}

/// The triangles with a group a facet, for the kernel.
fn grouped(mesh: &TriMesh, regions: &regions::Regions) -> TriMesh {
    let mut order: Vec<u32> = (0..mesh.faces.len() as u32).collect();
    order.sort_by_key(|&f| (regions.of[f as usize], f));
    let mut out =
        TriMesh::new(mesh.positions.clone(), order.iter().map(|&f| mesh.faces[f as usize]).collect());
    let mut first = 0;
    for same in order.chunk_by(|a, b| regions.of[*a as usize] == regions.of[*b as usize]) {
        let end = first + same.len() as u32;
        out.groups.push(Group { name: String::new(), faces: first..end });
        first = end;
    }
    out
}

/// A name for every facet.
fn names(mesh: &TriMesh, groups: &[u32], regions: &regions::Regions) -> Vec<String> {
    let mut group_of = vec![0; regions.count];
    for (t, &r) in regions.of.iter().enumerate() {
        group_of[r as usize] = groups[t];
    }
    let mut seen = vec![0usize; mesh.groups.len() + 1];
    let total = |g: u32| group_of.iter().filter(|x| **x == g).count();
    let name_of = |g: u32| match mesh.groups.get(g as usize) {
        Some(group) if !group.name.is_empty() => group.name.clone(),
        _ => "facet".to_owned(),
    };
    let mut many: Vec<Option<bool>> = vec![None; mesh.groups.len() + 1];
    group_of
        .iter()
        .map(|&g| {
            let slot = (g as usize).min(mesh.groups.len());
            seen[slot] += 1;
            let several = *many[slot].get_or_insert_with(|| total(g) > 1);
            if several { format!("{}-{}", name_of(g), seen[slot]) } else { name_of(g) }
        })
        .collect()
}
