//! `trik show`: a diagram for the eye, as sentences or as a picture.
//!
//! Owns which diagram of a project is meant. What is shown of it is the business of `lang`.

use super::report::Reporter;
use super::save::must_open;
use crate::language;
use crate::limits;
use crate::output::{Output, standard};
use crate::refusal::{REFUSED, Refusal};
use crate::terminal::harmless;
use clap::Args;
use lang_diagram::project::Project;
use lang_diagram::show::{outline::outline, picture::picture};
use lang_text::problem::Locale;
use std::path::PathBuf;

/// What `trik show` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct ShowArgs {
    /// The diagram, a file NAME.qrs.
    pub file: PathBuf,
    /// Write a picture into a new file; - is standard output.
    #[arg(long, value_name = "OUT.svg")]
    pub svg: Option<PathBuf>,
    /// Print the program as sentences, as without this option.
    #[arg(long, conflicts_with = "svg")]
    pub text: bool,
    /// The diagram with this name in the file [default: the main one]. Sentences are those of the diagram and of the
    /// subprograms that it calls.
    #[arg(long, value_name = "NAME")]
    pub diagram: Option<String>,
    /// Overwrite OUT.svg if it exists.
    #[arg(long, requires = "svg")]
    pub force: bool,
    /// Language of sentences and messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// Shows it.
///
/// # Errors
/// The save cannot be read, it is not clear what the diagram does, or the picture cannot be written.
pub(crate) fn run(args: &ShowArgs) -> Result<u8, Refusal> {
    let mut opened = must_open(&args.file, args.language)?;
    let chosen = choose(&opened.project, args.diagram.as_deref())?;
    if let Some(svg) = &args.svg {
        let output = Output {
            path: Some(svg),
            force: args.force,
            source: &args.file,
            locale: args.language,
        };
        output.refuse_present()?;
        let picture = picture(&opened.project.diagrams[chosen], args.language);
        output.write(picture.as_bytes())?;
        return Ok(0);
    }
    // The program begins there.
    opened.project.main = Some(chosen);
    let text = outline(&opened.project, args.language).map_err(|mut problems| {
        let reporter = Reporter::new(&args.file, Some(&opened.project), args.language);
        reporter.sort(&mut problems);
        let mut lines = reporter.lines(&problems);
        lines.push("trik: it is not clear what this diagram does: --svg shows it as it is".into());
        Refusal {
            lines,
            code: REFUSED,
        }
    })?;
    standard(text.as_bytes())?;
    Ok(0)
}

/// The diagram with a name, or else the main one.
fn choose(project: &Project, name: Option<&str>) -> Result<usize, Refusal> {
    let Some(name) = name else {
        return project
            .main
            .ok_or_else(|| Refusal::new("there is no diagram in this project"));
    };
    let mut all = project.diagrams.iter();
    all.position(|diagram| diagram.name == name).ok_or_else(|| {
        let some = project.diagrams.iter().take(limits::DIAGRAM_NAMES_MAX);
        let mut names: Vec<_> = some.map(|diagram| harmless(&diagram.name)).collect();
        if project.diagrams.len() > limits::DIAGRAM_NAMES_MAX {
            names.push("others".to_owned());
        }
        let (name, names) = (harmless(name), names.join(", "));
        Refusal::new(format!(
            "there is no diagram '{name}' in this project; there are: {names}"
        ))
    })
}
