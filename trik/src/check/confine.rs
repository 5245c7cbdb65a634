//! What is asked and told once of the sandbox of solutions in Python, before anything runs.
//!
//! Owns for which files that is. What the layers are is known to `sandbox`.

use super::args::CheckArgs;
use super::jobs::Job;
use super::script::{Language, embeds_python};
use crate::refusal::{Refusal, UNREADABLE, say};
use crate::sandbox::{delegated, lacks, python, required};
use nix::unistd::geteuid;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};

/// Asks for Python once, if there are solutions in it, and tells what their sandbox lacks.
///
/// # Errors
/// Something is missing, and all is demanded.
pub(super) fn settle(jobs: &[Job], args: &CheckArgs) -> Result<CheckArgs, Refusal> {
    let mut args = args.clone();
    let is_python = |path: &Path| Language::of(path) == Some(Language::Python);
    // One program for all, or each its own.
    let files: Vec<&Path> = match &args.script {
        Some(script) => vec![script],
        None => jobs.iter().map(|job| &*job.solution).collect(),
    };
    let folders: BTreeSet<PathBuf> = files
        .into_iter()
        .filter(|file| is_python(file) || args.is_embedded && embeds_python(file))
        .filter_map(|file| Some(std::path::absolute(file).ok()?.parent()?.to_owned()))
        .collect();
    if folders.is_empty() || !args.log.is_empty() {
        return Ok(args);
    }
    // Without Python each run says so.
    let Ok(found) = python() else {
        return Ok(args);
    };
    args.sandbox.python = found;
    let missing = args.sandbox.sandbox();
    let missing = missing.missing(folders.iter().map(PathBuf::as_path));
    let missing = missing.map_err(|error| Refusal {
        code: UNREADABLE,
        ..error.into()
    })?;
    let lines = lacks(&missing, geteuid().is_root(), args.language);
    let lines = lines.into_iter();
    let mut lines: Vec<String> = lines.map(|line| format!("trik: {line}")).collect();
    if args.sandbox.require_sandbox && !lines.is_empty() {
        lines.push(format!("trik: {}", required(args.language)));
        return Err(Refusal {
            lines,
            code: UNREADABLE,
        });
    }
    say(&lines);
    args.sandbox.group = delegated();
    Ok(args)
}
