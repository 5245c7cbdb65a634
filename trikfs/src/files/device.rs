//! An open `device`: the stream of converted tuples, in both directions.
//!
//! Owns the reads that wait, in their order, and the poll handle. What there is to read is the reader's business.

use super::ownership::Ownership;
use super::{OpenFile, READABLE, WRITABLE};
use crate::crew::lock_patiently;
use crate::device::{ByDelivery, Got, State};
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::{Ready, lock};
use crate::limits;
use crate::newest;
use crate::node::{Feed, Node};
use crate::reader::Reader;
use crate::state_reader::StateReader;
use crate::transport::{Access, Answer, Caller, Outcome, PollHandle, RequestId, Transfer};
use crate::writer::Writer;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, OnceLock};

/// One open `device`.
pub struct DeviceFile {
    node: Arc<Node>,
    engine: Arc<Engine>,
    source: OnceLock<Source>,
    writer: OnceLock<Mutex<Writer>>,
    ownership: Ownership,
    waiting: Mutex<Waiting>,
    poll: OnceLock<PollHandle>,
    /// Of its converters, when it was opened.
    pipeline_bytes: usize,
}

type Source = ByDelivery<Box<Mutex<StateReader>>, Arc<Reader>>;

#[derive(Default)]
struct Waiting {
    reads: VecDeque<(RequestId, usize)>,
    buffer: Vec<u8>,
}

impl DeviceFile {
    /// Opens the node's source, sink or both, with one private pipeline.
    pub fn open(node: &Arc<Node>, read: bool, write: bool) -> Result<(Arc<Self>, Access), Error> {
        node.check_access(read, write)?;
        let pipeline = node.open_pipeline()?;
        let pipeline_bytes = lock(&pipeline).memory();
        let file = Arc::new(Self {
            node: node.clone(),
            engine: node.engine.clone(),
            source: OnceLock::new(),
            writer: OnceLock::new(),
            ownership: Ownership::default(),
            waiting: Mutex::default(),
            poll: OnceLock::new(),
            pipeline_bytes,
        });
        let mut access = Access::Stream;
        if read {
            let me: Arc<dyn Ready> = file.clone();
            let source = match node.open_feed_with(Some(pipeline.clone()), Arc::downgrade(&me))? {
                Feed::State(state) => {
                    access = Access::Direct;
                    Source::State(Box::new(Mutex::new(state)))
                }
                Feed::Stream(reader) => Source::Stream(reader),
            };
            let _ = file.source.set(source);
        }
        // After the source: a FIFO that nobody else reads has us as its reader then.
        if write {
            let writer = node.open_writer(Some(pipeline))?;
            let _ = file.writer.set(Mutex::new(writer));
        }
        Ok((file, access))
    }

    /// Answers the reads that wait, as far as there is something for them. The caller is inside the node.
    fn serve(&self, reader: &Reader) {
        let mut waiting = lock(&self.waiting);
        while let Some(&(id, size)) = waiting.reads.front() {
            if !reader.is_ready() {
                return;
            }
            waiting.reads.pop_front();
            if !self.engine.claim(id) {
                continue; // interrupted meanwhile
            }
            let mut buffer = std::mem::take(&mut waiting.buffer);
            buffer.resize(size.min(limits::READ_BYTES), 0);
            match reader.read(&mut buffer) {
                Ok(Got::Bytes(n)) => {
                    self.node.stats.reads.add(1);
                    self.engine.answer(id, Ok(Answer::Data(&buffer[..n])));
                }
                Ok(Got::End) => self.engine.answer(id, Ok(Answer::Data(&[]))),
                // Cannot be, because nobody else reads here; a read that is tried again is right in any case.
                Ok(Got::Nothing) => self.engine.answer(id, Err(Error::Interrupted)),
                Err(error) => self.engine.answer(id, Err(error)),
            }
            waiting.buffer = buffer;
        }
    }

