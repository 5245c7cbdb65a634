//! The newest sample of a node: how often it is taken, how often it came, and on which thread.
//!
//! Owns the period, which can be changed, and the rate that `status` shows. Taking samples is `newest`'s business.

use super::Node;
use crate::clock::Stamp;
use crate::device::linked::LinkedNode;
use crate::errno::Error;
use crate::events::{Schedule, lock};
use crate::newest::Newest;
use config::description::{NodeDescription, Pace};
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Mutex, Weak};

/// The samples of one node.
pub struct Sampling {
    /// The newest sample, and how it is got.
    pub newest: Newest,
    pace: Pace,
    /// 0 unless the node is sampled by the clock.
    period_ms: AtomicU32,
    rate: Mutex<Rate>,
}

/// Samples counted when the rate was last computed.
struct Rate {
    count: u64,
    since: Stamp,
    hz: f64,
}

impl Sampling {
    pub(super) fn new(node: Weak<Node>, description: &NodeDescription) -> Self {
        let period_ms = match description.pace {
            Pace::Every { period_ms, .. } => period_ms,
            Pace::OnRead | Pace::OnEvent => 0,
        };
        Self {
            newest: Newest::new(node),
            pace: description.pace,
            period_ms: AtomicU32::new(period_ms),
            rate: Mutex::new(Rate {
                count: 0,
                since: Stamp::now(),
                hz: 0.0,
            }),
        }
    }

    /// Sampling period in ms; 0 unless sampled by the clock.
    pub fn period_ms(&self) -> u32 {
        self.period_ms.load(Ordering::Relaxed)
    }

    /// Changes the sampling period of a node that is sampled by the clock.
    ///
    /// # Errors
    /// A node that is not, and a period out of range.
    pub fn set_period_ms(&self, period_ms: u32) -> Result<(), Error> {
        if !matches!(self.pace, Pace::Every { .. }) {
            return Err(Error::Invalid(
                "the node is not sampled by the clock: its description has no poll_ms".to_owned(),
            ));
        }
        if period_ms == 0 || period_ms > config::limits::PERIOD_MS_MAX {
            return Err(Error::OutOfRange(format!(
                "poll_ms is 1 to {} ms",
                config::limits::PERIOD_MS_MAX
            )));
        }
        self.period_ms.store(period_ms, Ordering::Relaxed);
        self.newest.period_changed();
        Ok(())
    }

    /// Samples per second since the rate was last asked for, over at least a fifth of a second. `count` is how many
    /// there have been.
    pub fn rate_hz(&self, count: u64) -> f64 {
        let mut rate = lock(&self.rate);
        let elapsed_ns = rate.since.age_ns();
        if elapsed_ns >= 200_000_000 {
            #[allow(clippy::cast_precision_loss, reason = "a rate is shown with one digit")]
            let hz = (count - rate.count) as f64 * 1e9 / elapsed_ns as f64;
            *rate = Rate {
                count,
                since: Stamp::now(),
                hz,
            };
        }
        rate.hz
    }
}

impl Node {
    /// Where background samples of this node are scheduled: a node that reads one bus, itself or through other nodes,
    /// has its turn on the thread of that bus. One that reads several would make each wait for the others.
    pub fn sampling_schedule(&self) -> Arc<Schedule> {
        let mut buses = BTreeSet::new();
        self.add_buses(&mut buses);
        match (buses.pop_first(), buses.is_empty()) {
            (Some(bus), true) => self.engine.schedule_of(&bus),
            _ => self.engine.schedule.clone(),
        }
    }
}
