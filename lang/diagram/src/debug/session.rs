//! A program with its debugger: model time that stands still while the program is stopped.
//!
//! Owns the machine, the debugger and the time that was spent in stops. Whoever calls it gives the clock, as to a
//! machine, and decides what motors do at a stop.

use std::rc::Rc;

use super::{Breakpoint, Debugger, NoBreakpoint, Step, Stop};
use crate::brick::Brick;
use crate::machine::patch::{Patched, Refused, Version, WhenGone};
use crate::machine::trace::Trace;
use crate::machine::{Machine, Options, Status};
use crate::program::Program;
use lang_text::problem::Problem;

/// What a program in a debugger is doing.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "stops are rare")]
pub enum Phase {
    /// It runs.
    Runs,
    /// It is stopped, in the middle of a step or between two.
    Stopped(Stop),
    /// It has ended.
    Ended {
        /// When, in milliseconds since its first step.
        at: u32,
        /// Whether there were errors.
        with_errors: bool,
    },
}

/// A program with its debugger.
#[derive(Clone, Debug)]
pub struct Session {
    machine: Machine,
    debugger: Debugger,
    /// Milliseconds of the caller's clock that passed while it was stopped.
    stopped_ms: u32,
    /// When the present stop began, by the caller's clock.
    since: u32,
}

impl Session {
    /// A program before its first step.
    pub fn new(program: Rc<Program>, options: Options) -> Self {
        let mut machine = Machine::new(program, options);
        machine.set_guarded(true);
        Self {
            machine,
            debugger: Debugger::default(),
            stopped_ms: 0,
            since: 0,
        }
    }

    /// The machine, to be looked at.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }

    /// The debugger, to be told what to do.
    pub fn debugger(&mut self) -> &mut Debugger {
        &mut self.debugger
    }

    /// Adds a breakpoint; its number.
    ///
    /// # Errors
    /// [`NoBreakpoint`].
    pub fn add(&mut self, point: Breakpoint) -> Result<u32, NoBreakpoint> {
        self.debugger.add(self.machine.program(), point)
    }

    /// What it is doing.
    pub fn phase(&self) -> Phase {
        match (self.machine.status(), self.debugger.stop()) {
            (Status::Ended { at, with_errors }, _) => Phase::Ended { at, with_errors },
            (Status::Running, Some(stop)) => Phase::Stopped(stop.clone()),
            (Status::Running, None) => Phase::Runs,
        }
    }

    /// Runs what is due at a moment of the caller's clock, in milliseconds; while it is stopped, nothing is.
    pub fn step(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) -> Phase {
        if self.debugger.stop().is_none() {
            let now_there = now.saturating_sub(self.stopped_ms);
            let trace = &mut self.debugger.trace(trace);
            self.machine.step(now_there, brick, trace);
            self.note(now);
        }
        self.phase()
    }

    /// Goes on after a stop, at a moment of the caller's clock: finishes the step in which it was stopped, or stops again.
    pub fn go_on(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) -> Phase {
        if self.debugger.stop().is_some() {
            self.stopped_ms = self
                .stopped_ms
                .saturating_add(now.saturating_sub(self.since));
            self.debugger.go_on();
            let trace = &mut self.debugger.trace(trace);
            self.machine.go_on_held(brick, trace);
            self.note(now);
        }
        self.phase()
    }

    /// Goes on for a step of the thread at which it is stopped, or of another one that lives.
    pub fn walk(
        &mut self,
        (thread, step): (u16, Step),
        now: u32,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Phase {
        self.debugger.step(&self.machine, thread, step);
        self.go_on(now, brick, trace)
    }

    /// Lets a thread go on that was held alone, with the next step; false if it was not held.
    pub fn release(&mut self, name: &str) -> bool {
        self.debugger.let_thread(name);
        let number = self.machine.views().find(|view| view.name == name);
        let number = number.map(|view| view.number);
        number.is_some_and(|number| self.machine.release(number))
    }

    /// Assigns a variable the value of an expression.
    ///
    /// # Errors
    /// What is wrong with the expression, or with this value for this variable. Nothing has changed then.
    pub fn assign(
        &mut self,
        variable: &str,
        text: &str,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<(), Vec<Problem>> {
        let thread = self.machine.held_thread().unwrap_or(0);
        self.machine.assign(variable, text, thread, brick, trace)
    }

    /// Puts a new version in the place of the program.
    ///
    /// # Errors
    /// [`Refused`]; nothing has changed then.
    pub fn patch(
        &mut self,
        version: &Version,
        when_gone: WhenGone,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<Patched, Refused> {
        let patched = self.machine.patch(version, when_gone, brick, trace)?;
        self.debugger.bind(self.machine.program());
        Ok(patched)
    }

    fn note(&mut self, now: u32) {
        if self.debugger.stop().is_some() {
            self.since = now;
        }
    }
}
