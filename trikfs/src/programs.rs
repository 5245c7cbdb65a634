//! Programs that sensors need: started for the first user of one, stopped a moment after the last.
//!
//! Owns the order of start and stop, which for one program never overlap, and their limits. Each program is started
//! and stopped by a thread of its own, never by one that serves the kernel or samples. A start that has failed is not
//! tried again for a while. Knows no device and no node.

mod texts;

use crate::command::{self, Ended, Groups, Limits};
use crate::errno::Error;
use crate::events::lock;
use crate::limits;
use crate::log::Log;
use config::description::CommandDescription;
use std::io::Read;
use std::process::Command;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// All programs of one mount.
pub struct Programs {
    log: Arc<Log>,
    all: Mutex<Vec<Arc<Program>>>,
    /// Those that are run once for each text.
    text_queues: Mutex<Vec<texts::TextQueue>>,
    /// The mount ends.
    is_ending: AtomicBool,
    /// Everything that runs now.
    pub(crate) groups: Arc<Groups>,
}

/// How to start and stop a program.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Commands {
    /// Ends well when the program is up.
    pub start: CommandDescription,
    /// Ends when it is down.
    pub stop: Option<CommandDescription>,
}

/// How far a program is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Progress {
    /// It is being started, or stopped to be started.
    Starting,
    /// The start ended well at this time.
    Up(Instant),
    /// It did not.
    Failed(String),
}

struct Program {
    commands: Commands,
    log: Arc<Log>,
    groups: Arc<Groups>,
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    users: usize,
    /// A thread works on it.
    is_worked_on: bool,
    up_since: Option<Instant>,
    /// What it makes was seen since it is up.
    was_seen: bool,
    /// It has to be stopped although it is used.
    must_restart: bool,
    failure: Option<(Instant, String)>,
    idle_since: Option<Instant>,
    /// The mount ends.
    is_ending: bool,
}

/// What a program needs next.
enum Job {
    Start,
    Stop,
    /// To be looked at again, unless something happens before.
    Wait(Duration),
    Nothing,
}

/// One user of a program. It is up for as long as there is one.
pub struct Use(Arc<Program>);

impl Programs {
    /// None is up yet.
    pub fn new(log: Arc<Log>) -> Arc<Self> {
        Arc::new(Self {
            log,
            all: Mutex::default(),
            text_queues: Mutex::default(),
            is_ending: AtomicBool::new(false),
            groups: Arc::default(),
        })
    }

    /// Begins to use a program, and starts it if nobody did. `is_there`: what it makes can be seen now; if that was
    /// so before and is no more, it is stopped and started again.
    pub fn use_one(&self, commands: &Commands, is_there: bool) -> Result<Use, Error> {
        let program = {
            let mut all = lock(&self.all);
            all.retain(|program| Arc::strong_count(program) > 1 || lock(&program.state).is_busy());
            match all.iter().find(|program| program.commands == *commands) {
                Some(program) => program.clone(),
                None => {
                    let program = Arc::new(Program {
                        commands: commands.clone(),
                        log: self.log.clone(),
                        groups: self.groups.clone(),
                        state: Mutex::default(),
                        changed: Condvar::new(),
                    });
                    all.push(program.clone());
                    program
                }
            }
        };
        program.join(is_there)
    }

    /// Stops everything that is up, and waits for it, at most so long.
    pub fn stop_all(&self, limit: Duration) {
        self.is_ending.store(true, Ordering::Relaxed);
        let deadline = Instant::now() + limit;
        let all: Vec<_> = lock(&self.all).clone();
        for program in &all {
            let mut state = lock(&program.state);
            state.is_ending = true;
            program.employ(&mut state);
        }
        for program in &all {
            let mut state = lock(&program.state);
            while state.is_worked_on {
                let left = deadline.saturating_duration_since(Instant::now());
                if left.is_zero() {
                    break;
                }
                let waited = program.changed.wait_timeout(state, left);
                state = waited.unwrap_or_else(PoisonError::into_inner).0;
            }
        }
    }
}

impl State {
    fn is_busy(&self) -> bool {
        self.users > 0
            || self.is_worked_on
            || self.up_since.is_some()
            || self.recent_failure().is_some()
    }

    fn recent_failure(&self) -> Option<&str> {
        let (at, what) = self.failure.as_ref()?;
        (at.elapsed() < Duration::from_millis(limits::PROGRAM_RETRY_MS)).then_some(what)
    }

    fn next(&self) -> Job {
        let linger = Duration::from_millis(limits::PROGRAM_LINGER_MS);
        match self.up_since {
            Some(_) if self.is_ending || self.must_restart => Job::Stop,
            Some(_) if self.users > 0 => Job::Nothing,
            Some(_) => match self.idle_since.map(|since| since.elapsed()) {
                Some(idle) if idle < linger => Job::Wait(linger - idle),
                _ => Job::Stop,
            },
            None if self.users > 0 && self.failure.is_none() && !self.is_ending => Job::Start,
            None => Job::Nothing,
        }
    }
}

impl Program {
    fn join(self: Arc<Self>, is_there: bool) -> Result<Use, Error> {
        let mut state = lock(&self.state);
        if let Some(failure) = state.recent_failure() {
            return Err(Error::NoDevice(failure.to_owned()));
        }
        if state.is_ending {
            return Err(Error::ShuttingDown);
        }
        state.failure = None;
        if state.up_since.is_some() && state.was_seen && !is_there {
            state.must_restart = true;
        }
        state.users += 1;
        state.idle_since = None;
        self.employ(&mut state);
        if !state.is_worked_on && state.up_since.is_none() {
            state.users -= 1;
            return Err(Error::NoBuffers);
        }
        drop(state);
        Ok(Use(self))
    }

