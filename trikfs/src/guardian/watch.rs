//! Waits for whatever comes first: a signal, the end of the mount, a word from the daemon, its end.
//!
//! Owns what is listened to, the patience with a daemon that is to end, and the judgement of its end. One poll(2) for all
//! of them; nothing here is asked periodically. Knows no actuator and no mount point.

use super::child::{Child, Heard};
use crate::limits;
use nix::errno::Errno;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::signal::{SigSet, Signal};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use std::fs::File;
use std::io;
use std::os::fd::AsFd;
use std::os::unix::process::ExitStatusExt;
use std::process::ExitStatus;
use std::time::{Duration, Instant};

/// Exit status of a Rust program whose main thread panicked.
const PANICKED: i32 = 101;

/// How one life of the daemon ended.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum End {
    /// It was asked to by a signal, or the mount is gone.
    Stopped,
    /// It refused to run and said why.
    Failed,
    /// It did not mean to; how, in words that follow "the daemon was".
    Crashed(String),
}

/// What is done for a daemon that was killed and whose threads have not all ended, which takes a moment on a busy machine.
pub(super) struct LastMoment<'a> {
    /// Brings the actuators to rest. It is done once more after the last thread has ended, which may be inside a device.
    pub(super) rest: &'a dyn Fn(),
    /// Ends the connection, in which a thread hangs.
    pub(super) cut_off: &'a dyn Fn(),
}

/// What the guardian listens to for as long as it lives.
pub(super) struct Watch {
    signals: SignalFd,
    /// Has an exceptional condition when the list of mounts changes.
    mounts: File,
}

impl Watch {
    /// Blocks the signals that end a program in this thread, and listens to them from here on.
    pub(super) fn new() -> io::Result<Self> {
        // SIGCHLD comes also when the daemon is stopped. A terminal stops what runs in it (Ctrl-Z), and motors would go on:
        // not this process, nor the daemon, which inherits that.
        let mask: SigSet = [
            Signal::SIGTERM,
            Signal::SIGINT,
            Signal::SIGHUP,
            Signal::SIGCHLD,
            Signal::SIGTSTP,
        ]
        .into_iter()
        .collect();
        mask.thread_block()?;
        Ok(Self {
            signals: SignalFd::with_flags(&mask, SfdFlags::SFD_NONBLOCK | SfdFlags::SFD_CLOEXEC)?,
            mounts: File::open("/proc/self/mountinfo")?,
        })
    }

    /// Waits for the daemon's end. Brings it about when a signal comes or the mount goes: first by asking, after two
    /// seconds by force. A daemon that somebody stops (SIGSTOP) and does not soon continue is killed: it would leave
    /// actuators driven and requests unanswered. `ready` is called when the daemon says that it serves.
    pub(super) fn until_end(
        &self,
        child: &mut Child,
        mounted: &dyn Fn() -> bool,
        last_moment: &LastMoment<'_>,
        ready: &mut dyn FnMut(usize),
    ) -> io::Result<End> {
        let grace = Duration::from_millis(limits::GRACE_MS.into());
        let mut urgency = Urgency::None;
        let mut life = Life::Starting;
        let mut standstill = Standstill::default();
        loop {
            let deadline = urgency.deadline().into_iter().chain(standstill.until);
            let [signal, mounts, word] = self.wait(child, deadline.min())?;
            let mut stop = signal && self.asks_to_end()?;
            stop |= mounts && !mounted();
            standstill.update(child, Instant::now());
            if word {
                match child.hear()? {
                    Heard::Ready(nodes) => {
                        life = Life::Serving;
                        ready(nodes);
                    }
                    Heard::Over => life = Life::Over,
                    Heard::Nothing => {}
                    // A signal from a terminal reaches the daemon as well, and it may be the first to end.
                    Heard::End => {
                        let asked = stop || urgency != Urgency::None;
                        if life != Life::Over && !child.is_gone() {
                            (last_moment.rest)();
                            child.hurry();
                        }
                        let Some(status) = child.wait(last_moment.cut_off)? else {
                            return Ok(hanging(asked));
                        };
                        if standstill.was_killed && !asked {
                            return Ok(End::Crashed("stopped and did not go on".to_owned()));
                        }
                        return Ok(judge(status, asked, life));
                    }
                }
            }
            let now = Instant::now();
            match urgency {
                Urgency::None if stop => {
                    child.terminate();
                    urgency = Urgency::Asked(now + grace);
                }
                Urgency::Asked(deadline) if now >= deadline => {
                    child.kill();
                    urgency = Urgency::Forced(now + grace);
                }
                // It hangs in the kernel. What is left to do must not wait for it.
                Urgency::Forced(deadline) if now >= deadline => return Ok(End::Stopped),
                Urgency::None | Urgency::Asked(_) | Urgency::Forced(_) => {}
            }
        }
    }

