//! Which users need the samples of a node, and whether the clock takes them at the moment.
//!
//! Owns the count of those who need them and the time for which the clock goes on without anybody. Knows no node and takes
//! no sample. What a node shows after a rest was taken after it: who ends a rest has everything forgotten first.

use crate::events::lock;
use crate::limits;
use std::sync::Mutex;
use std::time::{Duration, Instant};

/// The need for samples of one node.
pub(super) struct Need(Mutex<Demand>);

struct Demand {
    /// Open files, links of nodes that are open, and orders of regulators.
    users: u32,
    is_awake: bool,
    /// Since when nobody has needed them, if nobody does.
    unneeded_since: Instant,
}

impl Need {
    /// Nobody needs anything, and the clock does not sample.
    pub(super) fn new() -> Self {
        Self(Mutex::new(Demand {
            users: 0,
            is_awake: false,
            unneeded_since: Instant::now(),
        }))
    }

    /// The clock begins to sample before anybody needs it, so that what is missing is known soon.
    pub(super) fn begin(&self) {
        let mut demand = lock(&self.0);
        demand.is_awake = true;
        demand.unneeded_since = Instant::now();
    }

    /// Somebody comes. True if that ended a rest: then `forget` was called before anybody could look, and the caller starts
    /// the clock.
    pub(super) fn comes(&self, forget: impl FnOnce()) -> bool {
        let mut demand = lock(&self.0);
        demand.users += 1;
        if demand.is_awake {
            return false;
        }
        forget();
        demand.is_awake = true;
        true
    }

    /// Somebody who came goes.
    pub(super) fn goes(&self) {
        let mut demand = lock(&self.0);
        demand.users = demand.users.saturating_sub(1);
        demand.unneeded_since = Instant::now();
    }

    /// The clock samples.
    pub(super) fn is_awake(&self) -> bool {
        lock(&self.0).is_awake
    }

    /// Asked by the clock before each sample: true if it is to stop, because nobody has needed a sample for a while; `more`
    /// is what it waits beyond that.
    pub(super) fn begins_rest(&self, more: Duration) -> bool {
        let mut demand = lock(&self.0);
        let lingers = Duration::from_millis(limits::SAMPLING_LINGER_MS).saturating_add(more);
        if demand.is_awake && (demand.users > 0 || demand.unneeded_since.elapsed() < lingers) {
            return false;
        }
        demand.is_awake = false;
        true
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LONG: Duration = Duration::from_secs(3600);

    fn unneeded_for(need: &Need, time: Duration) {
        lock(&need.0).unneeded_since -= time;
    }

    #[test]
    fn the_clock_rests_a_while_after_the_last_one_went_and_not_before() {
        let need = Need::new();
        need.begin();
        assert!(!need.begins_rest(Duration::ZERO), "it has only begun");
        unneeded_for(&need, Duration::from_millis(limits::SAMPLING_LINGER_MS));
        assert!(!need.begins_rest(LONG), "its first sample is not there");
        assert!(need.begins_rest(Duration::ZERO));
        assert!(!need.is_awake());

        let mut forgotten = 0;
        assert!(need.comes(|| forgotten += 1));
        assert!(!need.comes(|| forgotten += 1), "it is at work already");
        assert_eq!(forgotten, 1);
        unneeded_for(&need, LONG);
        need.goes();
        unneeded_for(&need, LONG);
        assert!(!need.begins_rest(Duration::ZERO), "one is left");
        need.goes();
        assert!(!need.begins_rest(Duration::ZERO), "it lingers");
        unneeded_for(&need, LONG);
        assert!(need.begins_rest(Duration::ZERO));
        assert!(
            need.begins_rest(Duration::ZERO),
            "a second clock stops as well"
        );
    }
}
