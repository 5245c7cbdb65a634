//! A program of a robot that connects to this computer: its bytes on their way to a debugger of ours, and back.
//!
//! Owns who is let in: once, a program of the robot that knows the secret, which no other process has been told. Knows nothing
//! of what is said behind that.

use crate::limits;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::collections::VecDeque;
use std::fs::File;
use std::io::{self, Read};
use std::net::{IpAddr, Shutdown, TcpListener, TcpStream};
use std::os::fd::AsFd;

/// A port that waits for a robot.
#[derive(Debug)]
pub(super) struct Relay {
    listener: TcpListener,
    robot: IpAddr,
    secret: String,
    /// Those who have not said all of a secret yet.
    unknown: VecDeque<Unknown>,
    /// The program, which has come before the debugger is there.
    come: Option<TcpStream>,
    /// The debugger.
    inner: Option<TcpStream>,
}

/// Somebody who may be the program.
#[derive(Debug)]
struct Unknown {
    stream: TcpStream,
    said: Vec<u8>,
}

/// What is known of somebody who may be the program.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Seems {
    TheProgram,
    SomebodyElse,
    Undecided,
}

impl Unknown {
    /// Hears what it says next, and not a byte behind the secret.
    fn hear(&mut self, secret: &[u8]) -> Seems {
        let mut rest = vec![0; secret.len() - self.said.len()];
        match self.stream.read(&mut rest) {
            Ok(0) => return Seems::SomebodyElse,
            Ok(count) => self.said.extend_from_slice(&rest[..count]),
            Err(why) if why.kind() == io::ErrorKind::WouldBlock => return Seems::Undecided,
            Err(why) if why.kind() == io::ErrorKind::Interrupted => return Seems::Undecided,
            Err(_) => return Seems::SomebodyElse,
        }
        // One guess for each connection, and only when it is whole.
        match self.said.len() == secret.len() {
            false => Seems::Undecided,
            true if self.said == secret => Seems::TheProgram,
            true => Seems::SomebodyElse,
        }
    }
}

/// A word that nobody can guess.
fn secret() -> io::Result<String> {
    let mut bytes = [0; 16];
    File::open("/dev/urandom")?.read_exact(&mut bytes)?;
    Ok(bytes.iter().map(|byte| format!("{byte:02x}")).collect())
}

impl Relay {
    /// At this address of ours, for a robot with that one.
    ///
    /// # Errors
    /// There can be no more ports.
    pub fn new(own: IpAddr, robot: IpAddr) -> io::Result<Self> {
        let listener = TcpListener::bind((own, 0))?;
        listener.set_nonblocking(true)?;
        Ok(Self {
            listener,
            robot: robot.to_canonical(),
            secret: secret()?,
            unknown: VecDeque::new(),
            come: None,
            inner: None,
        })
    }

    /// Where the robot has to connect to, and what its program has to say there first, before the end of a line.
    ///
    /// # Errors
    /// Those of the system.
    pub fn place(&self) -> io::Result<(u16, &str)> {
        Ok((self.listener.local_addr()?.port(), &self.secret))
    }

    /// What the program says goes there from now on.
    pub fn lead_to(&mut self, debugger: TcpStream) {
        self.inner = Some(debugger);
    }

    /// Lets the program in if it is there. True: it is, and this is not needed any more.
    ///
    /// # Errors
    /// Those of the system.
    pub fn turn(&mut self) -> io::Result<bool> {
        if self.come.is_none() {
            self.find();
            self.greet();
        }
        let (Some(robot), Some(inner)) = (&self.come, &self.inner) else {
            return Ok(false);
        };
        robot.set_nonblocking(false)?;
        robot.set_nodelay(true)?;
        copy(robot.try_clone()?, inner.try_clone()?);
        copy(inner.try_clone()?, robot.try_clone()?);
        Ok(true)
    }

    /// Accepts what has come, many at once: a crowd is not to keep the program out.
    fn greet(&mut self) {
        for _ in 0..limits::RELAY_COMERS {
            let mut there = [PollFd::new(self.listener.as_fd(), PollFlags::POLLIN)];
            if !poll(&mut there, PollTimeout::ZERO).is_ok_and(|count| count > 0) {
                return;
            }
            // A connection may be gone before it is accepted, which is no end of the talk.
            let Ok((stream, peer)) = self.listener.accept() else {
                continue;
            };
            if self.is_robot(peer.ip().to_canonical()) && stream.set_nonblocking(true).is_ok() {
                let said = Vec::new();
                self.judge(Unknown { stream, said });
            }
        }
    }

    /// What becomes of somebody by what it has said so far.
    fn judge(&mut self, mut one: Unknown) {
        let line = format!("{}\n", self.secret).into_bytes();
        match one.hear(&line) {
            Seems::SomebodyElse => {}
            // Another one that knows the secret would be a program of ours too; the first counts.
            Seems::TheProgram if self.come.is_some() => {}
            Seems::TheProgram => self.come = Some(one.stream),
            Seems::Undecided => {
                // A connection that says nothing must not keep the program out.
                if self.unknown.len() >= limits::RELAY_UNKNOWN_MAX {
                    self.unknown.pop_front();
                }
                self.unknown.push_back(one);
            }
        }
    }

    /// Looks for the program among them.
    fn find(&mut self) {
        for one in std::mem::take(&mut self.unknown) {
            self.judge(one);
        }
    }

    /// Virtual robots have several addresses of this computer, and connect from any of them.
    fn is_robot(&self, peer: IpAddr) -> bool {
        peer == self.robot || peer.is_loopback() && self.robot.is_loopback()
    }
}

