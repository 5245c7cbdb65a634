//! The buses of one mount: one opening for each path, used by one transfer at a time.
//!
//! Owns the turn (which transfer has the bus, in which order the others follow), the reopening of a bus that vanished, what is
//! known of its speed, and what is remembered of its registers. Knows no node.
//!
//! A thread that would have to wait gives its role away first ([`give_way`]), so that a slow or dead bus delays no
//! program that does not use it. Only so many wait for one bus, fewer for one that is stuck: the others get an error that
//! it is busy, and no bus can take all threads.

use super::adapter::Adapter;
use super::virtual_bus::VirtualBus;
use super::{Data, Transfer};
use crate::crew::give_way;
use crate::errno::Error;
use crate::events::lock;
use crate::limits;
use nix::errno::Errno;
use std::collections::{HashMap, VecDeque};
use std::io;
use std::ops::Deref;
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// Address and register.
pub(super) type Key = (u16, u16);

/// All buses of one mount, by path.
#[derive(Default)]
pub struct Buses(Mutex<HashMap<PathBuf, Arc<Bus>>>);

impl Buses {
    /// The bus at a path, which need not be there. The same for all that name the same path.
    pub fn get(&self, path: &Path) -> Arc<Bus> {
        let mut buses = lock(&self.0);
        if let Some(bus) = buses.get(path) {
            return bus.clone();
        }
        // Nothing holds a handle of those that reloads have left.
        buses.retain(|_, bus| Arc::strong_count(bus) > 1 || bus.has_memory());
        let bus = Arc::new(Bus::new(path));
        buses.insert(path.to_owned(), bus.clone());
        bus
    }
}

/// Why a transfer failed.
#[derive(Debug)]
pub(super) enum Failure {
    /// What the bus or the device said.
    Errno(i32),
    /// More bytes than this kind of bus carries, or a register that it cannot name: nothing was sent.
    Unfit,
    /// No answer in time.
    Silent,
    /// The bus is not there (any more), and nothing was sent.
    Gone(io::Error),
    /// The bus was closed after the request was sent: doing it again might do it twice.
    Lost,
    /// An answer that means nothing.
    Garbage(String),
}

/// How long one transfer may last.
#[derive(Clone, Copy)]
pub(super) struct Time {
    /// From its begin.
    pub(super) limit: Duration,
    /// The same as a moment.
    pub(super) deadline: Instant,
}

enum Connection {
    Real(Adapter),
    Virtual(VirtualBus),
}

impl Connection {
    fn open(path: &Path, timeout: Duration) -> Result<Self, Failure> {
        let kind = std::fs::metadata(path).map_err(Failure::Gone)?.file_type();
        if kind.is_socket() {
            VirtualBus::open(path, timeout).map(Self::Virtual)
        } else {
            Adapter::open(path, timeout).map(Self::Real)
        }
    }

    fn transfer(&mut self, transfer: &mut Transfer<'_>, time: Time) -> Result<(), Failure> {
        match self {
            Self::Real(adapter) => adapter.transfer(transfer),
            Self::Virtual(bus) => bus.transfer(transfer, time),
        }
    }

    /// Whether it is the opening of a bus that is being taken away.
    fn is_withdrawn(&mut self, path: &Path) -> bool {
        match self {
            Self::Real(adapter) => adapter.is_withdrawn(path),
            // Its end is an end of the connection.
            Self::Virtual(_) => false,
        }
    }

    fn identity(&self) -> Option<(u64, u64)> {
        match self {
            Self::Real(adapter) => adapter.identity(),
            Self::Virtual(_) => None,
        }
    }
}

/// One bus.
pub struct Bus {
    path: PathBuf,
    turn: Turn,
    /// Only the thread that has the turn takes this.
    connection: Mutex<Option<Connection>>,
    /// How many transfers from now on are expected to be slow.
    slow: AtomicU32,
    memory: Mutex<Memory>,
    /// How many [`InUse`] there are.
    users: AtomicUsize,
}

#[derive(Default)]
struct Memory {
    written: HashMap<Key, Vec<u8>>,
    remembered: HashMap<Key, Vec<u8>>,
    /// The bus that `remembered` is of, while nobody has it open.
    left: Option<(u64, u64)>,
}

