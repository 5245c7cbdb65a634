//! The process that does runs for another one: jobs on standard input, a line of JSON for each on standard output.
//!
//! Owns its limit of memory and its end with its parent. A run that panics is told as one that could not be run. Programs in
//! Python can find its standard output, so each line begins with a mark that only this process and its parent know.

use super::args::CheckArgs;
use super::jobs::{Job, shown};
use super::row::Row;
use super::run::{self, Phase};
use crate::error::Error;
use crate::limits;
use nix::sys::prctl::{set_dumpable, set_pdeathsig};
use nix::sys::resource::{Resource, rlim_t, setrlimit};
use nix::sys::signal::Signal;
use nix::sys::wait::{WaitPidFlag, WaitStatus, waitpid};
use nix::unistd::Pid;
use std::ffi::OsString;
use std::io::{self, BufRead, Read, Write};
use std::os::unix::ffi::OsStringExt;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::time::Duration;
use trikd::program::kill::{adopt_orphans, sweep};

/// What is told when the program of a run begins, and when it has ended.
pub(super) const RUNS: &str = "runs";
/// See [`RUNS`].
pub(super) const ENDED: &str = "ended";

/// Serves until there are no more jobs.
///
/// # Errors
/// The pipes, and what the system says of limits.
pub(super) fn serve(args: &CheckArgs) -> Result<(), Error> {
    set_pdeathsig(Signal::SIGKILL).map_err(|error| Error::system("worker", error))?;
    // The program that has started it may keep signals from its threads, and with them from this process.
    crate::up::session::let_in().map_err(|error| Error::system("signals", error))?;
    // Programs that it starts have the same user, and look neither into its memory nor at its pipes.
    set_dumpable(false).map_err(|error| Error::system("worker", error))?;
    adopt_orphans().map_err(|why| Error::Refused(why.to_string()))?;
    limit_memory(args).map_err(|error| Error::system("--memory", error))?;
    let mut input = io::stdin().lock();
    let mut output = io::stdout().lock();
    let mut mark = String::new();
    let read = input
        .by_ref()
        .take(limits::JOB_BYTES_MAX)
        .read_line(&mut mark);
    read.map_err(|error| Error::system("jobs", error))?;
    let mark = mark.trim_end_matches('\n');
    while let Some(job) = next(&mut input).map_err(|error| Error::system("jobs", error))? {
        let row = guarded(&job, args, &mut |phase| {
            let word = match phase {
                Phase::Runs => RUNS,
                Phase::Ended => ENDED,
            };
            // A reader that has gone away has killed this process.
            let _ = output.write_all(format!("\n{mark}{word}\n").as_bytes());
            let _ = output.flush();
        });
        sweep_all();
        // On a line of its own, whatever somebody else has begun.
        let line = format!("\n{mark}{}\n", row.write());
        let written = output.write_all(line.as_bytes());
        written
            .and_then(|()| output.flush())
            .map_err(|error| Error::system("results", error))?;
    }
    Ok(())
}

/// Ends what a program in Python has started and left behind, wherever it has put itself: a process that loses its parent
/// becomes a child of this process.
fn sweep_all() {
    for _ in 0..limits::SWEEPS {
        // Without children, as after nearly all runs, this fails at once.
        while waitpid(None, Some(WaitPidFlag::WNOHANG))
            .is_ok_and(|one| one != WaitStatus::StillAlive)
        {}
        if waitpid(None, Some(WaitPidFlag::WNOHANG)).is_err() {
            return;
        }
        sweep(Pid::this(), &[]);
        std::thread::sleep(Duration::from_millis(1));
    }
}

/// Holds this process to its memory, so that an overflow ends it and nobody else.
fn limit_memory(args: &CheckArgs) -> nix::Result<()> {
    let most = rlim_t::from(args.memory) << 20;
    setrlimit(Resource::RLIMIT_AS, most, most)?;
    // A crash is expected: nobody wants its memory on the disk.
    setrlimit(Resource::RLIMIT_CORE, 0, 0)
}

/// Does a run; a panic in it is its result.
fn guarded(job: &Job, args: &CheckArgs, report_phase: &mut dyn FnMut(Phase)) -> Row {
    catch_unwind(AssertUnwindSafe(|| run::run(job, args, report_phase))).unwrap_or_else(|_| {
        let field = job.rules(args).map(shown);
        let why = "trik has a defect and cannot judge this: please report it with this file";
        Row::broken(shown(job.judged(args)), field, why.to_owned())
    })
}

fn next(input: &mut impl BufRead) -> io::Result<Option<Job>> {
    let mut parts: [Vec<u8>; 6] = Default::default();
    for part in &mut parts {
        input
            .by_ref()
            .take(limits::JOB_BYTES_MAX)
            .read_until(0, part)?;
        if part.pop() != Some(0) {
            return Ok(None);
        }
    }
    let [solution, field, log, given, inputs, name] =
        parts.map(|part| PathBuf::from(OsString::from_vec(part)));
    Ok(Some(Job {
        solution,
        field: Some(field).filter(|field| !field.as_os_str().is_empty()),
        log: Some(log).filter(|log| !log.as_os_str().is_empty()),
        given: Some(given).filter(|given| !given.as_os_str().is_empty()),
        inputs: Some(inputs).filter(|inputs| !inputs.as_os_str().is_empty()),
        name,
    }))
}
