//! One child process within limits of time, output and memory.
//!
//! Owns how they are enforced, and the end of all processes that the child has started. Compilers and the programs of
//! sensors run through it; it knows nothing of either.

mod signals;

use crate::events::lock;
use crate::limits::{COMMAND_LOOK_MS, COMMAND_SETTLE};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use nix::sys::signal::{Signal, killpg};
use nix::unistd::Pid;
use std::io::{self, PipeReader, Read};
use std::os::fd::AsFd;
use std::os::unix::process::CommandExt;
use std::path::Path;
use std::process::{Child, Command, ExitStatus, Stdio};
use std::sync::{Arc, Mutex};
use std::time::{Duration, Instant};

/// What a process may take.
pub(crate) struct Limits {
    /// From start to end; then its whole process group is killed.
    pub(crate) time: Duration,
    /// Bytes of output that are kept; the rest is read and dropped.
    pub(crate) output_bytes: usize,
    /// Where its process group is noted while it runs, for the end of all.
    pub(crate) groups: Option<Arc<Groups>>,
}

/// Process groups that run now.
#[derive(Default)]
pub(crate) struct Groups(Mutex<Vec<i32>>);

impl Groups {
    /// Kills all of them: nothing is left that would end them when their time is up.
    pub(crate) fn kill_all(&self) {
        for &group in &*lock(&self.0) {
            let _ = killpg(Pid::from_raw(group), Signal::SIGKILL);
        }
    }
}

/// How it ended.
pub(crate) struct Ended {
    /// Absent if it was killed because its time was up.
    pub(crate) status: Option<ExitStatus>,
    /// What it wrote to standard output and standard error; bytes that are no UTF-8 are replaced.
    pub(crate) output: String,
    /// Where what it has left running still can write to.
    pub(crate) pipe: Option<PipeReader>,
}

/// A command for `program` whose processes may each take so much memory and write files of such a size.
///
/// The shell sets the limits, since setting them between fork and exec takes unsafe code.
pub(crate) fn confined(program: &Path, memory_kb: u32, file_kb: u32) -> Command {
    let mut command = Command::new("/bin/sh");
    // POSIX counts the size of files in blocks of 512 bytes. Not every shell knows every limit.
    let script = format!(
        "ulimit -v {memory_kb} 2>/dev/null; ulimit -f {} 2>/dev/null; ulimit -c 0 2>/dev/null; exec \"$@\"",
        u64::from(file_kb) * 2
    );
    command.arg("-c").arg(script).arg("sh").arg(program);
    command
}

/// Runs it in a process group of its own with empty standard input.
pub(crate) fn run(command: Command, limits: &Limits) -> io::Result<Ended> {
    run_unless(command, limits, &|| false)
}

/// The same; as soon as `is_over` says so, its time is up.
pub(crate) fn run_unless(
    mut command: Command,
    limits: &Limits,
    is_over: &dyn Fn() -> bool,
) -> io::Result<Ended> {
    let deadline = Instant::now() + limits.time;
    let (reader, writer) = io::pipe()?;
    command
        .stdin(Stdio::null())
        .stdout(writer.try_clone()?)
        .stderr(writer)
        .process_group(0);
    signals::unblock(&mut command);
    let child = command.spawn()?;
    // The command holds our copies of the writing end, and the end of the output is only seen without them.
    drop(command);
    let mut running = Running {
        child,
        reader: Some(reader),
        output: Vec::new(),
        output_bytes: limits.output_bytes,
        groups: limits.groups.clone(),
    };
    running.note();
    let status = running.wait(deadline, is_over);
    if !matches!(status, Ok(Some(_))) {
        running.kill();
    }
    Ok(Ended {
        status: status?,
        output: running.text(),
        pipe: running.reader,
    })
}

struct Running {
    child: Child,
    /// Until the end of the output.
    reader: Option<PipeReader>,
    output: Vec<u8>,
    output_bytes: usize,
    groups: Option<Arc<Groups>>,
}

impl Running {
    fn note(&self) {
        if let (Some(groups), Ok(group)) = (&self.groups, i32::try_from(self.child.id())) {
            lock(&groups.0).push(group);
        }
    }

    /// Whether it has ended. From then on its number may be another's, so it is forgotten in the same moment.
    fn try_wait(&mut self) -> io::Result<Option<ExitStatus>> {
        let Some(groups) = &self.groups else {
            return self.child.try_wait();
        };
        let mut noted = lock(&groups.0);
        let group = i32::try_from(self.child.id());
        let status = self.child.try_wait()?;
        if status.is_some() {
            noted.retain(|&other| Ok(other) != group);
        }
        Ok(status)
    }

