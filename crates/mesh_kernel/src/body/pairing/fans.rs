//! The fans of faces at a node, and what lies between them.

use std::collections::BTreeMap;

use super::PairingError;
use super::locate::locate;
use crate::body::shells::{Shells, onwards};
use crate::body::weld::UnionFind;
use crate::body::welded::Welded;
use crate::body::{Body, EdgeId, FaceId, NONE, NodeId, SurfaceId};

/// What a fan looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum FanKind {
    /// Faces all round the node, two at every edge.
    Disk,
    /// Faces from one free edge to another, two at every edge between.
    HalfDisk,
    /// Edges with three faces or more, or with ends between: a joint passes or ends at the node.
    Branched,
    /// One edge without faces.
    Wire,
    /// The node alone.
    Point,
}

/// What is connected through edges at a node: a component of the node's link.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fan {
    /// Its shape.
    pub kind: FanKind,
    /// Its faces, by surface and number.
    pub faces: Vec<(SurfaceId, FaceId)>,
    /// Its edge without faces; the partners of the edge where it is on a joint.
    pub wires: Vec<(SurfaceId, EdgeId)>,
    /// The surfaces' nodes that are its.
    pub nodes: Vec<(SurfaceId, NodeId)>,
}

/// What fans touch through.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Through {
    /// Empty space lies between them: bodies that touch.
    Empty,
    /// Material lies between them: hollows that touch.
    Material,
    /// Open sheets or wires, which bound no material.
    Sheets,
    /// Material for one of them and empty space for another.
    Conflict,
}

/// A sector of the space about a node that several fans look into.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Contact {
    /// The fans, by number, two or more.
    pub fans: Vec<u32>,
    /// For every one of them the shell that looks into the sector, as [`crate::body::Regions`] numbers them; `None` for
    /// wires and points.
    pub shells: Vec<Option<u32>>,
    /// What fills the sector.
    pub through: Through,
}

/// The fans at a node and how they touch.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct NodeFans {
    /// The fans, in order of their first faces, then wires, then nodes that stand alone.
    pub fans: Vec<Fan>,
    /// Where several of them look into one sector.
    pub contacts: Vec<Contact>,
}

/// A fan while its place is found: faces and edges by their numbers in the welded body.
pub(super) struct LocalFan {
    /// Faces by number through all surfaces, in order.
    pub(super) faces: Vec<u32>,
    /// The other ends of its edges, welded.
    pub(super) ends: Vec<u32>,
    /// Faces at every edge.
    valences: Vec<usize>,
    wires: Vec<u32>,
    /// For every face, its sectors in front and behind, numbered within the fan.
    pub(super) sectors: Vec<[u32; 2]>,
}

/// The edges at every welded node.
pub(super) struct Links<'a> {
    pub(super) body: &'a Body,
    pub(super) welded: &'a Welded,
    starts: Vec<u32>,
    edges: Vec<u32>,
}

impl<'a> Links<'a> {
    /// O(edges).
    pub(super) fn new(body: &'a Body, welded: &'a Welded) -> Self {
        let mut starts = vec![0u32; welded.weld.count + 1];
        for &[a, b] in &welded.edges {
            starts[a as usize + 1] += 1;
            starts[b as usize + 1] += 1;
        }
        for i in 1..starts.len() {
            starts[i] += starts[i - 1];
        }
        let mut fill = starts.clone();
        let mut edges = vec![0; welded.edges.len() * 2];
        for (e, ends) in welded.edges.iter().enumerate() {
            for &v in ends {
                edges[fill[v as usize] as usize] = e as u32;
                fill[v as usize] += 1;
            }
        }
        Self { body, welded, starts, edges }
    }

    fn at(&self, node: u32) -> &[u32] {
        &self.edges[self.starts[node as usize] as usize..self.starts[node as usize + 1] as usize]
    }

    /// Surface and number of a face numbered through all.
    pub(super) fn face(&self, f: u32) -> (SurfaceId, FaceId) {
        self.welded.faces.face(f)
    }

