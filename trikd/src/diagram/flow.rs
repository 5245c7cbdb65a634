//! Programs of data flow on a robot: the machine of crate `lang-dataflow` with the tree as its robot.
//!
//! Owns the time of a running program, and when something is told of it. What orders of a
//! debugger do is known in `lang_dataflow::debug`, and what a new version keeps in `lang_dataflow::machine::patch`.

use super::live::{self, Answer, Prepared};
use super::motors::Motors;
use super::robot::Robot;
use super::source::Source;
use super::versions::{Asked, Change, Ready, Versions};
use super::watch::Watch;
use super::{hear_until, next_step, since};
use crate::engine::{Failure, Outcome};
use crate::host::{Host, Incoming};
use crate::limits;
use crate::protocol::news;
use crate::protocol::program::ALL;
use lang_dataflow::debug::Desk;
use lang_dataflow::diary::Diary;
use lang_dataflow::machine::Machine;
use lang_dataflow::machine::patch::{Refused, Version};
use lang_dataflow::machine::trace::{Deaf, Trace};
use lang_dataflow::program::{NodeId, Program};
use lang_diagram::machine::Status;
use lang_expr::Value;
use lang_text::problem::{Locale, Problem};
use std::cell::Cell;
use std::collections::VecDeque;
use std::io;
use std::path::Path;
use std::rc::Rc;
use std::time::Instant;

/// What is heard of a machine.
struct Heard<'a> {
    watch: &'a mut Watch,
    /// While somebody looks or records.
    diary: Option<&'a mut Diary>,
}

impl Trace for Heard<'_> {
    fn sent(&mut self, now: u32, from: NodeId, port: u8, value: &Value) {
        if let Some(diary) = &mut self.diary {
            diary.sent(now, from, port, value);
        }
    }

    fn fired(&mut self, now: u32, node: NodeId) {
        self.watch.fired();
        if let Some(diary) = &mut self.diary {
            diary.fired(now, node);
        }
    }

    fn trap(&mut self, _now: u32, problem: &Problem) {
        self.watch.note(problem);
    }
}

/// A program that runs, with its debugger.
struct Flow {
    desk: Desk,
    /// What it was made of: where its blocks are.
    source: Source,
    motors: Motors,
    /// What happens at its blocks, while somebody looks or records.
    diary: Option<Diary>,
    /// Warnings that were told.
    warned: usize,
    was_stopped: bool,
    told_at: u32,
    versions: Versions<Source>,
}

/// Steps until the program has ended or the daemon is gone; `is_debugged`: it stops before its first block.
pub(super) fn run(
    (program, source): (Rc<Program>, Source),
    is_debugged: bool,
    robot: &mut Robot<'_>,
    watch: &mut Watch,
    host: &Host,
) -> Outcome {
    let mut flow = Flow {
        desk: Desk::new(
            Machine::new(program),
            watch.locale(),
            limits::DEBUG_HISTORY_BYTES,
        ),
        source,
        motors: Motors::default(),
        diary: None,
        warned: 0,
        was_stopped: false,
        told_at: 0,
        versions: Versions::new(prepared, watch.locale()),
    };
    if is_debugged {
        flow.desk.stop_first();
    }
    let ran = flow.steps(robot, watch, host);
    flow.desk.stop(&mut flow.motors.over(robot), &mut Deaf);
    ran.map_err(|error| Failure::Deaf(error.into()))?;
    match flow.desk.machine().errors() {
        [] => Ok(()),
        // They were told when they happened.
        _ => Err(Failure::Told),
    }
}

impl Flow {
    fn steps(&mut self, robot: &mut Robot<'_>, watch: &mut Watch, host: &Host) -> io::Result<()> {
        let start = Instant::now();
        let mut due = start;
        let mut early = self.look_first(watch, host)?;
        loop {
            let now = since(start);
            let mut heard = Heard {
                watch,
                diary: self.diary.as_mut(),
            };
            let status = self
                .desk
                .step(now, &mut self.motors.over(robot), &mut heard);
            self.motors.settle(self.desk.is_at_rest(), robot);
            let warnings = self.desk.machine().warnings();
            for problem in warnings.iter().skip(self.warned) {
                host.info(&self.source.line(problem, watch.locale()))?;
            }
            self.warned = warnings.len();
            let is_over = status != Status::Running;
            let program = (self.desk.machine(), &self.source);
            let diary = self.diary.as_mut();
            match is_over {
                true => watch.last_of_flow(program, diary, now, host)?,
                false => watch.report_flow(program, diary, now, host)?,
            }
            self.report(now, is_over, host)?;
            if is_over {
                return Ok(());
            }
            robot.go_on();
            // Steps that are missed are not made up: timers look at the time, not at steps.
            due = next_step(due, Instant::now());
            for message in early.drain(..) {
                if matches!(message, Incoming::Gone) {
                    return Ok(());
                }
                self.hear(message, since(start), (robot, watch), host)?;
            }
            if !self.hear_all(start, due, (robot, watch), host)? {
                return Ok(());
            }
        }
    }

