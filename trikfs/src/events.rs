//! What wakes the filesystem besides the kernel: descriptors that become readable, and the clock.
//!
//! Owns one epoll instance and one queue of due times, each served by a crew of threads of which one works and
//! others step in when it is late. Knows nothing of what is woken but its trait.

use crate::crew::{Crew, Seat, Urgency};
use crate::limits;
use nix::sys::epoll::{Epoll, EpollCreateFlags, EpollEvent, EpollFlags, EpollTimeout};
use std::cmp::Reverse;
use std::collections::{BinaryHeap, HashMap};
use std::io;
use std::ops::ControlFlow;
use std::os::fd::BorrowedFd;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError, Weak};
use std::time::{Duration, Instant};

/// Something that waits for data. Called from an event thread, perhaps without need, never with a lock held.
pub trait Ready: Send + Sync {
    /// Data may have arrived.
    fn ready(&self);
}

/// Something that acts at a time.
pub trait Due: Send + Sync {
    /// Acts, and says when to be called again.
    fn due(&self) -> Option<Instant>;
}

/// Descriptors that wake somebody.
pub struct Poller {
    epoll: Epoll,
    waiting: Mutex<Waiting>,
    stopping: AtomicBool,
}

#[derive(Default)]
struct Waiting {
    next_key: u64,
    by_key: HashMap<u64, Weak<dyn Ready>>,
}

/// Keeps a descriptor watched; the descriptor itself must be closed with or after it.
pub struct Watch {
    poller: Arc<Poller>,
    key: u64,
}

impl Drop for Watch {
    fn drop(&mut self) {
        lock(&self.poller.waiting).by_key.remove(&self.key);
    }
}

impl Poller {
    /// Starts the thread that waits.
    pub fn start() -> io::Result<Arc<Self>> {
        let epoll = Epoll::new(EpollCreateFlags::EPOLL_CLOEXEC)?;
        let poller = Arc::new(Self {
            epoll,
            waiting: Mutex::default(),
            stopping: AtomicBool::new(false),
        });
        let weak = Arc::downgrade(&poller);
        Crew::run(
            "events",
            limits::MAX_THREADS,
            Urgency::Background,
            Arc::new(move |seat: &Seat| Self::cycle(&weak, seat)),
        )?;
        Ok(poller)
    }

    /// Calls `ready` each time the descriptor becomes readable (edge-triggered). A descriptor that is always
    /// ready and cannot be watched (EPERM: `/dev/zero`, regular files) gives no watch.
    pub fn watch(
        self: &Arc<Self>,
        fd: BorrowedFd<'_>,
        ready: Weak<dyn Ready>,
    ) -> io::Result<Option<Watch>> {
        let key = {
            let mut waiting = lock(&self.waiting);
            waiting.next_key += 1;
            let key = waiting.next_key;
            waiting.by_key.insert(key, ready);
            key
        };
        let watch = Watch {
            poller: self.clone(),
            key,
        };
        let flags = EpollFlags::EPOLLIN
            | EpollFlags::EPOLLPRI
            | EpollFlags::EPOLLRDHUP
            | EpollFlags::EPOLLET;
        match self.epoll.add(fd, EpollEvent::new(flags, key)) {
            Ok(()) => Ok(Some(watch)),
            Err(nix::Error::EPERM) => Ok(None),
            Err(errno) => Err(errno.into()),
        }
    }

    /// Ends the threads at their next wake-up.
    pub fn stop(&self) {
        self.stopping.store(true, Ordering::Relaxed);
    }

    fn cycle(weak: &Weak<Self>, seat: &Seat) -> ControlFlow<()> {
        let Some(poller) = weak.upgrade() else {
            return ControlFlow::Break(());
        };
        let mut events = [EpollEvent::empty(); 1];
        // One event at a time: if its handling is late, the next one is another thread's.
        let count = poller
            .epoll
            .wait(&mut events, EpollTimeout::NONE)
            .unwrap_or(0);
        if poller.stopping.load(Ordering::Relaxed) {
            return ControlFlow::Break(());
        }
        if count > 0 {
            let target = lock(&poller.waiting)
                .by_key
                .get(&events[0].data())
                .and_then(Weak::upgrade);
            if let Some(target) = target {
                seat.begin();
                target.ready();
                seat.end();
            }
        }
        ControlFlow::Continue(())
    }
}

