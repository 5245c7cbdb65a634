//! The command line of `trik`: what can be said, and which part of the crate does it.
//!
//! Owns the words, the help and the exit codes: 0 done, 1 refused or failed, 2 not understood, or a robot that could not
//! be reached.

pub(crate) use crate::check::CheckArgs;
use crate::check::original;
use crate::dcml::{self, Dcml};
use crate::remote::{self, Target};
use crate::{check, diagrams, fault, limits, up};
use clap::{Args, CommandFactory, Parser, Subcommand};
use lang_diagram::generate::Language;
use lang_text::problem::Locale;
use sim::body::rolling::Actuator;
use std::ffi::OsString;
use std::io::{self, Write};
use std::net::IpAddr;
use std::path::PathBuf;
use std::process::ExitCode;
use trikd::manual;

/// A whole virtual TRIK robot in one command, for a person at a PC.
#[derive(Parser)]
#[command(name = "trik", version, max_term_width = 100, after_long_help = EXAMPLES)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

const EXAMPLES: &str = "\
Examples:
  trik up                            a robot with two wheels, until Ctrl-C
  trik up --speed 2 /tmp/robot       twice as fast, its tree in /tmp/robot
  trik run square.js                 run a program on it, with its output here
  trik run square.js --robot 192.168.77.1   the same on a robot in the network
  trik send a.js b.py --robot 192.168.77.1,192.168.77.2 --run a.js
  trik stop                          end the program, all motors rest
  trik lint maze.qrs                 what is wrong with a diagram of TRIK Studio
  trik gen --lang python maze.qrs -o maze.py   the diagram as a program
  trik show maze.qrs --svg maze.svg  the diagram as a picture
  trik check maze.qrs                does it solve its task?
  trik check class/ --field hard.xml --results all.jsonl   a class, in another world
  trik fault D1 unplug               pull the plug of the distance sensor D1
  trik fault D1 --clear              and put it back
  trik fault --at /tmp/robot D1 unplug   the same, if several robots run

Exit status: 0 done; 1 refused, or something failed; 2 the command line was not understood, or a robot could not be
reached.";