impl Memory {
    /// The bus was opened: what is remembered holds only if it was closed because nobody used it, and is the same.
    fn enter(&mut self, identity: Option<(u64, u64)>) {
        if self.left.take().is_none_or(|left| Some(left) != identity) {
            self.remembered.clear();
        }
    }
}

/// A bus that a register uses; with the last one the bus is closed.
pub(super) struct InUse(Arc<Bus>);

impl InUse {
    pub(super) fn new(bus: Arc<Bus>) -> Self {
        bus.users.fetch_add(1, Ordering::Relaxed);
        Self(bus)
    }
}

impl Deref for InUse {
    type Target = Bus;

    fn deref(&self) -> &Bus {
        &self.0
    }
}

impl Drop for InUse {
    fn drop(&mut self) {
        if self.0.users.fetch_sub(1, Ordering::Relaxed) == 1 {
            self.0.leave();
        }
    }
}

impl Bus {
    fn new(path: &Path) -> Self {
        Self {
            path: path.to_owned(),
            turn: Turn::default(),
            connection: Mutex::default(),
            slow: AtomicU32::new(0),
            memory: Mutex::default(),
            users: AtomicUsize::new(0),
        }
    }

    /// Closes a real bus that nobody uses: the kernel can only take away a bus and its driver that nobody has open. A
    /// virtual one stays, since nobody waits for its end.
    fn leave(&self) {
        // Somebody who has come since then has it.
        let Ok(mut connection) = self.connection.try_lock() else {
            return;
        };
        let identity = connection.as_ref().and_then(Connection::identity);
        if identity.is_some() {
            lock(&self.memory).left = identity;
            *connection = None;
        }
    }

    fn has_memory(&self) -> bool {
        !lock(&self.memory).written.is_empty()
    }

    /// Whether there is something at the path that can be a bus.
    pub(super) fn check(&self) -> Result<(), Error> {
        let meta = std::fs::metadata(&self.path)
            .map_err(|error| super::super::device_error(&self.path, &error))?;
        if meta.file_type().is_char_device() || meta.file_type().is_socket() {
            return Ok(());
        }
        Err(Error::NoDevice(format!(
            "{} is neither an I2C bus (a character device) nor a virtual one (a socket)",
            self.path.display()
        )))
    }

    /// Waits for the bus and makes one transfer, both together within the time limit.
    pub(super) fn transfer(
        &self,
        transfer: &mut Transfer<'_>,
        timeout: Duration,
    ) -> Result<(), Error> {
        // The clock is read once before and once after a transfer that need not wait: it costs a tenth of a short one.
        let begin = Instant::now();
        let urgent = matches!(transfer.data, Data::Write(_));
        let mut started = begin;
        let _turn = if let Some(turn) = self.turn.try_take(begin) {
            if self.is_slow() || is_long(transfer) {
                give_way();
            }
            turn
        } else {
            give_way();
            let turn = self.turn.take(urgent, begin + timeout);
            started = Instant::now();
            turn.map_err(|refusal| self.refusal(&refusal, timeout))?
        };
        let time = Time {
            limit: timeout.saturating_sub(started - begin),
            deadline: begin + timeout,
        };
        let mut connection = lock(&self.connection);
        let was_open = connection.is_some();
        let mut result = self.transfer_once(&mut connection, transfer, time);
        if was_open && matches!(result, Err(Failure::Gone(_))) {
            // The bus was closed since the last transfer, and nothing has been sent: there may be a new one.
            result = self.transfer_once(&mut connection, transfer, time);
        }
        self.note_speed(started.elapsed());
        result.map_err(|failure| self.error(failure, transfer.address, timeout))
    }

    fn transfer_once(
        &self,
        connection: &mut Option<Connection>,
        transfer: &mut Transfer<'_>,
        time: Time,
    ) -> Result<(), Failure> {
        if connection
            .as_mut()
            .is_some_and(|open| open.is_withdrawn(&self.path))
        {
            *connection = None;
        }
        let open = match connection.as_mut() {
            Some(open) => open,
            None => {
                // Opening may wait, too.
                give_way();
                let fresh = Connection::open(&self.path, time.limit)?;
                lock(&self.memory).enter(fresh.identity());
                connection.insert(fresh)
            }
        };
        let result = open.transfer(transfer, time);
        if !matches!(&result, Ok(()) | Err(Failure::Errno(_) | Failure::Unfit)) {
            *connection = None;
        }
        result
    }

