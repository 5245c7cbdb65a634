//! A run that is done tick by tick by its caller: at once for a verdict, or with pauses for a debugger.
//!
//! Owns the order of one tick: the world moves, the rules look, the program steps, what it has said is heard. A program that
//! is held in the middle of its step holds the tick, and model time with it.

use super::hands;
use super::program::Program;
use super::run::{Failure, Outcome, Run, Settings, Verdict};
use super::task::Task;
use super::words;
use crate::arena::{Arena, Gamepad, Person, Setup};
use lang_constraint::Entry;
use lang_diagram::brick::Brick;
use lang_diagram::machine::{STEP_MS, Status};
use std::rc::Rc;
use std::time::Duration;

/// How often the clock is looked at, in ticks.
const CLOCK_TICKS: u32 = 64;

/// What a run is doing.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Progress {
    /// The next tick may come.
    Runs,
    /// The program is held in its step; the next call lets it finish that.
    Held,
    /// It is decided: there is nothing more to do than [`Trial::outcome`].
    Over,
}

/// A run between its beginning and its verdict.
pub struct Trial {
    settings: Rc<Settings>,
    arena: Arena,
    run: Run,
    /// How many deeds of a person were done.
    deeds: usize,
    began: Duration,
    now: u32,
    progress: Progress,
    /// The next tick is the first.
    is_new: bool,
}

impl Trial {
    /// A program that has not begun, in the world of a task.
    pub fn new(task: &Task, program: &dyn Program, settings: &Settings) -> Self {
        let settings = Rc::new(settings.clone());
        let setup = Setup {
            seed: settings.seed,
            sensors: task.sensors.clone(),
            answers: settings.answers.iter().cloned().collect(),
            is_unmarked: !settings.is_marking,
            ..Setup::default()
        };
        let mut arena = Arena::new(&task.field, setup);
        let mut run = Run::new(task, &settings, &arena);
        if let (Some(_), Some(robot)) = (&settings.deeds, arena.robot_mut(0)) {
            robot.set_gamepad(Some(Gamepad::default()));
        }
        let mut progress = Progress::Runs;
        if let Some(why) = program.refusal() {
            // It does not begin, and so the rules have nothing to say.
            run.hear(0, std::slice::from_ref(why));
            run.verdict = Some(Verdict::Failed);
            run.failure = Some(Failure::Structure);
            progress = Progress::Over;
        }
        Self {
            arena,
            run,
            deeds: 0,
            began: settings.clock.now(),
            settings,
            now: 0,
            progress,
            is_new: true,
        }
    }

    /// Does a tick, or finishes one whose program was held.
    pub fn tick(&mut self, program: &mut dyn Program) -> Progress {
        if self.progress == Progress::Over {
            return Progress::Over;
        }
        if self.progress == Progress::Runs && !self.begin(program) {
            self.progress = Progress::Over;
            return Progress::Over;
        }
        let status = self.run.step(self.now, program, &mut self.arena);
        self.progress = match program.is_held() {
            true => Progress::Held,
            false => self.settle(status, program),
        };
        self.progress
    }

    /// What comes before the step of the program; false: the rules have decided.
    fn begin(&mut self, program: &mut dyn Program) -> bool {
        if self.is_new {
            self.is_new = false;
        } else {
            self.now += STEP_MS;
            self.arena.tick();
            self.run.record(self.now, &self.arena);
            if self.run.check(self.now, &mut self.arena) {
                self.run.last_tick(self.now, program, &mut self.arena);
                return false;
            }
        }
        let deeds = self.settings.deeds.as_deref().unwrap_or_default();
        let mut rest = &deeds[self.deeds..];
        if let Some(robot) = self.arena.robot_mut(0) {
            hands::act(&mut rest, self.now, robot);
        }
        self.deeds = deeds.len() - rest.len();
        true
    }

    /// What comes after it.
    fn settle(&mut self, status: Status, program: &mut dyn Program) -> Progress {
        let Self {
            run,
            arena,
            settings,
            now,
            ..
        } = self;
        let now = *now;
        run.hear_warnings(now, program.warnings());
        run.hear(now, program.errors());
        run.track(now, program, arena);
        arena.renew();
        if let Status::Ended { with_errors, .. } = status {
            match program.is_out_of_time() {
                true => run.verdict = Some(Verdict::Unknown),
                false => run.ended(now, with_errors, arena),
            }
            return Progress::Over;
        }
        if now >= settings.longest_ms {
            run.fail(now, words::too_long(f64::from(now) / 1000.0));
            run.failure = Some(Failure::ModelTime);
            return Progress::Over;
        }
        let is_time_to_look = (now / STEP_MS).is_multiple_of(CLOCK_TICKS);
        if is_time_to_look && settings.clock.since(self.began) > settings.longest {
            run.fail(now, words::too_slow(settings.longest.as_secs_f64()));
            run.verdict = Some(Verdict::Unknown);
            return Progress::Over;
        }
        Progress::Runs
    }

    /// Lets somebody else tell the robot something between two ticks, which is kept as what the program says is.
    pub fn aside(&mut self, act: &mut dyn FnMut(u32, &mut dyn Brick)) {
        let now = self.now;
        self.run
            .with_robot(now, &mut self.arena, &mut |robot| act(now, robot));
    }

    /// From now on this person answers when the program asks and no answers are left.
    pub fn set_person(&mut self, person: Box<dyn Person>) {
        self.arena.set_person(person);
    }

    /// What was said so far by rules and program.
    pub fn entries(&self) -> &[Entry] {
        self.run.entries()
    }

    /// What the run is doing.
    pub fn progress(&self) -> Progress {
        self.progress
    }

    /// The world as it is.
    pub fn arena(&self) -> &Arena {
        &self.arena
    }

    /// Milliseconds of model time.
    pub fn now(&self) -> u32 {
        self.now
    }

    /// What has come out. The program is stopped.
    pub fn outcome(mut self, program: &mut dyn Program) -> Outcome {
        let mut outcome = self.run.outcome(self.now, &self.arena);
        if program.refusal().is_some() {
            return outcome;
        }
        outcome.running = program.running();
        program.stop(&mut self.arena.robot(0));
        let shown = self.arena.robots().first().map(|robot| robot.shown());
        outcome.printed = shown.map(|shown| shown.printed.clone()).unwrap_or_default();
        outcome
    }
}

/// Runs a program in the world of a task, to its verdict.
pub fn judge(task: &Task, program: &mut dyn Program, settings: &Settings) -> Outcome {
    let mut trial = Trial::new(task, program, settings);
    // A program that nobody asked to be held is never held.
    while trial.tick(program) != Progress::Over {}
    trial.outcome(program)
}
