//! Where a running program stops for somebody who looks: before a token reaches a block that will react to it.
//!
//! Owns breakpoints and steps. A program that is stopped is within an instant: what it has told motors in this instant is
//! done only when the instant is over. Knows no orders and no words of a protocol.

use super::aside::Nobody;
use super::{Machine, words};
use crate::limits;
use crate::program::{Flow, Op, Target};
use lang_diagram::debug::{Breakpoint, Spot};
use lang_expr::Value;
use lang_text::problem::{Problem, Words};
use std::collections::BTreeMap;

/// Why a program has stopped.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Reason {
    /// Somebody has asked for it: between two instants.
    Pause,
    /// A step is done.
    Step,
    /// The breakpoint with this number.
    Breakpoint(u32),
    /// The condition of this breakpoint cannot be computed.
    Condition(u32, Vec<Problem>),
}

/// A program that is stopped.
#[derive(Clone, Debug)]
pub struct Stop {
    /// Why.
    pub reason: Reason,
    /// The token that comes next, and the port that it is about to reach; none: the program is between two instants.
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

/// Why there is no breakpoint.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum NoPoint {
    /// The program has no such block.
    NoSuchBlock,
    /// There are [`limits::BREAKPOINTS_MAX`].
    TooMany,
    /// Its condition is longer than such texts may be.
    TooLong,
    /// Its condition can never be computed.
    Condition(Vec<Problem>),
    /// What it is asked for does not exist here.
    Cannot(Words),
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

/// A breakpoint, and how often it was hit.
#[derive(Clone, Debug)]
struct Point {
    point: Breakpoint,
    hits: u32,
}

/// Breakpoints and steps of a program.
#[derive(Clone, Debug, Default)]
pub(super) struct Stops {
    points: BTreeMap<u32, Point>,
    /// The number of the newest one.
    last: u32,
    wish: Wish,
    stopped: Option<Stop>,
    /// The token before which it was stopped goes on.
    may_pass: bool,
}

impl Stops {
    /// Whether each token has to be looked at.
    pub(super) fn is_armed(&self) -> bool {
        let steps = match self.wish {
            Wish::None | Wish::Pause => false,
            Wish::Step | Wish::After(_) => true,
        };
        self.may_pass || steps || !self.points.is_empty()
    }

    /// Stops between two instants, if somebody has asked for it.
    pub(super) fn pause_now(&mut self) {
        if self.wish == Wish::Pause && self.stopped.is_none() {
            self.wish = Wish::None;
            self.stopped = Some(Stop {
                reason: Reason::Pause,
                next: None,
            });
        }
    }

    /// The program has ended.
    pub(super) fn forget(&mut self) {
        self.stopped = None;
        self.wish = Wish::None;
        self.may_pass = false;
    }
}

impl Machine {
    /// Where it is stopped, if it is.
    pub fn stopped(&self) -> Option<&Stop> {
        self.stops.stopped.as_ref()
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
        let stop = self.stops.stopped.take();
        self.stops.may_pass |= stop.is_some_and(|stop| stop.next.is_some());
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
        self.stops.points.clear();
        self.go_on();
    }

    /// Adds a breakpoint; its number.
    ///
    /// # Errors
    /// [`NoPoint`].
    pub fn add_point(&mut self, point: Breakpoint) -> Result<u32, NoPoint> {
        let Spot::Block(id) = &point.at else {
            return Err(NoPoint::Cannot(words::only_blocks()));
        };
        if !point.log.is_empty() {
            return Err(NoPoint::Cannot(words::no_log()));
        }
        let mut nodes = self.program.nodes.iter();
        let Some(node) = nodes.find(|node| *node.id == **id) else {
            return Err(NoPoint::NoSuchBlock);
        };
        if let Op::Source(_) = node.op
            && node.linked == 0
        {
            return Err(NoPoint::Cannot(words::starts_by_itself()));
        }
        if let Op::Flow(Flow::InPort) = node.op {
            return Err(NoPoint::Cannot(words::only_passes()));
        }
        if point.condition.len() > lang_diagram::limits::CONDITION_MAX {
            return Err(NoPoint::TooLong);
        }
        if !point.condition.is_empty() {
            let checked = self.formulas.check_condition(&point.condition);
            checked.map_err(NoPoint::Condition)?;
        }
        if self.stops.points.len() >= limits::BREAKPOINTS_MAX {
            return Err(NoPoint::TooMany);
        }
        self.stops.last = self.stops.last.wrapping_add(1);
        self.stops
            .points
            .insert(self.stops.last, Point { point, hits: 0 });
        Ok(self.stops.last)
    }

