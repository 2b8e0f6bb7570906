//! The sheets of a joint, and their stored order against the geometry.

use std::collections::BTreeMap;

use super::Body;
use super::ids::{JointId, NONE};
use super::joint::{Sheet, Side};
use super::radial::{Radial, radial_order};

impl Body {
    /// The sheets that leave edge `k` of a joint, by use and side, not in radial order, each with its face.
    pub(crate) fn sheets_at(&self, joint: JointId, k: usize) -> Vec<(Sheet, u32)> {
        let mut sheets = Vec::new();
        for (i, u) in self.joints[joint.index()].uses.iter().enumerate() {
            let surface = self.surface(u.surface);
            let d = self.joint_edge(joint, i, k);
            for (side, d) in [(Side::Left, d), (Side::Right, d.flipped())] {
                let face = surface.face_left(d);
                if face != NONE {
                    sheets.push((Sheet { use_index: i as u32, side }, face));
                }
            }
        }
        sheets
    }

    /// The radial order that geometry gives at edge `k` to the sheets of [`Body::sheets_at`]; `None` where the edge or
    /// all its faces are degenerate.
    pub(crate) fn geometric_order(
        &self,
        joint: JointId,
        k: usize,
        sheets: &[(Sheet, u32)],
    ) -> Option<Radial> {
        let axis = self.joint_edge(joint, 0, k);
        let surface = self.surface(self.joint(joint).uses.first()?.surface);
        let [a, b] = surface.ends(axis).map(|v| surface.positions[v.index()]);
        let apex = |&(sheet, face): &(Sheet, u32)| {
            let s = self.surface(self.joint(joint).uses[sheet.use_index as usize].surface);
            s.positions[s.apex(face, self.joint_edge(joint, sheet.use_index as usize, k).edge().0) as usize]
        };
        radial_order(a, b, &sheets.iter().map(apex).collect::<Vec<_>>())
    }

    /// Finds the radial order of a joint's sheets anew from the geometry and stores it. O(length · sheets · log sheets)
    /// exact predicates.
    ///
    /// Edges of a joint may show different orders, where sheets change places about it, or leave sheets in exactly the same
    /// direction. The rule:
    ///
    /// 1. The order that most edges show, among edges where no two sheets coincide; of several that as many show, the one
    ///    seen first along the joint. [`Body::check`] names the joint and the edges that show another.
    /// 2. Where sheets coincide on every edge, the order of the edge that tells most of them apart, and sheets that coincide
    ///    there in the order of edges where they do not.
    /// 3. Sheets that coincide all along: so that entering and leaving alternate, if they can; a gap without width that may
    ///    be either is empty, not material. Among sheets that do the same, in the order of the uses.
    ///
    /// But for the last clause the cyclic order does not depend on the order in which the uses were given.
    ///
    /// Splits keep the stored order, as they must: it says how the sheets are joined. To be called where nodes were
    /// moved so far that sheets have changed places about the joint.
    pub fn order_joint(&mut self, joint: JointId) {
        let len = self.joint_len(joint);
        if len == 0 {
            return;
        }
        let sheets = self.sheets_at(joint, 0);
        let sides: Vec<Sheet> = sheets.iter().map(|(s, _)| *s).collect();
        let mut views = Views::default();
        for k in 0..len {
            let here = self.sheets_at(joint, k);
            if here.iter().map(|(s, _)| s).eq(&sides)
                && let Some(radial) = self.geometric_order(joint, k, &here)
            {
                views.add(&radial);
            }
        }
        let order: Vec<Sheet> = match views.groups() {
            Some(groups) => alternated(groups, &sides),
            None => sides,
        };
        self.store_order(joint, &order);
    }

    /// Stores an order of sheets and puts the uses into the order of their first sheets.
    pub(super) fn store_order(&mut self, joint: JointId, order: &[Sheet]) {
        let j = &mut self.joints[joint.index()];
        let mut rank = vec![NONE; j.uses.len()];
        let mut next = 0;
        for s in order {
            if rank[s.use_index as usize] == NONE {
                rank[s.use_index as usize] = next;
                next += 1;
            }
        }
        for r in rank.iter_mut().filter(|r| **r == NONE) {
            *r = next;
            next += 1;
        }
        let mut uses = j.uses.clone();
        for (i, u) in j.uses.iter().enumerate() {
            uses[rank[i] as usize] = *u;
        }
        j.uses = uses;
        j.radial =
            order.iter().map(|s| Sheet { use_index: rank[s.use_index as usize], side: s.side }).collect();
    }
}

/// What edges of a joint show: the places of its sheets, counted from the first, and how often.
#[derive(Default)]
struct Views(BTreeMap<Vec<Option<u32>>, View>);

#[derive(Clone, Copy)]
struct View {
    edges: usize,
    /// Number of the view by the first edge that shows it.
    first: usize,
    /// How many places there are.
    places: u32,
}

