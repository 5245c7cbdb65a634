//! A node as the source and the sink of other nodes.
//!
//! Owns the bridge: readiness of a stream becomes that of an eventfd, so that a linked stream can be
//! waited for like any other.

use super::{Feed, Node};
use crate::device::linked::LinkedNode;
use crate::device::{Device, Got, Patience, Sink, Stream, kinds};
use crate::errno::Error;
use crate::events::Ready;
use crate::latch::Latch;
use crate::newest;
use crate::reader::Reader;
use nix::sys::eventfd::{EfdFlags, EventFd};
use std::collections::BTreeSet;
use std::os::fd::{AsFd, BorrowedFd};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Duration;

impl LinkedNode for Node {
    fn path(&self) -> &str {
        &self.description.path
    }

    fn open(self: Arc<Self>) -> Result<Device, Error> {
        if self.is_retired() {
            return Err(Error::Stale);
        }
        let bell = EventFd::from_flags(EfdFlags::EFD_NONBLOCK | EfdFlags::EFD_CLOEXEC);
        let bell =
            Arc::new(Bell(bell.map_err(|errno| {
                Error::Device(errno as i32, "eventfd".to_owned())
            })?));
        let listener: Arc<dyn Ready> = bell.clone();
        Ok(match self.open_feed(&listener)? {
            Feed::State(reader) => Device::State(Box::new(reader)),
            Feed::Stream(reader) => Device::Stream(Box::new(LinkedStream { reader, bell })),
        })
    }

    fn open_sink(self: Arc<Self>) -> Result<Box<dyn Sink>, Error> {
        Ok(Box::new(self.open_writer(None)?))
    }

    fn join_newest(&self) -> Result<(), Error> {
        if self.is_retired() {
            return Err(Error::Stale);
        }
        self.sampling.newest.join_as_link()
    }

    fn leave_newest(&self) {
        self.sampling.newest.leave();
    }

    fn refresh_newest(&self) -> Result<(), Error> {
        self.sampling.newest.refresh()
    }

    fn is_silent(&self) -> bool {
        self.sampling.newest.is_silent()
    }

    fn latch(&self) -> &Latch {
        self.sampling.newest.latch()
    }

    fn too_old(&self) -> Option<Duration> {
        newest::too_old(self)
    }

    fn add_buses(&self, buses: &mut BTreeSet<PathBuf>) {
        kinds::add_buses(&self.description.source, &self.source.around, buses);
    }
}

/// Turns "something may have arrived" into readability of a descriptor.
struct Bell(EventFd);

impl Ready for Bell {
    fn ready(&self) {
        // A full counter is readable already.
        let _ = self.0.write(1);
    }
}

struct LinkedStream {
    reader: Arc<Reader>,
    bell: Arc<Bell>,
}

impl Stream for LinkedStream {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        let first = self.reader.read(buf)?;
        if first != Got::Nothing {
            return Ok(first);
        }
        // Silence the bell before looking again: what arrives in between rings it anew.
        let _ = self.bell.0.read();
        self.reader.arm()?;
        self.reader.read(buf)
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        Some(self.bell.0.as_fd())
    }

    /// The other node's source is asked: it may have spoken although the node has given nothing yet.
    fn is_silent(&self, _open: Duration, patience: Patience) -> bool {
        self.reader.is_silent(patience)
    }
}
