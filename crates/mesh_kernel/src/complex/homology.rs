//! Ranks of boundary matrices over GF(2).
//!
//! A face with rings is cut along a bridge to each ring: the bridge is walked twice, so the boundary of the face is the sum of its
//! loops, and each bridge is one more edge of the graph.

use std::collections::{BTreeMap, BTreeSet};

use super::connected::Sets;
use super::ids::{EdgeId, Loop};

/// Rank of the matrix that takes faces to the edges that they walk an odd number of times.
///
/// An edge with two such faces merges them (union–find); what is left between the non-manifold edges is eliminated. Near O(loops)
/// for complexes of few patches, at most patches² · distinct rows else.
pub(super) fn rank_of_faces<'a>(faces: impl Iterator<Item = &'a [Loop]>) -> u32 {
    let mut at_edge: BTreeMap<EdgeId, Vec<u32>> = BTreeMap::new();
    let mut count = 0;
    for loops in faces {
        for d in loops.iter().flat_map(Loop::edges) {
            at_edge.entry(d.edge).or_default().push(count);
        }
        count += 1;
    }
    // Faces come in ascending order, so the lists are sorted.
    let mut patches = Sets::new(count as usize);
    let mut rank = 0;
    for faces in at_edge.values_mut() {
        *faces = odd(faces);
        if let [a, b] = faces[..] {
            rank += u32::from(patches.union(a, b));
        }
    }
    let mut rows: BTreeSet<Vec<u32>> = BTreeSet::new();
    for faces in at_edge.values() {
        if faces.len() != 2 {
            let mut row: Vec<u32> = faces.iter().map(|f| patches.find(*f)).collect();
            row.sort_unstable();
            rows.insert(odd(&row));
        }
    }
    rows.remove(&Vec::new());
    rank + eliminate(rows)
}

/// Members of a sorted list that stand in it an odd number of times.
fn odd(sorted: &[u32]) -> Vec<u32> {
    sorted.chunk_by(|a, b| a == b).filter(|run| run.len() % 2 == 1).map(|run| run[0]).collect()
}

/// Rank of sparse rows, each a sorted list of columns.
fn eliminate(rows: BTreeSet<Vec<u32>>) -> u32 {
    let mut pivots: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    let mut rows: Vec<Vec<u32>> = rows.into_iter().collect();
    // Short rows first: they keep the others short.
    rows.sort_by_key(Vec::len);
    for mut row in rows {
        while let Some(&lead) = row.first() {
            let Some(pivot) = pivots.get(&lead) else {
                pivots.insert(lead, row);
                break;
            };
            let mut sum: Vec<u32> = row.iter().chain(pivot).copied().collect();
            sum.sort_unstable();
            row = odd(&sum);
        }
    }
    pivots.len() as u32
}
