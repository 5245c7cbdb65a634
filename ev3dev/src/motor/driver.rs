//! Drives one motor of the tree: a loop that reads the encoder, asks [`Control`] and writes the power.
//!
//! Owns the open files of the motor and its thread, which sleeps while the motor is released and does not turn. The files are
//! opened by a command and stay open until the motor has been let go, so that the tree brings the motor to rest if this
//! process dies. While it runs the encoder is sampled as often as the loop asks.
//!
//! Locks: `files`, then `control` or `turns`. What holds `files` drives the motor: the loop, or a program's
//! command, whose first step is done in its own call so that it hears of a failure.

use super::command::{Command, Output};
use super::control::Control;
use crate::device::{Changes, lock};
use crate::limits::{LOOP_MS, LOST_S, OBSERVE_S, RETRY_MS};
use crate::tree::{KeptFile, Tree, TreeFile};
use std::io::{self, Write};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};
use trikfs::errno::Error;

/// What the power file takes for "brake".
const BRAKE: i32 = 127;

/// Names in the tree.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Paths {
    /// The file that takes the power, for example `motors/M1/value`.
    pub power: String,
    /// The node of the encoder, for example `encoders/E1`.
    pub encoder: Option<String>,
}

/// One motor at work.
pub struct Driver {
    tree: Tree,
    paths: Paths,
    epoch: Instant,
    files: Mutex<Files>,
    control: Mutex<Control>,
    /// With `turns`.
    wake: Condvar,
    turns: Mutex<Turns>,
    changes: Arc<Changes>,
}

struct Files {
    power: Option<TreeFile>,
    /// What the power file has got.
    sent: Option<i32>,
    encoder: Option<KeptFile>,
    /// When the encoder was last read, while it is needed.
    heard_s: f64,
    /// When the power file last had what it should.
    wrote_s: f64,
    /// The period of the encoder before this motor ran.
    usual_ms: Option<u64>,
    fault: String,
}

/// What the loop is told.
#[derive(Default)]
struct Turns {
    has_thread: bool,
    retired: bool,
    /// There is something to do at once.
    due: bool,
    /// The power file has not got yet what it should.
    pending: bool,
    observe_until_s: f64,
}

impl Driver {
    /// A motor at rest. No file is opened and no thread runs yet.
    pub fn new(tree: Tree, paths: Paths, control: Control, changes: Arc<Changes>) -> Arc<Self> {
        let encoder = paths
            .encoder
            .as_ref()
            .map(|node| KeptFile::new(tree.clone(), format!("{node}/value0")));
        Arc::new(Self {
            tree,
            paths,
            epoch: Instant::now(),
            files: Mutex::new(Files {
                power: None,
                sent: None,
                encoder,
                heard_s: 0.0,
                wrote_s: 0.0,
                usual_ms: None,
                fault: String::new(),
            }),
            control: Mutex::new(control),
            wake: Condvar::new(),
            turns: Mutex::default(),
            changes,
        })
    }

