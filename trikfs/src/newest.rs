//! The newest sample of a node: one state for all readers of `bin_data`, `value` and `valueN`.
//!
//! Owns the way of a sample into the latch, when samples are taken (on read, by the clock, on event), which reads wait for
//! the first one, and when a sample is too old to be shown. `pace` takes samples in the background, `page` is the copy in
//! the kernel's page cache, `bus` the one in shared memory, `joining` is who comes and goes, `need` whether anybody needs
//! the clock's samples. A failure replaces the sample: what cannot be read is an error with a reason, never the
//! value of before.

// A pace or a kind of source that is forgotten must not leave a value that grows old in silence.
#![deny(clippy::wildcard_enum_match_arm)]

mod bus;
mod joining;
mod need;
mod pace;
mod page;
mod tap;

use crate::clock::Stamp;
use crate::crew::lock_patiently;
use crate::device::{Got, Patience};
use crate::errno::Error;
use crate::events::{Due, Ready, lock};
use crate::latch::{Era, Glimpse, Latch};
use crate::limits;
use crate::node::{Feed, Node};
use crate::reader::Reader;
use crate::state_reader::StateReader;
use crate::transport::RequestId;
use config::description::Pace;
use config::format::FieldKind;
use need::Need;
use pace::{Ageing, Listening, Sampling};
pub use pace::{renew, too_old};
use page::Page;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::SyncSender;
use std::sync::{Arc, Mutex, Weak};
use std::time::{Duration, Instant};
use tap::Tap;

/// Newest sample of one node and everything that keeps it new.
pub struct Newest {
    node: Weak<Node>,
    latch: Latch,
    work: Mutex<Work>,
    /// Open files that keep the source of an unsampled node open.
    users: AtomicU32,
    /// Which users need the samples of a node that is sampled by the clock.
    need: Need,
    /// The source had its time and said nothing, and was left: nobody waits for it as long once more.
    was_silent: AtomicBool,
    waiting: Mutex<Vec<Waiting>>,
    watchers: Mutex<Vec<Weak<dyn Ready>>>,
    jobs: Mutex<Vec<Arc<dyn Due>>>,
    /// The sample out of turn that no writer waits for any longer; that of a later write is in its place.
    renewal: Mutex<Option<Arc<dyn Due>>>,
    page: Page,
    /// What the source gave, for those who want it as it was.
    tap: Tap,
}

#[derive(Default)]
struct Work {
    source: Source,
    tuple: Vec<u8>,
}

#[derive(Default)]
enum Source {
    #[default]
    Closed,
    State(StateReader),
    Stream(Arc<Reader>),
}

/// On which thread a sample is taken.
#[derive(Clone, Copy)]
enum Thread {
    /// One that may wait for the page cache.
    Clock,
    /// Perhaps one that is inside an operation and may not.
    Any,
}

/// How long a read waits before it is looked whether anything is on its way, and between two such looks.
const SILENCE: Duration = Duration::from_millis(limits::SILENCE_MS);

struct Waiting {
    id: RequestId,
    file: Weak<dyn Waiter>,
    deadline: Instant,
}

/// An open file whose read waits for the first sample.
pub trait Waiter: Send + Sync {
    /// Answers the claimed request from the newest sample, or with the error.
    fn serve(&self, id: RequestId, error: Option<Error>);
}

impl Newest {
    /// No sample yet.
    pub fn new(node: Weak<Node>) -> Self {
        Self {
            node,
            latch: Latch::new(),
            work: Mutex::default(),
            users: AtomicU32::new(0),
            need: Need::new(),
            was_silent: AtomicBool::new(false),
            waiting: Mutex::default(),
            watchers: Mutex::default(),
            jobs: Mutex::default(),
            renewal: Mutex::default(),
            page: Page::default(),
            tap: Tap::default(),
        }
    }

