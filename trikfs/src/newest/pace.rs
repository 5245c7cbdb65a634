//! When samples are taken in the background: by the clock or on event, and when one has become too old.
//!
//! Owns the due times. What a sample is, and what hears of it, is `newest`'s business.

use super::{Source, Thread};
use crate::crew;
use crate::events::{Due, lock};
use crate::limits;
use crate::node::Node;
use config::description::Pace;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{SyncSender, sync_channel};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

/// The age from which a sample taken in the background is no longer shown. None: it is never too old.
pub fn too_old(node: &Node) -> Option<Duration> {
    let description = &node.description;
    let ms = match (description.max_age_ms, description.pace) {
        (Some(ms), _) => u64::from(ms),
        (None, Pace::Every { .. }) => {
            (u64::from(node.sampling.period_ms()) * 2).max(description.timeout_ms.into())
        }
        (None, Pace::OnEvent | Pace::OnRead) => return None,
    };
    Some(Duration::from_millis(ms))
}

/// Background sampling by the clock.
pub(super) struct Sampling {
    node: Weak<Node>,
    /// The sample before took so long that others should not wait for the next one.
    lasts: AtomicBool,
    /// Hears of the first attempt.
    first: Mutex<Option<SyncSender<()>>>,
}

impl Sampling {
    pub(super) fn of(node: Weak<Node>, first: Option<SyncSender<()>>) -> Self {
        Self {
            node,
            lasts: AtomicBool::new(false),
            first: Mutex::new(first),
        }
    }
}

/// When the clock takes the next sample of a node.
pub(super) fn next(node: &Node) -> Instant {
    let period = Duration::from_millis(node.sampling.period_ms().into());
    next_on_grid(node.engine.schedule.origin(), period, Instant::now())
}

/// The first time after `now` that is a whole number of periods from `origin`. Periods that were missed are not made up
/// for. Nodes of the same period are due at the same moments: one wake-up serves them all.
fn next_on_grid(origin: Instant, period: Duration, now: Instant) -> Instant {
    // 64 bits hold 500 years, and a division of 128 bits is long.
    let whole_ns = |time: Duration| u64::try_from(time.as_nanos()).unwrap_or(u64::MAX);
    let period_ns = whole_ns(period).max(1);
    let since_ns = whole_ns(now.saturating_duration_since(origin));
    now + Duration::from_nanos(period_ns - since_ns % period_ns)
}

impl Due for Sampling {
    fn due(&self) -> Option<Instant> {
        let node = self.node.upgrade()?;
        if node.is_retired() {
            return None;
        }
        if self.lasts.load(Ordering::Relaxed) {
            crew::give_way();
        }
        let always = match node.description.pace {
            Pace::Every { always, .. } => always,
            Pace::OnEvent | Pace::OnRead => false,
        };
        if !always && node.sampling.newest.rests(&node) {
            return None;
        }
        let begun = Instant::now();
        let has_source = node.sampling.newest.sample(&node, Thread::Clock);
        let now = Instant::now();
        let lasted = now - begun > limits::SAMPLE_SOON;
        self.lasts.store(lasted, Ordering::Relaxed);
        if let Some(first) = lock(&self.first).take() {
            // Who came first may no longer wait.
            let _ = first.try_send(());
        }
        // What is not there is not looked for at the pace of what is.
        let period_ms = u64::from(node.sampling.period_ms());
        let period_ms = if has_source {
            period_ms
        } else {
            period_ms.max(limits::REOPEN_MS)
        };
        let origin = node.engine.schedule.origin();
        Some(next_on_grid(origin, Duration::from_millis(period_ms), now))
    }
}

/// One sample out of turn.
struct Renewal {
    node: Weak<Node>,
    done: SyncSender<()>,
}

