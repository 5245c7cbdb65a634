//! Entries as messages of one recording.
//!
//! Owns which nodes the recording knows by now: one that is new is added before its first message.

use crate::entry::{Entry, Known};
use journal::error::Error;
use journal::write::{Id, Writer};
use std::collections::{BTreeMap, HashMap};
use std::io::{Seek, Write};

/// Writes one recording.
pub(crate) struct Pen<W: Write + Seek> {
    pub(crate) file: Writer<W>,
    ids: HashMap<u32, Id>,
}

impl<W: Write + Seek> Pen<W> {
    pub(crate) fn new(file: Writer<W>) -> Self {
        Self {
            file,
            ids: HashMap::new(),
        }
    }

    fn id(&mut self, known: &Known) -> Result<Id, Error> {
        if let Some(id) = self.ids.get(&known.number) {
            return Ok(*id);
        }
        let id = self.file.add(&known.node)?;
        self.ids.insert(known.number, id);
        Ok(id)
    }

    /// Writes one entry.
    ///
    /// # Errors
    /// The file takes nothing more.
    pub(crate) fn put(&mut self, entry: &Entry) -> Result<(), Error> {
        match entry {
            Entry::Node(known) => self.id(known).map(drop),
            Entry::Sample(known, unix_ns, tuple) => {
                let id = self.id(known)?;
                self.file.sample(id, *unix_ns, tuple)
            }
            Entry::Fault(known, unix_ns, errno, reason) => {
                let id = self.id(known)?;
                self.file.fault(id, *unix_ns, *errno, reason)
            }
            Entry::Line(story, unix_ns, line) => self.file.line(*story, *unix_ns, line),
            Entry::Attachment(unix_ns, name, media_type, bytes) => {
                self.file.attach(*unix_ns, name, media_type, bytes)
            }
            Entry::Facts(name, facts) => self.file.facts(name, BTreeMap::clone(facts)),
        }
    }
}
