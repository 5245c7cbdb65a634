//! Who drives an actuator: the program that wrote to it and still has the file open when it ends.
//!
//! Owns the rule of `rest` at a program's end. A program that closes the file itself has handed the actuator over
//! (`echo 50 > value` must last); one that exits or is killed with the file open has lost it, and the actuator comes
//! to rest. Of several processes that share the open file, the last one to close it counts.
//!
//! Also remembers which thread was let in by the leases last, so that only its first write has to be looked into.

use crate::errno::Error;
use crate::events::lock;
use crate::lease::Lease;
use crate::node::Node;
use crate::process::is_ending;
use crate::transport::Caller;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex};

/// What is known of the program that has one file open.
#[derive(Default)]
pub struct Ownership {
    has_ended: AtomicBool,
    /// The last write that was let in.
    admitted: Mutex<Option<Admitted>>,
}

struct Admitted {
    thread: u32,
    /// Of each lease of the node.
    generations: Vec<u32>,
}

/// A write that the leases let in, for as long as it lasts.
pub struct Admission<'a> {
    node: &'a Node,
    leases: &'a [Arc<Lease>],
    generations: Vec<u32>,
}

impl Drop for Admission<'_> {
    fn drop(&mut self) {
        // Once more: a rest that came before the bytes of this write has taken the note back.
        self.node.note_driven();
        for (lease, generation) in self.leases.iter().zip(&self.generations) {
            lease.wrote(*generation);
        }
    }
}

impl Ownership {
    /// Asks every lease that a write to the node touches. Keep the result until the device has the bytes.
    pub fn admit<'a>(&self, node: &'a Node, caller: Caller) -> Result<Admission<'a>, Error> {
        node.note_driven();
        let mut admission = Admission {
            node,
            leases: &node.driving.leases,
            generations: Vec::with_capacity(node.driving.leases.len()),
        };
        let mut admitted = lock(&self.admitted);
        let known = admitted.as_ref().filter(|last| last.thread == caller.pid);
        for (index, lease) in node.driving.leases.iter().enumerate() {
            let known = known.and_then(|last| last.generations.get(index).copied());
            let admitted = lease.admit(caller.pid, known);
            let admitted = admitted.inspect_err(|error| node.report(error))?;
            admission.generations.push(admitted);
        }
        *admitted = Some(Admitted {
            thread: caller.pid,
            generations: admission.generations.clone(),
        });
        Ok(admission)
    }

    /// A descriptor was closed by this caller.
    pub fn closed(&self, node: &Node, caller: Caller) {
        if node.description.rest.is_some() && lock(&self.admitted).is_some() {
            self.has_ended
                .store(is_ending(caller.pid), Ordering::Relaxed);
        }
    }

    /// The last descriptor is gone. A program that has lost the actuator to a lease since does not stop it any more.
    pub fn released(&self, node: &Arc<Node>) {
        if !self.has_ended.load(Ordering::Relaxed) || node.is_retired() {
            return;
        }
        let generation = lock(&self.admitted)
            .as_ref()
            .and_then(|last| last.generations.first().copied());
        if generation == Some(node.driving.lease.generation())
            && let Err(error) = node.rest()
        {
            node.report(&error);
        }
    }
}
