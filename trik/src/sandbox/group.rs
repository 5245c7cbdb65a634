//! A control group for each judged program, where the system has given one to this process (cgroup v2).
//!
//! Owns what is made and removed there. Limits of one process are known elsewhere; these are of a program with all that
//! it starts. Without such a group there is none, and nobody is told: few systems give one by themselves.

use crate::error::Error;
use crate::limits;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};
use std::thread::sleep;
use std::time::Duration;

/// Where cgroup v2 is mounted, alone or beside the first version.
const MOUNTS: [&str; 2] = ["/sys/fs/cgroup", "/sys/fs/cgroup/unified"];
/// The line of `/proc/self/cgroup` that has it.
const LINE: &str = "0::/";
const PROCESSES: &str = "cgroup.procs";
/// What the name of the group of a program begins with, before the number of the process that starts it.
const PROGRAM: &str = "trik-";
/// The same of the group of a judge.
const JUDGE: &str = "trik-judge-";
const CONTROLLERS: [&str; 2] = ["memory", "pids"];

/// The group of this process, if groups with limits can be made below it. Only a group without processes of its own has
/// such groups, so this process moves into one beside them.
pub(crate) fn delegated() -> Option<PathBuf> {
    let own = fs::read_to_string("/proc/self/cgroup").ok()?;
    let place = own.lines().find_map(|line| line.strip_prefix(LINE))?;
    let bases = MOUNTS.iter().map(|mount| Path::new(mount).join(place));
    let base = bases.into_iter().find(|base| has_controllers(base))?;
    // What a judge that was killed has left.
    sweep_once(&base);
    let leaf = base.join(format!("{JUDGE}{}", std::process::id()));
    if divide(&base).is_ok() {
        return Some(base);
    }
    let moved = fs::create_dir(&leaf)
        .and_then(|()| fs::write(leaf.join(PROCESSES), "0"))
        .and_then(|()| divide(&base));
    if moved.is_ok() {
        return Some(base);
    }
    // Others are in it too: it was not given to this process.
    let _ = fs::write(base.join(PROCESSES), "0");
    let _ = fs::remove_dir(&leaf);
    None
}

fn has_controllers(base: &Path) -> bool {
    let listed = fs::read_to_string(base.join("cgroup.controllers")).unwrap_or_default();
    CONTROLLERS
        .iter()
        .all(|one| listed.split_whitespace().any(|word| word == *one))
}

fn divide(base: &Path) -> io::Result<()> {
    fs::write(base.join("cgroup.subtree_control"), "+memory +pids")
}

/// The group of a program by the process that starts it.
fn of(base: &Path, process: u32) -> PathBuf {
    base.join(format!("{PROGRAM}{process}"))
}

/// Puts this process, and what it starts, into a group of its own.
pub(super) fn enter(base: &Path, memory: u64) -> Result<(), Error> {
    let failed = |path: &Path, error: io::Error| {
        Error::system(format_args!("control group {}", path.display()), error)
    };
    let group = of(base, std::process::id());
    if group.exists() {
        // Process ids are used again: a judge was killed before it could remove its group.
        leave(base, std::process::id());
    }
    match fs::create_dir(&group) {
        Err(error) if error.kind() != io::ErrorKind::AlreadyExists => {
            return Err(failed(&group, error));
        }
        _ => {}
    }
    let put = |name: &str, text: &str| {
        let path = group.join(name);
        fs::write(&path, text).map_err(|error| failed(&path, error))
    };
    put("memory.max", &memory.to_string())?;
    // Not each kernel counts swap.
    let _ = put("memory.swap.max", "0");
    put("pids.max", &limits::GROUP_PROCESSES.to_string())?;
    put(PROCESSES, "0")
}

/// Ends all in the group of a program, and removes it.
pub(super) fn leave(base: &Path, process: u32) {
    let group = of(base, process);
    // Since Linux 5.14; what it leaves others end.
    let _ = fs::write(group.join("cgroup.kill"), "1");
    for _ in 0..limits::SWEEPS {
        match fs::remove_dir(&group) {
            Err(error) if error.kind() == io::ErrorKind::ResourceBusy => {
                sleep(Duration::from_millis(1));
            }
            _ => return,
        }
    }
}

