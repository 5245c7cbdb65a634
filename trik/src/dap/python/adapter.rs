//! The adapter of debugpy as a process: requests to it, and what it says.
//!
//! Owns the process and its end. Knows no request.

use super::super::client::Refused;
use crate::limits;
use crate::wire::{self, Frame, Frames};
use serde_json::Value;
use std::io::BufReader;
use std::process::{Child, ChildStdin, Command, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::Duration;

/// What comes next.
pub(super) enum AdapterSays {
    Message(Value),
    Nothing,
    End,
}

/// debugpy on this computer.
pub(super) struct Adapter {
    process: Child,
    to: ChildStdin,
    from: Receiver<Value>,
}

/// Modules of the current directory are not found by it: a file json.py beside a program would run on this computer. Pythons
/// before 3.11 do not know the variable.
const SAFE: (&str, &str) = ("PYTHONSAFEPATH", "1");

/// Whether this Python has debugpy, and what to type if it has not.
fn must_have(python: &str) -> Result<(), Refused> {
    let asked = Command::new(python)
        .args(["-c", "import debugpy"])
        .env(SAFE.0, SAFE.1)
        .stdin(Stdio::null())
        .output();
    match asked {
        Ok(answer) if answer.status.success() => Ok(()),
        Ok(_) => Err(Refused::new(format!(
            "debugpy is needed to debug Python, and {python} on this computer has none: type\n    {python} -m pip install debugpy\nor say with \"python\" which Python has it"
        ))),
        Err(why) => Err(Refused::new(format!(
            "{python} cannot be started: {why}; say with \"python\" which Python of this computer has debugpy"
        ))),
    }
}

impl Adapter {
    /// Starts it with this Python.
    ///
    /// # Errors
    /// There is none, and what to do.
    pub fn start(python: &str) -> Result<Self, Refused> {
        must_have(python)?;
        let no = |why: std::io::Error| Refused::new(format!("debugpy cannot be started: {why}"));
        let mut process = Command::new(python)
            .args(["-m", "debugpy.adapter"])
            .env(SAFE.0, SAFE.1)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .stderr(Stdio::null())
            .spawn()
            .map_err(no)?;
        let (Some(to), Some(from)) = (process.stdin.take(), process.stdout.take()) else {
            return Err(Refused::new("debugpy has no streams"));
        };
        let (sender, receiver) = sync_channel(limits::DAP_WAITING);
        std::thread::spawn(move || {
            let mut frames = Frames::of(BufReader::new(from));
            while let Ok(Some(frame)) = frames.next() {
                // It is a program like ours: what is no message is none for anybody.
                if let Frame::Body(body) = frame
                    && let Ok(message) = serde_json::from_slice(&body)
                    && sender.send(message).is_err()
                {
                    return;
                }
            }
        });
        Ok(Self {
            process,
            to,
            from: receiver,
        })
    }

    /// Gives it a message; one that is gone is heard of by its end.
    pub fn send(&mut self, message: &Value) {
        let _ = wire::write(&mut self.to, message);
    }

    /// What it says next, waiting at most so long.
    pub fn next(&self, wait: Duration) -> AdapterSays {
        match self.from.recv_timeout(wait) {
            Ok(message) => AdapterSays::Message(message),
            Err(RecvTimeoutError::Timeout) => AdapterSays::Nothing,
            Err(RecvTimeoutError::Disconnected) => AdapterSays::End,
        }
    }
}

impl Drop for Adapter {
    fn drop(&mut self) {
        let _ = self.process.kill();
        let _ = self.process.wait();
    }
}
