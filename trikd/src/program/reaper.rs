//! Tells of the ends of all child processes, also of those that were born elsewhere and lost their parents.
//!
//! Owns waitpid(2) in this process: nothing else may wait for children.

use nix::sys::wait::{WaitPidFlag, WaitStatus, waitpid};
use nix::unistd::Pid;
use std::cell::RefCell;
use std::collections::HashMap;
use std::io;
use tokio::signal::unix::{SignalKind, signal};
use tokio::sync::oneshot;

/// How a process ended.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Ended {
    /// By itself, with this code.
    Code(i32),
    /// By this signal.
    Signal(i32),
}

/// Who waits for whom.
#[derive(Debug, Default)]
pub struct Reaper {
    waiting: RefCell<HashMap<i32, oneshot::Sender<Ended>>>,
}

impl Reaper {
    /// The end of a child. Ask in the same turn in which it was started, so that it cannot have been told yet.
    pub fn watch(&self, pid: Pid) -> oneshot::Receiver<Ended> {
        let (tell, told) = oneshot::channel();
        self.waiting.borrow_mut().insert(pid.as_raw(), tell);
        told
    }

    /// Takes all ends that have not been taken.
    pub fn reap(&self) {
        loop {
            let (pid, ended) = match waitpid(None, Some(WaitPidFlag::WNOHANG)) {
                Ok(WaitStatus::Exited(pid, code)) => (pid, Ended::Code(code)),
                Ok(WaitStatus::Signaled(pid, signal, _)) => (pid, Ended::Signal(signal as i32)),
                Ok(WaitStatus::StillAlive) | Err(_) => return,
                Ok(_) => continue,
            };
            if let Some(tell) = self.waiting.borrow_mut().remove(&pid.as_raw()) {
                // The caller may have lost interest.
                let _ = tell.send(ended);
            }
        }
    }

    /// Reaps for ever.
    ///
    /// # Errors
    /// The signal cannot be received.
    pub async fn run(&self) -> io::Result<()> {
        let mut ends = signal(SignalKind::child())?;
        loop {
            self.reap();
            ends.recv().await;
        }
    }
}
