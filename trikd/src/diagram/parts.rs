//! Parts of the robot as a diagram has found them, each once.
//!
//! Owns when one that was not there is looked for again: the tree may be on its way back after a crash, with all that was in
//! it. Knows no part.

use crate::limits;
use lang_diagram::ports::Port;
use std::collections::HashMap;
use std::time::{Duration, Instant};

/// Parts by their ports; of one that is not there, when it was looked for last.
#[derive(Debug)]
pub(super) struct Parts<T>(HashMap<Port, Result<T, Instant>>);

impl<T> Parts<T> {
    /// None is looked for yet.
    pub(super) fn new() -> Self {
        Self(HashMap::new())
    }

    /// The part at a port, which is looked for if that is due.
    pub(super) fn get(&mut self, port: Port, find: impl Fn() -> Option<T>) -> Option<&T> {
        let look = || find().ok_or_else(Instant::now);
        let part = self.0.entry(port).or_insert_with(look);
        let again = Duration::from_millis(limits::PART_LOOK_MS);
        if part.as_ref().is_err_and(|looked| looked.elapsed() >= again) {
            *part = look();
        }
        part.as_ref().ok()
    }
}
