//! A debugger for a running program: breakpoints, steps, pauses, and why it has stopped.
//!
//! Owns what a person has asked for and decides, as the trace of a guarded machine, whether it goes on. It changes nothing
//! in the machine: a program that is debugged does what it does alone. Knows no clock, no files and no protocol.

use std::collections::BTreeSet;
use std::rc::Rc;

use crate::limits;
use crate::machine::Machine;
use crate::machine::trace::{Guard, Moment, Trace};
use crate::machine::view::Waits;
use crate::program::{NOWHERE, Node};
use lang_expr::Value;
use lang_text::problem::{Problem, Severity};

pub mod again;
pub mod answers;
pub mod desk;
pub mod hindsight;
mod history;
mod no_order;
pub mod order;
mod past;
mod points;
pub mod report;
mod session;
#[cfg(test)]
mod tests;
mod words;

pub use history::Position;
pub use past::{Back, NoBack};
pub use points::{Breakpoint, NoBreakpoint, Points, Spot, Subject};
pub use session::{NotNow, Phase, Session};
pub use words::not_attached;

/// How far a thread goes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Step {
    /// To its next block.
    Into,
    /// To its next block in this diagram, or where this one was called.
    Over,
    /// To the block after the call of this diagram.
    Out,
}

/// Why a program has stopped.
#[derive(Clone, Debug, PartialEq)]
#[allow(clippy::large_enum_variant, reason = "stops are rare")]
pub enum Reason {
    /// Somebody asked for it.
    Pause,
    /// A step is done.
    Step,
    /// The thread that made a step has ended.
    ThreadEnded,
    /// A breakpoint, by its number.
    Breakpoint(u32),
    /// A variable that is watched has changed.
    Changed(Box<Change>),
    /// The condition of a breakpoint cannot be computed.
    Condition(u32, Vec<Problem>),
    /// An error in a block. The thread ends when the program goes on.
    Error(Problem),
    /// This is the first moment of the past that is kept.
    Oldest,
    /// A moment of the past that somebody asked for.
    Past,
}

/// A change of a variable that is watched.
#[derive(Clone, Debug)]
pub struct Change {
    /// The number of the breakpoint.
    pub number: u32,
    /// The variable.
    pub variable: Box<str>,
    /// What it held before; none: it had no value.
    pub was: Option<Value>,
    /// What it holds.
    pub is: Option<Value>,
    /// The block that has assigned it, if one has, and it is known.
    pub by: Option<Node>,
}

impl PartialEq for Change {
    /// A change is known by the breakpoint that tells of it.
    fn eq(&self, other: &Self) -> bool {
        self.number == other.number && self.variable == other.variable && self.by == other.by
    }
}

/// A stop.
#[derive(Clone, Debug, PartialEq)]
pub struct Stop {
    /// Why.
    pub reason: Reason,
    /// The thread that made it stop; none if no thread was running.
    pub thread: Option<u16>,
    /// The block that it enters next, or in which it has failed.
    pub node: Option<Node>,
}

impl Stop {
    /// Whether the thread is about to enter a block, and not in one that failed, nor between threads.
    fn is_before_block(&self) -> bool {
        let is_failure = match self.reason {
            Reason::Error(_) => true,
            Reason::Pause
            | Reason::Step
            | Reason::ThreadEnded
            | Reason::Breakpoint(_)
            | Reason::Changed(_)
            | Reason::Condition(..)
            | Reason::Oldest
            | Reason::Past => false,
        };
        self.node.is_some() && !is_failure
    }
}

#[derive(Clone, Copy, Debug)]
struct Walk {
    thread: u16,
    step: Step,
    depth: usize,
}

/// What a person has asked for.
#[derive(Clone, Debug, Default)]
pub struct Debugger {
    points: Points,
    /// By thread: the block that it has entered last.
    entered_by: Vec<Node>,
    /// Variables that are watched and were assigned since the last moment, and by which block.
    assigned: Vec<(Box<str>, Node)>,
    /// Whether errors stop.
    pub stops_at_errors: bool,
    wants_pause: bool,
    held_alone: BTreeSet<Rc<str>>,
    walk: Option<Walk>,
    walker_ended: bool,
    error: Option<Problem>,
    stop: Option<Stop>,
    /// Blocks that threads were about to enter so far.
    entered: Position,
    /// Of those the ones before which a thread was held alone, since somebody took them.
    held_at: Vec<Position>,
}

impl Debugger {
    /// Adds a breakpoint; its number.
    ///
    /// # Errors
    /// [`NoBreakpoint`].
    pub fn add(&mut self, machine: &Machine, point: Breakpoint) -> Result<u32, NoBreakpoint> {
        self.points.add(&machine, point)
    }

