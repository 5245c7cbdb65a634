//! `trik gen`: a diagram as a program in a language with text.
//!
//! Owns the options and where the program goes. What it looks like is the business of `lang`.

use super::flow::{self, Flow};
use super::report::Reporter;
use super::save::must;
use crate::language;
use crate::output::Output;
use crate::refusal::{REFUSED, Refusal, say};
use crate::terminal::named;
use clap::Args;
use lang_dataflow::generate::Target;
use lang_diagram::check::check;
use lang_diagram::generate::{self, Language, Options};
use lang_diagram::lower::World;
use lang_text::problem::{Locale, Severity};
use std::path::PathBuf;

/// What `trik gen` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct GenArgs {
    /// The diagram, a file NAME.qrs, or a data-flow program as text, a file NAME.flow.
    pub file: PathBuf,
    /// The language: python, javascript, lua, c, pascal or fsharp. A data-flow program becomes a converter of trikfs, in lua
    /// or c.
    #[arg(long, alias = "target", value_name = "LANGUAGE", value_parser = target_language)]
    pub lang: Language,
    /// Write the main diagram of this name instead of the first one.
    #[arg(long, value_name = "NAME")]
    pub diagram: Option<String>,
    /// Write to a new file; - is standard output.
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Overwrite OUT if it exists.
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Write crossing arrows as goto instead of copies of blocks: in C and Lua.
    #[arg(long)]
    pub goto: bool,
    /// Language of messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// A language by its name; for the command line.
fn target_language(name: &str) -> Result<Language, String> {
    Language::named(name).ok_or_else(|| {
        let all = "python, javascript, lua, c, pascal and fsharp";
        format!("there is no such language; there are {all}")
    })
}

/// Writes the program.
///
/// # Errors
/// The save cannot be read, the diagram has errors or cannot be written in this language, or the file is there already.
pub(crate) fn run(args: &GenArgs) -> Result<u8, Refusal> {
    if args.goto && !args.lang.has_goto() {
        let with = Language::ALL.into_iter().filter(|one| one.has_goto());
        let with: Vec<_> = with.map(Language::name).collect();
        let (name, with) = (args.lang.name(), with.join(" and "));
        return Err(Refusal {
            code: 2,
            ..Refusal::new(format!("{name} has no goto: --goto is for {with}"))
        });
    }
    let output = Output {
        path: args.output.as_deref(),
        force: args.force,
        source: &args.file,
        locale: args.language,
    };
    let opened = match must(
        flow::open(&args.file, args.diagram.as_deref()),
        &args.file,
        args.language,
    )? {
        flow::Program::Diagram(opened) => opened,
        flow::Program::Flow(flow, _) | flow::Program::Text(flow) => {
            return converter(args, &flow, &output);
        }
    };
    output.refuse_present()?;
    let options = Options {
        goto: args.goto,
        ..Options::default()
    };
    let reporter = Reporter::new(&args.file, Some(&opened.project), args.language);
    let generated = generate::generate(&opened.project, args.lang, options);
    let generated = generated.map_err(|mut problems| {
        reporter.sort(&mut problems);
        let mut lines = reporter.lines(&problems);
        // What a language lacks is nothing that is wrong with the diagram.
        let found = check(&opened.project, World::Robot);
        lines.push(if found.iter().any(|one| one.severity == Severity::Error) {
            let file = named(&args.file);
            format!("trik: no program was written: trik lint {file} tells all")
        } else {
            "trik: no program was written".to_owned()
        });
        Refusal {
            lines,
            code: REFUSED,
        }
    })?;
    output.write(generated.text.as_bytes())?;
    let mut notes = generated.notes;
    reporter.sort(&mut notes);
    say(&reporter.lines(&notes));
    Ok(0)
}

/// Writes a data-flow program as a converter.
fn converter(args: &GenArgs, flow: &Flow, output: &Output<'_>) -> Result<u8, Refusal> {
    let misused = |why: String| Refusal {
        code: 2,
        ..Refusal::new(why)
    };
    let target = match args.lang {
        Language::Lua => Target::Lua,
        Language::C => Target::C,
        Language::JavaScript | Language::Python | Language::Pascal | Language::FSharp => {
            let name = args.lang.name();
            return Err(misused(format!(
                "a data-flow program becomes a converter of trikfs, in lua or c: there is none in {name}"
            )));
        }
    };
    if args.goto {
        return Err(misused("--goto is for diagrams of control flow".to_owned()));
    }
    output.refuse_present()?;
    let program = flow.ready();
    let written = program.and_then(|program| lang_dataflow::generate::generate(&program, target));
    let text = written.map_err(|problems| {
        let reporter = Reporter::of_flow(&args.file, flow, args.language);
        let mut lines = reporter.lines(&problems);
        lines.push("trik: no program was written".to_owned());
        Refusal {
            lines,
            code: REFUSED,
        }
    })?;
    output.write(text.as_bytes())?;
    Ok(0)
}
