//! The register of connected clients, through which messages to all go and which the status shows.
//!
//! `debugging` has those who debug a diagram. Knows no sockets and no frames.

pub mod debugging;

use crate::outbox::{Latest, Outbox};
use crate::protocol::news;
use frame::encode;
use page::seats::Whom;
use std::cell::{Cell, RefCell};
use std::fmt::Write;
use std::net::{IpAddr, SocketAddr};
use std::rc::{Rc, Weak};
use std::time::Instant;

/// One connection.
#[derive(Debug)]
pub struct Client {
    id: u32,
    /// Which port it came to.
    pub port: &'static str,
    /// Its other end.
    pub peer: SocketAddr,
    /// What waits to be sent to it.
    pub outbox: Rc<Outbox>,
    since: Instant,
    requests: Cell<u32>,
    watches: Cell<Watching>,
    /// It has missed something of what it watches.
    is_behind: Cell<bool>,
    /// It hears of the debugger.
    debugs: Cell<bool>,
    /// A person is there who answers.
    answers: Cell<bool>,
}

/// What a client wants to know of the running diagram.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Watching {
    /// Nothing.
    #[default]
    No,
    /// Lines for people, as frames `info: ...`.
    Lines,
    /// JSON, an object on each line, without frames.
    Objects,
}

impl Client {
    /// Its number, from 1; no other client has it.
    pub fn id(&self) -> u32 {
        self.id
    }

    /// Wants to know where the running diagram is, or no more.
    pub fn watch(&self, watching: Watching) {
        self.watches.set(watching);
    }

    /// Shows where the diagram is, now or when it reads again: then the newest counts.
    fn show(&self, frame: Rc<[u8]>) {
        if !self.outbox.push_latest(Latest::Place, frame) {
            self.is_behind.set(true);
        }
    }

    /// A person is there who answers questions, or no more.
    pub fn answers(&self, is_there: bool) {
        self.answers.set(is_there);
    }

    /// Counts a request.
    pub fn count(&self) {
        self.requests.set(self.requests.get().saturating_add(1));
    }
}

/// All connections.
#[derive(Debug, Default)]
pub struct Clients {
    all: RefCell<Vec<Weak<Client>>>,
    /// Who started the program or stopped it last.
    in_control: Cell<Option<SocketAddr>>,
    /// How many there were.
    count: Cell<u32>,
    /// Who is in control of the debugger.
    debugger: Cell<Option<debugging::Holder>>,
}

impl Clients {
    /// Registers a connection as long as the result lives.
    pub fn add(&self, port: &'static str, peer: SocketAddr, outbox: Rc<Outbox>) -> Rc<Client> {
        self.count.set(self.count.get().wrapping_add(1).max(1));
        let client = Rc::new(Client {
            id: self.count.get(),
            port,
            peer,
            outbox,
            since: Instant::now(),
            requests: Cell::new(0),
            watches: Cell::default(),
            is_behind: Cell::default(),
            debugs: Cell::default(),
            answers: Cell::default(),
        });
        let mut all = self.all.borrow_mut();
        all.retain(|other| other.strong_count() > 0);
        all.push(Rc::downgrade(&client));
        client
    }

    /// Remembers who commands.
    pub fn takes_control(&self, peer: SocketAddr) {
        self.in_control.set(Some(peer));
    }

    /// For whom a place at that address is.
    pub fn whom(&self, ip: IpAddr) -> Whom {
        match self.in_control.get() {
            Some(peer) if peer.ip() == ip => Whom::InControl,
            _ if ip.is_loopback() => Whom::Own,
            _ => Whom::Anybody,
        }
    }

    fn living(&self) -> Vec<Rc<Client>> {
        self.all.borrow().iter().filter_map(Weak::upgrade).collect()
    }

    /// Sends a payload to every client of the control port.
    pub fn broadcast(&self, payload: &[u8]) {
        let frame: Rc<[u8]> = encode(payload).into();
        for client in self.living() {
            if client.port == "control" {
                client.outbox.push(frame.clone());
            }
        }
    }

