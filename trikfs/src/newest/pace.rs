//! When samples are taken in the background: by the clock or on event, and when one has become too old.
//!
//! Owns the due times. What a sample is and who hears of it is `newest`'s business.

use super::{Source, too_old};
use crate::events::{Due, lock};
use crate::limits;
use crate::node::Node;
use std::sync::{Mutex, Weak};
use std::time::{Duration, Instant};

/// Background sampling by the clock.
pub(super) struct Sampling {
    pub(super) node: Weak<Node>,
    pub(super) planned: Mutex<Instant>,
}

impl Due for Sampling {
    fn due(&self) -> Option<Instant> {
        let node = self.node.upgrade()?;
        if node.is_retired() {
            return None;
        }
        node.newest.sample(&node);
        let period = Duration::from_millis(node.period_ms().into());
        let mut planned = lock(&self.planned);
        *planned += period;
        let now = Instant::now();
        if *planned <= now {
            *planned = now + period; // periods that were missed are not made up for
        }
        Some(*planned)
    }
}

/// Takes a value out of the page cache when it has become too old although the sampler still waits for the device.
pub(super) struct Ageing {
    pub(super) node: Weak<Node>,
}

impl Due for Ageing {
    fn due(&self) -> Option<Instant> {
        let node = self.node.upgrade()?;
        let limit = too_old(&node);
        let age = node
            .newest
            .stamp()
            .map_or(limit, |stamp| Duration::from_nanos(stamp.age_ns()));
        if age >= limit {
            if node.newest.page.drop_filled(&node) {
                node.newest.tell();
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
            let mut work = lock(&node.newest.work);
            let opened = if matches!(work.source, Source::Closed) {
                work.open(&node).map(|()| true)
            } else {
                Ok(false)
            };
            drop(work);
            match opened {
                Ok(true) => {
                    node.newest.arm(&node);
                    node.newest.ready();
                    true
                }
                Ok(false) => true,
                Err(error) => {
                    node.newest.fail(error);
                    false
                }
            }
        };
        let wait = if is_open {
            4 * limits::REOPEN_MS
        } else {
            limits::REOPEN_MS
        };
        Some(Instant::now() + Duration::from_millis(wait))
    }
}
