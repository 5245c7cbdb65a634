//! Blocks that wait: what they ask for, how often, and when they are satisfied.
//!
//! Owns the rules of the original: every 20 ms, encoders every step, buttons of the gamepad every 200 ms, messages every
//! 100 ms; a sensor that is read for its variable answers the blocks that wait for it as well.

use super::clocks::Purpose;
use super::{Env, Machine, words};
use crate::blocks::{Copied, Type, Watch};
use crate::brick::{Answer, Question};
use crate::ports::{Port, Sort};
use crate::program::{Axis, NOWHERE, Node, Op, Program, Watching};
use lang_expr;
use lang_text::problem::Words;

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
    /// A thread has come to a block that waits; false after an error that was told.
    pub(super) fn start_waiting(
        &mut self,
        program: &Program,
        node: Node,
        op: &Op,
        env: &mut Env<'_>,
    ) -> bool {
        match *op {
            Op::Watch { watch, .. } => {
                let watching = &program.watches[watch as usize];
                let interval = match watching.watch {
                    Watch::Encoder(_) => 1,
                    Watch::PadButton => 200,
                    Watch::Sensor(_)
                    | Watch::Gyroscope(_)
                    | Watch::Acceleration(_)
                    | Watch::Touch
                    | Watch::Motion
                    | Watch::Button
                    | Watch::Pad
                    | Watch::Wheel(_)
                    | Watch::Connected
                    | Watch::Disconnected => 20,
                };
                self.set_clock(node, Purpose::Watch, interval);
                match self.look(node, watching, env) {
                    Look::Waits => true,
                    Look::Holds => {
                        self.satisfy(node);
                        true
                    }
                    Look::Failed => {
                        self.drop_clock(node);
                        false
                    }
                    Look::Absent => {
                        self.drop_clock(node);
                        self.error_at(node, absent(watching), env);
                        false
                    }
                }
            }
            Op::AnyButton { .. } => {
                self.set_clock(node, Purpose::AnyButton, 20);
                true
            }
            Op::Mail { .. } => {
                self.set_clock(node, Purpose::Mail, 100);
                true
            }
            Op::Ask { .. } => {
                self.set_clock(node, Purpose::Ask, 1);
                true
            }
            Op::Pass { .. }
            | Op::End
            | Op::Fault { .. }
            | Op::Run { .. }
            | Op::If { .. }
            | Op::Loop { .. }
            | Op::Switch { .. }
            | Op::Fork { .. }
            | Op::Join { .. }
            | Op::Kill { .. }
            | Op::Send { .. }
            | Op::Receive { .. }
            | Op::Call { .. }
            | Op::Timer { .. }
            | Op::Random { .. }
            | Op::Copy { .. }
            | Op::Act { .. } => true,
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
                self.done(node, env);
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
                        self.done(node, env);
                    }
                }
            }
            Purpose::Ask => self.ask(node, env),
        }
    }

    /// Sensor variables were refreshed: whoever waits for a sensor has an answer.
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

    fn look_again(&mut self, node: Node, env: &mut Env<'_>) {
        let program = self.program.clone();
        let Some(Op::Watch { watch, .. }) = program.ops.get(node as usize) else {
            return;
        };
        match self.look(node, &program.watches[*watch as usize], env) {
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

    fn look(&mut self, node: Node, watching: &Watching, env: &mut Env<'_>) -> Look {
        let Ok(port) = watching.port else {
            return Look::Absent;
        };
        let Some(reading) = self.reading(port, watching, env) else {
            return Look::Absent;
        };
        let holds = match (watching.watch, watching.source) {
            (Watch::Disconnected, _) => reading == 0,
            (_, None) => reading > 0,
            (_, Some(source)) => match self.evaluate(node, source, Type::Whole, env) {
                None => return Look::Failed,
                Some(value) => watching.sign.holds(reading, value.to_int()),
            },
        };
        if holds { Look::Holds } else { Look::Waits }
    }

    fn reading(&mut self, port: Port, watching: &Watching, env: &mut Env<'_>) -> Option<i32> {
        if super::sensors::is_scalar(port) {
            return env.brick.scalar(port);
        }
        self.scratch.clear();
        if !env.brick.vector(port, &mut self.scratch) {
            return None;
        }
        let number = |index: usize| self.scratch.get(index).copied().unwrap_or(0);
        Some(match (watching.watch, watching.axis) {
            // Millidegrees, the last of seven numbers.
            (Watch::Gyroscope(_), _) => number(6) / 1000,
            (Watch::Acceleration(_), Axis::Y) => number(1),
            (Watch::Acceleration(_), Axis::Z) => number(2),
            (Watch::Acceleration(_), Axis::Length) => {
                let squares = (0..3).map(|axis| f64::from(number(axis)).powi(2));
                squares.sum::<f64>().sqrt() as i32
            }
            _ => number(0),
        })
    }

    fn look_at_buttons(&mut self, node: Node, env: &mut Env<'_>) {
        let program = self.program.clone();
        let Some(Op::AnyButton { assignment, .. }) = program.ops.get(node as usize) else {
            return;
        };
        let Some(assignment) = program.assignments.get(*assignment as usize) else {
            return;
        };
        let pressed = Port::all().find_map(|port| match port.sort() {
            Sort::Button(code) if env.brick.scalar(port).unwrap_or(0) != 0 => Some(code),
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

    /// Runs a statement for whoever waits at a block; false after an error, with which they have ended.
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
        let answer = env.brick.ask(Question {
            variable: &assignment.variable,
            prompt: &assignment.prompt,
            default: &assignment.default,
        });
        let text = match answer {
            Answer::Waiting => return,
            Answer::Text(text) if text.is_empty() => assignment.default.to_string(),
            Answer::Text(text) => text,
            Answer::Cancelled => String::new(),
        };
        self.drop_clock(node);
        if !text.is_empty() {
            let statement = format!("{} = {text}", assignment.variable);
            if self.assign_for_waiting(node, &statement, env) {
                self.lead(node, next, env);
            }
        } else if cancel != NOWHERE {
            self.lead(node, cancel, env);
        } else {
            let mut problem = lang_text::problem::Problem::warning(words::must_answer());
            problem.place = program.place(node);
            env.trace.trap(self.now, &problem);
            self.lead(node, node, env);
        }
    }

    /// Whether a block copies a sensor that is not there.
    pub(super) fn lacks_copied(
        &mut self,
        program: &Program,
        node: Node,
        env: &mut Env<'_>,
    ) -> bool {
        let Some(Op::Copy {
            copied: Copied::Lidar,
            ..
        }) = program.ops.get(node as usize)
        else {
            return false;
        };
        self.scratch.clear();
        let port = Port::named("LidarPort");
        !port.is_some_and(|port| env.brick.vector(port, &mut self.scratch))
    }
}

/// What is said of a device that is not there.
fn absent(watching: &Watching) -> Words {
    let port = match &watching.port {
        Ok(port) => port.name(),
        Err(name) => name,
    };
    match watching.watch {
        Watch::Button => words::no_button(port),
        Watch::Encoder(_) => words::not_configured("Encoder", port),
        Watch::Gyroscope(_) => words::not_configured("Gyroscope", port),
        Watch::Acceleration(_) => words::not_configured("Accelerometer", port),
        Watch::Touch => words::not_configured("Touch sensor", port),
        Watch::Motion => words::not_configured("Motion sensor", port),
        Watch::Sensor(_) => words::not_configured("Sensor", port),
        Watch::PadButton
        | Watch::Pad
        | Watch::Wheel(_)
        | Watch::Connected
        | Watch::Disconnected => words::not_configured("Gamepad", port),
    }
}
