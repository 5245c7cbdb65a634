//! `trik grade-submit`: hands files in, and waits for their results.
//!
//! Owns the exit status, which is that of `trik check`, and how long is waited.

use super::args::SubmitArgs;
use super::way::with;
use crate::error::Error;
use crate::input;
use crate::input::words::{A_FILE, why};
use crate::output::{Output, standard};
use crate::refusal::{REFUSED, Refusal, UNREADABLE, say};
use crate::terminal::named;
use grading::queue::Receipt;
use grading::{Ends, Outcome, Submission, Waiter, limits};
use lang_text::problem::Locale;
use serde_json::Value;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::fmt::Display;
use std::path::Path;
use std::time::Duration;

/// Hands them in.
///
/// # Errors
/// A file cannot be read, or the server is not reached.
pub fn submit(args: &SubmitArgs) -> Result<u8, Refusal> {
    if let (Some(folder), true) = (&args.report, args.files.len() > 1) {
        let why = "--report is for one file: those of several would have the same names";
        return Err(refused(folder, why));
    }
    let files = args.files.iter();
    let all: Vec<_> = files
        .map(|file| read(file, args).map(|submission| (file, submission)))
        .collect::<Result<_, _>>()?;
    with(&args.server, "grade-submit", async |queue| {
        // Before anything is handed in, so that none is missed.
        let waiter = Waiter::new(&queue).await?;
        let mut ends = Ends::new()?;
        let mut files: BTreeMap<String, Vec<&Path>> = BTreeMap::new();
        let mut missing: BTreeMap<String, &Submission> = BTreeMap::new();
        let mut code = 0;
        for (file, submission) in &all {
            let receipt = queue.submit(submission).await;
            let receipt = receipt.map_err(|why| {
                let line = format!("trik: {}: {why}", named(file));
                Refusal {
                    lines: vec![line],
                    code: UNREADABLE,
                }
            })?;
            let id = submission.id();
            if !args.wait {
                let word = match receipt {
                    Receipt::Taken => "taken",
                    Receipt::Waits => "waits",
                    Receipt::Judged => "judged",
                    Receipt::Blocked => {
                        say(&[format!(
                            "trik: {}: something else is in its place in the queue, which a worker puts aside: hand it in again then",
                            named(file)
                        )]);
                        code = UNREADABLE;
                        "blocked"
                    }
                };
                standard(format!("{id} {word} {}\n", named(file)).as_bytes())?;
            }
            files.entry(id.clone()).or_default().push(file);
            missing.insert(id, submission);
        }
        if !args.wait {
            return Ok(code);
        }
        let patience = args
            .timeout
            .map(|seconds| Duration::from_secs(seconds.into()));
        let told = |id: &str, result: Result<Outcome, grading::Error>| {
            let paths = files.get(id).map_or(&[][..], Vec::as_slice);
            code = code.max(match result {
                Ok(outcome) => tell(outcome, paths, args)?,
                Err(why) => {
                    let line = |path: &&Path| format!("trik: {}: {why}", named(path));
                    say(&paths.iter().map(line).collect::<Vec<_>>());
                    UNREADABLE
                }
            });
            Ok::<(), Refusal>(())
        };
        match waiter.wait(missing, patience, &mut ends, told).await? {
            0 => Ok(code),
            count => Err(unfinished(count)),
        }
    })
}

/// A file as a submission.
fn read(path: &Path, args: &SubmitArgs) -> Result<Submission, Refusal> {
    let most = limits::SUBMISSION_BYTES_MAX as u64;
    let bytes = input::read(path, most)
        .map_err(|unread| refused(path, why(&unread, most, A_FILE).english))?;
    let text = |name: Option<&OsStr>| name.map(|name| name.to_string_lossy().into_owned());
    let name = text(path.file_name()).unwrap_or_default();
    let stem = text(path.file_stem()).unwrap_or_default();
    let task = args.task.as_deref().unwrap_or(&stem);
    let ending = path.extension().and_then(OsStr::to_str);
    if !matches!(ending, Some("qrs" | "flow" | "js" | "py")) {
        let why = "it is no solution: a name ends with .qrs, .flow, .js or .py";
        return Err(refused(path, why));
    }
    Submission::new(task, &name, bytes).map_err(|why| refused(path, why))
}

/// A file that cannot be handed in.
fn refused(path: &Path, why: impl Display) -> Refusal {
    Refusal {
        code: UNREADABLE,
        ..Error::file(path, why).into()
    }
}

/// Prints a result, once for each file that it is of, and writes its reports; the exit status that it has.
fn tell(outcome: Outcome, paths: &[&Path], args: &SubmitArgs) -> Result<u8, Refusal> {
    let code = |run: &Value| match run["verdict"].as_str() {
        Some("accomplished" | "ended") => 0,
        Some("failed") => REFUSED,
        Some(_) | None => UNREADABLE,
    };
    let worst = match outcome.dead() {
        Some(_) => UNREADABLE,
        None => outcome.runs().iter().map(code).max().unwrap_or(UNREADABLE),
    };
    if let (Some(folder), Some(file)) = (&args.report, args.files.first()) {
        for run in outcome.runs() {
            report(run, folder, file)?;
        }
    }
    let mut result = outcome.into_value();
    for path in paths {
        result["path"] = path.to_string_lossy().into();
        standard(format!("{result}\n").as_bytes())?;
    }
    Ok(worst)
}

/// Writes the report of a run, by the name of its field; without one by that of the file.
fn report(run: &Value, folder: &Path, file: &Path) -> Result<(), Refusal> {
    let field = run["field"].as_str().map(Path::new);
    // A result is from elsewhere: a name has no folders.
    let name = field.unwrap_or(file).file_stem().unwrap_or_default();
    let mut name = name.to_owned();
    name.push(".json");
    let path = folder.join(name);
    let Some(text) = run["report"].as_str() else {
        return Err(refused(&path, "the result has no report: it was too large"));
    };
    let made = std::fs::create_dir_all(folder);
    made.map_err(|error| Error::system(format!("{} cannot be made", named(folder)), error))?;
    let output = Output {
        path: Some(&path),
        force: true,
        source: file,
        locale: Locale::English,
    };
    output.write(text.as_bytes())
}

fn unfinished(count: usize) -> Refusal {
    Refusal {
        code: UNREADABLE,
        ..Refusal::new(format!(
            "not judged yet: {count}; they stay in the queue, and the same command shows their results"
        ))
    }
}
