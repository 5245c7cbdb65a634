//! The command line of `trik`: the commands and options, and which part of the crate does each.
//!
//! Owns the words, the help and the exit codes: 0 done, 1 refused or failed, 2 not understood, or a robot that could not
//! be reached.

use crate::check::{self, of_misuse, original};
use crate::dcml::{self, Dcml};
use crate::output::standard;
use crate::refusal::{Refusal, end};
use crate::{
    bridges, class, dap, debug, diagrams, fault, grade, record, recording, remote, replay, site,
    task, up,
};
use clap::{CommandFactory, Parser, Subcommand};
use std::ffi::OsString;
use std::process::ExitCode;
use trikd::manual;

/// Virtual TRIK robots, programs on robots, diagrams, tasks and models, on a PC.
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
  trik class page --class room.txt   a page with all robots of a class
  trik stop                          end the program, bring all motors to rest
  trik lint maze.qrs                 what is wrong with a diagram of TRIK Studio
  trik gen --lang python maze.qrs -o maze.py   the diagram as a program
  trik show maze.qrs --svg maze.svg  the diagram as a picture
  trik lint maze.xml                 what is wrong with a world and its rules
  trik new-task maze                 a world with rules, and solutions, to change
  trik site OUT --task maze.qrs      a page in which pupils draw a solution and have it judged
  trik check maze.qrs                does it solve its task?
  trik check class/ --field hard.xml --results all.jsonl   a class, in another world
  trik debug maze.qrs                stop its diagram, step, and go back
  trik record -o run.mcap            record everything that the robot gives
  trik box save -o before.mcap       the last minutes of a robot, after something has happened
  trik replay run.mcap               and make the same tree of it
  trik export run.mcap -o run.csv    or a table
  trik plot run.mcap sensors motors/M1 -o run.svg   or a picture
  trik fault D1 unplug               pull the plug of the distance sensor D1
  trik fault D1 --clear              and put it back
  trik fault --robot /tmp/robot D1 unplug   the same, if several robots run

Exit status: 0 success; 1 refused, or something failed; 2 bad command line, or a robot could not be
reached.";

/// What can be done with a black box.
#[derive(Subcommand)]
enum BoxCommand {
    /// Save the last minutes of a robot in a file here.
    ///
    /// The robot keeps them as well, with those that it has saved by itself: when a program failed, everything was stopped,
    /// or a sensor failed. A robot keeps none unless its trikd is told to by --box-minutes; trik up does.
    ///
    /// Exit status: 0 saved; 1 the robot keeps none, or the file cannot be written; 2 the robot could not be reached.
    Save(remote::recorded::SaveArgs),
}

