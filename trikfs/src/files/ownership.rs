//! Who drives an actuator: the program that wrote to it and still has the file open when it ends.
//!
//! Owns the rule of `rest` at a program's end. A program that closes the file itself has handed the actuator over
//! (`echo 50 > value` must last); one that exits or is killed with the file open has lost it, and the actuator comes
//! to rest. Of several processes that share the open file, the last one to close it counts.

use crate::node::Node;
use crate::process::is_ending;
use crate::transport::Caller;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};

/// What is known of the program behind one open file.
#[derive(Default)]
pub struct Ownership {
    has_written: AtomicBool,
    has_ended: AtomicBool,
}

impl Ownership {
    /// A write reached the node.
    pub fn wrote(&self) {
        self.has_written.store(true, Ordering::Relaxed);
    }

    /// A descriptor was closed by this caller.
    pub fn closed(&self, node: &Node, caller: Caller) {
        if node.description.rest.is_some() && self.has_written.load(Ordering::Relaxed) {
            self.has_ended
                .store(is_ending(caller.pid), Ordering::Relaxed);
        }
    }

    /// The last descriptor is gone.
    pub fn released(&self, node: &Arc<Node>) {
        if self.has_ended.load(Ordering::Relaxed) && !node.is_retired() {
            let outcome = node.rest();
            if let Err(error) = outcome {
                node.report(&error);
            }
        }
    }
}
