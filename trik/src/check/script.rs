//! Programs in languages with text, as solutions: the border to the engines that run them in virtual time.
//!
//! Owns which language a file is in. Knows no engine from inside.

use crate::diagrams::save;
use crate::error::Error;
use crate::sandbox::Sandbox;
use crate::script::{JavaScript, Python};
use lang_diagram::project::Project;
use sim::judge::Program;
use std::path::Path;
use std::time::Duration;

/// A language of programs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Language {
    /// JavaScript.
    JavaScript,
    /// Python 3.
    Python,
}

impl Language {
    /// By the ending of a file, as `js`.
    pub fn of_ending(ending: &str) -> Option<Self> {
        match ending {
            "js" | "qts" => Some(Self::JavaScript),
            "py" => Some(Self::Python),
            _ => None,
        }
    }

    /// By the name of a file.
    pub fn of(path: &Path) -> Option<Self> {
        Self::of_ending(path.extension()?.to_str()?)
    }
}

/// What a program is given beside its text.
#[derive(Clone, Debug)]
pub(super) struct Setup<'a> {
    /// Where its text comes from.
    pub file: &'a Path,
    /// Seed of random numbers.
    pub seed: u32,
    /// Whether it is to be known at which lines it waits and asks.
    pub is_watched: bool,
    /// Longest run in seconds of real time.
    pub wall_seconds: f64,
    /// What a program in Python is confined by.
    pub sandbox: Sandbox,
}

/// Makes a program ready to run.
///
/// # Errors
/// No engine for this language can be started here.
pub(super) fn open(
    language: Language,
    text: &str,
    given: Setup<'_>,
) -> Result<Box<dyn Program>, Error> {
    match language {
        Language::JavaScript => {
            let program = JavaScript::new(given.file, text)?;
            Ok(Box::new(match given.is_watched {
                true => program.watched(),
                false => program,
            }))
        }
        Language::Python => {
            let longest = Duration::from_secs_f64(given.wall_seconds);
            let python = Python::new(given.file, text, given.seed, longest, given.sandbox)?;
            Ok(Box::new(match given.is_watched {
                true => python.watched(),
                false => python,
            }))
        }
    }
}

/// Whether the program that a save holds beside its diagram is in Python.
pub(super) fn embeds_python(path: &Path) -> bool {
    let language = |project: &Project| {
        let ending = project.meta.get("activeCodeLanguageExtension")?;
        Language::of_ending(ending)
    };
    save::open(path).is_ok_and(|opened| language(&opened.project) == Some(Language::Python))
}

/// The program that a save holds beside its diagram.
///
/// # Errors
/// It holds none, or one in another language.
pub(super) fn embedded(project: &Project, path: &Path) -> Result<(Language, String), Error> {
    let key = |name| project.meta.get(name).filter(|value| !value.is_empty());
    let (Some(code), ending) = (key("activeCode"), key("activeCodeLanguageExtension")) else {
        return Err(Error::file(path, "there is no program with text in it"));
    };
    let ending = ending.map_or("js", |ending| ending);
    let language = Language::of_ending(ending)
        .ok_or_else(|| Error::file(path, format!("there is no language '{ending}'")))?;
    Ok((language, code.clone()))
}
