//! `trik cut`: a piece of a recording as a recording.
//!
//! Owns which messages are in the piece. Everything else of the recording goes with it, so that it explains itself too.

use super::failed;
use super::fresh::Fresh;
use super::shared::{Watched, moment, open, seconds};
use crate::error::Error;
use crate::output::standard;
use crate::refusal::Refusal;
use crate::terminal::named;
use clap::Args;
use journal::mend::copy;
use journal::node::path_of;
use recorder::pattern::matches;
use std::io::BufWriter;
use std::path::PathBuf;

/// The options of `trik cut`.
#[derive(Args, Clone, Debug)]
pub(crate) struct CutArgs {
    /// The recording.
    pub file: PathBuf,
    /// Where the piece begins, in seconds from the beginning [default: at the beginning].
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub from: Option<u64>,
    /// Where it ends; what happens at this moment is in it [default: at the end].
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub to: Option<u64>,
    /// Only topics that are matched: * stands for anything, and a group for all below it; may be given several times.
    #[arg(long, value_name = "PATTERN")]
    pub only: Vec<String>,
    /// The piece, a new file.
    #[arg(long, short, value_name = "FILE.mcap")]
    pub output: PathBuf,
    /// Overwrite the piece if it exists.
    #[arg(long)]
    pub force: bool,
}

/// Cuts it.
///
/// # Errors
/// It is no whole recording, nothing is in the piece, or that cannot be written.
pub(crate) fn run(args: &CutArgs) -> Result<u8, Refusal> {
    let whole = open(&args.file)?;
    let (begin, end) = (whole.begin_ns(), whole.end_ns());
    let from = begin.saturating_add(args.from.unwrap_or(0));
    let to = args.to.map_or(u64::MAX, |to| begin.saturating_add(to));
    if to < from {
        return Err(Refusal::new("--to lies before --from"));
    }
    if from > end {
        let length = seconds(end.saturating_sub(begin));
        let why = format!("the recording is {length} s long: nothing is after --from");
        return Err(Error::file(&args.file, why).into());
    }
    let is_wanted = |topic: &str, at: u64| {
        let name = topic.trim_start_matches('/');
        let is_it = |one: &String| matches(one, name) || matches(one, path_of(name));
        let is_named = args.only.is_empty() || args.only.iter().any(is_it);
        is_named && (from..=to).contains(&at)
    };
    let fresh = Fresh::new(&args.output, &args.file, args.force)?;
    let source = Watched::open(&args.file)?;
    let kept = copy(source, BufWriter::new(fresh.file()?), is_wanted);
    let kept = kept.map_err(|why| failed(&args.file, &args.output, why))?;
    // Half of a piece is none.
    if let Some(why) = kept.cut {
        return Err(Error::file(&args.file, why).into());
    }
    if kept.messages == 0 {
        return Err(Error::file(&args.file, "nothing happens in this piece").into());
    }
    fresh.place()?;
    let line = format!("{}: {} messages\n", named(&args.output), kept.messages);
    standard(line.as_bytes())?;
    Ok(0)
}
