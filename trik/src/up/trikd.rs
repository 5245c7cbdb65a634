//! trikd beside the tree, so that TRIK Studio and gamepads reach the virtual robot as they reach a real one.
//!
//! Owns where it serves, where its folders are, and what a person is told of it; `companion` is its life. It serves this
//! machine alone unless somebody names other addresses, because a client that reaches it runs programs with the rights of the
//! person who started the robot.

use super::args::{ServingArgs, absolute};
use super::companion::Companion;
use super::telling;
use crate::error::Error;
use crate::limits;
use crate::place::Place;
use nix::unistd::{User, geteuid};
use std::ffi::{OsStr, OsString};
use std::net::{IpAddr, Ipv4Addr, SocketAddr};
use std::path::{Path, PathBuf};

/// The port that TRIK Studio connects to.
pub(super) const CONTROL_PORT: u16 = 8888;
/// What trikd says when it serves.
const READY: &str = "trikd: ready: ";
/// What trikd advises to who starts it alone.
const ADVICE: &str = ", or take another port with --";

/// trikd of one robot.
pub(crate) struct Trikd {
    pub(super) process: Companion,
    /// Where uploaded programs are.
    pub(super) scripts: PathBuf,
    /// The first address at which it serves.
    bound: IpAddr,
}

impl Trikd {
    /// For the robot at this place. It does not run yet.
    ///
    /// # Errors
    /// The ports that are wanted do not exist.
    pub(crate) fn of(args: &ServingArgs, place: &Place) -> Result<Self, Error> {
        let addresses = match &args.trikd_address[..] {
            [] => vec![own_address(place.number)],
            named => named.to_vec(),
        };
        let scripts = match &args.scripts {
            Some(path) => absolute(path)?,
            None => place.trikd.join("scripts"),
        };
        let mut list: Vec<OsString> = vec!["serve".into()];
        let mut option = |name: &str, value: &Path| {
            let mut argument = OsString::from(name);
            argument.push("=");
            argument.push(value);
            list.push(argument);
        };
        option("--tree", &place.mountpoint);
        option("--scripts", &scripts);
        option("--state", &place.trikd.join("state"));
        option("--run", &place.trikd.join("run"));
        let fifo = place.board.join("run/gamepad-service.out.fifo");
        option("--gamepad-fifo", &fifo);
        option("--world", &telling::folder(&place.board));
        list.extend(addresses.iter().map(|ip| format!("--address={ip}").into()));
        // Who comes and goes is no news for the person in front of the robot, unless it is asked for.
        if std::env::var_os("TRIKD_LOG").is_none() {
            list.push("--log=info,clients=warn".into());
        }
        list.push(format!("--language={}", args.locale().name()).into());
        if args.box_minutes > 0 {
            list.push(format!("--box-minutes={}", args.box_minutes).into());
            list.push(format!("--box-mib={}", limits::BOX_MIB).into());
        }
        if let Some(path) = &args.box_dir {
            let mut argument = OsString::from("--box=");
            argument.push(absolute(path)?);
            list.push(argument);
        }
        if let Some(to) = args.udp_telemetry {
            list.push(format!("--udp-telemetry={to}").into());
        }
        if addresses.iter().all(IpAddr::is_loopback) {
            // Nobody else could connect.
            list.push("--without=discovery".into());
        }
        if let Some(first) = args.trikd_ports {
            list.extend(ports(first)?.map(OsString::from));
        }
        if geteuid().is_root()
            && let Ok(Some(user)) = User::from_uid(geteuid())
        {
            // Programs have the rights of the person who started the robot, whichever that is.
            list.push(format!("--user={}", user.name).into());
        }
        Ok(Self {
            process: Companion::new("trikd", "trikd", READY, list),
            scripts,
            bound: addresses[0],
        })
    }

    /// The first address at which it serves.
    pub(super) fn bound(&self) -> IpAddr {
        self.bound
    }

    /// Starts it and waits until it serves.
    ///
    /// # Errors
    /// One line: why it does not run, and what to do.
    pub(super) fn start(&mut self) -> Result<(), Error> {
        self.process.start().map_err(|error| {
            let reason = error.to_string();
            let reason = reason.split(ADVICE).next().unwrap_or_default();
            let reason = reason.replace("trikd: ", "").replace('\n', "; ");
            Error::Process(format!(
                "{reason}; or start the robot with other ports, --trikd-ports=18888, or without trikd, --no-trikd. The robot itself runs"
            ))
        })
    }

    /// Where programs are uploaded, if it has told that since the last call: the ports of a new start may be others.
    pub(super) fn take_address(&mut self) -> Option<SocketAddr> {
        let line = self.process.take_ready_line()?;
        let words = line.split_once(READY)?.1;
        let port = words.split(", ").find_map(|word| {
            let (name, number) = word.split_once(' ')?;
            (name == "control").then(|| number.parse().ok())?
        })?;
        Some(SocketAddr::new(reachable(self.bound), port))
    }
}

