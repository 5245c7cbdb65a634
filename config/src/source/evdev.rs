//! `evdev{ path, axes | codes | events }`: input events decoded and grouped up to SYN_REPORT.
//!
//! Owns which codes make a tuple. Knows nothing of the kernel's structure but its sizes.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::Rest;
use crate::evdev_codes::event_code;
use crate::fields::Fields;
use crate::limits::EVDEV_CODES_MAX;
use crate::problem::Problem;
use crate::value::{Table, Value};
use std::path::{Path, PathBuf};

/// How kernel input events are laid out in the bytes of an evdev node.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EvdevLayout {
    /// As this kernel's `struct input_event` is for this process.
    Native,
    /// 16 bytes: 32-bit time fields.
    Bits32,
    /// 24 bytes: 64-bit time fields.
    Bits64,
}

/// `evdev{ path = ..., axes = { 'ABS_X', ... } | codes... | events = true }`
///
/// Each tuple holds, for every listed code in order, its newest value as a little-endian i32; one tuple per SYN_REPORT.
#[derive(Clone, Debug, PartialEq)]
pub struct EvdevDescription {
    /// Device node, usually `/dev/input/eventN`; a FIFO or file of recorded events works as well.
    pub path: PathBuf,
    /// Watched (type, code) pairs, in the order of the tuple. Empty: each event of the device is a tuple of its own,
    /// [`EvdevDescription::EVENT_BYTES`] long.
    pub codes: Vec<(u16, u16)>,
    /// Size of one event.
    pub layout: EvdevLayout,
}

impl EvdevDescription {
    /// Type and code (u16), value (i32), microseconds of the kernel's clock (i64); little-endian.
    pub const EVENT_BYTES: usize = 16;

    /// Bytes of one tuple.
    pub fn tuple_size(&self) -> usize {
        match self.codes.len() {
            0 => Self::EVENT_BYTES,
            codes => 4 * codes,
        }
    }
}

impl Kind for EvdevDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "evdev",
        keys: &["path", "axes", "codes", "events", "layout"],
        read,
    }];
    const REST: Rest<Self> = Rest::ReadOnly;

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.path);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.path]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::Stream
    }

    fn known_tuple_size(
        &self,
        _fields: &Fields<'_>,
        _nodes: &mut dyn Nodes,
    ) -> Result<Option<usize>, Problem> {
        Ok(Some(self.tuple_size()))
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<EvdevDescription, Problem> {
    let path = fields.own_path("evdev")?;
    let codes = watched(fields)?;
    let layout = match fields.text("layout", 16)? {
        None | Some("native") => EvdevLayout::Native,
        Some("bits32") => EvdevLayout::Bits32,
        Some("bits64") => EvdevLayout::Bits64,
        Some(other) => {
            let reason =
                format!("evdev: layout must be 'native', 'bits32' or 'bits64', not '{other}'");
            return Err(fields.problem("src", reason));
        }
    };
    Ok(EvdevDescription {
        path,
        codes,
        layout,
    })
}

/// Which codes of an input device make a tuple; none with `events = true`.
fn watched(fields: &Fields<'_>) -> Result<Vec<(u16, u16)>, Problem> {
    let refuse = |reason| Err(fields.problem("src", reason));
    let (field, value) = match (fields.get("axes"), fields.get("codes")) {
        (Some(_), Some(_)) => return refuse("evdev: axes and codes are the same, give one"),
        (Some(value), None) => ("axes", value),
        (None, Some(value)) => ("codes", value),
        (None, None) if fields.boolean("events")? == Some(true) => return Ok(Vec::new()),
        (None, None) => {
            return refuse(
                "evdev: axes is missing, for example axes = { 'ABS_X' }; events = true gives every event",
            );
        }
    };
    if fields.boolean("events")? == Some(true) {
        return refuse("evdev: with events = true every event is a tuple, axes make no sense");
    }
    let Some(list) = fields.table_of(value) else {
        return Err(fields.wrong_type(field, "a list of event names", value));
    };
    codes(fields, field, list)
}

fn codes(fields: &Fields<'_>, field: &str, list: &Table) -> Result<Vec<(u16, u16)>, Problem> {
    let values = list.list();
    if values.is_empty() || values.len() != list.entries.len() {
        return Err(fields.problem(
            "src",
            format!("evdev: {field} must be a list of event names"),
        ));
    }
    if values.len() > EVDEV_CODES_MAX {
        return Err(fields.problem(
            "src",
            format!("evdev: {field} has more than {EVDEV_CODES_MAX} events"),
        ));
    }
    let mut codes = Vec::new();
    for value in values {
        let code = match value {
            Value::Text(name) => {
                let found = event_code(&String::from_utf8_lossy(name));
                found.map_err(|reason| fields.problem("src", format!("evdev: {reason}")))?
            }
            Value::Boolean(_)
            | Value::Number(_)
            | Value::Function(_)
            | Value::Table(_)
            | Value::Other(_) => match fields.table_of(value).map(Table::list).as_deref() {
                Some([kind, code]) => {
                    let kind = fields.whole_value(field, kind, 0, 0x1f)?;
                    let code = fields.whole_value(field, code, 0, 0x2ff)?;
                    (kind as u16, code as u16)
                }
                _ => {
                    return Err(fields.wrong_type(
                        field,
                        "a list of event names or {type, code} pairs",
                        value,
                    ));
                }
            },
        };
        if codes.contains(&code) {
            return Err(fields.problem(
                "src",
                format!("evdev: {field} names the event {},{} twice", code.0, code.1),
            ));
        }
        codes.push(code);
    }
    Ok(codes)
}
