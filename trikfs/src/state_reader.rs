//! The converted tuples of a state, for one consumer: position in, bytes out.
//!
//! Owns the rule that reading at offset 0 samples anew, and what is left over when a buffer ends inside a tuple.

use crate::convert::Pipeline;
use crate::device::State;
use crate::errno::Error;
use crate::events::lock;
use crate::limits;
use crate::node::Node;
use converter::Direction;
use std::sync::{Arc, Mutex};

/// One consumer's view of a state.
pub struct StateReader {
    node: Arc<Node>,
    device: Box<dyn State>,
    /// None: it is opened for the first sample.
    pipeline: Option<Arc<Mutex<Pipeline>>>,
    raw: Vec<u8>,
    /// The last sample gave a whole tuple of the source, which is in `raw`.
    is_whole: bool,
    /// What is left of the converted tuple that the last read ended in.
    rest: Vec<u8>,
    /// The offset after the last read, and the tuple of the source that comes next there.
    next_at: u64,
    next_tuple: u64,
    /// It takes the samples of the node, and tells of what they were made.
    is_tapped: bool,
}

impl StateReader {
    /// A reader of an open state.
    pub fn new(
        node: Arc<Node>,
        device: Box<dyn State>,
        pipeline: Option<Arc<Mutex<Pipeline>>>,
    ) -> Self {
        Self {
            node,
            device,
            pipeline,
            raw: Vec::new(),
            is_whole: false,
            rest: Vec::new(),
            next_at: 0,
            next_tuple: 0,
            is_tapped: false,
        }
    }

    /// The one that takes the samples of the node.
    #[must_use]
    pub fn tapped(self) -> Self {
        Self {
            is_tapped: true,
            ..self
        }
    }

