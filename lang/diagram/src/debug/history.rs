//! The past of a program: copies of it now and then, and what the robot answered since each, from which every moment
//! between is computed again.
//!
//! Owns what is kept, how much memory that takes, and the search for a moment. A program is deterministic given what its
//! robot answers, so a moment that is computed again is the one that was. Knows no breakpoints: the caller of a search says
//! which moments it means.

use std::collections::{BTreeSet, VecDeque};
use std::rc::Rc;

use super::again::{Again, Asked, Begin};
use super::answers::{Answers, Remembering};
use crate::limits;
use crate::machine::trace::Guard;
use crate::program::Node;

/// A moment: how many blocks were entered before it. At each, a thread is about to enter a block.
pub type Position = u64;

#[derive(Clone, Debug)]
struct Kept {
    begin: Begin,
    /// Steps in which the robot answered the same share them.
    answers: Rc<Answers>,
}

/// A copy of a program, and what has happened since.
#[derive(Clone, Debug)]
struct Segment<M> {
    start: M,
    /// Of the first block that is entered in it.
    first: Position,
    steps: Vec<Kept>,
    /// Blocks before which a thread was held alone.
    held: BTreeSet<Position>,
    bytes: usize,
    weight: usize,
}

/// The past of a program.
#[derive(Clone, Debug)]
pub(super) struct History<M> {
    bytes_max: usize,
    bytes: usize,
    segments: VecDeque<Segment<M>>,
    /// Of the step that has begun and is not done.
    open: Option<Answers>,
    /// Somebody has changed the program: what comes cannot be computed from what was.
    is_changed: bool,
}

/// What a search is told of while a part of the past is run again.
pub(super) trait Look<M> {
    /// A thread is about to enter a block at a position, or none is, and that position is the next.
    fn sees(&mut self, at: Position, machine: &M, entering: Option<(u16, Node)>) -> Seen;
}

/// What a search says to a moment.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Seen {
    /// On to the next one.
    On,
    /// It has looked long enough for now.
    Pause,
    /// It has found what it looks for.
    Enough,
}

/// A part of the past that is being run again, and may be left and gone on with.
#[derive(Clone, Debug)]
pub(super) struct Rerun<M> {
    machine: M,
    pub(super) part: usize,
    /// The next moment.
    next: Position,
    /// The step that is run, and how many of its answers were given.
    step: usize,
    read: usize,
}

impl<M> Rerun<M> {
    /// The program where it was left.
    pub(super) fn machine(&self) -> &M {
        &self.machine
    }
}

/// How far a part was run again.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Ran {
    /// It was left.
    Left,
    /// Nothing is left of it.
    Through,
}

/// What is asked at each moment of a part that is run again: a position and what is entered there.
type Stops<'a, M> = &'a mut dyn FnMut(Position, &M, Option<(u16, Node)>) -> bool;

impl<M: Again> History<M> {
    /// Nothing yet, and never more than about so many bytes.
    pub(super) fn new(bytes_max: usize) -> Self {
        Self {
            bytes_max,
            bytes: 0,
            segments: VecDeque::new(),
            open: None,
            is_changed: true,
        }
    }

    /// A step begins, or goes on after a stop; before the machine does anything. What is noted goes into the answers.
    pub(super) fn begin(&mut self, machine: &M, begin: Begin, next: Position) -> &mut Answers {
        if self.open.is_none() || self.is_changed {
            self.close();
            if self.is_changed || self.segments.back().is_none_or(|last| last.is_full(next)) {
                self.copy(machine, next);
            }
            if let Some(last) = self.segments.back_mut() {
                let answers = Rc::default();
                last.steps.push(Kept { begin, answers });
                last.grow(size_of::<Kept>(), &mut self.bytes);
            }
        }
        self.open.get_or_insert_default()
    }

    /// What was begun has come to an end, or to a stop.
    pub(super) fn end(&mut self, is_done: bool, held: impl IntoIterator<Item = Position>) {
        if let Some(last) = self.segments.back_mut() {
            last.held.extend(held);
        }
        if is_done {
            self.close();
        }
    }

    /// A person has changed the program, between steps or at a stop.
    pub(super) fn changed(&mut self) {
        self.is_changed = true;
    }

    /// The first moment that is kept.
    pub(super) fn first(&self) -> Position {
        self.segments.front().map_or(0, |segment| segment.first)
    }

    /// The program at the first moment that is kept, at which it could have been stopped: before its first block is entered,
    /// and before the time that passes until then.
    pub(super) fn beginning(&self) -> Option<M> {
        let (mut rerun, segment) = (self.rerun_of(0)?, self.segments.front()?);
        let is_held = self.run_on(segment, &mut rerun, self.until(0), &mut |_, _, _| true);
        is_held.then_some(rerun.machine)
    }

