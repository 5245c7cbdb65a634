//! What blocks do with devices: motors, speech, files, camera, messages, drawing.
//!
//! Owns one reaction at a time. Motors, servos and encoders are told at the end of the instant, everything else at once.
//! Numbers of ports are those of the rows.

use super::state::Memory;
use super::values;
use super::words;
use super::{Env, Halt, Machine, Write};
use crate::limits;
use crate::lower::chosen;
use crate::program::{Act, Camera, Source, Target, Words as Said};
use lang_diagram::brick::Command;
use lang_diagram::ports::{Port, Sort};
use lang_expr::Value;
use lang_text::problem::Words;
use std::rc::Rc;

/// The control input of these blocks, but for `PlayTone`.
const CONTROL: u8 = 0;
/// The data input of these blocks.
const DATA: u8 = 2;

impl Machine {
    /// A token comes to a block of devices.
    pub(super) fn act(
        &mut self,
        to: Target,
        value: &Value,
        act: &Act,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let is_start = env.program.node(to.node).row.control() == Some(to.port);
        let token = (!is_start).then_some(value);
        match act {
            Act::WritePort { port, value } => {
                let number = match token {
                    Some(token) => self.whole(to, token, env)?,
                    None => *value,
                };
                self.write(*port, number);
            }
            Act::ReadPort(read) => {
                return match self.read_port(*read, env) {
                    Some(value) => self.send(to.node, 1, &value, env),
                    None => {
                        let words = words::no_reading(read.port().name());
                        Err(self.fault(to.node, words, env))
                    }
                };
            }
            Act::Drive { devices, .. } => match token {
                Some(token) => {
                    self.drive(to, devices[usize::from(to.port - DATA)].0, token, env)?
                }
                None => devices
                    .iter()
                    .for_each(|&(port, value)| self.write(port, value)),
            },
            Act::Led(color) => self.led(to, token, color, env)?,
            Act::Say(text) => return self.say(to, token, text, env),
            Act::Sound(file) => {
                let file = self.text_or(to, token, file, env)?;
                self.tell(Command::Sound { file: &file }, env);
            }
            Act::System { command, code } => {
                let command = self.said_or(to, token, command, env)?;
                let code = *code;
                self.tell(
                    Command::System {
                        command: &command,
                        code,
                    },
                    env,
                );
            }
            Act::Stream => {
                let (gray, quality) = (false, STREAM_QUALITY);
                self.tell(Command::StartVideo { gray, quality }, env);
            }
            Act::StartCamera(camera) => self.start_camera(to, token, *camera, env)?,
            Act::Send { message, .. } => return self.message(to, token, message, env),
            Act::WriteFile { .. } => self.write_file(to, token, env)?,
            Act::ReadFile { words, .. } => self.read_file(to, token, *words, env)?,
            Act::RemoveFile(file) => {
                let file = self.text_or(to, token, file, env)?;
                self.tell(Command::Remove { file: &file }, env);
            }
            Act::Pen { down, .. } => self.pen(to, token, *down, env)?,
            Act::Paint { .. } => self.paint(to, token, act, env)?,
            Act::Print { .. } => return self.print(to, token, act, env),
            Act::Clear => {
                self.tell(Command::ClearScreen, env);
                self.tell(Command::Redraw, env);
            }
            Act::Smile(_) => self.smile(to, token, env)?,
            Act::Draw { .. } => self.draw(to, token, act, env)?,
        }
        self.done(to.node, env)
    }

    /// What a port is told at the end of the instant; the last one who speaks counts.
    fn write(&mut self, port: Port, number: i32) {
        let write = match port.sort() {
            Sort::Encoder => Write::Reset,
            Sort::Motor | Sort::Servo | Sort::Scalar | Sort::Vector | Sort::Button(_) => {
                Write::Number(number)
            }
        };
        self.writes.insert(port, write);
    }

