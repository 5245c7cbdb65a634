//! The process around the serving one: whatever ends that, motors rest, no program is left, and it is started again.
//!
//! Owns one child and nothing else. It is the subreaper behind the daemon, so programs whose daemon is dead are its
//! children; if the guardian itself dies, the daemon ends in order.

// A request, a message or a command that is forgotten must not pass in silence.
#![deny(clippy::wildcard_enum_match_arm)]

use crate::error::Error;
use crate::program::kill;
use crate::program::rest::Failure;
use crate::tree::{Access, Tree};
use crate::{limits, log};
use nix::sys::prctl;
use nix::sys::signal::{SigSet, SigmaskHow, Signal};
use nix::sys::wait::{WaitPidFlag, WaitStatus, waitpid};
use nix::unistd::{Pid, getppid};
use std::collections::VecDeque;
use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

/// Signals that end both processes.
const ENDS: [Signal; 3] = [Signal::SIGTERM, Signal::SIGINT, Signal::SIGHUP];

/// The beginning of the serving process: it ends in order when the guardian dies.
///
/// # Errors
/// The guardian is gone, or the kernel refuses.
pub fn follow(guardian: i32) -> Result<(), Error> {
    // For those who look at a list of processes.
    let _ = prctl::set_name(c"trikd");
    let reset = SigSet::empty().thread_swap_mask(SigmaskHow::SIG_SETMASK);
    reset
        .and_then(|_| prctl::set_pdeathsig(Signal::SIGTERM))
        .map_err(|error| Error::Os(error.into()))?;
    if getppid().as_raw() != guardian {
        return Err(Error::GuardianGone);
    }
    Ok(())
}

fn start(arguments: &[OsString], restarts: u32) -> Result<Pid, Error> {
    let mut command = crate::program::child::this_program();
    command
        .arg("daemon")
        .arg("--guardian")
        .arg(std::process::id().to_string());
    command
        .arg("--restarts")
        .arg(restarts.to_string())
        .args(arguments);
    let child = command
        .spawn()
        .map_err(|error| Error::ServingProcess(error.into()))?;
    Ok(Pid::from_raw(i32::try_from(child.id()).map_err(
        |error| Error::Os(std::io::Error::other(error).into()),
    )?))
}

/// Motors to rest, programs away, motors to rest again.
fn clean_up(tree: &Path) {
    rest(tree);
    let deadline = Instant::now() + Duration::from_millis(limits::KILL_MS);
    while kill::sweep(Pid::this(), &[]) > 0 && Instant::now() < deadline {
        while matches!(waitpid(None, Some(WaitPidFlag::WNOHANG)), Ok(status) if status != WaitStatus::StillAlive)
        {
        }
        std::thread::sleep(Duration::from_millis(2));
    }
    rest(tree);
}

/// On a thread, because a tree that hangs must not hang the guardian.
fn rest(tree: &Path) {
    let (tell, told) = std::sync::mpsc::channel();
    let root = tree.to_owned();
    std::thread::spawn(move || {
        let done = Tree::new(&root).node("stop", Access::Write).write("1\n");
        let _ = tell.send(done.map_err(|error| Failure::of(&root, error)));
    });
    match told.recv_timeout(Duration::from_millis(limits::GUARDIAN_REST_MS)) {
        Ok(Ok(())) => {}
        Ok(Err(why)) => tracing::error!(target: log::TREE, "{why}"),
        Err(_) => tracing::error!(
            target: log::TREE,
            "the tree at {} does not answer",
            tree.display()
        ),
    }
}

/// Asks the serving process to end, and insists when it does not: it hangs.
fn end(daemon: Pid) {
    let _ = nix::sys::signal::kill(daemon, Signal::SIGTERM);
    std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(limits::GUARDIAN_END_MS));
        // Its number is its own until this process, which ends then, has taken its end.
        let _ = nix::sys::signal::kill(daemon, Signal::SIGKILL);
    });
}

/// How the serving process ended, if it has. One that is stopped (SIGSTOP) can neither serve nor see that it does not:
/// a program with the same rights could do that to escape every stop. It is killed.
fn ended(daemon: Pid) -> Option<WaitStatus> {
    let flags = WaitPidFlag::WNOHANG | WaitPidFlag::WUNTRACED;
    loop {
        match waitpid(None, Some(flags)) {
            Ok(WaitStatus::StillAlive) | Err(_) => return None,
            Ok(WaitStatus::Stopped(pid, signal)) => {
                if pid == daemon {
                    tracing::error!(target: log::DAEMON, "the serving process was stopped with {signal}: it is killed");
                    let _ = nix::sys::signal::kill(daemon, Signal::SIGKILL);
                }
            }
            Ok(status) if status.pid() == Some(daemon) => return Some(status),
            Ok(_) => {}
        }
    }
}

/// Starts the serving process with the same arguments and looks after it until it ends in order.
///
/// # Errors
/// The serving process cannot be started, or crashes again and again.
pub fn run(tree: &Path, arguments: &[OsString]) -> Result<ExitCode, Error> {
    let fails = |error: nix::Error| Error::Guardian(error.into());
    kill::adopt_orphans()?;
    let mut signals = SigSet::from_iter(ENDS);
    signals.add(Signal::SIGCHLD);
    // A terminal stops whatever runs in it (Ctrl-Z), and motors would go on.
    signals.add(Signal::SIGTSTP);
    signals.thread_block().map_err(fails)?;
    let mut crashes: VecDeque<Instant> = VecDeque::new();
    let mut restarts = 0;
    let mut is_over = false;
    let mut daemon = start(arguments, restarts)?;
    loop {
        let signal = signals.wait().map_err(fails)?;
        if signal == Signal::SIGTSTP {
            tracing::warn!(target: log::DAEMON, "what guards motors is not stopped: end it with Ctrl-C");
            continue;
        }
        if signal != Signal::SIGCHLD {
            is_over = true;
            end(daemon);
            continue;
        }
        let Some(status) = ended(daemon) else {
            continue;
        };
        if let WaitStatus::Exited(_, code @ 0..=2) = status {
            return Ok(ExitCode::from(u8::try_from(code).unwrap_or(1)));
        }
        tracing::error!(
            target: log::DAEMON,
            "the serving process has crashed ({status:?}): motors are brought to rest, programs are ended"
        );
        clean_up(tree);
        if is_over {
            return Err(Error::CrashAtTheEnd);
        }
        crashes.push_back(Instant::now());
        crashes.retain(|crash| crash.elapsed() < Duration::from_millis(limits::CRASHES_MS));
        if crashes.len() >= limits::CRASHES {
            return Err(Error::Crashes(limits::CRASHES, limits::CRASHES_MS / 1000));
        }
        restarts += 1;
        daemon = start(arguments, restarts)?;
    }
}
