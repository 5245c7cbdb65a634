//! `trik show`: a diagram for the eye, as sentences or as a picture.
//!
//! Owns which diagram of a project is meant. What is shown of it is the business of `lang`.

use super::output::{Output, standard};
use super::telling::{Teller, harmless};
use super::{REFUSED, Refusal, end, must_open};
use crate::cli::ShowArgs;
use lang_diagram::project::Project;
use lang_diagram::show::{outline::outline, picture::picture};
use std::process::ExitCode;

/// Names of diagrams that a message lists.
const NAMES_MAX: usize = 20;

/// Does it.
pub(crate) fn show(args: &ShowArgs) -> ExitCode {
    end(shown(args))
}

fn shown(args: &ShowArgs) -> Result<u8, Refusal> {
    let mut opened = must_open(&args.file, args.language)?;
    let chosen = choose(&opened.project, args.diagram.as_deref())?;
    if let Some(svg) = &args.svg {
        let output = Output {
            path: Some(svg),
            force: args.force,
            source: &args.file,
        };
        output.look()?;
        let picture = picture(&opened.project.diagrams[chosen], args.language);
        output.write(picture.as_bytes())?;
        return Ok(0);
    }
    // The program begins there.
    opened.project.main = Some(chosen);
    let text = outline(&opened.project, args.language).map_err(|mut problems| {
        let teller = Teller::new(&args.file, Some(&opened.project), args.language);
        teller.sort(&mut problems);
        let mut lines = teller.lines(&problems);
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
        let some = project.diagrams.iter().take(NAMES_MAX);
        let mut names: Vec<_> = some.map(|diagram| harmless(&diagram.name)).collect();
        if project.diagrams.len() > NAMES_MAX {
            names.push("others".to_owned());
        }
        let (name, names) = (harmless(name), names.join(", "));
        Refusal::new(format!(
            "there is no diagram '{name}' in this project; there are: {names}"
        ))
    })
}
