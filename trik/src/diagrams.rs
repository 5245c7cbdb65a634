//! Diagrams on this computer, without a robot: `trik gen`, `trik show` and `trik lint`.
//!
//! Owns the way of a save from its file to crate `lang`, and how such a command ends. What a diagram means is known in
//! `lang` alone; `telling` puts its problems into lines, `output` writes files, `words` has what is said here.

mod generate;
mod lint;
pub(crate) mod output;
mod show;
pub(crate) mod telling;
mod words;

pub(crate) use generate::{generate, language};
use lang_diagram::limits::SAVE_BYTES;
use lang_diagram::read::{self, Opened};
use lang_text::problem::{Locale, Problem};
pub(crate) use lint::lint;
pub(crate) use show::show;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;
use std::process::ExitCode;
use telling::Teller;

/// Exit code of what was refused or failed.
pub(crate) const REFUSED: u8 = 1;
/// Exit code of a file that cannot be read.
pub(crate) const UNREADABLE: u8 = 2;

/// Why a command ends early: lines for standard error, and the exit code.
#[derive(Debug, PartialEq)]
pub(crate) struct Refusal {
    pub lines: Vec<String>,
    pub code: u8,
}

impl Refusal {
    /// One line that says why something was not done.
    pub fn new(reason: impl Into<String>) -> Self {
        Self {
            lines: vec![format!("trik: {}", reason.into())],
            code: REFUSED,
        }
    }
}

/// Why a save cannot be read.
pub(crate) enum Unreadable {
    /// The file itself.
    File(String),
    /// What is in it.
    Save(Vec<Problem>),
}

/// The language of messages by its short name.
pub(crate) fn locale(name: &str) -> Result<Locale, String> {
    match name {
        "en" => Ok(Locale::English),
        "ru" => Ok(Locale::Russian),
        _ => Err("there are en and ru".to_owned()),
    }
}

/// Ends a command: what kept it from being done goes to standard error.
pub(crate) fn end(done: Result<u8, Refusal>) -> ExitCode {
    let code = done.unwrap_or_else(|refusal| {
        say(&refusal.lines);
        refusal.code
    });
    ExitCode::from(code)
}

/// Lines to standard error. Nobody is told if nobody can hear it.
pub(crate) fn say(lines: &[String]) {
    let mut err = io::stderr().lock();
    for line in lines {
        let _ = writeln!(err, "{line}");
    }
}

/// Reads a save.
pub(crate) fn open(path: &Path) -> Result<Opened, Unreadable> {
    let bytes = bytes(path).map_err(Unreadable::File)?;
    read::read(&bytes).map_err(Unreadable::Save)
}

/// Reads a save of which nothing else can be said if it cannot be read.
pub(crate) fn must_open(path: &Path, locale: Locale) -> Result<Opened, Refusal> {
    open(path).map_err(|why| Refusal {
        lines: match why {
            Unreadable::File(why) => vec![format!("trik: {}: {why}", telling::named(path))],
            Unreadable::Save(problems) => Teller::new(path, None, locale).lines(&problems),
        },
        code: UNREADABLE,
    })
}

/// The bytes of a file that is no longer than a save may be.
fn bytes(path: &Path) -> Result<Vec<u8>, String> {
    let failed = |error: io::Error| match error.kind() {
        io::ErrorKind::NotFound => "there is no such file".to_owned(),
        io::ErrorKind::IsADirectory => {
            "this is a directory: name a diagram, a file NAME.qrs".to_owned()
        }
        _ => format!("cannot be read: {error}"),
    };
    let limit = SAVE_BYTES as u64;
    let mut bytes = Vec::new();
    let file = File::open(path).map_err(failed)?;
    file.take(limit + 1)
        .read_to_end(&mut bytes)
        .map_err(failed)?;
    if bytes.len() as u64 > limit {
        let mib = limit >> 20;
        return Err(format!("longer than {mib} MiB, which no diagram is"));
    }
    Ok(bytes)
}
