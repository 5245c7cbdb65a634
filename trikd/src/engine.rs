//! The border between the daemon and a language: what an engine is given, what it must do, and how a program ends.
//!
//! An engine runs in a child process of its own, so that a loop, greed or a crash costs that process only. Nothing
//! stops an engine politely: the daemon brings the motors to rest and kills the process. So an engine keeps nothing
//! that must be saved, and may loop, block and recurse as its program likes.

mod words;

use crate::blame::{Blame, Os};
use crate::brick::Brick;
use crate::host::Host;
use crate::js::files::Unread;
use crate::limits;
use lang_text::problem::{Locale, Words};
use std::fmt;
use std::path::PathBuf;

/// What an engine begins with.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Start {
    /// A program in a file, by its absolute path.
    File(PathBuf),
    /// A program in a file, as above, with a debugger attached and stopped before its first block, if the engine has one.
    Debugged(PathBuf),
    /// The text of a program that has no file.
    Script(String),
    /// No program: texts come one after the other ([`crate::host::Incoming::Direct`]), and share their variables.
    Direct,
}

/// Why a save of a diagram cannot be run.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum NoDiagram {
    /// It cannot be read.
    Unread(Os),
    /// It has more bytes than this.
    TooLong(u64),
    /// What is wrong with it, in the language of the person.
    Problems(Vec<String>),
}

impl NoDiagram {
    /// For a person with this language.
    pub fn in_locale(&self, locale: Locale) -> String {
        let words = Words::new(self.to_string(), words::no_diagram(self));
        words.in_locale(locale).to_owned()
    }
}

impl fmt::Display for NoDiagram {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Unread(os) => write!(out, "cannot be read: {os}"),
            Self::TooLong(limit) => write!(out, "is longer than {} MiB", limit >> 20),
            Self::Problems(lines) => out.write_str(&lines.join("\n")),
        }
    }
}

/// Why a thread of a program cannot be started.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum NoThread {
    /// Another one has its name.
    Occupied(String),
    /// There are [`limits::JS_THREADS`] already.
    TooMany,
    /// The system gives none.
    System(Os),
}

impl fmt::Display for NoThread {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Occupied(name) => write!(
                out,
                "Attempt to create a thread with an already occupied id {name}"
            ),
            Self::TooMany => write!(
                out,
                "a program has at most {} threads at once: wait for the end of some with Threading.joinThread",
                limits::JS_THREADS
            ),
            Self::System(os) => write!(out, "no thread: {os}"),
        }
    }
}

impl NoThread {
    /// Who can change something about it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Occupied(_) | Self::TooMany => Blame::Client,
            Self::System(_) => Blame::System,
        }
    }
}

/// Why a program did not end well.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Failure {
    /// The program itself, in the words of its language: `Line 2: ReferenceError: ...` with backtrace lines.
    Program(String),
    /// All was told when it happened.
    Told,
    /// A diagram that is in no file.
    NoFile,
    /// A diagram: the name of its file and what is wrong with it.
    Diagram(String, NoDiagram),
    /// Its text cannot be read.
    Unread(Unread),
    /// Its file cannot be found.
    Nowhere(PathBuf, Os),
    /// Its first thread.
    Thread(NoThread),
    /// What threads share cannot be made.
    Start(Os),
    /// The engine cannot be made, in its own words.
    Engine(String),
    /// The engine broke off.
    Broken,
    /// There is no second way to the daemon.
    NoWay(Os),
    /// The daemon does not say what to run.
    NoStart(Os),
    /// The daemon cannot be heard.
    Deaf(Os),
    /// The program has ended, and the tree at this path does not bring the robot to rest.
    Stop(PathBuf, Os),
}

impl Failure {
    /// Who can change something about it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Program(_)
            | Self::Told
            | Self::NoFile
            | Self::Diagram(..)
            | Self::Unread(_)
            | Self::Nowhere(..) => Blame::Client,
            Self::Thread(why) => why.blame(),
            Self::Start(_) | Self::Engine(_) | Self::NoWay(_) => Blame::System,
            Self::Broken | Self::NoStart(_) | Self::Deaf(_) => Blame::Trikd,
            Self::Stop(..) => Blame::Tree,
        }
    }

    /// For a person.
    pub fn words(&self) -> Words {
        Words::new(self.to_string(), words::russian(self))
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Program(text) => out.write_str(text),
            Self::Told => Ok(()),
            Self::NoFile => out.write_str("a diagram is a file"),
            Self::Diagram(name, why) => write!(out, "{name}: {why}"),
            Self::Unread(why) => write!(out, "{why}"),
            Self::Nowhere(path, os) => write!(out, "{}: where is it? {os}", path.display()),
            Self::Thread(why) => write!(out, "{why}"),
            Self::Start(os) => write!(out, "the program cannot be started: {os}"),
            Self::Engine(why) => write!(out, "JavaScript cannot be started: {why}"),
            Self::Broken => out.write_str("trikd has a defect: its JavaScript broke off"),
            Self::NoWay(os) => write!(out, "no way to the daemon: {os}"),
            Self::NoStart(os) => write!(out, "the daemon does not say what to run: {os}"),
            Self::Deaf(os) => write!(out, "the daemon cannot be heard: {os}"),
            Self::Stop(tree, os) => {
                let tree = tree.display();
                write!(out, "{tree}/stop: the motors may still turn: {os}")
            }
        }
    }
}

impl std::error::Error for Failure {}

/// How a program ended.
pub type Outcome = Result<(), Failure>;

/// An interpreter of one language.
pub trait Engine {
    /// Runs from the beginning to the end, in the directory of programs.
    ///
    /// Returns when the program is over: its text has been evaluated and it is not event-driven, or it has quit. With
    /// [`Start::Direct`] it never returns by itself but when [`Host::receive`] says that the daemon is gone.
    ///
    /// # Errors
    /// Why the program did not end well; the daemon puts `error: ` before its text. Failures of direct texts are told
    /// with [`Host::error`] and do not end anything.
    fn run(&mut self, start: Start, brick: &Brick, host: &Host) -> Outcome;
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_can_change_something_is_told_beside_the_words() {
        let os = || Os::from(std::io::Error::from_raw_os_error(libc::EMFILE));
        for (failure, blame, text) in [
            (Failure::Told, Blame::Client, ""),
            (Failure::Broken, Blame::Trikd, "trikd has a defect"),
            (
                Failure::Stop("/t".into(), os()),
                Blame::Tree,
                "/t/stop: the motors may still turn: ",
            ),
            (
                Failure::Thread(NoThread::System(os())),
                Blame::System,
                "no thread: ",
            ),
            (
                Failure::Thread(NoThread::TooMany),
                Blame::Client,
                "a program has at most ",
            ),
            (
                Failure::Diagram("a.qrs".to_owned(), NoDiagram::TooLong(2 << 20)),
                Blame::Client,
                "a.qrs: is longer than 2 MiB",
            ),
        ] {
            assert_eq!(failure.blame(), blame);
            assert!(failure.to_string().starts_with(text), "{failure}");
        }
    }
}
