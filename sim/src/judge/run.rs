//! What is kept while a run is judged, and what comes out of it.
//!
//! Owns verdicts, messages, trajectory and track; `trial` has the order of one tick. The same task, program and settings give
//! the same outcome; only the limit of real time can make a difference, and then there is no verdict.

use super::clock::Clock;
use super::hands::Deed;
use super::program::{Program, Running};
use super::recorder::Recorder;
use super::report;
use super::task::Task;
use super::track::{Group, Track};
use super::trajectory::{Record, Trajectory};
use crate::arena::{Arena, Robot};
use crate::limits;
use lang_constraint::{
    self as rules, Checker, Entry, Explanation, Level, Value, Verdict as Decision,
};
use lang_diagram::brick::Brick;
use lang_diagram::machine::Status;
use lang_diagram::ports::{Port, Sort};
use lang_text::problem::{Locale, Problem, Words};
use std::rc::Rc;
use std::time::Duration;

/// How a run ended.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Verdict {
    /// The task was accomplished.
    Accomplished,
    /// There are no rules, and the program has ended without an error.
    Ended,
    /// The task was not accomplished, or the program has errors.
    Failed,
    /// It took too much real time, so nothing is known.
    Unknown,
}

/// What kind of failure a failed run is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Failure {
    /// The program did something else than the rules demand.
    Wrong,
    /// The model time of the rules or of the settings was over.
    ModelTime,
    /// The program had an error while it ran.
    Program,
    /// The program is not one that could begin.
    Structure,
}

/// How a run is judged.
#[derive(Clone, Debug)]
pub struct Settings {
    /// Language of messages.
    pub locale: Locale,
    /// Whether to go on after the first failure and collect all.
    pub keep_going: bool,
    /// Longest run, in milliseconds of model time.
    pub longest_ms: u32,
    /// Longest run in real time.
    pub longest: Duration,
    /// What real time is read from.
    pub clock: Clock,
    /// Seed of everything that is random.
    pub seed: u64,
    /// What a person answers when a program asks, in order.
    pub answers: Vec<String>,
    /// What a person with a gamepad does beside the robot, in order of time.
    pub deeds: Option<Vec<Deed>>,
    /// Whether markers leave something on the floor that sensors and rules see, as in the original's window. Its background
    /// mode, which is that of graders, draws nothing.
    pub is_marking: bool,
    /// Whether a trajectory is kept.
    pub is_recording: bool,
    /// Whether motors, readings, variables and blocks are kept, for a page.
    pub is_tracking: bool,
    /// Whether a picture of the display at the end is made.
    pub is_showing: bool,
    /// Whether it is kept why the run ends as it does.
    pub is_explaining: bool,
}

impl Default for Settings {
    fn default() -> Self {
        Self {
            locale: Locale::English,
            keep_going: false,
            longest_ms: 600_000,
            longest: Duration::from_secs(60),
            clock: Clock::default(),
            seed: 1,
            answers: Vec::new(),
            deeds: None,
            is_marking: false,
            is_recording: false,
            is_tracking: false,
            is_showing: false,
            is_explaining: false,
        }
    }
}

/// What has come out.
#[derive(Clone, Debug)]
pub struct Outcome {
    /// How it ended.
    pub verdict: Verdict,
    /// What kind of failure it is, if it is one.
    pub failure: Option<Failure>,
    /// When, in milliseconds of model time.
    pub ms: u32,
    /// What was said, in order.
    pub entries: Vec<Entry>,
    /// What the rules have counted.
    pub total_score: Option<f64>,
    /// The value of `total_score`, if it is there and is no number.
    pub strange_score: Option<String>,
    /// What the program has printed: the first texts.
    pub printed: Vec<String>,
    /// Where robots were; empty if it was not recorded.
    pub trajectory: Trajectory,
    /// What the first robot and its program did beside moving; empty if it was not kept.
    pub track: Track,
    /// The display at the end, as a PNG file, if it was wanted.
    pub display: Option<Vec<u8>>,
    /// Why the rules have decided so, if that was wanted and there are rules.
    pub explanation: Option<Explanation>,
    /// Where the threads of the program were at the end.
    pub running: Vec<Running>,
}

/// Tells the devices of a robot: power in percent or angle in degrees of what moves, the newest reading of what was read; and
/// whether it is a motor that stands still and is no wheel.
pub fn devices(robot: &Robot, tell: &mut dyn FnMut(Port, i32, bool)) {
    let description = robot.description();
    for port in Port::all() {
        match port.sort() {
            Sort::Motor => {
                let power = robot.power(port);
                let is_wheel = [description.left, description.right].contains(&Some(port));
                tell(port, power, power == 0 && !is_wheel);
            }
            Sort::Servo => {
                let degrees = robot.servo(port);
                tell(port, degrees, degrees == 0);
            }
            Sort::Encoder | Sort::Scalar | Sort::Button(_) => {
                if robot.readings.is_read(port) {
                    tell(port, robot.readings.last(port), false);
                }
            }
            Sort::Vector => {}
        }
    }
}

