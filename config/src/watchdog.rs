//! The clock over work that must not last: late requests, and Lua calls that have spent their budget.
//!
//! Owns one thread of the process and one real-time signal. Both are process-wide because signal handlers are:
//! this is the one singleton of the crate. The thread ticks every millisecond while somebody works who is waited for,
//! dozes while there is nothing but work in the background, and sleeps otherwise; so marking work costs two atomic
//! stores, and a system call only after a few milliseconds without any. A doze that finds work still going on makes it
//! tick. Knows nothing of requests and nothing of what a Lua call computes.
//!
//! How a Lua call is ended. LuaJIT documents that `lua_sethook` may be called from a signal handler of the thread that
//! runs the state. The watchdog sends the signal to that thread; the handler compares the sequence number of the
//! running call with the one that the watchdog saw and only then arms a hook on every instruction, which raises an
//! error. The hook stays armed until the outermost call has returned, so a loop around `pcall` cannot swallow it.
//! The signal is repeated each tick, because it may have arrived while LuaJIT was rewriting its own dispatch table.
//! Hooks do not run inside the message handler of `xpcall` for an error that a hook raised: a caller must not
//! give Lua code the real `xpcall`.
//! Compiled loops look at the hook only if LuaJIT was built with LUAJIT_ENABLE_CHECKHOOK; a test of this file checks it.

mod level;

pub use level::Urgency;
use level::{ASLEEP, DOZING, Found, TICKING};
use mlua_sys as lua;
use nix::time::{ClockId, clock_gettime};
use std::cell::Cell;
use std::ffi::c_int;
use std::marker::PhantomData;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::ptr;
use std::sync::atomic::{
    AtomicBool, AtomicI32, AtomicPtr, AtomicU8, AtomicU32, Ordering, compiler_fence,
};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, OnceLock, PoisonError};
use std::time::{Duration, Instant};

/// Time between two looks, and the time after which a piece of work is late.
const TICK: Duration = Duration::from_millis(1);
/// Ticks without any work before the thread goes to sleep. Few: being woken costs about as much as two ticks, and what
/// is done a hundred times per second should not keep it awake.
const IDLE_TICKS: u32 = 2;
/// Time between two looks while there is only work in the background: what is sampled all the time must not cost a
/// wake-up per millisecond. No period that is usual for sampling, or looks would fall into the midst of it again and again.
const DOZE: Duration = Duration::from_millis(13);
/// Added to SIGRTMIN: far from the first ones, which libraries like to take.
const SIGNAL_OFFSET: c_int = 7;
/// Functions that are asked for a line.
const PLACE_LEVELS: c_int = 8;
/// CPUCLOCK_PERTHREAD | CPUCLOCK_SCHED of the kernel's posix-timers.h: the clock of one thread's processor time.
const THREAD_CLOCK: i32 = 4 | 2;

/// A thread's place under the watchdog, for work of the thread itself.
///
/// Belongs to the thread that took it; dropping it ends the watch.
pub struct Seat {
    watched: Arc<SeatWork>,
    depth: Cell<u32>,
    /// Raw pointers are neither Send nor Sync.
    of_this_thread: PhantomData<*const ()>,
}

/// Called for late work.
type OnLate = Arc<dyn Fn() + Send + Sync>;

impl Seat {
    /// Puts the calling thread under watch. `on_late` is called from the watchdog's thread, once for each piece of
    /// work that is late; it must be short and may start threads.
    /// A call that has begun may still run while the seat is dropped.
    pub fn take(urgency: Urgency, on_late: OnLate) -> Self {
        let watched = Arc::new(SeatWork {
            work: Work::default(),
            urgency,
            on_late,
        });
        Dog::get()
            .lock()
            .seats
            .push(Watched::new(Arc::clone(&watched)));
        Self {
            watched,
            depth: Cell::new(0),
            of_this_thread: PhantomData,
        }
    }

    /// Work begins. Inside other work of this seat it changes nothing but wants its own `end`.
    pub fn begin(&self) {
        let depth = self.depth.get();
        self.depth.set(depth.saturating_add(1));
        if depth == 0 {
            self.watched.work.begin(self.watched.urgency);
        }
    }

