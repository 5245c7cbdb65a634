//! Another node of the same tree as a source (`trikfs:other`), without a round trip through the kernel.
//!
//! Owns the bridge only: converted tuples of the other node come out here as raw ones, and readiness becomes
//! that of an eventfd, so that a linked stream looks like any other to whoever waits for it.

use super::{Device, Got, Kind, Sink, State, Stream, Surroundings};
use crate::errno::Error;
use crate::events::Ready;
use crate::node::{Feed, Node};
use crate::reader::Reader;
use crate::state_reader::StateReader;
use crate::writer::Writer;
use config::description::LinkDescription;
use nix::sys::eventfd::{EfdFlags, EventFd};
use std::collections::BTreeSet;
use std::os::fd::{AsFd, BorrowedFd};
use std::path::PathBuf;
use std::sync::Arc;

impl Kind for LinkDescription {
    fn open(&self, _tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        open(around.link(&self.path)?)
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        Ok(Box::new(LinkedSink::open(around.link(&self.path)?)?))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }

    fn add_buses(&self, around: &Surroundings, buses: &mut BTreeSet<PathBuf>) {
        if let Ok(node) = around.link(&self.path) {
            node.add_buses(buses);
        }
    }
}

/// Opens the other node as this node's source.
fn open(other: &Arc<Node>) -> Result<Device, Error> {
    if other.is_retired() {
        return Err(Error::Stale);
    }
    let bell = EventFd::from_flags(EfdFlags::EFD_NONBLOCK | EfdFlags::EFD_CLOEXEC);
    let bell =
        Arc::new(Bell(bell.map_err(|errno| {
            Error::Device(errno as i32, "eventfd".to_owned())
        })?));
    let listener: Arc<dyn Ready> = bell.clone();
    Ok(match other.open_feed(&listener)? {
        Feed::State(reader) => Device::State(Box::new(LinkedState(reader))),
        Feed::Stream(reader) => Device::Stream(Box::new(LinkedStream { reader, bell })),
    })
}

/// Turns "something may have arrived" into readability of a descriptor.
struct Bell(EventFd);

impl Ready for Bell {
    fn ready(&self) {
        // A full counter is readable already.
        let _ = self.0.write(1);
    }
}

struct LinkedState(StateReader);

impl State for LinkedState {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        self.0.read_at(offset, buf)
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
}

/// Writes to the other node as a program would.
pub struct LinkedSink(Writer);

impl LinkedSink {
    /// Opens the other node for writing.
    pub fn open(other: &Arc<Node>) -> Result<Self, Error> {
        Ok(Self(other.open_writer(None)?))
    }
}

impl Sink for LinkedSink {
    fn write(&mut self, tuple: &[u8], waits: bool) -> Result<(), Error> {
        self.0.write_whole(tuple, waits)
    }
}
