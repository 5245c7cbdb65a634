//! The way to the kernel: every message is one write to the device, from any thread.
//!
//! Owns the descriptor of the connection, which is closed (and the connection aborted) with the last user of it, and what
//! is done when a call on it fails. Knows nothing of the requests that wait.
//!
//! # Calls that fail
//! The kernel answers a call on the device with an error when it is short of memory, or when something between it and us
//! refuses. A request that is not answered keeps its caller in a sleep that no signal ends, and an invalidation that is lost
//! leaves a value in the page cache that is not true any more, so both are tried again for [`KERNEL_PATIENCE`]. An answer
//! that the kernel does not take in that time becomes EIO, which needs next to no memory. If not even that arrives, the
//! process aborts: its guardian lets the actuators rest, ends everything that waits, and serves again.

use super::abi::notify;
use super::complain;
use super::encode;
use crate::clock::coarse_ms;
use crate::errno::Error;
use crate::limits::{KERNEL_PATIENCE, KERNEL_PAUSE_MAX, MISTAKE_MS};
use crate::transport::{Answer, Kernel, PollHandle, RequestId};
use nix::errno::Errno;
use nix::sys::uio;
use nix::unistd;
use std::io::IoSlice;
use std::os::fd::OwnedFd;
use std::sync::atomic::{AtomicU32, Ordering};
use std::time::{Duration, Instant};

/// The connection to the kernel.
pub(crate) struct Link {
    device: OwnedFd,
    /// When a call that failed was told of last, in ms of [`coarse_ms`]; a kernel in distress must not fill a disk with lines.
    told_ms: AtomicU32,
    #[cfg(test)]
    inject: Option<Inject>,
}

/// What became of an answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Delivery {
    /// The caller has it.
    Whole,
    /// The kernel did not take it, and the caller has EIO instead.
    AsError,
    /// Nobody waits for it any more: the request was interrupted, or the mount is gone.
    Unwanted,
}

impl Link {
    pub(crate) fn new(device: OwnedFd) -> Self {
        Self {
            device,
            told_ms: AtomicU32::new(coarse_ms().wrapping_sub(MISTAKE_MS)),
            #[cfg(test)]
            inject: None,
        }
    }

    /// Waits for the next request. ENODEV when the mount is gone, EINTR after a signal.
    pub(crate) fn read(&self, buffer: &mut [u8]) -> Result<usize, Errno> {
        self.persist("a read of a request", || {
            #[cfg(test)]
            self.injected(Call::Read)?;
            unistd::read(&self.device, buffer)
        })
    }

    /// Sends one message that is in one piece.
    pub(crate) fn send(&self, message: &[u8]) -> Result<(), Errno> {
        self.persist("a message", || {
            #[cfg(test)]
            self.injected(Call::Write(message.len()))?;
            again(|| unistd::write(&self.device, message))
        })
    }

    /// Answers a request, with an error if the answer itself cannot be delivered.
    pub(crate) fn answer(&self, unique: u64, message: &[u8]) -> Delivery {
        self.settle(unique, self.send(message))
    }

    /// Sees to it that a request whose answer was refused is answered.
    fn settle(&self, unique: u64, sent: Result<(), Errno>) -> Delivery {
        let errno = match sent {
            Ok(()) => return Delivery::Whole,
            Err(errno) if is_gone(errno) => return Delivery::Unwanted,
            Err(errno) => errno,
        };
        self.tell(format_args!(
            "the kernel refused an answer: {errno}; its caller gets EIO"
        ));
        let failed = Error::Internal("an answer could not be delivered".to_owned());
        match self.send(&encode::answer_header(unique, failed.errno(), 0)) {
            Ok(()) => Delivery::AsError,
            Err(errno) if is_gone(errno) => Delivery::Unwanted,
            Err(errno) => {
                self.beyond_help("the answer to a request", errno);
                Delivery::Unwanted
            }
        }
    }

