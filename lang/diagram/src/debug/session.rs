//! A program with its debugger: model time that stands still while the program is stopped.
//!
//! Owns the machine, the debugger, its past, and the time that was spent in stops. The caller gives the clock, as to
//! a machine, and decides what motors do at a stop.

use std::rc::Rc;

use super::again::Begin;
use super::answers::Noting;
use super::hindsight::{Hindsight, Present};
use super::past::{Back, NoBack};
use super::{Breakpoint, Debugger, NoBreakpoint, Step, Stop, report, words};
use crate::brick::Brick;
use crate::machine::patch::{Patched, Refused, Version, WhenGone};
use crate::machine::trace::Trace;
use crate::machine::{Machine, Options, Status};
use crate::program::Program;
use lang_text::problem::{Locale, Problem};

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

/// Why a program is not changed.
#[derive(Clone, Debug, PartialEq)]
pub enum NotNow {
    /// Somebody looks at its past, which is as it was.
    Past,
    /// It has ended.
    Ended,
    /// What is asked for is wrong.
    Problems(Vec<Problem>),
}

impl NotNow {
    /// For a person, a line for each problem.
    pub fn in_locale(&self, locale: Locale) -> String {
        match self {
            Self::Past => words::past().in_locale(locale).to_owned(),
            Self::Ended => words::ended().in_locale(locale).to_owned(),
            Self::Problems(problems) => report::problems(problems, locale),
        }
    }
}

/// A program with its debugger.
#[derive(Clone, Debug)]
pub struct Session {
    machine: Machine,
    debugger: Debugger,
    hindsight: Hindsight<Machine>,
    /// Milliseconds of the caller's clock that passed while it was stopped.
    stopped_ms: u32,
    /// When the present stop began, by the caller's clock.
    since: u32,
}

impl Session {
    /// A program before its first step, with a debugger attached.
    pub fn new(program: Rc<Program>, options: Options) -> Self {
        let mut session = Self::alone(Machine::new(program, options));
        session.attach();
        session
    }

    /// A program that runs as if there were no debugger, until one is attached.
    pub fn alone(machine: Machine) -> Self {
        Self {
            machine,
            debugger: Debugger::default(),
            hindsight: Hindsight::default(),
            stopped_ms: 0,
            since: 0,
        }
    }

    /// Whether a debugger is attached.
    pub fn is_attached(&self) -> bool {
        self.machine.is_guarded()
    }

    /// Attaches a debugger that has been asked for nothing.
    pub fn attach(&mut self) {
        self.machine.set_guarded(true);
    }

    /// Takes the debugger away with all that it was asked for, and forgets the past. A program that was stopped goes on
    /// from the next [`Session::step`] on, which comes at a moment of the caller's clock.
    pub fn detach(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        for name in self.debugger.held_names() {
            self.release(&name);
        }
        self.debugger.forget();
        self.hindsight = Hindsight::default();
        self.machine.set_guarded(false);
        self.go_on(now, brick, trace);
    }

    /// Keeps the past from now on, in about so many bytes.
    pub fn keep(&mut self, bytes_max: usize) {
        self.hindsight.keep(bytes_max);
    }

    /// When the past begins that is kept, in milliseconds of the program, and how many bytes it takes.
    pub fn kept(&self) -> Option<(u32, usize)> {
        self.hindsight.kept()
    }

    /// The machine, to be looked at; in the past the one that was.
    pub fn machine(&self) -> &Machine {
        let shown = self.hindsight.shown();
        shown.map_or(&self.machine, |(machine, _)| machine)
    }

    /// The machine as it is, also while a client looks at its past.
    pub fn live(&self) -> &Machine {
        &self.machine
    }

    /// The clocks of a moment at which the program is being stopped, as [`Machine::last_tick`] has it.
    pub fn last_tick(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        self.machine.last_tick(now, brick, trace);
    }

    /// Whether somebody looks at the past.
    pub fn is_past(&self) -> bool {
        self.hindsight.is_past()
    }

    /// The debugger, to be told what to do.
    pub fn debugger(&mut self) -> &mut Debugger {
        &mut self.debugger
    }

    /// Where the program is stopped, in the past if somebody looks at that.
    pub fn stop(&self) -> Option<&Stop> {
        let shown = self.hindsight.shown();
        shown.map(|(_, stop)| stop).or(self.debugger.stop())
    }

    /// Adds a breakpoint; its number.
    ///
    /// # Errors
    /// [`NoBreakpoint`].
    pub fn add(&mut self, point: Breakpoint) -> Result<u32, NoBreakpoint> {
        self.debugger.add(&self.machine, point)
    }

