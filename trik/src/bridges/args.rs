//! The options of `trik bridge`.
//!
//! Owns the options. Knows nothing of what they do.

use clap::{Args, Subcommand};
use std::net::IpAddr;
use std::path::PathBuf;

/// What a tree is served for.
#[derive(Subcommand, Clone, Debug, PartialEq, Eq)]
pub(crate) enum Bridge {
    /// Serve health and values of a tree as the text that Prometheus reads, at /metrics.
    ///
    /// A node that fails has no value, and its errno as a series of its own. A tree that is unmounted is waited for; trikfs_up
    /// is 0 meanwhile.
    ///
    /// Exit status: 0 somebody has ended it; 1 there is no tree, or the address cannot be had; 2 the command line was not
    /// understood.
    Prometheus(PrometheusArgs),
}

/// The options of `trik bridge prometheus`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct PrometheusArgs {
    /// The address to listen on; 0.0.0.0 or :: lets everybody in the network read.
    #[arg(long, default_value = "127.0.0.1")]
    pub address: IpAddr,
    /// The TCP port; 0 takes a free one.
    #[arg(long, default_value_t = 9464)]
    pub port: u16,
    /// The robot: where its tree is mounted, or the address of a virtual one.
    #[arg(long, value_name = "ROBOT", conflicts_with = "mountpoint")]
    pub robot: Option<PathBuf>,
    /// The mounted tree [default: the virtual robot that runs, or else /trikfs].
    pub mountpoint: Option<PathBuf>,
}