    /// Calls until it succeeds, fails for good, or has failed for as long as it may. Pauses grow, so that a kernel which is
    /// short of something is left in peace.
    fn persist<T>(
        &self,
        what: &str,
        mut call: impl FnMut() -> Result<T, Errno>,
    ) -> Result<T, Errno> {
        let mut result = call();
        let Err(errno) = result else { return result };
        if !is_passing(errno) {
            return result;
        }
        self.tell(format_args!("{what} failed: {errno}; it is tried again"));
        let until = Instant::now() + KERNEL_PATIENCE;
        let mut pause = Duration::from_millis(1);
        while matches!(result, Err(errno) if is_passing(errno)) && Instant::now() < until {
            std::thread::sleep(pause);
            pause = (pause * 2).min(KERNEL_PAUSE_MAX);
            result = call();
        }
        result
    }

    /// A line about a call that failed, now and then.
    fn tell(&self, line: std::fmt::Arguments<'_>) {
        let now = coarse_ms();
        let last = self.told_ms.load(Ordering::Relaxed);
        let is_due = now.wrapping_sub(last) >= MISTAKE_MS;
        let swap = |last| {
            self.told_ms
                .compare_exchange(last, now, Ordering::Relaxed, Ordering::Relaxed)
        };
        if is_due && swap(last).is_ok() {
            complain(line);
        }
    }

    /// A message that must arrive does not: only another life of the daemon can mend that.
    fn beyond_help(&self, what: &str, errno: Errno) {
        complain(format_args!(
            "the kernel takes nothing any more: {what}: {errno}; this process ends, so that nobody waits for ever"
        ));
        #[cfg(test)]
        if let Some(inject) = &self.inject {
            return inject.lost.store(true, Ordering::SeqCst);
        }
        std::process::abort();
    }

    /// Sends one message that is in several pieces.
    fn send_parts(&self, parts: &[&[u8]]) -> Result<(), Errno> {
        self.persist("a message", || self.try_parts(parts))
    }

    fn try_parts(&self, parts: &[&[u8]]) -> Result<(), Errno> {
        let mut slices = [IoSlice::new(&[]); 4];
        let count = parts.len().min(slices.len());
        for (slice, part) in slices.iter_mut().zip(parts) {
            *slice = IoSlice::new(part);
        }
        #[cfg(test)]
        self.injected(Call::Write(parts.iter().map(|part| part.len()).sum()))?;
        again(|| uio::writev(&self.device, &slices[..count]))
    }

    /// Sends what must not be lost while somebody is there who could miss it.
    fn send_surely(&self, what: &str, parts: &[&[u8]]) {
        let sent = self.send_parts(parts);
        if let Err(errno) = sent
            && is_passing(errno)
        {
            return self.beyond_help(what, errno);
        }
        report(what, sent);
    }

    /// Answers a request with an error.
    pub(crate) fn refuse(&self, unique: u64, error: &Error) {
        self.answer(unique, &encode::answer_header(unique, error.errno(), 0));
    }

    /// Makes the kernel send a NOTIFY_REPLY, and so wakes the thread that waits in [`read`](Self::read): asks for
    /// cached bytes of a file that the kernel knows. Newer kernels refuse with EINVAL when it is a directory.
    pub(crate) fn wake_reader(&self, node: u64) -> Result<(), Errno> {
        let body = encode::retrieve(node);
        self.send_parts(&[&encode::notify_header(notify::RETRIEVE, body.len()), &body])
    }
}

/// A signal must not cost a message: the kernel takes it whole or not at all.
fn again(mut write: impl FnMut() -> Result<usize, Errno>) -> Result<(), Errno> {
    loop {
        match write() {
            Err(Errno::EINTR) => {}
            result => return result.map(drop),
        }
    }
}

/// Errors that say nothing of the message and may be over the next time. A request that the kernel could not hand over is
/// answered by the kernel itself, and EIO only tells of it; ENOSYS is what a tracer leaves that was killed in the middle.
fn is_passing(errno: Errno) -> bool {
    errno == Errno::EAGAIN
        || errno == Errno::EFAULT
        || errno == Errno::EIO
        || errno == Errno::ENOBUFS
        || errno == Errno::ENOMEM
        || errno == Errno::ENOSYS
}

