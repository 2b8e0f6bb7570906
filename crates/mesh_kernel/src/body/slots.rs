//! Numbers that stay: which are taken, which are free, and in what order free ones are given again.
//!
//! An entity keeps its number while it lives (a *sparse* surface has free numbers in between, a *compact* one has none).
//! Free numbers are given again last in, first out, so that an operator and its inverse are mirror images of each other:
//! making takes what killing just put back. [`super::Body::compact`] closes the gaps.

/// The free numbers of one kind of entity.
#[derive(Clone, Debug, Default)]
pub(crate) struct Slots {
    /// Free numbers; the last is given next.
    free: Vec<u32>,
    /// A bit for every number that is free; numbers beyond its end are taken.
    bits: Vec<u64>,
}

/// The order in which numbers became free is all there is; the bits follow from it.
impl PartialEq for Slots {
    fn eq(&self, other: &Self) -> bool {
        self.free == other.free
    }
}

impl Eq for Slots {}

impl Slots {
    /// Free numbers in the order in which they became free.
    pub(crate) fn from_free(free: Vec<u32>) -> Self {
        let mut slots = Self::default();
        free.into_iter().for_each(|i| slots.release(i));
        slots
    }

    /// Free numbers, the one given next last.
    pub(crate) fn free(&self) -> &[u32] {
        &self.free
    }

    #[inline]
    pub(crate) fn is_compact(&self) -> bool {
        self.free.is_empty()
    }

    #[inline]
    pub(crate) fn is_free(&self, i: u32) -> bool {
        !self.free.is_empty() && self.bits.get(i as usize / 64).is_some_and(|w| w >> (i % 64) & 1 == 1)
    }

    /// The number that is given next, of an array that is `len` long.
    pub(crate) fn next(&self, len: usize) -> u32 {
        self.upcoming(len, 0)
    }

    /// The number that is given after `k` others.
    pub(crate) fn upcoming(&self, len: usize, k: usize) -> u32 {
        match self.free.len().checked_sub(k + 1) {
            Some(i) => self.free[i],
            None => (len + k - self.free.len()) as u32,
        }
    }

    /// Takes the number freed last; `None` where there is none and the array has to grow.
    pub(crate) fn take(&mut self) -> Option<u32> {
        let i = self.free.pop()?;
        self.bits[i as usize / 64] &= !(1 << (i % 64));
        Some(i)
    }

    pub(crate) fn release(&mut self, i: u32) {
        let word = i as usize / 64;
        if self.bits.len() <= word {
            self.bits.resize(word + 1, 0);
        }
        self.bits[word] |= 1 << (i % 64);
        self.free.push(i);
    }
}

/// The free numbers of a surface.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(crate) struct SurfaceSlots {
    pub(crate) nodes: Slots,
    pub(crate) edges: Slots,
    pub(crate) faces: Slots,
    pub(crate) chains: Slots,
}

impl SurfaceSlots {
    pub(crate) fn is_compact(&self) -> bool {
        self.nodes.is_compact()
            && self.edges.is_compact()
            && self.faces.is_compact()
            && self.chains.is_compact()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_was_freed_last_is_given_first() {
        let mut slots = Slots::default();
        assert_eq!((slots.next(7), slots.take()), (7, None));
        slots.release(200);
        slots.release(3);
        assert!(slots.is_free(3) && slots.is_free(200) && !slots.is_free(64) && !slots.is_free(9_999));
        assert_eq!((slots.next(300), slots.take(), slots.take()), (3, Some(3), Some(200)));
        assert!(!slots.is_free(3) && slots.is_compact());
        assert_eq!(slots, Slots::default());
    }
}
