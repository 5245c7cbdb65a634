//! A crew: threads that take turns in one role, so that one piece of work that lasts does not stop the others.
//!
//! Exactly one thread plays the role at a time: it waits for work and does it. When its work lasts longer than about
//! a millisecond (some fifteen where nobody waits for it), the watchdog declares it late, a spare thread takes the role
//! over, and the late one finishes its own work and becomes a spare. A second thread in the role all the time would be simpler and costs 12 to 21 % of every
//! request, because the kernel wakes the waiters in turn.
//!
//! A crew of one has nobody to step in: it is not watched, and so costs nothing when it wakes.
//!
//! A thread that knows that its work will last, such as before a transfer on a slow bus, calls [`give_way`] and does not
//! make the others wait for the watchdog.
//!
//! Owns the threads and which of them has the role. Knows nothing of what the role is; `config::watchdog` measures the time.
//!
//! Why no two threads have the role: it is given away only by the compare-and-swap of `Work::relieve`, which succeeds
//! between `begin` and `end` alone, and the thread that lost it learns so at `end`, before it could wait for work again.

use config::watchdog;
pub use config::watchdog::Urgency;
use std::any::Any;
use std::cell::{Cell, RefCell};
use std::io;
use std::ops::ControlFlow;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::atomic::{AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, TryLockError};

/// One cycle of a role: waits for work, does it between [`Seat::begin`] and [`Seat::end`], returns.
/// `Break` ends the crew.
pub type Role = dyn Fn(&Seat) -> ControlFlow<()> + Send + Sync;

/// A [`Role`] with state of its own for each thread; it stays on the thread it was made on.
pub type OwnRole = Box<dyn FnMut(&Seat) -> ControlFlow<()>>;

type MakeRole = Arc<dyn Fn() -> OwnRole + Send + Sync>;

type HandOver = Arc<dyn Fn() + Send + Sync>;

thread_local! {
    /// Hands the role of this thread over, if it has one and works.
    static HAND_OVER: RefCell<Option<HandOver>> = const { RefCell::new(None) };
}

/// Hands this thread's role over now, because what comes next may last: the thread goes on with its own work, as one
/// that the watchdog found late. Does nothing on a thread that has no role, or none any more. Costs the waking of
/// another thread, so it is for waits that are likely, not for those that are possible.
pub fn give_way() {
    let hand_over = HAND_OVER.with_borrow(Clone::clone);
    if let Some(hand_over) = hand_over {
        hand_over();
    }
}

/// Takes a lock whose holder may be inside a slow device: gives way if it is not free.
pub(crate) fn lock_patiently<T: ?Sized>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    match mutex.try_lock() {
        Ok(guard) => guard,
        Err(TryLockError::Poisoned(poisoned)) => poisoned.into_inner(),
        Err(TryLockError::WouldBlock) => {
            give_way();
            mutex.lock().unwrap_or_else(PoisonError::into_inner)
        }
    }
}

/// A thread's place in a crew.
pub struct Seat {
    /// None in a crew of one: nobody could take the role over, so nobody needs to know that it is late.
    watched: Option<watchdog::Seat>,
    work: Arc<Work>,
    /// Between `begin` and `end`.
    working: Cell<bool>,
    /// The role went to another thread during the last work.
    relieved: Cell<bool>,
}

impl Seat {
    /// The wait is over and work begins. Not to be nested.
    pub fn begin(&self) {
        self.working.set(true);
        if !self.relieved.get() {
            self.work.begin();
        }
        if let Some(watched) = &self.watched {
            watched.begin();
        }
    }

    /// The work is done.
    pub fn end(&self) {
        self.working.set(false);
        if let Some(watched) = &self.watched {
            watched.end();
        }
        if self.work.end() {
            self.relieved.set(true);
        }
    }
}

/// What one thread is doing, as its own end of work and the watchdog dispute it.
#[derive(Default)]
struct Work(AtomicU32);

impl Work {
    /// Not working, or working without the role.
    const IDLE: u32 = 0;
    const WORKING: u32 = 1;
    /// Still working, but the role is somebody else's.
    const RELIEVED: u32 = 2;

    fn begin(&self) {
        self.0.store(Self::WORKING, Ordering::Release);
    }

    /// True if the role was lost meanwhile.
    fn end(&self) -> bool {
        self.0.swap(Self::IDLE, Ordering::AcqRel) == Self::RELIEVED
    }

    /// Takes the role from a thread that works. False if it has none or has just finished.
    fn relieve(&self) -> bool {
        self.0
            .compare_exchange(
                Self::WORKING,
                Self::RELIEVED,
                Ordering::AcqRel,
                Ordering::Relaxed,
            )
            .is_ok()
    }
}

/// The threads of one role. A clone is another handle on the same crew.
#[derive(Clone)]
pub struct Crew {
    shared: Arc<Shared>,
}

struct Shared {
    name: String,
    limit: usize,
    urgency: Urgency,
    late: AtomicU32,
    state: Mutex<State>,
    /// The role is vacant, or the crew has ended.
    called: Condvar,
    /// The crew has ended.
    ended: Condvar,
}

#[derive(Default)]
struct State {
    threads: usize,
    /// Threads that wait for the role.
    spares: usize,
    /// Nobody has the role.
    vacant: bool,
    ended: bool,
    panic: Option<Box<dyn Any + Send>>,
}

