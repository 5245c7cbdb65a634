//! The newest sample of a node, or the failure that stands in its place.
//!
//! Owns the rule that a failure replaces the sample, the count of events, the copy in shared memory, and how several
//! latches are read at one moment. Knows no node, and not when or why samples are taken.

use crate::clock::Stamp;
use crate::errno::Error;
use crate::events::lock;
use crate::sample_bus::Ring;
use std::sync::Mutex;
use std::time::Duration;

/// The newest sample of one node.
pub struct Latch(Mutex<Content>);

struct Content {
    tuple: Vec<u8>,
    stamp: Option<Stamp>,
    error: Option<Error>,
    /// Counts samples and failures; a reader that has seen this number has nothing new to read.
    events: u32,
    era: Era,
    /// The same for programs that read shared memory.
    ring: Option<Ring>,
}

/// The time between two moments at which everything known was forgotten.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Era(u32);

/// One sample and when it was taken.
pub struct Sample {
    /// The converted tuple.
    pub tuple: Vec<u8>,
    /// When it was taken.
    pub stamp: Stamp,
}

/// What a reader learns beside the tuple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Glimpse {
    /// The sample's age.
    pub age_ns: u64,
    /// Number of the event that brought it.
    pub events: u32,
}

impl Default for Latch {
    fn default() -> Self {
        Self::new()
    }
}

impl Latch {
    /// No sample yet.
    pub fn new() -> Self {
        Self(Mutex::new(Content {
            // A picture that nobody asks for takes no memory.
            tuple: Vec::new(),
            stamp: None,
            error: None,
            events: 0,
            era: Era::default(),
            ring: None,
        }))
    }

    /// A sample that is complete now. `era` is that in which taking it began: if it is
    /// over, the sample tells what was before and is left out. True if the sample is published.
    pub fn publish(&self, era: Era, tuple: &[u8]) -> bool {
        let mut content = lock(&self.0);
        if content.era != era {
            return false;
        }
        content.tuple.clear();
        content.tuple.extend_from_slice(tuple);
        let stamp = Stamp::now();
        content.stamp = Some(stamp);
        content.error = None;
        content.events = content.events.wrapping_add(1);
        if let Some(ring) = &mut content.ring {
            ring.publish(stamp, tuple);
        }
        true
    }

    /// A failure. True if it is another one than stands there already.
    pub fn fail(&self, error: &Error) -> bool {
        let mut content = lock(&self.0);
        let is_new = content.error.as_ref() != Some(error);
        content.error = Some(error.clone());
        if is_new {
            content.events = content.events.wrapping_add(1);
            if let Some(ring) = &mut content.ring {
                ring.fail(Stamp::now(), error);
            }
        }
        is_new
    }

    /// From now on there is neither a sample nor a failure, and what is being sampled at this moment does not count.
    pub fn forget(&self) {
        let mut content = lock(&self.0);
        (content.stamp, content.error) = (None, None);
        content.era = Era(content.era.0.wrapping_add(1));
    }

    /// The era that a sample belongs to whose taking begins now.
    pub fn era(&self) -> Era {
        lock(&self.0).era
    }

    /// Copies the sample to `tuple`. None, and nothing copied: there is none yet.
    ///
    /// # Errors
    /// The failure that stands there; a sample that is older than `too_old`.
    pub fn get(
        &self,
        too_old: Option<Duration>,
        tuple: &mut Vec<u8>,
    ) -> Result<Option<Glimpse>, Error> {
        let content = lock(&self.0);
        let Some(stamp) = content.good_stamp(too_old)? else {
            return Ok(None);
        };
        tuple.clear();
        tuple.extend_from_slice(&content.tuple);
        Ok(Some(Glimpse {
            age_ns: stamp.age_ns(),
            events: content.events,
        }))
    }

    /// The sample. None: there is none yet.
    ///
    /// # Errors
    /// As for [`get`](Self::get).
    pub fn sample(&self, too_old: Option<Duration>) -> Result<Option<Sample>, Error> {
        lock(&self.0).sample(too_old)
    }