    /// What it is doing, whether or not somebody looks at the past.
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
            self.advance(Begin::Step(now_there), brick, trace);
            self.note(now);
        }
        self.phase()
    }

    /// Goes on after a stop, at a moment of the caller's clock: finishes the step in which it was stopped, or stops again.
    /// A client that looks at the past is back in the present after that.
    pub fn go_on(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) -> Phase {
        self.hindsight.to_present();
        if self.debugger.stop().is_some() {
            self.stopped_ms = self
                .stopped_ms
                .saturating_add(now.saturating_sub(self.since));
            self.debugger.go_on();
            self.advance(Begin::Rest, brick, trace);
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

    /// Runs a step of the machine or the rest of one; what the robot answers is noted if the past is kept.
    fn advance(&mut self, begin: Begin, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        let run = |machine: &mut Machine, brick: &mut dyn Brick, trace: &mut dyn Trace| match begin
        {
            Begin::Step(now) => machine.step(now, brick, trace),
            Begin::Rest => machine.go_on_held(brick, trace),
        };
        if !self.machine.is_guarded() {
            run(&mut self.machine, brick, trace);
            return;
        }
        let next = self.debugger.entered;
        let Some(notes) = self.hindsight.begin(&self.machine, begin, next) else {
            run(&mut self.machine, brick, &mut self.debugger.trace(trace));
            self.debugger.held_at.clear();
            return;
        };
        let mut noting = Noting {
            robot: brick,
            notes,
        };
        run(
            &mut self.machine,
            &mut noting,
            &mut self.debugger.trace(trace),
        );
        let held_at = self.debugger.held_at.drain(..);
        self.hindsight.end(!self.machine.is_held(), held_at);
    }

    /// Goes back, however long the search takes. The program itself stays where it is stopped.
    ///
    /// # Errors
    /// [`NoBack`]; then nothing has changed.
    pub fn back(&mut self, how: Back) -> Result<&Stop, NoBack> {
        self.begin_back(how)?;
        while self.search_on() {}
        let shown = self.hindsight.shown();
        shown.map(|(_, stop)| stop).ok_or(NoBack::NotKept)
    }

    /// Begins to go back; [`Session::search_on`] goes on with it.
    ///
    /// # Errors
    /// [`NoBack`]; then nothing has changed.
    pub fn begin_back(&mut self, how: Back) -> Result<(), NoBack> {
        if self.hindsight.is_kept() && self.phase() == Phase::Runs {
            return Err(NoBack::Runs);
        }
        let present = Present {
            machine: &self.machine,
            at: self.debugger.present(),
            stop: self.debugger.stop(),
        };
        self.hindsight.begin_back(how, &present)
    }

    /// Goes forth in the past, by a step or to the next breakpoint; false: this is the present now.
    pub fn forth(&mut self, step: Option<Step>) -> bool {
        self.begin_forth(step);
        while self.search_on() {}
        self.is_past()
    }

    /// Begins to go forth in the past; [`Session::search_on`] goes on with it.
    pub fn begin_forth(&mut self, step: Option<Step>) {
        let present = Present {
            machine: &self.machine,
            at: self.debugger.present(),
            stop: self.debugger.stop(),
        };
        self.hindsight.begin_forth(step, &present);
    }

    /// Whether a search through the past goes on.
    pub fn is_searching(&self) -> bool {
        self.hindsight.is_searching()
    }

    /// Does a piece of a search through the past, in bounded time; whether there is more to do.
    pub fn search_on(&mut self) -> bool {
        self.hindsight.search_on(&self.debugger.points)
    }

    /// Ends a search: what is looked at stays where it was begun.
    pub fn give_up_search(&mut self) -> bool {
        self.hindsight.give_up_search()
    }

    /// Leaves the past.
    pub fn to_present(&mut self) {
        self.hindsight.to_present();
    }

    /// Holds a thread when it enters its next block, and lets the others go on.
    ///
    /// # Errors
    /// There are too many that are held.
    pub fn hold(&mut self, name: &str) -> Result<(), NoBreakpoint> {
        self.debugger.hold_thread(name)
    }

    /// Names of the threads that are held alone, or will be at their next block.
    pub fn held(&self) -> impl Iterator<Item = &str> {
        self.debugger.held_alone.iter().map(|name| &**name)
    }

    /// Lets a thread go on that was held alone, with the next step, or was to be; false if it was neither.
    pub fn release(&mut self, name: &str) -> bool {
        let was_meant = self.debugger.let_thread(name);
        self.changes();
        let number = self.machine.views().find(|view| view.name == name);
        let number = number.map(|view| view.number);
        let was_held = number.is_some_and(|number| self.machine.release(number));
        was_meant || was_held
    }

    /// Assigns a variable the value of an expression.
    ///
    /// # Errors
    /// What is wrong with the expression, or with this value for this variable, or somebody looks at the past, or the program
    /// has ended. Nothing has changed then.
    pub fn assign(
        &mut self,
        variable: &str,
        text: &str,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<(), NotNow> {
        if self.is_past() {
            return Err(NotNow::Past);
        }
        if let Phase::Ended { .. } = self.phase() {
            return Err(NotNow::Ended);
        }
        let thread = self.machine.held_thread().unwrap_or(0);
        let assigned = self.machine.assign(variable, text, thread, brick, trace);
        assigned.map_err(NotNow::Problems)?;
        self.debugger.look(&self.machine);
        self.changes();
        Ok(())
    }

    /// Replaces the program by a new version. A client that looks at the past is back in the present after that.
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
        self.debugger.bind(&self.machine);
        self.debugger.look(&self.machine);
        self.hindsight.to_present();
        self.changes();
        Ok(patched)
    }

    /// Ends the program from outside: motors off, nothing runs any more.
    pub fn end(&mut self, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        self.machine.stop(brick, trace);
    }

    fn changes(&mut self) {
        self.hindsight.changed();
    }

    fn note(&mut self, now: u32) {
        if self.debugger.stop().is_some() {
            self.since = now;
        }
    }
}
