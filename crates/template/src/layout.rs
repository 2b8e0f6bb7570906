//! The template written out: twins made, halves joined at the centre, names turned into indices. Knows no body.

use std::collections::{BTreeMap, BTreeSet};

use crate::error::TemplateError;
use crate::format::{
    At, EaseSpec, Grain, Interior, JointSpec, Level, LineSpec, NodeSpec, PieceSpec, Shape, SurfaceSpec,
    TemplateFile,
};

/// A template node.
#[derive(Clone, Debug)]
pub(crate) struct LayoutNode {
    pub(crate) name: String,
    /// As written, or with left and right swapped for a twin that was made.
    pub(crate) spec: NodeSpec,
    /// The mirror image: itself on the centre plane, `None` without mirroring.
    pub(crate) twin: Option<u32>,
    /// This node was made as the mirror image of that one.
    pub(crate) made_from: Option<u32>,
}

/// A face as it was written; quads are split when positions are known. Turns anticlockwise seen from outside.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Cell {
    Triangle([u32; 3]),
    /// Corners in turn; the diagonal 0–2 is taken unless 1–3 is clearly better.
    Quad([u32; 4]),
}

/// A patch over template nodes.
#[derive(Clone, Debug)]
pub(crate) struct LayoutSurface {
    pub(crate) name: String,
    /// The cells as listed; a mirrored half is added when quads have been split.
    pub(crate) cells: Vec<Cell>,
    pub(crate) across_centre: bool,
    pub(crate) interior: Interior,
    pub(crate) layer: u8,
    /// Lines along which the patch is slit.
    pub(crate) open_along: Vec<u32>,
    /// The mirror image: itself when it lies across the centre.
    pub(crate) twin: Option<u32>,
    /// This surface was made as the mirror image of that one.
    pub(crate) made_from: Option<u32>,
    pub(crate) piece: Option<PieceSpec>,
}

/// A line on a chain of template edges.
#[derive(Clone, Debug)]
pub(crate) struct LayoutLine {
    pub(crate) name: String,
    pub(crate) nodes: Vec<u32>,
    pub(crate) closed: bool,
    pub(crate) shape: Option<Shape>,
    pub(crate) corners: Vec<u32>,
    pub(crate) continues: Option<u32>,
    pub(crate) hold: Option<bool>,
}

/// An ease level.
#[derive(Clone, Debug)]
pub(crate) struct LayoutEase {
    pub(crate) name: String,
    pub(crate) spec: EaseSpec,
    pub(crate) surfaces: Vec<u32>,
}

/// The whole template, written out.
#[derive(Clone, Debug)]
pub(crate) struct Layout {
    pub(crate) mirrored: bool,
    pub(crate) symmetric: bool,
    pub(crate) nodes: Vec<LayoutNode>,
    pub(crate) surfaces: Vec<LayoutSurface>,
    pub(crate) lines: Vec<LayoutLine>,
    pub(crate) groups: Vec<Vec<u32>>,
    pub(crate) ease: Vec<LayoutEase>,
    pub(crate) joints: Option<Vec<JointSpec>>,
}

/// `left_` and `right_` swapped; `None` for a name that has no side.
pub(crate) fn swap_side(name: &str) -> Option<String> {
    if let Some(rest) = name.strip_prefix("left_") {
        return Some(format!("right_{rest}"));
    }
    name.strip_prefix("right_").map(|rest| format!("left_{rest}"))
}

/// A feature's name on the other side; features without a side are their own.
fn swap_feature(name: &str) -> String {
    swap_side(name).unwrap_or_else(|| name.to_string())
}

/// Twin's name of a named thing of the template, given which names are marked `"mirror": true`.
fn twin_name(name: &str, marked: &BTreeSet<&str>) -> Option<String> {
    if let Some(swapped) = swap_side(name) {
        if name.starts_with("right_") && marked.contains(&name["right_".len()..]) {
            return Some(name["right_".len()..].to_string());
        }
        return Some(swapped);
    }
    marked.contains(name).then(|| format!("right_{name}"))
}

fn known<T>(file: &TemplateFile, map: &BTreeMap<String, T>, marked: impl Fn(&T) -> bool, name: &str) -> bool {
    if map.contains_key(name) {
        return true;
    }
    let Some(rest) = name.strip_prefix("right_").filter(|_| file.mirrored) else { return false };
    map.contains_key(&format!("left_{rest}")) || map.get(rest).is_some_and(marked)
}

