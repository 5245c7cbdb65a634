//! A program in JavaScript that somebody debugs: it pauses, goes on, and stops at an error that nobody catches.
//!
//! Owns who stands still, and where each thread was seen last. QuickJS asks now and then whether a program is to end, and
//! there a thread can be held; it tells lines only where a program calls the robot or fails. `motors` brings motors to
//! rest meanwhile.

mod motors;
mod orders;
mod words;

pub use orders::Orders;

use crate::limits;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Condvar, Mutex, MutexGuard, PoisonError};

/// One function that was being executed.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Frame {
    /// Its name; empty for the text of the program itself.
    pub function: String,
    /// The file, as it was named when it was evaluated.
    pub file: String,
    /// Line and column, from 1.
    pub line: u32,
    /// See `line`.
    pub column: u32,
}

/// A thread of a program.
#[derive(Clone, Copy, Debug)]
pub struct Who<'a> {
    /// Its number, which no other thread of the program has.
    pub number: u32,
    /// Its name.
    pub name: &'a str,
}

/// What a thread does.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
enum Does {
    /// It computes, or is in a call of the robot.
    #[default]
    Runs,
    /// It waits for time or events.
    Waits,
    /// It stands still for the debugger.
    Held,
}

impl Does {
    fn word(self) -> &'static str {
        match self {
            Self::Runs => "runs",
            Self::Waits => "waits",
            Self::Held => "held",
        }
    }
}

/// A thread as it was seen last.
#[derive(Clone, Debug, Default, PartialEq)]
struct Seen {
    name: String,
    does: Does,
    /// Its calls, the innermost first; of a thread that runs where it has called the robot last.
    frames: Vec<Frame>,
}

/// Why all stand still.
#[derive(Clone, Debug, PartialEq)]
enum Stop {
    /// Somebody wanted it, or it is the beginning.
    Pause,
    /// An error of this thread.
    Error {
        /// Its number.
        thread: u32,
        /// What was thrown, and from where.
        text: String,
    },
}

#[derive(Debug, Default)]
struct State {
    stop: Option<Stop>,
    stops_at_errors: bool,
    threads: BTreeMap<u32, Seen>,
}

/// What threads and the debugger know of each other.
#[derive(Debug, Default)]
pub struct Debugger {
    is_attached: AtomicBool,
    is_stopped: AtomicBool,
    state: Mutex<State>,
    goes_on: Condvar,
}

