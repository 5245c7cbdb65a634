//! What the command line of `trikd serve` can say: addresses, ports, folders, limits.
//!
//! Owns names and defaults; what they mean is known where they are used.

use crate::access::Network;
use crate::error::Error;
use crate::limits;
use crate::log::Filter;
use clap::{Args, ValueEnum};
use std::net::{IpAddr, SocketAddr};
use std::path::PathBuf;

/// A service or feature that can be turned off.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub enum Service {
    /// Messages between robots.
    Mailbox,
    /// Gamepads.
    Gamepad,
    /// Pictures of the camera.
    Video,
    /// Variables of a program for web pages.
    Variables,
    /// The answer to programs that look for robots in the network.
    Discovery,
    /// The beep after an upload and the green light after a program.
    Feedback,
}

/// The key that ends the program.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub enum StopKey {
    /// The power key.
    Power,
    /// The key Esc.
    Esc,
    /// No key.
    None,
}

/// The key that saves the black box.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub enum BoxKey {
    /// The key Up.
    Up,
    /// The key Down.
    Down,
    /// The key Left.
    Left,
    /// The key Right.
    Right,
    /// No key.
    None,
}

/// The rules by which diagrams run.
#[derive(Clone, Copy, Debug, Eq, PartialEq, ValueEnum)]
pub enum Compat {
    /// The rules of TRIK Studio, with its oddities.
    Studio,
    /// The oddities are corrected.
    Fixed,
}

impl Compat {
    /// Its name.
    pub fn name(self) -> &'static str {
        match self {
            Self::Studio => "studio",
            Self::Fixed => "fixed",
        }
    }
}