    /// Starts background sampling if the description asks for it.
    pub fn start(&self) {
        let Some(node) = self.node.upgrade() else {
            return;
        };
        self.join_bus(&node);
        match node.description.pace {
            Pace::OnRead => {}
            Pace::Every { .. } => {
                self.need.begin();
                self.schedule_sampling(&node, Instant::now(), None);
            }
            Pace::OnEvent => {
                let me: Arc<dyn Due> = Arc::new(Listening {
                    node: self.node.clone(),
                });
                node.engine.schedule.at(Instant::now(), Arc::downgrade(&me));
                lock(&self.jobs).push(me);
                self.schedule_ageing(&node);
            }
        }
    }

    /// Starts the clock at a time; `first` hears of the first attempt.
    fn schedule_sampling(&self, node: &Arc<Node>, at: Instant, first: Option<SyncSender<()>>) {
        let sampler: Arc<dyn Due> = Arc::new(Sampling::of(self.node.clone(), first));
        node.sampling_schedule().at(at, Arc::downgrade(&sampler));
        // Entries of earlier jobs die with them.
        *lock(&self.jobs) = vec![sampler];
        self.schedule_ageing(node);
    }

    fn schedule_ageing(&self, node: &Node) {
        let Some(age) = too_old(node) else {
            return;
        };
        let ageing: Arc<dyn Due> = Arc::new(Ageing {
            node: self.node.clone(),
        });
        let at = Instant::now() + age;
        node.engine.schedule.at(at, Arc::downgrade(&ageing));
        lock(&self.jobs).push(ageing);
    }

    /// The sampling period was changed.
    pub fn period_changed(&self) {
        if let Some(node) = self.node.upgrade() {
            self.tell_bus_of_period(&node);
            if self.need.is_awake() {
                self.schedule_sampling(&node, Instant::now(), None);
            }
        }
    }

    /// Stops sampling and answers all reads that wait with ESTALE.
    pub fn stop(&self) {
        lock(&self.jobs).clear();
        lock(&self.renewal).take();
        self.leave_bus();
        for waiting in std::mem::take(&mut *lock(&self.waiting)) {
            self.finish(&waiting, Some(Error::Stale));
        }
        if let Some(node) = self.node.upgrade() {
            self.page.close(&node.engine);
        }
        // A sampler that is inside the device right now closes the source when it comes out.
        if let Ok(mut work) = self.work.try_lock() {
            work.source = Source::Closed;
        }
    }

    /// Brings the latch up to date for a reader: samples now unless the background does.
    pub fn refresh(&self) -> Result<(), Error> {
        let Some(node) = self.node.upgrade() else {
            return Err(Error::Stale);
        };
        if node.is_retired() {
            return Err(Error::Stale);
        }
        if node.description.pace == Pace::OnRead {
            let _inside = node.quarantine.enter()?;
            self.sample(&node, Thread::Any);
        }
        Ok(())
    }

    /// A write has made the newest sample wrong, and no other has come in time: it is forgotten, and reads wait for the
    /// sample that `renewal` takes. The page goes later, because this is inside an operation.
    fn outdate(&self, node: &Arc<Node>, renewal: Arc<dyn Due>) {
        self.latch.forget();
        // Once more: what it samples at this moment does not count any longer.
        node.sampling_schedule()
            .at(Instant::now(), Arc::downgrade(&renewal));
        *lock(&self.renewal) = Some(renewal);
        self.page.unwant();
        let due: Arc<dyn Due> = node.clone();
        (node.engine.schedule).at(Instant::now(), Arc::downgrade(&due));
    }

    /// What the page may hold, if anything, goes, but not from here: this may be inside an operation.
    fn drop_page_soon(&self, node: &Arc<Node>) {
        if self.page.may_hold_something() {
            self.page.unwant();
            let due: Arc<dyn Due> = node.clone();
            (node.engine.schedule).at(Instant::now(), Arc::downgrade(&due));
        }
    }

    /// The newest sample. None: there is none yet.
    pub fn get(&self, tuple: &mut Vec<u8>) -> Result<Option<u32>, Error> {
        let Some(node) = self.node.upgrade() else {
            return Err(Error::Stale);
        };
        let Some(Glimpse { age_ns, events }) = self.latch.get(too_old(&node), tuple)? else {
            return Ok(None);
        };
        node.stats.age.add(age_ns);
        Ok(Some(events))
    }

