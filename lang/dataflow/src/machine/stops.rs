//! Where a running program stops for somebody who looks: before a token reaches a block that will react to it, or after
//! a variable has changed that is watched.
//!
//! Owns breakpoints and steps. A program that is stopped is within an instant: what it has told motors in this instant is
//! done only when the instant is over. Knows no orders and no words of a protocol.

use super::Machine;
use super::subject::{Here, Texts};
use super::trace::Trace;
use crate::lower::DATA;
use crate::program::{NodeId, Target};
use lang_diagram::debug::{Breakpoint, NoBreakpoint, Points, Position, Reason};
use lang_expr::Value;

/// A program that is stopped.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Why.
    pub reason: Reason,
    /// The token that comes next, and the port that it is about to reach; none: no token is on its way.
    pub next: Option<(Target, Value)>,
}

/// How far a step goes.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Step {
    /// To the next reaction.
    Reaction,
    /// To the first reaction of a later instant.
    Instant,
}

/// What is waited for beside breakpoints.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
enum Wish {
    #[default]
    None,
    Pause,
    Step,
    /// The first reaction after this moment.
    After(u32),
}

/// Breakpoints and steps of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Stops {
    points: Points,
    wish: Wish,
    stopped: Option<Stop>,
    /// The token before which it was stopped last was looked at then, and goes on.
    may_pass: bool,
    /// It was counted too.
    is_counted: bool,
    /// Tokens so far before which a block was about to react.
    reached: Position,
    /// Its past is kept, so that each token is counted.
    is_kept: bool,
    /// It is a copy that is run again: only the trace holds it.
    is_again: bool,
    /// The block that has reacted since variables were looked at.
    by: Option<NodeId>,
}

impl Stops {
    /// Whether each token has to be looked at.
    pub(super) fn is_armed(&self) -> bool {
        let steps = match self.wish {
            Wish::None | Wish::Pause => false,
            Wish::Step | Wish::After(_) => true,
        };
        self.is_kept || self.is_again || self.may_pass || steps || !self.points.is_empty()
    }

    /// Stops between two instants, if somebody has asked for it.
    pub(super) fn pause_now(&mut self) {
        if self.wish == Wish::Pause && self.stopped.is_none() {
            self.stop(Reason::Pause, None, false);
        }
    }

    /// Stops before a token that was looked at, and counted if a block is about to react to it.
    fn stop(&mut self, reason: Reason, next: Option<(Target, Value)>, is_counted: bool) {
        self.wish = Wish::None;
        self.may_pass = next.is_some();
        self.is_counted = is_counted;
        self.stopped = Some(Stop { reason, next });
    }

    /// The program has ended.
    pub(super) fn forget(&mut self) {
        self.stopped = None;
        self.wish = Wish::None;
        self.may_pass = false;
        self.is_counted = false;
    }
}

impl Machine {
    /// Where it is stopped, if it is.
    pub fn stopped(&self) -> Option<&Stop> {
        self.stops.stopped.as_ref()
    }

    /// The token that comes next, if the program is stopped before one and this is its name.
    pub(super) fn next_token(&self, name: &str) -> Option<&Value> {
        let next = self.stopped()?.next.as_ref();
        next.filter(|_| DATA.contains(&name))
            .map(|(_, token)| token)
    }

    /// That token is another one.
    pub(super) fn change_next(&mut self, token: &Value) {
        let stop = self.stops.stopped.as_mut();
        let shown = stop.and_then(|stop| stop.next.as_mut());
        if let (Some((_, shown)), Some((_, next))) = (shown, self.deliveries.front_mut()) {
            shown.clone_from(token);
            next.clone_from(token);
        }
    }

    /// Stops before the next instant.
    pub fn pause(&mut self) {
        if self.stopped().is_none() {
            self.stops.wish = Wish::Pause;
        }
    }

    /// Goes on at the next step of the caller.
    pub fn go_on(&mut self) {
        self.stops.wish = Wish::None;
        self.stops.stopped = None;
    }

    /// Goes on for a step.
    pub fn walk(&mut self, step: Step) {
        self.go_on();
        self.stops.wish = match step {
            Step::Reaction => Wish::Step,
            Step::Instant => Wish::After(self.now),
        };
    }

    /// Goes on without any breakpoint.
    pub fn let_go(&mut self) {
        self.stops.points = self.stops.points.without_all();
        self.go_on();
    }

    /// Adds a breakpoint; its number.
    ///
    /// # Errors
    /// [`NoBreakpoint`].
    pub fn add_point(&mut self, point: Breakpoint) -> Result<u32, NoBreakpoint> {
        self.look(None, |points, here| points.add(here, point))
    }

    /// Whether its past is kept.
    pub fn set_kept(&mut self, is_kept: bool) {
        self.stops.is_kept = is_kept;
    }

    /// Whether the next step of the caller runs anything.
    pub fn runs_next(&self) -> bool {
        let is_paused = self.stops.wish == Wish::Pause && !self.is_amid;
        self.stopped().is_none() && self.ended.is_none() && !is_paused
    }

