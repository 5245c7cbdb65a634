//! What drives a robot while it is judged: a diagram, or a program in a language with text.
//!
//! Owns the border between the judge and whatever runs. Model time moves only between steps, so a program is as
//! repeatable as its steps are.

use crate::limits;
use lang_diagram::brick::Brick;
use lang_diagram::machine::trace::{Deaf, Trace};
use lang_diagram::machine::{Machine, Options, Status};
use lang_diagram::ports::Port;
use lang_diagram::program::{Node, Program as Lowered};
use lang_text::problem::{Locale, Problem, Words};
use std::rc::Rc;

use super::track::Group;

/// A program under judgement.
pub trait Program {
    /// Runs what is due at a moment, in milliseconds of model time: 0 first, then every 10 ms, after the world has moved.
    /// What it tells the robot shows in the next ticks of the world. Returns when the program waits for a later moment,
    /// or after a bounded piece of work.
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status;

    /// Whether it is held in the middle of a step: the next call of [`Program::step`], at the same moment, goes on there.
    fn is_held(&self) -> bool {
        false
    }

    /// What of it still runs in the tick in which the rules have decided.
    fn last_tick(&mut self, _now_ms: u32, _robot: &mut dyn Brick) {}

    /// Ends it from outside: motors off, nothing runs any more.
    fn stop(&mut self, robot: &mut dyn Brick);

    /// Says what it does at this moment, for people who look on: variables, and the blocks or lines at which its threads
    /// are.
    fn describe(&self, _locale: Locale, _tell: &mut dyn FnMut(Group, &str, &str)) {}

    /// What went wrong in it so far, in order; it only grows.
    fn errors(&self) -> &[Problem];

    /// What was strange in it so far and does not end it, in order; it only grows.
    fn warnings(&self) -> &[Problem] {
        &[]
    }

    /// Why it cannot even begin.
    fn refusal(&self) -> Option<&Problem> {
        None
    }

    /// Which block or line each of its threads was at last, for an explanation; nothing if it was not watched.
    fn running(&self) -> Vec<Running> {
        Vec::new()
    }

    /// Whether it was ended because it took too much real time, which says nothing of the task.
    fn is_out_of_time(&self) -> bool {
        false
    }
}

/// A thread of a program, and where it is.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Running {
    /// The thread.
    pub thread: String,
    /// When it ended, in milliseconds of model time, if it has.
    pub ended_ms: Option<u32>,
    /// Its block or line.
    pub at: Spot,
}

/// A place in a program.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Spot {
    /// A block of a diagram.
    Block {
        /// The name of the diagram.
        diagram: String,
        /// The id of the block.
        id: String,
        /// Its type, as `Timer`.
        kind: String,
        /// Its name in the editor, in English and Russian.
        caption: Words,
    },
    /// The line of a text at which it waited, or asked the robot, last.
    Line {
        /// The name of the file.
        file: String,
        /// From 1.
        line: u32,
        /// When, in milliseconds of model time.
        at_ms: u32,
    },
}

/// A diagram as a program, with the oddities of the original's simulator.
#[derive(Debug)]
pub struct Diagram {
    machine: Machine,
    /// Blocks that threads were at, if somebody wants to know.
    steps: Option<Steps>,
}

/// Where threads are, by their numbers.
#[derive(Debug, Default)]
struct Steps(Vec<Step>);

#[derive(Clone, Debug, Default)]
struct Step {
    name: String,
    node: Option<Node>,
    ended_ms: Option<u32>,
}

impl Steps {
    fn of(&mut self, thread: u16) -> &mut Step {
        let index = usize::from(thread);
        if self.0.len() <= index {
            self.0.resize_with(index + 1, Step::default);
        }
        &mut self.0[index]
    }
}

impl Trace for Steps {
    fn entered(&mut self, _now: u32, thread: u16, node: Node) {
        self.of(thread).node = Some(node);
    }