#[derive(Subcommand)]
enum Command {
    /// Start a virtual robot and mount its tree of files.
    ///
    /// Needs no hardware: a virtual board stands in for the controller below the level of its buses, so the tree, its
    /// configuration and programs that use it are those of a real robot. Says in one line when the tree can be used
    /// and what to try, then shows the robot until Ctrl-C, SIGTERM, SIGHUP or an unmount. Then it brings all actuators
    /// to rest, unmounts and leaves nothing behind. Several may run side by side.
    Up(Box<UpArgs>),
    /// Run a program on a robot and show what it says.
    ///
    /// Sends the file, runs it, and ends when it has ended. What it prints goes to standard output, errors to standard
    /// error. NAME.py is Python, NAME.js JavaScript, what begins with #! or is an ELF file is executed on the robot.
    /// Another program that runs there ends first. Ctrl-C stops the program on the robot; a second one does not wait.
    ///
    /// Exit status: 0 the program has ended; 1 it has failed, or was stopped; 2 it could not be run, or the connection
    /// was lost.
    Run(RunArgs),
    /// End the program of a robot, and bring everything to rest.
    ///
    /// Several robots are stopped at once. Exit status: 0 all rest; 1 a robot does not say so; 2 one could not be
    /// reached.
    Stop(FleetArgs),
    /// Send files to robots, to all at once, and perhaps run one of them there.
    ///
    /// Tells the progress of each, and at the end in a table who has got everything. A program that is started goes on.
    ///
    /// Exit status: 0 all robots have got everything; 1 one has not.
    Send(SendArgs),
    /// Show what runs on a robot, and how the last program ended.
    Status(FleetArgs),
    /// Break a device of a running virtual robot, or mend it.
    ///
    /// Programs see what they would see with a real device that fails so. Without a MOUNTPOINT it is the only robot
    /// that runs.
    Fault(FaultArgs),
    /// Write a diagram of TRIK Studio as a program in a language with text.
    ///
    /// The program does what the diagram does, and goes to standard output, or into a new file with -o. Notes go to
    /// standard error, for example that blocks had to be written twice because arrows cross.
    ///
    /// Exit status: 0 written; 1 the diagram has errors, or cannot be written in this language, or the file is there
    /// already; 2 the diagram cannot be read, or the command line was not understood.
    Gen(GenArgs),
    /// Show a diagram of TRIK Studio as sentences, or as a picture.
    ///
    /// Exit status: 0 shown; 1 it is not clear what the diagram does, there is no diagram with this name, or the picture
    /// could not be written; 2 the diagram cannot be read, or the command line was not understood.
    Show(ShowArgs),
    /// Find everything that is wrong with diagrams of TRIK Studio, without running them.
    ///
    /// A line for each problem: file, how bad, diagram, block and its place on the sheet in px, property, line and column
    /// in its text, what is wrong. The worst come first. The last line counts them.
    ///
    /// Exit status: 0 no errors, perhaps warnings and notes; 1 errors; 2 a diagram cannot be read, or the command line
    /// was not understood.
    Lint(LintArgs),
    /// Run solutions of tasks in virtual time and judge them.
    ///
    /// A solution is a diagram of TRIK Studio in a file NAME.qrs, with a world in it and rules that say what the task is;
    /// --field puts it into other worlds. The world is simulated as TRIK Studio does it, much faster than real time, and
    /// the same run always ends in the same way. One run tells its messages, several make a table. A directory stands for
    /// all solutions below it, which are done on all cores; a run that crashes or hangs harms no other.
    ///
    /// Exit status: 0 all tasks were accomplished, or there were no rules and no errors; 1 one was not; 2 a solution could
    /// not be run or judged, or the command line was not understood.
    Check(Box<CheckArgs>),
    /// Robots as equations: models in the Differential Constraints Modeling Language.
    Dcml {
        /// What to do.
        #[command(subcommand)]
        command: Dcml,
    },
    /// Run as TRIK Studio's program 2D-model, with its options, for graders that call it.
    #[command(name = "2d-model", disable_help_flag = true)]
    Model {
        /// Options and save, as for 2D-model; see --help.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
    /// Change a save as TRIK Studio's program patcher, with its options, for graders that call it.
    #[command(name = "patcher", disable_help_flag = true)]
    Patcher {
        /// Options and save, as for patcher; see --help.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
    /// Print a completion script for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page, of the program or of one command, for example: trik man up | man -l -
    Man {
        /// The command.
        command: Option<String>,
    },
    /// A process that serves a mount of a robot: ends with its parent.
    #[command(hide = true)]
    Tree {
        /// Process id of the parent.
        parent: u32,
        /// Under which name this program is started.
        name: String,
        /// Its arguments.
        #[arg(trailing_var_arg = true, allow_hyphen_values = true)]
        arguments: Vec<OsString>,
    },
}

/// What `trik up` can be told.
#[derive(Args, Clone, Debug, PartialEq)]
pub(crate) struct UpArgs {
    /// Which robot: its body in the simulator, and its configuration robots/NAME.lua; or a model of DCML that moves the
    /// usual body, FILE.dcml or the name of a shipped one.
    #[arg(long, value_name = "NAME|FILE.dcml", default_value = up::DEFAULT_ROBOT, value_parser = up::robot_name)]
    pub robot: String,
    /// Which model, if the file has several.
    #[arg(long, value_name = "NAME")]
    pub model: Option<String>,
    /// Numbers for the parameters of the model.
    #[arg(long, value_name = "NAME=NUMBER", value_delimiter = ',', value_parser = up::number_of)]
    pub params: Vec<(String, f64)>,
    /// What drives the actions of the model: u_l=M3 is the speed of the motor in rad/s, steer=S1 the angle of the servo in
    /// rad to the left, v=M3*0.028 so many times as much [default: what the model says of its actions].
    #[arg(long, value_name = "ACTION=PORT", value_delimiter = ',', value_parser = up::driven)]
    pub drive: Vec<(String, Actuator)>,
    /// States of the model that do not begin with 0.
    #[arg(long, value_name = "STATE=NUMBER", value_delimiter = ',', value_parser = up::number_of)]
    pub start: Vec<(String, f64)>,
    /// A world of TRIK Studio in the place of the robot's own: FILE.xml, or a project FILE.qrs with a world in it. The robot
    /// stands where the world has it, and has the wheels and sensors that are plugged in there.
    #[arg(long, value_name = "FILE", conflicts_with = "robot")]
    pub world: Option<PathBuf>,
    /// Configuration in the place of the robot's own.
    #[arg(long, value_name = "FILE")]
    pub config: Option<PathBuf>,
    /// How fast simulated time runs, from 0.1 to 20 times real time. Programs see their own clock, so at 2 the robot
    /// moves twice as far in a second of theirs.
    #[arg(long, value_name = "FACTOR", default_value_t = 1.0, value_parser = speed)]
    pub speed: f64,
    /// Seed of everything that is random: noise of sensors, faults. The same seed gives the same noise.
    #[arg(long, value_name = "NUMBER", default_value_t = 1)]
    pub seed: u64,
    /// Do not show the robot, also on a terminal.
    #[arg(long)]
    pub no_view: bool,
    /// Directory for files that configurations include, before /etc/trikfs; may be given several times.
    #[arg(long, value_name = "DIR")]
    pub include: Vec<PathBuf>,
    /// Private directory for compiled C and copies of libraries [default: as for trikfs].
    #[arg(long, value_name = "DIR")]
    pub cache: Option<PathBuf>,
    /// Let other users in, and let members of this group write what you may write of each node, as `trikfs mount
    /// --allow-other --group GROUP` does.
    #[arg(long, value_name = "GROUP")]
    pub group: Option<String>,
    /// Mount the devices of the robot a second time as the classes of ev3dev, for programs that know those [default: the
    /// mount point of the robot with .ev3dev behind its name].
    #[arg(long, value_name = "DIR", num_args = 0..=1, require_equals = true)]
    pub ev3dev: Option<Option<PathBuf>>,
    /// Do not start trikd: no TRIK Studio, no gamepad and no `trik run` reaches the robot.
    #[arg(long, conflicts_with_all = ["trikd_address", "trikd_ports", "scripts"])]
    pub no_trikd: bool,
    /// Address at which trikd serves; may be given several times. With one that others reach, 0.0.0.0 for all, they run
    /// programs with your rights [default: 127.0.0.1; for robot-2 127.0.0.2 and so on].
    #[arg(long, value_name = "ADDRESS")]
    pub trikd_address: Vec<IpAddr>,
    /// First of the ports of trikd: programs, sensors, gamepads, pictures, variables, mailbox are in a row from there; 0
    /// takes any free ones [default: 8888, 9000, 4444, 8080, 10000, 8889, which TRIK Studio knows].
    #[arg(long, value_name = "PORT")]
    pub trikd_ports: Option<u16>,
    /// Where uploaded programs are kept [default: a directory that goes with the robot].
    #[arg(long, value_name = "DIR")]
    pub scripts: Option<PathBuf>,
    /// An empty directory; made if nothing is there, and removed again [default: robot, or else robot-2 and so on, in
    /// $XDG_RUNTIME_DIR/trik or /tmp/trik-UID].
    pub mountpoint: Option<PathBuf>,
}

/// What `trik run` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct RunArgs {
    /// The program.
    pub file: PathBuf,
    /// Name or address of the robot, and its port if that is not 8888 [default: the virtual robot that runs on this
    /// computer, or else 127.0.0.1].
    #[arg(long, value_name = "HOST[:PORT]", value_parser = remote::target)]
    pub robot: Option<Target>,
}

/// What `trik stop` and `trik status` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct FleetArgs {
    /// Names or addresses of robots [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "HOST[:PORT]", value_parser = remote::target, value_delimiter = ',')]
    pub robot: Vec<Target>,
}

