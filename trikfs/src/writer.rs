//! The way from a program to a device: whole tuples through the converter to the sink.
//!
//! Owns the part of a tuple that has been written so far. Knows no request of the kernel.

use crate::convert::Pipeline;
use crate::device::Sink;
use crate::errno::Error;
use crate::events::lock;
use crate::node::Node;
use converter::Direction;
use std::sync::{Arc, Mutex};

/// One program's way to a device.
pub struct Writer {
    node: Arc<Node>,
    destination: Destination,
    partial: Vec<u8>,
    output: Vec<u8>,
}

/// What becomes of a written tuple.
enum Destination {
    /// It is converted and goes to the device.
    Device {
        sink: Box<dyn Sink>,
        pipeline: Arc<Mutex<Pipeline>>,
    },
    /// It is an order to the node's regulator.
    Regulation,
}

impl Writer {
    /// A writer to an open sink.
    pub fn new(node: Arc<Node>, sink: Box<dyn Sink>, pipeline: Arc<Mutex<Pipeline>>) -> Self {
        let output = vec![0; node.device_tuple_size()];
        Self {
            node,
            destination: Destination::Device { sink, pipeline },
            partial: Vec::new(),
            output,
        }
    }

    /// A writer to a node that holds what is written by driving another.
    pub fn to_regulation(node: Arc<Node>) -> Self {
        Self {
            node,
            destination: Destination::Regulation,
            partial: Vec::new(),
            output: Vec::new(),
        }
    }

    /// Takes bytes of a stream of tuples; each tuple that is complete goes to the device. Returns how many bytes
    /// were taken: fewer than given if a later tuple failed, whose error the next call meets again.
    pub fn write(&mut self, data: &[u8], waits: bool) -> Result<usize, Error> {
        let size = self.node.description.written_tuple_size();
        let mut taken = 0;
        while taken < data.len() {
            let missing = size - self.partial.len();
            let part = &data[taken..data.len().min(taken + missing)];
            if part.len() < missing {
                self.partial.extend_from_slice(part);
                return Ok(data.len());
            }
            let before = self.partial.len();
            self.partial.extend_from_slice(part);
            let tuple = std::mem::take(&mut self.partial);
            let sent = self.write_whole(&tuple, waits);
            self.partial = tuple;
            match sent {
                Ok(()) => {
                    self.partial.clear();
                    taken += part.len();
                }
                Err(error) => {
                    self.partial.truncate(before);
                    return if taken > 0 { Ok(taken) } else { Err(error) };
                }
            }
        }
        Ok(taken)
    }

    /// Sends exactly one tuple; `waits` as for [`Sink::write`].
    pub fn write_whole(&mut self, tuple: &[u8], waits: bool) -> Result<(), Error> {
        if self.node.is_retired() {
            return Err(Error::Stale);
        }
        let size = self.node.description.written_tuple_size();
        if tuple.len() != size {
            return Err(Error::Invalid(format!(
                "a tuple has {size} bytes, {} were written",
                tuple.len()
            )));
        }
        let (sink, pipeline) = match &mut self.destination {
            Destination::Device { sink, pipeline } => (sink, pipeline),
            Destination::Regulation => return self.node.driving.order(&self.node, tuple),
        };
        let batch = self.node.convert(
            &mut lock(pipeline),
            Direction::Write,
            tuple,
            &mut self.output,
        );
        if let Some(error) = batch.fault {
            return Err(error);
        }
        if batch.produced > 0 {
            sink.write(&self.output, waits).inspect_err(|error| {
                if *error != Error::WouldBlock {
                    self.node.report(error);
                }
            })?;
            self.node.driving.written.sent(tuple, &self.output);
            self.node.driving.went(tuple);
        }
        Ok(())
    }

    /// Bytes of a tuple that is not complete yet.
    pub fn incomplete(&self) -> usize {
        self.partial.len()
    }
}

impl Sink for Writer {
    fn write(&mut self, tuple: &[u8], waits: bool) -> Result<(), Error> {
        self.write_whole(tuple, waits)
    }
}
