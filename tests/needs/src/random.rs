//! Numbers that look random and are the same in each run, for tests and benchmarks.
//!
//! Owns the generator: xorshift of 32 bits (Marsaglia, Xorshift RNGs, 2003), from a seed that is stirred, so that seeds
//! beside each other give sequences that differ from the first number on. Knows no test and prints nothing.

/// A sequence of numbers.
#[derive(Clone, Debug)]
pub struct Random(u32);

impl Random {
    /// The sequence of a seed.
    pub fn new(seed: u32) -> Self {
        // The last steps of MurmurHash3, which map different seeds to different states.
        let mut state = seed;
        state = (state ^ (state >> 16)).wrapping_mul(0x85eb_ca6b);
        state = (state ^ (state >> 13)).wrapping_mul(0xc2b2_ae35);
        state ^= state >> 16;
        // A generator of this kind never leaves zero.
        Self(state.max(1))
    }

    /// The next number, any but 0.
    pub fn bits(&mut self) -> u32 {
        self.0 ^= self.0 << 13;
        self.0 ^= self.0 >> 17;
        self.0 ^= self.0 << 5;
        self.0
    }

    /// The next number below a limit; 0 if that is 0.
    pub fn below(&mut self, limit: usize) -> usize {
        self.bits() as usize % limit.max(1)
    }

    /// The next byte.
    pub fn byte(&mut self) -> u8 {
        self.bits().to_le_bytes()[1]
    }

    /// The next number from -1 to 1, with 53 bits.
    pub fn signed(&mut self) -> f64 {
        let bits = u64::from(self.bits()) << 32 | u64::from(self.bits());
        (bits >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn seeds_beside_each_other_begin_with_different_numbers() {
        let mut firsts: Vec<u32> = (0..1000).map(|seed| Random::new(seed).bits()).collect();
        firsts.sort_unstable();
        firsts.dedup();
        // 0 and one other seed may share the state 1.
        assert!(firsts.len() >= 999, "{}", firsts.len());
    }

    #[test]
    fn numbers_stay_within_their_bounds_and_reach_them() {
        let mut random = Random::new(7);
        let mut seen = [false; 5];
        for _ in 0..200 {
            seen[random.below(5)] = true;
            assert!((-1.0..=1.0).contains(&random.signed()));
        }
        assert_eq!(seen, [true; 5]);
        assert_eq!(random.below(0), 0);
        assert_eq!(random.below(1), 0);
    }
}
