//! Sequences of operations that fail, shrunk to the few that matter.
//!
//! Delta debugging (Zeller & Hildebrandt, *Simplifying and isolating failure-inducing input*, 2002): parts of the sequence
//! are left out, large ones first, as long as what is left still fails.

/// The shortest sequence found that still fails: it does not fail any more with any single operation left out. `None`
/// where the whole sequence does not fail.
///
/// `fails` replays a sequence from the start and says whether the failure shows. It must give the same answer for the same
/// sequence, and treat an operation that is refused, since what it needs was left out, as one that is not there.
///
/// Calls `fails` some `c² + c log n` times for `c` operations that matter out of `n`; at worst `n² + 3n` times.
///
/// ```
/// use mesh_kernel::body::edit::minimise;
///
/// // Three and eight fail together.
/// let fails = |all: &[u32]| all.contains(&3) && all.contains(&8);
/// let operations: Vec<u32> = (0..100).collect();
/// assert_eq!(minimise(&operations, fails), Some(vec![3, 8]));
/// assert_eq!(minimise(&[1, 2, 3], fails), None);
/// ```
pub fn minimise<O: Clone>(operations: &[O], fails: impl FnMut(&[O]) -> bool) -> Option<Vec<O>> {
    minimise_with(operations, |_| Vec::new(), fails)
}

/// As [`minimise`]; then operations are replaced by simpler ones where these fail too.
///
/// `simplify` gives what may stand for an operation, the simplest first; each must be simpler than the operation in an
/// order that has an end.
///
/// ```
/// use mesh_kernel::body::edit::minimise_with;
///
/// let simpler = |n: &u32| if *n > 0 { vec![0, n / 2, n - 1] } else { vec![] };
/// let fails = |all: &[u32]| all.iter().any(|n| *n >= 37);
/// assert_eq!(minimise_with(&[5, 900, 12, 64], simpler, fails), Some(vec![37]));
/// ```
pub fn minimise_with<O: Clone>(
    operations: &[O],
    mut simplify: impl FnMut(&O) -> Vec<O>,
    mut fails: impl FnMut(&[O]) -> bool,
) -> Option<Vec<O>> {
    if !fails(operations) {
        return None;
    }
    if fails(&[]) {
        return Some(Vec::new());
    }
    let mut kept = operations[..failing_prefix(operations, &mut fails)].to_vec();
    loop {
        leave_out(&mut kept, &mut fails);
        if !replace(&mut kept, &mut simplify, &mut fails) {
            return Some(kept);
        }
    }
}

/// Length of a prefix that fails: what comes after a failure has no part in it. O(log n) calls.
fn failing_prefix<O>(operations: &[O], fails: &mut impl FnMut(&[O]) -> bool) -> usize {
    let (mut passes, mut fails_at) = (0, operations.len());
    while fails_at - passes > 1 {
        let middle = passes + (fails_at - passes) / 2;
        if fails(&operations[..middle]) {
            fails_at = middle;
        } else {
            passes = middle;
        }
    }
    fails_at
}

/// Delta debugging down to a sequence of which no single operation can be left out.
fn leave_out<O: Clone>(kept: &mut Vec<O>, fails: &mut impl FnMut(&[O]) -> bool) {
    let mut parts = 2;
    while kept.len() > 1 {
        let starts: Vec<usize> = (0..=parts).map(|k| k * kept.len() / parts).collect();
        let part = |k: usize| starts[k]..starts[k + 1];
        // One part alone, only where there are few: later it almost never fails.
        let alone = (parts <= 4).then(|| (0..parts).find(|&k| fails(&kept[part(k)]))).flatten();
        if let Some(k) = alone {
            *kept = kept[part(k)].to_vec();
            parts = 2;
            continue;
        }
        // All but one part, from the end: what comes late is built on what comes early. A part that went leaves the
        // others as they were, so that the round goes on with them.
        let before = kept.len();
        for k in (0..parts).rev() {
            let mut rest = kept.clone();
            rest.drain(part(k));
            if fails(&rest) {
                *kept = rest;
            }
        }
        if kept.len() == before {
            if parts == kept.len() {
                return;
            }
            parts = (2 * parts).min(kept.len());
        } else {
            parts = parts.min(kept.len()).max(2);
        }
    }
}

/// Puts simpler operations in; `true` where one was.
fn replace<O: Clone>(
    kept: &mut [O],
    simplify: &mut impl FnMut(&O) -> Vec<O>,
    fails: &mut impl FnMut(&[O]) -> bool,
) -> bool {
    let mut replaced = false;
    for k in 0..kept.len() {
        'simpler: loop {
            for candidate in simplify(&kept[k]) {
                let own = std::mem::replace(&mut kept[k], candidate);
                if fails(kept) {
                    replaced = true;
                    continue 'simpler;
                }
                kept[k] = own;
            }
            break;
        }
    }
    replaced
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Numbers that are the same every time.
    struct Random(u64);

    impl Random {
        fn below(&mut self, n: usize) -> usize {
            self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
            ((self.0 >> 33) % n as u64) as usize
        }
    }

    #[test]
    fn planted_culprits_and_nothing_else_are_left() {
        let mut random = Random(1);
        let (mut most, mut all) = (0, 0);
        for round in 0..200 {
            let operations: Vec<usize> = (0..1000).collect();
            let mut culprits: Vec<usize> = (0..1 + round % 4).map(|_| random.below(1000)).collect();
            culprits.sort_unstable();
            culprits.dedup();
            let mut calls = 0;
            let found = minimise(&operations, |all| {
                calls += 1;
                culprits.iter().all(|c| all.contains(c))
            });
            assert_eq!(found, Some(culprits));
            most = most.max(calls);
            all += calls;
        }
        assert!(most <= 250 && all <= 200 * 100, "{most} calls at most, {all} in all");
    }

    #[test]
    fn what_is_left_cannot_lose_a_single_operation() {
        // Failures that need an even number of some kind, an order, or one of several: not monotone at all.
        let mut random = Random(7);
        for _ in 0..100 {
            let operations: Vec<usize> = (0..300).map(|_| random.below(9)).collect();
            let fails = |all: &[usize]| {
                let threes = all.iter().filter(|o| **o == 3).count();
                let order = all.iter().position(|o| *o == 5).zip(all.iter().rposition(|o| *o == 7));
                threes >= 2 && threes % 2 == operations.iter().filter(|o| **o == 3).count() % 2
                    || order.is_some_and(|(five, seven)| five < seven) && all.contains(&1)
            };
            let Some(found) = minimise(&operations, fails) else { continue };
            assert!(fails(&found) && found.len() <= 3, "{found:?}");
            for k in 0..found.len() {
                let mut less = found.clone();
                less.remove(k);
                assert!(!fails(&less), "{found:?}");
            }
        }
    }

    #[test]
    fn sequences_that_do_not_fail_or_always_fail() {
        assert_eq!(minimise(&[1, 2], |_| false), None);
        assert_eq!(minimise::<u8>(&[], |_| false), None);
        assert_eq!(minimise(&[1, 2], |_| true), Some(vec![]));
    }

    #[test]
    fn every_operation_may_matter() {
        let operations: Vec<usize> = (0..40).collect();
        let mut calls = 0;
        let found = minimise(&operations, |all| {
            calls += 1;
            all.len() == 40
        });
        assert_eq!((found, calls <= 40 * 40 + 3 * 40), (Some(operations), true));
    }
}
