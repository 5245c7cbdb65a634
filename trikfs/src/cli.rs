//! The command line: the commands and options, and which part of the crate does each.
//!
//! Owns the words, the help and the exit codes: 0 done, 1 refused or failed, 2 not understood, 3 given up. `run` mounts and serves,
//! `author` has the commands for authors of converters, `paths` knows where files are looked for, `edit` changes the
//! configuration of a mounted tree, `notify` speaks to a service manager.

mod author;
mod edit;
#[cfg(feature = "manual")]
mod manual;
mod notify;
mod paths;
mod run;

pub use paths::find_shipped;
pub(crate) use paths::search_paths;

use crate::check::SearchPaths;
use crate::convert::isolated;
use crate::daemon::Transport;
use crate::failure::Failure;
use crate::guardian::inherit::Handover;
use crate::mount::{self, Unmounted};
use clap::{Args, Parser, Subcommand, ValueEnum};
use config::problem::Problem;
use std::ffi::OsString;
use std::io::{self, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// A robot's peripherals as files in physical units.
///
/// trikfs mounts a tree in which each peripheral of a robot is a directory: read its files for values in physical
/// units, write them to move things. A configuration in Lua says which devices there are and how their bytes are
/// converted; it can be changed while the tree is in use by writing MOUNTPOINT/config.
#[derive(Parser)]
#[command(name = "trikfs", version, max_term_width = 100, after_long_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  trikfs check robot.lua                          is this configuration good?
  trikfs mount --config robot.lua /trikfs         serve it until Ctrl-C
  cat /trikfs/distance/value                      the newest value, as text
  trikfs edit /trikfs                             change the configuration in use
  trikfs convert --text robot.lua distance raw    try a converter without a device
  trikfs new-converter --lang c sonar             start a converter of your own
  trikfs umount /trikfs

Exit status: 0 success; 1 the configuration was refused, or something failed; 2 bad command line;
3 the tree was given up after crashes.";

/// The exit code of a guardian whose daemon crashed again and again: unlike a refused configuration it may be tried again.
const GIVEN_UP: u8 = 3;

#[derive(Subcommand)]
enum Command {
    /// Mount the tree and serve it.
    ///
    /// Stays in the foreground until it is unmounted or gets SIGTERM or SIGINT, and prints one line when the tree can
    /// be used. Then it brings all actuators to rest and unmounts. A tree that a killed trikfs left behind is replaced.
    Mount(MountArgs),
    /// Check a configuration as the mounted tree would, without opening a device.
    ///
    /// Prints `FILE:LINE: REASON` and exits with 1 if the configuration would be refused. Warnings, such as a device
    /// that is not there, do not change the exit status.
    Check(CheckArgs),
    /// Run one node's converter over recorded bytes, without mounting and without a device.
    ///
    /// Writes the converted bytes to standard output. A refused tuple ends it with its place, the reason and
    /// exit status 1. With --vectors or --random the converter is tested instead.
    Convert(author::ConvertArgs),
    /// Create a working project for a converter of your own, with tests.
    ///
    /// Prints the commands that try it. Nothing is downloaded, not even by its builds.
    NewConverter(author::NewConverterArgs),
    /// Unmount a tree; one that is in use is detached: it disappears at once, and programs get ENOTCONN from it.
    Umount {
        /// Where the tree is mounted.
        mountpoint: PathBuf,
    },
    /// Edit the configuration of a mounted tree and apply it.
    ///
    /// Opens a copy in $VISUAL, $EDITOR or vi and writes it back when the editor ends. If the text is refused, says why and
    /// offers to edit again; until then the old configuration stays in force.
    Edit {
        /// Where the tree is mounted.
        mountpoint: PathBuf,
    },
    /// Print a completion script for a shell.
    #[cfg(feature = "manual")]
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page, of the program or of one command, for example: trikfs man mount | man -l -
    #[cfg(feature = "manual")]
    Man {
        /// The command.
        command: Option<String>,
    },
    #[command(hide = true)]
    Serve(ServeArgs),
    #[command(hide = true, name = isolated::COMMAND)]
    Isolated {
        /// The process that has started this one.
        daemon: i32,
    },
}

/// Options that say what is served, for the guardian and its daemon alike.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
struct TreeArgs {
    /// Configuration to begin with; without it the tree is empty until MOUNTPOINT/config is written.
    #[arg(long, value_name = "FILE")]
    config: Option<PathBuf>,
    #[command(flatten)]
    search: SearchArgs,
    /// Group whose members may write MOUNTPOINT/config besides the mounting user. A configuration is code: it runs with
    /// the rights of trikfs.
    #[arg(long, value_name = "GROUP", value_parser = group_id)]
    config_group: Option<u32>,
    /// Group whose members may write what the mounting user may write of each node, such as motors, but not
    /// MOUNTPOINT/config: for unprivileged programs. Nodes whose description names a group keep that one. Needs
    /// --allow-other.
    #[arg(long, value_name = "GROUP", value_parser = group_id)]
    group: Option<u32>,
    /// How to talk to the kernel.
    #[arg(long, value_name = "NAME", value_enum, default_value_t = TransportName::Native)]
    transport: TransportName,
    /// Do not put samples into shared memory.
    #[arg(long, hide = !cfg!(feature = "sample-bus"))]
    no_sample_bus: bool,
    /// Put what devices give into shared memory too, as it is before converters: for trik record --raw. A node with raw = true
    /// does so without this option.
    #[arg(long, hide = !cfg!(feature = "sample-bus"), conflicts_with = "no_sample_bus")]
    raw: bool,
}

/// A transport as it is called here.
#[derive(Clone, Copy, Debug, PartialEq, Eq, ValueEnum)]
enum TransportName {
    /// The program's own layer over /dev/fuse.
    Native,
    /// The crate fuser: portable, but a program that waits for data cannot be killed.
    #[cfg(feature = "fuser")]
    Fuser,
}

impl TransportName {
    fn transport(self) -> Transport {
        match self {
            Self::Native => Transport::Native,
            #[cfg(feature = "fuser")]
            Self::Fuser => Transport::Fuser,
        }
    }
}

#[derive(Args, Clone, Debug, PartialEq, Eq)]
struct SearchArgs {
    /// Directory of files that configurations include, searched before /etc/trikfs; may be given several times.
    #[arg(long, value_name = "DIR")]
    include: Vec<PathBuf>,
    /// Private directory for compiled C and copies of libraries [default: /var/cache/trikfs for root, else
    /// ~/.cache/trikfs].
    #[arg(long, value_name = "DIR")]
    cache: Option<PathBuf>,
    /// Take all device paths of the configuration below this directory: /dev/i2c-2 means DIR/dev/i2c-2. A virtual board
    /// lives there.
    #[arg(long, value_name = "DIR")]
    device_root: Option<PathBuf>,
}

#[derive(Args, Clone, Debug, PartialEq, Eq)]
struct MountArgs {
    #[command(flatten)]
    tree: TreeArgs,
    /// Let other users in, with the permissions that the files show.
    #[arg(long)]
    allow_other: bool,
    /// Return when the tree can be used, and serve it in the background.
    #[arg(long)]
    background: bool,
    /// This is the process in the background.
    #[arg(long, hide = true)]
    detached: bool,
    /// A directory; created if it does not exist.
    mountpoint: PathBuf,
}

#[derive(Args)]
struct ServeArgs {
    #[command(flatten)]
    tree: TreeArgs,
    #[command(flatten)]
    handover: Handover,
    #[arg(long)]
    detached: bool,
    #[arg(long)]
    allow_other: bool,
    mountpoint: PathBuf,
}

#[derive(Args)]
struct CheckArgs {
    #[command(flatten)]
    search: SearchArgs,
    /// The configuration.
    file: PathBuf,
}

/// The program: reads the arguments of the process, does it, gives the exit code.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse() {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match perform(cli.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Reported) => ExitCode::FAILURE,
        Err(failure) => {
            let _ = writeln!(io::stderr(), "trikfs: {failure}");
            match matches!(failure, Failure::Crashed(_)) {
                true => ExitCode::from(GIVEN_UP),
                false => ExitCode::FAILURE,
            }
        }
    }
}

