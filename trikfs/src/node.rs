//! What stands behind one description: its converters, its sources, its newest value, its statistics.
//!
//! Owns the joints between these, the node's fault and the flag that a reload sets when the description is gone.
//! Knows no file of the tree and no request of the kernel.

mod fault;
mod linked;
mod rest;
mod written;

use crate::clock::Stamp;
use crate::convert::{LogSink, Pipeline, Recipe};
use crate::crew::lock_patiently;
use crate::device::lines::answer::Answer;
use crate::device::linked::LinkedNode;
use crate::device::{self, Device, Sink, Stream, Surroundings, kinds};
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::{Due, Ready, Schedule, lock};
use crate::hub::Hub;
use crate::lease::Lease;
use crate::limits;
use crate::newest::Newest;
use crate::reader::{Origin, Reader};
use crate::regulation::Regulation;
use crate::state_reader::StateReader;
use crate::stats::Stats;
use crate::writer::Writer;
use config::description::{NodeDescription, Pace, SourceDescription};
use config::format::Format;
use config::problem::Problem;
use converter::Direction;
use fault::Trouble;
use std::collections::BTreeSet;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, Weak};
use written::Written;

/// One described peripheral.
pub struct Node {
    /// As the configuration says.
    pub description: NodeDescription,
    /// One file of another node's directory, not a directory of its own.
    pub is_attribute: bool,
    /// The description's fingerprint together with those of the nodes it is linked to.
    pub fingerprint: u128,
    /// Format of a converted tuple; single bytes when none was given.
    pub format: Format,
    /// The mount's services.
    pub engine: Arc<Engine>,
    /// Who may write the files of the node's directory.
    pub lease: Arc<Lease>,
    /// The same, and those of the nodes that a write passes on its way to the device.
    pub leases: Vec<Arc<Lease>>,
    /// Counts and times.
    pub stats: Stats,
    /// The newest sample, and how it is got.
    pub newest: Newest,
    recipe: Recipe,
    /// Nodes that the source names, by path.
    links: Vec<(String, Arc<Self>)>,
    around: Surroundings,
    hub: Mutex<Weak<Hub>>,
    trouble: Trouble,
    written: Written,
    rate: Mutex<Rate>,
    retired: AtomicBool,
    period_ms: AtomicU32,
    /// How often a tuple went to the device. Wraps.
    writes: AtomicU32,
    /// Only for the source `regulator{...}`.
    regulation: Option<Regulation>,
    /// A regulator drives this node.
    is_regulated: AtomicBool,
    turn: Mutex<()>,
    /// Why a regulator that drove this node gave up.
    lost: Mutex<Option<Error>>,
    /// When each of the operations that are inside now began, in coarse ms.
    inside: [AtomicU32; limits::LATE_PER_NODE_MAX],
}

/// How a node can be read.
pub enum Feed {
    /// A value at any time.
    State(StateReader),
    /// One tuple after another.
    Stream(Arc<Reader>),
}

impl Node {
    /// Puts a node together; opens nothing.
    pub fn new(
        description: NodeDescription,
        is_attribute: bool,
        fingerprint: u128,
        recipe: Recipe,
        links: Vec<(String, Arc<Self>)>,
        engine: Arc<Engine>,
        lease: Arc<Lease>,
    ) -> Arc<Self> {
        let format = description
            .format
            .clone()
            .unwrap_or_else(|| Format::bytes(description.output_tuple_size));
        let regulation = match &description.source {
            SourceDescription::Regulator(regulator) => links
                .iter()
                .find(|(path, _)| *path == regulator.actuator)
                .map(|(_, actuator)| Regulation::new(actuator.clone())),
            _ => None,
        };
        let stats = Stats::default();
        let mut leases = vec![lease.clone()];
        if let Some(other) = description.source.written_node() {
            let linked = links.iter().filter(|(path, _)| path == other);
            // One that stands for another node has its lease.
            let others = linked.flat_map(|(_, node)| node.leases.clone());
            leases.extend(others.filter(|other| !Arc::ptr_eq(other, &lease)));
        }
        let named = links.iter().map(|(path, node)| {
            let node: Arc<dyn LinkedNode> = node.clone();
            (path.clone(), node)
        });
        let around = Surroundings {
            links: named.collect(),
            timeout_ms: description.timeout_ms,
            damaged: stats.damaged.clone(),
            log: log_sink(&engine, &description.path),
            ..Surroundings::new(&engine)
        };
        let period_ms = match description.pace {
            Pace::Every { period_ms } => period_ms,
            Pace::OnRead | Pace::OnEvent => 0,
        };
        Arc::new_cyclic(|me| Self {
            is_attribute,
            fingerprint,
            format,
            engine,
            lease,
            leases,
            stats,
            newest: Newest::new(me.clone(), description.output_tuple_size),
            recipe,
            links,
            around,
            hub: Mutex::default(),
            trouble: Trouble::default(),
            written: Written::default(),
            rate: Mutex::new(Rate {
                count: 0,
                since: Stamp::now(),
                hz: 0.0,
            }),
            retired: AtomicBool::new(false),
            period_ms: AtomicU32::new(period_ms),
            writes: AtomicU32::new(0),
            regulation,
            is_regulated: AtomicBool::new(false),
            turn: Mutex::default(),
            lost: Mutex::default(),
            inside: Default::default(),
            description,
        })
    }