    /// Takes the signals that came; whether one of them asks for the end.
    fn asks_to_end(&self) -> io::Result<bool> {
        let mut asks = false;
        while let Some(info) = self.signals.read_signal()? {
            match i32::try_from(info.ssi_signo).map(Signal::try_from) {
                Ok(Ok(Signal::SIGCHLD)) => {}
                Ok(Ok(Signal::SIGTSTP)) => super::complain(
                    "what guards motors is not stopped by Ctrl-Z: end it with Ctrl-C",
                ),
                Ok(_) | Err(_) => asks = true,
            }
        }
        Ok(asks)
    }

    /// Which of signals, mounts and lifeline have something to say.
    fn wait(&self, child: &Child, deadline: Option<Instant>) -> io::Result<[bool; 3]> {
        let timeout = match deadline {
            None => PollTimeout::NONE,
            // One more, so that the deadline has passed when the time is up.
            Some(at) => (at.saturating_duration_since(Instant::now()) + Duration::from_millis(1))
                .try_into()
                .unwrap_or(PollTimeout::MAX),
        };
        let mut watched = [
            PollFd::new(self.signals.as_fd(), PollFlags::POLLIN),
            PollFd::new(self.mounts.as_fd(), PollFlags::POLLPRI),
            PollFd::new(child.lifeline(), PollFlags::POLLIN),
        ];
        match poll(&mut watched, timeout) {
            Err(Errno::EINTR) => Ok([false; 3]),
            // Without memory the kernel cannot even wait. A guardian that gave up now would take the tree with it.
            Err(Errno::ENOMEM | Errno::EAGAIN) => {
                std::thread::sleep(limits::KERNEL_PAUSE_MAX);
                Ok([false; 3])
            }
            Err(error) => Err(error.into()),
            Ok(_) => Ok(watched.map(|fd| fd.any().unwrap_or(true))),
        }
    }
}

/// How much has been done to end the daemon, and when the next step is due.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Urgency {
    None,
    Asked(Instant),
    Forced(Instant),
}

impl Urgency {
    fn deadline(self) -> Option<Instant> {
        match self {
            Self::None => None,
            Self::Asked(at) | Self::Forced(at) => Some(at),
        }
    }
}

/// A daemon that is stopped, as the kernel says: one that has much to do, or waits for a device, is not.
#[derive(Default)]
struct Standstill {
    /// When it has to go on.
    until: Option<Instant>,
    was_killed: bool,
}

impl Standstill {
    /// Begins or ends with what the kernel says now; a stop that lasted is ended by force.
    fn update(&mut self, child: &Child, now: Instant) {
        if !child.is_stopped() {
            self.until = None;
            return;
        }
        let patience = Duration::from_millis(limits::STOPPED_MS.into());
        let until = *self.until.get_or_insert(now + patience);
        if now >= until && !self.was_killed {
            self.was_killed = true;
            child.kill();
        }
    }
}

/// What the daemon was doing by its own word.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Life {
    Starting,
    Serving,
    Over,
}

/// It is dead, and a thread of it is inside a device that does not return. What is left to do must not wait for it.
fn hanging(asked: bool) -> End {
    match asked {
        true => End::Stopped,
        false => End::Crashed("killed, and hangs in the kernel".to_owned()),
    }
}

