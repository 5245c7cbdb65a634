//! Blocks that wait: what they ask for, how often, and when they are satisfied.
//!
//! Owns the rules of the original: every 20 ms, encoders every step, buttons of the gamepad every 200 ms, messages every
//! 100 ms; a sensor that is read for its variable answers the blocks that wait for it as well.

use super::clocks::Purpose;
use super::flow::Flow;
use super::threads::Handle;
use super::{Env, Machine, words};
use crate::blocks::Type;
use crate::blocks::wait::Every;
use crate::brick::{Answer, Question};
use crate::ports::{Port, Sort};
use crate::program::{NOWHERE, Node, Op, Program, WatchedFor, Watching};
use lang_expr;

/// What a look at a device gave.
enum Look {
    /// It is so.
    Holds,
    /// Not yet.
    Waits,
    /// There is no such device.
    Absent,
    /// An error that was told.
    Failed,
}

/// The statement that assigns a message of another robot as a text.
pub(super) fn mail(program: &Program, assignment: u32, message: &str) -> String {
    let variable = program
        .assignments
        .get(assignment as usize)
        .map_or("", |assignment| &*assignment.variable);
    let unquoted = message
        .strip_prefix('"')
        .and_then(|inner| inner.strip_suffix('"'))
        .unwrap_or(message);
    format!("{variable} = \"{}\"", lang_expr::escape(unquoted))
}

impl Machine {
    /// A thread that has come to a block waits there until something answers, which is asked for every so many
    /// milliseconds.
    pub(super) fn wait_for(
        &mut self,
        handle: Handle,
        node: Node,
        purpose: Purpose,
        every_ms: i32,
    ) -> Flow {
        self.set_clock(node, purpose, every_ms);
        self.wait(handle, node)
    }

    /// A thread has come to a block that waits for a device.
    pub(super) fn watch(
        &mut self,
        handle: Handle,
        node: Node,
        watching: &Watching,
        env: &mut Env<'_>,
    ) -> Flow {
        let every_ms = match watching.wait.every {
            // A clock rings at most once in a step.
            Every::Step => 1,
            Every::Ms(ms) => ms,
        };
        let flow = self.wait_for(handle, node, Purpose::Watch, every_ms);
        match self.measure(node, watching, env) {
            Look::Waits => flow,
            Look::Holds => {
                self.satisfy(node);
                flow
            }
            Look::Failed => {
                self.drop_clock(node);
                Flow::Failed
            }
            Look::Absent => {
                self.drop_clock(node);
                let port = match &watching.port {
                    Ok(port) => port.name(),
                    Err(name) => name,
                };
                self.error_at(node, (watching.wait.absent)(port), env);
                Flow::Failed
            }
        }
    }

    /// The clock of a block rings.
    pub(super) fn ring(&mut self, node: Node, env: &mut Env<'_>) {
        let Some(clock) = self.clock(node) else {
            return;
        };
        match clock.purpose {
            Purpose::Timer => {
                self.drop_clock(node);
                self.done(node);
            }
            Purpose::Watch => self.look_again(node, env),
            Purpose::AnyButton => self.look_at_buttons(node, env),
            Purpose::Mail => {
                let program = self.program.clone();
                if let Some(Op::Mail { assignment, .. }) = program.ops.get(node as usize)
                    && let Some(message) = env.brick.mail().filter(|text| !text.is_empty())
                {
                    let statement = mail(&program, *assignment, &message);
                    self.drop_clock(node);
                    if self.assign_for_waiting(node, &statement, env) {
                        self.done(node);
                    }
                }
            }
            Purpose::Ask => self.ask(node, env),
        }
    }

    /// Sensor variables were refreshed: a thread that waits for a sensor has an answer.
    pub(super) fn answer_waits(&mut self, env: &mut Env<'_>) {
        let mut after = None;
        while let Some(node) = self.next_clock(after) {
            after = Some(node);
            if self
                .clock(node)
                .is_some_and(|clock| clock.purpose == Purpose::Watch)
            {
                self.look_again(node, env);
            }
        }
    }

    /// Readings that somebody else has given to sensors: variables show them, and blocks that wait for them have an answer.
    pub(super) fn hear_announced(&mut self, env: &mut Env<'_>) {
        while let Some((port, reading)) = env.brick.announced() {
            self.sensors.put(port, &[reading]);
            let program = self.program.clone();
            let mut after = None;
            while let Some(node) = self.next_clock(after) {
                after = Some(node);
                let Some(Op::Watch { watch, .. }) = program.ops.get(node as usize) else {
                    continue;
                };
                let watching = &program.watches[*watch as usize];
                if watching.port == Ok(port) {
                    let look = self.compare(node, watching, reading, env);
                    self.conclude(node, look, env);
                }
            }
        }
    }

    fn look_again(&mut self, node: Node, env: &mut Env<'_>) {
        let program = self.program.clone();
        let Some(Op::Watch { watch, .. }) = program.ops.get(node as usize) else {
            return;
        };
        let look = self.measure(node, &program.watches[*watch as usize], env);
        self.conclude(node, look, env);
    }

