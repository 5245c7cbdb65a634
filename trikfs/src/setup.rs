//! The actions of the global `setup`: each is done once in the life of the daemon, in order.
//!
//! Owns which have been done, their patience, and the failures that `status` shows. A failure never refuses a
//! configuration. Opens nothing itself: what is written goes through a sink of `device`, programs run through `command`.

use crate::command::{self, Limits};
use crate::device::{Surroundings, kinds};
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::lock;
use crate::limits;
use config::description::{SetupAction, SetupStep, SourceDescription};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

/// Does the actions of one daemon.
pub struct SetupRunner {
    engine: Arc<Engine>,
    /// Root of a virtual board, which never runs programs of the host.
    device_root: Option<PathBuf>,
    /// One list at a time, in the order in which the configurations came.
    turn: Mutex<Done>,
    /// Number and reason of each action of the newest list that failed.
    failures: Mutex<Vec<(usize, String)>>,
    /// Actions that hang in a device and were given up.
    stuck: Arc<AtomicUsize>,
}

/// What has been done.
#[derive(Default)]
struct Done(HashSet<String>);

/// What became of an action.
enum Outcome {
    Done,
    /// Not to be done here; the reason is for the log.
    Skipped(String),
    Failed(String),
}

impl SetupRunner {
    /// Nothing has been done yet.
    pub fn new(engine: Arc<Engine>, device_root: Option<PathBuf>) -> Arc<Self> {
        Arc::new(Self {
            engine,
            device_root,
            turn: Mutex::default(),
            failures: Mutex::default(),
            stuck: Arc::default(),
        })
    }

    /// Does what has not been done yet, and waits for the end of it, but not for longer than the limit: then the rest
    /// is done beside what follows.
    pub fn run(self: &Arc<Self>, actions: &[SetupAction]) {
        if actions.is_empty() {
            lock(&self.failures).clear();
            return;
        }
        let (runner, actions) = (self.clone(), actions.to_vec());
        let (done, ended) = channel::<()>();
        let spawned = std::thread::Builder::new()
            .name("setup".to_owned())
            .spawn(move || {
                runner.work(&actions);
                drop(done);
            });
        if let Err(error) = spawned {
            self.log(&format!("setup: threads cannot be started: {error}"));
            return;
        }
        let bound = Duration::from_millis(limits::SETUP_WAIT_MS);
        if ended.recv_timeout(bound) == Err(RecvTimeoutError::Timeout) {
            let bound_ms = limits::SETUP_WAIT_MS;
            self.log(&format!(
                "setup: not done after {bound_ms} ms; it goes on beside the sampling"
            ));
        }
    }

    /// Lines of `status`: one for each action that failed.
    pub fn status_lines(&self) -> String {
        let failures = lock(&self.failures);
        failures
            .iter()
            .map(|(number, why)| format!("setup[{number}] fault 0.0Hz {why}\n"))
            .collect()
    }

    fn log(&self, line: &str) {
        self.engine.log.line(line);
    }

    fn work(self: &Arc<Self>, actions: &[SetupAction]) {
        let mut done = lock(&self.turn);
        lock(&self.failures).clear();
        for (number, action) in (1..).zip(actions) {
            let what = format!("{:?} {:?}", action.step, action.unless);
            if done.0.contains(&what) {
                continue;
            }
            match self.perform(action) {
                Outcome::Done => drop(done.0.insert(what)),
                Outcome::Skipped(why) => {
                    self.log(&format!("{}: setup[{number}]: {why}", action.place));
                    done.0.insert(what);
                }
                Outcome::Failed(why) => {
                    let why = one_line(&why);
                    self.log(&format!("{}: setup[{number}]: {why}", action.place));
                    lock(&self.failures).push((number, why));
                }
            }
        }
    }