pub(crate) fn node_known(file: &TemplateFile, name: &str) -> bool {
    known(file, &file.nodes, |n| n.mirror, name)
}

pub(crate) fn surface_known(file: &TemplateFile, name: &str) -> bool {
    known(file, &file.surfaces, |s| s.mirror, name)
}

pub(crate) fn line_known(file: &TemplateFile, name: &str) -> bool {
    known(file, &file.lines, |l| l.mirror, name)
}

/// The names of one kind of thing with their twins, in the file's (alphabetical) order, and who was made from whom.
struct Names {
    index: BTreeMap<String, u32>,
    /// name, twin, made from
    entries: Vec<(String, Option<u32>, Option<u32>)>,
}

impl Names {
    fn new<'a>(file: &TemplateFile, names: impl Iterator<Item = (&'a String, bool, bool)> + Clone) -> Self {
        let marked: BTreeSet<&str> = names.clone().filter(|n| n.1).map(|n| n.0.as_str()).collect();
        let mut index = BTreeMap::new();
        let mut entries: Vec<(String, Option<u32>, Option<u32>)> = Vec::new();
        for (name, ..) in names.clone() {
            index.insert(name.clone(), entries.len() as u32);
            entries.push((name.clone(), None, None));
        }
        if file.mirrored {
            for (i, (name, _, own)) in names.enumerate() {
                if own {
                    entries[i].1 = Some(i as u32);
                    continue;
                }
                let Some(twin) = twin_name(name, &marked) else { continue };
                let t = *index.entry(twin.clone()).or_insert_with(|| {
                    entries.push((twin, Some(i as u32), Some(i as u32)));
                    entries.len() as u32 - 1
                });
                entries[i].1 = Some(t);
            }
        }
        Self { index, entries }
    }

    fn find(&self, name: &str, path: impl Fn() -> String, what: &str) -> Result<u32, TemplateError> {
        self.index.get(name).copied().ok_or_else(|| {
            // Whoever writes names beyond a line's length is not helped by a guess that takes long.
            let mut near: Vec<&String> =
                self.index.keys().filter(|k| k.len().max(name.len()) <= 100).collect();
            near.sort_by_cached_key(|k| distance(k, name));
            let hint = near.first().map(|n| format!("; did you mean `{n}`?")).unwrap_or_default();
            TemplateError::format(path(), format!("there is no {what} `{name}`{hint}"))
        })
    }
}

/// Edit distance, for hints. O(n·m) on short names.
fn distance(a: &str, b: &str) -> usize {
    let b: Vec<char> = b.chars().collect();
    let mut row: Vec<usize> = (0..=b.len()).collect();
    for (i, ca) in a.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = i + 1;
        for (j, cb) in b.iter().enumerate() {
            let substitute = diagonal + usize::from(ca != *cb);
            diagonal = row[j + 1];
            row[j + 1] = substitute.min(diagonal + 1).min(row[j] + 1);
        }
    }
    row[b.len()]
}

fn mirrored_node(spec: &NodeSpec, names: &Names) -> NodeSpec {
    let node = |name: &String| {
        let at = names.index.get(name).and_then(|i| names.entries[*i as usize].1);
        at.map_or_else(|| name.clone(), |t| names.entries[t as usize].0.clone())
    };
    let mut out = spec.clone();
    out.mirror = false;
    out.at = spec.at.as_ref().map(|at| match at {
        At::Crossing([a, b]) => At::Crossing([swap_feature(a), swap_feature(b)]),
        At::Point(p) => At::Point(swap_feature(p)),
    });
    out.between = spec.between.as_ref().map(|[a, b]| [node(a), node(b)]);
    out.axes = spec.axes.map(|[x, y, z]| [-x, y, z]);
    if let Some(slide) = &mut out.slide {
        slide.along = swap_feature(&slide.along);
        slide.toward = slide.toward.as_deref().map(swap_feature);
    }
    match &mut out.level {
        Some(Level::Feature(f)) => *f = swap_feature(f),
        Some(Level::Between(l)) => {
            l.from = swap_feature(&l.from);
            l.to = l.to.as_deref().map(swap_feature);
        }
        None => {}
    }
    out
}