/// All of it.
#[derive(Args, Clone, Debug)]
pub struct Settings {
    /// Where the tree of the robot is mounted.
    #[arg(long, value_name = "DIR", default_value = "/trikfs")]
    pub tree: PathBuf,
    /// Directory of uploaded programs.
    #[arg(long, value_name = "DIR", default_value = "/home/root/trik/scripts")]
    pub scripts: PathBuf,
    /// Directory of what trikd keeps: the mailbox, paired computers.
    #[arg(long, value_name = "DIR", default_value = "/var/lib/trikd")]
    pub state: PathBuf,
    /// Directory of the socket and the Python module of the running trikd.
    #[arg(long, value_name = "DIR", default_value = "/run/trikd")]
    pub run: PathBuf,
    /// Address to serve at; may be given several times [default: all, IPv4 and IPv6].
    #[arg(long, value_name = "ADDRESS")]
    pub address: Vec<IpAddr>,
    /// Port of programs and output; here and below, 0 takes any free port.
    #[arg(long, value_name = "PORT", default_value_t = 8888)]
    pub control_port: u16,
    /// Port of sensor values.
    #[arg(long, value_name = "PORT", default_value_t = 9000)]
    pub telemetry_port: u16,
    /// Port of messages between robots; if it is taken, one of the next four.
    #[arg(long, value_name = "PORT", default_value_t = 8889)]
    pub mailbox_port: u16,
    /// Port of gamepads.
    #[arg(long, value_name = "PORT", default_value_t = 4444)]
    pub gamepad_port: u16,
    /// Port of pictures of the camera.
    #[arg(long, value_name = "PORT", default_value_t = 8080)]
    pub video_port: u16,
    /// Port of variables of the program, served only to this machine.
    #[arg(long, value_name = "PORT", default_value_t = 10000)]
    pub variables_port: u16,
    /// Serve a page for browsers at this port, at the first address of --address [default: none]. Programs of the robot may
    /// then use the other ports without being paired.
    #[arg(long, value_name = "PORT")]
    pub page_port: Option<u16>,
    /// Let the page replace the configuration of the tree: a converter runs as the filesystem does, as root if that is root.
    #[arg(long, requires = "page_port")]
    pub page_configures: bool,
    /// Turn this off; may be given several times.
    #[arg(long, value_name = "SERVICE", value_enum)]
    pub without: Vec<Service>,
    /// Keep the last MINUTES minutes of everything that the robot senses and does, in the folder of --box; a program that
    /// fails, a stop and a sensor that fails save them, and `trik box save` does.
    #[arg(long, value_name = "MINUTES", value_parser = clap::value_parser!(u16).range(1..=24 * 60))]
    pub box_minutes: Option<u16>,
    /// Maximum size of these minutes, in MiB; the last 8 that were saved come on top.
    #[arg(long, value_name = "MIB", default_value_t = 16, value_parser = clap::value_parser!(u16).range(1..=4096))]
    pub box_mib: u16,
    /// Folder of these minutes, on a disk or in memory [default: box in the directory of --state].
    #[arg(long = "box", value_name = "DIR")]
    pub box_dir: Option<PathBuf>,
    /// The key that saves them.
    #[arg(long, value_name = "KEY", value_enum, default_value = "none")]
    pub box_key: BoxKey,
    /// Send sensor values to this address, one JSON object in each datagram.
    #[arg(long, value_name = "ADDRESS:PORT")]
    pub udp_telemetry: Option<SocketAddr>,
    /// Milliseconds between two datagrams.
    #[arg(long, value_name = "MS", default_value_t = 50, value_parser = clap::value_parser!(u64).range(5..=60_000))]
    pub udp_period_ms: u64,
    /// The pipe that the tree reads gamepads from.
    #[arg(
        long,
        value_name = "PATH",
        default_value = "/run/gamepad-service.out.fifo"
    )]
    pub gamepad_fifo: PathBuf,
    /// Folder in which the world around a virtual robot is told, for recordings; `trik up` names it.
    #[arg(long, value_name = "DIR")]
    pub world: Option<PathBuf>,
    /// Name of the robot in the network [default: the name of the host].
    #[arg(long, value_name = "NAME")]
    pub name: Option<String>,
    /// The answer to `configVersion`: desktop programs refuse to run programs on a model other than theirs.
    #[arg(long, value_name = "TEXT", default_value = "model-2015")]
    pub config_version: String,
    /// Serve only computers with this address or in this network, such as 192.168.77.0/24; may be given several times.
    #[arg(long, value_name = "NETWORK")]
    pub allow: Vec<Network>,
    /// Accept programs only from paired computers: press Enter on the robot within 30 s of the first attempt.
    #[arg(long)]
    pub pair: bool,
    /// User whose rights programs have, when trikd is root.
    #[arg(long, value_name = "USER")]
    pub user: Option<String>,
    /// Maximum memory of one program, in MiB.
    #[arg(long, value_name = "MIB", default_value_t = limits::PROGRAM_MEMORY_MIB, value_parser = clap::value_parser!(u64).range(8..=1 << 20))]
    pub memory_mib: u64,
    /// Maximum number of processes of one program.
    #[arg(long, value_name = "NUMBER", default_value_t = limits::PROGRAM_PROCESSES, value_parser = clap::value_parser!(u64).range(1..=10_000))]
    pub processes: u64,
    /// Maximum size of an upload, in MiB.
    #[arg(long, value_name = "MIB", default_value_t = 16, value_parser = clap::value_parser!(u16).range(1..=256))]
    pub upload_mib: u16,
    /// Maximum number of connections, on all ports together.
    #[arg(long, value_name = "NUMBER", default_value_t = limits::CONNECTIONS, value_parser = clap::value_parser!(u16).range(4..=4096))]
    pub connections: u16,
    /// The key that ends the program.
    #[arg(long, value_name = "KEY", value_enum, default_value = "power")]
    pub stop_key: StopKey,
    /// Do not run autorun.js, autorun.py, autorun.qrs or autorun at the start.
    #[arg(long)]
    pub no_autorun: bool,
    /// What to log on standard error: off, error, warn, info, debug or trace, and other levels for some areas, such
    /// as warn,programs=debug; areas are clients, programs, tree and daemon.
    #[arg(long, value_name = "LEVEL", env = "TRIKD_LOG", default_value = "info")]
    pub log: Filter,
    /// Whether diagrams have the oddities of TRIK Studio, or behave as a user would expect.
    #[arg(
        long,
        value_name = "RULES",
        env = "TRIKD_COMPAT",
        value_enum,
        default_value = "studio"
    )]
    pub compat: Compat,
    /// Seconds that the block `Input` of a diagram waits for the answer of a person.
    #[arg(
        long,
        value_name = "SECONDS",
        env = "TRIKD_ANSWER_S",
        default_value_t = limits::ANSWER_S,
        value_parser = clap::value_parser!(u64).range(1..=limits::ANSWER_S_MAX)
    )]
    pub answer_s: u64,
    /// Language of messages of diagrams: English, or Russian if it begins with ru, as LANG does.
    #[arg(
        long,
        value_name = "LANGUAGE",
        env = "LANG",
        default_value = "en",
        hide_env_values = true
    )]
    pub language: String,
    /// The Python interpreter.
    #[arg(long, value_name = "PROGRAM", default_value = "python3")]
    pub python: PathBuf,
}

impl Settings {
    /// Makes paths absolute, because programs run in another directory than trikd.
    ///
    /// # Errors
    /// The current directory is gone.
    pub fn make_absolute(&mut self) -> Result<(), Error> {
        let paths = [
            &mut self.tree,
            &mut self.scripts,
            &mut self.state,
            &mut self.run,
            &mut self.gamepad_fifo,
        ];
        for path in (paths.into_iter())
            .chain(&mut self.box_dir)
            .chain(&mut self.world)
        {
            *path = std::path::absolute(&*path).map_err(|error| Error::file(path, error))?;
        }
        Ok(())
    }

    /// Where the last minutes are kept.
    pub fn box_directory(&self) -> PathBuf {
        let named = self.box_dir.clone();
        named.unwrap_or_else(|| self.state.join("box"))
    }

    /// Whether a service is wanted.
    pub fn has(&self, service: Service) -> bool {
        !self.without.contains(&service)
    }
}