/// What `trik send` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct SendArgs {
    /// Programs, and files that they need.
    #[arg(required = true)]
    pub files: Vec<PathBuf>,
    /// Names or addresses of robots [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "HOST[:PORT]", value_parser = remote::target, value_delimiter = ',')]
    pub robot: Vec<Target>,
    /// Run this program when all files are there.
    #[arg(long, value_name = "NAME")]
    pub run: Option<String>,
}

/// What `trik fault` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct FaultArgs {
    /// The robot that is mounted there; needed when several run.
    #[arg(long, value_name = "MOUNTPOINT")]
    pub at: Option<PathBuf>,
    /// Print the devices, the kinds of faults, and the faults in force.
    #[arg(long, conflicts_with_all = ["device", "kind", "clear"])]
    pub list: bool,
    /// Mend the device.
    #[arg(long, requires = "device", conflicts_with = "kind")]
    pub clear: bool,
    /// The device, for example msp430, A1, D1, gyroscope; see --list.
    #[arg(required_unless_present = "list")]
    pub device: Option<String>,
    /// What happens to it, with its numbers, for example: unplug; nack 0.5; slow 20.
    #[arg(required_unless_present_any = ["list", "clear"], num_args = 1.., allow_negative_numbers = true)]
    pub kind: Vec<String>,
}

