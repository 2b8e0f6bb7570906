//! Which nodes of a surface are joined by an edge, kept while it is edited.

use std::collections::HashSet;
use std::hash::{BuildHasherDefault, Hasher};

use crate::body::Surface;

/// Pairs of joined nodes. It is asked, never iterated, so its order cannot reach a result.
///
/// A set, not a walk round a node: it is right where fans meet only at a node and where wires end there, and takes the
/// same time at nodes of any valence.
#[derive(Clone, Debug, Default)]
pub(super) struct EdgeSet(HashSet<u64, BuildHasherDefault<PairHasher>>);

fn key(a: u32, b: u32) -> u64 {
    let (lo, hi) = if a < b { (a, b) } else { (b, a) };
    u64::from(lo) << 32 | u64::from(hi)
}

impl EdgeSet {
    /// O(edges).
    pub(super) fn new(s: &Surface) -> Self {
        let mut set = HashSet::with_capacity_and_hasher(s.edges().len(), BuildHasherDefault::default());
        set.extend(s.edges().iter().map(|&[a, b]| key(a, b)));
        Self(set)
    }

    pub(super) fn insert(&mut self, a: u32, b: u32) {
        self.0.insert(key(a, b));
    }

    /// Forgets a pair. (Two edges of a slit that a joint makes one are one pair; they come and go together.)
    pub(super) fn remove(&mut self, a: u32, b: u32) {
        self.0.remove(&key(a, b));
    }

    pub(super) fn contains(&self, a: u32, b: u32) -> bool {
        self.0.contains(&key(a, b))
    }
}

/// Multiplies and folds: pairs of small neighbouring numbers spread over the table.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct PairHasher(u64);

impl Hasher for PairHasher {
    fn write(&mut self, bytes: &[u8]) {
        for &b in bytes {
            self.write_u64(self.0 ^ u64::from(b));
        }
    }

    fn write_u64(&mut self, x: u64) {
        let wide = u128::from(x) * 0x9e37_79b9_7f4a_7c15;
        self.0 = (wide >> 64) as u64 ^ wide as u64;
    }

    fn finish(&self) -> u64 {
        self.0
    }
}
