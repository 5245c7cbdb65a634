//! What a debugger has told, read from its JSON.
//!
//! Owns the way from the form that `docs/protocol.md` describes to values. What is missing is empty: an older robot may
//! tell less.

use super::stops::words;
use lang_text::problem::Locale;
use serde_json::Value;

/// Where a program is.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Report {
    pub state: State,
    /// Milliseconds since the beginning.
    pub ms: u64,
    pub is_attached: bool,
    pub with_errors: bool,
    pub stop: Option<Stop>,
    pub threads: Vec<Thread>,
    /// Names of the threads that somebody holds alone.
    pub held: Vec<String>,
    pub variables: Vec<Variable>,
    /// Of a data-flow program: the last token of each port, and ports at which tokens wait.
    pub ports: Vec<Port>,
    pub waiting: Vec<Port>,
    /// From when on the past is kept, and how many bytes it takes.
    pub kept: Option<(u64, u64)>,
}

/// What a program does.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub(crate) enum State {
    #[default]
    Running,
    Stopped,
    /// A search through its past goes on.
    Searching,
    /// Somebody looks at its past.
    Past,
    Ended,
}

/// Why it is stopped, and where.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Stop {
    pub reason: String,
    pub number: Option<u64>,
    pub text: String,
    /// The change of a variable that is watched.
    pub change: Option<Change>,
    pub thread: Option<u64>,
    pub name: String,
    pub at: Option<At>,
}

/// A variable that has changed.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Change {
    pub variable: String,
    /// What it held; none: it had no value.
    pub was: Option<String>,
    pub is: Option<String>,
    /// The block that has assigned it, if that is known.
    pub by: Option<At>,
}

/// A block.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct At {
    pub diagram: String,
    pub id: String,
    pub block: String,
    /// Of a program in JavaScript: the line, of the file that `diagram` names.
    pub line: Option<u64>,
    /// Of a data-flow program that is stopped: the port that a token is about to reach, and the token.
    pub token: Option<Port>,
}

/// A port of a data-flow program.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Port {
    /// The calls of subprograms in which it is, with a slash between them; empty in the main diagram.
    pub call: String,
    /// Its block, by the caption or else by the type.
    pub block: String,
    pub name: String,
    /// The token.
    pub value: String,
    /// How many tokens there were, or wait.
    pub count: u64,
    /// How many it has lost.
    pub lost: u64,
}

impl Port {
    /// As an edge names it, after the call in which it is.
    pub(crate) fn full_name(&self) -> String {
        let slash = if self.call.is_empty() { "" } else { "/" };
        format!("{}{slash}{}.{}", self.call, self.block, self.name)
    }
}

/// A thread.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Thread {
    pub number: u64,
    pub name: String,
    pub at: At,
    /// What it does, by its word in the protocol.
    does: String,
    /// For what it waits, and what belongs to that.
    waits_for: String,
    port: String,
    left_ms: u64,
    /// The blocks that call, the outermost first.
    pub calls: Vec<At>,
}

/// A variable.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct Variable {
    pub name: String,
    pub kind: String,
    pub value: String,
}

fn text(value: &Value, name: &str) -> String {
    let found = value.get(name).and_then(Value::as_str);
    found.unwrap_or_default().to_owned()
}

fn number(value: &Value, name: &str) -> Option<u64> {
    value.get(name)?.as_u64()
}

fn truth(value: &Value, name: &str) -> bool {
    value.get(name).and_then(Value::as_bool).unwrap_or_default()
}

fn list<T>(value: &Value, name: &str, read: impl Fn(&Value) -> T) -> Vec<T> {
    let items = value.get(name).and_then(Value::as_array);
    items.into_iter().flatten().map(read).collect()
}

impl Change {
    /// What has changed, for a person.
    pub(crate) fn sentence(&self, locale: Locale) -> String {
        let nothing = words::nothing();
        let held = |text: &'_ Option<String>| match text.as_deref() {
            None => [nothing.english.clone(), nothing.russian.clone()],
            Some("") => ["\"\"".to_owned(), "\"\"".to_owned()],
            Some(text) => [text.to_owned(), text.to_owned()],
        };
        let (was, is) = (held(&self.was), held(&self.is));
        let words = words::was_and_is(&self.variable, [&was[0], &was[1]], [&is[0], &is[1]]);
        words::in_locale(locale, words)
    }
}

impl Thread {
    /// What it does, for a person.
    pub(crate) fn doing(&self, locale: Locale) -> String {
        let words = match (self.does.as_str(), self.waits_for.as_str()) {
            ("waits", "time") => words::waits_more(self.left_ms),
            ("waits", "device") => words::waits_for(&self.port),
            ("waits", what) => words::waits_for(what),
            (does, _) => words::activity(does),
        };
        words::in_locale(locale, words)
    }
}

