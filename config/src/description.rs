//! A configuration after all checks: plain typed values that the filesystem builds its tree from.
//!
//! Owns the meaning of each field of a node's description. Knows nothing of Lua and opens nothing.

mod ports;

pub use ports::{
    AnswerDescription, ByteOrder, Checksum, CommandDescription, GpioDescription, GpioDirection,
    IioDescription, LengthField, LinesDescription, PacketsDescription, PwmDescription,
};

use crate::format::Format;
use std::collections::BTreeMap;
use std::fmt;
use std::path::PathBuf;

/// Everything that a configuration describes, in the order of the paths.
#[derive(Clone, Debug, Default)]
pub struct Config {
    /// All nodes, sorted by `path`; groups exist only as parts of the paths.
    pub nodes: Vec<NodeDescription>,
    /// The global `setup`: what is done once, in this order, when the configuration comes into force.
    pub setup: Vec<SetupAction>,
    /// Second names of nodes, sorted by path.
    pub aliases: Vec<Alias>,
}

/// `{ alias = 'motors/M1' }`: the same node, with all its files, at a second place.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Alias {
    /// Where the second directory is.
    pub path: String,
    /// Path of the node.
    pub node: String,
}

/// One node of the tree.
#[derive(Clone, Debug)]
pub struct NodeDescription {
    /// Path below the mount point without a leading slash, for example `motors/M1`.
    /// For an attribute, the node's path followed by the attribute's name.
    pub path: String,
    /// Where the description stands, for messages.
    pub place: Place,
    /// Where bytes come from and go to.
    pub source: SourceDescription,
    /// Bytes of one tuple before the converter; for several sources, their sum.
    pub input_tuple_size: usize,
    /// Bytes of one tuple after the converter.
    pub output_tuple_size: usize,
    /// Stages from device to program; empty means the bytes pass unchanged.
    pub converter: Vec<StageDescription>,
    /// Stages from program to device when they differ from `converter`; then a written tuple has
    /// `output_tuple_size` bytes and the device gets `input_tuple_size`.
    pub write_converter: Option<Vec<StageDescription>>,
    /// Named fields of the converted tuple.
    pub format: Option<Format>,
    /// What the node is, in a few words, for tables and people; empty when none was given.
    pub about: String,
    /// Physical unit as the user wrote it; empty when none was given.
    pub units: String,
    /// When samples are taken.
    pub pace: Pace,
    /// The age in ms from which a sample that was taken in the background is an error; absent: as the pace has it.
    pub max_age_ms: Option<u32>,
    /// Permission bits (0o777 at most).
    pub mode: u16,
    /// Owner of the files; the mounting user when absent.
    pub owner: Option<u32>,
    /// Group of the files; the mounting user's when absent.
    pub group: Option<u32>,
    /// Values that bring the actuator to rest, written like the text of `value`.
    pub rest: Option<Vec<f64>>,
    /// A read shows the tuple that was written last while the device has the bytes that it became.
    pub read_back: bool,
    /// How long a reader of the newest value waits for the first one.
    pub timeout_ms: u32,
    /// Time that one converter call may take.
    pub budget_us: u32,
    /// Memory that one open file's Lua state may take.
    pub memory_kb: u32,
    /// Numbers that a converter can read as `params` (Lua) or at open (native).
    pub params: BTreeMap<String, f64>,
    /// Least and greatest value of those params that have a range.
    pub param_ranges: BTreeMap<String, (f64, f64)>,
    /// Further files of the node's directory; each has its own source and converter.
    pub attributes: Vec<NodeDescription>,
    /// `share` as written; absent means "by kind of source".
    pub share: Option<bool>,
    /// Equal for equal descriptions: plain fields, stripped bytecode, upvalues (attributes excluded, they have their own).
    pub fingerprint: u128,
}

impl NodeDescription {
    /// True if any stage of either direction is a Lua function.
    pub fn uses_lua(&self) -> bool {
        let lua =
            |stages: &[StageDescription]| stages.iter().any(|s| matches!(s.kind, StageKind::Lua));
        lua(&self.converter) || self.write_converter.as_deref().is_some_and(lua)
    }

