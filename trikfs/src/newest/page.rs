//! A node's `bin_data` in the kernel's page cache.
//!
//! Owns the counts of its readers and what is known of the page's content. Filling and dropping happen
//! on event and schedule threads only: a READ request may hold the page while it waits for the thread that serves the
//! kernel, so that thread must never wait for the page.

use crate::engine::Engine;
use crate::events::lock;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Mutex, OnceLock};

/// What the kernel keeps of one file.
#[derive(Default)]
pub(super) struct Page {
    ino: OnceLock<u64>,
    /// Open files whose reads come from the page cache.
    readers: AtomicU32,
    /// Those of them that are polled: they must come to us, so that we know what they have read.
    polled: AtomicU32,
    is_filled: AtomicBool,
    /// The page is to be dropped soon, by the schedule.
    is_unwanted: AtomicBool,
    /// The node left the tree. Held during a fill: a fill that has begun ends before the page is dropped for good.
    is_closed: Mutex<bool>,
}

impl Page {
    /// Only these sizes are written in one piece, so that no reader sees half of two values; and the transport must
    /// be able to fill pages.
    pub(super) fn can_hold(engine: &Engine, size: usize) -> bool {
        let kernel = engine.kernel();
        matches!(size, 1 | 2 | 4 | 8) && kernel.is_some_and(|kernel| kernel.can_store())
    }

    /// Whether this file is the one that is cached. A node with second names has several; the first that is opened is it.
    pub(super) fn is_of(&self, ino: u64) -> bool {
        *self.ino.get_or_init(|| ino) == ino
    }

    /// A reader of this file comes (true) or goes.
    pub(super) fn count_reader(&self, comes: bool) {
        if comes {
            // Its first read comes to us and leaves the answer in the page.
            self.is_filled.store(true, Ordering::SeqCst);
        }
        count(&self.readers, comes);
    }

    /// A reader starts being polled (true) or goes.
    pub(super) fn count_polled(&self, comes: bool) {
        count(&self.polled, comes);
        if comes {
            self.unwant();
        }
    }

    /// The page is dropped by the schedule, as soon as it can.
    pub(super) fn unwant(&self) {
        self.is_unwanted.store(true, Ordering::SeqCst);
    }

    /// There is a new sample.
    pub(super) fn fill(&self, engine: &Engine, tuple: &[u8]) {
        let (Some(kernel), Some(&ino)) = (engine.kernel(), self.ino.get()) else {
            return;
        };
        let has_readers = self.readers.load(Ordering::SeqCst) > 0;
        if has_readers && self.polled.load(Ordering::SeqCst) == 0 {
            let is_closed = lock(&self.is_closed);
            if !*is_closed {
                self.is_filled.store(true, Ordering::SeqCst);
                kernel.store(ino, tuple);
            }
        } else if self.is_filled.swap(has_readers, Ordering::SeqCst) {
            // Readers that come to us leave their answers in the page as well.
            kernel.invalidate(ino);
        }
    }

    /// The sample is no longer to be shown.
    pub(super) fn drop(&self, engine: &Engine) {
        if let (Some(kernel), Some(&ino)) = (engine.kernel(), self.ino.get()) {
            kernel.invalidate(ino);
        }
    }

    /// The node leaves the tree: nothing stays in the page, and nothing comes into it again.
    pub(super) fn close(&self, engine: &Engine) {
        *lock(&self.is_closed) = true;
        self.drop(engine);
    }

    /// Whether there may be anything in it.
    pub(super) fn may_hold_something(&self) -> bool {
        self.is_filled.load(Ordering::SeqCst)
    }

    /// Drops the page if it may hold something. True if it may have.
    pub(super) fn drop_filled(&self, engine: &Engine) -> bool {
        let was_filled = self.is_filled.swap(false, Ordering::SeqCst);
        if was_filled {
            self.drop(engine);
        }
        was_filled
    }

    /// Drops the page if it was said that it must go.
    pub(super) fn drop_unwanted(&self, engine: &Engine) {
        if self.is_unwanted.swap(false, Ordering::SeqCst) {
            self.drop(engine);
        }
    }
}

fn count(counter: &AtomicU32, comes: bool) {
    if comes {
        counter.fetch_add(1, Ordering::SeqCst);
    } else {
        counter.fetch_sub(1, Ordering::SeqCst);
    }
}