/// Each robot of a user has an address of its own, so that all can have the ports that clients know.
fn own_address(number: usize) -> IpAddr {
    let last = u8::try_from(number).unwrap_or(u8::MAX);
    Ipv4Addr::new(127, 0, 0, last).into()
}

/// Where this machine reaches what serves there.
pub(crate) fn reachable(ip: IpAddr) -> IpAddr {
    if ip.is_unspecified() {
        Ipv4Addr::LOCALHOST.into()
    } else {
        ip
    }
}

/// Six ports in a row; the mailbox is last, because it may take one of the next four.
fn ports(first: u16) -> Result<impl Iterator<Item = String>, Error> {
    let names = [
        "control",
        "telemetry",
        "gamepad",
        "video",
        "variables",
        "mailbox",
    ];
    // From 0 on the system chooses each.
    let step = u16::from(first > 0);
    if first.checked_add(9).is_none() {
        return Err(Error::Refused(format!(
            "--trikd-ports {first}: there are no ten ports from there on: at most 65526"
        )));
    }
    Ok((0..).zip(names).map(move |(index, name)| {
        let number = first + step * index;
        format!("--{name}-port={number}")
    }))
}

/// What a person is told: where clients connect, and where programs are; `trik` is how this program is called.
pub(super) fn welcome(at: SocketAddr, scripts: &Path, trik: &str) -> String {
    let robot = match at.ip() == Ipv4Addr::LOCALHOST && at.port() == CONTROL_PORT {
        true => String::new(),
        false if at.port() == CONTROL_PORT => format!("--robot {} ", at.ip()),
        false => format!("--robot {at} "),
    };
    let studio = match at.port() {
        CONTROL_PORT => format!("TRIK Studio: connect to {}", at.ip()),
        _ => format!("TRIK Studio needs port {CONTROL_PORT}"),
    };
    format!(
        "\nIn a terminal: {trik} run {robot}FILE\n{studio}\nUploaded programs are in {}\n",
        scripts.display()
    )
}

/// How a person calls this program: its name if the shell finds one by it, else its path.
pub(super) fn own_command(program: Option<&Path>, path: Option<&OsStr>) -> String {
    let name = Path::new("trik");
    let is_found =
        path.is_some_and(|path| std::env::split_paths(path).any(|dir| dir.join(name).is_file()));
    match program {
        Some(program) if !is_found => program.display().to_string(),
        _ => name.display().to_string(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ports_are_in_a_row_or_chosen_by_the_system() {
        let list: Vec<_> = ports(18888).unwrap().collect();
        assert_eq!(list[0], "--control-port=18888");
        assert_eq!(list[5], "--mailbox-port=18893");
        assert!(ports(0).unwrap().all(|word| word.ends_with("-port=0")));
        assert!(ports(65526).is_ok());
        assert!(
            ports(65527)
                .err()
                .unwrap()
                .to_string()
                .contains("at most 65526")
        );
    }

    #[test]
    fn a_robot_is_reached_at_an_address_of_its_own() {
        assert_eq!(own_address(1).to_string(), "127.0.0.1");
        assert_eq!(own_address(32).to_string(), "127.0.0.32");
        assert_eq!(reachable("::".parse().unwrap()).to_string(), "127.0.0.1");
        let told = |at: &str| welcome(at.parse().unwrap(), Path::new("/s"), "trik");
        assert_eq!(
            told("127.0.0.1:8888"),
            "\nIn a terminal: trik run FILE\nTRIK Studio: connect to 127.0.0.1\nUploaded programs are in /s\n"
        );
        // Without it `trik run` asks which of several robots is meant.
        let second = told("127.0.0.2:8888");
        assert!(
            second.contains("trik run --robot 127.0.0.2 FILE\nTRIK Studio: connect to 127.0.0.2"),
            "{second}"
        );
        let other = told("127.0.0.1:4000");
        assert!(
            other.contains("trik run --robot 127.0.0.1:4000 FILE\nTRIK Studio needs port 8888"),
            "{other}"
        );
    }

    #[test]
    fn a_program_that_the_shell_does_not_find_is_called_by_its_path() {
        let built = Some(Path::new("/src/target/release/trik"));
        let nowhere = OsStr::new("/nowhere:/nor/here");
        assert_eq!(
            own_command(built, Some(nowhere)),
            "/src/target/release/trik"
        );
        assert_eq!(own_command(built, None), "/src/target/release/trik");
        let dir = tempfile::tempdir().unwrap();
        std::fs::write(dir.path().join("trik"), "").unwrap();
        let found = own_command(built, Some(dir.path().as_os_str()));
        assert_eq!(found, "trik");
        assert_eq!(own_command(None, None), "trik");
    }
}
