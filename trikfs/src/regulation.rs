//! Regulators at work: what was ordered of a node is held by driving another one, step by step.
//!
//! Owns the order, the control law's pipeline and the way to the driven node. An order lasts until the node or the driven
//! node comes to rest, the feedback or the law fails, another program writes to the driven node, or a lease of either
//! changes hands. What is measured, and when, is the business of the node's sampling; the law is a converter like any other. The first step of an order is made when it is
//! given, with the newest sample, so that the program that gives it gets the error of the law or of the driven node.

use crate::clock::Stamp;
use crate::convert::Pipeline;
use crate::errno::{Blame, Error};
use crate::events::lock;
use crate::newest::{self, Needed};
use crate::node::Node;
use crate::writer::Writer;
use converter::Direction;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, TryLockError};

/// The regulator of one node.
pub struct Regulation {
    actuator: Arc<Node>,
    order: Mutex<Option<Order>>,
    /// Nothing is to be held any more, which the one that works at the order sees when it has done so.
    is_released: AtomicBool,
    owed: Mutex<Option<Owed>>,
}

/// A rest that the driven node did not take.
struct Owed {
    /// Why there is to be a rest.
    why: Error,
    /// How often the driven node had been written: a program that drives it since then owes nothing.
    writes: u32,
    /// Each sample is an attempt.
    _needed: Needed,
}

/// The order, for one who works at it: what is released meanwhile is dropped with this.
struct Slot<'a> {
    order: MutexGuard<'a, Option<Order>>,
    is_released: &'a AtomicBool,
}

impl Slot<'_> {
    fn drop_released(&mut self) {
        if self.is_released.swap(false, Ordering::SeqCst) {
            *self.order = None;
        }
    }
}

impl Drop for Slot<'_> {
    fn drop(&mut self) {
        self.drop_released();
    }
}

struct Order {
    target: Vec<u8>,
    law: Arc<Mutex<Pipeline>>,
    writer: Writer,
    /// When the step before was made.
    before: Option<Stamp>,
    /// How often the driven node had been written, our own writes included.
    writes: u32,
    /// Of the leases when the order was given.
    generation: u32,
    input: Vec<u8>,
    output: Vec<u8>,
    /// Each sample is a step.
    _needed: Needed,
}

impl Regulation {
    /// Nothing is ordered yet.
    pub fn new(actuator: Arc<Node>) -> Self {
        actuator.let_regulate();
        Self {
            actuator,
            order: Mutex::default(),
            is_released: AtomicBool::new(false),
            owed: Mutex::default(),
        }
    }

    /// A program wrote what is to be held. The law goes on if it is at work, else it begins afresh.
    ///
    /// # Errors
    /// What the law refuses as the caller's mistake; then what was held before is held on. Any other failure of the
    /// feedback, the law or the driven node; then nothing is held, and what was held before came to rest.
    pub fn order(&self, node: &Arc<Node>, target: &[u8]) -> Result<(), Error> {
        // The first step is made with a sample of now, also if nobody needed any before.
        let _needed = node.sampling.newest.needed();
        let mut slot = self.slot();
        let measured = node.sampling.newest.latch().sample(newest::too_old(node));
        let turn = self.actuator.take_turn();
        let before = match slot.order.as_mut() {
            Some(order) if self.is_mine(order, node) => {
                Some(std::mem::replace(&mut order.target, target.to_vec()))
            }
            _ => {
                *slot.order = Some(self.begin(node, target)?);
                None
            }
        };
        let Some(order) = slot.order.as_mut() else {
            return Ok(());
        };
        let outcome = match measured {
            Ok(Some(sample)) => order.step(node, &sample.tuple, slot.is_released),
            // The first sample makes the first step.
            Ok(None) => Ok(false),
            Err(error) => Err(error),
        };
        if let Ok(wrote) = outcome {
            order.count(wrote);
        }
        drop(turn);
        match (outcome, before) {
            (Ok(_), _) => {
                *lock(&self.owed) = None;
                Ok(())
            }
            (Err(error), Some(before)) if error.blame() == Blame::Caller => {
                order.target = before;
                Err(error)
            }
            (Err(error), before) => {
                *slot.order = None;
                drop(slot);
                // What this regulator did not drive yet is not to be touched.
                if before.is_some() {
                    self.stop(node, &error);
                }
                Err(error)
            }
        }
    }

    fn begin(&self, node: &Arc<Node>, target: &[u8]) -> Result<Order, Error> {
        let (input, output) = node.description.write_conversion_sizes();
        Ok(Order {
            target: target.to_vec(),
            law: node.open_pipeline()?,
            writer: self.actuator.open_writer(None)?,
            before: None,
            writes: self.writes(),
            generation: node.driving.lease_generation(),
            input: Vec::with_capacity(input),
            output: vec![0; output],
            _needed: node.sampling.newest.needed(),
        })
    }

