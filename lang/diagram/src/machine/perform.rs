//! Device commands of blocks, and expressions with their errors at the right block.
//!
//! Owns the way from an action with its evaluated properties to a [`Command`].

use super::sensors::Robot;
use super::{Env, Machine};
use crate::blocks::Type;
use crate::blocks::act::{Effect, Operands, WHOLES_MAX};
use crate::brick::Command;
use crate::ports::{Direction, Port, Sort};
use crate::program::{Action, Node, Source};
use lang_expr::Value;
use lang_text::problem::Problem;

impl Machine {
    /// The value of an expression; `None` after errors that were told.
    pub(super) fn evaluate(
        &mut self,
        node: Node,
        source: Source,
        wanted: Type,
        env: &mut Env<'_>,
    ) -> Option<Value> {
        let mut robot = Robot {
            sensors: &mut self.sensors,
            brick: env.brick,
            now: self.now,
        };
        let value = match wanted {
            Type::Truth => self.formulas.truth(source, &mut robot).map(Value::Bool),
            Type::Whole => self.formulas.whole(source, &mut robot).map(Value::Int),
            Type::Statements | Type::Number | Type::Text | Type::Printed | Type::List => {
                self.formulas.evaluate(source, &mut robot)
            }
        };
        match value {
            Ok(value) => Some(value),
            Err(problems) => {
                self.tell_of(node, source, problems, env);
                None
            }
        }
    }

    /// The value of an expression as a whole number; `None` after errors that were told.
    fn whole(&mut self, node: Node, source: Source, env: &mut Env<'_>) -> Option<i32> {
        let mut robot = Robot {
            sensors: &mut self.sensors,
            brick: env.brick,
            now: self.now,
        };
        match self.formulas.whole(source, &mut robot) {
            Ok(whole) => Some(whole),
            Err(problems) => {
                self.tell_of(node, source, problems, env);
                None
            }
        }
    }

    /// Runs a statement that a block has put together; false after errors that were told. Their place is the block alone:
    /// nobody has written the statement into it.
    pub(super) fn run_text(
        &mut self,
        node: Node,
        thread: u16,
        statement: &str,
        env: &mut Env<'_>,
    ) -> bool {
        let mut robot = Robot {
            sensors: &mut self.sensors,
            brick: env.brick,
            now: self.now,
        };
        if let Err(problems) = self.formulas.run_text(statement, &mut robot) {
            for mut problem in problems {
                problem.place = self.program.place(node);
                self.report(problem, env);
            }
            return false;
        }
        let now = self.now;
        self.formulas
            .changed(|name, value| env.trace.changed(now, thread, name, value));
        true
    }

    /// Errors of an expression of the program, at its block and property.
    #[cold]
    fn tell_of(&mut self, node: Node, source: Source, problems: Vec<Problem>, env: &mut Env<'_>) {
        let text = self.program.sources.get(source as usize);
        let property = text.map_or("", |text| text.property);
        self.tell_all(node, property, problems, env);
    }

    /// Errors of an expression, at this block and property.
    fn tell_all(&mut self, node: Node, property: &str, problems: Vec<Problem>, env: &mut Env<'_>) {
        for mut problem in problems {
            let position = problem.place.position;
            problem.place = self.program.place(node);
            problem.place.property = Some(property.to_owned());
            problem.place.position = position;
            self.report(problem, env);
        }
    }

    /// Tells the robot what a block says; `None` after errors that were told, true if the flow goes on only when the
    /// events of this step are through.
    pub(super) fn perform(
        &mut self,
        node: Node,
        action: &Action,
        env: &mut Env<'_>,
    ) -> Option<bool> {
        match action.act.effect {
            Effect::Drive(sign) => {
                let source = *action.sources.get(1)?;
                let power = self.whole(node, source, env)?.saturating_mul(sign);
                self.for_motors(node, action, env, |port| match port.sort() {
                    Sort::Servo => Command::Servo {
                        port,
                        degrees: power,
                    },
                    Sort::Motor | Sort::Encoder | Sort::Scalar | Sort::Vector | Sort::Button(_) => {
                        Command::Power {
                            port,
                            percent: power.clamp(-100, 100),
                        }
                    }
                })?;
            }
            Effect::Stop => {
                let brake = action.texts.first().is_some_and(|mode| &**mode == "brake");
                self.for_motors(node, action, env, |port| Command::Off { port, brake })?;
            }
            Effect::ResetEncoders => {
                for &port in &action.ports {
                    if port.sort() == Sort::Encoder {
                        env.brick.command(Command::ResetEncoder { port });
                        self.sensors.put(port, &[0]);
                    }
                }
                return Some(true);
            }
            Effect::Command(command) => {
                self.one(node, action, command, env)?;
                if action.redraws {
                    env.brick.command(Command::Redraw);
                }
            }
        }
        Some(false)
    }

    /// A command to each port of the list.
    fn for_motors(
        &mut self,
        node: Node,
        action: &Action,
        env: &mut Env<'_>,
        command: impl Fn(Port) -> Command<'static>,
    ) -> Option<()> {
        if !action.ports.is_empty() {
            for &port in &action.ports {
                env.brick.command(command(port));
            }
            return Some(());
        }
        let list = self.evaluate(node, *action.sources.first()?, Type::List, env)?;
        for name in list.to_texts() {
            // What is no port is left out, as in the original.
            if let Some(port) = Port::find(self.program.kit, &name, Direction::Out) {
                env.brick.command(command(port));
            }
        }
        Some(())
    }

    /// Evaluates the properties, whole numbers before the text, and gives the command that the row makes of them.
    fn one(
        &mut self,
        node: Node,
        action: &Action,
        command: fn(Operands<'_>) -> Command<'_>,
        env: &mut Env<'_>,
    ) -> Option<()> {
        let mut wholes = [0; WHOLES_MAX];
        let mut count = 0;
        let (mut computed, mut is_unset) = (None, false);
        for &source in &action.sources {
            if self.wanted(source) != Type::Whole {
                computed = Some(source);
            } else if let Some(whole) = wholes.get_mut(count) {
                *whole = self.whole(node, source, env)?;
                count += 1;
            }
        }
        let computed = match computed {
            None => None,
            Some(source) => {
                let value = self.evaluate(node, source, Type::Text, env)?;
                is_unset = matches!(value, Value::Unset);
                Some(if action.act.is_label {
                    value.printed()
                } else {
                    value.to_text()
                })
            }
        };
        let written = action.texts.first().map_or("", |text| &**text);
        env.brick.command(command(Operands {
            wholes,
            count,
            written,
            text: computed.as_deref().unwrap_or(written),
            is_unset,
            numbers: &action.numbers,
            flags: &action.flags,
        }));
        Some(())
    }

    /// What a block wants of an expression.
    fn wanted(&self, source: Source) -> Type {
        let text = self.program.sources.get(source as usize);
        text.map_or(Type::Text, |text| text.wanted)
    }
}
