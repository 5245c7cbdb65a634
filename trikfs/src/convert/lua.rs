//! Lua states prepared ahead: every open file gets one of its own, and opening should not wait for its making.
//!
//! Owns a small stock of blank states, which suit any configuration, and the thread that fills it, that closes used ones
//! and that gives their memory back. A state that was used is never used again.

use crate::events::lock;
use crate::limits;
use config::error::Error;
use config::program::{Blank, Program, Vm, give_memory_back};
use std::io;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::mpsc::{Receiver, RecvTimeoutError, Sender, channel};
use std::sync::{Arc, Mutex, Weak};
use std::time::Duration;

enum Work {
    Fill,
    Close(Box<Vm>),
}

/// The thread that makes and closes Lua states, and its stock.
#[derive(Clone)]
pub struct StateMaker {
    work: Sender<Work>,
    stock: Arc<Stock>,
}

/// States that are ready to be taken.
struct Stock {
    ready: Mutex<Vec<Blank>>,
    wanted: AtomicUsize,
    is_filling: AtomicBool,
    /// States that wait to be closed.
    used: AtomicUsize,
    /// Pools that take from here; without any there is no stock.
    pools: AtomicUsize,
    /// Programs that have not been settled yet.
    unsettled: Mutex<Vec<Weak<Program>>>,
}

impl StateMaker {
    /// Starts the thread; it ends with the last maker and pool.
    pub fn start() -> io::Result<Self> {
        let (work, todo) = channel();
        let stock = Arc::new(Stock {
            ready: Mutex::default(),
            wanted: AtomicUsize::new(limits::LUA_STATES_FIRST),
            is_filling: AtomicBool::new(false),
            used: AtomicUsize::new(0),
            pools: AtomicUsize::new(0),
            unsettled: Mutex::default(),
        });
        let own = stock.clone();
        std::thread::Builder::new()
            .name("lua-states".to_owned())
            .spawn(move || {
                // A program that opens a file goes first. Every thread may give way; if it fails, nothing is lost.
                let _ = rustix::process::setpriority_process(None, limits::LUA_STATES_NICE);
                own.serve(&todo);
            })?;
        Ok(Self { work, stock })
    }

    /// States for one configuration.
    pub fn pool(&self, program: Arc<Program>) -> Arc<StatePool> {
        self.stock.pools.fetch_add(1, Ordering::Relaxed);
        lock(&self.stock.unsettled).push(Arc::downgrade(&program));
        let pool = Arc::new(StatePool {
            program,
            maker: self.clone(),
        });
        pool.ask_to_fill();
        pool
    }
}

impl Stock {
    /// Does what is asked until nobody can ask any more.
    fn serve(&self, todo: &Receiver<Work>) {
        let quiet = Duration::from_millis(limits::LUA_STATES_QUIET_MS);
        while let Ok(mut first) = todo.recv() {
            loop {
                // A program that opens files in a row should not be interrupted at each of them: the work waits until
                // a stock's worth of it may have come, and is then done in one go.
                std::thread::sleep(Duration::from_millis(limits::LUA_STATES_BATCH_MS));
                for item in std::iter::once(first).chain(todo.try_iter()) {
                    match item {
                        Work::Fill => self.fill(),
                        Work::Close(vm) => {
                            drop(vm);
                            self.used.fetch_sub(1, Ordering::Relaxed);
                        }
                    }
                }
                match todo.recv_timeout(quiet) {
                    Ok(next) => first = next,
                    Err(RecvTimeoutError::Timeout) => break,
                    Err(RecvTimeoutError::Disconnected) => return,
                }
            }
            self.rest();
        }
    }

    fn fill(&self) {
        self.is_filling.store(false, Ordering::Relaxed);
        while self.pools.load(Ordering::Relaxed) > 0
            && lock(&self.ready).len() < self.wanted.load(Ordering::Relaxed)
        {
            // If there is no memory, the next open of a file reports it.
            let Ok(blank) = Blank::new() else { return };
            lock(&self.ready).push(blank);
        }
    }

    /// After a burst of openings and closings: the stock is small again, programs are settled, and memory goes back to the
    /// system.
    fn rest(&self) {
        let unsettled = std::mem::take(&mut *lock(&self.unsettled));
        for program in unsettled.iter().filter_map(Weak::upgrade) {
            program.settle();
        }
        let few = if self.pools.load(Ordering::Relaxed) > 0 {
            limits::LUA_STATES_FIRST
        } else {
            0
        };
        self.wanted
            .store(limits::LUA_STATES_FIRST, Ordering::Relaxed);
        let mut ready = lock(&self.ready);
        let kept = ready.len().min(few);
        let surplus = ready.split_off(kept);
        drop(ready);
        drop(surplus);
        give_memory_back();
    }
}

/// States for the converters of one configuration.
pub struct StatePool {
    program: Arc<Program>,
    maker: StateMaker,
}

impl StatePool {
    /// A state of one's own for the converters of a node; made on the spot if the stock is empty.
    pub fn take(&self, node: &str) -> Result<Vm, Error> {
        let stock = &self.maker.stock;
        let (blank, left) = {
            let mut ready = lock(&stock.ready);
            (ready.pop(), ready.len())
        };
        if blank.is_none() {
            let more = (stock.wanted.load(Ordering::Relaxed) * 2).min(limits::LUA_STATES_READY);
            stock.wanted.store(more, Ordering::Relaxed);
        }
        // Filling in bursts keeps the maker from waking at every open.
        if left * 2 <= stock.wanted.load(Ordering::Relaxed) {
            self.ask_to_fill();
        }
        let blank = blank.map_or_else(Blank::new, Ok)?;
        self.program.prepare(blank, node)
    }

    /// Closes a used state, later and elsewhere; here if many wait already, because each holds its memory.
    pub fn discard(&self, vm: Vm) {
        let used = &self.maker.stock.used;
        if used.fetch_add(1, Ordering::Relaxed) >= limits::LUA_STATES_READY {
            used.fetch_sub(1, Ordering::Relaxed);
            return;
        }
        // Without the thread the state is closed here.
        let _ = self.maker.work.send(Work::Close(Box::new(vm)));
    }

    fn ask_to_fill(&self) {
        if !self.maker.stock.is_filling.swap(true, Ordering::Relaxed) {
            let _ = self.maker.work.send(Work::Fill);
        }
    }
}

impl Drop for StatePool {
    fn drop(&mut self) {
        self.maker.stock.pools.fetch_sub(1, Ordering::Relaxed);
        // The thread lets go of the stock if this was the last.
        let _ = self.maker.work.send(Work::Fill);
    }
}
