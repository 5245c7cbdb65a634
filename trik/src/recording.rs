//! `trik info` and `trik mend`: looks into recordings, and makes cut ones whole.
//!
//! Owns what a person is told of a file. What is in one is known to `journal`. `cut` takes a piece of one, `export` makes a
//! table of it, `plot` a picture.

pub(crate) mod cut;
pub(crate) mod export;
pub(crate) mod fresh;
pub(crate) mod plot;
pub(crate) mod shared;

use crate::error::Error;
use crate::limits;
use crate::output::{Output, standard};
use crate::refusal::Refusal;
use crate::terminal::harmless;
use clap::Args;
use fresh::Fresh;
use journal::mend::{Saved, check, mend_file as mend_whole};
use journal::node::Node;
use journal::read::Reader;
use journal::write::ABOUT;
use lang_text::problem::Locale;
use std::collections::HashMap;
use std::fmt::Write;
use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::{Path, PathBuf};

/// The options of `trik info`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct InfoArgs {
    /// The recording.
    pub file: PathBuf,
    /// Give one of the files that go with it instead: config.lua, world.json, programs/NAME; of several with this name the
    /// last.
    #[arg(long, value_name = "NAME")]
    pub attachment: Option<String>,
    /// Where that file goes, a new one [default: standard output].
    #[arg(long, short, value_name = "FILE", requires = "attachment")]
    pub output: Option<PathBuf>,
    /// Overwrite it if it exists.
    #[arg(long, requires = "output")]
    pub force: bool,
}

/// The options of `trik mend`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct MendArgs {
    /// The cut recording.
    pub file: PathBuf,
    /// A new file for the whole one [default: it takes the place of the cut one].
    #[arg(long, short, value_name = "FILE.mcap")]
    pub output: Option<PathBuf>,
    /// Overwrite that file if it exists.
    #[arg(long, requires = "output")]
    pub force: bool,
}

/// Tells what is in a recording.
///
/// # Errors
/// It is none, or it is cut.
pub(crate) fn info(args: &InfoArgs) -> Result<u8, Refusal> {
    match &args.attachment {
        Some(name) => fetch(args, name)?,
        None => standard(summary(&args.file)?.as_bytes())?,
    }
    Ok(0)
}

/// Gives a file that goes with a recording. Its name there only finds it: where it goes is what the person says.
fn fetch(args: &InfoArgs, name: &str) -> Result<(), Refusal> {
    let output = Output {
        path: args.output.as_deref(),
        force: args.force,
        source: &args.file,
        locale: Locale::English,
    };
    output.refuse_present()?;
    let fail = |why| Error::file(&args.file, why);
    let mut reader = Reader::open(open(&args.file)?).map_err(fail)?;
    let mut names: Vec<String> = Vec::new();
    for (known, _) in reader.attachments() {
        if known == name {
            let bytes = reader.attachment(name).map_err(fail)?;
            return output.write(&bytes);
        }
        let known = harmless(&known);
        if names.len() < limits::FILES_TOLD && !names.contains(&known) {
            names.push(known);
        }
    }
    let name = harmless(name);
    let why = match &names[..] {
        [] => format!("no file {name} goes with it, and no other one"),
        some => format!("no file {name} goes with it; there are {}", some.join(", ")),
    };
    Err(Error::file(&args.file, why).into())
}

