//! Numbering of distinct keys in the order in which they first appear.

/// A hash table from keys of `N` words to running numbers (open addressing, linear probing).
pub(crate) struct Welder<const N: usize> {
    slots: Vec<u32>,
    keys: Vec<[u64; N]>,
}

const EMPTY: u32 = u32::MAX;

impl<const N: usize> Welder<N> {
    /// An empty table with room for about `expected` keys.
    pub(crate) fn with_capacity(expected: usize) -> Self {
        Self {
            slots: vec![EMPTY; (expected * 2).next_power_of_two().max(16)],
            keys: Vec::with_capacity(expected),
        }
    }

    /// The number of `key`, and whether it is new.
    #[inline]
    pub(crate) fn number(&mut self, key: [u64; N]) -> (u32, bool) {
        if self.keys.len() * 2 > self.slots.len() {
            self.grow();
        }
        let mask = self.slots.len() - 1;
        let mut slot = hash(&key) as usize & mask;
        loop {
            match self.slots[slot] {
                EMPTY => {
                    let number = self.keys.len() as u32;
                    self.slots[slot] = number;
                    self.keys.push(key);
                    return (number, true);
                }
                number if self.keys[number as usize] == key => return (number, false),
                _ => slot = (slot + 1) & mask,
            }
        }
    }

    fn grow(&mut self) {
        let mask = self.slots.len() * 4 - 1;
        self.slots.clear();
        self.slots.resize(mask + 1, EMPTY);
        for (number, key) in self.keys.iter().enumerate() {
            let mut slot = hash(key) as usize & mask;
            while self.slots[slot] != EMPTY {
                slot = (slot + 1) & mask;
            }
            self.slots[slot] = number as u32;
        }
    }
}

/// Mixes all words (multiply and fold, the constants of `SplitMix64`).
#[inline]
fn hash<const N: usize>(key: &[u64; N]) -> u64 {
    let mut state = 0u64;
    for word in key {
        state = (state ^ word).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        state ^= state >> 32;
    }
    state = state.wrapping_mul(0xbf58_476d_1ce4_e5b9);
    state ^ (state >> 29)
}

/// A coordinate as a key: equal numbers have equal keys (both zeros are one).
#[inline]
pub(crate) fn key(value: f64) -> u64 {
    (value + 0.0).to_bits()
}
