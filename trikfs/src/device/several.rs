//! Several sources as one: their tuples stand one after the other in the input of one converter.
//!
//! Owns the rule for time: a tuple is made whenever one of the triggering streams delivers, from that tuple and the
//! newest of every other source; states are sampled at that moment, and newest samples of other nodes are all of one
//! moment. Nothing is made before every stream and every other node has delivered once.
//! Only states: each reading samples all of them.

use super::latched::{self, Latched};
use super::{Device, Got, Kind, Patience, State, Stream, Surroundings, kinds};
use crate::bytes::copy_at;
use crate::clock::Stamp;
use crate::errno::Error;
use config::description::{PartDescription, SeveralDescription};
use nix::sys::epoll::{Epoll, EpollCreateFlags, EpollEvent, EpollFlags, EpollTimeout};
use std::collections::BTreeSet;
use std::os::fd::{AsFd, BorrowedFd};
use std::path::PathBuf;
use std::time::{Duration, Instant};

impl Kind for SeveralDescription {
    fn open(&self, _tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        open(self, around)
    }

    fn is_shared(&self) -> Result<bool, Error> {
        let mut shared = false;
        for part in &self.parts {
            let is_shared = kinds::is_shared(&part.source);
            shared |= is_shared.map_err(|error| part_error(&part.name, error))?;
        }
        Ok(shared)
    }

    fn add_buses(&self, around: &Surroundings, buses: &mut BTreeSet<PathBuf>) {
        for part in &self.parts {
            kinds::add_buses(&part.source, around, buses);
        }
    }
}

/// The error of one of several sources, with its name.
fn part_error(name: &str, error: Error) -> Error {
    match error {
        Error::NoDevice(what) => Error::NoDevice(format!("source {name}: {what}")),
        other => other,
    }
}

/// Opens all parts.
fn open(several: &SeveralDescription, around: &Surroundings) -> Result<Device, Error> {
    let mut inputs = Vec::with_capacity(several.parts.len());
    let mut streams = false;
    for part in &several.parts {
        let input = Input::open(part, around).map_err(|error| part_error(&part.name, error))?;
        streams |= matches!(input.origin, From::Stream(_));
        inputs.push(input);
    }
    let has_trigger = |input: &Input| input.is_trigger && matches!(input.origin, From::Stream(_));
    let is_chosen = several.parts.iter().any(|part| !part.is_trigger);
    if is_chosen && !inputs.iter().any(has_trigger) {
        let what = "trigger: the sources that it names are states, which have no events of their own; name a stream, or leave out trigger and let poll_ms say when to sample";
        return Err(Error::NoDevice(what.to_owned()));
    }
    let joint = Joint {
        inputs,
        ages: several.ages,
        interval: several.interval,
        before: None,
    };
    if !streams {
        return Ok(Device::State(Box::new(States {
            joint,
            current: Vec::new(),
        })));
    }
    let failed = |errno: nix::Error| Error::Device(errno as i32, "epoll".to_owned());
    let epoll = Epoll::new(EpollCreateFlags::EPOLL_CLOEXEC).map_err(failed)?;
    for (index, input) in joint.inputs.iter().enumerate() {
        if let From::Stream(stream) = &input.origin
            && let Some(fd) = stream.fd()
        {
            let event = EpollEvent::new(EpollFlags::EPOLLIN | EpollFlags::EPOLLET, index as u64);
            match epoll.add(fd, event) {
                // EPERM: a device that is always ready needs no waking.
                Ok(()) | Err(nix::Error::EPERM) => {}
                Err(errno) => return Err(failed(errno)),
            }
        }
    }
    Ok(Device::Stream(Box::new(Streams {
        joint,
        epoll,
        ready: Vec::new(),
        next: 0,
    })))
}

/// Where the tuples of one part come from.
enum From {
    State(Box<dyn State>),
    Stream(Box<dyn Stream>),
    Newest(Latched),
}

struct Input {
    origin: From,
    /// The newest whole tuple, and when it was taken.
    newest: Vec<u8>,
    taken: Stamp,
    /// The one that is coming in, of which `filled` bytes are there.
    partial: Vec<u8>,
    filled: usize,
    has_delivered: bool,
    /// A tuple of it makes one of the whole.
    is_trigger: bool,
}

impl Input {
    fn open(part: &PartDescription, around: &Surroundings) -> Result<Self, Error> {
        let origin = match part.source.sampled_node() {
            Some(path) => From::Newest(Latched::open(around.link(path)?)?),
            None => match kinds::open(&part.source, part.tuple_size, around)? {
                Device::State(state) => From::State(state),
                Device::Stream(stream) => From::Stream(stream),
            },
        };
        let empty = vec![0; part.tuple_size];
        Ok(Self {
            origin,
            newest: empty.clone(),
            taken: Stamp::now(),
            partial: empty,
            filled: 0,
            has_delivered: false,
            is_trigger: part.is_trigger,
        })
    }
}

impl Input {
    /// Another node whose newest sample is wanted, and which has nothing to say.
    fn is_silent_node(&self) -> bool {
        match &self.origin {
            From::Newest(latched) => latched.is_silent(),
            From::State(_) | From::Stream(_) => false,
        }
    }
}

/// All parts and what is added to their tuples.
struct Joint {
    inputs: Vec<Input>,
    ages: bool,
    interval: bool,
    /// When the tuple before was made.
    before: Option<Stamp>,
}

