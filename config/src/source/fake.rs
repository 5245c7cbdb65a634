//! `fake{ data, period_ms, loop }`: bytes that the configuration itself holds.
//!
//! Owns its keys. The bytes are whole tuples.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::Rest;
use crate::fields::Fields;
use crate::limits::PERIOD_MS_MAX;
use crate::problem::Problem;
use crate::value::Value;
use std::path::{Path, PathBuf};

/// `fake{ data = '...', period_ms = 10, loop = true }`
#[derive(Clone, Debug, PartialEq)]
pub struct FakeDescription {
    /// Bytes to emit, a tuple at a time.
    pub data: Vec<u8>,
    /// Milliseconds between tuples; 0 makes the bytes state: one tuple per read, in turn.
    pub period_ms: u32,
    /// Start again at the end; otherwise end of file (a stream) or the last tuple for ever (state).
    pub repeat: bool,
}

impl Kind for FakeDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "fake",
        keys: &["data", "period_ms", "loop"],
        read,
    }];
    const REST: Rest<Self> = Rest::ReadOnly;

    fn each_path(&mut self, _take: &mut dyn FnMut(&mut PathBuf)) {}

    fn needed_paths(&self) -> Vec<&Path> {
        Vec::new()
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        if self.period_ms > 0 {
            Delivery::Stream
        } else {
            Delivery::State
        }
    }

    fn check_tuple_size(&self, size: usize, fields: &Fields<'_>) -> Result<(), Problem> {
        if self.data.len().is_multiple_of(size) {
            return Ok(());
        }
        let bytes = self.data.len();
        let reason = format!("fake: data has {bytes} bytes, not whole tuples of {size}");
        Err(fields.problem("src", reason))
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<FakeDescription, Problem> {
    let data = match fields.get("data") {
        Some(Value::Text(data)) if !data.is_empty() => data.clone(),
        Some(Value::Text(_)) => return Err(fields.problem("src", "fake: data is empty")),
        Some(value) => return Err(fields.wrong_type("data", "a string", value)),
        None => return Err(fields.problem("src", "fake: data is missing")),
    };
    Ok(FakeDescription {
        data,
        period_ms: fields.whole("period_ms", 0, PERIOD_MS_MAX)?.unwrap_or(0),
        repeat: fields.boolean("loop")?.unwrap_or(false),
    })
}
