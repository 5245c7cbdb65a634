//! How a command ends that cannot do its work: lines for standard error, and an exit code.
//!
//! Owns the codes that commands share, and the way to standard error. Knows no command.

use crate::error::Error;
use std::io::{self, Write};
use std::process::ExitCode;

/// Exit code of what was refused or failed.
pub(crate) const REFUSED: u8 = 1;
/// Exit code of a file that cannot be read.
pub(crate) const UNREADABLE: u8 = 2;

/// Why a command ends early: lines for standard error, and the exit code.
#[derive(Debug, PartialEq)]
pub(crate) struct Refusal {
    pub lines: Vec<String>,
    pub code: u8,
}

impl Refusal {
    /// One line that says why something was not done.
    pub fn new(reason: impl Into<String>) -> Self {
        Self {
            lines: vec![format!("trik: {}", reason.into())],
            code: REFUSED,
        }
    }
}

/// Ends a command: what kept it from being done goes to standard error.
pub(crate) fn end(done: Result<u8, Refusal>) -> ExitCode {
    let code = done.unwrap_or_else(|refusal| {
        say(&refusal.lines);
        refusal.code
    });
    ExitCode::from(code)
}

/// Lines to standard error. Nobody is told if nobody can hear it.
pub(crate) fn say(lines: &[String]) {
    let mut err = io::stderr().lock();
    for line in lines {
        let _ = writeln!(err, "{line}");
    }
}

impl From<Error> for Refusal {
    fn from(error: Error) -> Self {
        match error {
            Error::Reported => Self {
                lines: Vec::new(),
                code: REFUSED,
            },
            Error::Refused(_)
            | Error::File { .. }
            | Error::System { .. }
            | Error::Unreachable(_)
            | Error::Robot(_)
            | Error::Process(_) => Self::new(error.to_string()),
        }
    }
}