fn cells(name: &str, spec: &SurfaceSpec, nodes: &Names) -> Result<Vec<Cell>, TemplateError> {
    let mut out = Vec::new();
    let mut push = |corners: &[u32]| {
        // A corner that comes twice in a row makes a quad a triangle, and a triangle nothing.
        let mut distinct: Vec<u32> = Vec::with_capacity(4);
        for &c in corners {
            if !distinct.contains(&c) {
                distinct.push(c);
            }
        }
        match distinct[..] {
            [a, b, c] => out.push(Cell::Triangle([a, b, c])),
            [a, b, c, d] => out.push(Cell::Quad([a, b, c, d])),
            _ => {}
        }
    };
    if let Some(rows) = &spec.rows {
        let mut grid: Vec<Vec<u32>> = Vec::with_capacity(rows.len());
        for (r, row) in rows.iter().enumerate() {
            let path = |c: usize| move || format!("surfaces.{name}.rows[{r}][{c}]");
            grid.push(
                row.iter()
                    .enumerate()
                    .map(|(c, n)| nodes.find(n, path(c), "node"))
                    .collect::<Result<_, _>>()?,
            );
        }
        for pair in grid.windows(2) {
            let [upper, lower] = [&pair[0], &pair[1]];
            let (mut i, mut j) = (0, 0);
            while i + 1 < upper.len() || j + 1 < lower.len() {
                // Shares of the rows at the next node; the row that lags goes first, rows in step make a quad.
                let ahead = |k: usize, row: &[u32]| {
                    if k + 1 < row.len() { (k + 1) as f64 / (row.len() - 1) as f64 } else { f64::INFINITY }
                };
                let (u, l) = (ahead(i, upper), ahead(j, lower));
                if (u - l).abs() < 1e-9 {
                    push(&[upper[i], lower[j], lower[j + 1], upper[i + 1]]);
                    (i, j) = (i + 1, j + 1);
                } else if u < l {
                    push(&[upper[i], lower[j], upper[i + 1]]);
                    i += 1;
                } else {
                    push(&[upper[i], lower[j], lower[j + 1]]);
                    j += 1;
                }
            }
        }
    }
    for (f, face) in spec.faces.iter().flatten().enumerate() {
        let path = || format!("surfaces.{name}.faces[{f}]");
        let corners = face.iter().map(|n| nodes.find(n, path, "node")).collect::<Result<Vec<_>, _>>()?;
        push(&corners);
    }
    if out.is_empty() {
        return Err(TemplateError::format(
            format!("surfaces.{name}"),
            "the surface has no face with three nodes",
        ));
    }
    Ok(out)
}

fn mirror_cell(cell: Cell, twin: &dyn Fn(u32) -> Result<u32, TemplateError>) -> Result<Cell, TemplateError> {
    Ok(match cell {
        Cell::Triangle([a, b, c]) => Cell::Triangle([twin(a)?, twin(c)?, twin(b)?]),
        // Reversed so that the preferred diagonal stays the mirror image of the other's.
        Cell::Quad([a, b, c, d]) => Cell::Quad([twin(a)?, twin(d)?, twin(c)?, twin(b)?]),
    })
}

