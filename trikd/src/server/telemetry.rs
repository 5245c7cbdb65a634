//! Port 9000: answers questions about sensors. Asks nothing of the tree while nobody asks here.

use super::Guest;
use crate::clients::Client;
use crate::connection::{self, Handler, VERSION};
use crate::daemon::Daemon;
use crate::outbox::Outbox;
use crate::protocol::telemetry::Request;
use crate::{limits, log};
use std::rc::Rc;

struct Telemetry {
    daemon: Rc<Daemon>,
    client: Rc<Client>,
}

impl Handler for Telemetry {
    async fn frame(&mut self, frame: &[u8]) {
        let out = &self.client.outbox;
        // Who does not read its answers is not answered further.
        out.room().await;
        self.client.count();
        let answer = match Request::parse(frame) {
            Request::Keepalive => return,
            Request::Version => return out.send(VERSION),
            Request::Unknown => String::new(),
            Request::Data => return out.push(self.daemon.sampler.all_data().await),
            Request::Ports => self.daemon.sampler.snapshot().await.port_names(),
            Request::Key(name) => self.daemon.sampler.snapshot().await.key(name),
            Request::Sensor(name) => self.daemon.sampler.snapshot().await.sensor(name),
        };
        out.send(answer.as_bytes());
    }
}

/// Serves one client.
pub async fn serve(daemon: Rc<Daemon>, guest: Guest) {
    let outbox = Rc::new(Outbox::new(limits::OUTBOX_BYTES));
    let client = daemon.clients.add("telemetry", guest.peer, outbox.clone());
    tracing::info!(target: log::CLIENTS, "telemetry: {} has come", guest.peer);
    let mut handler = Telemetry {
        daemon: daemon.clone(),
        client,
    };
    let why = connection::serve(
        guest.stream,
        limits::SMALL_FRAME_BYTES,
        &daemon.held,
        &outbox,
        &mut handler,
    )
    .await;
    tracing::info!(target: log::CLIENTS, "telemetry: {} has left: {why}", guest.peer);
    drop(guest.seat);
}
