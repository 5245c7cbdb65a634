//! Problems of a diagram as lines for a person: file, in a text its line and column, how bad, diagram, block with its place,
//! property, words; and as lines of JSON.
//!
//! Owns the order of problems and both forms of a line.

use super::flow::Flow;
use crate::terminal::{harmless, named};
use lang_dataflow::text::Places;
use lang_diagram::blocks;
use lang_diagram::project::{Block, Project};
use lang_text::problem::{Locale, Position, Problem, Severity};
use serde_json::json;
use std::cmp::Reverse;
use std::collections::HashMap;
use std::path::Path;

/// How many problems of each kind.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct Count {
    pub errors: usize,
    pub warnings: usize,
    pub notes: usize,
}

impl Count {
    /// Adds problems.
    pub fn add(&mut self, problems: &[Problem]) {
        for problem in problems {
            match problem.severity {
                Severity::Error => self.errors += 1,
                Severity::Warning => self.warnings += 1,
                Severity::Note => self.notes += 1,
            }
        }
    }
}

/// What lines and columns of a file are known.
enum Lines<'a> {
    /// None: a save is an archive.
    None,
    /// Those that problems have: nobody could read the text.
    OfProblems,
    /// Those of the objects in a text.
    OfObjects(Places<'a>),
}

/// Problems of one save as lines.
pub(super) struct Reporter<'a> {
    file: String,
    lines: Lines<'a>,
    blocks: HashMap<&'a str, (usize, usize, &'a Block)>,
    locale: Locale,
}

impl<'a> Reporter<'a> {
    /// For a save, with its project if it could be read.
    pub fn new(file: &Path, project: Option<&'a Project>, locale: Locale) -> Self {
        let mut blocks = HashMap::new();
        for (at, diagram) in project
            .iter()
            .flat_map(|one| one.diagrams.iter().enumerate())
        {
            for (place, block) in diagram.blocks.iter().enumerate() {
                blocks.entry(&*block.id).or_insert((at, place, block));
            }
        }
        Self {
            file: named(file),
            lines: Lines::None,
            blocks,
            locale,
        }
    }

    /// For a text that could not be read: an editor can go to the places of its problems.
    pub fn of_unread_text(file: &Path, locale: Locale) -> Self {
        Self {
            lines: Lines::OfProblems,
            ..Self::new(file, None, locale)
        }
    }

    /// For a data-flow program: an editor can go to the places of what is wrong with its text, if it has one.
    pub fn of_flow(file: &Path, flow: &'a Flow, locale: Locale) -> Self {
        let text = flow.text.as_deref();
        Self {
            lines: text.map_or(Lines::None, |text| {
                Lines::OfObjects(Places::of(text, &flow.project))
            }),
            ..Self::new(file, None, locale)
        }
    }

    /// The places of problems in the file.
    fn in_file(&self, problems: &[Problem]) -> Vec<Option<Position>> {
        match &self.lines {
            Lines::None => vec![None; problems.len()],
            Lines::OfProblems => problems.iter().map(|one| one.place.position).collect(),
            Lines::OfObjects(places) => places.locate(problems),
        }
    }

    /// The worst first, then diagram after diagram, block after block, and each only once.
    pub fn sort(&self, problems: &mut Vec<Problem>) {
        let place = |problem: &Problem| {
            let block = self.block(problem);
            let (diagram, at) = block.map_or((usize::MAX, 0), |&(diagram, at, _)| (diagram, at));
            (diagram, at, problem.place.position)
        };
        problems.sort_by_key(|problem| (Reverse(problem.severity), place(problem)));
        problems.dedup();
    }

    /// A line for each.
    pub fn lines(&self, problems: &[Problem]) -> Vec<String> {
        let places = problems.iter().zip(self.in_file(problems));
        places.map(|(problem, at)| self.line(problem, at)).collect()
    }