impl Layout {
    /// Writes a checked file out. Errors name what refers to nothing or lacks its twin.
    pub(crate) fn new(file: &TemplateFile) -> Result<Self, TemplateError> {
        let node_names = Names::new(file, file.nodes.iter().map(|(k, n)| (k, n.mirror, n.centre)));
        let surface_names =
            Names::new(file, file.surfaces.iter().map(|(k, s)| (k, s.mirror, s.across_centre)));
        let line_names = Names::new(file, file.lines.iter().map(|(k, l)| (k, l.mirror, l.across_centre)));

        let nodes: Vec<LayoutNode> = node_names
            .entries
            .iter()
            .map(|(name, twin, made_from)| {
                let spec = match made_from {
                    Some(m) => mirrored_node(&file.nodes[&node_names.entries[*m as usize].0], &node_names),
                    None => file.nodes[name].clone(),
                };
                LayoutNode { name: name.clone(), spec, twin: *twin, made_from: *made_from }
            })
            .collect();
        for node in &nodes {
            for name in node.spec.between.iter().flatten() {
                node_names.find(name, || format!("nodes.{}.between", node.name), "node")?;
            }
        }
        let node_twin = |path: &str| {
            let (nodes, path) = (&nodes, path.to_string());
            move |n: u32| {
                nodes[n as usize].twin.ok_or_else(|| {
                    let name = &nodes[n as usize].name;
                    let remedy = "name it `left_…`, mark it `\"mirror\": true`, or `\"centre\": true`";
                    TemplateError::format(
                        path.clone(),
                        format!("the node `{name}` has no mirror image: {remedy}"),
                    )
                })
            }
        };

        let surfaces = Self::surfaces(file, &surface_names, &node_names, &line_names, &node_twin)?;
        let lines = Self::lines(file, &line_names, &node_names, &node_twin)?;
        let mut groups = Vec::new();
        for (g, group) in file.fair_across.iter().enumerate() {
            let path = || format!("fair_across[{g}]");
            let mut ids: Vec<u32> =
                group.iter().map(|n| surface_names.find(n, path, "surface")).collect::<Result<_, _>>()?;
            ids.sort_unstable();
            ids.dedup();
            groups.push(ids);
        }
        let mut ease = Vec::new();
        for (name, spec) in &file.ease {
            let path = || format!("ease.{name}.surfaces");
            let surfaces = spec.surfaces.iter().map(|n| surface_names.find(n, path, "surface"));
            let surfaces = surfaces.collect::<Result<_, _>>()?;
            ease.push(LayoutEase { name: name.clone(), spec: spec.clone(), surfaces });
        }
        Ok(Self {
            mirrored: file.mirrored,
            symmetric: file.mirrored && file.symmetric.unwrap_or(true),
            nodes,
            surfaces,
            lines,
            groups,
            ease,
            joints: file.joints.clone(),
        })
    }

    fn surfaces<T: Fn(u32) -> Result<u32, TemplateError>>(
        file: &TemplateFile,
        names: &Names,
        node_names: &Names,
        line_names: &Names,
        node_twin: &dyn Fn(&str) -> T,
    ) -> Result<Vec<LayoutSurface>, TemplateError> {
        let mut out: Vec<LayoutSurface> = Vec::with_capacity(names.entries.len());
        for (name, twin, made_from) in &names.entries {
            let source = made_from.map_or(name, |m| &names.entries[m as usize].0);
            let spec = &file.surfaces[source];
            let mut cells = cells(source, spec, node_names)?;
            let path = format!("surfaces.{source}");
            let swap = node_twin(&path);
            let mut open_along = Vec::new();
            for line in &spec.open_along {
                let l = line_names.find(line, || format!("{path}.open_along"), "line")?;
                let mirrored = line_names.entries[l as usize].1.filter(|_| made_from.is_some());
                open_along.push(mirrored.unwrap_or(l));
            }
            if made_from.is_some() {
                cells = cells.into_iter().map(|c| mirror_cell(c, &swap)).collect::<Result<_, _>>()?;
            } else if spec.across_centre {
                // Every node must have its image: found out here, where the message can name the surface.
                for cell in &cells {
                    mirror_cell(*cell, &swap)?;
                }
            }
            let piece = file.pieces.get(name).cloned().or_else(|| {
                let source = file.pieces.get(source).filter(|_| made_from.is_some())?;
                Some(mirrored_piece(source, node_names, line_names))
            });
            out.push(LayoutSurface {
                name: name.clone(),
                cells,
                across_centre: spec.across_centre,
                interior: spec.interior,
                layer: spec.layer,
                open_along,
                twin: *twin,
                made_from: *made_from,
                piece,
            });
        }
        Ok(out)
    }

