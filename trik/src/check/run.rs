//! One run: files in, a verdict and files out.
//!
//! Owns what of a solution and a field is taken: a field replaces the whole world of a project. What becomes of it is known
//! in `sim`.

use super::args::CheckArgs;
use super::jobs::{Job, shown};
use super::recorded;
use super::row::Row;
use super::script::{self, Language, Setup};
use super::words;
use crate::diagrams::flow::{self, Flow};
use crate::diagrams::save::{Unreadable, open};
use crate::error::Error;
use crate::input;
use crate::input::words::{A_FILE, no_text, why};
use crate::limits;
use crate::output::Output;
use lang_constraint::Level;
use lang_diagram::lower::{World, lower};
use lang_diagram::program::Program as Lowered;
use lang_diagram::project::Project;
use lang_text::problem::{Locale, Problem, Severity, Words};
use sim::field::Locks;
use sim::judge::{
    self, Caption, Clock, Diagram, Outcome, Program, Settings, Task, Texts, Trajectory,
};
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::Duration;
use studio::explain;
use studio::verdict::Verdict;

/// Ends of the names of files, where each run has its own.
pub(super) const REPORT: &str = ".json";
pub(super) const TRAJECTORY: &str = ".trajectory.json";
pub(super) const SVG: &str = ".svg";
pub(super) const HTML: &str = ".html";
pub(super) const DISPLAY: &str = ".png";

/// What a worker is doing, for the thread that watches its time.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Phase {
    /// The program runs.
    Runs,
    /// It has ended; files are written.
    Ended,
}

/// Does a run and writes its files; tells how far it is.
pub(super) fn run(job: &Job, args: &CheckArgs, report_phase: &mut dyn FnMut(Phase)) -> Row {
    let mut row = Row {
        solution: shown(job.judged(args)),
        field: job.rules(args).map(shown),
        verdict: Verdict::NotRun,
        ms: 0,
        total_score: None,
        messages: Vec::new(),
        more: 0,
        printed: Vec::new(),
        explain: None,
    };
    match judged(job, args, report_phase) {
        Ok((task, outcome, strange)) => {
            let some = strange.iter().take(limits::ROW_WARNINGS_MAX);
            some.for_each(|line| row.say(words::WARNING, line));
            fill(&outcome, args.language, &mut row);
            if args.explain {
                row.explain = Some(explain::explanation(&outcome, args.language));
            }
            if let Err(lines) = write(job, args, &task, &outcome) {
                row.verdict = Verdict::NotRun;
                lines.iter().for_each(|line| row.say("error", line));
            }
        }
        Err(refused) => {
            row.verdict = refused.verdict;
            let lines = &refused.lines;
            lines.iter().for_each(|line| row.say("error", line));
            let said = refused.bare.into_iter();
            let said: Vec<_> = said.map(|text| ("error".to_owned(), text)).collect();
            report(job, args, &mut row, &said);
        }
    }
    row
}

/// Writes the report of a run that could not be, of these levels and messages.
pub(super) fn report(job: &Job, args: &CheckArgs, row: &mut Row, said: &[(String, String)]) {
    let Some(path) = &args.report else { return };
    let text = judge::report::of_messages(said);
    if let Err(why) = put(job, args, path, REPORT, text.as_bytes()) {
        row.say("error", &why.to_string());
    }
}

/// What came out, as a row.
fn fill(outcome: &Outcome, locale: Locale, row: &mut Row) {
    row.verdict = Verdict::of(outcome);
    row.ms = outcome.ms;
    row.total_score = outcome.total_score;
    row.printed.clone_from(&outcome.printed);
    if let Some(text) = &outcome.strange_score {
        row.say(words::WARNING, words::no_score(text).in_locale(locale));
    }
    // What is wrong with rules is wrong in each tick; a person needs it once.
    let mut told = BTreeSet::new();
    for entry in &outcome.entries {
        let is_new = entry.level != Level::Critical || told.insert(&entry.text);
        if entry.level != Level::Variables && is_new {
            row.say(judge::report::level(entry.level), &entry.line());
        }
    }
}

pub(crate) type Lines = Vec<String>;

/// Why a run cannot be: for people, with places, and for the report, which has none.
pub(super) struct Refused {
    pub(super) lines: Lines,
    pub(super) bare: Lines,
    pub(super) verdict: Verdict,
}

impl From<Lines> for Refused {
    fn from(lines: Lines) -> Self {
        let bare = lines.clone();
        Self {
            lines,
            bare,
            verdict: Verdict::NotRun,
        }
    }
}

impl Refused {
    /// Of problems in the file at a path.
    fn of(path: &Path, problems: &[Problem], locale: Locale) -> Self {
        let errors = problems
            .iter()
            .filter(|one| one.severity == Severity::Error);
        let bare = errors.map(|problem| judge::report::text(problem, locale));
        Self {
            lines: lines(path, problems, locale),
            bare: bare.collect(),
            verdict: Verdict::NotRun,
        }
    }

