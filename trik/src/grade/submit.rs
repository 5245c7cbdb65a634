//! `trik grade-submit`: hands files in, and waits for their results.
//!
//! Owns the exit status, which is that of `trik check`, and how long is waited.

use super::args::SubmitArgs;
use super::way::with;
use crate::error::Error;
use crate::input;
use crate::input::words::{A_FILE, why};
use crate::output::standard;
use crate::refusal::{REFUSED, Refusal, UNREADABLE};
use crate::terminal::named;
use grading::queue::Receipt;
use grading::{Ends, Submission, Waiter, limits};
use serde_json::Value;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsStr;
use std::fmt::Display;
use std::path::Path;
use std::time::Duration;

/// Hands them in.
///
/// # Errors
/// A file cannot be read, or the server is not reached.
pub fn submit(args: &SubmitArgs) -> Result<u8, Refusal> {
    let files = args.files.iter();
    let all: Vec<_> = files
        .map(|file| read(file, args).map(|submission| (file, submission)))
        .collect::<Result<_, _>>()?;
    with(&args.server, "grade-submit", async |queue| {
        // Before anything is handed in, so that none is missed.
        let waiter = Waiter::new(&queue).await?;
        let mut ends = Ends::new()?;
        let mut missing: BTreeMap<String, Vec<&Path>> = BTreeMap::new();
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
                };
                standard(format!("{id} {word} {}\n", named(file)).as_bytes())?;
            }
            missing.entry(id).or_default().push(file);
        }
        if !args.wait {
            return Ok(0);
        }
        let patience = args
            .timeout
            .map(|seconds| Duration::from_secs(seconds.into()));
        let mut code = 0;
        let ids: BTreeSet<String> = missing.keys().cloned().collect();
        let told = |result: &str| {
            code = code.max(tell(result, &missing)?);
            Ok::<(), Refusal>(())
        };
        match waiter.wait(ids, patience, &mut ends, told).await? {
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

/// Prints a result, once for each file that it is of; the exit status that it has.
fn tell(result: &str, files: &BTreeMap<String, Vec<&Path>>) -> Result<u8, Refusal> {
    let Ok(mut result) = serde_json::from_str::<Value>(result) else {
        return Ok(UNREADABLE);
    };
    let of = result["id"].as_str().and_then(|id| files.get(id));
    for path in of.into_iter().flatten() {
        result["path"] = path.to_string_lossy().into();
        standard(format!("{result}\n").as_bytes())?;
    }
    let runs = result["runs"].as_array().map_or(&[][..], Vec::as_slice);
    let code = |run: &Value| match run["verdict"].as_str() {
        Some("accomplished" | "ended") => 0,
        Some("failed") => REFUSED,
        Some(_) | None => UNREADABLE,
    };
    let worst = runs.iter().map(code).max().unwrap_or(UNREADABLE);
    Ok(match result["dead"].is_null() {
        true => worst,
        false => UNREADABLE,
    })
}

fn unfinished(count: usize) -> Refusal {
    Refusal {
        code: UNREADABLE,
        ..Refusal::new(format!(
            "not judged yet: {count}; they stay in the queue, and the same command shows their results"
        ))
    }
}
