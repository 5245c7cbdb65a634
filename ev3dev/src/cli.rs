//! The command line of `trikfs-ev3dev`: options, commands, and which part of the crate carries them out.
//!
//! Owns the words, the help and the exit codes: 0 success, 1 refused or failed, 2 bad command line.

use crate::failure::Failure;
use crate::keeper::{self, Handover, Plan};
use crate::scan::{Options, encoder_of};
use crate::tree::Tree;
use clap::Parser;
#[cfg(feature = "manual")]
use clap::Subcommand;
use clap::builder::{OsStringValueParser, TypedValueParser};
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Show the devices of a trikfs tree as the classes of ev3dev.
///
/// Programs written for ev3dev then find motors, sensors, lights and the battery of the tree in MOUNTPOINT as they
/// would in /sys/class. Stays in the foreground until it is unmounted or gets SIGTERM or SIGINT, and prints one line
/// when the view can be used. Motors that it drives come to rest when it ends, for whatever reason. The tree may go
/// and come back meanwhile, and need not be there at the start.
#[derive(Parser)]
#[command(name = "trikfs-ev3dev", version, max_term_width = 100, after_long_help = EXAMPLES)]
#[command(args_conflicts_with_subcommands = true, subcommand_negates_reqs = true)]
struct Cli {
    #[cfg(feature = "manual")]
    #[command(subcommand)]
    command: Option<Command>,
    /// Where the tree is mounted.
    #[arg(long, value_name = "DIR", default_value = "/trikfs")]
    tree: PathBuf,
    /// Maximum speed of motors with an encoder, in degrees per second: about 80 percent of what they
    /// reach without a load.
    #[arg(long, value_name = "NUMBER", default_value_t = 1000, value_parser = clap::value_parser!(i32).range(10..=100_000))]
    max_speed: i32,
    /// The encoder of a motor, for example M1=E3, if it is not the one with the same number; M1=none for a motor without
    /// one, which is shown as a dc-motor. May be given several times.
    #[arg(long, value_name = "MOTOR=ENCODER", value_parser = encoder_of)]
    encoder: Vec<(String, String)>,
    /// Let other users in, with the permissions that the files show.
    #[arg(long)]
    allow_other: bool,
    /// A directory; created if it does not exist, and then removed again. For one with the name of a command write ./NAME.
    #[arg(required = true, value_parser = OsStringValueParser::new().try_map(mountpoint))]
    mountpoint: Option<PathBuf>,
}

/// Commands that print something instead of mounting a view.
#[cfg(feature = "manual")]
#[derive(Subcommand)]
enum Command {
    /// Print a completion script for a shell.
    Completions {
        /// The shell.
        shell: clap_complete::Shell,
    },
    /// Print the manual page, for example: trikfs-ev3dev man | man -l -
    Man,
}

/// Commands of this program and of its siblings. They are no mount points in any build, with or without a manual.
const COMMANDS: [&str; 3] = ["completions", "help", "man"];

/// A mount point that is not a mistyped command.
fn mountpoint(word: OsString) -> Result<PathBuf, String> {
    match word.to_str().filter(|word| COMMANDS.contains(word)) {
        Some(word) if cfg!(feature = "manual") => Err(format!(
            "{word} is a command, which stands alone before all options; a directory of that name is ./{word}"
        )),
        Some(word) => Err(format!(
            "this build has no command {word}; a directory of that name is ./{word}"
        )),
        None => Ok(word.into()),
    }
}

const EXAMPLES: &str = "\
Examples:
  trikfs-ev3dev --tree /trikfs /ev3dev
  trikfs-ev3dev --encoder M1=none --encoder M2=none /ev3dev
  cat /ev3dev/tacho-motor/motor0/address
  trikfs umount /ev3dev

Exit status: 0 success; 1 refused, or something failed; 2 bad command line.";

/// The first argument of the serving process: process id of its keeper and the numbers of the mount. Not meant for
/// users, so it is not an option.
pub(crate) const SERVE: &str = "--serve=";

/// The program: reads the arguments of the process, does it, gives the exit code.
pub fn main() -> ExitCode {
    let mut words: Vec<OsString> = std::env::args_os().collect();
    let handover = words.get(1).and_then(|word| handover(word.to_str()?));
    if handover.is_some() {
        words.remove(1);
    }
    let cli = match Cli::try_parse_from(words) {
        Ok(cli) => cli,
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };
    match perform(cli, handover) {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure::Told) => ExitCode::FAILURE,
        Err(reason) => {
            let _ = writeln!(io::stderr(), "trikfs-ev3dev: {reason}");
            ExitCode::FAILURE
        }
    }
}

fn perform(cli: Cli, handover: Option<Handover>) -> Result<(), Failure> {
    #[cfg(feature = "manual")]
    if let Some(command) = &cli.command {
        return match io::stdout().write_all(&manual(command)?) {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(Failure::Output(error)),
            _ => Ok(()),
        };
    }
    let tree = absolute(&cli.tree)?;
    let mountpoint = absolute(cli.mountpoint.as_deref().unwrap_or(Path::new("")))?;
    if tree == mountpoint {
        return Err(Failure::OverItsTree(tree));
    }
    if let Some(handover) = handover {
        let options = Options {
            max_speed: cli.max_speed,
            encoders: cli.encoder.into_iter().collect(),
        };
        return keeper::serve(&tree, mountpoint, options, handover);
    }
    let plan = Plan {
        arguments: arguments(&tree, &cli),
        tree,
        mountpoint,
        allow_other: cli.allow_other,
    };
    if !Tree::new(plan.tree.clone()).is_there() {
        let _ = writeln!(io::stderr(), "trikfs-ev3dev: {}", missing_line(&plan.tree));
    }
    keeper::keep(&plan, &mut |devices| {
        let _ = writeln!(io::stdout(), "{}", ready_line(&plan, devices))
            .and_then(|()| io::stdout().flush());
    })
}

