//! The daemon as a program sees it: a channel of frames on standard input, in both directions.
//!
//! Owns the program's end of that channel; `program` has the other end, and [`crate::protocol::program`] what is said.
//! Everything is blocking and on one thread: an engine polls [`Host::fd`] together with its timers. Python programs
//! have `trik.py` in its place.

use crate::engine::Start;
use crate::limits;
use crate::protocol::program::mailbox::Question;
use crate::protocol::program::{FromProgram, ToProgram, WhenGone};
use frame::{Decoder, encode};
use lang_text::problem::Locale;
use nix::errno::Errno;
use nix::sys::socket::MsgFlags;
use std::cell::RefCell;
use std::io::{self, Read, Write};
use std::os::fd::{AsFd, AsRawFd, BorrowedFd, OwnedFd};
use std::os::unix::net::UnixStream;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// What comes from the daemon while a program runs.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Incoming {
    /// A direct text to evaluate.
    Direct(String),
    /// A message of the mailbox: hull number of the sender, -1 if it is unknown, and the text.
    Mail(i32, String),
    /// The variables server asks for the properties of `web`: answer with [`Host::web`].
    Web,
    /// Whether somebody wants to see where the program is: tell it with [`Host::watch`].
    Watch(bool),
    /// A new version of the program is in this file: answer with [`Host::changed`], in this language.
    Patch(WhenGone, PathBuf, Locale),
    /// An assignment, `NAME=EXPRESSION`: answer with [`Host::changed`], in this language.
    Set(String, Locale),
    /// An order to the debugger: answer with [`Host::debug`].
    Debug {
        /// Whose order it is.
        client: u32,
        /// What the client calls it.
        tag: u32,
        /// The language of the answer.
        locale: Locale,
        /// The order.
        order: String,
    },
    /// The client that was in control of the debugger is gone.
    DebugLeft,
    /// What a person says to a question, by its number; none: nobody answers.
    Reply(u32, Option<String>),
    /// The daemon is gone; the program should end.
    Gone,
}

/// The program's end of the channel.
#[derive(Debug)]
pub struct Host {
    channel: UnixStream,
    decoder: RefCell<Decoder>,
    /// Came while an answer was waited for.
    early: RefCell<std::collections::VecDeque<Incoming>>,
}

impl Host {
    /// Takes standard input, which the daemon has made a socket.
    ///
    /// # Errors
    /// It is none: engines are started by the daemon only.
    pub fn from_standard_input() -> io::Result<Self> {
        let descriptor: OwnedFd = io::stdin().as_fd().try_clone_to_owned()?;
        let channel = UnixStream::from(descriptor);
        channel.local_addr()?;
        // Standard input is empty from now on: what the program starts must not take what the daemon says.
        nix::unistd::dup2_stdin(std::fs::File::open("/dev/null")?)?;
        Ok(Self::new(channel))
    }

    /// Over any socket.
    pub fn new(channel: UnixStream) -> Self {
        Self {
            channel,
            decoder: RefCell::new(Decoder::new(limits::CHANNEL_FRAME_BYTES)),
            early: RefCell::default(),
        }
    }

