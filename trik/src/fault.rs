//! `trik fault`: breaks and mends devices of a running board.
//!
//! Owns the way to a board and the files in which it finds its faults; what may be asked for is the board's table, and
//! what a fault does is the board's business.

use crate::error::Error;
use crate::output::standard;
use crate::place::{self, Running};
use crate::refusal::Refusal;
use crate::remote::target::tree_of;
use clap::Args;
use sim::faults::{Faults, devices};
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

/// What `trik fault` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct FaultArgs {
    /// The virtual robot: where its tree is mounted, or its address; needed if several run.
    #[arg(long, alias = "at", value_name = "ROBOT")]
    pub robot: Option<PathBuf>,
    /// Print the devices, the kinds of faults, and the faults in force.
    #[arg(long, conflicts_with_all = ["device", "kind", "clear"])]
    pub list: bool,
    /// Repair the device.
    #[arg(long, requires = "device", conflicts_with = "kind")]
    pub clear: bool,
    /// The device, for example msp430, A1, D1, gyroscope; see --list.
    #[arg(required_unless_present = "list")]
    pub device: Option<String>,
    /// What happens to it, with its numbers, for example: unplug; nack 0.5; slow 20.
    #[arg(required_unless_present_any = ["list", "clear"], num_args = 1.., allow_negative_numbers = true)]
    pub kind: Vec<String>,
}

/// Does it, and prints what was asked for.
///
/// # Errors
/// No such robot, device or kind.
pub(crate) fn run(args: &FaultArgs) -> Result<u8, Refusal> {
    standard(fault(args)?.as_bytes())?;
    Ok(0)
}

/// Does it, and gives what is to be printed.
fn fault(args: &FaultArgs) -> Result<String, Error> {
    let all = place::running()?;
    let named = args.robot.as_deref().map(tree_of).transpose()?;
    let robot = choose(all, named.as_deref());
    let Some(device) = &args.device else {
        // The table is good to know also when nothing runs.
        return Ok(table(robot.ok().as_ref()));
    };
    let text = match args.clear {
        true => String::new(),
        false => args.kind.join(" "),
    };
    check(device, &text)?;
    set(&robot?.board, device, &text)?;
    Ok(String::new())
}

/// There is such a device, and it can have such faults.
fn check(device: &str, text: &str) -> Result<(), Error> {
    let checked = Faults::default().set(device, text);
    checked.map_err(|why| Error::Refused(why.to_string()))
}

/// Makes the text the fault of a device of the board there; an empty one makes it whole.
///
/// # Errors
/// No such device or kind, or the file cannot be written.
pub(crate) fn set(board: &Path, device: &str, text: &str) -> Result<(), Error> {
    check(device, text)?;
    let faults = board.join("faults");
    put(&faults, device, text).map_err(|error| Error::file(&faults.join(device), error))
}

/// The robot that is meant.
fn choose(mut all: Vec<Running>, at: Option<&Path>) -> Result<Running, Error> {
    let points = |all: &[Running]| {
        let points: Vec<_> = all
            .iter()
            .map(|robot| robot.mountpoint.display().to_string())
            .collect();
        points.join(", ")
    };
    if let Some(at) = at {
        let path = at.canonicalize().unwrap_or_else(|_| at.to_owned());
        let found = all.iter().position(|robot| robot.mountpoint == path);
        return match found {
            Some(index) => Ok(all.swap_remove(index)),
            None if all.is_empty() => Err(none()),
            None => Err(Error::file(
                at,
                format!("no robot of yours runs there; there are {}", points(&all)),
            )),
        };
    }
    match all.len() {
        0 => Err(none()),
        1 => Ok(all.swap_remove(0)),
        _ => Err(Error::Refused(format!(
            "several robots run: say which with --robot; there are {}",
            points(&all)
        ))),
    }
}

fn none() -> Error {
    Error::Refused("no robot of yours runs: start one with trik up".to_owned())
}

/// Makes the text the fault of the device, at one stroke: the board must not see half of it.
fn put(faults: &Path, device: &str, text: &str) -> io::Result<()> {
    let path = faults.join(device);
    if text.is_empty() {
        return match fs::remove_file(path) {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ok(()),
        };
    }
    // Beside the folder, which is the board's to read, and on the same filesystem.
    let fresh = faults.with_file_name(format!(".fault-{}", std::process::id()));
    fs::write(&fresh, format!("{text}\n"))?;
    fs::rename(fresh, path)
}

/// All devices, what can happen to them and what is in force.
fn table(robot: Option<&Running>) -> String {
    let mut text = String::new();
    for (name, kinds) in devices() {
        text.push_str(&format!("{name:<14} {}\n", kinds.join(", ")));
    }
    let Some(robot) = robot else {
        return text;
    };
    for (name, _) in devices() {
        // A board whose robot has just ended has no faults.
        let now = fs::read_to_string(robot.board.join("faults").join(name)).unwrap_or_default();
        for fault in now.lines().filter(|line| !line.is_empty()) {
            text.push_str(&format!("in force: {name} {fault}\n"));
        }
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    fn robot(mountpoint: &str) -> Running {
        Running {
            mountpoint: mountpoint.into(),
            board: "/none".into(),
            trikd: None,
            page: None,
        }
    }

    #[test]
    fn the_only_robot_is_meant_and_among_several_the_named_one() {
        assert_eq!(choose(vec![], None), Err(none()));
        assert_eq!(choose(vec![robot("/a")], None), Ok(robot("/a")));
        let two = || vec![robot("/a"), robot("/b")];
        assert_eq!(
            choose(two(), None),
            Err(Error::Refused(
                "several robots run: say which with --robot; there are /a, /b".to_owned()
            ))
        );
        assert_eq!(choose(two(), Some(Path::new("/b"))), Ok(robot("/b")));
        assert_eq!(
            choose(two(), Some(Path::new("/c"))),
            Err(Error::file(
                Path::new("/c"),
                "no robot of yours runs there; there are /a, /b"
            ))
        );
    }

    #[test]
    fn the_table_names_every_device() {
        let text = table(None);
        assert!(text.contains("msp430 ") && text.contains("nack"), "{text}");
        assert!(text.lines().count() >= 20, "{text}");
    }
}
