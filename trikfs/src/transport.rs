//! The border to the kernel: what a transport asks of the filesystem and what it does for it.
//!
//! A transport unpacks a request, calls the operation of the same name and sends the reply; it knows
//! no node, no converter and no device. The filesystem knows no opcode, no flag bit and no crate of FUSE.
//! Two transports implement this: [`native`] and, as a cargo feature, [`fuser`](self).

#[cfg(feature = "fuser")]
pub mod fuser;
pub mod native;
pub mod null;

use crate::errno::Error;
use std::sync::Arc;
use std::time::{Duration, SystemTime};

/// Names one request of the kernel for as long as it is unanswered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct RequestId(pub u64);

/// The kernel's name for a program that polls an open file; valid until that file is released.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct PollHandle(pub u64);

/// The process that asks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Caller {
    /// Effective user.
    pub uid: u32,
    /// Effective group.
    pub gid: u32,
    /// Thread id of the caller as this process sees it; 0 if it cannot be seen.
    pub pid: u32,
}

/// What a directory entry is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FileKind {
    /// A directory.
    Directory,
    /// A regular file.
    File,
}

/// Attributes of one file. `nlink`, block counts and the like follow from these.
#[derive(Clone, Copy, Debug)]
pub struct Attr {
    /// Node id, also shown as the inode number.
    pub ino: u64,
    /// Directory or file.
    pub kind: FileKind,
    /// Bytes that `stat` shows.
    pub size: u64,
    /// Permission bits.
    pub mode: u16,
    /// Owner.
    pub uid: u32,
    /// Group.
    pub gid: u32,
    /// Time of the newest sample or change; shown as mtime, ctime and atime.
    pub modified: SystemTime,
    /// How long the kernel may keep these attributes.
    pub attr_ttl: Duration,
    /// How long the kernel may keep the name.
    pub entry_ttl: Duration,
}

/// How the kernel is to treat an open file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Access {
    /// Every read and write comes to us; the file position works.
    Direct,
    /// Every read and write comes to us; no position, so a waiting read does not block a write (`lseek` gives ESPIPE).
    Stream,
    /// Reads are served from the page cache, which [`Kernel::store`] fills.
    Cached,
}

/// Answer to `open`.
#[derive(Clone, Copy, Debug)]
pub struct Opened {
    /// Our number for the open file, given back with each of its requests.
    pub fh: u64,
    /// Treatment by the kernel.
    pub access: Access,
    /// Whether `close` has to be told (FLUSH): only files whose close can fail.
    pub flush: bool,
}

/// Answer to an operation that may have to wait.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Outcome {
    /// Done; so many bytes are in the reply buffer, or were taken.
    Done(usize),
    /// The filesystem keeps the request and answers it later through [`Kernel::answer`],
    /// perhaps before this value reaches the transport.
    Wait,
}

/// A read or write of an open file.
#[derive(Clone, Copy, Debug)]
pub struct Transfer {
    /// The request, for a later answer.
    pub id: RequestId,
    /// File.
    pub ino: u64,
    /// Open file.
    pub fh: u64,
    /// Position; meaningless for [`Access::Stream`].
    pub offset: u64,
    /// O_NONBLOCK is set on the open file now.
    pub nonblocking: bool,
    /// O_APPEND is set on the open file now.
    pub append: bool,
    /// The kernel reads for its page cache (splice, sendfile, a mapping), not for a read(2) of a program.
    pub paged: bool,
    /// The process that asks.
    pub caller: Caller,
}

/// One entry of a directory, in the order of the tree.
#[derive(Clone, Debug)]
pub struct DirEntry<'a> {
    /// Node id.
    pub ino: u64,
    /// Kind.
    pub kind: FileKind,
    /// Name.
    pub name: &'a str,
    /// Position to continue after this entry.
    pub next: u64,
}

/// Answer to `statfs`.
#[derive(Clone, Copy, Debug)]
pub struct StatFs {
    /// Files in the tree.
    pub files: u64,
    /// Longest name in bytes.
    pub name_max: u32,
}

