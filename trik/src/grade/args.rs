//! The options of `trik grade-worker`, `trik grade-submit` and `trik grade-status`.
//!
//! Owns the options. Knows nothing of what they do.

use crate::check::{MEMORY_MIB, MODEL_SECONDS, WALL_SECONDS, memory, model_seconds, wall_seconds};
use crate::language;
use clap::Args;
use lang_text::problem::Locale;
use std::net::IpAddr;
use std::path::PathBuf;

/// Where the queue is.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
#[command(next_help_heading = "Options for the server")]
pub(crate) struct ServerArgs {
    /// The NATS server, with its port if that is not 4222; tls://HOST is one behind TLS. Several with commas between them are
    /// one cluster.
    #[arg(long, value_name = "SERVER", default_value = "127.0.0.1")]
    pub server: String,
    /// Who it is for the server; needs --password-file.
    #[arg(long, requires = "password_file")]
    pub user: Option<String>,
    /// A file with the password in its first line. On the command line everybody could read it.
    #[arg(long, value_name = "FILE", requires = "user")]
    pub password_file: Option<PathBuf>,
    /// Certificates of those who vouch for a server behind TLS, as PEM [default: whom this computer trusts].
    #[arg(long, value_name = "FILE")]
    pub ca: Option<PathBuf>,
}

/// The options of `trik grade-worker`.
#[derive(Args, Clone, Debug)]
pub(crate) struct WorkerArgs {
    /// The tasks that it judges, as of trik check --tasks: fields NAME.xml, folders NAME with several fields, and saves
    /// NAME.qrs that pupils were given.
    #[arg(long, value_name = "DIR")]
    pub tasks: PathBuf,
    /// How many submissions at once [default: one for each core].
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=256))]
    pub jobs: Option<u16>,
    /// What results say of who has judged [default: the name of this computer].
    #[arg(long)]
    pub name: Option<String>,
    /// Tell why each run ended as it did.
    #[arg(long)]
    pub explain: bool,
    /// Longest run in seconds of simulated time, whatever the rules say.
    #[arg(long, value_name = "SECONDS", default_value_t = MODEL_SECONDS, value_parser = model_seconds)]
    pub time_limit: f64,
    /// Longest run in seconds of real time; a longer one is tried again, and is a dead letter after the third time.
    #[arg(long, value_name = "SECONDS", default_value_t = WALL_SECONDS, value_parser = wall_seconds)]
    pub wall_limit: f64,
    /// Maximum memory of one process, in MiB.
    #[arg(long, value_name = "MIB", default_value_t = MEMORY_MIB, value_parser = memory())]
    pub memory: u32,
    /// Judge nothing unless this computer gives every layer of the sandbox for Python.
    #[arg(long)]
    pub require_sandbox: bool,
    /// Language of messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
    /// The server.
    #[command(flatten)]
    pub server: ServerArgs,
}

/// The options of `trik grade-submit`.
#[derive(Args, Clone, Debug)]
pub(crate) struct SubmitArgs {
    /// Solutions: NAME.qrs, NAME.flow, NAME.js, NAME.py.
    #[arg(value_name = "FILE", required = true)]
    pub files: Vec<PathBuf>,
    /// The task [default: the name of each file without its ending].
    #[arg(long, value_name = "NAME")]
    pub task: Option<String>,
    /// Wait until all are judged, and print each result as a line of JSON.
    #[arg(long)]
    pub wait: bool,
    /// With --wait, and one file: write the report of each run into this directory, as FIELD.json, in the form of TRIK
    /// Studio's 2D-model.
    #[arg(long, value_name = "DIR", requires = "wait")]
    pub report: Option<PathBuf>,
    /// With --wait: for so many seconds at most.
    #[arg(long, value_name = "SECONDS", requires = "wait", value_parser = clap::value_parser!(u32).range(1..))]
    pub timeout: Option<u32>,
    /// The server.
    #[command(flatten)]
    pub server: ServerArgs,
}

/// The options of `trik grade-status`.
#[derive(Args, Clone, Debug)]
pub(crate) struct StatusArgs {
    /// Serve a page with the same until Ctrl-C, which a browser shows anew every two seconds.
    #[arg(long)]
    pub page: bool,
    /// With --page: the address to listen on; 0.0.0.0 or :: lets everybody in the network read.
    #[arg(long, requires = "page", default_value = "127.0.0.1")]
    pub address: IpAddr,
    /// With --page: the TCP port; 0 takes a free one.
    #[arg(long, requires = "page", default_value_t = 8300)]
    pub port: u16,
    /// The server.
    #[command(flatten)]
    pub server: ServerArgs,
}
