//! `trik lint`: everything that is wrong with diagrams and worlds, and the way back for blocks that an earlier editor has
//! lost.
//!
//! Owns the order of files, the summary and the exit code, and what is a world: a file that begins with a tag, and the
//! world model of a save. What is wrong is found in `lang` and by the judge in `sim`.

use super::flow::{self, Flow};
use super::report::{Count, Reporter};
use super::save::{Unreadable, bytes};
use super::words;
use crate::language;
use crate::output::{Output, standard};
use crate::refusal::{REFUSED, Refusal, UNREADABLE};
use crate::terminal::named;
use clap::Args;
use lang_diagram::check::check;
use lang_diagram::lower::World;
use lang_diagram::project::Project;
use lang_diagram::read::{self, Opened};
use lang_text::problem::{Locale, Problem};
use sim::judge::{self, Texts};
use std::path::{Path, PathBuf};

/// The part of a save that lines and columns of its world are in.
const WORLD: &str = "worldModel";

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
        let mut opened = match open(file) {
            Ok(Content::Diagram(opened)) => *opened,
            Ok(Content::World(text)) => {
                refuse_recovery(args, file, "a world")?;
                let reporter = Reporter::new(file, None, args.language);
                report(&reporter, world(&text), &mut count, args)?;
                continue;
            }
            Ok(Content::Flow(flow, None)) => {
                refuse_recovery(args, file, "a text")?;
                let reporter = Reporter::of_flow(file, &flow, args.language);
                report(&reporter, flow.found(), &mut count, args)?;
                continue;
            }
            Ok(Content::Flow(flow, Some(save))) => {
                lint_save(flow, *save, file, &mut count, args)?;
                continue;
            }
            Err(why) => {
                unreadable += 1;
                let problems = match why {
                    Unreadable::File(words) | Unreadable::Diagram(words) => {
                        vec![Problem::error(words)]
                    }
                    Unreadable::Save(problems) => problems,
                };
                let reporter = match flow::is_text(file) {
                    true => Reporter::of_unread_text(file, args.language),
                    false => Reporter::new(file, None, args.language),
                };
                report(&reporter, problems, &mut count, args)?;
                continue;
            }
        };
        let name = recovered(&mut opened, file, args)?;
        let reporter = Reporter::new(name, Some(&opened.project), args.language);
        report(&reporter, found(&opened), &mut count, args)?;
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

/// Finds and tells everything about a save with a data-flow program.
fn lint_save(
    mut flow: Flow,
    mut opened: Opened,
    file: &Path,
    count: &mut Count,
    args: &LintArgs,
) -> Result<(), Refusal> {
    let name = recovered(&mut opened, file, args)?;
    if name != file {
        flow = Flow::of_save(&opened);
    }
    let mut problems = opened.problems.clone();
    problems.extend(flow.found());
    problems.extend(world_of(&opened.project));
    report(
        &Reporter::new(name, None, args.language),
        problems,
        count,
        args,
    )
}

/// Puts back what was lost, if that is asked for; which file has all of it.
fn recovered<'a>(
    opened: &mut Opened,
    file: &'a Path,
    args: &'a LintArgs,
) -> Result<&'a Path, Refusal> {
    match &args.recover {
        Some(out) if recover(opened, file, out, args)? => Ok(out),
        Some(_) | None => Ok(file),
    }
}

/// Only diagrams lose blocks that can be put back.
fn refuse_recovery(args: &LintArgs, file: &Path, is: &str) -> Result<(), Refusal> {
    match args.recover {
        None => Ok(()),
        Some(_) => Err(Refusal::new(format!(
            "{}: this is {is}, and --recover is for diagrams",
            named(file)
        ))),
    }
}

/// What a file is.
enum Content {
    Diagram(Box<Opened>),
    /// A data-flow program, with the save that it is of.
    Flow(Flow, Option<Box<Opened>>),
    /// The text of a world model.
    World(String),
}

/// Reads a file; one that begins with a tag is a world.
fn open(path: &Path) -> Result<Content, Unreadable> {
    let bytes = bytes(path).map_err(Unreadable::File)?;
    if bytes.starts_with(b"\xff\xfe") || bytes.starts_with(b"\xfe\xff") {
        return Err(Unreadable::File(words::utf_16()));
    }
    if is_program(path) {
        return Err(Unreadable::File(words::is_program()));
    }
    if flow::is_text(path) {
        return Ok(Content::Flow(flow::of_text(bytes)?, None));
    }
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&bytes);
    if text.trim_ascii_start().first() != Some(&b'<') {
        let opened = read::read(&bytes).map_err(Unreadable::Save)?;
        return Ok(match flow::of_save(opened) {
            flow::Program::Diagram(opened) => Content::Diagram(opened),
            flow::Program::Flow(flow, save) => Content::Flow(flow, Some(save)),
            flow::Program::Text(flow) => Content::Flow(flow, None),
        });
    }
    let text = String::from_utf8(bytes)
        .map_err(|error| Unreadable::File(words::no_utf_8(error.utf8_error().valid_up_to())))?;
    Ok(Content::World(text))
}

/// Whether a file is a program by its name.
fn is_program(path: &Path) -> bool {
    let ending = path.extension().and_then(|ending| ending.to_str());
    ending.is_some_and(|ending| ["js", "py"].contains(&&*ending.to_ascii_lowercase()))
}

/// What is wrong with a world in a file of its own.
fn world(text: &str) -> Vec<Problem> {
    judge::lint(Texts {
        world: text,
        ..Texts::default()
    })
}

/// What is wrong with the world in a save.
fn world_of(project: &Project) -> Vec<Problem> {
    let Some(world) = project.world.as_deref() else {
        return Vec::new();
    };
    let mut problems = judge::lint(Texts {
        world,
        blobs: project.blobs.as_deref(),
        templates: Some(&project.templates),
    });
    for problem in &mut problems {
        problem.place.file.get_or_insert_with(|| WORLD.to_owned());
    }
    problems
}

/// What is wrong with a save that could be read.
fn found(opened: &Opened) -> Vec<Problem> {
    let mut problems: Vec<Problem> = opened.problems.clone();
    problems.extend(check(&opened.project, World::Robot));
    problems.extend(world_of(&opened.project));
    problems
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
