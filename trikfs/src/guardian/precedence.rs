//! What must not be late when the daemon dies, on a machine that has much to do, and must not die of the same want of memory.
//!
//! Owns the nice values of this thread and of a process that ends, and whom the kernel kills first when memory is short. Those
//! who come first here sleep until something has gone wrong, and have little memory, so they take nothing from others.

use crate::limits::RESERVE_BYTES;
use nix::sys::memfd::{MFdFlags, memfd_create};
use rustix::process::{Pid, getpriority_process, setpriority_process};
use std::fs::{self, File};
use std::io::Write;
use std::path::Path;

/// How much the kernel wants to kill this process for memory, and the value of one that it never kills (proc_pid_oom_score_adj(5)).
const OOM_SCORE: &str = "/proc/self/oom_score_adj";
const NEVER: &str = "-1000";

/// The highest priority that a nice value gives (setpriority(2)).
const HIGHEST: i32 = -20;

/// While it lives, this thread comes first, if the system allows that; then it has the nice value that it had before.
pub(super) struct Hurry(Option<i32>);

impl Hurry {
    /// Begins it. Threads that this one starts meanwhile are in a hurry as well.
    pub(super) fn begin() -> Self {
        // None is this thread: on Linux each thread has a nice value of its own.
        let before = getpriority_process(None).ok();
        let raised = before.filter(|_| setpriority_process(None, HIGHEST).is_ok());
        Self(raised)
    }

    /// Begins it for good.
    pub(super) fn for_good() {
        std::mem::forget(Self::begin());
    }
}

/// Gives all threads of a process that is to end the processor first: it ends with the last of them.
pub(super) fn hurry_the_end_of(process: u32) {
    let threads = fs::read_dir(format!("/proc/{process}/task"));
    let numbers = threads
        .into_iter()
        .flatten()
        .flatten()
        .filter_map(|thread| thread.file_name().to_str()?.parse().ok());
    for thread in numbers.filter_map(Pid::from_raw) {
        let _ = setpriority_process(Some(thread), HIGHEST);
    }
}

/// While it lives, the kernel does not kill this process for memory, if the system allows that.
pub(super) struct Spared {
    file: &'static Path,
    before: Option<String>,
}

impl Spared {
    /// Begins it. Processes that this one starts meanwhile are spared as well.
    pub(super) fn begin() -> Self {
        Self::by(Path::new(OOM_SCORE))
    }

    fn by(file: &'static Path) -> Self {
        let before = fs::read_to_string(file).ok();
        let before = before.filter(|_| fs::write(file, NEVER).is_ok());
        Self { file, before }
    }
}

impl Drop for Spared {
    fn drop(&mut self) {
        if let Some(before) = &self.before {
            let _ = fs::write(self.file, before);
        }
    }
}

/// Memory that is given back when the daemon dies, by dropping it: what is done then needs some, and where a control group's
/// limit has killed the daemon there is none, until the daemon's own is free. The kernel would kill this process as well.
pub(super) struct Reserve(Option<File>);

impl Reserve {
    /// As much as a few threads and open files take. Nothing if there is no memory for it now.
    pub(super) fn new() -> Self {
        let file = memfd_create(c"reserve", MFdFlags::MFD_CLOEXEC).map(File::from);
        // Memory counts once it is written to.
        let piece = [0; 4096];
        let filled = |mut file: File| {
            let mut pieces = (0..RESERVE_BYTES / piece.len()).map(|_| file.write_all(&piece));
            let is_full = pieces.all(|written| written.is_ok());
            is_full.then_some(file)
        };
        Self(file.ok().and_then(filled))
    }

    /// Gives it back.
    pub(super) fn give_back(&self) {
        if let Some(file) = &self.0 {
            let _ = file.set_len(0);
        }
    }
}

impl Drop for Hurry {
    fn drop(&mut self) {
        if let Some(before) = self.0 {
            let _ = setpriority_process(None, before);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::os::unix::fs::MetadataExt;

    #[test]
    fn a_thread_hurries_and_the_nice_value_comes_back() {
        let seen = std::thread::spawn(|| {
            let now = || getpriority_process(None).expect("a nice value");
            let before = now();
            let hurry = Hurry::begin();
            let (during, is_allowed) = (now(), hurry.0.is_some());
            drop(hurry);
            (before, during, is_allowed, now())
        });
        let other = getpriority_process(None).expect("a nice value");
        let (before, during, is_allowed, after) = seen.join().expect("no panic");
        assert_eq!(during, if is_allowed { HIGHEST } else { before });
        assert_eq!((before, after), (other, other));
    }

    #[test]
    fn a_process_is_spared_for_a_while() {
        let folder = tempfile::tempdir().expect("a folder");
        let file: &'static Path = Box::leak(folder.path().join("score").into_boxed_path());
        let _nothing_to_change = Spared::by(file);
        fs::write(file, "7\n").expect("written");
        let spared = Spared::by(file);
        assert_eq!(fs::read_to_string(file).expect("read"), NEVER);
        drop(spared);
        assert_eq!(fs::read_to_string(file).expect("read"), "7\n");
    }

    #[test]
    fn a_reserve_is_there_until_it_is_given_back() {
        let reserve = Reserve::new();
        let blocks = || {
            let file = reserve.0.as_ref().expect("a kernel with memory files");
            file.metadata().expect("readable").blocks() * 512
        };
        assert!(blocks() >= RESERVE_BYTES as u64, "a page may be large");
        reserve.give_back();
        assert_eq!(blocks(), 0);
    }

    #[test]
    fn the_threads_of_another_process_come_first() {
        let mut other = std::process::Command::new("sleep")
            .arg("1000")
            .spawn()
            .expect("sleep");
        hurry_the_end_of(other.id());
        let pid = Pid::from_child(&other);
        let is_allowed = Hurry::begin().0.is_some();
        let nice = getpriority_process(Some(pid)).expect("a nice value");
        assert_eq!(nice == HIGHEST, is_allowed);
        other.kill().expect("killed");
        other.wait().expect("waited for");
    }
}