    /// Hears the daemon until a step is due, and takes each new version as soon as it is ready; whether the daemon is there.
    fn hear_all(
        &mut self,
        start: Instant,
        due: Instant,
        (robot, watch): (&mut Robot<'_>, &mut Watch),
        host: &Host,
    ) -> io::Result<bool> {
        loop {
            let until = Cell::new(self.versions.until(due));
            let hear = |message| {
                self.hear(message, since(start), (&mut *robot, &mut *watch), host)?;
                until.set(self.versions.until(due));
                Ok(())
            };
            if !hear_until(&until, host, hear)? {
                return Ok(false);
            }
            self.take_version(since(start), (robot, watch), host)?;
            if Instant::now() >= due {
                return Ok(true);
            }
        }
    }

    /// Whether somebody looks is known before the first instant, so that this is not missed; all else that has come is heard
    /// after it.
    fn look_first(&mut self, watch: &mut Watch, host: &Host) -> io::Result<VecDeque<Incoming>> {
        let mut early = VecDeque::new();
        while let Some(message) = host.waiting()? {
            match message {
                Incoming::Watch(is_wanted) => {
                    watch.set_wanted(is_wanted);
                    self.keep_diary(is_wanted);
                }
                Incoming::Gone => {
                    early.push_back(message);
                    break;
                }
                Incoming::Mail(..)
                | Incoming::Reply(..)
                | Incoming::Web
                | Incoming::Patch(..)
                | Incoming::Set(..)
                | Incoming::Debug { .. }
                | Incoming::DebugLeft
                | Incoming::Direct(_) => early.push_back(message),
            }
        }
        Ok(early)
    }

    /// Tells all who debug what is new, if it is time; after an order it always is.
    fn report(&mut self, now: u32, is_time: bool, host: &Host) -> io::Result<()> {
        let is_stopped = self.desk.is_stopped();
        let is_due = now.saturating_sub(self.told_at) >= limits::WATCH_MS;
        if !is_time && !is_due && is_stopped == self.was_stopped {
            return Ok(());
        }
        self.was_stopped = is_stopped;
        self.told_at = now;
        if let Some(log) = self.desk.log() {
            host.debug_log(&log)?;
        }
        for state in self.desk.news() {
            host.debug(ALL, &state)?;
        }
        Ok(())
    }

    /// Does what the daemon asks for between two steps.
    fn hear(
        &mut self,
        message: Incoming,
        now: u32,
        (robot, watch): (&mut Robot<'_>, &mut Watch),
        host: &Host,
    ) -> io::Result<()> {
        match message {
            Incoming::Mail(sender, text) => robot.post(sender, text),
            Incoming::Reply(number, text) => robot.answer(number, text),
            Incoming::Web => {
                let variables = self.desk.machine().variables();
                host.web(&super::watch::variables_of(variables))?;
            }
            Incoming::Watch(is_wanted) => {
                watch.set_wanted(is_wanted);
                self.keep_diary(is_wanted);
            }
            Incoming::Patch(when_gone, path, locale) => {
                self.versions.ask(Change::Version(Asked {
                    when_gone,
                    path,
                    locale,
                }));
                self.assign_due(now, host)?;
            }
            Incoming::Set(text, locale) => {
                self.versions.ask(Change::Set(text, locale));
                self.assign_due(now, host)?;
            }
            Incoming::Debug {
                client,
                tag,
                locale,
                order,
            } => {
                let own = self.desk.speak(locale);
                let answer = self.desk.order((tag, &order));
                self.desk.speak(own);
                self.motors.settle(self.desk.is_at_rest(), robot);
                host.debug(client, &answer)?;
                self.report(now, true, host)?;
            }
            Incoming::DebugLeft => {
                self.desk.left();
                self.motors.settle(self.desk.is_at_rest(), robot);
                self.report(now, true, host)?;
            }
            Incoming::Direct(_) => {
                host.error(super::words::no_direct().in_locale(watch.locale()))?
            }
            // The caller knows.
            Incoming::Gone => {}
        }
        Ok(())
    }

    /// What happens is kept while somebody wants to know it; a client that has missed some of it is told all once more.
    fn keep_diary(&mut self, is_wanted: bool) {
        match (&mut self.diary, is_wanted) {
            (Some(diary), true) => diary.tell_again(),
            (None, true) => self.diary = Some(Diary::new(self.desk.machine().program())),
            (_, false) => self.diary = None,
        }
    }

    /// Assigns what is due. A version that is due begins to be prepared.
    fn assign_due(&mut self, now: u32, host: &Host) -> io::Result<()> {
        while let Some((text, locale)) = self.versions.next() {
            let answer = self.set(&text, locale);
            host.changed(answer.is_changed, &answer.text)?;
            self.report(now, true, host)?;
        }
        Ok(())
    }

    /// Puts a version into force that is prepared, and does what was asked for after it.
    fn take_version(
        &mut self,
        now: u32,
        (robot, watch): (&mut Robot<'_>, &mut Watch),
        host: &Host,
    ) -> io::Result<()> {
        let Some(ready) = self.versions.ready() else {
            return Ok(());
        };
        // Blocks have other numbers then.
        if self.diary.as_ref().is_some_and(Diary::has_news) {
            let program = (self.desk.machine(), &self.source);
            watch.last_of_flow(program, self.diary.as_mut(), now, host)?;
        }
        let count = ready.count;
        let answer = self.patch(ready, robot, watch, host);
        for _ in 0..count {
            host.changed(answer.is_changed, &answer.text)?;
        }
        self.report(now, true, host)?;
        self.assign_due(now, host)
    }

    /// Replaces the program by a version, whole or not at all. There are no threads whose block could be gone.
    fn patch(
        &mut self,
        ready: Ready<Source>,
        robot: &mut Robot<'_>,
        watch: &mut Watch,
        host: &Host,
    ) -> Answer {
        let Prepared { source, warnings } = match ready.version {
            Ok(prepared) => prepared,
            Err(answer) => return answer,
        };
        let patched = Version::of_checked(&source.project)
            .and_then(|version| self.desk.patch(&version, &mut self.motors.over(robot)));
        match patched {
            Ok(patched) => {
                if let Some(diary) = &mut self.diary {
                    *diary = Diary::new(self.desk.machine().program());
                }
                // It keeps those that there were.
                self.warned = self.desk.machine().warnings().len();
                watch.tell_warnings(warnings, host);
                self.source = source;
                Answer::changed(&ready.name, &patched.to_string())
            }
            Err(why) => Answer::unchanged(&ready.name, &explained(&why, &source, ready.locale)),
        }
    }

    /// Assigns a variable: `NAME=EXPRESSION`.
    fn set(&mut self, text: &str, locale: Locale) -> Answer {
        let (name, expression) = text.split_once('=').unwrap_or((text, ""));
        let name = name.trim();
        match self.desk.assign(name, expression.trim()) {
            Ok(()) => {
                let value = self.desk.machine().value_of(name);
                let value = value.map_or_else(String::new, |value| value.brief());
                Answer::changed(name, &format!("{name} = {value}"))
            }
            Err(why) => Answer::unchanged(name, &why.in_locale(locale)),
        }
    }
}

/// The program in a file, if nothing is wrong with it whatever runs. Knows no program that runs, so that another thread may
/// do it. `own` is the language of the program, `locale` that of the one who asks.
fn prepared(path: &Path, own: Locale, locale: Locale) -> Result<Prepared<Source>, Answer> {
    let name = live::name(path);
    let source = Source::open(path, locale)
        .map_err(|why| Answer::unchanged(&name, &why.in_locale(locale)))?;
    let sheets = source.project.diagrams.iter();
    let blocks = sheets.flat_map(|sheet| &sheet.blocks);
    live::fits(blocks.map(|block| &block.properties))
        .map_err(|why| Answer::unchanged(&name, why.in_locale(locale)))?;
    let found = Version::mistakes(&source.project)
        .map_err(|why| Answer::unchanged(&name, &explained(&why, &source, locale)))?;
    let all = [&source.problems[..], &found].concat();
    Ok(Prepared {
        warnings: source.warnings(&all, own),
        source,
    })
}

fn explained(why: &Refused, source: &Source, locale: Locale) -> String {
    match why {
        Refused::Ended => news::NO_DIAGRAM.to_owned(),
        Refused::Mistakes(problems) => source.lines(problems, locale).join("\n"),
    }
}
