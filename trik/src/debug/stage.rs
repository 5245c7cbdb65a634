//! A program that somebody debugs in a simulated world: in this process, with model time that stands still at a stop.
//!
//! Owns the run, where its robot was at each moment, and what was said of it so far. Rules, program and debugger are those
//! of `sim`, `lang-diagram` and `lang-dataflow`.

use super::asking::{Asking, Listener};
use super::stops::words;
use super::target::words::told;
use super::target::{Changed, Channel, Event, Target, Written, lines, problems};
use crate::check::{Ready, Staged, Start};
use crate::error::Error;
use crate::limits;
use lang_constraint::Level;
use lang_dataflow::machine::patch as flow;
use lang_diagram::debug::order::Order;
use lang_diagram::lower::World;
use lang_diagram::machine::patch;
use lang_text::problem::{Locale, Words};
use serde_json::Value;
use sim::judge::debugged::{self, Debugged, Refused, Version};
use sim::judge::{Failure, Outcome, Progress, Settings, Task, Trial, Verdict};
use std::collections::VecDeque;
use std::path::Path;
use std::time::{Duration, Instant};

/// Ticks between two looks at the clock.
const TICKS: usize = 16;

/// A run that waits for orders.
pub(crate) struct Stage<'a> {
    trial: Option<Trial>,
    program: Debugged,
    outcome: Option<Outcome>,
    /// Its end was told.
    has_told_end: bool,
    tag: u32,
    /// Where the robot was: milliseconds, x, y, degrees.
    poses: VecDeque<(u32, [f64; 3])>,
    /// How much of what was said and printed was passed on.
    entries: usize,
    printed: usize,
    settings: &'a Settings,
    world: World,
    /// The program is faster than time by this; none: as fast as can be.
    speed: Option<f64>,
    /// When the model's time was what, while it runs at a speed.
    pace: Option<(Instant, u32)>,
    asking: Asking,
}

impl<'a> Stage<'a> {
    /// Stopped before the first block.
    fn new(task: &Task, program: Debugged, settings: &'a Settings, world: World) -> Self {
        let asking = Asking::default();
        asking.speak(settings.locale);
        let mut trial = Trial::new(task, &program, settings);
        trial.set_person(Box::new(asking.clone()));
        Self {
            trial: Some(trial),
            program,
            outcome: None,
            has_told_end: false,
            tag: 0,
            poses: VecDeque::new(),
            entries: 0,
            printed: 0,
            settings,
            world,
            speed: None,
            pace: None,
            asking,
        }
    }

    /// A run of what was prepared.
    pub(crate) fn of(staged: &'a Staged, start: Start) -> Self {
        let locale = staged.settings.locale;
        let mut program = match &staged.program {
            Ready::Diagram(_, program) => Debugged::diagram(program.clone(), locale),
            Ready::Flow(_, program) => Debugged::flow(program.clone(), locale),
        };
        match start {
            Start::Stopped => program.stop_first(),
            Start::Running => {}
        }
        Self::new(&staged.task, program, &staged.settings, staged.world)
    }

    /// Model time goes so many times faster than real time.
    pub(crate) fn at_speed(mut self, speed: Option<f64>) -> Self {
        self.speed = speed;
        self
    }

    fn progress(&self) -> Progress {
        self.trial.as_ref().map_or(Progress::Over, Trial::progress)
    }

    fn note_pose(&mut self) {
        let Some(trial) = &self.trial else { return };
        let Some(robot) = trial.arena().robots().first() else {
            return;
        };
        let pose = robot.pose();
        if self.poses.len() >= limits::DEBUG_POSES_MAX {
            self.poses.pop_front();
        }
        self.poses
            .push_back((trial.now(), [pose.x, pose.y, pose.degrees]));
    }

    /// Ends the run if it is over.
    fn end_if_over(&mut self) {
        if self.outcome.is_none()
            && self.progress() == Progress::Over
            && let Some(trial) = self.trial.take()
        {
            self.outcome = Some(trial.outcome(&mut self.program));
        }
    }

    /// What is new of what was said.
    fn said(&mut self, events: &mut Vec<Event>) {
        let (entries, printed) = match (&self.trial, &self.outcome) {
            (Some(trial), _) => {
                let shown = trial.arena().robots().first().map(|robot| robot.shown());
                let printed = shown.map_or(&[][..], |shown| &shown.printed);
                (trial.entries(), printed)
            }
            (None, Some(outcome)) => (&outcome.entries[..], &outcome.printed[..]),
            (None, None) => (&[][..], &[][..]),
        };
        let lines = printed.iter().skip(self.printed);
        events.extend(lines.map(|line| Event::Said(Channel::Output, line.clone())));
        self.printed = self.printed.max(printed.len());
        let told = entries
            .iter()
            .skip(self.entries)
            .filter(|entry| entry.level != Level::Variables);
        events.extend(told.map(|entry| Event::Said(Channel::Message, entry.line())));
        self.entries = self.entries.max(entries.len());
    }

    fn news(&mut self) -> Vec<Event> {
        let news = self.program.news();
        let mut events: Vec<Event> = news
            .iter()
            .filter_map(|text| Some(Event::Report(serde_json::from_str(text).ok()?)))
            .collect();
        self.said(&mut events);
        if let Some(asked) = self.asking.missed() {
            let words = words::nobody_answers(&asked.variable);
            let said = words::in_locale(self.settings.locale, words);
            events.push(Event::Said(Channel::Message, said));
        }
        events.extend(self.asking.news().map(Event::Asked));
        events
    }

