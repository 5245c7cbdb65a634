//! A look at the past of a program: where somebody stands in it, and how people go back and forth.
//!
//! Owns the rules of going back: which earlier moment a step back or a run back means, and the search for it, which is done
//! in pieces so that it can be given up. What is kept is known in `history`.

use super::again::Again;
use super::history::{History, Look, Position, Ran, Rerun, Seen};
use super::{Points, Reason, Step, words};
use crate::limits;
use crate::program::Node;
use lang_expr::Value;
use lang_text::problem::{Locale, Words};

/// How far somebody goes back.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Back {
    /// A step of the thread at which the program is stopped; of any thread if it is stopped between threads.
    Step(Step),
    /// To the last moment at which a breakpoint would have stopped.
    Continue,
    /// To this time, in milliseconds of the program, between two steps.
    To(u32),
    /// To the first moment that is kept.
    Oldest,
}

/// Why nobody goes back.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum NoBack {
    /// Nothing is kept.
    NotKept,
    /// The program runs: it has to be stopped first.
    Runs,
    /// Nothing before this moment is kept.
    AtOldest,
    /// The program has not come to that time.
    NotYet,
}

impl NoBack {
    /// For a person.
    pub fn in_locale(&self, locale: Locale) -> String {
        let words: Words = match self {
            Self::NotKept => words::not_kept(),
            Self::Runs => words::runs(),
            Self::AtOldest => words::at_oldest(),
            Self::NotYet => words::not_yet(),
        };
        words.in_locale(locale).to_owned()
    }
}

/// A moment of the past at which somebody stands.
#[derive(Clone, Debug)]
pub(super) struct Past<M: Again> {
    pub(super) machine: M,
    pub(super) at: Position,
    pub(super) stop: M::Stop,
}

/// From where somebody goes.
#[derive(Debug)]
pub(super) struct From<'a, M> {
    pub(super) machine: &'a M,
    pub(super) at: Position,
    /// The thread at which it is stopped.
    pub(super) thread: Option<u16>,
}

impl<M: Again> Past<M> {
    fn new(machine: M, at: Position, reason: Reason) -> Self {
        let stop = machine.stop(reason);
        Self { machine, at, stop }
    }
}

/// The program at a time, between two steps.
pub(super) fn at_time<M: Again>(history: &History<M>, ms: u32) -> Option<Past<M>> {
    let (at, machine) = history.at_time(ms)?;
    Some(Past::new(machine, at, Reason::Past))
}

/// The first moment that is kept.
pub(super) fn oldest<M: Again>(history: &History<M>) -> Option<Past<M>> {
    Some(Past::new(
        history.beginning()?,
        history.first(),
        Reason::Oldest,
    ))
}

/// Whether somebody stands at the first moment that is kept, or nothing is.
pub(super) fn is_oldest<M: Again>(history: &History<M>, here: &From<'_, M>) -> bool {
    let is_later = oldest(history).is_some_and(|oldest| {
        let is_at_block = here.thread.is_some() && M::thread_of(&oldest.stop).is_none();
        is_at_block || here.machine.ms() > oldest.machine.ms()
    });
    here.at <= history.first() && !is_later
}

/// In which direction a search goes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Direction {
    Back,
    Forth,
}

/// A search through the past that goes on piece by piece.
#[derive(Clone, Debug)]
pub(super) struct Search<M: Again> {
    /// A step that ends there; without one, breakpoints are looked for.
    step: Option<M::Walk>,
    way: Direction,
    after: Option<Position>,
    before: Position,
    /// The part that is looked through, or comes next.
    part: Option<usize>,
    /// Where it was left, and what variables that are watched held there.
    rerun: Option<Rerun<M>>,
    held: Vec<Option<Value>>,
    /// The last moment of the part so far that is one.
    found: Option<(Position, Reason)>,
}

/// What a piece of a search has come to.
#[derive(Debug)]
#[allow(clippy::large_enum_variant, reason = "pieces are rare")]
pub(super) enum Piece<M: Again> {
    /// It has to be looked further.
    More,
    /// The moment that is meant.
    Found(Past<M>),
    /// There is none in this direction.
    Nothing,
}

