//! One opening of a source for all its readers.
//!
//! Owns the fan-out: every subscriber gets every raw tuple from its subscription on, in a bounded queue of its own
//! that drops the oldest when its reader is slow. Also owns what happens when the source ends or is lost: one end
//! of file for everybody, or an error until it is back, and attempts to open it again while anybody listens.

use crate::device::{Got, Patience, Stream, is_readable};
use crate::errno::Error;
use crate::events::{Due, Ready, Watch, lock};
use crate::limits;
use crate::node::Node;
use std::collections::VecDeque;
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};

/// The shared opening of one node's source. Closed with its last subscription.
pub struct Hub {
    me: Weak<Self>,
    node: Weak<Node>,
    tuple_size: usize,
    inner: Mutex<Inner>,
    subscriptions: Mutex<Vec<Weak<Subscription>>>,
}

struct Inner {
    stream: Option<Box<dyn Stream>>,
    watch: Option<Watch>,
    raw: Vec<u8>,
    raw_len: usize,
    /// The last tuple of a source that speaks of changes only; empty before the first, and of any other.
    last: Vec<u8>,
    /// The source is over for good (a recording).
    is_over: bool,
    opened: Instant,
    /// Something has come since then.
    has_spoken: bool,
    /// Somebody has subscribed, so the source is watched.
    listens: bool,
    /// When the source is read again without an event.
    wakes_at: Option<Instant>,
    /// Looks whether the source is still the one that is open.
    presence: Option<Arc<dyn Due>>,
}

/// One reader's queue of raw tuples.
pub struct Subscription {
    /// Keeps the opening alive.
    hub: Arc<Hub>,
    node: Weak<Node>,
    tuple_size: usize,
    queue: Mutex<Queue>,
    /// When its reader came.
    since: Instant,
    on_ready: Weak<dyn Ready>,
}

#[derive(Default)]
struct Queue {
    bytes: VecDeque<u8>,
    ended: bool,
    /// The end stays: nothing will ever come again.
    is_over: bool,
    lost: Option<Error>,
}

impl Hub {
    /// Takes over the open source of a node; listening starts with the first subscription.
    pub fn start(node: &Arc<Node>, stream: Box<dyn Stream>) -> Arc<Self> {
        let tuple_size = node.description.input_tuple_size;
        let raw = vec![0; tuple_size.max(4096) / tuple_size * tuple_size];
        let inner = Inner {
            stream: Some(stream),
            watch: None,
            raw,
            raw_len: 0,
            last: Vec::new(),
            is_over: false,
            opened: Instant::now(),
            has_spoken: false,
            listens: false,
            wakes_at: None,
            presence: None,
        };
        Arc::new_cyclic(|me| Self {
            me: me.clone(),
            node: Arc::downgrade(node),
            tuple_size,
            inner: Mutex::new(inner),
            subscriptions: Mutex::default(),
        })
    }

    /// A queue that gets every tuple from now on, after what the source answered last, or said last if it speaks of changes
    /// only.
    pub fn subscribe(self: &Arc<Self>, on_ready: Weak<dyn Ready>) -> Arc<Subscription> {
        let mut inner = lock(&self.inner);
        let node = self.node.upgrade();
        let answer = node.and_then(|node| node.source.answer().tuple());
        let queue = Queue {
            is_over: inner.is_over,
            bytes: answer.unwrap_or_else(|| inner.last.clone()).into(),
            ..Queue::default()
        };
        let subscription = Arc::new(Subscription {
            hub: self.clone(),
            node: self.node.clone(),
            tuple_size: self.tuple_size,
            queue: Mutex::new(queue),
            since: Instant::now(),
            on_ready,
        });
        let mut subscriptions = lock(&self.subscriptions);
        subscriptions.retain(|other| other.strong_count() > 0);
        subscriptions.push(Arc::downgrade(&subscription));
        drop(subscriptions);
        // Not before somebody is there to get what comes: a recording begins at once.
        if !std::mem::replace(&mut inner.listens, true) {
            self.listen(&mut inner);
            let presence: Arc<dyn Due> = Arc::new(Presence(self.me.clone()));
            if let Some(node) = self.node.upgrade() {
                let at = Instant::now() + Duration::from_millis(limits::PRESENCE_MS);
                node.engine.schedule.at(at, Arc::downgrade(&presence));
            }
            inner.presence = Some(presence);
        }
        subscription
    }

    /// Registers for whatever wakes this source. An edge that is there already is reported at once.
    fn listen(&self, inner: &mut Inner) {
        let (Some(node), Some(stream)) = (self.node.upgrade(), &inner.stream) else {
            return;
        };
        let at = stream.wake_at();
        if let Some(fd) = stream.fd() {
            let me: Weak<dyn Ready> = self.me.clone();
            match node.engine.poller.watch(fd, me) {
                Ok(watch) => inner.watch = watch,
                Err(error) => node.report(&Error::of_system("epoll", &error)),
            }
        }
        if let Some(at) = at {
            self.wake_once(&mut inner.wakes_at, &node, at);
        } else if inner.watch.is_none() {
            inner.stream = None;
            inner.is_over = true;
            let what = "the source is always ready: it cannot be shared, use share = false";
            self.each(|subscription| subscription.lose(&Error::NoDevice(what.to_owned())));
            node.report(&Error::NoDevice(what.to_owned()));
        }
    }

