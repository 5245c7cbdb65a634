//! Entries as messages of one recording.
//!
//! Owns which nodes the recording knows by now: one that is new is added before its first message.

use crate::entry::{Entry, Known};
use crate::standard::Standard;
use journal::error::Error;
use journal::write::{Id, Writer};
use std::collections::{BTreeMap, HashMap};
use std::io::{Seek, Write};

/// Writes one recording.
pub(crate) struct Pen<W: Write + Seek> {
    pub(crate) file: Writer<W>,
    ids: HashMap<u32, Id>,
    /// None if there are messages of the nodes themselves alone.
    standard: Option<Standard>,
}

impl<W: Write + Seek> Pen<W> {
    pub(crate) fn new(file: Writer<W>) -> Self {
        Self {
            file,
            ids: HashMap::new(),
            standard: None,
        }
    }

    /// With standard messages too, if they are wanted.
    pub(crate) fn with_standard(self, is_wanted: bool) -> Self {
        Self {
            standard: is_wanted.then(Standard::default),
            ..self
        }
    }

    fn id(&mut self, known: &Known) -> Result<Id, Error> {
        if let Some(id) = self.ids.get(&known.number) {
            return Ok(*id);
        }
        let id = self.file.add(&known.node)?;
        self.ids.insert(known.number, id);
        if let Some(standard) = &mut self.standard
            && !known.node.is_raw
        {
            standard.meet(known, id, &self.file);
        }
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
                self.file.sample(id, *unix_ns, tuple)?;
                match &mut self.standard {
                    Some(standard) if !known.node.is_raw => {
                        standard.sample(&mut self.file, known, *unix_ns, tuple)
                    }
                    Some(_) | None => Ok(()),
                }
            }
            Entry::Fault(known, unix_ns, errno, reason) => {
                let id = self.id(known)?;
                if let Some(standard) = &mut self.standard
                    && !known.node.is_raw
                {
                    standard.fault(known);
                }
                self.file.fault(id, *unix_ns, *errno, reason)
            }
            Entry::Line(story, unix_ns, line) => self.file.line(*story, *unix_ns, line),
            Entry::Attachment(unix_ns, name, media_type, bytes) => {
                self.file.attach(*unix_ns, name, media_type, bytes)
            }
            Entry::Facts(name, facts) => self.file.facts(name, BTreeMap::clone(facts)),
        }
    }

    /// All entries of one look were put, or with `is_end` all that there are: writes messages that are made of several.
    ///
    /// # Errors
    /// The file takes nothing more.
    pub(crate) fn settle(&mut self, is_end: bool) -> Result<(), Error> {
        match &mut self.standard {
            Some(standard) => standard.settle(&mut self.file, is_end),
            None => Ok(()),
        }
    }
}
