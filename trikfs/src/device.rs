//! Sources and sinks: where a node's bytes come from and go to.
//!
//! Owns the traits and what opening needs beside a description. Each kind is one file below that implements [`Kind`] for
//! its description; only those files open device nodes, and `kinds` lists them. Nothing here converts a tuple, or knows
//! an open file or a request of the kernel.

mod absent;
pub mod attribute;
pub mod chardev;
mod cutter;
pub mod evdev;
pub mod fake;
pub mod faulty;
pub mod fifo;
pub mod gpio;
pub mod i2c;
pub mod iio;
pub mod kinds;
pub mod latched;
pub mod lines;
pub mod linked;
pub mod packets;
mod path;
pub mod played;
pub mod program;
pub mod pwm;
mod regulator;
pub mod replay;
pub mod several;
mod sysfs;

use crate::convert::LogSink;
use crate::engine::Engine;
use crate::errno::Error;
use crate::limits;
use crate::log::Log;
use crate::programs::Programs;
use crate::stats::Counter;
use config::description::{NodeDescription, Pace};
use linked::LinkedNode;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::collections::BTreeSet;
use std::os::fd::BorrowedFd;
use std::os::unix::fs::MetadataExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

/// What can be read in one of the two ways in which sources deliver: the source itself, and what stands over it.
pub enum ByDelivery<S, T> {
    /// Something that has a value at any time.
    State(S),
    /// Something that delivers one tuple after another.
    Stream(T),
}

/// What opening a source gives.
pub type Device = ByDelivery<Box<dyn State>, Box<dyn Stream>>;

/// A source that can be asked again: a sysfs attribute, a register, a regular file.
pub trait State: Send {
    /// Reads from a byte position of the source; 0 means its end. May take as long as the device takes.
    /// [`Error::WouldBlock`]: there is nothing to read yet.
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error>;

    /// Text that ends before the tuple does is filled up with zero bytes (`read_at` at 0 gives all there is).
    fn is_text(&self) -> bool {
        false
    }

    /// There is nothing to read yet and nothing on its way, because another node is silent.
    fn is_silent(&self) -> bool {
        false
    }

    /// Samples one raw tuple. Text is filled up with zero bytes; anything else that is short is an error.
    fn whole_tuple(&mut self, tuple: &mut [u8]) -> Result<(), Error> {
        let n = self.read_at(0, tuple)?;
        if n < tuple.len() {
            if !self.is_text() || n == 0 {
                let what = format!(
                    "the source gave {n} of the {} bytes of a tuple",
                    tuple.len()
                );
                return Err(Error::Malformed(what));
            }
            tuple[n..].fill(0);
        }
        Ok(())
    }
}

/// A source that delivers and forgets.
pub trait Stream: Send {
    /// Takes what is there, without waiting.
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error>;

    /// Becomes readable (edge-triggered) when `read` may give more after it gave [`Got::Nothing`].
    fn fd(&self) -> Option<BorrowedFd<'_>>;

    /// When to read again after [`Got::Nothing`], for sources that run by the clock.
    fn wake_at(&self) -> Option<Instant> {
        None
    }

    /// False when another source stands at the same place by now, or none: a FIFO that was deleted and made again.
    fn is_still_there(&self) -> bool {
        true
    }

    /// Whether a source that has given nothing since it was opened, `open` ago, counts as silent: nothing is on its way, so
    /// nobody should wait for it who has not chosen to.
    fn is_silent(&self, open: Duration, patience: Patience) -> bool {
        self.wake_at().is_none() && open >= patience.by_itself
    }

    /// Whether it speaks of changes only, so that its last tuple says what is so until the next one: a reader that comes to
    /// an opening that others have already gets it first.
    fn tells_changes_only(&self) -> bool {
        false
    }

    /// Whether opening it again after [`Got::End`] can give more (the next writer of a FIFO).
    fn begins_anew(&self) -> bool {
        true
    }
}

/// How long a source that has given nothing yet is waited for, from its opening on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Patience {
    /// One that speaks by itself, such as a serial sensor.
    pub by_itself: Duration,
    /// One that speaks when somebody does something: presses a key, writes to a pipe.
    pub by_somebody: Duration,
}

impl Patience {
    /// With whom nothing is on its way: a pipe that nobody has open for writing.
    pub const WITH_NOBODY: Duration = Duration::from_millis(limits::SILENCE_MS);

    /// For readers of a node. What is read in the background has had its time; what is opened by a read has `timeout_ms`.
    pub fn of(description: &NodeDescription) -> Self {
        let timeout = Duration::from_millis(description.timeout_ms.into());
        let by_somebody = match description.pace {
            Pace::OnRead => timeout,
            Pace::Every { .. } | Pace::OnEvent => Self::WITH_NOBODY,
        };
        Self {
            by_itself: timeout,
            by_somebody,
        }
    }
}

/// Outcome of reading a stream.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Got {
    /// So many bytes, at least one.
    Bytes(usize),
    /// Nothing at the moment.
    Nothing,
    /// The end: a FIFO without writers, a recording that is over. More may follow when it begins anew.
    End,
}

