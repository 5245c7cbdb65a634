//! What the past of a program asks of its machine: to be copied, and to be run again from a copy.
//!
//! Owns the border between the past, which is the same for both languages of blocks, and the machines of either.

use super::points::Subject;
use super::{Reason, Step, Stop};
use crate::brick::Brick;
use crate::machine::Machine;
use crate::machine::trace::{Guard, Moment, Trace};
use crate::program::Node;
use std::fmt::Debug;

/// What a step begins with.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Begin {
    /// A step at this time of the program.
    Step(u32),
    /// The rest of a step, in which the program was held and changed by a person.
    Rest,
}

/// Somebody who is asked whether a program that runs again goes on.
pub trait Asked<M> {
    /// A thread is about to enter a block, or none is.
    fn asked(&mut self, machine: &M, entering: Option<(u16, Node)>) -> Guard;
}

/// A machine that is deterministic given what its robot answers.
pub trait Again: Clone + Debug {
    /// Where it stands when it is stopped.
    type Stop: Clone + Debug;
    /// The machine as breakpoints see it.
    type Seen<'a>: Subject
    where
        Self: 'a;
    /// What decides where a step ends that begins somewhere.
    type Walk: Copy + Debug;

    /// Milliseconds of its time.
    fn ms(&self) -> u32;

    /// How much memory a copy takes, about.
    fn bytes(&self) -> usize;

    /// Whether it is held in the middle of a step.
    fn is_amid(&self) -> bool;

    /// Makes a copy ready to be run again: nobody but the one who is asked stops it.
    fn prepare(&mut self);

    /// Runs a step, or the rest of the one in which it is held.
    fn run_again(&mut self, begin: Begin, robot: &mut dyn Brick, asked: &mut dyn Asked<Self>);

    /// Where it stands.
    fn stop(&self, reason: Reason) -> Self::Stop;

    /// The thread at which it is stopped; none if nothing comes next.
    fn thread_of(stop: &Self::Stop) -> Option<u16>;

    /// How breakpoints at changes see it: nothing comes to a change.
    fn seen(&self) -> Self::Seen<'_>;

    /// How those at the block see it that a thread is about to enter.
    fn seen_at_block(&self) -> Self::Seen<'_>;

    /// A step that begins here.
    fn walk(&self, thread: Option<u16>, step: Step) -> Self::Walk;

    /// Whether it ends where a thread is about to enter a block.
    fn is_end(&self, walk: Self::Walk, thread: u16) -> bool;
}

/// A step at the end of which a thread has these calls.
#[derive(Clone, Copy, Debug)]
pub struct Ends {
    thread: Option<u16>,
    depth: usize,
    step: Step,
}

impl Again for Machine {
    type Stop = Stop;
    type Seen<'a> = &'a Self;
    type Walk = Ends;

    fn ms(&self) -> u32 {
        self.now()
    }

    fn bytes(&self) -> usize {
        self.weight()
    }

    fn is_amid(&self) -> bool {
        self.is_held()
    }

    fn prepare(&mut self) {
        self.set_guarded(true);
    }

    fn run_again(&mut self, begin: Begin, robot: &mut dyn Brick, asked: &mut dyn Asked<Self>) {
        let mut guarding = Guarding(asked);
        match (self.is_held(), begin) {
            (false, Begin::Step(now)) => self.step(now, robot, &mut guarding),
            // It was left in the middle of this step, or was held when it was copied.
            (true, Begin::Step(_) | Begin::Rest) | (false, Begin::Rest) => {
                self.go_on_held(robot, &mut guarding)
            }
        };
    }

    fn stop(&self, reason: Reason) -> Stop {
        let thread = self.held_thread();
        let node = self.views().find(|view| Some(view.number) == thread);
        Stop {
            reason,
            thread,
            node: node.map(|view| view.node),
        }
    }

    fn thread_of(stop: &Stop) -> Option<u16> {
        stop.thread
    }

    fn seen(&self) -> &Self {
        self
    }

    fn seen_at_block(&self) -> &Self {
        self
    }

    fn walk(&self, thread: Option<u16>, step: Step) -> Ends {
        let depth = thread.map_or(0, |thread| self.depth(thread));
        Ends {
            thread,
            depth,
            step,
        }
    }

    fn is_end(&self, walk: Ends, thread: u16) -> bool {
        let is_its = walk.thread.is_none_or(|wanted| wanted == thread);
        is_its && walk.step.ends_at(self.depth(thread), walk.depth)
    }
}

/// Asks before each block.
struct Guarding<'a>(&'a mut dyn Asked<Machine>);

impl Trace for Guarding<'_> {
    fn guard(&mut self, machine: &Machine, at: Moment) -> Guard {
        match at {
            Moment::Enters { thread, node } => self.0.asked(machine, Some((thread, node))),
            Moment::Between => self.0.asked(machine, None),
            Moment::Fails { .. } => Guard::Go,
        }
    }
}
