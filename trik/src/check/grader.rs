//! Submissions of a queue, judged as `trik check --tasks` judges them.
//!
//! Owns the folder in which a submission is while it is judged, and what a result has of it. Knows no server.

use super::args::CheckArgs;
use super::class::{self, Task};
use super::confine;
use super::jobs::{Job, shown};
use super::lodging::{self, readable};
use super::pool::{Slot, broken};
use super::row::Row;
use super::run::{REPORT, report};
use super::script::Language;
use super::walk::Passed;
use super::words;
use crate::error::Error;
use crate::refusal::{Refusal, say};
use crate::terminal::named;
use crate::{input, limits};
use grading::{Judge, Judged, Submission};
use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fs::{self, DirBuilder, File};
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use studio::verdict::Verdict;
use tempfile::TempDir;

/// What all judges of a worker share.
struct Room {
    args: CheckArgs,
    tasks: BTreeMap<String, Task>,
    folder: TempDir,
    /// For as long as it is held nobody takes the folder away.
    _claim: File,
}

/// Judges one submission at a time, in a process of its own.
pub(crate) struct Grader {
    room: Arc<Room>,
    slot: Slot,
    /// Where its submissions are.
    folder: PathBuf,
    /// Which one it is.
    number: u16,
}

/// What a worker judges, and how.
pub(crate) struct Wanted<'a> {
    /// The tasks, as of `trik check --tasks`.
    pub tasks: &'a Path,
    /// Tell why each run ended so.
    pub explain: bool,
    /// Seconds of simulated time.
    pub time_limit: f64,
    /// Seconds of real time.
    pub wall_limit: f64,
    /// MiB of a process.
    pub memory: u32,
    /// Run nothing in Python without its whole sandbox.
    pub require_sandbox: bool,
    /// Of messages.
    pub language: lang_text::problem::Locale,
}

/// So many judges, and the names of the tasks.
///
/// # Errors
/// The tasks cannot be read, there is no place for submissions, or a layer of the sandbox is missing that is demanded.
pub(crate) fn graders(
    wanted: &Wanted<'_>,
    count: u16,
) -> Result<(Vec<Grader>, Vec<String>), Refusal> {
    let mut args = CheckArgs {
        explain: wanted.explain,
        time_limit: wanted.time_limit,
        wall_limit: wanted.wall_limit,
        memory: wanted.memory,
        language: wanted.language,
        ..CheckArgs::plain()
    };
    args.sandbox.require_sandbox = wanted.require_sandbox;
    args.force = true;
    let mut passed = Passed::default();
    let tasks = class::tasks(wanted.tasks, &args, &mut passed)?;
    let told = passed.told.iter();
    let told = told.map(|(path, reason)| words::passed(&named(path), reason, args.language));
    say(&told.map(|line| format!("trik: {line}")).collect::<Vec<_>>());
    let (folder, claim) = lodging::new().map_err(place)?;
    let reports = folder.path().join("reports");
    DirBuilder::new()
        .mode(0o700)
        .create(&reports)
        .map_err(place)?;
    args.report = Some(reports);
    // What the sandbox of Python lacks is told once, and not for each submission.
    let any = Job {
        solution: folder.path().join("any.py"),
        field: None,
        log: None,
        given: None,
        inputs: None,
        name: PathBuf::new(),
    };
    let args = confine::settle(&[any], &args)?;
    let names = tasks.iter().map(|task| task.name.clone()).collect();
    let tasks = tasks.into_iter();
    let room = Arc::new(Room {
        args,
        tasks: tasks.map(|task| (task.name.clone(), task)).collect(),
        folder,
        _claim: claim,
    });
    let grader = |number: u16| Grader {
        slot: Slot::new(&room.args),
        folder: room.folder.path().join(number.to_string()),
        number,
        room: room.clone(),
    };
    Ok(((0..count).map(grader).collect(), names))
}

