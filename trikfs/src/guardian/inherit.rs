//! The daemon's side of the guardian: takes over what it inherits, and takes its place if it is dead.
//!
//! Also when the guardian is dead: then SIGTERM comes from the kernel, and the daemon itself brings the actuators to
//! rest and unmounts when it has ended. Owns the arguments that travel between the two; what to do at a signal is
//! the daemon's business, which finds SIGTERM, SIGINT and SIGHUP blocked.

use super::clean_up;
use super::ledger::Ledger;
use super::mounted::Mounted;
use super::precedence::Hurry;
use crate::failure::Failure;
use nix::sched::{CloneFlags, unshare};
use nix::sys::prctl::set_pdeathsig;
use nix::sys::signal::{SigSet, Signal};
use nix::unistd::{dup2_stdin, dup2_stdout, getppid};
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, Write};
use std::os::fd::{AsFd, AsRawFd, OwnedFd, RawFd};
use std::path::Path;
use std::sync::mpsc::{Sender, channel};

/// What the guardian tells the daemon on its command line, as options of `serve`.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::Args)]
pub struct Handover {
    /// Process id of the guardian.
    #[arg(long)]
    pub guardian: u32,
    /// Descriptor of the ledger.
    #[arg(long)]
    pub ledger: RawFd,
    /// Numbers of the mount and of its connection.
    #[arg(long, value_name = "ID:CONNECTION", value_parser = mount_numbers)]
    pub mount: (u32, u32),
    /// Take the configuration from the ledger: the daemon before this one crashed.
    #[arg(long)]
    pub again: bool,
}

impl Handover {
    /// The same as arguments.
    pub(super) fn to_arguments(self) -> Vec<OsString> {
        let (id, connection) = self.mount;
        let mut arguments = vec![
            format!("--guardian={}", self.guardian).into(),
            format!("--ledger={}", self.ledger).into(),
            format!("--mount={id}:{connection}").into(),
        ];
        if self.again {
            arguments.push("--again".into());
        }
        arguments
    }
}

fn mount_numbers(text: &str) -> Result<(u32, u32), &'static str> {
    text.split_once(':')
        .and_then(|(id, connection)| Some((id.parse().ok()?, connection.parse().ok()?)))
        .ok_or("not two numbers")
}

/// What the daemon has from the guardian.
pub struct Inheritance {
    /// The connection to the kernel.
    pub device: OwnedFd,
    /// Shared with the guardian.
    pub ledger: Ledger,
    /// Keep it to the end: when it closes, the guardian takes this process for dead.
    pub lifeline: Lifeline,
}

/// The writing end of the pipe that tells the guardian of our life.
///
/// A thread of its own has it, and that thread has a table of descriptors of its own. A process that is killed keeps its
/// descriptors until its last thread has ended, and one that hangs in the kernel, in a page that an unanswered request holds,
/// would do so for ever; this thread waits for nothing but words, so the pipe closes at once.
#[derive(Clone)]
pub struct Lifeline(Sender<(String, Sender<()>)>);

impl Lifeline {
    /// Gives the pipe to a thread. The caller has no other copy of it.
    fn keep(pipe: OwnedFd) -> io::Result<Self> {
        let number = pipe.as_raw_fd();
        let (words, to_say) = channel::<(String, Sender<()>)>();
        let (separated, is_separated) = channel();
        std::thread::Builder::new()
            .name("lifeline".to_owned())
            .spawn(move || {
                let _ = separated.send(separate(number).is_ok());
                // It has to run once more in order to end, and all that it does is wait.
                Hurry::for_good();
                let mut pipe = File::from(pipe);
                for (word, said) in to_say {
                    // If nobody listens, the guardian is dead and its signal is on the way.
                    let _ = pipe.write_all(word.as_bytes());
                    let _ = said.send(());
                }
            })?;
        // Where the kernel gives the thread no table of its own, the pipe is in the one that all share.
        if is_separated.recv() == Ok(true) {
            let _ = nix::unistd::close(number);
        }
        Ok(Self(words))
    }

    /// Tells the guardian that the filesystem with so many nodes is being served.
    pub fn ready(&self, nodes: usize) {
        self.say(format!("ready {nodes}\n"));
    }

    /// Tells the guardian that this process is about to end in order.
    pub fn over(&self) {
        self.say("over\n".to_owned());
    }

    /// Returns when it has been said: the process may end right then.
    fn say(&self, word: String) {
        let (said, is_said) = channel();
        if self.0.send((word, said)).is_ok() {
            let _ = is_said.recv();
        }
    }
}