/// What changes while a run is judged.
pub(super) struct Run {
    settings: Rc<Settings>,
    checker: Option<Checker>,
    entries: Vec<Entry>,
    trajectory: Trajectory,
    track: Track,
    heard: usize,
    /// How many warnings of the program were told.
    warned: usize,
    /// Once it is known.
    pub verdict: Option<Verdict>,
    pub failure: Option<Failure>,
}

impl Run {
    pub fn new(task: &Task, settings: &Rc<Settings>, arena: &Arena) -> Self {
        let checker = task.rules.clone().map(|rules| {
            let checker = Checker::new(rules, settings.locale);
            let checker = match settings.is_explaining {
                true => checker.explaining(),
                false => checker,
            };
            if settings.keep_going {
                checker.continuing()
            } else {
                checker
            }
        });
        let mut trajectory = Trajectory::default();
        for robot in arena.robots() {
            trajectory.robots.push(robot.description().id.clone());
        }
        // What is wrong with templates of the save is told, and nothing else comes of it.
        let faults = task.rules.iter().flat_map(|rules| rules.faults());
        let faults = faults.map(|problem| (Level::Error, &problem.words));
        let told = task.told.iter().map(|words| (Level::Info, words));
        let entries = faults.chain(told).map(|(level, words)| Entry {
            level,
            at_ms: 0,
            place: String::new(),
            text: words.in_locale(settings.locale).to_owned(),
        });
        Self {
            settings: Rc::clone(settings),
            checker,
            entries: entries.collect(),
            trajectory,
            track: Track::default(),
            heard: 0,
            warned: 0,
            verdict: None,
            failure: None,
        }
    }

    /// Keeps where the robots are.
    pub fn record(&mut self, now: u32, arena: &Arena) {
        if !self.settings.is_recording {
            return;
        }
        for (index, robot) in arena.robots().iter().enumerate() {
            if self.trajectory.records.len() >= limits::RECORDS {
                return;
            }
            let pose = robot.pose();
            self.trajectory.records.push(Record::Pose {
                robot: index as u16,
                ms: now,
                x: pose.x,
                y: pose.y,
                degrees: pose.degrees,
            });
        }
    }

    /// Keeps what can be seen of the first robot and its program. Only what was read anyway is shown as a reading: one more
    /// would draw from the noise of sensors, and change the run.
    pub fn track(&mut self, now: u32, program: &dyn Program, arena: &Arena) {
        let (true, Some(robot)) = (self.settings.is_tracking, arena.robots().first()) else {
            return;
        };
        let track = &mut self.track;
        program.describe(self.settings.locale, &mut |group, name, value| {
            track.note(group, name, now, value);
        });
        devices(robot, &mut |port, value, is_idle| {
            let group = match port.sort() {
                Sort::Motor | Sort::Servo => Group::Motor,
                Sort::Encoder | Sort::Scalar | Sort::Button(_) | Sort::Vector => Group::Sensor,
            };
            if !is_idle || track.has(group, port.name()) {
                track.note(group, port.name(), now, &value.to_string());
            }
        });
        track.round(now);
    }

    /// A step of the program; what it tells its robot is kept.
    pub fn step(&mut self, now: u32, program: &mut dyn Program, arena: &mut Arena) -> Status {
        let mut status = Status::Running;
        self.with_robot(now, arena, &mut |robot| status = program.step(now, robot));
        status
    }

    /// Gives the first robot to somebody; what it is told is kept.
    pub fn with_robot(&mut self, now: u32, arena: &mut Arena, act: &mut dyn FnMut(&mut dyn Brick)) {
        if !self.settings.is_recording {
            return act(&mut arena.robot(0));
        }
        act(&mut Recorder {
            arena,
            robot: 0,
            ms: now,
            trajectory: &mut self.trajectory,
        });
    }

    /// What was said so far.
    pub fn entries(&self) -> &[Entry] {
        &self.entries
    }

    /// What the program still does in the tick in which the rules have decided.
    pub fn last_tick(&mut self, now: u32, program: &mut dyn Program, arena: &mut Arena) {
        let mut robot = Recorder {
            arena,
            robot: 0,
            ms: now,
            trajectory: &mut self.trajectory,
        };
        program.last_tick(now, &mut robot);
        if !self.settings.is_recording {
            self.trajectory.records.clear();
        }
    }

    /// Lets the rules check the world; whether they have decided.
    pub fn check(&mut self, now: u32, arena: &mut Arena) -> bool {
        let Some(checker) = &mut self.checker else {
            return false;
        };
        let decision = checker.check(u64::from(now), arena, &mut self.entries);
        self.record_changes(now, arena);
        self.decide(decision)
    }

