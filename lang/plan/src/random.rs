//! Random numbers that are the same on every machine: xoshiro256** of Blackman and Vigna, seeded through SplitMix64.
//!
//! Owns the generator. Knows no clock: the seed is all that it depends on.

/// A generator.
#[derive(Clone, Debug)]
pub struct Random {
    words: [u64; 4],
}

impl Random {
    /// The generator of this seed; any number will do.
    pub fn new(seed: u64) -> Self {
        let mut at = seed;
        let mut word = || {
            at = at.wrapping_add(0x9e37_79b9_7f4a_7c15);
            let mut mixed = at;
            mixed = (mixed ^ (mixed >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
            mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
            mixed ^ (mixed >> 31)
        };
        Self {
            words: [word(), word(), word(), word()],
        }
    }

    /// The next 64 bits.
    pub fn bits(&mut self) -> u64 {
        let [a, b, c, d] = &mut self.words;
        let result = b.wrapping_mul(5).rotate_left(7).wrapping_mul(9);
        let shifted = *b << 17;
        *c ^= *a;
        *d ^= *b;
        *b ^= *c;
        *a ^= *d;
        *c ^= shifted;
        *d = d.rotate_left(45);
        result
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

    #[test]
    fn splitmix_and_xoshiro_give_their_published_numbers() {
        // SplitMix64 of seed 1234567 begins so by its reference implementation.
        assert_eq!(Random::new(1_234_567).words[0], 6_457_827_717_110_365_317);
        // xoshiro256** from the words 1, 2, 3, 4, by its reference implementation.
        let mut random = Random {
            words: [1, 2, 3, 4],
        };
        let first: Vec<u64> = (0..4).map(|_| random.bits()).collect();
        assert_eq!(first, [11520, 0, 1_509_978_240, 1_215_971_899_390_074_240]);
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