    /// Path below the mount point.
    pub fn path(&self) -> &str {
        &self.description.path
    }

    /// Path of the directory that holds the node's files.
    pub fn directory(&self) -> &str {
        directory_of(&self.description.path, self.is_attribute)
    }

    /// A reload has changed or removed the description.
    pub fn is_retired(&self) -> bool {
        self.retired.load(Ordering::Acquire)
    }

    /// From here on everything that is open on this node gets ESTALE.
    pub fn retire(&self) {
        self.retired.store(true, Ordering::Release);
        self.newest.stop();
    }

    /// Converters of this node that are opened from now on take their Lua states from here.
    pub fn recipe(&self) -> &Recipe {
        &self.recipe
    }

    /// Sampling period in ms; 0 unless sampled in the background.
    pub fn period_ms(&self) -> u32 {
        self.period_ms.load(Ordering::Relaxed)
    }

    /// Changes the sampling period of a node that is sampled in the background.
    pub fn set_period_ms(&self, period_ms: u32) -> Result<(), Error> {
        if !matches!(self.description.pace, Pace::Every { .. }) {
            return Err(Error::Invalid(
                "the node is not sampled by the clock: its description has no poll_ms".to_owned(),
            ));
        }
        if period_ms == 0 || period_ms > config::limits::PERIOD_MS_MAX {
            return Err(Error::OutOfRange(format!(
                "poll_ms is 1 to {} ms",
                config::limits::PERIOD_MS_MAX
            )));
        }
        self.period_ms.store(period_ms, Ordering::Relaxed);
        self.newest.period_changed();
        Ok(())
    }

    /// What the sensor program of this node answered last.
    pub fn answer(&self) -> &Answer {
        &self.around.answer
    }

    /// Bytes of one tuple that goes to the device.
    pub fn device_tuple_size(&self) -> usize {
        self.description.write_conversion_sizes().1
    }

    /// Holds what is written by driving another node.
    pub fn regulation(&self) -> Option<&Regulation> {
        self.regulation.as_ref()
    }

    /// Changes whenever a lease that a write to this node touches changes hands.
    pub fn lease_generation(&self) -> u32 {
        let generations = self.leases.iter().map(|lease| lease.generation());
        generations.fold(0, u32::wrapping_add)
    }

    /// How often a tuple went to the device, for an alias to the device of the node that it stands for. Wraps.
    pub fn writes(&self) -> u32 {
        self.driven().writes.load(Ordering::Relaxed)
    }

    /// What is driven in the end: the node itself, or the one that it stands for.
    fn driven(&self) -> &Self {
        let mut node = self;
        while let SourceDescription::Node(link) = &node.description.source {
            match node.links.iter().find(|(name, _)| *name == link.path) {
                Some((_, other)) => node = other,
                None => break,
            }
        }
        node
    }

    /// From now on a regulator drives this node beside those who write to it.
    pub fn let_regulate(&self) {
        self.driven().is_regulated.store(true, Ordering::Relaxed);
    }