    /// The samples of all, each with the age from which it is too old, as they stood at one moment: no publisher comes
    /// in between. None: there is none yet.
    pub fn of_all(all: &[(&Self, Option<Duration>)]) -> Vec<Result<Option<Sample>, Error>> {
        // Latches are locked in the order of their addresses, each once, so that two such readers cannot wait for
        // each other; nobody else holds two.
        let mut order: Vec<&Self> = all.iter().map(|(latch, _)| *latch).collect();
        order.sort_by_key(|latch| std::ptr::from_ref::<Self>(latch));
        order.dedup_by_key(|latch| std::ptr::from_ref::<Self>(latch));
        let contents: Vec<_> = order.iter().map(|latch| lock(&latch.0)).collect();
        let sample = |(latch, too_old): &(&Self, Option<Duration>)| {
            let at = order.iter().position(|other| std::ptr::eq(*other, *latch));
            match at.and_then(|at| contents.get(at)) {
                Some(content) => content.sample(*too_old),
                None => Ok(None),
            }
        };
        all.iter().map(sample).collect()
    }

    /// When the newest sample was taken, however old it is.
    pub fn stamp(&self) -> Option<Stamp> {
        lock(&self.0).stamp
    }

    /// The number of the newest event.
    pub fn events(&self) -> u32 {
        lock(&self.0).events
    }

    /// The failure that stands there.
    pub fn error(&self) -> Option<Error> {
        lock(&self.0).error.clone()
    }

    /// A sample or a failure has come.
    pub fn has_news(&self) -> bool {
        let content = lock(&self.0);
        content.stamp.is_some() || content.error.is_some()
    }

    /// There is a sample, and no failure since.
    pub fn is_good(&self) -> bool {
        let content = lock(&self.0);
        content.stamp.is_some() && content.error.is_none()
    }

    /// From now on everything is published in this ring too, or in none.
    pub fn set_ring(&self, ring: Option<Ring>) {
        // The one before goes after the lock.
        let _before = std::mem::replace(&mut lock(&self.0).ring, ring);
    }

    /// Tells readers of shared memory the age from which a sample is too old.
    pub fn tell_ring_of_age(&self, too_old: Duration) {
        if let Some(ring) = &mut lock(&self.0).ring {
            ring.set_too_old(too_old);
        }
    }
}

impl Content {
    fn good_stamp(&self, too_old: Option<Duration>) -> Result<Option<Stamp>, Error> {
        if let Some(error) = &self.error {
            return Err(error.clone());
        }
        let Some(stamp) = self.stamp else {
            return Ok(None);
        };
        let age_ns = stamp.age_ns();
        if too_old.is_some_and(|limit| u128::from(age_ns) > limit.as_nanos()) {
            let age_ms = age_ns / 1_000_000;
            return Err(Error::TimedOut(format!(
                "the newest sample is {age_ms} ms old"
            )));
        }
        Ok(Some(stamp))
    }

    fn sample(&self, too_old: Option<Duration>) -> Result<Option<Sample>, Error> {
        let stamp = self.good_stamp(too_old)?;
        Ok(stamp.map(|stamp| Sample {
            tuple: self.tuple.clone(),
            stamp,
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_sample_that_was_begun_before_everything_was_forgotten_does_not_count() {
        let latch = Latch::new();
        let before = latch.era();
        assert!(latch.publish(before, &[1]));
        latch.forget();
        assert!(!latch.publish(before, &[2]));
        let mut tuple = Vec::new();
        assert_eq!(
            latch.get(None, &mut tuple).map(|got| got.is_some()),
            Ok(false)
        );
        assert!(latch.publish(latch.era(), &[3]));
        assert_eq!(
            latch.get(None, &mut tuple).map(|got| got.is_some()),
            Ok(true)
        );
        assert_eq!(tuple, [3]);
    }
}
