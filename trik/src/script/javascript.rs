//! JavaScript under a judge: the engine of the daemon on a stage, its threads in a fixed order.
//!
//! Owns who runs. One thread runs at a time, until it waits: first who was begun, killed or sent something, then who
//! did that, then who is due, in the order in which they began to wait.

use super::stage::{Ear, Here, Stage, Subscriptions, Wish, record};
use crate::error::Error;
use generator::{Generator, Gn};
use lang_diagram::brick::{Brick, Command};
use lang_diagram::machine::{STEP_MS, Status};
use lang_text::javascript::with_call_of_main;
use lang_text::problem::{Locale, Problem};
use sim::judge::{Group, Program, Running};
use std::cell::{Cell, RefCell};
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::sync::{Arc, PoisonError};
use studio::script::asked::START_MS;
use studio::script::failure::problem;
use studio::script::input::{GAMEPAD, KEYS, Record};
use studio::script::lines::Lines;
use studio::script::refresh::Readings;
use trikd::js::machine::{self, Job, Kind};
use trikd::js::shared::{MAIN, Shared, Slot, unbroken};
use trikd::limits::{JS_MESSAGES, JS_STACK_BYTES, JS_STACK_SPARE_BYTES};

/// All that a thread does.
type Start = Box<dyn FnOnce()>;

/// One thread of the program.
struct Thread {
    slot: Arc<Slot>,
    body: Generator<'static, Start, ()>,
    /// What it does, until it begins.
    start: Option<Start>,
    heard: Rc<RefCell<Subscriptions>>,
    /// When it goes on in any case.
    due: f64,
    /// Whether its bell and records wake it before that.
    listens: bool,
    /// Who began to wait before others goes on before them.
    order: u32,
    /// Its calls to the robot, in this tick.
    calls: u32,
    tick: u32,
}

/// A JavaScript program that is judged.
pub struct JavaScript {
    file: String,
    shared: Arc<Shared>,
    ear: Ear,
    stage: Rc<Stage>,
    threads: Vec<Thread>,
    began: Option<u32>,
    turns: u32,
    readings: Readings,
    errors: Vec<Problem>,
    ended: Option<u32>,
}

impl JavaScript {
    /// A program by its text; other files beside its own can be included and read.
    ///
    /// # Errors
    /// No more descriptors.
    pub fn new(file: &Path, text: &str) -> Result<Self, Error> {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let file = std::path::absolute(file)
            .map_err(|error| Error::file(file, format!("where is it? {error}")))?;
        let folder = file.parent().unwrap_or(Path::new("/")).to_owned();
        let failed =
            |why: &dyn std::fmt::Display| Error::system(format!("{name}: cannot be started"), why);
        let ear = Ear::default();
        let shared = Shared::new(PathBuf::new(), folder, Box::new(ear.clone()))
            .map_err(|error| failed(&error))?;
        let stage = Rc::new(Stage::default());
        let slot = shared.admit(MAIN).map_err(|why| failed(&why))?;
        let job = Job {
            name: MAIN.to_owned(),
            text: with_call_of_main(text.to_owned()).into(),
            kind: Kind::Program,
        };
        stage.begins.borrow_mut().push((job, slot));
        Ok(Self {
            file: name.clone().into_owned(),
            shared: Arc::new(shared),
            ear,
            stage,
            threads: Vec::new(),
            began: None,
            turns: 0,
            readings: Readings::default(),
            errors: Vec::new(),
            ended: None,
        })
    }

    /// The same, and it is kept at which lines its threads wait and ask.
    #[must_use]
    pub fn watched(self) -> Self {
        *self.stage.lines.borrow_mut() = Some(Lines::default());
        self
    }

    /// What a person may want to know of the run: things that the simulated robot does not have.
    pub fn remarks(&self) -> Vec<String> {
        let said = self.ear.0.lock().unwrap_or_else(PoisonError::into_inner);
        said.remarks.clone()
    }

