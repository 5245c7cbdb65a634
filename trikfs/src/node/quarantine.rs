//! How many operations may be inside a node's device and converter, and for how long.
//!
//! Owns the count and the times; a device or a native converter that never returns keeps a few threads and no more.
//! Knows no node.

use crate::clock::coarse_ms;
use crate::errno::Error;
use crate::limits::{LATE_PER_NODE_MAX, STUCK_MS};
use config::description::NodeDescription;
use std::sync::atomic::{AtomicU32, Ordering};

/// The operations inside one node.
pub struct Quarantine {
    /// An operation that has been inside for longer will hardly return.
    limit_ms: u32,
    /// When each of them began, in coarse ms; 0 marks a free place.
    began_ms: [AtomicU32; LATE_PER_NODE_MAX],
}

/// One operation inside a node: its place among those that may be there at once.
pub struct Inside<'a>(&'a AtomicU32);

impl Drop for Inside<'_> {
    fn drop(&mut self) {
        self.0.store(0, Ordering::Release);
    }
}

impl Quarantine {
    pub(super) fn new(description: &NodeDescription) -> Self {
        Self {
            limit_ms: STUCK_MS + description.budget_us / 1000 + description.timeout_ms,
            began_ms: Default::default(),
        }
    }

    /// Marks an operation that may enter the node's device or converter, for as long as the result lives.
    ///
    /// # Errors
    /// As many operations are inside as the limit allows, or one has been inside for so long that it will hardly return
    /// (native code that hangs, a driver that never answers): those keep their threads, and no further ones may join them.
    pub fn enter(&self) -> Result<Inside<'_>, Error> {
        let now_ms = coarse_ms().max(1);
        let mut mine = None;
        for place in &self.began_ms {
            let since_ms = place.load(Ordering::Acquire);
            if since_ms == 0 {
                if mine.is_none()
                    && place
                        .compare_exchange(0, now_ms, Ordering::AcqRel, Ordering::Relaxed)
                        .is_ok()
                {
                    mine = Some(Inside(place));
                }
            } else if now_ms.wrapping_sub(since_ms) > self.limit_ms
                && now_ms.wrapping_sub(since_ms) < u32::MAX / 2
            {
                let for_ms = now_ms.wrapping_sub(since_ms);
                return Err(Error::Quarantined { for_ms });
            }
        }
        mine.ok_or_else(|| Error::Crowded("earlier operations have not returned yet".to_owned()))
    }
}
