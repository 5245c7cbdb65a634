//! What a client sees of a program that is stopped: threads, calls, variables, sensors.
//!
//! Owns the numbers by which it asks for them. They are good until the program goes on.

use super::words;
use crate::debug::listing::Listing;
use crate::debug::report::{At, Report, State};
use crate::debug::target::{Target, why_not};
use crate::error::Error;
use lang_diagram::debug::order::Order;
use lang_diagram::ports::Port;
use lang_text::problem::Locale;
use serde_json::{Value, json};

/// The text of the diagram, as a source.
pub(super) const SOURCE: u64 = 1;
/// The variables of the program.
const VARIABLES: u64 = 1;
/// The readings that it knows.
const SENSORS: u64 = 2;
/// Of a data-flow program: the last token of each port.
const PORTS: u64 = 3;
/// Frames of one thread.
const FRAMES: u64 = 10_000;

/// The number of a thread for a client: 0 would be none.
pub(super) fn thread_id(number: u64) -> u64 {
    number + 1
}

/// The number that it has for the debugger.
pub(super) fn thread_of(id: u64) -> u64 {
    id.saturating_sub(1)
}

/// Whether a program stops and steps as a whole: a data-flow program, which is shown as one thread because editors know
/// nothing else.
fn is_whole(told: &Report) -> bool {
    told.threads.is_empty() && told.state != State::Ended
}

pub(super) fn threads(told: &Report) -> Value {
    let threads = told.threads.iter();
    let mut threads: Vec<Value> = threads
        .map(|thread| json!({"id": thread_id(thread.number), "name": thread.name}))
        .collect();
    if is_whole(told) {
        threads.push(json!({"id": thread_id(0), "name": "flow"}));
    }
    json!({ "threads": threads })
}

/// The number of the thread at which it is stopped, for a client.
pub(super) fn stopped_thread(told: &Report) -> Option<u64> {
    let stop = told.stop.as_ref().and_then(|stop| stop.thread);
    let number = stop.or(told.thread().map(|thread| thread.number));
    number.or(is_whole(told).then_some(0)).map(thread_id)
}

pub(super) fn stack(
    told: &Report,
    id: u64,
    window: (u64, u64),
    listing: &Listing,
    name: &str,
) -> Value {
    let thread = told
        .threads
        .iter()
        .find(|thread| thread.number == thread_of(id));
    let places: Vec<&At> = thread
        .into_iter()
        .flat_map(|thread| std::iter::once(&thread.at).chain(thread.calls.iter().rev()))
        .chain(told.at().or(by(told)).filter(|_| is_whole(told)))
        .collect();
    let (start, levels) = window;
    let levels = if levels == 0 { FRAMES } else { levels };
    let frames = (0u64..).zip(&places);
    let frames = frames.skip_while(|(index, _)| *index < start);
    let frames = frames.take_while(|(index, _)| *index < start.saturating_add(levels));
    let frames: Vec<Value> = frames
        .map(|(index, at)| {
            json!({
                "id": id * FRAMES + index,
                "name": frame_name(at, listing),
                "line": listing.line_of(&at.id),
                "column": 1,
                "source": source(name),
                "instructionPointerReference": at.id,
            })
        })
        .collect();
    json!({"stackFrames": frames, "totalFrames": places.len()})
}

/// The block that has changed a variable at which it is stopped: nothing may come after it in its instant.
fn by(told: &Report) -> Option<&At> {
    let change = told.stop.as_ref()?.change.as_ref()?;
    change.by.as_ref()
}

/// A call as people see it: the diagram, and the sentence or the type of the block.
fn frame_name(at: &At, listing: &Listing) -> String {
    match listing.has(&at.id) {
        true => {
            let text = listing.text(listing.line_of(&at.id));
            format!("{}: {}", at.diagram, text.trim())
        }
        false => format!("{}: {}", at.diagram, at.block),
    }
}

/// The text of the diagram.
pub(super) fn source(name: &str) -> Value {
    json!({"name": name, "sourceReference": SOURCE, "origin": "trik show"})
}

pub(super) fn scopes(told: &Report, locale: Locale) -> Value {
    let [variables, sensors, ports] = words::scopes(locale);
    let mut scopes = vec![
        json!({"name": variables, "variablesReference": VARIABLES, "expensive": false}),
        json!({"name": sensors, "variablesReference": SENSORS, "expensive": true}),
    ];
    if is_whole(told) {
        scopes.push(json!({"name": ports, "variablesReference": PORTS, "expensive": false}));
    }
    json!({ "scopes": scopes })
}

pub(super) fn variables(
    told: &Report,
    reference: u64,
    target: &mut dyn Target,
) -> Result<Value, Error> {
    let sensors: Vec<&str> = Port::all().filter_map(Port::variable).collect();
    let mut found = Vec::new();
    if reference == VARIABLES {
        let own = told.variables.iter();
        let own = own.filter(|variable| !sensors.contains(&variable.name.as_str()));
        found.extend(own.map(|variable| one(&variable.name, &variable.value, &variable.kind)));
    }
    if reference == PORTS {
        let ports = told.ports.iter();
        found.extend(ports.map(|port| {
            let name = port.full_name();
            json!({"name": name, "value": port.value, "variablesReference": 0})
        }));
    }
    if reference == SENSORS {
        for name in sensors {
            let answer = target.order(&Order::Evaluate(name.into()))?;
            // Those that the program does not read are unknown.
            if why_not(&answer).is_none() {
                found.push(one(name, &word(&answer, "value"), &word(&answer, "type")));
            }
        }
    }
    Ok(json!({ "variables": found }))
}

/// Whether a breakpoint can stop at changes of what has this name, and how the client calls it then.
pub(super) fn data(told: &Report, name: &str) -> Value {
    let mut own = told.variables.iter();
    let is_known = own.any(|variable| variable.name == name)
        || Port::all().any(|port| port.variable() == Some(name));
    match is_known {
        true => json!({
            "dataId": name,
            "description": name,
            "accessTypes": ["write"],
            "canPersist": true,
        }),
        false => {
            let why = format!("'{name}' is no variable that has a value yet");
            json!({"dataId": null, "description": why})
        }
    }
}

fn one(name: &str, value: &str, kind: &str) -> Value {
    json!({"name": name, "value": value, "type": kind, "variablesReference": 0, "evaluateName": name})
}

/// A text in an answer.
pub(super) fn word(answer: &Value, name: &str) -> String {
    let text = answer.get(name).and_then(Value::as_str);
    text.unwrap_or_default().to_owned()
}

/// Names that begin as what is typed ends.
pub(super) fn completions(told: &Report, text: &str, column: u64) -> Value {
    let column = usize::try_from(column.saturating_sub(1)).unwrap_or(usize::MAX);
    let typed: String = text.chars().take(column).collect();
    let is_part = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let begun = typed.rsplit(|c| !is_part(c)).next().unwrap_or_default();
    let own = told.variables.iter().map(|variable| variable.name.clone());
    let sensors = Port::all().filter_map(Port::variable);
    let mut names: Vec<String> = own.chain(sensors.map(str::to_owned)).collect();
    names.sort_unstable();
    names.dedup();
    let fitting = names.iter().filter(|name| name.starts_with(begun));
    let targets: Vec<Value> = fitting
        .map(|name| json!({"label": name, "type": "variable", "length": begun.chars().count()}))
        .collect();
    json!({ "targets": targets })
}
