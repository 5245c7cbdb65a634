//! `trik lint`: everything that is wrong with diagrams and worlds, and the way back for blocks that an earlier editor has
//! lost.
//!
//! Owns the order of files, the summary and the exit code, and what is a world: a file that begins with a tag, and the
//! world model of a save. What is wrong is found in `lang` and by the judge in `sim`.

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
    /// Diagrams, files NAME.qrs, with the worlds in them; and worlds, files NAME.xml.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Language of messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
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
            Ok(Found::Diagram(opened)) => *opened,
            Ok(Found::World(text)) => {
                if args.recover.is_some() {
                    let why = "this is a world, and --recover is for diagrams";
                    return Err(Refusal::new(format!("{}: {why}", named(file))));
                }
                let lines = world(file, &text, &mut count, args.language);
                standard(lines.as_bytes())?;
                continue;
            }
            Err(why) => {
                unreadable += 1;
                let lines = unread(file, why, &mut count, args.language);
                standard(lines.as_bytes())?;
                continue;
            }
        };
        let name = match &args.recover {
            None => file,
            Some(out) => {
                if recover(&mut opened, file, out, args)? {
                    out
                } else {
                    file
                }
            }
        };
        let text = found(name, &opened, &mut count, args.language);
        standard(text.as_bytes())?;
    }
    let summary = words::summary(args.files.len(), unreadable, count, args.language);
    standard(format!("{summary}\n").as_bytes())?;
    Ok(match (unreadable, count.errors) {
        (0, 0) => 0,
        (0, _) => REFUSED,
        _ => UNREADABLE,
    })
}

/// What a file is.
enum Found {
    Diagram(Box<Opened>),
    /// The text of a world model.
    World(String),
}

/// Reads a file; one that begins with a tag is a world.
fn open(path: &Path) -> Result<Found, Unreadable> {
    let bytes = bytes(path).map_err(Unreadable::File)?;
    let text = bytes.strip_prefix("\u{feff}".as_bytes()).unwrap_or(&bytes);
    if text.trim_ascii_start().first() != Some(&b'<') {
        let opened = read::read(&bytes).map_err(Unreadable::Save)?;
        return Ok(Found::Diagram(Box::new(opened)));
    }
    let text = String::from_utf8(bytes).map_err(|error| {
        let at = error.utf8_error().valid_up_to();
        Unreadable::File(format!(
            "byte {at} is not UTF-8; save the world as XML in UTF-8"
        ))
    })?;
    Ok(Found::World(text))
}

/// Lines of a world in a file of its own.
fn world(file: &Path, text: &str, count: &mut Count, locale: Locale) -> String {
    let reporter = Reporter::new(file, None, locale);
    let texts = Texts {
        world: text,
        ..Texts::default()
    };
    let mut problems = judge::lint(texts);
    reporter.sort(&mut problems);
    count.add(&problems);
    joined(&reporter.lines(&problems))
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

/// Lines of a save that could not be read.
fn unread(file: &Path, why: Unreadable, count: &mut Count, locale: Locale) -> String {
    let reporter = Reporter::new(file, None, locale);
    let lines = match why {
        Unreadable::File(why) => {
            count.errors += 1;
            let error = words::severity(lang_text::problem::Severity::Error, locale);
            vec![format!("{}: {error}: {why}", named(file))]
        }
        Unreadable::Save(mut problems) => {
            reporter.sort(&mut problems);
            count.add(&problems);
            reporter.lines(&problems)
        }
    };
    joined(&lines)
}

/// Lines of a save that could be read.
fn found(file: &Path, opened: &Opened, count: &mut Count, locale: Locale) -> String {
    let reporter = Reporter::new(file, Some(&opened.project), locale);
    let mut problems: Vec<Problem> = opened.problems.clone();
    problems.extend(check(&opened.project, World::Robot));
    problems.extend(world_of(&opened.project));
    reporter.sort(&mut problems);
    count.add(&problems);
    joined(&reporter.lines(&problems))
}

fn joined(lines: &[String]) -> String {
    lines.iter().map(|line| format!("{line}\n")).collect()
}

/// Puts back what was lost and writes the save; whether there was anything.
fn recover(opened: &mut Opened, file: &Path, out: &Path, args: &LintArgs) -> Result<bool, Refusal> {
    let output = Output {
        path: Some(out),
        force: args.force,
        source: file,
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
