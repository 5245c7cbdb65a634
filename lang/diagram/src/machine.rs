//! A program that runs: threads, loops, waits and messages over a [`Brick`], one step every 10 ms.
//!
//! Owns everything that changes while a diagram runs, and the order of events, which is the original's: timers in the
//! order of blocks, then sensor variables, then what has been put off. Knows no robot and no clock: the caller gives both.
//! The same program with the same readings does the same.

mod clocks;
mod flow;
mod formulas;
mod loops;
mod perform;
mod sensors;
mod tasks;
mod threads;
pub mod trace;
mod waits;

#[cfg(test)]
mod tests;

use std::collections::{BTreeMap, VecDeque};
use std::rc::Rc;

use super::brick::{Brick, Command};
use super::lower::World;
use super::program::{Node, Program};
use super::words;
use clocks::Clock;
use formulas::Formulas;
pub(crate) use formulas::wanted;
use lang_expr::{Compat, Value};
use lang_text::problem::{Place, Problem, Words};
use loops::Loops;
use sensors::Sensors;
use threads::{Handle, State, Threads};
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
#[derive(Debug)]
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
}

/// What a step works with.
pub(crate) struct Env<'a> {
    pub brick: &'a mut dyn Brick,
    pub trace: &'a mut dyn Trace,
}

impl Machine {
    /// A program before its first step.
    pub fn new(program: Rc<Program>, options: Options) -> Self {
        let formulas = Formulas::new(&program, options.compat);
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
        match self.began {
            None => self.begin(now, env),
            Some(began) => {
                let before = self.now;
                self.now = now.saturating_sub(began).max(before);
                self.tick(self.now - before, env);
            }
        }
        if let Some((_, until)) = self.kept
            && self.now >= until
            && let Some((chain, _)) = self.kept.take()
        {
            if let Some(problem) = self.unfit.take() {
                self.report(problem, env);
                self.end_all(env);
            }
            self.active = chain;
            self.is_beginning = true;
            self.drive(env);
            self.is_beginning = false;
        }
        self.work_off(env);
        self.status()
    }

    /// The clocks of a moment at which the program is being stopped: blocks that are due run once more, and whatever they
    /// put off does not.
    pub fn last_tick(&mut self, now: u32, brick: &mut dyn Brick, trace: &mut dyn Trace) {
        if let (None, Some(began)) = (self.ended, self.began) {
            let before = self.now;
            self.now = now.saturating_sub(began).max(before);
            self.tick(self.now - before, &mut Env { brick, trace });
        }
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

    /// What the passing of time brings: timers and waits by the order of blocks, then sensor variables.
    fn tick(&mut self, elapsed: u32, env: &mut Env<'_>) {
        if elapsed == 0 {
            return;
        }
        self.hear_announced(env);
        let mut after = None;
        while let Some(node) = self.next_clock(after) {
            after = Some(node);
            if self.clock_is_due(node, elapsed) {
                self.ring(node, env);
            }
            if self.ended.is_some() {
                return;
            }
        }
        if self.sensors.are_due(elapsed) {
            self.sensors.refresh(env.brick);
            self.answer_waits(env);
        }
    }

    /// What was put off: first what is to follow the events of this step, then what had to wait for a turn.
    ///
    /// What the first puts off for a turn waits for the next step; but the original's simulator comes through its event
    /// loop once more after each third step, and there it does not wait.
    fn work_off(&mut self, env: &mut Env<'_>) {
        let is_turn = !self.options.in_turns || self.now.is_multiple_of(TURN_MS);
        let mut due = self.deferred.len();
        while let Some(node) = self.posted.pop_front() {
            self.done(node, env);
        }
        if is_turn {
            due = self.deferred.len();
        }
        // The original takes posted events before its timers, and a thread that has run long enough waits for a timer:
        // one that a block has just led on comes in the same pass, one that a timer has led on in the next.
        let mut soon = VecDeque::new();
        for _ in 0..due {
            match self.deferred.pop_front() {
                None => break,
                Some(Deferred::Block(node)) => self.follow(node, &mut soon, env),
                Some(Deferred::Thread(handle)) => self.resume(handle, env),
            }
        }
        for handle in soon {
            self.resume(handle, env);
        }
    }

    /// A block that was put off is done, and so are those of its kind that come right behind it: the original posts them
    /// to the same pass. Threads that have run long enough meanwhile come `soon`.
    fn follow(&mut self, node: Node, soon: &mut VecDeque<Handle>, env: &mut Env<'_>) {
        let mut blocks = VecDeque::from([node]);
        while let Some(node) = blocks.pop_front() {
            let before = self.deferred.len();
            self.done(node, env);
            let mut threads = Vec::new();
            for deferred in self.deferred.drain(before.min(self.deferred.len())..) {
                match deferred {
                    Deferred::Thread(handle) => threads.push(handle),
                    Deferred::Block(node) => blocks.push_back(node),
                }
            }
            for handle in threads.into_iter().rev() {
                soon.push_front(handle);
            }
        }
    }

    /// A thread that has run long enough goes on.
    fn resume(&mut self, handle: Handle, env: &mut Env<'_>) {
        if let Some(thread) = self.threads.get_mut(handle)
            && matches!(thread.state, State::Deferred)
        {
            thread.state = State::Resumed;
            self.active.push(handle);
            self.drive(env);
        }
    }

    /// A block that made threads wait is done: they go on, one after another, in the order in which they came.
    fn done(&mut self, node: Node, env: &mut Env<'_>) {
        let Some(next) = self.next_of(node) else {
            return;
        };
        self.lead(node, next, env);
    }

    /// Leads all threads that wait at a node to another one.
    fn lead(&mut self, node: Node, next: Node, env: &mut Env<'_>) {
        for handle in self.threads.waiting_at(node) {
            if let Some(thread) = self.threads.get_mut(handle)
                && thread.is_waiting_at(node)
            {
                thread.go(next);
                self.active.push(handle);
                self.drive(env);
            }
        }
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
        self.posted.clear();
        self.deferred.clear();
        self.clocks.clear();
        self.kept = None;
        env.brick.command(Command::Rest);
    }
}
