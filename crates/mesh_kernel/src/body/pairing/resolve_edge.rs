//! A joint of many sheets taken apart into edges of two.

use std::collections::BTreeMap;

use super::fans::Links;
use super::recut::{Seam, Unsewn};
use super::{Pairing, PairingError, Resolution};
use crate::body::build::Run;
use crate::body::ids::{DirectedEdge, NONE};
use crate::body::joint::{Sheet, Side};
use crate::body::weld::UnionFind;
use crate::body::welded::Welded;
use crate::body::{Body, JointId, SurfaceId};

impl Body {
    /// Says what is meant where more than two sheets meet: the joint's sheets are set apart in pairs, every pair on an edge
    /// of its own (see [`super::Pairing`] for which pairs). The two sides of an inner chain that stay a pair become an
    /// ordinary edge of their surface; other pairs become joints of two sheets; an inner chain whose sides part is cut.
    ///
    /// Nodes within the joint get copies where nothing else holds them together. At the joint's ends, and where other
    /// surfaces touch it, the pairs stay together by joints without edges ("only being joined at the vertices of the
    /// edges", Stroud & Nagy): what is meant there is a question of its own, for [`Body::resolve_node`].
    ///
    /// Faces, positions and volume stay. Of 2n sheets on m edges come (n − 1) m more edges.
    ///
    /// # Errors
    /// See [`PairingError`]; nothing is changed then. O(faces).
    pub fn resolve_edge(&self, joint: JointId, pairing: Pairing) -> Result<Resolution, PairingError> {
        let pairings = self.edge_pairings(joint)?;
        let pairs = pairings.pairs(pairing);
        if pairs.len() < 2 {
            return Err(PairingError::Manifold { joint });
        }
        let held = self.held_nodes(joint);
        let mut unsewn = Unsewn::new(self);
        let place = unsewn.seams.iter().position(|s| s.old == Some(joint));
        let place = place.ok_or(PairingError::NoJoint(joint))?;
        let Seam { name, runs, .. } = unsewn.seams.remove(place);

        // The edges of every sheet: one set for both sides of an inner chain that stays whole.
        let mut edges_of: BTreeMap<Sheet, Vec<DirectedEdge>> = BTreeMap::new();
        let mut cut: Vec<(u32, DirectedEdge, DirectedEdge)> = Vec::new();
        for (i, run) in runs.iter().enumerate() {
            let [left, right] = [Side::Left, Side::Right].map(|side| Sheet { use_index: i as u32, side });
            let own: Vec<Sheet> =
                pairs.iter().flatten().copied().filter(|s| [left, right].contains(s)).collect();
            let whole = own.len() < 2 || pairs.iter().any(|p| p.contains(&left) && p.contains(&right));
            if whole {
                own.iter().for_each(|s| {
                    edges_of.insert(*s, run.edges.clone());
                });
                continue;
            }
            let (mut to_left, mut to_right) = (Vec::new(), Vec::new());
            for &d in &run.edges {
                let new = DirectedEdge::new(unsewn.cut_edge(run.surface, d.edge()), d.is_reversed());
                // The old edge keeps the face on its own left.
                let (l, r) = if d.is_reversed() { (new, d) } else { (d, new) };
                to_left.push(l);
                to_right.push(r);
                cut.push((run.surface, d, new));
            }
            edges_of.insert(left, to_left);
            edges_of.insert(right, to_right);
        }
        unsewn.part_nodes(&cut);

        let run_of = |unsewn: &Unsewn, sheet: &Sheet| {
            let surface = runs[sheet.use_index as usize].surface;
            let edges = edges_of[sheet].clone();
            let start = unsewn.surfaces[surface as usize].ends(edges[0])[0].0;
            Run { surface, start, edges }
        };
        let mut seams = Vec::new();
        for [a, b] in pairs.iter().filter(|[a, b]| a.use_index != b.use_index) {
            let runs = vec![run_of(&unsewn, a), run_of(&unsewn, b)];
            let radial = vec![Sheet { use_index: 0, side: a.side }, Sheet { use_index: 1, side: b.side }];
            seams.push(Seam { old: None, name: name.clone(), runs, radial });
        }
        self.no_slit(joint, &unsewn, &seams, &runs, &edges_of)?;
        // The first pair takes the joint's place, so that others keep their ids; the rest come last.
        let at_end = unsewn.seams.len() + usize::from(!seams.is_empty());
        let count = seams.len();
        let mut seams = seams.into_iter();
        if let Some(first) = seams.next() {
            unsewn.seams.insert(place, first);
        }
        unsewn.seams.extend(seams);
        let mut made: Vec<JointId> = (at_end..unsewn.seams.len()).map(|j| JointId(j as u32)).collect();
        if count > 0 {
            made.insert(0, JointId(place as u32));
        }
        unsewn.start_runs();
        let first_touch = unsewn.seams.len();
        let lists = unsewn.copies_of(&held);
        unsewn.touch(&lists);
        let touching = (first_touch..unsewn.seams.len()).map(|j| JointId(j as u32)).collect();
        let sewn = unsewn.sew(self.joints.len())?;
        let (before, after) = (self.counts(), sewn.body.counts());
        Ok(Resolution { body: sewn.body, joints: sewn.joints, pairs: made, touching, before, after })
    }

