//! The commands for authors of converters: `convert` and `new-converter`.
//!
//! Owns their words and which of them go together; `trial` and `kit` do the work.

use super::{SearchArgs, print};
use crate::failure::Failure;
use crate::kit::{self, Language};
use crate::limits::RECORDING_BYTES_MAX;
use crate::trial::stream::{self, Input, Shape, Wishes};
use crate::trial::{self, Random, Subject};
use clap::{Args, ValueEnum};
use converter::Direction;
use converter::limits::TRIAL_TUPLES_MAX;
use std::collections::BTreeMap;
use std::fs::File;
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};

#[derive(Args)]
pub(super) struct ConvertArgs {
    #[command(flatten)]
    search: SearchArgs,
    /// Print a line for each tuple, as the file `value` of the node would show it.
    #[arg(long)]
    text: bool,
    /// Print each tuple as a line in hexadecimal.
    #[arg(long, conflicts_with = "text")]
    hex: bool,
    /// Print on standard error how long the conversions took: median, 99th percentile, maximum, and tuples per second.
    /// Each time includes one reading of the clock.
    #[arg(long)]
    timing: bool,
    /// Go on after a refused tuple, and report all of them at the end; the exit status is then still 1.
    #[arg(long)]
    keep_going: bool,
    /// From the program to the device: the input is what programs write, the output what the device gets.
    #[arg(long)]
    write: bool,
    /// The input is a recording, lines `TIME_MS HEX` as `replay` takes them; lines of output begin with the time.
    #[arg(long)]
    replay: bool,
    /// Check the converter against a file of vectors instead of converting: which input must give which output.
    #[arg(long, value_name = "FILE", conflicts_with_all = ["text", "hex", "timing", "keep_going", "replay", "input"])]
    vectors: Option<PathBuf>,
    /// Test the converter with TUPLES random, extreme and (from INPUT) damaged tuples instead of converting: numbers
    /// stay finite, nothing is written outside the output, and after opening again it gives the same.
    #[arg(long, value_name = "TUPLES", value_parser = clap::value_parser!(u32).range(1..=TRIAL_TUPLES_MAX as i64),
        conflicts_with_all = ["text", "hex", "timing", "keep_going", "replay", "vectors"])]
    random: Option<u32>,
    /// Repeat the random tuples of an earlier run.
    #[arg(long, value_name = "NUMBER", requires = "random")]
    seed: Option<u32>,
    /// The configuration.
    file: PathBuf,
    /// Path of the node in the tree, for example motors/M1.
    node: String,
    /// Recorded bytes; standard input if it is - or not given.
    input: Option<PathBuf>,
}

#[derive(Args)]
pub(super) struct NewConverterArgs {
    /// The language. Lua needs no build and cannot crash anything; the others are faster.
    #[arg(long, value_enum)]
    lang: LanguageName,
    /// Name of the converter and of the node that shows it: a-z, 0-9 and _.
    name: String,
    /// Folder to create for it [default: NAME].
    #[arg(long, value_name = "DIR")]
    dir: Option<PathBuf>,
}

/// A language as it is called here.
#[derive(Clone, Copy, ValueEnum)]
enum LanguageName {
    Lua,
    C,
    Rust,
}

pub(super) fn new_converter(args: &NewConverterArgs) -> Result<(), Failure> {
    let language = match args.lang {
        LanguageName::Lua => Language::Lua,
        LanguageName::C => Language::C,
        LanguageName::Rust => Language::Rust,
    };
    let made = kit::new_converter(language, &args.name, args.dir.as_deref())?;
    print(made.render().as_bytes())
}

pub(super) fn convert(args: &ConvertArgs) -> Result<(), Failure> {
    let paths = args.search.paths()?;
    let place = (args.file.as_path(), args.node.as_str());
    let direction = if args.write {
        Direction::Write
    } else {
        Direction::Read
    };
    if let Some(vectors) = &args.vectors {
        let text = trial::check_vectors(place, direction, &paths, vectors)?;
        return print(text.as_bytes());
    }
    let subject = Subject::load(place, direction, &paths, &BTreeMap::new())?;
    match args.random {
        Some(tuples) => random(args, &subject, tuples),
        None => stream(args, &subject),
    }
}

fn random(args: &ConvertArgs, subject: &Subject, tuples: u32) -> Result<(), Failure> {
    let recorded = match &args.input {
        None => Vec::new(),
        Some(file) => trial::read(file, RECORDING_BYTES_MAX)?,
    };
    let random = Random {
        tuples: tuples as usize,
        seed: args.seed.unwrap_or_else(converter::trial::seed),
    };
    print(trial::check_random(subject, &random, &recorded)?.as_bytes())
}

fn stream(args: &ConvertArgs, subject: &Subject) -> Result<(), Failure> {
    let wishes = Wishes {
        shape: match (args.text, args.hex) {
            (true, _) => Shape::Text,
            (_, true) => Shape::Hex,
            _ => Shape::Raw,
        },
        keep_going: args.keep_going,
        timing: args.timing,
    };
    let standard = Path::new("standard input");
    let named = args.input.as_deref().filter(|file| *file != Path::new("-"));
    let name = named.unwrap_or(standard);
    let mut bytes: Box<dyn Read> = match named {
        Some(file) => Box::new(File::open(file).map_err(|error| Failure::file(file, error))?),
        None => Box::new(io::stdin().lock()),
    };
    let mut input = if args.replay {
        Input::recording(&mut bytes, name)?
    } else {
        Input::Bytes(&mut bytes, name.display().to_string())
    };
    let (lines, result) = stream::run(subject, wishes, &mut input, &mut io::stdout().lock());
    for line in lines {
        let _ = writeln!(io::stderr(), "{line}");
    }
    result
}