impl Due for Renewal {
    fn due(&self) -> Option<Instant> {
        let node = self.node.upgrade()?;
        if !node.is_retired() && !node.sampling.newest.is_at_rest() {
            node.sampling.newest.sample(&node, Thread::Clock);
        }
        // The writer may no longer wait.
        let _ = self.done.try_send(());
        None
    }
}

/// After a write: what the clock had sampled before is not what the device says now. Waits for a sample of the thread that
/// takes the others, which alone may wait for the page cache, but not for ever: that thread may be busy with a device that
/// hangs. Then the sample from before the write is forgotten, so that nobody takes it for an answer to the write.
pub fn renew(node: &Arc<Node>) {
    let by_clock = matches!(node.description.pace, Pace::Every { .. });
    // What rests is sampled when somebody comes.
    let clock_samples = by_clock && !node.sampling.newest.is_at_rest();
    if !clock_samples || node.driving.takes_orders() || node.is_retired() {
        return;
    }
    let (done, sampled) = sync_channel(1);
    let renewal: Arc<dyn Due> = Arc::new(Renewal {
        node: Arc::downgrade(node),
        done,
    });
    node.sampling_schedule()
        .at(Instant::now(), Arc::downgrade(&renewal));
    if (sampled.recv_timeout(Duration::from_millis(limits::RENEWAL_MS))).is_err() {
        node.sampling.newest.outdate(node, renewal);
    }
}

/// Takes a value out of the page cache when it has become too old although the sampler still waits for the device.
pub(super) struct Ageing {
    pub(super) node: Weak<Node>,
}

impl Due for Ageing {
    fn due(&self) -> Option<Instant> {
        let node = self.node.upgrade()?;
        if node.sampling.newest.is_at_rest() {
            return None;
        }
        let limit = too_old(&node)?;
        let age = node
            .sampling
            .newest
            .stamp()
            .map_or(limit, |stamp| Duration::from_nanos(stamp.age_ns()));
        if age >= limit {
            if node.sampling.newest.page.drop_filled(&node.engine) {
                node.sampling.newest.notify();
            }
            return Some(Instant::now() + limit);
        }
        Some(Instant::now() + (limit - age))
    }
}

/// Opens the source of an `on_event` node, and tries again while it is not there.
pub(super) struct Listening {
    pub(super) node: Weak<Node>,
}

impl Due for Listening {
    fn due(&self) -> Option<Instant> {
        let node = self.node.upgrade()?;
        if node.is_retired() {
            return None;
        }
        let is_open = {
            let mut work = lock(&node.sampling.newest.work);
            let opened = if matches!(work.source, Source::Closed) {
                work.open(&node).map(|()| true)
            } else {
                Ok(false)
            };
            drop(work);
            match opened {
                Ok(true) => {
                    node.sampling.newest.arm(&node);
                    node.sampling.newest.ready();
                    true
                }
                Ok(false) => true,
                Err(error) => {
                    node.sampling.newest.fail(error, Thread::Clock);
                    false
                }
            }
        };
        let wait_ms = if is_open {
            4 * limits::REOPEN_MS
        } else {
            limits::REOPEN_MS
        };
        // Together with all others.
        let origin = node.engine.schedule.origin();
        let wait = Duration::from_millis(wait_ms);
        Some(next_on_grid(origin, wait, Instant::now()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nodes_of_the_same_period_are_due_together_and_missed_periods_are_left_out() {
        let origin = Instant::now();
        let ms = Duration::from_millis;
        let next = |at| next_on_grid(origin, ms(10), origin + at) - origin;
        assert_eq!(next(ms(0)), ms(10));
        assert_eq!(next(ms(3)), ms(10));
        assert_eq!(next(ms(9) + Duration::from_nanos(999_999)), ms(10));
        assert_eq!(next(ms(10)), ms(20));
        assert_eq!(next(ms(47)), ms(50));
        assert_eq!(
            next_on_grid(origin + ms(5), ms(10), origin),
            origin + ms(10)
        );
    }
}