    /// For every welded node of the joint at which its pairs stay together (its ends, and where more than its own sheets
    /// meet), the surfaces' nodes there.
    fn held_nodes(&self, joint: JointId) -> Vec<Vec<(u32, u32)>> {
        let welded = Welded::new(self);
        let links = Links::new(self, &welded);
        let first = self.joint(joint).uses[0].surface;
        let line: Vec<u32> = self.joint_nodes(joint, 0).iter().map(|&v| welded.weld.node(first, v)).collect();
        let closed = line.first() == line.last();
        let last = line.len() - 1;
        let mut held: BTreeMap<u32, usize> = BTreeMap::new();
        for (k, &w) in line.iter().enumerate() {
            let end = !closed && (k == 0 || k == last);
            if end || links.fans(w).len() > 1 {
                let next = held.len();
                held.entry(w).or_insert(next);
            }
        }
        let mut lists = vec![Vec::new(); held.len()];
        for (s, nodes) in welded.weld.nodes.iter().enumerate() {
            for (v, w) in nodes.iter().enumerate() {
                if let Some(&i) = held.get(w) {
                    lists[i].push((s as u32, v as u32));
                }
            }
        }
        lists
    }

    /// Refuses what would leave a surface with two edges on the same nodes that are not one joint's.
    fn no_slit(
        &self,
        joint: JointId,
        unsewn: &Unsewn,
        seams: &[Seam],
        runs: &[Run],
        edges_of: &BTreeMap<Sheet, Vec<DirectedEdge>>,
    ) -> Result<(), PairingError> {
        let seam_of = |surface: u32, d: DirectedEdge| {
            let has = |r: &Run| r.surface == surface && r.edges.iter().any(|x| x.edge() == d.edge());
            seams.iter().position(|s| s.runs.iter().any(has))
        };
        let mut seen: BTreeMap<(u32, [u32; 2]), DirectedEdge> = BTreeMap::new();
        for (sheet, edges) in edges_of {
            let surface = runs[sheet.use_index as usize].surface;
            for &d in edges {
                let mut nodes = unsewn.surfaces[surface as usize].edges[d.edge().index()];
                nodes.sort_unstable();
                if let Some(other) = seen.insert((surface, nodes), d)
                    && other.edge() != d.edge()
                    && (seam_of(surface, d).is_none() || seam_of(surface, d) != seam_of(surface, other))
                {
                    return Err(PairingError::SlitOfOneEdge { joint, surface: SurfaceId(surface), nodes });
                }
            }
        }
        Ok(())
    }
}

impl Unsewn {
    /// Runs start where their first edges do.
    pub(super) fn start_runs(&mut self) {
        for seam in &mut self.seams {
            for run in &mut seam.runs {
                if let Some(&first) = run.edges.first() {
                    run.start = self.surfaces[run.surface as usize].ends(first)[0].0;
                }
            }
        }
    }

    /// Gives the faces on both sides of cut edges nodes of their own where the cut parts them. The part with the lowest face
    /// keeps the node.
    fn part_nodes(&mut self, cut: &[(u32, DirectedEdge, DirectedEdge)]) {
        let mut by_surface: BTreeMap<u32, Vec<(u32, u32)>> = BTreeMap::new();
        for (surface, d, new) in cut {
            by_surface.entry(*surface).or_default().push((d.edge().0, new.edge().0));
        }
        for (surface, edges) in by_surface {
            let s = &self.surfaces[surface as usize];
            let mut place = vec![NONE; s.positions.len()];
            let mut nodes: Vec<u32> = edges.iter().flat_map(|&(e, _)| s.edges[e as usize]).collect();
            nodes.sort_unstable();
            nodes.dedup();
            nodes.iter().zip(0..).for_each(|(&v, i)| place[v as usize] = i);
            let mut faces_at: Vec<Vec<u32>> = vec![Vec::new(); nodes.len()];
            for f in s.live_faces() {
                for &v in s.faces[f.index()].iter().filter(|v| place[**v as usize] != NONE) {
                    faces_at[place[v as usize] as usize].push(f.0);
                }
            }
            let partner: BTreeMap<u32, u32> = edges.iter().copied().collect();
            for (&v, faces) in nodes.iter().zip(&faces_at) {
                self.part_node(surface, v, faces, &partner);
            }
        }
    }

    /// `faces` are those at the node, `partner` the new edge of every edge cut.
    fn part_node(&mut self, surface: u32, v: u32, faces: &[u32], partner: &BTreeMap<u32, u32>) {
        let s = &self.surfaces[surface as usize];
        let local = |f: u32| faces.binary_search(&f).ok().map(|i| i as u32);
        let mut now = UnionFind::new(faces.len());
        let mut before = UnionFind::new(faces.len());
        for (i, &f) in faces.iter().enumerate() {
            for e in s.face_edges[f as usize].into_iter().filter(|e| s.edges[*e as usize].contains(&v)) {
                for g in s.edge_faces[e as usize].into_iter().filter_map(local) {
                    now.union(i as u32, g);
                    before.union(i as u32, g);
                }
                if let Some(&new) = partner.get(&e) {
                    for g in s.edge_faces[new as usize].into_iter().filter_map(local) {
                        before.union(i as u32, g);
                    }
                }
            }
        }
        let mut parts: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
        for (i, &f) in (0..).zip(faces) {
            parts.entry(now.find(i)).or_default().push(f);
        }
        for (first, part) in parts {
            if before.find(first) != first {
                let copy = self.copy_node(surface, v);
                self.hand_over(surface, &part, v, copy);
            }
        }
    }

    /// Lists of nodes with the copies that have been made of them.
    fn copies_of(&self, lists: &[Vec<(u32, u32)>]) -> Vec<Vec<(u32, u32)>> {
        let with = |list: &Vec<(u32, u32)>| {
            let copies = self.copies.iter().filter(|(s, v, _)| list.contains(&(*s, *v)));
            list.iter().copied().chain(copies.map(|&(s, _, c)| (s, c))).collect()
        };
        lists.iter().map(with).collect()
    }
}
