//! A program of a robot that connects to this computer: its bytes on their way to a port of ours, and back.
//!
//! Owns who is let in: the robot, once. Knows nothing of what is said.

use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::io;
use std::net::{IpAddr, Ipv4Addr, Shutdown, SocketAddr, TcpListener, TcpStream};
use std::os::fd::AsFd;

/// A port that waits for a robot.
#[derive(Debug)]
pub(super) struct Relay {
    listener: TcpListener,
    robot: IpAddr,
    /// The robot, which has come before anybody listens here.
    come: Option<TcpStream>,
    /// The port of this computer behind it.
    inner: Option<u16>,
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
            come: None,
            inner: None,
        })
    }

    /// Where the robot has to connect to.
    ///
    /// # Errors
    /// Those of the system.
    pub fn port(&self) -> io::Result<u16> {
        Ok(self.listener.local_addr()?.port())
    }

    /// What the robot says goes to this port from now on.
    pub fn lead_to(&mut self, port: u16) {
        self.inner = Some(port);
    }

    /// Lets the robot in if it is there. True: it is, and this is not needed any more.
    ///
    /// # Errors
    /// Nobody listens at the port.
    pub fn turn(&mut self) -> io::Result<bool> {
        let mut there = [PollFd::new(self.listener.as_fd(), PollFlags::POLLIN)];
        if self.come.is_none() && poll(&mut there, PollTimeout::ZERO).is_ok_and(|count| count > 0) {
            // Who was there may have gone before it was let in, which is no end of the talk.
            let Ok((stream, peer)) = self.listener.accept() else {
                return Ok(false);
            };
            // Anybody else would be taken for the program.
            if self.is_robot(peer.ip().to_canonical()) {
                stream.set_nonblocking(false)?;
                stream.set_nodelay(true)?;
                self.come = Some(stream);
            }
        }
        let (Some(port), Some(_)) = (self.inner, &self.come) else {
            return Ok(false);
        };
        let inner = TcpStream::connect(SocketAddr::from((Ipv4Addr::LOCALHOST, port)))?;
        inner.set_nodelay(true)?;
        let Some(robot) = self.come.take() else {
            return Ok(false);
        };
        copy(robot.try_clone()?, inner.try_clone()?);
        copy(inner, robot);
        Ok(true)
    }
}

impl Relay {
    /// Virtual robots have several addresses of this computer, and connect from any of them. So any process of this
    /// computer, of whichever user, is taken for a virtual robot if it comes first.
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
    use std::io::{Read, Write};
    use std::time::Duration;

    /// Longer than anything takes that works.
    const LIFE: Option<Duration> = Some(Duration::from_secs(20));

    fn connected(robot: IpAddr) -> (Relay, TcpStream, TcpListener) {
        let own = IpAddr::from(Ipv4Addr::LOCALHOST);
        let mut relay = Relay::new(own, robot).expect("a port");
        let inner = TcpListener::bind((own, 0)).expect("a port");
        let port = relay.port().expect("a port");
        let program = TcpStream::connect((own, port)).expect("a connection");
        program.set_read_timeout(LIFE).expect("a socket");
        assert!(!relay.turn().expect("nobody listens yet"));
        relay.lead_to(inner.local_addr().expect("its port").port());
        (relay, program, inner)
    }

    #[test]
    fn the_robot_speaks_with_who_listens_here() {
        let (mut relay, mut program, inner) = connected(Ipv4Addr::LOCALHOST.into());
        // As of a virtual robot that has another address.
        relay.robot = Ipv4Addr::new(127, 0, 0, 9).into();
        assert!(relay.turn().expect("both"));
        let (mut debugger, _) = inner.accept().expect("the other end");
        debugger.set_read_timeout(LIFE).expect("a socket");
        let mut heard = [0; 2];
        program.write_all(b"hi").expect("sent");
        debugger.read_exact(&mut heard).expect("heard");
        assert_eq!(&heard, b"hi");
        debugger.write_all(b"ho").expect("sent");
        program.read_exact(&mut heard).expect("heard");
        assert_eq!(&heard, b"ho");
        drop(program);
        assert_eq!(debugger.read(&mut heard).expect("the end"), 0);
    }

    #[test]
    fn nobody_else_is_let_in() {
        let (mut relay, mut other, _inner) = connected(Ipv4Addr::new(192, 168, 77, 1).into());
        assert!(!relay.turn().expect("nobody"));
        let end = other.read(&mut [0; 1]);
        let is_closed = match &end {
            Ok(count) => *count == 0,
            Err(why) => why.kind() == io::ErrorKind::ConnectionReset,
        };
        assert!(is_closed, "{end:?}");
    }
}