    fn perform(&self, action: &SetupAction) -> Outcome {
        if action.unless.as_deref().is_some_and(Path::exists) {
            return Outcome::Done;
        }
        let timeout = Duration::from_millis(action.timeout_ms.into());
        match &action.step {
            SetupStep::Run { program, arguments } => self.run_program(program, arguments, timeout),
            SetupStep::Write { path, bytes } => {
                let exports = path.file_name().is_some_and(|name| name == "export");
                let to = SourceDescription::Path(path.as_path().into());
                match self.send(&to, bytes, action.timeout_ms) {
                    // Somebody has done it before us, a boot script usually.
                    Err(error) if exports && error.is_busy_device() => Outcome::Done,
                    result => outcome_of(result),
                }
            }
            SetupStep::Send { to, bytes } => outcome_of(self.send(to, bytes, action.timeout_ms)),
        }
    }

    /// Writes on a thread of its own, because a driver may never return.
    fn send(&self, to: &SourceDescription, bytes: &[u8], timeout_ms: u32) -> Result<(), Error> {
        if self.stuck.load(Ordering::Acquire) >= limits::SETUP_STUCK_MAX {
            let what = "not tried: too many earlier actions have not returned".to_owned();
            return Err(Error::TimedOut(what));
        }
        let around = Surroundings {
            timeout_ms,
            ..Surroundings::new(&self.engine)
        };
        let (to, bytes, stuck) = (to.clone(), bytes.to_vec(), self.stuck.clone());
        let (said, heard) = channel();
        stuck.fetch_add(1, Ordering::AcqRel);
        let work = move || {
            let result =
                kinds::open_sink(&to, &around).and_then(|mut sink| sink.write(&bytes, true));
            stuck.fetch_sub(1, Ordering::AcqRel);
            let _ = said.send(result);
        };
        let thread = std::thread::Builder::new().name("setup".to_owned());
        if let Err(error) = thread.spawn(work) {
            self.stuck.fetch_sub(1, Ordering::AcqRel);
            return Err(Error::Internal(format!(
                "threads cannot be started: {error}"
            )));
        }
        // A device that keeps the time itself gives a better reason than we have.
        let patience = Duration::from_millis(u64::from(timeout_ms) + limits::SETUP_GRACE_MS);
        heard.recv_timeout(patience).unwrap_or_else(|_| {
            Err(Error::TimedOut(format!(
                "the device has not returned for {timeout_ms} ms"
            )))
        })
    }

    fn run_program(&self, program: &Path, arguments: &[String], timeout: Duration) -> Outcome {
        let shown = program.display();
        if let Some(root) = &self.device_root
            && !is_inside(program, root)
        {
            return Outcome::Skipped(format!(
                "left out, which is no problem: a virtual board runs only programs of its own, and has no {shown}"
            ));
        }
        let mut command = Command::new(program);
        command.args(arguments).current_dir("/");
        let limits = Limits {
            groups: Some(self.engine.programs.groups.clone()),
            time: timeout,
            output_bytes: limits::SETUP_OUTPUT_BYTES,
        };
        match command::run(command, &limits) {
            Err(error) => Outcome::Failed(format!("device: {shown}: {error}")),
            Ok(ended) => {
                let said = match one_line(&ended.output) {
                    said if said.is_empty() => said,
                    said => format!(": {said}"),
                };
                match ended.status {
                    Some(status) if status.success() => Outcome::Done,
                    Some(status) => Outcome::Failed(format!("device: {shown}: {status}{said}")),
                    None => Outcome::Failed(format!(
                        "device: {shown} was killed after {} ms{said}",
                        timeout.as_millis()
                    )),
                }
            }
        }
    }
}

fn outcome_of(result: Result<(), Error>) -> Outcome {
    match result {
        Ok(()) => Outcome::Done,
        Err(error) => Outcome::Failed(format!("{}: {error}", error.blame())),
    }
}

/// Whether a file is really below a folder, links followed.
fn is_inside(file: &Path, root: &Path) -> bool {
    match (file.canonicalize(), root.canonicalize()) {
        (Ok(file), Ok(root)) => file.starts_with(root),
        _ => false,
    }
}

fn one_line(text: &str) -> String {
    text.trim().replace(|c: char| c.is_control(), " ")
}
