//! The daemon as a child process: its start, the line that tells of its life, its end.
//!
//! What it inherits travels without any unsafe claim to a descriptor's number: the connection to the kernel as
//! standard input, the lifeline as standard output, the ledger as a number that is opened again through /proc. Owns the
//! process and what it says; what its end means, `watch` judges.

use super::inherit::Handover;
use super::ledger::Ledger;
use super::mounted::Mounted;
use super::precedence::hurry_the_end_of;
use crate::limits::{CUT_OFF_PATIENCE, LIFE_LINE_BYTES_MAX, REAP_PATIENCE, REAP_PAUSE};
use nix::sys::signal::{Signal, kill};
use nix::sys::wait::{Id, WaitPidFlag, WaitStatus, waitid};
use nix::unistd::Pid;
use std::ffi::OsString;
use std::io::{self, PipeReader, Read};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::process::CommandExt;
use std::process::{self, Command, ExitStatus};
use std::time::Instant;

/// A running daemon. Dropping it kills it.
pub(super) struct Child {
    process: process::Child,
    /// Its writing end is open in the daemon alone, for as long as it lives.
    lifeline: PipeReader,
    heard: Vec<u8>,
}

/// What came over the lifeline.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Heard {
    /// It serves so many nodes.
    Ready(usize),
    /// It ends in order: its exit status is its own word.
    Over,
    /// Nothing yet.
    Nothing,
    /// It is dead.
    End,
}

impl Child {
    /// Starts this program again as the daemon. `again` tells it to take the configuration from the ledger.
    pub(super) fn start(
        device: &OwnedFd,
        ledger: &Ledger,
        mounted: &Mounted,
        arguments: &[OsString],
        again: bool,
    ) -> io::Result<Self> {
        let handover = Handover {
            guardian: process::id(),
            ledger: ledger.number(),
            mount: mounted.numbers(),
            again,
        };
        // Through this link it is the same program even if its file has been replaced since.
        let mut command = Command::new("/proc/self/exe");
        command
            .arg0("trikfs")
            .arg("serve")
            .args(handover.to_arguments())
            .args(arguments)
            .arg("--")
            .arg(mounted.path())
            .stdin(device.try_clone()?)
            // The service manager is told by the guardian.
            .env_remove("NOTIFY_SOCKET");
        Self::spawn(command)
    }

    fn spawn(mut command: Command) -> io::Result<Self> {
        let (lifeline, writer) = io::pipe()?;
        let process = command.stdout(writer).spawn()?;
        // The command holds our copy of the writing end, which would keep the line open.
        drop(command);
        Ok(Self {
            process,
            lifeline,
            heard: Vec::new(),
        })
    }

    /// Readable when [`Child::hear`] has something to say.
    pub(super) fn lifeline(&self) -> BorrowedFd<'_> {
        self.lifeline.as_fd()
    }

    /// What the daemon says, a line at a time. Call it when the lifeline is readable, which it stays after the end.
    pub(super) fn hear(&mut self) -> io::Result<Heard> {
        if let Some(word) = self.next_word() {
            return Ok(word);
        }
        let mut piece = [0; LIFE_LINE_BYTES_MAX];
        let size = match self.lifeline.read(&mut piece) {
            Err(error) if error.kind() == io::ErrorKind::Interrupted => return Ok(Heard::Nothing),
            result => result?,
        };
        if size == 0 {
            return Ok(Heard::End);
        }
        self.heard.extend_from_slice(&piece[..size]);
        let word = self.next_word();
        if self.heard.len() > LIFE_LINE_BYTES_MAX {
            self.heard.clear();
        }
        Ok(word.unwrap_or(Heard::Nothing))
    }

    /// The next line that has been read and means something.
    fn next_word(&mut self) -> Option<Heard> {
        while let Some(end) = self.heard.iter().position(|byte| *byte == b'\n') {
            let line: Vec<u8> = self.heard.drain(..=end).collect();
            let line = std::str::from_utf8(&line).unwrap_or("").trim_end();
            if line == "over" {
                return Some(Heard::Over);
            }
            let nodes = line.strip_prefix("ready ").map(str::parse);
            if let Some(Ok(nodes)) = nodes {
                return Some(Heard::Ready(nodes));
            }
        }
        None
    }

    /// Asks it to end.
    pub(super) fn terminate(&self) {
        self.signal(Signal::SIGTERM);
    }

    /// Ends it.
    pub(super) fn kill(&self) {
        self.signal(Signal::SIGKILL);
    }

    /// Whether somebody has stopped it (SIGSTOP, SIGTSTP) and it has not been continued since.
    pub(super) fn is_stopped(&self) -> bool {
        let Ok(pid) = i32::try_from(self.process.id()) else {
            return false;
        };
        // Looks only: the stop stays to be seen, and an end is left to `wait`.
        let flags = WaitPidFlag::WSTOPPED | WaitPidFlag::WNOHANG | WaitPidFlag::WNOWAIT;
        let seen = waitid(Id::Pid(Pid::from_raw(pid)), flags);
        matches!(seen, Ok(WaitStatus::Stopped(..)))
    }

    /// Its threads come first, which have nothing to do but to end.
    pub(super) fn hurry(&self) {
        hurry_the_end_of(self.process.id());
    }

    /// Whether it has ended wholly, with all its threads.
    pub(super) fn is_gone(&mut self) -> bool {
        matches!(self.process.try_wait(), Ok(Some(_)))
    }

    fn signal(&self, signal: Signal) {
        // The number is its own until `wait`: a dead child keeps it.
        if let Ok(pid) = i32::try_from(self.process.id()) {
            let _ = kill(Pid::from_raw(pid), signal);
        }
    }

    /// How it ended; call it after [`Heard::End`]. A thread of it that hangs in a page of our own tree ends when the connection
    /// is cut off, which is done if the process is not gone soon. None: it hangs even then.
    pub(super) fn wait(&mut self, cut_off: &dyn Fn()) -> io::Result<Option<ExitStatus>> {
        for (patience, then) in [(REAP_PATIENCE, Some(cut_off)), (CUT_OFF_PATIENCE, None)] {
            let until = Instant::now() + patience;
            loop {
                if let Some(status) = self.process.try_wait()? {
                    return Ok(Some(status));
                }
                if Instant::now() > until {
                    break;
                }
                std::thread::sleep(REAP_PAUSE);
            }
            if let Some(cut_off) = then {
                cut_off();
            }
        }
        Ok(None)
    }
}

