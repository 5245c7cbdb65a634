//! Clocks of blocks that wait: one for each block, in the order of blocks, counted in steps.
//!
//! Owns their table and when they are due. A clock that is set within a step counts that step if its block comes later
//! than the one whose clock rang: as the original's timers do, because they are connected in the order of blocks.

use super::Machine;
use crate::program::Node;

/// What a clock is for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Purpose {
    /// The block Timer.
    Timer,
    /// A sensor is asked.
    Watch,
    /// All buttons are asked.
    AnyButton,
    /// The mailbox is asked.
    Mail,
    /// A person is asked.
    Ask,
}

/// The clock of a block.
#[derive(Clone, Copy, Debug)]
pub(super) struct Clock {
    pub node: Node,
    pub purpose: Purpose,
    /// Milliseconds that have passed.
    past: u32,
    /// Milliseconds to wait; nothing and less count as one step.
    wait: i32,
}

impl Clock {
    /// Milliseconds until it rings.
    pub fn left_ms(&self) -> u32 {
        u32::try_from(self.wait)
            .unwrap_or(0)
            .saturating_sub(self.past)
    }
}

impl Machine {
    /// Sets the clock of a block, anew if it runs.
    pub(super) fn set_clock(&mut self, node: Node, purpose: Purpose, wait: i32) {
        let clock = Clock {
            node,
            purpose,
            past: 0,
            wait,
        };
        match self.clocks.binary_search_by_key(&node, |clock| clock.node) {
            Ok(at) => self.clocks[at] = clock,
            Err(at) => self.clocks.insert(at, clock),
        }
    }

    /// Takes a clock away.
    pub(super) fn drop_clock(&mut self, node: Node) {
        if let Ok(at) = self.clocks.binary_search_by_key(&node, |clock| clock.node) {
            self.clocks.remove(at);
        }
    }

    pub(super) fn clock(&self, node: Node) -> Option<Clock> {
        let at = self.clocks.binary_search_by_key(&node, |clock| clock.node);
        at.ok().map(|at| self.clocks[at])
    }

    /// The first block after another one whose clock runs.
    pub(super) fn next_clock(&self, after: Option<Node>) -> Option<Node> {
        let from = match after {
            None => 0,
            Some(after) => self.clocks.partition_point(|clock| clock.node <= after),
        };
        self.clocks.get(from).map(|clock| clock.node)
    }

    /// Lets time pass for a clock. One that is due begins again.
    pub(super) fn clock_is_due(&mut self, node: Node, elapsed: u32) -> bool {
        let Ok(at) = self.clocks.binary_search_by_key(&node, |clock| clock.node) else {
            return false;
        };
        let clock = &mut self.clocks[at];
        clock.past = clock.past.saturating_add(elapsed);
        let is_due = i64::from(clock.past) >= i64::from(clock.wait);
        if is_due {
            clock.past = 0;
        }
        is_due
    }
}
