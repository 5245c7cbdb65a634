//! Robots that are reached over the network, real or virtual: `trik run`, `stop`, `status`, `send`.
//!
//! Owns which robot is meant and how a program gets there. `link` is one connection, `run` follows one program, `fleet`
//! does something with several robots at once, `output` is where a program's text goes.

mod fleet;
mod link;
mod output;
mod run;

use crate::limits;
use crate::place::{self, Running};
pub(crate) use fleet::{send, status, stop};
use link::{Link, Message};
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
pub(crate) use run::run;
use std::fmt;
use std::io::Write;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, ToSocketAddrs};
use std::os::fd::BorrowedFd;
use std::path::Path;
use std::time::{Duration, Instant};
use trikd::protocol::news;

/// The port on which robots take programs.
pub(crate) const PORT: u16 = 8888;

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
        Self {
            host: address.ip().to_string(),
            port: address.port(),
        }
    }
}

/// `HOST`, `HOST:PORT`, `[IPv6]:PORT` or a plain IPv6 address.
pub(crate) fn target(text: &str) -> Result<Target, String> {
    if let Ok(address) = text.parse::<SocketAddr>() {
        return Ok(address.into());
    }
    if text.parse::<IpAddr>().is_ok() {
        return Ok(SocketAddr::new(text.parse().map_err(|_| text.to_owned())?, PORT).into());
    }
    let (host, port) = match text.split_once(':') {
        None => (text, PORT),
        Some((host, port)) => match port.parse() {
            Ok(port) if port > 0 => (host, port),
            _ => return Err(format!("'{port}' is no port: a number from 1 to 65535")),
        },
    };
    let fits = |c: char| c.is_alphanumeric() || "-._".contains(c);
    if host.is_empty() || host.len() > limits::HOST_BYTES_MAX || !host.chars().all(fits) {
        return Err("no address: the name or the IP of a robot, such as 192.168.77.1".to_owned());
    }
    Ok(Target {
        host: host.to_owned(),
        port,
    })
}

/// The robot of whoever names none: the virtual one that runs here, or what listens on this machine.
fn the_one() -> Result<Target, String> {
    let base = place::base()?;
    let all = place::running(&base).map_err(|error| format!("{}: {error}", base.display()));
    // Looking makes the directory; nobody needs it if no robot does.
    let _ = std::fs::remove_dir(&base);
    choose(&all?)
}

fn choose(all: &[Running]) -> Result<Target, String> {
    let reachable: Vec<_> = all
        .iter()
        .filter_map(|robot| Some((Target::from(robot.trikd?), robot)))
        .collect();
    match (&reachable[..], all) {
        ([(one, _)], _) => Ok(one.clone()),
        ([], []) => Ok(SocketAddr::new(Ipv4Addr::LOCALHOST.into(), PORT).into()),
        ([], [robot, ..]) => Err(format!(
            "the virtual robot at {} has no trikd, which takes programs: it told why when it started, or was started with --no-trikd",
            robot.mountpoint.display()
        )),
        (several, _) => {
            let list: Vec<_> = several
                .iter()
                .map(|(target, robot)| format!("{target} ({})", robot.mountpoint.display()))
                .collect();
            Err(format!(
                "several robots run: say which with --robot: {}",
                list.join(", ")
            ))
        }
    }
}

impl Target {
    /// Connects, trying all addresses that the name has.
    ///
    /// # Errors
    /// A sentence with what to do.
    fn connect(&self) -> Result<Link, String> {
        let found = (self.host.as_str(), self.port).to_socket_addrs();
        let addresses: Vec<_> = match found {
            Ok(found) => found.take(limits::ADDRESSES_MAX).collect(),
            Err(_) => Vec::new(),
        };
        let mut why = format!(
            "there is no robot '{}' in this network: take its IP address, which the robot shows in its network settings",
            self.host
        );
        for address in addresses {
            match Link::connect(address, &self.to_string()) {
                Ok(link) => return Ok(link),
                Err(error) => why = self.explain(&error),
            }
        }
        Err(why)
    }

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

/// A program on its way to robots.
#[derive(Debug)]
struct Upload {
    /// Its name on the robot.
    pub(crate) name: String,
    content: Vec<u8>,
}

impl Upload {
    /// Reads a file.
    ///
    /// # Errors
    /// It cannot be read, is too long, or its name is none for a robot.
    pub(crate) fn read(path: &Path) -> Result<Self, String> {
        let shown = path.display();
        let bad = |why: String| format!("{shown}: {why}");
        let name = path.file_name().and_then(|name| name.to_str());
        let name =
            name.ok_or_else(|| bad("its name is no text that a robot understands".to_owned()))?;
        // The same rule as on the robot, and a colon would end the name on the way.
        trikd::scripts::locate(Path::new("/"), name.as_bytes())?;
        if name.contains(':') {
            return Err(bad(
                "a program with ':' in its name cannot be sent".to_owned()
            ));
        }
        let data = std::fs::metadata(path).map_err(|error| bad(error.to_string()))?;
        if !data.is_file() {
            return Err(bad("not a file".to_owned()));
        }
        let most = limits::UPLOAD_BYTES_MAX;
        if data.len() > most {
            return Err(bad(format!("longer than {} MiB", most >> 20)));
        }
        let mut content = Vec::new();
        let file = std::fs::File::open(path).map_err(|error| bad(error.to_string()))?;
        // It may have grown meanwhile.
        std::io::Read::read_to_end(&mut std::io::Read::take(file, most), &mut content)
            .map_err(|error| bad(error.to_string()))?;
        let name = name.to_owned();
        Ok(Self { name, content })
    }

