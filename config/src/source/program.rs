//! `program{ run = { ... } }`: each written text is the last argument of a program that is run for it.
//!
//! Nothing can be read from it.

use super::command::{CommandDescription, command};
use super::kind::{Constructor, Delivery, Kind};
use super::rest::Rest;
use std::path::{Path, PathBuf};

/// `program{ run = { '/etc/trik/say' } }`
#[derive(Clone, Debug, PartialEq)]
pub struct ProgramDescription {
    /// The program, and what stands before the text.
    pub run: CommandDescription,
}

impl Kind for ProgramDescription {
    const CONSTRUCTORS: &'static [Constructor<Self>] = &[Constructor {
        word: "program",
        keys: &["run"],
        read: |fields, _| match command(fields, "program", "run")? {
            Some(run) => Ok(Self { run }),
            None => Err(fields.problem(
                "src",
                "program: run is missing, for example run = { '/etc/trik/say' }",
            )),
        },
    }];
    const REST: Rest<Self> = Rest::NoDevice;

    fn each_path(&mut self, take: &mut dyn FnMut(&mut PathBuf)) {
        take(&mut self.run.program);
    }

    fn needed_paths(&self) -> Vec<&Path> {
        vec![&self.run.program]
    }

    fn delivery(&self, _nodes: &dyn Fn(&str) -> Delivery) -> Delivery {
        Delivery::Unknown
    }

    fn gives_tuples(&self) -> bool {
        false
    }
}
