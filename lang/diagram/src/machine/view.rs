//! What a running program looks like at a moment: threads, what each does, its calls; expressions asked by a person.
//!
//! Owns the view. Looking changes nothing: an expression is computed on copies, and reads no device.

use super::clocks::Purpose;
use super::formulas::Formulas;
use super::threads::{State, Thread};
use super::trace::Trace;
use super::{Deferred, Env, Machine, words};
use crate::brick::Brick;
use crate::check::aside;
use crate::ports::Port;
use crate::program::{AssignedKind, Leads, Node, Op};
use lang_expr::reserved::{SENSORS, SensorIndex};
use lang_expr::{Outside, Source, Value, Wanted};
use lang_text::problem::Problem;

/// A thread at a moment.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct ThreadView<'a> {
    /// Its number, as traces tell it.
    pub number: u16,
    /// Its name.
    pub name: &'a str,
    /// The block where it is, or which it enters next.
    pub node: Node,
    /// What it does there.
    pub doing: Doing,
    /// The calls that it is in, the outermost first.
    pub calls: Vec<Node>,
    /// Messages that it has not received.
    pub messages: usize,
}

/// What a thread does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Doing {
    /// It enters its block next.
    Enters,
    /// It has run a hundred blocks, and goes on in the next turn.
    GivesWay,
    /// It waits.
    Waits(Waits),
    /// It is held alone.
    Held,
    /// It has failed and ends next.
    Failed,
}

/// What a thread waits for.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Waits {
    /// For a time.
    Time {
        /// How long still, in milliseconds.
        left_ms: u32,
    },
    /// For a reading of a device.
    Device(Port),
    /// For any button.
    AnyButton,
    /// For a message of another robot.
    Mail,
    /// For the answer of a person.
    Answer,
    /// For a message of another thread.
    Message,
    /// For other threads.
    Threads,
    /// For the end of this step: what it waited for is there.
    Step,
    /// For nothing that comes.
    Nothing,
}

