//! Numbered slots whose numbers stay while an entity lives, and come back in the opposite order in which they went.

use std::collections::VecDeque;

use serde::{Deserialize, Serialize};

/// Slots with a stack of free numbers.
///
/// The numbers never used so far lie, descending, under the stack, as if it were infinite: `… n+1, n | free`. Stored is the
/// part above; a free number at its bottom that continues the descent is taken into the rest. So taking a number and giving it
/// back is the identity on the stored bits, in either order.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub(super) struct Slots<T> {
    slots: Vec<Option<T>>,
    free: VecDeque<u32>,
}

impl<T> Default for Slots<T> {
    fn default() -> Self {
        Self { slots: Vec::new(), free: VecDeque::new() }
    }
}

/// What is wrong with the stack of free numbers.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum SlotFault {
    /// A number that is free and taken at once, out of range, or twice on the stack.
    NotFree(u32),
    /// An empty slot that is not on the stack.
    Lost(u32),
    /// The bottom of the stack continues the descent of unused numbers.
    NotNormal(u32),
}

impl<T> Slots<T> {
    /// The number that the next entity gets.
    pub(super) fn next(&self) -> u32 {
        self.free.back().copied().unwrap_or(self.slots.len() as u32)
    }

    pub(super) fn insert(&mut self, value: T) -> u32 {
        match self.free.pop_back() {
            Some(id) => {
                self.slots[id as usize] = Some(value);
                id
            }
            None => {
                self.slots.push(Some(value));
                self.slots.len() as u32 - 1
            }
        }
    }

    pub(super) fn remove(&mut self, id: u32) -> Option<T> {
        let value = self.slots.get_mut(id as usize)?.take()?;
        self.free.push_back(id);
        while self.free.front().is_some_and(|&f| f as usize + 1 == self.slots.len()) {
            self.free.pop_front();
            self.slots.pop();
        }
        Some(value)
    }

    #[inline]
    pub(super) fn get(&self, id: u32) -> Option<&T> {
        self.slots.get(id as usize)?.as_ref()
    }

    #[inline]
    pub(super) fn get_mut(&mut self, id: u32) -> Option<&mut T> {
        self.slots.get_mut(id as usize)?.as_mut()
    }

    pub(super) fn iter(&self) -> impl Iterator<Item = (u32, &T)> {
        self.slots.iter().enumerate().filter_map(|(i, s)| Some((i as u32, s.as_ref()?)))
    }

    /// How many live.
    pub(super) fn len(&self) -> usize {
        self.slots.len() - self.free.len()
    }

    /// One more than the greatest number in use or on the stack.
    pub(super) fn bound(&self) -> usize {
        self.slots.len()
    }

    /// O(slots).
    pub(super) fn faults(&self) -> Vec<SlotFault> {
        let mut faults = Vec::new();
        let mut seen = vec![false; self.slots.len()];
        for &f in &self.free {
            match seen.get_mut(f as usize) {
                Some(seen) if !*seen && self.slots[f as usize].is_none() => *seen = true,
                _ => faults.push(SlotFault::NotFree(f)),
            }
        }
        for (i, slot) in self.slots.iter().enumerate() {
            if slot.is_none() && !seen[i] {
                faults.push(SlotFault::Lost(i as u32));
            }
        }
        if let Some(&f) = self.free.front()
            && f as usize + 1 == self.slots.len()
        {
            faults.push(SlotFault::NotNormal(f));
        }
        faults
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn taking_back_is_the_identity_in_both_orders() {
        let mut s = Slots::default();
        (0..5).for_each(|i| {
            s.insert(i);
        });
        s.remove(3);
        let before = s.clone();
        // Kill, then make again.
        let x = s.remove(4).unwrap();
        assert_eq!(s.next(), 4);
        s.insert(x);
        assert_eq!(s, before);
        // Make, then kill, over the end of the stack.
        assert_eq!(s.next(), 3);
        let [a, b] = [7, 8].map(|x| s.insert(x));
        assert_eq!([a, b], [3, 5]);
        s.remove(b);
        s.remove(a);
        assert_eq!(s, before);
        assert_eq!(s.faults(), []);
    }
}
