//! What a robot tells of its programs: that one has started, and how it has ended.
//!
//! Owns the words, for the one who says them and for clients that understand them. Pure.

use std::fmt;

/// What a robot says when a program has started, after `info: `.
pub fn started(name: &str) -> String {
    format!("{name} has started")
}

/// Whether a text says that a program of this name has started.
pub fn is_started(text: &str, name: &str) -> bool {
    text.strip_prefix(name)
        .is_some_and(|rest| rest.starts_with(" has started"))
}

/// Whether a text is [`End::describe`] of a program of this name.
pub fn is_end(text: &str, name: &str) -> bool {
    let ends = [
        " has ended ",
        " has failed ",
        " was killed by ",
        " was stopped ",
    ];
    text.strip_prefix(name)
        .is_some_and(|rest| ends.iter().any(|end| rest.starts_with(end)))
}

/// Why a request of a computer that is not paired is refused, after `error: `.
pub const NOT_PAIRED: &str = "this computer is not paired with the robot: press Enter on the robot within 30 s, then try again";
/// How it begins when an upload was not kept; other reasons begin with its name in quotes.
pub const UPLOAD_FAILED: &str = "the upload failed: ";
/// How it ends when a client is told how many messages it has lost.
pub const SLOW_READER: &str = "this computer reads more slowly than the robot writes";

/// Why nothing is changed while no diagram runs.
pub const NO_DIAGRAM: &str = "no diagram runs";
/// Why nothing is changed while the diagram has not read what came before.
pub const TOO_MUCH: &str = "what came before is not done yet; try again";

/// Why an order to a debugger is not carried out that the program has not answered before its end.
pub const HAS_ENDED: &str = "the program has ended";
/// Why a diagram is not debugged from its beginning.
pub const OVERTAKEN: &str = "it was stopped before it began";
/// Why a diagram is not debugged from its beginning that could not be started; an error says more.
pub const NOT_STARTED: &str = "the program cannot be started";
/// Why a program in another language is not debugged like a diagram.
pub const NO_DEBUGGER: &str = "only diagrams and JavaScript programs have this debugger";
/// Why an order to a program in JavaScript is not carried out.
pub const NOT_IN_JAVASCRIPT: &str = "a JavaScript program can only be paused, continued, and stopped at an error: it has no breakpoints, no steps and shows no variables; let the program print them";
/// Why a program in another language is not run under debugpy.
pub const ONLY_PYTHON: &str = "only programs in Python run under debugpy";
/// Why a request to run a program under debugpy is none.
pub const NO_PORT: &str = "a port is wanted, a blank, and the name of a program";
/// Why a request to run a program under debugpy with a secret is none.
pub const NO_SECRET: &str = "a secret is 1 to 64 letters of a to z and A to Z and digits";
/// How it begins when a program in Python says that it does not reach its debugger.
pub const NO_DEBUGGER_THERE: &str = "the debugger at ";
/// Why a request to debug is none.
pub const NO_TAG: &str = "a request to debug is a number, a blank and an order";
/// What all who debug hear when the diagram has ended, however that came.
pub const GONE: &str = "{\"state\":\"gone\"}";

/// Why a client does not get control of the debugger.
pub fn has_control(who: std::net::SocketAddr) -> String {
    in_control(&who.to_string())
}

/// The same of one that is known by its name.
pub fn in_control(who: &str) -> String {
    format!("{who} is in control")
}

/// The line of a status about the battery: its value with its unit, and how long ago that was.
pub fn battery(value: &str, seconds: u64) -> String {
    format!("battery {value}, {seconds} s ago\n")
}

/// The line of a status about the client that has started or stopped a program last, while it is connected.
pub fn commands(who: std::net::SocketAddr) -> String {
    format!("control {who}\n")
}

/// The line of a status about the client that controls the debugger.
pub fn debugs(who: &str) -> String {
    format!("debugger {}\n", in_control(who))
}

