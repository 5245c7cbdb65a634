//! Which solution is run in which world: files, directories and fields to a list of runs.
//!
//! Owns the order (as it was said, directories by name) and the names of files that a run writes. Opens nothing but
//! directories; links to directories are not followed.

use super::args::CheckArgs;
use crate::error::Error;
use crate::input::Unread;
use crate::input::words::{A_FILE, why};
use crate::limits;
use crate::terminal::named;
use lang_text::problem::Locale;
use std::collections::HashSet;
use std::ffi::OsStr;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// One run to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Job {
    /// The solution; a record alone stands here itself.
    pub solution: PathBuf,
    /// The world in place of its own.
    pub field: Option<PathBuf>,
    /// A record that is judged in place of running the solution.
    pub log: Option<PathBuf>,
    /// The save that pupils were given for this task, if not that of all runs.
    pub given: Option<PathBuf>,
    /// What files of this run are called, below a directory for results and without an ending.
    pub name: PathBuf,
}

impl Job {
    /// What is judged, as people are told: a record, a program in place of the diagram, or the solution.
    pub fn judged<'a>(&'a self, args: &'a CheckArgs) -> &'a Path {
        let other = self.log.as_deref().or(args.script.as_deref());
        other.unwrap_or(&self.solution)
    }

    /// Where the rules come from, if not from what is judged.
    pub fn rules(&self, args: &CheckArgs) -> Option<&Path> {
        let is_own = self.judged(args) == self.solution;
        let save = (!is_own).then_some(&*self.solution);
        self.field.as_deref().or(save)
    }

    /// Where a file of this run goes: the file itself if it is the only run, or else one in a directory.
    pub fn place(&self, wanted: &Path, ending: &str, is_one: bool) -> PathBuf {
        if is_one {
            return wanted.to_owned();
        }
        let mut name = self.name.clone().into_os_string();
        name.push(ending);
        wanted.join(name)
    }
}

/// A path as a row has it.
pub(super) fn shown(path: &Path) -> String {
    path.to_string_lossy().into_owned()
}

/// All runs.
///
/// # Errors
/// A path that cannot be read, a directory without solutions or fields, more than the limits allow.
pub(super) fn jobs(args: &CheckArgs) -> Result<Vec<Job>, Error> {
    let fields = fields(args)?;
    let solutions = match args.log.is_empty() {
        true => solutions(args)?,
        false => return recorded(args, &fields),
    };
    let (mut all, mut names) = (Vec::new(), HashSet::new());
    for (solution, name) in solutions {
        for field in &fields {
            all.push(Job {
                solution: solution.clone(),
                field: field.clone(),
                log: None,
                given: None,
                name: free(&name, field.as_deref(), fields.len() > 1, &mut names),
            });
        }
        bound(&all)?;
    }
    Ok(all)
}

/// The worlds of all solutions; `None` is a solution's own.
pub(super) fn fields(args: &CheckArgs) -> Result<Vec<Option<PathBuf>>, Error> {
    let mut fields: Vec<Option<PathBuf>> = Vec::new();
    if args.own || args.field.is_empty() {
        fields.push(None);
    }
    for path in &args.field {
        let found = below(path, &["xml"], 1, limits::FIELDS_MAX)?;
        fields.extend(found.into_iter().map(|(field, _)| Some(field)));
        if fields.len() > limits::FIELDS_MAX {
            return Err(too_many_fields());
        }
    }
    Ok(fields)
}

/// Why no more fields are taken.
pub(super) fn too_many_fields() -> Error {
    let max = limits::FIELDS_MAX;
    Error::Refused(format!("there are more than {max} fields"))
}

/// Refuses more runs than a command does.
pub(super) fn bound(jobs: &[Job]) -> Result<(), Error> {
    let max = limits::SOLUTIONS_MAX;
    match jobs.len() > max {
        true => Err(Error::Refused(format!(
            "there are more than {max} runs to do"
        ))),
        false => Ok(()),
    }
}

/// All solutions, with their names from where they were looked for.
fn solutions(args: &CheckArgs) -> Result<Vec<(PathBuf, PathBuf)>, Error> {
    let endings: &[&str] = match args.field.is_empty() {
        true => &["qrs"],
        false => &["qrs", "js", "py"],
    };
    let mut all = Vec::new();
    for path in &args.paths {
        all.extend(below(
            path,
            endings,
            limits::FOLDERS_DEEP,
            limits::SOLUTIONS_MAX,
        )?);
    }
    Ok(all)
}

