//! `stages`: the tuples of the newest sample on their way through the converters, for people who look for a mistake.
//!
//! Owns their text: a line for each, in hexadecimal, the source's own first and the value last. Reading it samples as a read of
//! `value` does; what is told was kept for the conversion anyway.

use super::OpenFile;
use crate::bytes::copy_at;
use crate::errno::Error;
use crate::events::lock;
use crate::limits::STAGE_BYTES_MAX;
use crate::node::Node;
use crate::transport::{Outcome, Transfer};
use std::sync::{Arc, Mutex};

/// One open file.
pub struct StagesFile {
    node: Arc<Node>,
    shown: Mutex<Vec<u8>>,
}

impl StagesFile {
    /// Opens it: from now on the node is needed, as by a reader of its value.
    pub fn open(node: &Arc<Node>) -> Result<Self, Error> {
        node.check_access(true, false)?;
        node.sampling.newest.join()?;
        Ok(Self {
            node: node.clone(),
            shown: Mutex::default(),
        })
    }
}

/// A line with the bytes of a tuple; of a large one its beginning, and dots.
fn line(tuple: &[u8], text: &mut Vec<u8>) {
    const DIGITS: &[u8; 16] = b"0123456789abcdef";
    for byte in tuple.iter().take(STAGE_BYTES_MAX) {
        text.extend([byte >> 4, byte & 15].map(|digit| DIGITS[usize::from(digit)]));
    }
    if tuple.len() > STAGE_BYTES_MAX {
        text.extend(b"...");
    }
    text.push(b'\n');
}

impl OpenFile for StagesFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        if request.offset == 0 {
            self.node.sampling.newest.refresh()?;
            let _inside = self.node.quarantine.enter()?;
            let mut text = Vec::new();
            let mut tell = |tuple: &[u8]| line(tuple, &mut text);
            self.node.sampling.newest.tell_stages(&mut tell);
            *lock(&self.shown) = text;
        }
        let shown = lock(&self.shown);
        Ok(Outcome::Done(copy_at(&shown, request.offset, out)))
    }

    fn held_bytes(&self) -> usize {
        let description = &self.node.description;
        let tuples = description.converter.len() + 1;
        let largest = description
            .input_tuple_size
            .max(description.output_tuple_size);
        2 * tuples * largest.min(STAGE_BYTES_MAX)
    }

    fn release(&self) {
        self.node.sampling.newest.leave();
    }
}
