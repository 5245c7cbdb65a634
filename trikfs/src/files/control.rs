//! Small files about the tree: texts made when they are read, `poll_ms` and `stop`.
//!
//! Owns their rendering. What they tell belongs to the nodes and to the reloader.

use super::OpenFile;
use crate::bytes::copy_at;
use crate::errno::Error;
use crate::events::lock;
use crate::node::{Node, rest_all};
use crate::text;
use crate::transport::{Outcome, Transfer};
use std::sync::{Arc, Mutex};

/// A text that is made anew at each read from its beginning.
pub struct TextFile {
    make: Box<dyn Fn() -> String + Send + Sync>,
    shown: Mutex<String>,
    /// Bytes of the text, about.
    bytes: usize,
}

impl TextFile {
    /// A file with this content.
    pub fn new(make: impl Fn() -> String + Send + Sync + 'static) -> Self {
        Self {
            make: Box::new(make),
            shown: Mutex::default(),
            bytes: 0,
        }
    }

    /// The same, with a text that is long: this is about how long.
    #[must_use]
    pub fn long(mut self, bytes: usize) -> Self {
        self.bytes = bytes;
        self
    }

    fn copy(&self, offset: u64, out: &mut [u8]) -> usize {
        let mut shown = lock(&self.shown);
        if offset == 0 {
            *shown = (self.make)();
        }
        copy_at(shown.as_bytes(), offset, out)
    }
}

impl OpenFile for TextFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        Ok(Outcome::Done(self.copy(request.offset, out)))
    }

    fn held_bytes(&self) -> usize {
        self.bytes
    }
}

/// `poll_ms`: the sampling period, to be read and changed.
pub struct PeriodFile {
    node: Arc<Node>,
    text: TextFile,
}

impl PeriodFile {
    /// The period of one node.
    pub fn new(node: &Arc<Node>) -> Self {
        let shown = node.clone();
        Self {
            node: node.clone(),
            text: TextFile::new(move || format!("{}\n", shown.sampling.period_ms())),
        }
    }
}

impl OpenFile for PeriodFile {
    fn read(&self, request: &Transfer, out: &mut [u8]) -> Result<Outcome, Error> {
        self.text.read(request, out)
    }

    fn write(&self, _request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        let text = text::from_bytes(data)?;
        let number: i64 = text
            .parse()
            .map_err(|_| Error::Invalid("poll_ms is a whole number of ms".to_owned()))?;
        let period_ms = u32::try_from(number)
            .map_err(|_| Error::OutOfRange("poll_ms is at least 1".to_owned()))?;
        self.node.sampling.set_period_ms(period_ms)?;
        Ok(Outcome::Done(data.len()))
    }
}

/// `stop`: any write brings every actuator to rest.
pub struct StopFile {
    nodes: Box<dyn Fn() -> Vec<Arc<Node>> + Send + Sync>,
}

impl StopFile {
    /// Acts on the nodes that are in force at the time of the write.
    pub fn new(nodes: impl Fn() -> Vec<Arc<Node>> + Send + Sync + 'static) -> Self {
        Self {
            nodes: Box::new(nodes),
        }
    }
}

impl OpenFile for StopFile {
    fn write(&self, _request: &Transfer, data: &[u8]) -> Result<Outcome, Error> {
        rest_all(&(self.nodes)())?;
        Ok(Outcome::Done(data.len()))
    }
}

/// The lines of `status` after the first: name, state, rate and fault of each node.
pub fn status_lines(nodes: &[Arc<Node>]) -> String {
    let mut out = String::new();
    for node in nodes {
        let fault = node.fault();
        let state = match (&fault, node.description.pace) {
            (Some(_), _) => "fault",
            (None, config::description::Pace::OnRead) => "ready",
            (None, _) if node.sampling.newest.is_at_rest() => "ready",
            (None, _) if node.sampling.newest.stamp().is_some() => "sampled",
            (None, _) => "waiting",
        };
        let why = fault.map_or_else(|| "-".to_owned(), |error| fault_line(&error));
        out.push_str(&format!(
            "{} {state} {:.1}Hz {why}\n",
            node.path(),
            node.sampling.rate_hz(node.stats.samples.get())
        ));
    }
    out
}

/// Who is to blame and why, on one line.
pub fn fault_line(error: &Error) -> String {
    let text: String = error
        .to_string()
        .chars()
        .map(|c| if c.is_control() { ' ' } else { c })
        .collect();
    format!("{}: {text}", error.blame())
}
