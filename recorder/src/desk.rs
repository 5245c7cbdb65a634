//! The thread that looks at a tree for all who take what it sees: the black box and live streams.
//!
//! Owns who takes it. Looks at nothing while nobody does; a tree that is not there yet is waited for. Lines about programs and
//! messages come from the owner of the desk.

use crate::clock::now_ns;
use crate::entry::{Batch, Entry};
use crate::errno::LEFT;
use crate::error::Error;
use crate::kept::{self, BlackBox, OnSaved, SaveReason};
use crate::limits;
use crate::watch::{Wants, Watch, Wish};
use journal::standard::{Level, Log};
use journal::write::Story;
use std::collections::HashSet;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, TrySendError, sync_channel};
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// What the thread is told.
enum Order {
    /// Something has happened beside the tree.
    Line(Entry),
    /// A program starts, and this is its file.
    Program(Entry),
    /// The last minutes shall be saved.
    Save(SaveReason, OnSaved),
    /// Somebody who wants to hear comes.
    Listen(Box<dyn Listener>),
}

/// Somebody who takes what is seen. It is called from the thread that looks, so it waits for nothing.
pub trait Listener: Send {
    /// Which nodes are wanted, and how much.
    fn wants(&self) -> Wants;

    /// Whether what devices give is wanted too, before it is converted. Others never hear of it.
    fn wants_raw(&self) -> bool {
        false
    }

    /// Takes what has come, which may be nothing, at this moment in ns since 1970. False: it wants no more.
    fn put(&mut self, entries: &[Entry], now_ns: u64) -> bool;
}

/// The way to the thread. Dropping it ends that, and waits for what is being saved.
pub struct Desk {
    /// None at the end.
    orders: Option<SyncSender<Order>>,
    thread: Option<JoinHandle<()>>,
    keeps: bool,
    is_heard: Arc<AtomicBool>,
}

impl Drop for Desk {
    fn drop(&mut self) {
        self.orders = None;
        if let Some(thread) = self.thread.take() {
            // It has failed: there is nothing to wait for.
            let _ = thread.join();
        }
    }
}

/// What a desk is for.
pub struct Settings {
    /// Where the tree is mounted.
    pub root: PathBuf,
    /// The program that records, with its version, as `trikd/0.1.0`.
    pub library: String,
    /// The black box; None without one.
    pub kept: Option<kept::Settings>,
    /// The folder in which the world around a virtual robot is told.
    pub world: Option<PathBuf>,
}

impl Desk {
    /// Starts the thread. `told` hears when minutes were saved that nobody has asked for.
    ///
    /// # Errors
    /// The folder of the black box cannot be used, or there are no more threads.
    pub fn start(
        settings: Settings,
        told: impl Fn(Result<PathBuf, Error>) + Clone + Send + 'static,
    ) -> Result<Self, Error> {
        let left: OnSaved = Box::new(told.clone());
        let kept = settings
            .kept
            .map(|kept| BlackBox::open(kept, &settings.library, left))
            .transpose()?;
        let (orders, come) = sync_channel(limits::LINES);
        let keeps = kept.is_some();
        let is_heard = Arc::new(AtomicBool::new(keeps));
        let mut work = Work {
            root: settings.root,
            world: settings.world,
            library: settings.library,
            watch: None,
            numbers: 0,
            looks_at: Instant::now(),
            kept,
            listeners: Vec::new(),
            told: Box::new(move || Box::new(told.clone())),
            batch: Vec::new(),
            program: None,
            values: Values::default(),
            is_heard: is_heard.clone(),
        };
        let thread = std::thread::Builder::new()
            .name("recorder".to_owned())
            .spawn(move || {
                // After a panic it looks at everything anew, for the listeners that come then.
                while catch_unwind(AssertUnwindSafe(|| work.run(&come))).is_err() {
                    work.leave();
                    work.batch.clear();
                    work.listeners.clear();
                }
                if let Some(kept) = work.kept.take() {
                    kept.close();
                }
            })
            .map_err(|error| Error::Thread(error.to_string()))?;
        Ok(Self {
            orders: Some(orders),
            thread: Some(thread),
            keeps,
            is_heard,
        })
    }

    /// Whether the last minutes are kept.
    pub fn keeps(&self) -> bool {
        self.keeps
    }

    /// Whether anybody takes what is seen, so that lines are worth their while.
    pub fn is_heard(&self) -> bool {
        self.is_heard.load(Ordering::Relaxed)
    }