    fn wake_at(&self, node: &Node, at: Instant) {
        let me: Weak<dyn Due> = self.me.clone();
        node.engine.schedule.at(at, me);
    }

    /// As `wake_at`, unless that comes before anyway.
    fn wake_once(&self, wakes_at: &mut Option<Instant>, node: &Node, at: Instant) {
        if wakes_at.is_none_or(|before| at < before || before <= Instant::now()) {
            *wakes_at = Some(at);
            self.wake_at(node, at);
        }
    }

    /// Takes what the source has and passes it on. Readers are called with no lock held.
    pub fn pump(&self) {
        let Some(node) = self.node.upgrade() else {
            return;
        };
        for _ in 0..limits::PUMP_ROUNDS {
            let goes_on = self.take_once(&node);
            match goes_on {
                Some(goes_on) => {
                    self.notify();
                    if !goes_on {
                        return;
                    }
                }
                None => return,
            }
        }
        self.wake_at(&node, Instant::now());
    }

    /// Reads once. None: nothing there; otherwise readers have news, and whether there may be more.
    fn take_once(&self, node: &Arc<Node>) -> Option<bool> {
        let mut inner = lock(&self.inner);
        let Inner {
            stream: Some(stream),
            raw,
            raw_len,
            last,
            wakes_at,
            has_spoken,
            ..
        } = &mut *inner
        else {
            return None;
        };
        match stream.read(&mut raw[*raw_len..]) {
            Ok(Got::Bytes(n)) => {
                *raw_len += n;
                *has_spoken = true;
                let whole = *raw_len / self.tuple_size * self.tuple_size;
                if whole > 0 {
                    let source = &node.description.source;
                    node.source
                        .answer()
                        .note(source, &raw[..whole], self.tuple_size);
                    self.each(|subscription| subscription.push(&raw[..whole]));
                    if stream.tells_changes_only() {
                        last.clear();
                        last.extend_from_slice(&raw[whole - self.tuple_size..whole]);
                    }
                    raw.copy_within(whole..*raw_len, 0);
                    *raw_len -= whole;
                }
                Some(true)
            }
            Ok(Got::Nothing) => {
                if let Some(at) = stream.wake_at() {
                    self.wake_once(wakes_at, node, at);
                }
                None
            }
            Ok(Got::End) => {
                self.end(node, &mut inner);
                Some(false)
            }
            Err(error @ Error::Recorded(..)) => {
                *raw_len = 0;
                last.clear();
                *has_spoken = true;
                node.report(&error);
                self.each(|subscription| subscription.lose(&error));
                Some(true)
            }
            Err(error) => {
                inner.raw_len = 0;
                inner.last.clear();
                inner.watch = None;
                inner.stream = None;
                self.lose(node, &error);
                Some(false)
            }
        }
    }

    /// The source has ended, for good or until it begins anew.
    fn end(&self, node: &Arc<Node>, inner: &mut Inner) {
        let again = (inner.stream.as_ref()).is_some_and(|stream| stream.begins_anew());
        if std::mem::take(&mut inner.raw_len) > 0 {
            let what = "the source ended inside a tuple".to_owned();
            node.report(&Error::Malformed(what));
        }
        inner.last.clear();
        inner.is_over = !again;
        if again {
            // The old opening stays until the new one is there: what the next writer of a FIFO sends
            // would be lost while nobody has it open.
            if let Err(error) = self.reopen(node, inner) {
                // At one stroke: the end comes before the loss for everybody.
                self.each(|subscription| subscription.end_and_lose(&error));
                return;
            }
        } else {
            inner.watch = None;
            inner.stream = None;
        }
        // Not before: a program that has seen the end may let the next writer come at once, whose end is that of the new opening.
        self.each(|subscription| subscription.end(!again));
    }

    /// Whether the source has given nothing since it was opened, and nothing is on its way. For a reader that came after
    /// something was said, this counts from when it came.
    fn is_silent(&self, reader: &Subscription, patience: Patience) -> bool {
        // With the lock under which tuples are passed on: one that was just read is in the queue, or still to be read.
        let inner = lock(&self.inner);
        if !lock(&reader.queue).bytes.is_empty() {
            return false;
        }
        let since = reader.since;
        let begin = if inner.has_spoken {
            since
        } else {
            inner.opened
        };
        let stream = inner.stream.as_deref();
        stream.is_some_and(|stream| {
            stream.is_silent(begin.elapsed(), patience) && !is_readable(stream)
        })
    }

