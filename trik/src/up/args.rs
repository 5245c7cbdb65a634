//! The options of `trik up`.
//!
//! Owns the options and the forms of their values. Knows nothing of what they do.

use crate::error::Error;
use crate::language;
use crate::limits;
use clap::Args;
use lang_dcml::models;
use lang_text::problem::Locale;
use sim::body::rolling::Actuator;
use std::net::{IpAddr, SocketAddr};
use std::path::{Path, PathBuf};

/// The robot used if none is named.
pub(crate) const DEFAULT_ROBOT: &str = "two-wheels";

/// The options of `trik up`.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct UpArgs {
    /// Which robot is simulated: its body, and its configuration robots/NAME.lua; or a model of DCML that moves the usual
    /// body, FILE.dcml or the name of a shipped one.
    #[arg(long, visible_alias = "robot", value_name = "NAME|FILE.dcml", default_value = DEFAULT_ROBOT, value_parser = robot_name)]
    pub body: String,
    /// Which model, if the file has several.
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// Values for the parameters of the model.
    #[arg(long, value_name = "NAME=NUMBER", value_delimiter = ',', value_parser = number_of)]
    pub params: Vec<(String, f64)>,
    /// What drives the actions of the model: u_l=M3 is the speed of the motor in rad/s, steer=S1 the angle of the servo in
    /// rad to the left, v=M3*0.028 that speed times 0.028 [default: what the model says of its actions].
    #[arg(long, value_name = "ACTION=PORT", value_delimiter = ',', value_parser = driven)]
    pub drive: Vec<(String, Actuator)>,
    /// Initial values of states of the model that do not begin with 0.
    #[arg(long, value_name = "STATE=NUMBER", value_delimiter = ',', value_parser = number_of)]
    pub start: Vec<(String, f64)>,
    /// A world of TRIK Studio instead of the robot's own: FILE.xml, or a project FILE.qrs with a world in it. The robot
    /// is where the world puts it, and has the wheels and sensors that are plugged in there.
    #[arg(
        long = "field",
        alias = "world",
        value_name = "FILE",
        conflicts_with = "body"
    )]
    pub world: Option<PathBuf>,
    /// Configuration instead of the robot's own.
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// How fast simulated time runs, from 0.1 to 20 times real time. Programs see their own clock, so at 2 the robot
    /// moves twice as far in a second of theirs.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = speed)]
    pub speed: f64,
    /// Seed of everything that is random: noise of sensors, faults. The same seed gives the same noise.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Do not show the robot, even on a terminal.
    #[arg(long)]
    pub no_view: bool,
    /// Directory of files that configurations include, searched before /etc/trikfs; may be given several times.
    #[arg(long, value_name = "DIR")]
    pub include: Vec<PathBuf>,
    /// Private directory for compiled C and copies of libraries [default: as for trikfs].
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Let other users in, and let members of this group write what you may write of each node, as `trikfs mount
    /// --allow-other --group GROUP` does.
    #[arg(long, value_name = "GROUP")]
    pub group: Option<String>,
    /// Let trik record --raw record what devices give before it is converted, as trikfs mount --raw does.
    #[arg(long)]
    pub raw: bool,
    /// Mount the devices of the robot a second time as the classes of ev3dev, for programs written for those [default: the
    /// mount point of the robot with .ev3dev added to its name].
    #[arg(long, value_name = "DIR", num_args = 0..=1, require_equals = true)]
    pub ev3dev: Option<Option<PathBuf>>,
    #[command(flatten)]
    pub serving: ServingArgs,
    /// An empty directory; created if it does not exist, and then removed again [default: robot, or else robot-2 and so on, in
    /// $XDG_RUNTIME_DIR/trik or /tmp/trik-UID].
    pub mountpoint: Option<PathBuf>,
}

