//! Lua states prepared ahead: every open file gets one of its own, and opening should not wait for its making.
//!
//! Owns a small stock of states in which a configuration has already run, and the thread that fills it and that
//! closes used ones. A state that was used is never used again.

use crate::events::lock;
use crate::limits;
use config::error::Error;
use config::program::{Program, Vm};
use std::io;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex};
use std::time::Duration;

enum Work {
    Fill(Arc<StatePool>),
    Close(Box<Vm>),
}

/// The thread that makes and closes Lua states.
#[derive(Clone)]
pub struct StateMaker {
    work: Sender<Work>,
    /// States that wait to be closed.
    used: Arc<AtomicUsize>,
}

impl StateMaker {
    /// Starts the thread; it ends with the last maker and pool.
    pub fn start() -> io::Result<Self> {
        let (work, todo) = channel();
        let used = Arc::new(AtomicUsize::new(0));
        let waiting = used.clone();
        std::thread::Builder::new()
            .name("lua-states".to_owned())
            .spawn(move || {
                while let Ok(first) = todo.recv() {
                    // A program that opens files in a row should not be interrupted at each of them: the work waits until
                    // a stock's worth of it may have come, and is then done in one go.
                    std::thread::sleep(Duration::from_millis(limits::LUA_STATES_BATCH_MS));
                    for item in std::iter::once(first).chain(todo.try_iter()) {
                        match item {
                            Work::Fill(pool) => pool.fill(),
                            Work::Close(vm) => {
                                drop(vm);
                                waiting.fetch_sub(1, Ordering::Relaxed);
                            }
                        }
                    }
                }
            })?;
        Ok(Self { work, used })
    }

    /// A stock of states for one configuration.
    pub fn pool(&self, program: Arc<Program>) -> Arc<StatePool> {
        let pool = Arc::new(StatePool {
            program,
            maker: self.clone(),
            ready: Mutex::default(),
            wanted: AtomicUsize::new(limits::LUA_STATES_FIRST),
            filling: AtomicBool::new(false),
            retired: AtomicBool::new(false),
        });
        pool.ask_to_fill();
        pool
    }
}

/// States in which one configuration has run, ready to be taken.
pub struct StatePool {
    program: Arc<Program>,
    maker: StateMaker,
    ready: Mutex<Vec<Vm>>,
    wanted: AtomicUsize,
    filling: AtomicBool,
    retired: AtomicBool,
}

impl StatePool {
    /// A state of one's own; made on the spot if the stock is empty.
    pub fn take(self: &Arc<Self>) -> Result<Vm, Error> {
        let (vm, left) = {
            let mut ready = lock(&self.ready);
            (ready.pop(), ready.len())
        };
        if vm.is_none() {
            let more = (self.wanted.load(Ordering::Relaxed) * 2).min(limits::LUA_STATES_READY);
            self.wanted.store(more, Ordering::Relaxed);
        }
        // Filling in bursts keeps the maker from waking at every open.
        if left * 2 <= self.wanted.load(Ordering::Relaxed) {
            self.ask_to_fill();
        }
        vm.map_or_else(|| self.program.prepare(), Ok)
    }

    /// Closes a used state, later and elsewhere; here if many wait already, because each holds its memory.
    pub fn discard(&self, vm: Vm) {
        let used = &self.maker.used;
        if used.fetch_add(1, Ordering::Relaxed) >= limits::LUA_STATES_READY {
            used.fetch_sub(1, Ordering::Relaxed);
            return;
        }
        // Without the thread the state is closed here.
        let _ = self.maker.work.send(Work::Close(Box::new(vm)));
    }

    /// No more states are kept ready: the configuration is no longer in force.
    pub fn retire(&self) {
        self.retired.store(true, Ordering::Relaxed);
        lock(&self.ready).clear();
    }

    fn ask_to_fill(self: &Arc<Self>) {
        if !self.retired.load(Ordering::Relaxed) && !self.filling.swap(true, Ordering::Relaxed) {
            let _ = self.maker.work.send(Work::Fill(self.clone()));
        }
    }

    fn fill(&self) {
        self.filling.store(false, Ordering::Relaxed);
        loop {
            let ready = lock(&self.ready).len();
            if ready >= self.wanted.load(Ordering::Relaxed) || self.retired.load(Ordering::Relaxed)
            {
                return;
            }
            // If the program no longer runs, the next open of a file reports it.
            let Ok(vm) = self.program.prepare() else {
                return;
            };
            // A program that holds much is not held many times for nobody.
            if (ready + 1) * vm.memory() > limits::LUA_STATES_BYTES {
                self.wanted.store(ready.max(1), Ordering::Relaxed);
                if ready > 0 {
                    return;
                }
            }
            lock(&self.ready).push(vm);
        }
    }
}
