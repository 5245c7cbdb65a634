//! Where a program is stopped, in sentences for a terminal.
//!
//! Owns the sentences, with the line of the diagram's text if that is known. Knows no target.

pub(crate) mod words;

use super::listing::Listing;
use super::report::{At, Report, State, Stop};
use super::target::words::seconds;
use crate::terminal::harmless;
use lang_text::problem::Locale;
use words::in_locale;

/// The time of the program.
pub(crate) fn time(told: &Report, locale: Locale) -> String {
    let unit = in_locale(locale, seconds());
    format!("{:.2} {unit}", told.ms as f64 / 1000.0)
}

/// Where it is stopped and why, and the block that comes next; nothing if it is not stopped.
pub(crate) fn lines(told: &Report, listing: Option<&Listing>, locale: Locale) -> Vec<String> {
    let Some(stop) = &told.stop else {
        return Vec::new();
    };
    let past = match told.state {
        State::Past => in_locale(locale, words::past()),
        State::Running | State::Searching | State::Stopped | State::Ended => String::new(),
    };
    let thread = match stop.name.as_str() {
        "" => String::new(),
        name => in_locale(locale, words::thread(&harmless(name))),
    };
    let why = why((told, stop), listing, locale);
    let mut lines = vec![format!("{past}{}{thread}: {why}", time(told, locale))];
    lines.extend(told.at().map(|at| place(at, listing, locale)));
    let token = told.at().and_then(|at| at.token.as_ref());
    lines.extend(token.map(|token| {
        let (port, value) = (harmless(&token.full_name()), harmless(&token.value));
        in_locale(locale, words::token(&port, &value))
    }));
    lines
}

/// That it stands still or is looked at in its past, for who only watches, and why; nothing if it runs.
pub(crate) fn standing(told: &Report, listing: Option<&Listing>, locale: Locale) -> Option<String> {
    let why = |told: &Report| {
        let why = told
            .stop
            .as_ref()
            .map(|stop| why((told, stop), listing, locale));
        why.unwrap_or_default()
    };
    let words = match told.state {
        State::Running | State::Ended => return None,
        State::Searching => words::is_searched(),
        State::Stopped => words::is_stopped(&why(told)),
        State::Past => words::is_past(&time(told, locale), &why(told)),
    };
    Some(in_locale(locale, words))
}

/// The same for a line among others, with blocks as people see them; nothing if it is not stopped.
pub(crate) fn in_one_line(told: &Report, locale: Locale) -> Option<String> {
    let mut lines = lines(told, None, locale);
    if let (Some(line), Some(at)) = (lines.get_mut(1), told.at()) {
        *line = short(at, locale);
    }
    let lines: Vec<_> = lines
        .iter()
        .flat_map(|line| line.lines())
        .map(|line| line.trim_start_matches('>').trim())
        .filter(|line| !line.is_empty())
        .collect();
    (!lines.is_empty()).then(|| {
        let stopped = in_locale(locale, words::stopped());
        format!("{stopped} {}", lines.join(", "))
    })
}

/// A place without the id of its block.
fn short(at: &At, locale: Locale) -> String {
    let (diagram, block) = (harmless(&at.diagram), harmless(&at.block));
    let line = |number: &dyn std::fmt::Display| {
        let line = in_locale(locale, words::line());
        format!("{line} {number}")
    };
    match (&at.token, at.line) {
        (Some(token), _) => format!("{diagram}, {}", harmless(&token.block)),
        // What was uploaded as a text has no file.
        (None, Some(number)) if at.diagram.starts_with('<') => line(&number),
        (None, Some(number)) => format!("{diagram} {}", line(&number)),
        (None, None) if at.block.is_empty() => String::new(),
        (None, None) => format!("{diagram}, {block}"),
    }
}

fn why((told, stop): (&Report, &Stop), listing: Option<&Listing>, locale: Locale) -> String {
    let number = stop.number.unwrap_or_default();
    let words = match stop.reason.as_str() {
        "breakpoint" => words::breakpoint(number),
        "condition" => words::condition(number, &harmless(&stop.text)),
        "change" => {
            let change = stop.change.clone().unwrap_or_default();
            let breakpoint = in_locale(locale, words::breakpoint(number));
            let told = format!("{breakpoint}: {}", harmless(&change.sentence(locale)));
            let by = change.by.as_ref();
            return match by.and_then(|at| Some((listing?, at))) {
                Some((listing, at)) if listing.has(&at.id) => {
                    let line = listing.line_of(&at.id);
                    told + &in_locale(locale, words::by_line(line))
                }
                Some(_) | None => told,
            };
        }
        "error" => words::error(&harmless(&stop.text)),
        "pause" | "oldest" if told.ms == 0 => words::first(),
        "oldest" => words::oldest(),
        reason => words::reason(&harmless(reason)),
    };
    in_locale(locale, words)
}

fn place(at: &At, listing: Option<&Listing>, locale: Locale) -> String {
    let (diagram, block) = (harmless(&at.diagram), harmless(&at.block));
    match listing {
        Some(listing) if listing.has(&at.id) => {
            let line = listing.line_of(&at.id);
            format!("> {line:3} {}", listing.text(line))
        }
        Some(_) => in_locale(locale, words::another_runs(&diagram, &block)),
        // Of a data-flow program people know the caption.
        None if let Some(token) = &at.token => {
            format!(">     {diagram}, {}", harmless(&token.block))
        }
        None if at.id.is_empty() => format!(">     {}", short(at, locale)),
        None => format!(">     {diagram}, {block} {}", harmless(&at.id)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn who_only_watches_sees_that_it_stands_still_and_why() {
        let stop = Stop {
            reason: "breakpoint".to_owned(),
            number: Some(2),
            ..Stop::default()
        };
        let told = |state| Report {
            state,
            ms: 1500,
            stop: Some(stop.clone()),
            ..Report::default()
        };
        for (state, expected) in [
            (State::Running, None),
            (State::Ended, None),
            (State::Stopped, Some("stopped by a debugger: breakpoint 2")),
            (
                State::Past,
                Some("stopped, and this is its past as it was at 1.50 s: breakpoint 2"),
            ),
            (
                State::Searching,
                Some("stopped, and a debugger searches its past"),
            ),
        ] {
            let said = standing(&told(state), None, Locale::English);
            assert_eq!(said.as_deref(), expected);
            let russian = standing(&told(state), None, Locale::Russian);
            assert_eq!(russian.is_some(), expected.is_some());
            assert!(russian.is_none_or(|said| !said.is_ascii()), "{state:?}");
        }
    }
}