    fn conclude(&mut self, node: Node, look: Look, env: &mut Env<'_>) {
        match look {
            Look::Holds => self.satisfy(node),
            Look::Failed => {
                self.drop_clock(node);
                self.fail_all_at(node, env);
            }
            Look::Waits | Look::Absent => {}
        }
    }

    /// The block is done when the events of this step are through.
    fn satisfy(&mut self, node: Node) {
        self.drop_clock(node);
        self.posted.push_back(node);
    }

    fn measure(&mut self, node: Node, watching: &Watching, env: &mut Env<'_>) -> Look {
        let Ok(port) = watching.port else {
            return Look::Absent;
        };
        let Some(reading) = self.reading(port, watching, env) else {
            return Look::Absent;
        };
        self.compare(node, watching, reading, env)
    }

    fn compare(
        &mut self,
        node: Node,
        watching: &Watching,
        reading: i32,
        env: &mut Env<'_>,
    ) -> Look {
        let holds = match watching.until {
            WatchedFor::Positive => reading > 0,
            WatchedFor::Zero => reading == 0,
            WatchedFor::Compared(sign, source) => {
                match self.evaluate(node, source, Type::Whole, env) {
                    None => return Look::Failed,
                    Some(value) => sign.holds(reading, value.to_int()),
                }
            }
        };
        if holds { Look::Holds } else { Look::Waits }
    }

    fn reading(&mut self, port: Port, watching: &Watching, env: &mut Env<'_>) -> Option<i32> {
        // What is read for a block is shown by the variable too.
        if super::sensors::is_scalar(port) {
            let reading = env.brick.scalar(port)?;
            self.sensors.put(port, &[reading]);
            return Some(reading);
        }
        self.scratch.clear();
        if !env.brick.vector(port, &mut self.scratch) {
            return None;
        }
        self.sensors.put(port, &self.scratch);
        Some(watching.measure.of(&self.scratch))
    }

    fn look_at_buttons(&mut self, node: Node, env: &mut Env<'_>) {
        let program = self.program.clone();
        let Some(Op::AnyButton { assignment, .. }) = program.ops.get(node as usize) else {
            return;
        };
        let Some(assignment) = program.assignments.get(*assignment as usize) else {
            return;
        };
        let reading = |port| {
            let kept = env.brick.locked(port);
            kept.or_else(|| env.brick.scalar(port)).unwrap_or(0)
        };
        let mut reading = reading;
        let pressed = Port::all().find_map(|port| match port.sort() {
            Sort::Button(code) if reading(port) != 0 => Some(code),
            Sort::Motor
            | Sort::Servo
            | Sort::Encoder
            | Sort::Scalar
            | Sort::Vector
            | Sort::Button(_) => None,
        });
        let code = match pressed {
            Some(code) => code,
            None if assignment.wait => return,
            None => -1,
        };
        let statement = format!("{} = {code}", assignment.variable);
        self.drop_clock(node);
        if self.assign_for_waiting(node, &statement, env) {
            self.posted.push_back(node);
        }
    }

    /// Runs a statement for the thread that waits at a block; false after an error, with which it has ended.
    fn assign_for_waiting(&mut self, node: Node, statement: &str, env: &mut Env<'_>) -> bool {
        let waiting = self.threads.waiting_at(node);
        let slot = waiting.first().map_or(0, |handle| handle.slot);
        let is_good = self.run_text(node, slot, statement, env);
        if !is_good {
            self.fail_all_at(node, env);
        }
        is_good
    }

    fn ask(&mut self, node: Node, env: &mut Env<'_>) {
        let program = self.program.clone();
        let Some(&Op::Ask {
            assignment,
            next,
            cancel,
        }) = program.ops.get(node as usize)
        else {
            return;
        };
        let assignment = &program.assignments[assignment as usize];
        let question = Question {
            variable: &assignment.variable,
            prompt: &assignment.prompt,
            default: &assignment.default,
        };
        let (text, is_answer) = match env.brick.ask(question) {
            Answer::Waiting => return,
            Answer::Text(text) if text.is_empty() => (assignment.default.to_string(), true),
            Answer::Text(text) => (text, true),
            Answer::Cancelled => (String::new(), false),
        };
        if is_answer && env.brick.may_ask_again(question) {
            let wrong = self.wrong_answer(&assignment.variable, &text, cancel != NOWHERE);
            if !wrong.is_empty() {
                env.brick.ask_again(question, &wrong);
                return;
            }
        }
        self.drop_clock(node);
        if !text.is_empty() {
            let statement = format!("{} = {text}", assignment.variable);
            if self.assign_for_waiting(node, &statement, env) {
                self.lead(node, next);
            }
        } else if cancel != NOWHERE {
            self.lead(node, cancel);
        } else {
            let mut problem = lang_text::problem::Problem::warning(words::must_answer());
            problem.place = program.place(node);
            env.trace.trap(self.now, &problem);
            self.lead(node, node);
        }
    }

    /// Whether anything answers on a port.
    pub(super) fn answers(&mut self, port: Port, env: &mut Env<'_>) -> bool {
        if super::sensors::is_scalar(port) {
            return env.brick.scalar(port).is_some();
        }
        self.scratch.clear();
        env.brick.vector(port, &mut self.scratch)
    }
}
