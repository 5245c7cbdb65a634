//! What is wrong with a node now, and what its callers did wrong.
//!
//! Owns the present fault, which lasts until something works again, and the memory that keeps a program that makes the
//! same mistake over and over from filling the log. A caller's mistake is no fault: the device is as well as before.

use crate::clock::coarse_ms;
use crate::errno::{Blame, Error};
use crate::events::lock;
use crate::limits;
use crate::log::Log;
use crate::stats::Stats;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// The troubles of one node.
pub(super) struct Trouble {
    /// The node's, for messages.
    path: String,
    log: Arc<Log>,
    fault: Mutex<Option<Error>>,
    /// The same, without a lock.
    is_faulty: AtomicBool,
    /// The mistake of a caller that was told last, and when, in coarse ms.
    mistake: Mutex<Option<(Error, u32)>>,
}

impl Trouble {
    pub(super) fn new(path: &str, log: Arc<Log>) -> Self {
        Self {
            path: path.to_owned(),
            log,
            fault: Mutex::default(),
            is_faulty: AtomicBool::new(false),
            mistake: Mutex::default(),
        }
    }

    /// The same as whether there is a [`fault`](Self::fault), without a lock.
    pub(super) fn has_fault(&self) -> bool {
        self.is_faulty.load(Ordering::Relaxed)
    }

    /// Notes a failure. One of the device or the converter is shown by `fault`, `stats` and the log; a mistake of the
    /// caller, which has the errno, by the log alone.
    pub(super) fn report(&self, error: &Error, stats: &Stats) {
        if error.blame() == Blame::Caller {
            return self.tell_mistake(error);
        }
        stats.faults.add(1);
        let mut fault = lock(&self.fault);
        if fault.as_ref() != Some(error) {
            self.write_line(error);
            *fault = Some(error.clone());
        }
        self.is_faulty.store(true, Ordering::Relaxed);
    }

    /// A line of the log for a mistake that was not told a moment ago. That there is nothing yet is none.
    fn tell_mistake(&self, error: &Error) {
        if *error == Error::WouldBlock {
            return;
        }
        let now_ms = coarse_ms();
        let mut mistake = lock(&self.mistake);
        let is_old = |(told, at_ms): &(Error, u32)| {
            told == error && now_ms.wrapping_sub(*at_ms) < limits::MISTAKE_MS
        };
        if !mistake.as_ref().is_some_and(is_old) {
            self.write_line(error);
            *mistake = Some((error.clone(), now_ms));
        }
    }

    fn write_line(&self, error: &Error) {
        let line = format!("{}: {}: {error}", self.path, error.blame());
        self.log.line(&line);
    }

    /// All is well again.
    pub(super) fn recover(&self) {
        self.is_faulty.store(false, Ordering::Relaxed);
        *lock(&self.fault) = None;
    }

    /// The present fault.
    pub(super) fn fault(&self) -> Option<Error> {
        lock(&self.fault).clone()
    }
}
