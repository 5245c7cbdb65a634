//! What all engines of one program share: output, messages, and which threads run.
//!
//! Owns the joints between threads. Each engine has a slot: an inbox, a bell to wait on, and a flag that ends it. Values
//! of JavaScript never pass from one engine to another; texts do.

use super::debug::{Debugger, Who};
use super::machine::{self, Job};
use super::outside::Output;
use crate::display::Display;
use crate::engine::{Failure, NoThread, Outcome};
use crate::limits;
use nix::sys::eventfd::{EfdFlags, EventFd};
use std::collections::{HashMap, VecDeque};
use std::io;
use std::os::fd::{AsFd, BorrowedFd};
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::PathBuf;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// The thread that a program begins in.
pub const MAIN: &str = "main";

/// What happens to an engine.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Event {
    /// A message of the mailbox has come: hull number and text.
    Mail(i32, String),
    /// A direct text.
    Direct(String),
    /// Somebody wants to see the variables for web pages.
    Web,
}

/// A descriptor that is readable after it was rung.
#[derive(Debug)]
pub struct Bell {
    fd: EventFd,
    rung: AtomicBool,
}

impl Bell {
    fn new() -> io::Result<Self> {
        let flags = EfdFlags::EFD_CLOEXEC | EfdFlags::EFD_NONBLOCK;
        Ok(Self {
            fd: EventFd::from_flags(flags)?,
            rung: AtomicBool::new(false),
        })
    }

    /// To wait on.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.fd.as_fd()
    }

    /// Fails only when it has been rung so often that it is readable for sure.
    pub fn ring(&self) {
        self.rung.store(true, Ordering::Relaxed);
        let _ = self.fd.write(1);
    }

    /// Silent again; whether it was rung.
    pub fn hush(&self) -> bool {
        self.rung.store(false, Ordering::Relaxed);
        self.fd.read().is_ok()
    }

    /// Whether it was rung and not hushed, for another wait on the same thread.
    pub fn is_rung(&self) -> bool {
        self.rung.load(Ordering::Relaxed)
    }
}

/// What stands for one engine in the others.
#[derive(Debug)]
pub struct Slot {
    /// The name of its thread.
    pub name: String,
    /// Its number; each thread of a program has another one.
    pub number: u32,
    /// Rung when something has changed that it may wait for.
    pub bell: Bell,
    inbox: Mutex<VecDeque<Event>>,
    stops: AtomicBool,
}

impl Slot {
    fn new(name: &str, number: u32) -> io::Result<Self> {
        Ok(Self {
            name: name.to_owned(),
            number,
            bell: Bell::new()?,
            inbox: Mutex::default(),
            stops: AtomicBool::new(false),
        })
    }

    /// As a debugger knows it.
    pub fn who(&self) -> Who<'_> {
        Who {
            number: self.number,
            name: &self.name,
        }
    }

    /// Ends it: a loop at the next turn, a wait at once.
    pub fn stop(&self) {
        self.stops.store(true, Ordering::Relaxed);
        self.bell.ring();
    }

    /// Whether it was stopped.
    pub fn stops(&self) -> bool {
        self.stops.load(Ordering::Relaxed)
    }

    /// Tells it something; lost when it does not listen for too long.
    pub fn deliver(&self, event: Event) {
        let mut inbox = lock(&self.inbox);
        if inbox.len() < limits::JS_EVENTS {
            inbox.push_back(event);
        }
        drop(inbox);
        self.bell.ring();
    }

    /// What it was told.
    pub fn next(&self) -> Option<Event> {
        lock(&self.inbox).pop_front()
    }
}

/// A panic of another thread leaves nothing half done here.
fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The work of one engine; who waits for its end must hear of it in any case.
pub fn unbroken(work: impl FnOnce() -> Outcome) -> Outcome {
    catch_unwind(AssertUnwindSafe(work)).unwrap_or(Err(Failure::Broken))
}

