//! The contract between trikfs and native converters: the Rust trait, the C ABI behind it, and its validation.
//!
//! A converter turns one tuple of bytes into another: raw bytes of a device into physical units, or back.
//! This crate owns what both sides must agree on and links nothing, so that anybody can depend on it.
//! It knows nothing of files, devices, Lua or of how a library is found and loaded.
//!
//! To write a converter: implement [`Converter`] for a struct and name it in [`export_converters!`];
//! `trikfs new-converter --lang rust NAME` writes a whole project.
//! To load one: `abi.rs` begins with the steps.

pub mod abi;
pub mod error;
pub mod export;
pub mod limits;
pub mod trial;
pub mod vectors;

#[cfg(test)]
mod templates;

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::ffi::CStr;
use std::fmt;

/// A converter written in Rust. One value exists per open file and direction, so state needs no locks.
pub trait Converter: Send + Sized {
    /// One sentence for lists of converters, ASCII.
    const DESCRIPTION: &'static CStr = c"";
    /// Bytes of the only input tuple it takes; 0 takes any and leaves the check to [`Converter::open`].
    const INPUT_SIZE: u32 = 0;
    /// Bytes of the only output tuple it gives; 0 gives any.
    const OUTPUT_SIZE: u32 = 0;

    /// Makes the state of one open file. Everything that can be refused is refused here, parameters above all.
    ///
    /// # Errors
    /// The text reaches the person who wrote the configuration: lower case, no trailing stop, names the thing.
    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault>;

    /// Turns one tuple into another.
    ///
    /// `input` has [`OpenInfo::input_size`] bytes and `output` [`OpenInfo::output_size`], always, and `output` comes zeroed.
    ///
    /// # Errors
    /// A tuple that cannot be converted. Never invent a plausible value instead. The next call is made as usual.
    fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Fault>;
}

/// What a converter did with a tuple.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Conversion {
    /// The output tuple is complete.
    Produced,
    /// The input was taken; there is no output yet.
    Consumed,
}

/// Which way the bytes go.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Direction {
    /// From the device to the program.
    Read,
    /// From the program to the device.
    Write,
}

/// What a converter is told when a file is opened.
pub struct OpenInfo<'a> {
    /// Which way this instance converts.
    pub direction: Direction,
    /// Bytes of every input tuple.
    pub input_size: usize,
    /// Bytes of every output tuple.
    pub output_size: usize,
    /// Path of the node in the tree, for messages.
    pub node: &'a str,
    /// The node's `params`. In a chain every stage sees the same ones, so names that mean nothing here are no error.
    pub params: &'a BTreeMap<String, f64>,
    /// Where [`OpenInfo::log`] goes.
    pub log: &'a dyn Fn(&str),
}

impl OpenInfo<'_> {
    /// The value of a parameter, absent when the configuration does not give it. It may be any number, NaN included.
    pub fn param(&self, name: &str) -> Option<f64> {
        self.params.get(name).copied()
    }

    /// Writes a line to the filesystem's `log`.
    pub fn log(&self, text: &str) {
        (self.log)(text);
    }
}

/// Why a tuple could not be converted, or why a converter refused to open: a text for people.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Fault(Cow<'static, str>);

impl Fault {
    /// A fault with this text: lower case, no trailing stop. A literal costs no allocation.
    pub fn new(text: impl Into<Cow<'static, str>>) -> Self {
        Self(text.into())
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.0
    }
}

impl fmt::Display for Fault {
    /// The text alone.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Fault {}

impl From<String> for Fault {
    fn from(text: String) -> Self {
        Self::new(text)
    }
}

impl From<&'static str> for Fault {
    fn from(text: &'static str) -> Self {
        Self::new(text)
    }
}
