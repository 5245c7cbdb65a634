//! A program that runs: threads, loops, waits and messages over a [`Brick`], one step every 10 ms.
//!
//! Owns everything that changes while a diagram runs, and the order of events, which is the original's: timers in the
//! order of blocks, then sensor variables, then what has been put off. Knows no robot and no clock: the caller gives both.
//! The same program with the same readings does the same.

mod agenda;
mod clocks;
mod flow;
mod formulas;
mod guard;
mod loops;
pub mod patch;
mod perform;
mod sensors;
mod tasks;
mod threads;
pub mod trace;
pub mod view;
mod waits;

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;

use super::brick::{Brick, Command};
use super::lower::World;
use super::program::{Node, Program};
use super::words;
use agenda::Work;
use clocks::Clock;
use formulas::Formulas;
use guard::Held;
use lang_expr::{Compat, Value};
use lang_text::problem::{Place, Problem, Words};
use loops::Loops;
use sensors::Sensors;
use threads::{Handle, Threads};
use trace::Trace;

/// How a program runs.
#[derive(Clone, Copy, Debug, Default)]
pub struct Options {
    /// Whether the oddities of the original are kept.
    pub compat: Compat,
    /// Whether the steps come three in one turn, as in the original's simulator: the first thread, and threads that begin
    /// in its first moment, are kept for a turn, and some blocks take a step more within one.
    /// [`Options::simulated`] sets it.
    pub in_turns: bool,
}

impl Options {
    /// As the original runs it in its simulator.
    pub fn simulated() -> Self {
        Self {
            compat: Compat::Studio,
            in_turns: true,
        }
    }

    /// The usual options for a world.
    pub fn of(world: World) -> Self {
        Self {
            in_turns: world != World::Robot,
            ..Self::default()
        }
    }
}

/// What a program is doing.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Status {
    /// It runs or waits.
    Running,
    /// All its threads have ended.
    Ended {
        /// When, in milliseconds since its first step.
        at: u32,
        /// Whether there were errors.
        with_errors: bool,
    },
}

/// How often a step is due, in milliseconds.
pub const STEP_MS: u32 = 10;
/// What the original's simulator takes for one turn of its event loop.
const TURN_MS: u32 = 3 * STEP_MS;

/// A program that runs.
#[derive(Clone, Debug)]
pub struct Machine {
    program: Rc<Program>,
    options: Options,
    formulas: Formulas,
    threads: Threads,
    sensors: Sensors,
    /// Of the first step.
    began: Option<u32>,
    /// Milliseconds since then.
    now: u32,
    /// The thread that runs now, and beneath it those that go on when it waits.
    active: Vec<Handle>,
    /// What of the beginning is kept, and until when.
    kept: Option<(Vec<Handle>, u32)>,
    /// Why there is no beginning; it is told when that would be.
    unfit: Option<Problem>,
    /// Whether `active` belongs to the beginning.
    is_beginning: bool,
    /// Blocks that are done with waiting.
    posted: VecDeque<Node>,
    /// What has to wait for the next turn.
    deferred: VecDeque<Deferred>,
    clocks: Vec<Clock>,
    loops: Loops,
    /// How many threads have come to each join.
    tokens: Vec<u32>,
    /// What each fork remembers.
    forks: Vec<BTreeMap<Rc<str>, Node>>,
    errors: Vec<Problem>,
    /// Errors that are not kept.
    more_errors: u32,
    ended: Option<u32>,
    /// What the present step has still to do, the next last.
    agenda: Vec<Work>,
    /// Threads that run long come after blocks that follow each other.
    soon: VecDeque<Handle>,
    /// Whether the trace is asked before each block.
    is_guarded: bool,
    /// Why nothing runs for now.
    held: Option<Held>,
    /// Who enters its block without the trace being asked: it was.
    pass: Option<Handle>,
    /// Reused for readings.
    scratch: Vec<i32>,
}

/// What waits for the next turn.
#[derive(Clone, Copy, Debug)]
enum Deferred {
    /// A thread that has run long enough.
    Thread(Handle),
    /// A block that is done then.
    Block(Node),
    /// A thread that was held alone and is let go.
    Released(Handle),
}

/// What a step works with.
pub(crate) struct Env<'a> {
    pub brick: &'a mut dyn Brick,
    pub trace: &'a mut dyn Trace,
}

impl Machine {
    /// A program before its first step.
    pub fn new(program: Rc<Program>, options: Options) -> Self {
        let formulas = Formulas::new(&program, options);
        Self {
            loops: Loops::new(program.loops, options.compat),
            tokens: vec![0; program.joins.len()],
            forks: vec![BTreeMap::new(); program.forks.len()],
            formulas,
            program,
            options,
            threads: Threads::default(),
            sensors: Sensors::default(),
            began: None,
            now: 0,
            active: Vec::new(),
            kept: None,
            unfit: None,
            is_beginning: false,
            posted: VecDeque::new(),
            deferred: VecDeque::new(),
            clocks: Vec::new(),
            errors: Vec::new(),
            more_errors: 0,
            ended: None,
            agenda: Vec::new(),
            soon: VecDeque::new(),
            is_guarded: false,
            held: None,
            pass: None,
            scratch: Vec::new(),
        }
    }

    /// Runs what is due at a moment, in milliseconds that never go back. The first step is the beginning; then one is
    /// due every [`STEP_MS`]. A later one makes up for the time, but not for steps that were left out.
    pub fn step(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) -> Status {
        if self.ended.is_some() {
            return self.status();
        }
        let env = &mut Env { brick, trace };
        if self.held.is_some() {
            return self.status();
        }
        self.plan(Work::Events);
        // What is kept in a later step than the first begins in one after that.
        if self.began.is_none() || self.kept.is_some() {
            self.plan(Work::Beginning);
        }
        match self.began {
            None => self.begin(now, env),
            Some(began) => self.let_pass(now, began),
        }
        self.go_on(env);
        self.status()
    }