impl Debugger {
    fn state(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Whether threads are to tell where they are, which takes time.
    pub fn is_attached(&self) -> bool {
        self.is_attached.load(Ordering::Relaxed)
    }

    /// From the beginning, before its first line.
    pub fn begin(&self) {
        self.attach();
        self.stop(Stop::Pause);
    }

    fn attach(&self) {
        self.is_attached.store(true, Ordering::Relaxed);
    }

    fn stop(&self, why: Stop) {
        self.stop_in(&mut self.state(), why);
    }

    /// The flag and its reason change under one lock, so that they never disagree for long.
    fn stop_in(&self, state: &mut State, why: Stop) {
        match (&state.stop, &why) {
            // An error is the end of the program, and tells more than a pause that comes to the same.
            (None | Some(Stop::Pause), Stop::Error { .. }) | (None, Stop::Pause) => {
                state.stop = Some(why);
            }
            (Some(Stop::Error { .. }), _) | (Some(Stop::Pause), Stop::Pause) => {}
        }
        self.is_stopped.store(true, Ordering::Relaxed);
    }

    fn go_on(&self) {
        self.go_on_in(&mut self.state());
    }

    fn go_on_in(&self, state: &mut State) {
        state.stop = None;
        self.is_stopped.store(false, Ordering::Relaxed);
        self.goes_on.notify_all();
    }

    /// Under one lock: a thread that fails meanwhile is held for a debugger or finds none.
    fn detach(&self) {
        let mut state = self.state();
        self.is_attached.store(false, Ordering::Relaxed);
        state.stops_at_errors = false;
        self.go_on_in(&mut state);
    }

    /// Somebody ends threads: those that are held look whether they are meant.
    pub fn wake(&self) {
        let _state = self.state();
        self.goes_on.notify_all();
    }

    /// A thread has come to a place, which is told only if somebody debugs.
    pub fn stand(&self, who: Who<'_>, frames: Vec<Frame>) {
        self.seen(&mut self.state(), who).frames = frames;
    }

    /// A thread begins to wait, or has ended that.
    pub fn waits(&self, who: Who<'_>, is_waiting: bool) {
        self.seen(&mut self.state(), who).does = match is_waiting {
            true => Does::Waits,
            false => Does::Runs,
        };
    }

    fn seen<'a>(&self, state: &'a mut State, who: Who<'_>) -> &'a mut Seen {
        let seen = state.threads.entry(who.number).or_default();
        if seen.name.is_empty() {
            who.name.clone_into(&mut seen.name);
        }
        seen
    }

    /// A thread begins.
    pub fn enter(&self, who: Who<'_>) {
        self.seen(&mut self.state(), who);
    }

    /// A thread is gone.
    pub fn forget(&self, who: Who<'_>) {
        self.state().threads.remove(&who.number);
    }

    /// Called by a thread where it can be held: stays while the program is stopped and the thread is not to end.
    pub fn pass(&self, who: Who<'_>, ends: impl Fn() -> bool) {
        if !self.is_stopped.load(Ordering::Relaxed) {
            return;
        }
        let mut state = self.state();
        while state.stop.is_some() && !ends() {
            self.seen(&mut state, who).does = Does::Held;
            state = self
                .goes_on
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
        self.seen(&mut state, who).does = Does::Runs;
    }

    /// A thread has failed, and the program will end because of it: it stops before that, if that is wanted. True: it
    /// does, and the thread is to be held.
    pub fn failed(&self, who: Who<'_>, text: &str, frames: &[Frame]) -> bool {
        let mut state = self.state();
        if !self.is_attached() || !state.stops_at_errors {
            return false;
        }
        let most = frames.len().min(limits::JS_FRAMES);
        self.seen(&mut state, who).frames = frames[..most].to_vec();
        let (thread, text) = (who.number, text.to_owned());
        self.stop_in(&mut state, Stop::Error { thread, text });
        true
    }

    /// Whether nothing moves: each thread is held or waits.
    fn is_still(&self) -> bool {
        let state = self.state();
        let mut threads = state.threads.values();
        state.stop.is_some() && threads.all(|seen| seen.does != Does::Runs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::Arc;
    use std::sync::mpsc::channel;

    const MAIN: Who<'_> = Who {
        number: 1,
        name: "main",
    };

    #[test]
    fn a_thread_is_held_until_the_program_goes_on_or_ends() {
        for goes_on in [true, false] {
            let debugger = Arc::new(Debugger::default());
            let ends = Arc::new(AtomicBool::new(false));
            debugger.enter(MAIN);
            debugger.begin();
            assert!(!debugger.is_still());
            let (say, hear) = channel();
            let thread = {
                let (debugger, ends) = (debugger.clone(), ends.clone());
                std::thread::spawn(move || {
                    debugger.pass(MAIN, || ends.load(Ordering::Relaxed));
                    say.send(()).unwrap();
                })
            };
            while !debugger.is_still() {
                std::thread::yield_now();
            }
            assert!(hear.try_recv().is_err(), "it is held");
            if goes_on {
                debugger.go_on();
            } else {
                ends.store(true, Ordering::Relaxed);
                debugger.wake();
            }
            hear.recv().unwrap();
            thread.join().unwrap();
        }
    }

    #[test]
    fn an_error_stops_only_who_wants_that() {
        let debugger = Debugger::default();
        debugger.enter(MAIN);
        assert!(!debugger.failed(MAIN, "e", &[]), "nobody debugs");
        debugger.attach();
        assert!(!debugger.failed(MAIN, "e", &[]), "nobody asked for it");
        debugger.state().stops_at_errors = true;
        assert!(debugger.failed(MAIN, "e", &[]));
        assert!(matches!(
            &debugger.state().stop,
            Some(Stop::Error { thread: 1, text }) if text == "e"
        ));
    }

    #[test]
    fn an_error_says_more_than_a_pause_and_another_error_nothing_new() {
        let debugger = Debugger::default();
        debugger.enter(MAIN);
        debugger.begin();
        debugger.state().stops_at_errors = true;
        for (text, kept) in [("first", "first"), ("second", "first")] {
            assert!(debugger.failed(MAIN, text, &[]));
            debugger.stop(Stop::Pause);
            assert!(matches!(
                &debugger.state().stop,
                Some(Stop::Error { text, .. }) if text == kept
            ));
        }
    }

    #[test]
    fn no_thread_is_held_by_its_error_when_the_debugger_is_gone() {
        for _ in 0..200 {
            let debugger = Debugger::default();
            debugger.enter(MAIN);
            debugger.attach();
            debugger.state().stops_at_errors = true;
            std::thread::scope(|threads| {
                threads.spawn(|| {
                    if debugger.failed(MAIN, "e", &[]) {
                        debugger.pass(MAIN, || false);
                    }
                });
                debugger.detach();
            });
            assert!(debugger.state().stop.is_none());
            assert!(!debugger.is_stopped.load(Ordering::Relaxed));
        }
    }

    #[test]
    fn what_only_waits_stands_still_too() {
        let debugger = Debugger::default();
        debugger.enter(MAIN);
        debugger.begin();
        debugger.waits(MAIN, true);
        assert!(debugger.is_still());
        debugger.waits(MAIN, false);
        assert!(!debugger.is_still());
        debugger.forget(MAIN);
        assert!(debugger.is_still(), "who is gone is not waited for");
    }
}