/// The addressee of a message is gone: the request was answered already, the file is not known to the kernel, the mount is
/// gone.
fn is_gone(errno: Errno) -> bool {
    errno == Errno::ENOENT
        || errno == Errno::ENODEV
        || errno == Errno::ENOTCONN
        || errno == Errno::ECONNABORTED
}

/// Logs a message that the kernel refused, except when its addressee is gone.
pub(crate) fn report(what: &str, sent: Result<(), Errno>) {
    if let Err(errno) = sent
        && !is_gone(errno)
    {
        complain(format_args!("the kernel refused {what}: {errno}"));
    }
}

impl Kernel for Link {
    fn answer(&self, id: RequestId, result: Result<Answer<'_>, Error>) {
        let sent = match result {
            Ok(Answer::Data(data)) => {
                self.send_parts(&[&encode::answer_header(id.0, 0, data.len()), data])
            }
            Ok(Answer::Written(count)) => {
                let body = encode::number(u32::try_from(count).unwrap_or(u32::MAX));
                self.send_parts(&[&encode::answer_header(id.0, 0, body.len()), &body])
            }
            Ok(Answer::Empty) => self.send(&encode::answer_header(id.0, 0, 0)),
            Err(error) => self.send(&encode::answer_header(id.0, error.errno(), 0)),
        };
        self.settle(id.0, sent);
    }

    fn notify_poll(&self, handle: PollHandle) {
        let body = encode::poll_wakeup(handle.0);
        let header = encode::notify_header(notify::POLL, body.len());
        self.send_surely("a poll notification", &[&header, &body]);
    }

    fn store(&self, ino: u64, data: &[u8]) -> bool {
        let Ok(size) = u32::try_from(data.len()) else {
            return false;
        };
        let head = encode::store(ino, size);
        let header = encode::notify_header(notify::STORE, head.len() + data.len());
        // Once: the next value comes soon. But what is in the cache must not stay there as the newest one.
        let sent = self.try_parts(&[&header, &head, data]);
        if let Err(errno) = sent
            && !is_gone(errno)
        {
            self.tell(format_args!(
                "the kernel refused bytes for its cache: {errno}"
            ));
            self.invalidate(ino);
        }
        sent.is_ok()
    }

    fn invalidate(&self, ino: u64) {
        self.send_surely("an invalidation", &[&encode::invalidate_message(ino)]);
    }

    fn invalidate_entry(&self, parent: u64, name: &str) {
        let Ok(length) = u32::try_from(name.len()) else {
            return;
        };
        let head = encode::invalidate_entry(parent, length);
        let header = encode::notify_header(notify::INVAL_ENTRY, head.len() + name.len() + 1);
        self.send_surely(
            "the invalidation of a name",
            &[&header, &head, name.as_bytes(), b"\0"],
        );
    }

    /// NOTIFY_STORE and KEEP_CACHE are older than the oldest version served.
    fn can_store(&self) -> bool {
        true
    }
}

/// A call on the device, as a test sees it.
#[cfg(test)]
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Call {
    /// For a request.
    Read,
    /// Of a message of so many bytes.
    Write(usize),
}

/// Errors instead of calls on the device.
#[cfg(test)]
#[derive(Clone)]
pub(crate) struct Inject {
    /// The error that a call gets, if it gets one.
    pub(crate) error: std::sync::Arc<dyn Fn(Call) -> Option<Errno> + Send + Sync>,
    /// Set where the process would abort.
    pub(crate) lost: std::sync::Arc<std::sync::atomic::AtomicBool>,
}

#[cfg(test)]
impl Link {
    /// The same with errors.
    pub(crate) fn with_errors(mut self, inject: Inject) -> Self {
        self.inject = Some(inject);
        self
    }

    fn injected(&self, call: Call) -> Result<(), Errno> {
        let error = self.inject.as_ref().and_then(|inject| (inject.error)(call));
        error.map_or(Ok(()), Err)
    }
}
