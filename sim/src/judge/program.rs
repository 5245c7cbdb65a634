//! What drives a robot while it is judged: a diagram, or a program in a language with text.
//!
//! Owns the border between the judge and whatever runs. Model time moves only between steps, so a program is as
//! repeatable as its steps are.

use lang_diagram::brick::Brick;
use lang_diagram::machine::trace::Deaf;
use lang_diagram::machine::{Machine, Options, Status};
use lang_diagram::program::Program as Lowered;
use lang_text::problem::Problem;
use std::rc::Rc;

/// A program under judgement.
pub trait Program {
    /// Runs what is due at a moment, in milliseconds of model time: 0 first, then every 10 ms, after the world has moved.
    /// What it tells the robot shows in the next ticks of the world. Returns when the program waits for a later moment,
    /// or after a bounded piece of work.
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status;

    /// What of it still runs in the tick in which the rules have decided.
    fn last_tick(&mut self, _now_ms: u32, _robot: &mut dyn Brick) {}

    /// Ends it from outside: motors off, nothing runs any more.
    fn stop(&mut self, robot: &mut dyn Brick);

    /// What went wrong in it so far, in order; it only grows.
    fn errors(&self) -> &[Problem];

    /// Why it cannot even begin.
    fn refusal(&self) -> Option<&Problem> {
        None
    }

    /// Whether it was ended because it took too much real time, which says nothing of the task.
    fn is_out_of_time(&self) -> bool {
        false
    }
}

/// A diagram as a program, with the oddities of the original's simulator.
#[derive(Debug)]
pub struct Diagram {
    machine: Machine,
}

impl Diagram {
    /// Before its first step.
    pub fn new(program: Rc<Lowered>) -> Self {
        Self {
            machine: Machine::new(program, Options::simulated()),
        }
    }

    /// The machine, for its variables.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }
}

impl Program for Diagram {
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status {
        self.machine.step(now_ms, robot, &mut Deaf)
    }

    fn last_tick(&mut self, now_ms: u32, robot: &mut dyn Brick) {
        self.machine.last_tick(now_ms, robot, &mut Deaf);
    }

    fn stop(&mut self, robot: &mut dyn Brick) {
        self.machine.stop(robot, &mut Deaf);
    }

    fn errors(&self) -> &[Problem] {
        self.machine.errors()
    }

    fn refusal(&self) -> Option<&Problem> {
        self.machine.program().refusal()
    }
}