    /// Threads that were asked for get their stacks; their names.
    fn begin(&mut self) -> Vec<String> {
        let begins = std::mem::take(&mut *self.stage.begins.borrow_mut());
        let mut begun = Vec::new();
        for (job, slot) in begins {
            let heard = Rc::new(RefCell::default());
            let here = Here {
                stage: self.stage.clone(),
                heard: Rc::clone(&heard),
                has_looked_up: Cell::new(false),
            };
            let (shared, own) = (self.shared.clone(), slot.clone());
            let words: usize = (JS_STACK_BYTES + JS_STACK_SPARE_BYTES) / size_of::<usize>();
            let start: Start = Box::new(move || {
                let platform = Rc::new(here);
                let outcome = unbroken(|| machine::run_on(platform, &job, &shared, &own));
                shared.finish(&own, outcome);
            });
            let body = Gn::<Start>::new_opt(words, || {
                #[expect(deprecated, reason = "a scope cannot be carried through an engine")]
                let start = generator::get_yield::<Start>();
                if let Some(start) = start {
                    start();
                }
            });
            begun.push(slot.name.clone());
            self.threads.push(Thread {
                slot,
                body,
                start: Some(start),
                heard,
                due: 0.0,
                listens: true,
                order: 0,
                calls: 0,
                tick: 0,
            });
        }
        begun
    }

    /// Runs one thread until it waits, or lets others go first; None: it has ended. Without a robot nothing is done.
    fn run(&mut self, at: usize, mut robot: Option<&mut dyn Brick>) -> Option<Wish> {
        loop {
            let thread = &mut self.threads[at];
            let _ = match thread.start.take() {
                Some(start) => thread.body.raw_send(Some(start)),
                None => thread.body.resume(),
            };
            if let Some(robot) = &mut robot {
                self.print(&mut **robot);
            }
            let thread = &mut self.threads[at];
            if thread.body.is_done() {
                return None;
            }
            let wish = self.stage.wish.take()?;
            match wish {
                Wish::Work => {
                    let work = self.stage.work.take();
                    if let (Some(work), Some(robot)) = (work, &mut robot) {
                        work(&mut **robot);
                    }
                }
                Wish::Wait(due) => {
                    (thread.due, thread.listens) = (due, true);
                    return Some(wish);
                }
                Wish::Tick => {
                    thread.due = f64::from(self.stage.now.get() + STEP_MS);
                    thread.listens = false;
                    return Some(wish);
                }
                Wish::After => return Some(wish),
            }
        }
    }

    fn print(&self, robot: &mut dyn Brick) {
        let mut said = self.ear.0.lock().unwrap_or_else(PoisonError::into_inner);
        if said.printed.is_empty() {
            return;
        }
        for text in said.take_printed() {
            let text = text.strip_suffix('\n').unwrap_or(&text);
            robot.command(Command::Console { text });
        }
    }

    /// The threads that can run by themselves, the first one first.
    fn due(&self, now: f64) -> Vec<usize> {
        let is_due = |thread: &Thread| {
            let records = || !thread.heard.borrow().records.is_empty();
            let is_woken = thread.listens && (thread.slot.bell.is_rung() || records());
            thread.due <= now || thread.slot.stops() || is_woken
        };
        let threads = 0..self.threads.len();
        let mut due: Vec<usize> = threads.filter(|at| is_due(&self.threads[*at])).collect();
        due.sort_by(|one, other| {
            let (one, other) = (&self.threads[*one], &self.threads[*other]);
            one.due
                .total_cmp(&other.due)
                .then(one.order.cmp(&other.order))
        });
        due
    }

