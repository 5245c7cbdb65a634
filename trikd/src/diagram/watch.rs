//! What a running diagram tells of itself: which block each thread is at, and what variables hold.
//!
//! Owns the two forms: a line for people, and a JSON object for programs. Told at most every [`limits::WATCH_MS`], and only
//! while somebody looks; errors are always told at once.

use super::source::Source;
use crate::host::Host;
use crate::limits;
use lang_dataflow::diary::Diary;
use lang_diagram::machine::Machine;
use lang_diagram::machine::trace::Trace;
use lang_diagram::machine::view::Doing;
use lang_diagram::program::Node;
use lang_expr::Value;
use lang_text::json::{self, Object};
use lang_text::problem::{Locale, Problem, Severity};
use std::collections::BTreeSet;
use std::fmt::Write;
use std::io;

/// Hears a machine and tells of it.
pub struct Watch {
    locale: Locale,
    is_wanted: bool,
    /// Everything is told next time.
    is_new: bool,
    /// A thread has moved, begun or ended.
    has_moved: bool,
    /// Numbers of the threads that were held alone when it was told last.
    held: Vec<u16>,
    /// Assigned since the last time.
    changed: BTreeSet<String>,
    /// What was told when the program was loaded.
    at_load: BTreeSet<String>,
    /// Not told yet.
    errors: Vec<Problem>,
    reported_at: Option<u32>,
    /// What was told last of a data-flow program had its variables.
    had_variables: bool,
}

impl Watch {
    pub(super) fn new(locale: Locale) -> Self {
        Self {
            locale,
            is_wanted: false,
            is_new: false,
            has_moved: false,
            held: Vec::new(),
            changed: BTreeSet::new(),
            at_load: BTreeSet::new(),
            errors: Vec::new(),
            reported_at: None,
            had_variables: false,
        }
    }

    /// The language of messages.
    pub(super) fn locale(&self) -> Locale {
        self.locale
    }

    /// Whether somebody looks from now on.
    pub(super) fn set_wanted(&mut self, is_wanted: bool) {
        self.is_new = is_wanted;
        self.is_wanted = is_wanted;
        self.changed.clear();
    }

    /// At the end: everything once more, whenever it was told last.
    pub(super) fn last(&mut self, machine: &Machine, now: u32, host: &Host) -> io::Result<()> {
        self.is_new = self.is_wanted;
        self.reported_at = None;
        self.report(machine, now, host)
    }

    /// Tells what is new, if it is time.
    pub(super) fn report(&mut self, machine: &Machine, now: u32, host: &Host) -> io::Result<()> {
        let told = |problem, locale| machine.program().on_sheet(problem).in_locale(locale);
        let errors = self.tell_errors(host, told)?;
        let held = match self.is_wanted {
            true => held(machine),
            false => Vec::new(),
        };
        let has_moved = self.has_moved || held != self.held;
        let is_news = self.is_new || has_moved || !self.changed.is_empty();
        if !self.is_told(is_news, now, &errors) {
            return Ok(());
        }
        let variables: Vec<(&str, &Value)> = machine
            .variables()
            .filter(|(name, _)| self.is_new || self.changed.contains(*name))
            .collect();
        host.watch(
            &line(machine, &variables),
            &object_of(machine, &variables, &errors),
        )?;
        self.told(now);
        self.held = held;
        Ok(())
    }

    /// Tells what is new of a data-flow program, if it is time: all its variables, whenever a block has reacted, and what has
    /// happened at its blocks.
    pub(super) fn report_flow(
        &mut self,
        (machine, source): (&lang_dataflow::machine::Machine, &Source),
        mut diary: Option<&mut Diary>,
        now: u32,
        host: &Host,
    ) -> io::Result<()> {
        let has_news = diary.as_ref().is_some_and(|diary| diary.has_news());
        let told = |problem, locale| source.line(&problem, locale);
        let errors = self.tell_errors(host, told)?;
        let is_news = self.is_new || self.has_moved || has_news;
        if !self.is_told(is_news, now, &errors) {
            return Ok(());
        }
        let mut variables = object(machine.variables());
        // A line of a recording has no room for both: they take turns.
        let is_long = variables.len() > limits::WATCH_BESIDE_BYTES;
        let is_turn_of_blocks = is_long && has_news && self.had_variables && errors.is_empty();
        if is_turn_of_blocks {
            "{}".clone_into(&mut variables);
        }
        let values = machine
            .variables()
            .map(|(name, value)| format!("{name} = {}", value.printed()));
        let text = cut(values.collect::<Vec<_>>().join("; "));
        let mut json = Object::new(limits::WATCH_TEXT_CHARACTERS)
            .plain("ms", machine.now())
            .list("threads", [])
            .plain("variables", variables);
        // Nor for errors and blocks.
        if let Some(diary) = &mut diary
            && (is_turn_of_blocks || !is_long && errors.is_empty())
        {
            json = diary.tell(json, machine.program(), now);
        }
        if !errors.is_empty() {
            json = json.list("errors", errors.iter().map(|error| quoted(error)));
        }
        host.watch(&text, &json.done())?;
        self.told(now);
        self.had_variables = !is_turn_of_blocks;
        self.has_moved = is_turn_of_blocks;
        Ok(())
    }