/// Removes the groups of programs whose judge was killed, with what is in them. Those of others that still run stay, so it
/// is waited only for a while for the last of ours.
pub(crate) fn sweep(base: &Path) {
    for _ in 0..limits::SWEEPS {
        if sweep_once(base) == 0 {
            return;
        }
        sleep(Duration::from_millis(1));
    }
}

/// How many there still are.
fn sweep_once(base: &Path) -> usize {
    let Ok(entries) = fs::read_dir(base) else {
        return 0;
    };
    let mut left = 0;
    for entry in entries.flatten() {
        let name = entry.file_name();
        let Some(name) = name.to_str() else { continue };
        let number = |start: &str| name.strip_prefix(start)?.parse().ok();
        if let Some(process) = number(PROGRAM) {
            if !is_gone(process) {
                left += 1;
            } else if fs::remove_dir(entry.path()).is_err() {
                leave(base, process);
            }
        } else if number(JUDGE).is_some_and(is_gone) {
            let _ = fs::remove_dir(entry.path());
        }
    }
    left
}

/// Whether a process has ended; one that nobody has asked how is still listed.
fn is_gone(process: u32) -> bool {
    let status = fs::read_to_string(format!("/proc/{process}/stat")).unwrap_or_default();
    // The name in brackets may hold anything.
    let state = status.rsplit(')').next().map(str::trim_start);
    state.is_none_or(|state| state.is_empty() || state.starts_with(['Z', 'X']))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::process::{Command, Stdio};

    /// Plain files instead of the kernel's.
    #[test]
    fn a_program_gets_a_group_with_its_limits_that_is_told_whom_it_has() {
        let base = tempfile::tempdir().unwrap();
        assert!(!has_controllers(base.path()));
        fs::write(base.path().join("cgroup.controllers"), "cpu memory pids\n").unwrap();
        assert!(has_controllers(base.path()));
        divide(base.path()).unwrap();
        let read = |path: PathBuf| fs::read_to_string(path).unwrap();
        let divided = read(base.path().join("cgroup.subtree_control"));
        assert_eq!(divided, "+memory +pids");
        enter(base.path(), 1 << 30).unwrap();
        let group = of(base.path(), std::process::id());
        assert_eq!(read(group.join("memory.max")), (1 << 30).to_string());
        assert_eq!(read(group.join("pids.max")), "96");
        assert_eq!(read(group.join(PROCESSES)), "0");
        leave(base.path(), std::process::id());
        assert_eq!(read(group.join("cgroup.kill")), "1");
        let missing = base.path().join("missing");
        let why = enter(&missing, 1 << 30).unwrap_err().to_string();
        let told = format!(
            "control group {}: ",
            of(&missing, std::process::id()).display()
        );
        assert!(why.starts_with(&told), "{why}");
    }

    #[test]
    fn a_group_that_was_left_behind_is_taken_again_and_those_of_the_dead_are_removed() {
        let base = tempfile::tempdir().unwrap();
        let own = of(base.path(), std::process::id());
        fs::create_dir(&own).unwrap();
        fs::write(own.join("memory.max"), "1").unwrap();
        enter(base.path(), 1 << 30).unwrap();
        let most = fs::read_to_string(own.join("memory.max")).unwrap();
        assert_eq!(most, (1 << 30).to_string());
        let mut child = Command::new("cat").stdin(Stdio::piped()).spawn().unwrap();
        let (group, judge) = (
            of(base.path(), child.id()),
            base.path().join(format!("{JUDGE}{}", child.id())),
        );
        fs::create_dir(&group).unwrap();
        fs::create_dir(&judge).unwrap();
        fs::create_dir(base.path().join("trik-of-somebody")).unwrap();
        assert_eq!(sweep_once(base.path()), 2);
        assert!(group.exists() && judge.exists());
        child.kill().unwrap();
        child.wait().unwrap();
        assert_eq!(sweep_once(base.path()), 1);
        assert!(!group.exists() && !judge.exists() && own.exists());
        assert!(base.path().join("trik-of-somebody").exists());
    }
}