    /// The work that the last `begin` announced is over.
    pub fn end(&self) {
        match self.depth.get() {
            0 => {}
            1 => {
                self.depth.set(0);
                self.watched.work.end();
            }
            depth => self.depth.set(depth - 1),
        }
    }
}

impl Drop for Seat {
    fn drop(&mut self) {
        let mut rounds = Dog::get().lock();
        rounds
            .seats
            .retain(|w| !Arc::ptr_eq(&w.what, &self.watched));
    }
}

/// Runs `call`, which runs Lua on this thread in a protected call, and makes the Lua code fail with
/// `time budget spent (N us)` when it has used `budget_us` of processor time: to within about two milliseconds on a
/// thread with an awaited seat, and about fifteen elsewhere.
///
/// Processor time and not the clock on the wall: a converter is not to blame for being preempted.
/// Calls may be nested on different states; the outer one's time starts again when the inner one returns.
///
/// # Safety
/// `state` must be a live Lua state that only this thread uses during the call, and `call` must not let a Lua
/// error leave it.
pub(crate) unsafe fn lua_budget<R>(
    state: *mut lua::lua_State,
    budget_us: u32,
    call: impl FnOnce() -> R,
) -> R {
    let Some(slot) = CURRENT.get().or_else(register_this_thread) else {
        return call();
    };
    let _bracket = Bracket::open(slot, state, budget_us);
    call()
}

/// One line of work: odd while some is going on, and each piece has its own number.
#[derive(Default)]
struct Work(AtomicU32);

impl Work {
    /// From even to odd. Only the owning thread calls this and `end`.
    fn begin(&self, urgency: Urgency) {
        let number = self.0.load(Ordering::Relaxed);
        // Sequentially consistent, as is the watchdog's `level = less; read work`: one of the two sees the other.
        self.0.store(number.wrapping_add(1), Ordering::SeqCst);
        let dog = Dog::get();
        if dog.level.load(Ordering::SeqCst) < urgency.level() {
            dog.wake(urgency.level());
        }
    }

    /// From odd to even.
    fn end(&self) {
        let number = self.0.load(Ordering::Relaxed);
        self.0.store(number.wrapping_add(1), Ordering::Release);
    }

    fn number(&self) -> u32 {
        self.0.load(Ordering::SeqCst)
    }
}

/// Work of a thread itself.
struct SeatWork {
    work: Work,
    urgency: Urgency,
    on_late: OnLate,
}

/// Lua calls of one thread. Written by that thread, read by the watchdog and by the signal handler.
///
/// Never freed but given to the next thread, so the handler cannot meet one that is gone.
struct CallWork {
    work: Work,
    thread: AtomicI32,
    state: AtomicPtr<lua::lua_State>,
    budget_us: AtomicU32,
    /// Number of the call that the watchdog wants to see ended.
    condemned: AtomicU32,
    /// The hook is armed on `state`.
    armed: AtomicBool,
}

thread_local! {
    /// Constant initialiser and no destructor: the signal handler may read it.
    static CURRENT: Cell<Option<&'static CallWork>> = const { Cell::new(None) };
    /// Gives the place back at the end of the thread.
    static REGISTRATION: Cell<Option<Registration>> = const { Cell::new(None) };
}

struct Registration(&'static CallWork);

impl Drop for Registration {
    fn drop(&mut self) {
        CURRENT.set(None);
        let mut rounds = Dog::get().lock();
        rounds.calls.retain(|w| !ptr::eq(w.what, self.0));
        rounds.free.push(self.0);
    }
}

/// First Lua call of a thread. None while the thread is ending.
#[cold]
fn register_this_thread() -> Option<&'static CallWork> {
    let dog = Dog::get();
    let mut rounds = dog.lock();
    let slot: &'static CallWork = rounds.free.pop().unwrap_or_else(|| {
        Box::leak(Box::new(CallWork {
            work: Work::default(),
            thread: AtomicI32::new(0),
            state: AtomicPtr::new(ptr::null_mut()),
            budget_us: AtomicU32::new(0),
            condemned: AtomicU32::new(0),
            armed: AtomicBool::new(false),
        }))
    });
    slot.thread
        .store(nix::unistd::gettid().as_raw(), Ordering::Relaxed);
    rounds.calls.push(Watched::new(slot));
    drop(rounds);
    CURRENT.set(Some(slot));
    // If the thread is ending, the registration is dropped here and takes everything back.
    REGISTRATION
        .try_with(|r| r.set(Some(Registration(slot))))
        .ok()?;
    unblock_signal();
    Some(slot)
}