impl State {
    /// Whether something is to come by itself: a stop, an end, the end of a search.
    pub(crate) fn is_under_way(self) -> bool {
        match self {
            Self::Running | Self::Searching => true,
            Self::Stopped | Self::Past | Self::Ended => false,
        }
    }
}

impl Report {
    /// What a state says; none if it is something else, or a state that is not known here.
    pub(crate) fn read(value: &Value) -> Option<Self> {
        let state = match value.get("state")?.as_str()? {
            "running" => State::Running,
            "stopped" => State::Stopped,
            "searching" => State::Searching,
            "past" => State::Past,
            "ended" => State::Ended,
            // Of a newer robot: whether it runs is not known.
            _ => return None,
        };
        let kept = value.get("kept");
        Some(Self {
            state,
            ms: number(value, "ms").unwrap_or_default(),
            is_attached: truth(value, "attached"),
            with_errors: truth(value, "with_errors"),
            stop: value.get("stop").map(stop),
            threads: list(value, "threads", thread),
            held: list(value, "held", |name| {
                name.as_str().unwrap_or_default().to_owned()
            }),
            variables: list(value, "variables", |variable| Variable {
                name: text(variable, "name"),
                kind: text(variable, "type"),
                value: text(variable, "value"),
            }),
            ports: list(value, "ports", port),
            waiting: list(value, "waiting", port),
            kept: kept.and_then(|kept| Some((number(kept, "from_ms")?, number(kept, "bytes")?))),
        })
    }

    /// Whether it tells of the same moment: how much of the past is kept says nothing of that.
    pub(crate) fn is_same(&self, other: &Self) -> bool {
        let bare = |told: &Self| Self {
            kept: None,
            ..told.clone()
        };
        bare(self) == bare(other)
    }

    /// The thread at which it is stopped, or else the first.
    pub(crate) fn thread(&self) -> Option<&Thread> {
        let number = self.stop.as_ref().and_then(|stop| stop.thread);
        let mut threads = self.threads.iter();
        threads
            .find(|thread| Some(thread.number) == number)
            .or(self.threads.first())
    }

    /// The block that is entered next, or in which it has failed.
    pub(crate) fn at(&self) -> Option<&At> {
        let at = self.stop.as_ref().and_then(|stop| stop.at.as_ref());
        at.or_else(|| Some(&self.thread()?.at))
    }
}

fn at(value: &Value) -> At {
    At {
        diagram: text(value, "diagram"),
        id: text(value, "id"),
        block: text(value, "block"),
        line: None,
        token: value.get("port").map(|_| port(value)),
    }
}

fn port(value: &Value) -> Port {
    let caption = text(value, "caption");
    Port {
        call: text(value, "call"),
        block: match caption.is_empty() {
            true => text(value, "block"),
            false => caption,
        },
        name: text(value, "port"),
        value: text(value, "value"),
        count: number(value, "count").unwrap_or_default(),
        lost: number(value, "lost").unwrap_or_default(),
    }
}

fn stop(value: &Value) -> Stop {
    Stop {
        reason: text(value, "reason"),
        number: number(value, "number"),
        text: text(value, "text"),
        change: value.get("variable").map(|_| Change {
            variable: text(value, "variable"),
            was: value.get("was").map(|_| text(value, "was")),
            is: value.get("is").map(|_| text(value, "is")),
            by: value.get("by").map(at),
        }),
        thread: number(value, "thread"),
        name: text(value, "name"),
        at: value.get("at").map(at),
    }
}

/// Where a thread of a program in JavaScript is.
fn frame(value: &Value) -> Option<At> {
    let frame = value.get("frames")?.get(0)?;
    Some(At {
        diagram: text(frame, "file"),
        line: number(frame, "line"),
        ..At::default()
    })
}

fn thread(value: &Value) -> Thread {
    Thread {
        number: number(value, "number").unwrap_or_default(),
        name: text(value, "name"),
        at: value.get("at").map(at).or(frame(value)).unwrap_or_default(),
        does: text(value, "does"),
        waits_for: text(value, "for"),
        port: text(value, "port"),
        left_ms: number(value, "left_ms").unwrap_or_default(),
        calls: list(value, "calls", at),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn a_state_that_is_not_known_says_nothing() {
        let state = |word: &str| Report::read(&json!({"state": word})).map(|told| told.state);
        assert_eq!(state("running"), Some(State::Running));
        assert_eq!(state("stopped"), Some(State::Stopped));
        assert_eq!(state("searching"), Some(State::Searching));
        assert_eq!(state("past"), Some(State::Past));
        assert_eq!(state("ended"), Some(State::Ended));
        assert_eq!(state("asleep"), None);
        assert_eq!(Report::read(&json!({"control": null})), None);
    }
}
