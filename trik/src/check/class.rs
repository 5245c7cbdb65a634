//! Whose solution is for which task: the folders of a class to pupils, tasks and runs.
//!
//! Owns how names of folders and files are understood, the fields of each task, and what is said of files that fit nowhere.
//! Runs nothing.

use super::args::CheckArgs;
use super::jobs::{self, Job};
use super::walk::{self, Passed, Reason};
use super::words;
use crate::error::Error;
use crate::limits;
use crate::terminal::named;
use lang_text::near::nearest;
use std::collections::{BTreeMap, BTreeSet, HashSet};
use std::ffi::{OsStr, OsString};
use std::fmt::Write;
use std::path::{Path, PathBuf};

/// A class, before it is judged.
#[derive(Debug, Default)]
pub(super) struct Plan {
    /// All runs.
    pub jobs: Vec<Job>,
    /// Of each run, whose it is and in which column it stands.
    pub places: Vec<(usize, usize)>,
    /// In the order of the table.
    pub pupils: Vec<String>,
    /// In the order of the table.
    pub columns: Vec<Column>,
    /// What a teacher should know before.
    pub notes: Vec<String>,
    /// What is in the folders and is not judged, each with its reason.
    pub left_out: Vec<String>,
    /// How much of it there is, told or not.
    pub left_out_count: usize,
}

/// A task in one of its worlds.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Column {
    /// The task.
    pub task: String,
    /// The world, if the task has several.
    pub field: Option<String>,
    /// What its points are multiplied with.
    pub weight: f64,
}

impl Column {
    /// As it is written: `task`, or `task/field`.
    pub fn name(&self) -> String {
        match &self.field {
            Some(field) => format!("{}/{field}", self.task),
            None => self.task.clone(),
        }
    }
}

/// A task and its worlds; `None` is the world of the solution.
#[derive(Clone, Debug)]
pub(super) struct Task {
    /// As its file or folder is called.
    pub name: String,
    /// At least one.
    pub worlds: Vec<Option<PathBuf>>,
    /// The save that was given out, whose locks hold.
    pub given: Option<PathBuf>,
}

/// A solution, with the names on the way to it: folders, and the file without its ending.
struct Solution {
    path: PathBuf,
    parts: Vec<String>,
    name: PathBuf,
}

/// The plan for the solutions that were named.
///
/// # Errors
/// A path that cannot be read, weights of what is not there, more than the limits allow.
pub(super) fn plan(args: &CheckArgs) -> Result<Plan, Error> {
    if !args.log.is_empty() {
        let why = "--grades is for solutions: recorded runs have no pupils";
        return Err(Error::Refused(why.to_owned()));
    }
    let mut passed = Passed::default();
    let tasks = match &args.grades.tasks {
        Some(folder) => Some(tasks(folder, args, &mut passed)?),
        None => None,
    };
    let found = found(args, tasks.is_some(), &mut passed)?;
    let (tasks, owners) = sorted(tasks, &found, args)?;
    let mut plan = Plan::default();
    let empty = empty_folders(args, &found, &tasks)?;
    let owned = owners.iter().flatten().map(|(pupil, _)| pupil);
    plan.set_pupils(args, owned.chain(&empty))?;
    let mut firsts = Vec::new();
    for task in &tasks {
        firsts.push(plan.columns.len());
        let is_many = task.worlds.len() > 1;
        plan.columns.extend(task.worlds.iter().map(|world| Column {
            task: task.name.clone(),
            field: is_many.then(|| stem_of(world.as_deref(), args)),
            weight: 1.0,
        }));
    }
    if plan.pupils.len().saturating_mul(plan.columns.len()) > limits::CELLS_MAX {
        return Err(Error::Refused(format!(
            "{} pupils and {} columns make too large a table",
            plan.pupils.len(),
            plan.columns.len()
        )));
    }
    plan.set_weights(&args.grades.weights)?;
    let mut names = HashSet::new();
    for (one, owner) in found.iter().zip(owners) {
        let Some((pupil, task)) = owner else {
            let known = tasks.iter().map(|task| task.name.as_str());
            let meant = passed.has_room().then(|| nearest(&stem(&one.path), known));
            let meant = meant.flatten().map(str::to_owned);
            passed.note(one.path.clone(), Reason::NoTask(meant));
            continue;
        };
        let pupil = plan.pupils.iter().position(|name| *name == pupil);
        let worlds = &tasks[task].worlds;
        for (index, world) in worlds.iter().enumerate() {
            plan.places
                .push((pupil.unwrap_or_default(), firsts[task] + index));
            plan.jobs.push(Job {
                solution: one.path.clone(),
                field: world.clone(),
                log: None,
                given: tasks[task].given.clone(),
                inputs: world.as_deref().and_then(inputs_of),
                name: jobs::free(&one.name, world.as_deref(), worlds.len() > 1, &mut names),
            });
        }
        jobs::bound(&plan.jobs)?;
    }
    let told = passed.told.iter();
    let told = told.map(|(path, reason)| words::passed(&named(path), reason, args.language));
    plan.left_out = told.collect();
    plan.left_out_count = passed.count;
    Ok(plan)
}

