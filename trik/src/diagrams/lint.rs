//! `trik lint`: everything that is wrong with diagrams and worlds, and the way back for blocks that an earlier editor has
//! lost.
//!
//! Owns the order of files, the summary and the exit code. What a file is and what is wrong with it is found in `studio`.

use super::flow::Flow;
use super::report::{Count, Reporter};
use super::save::{Unreadable, bytes};
use super::words;
use crate::language;
use crate::output::{Output, standard};
use crate::refusal::{REFUSED, Refusal, UNREADABLE};
use crate::terminal::named;
use clap::Args;
use lang_diagram::read::Opened;
use lang_text::problem::{Locale, Problem};
use std::path::{Path, PathBuf};
use studio::lint::{Content, unread};

/// What `trik lint` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct LintArgs {
    /// Diagrams, files NAME.qrs, with the worlds in them; data-flow programs as text, files NAME.flow; and worlds, files
    /// NAME.xml.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Language of messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
    /// Write a line of JSON for each problem to standard output instead, for programs: file, level and message as in the
    /// results of trik check, and where it is.
    #[arg(long, conflicts_with = "recover")]
    pub json: bool,
    /// Write the diagram to this new file, with the blocks and links restored that are in the file but on no sheet, and
    /// check that. For one FILE that is a diagram.
    #[arg(long, value_name = "OUT.qrs")]
    pub recover: Option<PathBuf>,
    /// Overwrite OUT.qrs if it exists.
    #[arg(long, requires = "recover")]
    pub force: bool,
}

/// Finds and tells everything.
///
/// # Errors
/// What was found could not be told, or what was put back could not be written.
pub(crate) fn run(args: &LintArgs) -> Result<u8, Refusal> {
    let mut count = Count::default();
    let mut unreadable = 0;
    for file in &args.files {
        let content = bytes(file).map_err(Unreadable::File);
        match content.and_then(|bytes| Content::read(file, bytes)) {
            Ok(mut content) => {
                let name = recovered(&mut content, file, args)?;
                let reporter = Reporter::of(name, content.findings(), args.language);
                report(&reporter, content.problems(), &mut count, args)?;
            }
            Err(why) => {
                unreadable += 1;
                let reporter = Reporter::of(file, unread(file), args.language);
                report(&reporter, why.problems(), &mut count, args)?;
            }
        }
    }
    if !args.json {
        let summary = words::summary(args.files.len(), unreadable, count, args.language);
        standard(format!("{summary}\n").as_bytes())?;
    }
    Ok(match (unreadable, count.errors) {
        (0, 0) => 0,
        (0, _) => REFUSED,
        _ => UNREADABLE,
    })
}

/// Puts back what was lost, if that is asked for; which file has all of it.
fn recovered<'a>(
    content: &mut Content,
    file: &'a Path,
    args: &'a LintArgs,
) -> Result<&'a Path, Refusal> {
    let Some(out) = &args.recover else {
        return Ok(file);
    };
    let opened = match content {
        Content::Diagram(opened) | Content::Flow(_, Some(opened)) => opened,
        Content::World(_) => return Err(no_recovery(file, "a world")),
        Content::Flow(_, None) => return Err(no_recovery(file, "a text")),
    };
    if !recover(opened, file, out, args)? {
        return Ok(file);
    }
    if let Content::Flow(flow, Some(opened)) = content {
        *flow = Flow::of_save(opened);
    }
    Ok(out)
}

/// Only diagrams lose blocks that can be put back.
fn no_recovery(file: &Path, is: &str) -> Refusal {
    Refusal::new(format!(
        "{}: this is {is}, and --recover is for diagrams",
        named(file)
    ))
}

/// Reports and counts problems.
fn report(
    reporter: &Reporter<'_>,
    mut problems: Vec<Problem>,
    count: &mut Count,
    args: &LintArgs,
) -> Result<(), Refusal> {
    reporter.sort(&mut problems);
    count.add(&problems);
    let lines = match args.json {
        true => reporter.json(&problems),
        false => reporter.lines(&problems),
    };
    let text: String = lines.iter().map(|line| format!("{line}\n")).collect();
    standard(text.as_bytes())
}

/// Puts back what was lost and writes the save; whether there was anything.
fn recover(opened: &mut Opened, file: &Path, out: &Path, args: &LintArgs) -> Result<bool, Refusal> {
    let output = Output {
        path: Some(out),
        force: args.force,
        source: file,
        locale: args.language,
    };
    output.refuse_present()?;
    let recovered = opened.save.recover_orphans();
    let told = match recovered {
        0 => words::nothing_to_recover(args.language).to_owned(),
        _ => {
            let bytes = opened.save.write().map_err(|problem| Refusal {
                lines: Reporter::new(file, None, args.language).lines(&[problem]),
                code: REFUSED,
            })?;
            output.write(&bytes)?;
            (opened.project, opened.problems) = opened.save.project();
            words::recovered(recovered, args.language)
        }
    };
    let name = named(if recovered == 0 { file } else { out });
    standard(format!("{name}: {told}\n").as_bytes())?;
    Ok(recovered > 0)
}