/// Marks a Lua call from construction to drop, and takes the hook off again.
struct Bracket {
    slot: &'static CallWork,
    /// The call that this one is nested in: state, budget, hook armed.
    outer: Option<(*mut lua::lua_State, u32, bool)>,
}

impl Bracket {
    fn open(slot: &'static CallWork, state: *mut lua::lua_State, budget_us: u32) -> Self {
        let outer = (slot.work.0.load(Ordering::Relaxed) & 1 == 1).then(|| {
            slot.work.end();
            let armed = slot.armed.swap(false, Ordering::Relaxed);
            let state = slot.state.load(Ordering::Relaxed);
            (state, slot.budget_us.load(Ordering::Relaxed), armed)
        });
        slot.state.store(state, Ordering::Relaxed);
        slot.budget_us.store(budget_us, Ordering::Relaxed);
        compiler_fence(Ordering::SeqCst);
        slot.work.begin(Urgency::Background);
        Self { slot, outer }
    }
}

impl Drop for Bracket {
    fn drop(&mut self) {
        let slot = self.slot;
        slot.work.end();
        // From here on the handler finds another number, so `armed` and the hook change no more.
        compiler_fence(Ordering::SeqCst);
        if slot.armed.load(Ordering::Relaxed) {
            slot.armed.store(false, Ordering::Relaxed);
            let state = slot.state.load(Ordering::Relaxed);
            // SAFETY: the caller of `lua_budget` vouches for the state until its call returns, which is after this.
            unsafe { lua::lua_sethook(state, None, 0, 0) };
        }
        if let Some((state, budget_us, armed)) = self.outer {
            slot.state.store(state, Ordering::Relaxed);
            slot.budget_us.store(budget_us, Ordering::Relaxed);
            slot.armed.store(armed, Ordering::Relaxed);
            compiler_fence(Ordering::SeqCst);
            slot.work.begin(Urgency::Background);
        }
    }
}

/// The signal handler: arms the hook if the call that the watchdog condemned is still the one that runs.
/// Touches only atomics, a constant thread-local and `lua_sethook`, so it is safe in a signal handler.
extern "C" fn on_signal(_signal: c_int) {
    let Some(slot) = CURRENT.get() else { return };
    let number = slot.work.0.load(Ordering::Relaxed);
    if number & 1 == 0 || number != slot.condemned.load(Ordering::Acquire) {
        return;
    }
    let state = slot.state.load(Ordering::Relaxed);
    slot.armed.store(true, Ordering::Relaxed);
    // SAFETY: `Bracket::open` stored the state before it made the number odd, on this very thread, and the caller of
    // `lua_budget` keeps it alive until the number is even again. LuaJIT documents this call as safe from a signal.
    // Off first: `lua_sethook` rewrites the dispatch table only when the mode changes.
    unsafe {
        lua::lua_sethook(state, None, 0, 0);
        lua::lua_sethook(state, Some(on_instruction), lua::LUA_MASKCOUNT, 1);
    }
}

/// The hook: raises the error at every instruction until the hook is taken off.
unsafe extern "C-unwind" fn on_instruction(
    state: *mut lua::lua_State,
    _activation: *mut lua::lua_Debug,
) {
    let budget_us = CURRENT
        .get()
        .map_or(0, |slot| slot.budget_us.load(Ordering::Relaxed));
    // SAFETY: LuaJIT calls hooks with a live state and room on its stack; no value with a destructor is alive here
    // when the error leaves the function.
    unsafe {
        push_place(state);
        lua::lua_pushfstring(
            state,
            c"time budget spent (%d us)".as_ptr(),
            budget_us as c_int,
        );
        lua::lua_concat(state, 2);
        lua::lua_error(state);
    }
}