/// What `trik gen` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct GenArgs {
    /// The diagram, a file NAME.qrs.
    pub file: PathBuf,
    /// The language: python, javascript, lua, c, pascal or fsharp.
    #[arg(long, value_name = "LANGUAGE", value_parser = diagrams::language)]
    pub lang: Language,
    /// A new file for the program; - is standard output.
    #[arg(short, long, value_name = "OUT")]
    pub output: Option<PathBuf>,
    /// Replace OUT if it is there already.
    #[arg(long, requires = "output")]
    pub force: bool,
    /// Write arrows that cross as goto and not as copies of blocks: in C and Lua.
    #[arg(long)]
    pub goto: bool,
    /// Language of messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = diagrams::locale)]
    pub language: Locale,
}

/// What `trik show` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct ShowArgs {
    /// The diagram, a file NAME.qrs.
    pub file: PathBuf,
    /// Write a picture into a new file; - is standard output.
    #[arg(long, value_name = "OUT.svg")]
    pub svg: Option<PathBuf>,
    /// Print the program as sentences, as without this option.
    #[arg(long, conflicts_with = "svg")]
    pub text: bool,
    /// The diagram with this name in the file [default: the main one]. Sentences are those of the diagram and of the
    /// subprograms that it calls.
    #[arg(long, value_name = "NAME")]
    pub diagram: Option<String>,
    /// Replace OUT.svg if it is there already.
    #[arg(long, requires = "svg")]
    pub force: bool,
    /// Language of sentences and messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = diagrams::locale)]
    pub language: Locale,
}

/// What `trik lint` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct LintArgs {
    /// Diagrams, files NAME.qrs.
    #[arg(required = true, value_name = "FILE")]
    pub files: Vec<PathBuf>,
    /// Language of messages: en or ru.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = diagrams::locale)]
    pub language: Locale,
    /// Write the diagram into this new file, with blocks and links put back that are in the file but on no sheet, and
    /// look at that. For one FILE.
    #[arg(long, value_name = "OUT.qrs")]
    pub recover: Option<PathBuf>,
    /// Replace OUT.qrs if it is there already.
    #[arg(long, requires = "recover")]
    pub force: bool,
}

/// The program: reads the arguments of the process, does it, gives the exit code.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse().and_then(understood) {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match perform(cli.command) {
        Ok(code) => code,
        Err(reason) => {
            // Empty if another process has told it.
            if !reason.is_empty() {
                let _ = writeln!(io::stderr(), "trik: {reason}");
            }
            ExitCode::FAILURE
        }
    }
}

/// Whether a program's name is one of TRIK Studio's that this program stands in for.
pub fn is_of_studio(name: &str) -> bool {
    original::is_model(name) || original::is_patcher(name)
}

/// Such a program, with the arguments of the process.
pub fn of_studio(name: &str) -> ExitCode {
    let arguments = std::env::args_os().skip(1);
    if original::is_model(name) {
        original::model(arguments)
    } else {
        original::patcher(arguments)
    }
}

/// What clap cannot say of a command line.
fn understood(cli: Cli) -> Result<Cli, clap::Error> {
    match &cli.command {
        Command::Lint(args) if args.recover.is_some() && args.files.len() > 1 => {
            let why = "--recover writes one file: name one FILE";
            Err(Cli::command().error(clap::error::ErrorKind::TooManyValues, why))
        }
        _ => Ok(cli),
    }
}

fn perform(command: Command) -> Result<ExitCode, String> {
    let done = match command {
        Command::Run(args) => return Ok(remote::run(&args)),
        Command::Stop(args) => return Ok(remote::stop(&args)),
        Command::Status(args) => return Ok(remote::status(&args)),
        Command::Gen(args) => return Ok(diagrams::generate(&args)),
        Command::Show(args) => return Ok(diagrams::show(&args)),
        Command::Lint(args) => return Ok(diagrams::lint(&args)),
        Command::Check(args) => return Ok(check::check(&args)),
        Command::Dcml { command } => return Ok(dcml::perform(&command)),
        Command::Model { arguments } => return Ok(original::model(arguments.into_iter())),
        Command::Patcher { arguments } => return Ok(original::patcher(arguments.into_iter())),
        Command::Send(args) => remote::send(&args),
        Command::Up(args) => up::up(*args),
        Command::Fault(args) => print(fault::fault(&args)?.as_bytes()),
        Command::Completions { shell } => print(&manual::completions(shell, Cli::command())),
        Command::Man { command } => print(&manual::page(command.as_deref(), Cli::command())?),
        Command::Tree {
            parent,
            name,
            arguments,
        } => Err(up::tree::become_program(parent, &name, &arguments)),
    };
    done.map(|()| ExitCode::SUCCESS)
}