    /// Sends a payload to one client, which may have left.
    pub fn tell(&self, id: u32, payload: &[u8]) {
        if let Some(client) = self.living().iter().find(|client| client.id == id) {
            client.outbox.push(encode(payload).into());
        }
    }

    /// Passes a question on to those who answer; false: nobody does.
    pub fn ask(&self, json: &str) -> bool {
        let frame: Rc<[u8]> = encode(format!("question: {json}").as_bytes()).into();
        let living = self.living();
        let asked = living.iter().filter(|client| client.answers.get());
        asked
            .map(|client| client.outbox.push(frame.clone()))
            .count()
            > 0
    }

    /// Whether anybody wants to know where the running diagram is.
    pub fn are_watching(&self) -> bool {
        self.living()
            .iter()
            .any(|client| client.watches.get() != Watching::No)
    }

    /// Whether somebody who watches has missed something and reads again; that is forgotten with this call.
    pub fn take_behind(&self) -> bool {
        let living = self.living();
        let back = living
            .iter()
            .filter(|client| client.is_behind.get() && client.outbox.is_empty());
        back.map(|client| client.is_behind.set(false)).count() > 0
    }

    /// Tells those who want to know where the running diagram is.
    pub fn send_to_watchers(&self, line: &str, json: &str) {
        let frame: Rc<[u8]> = encode(format!("info: {line}").as_bytes()).into();
        let object: Rc<[u8]> = format!("{json}\n").into_bytes().into();
        for client in self.living() {
            match client.watches.get() {
                Watching::No => {}
                Watching::Lines => client.show(frame.clone()),
                Watching::Objects => client.show(object.clone()),
            }
        }
    }

    /// Lines for the status that every client may ask for: who commands, and who debugs.
    pub fn describe_control(&self) -> String {
        let commands = self.in_control.get();
        let living = self.living();
        let commands = commands.filter(|peer| living.iter().any(|client| client.peer == *peer));
        let debugs = self.debugger.get();
        let debugs = debugs.map(|holder| news::debugs(&holder.peer().to_string()));
        let lines = [commands.map(news::commands), debugs];
        lines.into_iter().flatten().collect()
    }

    /// Lines for the status.
    pub fn describe(&self) -> String {
        let mut text = String::new();
        for client in self.living() {
            let controls = self.in_control.get() == Some(client.peer);
            let _ = writeln!(
                text,
                "client {} {} for {} s, {} requests{}",
                client.peer,
                client.port,
                client.since.elapsed().as_secs(),
                client.requests.get(),
                if controls { ", in control" } else { "" }
            );
        }
        text
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_clients_that_are_there_get_messages_to_all() {
        let clients = Clients::default();
        let peer: SocketAddr = "10.0.0.1:5".parse().unwrap();
        let outbox = || Rc::new(Outbox::new(100));
        let (one, other) = (outbox(), outbox());
        let control = clients.add("control", peer, one.clone());
        let telemetry = clients.add("telemetry", peer, other.clone());
        drop(clients.add("control", peer, outbox()));
        control.count();
        clients.takes_control(peer);
        clients.broadcast(b"hi");
        other.close();
        let runtime = tokio::runtime::Builder::new_current_thread()
            .build()
            .unwrap();
        assert_eq!(runtime.block_on(one.next()).as_deref(), Some(&b"2:hi"[..]));
        assert_eq!(runtime.block_on(other.next()), None);
        let text = clients.describe();
        assert!(
            text.starts_with("client 10.0.0.1:5 control for 0 s, 1 requests, in control\n"),
            "{text}"
        );
        assert_eq!(text.lines().count(), 2);
        drop(telemetry);
        // What all may ask for: who commands, while that client is there, and who debugs.
        assert_eq!(clients.describe_control(), "control 10.0.0.1:5\n");
        clients.take_debugger(&control).unwrap();
        assert_eq!(
            clients.describe_control(),
            "control 10.0.0.1:5\ndebugger 10.0.0.1:5 is in control\n"
        );
        clients.release_debugger(&control);
        drop(control);
        assert_eq!(clients.describe_control(), "");
    }
}
