//! The way to the kernel: every message is one write to the device, from any thread.
//!
//! Owns the descriptor of the connection, which is closed (and the connection aborted) with the last user of it.
//! Knows nothing of the requests that wait.

use super::abi::notify;
use super::complain;
use super::encode;
use crate::errno::Error;
use crate::transport::{Answer, Kernel, PollHandle, RequestId};
use nix::errno::Errno;
use nix::sys::uio;
use nix::unistd;
use std::io::IoSlice;
use std::os::fd::OwnedFd;

/// The connection to the kernel.
pub(crate) struct Link {
    device: OwnedFd,
}

impl Link {
    pub(crate) fn new(device: OwnedFd) -> Self {
        Self { device }
    }

    /// Waits for the next request. ENODEV when the mount is gone.
    pub(crate) fn read(&self, buffer: &mut [u8]) -> Result<usize, Errno> {
        unistd::read(&self.device, buffer)
    }

    /// Sends one message that is in one piece.
    pub(crate) fn send(&self, message: &[u8]) -> Result<(), Errno> {
        again(|| unistd::write(&self.device, message))
    }

    /// Sends one message that is in several pieces.
    fn send_parts(&self, parts: &[&[u8]]) -> Result<(), Errno> {
        let mut slices = [IoSlice::new(&[]); 4];
        let count = parts.len().min(slices.len());
        for (slice, part) in slices.iter_mut().zip(parts) {
            *slice = IoSlice::new(part);
        }
        again(|| uio::writev(&self.device, &slices[..count]))
    }

    /// Answers a request with an error.
    pub(crate) fn refuse(&self, unique: u64, error: &Error) {
        let sent = self.send(&encode::answer_header(unique, error.errno(), 0));
        report("an error", sent);
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

/// Logs a message that the kernel refused, except when its addressee is gone: the request was answered already,
/// the file is not known to the kernel, the mount is gone.
pub(crate) fn report(what: &str, sent: Result<(), Errno>) {
    match sent {
        Ok(()) | Err(Errno::ENOENT | Errno::ENODEV | Errno::ENOTCONN | Errno::ECONNABORTED) => {}
        Err(errno) => complain(format_args!("the kernel refused {what}: {errno}")),
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
        report("a late answer", sent);
    }

    fn notify_poll(&self, handle: PollHandle) {
        let body = encode::poll_wakeup(handle.0);
        let sent = self.send_parts(&[&encode::notify_header(notify::POLL, body.len()), &body]);
        report("a poll notification", sent);
    }

    fn store(&self, ino: u64, data: &[u8]) -> bool {
        let Ok(size) = u32::try_from(data.len()) else {
            return false;
        };
        let head = encode::store(ino, size);
        let header = encode::notify_header(notify::STORE, head.len() + data.len());
        let sent = self.send_parts(&[&header, &head, data]);
        report("bytes for its cache", sent);
        sent.is_ok()
    }

    fn invalidate(&self, ino: u64) {
        report(
            "an invalidation",
            self.send(&encode::invalidate_message(ino)),
        );
    }

    fn invalidate_entry(&self, parent: u64, name: &str) {
        let Ok(length) = u32::try_from(name.len()) else {
            return;
        };
        let head = encode::invalidate_entry(parent, length);
        let header = encode::notify_header(notify::INVAL_ENTRY, head.len() + name.len() + 1);
        let sent = self.send_parts(&[&header, &head, name.as_bytes(), b"\0"]);
        report("the invalidation of a name", sent);
    }

    /// NOTIFY_STORE and KEEP_CACHE are older than the oldest version served.
    fn can_store(&self) -> bool {
        true
    }
}
