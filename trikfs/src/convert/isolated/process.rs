//! The process of an isolated converter as the daemon has it: its start, one question and its answer at a time, its end.
//!
//! Owns the child and the shared memory. What is asked and when another process is started is known to
//! `isolated`.
//!
//! A process dies with the thread that has started it: the kernel sends it SIGKILL then, also if it hangs in a converter. So
//! all are started by one thread, which lives as long as the daemon.

use super::memory::{Shared, Waited};
use crate::failure::Blame;
use crate::limits::{ISOLATED_BATCH_WAITS, ISOLATED_IDLE, ISOLATED_LOOK, ISOLATED_MESSAGE_BYTES};
use crate::process;
use nix::sys::signal::Signal;
use nix::sys::wait::waitpid;
use nix::unistd::Pid;
use std::fmt;
use std::fs::File;
use std::io;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::OnceLock;
use std::sync::mpsc::{Sender, channel};
use std::time::{Duration, Instant};

/// The hidden command of this program that is such a process.
pub const COMMAND: &str = "isolated";

/// Why an answer did not come. Shown, it goes after the converter's name.
#[derive(Debug)]
pub(super) enum Lost {
    /// There is no process.
    NotStarted(io::Error),
    /// There was one, to which that happened while nothing but our own code ran in it.
    NotBegun(Box<Self>),
    /// It does not load this library again, for this reason.
    NotLoaded(String, String),
    /// A signal has ended it.
    Killed(i32),
    /// It has ended itself.
    Exited(i32),
    /// Somebody has stopped it.
    Stopped,
    /// It computes for so long at one tuple.
    Late(Duration),
    /// It goes on, but a batch took so long.
    Slow(Duration),
    /// It does not let its rights be taken.
    Resists,
    /// The kernel does not hold it to its list of system calls, as it held another one before.
    Unconfined,
    /// There is none: it was ended a moment before.
    Absent,
    /// It has said what no process of ours says.
    Rubbish,
}

impl Lost {
    /// The person or the part that can mend it.
    pub(super) fn blame(&self) -> Blame {
        match self {
            Self::NotStarted(_) | Self::NotBegun(_) | Self::Unconfined => Blame::Machine,
            // Its own code can do that as well as somebody else.
            Self::Stopped
            | Self::NotLoaded(..)
            | Self::Killed(_)
            | Self::Exited(_)
            | Self::Late(_)
            | Self::Slow(_)
            | Self::Resists
            | Self::Absent
            | Self::Rubbish => Blame::Converter,
        }
    }
}

impl fmt::Display for Lost {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotStarted(error) => write!(f, "its process cannot be started: {error}"),
            Self::NotBegun(lost) => write!(f, "before anything was loaded, {lost}"),
            Self::NotLoaded(library, why) => write!(
                f,
                "another process does not load {library}: {why}; write the configuration again"
            ),
            Self::Killed(signal) => match Signal::try_from(*signal) {
                Ok(signal) => write!(f, "its process was ended by {signal}"),
                Err(_) => write!(f, "its process was ended by signal {signal}"),
            },
            Self::Exited(status) => write!(f, "its process ended itself with status {status}"),
            Self::Stopped => f.write_str("its process was stopped by a signal (SIGSTOP)"),
            Self::Late(patience) => write!(
                f,
                "gave no answer in {} ms: its process was ended",
                patience.as_millis()
            ),
            Self::Slow(time) => write!(
                f,
                "its tuples took longer than {} ms together: its process was ended",
                time.as_millis()
            ),
            Self::Resists => {
                f.write_str("its process does not let the right to open files be taken from it")
            }
            Self::Unconfined => {
                f.write_str("the system puts no filter of system calls in force for its process")
            }
            Self::Absent => f.write_str("its process has just ended"),
            Self::Rubbish => f.write_str("its process answered what is no answer"),
        }
    }
}

/// A process that runs. Dropping it ends it.
#[derive(Debug)]
pub(super) struct Running {
    child: Child,
    pub(super) shared: Shared,
    pub(super) since: Instant,
    /// When it answered last.
    answered: Instant,
}

impl Running {
    /// Starts this program again as such a process.
    pub(super) fn start() -> io::Result<Self> {
        let (shared, file) = Shared::new()?;
        Ok(Self {
            child: spawn(file)?,
            shared,
            since: Instant::now(),
            answered: Instant::now(),
        })
    }

