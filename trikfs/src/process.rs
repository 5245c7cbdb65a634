//! What /proc tells about the process that made a request.
//!
//! Owns the reading of /proc/PID; knows no file of the tree. A process that cannot be seen is not ending.
//!
//! The process may be inside execve(2), waiting for our answer to a close, and then some files below /proc/PID wait
//! for it: `stat` waits for `exec_update_lock` of the kernel. `status` never does, so it is what is read here; `stat`
//! is opened only when `status` shows that the process has given up its memory, as one that exits has done before it
//! closes its files, and as one inside execve never has.

use crate::limits::GENERATIONS_MAX;
use std::fs;

/// PF_SIGNALED of include/linux/sched.h: the process was killed by a signal.
const PF_SIGNALED: u32 = 0x400;

/// The process that a thread belongs to; the thread itself if it cannot be seen.
pub fn process_of(thread: u32) -> u32 {
    number(&status(thread), "Tgid:").unwrap_or(thread)
}

/// The process and its ancestors, nearest first; a parent that has ended is one no more.
pub fn line_of(thread: u32) -> impl Iterator<Item = u32> {
    let own = status(thread);
    let process = number(&own, "Tgid:").unwrap_or(thread);
    let parent = number(&own, "PPid:");
    let ancestors = std::iter::successors(parent, |&id| number(&status(id), "PPid:"));
    let ancestors = ancestors.take_while(|&id| id > 0).take(GENERATIONS_MAX);
    std::iter::once(process).chain(ancestors)
}

/// The name of a process as /proc/PID/comm has it, on one line and printable; `?` if it cannot be seen.
pub fn name_of(process: u32) -> String {
    let name = fs::read(format!("/proc/{process}/comm")).unwrap_or_default();
    let shown: String = String::from_utf8_lossy(&name)
        .trim_end()
        .chars()
        .map(|c| if c.is_ascii_graphic() { c } else { '?' })
        .collect();
    if shown.is_empty() {
        "?".to_owned()
    } else {
        shown
    }
}

/// The process is being killed by a signal.
pub fn is_being_killed(thread: u32) -> bool {
    let stat = |thread| fs::read_to_string(format!("/proc/{thread}/stat")).unwrap_or_default();
    is_ending(thread) && flags(&stat(thread)) & PF_SIGNALED != 0
}

/// Somebody has stopped the process (SIGSTOP, SIGTSTP). One that a debugger holds is not stopped.
pub fn is_stopped(process: u32) -> bool {
    let status = status(process);
    let state = status.lines().find_map(|line| line.strip_prefix("State:"));
    state.is_some_and(|state| state.trim_start().starts_with('T'))
}

/// The process is ending, for whatever reason.
pub fn is_ending(thread: u32) -> bool {
    has_no_memory(&status(thread))
}

fn status(thread: u32) -> String {
    let bytes = fs::read(format!("/proc/{thread}/status")).unwrap_or_default();
    String::from_utf8_lossy(&bytes).into_owned()
}

/// The lines about memory are there exactly as long as a process has some (proc(5)).
fn has_no_memory(status: &str) -> bool {
    !status.is_empty() && !status.lines().any(|line| line.starts_with("VmSize:"))
}

fn number(status: &str, key: &str) -> Option<u32> {
    let line = status.lines().find_map(|line| line.strip_prefix(key));
    line.and_then(|number| number.trim().parse().ok())
}

/// Field 9 of /proc/PID/stat, counted after the name, which may hold anything (proc(5)).
fn flags(stat: &str) -> u32 {
    let rest = stat.rsplit(')').next().unwrap_or("");
    let flags = rest.split_whitespace().nth(6);
    flags.and_then(|flags| flags.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::{Command, Stdio};

    #[test]
    fn the_flags_are_found_behind_any_name() {
        assert_eq!(flags("12 (a) b (c)) R 1 2 3 4 5 4194304 6"), 4_194_304);
        assert_eq!(flags("12 (a) b (c)) R 1 2 3 4 5 1028 6"), 1028);
        assert_eq!(flags(""), 0);
    }

    #[test]
    fn a_thread_belongs_to_its_process_which_is_not_ending() {
        let process = std::process::id();
        let thread = nix::unistd::gettid().as_raw().cast_unsigned();
        assert_eq!(process_of(thread), process);
        assert!(!is_being_killed(thread) && !is_ending(thread));
        let parent = nix::unistd::getppid().as_raw().cast_unsigned();
        let line: Vec<u32> = line_of(thread).take(2).collect();
        assert_eq!(line, [process, parent]);
        assert!(line_of(thread).count() <= GENERATIONS_MAX + 1);
        assert_eq!(line_of(u32::MAX).collect::<Vec<_>>(), [u32::MAX]);
    }

    #[test]
    fn one_that_has_ended_is_known_by_its_end() {
        let mut child = Command::new("sh")
            .args(["-c", "kill -KILL $$"])
            .stdin(Stdio::null())
            .spawn()
            .expect("a shell");
        let id = child.id();
        // Until it is waited for, its entry stays.
        while !is_ending(id) {
            std::thread::yield_now();
        }
        assert!(is_being_killed(id));
        child.wait().expect("ended");
        assert!(!is_ending(id), "one that is gone cannot be seen");
        assert_eq!(name_of(id), "?");
    }
}