/// A question to the mailbox and where its answer goes.
pub type Question = (String, Sender<io::Result<String>>);

/// The program as a whole.
pub struct Shared {
    /// Where the tree is mounted.
    pub root: PathBuf,
    /// The directory that files are included from.
    pub folder: PathBuf,
    /// Rung when the process has something to do: a question, an end.
    pub bell: Bell,
    /// Who debugs it.
    pub debugger: Debugger,
    started: AtomicU32,
    output: Mutex<Box<dyn Output>>,
    display: Mutex<Display>,
    mail: Mutex<VecDeque<(i32, String)>>,
    questions: Mutex<VecDeque<Question>>,
    running: Mutex<HashMap<String, Arc<Slot>>>,
    notes: Mutex<HashMap<String, VecDeque<String>>>,
    failure: Mutex<Option<Failure>>,
    quits: AtomicBool,
}

impl Shared {
    /// Nothing runs yet.
    ///
    /// # Errors
    /// No more descriptors.
    pub fn new(root: PathBuf, folder: PathBuf, output: Box<dyn Output>) -> io::Result<Self> {
        Ok(Self {
            display: Mutex::new(Display::new(&root)),
            root,
            folder,
            bell: Bell::new()?,
            debugger: Debugger::default(),
            started: AtomicU32::new(0),
            output: Mutex::new(output),
            mail: Mutex::default(),
            questions: Mutex::default(),
            running: Mutex::default(),
            notes: Mutex::default(),
            failure: Mutex::default(),
            quits: AtomicBool::new(false),
        })
    }

