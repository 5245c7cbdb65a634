//! `packets{ path, baud, start, length, order, checksum }`: packets of a serial line.
//!
//! Owns what a packet looks like, and which tuples it fits into.

use super::kind::{Constructor, Delivery, Kind, Nodes};
use super::rest::Rest;
use crate::fields::Fields;
use crate::limits::{BAUD_RATES, PACKET_START_BYTES_MAX, TUPLE_BYTES_MAX};
use crate::problem::Problem;
use crate::value::Value;
use std::path::{Path, PathBuf};

/// How the bytes of a number follow each other.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ByteOrder {
    /// The highest first.
    Big,
    /// The lowest first.
    Little,
}

/// What the end of a packet is checked with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Checksum {
    /// Nothing.
    None,
    /// One byte: the sum of all bytes before it.
    Sum8,
    /// Two bytes in the packet's order: the sum of all bytes before them.
    Sum16,
    /// One byte: all bytes before it, exclusive-or.
    Xor8,
}

impl Checksum {
    /// Bytes at the end of a packet.
    pub fn size(self) -> usize {
        match self {
            Self::None => 0,
            Self::Sum8 | Self::Xor8 => 1,
            Self::Sum16 => 2,
        }
    }
}

/// Where a packet tells its length. The whole packet has that number and `add` bytes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LengthField {
    /// Position in the packet.
    pub at: usize,
    /// Bytes of the number, 1 or 2.
    pub bytes: usize,
    /// What the number leaves out.
    pub add: i32,
}

/// `packets{ path = ..., start = ..., length = {...} }`: checked packets of a serial line, one for each tuple.
#[derive(Clone, Debug, PartialEq)]
pub struct PacketsDescription {
    /// Terminal, FIFO or file.
    pub path: PathBuf,
    /// Bits per second of a terminal; as it is if absent.
    pub baud: Option<u32>,
    /// What each packet begins with.
    pub start: Vec<u8>,
    /// Where its length is.
    pub length: LengthField,
    /// Of the length and of the checksum.
    pub order: ByteOrder,
    /// What its end is checked with.
    pub checksum: Checksum,
}

impl PacketsDescription {
    /// Bytes that tell the length of a packet.
    pub fn head_size(&self) -> usize {
        self.start.len().max(self.length.at + self.length.bytes)
    }

    /// The shortest packet that can be.
    pub fn size_min(&self) -> usize {
        self.head_size() + self.checksum.size()
    }
}

impl Kind for PacketsDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "packets",
        keys: &["path", "baud", "start", "length", "order", "checksum"],
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

    fn check_tuple_size(&self, size: usize, fields: &Fields<'_>) -> Result<(), Problem> {
        let least = self.size_min();
        if least > size {
            let reason = format!(
                "packets: start, length and checksum take {least} bytes, more than a tuple of {size}"
            );
            return Err(fields.problem("src", reason));
        }
        Ok(())
    }
}

/// Reads the constructor.
fn read(fields: &Fields<'_>, _nodes: &mut dyn Nodes) -> Result<PacketsDescription, Problem> {
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
    let length = length_field(fields)?;
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
    Ok(PacketsDescription {
        path,
        baud,
        start,
        length,
        order: order.unwrap_or(ByteOrder::Big),
        checksum,
    })
}

/// `length = { at = 1, bytes = 2, add = 2 }` of packets.
fn length_field(fields: &Fields<'_>) -> Result<LengthField, Problem> {
    let Some(value) = fields.get("length") else {
        let reason = "packets: length is missing, for example length = { at = 1, bytes = 2 }";
        return Err(fields.problem("src", reason));
    };
    let Some(table) = fields.table_of(value) else {
        return Err(fields.wrong_type("length", "a table", value));
    };
    let fields = fields.inner(table);
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
        let reason =
            format!("packets: length: add must be a whole number from -{max} to {max}, not {add}");
        return Err(fields.problem("src", reason));
    }
    #[allow(clippy::cast_possible_truncation, reason = "whole and within limits")]
    Ok(LengthField {
        at: usize::try_from(at).unwrap_or(TUPLE_BYTES_MAX),
        bytes: usize::try_from(bytes).unwrap_or(2),
        add: add as i32,
    })
}