/// How long a thread waits if nothing is due.
const NEVER: Duration = Duration::from_secs(86_400);

/// Times at which somebody acts.
pub struct Schedule {
    origin: Instant,
    queue: Mutex<Queue>,
    changed: Condvar,
}

#[derive(Default)]
struct Queue {
    entries: BinaryHeap<Reverse<Entry>>,
    next_number: u64,
    /// A thread waits for the first entry; one that works looks by itself afterwards.
    is_awaited: bool,
    stopping: bool,
}

struct Entry {
    at: Instant,
    number: u64,
    target: Weak<dyn Due>,
}

impl PartialEq for Entry {
    fn eq(&self, other: &Self) -> bool {
        self.number == other.number
    }
}
impl Eq for Entry {}
impl PartialOrd for Entry {
    fn partial_cmp(&self, other: &Self) -> Option<std::cmp::Ordering> {
        Some(self.cmp(other))
    }
}
impl Ord for Entry {
    fn cmp(&self, other: &Self) -> std::cmp::Ordering {
        (self.at, self.number).cmp(&(other.at, other.number))
    }
}

impl Schedule {
    /// Starts the thread that watches the clock, with others that step in when it is late.
    pub fn start() -> io::Result<Arc<Self>> {
        Self::start_crew("schedule", limits::MAX_THREADS)
    }

    /// Starts one with threads of this name, at most so many.
    pub fn start_crew(name: &str, threads: usize) -> io::Result<Arc<Self>> {
        let schedule = Arc::new(Self {
            origin: Instant::now(),
            queue: Mutex::default(),
            changed: Condvar::new(),
        });
        let cycling = schedule.clone();
        Crew::run(
            name,
            threads,
            Urgency::Background,
            Arc::new(move |seat: &Seat| cycling.cycle(seat)),
        )?;
        Ok(schedule)
    }

    /// The moment from which periods count.
    pub fn origin(&self) -> Instant {
        self.origin
    }

    /// Calls `target` at (not before) a time; not at all if it is gone by then.
    pub fn at(&self, at: Instant, target: Weak<dyn Due>) {
        let mut queue = lock(&self.queue);
        queue.next_number += 1;
        let number = queue.next_number;
        let is_first = queue
            .entries
            .peek()
            .is_none_or(|Reverse(first)| at < first.at);
        queue.entries.push(Reverse(Entry { at, number, target }));
        let must_wake = is_first && queue.is_awaited;
        drop(queue);
        if must_wake {
            self.changed.notify_all();
        }
    }

    /// Ends the threads.
    pub fn stop(&self) {
        lock(&self.queue).stopping = true;
        self.changed.notify_all();
    }

    fn cycle(&self, seat: &Seat) -> ControlFlow<()> {
        let mut queue = lock(&self.queue);
        let entry = loop {
            if queue.stopping {
                return ControlFlow::Break(());
            }
            let now = Instant::now();
            match queue.entries.peek() {
                Some(Reverse(first)) if first.at <= now => break queue.entries.pop(),
                first => {
                    let wait = first.map_or(NEVER, |Reverse(first)| first.at - now);
                    queue.is_awaited = true;
                    queue = self
                        .changed
                        .wait_timeout(queue, wait)
                        .unwrap_or_else(PoisonError::into_inner)
                        .0;
                    queue.is_awaited = false;
                }
            }
        };
        drop(queue);
        if let Some(target) = entry.and_then(|Reverse(entry)| entry.target.upgrade()) {
            seat.begin();
            let again = target.due();
            seat.end();
            if let Some(at) = again {
                self.at(at, Arc::downgrade(&target));
            }
        }
        ControlFlow::Continue(())
    }
}

/// A lock whose holder may have panicked: every critical section here leaves whole data behind.
pub(crate) fn lock<T: ?Sized>(mutex: &Mutex<T>) -> std::sync::MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