fn summary(path: &Path) -> Result<String, Error> {
    let fail = |why| Error::file(path, why);
    let mut reader = Reader::open(open(path)?).map_err(fail)?;
    let facts = reader.facts(ABOUT).map_err(fail)?;
    let lost = reader.facts("counts").map_err(fail)?;
    let (counts, all) = reader.counts();
    let seconds = reader.end_ns().saturating_sub(reader.begin_ns()) as f64 / 1e9;
    let mut text = format!(
        "{}: {seconds:.1} s, {all} messages, {} bytes\n",
        path.display(),
        reader.size()
    );
    for key in ["program", "host", "tree"] {
        if let Some(value) = facts.get(key) {
            put(&mut text, format_args!("{key:<9} {}\n", harmless(value)));
        }
    }
    for key in ["missed", "dropped"] {
        if let Some(count) = lost.get(key).filter(|count| *count != "0") {
            put(
                &mut text,
                format_args!("{key:<9} {} events\n", harmless(count)),
            );
        }
    }
    for (name, bytes) in reader.attachments() {
        put(
            &mut text,
            format_args!("file      {} ({bytes} bytes)\n", harmless(&name)),
        );
    }
    let by_topic: HashMap<String, &Node> = (reader.nodes().iter().enumerate())
        .filter_map(|(number, node)| Some((reader.topic_of(number)?, node)))
        .collect();
    for (topic, count) in &counts {
        let node = by_topic.get(topic);
        let what = node.map_or_else(String::new, |node| {
            let format: String = node.format.chars().take(40).collect();
            format!("{format}   {}", node.units)
        });
        let name = harmless(topic.trim_start_matches('/'));
        put(
            &mut text,
            format_args!("{count:>9} {name:<24} {}\n", harmless(what.trim_end())),
        );
    }
    Ok(text)
}

/// Writing to a string cannot fail.
fn put(text: &mut String, what: std::fmt::Arguments<'_>) {
    let _ = text.write_fmt(what);
}

fn open(path: &Path) -> Result<BufReader<File>, Error> {
    let file = File::open(path).map_err(|error| Error::file(path, error))?;
    match file.metadata().is_ok_and(|file| file.is_file()) {
        true => Ok(BufReader::new(file)),
        false => Err(Error::file(path, "a recording is a regular file")),
    }
}

/// Why no recording was made of another one: of each file its own reasons.
fn failed(from: &Path, to: &Path, why: journal::error::Error) -> Error {
    let is_output = matches!(why, journal::error::Error::Output(_));
    Error::file(if is_output { to } else { from }, why)
}

/// What a mended recording has not.
fn left_out(saved: &Saved) -> String {
    match (saved.is_only_cut(), saved.left_out) {
        (true, _) => String::new(),
        (false, 0) => format!(
            "; damaged at byte {}, and nothing can be read behind it",
            saved.at
        ),
        (false, count) => format!(
            "; left out: {count} damaged parts or messages, the first at byte {}",
            saved.at
        ),
    }
}

/// Makes a cut recording whole.
///
/// # Errors
/// It is no recording, or the whole one cannot be written.
pub(crate) fn mend_file(args: &MendArgs) -> Result<u8, Refusal> {
    standard(mended(args)?.as_bytes())?;
    Ok(0)
}

fn mended(args: &MendArgs) -> Result<String, Refusal> {
    let path = &args.file;
    if args.output.is_none() {
        let found = check(open(path)?).map_err(|why| Error::file(path, why))?;
        if found.cut.is_none() && Reader::open(open(path)?).is_ok() {
            return Ok(format!("{}: it is whole\n", path.display()));
        }
        if !found.is_only_cut() {
            // What cannot be read today may be read by something else tomorrow.
            let why = format!(
                "it is damaged at byte {}, not only cut: name a new file by -o, which gets what is whole",
                found.at
            );
            return Err(Error::file(path, why).into());
        }
    }
    let from = open(path)?;
    let fresh = match &args.output {
        Some(output) => Fresh::new(output, path, args.force)?,
        None => Fresh::over(path)?,
    };
    let saved = mend_whole(from, BufWriter::new(fresh.file()?));
    let shown = args.output.as_ref().unwrap_or(path);
    let saved = saved.map_err(|why| failed(path, shown, why))?;
    fresh.place()?;
    let shown = shown.display();
    Ok(format!(
        "{shown}: {} messages and {} files that go with them{}\n",
        saved.messages,
        saved.attachments,
        left_out(&saved)
    ))
}