    /// Tells the tuples of the newest sample on their way: that of the source, then what each converter has made of it, as far
    /// as it came. Nothing is copied for this when a sample is taken.
    pub fn tell_stages(&self, tell: &mut dyn FnMut(&[u8])) {
        let Some(node) = self.node.upgrade() else {
            return;
        };
        // Held until the end: no other sample comes in between.
        let work = lock_patiently(&self.work);
        let is_through = match &work.source {
            Source::Closed => false,
            Source::State(state) => state.tell_stages(tell),
            Source::Stream(reader) => reader.tell_stages(tell),
        };
        let mut tuple = Vec::new();
        if is_through && let Ok(Some(_)) = self.latch.get(too_old(&node), &mut tuple) {
            tell(&tuple);
        }
    }

    /// The latch itself.
    pub fn latch(&self) -> &Latch {
        &self.latch
    }

    /// Samples are taken without anybody reading.
    pub fn is_in_background(&self) -> bool {
        let node = self.node.upgrade();
        node.is_some_and(|node| node.description.pace != Pace::OnRead)
    }

    /// The clock takes samples of this node, but none at the moment, because nobody needs them.
    pub fn is_at_rest(&self) -> bool {
        let node = self.node.upgrade();
        let by_clock = |node: Arc<Node>| matches!(node.description.pace, Pace::Every { .. });
        node.is_some_and(by_clock) && !self.need.is_awake()
    }

    /// When the newest sample was taken, however old it is.
    pub fn stamp(&self) -> Option<Stamp> {
        self.latch.stamp()
    }

    /// The number of the newest event; see [`get`](Self::get).
    pub fn events(&self) -> u32 {
        self.latch.events()
    }

    /// Whether there is no sample, and none is on its way: the source has never said anything. Nobody waits for such
    /// a one who has not chosen to, by poll or with `device`.
    pub fn is_silent(&self) -> bool {
        let Some(node) = self.node.upgrade() else {
            return false;
        };
        if self.latch.has_news() {
            return false;
        }
        // The thread that has the lock takes a sample.
        let Ok(work) = self.work.try_lock() else {
            return false;
        };
        match &work.source {
            Source::Closed => false,
            Source::State(state) => state.is_silent(),
            Source::Stream(reader) => {
                let mut patience = Patience::of(&node.description);
                if self.was_silent.load(Ordering::Relaxed) {
                    patience.by_itself = Patience::WITH_NOBODY;
                }
                reader.is_silent(patience)
            }
        }
    }

    /// Keeps a read until the first sample, at most `timeout_ms`, or until the source counts as silent.
    pub fn wait(&self, id: RequestId, file: Weak<dyn Waiter>) {
        let Some(node) = self.node.upgrade() else {
            return;
        };
        let deadline = Instant::now() + Duration::from_millis(node.description.timeout_ms.into());
        lock(&self.waiting).push(Waiting { id, file, deadline });
        let due: Arc<dyn Due> = node.clone();
        let look = deadline.min(Instant::now() + SILENCE);
        node.engine.schedule.at(look, Arc::downgrade(&due));
        // The sample may have come before the request was in the list; a stream may need to be watched.
        self.arm(&node);
        self.ready();
        if self.latch.has_news() {
            self.serve_waiting();
        }
    }

    /// Makes sure that the reader of a stream calls when there is more; sampling by the clock needs no call.
    fn arm(&self, node: &Node) {
        if matches!(node.description.pace, Pace::Every { .. }) {
            return;
        }
        let reader = match &lock_patiently(&self.work).source {
            Source::Stream(reader) => reader.clone(),
            Source::Closed | Source::State(_) => return,
        };
        if let Err(error) = reader.arm() {
            node.report(&error);
        }
    }

