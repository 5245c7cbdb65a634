//! The `src` of a description: paths, constructors, other nodes. Several sources stand in `several`.
//!
//! Owns which sources can be written, and which know the size of their tuples.

use super::bus::i2c_size;
use super::fields::Fields;
use crate::description::{
    EvdevDescription, EvdevLayout, FakeDescription, FaultyDescription, GpioDirection,
    ReplayDescription, SourceDescription,
};
use crate::evdev_codes::event_code;
use crate::limits::{PERIOD_MS_MAX, TUPLE_BYTES_MAX};
use crate::problem::Problem;
use crate::search::path_of;
use crate::value::{Table, Value};

/// Codes of one evdev tuple.
const CODES_MAX: usize = 256;

/// Errors that a `faulty` source can be told to give; end of file as well.
const ERRORS: [(&str, i32); 17] = [
    ("EACCES", libc::EACCES),
    ("EAGAIN", libc::EAGAIN),
    ("EBUSY", libc::EBUSY),
    ("EINTR", libc::EINTR),
    ("EINVAL", libc::EINVAL),
    ("EIO", libc::EIO),
    ("ENODATA", libc::ENODATA),
    ("ENODEV", libc::ENODEV),
    ("ENOENT", libc::ENOENT),
    ("ENOMEM", libc::ENOMEM),
    ("ENXIO", libc::ENXIO),
    ("EOF", 0),
    ("EPERM", libc::EPERM),
    ("EPIPE", libc::EPIPE),
    ("EREMOTEIO", libc::EREMOTEIO),
    ("ESHUTDOWN", libc::ESHUTDOWN),
    ("ETIMEDOUT", libc::ETIMEDOUT),
];

/// True if nothing can be written to the source.
pub(super) fn is_read_only(source: &SourceDescription) -> bool {
    match source {
        SourceDescription::Path(_)
        | SourceDescription::Attribute(_)
        | SourceDescription::Fifo(_)
        // A port that is absent on this board is described like one that is there.
        | SourceDescription::Absent(_)
        | SourceDescription::Program(_)
        | SourceDescription::Regulator(_)
        | SourceDescription::I2c(_)
        | SourceDescription::I2cBus(_) => false,
        SourceDescription::Pwm(_) => false,
        SourceDescription::Gpio(gpio) => gpio.direction == GpioDirection::In,
        SourceDescription::Lines(lines) => lines.input.is_none(),
        SourceDescription::Evdev(_)
        | SourceDescription::Iio(_)
        | SourceDescription::Packets(_)
        | SourceDescription::Fake(_)
        | SourceDescription::Replay(_)
        | SourceDescription::Node(_)
        | SourceDescription::Newest(_)
        | SourceDescription::Several(_) => true,
        SourceDescription::Faulty(faulty) => is_read_only(&faulty.source),
    }
}