/// A thread that lives as long as one of the two speaks.
fn copy(mut from: TcpStream, mut to: TcpStream) {
    std::thread::spawn(move || {
        // Whose end it is does not matter: both are told.
        let _ = io::copy(&mut from, &mut to);
        let _ = from.shutdown(Shutdown::Both);
        let _ = to.shutdown(Shutdown::Both);
    });
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;
    use std::net::Ipv4Addr;
    use std::time::{Duration, Instant};

    const OWN: IpAddr = IpAddr::V4(Ipv4Addr::LOCALHOST);
    /// Longer than anything takes that works.
    const LIFE: Duration = Duration::from_secs(60);

    fn connection(port: u16) -> TcpStream {
        let stream = TcpStream::connect((OWN, port)).expect("a connection");
        stream.set_read_timeout(Some(LIFE)).expect("a socket");
        stream
    }

    /// One that waits, who has come there, and the debugger behind it, which is not there yet.
    fn connected(robot: IpAddr) -> (Relay, TcpStream, TcpListener) {
        let relay = Relay::new(OWN, robot).expect("a port");
        let inner = TcpListener::bind((OWN, 0)).expect("a port");
        let program = connection(relay.place().expect("a port").0);
        (relay, program, inner)
    }

    fn lead(relay: &mut Relay, inner: &TcpListener) -> TcpStream {
        let port = inner.local_addr().expect("its port").port();
        relay.lead_to(connection(port));
        let (debugger, _) = inner.accept().expect("the other end");
        debugger.set_read_timeout(Some(LIFE)).expect("a socket");
        debugger
    }

    fn turn_until(relay: &mut Relay, is_so: impl Fn(&Relay, bool) -> bool) {
        let end = Instant::now() + LIFE;
        loop {
            let is_in = relay.turn().expect("a system");
            if is_so(relay, is_in) {
                return;
            }
            assert!(Instant::now() < end, "{relay:?}");
            std::thread::yield_now();
        }
    }

    fn line(relay: &Relay) -> String {
        format!("{}\n", relay.place().expect("a port").1)
    }

    #[test]
    fn the_program_speaks_with_the_debugger_here() {
        // As of a virtual robot that has another address.
        let robot = Ipv4Addr::new(127, 0, 0, 9).into();
        let (mut relay, mut program, inner) = connected(robot);
        // In two pieces, and what it says then is for the debugger.
        let all = format!("{}hi", line(&relay));
        program.write_all(&all.as_bytes()[..5]).expect("sent");
        turn_until(&mut relay, |relay, _| {
            relay.unknown.iter().any(|one| one.said.len() == 5)
        });
        program.write_all(&all.as_bytes()[5..]).expect("sent");
        turn_until(&mut relay, |relay, is_in| {
            assert!(!is_in, "there is no debugger yet");
            relay.come.is_some()
        });
        let mut debugger = lead(&mut relay, &inner);
        assert!(relay.turn().expect("both"));
        let mut heard = [0; 2];
        debugger.read_exact(&mut heard).expect("heard");
        assert_eq!(&heard, b"hi");
        debugger.write_all(b"ho").expect("sent");
        program.read_exact(&mut heard).expect("heard");
        assert_eq!(&heard, b"ho");
        drop(program);
        assert_eq!(debugger.read(&mut heard).expect("the end"), 0);
    }

    fn is_closed(stream: &mut TcpStream) -> bool {
        match stream.read(&mut [0; 1]) {
            Ok(count) => count == 0,
            Err(why) => why.kind() == io::ErrorKind::ConnectionReset,
        }
    }

    #[test]
    fn another_computer_is_not_let_in() {
        let (mut relay, mut other, _inner) = connected(Ipv4Addr::new(192, 168, 77, 1).into());
        other.write_all(line(&relay).as_bytes()).expect("sent");
        assert!(!relay.turn().expect("nobody"));
        assert!(is_closed(&mut other));
        assert!(relay.come.is_none());
    }

    #[test]
    fn who_does_not_know_the_secret_is_not_taken_for_the_program() {
        let (mut relay, mut first, inner) = connected(OWN);
        let mut debugger = lead(&mut relay, &inner);
        let port = relay.place().expect("a port").0;
        let wrong = "0".repeat(relay.secret.len()) + "\n{\"type\":\"event\"}";
        first.write_all(wrong.as_bytes()).expect("sent");
        let mut gone = connection(port);
        gone.write_all(b"Content-Length: 3\r\n\r\nx").expect("sent");
        gone.shutdown(Shutdown::Write).expect("an end");
        // More than are heard at once, and none says anything.
        let mut silent = Vec::new();
        for _ in 0..limits::RELAY_UNKNOWN_MAX + 4 {
            silent.push(connection(port));
            assert!(!relay.turn().expect("a system"));
        }
        let mut program = connection(port);
        program.write_all(line(&relay).as_bytes()).expect("sent");
        program.write_all(b"it is me").expect("sent");
        turn_until(&mut relay, |_, is_in| is_in);
        let mut heard = [0; 8];
        debugger.read_exact(&mut heard).expect("heard");
        assert_eq!(&heard, b"it is me");
        drop(relay);
        for mut other in silent.into_iter().chain([first, gone]) {
            assert!(is_closed(&mut other));
        }
    }

    #[test]
    fn secrets_differ() {
        let secrets: std::collections::BTreeSet<_> =
            (0..100).map(|_| secret().expect("one")).collect();
        assert_eq!(secrets.len(), 100);
        assert!(secrets.iter().all(|secret| secret.len() == 32));
    }
}
