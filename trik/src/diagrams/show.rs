//! `trik show`: a diagram for the eye, as sentences or as a picture, and a data-flow program in its other form.
//!
//! Owns which diagram of a project is meant. What is shown of it is the business of `lang`.

use super::flow::{self, Flow};
use super::report::Reporter;
use super::save::{Unreadable, must};
use crate::language;
use crate::limits;
use crate::output::{Output, standard};
use crate::refusal::{REFUSED, Refusal};
use crate::terminal::harmless;
use clap::Args;
use lang_dataflow::show::{Extent, Looks};
use lang_diagram::show::{outline::outline, picture::picture};
use lang_text::near::did_you_mean;
use lang_text::problem::Locale;
use std::path::{Path, PathBuf};

/// What `trik show` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct ShowArgs {
    /// The diagram, a file NAME.qrs, or a data-flow program as text, a file NAME.flow.
    pub file: PathBuf,
    /// Write a picture into a new file; - is standard output.
    #[arg(long, value_name = "OUT.svg", group = "written")]
    pub svg: Option<PathBuf>,
    /// Print the program as sentences, as without this option.
    #[arg(long, conflicts_with = "svg")]
    pub text: bool,
    /// Print a data-flow program in its textual form, which all commands read from a file NAME.flow.
    #[arg(long, conflicts_with_all = ["svg", "text"])]
    pub source: bool,
    /// Write a data-flow program as a save, which the editor of the language opens, into a new file; - is standard output.
    #[arg(long, value_name = "OUT.qrs", group = "written", conflicts_with_all = ["svg", "text", "source", "all", "diagram"])]
    pub save: Option<PathBuf>,
    /// Say also the properties of a data-flow program that have their defaults.
    #[arg(long, conflicts_with_all = ["svg", "source"])]
    pub all: bool,
    /// The diagram with this name in the file [default: the main one]. Sentences are those of the diagram and of the
    /// subprograms that it calls; without this option, those of a data-flow program are of all its diagrams.
    #[arg(long, value_name = "NAME")]
    pub diagram: Option<String>,
    /// Overwrite OUT.svg or OUT.qrs if it exists.
    #[arg(long, requires = "written")]
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
    let mut opened = match must(opened(args), &args.file, args.language)? {
        flow::Program::Diagram(opened) => opened,
        flow::Program::Text(flow) => return show_flow(args, flow),
        flow::Program::Flow(flow, _) => {
            if args.save.is_some() {
                return Err(Refusal::new(
                    "--save is for programs as text, and this is a save",
                ));
            }
            return show_flow(args, flow);
        }
    };
    if args.save.is_some() {
        let why = "--save is for data-flow programs as text, and this is a save with a diagram of control flow";
        return Err(Refusal::new(why));
    }
    if args.source {
        let why = "--source is for data-flow programs, and this is a diagram of control flow";
        return Err(Refusal::new(why));
    }
    if args.all {
        let why = "--all is for data-flow programs: of a diagram everything is said";
        return Err(Refusal::new(why));
    }
    let names = opened.project.diagrams.iter().map(|one| &*one.name);
    let chosen = choose(names, opened.project.main, args.diagram.as_deref())?;
    if let Some(svg) = &args.svg {
        let picture = picture(&opened.project.diagrams[chosen], args.language);
        return write(args, svg, picture.as_bytes());
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

/// The program in the file: of a save with both languages the one that has the diagram that was asked for.
fn opened(args: &ShowArgs) -> Result<flow::Program, Unreadable> {
    match flow::open(&args.file, args.diagram.as_deref()) {
        // It may be a subprogram, which can be shown, or there is none: that is told with all that there are.
        Err(Unreadable::Diagram(_)) => flow::open(&args.file, None),
        opened => opened,
    }
}

/// Shows a data-flow program.
fn show_flow(args: &ShowArgs, flow: Flow) -> Result<u8, Refusal> {
    let project = flow.project;
    if args.source {
        standard(lang_dataflow::text::write(&project).as_bytes())?;
        return Ok(0);
    }
    if let Some(save) = &args.save {
        let bytes = lang_dataflow::save::save(&project).write();
        let bytes = bytes.map_err(|problem| Refusal::new(problem.in_locale(args.language)))?;
        return write(args, save, &bytes);
    }
    let names = project.diagrams.iter().map(|one| &*one.name);
    let chosen = choose(names, project.main, args.diagram.as_deref())?;
    if let Some(svg) = &args.svg {
        let mut looks = Looks::default();
        let picture = lang_dataflow::show::picture(&project, chosen, args.language, &mut looks);
        return write(args, svg, picture.as_bytes());
    }
    let extent = Extent {
        with_defaults: args.all,
        from: args.diagram.is_some().then_some(chosen),
    };
    let said = lang_dataflow::show::sentences(&project, extent, args.language);
    standard(said.as_bytes())?;
    Ok(0)
}

fn write(args: &ShowArgs, path: &Path, bytes: &[u8]) -> Result<u8, Refusal> {
    let output = Output {
        path: Some(path),
        force: args.force,
        source: &args.file,
        locale: args.language,
    };
    output.refuse_present()?;
    output.write(bytes)?;
    Ok(0)
}

/// The diagram with a name, or else the main one.
fn choose<'a>(
    all: impl ExactSizeIterator<Item = &'a str> + Clone,
    main: Option<usize>,
    name: Option<&str>,
) -> Result<usize, Refusal> {
    let Some(name) = name else {
        return main.ok_or_else(|| Refusal::new("there is no diagram in this project"));
    };
    all.clone().position(|one| one == name).ok_or_else(|| {
        let mut names: Vec<_> = all
            .clone()
            .take(limits::DIAGRAM_NAMES_MAX)
            .map(harmless)
            .collect();
        if all.len() > limits::DIAGRAM_NAMES_MAX {
            names.push("others".to_owned());
        }
        let meant = did_you_mean(name, all).english;
        let shown: String = name.chars().take(limits::DIAGRAM_NAME_SHOWN_MAX).collect();
        let (name, names) = (harmless(&shown), names.join(", "));
        Refusal::new(format!(
            "there is no diagram '{name}' in this project; there are: {names}{meant}"
        ))
    })
}
