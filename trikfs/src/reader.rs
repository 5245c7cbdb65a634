//! The converted tuples of a stream, for one consumer.
//!
//! Owns the assembly of tuples from whatever pieces the source gives, the conversion, and what is left over when
//! the consumer's buffer ends inside a tuple. Never waits; a consumer that waits is called through `Ready` when
//! it is worth trying again. Knows no request of the kernel.

use crate::convert::Pipeline;
use crate::device::{Got, Patience, Stream, is_readable};
use crate::errno::Error;
use crate::events::{Due, Ready, Watch, lock};
use crate::hub::Subscription;
use crate::limits;
use crate::node::Node;
use converter::Direction;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

/// One consumer's view of a stream.
pub struct Reader {
    node: Arc<Node>,
    me: Weak<Self>,
    on_ready: Weak<dyn Ready>,
    pipeline: Arc<Mutex<Pipeline>>,
    inner: Mutex<Inner>,
    /// It takes the samples of the node, and tells of what they were made.
    is_tapped: AtomicBool,
}

/// Where the raw tuples come from.
pub enum Origin {
    /// An opening of our own.
    Own(Box<dyn Stream>),
    /// A queue that is filled from an opening that all readers share.
    Shared(Arc<Subscription>),
    /// Our own opening failed; the next read tries to open it again.
    Lost,
}

struct Inner {
    origin: Origin,
    opened: Instant,
    /// Something has come since then.
    has_heard: bool,
    raw: Vec<u8>,
    raw_len: usize,
    /// One tuple was converted, and it is still at the beginning of `raw`.
    is_whole: bool,
    rest: Vec<u8>,
    rest_at: usize,
    /// What the next read gets when `rest` is used up.
    pending: Option<Result<Got, Error>>,
    watch: Option<Watch>,
    scheduled: Option<Instant>,
}

/// Outcome of one attempt to convert more.
enum Step {
    Output(usize),
    Consumed,
    Stop(Result<Got, Error>),
}

impl Reader {
    /// A reader of `node` that calls `on_ready` when more may have come.
    pub fn new(
        node: Arc<Node>,
        origin: Origin,
        pipeline: Arc<Mutex<Pipeline>>,
        on_ready: Weak<dyn Ready>,
    ) -> Arc<Self> {
        let inner = Inner {
            origin,
            opened: Instant::now(),
            has_heard: false,
            raw: Vec::new(),
            raw_len: 0,
            is_whole: false,
            rest: Vec::new(),
            rest_at: 0,
            pending: None,
            watch: None,
            scheduled: None,
        };
        Arc::new_cyclic(|me| Self {
            node,
            me: me.clone(),
            on_ready,
            pipeline,
            inner: Mutex::new(inner),
            is_tapped: AtomicBool::new(false),
        })
    }

    /// From now on this is the one that takes the samples of the node.
    pub fn tap(&self) {
        self.is_tapped.store(true, Ordering::Relaxed);
    }

    /// True if the source is one opening that all readers share, so that what arrived is queued here.
    pub fn is_shared(&self) -> bool {
        matches!(lock(&self.inner).origin, Origin::Shared(_))
    }

    /// Bytes that may wait for this reader while it does not read.
    pub fn queue_bytes(&self) -> usize {
        match &lock(&self.inner).origin {
            Origin::Shared(subscription) => subscription.queue_bytes(),
            Origin::Own(_) | Origin::Lost => 0,
        }
    }

    /// Whether nothing has come from the source since it was opened, and nothing is on its way.
    pub fn is_silent(&self, patience: Patience) -> bool {
        let inner = lock(&self.inner);
        !inner.has_heard
            && match &inner.origin {
                Origin::Own(stream) => {
                    stream.is_silent(inner.opened.elapsed(), patience) && !is_readable(&**stream)
                }
                Origin::Shared(subscription) => subscription.is_silent(patience),
                Origin::Lost => false,
            }
    }

