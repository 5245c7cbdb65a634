//! Changes of a diagram while it runs: a new version of it, and a variable that a person sets.
//!
//! Owns what a person is told of that. What a new version keeps is known in `lang_diagram::machine::patch` alone; nothing
//! here touches a device.

use super::watch::Watch;
use super::words;
use super::{opened, read_save};
use crate::limits;
use crate::protocol::news;
use lang_diagram::brick::Brick;
use lang_diagram::debug::Session;
use lang_diagram::lower::World;
use lang_diagram::machine::patch::{Refused, Version, WhenGone};
use lang_diagram::project::Project;
use lang_text::problem::{Locale, Problem, Severity, Words};
use std::collections::BTreeMap;
use std::path::Path;

/// A version that may replace what runs.
#[derive(Debug)]
pub(super) struct Prepared<S> {
    pub(super) source: S,
    /// What is strange about it, in the language of the program, each with its severity. It is told as at a start.
    pub(super) warnings: Vec<(Severity, String)>,
}

/// What a person is told.
#[derive(Debug, Eq, PartialEq)]
pub(super) struct Answer {
    /// Whether anything has changed.
    pub(super) is_changed: bool,
    /// What, or why not.
    pub(super) text: String,
}

impl Answer {
    pub(super) fn changed(name: &str, what: &str) -> Self {
        Self {
            is_changed: true,
            text: news::changed(name, what),
        }
    }

    pub(super) fn unchanged(name: &str, why: &str) -> Self {
        Self {
            is_changed: false,
            text: news::unchanged(name, why),
        }
    }
}

/// The name of a program in messages.
pub(super) fn name(path: &Path) -> String {
    let name = path.file_name().unwrap_or_default();
    name.to_string_lossy().into_owned()
}

/// The project in a file, if nothing is wrong with it whatever runs. Knows no program that runs, so that another thread may
/// do it. `own` is the language of the program, `locale` that of the one who asks.
pub(super) fn prepared(
    path: &Path,
    own: Locale,
    locale: Locale,
) -> Result<Prepared<Project>, Answer> {
    let name = name(path);
    let save = read_save(path).and_then(|bytes| opened(&bytes, locale));
    let save = save.map_err(|why| Answer::unchanged(&name, &why.in_locale(locale)))?;
    let sheets = save.project.diagrams.iter();
    let blocks = sheets.flat_map(|sheet| &sheet.blocks);
    fits(blocks.map(|block| &block.properties))
        .map_err(|why| Answer::unchanged(&name, why.in_locale(locale)))?;
    let checked = Version::mistakes(&save.project, World::Robot);
    let placed = |problem: &Problem| save.project.on_sheet(problem.clone());
    let found =
        checked.map_err(|why| Answer::unchanged(&name, &explained(&why, placed, locale)))?;
    let shown = save.problems.iter().chain(&found);
    let shown = shown.take(limits::DIAGRAM_WARNINGS);
    let warnings = shown.map(|problem| (problem.severity, placed(problem).in_locale(own)));
    Ok(Prepared {
        warnings: warnings.collect(),
        source: save.project,
    })
}

/// Whether blocks with these properties fit into the program beside what runs: there is no way back from an allocation that
/// fails.
///
/// # Errors
/// What a person is told.
pub(super) fn fits<'a>(
    blocks: impl Iterator<Item = &'a BTreeMap<String, String>>,
) -> Result<(), Words> {
    let texts = blocks.map(|texts| texts.values().map(String::len).sum::<usize>());
    let bytes: usize = texts.map(|text| text + limits::VERSION_BLOCK_BYTES).sum();
    match bytes > limits::VERSION_BYTES {
        true => Err(words::long_version(bytes)),
        false => Ok(()),
    }
}

/// Replaces the program that runs by a project that is prepared, whole or not at all; the answer is in this language.
pub(super) fn patch(
    session: &mut Session,
    (when_gone, name, project, locale): (WhenGone, &str, &Project, Locale),
    robot: &mut dyn Brick,
    watch: &mut Watch,
) -> Answer {
    let version = Version::of_checked(project, World::Robot);
    let patched = version.and_then(|version| session.patch(&version, when_gone, robot, watch));
    match patched {
        Ok(patched) => Answer::changed(name, &patched.to_string()),
        Err(why) => Answer::unchanged(name, &explained(&why, Problem::clone, locale)),
    }
}

/// `placed` gives a problem with the place of its block on the sheet.
fn explained(why: &Refused, placed: impl Fn(&Problem) -> Problem, locale: Locale) -> String {
    match why {
        Refused::Ended => news::NO_DIAGRAM.to_owned(),
        Refused::Mistakes(problems) | Refused::Occupied(problems) => {
            let lines = problems
                .iter()
                .map(|problem| placed(problem).in_locale(locale));
            lines.collect::<Vec<_>>().join("\n")
        }
    }
}

/// Assigns a variable: `NAME=EXPRESSION`; the answer is in this language.
pub(super) fn set(
    session: &mut Session,
    (text, locale): (&str, Locale),
    robot: &mut dyn Brick,
    watch: &mut Watch,
) -> Answer {
    let (name, expression) = text.split_once('=').unwrap_or((text, ""));
    let (name, expression) = (name.trim(), expression.trim());
    match session.assign(name, expression, robot, watch) {
        Ok(()) => {
            let value = session.machine().variable(name);
            let value = value.map_or_else(String::new, |value| value.brief());
            Answer::changed(name, &format!("{name} = {value}"))
        }
        Err(why) => Answer::unchanged(name, &why.in_locale(locale)),
    }
}