impl Machine {
    /// The threads that live.
    pub fn views(&self) -> impl Iterator<Item = ThreadView<'_>> {
        self.threads
            .handles()
            .map(|(handle, thread)| self.view(handle.slot, thread))
    }

    fn view<'a>(&'a self, number: u16, thread: &'a Thread) -> ThreadView<'a> {
        ThreadView {
            number,
            name: &thread.name,
            node: thread.node,
            doing: match &thread.state {
                State::Ready | State::Resumed | State::Starting(_) => Doing::Enters,
                State::Deferred => Doing::GivesWay,
                State::Waiting => Doing::Waits(self.waits(thread.node)),
                State::Held => Doing::Held,
                State::Failed => Doing::Failed,
            },
            calls: thread.stack.iter().map(|frame| frame.node).collect(),
            messages: thread.messages.len(),
        }
    }

    /// How many calls a thread is in.
    pub fn depth(&self, thread: u16) -> usize {
        let found = self.threads.handles();
        let mut found = found.filter(|(handle, _)| handle.slot == thread);
        found.next().map_or(0, |(_, thread)| thread.stack.len())
    }

    /// How much memory a copy of it takes, about.
    pub fn weight(&self) -> usize {
        const FIXED: usize = 4096;
        const THREAD: usize = 256;
        const COUNTER: usize = 64;
        /// An expression is compiled to some code for each of its letters.
        const LETTER: usize = 16;
        let sources = self.program.sources.iter();
        let texts = sources.map(|source| THREAD + source.text.len() * LETTER);
        let values = self.variables().map(|(name, value)| {
            let text = match value {
                Value::Text(text) => text.len(),
                Value::Nil
                | Value::Unset
                | Value::Bool(_)
                | Value::Int(_)
                | Value::Float(_)
                | Value::List(_) => 0,
            };
            COUNTER + name.len() + text + value.cells() as usize * size_of::<Value>()
        });
        let counters = self.tokens.len() + self.forks.len() + self.program.loops as usize;
        FIXED
            + texts.sum::<usize>()
            + values.sum::<usize>()
            + counters * COUNTER
            + self.threads.alive().count() * THREAD
    }

    /// What threads at a block wait for.
    pub(super) fn waits(&self, node: Node) -> Waits {
        let is_put_off =
            |deferred: &Deferred| matches!(deferred, Deferred::Block(found) if *found == node);
        if self.posted.contains(&node) || self.deferred.iter().any(is_put_off) {
            return Waits::Step;
        }
        if let Some(clock) = self.clock(node) {
            return match clock.purpose {
                Purpose::Timer => Waits::Time {
                    left_ms: clock.left_ms(),
                },
                Purpose::Watch => self.watched(node).map_or(Waits::Nothing, Waits::Device),
                Purpose::AnyButton => Waits::AnyButton,
                Purpose::Mail => Waits::Mail,
                Purpose::Ask => Waits::Answer,
            };
        }
        match (self.program.leads(node), self.program.given(node)) {
            (Some(Leads::Join(..)), _) => Waits::Threads,
            (_, Some((_, AssignedKind::Any))) => Waits::Message,
            (
                _,
                Some((_, AssignedKind::Whole | AssignedKind::Text | AssignedKind::Answer)) | None,
            ) => Waits::Nothing,
        }
    }

    fn watched(&self, node: Node) -> Option<Port> {
        let Some(Op::Watch { watch, .. }) = self.program.ops.get(node as usize) else {
            return None;
        };
        let watching = self.program.watches.get(*watch as usize)?;
        watching.port.as_ref().ok().copied()
    }

    /// The value of an expression as the program would compute it now. Nothing changes by it: it assigns
    /// nothing, and sensors have the readings that the program has.
    pub fn evaluate_aside(&self, text: &str) -> Result<Value, Vec<Problem>> {
        let value = self.compute_aside(text)?;
        match aside::assignment(text) {
            None => Ok(value),
            Some(problem) => Err(vec![problem]),
        }
    }

    fn compute_aside(&self, text: &str) -> Result<Value, Vec<Problem>> {
        let mut formulas = self.formulas.clone();
        let mut robot = Onlooker {
            machine: self,
            lacking: None,
        };
        let value = formulas.evaluate_text(text, Wanted::Any, &mut robot)?;
        match robot.lacking {
            None => Ok(value),
            Some(problem) => Err(vec![problem]),
        }
    }

    /// What is wrong with an expression whatever the program does from here on; nothing, if it may be good.
    pub fn mistakes_aside(&self, text: &str) -> Vec<Problem> {
        self.known(|known| aside::mistakes(known, text))
    }

    fn known<T>(&self, ask: impl FnOnce(&aside::Known<'_>) -> T) -> T {
        ask(&aside::Known {
            program: &self.program,
            names: self.formulas.names(),
            has_value: &|name| self.variable(name).is_some(),
        })
    }

    /// Why this is not the name of a variable, or of a sensor that the program reads; nothing, if it is.
    pub fn no_variable(&self, name: &str) -> Vec<Problem> {
        match is_name(name) {
            true => self.known(|known| aside::no_variable(known, name)),
            false => vec![Problem::error(words::no_name(name))],
        }
    }

    /// What a variable holds, or the variable of a sensor that the program reads.
    pub fn value_of(&self, name: &str) -> Option<Value> {
        let sensor = SENSORS.iter().position(|sensor| sensor.name == name);
        let reading = sensor.and_then(|index| self.sensors.known(index));
        reading.or_else(|| self.variable(name))
    }

    /// What is wrong with the answer of a person for this variable, as far as that can be known without the robot; nothing,
    /// if it may be good.
    pub(super) fn wrong_answer(
        &self,
        variable: &str,
        text: &str,
        may_be_empty: bool,
    ) -> Vec<Problem> {
        if text.is_empty() {
            return match may_be_empty {
                true => Vec::new(),
                false => vec![Problem::error(words::must_answer())],
            };
        }
        let opening = format!("{variable} = ");
        let statement = format!("{opening}{text}");
        match self.tried(&opening, &statement) {
            (Ok(_), _) => {}
            // The robot knows more: what it measures, or chance.
            (Err(_), true) => return Vec::new(),
            (Err(problems), false) => return problems,
        }
        match self.known(|known| aside::fights(known, variable, &statement)) {
            true => vec![Problem::error(words::answer_does_not_fit(variable))],
            false => Vec::new(),
        }
    }

    /// The variables after a statement that is run without the robot, or what is wrong with it, at places after its opening;
    /// and whether it asked for something that only the robot knows.
    fn tried(&self, opening: &str, statement: &str) -> (Result<Formulas, Vec<Problem>>, bool) {
        let mut formulas = self.formulas.clone();
        let mut robot = Onlooker {
            machine: self,
            lacking: None,
        };
        let ran = formulas.run_typed(statement, &mut robot);
        let lacks = robot.lacking.is_some();
        match ran {
            Ok(()) => (Ok(formulas), lacks),
            Err(problems) => (Err(without(opening, problems)), lacks),
        }
    }

    /// Assigns a variable as a block with this expression would; the trace hears it as the doing of a thread.
    pub fn assign(
        &mut self,
        variable: &str,
        text: &str,
        thread: u16,
        brick: &mut dyn Brick,
        trace: &mut dyn Trace,
    ) -> Result<(), Vec<Problem>> {
        if !is_name(variable) {
            return Err(vec![Problem::error(words::no_name(variable))]);
        }
        if let Some(problem) = self.known(|known| aside::no_assignment(known, variable)) {
            return Err(vec![problem]);
        }
        let source = Source::new(text, Wanted::Statements);
        let second = source.tree().statements().get(1).copied();
        if text.trim().is_empty() || second.is_some() {
            let mut problem = Problem::error(words::one_expression(variable));
            problem.place.position = second.map(|part| source.tree().place(part));
            return Err(vec![problem]);
        }
        // Its errors have columns of this text. In brackets it is no assignment.
        self.compute_aside(text)?;
        let opening = format!("{variable} = (");
        let statement = format!("{opening}{text})");
        let (tried, _) = self.tried(&opening, &statement);
        let formulas = tried?;
        if let Some(Value::Float(number)) = formulas.get(variable)
            && !number.is_finite()
        {
            return Err(vec![Problem::error(words::not_finite(variable))]);
        }
        let env = &mut Env { brick, trace };
        let now = self.now;
        self.formulas = formulas;
        self.formulas
            .changed(|name, value| env.trace.changed(now, thread, name, value));
        Ok(())
    }
}

