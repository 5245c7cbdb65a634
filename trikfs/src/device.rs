//! Sources and sinks: where a node's bytes come from and go to.
//!
//! Owns the traits, the decision which of them a description gets, and nothing else. Each kind of device is one
//! file below; only those files open device nodes. Nothing here knows converters, handles or the kernel's requests.
//! A bus that needs more than a file (I2C, IIO, PWM) is one more file and one more arm of [`open`]; [`add_buses`]
//! tells who waits for which bus.

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
pub mod latched;
pub mod lines;
pub mod linked;
pub mod packets;
pub mod program;
pub mod pwm;
pub mod replay;
pub mod several;
mod sysfs;

use crate::convert::LogSink;
use crate::engine::Engine;
use crate::errno::Error;
use crate::log::Log;
use crate::programs::Programs;
use crate::stats::Counter;
use config::description::{GpioDirection, SourceDescription};
use linked::LinkedNode;
use std::collections::BTreeSet;
use std::os::fd::BorrowedFd;
use std::os::unix::fs::{FileTypeExt, MetadataExt};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Instant;

/// What opening a source gives.
pub enum Device {
    /// Something that has a value at any time.
    State(Box<dyn State>),
    /// Something that delivers one tuple after another.
    Stream(Box<dyn Stream>),
}

/// A source that can be asked again: a sysfs attribute, a register, a regular file.
pub trait State: Send {
    /// Reads from a byte position of the source; 0 means its end. May take as long as the device takes.
    /// [`Error::WouldBlock`]: there is nothing to read yet.
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error>;

