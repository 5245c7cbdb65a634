//! A data-flow program as its file has it: of a save, or in its textual form.
//!
//! Owns how what is wrong with it is told: of a text by line and column. Knows no robot; what is wrong is found in
//! `lang_dataflow`.

use super::{errors_among, opened, read_save, words};
use crate::engine::NoDiagram;
use crate::limits;
use crate::scripts::ending;
use lang_dataflow::project::Project;
use lang_dataflow::read::{Language, language, project};
use lang_dataflow::text::{self, Places};
use lang_diagram::read::Opened;
use lang_text::problem::{Locale, Position, Problem, Severity};
use std::io;
use std::path::Path;

/// The ending of a program in its textual form.
pub(super) const ENDING: &str = "flow";

/// A data-flow program that was read.
pub(super) struct Source {
    /// What it means.
    pub project: Project,
    /// What is strange about its save.
    pub problems: Vec<Problem>,
    /// Its text, if it is not of a save.
    text: Option<String>,
}

impl Source {
    /// The program that bytes spell out.
    ///
    /// # Errors
    /// What is wrong with the text.
    pub fn of_text(bytes: Vec<u8>, locale: Locale) -> Result<Self, NoDiagram> {
        let text = String::from_utf8(bytes).map_err(|error| {
            NoDiagram::Unread(io::Error::new(io::ErrorKind::InvalidData, error).into())
        })?;
        let project = text::read(&text).map_err(|problems| errors_among(&problems, locale))?;
        Ok(Self {
            project,
            problems: Vec::new(),
            text: Some(text),
        })
    }

    /// That of a save.
    pub fn of_save(opened: Opened) -> Self {
        let (project, mut problems) = project(&opened.save);
        problems.splice(0..0, opened.problems);
        Self {
            project,
            problems,
            text: None,
        }
    }

    /// The program in a file, which is to take the place of one that runs.
    ///
    /// # Errors
    /// It cannot be read, has mistakes, or is of control flow.
    pub fn open(path: &Path, locale: Locale) -> Result<Self, NoDiagram> {
        let bytes = read_save(path)?;
        if ending(path) == ENDING {
            return Self::of_text(bytes, locale);
        }
        let opened = opened(&bytes, locale)?;
        if language(&opened.save) != Language::Dataflow {
            return Err(NoDiagram::Problems(vec![
                words::other_language().in_locale(locale).to_owned(),
            ]));
        }
        let source = Self::of_save(opened);
        match source.errors(&source.problems, locale) {
            errors if errors.is_empty() => Ok(source),
            errors => Err(NoDiagram::Problems(errors)),
        }
    }

    /// The errors among some problems, a line for each.
    pub fn errors(&self, problems: &[Problem], locale: Locale) -> Vec<String> {
        let is_error = |one: &&Problem| one.severity == Severity::Error;
        let errors: Vec<Problem> = problems.iter().filter(is_error).cloned().collect();
        self.lines(&errors, locale)
    }

    /// What is told when a program with these problems starts: not more than a person reads.
    pub fn warnings(&self, problems: &[Problem], locale: Locale) -> Vec<(Severity, String)> {
        let shown = &problems[..problems.len().min(limits::DIAGRAM_WARNINGS)];
        let severities = shown.iter().map(|problem| problem.severity);
        severities.zip(self.lines(shown, locale)).collect()
    }

    /// The line of one problem, as [`Source::lines`] has it.
    pub fn line(&self, problem: &Problem, locale: Locale) -> String {
        let lines = self.lines(std::slice::from_ref(problem), locale);
        lines.into_iter().next().unwrap_or_default()
    }

    /// A line for each problem; of a text it begins with line and column, of a save it has the place of the block on its sheet.
    pub fn lines(&self, problems: &[Problem], locale: Locale) -> Vec<String> {
        let places = match &self.text {
            Some(text) => Places::of(text, &self.project).locate(problems),
            None => vec![None; problems.len()],
        };
        let line = |(problem, at): (&Problem, Option<Position>)| match at {
            Some(at) => in_text(problem, at, locale),
            None => self.project.on_sheet(problem.clone()).in_locale(locale),
        };
        problems.iter().zip(places).map(line).collect()
    }
}

fn in_text(problem: &Problem, at: Position, locale: Locale) -> String {
    let problem = problem.without_position();
    format!("{}:{} {}", at.line, at.column, problem.in_locale(locale))
}
