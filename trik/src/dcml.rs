//! Models of robots on this computer: `trik dcml ...`.
//!
//! Owns the words of these commands and the way of a model from its file to crate `lang`. What a model means is known in
//! `lang` alone; `report` shows what is wrong with one.
//!
//! Exit codes: 0 done, 1 refused or failed, 2 a file that cannot be read, or a command line that was not understood.

mod check;
pub mod lsp;
mod plan;
mod report;

use crate::diagrams::{Refusal, UNREADABLE, end};
use clap::{Args, Subcommand};
use lang::dcml::diagnostic::Severity;
use lang::dcml::model::Model;
use lang::dcml::{Understood, understand, understand_paper};
use lang::limits::DCML_TEXT_MAX;
use std::fs::File;
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// What can be done with models.
#[derive(Debug, Subcommand)]
pub(crate) enum Dcml {
    /// Find everything that is wrong with models.
    ///
    /// Each error and warning is shown with its place, the line, and what to do. Exit status: 0 no errors, perhaps
    /// warnings; 1 errors; 2 a file cannot be read, or the command line was not understood.
    Check(CheckArgs),
    /// Find a path for a robot from one place to another, among obstacles.
    ///
    /// Grows a tree of motions that the model can do until one ends in the goal: rrt ends with the first path, sst looks
    /// for shorter ones until a limit. Nothing is jumped over, however thin. Writes the path as a table, which `trik dcml
    /// sim --actions` follows, and a picture.
    ///
    /// Exit status: 0 a path was found; 1 none, and what was reached is told; 2 it could not be searched.
    Plan(Box<plan::PlanArgs>),
    /// Serve an editor: errors as you type, documentation, completion, rename and more.
    ///
    /// Speaks the Language Server Protocol on standard input and output, so an editor starts it. Exit status: 0 the editor
    /// has said goodbye; 1 it was gone before.
    Lsp,
}

/// What `trik dcml check` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct CheckArgs {
    /// Files with models; - is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Refuse what the published language does not have: units, ranges, piecewise, comments with // and /* */.
    #[arg(long)]
    pub paper: bool,
}

/// Does it.
pub(crate) fn perform(command: &Dcml) -> ExitCode {
    end(match command {
        Dcml::Check(args) => check::check(args),
        Dcml::Plan(args) => plan::plan(args),
        Dcml::Lsp => return lsp::serve(),
    })
}

/// A text with models, and how it is called in messages.
pub(crate) struct Source {
    /// Its file.
    pub name: String,
    /// All of it.
    pub text: String,
}

/// The text of one model and the model: the one of this name, or the only one of the file. What is wrong with the file is
/// shown on standard error, warnings too; errors of another model are no hindrance.
#[allow(dead_code, reason = "for commands of one model")]
pub(crate) fn load(path: &Path, model: Option<&str>) -> Result<(String, Model), Refusal> {
    let source = read(path)?;
    let understood = understand(&source.text);
    report::show(&source, &understood.diagnostics);
    let model = pick(&source.name, understood, model)?;
    Ok((source.text, model))
}

#[allow(dead_code, reason = "as above")]
fn pick(file: &str, understood: Understood, wanted: Option<&str>) -> Result<Model, Refusal> {
    let Understood {
        document,
        mut models,
        diagnostics,
    } = understood;
    let all: Vec<&str> = document
        .models
        .iter()
        .map(|one| one.name.text.as_str())
        .collect();
    let is_broken = diagnostics
        .iter()
        .any(|one| one.severity == Severity::Error);
    let listed = all.iter().take(20).copied().collect::<Vec<_>>().join(", ");
    match wanted {
        Some(name) => match models.iter().position(|one| one.name == name) {
            Some(at) => Ok(models.swap_remove(at)),
            None if all.contains(&name) => {
                Err(Refusal::new(format!("{file}: the model {name} has errors")))
            }
            None if all.is_empty() => Err(Refusal::new(format!(
                "{file}: there is no model that can be read"
            ))),
            None => Err(Refusal::new(format!(
                "{file}: there is no model {name}; there are {listed}"
            ))),
        },
        None if all.len() > 1 => Err(Refusal::new(format!(
            "{file}: there are several models: name one with --model: {listed}"
        ))),
        None => match models.pop() {
            Some(model) if !is_broken => Ok(model),
            _ => Err(Refusal::new(format!("{file}: the model has errors"))),
        },
    }
}

/// The text of a file, or of standard input for `-`.
pub(crate) fn read(path: &Path) -> Result<Source, Refusal> {
    let is_input = path == Path::new("-");
    let name = if is_input {
        "<stdin>".to_owned()
    } else {
        path.to_string_lossy().into_owned()
    };
    let unreadable = |why: String| Refusal {
        lines: vec![format!("trik: {name}: {why}")],
        code: UNREADABLE,
    };
    let bytes = if is_input {
        bytes(io::stdin().lock())
    } else {
        File::open(path).and_then(bytes)
    };
    let bytes = bytes.map_err(|error| {
        unreadable(match error.kind() {
            io::ErrorKind::NotFound => "there is no such file".to_owned(),
            io::ErrorKind::IsADirectory => {
                "this is a directory: name a file with models".to_owned()
            }
            _ => format!("cannot be read: {error}"),
        })
    })?;
    if bytes.len() > DCML_TEXT_MAX {
        let mib = DCML_TEXT_MAX >> 20;
        return Err(unreadable(format!(
            "longer than {mib} MiB, which no model is"
        )));
    }
    match lang::dcml::decode(bytes) {
        Ok(text) => Ok(Source { name, text }),
        Err(why) => Err(Refusal {
            lines: vec![format!("trik: {name}:{why}")],
            code: UNREADABLE,
        }),
    }
}

/// One byte more than may be, so that it can be seen.
fn bytes(from: impl Read) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    from.take(DCML_TEXT_MAX as u64 + 1)
        .read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Understands a text, as the published language if that is wanted.
fn understood(source: &Source, paper: bool) -> Understood {
    if paper {
        understand_paper(&source.text)
    } else {
        understand(&source.text)
    }
}
