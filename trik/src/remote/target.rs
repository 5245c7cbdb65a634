//! Which robot is meant: its name, its address or the mountpoint of its tree, and the one that is meant without a name.
//!
//! Owns the forms of names, of which a path has a slash, and what is said of a robot that cannot be reached. `link` is the connection.

use super::link::Link;
use crate::error::Error;
use crate::limits;
use crate::place::{self, Running};
use std::fmt;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr, ToSocketAddrs};
use std::path::{Path, PathBuf};

/// The port on which robots take programs.
const PORT: u16 = 8888;

/// There is a tree, and nothing that says whose: somebody has removed that under a robot that runs.
pub(super) const UNKNOWN: &str = "a tree is mounted there, and nothing says where its robot takes programs: trik up did not mount it, or the folder trik in XDG_RUNTIME_DIR, or /tmp/trik-UID without that, was removed or is another one here; name the robot by its address, as trik up has printed it, or end it and start it again";
pub(super) const NOT_MOUNTED: &str =
    "no virtual robot of yours is mounted there; robots in the network have names and addresses";

/// A robot as somebody has named it.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Target {
    /// A name or an address.
    host: String,
    port: u16,
}

impl fmt::Display for Target {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match (self.port, self.host.contains(':')) {
            (PORT, _) => write!(out, "{}", self.host),
            (port, true) => write!(out, "[{}]:{port}", self.host),
            (port, false) => write!(out, "{}:{port}", self.host),
        }
    }
}

impl From<SocketAddr> for Target {
    fn from(address: SocketAddr) -> Self {
        let host = match address {
            // Without its interface such an address leads nowhere.
            SocketAddr::V6(six) if six.scope_id() != 0 => {
                format!("{}%{}", six.ip(), six.scope_id())
            }
            SocketAddr::V4(_) | SocketAddr::V6(_) => address.ip().to_string(),
        };
        Self {
            host,
            port: address.port(),
        }
    }
}

/// Whether `--robot` means a mountpoint by a text.
pub(crate) fn is_path(text: &str) -> bool {
    text.contains('/')
}

/// `HOST`, `HOST:PORT`, `[IPv6]:PORT`, a plain IPv6 address, or the mountpoint of a virtual robot. `%INTERFACE` after an IPv6 address
/// says where the network is in which it counts.
///
/// # Errors
/// It is none of these, or no virtual robot that takes programs is mounted there.
pub(crate) fn target(text: &str) -> Result<Target, Error> {
    if is_path(text) {
        return mounted(&place::running()?, Path::new(text));
    }
    if let Some(six) = six(text) {
        return six;
    }
    if let Ok(address) = text.parse::<SocketAddr>() {
        return Ok(address.into());
    }
    let (host, port) = match text.split_once(':') {
        None => (text, PORT),
        Some((host, text)) => (host, port(text)?),
    };
    let fits = |c: char| c.is_alphanumeric() || "-._".contains(c);
    if host.is_empty() || host.len() > limits::HOST_BYTES_MAX || !host.chars().all(fits) {
        let why = "no address: the name or the IP of a robot, such as 192.168.77.1";
        return Err(Error::Refused(why.to_owned()));
    }
    Ok(Target {
        host: host.to_owned(),
        port,
    })
}

fn port(text: &str) -> Result<u16, Error> {
    let port = text.parse().ok().filter(|port| *port > 0);
    port.ok_or_else(|| Error::Refused(format!("'{text}' is no port: a number from 1 to 65535")))
}

/// An IPv6 address with its interface and port; None if it is none.
fn six(text: &str) -> Option<Result<Target, Error>> {
    let (inside, tail) = match text.strip_prefix('[') {
        Some(rest) => rest.split_once(']')?,
        None => (text, ""),
    };
    let (address, zone) = match inside.split_once('%') {
        Some((address, zone)) => (address, Some(zone)),
        None => (inside, None),
    };
    let ip: Ipv6Addr = address.parse().ok()?;
    let fits = |c: char| c.is_ascii_alphanumeric() || "-._".contains(c);
    let is_zone =
        |zone: &str| (1..=limits::ZONE_BYTES_MAX).contains(&zone.len()) && zone.chars().all(fits);
    let refused = |why: String| Some(Err(Error::Refused(why)));
    match zone {
        Some(zone) if !is_zone(zone) => {
            return refused(format!("'{zone}' is no interface: write {address}%eth0"));
        }
        None if ip.is_unicast_link_local() => {
            return refused(format!(
                "{address} counts in one network alone: say which interface leads there, as {address}%eth0"
            ));
        }
        Some(_) | None => {}
    }
    let port = match tail.strip_prefix(':') {
        Some(text) => port(text),
        None if tail.is_empty() => Ok(PORT),
        None => return None,
    };
    Some(port.map(|port| Target {
        host: inside.to_owned(),
        port,
    }))
}

/// The robot if none is named: the virtual one that runs here, or what listens on this machine.
pub(crate) fn the_one() -> Result<Target, Error> {
    choose(&place::running()?)
}

