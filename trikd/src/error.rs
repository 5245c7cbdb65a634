//! Why the daemon cannot start, serve or end something, and who can change that.
//!
//! Owns the failures of the processes of trikd and their words. Those of an area stand in its module: names of programs
//! in `scripts`, places in `server`, the tree in `program/rest`, ends of programs in `engine`.

use crate::blame::{Blame, Os};
use crate::display::Unshown;
use crate::engine;
use crate::program::rest;
use crate::status;
use std::fmt;
use std::io;
use std::path::{Path, PathBuf};

/// Why programs cannot be run as the user of this name.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum BadUser {
    /// It cannot be looked for.
    Unknown(Os),
    /// There is none.
    Missing,
    /// trikd is not root.
    WithoutRoot,
    /// It is root.
    Root,
    /// The folder of programs cannot be given to it.
    Folder(PathBuf, Os),
}

/// Why something cannot be done.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Error {
    /// The system, with nothing to add.
    Os(Os),
    /// A file or folder.
    File(PathBuf, Os),
    /// A directory, and the option that names it.
    Directory(PathBuf, Os, &'static str),
    /// A thread cannot be started.
    Thread(Os),
    /// The event loop cannot be made.
    EventLoop(Os),
    /// Signals cannot be received.
    Signals(Os),
    /// A port cannot be served: its name and number.
    Port(&'static str, u16, Os),
    /// The page for browsers cannot be served.
    Page(String),
    /// The user of programs.
    User(String, BadUser),
    /// Orphans of programs cannot be adopted.
    Subreaper(Os),
    /// `kill-user` as root.
    KillUserAsRoot,
    /// `kill-user` was refused.
    KillUser(Os),
    /// The guardian cannot wait for signals.
    Guardian(Os),
    /// The serving process cannot be started.
    ServingProcess(Os),
    /// The guardian has ended before the serving process began.
    GuardianGone,
    /// The serving process crashed while it was ended.
    CrashAtTheEnd,
    /// The serving process has crashed so often within so many seconds.
    Crashes(usize, u64),
    /// The process of a program cannot be given its limits.
    Launch(Os),
    /// The daemon has ended before its program began.
    DaemonGone,
    /// `launch` without a program.
    NoProgram,
    /// A program cannot be started.
    Execute(String, Os),
    /// A manual page for no command.
    NoCommand(String),
    /// The tree.
    Rest(rest::Failure),
    /// The black box.
    Recorder(recorder::error::Error),
    /// A question to the running trikd.
    Ask(status::Unanswered),
    /// Orders for the display.
    Display(Unshown),
    /// A program in this terminal.
    Program(engine::Failure),
}

impl Error {
    /// Who can change something about it.
    pub fn blame(&self) -> Blame {
        match self {
            Self::Directory(..)
            | Self::Port(..)
            | Self::Page(_)
            | Self::User(..)
            | Self::KillUserAsRoot
            | Self::NoProgram
            | Self::NoCommand(_)
            | Self::Ask(_) => Blame::Operator,
            Self::Execute(..) => Blame::Client,
            Self::Display(why) => why.blame(),
            Self::Program(failure) => failure.blame(),
            Self::Rest(_) => Blame::Tree,
            Self::Recorder(why) => match why.blame() {
                recorder::error::Blame::Caller => Blame::Operator,
                recorder::error::Blame::Machine => Blame::System,
            },
            Self::Os(_)
            | Self::File(..)
            | Self::Thread(_)
            | Self::EventLoop(_)
            | Self::Signals(_)
            | Self::Subreaper(_)
            | Self::KillUser(_)
            | Self::Guardian(_)
            | Self::ServingProcess(_)
            | Self::Launch(_) => Blame::System,
            Self::GuardianGone | Self::DaemonGone | Self::CrashAtTheEnd | Self::Crashes(..) => {
                Blame::Trikd
            }
        }
    }

    /// A file or folder, and what the system says of it.
    pub fn file(path: &Path, error: io::Error) -> Self {
        Self::File(path.to_owned(), error.into())
    }

    /// A thread that cannot be started.
    pub fn thread(error: io::Error) -> Self {
        Self::Thread(error.into())
    }
}

impl fmt::Display for Error {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Os(os) => write!(out, "{os}"),
            Self::File(path, os) => write!(out, "{}: {os}", path.display()),
            Self::Directory(path, os, option) => {
                let path = path.display();
                write!(out, "{path}: {os}: name another directory with {option}")
            }
            Self::Recorder(why) => {
                write!(out, "the black box: {why}: name another folder with --box")
            }
            Self::Thread(os) => write!(out, "a thread cannot be started: {os}"),
            Self::EventLoop(os) => write!(out, "no event loop: {os}"),
            Self::Signals(os) => write!(out, "signals: {os}"),
            Self::Port(name, port, os) => port_text(out, name, *port, os),
            Self::Page(why) => out.write_str(why),
            Self::User(name, why) => user_text(out, name, why),
            Self::Subreaper(os) => write!(out, "no subreaper: {os}"),
            Self::KillUserAsRoot => {
                out.write_str("kill-user is for the user of programs, and never for root")
            }
            Self::KillUser(os) => write!(out, "kill-user: {os}"),
            Self::Guardian(os) => write!(out, "guardian: {os}"),
            Self::ServingProcess(os) => {
                write!(out, "the serving process cannot be started: {os}")
            }
            Self::GuardianGone => out.write_str("the process that started this one is gone"),
            Self::CrashAtTheEnd => out.write_str("the serving process crashed at its end"),
            Self::Crashes(count, seconds) => write!(
                out,
                "{count} crashes within {seconds} s: it is not started again"
            ),
            Self::Launch(os) => write!(out, "the program cannot be given its limits: {os}"),
            Self::DaemonGone => out.write_str("the daemon that started this program is gone"),
            Self::NoProgram => out.write_str("no program is named"),
            Self::Execute(program, os) => {
                let hint = match os.errno {
                    Some(libc::ENOEXEC) => ": it is made for another processor, or is no program",
                    Some(libc::ENOENT) => ": it is not there, or what its first line names is not",
                    Some(libc::EACCES) => ": it may not be executed by the user of programs",
                    Some(_) | None => "",
                };
                write!(out, "{program} cannot be started: {os}{hint}")
            }
            Self::NoCommand(name) => write!(out, "there is no command {name}"),
            Self::Rest(failure) => write!(out, "{failure}"),
            Self::Ask(why) => write!(out, "{why}"),
            Self::Display(why) => write!(out, "{why}"),
            Self::Program(failure) => write!(out, "{failure}"),
        }
    }
}

