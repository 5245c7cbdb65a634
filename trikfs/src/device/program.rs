//! A program as a sink: each written text is the last argument of one run.
//!
//! Owns what a text may be for that. When it runs, and for how long, is the business of `programs`.

use super::{Device, Kind, Sink, Surroundings};
use crate::errno::Error;
use crate::programs::Programs;
use config::description::{CommandDescription, ProgramDescription};
use std::sync::Arc;

/// After this word a program takes nothing for an option (POSIX, utility syntax guideline 10).
const END: &str = "--";

impl Kind for ProgramDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Err(Error::AccessDenied)
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        let programs = around.programs.clone();
        Ok(Box::new(ProgramSink::new(&self.run, programs)))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(false)
    }
}

/// One way to a program.
pub struct ProgramSink {
    command: CommandDescription,
    programs: Arc<Programs>,
}

impl ProgramSink {
    /// Runs nothing yet.
    pub fn new(command: &CommandDescription, programs: Arc<Programs>) -> Self {
        Self {
            command: command.clone(),
            programs,
        }
    }
}

impl Sink for ProgramSink {
    fn write(&mut self, tuple: &[u8], _waits: bool) -> Result<(), Error> {
        let program = &self.command.program;
        if !program.exists() {
            return Err(Error::NoDevice(format!(
                "{} does not exist",
                program.display()
            )));
        }
        let end = tuple.iter().position(|&byte| byte == 0);
        let text = std::str::from_utf8(&tuple[..end.unwrap_or(tuple.len())])
            .map_err(|_| Error::Invalid("the text is no UTF-8".to_owned()))?;
        let ends_options = self
            .command
            .arguments
            .last()
            .is_some_and(|word| word == END);
        if text.starts_with('-') && !ends_options {
            return Err(Error::Invalid(
                "the program would take a text that begins with '-' for an option: if it knows '--', end its run with that"
                    .to_owned(),
            ));
        }
        self.programs.enqueue(&self.command, text)
    }
}