    /// Answers reads whose time is over, or all if the source is silent, and drops a page that is not to be used; says when
    /// the next read is due.
    pub fn expire(&self) -> Option<Instant> {
        let mut again = None;
        if let Some(node) = self.node.upgrade() {
            self.page.drop_unwanted(&node.engine);
            again = self.close_unused(&node);
        }
        if lock(&self.waiting).is_empty() {
            return again;
        }
        let is_silent = self.is_silent();
        let now = Instant::now();
        let (over, next) = {
            let mut waiting = lock(&self.waiting);
            let (over, rest): (Vec<_>, Vec<_>) = std::mem::take(&mut *waiting)
                .into_iter()
                .partition(|one| is_silent || one.deadline <= now);
            *waiting = rest;
            let next = waiting.iter().map(|one| one.deadline).min();
            (over, next.map(|deadline| deadline.min(now + SILENCE)))
        };
        for one in over {
            let error = if one.deadline <= now {
                Error::TimedOut("no sample within timeout_ms".to_owned())
            } else {
                Error::Silent
            };
            // A reader that was interrupted meanwhile has missed nothing.
            if let Some(node) = self.node.upgrade()
                && node.engine.is_parked(one.id)
            {
                node.report(&error);
            }
            self.finish(&one, Some(error));
        }
        next.into_iter().chain(again).min()
    }

    fn finish(&self, waiting: &Waiting, error: Option<Error>) {
        let Some(node) = self.node.upgrade() else {
            return;
        };
        if node.engine.claim(waiting.id)
            && let Some(file) = waiting.file.upgrade()
        {
            file.serve(waiting.id, error);
        }
    }

    fn serve_waiting(&self) {
        for one in std::mem::take(&mut *lock(&self.waiting)) {
            self.finish(&one, None);
        }
    }

    /// Calls `file` at every sample and failure, for as long as it lives.
    pub fn watch(&self, file: Weak<dyn Ready>) {
        let mut watchers = lock(&self.watchers);
        watchers.retain(|other| other.strong_count() > 0);
        watchers.push(file);
        drop(watchers);
        if let Some(node) = self.node.upgrade() {
            self.arm(&node);
        }
    }

    /// Takes one sample (a state, an own stream) or everything that has come (a shared stream). False: there is no source.
    fn sample(&self, node: &Arc<Node>, thread: Thread) -> bool {
        let mut work = lock_patiently(&self.work);
        let era = self.latch.era();
        if let Err(error) = work.open(node) {
            drop(work);
            self.fail(error, thread);
            return false;
        }
        let outcome = work.take(node, |tuple| self.publish(node, era, tuple, thread));
        let is_gone = matches!(&outcome, Err(error) if error.is_gone());
        if is_gone || node.is_retired() {
            work.source = Source::Closed;
        }
        match node.description.pace {
            Pace::Every { .. } => self.close_if_at_rest(&mut work),
            // The last one may have gone meanwhile.
            Pace::OnRead => self.close_if_unused(&mut work),
            Pace::OnEvent => {}
        }
        drop(work);
        if let Err(error) = outcome {
            self.fail(error, thread);
        }
        !is_gone
    }

    /// A stream may have more: called by its reader.
    pub fn ready(&self) {
        let Some(node) = self.node.upgrade() else {
            return;
        };
        let listens = match node.description.pace {
            Pace::OnEvent => true,
            Pace::OnRead => matches!(lock_patiently(&self.work).source, Source::Stream(_)),
            Pace::Every { .. } => false,
        };
        if listens {
            self.sample(&node, Thread::Clock);
            if node.description.pace == Pace::OnEvent {
                self.arm(&node);
            }
        }
    }

    fn publish(&self, node: &Arc<Node>, era: Era, tuple: &[u8], thread: Thread) {
        if node
            .format
            .fields()
            .iter()
            .any(|field| matches!(field.kind, FieldKind::F32 | FieldKind::F64))
            && let Err(why) = node.format.render(tuple, &mut String::new())
        {
            let error = Error::Converter(why.to_string());
            node.report(&error);
            return self.fail(error, thread);
        }
        if !self.latch.publish(era, tuple) {
            return;
        }
        node.stats.samples.add(1);
        self.was_silent.store(false, Ordering::Relaxed);
        match thread {
            Thread::Clock => self.page.fill(&node.engine, tuple),
            Thread::Any => self.drop_page_soon(node),
        }
        self.notify();
        node.driving.measured(node, tuple);
    }