fn stem_of(world: Option<&Path>, args: &CheckArgs) -> String {
    match world {
        None => words::own(args.language).to_owned(),
        Some(path) => stem(path),
    }
}

fn stem(path: &Path) -> String {
    let stem = path.file_stem().unwrap_or(path.as_os_str());
    shown(stem)
}

/// A name of a file as a text. Bytes that are no UTF-8, as those of a zip from Windows, are shown by their numbers: two
/// pupils stay two.
fn shown(name: &OsStr) -> String {
    let mut text = String::new();
    for chunk in name.as_encoded_bytes().utf8_chunks() {
        text.push_str(chunk.valid());
        for byte in chunk.invalid() {
            let _ = write!(text, "\\x{byte:02X}");
        }
    }
    text
}

impl Plan {
    /// Those of the list first, in its order; then all who have solutions.
    fn set_pupils<'a>(
        &mut self,
        args: &CheckArgs,
        found: impl Iterator<Item = &'a String>,
    ) -> Result<(), Error> {
        if let Some(path) = &args.grades.pupils {
            let text = super::run::text(path, limits::WORLD_BYTES_MAX, args.language)?;
            let mut seen = HashSet::new();
            let names = text.trim_start_matches('\u{feff}').lines().map(str::trim);
            let names = names.filter(|name| !name.is_empty() && seen.insert(*name));
            self.pupils = names.map(str::to_owned).collect();
        }
        let listed: HashSet<&String> = self.pupils.iter().collect();
        let more: BTreeSet<&String> = found.filter(|name| !listed.contains(name)).collect();
        let more: Vec<String> = more.into_iter().cloned().collect();
        if args.grades.pupils.is_some() {
            let told = more.iter().take(limits::ROW_WARNINGS_MAX);
            let listed = || self.pupils.iter().map(String::as_str);
            let told = told.map(|name| words::unlisted(name, listed(), args.language));
            self.notes.extend(told);
        }
        self.pupils.extend(more);
        Ok(())
    }

    /// Weights such as `maze=2` and `maze/far=0.5`; the latter wins.
    fn set_weights(&mut self, weights: &[(String, f64)]) -> Result<(), Error> {
        let is_one = |name: &str| weights.iter().filter(|(other, _)| other == name).count() == 1;
        for (name, weight) in weights {
            if !is_one(name) {
                let why = format!("--weights: '{name}' has two weights");
                return Err(Error::Refused(why));
            }
            let mut is_there = false;
            for column in &mut self.columns {
                let (is_field, is_task) = (column.name() == *name, column.task == *name);
                is_there |= is_field || is_task;
                let has_own = weights.iter().any(|(other, _)| *other == column.name());
                if is_field || (is_task && !has_own) {
                    column.weight = *weight;
                }
            }
            if !is_there {
                let all: BTreeSet<String> = self.columns.iter().map(Column::name).collect();
                let all: Vec<String> = all.into_iter().take(limits::ROW_WARNINGS_MAX).collect();
                return Err(Error::Refused(format!(
                    "--weights: there is no '{name}'; there are: {}",
                    all.join(", ")
                )));
            }
        }
        Ok(())
    }
}

