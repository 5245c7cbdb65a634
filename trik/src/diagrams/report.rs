//! Problems of a diagram as lines for a person: file, in a text its line and column, how bad, diagram, block with its place,
//! property, words; and as lines of JSON.
//!
//! Owns the form of a line for people. The order of problems and their JSON are known in `studio`.

use super::flow::Flow;
use crate::terminal::{harmless, named};
use lang_diagram::blocks;
use lang_diagram::project::Project;
use lang_text::problem::{Locale, Position, Problem, Severity};
use std::path::Path;
use studio::findings::Findings;

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

/// Problems of one file as lines.
pub(super) struct Reporter<'a> {
    file: String,
    findings: Findings<'a>,
    locale: Locale,
}

impl<'a> Reporter<'a> {
    /// For a save, with its project if it could be read.
    pub fn new(file: &Path, project: Option<&'a Project>, locale: Locale) -> Self {
        Self::of(file, Findings::new(project), locale)
    }

    /// For a data-flow program.
    pub fn of_flow(file: &Path, flow: &'a Flow, locale: Locale) -> Self {
        Self::of(file, Findings::of_flow(flow), locale)
    }

    /// For any file.
    pub fn of(file: &Path, findings: Findings<'a>, locale: Locale) -> Self {
        Self {
            file: named(file),
            findings,
            locale,
        }
    }

    /// The worst first, then diagram after diagram, block after block, and each only once.
    pub fn sort(&self, problems: &mut Vec<Problem>) {
        self.findings.sort(problems);
    }

    /// A line for each.
    pub fn lines(&self, problems: &[Problem]) -> Vec<String> {
        let places = problems.iter().zip(self.findings.in_file(problems));
        places.map(|(problem, at)| self.line(problem, at)).collect()
    }

    /// A line of JSON for each.
    pub fn json(&self, problems: &[Problem]) -> Vec<String> {
        let all = self.findings.json(&self.file, problems, self.locale);
        all.iter().map(ToString::to_string).collect()
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
        let found = self.findings.block(problem);
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
