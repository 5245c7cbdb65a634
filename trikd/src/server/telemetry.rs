//! Port 9000: answers questions about sensors. Asks nothing of the tree while nobody asks here.

use super::Guest;
use crate::clients::{Client, Clients};
use crate::connection::{self, Handler, Held, VERSION};
use crate::outbox::Outbox;
use crate::protocol::telemetry::Request;
use crate::sampler::Sampler;
use crate::{limits, log};
use std::rc::Rc;

/// What this port works with.
#[derive(Debug)]
pub struct Telemetry {
    /// The register of connections.
    pub clients: Rc<Clients>,
    /// Bytes of half frames.
    pub held: Rc<Held>,
    /// What the robot senses.
    pub sampler: Rc<Sampler>,
}

/// One connection.
struct Session {
    sampler: Rc<Sampler>,
    client: Rc<Client>,
}

impl Handler for Session {
    async fn frame(&mut self, frame: &[u8]) {
        let out = &self.client.outbox;
        // Who does not read its answers is not answered further.
        out.room().await;
        self.client.count();
        let answer = match Request::parse(frame) {
            Request::Keepalive => return,
            Request::Version => return out.send(VERSION),
            Request::Unknown => String::new(),
            Request::Data => return out.push(self.sampler.all_data().await),
            Request::Ports => self.sampler.snapshot().await.port_names(),
            Request::Key(name) => self.sampler.snapshot().await.key(name),
            Request::Sensor(name) => self.sampler.snapshot().await.sensor(name),
        };
        out.send(answer.as_bytes());
    }
}

/// Serves one client.
pub async fn serve(telemetry: Rc<Telemetry>, guest: Guest) {
    let outbox = Rc::new(Outbox::new(limits::OUTBOX_BYTES));
    let client = telemetry
        .clients
        .add("telemetry", guest.peer, outbox.clone());
    tracing::info!(target: log::CLIENTS, "telemetry: {} has come", guest.peer);
    let mut handler = Session {
        sampler: telemetry.sampler.clone(),
        client,
    };
    let why = connection::serve(
        guest.stream,
        limits::SMALL_FRAME_BYTES,
        &telemetry.held,
        &outbox,
        &mut handler,
    )
    .await;
    tracing::info!(target: log::CLIENTS, "telemetry: {} has left: {why}", guest.peer);
    drop(guest.seat);
}
