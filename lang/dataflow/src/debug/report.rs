//! What the desk tells, as JSON: where a program is, what its variables hold, what its ports gave last.
//!
//! Owns the form, which `docs/protocol.md` describes. Knows no orders.

use crate::limits::{TOLD_BYTES, TOLD_CHARACTERS_MAX};
use crate::machine::Machine;
use crate::machine::stops::{Reason, Stop};
use crate::program::{NodeId, Program, Target};
use lang_diagram::debug::Spot;
use lang_diagram::machine::Status;
use lang_expr::Value;
use lang_text::json::Object;
use lang_text::problem::{Locale, Problem};
use std::collections::BTreeMap;

/// Ports with their last tokens, and how many there were.
pub(super) type Ports = BTreeMap<(NodeId, u8), (Value, u32)>;

/// An object without members.
pub(super) fn object() -> Object {
    Object::new(TOLD_CHARACTERS_MAX)
}

/// An object with a list that takes no more than about [`TOLD_BYTES`], and how much of it is left out, if anything is.
fn listed(told: Object, name: &str, items: impl Iterator<Item = String>) -> Object {
    let (mut bytes, mut left_out) = (0, 0);
    let mut list = Vec::new();
    for item in items {
        if bytes > TOLD_BYTES {
            left_out += 1;
            continue;
        }
        bytes += item.len();
        list.push(item);
    }
    let told = told.list(name, list);
    match left_out {
        0 => told,
        some => told.plain(&format!("{name}_left_out"), some),
    }
}

/// Where a program is.
pub(super) fn state(
    machine: &Machine,
    (is_attached, ports): (bool, &Ports),
    locale: Locale,
) -> String {
    let status = machine.status();
    let word = match (status, machine.stopped()) {
        (Status::Ended { .. }, _) => "ended",
        (Status::Running, Some(_)) => "stopped",
        (Status::Running, None) => "running",
    };
    let mut told = object()
        .text("state", word)
        .plain("ms", machine.now())
        .plain("attached", is_attached);
    if let Status::Ended { with_errors, .. } = status {
        told = told.plain("with_errors", with_errors);
    }
    if let Some(stop) = machine.stopped() {
        told = told.plain("stop", stopped(machine, stop, locale));
    }
    told = told.list("threads", []);
    let variables = machine.variables().map(|(name, held)| {
        let told = object().text("name", name).text("type", kind(held));
        told.text("value", &held.brief()).done()
    });
    told = listed(told, "variables", variables);
    let program = machine.program();
    let ports = ports.iter().map(|(&(node, port), (last, count))| {
        let told = place(program, Target { node, port });
        let told = told.text("type", kind(last)).text("value", &last.brief());
        told.plain("count", count).done()
    });
    told = listed(told, "ports", ports);
    listed(told, "waiting", waiting(machine).into_iter()).done()
}

/// Ports at which tokens wait or were lost.
fn waiting(machine: &Machine) -> Vec<String> {
    let lost: BTreeMap<(NodeId, u8), u32> = machine
        .dropped()
        .map(|(at, count)| ((at.node, at.port), count))
        .collect();
    let program = machine.program();
    let mut told = Vec::new();
    for (node, block) in (0..).zip(&program.nodes) {
        for port in 0..u8::try_from(block.queues.len()).unwrap_or(u8::MAX) {
            let at = Target { node, port };
            let lost = lost.get(&(node, port)).copied().unwrap_or_default();
            let count = machine.waiting_at(at);
            if count > 0 || lost > 0 {
                let one = place(program, at).plain("count", count);
                told.push(one.plain("lost", lost).done());
            }
        }
    }
    told
}

/// A port: its diagram, its block by caption, id and type, and its name.
fn place(program: &Program, at: Target) -> Object {
    let node = program.node(at.node);
    let instance = &program.instances[node.instance as usize];
    object()
        .text("diagram", &instance.name)
        .text("id", &node.id)
        .text("block", node.row.element)
        .text("caption", &node.caption)
        .text("port", node.port_name(at.port))
}

fn stopped(machine: &Machine, stop: &Stop, locale: Locale) -> String {
    let told = match &stop.reason {
        Reason::Pause => object().text("reason", "pause"),
        Reason::Step => object().text("reason", "step"),
        Reason::Breakpoint(number) => object()
            .text("reason", "breakpoint")
            .plain("number", number),
        Reason::Condition(number, found) => object()
            .text("reason", "condition")
            .plain("number", number)
            .text("text", &problems(found, locale)),
    };
    let at = place(machine.program(), stop.at)
        .text("type", kind(&stop.token))
        .text("value", &stop.token.brief());
    told.plain("at", at.done()).done()
}

/// Problems as a text, a line for each.
fn problems(problems: &[Problem], locale: Locale) -> String {
    let lines = problems.iter().map(|problem| problem.in_locale(locale));
    lines.collect::<Vec<_>>().join("\n")
}

/// The value of an expression, with the word of its type.
pub(super) fn value(value: &Value) -> Object {
    object()
        .text("type", kind(value))
        .text("value", &value.brief())
}

/// Breakpoints after a number.
pub(super) fn points(machine: &Machine, after: u32) -> Object {
    let points = machine.points().filter(|(number, ..)| *number > after);
    let told = points.map(|(number, point, hits)| {
        let told = object().plain("number", number);
        let told = match &point.at {
            Spot::Block(block) => told.text("block", block),
            Spot::Change(variable) => told.text("variable", variable),
        };
        told.text("if", &point.condition)
            .plain("from", point.from_hit)
            .text("log", &point.log)
            .plain("once", point.is_once)
            .plain("disabled", point.is_disabled)
            .plain("hits", hits)
            .done()
    });
    listed(object(), "breakpoints", told)
}

/// The word of a value's type.
fn kind(value: &Value) -> &'static str {
    match value {
        Value::Nil | Value::Unset => "nothing",
        Value::Bool(_) => "bool",
        Value::Int(_) => "int",
        Value::Float(_) => "float",
        Value::Text(_) => "text",
        Value::List(_) => "list",
    }
}