    /// Sends it and waits until the robot has kept it. `tell` hears how many bytes of how many are on their way.
    ///
    /// # Errors
    /// A sentence: the connection is lost, or the robot refuses.
    pub(super) fn send(
        &self,
        link: &mut Link,
        mut tell: impl FnMut(usize, usize),
    ) -> Result<(), String> {
        let head = format!("file:{}:", self.name);
        link.ask(&[head.as_bytes(), &self.content]);
        // Answered in order, so behind the answer the file is kept or refused.
        link.ask(&[b"version"]);
        let all = link.unsent();
        let mut moved = (all, Instant::now());
        loop {
            tell(all - link.unsent().min(all), all);
            while let Some(message) = link.next() {
                match message {
                    Message::Version => return Ok(()),
                    Message::Error(text) if self.is_refused(&text) => {
                        let robot = link.name();
                        return Err(format!("{robot} refuses {}: {text}", self.name));
                    }
                    Message::Error(text) => link.remember(&text),
                    _ => {}
                }
            }
            if moved.0 != link.unsent() {
                moved = (link.unsent(), Instant::now());
            } else if moved.1.elapsed() >= ms(limits::ANSWER_MS) {
                return Err(format!(
                    "{} has not answered for {} s: is it a robot?",
                    link.name(),
                    limits::ANSWER_MS / 1000
                ));
            }
            link.turn(ms(limits::TURN_MS), None, true)?;
        }
    }

    /// Other errors are those of a program that still runs.
    fn is_refused(&self, text: &str) -> bool {
        text == news::NOT_PAIRED
            || text.starts_with(news::UPLOAD_FAILED)
            || text.starts_with(&format!("'{}'", self.name))
    }
}

/// Runs a program that is on the robot, and waits until it has started, or `also` can be read.
///
/// # Errors
/// A sentence: the connection is lost, or the robot refuses.
fn start(link: &mut Link, name: &str, also: Option<BorrowedFd<'_>>) -> Result<(), String> {
    link.ask(&[b"run:", name.as_bytes()]);
    link.ask(&[b"status"]);
    let deadline = Instant::now() + ms(limits::ANSWER_MS);
    let mut errors: Vec<String> = Vec::new();
    loop {
        while let Some(message) = link.next() {
            match message {
                Message::Info(text) if text == news::started(name) => return Ok(()),
                Message::Error(text) => errors.push(text),
                Message::Status(text) => {
                    // A robot that had too much to say may have left the news of the start out.
                    if news::status(&text).is_of(name) {
                        return Ok(());
                    }
                    let why = errors
                        .pop()
                        .unwrap_or_else(|| "it does not say why".to_owned());
                    return Err(format!("{} does not run {name}: {why}", link.name()));
                }
                _ => {}
            }
            errors.drain(..errors.len().saturating_sub(1));
        }
        if Instant::now() >= deadline {
            return Err(format!(
                "{} does not say that {name} has started: if its software is older than trikd, the program may run, and trik stop ends it",
                link.name()
            ));
        }
        link.turn(ms(limits::TURN_MS), also, true)?;
        let mut there = also.map(|fd| PollFd::new(fd, PollFlags::POLLIN));
        if poll(there.as_mut_slice(), PollTimeout::ZERO).is_ok_and(|count| count > 0) {
            return Ok(());
        }
    }
}

fn ms(ms: u32) -> Duration {
    Duration::from_millis(ms.into())
}

/// A line for the person; nobody may be there.
fn tell(text: &str) {
    let _ = writeln!(std::io::stderr(), "trik: {}", harmless(text).trim_end());
}

/// Text of a robot that cannot command a terminal.
fn harmless(text: &str) -> String {
    let fits = |c: &char| matches!(c, '\n' | '\t') || !c.is_control();
    text.chars().filter(fits).collect()
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
            "a/b",
            "a:b:c",
        ] {
            assert!(target(text).is_err(), "{text}");
        }
        assert!(
            target("trik:99999")
                .unwrap_err()
                .contains("'99999' is no port")
        );
    }

    #[test]
    fn without_a_name_the_only_robot_that_takes_programs_is_meant() {
        let robot = |mountpoint: &str, trikd: Option<&str>| Running {
            mountpoint: mountpoint.into(),
            board: "/none".into(),
            trikd: trikd.map(|text| text.parse().expect("an address")),
        };
        let chosen = |all: &[Running]| choose(all).map(|target| target.to_string());
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

    #[test]
    fn a_file_that_no_robot_takes_is_refused_here() {
        let dir = std::env::temp_dir().join(format!("trik-upload-{}", std::process::id()));
        std::fs::create_dir_all(&dir).expect("a directory");
        for (name, why) in [
            ("a:b.js", "':'"),
            (".hidden.js", "begins with a dot"),
            ("none.js", "No such file"),
        ] {
            if name != "none.js" {
                std::fs::write(dir.join(name), "x").expect(name);
            }
            let refusal = Upload::read(&dir.join(name)).unwrap_err();
            assert!(refusal.contains(why), "{name}: {refusal}");
        }
        assert!(Upload::read(&dir).unwrap_err().contains("not a file"));
        assert!(Upload::read(Path::new("/")).is_err());
        let large = std::fs::File::create(dir.join("large")).expect("a file");
        large.set_len(limits::UPLOAD_BYTES_MAX + 1).expect("a hole");
        assert!(
            Upload::read(&dir.join("large"))
                .unwrap_err()
                .contains("longer than 256 MiB")
        );
        std::fs::remove_dir_all(dir).expect("removed");
    }
}
