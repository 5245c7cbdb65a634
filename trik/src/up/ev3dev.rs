//! The view of ev3dev beside the tree: a child process out of this same program, started again if it is killed.
//!
//! Owns its start, its words and its end. Knows no device; `tree` is how such a process is started.

use super::after;
use super::tree::Tree;
use crate::limits;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::ffi::OsString;
use std::os::fd::BorrowedFd;
use std::path::{Path, PathBuf};
use std::time::Instant;

/// A view that is wanted.
pub(super) struct Ev3dev {
    /// Where it is.
    pub(super) mountpoint: PathBuf,
    arguments: [OsString; 3],
    process: Option<Tree>,
    restarts: usize,
}

impl Ev3dev {
    /// A view of this tree. It does not run yet.
    pub(super) fn new(tree: &Path, mountpoint: PathBuf) -> Self {
        // In one word, so that a path that begins with a dash stays a value.
        let mut place = OsString::from("--tree=");
        place.push(tree);
        Self {
            arguments: [place, "--".into(), mountpoint.clone().into()],
            mountpoint,
            process: None,
            restarts: 0,
        }
    }

    /// Starts it and waits until it can be used.
    ///
    /// # Errors
    /// Why it does not run.
    pub(super) fn start(&mut self) -> Result<(), String> {
        let failed = |error: std::io::Error| format!("the view of ev3dev: {error}");
        let mut process = Tree::start("trikfs-ev3dev", &self.arguments).map_err(failed)?;
        let deadline = after(limits::START_MS);
        loop {
            let lines = process.said.hear();
            if lines.iter().any(|line| line.contains(": ready on ")) {
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
                return Err(format!("the view of ev3dev does not run: {reason}"));
            }
            wait(process.said.fd(), deadline);
        }
    }

    /// Readable when there is something to hear.
    pub(super) fn fds(&self) -> impl Iterator<Item = BorrowedFd<'_>> {
        let pipes = self
            .process
            .iter()
            .flat_map(|process| [process.said.fd(), process.complaints.fd()]);
        pipes.flatten()
    }

    /// What is to be told to the person. A view that has ended is started again, a few times.
    pub(super) fn hear(&mut self) -> Vec<String> {
        let Some(process) = &mut self.process else {
            return Vec::new();
        };
        let mut lines = process.complaints.hear();
        process.said.hear();
        if process.said.is_over() && process.complaints.is_over() {
            wait_for_end(process);
            self.process = None;
            self.restarts += 1;
            lines.push(if self.restarts > limits::RESTARTS_MAX {
                "trik: the view of ev3dev has ended too often; giving it up".to_owned()
            } else {
                match self.start() {
                    Ok(()) => "trik: the view of ev3dev has ended; started again".to_owned(),
                    Err(reason) => format!("trik: {reason}"),
                }
            });
        }
        lines
    }

    /// Ends it. To be done before the tree goes, so that no file of that is open.
    pub(super) fn stop(&mut self) {
        let Some(mut process) = self.process.take() else {
            return;
        };
        process.terminate();
        let deadline = after(limits::STOP_MS);
        while !process.said.is_over() {
            wait(process.said.fd(), deadline);
            process.said.hear();
            if Instant::now() >= deadline {
                process.kill();
            }
        }
        wait_for_end(&mut process);
    }
}

/// Waits until there is something to hear, at most that long.
fn wait(fd: Option<BorrowedFd<'_>>, until: Instant) {
    let Some(fd) = fd else { return };
    let left =
        until.saturating_duration_since(Instant::now()) + std::time::Duration::from_millis(1);
    let patience = left.try_into().unwrap_or(PollTimeout::MAX);
    // A signal is looked at by the one who calls.
    let _ = poll(&mut [PollFd::new(fd, PollFlags::POLLIN)], patience);
}

/// It has said all that it had to say, so this is soon.
fn wait_for_end(process: &mut Tree) {
    let _ = process.wait();
}
