//! The constructors of ports that need more than one path: `iio`, `pwm`, `gpio`, `lines`, `pictures`, `packets`.
//!
//! Owns their keys, limits and defaults. Opens nothing, and does not look whether a port is there.

use super::fields::Fields;
use crate::description::{
    AnswerDescription, ByteOrder, Checksum, CommandDescription, GpioDescription, GpioDirection,
    IioDescription, LengthField, LinesDescription, PacketsDescription, PwmDescription,
    SourceDescription,
};
use crate::limits::{
    ANSWER_BYTES_MAX, BAUD_RATES, COMMAND_WORD_BYTES_MAX, COMMAND_WORDS_MAX, GPIO_NUMBER_MAX,
    IIO_CHANNELS_MAX, IIO_FREQUENCY_MAX, IIO_NAME_BYTES_MAX, IIO_NAMES_MAX, PACKET_START_BYTES_MAX,
    PWM_CHANNEL_MAX, TUPLE_BYTES_MAX,
};
use crate::nearest::suggestion;
use crate::problem::Problem;
use crate::search::path_of;
use crate::value::{Table, Value};
use std::path::PathBuf;

/// Where Linux shows the devices of IIO, their nodes, and the lines of GPIO.
const IIO_DEVICES: &[u8] = b"/sys/bus/iio/devices";
const NODES: &[u8] = b"/dev";
const GPIO_LINES: &[u8] = b"/sys/class/gpio";

