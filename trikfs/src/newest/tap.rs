//! What the source of a node gives before it is converted, in shared memory, for those who want it as it was.
//!
//! Owns which failures are the source's: those of a converter are not, and one that lasts is told once.

use crate::clock::Stamp;
use crate::errno::{Blame, Error};
use crate::events::lock;
use crate::sample_bus::Ring;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};

/// What the source gives before it is converted, in shared memory.
#[derive(Default)]
pub(super) struct Tap {
    tapped: Mutex<Tapped>,
    /// It has a ring. Samples of all others pay no more than a look at this.
    has_ring: AtomicBool,
}

#[derive(Default)]
struct Tapped {
    ring: Option<Ring>,
    /// The failure that stands there.
    failure: Option<Error>,
    /// The failure that comes next is what a converter said of the last tuple.
    is_refused: bool,
}

impl Tap {
    /// From now on it is in this ring, or in none.
    pub(super) fn set_ring(&self, ring: Option<Ring>) {
        let fresh = Tapped {
            ring,
            ..Tapped::default()
        };
        let has_ring = fresh.ring.is_some();
        // Outside the lock: the end of a ring removes a file.
        let _before = std::mem::replace(&mut *lock(&self.tapped), fresh);
        self.has_ring.store(has_ring, Ordering::Release);
    }

    /// Tuples that were converted at this moment; true: the last of them was refused.
    pub(super) fn publish(&self, tuples: &[u8], tuple_size: usize, is_refused: bool) {
        if !self.has_ring.load(Ordering::Acquire) {
            return;
        }
        let mut tapped = lock(&self.tapped);
        let Some(ring) = &mut tapped.ring else { return };
        for tuple in tuples.chunks_exact(tuple_size) {
            ring.publish(Stamp::now(), tuple);
        }
        tapped.failure = None;
        tapped.is_refused = is_refused;
    }

    /// What a converter says of good bytes is no failure of the source.
    pub(super) fn fail(&self, error: &Error) {
        if !self.has_ring.load(Ordering::Acquire) {
            return;
        }
        let mut tapped = lock(&self.tapped);
        let is_refused = std::mem::take(&mut tapped.is_refused);
        if is_refused || error.blame() == Blame::Converter || tapped.failure.as_ref() == Some(error)
        {
            return;
        }
        if let Some(ring) = &mut tapped.ring {
            ring.fail(Stamp::now(), error);
            tapped.failure = Some(error.clone());
        }
    }
}
