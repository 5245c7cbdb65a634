//! Errors of the filesystem, who is to blame for each, and the one table that turns them into errno.
//!
//! Nothing else in this crate chooses an errno for an outcome of its own; a device's own errno passes through here. Failures
//! of commands and processes, which no program gets as an errno, are in `failure`.

use converter::Fault;
use std::fmt;
use std::io;
use std::path::Path;

/// The person or the part that can mend it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Blame {
    /// The program that called.
    Caller,
    /// The device or its wiring.
    Device,
    /// The converter's code or its data.
    Converter,
    /// The computer: its kernel, its memory, its limits.
    System,
    /// This filesystem.
    Ours,
}

impl fmt::Display for Blame {
    /// The first word of a `fault`.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Caller => "caller",
            Self::Device => "device",
            Self::Converter => "converter",
            Self::System => "system",
            Self::Ours => "filesystem",
        })
    }
}

/// Why an operation failed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Error {
    /// No such name.
    NotFound,
    /// A path component is not a directory.
    NotADirectory,
    /// The operation needs a file.
    IsADirectory,
    /// Writing a sensor, or reading a file that can only be written.
    AccessDenied,
    /// A device that cannot be reached from here, because others have it.
    Reserved(String),
    /// Text or bytes that mean nothing here.
    Invalid(String),
    /// A number that does not fit its field.
    OutOfRange(String),
    /// Nothing is plugged in, or it was unplugged.
    NoDevice(String),
    /// No sample yet, and the caller does not wait.
    WouldBlock,
    /// No sample, and none on its way: the source has said nothing since it was opened.
    Silent,
    /// No sample within the deadline, or the newest one is too old.
    TimedOut(String),
    /// Another program holds the lease of the actuator, or as many texts wait for a program as may.
    Busy(String),
    /// A line for a sensor program that runs while somebody reads it, and nobody does.
    NotRunning(String),
    /// The device failed with an errno of its own.
    Device(i32, String),
    /// An earlier operation has been in the device or the converter for so long that it will hardly return.
    Quarantined {
        /// How long.
        for_ms: u32,
    },
    /// More operations want the device than may wait for it.
    Crowded(String),
    /// What the device gives does not have the form that it must have.
    Malformed(String),
    /// The device answers, and what it says is no measurement: a converter has seen that.
    Measurement(String),
    /// What a recording has instead of a sample: this errno. The source itself is well, and goes on.
    Recorded(i32, String),
    /// The converter failed.
    Converter(String),
    /// The system refuses what a converter needs to run, such as a process.
    System(String),
    /// The open file belongs to a node that a reload changed or removed.
    Stale,
    /// Too many open files; whose, and how many are allowed.
    TooManyOpen(String),
    /// The open files of a user hold as much memory as they may.
    NoMemory(String),
    /// A queue or buffer is full.
    NoBuffers,
    /// More bytes than the file can take.
    TooLarge,
    /// The waiting caller got a signal.
    Interrupted,
    /// The filesystem is going away.
    ShuttingDown,
    /// An operation this filesystem does not have, and never will (rename, mkdir, chmod...).
    NotPermitted,
    /// An operation this filesystem does not have.
    Unsupported,
    /// No such extended attribute.
    NoAttribute,
    /// The caller's buffer is too small for the extended attribute.
    BufferTooSmall,
    /// An ioctl(2): what a regular file answers; kernels before 6.0 would show the program an ENOSYS.
    NoControl,
    /// A request of the kernel that it need not send again: it does without.
    NotNeeded,
    /// The kernel speaks a version of its protocol that is too old.
    OldKernel,
    /// A fault of our own; the text is for the log.
    Internal(String),
}

/// The first word of what a converter says, if it blames somebody else than itself.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlameWord {
    /// The caller: a number outside the range.
    OutOfRange,
    /// The caller: bytes without a meaning.
    Invalid,
    /// The device has gone.
    NoDevice,
    /// The device does not answer.
    TimedOut,
    /// The device gives nonsense.
    Measurement,
}

impl BlameWord {
    const ALL: [Self; 5] = [
        Self::OutOfRange,
        Self::Invalid,
        Self::NoDevice,
        Self::TimedOut,
        Self::Measurement,
    ];

    /// As a converter writes it, with what divides it from the reason.
    pub fn text(self) -> &'static str {
        match self {
            Self::OutOfRange => "ERANGE: ",
            Self::Invalid => "EINVAL: ",
            Self::NoDevice => "ENODEV: ",
            Self::TimedOut => "ETIMEDOUT: ",
            Self::Measurement => "EIO: ",
        }
    }
}

