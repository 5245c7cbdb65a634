//! How many operations may be inside a node's device and converter, and for how long.
//!
//! Owns the count and the times; a device or a native converter that never returns keeps a few threads and no more.
//! Knows no node.

use crate::clock::coarse_ms;
use crate::crew;
use crate::errno::Error;
use crate::events::lock;
use crate::limits::{
    CROWDED_LOOK, CROWDED_PATIENCE_MS, CROWDED_PER_NODE_MAX, LATE_PER_NODE_MAX, STUCK_MS,
};
use config::description::NodeDescription;
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Condvar, Mutex};
use std::time::{Duration, Instant};

/// The operations inside one node.
pub struct Quarantine {
    /// An operation that has been inside for longer will hardly return.
    limit_ms: u32,
    /// When each of them began, in coarse ms; 0 marks a free place.
    began_ms: [AtomicU32; LATE_PER_NODE_MAX],
    /// Callers that wait for a place.
    waiting: AtomicU32,
    queue: Mutex<()>,
    is_free: Condvar,
}

/// One operation inside a node: its place among those that may be there at once.
pub struct Inside<'a> {
    quarantine: &'a Quarantine,
    place: &'a AtomicU32,
}

impl Drop for Inside<'_> {
    fn drop(&mut self) {
        self.place.store(0, Ordering::Release);
        // A caller that begins to wait at this moment may be overlooked: it looks again by itself.
        if self.quarantine.waiting.load(Ordering::Relaxed) > 0 {
            let _queue = lock(&self.quarantine.queue);
            self.quarantine.is_free.notify_one();
        }
    }
}

/// Why nobody may enter at the moment.
enum Full {
    /// The newest operation inside has just begun: a place is free soon.
    Passing,
    /// All operations inside are late.
    Late,
}

impl Quarantine {
    pub(super) fn new(description: &NodeDescription) -> Self {
        Self {
            limit_ms: STUCK_MS + description.budget_us / 1000 + description.timeout_ms,
            began_ms: Default::default(),
            waiting: AtomicU32::new(0),
            queue: Mutex::new(()),
            is_free: Condvar::new(),
        }
    }

    /// Marks an operation that may enter the node's device or converter, for as long as the result lives. Where several callers
    /// are quicker than the device, it waits a moment for its turn.
    ///
    /// # Errors
    /// As many operations are late inside as the limit allows, or one has been inside for so long that it will hardly return
    /// (native code that hangs, a driver that never answers): those keep their threads, and no further ones may join them.
    pub fn enter(&self) -> Result<Inside<'_>, Error> {
        match self.look()? {
            Ok(inside) => Ok(inside),
            Err(Full::Late) => Err(crowded()),
            Err(Full::Passing) => self.wait(Duration::from_millis(CROWDED_PATIENCE_MS.into())),
        }
    }

    /// As [`enter`](Self::enter), for callers that come again by themselves.
    ///
    /// # Errors
    /// As of `enter`, and if there is no place at this moment.
    pub fn enter_at_once(&self) -> Result<Inside<'_>, Error> {
        self.look()?.map_err(|_| crowded())
    }

    fn look(&self) -> Result<Result<Inside<'_>, Full>, Error> {
        let now_ms = coarse_ms().max(1);
        let mut full = Full::Late;
        for place in &self.began_ms {
            let since_ms = place.load(Ordering::Acquire);
            let for_ms = now_ms.wrapping_sub(since_ms);
            // A number of the other half is of an operation that began after `now_ms` was taken.
            let is_newer = for_ms >= u32::MAX / 2;
            if since_ms != 0 && for_ms > self.limit_ms && !is_newer {
                return Err(Error::Quarantined { for_ms });
            }
            if since_ms == 0 || for_ms <= CROWDED_PATIENCE_MS || is_newer {
                full = Full::Passing;
            }
        }
        let (acq_rel, relaxed) = (Ordering::AcqRel, Ordering::Relaxed);
        for place in &self.began_ms {
            if place.compare_exchange(0, now_ms, acq_rel, relaxed).is_ok() {
                let quarantine = self;
                return Ok(Ok(Inside { quarantine, place }));
            }
        }
        Ok(Err(full))
    }

    /// A place that becomes free soon, among not too many who wait for one.
    fn wait(&self, patience: Duration) -> Result<Inside<'_>, Error> {
        crew::give_way();
        let until = Instant::now() + patience;
        let _place = Waiting::begin(&self.waiting)?;
        loop {
            match self.look()? {
                Ok(inside) => return Ok(inside),
                Err(Full::Passing) if Instant::now() < until => {}
                Err(Full::Passing | Full::Late) => return Err(crowded()),
            }
            // A place that became free since the look is seen by the next one.
            let queue = lock(&self.queue);
            let _woken = self.is_free.wait_timeout(queue, CROWDED_LOOK);
        }
    }
}