impl Joint {
    /// Samples what can be sampled and appends the tuples with their times. False, and nothing appended, while
    /// another node has no sample yet.
    fn join(&mut self, into: &mut Vec<u8>) -> Result<bool, Error> {
        for input in &mut self.inputs {
            if let From::State(state) = &mut input.origin {
                state.whole_tuple(&mut input.newest)?;
                input.taken = Stamp::now();
            }
        }
        if !self.take_newest()? {
            return Ok(false);
        }
        let now = Stamp::now();
        for input in &self.inputs {
            into.extend_from_slice(&input.newest);
        }
        if self.ages {
            for input in &self.inputs {
                into.extend_from_slice(&us_between(input.taken, now).to_le_bytes());
            }
        }
        if self.interval {
            let us = self.before.map_or(0, |before| us_between(before, now));
            into.extend_from_slice(&us.to_le_bytes());
        }
        self.before = Some(now);
        Ok(true)
    }

    fn take_newest(&mut self) -> Result<bool, Error> {
        let latched: Vec<&Latched> = self
            .inputs
            .iter()
            .filter_map(|input| match &input.origin {
                From::Newest(latched) => Some(latched),
                From::State(_) | From::Stream(_) => None,
            })
            .collect();
        if latched.is_empty() {
            return Ok(true);
        }
        let mut tuples = Vec::with_capacity(latched.len());
        let mut taken = Vec::with_capacity(latched.len());
        if !latched::sample_all(&latched, &mut tuples, &mut taken)? {
            return Ok(false);
        }
        let newest = self.inputs.iter_mut();
        let newest = newest.filter(|input| matches!(input.origin, From::Newest(_)));
        for (input, (tuple, stamp)) in newest.zip(tuples.into_iter().zip(taken)) {
            input.newest = tuple;
            input.taken = stamp;
        }
        Ok(true)
    }
}

/// Microseconds, at most what fits.
fn us_between(earlier: Stamp, later: Stamp) -> u32 {
    u32::try_from(later.0.saturating_sub(earlier.0) / 1000).unwrap_or(u32::MAX)
}

struct States {
    joint: Joint,
    current: Vec<u8>,
}

impl State for States {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        if offset == 0 {
            self.current.clear();
            if !self.joint.join(&mut self.current)? {
                return Err(Error::WouldBlock);
            }
        }
        Ok(copy_at(&self.current, offset, buf))
    }

    fn is_silent(&self) -> bool {
        self.joint.inputs.iter().any(Input::is_silent_node)
    }
}

struct Streams {
    joint: Joint,
    epoll: Epoll,
    ready: Vec<u8>,
    /// The stream to ask first, so that a fast one does not starve the others.
    next: usize,
}

/// What asking all streams once came to.
enum Advance {
    /// A tuple is complete; true: of a source that triggers.
    Tuple(bool),
    /// Bytes came, but no tuple is complete.
    Part,
    Nothing,
    End,
}

impl Streams {
    /// Asks each stream once for the rest of its tuple, up to the first that completes one.
    fn advance(&mut self) -> Result<Advance, Error> {
        let count = self.joint.inputs.len();
        let (mut ended, mut streams, mut came) = (0, 0, false);
        for turn in 0..count {
            let index = (self.next + turn) % count;
            let input = &mut self.joint.inputs[index];
            let From::Stream(stream) = &mut input.origin else {
                continue;
            };
            streams += 1;
            let at = input.filled;
            match stream.read(&mut input.partial[at..])? {
                Got::Nothing => {}
                Got::End => ended += 1,
                Got::Bytes(n) => {
                    came = true;
                    input.filled += n;
                    if input.filled == input.partial.len() {
                        std::mem::swap(&mut input.newest, &mut input.partial);
                        input.filled = 0;
                        input.has_delivered = true;
                        input.taken = Stamp::now();
                        self.next = index + 1;
                        return Ok(Advance::Tuple(input.is_trigger));
                    }
                }
            }
        }
        Ok(if ended == streams {
            Advance::End
        } else if came {
            Advance::Part
        } else {
            Advance::Nothing
        })
    }

    fn is_complete(&self) -> bool {
        let complete =
            |input: &Input| !matches!(input.origin, From::Stream(_)) || input.has_delivered;
        self.joint.inputs.iter().all(complete)
    }
}

impl Stream for Streams {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        while self.ready.is_empty() {
            match self.advance()? {
                Advance::End => return Ok(Got::End),
                Advance::Tuple(true) if self.is_complete() => {
                    self.joint.join(&mut self.ready)?;
                }
                Advance::Tuple(_) | Advance::Part => {}
                Advance::Nothing => {
                    // Take the edges off our own descriptor, then look once more.
                    let mut events = [EpollEvent::empty(); 16];
                    if self
                        .epoll
                        .wait(&mut events, EpollTimeout::ZERO)
                        .unwrap_or(0)
                        == 0
                    {
                        return Ok(Got::Nothing);
                    }
                }
            }
        }
        let n = self.ready.len().min(buf.len());
        buf[..n].copy_from_slice(&self.ready[..n]);
        self.ready.drain(..n);
        Ok(Got::Bytes(n))
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        Some(self.epoll.0.as_fd())
    }

    /// One part that is silent is enough: nothing is made without it.
    fn is_silent(&self, open: Duration, patience: Patience) -> bool {
        self.joint.inputs.iter().any(|input| match &input.origin {
            From::Stream(stream) => !input.has_delivered && stream.is_silent(open, patience),
            From::State(_) => false,
            From::Newest(_) => input.is_silent_node(),
        })
    }

    fn wake_at(&self) -> Option<Instant> {
        let due = |input: &Input| match &input.origin {
            From::Stream(stream) => stream.wake_at(),
            From::State(_) | From::Newest(_) => None,
        };
        self.joint.inputs.iter().filter_map(due).min()
    }
}
