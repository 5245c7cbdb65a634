//! An open `log`: gives the lines kept, then waits for more.
//!
//! Owns the reads that wait and the distance between the reader's positions and the log's, which appears when
//! lines were dropped before they were read.

use super::{OpenFile, READABLE};
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::{Ready, lock};
use crate::transport::{Answer, Outcome, PollHandle, RequestId, Transfer};
use std::sync::{Arc, Mutex, OnceLock};

/// One reader of the log.
pub struct LogFile {
    engine: Arc<Engine>,
    place: Mutex<Place>,
    poll: OnceLock<PollHandle>,
}

#[derive(Default)]
struct Place {
    /// Dropped bytes that this reader's positions do not count.
    shift: u64,
    /// Where the next read in sequence begins, in the log's positions.
    next: u64,
    waiting: Vec<(RequestId, u64, usize)>,
}

impl LogFile {
    /// A reader at the first line kept.
    pub fn open(engine: &Arc<Engine>) -> Arc<Self> {
        let file = Arc::new(Self {
            engine: engine.clone(),
            place: Mutex::default(),
            poll: OnceLock::new(),
        });
        let me: Arc<dyn Ready> = file.clone();
        engine.log.follow(Arc::downgrade(&me));
        file
    }

    fn take(&self, place: &mut Place, offset: u64, out: &mut [u8]) -> usize {
        let position = offset.saturating_add(place.shift);
        let (from, n) = self.engine.log.read_at(position, out);
        place.shift += from - position.min(from);
        place.next = from + n as u64;
        n
    }
}

impl OpenFile for LogFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        let mut place = lock(&self.place);
        let n = self.take(&mut place, request.offset, out);
        if n > 0 || out.is_empty() {
            return Ok(Outcome::Done(n));
        }
        if request.nonblocking {
            return Err(Error::WouldBlock);
        }
        self.engine.park(request.id);
        place.waiting.push((request.id, request.offset, out.len()));
        drop(place);
        self.ready();
        Ok(Outcome::Wait)
    }

    fn poll(&self, handle: PollHandle, events: u32) -> Result<u32, Error> {
        let _ = self.poll.set(handle);
        let has_more = self.engine.log.end() > lock(&self.place).next;
        Ok(if has_more { events & READABLE } else { 0 })
    }
}

impl Ready for LogFile {
    fn ready(&self) {
        let mut place = lock(&self.place);
        let mut waiting = std::mem::take(&mut place.waiting);
        waiting.retain(|&(id, ..)| self.engine.is_parked(id));
        for (id, offset, size) in waiting {
            let mut out = vec![0; size];
            let n = self.take(&mut place, offset, &mut out);
            if n == 0 {
                place.waiting.push((id, offset, size));
            } else if self.engine.claim(id) {
                self.engine.answer(id, Ok(Answer::Data(&out[..n])));
            }
        }
        drop(place);
        self.engine.notify(self.poll.get().copied());
    }
}