/// Gives this thread a table of descriptors with this one alone.
fn separate(kept: RawFd) -> io::Result<()> {
    unshare(CloneFlags::CLONE_FILES)?;
    let open: Vec<RawFd> = std::fs::read_dir("/proc/thread-self/fd")?
        .flatten()
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok())
        .collect();
    for number in open.into_iter().filter(|number| *number != kept) {
        // One of them was that of the folder.
        let _ = nix::unistd::close(number);
    }
    Ok(())
}

impl Inheritance {
    /// Takes the descriptors over. From then on standard input is empty, and what native code prints goes to
    /// standard error. Blocks SIGTERM, SIGINT and SIGHUP in this thread, which must still be the only one.
    ///
    /// # Errors
    /// This process was not started by a guardian.
    pub fn take(handover: &Handover) -> Result<Self, Failure> {
        let fail = |error: io::Error| Failure::system("not started by a guardian", error);
        let mask: SigSet = [Signal::SIGTERM, Signal::SIGINT, Signal::SIGHUP]
            .into_iter()
            .collect();
        mask.thread_block().map_err(|error| fail(error.into()))?;
        // The guardian has it blocked; programs started from here need it as usual.
        let child: SigSet = [Signal::SIGCHLD].into_iter().collect();
        child.thread_unblock().map_err(|error| fail(error.into()))?;
        set_pdeathsig(Signal::SIGTERM).map_err(|error| fail(error.into()))?;
        // It may have died before the line above, and then no signal comes.
        if !is_parent(handover.guardian) {
            return Err(Failure::Orphaned);
        }
        let device = io::stdin().as_fd().try_clone_to_owned().map_err(fail)?;
        let lifeline = io::stdout().as_fd().try_clone_to_owned().map_err(fail)?;
        let ledger = Ledger::inherited(handover.ledger).map_err(fail)?;
        let empty = File::open("/dev/null").map_err(fail)?;
        dup2_stdin(empty).map_err(|error| fail(error.into()))?;
        dup2_stdout(io::stderr()).map_err(|error| fail(error.into()))?;
        // The ledger was opened anew; programs started from here need not inherit the guardian's number.
        let _ = nix::unistd::close(handover.ledger);
        Ok(Self {
            device,
            ledger,
            lifeline: Lifeline::keep(lifeline).map_err(fail)?,
        })
    }
}

/// What is left to do when the daemon has ended.
pub struct Farewell {
    guardian: u32,
    mounted: Mounted,
    device: OwnedFd,
    ledger: Ledger,
}

impl Farewell {
    /// Notes it down while the descriptors are there.
    ///
    /// # Errors
    /// A descriptor too many.
    pub fn prepare(
        inheritance: &Inheritance,
        mountpoint: &Path,
        handover: &Handover,
    ) -> io::Result<Self> {
        Ok(Self {
            guardian: handover.guardian,
            mounted: Mounted::inherited(mountpoint.to_owned(), handover.mount),
            device: inheritance.device.try_clone()?,
            ledger: inheritance.ledger.clone(),
        })
    }

    /// Leaves everything to the guardian. If that is dead, does what it would have done.
    pub fn say(self) {
        if !is_parent(self.guardian) {
            // Before the actuators rest, so that no program moves them again.
            self.mounted.abort();
            clean_up(&self.ledger, &self.mounted, self.device);
        }
    }
}

fn is_parent(guardian: u32) -> bool {
    u32::try_from(getppid().as_raw()) == Ok(guardian)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        handover: Handover,
    }

    #[test]
    fn the_arguments_say_what_was_handed_over() {
        for again in [false, true] {
            let handover = Handover {
                guardian: 12,
                ledger: 7,
                mount: (90, 45),
                again,
            };
            let line = std::iter::once("serve".into()).chain(handover.to_arguments());
            assert_eq!(
                Line::try_parse_from(line).expect("parses").handover,
                handover
            );
        }
        assert!(
            Line::try_parse_from(["serve", "--guardian=1", "--ledger=2", "--mount=3"]).is_err()
        );
    }

    #[test]
    fn a_process_of_somebody_else_takes_nothing_over() {
        let handover = Handover {
            guardian: u32::MAX,
            ledger: 0,
            mount: (0, 0),
            again: false,
        };
        let refusal = std::thread::spawn(move || Inheritance::take(&handover).err())
            .join()
            .expect("no panic");
        assert!(matches!(refusal, Some(Failure::Orphaned)), "{refusal:?}");
    }
}