/// What a converter says, as whom it blames, if not itself, and the reason.
pub fn blame_and_reason(text: &str) -> (Option<BlameWord>, &str) {
    BlameWord::ALL
        .into_iter()
        .find_map(|word| Some((Some(word), text.strip_prefix(word.text())?)))
        .unwrap_or((None, text))
}

impl Error {
    /// What a converter said. A first word tells who is to blame when it is not the converter: `ERANGE: `, `EINVAL: `
    /// the caller, `ENODEV: `, `ETIMEDOUT: `, `EIO: ` the device. See docs/user/config.md.
    pub fn of_converter(fault: &Fault) -> Self {
        let (word, rest) = blame_and_reason(fault.text());
        let reason = rest.to_owned();
        match word {
            Some(BlameWord::OutOfRange) => Self::OutOfRange(reason),
            Some(BlameWord::Invalid) => Self::Invalid(reason),
            Some(BlameWord::NoDevice) => Self::NoDevice(reason),
            Some(BlameWord::TimedOut) => Self::TimedOut(reason),
            Some(BlameWord::Measurement) => Self::Measurement(reason),
            None => Self::Converter(reason),
        }
    }

    /// A fault of a converter on the way from the device: there is no caller that could have written better.
    pub fn of_reading(self) -> Self {
        match self {
            Self::Invalid(text) | Self::OutOfRange(text) => Self::Converter(text),
            other => other,
        }
    }

    /// An I/O error of the device at this path.
    pub fn of_device(path: &Path, error: &io::Error) -> Self {
        let what = path.display().to_string();
        match error.raw_os_error() {
            Some(libc::ENOENT | libc::ENODEV | libc::ENXIO | libc::ENOTDIR) | None => {
                Self::NoDevice(format!("{what}: {error}"))
            }
            Some(libc::EACCES | libc::EPERM | libc::EROFS) => Self::AccessDenied,
            Some(errno) => Self::Device(errno, what),
        }
    }

    /// An error of the system in something that a device needs, such as epoll.
    pub fn of_system(what: impl Into<String>, error: &io::Error) -> Self {
        Self::Device(error.raw_os_error().unwrap_or(libc::EIO), what.into())
    }

    /// What a device fails with that has this errno.
    pub fn of_number(what: String, errno: i32) -> Self {
        match errno {
            libc::ENODEV | libc::ENXIO => Self::NoDevice(what),
            errno => Self::Device(errno, what),
        }
    }

    /// Nobody acknowledges at an address of a bus.
    pub fn no_answer(what: String) -> Self {
        Self::Device(libc::EREMOTEIO, what)
    }

    /// A transfer that the bus of a device cannot carry.
    pub fn unfit_transfer(what: String) -> Self {
        Self::Device(libc::EINVAL, what)
    }

    /// An answer that is against the protocol.
    pub fn against_protocol(what: String) -> Self {
        Self::Device(libc::EPROTO, what)
    }

    /// The number that the program sees.
    pub fn errno(&self) -> i32 {
        match self {
            Self::NotFound => libc::ENOENT,
            Self::NotADirectory => libc::ENOTDIR,
            Self::IsADirectory => libc::EISDIR,
            Self::AccessDenied | Self::Reserved(_) => libc::EACCES,
            Self::Invalid(_) => libc::EINVAL,
            Self::OutOfRange(_) => libc::ERANGE,
            Self::NoDevice(_) => libc::ENODEV,
            Self::WouldBlock => libc::EAGAIN,
            Self::Silent => libc::ENODATA,
            Self::TimedOut(_) => libc::ETIMEDOUT,
            Self::Busy(_) => libc::EBUSY,
            Self::NotRunning(_) => libc::ENODEV,
            Self::Device(errno, _) => device_errno(*errno),
            Self::Quarantined { .. } => libc::EIO,
            Self::Crowded(_) => libc::EBUSY,
            Self::Malformed(_) => libc::EIO,
            Self::Measurement(_) => libc::EIO,
            Self::Recorded(errno, _) => *errno,
            Self::Converter(_) => libc::EIO,
            Self::System(_) => libc::EIO,
            Self::Stale => libc::ESTALE,
            Self::TooManyOpen(_) => libc::EMFILE,
            Self::NoMemory(_) => libc::ENOMEM,
            Self::NoBuffers => libc::ENOBUFS,
            Self::TooLarge => libc::EFBIG,
            Self::Interrupted => libc::EINTR,
            Self::ShuttingDown => libc::ENODEV,
            Self::NotPermitted => libc::EPERM,
            Self::Unsupported => libc::EOPNOTSUPP,
            Self::NoAttribute => libc::ENODATA,
            Self::BufferTooSmall => libc::ERANGE,
            Self::NoControl => libc::ENOTTY,
            Self::NotNeeded => libc::ENOSYS,
            Self::OldKernel => libc::EPROTO,
            Self::Internal(_) => libc::EIO,
        }
    }

