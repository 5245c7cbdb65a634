//! What a running program tells of itself: for a debugger, a client, a test.
//!
//! Owns the trait. Everything is borrowed and nothing is kept: a caller that wants to keep it does so.

use crate::program::Node;
use lang_expr::Value;
use lang_text::problem::Problem;

/// Hears what happens. Threads are told by a number; [`super::Machine::thread_name`] knows the name.
pub trait Trace {
    /// A thread enters a block.
    fn entered(&mut self, _now: u32, _thread: u16, _node: Node) {}

    /// A statement has assigned a variable.
    fn changed(&mut self, _now: u32, _thread: u16, _variable: &str, _value: &Value) {}

    /// Something went wrong.
    fn trap(&mut self, _now: u32, _problem: &Problem) {}

    /// A thread begins.
    fn thread_started(&mut self, _now: u32, _thread: u16, _name: &str) {}

    /// A thread ends.
    fn thread_ended(&mut self, _now: u32, _thread: u16) {}
}

/// Hears nothing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Deaf;

impl Trace for Deaf {}