    /// Something has happened beside the tree. It is lost if the thread is far too slow.
    pub fn line(&self, story: Story, name: &str, level: Level, text: &str) {
        let line = Log {
            level,
            name: name.to_owned(),
            text: text.to_owned(),
            errno: 0,
        };
        self.give(Order::Line(Entry::Line(story, now_ns(), Arc::new(line))));
    }

    /// A program starts: its file goes with every recording, instead of that of the program before.
    pub fn program(&self, name: &str, media_type: &'static str, bytes: &[u8]) {
        let name = name.into();
        self.give(Order::Program(Entry::Attachment(
            now_ns(),
            name,
            media_type,
            bytes.into(),
        )));
    }

    /// Saves the last minutes; `told` hears the file, or why there is none.
    pub fn save(&self, why: SaveReason, told: OnSaved) {
        self.give(Order::Save(why, told));
    }

    /// A listener has what it wants from now on. If there are too many of them, it is dropped.
    pub fn listen(&self, listener: Box<dyn Listener>) {
        self.give(Order::Listen(listener));
    }

    fn give(&self, order: Order) {
        let Some(orders) = &self.orders else { return };
        match orders.try_send(order) {
            Ok(()) => {}
            Err(TrySendError::Full(order) | TrySendError::Disconnected(order)) => match order {
                Order::Save(_, told) => told(Err(Error::TooMany("orders at once"))),
                // Dropping a listener ends its connection.
                Order::Line(_) | Order::Program(_) | Order::Listen(_) => {}
            },
        }
    }
}

struct Work {
    root: PathBuf,
    world: Option<PathBuf>,
    library: String,
    /// None while nobody wants anything, or there is no tree.
    watch: Option<Watch>,
    /// The greatest number of a node that anybody has heard of.
    numbers: u32,
    /// When a tree that is not there is looked for again.
    looks_at: Instant,
    kept: Option<BlackBox>,
    listeners: Vec<Box<dyn Listener>>,
    told: Box<dyn Fn() -> OnSaved + Send>,
    batch: Vec<Entry>,
    /// The file of the program that was started last.
    program: Option<Entry>,
    values: Values,
    is_heard: Arc<AtomicBool>,
}

impl Work {
    fn run(&mut self, orders: &Receiver<Order>) {
        let turn = Duration::from_millis(limits::LOOK_MS.into());
        loop {
            let is_idle = self.kept.is_none() && self.listeners.is_empty();
            self.is_heard.store(!is_idle, Ordering::Relaxed);
            if is_idle {
                // Rings that nobody reads are not filled, and nothing stays open.
                self.leave();
                self.batch.clear();
            }
            let order = match is_idle {
                true => orders.recv().map_err(|_| RecvTimeoutError::Disconnected),
                false => orders.recv_timeout(turn),
            };
            match order {
                Ok(order) => self.obey(order),
                Err(RecvTimeoutError::Timeout) => {}
                Err(RecvTimeoutError::Disconnected) => return,
            }
            while let Ok(order) = orders.try_recv() {
                self.obey(order);
            }
            self.look();
        }
    }

    fn obey(&mut self, order: Order) {
        match order {
            Order::Line(line) => self.batch.push(line),
            Order::Program(file) => {
                self.batch.push(file.clone());
                self.program = Some(file);
            }
            Order::Save(why, told) => self.save(why, told),
            Order::Listen(listener) => self.welcome(listener),
        }
    }

    fn save(&mut self, why: SaveReason, told: OnSaved) {
        let Some(kept) = &mut self.kept else {
            told(Err(Error::Request(
                "no black box is kept here: start trikd with --box-minutes".to_owned(),
            )));
            return;
        };
        if !kept.is_due(why) {
            return;
        }
        // What has come until now belongs to it.
        self.hand_over();
        if let Some(kept) = &mut self.kept {
            kept.save(why, told);
        }
    }

    fn welcome(&mut self, listener: Box<dyn Listener>) {
        if self.listeners.len() == limits::LISTENERS {
            return;
        }
        // Until now it is for the others.
        self.hand_over();
        self.listeners.push(listener);
        self.is_heard.store(true, Ordering::Relaxed);
        self.want();
        self.ensure();
        let mut beginning: Vec<Entry> = self.program.iter().cloned().collect();
        beginning.extend(self.watch.iter().flat_map(Watch::beginning));
        if let Some(listener) = self.listeners.last_mut() {
            beginning.retain(|entry| !entry.is_raw() || listener.wants_raw());
            if !beginning.is_empty() {
                listener.put(&beginning, now_ns());
            }
        }
    }

