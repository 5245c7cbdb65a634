//! Who may write an actuator: one lease for each directory with a `rest`.
//!
//! A *claim* is an open `owner` file; at most one claim at a time holds the lease. While one does, only its process and
//! what that process started may write the actuator's files, a child with a claim of its own excepted. When it
//! loses the lease in any way, the actuators of the directory come to rest. A process that has lost the lease and keeps its
//! claim open may not write either, so that a program that hung does not go on where it was. Without any claim every
//! program may write.
//!
//! Owns these rules and the dead-man's clock. Knows no node, no open file and no request; bringing to rest is the
//! work of [`Actuators`] and is done with no lock held.

use crate::crew::give_way;
use crate::engine::Engine;
use crate::errno::Error;
use crate::events::{Due, Ready, lock};
use crate::limits;
use crate::process::{line_of, name_of};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, Weak};
use std::time::{Duration, Instant};

/// The lease of one directory and of those that stand for it (`src = 'trikfs:...'`). It outlives reloads, so that kept and new nodes of a directory obey the same one.
pub struct Lease {
    /// The directory, for messages.
    path: String,
    engine: Arc<Engine>,
    me: Weak<Self>,
    /// None before the first tree with them is in force.
    actuators: Mutex<Option<Arc<dyn Actuators>>>,
    state: Mutex<State>,
    /// The actuators have come to rest.
    rested: Condvar,
}

/// What a lease is for, as far as it has to do with it.
pub trait Actuators: Send + Sync {
    /// Permission to write any of them, as mode bits.
    fn write_mode(&self) -> u16;

    /// Brings all of them to rest. Each notes its own failure.
    fn rest(&self);
}

#[derive(Default)]
struct State {
    claims: Vec<Claim>,
    /// Which claim holds the lease.
    holder: Option<u32>,
    /// Changes whenever the holder does.
    generation: u32,
    next_claim: u32,
    /// How many threads are bringing the actuators to rest.
    resting: u32,
    /// When the schedule will call, each time once.
    alarms: Vec<Instant>,
}

struct Claim {
    number: u32,
    process: u32,
    priority: u32,
    /// 0: none.
    deadman_ms: u32,
    /// When the holder last gave a sign of life.
    alive: Instant,
    /// Is told when the lease is lost.
    watcher: Weak<dyn Ready>,
}

impl Claim {
    fn deadline(&self) -> Option<Instant> {
        let patience = Duration::from_millis(self.deadman_ms.into());
        (self.deadman_ms > 0).then(|| self.alive + patience)
    }
}

impl State {
    fn holder(&mut self) -> Option<&mut Claim> {
        let number = self.holder?;
        self.claim(number)
    }

    fn claim(&mut self, number: u32) -> Option<&mut Claim> {
        self.claims.iter_mut().find(|claim| claim.number == number)
    }

    fn give_to(&mut self, number: Option<u32>) {
        self.holder = number;
        self.generation = self.generation.wrapping_add(1);
        if let Some(holder) = self.holder() {
            holder.alive = Instant::now();
        }
    }

    /// Takes the lease away. What is left to do is [`Lease::rest`], with the lock released.
    fn take_away(&mut self) -> Option<Lost> {
        let holder = self.holder()?;
        let lost = Lost {
            process: holder.process,
            watcher: holder.watcher.clone(),
        };
        self.give_to(None);
        self.resting += 1;
        Some(lost)
    }

    /// When the schedule has to call for the holder, unless it will call before that anyway.
    fn next_alarm(&mut self) -> Option<Instant> {
        let at = self.holder().and_then(|holder| holder.deadline())?;
        if self.alarms.iter().any(|alarm| *alarm <= at) {
            return None;
        }
        self.alarms.push(at);
        Some(at)
    }
}

/// A lease that was just taken away.
struct Lost {
    process: u32,
    watcher: Weak<dyn Ready>,
}

/// What a holder can ask for by writing to `owner`.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Wish {
    /// `priority N`
    pub priority: Option<u32>,
    /// `deadman_ms N`
    pub deadman_ms: Option<u32>,
}

impl Wish {
    /// Reads `priority 50 deadman_ms 100`, in any order and each at most once; nothing is a sign of life only.
    pub fn parse(text: &str) -> Result<Self, Error> {
        let mut wish = Self::default();
        let mut words = text.split_ascii_whitespace();
        while let Some(key) = words.next() {
            let (place, max) = match key {
                "priority" => (&mut wish.priority, limits::LEASE_PRIORITY_MAX),
                "deadman_ms" => (&mut wish.deadman_ms, limits::DEADMAN_MS_MAX),
                _ => {
                    let what = "owner takes 'priority N' and 'deadman_ms N'";
                    return Err(Error::Invalid(what.to_owned()));
                }
            };
            let number = words.next().and_then(|word| word.parse::<i64>().ok());
            let number =
                number.ok_or_else(|| Error::Invalid(format!("{key} is a whole number")))?;
            let number = u32::try_from(number).ok().filter(|number| *number <= max);
            let number = number.ok_or_else(|| Error::OutOfRange(format!("{key} is 0 to {max}")))?;
            if place.replace(number).is_some() {
                return Err(Error::Invalid(format!("{key} stands there twice")));
            }
        }
        Ok(wish)
    }
}