/// Programs in directories that have no world to run in, for a word about them.
pub(super) fn left_out(args: &CheckArgs) -> usize {
    if !args.field.is_empty() || !args.log.is_empty() || args.script.is_some() {
        return 0;
    }
    let folders = args.paths.iter().filter(|path| path.is_dir());
    let programs = folders.map(|path| {
        let max = limits::SOLUTIONS_MAX;
        let found = below(path, &["js", "py"], limits::FOLDERS_DEEP, max);
        found.map_or(0, |found| found.len())
    });
    programs.sum()
}

/// All records, each against the rules of each world.
fn recorded(args: &CheckArgs, fields: &[Option<PathBuf>]) -> Result<Vec<Job>, Error> {
    let save = match &args.paths[..] {
        [] if args.field.is_empty() => {
            return Err(Error::Refused(
                "--log needs rules: --field WORLD.xml, or a save that has them".to_owned(),
            ));
        }
        [] if args.own => {
            return Err(Error::Refused(
                "--own needs a save, whose world it is".to_owned(),
            ));
        }
        [] => None,
        [save] if !save.is_dir() => Some(save),
        _ => {
            return Err(Error::Refused(
                "with --log, name one save: that whose world has the rules".to_owned(),
            ));
        }
    };
    let (mut all, mut names) = (Vec::new(), HashSet::new());
    for path in &args.log {
        for (log, name) in below(path, &["json"], limits::FOLDERS_DEEP, limits::SOLUTIONS_MAX)? {
            all.extend(fields.iter().map(|field| Job {
                solution: save.unwrap_or(&log).clone(),
                field: field.clone(),
                log: Some(log.clone()),
                given: None,
                name: free(&name, field.as_deref(), fields.len() > 1, &mut names),
            }));
        }
        bound(&all)?;
    }
    Ok(all)
}

/// A name for files that no other run has.
pub(super) fn free(
    name: &Path,
    field: Option<&Path>,
    are_many: bool,
    names: &mut HashSet<PathBuf>,
) -> PathBuf {
    let mut whole = name.with_extension("").into_os_string();
    if are_many {
        let field = field.and_then(Path::file_stem);
        whole.push("--");
        whole.push(field.unwrap_or(OsStr::new("own")));
    }
    let mut found = PathBuf::from(&whole);
    let mut count = 1;
    while !names.insert(found.clone()) {
        count += 1;
        let mut other = whole.clone();
        other.push(format!("-{count}"));
        found = other.into();
    }
    found
}

/// Why a file or a directory cannot be looked at.
pub(super) fn unread(path: &Path, error: io::Error, locale: Locale) -> Error {
    let words = why(&Unread::from(error), 0, A_FILE);
    Error::Refused(format!("{}: {}", named(path), words.in_locale(locale)))
}

/// A file as it is, or those with an ending below a directory, sorted, with their names from there.
pub(super) fn below(
    path: &Path,
    endings: &[&str],
    deep: usize,
    max: usize,
) -> Result<Vec<(PathBuf, PathBuf)>, Error> {
    let failed = |error: io::Error| unread(path, error, Locale::English);
    if !fs::metadata(path).map_err(failed)?.is_dir() {
        let name = path.file_name().map_or_else(|| path.into(), PathBuf::from);
        return Ok(vec![(path.to_owned(), name)]);
    }
    let mut found = Vec::new();
    let mut folders = vec![(path.to_owned(), 0)];
    while let Some((folder, depth)) = folders.pop() {
        for entry in fs::read_dir(&folder).map_err(failed)? {
            let entry = entry.map_err(failed)?;
            let kind = entry.file_type().map_err(failed)?;
            let inside = entry.path();
            let is_wanted = || {
                let ending = inside.extension().and_then(OsStr::to_str);
                ending.is_some_and(|ending| endings.contains(&ending))
            };
            if kind.is_dir() {
                if depth + 1 < deep {
                    folders.push((inside, depth + 1));
                }
            } else if is_wanted() && (kind.is_file() || inside.is_file()) {
                let name = inside.strip_prefix(path).unwrap_or(&inside).to_owned();
                found.push((inside, name));
                if found.len() > max {
                    return Err(Error::Refused(format!(
                        "{}: there are more than {max} files",
                        named(path)
                    )));
                }
            }
        }
    }
    if found.is_empty() {
        let endings: Vec<String> = endings.iter().map(|one| format!("*.{one}")).collect();
        let endings = endings.join(" and ");
        return Err(Error::Refused(format!(
            "{}: there is no {endings} here",
            named(path)
        )));
    }
    found.sort();
    Ok(found)
}