    /// Takes a breakpoint away; false if there is none with this number.
    pub fn remove(&mut self, number: u32) -> bool {
        self.clear(Some(number))
    }

    /// Takes one breakpoint away, or all; false if there is none with this number.
    pub fn clear(&mut self, number: Option<u32>) -> bool {
        self.points.clear(number)
    }

    /// Lets a breakpoint do something or nothing; false if there is none with this number.
    pub fn enable(&mut self, number: u32, is_enabled: bool) -> bool {
        self.points.enable(number, is_enabled)
    }

    /// The breakpoints with their numbers and how often each was hit.
    pub fn breakpoints(&self) -> impl Iterator<Item = (u32, &Breakpoint, u32)> {
        self.points.all()
    }

    /// The program that runs is another one: breakpoints are where their blocks are.
    pub fn bind(&mut self, machine: &Machine) {
        self.points.bind(&machine);
        // They are of blocks of the old one.
        self.entered_by.clear();
        self.assigned.clear();
    }

    /// Somebody else than the program has changed values.
    fn look(&mut self, machine: &Machine) {
        self.points.look(&machine);
    }

    /// The program stops as soon as it can.
    pub fn pause(&mut self) {
        self.wants_pause = true;
    }

    /// A thread is held when it enters its next block, and the others go on.
    ///
    /// Told by its name, so that it also counts for threads that are to come; at most [`limits::BREAKPOINTS_MAX`] names.
    ///
    /// # Errors
    /// [`NoBreakpoint::TooMany`].
    pub fn hold_thread(&mut self, name: &str) -> Result<(), NoBreakpoint> {
        if self.held_alone.len() >= limits::BREAKPOINTS_MAX {
            return Err(NoBreakpoint::TooMany);
        }
        self.held_alone.insert(name.into());
        Ok(())
    }

    /// A thread is no longer to be held; false if it was not. The caller also calls [`Machine::release`].
    pub fn let_thread(&mut self, name: &str) -> bool {
        self.held_alone.remove(name)
    }

    /// The threads that are to be held alone.
    fn held_names(&self) -> Vec<Rc<str>> {
        self.held_alone.iter().cloned().collect()
    }

    /// Forgets everything that was asked for, but not where the program is stopped.
    fn forget(&mut self) {
        *self = Self {
            stop: self.stop.take(),
            points: self.points.without_all(),
            ..Self::default()
        };
    }

    /// A thread makes a step, and the program stops after it.
    pub fn step(&mut self, machine: &Machine, thread: u16, step: Step) {
        self.walk = Some(Walk {
            thread,
            step,
            depth: machine.depth(thread),
        });
    }

    /// The moment at which the program is.
    fn present(&self) -> Position {
        match &self.stop {
            // It was counted when the thread was about to enter it.
            Some(stop) if stop.is_before_block() => self.entered.saturating_sub(1),
            Some(_) | None => self.entered,
        }
    }

    /// The stop at which the machine is held, until it goes on.
    pub fn stop(&self) -> Option<&Stop> {
        self.stop.as_ref()
    }

    /// The program goes on: what made it stop is done with.
    pub fn go_on(&mut self) {
        self.stop = None;
    }

    /// Lines of breakpoints that log, and how many were lost because nobody took them.
    pub fn take_lines(&mut self) -> (Vec<String>, u32) {
        self.points.take_lines()
    }

    /// This debugger as the trace of a machine, with another one that hears everything as well.
    pub fn trace<'a>(&'a mut self, heard: &'a mut dyn Trace) -> Attached<'a> {
        Attached {
            debugger: self,
            heard,
        }
    }

    fn halt(&mut self, reason: Reason, thread: Option<u16>, node: Option<Node>) -> Guard {
        self.wants_pause = false;
        self.walk = None;
        self.walker_ended = false;
        self.stop = Some(Stop {
            reason,
            thread,
            node,
        });
        Guard::Hold
    }

    fn enters(&mut self, machine: &Machine, thread: u16, node: Node) -> Guard {
        let guard = self.decides(machine, thread, node);
        if guard == Guard::HoldThread {
            self.held_at.push(self.entered);
        }
        self.entered += 1;
        guard
    }

    fn decides(&mut self, machine: &Machine, thread: u16, node: Node) -> Guard {
        if (self.points.has_watches() || self.points.is_marked(node))
            && let Some(reason) = self.met(machine, node)
        {
            return self.halt(reason, Some(thread), Some(node));
        }
        if let Some(walk) = self.walk
            && walk.thread == thread
            && walk.step.ends_at(machine.depth(thread), walk.depth)
        {
            return self.halt(Reason::Step, Some(thread), Some(node));
        }
        if self.wants_pause {
            return self.halt(Reason::Pause, Some(thread), Some(node));
        }
        let name = machine.thread_name(thread);
        match name.is_some_and(|name| self.held_alone.contains(name)) {
            true => Guard::HoldThread,
            false => Guard::Go,
        }
    }

