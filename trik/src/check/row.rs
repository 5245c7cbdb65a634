//! One run as a line of JSON and as a row of the table.
//!
//! Owns both forms. The line is also what a worker process tells.

use super::{points, words};
use crate::limits;
use crate::terminal::harmless;
use lang_text::problem::Locale;
use sim::judge::json::{self, Value};
use studio::explain;
use studio::verdict::Verdict;

/// One run.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Row {
    /// The solution.
    pub solution: String,
    /// The field; none for the solution's own world.
    pub field: Option<String>,
    /// How it ended.
    pub verdict: Verdict,
    /// When, in milliseconds of model time.
    pub ms: u32,
    /// What the rules have counted.
    pub total_score: Option<f64>,
    /// Level and text, in order: the first [`limits::ROW_MESSAGES_MAX`].
    pub messages: Vec<(String, String)>,
    /// Messages that are left out.
    pub more: usize,
    /// What the program printed.
    pub printed: Vec<String>,
    /// Why it ended so, if that was asked for.
    pub explain: Option<Value>,
}

impl Row {
    /// A run that could not be.
    pub fn broken(solution: String, field: Option<String>, why: String) -> Self {
        Self {
            solution,
            field,
            verdict: Verdict::NotRun,
            ms: 0,
            total_score: None,
            messages: vec![("error".to_owned(), why)],
            more: 0,
            printed: Vec::new(),
            explain: None,
        }
    }

    /// Adds a message, unless there are very many.
    pub fn say(&mut self, level: &str, text: &str) {
        if self.messages.len() < limits::ROW_MESSAGES_MAX {
            let mut chars = text.chars();
            let mut kept: String = chars.by_ref().take(limits::ROW_MESSAGE_CHARS_MAX).collect();
            if chars.next().is_some() {
                kept.push_str("...");
            }
            self.messages.push((level.to_owned(), kept));
        } else {
            self.more += 1;
        }
    }

    /// The last whole number in what the rules said, for tasks that tell points in words.
    pub fn last_number(&self) -> Option<i64> {
        if !self.verdict.is_judged() {
            return None;
        }
        // Seconds of the run are no points: neither the time of success nor the limit that a run met.
        let is_time = |text: &str| words::TIMES.iter().any(|mark| text.starts_with(mark));
        let said = self.messages.iter().rev();
        let texts = said.filter(|(level, _)| level != words::WARNING);
        let texts = texts.map(|(_, text)| text);
        let texts = texts.filter(|text| !is_time(text));
        let mut numbers = texts.filter_map(|text| {
            let is_part = |c: char| c.is_ascii_digit() || matches!(c, '-' | '.');
            let words = text
                .split(|c| !is_part(c))
                .map(|word| word.trim_matches('.'));
            words.filter_map(|word| word.parse().ok()).next_back()
        });
        numbers.next()
    }

    /// The points that its rules have said in words, the last time that they did.
    pub fn points_in_words(&self) -> Option<f64> {
        let said = self.messages.iter().rev();
        let mut said = said.filter(|(level, _)| level != words::WARNING);
        said.find_map(|(_, text)| points::stated(text))
            .filter(|_| self.verdict.is_judged())
    }

    /// Its points: what the rules have counted, or what they have said in words.
    pub fn points(&self) -> Option<f64> {
        self.score().or_else(|| self.points_in_words())
    }

    /// The first error in what was said, or else nothing.
    pub fn why(&self) -> &str {
        let mut messages = self.messages.iter();
        let first = messages.find(|(level, _)| level == "error");
        first.map_or("", |(_, text)| text)
    }

