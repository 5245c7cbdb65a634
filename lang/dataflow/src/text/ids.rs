//! Ids that a text need not say: made of the name of a diagram, of labels and of ports, the same at each reading.
//!
//! Owns their form, and which texts can be ids at all. A label can be read back from the id of its block, so labels that
//! people gave outlive a save. Knows neither drafts nor projects.

use crate::limits;
use crate::project::DiagramKind;
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

/// How all ids of this language begin.
const BEGINNING: &str = "qrm:/RobotsDataFlowMetamodel/RobotsDataFlowDiagram/";
/// What ids of a diagram's logical object end with.
const LOGICAL: &str = ".logical";
/// The element in an id of a block whose element cannot stand there.
const NO_ELEMENT: &str = "Unknown";

/// Whether a text can be an id. It is the name of a file in a save, so it must not lead out of it.
pub(super) fn can_be(text: &str) -> bool {
    let has_bad_sign = text.contains(|c: char| c.is_control() || c == '\\');
    let parts = text.strip_prefix("qrm:/").unwrap_or(text);
    let leads_out = |part: &str| part.starts_with('.');
    !text.is_empty()
        && text.len() <= limits::SOURCE_ID_BYTES_MAX
        && !has_bad_sign
        && !parts.split('/').any(leads_out)
        && !parts.starts_with('/')
}

/// A name as a part of an id: letters and digits of ASCII and `_` stand for themselves, others for their numbers; of a
/// long name a hash.
fn encoded(name: &str) -> String {
    let mut out = String::new();
    for c in name.chars() {
        if c.is_ascii_alphanumeric() || c == '_' {
            out.push(c);
        } else {
            let _ = write!(out, "-{:x}-", u32::from(c));
        }
        if out.len() > limits::SOURCE_ID_NAME_BYTES_MAX {
            return hash(name);
        }
    }
    out
}

/// The name of a part; a hash has none.
fn decoded(part: &str) -> Option<String> {
    if part.matches('-').count() % 2 == 1 {
        return None;
    }
    let mut out = String::new();
    for (at, piece) in part.split('-').enumerate() {
        if at % 2 == 0 {
            out.push_str(piece);
        } else {
            let number = u32::from_str_radix(piece, 16).ok()?;
            out.push(char::from_u32(number)?);
        }
    }
    Some(out)
}

/// FNV-1a of 64 bits. That others hash to the same is no harm: ids that are taken are not given again.
fn hash(text: &str) -> String {
    let mix = |sum: u64, byte: u8| (sum ^ u64::from(byte)).wrapping_mul(0x100_0000_01b3);
    let sum = text.bytes().fold(0xcbf2_9ce4_8422_2325, mix);
    format!("-{sum:016x}")
}

/// The id for the n-th diagram of a name, from 0.
pub(super) fn diagram(kind: DiagramKind, name: &str, count: usize) -> String {
    let element = match kind {
        DiagramKind::Main => "RobotsBehaviourDiagram",
        DiagramKind::Subprogram => "RobotsBehaviourSubprogram",
    };
    let name = match name {
        "" => "-".to_owned(),
        name => encoded(name),
    };
    format!("{BEGINNING}{element}/{name}{}", nth(count))
}

fn nth(count: usize) -> String {
    match count {
        0 => String::new(),
        count => format!(".{}", count + 1),
    }
}

/// The id of the logical object that belongs to an id that was made.
pub(super) fn logical(id: &str) -> String {
    format!("{id}{LOGICAL}")
}

/// Ids of what is in one diagram.
#[derive(Clone, Debug)]
pub(super) struct Inside {
    /// What they begin with after the element: the last part of the diagram's id.
    stem: String,
}

impl Inside {
    /// In the diagram with this id.
    pub fn new(diagram: &str) -> Self {
        let last = diagram.rsplit('/').next().unwrap_or_default();
        let is_long = last.len() > limits::SOURCE_ID_NAME_BYTES_MAX || last.is_empty();
        let stem = if is_long {
            hash(diagram)
        } else {
            last.to_owned()
        };
        Self { stem }
    }

    /// The id of a block.
    pub fn block(&self, element: &str, label: &str) -> String {
        format!("{}{}", self.beginning(element), encoded(label))
    }

    /// Up to the label.
    fn beginning(&self, element: &str) -> String {
        let is_part = can_be(element)
            && !element.contains(['/', ':'])
            && element.len() <= limits::SOURCE_ID_NAME_BYTES_MAX;
        let element = if is_part { element } else { NO_ELEMENT };
        format!("{BEGINNING}{element}/{}.", self.stem)
    }

    /// The label of which the id of a block was made.
    pub fn label(&self, element: &str, id: &str) -> Option<String> {
        decoded(id.strip_prefix(&self.beginning(element))?)
    }

    /// The id of the n-th edge, from 0, between two ports, each by the label of its block.
    pub fn edge(&self, ends: [Option<(&str, i32)>; 2], count: usize) -> String {
        let mut id = format!("{BEGINNING}Edge/{}", self.stem);
        for end in ends {
            let _ = match end {
                Some((label, port)) => write!(id, ".{}.{port}", encoded(label)),
                None => write!(id, ".-.-"),
            };
        }
        id + &nth(count)
    }
}

/// How often each of some names was there.
#[derive(Debug)]
pub(super) struct Counts<K>(HashMap<K, usize>);

impl<K: std::hash::Hash + Eq> Counts<K> {
    pub fn new() -> Self {
        Self(HashMap::new())
    }

    /// How often it was there before.
    pub fn next(&mut self, name: K) -> usize {
        let count = self.0.entry(name).or_default();
        *count += 1;
        *count - 1
    }

    /// How often it was there.
    pub fn of<Q: std::hash::Hash + Eq + ?Sized>(&self, name: &Q) -> usize
    where
        K: std::borrow::Borrow<Q>,
    {
        self.0.get(name).copied().unwrap_or_default()
    }
}

/// Ids that something has.
#[derive(Debug, Default)]
pub(super) struct Taken {
    all: HashSet<String>,
    /// The last number after an id that was taken.
    numbers: HashMap<String, u64>,
}

impl Taken {
    /// Takes an id that was said; whether nothing had it.
    pub fn take(&mut self, id: &str) -> bool {
        self.all.insert(id.to_owned())
    }

    /// Takes an id that is wanted, or one that is like it.
    pub fn make(&mut self, wanted: String) -> String {
        if self.all.insert(wanted.clone()) {
            return wanted;
        }
        let number = self.numbers.entry(wanted.clone()).or_default();
        loop {
            *number += 1;
            let other = format!("{wanted}.x{number}");
            if self.all.insert(other.clone()) {
                return other;
            }
        }
    }
}
