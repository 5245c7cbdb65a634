//! What was written to a node last: the base for writes of single numbers, and what `read_back` shows.
//!
//! Owns the rule of `read_back`: several tuples may become the same bytes of the device, and the one that was written
//! is shown for as long as the device gives the bytes that it sent. A rest, and other bytes from the device, end that.

use crate::events::lock;
use std::sync::Mutex;

/// The memory of one node's writes.
pub struct Written {
    /// The description asks for `read_back`.
    is_read_back: bool,
    last: Mutex<Option<Vec<u8>>>,
    sent: Mutex<Option<Sent>>,
}

/// A write that reached the device.
struct Sent {
    written: Vec<u8>,
    to_device: Vec<u8>,
}

impl Written {
    pub(super) fn new(is_read_back: bool) -> Self {
        Self {
            is_read_back,
            last: Mutex::default(),
            sent: Mutex::default(),
        }
    }

    /// Notes what was written last, for writes of single numbers.
    pub fn wrote(&self, tuple: Vec<u8>) {
        *lock(&self.last) = Some(tuple);
    }

    /// What was written last.
    pub fn last(&self) -> Option<Vec<u8>> {
        lock(&self.last).clone()
    }

    /// The device has the bytes that a written tuple became.
    pub fn sent(&self, written: &[u8], to_device: &[u8]) {
        if self.is_read_back {
            *lock(&self.sent) = Some(Sent {
                written: written.to_vec(),
                to_device: to_device.to_vec(),
            });
        }
    }

    /// From now on the device's answer counts.
    pub fn forget_sent(&self) {
        *lock(&self.sent) = None;
    }

    /// Replaces a converted tuple by the written one if the device gave the bytes that the write sent.
    pub fn read_back(&self, from_device: &[u8], converted: &mut [u8]) {
        if !self.is_read_back {
            return;
        }
        let mut sent = lock(&self.sent);
        let is_other = |sent: &Sent| sent.to_device != from_device;
        if sent.as_ref().is_some_and(is_other) {
            *sent = None;
        }
        if let Some(Sent { written, .. }) = &*sent {
            converted.copy_from_slice(written);
        }
    }
}
