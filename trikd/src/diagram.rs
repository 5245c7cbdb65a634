//! Diagrams of TRIK Studio: the machine of crate `lang` with the tree as its robot.
//!
//! Owns the time of a running diagram and its way outside. `robot` is the tree as the machine sees it, `readings` its
//! sensors, `motors` its motors at a stop, `watch` what is told of the run, `debugging` its debugger, `live` its changes, `versions`
//! those that are prepared;
//! `flow` runs programs of data flow, which `source` reads.
//! What blocks mean is known in `lang` alone.

// A request, a message or a command that is forgotten must not pass in silence.
#![deny(clippy::wildcard_enum_match_arm)]

mod asking;
mod debugging;
mod flow;
mod live;
mod motors;
mod parts;
mod readings;
mod robot;
mod source;
mod versions;
mod watch;
mod words;

use crate::brick::Brick;
use crate::engine::{Engine, Failure, NoDiagram, Outcome, Start};
use crate::host::{Host, Incoming};
use crate::scripts::ending;
use crate::{limits, settings};
use debugging::Debugging;
use lang_dataflow::read::{Language, language};
use lang_diagram::lower::{World, lower};
use lang_diagram::machine::{Machine, Options, STEP_MS};
use lang_diagram::project::Project;
use lang_diagram::read;
use lang_expr::Compat;
use lang_text::problem::{Locale, Problem, Severity};
use live::Prepared;
use nix::poll::{PollFd, PollFlags, ppoll};
use nix::sys::time::TimeSpec;
use robot::Robot;
use source::Source;
use std::cell::Cell;
use std::fs::OpenOptions;
use std::io::{self, Read};
use std::os::unix::fs::OpenOptionsExt;
use std::path::Path;
use std::rc::Rc;
use std::time::{Duration, Instant};
use versions::{Asked, Change, Versions};
use watch::Watch;

/// Runs diagrams.
#[derive(Debug)]
pub struct Diagram {
    locale: Locale,
    compat: Compat,
    /// How long a question waits for its answer.
    patience: Duration,
}

/// The engine of this build, with the language of messages and the rules that the environment names.
pub fn engine() -> impl Engine {
    let named = |name: &str| std::env::var(name).unwrap_or_default();
    Diagram {
        locale: of_environment(),
        patience: Duration::from_secs(named("TRIK_ANSWER_S").parse().unwrap_or(limits::ANSWER_S)),
        compat: if named("TRIK_COMPAT") == settings::Compat::Fixed.name() {
            Compat::Fixed
        } else {
            Compat::Studio
        },
    }
}

/// The language in which a program says what it says by itself, as the daemon names it.
pub fn of_environment() -> Locale {
    locale(&std::env::var("TRIK_LANGUAGE").unwrap_or_default())
}

/// The language of messages by its name, as `LANG` has it: Russian if it begins with `ru`, else English.
pub fn locale(name: &str) -> Locale {
    if name.starts_with("ru") {
        Locale::Russian
    } else {
        Locale::English
    }
}

/// What a file has.
enum Loaded {
    /// A machine with diagrams of control flow.
    Diagram(Box<Machine>),
    /// A data-flow program.
    Flow(Box<(Rc<lang_dataflow::program::Program>, Source)>),
}

impl Engine for Diagram {
    fn run(&mut self, start: Start, brick: &Brick, host: &Host) -> Outcome {
        let (path, is_debugged) = match start {
            Start::File(path) => (path, false),
            Start::Debugged(path) => (path, true),
            Start::Script(_) | Start::Direct => return Err(Failure::NoFile),
        };
        let mut robot = Robot::new(brick, host, self.patience, self.locale);
        let mut watch = Watch::new(self.locale);
        let machine = match self.load(&path, host, &mut watch)? {
            Loaded::Diagram(machine) => *machine,
            Loaded::Flow(flow) => {
                return flow::run(*flow, is_debugged, &mut robot, &mut watch, host);
            }
        };
        let mut diagram = Debugging::new(machine, self.locale);
        if is_debugged {
            diagram.stop_first(&mut robot, &mut watch);
        }
        let ran = run(&mut diagram, &mut robot, &mut watch, host);
        diagram.end(&mut robot, &mut watch);
        ran.map_err(|error| Failure::Deaf(error.into()))?;
        if diagram.machine().errors().is_empty() {
            Ok(())
        } else {
            // They were told when they happened.
            Err(Failure::Told)
        }
    }
}

