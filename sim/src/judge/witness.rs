//! A run that somebody else has seen, held against the rules of a task: a robot that drove on a real floor.
//!
//! Owns what rules may ask of such a run, and how what was seen becomes the world that they ask: the robot is put where it
//! was, and its devices say what they said. Things that rules ask for and nobody has seen are named before anything is
//! judged, so no verdict rests on what a simulator would have said. Knows no files: what was seen is behind [`Witness`].

use super::run::{Failure, Outcome, Run, Settings, Verdict};
use super::scene::{Subject, subject};
use super::task::Task;
use super::words;
use crate::arena::{Arena, Setup};
use crate::field;
use crate::geometry::Pose;
use crate::show::field::PIXELS_IN_M;
use lang_constraint::{Asked, Wish, asked};
use lang_diagram::brick::{Brick, Command};
use lang_diagram::machine::STEP_MS;
use lang_diagram::ports::{Port, Sort};
use lang_diagram::stand_in;
use lang_text::problem::Words;
use std::rc::Rc;

/// How often the clock is looked at, in ticks.
const CLOCK_TICKS: u32 = 64;

/// What rules may ask of a robot or of what is around it.
#[derive(Clone, Copy, Debug, Eq, Ord, PartialEq, PartialOrd)]
pub enum Fact {
    /// Where the robot is.
    Place,
    /// What a device on a port says, or was told.
    Port(Port),
    /// The colour of its light.
    Light,
    /// What it said last.
    Phrase,
    /// Something else, which only a simulated world knows.
    Simulated,
}

/// Something that rules ask for.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Need {
    /// The rule.
    pub rule: String,
    /// What it asks, as it is written.
    pub text: String,
    /// What that is.
    pub fact: Fact,
}

/// Facts of a run.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Needs {
    /// What the rules ask for; each rule and text once for each fact.
    pub all: Vec<Need>,
    /// What rules would change of the robot or of things around it, which nothing did while it was seen.
    pub changes: Vec<Words>,
}

/// What the rules of a task ask of a run that was only seen.
pub fn needs(task: &Task) -> Needs {
    let mut needs = Needs::default();
    let Some(rules) = &task.rules else {
        return needs;
    };
    let mut arena = Arena::new(&task.field, Setup::default());
    for one in asked(rules, &mut arena) {
        if one.wish == Wish::Change {
            if !matches!(subject(one.object), Some(Subject::Still)) {
                needs.changes.push(words::not_changed(&one.rule, &one.text));
            }
            continue;
        }
        for fact in facts(&one) {
            let need = Need {
                rule: one.rule.clone(),
                text: one.text.clone(),
                fact,
            };
            if !needs.all.contains(&need) {
                needs.all.push(need);
            }
        }
    }
    needs.changes.dedup();
    needs
}

fn motors() -> impl Iterator<Item = Fact> {
    let motors = Port::all().filter(|port| port.sort() == Sort::Motor);
    motors.map(Fact::Port)
}

/// What has to be known for it.
fn facts(one: &Asked) -> Vec<Fact> {
    let property = one.chain.first().map_or("", |name| &**name);
    // A variable that holds the thing itself may be asked for anything of it.
    let is_whole = one.wish == Wish::Property && one.chain.is_empty();
    match subject(one.object) {
        Some(Subject::Robot(0)) if is_whole => motors().chain([Fact::Place]).collect(),
        Some(Subject::Device(0, port)) if is_whole && port.sort() != Sort::Vector => {
            vec![Fact::Port(port), Fact::Place]
        }
        Some(Subject::Robot(0)) if property == "isRiding" => motors().collect(),
        Some(Subject::Robot(0)) => vec![Fact::Place],
        // A place that is asked of what a robot carries is that of the robot.
        Some(Subject::Device(0, _) | Subject::Part(0, _)) if one.wish == Wish::Place => {
            vec![Fact::Place]
        }
        Some(Subject::Device(0, port)) => match (port.sort(), property) {
            // Nobody locks a sensor of a robot that is only seen, and readings of several numbers cannot be compared.
            (_, "locked") | (Sort::Vector, _) => Vec::new(),
            (Sort::Motor | Sort::Servo | Sort::Encoder | Sort::Scalar | Sort::Button(_), _) => {
                vec![Fact::Port(port)]
            }
        },
        Some(Subject::Part(0, "led")) => vec![Fact::Light],
        Some(Subject::Part(0, "shell")) => vec![Fact::Phrase],
        Some(Subject::Still) => Vec::new(),
        Some(Subject::Robot(_) | Subject::Device(..) | Subject::Part(..) | Subject::Moving)
        | None => vec![Fact::Simulated],
    }
}

