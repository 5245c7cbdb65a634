//! A run that is drawn while it goes: some ticks in each call, and what there is to see between two calls.
//!
//! Owns what is seen: where the robot is and was, devices, variables, blocks, what was said. The order of a tick and the
//! verdict are those of the judge; orders to a debugger are those of `trik debug`.

use crate::failure::Failure;
use crate::judged::{self, Machine, Staged, Wish, message, stage, told, world};
use crate::project::{Answer, Project};
use crate::{limits, words};
use lang_constraint::{Entry, Level};
use lang_dataflow::machine::patch as flow;

use lang_diagram::machine::patch as diagram;
use lang_diagram::ports::Sort;
use lang_text::problem::{Locale, Problem};
use serde_json::{Map, Value, json};
use sim::judge::debugged::{self, Refused, Version};
use sim::judge::track::Group;
use sim::judge::{Clock, Outcome, Progress, Running, Settings, Spot, Trial, devices};
use sim::show::seen;
use std::time::Duration;
use studio::program::Program;

/// A run between its beginning and its verdict, and after it.
pub struct Run {
    project: Project,
    settings: Settings,
    strange: Vec<Problem>,
    stage: Stage,
    machine: Machine,
    /// Milliseconds, x, y and degrees of the first robot after each tick, as trajectories have them.
    trail: Vec<f64>,
    /// Its middle in metres, x and y in turn.
    way: Vec<f64>,
    /// Messages and prints that were taken.
    said: usize,
    printed: usize,
}

/// How far it is.
enum Stage {
    Runs(Box<Trial>),
    /// Between both, within one call.
    Ends,
    Over(Box<Over>),
}

/// What is left of a run.
struct Over {
    outcome: Outcome,
    scene: String,
    state: String,
}

impl Run {
    /// Before the first tick. Options are those of [`Wish::read`]; the caller bounds real time.
    pub fn begin(project: &Project, options: &str) -> Answer<Self> {
        let mut locale = Locale::default();
        let begun = Wish::read(options, Clock::default(), &mut locale).and_then(|mut wish| {
            // Somebody looks at it, and may let it stand for an hour.
            wish.settings.longest = Duration::MAX;
            wish.settings.is_showing = true;
            let staged =
                stage(project, &wish).map_err(|refused: Box<judged::Refused>| refused.failure)?;
            Ok(Self::of(project.clone(), staged, wish.settings))
        });
        (begun, locale)
    }

    fn of(project: Project, staged: Staged, settings: Settings) -> Self {
        let mut machine = staged.program;
        let trial = Trial::new(&staged.task, machine.program(), &settings);
        let mut run = Self {
            project,
            settings,
            strange: staged.strange,
            stage: Stage::Runs(Box::new(trial)),
            machine,
            trail: Vec::new(),
            way: Vec::new(),
            said: 0,
            printed: 0,
        };
        run.settle();
        run
    }