    /// A motor or servo gets the number of a token.
    pub(super) fn drive(
        &mut self,
        from: Target,
        port: Port,
        value: &Value,
        env: &Env<'_>,
    ) -> Result<(), Halt> {
        let number = self.whole(from, value, env)?;
        self.write(port, number);
        Ok(())
    }

    /// A token starts a block that gives readings, or changes what it gives.
    pub(super) fn start_source(
        &mut self,
        to: Target,
        value: &Value,
        source: &Source,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        match source {
            Source::Encoders(devices) => self.start_encoders(to, value, source, devices, env),
            // TYPE says that it cannot be another one: a detector is of the sensor that it was drawn with.
            Source::Detect(camera) if to.port == DATA => {
                let wanted = self.text(to, value, env)?;
                match Camera::of(&wanted) == Some(*camera) {
                    true => Ok(()),
                    false => Err(self.fault_at_port(to, words::other_camera(&wanted), env)),
                }
            }
            Source::Sensor(_) | Source::Detect(_) | Source::Gamepad | Source::Receive => {
                self.subscribe(to.node, source, env)
            }
        }
    }

    fn start_encoders(
        &mut self,
        to: Target,
        value: &Value,
        source: &Source,
        devices: &[(Port, bool); 4],
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let number = match to.port {
            CONTROL => None,
            _ => Some(self.whole(to, value, env)?),
        };
        let Memory::Offsets(mut offsets, has_failed) = self.states[to.node as usize].memory else {
            return Ok(());
        };
        for (at, (port, clears)) in devices.iter().enumerate() {
            let offset = match number {
                None => clears.then_some(0),
                Some(number) => (usize::from(to.port - DATA) == at).then_some(number),
            };
            if let Some(offset) = offset {
                if self.readings.of(*port, env.brick).is_none() {
                    return Err(self.fault(to.node, words::no_reading(port.name()), env));
                }
                offsets[at] = Some(offset);
                self.write(*port, 0);
            }
        }
        self.states[to.node as usize].memory = Memory::Offsets(offsets, has_failed);
        if offsets.iter().any(Option::is_some) {
            self.subscribe(to.node, source, env)?;
        }
        self.done(to.node, env)
    }

    fn led(
        &mut self,
        to: Target,
        token: Option<&Value>,
        own: &str,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let color = match token {
            None => own,
            Some(token) => self.choice(to, token, crate::blocks::LED_COLORS, env)?,
        };
        self.tell(Command::Led { color }, env);
        Ok(())
    }

