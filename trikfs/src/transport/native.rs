//! The native transport: requests read from /dev/fuse, answers written to it, nothing between.
//!
//! Owns the session: INIT, the loop, interrupts, the end. Its parts know the protocol: `abi` the numbers, `decode` and
//! `encode` the layouts, `negotiate` the versions, `perform` the operations, `link` the descriptor, `received` how it
//! comes from a helper. Knows nothing of what a file contains.
//!
//! One thread at a time reads the device. Operations run on it, in line, because a hop to another thread costs as
//! much as the rest of a read; when one lasts longer than a millisecond another thread of the crew reads on, and the
//! late one answers its own request. A read allocates nothing: the operation writes after the header of the answer.
//!
//! # Interrupts
//! The kernel sends INTERRUPT once, and only after the request itself has been read completely. A request is in one of
//! three places, in this order: *inside* an operation (its number stands in the slot of its thread), *parked* in the
//! filesystem (the operation returned `Wait`), *answered*. `Shared::interrupt` asks the filesystem, then the slots, then
//! the filesystem again, so a request that moves from inside to parked meanwhile is found in the third step, and one
//! that is found nowhere has been answered or is being answered by a thread that took it out of its slot.
//! It cannot be that a request was read but stands in no slot yet: another thread reads the device only after the first
//! one has lost the role, which happens between `Seat::begin` and `Seat::end`, after the slot was filled. So no
//! INTERRUPT needs to be sent back (EAGAIN) for a second try.
//! The side that takes the number out of the slot answers: the interrupter with EINTR, or the thread with its result. A result
//! that came too late is undone as far as it can be: a file that was opened is released, a request that was parked is
//! interrupted there. FLUSH and FSYNC are not answered over the head of their operation: their verdict must not be lost.

mod abi;
mod decode;
mod encode;
mod link;
mod negotiate;
mod perform;
pub mod received;

pub use encode::invalidate_message;
pub(crate) use negotiate::Features;

use crate::crew::{Crew, Seat, Urgency};
use crate::errno::Error;
use crate::limits::{MAX_THREADS, TRANSFER_BYTES_MAX};
use crate::transport::null::NullFs;
use crate::transport::{Kernel, Operations, RequestId};
use decode::{Body, Header, KernelInit, Malformed, Request};
use link::{Delivery, Link, report};
use negotiate::{Negotiated, negotiate};
use nix::errno::Errno;
use perform::{Performed, perform};
use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Write};
use std::ops::ControlFlow;
use std::os::fd::OwnedFd;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, OnceLock, PoisonError};

/// Bytes of the buffer for a request: the largest write with its headers, rounded up to a page.
const REQUEST_BYTES: usize = TRANSFER_BYTES_MAX + 4096;
const _: () = assert!(REQUEST_BYTES >= TRANSFER_BYTES_MAX + abi::IN_HEADER + abi::WRITE_IN);
/// Alignment of the request buffer, so that the kernel fills whole pages of it.
const PAGE_BYTES: usize = 4096;

/// What tests and odd kernels may want changed.
#[derive(Clone, Copy, Debug)]
pub struct SessionOptions {
    /// Newest minor version of the protocol to use; everything newer is left off even if the kernel has it.
    pub minor_max: u32,
    /// Feature bits of INIT to treat as not offered.
    pub withhold: u64,
}

impl Default for SessionOptions {
    /// Everything that is known here.
    fn default() -> Self {
        Self {
            minor_max: abi::MINOR,
            withhold: 0,
        }
    }
}

/// One mount, served.
pub struct Session {
    shared: Arc<Shared>,
    /// Set by `serve`.
    crew: OnceLock<Crew>,
}

/// Serves a mount until it is gone; see [`Session::serve`].
///
/// # Errors
/// As [`Session::serve`].
pub fn serve(device: OwnedFd, operations: Arc<dyn Operations>) -> io::Result<()> {
    Session::new(device, operations, SessionOptions::default()).serve()
}

/// What the threads of a session share.
struct Shared {
    link: Arc<Link>,
    operations: Arc<dyn Operations>,
    options: SessionOptions,
    /// Set by INIT.
    features: OnceLock<Features>,
    /// The slots of all threads.
    slots: Mutex<Vec<Arc<Slot>>>,
    /// Nodes of open files, each with how often it is open: the kernel is sure to know them.
    open: Mutex<BTreeMap<u64, u32>>,
    stopping: AtomicBool,
    /// Why the loop ended, if not by an unmount.
    failure: Mutex<Option<io::Error>>,
}