/// Where written tuples go.
pub trait Sink: Send {
    /// Sends one whole tuple. A device that takes no bytes now is waited for, at most for the sink's time limit;
    /// not at all (EAGAIN) if the writer does not wait and nothing of the tuple has gone yet.
    fn write(&mut self, tuple: &[u8], waits: bool) -> Result<(), Error>;
}

/// A device without tuples: each read and write is a transfer of its own, with what a position stands for.
pub trait Positions: Send + Sync {
    /// Fills the buffer from a position on.
    fn read(&self, position: u64, buffer: &mut [u8]) -> Result<(), Error>;

    /// Sends bytes to a position.
    fn write(&self, position: u64, bytes: &[u8]) -> Result<(), Error>;
}

/// What opening needs to know beside the description.
#[derive(Clone)]
pub struct Surroundings {
    /// Nodes that `trikfs:` sources of this node name, by path.
    pub links: Vec<(String, Arc<dyn LinkedNode>)>,
    /// How long a sink waits for a device that takes no bytes.
    pub timeout_ms: u32,
    /// Where the node counts what its source had to throw away.
    pub damaged: Arc<Counter>,
    /// Programs that sensors need.
    pub programs: Arc<Programs>,
    /// What has to be said and is no failure.
    pub log: LogSink,
    /// The I2C buses of the mount.
    pub buses: Arc<i2c::bus::Buses>,
    /// What the sensor program of this node answered last.
    pub answer: Arc<lines::answer::Answer>,
}

impl Surroundings {
    /// Those of a mount, without links and with the usual time limit.
    pub fn new(engine: &Engine) -> Self {
        let log = engine.log.clone();
        Self {
            links: Vec::new(),
            timeout_ms: config::limits::TIMEOUT_MS,
            damaged: Arc::default(),
            programs: engine.programs.clone(),
            log: Arc::new(move |text| log.line(text)),
            buses: engine.buses.clone(),
            answer: Arc::default(),
        }
    }

    /// For a device and nothing else: no nodes, no log.
    pub fn alone(timeout_ms: u32, buses: &Arc<i2c::bus::Buses>) -> Self {
        Self {
            links: Vec::new(),
            timeout_ms,
            damaged: Arc::default(),
            programs: Programs::new(Arc::new(Log::new())),
            log: Arc::new(|_| {}),
            buses: buses.clone(),
            answer: Arc::default(),
        }
    }

    /// A node that the source names.
    fn link(&self, path: &str) -> Result<&Arc<dyn LinkedNode>, Error> {
        let found = self.links.iter().find(|(name, _)| name == path);
        found
            .map(|(_, node)| node)
            .ok_or_else(|| Error::NoDevice(format!("there is no node {path}")))
    }
}

/// What a kind of source can do.
pub trait Kind {
    /// Opens it for reading. `tuple_size` is that of the source, for kinds that produce whole tuples.
    fn open(&self, tuple_size: usize, around: &Surroundings) -> Result<Device, Error>;

    /// Opens it for writing.
    fn open_sink(&self, _around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        Err(Error::AccessDenied)
    }

    /// Whether all readers share one opening: it gives each datum once or lets only one process in.
    fn is_shared(&self) -> Result<bool, Error>;

    /// The buses whose transfers it waits for, itself or through nodes that it reads or drives.
    fn add_buses(&self, _around: &Surroundings, _buses: &mut BTreeSet<PathBuf>) {}

    /// Opens what has no tuples; None for all that has them.
    fn open_positions(&self, _around: &Surroundings) -> Result<Option<Box<dyn Positions>>, Error> {
        Ok(None)
    }

    /// What moves when it is written.
    fn drives(&self) -> Drives<'_> {
        Drives::Itself
    }
}

/// What moves when a source is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Drives<'a> {
    /// What it names itself.
    Itself,
    /// The node at this path, which it stands for.
    Other(&'a str),
    /// The node at this path, which a regulator drives so that what is written is held.
    Held(&'a str),
}

/// Whether a stream has something that nobody has read yet.
pub(crate) fn is_readable(stream: &dyn Stream) -> bool {
    stream.fd().is_some_and(|fd| {
        let mut fds = [PollFd::new(fd, PollFlags::POLLIN)];
        let asked = poll(&mut fds, PollTimeout::ZERO);
        let events = fds[0].revents().unwrap_or(PollFlags::empty());
        asked.is_ok() && events.contains(PollFlags::POLLIN)
    })
}

/// Whether a path still leads to the file that is open.
pub(crate) fn is_same_file(file: &std::fs::File, path: &Path) -> bool {
    let same = |there: std::fs::Metadata, open: std::fs::Metadata| {
        (there.dev(), there.ino()) == (open.dev(), open.ino())
    };
    match (std::fs::metadata(path), file.metadata()) {
        (Ok(there), Ok(open)) => same(there, open),
        _ => false,
    }
}

/// An I/O error of a device, with the path in its text.
pub(crate) fn device_error(path: &Path, error: &std::io::Error) -> Error {
    Error::of_device(path, error)
}
