//! A node's part of the sample bus: a ring of its samples, one of what is written to it, and one of what its source gives.
//!
//! Owns which of them a node has, and since when. They stand where samples, writes and bytes of the source pass; where their
//! files are is not known here.

use super::{Newest, too_old};
use crate::node::Node;
use config::description::Pace;

impl Newest {
    /// Takes the rings that the description asks for.
    pub(super) fn join_bus(&self, node: &Node) {
        if node.description.pace != Pace::OnRead {
            match node.engine.samples.ring(&node.description) {
                Ok(ring) => self.latch.set_ring(ring),
                Err(reason) => (node.engine.log).line(&format!("{}: {reason}", node.path())),
            }
            self.tell_bus_of_period(node);
        }
        if node.description.pace != Pace::OnRead && !node.is_attribute {
            match node.engine.samples.ring_of_raw(&node.description) {
                Ok(ring) => self.tap.set_ring(ring),
                Err(reason) => (node.engine.log).line(&format!("{}: {reason}", node.path())),
            }
        }
        if node.description.rest.is_some() {
            match node.engine.samples.ring_of_writes(&node.description) {
                Ok(ring) => node.driving.set_ring(ring),
                Err(reason) => (node.engine.log).line(&format!("{}: {reason}", node.path())),
            }
        }
    }

    pub(super) fn tell_bus_of_period(&self, node: &Node) {
        if let Some(age) = too_old(node) {
            self.latch.tell_ring_of_age(age);
        }
    }

    /// The bus has another directory: takes rings there. The former ones end first, because their end removes files of the same
    /// names.
    pub fn join_bus_again(&self) {
        self.leave_bus();
        if let Some(node) = self.node.upgrade() {
            self.join_bus(&node);
        }
    }

    /// Tuples of the source, which were converted at this moment, or the last of them refused; what they became is published
    /// after them.
    pub fn heard(&self, tuples: &[u8], tuple_size: usize, is_refused: bool) {
        self.tap.publish(tuples, tuple_size, is_refused);
    }

    /// Ends the node's part of the sample bus.
    pub fn leave_bus(&self) {
        self.latch.set_ring(None);
        self.tap.set_ring(None);
        if let Some(node) = self.node.upgrade() {
            node.driving.set_ring(None);
        }
    }
}
