//! Other processes as /proc shows them: who lives, whose child is who, who sleeps.
//!
//! Owns the reading of /proc; sends signals only to processes that it is told of.

use nix::sys::signal::{Signal, kill};
use nix::unistd::Pid;
use std::fs;

/// State letter and parent of a process (proc(5), fields 3 and 4, counted after the name, which may hold anything).
fn state(pid: u32) -> Option<(char, u32)> {
    let stat = fs::read_to_string(format!("/proc/{pid}/stat")).ok()?;
    let mut fields = stat.rsplit(')').next()?.split_whitespace();
    Some((fields.next()?.chars().next()?, fields.next()?.parse().ok()?))
}

/// Threads of a process that bear a name (the first 15 bytes of it, as the kernel keeps them); 0 if it is gone.
pub fn threads_named(pid: u32, name: &str) -> usize {
    let Ok(threads) = fs::read_dir(format!("/proc/{pid}/task")) else {
        return 0;
    };
    threads
        .flatten()
        .filter_map(|thread| fs::read_to_string(thread.path().join("comm")).ok())
        .filter(|comm| comm.trim_end() == name)
        .count()
}

/// Runs or sleeps; a zombie is dead.
pub fn is_alive(pid: u32) -> bool {
    state(pid).is_some_and(|(state, _)| !matches!(state, 'Z' | 'X'))
}

/// Sleeps in a system call or waits for a device.
pub fn is_asleep(pid: u32) -> bool {
    state(pid).is_some_and(|(state, _)| matches!(state, 'S' | 'D'))
}

/// Was stopped by a signal, with all its threads.
pub fn is_stopped(pid: u32) -> bool {
    let Ok(threads) = fs::read_dir(format!("/proc/{pid}/task")) else {
        return false;
    };
    let numbers = threads
        .flatten()
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    numbers
        .map(state)
        .all(|state| state.is_none_or(|(state, _)| state == 'T'))
}

/// Living children of a process.
pub fn children(pid: u32) -> Vec<u32> {
    let Ok(entries) = fs::read_dir("/proc") else {
        return Vec::new();
    };
    let numbers = entries
        .flatten()
        .filter_map(|entry| entry.file_name().to_str()?.parse().ok());
    numbers
        .filter(|&child| is_alive(child) && state(child).is_some_and(|(_, parent)| parent == pid))
        .collect()
}

/// Sends a signal to one process; one that is gone already is fine.
pub fn signal(pid: u32, signal: Signal) {
    if let Ok(pid) = i32::try_from(pid) {
        let _ = kill(Pid::from_raw(pid), signal);
    }
}

/// Sends a signal to a process group that the harness made.
pub fn signal_group(pid: u32, signal: Signal) {
    if let Ok(pid) = i32::try_from(pid) {
        let _ = kill(Pid::from_raw(-pid), signal);
    }
}

/// What each thread of a process is doing, for the message of a hang.
pub fn describe(pid: u32) -> String {
    let read = |thread: &str, file: &str| {
        fs::read_to_string(format!("/proc/{pid}/task/{thread}/{file}")).unwrap_or_default()
    };
    let threads = fs::read_dir(format!("/proc/{pid}/task")).into_iter();
    let names = threads.flatten().flatten().map(|entry| entry.file_name());
    let mut text = String::new();
    for name in names {
        let thread = name.to_string_lossy();
        let state = thread.parse().ok().and_then(state).map_or('?', |s| s.0);
        let (comm, stack) = (read(&thread, "comm"), read(&thread, "stack"));
        let calls: Vec<&str> = stack
            .lines()
            .filter_map(|line| line.split(' ').nth(1)?.split('+').next())
            .collect();
        let doing = if calls.is_empty() {
            read(&thread, "syscall")
        } else {
            calls.join(" < ")
        };
        text.push_str(&format!(
            "{pid}/{thread} {} {state}: {}\n",
            comm.trim(),
            doing.trim()
        ));
    }
    text
}

/// Resident memory in bytes (proc(5), /proc/PID/statm counts pages).
pub fn resident_bytes(pid: u32) -> Option<u64> {
    let statm = fs::read_to_string(format!("/proc/{pid}/statm")).ok()?;
    let pages: u64 = statm.split(' ').nth(1)?.parse().ok()?;
    let page = nix::unistd::sysconf(nix::unistd::SysconfVar::PAGE_SIZE).ok()??;
    Some(pages * u64::try_from(page).ok()?)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_child_is_seen_while_it_lives() {
        let mut child = std::process::Command::new("sleep")
            .arg("100")
            .spawn()
            .unwrap();
        let pid = child.id();
        assert!(is_alive(pid) && children(std::process::id()).contains(&pid));
        signal(pid, Signal::SIGKILL);
        child.wait().unwrap();
        assert!(!is_alive(pid));
        assert!(resident_bytes(std::process::id()).unwrap() > 0);
    }
}