/// Which port, why, and what to do.
fn port_text(out: &mut fmt::Formatter<'_>, name: &str, port: u16, os: &Os) -> fmt::Result {
    write!(out, "port {port} ({name}) cannot be served: ")?;
    if os.kind == io::ErrorKind::AddrInUse {
        write!(
            out,
            "another program has it: end that program (`ss -ltnp 'sport = :{port}'` shows it), or take another port with --{name}-port"
        )
    } else if os.kind == io::ErrorKind::AddrNotAvailable {
        out.write_str("this machine does not have the address of --address")
    } else if os.kind == io::ErrorKind::PermissionDenied {
        write!(
            out,
            "ports below 1024 are for root: take another one with --{name}-port"
        )
    } else {
        write!(out, "{os}")
    }
}

fn user_text(out: &mut fmt::Formatter<'_>, name: &str, why: &BadUser) -> fmt::Result {
    match why {
        BadUser::Unknown(os) => write!(out, "--user {name}: {os}"),
        BadUser::Missing => write!(
            out,
            "--user {name}: there is no such user: `useradd --system {name}` makes one"
        ),
        BadUser::WithoutRoot => write!(
            out,
            "--user {name}: only root can start programs as another user"
        ),
        BadUser::Root => write!(
            out,
            "--user {name}: this is root: leave --user out to run programs as root"
        ),
        BadUser::Folder(path, os) => write!(out, "{}: {os}", path.display()),
    }
}

impl std::error::Error for Error {}

impl From<rest::Failure> for Error {
    fn from(failure: rest::Failure) -> Self {
        Self::Rest(failure)
    }
}

impl From<status::Unanswered> for Error {
    fn from(why: status::Unanswered) -> Self {
        Self::Ask(why)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_port_says_what_to_do() {
        let text = |kind: io::ErrorKind| {
            Error::Port("video", 80, io::Error::from(kind).into()).to_string()
        };
        let start = "port 80 (video) cannot be served: ";
        for (kind, part) in [
            (io::ErrorKind::AddrInUse, "--video-port"),
            (io::ErrorKind::AddrNotAvailable, "--address"),
            (io::ErrorKind::PermissionDenied, "for root"),
            (io::ErrorKind::OutOfMemory, "memory"),
        ] {
            let text = text(kind);
            assert!(text.starts_with(start) && text.contains(part), "{text}");
        }
    }

    #[test]
    fn a_program_that_cannot_be_started_has_a_hint() {
        let error = io::Error::from_raw_os_error(libc::ENOEXEC);
        let error = Error::Execute("a".to_owned(), error.into());
        assert!(error.to_string().contains("another processor"), "{error}");
        assert_eq!(error.blame(), Blame::Client);
    }
}
