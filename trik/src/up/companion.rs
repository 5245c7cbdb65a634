//! A process beside the tree that stands on it: the view of ev3dev, or trikd; out of this same program, started again if
//! it is killed.
//!
//! Owns its start, its words and its end. Knows no device; `tree` is how such a process is started, `ev3dev` and `trikd`
//! say which ones there are.

use super::tree::Tree;
use crate::error::Error;
use crate::limits;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::ffi::OsString;
use std::os::fd::BorrowedFd;
use std::time::{Duration, Instant};

/// A process that is wanted.
pub(super) struct Companion {
    /// What a person calls it.
    name: &'static str,
    /// The name that it is started under.
    program: &'static str,
    /// What is in the line that it says when it can be used.
    ready: &'static str,
    arguments: Vec<OsString>,
    process: Option<Tree>,
    restarts: usize,
    ready_line: Option<String>,
}

impl Companion {
    /// It does not run yet.
    pub(super) fn new(
        name: &'static str,
        program: &'static str,
        ready: &'static str,
        arguments: Vec<OsString>,
    ) -> Self {
        Self {
            name,
            program,
            ready,
            arguments,
            process: None,
            restarts: 0,
            ready_line: None,
        }
    }

    /// Starts it and waits until it can be used.
    ///
    /// # Errors
    /// Why it does not run.
    pub(super) fn start(&mut self) -> Result<(), Error> {
        let name = self.name;
        let failed = |error: std::io::Error| Error::system(name, error);
        let mut process = Tree::start(self.program, &self.arguments).map_err(failed)?;
        let deadline = after(limits::START_MS);
        loop {
            let lines = process.said.hear();
            if let Some(line) = lines.into_iter().find(|line| line.contains(self.ready)) {
                self.ready_line = Some(line);
                self.process = Some(process);
                return Ok(());
            }
            let late = Instant::now() >= deadline;
            if late || process.said.is_over() {
                if late {
                    process.kill();
                }
                wait_for_end(&mut process);
                let reason = process.complaints.hear().join("\n");
                return Err(Error::Process(format!("{name} does not run: {reason}")));
            }
            wait(process.said.fd(), deadline);
        }
    }

    /// What it said last when it could be used, until somebody has taken it.
    pub(super) fn take_ready_line(&mut self) -> Option<String> {
        self.ready_line.take()
    }

    /// Whether it is there.
    pub(super) fn runs(&self) -> bool {
        self.process.is_some()
    }

    /// Readable when there is something to hear.
    pub(super) fn fds(&self) -> impl Iterator<Item = BorrowedFd<'_>> {
        let pipes = self
            .process
            .iter()
            .flat_map(|process| [process.said.fd(), process.complaints.fd()]);
        pipes.flatten()
    }

    /// What is to be told to the person. One that has ended is started again, a few times.
    pub(super) fn hear(&mut self) -> Vec<String> {
        let Some(process) = &mut self.process else {
            return Vec::new();
        };
        let mut lines = process.complaints.hear();
        let said = process.said.hear();
        let ready = said.into_iter().rfind(|line| line.contains(self.ready));
        if ready.is_some() {
            self.ready_line = ready;
        }
        if process.said.is_over() && process.complaints.is_over() {
            wait_for_end(process);
            self.process = None;
            self.restarts += 1;
            let name = self.name;
            lines.push(if self.restarts > limits::RESTARTS_MAX {
                format!("trik: {name} has ended too often; giving it up")
            } else {
                match self.start() {
                    Ok(()) => format!("trik: {name} has ended; started again"),
                    Err(reason) => format!("trik: {reason}"),
                }
            });
        }
        lines
    }

    /// Ends it. To be done before the tree goes, so that no file of that is open. It has [`limits::COMPANION_STOP_MS`],
    /// or until somebody has no patience, and then a moment after its end is forced.
    pub(super) fn stop(&mut self, mut hurries: impl FnMut() -> bool) {
        let Some(mut process) = self.process.take() else {
            return;
        };
        process.terminate();
        let mut deadline = after(limits::COMPANION_STOP_MS);
        let mut is_forced = false;
        while !process.said.is_over() {
            wait(process.said.fd(), deadline.min(after(limits::TURN_MS)));
            process.said.hear();
            // Who waits for room in this pipe would not end.
            process.complaints.hear();
            if hurries() || Instant::now() >= deadline {
                if is_forced {
                    break;
                }
                is_forced = true;
                process.kill();
                deadline = after(limits::ORPHAN_MS);
            }
        }
        // Killed if it is still there.
        drop(process);
    }
}

/// When so much time is over.
pub(super) fn after(ms: u32) -> Instant {
    Instant::now() + Duration::from_millis(ms.into())
}

/// Waits until there is something to hear, at most that long.
fn wait(fd: Option<BorrowedFd<'_>>, until: Instant) {
    let Some(fd) = fd else { return };
    let left = until.saturating_duration_since(Instant::now()) + Duration::from_millis(1);
    let patience = left.try_into().unwrap_or(PollTimeout::MAX);
    // A signal is looked at by the one who calls.
    let _ = poll(&mut [PollFd::new(fd, PollFlags::POLLIN)], patience);
}

/// It has said all that it had to say, so this is soon.
fn wait_for_end(process: &mut Tree) {
    let _ = process.wait();
}
