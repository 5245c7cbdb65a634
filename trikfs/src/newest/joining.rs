//! Who comes to the newest sample of a node and goes again: open files, links of other nodes, regulators.
//!
//! Owns what their coming starts (a source is opened, a clock that rested samples) and what ends without them. `need` counts
//! them; what a sample is, is the business of `newest`.

use super::{Needed, Newest, SILENCE, Source, Thread, Work, pace};
use crate::crew::lock_patiently;
use crate::errno::Error;
use crate::events::Due;
use crate::limits;
use crate::node::Node;
use config::description::Pace;
use std::sync::atomic::Ordering;
use std::sync::mpsc::sync_channel;
use std::sync::{Arc, TryLockError};
use std::time::{Duration, Instant};

impl Newest {
    /// Somebody opened a newest-value file for reading: without background sampling, listening starts here, and a clock that
    /// rested samples again. True if a reader always finds a value, because reading makes one.
    pub fn join(&self) -> Result<bool, Error> {
        let Some(node) = self.node.upgrade() else {
            return Err(Error::Stale);
        };
        match node.description.pace {
            Pace::OnRead => self.join_unsampled(&node),
            Pace::OnEvent => self.join_sampled(),
            Pace::Every { .. } => {
                self.come(&node);
                self.join_sampled().inspect_err(|_| self.need.goes())
            }
        }
    }

    fn join_sampled(&self) -> Result<bool, Error> {
        match self.latch.error() {
            Some(error @ Error::NoDevice(_)) => Err(error),
            _ => Ok(false),
        }
    }

    /// Somebody needs the clock's samples. If it rested, the first attempt at one is waited for on the thread that takes them,
    /// but not for ever, as after a write: see [`renew`].
    fn come(&self, node: &Arc<Node>) {
        if self.need.comes(|| self.latch.forget()) {
            let (done, tried) = sync_channel(1);
            self.schedule_sampling(node, Instant::now(), Some(done));
            // The reader waits on, or gets what came out of it.
            let _ = tried.recv_timeout(Duration::from_millis(limits::RENEWAL_MS));
        }
    }

    /// Another node needs the samples. The first one after a rest is taken right here: this may be the thread that the
    /// clock's samples are taken on.
    pub fn join_as_link(&self) -> Result<(), Error> {
        let Some(node) = self.node.upgrade() else {
            return Err(Error::Stale);
        };
        match node.description.pace {
            Pace::OnRead => self.join_unsampled(&node).map(|_| ()),
            Pace::OnEvent => Ok(()),
            Pace::Every { .. } => {
                if self.need.comes(|| self.latch.forget()) {
                    self.schedule_sampling(&node, pace::next(&node), None);
                    self.sample(&node, Thread::Any);
                }
                Ok(())
            }
        }
    }

    /// Somebody who is no file and no link needs the samples, for as long as what is returned lives.
    pub fn needed(&self) -> Needed {
        if let Some(node) = self.node.upgrade()
            && matches!(node.description.pace, Pace::Every { .. })
        {
            self.come(&node);
        }
        Needed(self.node.clone())
    }

    /// Asked before each sample of the clock: true if nobody needs one. Then the source is closed, and what its converters
    /// remember is gone with it.
    pub(super) fn rests(&self, node: &Node) -> bool {
        // What has not said anything yet has its time to say that it is there.
        let more = if self.latch.has_news() || self.is_silent() {
            Duration::ZERO
        } else {
            Duration::from_millis(node.description.timeout_ms.into())
        };
        if !self.need.begins_rest(more) {
            return false;
        }
        if self.is_silent() {
            self.was_silent.store(true, Ordering::Relaxed);
        }
        self.close_if_at_rest(&mut lock_patiently(&self.work));
        self.page.drop_filled(&node.engine);
        true
    }

    pub(super) fn close_if_at_rest(&self, work: &mut Work) {
        if !self.need.is_awake() {
            work.source = Source::Closed;
        }
    }

    fn join_unsampled(&self, node: &Arc<Node>) -> Result<bool, Error> {
        let _inside = node.quarantine.enter()?;
        let mut work = lock_patiently(&self.work);
        let was_closed = matches!(work.source, Source::Closed);
        work.open(node)?;
        if was_closed && matches!(work.source, Source::Stream(_)) {
            // What a stream gave while it was open for others may be long ago.
            self.latch.forget();
        }
        self.users.fetch_add(1, Ordering::Relaxed);
        Ok(!matches!(&work.source, Source::Stream(reader) if reader.is_shared()))
    }

    /// The opposite of [`join`](Self::join).
    pub fn leave(&self) {
        let Some(node) = self.node.upgrade() else {
            return;
        };
        if matches!(node.description.pace, Pace::Every { .. }) {
            self.need.goes();
        }
        if node.description.pace == Pace::OnRead
            && self.users.fetch_sub(1, Ordering::Relaxed) == 1
            && let Some(again) = self.close_unused(&node)
        {
            let due: Arc<dyn Due> = node.clone();
            node.engine.schedule.at(again, Arc::downgrade(&due));
        }
    }

    /// Closes the source of a node that is sampled on read only if nobody has it open; when to try again, if somebody takes a
    /// sample at the moment, or is stuck in the device.
    pub(super) fn close_unused(&self, node: &Node) -> Option<Instant> {
        if node.description.pace != Pace::OnRead || self.users.load(Ordering::Relaxed) > 0 {
            return None;
        }
        match self.work.try_lock() {
            Ok(mut work) => self.close_if_unused(&mut work),
            Err(TryLockError::Poisoned(work)) => self.close_if_unused(&mut work.into_inner()),
            Err(TryLockError::WouldBlock) => return Some(Instant::now() + SILENCE),
        }
        None
    }

    /// With the lock under which users come.
    pub(super) fn close_if_unused(&self, work: &mut Work) {
        if self.users.load(Ordering::Relaxed) == 0 {
            work.source = Source::Closed;
        }
    }
}