/// What programs read in a field of a task: a text beside it.
pub(super) fn inputs_of(field: &Path) -> Option<PathBuf> {
    Some(field.with_extension("txt")).filter(|path| path.is_file())
}

/// A text beside a field.
fn is_inputs(path: &Path) -> bool {
    path.extension() == Some(OsStr::new("txt")) && path.with_extension("xml").is_file()
}

/// The tasks of a folder: `NAME.xml` and folders of such files are fields, `NAME.qrs` is what was given out.
///
/// # Errors
/// There are none, or too many, or the folder cannot be read.
pub(super) fn tasks(
    folder: &Path,
    args: &CheckArgs,
    passed: &mut Passed,
) -> Result<Vec<Task>, Error> {
    let failed = |error: std::io::Error| walk::unread(folder, error, args.language);
    let mut all: BTreeMap<String, Task> = BTreeMap::new();
    let mut saves = Vec::new();
    let mut entries = Vec::new();
    for entry in std::fs::read_dir(folder).map_err(failed)? {
        entries.push(entry.map_err(failed)?.path());
    }
    entries.sort();
    for path in entries {
        let ending = path.extension().and_then(OsStr::to_str);
        let is_folder = path.is_dir();
        let name = match is_folder {
            true => shown(path.file_name().unwrap_or_default()),
            false => stem(&path),
        };
        let worlds: Vec<Option<PathBuf>> = match ending {
            _ if is_folder && !name.starts_with('.') => {
                let walk = walk::below(&path, &["xml"], 1, limits::FIELDS_MAX)?;
                let mut others = walk.passed;
                others.drop_if(is_inputs);
                passed.extend(others);
                let found = walk.found.into_iter();
                found.map(|(field, _)| Some(field)).collect()
            }
            Some("xml") if path.is_file() && !name.starts_with('.') => vec![Some(path)],
            Some("qrs") if path.is_file() && !name.starts_with('.') => {
                saves.push((name, path));
                continue;
            }
            Some(_) | None => {
                if !is_inputs(&path) {
                    passed.note(path, Reason::NoTaskFile);
                }
                continue;
            }
        };
        let task = all.entry(name.clone()).or_insert_with(|| Task {
            name,
            worlds: Vec::new(),
            given: None,
        });
        task.worlds.extend(worlds);
        if task.worlds.len() > limits::FIELDS_MAX {
            return Err(jobs::too_many_fields());
        }
    }
    for (name, path) in saves {
        if all.contains_key(&name) {
            passed.note(path, Reason::HasFields);
            continue;
        }
        let task = Task {
            name: name.clone(),
            worlds: vec![None],
            given: Some(path),
        };
        all.insert(name, task);
    }
    if all.is_empty() {
        return Err(Error::Refused(format!(
            "{}: there are no tasks here: fields NAME.xml, folders of fields, or saves NAME.qrs",
            named(folder)
        )));
    }
    Ok(all.into_values().collect())
}

