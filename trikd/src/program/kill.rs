//! Ends everything that a program has started, wherever it has put itself.
//!
//! This process is the subreaper of all programs: a process that loses its parent becomes our child, so what lives below us is
//! what has to go. A program with a user of its own cannot even outrun the search: one kill(2) takes all of that user.

use crate::error::Error;
use crate::limits;
use nix::errno::Errno;
use nix::sys::prctl;
use nix::sys::signal::{Signal, kill, killpg};
use nix::unistd::{Pid, Uid, getpgid};
use std::collections::{HashMap, HashSet};
use std::fs;
use std::os::unix::fs::MetadataExt;

/// Makes this process the subreaper of everything below it. Linux has that since 3.4, but an emulator of another processor
/// may not: there the robot works all the same, and says what it cannot promise.
///
/// # Errors
/// The kernel refuses.
pub fn adopt_orphans() -> Result<(), Error> {
    match prctl::set_child_subreaper(true) {
        Err(Errno::EINVAL) => {
            crate::log::report(
                "this system has no PR_SET_CHILD_SUBREAPER: processes that leave their program outlive it",
            );
            Ok(())
        }
        other => other.map_err(|error| Error::Subreaper(error.into())),
    }
}

/// A process as /proc shows it (proc(5)).
struct Process {
    pid: i32,
    parent: i32,
    /// Was stopped by a signal.
    is_still: bool,
}

fn processes() -> Vec<Process> {
    let Ok(entries) = fs::read_dir("/proc") else {
        return Vec::new();
    };
    let numbers = entries
        .flatten()
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    numbers.filter_map(process).collect()
}

/// None if it is gone or a zombie, which only waits to be told of.
fn process(pid: i32) -> Option<Process> {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    // The name in brackets may hold anything.
    let mut fields = stat.rsplit(')').next()?.split_ascii_whitespace();
    let state = fields.next()?;
    let is_dead = matches!(state, "Z" | "X");
    (!is_dead).then(|| {
        Some(Process {
            pid,
            parent: fields.next()?.parse().ok()?,
            is_still: state == "T",
        })
    })?
}

/// Whether a process was stopped by a signal and has not gone on.
pub fn stands_still(pid: Pid) -> bool {
    process(pid.as_raw()).is_some_and(|process| process.is_still)
}

/// Everybody below a process, without it.
pub fn below(ancestor: Pid) -> Vec<Pid> {
    below_of(ancestor, &processes())
}

/// The same, and who of them was stopped by a signal.
pub fn below_and_still(ancestor: Pid) -> (Vec<Pid>, Option<Pid>) {
    let all = processes();
    let found = below_of(ancestor, &all);
    let is_still = |pid: &&Pid| {
        all.iter()
            .any(|process| process.is_still && process.pid == pid.as_raw())
    };
    let still = found.iter().find(is_still).copied();
    (found, still)
}

fn below_of(ancestor: Pid, all: &[Process]) -> Vec<Pid> {
    let mut children: HashMap<i32, Vec<i32>> = HashMap::new();
    for process in all {
        children
            .entry(process.parent)
            .or_default()
            .push(process.pid);
    }
    let mut found = Vec::new();
    let mut seen = HashSet::new();
    let mut next = vec![ancestor.as_raw()];
    while let Some(pid) = next.pop() {
        for child in children.get(&pid).into_iter().flatten() {
            // Numbers that are used again while /proc is read could make a circle.
            if seen.insert(*child) {
                found.push(Pid::from_raw(*child));
                next.push(*child);
            }
        }
    }
    found
}

/// How many processes a user has.
pub fn of_user(user: Uid) -> u64 {
    let Ok(entries) = fs::read_dir("/proc") else {
        return 0;
    };
    let own = entries.flatten().filter(|entry| {
        let is_process = entry
            .file_name()
            .to_str()
            .is_some_and(|name| name.parse::<i32>().is_ok());
        is_process
            && entry
                .metadata()
                .is_ok_and(|data| data.uid() == user.as_raw())
    });
    u64::try_from(own.count()).unwrap_or(u64::MAX)
}

/// Stops or kills the processes of a program that have not left its group: one system call, nobody can outrun it.
pub fn group(leader: Pid, signal: Signal) {
    // A group of which nobody is left is fine.
    let _ = killpg(leader, signal);
}

/// Stops all processes below one that are in no group that has been stopped, until no new one is found; returns
/// whether there was one. What they were about to write waits until they are dead.
pub fn freeze(ancestor: Pid, stopped: Pid) -> bool {
    let mut frozen = HashSet::new();
    for _ in 0..limits::FREEZE_ROUNDS {
        let before = frozen.len();
        for pid in below(ancestor) {
            if getpgid(Some(pid)) != Ok(stopped) && frozen.insert(pid) {
                let _ = kill(pid, Signal::SIGSTOP);
            }
        }
        if frozen.len() == before {
            break;
        }
    }
    !frozen.is_empty()
}

/// Kills everybody below a process once; returns how many there were.
pub fn sweep(ancestor: Pid, spared: &[Pid]) -> usize {
    let mut found = below(ancestor);
    found.retain(|pid| !spared.contains(pid));
    for pid in &found {
        let _ = kill(*pid, Signal::SIGKILL);
    }
    found.len()
}

/// Kills everybody with the user of this process but this process: what the hidden command `kill-user` does, under the
/// user of the program.
///
/// # Errors
/// This process is root: then everything on the machine would go.
pub fn own_user() -> Result<(), Error> {
    if Uid::effective().is_root() || Uid::current().is_root() {
        return Err(Error::KillUserAsRoot);
    }
    match kill(Pid::from_raw(-1), Signal::SIGKILL) {
        Ok(()) | Err(Errno::ESRCH) => Ok(()),
        Err(error) => Err(Error::KillUser(error.into())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::process::CommandExt;
    use std::process::Command;

    #[test]
    fn children_of_children_are_found_and_ended() {
        let mut child = Command::new("sh")
            .args(["-c", "sleep 100 & sleep 100 & wait"])
            .spawn()
            .unwrap();
        let pid = Pid::from_raw(i32::try_from(child.id()).unwrap());
        while below(pid).len() < 2 {
            std::thread::yield_now();
        }
        assert!(below(Pid::this()).contains(&pid));
        assert_eq!(sweep(pid, &[]), 2);
        child.wait().unwrap();
        assert!(below(pid).is_empty());
    }

    #[test]
    fn who_has_left_the_group_stands_still_too() {
        let mut child = Command::new("sh")
            .args(["-c", "setsid sh -c 'while :; do :; done' & wait"])
            .process_group(0)
            .spawn()
            .unwrap();
        let pid = Pid::from_raw(i32::try_from(child.id()).unwrap());
        let stranger = || {
            let all = below(pid);
            all.into_iter().find(|one| getpgid(Some(*one)) != Ok(pid))
        };
        while stranger().is_none() {
            std::thread::yield_now();
        }
        assert!(freeze(pid, pid));
        let stranger = stranger().unwrap();
        let stands = || {
            let stat = fs::read_to_string(format!("/proc/{stranger}/stat")).unwrap();
            stat.contains(") T ")
        };
        while !stands() {
            std::thread::yield_now();
        }
        assert_eq!(below_and_still(Pid::this()).1, Some(stranger));
        assert!(stands_still(stranger) && !stands_still(Pid::this()));
        sweep(pid, &[]);
        let _ = child.kill();
        child.wait().unwrap();
        assert!(!freeze(pid, pid));
    }
}
