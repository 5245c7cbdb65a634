//! Several sources as one: their tuples stand one after the other in the input of one converter.
//!
//! Owns the rule for time: a tuple is made whenever one of the streams delivers, from that tuple and the newest of
//! every other source; states are sampled at that moment. Nothing is made before every stream has delivered once.
//! Only states: each reading samples all of them.

use super::{Device, Got, State, Stream, Surroundings};
use crate::bytes::copy_at;
use crate::errno::Error;
use crate::state_reader::whole_tuple;
use config::description::PartDescription;
use nix::sys::epoll::{Epoll, EpollCreateFlags, EpollEvent, EpollFlags, EpollTimeout};
use std::os::fd::{AsFd, BorrowedFd};
use std::time::Instant;

/// Opens all parts.
pub fn open(parts: &[PartDescription], around: &Surroundings) -> Result<Device, Error> {
    let mut inputs = Vec::with_capacity(parts.len());
    let mut streams = false;
    for part in parts {
        let device = super::open(&part.source, part.tuple_size, around)
            .map_err(|error| super::part_error(&part.name, error))?;
        streams |= matches!(device, Device::Stream(_));
        let empty = vec![0; part.tuple_size];
        inputs.push(Input {
            device,
            newest: empty.clone(),
            partial: empty,
            filled: 0,
            has_delivered: false,
        });
    }
    if !streams {
        return Ok(Device::State(Box::new(States {
            inputs,
            current: Vec::new(),
        })));
    }
    let failed = |errno: nix::Error| Error::Device(errno as i32, "epoll".to_owned());
    let epoll = Epoll::new(EpollCreateFlags::EPOLL_CLOEXEC).map_err(failed)?;
    for (index, input) in inputs.iter().enumerate() {
        if let Device::Stream(stream) = &input.device
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
        inputs,
        epoll,
        ready: Vec::new(),
        next: 0,
    })))
}

struct Input {
    device: Device,
    /// The newest whole tuple.
    newest: Vec<u8>,
    /// The one that is coming in, of which `filled` bytes are there.
    partial: Vec<u8>,
    filled: usize,
    has_delivered: bool,
}

impl Input {
    fn sample(&mut self) -> Result<(), Error> {
        if let Device::State(state) = &mut self.device {
            whole_tuple(state.as_mut(), &mut self.newest)?;
        }
        Ok(())
    }
}

fn joined(inputs: &mut [Input], into: &mut Vec<u8>) -> Result<(), Error> {
    for input in inputs {
        input.sample()?;
        into.extend_from_slice(&input.newest);
    }
    Ok(())
}

struct States {
    inputs: Vec<Input>,
    current: Vec<u8>,
}

impl State for States {
    fn read_at(&mut self, offset: u64, buf: &mut [u8]) -> Result<usize, Error> {
        if offset == 0 {
            self.current.clear();
            joined(&mut self.inputs, &mut self.current)?;
        }
        Ok(copy_at(&self.current, offset, buf))
    }
}

struct Streams {
    inputs: Vec<Input>,
    epoll: Epoll,
    ready: Vec<u8>,
    /// The stream to ask first, so that a fast one does not starve the others.
    next: usize,
}

impl Streams {
    /// Asks each stream once for the rest of its tuple, up to the first that completes one.
    fn advance(&mut self) -> Result<Option<Got>, Error> {
        let count = self.inputs.len();
        let mut ended = 0;
        let mut streams = 0;
        for turn in 0..count {
            let index = (self.next + turn) % count;
            let input = &mut self.inputs[index];
            let Device::Stream(stream) = &mut input.device else {
                continue;
            };
            streams += 1;
            let at = input.filled;
            match stream.read(&mut input.partial[at..])? {
                Got::Nothing => {}
                Got::End => ended += 1,
                Got::Bytes(n) => {
                    input.filled += n;
                    if input.filled == input.partial.len() {
                        std::mem::swap(&mut input.newest, &mut input.partial);
                        input.filled = 0;
                        input.has_delivered = true;
                        self.next = index + 1;
                        return Ok(Some(Got::Bytes(n)));
                    }
                }
            }
        }
        Ok((ended == streams).then_some(Got::End))
    }

    fn is_complete(&self) -> bool {
        let complete =
            |input: &Input| matches!(input.device, Device::State(_)) || input.has_delivered;
        self.inputs.iter().all(complete)
    }
}

impl Stream for Streams {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        while self.ready.is_empty() {
            match self.advance()? {
                Some(Got::End) => return Ok(Got::End),
                Some(_) if self.is_complete() => joined(&mut self.inputs, &mut self.ready)?,
                Some(_) => {}
                None => {
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

    fn wake_at(&self) -> Option<Instant> {
        let due = |input: &Input| match &input.device {
            Device::Stream(stream) => stream.wake_at(),
            Device::State(_) => None,
        };
        self.inputs.iter().filter_map(due).min()
    }
}