    /// Text that ends before the tuple does is filled up with zero bytes (`read_at` at 0 gives all there is).
    fn is_text(&self) -> bool {
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
                return Err(Error::Device(libc::EIO, what));
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

    /// Whether opening it again after [`Got::End`] can give more (the next writer of a FIFO).
    fn begins_anew(&self) -> bool {
        true
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

    /// For who has a device and nothing else: no nodes, nobody to talk to.
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

    fn link(&self, path: &str) -> Result<&Arc<dyn LinkedNode>, Error> {
        let found = self.links.iter().find(|(name, _)| name == path);
        found
            .map(|(_, node)| node)
            .ok_or_else(|| Error::NoDevice(format!("there is no node {path}")))
    }
}

/// Opens a source for reading. `tuple_size` is that of the source, for kinds that produce whole tuples.
pub fn open(
    source: &SourceDescription,
    tuple_size: usize,
    around: &Surroundings,
) -> Result<Device, Error> {
    match source {
        SourceDescription::Path(path) => open_path(path),
        SourceDescription::Attribute(path) => Ok(Device::State(Box::new(
            attribute::Attribute::open(path, true)?,
        ))),
        SourceDescription::Fifo(path) => Ok(Device::Stream(Box::new(fifo::Fifo::open(path)?))),
        SourceDescription::Evdev(evdev) => Ok(Device::Stream(Box::new(evdev::Evdev::open(evdev)?))),
        SourceDescription::Fake(fake) => Ok(fake::open(fake, tuple_size)),
        SourceDescription::Replay(replay) => {
            Ok(Device::Stream(Box::new(replay::Replay::open(replay)?)))
        }
        SourceDescription::Faulty(faulty) => {
            faulty::open(faulty, open(&faulty.source, tuple_size, around)?)
        }
        SourceDescription::Node(path) => around.link(path)?.clone().open(),
        SourceDescription::Iio(iio) => Ok(Device::Stream(Box::new(iio::Iio::open(
            iio,
            around.damaged.clone(),
            &around.log,
        )?))),
        SourceDescription::Pwm(pwm) => Ok(Device::State(Box::new(pwm::Pwm::open(pwm)?))),
        SourceDescription::Gpio(gpio) => Ok(Device::State(Box::new(gpio::Gpio::open(gpio)?))),
        SourceDescription::Lines(lines) => Ok(Device::Stream(Box::new(lines::Lines::open(
            lines,
            tuple_size,
            &around.programs,
            around.damaged.clone(),
        )?))),
        SourceDescription::Packets(packets) => Ok(Device::Stream(Box::new(
            packets::Packets::open(packets, tuple_size, around.damaged.clone())?,
        ))),
        SourceDescription::Newest(path) => latched::open(around.link(path)?),
        SourceDescription::Several(several) => several::open(several, around),
        SourceDescription::Program(_) => Err(Error::AccessDenied),
        SourceDescription::Regulator(regulator) => several::open(&regulator.feedback, around),
        SourceDescription::I2c(i2c) => {
            let register = i2c::Register::open(i2c, tuple_size, around.timeout_ms, &around.buses)?;
            Ok(Device::State(Box::new(register)))
        }
        SourceDescription::I2cBus(_) => Err(i2c::devices::only_device()),
        SourceDescription::Absent(reason) => Err(Error::NoDevice(reason.clone())),
    }
}

/// Opens a source for writing.
pub fn open_sink(
    source: &SourceDescription,
    around: &Surroundings,
) -> Result<Box<dyn Sink>, Error> {
    match source {
        SourceDescription::Path(path) => match kind_of(path)? {
            PathKind::Attribute => Ok(Box::new(attribute::AttributeSink::open(path, true)?)),
            PathKind::Regular => Ok(Box::new(attribute::AttributeSink::open(path, false)?)),
            PathKind::CharDevice | PathKind::SharedDevice | PathKind::Fifo => {
                Ok(Box::new(chardev::CharSink::open(path, around.timeout_ms)?))
            }
        },
        SourceDescription::Attribute(path) => {
            Ok(Box::new(attribute::AttributeSink::open(path, true)?))
        }
        SourceDescription::Fifo(path) => {
            Ok(Box::new(chardev::CharSink::open(path, around.timeout_ms)?))
        }
        SourceDescription::Node(path) => around.link(path)?.clone().open_sink(),
        SourceDescription::Faulty(faulty) => Ok(Box::new(faulty::FaultySink::new(
            faulty,
            open_sink(&faulty.source, around)?,
        ))),
        SourceDescription::Pwm(pwm) => Ok(Box::new(pwm::Pwm::open(pwm)?)),
        SourceDescription::Gpio(gpio) if gpio.direction != GpioDirection::In => {
            Ok(Box::new(gpio::Gpio::open(gpio)?))
        }
        SourceDescription::Program(command) => Ok(Box::new(program::ProgramSink::new(
            command,
            around.programs.clone(),
        ))),
        SourceDescription::Lines(lines) => Ok(Box::new(lines::LinesSink::open(
            lines,
            around.timeout_ms,
            around.answer.clone(),
        )?)),
        SourceDescription::I2c(i2c) => {
            // The size only matters for reading.
            let register = i2c::Register::open(i2c, 0, around.timeout_ms, &around.buses)?;
            Ok(Box::new(register))
        }
        SourceDescription::I2cBus(_) => Err(i2c::devices::only_device()),
        SourceDescription::Absent(reason) => Err(Error::NoDevice(reason.clone())),
        SourceDescription::Evdev(_)
        | SourceDescription::Iio(_)
        | SourceDescription::Gpio(_)
        | SourceDescription::Packets(_)
        | SourceDescription::Fake(_)
        | SourceDescription::Replay(_)
        | SourceDescription::Newest(_)
        | SourceDescription::Regulator(_)
        | SourceDescription::Several(_) => Err(Error::AccessDenied),
    }
}

/// Whether a source is a device of its own that written tuples can go to.
pub fn takes_bytes(source: &SourceDescription) -> bool {
    match source {
        SourceDescription::Path(_)
        | SourceDescription::Attribute(_)
        | SourceDescription::Fifo(_)
        | SourceDescription::I2c(_)
        | SourceDescription::Pwm(_) => true,
        SourceDescription::Gpio(gpio) => gpio.direction != GpioDirection::In,
        SourceDescription::Lines(lines) => lines.input.is_some(),
        _ => false,
    }
}

/// Whether all readers share one opening: the source gives each datum once or lets only one process in.
/// The kind of a plain path is looked up each time, because a device may appear later as something else.
pub fn is_shared(source: &SourceDescription) -> Result<bool, Error> {
    Ok(match source {
        SourceDescription::Path(path) => {
            matches!(kind_of(path)?, PathKind::Fifo | PathKind::SharedDevice)
        }
        SourceDescription::Attribute(_)
        | SourceDescription::Node(_)
        | SourceDescription::Newest(_)
        | SourceDescription::Regulator(_)
        | SourceDescription::Program(_)
        | SourceDescription::I2c(_)
        | SourceDescription::I2cBus(_)
        | SourceDescription::Absent(_)
        | SourceDescription::Pwm(_)
        | SourceDescription::Gpio(_) => false,
        SourceDescription::Fifo(_)
        | SourceDescription::Evdev(_)
        | SourceDescription::Replay(_)
        | SourceDescription::Iio(_)
        | SourceDescription::Lines(_)
        | SourceDescription::Packets(_) => true,
        SourceDescription::Fake(fake) => fake.period_ms > 0,
        SourceDescription::Faulty(faulty) => is_shared(&faulty.source)?,
        SourceDescription::Several(several) => {
            let mut shared = false;
            for part in &several.parts {
                shared |= is_shared(&part.source).map_err(|error| part_error(&part.name, error))?;
            }
            shared
        }
    })
}

/// Device paths that a description needs, for the warnings of `trikfs check`.
pub fn paths(source: &SourceDescription) -> Vec<&Path> {
    match source {
        SourceDescription::Path(path)
        | SourceDescription::Attribute(path)
        | SourceDescription::Fifo(path) => vec![path],
        SourceDescription::Evdev(evdev) => vec![&evdev.path],
        SourceDescription::I2c(i2c) => vec![&i2c.path],
        SourceDescription::I2cBus(bus) => vec![&bus.path],
        SourceDescription::Replay(replay) => vec![&replay.path],
        SourceDescription::Iio(iio) => vec![&iio.devices],
        SourceDescription::Pwm(pwm) => vec![&pwm.chip],
        SourceDescription::Gpio(gpio) => vec![&gpio.base],
        // The program makes its pipes when it is started.
        SourceDescription::Lines(lines) => match &lines.start {
            Some(start) => vec![&start.program],
            None => vec![&lines.path],
        },
        SourceDescription::Packets(packets) => vec![&packets.path],
        SourceDescription::Program(command) => vec![&command.program],
        SourceDescription::Faulty(faulty) => paths(&faulty.source),
        SourceDescription::Several(several) => {
            let parts = several.parts.iter();
            parts.flat_map(|part| paths(&part.source)).collect()
        }
        SourceDescription::Fake(_)
        | SourceDescription::Node(_)
        | SourceDescription::Regulator(_)
        | SourceDescription::Newest(_)
        | SourceDescription::Absent(_) => Vec::new(),
    }
}

/// The buses whose transfers a source waits for, itself or through nodes that it reads or drives.
pub fn add_buses(source: &SourceDescription, around: &Surroundings, buses: &mut BTreeSet<PathBuf>) {
    let mut of_node = |path: &str| {
        if let Ok(node) = around.link(path) {
            node.add_buses(buses);
        }
    };
    match source {
        SourceDescription::I2c(i2c) => {
            buses.insert(i2c.path.clone());
        }
        SourceDescription::Faulty(faulty) => add_buses(&faulty.source, around, buses),
        SourceDescription::Node(path) | SourceDescription::Newest(path) => of_node(path),
        SourceDescription::Regulator(regulator) => {
            of_node(&regulator.actuator);
            for part in &regulator.feedback.parts {
                add_buses(&part.source, around, buses);
            }
        }
        SourceDescription::Several(several) => {
            for part in &several.parts {
                add_buses(&part.source, around, buses);
            }
        }
        _ => {}
    }
}

/// What a plain path is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum PathKind {
    /// A file of sysfs, procfs or the like, whose content is made when it is read.
    Attribute,
    /// A regular file, a block device or a display: tuples at their places.
    Regular,
    /// A character device that each handle may open for itself.
    CharDevice,
    /// A terminal or input device: one queue for all readers.
    SharedDevice,
    /// A named pipe.
    Fifo,
}

/// Major numbers of Linux terminals (4, 5, 136-143, 188 USB serial, 166 ACM, 204 low-density serial) and of input (13).
/// Source: Documentation/admin-guide/devices.txt of the kernel.
const SHARED_MAJORS: [u32; 14] = [
    4, 5, 13, 136, 137, 138, 139, 140, 141, 142, 143, 166, 188, 204,
];

/// Major number of frame buffers: a picture is written from the beginning each time (the same source).
const DISPLAY_MAJOR: u32 = 29;

fn kind_of(path: &Path) -> Result<PathKind, Error> {
    let meta = std::fs::metadata(path).map_err(|error| device_error(path, &error))?;
    let kind = meta.file_type();
    if kind.is_fifo() {
        return Ok(PathKind::Fifo);
    }
    if kind.is_char_device() {
        let major = u32::try_from((meta.rdev() >> 8) & 0xfff).unwrap_or(0);
        if major == DISPLAY_MAJOR {
            return Ok(PathKind::Regular);
        }
        let shared = SHARED_MAJORS.contains(&major);
        return Ok(if shared {
            PathKind::SharedDevice
        } else {
            PathKind::CharDevice
        });
    }
    if kind.is_dir() {
        return Err(Error::NoDevice(format!(
            "{} is a directory",
            path.display()
        )));
    }
    if kind.is_socket() {
        return Err(Error::NoDevice(format!("{} is a socket", path.display())));
    }
    Ok(if attribute::is_generated(path) {
        PathKind::Attribute
    } else {
        PathKind::Regular
    })
}

fn open_path(path: &Path) -> Result<Device, Error> {
    Ok(match kind_of(path)? {
        PathKind::Attribute => Device::State(Box::new(attribute::Attribute::open(path, true)?)),
        PathKind::Regular => Device::State(Box::new(attribute::Attribute::open(path, false)?)),
        PathKind::Fifo => Device::Stream(Box::new(fifo::Fifo::open(path)?)),
        PathKind::CharDevice | PathKind::SharedDevice => {
            Device::Stream(Box::new(chardev::CharDevice::open(path)?))
        }
    })
}

/// The error of one of several sources, with its name.
fn part_error(name: &str, error: Error) -> Error {
    match error {
        Error::NoDevice(what) => Error::NoDevice(format!("source {name}: {what}")),
        other => other,
    }
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
    let what = path.display().to_string();
    match error.raw_os_error() {
        Some(libc::ENOENT | libc::ENODEV | libc::ENXIO | libc::ENOTDIR) | None => {
            Error::NoDevice(format!("{what}: {error}"))
        }
        Some(libc::EACCES | libc::EPERM | libc::EROFS) => Error::AccessDenied,
        Some(errno) => Error::Device(errno, what),
    }
}
