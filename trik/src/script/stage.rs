//! Where one thread of a judged JavaScript program stands: each call to the robot hands over to who steps the program.
//!
//! Owns the hand-over and what it costs. A thread runs on a stack of its own, so a call may stop in its middle, however
//! deep, and go on in a later step. A program that asks [`limits::SCRIPT_CALLS`] times without waiting, or computes until the
//! engine has looked up a few times (some 10 000 turns of a loop), is charged one tick.

use super::beside;
use crate::limits::SCRIPT_PRINT_BYTES;
use lang_diagram::brick::{Brick, Command};
use std::cell::{Cell, RefCell};
use std::collections::{BTreeSet, VecDeque};
use std::fmt;
use std::io;
use std::rc::Rc;
use std::sync::{Arc, Mutex, PoisonError};
use studio::limits;
use studio::script::asked::START_MS;
use studio::script::input::{GAMEPAD, Input, KEYS, Record as Seen};
use studio::script::lines::Lines;
use studio::script::tree::Tree;
use studio::script::{drawing, post};
use trikd::display::Unshown;
use trikd::engine::NoThread;
use trikd::js::events::Record;
use trikd::js::files::Unread;
use trikd::js::machine::Job;
use trikd::js::outside::Output;
use trikd::js::platform::{Platform, Shown};
use trikd::js::shared::{Shared, Slot};
use trikd::pictures::NoPicture;
use trikd::tree::Answers;

/// What is done with the robot while a thread waits for the answer.
pub type Work = Box<dyn FnOnce(&mut dyn Brick)>;

/// Why a thread has handed over.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Wish {
    /// The robot is to do something; it goes on at once.
    Work,
    /// It waits until a time, its bell or a record.
    Wait(f64),
    /// It has used up its tick.
    Tick,
    /// Others whose bells were rung, and threads that begin, go first.
    After,
}

/// What all threads of a run share.
#[derive(Default)]
pub struct Stage {
    /// Model time in milliseconds since the first step.
    pub now: Cell<u32>,
    /// What the running thread wants.
    pub wish: Cell<Option<Wish>>,
    /// What it wants done.
    pub work: RefCell<Option<Work>>,
    /// Threads that begin.
    pub begins: RefCell<Vec<(Job, Arc<Slot>)>>,
    /// The robot as files.
    pub tree: RefCell<Tree>,
    /// Keys and gamepad.
    pub input: RefCell<Input>,
    /// Calls of the running thread in this tick.
    pub calls: Cell<u32>,
    /// At which lines threads are, if somebody looks on.
    pub lines: RefCell<Option<Lines>>,
    /// The hull number of this robot.
    hull: Cell<i32>,
}

impl Stage {
    /// Stops in the middle of whatever runs, until it is resumed.
    fn hand_over(&self, wish: Wish) {
        self.wish.set(Some(wish));
        #[expect(deprecated, reason = "a scope cannot be carried through an engine")]
        generator::yield_with(());
    }

    /// So many more calls.
    fn charge(&self, calls: u32) {
        let calls = self.calls.get() + calls;
        self.calls.set(calls);
        if calls > limits::SCRIPT_CALLS {
            self.hand_over(Wish::Tick);
        }
    }

    /// Does something with the robot. None: nobody steps the program any more.
    fn with<T: 'static>(&self, work: impl FnOnce(&mut dyn Brick) -> T + 'static) -> Option<T> {
        self.charge(1);
        let answer = Rc::new(Cell::new(None));
        let into = answer.clone();
        let work: Work = Box::new(move |brick| into.set(Some(work(brick))));
        *self.work.borrow_mut() = Some(work);
        self.hand_over(Wish::Work);
        answer.take()
    }

    fn try_with<T: 'static>(
        &self,
        work: impl FnOnce(&mut dyn Brick) -> io::Result<T> + 'static,
    ) -> io::Result<T> {
        self.with(work)
            .unwrap_or_else(|| Err(io::Error::other("the run is over")))
    }
}

/// What a program has said and nobody has heard yet.
#[derive(Debug, Default)]
pub struct Transcript {
    /// What was printed.
    pub printed: Vec<String>,
    /// Remarks that a person may want to know.
    pub remarks: Vec<String>,
    bytes: usize,
}

impl Transcript {
    /// What was printed since the last time.
    pub fn take_printed(&mut self) -> Vec<String> {
        self.bytes = 0;
        std::mem::take(&mut self.printed)
    }
}

/// The way out of all threads.
#[derive(Clone, Debug, Default)]
pub struct Ear(pub Arc<Mutex<Transcript>>);