/// All solutions. One directory is the class; of several each is a pupil. Programs with text run in fields, or in the save
/// that was given out.
fn found(args: &CheckArgs, has_tasks: bool, passed: &mut Passed) -> Result<Vec<Solution>, Error> {
    let has_worlds = has_tasks || !args.field.is_empty() || args.task.is_some();
    let endings: &[&str] = match has_worlds {
        true => &["qrs", "flow", "js", "py"],
        false => &["qrs", "flow"],
    };
    let mut all = Vec::new();
    for path in &args.paths {
        let is_pupil = args.paths.len() > 1 && path.is_dir();
        let walk = walk::walk(path, endings, limits::FOLDERS_DEEP, limits::SOLUTIONS_MAX)?;
        // A pupil who has handed in an empty folder is no reason to stop.
        if walk.found.is_empty() && !is_pupil {
            return Err(walk::none(path, endings));
        }
        passed.extend(walk.passed);
        let inside = walk.found;
        for (solution, name) in inside {
            let name = match (is_pupil, path.file_name()) {
                (true, Some(pupil)) => Path::new(pupil).join(name),
                (true, None) | (false, _) => name,
            };
            let parts = name.with_extension("");
            let parts = parts.components();
            let parts = parts.map(|part| shown(part.as_os_str()));
            all.push(Solution {
                path: solution,
                parts: parts.collect(),
                name,
            });
        }
    }
    Ok(all)
}

/// Folders of pupils in which there is no solution: they have handed in nothing, and have a row all the same.
fn empty_folders(
    args: &CheckArgs,
    found: &[Solution],
    tasks: &[Task],
) -> Result<Vec<String>, Error> {
    let mut folders = Vec::new();
    match &args.paths[..] {
        [class] if class.is_dir() => {
            let failed = |error| Error::system(format!("{} cannot be read", named(class)), error);
            for entry in std::fs::read_dir(class).map_err(failed)? {
                let entry = entry.map_err(failed)?;
                if entry.file_type().map_err(failed)?.is_dir() {
                    folders.push(entry.file_name());
                }
            }
        }
        paths => {
            let pupils = paths.iter().filter(|path| path.is_dir());
            folders.extend(
                pupils
                    .filter_map(|path| path.file_name())
                    .map(OsString::from),
            );
        }
    }
    let firsts: HashSet<&String> = found.iter().filter_map(|one| one.parts.first()).collect();
    let names = folders.iter().map(|name| shown(name));
    let names = names.filter(|name| !name.starts_with('.') && !firsts.contains(name));
    let is_task = |name: &String| {
        let name = name.to_lowercase();
        tasks.iter().any(|task| task.name.to_lowercase() == name)
    };
    Ok(names.filter(|name| !is_task(name)).collect())
}

type Owner = Option<(String, usize)>;

/// The tasks, and of each solution whose it is and for which of them; none for one that fits nowhere.
fn sorted(
    tasks: Option<Vec<Task>>,
    found: &[Solution],
    args: &CheckArgs,
) -> Result<(Vec<Task>, Vec<Owner>), Error> {
    let tasks = match tasks {
        Some(tasks) => tasks,
        None => {
            let worlds = jobs::fields(args)?;
            let task = |name: String| Task {
                name,
                worlds: worlds.clone(),
                given: args.task.clone(),
            };
            let names = names_of_tasks(found, args);
            names.into_iter().map(task).collect()
        }
    };
    let numbers: BTreeMap<String, usize> = (0..)
        .zip(&tasks)
        .map(|(index, task)| (task.name.to_lowercase(), index))
        .collect();
    let number = |part: &String| numbers.get(&part.to_lowercase()).copied();
    let owner = |one: &Solution| -> Owner {
        let (first, rest) = one.parts.split_first()?;
        // A folder for each task, with a file or a folder for each pupil.
        if let (Some(task), Some(pupil)) = (number(first), rest.first()) {
            return Some((pupil.clone(), task));
        }
        // A folder for each pupil.
        if let Some(task) = rest.iter().rev().find_map(number) {
            return Some((first.clone(), task));
        }
        (tasks.len() == 1).then(|| (first.clone(), 0))
    };
    let owners = found.iter().map(owner).collect();
    Ok((tasks, owners))
}