    /// The fans of faces and wires at a welded node. O(edges at the node · log).
    pub(super) fn fans(&self, node: u32) -> Vec<LocalFan> {
        let edges = self.at(node);
        let mut index: BTreeMap<u32, u32> = BTreeMap::new();
        for &e in edges {
            self.welded.uses(e as usize).for_each(|u| {
                index.insert(u.face, 0);
            });
        }
        index.values_mut().zip(0..).for_each(|(place, i)| *place = i);
        let mut faces = UnionFind::new(index.len());
        let mut sides = UnionFind::new(2 * index.len());
        for &e in edges {
            let uses = self.welded.uses(e as usize);
            let local = |side: u32| 2 * index[&(side / 2)] + side % 2;
            for (u, next) in uses.clone().zip(uses.clone().cycle().skip(1)) {
                faces.union(index[&u.face], index[&next.face]);
                sides.union(local(onwards(u)[0]), local(onwards(next)[1]));
            }
        }
        let (fan_of, count) = faces.number();
        let (sector_of, _) = sides.number();
        let new = || LocalFan {
            faces: Vec::new(),
            ends: Vec::new(),
            valences: Vec::new(),
            wires: Vec::new(),
            sectors: Vec::new(),
        };
        let mut fans: Vec<LocalFan> = (0..count).map(|_| new()).collect();
        for (&face, &i) in &index {
            let fan = &mut fans[fan_of[i as usize] as usize];
            fan.faces.push(face);
            fan.sectors.push([0, 1].map(|k| sector_of[(2 * i + k) as usize]));
        }
        for &e in edges {
            let [a, b] = self.welded.edges[e as usize];
            let end = if a == node { b } else { a };
            let mut uses = self.welded.uses(e as usize);
            let valence = uses.len();
            let fan = match uses.next() {
                Some(u) => &mut fans[fan_of[index[&u.face] as usize] as usize],
                None => {
                    fans.push(new());
                    let last = fans.len() - 1;
                    fans[last].wires.push(e);
                    &mut fans[last]
                }
            };
            fan.ends.push(end);
            fan.valences.push(valence);
        }
        fans
    }

    /// The position of a welded node.
    pub(super) fn position(&self, places: &[(SurfaceId, NodeId)], node: u32) -> glam::DVec3 {
        let (s, v) = places[node as usize];
        self.body.surface(s).positions[v.index()]
    }
}

impl LocalFan {
    fn kind(&self) -> FanKind {
        if !self.wires.is_empty() {
            return FanKind::Wire;
        }
        let free = self.valences.iter().filter(|n| **n == 1).count();
        let many = self.valences.iter().any(|n| *n > 2);
        match (many, free) {
            (false, 0) => FanKind::Disk,
            (false, 2) => FanKind::HalfDisk,
            _ => FanKind::Branched,
        }
    }

    /// What fills a sector, as this fan has it.
    fn through(&self, sector: u32) -> Through {
        if self.faces.is_empty() || self.valences.contains(&1) {
            return Through::Sheets;
        }
        let seen = |k: usize| self.sectors.iter().any(|s| s[k] == sector);
        match (seen(0), seen(1)) {
            (true, false) => Through::Empty,
            (false, true) => Through::Material,
            _ => Through::Conflict,
        }
    }
}

/// Any node of a surface for every welded node: the first.
pub(super) fn places(welded: &Welded) -> Vec<(SurfaceId, NodeId)> {
    let mut places = vec![(SurfaceId(NONE), NodeId(NONE)); welded.weld.count];
    for (s, nodes) in welded.weld.nodes.iter().enumerate().rev() {
        for (v, &w) in nodes.iter().enumerate().rev().filter(|(_, w)| **w != NONE) {
            places[w as usize] = (SurfaceId(s as u32), NodeId(v as u32));
        }
    }
    places
}

impl Body {
    /// The fans of faces (and wires) that share a node, seen through all joints, and what lies between them.
    ///
    /// Fans that are connected nowhere but at the node are told apart in space by exact predicates: which of them look
    /// into the same sector, and whether material or empty space fills it, where faces bound material behind them.
    ///
    /// # Errors
    /// No such node; fans that run through each other. O(faces + fans² · faces at the node).
    pub fn node_fans(&self, surface: SurfaceId, node: NodeId) -> Result<NodeFans, PairingError> {
        let unknown = PairingError::NoNode { surface, node };
        let s = self.surfaces.get(surface.index()).ok_or(unknown.clone())?;
        if !s.is_node(node) {
            return Err(unknown);
        }
        let welded = Welded::new(self);
        let links = Links::new(self, &welded);
        let w = welded.weld.node(surface, node.0);
        let local = links.fans(w);
        let shells = Shells::new(&welded);
        let contacts = contacts(&links, (surface, node), w, &local, &shells)?;
        let mut fans: Vec<Fan> = local.iter().map(|fan| links.fan(w, fan)).collect();
        // Nodes that stand alone, held by a joint without edges.
        for (s, nodes) in welded.weld.nodes.iter().enumerate() {
            for v in (0..nodes.len()).filter(|v| nodes[*v] == w) {
                let there = (SurfaceId(s as u32), NodeId(v as u32));
                if !fans.iter().any(|f| f.nodes.contains(&there)) {
                    let (faces, wires) = (Vec::new(), Vec::new());
                    fans.push(Fan { kind: FanKind::Point, faces, wires, nodes: vec![there] });
                }
            }
        }
        Ok(NodeFans { fans, contacts })
    }