    /// A bus that was slow once is taken for slow until it was fast many times.
    fn note_speed(&self, took: Duration) {
        if took > Duration::from_micros(limits::BUS_SLOW_US) {
            self.slow
                .store(limits::BUS_SLOW_TRANSFERS, Ordering::Relaxed);
        } else if self.is_slow() {
            // Only the thread that has the turn comes here.
            self.slow.fetch_sub(1, Ordering::Relaxed);
        }
    }

    fn is_slow(&self) -> bool {
        self.slow.load(Ordering::Relaxed) > 0
    }

    fn refusal(&self, refusal: &Refusal, timeout: Duration) -> Error {
        let path = self.path.display();
        match refusal {
            Refusal::Late => Error::TimedOut(format!(
                "{path} was busy with other transfers for {} ms",
                timeout.as_millis()
            )),
            Refusal::TooMany(number) => {
                Error::Crowded(format!("{path}: {number} transfers wait for it"))
            }
        }
    }

    fn error(&self, failure: Failure, address: u16, timeout: Duration) -> Error {
        let path = self.path.display();
        let transfer = || format!("transfer with 0x{address:02x} on {path}");
        match failure {
            Failure::Errno(number) => match Errno::from_raw(number) {
                // Drivers differ in what they call a missing acknowledge.
                Errno::ENXIO | Errno::EREMOTEIO => {
                    Error::no_answer(format!("no answer from 0x{address:02x} on {path}"))
                }
                Errno::ETIMEDOUT => self.error(Failure::Silent, address, timeout),
                _ => Error::Device(number, transfer()),
            },
            Failure::Silent => Error::TimedOut(format!(
                "0x{address:02x} on {path} did not answer within {} ms",
                timeout.as_millis()
            )),
            Failure::Unfit => Error::unfit_transfer(transfer()),
            Failure::Gone(error) => match error.raw_os_error().map(Errno::from_raw) {
                Some(Errno::EACCES | Errno::EPERM) => Error::AccessDenied,
                _ => Error::NoDevice(format!("{path}: {error}")),
            },
            Failure::Lost => {
                Error::NoDevice(format!("{path}: the bus was closed inside a transfer"))
            }
            Failure::Garbage(what) => Error::against_protocol(format!("{path}: {what}")),
        }
    }

    /// What was written last to a register that cannot be read back; zeros before that.
    pub(super) fn written(&self, key: Key, tuple: &mut [u8]) {
        copy_known(&lock(&self.memory).written, key, tuple);
    }

    /// Keeps what was written.
    pub(super) fn wrote(&self, key: Key, tuple: &[u8]) {
        keep(&mut lock(&self.memory).written, key, tuple);
    }

    /// What was read once since the bus was opened; false if nothing was.
    pub(super) fn remembered(&self, key: Key, tuple: &mut [u8]) -> bool {
        copy_known(&lock(&self.memory).remembered, key, tuple)
    }

    /// Keeps what was read once.
    pub(super) fn remember(&self, key: Key, tuple: &[u8]) {
        keep(&mut lock(&self.memory).remembered, key, tuple);
    }

    /// What was read before a write is true no more.
    pub(super) fn forget(&self, key: Key) {
        lock(&self.memory).remembered.remove(&key);
    }
}

fn copy_known(known: &HashMap<Key, Vec<u8>>, key: Key, tuple: &mut [u8]) -> bool {
    match known.get(&key) {
        Some(bytes) if bytes.len() == tuple.len() => {
            tuple.copy_from_slice(bytes);
            true
        }
        _ => false,
    }
}

fn keep(known: &mut HashMap<Key, Vec<u8>>, key: Key, tuple: &[u8]) {
    if known.len() >= limits::BUS_MEMORY_MAX && !known.contains_key(&key) {
        // Of registers that left the configuration nothing is needed; those that are in use are kept anew.
        known.clear();
    }
    known.insert(key, tuple.to_vec());
}

/// Long for any bus: 9 bits each at 100 kHz are more than the watchdog's patience.
fn is_long(transfer: &Transfer<'_>) -> bool {
    let bytes = match &transfer.data {
        Data::Read(data) => data.len(),
        Data::Write(data) => data.len(),
    };
    bytes > limits::BUS_SHORT_BYTES
}