    /// A block of a data-flow program has reacted.
    pub(super) fn fired(&mut self) {
        self.has_moved = true;
    }

    /// The same at once, for the last time before the program ends, or becomes another one.
    pub(super) fn last_of_flow(
        &mut self,
        program: (&lang_dataflow::machine::Machine, &Source),
        mut diary: Option<&mut Diary>,
        now: u32,
        host: &Host,
    ) -> io::Result<()> {
        self.is_new = self.is_wanted;
        // A second line has what the first has no room for.
        for _ in 0..2 {
            self.reported_at = None;
            if let Some(diary) = &mut diary {
                diary.is_last();
            }
            self.report_flow(program, diary.as_deref_mut(), now, host)?;
            let has_news = diary.as_ref().is_some_and(|diary| diary.has_news());
            if !has_news && self.had_variables {
                break;
            }
        }
        Ok(())
    }

    /// Keeps an error until it is told.
    pub(super) fn note(&mut self, problem: &Problem) {
        if self.errors.len() < lang_text::limits::PROBLEMS {
            self.errors.push(problem.clone());
        }
    }

    /// What is wrong with a program or a new version of it is told before that begins, but for what was told of the version
    /// before.
    pub(super) fn tell_warnings(
        &mut self,
        warnings: impl IntoIterator<Item = (Severity, String)>,
        host: &Host,
    ) {
        let before = std::mem::take(&mut self.at_load);
        for (severity, line) in warnings {
            if !before.contains(&line) && !self.at_load.contains(&line) {
                let severity = severity.words();
                let severity = severity.in_locale(self.locale);
                // What cannot be told is not told that it cannot be.
                let _ = host.info(&format!("{severity}: {line}"));
            }
            self.at_load.insert(line);
        }
    }

    /// Errors since the last time, which are told at once, but for faults that were told at load. `line` is how one is told.
    fn tell_errors(
        &mut self,
        host: &Host,
        line: impl Fn(Problem, Locale) -> String,
    ) -> io::Result<Vec<String>> {
        let errors = std::mem::take(&mut self.errors).into_iter();
        let errors = errors.map(|problem| line(problem, self.locale));
        let errors: Vec<String> = errors.collect();
        for error in &errors {
            match self.at_load.contains(error) {
                true => host.known_error()?,
                false => host.error(error)?,
            }
        }
        Ok(errors)
    }

    /// Whether somebody is to be told now.
    fn is_told(&self, is_news: bool, now: u32, errors: &[String]) -> bool {
        let is_due = self
            .reported_at
            .is_none_or(|at| now - at >= limits::WATCH_MS);
        self.is_wanted && (!errors.is_empty() || is_due && is_news)
    }

    /// Everything was told.
    fn told(&mut self, now: u32) {
        self.reported_at = Some(now);
        self.is_new = false;
        self.has_moved = false;
        self.changed.clear();
    }
}

impl Trace for Watch {
    fn entered(&mut self, _now: u32, _thread: u16, _node: Node) {
        self.has_moved = true;
    }

    fn changed(&mut self, _now: u32, _thread: u16, variable: &str, _value: &Value) {
        if self.is_wanted && !self.changed.contains(variable) {
            self.changed.insert(variable.to_owned());
        }
    }

    fn trap(&mut self, _now: u32, problem: &Problem) {
        self.note(problem);
    }

    fn thread_started(&mut self, _now: u32, _thread: u16, _name: &str) {
        self.has_moved = true;
    }

    fn thread_ended(&mut self, _now: u32, _thread: u16) {
        self.has_moved = true;
    }
}

/// Type of the block where a thread is, as the save has it.
fn block(machine: &Machine, node: Node) -> &'static str {
    machine
        .program()
        .row(node)
        .map_or("unknown", |row| row.kind)
}

/// Numbers of the threads that are held alone.
fn held(machine: &Machine) -> Vec<u16> {
    if !machine.is_guarded() {
        return Vec::new();
    }
    let views = machine.views();
    let held = views.filter(|view| view.doing == Doing::Held);
    held.map(|view| view.number).collect()
}

