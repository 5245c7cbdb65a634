//! The options of `trik check` for the sandbox of solutions in Python.
//!
//! Owns these options and how they are passed to a worker process. What the layers are is known to `sandbox`.

use crate::sandbox::{Layer, Sandbox, named};
use clap::Args;
use std::ffi::OsString;
use std::path::PathBuf;

/// Options for the sandbox.
#[derive(Args, Clone, Debug, Default)]
pub(crate) struct SandboxArgs {
    /// Run no solution in Python unless this computer gives every layer of their sandbox. Without this option they run, and
    /// what is missing is told once.
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
