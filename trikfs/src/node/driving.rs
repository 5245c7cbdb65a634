//! Who drives a node: leases, the regulator that takes what is written to it as orders, the regulator that drives it.
//!
//! Owns the count of writes, the turn of writers to a node that is regulated, and why a regulator gave up; no other
//! file asks a node whether it has a regulator. The rules of leases and of regulators are theirs; how a node comes to rest
//! is in `rest`. Knows no kind of source but by what its trait says that it drives.

use super::Node;
use super::written::Written;
use crate::clock::Stamp;
use crate::crew::lock_patiently;
use crate::device::{Drives, kinds};
use crate::errno::Error;
use crate::events::lock;
use crate::guardian::actions::RestAction;
use crate::lease::Lease;
use crate::regulation::Regulation;
use crate::sample_bus::Ring;
use config::description::NodeDescription;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

/// What a write to one node has to do with.
pub struct Driving {
    /// Who may write the files of the node's directory.
    pub lease: Arc<Lease>,
    /// The same, and those of the nodes that a write passes on its way to the device.
    pub leases: Vec<Arc<Lease>>,
    /// Only for a source that holds what is written.
    regulation: Option<Regulation>,
    /// A regulator drives this node.
    is_regulated: AtomicBool,
    turn: Mutex<()>,
    /// Why a regulator that drove this node gave up.
    lost: Mutex<Option<Error>>,
    /// A program was let in since the actuator came to rest.
    is_driven: AtomicBool,
    /// How often a tuple went to the device. Wraps.
    writes: AtomicU32,
    /// What was written last.
    pub written: Written,
    /// What is written, in shared memory.
    ring: Mutex<Option<Ring>>,
    /// The rest as the device gets it, if a converter on the way there is not in this process, and of which params it is.
    known_rest: Mutex<Option<(RestAction, u32)>>,
    /// One param after the other is changed, with what follows from it.
    pub(super) params_turn: Mutex<()>,
}

impl Driving {
    pub(super) fn new(
        description: &NodeDescription,
        links: &[(String, Arc<Node>)],
        lease: Arc<Lease>,
    ) -> Self {
        let source = &description.source;
        let linked = |path: &str| links.iter().find(|(name, _)| name == path);
        let regulation = match kinds::drives(source) {
            Drives::Held(actuator) => {
                linked(actuator).map(|(_, actuator)| Regulation::new(actuator.clone()))
            }
            Drives::Itself | Drives::Other(_) => None,
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
            is_driven: AtomicBool::new(false),
            writes: AtomicU32::new(0),
            written: Written::new(description.read_back),
            ring: Mutex::default(),
            known_rest: Mutex::default(),
            params_turn: Mutex::default(),
        }
    }

    /// The rest as the device gets it, if it must not depend on a converter; `params` says of which params it has to be.
    pub(super) fn known_rest(&self, params: u32) -> Option<RestAction> {
        let known = lock(&self.known_rest).clone();
        known.and_then(|(action, of)| (of == params).then_some(action))
    }

    /// Keeps that.
    pub(super) fn keep_rest(&self, action: &RestAction, params: u32) {
        *lock(&self.known_rest) = Some((action.clone(), params));
    }

    /// Whether the actuator may be anything but at rest.
    pub fn is_driven(&self) -> bool {
        self.is_driven.load(Ordering::SeqCst)
    }

    /// A program is let in, or the actuator comes to rest.
    pub(super) fn set_driven(&self, is_driven: bool) {
        self.is_driven.store(is_driven, Ordering::SeqCst);
    }

    /// What is written is an order to a regulator, which holds it by driving another node; no sink takes it.
    pub fn takes_orders(&self) -> bool {
        self.regulation.is_some()
    }

    /// A program wrote what is to be held; see [`Regulation::order`].
    pub fn order(&self, node: &Arc<Node>, tuple: &[u8]) -> Result<(), Error> {
        match &self.regulation {
            Some(regulation) => regulation.order(node, tuple),
            None => Err(Error::Internal("an order without a regulator".to_owned())),
        }
    }

