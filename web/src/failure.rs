//! Why a request is not answered, by who has to act, as a value.
//!
//! Owns the kinds and their names in JSON. What is wrong is said where it was found.

use lang_text::problem::{Locale, Problem, Words};
use serde_json::{Value, json};
use std::path::Path;
use studio::findings::Findings;
use studio::lint::unread;
use studio::program::Unreadable;

/// Why a request is not answered.
#[derive(Clone, Debug)]
pub enum Failure {
    /// The code that asks has a mistake: an option, an argument.
    Request(Words),
    /// The file is no program or world, or is damaged.
    Unreadable(Vec<Problem>),
    /// The project has no such diagram.
    Diagram(Words),
    /// The program has mistakes for which this cannot be done.
    Program(Vec<Problem>),
    /// The world or its rules have mistakes for which nothing can be run.
    World(Vec<Problem>),
}

impl From<Unreadable> for Failure {
    fn from(why: Unreadable) -> Self {
        match why {
            Unreadable::Diagram(words) => Self::Diagram(words),
            why @ (Unreadable::File(_) | Unreadable::Save(_)) => Self::Unreadable(why.problems()),
        }
    }
}

impl Failure {
    /// Its name.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Request(_) => "request",
            Self::Unreadable(_) => "unreadable",
            Self::Diagram(_) => "diagram",
            Self::Program(_) => "program",
            Self::World(_) => "world",
        }
    }

    /// As a value: its kind, and findings as `trik lint --json` has them, the worst first. `findings` knows the places in the
    /// file, if that could be read.
    pub fn json(&self, file: &str, findings: Option<Findings<'_>>, locale: Locale) -> Value {
        let mut problems = match self {
            Self::Request(words) | Self::Diagram(words) => vec![Problem::error(words.clone())],
            Self::Unreadable(problems) | Self::Program(problems) | Self::World(problems) => {
                problems.clone()
            }
        };
        let findings = findings.unwrap_or_else(|| unread(Path::new(file)));
        findings.sort(&mut problems);
        json!({
            "kind": self.kind(),
            "problems": findings.json(file, &problems, locale),
        })
    }
}
