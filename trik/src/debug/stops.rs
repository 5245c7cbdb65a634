//! Where a program is stopped, in sentences for a terminal.
//!
//! Owns the sentences, with the line of the diagram's text if that is known. Knows no target.

use super::listing::Listing;
use super::told::{At, State, Stop, Told};
use crate::terminal::harmless;

/// The time of the program.
pub(crate) fn time(told: &Told) -> String {
    format!("{:.2} s", told.ms as f64 / 1000.0)
}

/// Where it is stopped and why, and the block that comes next; nothing if it is not stopped.
pub(crate) fn lines(told: &Told, listing: Option<&Listing>) -> Vec<String> {
    let Some(stop) = &told.stop else {
        return Vec::new();
    };
    let past = match told.state {
        State::Past => "past, ",
        State::Running | State::Searching | State::Stopped | State::Ended => "",
    };
    let thread = match stop.name.as_str() {
        "" => String::new(),
        name => format!(", thread {}", harmless(name)),
    };
    let why = why(told, stop, listing);
    let mut lines = vec![format!("{past}{}{thread}: {why}", time(told))];
    lines.extend(told.at().map(|at| place(at, listing)));
    lines
}

fn why(told: &Told, stop: &Stop, listing: Option<&Listing>) -> String {
    let number = stop.number.unwrap_or_default();
    match stop.reason.as_str() {
        "breakpoint" => format!("breakpoint {number}"),
        "condition" => {
            let text = harmless(&stop.text);
            format!("the condition of breakpoint {number}: {text}")
        }
        "change" => {
            let change = stop.change.clone().unwrap_or_default();
            let told = format!("breakpoint {number}: {}", harmless(&change.sentence()));
            let by = change.by.as_ref();
            match by.and_then(|at| Some((listing?, at))) {
                Some((listing, at)) if listing.has(&at.id) => {
                    format!("{told}, by line {}", listing.line_of(&at.id))
                }
                Some(_) | None => told,
            }
        }
        "error" => format!("an error: {}", harmless(&stop.text)),
        "oldest" => "nothing before this is kept".to_owned(),
        "pause" if told.ms == 0 => "before the first block".to_owned(),
        reason => harmless(reason),
    }
}

fn place(at: &At, listing: Option<&Listing>) -> String {
    let (diagram, block) = (harmless(&at.diagram), harmless(&at.block));
    match listing {
        Some(listing) if listing.has(&at.id) => {
            let line = listing.line_of(&at.id);
            format!("> {line:3} {}", listing.text(line))
        }
        Some(_) => {
            format!(">     {diagram}, {block}: this block is not in the file: another diagram runs")
        }
        None => format!(">     {diagram}, {block} {}", harmless(&at.id)),
    }
}