/// What the tasks are called if nobody says it: as the files in the folders of pupils are, unless each pupil has one file.
fn names_of_tasks(found: &[Solution], args: &CheckArgs) -> Vec<String> {
    let mut counts: BTreeMap<&String, usize> = BTreeMap::new();
    for pupil in found.iter().filter_map(|one| one.parts.first()) {
        *counts.entry(pupil).or_default() += 1;
    }
    let mut names = BTreeMap::new();
    for one in found.iter().filter(|one| one.parts.len() > 1) {
        if let Some(name) = one.parts.last() {
            names.entry(name.to_lowercase()).or_insert(name);
        }
    }
    if names.len() > 1 && counts.values().any(|count| *count > 1) {
        return names.into_values().cloned().collect();
    }
    let is_told = names.len() == 1 && found.iter().all(|one| one.parts.len() > 1);
    let only = names.into_values().next().filter(|_| is_told);
    vec![only.map_or_else(|| words::task(args.language).to_owned(), String::clone)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::Parser;

    #[derive(Parser)]
    struct Line {
        #[command(flatten)]
        args: CheckArgs,
    }

    fn found(paths: &[&str]) -> Vec<Solution> {
        let one = |path: &&str| {
            let name = PathBuf::from(path);
            let parts = name.with_extension("");
            let parts = parts.iter().map(|part| part.to_string_lossy().into_owned());
            Solution {
                path: name.clone(),
                parts: parts.collect(),
                name,
            }
        };
        paths.iter().map(one).collect()
    }

    #[test]
    fn names_of_other_encodings_stay_different() {
        use std::os::unix::ffi::OsStrExt;
        let names = [
            &b"\xC0\xED\xED\xE0"[..],
            b"\xC2\xE5\xF0\xE0",
            b"a\xFFb",
            "\u{410}".as_bytes(),
        ];
        let shown = names.map(|name| shown(OsStr::from_bytes(name)));
        assert_eq!(
            shown,
            [
                "\\xC0\\xED\\xED\\xE0",
                "\\xC2\\xE5\\xF0\\xE0",
                "a\\xFFb",
                "\u{410}"
            ]
        );
    }

    fn task(name: &str) -> Task {
        Task {
            name: name.into(),
            worlds: vec![None],
            given: None,
        }
    }

    /// Whose it is, and the name of the task.
    fn understood(tasks: Option<Vec<Task>>, paths: &[&str]) -> Vec<String> {
        let args = Line::parse_from(["check", "class"]).args;
        let (tasks, owners) = sorted(tasks, &found(paths), &args).unwrap();
        let shown = |owner: Owner| match owner {
            Some((pupil, task)) => format!("{pupil}:{}", tasks[task].name),
            None => "-".to_owned(),
        };
        owners.into_iter().map(shown).collect()
    }

    #[test]
    fn folders_of_a_class_are_understood_in_each_usual_form() {
        let all = [
            "anna/line.qrs",
            "anna/Maze.qrs",
            "boris/maze.qrs",
            "lost.qrs",
        ];
        let expected = ["anna:line", "anna:Maze", "boris:Maze", "-"];
        assert_eq!(understood(None, &all), expected);
        // One file each, whatever it is called.
        assert_eq!(
            understood(None, &["anna/a.qrs", "boris/b.qrs", "clara.qrs"]),
            ["anna:task", "boris:task", "clara:task"]
        );
        assert_eq!(
            understood(None, &["anna/line.qrs", "boris/line.qrs"]),
            ["anna:line", "boris:line"]
        );
        assert_eq!(understood(None, &["a.qrs", "b.qrs"]), ["a:task", "b:task"]);
        // Tasks that are known.
        let both = || Some(vec![task("line"), task("maze")]);
        assert_eq!(
            understood(
                both(),
                &[
                    "anna/LINE.qrs",
                    "maze/boris.qrs",
                    "clara/day2/maze/x.qrs",
                    "d/e.qrs"
                ]
            ),
            ["anna:line", "boris:maze", "clara:maze", "-"]
        );
        let one = || Some(vec![task("line")]);
        assert_eq!(
            understood(one(), &["anna.qrs", "line/boris.qrs", "clara/mine.qrs"]),
            ["anna:line", "boris:line", "clara:line"]
        );
    }
}
