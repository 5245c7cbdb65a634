//! `trik dcml gen`: a model as source text of another language.
//!
//! Owns the options and where the text goes. What it looks like is the business of `lang`.

use super::load::load;
use crate::output::Output;
use crate::refusal::Refusal;
use clap::Args;
use lang_dcml::generate::{JAVA_INTERFACE, Options, Target, generate};
use lang_text::problem::Locale;
use std::path::PathBuf;

/// What `trik dcml gen` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct GenArgs {
    /// A file with a model; - is standard input.
    #[arg(required_unless_present = "interface")]
    pub file: Option<PathBuf>,
    #[arg(long, alias = "target", value_name = "LANGUAGE", value_parser = target, help = about_languages())]
    pub lang: Target,
    /// Write to a new file; - is standard output, as without this option.
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// The model with this name, if the file has several.
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// Also write the Jacobians df/dx and df/du.
    #[arg(long)]
    pub jacobian: bool,
    /// Write the interface that the classes of all models implement, for java and java-hipparchus; it belongs into the file
    /// trik/dcml/RobotModel.java below the folder of sources.
    #[arg(long, conflicts_with_all = ["file", "model", "jacobian"])]
    pub interface: bool,
    /// Overwrite OUT if it exists.
    #[arg(long, requires = "output")]
    pub force: bool,
}

/// The names of all languages, for a person.
fn languages() -> String {
    let all: Vec<_> = Target::ALL.into_iter().map(Target::name).collect();
    match all.split_last() {
        Some((last, others)) => format!("{} or {last}", others.join(", ")),
        None => String::new(),
    }
}

/// What the help says of the option.
fn about_languages() -> String {
    format!("The language: {}", languages())
}

/// A language by its name; for the command line.
fn target(name: &str) -> Result<Target, String> {
    Target::named(name)
        .ok_or_else(|| format!("there is no such language; there are {}", languages()))
}

/// Writes the text.
pub(super) fn run(args: &GenArgs) -> Result<u8, Refusal> {
    let file = args.file.clone().unwrap_or_else(|| PathBuf::from("-"));
    let output = Output {
        path: args.output.as_deref(),
        force: args.force,
        source: &file,
        locale: Locale::English,
    };
    if args.interface {
        let (Target::Java | Target::JavaHipparchus) = args.lang else {
            let name = args.lang.name();
            let why = format!("--interface: {name} has none; java and java-hipparchus have one");
            return Err(Refusal::new(why));
        };
        output.refuse_present()?;
        output.write(JAVA_INTERFACE.1.as_bytes())?;
        return Ok(0);
    }
    let (_, model) = load(&file, args.model.as_deref())?;
    output.refuse_present()?;
    let options = Options {
        jacobian: args.jacobian,
    };
    let text = generate(&model, args.lang, &options)
        .map_err(|why| Refusal::new(format!("{}: {why}", model.name)))?;
    output.write(text.as_bytes())?;
    Ok(0)
}