impl Crew {
    /// Starts a crew of at most `limit` threads (at least one), which carry `name` and play `role` until a cycle
    /// returns `Break`. `urgency` says how soon their work is late. Dropping the crew's handle changes nothing.
    ///
    /// A panic during work has been reported by the panic hook and costs that work; one while waiting ends the crew.
    ///
    /// # Errors
    /// If the first thread cannot be made.
    pub fn run(name: &str, limit: usize, urgency: Urgency, role: Arc<Role>) -> io::Result<Self> {
        Self::run_each(name, limit, urgency, move || {
            let role = Arc::clone(&role);
            Box::new(move |seat| role(seat))
        })
    }

    /// As [`run`](Self::run), with a role for each thread: `make` is called once on each new one.
    ///
    /// # Errors
    /// If the first thread cannot be made.
    pub fn run_each(
        name: &str,
        limit: usize,
        urgency: Urgency,
        make: impl Fn() -> OwnRole + Send + Sync + 'static,
    ) -> io::Result<Self> {
        let shared = Arc::new(Shared {
            name: name.into(),
            limit: limit.max(1),
            urgency,
            late: AtomicU32::new(0),
            state: Mutex::new(State {
                threads: 1,
                vacant: true,
                ..State::default()
            }),
            called: Condvar::new(),
            ended: Condvar::new(),
        });
        shared.spawn(Arc::new(make))?;
        Ok(Self { shared })
    }

    /// Waits until the crew has ended. Late threads are not waited for: they end when their work does.
    /// A panic that ended the crew goes on here, once.
    pub fn wait(&self) {
        let mut state = self.shared.lock();
        while !state.ended {
            state = self
                .shared
                .ended
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
        let panic = state.panic.take();
        drop(state);
        if let Some(panic) = panic {
            resume_unwind(panic);
        }
    }

    /// How often a thread was relieved of the role because its work lasted too long. Wraps.
    pub fn late_count(&self) -> u32 {
        self.shared.late.load(Ordering::Relaxed)
    }

    /// Threads alive now, late ones and spares included.
    pub fn threads(&self) -> usize {
        self.shared.lock().threads
    }
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Starts a thread that is already counted.
    fn spawn(self: &Arc<Self>, make: MakeRole) -> io::Result<()> {
        let shared = Arc::clone(self);
        std::thread::Builder::new()
            .name(self.name.clone())
            .spawn(move || {
                let panic = catch_unwind(AssertUnwindSafe(|| shared.play(&make))).err();
                let mut state = shared.lock();
                state.threads -= 1;
                if panic.is_some() {
                    state.panic = panic;
                    shared.end(&mut state);
                }
            })
            .map(drop)
            .inspect_err(|_| self.lock().threads -= 1)
    }

    /// The life of one thread.
    fn play(self: &Arc<Self>, make: &MakeRole) {
        let work = Arc::new(Work::default());
        let watched = (self.limit > 1).then(|| self.watch(&work, make));
        let seat = Seat {
            watched,
            work,
            working: Cell::new(false),
            relieved: Cell::new(false),
        };
        let mut role = make();
        while self.await_vacancy() {
            while !seat.relieved.take() {
                if cycle(&mut role, &seat).is_break() {
                    self.end(&mut self.lock());
                    return;
                }
            }
        }
    }

    /// Makes this thread one that the watchdog and [`give_way`] can relieve.
    fn watch(self: &Arc<Self>, work: &Arc<Work>, make: &MakeRole) -> watchdog::Seat {
        let (shared, work, make) = (Arc::clone(self), Arc::clone(work), Arc::clone(make));
        let relieve = move |late: u32| {
            if work.relieve() {
                shared.late.fetch_add(late, Ordering::Relaxed);
                shared.hand_over(&make);
            }
        };
        let on_late = relieve.clone();
        HAND_OVER.set(Some(Arc::new(move || relieve(0))));
        watchdog::Seat::take(self.urgency, Arc::new(move || on_late(1)))
    }

    /// Waits until the role is vacant and takes it. False when the crew has ended.
    fn await_vacancy(&self) -> bool {
        let mut state = self.lock();
        state.spares += 1;
        while !state.vacant && !state.ended {
            state = self
                .called
                .wait(state)
                .unwrap_or_else(PoisonError::into_inner);
        }
        state.spares -= 1;
        state.vacant = false;
        !state.ended
    }

    /// On the watchdog's thread, or on the one that gives way: the role is vacant, and a spare or a new thread is called
    /// to it. At the limit, or when no thread can be made, the first of the others to finish takes it.
    fn hand_over(self: &Arc<Self>, make: &MakeRole) {
        let mut state = self.lock();
        state.vacant = true;
        if state.spares > 0 {
            self.called.notify_one();
        } else if state.threads < self.limit && !state.ended {
            state.threads += 1;
            drop(state);
            let _ = self.spawn(Arc::clone(make));
        }
    }

    fn end(&self, state: &mut State) {
        state.ended = true;
        self.called.notify_all();
        self.ended.notify_all();
    }
}

/// One cycle, with a panic during work kept to that work.
fn cycle(role: &mut OwnRole, seat: &Seat) -> ControlFlow<()> {
    match catch_unwind(AssertUnwindSafe(|| role(seat))) {
        Ok(flow) => flow,
        Err(_) if seat.working.get() => {
            seat.end();
            ControlFlow::Continue(())
        }
        Err(panic) => resume_unwind(panic),
    }
}

#[cfg(test)]
mod tests;
