//! What the desk tells, as JSON: where a program is, what its variables hold, what its ports gave last, which blocks
//! have reacted.
//!
//! Owns the form, which `docs/protocol.md` describes. Knows no orders.

use super::Tap;
use crate::limits::{TOLD_BYTES, TOLD_CHARACTERS_MAX};
use crate::machine::Machine;
use crate::machine::stops::Stop;
use crate::program::{NodeId, Program, Target};
use lang_diagram::debug::report::{kind, reason};
use lang_diagram::machine::Status;
use lang_text::json::Object;
use lang_text::problem::Locale;
use std::collections::BTreeMap;

/// An object without members.
pub(super) fn object() -> Object {
    Object::new(TOLD_CHARACTERS_MAX)
}

/// An object with a list that takes no more than about [`TOLD_BYTES`], and how much of it is left out, if anything is.
fn listed<T>(
    told: Object,
    name: &str,
    items: impl Iterator<Item = T>,
    told_of: impl Fn(T) -> String,
) -> Object {
    let (mut bytes, mut left_out) = (0, 0);
    let mut list = Vec::new();
    for item in items {
        if bytes > TOLD_BYTES {
            left_out += 1;
            continue;
        }
        let text = told_of(item);
        bytes += text.len();
        list.push(text);
    }
    let told = told.list(name, list);
    match left_out {
        0 => told,
        some => told.plain(&format!("{name}_left_out"), some),
    }
}

/// Where a program is, or was.
pub(super) struct State<'a> {
    /// The word of its state.
    pub word: &'static str,
    pub is_attached: bool,
    /// Whether it runs, also while somebody looks at its past.
    pub status: Status,
    pub machine: &'a Machine,
    /// Where that is stopped.
    pub stop: Option<&'a Stop>,
    pub tap: &'a Tap,
    /// From when on its past is kept, and in how many bytes.
    pub kept: Option<(u32, usize)>,
}

/// Tells where a program is.
pub(super) fn state(state: &State<'_>, locale: Locale) -> String {
    let machine = state.machine;
    let mut told = object()
        .text("state", state.word)
        .plain("ms", machine.now())
        .plain("attached", state.is_attached);
    if let Status::Ended { with_errors, .. } = state.status {
        told = told.plain("with_errors", with_errors);
    }
    if let Some(stop) = state.stop {
        told = told.plain("stop", stopped(machine, stop, locale));
    }
    told = told.list("threads", []);
    told = listed(told, "variables", machine.variables(), |(name, held)| {
        let told = object().text("name", name).text("type", kind(held));
        told.text("value", &held.brief()).done()
    });
    let program = machine.program();
    told = listed(
        told,
        "ports",
        state.tap.ports.iter(),
        |(&(node, port), seen)| {
            let told = place(program, Target { node, port });
            let told = told
                .text("type", seen.kind)
                .text("value", &seen.last.brief());
            told.plain("count", seen.count).done()
        },
    );
    told = listed(
        told,
        "reacted",
        state.tap.reactions.iter(),
        |(&node, count)| block(program, node).plain("count", count).done(),
    );
    told = listed(told, "waiting", waiting(machine), |(at, count, lost)| {
        let told = place(program, at).plain("count", count);
        told.plain("lost", lost).done()
    });
    if let Some((from_ms, bytes)) = state.kept {
        let kept = object().plain("from_ms", from_ms).plain("bytes", bytes);
        told = told.plain("kept", kept.done());
    }
    told.done()
}

/// Ports at which tokens wait or were lost, and how many.
fn waiting(machine: &Machine) -> impl Iterator<Item = (Target, usize, u32)> {
    let lost = machine.dropped();
    let lost: BTreeMap<(NodeId, u8), u32> = lost
        .map(|(at, count)| ((at.node, at.port), count))
        .collect();
    let nodes = (0..).zip(&machine.program().nodes);
    let ports = nodes.flat_map(|(node, block)| {
        let ports = u8::try_from(block.row.ports.len()).unwrap_or(u8::MAX);
        (0..ports).map(move |port| Target { node, port })
    });
    ports.filter_map(move |at| {
        let lost = lost.get(&(at.node, at.port)).copied().unwrap_or_default();
        let count = machine.waiting_at(at);
        (count > 0 || lost > 0).then_some((at, count, lost))
    })
}

/// A port: its block, and its name.
fn place(program: &Program, at: Target) -> Object {
    let name = program.node(at.node).port_name(at.port);
    block(program, at.node).text("port", name)
}

/// A block: its diagram, its id, its type, and its caption; of one in a subprogram, the call too.
fn block(program: &Program, at: NodeId) -> Object {
    let node = program.node(at);
    let instance = &program.instances[node.instance as usize];
    let told = object()
        .text("diagram", &instance.name)
        .text("id", &node.id)
        .text("block", node.row.element)
        .text("caption", &node.caption);
    match instance.caller {
        Some(caller) => told.text("call", &calls(program, caller)),
        None => told,
    }
}

/// The calls that a block runs in, by their captions or else their types, the outermost first.
fn calls(program: &Program, inner: NodeId) -> String {
    let mut names = Vec::new();
    let mut next = Some(inner);
    while let Some(caller) = next {
        let node = program.node(caller);
        names.push(match node.caption.is_empty() {
            true => node.row.element,
            false => &*node.caption,
        });
        next = program.instances[node.instance as usize].caller;
    }
    names.reverse();
    names.join("/")
}

fn stopped(machine: &Machine, stop: &Stop, locale: Locale) -> String {
    let program = machine.program();
    let told = reason(&stop.reason, locale, |node| block(program, node).done());
    let Some((to, token)) = &stop.next else {
        return told.done();
    };
    let at = place(program, *to)
        .text("type", kind(token))
        .text("value", &token.brief());
    told.plain("at", at.done()).done()
}
