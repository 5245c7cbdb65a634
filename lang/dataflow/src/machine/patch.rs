//! A new version of a program takes the place of the one that runs, which goes on where it is.
//!
//! Owns what is kept and what is not. Blocks are the same if they are of the same type, with the same id, in the same call:
//! they keep their windows, counts, timers and waiting tokens. Variables keep their values and types. A property that the
//! new version changes counts from now on; one that it leaves alone keeps what a token has made of it. Everything is checked
//! before anything changes, and no device is told anything.

use super::formulas::Formulas;
use super::sensors::device;
use super::state::{Memory, State};
use super::trace::Deaf;
use super::{Env, Machine, words};
use crate::check::check;
use crate::limits;
use crate::lower::lower;
use crate::program::{Flow, Instance, Node, NodeId, Op, Program, Queue, Target};
use crate::project::Project;
use lang_diagram::brick::Brick;
use lang_expr::Value;
use lang_expr::limits::NAMES_MAX;
use lang_text::problem::{Problem, Severity};
use std::collections::{HashMap, VecDeque};
use std::fmt;
use std::mem::discriminant;
use std::rc::Rc;

/// A new version that is good as far as it can be known without the program that runs.
#[derive(Clone, Debug)]
pub struct Version {
    program: Rc<Program>,
}

/// Why a new version is refused. Nothing has changed then.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Refused {
    /// The program has ended.
    Ended,
    /// The version has mistakes, each with its diagram, block and property.
    Mistakes(Vec<Problem>),
}

/// What a new version has changed.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Patched {
    /// Blocks that both versions have, those of each call by themselves.
    pub kept: usize,
    /// Blocks that only the new one has.
    pub added: usize,
    /// Blocks that only the old one had.
    pub gone: usize,
    /// Tokens that waited at ports that are gone, or were on their way there.
    pub lost: usize,
}

impl fmt::Display for Patched {
    /// For a person.
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self {
            kept,
            added,
            gone,
            lost,
        } = self;
        write!(f, "{kept} blocks kept, {added} new, {gone} gone")?;
        match lost {
            0 => Ok(()),
            1 => write!(f, ", 1 token lost"),
            some => write!(f, ", {some} tokens lost"),
        }
    }
}

impl From<Rc<Program>> for Version {
    /// Of a program that was checked and has no errors.
    fn from(program: Rc<Program>) -> Self {
        Self { program }
    }
}

impl Version {
    /// Checks a project as `trik lint` does.
    ///
    /// # Errors
    /// All mistakes, if there is an error among them.
    pub fn of(project: &Project) -> Result<Self, Refused> {
        Self::mistakes(project)?;
        Self::of_checked(project)
    }

    /// The version of a project that [`Version::mistakes`] has found good, which takes a small part of the time.
    ///
    /// # Errors
    /// The project cannot be run at all.
    pub fn of_checked(project: &Project) -> Result<Self, Refused> {
        let lowered = lower(project);
        match lowered.has_errors() {
            true => Err(Refused::Mistakes(lowered.problems)),
            false => Ok(Self {
                program: Rc::new(lowered.program),
            }),
        }
    }

    /// What is wrong with a project whatever runs; another thread may look for it. The answer are the warnings.
    ///
    /// # Errors
    /// All mistakes, if there is an error among them.
    pub fn mistakes(project: &Project) -> Result<Vec<Problem>, Refused> {
        let checked = check(project);
        let kept = match checked.has_failed {
            true => Severity::Error,
            false => Severity::Warning,
        };
        let mut problems = checked.problems;
        problems.retain(|problem| problem.severity == kept);
        match checked.has_failed {
            true => Err(Refused::Mistakes(problems)),
            false => Ok(problems),
        }
    }
}

/// Where the blocks of the old version are in the new one, and the other way round.
struct Kept {
    new_of: Vec<Option<NodeId>>,
    old_of: Vec<Option<NodeId>>,
}

impl Kept {
    fn between(old: &Program, new: &Program) -> Self {
        let mut kept = Self {
            new_of: vec![None; old.nodes.len()],
            old_of: vec![None; new.nodes.len()],
        };
        // Calls come before the bodies that they lead to, so the caller of each body is known here.
        let mut bodies: HashMap<Option<NodeId>, &Instance> = HashMap::new();
        for instance in &old.instances {
            bodies.insert(instance.caller, instance);
        }
        for instance in &new.instances {
            let caller = match instance.caller {
                None => Some(None),
                Some(node) => kept.old_of[node as usize].map(Some),
            };
            if let Some(body) = caller.and_then(|caller| bodies.get(&caller)) {
                kept.pair((old, body), (new, instance));
            }
        }
        kept
    }

    fn pair(&mut self, (old, body): (&Program, &Instance), (new, instance): (&Program, &Instance)) {
        let ids = body.nodes.clone().map(|id| (&*old.node(id).id, id));
        let ids: HashMap<&str, NodeId> = ids.collect();
        for id in instance.nodes.clone() {
            let node = new.node(id);
            let Some(&before) = ids.get(&*node.id) else {
                continue;
            };
            if old.node(before).row.element == node.row.element {
                self.new_of[before as usize] = Some(id);
                self.old_of[id as usize] = Some(before);
            }
        }
    }