/// The operations of the filesystem. Called from any number of threads at once; none waits for a device
/// unless it says so, and a transport must go on serving when one takes long (see `crew.rs`).
pub trait Operations: Send + Sync {
    /// The mount is live: from here on `kernel` may be used.
    fn start(&self, kernel: Arc<dyn Kernel>);
    /// Finds `name` in a directory.
    fn lookup(&self, parent: u64, name: &[u8]) -> Result<Attr, Error>;
    /// Attributes of a file.
    fn getattr(&self, ino: u64) -> Result<Attr, Error>;
    /// Changes attributes: only `size` can be changed, everything else is refused (`other`).
    fn setattr(
        &self,
        ino: u64,
        fh: Option<u64>,
        size: Option<u64>,
        other: bool,
    ) -> Result<Attr, Error>;
    /// Lists a directory from position `from`, until `add` returns false (the buffer is full).
    fn readdir(
        &self,
        ino: u64,
        from: u64,
        add: &mut dyn FnMut(DirEntry<'_>) -> bool,
    ) -> Result<(), Error>;
    /// Opens a file; `flags` are those of open(2), with O_TRUNC.
    fn open(&self, ino: u64, flags: i32, caller: Caller) -> Result<Opened, Error>;
    /// Reads into `out`, which is as long as the request asks for.
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error>;
    /// Writes `data`.
    fn write(&self, request: &Transfer, data: &[u8]) -> Result<Outcome, Error>;
    /// Which of the POLL* bits in `events` hold now. Keeps `handle` until release, and from then on
    /// calls [`Kernel::notify_poll`] whenever one may have come to hold.
    fn poll(&self, ino: u64, fh: u64, handle: PollHandle, events: u32) -> Result<u32, Error>;
    /// A descriptor of the open file was closed.
    fn flush(&self, id: RequestId, ino: u64, fh: u64, caller: Caller) -> Result<Outcome, Error>;
    /// fsync(2) of the open file.
    fn fsync(&self, id: RequestId, ino: u64, fh: u64, caller: Caller) -> Result<Outcome, Error>;
    /// The last descriptor of the open file was closed; `fh` is not used again.
    fn release(&self, ino: u64, fh: u64);
    /// The caller of an unanswered request got a signal. True if the request was waiting here and has been
    /// answered now (EINTR); false if it is not known (answered already, or still inside an operation).
    fn interrupt(&self, id: RequestId) -> bool;
    /// Value of an extended attribute.
    fn getxattr(&self, ino: u64, name: &[u8]) -> Result<Vec<u8>, Error>;
    /// Names of the extended attributes, each followed by a zero byte.
    fn listxattr(&self, ino: u64) -> Result<Vec<u8>, Error>;
    /// Size of the filesystem.
    fn statfs(&self) -> StatFs;
    /// The mount is gone; nothing can be answered any more.
    fn stop(&self);
}

/// What a transport does for the filesystem, from any thread.
///
/// None of these may be called while holding a lock that an operation takes, and [`store`](Self::store) and
/// [`invalidate`](Self::invalidate) never from inside an operation: the kernel holds the page during a READ.
pub trait Kernel: Send + Sync {
    /// Answers a request for which an operation returned [`Outcome::Wait`]. Data for a read; for a write the
    /// number of bytes taken is `written`; both empty for flush and fsync.
    fn answer(&self, id: RequestId, result: Result<Answer<'_>, Error>);
    /// Wakes the programs that poll this open file.
    fn notify_poll(&self, handle: PollHandle);
    /// Puts the file's newest bytes into the page cache at offset 0. True if the kernel took them.
    fn store(&self, ino: u64, data: &[u8]) -> bool;
    /// Drops the file's cached bytes and attributes.
    fn invalidate(&self, ino: u64);
    /// Drops a cached name of a directory.
    fn invalidate_entry(&self, parent: u64, name: &str);
    /// True if [`Access::Cached`] with `store` works on this mount.
    fn can_store(&self) -> bool;
}

/// A late answer.
#[derive(Clone, Copy, Debug)]
pub enum Answer<'a> {
    /// Bytes for a read.
    Data(&'a [u8]),
    /// Bytes taken by a write.
    Written(usize),
    /// Nothing to say but success.
    Empty,
}
