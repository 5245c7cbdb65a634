//! What the bench counts, and what it says of it.
//!
//! Owns the counts, who is inside a call, the end of the run and the verdict. Knows no fault and no load.

use crate::robot::Robot;
use std::collections::BTreeMap;
use std::fmt::{self, Debug, Write};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// A call that lasts longer hangs.
const HUNG: Duration = Duration::from_secs(15);
/// Findings that are told in words.
const TOLD: usize = 12;
/// After a fault calls may fail for so long.
const DISTURBED: Duration = Duration::from_secs(4);
/// Longest time to rest that the verdict lets pass; the goals are in docs/maintainer/reliability.md.
const REST_MOST: Duration = Duration::from_secs(3);

/// Memory and open things of the processes at one moment.
#[derive(Clone, Debug, Default)]
pub struct Footprint(BTreeMap<&'static str, Process>);

#[derive(Clone, Copy, Debug, Default)]
struct Process {
    pid: u32,
    bytes: u64,
    files: usize,
    threads: usize,
}

impl Footprint {
    /// Now.
    pub fn of(robot: &Robot) -> Self {
        let all = [
            ("guardian of the tree", Some(robot.mount.guardian())),
            ("daemon of the tree", robot.daemon()),
            ("guardian of trikd", Some(robot.trikd_guardian())),
            ("trikd", robot.trikd()),
        ];
        let count = |pid: u32, what: &str| {
            std::fs::read_dir(format!("/proc/{pid}/{what}")).map_or(0, Iterator::count)
        };
        Self(
            all.into_iter()
                .filter_map(|(name, pid)| Some((name, pid?)))
                .map(|(name, pid)| {
                    let process = Process {
                        pid,
                        bytes: own_bytes(pid),
                        files: count(pid, "fd"),
                        threads: count(pid, "task"),
                    };
                    (name, process)
                })
                .collect(),
        )
    }
}

/// Memory that a process has for itself: pages of its program come in as they are needed first, and are no growth.
fn own_bytes(pid: u32) -> u64 {
    let status = std::fs::read_to_string(format!("/proc/{pid}/status")).unwrap_or_default();
    let line = status
        .lines()
        .find_map(|line| line.strip_prefix("RssAnon:"));
    let kib = line.and_then(|line| line.trim().strip_suffix(" kB")?.trim().parse::<u64>().ok());
    kib.unwrap_or(0) * 1024
}

/// Why a run was not good.
#[derive(Clone, Copy, Debug)]
pub enum Bad {
    /// So many things that must not be.
    Findings(u64),
    /// No motor came to rest, so nothing was shown.
    NothingTried,
    /// A motor ran on for so long.
    RanOn(Duration),
}

impl fmt::Display for Bad {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Findings(count) => write!(out, "{count} findings"),
            Self::NothingTried => out.write_str("nothing was tried: no motor came to rest"),
            Self::RanOn(time) => write!(out, "a motor ran on for {time:?}"),
        }
    }
}

