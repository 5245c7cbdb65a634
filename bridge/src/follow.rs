//! A tree that may go and come back at the same mount point.
//!
//! Owns when it is looked for again. What happens in it is seen by `recorder`.

use crate::error::Error;
use crate::limits::RETURN_TIME;
use recorder::entry::Entry;
use recorder::watch::{Watch, Wish};
use std::path::{Path, PathBuf};
use std::time::Instant;

/// What became of a tree since the last look.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Change {
    /// Nothing.
    Same,
    /// It is not mounted any more.
    Gone,
    /// It is there again; it may be another one.
    Back,
}

/// A tree that is followed.
pub struct Follow {
    root: PathBuf,
    program: String,
    watch: Option<Watch>,
    again_at: Instant,
    /// Samples that were missed in trees that have gone.
    missed: u64,
}

impl Follow {
    /// Begins with a tree that must be there; `program` is what looks, with its version.
    ///
    /// # Errors
    /// It is not there, or nothing of it is sampled.
    pub fn begin(root: &Path, program: &str) -> Result<Self, Error> {
        let watch = Watch::begin(root, program, Box::new(|_| Some(Wish::ByTheClock)))
            .map_err(Error::Tree)?;
        Ok(Self {
            root: root.to_owned(),
            program: program.to_owned(),
            watch: Some(watch),
            again_at: Instant::now(),
            missed: 0,
        })
    }

    /// Where the tree is, or was.
    pub fn root(&self) -> &Path {
        &self.root
    }

    /// It is there.
    pub fn is_there(&self) -> bool {
        self.watch.is_some()
    }

    /// Samples that were overwritten before they were looked at.
    pub fn missed(&self) -> u64 {
        self.missed + self.watch.as_ref().map_or(0, Watch::missed)
    }

    /// What one who comes late must have first.
    pub fn beginning(&self) -> Vec<Entry> {
        self.watch.as_ref().map_or_else(Vec::new, Watch::beginning)
    }

    /// Takes what has come since the last look.
    pub fn look(&mut self, out: &mut Vec<Entry>) -> Change {
        if let Some(watch) = &mut self.watch {
            watch.look(out);
            if !watch.is_gone() {
                return Change::Same;
            }
            self.missed += watch.missed();
            self.watch = None;
            self.again_at = Instant::now() + RETURN_TIME;
            return Change::Gone;
        }
        if Instant::now() < self.again_at {
            return Change::Same;
        }
        self.again_at = Instant::now() + RETURN_TIME;
        match Watch::begin(
            &self.root,
            &self.program,
            Box::new(|_| Some(Wish::ByTheClock)),
        ) {
            Ok(watch) => {
                self.watch = Some(watch);
                Change::Back
            }
            // It is looked for once more later.
            Err(_) => Change::Same,
        }
    }
}
