//! The options of `trik bridge`.
//!
//! Owns the options. Knows nothing of what they do.

use crate::remote::target::{Target, target};
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
    /// Serve a tree live over Foxglove's WebSocket, for Foxglove, Lichtblick, PlotJuggler and others.
    ///
    /// Every node is a channel with the messages that a recording has; parameters are sampling periods, parameters of filters
    /// and variables of the diagram that runs; services stop the robot and run a program that it has. A tree that is unmounted
    /// is waited for.
    ///
    /// Exit status: 0 somebody has ended it; 1 there is no tree, or the address cannot be had; 2 the command line was not
    /// understood.
    Foxglove(FoxgloveArgs),
}

/// The options of `trik bridge foxglove`.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct FoxgloveArgs {
    /// The address to listen on; 0.0.0.0 or :: lets everybody in the network look.
    #[arg(long, default_value = "127.0.0.1")]
    pub address: IpAddr,
    /// The TCP port; 0 takes a free one.
    #[arg(long, default_value_t = 8765)]
    pub port: u16,
    /// Let clients of other computers set parameters and call services too, with your rights. There is no password.
    #[arg(long)]
    pub control: bool,
    /// A web page that may use the robot from a browser, such as https://lichtblick.example; may be given several times. Those
    /// of this computer and that of Foxglove may anyway.
    #[arg(long, value_name = "URL")]
    pub origin: Vec<String>,
    /// Where the robot takes programs: its name or address, with its port if that is not 8888 [default: that of the virtual
    /// robot with this tree].
    #[arg(long, value_name = "ADDRESS", value_parser = target)]
    pub programs: Option<Target>,
    /// The robot: where its tree is mounted, or the address of a virtual one.
    #[arg(long, value_name = "ROBOT", conflicts_with = "mountpoint")]
    pub robot: Option<PathBuf>,
    /// The mounted tree [default: the virtual robot that runs, or else /trikfs].
    pub mountpoint: Option<PathBuf>,
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