impl Drop for Child {
    fn drop(&mut self) {
        // `try_wait` has no process left to ask about, and kills nothing, after `wait`.
        if let Ok(None) = self.process.try_wait() {
            self.kill();
        }
    }
}

#[cfg(test)]
impl Child {
    /// A shell in the daemon's place; its standard output is the lifeline.
    pub(super) fn shell(script: &str) -> Self {
        let mut command = Command::new("/bin/sh");
        command.args(["-c", script]).stdin(process::Stdio::null());
        Self::spawn(command).expect("a shell")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(child: &mut Child) -> Vec<Heard> {
        let mut heard = Vec::new();
        loop {
            match child.hear().expect("readable") {
                Heard::End => return heard,
                Heard::Nothing => {}
                word @ (Heard::Ready(_) | Heard::Over) => heard.push(word),
            }
        }
    }

    #[test]
    fn the_line_tells_of_readiness_and_of_the_end() {
        let mut child = Child::shell("printf 'rea'; printf 'dy 6\\n'; exit 3");
        assert_eq!(all(&mut child), [Heard::Ready(6)]);
        let status = child.wait(&|| panic!("it ends by itself"));
        assert_eq!(
            status.expect("ended").and_then(|status| status.code()),
            Some(3)
        );
    }

    #[test]
    fn one_that_is_dead_but_does_not_end_is_cut_off_and_then_given_up() {
        // It closes the line and goes on, as a process does of which one thread hangs.
        let cuts = std::cell::Cell::new(0);
        let mut child = Child::shell("exec >&-; exec sleep 1000");
        assert_eq!(all(&mut child), []);
        let given_up = child.wait(&|| cuts.set(cuts.get() + 1)).expect("no error");
        assert_eq!((given_up, cuts.get()), (None, 1));
        let mut other = Child::shell("exec >&-; exec sleep 1000");
        let pid = other.process.id();
        assert_eq!(all(&mut other), []);
        let status = other.wait(&|| {
            let pid = Pid::from_raw(i32::try_from(pid).expect("a number"));
            kill(pid, Signal::SIGKILL).expect("killed");
        });
        assert!(status.expect("no error").is_some());
    }

    #[test]
    fn nonsense_on_the_line_is_dropped() {
        let mut child = Child::shell(
            "head -c 100000 /dev/zero; echo; echo ready -1; echo ready x; echo ready 2",
        );
        assert_eq!(all(&mut child), [Heard::Ready(2)]);
        assert!(child.heard.capacity() < 1000);
    }

    #[test]
    fn a_dropped_child_is_killed() {
        let child = Child::shell("exec sleep 1000");
        let mut lifeline = child.lifeline.try_clone().expect("cloned");
        drop(child);
        assert_eq!(lifeline.read(&mut [0; 8]).expect("the end"), 0);
    }
}