    fn target(&self, target: Target) -> Option<Target> {
        let node = self.new_of[target.node as usize]?;
        Some(Target { node, ..target })
    }
}

impl Machine {
    /// Replaces the program that runs by a new version of it, whole or not at all. New blocks that nothing leads to start
    /// at the next step; those that there were before do not start again.
    ///
    /// # Errors
    /// [`Refused`]; a sensor that the robot does not have is a mistake too.
    pub fn patch(&mut self, version: &Version, brick: &mut dyn Brick) -> Result<Patched, Refused> {
        if self.ended.is_some() {
            return Err(Refused::Ended);
        }
        let old = self.program.clone();
        let kept = Kept::between(&old, &version.program);
        let mut next = Self::new(version.program.clone());
        next.take_over(self);
        let mut patched = next.take_blocks(self, &kept);
        next.take_variables(self, &kept)
            .map_err(|problem| Refused::Mistakes(vec![problem]))?;
        let sound = next.formulas.check_all(&version.program, &next.states);
        sound.map_err(Refused::Mistakes)?;
        next.take_stops(self);
        next.take_instant(self);
        patched.lost += next.take_deliveries(self, &kept);
        next.start_new(&kept);
        if let Some(problem) = next.missing_sensor(brick) {
            return Err(Refused::Mistakes(vec![problem]));
        }
        patched.kept = kept.old_of.iter().flatten().count();
        patched.added = kept.old_of.len() - patched.kept;
        patched.gone = kept.new_of.len() - patched.kept;
        *self = next;
        Ok(patched)
    }

    /// What belongs to no block.
    fn take_over(&mut self, old: &Self) {
        self.began = old.began;
        self.asked = old.asked;
        self.was_stopped = old.was_stopped;
        self.now = old.now;
        self.set = old.set;
        self.next_poll = old.next_poll;
        self.writes = old.writes.clone();
        self.told = old.told.clone();
        self.warnings = old.warnings.clone();
    }

    /// What blocks remember that both versions have.
    fn take_blocks(&mut self, old: &Self, kept: &Kept) -> Patched {
        let mut patched = Patched::default();
        let program = self.program.clone();
        for (id, node) in (0..).zip(&program.nodes) {
            let Some(before) = kept.old_of[id as usize] else {
                continue;
            };
            let (was, state) = (old.program.node(before), &old.states[before as usize]);
            let mut memory = state.memory.clone();
            memory.follow(&State::new(was).memory, &State::new(node).memory);
            memory.keep_of(|port| node.is_linked(port));
            self.queued += memory.kept().map(|(_, value)| value.cells()).sum::<u32>();
            self.states[id as usize].memory = memory;
            // One that repeats no more has nothing to wait for.
            if !matches!(&node.op, Op::Flow(Flow::Random { every_ms: None, .. })) {
                self.states[id as usize].timer = state.timer;
            }
            for (port, queue) in old.queues[before as usize].iter().enumerate() {
                self.take_queue((id, node), port, queue);
            }
        }
        patched.lost = (old.queued_tokens()).saturating_sub(self.queued_tokens());
        let timers = old.timers.iter();
        self.timers = timers
            .filter_map(|(&key, &id)| Some((key, kept.new_of[id as usize]?)))
            .filter(|&(key, id)| self.states[id as usize].timer == Some(key))
            .collect();
        let subscribed = old.subscribed.iter();
        self.subscribed = subscribed
            .filter_map(|&id| kept.new_of[id as usize])
            .collect();
        self.subscribed.sort_unstable();
        let dropped = old.dropped();
        self.dropped = dropped
            .filter_map(|(target, count)| Some((kept.target(target)?, count)))
            .map(|(target, count)| ((target.node, target.port), count))
            .collect();
        patched
    }

    /// Tokens that are on their way: within an instant that is stopped, and to what an earlier version has started. Those
    /// for ports that nothing leads to any more are lost.
    fn take_deliveries(&mut self, old: &Self, kept: &Kept) -> usize {
        let program = self.program.clone();
        let moved = |(target, value): &(Target, Value)| {
            let target = kept.target(*target)?;
            let node = program.node(target.node);
            let instance = &program.instances[node.instance as usize];
            let is_open = node.is_linked(target.port) || instance.starts.contains(&target);
            is_open.then(|| (target, value.clone()))
        };
        let next = old.deliveries.front();
        let is_next_there = next.is_some_and(|next| moved(next).is_some());
        self.deliveries = old.deliveries.iter().filter_map(moved).collect();
        self.move_stop(is_next_there, |node| kept.new_of[node as usize]);
        old.deliveries.len() - self.deliveries.len()
    }

    fn queued_tokens(&self) -> usize {
        let kept = self.states.iter().map(|state| state.memory.kept().count());
        let queued = self.queues.iter().flatten().map(VecDeque::len);
        kept.chain(queued).sum()
    }

