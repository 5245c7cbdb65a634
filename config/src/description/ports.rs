//! Descriptions of the kinds of ports that need more than one path: sampled sensors, PWM, GPIO, sensor programs, serial
//! packets.
//!
//! Owns the meaning of their fields. Paths are whole already: nothing has to be put in front of them. Opens nothing.

use std::path::PathBuf;

/// `iio{ name = ..., channels = {...} }`: a device of Linux IIO that is sampled into a buffer.
///
/// A tuple holds each channel in the order listed as a little-endian i32, a timestamp as i64. With several names it
/// begins with an i32: the position from 1 of the name that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct IioDescription {
    /// Where the devices are described, `/sys/bus/iio/devices`.
    pub devices: PathBuf,
    /// Where their nodes are, `/dev`.
    pub nodes: PathBuf,
    /// Names that the device may have; the first that is found counts.
    pub names: Vec<String>,
    /// The tuple begins with the position of the name.
    pub gives_position: bool,
    /// Names of scan elements without `in_`, for example `accel_x`.
    pub channels: Vec<String>,
    /// Samples per second to ask for.
    pub sampling_frequency: Option<f64>,
}

impl IioDescription {
    /// Bytes of one tuple.
    pub fn tuple_size(&self) -> usize {
        let channels: usize = self
            .channels
            .iter()
            .map(|channel| Self::value_size(channel))
            .sum();
        channels + if self.gives_position { 4 } else { 0 }
    }

    /// Bytes of one channel in the tuple.
    pub fn value_size(channel: &str) -> usize {
        if channel == "timestamp" { 8 } else { 4 }
    }
}

/// `pwm{ chip = ..., channel = 0, period_ns = ... }`: a tuple is the pulse in ns as a little-endian u32.
#[derive(Clone, Debug, PartialEq)]
pub struct PwmDescription {
    /// Directory of the chip, `/sys/class/pwm/pwmchipN`.
    pub chip: PathBuf,
    /// Number within the chip.
    pub channel: u32,
    /// Nanoseconds from pulse to pulse.
    pub period_ns: u32,
}

/// Which way a GPIO line goes, in the words of its `direction` file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GpioDirection {
    /// Read only.
    In,
    /// Written; low at first.
    Out,
    /// Written; high at first.
    High,
    /// Written; low at first.
    Low,
}

/// `gpio{ number = 56, direction = 'in' }`: a tuple is one byte, 0 or 1.
#[derive(Clone, Debug, PartialEq)]
pub struct GpioDescription {
    /// Where lines are exported, `/sys/class/gpio`.
    pub base: PathBuf,
    /// Number of the line.
    pub number: u32,
    /// Which way it goes.
    pub direction: GpioDirection,
    /// 1 stands for the low level.
    pub active_low: bool,
}

/// `lines{ path = ..., input = ..., start = {...}, stop = {...} }`: lines of text from a program's named pipe.
///
/// A tuple is one line without its end, filled up with zero bytes.
#[derive(Clone, Debug, PartialEq)]
pub struct LinesDescription {
    /// The pipe that the program writes to.
    pub path: PathBuf,
    /// The pipe that it reads from.
    pub input: Option<PathBuf>,
    /// Starts the program: an absolute path and arguments.
    pub start: Option<CommandDescription>,
    /// Stops it.
    pub stop: Option<CommandDescription>,
    /// What is kept for those who come later.
    pub answer: Option<AnswerDescription>,
    /// `pictures{ ... }`: the pipe gives JPEG pictures, one behind the other, and no lines.
    pub are_pictures: bool,
}

/// A line to a sensor program that asks for one line from it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct AnswerDescription {
    /// The line that asks.
    pub question: String,
    /// What the line that answers begins with.
    pub answer: String,
}

/// A program to run, without a shell.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct CommandDescription {
    /// The program.
    pub program: PathBuf,
    /// What follows it.
    pub arguments: Vec<String>,
}

/// How the bytes of a number follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// The highest first.
    Big,
    /// The lowest first.
    Little,
}

/// What the end of a packet is checked with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checksum {
    /// Nothing.
    None,
    /// One byte: the sum of all bytes before it.
    Sum8,
    /// Two bytes in the packet's order: the sum of all bytes before them.
    Sum16,
    /// One byte: all bytes before it, exclusive-or.
    Xor8,
}

impl Checksum {
    /// Bytes at the end of a packet.
    pub fn size(self) -> usize {
        match self {
            Self::None => 0,
            Self::Sum8 | Self::Xor8 => 1,
            Self::Sum16 => 2,
        }
    }
}

/// Where a packet tells its length. The whole packet has that number and `add` bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthField {
    /// Position in the packet.
    pub at: usize,
    /// Bytes of the number, 1 or 2.
    pub bytes: usize,
    /// What the number leaves out.
    pub add: i32,
}

/// `packets{ path = ..., start = ..., length = {...} }`: checked packets of a serial line, one for each tuple.
#[derive(Clone, Debug, PartialEq)]
pub struct PacketsDescription {
    /// Terminal, FIFO or file.
    pub path: PathBuf,
    /// Bits per second of a terminal; as it is if absent.
    pub baud: Option<u32>,
    /// What each packet begins with.
    pub start: Vec<u8>,
    /// Where its length is.
    pub length: LengthField,
    /// Of the length and of the checksum.
    pub order: ByteOrder,
    /// What its end is checked with.
    pub checksum: Checksum,
}

impl PacketsDescription {
    /// Bytes that tell the length of a packet.
    pub fn head_size(&self) -> usize {
        self.start.len().max(self.length.at + self.length.bytes)
    }

    /// The shortest packet that can be.
    pub fn size_min(&self) -> usize {
        self.head_size() + self.checksum.size()
    }
}
