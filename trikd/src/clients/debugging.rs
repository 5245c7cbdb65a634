//! Clients that debug the running diagram: those that hear of it, and the one in control.
//!
//! Owns who is in control, and what all hear when that changes. Knows no orders and no program.

use super::{Client, Clients};
use crate::limits;
use crate::outbox::Latest;
use frame::encode;
use lang_text::json::Object;
use lang_text::problem::Locale;
use std::net::SocketAddr;
use std::rc::Rc;

/// A client by its number, which no other client ever has.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct Holder {
    id: u32,
    peer: SocketAddr,
}

impl Holder {
    /// Where it is.
    pub fn peer(&self) -> SocketAddr {
        self.peer
    }
}

/// An order, by the client that gave it and what it calls it.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub struct OrderId {
    /// The number of the client.
    pub client: u32,
    /// What the client calls it.
    pub tag: u32,
    /// The language that the client wants; none: that of the robot.
    pub locale: Option<Locale>,
}

/// The frame of something for clients that debug.
fn frame(json: &str) -> Rc<[u8]> {
    encode(format!("debug: {json}").as_bytes()).into()
}

fn object() -> Object {
    Object::new(limits::DEBUG_CHARACTERS_MAX)
}

/// Tells which client is in control, as all who debug hear it.
fn control(holder: Option<SocketAddr>) -> String {
    match holder {
        Some(peer) => object().text("control", &peer.to_string()).done(),
        None => object().plain("control", "null").done(),
    }
}

/// The answer to an order that the daemon itself answers; a reason, if it is not carried out.
fn answer(tag: Option<u32>, why: Option<&str>) -> String {
    let told = object();
    let told = match why {
        Some(why) => told.text("why", why),
        None => told,
    };
    let told = match tag {
        Some(tag) => told.plain("to", tag),
        None => told.plain("to", "null"),
    };
    told.plain("done", why.is_none()).done()
}

impl Client {
    /// Answers an order that is not.
    pub fn not_done(&self, tag: Option<u32>, why: &str) {
        self.outbox.push(frame(&answer(tag, Some(why))));
    }
}

impl Clients {
    /// This client hears from now on what happens to the diagram that is debugged, and who is in control.
    pub fn debugs(&self, client: &Client) {
        if !client.debugs.replace(true)
            && let Some(holder) = self.debugger.get()
        {
            client.outbox.push(frame(&control(Some(holder.peer))));
        }
    }

    /// This client takes control, if nobody else has it.
    ///
    /// # Errors
    /// The client that has it.
    pub fn take_debugger(&self, client: &Client) -> Result<(), SocketAddr> {
        match self.debugger.get() {
            Some(holder) if holder.id == client.id => Ok(()),
            Some(holder) => Err(holder.peer),
            None => {
                self.set_debugger(Some(Holder {
                    id: client.id,
                    peer: client.peer,
                }));
                Ok(())
            }
        }
    }

    /// Whether this client is in control.
    pub fn has_debugger(&self, client: &Client) -> bool {
        self.debugger
            .get()
            .is_some_and(|holder| holder.id == client.id)
    }

    /// This client is no longer in control, if it was.
    pub fn release_debugger(&self, client: &Client) {
        if self.has_debugger(client) {
            self.set_debugger(None);
        }
    }

    /// This client hears nothing more.
    pub fn debugs_no_more(&self, client: &Client) {
        client.debugs.set(false);
    }

    fn set_debugger(&self, holder: Option<Holder>) {
        self.debugger.set(holder);
        let holder = holder.map(|holder| holder.peer);
        self.tell_latest(Latest::Control, &control(holder));
    }

    /// Tells all who debug of a state, which makes older ones pointless.
    pub fn tell_state(&self, json: &str) {
        self.tell_latest(Latest::State, json);
    }

    fn tell_latest(&self, kind: Latest, json: &str) {
        let frame = frame(json);
        for client in self.living().iter().filter(|client| client.debugs.get()) {
            client.outbox.push_latest(kind, frame.clone());
        }
    }

    /// Tells all who debug of something that slow ones may miss.
    pub fn tell_log(&self, json: &str) {
        let frame = frame(json);
        for client in self.living().iter().filter(|client| client.debugs.get()) {
            client.outbox.push(frame.clone());
        }
    }

    /// The answer of the program to an order; the client that gave it may have left.
    pub fn tell_answer(&self, client: u32, json: &str) {
        if let Some(client) = self.living().iter().find(|found| found.id == client) {
            client.outbox.push(frame(json));
        }
    }

    /// Answers an order that is carried out.
    pub fn debug_done(&self, asked: OrderId) {
        self.tell_answer(asked.client, &answer(Some(asked.tag), None));
    }

    /// Answers an order to run a program that is in this folder.
    pub fn debug_begun(&self, asked: OrderId, folder: &str) {
        let told = object().text("folder", folder).plain("to", asked.tag);
        self.tell_answer(asked.client, &told.plain("done", true).done());
    }

    /// Answers an order that is not carried out.
    pub fn debug_refused(&self, asked: OrderId, why: &str) {
        self.tell_answer(asked.client, &answer(Some(asked.tag), Some(why)));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::outbox::Outbox;

    fn said(client: &Client) -> Vec<String> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .build()
            .unwrap();
        client.outbox.send(b"end");
        let next = || runtime.block_on(client.outbox.next()).unwrap();
        let texts = std::iter::from_fn(|| {
            let text = String::from_utf8(next().to_vec()).unwrap();
            let text = text.split_once(':').unwrap().1.to_owned();
            (text != "end").then_some(text)
        });
        texts.collect()
    }

    #[test]
    fn one_is_in_control_and_the_others_hear_who() {
        let clients = Clients::default();
        let client = |port: u16| {
            let peer = SocketAddr::from(([10, 0, 0, 1], port));
            clients.add("control", peer, Rc::new(Outbox::new(1000)))
        };
        let (one, two, quiet) = (client(1), client(2), client(3));
        clients.debugs(&one);
        assert_eq!(clients.take_debugger(&one), Ok(()));
        assert_eq!(clients.take_debugger(&one), Ok(()));
        clients.debugs(&two);
        assert_eq!(clients.take_debugger(&two), Err(one.peer));
        clients.release_debugger(&two);
        assert!(clients.has_debugger(&one));
        assert_eq!(said(&one), ["debug: {\"control\":\"10.0.0.1:1\"}"]);
        assert_eq!(said(&two), ["debug: {\"control\":\"10.0.0.1:1\"}"]);
        clients.release_debugger(&one);
        clients.debugs_no_more(&one);
        assert_eq!(clients.take_debugger(&two), Ok(()));
        assert_eq!(said(&one), ["debug: {\"control\":null}"]);
        let heard = said(&two);
        assert_eq!(heard.len(), 2, "{heard:?}");
        clients.debug_refused(
            OrderId {
                client: two.id,
                tag: 7,
                locale: None,
            },
            "a \"b\"",
        );
        clients.debug_done(OrderId {
            client: two.id,
            tag: 8,
            locale: None,
        });
        assert_eq!(
            said(&two),
            [
                "debug: {\"why\":\"a \\\"b\\\"\",\"to\":7,\"done\":false}",
                "debug: {\"to\":8,\"done\":true}"
            ]
        );
        assert!(said(&quiet).is_empty(), "who does not debug hears nothing");
    }
}