    /// Runs all threads that can run, until each waits.
    fn work_off(&mut self, mut robot: Option<&mut dyn Brick>) {
        let now = self.stage.now.get();
        // Who goes before all others; the last one is the next.
        let mut first: Vec<String> = self.begin();
        loop {
            let named = first.pop();
            let at = match &named {
                Some(name) => {
                    let is_it = |thread: &Thread| thread.slot.name == *name;
                    self.threads.iter().position(is_it)
                }
                None => self.due(now.into()).first().copied(),
            };
            let Some(at) = at else {
                if named.is_some() {
                    continue;
                }
                return;
            };
            let thread = &mut self.threads[at];
            if thread.tick != now {
                (thread.tick, thread.calls) = (now, 0);
            }
            self.stage.calls.set(thread.calls);
            let wish = self.run(
                at,
                robot.as_deref_mut().map(|robot| robot as &mut dyn Brick),
            );
            self.turns += 1;
            let thread = &mut self.threads[at];
            (thread.order, thread.calls) = (self.turns, self.stage.calls.get());
            match wish {
                None => {
                    if let Some(lines) = &mut *self.stage.lines.borrow_mut() {
                        lines.end(&self.threads[at].slot.name, now + START_MS);
                    }
                    self.threads.remove(at);
                }
                Some(Wish::After) => {
                    let name = thread.slot.name.clone();
                    let woken = self.due(now.into());
                    let others = woken
                        .into_iter()
                        .rev()
                        .map(|at| &self.threads[at].slot.name);
                    let others: Vec<_> = others.filter(|other| **other != name).cloned().collect();
                    first.push(name);
                    first.extend(others);
                    first.extend(self.begin());
                }
                Some(_) => {}
            }
        }
    }

    /// What comes from outside: messages, keys, the gamepad.
    fn hear(&self, robot: &mut dyn Brick) {
        for _ in 0..JS_MESSAGES {
            let Some(text) = robot.mail() else { break };
            self.shared.post(-1, text);
        }
        let listens = |path: &str| {
            let mut threads = self.threads.iter();
            threads.any(|thread| thread.heard.borrow().paths.contains(path))
        };
        let mut input = self.stage.input.borrow_mut();
        if listens(KEYS)
            && let Some(record) = input.keys(robot)
        {
            self.note(KEYS, record);
        }
        if listens(GAMEPAD) {
            for record in input.gamepad(robot) {
                self.note(GAMEPAD, record);
            }
        }
    }

    fn note(&self, path: &str, seen: Record) {
        let record = record(seen);
        for thread in &self.threads {
            thread.heard.borrow_mut().note(path, &record);
        }
    }

    fn status(&self) -> Status {
        self.ended.map_or(Status::Running, |at| Status::Ended {
            at,
            with_errors: !self.errors.is_empty(),
        })
    }

    /// All that is due in this step.
    fn act(&mut self, robot: &mut dyn Brick) {
        self.hear(robot);
        self.work_off(Some(robot));
        if self.threads.is_empty() {
            self.end(robot);
        }
    }

    /// No thread lives any more.
    fn end(&mut self, robot: &mut dyn Brick) {
        self.ended = Some(self.stage.now.get());
        let failure = self.shared.failure();
        self.errors
            .extend(failure.map(|failure| problem(&self.file, &failure.to_string())));
        robot.command(Command::Rest);
    }

    /// Ends all threads: what they ask for is no longer done.
    fn quit(&mut self) {
        self.shared.quit(None);
        self.work_off(None);
    }
}

impl Program for JavaScript {
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status {
        if self.ended.is_some() {
            return self.status();
        }
        let began = *self.began.get_or_insert(now_ms + START_MS);
        let Some(now) = now_ms.checked_sub(began) else {
            return Status::Running;
        };
        self.stage.now.set(now);
        let mut readings = std::mem::take(&mut self.readings);
        self.act(&mut readings.of(robot, now + START_MS));
        self.readings = readings;
        self.status()
    }

    fn stop(&mut self, robot: &mut dyn Brick) {
        if self.ended.is_none() {
            self.quit();
            self.ended = Some(self.stage.now.get());
            robot.command(Command::Rest);
        }
    }

    fn errors(&self) -> &[Problem] {
        &self.errors
    }

    fn running(&self) -> Vec<Running> {
        let lines = self.stage.lines.borrow();
        lines
            .as_ref()
            .map_or_else(Vec::new, |lines| lines.running(&self.file))
    }

    fn describe(&self, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
        if let Some(lines) = &*self.stage.lines.borrow() {
            lines.describe(locale, tell);
        }
    }
}

impl Drop for JavaScript {
    fn drop(&mut self) {
        // A stack that is thrown away would be unwound through the engine.
        self.quit();
    }
}