    /// What the motor does. Hold it for a moment only.
    pub fn control(&self) -> MutexGuard<'_, Control> {
        lock(&self.control)
    }

    /// Tells of changes of the state.
    pub fn changes(&self) -> &Arc<Changes> {
        &self.changes
    }

    /// Why the motor was stopped by a failure; empty after the next command.
    pub fn fault(&self) -> String {
        lock(&self.files).fault.clone()
    }

    /// Takes a command and does its first step.
    ///
    /// # Errors
    /// The tree does not take the power or has no encoder; then the motor has been let go.
    pub fn command(self: &Arc<Self>, command: Command) -> Result<(), Error> {
        let mut files = lock(&self.files);
        files.fault.clear();
        let before = self.state();
        let now_s = self.now_s();
        let result = self.prepare(&mut files, now_s).and_then(|()| {
            self.control().command(command, now_s);
            self.step(&mut files)
        });
        if let Err(error) = &result {
            self.give_up(&mut files, error);
        }
        drop(files);
        self.tell_if_changed(before);
        self.keep_going(0.0)?;
        result
    }

    /// Lets the loop look at the setpoints now.
    pub fn hurry(&self) {
        lock(&self.turns).due = true;
        self.wake.notify_all();
    }

    /// Counts since position 0.
    ///
    /// # Errors
    /// The encoder cannot be read.
    pub fn position(&self) -> Result<i32, Error> {
        self.observe_if_idle()?;
        Ok(self.control().position())
    }

    /// Calls the present place so.
    ///
    /// # Errors
    /// The encoder cannot be read.
    pub fn set_position(&self, position: i32) -> Result<(), Error> {
        self.observe_if_idle()?;
        self.control().set_position(position);
        Ok(())
    }

    /// Counts per second. A motor that stands is watched for a while, because it may be turned from outside.
    ///
    /// # Errors
    /// The encoder cannot be read.
    pub fn speed(self: &Arc<Self>) -> Result<i32, Error> {
        self.observe_if_idle()?;
        self.keep_going(self.now_s() + OBSERVE_S)?;
        Ok(self.control().speed())
    }

    /// The motor is not shown any more: ends the loop.
    pub fn retire(&self) {
        lock(&self.turns).retired = true;
        self.wake.notify_all();
    }

    fn now_s(&self) -> f64 {
        self.epoch.elapsed().as_secs_f64()
    }

    fn state(&self) -> String {
        self.control().flags().text()
    }

    fn tell_if_changed(&self, before: String) {
        if self.state() != before {
            self.changes.notify();
        }
    }

    /// Opens what a command needs, and takes where the motor is.
    fn prepare(&self, files: &mut Files, now_s: f64) -> Result<(), Error> {
        if files.power.is_none() {
            files.power = Some(self.tree.open_to_write(&self.paths.power)?);
        }
        // Somebody else may have driven the motor since, or have the lease now: a command is written in any case.
        files.sent = None;
        files.wrote_s = now_s;
        if files.usual_ms.is_none() {
            files.usual_ms = self.hasten_encoder();
        }
        if let Some(counts) = read_encoder(files)? {
            files.heard_s = now_s;
            self.control().observe(now_s, counts);
        }
        Ok(())
    }

    /// One step of the regulation. `files` are locked, so nothing else writes the power.
    fn step(&self, files: &mut Files) -> Result<(), Error> {
        let is_let_go = self.control().is_let_go();
        let counts = match read_encoder(files) {
            Ok(counts) => {
                files.heard_s = self.now_s();
                counts
            }
            Err(error) if is_passing(&error) && self.now_s() - files.heard_s < LOST_S => None,
            Err(_) if is_let_go => None,
            Err(error) => return Err(error),
        };
        let mut control = self.control();
        let output = control.tick(self.now_s(), counts);
        let is_let_go = control.is_let_go();
        drop(control);
        let wanted = match output {
            Output::Power(percent) => percent,
            Output::Brake => BRAKE,
        };
        self.send(files, wanted)?;
        let has_all = files.sent == Some(wanted);
        lock(&self.turns).pending = files.power.is_some() && !has_all;
        if is_let_go && has_all {
            files.power = None;
        }
        Ok(())
    }

    /// Writes the power if it is another one. A transfer that fails is tried again at the next step, for a while.
    fn send(&self, files: &mut Files, wanted: i32) -> Result<(), Error> {
        let now_s = self.now_s();
        let Some(power) = &files.power else {
            return Ok(());
        };
        if files.sent == Some(wanted) {
            files.wrote_s = now_s;
            return Ok(());
        }
        match power.write(&wanted.to_string()) {
            Ok(()) => {
                files.sent = Some(wanted);
                files.wrote_s = now_s;
                Ok(())
            }
            // A motor that is to be let go is tried forever.
            Err(error)
                if is_passing(&error)
                    && (now_s - files.wrote_s < LOST_S || self.control().is_let_go()) =>
            {
                Ok(())
            }
            Err(error) => Err(error),
        }
    }

    /// Lets the motor go if it is driven; whether it was.
    pub fn rest(&self, why: &str) -> bool {
        let mut files = lock(&self.files);
        if files.power.is_none() {
            return false;
        }
        let before = self.state();
        self.release(&mut files, why.to_owned());
        drop(files);
        self.tell_if_changed(before);
        self.hurry();
        true
    }

    /// Lets the motor go, because it cannot be driven.
    fn give_up(&self, files: &mut Files, error: &Error) {
        self.release(files, error.to_string().replace('\n', " "));
    }

    /// If the motor does not take that now, the loop tries again.
    fn release(&self, files: &mut Files, why: String) {
        self.control().let_go();
        files.fault = why;
        files.sent = None;
        // The lease may be another's, or the tree gone, which brings the motor to rest by itself.
        let refused = self.send(files, 0).is_err();
        let has_all = files.sent == Some(0);
        if refused || has_all {
            files.power = None;
        }
        lock(&self.turns).pending = files.power.is_some();
    }

    fn observe_if_idle(&self) -> Result<(), Error> {
        if self.paths.encoder.is_none() {
            return Err(Error::Unsupported);
        }
        if self.control().is_busy(self.now_s()) {
            return Ok(());
        }
        let mut files = lock(&self.files);
        if let Some(counts) = read_encoder(&mut files)? {
            self.control().observe(self.now_s(), counts);
        }
        Ok(())
    }

    /// Sees to it that the loop runs while there is something to do.
    fn keep_going(self: &Arc<Self>, observe_until_s: f64) -> Result<(), Error> {
        let mut turns = lock(&self.turns);
        turns.observe_until_s = turns.observe_until_s.max(observe_until_s);
        turns.due = true;
        if !turns.has_thread {
            let driver = Arc::clone(self);
            let spawned = thread::Builder::new()
                .name("motor".to_owned())
                .spawn(move || driver.work());
            if let Err(error) = spawned {
                return Err(Error::Internal(format!("a thread for a motor: {error}")));
            }
            turns.has_thread = true;
        }
        self.wake.notify_all();
        Ok(())
    }

    /// The loop.
    fn work(&self) {
        let period = Duration::from_millis(LOOP_MS);
        let retry = Duration::from_millis(RETRY_MS);
        let mut next = Instant::now();
        while self.wait_until(next) {
            self.turn();
            let now = Instant::now();
            let is_waiting = lock(&self.turns).pending && self.control().is_let_go();
            next += if is_waiting { retry } else { period };
            // What was missed is not made up for.
            if next < now {
                next = now;
            }
            if let Some(end_s) = self.control().ends_at_s() {
                next = next.min(self.epoch + Duration::from_secs_f64(end_s.max(0.0)));
            }
        }
    }

    /// Waits for the next turn; while there is nothing to do, for something. False if this motor is over.
    fn wait_until(&self, next: Instant) -> bool {
        loop {
            let is_busy = self.control().is_busy(self.now_s());
            let mut turns = lock(&self.turns);
            if turns.retired {
                return false;
            }
            if std::mem::take(&mut turns.due) {
                return true;
            }
            let left = next.saturating_duration_since(Instant::now());
            if is_busy || turns.pending || self.now_s() < turns.observe_until_s {
                if left.is_zero() {
                    return true;
                }
                drop(
                    self.wake
                        .wait_timeout(turns, left)
                        .unwrap_or_else(PoisonError::into_inner),
                );
            } else {
                drop(turns);
                self.fall_asleep();
                let turns = lock(&self.turns);
                if !turns.due && !turns.retired && self.now_s() >= turns.observe_until_s {
                    drop(
                        self.wake
                            .wait(turns)
                            .unwrap_or_else(PoisonError::into_inner),
                    );
                }
            }
        }
    }

    /// Nothing is left to do: the encoder is sampled as usual, and its file is closed.
    fn fall_asleep(&self) {
        let mut files = lock(&self.files);
        if self.control().is_busy(self.now_s()) {
            return;
        }
        self.calm_encoder(&mut files);
        if let Some(encoder) = &mut files.encoder {
            encoder.close();
        }
    }

    fn turn(&self) {
        let mut files = lock(&self.files);
        let before = self.state();
        let result = self.step(&mut files);
        if let Err(error) = result {
            self.give_up(&mut files, &error);
            complain(&format!("{}: let go: {error}", self.paths.power));
        }
        drop(files);
        self.tell_if_changed(before);
    }

    /// Lets the tree sample the encoder as often as the loop reads it. Gives the period before, if it was longer.
    fn hasten_encoder(&self) -> Option<u64> {
        let name = format!("{}/poll_ms", self.paths.encoder.as_ref()?);
        let usual: u64 = self.tree.text(&name).ok()?.parse().ok()?;
        // A tree that does not let its period be changed is read as it is.
        (usual > LOOP_MS && self.tree.write(&name, &LOOP_MS.to_string()).is_ok()).then_some(usual)
    }

    /// Undoes that, unless it has been changed meanwhile.
    fn calm_encoder(&self, files: &mut Files) {
        let (Some(usual), Some(node)) = (files.usual_ms.take(), &self.paths.encoder) else {
            return;
        };
        let name = format!("{node}/poll_ms");
        if self.tree.text(&name) == Ok(LOOP_MS.to_string()) {
            let _ = self.tree.write(&name, &usual.to_string());
        }
    }
}