    fn lines<T: Fn(u32) -> Result<u32, TemplateError>>(
        file: &TemplateFile,
        names: &Names,
        node_names: &Names,
        node_twin: &dyn Fn(&str) -> T,
    ) -> Result<Vec<LayoutLine>, TemplateError> {
        let mut out = Vec::with_capacity(names.entries.len());
        for (name, _, made_from) in &names.entries {
            let source = made_from.map_or(name, |m| &names.entries[m as usize].0);
            let spec: &LineSpec = &file.lines[source];
            let path = format!("lines.{source}");
            let swap = node_twin(&path);
            let find = |n: &String| node_names.find(n, || format!("{path}.through"), "node");
            let mut nodes: Vec<u32> = spec.through.iter().map(find).collect::<Result<_, _>>()?;
            let mut corners: Vec<u32> = spec.corners.iter().map(find).collect::<Result<_, _>>()?;
            let image = |list: &[u32]| list.iter().map(|n| swap(*n)).collect::<Result<Vec<u32>, _>>();
            if made_from.is_some() {
                nodes = image(&nodes)?;
                corners = image(&corners)?;
            } else if spec.across_centre {
                nodes = joined_halves(&nodes, &image(&nodes)?, spec.closed).ok_or_else(|| {
                    let remedy = "begin or end it at a centre node, and a closed line at both ends";
                    TemplateError::format(
                        path.clone(),
                        format!("the halves of the line do not meet: {remedy}"),
                    )
                })?;
                corners.extend(image(&corners)?);
            }
            corners.sort_unstable();
            corners.dedup();
            let mut sorted = nodes.clone();
            sorted.sort_unstable();
            if sorted.windows(2).any(|w| w[0] == w[1]) {
                let message = "a node comes twice; end the line there, or say `\"closed\": true`";
                return Err(TemplateError::format(format!("{path}.through"), message));
            }
            if spec.closed && nodes.len() < 3 {
                return Err(TemplateError::format(
                    format!("{path}.through"),
                    "a closed line needs three nodes",
                ));
            }
            let shape =
                spec.shape.as_ref().map(|s| if made_from.is_some() { mirrored_shape(s) } else { s.clone() });
            let continues = match &spec.continues {
                None => None,
                Some(next) => {
                    let n = names.find(next, || format!("{path}.continues"), "line")?;
                    names.entries[n as usize].1.filter(|_| made_from.is_some()).or(Some(n))
                }
            };
            out.push(LayoutLine {
                name: name.clone(),
                nodes,
                closed: spec.closed,
                shape,
                corners,
                continues,
                hold: spec.hold,
            });
        }
        for line in &out {
            let Some(next) = line.continues else { continue };
            let next = &out[next as usize];
            if next.closed || line.nodes.last() != next.nodes.first() {
                let message = format!("`{}` does not begin at this line's last node", next.name);
                return Err(TemplateError::format(format!("lines.{}.continues", line.name), message));
            }
        }
        Ok(out)
    }
}

/// A half line and its mirror image as one chain; `None` when they do not meet where they should.
fn joined_halves(half: &[u32], image: &[u32], closed: bool) -> Option<Vec<u32>> {
    let (first, last) = (half.first() == image.first(), half.last() == image.last());
    let mut out = half.to_vec();
    match (closed, first, last) {
        (true, true, true) => out.extend(image[1..image.len() - 1].iter().rev()),
        (false, _, true) => out.extend(image[..image.len() - 1].iter().rev()),
        (false, true, false) => {
            out = image[1..].iter().rev().copied().collect();
            out.extend(half);
        }
        _ => return None,
    }
    Some(out)
}

fn mirrored_piece(piece: &PieceSpec, nodes: &Names, lines: &Names) -> PieceSpec {
    let swap = |names: &Names, name: &String| {
        let twin = names.index.get(name).and_then(|i| names.entries[*i as usize].1);
        twin.map_or_else(|| name.clone(), |t| names.entries[t as usize].0.clone())
    };
    let mut out = piece.clone();
    out.edges = piece.edges.iter().map(|(k, v)| (swap(lines, k), *v)).collect();
    out.on_fold = piece.on_fold.as_ref().map(|l| swap(lines, l));
    if let Some(Grain::Nodes([a, b])) = &piece.grain {
        out.grain = Some(Grain::Nodes([swap(nodes, a), swap(nodes, b)]));
    }
    out
}

fn mirrored_shape(shape: &Shape) -> Shape {
    let mut out = shape.clone();
    match &mut out {
        Shape::Profile(p) => p.points.iter_mut().for_each(|q| q[0] = -q[0]),
        Shape::Follow(f) => f.follow = swap_feature(&f.follow),
        Shape::Named(_) => {}
    }
    out
}
