//! Models of robots on this computer: `trik dcml ...`.
//!
//! Owns the list of commands; each has a file of its own with its options. What a model means is known in `lang-dcml`
//! alone; `source` and `load` are the way of a model from its file to there, `report` shows what is wrong with one.
//!
//! Exit codes: 0 done, 1 refused or failed, 2 a file that cannot be read, or a command line that was not understood.

mod doc;
mod drive;
mod fmt;
mod generate;
mod lint;
pub(crate) mod load;
pub mod lsp;
mod models;
mod plan;
mod report;
mod rows;
mod sim;
mod source;
mod values;

use crate::refusal::Refusal;
use clap::Subcommand;

/// What can be done with models.
#[derive(Debug, Subcommand)]
pub(crate) enum Dcml {
    /// Find everything that is wrong with models.
    ///
    /// Each error and warning is shown with its place, the line, and what to do. Exit status: 0 no errors, perhaps
    /// warnings; 1 errors; 2 a file cannot be read, or the command line was not understood.
    #[command(alias = "check")]
    Lint(lint::LintArgs),
    /// Bring models into the one layout: spaces, line ends, long lines.
    ///
    /// Files are changed in place, except standard input, which goes to standard output. Comments and the order of the
    /// author stay. Exit status: 0 done; 1 a file cannot be understood, or --check found one that is not in the layout; 2 a
    /// file cannot be read, or the command line was not understood.
    Fmt(fmt::FmtArgs),
    /// Write what models say of themselves as a page in Markdown, to standard output.
    ///
    /// Exit status: 0 done; 1 the text cannot be understood; 2 a file cannot be read, or the command line was not
    /// understood.
    Doc(doc::DocArgs),
    /// Find a path for a robot from one place to another, among obstacles.
    ///
    /// Grows a tree of motions that the model can do until one ends in the goal: rrt ends with the first path, sst looks
    /// for shorter ones until a limit. Nothing is jumped over, however thin. Writes the path as a table, which `trik dcml
    /// sim --actions` follows, and a picture.
    ///
    /// Exit status: 0 a path was found; 1 none, and what was reached is told; 2 it could not be searched.
    Plan(Box<plan::args::PlanArgs>),
    /// Drive a robot along a planned path.
    ///
    /// Gives the actions of a path of `trik dcml plan -o` to the motors and servos of a robot, through its tree: the virtual
    /// robot that runs here, or the real one on the controller. Encoders of motors keep each wheel at its place on the path.
    /// Before anything moves, a path that a motor or servo cannot do is refused. Motors are stopped at the end, on Ctrl-C
    /// and other signals, after any error, and if a wheel stays behind. Where the robot stands when it begins is taken to be
    /// the start of the path, and obstacles are not looked at.
    ///
    /// Exit status: 0 the end is reached; 1 refused, failed or stopped, and why is told; 2 a file cannot be read, or the
    /// command line was not understood.
    Drive(Box<drive::DriveArgs>),
    /// Serve an editor: errors as you type, documentation, completion, rename and more.
    ///
    /// Speaks the Language Server Protocol on standard input and output, so an editor starts it. Exit status: 0 the editor
    /// has ended the session; 1 it disconnected first.
    Lsp,
    /// Run a model under actions for some time, and write what it does as a table or a picture.
    ///
    /// FILE is a file with a model, or the name of one that comes with the program. Exit status: 0 done; 1 refused, or the
    /// solution ends before its time, and what there is of it is written; 2 a file cannot be read, or the command line was
    /// not understood.
    Sim(Box<sim::args::SimArgs>),
    /// List the models that come with the program, or print one of them.
    ///
    /// Exit status: 0 printed; 1 there is no model with this name; 2 the command line was not understood.
    Models(models::ModelsArgs),
    /// Write a model in another language: for programs, solvers, converters, papers.
    ///
    /// Names and documentation are those of the model; the header says which names are others in that language. Exit
    /// status: 0 done; 1 the model has errors, is too large for that language, or OUT is there already; 2 the file
    /// cannot be read, or the command line was not understood.
    Gen(generate::GenArgs),
}

/// Does it, and gives the exit code.
///
/// # Errors
/// It cannot be done; see each command.
pub(crate) fn run(command: &Dcml) -> Result<u8, Refusal> {
    match command {
        Dcml::Lint(args) => lint::run(args),
        Dcml::Fmt(args) => fmt::run(args),
        Dcml::Doc(args) => doc::run(args),
        Dcml::Plan(args) => plan::run(args),
        Dcml::Drive(args) => drive::run(args),
        Dcml::Lsp => Ok(lsp::serve()),
        Dcml::Sim(args) => sim::run(args),
        Dcml::Models(args) => models::run(args),
        Dcml::Gen(args) => generate::run(args),
    }
}