/// Pushes `FILE:LINE: ` of the innermost function that has lines; the sandbox's own functions have none.
///
/// # Safety
/// In a function that Lua called.
unsafe fn push_place(state: *mut lua::lua_State) {
    // SAFETY: zero is a valid value of every field of the record; its text is a zero-terminated array in it.
    unsafe {
        let mut info: lua::lua_Debug = std::mem::zeroed();
        for level in 0..PLACE_LEVELS {
            if lua::lua_getstack(state, level, &raw mut info) == 0 {
                break;
            }
            lua::lua_getinfo(state, c"Sl".as_ptr(), &raw mut info);
            if info.currentline > 0 {
                let file = info.short_src.as_ptr();
                lua::lua_pushfstring(state, c"%s:%d: ".as_ptr(), file, info.currentline as c_int);
                return;
            }
        }
        lua::lua_pushfstring(state, c"".as_ptr());
    }
}

fn signal_number() -> c_int {
    libc::SIGRTMIN() + SIGNAL_OFFSET
}

/// Installs the handler for the process. Interrupted system calls are restarted.
fn install_handler() {
    // SAFETY: the structure is plain data for which zero is a valid value of every field; the handler has the type that
    // sigaction wants without SA_SIGINFO.
    unsafe {
        let mut action: libc::sigaction = std::mem::zeroed();
        action.sa_sigaction = on_signal as extern "C" fn(c_int) as usize;
        action.sa_flags = libc::SA_RESTART | libc::SA_ONSTACK;
        libc::sigemptyset(&raw mut action.sa_mask);
        libc::sigaction(signal_number(), &raw const action, ptr::null_mut());
    }
}

/// Lets the signal through to this thread, whatever mask it inherited.
fn unblock_signal() {
    // SAFETY: plain data, initialised by sigemptyset before use.
    unsafe {
        let mut set: libc::sigset_t = std::mem::zeroed();
        libc::sigemptyset(&raw mut set);
        libc::sigaddset(&raw mut set, signal_number());
        libc::pthread_sigmask(libc::SIG_UNBLOCK, &raw const set, ptr::null_mut());
    }
}

/// Something that is watched, with what the watchdog saw of it last.
struct Watched<T> {
    what: T,
    /// Number of the work when it was last looked at.
    seen: u32,
    /// When that number was seen first.
    since: Instant,
    /// Processor time of the thread at that moment.
    since_cpu: Duration,
    /// Told already.
    told: bool,
}

impl<T> Watched<T> {
    fn new(what: T) -> Self {
        Self {
            what,
            seen: 0,
            since: Instant::now(),
            since_cpu: Duration::ZERO,
            told: false,
        }
    }

    /// Remembers a number. True if it is new.
    fn remember(&mut self, number: u32, now: Instant) -> bool {
        let new = number != self.seen;
        if new {
            self.seen = number;
            self.since = now;
            self.told = false;
        }
        new
    }
}

/// What the watchdog looks at in each round.
#[derive(Default)]
struct Rounds {
    seats: Vec<Watched<Arc<SeatWork>>>,
    calls: Vec<Watched<&'static CallWork>>,
    /// Places of threads that have ended.
    free: Vec<&'static CallWork>,
    /// The thread exists.
    started: bool,
}

impl Rounds {
    /// One look at everything. Collects what is to be called after the lock is released.
    fn look(&mut self, now: Instant, late: &mut Vec<OnLate>) -> Found {
        let mut found = Found::default();
        for seat in &mut self.seats {
            let number = seat.what.work.number();
            let is_new = seat.remember(number, now);
            found.add(is_new, number, seat.what.urgency);
            if number & 1 == 1 && !seat.told && now - seat.since >= TICK {
                seat.told = true;
                late.push(Arc::clone(&seat.what.on_late));
            }
        }
        for call in &mut self.calls {
            let number = call.what.work.number();
            let new = call.remember(number, now);
            found.add(new, number, Urgency::Background);
            if number & 1 == 0 {
                continue;
            }
            let thread = call.what.thread.load(Ordering::Relaxed);
            if new {
                call.since_cpu = thread_time(thread);
                continue;
            }
            let budget = Duration::from_micros(call.what.budget_us.load(Ordering::Relaxed).into());
            if now - call.since >= budget
                && thread_time(thread).saturating_sub(call.since_cpu) >= budget
            {
                call.what.condemned.store(number, Ordering::Release);
                send_signal(thread);
            }
        }
        found
    }
}

