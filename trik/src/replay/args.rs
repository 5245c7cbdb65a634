//! The options of `trik replay`.
//!
//! Owns the options and the forms of their values. Knows nothing of what they do.

use super::order;
use crate::limits;
use crate::up::args::ServingArgs;
use clap::Args;
use std::path::PathBuf;
use std::time::Duration;

/// The options of `trik replay`.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct ReplayArgs {
    /// The recording, as `trik record` writes it.
    pub file: PathBuf,
    /// Seconds of the recording in a real one, from 0.01 to 1000.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = speed)]
    pub speed: f64,
    /// Where to begin: seconds, or MINUTES:SECONDS.
    #[arg(long, value_name = "TIME", visible_alias = "from", value_parser = start)]
    pub start: Option<Duration>,
    /// Begin again at the end.
    #[arg(long = "loop")]
    pub is_loop: bool,
    /// Begin stopped: the clock goes on with `go`, or the space bar.
    #[arg(long)]
    pub paused: bool,
    /// End when the recording is at its end; exit status 1 if a program has written something else than was recorded.
    #[arg(long, conflicts_with = "is_loop")]
    pub exit: bool,
    /// Run the converters of this configuration on what devices gave, and give what comes of it; all other nodes give what
    /// was recorded. The recording has it if it was made with trik record --raw.
    #[arg(long, value_name = "FILE.lua")]
    pub config: Option<PathBuf>,
    /// Directory of files that this configuration includes, searched before /etc/trikfs; may be given several times.
    #[arg(long, value_name = "DIR", requires = "config")]
    pub include: Vec<PathBuf>,
    /// Mount nothing: tell where what the configuration makes differs from what was recorded, as fast as that goes. The exit
    /// status is 1 if anything differs.
    #[arg(long, requires = "config", conflicts_with_all = ["is_loop", "paused", "exit", "mountpoint"])]
    pub diff: bool,
    /// With --diff, only nodes whose path is matched: * stands for anything, and a group for all below it; may be given
    /// several times.
    #[arg(long, value_name = "PATTERN", requires = "diff")]
    pub only: Vec<String>,
    /// With --diff, both drawn in one picture, a new SVG file; - is standard output.
    #[arg(long, short, value_name = "OUT.svg", requires = "diff")]
    pub output: Option<PathBuf>,
    /// Overwrite the picture if it exists.
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Do not show where the replay is, even on a terminal.
    #[arg(long)]
    pub no_view: bool,
    #[command(flatten)]
    pub serving: ServingArgs,
    /// An empty directory; created if it does not exist, and then removed again [default: as for trik up].
    pub mountpoint: Option<PathBuf>,
}

fn speed(text: &str) -> Result<f64, String> {
    let (min, max) = (limits::REPLAY_SPEED_MIN, limits::REPLAY_SPEED_MAX);
    order::speed_of(text).ok_or_else(|| format!("not a number from {min} to {max}"))
}

fn start(text: &str) -> Result<Duration, String> {
    order::time(text).ok_or_else(|| "expected seconds, or MINUTES:SECONDS".to_owned())
}