/// The arguments that say the same to the serving process.
fn arguments(tree: &Path, cli: &Cli) -> Vec<OsString> {
    // In one word, so that a path that begins with a dash stays a value.
    let mut place = OsString::from("--tree=");
    place.push(tree);
    let mut list = vec![place, format!("--max-speed={}", cli.max_speed).into()];
    for (motor, encoder) in &cli.encoder {
        let encoder = if encoder.is_empty() { "none" } else { encoder };
        list.push(format!("--encoder={motor}={encoder}").into());
    }
    list
}

/// What is printed before the view is mounted.
fn missing_line(tree: &Path) -> String {
    format!(
        "{}: no tree is mounted there; the view is empty until there is one (--tree=DIR says another place)",
        tree.display()
    )
}

fn ready_line(plan: &Plan, devices: usize) -> String {
    let shown = plan.mountpoint.display();
    match devices {
        0 => format!(
            "trikfs-ev3dev: ready on {shown}, without devices until the tree {} has some",
            plan.tree.display()
        ),
        _ => format!(
            "trikfs-ev3dev: ready on {shown} ({devices} devices); try: ls {shown}/lego-sensor"
        ),
    }
}

fn absolute(path: &Path) -> Result<PathBuf, Failure> {
    std::path::absolute(path).map_err(|error| Failure::Path(path.to_owned(), error))
}

fn handover(word: &str) -> Option<Handover> {
    let numbers = word.strip_prefix(SERVE)?.split(',').map(str::parse);
    match numbers.collect::<Result<Vec<u32>, _>>().as_deref() {
        Ok([keeper, mount, connection]) => Some(Handover {
            keeper: *keeper,
            mount: (*mount, *connection),
        }),
        _ => None,
    }
}

/// The text that is printed instead of mounting a view.
#[cfg(feature = "manual")]
fn manual(command: &Command) -> Result<Vec<u8>, Failure> {
    use clap::CommandFactory;
    let mut text = Vec::new();
    match command {
        Command::Completions { shell } => {
            clap_complete::generate(*shell, &mut Cli::command(), "trikfs-ev3dev", &mut text);
        }
        Command::Man => clap_mangen::Man::new(Cli::command())
            .render(&mut text)
            .map_err(Failure::Manual)?,
    }
    Ok(text)
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    fn parse(line: &[&str]) -> Result<Cli, clap::Error> {
        Cli::try_parse_from(std::iter::once(&"trikfs-ev3dev").chain(line))
    }

    #[test]
    fn the_definition_is_consistent_and_the_serving_process_is_told_the_same() {
        Cli::command().debug_assert();
        let cli = parse(&["--tree", "-t", "--encoder=M1=none", "--max-speed=500", "m"]);
        assert!(cli.is_err(), "a value that looks like an option");
        let cli = parse(&["--tree=-t", "--encoder=M1=none", "--max-speed=500", "m"]).unwrap();
        let words = arguments(Path::new("/-t"), &cli);
        assert_eq!(
            words,
            ["--tree=/-t", "--max-speed=500", "--encoder=M1=none"]
        );
        let found = Handover {
            keeper: 1,
            mount: (2, 3),
        };
        assert_eq!(handover("--serve=1,2,3"), Some(found));
        for word in ["--serve=1", "--serve=1,2,x", "1,2,3"] {
            assert_eq!(handover(word), None);
        }
    }

    #[test]
    fn what_makes_no_sense_is_refused_with_what_would() {
        for (line, reason) in [
            (&[] as &[&str], "MOUNTPOINT"),
            (&["--encoder=E1=E1", "m"], "there are M1, M2, M3, M4"),
            (&["--max-speed=0", "m"], "10..=100000"),
            (&["--tree=/t", "man"], "is ./man"),
            (&["--", "completions"], "is ./completions"),
        ] {
            let Err(error) = parse(line) else {
                panic!("{line:?} was understood")
            };
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(reason), "{error}");
        }
        let same = perform(parse(&["--tree=/t", "/t"]).unwrap(), None);
        assert!(same.is_err_and(|failure| matches!(failure, Failure::OverItsTree(_))));
    }

    #[cfg(feature = "manual")]
    #[test]
    fn the_manual_page_and_the_completions_know_the_options() {
        for words in [&["man"] as &[&str], &["completions", "bash"]] {
            let command = parse(words).unwrap().command.unwrap();
            let text = manual(&command).unwrap();
            let text = String::from_utf8(text).unwrap().replace('\\', "");
            assert!(
                text.contains("--encoder") && !text.contains("--serve"),
                "{text}"
            );
        }
        let cli = parse(&["./man"]).unwrap();
        assert!(cli.command.is_none() && cli.mountpoint == Some("./man".into()));
        assert!(parse(&["/m", "man"]).is_err());
    }
}
