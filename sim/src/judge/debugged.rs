//! A diagram or a data-flow program under judgement with a debugger attached: a stop holds the tick, and with it the model
//! time.
//!
//! Owns the way of orders to a program that is held, or between two ticks, or over. Knows no person and no files.

use super::Dataflow;
use super::program::{Program, Running, alive, describe};
use super::track::Group;
use super::trial::{Progress, Trial};
use lang_dataflow::machine::patch as flow;
use lang_dataflow::program::Program as Flow;
use lang_diagram::brick::{Brick, Command};
use lang_diagram::debug::Session;
use lang_diagram::debug::desk::Desk;
use lang_diagram::limits::HISTORY_BYTES;
use lang_diagram::machine::patch::{self as diagram, WhenGone};
use lang_diagram::machine::trace::Deaf;
use lang_diagram::machine::{Options, Status};
use lang_diagram::ports::Port;
use lang_diagram::program::Program as Lowered;
use lang_text::problem::{Locale, Problem};
use std::rc::Rc;

/// A program with a debugger, which may hold it.
#[derive(Debug)]
pub struct Debugged {
    program: Debuggee,
    /// What a program that is held is asked for.
    request: Option<Request>,
    /// What has come of it.
    answer: Option<String>,
    patched: Option<Result<String, Refused>>,
}

/// A program of either language.
#[derive(Debug)]
enum Debuggee {
    Diagram(Box<Desk>),
    Flow(Box<Dataflow>),
}

#[derive(Debug)]
enum Request {
    Order(u32, String),
    Change(Version),
}

/// A new version of a program, good as far as it can be known without the one that runs.
#[derive(Clone, Debug)]
pub enum Version {
    /// Of a diagram.
    Diagram(diagram::Version),
    /// Of a data-flow program.
    Flow(flow::Version),
}

/// Why a new version does not take the place of a program. Nothing has changed then.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Refused {
    /// That of a diagram.
    Diagram(diagram::Refused),
    /// That of a data-flow program.
    Flow(flow::Refused),
    /// It is a diagram, and a data-flow program runs, or the other way round.
    OtherLanguage,
}

impl Debugged {
    /// A diagram before its first step. The past is kept.
    pub fn diagram(program: Rc<Lowered>, locale: Locale) -> Self {
        let mut session = Session::new(program, Options::simulated());
        session.keep(HISTORY_BYTES);
        let desk = Desk::new(session, locale, HISTORY_BYTES);
        Self::of(Debuggee::Diagram(Box::new(desk)))
    }

    /// A data-flow program before its first instant. The past is kept.
    pub fn flow(program: Rc<Flow>, locale: Locale) -> Self {
        let mut flow = Dataflow::new(program, locale);
        flow.desk().attach();
        Self::of(Debuggee::Flow(Box::new(flow)))
    }

    fn of(program: Debuggee) -> Self {
        Self {
            program,
            request: None,
            answer: None,
            patched: None,
        }
    }

    /// It stops before its first block.
    pub fn stop_first(&mut self) {
        match &mut self.program {
            Debuggee::Diagram(desk) => desk.session().debugger().pause(),
            Debuggee::Flow(flow) => flow.desk().stop_first(),
        }
    }

    /// What has happened since the last time, each a JSON object.
    pub fn news(&mut self) -> Vec<String> {
        match &mut self.program {
            Debuggee::Diagram(desk) => desk.news(),
            Debuggee::Flow(flow) => flow.desk().news(),
        }
    }

    /// Goes on with a search through the past; whether there is more of it.
    pub fn search_on(&mut self) -> bool {
        match &mut self.program {
            Debuggee::Diagram(desk) => desk.session().search_on(),
            Debuggee::Flow(flow) => flow.desk().search_on(),
        }
    }

    /// Carries out an order; the answer is JSON.
    fn order(&mut self, order: (u32, &str), now: u32, robot: &mut dyn Brick) -> String {
        match &mut self.program {
            Debuggee::Diagram(desk) => desk.order(order, now, robot, &mut Deaf),
            Debuggee::Flow(flow) => flow.desk().order(order),
        }
    }

    fn change(&mut self, version: &Version, robot: &mut dyn Brick) -> Result<String, Refused> {
        match (&mut self.program, version) {
            (Debuggee::Diagram(desk), Version::Diagram(version)) => {
                let session = desk.session();
                let patched = session.patch(version, WhenGone::Refuse, robot, &mut Deaf);
                let patched = patched.map_err(Refused::Diagram)?;
                desk.tell_again();
                Ok(patched.to_string())
            }
            (Debuggee::Flow(flow), Version::Flow(version)) => {
                let patched = flow.desk().patch(version, robot);
                patched
                    .map(|patched| patched.to_string())
                    .map_err(Refused::Flow)
            }
            (Debuggee::Diagram(_), Version::Flow(_)) | (Debuggee::Flow(_), Version::Diagram(_)) => {
                Err(Refused::OtherLanguage)
            }
        }
    }

