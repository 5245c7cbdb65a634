//! What the debugger in a terminal shows of a program when it is asked: lines, threads, calls, variables, breakpoints.
//!
//! Owns how each list looks; what has been heard of the program is in `report`, its text in `listing`.

use super::Terminal;
use crate::debug::stops::words;
use crate::debug::words::ROWS;
use crate::error::Error;
use crate::limits;
use crate::terminal::harmless;
use lang_diagram::debug::order::Order;
use lang_text::problem::Words;
use serde_json::Value;

/// Lines of the diagram that are shown before and after one.
const AROUND: usize = 5;

impl Terminal<'_> {
    pub(super) fn here(&self) -> Option<usize> {
        let at = self.told.at()?;
        Some(self.listing.line_of(&at.id))
    }

    pub(super) fn list(&self, line: Option<usize>) -> Result<(), Error> {
        let here = self.here();
        let (from, to) = match line.or(here) {
            Some(line) => (
                line.saturating_sub(AROUND).max(1),
                line.saturating_add(AROUND),
            ),
            None => (1, 2 * AROUND),
        };
        if from > self.listing.len() {
            return self.says(words::lines_there_are(self.listing.len()));
        }
        for line in from..=to.min(self.listing.len()) {
            let mark = if Some(line) == here { '>' } else { ' ' };
            self.say(&format!("{mark} {line:3} {}", self.listing.text(line)))?;
        }
        Ok(())
    }

    pub(super) fn threads(&self) -> Result<(), Error> {
        for thread in &self.told.threads {
            let line = self.listing.line_of(&thread.at.id);
            let (name, does) = (
                harmless(&thread.name),
                harmless(&thread.doing(self.source.locale)),
            );
            let text = self.listing.text(line);
            self.say(&format!("{name:12} {does:20} {line:3} {}", text.trim()))?;
        }
        if self.told.threads.is_empty() {
            self.says(self.no_thread())?;
        }
        Ok(())
    }

    pub(super) fn no_thread(&self) -> Words {
        match self.listing.is_flow() {
            true => words::no_threads(),
            false => words::no_thread(),
        }
    }

    pub(super) fn calls(&self) -> Result<(), Error> {
        let Some(thread) = self.told.thread() else {
            return self.says(self.no_thread());
        };
        let places = std::iter::once(&thread.at).chain(thread.calls.iter().rev());
        for (index, at) in places.take(limits::DEBUG_CALLS_SHOWN).enumerate() {
            let line = self.listing.line_of(&at.id);
            let (diagram, text) = (harmless(&at.diagram), self.listing.text(line));
            self.say(&format!("#{index} {diagram}, {line}: {}", text.trim()))?;
        }
        Ok(())
    }

    pub(super) fn variables(&self) -> Result<(), Error> {
        for variable in &self.told.variables {
            let (name, value) = (harmless(&variable.name), harmless(&variable.value));
            self.say(&format!("{name} = {value}"))?;
        }
        if self.told.variables.is_empty() {
            self.says(words::no_variable())?;
        }
        Ok(())
    }

    /// All breakpoints; those that one answer leaves out are in the next one.
    pub(super) fn breakpoints(
        &mut self,
        mut points: Vec<Value>,
        mut answer: Value,
    ) -> Result<(), Error> {
        if points.is_empty() {
            return self.says(words::no_breakpoints());
        }
        loop {
            self.page(&points)?;
            let left_out = answer.get("breakpoints_left_out").and_then(Value::as_u64);
            let last = points
                .last()
                .and_then(|point| point.get("number")?.as_u64());
            let last = last.and_then(|last| u32::try_from(last).ok());
            let (Some(left_out), Some(last)) = (left_out, last) else {
                return Ok(());
            };
            answer = self.target.order(&Order::Breakpoints(last))?;
            let next = answer.get("breakpoints").and_then(Value::as_array);
            points = next.cloned().unwrap_or_default();
            if points.is_empty() {
                return self.says(words::more(left_out));
            }
        }
    }

    fn page(&self, points: &[Value]) -> Result<(), Error> {
        let said = |words: Words| words::in_locale(self.source.locale, words);
        for point in points {
            let text = |name: &str| {
                let text = point.get(name).and_then(Value::as_str);
                harmless(text.unwrap_or_default())
            };
            let place = match text("variable").as_str() {
                "" => {
                    let line = self.listing.line_of(&text("block"));
                    format!(
                        "{} {line}: {}",
                        said(words::line()),
                        self.listing.text(line).trim()
                    )
                }
                variable => format!("{} {variable}", said(words::watching())),
            };
            let mut told = format!(
                "{:3} {place}, {}: {}",
                point["number"],
                said(words::hits()),
                point["hits"]
            );
            for (word, name) in [(words::if_(), "if"), (words::writes(), "log")] {
                if !text(name).is_empty() {
                    told.push_str(&format!(", {} {}", said(word), text(name)));
                }
            }
            if point["disabled"] == Value::Bool(true) {
                told.push_str(&format!(", {}", said(words::disabled())));
            }
            self.say(&told)?;
        }
        Ok(())
    }

    pub(super) fn help(&self) -> Result<(), Error> {
        for row in ROWS {
            let head = row.form(self.source.locale);
            self.say(&format!("{head:42} {}", row.what(self.source.locale)))?;
        }
        self.says(words::last_of_help())
    }
}