#[derive(Default)]
struct State {
    over: bool,
    operations: BTreeMap<&'static str, u64>,
    errors: u64,
    wrong: Vec<String>,
    wrong_count: u64,
    hung: u64,
    /// By the name of the fault.
    rests: BTreeMap<&'static str, Vec<Duration>>,
    /// Until when calls may fail.
    disturbed: Option<Instant>,
    /// Until when samples may be late.
    slowed: Option<Instant>,
    /// What was done last, and when.
    last: Option<(&'static str, Instant)>,
    begin: Footprint,
    end: Footprint,
    length: Duration,
}

/// The counts of one run.
pub struct Figures {
    state: Mutex<State>,
    changed: Condvar,
}

impl Figures {
    /// Nothing yet.
    pub fn new() -> Self {
        Self {
            state: Mutex::default(),
            changed: Condvar::new(),
        }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Waits for so long, or until the run is over.
    pub fn pause(&self, time: Duration) {
        let state = self.lock();
        let waited = self
            .changed
            .wait_timeout_while(state, time, |state| !state.over);
        drop(waited.unwrap_or_else(PoisonError::into_inner));
    }

    /// Ends the run.
    pub fn end(&self) {
        self.lock().over = true;
        self.changed.notify_all();
    }

    /// Whether the run has ended.
    pub fn is_over(&self) -> bool {
        self.lock().over
    }

    /// A fault comes now: calls may fail for a while.
    pub fn disturb(&self, time: Duration) {
        self.lock().disturbed = Some(Instant::now() + time + DISTURBED);
    }

    /// A tracer comes now, for about so long: all threads stand still for a moment, so samples may be late.
    pub fn slow(&self, time: Duration) {
        self.lock().slowed = Some(Instant::now() + time);
    }

    /// What is done now, for the words of a finding.
    pub fn doing(&self, fault: &'static str) {
        self.lock().last = Some((fault, Instant::now()));
    }

    /// Makes a call and counts it. An error counts as a finding unless something was done to the robot a moment before or
    /// since; a result that is wrong always does.
    pub fn call<T: Debug>(
        &self,
        kind: &'static str,
        call: impl FnOnce() -> std::io::Result<T>,
        is_right: impl FnOnce(&T) -> bool,
    ) {
        let begun = Instant::now();
        let result = call();
        let took = begun.elapsed();
        let mut state = self.lock();
        *state.operations.entry(kind).or_default() += 1;
        let is_disturbed = state.disturbed.is_some_and(|until| begun < until);
        if took > HUNG {
            state.hung += 1;
            state.find(format!("{kind} took {took:?}"));
        }
        match result {
            Ok(value) if is_right(&value) => {}
            Ok(value) => state.find(format!("{kind} gave {value:?}")),
            Err(_) if is_disturbed => state.errors += 1,
            Err(error)
                if error.raw_os_error() == Some(libc::ETIMEDOUT)
                    && state.slowed.is_some_and(|until| begun < until) =>
            {
                state.errors += 1;
            }
            Err(error) => {
                let last = state.last.map_or_else(String::new, |(fault, when)| {
                    format!("; the last thing was {fault}, {:.1?} before", begun - when)
                });
                state.find(format!(
                    "{kind}: {error}, although nothing was killed{last}"
                ));
            }
        }
    }

    /// Something that must not be.
    pub fn wrong(&self, what: String) {
        self.lock().find(what);
    }

    /// The motor came to rest so long after this fault; None: it did not.
    pub fn rested(&self, fault: &'static str, after: Option<Duration>) {
        let mut state = self.lock();
        match after {
            Some(after) => state.rests.entry(fault).or_default().push(after),
            None => state.find(format!("{fault}: the motor did not come to rest")),
        }
    }

    /// After the warm-up.
    pub fn note_begin(&self, footprint: Footprint) {
        self.lock().begin = footprint;
    }

    /// After the last call.
    pub fn note_end(&self, footprint: Footprint, length: Duration) {
        let mut state = self.lock();
        state.end = footprint;
        state.length = length;
    }

    /// One line while it runs.
    pub fn progress(&self) -> String {
        let state = self.lock();
        let faults: usize = state.rests.values().map(Vec::len).sum();
        format!(
            "{} calls, {} faults, {} errors during faults, {} findings",
            state.operations.values().sum::<u64>(),
            faults,
            state.errors,
            state.wrong_count
        )
    }

    /// All figures, for people.
    pub fn table(&self) -> String {
        let state = self.lock();
        let mut out = String::from("\ncalls\n");
        for (kind, count) in &state.operations {
            let _ = writeln!(out, "  {count:9}  {kind}");
        }
        let _ = writeln!(
            out,
            "  {:9}  errors while something was killed or traced",
            state.errors
        );
        let _ = writeln!(
            out,
            "  {:9}  findings: wrong results, errors without a cause",
            state.wrong_count
        );
        let _ = writeln!(out, "  {:9}  callers that hung", state.hung);
        out.push_str("\nmotor at rest after: times, median, 99 of 100, worst in ms\n");
        for (fault, times) in &state.rests {
            let mut times = times.clone();
            times.sort_unstable();
            let at = |part: usize| {
                let index = (times.len() * part / 100).min(times.len() - 1);
                times[index].as_secs_f64() * 1000.0
            };
            let _ = writeln!(
                out,
                "  {:5} {:8.1} {:8.1} {:8.1}  {fault}",
                times.len(),
                at(50),
                at(99),
                at(100)
            );
        }
        out.push_str("\nown resident KiB, open files, threads: after the warm-up, at the end; growth an hour if it is the same process\n");
        let hours = state.length.as_secs_f64() / 3600.0;
        for (name, end) in &state.end.0 {
            let begin = state.begin.0.get(name).copied().unwrap_or_default();
            let growth = (end.bytes as f64 - begin.bytes as f64) / 1024.0 / hours;
            let growth = if begin.pid == end.pid {
                format!("{growth:.0} KiB/h")
            } else {
                "another process".to_owned()
            };
            let shown = |process: &Process| {
                format!(
                    "{:7} {:4} {:3}",
                    process.bytes / 1024,
                    process.files,
                    process.threads
                )
            };
            let _ = writeln!(
                out,
                "  {}   {}  {name}: {growth}",
                shown(&begin),
                shown(end)
            );
        }
        for what in &state.wrong {
            let _ = writeln!(out, "found: {what}");
        }
        out
    }

    /// Whether the run was good.
    ///
    /// # Errors
    /// Why it was not.
    pub fn verdict(&self) -> Result<(), Bad> {
        let state = self.lock();
        let worst = state.rests.values().flatten().max().copied();
        if state.wrong_count > 0 {
            return Err(Bad::Findings(state.wrong_count));
        }
        match worst {
            None => Err(Bad::NothingTried),
            Some(worst) if worst > REST_MOST => Err(Bad::RanOn(worst)),
            Some(_) => Ok(()),
        }
    }
}

impl State {
    fn find(&mut self, what: String) {
        self.wrong_count += 1;
        if self.wrong.len() < TOLD {
            self.wrong.push(what);
        }
    }
}