    /// One of the words that a token may say.
    pub(super) fn choice(
        &self,
        to: Target,
        token: &Value,
        choices: &'static [&'static str],
        env: &Env<'_>,
    ) -> Result<&'static str, Halt> {
        let text = self.text(to, token, env)?;
        chosen(choices, &text)
            .ok_or_else(|| self.fault_at_port(to, words::no_choice(&text, choices), env))
    }

    fn say(
        &mut self,
        to: Target,
        token: Option<&Value>,
        own: &Said,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let text = self.said_or(to, token, own, env)?;
        self.done(to.node, env)?;
        self.tell(Command::Say { text: Some(&text) }, env);
        Ok(())
    }

    fn start_camera(
        &mut self,
        to: Target,
        token: Option<&Value>,
        own: Camera,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let camera = match token {
            None => own,
            Some(token) => {
                let text = self.text(to, token, env)?;
                let words = || words::other_camera(&text);
                Camera::of(&text).ok_or_else(|| self.fault_at_port(to, words(), env))?
            }
        };
        let mode = camera.word();
        self.tell(Command::StartCamera { mode, show: true }, env);
        Ok(())
    }

    fn message(
        &mut self,
        to: Target,
        token: Option<&Value>,
        own: &str,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        // CF_IN, CF_OUT, MSG, NUMBER.
        const NUMBER: u8 = 3;
        if to.port == NUMBER {
            if let Some(token) = token {
                let number = self.whole(to, token, env)?;
                self.states[to.node as usize].memory = Memory::Number(number);
            }
            return Ok(());
        }
        let message = self.text_or(to, token, own, env)?;
        let hull = self.states[to.node as usize].memory.number();
        self.tell(
            Command::Send {
                message: &message,
                hull,
            },
            env,
        );
        self.done(to.node, env)
    }

    fn write_file(
        &mut self,
        to: Target,
        token: Option<&Value>,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        // CF_IN, CF_OUT, FILE, TEXT.
        let token = match token {
            Some(token) => Some(self.text(to, token, env)?),
            None => None,
        };
        let memory = &mut self.states[to.node as usize].memory;
        let Memory::File(file, text) = memory else {
            return Ok(());
        };
        match (to.port, token) {
            // The block is done, and has written nothing.
            (DATA, Some(token)) => {
                *file = token;
                return Ok(());
            }
            (_, Some(token)) => *text = token,
            (_, None) => {}
        }
        let (file, text) = (file.clone(), text.clone());
        self.tell(
            Command::Append {
                file: &file,
                text: &text,
            },
            env,
        );
        Ok(())
    }

    fn read_file(
        &mut self,
        to: Target,
        token: Option<&Value>,
        by_words: bool,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        const OUT: u8 = 3;
        if let Some(token) = token {
            let file = self.text(to, token, env)?;
            self.states[to.node as usize].memory = Memory::Text(file);
        }
        let file = self.states[to.node as usize]
            .memory
            .text()
            .unwrap_or_default();
        let Some(contents) = env.brick.contents(&file) else {
            return Err(self.fault(to.node, words::no_file(&file), env));
        };
        let mut pieces: Vec<&str> = match by_words {
            true => contents.split_whitespace().collect(),
            false => contents
                .split('\n')
                .map(|line| line.trim_end_matches('\r'))
                .collect(),
        };
        if !by_words && pieces.last().is_some_and(|last| last.is_empty()) {
            pieces.pop();
        }
        if pieces.len() > limits::PIECES_MAX {
            let words = words::file_too_long(&file, limits::PIECES_MAX);
            return Err(self.fault(to.node, words, env));
        }
        for piece in pieces {
            if piece.len() > limits::TEXT_BYTES_MAX {
                return Err(self.fault(to.node, words::too_large_token(), env));
            }
            self.send(to.node, OUT, &Value::text(piece), env)?;
        }
        Ok(())
    }

    pub(super) fn text(&self, to: Target, token: &Value, env: &Env<'_>) -> Result<Rc<str>, Halt> {
        self.at_port(to, values::text(token), env)
    }

    pub(super) fn flag(&self, to: Target, token: &Value, env: &Env<'_>) -> Result<bool, Halt> {
        self.at_port(to, values::truth(token), env)
    }

    pub(super) fn at_port<T>(
        &self,
        to: Target,
        value: Result<T, Words>,
        env: &Env<'_>,
    ) -> Result<T, Halt> {
        value.map_err(|words| self.fault_at_port(to, words, env))
    }

    /// The text of a token, or the block's own.
    fn text_or(
        &self,
        to: Target,
        token: Option<&Value>,
        own: &str,
        env: &Env<'_>,
    ) -> Result<Rc<str>, Halt> {
        match token {
            Some(token) => self.text(to, token, env),
            None => Ok(own.into()),
        }
    }

    /// The text of a token, or the block's own, computed if the block says so.
    pub(super) fn said_or(
        &mut self,
        to: Target,
        token: Option<&Value>,
        own: &Said,
        env: &mut Env<'_>,
    ) -> Result<Rc<str>, Halt> {
        match (token, own) {
            (Some(token), Said::Plain(_)) => self.text(to, token, env),
            (Some(token), Said::Computed(_)) => {
                let text = self.text(to, token, env)?;
                self.evaluate_token(to, &text, env)
            }
            (None, Said::Plain(text)) => Ok(text.clone()),
            (None, Said::Computed(formula)) => {
                let value = self.evaluate(*formula, env)?;
                self.text(to, &value, env)
            }
        }
    }
}

/// Quality of the video, in percent.
const STREAM_QUALITY: i32 = 50;
