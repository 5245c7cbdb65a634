//! A look at the past of a program: where somebody stands in it, and how he goes back and forth.
//!
//! Owns the rules of going back: which earlier moment a step back or a run back means. What is kept is known in `history`.

use std::fmt;

use super::history::{History, Position};
use super::{Debugger, Reason, Step, Stop};
use crate::machine::Machine;
use crate::program::Node;

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

impl fmt::Display for NoBack {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::NotKept => "the past of this program is not kept",
            Self::Runs => "the program runs: pause it first",
            Self::AtOldest => "this is the first moment that is kept",
            Self::NotYet => "the program has not come to that time",
        })
    }
}

/// A moment of the past at which somebody stands.
#[derive(Clone, Debug)]
pub(super) struct Past {
    pub(super) machine: Machine,
    pub(super) at: Position,
    pub(super) stop: Stop,
}

/// From where somebody goes.
#[derive(Clone, Copy, Debug)]
pub(super) struct From<'a> {
    pub(super) machine: &'a Machine,
    pub(super) at: Position,
    /// The thread at which it is stopped.
    pub(super) thread: Option<u16>,
}

impl Past {
    fn new(machine: Machine, at: Position, reason: Reason) -> Self {
        let thread = machine.held_thread();
        let node = machine.views().find(|view| Some(view.number) == thread);
        let node = node.map(|view| view.node);
        Self {
            machine,
            at,
            stop: Stop {
                reason,
                thread,
                node,
            },
        }
    }
}

/// The earlier moment that is meant.
pub(super) fn back(
    history: &History,
    debugger: &Debugger,
    from: From<'_>,
    how: Back,
) -> Result<Past, NoBack> {
    if let Back::To(ms) = how {
        let (at, machine) = history.at_time(ms).ok_or(NoBack::NotKept)?;
        return Ok(Past::new(machine, at, Reason::Past));
    }
    if from.at <= history.first() {
        return Err(NoBack::AtOldest);
    }
    let found = match how {
        Back::Step(step) => {
            let mut test = step_test(from, step);
            history.last_before(from.at, &mut test)
        }
        Back::Continue => history.last_before(from.at, &mut |machine, _, node| {
            debugger.is_marked(node) && debugger.stops_at(machine, node).is_some()
        }),
        Back::To(_) | Back::Oldest => None,
    };
    let at = found.unwrap_or(history.first());
    let machine = history.at(at).ok_or(NoBack::NotKept)?;
    let reason = match (found, how) {
        (None, _) => Reason::Oldest,
        (Some(_), Back::Step(_)) => Reason::Step,
        (Some(_), Back::Continue) => stopped(debugger, &machine),
        (Some(_), Back::To(_) | Back::Oldest) => Reason::Past,
    };
    Ok(Past::new(machine, at, reason))
}

/// The later moment of the past that is meant; none if the present comes first.
pub(super) fn forth(
    history: &History,
    debugger: &Debugger,
    from: From<'_>,
    present: Position,
    step: Option<Step>,
) -> Option<Past> {
    // Between two steps the next block is still to come.
    let after = match from.thread {
        Some(_) => Some(from.at),
        None => from.at.checked_sub(1),
    };
    let between = (after, present);
    let (found, is_step) = match step {
        Some(step) => {
            let mut test = step_test(from, step);
            (history.first_between(between, &mut test), true)
        }
        None => {
            let test = &mut |machine: &Machine, _, node| {
                debugger.is_marked(node) && debugger.stops_at(machine, node).is_some()
            };
            (history.first_between(between, test), false)
        }
    };
    let at = found?;
    let machine = history.at(at)?;
    let reason = match is_step {
        true => Reason::Step,
        false => stopped(debugger, &machine),
    };
    Some(Past::new(machine, at, reason))
}

fn stopped(debugger: &Debugger, machine: &Machine) -> Reason {
    let view = machine
        .views()
        .find(|view| Some(view.number) == machine.held_thread());
    let number = view.and_then(|view| debugger.stops_at(machine, view.node));
    number.map_or(Reason::Past, Reason::Breakpoint)
}

/// Whether a moment is one to which a step of this thread leads, in either direction.
fn step_test(from: From<'_>, step: Step) -> impl FnMut(&Machine, u16, Node) -> bool {
    let thread = from.thread;
    let depth = thread.map_or(0, |thread| from.machine.depth(thread));
    move |machine, entering, _| {
        thread.is_none_or(|thread| thread == entering)
            && step.ends_at(machine.depth(entering), depth)
    }
}