/// One of those who wait.
struct Waiting<'a>(&'a AtomicU32);

impl<'a> Waiting<'a> {
    fn begin(waiting: &'a AtomicU32) -> Result<Self, Error> {
        let before = waiting.fetch_add(1, Ordering::Relaxed);
        let me = Self(waiting);
        match before < CROWDED_PER_NODE_MAX {
            true => Ok(me),
            false => Err(crowded()),
        }
    }
}

impl Drop for Waiting<'_> {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::Relaxed);
    }
}

fn crowded() -> Error {
    Error::Crowded("earlier operations have not returned yet".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn quarantine() -> Quarantine {
        Quarantine {
            limit_ms: 60_000,
            began_ms: Default::default(),
            waiting: AtomicU32::new(0),
            queue: Mutex::new(()),
            is_free: Condvar::new(),
        }
    }

    const SOON: Duration = Duration::from_secs(30);

    #[test]
    fn more_callers_than_places_take_turns() {
        let quarantine = &quarantine();
        let crowd = LATE_PER_NODE_MAX + CROWDED_PER_NODE_MAX as usize;
        // On a busy machine an operation may be late by no fault of its own: then its place is waited for again.
        let enter = move || {
            let mut tried = quarantine.enter();
            while tried.is_err() {
                tried = quarantine.wait(SOON);
            }
        };
        std::thread::scope(|scope| {
            for _ in 0..crowd {
                scope.spawn(move || (0..200).for_each(|_| enter()));
            }
        });
        assert_eq!(quarantine.waiting.load(Ordering::Relaxed), 0);
        let is_free = |place: &AtomicU32| place.load(Ordering::Relaxed) == 0;
        assert!(quarantine.began_ms.iter().all(is_free));
    }

    #[test]
    fn a_place_that_becomes_free_goes_to_the_one_that_waits() {
        let quarantine = &quarantine();
        let places = (0..LATE_PER_NODE_MAX).map(|_| quarantine.enter().unwrap());
        let mut inside: Vec<_> = places.collect();
        let at_once = quarantine.enter_at_once().map(|_| ());
        assert!(matches!(at_once, Err(Error::Crowded(_))));
        // All have just begun, for as long as the test lasts.
        for place in &quarantine.began_ms {
            place.store(coarse_ms().wrapping_add(60_000), Ordering::Relaxed);
        }
        std::thread::scope(|scope| {
            let waits = scope.spawn(|| quarantine.wait(SOON).is_ok());
            inside.pop();
            assert!(waits.join().unwrap());
        });
    }

    #[test]
    fn a_caller_is_refused_at_once_when_all_are_late() {
        let quarantine = quarantine();
        let began = |for_ms| coarse_ms().wrapping_sub(for_ms).max(1);
        let late = began(CROWDED_PATIENCE_MS + 100);
        for place in &quarantine.began_ms {
            place.store(late, Ordering::Relaxed);
        }
        assert!(matches!(quarantine.look(), Ok(Err(Full::Late))));
        assert!(matches!(quarantine.enter(), Err(Error::Crowded(_))));
        quarantine.began_ms[1].store(began(60_100), Ordering::Relaxed);
        assert!(matches!(quarantine.enter(), Err(Error::Quarantined { .. })));
        // Also for a caller that waits and sees a free place before it.
        quarantine.began_ms[0].store(0, Ordering::Relaxed);
        assert!(matches!(
            quarantine.wait(SOON),
            Err(Error::Quarantined { .. })
        ));
    }
}