    /// The status of the process, or nothing when the deadline or the end of all came first.
    fn wait(
        &mut self,
        deadline: Instant,
        is_over: &dyn Fn() -> bool,
    ) -> io::Result<Option<ExitStatus>> {
        loop {
            if self.reader.is_some() {
                self.read_some(COMMAND_LOOK_MS)?;
            } else {
                std::thread::sleep(COMMAND_SETTLE);
            }
            if let Some(status) = self.try_wait()? {
                // A grandchild may keep the pipe open for ever: only what is in it now counts.
                while self.read_some(0)? {}
                return Ok(Some(status));
            }
            if Instant::now() >= deadline || is_over() {
                return Ok(None);
            }
        }
    }

    /// Reads what there is after waiting so long for it; false if there was nothing.
    fn read_some(&mut self, wait_ms: u16) -> io::Result<bool> {
        let Some(reader) = &mut self.reader else {
            return Ok(false);
        };
        let mut watched = [PollFd::new(reader.as_fd(), PollFlags::POLLIN)];
        if poll(&mut watched, PollTimeout::from(wait_ms))? == 0 {
            return Ok(false);
        }
        let mut piece = [0; 4096];
        let size = reader.read(&mut piece)?;
        if size == 0 {
            self.reader = None;
            return Ok(false);
        }
        let room = self.output_bytes - self.output.len();
        self.output.extend_from_slice(&piece[..size.min(room)]);
        Ok(true)
    }

    fn kill(&mut self) {
        // Its number is still its own: nobody has waited for it yet.
        if let Ok(group) = i32::try_from(self.child.id()) {
            let _ = killpg(Pid::from_raw(group), Signal::SIGKILL);
        }
        while matches!(self.try_wait(), Ok(None)) {
            std::thread::sleep(COMMAND_SETTLE);
        }
    }

    fn text(&self) -> String {
        let mut text = String::from_utf8_lossy(&self.output).into_owned();
        if self.output.len() == self.output_bytes {
            text.push_str("\n... (the rest was dropped)");
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shell(script: &str, time_ms: u64, output_bytes: usize) -> Ended {
        let mut command = confined(Path::new("/bin/sh"), 1 << 20, 1 << 10);
        command.args(["-c", script]);
        let limits = Limits {
            time: Duration::from_millis(time_ms),
            output_bytes,
            groups: None,
        };
        run(command, &limits).expect("runs")
    }

    #[test]
    fn both_outputs_and_the_status_come_back() {
        let ended = shell("echo one; echo two >&2; exit 3", 10_000, 100);
        assert_eq!(ended.status.and_then(|status| status.code()), Some(3));
        assert_eq!(ended.output, "one\ntwo\n");
    }

    #[test]
    fn a_process_that_hangs_is_killed_with_its_children() {
        let began = Instant::now();
        let ended = shell("sleep 1000 & echo $!; sleep 1000", 200, 100);
        assert!(ended.status.is_none());
        assert!(began.elapsed() < Duration::from_secs(100));
        let child: i32 = ended.output.trim().parse().expect("the pid of the child");
        // The orphan is a zombie until it is reaped by init; it must not be running.
        let state = std::fs::read_to_string(format!("/proc/{child}/stat")).unwrap_or_default();
        let gone = || state.is_empty() || state.contains(") Z") || state.contains(") X");
        assert!(gone() || killed_soon(child), "{state}");
    }

    fn killed_soon(pid: i32) -> bool {
        let deadline = Instant::now() + Duration::from_secs(10);
        while Instant::now() < deadline {
            match std::fs::read_to_string(format!("/proc/{pid}/stat")) {
                Ok(state) if !state.contains(") Z") && !state.contains(") X") => {
                    std::thread::yield_now()
                }
                _ => return true,
            }
        }
        false
    }

    #[test]
    fn a_program_begins_with_no_signal_blocked() {
        let blocked: nix::sys::signal::SigSet = [Signal::SIGTERM].into_iter().collect();
        blocked.thread_block().expect("this thread's own mask");
        let ended = shell("kill -TERM $$; echo it lives", 20_000, 100);
        blocked.thread_unblock().expect("this thread's own mask");
        let signal = ended.status.and_then(|status| {
            use std::os::unix::process::ExitStatusExt;
            status.signal()
        });
        assert_eq!((signal, &*ended.output), (Some(libc::SIGTERM), ""));
    }

    #[test]
    fn output_beyond_the_limit_is_dropped_without_blocking_the_process() {
        let ended = shell(
            "head -c 1000000 /dev/zero | tr '\\0' x; exit 0",
            20_000,
            1000,
        );
        assert!(ended.status.is_some_and(|status| status.success()));
        assert_eq!(
            ended.output.len(),
            1000 + "\n... (the rest was dropped)".len()
        );
    }

    #[test]
    fn a_grandchild_that_keeps_the_output_open_is_not_waited_for() {
        let began = Instant::now();
        let ended = shell("sleep 30 & echo ${!}; exit 0", 20_000, 100);
        assert!(ended.status.is_some_and(|status| status.success()));
        assert!(began.elapsed() < Duration::from_secs(10));
        let child: i32 = ended.output.trim().parse().expect("the pid of the child");
        nix::sys::signal::kill(Pid::from_raw(child), Signal::SIGKILL).expect("still there");
    }
}
