//! Numbers that an output always gives, and inputs that cannot take them or take them for others.
//!
//! Owns what a motor's power may be. Numbers that are computed are looked at when the program runs.

use super::found::{Found, port_place};
use super::through::Emitted;
use super::words;
use crate::blocks::Kind;
use crate::program::{Act, Flow, Op, Program, Target};
use lang_diagram::ports::{Port, Sort};
use lang_expr::{Source, Value};

/// What a motor takes, in percent.
const FULL_POWER: i32 = 100;

/// A number that does not fit where it comes.
pub(super) fn look(program: &Program, made: Emitted, to: Target, found: &mut Found) {
    let node = program.node(to.node);
    let port = node.row.ports.get(usize::from(to.port));
    if port.is_none_or(|port| port.of != Kind::Whole) {
        return;
    }
    let Some(value) = number(program, made.by) else {
        return;
    };
    let place = || port_place(program, to.node, to.port);
    let rounded = value.to_float().round();
    if rounded.abs() > f64::from(i32::MAX) {
        found.error(place(), crate::words::too_large_number(&value));
    } else if let Some(port) = driven(program, to)
        && let power = rounded as i32
        && let Some(counts) = counts_as(port, power)
    {
        found.warn(place(), words::too_much_power(power, counts));
    }
}

/// What a power counts as that a motor does not have.
pub(super) fn counts_as(port: Port, power: i32) -> Option<i32> {
    let counts = power.clamp(-FULL_POWER, FULL_POWER);
    (port.sort() == Sort::Motor && counts != power).then_some(counts)
}

/// The port of the robot that is told what comes to an input.
fn driven(program: &Program, to: Target) -> Option<Port> {
    /// The first data input of these blocks.
    const DATA: u8 = 2;
    let at = to.port.checked_sub(DATA)?;
    match &program.node(to.node).op {
        Op::Act(Act::Drive { devices, .. }) => devices.get(usize::from(at)).map(|(port, _)| *port),
        Op::Act(Act::WritePort { port, .. }) => Some(*port),
        Op::Act(_) | Op::Flow(_) | Op::Source(_) => None,
    }
}

/// The number that an output always gives.
fn number(program: &Program, by: Target) -> Option<Value> {
    match &program.node(by.node).op {
        Op::Flow(Flow::Constant(value @ (Value::Int(_) | Value::Float(_)))) => Some(value.clone()),
        Op::Flow(Flow::Function { texts, .. }) => {
            let at = usize::from(by.port.checked_sub(3)?) / 2;
            let formula = (*texts.get(at)?)?;
            let text = &program.formulas[formula as usize];
            let source = Source::new(&text.text, text.wanted);
            let last = source.tree().statements().last().copied()?;
            lang_expr::constant(source.tree(), last).map(Value::Float)
        }
        Op::Flow(_) | Op::Source(_) | Op::Act(_) => None,
    }
}
