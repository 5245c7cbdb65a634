//! What blocks do with the marker and the screen.
//!
//! Owns one reaction at a time, done at once. Numbers of ports are those of the rows.

use super::state::Memory;
use super::{Env, Halt, Machine, values, words};
use crate::blocks::Shape;
use crate::lower::color;
use crate::program::{Act, Formula, Target};
use lang_diagram::brick::{Command, Figure};
use lang_expr::Value;

/// The first data input of these blocks.
const DATA: u8 = 2;
/// Height of letters on the screen, in pixels.
const LETTERS: i32 = 20;

impl Machine {
    pub(super) fn pen(
        &mut self,
        to: Target,
        token: Option<&Value>,
        own: bool,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        // CF_IN, CF_OUT, UP_DOWN, COLOR.
        const COLOR: u8 = 3;
        let down = match (to.port, token) {
            (COLOR, Some(token)) => {
                let word = self.choice(to, token, crate::blocks::COLORS, env)?;
                self.states[to.node as usize].memory = Memory::Text(color(word));
                return Ok(());
            }
            (_, Some(token)) => self.flag(to, token, env)?,
            (_, None) => own,
        };
        let color = self.states[to.node as usize].memory.text();
        let color = color.unwrap_or_else(|| "black".into());
        let command = match down {
            true => Command::MarkerDown { color: &color },
            false => Command::MarkerUp,
        };
        self.tell(command, env);
        Ok(())
    }

    pub(super) fn paint(
        &mut self,
        to: Target,
        token: Option<&Value>,
        act: &Act,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let Act::Paint {
            color: own,
            width,
            background,
            redraw,
        } = act
        else {
            return Ok(());
        };
        // CF_IN, CF_OUT, BRUSH_COLOR, BRUSH_WIDTH, BACKGROUND_COLOR.
        match (to.port, token) {
            (DATA, Some(token)) => {
                let word = self.choice(to, token, crate::blocks::COLORS, env)?;
                self.tell(Command::PenColor { color: word }, env);
            }
            (3, Some(token)) => {
                let width = self.whole(to, token, env)?;
                if width <= 0 {
                    return Err(self.fault_at_port(to, words::bad_width(), env));
                }
                self.tell(Command::PenWidth { width }, env);
            }
            (_, Some(token)) => {
                let word = self.choice(to, token, crate::blocks::BACKGROUNDS, env)?;
                self.tell(
                    Command::Background {
                        color: &color(word),
                    },
                    env,
                );
            }
            (_, None) => {
                self.tell(Command::PenColor { color: own }, env);
                self.tell(Command::PenWidth { width: *width }, env);
                self.tell(Command::Background { color: background }, env);
            }
        }
        self.redraw(*redraw, env);
        Ok(())
    }

    fn redraw(&mut self, wanted: bool, env: &mut Env<'_>) {
        if wanted {
            self.tell(Command::Redraw, env);
        }
    }

    pub(super) fn print(
        &mut self,
        to: Target,
        token: Option<&Value>,
        act: &Act,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let Act::Print {
            text: own,
            at,
            redraw,
            computed,
        } = act
        else {
            return Ok(());
        };
        // CF_IN, CF_OUT, COORDS, TEXT.
        const TEXT: u8 = 3;
        let place = match (to.port, token) {
            (TEXT, Some(token)) => {
                let text = self.text(to, token, env)?;
                let text = match computed {
                    true => self.evaluate_token(to, &text, env)?,
                    false => text,
                };
                self.states[to.node as usize].memory = Memory::Text(text);
                return Ok(());
            }
            (_, Some(token)) => self.coordinates(to, token, env)?,
            (_, None) => self.computed(at, env)?,
        };
        let text = match self.states[to.node as usize].memory.text() {
            Some(text) => text,
            None => self.said_or(to, None, own, env)?,
        };
        let ([x, y], size) = (place, LETTERS);
        self.tell(
            Command::Label {
                x,
                y,
                size,
                text: &text,
            },
            env,
        );
        self.redraw(*redraw, env);
        self.done(to.node, env)
    }

    pub(super) fn smile(
        &mut self,
        to: Target,
        token: Option<&Value>,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        if let Some(token) = token {
            let happy = self.flag(to, token, env)?;
            self.states[to.node as usize].memory = Memory::Truth(happy);
        }
        let sad = matches!(self.states[to.node as usize].memory, Memory::Truth(false));
        self.tell(Command::Smile { sad }, env);
        self.tell(Command::Redraw, env);
        Ok(())
    }

    pub(super) fn draw(
        &mut self,
        to: Target,
        token: Option<&Value>,
        act: &Act,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let Act::Draw {
            shape,
            numbers,
            filled,
            redraw,
        } = act
        else {
            return Ok(());
        };
        let figure = match shape {
            Shape::Pixel => Figure::Pixel(self.place(to, token, numbers, env)?),
            Shape::Line => Figure::Line(self.place(to, token, numbers, env)?),
            Shape::Rectangle => Figure::Rectangle(self.place(to, token, numbers, env)?, *filled),
            Shape::Ellipse => Figure::Ellipse(self.place(to, token, numbers, env)?, *filled),
            Shape::Arc => Figure::Arc(self.place(to, token, numbers, env)?),
        };
        self.tell(Command::Draw(figure), env);
        self.redraw(*redraw, env);
        Ok(())
    }

    /// Coordinates of a token, or those of the properties.
    fn place<const N: usize>(
        &mut self,
        to: Target,
        token: Option<&Value>,
        own: &[Formula],
        env: &mut Env<'_>,
    ) -> Result<[i32; N], Halt> {
        match token {
            Some(token) => self.coordinates(to, token, env),
            None => self.computed(own, env),
        }
    }

    fn coordinates<const N: usize>(
        &self,
        to: Target,
        token: &Value,
        env: &Env<'_>,
    ) -> Result<[i32; N], Halt> {
        values::numbers(token).map_err(|words| self.fault_at_port(to, words, env))
    }

    fn computed<const N: usize>(
        &mut self,
        own: &[Formula],
        env: &mut Env<'_>,
    ) -> Result<[i32; N], Halt> {
        let mut numbers = [0; N];
        for (number, formula) in numbers.iter_mut().zip(own) {
            *number = self.evaluate(*formula, env)?.to_int();
        }
        Ok(numbers)
    }
}