/// How trikd serves over a tree.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct ServingArgs {
    /// Do not start trikd: no TRIK Studio, no gamepad and no `trik run` reaches the robot.
    #[arg(long, conflicts_with_all = ["trikd_address", "trikd_ports", "scripts", "box_dir", "udp_telemetry", "page_port", "open"])]
    pub no_trikd: bool,
    /// Address at which trikd serves; may be given several times. If others can reach it (0.0.0.0 for all), they can run
    /// programs with your rights [default: 127.0.0.1; for robot-2 127.0.0.2 and so on].
    #[arg(long, value_name = "ADDRESS")]
    pub trikd_address: Vec<IpAddr>,
    /// First of the ports of trikd: programs, sensors, gamepads, pictures, variables, mailbox are in a row from there; 0
    /// takes any free ones [default: 8888, 9000, 4444, 8080, 10000, 8889, which TRIK Studio uses].
    #[arg(long, value_name = "PORT")]
    pub trikd_ports: Option<u16>,
    /// Minutes of everything that happens which are kept for trik box save; 0 keeps none.
    #[arg(long, value_name = "MINUTES", default_value_t = 10, value_parser = clap::value_parser!(u16).range(0..=24 * 60))]
    pub box_minutes: u16,
    /// Folder of these minutes and of what is saved of them [default: a directory that is removed with the robot].
    #[arg(long = "box", value_name = "DIR")]
    pub box_dir: Option<PathBuf>,
    /// Send the values of all nodes to this address, as JSON in datagrams; PlotJuggler listens at port 9870.
    #[arg(long, value_name = "ADDRESS:PORT")]
    pub udp_telemetry: Option<SocketAddr>,
    /// Port of the page for browsers, at the first address of trikd [default: 8000, or any free one if that is taken].
    #[arg(long, value_name = "PORT", conflicts_with = "no_page")]
    pub page_port: Option<u16>,
    /// Open the page in a browser.
    #[arg(long, conflicts_with = "no_page")]
    pub open: bool,
    /// Serve no page for browsers.
    #[arg(long)]
    pub no_page: bool,
    /// Where uploaded programs are kept [default: a directory that is removed with the robot].
    #[arg(long, value_name = "DIR")]
    pub scripts: Option<PathBuf>,
    /// Language of what the robot says of programs of blocks, and of what is wrong with a world: en or ru [default: that of
    /// LANG].
    #[arg(long, value_name = "LANGUAGE", value_parser = language::locale)]
    pub language: Option<Locale>,
}

impl ServingArgs {
    /// The language that was asked for, or that of the system.
    pub(crate) fn locale(&self) -> Locale {
        self.language.unwrap_or_else(language::of_system)
    }
}

/// The name of a robot that there is, or of a model.
fn robot_name(text: &str) -> Result<String, String> {
    match sim::robots::by_name(text) {
        Some(_) => Ok(text.to_owned()),
        None if is_model(text) => Ok(text.to_owned()),
        None => Err(format!(
            "there is no such robot; there are {}, and models FILE.dcml; {}",
            sim::robots::names().collect::<Vec<_>>().join(", "),
            models::advice(text)
        )),
    }
}

/// Whether a robot of this name is a model: a file or a shipped one.
fn is_model(text: &str) -> bool {
    text.ends_with(".dcml") || models::named(text).is_some()
}

/// `NAME=NUMBER`
fn number_of(text: &str) -> Result<(String, f64), String> {
    let (name, number) = text.split_once('=').ok_or("write NAME=NUMBER")?;
    let number = number
        .trim()
        .parse()
        .ok()
        .filter(|one: &f64| one.is_finite());
    let number = number.ok_or_else(|| format!("'{text}': a number belongs after ="))?;
    Ok((name.trim().to_owned(), number))
}

/// `ACTION=PORT`
fn driven(text: &str) -> Result<(String, Actuator), String> {
    let (name, port) = text.split_once('=').ok_or("write ACTION=PORT")?;
    let actuator = Actuator::read(port).map_err(|why| why.to_string())?;
    Ok((name.trim().to_owned(), actuator))
}

fn speed(text: &str) -> Result<f64, String> {
    let (min, max) = (limits::SPEED_MIN, limits::SPEED_MAX);
    text.parse()
        .ok()
        .filter(|speed| (min..=max).contains(speed))
        .ok_or_else(|| format!("not a number from {min} to {max}"))
}

/// A path of the command line, whatever directory this process goes to.
pub(crate) fn absolute(path: &Path) -> Result<PathBuf, Error> {
    std::path::absolute(path).map_err(|error| Error::file(path, error))
}
