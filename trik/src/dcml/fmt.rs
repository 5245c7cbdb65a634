//! `trik dcml fmt`: the one layout.
//!
//! Owns which files are changed. The layout is known to crate `lang`.

use super::report;
use super::source::read;
use crate::output::{replace, standard};
use crate::refusal::{REFUSED, Refusal, UNREADABLE, say};
use clap::Args;
use lang_dcml::format::format;
use std::fs;
use std::path::{Path, PathBuf};

/// What `trik dcml fmt` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct FmtArgs {
    /// Files with models; - is standard input.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Change nothing, and name the files that would change.
    #[arg(long)]
    pub check: bool,
}

/// Formats all files; the worst result is the exit code.
pub(super) fn run(args: &FmtArgs) -> Result<u8, Refusal> {
    let mut code = 0;
    for path in &args.files {
        code = code.max(match one(path, args.check) {
            Ok(code) => code,
            Err(refusal) => {
                say(&refusal.lines);
                refusal.code
            }
        });
    }
    Ok(code)
}

fn one(path: &Path, is_check: bool) -> Result<u8, Refusal> {
    // A model that comes with the program is no file that could be changed.
    if path != Path::new("-") && fs::symlink_metadata(path).is_err() {
        return Err(Refusal {
            lines: vec![format!("trik: {}: there is no such file", path.display())],
            code: UNREADABLE,
        });
    }
    let source = read(path)?;
    let name = &source.name;
    let laid = match format(&source.text) {
        Ok(laid) => laid,
        Err(why) => {
            report::show(&source, &why);
            return Err(Refusal::new(format!(
                "{name}: not changed, because it cannot be understood"
            )));
        }
    };
    let is_same = laid == source.text;
    if is_check {
        if is_same {
            return Ok(0);
        }
        let differs = |(one, other): (&str, &str)| one != other;
        let line = source.text.lines().zip(laid.lines()).position(differs);
        let line = line.unwrap_or_else(|| source.text.lines().count().min(laid.lines().count()));
        say(&[format!(
            "trik: {name}:{}: not in the layout: trik dcml fmt changes it",
            line + 1
        )]);
        return Ok(REFUSED);
    }
    if path == Path::new("-") {
        standard(laid.as_bytes())?;
        return Ok(0);
    }
    if is_same {
        return Ok(0);
    }
    let there = fs::metadata(path).ok();
    if there.as_ref().is_some_and(|there| !there.is_file()) {
        return Err(Refusal {
            lines: vec![format!(
                "trik: {name}: only a file can be changed: give other texts to trik dcml fmt -"
            )],
            code: UNREADABLE,
        });
    }
    replace(path, there.as_ref(), laid.as_bytes())
        .map_err(|error| Refusal::new(format!("{name} cannot be written: {error}")))?;
    Ok(0)
}