    /// Bytes of a tuple before and after the conversion in the direction of writing.
    pub fn write_conversion_sizes(&self) -> (usize, usize) {
        match &self.source {
            SourceDescription::Regulator(regulator) => (
                RegulatorDescription::law_input_size(self.output_tuple_size),
                regulator.actuator_tuple_size,
            ),
            _ if self.write_converter.is_some() => (self.output_tuple_size, self.input_tuple_size),
            _ => (self.input_tuple_size, self.output_tuple_size),
        }
    }

    /// Bytes of one tuple that a program writes.
    pub fn written_tuple_size(&self) -> usize {
        if self.write_converter.is_some() {
            self.output_tuple_size
        } else {
            self.input_tuple_size
        }
    }
}

/// A line of a configuration file.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Place {
    /// File as the user named it.
    pub file: String,
    /// Line from 1.
    pub line: u32,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}:{}", self.file, self.line)
    }
}

/// When a node takes samples for its newest-value files.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pace {
    /// When somebody reads.
    OnRead,
    /// In the background, every so many milliseconds (at least 1).
    Every {
        /// Sampling period.
        period_ms: u32,
    },
    /// In the background, whenever the source has data.
    OnEvent,
}

/// What a node reads from and writes to.
#[derive(Clone, Debug, PartialEq)]
pub enum SourceDescription {
    /// A path of the system; what it is (regular file, character device, FIFO, terminal) is found out at open.
    Path(PathBuf),
    /// `attribute{ path }`: state, read afresh from offset 0, whatever the file's type says.
    Attribute(PathBuf),
    /// `fifo{ path }`: a named pipe, opened once and fanned out.
    Fifo(PathBuf),
    /// `evdev{ path }`: input events decoded and grouped up to SYN_REPORT.
    Evdev(EvdevDescription),
    /// `iio{ ... }`: a sampled sensor.
    Iio(IioDescription),
    /// `pwm{ ... }`: pulses of a PWM channel, state.
    Pwm(PwmDescription),
    /// `gpio{ ... }`: one line, state.
    Gpio(GpioDescription),
    /// `lines{ ... }`, `pictures{ ... }`: lines of text of a sensor program, or its pictures.
    Lines(LinesDescription),
    /// `packets{ ... }`: packets of a serial line.
    Packets(PacketsDescription),
    /// `fake{ ... }`: bytes that the configuration itself holds.
    Fake(FakeDescription),
    /// `i2c{ ... }`: a register of a device on an I2C bus.
    I2c(I2cDescription),
    /// `i2c_bus{ ... }`: all registers of all devices on an I2C bus, chosen by the position in the file.
    I2cBus(I2cBusDescription),
    /// `absent{ reason }`: something that this board does not have; opening it tells why.
    Absent(String),
    /// `replay{ ... }`: bytes recorded with their timing.
    Replay(ReplayDescription),
    /// `faulty{ ... }`: another source that fails on purpose.
    Faulty(FaultyDescription),
    /// `src = 'trikfs:other'`: the converted tuples of another node.
    Node(String),
    /// `src = 'newest:other'`: the newest sample of another node, which is taken by that node alone.
    Newest(String),
    /// Several sources, one converter.
    Several(SeveralDescription),
    /// `program{ run = { ... } }`: each written text is the last argument of a program that is run for it.
    Program(CommandDescription),
    /// `regulator{ feedback = ..., actuator = ... }`: what is written is held by driving another node.
    Regulator(RegulatorDescription),
}

/// Several sources: the tuples stand one after the other in the order of the parts, then the ages, then the interval.
#[derive(Clone, Debug, PartialEq)]
pub struct SeveralDescription {
    /// The sources, at least one.
    pub parts: Vec<PartDescription>,
    /// Behind the tuples stands, for each source, the age of its tuple in us as a little-endian u32, saturated.
    pub ages: bool,
    /// At the end stands the time since the tuple before in us as a little-endian u32, saturated; 0 in the first.
    pub interval: bool,
}