#[derive(Subcommand)]
enum Command {
    /// Start a virtual robot and mount its tree of files.
    ///
    /// Needs no hardware: a virtual board replaces the controller below the level of its buses, so the tree, its
    /// configuration and programs that use it are those of a real robot. Prints one line when the tree can be used,
    /// and what to try, then shows the robot until Ctrl-C, SIGTERM, SIGHUP or an unmount. Then it brings all actuators
    /// to rest, unmounts and leaves nothing behind. Several may run side by side.
    ///
    /// Exit status: 0 you have ended it; 1 it could not be started, or something of it has failed; 2 the command line was not
    /// understood.
    Up(Box<up::args::UpArgs>),
    /// Run a program on a robot and show what it prints.
    ///
    /// Sends the file, runs it, and ends when it has ended. What it prints goes to standard output, errors to standard
    /// error. NAME.py is Python, NAME.js JavaScript, NAME.lua Lua, NAME.qrs a diagram of TRIK Studio, NAME.flow a data-flow
    /// program; a file that begins with #! or an ELF file is executed on the robot. Another program that runs there is ended
    /// first. Ctrl-C stops the program on the robot; a second one does not wait. With --watch each save of a diagram changes
    /// the one that runs, and motors do not stop.
    ///
    /// Exit status: 0 the program has ended; 1 it has failed, or was stopped; 2 it could not be run, or the connection
    /// was lost.
    Run(remote::run::RunArgs),
    /// Assign a variable of the diagram that runs on a robot.
    ///
    /// The value is an expression as in a block, and has the type that the variable has.
    ///
    /// Exit status: 0 it is assigned; 1 it is refused, or no diagram runs; 2 the robot could not be reached, or does not
    /// answer.
    Set(remote::live::SetArgs),
    /// Show where the diagram that runs on a robot is, and what its variables hold.
    ///
    /// In a terminal a picture, with the last values of each number; elsewhere a line for each change. It only looks, and
    /// any client may do so, also while another one is in control.
    ///
    /// Exit status: 0 the program has ended, or the time is over; 1 no diagram runs; 2 the robot could not be reached, or
    /// does not answer.
    Watch(remote::watch::WatchArgs),
    /// Let the diagram that runs on a robot run until it comes to a block, and stop there.
    ///
    /// Prints where it stands. It stays stopped, with its motors at rest, until trik step, trik continue or trik stop;
    /// trik debug --attach looks closer.
    ///
    /// Exit status: 0 it is stopped there; 1 it has ended before, or does not stop there; 2 the robot could not be reached,
    /// or the place is none.
    Break(remote::step::BreakArgs),
    /// Let the diagram that is stopped on a robot make a step; one that runs is stopped where it is.
    ///
    /// Prints where it stands. Exit status: as of trik break.
    Step(remote::step::StepArgs),
    /// Let the diagram that is stopped on a robot go on.
    ///
    /// Exit status: 0 it goes on; 2 the robot could not be reached, or no diagram runs.
    Continue(remote::step::ContinueArgs),
    /// End the program of a robot, and bring everything to rest.
    ///
    /// Several robots are stopped at once. Exit status: 0 all are at rest; 1 a robot does not say so; 2 one could not be
    /// reached.
    Stop(remote::fleet::FleetArgs),
    /// Send files to several robots at once, and optionally run one of them there.
    ///
    /// Prints the progress of each, and at the end a table of which robots have got everything. A started program goes on.
    ///
    /// Exit status: 0 all robots have got everything; 1 one has not.
    Send(remote::fleet::SendArgs),
    /// Show what runs on a robot, and how the last program ended.
    ///
    /// Exit status: 0 all robots have told it; 2 one could not be reached, or the command line was not understood.
    Status(remote::fleet::FleetArgs),
    /// The robots of a class: a page that shows them all, their list, and who is in the network.
    ///
    /// trik stop, trik status and trik send take the same file with --class.
    Class {
        /// What to do.
        #[command(subcommand)]
        command: class::ClassCommand,
    },
    /// Record what the nodes of a mounted tree give.
    ///
    /// Every sample of each node that is sampled in the background, with its own time, every failure with its reason, the lines
    /// of the log, and the configuration, into one MCAP file that tools of ROS 2 open too. The tree is read from outside, so
    /// nobody is delayed; what could not be recorded is counted. A recorder that is killed loses its last second; trik mend
    /// makes its file whole.
    ///
    /// Exit status: 0 recorded; 1 there is no tree, or the file cannot be written; 2 the command line was not understood.
    Record(record::args::RecordArgs),
    /// The black box of a robot: the last minutes of everything that it sensed and did.
    #[command(subcommand)]
    #[command(name = "box")]
    BlackBox(BoxCommand),
    /// Mount the tree of a recording: its nodes give what was recorded, when its time comes.
    ///
    /// Programs, filters and diagrams run on it as on the robot, and trikd takes them. What they write to actuators moves
    /// nothing: it is compared with what was recorded, and the first difference of each is told with its time. Keys of the
    /// terminal, or lines in a control file, stop the clock, step it, and go to another moment.
    ///
    /// Exit status: 0 you have ended it; 1 the recording cannot be replayed, or with --exit a program has written something
    /// else than was recorded; 2 the command line was not understood.
    Replay(replay::args::ReplayArgs),
    /// Show what is in a recording.
    ///
    /// How long it is, where it is from, what was lost, and how many messages each node has.
    ///
    /// Exit status: 0 shown; 1 the file is not a recording, or it is cut; 2 the command line was not understood.
    Info(recording::InfoArgs),
    /// Make a cut recording whole.
    ///
    /// A recorder that was killed, or that met a full disk, leaves a file without an end, which most programs refuse. All
    /// whole parts are kept; with the usual recorder the last second is lost.
    ///
    /// Exit status: 0 it is whole; 1 the file is not a recording, or the disk takes no more; 2 the command line was not understood.
    Mend(recording::MendArgs),
    /// Write a piece of a recording, or some of its nodes, as a recording.
    ///
    /// Configuration, facts and moments are kept. A node that gave nothing within the piece has no value there.
    ///
    /// Exit status: 0 written; 1 the recording cannot be read, nothing happens in the piece, or it cannot be written; 2 the
    /// command line was not understood.
    Cut(recording::cut::CutArgs),
    /// Write a recording as a table.
    ///
    /// Each row is a sample of one node or a failure, in the order of time; the other cells of the row are empty. The first
    /// column has seconds from the beginning, the last one failures. Cells have commas between them, and the first row has
    /// the names of the columns.
    ///
    /// Exit status: 0 written; 1 the recording cannot be read, or the table cannot be written; 2 the command line was not
    /// understood.
    Export(recording::export::ExportArgs),
    /// Draw numbers of a recording over time, as a picture in SVG.
    ///
    /// A panel for each number. A failure interrupts the line and has a red mark.
    ///
    /// Exit status: 0 drawn; 1 the recording cannot be read, has no such numbers, or the picture cannot be written; 2 the
    /// command line was not understood.
    Plot(recording::plot::PlotArgs),
    /// Serve a mounted tree for tools of other people.
    Bridge {
        /// For which tool.
        #[command(subcommand)]
        which: bridges::args::Bridge,
    },
    /// Break a device of a running virtual robot, or repair it.
    ///
    /// Programs see what they would see with a real device that fails in this way. Without --robot it is the only robot that
    /// runs.
    ///
    /// Exit status: 0 it is broken or repaired; 1 the robot refuses; 2 no robot runs, or the command line was not understood.
    Fault(fault::FaultArgs),
    /// Write a diagram or a data-flow program as a program in a textual language.
    ///
    /// The program does what the blocks do, and goes to standard output, or into a new file with -o. Notes go to
    /// standard error, for example that blocks had to be written twice because arrows cross.
    ///
    /// Exit status: 0 written; 1 the diagram has errors, or cannot be written in this language, or the file is there
    /// already; 2 the diagram cannot be read, or the command line was not understood.
    Gen(diagrams::generate::GenArgs),
    /// Show a diagram or a data-flow program as sentences, or as a picture.
    ///
    /// Exit status: 0 shown; 1 it is not clear what the diagram does, there is no diagram with this name, or the picture
    /// could not be written; 2 the diagram cannot be read, or the command line was not understood.
    Show(diagrams::show::ShowArgs),
    /// Find mistakes in diagrams, data-flow programs, worlds and their rules, without running them.
    ///
    /// A line for each problem: file, severity, diagram, block and its position on the sheet in px, property, line and column
    /// in its text, what is wrong. Of a world: file, severity, event of the rules, line and column, what is wrong, and what
    /// was probably meant. The most severe come first. The last line counts them.
    ///
    /// Exit status: 0 no errors, perhaps warnings and notes; 1 errors; 2 a file cannot be read, or the command line
    /// was not understood.
    Lint(diagrams::lint::LintArgs),
    /// Make a task that works, to be changed: a world with rules, a text for pupils, a solution, a wrong program.
    ///
    /// Prints the commands that judge it. The folder has world.xml, README.md, and both programs; the text says what to do
    /// with them.
    ///
    /// Exit status: 0 made; 1 a file of it is there already or cannot be written; 2 the command line was not understood.
    NewTask(task::NewTaskArgs),
    /// Make the studio, in which diagrams are drawn, checked and run in a browser, as files for a web server.
    ///
    /// With --task the page opens that project, and everything that is drawn in it is judged in its world. Nothing of it needs
    /// a network once it was open, and nothing is sent anywhere.
    ///
    /// Exit status: 0 made; 1 there is no built studio, or a file is there already or cannot be written; 2 the task cannot be
    /// read, or the command line was not understood.
    Site(site::SiteArgs),
    /// Run solutions of tasks in simulated time and judge them.
    ///
    /// A solution is a diagram of TRIK Studio in a file NAME.qrs, with a world in it and rules that say what the task is, or
    /// a data-flow program NAME.flow, or a program NAME.js or NAME.py; --field puts it into other worlds. The world is simulated as in TRIK Studio, much faster than real time, and
    /// the same run always ends in the same way. One run prints its messages, several make a table. A directory means
    /// all solutions below it, which run on all cores; a run that crashes or hangs does not affect the others. --grades
    /// writes the table of a class, --explain says why a run ended as it did.
    ///
    /// Exit status: 0 all tasks were accomplished, or there were no rules and no errors; 1 one was not: wrong, out of time,
    /// or an error of the program; 2 a solution is broken or could not be run or judged, a file could not be written, or
    /// the command line was not understood. With --for the exit status is that of the platform.
    Check(Box<check::CheckArgs>),
    /// Judge submissions that come from a queue, beside any number of other workers.
    ///
    /// The queue is NATS JetStream. A submission is a file for a task of --tasks, and runs as with trik check; its result is told
    /// once, whatever is killed meanwhile. One that cannot be judged is tried again, and put aside after the third time. Needs a
    /// trik that was built with --features nats.
    ///
    /// Exit status: 0 you have ended it; 1 there are no tasks, or the sandbox lacks something that is demanded; 2 the server is
    /// not reached, or the command line was not understood.
    GradeWorker(Box<grade::args::WorkerArgs>),
    /// Hand solutions in to the queue of trik grade-worker.
    ///
    /// Prints the id of each, and whether it is taken, waits already or is judged; with --wait its result. The same file for the
    /// same task has the same id, and is judged once; one that was put aside is judged anew.
    ///
    /// Exit status: 0 all are handed in; with --wait as of trik check: 0 all tasks were accomplished, 1 one was not, 2 one could
    /// not be judged or is not judged yet; 2 a file cannot be handed in, the server is not reached, or the command line was not
    /// understood.
    GradeSubmit(grade::args::SubmitArgs),
    /// Show how many submissions wait in the queue, are being judged, are judged, and are put aside.
    ///
    /// Exit status: 0 shown; 2 the server is not reached, or the command line was not understood.
    GradeStatus(grade::args::StatusArgs),
    /// Debug a diagram or a data-flow program: stop, step, look, and go back.
    ///
    /// The program runs in a simulated world and is stopped before its first block. The words are those of gdb; help shows
    /// them. Model time stands still while it is stopped. The past is kept, so that each moment of it can be looked at
    /// again: reverse-next, reverse-continue, back. Lines may also come from a file or a pipe. With --robot it runs on a
    /// robot, whose motors rest while it is stopped.
    ///
    /// Exit status: 0 you have ended it; 2 the program cannot run, or the command line was not understood.
    Debug(debug::DebugArgs),
    /// Debug programs from an editor, by the Debug Adapter Protocol.
    ///
    /// Serves one client on standard input and output, or clients on a TCP port. A launch request has program, a diagram
    /// NAME.qrs or a data-flow program NAME.flow, and may have robot, field, task, inputs, gamepad, seed, speed, language,
    /// stopOnEntry, stopAtEnd and noDebug; attach joins the program that runs on a robot. Lines are those of the program as
    /// text, which the adapter gives. A program NAME.py or NAME.js is debugged on a robot: Python by debugpy, which both
    /// computers need and which cannot be attached, and JavaScript with pauses and stops at errors alone; for them a request
    /// may have robot, language and stopOnEntry, and for Python also python, motors and the keys of debugpy.
    ///
    /// Exit status: 0 the client has ended; 2 the port cannot be had, or the command line was not understood.
    Dap(dap::DapArgs),
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
    /// Print the manual page, of the program or of one command, for example: trik man dcml plan | man -l -
    Man {
        /// The command, perhaps with the one below it.
        command: Vec<String>,
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

/// The program: reads the arguments of the process, does it, gives the exit code.
pub fn main() -> ExitCode {
    let cli = match Cli::try_parse().and_then(understood) {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            let code = u8::try_from(error.exit_code()).unwrap_or(2);
            return ExitCode::from(of_misuse(code, std::env::args_os()));
        }
    };
    end(run(cli.command))
}

/// Whether a program's name is one of TRIK Studio's that this program stands in for.
pub fn is_of_studio(name: &str) -> bool {
    original::is_model(name) || original::is_patcher(name)
}

/// Such a program, with the arguments of the process.
pub fn of_studio(name: &str) -> ExitCode {
    let arguments = std::env::args_os().skip(1);
    ExitCode::from(if original::is_model(name) {
        original::model(arguments)
    } else {
        original::patcher(arguments)
    })
}

/// What clap cannot say of a command line.
fn understood(cli: Cli) -> Result<Cli, clap::Error> {
    if let Command::Lint(args) = &cli.command
        && args.recover.is_some()
        && args.files.len() > 1
    {
        let why = "--recover writes one file: name one FILE";
        return Err(Cli::command().error(clap::error::ErrorKind::TooManyValues, why));
    }
    Ok(cli)
}

/// Does what a command says, and gives the exit code.
fn run(command: Command) -> Result<u8, Refusal> {
    match command {
        Command::Up(args) => up::run(*args),
        Command::Run(args) => Ok(remote::run::run(&args)),
        Command::Set(args) => Ok(remote::live::set(&args)),
        Command::Stop(args) => Ok(remote::fleet::stop(&args)),
        Command::Send(args) => remote::fleet::send(&args),
        Command::Status(args) => Ok(remote::fleet::status(&args)),
        Command::Class { command } => class::run(&command),
        Command::Fault(args) => fault::run(&args),
        Command::Gen(args) => diagrams::generate::run(&args),
        Command::Show(args) => diagrams::show::run(&args),
        Command::Lint(args) => diagrams::lint::run(&args),
        Command::NewTask(args) => task::run(&args),
        Command::Site(args) => site::run(&args),
        Command::Check(args) => check::run(&args),
        Command::GradeWorker(args) => grade::work(&args),
        Command::GradeSubmit(args) => grade::submit(&args),
        Command::GradeStatus(args) => grade::status(&args),
        Command::Watch(args) => remote::watch::run(&args),
        Command::Info(args) => recording::info(&args),
        Command::Mend(args) => recording::mend_file(&args),
        Command::Cut(args) => recording::cut::run(&args),
        Command::Export(args) => recording::export::run(&args),
        Command::Plot(args) => recording::plot::run(&args),
        Command::Record(args) => record::run(&args),
        Command::BlackBox(BoxCommand::Save(args)) => remote::recorded::save(&args),
        Command::Bridge { which } => bridges::run(&which),
        Command::Replay(args) => replay::run(&args),
        Command::Break(args) => remote::step::stop_at(&args),
        Command::Step(args) => remote::step::step(&args),
        Command::Continue(args) => remote::step::go_on(&args),
        Command::Debug(args) => debug::run(&args),
        Command::Dap(args) => dap::run(&args),
        Command::Dcml { command } => dcml::run(&command),
        Command::Model { arguments } => Ok(original::model(arguments.into_iter())),
        Command::Patcher { arguments } => Ok(original::patcher(arguments.into_iter())),
        Command::Completions { shell } => {
            standard(&manual::completions(shell, Cli::command())).map(|()| 0)
        }
        Command::Man { command } => standard(
            &manual::page(&command, Cli::command())
                .map_err(|error| Refusal::new(error.to_string()))?,
        )
        .map(|()| 0),
        Command::Tree {
            parent,
            name,
            arguments,
        } => Err(up::tree::become_program(parent, &name, &arguments).into()),
    }
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

    /// What `--help` says of a command and of those below it that a person is shown.
    fn help(command: &mut clap::Command) -> String {
        let mut text = format!("{}\n", command.render_long_help());
        for one in command.get_subcommands_mut() {
            if !one.is_hide_set() && one.get_name() != "help" {
                text.push_str(&format!("\n==== {}\n\n", one.get_name()));
                text.push_str(&help(one));
            }
        }
        text
    }

    #[test]
    fn help_has_these_words() {
        let mut command = Cli::command().term_width(100);
        command.build();
        insta::assert_snapshot!("help", help(&mut command));
    }

    #[test]
    fn up_takes_all_its_options_and_none() {
        let Ok(Command::Up(plain)) = parse(&["up"]) else {
            panic!("not understood")
        };
        assert_eq!(
            (plain.body.as_str(), plain.speed, plain.mountpoint),
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
        let text = refusal(&["up", "--body=tank"]);
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
    fn a_bridge_is_of_one_tree() {
        let line = ["bridge", "prometheus", "--robot", "/tmp/robot"];
        assert!(parse(&line).is_ok());
        assert!(parse(&["bridge", "prometheus", "/tmp/robot"]).is_ok());
        refusal(&[&line[..], &["/tmp/other"]].concat());
    }

    /// The words of each command that a person is shown, and of those below it.
    fn shown(command: &clap::Command, before: &[String]) -> Vec<Vec<String>> {
        let subcommands = command.get_subcommands();
        let shown = subcommands.filter(|one| !one.is_hide_set() && one.get_name() != "help");
        shown
            .flat_map(|one| {
                let words = [before, &[one.get_name().to_owned()]].concat();
                let below = self::shown(one, &words);
                std::iter::once(words).chain(below)
            })
            .collect()
    }

    #[test]
    fn every_command_but_the_hidden_one_has_a_manual_page() {
        let all = shown(&Cli::command(), &[]);
        assert!(all.len() >= 23, "{all:?}");
        for words in &all {
            let page = manual::page(words, Cli::command()).expect("a page");
            let page = String::from_utf8(page).expect("UTF-8");
            let title = format!("trik-{}", words.join("-"));
            assert!(page.contains(&title.replace('-', "\\-")), "{title}: {page}");
            assert!(page.contains(".SH DESCRIPTION"), "{title}: {page}");
        }
        let refused = |words: &[&str]| manual::page(words, Cli::command()).is_err();
        assert!(refused(&["tree"]) && refused(&["dcml", "fly"]) && refused(&["up", "up"]));
        let script = manual::completions(clap_complete::Shell::Bash, Cli::command());
        assert!(String::from_utf8_lossy(&script).contains("--no-view"));
    }

    #[test]
    fn spellings_of_before_are_understood() {
        for line in [
            &["dcml", "check", "a.dcml"] as &[&str],
            &["dcml", "gen", "--target", "c", "a.dcml"],
            &["fault", "--at", "/tmp/robot", "D1", "unplug"],
            &["export", "run.mcap", "--csv", "-o", "table"],
            &["up", "--world", "a.xml"],
            &[
                "dcml", "plan", "a.dcml", "--goal", "x=1", "--world", "a.xml",
            ],
        ] {
            assert!(parse(line).is_ok(), "{line:?}");
        }
    }
}