    fn read_stream(
        &self,
        reader: &Reader,
        request: &Transfer,
        out: &mut [u8],
    ) -> Result<Outcome, Error> {
        let is_first = {
            let mut waiting = lock(&self.waiting);
            waiting.reads.retain(|&(id, _)| self.engine.is_parked(id));
            waiting.reads.is_empty()
        };
        if is_first {
            match reader.read(out)? {
                Got::Bytes(n) => {
                    self.node.stats.reads.add(1);
                    return Ok(Outcome::Done(n));
                }
                Got::End => return Ok(Outcome::Done(0)),
                Got::Nothing => {}
            }
        }
        if request.nonblocking {
            // A program that polls edge-triggered comes here to find the end of the data.
            if self.poll.get().is_some() && reader.arm()? && is_first {
                return match reader.read(out)? {
                    Got::Bytes(n) => Ok(Outcome::Done(n)),
                    Got::End => Ok(Outcome::Done(0)),
                    Got::Nothing => Err(Error::WouldBlock),
                };
            }
            return Err(Error::WouldBlock);
        }
        self.engine.park(request.id);
        lock(&self.waiting).reads.push_back((request.id, out.len()));
        if let Err(error) = reader.arm() {
            self.engine.refuse(request.id, error);
        }
        // What arrived before the request was in the list has called nobody.
        self.serve(reader);
        Ok(Outcome::Wait)
    }
}

impl OpenFile for DeviceFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let _inside = self.node.quarantine.enter()?;
        match self.source.get() {
            None => Err(Error::AccessDenied),
            Some(Source::Stream(reader)) => self.read_stream(reader, request, out),
            Some(Source::State(state)) => {
                let n = lock_patiently(state).read_at(request.offset, out)?;
                self.node.stats.reads.add(1);
                Ok(Outcome::Done(n))
            }
        }
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        let Some(writer) = self.writer.get() else {
            return Err(Error::AccessDenied);
        };
        let _inside = self.node.quarantine.enter()?;
        let _admitted = self.ownership.admit(&self.node, request.caller)?;
        let turn = self.node.take_turn();
        let taken = lock_patiently(writer).write(data, !request.nonblocking)?;
        drop(turn);
        newest::renew(&self.node);
        self.node.stats.writes.add(1);
        Ok(Outcome::Done(taken))
    }

    fn poll(&self, handle: PollHandle, events: u32) -> Result<u32, Error> {
        let _ = self.poll.set(handle);
        let mut now = 0;
        if self.writer.get().is_some() {
            now |= WRITABLE;
        }
        match self.source.get() {
            None => {}
            Some(Source::State(_)) => now |= READABLE,
            Some(Source::Stream(reader)) => {
                let _inside = self.node.quarantine.enter()?;
                reader.arm()?;
                if reader.is_ready() {
                    now |= READABLE;
                }
            }
        }
        if self.node.is_retired() {
            return Ok((events & now) | libc::POLLERR as u32);
        }
        Ok(events & now)
    }

    fn held_bytes(&self) -> usize {
        let description = &self.node.description;
        let (before, after) = (description.input_tuple_size, description.output_tuple_size);
        let held = match self.source.get() {
            Some(Source::Stream(reader)) => reader.queue_bytes(),
            // A tuple of the device, and what a read that ended inside the converted one has left.
            Some(Source::State(_)) => before + after,
            None => 0,
        };
        self.pipeline_bytes + held
    }

    fn flush(&self, _id: RequestId, caller: Caller) -> Result<Outcome, Error> {
        self.ownership.closed(&self.node, caller);
        let _inside = self.node.quarantine.enter()?;
        let incomplete = self
            .writer
            .get()
            .map_or(0, |writer| lock(writer).incomplete());
        if incomplete > 0 {
            let size = self.node.description.written_tuple_size();
            let error = Error::Invalid(format!(
                "{incomplete} bytes were written after the last whole tuple of {size}"
            ));
            self.node.report(&error);
            return Err(error);
        }
        Ok(Outcome::Done(0))
    }

    fn release(&self) {
        self.ownership.released(&self.node);
    }

    fn retire(&self) {
        if self.node.is_retired() {
            self.ready();
        }
    }
}

impl Ready for DeviceFile {
    fn ready(&self) {
        let Some(Source::Stream(reader)) = self.source.get() else {
            if self.node.is_retired() {
                self.engine.notify(self.poll.get().copied());
            }
            return;
        };
        let Ok(_inside) = self.node.quarantine.enter_at_once() else {
            // Too many are inside: look again when they had time to come out.
            reader.retry_later();
            return;
        };
        self.serve(reader);
        // Every datum wakes: an edge-triggered poller does not ask again after it was told once.
        if self.poll.get().is_some() && reader.is_ready() {
            self.engine.notify(self.poll.get().copied());
        }
    }
}
