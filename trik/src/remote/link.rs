//! One connection to the control port of a robot: frames in both directions, keepalives, and a sentence when it ends.
//!
//! Owns the socket and both buffers. The frames themselves are those of trikd; what to ask is not known here.

use crate::error::Error;
use crate::limits;
use frame::{Decoder, encode};
use lang_text::problem::Locale;
use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
use std::io::{self, Read, Write};
use std::net::{IpAddr, SocketAddr, TcpStream};
use std::os::fd::{AsFd, BorrowedFd};
use std::time::{Duration, Instant};

/// A duration of `limits`.
pub(super) fn ms(ms: u32) -> Duration {
    Duration::from_millis(ms.into())
}

/// Something that a robot says.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Message {
    /// Output of the program, newlines included.
    Print(Vec<u8>),
    /// Something has failed.
    Error(String),
    /// Something to know.
    Info(String),
    /// The answer to `version`.
    Version,
    /// The answer to `status`.
    Status(String),
    /// Something that a debugger says, a JSON object.
    Debug(String),
    /// A question to a person, a JSON object.
    Question(String),
    /// A piece of a recording; an empty one is the end of a file.
    Stream(Vec<u8>),
}

impl Message {
    /// The piece of a recording, where nothing else was asked for; what comes to all clients is none.
    pub fn piece(self) -> Option<Vec<u8>> {
        match self {
            Self::Stream(piece) => Some(piece),
            Self::Print(_)
            | Self::Error(_)
            | Self::Info(_)
            | Self::Version
            | Self::Status(_)
            | Self::Debug(_)
            | Self::Question(_) => None,
        }
    }
}

/// What a frame says; None: nothing that anybody here asked for.
fn message(frame: &[u8]) -> Option<Message> {
    let colon = frame.iter().position(|&byte| byte == b':')?;
    let (word, rest) = (&frame[..colon], &frame[colon + 1..]);
    if word == b"stream" {
        return Some(Message::Stream(rest.to_vec()));
    }
    let rest = rest.strip_prefix(b" ").unwrap_or(rest);
    let text = || String::from_utf8_lossy(rest).into_owned();
    match word {
        b"print" => Some(Message::Print(rest.to_vec())),
        b"error" => Some(Message::Error(text())),
        b"info" => Some(Message::Info(text())),
        b"version" => Some(Message::Version),
        b"status" => Some(Message::Status(text())),
        b"debug" => Some(Message::Debug(text())),
        b"question" => Some(Message::Question(text())),
        _ => None,
    }
}

/// A connection.
#[derive(Debug)]
pub(super) struct Link {
    stream: TcpStream,
    name: String,
    decoder: Decoder,
    unsent: Vec<u8>,
    /// Bytes of `unsent` that are on their way.
    gone: usize,
    sent: Instant,
    heard: Instant,
    /// The last failure that the robot told of: why a connection ends is said before its end.
    last_error: Option<String>,
    /// The other side has closed it; what came before may not all be taken.
    lost: Option<String>,
}

impl Link {
    /// Connects within [`limits::CONNECT_MS`].
    pub(super) fn connect(address: SocketAddr, name: &str) -> io::Result<Self> {
        let stream = TcpStream::connect_timeout(&address, ms(limits::CONNECT_MS))?;
        stream.set_nonblocking(true)?;
        stream.set_nodelay(true)?;
        let now = Instant::now();
        Ok(Self {
            stream,
            name: name.to_owned(),
            decoder: Decoder::new(limits::MESSAGE_BYTES_MAX),
            unsent: Vec::new(),
            gone: 0,
            sent: now,
            heard: now,
            last_error: None,
            lost: None,
        })
    }

    /// The robot, as a person has named it.
    pub(super) fn name(&self) -> &str {
        &self.name
    }

    /// Our own address, as the robot sees it unless something between changes it.
    pub(super) fn own_address(&self) -> String {
        let address = self.stream.local_addr();
        address.map_or_else(|_| String::new(), |address| address.to_string())
    }

    /// Our address and that of the robot.
    ///
    /// # Errors
    /// The connection is lost.
    pub(super) fn addresses(&self) -> io::Result<(IpAddr, IpAddr)> {
        let (own, robot) = (self.stream.local_addr()?, self.stream.peer_addr()?);
        Ok((own.ip(), robot.ip()))
    }

    /// Bytes that are not on their way yet.
    pub(super) fn unsent(&self) -> usize {
        self.unsent.len() - self.gone
    }

    /// Keeps a failure, in case the connection ends because of it.
    pub(super) fn remember(&mut self, text: &str) {
        self.last_error = Some(text.to_owned());
    }

    /// Puts one message of several parts after what is still to be sent.
    pub(super) fn ask(&mut self, parts: &[&[u8]]) {
        let size: usize = parts.iter().map(|part| part.len()).sum();
        self.unsent.reserve(size + 16);
        self.unsent.extend_from_slice(format!("{size}:").as_bytes());
        parts
            .iter()
            .for_each(|part| self.unsent.extend_from_slice(part));
    }

    /// Has the robot say what it says of programs of blocks in this language, if it is another one than robots speak when
    /// nobody asks for any. An older robot passes over that.
    pub(super) fn speak(&mut self, locale: Locale) {
        match locale {
            Locale::English => {}
            Locale::Russian => self.ask(&[b"language:", locale.name().as_bytes()]),
        }
    }

    /// The next message that has come.
    pub(super) fn next(&mut self) -> Option<Message> {
        loop {
            match self.decoder.next() {
                Ok(Some(frame)) => {
                    if let Some(message) = message(frame) {
                        return Some(message);
                    }
                }
                Ok(None) => return None,
                Err(violation) => {
                    self.lost
                        .get_or_insert(format!("it does not speak as robots do, {violation}"));
                    return None;
                }
            }
        }
    }

