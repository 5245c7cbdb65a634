//! Requests to the debugger of the diagram that runs.
//!
//! Owns which of them need control, and who gets it. What an order does is known to the diagram alone; here only its first
//! word counts.

use super::Session;
use crate::clients::debugging::Asked;
use crate::program::child::Language;
use crate::program::{Command, Wish};
use crate::protocol::news;
use crate::scripts;
use lang_diagram::debug::order::Order;

/// The word of a request to hear nothing more, and to give up control.
const LEAVE: &str = "leave";
/// The word, with its blank, of a request to run a diagram that is stopped before its first block.
const RUN: &str = "run ";

impl Session {
    /// Does what a request asks for, or answers why not; each is answered once.
    pub(super) async fn debug(&self, tag: Option<u32>, text: &str) {
        let Some(tag) = tag else {
            return self.client.not_done(None, news::NO_TAG);
        };
        if text.trim() == LEAVE {
            self.leave_debugger().await;
            return self.client.done(tag);
        }
        self.control.clients.debugs(&self.client);
        let asked = Asked {
            client: self.client.id(),
            tag,
        };
        let done = match text.strip_prefix(RUN) {
            Some(name) => self.run_debugged(asked, name).await,
            None => self.order(asked, text).await,
        };
        if let Err(why) = done {
            self.client.not_done(Some(tag), &why);
        }
    }

    async fn run_debugged(&self, asked: Asked, name: &str) -> Result<(), String> {
        self.takes_debugger()?;
        let found = scripts::find(&self.control.scripts, name.as_bytes());
        let path = found.map_err(|why| why.to_string())?;
        if Language::of(&path) != Language::Diagram {
            return Err(news::ONLY_DIAGRAMS.to_owned());
        }
        self.command(Command::Debug(asked, Wish::Run(path))).await;
        Ok(())
    }

    async fn order(&self, asked: Asked, text: &str) -> Result<(), String> {
        let order = Order::parse(text).map_err(|why| why.to_string())?;
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
    fn takes_debugger(&self) -> Result<(), String> {
        if !self.is_paired() {
            return Err(news::NOT_PAIRED.to_owned());
        }
        let taken = self.control.clients.take_debugger(&self.client);
        taken.map_err(news::has_control)
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
