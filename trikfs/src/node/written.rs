//! What was written to a node last: the base for writes of single numbers, and what `read_back` shows.
//!
//! Owns the rule of `read_back`: several tuples may become the same bytes of the device, and the one that was written
//! is shown for as long as the device gives the bytes that it sent. A rest, and other bytes from the device, end that.

use super::Node;
use crate::events::lock;
use config::format::Format;
use std::sync::Mutex;

/// The memory of one node's writes.
#[derive(Default)]
pub(super) struct Written {
    last: Mutex<Option<Vec<u8>>>,
    sent: Mutex<Option<Sent>>,
}

/// A write that reached the device.
struct Sent {
    written: Vec<u8>,
    to_device: Vec<u8>,
}

impl Node {
    /// Notes what was written last, for writes of single numbers.
    pub fn wrote(&self, tuple: Vec<u8>) {
        *lock(&self.driving.written.last) = Some(tuple);
    }

    /// What was written last, or else the newest sample if it has the shape of what is written.
    pub fn last_tuple(&self) -> Option<Vec<u8>> {
        if let Some(tuple) = lock(&self.driving.written.last).clone() {
            return Some(tuple);
        }
        let mut tuple = Vec::new();
        let newest = self.sampling.newest.get(&mut tuple).ok().flatten();
        newest
            .filter(|_| self.description.output_tuple_size == self.description.written_tuple_size())
            .map(|_| tuple)
    }

    /// Format of what programs write.
    pub fn written_format(&self) -> Format {
        if self.format.size() == self.description.written_tuple_size() {
            self.format.clone()
        } else {
            Format::bytes(self.description.written_tuple_size())
        }
    }

    /// The device has the bytes that a written tuple became.
    pub fn sent(&self, written: &[u8], to_device: &[u8]) {
        if self.description.read_back {
            *lock(&self.driving.written.sent) = Some(Sent {
                written: written.to_vec(),
                to_device: to_device.to_vec(),
            });
        }
    }

    /// From now on the device's answer counts.
    pub fn forget_sent(&self) {
        *lock(&self.driving.written.sent) = None;
    }

    /// Replaces a converted tuple by the written one if the device gave the bytes that the write sent.
    pub fn read_back(&self, from_device: &[u8], converted: &mut [u8]) {
        if !self.description.read_back {
            return;
        }
        let mut sent = lock(&self.driving.written.sent);
        let is_other = |sent: &Sent| sent.to_device != from_device;
        if sent.as_ref().is_some_and(is_other) {
            *sent = None;
        }
        if let Some(Sent { written, .. }) = &*sent {
            converted.copy_from_slice(written);
        }
    }
}