    /// Nodes at which several fans meet, each by its first surface's node. O(faces · log).
    pub fn non_manifold_nodes(&self) -> Vec<(SurfaceId, NodeId)> {
        let welded = Welded::new(self);
        let links = Links::new(self, &welded);
        let places = places(&welded);
        (0..welded.weld.count as u32)
            .filter(|&w| links.fans(w).len() > 1)
            .map(|w| places[w as usize])
            .collect()
    }
}

impl Links<'_> {
    fn fan(&self, node: u32, fan: &LocalFan) -> Fan {
        let faces: Vec<_> = fan.faces.iter().map(|&f| self.face(f)).collect();
        let mut nodes = Vec::new();
        for &(s, f) in &faces {
            let corners = self.body.surface(s).faces[f.index()];
            let own = corners.into_iter().filter(|&v| self.welded.weld.node(s, v) == node);
            nodes.extend(own.map(|v| (s, NodeId(v))));
        }
        let mut wires = Vec::new();
        if let Some(&wire) = fan.wires.first() {
            for ((s, surface), numbers) in self.body.surfaces().zip(self.body.weld_edges().0) {
                for e in (0..numbers.len()).filter(|&e| numbers[e] == wire) {
                    wires.push((s, EdgeId(e as u32)));
                    let own = surface.edges[e].into_iter().filter(|&v| self.welded.weld.node(s, v) == node);
                    nodes.extend(own.map(|v| (s, NodeId(v))));
                }
            }
        }
        nodes.sort_unstable();
        nodes.dedup();
        Fan { kind: fan.kind(), faces, wires, nodes }
    }
}

/// Sectors that several fans look into.
fn contacts(
    links: &Links,
    (surface, node): (SurfaceId, NodeId),
    w: u32,
    fans: &[LocalFan],
    shells: &Shells,
) -> Result<Vec<Contact>, PairingError> {
    let n = fans.len();
    if n < 2 {
        return Ok(Vec::new());
    }
    let places = places(links.welded);
    // Sector of fan i in which fan j lies; a wire leaves all space one sector.
    let mut within = vec![vec![0u32; n]; n];
    for i in 0..n {
        for j in (0..n).filter(|&j| j != i) {
            if !fans[i].faces.is_empty() {
                let met = || PairingError::FansMeet { surface, node, fans: [i as u32, j as u32] };
                within[i][j] = locate(links, &places, w, &fans[i], &fans[j]).ok_or_else(met)?;
            }
        }
    }
    // Two fans look into one sector where no third stands between.
    let near = |i: usize, j: usize| (0..n).all(|k| k == i || k == j || within[k][i] == within[k][j]);
    let mut keys: Vec<(usize, u32)> = Vec::new();
    for (i, row) in within.iter().enumerate() {
        let mut own: Vec<u32> = (0..n).filter(|&j| j != i).map(|j| row[j]).collect();
        own.sort_unstable();
        own.dedup();
        keys.extend(own.into_iter().map(|s| (i, s)));
    }
    let place = |i: usize, s: u32| keys.iter().position(|k| *k == (i, s)).unwrap_or(0) as u32;
    let mut sets = UnionFind::new(keys.len());
    for (i, j) in (0..n).flat_map(|i| (i + 1..n).map(move |j| (i, j))).filter(|&(i, j)| near(i, j)) {
        sets.union(place(i, within[i][j]), place(j, within[j][i]));
    }
    let (set_of, count) = sets.number();
    let mut contacts =
        vec![Contact { fans: Vec::new(), shells: Vec::new(), through: Through::Sheets }; count];
    for (&(i, sector), &set) in keys.iter().zip(&set_of) {
        let contact = &mut contacts[set as usize];
        contact.fans.push(i as u32);
        contact.shells.push(fans[i].shell(sector, shells));
        let own = fans[i].through(sector);
        contact.through = match (contact.through, own) {
            (Through::Sheets, x) | (x, Through::Sheets) => x,
            (x, y) if x == y => x,
            _ => Through::Conflict,
        };
    }
    contacts.retain(|c| c.fans.len() > 1);
    Ok(contacts)
}

impl LocalFan {
    fn shell(&self, sector: u32, shells: &Shells) -> Option<u32> {
        self.faces.iter().zip(&self.sectors).find_map(|(&f, sides)| {
            let k = sides.iter().position(|s| *s == sector)?;
            Some(shells.of_side[2 * f as usize + k])
        })
    }
}
