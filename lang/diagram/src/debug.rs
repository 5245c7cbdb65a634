//! A debugger for a running program: breakpoints, steps, pauses, and why it has stopped.
//!
//! Owns what a person has asked for and decides, as the trace of a guarded machine, whether it goes on. It knows blocks
//! by the ids of the project, so that it survives a new version of the program. It changes nothing in the machine: a
//! program that is debugged does what it does alone. Knows no clock, no files and no protocol.

use std::collections::{BTreeSet, VecDeque};
use std::fmt;
use std::rc::Rc;

use crate::limits;
use crate::machine::Machine;
use crate::machine::trace::{Guard, Moment, Trace};
use crate::machine::view::Waits;
use crate::program::{Node, Program};
use lang_expr::Value;
use lang_text::problem::{Problem, Severity};

mod answers;
pub mod desk;
mod history;
pub mod order;
mod past;
pub mod report;
mod session;
#[cfg(test)]
mod tests;

use history::Position;
pub use past::{Back, NoBack};
pub use session::{NotNow, Phase, Session};

/// A breakpoint at a block.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Breakpoint {
    /// The id of the block in the project.
    pub block: Box<str>,
    /// It counts only if this expression is true; empty: always.
    pub condition: Box<str>,
    /// It stops at this time and all later ones; 0 and 1: at each.
    pub from_hit: u32,
    /// It writes this line instead of stopping; `{expression}` stands for a value. Empty: it stops.
    pub log: Box<str>,
    /// It stops once and is gone.
    pub is_once: bool,
    /// It is kept but does nothing.
    pub is_disabled: bool,
}

/// Why a breakpoint is refused.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum NoBreakpoint {
    /// The program has no such block.
    NoSuchBlock,
    /// There are [`limits::BREAKPOINTS_MAX`].
    TooMany,
    /// A condition or a line is longer than [`limits::CONDITION_MAX`] bytes.
    TooLong,
}

impl fmt::Display for NoBreakpoint {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoSuchBlock => f.write_str("the program has no such block"),
            Self::TooMany => {
                let most = limits::BREAKPOINTS_MAX;
                write!(
                    f,
                    "there are {most} breakpoints already, which is all that can be"
                )
            }
            Self::TooLong => {
                let most = limits::CONDITION_MAX;
                write!(f, "a condition or a line has at most {most} bytes")
            }
        }
    }
}

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
    /// The condition of a breakpoint cannot be computed.
    Condition(u32, Vec<Problem>),
    /// An error in a block. The thread ends when the program goes on.
    Error(Problem),
    /// This is the first moment of the past that is kept.
    Oldest,
    /// A moment of the past that somebody asked for.
    Past,
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
            | Reason::Condition(..)
            | Reason::Oldest
            | Reason::Past => false,
        };
        self.node.is_some() && !is_failure
    }
}

#[derive(Clone, Debug)]
struct Kept {
    number: u32,
    point: Breakpoint,
    node: Option<Node>,
    hits: u32,
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
    points: Vec<Kept>,
    numbers: u32,
    /// By node: whether there is a breakpoint.
    marked: Vec<bool>,
    /// Whether errors stop.
    pub stops_at_errors: bool,
    wants_pause: bool,
    held_alone: BTreeSet<Rc<str>>,
    walk: Option<Walk>,
    walker_ended: bool,
    error: Option<Problem>,
    stop: Option<Stop>,
    lines: VecDeque<String>,
    lines_lost: u32,
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
    pub fn add(&mut self, program: &Program, point: Breakpoint) -> Result<u32, NoBreakpoint> {
        if self.points.len() >= limits::BREAKPOINTS_MAX {
            return Err(NoBreakpoint::TooMany);
        }
        let longest = point.condition.len().max(point.log.len());
        if longest > limits::CONDITION_MAX {
            return Err(NoBreakpoint::TooLong);
        }
        if program.node(&point.block).is_none() {
            return Err(NoBreakpoint::NoSuchBlock);
        }
        self.numbers = self.numbers.wrapping_add(1);
        self.points.push(Kept {
            number: self.numbers,
            point,
            node: None,
            hits: 0,
        });
        self.bind(program);
        Ok(self.numbers)
    }

    /// Takes a breakpoint away; false if there is none with this number.
    pub fn remove(&mut self, number: u32) -> bool {
        let before = self.points.len();
        self.points.retain(|kept| kept.number != number);
        self.mark();
        self.points.len() < before
    }

    /// Takes one breakpoint away, or all; false if there is none with this number.
    pub fn clear(&mut self, number: Option<u32>) -> bool {
        match number {
            Some(number) => self.remove(number),
            None => {
                self.points.clear();
                self.mark();
                true
            }
        }
    }

    /// Lets a breakpoint do something or nothing; false if there is none with this number.
    pub fn enable(&mut self, number: u32, is_enabled: bool) -> bool {
        let mut points = self.points.iter_mut();
        let found = points.find(|kept| kept.number == number);
        found
            .map(|kept| kept.point.is_disabled = !is_enabled)
            .is_some()
    }