impl Diagram {
    /// A machine with the program of a save, or a data-flow program; tells on the way what is wrong with it.
    fn load(&self, path: &Path, host: &Host, watch: &mut Watch) -> Result<Loaded, Failure> {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let failed = |why| Failure::Diagram(name.clone().into_owned(), why);
        let bytes = read_save(path).map_err(failed)?;
        if ending(path) == source::ENDING {
            let source = Source::of_text(bytes, self.locale).map_err(failed)?;
            return self.ready(source, watch, host).map_err(failed);
        }
        let opened = opened(&bytes, self.locale).map_err(failed)?;
        if language(&opened.save) == Language::Dataflow {
            let source = Source::of_save(opened);
            return self.ready(source, watch, host).map_err(failed);
        }
        let lowered = lower(&opened.project, World::Robot)
            .map_err(|problem| opened.project.on_sheet(problem))
            .map_err(|problem| failed(errors_among(&[problem], self.locale)))?;
        let warnings = opened.problems.iter().chain(&lowered.problems);
        // A faulty block fails when it is reached, and what is wrong with it is told here.
        let warnings = warnings.take(limits::DIAGRAM_WARNINGS);
        let told = warnings.map(|problem| {
            let placed = opened.project.on_sheet(problem.clone());
            (problem.severity, placed.in_locale(self.locale))
        });
        watch.tell_warnings(told, host);
        let options = Options {
            compat: self.compat,
            ..Options::of(World::Robot)
        };
        let machine = Machine::new(Rc::new(lowered.program), options);
        Ok(Loaded::Diagram(Box::new(machine)))
    }

    /// A data-flow program that has nothing wrong with it; warnings are told.
    fn ready(&self, source: Source, watch: &mut Watch, host: &Host) -> Result<Loaded, NoDiagram> {
        let checked = lang_dataflow::check::check(&source.project);
        let all = [&source.problems[..], &checked.problems].concat();
        let errors = source.errors(&all, self.locale);
        if checked.has_errors() || !errors.is_empty() {
            return Err(NoDiagram::Problems(errors));
        }
        watch.tell_warnings(source.warnings(&all, self.locale), host);
        Ok(Loaded::Flow(Box::new((Rc::new(checked.program), source))))
    }
}

