//! What a debugger tells, as JSON: where a program is, what its threads do, what its variables hold.
//!
//! Owns the form, which `docs/protocol.md` describes. Knows no transport.

use super::{Breakpoint, Phase, Points, Reason, Session, Spot, Stop};
use crate::limits;
use crate::machine::Machine;
use crate::machine::view::{Doing, ThreadView, Waits};
use crate::program::Node;
use lang_expr::Value;
use lang_text::json::{Object, quoted};
use lang_text::problem::{Locale, Problem};

/// The first of these that take no more than about so many bytes.
pub(super) fn bounded(items: impl Iterator<Item = String>, bytes_max: usize) -> Vec<String> {
    let mut bytes = 0;
    let mut told = Vec::new();
    for item in items {
        bytes += item.len();
        told.push(item);
        if bytes > bytes_max {
            break;
        }
    }
    told
}

/// An object with a list, and how much of it is left out, if anything is.
fn listed(told: Object, name: &str, (items, all): (Vec<String>, usize)) -> Object {
    let left_out = all - items.len();
    let told = told.list(name, items);
    match left_out {
        0 => told,
        some => told.plain(&format!("{name}_left_out"), some),
    }
}

fn object() -> Object {
    Object::new(limits::TOLD_CHARACTERS_MAX)
}

/// Where a program is: its state, why it is stopped, threads, variables, and from when on the past is kept.
pub fn state(session: &Session, locale: Locale) -> String {
    let machine = session.machine();
    let phase = session.phase();
    let word = match (&phase, session.is_past()) {
        _ if session.is_searching() => "searching",
        (_, true) => "past",
        (Phase::Runs, false) => "running",
        (Phase::Stopped(_), false) => "stopped",
        (Phase::Ended { .. }, false) => "ended",
    };
    let mut told = object().text("state", word).plain("ms", machine.now());
    told = told.plain("attached", session.is_attached());
    if let Phase::Ended { with_errors, .. } = phase {
        told = told.plain("with_errors", with_errors);
    }
    if let Some(stop) = session.stop() {
        told = told.plain("stop", stopped(machine, stop, locale));
    }
    let threads = machine.views().map(|view| thread(machine, &view));
    let threads = bounded(threads, limits::TOLD_THREADS_BYTES);
    told = listed(told, "threads", (threads, machine.views().count()));
    let held: Vec<_> = session.held().collect();
    if !held.is_empty() {
        let names = held.iter();
        let names = names.map(|name| quoted(name, limits::TOLD_CHARACTERS_MAX));
        let names = bounded(names, limits::TOLD_THREADS_BYTES);
        told = listed(told, "held", (names, held.len()));
    }
    let all = machine.variables().count();
    told = listed(told, "variables", (variables(machine), all));
    if let Some((from_ms, bytes)) = session.kept() {
        let kept = object().plain("from_ms", from_ms).plain("bytes", bytes);
        told = told.plain("kept", kept.done());
    }
    told.done()
}

/// The value of an expression, with the word of its type.
pub fn value(value: &Value) -> Object {
    object()
        .text("type", kind(value))
        .text("value", &shown(value))
}

/// Lines that breakpoints have written, and how many were lost; nothing if there are none.
pub fn log((lines, lost): (Vec<String>, u32)) -> Option<String> {
    if lines.is_empty() && lost == 0 {
        return None;
    }
    let all = lines.len();
    let lines = lines.iter();
    let lines = lines.map(|line| quoted(line, limits::TOLD_CHARACTERS_MAX));
    let told = bounded(lines, limits::TOLD_LINES_BYTES);
    let lost = lost as usize + all - told.len();
    Some(object().list("log", told).plain("lost", lost).done())
}

/// Breakpoints with their numbers, and how often each was hit: those after a number.
pub fn breakpoints(points: &Points, after: u32) -> Object {
    let points = || points.all().filter(move |(number, ..)| *number > after);
    let told = bounded(points().map(breakpoint), limits::TOLD_VARIABLES_BYTES);
    listed(object(), "breakpoints", (told, points().count()))
}

fn breakpoint((number, point, hits): (u32, &Breakpoint, u32)) -> String {
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
}

/// Problems as a text, a line for each.
pub fn problems(problems: &[Problem], locale: Locale) -> String {
    let lines = problems.iter().map(|problem| problem.in_locale(locale));
    lines.collect::<Vec<_>>().join("\n")
}