    /// When the first moment is that is kept, in milliseconds of the program; none if nothing is.
    pub(super) fn first_ms(&self) -> Option<u32> {
        self.segments.front().map(|segment| segment.start.ms())
    }

    /// How much memory it takes, about.
    pub(super) fn bytes(&self) -> usize {
        self.bytes + self.open.as_ref().map_or(0, Answers::bytes)
    }

    fn close(&mut self) {
        let (Some(answers), Some(last)) = (self.open.take(), self.segments.back_mut()) else {
            return;
        };
        let count = last.steps.len();
        let before = count.checked_sub(2).and_then(|index| last.steps.get(index));
        let same = before.filter(|kept| *kept.answers == answers);
        let (answers, bytes) = match same {
            Some(kept) => (kept.answers.clone(), 0),
            None => {
                let bytes = answers.bytes();
                (Rc::new(answers), bytes)
            }
        };
        if let Some(kept) = last.steps.last_mut() {
            kept.answers = answers;
        }
        last.grow(bytes, &mut self.bytes);
        self.thin();
    }

    fn copy(&mut self, machine: &M, first: Position) {
        self.is_changed = false;
        let weight = machine.bytes();
        self.segments.push_back(Segment {
            start: machine.clone(),
            first,
            steps: Vec::new(),
            held: BTreeSet::new(),
            bytes: weight,
            weight,
        });
        self.bytes += weight;
        self.thin();
    }

    fn thin(&mut self) {
        while self.bytes > self.bytes_max && self.segments.len() > 1 {
            if let Some(gone) = self.segments.pop_front() {
                self.bytes -= gone.bytes;
            }
        }
    }

    /// How many parts are kept, and which of them has a moment.
    pub(super) fn parts(&self, moment: Position) -> (usize, Option<usize>) {
        let after = self
            .segments
            .partition_point(|segment| segment.first <= moment);
        (self.segments.len(), after.checked_sub(1))
    }

    /// Begins to run a part again.
    pub(super) fn rerun_of(&self, part: usize) -> Option<Rerun<M>> {
        let segment = self.segments.get(part)?;
        let mut machine = segment.start.clone();
        machine.prepare();
        Some(Rerun {
            machine,
            part,
            next: segment.first,
            step: 0,
            read: 0,
        })
    }

    /// Runs a part again from where it was left, until it is left again or is through, or until the moment `before`.
    pub(super) fn look_through(
        &self,
        rerun: &mut Rerun<M>,
        before: Position,
        look: &mut dyn Look<M>,
    ) -> Ran {
        let Some(segment) = self.segments.get(rerun.part) else {
            return Ran::Through;
        };
        let mut is_left = false;
        self.run_on(
            segment,
            rerun,
            before,
            &mut |position, machine, entering| {
                is_left = match look.sees(position, machine, entering) {
                    Seen::On => false,
                    // Between threads, or where one was held alone, it cannot be gone on with.
                    Seen::Pause => entering.is_some() && !segment.held.contains(&position),
                    Seen::Enough => true,
                };
                is_left
            },
        );
        if is_left { Ran::Left } else { Ran::Through }
    }

    /// The program at a moment, held before the block that a thread enters there; none if it is not kept.
    pub(super) fn at(&self, wanted: Position) -> Option<M> {
        let at = self
            .segments
            .partition_point(|segment| segment.first <= wanted);
        let at = at.checked_sub(1)?;
        let until = self.until(at);
        let (found, machine) = self.replay(at, until, &mut |position, _, entering| {
            entering.is_some() && position == wanted
        })?;
        (found == wanted).then_some(machine)
    }

    /// The program at a time, between two steps, and how many blocks were entered before; none if it is not kept.
    pub(super) fn at_time(&self, ms: u32) -> Option<(Position, M)> {
        let at = self
            .segments
            .partition_point(|segment| segment.start.ms() <= ms);
        let segment = self.segments.get(at.saturating_sub(1))?;
        let mut steps = 0;
        self.rerun(segment, &mut |machine| {
            let is_within = !machine.is_amid() && machine.ms() <= ms;
            steps += usize::from(is_within);
            is_within
        });
        let mut left = steps;
        self.rerun(segment, &mut |_| {
            left = left.saturating_sub(1);
            left > 0
        })
        .filter(|_| steps > 0)
        .or_else(|| Some((segment.first, segment.start.clone())))
    }

