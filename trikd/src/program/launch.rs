//! The moment between the daemon and a program: a process that gives up rights, takes limits, and becomes the program.
//!
//! What the hidden command `launch` does. Owns what a program may have; knows no languages.

use super::{child, kill};
use crate::error::Error;
use crate::priority::{self, Rank};
use clap::Args;
use nix::sys::prctl;
use nix::sys::resource::{Resource, rlim_t, setrlimit};
use nix::sys::signal::{SigSet, SigmaskHow, Signal};
use nix::unistd::{Gid, Uid, getppid, setgid, setgroups, setsid, setuid};
use std::ffi::OsString;
use std::os::unix::process::CommandExt;
use std::process::Command;

/// Open files of a program.
const OPEN_FILES: u64 = 512;
/// A program goes before the daemon when memory is short (proc(5), oom_score_adj).
const FIRST_TO_GO: &str = "500";

/// Rights and limits of a program.
#[derive(Args, Clone, Debug)]
pub struct Launch {
    /// Process id of the daemon.
    #[arg(long)]
    pub parent: i32,
    /// User to become.
    #[arg(long)]
    pub uid: Option<u32>,
    /// Group to become.
    #[arg(long)]
    pub gid: Option<u32>,
    /// Memory in MiB.
    #[arg(long)]
    pub memory_mib: u64,
    /// Processes.
    #[arg(long)]
    pub processes: u64,
    /// The program and its arguments.
    #[arg(trailing_var_arg = true, allow_hyphen_values = true, required = true)]
    pub program: Vec<OsString>,
}

impl Launch {
    /// Becomes the program; returns only why not.
    pub fn become_program(&self) -> Error {
        if let Err(error) = self.prepare() {
            return Error::Launch(error.into());
        }
        if getppid().as_raw() != self.parent {
            return Error::DaemonGone;
        }
        let Some((program, arguments)) = self.program.split_first() else {
            return Error::NoProgram;
        };
        let mut command = Command::new(program);
        if program == child::SELF {
            command.arg0(child::NAME);
        }
        let error = command.args(arguments).exec();
        Error::Execute(program.to_string_lossy().into_owned(), error.into())
    }

    fn prepare(&self) -> nix::Result<()> {
        // Fails only for who leads a group already, which is what is wanted.
        let _ = setsid();
        SigSet::empty().thread_swap_mask(SigmaskHow::SIG_SETMASK)?;
        priority::set(Rank::Program);
        let _ = std::fs::write("/proc/self/oom_score_adj", FIRST_TO_GO);
        let memory = self.memory_mib.saturating_mul(1 << 20);
        limit(Resource::RLIMIT_AS, memory)?;
        limit(Resource::RLIMIT_NOFILE, OPEN_FILES)?;
        limit(Resource::RLIMIT_CORE, 0)?;
        let user = self.uid.map_or_else(Uid::current, Uid::from_raw);
        // The kernel counts all processes of the user, so those that are there already do not count.
        let processes = self.processes.saturating_add(kill::of_user(user));
        limit(Resource::RLIMIT_NPROC, processes)?;
        if let Some(gid) = self.gid {
            let gid = Gid::from_raw(gid);
            setgroups(&[gid])?;
            setgid(gid)?;
        }
        if self.uid.is_some() {
            setuid(user)?;
            prctl::set_no_new_privs()?;
        }
        // Last, because a change of the user clears it.
        prctl::set_pdeathsig(Signal::SIGKILL)
    }
}

/// At most so much of it. What a word of a 32-bit processor cannot hold is more than such a process could ever have.
fn limit(resource: Resource, most: u64) -> nix::Result<()> {
    let most = rlim_t::try_from(most).unwrap_or(rlim_t::MAX);
    setrlimit(resource, most, most)
}