/// Standard output; a reader that has seen enough is no failure.
fn print(text: &[u8]) -> Result<(), String> {
    let mut out = io::stdout().lock();
    match out.write_all(text).and_then(|()| out.flush()) {
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
            Err(format!("standard output: {error}"))
        }
        _ => Ok(()),
    }
}

fn speed(text: &str) -> Result<f64, String> {
    let (min, max) = (limits::SPEED_MIN, limits::SPEED_MAX);
    text.parse()
        .ok()
        .filter(|speed| (min..=max).contains(speed))
        .ok_or_else(|| format!("not a number from {min} to {max}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parse(line: &[&str]) -> Result<Command, clap::Error> {
        Cli::try_parse_from(std::iter::once(&"trik").chain(line)).map(|cli| cli.command)
    }

    fn refusal(line: &[&str]) -> String {
        match parse(line) {
            Err(error) if error.exit_code() == 2 => error.to_string(),
            Err(error) => panic!("{line:?}: {error}"),
            Ok(_) => panic!("{line:?} was understood"),
        }
    }

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn up_takes_all_its_options_and_none() {
        let Ok(Command::Up(plain)) = parse(&["up"]) else {
            panic!("not understood")
        };
        assert_eq!(
            (plain.robot.as_str(), plain.speed, plain.mountpoint),
            ("two-wheels", 1.0, None)
        );
        let line = "up --robot two-wheels --speed 2 --seed 7 --config c.lua --no-view --include i --group g /m";
        let words: Vec<&str> = line.split(' ').collect();
        let Ok(Command::Up(args)) = parse(&words) else {
            panic!("not understood")
        };
        assert_eq!((args.speed, args.seed, args.no_view), (2.0, 7, true));
        assert_eq!((args.mountpoint, args.ev3dev), (Some("/m".into()), None));
        assert_eq!(args.group.as_deref(), Some("g"));
        for (words, dir) in [
            (&["up", "--ev3dev", "m"] as &[&str], None),
            (&["up", "--ev3dev=e", "m"], Some("e".into())),
        ] {
            let Ok(Command::Up(args)) = parse(words) else {
                panic!("not understood")
            };
            assert_eq!(args.ev3dev, Some(dir));
            assert_eq!(args.mountpoint, Some("m".into()));
        }
    }

    #[test]
    fn a_speed_out_of_range_and_an_unknown_robot_are_refused_with_what_is_possible() {
        for speed in ["0", "-1", "21", "nan", "inf", "fast"] {
            let text = refusal(&["up", &format!("--speed={speed}")]);
            assert!(text.contains("not a number from 0.1 to 20"), "{text}");
        }
        let text = refusal(&["up", "--robot=tank"]);
        assert!(
            text.contains("there is no such robot; there are ") && text.contains("two-wheels"),
            "{text}"
        );
    }

    #[test]
    fn a_fault_has_a_device_and_a_kind_or_asks_for_the_list() {
        let Ok(Command::Fault(args)) = parse(&["fault", "D1", "noise", "-2"]) else {
            panic!("not understood")
        };
        assert_eq!(args.kind, ["noise", "-2"]);
        assert!(parse(&["fault", "--list"]).is_ok());
        assert!(parse(&["fault", "D1", "--clear"]).is_ok());
        for line in [
            &["fault"] as &[&str],
            &["fault", "D1"],
            &["fault", "--clear"],
            &["fault", "--list", "D1", "unplug"],
            &["fault", "D1", "unplug", "--clear"],
        ] {
            refusal(line);
        }
    }

    #[test]
    fn every_command_but_the_hidden_one_has_a_manual_page() {
        for name in [
            "up",
            "run",
            "stop",
            "send",
            "status",
            "fault",
            "gen",
            "show",
            "lint",
            "check",
            "2d-model",
            "man",
            "completions",
        ] {
            let page = manual::page(Some(name), Cli::command()).expect(name);
            assert!(String::from_utf8_lossy(&page).contains(name));
        }
        assert!(manual::page(Some("tree"), Cli::command()).is_err());
        let script = manual::completions(clap_complete::Shell::Bash, Cli::command());
        assert!(String::from_utf8_lossy(&script).contains("--no-view"));
    }
}
