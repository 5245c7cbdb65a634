//! Port 9000: answers questions about sensors; recordings are `recordings`'. Asks nothing of the tree while nobody asks here.

use super::Guest;
use super::recordings::{Recordings, Sending};
use crate::clients::{Client, Clients};
use crate::connection::{self, Handler, Held, VERSION};
use crate::outbox::Outbox;
use crate::protocol::telemetry::{Request, list};
use crate::sampler::Sampler;
use crate::tree::value;
use crate::{limits, log};
use std::path::PathBuf;
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
    /// What has happened, and what happens.
    pub recordings: Rc<Recordings>,
    /// Where the tree is mounted.
    pub tree: PathBuf,
}

/// One connection.
struct Session {
    telemetry: Rc<Telemetry>,
    client: Rc<Client>,
    sending: Sending,
}

impl Session {
    /// A port, or any node by its path.
    async fn sensor(&self, name: &str) -> String {
        let answer = self.telemetry.sampler.snapshot().await.sensor(name);
        if !answer.ends_with(':') || name.len() > limits::NODE_PATH_BYTES {
            return answer;
        }
        let (tree, path) = (self.telemetry.tree.clone(), name.to_owned());
        let read = tokio::task::spawn_blocking(move || value(&tree, &path)).await;
        match read.ok().flatten() {
            Some(words) => format!("sensor:{name}:{}", list(&words)),
            None => answer,
        }
    }
}

impl Handler for Session {
    async fn frame(&mut self, frame: &[u8]) {
        let out = self.client.outbox.clone();
        // A client that does not read its answers is not answered further.
        out.room().await;
        self.client.count();
        let sampler = &self.telemetry.sampler;
        let answer = match Request::parse(frame) {
            Request::Keepalive => return,
            Request::Version => return out.send(VERSION),
            Request::Unknown => String::new(),
            Request::Data => return out.push(sampler.all_data().await),
            Request::Ports => sampler.snapshot().await.port_names(),
            Request::Key(name) => sampler.snapshot().await.key(name),
            Request::Sensor(name) => self.sensor(name).await,
            Request::Stream(wanted) => return self.sending.stream(wanted),
            Request::Box => return self.sending.last_minutes(),
        };
        out.send(answer.as_bytes());
    }
}

/// Serves one client.
pub async fn serve(telemetry: Rc<Telemetry>, mut guest: Guest) {
    let outbox = Rc::new(Outbox::new(limits::OUTBOX_BYTES));
    let client = telemetry
        .clients
        .add("telemetry", guest.peer, outbox.clone());
    tracing::info!(target: log::CLIENTS, "telemetry: {} has come", guest.peer);
    let mut handler = Session {
        telemetry: telemetry.clone(),
        sending: Sending::new(telemetry.recordings.clone(), client.clone()),
        client,
    };
    let why = connection::serve(
        guest.stream,
        &guest.begun,
        &mut guest.seat,
        limits::SMALL_FRAME_BYTES,
        &telemetry.held,
        &outbox,
        &mut handler,
    )
    .await;
    tracing::info!(target: log::CLIENTS, "telemetry: {} has left: {why}", guest.peer);
    drop(guest.seat);
}
