//! Joints of a template: found where surfaces share edges, or given by hand (T7).

use std::collections::{BTreeMap, BTreeSet};

use mesh_kernel::body::{ChainSpec, JointSpec};

use crate::complex::Patch;
use crate::error::TemplateError;
use crate::layout::Layout;

/// One surface at one edge: its local nodes in the direction of ascending template nodes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct EdgeUse {
    surface: u32,
    nodes: [u32; 2],
}

type EdgeUses = BTreeMap<[u32; 2], Vec<EdgeUse>>;

/// All edges by template nodes, with the surfaces that have them. An inner edge is one use, the two sides of a slit two.
fn edge_uses(patches: &[Patch]) -> EdgeUses {
    let mut out = EdgeUses::new();
    for (s, patch) in patches.iter().enumerate() {
        let mut seen = BTreeSet::new();
        for f in &patch.faces {
            for i in 0..3 {
                let (mut a, mut b) = (f[i], f[(i + 1) % 3]);
                if patch.nodes[a as usize] > patch.nodes[b as usize] {
                    (a, b) = (b, a);
                }
                if seen.insert([a, b]) {
                    let key = [patch.nodes[a as usize], patch.nodes[b as usize]];
                    out.entry(key).or_default().push(EdgeUse { surface: s as u32, nodes: [a, b] });
                }
            }
        }
    }
    out
}

/// Whether some surface has the edge.
pub(crate) fn missing_edge(layout: &Layout, patches: &[Patch]) -> Option<(String, u32, u32)> {
    let uses = edge_uses(patches);
    for line in &layout.lines {
        for [a, b] in crate::complex::chain_edges(&line.nodes, line.closed) {
            if !uses.contains_key(&[a, b]) {
                return Some((line.name.clone(), a, b));
            }
        }
    }
    None
}

/// The joints: those of the file, or else maximal chains of shared edges.
pub(crate) fn joints(layout: &Layout, patches: &[Patch]) -> Result<Vec<JointSpec>, TemplateError> {
    let mut out = match &layout.joints {
        Some(_) => explicit(layout, patches)?,
        None => found(patches),
    };
    // Names tell joints apart in seams, notches and reports.
    let mut counts: BTreeMap<String, u32> = BTreeMap::new();
    for joint in &mut out {
        let mut names: Vec<&str> =
            joint.chains.iter().map(|c| layout.surfaces[c.surface].name.as_str()).collect();
        names.dedup();
        let base = joint.name.clone().unwrap_or_else(|| names.join("/"));
        let count = counts.entry(base.clone()).or_insert(0);
        *count += 1;
        joint.name = Some(if *count == 1 { base } else { format!("{base} {count}") });
    }
    Ok(out)
}

/// A chain while it grows: template nodes and, for each use, local nodes.
struct Growing {
    nodes: Vec<u32>,
    locals: Vec<(u32, Vec<u32>)>,
}

fn found(patches: &[Patch]) -> Vec<JointSpec> {
    let uses = edge_uses(patches);
    let shared: BTreeMap<[u32; 2], &Vec<EdgeUse>> =
        uses.iter().filter(|(_, u)| u.len() >= 2).map(|(k, u)| (*k, u)).collect();
    let mut around: BTreeMap<u32, Vec<[u32; 2]>> = BTreeMap::new();
    for key in shared.keys() {
        key.iter().for_each(|n| around.entry(*n).or_default().push(*key));
    }
    let mut used: BTreeSet<[u32; 2]> = BTreeSet::new();
    let mut out = Vec::new();
    for (&key, first) in &shared {
        if !used.insert(key) {
            continue;
        }
        let locals = first.iter().map(|u| (u.surface, u.nodes.to_vec())).collect();
        let mut chain = Growing { nodes: key.to_vec(), locals };
        let mut closed = grow(&mut chain, &shared, &around, &mut used);
        if !closed {
            chain.nodes.reverse();
            chain.locals.iter_mut().for_each(|l| l.1.reverse());
            closed = grow(&mut chain, &shared, &around, &mut used);
        }
        let chains = chain.locals.into_iter().map(|(surface, mut nodes)| {
            if closed {
                nodes.pop();
            }
            ChainSpec { surface: surface as usize, nodes, closed }
        });
        out.push(JointSpec { name: None, chains: chains.collect() });
    }
    out
}