    /// The display, which all threads draw on.
    pub fn display(&self) -> MutexGuard<'_, Display> {
        lock(&self.display)
    }

    /// The way out, for one message; when nobody reads it, the program ends.
    pub fn say(&self, what: impl FnOnce(&dyn Output) -> io::Result<()>) {
        if what(&**lock(&self.output)).is_err() {
            self.quit(None);
        }
    }

    /// Ends the program; the engine that asks for it goes on to the end of its function.
    pub fn quit(&self, asker: Option<&Slot>) {
        self.quits.store(true, Ordering::Relaxed);
        for slot in lock(&self.running).values() {
            if asker.is_none_or(|asker| asker.name != slot.name) {
                slot.stop();
            }
            slot.bell.ring();
        }
        self.debugger.wake();
        self.bell.ring();
    }

    /// A thread stays here while a debugger has stopped the program.
    pub fn pass(&self, slot: &Slot) {
        self.debugger
            .pass(slot.who(), || slot.stops() || self.quits());
    }

    /// Whether the program is to end.
    pub fn quits(&self) -> bool {
        self.quits.load(Ordering::Relaxed)
    }

    /// Starts an engine on a thread of its own.
    ///
    /// # Errors
    /// Why there is none: its name is taken, there are too many.
    pub fn start(self: &Arc<Self>, job: Job) -> Result<(), NoThread> {
        let slot = self.admit(&job.name)?;
        let (shared, own) = (self.clone(), slot.clone());
        let started = std::thread::Builder::new()
            .name("js".to_owned())
            .stack_size(limits::JS_STACK_BYTES + limits::JS_STACK_SPARE_BYTES)
            .spawn(move || {
                let outcome = unbroken(|| machine::run(&job, &shared, &own));
                shared.finish(&own, outcome);
            });
        if let Err(error) = started {
            lock(&self.running).remove(&slot.name);
            return Err(NoThread::System(error.into()));
        }
        Ok(())
    }

    /// A slot for a thread that begins now; its runner calls [`Shared::finish`] at its end.
    ///
    /// # Errors
    /// Its name is taken, or there are too many.
    pub fn admit(&self, name: &str) -> Result<Arc<Slot>, NoThread> {
        let mut running = lock(&self.running);
        if running.contains_key(name) {
            return Err(NoThread::Occupied(name.to_owned()));
        }
        if running.len() >= limits::JS_THREADS {
            return Err(NoThread::TooMany);
        }
        let number = 1 + self.started.fetch_add(1, Ordering::Relaxed);
        let slot = Slot::new(name, number).map_err(|error| NoThread::System(error.into()))?;
        let slot = Arc::new(slot);
        self.debugger.enter(slot.who());
        running.insert(slot.name.clone(), slot.clone());
        Ok(slot)
    }

    /// A thread has ended; with its failure the program ends.
    pub fn finish(&self, slot: &Slot, outcome: Outcome) {
        let mut running = lock(&self.running);
        running.remove(&slot.name);
        self.debugger.forget(slot.who());
        lock(&self.notes).remove(&slot.name);
        for other in running.values() {
            other.bell.ring();
        }
        drop(running);
        if let Err(failure) = outcome {
            lock(&self.failure).get_or_insert(failure);
            self.quit(None);
        }
        self.bell.ring();
    }

    /// Whether a thread of this name runs; with None: any.
    pub fn runs(&self, name: Option<&str>) -> bool {
        let running = lock(&self.running);
        name.map_or(!running.is_empty(), |name| running.contains_key(name))
    }

    /// Ends the threads that match.
    pub fn kill(&self, which: impl Fn(&str) -> bool) {
        for slot in lock(&self.running)
            .values()
            .filter(|slot| which(&slot.name))
        {
            slot.stop();
        }
        self.debugger.wake();
    }

    /// Tells something to one thread, or to all.
    pub fn deliver(&self, name: Option<&str>, event: &Event) {
        for slot in lock(&self.running).values() {
            if name.is_none_or(|name| name == slot.name) {
                slot.deliver(event.clone());
            }
        }
    }

    /// The first failure of any thread.
    pub fn failure(&self) -> Option<Failure> {
        lock(&self.failure).take()
    }

    /// A message of the mailbox has come.
    pub fn post(&self, hull: i32, text: String) {
        let mut mail = lock(&self.mail);
        mail.push_back((hull, text.clone()));
        if mail.len() > limits::JS_MESSAGES {
            mail.pop_front();
        }
        drop(mail);
        self.deliver(None, &Event::Mail(hull, text));
    }

    /// The oldest message of the mailbox.
    pub fn take_mail(&self) -> Option<String> {
        lock(&self.mail).pop_front().map(|(_, text)| text)
    }

    /// Whether there is one.
    pub fn has_mail(&self) -> bool {
        !lock(&self.mail).is_empty()
    }

    /// Asks the mailbox; the process answers.
    pub fn ask(&self, words: String) -> Receiver<io::Result<String>> {
        let (answer, receiver) = channel();
        lock(&self.questions).push_back((words, answer));
        self.bell.ring();
        receiver
    }

    /// A question that was asked.
    pub fn question(&self) -> Option<Question> {
        lock(&self.questions).pop_front()
    }

    /// While the answer to a question comes, nobody else uses the channel.
    pub fn quietly<T>(&self, work: impl FnOnce() -> T) -> T {
        let _output = lock(&self.output);
        work()
    }

    /// Leaves a message for a thread, which may be started later.
    pub fn leave_note(&self, name: &str, text: String) {
        let mut notes = lock(&self.notes);
        if notes.len() >= limits::JS_MESSAGES && !notes.contains_key(name) {
            return;
        }
        let queue = notes.entry(name.to_owned()).or_default();
        queue.push_back(text);
        if queue.len() > limits::JS_MESSAGES {
            queue.pop_front();
        }
        drop(notes);
        if let Some(slot) = lock(&self.running).get(name) {
            slot.bell.ring();
        }
    }

    /// The oldest message for a thread.
    pub fn take_note(&self, name: &str) -> Option<String> {
        lock(&self.notes).get_mut(name)?.pop_front()
    }
}