/// What a robot says of a diagram that asks a person while nobody is there, after `info: `.
pub fn nobody_answers(name: &str) -> String {
    format!("{name} asks a person, and nobody is there: trik run {name} in a terminal would answer")
}

/// Why a diagram is not changed by the save of another one.
pub fn other_runs(name: &str) -> String {
    format!("{name} runs; a new version has the name of the diagram that runs")
}

/// What a robot says when a new version of this diagram is in force, or this variable has a new value, after `info: `.
pub fn changed(name: &str, what: &str) -> String {
    format!("{name} is changed: {what}")
}

/// The message when it is not. What ran goes on as it was.
pub fn not_changed(name: &str, why: &str) -> String {
    format!("error: {}", unchanged(name, why))
}

/// What follows `error: ` in [`not_changed`].
pub fn unchanged(name: &str, why: &str) -> String {
    format!("{name} is not changed: {why}")
}

/// Whether a text is [`changed`] or [`unchanged`] about this name, and then which: true for changed.
pub fn is_changed(text: &str, name: &str) -> Option<bool> {
    let rest = text.strip_prefix(name)?;
    if rest.starts_with(" is changed: ") {
        return Some(true);
    }
    rest.starts_with(" is not changed: ").then_some(false)
}

const KILLED_BY: &str = "was killed by ";
/// Of a program that somebody has killed; what may be the system's doing is said of itself.
const FROM_OUTSIDE: &str = "signal 9 (SIGKILL) from outside";
/// Of a program that has ended itself for want of memory: what a program may have, before and after the number.
const SHORT: &str = "perhaps it is too large for the memory of a program, ";
const MIB: &str = " MiB";

/// How a program ended.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum End<'a> {
    /// By itself, and it told of no error.
    Well,
    /// It told of an error.
    Failed,
    /// By itself, with this exit code, which is not 0.
    Code(i32),
    /// By a signal of this name.
    Killed(&'a str),
    /// By the system, which had no memory left.
    Starved,
    /// By itself with SIGABRT, as a diagram does that gets no more memory; a program has at most this number of MiB.
    Short(u64),
    /// By order of somebody.
    Stopped(&'a str),
    /// It did what it may not.
    Greedy(&'a str),
}

impl End<'_> {
    /// Whether the program is to blame.
    pub fn is_failure(self) -> bool {
        !matches!(self, Self::Well | Self::Stopped(_))
    }

    /// The sentence about a program of this name that has run for so long.
    pub fn describe(self, name: &str, seconds: f64) -> String {
        let after = Seconds(seconds);
        match self {
            Self::Well => format!("{name} has ended {after}"),
            Self::Failed => format!("{name} has failed {after}"),
            Self::Code(code) => format!("{name} has failed with exit code {code} {after}"),
            Self::Starved => {
                format!("{name} was killed by SIGKILL {after}: perhaps the memory was short")
            }
            Self::Short(mib) => {
                format!("{name} {KILLED_BY}SIGABRT {after}: {SHORT}{mib}{MIB}")
            }
            Self::Killed("SIGKILL") => format!("{name} {KILLED_BY}{FROM_OUTSIDE} {after}"),
            Self::Killed(signal) => format!("{name} {KILLED_BY}{signal} {after}"),
            Self::Stopped(who) => format!("{name} was stopped by {who} {after}"),
            Self::Greedy(why) => format!("{name} was stopped {after}: {why}"),
        }
    }
}

struct Seconds(f64);

impl fmt::Display for Seconds {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(out, "after {:.1} s", self.0)
    }
}