    /// Keeps what rules have told devices.
    fn record_changes(&mut self, now: u32, arena: &mut Arena) {
        for (robot, change) in arena.take_changes() {
            if self.settings.is_recording {
                let mut recorder = Recorder {
                    arena: &mut *arena,
                    robot: robot as u16,
                    ms: now,
                    trajectory: &mut self.trajectory,
                };
                recorder.changed(change);
            }
        }
    }

    /// The program has ended by itself.
    pub fn ended(&mut self, now: u32, with_errors: bool, arena: &mut Arena) {
        match &mut self.checker {
            None if with_errors => self.verdict = Some(Verdict::Failed),
            None => self.verdict = Some(Verdict::Ended),
            Some(checker) => {
                let time = u64::from(now);
                let decision = checker.program_ended(time, with_errors, arena, &mut self.entries);
                self.record_changes(now, arena);
                self.decide(decision);
            }
        }
    }

    fn decide(&mut self, decision: Decision) -> bool {
        let verdict = match decision {
            Decision::Open => return false,
            Decision::Accomplished { .. } => Verdict::Accomplished,
            Decision::Failed { .. } => Verdict::Failed,
        };
        self.verdict = Some(verdict);
        let failure = self.checker.as_ref().and_then(Checker::failure);
        self.failure = failure.map(|failure| match failure {
            rules::Failure::TimeOver => Failure::ModelTime,
            rules::Failure::Rule | rules::Failure::Unfinished => Failure::Wrong,
        });
        true
    }

    /// Tells what is new among the errors of a program.
    pub fn hear(&mut self, now: u32, errors: &[Problem]) {
        if errors.len() > self.heard {
            self.tell(now, Level::Error, &errors[self.heard..]);
            self.heard = errors.len();
        }
    }

    /// Tells what is new among its warnings.
    pub fn hear_warnings(&mut self, now: u32, warnings: &[Problem]) {
        if warnings.len() > self.warned {
            self.tell(now, Level::Warning, &warnings[self.warned..]);
            self.warned = warnings.len();
        }
    }

    fn tell(&mut self, now: u32, level: Level, problems: &[Problem]) {
        for problem in problems {
            self.entries.push(Entry {
                level,
                at_ms: u64::from(now),
                place: report::place(problem),
                text: report::text(problem, self.settings.locale),
            });
        }
    }

    /// Tells what may be wrong, and goes on.
    pub fn warn(&mut self, now: u32, all: &[Words]) {
        self.entries.extend(all.iter().map(|words| Entry {
            level: Level::Warning,
            at_ms: u64::from(now),
            place: String::new(),
            text: words.in_locale(self.settings.locale).to_owned(),
        }));
    }

    /// Ends it as failed, for a reason of the judge's own.
    pub fn fail(&mut self, now: u32, why: Words) {
        self.entries.push(Entry {
            level: Level::Error,
            at_ms: u64::from(now),
            place: String::new(),
            text: why.in_locale(self.settings.locale).to_owned(),
        });
        self.verdict = Some(Verdict::Failed);
    }

    pub fn outcome(self, now: u32, arena: &Arena) -> Outcome {
        let display = || {
            arena
                .robots()
                .first()
                .map(|robot| robot.shown().screen.png())
        };
        let score = self
            .checker
            .as_ref()
            .and_then(|checker| checker.variable("total_score"));
        // A run that ends without a word of the rules is no success.
        let verdict = self.verdict.unwrap_or(Verdict::Failed);
        let failure = match (self.failure, verdict) {
            (_, Verdict::Accomplished | Verdict::Ended | Verdict::Unknown) => None,
            (Some(Failure::Structure), Verdict::Failed) => Some(Failure::Structure),
            // Whatever came of an error, the error came first.
            (_, Verdict::Failed) if self.heard > 0 => Some(Failure::Program),
            (failure, Verdict::Failed) => Some(failure.unwrap_or(Failure::Wrong)),
        };
        Outcome {
            verdict,
            failure,
            ms: now,
            total_score: score.and_then(number),
            strange_score: score
                .filter(|score| number(score).is_none() && !matches!(score, Value::Null))
                .map(Value::to_text),
            explanation: self.checker.as_ref().and_then(Checker::explain),
            running: Vec::new(),
            entries: self.entries,
            printed: Vec::new(),
            trajectory: self.trajectory,
            track: self.track,
            display: self.settings.is_showing.then(display).flatten(),
        }
    }
}

/// A score: a number, or a text that says one, as rules with strings have it.
fn number(score: &Value) -> Option<f64> {
    let number = match score {
        Value::Int(number) => f64::from(*number),
        Value::Double(number) => *number,
        Value::Text(text) => text.trim().parse().ok()?,
        Value::Null
        | Value::Bool(_)
        | Value::NoText
        | Value::Point(_)
        | Value::Place(_)
        | Value::Rect(_)
        | Value::Colour(_)
        | Value::Opaque
        | Value::List(_)
        | Value::Record(_)
        | Value::Object(_) => return None,
    };
    number.is_finite().then_some(number)
}
