//! What a step still has to do, as data: clocks, the beginning, what was posted and put off, threads to lead on.
//!
//! Owns the order of a step, which is the original's, and the loop that works it off. Because nothing of it is on the
//! stack of the processor, a machine can be held between any two blocks, copied there, and go on later. Knows no
//! operations: `flow` runs the threads.

use std::collections::VecDeque;

use super::threads::{Handle, State};
use super::{Deferred, Env, Machine, TURN_MS};
use crate::program::Node;

/// A piece of a step. The last one in the list is next; each puts what must follow it below what it leads to.
#[derive(Clone, Debug)]
pub(super) enum Work {
    /// Time passes: readings from outside, then clocks, then sensor variables.
    Tick { elapsed: u32 },
    /// The clocks of blocks that come after one, in the order of blocks.
    Clocks { after: Option<Node>, elapsed: u32 },
    /// The clocks of these blocks: what a patch has left of those above.
    Listed { nodes: VecDeque<Node>, elapsed: u32 },
    /// Sensor variables, and the blocks that wait for sensors.
    Sensors { elapsed: u32 },
    /// The beginning of the program, if it is due.
    Beginning,
    /// The threads of the beginning have run.
    Begun,
    /// What is to follow the events of this step, and then what had to wait for a turn.
    Events,
    /// Blocks that are done with waiting.
    Posted,
    /// What had to wait for a turn begins; so many of them were there before the posted ones.
    Due { count: usize },
    /// So many of those are left.
    Turn { left: usize },
    /// Blocks that were put off are done, and those of their kind that come right after them.
    Follow { blocks: VecDeque<Node> },
    /// What the block before has put off since there were so many.
    Followed {
        blocks: VecDeque<Node>,
        before: usize,
    },
    /// Threads that have run long enough while blocks followed each other.
    Soon,
    /// The rest of the threads that waited at a node go on at another one.
    Lead {
        node: Node,
        next: Node,
        handles: VecDeque<Handle>,
    },
}

impl Machine {
    /// Works off what the step has still to do, until it is done or a thread is held.
    pub(super) fn go_on(&mut self, env: &mut Env<'_>) {
        loop {
            self.drive(env);
            if self.held.is_some() || (self.is_guarded && self.holds_between(env)) {
                return;
            }
            match self.agenda.pop() {
                Some(work) => self.work(work, env),
                None => return,
            }
        }
    }

    fn work(&mut self, work: Work, env: &mut Env<'_>) {
        match work {
            Work::Tick { elapsed } => {
                if elapsed > 0 {
                    self.hear_announced(env);
                    self.tick(elapsed, env);
                }
            }
            Work::Clocks { after, elapsed } => self.next_clocks(after, elapsed, env),
            Work::Listed { mut nodes, elapsed } => {
                if let Some(node) = nodes.pop_front() {
                    self.plan(Work::Listed { nodes, elapsed });
                    if self.clock_is_due(node, elapsed) {
                        self.ring(node, env);
                    }
                }
            }
            Work::Sensors { elapsed } => self.sense(elapsed, env),
            Work::Beginning => self.beginning(env),
            Work::Begun => self.is_beginning = false,
            Work::Events => {
                let count = self.deferred.len();
                if self.posted.is_empty() && self.has_nothing_between() {
                    self.due(count);
                } else {
                    self.plan(Work::Due { count });
                    self.plan(Work::Posted);
                }
            }
            Work::Posted => {
                if let Some(node) = self.posted.pop_front() {
                    self.plan(Work::Posted);
                    self.done(node);
                }
            }
            Work::Due { count } => self.due(count),
            Work::Turn { left } => self.next_of_turn(left),
            Work::Follow { mut blocks } => {
                if let Some(node) = blocks.pop_front() {
                    let before = self.deferred.len();
                    self.plan(Work::Followed { blocks, before });
                    self.done(node);
                }
            }
            Work::Followed { blocks, before } => self.followed(blocks, before),
            Work::Soon => {
                if let Some(handle) = self.soon.pop_front() {
                    self.plan(Work::Soon);
                    self.resume(handle);
                }
            }
            Work::Lead {
                node,
                next,
                handles,
            } => self.lead_next(node, next, handles),
        }
    }

    /// Comes next, before all that was planned before; after the end of the program nothing does.
    pub(super) fn plan(&mut self, work: Work) {
        if self.ended.is_none() {
            self.agenda.push(work);
        }
    }

    /// Whether a piece that follows another would come right after it: no thread is to run before, and nobody asks to hold
    /// the machine there. Most steps of a program find nothing to do; then the pieces of a step need not be planned to be
    /// worked off at once, which costs more than the pieces themselves.
    fn has_nothing_between(&self) -> bool {
        self.active.is_empty() && !self.is_guarded && self.ended.is_none()
    }

    fn tick(&mut self, elapsed: u32, env: &mut Env<'_>) {
        if !self.has_nothing_between() {
            self.plan(Work::Sensors { elapsed });
            self.plan(Work::Clocks {
                after: None,
                elapsed,
            });
            return;
        }
        match self.due_clock(None, elapsed) {
            None => self.sense(elapsed, env),
            Some(node) => {
                self.plan(Work::Sensors { elapsed });
                self.plan(Work::Clocks {
                    after: Some(node),
                    elapsed,
                });
                self.ring(node, env);
            }
        }
    }

