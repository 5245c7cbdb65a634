//! What is wrong with a configuration, where, and what to do: the one error type of this crate.
//!
//! Knows nothing of errno; a refused configuration is always the writer's to mend.

use std::fmt;

/// One reason to refuse (or warn about) a configuration.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Problem {
    /// The file as the user named it, for example `robot.lua` or `config` for the live node.
    pub file: String,
    /// Line from 1; 0 when the problem has no line (a file that cannot be read).
    pub line: u32,
    /// Lower case, no trailing stop, names the thing. May hold several lines (compiler output).
    pub reason: String,
}

impl Problem {
    /// A problem at a line of a file.
    pub fn new(file: impl Into<String>, line: u32, reason: impl Into<String>) -> Self {
        Self {
            file: file.into(),
            line,
            reason: reason.into(),
        }
    }
}

impl fmt::Display for Problem {
    /// `file:line: reason`, or `file: reason` without a line.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line == 0 {
            write!(f, "{}: {}", self.file, self.reason)
        } else {
            write!(f, "{}:{}: {}", self.file, self.line, self.reason)
        }
    }
}

impl std::error::Error for Problem {}
