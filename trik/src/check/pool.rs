//! Many runs on all cores: processes that do one run after another, and the thread that watches them.
//!
//! Owns the processes. A run that crashes, eats its memory or hangs takes only its process with it: another one is started
//! and does the rest. Results come in the order of the runs; a process that is far ahead waits, so memory is bounded.

use super::args::CheckArgs;
use super::jobs::{Job, shown};
use super::row::Row;
use super::run::report;
use super::{words, worker};
use crate::error::Error;
use crate::limits;
use crate::refusal::Refusal;
use crate::sandbox;
use sim::judge;
use std::ffi::OsString;
use std::fs::File;
use std::io::{self, BufRead, BufReader, Read, Write};
use std::os::unix::ffi::OsStrExt;
use std::os::unix::process::{CommandExt, ExitStatusExt};
use std::path::PathBuf;
use std::process::{Child, ChildStdin, Command, ExitStatus, Stdio};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

/// This program, whatever has happened to its file since it was started.
const SELF: &str = "/proc/self/exe";
/// Where the mark of a process comes from.
const RANDOM: &str = "/dev/urandom";

/// Which run is next, and which is the first that has not been told.
#[derive(Debug, Default)]
struct Progress {
    next: usize,
    told: usize,
    is_over: bool,
}

#[derive(Debug, Default)]
struct Shared {
    progress: Mutex<Progress>,
    has_moved: Condvar,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, Progress> {
        self.progress.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The next run for somebody, when it is not too far ahead.
    fn take(&self, count: usize) -> Option<usize> {
        let mut progress = self.lock();
        loop {
            if progress.is_over || progress.next >= count {
                return None;
            }
            if progress.next < progress.told + limits::RUNS_AHEAD_MAX {
                progress.next += 1;
                return Some(progress.next - 1);
            }
            progress = self
                .has_moved
                .wait(progress)
                .unwrap_or_else(PoisonError::into_inner);
        }
    }
}

/// Does all runs in processes, and gives each result to `take` in order; stops early if that says so. `hear` is told of each
/// when it comes.
///
/// # Errors
/// What `take` says.
pub(super) fn run(
    jobs: &[Job],
    args: &CheckArgs,
    mut hear: impl FnMut(usize, &Row),
    mut take: impl FnMut(usize, Row) -> Result<(), Refusal>,
) -> Result<(), Refusal> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let crew = args
        .jobs
        .map_or(cores, usize::from)
        .clamp(1, jobs.len().max(1));
    let shared = Shared::default();
    let (send, results) = sync_channel::<(usize, Row)>(crew * 2);
    let done = thread::scope(|scope| {
        for _ in 0..crew {
            let (send, shared) = (send.clone(), &shared);
            scope.spawn(move || feed(jobs, args, shared, &send));
        }
        drop(send);
        let done = in_order(&shared, &results, &mut hear, &mut take);
        shared.lock().is_over = true;
        shared.has_moved.notify_all();
        // A thread that waits for room is let go.
        drop(results);
        done
    });
    // A process that was killed has removed no group of its program.
    if let Some(group) = &args.sandbox.group {
        sandbox::sweep(group);
    }
    done
}

/// Does one run, whose outputs are files, in a process.
pub(super) fn run_one(job: Job, args: &CheckArgs) -> Row {
    let args = CheckArgs {
        is_one: true,
        ..args.clone()
    };
    let mut found = None;
    let jobs = [job];
    // Nothing is refused here, and there is one result.
    let take = |_, row| {
        found = Some(row);
        Ok(())
    };
    let _ = run(&jobs, &args, |_, _| {}, take);
    found
        .unwrap_or_else(|| Row::broken(shown(jobs[0].judged(&args)), None, "it was not run".into()))
}

fn in_order(
    shared: &Shared,
    results: &Receiver<(usize, Row)>,
    hear: &mut impl FnMut(usize, &Row),
    take: &mut impl FnMut(usize, Row) -> Result<(), Refusal>,
) -> Result<(), Refusal> {
    let mut early = std::collections::BTreeMap::new();
    let mut next = 0;
    for (index, row) in results {
        hear(index, &row);
        early.insert(index, row);
        while let Some(row) = early.remove(&next) {
            take(next, row)?;
            next += 1;
        }
        shared.lock().told = next;
        shared.has_moved.notify_all();
    }
    Ok(())
}

/// Takes runs for one process until there are none.
fn feed(jobs: &[Job], args: &CheckArgs, shared: &Shared, send: &SyncSender<(usize, Row)>) {
    let mut slot = Slot::new(args);
    while let Some(index) = shared.take(jobs.len()) {
        let job = &jobs[index];
        let row = slot.row(job, args).unwrap_or_else(|why| {
            let mut row = broken(job, args, &why);
            let said = row.messages.clone();
            report(job, args, &mut row, &said);
            row
        });
        if send.send((index, row)).is_err() {
            return;
        }
    }
}

/// A run that its process has not done.
pub(super) fn broken(job: &Job, args: &CheckArgs, why: &Error) -> Row {
    let rules = job.rules(args).map(shown);
    Row::broken(shown(job.judged(args)), rules, why.to_string())
}

/// Does one run after another in a process, and starts another one when that has died.
pub(super) struct Slot {
    worker: Option<Worker>,
    words: Vec<OsString>,
}