    /// One fresh converted tuple. A converter that gives none is sampled again, as often as the limit allows;
    /// false if there was none even then.
    pub fn sample(&mut self, tuple: &mut [u8]) -> Result<bool, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        self.raw.resize(self.node.description.input_tuple_size, 0);
        for _ in 0..limits::CONSUMED_TUPLES_MAX {
            self.is_whole = false;
            match self.device.whole_tuple(&mut self.raw) {
                // The clock asks again soon, and reads wait for that.
                Err(Error::WouldBlock) if self.node.sampling.newest.is_in_background() => {
                    return Ok(false);
                }
                sampled => sampled.map_err(|error| self.failed(error))?,
            }
            self.is_whole = true;
            let pipeline = self.pipeline()?;
            let mut pipeline = lock(&pipeline);
            let batch = self
                .node
                .convert(&mut pipeline, Direction::Read, &self.raw, tuple);
            if self.is_tapped {
                (self.node.sampling.newest).heard(&self.raw, self.raw.len(), batch.fault.is_some());
            }
            if let Some(error) = batch.fault {
                return Err(error);
            }
            if batch.produced > 0 {
                self.node.driving.written.read_back(&self.raw, tuple);
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// The last tuple of the source and what stages have made of it, if it came whole. True: the last stage has given too.
    pub fn tell_stages(&self, tell: &mut dyn FnMut(&[u8])) -> bool {
        match &self.pipeline {
            Some(pipeline) if self.is_whole => {
                tell(&self.raw);
                lock(pipeline).tell_stages(tell)
            }
            Some(_) | None => false,
        }
    }

    fn pipeline(&mut self) -> Result<Arc<Mutex<Pipeline>>, Error> {
        if let Some(pipeline) = &self.pipeline {
            return Ok(pipeline.clone());
        }
        let pipeline = self.node.open_pipeline()?;
        self.pipeline = Some(pipeline.clone());
        Ok(pipeline)
    }

    /// Whether there is no sample because another node that is needed is silent.
    pub fn is_silent(&self) -> bool {
        self.device.is_silent()
    }

    /// A failure of the source, reported. One that only has nothing yet is too late for the read at hand.
    fn failed(&self, error: Error) -> Error {
        let error = match error {
            Error::WouldBlock if self.is_silent() => Error::Silent,
            Error::WouldBlock => Error::TimedOut("not every source has a sample yet".to_owned()),
            other => other,
        };
        self.node.report(&error);
        error
    }

    fn take_rest(&mut self, out: &mut [u8]) -> usize {
        let n = self.rest.len().min(out.len());
        out[..n].copy_from_slice(&self.rest[..n]);
        self.rest.drain(..n);
        n
    }

    /// The one tuple of a text.
    fn convert_text(&mut self, skip: usize, out: &mut [u8]) -> Result<usize, Error> {
        if self.next_tuple > 0 {
            return Ok(0);
        }
        let mut tuple = vec![0; self.node.description.output_tuple_size];
        if !self.sample(&mut tuple)? {
            return Err(Error::WouldBlock);
        }
        self.next_tuple = 1;
        tuple.drain(..skip);
        self.rest = tuple;
        Ok(self.take_rest(out))
    }

    /// As many tuples as fit, or one of which the first `skip` bytes are left out and the end becomes `rest`.
    fn convert_next(&mut self, skip: usize, out: &mut [u8]) -> Result<usize, Error> {
        let description = &self.node.description;
        let (input_size, output_size) =
            (description.input_tuple_size, description.output_tuple_size);
        let whole = if skip == 0 {
            out.len() / output_size
        } else {
            0
        };
        let wanted = whole.clamp(1, (limits::READ_BYTES / input_size).max(1));
        let mut one = vec![0; if whole == 0 { output_size } else { 0 }];
        for _ in 0..limits::CONSUMED_TUPLES_MAX {
            self.raw.resize(wanted * input_size, 0);
            let from = self.next_tuple.saturating_mul(input_size as u64);
            let got = self.device.read_at(from, &mut self.raw);
            let tuples = got.map_err(|error| self.failed(error))? / input_size;
            if tuples == 0 {
                return Ok(0);
            }
            let target = if whole == 0 {
                &mut one[..]
            } else {
                &mut out[..whole * output_size]
            };
            let pipeline = self.pipeline()?;
            let input = &self.raw[..tuples * input_size];
            let mut pipeline = lock(&pipeline);
            let batch = self
                .node
                .convert(&mut pipeline, Direction::Read, input, target);
            drop(pipeline);
            self.next_tuple += batch.consumed as u64;
            if batch.produced > 0 {
                if tuples == 1 {
                    self.node
                        .driving
                        .written
                        .read_back(input, &mut target[..output_size]);
                }
                if whole > 0 {
                    return Ok(batch.produced * output_size);
                }
                one.drain(..skip);
                self.rest = one;
                return Ok(self.take_rest(out));
            }
            if let Some(error) = batch.fault {
                return Err(error);
            }
        }
        Err(Error::WouldBlock)
    }
}

impl State for StateReader {
    /// Converted bytes from an offset, counted in converted bytes. 0 samples anew; the end is 0 bytes.
    ///
    /// Reading on where the last read ended goes on in the source where that ended; any other offset counts
    /// one tuple of the source for each converted one.
    fn read_at(&mut self, offset: u64, out: &mut [u8]) -> Result<usize, Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let size = self.node.description.output_tuple_size as u64;
        let mut skip = 0;
        if offset == 0 || offset != self.next_at {
            self.rest.clear();
            self.next_tuple = offset / size;
            skip = usize::try_from(offset % size).unwrap_or(0);
        }
        let mut filled = self.take_rest(out);
        while filled < out.len() {
            let made = if self.device.is_text() {
                self.convert_text(skip, &mut out[filled..])?
            } else {
                self.convert_next(skip, &mut out[filled..])?
            };
            skip = 0;
            filled += made;
            if made == 0 {
                break;
            }
        }
        self.next_at = offset + filled as u64;
        Ok(filled)
    }
}
