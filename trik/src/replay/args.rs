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
