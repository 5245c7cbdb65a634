//! A run between its beginning and its verdict, whatever drives the robot, and what there is to see of it between two calls.
//!
//! Owns what is seen: where the robot is and was, devices, variables, lines and blocks, what was said. The order of a tick and
//! the verdict are those of the judge. The program is handed in.

use crate::judged::{message, told};
use crate::limits;
use lang_constraint::{Entry, Level};
use lang_diagram::ports::Sort;
use lang_text::problem::{Locale, Problem};
use serde_json::{Map, Value, json};
use sim::judge::track::Group;
use sim::judge::{Outcome, Program, Progress, Running, Settings, Spot, Task, Trial, devices};
use sim::show::seen;
use studio::findings::Findings;

/// A run without its program.
pub struct Course {
    settings: Settings,
    strange: Vec<Problem>,
    stage: Stage,
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

impl Course {
    /// Before the first tick. `strange` is what was found in the world.
    pub fn new(
        task: &Task,
        strange: Vec<Problem>,
        program: &mut dyn Program,
        settings: Settings,
    ) -> Self {
        let trial = Trial::new(task, program, &settings);
        let mut course = Self {
            settings,
            strange,
            stage: Stage::Runs(Box::new(trial)),
            trail: Vec::new(),
            way: Vec::new(),
            said: 0,
            printed: 0,
        };
        course.settle(program);
        course
    }

    /// The run itself, until it is over.
    pub fn trial(&mut self) -> Option<&mut Trial> {
        match &mut self.stage {
            Stage::Runs(trial) => Some(trial),
            Stage::Ends | Stage::Over(_) => None,
        }
    }

    /// How it is judged.
    pub fn settings(&self) -> &Settings {
        &self.settings
    }

    /// The language of its messages.
    pub fn locale(&self) -> Locale {
        self.settings.locale
    }

    /// Milliseconds of model time; none once it is over.
    pub fn now(&self) -> Option<u32> {
        match &self.stage {
            Stage::Runs(trial) => Some(trial.now()),
            Stage::Ends | Stage::Over(_) => None,
        }
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

    /// Makes a tick, or lets a held program finish its own. The caller settles it.
    pub fn tick(&mut self, program: &mut dyn Program) {
        let Stage::Runs(trial) = &mut self.stage else {
            return;
        };
        let before = trial.now();
        let was_held = trial.progress() == Progress::Held;
        trial.tick(program);
        if trial.now() != before || !was_held {
            self.keep_place();
        }
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
    pub fn settle(&mut self, program: &mut dyn Program) {
        let Stage::Runs(trial) = &self.stage else {
            return;
        };
        if trial.progress() == Progress::Over {
            self.end(program);
        }
    }

    /// Ends it as it is: the program is stopped. What is not decided then stays so.
    pub fn end(&mut self, program: &mut dyn Program) {
        let Stage::Runs(trial) = &self.stage else {
            return;
        };
        let (scene, state) = (seen::still(trial.arena()), self.state(program));
        let before = std::mem::replace(&mut self.stage, Stage::Ends);
        self.stage = match before {
            Stage::Runs(trial) => Stage::Over(Box::new(Over {
                outcome: trial.outcome(program),
                scene,
                state,
            })),
            before @ (Stage::Ends | Stage::Over(_)) => before,
        };
    }

    /// What came out, as [`crate::judged::judge`] tells it; nothing before the end. Findings know the places in the file of this
    /// name.
    pub fn outcome(&self, name: &str, findings: Findings<'_>) -> Option<Value> {
        match &self.stage {
            Stage::Runs(_) | Stage::Ends => None,
            Stage::Over(over) => Some(told(
                name,
                findings,
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
    pub fn state(&self, program: &dyn Program) -> String {
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
