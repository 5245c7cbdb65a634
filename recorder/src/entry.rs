//! Something for a recording, as it is handed from the one who saw it to all who keep it.
//!
//! Owns the kinds. An entry is cheap to copy: what is large in it is shared.

use journal::node::Node;
use journal::standard::Log;
use journal::write::Story;
use std::collections::BTreeMap;
use std::sync::Arc;

/// A node that is looked at. One whose format changes becomes another one.
#[derive(Debug)]
pub struct Known {
    /// No other one has it that the same files or clients hear of.
    pub number: u32,
    /// What is known of it.
    pub node: Node,
}

/// Something for a recording; times are ns since 1970.
#[derive(Clone, Debug)]
pub enum Entry {
    /// A node that is there, also if it has nothing to say yet.
    Node(Arc<Known>),
    /// A sample of a node.
    Sample(Arc<Known>, u64, Arc<[u8]>),
    /// A node has no value: its errno, and why.
    Fault(Arc<Known>, u64, i32, Arc<str>),
    /// A line of the log or another story.
    Line(Story, u64, Arc<Log>),
    /// A file that goes with the recording: its name, its type, its bytes.
    Attachment(u64, Arc<str>, &'static str, Arc<[u8]>),
    /// Facts, by a name.
    Facts(&'static str, Arc<BTreeMap<String, String>>),
}

impl Entry {
    /// Bytes that it keeps in memory, about.
    pub fn size(&self) -> usize {
        size_of::<Self>()
            + match self {
                Self::Sample(_, _, bytes) | Self::Attachment(_, _, _, bytes) => bytes.len(),
                Self::Fault(_, _, _, text) => text.len(),
                Self::Line(_, _, line) => line.name.len() + line.text.len(),
                Self::Node(_) | Self::Facts(..) => 0,
            }
    }

    /// Whether something has happened.
    pub fn is_event(&self) -> bool {
        self.unix_ns().is_some()
    }

    /// When it has happened; None for what only says what there is.
    pub fn unix_ns(&self) -> Option<u64> {
        match self {
            Self::Sample(_, unix_ns, _)
            | Self::Fault(_, unix_ns, ..)
            | Self::Line(_, unix_ns, _) => Some(*unix_ns),
            Self::Node(_) | Self::Attachment(..) | Self::Facts(..) => None,
        }
    }

    /// Whether this is news of the same thing: of one node, or a file of one name.
    pub fn replaces(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Sample(known, ..) | Self::Fault(known, ..),
                Self::Sample(other, ..) | Self::Fault(other, ..),
            ) => known.number == other.number,
            (Self::Attachment(_, name, ..), Self::Attachment(_, other, ..)) => name == other,
            (Self::Facts(name, _), Self::Facts(other, _)) => name == other,
            (
                Self::Node(_)
                | Self::Sample(..)
                | Self::Fault(..)
                | Self::Line(..)
                | Self::Attachment(..)
                | Self::Facts(..),
                _,
            ) => false,
        }
    }

    /// Whether it is of what a device gave, before it was converted.
    pub fn is_raw(&self) -> bool {
        self.node().is_some_and(|known| known.node.is_raw)
    }

    /// The node that it is of.
    pub fn node(&self) -> Option<&Arc<Known>> {
        match self {
            Self::Node(known) | Self::Sample(known, ..) | Self::Fault(known, ..) => Some(known),
            Self::Line(..) | Self::Attachment(..) | Self::Facts(..) => None,
        }
    }
}

/// What came in one look; shared by all who take it.
pub type Batch = Arc<[Entry]>;

/// Bytes that a batch keeps in memory, about.
pub fn size(batch: &[Entry]) -> usize {
    batch.iter().map(Entry::size).sum()
}

/// How many of these are events.
pub fn events(batch: &[Entry]) -> u64 {
    batch.iter().filter(|entry| entry.is_event()).count() as u64
}
