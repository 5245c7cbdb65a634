//! The command line of `trikfs-ev3dev`: what can be said, and which part of the crate does it.
//!
//! Owns the words, the help and the exit codes: 0 done, 1 refused or failed, 2 not understood.

use crate::keeper::{self, Handover, Plan};
use crate::scan::{Options, encoder_of};
use clap::Parser;
use std::ffi::OsString;
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;

/// Show the devices of a trikfs tree as the classes of ev3dev.
///
/// Programs that are written for ev3dev then find motors, sensors, lights and the battery of the tree in MOUNTPOINT as they
/// would in /sys/class. Stays in the foreground until it is unmounted or gets SIGTERM or SIGINT, and says in one line
/// when the view can be used. Motors that it drives come to rest when it ends, by whatever cause. The tree may go and come
/// back meanwhile.
#[derive(Parser)]
#[command(name = "trikfs-ev3dev", version, max_term_width = 100, after_long_help = EXAMPLES)]
struct Cli {
    /// Where the tree is mounted.
    #[arg(long, value_name = "DIR", default_value = "/trikfs")]
    tree: PathBuf,
    /// Greatest speed that motors with an encoder are asked for, in degrees per second: about 80 percent of what they
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
    /// Print a completion script for a shell and end.
    #[cfg(feature = "manual")]
    #[arg(long, value_name = "SHELL", exclusive = true)]
    completions: Option<clap_complete::Shell>,
    /// Print the manual page and end, for example: trikfs-ev3dev --man | man -l -
    #[cfg(feature = "manual")]
    #[arg(long, exclusive = true)]
    man: bool,
    /// A directory; made if nothing is there.
    #[cfg_attr(feature = "manual", arg(required_unless_present_any = ["completions", "man"]))]
    #[cfg_attr(not(feature = "manual"), arg(required = true))]
    mountpoint: Option<PathBuf>,
}

const EXAMPLES: &str = "\
Examples:
  trikfs-ev3dev --tree /trikfs /ev3dev
  trikfs-ev3dev --encoder M1=none --encoder M2=none /ev3dev
  cat /ev3dev/tacho-motor/motor0/address
  trikfs umount /ev3dev

Exit status: 0 done; 1 refused, or something failed; 2 the command line was not understood.";

/// The first argument of the serving process: process id of its keeper and the numbers of the mount. Not a matter of
/// people, so it is no option.
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
        Err(reason) => {
            // Empty if another process has told it.
            if !reason.is_empty() {
                let _ = writeln!(io::stderr(), "trikfs-ev3dev: {reason}");
            }
            ExitCode::FAILURE
        }
    }
}

fn perform(cli: Cli, handover: Option<Handover>) -> Result<(), String> {
    #[cfg(feature = "manual")]
    if let Some(text) = manual(&cli)? {
        return match io::stdout().write_all(&text) {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                Err(format!("standard output: {error}"))
            }
            _ => Ok(()),
        };
    }
    let tree = absolute(&cli.tree)?;
    let mountpoint = absolute(cli.mountpoint.as_deref().unwrap_or(Path::new("")))?;
    if tree == mountpoint {
        return Err(format!(
            "{}: the view cannot be mounted over its own tree",
            tree.display()
        ));
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

fn ready_line(plan: &Plan, devices: usize) -> String {
    let shown = plan.mountpoint.display();
    match devices {
        0 => format!(
            "trikfs-ev3dev: ready on {shown}; there is no tree at {} yet",
            plan.tree.display()
        ),
        _ => format!(
            "trikfs-ev3dev: ready on {shown} ({devices} devices); try: ls {shown}/lego-sensor"
        ),
    }
}

fn absolute(path: &Path) -> Result<PathBuf, String> {
    std::path::absolute(path).map_err(|error| format!("{}: {error}", path.display()))
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

/// The text that was asked for instead of a view.
#[cfg(feature = "manual")]
fn manual(cli: &Cli) -> Result<Option<Vec<u8>>, String> {
    use clap::CommandFactory;
    let mut text = Vec::new();
    if let Some(shell) = cli.completions {
        clap_complete::generate(shell, &mut Cli::command(), "trikfs-ev3dev", &mut text);
        return Ok(Some(text));
    }
    if cli.man {
        clap_mangen::Man::new(Cli::command())
            .render(&mut text)
            .map_err(|error| error.to_string())?;
        return Ok(Some(text));
    }
    Ok(None)
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
        ] {
            let Err(error) = parse(line) else {
                panic!("{line:?} was understood")
            };
            assert_eq!(error.exit_code(), 2);
            assert!(error.to_string().contains(reason), "{error}");
        }
        let same = perform(parse(&["--tree=/t", "/t"]).unwrap(), None);
        assert!(same.unwrap_err().contains("over its own tree"));
    }

    #[cfg(feature = "manual")]
    #[test]
    fn the_manual_page_and_the_completions_know_the_options() {
        for words in [["--man"], ["--completions=bash"]] {
            let text = manual(&parse(&words).unwrap()).unwrap().unwrap();
            let text = String::from_utf8(text).unwrap().replace('\\', "");
            assert!(
                text.contains("--encoder") && !text.contains("--serve"),
                "{text}"
            );
        }
    }
}