    /// Readable when [`Host::receive`] may have something.
    pub fn fd(&self) -> BorrowedFd<'_> {
        self.channel.as_fd()
    }

    /// What to begin with. Waits for it.
    ///
    /// # Errors
    /// The daemon is gone, or speaks differently.
    pub fn start(&self) -> io::Result<Start> {
        let frame = self.frame(None)?.ok_or(io::ErrorKind::UnexpectedEof)?;
        match ToProgram::parse(&frame) {
            Some(ToProgram::File(path)) => Ok(Start::File(path.into())),
            Some(ToProgram::Script(text)) => Ok(Start::Script(text.to_owned())),
            Some(ToProgram::Start) => Ok(Start::Direct),
            Some(ToProgram::Debugged(path)) => Ok(Start::Debugged(path.into())),
            Some(
                ToProgram::Direct(_)
                | ToProgram::Mail { .. }
                | ToProgram::Answer(_)
                | ToProgram::Web
                | ToProgram::Watch(_)
                | ToProgram::Patch { .. }
                | ToProgram::Set { .. }
                | ToProgram::Debugpy { .. }
                | ToProgram::Debug { .. }
                | ToProgram::DebugLeft
                | ToProgram::Reply { .. },
            )
            | None => {
                let word = frame.split(':').next().unwrap_or_default();
                Err(io::Error::other(format!(
                    "'{word}' is no way to start a program"
                )))
            }
        }
    }

    /// The next message, waiting at most this long, or for ever. None: nothing came in time.
    ///
    /// # Errors
    /// Those of the socket.
    pub fn receive(&self, wait: Option<Duration>) -> io::Result<Option<Incoming>> {
        if let Some(early) = self.early.borrow_mut().pop_front() {
            return Ok(Some(early));
        }
        let deadline = wait.map(|wait| Instant::now() + wait);
        loop {
            match self.frame(deadline) {
                Ok(None) => return Ok(Some(Incoming::Gone)),
                Ok(Some(frame)) => {
                    if let Some(message) = incoming(&frame) {
                        return Ok(Some(message));
                    }
                }
                Err(error) if is_late(&error) => return Ok(None),
                Err(error) => return Err(error),
            }
        }
    }

    /// Asks the mailbox in the words of [`Question`] and waits for its answer.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn mailbox(&self, words: &str) -> io::Result<String> {
        self.send(FromProgram::Mailbox(words))?;
        loop {
            let frame = self.frame(None)?.ok_or(io::ErrorKind::UnexpectedEof)?;
            if let Some(ToProgram::Answer(answer)) = ToProgram::parse(&frame) {
                return Ok(answer.to_owned());
            }
            self.early.borrow_mut().extend(incoming(&frame));
        }
    }

    /// The next message that has come by now.
    ///
    /// # Errors
    /// Those of the socket.
    pub fn waiting(&self) -> io::Result<Option<Incoming>> {
        if let Some(early) = self.early.borrow_mut().pop_front() {
            return Ok(Some(early));
        }
        let mut decoder = self.decoder.borrow_mut();
        let mut buffer = [0; 4096];
        loop {
            while let Some(frame) = decoder.next().map_err(io::Error::other)? {
                if let Some(message) = incoming(&String::from_utf8_lossy(frame)) {
                    return Ok(Some(message));
                }
            }
            let fd = self.channel.as_raw_fd();
            match nix::sys::socket::recv(fd, &mut buffer, MsgFlags::MSG_DONTWAIT) {
                Ok(0) | Err(Errno::ECONNRESET) => return Ok(Some(Incoming::Gone)),
                Ok(size) => decoder.feed(&buffer[..size]),
                Err(Errno::EAGAIN) => return Ok(None),
                Err(Errno::EINTR) => {}
                Err(error) => return Err(error.into()),
            }
        }
    }

    /// Tells the mailbox something without waiting for its answer, which is dropped when it comes.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn post(&self, question: Question<'_>) -> io::Result<()> {
        self.send(FromProgram::Mailbox(&question.to_string()))
    }

    /// Tells where the program is: a line for people, and a JSON object.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn watch(&self, line: &str, json: &str) -> io::Result<()> {
        self.send(FromProgram::Watch { line, json })
    }

    /// Tells what has become of a new version or an assignment.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn changed(&self, is_changed: bool, text: &str) -> io::Result<()> {
        self.send(FromProgram::Changed {
            is_changed,
            text: shown(text),
        })
    }

    /// Answers an order of a client, or tells all who debug of a state ([`ALL`](crate::protocol::program::ALL)).
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn debug(&self, client: u32, json: &str) -> io::Result<()> {
        self.send(FromProgram::Debug { client, json })
    }

    /// Tells all who debug what breakpoints have written.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn debug_log(&self, json: &str) -> io::Result<()> {
        self.send(FromProgram::DebugLog(json))
    }

    /// Asks a person; the answer comes as [`Incoming::Reply`].
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn question(&self, number: u32, json: &str) -> io::Result<()> {
        self.send(FromProgram::Question { number, json })
    }

    /// Shows output as it is; the newline is part of it.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn print(&self, text: &str) -> io::Result<()> {
        self.send(FromProgram::Print(shown(text)))
    }

    /// Shows a failure.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn error(&self, text: &str) -> io::Result<()> {
        self.send(FromProgram::Error(shown(text)))
    }

    /// An error has come that was told before: the program has failed, and nothing is shown.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn known_error(&self) -> io::Result<()> {
        self.send(FromProgram::Error(""))
    }

    /// Shows an information.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn info(&self, text: &str) -> io::Result<()> {
        self.send(FromProgram::Info(shown(text)))
    }

    /// Says that the program is event-driven from now on.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn events(&self) -> io::Result<()> {
        self.send(FromProgram::Events)
    }

    /// Answers [`Incoming::Web`] with a JSON object.
    ///
    /// # Errors
    /// The daemon is gone.
    pub fn web(&self, json: &str) -> io::Result<()> {
        self.send(FromProgram::Web(json))
    }

    fn send(&self, message: FromProgram<'_>) -> io::Result<()> {
        let payload = message.encode();
        if payload.len() > limits::CHANNEL_FRAME_BYTES {
            // The daemon would take it for the end of the program.
            let why = format!(
                "{} bytes at once are too many: at most {} can be sent",
                payload.len(),
                limits::CHANNEL_FRAME_BYTES
            );
            return Err(io::Error::new(io::ErrorKind::InvalidInput, why));
        }
        (&self.channel).write_all(&encode(&payload))
    }

    /// The next frame; None at the end of the channel; an error of [`is_late`] after the deadline.
    fn frame(&self, deadline: Option<Instant>) -> io::Result<Option<String>> {
        let mut decoder = self.decoder.borrow_mut();
        let mut buffer = [0; 4096];
        loop {
            if let Some(frame) = decoder.next().map_err(io::Error::other)? {
                return Ok(Some(String::from_utf8_lossy(frame).into_owned()));
            }
            let left = deadline.map(|deadline| deadline.saturating_duration_since(Instant::now()));
            // Zero would mean for ever.
            let wait = left.map(|left| left.max(Duration::from_micros(1)));
            self.channel.set_read_timeout(wait)?;
            match (&self.channel).read(&mut buffer) {
                Ok(0) => return Ok(None),
                Ok(size) => decoder.feed(&buffer[..size]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error) if error.kind() == io::ErrorKind::ConnectionReset => return Ok(None),
                Err(error) => return Err(error),
            }
        }
    }
}

