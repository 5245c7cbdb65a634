//! A project judged: from options to a world, a program and rules, and what came out as JSON.
//!
//! Owns the options of runs, and how an outcome reads. Verdict, report and trajectory are those of `trik check`.

use crate::failure::Failure;
use crate::options::Options;
use crate::project::{Answer, Project};
use crate::{limits, words};
use lang_constraint::{Entry, Level};
use lang_diagram::lower::{World, lower};
use lang_text::problem::{Locale, Problem, Severity};
use serde_json::{Value, json};
use sim::judge::debugged::Debugged;
use sim::judge::{self, Clock, Dataflow, Diagram, Outcome, Program, Settings, Task, Texts};
use std::rc::Rc;
use std::time::Duration;
use studio::explain::explanation;
use studio::findings::Findings;
use studio::program::Program as Opened;
use studio::verdict::Verdict;

/// How a project is run.
#[derive(Clone, Debug, Default)]
pub struct Wish {
    /// The world that takes the place of its own.
    pub field: Option<String>,
    /// How it is judged.
    pub settings: Settings,
    /// Whether a debugger may hold it.
    pub is_debugging: bool,
}

impl Wish {
    /// Reads the options of a run: `locale`, `field`, `seed`, `modelSeconds`, `wallSeconds`, `keepGoing`, `markerTraces`,
    /// `explain`, `trajectory`, `inputs`, `gamepad`, `debug`. `locale` is set as soon as it is known.
    ///
    /// # Errors
    /// [`Failure::Request`].
    pub fn read(text: &str, clock: Clock, locale: &mut Locale) -> Result<Self, Failure> {
        let mut options = Options::read(text)?;
        *locale = options.locale()?;
        let field = options.text("field")?;
        let seed = options.number("seed", 0.0, limits::SEED_MAX.into())?;
        let model = options.number("modelSeconds", 0.0, limits::MODEL_SECONDS_MAX)?;
        let wall = options.number("wallSeconds", 0.0, limits::WALL_SECONDS_MAX)?;
        let keep_going = options.flag("keepGoing")?;
        let is_marking = options.flag("markerTraces")?;
        let is_explaining = options.flag("explain")?;
        let is_recording = options.flag("trajectory")?;
        let answers = options.texts("inputs")?;
        let gamepad = options.text("gamepad")?;
        let is_debugging = options.flag("debug")?;
        options.end()?;
        let deeds = gamepad.map(|text| judge::hands::read(&text));
        let deeds = deeds
            .transpose()
            .map_err(|why| Failure::Request(words::wrong_gamepad(&why.to_string())))?;
        let usual = Settings::default();
        let settings = Settings {
            locale: *locale,
            keep_going,
            longest_ms: model.map_or(usual.longest_ms, |seconds| (seconds * 1000.0) as u32),
            longest: wall.map_or(usual.longest, Duration::from_secs_f64),
            clock,
            seed: seed.map_or(usual.seed, |seed| seed as u64),
            answers,
            deeds,
            is_marking,
            is_explaining,
            is_recording,
            ..usual
        };
        Ok(Self {
            field,
            settings,
            is_debugging,
        })
    }
}

/// A program in its world, before its first step.
pub struct Staged {
    /// World and rules.
    pub task: Task,
    /// The program.
    pub program: Machine,
    /// What is strange in the world.
    pub strange: Vec<Problem>,
}

/// A program of either language, with a debugger or without one.
#[derive(Debug)]
pub enum Machine {
    /// A diagram of control flow.
    Diagram(Box<Diagram>),
    /// A data-flow program.
    Flow(Box<Dataflow>),
    /// One of both that may be held.
    Debugged(Box<Debugged>),
}

impl Machine {
    /// As the judge has it.
    pub fn program(&mut self) -> &mut dyn Program {
        match self {
            Self::Diagram(program) => &mut **program,
            Self::Flow(program) => &mut **program,
            Self::Debugged(program) => &mut **program,
        }
    }

    /// The same, to look at.
    pub fn seen(&self) -> &dyn Program {
        match self {
            Self::Diagram(program) => &**program,
            Self::Flow(program) => &**program,
            Self::Debugged(program) => &**program,
        }
    }
}

/// Why nothing was run: what failed, and the lines of the report that tells it.
pub struct Refused {
    /// For people.
    pub failure: Failure,
    /// For the report.
    pub lines: Vec<String>,
    /// As it counts.
    pub verdict: Verdict,
}

/// Where diagrams run here.
pub fn world(settings: &Settings) -> World {
    World::Simulated {
        mailbox: false,
        gamepad: settings.deeds.is_some(),
    }
}

/// World and rules, with what is strange in them.
///
/// # Errors
/// Either has mistakes.
pub fn task(texts: Texts<'_>, locale: Locale) -> Result<(Task, Vec<Problem>), Box<Refused>> {
    Task::read(texts).map_err(|problems| {
        let is_error = |one: &&Problem| one.severity == Severity::Error;
        let errors = problems.iter().filter(is_error);
        Box::new(Refused {
            lines: errors.map(|one| judge::report::text(one, locale)).collect(),
            failure: Failure::World(problems),
            verdict: Verdict::NotRun,
        })
    })
}