impl<M: Again> Search<M> {
    /// For the earlier moment to which a step leads, or before which a breakpoint would have stopped.
    pub(super) fn back(history: &History<M>, from: From<'_, M>, step: Option<Step>) -> Self {
        let last = from.at.checked_sub(1);
        Self {
            step: step.map(|step| from.machine.walk(from.thread, step)),
            way: Direction::Back,
            after: None,
            before: from.at,
            part: last.and_then(|last| history.parts(last).1),
            rerun: None,
            held: Vec::new(),
            found: None,
        }
    }

    /// For the later one; the present comes at `present`.
    pub(super) fn forth(
        history: &History<M>,
        from: From<'_, M>,
        present: Position,
        step: Option<Step>,
    ) -> Self {
        // Between two steps the next block is still to come.
        let after = match from.thread {
            Some(_) => Some(from.at),
            None => from.at.checked_sub(1),
        };
        Self {
            way: Direction::Forth,
            after,
            before: present,
            part: history.parts(from.at).1,
            ..Self::back(history, from, step)
        }
    }

    /// Looks further, for about [`limits::SEARCH_WORK`].
    pub(super) fn piece(&mut self, history: &History<M>, points: &Points) -> Piece<M> {
        let mut work = 0;
        while work < limits::SEARCH_WORK {
            let Some(part) = self.part else {
                return Piece::Nothing;
            };
            let begun = self.rerun.take().or_else(|| {
                let rerun = history.rerun_of(part)?;
                self.held = points.watched(&rerun.machine().seen());
                Some(rerun)
            });
            let Some(mut rerun) = begun else {
                return Piece::Nothing;
            };
            // A part costs something although nothing happens in it.
            work += 1;
            let before = self.before;
            let mut look = Looked {
                search: self,
                points,
                work: &mut work,
            };
            let ran = history.look_through(&mut rerun, before, &mut look);
            match (ran, self.way, &self.found) {
                (Ran::Left, Direction::Forth, Some(_)) | (Ran::Through, _, Some(_)) => {
                    return self.end(history);
                }
                (Ran::Left, Direction::Back | Direction::Forth, _) => self.rerun = Some(rerun),
                (Ran::Through, Direction::Back, None) => self.part = part.checked_sub(1),
                (Ran::Through, Direction::Forth, None) => {
                    let (parts, _) = history.parts(0);
                    self.part = Some(part + 1).filter(|next| *next < parts);
                }
            }
        }
        Piece::More
    }

    fn end(&mut self, history: &History<M>) -> Piece<M> {
        let found = self.found.take();
        let past = found.and_then(|(at, reason)| Some(Past::new(history.at(at)?, at, reason)));
        past.map_or(Piece::Nothing, Piece::Found)
    }

    /// Whether it goes back.
    pub(super) fn is_back(&self) -> bool {
        self.way == Direction::Back
    }
}

/// A search that looks at moments.
struct Looked<'a, M: Again> {
    search: &'a mut Search<M>,
    points: &'a Points,
    work: &'a mut u64,
}

impl<M: Again> Look<M> for Looked<'_, M> {
    fn sees(&mut self, at: Position, machine: &M, entering: Option<(u16, Node)>) -> Seen {
        *self.work += 1;
        let reason = match self.search.step {
            Some(walk) => entering.and_then(|(thread, _)| {
                let is_it = machine.is_end(walk, thread);
                is_it.then_some(Reason::Step)
            }),
            None => self.stops(machine, entering.map(|(_, node)| node)),
        };
        let is_later = self.search.after.is_none_or(|after| at > after);
        if let Some(reason) = reason.filter(|_| is_later) {
            self.search.found = Some((at, reason));
            if self.search.way == Direction::Forth {
                return Seen::Enough;
            }
        }
        match *self.work < limits::SEARCH_WORK {
            true => Seen::On,
            false => Seen::Pause,
        }
    }
}

impl<M: Again> Looked<'_, M> {
    /// Why a breakpoint would have stopped at a moment.
    fn stops(&mut self, machine: &M, node: Option<Node>) -> Option<Reason> {
        let points = self.points;
        if points.has_watches() {
            *self.work += limits::SEARCH_LOOK_WORK;
        }
        let changed = points.stops_at_changes(&mut machine.seen(), &mut self.search.held);
        let node = node.filter(|node| points.is_marked(*node));
        if node.is_some() {
            *self.work += limits::SEARCH_LOOK_WORK;
        }
        changed.or_else(|| points.stops_at(&mut machine.seen_at_block(), node?))
    }
}
