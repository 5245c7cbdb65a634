//! The newest samples of other nodes as a source (`newest:other`): what those nodes have, not a reading of one's own.
//!
//! Owns keeping the other nodes' sources open meanwhile, and taking several of their samples at one moment.

use super::{Device, Kind, State, Surroundings};
use crate::bytes::copy_at;
use crate::clock::Stamp;
use crate::errno::Error;
use crate::newest::{Newest, Sample};
use crate::node::Node;
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
fn open(other: &Arc<Node>) -> Result<Device, Error> {
    let latched = Latched::open(other)?;
    Ok(Device::State(Box::new(LatchedState {
        latched,
        current: Vec::new(),
    })))
}

/// One other node whose newest sample is used. Without background sampling its source is open for as long.
pub struct Latched(Arc<Node>);

impl Latched {
    /// Joins those who read the other node's newest value.
    pub fn open(other: &Arc<Node>) -> Result<Self, Error> {
        if other.is_retired() {
            return Err(Error::Stale);
        }
        match other.newest.join() {
            // A device that is gone now may come back: the samples tell.
            Ok(_) => Ok(Self(other.clone())),
            Err(Error::NoDevice(_)) if other.newest.is_in_background() => Ok(Self(other.clone())),
            Err(error) => Err(error),
        }
    }
}

impl Drop for Latched {
    fn drop(&mut self) {
        self.0.newest.leave();
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
    let named = |node: &Node, error: Error| match error {
        Error::NoDevice(what) => Error::NoDevice(format!("{}: {what}", node.path())),
        Error::TimedOut(what) => Error::TimedOut(format!("{}: {what}", node.path())),
        other => other,
    };
    for one in all {
        one.0
            .newest
            .refresh()
            .map_err(|error| named(&one.0, error))?;
    }
    let nodes: Vec<&Newest> = all.iter().map(|one| &one.0.newest).collect();
    let samples = Newest::of_all(&nodes);
    let mut found = Vec::with_capacity(samples.len());
    for (one, sample) in all.iter().zip(samples) {
        match sample.map_err(|error| named(&one.0, error))? {
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
}