impl Slot {
    /// For runs with these options.
    pub fn new(args: &CheckArgs) -> Self {
        Self {
            worker: None,
            words: args.for_worker(),
        }
    }

    /// Does a run.
    ///
    /// # Errors
    /// Its process cannot be started, has died, or has said nothing in time.
    pub fn row(&mut self, job: &Job, args: &CheckArgs) -> Result<Row, Error> {
        let done = self.done(job, args);
        if done.is_err() {
            // Whatever it was, the next run gets a fresh process.
            self.worker = None;
        }
        done
    }

    fn done(&mut self, job: &Job, args: &CheckArgs) -> Result<Row, Error> {
        let worker = match &mut self.worker {
            Some(worker) => worker,
            worker => {
                let fresh = Worker::start(&self.words);
                let fresh = fresh.map_err(|error| Error::system("no process", error))?;
                worker.insert(fresh)
            }
        };
        let line = worker.ask(job, args)?;
        let strange =
            || Error::Process("the process that ran it said something strange".to_owned());
        Row::read(&line).ok_or_else(strange)
    }
}

/// A process that does runs. Dropping it kills it.
struct Worker {
    child: Child,
    /// What its lines begin with; programs that it runs do not know it, and their lines are passed over.
    mark: String,
    stdin: Option<ChildStdin>,
    lines: Receiver<String>,
}

impl Worker {
    fn start(words: &[OsString]) -> io::Result<Self> {
        let mut random = [0; 16];
        File::open(RANDOM)?.read_exact(&mut random)?;
        let mark = format!("{:032x} ", u128::from_ne_bytes(random));
        let mut child = Command::new(SELF)
            .arg0("trik")
            .args(words)
            .stdin(Stdio::piped())
            .stdout(Stdio::piped())
            .spawn()?;
        let (mut stdin, stdout) = (child.stdin.take(), child.stdout.take());
        if let Some(stdin) = &mut stdin {
            // Should it have died already, the first job finds out.
            let _ = writeln!(stdin, "{mark}");
        }
        let (send, lines) = sync_channel(1);
        thread::spawn(move || {
            let mut reader = stdout.map(BufReader::new);
            while let Some(reader) = reader.as_mut() {
                let mut line = Vec::new();
                let most = limits::ROW_BYTES_MAX as u64;
                let read = reader.by_ref().take(most).read_until(b'\n', &mut line);
                // Whatever it is: only a line with the mark counts.
                let line = String::from_utf8_lossy(&line).into_owned();
                if !matches!(read, Ok(1..)) || send.send(line).is_err() {
                    return;
                }
            }
        });
        Ok(Self {
            child,
            mark,
            stdin,
            lines,
        })
    }

    /// Has a run done.
    fn ask(&mut self, job: &Job, args: &CheckArgs) -> Result<String, Error> {
        let mut bytes = Vec::new();
        let path = |path: &'_ Option<PathBuf>| path.clone().unwrap_or_default();
        let (field, log, given) = (path(&job.field), path(&job.log), path(&job.given));
        let inputs = path(&job.inputs);
        for path in [&job.solution, &field, &log, &given, &inputs, &job.name] {
            bytes.extend_from_slice(path.as_os_str().as_bytes());
            bytes.push(0);
        }
        let written = self.stdin.as_mut().map(|stdin| stdin.write_all(&bytes));
        if !matches!(written, Some(Ok(()))) {
            return Err(self.died());
        }
        let limit = Duration::from_secs_f64(args.wall_limit);
        let ms = |ms: u32| Duration::from_millis(u64::from(ms));
        let mut end = Instant::now() + limit + ms(limits::WORKER_GRACE_MS);
        let mut runs = false;
        loop {
            let left = end.saturating_duration_since(Instant::now());
            match self.lines.recv_timeout(left) {
                Ok(line) => {
                    let Some(said) = line.strip_prefix(&*self.mark) else {
                        continue;
                    };
                    match said.trim_end() {
                        worker::RUNS => {
                            end = Instant::now() + limit + ms(limits::RUN_GRACE_MS);
                            runs = true;
                        }
                        worker::ENDED => {
                            end = Instant::now() + ms(limits::WORKER_GRACE_MS);
                            runs = false;
                        }
                        _ => return Ok(said.to_owned()),
                    }
                }
                Err(RecvTimeoutError::Disconnected) => return Err(self.died()),
                Err(RecvTimeoutError::Timeout) => {
                    let why = match runs {
                        true => judge::too_slow(args.wall_limit),
                        false => words::hung(),
                    };
                    return Err(Error::Process(why.in_locale(args.language).to_owned()));
                }
            }
        }
    }

    /// What has become of it.
    fn died(&mut self) -> Error {
        // One that only has closed its pipes would be waited for without end.
        let _ = self.child.kill();
        let status = self.child.wait().unwrap_or(ExitStatus::from_raw(0));
        Error::Process(match status.signal() {
            Some(6) => "the process that ran it has crashed, perhaps for want of memory: --memory is its limit".to_owned(),
            Some(signal) => format!("the process that ran it was killed by signal {signal}"),
            None => format!("the process that ran it has ended: {status}"),
        })
    }
}

impl Drop for Worker {
    fn drop(&mut self) {
        drop(self.stdin.take());
        let _ = self.child.kill();
        let _ = self.child.wait();
    }
}
