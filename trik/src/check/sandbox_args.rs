//! The options of `trik check` for the sandbox of solutions in Python, and what is told of it before anything runs.
//!
//! Owns these options and how they are passed to a worker process. What the layers are is known to `sandbox`.

use super::args::CheckArgs;
use super::jobs::Job;
use super::script::{Language, embeds_python};
use crate::refusal::{Refusal, UNREADABLE, say};
use crate::sandbox::{Layer, Sandbox, delegated, lacks, named, python, required};
use clap::Args;
use nix::unistd::geteuid;
use std::collections::BTreeSet;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Options for the sandbox.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct SandboxArgs {
    /// Run no solution in Python unless this computer gives every layer of their sandbox; without it what is missing is
    /// told, and they run.
    #[arg(long, conflicts_with = "log")]
    pub require_sandbox: bool,
    /// Do as if the kernel did not have this layer.
    #[arg(long = "without-layer", value_name = "LAYER", hide = true, value_parser = named)]
    pub without: Vec<Layer>,
    /// The interpreter, and then folders that it reads.
    #[arg(long, hide = true)]
    pub python: Vec<PathBuf>,
    /// The control group in which programs get one each.
    #[arg(long = "control-group", hide = true)]
    pub group: Option<PathBuf>,
}

impl SandboxArgs {
    /// What a program in Python is confined by.
    pub(super) fn sandbox(&self) -> Sandbox {
        let sandbox = Sandbox::new(&self.python, &self.without, self.require_sandbox);
        sandbox.below(self.group.as_deref())
    }

    /// As words for a worker process.
    pub(super) fn for_worker(&self) -> Vec<OsString> {
        let mut words: Vec<OsString> = Vec::new();
        if self.require_sandbox {
            words.push("--require-sandbox".into());
        }
        let layers = self.without.iter();
        words.extend(layers.map(|layer| format!("--without-layer={}", layer.name()).into()));
        let python = self.python.iter().map(|path| ("--python=", path));
        let group = self.group.iter().map(|path| ("--control-group=", path));
        for (name, path) in python.chain(group) {
            let mut word = OsString::from(name);
            word.push(path);
            words.push(word);
        }
        words
    }
}

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