/// What an exit status means; `asked` if the guardian has asked for the end. A daemon that exits while it serves,
/// without a word, did not mean to: native code has called exit().
fn judge(status: ExitStatus, asked: bool, life: Life) -> End {
    if asked {
        return End::Stopped;
    }
    match (status.code(), status.signal()) {
        (Some(PANICKED), _) => End::Crashed("ended by a panic".to_owned()),
        (Some(code), _) if life == Life::Serving => {
            End::Crashed(format!("ended from inside with status {code}"))
        }
        (Some(0), _) => End::Stopped,
        (Some(_), _) => End::Failed,
        (None, Some(number)) => match Signal::try_from(number) {
            Ok(Signal::SIGTERM | Signal::SIGINT) => End::Stopped,
            Ok(signal) => End::Crashed(format!("killed by {signal}")),
            Err(_) => End::Crashed(format!("killed by signal {number}")),
        },
        (None, None) => End::Crashed("ended somehow".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nix::sys::pthread::{pthread_kill, pthread_self};
    use nix::sys::stat::Mode;
    use nix::unistd::mkfifo;
    use std::path::Path;

    /// Nothing.
    const LEFT_ALONE: LastMoment<'static> = LastMoment {
        rest: &|| {},
        cut_off: &|| {},
    };

    fn end_of(script: &str) -> (End, Vec<usize>) {
        let mut heard = Vec::new();
        let mut child = Child::shell(script);
        let mut ready = |nodes| heard.push(nodes);
        let end = Watch::new()
            .and_then(|watch| watch.until_end(&mut child, &|| true, &LEFT_ALONE, &mut ready))
            .expect("watched");
        (end, heard)
    }

    #[test]
    fn actuators_rest_before_the_last_thread_has_ended() {
        let folder = tempfile::tempdir().expect("a folder");
        let [rest, cut_off] = ["rest", "cut-off"].map(|name| folder.path().join(name));
        for pipe in [&rest, &cut_off] {
            mkfifo(pipe, Mode::S_IRWXU).expect("a pipe");
        }
        // The line ends before the process does, as while a thread still ends. What it waits for, nobody else reads.
        let end_of = |before: &str, pipe: &Path| {
            let mut child = Child::shell(&format!(
                "{before}; exec >&-; read word < {}; exit 7",
                pipe.display()
            ));
            let say = |pipe: &Path| std::fs::write(pipe, "now\n").expect("somebody reads");
            let last_moment = LastMoment {
                rest: &|| say(&rest),
                cut_off: &|| {
                    if pipe == cut_off {
                        say(pipe);
                    }
                },
            };
            let watch = Watch::new().expect("watch");
            let end = watch.until_end(&mut child, &|| true, &last_moment, &mut |_| {});
            end.expect("watched")
        };
        let crashed = End::Crashed("ended from inside with status 7".to_owned());
        assert_eq!(end_of("echo ready 1", &rest), crashed);
        // One that ends in order has done it itself.
        assert_eq!(end_of("echo ready 1; echo over", &cut_off), End::Failed);
    }

    #[test]
    fn an_end_is_judged_by_its_cause() {
        assert_eq!(
            end_of("echo ready 3; echo over; exit 0"),
            (End::Stopped, vec![3])
        );
        assert_eq!(
            end_of("echo ready 3; exit 0").0,
            End::Crashed("ended from inside with status 0".to_owned())
        );
        assert_eq!(end_of("exit 1").0, End::Failed);
        assert_eq!(
            end_of("exit 101").0,
            End::Crashed("ended by a panic".to_owned())
        );
        assert_eq!(
            end_of("kill -SEGV $$").0,
            End::Crashed("killed by SIGSEGV".to_owned())
        );
        assert_eq!(
            end_of("kill -KILL $$").0,
            End::Crashed("killed by SIGKILL".to_owned())
        );
    }

    #[test]
    fn a_daemon_that_somebody_stopped_is_not_restarted() {
        // The shell inherits the blocked signals of a daemon, so the statuses are made up: signal 15 and signal 2.
        assert_eq!(
            judge(ExitStatus::from_raw(15), false, Life::Serving),
            End::Stopped
        );
        assert_eq!(
            judge(ExitStatus::from_raw(2), false, Life::Serving),
            End::Stopped
        );
        assert_eq!(
            judge(ExitStatus::from_raw(64), false, Life::Serving),
            End::Crashed("killed by signal 64".to_owned())
        );
        assert_eq!(
            judge(ExitStatus::from_raw(9), true, Life::Serving),
            End::Stopped
        );
    }

    #[test]
    fn a_signal_ends_a_daemon_and_one_that_does_not_listen_is_forced() {
        let watch = Watch::new().expect("watch");
        // It inherits the mask of this thread, which blocks SIGTERM.
        let mut child = Child::shell("echo ready 1; exec sleep 1000");
        let mut asked = None;
        let mut ready = |_| {
            asked = Some(Instant::now());
            pthread_kill(pthread_self(), Signal::SIGTERM).expect("sent to this thread");
        };
        let end = watch
            .until_end(&mut child, &|| true, &LEFT_ALONE, &mut ready)
            .expect("watched");
        assert_eq!(end, End::Stopped);
        assert!(
            asked.is_some_and(
                |asked| asked.elapsed() >= Duration::from_millis(limits::GRACE_MS.into())
            )
        );
    }
}