/// Prolongs a chain at its end as far as the same uses go on; `true` when it came back to its beginning.
fn grow(
    chain: &mut Growing,
    shared: &BTreeMap<[u32; 2], &Vec<EdgeUse>>,
    around: &BTreeMap<u32, Vec<[u32; 2]>>,
    used: &mut BTreeSet<[u32; 2]>,
) -> bool {
    loop {
        let (from, end) = (chain.nodes[chain.nodes.len() - 2], chain.nodes[chain.nodes.len() - 1]);
        let fits: Vec<([u32; 2], Vec<u32>)> = around[&end]
            .iter()
            .filter(|k| **k != [from.min(end), from.max(end)])
            .filter_map(|k| continued(chain, shared[k], k[0] == end).map(|next| (*k, next)))
            .collect();
        // Two ways on are a branch: the joint ends here.
        let [(key, next)] = &fits[..] else { return false };
        if !used.insert(*key) {
            return false;
        }
        let node = if key[0] == end { key[1] } else { key[0] };
        chain.nodes.push(node);
        for ((_, locals), n) in chain.locals.iter_mut().zip(next) {
            locals.push(*n);
        }
        if node == chain.nodes[0] {
            // Closed only when every surface comes back to the same node of its own.
            return chain.locals.iter().all(|(_, l)| l[0] == l[l.len() - 1]);
        }
    }
}

/// The local nodes with which an edge's uses continue the chain's, one for one; `None` when others meet there.
fn continued(chain: &Growing, uses: &[EdgeUse], forth: bool) -> Option<Vec<u32>> {
    if uses.len() != chain.locals.len() {
        return None;
    }
    let mut free: Vec<&EdgeUse> = uses.iter().collect();
    let mut out = Vec::with_capacity(uses.len());
    for (surface, locals) in &chain.locals {
        let end = locals[locals.len() - 1];
        let start = |u: &EdgeUse| if forth { u.nodes[0] } else { u.nodes[1] };
        let i = free.iter().position(|u| u.surface == *surface && start(u) == end)?;
        let u = free.remove(i);
        out.push(if forth { u.nodes[1] } else { u.nodes[0] });
    }
    Some(out)
}

fn explicit(layout: &Layout, patches: &[Patch]) -> Result<Vec<JointSpec>, TemplateError> {
    let uses = edge_uses(patches);
    let find_node = |n: &String| layout.nodes.iter().position(|m| m.name == *n).map(|i| i as u32);
    let find_surface = |n: &String| layout.surfaces.iter().position(|s| s.name == *n);
    let mut out = Vec::new();
    for (j, joint) in layout.joints.iter().flatten().enumerate() {
        let label = joint.name.clone().unwrap_or_else(|| format!("[{j}]"));
        let unknown =
            |what: &str, n: &str| TemplateError::BadJoint(format!("{label}: there is no {what} `{n}`"));
        let nodes: Vec<u32> = joint
            .nodes
            .iter()
            .map(|n| find_node(n).ok_or_else(|| unknown("node", n)))
            .collect::<Result<_, _>>()?;
        let mut chains: Vec<ChainSpec> = Vec::new();
        for name in &joint.surfaces {
            let surface = find_surface(name).ok_or_else(|| unknown("surface", name))?;
            let all = chains_of(&uses, surface as u32, &nodes, joint.closed);
            let taken = |c: &Vec<u32>| chains.iter().any(|k| k.surface == surface && k.nodes == *c);
            let Some(nodes) = all.into_iter().find(|c| !taken(c)) else {
                let problem = format!(
                    "{label}: the surface `{name}` has no (further) chain of edges through these nodes"
                );
                return Err(TemplateError::BadJoint(problem));
            };
            chains.push(ChainSpec { surface, nodes, closed: joint.closed });
        }
        out.push(JointSpec { name: joint.name.clone(), chains });
    }
    Ok(out)
}

/// The chains of local nodes of one surface along given template nodes.
fn chains_of(uses: &EdgeUses, surface: u32, nodes: &[u32], closed: bool) -> Vec<Vec<u32>> {
    let mut out: Vec<Vec<u32>> = Vec::new();
    let pairs =
        nodes.windows(2).map(|w| [w[0], w[1]]).chain(closed.then(|| [nodes[nodes.len() - 1], nodes[0]]));
    for (k, [a, b]) in pairs.enumerate() {
        let here: Vec<[u32; 2]> = uses
            .get(&[a.min(b), a.max(b)])
            .into_iter()
            .flatten()
            .filter(|u| u.surface == surface)
            .map(|u| if a < b { u.nodes } else { [u.nodes[1], u.nodes[0]] })
            .collect();
        if k == 0 {
            out = here.iter().map(|e| e.to_vec()).collect();
        } else {
            let mut longer = Vec::new();
            for chain in &out {
                for e in here.iter().filter(|e| e[0] == chain[chain.len() - 1]) {
                    longer.push(chain.iter().copied().chain([e[1]]).collect());
                }
            }
            out = longer;
        }
    }
    if closed {
        out.retain(|c| c[0] == c[c.len() - 1]);
        out.iter_mut().for_each(|c| {
            c.pop();
        });
    }
    out.sort();
    out.dedup();
    out
}