impl Ear {
    fn with(&self, work: impl FnOnce(&mut Transcript)) {
        work(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner));
    }
}

impl Output for Ear {
    fn print(&self, text: &str) -> io::Result<()> {
        self.with(|said| {
            if said.bytes + text.len() <= SCRIPT_PRINT_BYTES {
                said.bytes += text.len();
                said.printed.push(text.to_owned());
            }
        });
        Ok(())
    }

    fn error(&self, text: &str) -> io::Result<()> {
        self.info(text)
    }

    fn info(&self, text: &str) -> io::Result<()> {
        self.with(|said| {
            if said.remarks.len() < limits::SCRIPT_REMARKS {
                said.remarks.push(text.to_owned());
            }
        });
        Ok(())
    }

    fn events(&self) -> io::Result<()> {
        Ok(())
    }

    fn web(&self, _json: &str) -> io::Result<()> {
        Ok(())
    }
}

/// Records that a thread listens to.
#[derive(Debug, Default)]
pub struct Subscriptions {
    /// The streams.
    pub paths: BTreeSet<String>,
    /// What has come.
    pub records: VecDeque<(String, Record)>,
}

impl Subscriptions {
    /// Notes what has come on a stream, if somebody listens to it.
    pub fn note(&mut self, path: &str, record: &Record) {
        if self.paths.contains(path) {
            if self.records.len() >= limits::SCRIPT_EVENTS {
                self.records.pop_front();
            }
            self.records.push_back((path.to_owned(), record.clone()));
        }
    }
}

/// What keys or gamepad have brought, as an engine hears it.
pub fn record(seen: Seen) -> Record {
    match seen {
        Seen::Numbers(numbers) => Record::Numbers(numbers),
        Seen::Line(line) => Record::Line(line),
    }
}

/// One thread's view of the stage.
#[derive(Clone)]
pub struct Here {
    /// What all share.
    pub stage: Rc<Stage>,
    /// What it listens to.
    pub heard: Rc<RefCell<Subscriptions>>,
    /// Whether its engine has looked up from its work.
    pub has_looked_up: Cell<bool>,
}

impl fmt::Debug for Here {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Here").finish_non_exhaustive()
    }
}

impl Here {
    fn tree<T: 'static>(
        &self,
        path: &str,
        work: impl FnOnce(&mut Tree, &mut dyn Brick, &str) -> T + 'static,
    ) -> Option<T> {
        let (stage, path) = (self.stage.clone(), path.to_owned());
        self.stage
            .with(move |brick| work(&mut stage.tree.borrow_mut(), brick, &path))
    }
}

fn over<T>() -> io::Result<T> {
    Err(io::Error::other("the run is over"))
}

impl Answers for Here {
    fn has(&self, directory: &str) -> bool {
        let found = self.tree(directory, |tree, brick, path| tree.has(brick, path));
        found.unwrap_or(false)
    }

    fn is_file(&self, path: &str) -> bool {
        path == "display/device"
    }

    fn names(&self, directory: &str) -> Vec<String> {
        self.tree(directory, |tree, brick, path| tree.names(brick, path))
            .unwrap_or_default()
    }

    fn read(&self, path: &str) -> io::Result<String> {
        self.tree(path, |tree, brick, path| tree.read(brick, path))
            .unwrap_or_else(over)
    }

    fn write(&self, path: &str, text: &str) -> io::Result<()> {
        let text = text.to_owned();
        let done = self.tree(path, move |tree, brick, path| {
            tree.write(brick, path, &text)
        });
        let has_cleared = self
            .stage
            .tree
            .borrow_mut()
            .has_cleared(self.stage.now.get());
        if has_cleared {
            self.stage.hand_over(Wish::Tick);
        }
        done.unwrap_or_else(over)
    }

    fn now_us(&self) -> u128 {
        u128::from(self.stage.now.get()) * 1000
    }
}

impl Platform for Here {
    fn brick(&self) -> trikd::brick::Brick {
        trikd::brick::Brick::answered(Rc::new(self.clone()))
    }

    fn clock_ms(&self) -> f64 {
        self.stage.charge(1);
        self.stage.now.get().into()
    }

    fn stops(&self, slot: &Slot) -> bool {
        // The engine looks up for the first time when it has just begun.
        if self.has_looked_up.replace(true) && !slot.stops() {
            self.stage.charge(limits::SCRIPT_LOOK_CALLS);
        }
        slot.stops()
    }

