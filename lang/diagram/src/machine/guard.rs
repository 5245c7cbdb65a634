//! Machines that can be held: before a block, at an error, between threads.
//!
//! Owns how a machine stops in the middle of a step and goes on as if it had not. Whether it stops is decided by the
//! trace, which is asked by guarded machines alone, so that others pay a test of one flag for a block.

use super::threads::{Handle, State};
use super::trace::{Guard, Moment, Trace};
use super::{Deferred, Env, Machine, Status};
use crate::brick::Brick;
use crate::program::Node;

/// What is held: everything, at this thread or between threads.
#[derive(Clone, Copy, Debug)]
pub(super) struct Held {
    thread: Option<Handle>,
}

impl Machine {
    /// Whether the trace is asked before each block from now on.
    pub fn set_guarded(&mut self, is_guarded: bool) {
        self.is_guarded = is_guarded;
    }

    /// Whether the trace is asked before each block.
    pub fn is_guarded(&self) -> bool {
        self.is_guarded
    }

    /// Whether it is held in the middle of a step: steps do nothing then.
    pub fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// The thread at which it is held.
    pub fn held_thread(&self) -> Option<u16> {
        self.held?.thread.map(|handle| handle.slot)
    }

    /// Finishes the step in which it was held, or is held again. Without that it does nothing.
    pub fn go_on_held(&mut self, brick: &mut dyn Brick, trace: &mut dyn Trace) -> Status {
        if let Some(held) = self.held.take() {
            self.pass = held.thread;
            self.go_on(&mut Env { brick, trace });
        }
        self.status()
    }

    /// Lets a thread go on in the next step that was held alone; false if it was not.
    pub fn release(&mut self, thread: u16) -> bool {
        let handle = self.threads.handles().find_map(|(handle, found)| {
            (handle.slot == thread && found.state == State::Held).then_some(handle)
        });
        if let Some(handle) = handle
            && !self.is_released(handle)
        {
            self.deferred.push_back(Deferred::Released(handle));
        }
        handle.is_some()
    }

    fn is_released(&self, handle: Handle) -> bool {
        self.deferred
            .iter()
            .any(|deferred| matches!(deferred, Deferred::Released(found) if *found == handle))
    }

    /// Asks whether a thread may enter a block.
    #[cold]
    pub(super) fn holds(
        &mut self,
        handle: Handle,
        (from, node): (Option<Node>, Node),
        count: u32,
        env: &mut Env<'_>,
    ) -> bool {
        if self.pass.take() == Some(handle) {
            return false;
        }
        // The thread stands where it is, for a client that looks.
        self.save(handle, (from, node), count, State::Ready);
        let thread = handle.slot;
        match env.trace.guard(self, Moment::Enters { thread, node }) {
            Guard::Go => return false,
            Guard::Hold => {
                self.held = Some(Held {
                    thread: Some(handle),
                });
            }
            Guard::HoldThread => self.save(handle, (from, node), count, State::Held),
        }
        true
    }

    /// A thread has failed and ends, unless it is kept for somebody to look at.
    #[cold]
    pub(super) fn fail(
        &mut self,
        handle: Handle,
        at: (Option<Node>, Node),
        count: u32,
        env: &mut Env<'_>,
    ) {
        if !self.is_guarded || !self.holds_failed(handle, at, count, env) {
            self.end_thread(handle, env);
        }
    }

    #[cold]
    fn holds_failed(
        &mut self,
        handle: Handle,
        (from, node): (Option<Node>, Node),
        count: u32,
        env: &mut Env<'_>,
    ) -> bool {
        if self.threads.get(handle).is_none() {
            return false;
        }
        self.save(handle, (from, node), count, State::Failed);
        let thread = handle.slot;
        match env.trace.guard(self, Moment::Fails { thread, node }) {
            Guard::Go | Guard::HoldThread => false,
            Guard::Hold => {
                self.held = Some(Held {
                    thread: Some(handle),
                });
                true
            }
        }
    }

    /// Asks between threads.
    pub(super) fn holds_between(&mut self, env: &mut Env<'_>) -> bool {
        let is_held = env.trace.guard(self, Moment::Between) == Guard::Hold;
        if is_held {
            self.held = Some(Held { thread: None });
        }
        is_held
    }

    /// Reports that a thread waits, if it does.
    #[cold]
    pub(super) fn report_wait(&self, handle: Handle, env: &mut Env<'_>) {
        if let Some(thread) = self.threads.get(handle)
            && thread.state == State::Waiting
        {
            let waits = self.waits(thread.node);
            env.trace.waits(self.now, handle.slot, thread.node, waits);
        }
    }
}
