//! Entries as types, channels and messages, for those who pass them on in a form of their own.
//!
//! Owns that these are the ones that a recording would have, those of other people's tools among them. Knows no clients.

use crate::clock::now_ns;
use crate::entry::Entry;
use crate::pen::Pen;
use journal::error::Error;
use journal::records::{Record, records};
use journal::write::{Out, Writer};

/// A recording that nobody keeps.
pub struct Live {
    pen: Pen<Out>,
    out: Out,
}

impl Live {
    /// Begins it; `library` is the program that passes it on, with its version.
    ///
    /// # Errors
    /// None is seen.
    pub fn begin(library: &str) -> Result<Self, Error> {
        let out = Out::default();
        let mut writer = Writer::live(out.clone(), library)?;
        // What a node has had for long is news for one who hears of it first.
        writer.begin_at(now_ns());
        Ok(Self {
            pen: Pen::new(writer).with_standard(true),
            out,
        })
    }

    /// What a recording would have of the entries of one look, and the first failure: a node has a format that is none, or
    /// there are too many. Of other nodes all is there.
    pub fn take(&mut self, entries: &[Entry]) -> (Vec<Record>, Option<Error>) {
        let mut failure = None;
        let mut keep = |result: Result<(), Error>| {
            if let Err(why) = result {
                failure.get_or_insert(why);
            }
        };
        for entry in entries {
            match entry {
                Entry::Attachment(..) | Entry::Facts(..) => {}
                Entry::Node(_) | Entry::Sample(..) | Entry::Fault(..) | Entry::Line(..) => {
                    keep(self.pen.put(entry));
                }
            }
        }
        keep(self.pen.settle(false));
        match records(&self.out.take()) {
            Ok(all) => (all, failure),
            Err(why) => (Vec::new(), failure.or(Some(why))),
        }
    }
}
