//! `trik gen`: a diagram as a program in a language with text.
//!
//! Owns the options and where the program goes. What it looks like is the business of `lang`.

use super::output::Output;
use super::telling::{self, Teller};
use super::{REFUSED, Refusal, end, must_open, say};
use crate::cli::GenArgs;
use lang_diagram::check::check;
use lang_diagram::generate::{self, Language, Options};
use lang_diagram::lower::World;
use lang_text::problem::Severity;
use std::process::ExitCode;

/// A language by its name; for the command line.
pub(crate) fn language(name: &str) -> Result<Language, String> {
    Language::named(name).ok_or_else(|| {
        let all = "python, javascript, lua, c, pascal and fsharp";
        format!("there is no such language; there are {all}")
    })
}

/// Does it.
pub(crate) fn generate(args: &GenArgs) -> ExitCode {
    end(written(args))
}

fn written(args: &GenArgs) -> Result<u8, Refusal> {
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
    };
    let opened = must_open(&args.file, args.language)?;
    output.look()?;
    let options = Options {
        goto: args.goto,
        ..Options::default()
    };
    let teller = Teller::new(&args.file, Some(&opened.project), args.language);
    let generated = generate::generate(&opened.project, args.lang, options);
    let generated = generated.map_err(|mut problems| {
        teller.sort(&mut problems);
        let mut lines = teller.lines(&problems);
        // What a language lacks is nothing that is wrong with the diagram.
        let found = check(&opened.project, World::Robot);
        lines.push(if found.iter().any(|one| one.severity == Severity::Error) {
            let file = telling::named(&args.file);
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
    teller.sort(&mut notes);
    say(&teller.lines(&notes));
    Ok(0)
}