    /// Takes a breakpoint away, or all; whether there was one.
    pub fn clear_points(&mut self, number: Option<u32>) -> bool {
        match number {
            Some(number) => self.stops.points.remove(&number).is_some(),
            None => !std::mem::take(&mut self.stops.points).is_empty(),
        }
    }

    /// Lets a breakpoint stop or not; whether there is one.
    pub fn enable_point(&mut self, number: u32, is_enabled: bool) -> bool {
        let found = self.stops.points.get_mut(&number);
        found.is_some_and(|found| {
            found.point.is_disabled = !is_enabled;
            true
        })
    }

    /// Breakpoints with their numbers, and how often each was hit.
    pub fn points(&self) -> impl Iterator<Item = (u32, &Breakpoint, u32)> {
        let all = self.stops.points.iter();
        all.map(|(&number, held)| (number, &held.point, held.hits))
    }

    /// What is asked of the program that a new version takes over.
    pub(super) fn take_stops(&mut self, old: &Self) {
        self.stops = old.stops.clone();
        let is_there = |id: &str| self.program.nodes.iter().any(|node| *node.id == *id);
        self.stops.points.retain(|_, held| match &held.point.at {
            Spot::Block(id) => is_there(id),
            Spot::Change(_) => false,
        });
    }

    /// Where it is stopped, in the new version: if the token that comes next is gone, so is the rest of its instant.
    pub(super) fn move_stop(&mut self, is_next_there: bool) {
        self.stops.may_pass &= is_next_there;
        let next = self.deliveries.front().cloned();
        if let Some(stop) = &mut self.stops.stopped
            && stop.next.is_some()
        {
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

    /// Whether the program stops before a token that is the next one.
    pub(super) fn stops_before(&mut self, to: Target, token: &Value) -> bool {
        if std::mem::take(&mut self.stops.may_pass) || !self.would_react(to) {
            return false;
        }
        let wished = match self.stops.wish {
            Wish::None | Wish::Pause => None,
            Wish::Step => Some(Reason::Step),
            Wish::After(moment) => (self.now > moment).then_some(Reason::Step),
        };
        let Some(reason) = wished.or_else(|| self.hit(to, token)) else {
            return false;
        };
        self.stops.wish = Wish::None;
        self.stops.stopped = Some(Stop {
            reason,
            next: Some((to, token.clone())),
        });
        true
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

    /// The breakpoint that a token hits.
    fn hit(&mut self, to: Target, token: &Value) -> Option<Reason> {
        let program = self.program.clone();
        let id = &*program.node(to.node).id;
        let mut nobody = Nobody::at(self.now);
        let mut found = None;
        for (&number, held) in &mut self.stops.points {
            let is_here = matches!(&held.point.at, Spot::Block(block) if **block == *id);
            if !is_here || held.point.is_disabled || found.is_some() {
                continue;
            }
            let holds = match &*held.point.condition {
                "" => Ok(true),
                text => self.formulas.holds(text, token, &mut nobody),
            };
            match holds {
                Ok(_) if nobody.is_asked => {
                    let why = vec![Problem::error(words::asks_the_robot())];
                    found = Some(Reason::Condition(number, why));
                }
                Ok(true) => {
                    held.hits = held.hits.saturating_add(1);
                    if held.hits >= held.point.from_hit {
                        found = Some(Reason::Breakpoint(number));
                    }
                }
                Ok(false) => {}
                Err(why) => found = Some(Reason::Condition(number, why)),
            }
        }
        if let Some(Reason::Breakpoint(number)) = found
            && self
                .stops
                .points
                .get(&number)
                .is_some_and(|held| held.point.is_once)
        {
            self.stops.points.remove(&number);
        }
        found
    }
}