    fn next_clocks(&mut self, after: Option<Node>, elapsed: u32, env: &mut Env<'_>) {
        if let Some(node) = self.due_clock(after, elapsed) {
            self.plan(Work::Clocks {
                after: Some(node),
                elapsed,
            });
            self.ring(node, env);
        }
    }

    /// Lets time pass for the clocks after one, up to the first that is due.
    fn due_clock(&mut self, mut after: Option<Node>, elapsed: u32) -> Option<Node> {
        loop {
            after = self.next_clock(after);
            if self.clock_is_due(after?, elapsed) {
                return after;
            }
        }
    }

    fn sense(&mut self, elapsed: u32, env: &mut Env<'_>) {
        if self.sensors.are_due(elapsed) {
            self.sensors.refresh(env.brick);
            self.answer_waits(env);
        }
    }

    /// What had to wait for a turn begins; so many of them were there before the posted ones.
    ///
    /// What the posted ones put off waits for the next step; but the original's simulator comes through its event loop
    /// once more after each third step, and there it does not wait.
    fn due(&mut self, count: usize) {
        let is_turn = !self.options.in_turns || self.now.is_multiple_of(TURN_MS);
        let left = if is_turn { self.deferred.len() } else { count };
        if left > 0 || !self.soon.is_empty() {
            self.plan(Work::Turn { left });
        }
    }

    fn beginning(&mut self, env: &mut Env<'_>) {
        let is_due = |until| self.now >= until;
        if self.kept.as_ref().is_none_or(|(_, until)| !is_due(*until)) {
            return;
        }
        if let Some((chain, _)) = self.kept.take() {
            if let Some(problem) = self.unfit.take() {
                self.report(problem, env);
                self.end_all(env);
                return;
            }
            self.active = chain;
            self.is_beginning = true;
            self.plan(Work::Begun);
        }
    }

    /// The original takes posted events before its timers, and a thread that has run long enough waits for a timer: one
    /// that a block has just led on comes in the same pass, one that a timer has led on in the next.
    fn next_of_turn(&mut self, left: usize) {
        let next = match left {
            0 => None,
            _ => self.deferred.pop_front(),
        };
        let Some(next) = next else {
            if !self.soon.is_empty() {
                self.plan(Work::Soon);
            }
            return;
        };
        self.plan(Work::Turn { left: left - 1 });
        match next {
            Deferred::Block(node) => self.plan(Work::Follow {
                blocks: VecDeque::from([node]),
            }),
            Deferred::Thread(handle) => self.resume(handle),
            Deferred::Released(handle) => self.let_go(handle),
        }
    }

    /// Blocks that the one before has put off are done too: the original posts them to the same pass. Threads that have
    /// run long enough meanwhile come soon.
    fn followed(&mut self, mut blocks: VecDeque<Node>, before: usize) {
        let from = before.min(self.deferred.len());
        let mut threads = Vec::new();
        for deferred in self.deferred.split_off(from) {
            match deferred {
                Deferred::Thread(handle) => threads.push(handle),
                Deferred::Block(node) => blocks.push_back(node),
                released @ Deferred::Released(_) => self.deferred.push_back(released),
            }
        }
        for handle in threads.into_iter().rev() {
            self.soon.push_front(handle);
        }
        if !blocks.is_empty() {
            self.plan(Work::Follow { blocks });
        }
    }

    /// A thread that has run long enough goes on.
    fn resume(&mut self, handle: Handle) {
        if let Some(thread) = self.threads.get_mut(handle)
            && matches!(thread.state, State::Deferred)
        {
            thread.state = State::Resumed;
            self.active.push(handle);
        }
    }

    /// A thread that was held alone goes on.
    fn let_go(&mut self, handle: Handle) {
        if let Some(thread) = self.threads.get_mut(handle)
            && matches!(thread.state, State::Held)
        {
            thread.state = State::Ready;
            self.pass = Some(handle);
            self.active.push(handle);
        }
    }

    /// A block that made threads wait is done: they go on, one after another, in the order in which they came.
    pub(super) fn done(&mut self, node: Node) {
        if let Some(next) = self.next_of(node) {
            self.lead(node, next);
        }
    }

    /// Leads all threads that wait at a node to another one.
    pub(super) fn lead(&mut self, node: Node, next: Node) {
        let handles = self.threads.waiting_at(node).into();
        self.plan(Work::Lead {
            node,
            next,
            handles,
        });
    }

    fn lead_next(&mut self, node: Node, next: Node, mut handles: VecDeque<Handle>) {
        while let Some(handle) = handles.pop_front() {
            if let Some(thread) = self.threads.get_mut(handle)
                && thread.is_waiting_at(node)
            {
                thread.go(next);
                self.active.push(handle);
                if !handles.is_empty() {
                    self.plan(Work::Lead {
                        node,
                        next,
                        handles,
                    });
                }
                return;
            }
        }
    }
}
