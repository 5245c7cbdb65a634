//! One node that is looked at: its ring, and what it had last.
//!
//! Owns the way from an event of a ring to an entry. Which nodes are looked at is known to `watch`.

use crate::entry::{Entry, Known};
use crate::nodes;
use journal::layout::Layout;
use journal::node::Node;
use sample_bus::{Event, Reader, Step};
use std::path::Path;
use std::sync::Arc;

/// How much a node is wanted.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Wish {
    /// Its samples, if the clock takes them or if others need them: a camera is not started for that.
    ByTheClock,
    /// Its samples, whatever has to run for them.
    Samples,
}

/// One node that is looked at.
pub(crate) struct Watched {
    pub(crate) known: Arc<Known>,
    pub(crate) ring: Reader,
    pub(crate) wish: Wish,
    /// The last errno, and what `fault` said of it.
    fault: (i32, Arc<str>),
    /// What it had last.
    pub(crate) newest: Option<Entry>,
    /// When its last event was, by the clock of the machine, and that of the same ring before it was opened anew.
    last_ns: u64,
    taken_ns: u64,
}

impl Watched {
    pub(crate) fn new(number: u32, mut node: Node, ring: Reader, wish: Wish) -> Self {
        let size = Layout::parse(&node.format).map_or(0, |layout| layout.size());
        if size != ring.tuple_bytes() {
            // What is written has no names if it is converted on its way.
            node.format = format!("u8 x {}", ring.tuple_bytes());
        }
        Self {
            known: Arc::new(Known { number, node }),
            ring,
            wish,
            fault: (0, Arc::default()),
            newest: None,
            last_ns: 0,
            taken_ns: 0,
        }
    }

    /// Goes on with the same ring, opened in another way: it begins with events that have been taken.
    pub(crate) fn reopen(&mut self, ring: Reader, wish: Wish) {
        self.ring = ring;
        self.wish = wish;
        self.taken_ns = self.last_ns;
    }

    /// One event of its ring.
    fn entry(&mut self, root: &Path, event: Event, unix_ns: u64, tuple: &[u8]) -> Entry {
        let is_new = event.errno != self.fault.0;
        if is_new {
            let told = match event.errno {
                0 => None,
                _ => nodes::text(&root.join(&self.known.node.path).join("fault")),
            };
            self.fault = (event.errno, told.unwrap_or_default().into());
        }
        match event.errno {
            0 => Entry::Sample(self.known.clone(), unix_ns, tuple.into()),
            errno => Entry::Fault(self.known.clone(), unix_ns, errno, self.fault.1.clone()),
        }
    }

    /// Takes what has come; gives how much was overwritten before. What a node had when the looking began comes first.
    pub(crate) fn look(
        &mut self,
        from: &From<'_>,
        tuple: &mut Vec<u8>,
        out: &mut Vec<Entry>,
    ) -> u64 {
        let begin = out.len();
        let mut missed = 0;
        let mut before = None;
        loop {
            match self.ring.next_event(tuple) {
                Step::Event(event) if event.time_ns <= self.taken_ns => {}
                Step::Event(event) => {
                    self.last_ns = self.last_ns.max(event.time_ns);
                    let time_ns = event.time_ns.max(from.begin_ns);
                    let unix_ns = time_ns.saturating_add_signed(from.offset_ns);
                    let entry = self.entry(from.root, event, unix_ns, tuple);
                    if event.time_ns < from.begin_ns {
                        before = Some(entry);
                    } else {
                        out.extend(before.take());
                        out.push(entry);
                    }
                }
                Step::Missed(count) => missed += u64::from(count),
                Step::Nothing => break,
            }
        }
        out.extend(before);
        if out.len() > begin {
            self.newest = out.last().cloned();
        }
        missed
    }
}

/// What times of samples are counted from.
pub(crate) struct From<'a> {
    pub(crate) root: &'a Path,
    pub(crate) begin_ns: u64,
    pub(crate) offset_ns: i64,
}
