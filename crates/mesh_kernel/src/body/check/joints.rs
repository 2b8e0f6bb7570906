//! Joints: equal lengths, directions, coincidence, radial order.

use super::Defect;
use crate::body::{Body, ChainId, JointId, NodeId, Sheet};

/// Lengths, membership, and the list of sheets.
pub(super) fn check_topology(body: &Body, defects: &mut Vec<Defect>) {
    membership(body, defects);
    for (id, joint) in body.joints() {
        if joint.uses.len() < 2 {
            defects.push(Defect::TooFewUses { joint: id, uses: joint.uses.len() });
            continue;
        }
        let lengths: Vec<usize> =
            joint.uses.iter().map(|u| body.surface(u.surface).chain(u.chain).edges.len()).collect();
        if lengths.iter().any(|&n| n != lengths[0]) {
            defects.push(Defect::JointLength { joint: id, lengths });
            continue;
        }
        if lengths[0] > 0 {
            sheets(body, id, defects);
        }
    }
}

fn membership(body: &Body, defects: &mut Vec<Defect>) {
    let mut found: Vec<Vec<Vec<JointId>>> =
        body.surfaces.iter().map(|s| vec![Vec::new(); s.chains.len()]).collect();
    for (id, joint) in body.joints() {
        for u in &joint.uses {
            found[u.surface.index()][u.chain.index()].push(id);
        }
    }
    for ((id, s), found) in body.surfaces().zip(found) {
        for (c, (chain, found)) in s.chains.iter().zip(found).enumerate() {
            if found.as_slice() != chain.joint.as_slice() {
                let chain_id = ChainId(c as u32);
                defects.push(Defect::ChainJoint {
                    surface: id,
                    chain: chain_id,
                    recorded: chain.joint,
                    found,
                });
            }
        }
    }
}

fn sheets(body: &Body, id: JointId, defects: &mut Vec<Defect>) {
    let joint = body.joint(id);
    let found: Vec<Sheet> = body.sheets_at(id, 0).into_iter().map(|(s, _)| s).collect();
    let mut stored = joint.radial.clone();
    stored.sort_unstable();
    // Uses stand in the order of their first sheets.
    let mut seen = 0;
    let ordered = joint.radial.iter().all(|s| {
        let fits = s.use_index <= seen;
        seen = seen.max(s.use_index + 1);
        fits
    });
    if stored != found || !ordered {
        defects.push(Defect::RadialSheets { joint: id, stored: joint.radial.clone(), found });
    }
}

/// Corresponding nodes are in the same place, bit for bit.
pub(super) fn check_coincidence(body: &Body, defects: &mut Vec<Defect>) {
    for (id, joint) in body.joints() {
        let position = |i: usize, v: u32| body.surface(joint.uses[i].surface).positions[v as usize];
        let first = body.joint_nodes(id, 0);
        for use_index in 1..joint.uses.len() {
            let own = body.joint_nodes(id, use_index);
            let apart = |a: u32, b: u32| position(0, a) != position(use_index, b);
            let Some(at) = first.iter().zip(&own).position(|(&a, &b)| apart(a, b)) else { continue };
            if own.len() > 1 && !first.iter().zip(own.iter().rev()).any(|(&a, &b)| apart(a, b)) {
                defects.push(Defect::JointDirection { joint: id, use_index });
                continue;
            }
            for (at, (&a, &b)) in
                first.iter().zip(&own).enumerate().skip(at).filter(|(_, (a, b))| apart(**a, **b))
            {
                let distance = position(0, a).distance(position(use_index, b));
                defects.push(Defect::JointApart { joint: id, use_index, at, node: NodeId(b), distance });
            }
        }
    }
}

/// The stored order goes round every edge once, clockwise. Sheets that leave in exactly the same direction may stand
/// either way.
pub(super) fn check_radial_order(body: &Body, defects: &mut Vec<Defect>) {
    for (id, joint) in body.joints() {
        let mut first: Option<(usize, Vec<Sheet>)> = None;
        let mut edges = 0;
        for k in 0..body.joint_len(id) {
            let sheets = body.sheets_at(id, k);
            let Some(radial) = body.geometric_order(id, k, &sheets) else { continue };
            let index = |s: &Sheet| sheets.iter().position(|(x, _)| x == s).map(|i| i as u32);
            let stored: Vec<u32> = joint.radial.iter().filter_map(index).collect();
            if !radial.agrees(&stored) {
                edges += 1;
                first
                    .get_or_insert_with(|| (k, radial.order.iter().map(|&i| sheets[i as usize].0).collect()));
            }
        }
        if let Some((at, geometric)) = first {
            defects.push(Defect::RadialOrder {
                joint: id,
                at,
                edges,
                stored: joint.radial.clone(),
                geometric,
            });
        }
    }
}