/// What takes programs for the virtual robot that is mounted there. A real robot is never guessed from a path.
fn mounted(all: &[Running], path: &Path) -> Result<Target, Error> {
    let real = path.canonicalize().unwrap_or_else(|_| path.to_owned());
    let Some(robot) = all.iter().find(|robot| robot.mountpoint == real) else {
        let why = match trikfs::mount::is_mounted(&real) {
            Ok(true) => UNKNOWN,
            Ok(false) | Err(_) => NOT_MOUNTED,
        };
        return Err(Error::file(path, why));
    };
    robot.trikd.map(Target::from).ok_or_else(|| deaf(robot))
}

/// Where the tree of a robot is that `--robot` names, for commands that need the tree: a mountpoint is taken as it is, and
/// of the virtual robots one is found by its address.
///
/// # Errors
/// No tree is known of a robot with this address.
pub(crate) fn tree_of(named: &Path) -> Result<PathBuf, Error> {
    if named.is_dir() {
        return Ok(named.to_owned());
    }
    match named.to_str().filter(|text| !is_path(text)).map(target) {
        Some(Ok(address)) => tree_at(&place::running()?, &address),
        Some(Err(_)) | None => Ok(named.to_owned()),
    }
}

fn tree_at(all: &[Running], address: &Target) -> Result<PathBuf, Error> {
    let is_meant = |robot: &&Running| robot.trikd.map(Target::from).as_ref() == Some(address);
    let found = all.iter().find(is_meant);
    found.map(|robot| robot.mountpoint.clone()).ok_or_else(|| {
        Error::Refused(format!(
            "{address} is no virtual robot of yours, and this needs its tree: say where that is mounted, a path with a slash"
        ))
    })
}

/// What is said of a virtual robot that takes no programs.
fn deaf(robot: &Running) -> Error {
    Error::Refused(format!(
        "the virtual robot at {} has no trikd, which takes programs: it told why when it started, or was started with --no-trikd",
        robot.mountpoint.display()
    ))
}

fn choose(all: &[Running]) -> Result<Target, Error> {
    let reachable: Vec<_> = all
        .iter()
        .filter_map(|robot| Some((Target::from(robot.trikd?), robot)))
        .collect();
    match (&reachable[..], all) {
        ([(one, _)], _) => Ok(one.clone()),
        ([], []) => Ok(SocketAddr::new(Ipv4Addr::LOCALHOST.into(), PORT).into()),
        ([], [robot, ..]) => Err(deaf(robot)),
        (several, _) => {
            let list: Vec<_> = several
                .iter()
                .map(|(target, robot)| format!("{target} ({})", robot.mountpoint.display()))
                .collect();
            Err(Error::Refused(format!(
                "several robots run: say which with --robot: {}",
                list.join(", ")
            )))
        }
    }
}

impl Target {
    /// Connects, trying all addresses that the name has.
    ///
    /// # Errors
    /// A sentence with what to do.
    pub(super) fn connect(&self) -> Result<Link, Error> {
        let mut why = String::new();
        for address in self.addresses()? {
            match Link::connect(address, &self.to_string()) {
                Ok(link) => return Ok(link),
                Err(error) => why = self.explain(&error),
            }
        }
        Err(Error::Unreachable(why))
    }

    /// All addresses that the name has, at least one.
    ///
    /// # Errors
    /// There are none.
    pub(crate) fn addresses(&self) -> Result<Vec<SocketAddr>, Error> {
        let found = (self.host.as_str(), self.port).to_socket_addrs();
        let addresses: Vec<_> = match found {
            Ok(found) => found.take(limits::ADDRESSES_MAX).collect(),
            Err(_) => Vec::new(),
        };
        match addresses.is_empty() {
            false => Ok(addresses),
            true => Err(Error::Unreachable(format!(
                "there is no robot '{}' in this network: take its IP address, which the robot shows in its network settings",
                self.host
            ))),
        }
    }

    /// Where browsers find its page, if it is a virtual robot of this user.
    pub(crate) fn page(&self) -> Option<SocketAddr> {
        let is_meant = |robot: &&Running| robot.trikd.map(Self::from).as_ref() == Some(self);
        place::running().ok()?.iter().find(is_meant)?.page
    }