fn perform(command: Command) -> Result<(), Failure> {
    match command {
        Command::Mount(args) => run::mount(args),
        Command::Serve(args) => run::serve(args),
        Command::Isolated { daemon } => isolated::inner::run(daemon),
        Command::Check(args) => check(args),
        Command::Convert(args) => author::convert(&args),
        Command::NewConverter(args) => author::new_converter(&args),
        Command::Umount { mountpoint } => match mount::unmount(&mountpoint) {
            Ok(Unmounted::Clean) => Ok(()),
            Ok(Unmounted::Detached) => {
                let _ = writeln!(
                    io::stderr(),
                    "trikfs: {} was in use and has been detached",
                    mountpoint.display()
                );
                Ok(())
            }
            Err(error) => Err(error.into()),
        },
        Command::Edit { mountpoint } => edit::edit(&mountpoint),
        #[cfg(feature = "manual")]
        Command::Completions { shell } => print(&manual::completions(shell)),
        #[cfg(feature = "manual")]
        Command::Man { command } => print(&manual::page(command.as_deref())?),
    }
}

fn check(args: CheckArgs) -> Result<(), Failure> {
    let paths = args.search.paths()?;
    let warnings = match crate::check::check(&args.file, &paths, &progress) {
        Ok(warnings) => warnings,
        Err(problem) => {
            // Without the name of the program, so that editors find the place.
            let _ = writeln!(io::stderr(), "{problem}");
            return Err(Failure::Reported);
        }
    };
    let mut text = String::new();
    for warning in &warnings {
        let reason = format!("warning: {}", warning.reason);
        text.push_str(&format!(
            "{}\n",
            Problem {
                reason,
                ..warning.clone()
            }
        ));
    }
    let _ = io::stderr().write_all(text.as_bytes());
    print(format!("{}: good\n", args.file.display()).as_bytes())
}