    /// What breakpoints do before a block: those at it, and those whose variables have changed.
    #[cold]
    fn met(&mut self, mut machine: &Machine, node: Node) -> Option<Reason> {
        // Both have to count their hits.
        let changed = self.changed(machine);
        let hit = self.points.at_block(&mut machine, node);
        changed.or(hit)
    }

    /// What breakpoints do whose variables have changed.
    fn changed(&mut self, mut machine: &Machine) -> Option<Reason> {
        let assigned = std::mem::take(&mut self.assigned);
        self.points.at_changes(&mut machine, |variable| {
            let mut last = assigned.iter().rev();
            let by = last.find(|(name, _)| **name == *variable);
            by.map(|(_, node)| *node)
        })
    }

    /// A thread has assigned a variable.
    fn note_assigned(&mut self, thread: u16, variable: &str) {
        if !self.points.is_watched(variable) {
            return;
        }
        let by = self.entered_by.get(usize::from(thread));
        if let Some(&node) = by.filter(|&&node| node != NOWHERE) {
            self.assigned.retain(|(name, _)| **name != *variable);
            self.assigned.push((variable.into(), node));
        }
    }

    fn note_entered(&mut self, thread: u16, node: Node) {
        if !self.points.has_watches() {
            return;
        }
        let at = usize::from(thread);
        if self.entered_by.len() <= at {
            self.entered_by.resize(at + 1, NOWHERE);
        }
        self.entered_by[at] = node;
    }
}

impl Step {
    /// Whether it ends where so many calls are open, when so many were when it began.
    fn ends_at(self, depth: usize, began: usize) -> bool {
        match self {
            Self::Into => true,
            Self::Over => depth <= began,
            // Nothing has called the main diagram: there it is a step over.
            Self::Out => depth < began || began == 0 && depth == 0,
        }
    }
}

/// A debugger at a machine, with another trace beside it.
pub struct Attached<'a> {
    debugger: &'a mut Debugger,
    heard: &'a mut dyn Trace,
}

impl Trace for Attached<'_> {
    fn entered(&mut self, now: u32, thread: u16, node: Node) {
        self.debugger.note_entered(thread, node);
        self.heard.entered(now, thread, node);
    }

    fn changed(&mut self, now: u32, thread: u16, variable: &str, value: &Value) {
        self.debugger.note_assigned(thread, variable);
        self.heard.changed(now, thread, variable, value);
    }

    fn trap(&mut self, now: u32, problem: &Problem) {
        let is_error = problem.severity == Severity::Error;
        if is_error && self.debugger.stops_at_errors && self.debugger.error.is_none() {
            self.debugger.error = Some(problem.clone());
        }
        self.heard.trap(now, problem);
    }

    fn sent(&mut self, now: u32, from: u16, to: u16, message: &str) {
        self.heard.sent(now, from, to, message);
    }

    fn thread_started(&mut self, now: u32, thread: u16, name: &str) {
        self.heard.thread_started(now, thread, name);
    }

    fn thread_ended(&mut self, now: u32, thread: u16) {
        if self.debugger.walk.is_some_and(|walk| walk.thread == thread) {
            self.debugger.walk = None;
            self.debugger.walker_ended = true;
        }
        self.heard.thread_ended(now, thread);
    }

    fn waits(&mut self, now: u32, thread: u16, node: Node, waits: Waits) {
        self.heard.waits(now, thread, node, waits);
    }

    fn guard(&mut self, machine: &Machine, at: Moment) -> Guard {
        let debugger = &mut *self.debugger;
        match at {
            Moment::Enters { thread, node } => debugger.enters(machine, thread, node),
            Moment::Fails { thread, node } => match debugger.error.take() {
                Some(problem) => debugger.halt(Reason::Error(problem), Some(thread), Some(node)),
                None => Guard::Go,
            },
            // Errors of blocks that wait: their threads have ended.
            Moment::Between => match debugger.error.take() {
                Some(problem) => debugger.halt(Reason::Error(problem), None, None),
                None if debugger.points.has_watches()
                    && let Some(reason) = debugger.changed(machine) =>
                {
                    debugger.halt(reason, None, None)
                }
                None if debugger.walker_ended => debugger.halt(Reason::ThreadEnded, None, None),
                None if debugger.wants_pause => debugger.halt(Reason::Pause, None, None),
                None => Guard::Go,
            },
        }
    }
}
