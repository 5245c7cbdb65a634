//! An open `bin_data`, `value` or `valueN`: the newest sample as bytes, as text, or one number of it.
//!
//! Owns the rendering of the sample that this file was last asked for (so that reading in small pieces gives one
//! sample) and what its poller has seen. The sample itself belongs to the node.

use super::ownership::Ownership;
use super::{OpenFile, READABLE, WRITABLE};
use crate::bytes::copy_at;
use crate::crew::lock_patiently;
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::{Ready, lock};
use crate::limits;
use crate::newest::{self, Waiter};
use crate::node::Node;
use crate::text;
use crate::transport::{Access, Answer, Caller, Outcome, PollHandle, RequestId, Transfer};
use crate::writer::Writer;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, OnceLock, Weak};

/// Which view of the sample.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum View {
    /// `bin_data`: the tuple's bytes.
    Bytes,
    /// `value`: all numbers on one line.
    Text,
    /// `valueN`: one number.
    Field(usize),
}

/// One open file.
pub struct ValueFile {
    node: Arc<Node>,
    engine: Arc<Engine>,
    me: Weak<Self>,
    view: View,
    reads: bool,
    /// Served from the page cache under this node id.
    cached: bool,
    is_polled: AtomicBool,
    always_ready: bool,
    writer: Option<Mutex<Writer>>,
    ownership: Ownership,
    shown: Mutex<Shown>,
    poll: OnceLock<PollHandle>,
}

#[derive(Default)]
struct Shown {
    tuple: Vec<u8>,
    /// Of a view as text.
    text: String,
    seen: u32,
    sizes: Vec<(RequestId, usize)>,
}

impl ValueFile {
    /// Opens a view. Only `bin_data` read from a node with a background publisher is cached.
    pub fn open(
        node: &Arc<Node>,
        view: View,
        ino: u64,
        read: bool,
        write: bool,
    ) -> Result<(Arc<Self>, Access), Error> {
        node.check_access(read, write)?;
        let always_ready = read && node.sampling.newest.join()?;
        let writer = if write {
            match node.open_writer(None) {
                Ok(writer) => Some(Mutex::new(writer)),
                Err(error) => {
                    if read {
                        node.sampling.newest.leave();
                    }
                    return Err(error);
                }
            }
        } else {
            None
        };
        let is_cached =
            view == View::Bytes && read && !write && node.sampling.newest.can_cache(ino);
        if is_cached {
            node.sampling.newest.count_cached(true);
        }
        let file = Arc::new_cyclic(|me| Self {
            node: node.clone(),
            engine: node.engine.clone(),
            me: me.clone(),
            view,
            reads: read,
            cached: is_cached,
            is_polled: AtomicBool::new(false),
            always_ready,
            writer,
            ownership: Ownership::default(),
            shown: Mutex::default(),
            poll: OnceLock::new(),
        });
        Ok((
            file,
            if is_cached {
                Access::Cached
            } else {
                Access::Direct
            },
        ))
    }

    /// Renders the newest sample into `shown`. False: there is none yet.
    fn show(&self, shown: &mut Shown) -> Result<bool, Error> {
        let Shown {
            tuple, text, seen, ..
        } = shown;
        let got = self.node.sampling.newest.get(tuple);
        if got.is_err() {
            *seen = self.node.sampling.newest.events();
        }
        let Some(events) = got? else { return Ok(false) };
        *seen = events;
        text.clear();
        let rendered = match self.view {
            View::Bytes => return Ok(true),
            View::Text => self.node.format.render(tuple, text),
            View::Field(index) => self.node.format.render_field(index, tuple, text),
        };
        if let Err(why) = rendered {
            // A part of a text is none.
            text.clear();
            return Err(Error::Converter(why.to_string()));
        }
        text.push('\n');
        Ok(true)
    }

    /// What a reader gets.
    fn content<'a>(&self, shown: &'a Shown) -> &'a [u8] {
        match self.view {
            View::Bytes => &shown.tuple,
            View::Text | View::Field(_) => shown.text.as_bytes(),
        }
    }

    fn tuple_of(&self, data: &[u8]) -> Result<Vec<u8>, Error> {
        let size = self.node.description.written_tuple_size();
        if self.view == View::Bytes {
            return Ok(data.to_vec());
        }
        let format = self.node.written_format();
        let text = text::from_bytes(data)?;
        let mut tuple = vec![0; size];
        match self.view {
            View::Field(index) => {
                if format.len() > 1 {
                    tuple = self.node.last_tuple().ok_or_else(|| {
                        Error::Invalid(
                            "the other numbers are not known yet: write all of them to value first"
                                .to_owned(),
                        )
                    })?;
                }
                text::encode_field(&format, index, text, &mut tuple)?;
            }
            View::Text | View::Bytes => text::encode(&format, text, &mut tuple)?,
        }
        Ok(tuple)
    }
}

