//! Which solution is run in which world: files, directories and fields to a list of runs.
//!
//! Owns the order (as it was said, directories by name) and the names of files that a run writes. Directories are walked
//! in `walk`; opens nothing.

use super::args::CheckArgs;
use super::walk::{Passed, Reason, below, walk};
use crate::error::Error;
use crate::limits;
use std::collections::HashSet;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};

/// The endings of records: trajectories, and recordings of robots.
const RECORDS: &[&str] = &["json", "mcap"];

/// One run to be done.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Job {
    /// The solution; a record alone stands here itself.
    pub solution: PathBuf,
    /// The world instead of its own.
    pub field: Option<PathBuf>,
    /// A record that is judged instead of running the solution.
    pub log: Option<PathBuf>,
    /// The save that pupils were given for this task, if not that of all runs.
    pub given: Option<PathBuf>,
    /// Lines for programs that read, if not those of all runs.
    pub inputs: Option<PathBuf>,
    /// What files of this run are called, below a directory for results and without an ending.
    pub name: PathBuf,
}

impl Job {
    /// What is judged, as people are told: a record, a program instead of the diagram, or the solution.
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
    let chooses = args.recorded.from.is_some() || args.recorded.to.is_some();
    if chooses && args.log.is_empty() {
        let why = "--from and --to choose a part of a recording, which --log names";
        return Err(Error::Refused(why.to_owned()));
    }
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
                inputs: None,
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
        let found = below(path, &["xml"], 1, limits::FIELDS_MAX)?.found;
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

/// The endings of solutions: programs with text need a world from elsewhere.
fn endings(args: &CheckArgs) -> &'static [&'static str] {
    match args.field.is_empty() && args.task.is_none() {
        true => &["qrs", "flow"],
        false => &["qrs", "flow", "js", "py"],
    }
}

/// All solutions, with their names from where they were looked for.
fn solutions(args: &CheckArgs) -> Result<Vec<(PathBuf, PathBuf)>, Error> {
    let mut all = Vec::new();
    for path in &args.paths {
        let walk = below(
            path,
            endings(args),
            limits::FOLDERS_DEEP,
            limits::SOLUTIONS_MAX,
        )?;
        all.extend(walk.found);
    }
    Ok(all)
}

/// What directories of solutions have in them beside solutions and other files: what somebody may have meant to be judged.
pub(super) fn passed(args: &CheckArgs) -> Passed {
    let mut all = Passed::default();
    let paths = args.paths.iter().chain(&args.log);
    for path in paths.filter(|path| path.is_dir()) {
        let endings = if args.log.is_empty() {
            endings(args)
        } else {
            RECORDS
        };
        let walked = walk(path, endings, limits::FOLDERS_DEEP, limits::SOLUTIONS_MAX);
        let told = walked.map_or_else(|_| Vec::new(), |walk| walk.passed.told);
        for (path, reason) in told {
            match reason {
                Reason::Ending => {}
                Reason::LinkToFolder
                | Reason::BrokenLink
                | Reason::NoFile
                | Reason::TooDeep
                | Reason::Unreadable(_)
                | Reason::NoTask(_)
                | Reason::NoTaskFile
                | Reason::HasFields => all.note(path, reason),
            }
        }
    }
    all
}

/// Programs in directories that have no world to run in, for a word about them.
pub(super) fn left_out(args: &CheckArgs) -> usize {
    if endings(args).contains(&"js") || !args.log.is_empty() || args.script.is_some() {
        return 0;
    }
    let folders = args.paths.iter().filter(|path| path.is_dir());
    let programs = folders.map(|path| {
        let max = limits::SOLUTIONS_MAX;
        let walked = walk(path, &["js", "py"], limits::FOLDERS_DEEP, max);
        walked.map_or(0, |walk| walk.found.len())
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
        let walk = below(path, RECORDS, limits::FOLDERS_DEEP, limits::SOLUTIONS_MAX)?;
        for (log, name) in walk.found {
            all.extend(fields.iter().map(|field| Job {
                solution: save.unwrap_or(&log).clone(),
                field: field.clone(),
                log: Some(log.clone()),
                given: None,
                inputs: None,
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
