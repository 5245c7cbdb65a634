//! Random numbers that are the same on every machine: xoshiro256** of Blackman and Vigna, seeded through SplitMix64.
//!
//! Owns the generator. Knows no clock: the seed is all that it depends on.

use rand_core::{Rng as _, SeedableRng as _};
use rand_xoshiro::Xoshiro256StarStar;

/// A generator.
#[derive(Clone, Debug)]
pub struct Random(Xoshiro256StarStar);

impl Random {
    /// The generator of this seed; any number will do.
    pub fn new(seed: u64) -> Self {
        Self(Xoshiro256StarStar::seed_from_u64(seed))
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        self.0.next_u64()
    }

    /// From 0 to 1, without 1.
    pub fn unit(&mut self) -> f64 {
        const STEPS: f64 = (1_u64 << 53) as f64;
        (self.bits() >> 11) as f64 / STEPS
    }

    /// From `low` to `high`, both included. The same number of bits is used up whatever the range is.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = self.unit();
        (low * (1.0 - unit) + high * unit).clamp(low.min(high), high.max(low))
    }

    /// A whole number from `low` to `high`, both included.
    pub fn whole(&mut self, low: u32, high: u32) -> u32 {
        let span = u64::from(high.saturating_sub(low)) + 1;
        // The upper bits of a product; its bias is below 2^-32.
        let at = ((self.bits() >> 32) * span) >> 32;
        low.saturating_add(u32::try_from(at).unwrap_or(0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// By the reference implementations: SplitMix64 gives the first four words, xoshiro256** the numbers.
    #[test]
    fn the_sequence_of_a_seed_never_changes() {
        let mut random = Random::new(1_234_567);
        let first: Vec<u64> = (0..3).map(|_| random.bits()).collect();
        assert_eq!(
            first,
            [
                3_504_822_795_582_309_479,
                1_819_558_768_956_484_042,
                1_250_851_346_055_027_673
            ]
        );
    }

    #[test]
    fn numbers_stay_in_their_range_and_fill_it() {
        let mut random = Random::new(3);
        let mut seen = [false; 5];
        let mut sum = 0.0;
        for _ in 0..10_000 {
            let whole = random.whole(3, 7);
            seen[whole as usize - 3] = true;
            let number = random.between(-2.0, 4.0);
            assert!((-2.0..=4.0).contains(&number));
            sum += number;
        }
        assert_eq!(seen, [true; 5]);
        assert!((sum / 10_000.0 - 1.0).abs() < 0.1);
        assert_eq!(random.between(0.7, 0.7), 0.7);
        assert_eq!(random.whole(9, 9), 9);
        assert!(random.whole(0, u32::MAX) > 0);
    }
}
