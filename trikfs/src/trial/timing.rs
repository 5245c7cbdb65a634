//! How long conversions took, in a table of fixed size however many there were.
//!
//! Owns the arithmetic of its percentiles: buckets of a 32nd of their power of two, so that what is shown is at most
//! 3 % more than what was measured. Knows no clock.

use std::fmt::Write;
use std::time::Duration;

/// Buckets for each power of two.
const STEPS: usize = 32;
/// Up to 2^40 ns, which is 18 minutes.
const BUCKETS: usize = 36 * STEPS;

/// Durations of single conversions.
pub struct Timing {
    buckets: Box<[u32]>,
    count: u64,
    sum_ns: u64,
    max_ns: u64,
}

impl Default for Timing {
    fn default() -> Self {
        Self {
            buckets: vec![0; BUCKETS].into(),
            count: 0,
            sum_ns: 0,
            max_ns: 0,
        }
    }
}

/// Below 32 ns the number itself, above it the position of the highest bit and the five bits below it.
fn bucket(ns: u64) -> usize {
    if ns < STEPS as u64 {
        return ns as usize;
    }
    let shift = 58 - ns.leading_zeros() as usize;
    ((shift + 1) * STEPS + (ns >> shift) as usize - STEPS).min(BUCKETS - 1)
}

/// The greatest duration in a bucket.
fn upper_ns(bucket: usize) -> u64 {
    if bucket < STEPS {
        return bucket as u64;
    }
    let (shift, step) = (bucket / STEPS - 1, bucket % STEPS);
    (((STEPS + step + 1) as u64) << shift) - 1
}

impl Timing {
    /// One conversion.
    pub fn add(&mut self, took: Duration) {
        let ns = u64::try_from(took.as_nanos()).unwrap_or(u64::MAX);
        let bucket = &mut self.buckets[bucket(ns)];
        *bucket = bucket.saturating_add(1);
        self.count += 1;
        self.sum_ns = self.sum_ns.saturating_add(ns);
        self.max_ns = self.max_ns.max(ns);
    }

    /// What `hundredths` per cent of the conversions did not exceed.
    fn percentile_ns(&self, per_cent: u64) -> u64 {
        let wanted = (self.count * per_cent).div_ceil(100);
        let mut seen = 0;
        for (index, &count) in self.buckets.iter().enumerate() {
            seen += u64::from(count);
            if seen >= wanted {
                return upper_ns(index).min(self.max_ns);
            }
        }
        self.max_ns
    }

    /// A line for people: count, median, 99th percentile, greatest, and how many tuples a second of converting makes.
    pub fn render(&self) -> String {
        let mut text = format!("{} tuples", self.count);
        if self.count > 0 {
            let rate = self.count as f64 * 1e9 / self.sum_ns.max(1) as f64;
            let (middle, late) = (self.percentile_ns(50), self.percentile_ns(99));
            let max = self.max_ns;
            let _ = write!(
                text,
                ": p50 {middle} ns, p99 {late} ns, max {max} ns; {rate:.0} tuples/s"
            );
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn percentiles_are_at_most_a_32nd_above_the_truth() {
        let mut timing = Timing::default();
        for ns in 1..=1000 {
            timing.add(Duration::from_nanos(ns * 100));
        }
        for (per_cent, truth) in [(50, 50_000), (99, 99_000), (100, 100_000)] {
            let shown = timing.percentile_ns(per_cent);
            assert!(
                (truth..=truth + truth / 32).contains(&shown),
                "{per_cent}: {shown}"
            );
        }
        assert!(
            timing.render().ends_with("max 100000 ns; 19980 tuples/s"),
            "{}",
            timing.render()
        );
    }

    #[test]
    fn every_duration_has_a_bucket_and_lies_in_it() {
        for ns in (0..5000).chain([1 << 20, (1 << 33) - 1, (1 << 40) - 1]) {
            let index = bucket(ns);
            assert!(ns <= upper_ns(index), "{ns}");
            assert!(index == 0 || ns > upper_ns(index - 1), "{ns}");
        }
        let mut timing = Timing::default();
        assert_eq!(timing.render(), "0 tuples");
        timing.add(Duration::MAX);
        assert_eq!(timing.percentile_ns(50), (1 << 40) - 1);
    }
}