/// The request that a thread has inside an operation and that may be answered over its head.
#[derive(Default)]
struct Slot(Mutex<Option<u64>>);

impl Slot {
    fn lock(&self) -> MutexGuard<'_, Option<u64>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Takes this request out. True for one of the two that try.
    fn take(&self, unique: u64) -> bool {
        let mut slot = self.lock();
        let found = *slot == Some(unique);
        if found {
            *slot = None;
        }
        found
    }
}

impl Session {
    /// A session on an open /dev/fuse that has been mounted. Nothing is read before [`serve`](Self::serve).
    pub fn new(device: OwnedFd, operations: Arc<dyn Operations>, options: SessionOptions) -> Self {
        Self::over(Link::new(device), operations, options)
    }

    fn over(link: Link, operations: Arc<dyn Operations>, options: SessionOptions) -> Self {
        Self {
            shared: Arc::new(Shared {
                link: Arc::new(link),
                operations,
                options,
                features: OnceLock::new(),
                slots: Mutex::default(),
                open: Mutex::default(),
                stopping: AtomicBool::new(false),
                failure: Mutex::default(),
            }),
            crew: OnceLock::new(),
        }
    }

    /// Serves until the mount is gone or [`stop`](Self::stop) is called, then tells the filesystem. To be called once.
    /// Operations that are still running are not waited for.
    ///
    /// The mount is gone when it was unmounted and no file of it is open any more, or when its connection was aborted
    /// (/sys/fs/fuse/connections). After a lazy unmount of a busy mount, `stop` ends it.
    ///
    /// # Errors
    /// If the device cannot be read for longer than [`KERNEL_PATIENCE`](crate::limits::KERNEL_PATIENCE), or the kernel is too
    /// old (before 4.14).
    pub fn serve(&self) -> io::Result<()> {
        let shared = Arc::clone(&self.shared);
        let crew = Crew::run_each("fuse", MAX_THREADS, Urgency::Awaited, move || {
            let mut worker = Worker::new(Arc::clone(&shared));
            Box::new(move |seat| worker.cycle(seat))
        })?;
        self.crew.get_or_init(|| crew.clone());
        crew.wait();
        self.shared.operations.stop();
        let mut failure = self
            .shared
            .failure
            .lock()
            .unwrap_or_else(PoisonError::into_inner);
        failure.take().map_or(Ok(()), Err)
    }

    /// Makes [`serve`](Self::serve) return soon, from any thread, while the mount stays: for a busy mount that was
    /// detached. When the descriptor is closed with the session and the last [`Kernel`] of it, programs get ENOTCONN
    /// from the mount, and all requests that wait in it are ended.
    ///
    /// Works while some file is open. On newer kernels (6.18) a mount that is kept busy by a working directory alone
    /// goes on until the process ends.
    pub fn stop(&self) {
        self.shared.stopping.store(true, Ordering::SeqCst);
        let nodes: Vec<u64> = self
            .shared
            .open()
            .keys()
            .copied()
            .chain([abi::ROOT])
            .collect();
        // One that has just been closed may be unknown; any other does as well.
        let woken = nodes
            .into_iter()
            .any(|node| self.shared.link.wake_reader(node).is_ok());
        if !woken {
            complain(format_args!(
                "the session ends with the mount or the process"
            ));
        }
    }

    /// How often an operation lasted so long that another thread had to read on. Wraps.
    pub fn late_count(&self) -> u32 {
        self.crew.get().map_or(0, Crew::late_count)
    }

    /// Threads of this session now.
    pub fn threads(&self) -> usize {
        self.crew.get().map_or(0, Crew::threads)
    }
}

impl Shared {
    fn slots(&self) -> MutexGuard<'_, Vec<Arc<Slot>>> {
        self.slots.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn open(&self) -> MutexGuard<'_, BTreeMap<u64, u32>> {
        self.open.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The kernel has one open file of this node less.
    fn closed(&self, node: u64) {
        let mut open = self.open();
        match open.get_mut(&node) {
            Some(count) if *count > 1 => *count -= 1,
            _ => drop(open.remove(&node)),
        }
    }

    /// See the module's description.
    fn interrupt(&self, unique: u64) {
        let id = RequestId(unique);
        if self.operations.interrupt(id) {
            return;
        }
        let inside = self.slots().iter().any(|slot| slot.take(unique));
        if inside {
            self.link.refuse(unique, &Error::Interrupted);
        } else {
            self.operations.interrupt(id);
        }
    }

