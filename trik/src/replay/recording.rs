//! A recording as a player needs it: channels with the form of their tuples, and what happened on them in order.
//!
//! Owns that border, so that the player knows no format of files; `journal` files are one implementation.

use crate::error::Error;
use journal::layout::Layout;
use std::time::Duration;

/// One node that was recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Channel {
    /// Path of the node.
    pub(crate) path: String,
    /// Names and types of its numbers, as `format` has them; empty for plain bytes.
    pub(crate) format: String,
    pub(crate) units: String,
    pub(crate) about: String,
    /// Bytes of a tuple.
    pub(crate) bytes: usize,
    /// The numbers in them.
    pub(crate) layout: Layout,
    /// It could be written: an actuator.
    pub(crate) is_written: bool,
    /// What brings it to rest: numbers with commas between them; empty for what needs no rest.
    pub(crate) rest: String,
    /// Other names of the node.
    pub(crate) aliases: Vec<String>,
}

/// What a reader of the node got.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Reading {
    /// A tuple.
    Sample(Vec<u8>),
    /// No value: the errno and the reason.
    Failure(i32, String),
}

/// Something that happened.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Event {
    /// From the beginning of the recording.
    pub(crate) at: Duration,
    /// Which channel.
    pub(crate) channel: usize,
    pub(crate) what: Reading,
}

/// A recording that is read from any position on.
pub(crate) trait Recording {
    /// Its nodes, in the order in which events name them.
    fn channels(&self) -> &[Channel];

    /// From the first event to the last.
    fn length(&self) -> Duration;

    /// From now on `next` gives what happened at this position and after it.
    ///
    /// # Errors
    /// The file cannot be read.
    fn seek(&mut self, position: Duration) -> Result<(), Error>;

    /// As `seek`, but `next` gives events of these channels alone, until the next of both.
    ///
    /// # Errors
    /// The file cannot be read.
    fn seek_among(&mut self, position: Duration, channels: &[usize]) -> Result<(), Error>;

    /// The next event; None at the end.
    ///
    /// # Errors
    /// The file cannot be read any further.
    fn next(&mut self) -> Result<Option<Event>, Error>;

    /// What each channel had before this position, the newest of it. It changes nothing for `next`.
    ///
    /// # Errors
    /// The file cannot be read.
    fn newest(&mut self, position: Duration) -> Result<Vec<Option<Reading>>, Error>;
}
