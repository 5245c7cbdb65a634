//! What is around a program's process: the daemon, or a terminal.
//!
//! Owns the two ways in which output leaves and messages come in. Knows no engines.

use crate::host::{Host, Incoming};
use crate::protocol::program::mailbox::Question;
use std::cell::{Cell, RefCell};
use std::collections::VecDeque;
use std::io::{self, Write};
use std::os::fd::BorrowedFd;
use std::os::unix::net::UnixStream;
use std::time::Duration;

/// Where messages and answers come from. Asked by one thread only.
pub trait Outside {
    /// Readable when [`Outside::receive`] may have something.
    fn fd(&self) -> Option<BorrowedFd<'_>>;

    /// The next message, if there is one by now.
    ///
    /// # Errors
    /// Those of the connection.
    fn receive(&self) -> io::Result<Option<Incoming>>;

    /// Asks the mailbox, in the words of [`Host::mailbox`].
    ///
    /// # Errors
    /// Those of the connection.
    fn mailbox(&self, words: &str) -> io::Result<String>;
}

/// Where output goes. All threads share one, and each call is one whole message.
pub trait Output: Send {
    /// Output as it is; the newline is part of it.
    ///
    /// # Errors
    /// Nobody is there to read it.
    fn print(&self, text: &str) -> io::Result<()>;
    /// A failure that does not end the program.
    ///
    /// # Errors
    /// As [`Output::print`].
    fn error(&self, text: &str) -> io::Result<()>;
    /// Something a person may want to know.
    ///
    /// # Errors
    /// As [`Output::print`].
    fn info(&self, text: &str) -> io::Result<()>;
    /// The program is event-driven from now on.
    ///
    /// # Errors
    /// As [`Output::print`].
    fn events(&self) -> io::Result<()>;
    /// The variables for web pages.
    ///
    /// # Errors
    /// As [`Output::print`].
    fn web(&self, json: &str) -> io::Result<()>;
    /// The answer to an order of this client, or a state for all who debug; without a daemon nobody does.
    ///
    /// # Errors
    /// As [`Output::print`].
    fn debug(&self, _client: u32, _json: &str) -> io::Result<()> {
        Ok(())
    }
}

/// The daemon, over the channel of the process.
#[derive(Debug)]
pub struct Daemon<'a> {
    host: &'a Host,
}

impl<'a> Daemon<'a> {
    /// Takes over the channel: nobody else may read it or write to it from now on.
    pub fn new(host: &'a Host) -> Self {
        Self { host }
    }

    /// The other direction, for other threads.
    ///
    /// # Errors
    /// No more descriptors.
    pub fn output(&self) -> io::Result<Host> {
        let channel = self.host.fd().try_clone_to_owned()?;
        Ok(Host::new(UnixStream::from(channel)))
    }
}

impl Outside for Daemon<'_> {
    fn fd(&self) -> Option<BorrowedFd<'_>> {
        Some(self.host.fd())
    }

    fn receive(&self) -> io::Result<Option<Incoming>> {
        self.host.receive(Some(Duration::ZERO))
    }

    fn mailbox(&self, words: &str) -> io::Result<String> {
        self.host.mailbox(words)
    }
}

impl Output for Host {
    fn print(&self, text: &str) -> io::Result<()> {
        Host::print(self, text)
    }

    fn error(&self, text: &str) -> io::Result<()> {
        Host::error(self, text)
    }

    fn info(&self, text: &str) -> io::Result<()> {
        Host::info(self, text)
    }

    fn events(&self) -> io::Result<()> {
        Host::events(self)
    }

    fn web(&self, json: &str) -> io::Result<()> {
        Host::web(self, json)
    }

    fn debug(&self, client: u32, json: &str) -> io::Result<()> {
        Host::debug(self, client, json)
    }
}

/// Nobody: a mailbox whose only robot is this one.
#[derive(Debug, Default)]
pub struct Alone {
    hull: Cell<i32>,
    mail: RefCell<VecDeque<(i32, String)>>,
}

impl Outside for Alone {
    fn fd(&self) -> Option<BorrowedFd<'_>> {
        None
    }

    fn receive(&self) -> io::Result<Option<Incoming>> {
        let mail = self.mail.borrow_mut().pop_front();
        Ok(mail.map(|(hull, text)| Incoming::Mail(hull, text)))
    }

    fn mailbox(&self, words: &str) -> io::Result<String> {
        let Some(question) = Question::parse(words) else {
            return Ok(String::new());
        };
        Ok(match question {
            Question::Send { hull, text } => {
                let own = self.hull.get();
                if hull.is_some_and(|hull| hull == -1 || hull == own) {
                    self.mail.borrow_mut().push_back((own, text.to_owned()));
                }
                String::new()
            }
            Question::Join { hull, .. } => {
                if hull >= 0 {
                    self.hull.set(hull);
                }
                String::new()
            }
            Question::SetHull(hull) => {
                self.hull.set(hull);
                String::new()
            }
            Question::Hull => self.hull.get().to_string(),
            Question::Ip => "127.0.0.1".to_owned(),
            Question::Connected => "0".to_owned(),
            Question::Enabled => "1".to_owned(),
            // There is no other robot.
            Question::Connect { .. } | Question::Server | Question::Renew => String::new(),
        })
    }
}

/// Standard output and standard error.
#[derive(Clone, Copy, Debug)]
pub struct Terminal;

impl Output for Terminal {
    fn print(&self, text: &str) -> io::Result<()> {
        let mut out = io::stdout().lock();
        out.write_all(text.as_bytes())?;
        out.flush()
    }

    fn error(&self, text: &str) -> io::Result<()> {
        writeln!(io::stderr(), "error: {text}")
    }

    fn info(&self, text: &str) -> io::Result<()> {
        writeln!(io::stderr(), "info: {text}")
    }

    fn events(&self) -> io::Result<()> {
        Ok(())
    }

    fn web(&self, _json: &str) -> io::Result<()> {
        Ok(())
    }
}