impl<'a> Fields<'_, 'a> {
    /// Reads `src` and `input_tuple_size`, which belong together: several sources have a size each.
    pub(super) fn source(&mut self) -> Result<(SourceDescription, Option<usize>), Problem> {
        let Some(value) = self.get("src") else {
            return Err(self.problem("src", "'src' is missing"));
        };
        if let Some(table) = self.table_of(value)
            && table.get("").is_none()
        {
            let several = self.several(table)?;
            let size = several.tuple_size();
            if size > TUPLE_BYTES_MAX {
                let reason = format!(
                    "the tuples of all sources have {size} bytes, more than {TUPLE_BYTES_MAX}"
                );
                return Err(self.problem("src", reason));
            }
            return Ok((SourceDescription::Several(several), Some(size)));
        }
        if let Some(field) = ["ages", "interval", "trigger"]
            .into_iter()
            .find(|field| self.get(field).is_some())
        {
            let reason = format!("{field} is for several sources: src = {{ a = ..., b = ... }}");
            return Err(self.problem(field, reason));
        }
        let source = self.single(value)?;
        let known = self.size_of(&source)?;
        let given = match self.get("input_tuple_size") {
            None => None,
            Some(value) => Some(self.tuple_size("input_tuple_size", value)?),
        };
        if let (Some(known), Some(given)) = (known, given)
            && known != given
        {
            let reason = format!(
                "input_tuple_size is {given}, but the source gives tuples of {known} bytes"
            );
            return Err(self.problem("input_tuple_size", reason));
        }
        let size = given.or(known);
        if let Some(size) = size {
            self.check_data(&source, size)?;
        }
        Ok((source, size))
    }

    /// A size in bytes.
    pub(super) fn tuple_size(&self, field: &str, value: &Value) -> Result<usize, Problem> {
        let max = u32::try_from(TUPLE_BYTES_MAX).unwrap_or(u32::MAX);
        let size = self.whole_value(field, value, 1, max)?;
        Ok(usize::try_from(size).unwrap_or(TUPLE_BYTES_MAX))
    }

    /// The bytes of a fake source are whole tuples.
    pub(super) fn check_data(
        &self,
        source: &SourceDescription,
        size: usize,
    ) -> Result<(), Problem> {
        match source {
            SourceDescription::Fake(fake) if !fake.data.len().is_multiple_of(size) => {
                let reason = format!(
                    "fake: data has {} bytes, not whole tuples of {size}",
                    fake.data.len()
                );
                Err(self.problem("src", reason))
            }
            SourceDescription::Packets(packets) => self.check_packets(packets, size),
            SourceDescription::Faulty(faulty) => self.check_data(&faulty.source, size),
            SourceDescription::I2c(i2c) => self.check_i2c_size(i2c, size),
            _ => Ok(()),
        }
    }

    /// Bytes of one tuple, if the source knows.
    pub(super) fn size_of(&mut self, source: &SourceDescription) -> Result<Option<usize>, Problem> {
        match source {
            SourceDescription::Evdev(evdev) => Ok(Some(evdev.tuple_size())),
            SourceDescription::Iio(iio) => Ok(Some(iio.tuple_size())),
            SourceDescription::Pwm(_) => Ok(Some(4)),
            SourceDescription::Gpio(_) | SourceDescription::I2cBus(_) => Ok(Some(1)),
            SourceDescription::Faulty(faulty) => self.size_of(&faulty.source),
            SourceDescription::I2c(i2c) => Ok(i2c_size(i2c.transfer)),
            SourceDescription::Regulator(regulator) => Ok(Some(regulator.feedback.tuple_size())),
            SourceDescription::Node(other) | SourceDescription::Newest(other) => {
                match self.checker.size_of_node(other, self.depth)? {
                    Some(size) => Ok(Some(size)),
                    None => {
                        let hint = self.checker.nearest_node(other);
                        Err(self.problem("src", format!("there is no node '{other}'{hint}")))
                    }
                }
            }
            _ => Ok(None),
        }
    }

    /// One source: a path, another node, or what a constructor made.
    pub(super) fn single(&mut self, value: &'a Value) -> Result<SourceDescription, Problem> {
        if let Value::Text(text) = value {
            if let Some(other) = text.strip_prefix(b"trikfs:") {
                let other = String::from_utf8_lossy(other).into_owned();
                return Ok(SourceDescription::Node(other));
            }
            if let Some(other) = text.strip_prefix(b"newest:") {
                let other = String::from_utf8_lossy(other).into_owned();
                return Ok(SourceDescription::Newest(other));
            }
            return Ok(SourceDescription::Path(path_of(
                self.absolute("src", value)?,
            )));
        }
        let Some(table) = self.table_of(value) else {
            return Err(self.wrong_type("src", "a path, a source or a table of these", value));
        };
        let Some(Value::Text(kind)) = table.get("") else {
            return Err(self.problem(
                "src",
                "src is nested; sources of several stand side by side",
            ));
        };
        match kind.as_slice() {
            b"attribute" => self
                .device("attribute", table)
                .map(SourceDescription::Attribute),
            b"fifo" => self.device("fifo", table).map(SourceDescription::Fifo),
            b"evdev" => self.evdev(table),
            b"iio" => self.iio(table),
            b"pwm" => self.pwm(table),
            b"gpio" => self.gpio(table),
            b"lines" => self.lines(table),
            b"packets" => self.packets(table),
            b"pictures" => self.pictures(table),
            b"fake" => self.fake(table),
            b"replay" => self.replay(table),
            b"faulty" => self.faulty(table),
            b"program" => self.program(table),
            b"regulator" => self.regulator(table),
            b"i2c" => self.i2c(table),
            b"i2c_bus" => self.i2c_bus(table),
            b"absent" => self.absent(table),
            _ => Err(self.problem("src", "src is of an unknown kind")),
        }
    }

    /// A path of the system, which never depends on the working directory.
    pub(super) fn absolute(&self, field: &str, value: &'a Value) -> Result<&'a [u8], Problem> {
        let path = self.path_bytes(field, value)?;
        if path.first() == Some(&b'/') {
            return Ok(path);
        }
        let shown = String::from_utf8_lossy(path);
        Err(self.problem("src", format!("the path '{shown}' must begin with a slash")))
    }

    /// `KIND{ path }`
    fn device(&self, kind: &str, table: &'a Table) -> Result<std::path::PathBuf, Problem> {
        self.at("src", self.only(kind, table, &["", "path"]))?;
        match table.get("path") {
            Some(value) => self.at("src", self.absolute("path", value).map(path_of)),
            None => Err(self.problem("src", format!("{kind}: path is missing"))),
        }
    }

    /// A field of a constructor, read with the checks of a description's field.
    pub(super) fn inner<T>(
        &mut self,
        table: &'a Table,
        read: impl FnOnce(&mut Self) -> Result<T, Problem>,
    ) -> Result<T, Problem> {
        let outer = std::mem::replace(&mut self.table, table);
        let result = read(self);
        self.table = outer;
        self.at("src", result)
    }

    /// `evdev{ path = ..., axes = { 'ABS_X', { 3, 1 } }, layout = 'native' }`; `codes` is another word for `axes`.
    fn evdev(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            let keys = ["", "path", "axes", "codes", "events", "layout"];
            fields.only("evdev", table, &keys)?;
            let Some(path) = fields.get("path") else {
                return Err(fields.problem("src", "evdev: path is missing"));
            };
            let path = path_of(fields.absolute("path", path)?);
            let codes = fields.watched()?;
            let layout = match fields.text("layout", 16)? {
                None | Some("native") => EvdevLayout::Native,
                Some("bits32") => EvdevLayout::Bits32,
                Some("bits64") => EvdevLayout::Bits64,
                Some(other) => {
                    let reason = format!(
                        "evdev: layout must be 'native', 'bits32' or 'bits64', not '{other}'"
                    );
                    return Err(fields.problem("src", reason));
                }
            };
            Ok(SourceDescription::Evdev(EvdevDescription {
                path,
                codes,
                layout,
            }))
        })
    }

    /// Which codes of an input device make a tuple; none with `events = true`.
    fn watched(&mut self) -> Result<Vec<(u16, u16)>, Problem> {
        let refuse = |reason| Err(self.problem("src", reason));
        let (field, value) = match (self.get("axes"), self.get("codes")) {
            (Some(_), Some(_)) => return refuse("evdev: axes and codes are the same, give one"),
            (Some(value), None) => ("axes", value),
            (None, Some(value)) => ("codes", value),
            (None, None) if self.boolean("events")? == Some(true) => return Ok(Vec::new()),
            (None, None) => {
                return refuse(
                    "evdev: axes is missing, for example axes = { 'ABS_X' }; events = true gives every event",
                );
            }
        };
        if self.boolean("events")? == Some(true) {
            return refuse("evdev: with events = true every event is a tuple, axes make no sense");
        }
        let Some(list) = self.table_of(value) else {
            return Err(self.wrong_type(field, "a list of event names", value));
        };
        self.codes(field, list)
    }

    fn codes(&self, field: &str, list: &'a Table) -> Result<Vec<(u16, u16)>, Problem> {
        let values = list.list();
        if values.is_empty() || values.len() != list.entries.len() {
            return Err(self.problem(
                "src",
                format!("evdev: {field} must be a list of event names"),
            ));
        }
        if values.len() > CODES_MAX {
            return Err(self.problem(
                "src",
                format!("evdev: {field} has more than {CODES_MAX} events"),
            ));
        }
        let mut codes = Vec::new();
        for value in values {
            let code = match value {
                Value::Text(name) => {
                    let found = event_code(&String::from_utf8_lossy(name));
                    found.map_err(|reason| self.problem("src", format!("evdev: {reason}")))?
                }
                _ => match self.table_of(value).map(Table::list).as_deref() {
                    Some([kind, code]) => {
                        let kind = self.whole_value(field, kind, 0, 0x1f)?;
                        let code = self.whole_value(field, code, 0, 0x2ff)?;
                        (kind as u16, code as u16)
                    }
                    _ => {
                        return Err(self.wrong_type(
                            field,
                            "a list of event names or {type, code} pairs",
                            value,
                        ));
                    }
                },
            };
            if codes.contains(&code) {
                return Err(self.problem(
                    "src",
                    format!("evdev: {field} names the event {},{} twice", code.0, code.1),
                ));
            }
            codes.push(code);
        }
        Ok(codes)
    }

    fn fake(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("fake", table, &["", "data", "period_ms", "loop"])?;
            let data = match fields.get("data") {
                Some(Value::Text(data)) if !data.is_empty() => data.clone(),
                Some(Value::Text(_)) => return Err(fields.problem("src", "fake: data is empty")),
                Some(value) => return Err(fields.wrong_type("data", "a string", value)),
                None => return Err(fields.problem("src", "fake: data is missing")),
            };
            Ok(SourceDescription::Fake(FakeDescription {
                data,
                period_ms: fields.whole("period_ms", 0, PERIOD_MS_MAX)?.unwrap_or(0),
                repeat: fields.boolean("loop")?.unwrap_or(false),
            }))
        })
    }

    fn replay(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only("replay", table, &["", "path", "speed", "loop"])?;
            let Some(value) = fields.get("path") else {
                return Err(fields.problem("src", "replay: path is missing"));
            };
            let name = fields.path_bytes("path", value)?;
            let path = fields.checker.search.recording(name);
            let path = path.map_err(|reason| fields.problem("src", format!("replay: {reason}")))?;
            let speed = match fields.get("speed") {
                None => 1.0,
                Some(value) => fields.finite_value("speed", value)?,
            };
            if !(1e-3..=1e6).contains(&speed) {
                return Err(fields.problem(
                    "src",
                    format!("replay: speed must be from 0.001 to 1000000, not {speed}"),
                ));
            }
            let repeat = fields.boolean("loop")?.unwrap_or(false);
            Ok(SourceDescription::Replay(ReplayDescription {
                path,
                speed,
                repeat,
            }))
        })
    }

    fn faulty(&mut self, table: &'a Table) -> Result<SourceDescription, Problem> {
        self.inner(table, |fields| {
            fields.only(
                "faulty",
                table,
                &["", "src", "fail", "from", "count", "short"],
            )?;
            let Some(value) = fields.get("src") else {
                return Err(fields.problem("src", "faulty: src is missing"));
            };
            if fields.table_of(value).and_then(|inner| inner.get(""))
                == Some(&Value::Text(b"faulty".to_vec()))
            {
                return Err(fields.problem("src", "faulty: src is faulty already"));
            }
            let source = Box::new(fields.single(value)?);
            let errno = match fields.get("fail") {
                None => None,
                Some(Value::Number(_)) => fields
                    .whole("fail", 0, 4095)?
                    .and_then(|number| i32::try_from(number).ok()),
                Some(_) => {
                    let name = fields.text("fail", 32)?.unwrap_or_default();
                    let known = ERRORS.iter().find(|(known, _)| *known == name);
                    let Some((_, number)) = known else {
                        let hint = crate::nearest::suggestion(
                            name,
                            ERRORS.iter().map(|(known, _)| *known),
                        );
                        return Err(
                            fields.problem("src", format!("faulty: unknown error '{name}'{hint}"))
                        );
                    };
                    Some(*number)
                }
            };
            let short = fields.whole("short", 0, u32::MAX)?.unwrap_or(0);
            if errno.is_none() && short == 0 {
                return Err(fields.problem(
                    "src",
                    "faulty: give fail, for example fail = 'EIO', or short",
                ));
            }
            // Without an error only the short reads are wanted: the first failing read never comes.
            let from = if errno.is_some() {
                fields.whole("from", 1, u32::MAX)?.unwrap_or(1)
            } else {
                u32::MAX
            };
            Ok(SourceDescription::Faulty(FaultyDescription {
                source,
                errno: errno.unwrap_or(libc::EIO),
                from,
                count: fields.whole("count", 0, u32::MAX)?.unwrap_or(1),
                short: usize::try_from(short).unwrap_or(usize::MAX),
            }))
        })
    }
}