    /// The same where the solution is to blame.
    fn broken(lines: Lines) -> Self {
        Self {
            verdict: Verdict::Structure,
            ..lines.into()
        }
    }
}

/// An error as the only line.
pub(super) fn line(error: Error) -> Lines {
    vec![error.to_string()]
}

/// The task, what came out, and what is strange in the world.
fn judged(
    job: &Job,
    args: &CheckArgs,
    report_phase: &mut dyn FnMut(Phase),
) -> Result<(Task, Outcome, Lines), Refused> {
    let settings = settings(job, args).map_err(line)?;
    let mut solution = match &job.log {
        Some(log) if *log == job.solution => Solution::default(),
        _ => Solution::read(&job.solution, args)?,
    };
    let (mut task, mut strange) = solution.task(job, args)?;
    if let Some(log) = job.log.as_ref().filter(|log| recorded::is_recording(log)) {
        let (mut tape, told) = recorded::tape(log, &task, args)?;
        strange.extend(told);
        report_phase(Phase::Runs);
        let outcome = judge::witness::judge_seen(&task, &mut tape, &settings);
        report_phase(Phase::Ended);
        return Ok((task, outcome, strange));
    }
    if let Some(log) = &job.log {
        let text = text(log, limits::LOG_BYTES_MAX, args.language).map_err(line)?;
        let trajectory = Trajectory::read(&text);
        let trajectory = trajectory.map_err(|why| vec![format!("{}: {why}", shown(log))])?;
        let names = judge::strange_in_record(&task, &trajectory);
        let told = names.iter().map(|words| words.in_locale(args.language));
        strange.extend(told.map(|words| format!("{}: {words}", shown(log))));
        report_phase(Phase::Runs);
        let outcome = judge::judge_recorded(&task, &trajectory, &settings);
        report_phase(Phase::Ended);
        return Ok((task, outcome, strange));
    }
    let mut program = solution.program(&mut task, args)?;
    report_phase(Phase::Runs);
    let outcome = judge::judge(&task, &mut *program, &settings);
    drop(program);
    report_phase(Phase::Ended);
    Ok((task, outcome, strange))
}

/// The save that was given out, which has a world.
fn save(path: &Path, args: &CheckArgs) -> Result<Project, Lines> {
    let why = |words: Words| {
        vec![format!(
            "{}: {}",
            shown(path),
            words.in_locale(args.language)
        )]
    };
    let opened = open(path).map_err(|unreadable| match unreadable {
        Unreadable::File(words) | Unreadable::Diagram(words) => why(words),
        Unreadable::Save(problems) => lines(path, &problems, args.language),
    })?;
    match &opened.project.world {
        Some(_) => Ok(opened.project),
        None => Err(why(words::given_without_world())),
    }
}

/// Puts what a given task locks into the world of a solution.
fn hold(task: &mut Task, given: &Path, args: &CheckArgs) -> Result<Lines, Lines> {
    let project = save(given, args)?;
    let texts = Texts {
        world: project.world.as_deref().unwrap_or_default(),
        blobs: project.blobs.as_deref(),
        templates: Some(&project.templates),
    };
    let read = Task::read(texts).map_err(|problems| lines(given, &problems, args.language))?;
    let changed = task.hold(&read.0, Locks::of(&project.meta));
    let changed = changed.iter().map(|words| words.in_locale(args.language));
    Ok(changed.map(str::to_owned).collect())
}

pub(super) fn settings(job: &Job, args: &CheckArgs) -> Result<Settings, Error> {
    let answers = match job.inputs.as_ref().or(args.inputs.as_ref()) {
        None => Vec::new(),
        Some(path) => text(path, limits::WORLD_BYTES_MAX, args.language)?
            .lines()
            .map(str::to_owned)
            .collect(),
    };
    let deeds = match &args.gamepad {
        None => None,
        Some(path) => {
            let deeds = judge::hands::read(&text(path, limits::WORLD_BYTES_MAX, args.language)?);
            Some(deeds.map_err(|why| Error::file(path, why))?)
        }
    };
    Ok(Settings {
        locale: args.language,
        keep_going: args.keep_going,
        longest_ms: (args.time_limit * 1000.0) as u32,
        longest: Duration::from_secs_f64(args.wall_limit),
        clock: Clock::default(),
        seed: u64::from(args.seed),
        answers,
        deeds,
        is_marking: args.marker_traces,
        is_tracking: args.html.is_some(),
        is_showing: args.display.is_some(),
        is_explaining: args.explain,
        is_recording: [&args.trajectory, &args.svg, &args.html]
            .into_iter()
            .any(Option::is_some),
    })
}