/// Problems of a statement with columns of what follows its opening.
fn without(opening: &str, mut problems: Vec<Problem>) -> Vec<Problem> {
    let before = opening.chars().count() as u32;
    for problem in &mut problems {
        if let Some(position) = problem.place.position.as_mut().filter(|at| at.line == 1) {
            position.column = position.column.saturating_sub(before).max(1);
        }
    }
    problems
}

/// Whether a text can be the name of a variable.
fn is_name(text: &str) -> bool {
    let mut chars = text.chars();
    let begins = chars
        .next()
        .is_some_and(|c| c.is_ascii_alphabetic() || c == '_');
    begins && chars.all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// The robot for somebody who only looks.
struct Onlooker<'a> {
    machine: &'a Machine,
    /// What cannot be had without touching the robot.
    lacking: Option<Problem>,
}

impl Outside for Onlooker<'_> {
    fn sensor(&mut self, sensor: SensorIndex) -> Value {
        match self.machine.sensors.known(usize::from(sensor)) {
            Some(value) => value,
            None => {
                let name = SENSORS.get(usize::from(sensor)).map_or("", |row| row.name);
                self.lacking = Some(Problem::error(words::not_read(name)));
                Value::default()
            }
        }
    }

    fn time(&mut self) -> i32 {
        i32::try_from(self.machine.now).unwrap_or(i32::MAX)
    }

    fn print(&mut self, _text: &str) {
        self.lacking = Some(Problem::error(words::only_looked("print")));
    }

    fn random(&mut self, _below: i32) -> i32 {
        self.lacking = Some(Problem::error(words::only_looked("random")));
        0
    }
}
