//! `iio{ name, channels, sampling_frequency }`: a sampled sensor of Linux IIO.
//!
//! Owns the layout of its tuple and which names can be looked for. Does not look whether a sensor is there.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::Rest;
use crate::fields::Fields;
use crate::limits::{IIO_CHANNELS_MAX, IIO_FREQUENCY_MAX, IIO_NAME_BYTES_MAX, IIO_NAMES_MAX};
use crate::problem::Problem;
use crate::value::Value;
use std::path::{Path, PathBuf};

/// Where Linux shows the devices of IIO, and their nodes.
const IIO_DEVICES: &str = "/sys/bus/iio/devices";
const NODES: &str = "/dev";

/// `iio{ name = ..., channels = {...} }`: a device of Linux IIO that is sampled into a buffer.
///
/// A tuple holds each channel in the order listed as a little-endian i32, a timestamp as i64. With several names it
/// begins with an i32: the position from 1 of the name that was found.
#[derive(Clone, Debug, PartialEq)]
pub struct IioDescription {
    /// Where the devices are described, `/sys/bus/iio/devices`.
    pub devices: PathBuf,
    /// Where their nodes are, `/dev`.
    pub nodes: PathBuf,
    /// Names that the device may have; the first that is found counts.
    pub names: Vec<String>,
    /// The tuple begins with the position of the name.
    pub gives_position: bool,
    /// Names of scan elements without `in_`, for example `accel_x`.
    pub channels: Vec<String>,
    /// Samples per second to ask for.
    pub sampling_frequency: Option<f64>,
}

impl IioDescription {
    /// Bytes of one tuple.
    pub fn tuple_size(&self) -> usize {
        let channels: usize = self
            .channels
            .iter()
            .map(|channel| Self::value_size(channel))
            .sum();
        channels + if self.gives_position { 4 } else { 0 }
    }

    /// Bytes of one channel in the tuple.
    pub fn value_size(channel: &str) -> usize {
        if channel == "timestamp" { 8 } else { 4 }
    }
}

impl Kind for IioDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "iio",
        keys: &["name", "channels", "sampling_frequency"],
        read,
    }];
    const REST: Rest<Self> = Rest::ReadOnly;

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.devices);
        take(&mut self.nodes);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.devices]
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
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<IioDescription, Problem> {
    let Some(name) = fields.get("name") else {
        return Err(fields.problem("src", "iio: name is missing"));
    };
    let gives_position = fields.table_of(name).is_some();
    let names = match name {
        Value::Text(_) => vec![name_of(fields, "name", name)?],
        Value::Boolean(_)
        | Value::Number(_)
        | Value::Function(_)
        | Value::Table(_)
        | Value::Other(_) => names_of(fields, "name", name, IIO_NAMES_MAX)?,
    };
    let Some(channels) = fields.get("channels") else {
        return Err(fields.problem(
            "src",
            "iio: channels is missing, for example channels = { 'accel_x', 'timestamp' }",
        ));
    };
    let channels = names_of(fields, "channels", channels, IIO_CHANNELS_MAX)?;
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
    Ok(IioDescription {
        devices: IIO_DEVICES.into(),
        nodes: NODES.into(),
        names,
        gives_position,
        channels,
        sampling_frequency,
    })
}

/// A list of different names.
fn names_of(
    fields: &Fields<'_>,
    field: &str,
    value: &Value,
    max: usize,
) -> Result<Vec<String>, Problem> {
    let list = fields
        .table_of(value)
        .ok_or_else(|| fields.wrong_type(field, "a list of names", value))?;
    let values = list.list();
    if values.is_empty() || values.len() != list.entries.len() {
        return Err(fields.problem("src", format!("iio: {field} must be a list of names")));
    }
    if values.len() > max {
        return Err(fields.problem("src", format!("iio: {field} has more than {max} names")));
    }
    let mut names: Vec<String> = Vec::new();
    for value in values {
        let name = name_of(fields, field, value)?;
        if names.contains(&name) {
            return Err(fields.problem("src", format!("iio: {field} has '{name}' twice")));
        }
        names.push(name);
    }
    Ok(names)
}

/// A name that is a part of the names of files.
fn name_of(fields: &Fields<'_>, field: &str, value: &Value) -> Result<String, Problem> {
    let Value::Text(bytes) = value else {
        return Err(fields.wrong_type(field, "a name", value));
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
        return Err(fields.problem("src", reason));
    }
    Ok(shown)
}