/// Processor time of a thread of this process; zero if the kernel does not say.
fn thread_time(thread: i32) -> Duration {
    let clock = ClockId::from_raw((!thread << 3) | THREAD_CLOCK);
    clock_gettime(clock).map_or(Duration::ZERO, Duration::from)
}

/// The thread is registered, hence alive: `Registration::drop` takes the lock under which this runs.
fn send_signal(thread: i32) {
    // SAFETY: tgkill takes no pointers; at worst it reports that there is no such thread.
    unsafe { libc::syscall(libc::SYS_tgkill, libc::getpid(), thread, signal_number()) };
}

/// The watchdog of the process.
struct Dog {
    /// How awake the thread is. Only `wake` raises it but for the thread itself, with `rounds` locked.
    level: AtomicU8,
    rounds: Mutex<Rounds>,
    woken: Condvar,
}

impl Dog {
    fn get() -> &'static Self {
        static DOG: OnceLock<Dog> = OnceLock::new();
        DOG.get_or_init(|| {
            install_handler();
            Self {
                level: AtomicU8::new(ASLEEP),
                rounds: Mutex::default(),
                woken: Condvar::new(),
            }
        })
    }

    fn lock(&self) -> MutexGuard<'_, Rounds> {
        self.rounds.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Makes the thread at least so awake. If no thread can be made, the next call tries again: without one nothing is
    /// late.
    #[cold]
    fn wake(&'static self, level: u8) {
        let mut rounds = self.lock();
        if !rounds.started {
            let thread = std::thread::Builder::new().name("watchdog".into());
            rounds.started = thread.spawn(move || self.run()).is_ok();
        }
        if rounds.started && self.level.load(Ordering::SeqCst) < level {
            self.level.store(level, Ordering::SeqCst);
            self.woken.notify_one();
        }
    }

    fn run(&self) {
        let mut late = Vec::new();
        let mut calm = 0;
        loop {
            let mut rounds = self.lock();
            self.look(&mut rounds, &mut calm, &mut late);
            if self.level.load(Ordering::SeqCst) == TICKING {
                drop(rounds);
                for on_late in late.drain(..) {
                    // A panic of the callee has been reported by the panic hook and must not end the watch.
                    let _ = catch_unwind(AssertUnwindSafe(|| on_late()));
                }
                std::thread::sleep(TICK);
            } else {
                self.rest(rounds);
            }
        }
    }

    /// Looks, and is more or less awake from then on. `calm` counts looks in a row that found less than the level is for.
    fn look(&self, rounds: &mut Rounds, calm: &mut u32, late: &mut Vec<OnLate>) {
        let level = self.level.load(Ordering::SeqCst);
        let wanted = rounds.look(Instant::now(), late).level();
        *calm = if wanted < level { *calm + 1 } else { 0 };
        let patience = if level == TICKING { IDLE_TICKS } else { 1 };
        if wanted > level {
            self.level.store(wanted, Ordering::SeqCst);
        } else if *calm >= patience {
            self.level.store(wanted, Ordering::SeqCst);
            // Work that has begun in between has seen the level before, and has woken nobody.
            let again = rounds.look(Instant::now(), late).level();
            self.level.store(wanted.max(again), Ordering::SeqCst);
            *calm = 0;
        }
    }

    /// Sleeps as deeply as the level says. Nobody is late then, or the level would be another one.
    fn rest(&self, rounds: MutexGuard<'_, Rounds>) {
        let is = |level| move |_: &mut Rounds| self.level.load(Ordering::SeqCst) == level;
        let rounds = self
            .woken
            .wait_while(rounds, is(ASLEEP))
            .unwrap_or_else(PoisonError::into_inner);
        // Work that has just woken the thread is not looked at before it could be late.
        let dozed = self.woken.wait_timeout_while(rounds, DOZE, is(DOZING));
        drop(dozed);
    }
}

#[cfg(test)]
mod tests;
