//! Counts and times of one node, for its `stats` file.
//!
//! Owns 64-bit counters for a processor that has no 64-bit atomics, and the logarithmic histograms that mean and p99 are computed from.

use std::fmt::Write;
use std::sync::atomic::{AtomicU32, Ordering::Relaxed};
use std::sync::{Arc, OnceLock};

/// A counter that goes on after 2^32. Two readers of it may see the carry late, never a smaller low part for long.
#[derive(Default)]
pub struct Counter {
    low: AtomicU32,
    high: AtomicU32,
}

impl Counter {
    /// Adds `n`.
    pub fn add(&self, n: u32) {
        if self.low.fetch_add(n, Relaxed).checked_add(n).is_none() {
            self.high.fetch_add(1, Relaxed);
        }
    }

    /// The count.
    pub fn get(&self) -> u64 {
        u64::from(self.high.load(Relaxed)) << 32 | u64::from(self.low.load(Relaxed))
    }
}

/// Buckets of a [`Times`]: four per doubling, up to 2^40 ns (18 minutes).
const BUCKETS: usize = 160;

/// Durations: newest, mean, and 99th percentile to about a fifth.
#[derive(Default)]
pub struct Times {
    last_ns: AtomicU32,
    sum_ns: Counter,
    count: Counter,
    /// Made with the first duration: most nodes never have one.
    buckets: OnceLock<Box<[AtomicU32; BUCKETS]>>,
}

/// Index of the bucket of a duration: the position of its highest bit and the two bits below it.
fn bucket(ns: u64) -> usize {
    let ns = ns.max(4);
    let top = 63 - ns.leading_zeros() as usize;
    let quarter = (ns >> (top - 2)) as usize & 3;
    (4 * (top - 2) + quarter).min(BUCKETS - 1)
}

/// The upper bound of a bucket.
fn bound(bucket: usize) -> u64 {
    let (top, quarter) = (bucket / 4 + 2, bucket % 4);
    (5 + quarter as u64) << (top - 2)
}

impl Times {
    /// Adds one duration.
    pub fn add(&self, ns: u64) {
        let short = u32::try_from(ns).unwrap_or(u32::MAX);
        self.last_ns.store(short, Relaxed);
        self.sum_ns.add(short);
        self.count.add(1);
        let buckets =
            (self.buckets).get_or_init(|| Box::new([const { AtomicU32::new(0) }; BUCKETS]));
        buckets[bucket(ns)].fetch_add(1, Relaxed);
    }

    /// Last, mean and p99 in microseconds, as `NAME_last_us 1.5` lines.
    fn render(&self, name: &str, out: &mut String) {
        let count = self.count.get();
        let mean = self.sum_ns.get().checked_div(count).unwrap_or(0);
        let buckets = self.buckets.get().map_or(&[][..], |buckets| &buckets[..]);
        let total: u64 = buckets.iter().map(|b| u64::from(b.load(Relaxed))).sum();
        let mut left = (total * 99).div_ceil(100);
        let mut p99 = 0;
        for (index, counted) in buckets.iter().enumerate() {
            let counted = u64::from(counted.load(Relaxed));
            if counted > 0 {
                p99 = bound(index);
            }
            if counted >= left {
                break;
            }
            left -= counted;
        }
        let last = u64::from(self.last_ns.load(Relaxed));
        for (what, ns) in [("last", last), ("mean", mean), ("p99", p99)] {
            let _ = writeln!(out, "{name}_{what}_us {}.{:03}", ns / 1000, ns % 1000);
        }
    }
}

/// Everything that `stats` shows of a node.
#[derive(Default)]
pub struct Stats {
    /// Samples that became the newest value.
    pub samples: Counter,
    /// read(2) calls answered with data.
    pub reads: Counter,
    /// write(2) calls taken.
    pub writes: Counter,
    /// Failures of device or converter.
    pub faults: Counter,
    /// Tuples dropped because a reader was slow.
    pub dropped: Counter,
    /// Lines, packets and samples of the source that made no sense.
    pub damaged: Arc<Counter>,
    /// Age of the newest value when it was read.
    pub age: Times,
    /// Time of a conversion; measured on every 16th.
    pub conversion: Times,
    ticket: AtomicU32,
}

impl Stats {
    /// True for every 16th call: reading the clock costs more than most conversions.
    pub fn measures_this_conversion(&self) -> bool {
        self.ticket.fetch_add(1, Relaxed) & 15 == 0
    }

    /// `key value` lines. `realtime_offset_ns` is added to the sample's monotonic time to get real time.
    pub fn render(&self, realtime_offset_ns: i128) -> String {
        let mut out = String::with_capacity(512);
        let counts = [
            ("samples", &self.samples),
            ("reads", &self.reads),
            ("writes", &self.writes),
            ("faults", &self.faults),
            ("dropped", &self.dropped),
            ("damaged", &self.damaged),
        ];
        for (name, counter) in counts {
            let _ = writeln!(out, "{name} {}", counter.get());
        }
        self.age.render("age", &mut out);
        self.conversion.render("conversion", &mut out);
        let _ = writeln!(out, "realtime_offset_ns {realtime_offset_ns}");
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_counter_goes_on_after_32_bits() {
        let counter = Counter::default();
        counter.add(u32::MAX);
        counter.add(3);
        assert_eq!(counter.get(), (1 << 32) + 2);
    }

    #[test]
    fn every_duration_is_at_most_its_bucket_bound_and_within_a_quarter_of_it() {
        for ns in [4u64, 5, 7, 8, 100, 1023, 1024, 5500, 10_000_000, 1 << 39] {
            let bound = bound(bucket(ns));
            assert!(ns < bound && bound <= ns + ns / 4 + 2, "{ns} {bound}");
        }
    }

    #[test]
    fn the_99th_percentile_leaves_out_the_worst_hundredth() {
        let stats = Stats::default();
        for _ in 0..99 {
            stats.age.add(1000);
        }
        stats.age.add(1_000_000);
        let text = stats.render(0);
        assert!(text.contains("age_last_us 1000.000\n"), "{text}");
        assert!(text.contains("age_mean_us 10.990\n"), "{text}");
        assert!(text.contains("age_p99_us 1.024\n"), "{text}");
    }
}