    /// The right to write, alone, to a node that a regulator drives; others need none. A regulator that finds the node
    /// its own and writes must not come behind somebody who writes at that moment and has the last word.
    pub fn take_turn(&self) -> Option<MutexGuard<'_, ()>> {
        let driven = self.driven();
        let is_regulated = driven.is_regulated.load(Ordering::Relaxed);
        is_regulated.then(|| lock_patiently(&driven.turn))
    }

    /// A tuple went to the device.
    pub fn count_write(&self) {
        self.writes.fetch_add(1, Ordering::Relaxed);
        *lock(&self.lost) = None;
    }

    /// Whether programs may read or write at all: root passes the kernel's check of the mode bits.
    pub fn check_access(&self, read: bool, write: bool) -> Result<(), Error> {
        let mode = self.description.mode;
        if (read && mode & 0o444 == 0) || (write && mode & 0o222 == 0) {
            return Err(Error::AccessDenied);
        }
        if self.is_retired() {
            Err(Error::Stale)
        } else {
            Ok(())
        }
    }

    /// Marks an operation that may enter the node's device or converter, for as long as the result lives.
    ///
    /// Refused while as many operations are inside as the limit allows, or one has been inside for so long that it
    /// will hardly return (native code that hangs, a driver that never answers): those keep their threads, and no
    /// further ones may join them.
    pub fn enter(&self) -> Result<Inside<'_>, Error> {
        // 0 marks a free place.
        let now_ms = crate::clock::coarse_ms().max(1);
        let limit_ms =
            limits::STUCK_MS + self.description.budget_us / 1000 + self.description.timeout_ms;
        let mut mine = None;
        for place in &self.inside {
            let since_ms = place.load(Ordering::Acquire);
            if since_ms == 0 {
                if mine.is_none()
                    && place
                        .compare_exchange(0, now_ms, Ordering::AcqRel, Ordering::Relaxed)
                        .is_ok()
                {
                    mine = Some(Inside(place));
                }
            } else if now_ms.wrapping_sub(since_ms) > limit_ms
                && now_ms.wrapping_sub(since_ms) < u32::MAX / 2
            {
                let for_ms = now_ms.wrapping_sub(since_ms);
                let what =
                    format!("quarantined: an earlier operation has not returned for {for_ms} ms");
                return Err(Error::Device(libc::EIO, what));
            }
        }
        mine.ok_or_else(|| {
            Error::Device(
                libc::EBUSY,
                "earlier operations have not returned yet".to_owned(),
            )
        })
    }

    /// A private pipeline of converters.
    pub fn open_pipeline(self: &Arc<Self>) -> Result<Arc<Mutex<Pipeline>>, Error> {
        let pipeline = self
            .recipe
            .open(&self.around.log)
            .inspect_err(|error| self.report(error))?;
        Ok(Arc::new(Mutex::new(pipeline)))
    }

    /// Opens the node for reading with a pipeline of its own.
    pub fn open_feed(self: &Arc<Self>, on_ready: &Arc<dyn Ready>) -> Result<Feed, Error> {
        let pipeline = self.open_pipeline()?;
        self.open_feed_with(pipeline, Arc::downgrade(on_ready))
    }

    /// Opens the node for reading. `on_ready` is called when a stream may have more.
    pub fn open_feed_with(
        self: &Arc<Self>,
        pipeline: Arc<Mutex<Pipeline>>,
        on_ready: Weak<dyn Ready>,
    ) -> Result<Feed, Error> {
        let opened = self.open_origin(&on_ready);
        let origin = match opened.inspect_err(|error| self.report(error))? {
            Opened::State(state) => {
                return Ok(Feed::State(StateReader::new(self.clone(), state, pipeline)));
            }
            Opened::Stream(origin) => origin,
        };
        Ok(Feed::Stream(Reader::new(
            self.clone(),
            origin,
            pipeline,
            on_ready,
        )))
    }

    fn open_origin(self: &Arc<Self>, on_ready: &Weak<dyn Ready>) -> Result<Opened, Error> {
        let by_kind = kinds::is_shared(&self.description.source)?;
        if self.description.share.unwrap_or(by_kind) {
            // What came before, an end included, is for those who were there before.
            let running = lock(&self.hub).upgrade();
            if let Some(hub) = running {
                hub.pump();
            }
            let mut slot = lock(&self.hub);
            let hub = match slot.upgrade() {
                Some(hub) => hub,
                None => match self.open_device()? {
                    Device::State(state) => return Ok(Opened::State(state)),
                    Device::Stream(stream) => {
                        let hub = Hub::start(self, stream);
                        *slot = Arc::downgrade(&hub);
                        hub
                    }
                },
            };
            return Ok(Opened::Stream(Origin::Shared(
                hub.subscribe(on_ready.clone()),
            )));
        }
        Ok(match self.open_device()? {
            Device::State(state) => Opened::State(state),
            Device::Stream(stream) => Opened::Stream(Origin::Own(stream)),
        })
    }

    fn open_device(&self) -> Result<Device, Error> {
        kinds::open(
            &self.description.source,
            self.description.input_tuple_size,
            &self.around,
        )
    }

    /// Opens the source, which must be a stream: one that was a stream before.
    pub fn open_stream(&self) -> Result<Box<dyn Stream>, Error> {
        match self.open_device()? {
            Device::Stream(stream) => Ok(stream),
            Device::State(_) => Err(Error::NoDevice(
                "the source is no longer a stream".to_owned(),
            )),
        }
    }

    /// Opens the node for writing, with the pipeline of the open file or one of its own.
    pub fn open_writer(
        self: &Arc<Self>,
        pipeline: Option<Arc<Mutex<Pipeline>>>,
    ) -> Result<Writer, Error> {
        if self.regulation.is_some() {
            return Ok(Writer::to_regulation(self.clone()));
        }
        let pipeline = pipeline.map_or_else(|| self.open_pipeline(), Ok)?;
        let sink: Box<dyn Sink> = kinds::open_sink(&self.description.source, &self.around)
            .inspect_err(|error| self.report(error))?;
        Ok(Writer::new(self.clone(), sink, pipeline))
    }

    /// Converts, counts and times: tuples taken, tuples made, and a fault that is reported already.
    pub fn convert(
        &self,
        pipeline: &mut Pipeline,
        direction: Direction,
        input: &[u8],
        output: &mut [u8],
    ) -> (usize, usize, Option<Error>) {
        if let Err(error) = self.recipe.renew(pipeline, || self.around.log.clone()) {
            self.report(&error);
            return (1, 0, Some(error));
        }
        let start = self.stats.measures_this_conversion().then(Stamp::now);
        let mut batch = pipeline.convert(direction, input, output);
        if direction == Direction::Read {
            batch.fault = batch.fault.map(Error::of_reading);
        }
        let (in_size, out_size) = match direction {
            Direction::Write => self.description.write_conversion_sizes(),
            Direction::Read => (
                self.description.input_tuple_size,
                self.description.output_tuple_size,
            ),
        };
        let whole = (input.len() / in_size).min(output.len() / out_size);
        // An empty chain counts nothing: it moved everything that was there and fitted.
        let (consumed, produced) = if batch.consumed == usize::MAX {
            (whole, whole)
        } else {
            (batch.consumed, batch.produced)
        };
        if let Some(start) = start
            && consumed > 0
        {
            self.stats.conversion.add(start.age_ns() / consumed as u64);
        }
        if let Some(error) = &batch.fault {
            self.report(error);
        } else if self.has_fault() {
            self.recover();
        }
        (consumed, produced, batch.fault)
    }

    /// Samples per second since the rate was last asked for, over at least a fifth of a second.
    pub fn rate_hz(&self) -> f64 {
        let mut rate = lock(&self.rate);
        let elapsed_ns = rate.since.age_ns();
        if elapsed_ns >= 200_000_000 {
            let count = self.stats.samples.get();
            #[allow(clippy::cast_precision_loss, reason = "a rate is shown with one digit")]
            let hz = (count - rate.count) as f64 * 1e9 / elapsed_ns as f64;
            *rate = Rate {
                count,
                since: Stamp::now(),
                hz,
            };
        }
        rate.hz
    }

    /// Where background samples of this node are scheduled: a node that reads one bus, itself or through other nodes,
    /// has its turn on the thread of that bus. One that reads several would make each wait for the others.
    pub fn sampling_schedule(&self) -> Arc<Schedule> {
        let mut buses = BTreeSet::new();
        self.add_buses(&mut buses);
        match (buses.pop_first(), buses.is_empty()) {
            (Some(bus), true) => self.engine.schedule_of(&bus),
            _ => self.engine.schedule.clone(),
        }
    }

    /// A problem at the place of this node's description.
    pub fn problem(&self, reason: &str) -> Problem {
        let place = &self.description.place;
        Problem::new(
            place.file.clone(),
            place.line,
            format!("node {}: {reason}", self.path()),
        )
    }
}

/// Lines of the log that begin with a node's path.
fn log_sink(engine: &Engine, path: &str) -> LogSink {
    let (log, path) = (engine.log.clone(), path.to_owned());
    Arc::new(move |text| log.line(&format!("{path}: {text}")))
}

/// The directory of a node, or of an attribute.
pub fn directory_of(path: &str, is_attribute: bool) -> &str {
    let parent = path.rsplit_once('/').filter(|_| is_attribute);
    parent.map_or(path, |(parent, _)| parent)
}

/// One operation inside a node: its place among those that may be there at once.
pub struct Inside<'a>(&'a AtomicU32);

impl Drop for Inside<'_> {
    fn drop(&mut self) {
        self.0.store(0, Ordering::Release);
    }
}

/// Samples counted when the rate was last computed.
struct Rate {
    count: u64,
    since: Stamp,
    hz: f64,
}

enum Opened {
    State(Box<dyn device::State>),
    Stream(Origin),
}

impl Ready for Node {
    fn ready(&self) {
        self.newest.ready();
    }
}

impl Due for Node {
    fn due(&self) -> Option<std::time::Instant> {
        self.newest.expire()
    }
}