    // Kinds of errors of the system are not ours to list.
    #[allow(clippy::wildcard_enum_match_arm)]
    fn explain(&self, error: &std::io::Error) -> String {
        use std::io::ErrorKind;
        let seconds = limits::CONNECT_MS / 1000;
        match error.kind() {
            ErrorKind::ConnectionRefused => {
                let port = self.port;
                let hint = match self.host.parse::<IpAddr>() {
                    Ok(ip) if ip.is_loopback() => "start a virtual robot with trik up",
                    _ => "start trikd on the robot",
                };
                format!(
                    "nothing takes programs at {}, port {port}: {hint}",
                    self.host
                )
            }
            ErrorKind::TimedOut | ErrorKind::WouldBlock => format!(
                "{self} does not answer within {seconds} s: is it switched on, and in the same network?"
            ),
            ErrorKind::HostUnreachable | ErrorKind::NetworkUnreachable => format!(
                "there is no way to {self} ({error}): is this computer in the network of the robot?"
            ),
            _ => format!("no connection to {self}: {error}"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robots_are_named_as_people_name_computers() {
        for (text, shown, port) in [
            ("192.168.77.1", "192.168.77.1", 8888),
            ("192.168.77.1:9", "192.168.77.1:9", 9),
            ("trik-1.local", "trik-1.local", 8888),
            ("trik:8888", "trik", 8888),
            ("::1", "::1", 8888),
            ("[::1]:9", "[::1]:9", 9),
            ("[::1]", "::1", 8888),
            ("fe80::1%eth0", "fe80::1%eth0", 8888),
            ("[fe80::1%wlan-0.5]:9", "[fe80::1%wlan-0.5]:9", 9),
        ] {
            let target = target(text).expect(text);
            assert_eq!((target.to_string(), target.port), (shown.to_owned(), port));
        }
        for text in [
            "",
            ":9",
            "a b",
            "trik:",
            "trik:0",
            "trik:65536",
            "trik:x",
            "a:b:c",
            "fe80::1",
            "[fe80::1]:9",
            "fe80::1%",
            "fe80::1%a b",
            "fe80::1%0123456789abcdef",
            "[::1]9",
            "[::1]:0",
            "[::1",
            "1.2.3.4%eth0",
        ] {
            assert!(target(text).is_err(), "{text}");
        }
        assert!(
            target("trik:99999")
                .unwrap_err()
                .to_string()
                .contains("'99999' is no port")
        );
    }

    #[test]
    fn an_address_of_one_network_needs_its_interface_and_keeps_it() {
        let said = |text: &str| target(text).unwrap_err().to_string();
        assert_eq!(
            said("[fe80::1]:9"),
            "fe80::1 counts in one network alone: say which interface leads there, as fe80::1%eth0"
        );
        assert_eq!(said("fe80::1%"), "'' is no interface: write fe80::1%eth0");
        let address: SocketAddr = "[fe80::1%3]:8888".parse().unwrap();
        assert_eq!(Target::from(address).to_string(), "fe80::1%3");
        // The loopback interface has no such address, but leads to itself.
        let lo = Target {
            host: "::1%1".to_owned(),
            port: 8888,
        };
        let found = (lo.host.as_str(), lo.port).to_socket_addrs();
        assert!(found.is_ok_and(|mut found| found.any(|one| one.is_ipv6())));
    }

    #[test]
    fn a_path_and_an_address_of_a_virtual_robot_mean_the_same() {
        let robot = |mountpoint: &str, trikd: Option<&str>| Running {
            mountpoint: mountpoint.into(),
            board: "/none".into(),
            trikd: trikd.map(|text| text.parse().expect("an address")),
            page: None,
        };
        let all = [
            robot("/none/a", Some("127.0.0.2:8888")),
            robot("/none/b", None),
        ];
        let address = mounted(&all, Path::new("/none/a")).unwrap();
        assert_eq!(address, target("127.0.0.2").unwrap());
        assert_eq!(tree_at(&all, &address), Ok("/none/a".into()));
        let refused = |path: &str| mounted(&all, Path::new(path)).unwrap_err().to_string();
        assert!(refused("/none/b").starts_with("the virtual robot at /none/b has no trikd"));
        assert!(refused("/none/c").starts_with("/none/c: no virtual robot of yours is mounted"));
        let other = target("192.168.77.1").unwrap();
        let why = tree_at(&all, &other).unwrap_err().to_string();
        assert!(why.starts_with("192.168.77.1 is no virtual robot"), "{why}");
        assert_eq!(tree_of(Path::new("/none/d")), Ok("/none/d".into()));
    }

    #[test]
    fn without_a_name_the_only_robot_that_takes_programs_is_meant() {
        let robot = |mountpoint: &str, trikd: Option<&str>| Running {
            mountpoint: mountpoint.into(),
            board: "/none".into(),
            trikd: trikd.map(|text| text.parse().expect("an address")),
            page: None,
        };
        let chosen = |all: &[Running]| {
            choose(all)
                .map(|target| target.to_string())
                .map_err(|error| error.to_string())
        };
        assert_eq!(chosen(&[]).as_deref(), Ok("127.0.0.1"));
        let one = robot("/a", Some("127.0.0.2:8888"));
        assert_eq!(
            chosen(std::slice::from_ref(&one)).as_deref(),
            Ok("127.0.0.2")
        );
        assert_eq!(
            chosen(&[robot("/b", None), one.clone()]).as_deref(),
            Ok("127.0.0.2")
        );
        let refusal = chosen(&[robot("/b", None)]).unwrap_err();
        assert!(
            refusal.starts_with("the virtual robot at /b has no trikd"),
            "{refusal}"
        );
        assert_eq!(
            chosen(&[one, robot("/c", Some("127.0.0.1:4000"))]),
            Err(
                "several robots run: say which with --robot: 127.0.0.2 (/a), 127.0.0.1:4000 (/c)"
                    .to_owned()
            )
        );
    }
}