    /// The device has too much to do at the moment: trying again later may help.
    pub fn is_busy_device(&self) -> bool {
        matches!(self, Self::Crowded(_) | Self::Device(libc::EBUSY, _))
    }

    /// The device is not there, as the program sees it: it may come back.
    pub fn is_gone(&self) -> bool {
        self.errno() == libc::ENODEV && !matches!(self, Self::Recorded(..))
    }

    /// The person or the part that can mend it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::NotFound
            | Self::NotADirectory
            | Self::IsADirectory
            | Self::AccessDenied
            | Self::Reserved(_)
            | Self::Invalid(_)
            | Self::OutOfRange(_)
            | Self::WouldBlock
            | Self::Silent
            | Self::Busy(_)
            | Self::NotRunning(_)
            | Self::Stale
            | Self::TooManyOpen(_)
            | Self::NoMemory(_)
            | Self::NoBuffers
            | Self::TooLarge
            | Self::Interrupted
            | Self::ShuttingDown
            | Self::NotPermitted
            | Self::Unsupported
            | Self::NoAttribute
            | Self::BufferTooSmall
            | Self::NoControl
            | Self::NotNeeded
            | Self::OldKernel => Blame::Caller,
            Self::NoDevice(_)
            | Self::TimedOut(_)
            | Self::Device(..)
            | Self::Quarantined { .. }
            | Self::Crowded(_)
            | Self::Malformed(_)
            | Self::Measurement(_)
            | Self::Recorded(..) => Blame::Device,
            Self::Converter(_) => Blame::Converter,
            Self::System(_) => Blame::System,
            Self::Internal(_) => Blame::Ours,
        }
    }
}

/// What a program sees of a device's own errno: an unplugged device is ENODEV whatever its driver said,
/// a refused permission stays one, and everything else is a failed transfer.
fn device_errno(errno: i32) -> i32 {
    match errno {
        libc::ENODEV | libc::ENXIO | libc::ENOENT => libc::ENODEV,
        libc::EACCES | libc::EPERM | libc::EROFS => libc::EACCES,
        libc::EINVAL => libc::EINVAL,
        libc::ERANGE => libc::ERANGE,
        libc::EBUSY => libc::EBUSY,
        libc::EMFILE | libc::ENFILE => libc::EMFILE,
        _ => libc::EIO,
    }
}

/// A text with what the system says to a number.
fn with_number(f: &mut fmt::Formatter<'_>, what: &str, errno: i32) -> fmt::Result {
    write!(f, "{what}: {}", std::io::Error::from_raw_os_error(errno))
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotFound => f.write_str("no such name"),
            Self::NotADirectory => f.write_str("not a directory"),
            Self::IsADirectory => f.write_str("is a directory"),
            Self::AccessDenied => f.write_str("the file cannot be opened that way"),
            Self::Invalid(what)
            | Self::Reserved(what)
            | Self::OutOfRange(what)
            | Self::NoDevice(what)
            | Self::TimedOut(what)
            | Self::Busy(what)
            | Self::NotRunning(what)
            | Self::Measurement(what)
            | Self::Recorded(_, what)
            | Self::Converter(what)
            | Self::System(what)
            | Self::Internal(what) => f.write_str(what),
            Self::WouldBlock => f.write_str("no sample yet"),
            Self::Silent => f.write_str(
                "nothing has come from the source since it was opened; poll this file, or read device, to wait for it",
            ),
            Self::Device(errno, what) => with_number(f, what, *errno),
            Self::Quarantined { for_ms } => {
                let what =
                    format!("quarantined: an earlier operation has not returned for {for_ms} ms");
                with_number(f, &what, libc::EIO)
            }
            Self::Crowded(what) => with_number(f, what, libc::EBUSY),
            Self::Malformed(what) => with_number(f, what, libc::EIO),
            Self::Stale => f.write_str("the node was changed or removed since the file was opened"),
            Self::TooManyOpen(why) => write!(f, "too many open files: {why}"),
            Self::NoMemory(why) => write!(f, "too much memory: {why}"),
            Self::NoBuffers => f.write_str("a queue is full"),
            Self::TooLarge => f.write_str("more bytes than the file can take"),
            Self::Interrupted => f.write_str("interrupted"),
            Self::ShuttingDown => f.write_str("the filesystem is stopping"),
            Self::NotPermitted | Self::Unsupported | Self::NoControl | Self::NotNeeded => {
                f.write_str("this filesystem has no such operation")
            }
            Self::OldKernel => f.write_str("the kernel's protocol is too old"),
            Self::NoAttribute => f.write_str("no such extended attribute"),
            Self::BufferTooSmall => f.write_str("the buffer is too small"),
        }
    }
}

impl std::error::Error for Error {}