    /// The node was measured: a regulator makes a step.
    pub fn measured(&self, node: &Node, tuple: &[u8]) {
        if let Some(regulation) = &self.regulation {
            regulation.step(node, tuple);
        }
    }

    /// Measuring the node failed: a regulator can hold nothing without it.
    pub fn not_measured(&self, node: &Node, error: &Error) {
        if let Some(regulation) = &self.regulation {
            regulation.fail(node, error);
        }
    }

    /// Nothing is held any more; what was driven stays as it is.
    pub fn release(&self) {
        if let Some(regulation) = &self.regulation {
            regulation.release();
        }
    }

    /// Brings to rest what a regulator drives; None for a node that takes no orders.
    pub fn rest_what_is_held(&self) -> Option<Result<(), Error>> {
        self.regulation.as_ref().map(Regulation::rest)
    }

    /// Changes whenever a lease that a write to this node touches changes hands.
    pub fn lease_generation(&self) -> u32 {
        let generations = self.leases.iter().map(|lease| lease.generation());
        generations.fold(0, u32::wrapping_add)
    }

    /// A tuple, as it was written, went to the device.
    pub fn went(&self, tuple: &[u8]) {
        self.passed();
        if let Some(ring) = &mut *lock(&self.ring) {
            ring.publish(Stamp::now(), tuple);
        }
    }

    /// A tuple went to the device, and as what it would have been written here is not known.
    fn passed(&self) {
        self.writes.fetch_add(1, Ordering::Relaxed);
        *lock(&self.lost) = None;
    }

    /// From now on everything that goes to the device is published in this ring, or in none.
    pub fn set_ring(&self, ring: Option<Ring>) {
        // Outside the lock: the end of a ring removes a file.
        let _before = std::mem::replace(&mut *lock(&self.ring), ring);
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

/// Another one has the turn.
pub(super) struct Taken;

impl Node {
    /// A tuple went to the device past the converters and nodes on its way: those see the write all the same.
    pub(super) fn went(&self, tuple: &[u8]) {
        self.driving.went(tuple);
        let driven = self.driven();
        if !std::ptr::eq(driven, self) {
            driven.driving.passed();
        }
    }

    /// How often a tuple went to the device, for an alias to the device of the node that it stands for. Wraps.
    pub fn writes(&self) -> u32 {
        self.driven().driving.writes.load(Ordering::Relaxed)
    }

    /// What is driven in the end: the node itself, or the one that it stands for.
    fn driven(&self) -> &Self {
        let mut node = self;
        while let Drives::Other(path) = kinds::drives(&node.description.source) {
            match node.links.iter().find(|(name, _)| name == path) {
                Some((_, other)) => node = other,
                None => break,
            }
        }
        node
    }

    /// From now on a regulator drives this node beside the programs that write to it.
    pub fn let_regulate(&self) {
        let driving = &self.driven().driving;
        driving.is_regulated.store(true, Ordering::Relaxed);
    }

    /// The right to write, alone, to a node that a regulator drives; others need none. A regulator that finds the node
    /// its own and writes must not come after a program that writes at that moment and has the last word.
    pub fn take_turn(&self) -> Option<MutexGuard<'_, ()>> {
        let driving = &self.driven().driving;
        let is_regulated = driving.is_regulated.load(Ordering::Relaxed);
        is_regulated.then(|| lock_patiently(&driving.turn))
    }

    /// The same, if nobody has it.
    pub(super) fn take_turn_at_once(&self) -> Result<Option<MutexGuard<'_, ()>>, Taken> {
        let driving = &self.driven().driving;
        if !driving.is_regulated.load(Ordering::Relaxed) {
            return Ok(None);
        }
        match driving.turn.try_lock() {
            Ok(turn) => Ok(Some(turn)),
            Err(TryLockError::Poisoned(poisoned)) => Ok(Some(poisoned.into_inner())),
            Err(TryLockError::WouldBlock) => Err(Taken),
        }
    }
}
