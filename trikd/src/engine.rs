//! The border between the daemon and a language: what an engine is given and what it must do.
//!
//! An engine runs in a child process of its own, so that a loop, greed or a crash costs that process only. Nothing
//! stops an engine politely: the daemon brings the motors to rest and kills the process. So an engine keeps nothing
//! that must be saved, and may loop, block and recurse as its program likes.

use crate::brick::Brick;
use crate::host::Host;
use std::path::PathBuf;

/// What an engine begins with.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Start {
    /// A program in a file, by its absolute path.
    File(PathBuf),
    /// The text of a program that has no file.
    Script(String),
    /// No program: texts come one after the other ([`crate::host::Incoming::Direct`]), and share their variables.
    Direct,
}

/// How a program ended.
pub type Outcome = Result<(), String>;

/// An interpreter of one language.
pub trait Engine {
    /// Runs from the beginning to the end, in the directory of programs.
    ///
    /// Returns when the program is over: its text has been evaluated and it is not event-driven, or it has quit. With
    /// [`Start::Direct`] it never returns by itself but when [`Host::receive`] says that the daemon is gone.
    ///
    /// # Errors
    /// The text of the failure as a person shall read it: `Line 2: ReferenceError: ...` with backtrace lines; empty if
    /// all was told already. The
    /// daemon puts `error: ` before it. Failures of direct texts are told with [`Host::error`] and do not end anything.
    fn run(&mut self, start: Start, brick: &Brick, host: &Host) -> Outcome;
}