    /// False when somebody drives the actuator directly, or has taken the lease.
    fn is_mine(&self, order: &Order, node: &Node) -> bool {
        order.writes == self.writes() && order.generation == node.driving.lease_generation()
    }

    fn slot(&self) -> Slot<'_> {
        let mut slot = Slot {
            order: lock(&self.order),
            is_released: &self.is_released,
        };
        slot.drop_released();
        slot
    }

    /// Nothing is held any more; the driven node stays as it is. Waits for nobody: a step may hang in a converter.
    pub fn release(&self) {
        match self.order.try_lock() {
            Ok(mut order) => *order = None,
            Err(TryLockError::Poisoned(poisoned)) => *poisoned.into_inner() = None,
            Err(TryLockError::WouldBlock) => self.is_released.store(true, Ordering::SeqCst),
        }
    }

    /// Nothing is held any more, and the driven node comes to rest.
    pub fn rest(&self) -> Result<(), Error> {
        self.release();
        self.actuator.rest()
    }

    /// The feedback was measured: one step of the law.
    pub fn step(&self, node: &Node, measured: &[u8]) {
        self.settle();
        let mut slot = self.slot();
        let Some(order) = slot.order.as_mut() else {
            return;
        };
        let turn = self.actuator.take_turn();
        if !self.is_mine(order, node) {
            *slot.order = None;
            return;
        }
        match order.step(node, measured, slot.is_released) {
            Ok(wrote) => order.count(wrote),
            Err(error) => {
                *slot.order = None;
                drop(turn);
                drop(slot);
                self.stop(node, &error);
            }
        }
    }

    /// The feedback failed: without it nothing can be held.
    pub fn fail(&self, node: &Node, error: &Error) {
        let order = self.slot().order.take();
        if order.is_some() {
            self.stop(node, error);
        } else {
            self.settle();
        }
    }

    fn stop(&self, node: &Node, error: &Error) {
        let path = self.actuator.path();
        let log = &node.engine.log;
        log.line(&format!("{}: {path} comes to rest: {error}", node.path()));
        *lock(&self.owed) = Some(Owed {
            why: error.clone(),
            writes: self.writes(),
            _needed: node.sampling.newest.needed(),
        });
        self.settle();
    }

    /// Brings the driven node to rest if that is owed. What did not go, as on a bus that does not answer, is tried again
    /// with each sample, until it goes or somebody drives the node.
    fn settle(&self) {
        let Some(debt) = lock(&self.owed).take() else {
            return;
        };
        let (writes, why) = (debt.writes, debt.why.clone());
        if writes != self.writes() {
            return;
        }
        if let Err(error) = self.actuator.rest() {
            self.actuator.report(&error);
            let mut owed = lock(&self.owed);
            if owed.is_none() && writes == self.writes() {
                *owed = Some(debt);
            }
        }
        self.actuator.driving.lose(&why);
    }

    /// Why the driven node came to rest, until it is driven again.
    pub fn lost(&self) -> Option<Error> {
        self.actuator.driving.lost()
    }

    /// Writes to what is driven in the end: an alias and its target are one.
    fn writes(&self) -> u32 {
        self.actuator.writes()
    }
}

impl Order {
    /// A write of our own is not one of somebody else.
    fn count(&mut self, wrote: bool) {
        self.writes = self.writes.wrapping_add(wrote.into());
    }

    /// True if the driven node was written: a law may give nothing, or take so long that the order is released meanwhile.
    fn step(
        &mut self,
        node: &Node,
        measured: &[u8],
        is_released: &AtomicBool,
    ) -> Result<bool, Error> {
        let now = Stamp::now();
        let interval_us = self.before.map_or(0, |before| {
            u32::try_from(now.0.saturating_sub(before.0) / 1000).unwrap_or(u32::MAX)
        });
        self.before = Some(now);
        self.input.clear();
        self.input.extend_from_slice(&self.target);
        self.input.extend_from_slice(measured);
        self.input.extend_from_slice(&interval_us.to_le_bytes());
        let mut law = lock(&self.law);
        let batch = node.convert(&mut law, Direction::Write, &self.input, &mut self.output);
        drop(law);
        if let Some(error) = batch.fault {
            return Err(error);
        }
        let writes = batch.produced > 0 && !is_released.load(Ordering::SeqCst);
        if writes {
            self.writer.write_whole(&self.output, true)?;
        }
        Ok(writes)
    }
}