/// What is to be judged.
#[derive(Default)]
pub(super) struct Solution {
    pub(super) project: Project,
    /// The data-flow program that is run instead of a diagram.
    pub(super) flow: Option<Flow>,
    pub(super) script: Option<(Language, String)>,
    /// Where the program comes from.
    file: PathBuf,
}

impl Solution {
    pub(super) fn read(path: &Path, args: &CheckArgs) -> Result<Self, Refused> {
        if path.extension().is_some_and(|ending| ending == "xml") && path.is_file() {
            return Err(vec![format!(
                "{}: {}",
                shown(path),
                words::is_world(args.language)
            )]
            .into());
        }
        let script = args.script.as_deref();
        let own = Language::of(path);
        let (project, flow, script) = match own {
            Some(_) if args.diagram.is_some() => {
                let why = words::diagram_of_no_diagram(args.language);
                return Err(vec![format!("{}: {why}", shown(path))].into());
            }
            Some(_) => (Project::default(), None, script.or(Some(path))),
            None => {
                let opened =
                    flow::open(path, args.diagram.as_deref()).map_err(|why| match why {
                        Unreadable::File(why) | Unreadable::Diagram(why) => {
                            let why = why.in_locale(args.language);
                            vec![format!("{}: {why}", shown(path))].into()
                        }
                        Unreadable::Save(problems) => {
                            Refused::broken(flow::unread(path, &problems, args.language))
                        }
                    })?;
                match opened {
                    flow::Program::Diagram(opened) => (opened.project, None, script),
                    flow::Program::Flow(flow, opened) => (opened.project, Some(flow), script),
                    flow::Program::Text(flow) => (Project::default(), Some(flow), script),
                }
            }
        };
        let script = match script {
            None => None,
            Some(path) => {
                let language = Language::of(path).ok_or_else(|| {
                    vec![format!(
                        "{}: programs are files NAME.js and NAME.py",
                        shown(path)
                    )]
                })?;
                let text = text(path, limits::WORLD_BYTES_MAX, args.language).map_err(line)?;
                Some((language, text))
            }
        };
        let script = match script {
            None if args.is_embedded => {
                let embedded = script::embedded(&project, path);
                Some(embedded.map_err(|why| Refused::broken(line(why)))?)
            }
            script => script,
        };
        let file = args.script.as_deref().unwrap_or(path).to_owned();
        Ok(Self {
            project,
            flow,
            script,
            file,
        })
    }

    /// The task that is judged by: of the field, of a given save, or of its own world. A field replaces the whole world.
    pub(super) fn task(&mut self, job: &Job, args: &CheckArgs) -> Result<(Task, Lines), Refused> {
        let field = match &job.field {
            None => None,
            Some(path) => Some(text(path, limits::WORLD_BYTES_MAX, args.language).map_err(line)?),
        };
        if let Some(world) = field {
            self.project.world = Some(world);
            // The field has its own pictures.
            self.project.blobs = None;
        }
        let mut given = job.given.as_ref().or(args.task.as_ref());
        let is_text = self.script.is_some() || flow::is_text(&job.solution);
        if self.project.world.is_none() && is_text {
            match given.take() {
                // A program with text has no world of its own: it runs in the save that was given out, as it was.
                Some(path) => self.project = save(path, args)?,
                // A data-flow program may as well run in an empty one, as a diagram without a world does.
                None if self.script.is_none() => {}
                None => {
                    let why = words::no_world(args.language);
                    return Err(vec![format!("{}: {why}", shown(&job.solution))].into());
                }
            }
        }
        let project = &self.project;
        // A diagram without a world runs in an empty one.
        let world = project.world.as_deref().unwrap_or_default();
        let place = job.field.as_deref().unwrap_or(&job.solution);
        let texts = Texts {
            world,
            blobs: project.blobs.as_deref(),
            templates: Some(&project.templates),
        };
        let task = Task::read(texts);
        let refused = |problems: Vec<Problem>| Refused::of(place, &problems, args.language);
        let (mut task, strange) = task.map_err(refused)?;
        let mut strange = lines(place, &strange, args.language);
        if let Some(given) = given {
            let changed = hold(&mut task, given, args)?;
            strange.extend(
                changed
                    .into_iter()
                    .map(|why| format!("{}: {why}", shown(place))),
            );
        }
        Ok((task, strange))
    }

    /// The diagram, lowered; the task gets the sensors that it needs.
    pub(super) fn diagram(
        &self,
        task: &mut Task,
        args: &CheckArgs,
    ) -> Result<Rc<Lowered>, Refused> {
        let lowered = lower(&self.project, world(args));
        let lowered =
            lowered.map_err(|problem| Refused::broken(vec![problem.in_locale(args.language)]))?;
        task.plug_in(&self.project, &lowered.program);
        Ok(Rc::new(lowered.program))
    }

