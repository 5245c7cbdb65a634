//! Programs of data flow on a robot: the machine of crate `lang-dataflow` with the tree as its robot.
//!
//! Owns the time of a running program and what is told of it. A program of data flow has no debugger yet and cannot be
//! changed while it runs: who asks for either is told so.

use super::robot::Robot;
use super::watch::Watch;
use super::{errors_among, since, wait};
use crate::engine::{Failure, NoDiagram, Outcome};
use crate::host::{Host, Incoming};
use lang_dataflow::machine::Machine;
use lang_dataflow::machine::trace::Trace;
use lang_dataflow::program::{NodeId, Program};
use lang_dataflow::project::Project;
use lang_diagram::machine::{STEP_MS, Status};
use lang_text::json::Object;
use lang_text::problem::{Locale, Problem};
use std::io;
use std::rc::Rc;
use std::time::{Duration, Instant};

/// The ending of a program in its textual form.
pub(super) const ENDING: &str = "flow";

/// The project that bytes spell out.
///
/// # Errors
/// What is wrong with the text.
pub(super) fn of_text(bytes: Vec<u8>, locale: Locale) -> Result<Project, NoDiagram> {
    let text = String::from_utf8(bytes).map_err(|error| {
        NoDiagram::Unread(io::Error::new(io::ErrorKind::InvalidData, error).into())
    })?;
    lang_dataflow::text::read(&text).map_err(|problems| errors_among(&problems, locale))
}

/// What is heard of a machine.
struct Heard<'a> {
    watch: &'a mut Watch,
    /// Whether a block has reacted.
    has_fired: bool,
}

impl Trace for Heard<'_> {
    fn fired(&mut self, _now: u32, _node: NodeId) {
        self.has_fired = true;
    }

    fn trap(&mut self, _now: u32, problem: &Problem) {
        self.watch.note(problem);
    }
}

/// Steps until the program has ended or the daemon is gone.
pub(super) fn run(
    program: Rc<Program>,
    robot: &mut Robot<'_>,
    watch: &mut Watch,
    host: &Host,
) -> Outcome {
    let mut machine = Machine::new(program);
    let ran = steps(&mut machine, robot, watch, host);
    machine.stop(robot, &mut lang_dataflow::machine::trace::Deaf);
    ran.map_err(|error| Failure::Deaf(error.into()))?;
    match machine.errors() {
        [] => Ok(()),
        // They were told when they happened.
        _ => Err(Failure::Told),
    }
}

fn steps(
    machine: &mut Machine,
    robot: &mut Robot<'_>,
    watch: &mut Watch,
    host: &Host,
) -> io::Result<()> {
    let start = Instant::now();
    let step = Duration::from_millis(STEP_MS.into());
    let mut due = start;
    let mut warned = 0;
    loop {
        let now = since(start);
        let mut heard = Heard {
            watch,
            has_fired: false,
        };
        let status = machine.step(now, robot, &mut heard);
        let has_fired = heard.has_fired;
        for problem in &machine.warnings()[warned..] {
            host.info(&problem.in_locale(watch.locale()))?;
        }
        warned = machine.warnings().len();
        watch.report_flow(machine, has_fired, now, host)?;
        if status != Status::Running {
            return Ok(());
        }
        robot.go_on();
        // Steps that are missed are not made up: timers look at the time, not at steps.
        due = (due + step).max(Instant::now());
        loop {
            while let Some(message) = host.waiting()? {
                if matches!(message, Incoming::Gone) {
                    return Ok(());
                }
                hear(message, machine, (robot, watch), host)?;
            }
            if !wait(host, due)? {
                break;
            }
        }
    }
}

/// Does what the daemon asks for between two instants.
fn hear(
    message: Incoming,
    machine: &Machine,
    (robot, watch): (&mut Robot<'_>, &mut Watch),
    host: &Host,
) -> io::Result<()> {
    match message {
        Incoming::Mail(sender, text) => robot.post(sender, text),
        Incoming::Reply(number, text) => robot.answer(number, text),
        Incoming::Web => host.web(&super::watch::variables_of(machine.variables()))?,
        Incoming::Watch(is_wanted) => watch.set_wanted(is_wanted),
        Incoming::Patch(..) | Incoming::Set(_) => host.changed(false, NOT_YET)?,
        Incoming::Debug { client, tag, .. } => {
            let answer = Object::new(NOT_YET.len())
                .text("why", NOT_YET)
                .plain("to", tag);
            host.debug(client, &answer.plain("done", false).done())?;
        }
        Incoming::DebugLeft => {}
        Incoming::Direct(_) => host.error("a data-flow program takes no direct commands")?,
        // The caller knows.
        Incoming::Gone => {}
    }
    Ok(())
}

/// What who wants to look into a program or to change it is answered.
pub(super) const NOT_YET: &str = "a data-flow program has no debugger and cannot be changed while it runs: end it, and start the new one";