impl SeveralDescription {
    /// Bytes of one tuple of all sources with their times.
    pub fn tuple_size(&self) -> usize {
        let tuples: usize = self.parts.iter().map(|part| part.tuple_size).sum();
        let times = if self.ages { self.parts.len() } else { 0 } + usize::from(self.interval);
        tuples + times * size_of::<u32>()
    }
}

/// `regulator{ feedback = 'trikfs:encoder', actuator = 'trikfs:motor' }`
///
/// The converter makes the measured tuple of the feedback, and the write converter is the control law: at each sample it
/// takes what was ordered, what was measured and the time since the step before, and gives what the actuator is to do.
#[derive(Clone, Debug, PartialEq)]
pub struct RegulatorDescription {
    /// What is measured: one source, with the interval behind it.
    pub feedback: SeveralDescription,
    /// Path of the driven node.
    pub actuator: String,
    /// Bytes of one tuple that the driven node takes.
    pub actuator_tuple_size: usize,
}

impl RegulatorDescription {
    /// Bytes that the control law takes: ordered, measured, interval.
    pub fn law_input_size(output_tuple_size: usize) -> usize {
        2 * output_tuple_size + size_of::<u32>()
    }
}

/// One of several sources.
#[derive(Clone, Debug, PartialEq)]
pub struct PartDescription {
    /// Key in the table, or its position from 1.
    pub name: String,
    /// The source.
    pub source: SourceDescription,
    /// Bytes of one tuple of this source.
    pub tuple_size: usize,
    /// Its tuples make one of the node; false: only its newest is used when another source makes one.
    pub is_trigger: bool,
}

/// How kernel input events are laid out in the bytes of an evdev node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EvdevLayout {
    /// As this kernel's `struct input_event` is for this process.
    Native,
    /// 16 bytes: 32-bit time fields.
    Bits32,
    /// 24 bytes: 64-bit time fields.
    Bits64,
}

/// `evdev{ path = ..., axes = { 'ABS_X', ... } | codes... | events = true }`
///
/// Each tuple holds, for every listed code in order, its newest value as a little-endian i32; one tuple per SYN_REPORT.
#[derive(Clone, Debug, PartialEq)]
pub struct EvdevDescription {
    /// Device node, usually `/dev/input/eventN`; a FIFO or file of recorded events works as well.
    pub path: PathBuf,
    /// Watched (type, code) pairs, in the order of the tuple. Empty: each event of the device is a tuple of its own,
    /// [`EvdevDescription::EVENT_BYTES`] long.
    pub codes: Vec<(u16, u16)>,
    /// Size of one event.
    pub layout: EvdevLayout,
}

impl EvdevDescription {
    /// Type and code (u16), value (i32), microseconds of the kernel's clock (i64); little-endian.
    pub const EVENT_BYTES: usize = 16;

    /// Bytes of one tuple.
    pub fn tuple_size(&self) -> usize {
        match self.codes.len() {
            0 => Self::EVENT_BYTES,
            codes => 4 * codes,
        }
    }
}

/// `fake{ data = '...', period_ms = 10, loop = true }`
#[derive(Clone, Debug, PartialEq)]
pub struct FakeDescription {
    /// Bytes to emit, a tuple at a time.
    pub data: Vec<u8>,
    /// Milliseconds between tuples; 0 makes the bytes state: one tuple per read, in turn.
    pub period_ms: u32,
    /// Start again at the end; otherwise end of file (a stream) or the last tuple for ever (state).
    pub repeat: bool,
}

/// How the bytes of a register travel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum I2cTransfer {
    /// SMBus byte data: one byte.
    Byte,
    /// SMBus word data: two bytes, low byte first as on the wire.
    Word,
    /// I2C block data of the SMBus layer: 1 to 32 bytes.
    Block,
    /// Plain I2C messages: register bytes out, repeated start, data in; or register bytes and data out.
    Raw,
}

