//! How much memory this process may use: that of the machine, or less if its control group has less (cgroups(7)).
//!
//! Owns the reading of /proc and of the control groups' files. What follows from the number is known to others.

use crate::limits;
use crate::mount::{MountEntry, parse_mountinfo};
use std::fs;
use std::path::{Path, PathBuf};

/// Bytes that there are. If the machine does not say, as much as the smallest board has.
pub fn bytes() -> u64 {
    let machine = nix::sys::sysinfo::sysinfo();
    let machine = machine.map_or(limits::MACHINE_BYTES_LEAST, |found| found.ram_total());
    group_bytes(Path::new("/")).map_or(machine, |group| group.min(machine))
}

/// What the control group of this process allows, with those above it; None: nothing less than everything. `root` is where
/// /proc and all mounts are.
fn group_bytes(root: &Path) -> Option<u64> {
    let groups = fs::read_to_string(root.join("proc/self/cgroup")).ok()?;
    let mounts = fs::read(root.join("proc/self/mountinfo")).ok()?;
    let mut least = None;
    // NUMBER:CONTROLLERS:PATH; without controllers it is the second version, which has all of them.
    for line in groups.lines() {
        let mut words = line.splitn(3, ':').skip(1);
        let (Some(controllers), Some(path)) = (words.next(), words.next()) else {
            continue;
        };
        let is_second = controllers.is_empty();
        if !is_second && controllers.split(',').all(|one| one != "memory") {
            continue;
        }
        let kind = if is_second { "cgroup2" } else { "cgroup" };
        let Some((folder, top)) = mounted(&mounts, kind, path) else {
            continue;
        };
        let (folder, top) = (below(root, &folder), below(root, &top));
        let found = match is_second {
            true => second(&folder, &top),
            false => first(&folder),
        };
        least = [least, found].into_iter().flatten().min();
    }
    least
}

fn below(root: &Path, path: &Path) -> PathBuf {
    root.join(path.strip_prefix("/").unwrap_or(path))
}

/// Where a group is, and the top of its tree. In a container the path may be that outside; then the group is the top.
fn mounted(mounts: &[u8], kind: &str, group: &str) -> Option<(PathBuf, PathBuf)> {
    let is_of_memory = |mount: &MountEntry| {
        kind == "cgroup2" || mount.super_options.split(',').any(|one| one == "memory")
    };
    let mount = parse_mountinfo(mounts).find(|mount| mount.kind == kind && is_of_memory(mount))?;
    let inside = Path::new(group).strip_prefix(&mount.root).ok();
    let folder = inside.map(|inside| mount.mountpoint.join(inside));
    let top = mount.mountpoint;
    Some((folder.unwrap_or_else(|| top.clone()), top))
}

/// Of the first version, whose group knows the limits above it.
fn first(group: &Path) -> Option<u64> {
    let text = fs::read_to_string(group.join("memory.stat")).ok()?;
    let line = text
        .lines()
        .find_map(|line| line.strip_prefix("hierarchical_memory_limit "))?;
    line.trim().parse().ok()
}

/// Of the second version: the least of the group and all above it.
fn second(group: &Path, top: &Path) -> Option<u64> {
    let inside = |folder: &&Path| folder.starts_with(top);
    let limit = |folder: &Path, file| -> Option<u64> {
        // The word `max` is no number.
        fs::read_to_string(folder.join(file))
            .ok()?
            .trim()
            .parse()
            .ok()
    };
    group
        .ancestors()
        .take_while(inside)
        .flat_map(|folder| ["memory.max", "memory.high"].map(|file| limit(folder, file)))
        .flatten()
        .min()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    /// A root with these files.
    fn root(files: &[(&str, &str)]) -> Scratch {
        let scratch = Scratch::new();
        for (file, text) in files {
            let path = scratch.path(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
        scratch
    }

    #[test]
    fn the_machine_tells_its_memory() {
        assert!(bytes() >= 16 << 20);
    }

    #[test]
    fn the_first_version_has_a_tree_for_each_controller() {
        let mounts = "30 25 0:26 / /sys/fs/cgroup/cpu rw - cgroup cgroup rw,cpu\n31 25 0:27 / /sys/fs/cgroup/memory rw shared:9 - cgroup cgroup rw,memory\n";
        let root = root(&[
            (
                "proc/self/cgroup",
                "4:memory:/robot/a\n2:cpu,cpuacct:/other\n0::/\n",
            ),
            ("proc/self/mountinfo", mounts),
            (
                "sys/fs/cgroup/memory/robot/a/memory.stat",
                "cache 0\nhierarchical_memory_limit 52428800\nrss 1\n",
            ),
        ]);
        assert_eq!(group_bytes(&root.path("")), Some(52_428_800));
    }

    #[test]
    fn the_second_version_has_one_tree_in_which_the_least_limit_counts() {
        let mounts = "31 25 0:27 / /sys/fs/cgroup rw - cgroup2 cgroup2 rw\n";
        let root = root(&[
            ("proc/self/cgroup", "0::/robot/a\n"),
            ("proc/self/mountinfo", mounts),
            ("sys/fs/cgroup/robot/a/memory.max", "max\n"),
            ("sys/fs/cgroup/robot/a/memory.high", "90000000\n"),
            ("sys/fs/cgroup/robot/memory.max", "80000000\n"),
        ]);
        assert_eq!(group_bytes(&root.path("")), Some(80_000_000));
    }

    #[test]
    fn in_a_container_the_group_may_be_the_top_of_what_is_mounted() {
        let mounts = "31 25 0:27 /docker/1 /sys/my\\040groups rw - cgroup2 cgroup2 rw\n";
        let root = root(&[
            ("proc/self/cgroup", "0::/elsewhere\n"),
            ("proc/self/mountinfo", mounts),
            ("sys/my groups/memory.max", "70000000\n"),
        ]);
        assert_eq!(group_bytes(&root.path("")), Some(70_000_000));
    }

    #[test]
    fn without_control_groups_or_with_rubbish_there_is_no_limit() {
        for (groups, mounts) in [
            ("", ""),
            ("0::/\n", "x - cgroup2\n"),
            ("a:b\n::\n4:memory:/\n", "1 2 3 / /m rw - cgroup c memory\n"),
        ] {
            let root = root(&[
                ("proc/self/cgroup", groups),
                ("proc/self/mountinfo", mounts),
            ]);
            assert_eq!(group_bytes(&root.path("")), None, "{groups:?}");
        }
        assert_eq!(group_bytes(Path::new("/nonexistent")), None);
    }
}