    /// Which nodes anybody wants.
    fn wants(&self) -> Wants {
        let kept = self.kept.as_ref().map(|_| Wish::ByTheClock);
        let all: Vec<_> = (self.listeners.iter())
            .map(|listener| listener.wants())
            .collect();
        let most = move |path: &str| all.iter().filter_map(|wants| wants(path)).max();
        Box::new(move |path| most(path).max(kept))
    }

    /// What anybody wants has changed.
    fn want(&mut self) {
        let (wants, raw) = (self.wants(), self.wants_raw());
        if let Some(watch) = &mut self.watch {
            watch.want(wants, &mut self.batch);
            watch.want_raw(raw, &mut self.batch);
        }
    }

    /// Whether anybody wants what devices give. The black box does: a tree gives it only if somebody has asked for that.
    fn wants_raw(&self) -> bool {
        self.kept.is_some() || self.listeners.iter().any(|listener| listener.wants_raw())
    }

    fn leave(&mut self) {
        if let Some(watch) = self.watch.take() {
            self.numbers = watch.numbers();
        }
    }

    /// Looks for the tree if it is not there.
    fn ensure(&mut self) {
        if self.watch.as_ref().is_some_and(Watch::is_gone) {
            self.leave();
        }
        if self.watch.is_some() || Instant::now() < self.looks_at {
            return;
        }
        self.looks_at = Instant::now() + Duration::from_secs(1);
        if !is_tree(&self.root) {
            return;
        }
        let wants = self.wants();
        if let Ok(watch) = Watch::begin_after(self.numbers, &self.root, &self.library, wants) {
            let watch = watch.with_world(self.world.as_deref());
            let watch = watch.with_raw(self.wants_raw());
            self.batch.extend(watch.beginning());
            self.watch = Some(watch);
        }
    }

    fn look(&mut self) {
        if self.kept.is_none() && self.listeners.is_empty() {
            return;
        }
        self.ensure();
        if let Some(watch) = &mut self.watch {
            watch.look(&mut self.batch);
        }
        self.hand_over();
    }

    /// Gives what has come to all.
    fn hand_over(&mut self) {
        let now_ns = now_ns();
        let before = self.listeners.len();
        let batch: Batch = std::mem::take(&mut self.batch).into();
        let is_mixed = batch.iter().any(Entry::is_raw);
        let plain = is_mixed.then(|| batch.iter().filter(|entry| !entry.is_raw()).cloned());
        let plain: Option<Vec<Entry>> = plain.map(Iterator::collect);
        self.listeners.retain_mut(|listener| {
            let has_all = listener.wants_raw();
            let plain = plain.as_deref().filter(|_| !has_all);
            listener.put(plain.unwrap_or(&batch), now_ns)
        });
        if self.listeners.len() < before {
            self.want();
        }
        if batch.is_empty() {
            return;
        }
        if let Some(kept) = &mut self.kept {
            let (watch, program) = (&self.watch, &self.program);
            kept.put(&batch, || {
                let beginning = watch.iter().flat_map(Watch::beginning);
                beginning.chain(program.clone()).collect()
            });
            if self.values.have_gone(&batch) && kept.is_due(SaveReason::Fault) {
                kept.save(SaveReason::Fault, (self.told)());
            }
        }
    }
}

/// Which nodes have a value.
#[derive(Default)]
struct Values(HashSet<u32>);

impl Values {
    /// Whether one that had a value has none any more.
    fn have_gone(&mut self, batch: &[Entry]) -> bool {
        let mut have_gone = false;
        // What a device fails to give is told by its node.
        for entry in batch.iter().filter(|entry| !entry.is_raw()) {
            match entry {
                Entry::Sample(known, ..) => drop(self.0.insert(known.number)),
                // Somebody has put another configuration in force.
                Entry::Fault(known, _, LEFT, _) => drop(self.0.remove(&known.number)),
                Entry::Fault(known, ..) => have_gone |= self.0.remove(&known.number),
                Entry::Node(_) | Entry::Line(..) | Entry::Attachment(..) | Entry::Facts(..) => {}
            }
        }
        have_gone
    }
}

fn is_tree(root: &Path) -> bool {
    root.join("config").exists() && root.join("status").exists()
}

#[cfg(test)]
mod tests;
