//! The options of `trik record`.
//!
//! Owns the options. Knows nothing of what they do.

use crate::error::Error;
use crate::remote::target::{Target, is_path, target};
use clap::Args;
use recorder::pattern::matches;
use std::path::PathBuf;

/// The options of `trik record`.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct RecordArgs {
    /// The recording, a new file.
    #[arg(long, short, value_name = "FILE.mcap", default_value = "robot.mcap")]
    pub output: PathBuf,
    /// Only nodes whose path is matched: * stands for anything, and a group for all below it; may be given several times.
    #[arg(long, value_name = "PATTERN")]
    pub only: Vec<String>,
    /// Stop after this many seconds [default: on Ctrl-C, or when the tree is unmounted].
    #[arg(long, value_name = "SECONDS", value_parser = clap::value_parser!(u32).range(1..=86400 * 7))]
    pub seconds: Option<u32>,
    /// Record what happens on this robot: its name or address, with its port if that is not 8888, and it sends that over
    /// the network; or where its tree is mounted, a path with a slash.
    #[arg(long, value_name = "ROBOT", value_parser = recorded, conflicts_with = "mountpoint")]
    pub robot: Option<Recorded>,
    /// Of a robot in the network: at most NUMBER samples a second of each node, the newest ones [default: all].
    #[arg(long, value_name = "NUMBER", requires = "robot", value_parser = rate)]
    pub hz: Option<f64>,
    /// Leave out the messages of standard types, which other tools show at once: a smaller file.
    #[arg(long)]
    pub no_standard: bool,
    /// Record what devices give before it is converted too, of nodes with raw = true or a robot of trik up --raw: then trik
    /// replay --config tries other converters on it.
    #[arg(long)]
    pub raw: bool,
    /// Overwrite the recording if it exists.
    #[arg(long)]
    pub force: bool,
    /// The mounted tree [default: the virtual robot that runs, or else /trikfs].
    pub mountpoint: Option<PathBuf>,
}

/// A robot that is recorded.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) enum Recorded {
    /// One that sends what happens there.
    Network(Target),
    /// One whose tree is mounted here.
    Tree(PathBuf),
}

/// A robot by its name, address or mountpoint; for the command line.
fn recorded(text: &str) -> Result<Recorded, Error> {
    match is_path(text) {
        true => Ok(Recorded::Tree(text.into())),
        false => target(text).map(Recorded::Network),
    }
}

impl RecordArgs {
    /// Whether a node is wanted.
    pub(super) fn wants(&self, path: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|pattern| matches(pattern, path))
    }
}

/// A number of samples in a second.
fn rate(text: &str) -> Result<f64, Error> {
    let number = text.parse().ok();
    let fits = number.filter(|number| (0.01..=10_000.0).contains(number));
    fits.ok_or_else(|| Error::Refused("a number from 0.01 to 10000".to_owned()))
}