    /// The program, ready for its first step; the task gets the sensors that it needs.
    fn program(self, task: &mut Task, args: &CheckArgs) -> Result<Box<dyn Program>, Refused> {
        if let Some((language, text)) = &self.script {
            let given = Setup {
                file: &self.file,
                seed: args.seed,
                is_watched: args.explain || args.html.is_some(),
                wall_seconds: args.wall_limit,
                sandbox: args.sandbox.sandbox(),
            };
            return script::open(*language, text, given).map_err(|why| line(why).into());
        }
        if let Some(flow) = &self.flow {
            let program = ready(flow, &self.file, args)?;
            return Ok(Box::new(judge::Dataflow::new(program, args.language)));
        }
        let diagram = Diagram::new(self.diagram(task, args)?);
        Ok(Box::new(match args.explain {
            true => diagram.remembering(),
            false => diagram,
        }))
    }
}

/// A data-flow program without mistakes.
pub(super) fn ready(
    flow: &Flow,
    file: &Path,
    args: &CheckArgs,
) -> Result<Rc<lang_dataflow::program::Program>, Refused> {
    let ready = flow.ready();
    ready.map_err(|problems| Refused::broken(flow.lines(file, &problems, args.language)))
}

/// What a diagram finds in a world.
pub(super) fn world(args: &CheckArgs) -> World {
    World::Simulated {
        mailbox: false,
        gamepad: args.gamepad.is_some(),
    }
}

fn lines(path: &Path, problems: &[Problem], locale: Locale) -> Lines {
    let name = shown(path);
    problems
        .iter()
        .map(|problem| format!("{name}: {}", problem.in_locale(locale)))
        .collect()
}

/// A text file that is no longer than it may be.
pub(super) fn text(path: &Path, max: u64, locale: Locale) -> Result<String, Error> {
    let failed = |words: Words| Error::file(path, words.in_locale(locale));
    let bytes = input::read(path, max).map_err(|unread| failed(why(&unread, max, A_FILE)))?;
    String::from_utf8(bytes).map_err(|_| failed(no_text()))
}

/// Writes the files of a run.
fn write(job: &Job, args: &CheckArgs, task: &Task, outcome: &Outcome) -> Result<(), Lines> {
    let mut wrong = Vec::new();
    let mut write = |path: &Option<std::path::PathBuf>, ending, make: &dyn Fn() -> Vec<u8>| {
        if let Some(path) = path
            && let Err(why) = put(job, args, path, ending, &make())
        {
            wrong.push(why.to_string());
        }
    };
    write(&args.report, REPORT, &|| {
        judge::report::write(&outcome.entries).into()
    });
    write(&args.trajectory, TRAJECTORY, &|| {
        outcome.trajectory.write().into()
    });
    write(&args.svg, SVG, &|| {
        judge::svg(&task.field, &outcome.trajectory, args.language).into()
    });
    write(&args.display, DISPLAY, &|| {
        outcome.display.clone().unwrap_or_default()
    });
    write(&args.html, HTML, &|| {
        let mut row = Row::broken(shown(job.judged(args)), None, String::new());
        fill(outcome, args.language, &mut row);
        let verdict = format!(
            "{}, {}",
            words::verdict(row.verdict, args.language),
            words::seconds(outcome.ms, args.language)
        );
        let caption = Caption {
            title: &row.solution,
            verdict: &verdict,
            is_good: row.verdict.is_good(),
            locale: args.language,
            track: &outcome.track,
        };
        let (poses, entries) = (&outcome.trajectory, &outcome.entries);
        judge::page(&task.field, poses, entries, caption).into()
    });
    match wrong.is_empty() {
        true => Ok(()),
        false => Err(wrong),
    }
}

/// Writes one file of a run.
fn put(job: &Job, args: &CheckArgs, path: &Path, ending: &str, bytes: &[u8]) -> Result<(), Error> {
    let is_one = args.is_one;
    let path = job.place(path, ending, is_one);
    if let (false, Some(folder)) = (is_one, path.parent()) {
        let made = std::fs::create_dir_all(folder);
        made.map_err(|error| Error::system(format!("{} cannot be made", folder.display()), error))?;
    }
    let output = Output {
        path: Some(&path),
        force: args.force,
        source: job.judged(args),
        locale: args.language,
    };
    output.write(bytes).map_err(|refusal| {
        let lines: Vec<&str> = refusal.lines.iter().map(|line| plain(line)).collect();
        Error::Refused(lines.join("; "))
    })
}

/// A line without the name of the program, which begins what goes to a terminal.
fn plain(line: &str) -> &str {
    line.strip_prefix("trik: ").unwrap_or(line)
}
