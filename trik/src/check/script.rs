//! Programs in languages with text, as solutions: the border to the engines that run them in virtual time.
//!
//! Owns which language a file is in. Knows no engine from inside.

use crate::error::Error;
use crate::script::{JavaScript, Python};
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
#[derive(Clone, Copy, Debug)]
pub(super) struct Setup<'a> {
    /// Where its text comes from.
    pub file: &'a Path,
    /// Seed of random numbers.
    pub seed: u32,
    /// Whether it is to be known at which lines it waits and asks.
    pub is_watched: bool,
    /// Longest run in seconds of real time.
    pub wall_seconds: f64,
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
            let python = Python::new(given.file, text, given.seed, longest)?;
            Ok(Box::new(match given.is_watched {
                true => python.watched(),
                false => python,
            }))
        }
    }
}