/// A file that is no longer than a save may be.
fn read_save(path: &Path) -> Result<Vec<u8>, NoDiagram> {
    let failed = |error: io::Error| NoDiagram::Unread(error.into());
    let limit = lang_diagram::limits::SAVE_BYTES as u64;
    let mut bytes = Vec::new();
    // A pipe would be waited for.
    let file = OpenOptions::new()
        .read(true)
        .custom_flags(libc::O_NONBLOCK)
        .open(path)
        .map_err(failed)?;
    if !file.metadata().map_err(failed)?.is_file() {
        return Err(failed(io::ErrorKind::InvalidInput.into()));
    }
    file.take(limit + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() as u64 > limit {
        return Err(NoDiagram::TooLong(limit));
    }
    Ok(bytes)
}

/// The project of a save.
fn opened(bytes: &[u8], locale: Locale) -> Result<read::Opened, NoDiagram> {
    read::read(bytes).map_err(|problems| errors_among(&problems, locale))
}

fn errors_among(problems: &[Problem], locale: Locale) -> NoDiagram {
    let errors = problems
        .iter()
        .filter(|problem| problem.severity == Severity::Error);
    let lines = errors.map(|problem| problem.in_locale(locale));
    NoDiagram::Problems(lines.collect())
}

/// Steps until the program has ended or the daemon is gone.
fn run(
    diagram: &mut Debugging,
    robot: &mut Robot<'_>,
    watch: &mut Watch,
    host: &Host,
) -> io::Result<()> {
    let start = Instant::now();
    let mut due = start;
    let mut versions = Versions::new(live::prepared, watch.locale());
    loop {
        let now = since(start);
        let goes_on = diagram.step(now, robot, watch);
        diagram.report(now, !goes_on, host)?;
        watch.report(diagram.machine(), now, host)?;
        if !goes_on {
            return watch.last(diagram.machine(), now, host);
        }
        robot.go_on();
        // Steps that are missed are not made up: waits look at the time, not at steps.
        due = next_step(due, Instant::now());
        if !hear_all(start, due, (diagram, robot, watch), &mut versions, host)? {
            return Ok(());
        }
    }
}

/// Hears the daemon until a step is due, and takes each new version as soon as it is ready; whether the daemon is there.
fn hear_all(
    start: Instant,
    due: Instant,
    (diagram, robot, watch): (&mut Debugging, &mut Robot<'_>, &mut Watch),
    versions: &mut Versions<Project>,
    host: &Host,
) -> io::Result<bool> {
    loop {
        let until = Cell::new(versions.until(due));
        let hear = |message| {
            let parts = (&mut *diagram, &mut *robot, &mut *watch);
            hear(message, since(start), parts, versions, host)?;
            until.set(versions.until(due));
            Ok(())
        };
        if !hear_until(&until, host, hear)? {
            return Ok(false);
        }
        take_version(versions, since(start), (diagram, robot, watch), host)?;
        if Instant::now() >= due {
            return Ok(true);
        }
    }
}

/// Hears the daemon until a moment, which may come nearer while it is heard; whether the daemon is there. However much it asks
/// for, steps go on.
fn hear_until(
    until: &Cell<Instant>,
    host: &Host,
    mut hear: impl FnMut(Incoming) -> io::Result<()>,
) -> io::Result<bool> {
    let end = until
        .get()
        .max(Instant::now() + Duration::from_millis(limits::HEARING_MS));
    loop {
        // What came together with the beginning lies in the channel's buffer, where poll(2) does not see it.
        while let Some(message) = host.waiting()? {
            if matches!(message, Incoming::Gone) {
                return Ok(false);
            }
            hear(message)?;
            if Instant::now() >= end {
                return Ok(true);
            }
        }
        if !wait(host, until.get())? {
            return Ok(true);
        }
    }
}

/// When the step after the one of `due` is due. Of steps that are missed only the last one is done, at once. All others are
/// a whole number of steps from the first, so that one late step makes no later wait or reading late.
fn next_step(due: Instant, now: Instant) -> Instant {
    let step = Duration::from_millis(STEP_MS.into());
    let next = due + step;
    let missed = between(next, now) / STEP_MS;
    next + step * missed
}

/// Milliseconds from a moment to a later one; none to an earlier one.
fn between(start: Instant, until: Instant) -> u32 {
    let passed = until.saturating_duration_since(start).as_millis();
    u32::try_from(passed).unwrap_or(u32::MAX)
}

/// Milliseconds since a moment.
fn since(start: Instant) -> u32 {
    between(start, Instant::now())
}

/// Does what the daemon asks for between two steps.
fn hear(
    message: Incoming,
    now: u32,
    (diagram, robot, watch): (&mut Debugging, &mut Robot<'_>, &mut Watch),
    versions: &mut Versions<Project>,
    host: &Host,
) -> io::Result<()> {
    match message {
        Incoming::Mail(sender, text) => robot.post(sender, text),
        Incoming::Reply(number, text) => robot.answer(number, text),
        Incoming::Web => host.web(&watch::variables(diagram.machine()))?,
        Incoming::Watch(is_wanted) => watch.set_wanted(is_wanted),
        Incoming::Patch(when_gone, path, locale) => {
            versions.ask(Change::Version(Asked {
                when_gone,
                path,
                locale,
            }));
            assign_due(versions, now, (diagram, robot, watch), host)?;
        }
        Incoming::Set(text, locale) => {
            versions.ask(Change::Set(text, locale));
            assign_due(versions, now, (diagram, robot, watch), host)?;
        }
        Incoming::Debug {
            client,
            tag,
            locale,
            order,
        } => {
            let answer = diagram.answer((tag, &order), locale, now, (robot, watch));
            host.debug(client, &answer)?;
            diagram.report(now, true, host)?;
        }
        Incoming::DebugLeft => {
            diagram.left(now, robot, watch);
            diagram.report(now, true, host)?;
        }
        // The daemon starts another program for them; a client that sends one all the same learns that it is lost.
        Incoming::Direct(_) => host.error(words::no_direct().in_locale(watch.locale()))?,
        // The caller knows.
        Incoming::Gone => {}
    }
    Ok(())
}

/// Assigns what is due. A version that is due begins to be prepared.
fn assign_due(
    versions: &mut Versions<Project>,
    now: u32,
    (diagram, robot, watch): (&mut Debugging, &mut Robot<'_>, &mut Watch),
    host: &Host,
) -> io::Result<()> {
    while let Some((text, locale)) = versions.next() {
        let (session, mut driven) = diagram.parts(robot);
        let answer = live::set(session, (&text, locale), &mut driven, watch);
        host.changed(answer.is_changed, &answer.text)?;
        tell_change(now, diagram, host)?;
    }
    Ok(())
}

/// Puts a version into force that is prepared, and does what was asked for after it.
fn take_version(
    versions: &mut Versions<Project>,
    now: u32,
    (diagram, robot, watch): (&mut Debugging, &mut Robot<'_>, &mut Watch),
    host: &Host,
) -> io::Result<()> {
    let Some(ready) = versions.ready() else {
        return Ok(());
    };
    let (answer, warnings) = match ready.version {
        Ok(Prepared { source, warnings }) => {
            let (session, mut driven) = diagram.parts(robot);
            let version = (ready.when_gone, &*ready.name, &source, ready.locale);
            let answer = live::patch(session, version, &mut driven, watch);
            (answer, warnings)
        }
        Err(answer) => (answer, Vec::new()),
    };
    if answer.is_changed {
        watch.tell_warnings(warnings, host);
    }
    for _ in 0..ready.count {
        host.changed(answer.is_changed, &answer.text)?;
    }
    tell_change(now, diagram, host)?;
    assign_due(versions, now, (diagram, robot, watch), host)
}

/// Something of the program has been changed, or was not.
fn tell_change(now: u32, diagram: &mut Debugging, host: &Host) -> io::Result<()> {
    diagram.changed();
    diagram.report(now, true, host)
}

/// Waits until a moment; true if something came from the daemon before.
fn wait(host: &Host, until: Instant) -> io::Result<bool> {
    let left = until.saturating_duration_since(Instant::now());
    let mut awaited = [PollFd::new(host.fd(), PollFlags::POLLIN)];
    match ppoll(&mut awaited, Some(TimeSpec::from(left)), None) {
        Ok(ready) => Ok(ready > 0),
        Err(nix::errno::Errno::EINTR) => Ok(false),
        Err(error) => Err(error.into()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_late_step_makes_no_later_one_late() {
        let start = Instant::now();
        let at = |us: u64| start + Duration::from_micros(us);
        for (due, done, expected) in [
            // In time, and a moment late, as every step is.
            (20_000, 20_000, 30_000),
            (20_000, 20_090, 30_000),
            (20_000, 29_999, 30_000),
            // One is missed: it is done at once, and the one after it is where it would have been.
            (20_000, 30_000, 30_000),
            (20_000, 33_500, 30_000),
            (30_000, 33_600, 40_000),
            // Many are: of them only the last.
            (20_000, 118_200, 110_000),
            (110_000, 118_300, 120_000),
        ] {
            assert_eq!(next_step(at(due), at(done)), at(expected), "{due} {done}");
        }
    }
}
