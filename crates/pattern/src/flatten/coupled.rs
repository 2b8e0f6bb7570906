//! Sheets that are sewn together, solved as one: seam edges keep equal lengths at the least total stretch.

use glam::DVec2;

use super::{
    sheet::{Hold, Sheet, Side},
    sparse::{BlockSystem, NotDefinite},
};

/// One edge of one sheet.
#[derive(Clone, Copy, Debug)]
pub(crate) struct EdgeOf {
    /// Index among the sheets that are merged.
    pub(crate) sheet: usize,
    /// Its nodes in that sheet.
    pub(crate) nodes: [u32; 2],
}

/// Merges sheets into one with a hold for every pair of partners. Every group lists edges of equal wanted length.
pub(crate) fn merge(
    sheets: &[&Sheet],
    groups: &[Vec<EdgeOf>],
    area_weight: f64,
) -> Result<Sheet, NotDefinite> {
    let mut first = Vec::with_capacity(sheets.len());
    let mut merged = Merged::default();
    for sheet in sheets {
        first.push(merged.add(sheet));
    }
    let Merged { space, faces, rest, mut edges, sides, flat, pins, area } = merged;
    let mut known: Vec<([u32; 2], u32)> =
        edges.iter().enumerate().map(|(i, e)| ([e[0].min(e[1]), e[0].max(e[1])], i as u32)).collect();
    known.sort_unstable();
    // All pairs of nodes that a hold couples; those that are no mesh edge become edges of the system.
    let mut wanted: Vec<[u32; 2]> = Vec::new();
    let mut pairs: Vec<([[u32; 2]; 2], f64)> = Vec::new();
    for group in groups {
        let ends = |e: &EdgeOf| e.nodes.map(|v| first[e.sheet] + v);
        let head = ends(&group[0]);
        let length = space[head[0] as usize].distance(space[head[1] as usize]);
        for e in &group[1..] {
            pairs.push(([head, ends(e)], length));
        }
    }
    for (ends, _) in &pairs {
        let nodes = distinct(ends);
        for i in 0..nodes.len() {
            for j in i + 1..nodes.len() {
                wanted.push([nodes[i].min(nodes[j]), nodes[i].max(nodes[j])]);
            }
        }
    }
    wanted.sort_unstable();
    wanted.dedup();
    for pair in wanted {
        if known.binary_search_by(|k| k.0.cmp(&pair)).is_err() {
            edges.push(pair);
        }
    }
    known = edges.iter().enumerate().map(|(i, e)| ([e[0].min(e[1]), e[0].max(e[1])], i as u32)).collect();
    known.sort_unstable();
    let edge_of = |a: u32, b: u32| {
        let at = known.partition_point(|k| k.0 < [a.min(b), a.max(b)]);
        let edge = known[at].1;
        Side { edge, forward: edges[edge as usize][0] == a }
    };
    let holds = pairs
        .into_iter()
        .map(|(ends, length)| {
            let nodes = distinct(&ends);
            let slot = |v: u32| nodes.iter().position(|&n| n == v).unwrap_or(0);
            let slots = ends.map(|e| e.map(slot));
            let mut between = Vec::new();
            for i in 0..nodes.len() {
                for j in i + 1..nodes.len() {
                    between.push(edge_of(nodes[i], nodes[j]));
                }
            }
            Hold { ends, slots, edges: between, nodes, length, multiplier: 0.0 }
        })
        .collect();
    let system = BlockSystem::new(&space, &edges)?;
    let (loops, compact) = (Vec::new(), Vec::new());
    Ok(Sheet {
        space,
        faces,
        rest,
        edges,
        sides,
        loops,
        area,
        compact,
        flat,
        system,
        area_weight,
        pins,
        holds,
    })
}

/// Gives the merged flat positions back to their sheets.
pub(crate) fn hand_back(merged: &Sheet, sheets: &mut [&mut Sheet]) {
    let mut from = 0;
    for sheet in sheets {
        let count = sheet.flat.len();
        sheet.flat.copy_from_slice(&merged.flat[from..from + count]);
        from += count;
    }
}

fn distinct(ends: &[[u32; 2]; 2]) -> Vec<u32> {
    let mut nodes = Vec::with_capacity(4);
    for v in ends.iter().flatten() {
        if !nodes.contains(v) {
            nodes.push(*v);
        }
    }
    nodes
}

#[derive(Default)]
struct Merged {
    space: Vec<glam::DVec3>,
    faces: Vec<[u32; 3]>,
    rest: Vec<super::energy::RestTriangle>,
    edges: Vec<[u32; 2]>,
    sides: Vec<[Side; 3]>,
    flat: Vec<DVec2>,
    pins: Vec<[usize; 2]>,
    area: f64,
}

impl Merged {
    /// Appends a sheet; the number of its first node.
    fn add(&mut self, sheet: &Sheet) -> u32 {
        let node = self.space.len() as u32;
        let edge = self.edges.len() as u32;
        self.space.extend_from_slice(&sheet.space);
        self.faces.extend(sheet.faces.iter().map(|f| f.map(|v| v + node)));
        self.rest.extend_from_slice(&sheet.rest);
        self.edges.extend(sheet.edges.iter().map(|e| e.map(|v| v + node)));
        self.sides.extend(sheet.sides.iter().map(|s| s.map(|s| Side { edge: s.edge + edge, ..s })));
        self.flat.extend_from_slice(&sheet.flat);
        self.pins.extend(sheet.pins.iter().map(|p| p.map(|v| v + node as usize)));
        self.area += sheet.area;
        node
    }
}