/// What [`End::describe`] said about the program of this name; None: it is about something else.
pub fn ended<'a>(text: &'a str, name: &str) -> Option<End<'a>> {
    let rest = text.strip_prefix(name)?.strip_prefix(' ')?;
    if let Some(why) = rest.strip_prefix("was stopped after ") {
        return Some(End::Greedy(why.split_once(": ")?.1));
    }
    // The last one: who stopped it may be called so.
    let (what, time) = rest.rsplit_once(" after ")?;
    if !time.starts_with(|c: char| c.is_ascii_digit()) {
        return None;
    }
    match what {
        "has ended" => return Some(End::Well),
        "has failed" => return Some(End::Failed),
        _ => {}
    }
    if let Some(code) = what.strip_prefix("has failed with exit code ") {
        return code.parse().ok().map(End::Code);
    }
    if let Some(signal) = what.strip_prefix(KILLED_BY) {
        let short = time.split_once(SHORT);
        let short = short.and_then(|(_, mib)| mib.strip_suffix(MIB)?.parse().ok());
        return Some(match signal {
            "SIGABRT" => short.map_or(End::Killed(signal), End::Short),
            // Older robots say so of every one.
            "SIGKILL" => End::Starved,
            FROM_OUTSIDE => End::Killed("SIGKILL"),
            signal => End::Killed(signal),
        });
    }
    what.strip_prefix("was stopped by ").map(End::Stopped)
}

/// Instead of the program in [`running`] when there is none.
pub const NONE: &str = "none";

/// The line of a status about the program that runs.
pub fn running(program: &str) -> String {
    format!("program {program}\n")
}

/// The line of a status about the end of the last program.
pub fn last(end: &str) -> String {
    format!("last {end}\n")
}

/// What a status says of programs.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub struct Status<'a> {
    /// The program that runs: its name, and more about it.
    pub runs: Option<&'a str>,
    /// How the last one ended, as [`End::describe`] said it.
    pub last: Option<&'a str>,
}

impl Status<'_> {
    /// Whether the program of this name runs.
    pub fn is_of(&self, name: &str) -> bool {
        let rest = self.runs.and_then(|runs| runs.strip_prefix(name));
        rest.is_some_and(|rest| rest.starts_with(" ("))
    }
}

/// The lines of [`running`] and [`last`] among those of a status.
pub fn status(text: &str) -> Status<'_> {
    let line = |word: &str| text.lines().find_map(|line| line.strip_prefix(word));
    Status {
        runs: line("program ").filter(|program| *program != NONE),
        last: line("last "),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_end_that_is_told_is_understood() {
        for end in [
            End::Well,
            End::Failed,
            End::Code(3),
            End::Code(-1),
            End::Killed("SIGKILL"),
            End::Starved,
            End::Short(256),
            End::Killed("SIGABRT"),
            End::Killed("SIGSEGV"),
            End::Stopped("a client"),
            End::Stopped("the day after 3 s"),
            End::Greedy("it had 70 processes, and 64 are allowed"),
        ] {
            let text = end.describe("a b.js", 1.25);
            assert_eq!(ended(&text, "a b.js"), Some(end), "{text}");
            assert_eq!(ended(&text, "b.js"), None, "{text}");
            assert_eq!(ended(&text, "a"), None, "{text}");
        }
        assert_eq!(
            End::Well.describe("x.js", 1.26),
            "x.js has ended after 1.3 s"
        );
        let text = format!("{}{}", running(NONE), last("x.js has ended after 1.0 s"));
        let idle = Status {
            runs: None,
            last: Some("x.js has ended after 1.0 s"),
        };
        assert_eq!(status(&text), idle);
        assert_eq!(
            status(&running("x.js (Python)")).runs,
            Some("x.js (Python)")
        );
        assert_eq!(status("nonsense"), Status::default());
        let text = running("x.js (Python)");
        assert!(status(&text).is_of("x.js") && !status(&text).is_of("x"));
        for other in [
            "x.js has started",
            "x.js",
            "x.js has ended",
            "x.js has ended after all",
            "x.js has failed with exit code x after 1.0 s",
            "x.js was stopped after 1.0 s",
            "",
        ] {
            assert_eq!(ended(other, "x.js"), None, "{other}");
        }
    }
}