    /// The clocks of a moment at which the program is being stopped: blocks that are due run once more, and whatever they
    /// put off does not.
    pub fn last_tick(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        if let (None, None, Some(began)) = (self.ended, &self.held, self.began) {
            self.let_pass(now, began);
            self.go_on(&mut Env { brick, trace });
        }
    }

    /// Time passes until a moment.
    fn let_pass(&mut self, now: u32, began: u32) {
        let before = self.now;
        self.now = now.saturating_sub(began).max(before);
        self.plan(Work::Tick {
            elapsed: self.now - before,
        });
    }

    /// What it is doing.
    pub fn status(&self) -> Status {
        match self.ended {
            None => Status::Running,
            Some(at) => Status::Ended {
                at,
                with_errors: !self.errors.is_empty(),
            },
        }
    }

    /// Ends it from outside: motors off, nothing runs any more.
    pub fn stop(&mut self, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        let env = &mut Env { brick, trace };
        self.end_all(env);
    }

    /// What went wrong so far: at most [`lang_text::limits::PROBLEMS`].
    pub fn errors(&self) -> &[Problem] {
        &self.errors
    }

    /// How many more went wrong.
    pub fn more_errors(&self) -> u32 {
        self.more_errors
    }

    /// What runs.
    pub fn program(&self) -> &Rc<Program> {
        &self.program
    }

    /// Milliseconds since the first step.
    pub fn now(&self) -> u32 {
        self.now
    }

    /// Threads that live: name and present block.
    pub fn threads(&self) -> impl Iterator<Item = (&str, Node)> {
        self.threads
            .alive()
            .map(|thread| (&*thread.name, thread.node))
    }

    /// The name of a thread that a trace tells by its number.
    pub fn thread_name(&self, number: u16) -> Option<&str> {
        self.threads.name(number)
    }

    /// The program's variables that have values.
    pub fn variables(&self) -> impl Iterator<Item = (&str, &Value)> {
        self.formulas.variables()
    }

    /// The value of a variable.
    pub fn variable(&self, name: &str) -> Option<Value> {
        self.formulas.get(name)
    }

    fn begin(&mut self, now: u32, env: &mut Env<'_>) {
        self.began = Some(now);
        self.sensors = Sensors::new(&self.formulas);
        if !self.options.in_turns {
            // The original's simulator reads them for the first time when they are due.
            self.sensors.refresh(env.brick);
        }
        if let Some(problem) = self.program.refusal.clone() {
            self.report(problem, env);
            self.end_all(env);
            return;
        }
        let entry = match self.program.main {
            None => Err(words::no_main()),
            Some(main) => {
                let entry = self.program.entries.get(main as usize).copied().flatten();
                entry.ok_or_else(words::no_entry)
            }
        };
        let node = match entry {
            Ok(node) => node,
            Err(words) => {
                let main = self.program.main.unwrap_or(0) as usize;
                let sheet = self.program.diagrams.get(main);
                let place = Place {
                    diagram: sheet.map(|sheet| sheet.name.to_string()),
                    object: sheet.map(|sheet| sheet.id.to_string()),
                    ..Place::default()
                };
                let problem = Problem::error(words);
                self.unfit = Some(Problem { place, ..problem });
                self.kept = Some((Vec::new(), if self.options.in_turns { TURN_MS } else { 0 }));
                return;
            }
        };
        let Some(main) = self.threads.spawn("main".into(), node) else {
            return;
        };
        env.trace.thread_started(self.now, main.slot, "main");
        let wait = if self.options.in_turns { TURN_MS } else { 0 };
        self.kept = Some((vec![main], wait));
    }

    /// Where the flow goes after a block with one link.
    fn next_of(&self, node: Node) -> Option<Node> {
        self.program.next(node)
    }

    /// Tells an error at a block.
    fn error_at(&mut self, node: Node, words: Words, env: &mut Env<'_>) {
        let mut problem = Problem::error(words);
        problem.place = self.program.place(node);
        self.report(problem, env);
    }

    fn report(&mut self, problem: Problem, env: &mut Env<'_>) {
        env.trace.trap(self.now, &problem);
        if self.errors.len() < lang_text::limits::PROBLEMS {
            self.errors.push(problem);
        } else {
            self.more_errors = self.more_errors.saturating_add(1);
        }
    }

    /// A thread ends; with the last one the program does.
    fn end_thread(&mut self, handle: Handle, env: &mut Env<'_>) {
        if !self.threads.end(handle) {
            return;
        }
        self.loops.forget(handle.life, 0);
        env.trace.thread_ended(self.now, handle.slot);
        if self.threads.alive().next().is_none() {
            self.end_all(env);
        }
    }

    /// All threads that wait at a block end, after an error there.
    fn fail_all_at(&mut self, node: Node, env: &mut Env<'_>) {
        for handle in self.threads.waiting_at(node) {
            self.end_thread(handle, env);
        }
    }

    fn end_all(&mut self, env: &mut Env<'_>) {
        if self.ended.is_some() {
            return;
        }
        self.ended = Some(self.now);
        for slot in self.threads.end_all() {
            env.trace.thread_ended(self.now, slot);
        }
        self.active.clear();
        self.agenda.clear();
        self.soon.clear();
        self.held = None;
        self.pass = None;
        self.posted.clear();
        self.deferred.clear();
        self.clocks.clear();
        self.kept = None;
        self.is_beginning = false;
        env.brick.command(Command::Rest);
    }
}
