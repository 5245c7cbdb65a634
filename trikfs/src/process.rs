//! What /proc tells about the process behind a request.
//!
//! Owns the reading of /proc/PID; knows no file of the tree. A process that cannot be seen has no flags.

/// PF_EXITING of include/linux/sched.h: the process is ending, by itself or by a signal.
const PF_EXITING: u32 = 0x4;
/// PF_SIGNALED: it was killed by a signal.
const PF_SIGNALED: u32 = 0x400;

/// The process that a thread belongs to; the thread itself if it cannot be seen.
pub fn process_of(thread: u32) -> u32 {
    let status = std::fs::read_to_string(format!("/proc/{thread}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix("Tgid:"));
    line.and_then(|id| id.trim().parse().ok()).unwrap_or(thread)
}

/// The process is being killed by a signal.
pub fn is_being_killed(thread: u32) -> bool {
    flags_of(thread) & PF_SIGNALED != 0
}

/// The process is ending, for whatever reason.
pub fn is_ending(thread: u32) -> bool {
    flags_of(thread) & (PF_EXITING | PF_SIGNALED) != 0
}

fn flags_of(thread: u32) -> u32 {
    flags(&std::fs::read_to_string(format!("/proc/{thread}/stat")).unwrap_or_default())
}

/// Field 9 of /proc/PID/stat, counted behind the name, which may hold anything (proc(5)).
fn flags(stat: &str) -> u32 {
    let rest = stat.rsplit(')').next().unwrap_or("");
    let flags = rest.split_whitespace().nth(6);
    flags.and_then(|flags| flags.parse().ok()).unwrap_or(0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_flags_are_found_behind_any_name() {
        assert_eq!(flags("12 (a) b (c)) R 1 2 3 4 5 4194304 6"), 4_194_304);
        assert_eq!(
            flags("12 (a) b (c)) R 1 2 3 4 5 1028 6"),
            PF_EXITING | PF_SIGNALED
        );
        assert_eq!(flags(""), 0);
    }

    #[test]
    fn a_thread_belongs_to_its_process() {
        let process = std::process::id();
        let thread = nix::unistd::gettid().as_raw().cast_unsigned();
        assert_eq!(process_of(thread), process);
        assert!(!is_being_killed(thread) && !is_ending(thread));
    }
}
