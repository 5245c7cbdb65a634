//! Who drives a node: leases, a regulator in front of it, a regulator behind it.
//!
//! Owns the count of writes, the turn of those who write to a node that is regulated, and why a regulator gave up. The
//! rules of leases and of regulators are theirs; how a node comes to rest is in `rest`.

use super::Node;
use super::written::Written;
use crate::crew::lock_patiently;
use crate::errno::Error;
use crate::events::lock;
use crate::lease::Lease;
use crate::regulation::Regulation;
use config::description::{NodeDescription, SourceDescription};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard};

/// What a write to one node has to do with.
pub struct Driving {
    /// Who may write the files of the node's directory.
    pub lease: Arc<Lease>,
    /// The same, and those of the nodes that a write passes on its way to the device.
    pub leases: Vec<Arc<Lease>>,
    /// Only for the source `regulator{...}`.
    regulation: Option<Regulation>,
    /// A regulator drives this node.
    is_regulated: AtomicBool,
    turn: Mutex<()>,
    /// Why a regulator that drove this node gave up.
    lost: Mutex<Option<Error>>,
    /// How often a tuple went to the device. Wraps.
    writes: AtomicU32,
    /// What was written last.
    pub written: Written,
}

impl Driving {
    pub(super) fn new(
        description: &NodeDescription,
        links: &[(String, Arc<Node>)],
        lease: Arc<Lease>,
    ) -> Self {
        let source = &description.source;
        let linked = |path: &str| links.iter().find(|(name, _)| name == path);
        let regulation = match source {
            SourceDescription::Regulator(regulator) => {
                linked(&regulator.actuator).map(|(_, actuator)| Regulation::new(actuator.clone()))
            }
            _ => None,
        };
        let mut leases = vec![lease.clone()];
        if let Some((_, node)) = source.written_node().and_then(linked) {
            // One that stands for another node has its lease.
            let others = node.driving.leases.iter();
            leases.extend(others.filter(|other| !Arc::ptr_eq(other, &lease)).cloned());
        }
        Self {
            lease,
            leases,
            regulation,
            is_regulated: AtomicBool::new(false),
            turn: Mutex::default(),
            lost: Mutex::default(),
            writes: AtomicU32::new(0),
            written: Written::new(description.read_back),
        }
    }

    /// Holds what is written by driving another node.
    pub fn regulation(&self) -> Option<&Regulation> {
        self.regulation.as_ref()
    }

    /// Changes whenever a lease that a write to this node touches changes hands.
    pub fn lease_generation(&self) -> u32 {
        let generations = self.leases.iter().map(|lease| lease.generation());
        generations.fold(0, u32::wrapping_add)
    }

    /// A tuple went to the device.
    pub fn count_write(&self) {
        self.writes.fetch_add(1, Ordering::Relaxed);
        *lock(&self.lost) = None;
    }

    /// A regulator that drove this node had to give up: `fault` says why until somebody drives the node again.
    pub fn lose(&self, error: &Error) {
        *lock(&self.lost) = Some(error.clone());
    }

    /// Why the regulator of this node, or the one that drives it, gave up.
    pub fn lost(&self) -> Option<Error> {
        match &self.regulation {
            Some(regulation) => regulation.lost(),
            None => lock(&self.lost).clone(),
        }
    }
}

impl Node {
    /// How often a tuple went to the device, for an alias to the device of the node that it stands for. Wraps.
    pub fn writes(&self) -> u32 {
        self.driven().driving.writes.load(Ordering::Relaxed)
    }

    /// What is driven in the end: the node itself, or the one that it stands for.
    fn driven(&self) -> &Self {
        let mut node = self;
        while let SourceDescription::Node(link) = &node.description.source {
            match node.links.iter().find(|(name, _)| *name == link.path) {
                Some((_, other)) => node = other,
                None => break,
            }
        }
        node
    }

    /// From now on a regulator drives this node beside those who write to it.
    pub fn let_regulate(&self) {
        let driving = &self.driven().driving;
        driving.is_regulated.store(true, Ordering::Relaxed);
    }

    /// The right to write, alone, to a node that a regulator drives; others need none. A regulator that finds the node
    /// its own and writes must not come behind somebody who writes at that moment and has the last word.
    pub fn take_turn(&self) -> Option<MutexGuard<'_, ()>> {
        let driving = &self.driven().driving;
        let is_regulated = driving.is_regulated.load(Ordering::Relaxed);
        is_regulated.then(|| lock_patiently(&driving.turn))
    }
}
