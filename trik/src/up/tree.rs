//! A mount of a robot as a child process: trikfs, or the view of ev3dev, out of this same program; its ready line, its
//! words, its end.
//!
//! The child is in a process group of its own, so that Ctrl-C reaches only its parent, who ends things in order. If the
//! parent dies without a word the kernel tells the child, which then unmounts as after any SIGTERM.
//! Knows nothing of boards.

use crate::error::Error;
use crate::limits;
use nix::fcntl::{FcntlArg, OFlag, fcntl};
use nix::sys::prctl::set_pdeathsig;
use nix::sys::signal::{SigSet, SigmaskHow, Signal, kill};
use nix::unistd::{Pid, getppid};
use std::ffi::OsString;
use std::io::{self, Read};
use std::os::fd::{AsFd, BorrowedFd, OwnedFd};
use std::os::unix::process::CommandExt;
use std::process::{Child, Command, ExitStatus, Stdio};

/// This program, whatever has happened to its file since it was started.
const SELF: &str = "/proc/self/exe";

/// What the hidden command `tree` does: replaces this process by the program of this name, which ends with `parent`.
/// Returns why not.
pub(crate) fn become_program(parent: u32, name: &str, arguments: &[OsString]) -> Error {
    // The parent waits for these; a program begins without.
    let reset = SigSet::empty().thread_swap_mask(SigmaskHow::SIG_SETMASK);
    if let Err(error) = reset.and_then(|_| set_pdeathsig(Signal::SIGTERM)) {
        return Error::system("tree", error);
    }
    // It may have died before the line above, and then no signal comes.
    if u32::try_from(getppid().as_raw()) != Ok(parent) {
        return Error::system("tree", "the process that started this one is gone");
    }
    let error = Command::new(SELF).arg0(name).args(arguments).exec();
    Error::system(format!("tree: {SELF}"), error)
}

/// A running guardian. Dropping it kills it, and its daemon then cleans up by itself.
pub(super) struct Tree {
    child: Child,
    /// Ends with the guardian.
    pub(super) said: Lines,
    /// Ends with guardian and daemon.
    pub(super) complaints: Lines,
}

impl Tree {
    /// Starts this program under a name with these arguments. Call it in a thread that lives as long as the process: the
    /// kernel takes its end for the parent's.
    pub(super) fn start(name: &str, arguments: &[OsString]) -> io::Result<Self> {
        let mut child = Command::new(SELF)
            .arg0("trik")
            .arg("tree")
            .arg(std::process::id().to_string())
            .arg(name)
            .args(arguments)
            .stdin(Stdio::null())
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            // Ready is what the robot is, not its tree alone.
            .env_remove("NOTIFY_SOCKET")
            .process_group(0)
            .spawn()?;
        let missing = || io::Error::other("no pipe");
        let said = child.stdout.take().ok_or_else(missing)?;
        let complaints = child.stderr.take().ok_or_else(missing)?;
        Ok(Self {
            said: Lines::new(said.into())?,
            complaints: Lines::new(complaints.into())?,
            child,
        })
    }

    /// Asks it to end.
    pub(super) fn terminate(&self) {
        self.signal(Signal::SIGTERM);
    }

    /// Ends the guardian; the daemon then cleans up by itself.
    pub(super) fn kill(&self) {
        self.signal(Signal::SIGKILL);
    }

    fn signal(&self, signal: Signal) {
        // The number is its own until `wait`: a dead child keeps it.
        if let Ok(pid) = i32::try_from(self.child.id()) {
            let _ = kill(Pid::from_raw(pid), signal);
        }
    }

    /// How it ended; call it when nothing more will be said.
    pub(super) fn wait(&mut self) -> io::Result<ExitStatus> {
        self.child.wait()
    }
}

impl Drop for Tree {
    fn drop(&mut self) {
        if let Ok(None) = self.child.try_wait() {
            self.kill();
            let _ = self.child.wait();
        }
    }
}

/// The lines of a pipe, without waiting for them.
pub(super) struct Lines {
    pipe: Option<std::fs::File>,
    heard: Vec<u8>,
}

impl Lines {
    fn new(pipe: OwnedFd) -> io::Result<Self> {
        let flags = OFlag::from_bits_retain(fcntl(&pipe, FcntlArg::F_GETFL)?);
        fcntl(&pipe, FcntlArg::F_SETFL(flags | OFlag::O_NONBLOCK))?;
        Ok(Self {
            pipe: Some(pipe.into()),
            heard: Vec::new(),
        })
    }

    /// Readable when there is something to hear; nothing after the end.
    pub(super) fn fd(&self) -> Option<BorrowedFd<'_>> {
        self.pipe.as_ref().map(AsFd::as_fd)
    }

    /// Nobody can say anything any more.
    pub(super) fn is_over(&self) -> bool {
        self.pipe.is_none()
    }

    /// The whole lines that have come; at the end also one that is not whole. Longer ones are cut in pieces.
    pub(super) fn hear(&mut self) -> Vec<String> {
        let mut piece = [0; 4096];
        while let Some(pipe) = &mut self.pipe {
            match pipe.read(&mut piece) {
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => break,
                Ok(size) if size > 0 => {
                    self.heard.extend_from_slice(&piece[..size]);
                    if self.heard.len() >= limits::LINE_BYTES_MAX {
                        break;
                    }
                }
                Ok(_) | Err(_) => self.pipe = None,
            }
        }
        let whole = match self.heard.iter().rposition(|&byte| byte == b'\n') {
            _ if self.is_over() || self.heard.len() >= limits::LINE_BYTES_MAX => self.heard.len(),
            Some(end) => end + 1,
            None => 0,
        };
        let text: Vec<u8> = self.heard.drain(..whole).collect();
        let text = String::from_utf8_lossy(&text);
        text.lines().map(str::to_owned).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    #[test]
    fn lines_come_whole_and_the_end_is_noticed() {
        let (reader, mut writer) = io::pipe().expect("a pipe");
        let mut lines = Lines::new(reader.into()).expect("lines");
        assert_eq!(lines.hear(), Vec::<String>::new());
        writer.write_all(b"one\ntwo\nthr").expect("written");
        assert_eq!(lines.hear(), ["one", "two"]);
        writer.write_all(b"ee").expect("written");
        drop(writer);
        assert_eq!(lines.hear(), ["three"]);
        assert!(lines.is_over() && lines.fd().is_none());
    }

    #[test]
    fn a_line_without_end_does_not_grow_for_ever() {
        let (reader, mut writer) = io::pipe().expect("a pipe");
        let mut lines = Lines::new(reader.into()).expect("lines");
        let mut heard = 0;
        for _ in 0..10 {
            writer.write_all(&[b'x'; 8192]).expect("written");
            heard += lines.hear().iter().map(String::len).sum::<usize>();
            assert!(lines.heard.len() < limits::LINE_BYTES_MAX);
        }
        assert!(heard > 5 * limits::LINE_BYTES_MAX / 2);
    }
}