    /// The breakpoints with their numbers and how often each was hit.
    pub fn breakpoints(&self) -> impl Iterator<Item = (u32, &Breakpoint, u32)> {
        let kept = self.points.iter();
        kept.map(|kept| (kept.number, &kept.point, kept.hits))
    }

    /// The program that runs is another one: breakpoints are where their blocks are. Those of blocks that are gone wait
    /// until such a block comes back.
    pub fn bind(&mut self, program: &Program) {
        for kept in &mut self.points {
            kept.node = program.node(&kept.point.block);
        }
        self.mark();
    }

    fn mark(&mut self) {
        self.marked.clear();
        for node in self.points.iter().filter_map(|kept| kept.node) {
            let at = node as usize;
            if self.marked.len() <= at {
                self.marked.resize(at + 1, false);
            }
            self.marked[at] = true;
        }
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

    /// A thread is no longer to be held; whoever calls it also calls [`Machine::release`].
    pub fn let_thread(&mut self, name: &str) {
        self.held_alone.remove(name);
    }

    /// The threads that are to be held alone.
    fn held_names(&self) -> Vec<Rc<str>> {
        self.held_alone.iter().cloned().collect()
    }

    /// Forgets everything that was asked for, but not where the program is stopped.
    fn forget(&mut self) {
        *self = Self {
            stop: self.stop.take(),
            numbers: self.numbers,
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
        let lost = std::mem::take(&mut self.lines_lost);
        (self.lines.drain(..).collect(), lost)
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

    /// The breakpoint that would stop at a block in the past: hits are not counted there, and nothing is logged.
    fn stops_at(&self, machine: &Machine, node: Node) -> Option<u32> {
        let here = self.points.iter().find(|kept| {
            let point = &kept.point;
            let is_here = kept.node == Some(node) && !point.is_disabled && point.log.is_empty();
            let holds = |text: &str| {
                machine
                    .evaluate_aside(text)
                    .is_ok_and(|value| value.to_bool())
            };
            is_here && (point.condition.is_empty() || holds(&point.condition))
        });
        here.map(|kept| kept.number)
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
        if self.is_marked(node)
            && let Some(reason) = self.hit(machine, node)
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

    fn is_marked(&self, node: Node) -> bool {
        self.marked.get(node as usize).copied().unwrap_or(false)
    }

    /// What the breakpoints at a block do.
    fn hit(&mut self, machine: &Machine, node: Node) -> Option<Reason> {
        let mut reason = None;
        let mut gone = None;
        for at in 0..self.points.len() {
            let kept = &mut self.points[at];
            if kept.node != Some(node) || kept.point.is_disabled {
                continue;
            }
            if !kept.point.condition.is_empty() {
                match machine.evaluate_aside(&kept.point.condition) {
                    Ok(value) if !value.to_bool() => continue,
                    Ok(_) => {}
                    Err(problems) => {
                        reason.get_or_insert(Reason::Condition(kept.number, problems));
                        continue;
                    }
                }
            }
            kept.hits = kept.hits.saturating_add(1);
            if kept.hits < kept.point.from_hit {
                continue;
            }
            let number = kept.number;
            if kept.point.log.is_empty() {
                if kept.point.is_once {
                    gone = Some(number);
                }
                reason.get_or_insert(Reason::Breakpoint(number));
            } else {
                let line = filled(&kept.point.log, machine);
                self.line(line);
            }
        }
        if let Some(number) = gone {
            self.remove(number);
        }
        reason
    }

    fn line(&mut self, line: String) {
        if self.lines.len() >= limits::DEBUG_LINES_MAX {
            self.lines.pop_front();
            self.lines_lost = self.lines_lost.saturating_add(1);
        }
        self.lines.push_back(line);
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

/// A line with values in the place of `{expression}`; what cannot be computed says why.
fn filled(line: &str, machine: &Machine) -> String {
    let mut out = String::new();
    let mut rest = line;
    while let Some((before, after)) = rest.split_once('{') {
        out.push_str(before);
        let Some((expression, after)) = after.split_once('}') else {
            out.push('{');
            rest = after;
            continue;
        };
        match machine.evaluate_aside(expression) {
            Ok(value) => out.push_str(&value.to_text()),
            Err(problems) => {
                let why = problems.first().map(|problem| &*problem.words.english);
                out.push('<');
                out.push_str(why.unwrap_or("?"));
                out.push('>');
            }
        }
        rest = after;
        if out.len() > limits::DEBUG_LINE_BYTES_MAX {
            break;
        }
    }
    out.push_str(rest);
    let end = out.floor_char_boundary(limits::DEBUG_LINE_BYTES_MAX);
    out.truncate(end);
    out
}

/// A debugger at a machine, with another trace beside it.
pub struct Attached<'a> {
    debugger: &'a mut Debugger,
    heard: &'a mut dyn Trace,
}

impl Trace for Attached<'_> {
    fn entered(&mut self, now: u32, thread: u16, node: Node) {
        self.heard.entered(now, thread, node);
    }

    fn changed(&mut self, now: u32, thread: u16, variable: &str, value: &Value) {
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
                None if debugger.walker_ended => debugger.halt(Reason::ThreadEnded, None, None),
                None if debugger.wants_pause => debugger.halt(Reason::Pause, None, None),
                None => Guard::Go,
            },
        }
    }
}