/// Puts a project into its world.
///
/// # Errors
/// World, rules or program have mistakes.
pub fn stage(project: &Project, wish: &Wish) -> Result<Staged, Box<Refused>> {
    let locale = wish.settings.locale;
    let save = project.save();
    let texts = match &wish.field {
        // A field has its own pictures.
        Some(world) => Texts {
            world,
            blobs: None,
            templates: save.map(|save| &save.templates),
        },
        None => Texts {
            world: save
                .and_then(|save| save.world.as_deref())
                .unwrap_or_default(),
            blobs: save.and_then(|save| save.blobs.as_deref()),
            templates: save.map(|save| &save.templates),
        },
    };
    let (mut task, strange) = task(texts, locale)?;
    let is_debugging = wish.is_debugging;
    let program = match &project.program {
        Opened::Diagram(opened) => {
            let lowered =
                lower(&opened.project, world(&wish.settings)).map_err(|problem| Refused {
                    lines: vec![problem.in_locale(locale)],
                    failure: Failure::Program(vec![problem]),
                    verdict: Verdict::Structure,
                })?;
            task.plug_in(&opened.project, &lowered.program);
            let program = Rc::new(lowered.program);
            match is_debugging {
                true => Machine::Debugged(Box::new(Debugged::diagram(program, locale))),
                false => Machine::Diagram(Box::new(Diagram::new(program).remembering())),
            }
        }
        Opened::Flow(flow, _) | Opened::Text(flow) => {
            let program = flow.ready().map_err(|problems| Refused {
                lines: flow.lines(project.name.as_ref(), &problems, locale),
                failure: Failure::Program(problems),
                verdict: Verdict::Structure,
            })?;
            match is_debugging {
                true => Machine::Debugged(Box::new(Debugged::flow(program, locale))),
                false => Machine::Flow(Box::new(Dataflow::new(program, locale))),
            }
        }
    };
    Ok(Staged {
        task,
        program,
        strange,
    })
}

/// Runs a project to its verdict, in one call. Options are those of [`Wish::read`]; what cannot be run has a verdict too.
pub fn judge(project: &Project, options: &str, clock: Clock) -> Answer<Value> {
    let mut locale = Locale::default();
    let judged = Wish::read(options, clock, &mut locale).map(|mut wish| {
        wish.is_debugging = false;
        match stage(project, &wish) {
            Ok(mut staged) => {
                let program = staged.program.program();
                let outcome = judge::judge(&staged.task, program, &wish.settings);
                told(
                    &project.name,
                    project.findings(),
                    &staged.strange,
                    &outcome,
                    &wish.settings,
                )
            }
            Err(refused) => unrun(project, &refused, locale),
        }
    });
    (judged, locale)
}

/// What came out of a run, as JSON. Findings know the places in the file of this name.
pub fn told(
    name: &str,
    findings: Findings<'_>,
    strange: &[Problem],
    outcome: &Outcome,
    settings: &Settings,
) -> Value {
    let locale = settings.locale;
    let verdict = Verdict::of(outcome);
    let is_told = |entry: &&Entry| entry.level != Level::Variables;
    let entries = outcome.entries.iter().filter(is_told);
    let more = entries.clone().count().saturating_sub(limits::MESSAGES_MAX);
    let explanation = settings.is_explaining.then(|| explanation(outcome, locale));
    let trajectory = settings.is_recording.then(|| outcome.trajectory.write());
    json!({
        "verdict": verdict.name(),
        "failure": verdict.failure(),
        "ms": outcome.ms,
        "totalScore": outcome.total_score.filter(|score| score.is_finite()),
        "messages": entries.take(limits::MESSAGES_MAX).map(message).collect::<Vec<_>>(),
        "more": more,
        "printed": outcome.printed,
        "strange": findings.json(name, strange, locale),
        "report": judge::report::write(&outcome.entries),
        "explanation": explanation,
        "trajectory": trajectory,
    })
}

/// What was said in a run, as JSON.
pub fn message(entry: &Entry) -> Value {
    let text = entry.text.chars().take(limits::MESSAGE_CHARS_MAX);
    json!({
        "level": judge::report::level(entry.level),
        "ms": entry.at_ms,
        "place": entry.place,
        "text": text.collect::<String>(),
    })
}

/// A run that could not be, as JSON.
fn unrun(project: &Project, refused: &Refused, locale: Locale) -> Value {
    let said = refused.lines.iter();
    let said: Vec<_> = said
        .map(|line| ("error".to_owned(), line.clone()))
        .collect();
    let messages = said
        .iter()
        .take(limits::MESSAGES_MAX)
        .map(|(level, text)| json!({"level": level, "ms": 0, "place": "", "text": text}));
    let findings = Some(project.findings());
    let failure = refused.failure.json(&project.name, findings, locale);
    json!({
        "verdict": refused.verdict.name(),
        "failure": refused.verdict.failure(),
        "ms": 0,
        "totalScore": null,
        "messages": messages.collect::<Vec<_>>(),
        "more": said.len().saturating_sub(limits::MESSAGES_MAX),
        "printed": [],
        "strange": failure["problems"],
        "report": judge::report::of_messages(&said),
        "explanation": null,
        "trajectory": null,
    })
}