    /// Waits until bytes come or go, `also` is readable, or the pause is over. Call it when [`Link::next`] has nothing
    /// more. While it does not listen, what the robot says waits outside.
    ///
    /// # Errors
    /// A sentence: the connection is lost.
    pub(super) fn turn(
        &mut self,
        pause: Duration,
        also: Option<BorrowedFd<'_>>,
        listens: bool,
    ) -> Result<(), Error> {
        if let Some(why) = &self.lost {
            let name = &self.name;
            // What it said last is the better reason.
            return Err(Error::Unreachable(match &self.last_error {
                Some(error) => format!("{name} has closed the connection: {error}"),
                None => format!("the connection to {name} is lost: {why}"),
            }));
        }
        if self.unsent() == 0 && self.sent.elapsed() >= ms(limits::KEEPALIVE_MS) {
            let frame = encode(b"keepalive");
            self.unsent.extend_from_slice(&frame);
        }
        let mut events = PollFlags::empty();
        events.set(PollFlags::POLLIN, listens);
        events.set(PollFlags::POLLOUT, self.unsent() > 0);
        let mut watched = vec![PollFd::new(self.stream.as_fd(), events)];
        watched.extend(also.map(|fd| PollFd::new(fd, PollFlags::POLLIN)));
        let pause: PollTimeout = pause.try_into().unwrap_or(PollTimeout::MAX);
        match poll(&mut watched, pause) {
            Ok(_) | Err(nix::Error::EINTR) => {}
            Err(error) => return Err(Error::system(format!("waiting for {}", self.name), error)),
        }
        drop(watched);
        self.write();
        if listens {
            self.read();
            let most = ms(limits::SILENCE_MS);
            if self.lost.is_none() && self.heard.elapsed() >= most && self.sent.elapsed() < most {
                self.lost = Some(format!(
                    "it has been silent for {} s",
                    limits::SILENCE_MS / 1000
                ));
            }
        } else {
            self.heard = Instant::now();
        }
        Ok(())
    }

    fn write(&mut self) {
        while self.unsent() > 0 {
            match self.stream.write(&self.unsent[self.gone..]) {
                Ok(size) if size > 0 => {
                    self.gone += size;
                    self.sent = Instant::now();
                }
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Ok(_) => return,
                // Why it takes no more it may have said before: that is still to be read.
                Err(_) => break,
            }
        }
        self.unsent = Vec::new();
        self.gone = 0;
    }

    /// Takes a bounded amount: the rest comes at the next turn.
    fn read(&mut self) {
        let mut piece = [0; 16 << 10];
        for _ in 0..16 {
            match self.stream.read(&mut piece) {
                Ok(0) => {
                    self.lost = Some("the robot has closed it".to_owned());
                    return;
                }
                Ok(size) => {
                    self.heard = Instant::now();
                    self.decoder.feed(&piece[..size]);
                }
                Err(error) if error.kind() == io::ErrorKind::WouldBlock => return,
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) => {
                    self.lost = Some(error.to_string());
                    return;
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::TcpListener;

    fn pair() -> (TcpStream, Link) {
        let listener = TcpListener::bind("127.0.0.1:0").expect("a port");
        let address = listener.local_addr().expect("an address");
        let link = Link::connect(address, "robby").expect("a connection");
        let (robot, _) = listener.accept().expect("a client");
        (robot, link)
    }

    fn heard(link: &mut Link) -> Result<Message, Error> {
        loop {
            if let Some(message) = link.next() {
                return Ok(message);
            }
            link.turn(Duration::from_millis(100), None, true)?;
        }
    }

    #[test]
    fn messages_are_told_apart_and_strange_ones_are_left_out() {
        let (mut robot, mut link) = pair();
        for frame in [
            "9:keepalive",
            "10:print: a\n\n",
            "5:x:y:z",
            "8:error: e",
            "7:info: i",
            "14:version: 3.1.4",
            "17:status: program x",
        ] {
            robot.write_all(frame.as_bytes()).expect("sent");
        }
        let all: Vec<_> = (0..5)
            .map(|_| heard(&mut link).expect("a message"))
            .collect();
        let expected = [
            Message::Print(b"a\n\n".to_vec()),
            Message::Error("e".to_owned()),
            Message::Info("i".to_owned()),
            Message::Version,
            Message::Status("program x".to_owned()),
        ];
        assert_eq!(all, expected);
    }

    #[test]
    fn a_connection_that_ends_says_why() {
        let (mut robot, mut link) = pair();
        link.ask(&[b"ru", b"n:x"]);
        link.turn(Duration::ZERO, None, true).expect("sent");
        let mut asked = [0; 7];
        robot.read_exact(&mut asked).expect("a request");
        assert_eq!(&asked, b"5:run:x");
        robot.write_all(b"8:error: e").expect("sent");
        drop(robot);
        assert_eq!(heard(&mut link), Ok(Message::Error("e".to_owned())));
        let why = heard(&mut link).expect_err("the end");
        assert_eq!(
            why.to_string(),
            "the connection to robby is lost: the robot has closed it"
        );
    }

    #[test]
    fn what_is_no_robot_is_told_from_one() {
        let (mut robot, mut link) = pair();
        robot.write_all(&[b'x'; 5000]).expect("sent");
        let why = heard(&mut link).expect_err("the end").to_string();
        assert!(why.contains("does not speak as robots do"), "{why}");
    }
}
