//! Random numbers from a seed: the same ones everywhere.

/// A generator: xorshift64* (Vigna, 2016).
pub struct Noise(u64);

impl Noise {
    /// A generator of its own for each seed, which is not 0.
    pub fn new(seed: u64) -> Self {
        let mut noise = Self(seed);
        // The first numbers of a small seed are small.
        for _ in 0..8 {
            noise.uniform();
        }
        noise
    }

    /// From 0 to below 1.
    pub fn uniform(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let high = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32;
        high as f64 / f64::from(u32::MAX)
    }

    /// Nearly normal, with this standard deviation: the sum of twelve uniform numbers.
    pub fn normal(&mut self, deviation: f64) -> f64 {
        let sum: f64 = (0..12).map(|_| self.uniform()).sum();
        (sum - 6.0) * deviation
    }
}
