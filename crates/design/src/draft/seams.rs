//! Joints made and split by hand.

use std::collections::BTreeSet;

use template::format::{JointSpec, TemplateFile};

use super::edit::missing;
use super::topology::{joints, pair};
use super::{Draft, EditError};

/// The edges of a joint, in order along it.
fn edges_of(joint: &JointSpec) -> Vec<[String; 2]> {
    let ends = joint.nodes.windows(2).map(|w| pair(&w[0], &w[1]));
    let last = match (joint.closed, joint.nodes.first(), joint.nodes.last()) {
        (true, Some(first), Some(last)) => Some(pair(last, first)),
        _ => None,
    };
    ends.chain(last).collect()
}

/// What is left of a joint along its chain without some of its edges: at every gap it ends.
fn without(joint: &JointSpec, gone: &BTreeSet<[String; 2]>) -> Vec<Vec<String>> {
    let mut nodes = joint.nodes.clone();
    if joint.closed {
        // Begun at a gap it is an open chain.
        let edges = edges_of(joint);
        let first = edges.iter().position(|e| gone.contains(e)).unwrap_or_default();
        let count = nodes.len();
        nodes.rotate_left((first + 1) % count);
        nodes.push(nodes[0].clone());
    }
    let mut chains: Vec<Vec<String>> = vec![nodes[..1].to_vec()];
    for w in nodes.windows(2) {
        if gone.contains(&pair(&w[0], &w[1])) {
            chains.push(Vec::new());
        }
        if let Some(chain) = chains.last_mut() {
            chain.push(w[1].clone());
        }
    }
    chains.retain(|c| c.len() > 1);
    chains
}

/// Adds a joint. Where others hold its edges for its surfaces already it is cut out of them: they keep the rest of their
/// chains, and their other surfaces, when two are left, stay joined beside it.
///
/// # Errors
/// [`EditError::Held`]: it is there already, it joins surfaces or edges of several joints, one surface would be left alone.
pub(super) fn make_joint(draft: &mut Draft, joint: &JointSpec) -> Result<(), EditError> {
    let file = &mut draft.template;
    let mut all = listed(file);
    let wanted: BTreeSet<[String; 2]> = edges_of(joint).into_iter().collect();
    let surfaces: BTreeSet<&String> = joint.surfaces.iter().collect();
    let holds = |old: &JointSpec| {
        old.surfaces.iter().any(|s| surfaces.contains(s)) && edges_of(old).iter().any(|e| wanted.contains(e))
    };
    let Some(number) = all.iter().position(holds) else {
        all.push(joint.clone());
        file.joints = Some(all);
        return Ok(());
    };
    let old = all[number].clone();
    let refused = |why: String| EditError::Held {
        joint: number,
        name: old.name.clone().unwrap_or_else(|| old.surfaces.join(" + ")),
        why,
    };
    let have: BTreeSet<[String; 2]> = edges_of(&old).into_iter().collect();
    if let Some([a, b]) = wanted.iter().find(|e| !have.contains(*e)) {
        return Err(refused(format!("{a} – {b} is no edge of it; take edges of one joint")));
    }
    if let Some(other) = surfaces.iter().find(|s| !old.surfaces.contains(*s)) {
        return Err(refused(format!("`{other}` has no part in it; take surfaces of one joint")));
    }
    let rest: Vec<String> = old.surfaces.iter().filter(|s| !surfaces.contains(s)).cloned().collect();
    if let [alone] = &rest[..] {
        return Err(refused(format!(
            "`{alone}` would be left alone; take all of its surfaces, or all but two"
        )));
    }
    if rest.is_empty() && wanted == have {
        return Err(refused("it is that very joint".to_owned()));
    }
    let chains = without(&old, &wanted);
    // Names are given once.
    let mut made = vec![joint.clone()];
    if !rest.is_empty() {
        made.push(JointSpec { name: None, surfaces: rest, ..joint.clone() });
    }
    made.extend(chains.into_iter().enumerate().map(|(k, nodes)| JointSpec {
        name: old.name.clone().filter(|_| k == 0),
        surfaces: old.surfaces.clone(),
        nodes,
        closed: false,
    }));
    all.splice(number..=number, made);
    file.joints = Some(all);
    Ok(())
}

/// The joints that are listed, else those that make themselves.
fn listed(file: &TemplateFile) -> Vec<JointSpec> {
    file.joints.clone().unwrap_or_else(|| joints(file))
}

/// Makes two joints of one, along all of it: the first takes the surfaces named.
pub(super) fn split_joint(draft: &mut Draft, joint: usize, first: &[String]) -> Result<(), EditError> {
    let file = &mut draft.template;
    let mut all = listed(file);
    let refused = |why: &str| EditError::Value { what: format!("joint {joint}"), why: why.to_owned() };
    let old = all.get(joint).cloned().ok_or_else(|| missing("joint", &joint.to_string()))?;
    let (a, b): (Vec<_>, Vec<_>) = old.surfaces.iter().cloned().partition(|s| first.contains(s));
    if a.len() < 2 || b.len() < 2 || a.len() != first.len() {
        return Err(refused("both parts need two of its surfaces at least"));
    }
    let name = |part: &str| old.name.as_ref().map(|n| format!("{n}_{part}"));
    all[joint] = JointSpec { name: name("first"), surfaces: a, ..old.clone() };
    all.insert(joint + 1, JointSpec { name: name("second"), surfaces: b, ..old });
    file.joints = Some(all);
    Ok(())
}