impl OpenFile for ValueFile {
    fn is_cached(&self) -> bool {
        self.cached
    }

    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        if !self.reads {
            return Err(Error::AccessDenied);
        }
        if request.offset > 0 {
            let shown = lock(&self.shown);
            let n = copy_at(self.content(&shown), request.offset, out);
            return Ok(Outcome::Done(n));
        }
        // Taking a sample may answer other reads of this file: not with its lock held.
        self.node.sampling.newest.refresh()?;
        let mut shown = lock(&self.shown);
        if self.show(&mut shown)? {
            self.node.stats.reads.add(1);
            return Ok(Outcome::Done(copy_at(self.content(&shown), 0, out)));
        }
        if request.nonblocking {
            return Err(Error::WouldBlock);
        }
        if self.node.sampling.newest.is_silent() {
            self.node.report(&Error::Silent);
            return Err(Error::Silent);
        }
        shown.sizes.retain(|&(id, _)| self.engine.is_parked(id));
        shown.sizes.push((request.id, out.len()));
        drop(shown);
        self.engine.park(request.id);
        let me: Weak<dyn Waiter> = self.me.clone();
        self.node.sampling.newest.wait(request.id, me);
        Ok(Outcome::Wait)
    }

    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        let Some(writer) = &self.writer else {
            return Err(Error::AccessDenied);
        };
        let tuple = self.tuple_of(data);
        let tuple = tuple.inspect_err(|error| self.node.report(error))?;
        let _inside = self.node.quarantine.enter()?;
        let _admitted = self.ownership.admit(&self.node, request.caller)?;
        let turn = self.node.take_turn();
        lock_patiently(writer).write_whole(&tuple, !request.nonblocking)?;
        drop(turn);
        newest::renew(&self.node);
        self.node.driving.written.wrote(tuple);
        self.node.stats.writes.add(1);
        Ok(Outcome::Done(data.len()))
    }

    fn poll(&self, handle: PollHandle, events: u32) -> Result<u32, Error> {
        let is_first = self.poll.set(handle).is_ok();
        if is_first {
            let me: Weak<dyn Ready> = self.me.clone();
            self.node.sampling.newest.watch(me);
            if self.cached && !self.is_polled.swap(true, Ordering::SeqCst) {
                self.node.sampling.newest.count_polled(true);
            }
        }
        let mut now = 0;
        if self.writer.is_some() {
            now |= WRITABLE;
        }
        if self.node.is_retired() {
            return Ok((events & now) | libc::POLLERR as u32);
        }
        if self.reads
            && (self.always_ready || self.node.sampling.newest.events() != lock(&self.shown).seen)
        {
            now |= READABLE | libc::POLLPRI as u32;
        }
        Ok(events & now)
    }

    fn flush(&self, _id: RequestId, caller: Caller) -> Result<Outcome, Error> {
        self.ownership.closed(&self.node, caller);
        Ok(Outcome::Done(0))
    }

    fn held_bytes(&self) -> usize {
        if !self.reads {
            return 0;
        }
        let format = &self.node.format;
        let text = match self.view {
            View::Bytes => 0,
            View::Text => format.text_bytes_max(),
            View::Field(_) => limits::NUMBER_TEXT_BYTES,
        };
        format.size() + text
    }

    fn release(&self) {
        self.ownership.released(&self.node);
        if self.cached {
            self.node.sampling.newest.count_cached(false);
            if self.is_polled.load(Ordering::SeqCst) {
                self.node.sampling.newest.count_polled(false);
            }
        }
        if self.reads {
            self.node.sampling.newest.leave();
        }
    }

    fn retire(&self) {
        if self.node.is_retired() {
            self.engine.notify(self.poll.get().copied());
        }
    }
}

impl Ready for ValueFile {
    fn ready(&self) {
        self.engine.notify(self.poll.get().copied());
    }
}

impl Waiter for ValueFile {
    fn serve(&self, id: RequestId, error: Option<Error>) {
        let mut shown = lock(&self.shown);
        let position = shown.sizes.iter().position(|&(waiting, _)| waiting == id);
        let size = position.map_or(limits::TEXT_BYTES_MAX, |at| shown.sizes.swap_remove(at).1);
        if let Some(error) = error {
            return self.engine.answer(id, Err(error));
        }
        match self.show(&mut shown) {
            Ok(true) => {
                self.node.stats.reads.add(1);
                let content = self.content(&shown);
                let n = content.len().min(size);
                self.engine.answer(id, Ok(Answer::Data(&content[..n])));
            }
            Ok(false) => self.engine.answer(id, Err(Error::WouldBlock)),
            Err(error) => self.engine.answer(id, Err(error)),
        }
    }
}