    fn init(&self, unique: u64, kernel: &KernelInit) -> ControlFlow<()> {
        let (features, reply) = match negotiate(kernel, &self.options, page_bytes()) {
            Negotiated::Agreed(features, reply) => (Some(features), reply),
            Negotiated::AskAgain(reply) => (None, reply),
            Negotiated::TooOld => {
                self.link.refuse(unique, &Error::OldKernel);
                return self.fail(io::Error::new(
                    io::ErrorKind::Unsupported,
                    format!(
                        "the kernel speaks version {}.{} of the fuse protocol, at least {}.{} (linux 4.14) is needed",
                        kernel.major,
                        kernel.minor,
                        abi::MAJOR,
                        abi::MINOR_MIN
                    ),
                ));
            }
        };
        let body = encode::init(&reply);
        let mut message = [0; abi::OUT_HEADER + 64];
        message[..abi::OUT_HEADER].copy_from_slice(&encode::answer_header(unique, 0, body.len()));
        message[abi::OUT_HEADER..].copy_from_slice(&body);
        if let Some(features) = features {
            // A second INIT of one connection does not come; if it did, the first agreement would hold.
            let _ = self.features.set(features);
        }
        if let Err(errno) = self.link.send(&message) {
            return self.fail(errno.into());
        }
        if features.is_some() {
            self.operations
                .start(Arc::clone(&self.link) as Arc<dyn Kernel>);
        }
        ControlFlow::Continue(())
    }

    fn fail(&self, error: io::Error) -> ControlFlow<()> {
        *self.failure.lock().unwrap_or_else(PoisonError::into_inner) = Some(error);
        ControlFlow::Break(())
    }
}

fn page_bytes() -> usize {
    nix::unistd::sysconf(nix::unistd::SysconfVar::PAGE_SIZE)
        .ok()
        .flatten()
        .and_then(|bytes| usize::try_from(bytes).ok())
        .unwrap_or(PAGE_BYTES)
}

/// One thread's part: its buffers and its slot.
struct Worker {
    shared: Arc<Shared>,
    slot: Arc<Slot>,
    request: AlignedBuffer,
    /// Header and body of the answer.
    reply: Box<[u8]>,
}

impl Worker {
    fn new(shared: Arc<Shared>) -> Self {
        let slot = Arc::new(Slot::default());
        shared.slots().push(Arc::clone(&slot));
        Self {
            shared,
            slot,
            request: AlignedBuffer::new(),
            reply: vec![0; abi::OUT_HEADER + TRANSFER_BYTES_MAX].into_boxed_slice(),
        }
    }

    /// Waits for one request and serves it.
    fn cycle(&mut self, seat: &Seat) -> ControlFlow<()> {
        let shared = &*self.shared;
        let buffer = self.request.bytes_mut();
        let length = match shared.link.read(buffer) {
            Ok(length) => length,
            // A signal; or a request that was withdrawn while it was being read.
            Err(Errno::EINTR | Errno::ENOENT) => return ControlFlow::Continue(()),
            Err(Errno::ENODEV | Errno::ECONNABORTED) => return ControlFlow::Break(()),
            Err(errno) => return shared.fail(errno.into()),
        };
        match decode::decode(&buffer[..length]) {
            Ok(request) => serve_request(shared, &self.slot, &mut self.reply, seat, &request)?,
            Err(Malformed { unique, reason }) => {
                complain(format_args!(
                    "a request of the kernel is malformed: {reason}"
                ));
                if let Some(unique) = unique {
                    shared
                        .link
                        .refuse(unique, &Error::Internal(reason.to_string()));
                }
            }
        }
        // The last request was served like any other; this may have been the one that `stop` made the kernel send.
        if shared.stopping.load(Ordering::SeqCst) {
            return ControlFlow::Break(());
        }
        ControlFlow::Continue(())
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        self.shared
            .slots()
            .retain(|slot| !Arc::ptr_eq(slot, &self.slot));
    }
}

/// Serves one request: the session's own or one for the filesystem.
fn serve_request(
    shared: &Shared,
    slot: &Slot,
    reply: &mut [u8],
    seat: &Seat,
    request: &Request<'_>,
) -> ControlFlow<()> {
    let header = &request.header;
    match request.body {
        Body::Init(kernel) => {
            return fenced(header, || shared.init(header.unique, &kernel))
                .unwrap_or(ControlFlow::Continue(()));
        }
        Body::Interrupt { unique } => {
            seat.begin();
            fenced(header, || shared.interrupt(unique));
            seat.end();
        }
        Body::Destroy => {
            report(
                "the answer to its farewell",
                shared
                    .link
                    .send(&encode::answer_header(header.unique, 0, 0)),
            );
        }
        _ => serve_operation(shared, slot, reply, seat, request),
    }
    ControlFlow::Continue(())
}

