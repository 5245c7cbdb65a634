//! The command line of `trikd`: commands, options, and which part of the crate carries them out.
//!
//! Owns the words, the help and the exit codes: 0 success, 1 refused or failed, 2 bad command line, 3 given up. The hidden commands are
//! what `trikd` starts itself as: each is one child process.

use crate::brick::Brick;
use crate::engine::{Engine, Failure};
use crate::error::Error;
use crate::host::Host;
use crate::log::report;
#[cfg(feature = "manual")]
use crate::manual;
use crate::program::{kill, launch::Launch};
use crate::settings::Settings;
use crate::{daemon, diagram, display, guardian, js, log, status};
#[cfg(feature = "manual")]
use clap::CommandFactory;
use clap::{Parser, Subcommand};
#[cfg(feature = "manual")]
use std::io::Write;
use std::net::IpAddr;
use std::path::PathBuf;
use std::process::ExitCode;

/// The daemon of a robot, for desktop clients, gamepads and programs.
#[derive(Parser)]
#[command(name = "trikd", version, max_term_width = 100)]
struct Cli {
    #[command(subcommand)]
    command: Command,
}

#[derive(Subcommand)]
enum Command {
    /// Serve desktop programs, gamepads and other robots until SIGTERM, SIGINT or SIGHUP.
    ///
    /// It needs a mounted tree, and waits for one if there is none. It prints one line when all ports are
    /// served. It runs as two processes: if the serving one crashes, the other brings motors to rest, ends the program and
    /// starts it again.
    Serve {
        #[command(flatten)]
        settings: Box<Settings>,
    },
    /// Show the running trikd: ports, tree, program, robots, and who is connected and in control.
    Status {
        /// The directory of the running trikd.
        #[arg(long, value_name = "DIR", default_value = "/run/trikd")]
        run: PathBuf,
    },
    /// Pair a computer with the robot, as Enter on the robot does, or give out a code that pairs one.
    Pair {
        /// The directory of the running trikd.
        #[arg(long, value_name = "DIR", default_value = "/run/trikd")]
        run: PathBuf,
        /// The address of the computer.
        #[arg(required_unless_present = "code", conflicts_with = "code")]
        address: Option<IpAddr>,
        /// Print a code: the computer on which it is typed into the page or the studio of the robot within 10 min is paired.
        #[arg(long)]
        code: bool,
    },
    /// The serving process.
    #[command(hide = true)]
    Daemon {
        /// Process id of the guardian.
        #[arg(long)]
        guardian: i32,
        /// How often it was started after crashes.
        #[arg(long)]
        restarts: u32,
        #[command(flatten)]
        settings: Box<Settings>,
    },
    /// The process that becomes a program, within its limits.
    #[command(hide = true)]
    Launch(Launch),
    /// Ends all processes of the user that runs it.
    #[command(hide = true)]
    KillUser,
    /// Draw on the display of the robot: one order on each line of standard input.
    ///
    /// The orders are line X1 Y1 X2 Y2, point X Y, rect and ellipse X Y WIDTH HEIGHT FILLED, arc X Y WIDTH HEIGHT FROM
    /// SPAN, label X Y HEIGHT TEXT, image FILE, color NAME, width PIXELS, background NAME, removelabels, smile, sadsmile,
    /// redraw, clear and hide. What was drawn is shown by redraw.
    Draw {
        /// Where the tree is mounted.
        #[arg(long, env = "TRIK_TREE", value_name = "DIR", default_value = "/trikfs")]
        tree: PathBuf,
        /// Answer each order with a line "ok COUNT" and COUNT bytes, or "error: REASON".
        #[arg(long)]
        answers: bool,
    },
    /// Run a JavaScript program in this terminal, without the daemon; motors come to rest when it ends.
    ///
    /// Without a file this is the process of one program, whose standard input is the channel to the daemon.
    Js {
        /// Where the tree is mounted.
        #[arg(long, env = "TRIK_TREE", value_name = "DIR", default_value = "/trikfs")]
        tree: PathBuf,
        /// One line of a program instead of a file; motors are left as they are when it ends.
        #[arg(long, value_name = "TEXT", hide = true, conflicts_with = "file")]
        line: Option<String>,
        /// The program.
        file: Option<PathBuf>,
    },
    /// The process of one diagram, whose standard input is the channel to the daemon.
    #[command(hide = true)]
    Diagram {
        /// Where the tree is mounted.
        #[arg(long, env = "TRIK_TREE", value_name = "DIR", default_value = "/trikfs")]
        tree: PathBuf,
    },
    /// Print a completion script for a shell.
    #[cfg(feature = "manual")]
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page, of the program or of one command, for example: trikd man serve | man -l -
    #[cfg(feature = "manual")]
    Man {
        /// The command.
        command: Option<String>,
    },
}

/// The exit code of a guardian whose serving process crashed again and again: unlike a refusal it may be tried again.
const GIVEN_UP: u8 = 3;

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
        Ok(code) => code,
        Err(reason) => {
            let is_given_up = matches!(reason, Error::Crashes(..));
            report(reason);
            match is_given_up {
                true => ExitCode::from(GIVEN_UP),
                false => ExitCode::FAILURE,
            }
        }
    }
}

