//! The options of `trik check` for recordings of robots.
//!
//! Owns these, and how they are passed to a worker process. Knows nothing of what they do.

use crate::recording::shared::{moment, seconds};
use clap::{Args, ValueEnum};
use std::ffi::OsString;

/// The node of the controller that says where the robot is.
const ODOMETRY: &str = "odometry";

/// How recordings are judged.
#[derive(Args, Clone, Debug)]
pub(crate) struct RecordedArgs {
    /// With --log: the node of a recording that says where the robot was, by x, y and heading.
    #[arg(long, value_name = "NODE", default_value = ODOMETRY)]
    pub pose: String,
    /// With --log: what of that node is the place where the world has the robot begin.
    #[arg(long, value_name = "PLACE", value_enum, default_value_t = Origin::Start)]
    pub pose_from: Origin,
    /// With --log: the second of a recording at which the run begins [default: when its first program starts, or else its
    /// beginning].
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub from: Option<u64>,
    /// With --log: the second of a recording at which the run ends [default: when that program ends, or else its end].
    #[arg(long, value_name = "SECONDS", value_parser = moment)]
    pub to: Option<u64>,
}

impl Default for RecordedArgs {
    fn default() -> Self {
        Self {
            pose: ODOMETRY.to_owned(),
            pose_from: Origin::Start,
            from: None,
            to: None,
        }
    }
}

/// Which place of a recording is that where a world has its robot begin.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub(crate) enum Origin {
    /// Where it was when the run began.
    Start,
    /// Where the node says 0 0 0, as odometry does where the tree was mounted.
    Zero,
}

impl Origin {
    fn name(self) -> &'static str {
        match self {
            Self::Start => "start",
            Self::Zero => "zero",
        }
    }
}

impl RecordedArgs {
    /// The words that pass them on.
    pub(super) fn for_worker(&self) -> Vec<OsString> {
        let mut pose = OsString::from("--pose=");
        pose.push(&self.pose);
        let mut words = vec![
            pose,
            format!("--pose-from={}", self.pose_from.name()).into(),
        ];
        for (name, ns) in [("--from", self.from), ("--to", self.to)] {
            words.extend(ns.map(|ns| format!("{name}={}", seconds(ns)).into()));
        }
        words
    }
}