    /// Lets a thread look after the program, if there is something to do and none does.
    fn employ(self: &Arc<Self>, state: &mut State) {
        if state.is_worked_on {
            self.changed.notify_all();
        } else if !matches!(state.next(), Job::Nothing) {
            let me = self.clone();
            let thread = std::thread::Builder::new().name("program".to_owned());
            state.is_worked_on = thread.spawn(move || me.work()).is_ok();
        }
    }

    fn work(&self) {
        let mut state = lock(&self.state);
        loop {
            match state.next() {
                Job::Nothing => break,
                Job::Wait(time) => {
                    let waited = self.changed.wait_timeout(state, time);
                    state = waited.unwrap_or_else(PoisonError::into_inner).0;
                }
                Job::Start => {
                    drop(state);
                    let is_over = || lock(&self.state).is_ending;
                    let time_ms = limits::PROGRAM_START_MS_MAX;
                    let outcome = self.run(&self.commands.start, time_ms, &is_over);
                    state = lock(&self.state);
                    match outcome {
                        Ok(()) => {
                            state.up_since = Some(Instant::now());
                            state.was_seen = false;
                        }
                        Err(failure) => {
                            state.failure = Some((Instant::now(), failure.reason));
                            // What was killed may be half up.
                            if failure.was_killed {
                                state.up_since = Some(Instant::now());
                                state.must_restart = true;
                            }
                        }
                    }
                }
                Job::Stop => {
                    // A user that comes from here on waits for the start that follows.
                    state.up_since = None;
                    state.must_restart = false;
                    drop(state);
                    let outcome = match &self.commands.stop {
                        Some(stop) => self.run(stop, limits::PROGRAM_STOP_MS_MAX, &|| false),
                        None => Ok(()),
                    };
                    if let Err(failure) = outcome {
                        self.log.line(&failure.reason);
                    }
                    state = lock(&self.state);
                }
            }
            self.changed.notify_all();
        }
        state.is_worked_on = false;
        self.changed.notify_all();
    }

    /// Runs one command to its end.
    fn run(
        &self,
        description: &CommandDescription,
        time_ms: u32,
        is_over: &dyn Fn() -> bool,
    ) -> Result<(), Failure> {
        let shown = format!(
            "{} {}",
            description.program.display(),
            description.arguments.join(" ")
        );
        let shown = shown.trim_end();
        self.log.line(&format!("running {shown}"));
        let mut command = Command::new(&description.program);
        command.args(&description.arguments).current_dir("/");
        let limits = Limits {
            groups: Some(self.groups.clone()),
            time: Duration::from_millis(time_ms.into()),
            output_bytes: limits::PROGRAM_OUTPUT_BYTES_MAX,
        };
        let failed = |reason: String, was_killed| Err(Failure { reason, was_killed });
        let ended = match command::run_unless(command, &limits, is_over) {
            Ok(ended) => ended,
            Err(error) => return failed(format!("{shown} cannot be run: {error}"), false),
        };
        for line in ended.output.lines() {
            self.log.line(&format!("{shown}: {line}"));
        }
        let said = last_line(&ended);
        let status = ended.status;
        drain(ended);
        match status {
            Some(status) if status.success() => Ok(()),
            Some(status) => failed(format!("{shown} failed: {status}{said}"), false),
            None => {
                let limit = time_ms / 1000;
                let reason = format!("{shown} was killed: it had not ended within {limit} s{said}");
                failed(reason, true)
            }
        }
    }
}

/// Why a command did not end well.
struct Failure {
    reason: String,
    /// Its time was up.
    was_killed: bool,
}

/// The end of what a command said, for a reason.
fn last_line(ended: &Ended) -> String {
    let last = ended.output.lines().rfind(|line| !line.trim().is_empty());
    last.map_or_else(String::new, |line| format!(", it said: {}", line.trim()))
}

/// What a command has left running may go on writing to the output that it inherited: it must neither be ended by
/// that nor wait for somebody to read it.
fn drain(ended: Ended) {
    let Some(mut pipe) = ended.pipe else { return };
    let thread = std::thread::Builder::new().name("program-output".to_owned());
    // Without a thread the program gets SIGPIPE, which it would get from any other reader that ends.
    let _ = thread.spawn(move || {
        let mut piece = [0; 4096];
        while matches!(pipe.read(&mut piece), Ok(size) if size > 0) {}
    });
}

impl Use {
    /// How far the program is.
    pub fn progress(&self) -> Progress {
        let state = lock(&self.0.state);
        match (&state.failure, state.up_since) {
            (Some((_, reason)), _) => Progress::Failed(reason.clone()),
            (None, Some(since)) if !state.must_restart => Progress::Up(since),
            _ => Progress::Starting,
        }
    }

    /// What the program makes was seen.
    pub fn saw_it(&self) {
        lock(&self.0.state).was_seen = true;
    }

    /// The program is up and makes nothing: for the next user it is started again.
    pub fn give_up(&self, reason: &str) {
        let mut state = lock(&self.0.state);
        state.failure = Some((Instant::now(), reason.to_owned()));
        state.must_restart = state.up_since.is_some();
        self.0.employ(&mut state);
    }
}

impl Drop for Use {
    fn drop(&mut self) {
        let mut state = lock(&self.0.state);
        state.users -= 1;
        if state.users == 0 {
            state.idle_since = Some(Instant::now());
            self.0.employ(&mut state);
        }
    }
}

#[cfg(test)]
mod tests;