    /// The moment at which it is: how many tokens came before, to which a block was about to react.
    pub fn moment(&self) -> Position {
        // One that was counted when it came is still to come.
        let is_counted = self.stopped().is_some() && self.stops.is_counted;
        self.stops.reached.saturating_sub(is_counted.into())
    }

    /// How many tokens have come so far to which a block was about to react.
    pub fn reached(&self) -> Position {
        self.stops.reached
    }

    /// A copy that is to be run again.
    pub(super) fn run_only_again(&mut self) {
        self.stops = Stops {
            is_again: true,
            may_pass: self.stops.may_pass,
            is_counted: self.stops.is_counted,
            stopped: self.stops.stopped.take(),
            ..Stops::default()
        };
    }

    /// The breakpoints.
    pub fn points(&self) -> &Points {
        &self.stops.points
    }

    /// The same, to be changed.
    pub fn points_mut(&mut self) -> &mut Points {
        &mut self.stops.points
    }

    /// Somebody else than the program has changed variables.
    pub(super) fn look_again(&mut self) {
        self.look(None, |points, here| points.look(here));
    }

    /// Does something with breakpoints and the program as they see it.
    fn look<T>(
        &mut self,
        token: Option<&Value>,
        job: impl FnOnce(&mut Points, &mut Here<'_>) -> T,
    ) -> T {
        let mut here = Here {
            program: &self.program,
            formulas: Texts::Own(&mut self.formulas),
            now: self.now,
            token,
        };
        job(&mut self.stops.points, &mut here)
    }

    /// What is asked of the program that a new version takes over.
    pub(super) fn take_stops(&mut self, old: &Self) {
        self.stops = old.stops.clone();
        // A node of the old version.
        self.stops.by = None;
        self.look(None, |points, here| {
            points.bind(here);
            points.look(here);
        });
    }

    /// Where it is stopped, in the new version. If the token that comes next is gone, the other ones go on, and the first of
    /// them is still to be looked at. So is one to which no block was about to react: in the new version one may be.
    /// `moved` is what has become of a block.
    pub(super) fn move_stop(
        &mut self,
        is_next_there: bool,
        moved: impl Fn(NodeId) -> Option<NodeId>,
    ) {
        self.stops.is_counted &= is_next_there;
        self.stops.may_pass &= self.stops.is_counted;
        let next = self.deliveries.front().cloned();
        let Some(stop) = &mut self.stops.stopped else {
            return;
        };
        if let Reason::Changed(change) = &mut stop.reason {
            change.by = change.by.and_then(moved);
        }
        if stop.next.is_some() {
            stop.next = next;
            if !is_next_there {
                stop.reason = Reason::Pause;
            }
        }
    }

    /// Whether it is within an instant that goes on later.
    pub(super) fn take_instant(&mut self, old: &Self) {
        self.is_amid = old.is_amid;
        self.firings = old.firings;
    }

    /// Whether the program stops before the next token, or at the end of an instant, whose last reaction may have changed
    /// a variable.
    pub(super) fn stops_here(&mut self, trace: &mut dyn Trace) -> bool {
        let next = self.deliveries.front().cloned();
        let is_passing = std::mem::take(&mut self.stops.may_pass);
        let reacts = next.as_ref().is_some_and(|(to, _)| self.would_react(*to));
        if !(is_passing && next.is_some()) {
            self.stops.reached += Position::from(reacts);
            let node = next.as_ref().filter(|_| reacts).map(|(to, _)| to.node);
            let reason = match self.stops.is_again {
                true => trace.holds(self, node).then_some(Reason::Past),
                false => self.met(node, next.as_ref()),
            };
            if let Some(reason) = reason {
                self.stops.stop(reason, next, reacts);
                return true;
            }
        }
        self.stops.by = next.map(|(to, _)| to.node);
        false
    }

    /// Why it stops before a token, which a node will react to.
    fn met(&mut self, node: Option<NodeId>, next: Option<&(Target, Value)>) -> Option<Reason> {
        // Both have to count their hits.
        let changed = self.changed();
        let Some(node) = node else {
            return changed;
        };
        let token = next.map(|(_, token)| token);
        let hit = match self.stops.points.is_marked(node) {
            true => self.look(token, |points, here| points.at_block(here, node)),
            false => None,
        };
        let is_wished = match self.stops.wish {
            Wish::None | Wish::Pause => false,
            Wish::Step => true,
            Wish::After(moment) => self.now > moment,
        };
        changed.or(hit).or(is_wished.then_some(Reason::Step))
    }

    /// The change of a variable that is watched, since the last look.
    fn changed(&mut self) -> Option<Reason> {
        let by = self.stops.by.take();
        match self.stops.points.has_watches() {
            true => self.look(None, |points, here| points.at_changes(here, |_| by)),
            false => None,
        }
    }

    /// Whether a token makes its block react: one that waits for several may lack another one.
    fn would_react(&self, to: Target) -> bool {
        let node = self.program.node(to.node);
        let waits = !node.queues.is_empty() && node.data & (1 << to.port) != 0;
        let queues = &self.queues[to.node as usize];
        !waits
            || (0..queues.len())
                .filter(|port| node.data & (1 << port) != 0 && *port != usize::from(to.port))
                .all(|port| !queues[port].is_empty())
    }
}
