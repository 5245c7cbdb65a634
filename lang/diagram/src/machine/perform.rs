//! Device commands of blocks, and expressions with their errors at the right block.
//!
//! Owns the way from an action with its evaluated properties to a [`Command`].

use super::sensors::Robot;
use super::{Env, Machine};
use crate::blocks::{Act, Type};
use crate::brick::{Command, Figure};
use crate::ports::{Port, Sort, Way};
use crate::program::{Action, Node, Source};
use lang_expr::Value;
use lang_text::problem::Problem;

/// Height of letters when a block asks for none.
const FONT_SIZE: i32 = 20;

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
            _ => self.formulas.evaluate(source, &mut robot),
        };
        match value {
            Ok(value) => Some(value),
            Err(problems) => {
                let text = self.program.sources.get(source as usize);
                let property = text.map_or("", |text| text.property);
                self.tell_all(node, property, problems, env);
                None
            }
        }
    }

    /// Runs a statement that a block has put together; false after errors that were told.
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
        match self.formulas.run_text(statement, &mut robot) {
            Ok(()) => {
                let now = self.now;
                self.formulas
                    .changed(|name, value| env.trace.changed(now, thread, name, value));
                true
            }
            Err(problems) => {
                self.tell_all(node, "", problems, env);
                false
            }
        }
    }

    /// Errors of an expression, at its block and property.
    fn tell_all(&mut self, node: Node, property: &str, problems: Vec<Problem>, env: &mut Env<'_>) {
        for mut problem in problems {
            let position = problem.place.position;
            problem.place = self.program.place(node);
            problem.place.property = Some(property.to_owned());
            problem.place.position = position;
            self.tell(problem, env);
        }
    }

    fn whole(&mut self, node: Node, action: &Action, at: usize, env: &mut Env<'_>) -> Option<i32> {
        let source = *action.sources.get(at)?;
        let value = self.evaluate(node, source, Type::Whole, env)?;
        Some(value.to_int())
    }

    fn wholes<const N: usize>(
        &mut self,
        node: Node,
        action: &Action,
        env: &mut Env<'_>,
    ) -> Option<[i32; N]> {
        let mut numbers = [0; N];
        for (at, number) in numbers.iter_mut().enumerate() {
            *number = self.whole(node, action, at, env)?;
        }
        Some(numbers)
    }

    /// Tells the robot what a block says; `None` after errors that were told, true if the flow goes on only when the
    /// events of this step are through.
    pub(super) fn perform(
        &mut self,
        node: Node,
        action: &Action,
        env: &mut Env<'_>,
    ) -> Option<bool> {
        match action.act {
            Act::Forward | Act::Backward | Act::Stop => self.motors(node, action, env)?,
            Act::ClearEncoders => {
                for &port in &action.ports {
                    if port.sort() == Sort::Encoder {
                        env.brick.tell(Command::ResetEncoder { port });
                    }
                }
                return Some(true);
            }
            Act::Say
            | Act::System
            | Act::WriteFile
            | Act::SendMail
            | Act::JoinNetwork
            | Act::Print => self.texts(node, action, env)?,
            Act::PenWidth | Act::Pixel | Act::Line | Act::Rectangle | Act::Ellipse | Act::Arc => {
                self.draw(node, action, env)?
            }
            _ => plain(action, env),
        }
        Some(false)
    }

    fn motors(&mut self, node: Node, action: &Action, env: &mut Env<'_>) -> Option<()> {
        let power = match action.act {
            Act::Stop => 0,
            Act::Backward => self.whole(node, action, 1, env)?.saturating_neg(),
            _ => self.whole(node, action, 1, env)?,
        };
        let brake = action.texts.first().is_some_and(|mode| &**mode == "brake");
        let tell = |port: Port, env: &mut Env<'_>| {
            env.brick.tell(match (action.act, port.sort()) {
                (Act::Stop, _) => Command::Off { port, brake },
                (_, Sort::Servo) => Command::Servo {
                    port,
                    degrees: power,
                },
                _ => Command::Power {
                    port,
                    percent: power.clamp(-100, 100),
                },
            });
        };
        if !action.ports.is_empty() {
            action.ports.iter().for_each(|&port| tell(port, env));
            return Some(());
        }
        let list = self.evaluate(node, *action.sources.first()?, Type::List, env)?;
        for name in list.to_texts() {
            // What is no port is left out, as in the original.
            if let Some(port) = Port::find(self.program.kit, &name, Way::Out) {
                tell(port, env);
            }
        }
        Some(())
    }

    fn texts(&mut self, node: Node, action: &Action, env: &mut Env<'_>) -> Option<()> {
        if action.act == Act::Print {
            return self.print(node, action, env);
        }
        let value = match action.sources.first() {
            None => None,
            Some(&source) if matches!(action.act, Act::SendMail | Act::JoinNetwork) => {
                Some(self.evaluate(node, source, Type::Whole, env)?)
            }
            Some(&source) => Some(self.evaluate(node, source, Type::Text, env)?),
        };
        let written = action.texts.first().map_or("", |text| &**text);
        let told = value.as_ref().map(Value::to_text);
        let text = told.as_deref().unwrap_or(written);
        let number = value.as_ref().map(Value::to_int);
        env.brick.tell(match action.act {
            Act::Say => Command::Say { text },
            Act::System => Command::System {
                command: text,
                code: action.flags.first().copied().unwrap_or(false),
            },
            Act::WriteFile => Command::Append {
                file: written,
                text,
            },
            Act::SendMail => Command::Send {
                message: written,
                hull: number,
            },
            _ => Command::Join {
                address: written,
                port: action.numbers.first().copied().unwrap_or(0),
                hull: number.unwrap_or(0),
            },
        });
        Some(())
    }

    fn print(&mut self, node: Node, action: &Action, env: &mut Env<'_>) -> Option<()> {
        let [x, y] = self.wholes(node, action, env)?;
        let last = action.sources.len().checked_sub(1)?;
        let size = match last {
            // The former block has no size.
            0 | 1 => FONT_SIZE,
            _ => self.whole(node, action, last, env)?,
        };
        let told = match action.texts.first() {
            Some(_) => None,
            None => {
                let source = *action.sources.get(2)?;
                let value = self.evaluate(node, source, Type::Text, env)?;
                Some(value.printed())
            }
        };
        let written = action.texts.first().map_or("", |text| &**text);
        env.brick.tell(Command::Label {
            x,
            y,
            size: if size > 0 { size } else { FONT_SIZE },
            text: told.as_deref().unwrap_or(written),
        });
        redraw(action, env);
        Some(())
    }

    fn draw(&mut self, node: Node, action: &Action, env: &mut Env<'_>) -> Option<()> {
        let filled = action.flags.len() > 1 && action.flags.first().copied().unwrap_or(false);
        let figure = match action.act {
            Act::Pixel => Figure::Pixel(self.wholes(node, action, env)?),
            Act::Line => Figure::Line(self.wholes(node, action, env)?),
            Act::Rectangle => Figure::Rectangle(self.wholes(node, action, env)?, filled),
            Act::Ellipse => Figure::Ellipse(self.wholes(node, action, env)?, filled),
            Act::Arc => Figure::Arc(self.wholes(node, action, env)?),
            _ => {
                let [width] = self.wholes(node, action, env)?;
                env.brick.tell(Command::PenWidth { width });
                return Some(());
            }
        };
        env.brick.tell(Command::Draw(figure));
        redraw(action, env);
        Some(())
    }
}