fn serve_operation(
    shared: &Shared,
    slot: &Slot,
    reply: &mut [u8],
    seat: &Seat,
    request: &Request<'_>,
) {
    let header = &request.header;
    let Some(features) = shared.features.get() else {
        let early = Error::Internal("a request before the first one".into());
        return shared.link.refuse(header.unique, &early);
    };
    let interruptible = !matches!(request.body, Body::Flush { .. } | Body::Fsync { .. });
    let (head, out) = reply.split_at_mut(abi::OUT_HEADER);
    // Filled before `begin`: see the module's description.
    if interruptible {
        *slot.lock() = Some(header.unique);
    }
    seat.begin();
    let performed = fenced(header, || {
        perform(&*shared.operations, features, request, out)
    });
    seat.end();
    let ours = !interruptible || slot.take(header.unique);
    let performed = match performed {
        Some(performed) => performed,
        None if matches!(request.body, Body::Forget | Body::NotifyReply) => Performed::Silent,
        None => Performed::Refuse(Error::Internal("panic in a request".into())),
    };
    match performed {
        // Before the answer, because the file may be closed as soon as it arrives.
        Performed::Opened { .. } => *shared.open().entry(header.node).or_default() += 1,
        _ if matches!(request.body, Body::Release { .. }) => shared.closed(header.node),
        _ => {}
    }
    if !ours {
        return undo(shared, header, performed);
    }
    let (errno, bytes) = match &performed {
        Performed::Reply(bytes) | Performed::Opened { bytes, .. } => (0, *bytes),
        Performed::Refuse(error) => (error.errno(), 0),
        Performed::Wait | Performed::Silent => return,
    };
    head.copy_from_slice(&encode::answer_header(header.unique, errno, bytes));
    let message = &reply[..abi::OUT_HEADER + bytes];
    if shared.link.answer(header.unique, message) != Delivery::Whole {
        undo(shared, header, performed);
    }
}

/// The caller did not get the answer: it was interrupted, or it is gone.
fn undo(shared: &Shared, header: &Header, performed: Performed) {
    match performed {
        Performed::Opened { fh, .. } => {
            shared.closed(header.node);
            fenced(header, || shared.operations.release(header.node, fh));
        }
        Performed::Wait => {
            fenced(header, || {
                shared.operations.interrupt(RequestId(header.unique))
            });
        }
        Performed::Reply(_) | Performed::Refuse(_) | Performed::Silent => {}
    }
}

/// Keeps a panic of the filesystem to the request it belongs to.
fn fenced<R>(header: &Header, call: impl FnOnce() -> R) -> Option<R> {
    let result = catch_unwind(AssertUnwindSafe(call)).ok();
    if result.is_none() {
        complain(format_args!(
            "panic in request {} (operation {}) of file {}",
            header.unique, header.opcode, header.node
        ));
    }
    result
}

/// A line for the log of the process. Standard error may be closed; that is no reason to end.
pub(crate) fn complain(what: fmt::Arguments<'_>) {
    let _ = writeln!(io::stderr(), "trikfs: {what}");
}

/// A request buffer that starts on a page.
struct AlignedBuffer {
    bytes: Box<[u8]>,
    start: usize,
}

impl AlignedBuffer {
    fn new() -> Self {
        let bytes = vec![0; REQUEST_BYTES + PAGE_BYTES].into_boxed_slice();
        let start = bytes.as_ptr().align_offset(PAGE_BYTES).min(PAGE_BYTES);
        Self { bytes, start }
    }

    fn bytes_mut(&mut self) -> &mut [u8] {
        &mut self.bytes[self.start..self.start + REQUEST_BYTES]
    }
}

/// Decodes arbitrary bytes as a request and, if they are one, runs it on the [`NullFs`]: for fuzzing.
/// Must neither panic nor allocate more than a little.
pub fn fuzz_decode(bytes: &[u8]) {
    let Ok(request) = decode::decode(bytes) else {
        return;
    };
    let kernel = match request.body {
        Body::Init(kernel) => kernel,
        _ => KernelInit {
            major: abi::MAJOR,
            minor: abi::MINOR,
            ..KernelInit::default()
        },
    };
    let agreed = negotiate(&kernel, &SessionOptions::default(), PAGE_BYTES);
    if let Negotiated::Agreed(features, reply) = agreed {
        encode::init(&reply);
        let mut out = [0; 4096];
        perform(&NullFs, &features, &request, &mut out);
    }
}

#[cfg(test)]
pub(crate) mod tests;