    /// A line of JSON for each: level and message as in the results of `trik check`, and where it is.
    pub fn json(&self, problems: &[Problem]) -> Vec<String> {
        let line = |(problem, in_file): (&Problem, Option<Position>)| {
            let place = &problem.place;
            let level = match problem.severity {
                Severity::Error => "error",
                Severity::Warning => "warning",
                Severity::Note => "note",
            };
            let at = place.position;
            let mut line = json!({
                "file": self.file,
                "level": level,
                "message": problem.said(self.locale),
                "part": place.file,
                "diagram": place.diagram,
                "object": place.object,
                "block": place.block,
                "property": place.property,
                "line": at.map(|at| at.line),
                "column": at.map(|at| at.column),
            });
            if let Some(at) = in_file {
                line["fileLine"] = at.line.into();
                line["fileColumn"] = at.column.into();
            }
            line.to_string()
        };
        let places = problems.iter().zip(self.in_file(problems));
        places.map(line).collect()
    }

    fn block(&self, problem: &Problem) -> Option<&(usize, usize, &'a Block)> {
        self.blocks.get(problem.place.object.as_deref()?)
    }

    fn line(&self, problem: &Problem, in_file: Option<Position>) -> String {
        let place = &problem.place;
        let mut line = self.file.clone();
        if let Some(at) = in_file {
            line.push_str(&format!(":{}:{}", at.line, at.column));
        }
        let severity = problem.severity.words();
        let severity = severity.in_locale(self.locale);
        line.push_str(&format!(": {severity}: "));
        for part in [&place.file, &place.diagram].into_iter().flatten() {
            line.push_str(&format!("{}: ", harmless(part)));
        }
        let found = self.block(problem).map(|(_, _, block)| *block);
        let row = found.and_then(|block| blocks::find(&block.kind));
        if let Some(block) = found {
            let (x, y) = block.position;
            let name = row.map_or(&*block.kind, |row| row.shown_in(self.locale));
            line.push_str(&format!("{} ({x:.0}, {y:.0}): ", harmless(name)));
        } else if let Some(block) = &place.block {
            line.push_str(&format!("{}: ", harmless(block)));
        }
        let property = place.property.as_deref().filter(|name| !name.is_empty());
        let property =
            property.map(|name| harmless(row.map_or(name, |row| row.label(name, self.locale))));
        match (property, place.position) {
            (Some(name), Some(at)) => {
                line.push_str(&format!("'{name}' {}:{}: ", at.line, at.column));
            }
            (Some(name), None) => line.push_str(&format!("'{name}': ")),
            // The line begins with it.
            (None, Some(at)) if in_file == Some(at) => {}
            (None, Some(at)) => line.push_str(&format!("{}:{}: ", at.line, at.column)),
            (None, None) => {}
        }
        line.push_str(&harmless(&problem.said(self.locale)));
        line
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use lang_diagram::check::check;
    use lang_diagram::lower::World;
    use lang_diagram::sketch::Sketch;

    #[test]
    fn problems_stand_at_their_blocks_the_worst_first_and_once() {
        let mut sketch = Sketch::new();
        let start = sketch.block("InitialNode", &[]);
        let wait = sketch.block("Timer", &[("Delay", "1 +")]);
        let end = sketch.block("FinalNode", &[]);
        let lost = sketch.block("Timer", &[("Delay", "5")]);
        sketch.chain(&[start, wait, end]);
        sketch.link(lost, end);
        let project = sketch.project();
        let reporter = Reporter::new(Path::new("a.qrs"), Some(&project), Locale::English);
        let mut problems = check(&project, World::Robot);
        problems.reverse();
        problems.extend(problems.clone());
        reporter.sort(&mut problems);
        let lines = reporter.lines(&problems);
        let mut count = Count::default();
        count.add(&problems);
        assert_eq!((count.errors, count.notes), (1, 1), "{lines:?}");
        let first = "a.qrs: error: main: Timer (100, 0): 'Delay (ms)' 1:";
        assert!(lines[0].starts_with(first), "{lines:?}");
        let last = lines.last().map_or("", |line| line);
        assert!(
            last.starts_with("a.qrs: note: main: Timer (300, 0): "),
            "{lines:?}"
        );
    }
}
