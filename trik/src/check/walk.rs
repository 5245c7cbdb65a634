//! A walk below a directory: the files that are wanted, and all that is passed by, each with its reason.
//!
//! Owns what is no solution and no field: other files, links to directories, FIFOs, what cannot be read, what lies too deep.
//! What a person is told of it is in `words`. Links to directories are not followed.

use crate::error::Error;
use crate::input::Unread;
use crate::input::words::{A_FILE, why};
use crate::limits;
use crate::terminal::named;
use lang_text::problem::Locale;
use std::ffi::OsStr;
use std::fs::{self, FileType};
use std::io;
use std::path::{Path, PathBuf};

/// Why something is passed by.
#[derive(Debug)]
pub(super) enum Reason {
    /// A file with another ending.
    Ending,
    /// A link to a directory.
    LinkToFolder,
    /// A link to nothing.
    BrokenLink,
    /// No file and no directory: a FIFO, a socket, a device.
    NoFile,
    /// A directory deeper than solutions are looked for.
    TooDeep,
    /// A directory, or what is in it, that the system does not show.
    Unreadable(io::Error),
    /// A solution whose names say no task, and the task that may have been meant.
    NoTask(Option<String>),
    /// What is no task among tasks.
    NoTaskFile,
    /// A save of a task that has fields.
    HasFields,
}

/// What was passed by: the first of it with reasons, and how much it was.
#[derive(Debug, Default)]
pub(super) struct Passed {
    /// Paths and reasons, at most [`limits::PASSED_MAX`], sorted.
    pub told: Vec<(PathBuf, Reason)>,
    /// Of all.
    pub count: usize,
}

impl Passed {
    /// Whether a reason that is noted now will be told.
    pub fn has_room(&self) -> bool {
        self.told.len() < limits::PASSED_MAX
    }

    pub fn note(&mut self, path: PathBuf, reason: Reason) {
        self.count += 1;
        if self.has_room() {
            self.told.push((path, reason));
        }
    }

    /// What is told of and is of use after all.
    pub fn drop_if(&mut self, is_of_use: impl Fn(&Path) -> bool) {
        let before = self.told.len();
        self.told.retain(|(path, _)| !is_of_use(path));
        self.count -= before - self.told.len();
    }

    /// What another walk has passed by comes after it.
    pub fn extend(&mut self, other: Self) {
        let room = limits::PASSED_MAX.saturating_sub(self.told.len());
        self.count += other.count;
        self.told.extend(other.told.into_iter().take(room));
    }
}

/// What a walk finds.
#[derive(Debug, Default)]
pub(super) struct Walk {
    /// Files with a wanted ending, sorted, with their names from where the walk began.
    pub found: Vec<(PathBuf, PathBuf)>,
    /// All else.
    pub passed: Passed,
}

/// Why a file or a directory cannot be looked at.
pub(super) fn unread(path: &Path, error: io::Error, locale: Locale) -> Error {
    let words = why(&Unread::from(error), 0, A_FILE);
    Error::Refused(format!("{}: {}", named(path), words.in_locale(locale)))
}

/// A file as it is, or all below a directory, so many directories deep.
///
/// # Errors
/// It cannot be looked at, or there are too many files.
pub(super) fn walk(path: &Path, endings: &[&str], deep: usize, max: usize) -> Result<Walk, Error> {
    let failed = |error: io::Error| unread(path, error, Locale::English);
    if !fs::metadata(path).map_err(failed)?.is_dir() {
        let name = path.file_name().map_or_else(|| path.into(), PathBuf::from);
        return Ok(Walk {
            found: vec![(path.to_owned(), name)],
            passed: Passed::default(),
        });
    }
    let mut walk = Walk::default();
    let mut folders = vec![(path.to_owned(), 0)];
    while let Some((folder, depth)) = folders.pop() {
        let entries = match fs::read_dir(&folder) {
            Ok(entries) => entries,
            Err(error) if depth == 0 => return Err(failed(error)),
            Err(error) => {
                walk.passed.note(folder, Reason::Unreadable(error));
                continue;
            }
        };
        for entry in entries {
            let entry = match entry {
                Ok(entry) => entry,
                Err(error) => {
                    walk.passed.note(folder.clone(), Reason::Unreadable(error));
                    break;
                }
            };
            let inside = entry.path();
            match entry.file_type() {
                Err(error) => walk.passed.note(inside, Reason::Unreadable(error)),
                Ok(kind) if kind.is_dir() && depth + 1 < deep => folders.push((inside, depth + 1)),
                Ok(kind) if kind.is_dir() => walk.passed.note(inside, Reason::TooDeep),
                Ok(kind) => match unwanted(&inside, kind, endings) {
                    Some(reason) => walk.passed.note(inside, reason),
                    None => {
                        let name = inside.strip_prefix(path).unwrap_or(&inside).to_owned();
                        walk.found.push((inside, name));
                    }
                },
            }
            if walk.found.len() > max {
                return Err(Error::Refused(format!(
                    "{}: there are more than {max} files",
                    named(path)
                )));
            }
        }
    }
    walk.found.sort();
    walk.passed.told.sort_by(|one, other| one.0.cmp(&other.0));
    Ok(walk)
}

/// Why an entry that is no directory is passed by, if it is.
fn unwanted(path: &Path, kind: FileType, endings: &[&str]) -> Option<Reason> {
    let is_file = match kind.is_symlink() {
        false => kind.is_file(),
        true => match fs::metadata(path) {
            Ok(there) if there.is_dir() => return Some(Reason::LinkToFolder),
            Ok(there) => there.is_file(),
            Err(error) if error.kind() == io::ErrorKind::NotFound => {
                return Some(Reason::BrokenLink);
            }
            Err(error) => return Some(Reason::Unreadable(error)),
        },
    };
    let ending = path.extension().and_then(OsStr::to_str);
    match (is_file, ending.is_some_and(|one| endings.contains(&one))) {
        (false, _) => Some(Reason::NoFile),
        (true, false) => Some(Reason::Ending),
        (true, true) => None,
    }
}

/// The files that are wanted, of which there has to be one.
///
/// # Errors
/// As [`walk`], and if there is none.
pub(super) fn below(path: &Path, endings: &[&str], deep: usize, max: usize) -> Result<Walk, Error> {
    let walk = walk(path, endings, deep, max)?;
    if walk.found.is_empty() {
        return Err(none(path, endings));
    }
    Ok(walk)
}

/// There is none of the files that are wanted.
pub(super) fn none(path: &Path, endings: &[&str]) -> Error {
    let endings: Vec<String> = endings.iter().map(|one| format!("*.{one}")).collect();
    let endings = endings.join(" or ");
    Error::Refused(format!("{}: there is no {endings} here", named(path)))
}