/// Which transfer has the bus. The others follow in the order of their coming, but a write comes before the next read: what moves
/// must be stopped at once. After a write a read has its turn, so that neither can keep the other waiting for ever.
#[derive(Default)]
struct Turn {
    line: Mutex<Line>,
    called: Condvar,
}

#[derive(Default)]
struct Line {
    taken: bool,
    /// When it was taken.
    since: Option<Instant>,
    next_ticket: u32,
    waiting: VecDeque<(u32, bool)>,
    /// Whose turn it is, until that thread has woken up.
    called: Option<u32>,
    last_was_urgent: bool,
}

/// Why the turn did not come.
#[derive(Debug, PartialEq, Eq)]
enum Refusal {
    Late,
    TooMany(usize),
}

/// The turn, given back when dropped.
struct Taken<'a>(&'a Turn);

impl Drop for Taken<'_> {
    fn drop(&mut self) {
        self.0.give_back();
    }
}

impl Turn {
    /// The turn, if nobody has it or waits for it.
    fn try_take(&self, now: Instant) -> Option<Taken<'_>> {
        let mut line = lock(&self.line);
        let free = !line.taken && line.waiting.is_empty();
        free.then(|| {
            line.taken = true;
            line.since = Some(now);
            Taken(self)
        })
    }

    /// Waits in line for the turn.
    fn take(&self, urgent: bool, deadline: Instant) -> Result<Taken<'_>, Refusal> {
        let mut line = lock(&self.line);
        if !line.taken && line.waiting.is_empty() {
            line.taken = true;
            line.since = Some(Instant::now());
            return Ok(Taken(self));
        }
        let is_stuck = line
            .since
            .is_some_and(|since| since.elapsed() > Duration::from_millis(limits::BUS_STUCK_MS));
        let most = if is_stuck {
            limits::BUS_WAITERS_STUCK_MAX
        } else {
            limits::BUS_WAITERS_MAX
        };
        if line.waiting.len() >= most {
            return Err(Refusal::TooMany(line.waiting.len()));
        }
        line.next_ticket = line.next_ticket.wrapping_add(1);
        let ticket = line.next_ticket;
        line.waiting.push_back((ticket, urgent));
        while line.called != Some(ticket) {
            let left = deadline.saturating_duration_since(Instant::now());
            if left.is_zero() {
                line.waiting.retain(|(other, _)| *other != ticket);
                return Err(Refusal::Late);
            }
            line = self
                .called
                .wait_timeout(line, left)
                .unwrap_or_else(PoisonError::into_inner)
                .0;
        }
        line.called = None;
        line.since = Some(Instant::now());
        line.last_was_urgent = urgent;
        Ok(Taken(self))
    }

    fn give_back(&self) {
        let mut line = lock(&self.line);
        let urgent = line.waiting.iter().position(|(_, urgent)| *urgent);
        let patient = line.waiting.iter().position(|(_, urgent)| !*urgent);
        let next = if line.last_was_urgent {
            patient.or(urgent)
        } else {
            urgent.or(patient)
        };
        let called = next.and_then(|at| line.waiting.remove(at));
        line.called = called.map(|(ticket, _)| ticket);
        line.taken = called.is_some();
        let anybody = called.is_some();
        drop(line);
        if anybody {
            self.called.notify_all();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::sync::mpsc::channel;

    fn soon() -> Instant {
        Instant::now() + Duration::from_secs(20)
    }

    fn waiting(turn: &Turn, count: usize) {
        let deadline = soon();
        while lock(&turn.line).waiting.len() != count {
            assert!(Instant::now() < deadline, "never {count} waiting");
            std::thread::yield_now();
        }
    }

    #[test]
    fn what_is_remembered_holds_while_nobody_uses_the_same_bus_and_for_no_other() {
        let mut memory = Memory::default();
        let fill = |memory: &mut Memory, left| {
            keep(&mut memory.remembered, (0x50, 4), &[7]);
            memory.left = left;
        };
        fill(&mut memory, Some((5, 9)));
        memory.enter(Some((5, 9)));
        assert_eq!(memory.remembered.len(), 1, "it is the same");
        memory.enter(Some((5, 9)));
        assert!(memory.remembered.is_empty(), "it was lost in use");
        for (left, found) in [
            (Some((5, 9)), Some((5, 10))),
            (Some((5, 9)), None),
            (None, None),
        ] {
            fill(&mut memory, left);
            memory.enter(found);
            assert!(memory.remembered.is_empty(), "{left:?} {found:?}");
        }
    }

    #[test]
    fn writes_come_first_and_reads_in_between() {
        let turn = Arc::new(Turn::default());
        let held = turn.try_take(Instant::now()).expect("free");
        assert!(turn.try_take(Instant::now()).is_none());
        let (said, heard) = channel();
        let mut threads = Vec::new();
        for (place, (name, urgent)) in [
            ("read 1", false),
            ("read 2", false),
            ("write 1", true),
            ("write 2", true),
        ]
        .into_iter()
        .enumerate()
        {
            let (turn, said) = (turn.clone(), said.clone());
            let waits = turn.clone();
            threads.push(std::thread::spawn(move || {
                let _mine = turn.take(urgent, soon()).expect("in time");
                said.send(name).unwrap();
            }));
            waiting(&waits, place + 1);
        }
        drop(held);
        let order: Vec<_> = (0..4).map(|_| heard.recv().unwrap()).collect();
        assert_eq!(order, ["write 1", "read 1", "write 2", "read 2"]);
        threads
            .into_iter()
            .for_each(|thread| thread.join().unwrap());
        assert!(turn.try_take(Instant::now()).is_some());
    }

    #[test]
    fn who_waits_too_long_leaves_the_line_and_the_turn_goes_on() {
        let turn = Turn::default();
        let held = turn.try_take(Instant::now()).expect("free");
        let late = turn.take(true, Instant::now() + Duration::from_millis(5));
        assert_eq!(late.err(), Some(Refusal::Late));
        assert!(lock(&turn.line).waiting.is_empty());
        drop(held);
        assert!(turn.take(false, soon()).is_ok());
    }

    #[test]
    fn no_more_wait_than_the_limit_allows() {
        let turn = Arc::new(Turn::default());
        let held = turn.try_take(Instant::now()).expect("free");
        // However long it takes until all wait, the bus is not stuck.
        lock(&turn.line).since = Some(Instant::now() + Duration::from_secs(3600));
        let threads: Vec<_> = (0..limits::BUS_WAITERS_MAX)
            .map(|_| {
                let turn = turn.clone();
                std::thread::spawn(move || turn.take(false, soon()).is_ok())
            })
            .collect();
        waiting(&turn, limits::BUS_WAITERS_MAX);
        let refused = turn.take(true, soon()).err();
        assert_eq!(refused, Some(Refusal::TooMany(limits::BUS_WAITERS_MAX)));
        drop(held);
        assert!(threads.into_iter().all(|thread| thread.join().unwrap()));
    }

    #[test]
    fn a_bus_that_is_stuck_takes_fewer() {
        let turn = Arc::new(Turn::default());
        let held = turn.try_take(Instant::now()).expect("free");
        lock(&turn.line).since = Instant::now().checked_sub(Duration::from_secs(1));
        let threads: Vec<_> = (0..limits::BUS_WAITERS_STUCK_MAX)
            .map(|_| {
                let turn = turn.clone();
                std::thread::spawn(move || turn.take(false, soon()).is_ok())
            })
            .collect();
        waiting(&turn, limits::BUS_WAITERS_STUCK_MAX);
        let refused = turn.take(false, soon()).err();
        assert_eq!(
            refused,
            Some(Refusal::TooMany(limits::BUS_WAITERS_STUCK_MAX))
        );
        drop(held);
        assert!(threads.into_iter().all(|thread| thread.join().unwrap()));
    }

    #[test]
    fn what_was_written_stays_and_is_bounded() {
        let bus = Bus::new(Path::new("/dev/null"));
        let mut tuple = [9; 2];
        bus.written((1, 1), &mut tuple);
        assert_eq!(tuple, [9, 9], "nothing is made up");
        for register in 0..=u16::try_from(limits::BUS_MEMORY_MAX).unwrap() {
            bus.wrote((1, register), &[1, 2]);
        }
        assert!(lock(&bus.memory).written.len() <= limits::BUS_MEMORY_MAX);
        bus.wrote((1, 1), &[3, 4]);
        bus.written((1, 1), &mut tuple);
        assert_eq!(tuple, [3, 4]);
    }
}
