//! Why there is no view, or why it ended.
//!
//! Owns the reasons, which of the two processes prints them, and their words.

use nix::errno::Errno;
use std::fmt;
use std::io;
use std::path::PathBuf;
use std::process::ExitStatus;

/// One reason.
#[derive(Debug)]
pub enum Failure {
    /// The serving process has told the reason.
    Told,
    /// The mount point cannot be made.
    MountPoint(PathBuf, io::Error),
    /// Nothing can be mounted there, in the words of trikfs.
    Mount(String),
    /// The system refuses signals.
    Signals(Errno),
    /// The system refuses what serving needs.
    Serving(io::Error),
    /// The serving process was killed.
    Killed(ExitStatus),
    /// It was stopped and did not go on, so the keeper has killed it.
    Stopped,
    /// The keeper died before the serving process had begun.
    KeeperGone,
    /// The view would hide its own tree.
    OverItsTree(PathBuf),
    /// A path that cannot be made absolute.
    Path(PathBuf, io::Error),
    /// Standard output takes nothing.
    Output(io::Error),
    /// The manual cannot be written.
    Manual(io::Error),
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Told => f.write_str("the serving process has told the reason"),
            Self::MountPoint(path, error) => {
                write!(f, "the mount point {}: {error}", path.display())
            }
            Self::Mount(reason) => f.write_str(reason),
            Self::Signals(error) => write!(f, "signals: {error}"),
            Self::Serving(error) => write!(f, "serving: {error}"),
            Self::Killed(status) => write!(f, "the serving process was ended by {status}"),
            Self::Stopped => f.write_str("the serving process was stopped and did not go on"),
            Self::KeeperGone => f.write_str("the process that keeps the mount is gone"),
            Self::OverItsTree(path) => write!(
                f,
                "{}: the view cannot be mounted over its own tree",
                path.display()
            ),
            Self::Path(path, error) => write!(f, "{}: {error}", path.display()),
            Self::Output(error) => write!(f, "standard output: {error}"),
            Self::Manual(error) => write!(f, "{error}"),
        }
    }
}

impl std::error::Error for Failure {}