fn stopped(machine: &Machine, stop: &Stop, locale: Locale) -> String {
    let mut told = reason(&stop.reason, locale, |node| place(machine, node));
    if let Some(thread) = stop.thread {
        told = told.plain("thread", thread);
        told = told.text("name", machine.thread_name(thread).unwrap_or_default());
    }
    if let Some(node) = stop.node {
        told = told.plain("at", place(machine, node));
    }
    told.done()
}

/// Why a program is stopped; `place` tells of a block.
pub fn reason(reason: &Reason, locale: Locale, place: impl FnOnce(Node) -> String) -> Object {
    let told = object();
    match reason {
        Reason::Pause => told.text("reason", "pause"),
        Reason::Step => told.text("reason", "step"),
        Reason::ThreadEnded => told.text("reason", "thread ended"),
        Reason::Breakpoint(number) => told.text("reason", "breakpoint").plain("number", number),
        Reason::Changed(change) => {
            let mut told = told
                .text("reason", "change")
                .plain("number", change.number)
                .text("variable", &change.variable);
            for (name, value) in [("was", &change.was), ("is", &change.is)] {
                if let Some(value) = value {
                    told = told.text(name, &shown(value));
                }
            }
            match change.by {
                Some(node) => told.plain("by", place(node)),
                None => told,
            }
        }
        Reason::Condition(number, found) => told
            .text("reason", "condition")
            .plain("number", number)
            .text("text", &problems(found, locale)),
        Reason::Error(problem) => told
            .text("reason", "error")
            .text("text", &problem.in_locale(locale)),
        Reason::Oldest => told.text("reason", "oldest"),
        Reason::Past => told.text("reason", "past"),
    }
}

fn thread(machine: &Machine, view: &ThreadView<'_>) -> String {
    let told = object()
        .plain("number", view.number)
        .text("name", view.name)
        .plain("at", place(machine, view.node));
    let told = match view.doing {
        Doing::Enters => told.text("does", "enters"),
        Doing::GivesWay => told.text("does", "gives way"),
        Doing::Held => told.text("does", "held"),
        Doing::Failed => told.text("does", "failed"),
        Doing::Waits(waits) => waiting(told.text("does", "waits"), waits),
    };
    let calls = view.calls.iter().map(|node| place(machine, *node));
    let calls = bounded(calls, limits::TOLD_CALLS_BYTES);
    listed(told, "calls", (calls, view.calls.len()))
        .plain("messages", view.messages)
        .done()
}

fn waiting(told: Object, waits: Waits) -> Object {
    match waits {
        Waits::Time { left_ms } => told.text("for", "time").plain("left_ms", left_ms),
        Waits::Device(port) => told.text("for", "device").text("port", port.name()),
        Waits::AnyButton => told.text("for", "button"),
        Waits::Mail => told.text("for", "mail"),
        Waits::Answer => told.text("for", "answer"),
        Waits::Message => told.text("for", "message"),
        Waits::Threads => told.text("for", "threads"),
        Waits::Step => told.text("for", "step"),
        Waits::Nothing => told.text("for", "nothing"),
    }
}

/// A block: its diagram, its id in the save, and its type there.
fn place(machine: &Machine, node: Node) -> String {
    let program = machine.program();
    object()
        .text("diagram", program.diagram(node).unwrap_or_default())
        .text("id", program.id(node).unwrap_or_default())
        .text("block", program.row(node).map_or("", |row| row.kind))
        .done()
}

fn variables(machine: &Machine) -> Vec<String> {
    let told = machine.variables().map(|(name, held)| {
        let told = object().text("name", name).text("type", kind(held));
        told.text("value", &held.brief()).done()
    });
    bounded(told, limits::TOLD_VARIABLES_BYTES)
}

/// The word of a value's type.
pub fn kind(value: &Value) -> &'static str {
    match value {
        Value::Nil | Value::Unset => "nothing",
        Value::Bool(_) => "bool",
        Value::Int(_) => "int",
        Value::Float(_) => "float",
        Value::Text(_) => "text",
        Value::List(_) => "list",
    }
}

/// A value as an answer has it; a list in short.
fn shown(value: &Value) -> String {
    match value {
        Value::List(_) => value.brief(),
        Value::Nil
        | Value::Unset
        | Value::Bool(_)
        | Value::Int(_)
        | Value::Float(_)
        | Value::Text(_) => value.printed().to_string(),
    }
}