    fn wait(&self, slot: &Slot, until_ms: f64) -> io::Result<bool> {
        self.stage.charge(1);
        let has_reason = || slot.bell.is_rung() || !self.heard.borrow().records.is_empty();
        if !has_reason() && until_ms > f64::from(self.stage.now.get()) {
            self.stage.hand_over(Wish::Wait(until_ms));
        }
        let is_woken = has_reason();
        if slot.bell.is_rung() {
            slot.bell.hush();
        }
        Ok(is_woken)
    }

    fn listen(&self, _brick: &trikd::brick::Brick, path: &str, _numbers: usize) -> io::Result<()> {
        if ![KEYS, GAMEPAD].contains(&path) {
            return Err(io::ErrorKind::NotFound.into());
        }
        self.heard.borrow_mut().paths.insert(path.to_owned());
        Ok(())
    }

    fn drain(&self, path: &str) -> Vec<Record> {
        self.stage.charge(1);
        let mut drained = Vec::new();
        self.heard.borrow_mut().records.retain(|(other, record)| {
            if other == path {
                drained.push(record.clone());
            }
            other != path
        });
        drained
    }

    fn next(&self) -> Option<(String, Record)> {
        self.heard.borrow_mut().records.pop_front()
    }

    fn start(&self, shared: &Arc<Shared>, job: Job) -> Result<(), NoThread> {
        let slot = shared.admit(&job.name)?;
        self.stage.begins.borrow_mut().push((job, slot));
        self.give_way();
        Ok(())
    }

    fn give_way(&self) {
        self.stage.charge(1);
        self.stage.hand_over(Wish::After);
    }

    fn is_watched(&self) -> bool {
        self.stage.lines.borrow().is_some()
    }

    fn stand(&self, slot: &Slot, file: &str, line: u32) {
        if let Some(lines) = &mut *self.stage.lines.borrow_mut() {
            lines.stand(&slot.name, file, line, self.stage.now.get() + START_MS);
        }
    }

    fn has_spoken(&self) {
        // What was printed is heard before anything else is done.
        let _ = self.stage.with(|_| ());
    }

    fn mailbox(&self, _shared: &Shared, words: String) -> io::Result<String> {
        let stage = self.stage.clone();
        let answer = self.stage.with(move |brick| {
            let mut hull = stage.hull.get();
            let answer = post::answer(&words, &mut hull, |command| brick.command(command));
            stage.hull.set(hull);
            answer
        });
        answer.map_or_else(over, Ok)
    }

    fn show(&self, _shared: &Shared, shown: Shown<'_>) -> Result<(), Unshown> {
        let Shown::Order(line) = shown else {
            let why = "pictures are not shown in the simulator";
            return Err(Unshown::Simulated(why.to_owned()));
        };
        let line = line.to_owned();
        let done = self
            .stage
            .with(move |brick| drawing::order(&line, |command| brick.command(command)));
        done.unwrap_or(Ok(()))
            .map_err(|error| Unshown::Simulated(error.to_string()))
    }

    fn photo(&self, _shared: &Shared) -> Result<screen::Pixels, NoPicture> {
        Err(NoPicture::Simulated)
    }

    fn include(&self, shared: &Shared, file: &str) -> Result<String, Unread> {
        self.stage.charge(1);
        beside(&shared.folder, file)
    }

    fn read_file(&self, shared: &Shared, file: &str) -> Result<String, Unread> {
        self.stage.charge(1);
        if let Some(bytes) = self.stage.tree.borrow().written(file) {
            return Ok(String::from_utf8_lossy(bytes).into_owned());
        }
        beside(&shared.folder, file)
    }

    fn append(&self, _shared: &Shared, file: &str, bytes: &[u8]) -> io::Result<()> {
        let (stage, file, bytes) = (self.stage.clone(), file.to_owned(), bytes.to_vec());
        self.stage
            .try_with(move |brick| stage.tree.borrow_mut().append(brick, &file, &bytes))
    }

    fn remove(&self, _shared: &Shared, file: &str) -> io::Result<()> {
        let done = self.tree(file, |tree, brick, file| tree.remove(brick, file));
        done.map_or_else(over, Ok)
    }

    fn system(&self, _shared: &Shared, command: &str, _waits: bool) -> io::Result<i32> {
        let command = command.to_owned();
        let told = self.stage.with(move |brick| {
            brick.command(Command::System {
                command: &command,
                code: false,
            });
        });
        told.map_or_else(over, |()| Ok(0))
    }

    fn random(&self, low: i32, high: i32) -> Option<i32> {
        let high = high.max(low);
        self.stage.with(move |brick| brick.random(low, high))
    }

    fn date_ms(&self) -> Option<f64> {
        self.stage.charge(1);
        Some((limits::SCRIPT_EPOCH_MS + u64::from(self.stage.now.get())) as f64)
    }
}
