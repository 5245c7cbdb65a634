//! What a running data-flow program tells a program that looks on.
//!
//! Owns the border. Looking changes nothing.

use super::Machine;
use crate::program::{NodeId, Target};
use lang_diagram::brick::Command;
use lang_expr::Value;
use lang_text::problem::Problem;

/// Somebody who looks on; all times are milliseconds since the first step.
pub trait Trace {
    /// A token leaves a linked port.
    fn sent(&mut self, _now: u32, _from: NodeId, _port: u8, _value: &Value) {}
    /// A block reacts.
    fn fired(&mut self, _now: u32, _node: NodeId) {}
    /// A token is lost at a port.
    fn dropped(&mut self, _now: u32, _at: Target) {}
    /// A device is told something.
    fn told(&mut self, _now: u32, _command: &Command<'_>) {}
    /// Something goes wrong, which ends the program.
    fn trap(&mut self, _now: u32, _problem: &Problem) {}
    /// Whether a machine that is run again is held: before the next token on its way, which this node will react to, or
    /// where none reacts.
    fn holds(&mut self, _machine: &Machine, _next: Option<NodeId>) -> bool {
        false
    }
}

/// Nobody looks.
#[derive(Clone, Copy, Debug, Default)]
pub struct Deaf;

impl Trace for Deaf {}
