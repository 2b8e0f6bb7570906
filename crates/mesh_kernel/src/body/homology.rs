//! Betti numbers of the welded complex over GF(2), from its boundary matrices.
//!
//! The rank of ∂₁ (edges → nodes) is the size of a spanning forest. The rank of ∂₂ (faces → edges) is found by the
//! same idea one dimension up: an edge with two faces is a pivot that merges them, so that union–find removes all of
//! the matrix except the patches between non-manifold edges; what is left is small and eliminated directly.

use std::collections::{BTreeMap, BTreeSet};

use super::weld::UnionFind;
use super::welded::Welded;

/// Ranks of the boundary matrices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Ranks {
    /// Of ∂₁: edges of a spanning forest.
    pub(crate) first: u32,
    /// Of ∂₂.
    pub(crate) second: u32,
}

/// Near O(faces) for bodies of few patches; the rest costs at most patches² · distinct joint edges.
pub(crate) fn ranks(complex: &Welded) -> Ranks {
    let mut nodes = UnionFind::new(complex.weld.count);
    let first = complex.edges.iter().filter(|[a, b]| nodes.union(*a, *b)).count() as u32;

    let mut faces = UnionFind::new(complex.face_count() as usize);
    let mut second = 0;
    for e in 0..complex.edges.len() {
        let mut uses = complex.uses(e);
        if uses.len() == 2
            && let (Some(a), Some(b)) = (uses.next(), uses.next())
        {
            second += u32::from(faces.union(a.face, b.face));
        }
    }
    // Rows of the rest: patches that stand at an edge an odd number of times.
    let mut rows: BTreeSet<Vec<u32>> = BTreeSet::new();
    for e in 0..complex.edges.len() {
        if complex.uses(e).len() != 2 {
            let mut row: Vec<u32> = complex.uses(e).map(|u| faces.find(u.face)).collect();
            row.sort_unstable();
            let row = odd(&row);
            if !row.is_empty() {
                rows.insert(row);
            }
        }
    }
    Ranks { first, second: second + rank(rows) }
}

/// Members of a sorted list that stand in it an odd number of times.
fn odd(sorted: &[u32]) -> Vec<u32> {
    sorted.chunk_by(|a, b| a == b).filter(|run| run.len() % 2 == 1).map(|run| run[0]).collect()
}

/// Rank over GF(2) of sparse rows, each a sorted list of columns.
fn rank(rows: BTreeSet<Vec<u32>>) -> u32 {
    let mut pivots: BTreeMap<u32, Vec<u32>> = BTreeMap::new();
    // Short rows first: they keep the others short.
    let mut rows: Vec<Vec<u32>> = rows.into_iter().collect();
    rows.sort_by_key(Vec::len);
    for mut row in rows {
        while let Some(&lead) = row.first() {
            match pivots.get(&lead) {
                Some(pivot) => {
                    let mut sum: Vec<u32> = row.iter().chain(pivot).copied().collect();
                    sum.sort_unstable();
                    row = odd(&sum);
                }
                None => {
                    pivots.insert(lead, row);
                    break;
                }
            }
        }
    }
    pivots.len() as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rank_of_the_cycle_space_of_a_triangle_is_two() {
        let rows = [vec![0, 1], vec![1, 2], vec![0, 2]].into_iter().collect();
        assert_eq!(rank(rows), 2);
        assert_eq!(odd(&[1, 1, 2, 3, 3, 3]), [2, 3]);
    }
}
