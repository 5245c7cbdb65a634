//! The newest samples of other nodes as a source (`newest:other`): what those nodes have, not a reading of one's own.
//!
//! Owns keeping the other nodes' sources open meanwhile, and taking several of their samples at one moment.

use super::linked::LinkedNode;
use super::{Device, Kind, State, Surroundings};
use crate::bytes::copy_at;
use crate::clock::Stamp;
use crate::errno::Error;
use crate::latch::{Latch, Sample};
use config::description::NewestDescription;
use std::collections::BTreeSet;
use std::path::PathBuf;
use std::sync::Arc;

impl Kind for NewestDescription {
    fn open(&self, _tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        open(around.link(&self.path)?)
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

/// Opens the newest sample of one node as a state.
fn open(other: &Arc<dyn LinkedNode>) -> Result<Device, Error> {
    let latched = Latched::open(other)?;
    Ok(Device::State(Box::new(LatchedState {
        latched,
        current: Vec::new(),
    })))
}

/// One other node whose newest sample is used. Without background sampling its source is open for as long.
pub struct Latched(Arc<dyn LinkedNode>);

impl Latched {
    /// Joins the readers of the other node's newest value.
    pub fn open(other: &Arc<dyn LinkedNode>) -> Result<Self, Error> {
        other.join_newest()?;
        Ok(Self(other.clone()))
    }
}

impl Latched {
    /// The other node has no sample, and none is on its way.
    pub fn is_silent(&self) -> bool {
        self.0.is_silent()
    }
}

impl Drop for Latched {
    fn drop(&mut self) {
        self.0.leave_newest();
    }
}

/// The samples of all at one moment, in their order: bytes appended to `into`, times to `taken`.
/// False, and nothing appended, if one of them has no sample yet.
///
/// # Errors
/// The failure of the first that has one, with its name.
pub fn sample_all(
    all: &[&Latched],
    into: &mut Vec<Vec<u8>>,
    taken: &mut Vec<Stamp>,
) -> Result<bool, Error> {
    let named = |one: &Latched, error: Error| match error {
        Error::NoDevice(what) => Error::NoDevice(format!("{}: {what}", one.0.path())),
        Error::TimedOut(what) => Error::TimedOut(format!("{}: {what}", one.0.path())),
        other => other,
    };
    for one in all {
        one.0.refresh_newest().map_err(|error| named(one, error))?;
    }
    let latches: Vec<_> = all
        .iter()
        .map(|one| (one.0.latch(), one.0.too_old()))
        .collect();
    let samples = Latch::of_all(&latches);
    let mut found = Vec::with_capacity(samples.len());
    for (one, sample) in all.iter().zip(samples) {
        match sample.map_err(|error| named(one, error))? {
            Some(sample) => found.push(sample),
            None => return Ok(false),
        }
    }
    for Sample { tuple, stamp } in found {
        into.push(tuple);
        taken.push(stamp);
    }
    Ok(true)
}

struct LatchedState {
    latched: Latched,
    current: Vec<u8>,
}

impl State for LatchedState {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        if offset == 0 {
            let (mut tuples, mut taken) = (Vec::new(), Vec::new());
            if !sample_all(&[&self.latched], &mut tuples, &mut taken)? {
                return Err(Error::WouldBlock);
            }
            self.current = tuples.pop().unwrap_or_default();
        }
        Ok(copy_at(&self.current, offset, buf))
    }

    fn is_silent(&self) -> bool {
        self.latched.is_silent()
    }
}
