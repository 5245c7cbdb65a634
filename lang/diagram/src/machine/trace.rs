//! What a running program tells of itself: for a debugger, a client, a test.
//!
//! Owns the trait. Everything is borrowed and nothing is kept: a caller that wants to keep it does so.

use super::Machine;
use super::view::Waits;
use crate::program::Node;
use lang_expr::Value;
use lang_text::problem::Problem;

/// Hears what happens. Threads are told by a number; [`super::Machine::thread_name`] knows the name.
pub trait Trace {
    /// A thread enters a block. With that it has left the one where it was.
    fn entered(&mut self, _now: u32, _thread: u16, _node: Node) {}

    /// A statement has assigned a variable.
    fn changed(&mut self, _now: u32, _thread: u16, _variable: &str, _value: &Value) {}

    /// Something went wrong.
    fn trap(&mut self, _now: u32, _problem: &Problem) {}

    /// A thread has sent a message to another one. One that waits for it receives it at once.
    fn sent(&mut self, _now: u32, _from: u16, _to: u16, _message: &str) {}

    /// A thread begins.
    fn thread_started(&mut self, _now: u32, _thread: u16, _name: &str) {}

    /// A thread ends.
    fn thread_ended(&mut self, _now: u32, _thread: u16) {}

    /// A thread begins to wait at a block. Only guarded machines tell it.
    fn waits(&mut self, _now: u32, _thread: u16, _node: Node, _for_what: Waits) {}

    /// Whether the machine goes on. Only guarded machines ask, and everything in them can be looked at meanwhile.
    fn guard(&mut self, _machine: &Machine, _at: Moment) -> Guard {
        Guard::Go
    }
}

/// Where a guarded machine asks whether it goes on.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Moment {
    /// A thread is about to enter a block.
    Enters {
        /// The thread.
        thread: u16,
        /// The block.
        node: Node,
    },
    /// A thread has failed in a block, which was told, and is about to end.
    Fails {
        /// The thread.
        thread: u16,
        /// The block.
        node: Node,
    },
    /// No thread runs: between two pieces of a step, and before each step.
    Between,
}

/// What a guarded machine does.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Guard {
    /// It goes on.
    Go,
    /// It is held where it is, until [`Machine::go_on_held`].
    Hold,
    /// This thread alone is held, until [`Machine::release`]; between threads this holds nothing.
    HoldThread,
}

/// Hears nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Deaf;

impl Trace for Deaf {}
