//! A diagram under judgement with a debugger attached: a stop holds the tick, and with it the model time.
//!
//! Owns the way of orders to a program that is held, or between two ticks, or over. Knows no person and no files.

use super::program::{Program, describe};
use super::track::Group;
use super::trial::{Progress, Trial};
use lang_diagram::brick::{Brick, Command};
use lang_diagram::debug::Session;
use lang_diagram::debug::desk::Desk;
use lang_diagram::limits::HISTORY_BYTES;
use lang_diagram::machine::patch::{Patched, Refused, Version, WhenGone};
use lang_diagram::machine::trace::Deaf;
use lang_diagram::machine::{Options, Status};
use lang_diagram::ports::Port;
use lang_diagram::program::Program as Lowered;
use lang_text::problem::{Locale, Problem};
use std::rc::Rc;

/// A diagram with a debugger, which may hold it.
#[derive(Debug)]
pub struct Debugged {
    /// Takes orders while the program is not in a step.
    pub desk: Desk,
    /// An order for a program that is held, and what has come of it.
    order: Option<(u32, String)>,
    answer: Option<String>,
    /// A new version for a program that is held, and what has come of it.
    version: Option<Version>,
    patched: Option<Result<Patched, Refused>>,
}

impl Debugged {
    /// Before its first step. The past is kept.
    pub fn new(program: Rc<Lowered>, locale: Locale) -> Self {
        let mut session = Session::new(program, Options::simulated());
        session.keep(HISTORY_BYTES);
        Self {
            desk: Desk::new(session, locale, HISTORY_BYTES),
            order: None,
            answer: None,
            version: None,
            patched: None,
        }
    }
}

impl Debugged {
    fn patch(&mut self, version: &Version, robot: &mut dyn Brick) -> Result<Patched, Refused> {
        let session = self.desk.session();
        let patched = session.patch(version, WhenGone::Refuse, robot, &mut Deaf)?;
        self.desk.tell_again();
        Ok(patched)
    }
}

/// Replaces a debugged program in its run by a new version, if no thread is at a block that it does not have. Model
/// time does not pass.
///
/// # Errors
/// [`Refused`]; nothing has changed then.
pub fn patch(
    trial: &mut Trial<'_>,
    program: &mut Debugged,
    version: &Version,
) -> Result<Patched, Refused> {
    match trial.progress() {
        Progress::Held => {
            program.version = Some(version.clone());
            trial.tick(program);
            program.patched.take().unwrap_or(Err(Refused::Ended))
        }
        Progress::Runs => {
            let mut patched = Err(Refused::Ended);
            trial.aside(&mut |_, robot| patched = program.patch(version, robot));
            patched
        }
        Progress::Over => Err(Refused::Ended),
    }
}

impl Program for Debugged {
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status {
        if let Some((tag, text)) = self.order.take() {
            self.answer = Some(self.desk.order((tag, &text), now_ms, robot, &mut Deaf));
        } else if let Some(version) = self.version.take() {
            self.patched = Some(self.patch(&version, robot));
        } else {
            self.desk.step(now_ms, robot, &mut Deaf);
        }
        self.desk.live().status()
    }

    fn is_held(&self) -> bool {
        self.desk.is_stopped()
    }

    fn last_tick(&mut self, now_ms: u32, robot: &mut dyn Brick) {
        self.desk.session().last_tick(now_ms, robot, &mut Deaf);
    }

    fn stop(&mut self, robot: &mut dyn Brick) {
        self.desk.session().end(robot, &mut Deaf);
    }

    fn describe(&self, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
        describe(self.desk.live(), locale, tell);
    }

    fn errors(&self) -> &[Problem] {
        self.desk.live().errors()
    }

    fn refusal(&self) -> Option<&Problem> {
        self.desk.live().program().refusal()
    }
}

/// Gives an order to a debugged program in its run; the answer is JSON, as [`Desk::order`] has it. A program that was held
/// finishes its tick with it, or is held again.
pub fn order(trial: &mut Trial<'_>, program: &mut Debugged, tag: u32, text: &str) -> String {
    match trial.progress() {
        Progress::Held => {
            program.order = Some((tag, text.to_owned()));
            trial.tick(program);
            program.answer.take().unwrap_or_default()
        }
        Progress::Runs => {
            let mut answer = String::new();
            trial.aside(&mut |now, robot| {
                answer = program.desk.order((tag, text), now, robot, &mut Deaf);
            });
            answer
        }
        Progress::Over => order_after(program, tag, text),
    }
}

/// The same when the run is over: the program can be looked at, and its past.
pub fn order_after(program: &mut Debugged, tag: u32, text: &str) -> String {
    let now = program.desk.live().now();
    program.desk.order((tag, text), now, &mut Nobody, &mut Deaf)
}

/// The robot of a run that is over.
struct Nobody;

impl Brick for Nobody {
    fn command(&mut self, _command: Command<'_>) {}

    fn scalar(&mut self, _port: Port) -> Option<i32> {
        None
    }

    fn vector(&mut self, _port: Port, _into: &mut Vec<i32>) -> bool {
        false
    }

    fn random(&mut self, low: i32, _high: i32) -> i32 {
        low
    }
}