impl<'a> Fields<'_, 'a> {
    /// `iio{ name = 'mma8451', channels = { 'accel_x' }, sampling_frequency = 100 }`
    pub(super) fn iio(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("iio", table, &["", "name", "channels", "sampling_frequency"])?;
            let Some(name) = fields.get("name") else {
                return Err(fields.problem("src", "iio: name is missing"));
            };
            let gives_position = fields.table_of(name).is_some();
            let names = match name {
                Value::Text(_) => vec![fields.iio_name("name", name)?],
                _ => fields.iio_names("name", name, IIO_NAMES_MAX)?,
            };
            let Some(channels) = fields.get("channels") else {
                return Err(fields.problem(
                    "src",
                    "iio: channels is missing, for example channels = { 'accel_x', 'timestamp' }",
                ));
            };
            let channels = fields.iio_names("channels", channels, IIO_CHANNELS_MAX)?;
            let sampling_frequency = match fields.get("sampling_frequency") {
                None => None,
                Some(value) => Some(fields.finite_value("sampling_frequency", value)?),
            };
            if let Some(hz) = sampling_frequency.filter(|hz| *hz <= 0.0 || *hz > IIO_FREQUENCY_MAX) {
                let reason = format!(
                    "iio: sampling_frequency must be above 0 and at most {IIO_FREQUENCY_MAX}, not {hz}"
                );
                return Err(fields.problem("src", reason));
            }
            Ok(SourceDescription::Iio(IioDescription {
                devices: fields.system(IIO_DEVICES),
                nodes: fields.system(NODES),
                names,
                gives_position,
                channels,
                sampling_frequency,
            }))
        })
    }

    /// A path of the system that no configuration writes, treated like those that it does write.
    fn system(&self, path: &[u8]) -> PathBuf {
        path_of(path)
    }

    /// A path of the system that a configuration writes.
    fn system_path(&self, field: &str, value: &'a Value) -> Result<PathBuf, Problem> {
        self.absolute(field, value).map(path_of)
    }

    /// The `path` of a constructor.
    fn own_path(&self, kind: &str) -> Result<PathBuf, Problem> {
        match self.get("path") {
            Some(value) => self.system_path("path", value),
            None => Err(self.problem("src", format!("{kind}: path is missing"))),
        }
    }

    /// A list of different names.
    fn iio_names(&self, field: &str, value: &'a Value, max: usize) -> Result<Vec<String>, Problem> {
        let list = self
            .table_of(value)
            .ok_or_else(|| self.wrong_type(field, "a list of names", value))?;
        let values = list.list();
        if values.is_empty() || values.len() != list.entries.len() {
            return Err(self.problem("src", format!("iio: {field} must be a list of names")));
        }
        if values.len() > max {
            return Err(self.problem("src", format!("iio: {field} has more than {max} names")));
        }
        let mut names: Vec<String> = Vec::new();
        for value in values {
            let name = self.iio_name(field, value)?;
            if names.contains(&name) {
                return Err(self.problem("src", format!("iio: {field} has '{name}' twice")));
            }
            names.push(name);
        }
        Ok(names)
    }

    /// A name that is a part of the names of files.
    fn iio_name(&self, field: &str, value: &Value) -> Result<String, Problem> {
        let Value::Text(bytes) = value else {
            return Err(self.wrong_type(field, "a name", value));
        };
        let is_plain = |byte: &u8| byte.is_ascii_alphanumeric() || b"_-.".contains(byte);
        let shown = String::from_utf8_lossy(bytes).into_owned();
        if bytes.is_empty() || bytes.len() > IIO_NAME_BYTES_MAX || !bytes.iter().all(is_plain) {
            let shown: String = shown
                .chars()
                .take(64)
                .flat_map(char::escape_debug)
                .collect();
            let reason = format!(
                "iio: {field} has '{shown}', but a name has 1 to {IIO_NAME_BYTES_MAX} letters, digits, '_', '-' and '.'"
            );
            return Err(self.problem("src", reason));
        }
        Ok(shown)
    }

    /// `pwm{ chip = '/sys/class/pwm/pwmchip2', channel = 0, period_ns = 20000000 }`
    pub(super) fn pwm(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("pwm", table, &["", "chip", "channel", "period_ns"])?;
            let Some(chip) = fields.get("chip") else {
                let reason = "pwm: chip is missing, for example chip = '/sys/class/pwm/pwmchip0'";
                return Err(fields.problem("src", reason));
            };
            let chip = fields.system_path("chip", chip)?;
            let channel = fields.whole("channel", 0, PWM_CHANNEL_MAX)?;
            // The kernel takes up to 2^63, but a tuple holds 32 bits.
            let Some(period_ns) = fields.whole("period_ns", 1, u32::MAX)? else {
                return Err(fields.problem("src", "pwm: period_ns is missing"));
            };
            Ok(SourceDescription::Pwm(PwmDescription {
                chip,
                channel: channel.unwrap_or(0),
                period_ns,
            }))
        })
    }

    /// `gpio{ number = 56, direction = 'in', active_low = false }`
    pub(super) fn gpio(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("gpio", table, &["", "number", "direction", "active_low"])?;
            let Some(number) = fields.whole("number", 0, GPIO_NUMBER_MAX)? else {
                return Err(fields.problem("src", "gpio: number is missing"));
            };
            let directions = [
                ("in", GpioDirection::In),
                ("out", GpioDirection::Out),
                ("high", GpioDirection::High),
                ("low", GpioDirection::Low),
            ];
            let direction = fields.choice("gpio", "direction", &directions)?;
            let Some(direction) = direction else {
                return Err(fields.problem(
                    "src",
                    "gpio: direction is missing: 'in', 'out', 'high' or 'low'",
                ));
            };
            Ok(SourceDescription::Gpio(GpioDescription {
                base: fields.system(GPIO_LINES),
                number,
                direction,
                active_low: fields.boolean("active_low")?.unwrap_or(false),
            }))
        })
    }

    /// One of a few words.
    fn choice<T: Copy>(
        &self,
        kind: &str,
        field: &str,
        known: &[(&str, T)],
    ) -> Result<Option<T>, Problem> {
        let Some(word) = self.text(field, 64)? else {
            return Ok(None);
        };
        let found = known.iter().find(|(name, _)| *name == word);
        found.map(|(_, value)| Some(*value)).ok_or_else(|| {
            let names: Vec<_> = known.iter().map(|(name, _)| format!("'{name}'")).collect();
            let hint = suggestion(word, known.iter().map(|(name, _)| *name));
            let names = names.join(", ");
            self.problem(
                "src",
                format!("{kind}: {field} is one of {names}, not '{word}'{hint}"),
            )
        })
    }

    /// `lines{ path = ..., input = ..., start = { '/etc/init.d/x', 'start' }, stop = {...} }`
    pub(super) fn lines(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            let known = ["", "path", "input", "start", "stop", "question", "answer"];
            fields.only("lines", table, &known)?;
            let path = fields.own_path("lines")?;
            let input = fields
                .get("input")
                .map(|value| fields.system_path("input", value))
                .transpose()?;
            let start = fields.command("lines", "start")?;
            let stop = fields.command("lines", "stop")?;
            if stop.is_some() && start.is_none() {
                return Err(fields.problem("src", "lines: stop makes no sense without start"));
            }
            let answer = fields.answer(input.is_some())?;
            Ok(SourceDescription::Lines(LinesDescription {
                path,
                input,
                start,
                stop,
                answer,
                are_pictures: false,
            }))
        })
    }

    /// `pictures{ path = ..., start = { '/etc/init.d/x', 'start' }, stop = {...} }`
    pub(super) fn pictures(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("pictures", table, &["", "path", "start", "stop"])?;
            let path = fields.own_path("pictures")?;
            let start = fields.command("pictures", "start")?;
            let stop = fields.command("pictures", "stop")?;
            if stop.is_some() && start.is_none() {
                return Err(fields.problem("src", "pictures: stop makes no sense without start"));
            }
            Ok(SourceDescription::Lines(LinesDescription {
                path,
                input: None,
                start,
                stop,
                answer: None,
                are_pictures: true,
            }))
        })
    }

    /// The line that asks, and how the line that answers begins.
    fn answer(&self, has_input: bool) -> Result<Option<AnswerDescription>, Problem> {
        let word = |field| self.text(field, ANSWER_BYTES_MAX);
        let (question, answer) = match (word("question")?, word("answer")?) {
            (None, None) => return Ok(None),
            (Some(question), Some(answer)) if !question.is_empty() && !answer.is_empty() => {
                (question.to_owned(), answer.to_owned())
            }
            _ => {
                let reason = "lines: question and answer belong together, for example question = 'detect', answer = 'hsv:'";
                return Err(self.problem("src", reason));
            }
        };
        if !has_input {
            let reason = "lines: question makes no sense without input";
            return Err(self.problem("src", reason));
        }
        Ok(Some(AnswerDescription { question, answer }))
    }

    /// `program{ run = { '/etc/trik/say' } }`
    pub(super) fn program(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("program", table, &["", "run"])?;
            match fields.command("program", "run")? {
                Some(command) => Ok(SourceDescription::Program(command)),
                None => Err(fields.problem(
                    "src",
                    "program: run is missing, for example run = { '/etc/trik/say' }",
                )),
            }
        })
    }

    /// A program and its arguments.
    fn command(&self, kind: &str, field: &str) -> Result<Option<CommandDescription>, Problem> {
        let Some(value) = self.get(field) else {
            return Ok(None);
        };
        let wanted = "a list of a program and its arguments";
        let list = self
            .table_of(value)
            .ok_or_else(|| self.wrong_type(field, wanted, value))?;
        let words = list.list();
        let Some((program, arguments)) = words.split_first() else {
            return Err(self.problem("src", format!("{kind}: {field} must be {wanted}")));
        };
        if words.len() != list.entries.len() {
            return Err(self.problem("src", format!("{kind}: {field} must be {wanted}")));
        }
        if words.len() > COMMAND_WORDS_MAX {
            let reason = format!("{kind}: {field} has more than {COMMAND_WORDS_MAX} words");
            return Err(self.problem("src", reason));
        }
        let program = self.system_path(field, program)?;
        let mut texts = Vec::new();
        for value in arguments {
            let Value::Text(bytes) = value else {
                return Err(self.wrong_type(field, wanted, value));
            };
            let text = std::str::from_utf8(bytes).ok().filter(|text| {
                text.len() <= COMMAND_WORD_BYTES_MAX && !text.chars().any(char::is_control)
            });
            let Some(text) = text else {
                let reason = format!(
                    "{kind}: an argument of {field} is not UTF-8 of at most {COMMAND_WORD_BYTES_MAX} bytes without control characters"
                );
                return Err(self.problem("src", reason));
            };
            texts.push(text.to_owned());
        }
        Ok(Some(CommandDescription {
            program,
            arguments: texts,
        }))
    }

    /// `packets{ path = ..., baud = 230400, start = '\xAA', length = { at = 1, bytes = 2, add = 2 }, order = 'big',
    /// checksum = 'sum16' }`
    pub(super) fn packets(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            let known = ["", "path", "baud", "start", "length", "order", "checksum"];
            fields.only("packets", table, &known)?;
            let path = fields.own_path("packets")?;
            let baud = fields.whole("baud", 1, u32::MAX)?;
            if let Some(baud) = baud.filter(|baud| !BAUD_RATES.contains(baud)) {
                let rates: Vec<_> = BAUD_RATES.iter().map(u32::to_string).collect();
                let reason = format!("packets: baud is one of {}, not {baud}", rates.join(", "));
                return Err(fields.problem("src", reason));
            }
            let start = match fields.get("start") {
                Some(Value::Text(bytes)) if (1..=PACKET_START_BYTES_MAX).contains(&bytes.len()) => {
                    bytes.clone()
                }
                Some(Value::Text(bytes)) => {
                    let reason = format!(
                        "packets: start has 1 to {PACKET_START_BYTES_MAX} bytes, not {}",
                        bytes.len()
                    );
                    return Err(fields.problem("src", reason));
                }
                Some(value) => return Err(fields.wrong_type("start", "a string of bytes", value)),
                None => return Err(fields.problem("src", "packets: start is missing")),
            };
            let length = fields.length_field()?;
            let orders = [("big", ByteOrder::Big), ("little", ByteOrder::Little)];
            let sums = [
                ("none", Checksum::None),
                ("sum8", Checksum::Sum8),
                ("sum16", Checksum::Sum16),
                ("xor8", Checksum::Xor8),
            ];
            let order = fields.choice("packets", "order", &orders)?;
            let Some(checksum) = fields.choice("packets", "checksum", &sums)? else {
                let reason =
                    "packets: checksum is missing: 'sum16', 'sum8', 'xor8', or 'none' if there is none";
                return Err(fields.problem("src", reason));
            };
            Ok(SourceDescription::Packets(PacketsDescription {
                path,
                baud,
                start,
                length,
                order: order.unwrap_or(ByteOrder::Big),
                checksum,
            }))
        })
    }

    /// `length = { at = 1, bytes = 2, add = 2 }` of packets.
    fn length_field(&mut self) -> Result<LengthField, Problem> {
        let Some(value) = self.get("length") else {
            let reason = "packets: length is missing, for example length = { at = 1, bytes = 2 }";
            return Err(self.problem("src", reason));
        };
        let Some(table) = self.table_of(value) else {
            return Err(self.wrong_type("length", "a table", value));
        };
        self.inner(table, |fields| {
            fields.only("packets: length", table, &["at", "bytes", "add"])?;
            let max = u32::try_from(TUPLE_BYTES_MAX).unwrap_or(u32::MAX);
            let Some(at) = fields.whole("at", 0, max)? else {
                return Err(fields.problem("src", "packets: length: at is missing"));
            };
            let bytes = fields.whole("bytes", 1, 2)?.unwrap_or(1);
            let add = match fields.get("add") {
                None => 0.0,
                Some(value) => fields.finite_value("add", value)?,
            };
            let limit = f64::from(max);
            if add.fract() != 0.0 || add.abs() > limit {
                let reason = format!(
                    "packets: length: add must be a whole number from -{max} to {max}, not {add}"
                );
                return Err(fields.problem("src", reason));
            }
            #[allow(clippy::cast_possible_truncation, reason = "whole and within limits")]
            Ok(LengthField {
                at: usize::try_from(at).unwrap_or(TUPLE_BYTES_MAX),
                bytes: usize::try_from(bytes).unwrap_or(2),
                add: add as i32,
            })
        })
    }

    /// A packet that tells its length fits into a tuple.
    pub(super) fn check_packets(
        &self,
        packets: &PacketsDescription,
        size: usize,
    ) -> Result<(), Problem> {
        let least = packets.size_min();
        if least > size {
            let reason = format!(
                "packets: start, length and checksum take {least} bytes, more than a tuple of {size}"
            );
            return Err(self.problem("src", reason));
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests;
