//! A control group for each judged program, where the system has given one to this process (cgroup v2).
//!
//! Owns what is made and removed there. Limits of one process are known elsewhere; these are of a program with all that
//! it starts. Without such a group there is none, and nobody is told: few systems give one by themselves.

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
const CONTROLLERS: [&str; 2] = ["memory", "pids"];

/// The group of this process, if groups with limits can be made below it. Only a group without processes of its own has
/// such groups, so this process moves into one beside them.
pub(crate) fn delegated() -> Option<PathBuf> {
    let own = fs::read_to_string("/proc/self/cgroup").ok()?;
    let place = own.lines().find_map(|line| line.strip_prefix(LINE))?;
    let bases = MOUNTS.iter().map(|mount| Path::new(mount).join(place));
    let base = bases.into_iter().find(|base| has_controllers(base))?;
    let leaf = base.join(format!("trik-judge-{}", std::process::id()));
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
    base.join(format!("trik-{process}"))
}

/// Puts this process, and what it starts, into a group of its own.
pub(super) fn enter(base: &Path, memory: u64) -> io::Result<()> {
    let group = of(base, std::process::id());
    fs::create_dir(&group)?;
    fs::write(group.join("memory.max"), memory.to_string())?;
    // Not each kernel counts swap.
    let _ = fs::write(group.join("memory.swap.max"), "0");
    fs::write(group.join("pids.max"), limits::GROUP_PROCESSES.to_string())?;
    fs::write(group.join(PROCESSES), "0")
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

#[cfg(test)]
mod tests {
    use super::*;

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
    }
}