    /// Opens the source again, or tries it later; what to tell the readers then is the caller's matter.
    fn reopen(&self, node: &Arc<Node>, inner: &mut Inner) -> Result<(), Error> {
        let opened = node.open_stream();
        inner.watch = None;
        match opened {
            Ok(stream) => {
                inner.stream = Some(stream);
                self.listen(inner);
                self.each(Subscription::recover);
                Ok(())
            }
            Err(error) => {
                inner.stream = None;
                self.try_later(node, &error);
                Err(error)
            }
        }
    }

    fn lose(&self, node: &Arc<Node>, error: &Error) {
        self.try_later(node, error);
        self.each(|subscription| subscription.lose(error));
    }

    /// Reported before a reader is told, who may ask for the fault at once.
    fn try_later(&self, node: &Arc<Node>, error: &Error) {
        node.report(error);
        self.wake_at(
            node,
            Instant::now() + Duration::from_millis(limits::REOPEN_MS),
        );
    }

    fn each(&self, act: impl Fn(&Subscription)) {
        for subscription in lock(&self.subscriptions).iter().filter_map(Weak::upgrade) {
            act(&subscription);
        }
    }

    fn notify(&self) {
        let all: Vec<_> = lock(&self.subscriptions)
            .iter()
            .filter_map(Weak::upgrade)
            .collect();
        for target in all
            .iter()
            .filter_map(|subscription| subscription.on_ready.upgrade())
        {
            target.ready();
        }
    }
}

/// Looks after the source of a hub now and then: a FIFO that was deleted and made again is another one, and nothing
/// wakes the programs that have the old one open.
struct Presence(Weak<Hub>);

impl Due for Presence {
    fn due(&self) -> Option<Instant> {
        let hub = self.0.upgrade()?;
        let node = hub.node.upgrade()?;
        let is_gone = {
            let mut inner = lock(&hub.inner);
            let stream = inner.stream.as_ref();
            let is_gone = stream.is_some_and(|stream| !stream.is_still_there());
            if is_gone {
                inner.raw_len = 0;
                inner.last.clear();
                inner.watch = None;
                inner.stream = None;
                let what = "the device was removed or replaced".to_owned();
                hub.lose(&node, &Error::NoDevice(what));
            }
            is_gone
        };
        if is_gone {
            hub.notify();
        }
        Some(Instant::now() + Duration::from_millis(limits::PRESENCE_MS))
    }
}

impl Ready for Hub {
    fn ready(&self) {
        self.pump();
    }
}

impl Due for Hub {
    fn due(&self) -> Option<Instant> {
        let node = self.node.upgrade()?;
        let is_lost = {
            let mut inner = lock(&self.inner);
            let is_lost = inner.stream.is_none() && !inner.is_over;
            if is_lost && let Err(error) = self.reopen(&node, &mut inner) {
                self.each(|subscription| subscription.lose(&error));
            }
            is_lost
        };
        if is_lost {
            self.notify();
        } else {
            self.pump();
        }
        None
    }
}

impl Subscription {
    /// Takes queued tuples. `buf` must hold a whole number of tuples.
    pub fn take(&self, buf: &mut [u8]) -> Result<Got, Error> {
        let mut queue = lock(&self.queue);
        if queue.bytes.is_empty() {
            if queue.is_over || std::mem::take(&mut queue.ended) {
                return Ok(Got::End);
            }
            return queue.lost.clone().map_or(Ok(Got::Nothing), Err);
        }
        let n = buf.len().min(queue.bytes.len());
        for (to, from) in buf.iter_mut().zip(queue.bytes.drain(..n)) {
            *to = from;
        }
        Ok(Got::Bytes(n))
    }

    /// See [`Stream::is_silent`]; asked of the opening that all readers share, by a reader that has heard nothing yet.
    pub fn is_silent(&self, patience: Patience) -> bool {
        self.hub.is_silent(self, patience)
    }

    /// Bytes that may wait for its reader.
    pub fn queue_bytes(&self) -> usize {
        let most = (limits::QUEUE_BYTES / self.tuple_size).clamp(1, limits::QUEUE_TUPLES);
        most * self.tuple_size
    }

    fn push(&self, tuples: &[u8]) {
        let limit = self.queue_bytes();
        let mut queue = lock(&self.queue);
        queue.ended = false;
        queue.lost = None;
        queue.bytes.extend(tuples);
        let excess = queue.bytes.len().saturating_sub(limit);
        if excess > 0 {
            queue.bytes.drain(..excess);
            if let Some(node) = self.node.upgrade() {
                node.stats
                    .dropped
                    .add(u32::try_from(excess / self.tuple_size).unwrap_or(u32::MAX));
            }
        }
    }

    fn end(&self, for_good: bool) {
        let mut queue = lock(&self.queue);
        queue.ended = true;
        queue.is_over = for_good;
    }

    fn lose(&self, error: &Error) {
        lock(&self.queue).lost = Some(error.clone());
    }

    fn end_and_lose(&self, error: &Error) {
        let mut queue = lock(&self.queue);
        queue.ended = true;
        queue.lost = Some(error.clone());
    }

    fn recover(&self) {
        lock(&self.queue).lost = None;
    }
}