    /// Converted bytes, as many as there are and fit.
    pub fn read(&self, out: &mut [u8]) -> Result<Got, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let mut inner = lock(&self.inner);
        if out.is_empty() {
            return Ok(Got::Bytes(0));
        }
        let mut filled = inner.take_rest(out);
        while filled < out.len() {
            match self.step(&mut inner, &mut out[filled..]) {
                Step::Output(n) => {
                    filled += n;
                    break;
                }
                Step::Consumed => {}
                Step::Stop(end) if filled == 0 => return end,
                Step::Stop(Ok(Got::Nothing)) => break,
                Step::Stop(end) => {
                    inner.pending = Some(end);
                    break;
                }
            }
        }
        Ok(Got::Bytes(filled))
    }

    /// Whether `read` would give something (data, an end or an error). Converts ahead to be sure.
    pub fn is_ready(&self) -> bool {
        if self.node.is_retired() {
            return true;
        }
        let mut inner = lock(&self.inner);
        loop {
            if inner.rest_at < inner.rest.len() || inner.pending.is_some() {
                return true;
            }
            let mut tuple = std::mem::take(&mut inner.rest);
            tuple.resize(self.node.description.output_tuple_size, 0);
            let step = self.step(&mut inner, &mut tuple);
            let made = if let Step::Output(n) = step { n } else { 0 };
            tuple.truncate(made);
            inner.rest = tuple;
            inner.rest_at = 0;
            match step {
                Step::Output(_) | Step::Consumed => {}
                Step::Stop(Ok(Got::Nothing)) => return false,
                Step::Stop(end) => inner.pending = Some(end),
            }
        }
    }

    /// The last tuple of the source and what stages have made of it, if it is still here. True: the last stage has given too.
    pub fn tell_stages(&self, tell: &mut dyn FnMut(&[u8])) -> bool {
        let inner = lock(&self.inner);
        if !inner.is_whole {
            return false;
        }
        tell(&inner.raw[..self.node.description.input_tuple_size]);
        lock(&self.pipeline).tell_stages(tell)
    }

    /// Makes sure that `on_ready` is called for what arrives from now on. After the first time the caller must
    /// look once more, because something may have arrived before; then this returns true.
    pub fn arm(&self) -> Result<bool, Error> {
        let mut inner = lock(&self.inner);
        let Inner { origin, watch, .. } = &mut *inner;
        let Origin::Own(stream) = origin else {
            return Ok(true);
        };
        let at = stream.wake_at();
        let is_new = watch.is_none();
        if is_new && let Some(fd) = stream.fd() {
            let watched = self.node.engine.poller.watch(fd, self.on_ready.clone());
            *watch = watched.map_err(|error| Error::of_system("epoll", &error))?;
        }
        if let Some(at) = at {
            self.schedule(&mut inner, at);
        }
        Ok(is_new)
    }

    /// Calls `on_ready` a little later.
    pub fn retry_later(&self) {
        let me: Weak<dyn Due> = self.me.clone();
        let at = Instant::now() + Duration::from_millis(limits::RETRY_MS);
        self.node.engine.schedule.at(at, me);
    }

    fn schedule(&self, inner: &mut Inner, at: Instant) {
        if inner
            .scheduled
            .is_none_or(|before| at < before || before <= Instant::now())
        {
            inner.scheduled = Some(at);
            let me: Weak<dyn Due> = self.me.clone();
            self.node.engine.schedule.at(at, me);
        }
    }

    /// Fetches and converts as much as `out` needs, once.
    fn step(&self, inner: &mut Inner, out: &mut [u8]) -> Step {
        if let Some(pending) = inner.pending.take() {
            return Step::Stop(pending);
        }
        let (input_size, output_size) = (
            self.node.description.input_tuple_size,
            self.node.description.output_tuple_size,
        );
        let wanted = out
            .len()
            .div_ceil(output_size)
            .min((limits::READ_BYTES / input_size).max(1));
        let mut consumed_for_nothing = 0;
        loop {
            match self.fetch(inner, wanted * input_size, input_size) {
                Ok(Got::Bytes(_)) => {}
                stop => return Step::Stop(stop),
            }
            let made = self.convert(inner, out);
            match made {
                Step::Consumed if consumed_for_nothing < limits::CONSUMED_TUPLES_MAX => {
                    consumed_for_nothing += wanted
                }
                Step::Consumed => {
                    // A source without end and a converter without output: let others have their turn.
                    self.schedule(inner, Instant::now());
                    return Step::Stop(Ok(Got::Nothing));
                }
                made => return made,
            }
        }
    }

    /// Reads until at least one whole raw tuple is there.
    fn fetch(&self, inner: &mut Inner, wanted: usize, input_size: usize) -> Result<Got, Error> {
        if inner.raw.len() < wanted {
            inner.raw.resize(wanted, 0);
        }
        while inner.raw_len < input_size {
            let (start, origin) = (inner.raw_len, &mut inner.origin);
            let buf = &mut inner.raw[start..wanted];
            let got = match origin {
                Origin::Own(stream) => stream.read(buf),
                Origin::Shared(subscription) => subscription.take(buf),
                Origin::Lost => {
                    *origin = Origin::Own(self.node.open_stream()?);
                    continue;
                }
            };
            match got {
                Ok(Got::Bytes(n)) => {
                    inner.raw_len += n;
                    inner.is_whole = false;
                    inner.has_heard = true;
                }
                Ok(Got::End) => {
                    // A torn tuple is never converted.
                    if std::mem::take(&mut inner.raw_len) > 0 {
                        let what = "the source ended inside a tuple".to_owned();
                        self.node.report(&Error::Malformed(what));
                    }
                    return Ok(Got::End);
                }
                Ok(Got::Nothing) => return Ok(Got::Nothing),
                Err(error) => {
                    inner.raw_len = 0;
                    inner.is_whole = false;
                    self.node.report(&error);
                    if matches!(inner.origin, Origin::Own(_)) && error.is_gone() {
                        inner.watch = None;
                        inner.origin = Origin::Lost;
                    }
                    return Err(error);
                }
            }
        }
        Ok(Got::Bytes(inner.raw_len))
    }

    /// Converts the whole raw tuples into `out`; what does not fit of the last one becomes `rest`.
    fn convert(&self, inner: &mut Inner, out: &mut [u8]) -> Step {
        let (input_size, output_size) = (
            self.node.description.input_tuple_size,
            self.node.description.output_tuple_size,
        );
        let tuples = inner.raw_len / input_size;
        let direct = (out.len() / output_size).min(tuples);
        let mut pipeline = lock(&self.pipeline);
        let mut consumed = 0;
        let mut made = 0;
        let mut fault = None;
        if direct > 0 {
            let input = &inner.raw[..tuples * input_size];
            let batch = self.node.convert(
                &mut pipeline,
                Direction::Read,
                input,
                &mut out[..direct * output_size],
            );
            consumed = batch.consumed;
            made = batch.produced * output_size;
            fault = batch.fault;
        }
        if fault.is_none() && consumed < tuples && made < out.len() {
            // The buffer ends inside this tuple.
            let input = &inner.raw[consumed * input_size..tuples * input_size];
            inner.rest.clear();
            inner.rest.resize(output_size, 0);
            let batch = self
                .node
                .convert(&mut pipeline, Direction::Read, input, &mut inner.rest);
            consumed += batch.consumed;
            fault = batch.fault;
            inner.rest.truncate(batch.produced * output_size);
            inner.rest_at = 0;
            made += inner.take_rest(&mut out[made..]);
        }
        drop(pipeline);
        if self.is_tapped.load(Ordering::Relaxed) {
            let heard = &inner.raw[..consumed * input_size];
            let is_refused = fault.is_some();
            (self.node.sampling.newest).heard(heard, input_size, is_refused);
        }
        inner
            .raw
            .copy_within(consumed * input_size..inner.raw_len, 0);
        inner.raw_len -= consumed * input_size;
        inner.is_whole = consumed == 1 && inner.raw_len == 0;
        match fault {
            None if made == 0 => Step::Consumed,
            None => Step::Output(made),
            Some(error) if made == 0 => Step::Stop(Err(error)),
            Some(error) => {
                inner.pending = Some(Err(error));
                Step::Output(made)
            }
        }
    }
}

impl Inner {
    fn take_rest(&mut self, out: &mut [u8]) -> usize {
        let rest = &self.rest[self.rest_at..];
        let n = rest.len().min(out.len());
        out[..n].copy_from_slice(&rest[..n]);
        self.rest_at += n;
        n
    }
}

impl Due for Reader {
    fn due(&self) -> Option<Instant> {
        if let Ok(mut inner) = self.inner.try_lock() {
            inner.scheduled = None;
        }
        if let Some(target) = self.on_ready.upgrade() {
            target.ready();
        }
        None
    }
}