    /// Runs a segment again while each step is followed by another one that is wanted.
    fn rerun(
        &self,
        segment: &Segment<M>,
        goes_on: &mut dyn FnMut(&M) -> bool,
    ) -> Option<(Position, M)> {
        let mut machine = segment.start.clone();
        machine.prepare();
        let mut stops = |_: Position, _: &M, _: Option<(u16, Node)>| false;
        let mut seeker = Seeker {
            next: segment.first,
            until: Position::MAX,
            held: &segment.held,
            stops: &mut stops,
        };
        let is_last = self
            .segments
            .back()
            .is_some_and(|last| std::ptr::eq(last, segment));
        let count = segment.steps.len();
        // A step that is not done yet is the present.
        let whole = match is_last && self.open.is_some() {
            true => count.saturating_sub(1),
            false => count,
        };
        for kept in segment.steps.iter().take(whole) {
            let mut robot = Remembering::new(&kept.answers);
            machine.run_again(kept.begin, &mut robot, &mut seeker);
            if robot.is_astray || !goes_on(&machine) {
                break;
            }
        }
        Some((seeker.next, machine))
    }

    /// Where what a segment has ends.
    fn until(&self, segment: usize) -> Position {
        let next = self.segments.get(segment + 1);
        next.map_or(Position::MAX, |next| next.first)
    }

    /// Runs a segment again until a moment for which `stops` is true, or the one before `until`. What is held, and where.
    fn replay(
        &self,
        segment: usize,
        until: Position,
        stops: Stops<'_, M>,
    ) -> Option<(Position, M)> {
        let mut rerun = self.rerun_of(segment)?;
        let is_held = self.run_on(self.segments.get(segment)?, &mut rerun, until, stops);
        is_held.then(|| (rerun.next - 1, rerun.machine))
    }

    /// The same from where it was left; whether it is held.
    fn run_on(
        &self,
        segment: &Segment<M>,
        rerun: &mut Rerun<M>,
        until: Position,
        stops: Stops<'_, M>,
    ) -> bool {
        let last = self.segments.back();
        let is_last = last.is_some_and(|last| std::ptr::eq(last, segment));
        while let Some(kept) = segment.steps.get(rerun.step) {
            let is_open = is_last && rerun.step + 1 == segment.steps.len();
            let answers = match &self.open {
                Some(open) if is_open => open,
                Some(_) | None => &kept.answers,
            };
            let mut robot = Remembering::after(answers, rerun.read);
            let mut seeker = Seeker {
                next: rerun.next,
                until,
                held: &segment.held,
                stops,
            };
            let machine = &mut rerun.machine;
            machine.run_again(kept.begin, &mut robot, &mut seeker);
            rerun.next = seeker.next;
            if rerun.machine.is_amid() {
                rerun.read = robot.given();
                return true;
            }
            rerun.step += 1;
            rerun.read = 0;
            if robot.is_astray {
                return false;
            }
        }
        false
    }
}

impl<M> Segment<M> {
    /// Copies cost memory, and segments time: a copy comes when running again would take as long as a person sees, and not
    /// before the answers are worth it.
    fn is_full(&self, next: Position) -> bool {
        let blocks = next - self.first;
        let steps = self.steps.len();
        let is_long = steps >= limits::HISTORY_STEPS || blocks >= limits::HISTORY_BLOCKS;
        let is_worth = self.bytes - self.weight >= self.weight / 4;
        let is_too_long =
            steps >= 10 * limits::HISTORY_STEPS || blocks >= 10 * limits::HISTORY_BLOCKS;
        is_long && is_worth || is_too_long
    }

    fn grow(&mut self, bytes: usize, all: &mut usize) {
        self.bytes += bytes;
        *all += bytes;
    }
}

/// Finds a moment while a program runs again.
struct Seeker<'a, M> {
    /// The next moment.
    next: Position,
    until: Position,
    held: &'a BTreeSet<Position>,
    stops: Stops<'a, M>,
}

impl<M> Asked<M> for Seeker<'_, M> {
    fn asked(&mut self, machine: &M, entering: Option<(u16, Node)>) -> Guard {
        if entering.is_none() {
            let is_it = self.next < self.until && (self.stops)(self.next, machine, None);
            return if is_it { Guard::Hold } else { Guard::Go };
        }
        let position = self.next;
        self.next += 1;
        if position >= self.until {
            return Guard::Hold;
        }
        let is_it = (self.stops)(position, machine, entering);
        if is_it || self.next == self.until {
            return Guard::Hold;
        }
        match self.held.contains(&position) {
            true => Guard::HoldThread,
            false => Guard::Go,
        }
    }
}