    /// That the run is over, as the reason why a version is refused.
    fn over(&self) -> Refused {
        match &self.program {
            Debuggee::Diagram(_) => Refused::Diagram(diagram::Refused::Ended),
            Debuggee::Flow(_) => Refused::Flow(flow::Refused::Ended),
        }
    }

    fn now(&self) -> u32 {
        match &self.program {
            Debuggee::Diagram(desk) => desk.live().now(),
            Debuggee::Flow(flow) => flow.now(),
        }
    }
}

/// Replaces a debugged program in its run by a new version; what that has changed. Model time does not pass.
///
/// # Errors
/// [`Refused`]; nothing has changed then. Of a diagram a version is refused too if a thread is at a block that it does not
/// have.
pub fn patch(
    trial: &mut Trial,
    program: &mut Debugged,
    version: &Version,
) -> Result<String, Refused> {
    match trial.progress() {
        Progress::Held => {
            program.request = Some(Request::Change(version.clone()));
            trial.tick(program);
            let patched = program.patched.take();
            patched.unwrap_or_else(|| Err(program.over()))
        }
        Progress::Runs => {
            let mut patched = Err(program.over());
            trial.aside(&mut |_, robot| patched = program.change(version, robot));
            patched
        }
        Progress::Over => Err(program.over()),
    }
}

impl Program for Debugged {
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status {
        let is_asked = match self.request.take() {
            Some(Request::Order(tag, text)) => {
                self.answer = Some(self.order((tag, &text), now_ms, robot));
                true
            }
            Some(Request::Change(version)) => {
                self.patched = Some(self.change(&version, robot));
                true
            }
            None => false,
        };
        match &mut self.program {
            Debuggee::Diagram(desk) => {
                // An order has run what was to be run.
                if !is_asked {
                    desk.step(now_ms, robot, &mut Deaf);
                }
                desk.live().status()
            }
            // One that goes on finishes its instant.
            Debuggee::Flow(flow) => flow.step(now_ms, robot),
        }
    }

    fn is_held(&self) -> bool {
        match &self.program {
            Debuggee::Diagram(desk) => desk.is_stopped(),
            Debuggee::Flow(flow) => flow.is_held(),
        }
    }

    fn last_tick(&mut self, now_ms: u32, robot: &mut dyn Brick) {
        match &mut self.program {
            Debuggee::Diagram(desk) => desk.session().last_tick(now_ms, robot, &mut Deaf),
            Debuggee::Flow(flow) => flow.last_tick(now_ms, robot),
        }
    }

    fn stop(&mut self, robot: &mut dyn Brick) {
        match &mut self.program {
            Debuggee::Diagram(desk) => desk.session().end(robot, &mut Deaf),
            Debuggee::Flow(flow) => flow.stop(robot),
        }
    }

    fn describe(&self, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
        match &self.program {
            Debuggee::Diagram(desk) => describe(desk.live(), locale, tell),
            Debuggee::Flow(flow) => flow.describe(locale, tell),
        }
    }

    fn errors(&self) -> &[Problem] {
        match &self.program {
            Debuggee::Diagram(desk) => desk.live().errors(),
            Debuggee::Flow(flow) => flow.errors(),
        }
    }

    fn warnings(&self) -> &[Problem] {
        match &self.program {
            Debuggee::Diagram(_) => &[],
            Debuggee::Flow(flow) => flow.warnings(),
        }
    }

    fn refusal(&self) -> Option<&Problem> {
        match &self.program {
            Debuggee::Diagram(desk) => desk.live().program().refusal(),
            Debuggee::Flow(flow) => flow.refusal(),
        }
    }

    fn running(&self) -> Vec<Running> {
        match &self.program {
            Debuggee::Diagram(desk) => alive(desk.live()),
            Debuggee::Flow(flow) => flow.running(),
        }
    }
}

/// Gives an order to a debugged program in its run; the answer is JSON, as the desk of its language has it. A program that
/// was held finishes its tick with it, or is held again.
pub fn order(trial: &mut Trial, program: &mut Debugged, tag: u32, text: &str) -> String {
    match trial.progress() {
        Progress::Held => {
            program.request = Some(Request::Order(tag, text.to_owned()));
            trial.tick(program);
            program.answer.take().unwrap_or_default()
        }
        Progress::Runs => {
            let mut answer = String::new();
            trial.aside(&mut |now, robot| answer = program.order((tag, text), now, robot));
            answer
        }
        Progress::Over => order_after(program, tag, text),
    }
}

/// The same when the run is over: the program can be looked at, and its past.
pub fn order_after(program: &mut Debugged, tag: u32, text: &str) -> String {
    let now = program.now();
    program.order((tag, text), now, &mut Nobody)
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