/// So much of a text as is shown to people: the daemon would drop the rest.
fn shown(text: &str) -> &str {
    &text[..text.floor_char_boundary(limits::MESSAGE_BYTES)]
}

fn is_late(error: &io::Error) -> bool {
    [io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut].contains(&error.kind())
}

/// What a frame means to a running program. None: nothing, or too late or too early.
fn incoming(frame: &str) -> Option<Incoming> {
    match ToProgram::parse(frame)? {
        ToProgram::Direct(text) => Some(Incoming::Direct(text.to_owned())),
        ToProgram::Mail { hull, text } => Some(Incoming::Mail(hull, text.to_owned())),
        ToProgram::Web => Some(Incoming::Web),
        ToProgram::Watch(is_wanted) => Some(Incoming::Watch(is_wanted)),
        ToProgram::Patch {
            when_gone,
            locale,
            path,
        } => Some(Incoming::Patch(when_gone, path.into(), locale)),
        ToProgram::Set { locale, text } => Some(Incoming::Set(text.to_owned(), locale)),
        ToProgram::Reply { number, text } => Some(Incoming::Reply(number, text.map(str::to_owned))),
        ToProgram::Debug {
            client,
            tag,
            locale,
            order,
        } => Some(Incoming::Debug {
            client,
            tag,
            locale,
            order: order.to_owned(),
        }),
        ToProgram::DebugLeft => Some(Incoming::DebugLeft),
        // A program starts once, and the answer to what was posted is dropped.
        ToProgram::File(_)
        | ToProgram::Script(_)
        | ToProgram::Start
        | ToProgram::Debugged(_)
        | ToProgram::Debugpy { .. }
        | ToProgram::Answer(_) => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pair() -> (UnixStream, Host) {
        let (daemon, program) = UnixStream::pair().unwrap();
        (daemon, Host::new(program))
    }

    fn send(daemon: &mut UnixStream, text: &str) {
        daemon.write_all(&encode(text.as_bytes())).unwrap();
    }

    #[test]
    fn a_program_is_told_its_start_and_what_comes_later() {
        let (mut daemon, host) = pair();
        send(&mut daemon, "file:/a:b.js");
        send(&mut daemon, "unknown:x");
        send(&mut daemon, "mail:-1:a:b");
        assert_eq!(host.start().unwrap(), Start::File("/a:b.js".into()));
        assert_eq!(
            host.receive(None).unwrap(),
            Some(Incoming::Mail(-1, "a:b".to_owned()))
        );
        assert_eq!(host.receive(Some(Duration::ZERO)).unwrap(), None);
        drop(daemon);
        assert_eq!(host.receive(None).unwrap(), Some(Incoming::Gone));
    }

    #[test]
    fn what_is_too_long_does_not_end_the_channel() {
        let (mut daemon, host) = pair();
        let long = "\u{43f}".repeat(limits::CHANNEL_FRAME_BYTES / 2);
        let drain = std::thread::spawn(move || {
            let mut all = Vec::new();
            daemon.read_to_end(&mut all).unwrap();
            all
        });
        host.print(&format!("x{long}")).unwrap();
        let refusal = host.mailbox(&long).unwrap_err();
        assert!(refusal.to_string().contains("too many"), "{refusal}");
        host.print("end\n").unwrap();
        drop(host);
        let mut decoder = Decoder::new(limits::CHANNEL_FRAME_BYTES);
        decoder.feed(&drain.join().unwrap());
        let first = decoder.next().unwrap().unwrap().to_vec();
        // Half of the last character would be one byte more.
        assert_eq!(first.len(), "print:".len() + limits::MESSAGE_BYTES - 1);
        assert!(String::from_utf8(first).is_ok());
        assert_eq!(decoder.next().unwrap(), Some(&b"print:end\n"[..]));
        assert_eq!(decoder.next().unwrap(), None);
    }

    #[test]
    fn what_comes_before_an_answer_is_not_lost() {
        let (mut daemon, host) = pair();
        send(&mut daemon, "direct:x = 1");
        send(&mut daemon, "answer:7");
        assert_eq!(host.mailbox("hull").unwrap(), "7");
        assert_eq!(
            host.receive(None).unwrap(),
            Some(Incoming::Direct("x = 1".to_owned()))
        );
        let mut said = [0; 15];
        daemon.read_exact(&mut said).unwrap();
        assert_eq!(&said, b"12:mailbox:hull");
    }
}