fn place(error: std::io::Error) -> Error {
    Error::system("a folder for submissions", error)
}

impl Judge for Grader {
    fn judge(&mut self, submission: &Submission) -> Judged {
        let Some(task) = self.room.tasks.get(submission.task()).cloned() else {
            let why = format!("this worker has no task '{}'", submission.task());
            return Judged::Failed(why, Vec::new());
        };
        let judged = match self.lay_out(submission) {
            Ok(path) => self.runs(&path, &task, submission),
            Err(error) => Judged::Failed(place(error).to_string(), Vec::new()),
        };
        // The next one finds nothing of it. What cannot be removed is met then.
        let _ = fs::remove_dir_all(&self.folder);
        judged
    }
}

impl Grader {
    /// Writes it into a folder of its own.
    fn lay_out(&self, submission: &Submission) -> std::io::Result<PathBuf> {
        if self.folder.exists() {
            fs::remove_dir_all(&self.folder)?;
        }
        fs::create_dir(&self.folder)?;
        readable(&self.folder)?;
        let path = self.folder.join(submission.file());
        fs::write(&path, submission.bytes())?;
        Ok(path)
    }

    /// A row without the place of the submission, which is nobody's business and another one each time.
    fn told(&self, mut row: Row) -> Row {
        let place = format!("{}/", self.folder.display());
        let texts = row.messages.iter_mut().map(|(_, text)| text);
        for text in texts.chain(&mut row.printed) {
            if text.contains(&place) {
                *text = text.replace(&place, "");
            }
        }
        row
    }

    /// What the run has left as its report, which is not there for the next one. None if it is too large for a result.
    fn report(&self, job: &Job) -> Option<String> {
        let path = job.place(self.room.args.report.as_deref()?, REPORT, false);
        let text = input::read(&path, limits::REPORT_BYTES_MAX);
        // What cannot be removed is written over.
        let _ = fs::remove_file(&path);
        String::from_utf8(text.ok()?).ok()
    }

    /// Runs it in each world of its task.
    fn runs(&mut self, path: &Path, task: &Task, submission: &Submission) -> Judged {
        let ending = path.extension().and_then(OsStr::to_str).unwrap_or_default();
        if !matches!(ending, "qrs" | "flow") && Language::of(path).is_none() {
            let why = "it is no solution: a name ends with .qrs, .flow, .js or .py";
            let row = Row::broken(submission.file().to_owned(), None, why.to_owned());
            return Judged::Done(vec![value(row, submission)]);
        }
        let (mut rows, mut failed) = (Vec::new(), None);
        for world in &task.worlds {
            let job = Job {
                solution: path.to_owned(),
                field: world.clone(),
                log: None,
                given: task.given.clone(),
                inputs: world.as_deref().and_then(class::inputs_of),
                name: PathBuf::from(self.number.to_string()),
            };
            let args = &self.room.args;
            let row = self.slot.row(&job, args);
            let row = row.unwrap_or_else(|why| {
                let mut row = broken(&job, args, &why);
                let said = row.messages.clone();
                report(&job, args, &mut row, &said);
                row
            });
            let row = self.told(row);
            if row.verdict == Verdict::NotRun {
                failed.get_or_insert_with(|| row.why().to_owned());
            }
            let mut value = value(row, submission);
            value["report"] = self.report(&job).into();
            rows.push(value);
        }
        match failed {
            None => Judged::Done(rows),
            Some(why) => Judged::Failed(why, rows),
        }
    }
}

/// A row as a result has it: names of files are those of the submission and of the task.
fn value(mut row: Row, submission: &Submission) -> Value {
    row.solution = submission.file().to_owned();
    let name = |field: &String| {
        Path::new(field)
            .file_name()
            .map(|name| shown(Path::new(name)))
    };
    row.field = row.field.as_ref().and_then(name);
    serde_json::from_str(&row.write()).unwrap_or(Value::Null)
}