    /// How long to wait until the next tick is due.
    fn due(&mut self, now: u32) -> Duration {
        let Some(speed) = self.speed else {
            return Duration::ZERO;
        };
        let (began, from) = *self.pace.get_or_insert((Instant::now(), now));
        let passed = f64::from(now.saturating_sub(from)) / 1000.0 / speed;
        Duration::from_secs_f64(passed).saturating_sub(began.elapsed())
    }
}

/// Why a version is refused, a line for each problem.
fn explained(why: &Refused, locale: Locale) -> String {
    match why {
        Refused::Diagram(why) => problems(why, locale),
        Refused::Flow(flow::Refused::Ended) => words::in_locale(locale, words::has_ended()),
        Refused::Flow(flow::Refused::Mistakes(mistakes)) => lines(mistakes, locale),
        Refused::OtherLanguage => words::in_locale(locale, words::other_language()),
    }
}

/// How a run has ended, for a person.
fn ending(outcome: &Outcome, locale: Locale) -> String {
    let seconds = f64::from(outcome.ms) / 1000.0;
    let what = match outcome.verdict {
        Verdict::Accomplished => words::ACCOMPLISHED,
        Verdict::Ended => words::ENDED,
        Verdict::Failed => match outcome.failure {
            Some(Failure::ModelTime) => words::TIME_IS_OVER,
            Some(Failure::Program) => words::FAILED,
            Some(Failure::Structure) => words::CANNOT_BEGIN,
            Some(Failure::Wrong) | None => words::NOT_ACCOMPLISHED,
        },
        Verdict::Unknown => words::GIVEN_UP,
    };
    words::in_locale(locale, words::ending(what, seconds))
}

impl Target for Stage<'_> {
    fn order(&mut self, order: &Order) -> Result<Value, Error> {
        self.tag += 1;
        self.pace = None;
        // A program that is to stop stops before it has its answer.
        self.asking.put_off(*order == Order::Pause);
        let text = order.to_string();
        let answer = match &mut self.trial {
            Some(trial) => debugged::order(trial, &mut self.program, self.tag, &text),
            None => debugged::order_after(&mut self.program, self.tag, &text),
        };
        self.end_if_over();
        serde_json::from_str(&answer).map_err(|why| Error::Robot(why.to_string()))
    }

    fn turn(&mut self, wait: Duration) -> Result<Vec<Event>, Error> {
        let until = Instant::now() + wait;
        'turn: while self.progress() == Progress::Runs && !self.asking.is_waiting() {
            for _ in 0..TICKS {
                let Some(trial) = &mut self.trial else {
                    break 'turn;
                };
                let now = trial.now();
                let progress = trial.tick(&mut self.program);
                self.note_pose();
                self.asking.tick();
                if progress != Progress::Runs || self.asking.is_waiting() {
                    break 'turn;
                }
                let due = self
                    .due(now)
                    .min(until.saturating_duration_since(Instant::now()));
                if !due.is_zero() {
                    std::thread::sleep(due);
                }
                if self.speed.is_some() && Instant::now() >= until {
                    break 'turn;
                }
            }
            if Instant::now() >= until {
                break;
            }
        }
        while self.program.search_on() && Instant::now() < until {}
        self.end_if_over();
        let mut events = self.news();
        if let (false, Some(outcome)) = (self.has_told_end, &self.outcome) {
            self.has_told_end = true;
            events.push(Event::Over(ending(outcome, self.settings.locale)));
        }
        let is_asking = self.asking.is_waiting();
        if is_asking {
            self.pace = None;
        }
        if events.is_empty() && (is_asking || self.progress() != Progress::Runs) {
            std::thread::sleep(until.saturating_duration_since(Instant::now()));
        }
        Ok(events)
    }

    fn change(
        &mut self,
        file: &Path,
        _diagram: Option<&str>,
        version: Written<'_>,
    ) -> Result<Changed, Error> {
        let locale = self.settings.locale;
        let version = match version {
            Written::Diagram(project) => patch::Version::of(project, self.world)
                .map(Version::Diagram)
                .map_err(|why| problems(&why, locale)),
            Written::Flow(flow) => flow
                .ready()
                .map(|program| Version::Flow(program.into()))
                .map_err(|mistakes| flow.lines(file, &mistakes, locale).join("\n")),
        };
        let version = match version {
            Ok(version) => version,
            Err(why) => return Ok(Changed::Wrong(why)),
        };
        let Some(trial) = &mut self.trial else {
            let why = words::in_locale(locale, words::has_ended());
            return Ok(Changed::CannotBe(why));
        };
        let patched = debugged::patch(trial, &mut self.program, &version);
        self.end_if_over();
        Ok(match patched {
            Ok(patched) => Changed::InForce(told(&patched, locale)),
            Err(why) => Changed::CannotBe(explained(&why, locale)),
        })
    }

    fn attend(&mut self, listener: Listener) {
        self.asking.attend(listener);
    }

    fn answer(&mut self, text: &str) {
        self.asking.answer(text);
    }

    /// Nothing moves any more: its time stands still.
    fn end(&mut self) {}

    /// The world ends with the process.
    fn close(&mut self) {}

    fn keeps_past(&self) -> bool {
        true
    }

    fn scene(&self, ms: u64) -> Option<Words> {
        let before = self.poses.partition_point(|(at, _)| u64::from(*at) <= ms);
        let (at, [x, y, degrees]) = self.poses.get(before.checked_sub(1)?)?;
        let turned = degrees - 360.0 * (degrees / 360.0).round();
        let seconds = f64::from(*at) / 1000.0;
        let place = [*x, *y, turned];
        Some(words::scene(seconds, place, self.settings.is_marking))
    }
}
