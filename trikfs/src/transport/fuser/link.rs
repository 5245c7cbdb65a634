//! Replies that are given later, and notifications, over the crate.
//!
//! Owns each reply from before its operation runs until somebody sends it. Knows no operation by name.

use crate::errno::Error;
use crate::transport::native::complain;
use crate::transport::{Answer, Kernel, Outcome, PollHandle, RequestId};
use fuser::{Errno, INodeNo, Notifier, ReplyData, ReplyEmpty, ReplyWrite};
use std::collections::HashMap;
use std::ffi::OsStr;
use std::io;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::{Mutex, OnceLock, PoisonError};

/// Replies of requests that are inside an operation or wait, and the way to send notifications.
#[derive(Default)]
pub(super) struct Link {
    waiting: Mutex<HashMap<RequestId, Reply>>,
    /// Set once the connection exists.
    pub(super) notifier: OnceLock<Notifier>,
}

/// A reply that may be given later.
pub(super) enum Reply {
    Data(ReplyData),
    Write(ReplyWrite),
    Empty(ReplyEmpty),
}

impl Reply {
    fn send(self, result: Result<Answer<'_>, Error>) {
        match (self, result) {
            (Self::Data(reply), Ok(Answer::Data(data))) => reply.data(data),
            (Self::Data(reply), Ok(_)) => reply.data(&[]),
            (Self::Write(reply), Ok(Answer::Written(count))) => {
                reply.written(u32::try_from(count).unwrap_or(u32::MAX))
            }
            (Self::Write(reply), Ok(_)) => reply.written(0),
            (Self::Empty(reply), Ok(_)) => reply.ok(),
            (Self::Data(reply), Err(error)) => reply.error(number(&error)),
            (Self::Write(reply), Err(error)) => reply.error(number(&error)),
            (Self::Empty(reply), Err(error)) => reply.error(number(&error)),
        }
    }
}

impl Link {
    /// Takes a reply out, so that it is sent once.
    fn take(&self, id: RequestId) -> Option<Reply> {
        self.waiting
            .lock()
            .unwrap_or_else(PoisonError::into_inner)
            .remove(&id)
    }

    /// Runs an operation that may wait. Its reply is in the map before, because another thread may answer at once.
    pub(super) fn perform<'a>(
        &self,
        id: RequestId,
        reply: Reply,
        operation: impl FnOnce() -> Result<(Outcome, Option<Answer<'a>>), Error>,
    ) {
        let mut waiting = self.waiting.lock().unwrap_or_else(PoisonError::into_inner);
        waiting.insert(id, reply);
        drop(waiting);
        let result = match fenced(operation) {
            Ok((Outcome::Wait, _)) => return,
            Ok((Outcome::Done(_), answer)) => answer.ok_or_else(too_much),
            Err(error) => Err(error),
        };
        if let Some(reply) = self.take(id) {
            reply.send(result);
        }
    }

    fn notify(&self, what: &str, send: impl FnOnce(&Notifier) -> io::Result<()>) -> bool {
        let Some(notifier) = self.notifier.get() else {
            return false;
        };
        match send(notifier) {
            Ok(()) => true,
            Err(error) => {
                let errno = error.raw_os_error().map(nix::Error::from_raw);
                if !matches!(
                    errno,
                    Some(nix::Error::ENOENT | nix::Error::ENODEV | nix::Error::ENOTCONN)
                ) {
                    complain(format_args!("the kernel refused {what}: {error}"));
                }
                false
            }
        }
    }
}

impl Kernel for Link {
    fn answer(&self, id: RequestId, result: Result<Answer<'_>, Error>) {
        if let Some(reply) = self.take(id) {
            reply.send(result);
        }
    }

    fn notify_poll(&self, handle: PollHandle) {
        self.notify("a poll notification", |notifier| {
            notifier.poll(fuser::PollHandle(handle.0))
        });
    }

    fn store(&self, ino: u64, data: &[u8]) -> bool {
        self.notify("bytes for its cache", |notifier| {
            notifier.store(INodeNo(ino), 0, data)
        })
    }

    fn invalidate(&self, ino: u64) {
        self.notify("an invalidation", |notifier| {
            notifier.inval_inode(INodeNo(ino), 0, 0)
        });
    }

    fn invalidate_entry(&self, parent: u64, name: &str) {
        self.notify("the invalidation of a name", |notifier| {
            notifier.inval_entry(INodeNo(parent), OsStr::new(name))
        });
    }

    fn can_store(&self) -> bool {
        true
    }
}

/// An error as the crate wants it.
pub(super) fn number(error: &Error) -> Errno {
    Errno::from_i32(error.errno())
}

fn too_much() -> Error {
    Error::Internal("an operation claims more bytes than it was given".into())
}

/// Keeps a panic of the filesystem to the request it belongs to.
pub(super) fn fenced<T>(operation: impl FnOnce() -> Result<T, Error>) -> Result<T, Error> {
    catch_unwind(AssertUnwindSafe(operation)).unwrap_or_else(|_| {
        complain(format_args!("panic in a request"));
        Err(Error::Internal("panic in a request".into()))
    })
}