impl Lease {
    /// A free lease of a directory.
    pub fn new(path: &str, engine: &Arc<Engine>) -> Arc<Self> {
        Arc::new_cyclic(|me| Self {
            path: path.to_owned(),
            engine: engine.clone(),
            me: me.clone(),
            actuators: Mutex::default(),
            state: Mutex::default(),
            rested: Condvar::new(),
        })
    }

    /// The directory that it is named after.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// What comes to rest at its end.
    pub fn set_actuators(&self, actuators: Arc<dyn Actuators>) {
        *lock(&self.actuators) = Some(actuators);
    }

    /// Permission to write for all actuators that come to rest at its end.
    pub fn write_mode(&self) -> u16 {
        let actuators = lock(&self.actuators).clone();
        actuators.map_or(0, |actuators| actuators.write_mode())
    }

    /// The line of `owner`; empty if the lease is free.
    pub fn line(&self) -> String {
        let holder = {
            let mut state = lock(&self.state);
            let holder = state.holder();
            holder.map(|holder| (holder.process, holder.priority, holder.deadman_ms))
        };
        let Some((process, priority, deadman_ms)) = holder else {
            return "\n".to_owned();
        };
        let name = name_of(process);
        format!("{process} {name} priority {priority} deadman_ms {deadman_ms}\n")
    }

    /// A claim of a process: it holds the lease at once if it is free. If not, it is refused, or with `waits` stays
    /// a claim that may ask with a priority.
    pub fn claim(&self, process: u32, waits: bool, watcher: Weak<dyn Ready>) -> Result<u32, Error> {
        if process == 0 {
            let what =
                "a process that trikfs cannot see (another PID namespace) cannot hold a lease";
            return Err(Error::Invalid(what.to_owned()));
        }
        let mut state = lock(&self.state);
        if state.holder.is_some() && !waits {
            return Err(self.busy(state));
        }
        state.next_claim = state.next_claim.wrapping_add(1);
        let number = state.next_claim;
        state.claims.push(Claim {
            number,
            process,
            priority: 0,
            deadman_ms: 0,
            alive: Instant::now(),
            watcher,
        });
        if state.holder.is_none() {
            state.give_to(Some(number));
        }
        Ok(number)
    }

    /// Whether this claim holds the lease.
    pub fn is_held_by(&self, claim: u32) -> bool {
        lock(&self.state).holder == Some(claim)
    }

    /// What was written to an open `owner`. A claim without the lease gets it if it asks with a priority and nobody
    /// holds it with as much; then the actuators are at rest when this returns.
    pub fn ask(&self, claim: u32, wish: Wish) -> Result<(), Error> {
        let mut lost = None;
        let mut state = lock(&self.state);
        if state.holder != Some(claim) {
            let Some(priority) = wish.priority else {
                return Err(self.busy(state));
            };
            if state
                .holder()
                .is_some_and(|holder| holder.priority >= priority)
            {
                return Err(self.busy(state));
            }
            lost = state.take_away();
            state.give_to(Some(claim));
        }
        if let Some(holder) = state.holder() {
            holder.alive = Instant::now();
            holder.priority = wish.priority.unwrap_or(holder.priority);
            holder.deadman_ms = wish.deadman_ms.unwrap_or(holder.deadman_ms);
        }
        let alarm = state.next_alarm();
        drop(state);
        if let Some(at) = alarm {
            self.arm(at);
        }
        if let Some(lost) = lost {
            self.rest(&lost, "another asked with a higher priority");
        }
        Ok(())
    }

    /// The process of a claim is ending: it holds nothing any more.
    pub fn end(&self, claim: u32, process: u32) {
        let mut state = lock(&self.state);
        let is_its = state
            .claim(claim)
            .is_some_and(|claim| claim.process == process);
        let lost = (is_its && state.holder == Some(claim)).then(|| state.take_away());
        drop(state);
        if let Some(lost) = lost.flatten() {
            self.rest(&lost, "its process ended");
        }
    }

    /// The claim is closed for good.
    pub fn leave(&self, claim: u32) {
        let mut state = lock(&self.state);
        let lost = (state.holder == Some(claim)).then(|| state.take_away());
        state.claims.retain(|open| open.number != claim);
        drop(state);
        if let Some(lost) = lost.flatten() {
            self.rest(&lost, "owner was closed");
        }
    }

