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

    /// Finds the radial order of a joint's sheets anew from the geometry and stores it: the order that most of its
    /// edges have, of those without ties if there are any. O(length · sheets · log sheets) exact predicates.
    ///
    /// Splits keep the stored order, as they must: it says how the sheets are joined. To be called where nodes were
    /// moved so far that sheets have changed places about the joint.
    pub fn order_joint(&mut self, joint: JointId) {
        let len = self.joint_len(joint);
        if len == 0 {
            return;
        }
        let mut votes: BTreeMap<(bool, Vec<Sheet>), usize> = BTreeMap::new();
        for k in 0..len {
            let sheets = self.sheets_at(joint, k);
            if let Some(radial) = self.geometric_order(joint, k, &sheets) {
                // Started at the sheet that comes first by use and side, so that equal orders are equal lists.
                let first = radial.order.iter().position(|&i| i == 0).unwrap_or(0);
                let turned = radial.order[first..].iter().chain(&radial.order[..first]);
                let order = turned.map(|&i| sheets[i as usize].0).collect();
                *votes.entry((radial.tied(), order)).or_default() += 1;
            }
        }
        let untied = votes.keys().any(|(tied, _)| !tied);
        let mut best: Option<(usize, &Vec<Sheet>)> = None;
        for ((tied, order), &n) in &votes {
            if !(untied && *tied) && best.is_none_or(|(most, _)| n > most) {
                best = Some((n, order));
            }
        }
        let order = match best {
            Some((_, order)) => order.clone(),
            None => self.sheets_at(joint, 0).into_iter().map(|(s, _)| s).collect(),
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