    /// Tokens that wait at a port, as many of the newest as there are places for.
    fn take_queue(&mut self, (id, node): (NodeId, &Node), port: usize, queue: &VecDeque<Value>) {
        let Some(&Queue { capacity, .. }) = node.queues.get(port) else {
            return;
        };
        if node.data & (1 << port) == 0 {
            return;
        }
        let skipped = queue.len().saturating_sub(capacity.into());
        for value in queue.iter().skip(skipped) {
            self.queued += value.cells();
            self.queues[id as usize][port].push_back(value.clone());
        }
    }

    /// Values and types of variables, and values of the own names of blocks that both versions have.
    fn take_variables(&mut self, old: &Self, kept: &Kept) -> Result<(), Problem> {
        self.formulas = Formulas::after(&self.program, &old.formulas);
        if self.formulas.has_too_many_names() {
            return Err(Problem::error(words::too_many_names(NAMES_MAX)));
        }
        for (id, before) in (0..).zip(&kept.old_of) {
            let Some(before) = *before else {
                continue;
            };
            let state = &old.states[before as usize];
            for at in 0..limits::OWN_NAMES_MAX {
                let Some(value) = old.formulas.own(before, at, state) else {
                    continue;
                };
                self.bind(id, at, &value);
            }
        }
        Ok(())
    }

    /// Starts blocks that are new in diagrams that run: those of the main one and of calls that have begun.
    fn start_new(&mut self, kept: &Kept) {
        if self.began.is_none() {
            return;
        }
        let program = self.program.clone();
        for instance in &program.instances {
            let runs = instance.caller.is_none_or(|caller| {
                matches!(self.states[caller as usize].memory, Memory::Begun(true))
            });
            if !runs {
                continue;
            }
            let is_new = |start: &&Target| kept.old_of[start.node as usize].is_none();
            let starts = instance.starts.iter().filter(is_new);
            self.deliveries
                .extend(starts.map(|&start| (start, Value::Nil)));
        }
    }

    /// Of blocks that give readings or will at the next step, the first one whose sensor is not there.
    fn missing_sensor(&mut self, brick: &mut dyn Brick) -> Option<Problem> {
        let program = self.program.clone();
        let env = &mut Env {
            program: &program,
            brick,
            trace: &mut Deaf,
        };
        self.readings.begin();
        let started = self.deliveries.iter().map(|(target, _)| target.node);
        let asked: Vec<NodeId> = self.subscribed.iter().copied().chain(started).collect();
        asked.into_iter().find_map(|id| {
            let Op::Source(source) = &program.node(id).op else {
                return None;
            };
            if self.is_readable(source, env) {
                return None;
            }
            let place = program.place(id);
            let problem = Problem::error(words::no_reading(device(source)));
            Some(Problem { place, ..problem })
        })
    }
}

/// One property: what a token has made of it stays if no version has changed it.
fn one<T: Clone + PartialEq>(now: &mut T, before: &T, after: &T) {
    if before != after {
        now.clone_from(after);
    }
}

impl Memory {
    /// Follows the block into another version. `before` and `after` are what it remembers at its start in either: where
    /// the two differ, the version has changed a property.
    fn follow(&mut self, before: &Self, after: &Self) {
        // A property may have made another kind of block of it, as a text that is computed now.
        if discriminant(self) != discriminant(after) {
            self.clone_from(after);
            return;
        }
        match (self, before, after) {
            (
                Self::Count { bounds, .. },
                Self::Count { bounds: before, .. },
                Self::Count { bounds: after, .. },
            ) => {
                for (now, (before, after)) in bounds.iter_mut().zip(before.iter().zip(after)) {
                    one(now, before, after);
                }
            }
            (
                Self::Hold { ms, .. },
                Self::Hold { ms: before, .. },
                Self::Hold { ms: after, .. },
            )
            | (
                Self::Window { ms, .. },
                Self::Window { ms: before, .. },
                Self::Window { ms: after, .. },
            ) => one(ms, before, after),
            (
                Self::Gate {
                    pause_ms, count, ..
                },
                Self::Gate {
                    pause_ms: pause_before,
                    count: count_before,
                    ..
                },
                Self::Gate {
                    pause_ms: pause_after,
                    count: count_after,
                    ..
                },
            ) => {
                one(pause_ms, pause_before, pause_after);
                one(count, count_before, count_after);
            }
            (Self::Text(now), Self::Text(before), Self::Text(after)) => one(now, before, after),
            (Self::File(now, text), Self::File(before, was), Self::File(after, is)) => {
                one(now, before, after);
                one(text, was, is);
            }
            (Self::Number(now), Self::Number(before), Self::Number(after)) => {
                one(now, before, after);
            }
            (Self::Truth(now), Self::Truth(before), Self::Truth(after)) => one(now, before, after),
            // Nothing of the rest is a property, or the block was of another kind before.
            (
                Self::None
                | Self::Count { .. }
                | Self::Hold { .. }
                | Self::Window { .. }
                | Self::Gate { .. }
                | Self::Readings { .. }
                | Self::Offsets(..)
                | Self::Pads { .. }
                | Self::Begun(_)
                | Self::Text(_)
                | Self::File(..)
                | Self::Number(_)
                | Self::Truth(_),
                _,
                _,
            ) => {}
        }
    }
}