/// One line for people: `main: Timer; x = 3`.
fn line(machine: &Machine, variables: &[(&str, &Value)]) -> String {
    let threads = machine.views().map(|view| {
        let held = if view.doing == Doing::Held {
            " (held)"
        } else {
            ""
        };
        format!("{}: {}{held}", view.name, block(machine, view.node))
    });
    let values = variables
        .iter()
        .map(|(name, value)| format!("{name} = {}", value.printed()));
    cut(threads.chain(values).collect::<Vec<_>>().join("; "))
}

/// A line that is no longer than lines are told.
fn cut(mut line: String) -> String {
    let mut end = line.len().min(limits::WATCH_LINE_BYTES);
    while !line.is_char_boundary(end) {
        end -= 1;
    }
    line.truncate(end);
    line
}

/// One object for programs.
fn object_of(machine: &Machine, variables: &[(&str, &Value)], errors: &[String]) -> String {
    let mut json = format!("{{\"ms\":{},\"threads\":[", machine.now());
    for (index, view) in machine.views().enumerate() {
        let comma = if index > 0 { "," } else { "" };
        let is_held = view.doing == Doing::Held;
        let program = machine.program();
        let _ = write!(
            json,
            "{comma}{{\"name\":{},\"diagram\":{},\"id\":{},\"block\":{}{}}}",
            quoted(view.name),
            quoted(program.diagram(view.node).unwrap_or("")),
            quoted(program.id(view.node).unwrap_or("")),
            quoted(block(machine, view.node)),
            if is_held { ",\"held\":true" } else { "" }
        );
    }
    let _ = write!(
        json,
        "],\"variables\":{}",
        object(variables.iter().copied())
    );
    put_errors(&mut json, errors);
    json
}

/// The end of an object: errors, if there are any.
fn put_errors(json: &mut String, errors: &[String]) {
    if !errors.is_empty() {
        let errors: Vec<_> = errors.iter().map(|error| quoted(error)).collect();
        let _ = write!(json, ",\"errors\":[{}]", errors.join(","));
    }
    json.push('}');
}

/// All variables as one JSON object.
pub(super) fn variables(machine: &Machine) -> String {
    object(machine.variables())
}

/// All variables of a data-flow program as one JSON object.
pub(super) fn variables_of<'a>(all: impl Iterator<Item = (&'a str, &'a Value)>) -> String {
    object(all)
}

fn object<'a>(variables: impl Iterator<Item = (&'a str, &'a Value)>) -> String {
    let mut json = "{".to_owned();
    for (name, value) in variables {
        if json.len() > limits::WATCH_JSON_BYTES {
            break;
        }
        if json.len() > 1 {
            json.push(',');
        }
        json.push_str(&quoted(name));
        json.push(':');
        put(&mut json, value);
    }
    json.push('}');
    json
}

/// A value as JSON; what is no number there is `null`.
fn put(json: &mut String, value: &Value) {
    let _ = match value {
        Value::Nil => write!(json, "null"),
        Value::Unset => write!(json, "\"\""),
        Value::Bool(truth) => write!(json, "{truth}"),
        Value::Int(number) => write!(json, "{number}"),
        Value::Float(number) if number.is_finite() => write!(json, "{number}"),
        Value::Float(_) => write!(json, "null"),
        Value::Text(text) => write!(json, "{}", quoted(text)),
        Value::List(list) => {
            json.push('[');
            for (index, item) in list.items().iter().enumerate() {
                if json.len() > limits::WATCH_JSON_BYTES {
                    break;
                }
                if index > 0 {
                    json.push(',');
                }
                put(json, item);
            }
            write!(json, "]")
        }
    };
}

/// A text as JSON, cut if it is very long.
fn quoted(text: &str) -> String {
    json::quoted(text, limits::WATCH_TEXT_CHARACTERS)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_json_whatever_they_hold() {
        let list = Value::ints(&[1, 2]);
        let text = Value::text("a\"b\\\n\u{1}");
        let values = [
            ("f", &Value::Float(0.5)),
            ("n", &Value::Float(f64::NAN)),
            ("l", &list),
            ("t", &text),
            ("b", &Value::Bool(true)),
            ("z", &Value::Nil),
        ];
        assert_eq!(
            object(values.into_iter()),
            "{\"f\":0.5,\"n\":null,\"l\":[1,2],\"t\":\"a\\\"b\\\\\\n\\u0001\",\"b\":true,\"z\":null}"
        );
        assert_eq!(
            quoted(&"x".repeat(100_000)).len(),
            limits::WATCH_TEXT_CHARACTERS + 2
        );
    }
}
