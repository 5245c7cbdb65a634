//! Whether the system has killed somebody for want of memory while a program ran.
//!
//! Owns where the kernel counts that: in the control group of this process, which programs are in too, or else in the whole
//! machine. A kernel that counts nowhere gives no evidence.

use std::fs;
use std::path::Path;

/// How often it has.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) struct Kills(Option<u64>);

impl Kills {
    /// Until now.
    pub(super) fn now() -> Self {
        Self(of_group(Path::new("/sys/fs/cgroup")).or_else(of_machine))
    }

    /// Whether it has done so again.
    pub(super) fn have_grown(self) -> bool {
        Self::now().are_more_than(self)
    }

    fn are_more_than(self, before: Self) -> bool {
        matches!((before.0, self.0), (Some(before), Some(now)) if now > before)
    }
}

/// In the control group of this process: cgroups(7), memory.events of version 2, memory.oom_control of version 1.
fn of_group(root: &Path) -> Option<u64> {
    let groups = fs::read_to_string("/proc/self/cgroup").ok()?;
    groups.lines().find_map(|line| {
        let file = counted_in(line)?;
        let text = fs::read_to_string(root.join(file)).ok()?;
        named(&text, "oom_kill")
    })
}

/// The file below the mount of control groups that has the count, of a line of `/proc/self/cgroup`; none if this group
/// counts no memory.
fn counted_in(line: &str) -> Option<String> {
    let mut parts = line.splitn(3, ':');
    let (_, controllers, path) = (parts.next()?, parts.next()?, parts.next()?);
    let path = path.trim_matches('/');
    match controllers {
        "" => Some(
            format!("{path}/memory.events")
                .trim_start_matches('/')
                .to_owned(),
        ),
        all if all.split(',').any(|one| one == "memory") => {
            Some(format!("memory/{path}/memory.oom_control"))
        }
        _ => None,
    }
}

/// In the whole machine: proc(5), since Linux 4.13.
fn of_machine() -> Option<u64> {
    named(&fs::read_to_string("/proc/vmstat").ok()?, "oom_kill")
}

/// The number behind a word that begins a line.
fn named(text: &str, word: &str) -> Option<u64> {
    let mut lines = text.lines();
    lines.find_map(|line| {
        let (name, number) = line.split_once(' ')?;
        (name == word).then(|| number.trim().parse().ok())?
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_a_count_that_has_grown_is_evidence() {
        let kills = |count| Kills(count);
        assert!(kills(Some(3)).are_more_than(kills(Some(2))));
        assert!(!kills(Some(2)).are_more_than(kills(Some(2))));
        // A process that is moved to another group is counted elsewhere.
        assert!(!kills(Some(1)).are_more_than(kills(Some(2))));
        assert!(!kills(Some(2)).are_more_than(kills(None)));
        assert!(!kills(None).are_more_than(kills(Some(2))));
    }

    #[test]
    fn the_count_is_found_where_each_version_has_it() {
        for (line, file) in [
            ("0::/", Some("memory.events")),
            ("0::/a/b", Some("a/b/memory.events")),
            ("4:memory:/a", Some("memory/a/memory.oom_control")),
            ("4:cpu,memory:/a", Some("memory/a/memory.oom_control")),
            ("3:cpu:/a", None),
            ("rubbish", None),
            ("", None),
        ] {
            assert_eq!(counted_in(line).as_deref(), file, "{line}");
        }
        let events = "low 0\nhigh 3\nmax 5\noom 2\noom_kill 7\noom_group_kill 1\n";
        assert_eq!(named(events, "oom_kill"), Some(7));
        assert_eq!(named("oom_kill_disable 0\nunder_oom 0\n", "oom_kill"), None);
        assert_eq!(named("oom_kill many\n", "oom_kill"), None);
        assert_eq!(named("", "oom_kill"), None);
    }
}