    fn fail(&self, error: Error, thread: Thread) {
        self.tap.fail(&error);
        let is_new = self.latch.fail(&error);
        if let Some(node) = self.node.upgrade() {
            match thread {
                Thread::Clock if is_new => self.page.drop(&node.engine),
                Thread::Any => self.drop_page_soon(&node),
                Thread::Clock => {}
            }
            node.driving.not_measured(&node, &error);
        }
        self.notify();
    }

    fn notify(&self) {
        self.serve_waiting();
        let watchers: Vec<_> = lock(&self.watchers)
            .iter()
            .filter_map(Weak::upgrade)
            .collect();
        for watcher in watchers {
            watcher.ready();
        }
    }

    /// Whether an open of `bin_data` may be served from the page cache: there is a good sample, and a publisher.
    pub fn can_cache(&self, ino: u64) -> bool {
        let Some(node) = self.node.upgrade() else {
            return false;
        };
        let background = node.description.pace != Pace::OnRead;
        let size = node.description.output_tuple_size;
        background
            && self.latch.is_good()
            && Page::can_hold(&node.engine, size)
            && self.page.is_of(ino)
    }

    /// A cached open file comes (true) or goes.
    pub fn count_cached(&self, comes: bool) {
        self.page.count_reader(comes);
    }

    /// A cached open file starts being polled (true) or goes.
    pub fn count_polled(&self, comes: bool) {
        self.page.count_polled(comes);
        if comes && let Some(node) = self.node.upgrade() {
            // What is in the page must go, but not from here: this is inside an operation.
            let due: Arc<dyn Due> = node.clone();
            node.engine
                .schedule
                .at(Instant::now(), Arc::downgrade(&due));
        }
    }
}

/// A need for the samples of a node that is sampled by the clock, until it is dropped.
pub struct Needed(Weak<Node>);

impl Drop for Needed {
    fn drop(&mut self) {
        if let Some(node) = self.0.upgrade()
            && matches!(node.description.pace, Pace::Every { .. })
        {
            node.sampling.newest.need.goes();
        }
    }
}

impl Work {
    fn open(&mut self, node: &Arc<Node>) -> Result<(), Error> {
        if matches!(self.source, Source::Closed) {
            let on_ready: Arc<dyn Ready> = node.clone();
            self.source = match node.open_feed(&on_ready)? {
                Feed::State(_) if node.description.pace == Pace::OnEvent => {
                    return Err(Error::NoDevice(
                        "the source is a state and has no events; use poll_ms".to_owned(),
                    ));
                }
                Feed::State(state) => Source::State(state.tapped()),
                Feed::Stream(reader) => {
                    reader.tap();
                    Source::Stream(reader)
                }
            };
        }
        Ok(())
    }

    fn take(&mut self, node: &Arc<Node>, mut publish: impl FnMut(&[u8])) -> Result<(), Error> {
        self.tuple.resize(node.description.output_tuple_size, 0);
        let reader = match &mut self.source {
            Source::Closed => return Ok(()),
            Source::State(state) => {
                if state.sample(&mut self.tuple)? {
                    publish(&self.tuple);
                }
                return Ok(());
            }
            Source::Stream(reader) => reader,
        };
        let drains = reader.is_shared() || node.description.pace == Pace::OnEvent;
        let most = if drains { limits::QUEUE_TUPLES } else { 1 };
        for _ in 0..most {
            match reader.read(&mut self.tuple)? {
                Got::Bytes(_) => publish(&self.tuple),
                Got::Nothing => break,
                Got::End if drains => break,
                Got::End => return Err(Error::NoDevice("the source has ended".to_owned())),
            }
        }
        Ok(())
    }
}