/// The last flag of what draws.
fn redraw(action: &Action, env: &mut Env<'_>) {
    if action.flags.last().copied().unwrap_or(false) {
        env.brick.tell(Command::Redraw);
    }
}

/// Commands without expressions.
fn plain(action: &Action, env: &mut Env<'_>) {
    let text = action.texts.first().map_or("", |text| &**text);
    let number = |at: usize| action.numbers.get(at).copied().unwrap_or(0);
    let flag = action.flags.first().copied().unwrap_or(false);
    env.brick.tell(match action.act {
        Act::Sound => Command::Sound { file: text },
        Act::Tone => Command::Tone {
            hertz: number(0),
            ms: number(1),
        },
        Act::Led => Command::Led { color: text },
        Act::RemoveFile => Command::Remove { file: text },
        Act::StartCamera => Command::StartCamera {
            mode: text,
            show: flag,
        },
        Act::StopCamera => Command::StopCamera { mode: text },
        Act::StartVideo => Command::StartVideo {
            gray: flag,
            quality: text.parse().unwrap_or(0),
        },
        Act::StopVideo => Command::StopVideo,
        Act::Detect => Command::Detect { mode: text },
        Act::CalibrateGyroscope => Command::CalibrateGyroscope,
        Act::Clear => Command::ClearScreen,
        Act::PenColor => Command::PenColor { color: text },
        Act::Background => Command::Background { color: text },
        Act::Smile => Command::Smile { sad: false },
        Act::SadSmile => Command::Smile { sad: true },
        Act::MarkerDown => Command::MarkerDown { color: text },
        _ => Command::MarkerUp,
    });
    if matches!(action.act, Act::Clear | Act::Background) {
        redraw(action, env);
    }
}
