//! The options of `trik record`.
//!
//! Owns the options. Knows nothing of what they do.

use clap::Args;
use recorder::pattern::matches;
use std::path::PathBuf;

/// The options of `trik record`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct RecordArgs {
    /// The recording, which must not exist yet.
    #[arg(long, short, value_name = "FILE.mcap", default_value = "robot.mcap")]
    pub output: PathBuf,
    /// Only nodes whose path is matched: * stands for anything, and a group for all below it; may be given several times.
    #[arg(long, value_name = "PATTERN")]
    pub only: Vec<String>,
    /// Stop after so many seconds [default: on Ctrl-C, or when the tree is unmounted].
    #[arg(long, value_name = "NUMBER", value_parser = clap::value_parser!(u32).range(1..=86400 * 7))]
    pub seconds: Option<u32>,
    /// Leave out the messages of standard types, which other tools show at once: a smaller file.
    #[arg(long)]
    pub no_standard: bool,
    /// The mounted tree [default: the virtual robot that runs, or else /trikfs].
    pub mountpoint: Option<PathBuf>,
}

impl RecordArgs {
    /// Whether a node is wanted.
    pub(super) fn wants(&self, path: &str) -> bool {
        self.only.is_empty() || self.only.iter().any(|pattern| matches(pattern, path))
    }
}
