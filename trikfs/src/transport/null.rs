//! The yardstick: a filesystem that does nothing as fast as it can.
//!
//! A root with two files that hold the same four bytes: `null` ends after them and can be read at any position,
//! `device` is a stream that never ends. What a read of it costs is what a transport costs; benchmarks compare that with a pipe.

use super::{
    Access, Attr, Caller, DirEntry, FileKind, Kernel, Opened, Operations, Outcome, PollHandle,
    RequestId, StatFs, Transfer,
};
use crate::errno::Error;
use std::sync::Arc;
use std::time::{Duration, UNIX_EPOCH};

const ROOT: u64 = 1;
const NULL: u64 = 2;
const DEVICE: u64 = 3;
/// The kernel may keep everything; nothing ever changes.
const TTL: Duration = Duration::from_secs(3600);
/// What every read gives.
const BYTES: [u8; 4] = *b"null";

/// See the module's description.
#[derive(Clone, Copy, Debug, Default)]
pub struct NullFs;

impl Operations for NullFs {
    fn start(&self, _kernel: Arc<dyn Kernel>) {}

    fn lookup(&self, parent: u64, name: &[u8]) -> Result<Attr, Error> {
        match (parent, name) {
            (ROOT, b"null") => self.getattr(NULL),
            (ROOT, b"device") => self.getattr(DEVICE),
            _ => Err(Error::NotFound),
        }
    }

    fn getattr(&self, ino: u64) -> Result<Attr, Error> {
        let (kind, size, mode) = match ino {
            ROOT => (FileKind::Directory, 0, 0o755),
            NULL | DEVICE => (FileKind::File, BYTES.len() as u64, 0o666),
            _ => return Err(Error::Stale),
        };
        Ok(Attr {
            ino,
            kind,
            size,
            mode,
            uid: 0,
            gid: 0,
            modified: UNIX_EPOCH,
            attr_ttl: TTL,
            entry_ttl: TTL,
        })
    }

    fn setattr(
        &self,
        ino: u64,
        _fh: Option<u64>,
        _size: Option<u64>,
        other: bool,
    ) -> Result<Attr, Error> {
        if other {
            Err(Error::NotPermitted)
        } else {
            self.getattr(ino)
        }
    }

    fn readdir(
        &self,
        ino: u64,
        from: u64,
        add: &mut dyn FnMut(DirEntry<'_>) -> bool,
    ) -> Result<(), Error> {
        if ino != ROOT {
            return Err(Error::NotADirectory);
        }
        let entries = [
            (ROOT, FileKind::Directory, "."),
            (ROOT, FileKind::Directory, ".."),
            (NULL, FileKind::File, "null"),
            (DEVICE, FileKind::File, "device"),
        ];
        for ((ino, kind, name), next) in entries.into_iter().zip(1..) {
            if next > from
                && !add(DirEntry {
                    ino,
                    kind,
                    name,
                    next,
                })
            {
                break;
            }
        }
        Ok(())
    }

    fn open(&self, ino: u64, _flags: i32, _caller: Caller) -> Result<Opened, Error> {
        let access = match ino {
            NULL => Access::Direct,
            DEVICE => Access::Stream,
            _ => return Err(Error::IsADirectory),
        };
        Ok(Opened {
            fh: ino,
            access,
            flush: false,
        })
    }

    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        let from = match request.fh {
            NULL => usize::try_from(request.offset).map_or(BYTES.len(), |at| at.min(BYTES.len())),
            _ => 0,
        };
        let bytes = &BYTES[from..];
        let count = out.len().min(bytes.len());
        out[..count].copy_from_slice(&bytes[..count]);
        Ok(Outcome::Done(count))
    }

    fn write(&self, _request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        Ok(Outcome::Done(data.len()))
    }

    fn poll(&self, _ino: u64, _fh: u64, _handle: PollHandle, events: u32) -> Result<u32, Error> {
        Ok(events
            & u32::from(
                (libc::POLLIN | libc::POLLOUT | libc::POLLRDNORM | libc::POLLWRNORM)
                    .cast_unsigned(),
            ))
    }

    fn flush(
        &self,
        _id: RequestId,
        _ino: u64,
        _fh: u64,
        _caller: Caller,
    ) -> Result<Outcome, Error> {
        Ok(Outcome::Done(0))
    }

    fn fsync(
        &self,
        _id: RequestId,
        _ino: u64,
        _fh: u64,
        _caller: Caller,
    ) -> Result<Outcome, Error> {
        Ok(Outcome::Done(0))
    }

    fn release(&self, _ino: u64, _fh: u64) {}

    fn interrupt(&self, _id: RequestId) -> bool {
        false
    }

    fn getxattr(&self, _ino: u64, _name: &[u8]) -> Result<Vec<u8>, Error> {
        Err(Error::NoAttribute)
    }

    fn listxattr(&self, _ino: u64) -> Result<Vec<u8>, Error> {
        Ok(Vec::new())
    }

    fn statfs(&self) -> StatFs {
        StatFs {
            files: 3,
            name_max: 255,
        }
    }

    fn stop(&self) {}
}