    /// Lets a thread write, or says which other process holds the lease. Gives the generation; `known` is the one in which the
    /// same thread was let in through the same open file. [`Lease::wrote`] follows.
    pub fn admit(&self, thread: u32, known: Option<u32>) -> Result<u32, Error> {
        {
            let mut state = self.at_rest()?;
            let generation = state.generation;
            if state.claims.is_empty() {
                return Ok(generation);
            }
            if known == Some(generation)
                && let Some(holder) = state.holder()
            {
                holder.alive = Instant::now();
                return Ok(generation);
            }
        }
        // With the lock released: /proc is slow.
        let line: Vec<u32> = line_of(thread).collect();
        let mut state = lock(&self.state);
        // The nearest one with a claim speaks for the thread: one that has lost the lease is not let in by a parent's.
        let claims_of = |process| {
            let claims = state.claims.iter();
            claims.filter(move |claim| claim.process == process)
        };
        let nearest = line
            .into_iter()
            .find(|&process| claims_of(process).next().is_some());
        let holds = nearest.is_some_and(|process| {
            claims_of(process).any(|claim| state.holder == Some(claim.number))
        });
        if holds {
            if let Some(holder) = state.holder() {
                holder.alive = Instant::now();
            }
        } else if state.holder.is_some() || nearest.is_some() {
            return Err(self.busy(state));
        }
        Ok(state.generation)
    }

    /// A write that was let in is done. If the lease has changed hands meanwhile, the write may have come to the device
    /// after the rest, so there is another rest.
    pub fn wrote(&self, generation: u32) {
        let mut state = lock(&self.state);
        if state.generation == generation {
            if let Some(holder) = state.holder() {
                holder.alive = Instant::now();
            }
            return;
        }
        state.resting += 1;
        drop(state);
        self.bring_to_rest();
    }

    /// The generation now.
    pub fn generation(&self) -> u32 {
        lock(&self.state).generation
    }

    /// Waits until the actuators have come to rest after a lease, but not for ever.
    fn at_rest(&self) -> Result<MutexGuard<'_, State>, Error> {
        let state = lock(&self.state);
        if state.resting == 0 {
            return Ok(state);
        }
        drop(state);
        give_way();
        let limit = Duration::from_millis(limits::REST_WAIT_MS);
        let waited = self
            .rested
            .wait_timeout_while(lock(&self.state), limit, |state| state.resting > 0);
        let (state, timeout) = waited.unwrap_or_else(PoisonError::into_inner);
        if timeout.timed_out() {
            let what = "the actuator is still coming to rest after a lease";
            return Err(Error::Busy(what.to_owned()));
        }
        Ok(state)
    }

    fn arm(&self, at: Instant) {
        let me: Weak<dyn Due> = self.me.clone();
        self.engine.schedule.at(at, me);
    }

    /// Does what the end of a lease demands, after [`State::take_away`].
    fn rest(&self, lost: &Lost, why: &str) {
        let (path, process) = (&self.path, lost.process);
        let line = format!("{path}: process {process} lost the lease: {why}");
        self.engine.log.line(&line);
        self.bring_to_rest();
        if let Some(watcher) = lost.watcher.upgrade() {
            watcher.ready();
        }
    }

    /// The refusal for everybody but the holder. Gives the lock back first: /proc is slow.
    fn busy(&self, mut state: MutexGuard<'_, State>) -> Error {
        let holder = state.holder();
        let holder = holder.map(|holder| (holder.process, holder.priority));
        drop(state);
        Error::Busy(match holder {
            Some((process, priority)) => format!(
                "process {process} ({}) holds the lease with priority {priority}: see {}/owner",
                name_of(process),
                self.path
            ),
            None => "this program has lost the lease: write 'priority N' to owner to ask for it again, or close it"
                .to_owned(),
        })
    }

    fn bring_to_rest(&self) {
        let actuators = lock(&self.actuators).clone();
        if let Some(actuators) = actuators {
            actuators.rest();
        }
        lock(&self.state).resting -= 1;
        self.rested.notify_all();
    }
}

impl Due for Lease {
    /// The dead-man's clock: it calls at the earliest time at which the holder's patience may be over.
    fn due(&self) -> Option<Instant> {
        let now = Instant::now();
        let mut state = lock(&self.state);
        state.alarms.retain(|alarm| *alarm > now);
        let deadline = state.holder().and_then(|holder| holder.deadline());
        let lost = deadline
            .filter(|at| *at <= now)
            .and_then(|_| state.take_away());
        let again = state.next_alarm();
        drop(state);
        if let Some(lost) = lost {
            self.rest(&lost, "it gave no sign of life within its deadman_ms");
        }
        again
    }
}

#[cfg(test)]
mod tests;