    /// As one line of JSON, without its end.
    pub fn write(&self) -> String {
        let mut line = String::from("{\"solution\":");
        json::text(&mut line, &self.solution);
        line.push_str(",\"field\":");
        match &self.field {
            Some(field) => json::text(&mut line, field),
            None => line.push_str("null"),
        }
        line.push_str(&format!(
            ",\"verdict\":\"{}\",\"failure\":",
            self.verdict.name(),
        ));
        match self.verdict.failure() {
            Some(failure) => json::text(&mut line, failure),
            None => line.push_str("null"),
        }
        line.push_str(&format!(",\"ms\":{}", self.ms));
        line.push_str(",\"total_score\":");
        json::number(&mut line, self.total_score.unwrap_or(f64::NAN));
        line.push_str(",\"last_number\":");
        match self.last_number() {
            Some(number) => line.push_str(&number.to_string()),
            None => line.push_str("null"),
        }
        line.push_str(",\"points\":");
        json::number(&mut line, self.points().unwrap_or(f64::NAN));
        line.push_str(",\"messages\":[");
        for (index, (level, text)) in self.messages.iter().enumerate() {
            line.push_str(if index == 0 { "" } else { "," });
            line.push_str("{\"level\":");
            json::text(&mut line, level);
            line.push_str(",\"message\":");
            json::text(&mut line, text);
            line.push('}');
        }
        line.push_str("],\"more\":");
        line.push_str(&self.more.to_string());
        line.push_str(",\"printed\":[");
        for (index, text) in self.printed.iter().enumerate() {
            line.push_str(if index == 0 { "" } else { "," });
            json::text(&mut line, text);
        }
        line.push(']');
        if let Some(explain) = &self.explain {
            line.push_str(",\"explain\":");
            json::write(&mut line, explain);
        }
        line.push('}');
        line
    }

    /// Reads such a line.
    pub fn read(line: &str) -> Option<Self> {
        let value = json::read(line).ok()?;
        let text = |name| value.get(name).and_then(Value::as_str);
        let number = |name| value.get(name).and_then(Value::as_f64);
        let Some(Value::Array(all)) = value.get("messages") else {
            return None;
        };
        let messages = all.iter().map(|one| {
            let part = |name| one.get(name).and_then(Value::as_str).map(str::to_owned);
            Some((part("level")?, part("message")?))
        });
        let Some(Value::Array(printed)) = value.get("printed") else {
            return None;
        };
        let printed = printed.iter().map(|one| one.as_str().map(str::to_owned));
        Some(Self {
            solution: text("solution")?.to_owned(),
            field: text("field").map(str::to_owned),
            verdict: Verdict::named(text("verdict")?, text("failure"))?,
            ms: number("ms")? as u32,
            total_score: number("total_score"),
            messages: messages.collect::<Option<_>>()?,
            more: number("more")? as usize,
            printed: printed.collect::<Option<_>>()?,
            explain: value.get("explain").cloned(),
        })
    }

    /// Lines for a person who runs one solution.
    pub fn lines(&self, locale: Locale) -> Vec<String> {
        let printed = self.printed.iter().flat_map(|text| text.lines());
        let mut lines: Vec<String> = printed
            .map(|text| format!("print: {}", harmless(text)))
            .collect();
        let messages = self.messages.iter();
        lines.extend(
            messages.map(|(level, text)| {
                format!("{}: {}", words::level(level, locale), harmless(text))
            }),
        );
        if self.more > 0 {
            lines.push(words::more(self.more, locale));
        }
        let solution = harmless(&self.solution);
        let verdict = words::verdict(self.verdict, locale);
        let at = match self.verdict.is_judged() {
            false => String::new(),
            true => format!(", {}", words::seconds(self.ms, locale)),
        };
        let score = self.score().map_or_else(String::new, |score| {
            format!(", {}: {score}", words::heading(locale)[4])
        });
        lines.extend(self.explanation());
        lines.push(format!("{solution}: {verdict}{at}{score}"));
        lines
    }

    /// Why it ended so, in lines for a person.
    pub fn explanation(&self) -> impl Iterator<Item = String> {
        self.explain.iter().flat_map(explain::lines).map(|line| {
            // What stands at its beginning is the place of a condition in others.
            let text = line.trim_start();
            format!("{}{}", &line[..line.len() - text.len()], harmless(text))
        })
    }

    /// What the rules have counted, if that is something.
    pub fn score(&self) -> Option<f64> {
        self.total_score.filter(|score| *score != 0.0)
    }