/// `i2c{ path = '/dev/i2c-2', address = 0x48, register = 0x25, transfer = 'word' }`
#[derive(Clone, Debug, PartialEq)]
pub struct I2cDescription {
    /// The bus: a node of i2c-dev, or the socket of a virtual bus.
    pub path: PathBuf,
    /// 7-bit address of the device.
    pub address: u16,
    /// First register of the tuple.
    pub register: u16,
    /// Bytes of the register number on the wire, 1 or 2, high byte first.
    pub register_bytes: u8,
    /// How a tuple is read.
    pub transfer: I2cTransfer,
    /// How the beginning of a tuple is written.
    pub write_transfer: I2cTransfer,
    /// False: the device cannot be read back; reading gives what was written last.
    pub readable: bool,
    /// Read once after the bus was opened, then remembered.
    pub once: bool,
}

/// `i2c_bus{ path = '/dev/i2c-2', reserved = { 0x48 } }`
#[derive(Clone, Debug, PartialEq)]
pub struct I2cBusDescription {
    /// The bus: a node of i2c-dev, or the socket of a virtual bus.
    pub path: PathBuf,
    /// Addresses of devices that belong to other nodes or to drivers: nobody reaches them through this file.
    pub reserved: Vec<u16>,
}

/// One entry of the global `setup`.
#[derive(Clone, Debug, PartialEq)]
pub struct SetupAction {
    /// Where it stands, for messages.
    pub place: Place,
    /// What to do.
    pub step: SetupStep,
    /// Nothing is done if this path exists.
    pub unless: Option<PathBuf>,
    /// How long it may take.
    pub timeout_ms: u32,
}

/// What one action of `setup` does.
#[derive(Clone, Debug, PartialEq)]
pub enum SetupStep {
    /// `{ path = ..., write = ... }`: one write(2) to a file that exists.
    Write {
        /// Usually an attribute of sysfs.
        path: PathBuf,
        /// What is written.
        bytes: Vec<u8>,
    },
    /// `{ run = { '/sbin/modprobe', 'hcsr04' } }`: a program that must end with 0.
    Run {
        /// Absolute path of the program.
        program: PathBuf,
        /// Its arguments.
        arguments: Vec<String>,
    },
    /// `{ to = i2c{ ... }, write = ... }`: one tuple to a source that takes writes.
    Send {
        /// Where to.
        to: SourceDescription,
        /// The tuple.
        bytes: Vec<u8>,
    },
}

/// `replay{ path = 'run.rec', speed = 1, loop = false }`
///
/// Lines `TIME_MS HEX`, time from the start, not decreasing; `#` starts a comment.
#[derive(Clone, Debug, PartialEq)]
pub struct ReplayDescription {
    /// The recording, resolved like an include.
    pub path: PathBuf,
    /// Time factor, above 0.
    pub speed: f64,
    /// Start again at the end.
    pub repeat: bool,
}

/// `faulty{ src = ..., fail = 'EIO', from = 3, count = 1 }`
#[derive(Clone, Debug, PartialEq)]
pub struct FaultyDescription {
    /// What works in between.
    pub source: Box<SourceDescription>,
    /// Linux error number returned by the failing reads; 0 makes them end of file.
    pub errno: i32,
    /// First read that fails, from 1.
    pub from: u32,
    /// How many reads fail; 0 means all that follow.
    pub count: u32,
    /// Every read gives at most this many bytes; 0 means no limit.
    pub short: usize,
}

/// One stage of a chain of converters.
#[derive(Clone, Debug, PartialEq)]
pub struct StageDescription {
    /// Code of the stage.
    pub kind: StageKind,
    /// Bytes of the tuple it takes.
    pub input_size: usize,
    /// Bytes of the tuple it gives.
    pub output_size: usize,
    /// Where it stands, for messages.
    pub place: Place,
}

/// The code of one stage.
#[derive(Clone, Debug, PartialEq)]
pub enum StageKind {
    /// A Lua function; found again in another state by node path, direction and position in the chain.
    Lua,
    /// A shared library.
    Library {
        /// Absolute path of a file that exists, or as written when `missing`.
        path: PathBuf,
        /// Converter inside a library of several; absent for a library with one.
        name: Option<String>,
    },
    /// C source compiled on this machine.
    InlineC {
        /// The source text.
        code: String,
    },
}
