//! Models of robots on this computer: `trik dcml ...`.
//!
//! Owns the words of these commands and the way of a model from its file to crate `lang`. What a model means is known in
//! `lang` alone; `report` shows what is wrong with one.
//!
//! Exit codes: 0 done, 1 refused or failed, 2 a file that cannot be read, or a command line that was not understood.

mod check;
mod doc;
mod fmt;
mod generate;
pub mod lsp;
mod models;
mod plan;
mod report;
mod sim;
mod values;

use crate::diagrams::{Refusal, UNREADABLE, end};
use clap::{Args, Subcommand, ValueEnum};
use lang_dcml::diagnostic::Severity;
use lang_dcml::limits::DCML_TEXT_MAX;
use lang_dcml::model::Model;
use lang_dcml::models as shipped;
use lang_dcml::{Understood, understand, understand_paper};
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
    /// Bring models into the one layout: spaces, line ends, long lines.
    ///
    /// Files are changed in place, except standard input, which goes to standard output. Comments and the order of the
    /// author stay. Exit status: 0 done; 1 a file cannot be understood, or --check found one that is not in the layout; 2 a
    /// file cannot be read, or the command line was not understood.
    Fmt(FmtArgs),
    /// Write what models say of themselves as a page in Markdown, to standard output.
    ///
    /// Exit status: 0 done; 1 the text cannot be understood; 2 a file cannot be read, or the command line was not
    /// understood.
    Doc(DocArgs),
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
    /// Run a model under actions for some time, and write what it does as a table or a picture.
    ///
    /// FILE is a file with a model, or the name of one that comes with the program. Exit status: 0 done; 1 refused, or the
    /// solution ends before its time, and what there is of it is written; 2 a file cannot be read, or the command line was
    /// not understood.
    Sim(Box<SimArgs>),
    /// List the models that come with the program, or print one of them.
    Models(ModelsArgs),
    /// Write a model in another language: for programs, solvers, converters, papers.
    ///
    /// Names and documentation are those of the model; the header says which names are others in that language. Exit
    /// status: 0 done; 1 the model has errors, is too large for that language, or OUT is there already; 2 the file
    /// cannot be read, or the command line was not understood.
    Gen(generate::GenArgs),
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
    /// Write a line of JSON for each error and warning to standard output instead, for programs.
    #[arg(long)]
    pub json: bool,
}

/// What `trik dcml fmt` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct FmtArgs {
    /// Files with models; - is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Change nothing, and name the files that would change.
    #[arg(long)]
    pub check: bool,
}

/// What `trik dcml doc` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct DocArgs {
    /// A file with models; - is standard input.
    pub file: PathBuf,
}

/// What `trik dcml sim` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct SimArgs {
    /// A file with a model, - for standard input, or the name of a model that comes with the program.
    #[arg(value_name = "FILE")]
    pub file: PathBuf,
    /// Which model, if the file has several.
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// A number for each parameter: L=0.4,r=0.05.
    #[arg(
        long,
        value_name = "NAME=NUMBER,...",
        default_value = "",
        hide_default_value = true
    )]
    pub params: String,
    /// Where it starts; what is not named starts at 0.
    #[arg(
        long,
        value_name = "NAME=NUMBER,...",
        default_value = "",
        hide_default_value = true,
        allow_hyphen_values = true
    )]
    pub start: String,
    /// Formulas of the time t for all actions, 'u_l = 2 + sin(t); u_r = 3', or a table: its first line has the names
    /// t,u_l,u_r, each other one a time in s and what is done from then on.
    #[arg(long, value_name = "FORMULAS|FILE.csv")]
    pub actions: String,
    /// For how many seconds.
    #[arg(long = "t", value_name = "SECONDS", allow_negative_numbers = true)]
    pub time: f64,
    /// How it is solved.
    #[arg(long, value_enum, default_value = "rk45")]
    pub solver: Solver,
    /// Size of the steps in s: a thousandth of the time if it is not said; for rk45 the largest one.
    #[arg(long, value_name = "SECONDS")]
    pub step: Option<f64>,
    /// For rk45: the error of a step, as a part of each state.
    #[arg(long, value_name = "PART", default_value_t = 1e-6)]
    pub rtol: f64,
    /// For rk45: and beside that, in the unit of the state.
    #[arg(long, value_name = "NUMBER", default_value_t = 1e-9)]
    pub atol: f64,
    /// Seconds between lines of the table: a two-hundredth of the time if it is not said.
    #[arg(long, value_name = "SECONDS")]
    pub every: Option<f64>,
    /// What is written: csv is a table, svg a picture of the path and of everything over time.
    #[arg(long, value_enum, default_value = "csv")]
    pub out: Form,
    /// A new file for it, instead of standard output.
    #[arg(short, long, value_name = "FILE")]
    pub output: Option<PathBuf>,
    /// Replace the file if it is there.
    #[arg(long)]
    pub force: bool,
}

/// How a model is solved.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Solver {
    /// Dormand-Prince, order 5, with steps as the errors allow.
    Rk45,
    /// Runge-Kutta, order 4.
    Rk4,
    /// Order 2.
    Heun,
    /// Order 1.
    Euler,
}

/// What a simulation writes.
#[derive(Clone, Copy, Debug, ValueEnum)]
pub(crate) enum Form {
    /// A table.
    Csv,
    /// A picture.
    Svg,
}

/// What `trik dcml models` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct ModelsArgs {
    /// The one to print.
    pub name: Option<String>,
}

/// Does it.
pub(crate) fn perform(command: &Dcml) -> ExitCode {
    end(match command {
        Dcml::Check(args) => check::check(args),
        Dcml::Fmt(args) => fmt::fmt(args),
        Dcml::Doc(args) => doc::doc(args),
        Dcml::Plan(args) => plan::plan(args),
        Dcml::Lsp => return lsp::serve(),
        Dcml::Sim(args) => sim::sim(args),
        Dcml::Models(args) => models::models(args),
        Dcml::Gen(args) => generate::write(args),
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
pub(crate) fn load(path: &Path, model: Option<&str>) -> Result<(String, Model), Refusal> {
    let source = read(path)?;
    let understood = understand(&source.text);
    report::show(&source, &understood.diagnostics);
    let model = pick(&source.name, understood, model)?;
    Ok((source.text, model))
}

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

/// The text of a file, of standard input for `-`, or of a model that comes with the program where there is no file.
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
    if let (Err(error), Some(model)) = (&bytes, shipped::named(&name))
        && error.kind() == io::ErrorKind::NotFound
    {
        let text = model.text.to_owned();
        return Ok(Source { name, text });
    }
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
    match lang_dcml::decode(bytes) {
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