    /// Sends a message and waits for the answer, which is copied to `room`. During a batch a process that goes on is given more
    /// time.
    pub(super) fn ask<'a>(
        &mut self,
        message: &[u8],
        room: &'a mut [u8],
        patience: Duration,
        is_batch: bool,
    ) -> Result<&'a [u8], Lost> {
        if !self.shared.ask(message) {
            return Err(Lost::Rubbish);
        }
        match self.shared.wait(ISOLATED_LOOK) {
            Waited::Answered => {}
            Waited::NotYet => self.await_answer(patience, is_batch)?,
            Waited::Rubbish => return Err(Lost::Rubbish),
        }
        self.answered = Instant::now();
        self.shared.answer(room).ok_or(Lost::Rubbish)
    }

    /// Whether somebody has ended it while nobody asked it anything. Not looked at if it has just answered.
    pub(super) fn is_gone(&mut self) -> bool {
        self.answered.elapsed() > ISOLATED_IDLE && matches!(self.child.try_wait(), Ok(Some(_)))
    }

    /// Whether the kernel holds it to two filters more than this process, as it should be once all is loaded. A kernel that does
    /// not count them (before Linux 5.9) is believed.
    pub(super) fn has_our_filters(&self) -> bool {
        let filters = |process: &str| -> Option<u32> {
            let status = std::fs::read_to_string(format!("/proc/{process}/status")).ok()?;
            let count = status
                .lines()
                .find_map(|line| line.strip_prefix("Seccomp_filters:"));
            count?.trim().parse().ok()
        };
        match (filters(&self.child.id().to_string()), filters("self")) {
            (Some(there), Some(here)) => there == here + 2,
            (None, _) | (_, None) => true,
        }
    }

    /// The death of a process wakes nobody, so it is looked at from time to time.
    fn await_answer(&mut self, patience: Duration, is_batch: bool) -> Result<(), Lost> {
        let mut until = Instant::now() + patience;
        let mut before = Some((0, 0));
        let mut waits = 1;
        loop {
            if let Ok(Some(status)) = self.child.try_wait() {
                return Err(death(status));
            }
            match self.shared.wait(ISOLATED_LOOK) {
                Waited::Answered => return Ok(()),
                Waited::Rubbish => return Err(Lost::Rubbish),
                Waited::NotYet => {}
            }
            if Instant::now() < until {
                continue;
            }
            if process::is_stopped(self.child.id()) {
                return Err(Lost::Stopped);
            }
            let now = Some(self.shared.progress());
            if !is_batch || now == before {
                return Err(Lost::Late(patience));
            }
            if waits == ISOLATED_BATCH_WAITS {
                return Err(Lost::Slow(patience * waits));
            }
            before = now;
            waits += 1;
            until += patience;
        }
    }
}

impl Drop for Running {
    fn drop(&mut self) {
        let _ = self.child.kill();
        // One that waits for a file of our own tree ends when that is answered, perhaps by the thread that is here: so somebody
        // else waits for it.
        if let Ok(None) = self.child.try_wait() {
            reap(self.child.id());
        }
    }
}

/// Has the end of a process waited for by a thread that does nothing else.
fn reap(process: u32) {
    static REAPER: OnceLock<Option<Sender<u32>>> = OnceLock::new();
    let reaper = REAPER.get_or_init(|| {
        let (ended, to_wait) = channel::<u32>();
        let thread = std::thread::Builder::new().name("isolated-end".to_owned());
        let wait = move || {
            for process in to_wait {
                if let Ok(process) = i32::try_from(process) {
                    let _ = waitpid(Pid::from_raw(process), None);
                }
            }
        };
        thread.spawn(wait).ok().map(|_| ended)
    });
    // Without a thread its number stays taken, and nothing worse.
    if let Some(reaper) = reaper {
        let _ = reaper.send(process);
    }
}

fn death(status: ExitStatus) -> Lost {
    match (status.signal(), status.code()) {
        (Some(signal), _) => Lost::Killed(signal),
        (None, code) => Lost::Exited(code.unwrap_or(0)),
    }
}

type Start = (File, Sender<io::Result<Child>>);

/// Has a process started by the thread that does nothing else.
fn spawn(memory: File) -> io::Result<Child> {
    static STARTER: OnceLock<Sender<Start>> = OnceLock::new();
    let starter = match STARTER.get() {
        Some(starter) => starter,
        None => {
            let new = starter()?;
            // If two were begun at once, the other one ends with its channel before it has started anything.
            STARTER.get_or_init(|| new)
        }
    };
    let (started, is_started) = channel();
    let gone = || io::Error::other("the thread that starts them has ended");
    let sent = starter.send((memory, started));
    sent.map_err(|_| gone())?;
    is_started.recv().map_err(|_| gone())?
}

fn starter() -> io::Result<Sender<Start>> {
    let (starts, to_start) = channel::<Start>();
    std::thread::Builder::new()
        .name("isolated".to_owned())
        .spawn(move || {
            for (memory, started) in to_start {
                // Through this link it is the same program even if its file has been replaced since.
                let mut command = Command::new("/proc/self/exe");
                command
                    .arg0("trikfs")
                    .args([COMMAND, &std::process::id().to_string()])
                    .stdin(memory)
                    .stdout(Stdio::null())
                    .stderr(Stdio::null())
                    .env_remove("NOTIFY_SOCKET")
                    // What a terminal sends to this program ends the process by way of this program.
                    .process_group(0);
                let _ = started.send(command.spawn());
            }
        })?;
    Ok(starts)
}

/// Room for any message.
pub(super) fn room() -> Vec<u8> {
    vec![0; ISOLATED_MESSAGE_BYTES]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_happens_to_a_process_before_a_converter_is_in_it_is_the_systems_fault() {
        let killed = || Lost::Killed(9);
        assert_eq!(killed().blame(), Blame::Converter);
        let before = Lost::NotBegun(Box::new(killed()));
        assert_eq!(before.blame(), Blame::Machine);
        assert_eq!(
            before.to_string(),
            "before anything was loaded, its process was ended by SIGKILL"
        );
        let refused = Lost::NotStarted(io::Error::from_raw_os_error(libc::EAGAIN));
        assert_eq!(refused.blame(), Blame::Machine);
    }
}
