//! A machine whose past is kept: copied, and run again from what its robot has answered.
//!
//! Owns how a copy is made to run again. Its moments are the tokens to which a block is about to react.

use super::subject::{Here, Texts};
use super::trace::Trace;
use super::{Machine, stops};
use crate::program::NodeId;
use lang_diagram::brick::Brick;
use lang_diagram::debug::again::{Again, Asked, Begin};
use lang_diagram::debug::{Reason, Step};
use lang_diagram::machine::trace::Guard;
use lang_expr::Value;

/// A data-flow program has no threads: it is one.
const FLOW: u16 = 0;

/// Asks before each token.
struct Asking<'a>(&'a mut dyn Asked<Machine>);

impl Trace for Asking<'_> {
    fn holds(&mut self, machine: &Machine, next: Option<NodeId>) -> bool {
        let entering = next.map(|node| (FLOW, node));
        match self.0.asked(machine, entering) {
            Guard::Hold => true,
            // There are no threads that could be held alone.
            Guard::Go | Guard::HoldThread => false,
        }
    }
}

/// A step as it goes back or forth in the past.
#[derive(Clone, Copy, Debug)]
pub enum Walk {
    /// To the next reaction.
    Reaction,
    /// To one in another instant than this.
    Instant(u32),
}

impl Machine {
    /// The time of the program if a step came at this moment of the caller's clock.
    pub fn time_at(&self, now: u32) -> u32 {
        let Some(began) = self.began else {
            return self.now;
        };
        let stood = match self.was_stopped {
            true => now.saturating_sub(self.asked),
            false => 0,
        };
        let began = began.saturating_add(stood);
        now.saturating_sub(began).max(self.now)
    }

    /// What a step at this moment of the caller's clock begins with.
    pub fn begins(&self, now: u32) -> Begin {
        match self.is_amid {
            true => Begin::Rest,
            false => Begin::Step(self.time_at(now)),
        }
    }
}

impl Again for Machine {
    type Stop = stops::Stop;
    type Seen<'a> = Here<'a>;
    type Walk = Walk;

    fn ms(&self) -> u32 {
        self.now
    }

    fn bytes(&self) -> usize {
        const FIXED: usize = 4096;
        const NODE: usize = 256;
        /// An expression is compiled to some code for each of its letters.
        const LETTER: usize = 16;
        const CELL: usize = size_of::<Value>();
        let texts = self.program.formulas.iter();
        let texts = texts.map(|text| NODE + text.text.len() * LETTER);
        let names = self.variables().map(|(name, _)| name.len() + 2 * CELL);
        let remembered = self.states.iter().map(|state| state.memory.bytes());
        let deliveries = self.deliveries.iter();
        let on_way = deliveries.map(|(_, value)| CELL * (1 + value.cells() as usize));
        FIXED
            + self.program.nodes.len() * NODE
            + texts.sum::<usize>()
            + names.sum::<usize>()
            + self.formulas.cells() as usize * CELL
            + remembered.sum::<usize>()
            + on_way.sum::<usize>()
            // Also those that waits keep.
            + self.queued as usize * CELL
    }

    fn is_amid(&self) -> bool {
        self.stopped().is_some()
    }

    fn prepare(&mut self) {
        self.run_only_again();
        // Steps of the past are told in the time of the program.
        self.began = self.began.map(|_| 0);
        self.asked = self.now;
        self.was_stopped = false;
    }

    fn run_again(&mut self, begin: Begin, robot: &mut dyn Brick, asked: &mut dyn Asked<Self>) {
        if self.stopped().is_some() {
            self.go_on();
        }
        self.was_stopped = false;
        let now = match begin {
            Begin::Step(now) => now,
            Begin::Rest => self.now,
        };
        self.step(now, robot, &mut Asking(asked));
    }

    fn stop(&self, reason: Reason) -> stops::Stop {
        let next = self.deliveries.front().filter(|_| self.is_amid);
        stops::Stop {
            reason,
            next: next.cloned(),
        }
    }

    fn thread_of(stop: &stops::Stop) -> Option<u16> {
        stop.next.as_ref().map(|_| FLOW)
    }

    fn seen(&self) -> Here<'_> {
        Here {
            program: &self.program,
            formulas: Texts::Copied(&self.formulas, None),
            now: self.now,
            token: None,
        }
    }

    fn seen_at_block(&self) -> Here<'_> {
        Here {
            token: self.deliveries.front().map(|(_, token)| token),
            ..self.seen()
        }
    }

    fn walk(&self, _thread: Option<u16>, step: Step) -> Walk {
        match step {
            Step::Into | Step::Over => Walk::Reaction,
            Step::Out => Walk::Instant(self.now),
        }
    }

    fn is_end(&self, walk: Walk, _thread: u16) -> bool {
        match walk {
            Walk::Reaction => true,
            Walk::Instant(moment) => self.now != moment,
        }
    }
}