/// Reports what takes long, only if a person is waiting at a terminal.
fn progress(line: &str) {
    if io::stderr().is_terminal() {
        let _ = writeln!(io::stderr(), "{line}");
    }
}

/// Standard output; a reader that stops reading is not a failure.
fn print(text: &[u8]) -> Result<(), Failure> {
    let mut out = io::stdout().lock();
    match out.write_all(text).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(Failure::system("standard output", error))
        }
        _ => Ok(()),
    }
}

/// A group by its name or number.
fn group_id(text: &str) -> Result<u32, String> {
    if let Ok(number) = text.parse() {
        return Ok(number);
    }
    match nix::unistd::Group::from_name(text) {
        Ok(Some(group)) => Ok(group.gid.as_raw()),
        Ok(None) => Err("there is no such group".to_owned()),
        Err(error) => Err(error.desc().to_lowercase()),
    }
}

impl SearchArgs {
    fn paths(&self) -> Result<SearchPaths, Failure> {
        let root = self.device_root.as_deref().map(device_root).transpose()?;
        Ok(paths::search_paths(
            self.include.clone(),
            self.cache.as_deref(),
            root,
        )?)
    }
}

impl TreeArgs {
    /// The same with paths that mean the same from everywhere.
    fn absolute(self) -> Result<Self, Failure> {
        Ok(Self {
            config: self.config.map(|path| absolute(&path)).transpose()?,
            search: SearchArgs {
                include: self
                    .search
                    .include
                    .iter()
                    .map(|path| absolute(path))
                    .collect::<Result<_, _>>()?,
                cache: self.search.cache.map(|path| absolute(&path)).transpose()?,
                device_root: self
                    .search
                    .device_root
                    .map(|path| absolute(&path))
                    .transpose()?,
            },
            ..self
        })
    }

    /// The arguments that say the same.
    fn to_arguments(&self) -> Vec<OsString> {
        let mut arguments = Vec::new();
        let mut option = |name: &str, value: &Path| {
            // In one word, so that a path that begins with a dash stays a value.
            let mut argument = OsString::from(name);
            argument.push("=");
            argument.push(value);
            arguments.push(argument);
        };
        if let Some(config) = &self.config {
            option("--config", config);
        }
        for dir in &self.search.include {
            option("--include", dir);
        }
        if let Some(cache) = &self.search.cache {
            option("--cache", cache);
        }
        if let Some(root) = &self.search.device_root {
            option("--device-root", root);
        }
        if let Some(group) = self.config_group {
            option("--config-group", Path::new(&group.to_string()));
        }
        if let Some(group) = self.group {
            option("--group", Path::new(&group.to_string()));
        }
        if let Some(name) = self.transport.to_possible_value() {
            option("--transport", Path::new(name.get_name()));
        }
        arguments.extend(self.no_sample_bus.then(|| "--no-sample-bus".into()));
        arguments.extend(self.raw.then(|| "--raw".into()));
        arguments
    }
}

/// The root of a virtual board, which must be there: a mistyped one would make every device a missing one.
fn device_root(path: &Path) -> Result<PathBuf, Failure> {
    if !path.is_dir() {
        let what = format!("--device-root {}: not a directory", path.display());
        return Err(Failure::Refused(what));
    }
    absolute(path)
}

fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    std::path::absolute(path).map_err(|error| Failure::file(path, error))
}

#[cfg(test)]
mod tests;