    fn thread_started(&mut self, _now: u32, thread: u16, name: &str) {
        *self.of(thread) = Step {
            name: name.to_owned(),
            ..Step::default()
        };
    }

    fn thread_ended(&mut self, now: u32, thread: u16) {
        self.of(thread).ended_ms = Some(now);
    }
}

impl Diagram {
    /// Before its first step.
    pub fn new(program: Rc<Lowered>) -> Self {
        Self {
            machine: Machine::new(program, Options::simulated()),
            steps: None,
        }
    }

    /// The same, remembering which blocks its threads are at.
    #[must_use]
    pub fn remembering(mut self) -> Self {
        self.steps = Some(Steps::default());
        self
    }

    /// The machine, for its variables.
    pub fn machine(&self) -> &Machine {
        &self.machine
    }
}

impl Program for Diagram {
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status {
        match &mut self.steps {
            None => self.machine.step(now_ms, robot, &mut Deaf),
            Some(steps) => self.machine.step(now_ms, robot, steps),
        }
    }

    fn last_tick(&mut self, now_ms: u32, robot: &mut dyn Brick) {
        match &mut self.steps {
            None => self.machine.last_tick(now_ms, robot, &mut Deaf),
            Some(steps) => self.machine.last_tick(now_ms, robot, steps),
        }
    }

    fn stop(&mut self, robot: &mut dyn Brick) {
        self.machine.stop(robot, &mut Deaf);
    }

    fn describe(&self, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
        describe(&self.machine, locale, tell);
    }

    fn errors(&self) -> &[Problem] {
        self.machine.errors()
    }

    fn refusal(&self) -> Option<&Problem> {
        self.machine.program().refusal()
    }

    fn running(&self) -> Vec<Running> {
        let steps = self.steps.as_ref().map_or(&[][..], |steps| &steps.0);
        let lives = steps.iter().any(|step| step.ended_ms.is_none());
        // Of a program that has ended its last threads are told, and of one that runs those that live.
        let last = steps.iter().filter_map(|step| step.ended_ms).max();
        let told = steps.iter().filter(|step| match lives {
            true => step.ended_ms.is_none(),
            false => step.ended_ms == last,
        });
        let program = self.machine.program();
        let running =
            told.filter_map(|step| Some(running(program, &step.name, step.ended_ms, step.node?)));
        running.take(limits::RUNNING_MAX).collect()
    }
}

/// A thread of a diagram at a block.
fn running(program: &Lowered, thread: &str, ended_ms: Option<u32>, node: Node) -> Running {
    let row = program.row(node);
    let cut = |text: &str| text.chars().take(limits::RUNNING_CHARS_MAX).collect();
    let text = |text: Option<&str>| -> String { text.map_or_else(String::new, cut) };
    Running {
        thread: text(Some(thread)),
        ended_ms,
        at: Spot::Block {
            diagram: text(program.diagram(node)),
            id: text(program.id(node)),
            kind: text(row.map(|row| row.kind)),
            caption: Words::new(
                text(row.map(|row| row.shown)),
                text(row.map(|row| row.russian)),
            ),
        },
    }
}

/// Where the threads of a diagram are that live.
pub(super) fn alive(machine: &Machine) -> Vec<Running> {
    let threads = machine.threads().take(limits::RUNNING_MAX);
    let all = threads.map(|(thread, node)| running(machine.program(), thread, None, node));
    all.collect()
}

/// Says what a diagram does at this moment: its variables, and the blocks at which its threads are.
pub(super) fn describe(machine: &Machine, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
    let program = machine.program();
    for (thread, node) in machine.threads() {
        let block = program.row(node).map_or("", |row| row.shown_in(locale));
        tell(Group::Block, thread, block);
    }
    let is_of_port = |name: &str| Port::all().any(|port| port.variable() == Some(name));
    for (name, value) in machine.variables() {
        // Readings have their own place.
        if !is_of_port(name) {
            tell(Group::Variable, name, &value.brief());
        }
    }
}