fn perform(command: Command) -> Result<ExitCode, Error> {
    match command {
        Command::Serve { settings } => {
            // Behind the name of the program and `serve`.
            let arguments: Vec<_> = std::env::args_os().skip(2).collect();
            log::start(&settings.log);
            return guardian::run(&settings.tree, &arguments);
        }
        Command::Status { run } => print!("{}", status::ask(&run, "status")?),
        Command::Pair { run, address, code } => match address {
            Some(ip) if !code => print!("{}", status::ask(&run, &format!("pair {ip}"))?),
            _ => print!("{}", status::ask(&run, status::CODE)?),
        },
        Command::Daemon {
            guardian,
            restarts,
            settings,
        } => {
            guardian::follow(guardian)?;
            log::start(&settings.log);
            daemon::run(*settings, restarts)?;
        }
        Command::Launch(launch) => return Err(launch.become_program()),
        Command::KillUser => kill::own_user()?,
        Command::Draw { tree, answers } => {
            display::serve(&tree, &mut std::io::stdin().lock(), answers).map_err(Error::Display)?;
        }
        Command::Js {
            tree,
            line: Some(line),
            ..
        } => js::run_line(line, &tree).map_err(Error::Program)?,
        Command::Js {
            tree,
            file: Some(file),
            ..
        } => js::run_alone(&file, &tree).map_err(Error::Program)?,
        Command::Js { tree, .. } => return Ok(run_engine(&mut js::engine(), &tree)),
        Command::Diagram { tree } => return Ok(run_engine(&mut diagram::engine(), &tree)),
        #[cfg(feature = "manual")]
        Command::Completions { shell } => show(&manual::completions(shell, Cli::command()))?,
        #[cfg(feature = "manual")]
        Command::Man { command } => show(&manual::page(command.as_slice(), Cli::command())?)?,
    }
    Ok(ExitCode::SUCCESS)
}

/// On standard output; a reader that has seen enough is no failure.
#[cfg(feature = "manual")]
fn show(text: &[u8]) -> Result<(), Error> {
    match std::io::stdout().write_all(text) {
        Err(error) if error.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(Error::Os(error.into()))
        }
        _ => Ok(()),
    }
}

/// Runs one program of an engine in this process.
fn run_engine(engine: &mut impl Engine, tree: &std::path::Path) -> ExitCode {
    let host = match Host::from_standard_input() {
        Ok(host) => host,
        Err(error) => {
            report(format_args!(
                "standard input is no channel to the daemon ({error}): this command is for trikd itself"
            ));
            return ExitCode::FAILURE;
        }
    };
    let brick = Brick::new(tree);
    let outcome = match host.start() {
        Ok(start) => engine.run(start, &brick, &host),
        Err(error) => Err(Failure::NoStart(error.into())),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Told) => ExitCode::FAILURE,
        Err(failure) => {
            // The daemon that would show it may be gone.
            let locale = crate::diagram::of_environment();
            let _ = host.error(failure.words().in_locale(locale));
            ExitCode::FAILURE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    #[cfg(not(feature = "manual"))]
    use clap::CommandFactory;

    #[test]
    fn the_definition_is_consistent() {
        Cli::command().debug_assert();
    }

    #[cfg(feature = "manual")]
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
    fn every_command_that_is_shown_is_documented_and_has_a_page_in_the_package() {
        let document = include_str!("../../docs/user/trikd.md");
        let package = include_str!("../../cross/install/test/deb.sh").replace(';', " ");
        for one in Cli::command().get_subcommands() {
            let name = one.get_name();
            if !one.is_hide_set() {
                assert!(document.contains(&format!("`trikd {name} ")), "{name}");
                assert!(package.contains(&format!(" trikd-{name} ")), "{name}");
            }
        }
    }

    #[cfg(feature = "manual")]
    #[test]
    fn help_has_these_words() {
        let mut command = Cli::command().term_width(100);
        command.build();
        insta::assert_snapshot!("help", help(&mut command));
    }

    #[cfg(feature = "manual")]
    #[test]
    fn manual_pages_and_completions_know_the_commands_but_not_the_hidden_ones() {
        let page = |name: Option<&str>| {
            manual::page(name.as_slice(), Cli::command())
                .map(|page| String::from_utf8(page).unwrap())
        };
        assert!(page(None).unwrap().contains("trikd\\-serve(1)"));
        assert!(page(Some("serve")).unwrap().contains("control\\-port"));
        for unknown in ["launch", "daemon", "frobnicate"] {
            let said = page(Some(unknown)).unwrap_err();
            assert_eq!(said.to_string(), format!("there is no command {unknown}"));
        }
        let script = manual::completions(clap_complete::Shell::Bash, Cli::command());
        let script = String::from_utf8(script).unwrap();
        assert!(script.contains("--telemetry-port"));
    }
}