    /// The cells of its row in the table.
    pub fn cells(&self, locale: Locale) -> [String; 6] {
        let field = self.field.as_deref();
        [
            harmless(&self.solution),
            field.map_or_else(|| words::own(locale).to_owned(), harmless),
            words::verdict(self.verdict, locale).to_owned(),
            match self.verdict.is_judged() {
                false => "-".to_owned(),
                true => words::seconds(self.ms, locale),
            },
            self.points()
                .map_or_else(|| "-".to_owned(), |points| points.to_string()),
            harmless(self.why()),
        ]
    }
}

/// Widths of the columns of a table.
pub(super) struct Widths([usize; 3]);

impl Widths {
    /// For these solutions and fields.
    pub fn new<'a>(
        names: impl Iterator<Item = (&'a str, Option<&'a str>)>,
        locale: Locale,
    ) -> Self {
        let heading = words::heading(locale);
        let count = |text: &str| text.chars().count();
        let mut widths = [count(heading[0]), count(heading[1]), 0];
        for (solution, field) in names {
            widths[0] = widths[0].max(count(solution));
            widths[1] = widths[1].max(field.map_or(count(words::own(locale)), count));
        }
        for verdict in Verdict::ALL {
            widths[2] = widths[2].max(count(words::verdict(verdict, locale)));
        }
        Self(widths)
    }

    /// A line of the table.
    pub fn line(&self, cells: &[impl AsRef<str>; 6]) -> String {
        let [solution, field, verdict, seconds, score, message] =
            cells.each_ref().map(AsRef::as_ref);
        let [one, two, three] = self.0;
        let line = format!(
            "{solution:one$}  {field:two$}  {verdict:three$}  {seconds:>9}  {score:>5}  {message}"
        );
        line.trim_end().to_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn row() -> Row {
        Row {
            solution: "a\nb.qrs".into(),
            field: Some("f.xml".into()),
            verdict: Verdict::Wrong,
            ms: 19_830,
            total_score: Some(2.5),
            messages: vec![
                ("info".into(), "points: 20.".into()),
                ("error".into(), "out \"there\"".into()),
                ("info".into(), "The task was accomplished in 15 sec!".into()),
            ],
            more: 3,
            printed: vec!["1 \"a\"\n2".into()],
            explain: Some(serde_json::json!({"text": ["why: 1 < 2"], "ms": 3})),
        }
    }

    #[test]
    fn a_line_is_read_as_it_was_written() {
        let line = row().write();
        assert!(!line.contains('\n'), "{line}");
        assert!(
            line.contains(r#""verdict":"failed","failure":"wrong","ms":19830,"total_score":2.5,"last_number":20,"points":2.5,"#),
            "{line}"
        );
        assert_eq!(Row::read(&line), Some(row()));
        for mark in words::TIMES {
            let mut late = row();
            late.say("error", &format!("{mark}600 s"));
            assert_eq!(late.last_number(), Some(20), "{mark}");
        }
        assert_eq!(Row::read("{}"), None);
        assert_eq!(Row::read("[1"), None);
    }

    #[test]
    fn a_table_has_even_columns_and_no_line_that_a_terminal_obeys() {
        let widths = Widths::new(
            [("a b.qrs", Some("f.xml")), ("c", None)].into_iter(),
            Locale::English,
        );
        let line = widths.line(&row().cells(Locale::English));
        assert_eq!(
            line,
            "a b.qrs   f.xml  not accomplished    19.83 s    2.5  out \"there\""
        );
        let mut many = row();
        for _ in 0..limits::ROW_MESSAGES_MAX * 2 {
            many.say("log", &"x".repeat(limits::ROW_MESSAGE_CHARS_MAX * 2));
        }
        assert_eq!(many.messages.len(), limits::ROW_MESSAGES_MAX);
        assert_eq!(many.more, 3 + limits::ROW_MESSAGES_MAX + 3);
        assert!(many.write().len() < limits::ROW_BYTES_MAX);
    }
}
