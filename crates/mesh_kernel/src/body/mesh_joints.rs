//! Joints of a mesh: its joint edges strung together, and nodes where surfaces only touch.

use std::collections::BTreeMap;

use super::build::{Run, RunJoint};
use super::from_tri_mesh::{Copies, EdgeUse, Groups, MeshEdges, Uses};
use super::ids::{DirectedEdge, EdgeId, NONE};
use super::surface::Surface;
use super::weld::UnionFind;
use crate::TriMesh;

/// Joint edges strung together to joints.
pub(super) fn trace_joints(
    mesh: &TriMesh,
    groups: &Groups,
    edges: &MeshEdges,
    uses: &Uses,
    surfaces: &[Surface],
) -> Vec<RunJoint> {
    let mut at_node: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    for &e in uses.keys() {
        for v in edges.nodes[e as usize] {
            at_node.entry(v).or_default().push(e);
        }
    }
    // The surface's node of a use at a node of the mesh.
    let local = |u: &EdgeUse, v: u32| {
        let f = u.side / 3;
        let i = mesh.faces[f as usize].iter().position(|&n| n == v).unwrap_or(0);
        surfaces[u.group as usize].faces[groups.local[f as usize] as usize][i]
    };
    let key = |u: &EdgeUse, v: u32| (u.group, u.inner, local(u, v));
    // The uses of `e` put into the order of the uses of another edge at a node; `None` where the joint ends there.
    let follow = |list: &[EdgeUse], v: u32, e: u32| -> Option<Vec<EdgeUse>> {
        let next = &uses[&e];
        if next.len() != list.len() {
            return None;
        }
        let mut out = Vec::with_capacity(list.len());
        for u in list {
            let mut same = next.iter().filter(|w| key(w, v) == key(u, v));
            let (found, more) = (same.next()?, same.next());
            if more.is_some() {
                return None;
            }
            // Boundary uses must go on along the same boundary, with their face on the same side.
            out.push(*found);
        }
        let mut distinct: Vec<u32> = out.iter().map(|u| u.side).collect();
        distinct.sort_unstable();
        distinct.dedup();
        (distinct.len() == out.len()).then_some(out)
    };
    let mut done = vec![false; edges.nodes.len()];
    let mut joints = Vec::new();
    for (&seed, list) in uses {
        if done[seed as usize] {
            continue;
        }
        done[seed as usize] = true;
        let [p, q] = edges.nodes[seed as usize];
        // Steps (edge, node where it starts, uses), walked on from q and back from p.
        let walk = |from: u32, done: &mut Vec<bool>| {
            let mut steps = Vec::new();
            let (mut v, mut e, mut at) = (from, seed, list.clone());
            while let [a, b] = at_node[&v][..] {
                let next = if a == e { b } else { a };
                if done[next as usize] {
                    break;
                }
                let Some(uses) = follow(&at, v, next) else { break };
                let consistent = at.iter().zip(&uses).all(|(u, w)| {
                    let start = |u: &EdgeUse| mesh.faces[u.side as usize / 3][u.side as usize % 3];
                    // One face's side ends at v, the other's starts there, or both are inner.
                    u.inner || ((start(u) == v) != (start(w) == v))
                });
                if !consistent {
                    break;
                }
                done[next as usize] = true;
                let ends = edges.nodes[next as usize];
                steps.push((next, v, uses.clone()));
                v = if ends[0] == v { ends[1] } else { ends[0] };
                (e, at) = (next, uses);
            }
            steps
        };
        let ahead = walk(q, &mut done);
        let behind = walk(p, &mut done);
        let mut steps: Vec<(u32, u32, Vec<EdgeUse>)> = Vec::new();
        for (e, v, uses) in behind.into_iter().rev() {
            let ends = edges.nodes[e as usize];
            steps.push((e, if ends[0] == v { ends[1] } else { ends[0] }, uses));
        }
        steps.push((seed, p, list.clone()));
        steps.extend(ahead);
        let runs = (0..list.len())
            .map(|i| {
                let mut run =
                    Run { surface: list[i].group, start: 0, edges: Vec::with_capacity(steps.len()) };
                for (k, (_, v, uses)) in steps.iter().enumerate() {
                    let u = &uses[i];
                    let (f, side) = (u.side / 3, u.side as usize % 3);
                    let s = &surfaces[u.group as usize];
                    let e = s.face_edges[groups.local[f as usize] as usize][side];
                    let start = local(u, *v);
                    if k == 0 {
                        run.start = start;
                    }
                    run.edges.push(DirectedEdge::new(EdgeId(e), s.edges[e as usize][0] != start));
                }
                run
            })
            .collect();
        joints.push(RunJoint { name: None, runs });
    }
    joints
}

/// Joints without edges for copies of a node that no other joint holds together.
pub(super) fn touching_nodes(
    mesh: &TriMesh,
    groups: &Groups,
    copies: &Copies,
    surfaces: &[Surface],
    joints: &[RunJoint],
) -> Vec<RunJoint> {
    let mut offsets = vec![0u32];
    for s in surfaces {
        offsets.push(offsets[offsets.len() - 1] + s.positions.len() as u32);
    }
    let mut sets = UnionFind::new(offsets[surfaces.len()] as usize);
    for joint in joints {
        let nodes = |r: &Run| -> Vec<u32> {
            let s = &surfaces[r.surface as usize];
            let offset = offsets[r.surface as usize];
            std::iter::once(r.start)
                .chain(r.edges.iter().map(|&d| s.ends(d)[1].0))
                .map(|v| offset + v)
                .collect()
        };
        let first = nodes(&joint.runs[0]);
        for run in &joint.runs[1..] {
            for (&a, b) in first.iter().zip(nodes(run)) {
                sets.union(a, b);
            }
        }
    }
    let mut seen: Vec<u32> = vec![NONE; mesh.positions.len()];
    let mut apart: BTreeMap<u32, Vec<(u32, u32)>> = BTreeMap::new();
    for (f, face) in mesh.faces.iter().enumerate() {
        let g = groups.of_face[f];
        for (i, &v) in face.iter().enumerate() {
            if copies.set[3 * f + i] != (3 * f + i) as u32 {
                continue;
            }
            let local = surfaces[g as usize].faces[groups.local[f] as usize][i];
            let node = offsets[g as usize] + local;
            if seen[v as usize] == NONE {
                seen[v as usize] = node;
            } else if sets.union(seen[v as usize], node) {
                let t = offsets.partition_point(|&o| o <= seen[v as usize]) - 1;
                let first = (t as u32, seen[v as usize] - offsets[t]);
                apart.entry(v).or_insert_with(|| vec![first]).push((g, local));
            }
        }
    }
    apart
        .into_values()
        .map(|list| {
            let run = |(surface, start)| Run { surface, start, edges: Vec::new() };
            RunJoint { name: None, runs: list.into_iter().map(run).collect() }
        })
        .collect()
}
