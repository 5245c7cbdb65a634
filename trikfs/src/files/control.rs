//! Small files about the tree: texts made when they are read, `poll_ms` and `stop`.
//!
//! Owns their rendering. What they tell belongs to the nodes and to the reloader.

use super::OpenFile;
use crate::bytes::copy_at;
use crate::errno::Error;
use crate::events::lock;
use crate::limits;
use crate::node::Node;
use crate::text;
use crate::transport::{Outcome, Transfer};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex};

/// A text that is made anew at each read from its beginning.
pub struct TextFile {
    make: Box<dyn Fn() -> String + Send + Sync>,
    shown: Mutex<String>,
}

impl TextFile {
    /// A file with this content.
    pub fn new(make: impl Fn() -> String + Send + Sync + 'static) -> Self {
        Self {
            make: Box::new(make),
            shown: Mutex::default(),
        }
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
            text: TextFile::new(move || format!("{}\n", shown.period_ms())),
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
        self.node.set_period_ms(period_ms)?;
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

/// Brings every actuator to rest, slow ones beside each other: one that hangs keeps one thread. All are tried; the
/// first failure is returned.
pub fn rest_all(nodes: &[Arc<Node>]) -> Result<(), Error> {
    let has_rest = |node: &&Arc<Node>| node.description.rest.is_some();
    let actuators: Vec<_> = nodes.iter().filter(has_rest).collect();
    let threads = actuators.len().min(limits::REST_THREADS_MAX);
    let next = AtomicUsize::new(0);
    let failures = Mutex::new(Vec::new());
    // First nobody may drive them any more.
    for regulation in nodes.iter().filter_map(|node| node.regulation()) {
        regulation.release();
    }
    let work = || {
        while let Some(node) = actuators.get(next.fetch_add(1, Ordering::Relaxed)) {
            if let Err(error) = node.rest() {
                node.report(&error);
                lock(&failures).push(error);
            }
        }
    };
    std::thread::scope(|scope| {
        for _ in 1..threads {
            // Without further threads it takes longer.
            let _ = std::thread::Builder::new().spawn_scoped(scope, work);
        }
        work();
    });
    let first = lock(&failures).first().cloned();
    first.map_or(Ok(()), Err)
}

/// The lines of `status` after the first: name, state, rate and fault of each node.
pub fn status_lines(nodes: &[Arc<Node>]) -> String {
    let mut out = String::new();
    for node in nodes {
        let fault = node.fault();
        let state = match (&fault, node.description.pace) {
            (Some(_), _) => "fault",
            (None, config::description::Pace::OnRead) => "ready",
            (None, _) if node.newest.stamp().is_some() => "sampled",
            (None, _) => "waiting",
        };
        let why = fault.map_or_else(|| "-".to_owned(), |error| fault_line(&error));
        out.push_str(&format!(
            "{} {state} {:.1}Hz {why}\n",
            node.path(),
            node.rate_hz()
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