impl Views {
    fn add(&mut self, radial: &Radial) {
        let places = radial.ranks.iter().flatten().max().map_or(0, |r| r + 1);
        let Some(start) = radial.ranks.iter().flatten().next().copied() else { return };
        let key = radial.ranks.iter().map(|r| r.map(|r| (r + places - start) % places)).collect();
        let first = self.0.len();
        self.0.entry(key).or_insert(View { edges: 0, first, places }).edges += 1;
    }

    /// The sheets in cyclic order; those that coincide all along in one group.
    fn groups(&self) -> Option<Vec<Vec<u32>>> {
        let mut views: Vec<(&Vec<Option<u32>>, View)> = self.0.iter().map(|(k, v)| (k, *v)).collect();
        views.sort_by_key(|(_, v)| (std::cmp::Reverse(v.edges), v.first));
        // The first of those that tell most apart.
        let most = views.iter().map(|(_, v)| v.places).max()?;
        let base = views.iter().position(|(_, v)| v.places == most)?;
        let (ranks, _) = views.remove(base);
        let mut groups: Vec<Vec<u32>> = vec![Vec::new(); most as usize];
        for (i, rank) in (0..).zip(ranks) {
            if let Some(r) = rank {
                groups[*r as usize].push(i);
            }
        }
        let mut nowhere: Vec<u32> =
            (0..ranks.len() as u32).filter(|&i| ranks[i as usize].is_none()).collect();
        for (ranks, view) in views {
            if nowhere.is_empty() && groups.iter().all(|g| g.len() == 1) {
                break;
            }
            let from = |a: u32, b: u32| {
                let (a, b) = (ranks[a as usize]?, ranks[b as usize]?);
                Some((b + view.places - a) % view.places)
            };
            nowhere.retain(|&x| !insert(&mut groups, x, from));
            part(&mut groups, from);
        }
        groups.extend(nowhere.into_iter().map(|x| vec![x]));
        Some(groups)
    }
}

/// Puts a sheet that had no place behind the one that comes before it in another view; `from` counts places there.
fn insert(groups: &mut Vec<Vec<u32>>, x: u32, from: impl Fn(u32, u32) -> Option<u32>) -> bool {
    let before = |g: &[u32]| g.iter().filter_map(|&y| from(y, x)).min();
    let nearest = groups.iter().enumerate().filter_map(|(i, g)| Some((before(g)?, i))).min();
    if let Some((_, i)) = nearest {
        groups.insert(i + 1, vec![x]);
    }
    nearest.is_some()
}

/// Parts groups that another view tells apart, counted from a sheet of the group before.
fn part(groups: &mut Vec<Vec<u32>>, from: impl Fn(u32, u32) -> Option<u32>) {
    let old = std::mem::take(groups);
    for (i, group) in old.iter().enumerate() {
        let before = &old[(i + old.len() - 1) % old.len()];
        let start = before.iter().copied().find(|&y| old.len() > 1 && from(y, y).is_some());
        let Some(start) = start.filter(|_| group.len() > 1) else {
            groups.push(group.clone());
            continue;
        };
        let mut places: Vec<(Option<u32>, u32)> = group.iter().map(|&x| (from(start, x), x)).collect();
        places.sort_by_key(|p| p.0);
        groups.extend(places.chunk_by(|a, b| a.0 == b.0).map(|run| run.iter().map(|p| p.1).collect()));
    }
}

/// The groups in a row, those of several sheets so that entering and leaving alternate; started at the first sheet.
fn alternated(groups: Vec<Vec<u32>>, sides: &[Sheet]) -> Vec<Sheet> {
    let count = |g: &[u32], side| g.iter().filter(|&&i| sides[i as usize].side == side).count();
    // Where it is known what must come: at a sheet alone, or at a group that has more of one side.
    let known = groups
        .iter()
        .position(|g| g.len() == 1)
        .or_else(|| groups.iter().position(|g| count(g, Side::Left) != count(g, Side::Right)));
    let begin = known.unwrap_or(0);
    let first = &groups[begin];
    let mut wanted =
        if count(first, Side::Left) >= count(first, Side::Right) { Side::Left } else { Side::Right };
    let mut order = Vec::with_capacity(sides.len());
    for i in 0..groups.len() {
        let mut left = groups[(begin + i) % groups.len()].clone();
        while !left.is_empty() {
            let next = left.iter().position(|&i| sides[i as usize].side == wanted).unwrap_or(0);
            let sheet = left.remove(next);
            wanted = if sides[sheet as usize].side == Side::Left { Side::Right } else { Side::Left };
            order.push(sheet);
        }
    }
    let start = order.iter().position(|&i| i == 0).unwrap_or(0);
    order.rotate_left(start);
    order.into_iter().map(|i| sides[i as usize]).collect()
}
