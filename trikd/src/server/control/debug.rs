//! Requests to the debugger of the diagram that runs.
//!
//! Owns which of them need control, and who gets it. What an order does is known to the diagram alone; here only its first
//! word counts.

use super::Session;
use crate::blame::Blame;
use crate::clients::debugging::OrderId;
use crate::program::child::Language;
use crate::program::{Command, Meeting, Wish};
use crate::protocol::news;
use crate::{limits, log, scripts};
use lang_diagram::debug::order::{NoOrder, Order};
use lang_text::problem::Locale;
use std::fmt;
use std::net::SocketAddr;

/// The word of a request to hear nothing more, and to give up control.
const LEAVE: &str = "leave";
/// The word, with its blank, of a request to run a diagram that is stopped before its first block.
const RUN: &str = "run ";
/// The same of a request to run a Python program under debugpy.
const PYTHON: &str = "python ";

/// Why a request is not passed on to a program.
#[derive(Clone, Debug, Eq, PartialEq)]
enum Refusal {
    /// The computer is not paired.
    NotPaired,
    /// Somebody else is in control.
    Taken(SocketAddr),
    /// The text is no order.
    Order(NoOrder),
    /// There is no such program.
    Program(scripts::Refusal),
    /// The program is neither of blocks nor in JavaScript.
    NoDebugger,
    /// The program is none in Python.
    NoPython,
    /// No port, or no name behind it.
    NoPort,
    /// A secret that is none.
    NoSecret,
}

impl Refusal {
    /// Who can change something about it.
    fn blame(&self) -> Blame {
        match self {
            Self::NotPaired
            | Self::Taken(_)
            | Self::Order(_)
            | Self::NoDebugger
            | Self::NoPython
            | Self::NoPort
            | Self::NoSecret => Blame::Client,
            Self::Program(why) => why.blame(),
        }
    }
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotPaired => out.write_str(news::NOT_PAIRED),
            Self::Taken(who) => out.write_str(&news::has_control(*who)),
            Self::Order(why) => write!(out, "{why}"),
            Self::Program(why) => write!(out, "{why}"),
            Self::NoDebugger => out.write_str(news::NO_DEBUGGER),
            Self::NoPython => out.write_str(news::ONLY_PYTHON),
            Self::NoPort => out.write_str(news::NO_PORT),
            Self::NoSecret => out.write_str(news::NO_SECRET),
        }
    }
}

impl Refusal {
    /// For a client. What clients know by its words stays as it is in all languages.
    fn in_locale(&self, locale: Locale) -> String {
        match self {
            Self::Order(why) => why.words().in_locale(locale).to_owned(),
            Self::Program(why) => why.words().in_locale(locale).to_owned(),
            Self::NotPaired
            | Self::Taken(_)
            | Self::NoDebugger
            | Self::NoPython
            | Self::NoPort
            | Self::NoSecret => self.to_string(),
        }
    }
}

/// Whether a word is one that a program can say to its debugger.
fn is_secret(word: &str) -> bool {
    (1..=limits::DEBUG_SECRET_BYTES).contains(&word.len())
        && word.bytes().all(|byte| byte.is_ascii_alphanumeric())
}

impl Session {
    /// Does what a request asks for, or answers why not; each is answered once.
    pub(super) async fn debug(&self, tag: Option<u32>, text: &str) {
        let Some(tag) = tag else {
            return self.client.not_done(None, news::NO_TAG);
        };
        let asked = OrderId {
            client: self.client.id(),
            tag,
            locale: self.heard,
        };
        if text.trim() == LEAVE {
            self.leave_debugger().await;
            // After a stop that was asked for before, so that motors rest when this is answered.
            let left = Command::Debug(asked, Wish::Left);
            return self.control.programs.send(left).await;
        }
        self.control.clients.debugs(&self.client);
        let done = match (text.strip_prefix(RUN), text.strip_prefix(PYTHON)) {
            (Some(name), _) => self.run_debugged(asked, name).await,
            (None, Some(words)) => self.run_python(asked, words).await,
            (None, None) => self.order(asked, text).await,
        };
        if let Err(why) = done {
            if why.blame() != Blame::Client {
                log::report(&why);
            }
            let why = why.in_locale(self.locale());
            self.client.not_done(Some(tag), &why);
        }
    }

    async fn run_debugged(&self, asked: OrderId, name: &str) -> Result<(), Refusal> {
        self.takes_debugger()?;
        let found = scripts::find(&self.control.scripts, name.as_bytes());
        let path = found.map_err(Refusal::Program)?;
        if !Language::of(&path).has_debugger() {
            return Err(Refusal::NoDebugger);
        }
        self.command(Command::Debug(asked, Wish::Run(path))).await;
        Ok(())
    }

    /// The port of this client that debugpy connects to, perhaps a secret, and the name of the program.
    async fn run_python(&self, asked: OrderId, words: &str) -> Result<(), Refusal> {
        let (port, name) = words.split_once(' ').ok_or(Refusal::NoPort)?;
        let (port, secret) = match port.split_once(':') {
            Some((port, secret)) => (port, Some(secret)),
            None => (port, None),
        };
        let port = port.parse().map_err(|_| Refusal::NoPort)?;
        if !secret.is_none_or(is_secret) {
            return Err(Refusal::NoSecret);
        }
        // To the computer that asks, and to no other.
        let address = SocketAddr::new(self.client.peer.ip(), port);
        self.takes_debugger()?;
        let found = scripts::find(&self.control.scripts, name.as_bytes());
        let path = found.map_err(Refusal::Program)?;
        if Language::of(&path) != Language::Python {
            return Err(Refusal::NoPython);
        }
        let place = Meeting {
            address,
            secret: secret.map(str::to_owned),
        };
        let wish = Wish::Debugpy(place, path);
        self.command(Command::Debug(asked, wish)).await;
        Ok(())
    }

    async fn order(&self, asked: OrderId, text: &str) -> Result<(), Refusal> {
        let order = Order::parse(text).map_err(Refusal::Order)?;
        let command = Command::Debug(asked, Wish::Order(text.to_owned()));
        if !order.is_for_control() {
            self.control.programs.send(command).await;
            return Ok(());
        }
        self.takes_debugger()?;
        self.command(command).await;
        if order == Order::Detach {
            self.control.clients.release_debugger(&self.client);
        }
        Ok(())
    }

    /// This client is in control now, or may not be.
    fn takes_debugger(&self) -> Result<(), Refusal> {
        if !self.is_paired() {
            return Err(Refusal::NotPaired);
        }
        let taken = self.control.clients.take_debugger(&self.client);
        taken.map_err(Refusal::Taken)
    }

    /// This client hears nothing more, and is not in control; the program learns that before anybody else is.
    pub(super) async fn leave_debugger(&self) {
        let clients = &self.control.clients;
        if clients.has_debugger(&self.client) {
            self.control.programs.send(Command::DebugLeft).await;
            clients.release_debugger(&self.client);
        }
        clients.debugs_no_more(&self.client);
    }
}