/// A transfer may fail now and then.
fn is_passing(error: &Error) -> bool {
    matches!(error, Error::Device(..) | Error::TimedOut(_))
}

/// Degrees, if there is an encoder.
fn read_encoder(files: &mut Files) -> Result<Option<i32>, Error> {
    let Some(encoder) = &mut files.encoder else {
        return Ok(None);
    };
    let degrees = encoder.number()?;
    // Out of range it would stay at the end, which the regulation would take for a shaft that stands.
    if degrees.abs() > f64::from(i32::MAX) {
        return Err(Error::OutOfRange(format!("{degrees} degrees")));
    }
    Ok(Some(degrees.round() as i32))
}

fn complain(text: &str) {
    let _ = writeln!(io::stderr(), "trikfs-ev3dev: {text}");
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::device::KernelSlot;
    use std::path::{Path, PathBuf};

    /// A motor whose tree is this folder, and its file there.
    fn motor_in(root: &Path) -> (Arc<Driver>, PathBuf) {
        let value = root.join("value");
        std::fs::write(&value, "").unwrap();
        let paths = Paths {
            power: "value".to_owned(),
            encoder: None,
        };
        let tree = Tree::new(root.to_owned());
        let changes = Changes::new(KernelSlot::default());
        let driver = Driver::new(tree, paths, Control::new(false, 100), changes);
        (driver, value)
    }

    #[test]
    fn a_command_is_written_also_where_somebody_else_has_written_since() {
        let root = tempfile::tempdir().unwrap();
        let (driver, value) = motor_in(root.path());
        driver.control().setpoints.duty_cycle = 30;
        for (command, power) in [(Command::RunDirect, "30"), (Command::Stop, "0")] {
            for _ in 0..2 {
                std::fs::write(&value, "").unwrap();
                driver.command(command).unwrap();
                assert_eq!(std::fs::read_to_string(&value).unwrap(), power);
            }
        }
        driver.retire();
    }

    #[test]
    fn a_motor_that_is_driven_rests_with_a_reason_and_one_that_is_not_is_left_alone() {
        let root = tempfile::tempdir().unwrap();
        let (driver, value) = motor_in(root.path());
        assert!(!driver.rest("why"));
        assert_eq!(driver.fault(), "");
        driver.control().setpoints.duty_cycle = 30;
        driver.command(Command::RunDirect).unwrap();
        std::fs::write(&value, "").unwrap();
        assert!(driver.rest("why"));
        assert_eq!(std::fs::read_to_string(&value).unwrap(), "0");
        assert_eq!(
            (driver.fault().as_str(), driver.state().as_str()),
            ("why", "")
        );
        driver.command(Command::RunDirect).unwrap();
        assert_eq!(std::fs::read_to_string(&value).unwrap(), "30");
        assert_eq!(driver.fault(), "");
        driver.retire();
    }
}
