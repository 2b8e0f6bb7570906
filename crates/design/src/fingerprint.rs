//! A short name for the inputs of a run, so that a resumed batch knows what is still as it was.

/// 64-bit FNV-1a over parts; the parts' lengths go in too, so that moving a byte from one to the next shows.
///
/// It tells changed inputs apart, it does not guard against a forger.
#[derive(Clone, Debug)]
pub(crate) struct Fingerprint(u64);

impl Default for Fingerprint {
    fn default() -> Self {
        Self(0xcbf2_9ce4_8422_2325)
    }
}

impl Fingerprint {
    /// Takes in one input.
    #[must_use]
    pub(crate) fn with(mut self, part: &[u8]) -> Self {
        for byte in (part.len() as u64).to_le_bytes().iter().chain(part) {
            self.0 = (self.0 ^ u64::from(*byte)).wrapping_mul(0x0000_0100_0000_01b3);
        }
        self
    }

    /// Sixteen hexadecimal digits.
    pub(crate) fn text(&self) -> String {
        format!("{:016x}", self.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_do_not_run_together() {
        let ab_c = Fingerprint::default().with(b"ab").with(b"c").text();
        let a_bc = Fingerprint::default().with(b"a").with(b"bc").text();
        assert_ne!(ab_c, a_bc);
        assert_eq!(ab_c, Fingerprint::default().with(b"ab").with(b"c").text());
    }
}