/// How a run that is seen goes on.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Going {
    /// There is more to see.
    On,
    /// This is its last moment.
    Ended {
        /// Its program had errors.
        with_errors: bool,
    },
}

/// Somebody who has seen a run.
pub trait Witness {
    /// Tells what has changed up to this moment, in milliseconds since the beginning. It is called with moments that grow.
    ///
    /// # Errors
    /// What was seen cannot be told, so nothing can be judged.
    fn tell(&mut self, now: u32, to: &mut Seen<'_>) -> Result<Going, Words>;
}

/// What a witness tells: it becomes what rules see.
pub struct Seen<'a> {
    arena: &'a mut Arena,
    start: stand_in::Pose,
    warnings: Vec<Words>,
}

impl Seen<'_> {
    /// The robot is there: so many metres ahead and to the left of where the world has it begin, and turned so far to the
    /// left.
    pub fn place(&mut self, moved: Pose) {
        let Some(robot) = self.arena.robot_mut(0) else {
            return;
        };
        let (sin, cos) = libm::sincos(self.start.degrees.to_radians());
        let (ahead, right) = (moved.at.x * PIXELS_IN_M, -moved.at.y * PIXELS_IN_M);
        let before = robot.pose().degrees;
        let degrees = self.start.degrees - moved.heading_rad.to_degrees();
        // Whole turns are counted, as a simulated robot counts them.
        let turns = ((before - degrees) / 360.0).round();
        robot.put(stand_in::Pose {
            x: self.start.x + ahead * cos - right * sin,
            y: self.start.y + ahead * sin + right * cos,
            degrees: degrees + 360.0 * turns,
        });
    }

    /// A device says this, or was told it.
    pub fn port(&mut self, port: Port, value: i32) {
        match port.sort() {
            Sort::Motor => self.arena.robot(0).command(Command::Power {
                port,
                percent: value,
            }),
            Sort::Servo => self.arena.robot(0).command(Command::Servo {
                port,
                degrees: value,
            }),
            Sort::Encoder | Sort::Scalar | Sort::Vector | Sort::Button(_) => {
                if let Some(robot) = self.arena.robot_mut(0) {
                    robot.readings.give(port, value);
                }
            }
        }
    }

    /// The light has this colour.
    pub fn light(&mut self, color: &str) {
        self.arena.robot(0).command(Command::Led { color });
    }

    /// It says this.
    pub fn phrase(&mut self, text: &str) {
        self.arena
            .robot(0)
            .command(Command::Say { text: Some(text) });
    }

    /// What was seen may be less than it seems.
    pub fn warn(&mut self, words: Words) {
        self.warnings.push(words);
    }
}

/// Judges a run that somebody has seen. Nothing moves by itself in it.
pub fn judge_seen(task: &Task, witness: &mut dyn Witness, settings: &Settings) -> Outcome {
    let mut field = task.field.clone();
    field.settings = field::Settings {
        background: field.settings.background,
        ..field::Settings::default()
    };
    let mut arena = Arena::new(&field, Setup::default());
    let start = arena.robots()[0].pose();
    let mut run = Run::new(task, &Rc::new(settings.clone()), &arena);
    let began = settings.clock.now();
    let mut now = 0;
    loop {
        let mut seen = Seen {
            arena: &mut arena,
            start,
            warnings: Vec::new(),
        };
        let going = witness.tell(now, &mut seen);
        let warnings = seen.warnings;
        run.warn(now, &warnings);
        let going = match going {
            Ok(going) => going,
            Err(why) => {
                run.fail(now, why);
                run.verdict = Some(Verdict::Unknown);
                break;
            }
        };
        run.record(now, &arena);
        if now > 0 && run.check(now, &mut arena) {
            break;
        }
        if let Going::Ended { with_errors } = going {
            run.ended(now, with_errors, &mut arena);
            break;
        }
        if now >= settings.longest_ms {
            run.fail(now, words::seen_too_long(f64::from(now) / 1000.0));
            run.failure = Some(Failure::ModelTime);
            break;
        }
        let is_time_to_look = (now / STEP_MS).is_multiple_of(CLOCK_TICKS);
        if is_time_to_look && settings.clock.since(began) > settings.longest {
            run.fail(now, words::too_slow(settings.longest.as_secs_f64()));
            run.verdict = Some(Verdict::Unknown);
            break;
        }
        now += STEP_MS;
    }
    run.outcome(now, &arena)
}

#[cfg(test)]
mod tests;