    /// What it is doing.
    pub fn progress(&self) -> &'static str {
        match &self.stage {
            Stage::Ends | Stage::Over(_) => "over",
            Stage::Runs(trial) => match trial.progress() {
                Progress::Runs => "runs",
                Progress::Held => "held",
                Progress::Over => "over",
            },
        }
    }

    /// Makes at most so many ticks of 10 ms, and not more than [`limits::TICKS_MAX`]; one that a debugger holds makes none,
    /// and goes on with a search through its past. What it is doing then.
    pub fn tick(&mut self, count: u32) -> &'static str {
        for _ in 0..count.min(limits::TICKS_MAX) {
            let Stage::Runs(trial) = &mut self.stage else {
                break;
            };
            if trial.progress() != Progress::Runs {
                break;
            }
            trial.tick(self.machine.program());
            self.keep_place();
        }
        if let Machine::Debugged(program) = &mut self.machine {
            let mut pieces = 0..limits::SEARCHES_MAX;
            while program.search_on() && pieces.next().is_some() {}
        }
        self.settle();
        self.progress()
    }

    fn keep_place(&mut self) {
        let Stage::Runs(trial) = &self.stage else {
            return;
        };
        if let Some(robot) = trial.arena().robots().first() {
            let pose = robot.pose();
            let place = [f64::from(trial.now()), pose.x, pose.y, pose.degrees];
            self.trail.extend(place);
            let (x, y) = seen::middle(robot);
            self.way.extend([x, y]);
        }
    }

    /// Ends it if it is decided.
    fn settle(&mut self) {
        let Stage::Runs(trial) = &self.stage else {
            return;
        };
        if trial.progress() == Progress::Over {
            self.end();
        }
    }

    /// Ends it as it is: the program is stopped. What is not decided then stays so.
    pub fn end(&mut self) {
        let Stage::Runs(trial) = &self.stage else {
            return;
        };
        let (scene, state) = (seen::still(trial.arena()), self.state());
        let before = std::mem::replace(&mut self.stage, Stage::Ends);
        self.stage = match before {
            Stage::Runs(trial) => Stage::Over(Box::new(Over {
                outcome: trial.outcome(self.machine.program()),
                scene,
                state,
            })),
            before @ (Stage::Ends | Stage::Over(_)) => before,
        };
    }

    /// What came out, as [`crate::judged::judge`] tells it; nothing before the end.
    pub fn outcome(&self) -> Option<Value> {
        match &self.stage {
            Stage::Runs(_) | Stage::Ends => None,
            Stage::Over(over) => Some(told(
                &self.project,
                &self.strange,
                &over.outcome,
                &self.settings,
            )),
        }
    }

    /// What stands still in the world, as JSON: metres, x to the right, y up, degrees counter-clockwise.
    pub fn scene(&self) -> String {
        match &self.stage {
            Stage::Runs(trial) => seen::still(trial.arena()),
            Stage::Ends => String::new(),
            Stage::Over(over) => over.scene.clone(),
        }
    }

    /// What moves in it, and what its program does, as JSON.
    pub fn state(&self) -> String {
        let trial = match &self.stage {
            Stage::Runs(trial) => trial,
            Stage::Ends => return String::new(),
            Stage::Over(over) => return over.state.clone(),
        };
        let locale = self.settings.locale;
        let (mut motors, mut sensors) = (Map::new(), Map::new());
        if let Some(robot) = trial.arena().robots().first() {
            devices(robot, &mut |port, value, is_idle| {
                let into = match port.sort() {
                    Sort::Motor | Sort::Servo => &mut motors,
                    Sort::Encoder | Sort::Scalar | Sort::Button(_) | Sort::Vector => &mut sensors,
                };
                if !is_idle {
                    into.insert(port.name().to_owned(), value.into());
                }
            });
        }
        let mut variables = Map::new();
        let program = self.machine.seen();
        program.describe(locale, &mut |group, name, value| {
            if group == Group::Variable {
                variables.insert(name.to_owned(), value.into());
            }
        });
        let threads = program.running();
        let threads = threads.iter().filter(|one| one.ended_ms.is_none());
        let mut text = json!({
            "ms": trial.now(),
            "progress": self.progress(),
            "motors": motors,
            "sensors": sensors,
            "variables": variables,
            "threads": threads.map(|one| thread(one, locale)).collect::<Vec<_>>(),
        })
        .to_string();
        // The world is JSON already.
        text.pop();
        text.push_str(",\"world\":");
        text.push_str(&seen::motion(trial.arena()));
        text.push('}');
        text
    }

    /// Where the robot was after each tick, from this one on: milliseconds, pixels to the right and down of the upper left
    /// corner of the unturned robot, degrees clockwise. At most [`limits::TRAIL_NUMBERS_MAX`] numbers.
    pub fn trail(&self, from: usize) -> &[f64] {
        let begin = from.saturating_mul(4).min(self.trail.len());
        let end = self.trail.len().min(begin + limits::TRAIL_NUMBERS_MAX);
        &self.trail[begin..end]
    }

    /// Where the middle of the robot was after each tick, from this one on: metres, x to the right and y up. At most
    /// [`limits::TRAIL_NUMBERS_MAX`] numbers.
    pub fn way(&self, from: usize) -> &[f64] {
        let begin = from.saturating_mul(2).min(self.way.len());
        let end = self.way.len().min(begin + limits::TRAIL_NUMBERS_MAX);
        &self.way[begin..end]
    }

    /// What rules and program have said and printed since the last time.
    pub fn news(&mut self) -> Value {
        let (entries, printed): (&[Entry], &[String]) = match &self.stage {
            Stage::Runs(trial) => {
                let shown = trial.arena().robots().first().map(|robot| robot.shown());
                (trial.entries(), shown.map_or(&[], |shown| &shown.printed))
            }
            Stage::Ends => (&[], &[]),
            Stage::Over(over) => (&over.outcome.entries, &over.outcome.printed),
        };
        let new = entries.get(self.said..).unwrap_or_default();
        let new = &new[..new.len().min(limits::MESSAGES_MAX)];
        let is_told = |entry: &&Entry| entry.level != Level::Variables;
        let messages: Vec<Value> = new.iter().filter(is_told).map(message).collect();
        let lines = printed.get(self.printed..).unwrap_or_default();
        let news = json!({"messages": messages, "printed": lines});
        self.said += new.len();
        self.printed = printed.len().max(self.printed);
        news
    }

    /// The display of the robot, as a PNG file; empty without a robot.
    pub fn display(&self) -> Vec<u8> {
        match &self.stage {
            Stage::Runs(trial) => {
                let robot = trial.arena().robots().first();
                robot.map_or_else(Vec::new, |robot| robot.shown().screen.png())
            }
            Stage::Ends => Vec::new(),
            Stage::Over(over) => over.outcome.display.clone().unwrap_or_default(),
        }
    }

    /// Gives its debugger an order, a line as `trik debug` sends it: `attach`, `pause`, `break ID`, `step in`. The answer is
    /// that of the desk of its language, as JSON.
    ///
    /// # Errors
    /// It has no debugger, or the order is longer than [`limits::ORDER_BYTES_MAX`].
    pub fn order(&mut self, text: &str) -> Result<String, Failure> {
        if text.len() > limits::ORDER_BYTES_MAX {
            let most = limits::ORDER_BYTES_MAX;
            let words = words::too_long("an order", text.len(), most);
            return Err(Failure::Request(words));
        }
        let Machine::Debugged(program) = &mut self.machine else {
            return Err(Failure::Request(words::no_debugger()));
        };
        let answer = match &mut self.stage {
            Stage::Runs(trial) => debugged::order(trial, program, 0, text),
            Stage::Ends | Stage::Over(_) => debugged::order_after(program, 0, text),
        };
        self.settle();
        Ok(answer)
    }

    /// Puts a new version of its program into the run, between two ticks: what stays keeps its state. What has changed, in words.
    ///
    /// # Errors
    /// It has no debugger or is over, the version has mistakes, or a thread is where the version has nothing. Nothing has
    /// changed then.
    pub fn patch(&mut self, project: &Project) -> Result<String, Failure> {
        let Machine::Debugged(program) = &mut self.machine else {
            return Err(Failure::Request(words::no_debugger()));
        };
        let Stage::Runs(trial) = &mut self.stage else {
            return Err(Failure::Request(words::run_is_over()));
        };
        let version = match &project.program {
            Program::Diagram(opened) => {
                let version = diagram::Version::of(&opened.project, world(&self.settings));
                Version::Diagram(version.map_err(|why| refused(&Refused::Diagram(why)))?)
            }
            Program::Flow(flow, _) | Program::Text(flow) => {
                Version::Flow(flow.ready().map_err(Failure::Program)?.into())
            }
        };
        let patched = debugged::patch(trial, program, &version);
        let patched = patched.map_err(|why| refused(&why))?;
        self.project = project.clone();
        self.settle();
        Ok(patched)
    }

    /// What its debugger tells by itself since the last time: JSON, a list.
    pub fn reports(&mut self) -> String {
        match &mut self.machine {
            Machine::Debugged(program) => format!("[{}]", program.news().join(",")),
            Machine::Diagram(_) | Machine::Flow(_) => "[]".to_owned(),
        }
    }

    /// The language of its messages.
    pub fn locale(&self) -> Locale {
        self.settings.locale
    }

    /// What is run.
    pub fn project(&self) -> &Project {
        &self.project
    }
}

/// Why a version is not taken.
fn refused(why: &Refused) -> Failure {
    let problems = match why {
        Refused::Diagram(why) => why.problems(),
        Refused::Flow(flow::Refused::Ended) => &[],
        Refused::Flow(flow::Refused::Mistakes(problems)) => problems,
        Refused::OtherLanguage => return Failure::Request(words::other_language()),
    };
    match problems {
        [] => Failure::Request(words::run_is_over()),
        problems => Failure::Program(problems.to_vec()),
    }
}

/// Where a thread is.
fn thread(one: &Running, locale: Locale) -> Value {
    match &one.at {
        Spot::Block {
            diagram,
            id,
            kind,
            caption,
        } => {
            let caption = caption.in_locale(locale);
            json!({"thread": one.thread, "diagram": diagram, "id": id, "kind": kind, "block": caption})
        }
        Spot::Line { file, line, .. } => {
            json!({"thread": one.thread, "file": file, "line": line})
        }
    }
}
