//! Port 8888: programs come, are started and stopped; what they say goes to all clients here.

use super::Guest;
use crate::clients::{Client, Watching};
use crate::connection::{self, Handler, VERSION};
use crate::daemon::Daemon;
use crate::feedback::Moment;
use crate::outbox::Outbox;
use crate::program::Command;
use crate::protocol::control::Request;
use crate::protocol::news;
use crate::{limits, log, scripts};
use std::rc::Rc;
use tokio::sync::oneshot;

struct Control {
    daemon: Rc<Daemon>,
    client: Rc<Client>,
}

impl Control {
    fn error(&self, text: &str) {
        self.client.outbox.send(format!("error: {text}").as_bytes());
    }

    /// Whether this computer may do more than look; says so if not.
    fn may_control(&self) -> bool {
        let may = self.daemon.access.may_control(self.client.peer.ip());
        if !may {
            tracing::warn!(target: log::CLIENTS, "control: {} is not paired", self.client.peer);
            self.error(news::NOT_PAIRED);
        }
        may
    }

    /// Programs in the order in which they came.
    async fn command(&self, command: Command) {
        self.daemon.clients.takes_control(self.client.peer);
        self.daemon.programs.send(command).await;
    }

    /// What runs, when everything is done that was asked for before.
    async fn status(&self) {
        let (answer, told) = oneshot::channel();
        self.daemon.programs.send(Command::Ask(answer)).await;
        if let Ok(text) = told.await {
            self.client
                .outbox
                .send(format!("status: {text}").as_bytes());
        }
    }

    async fn keep(&self, name: &[u8], content: &[u8]) {
        let folder = self.daemon.settings.scripts.clone();
        let (name, content) = (name.to_owned(), content.to_owned());
        // A disk may be slow; everybody else is served meanwhile.
        let kept =
            tokio::task::spawn_blocking(move || scripts::keep(&folder, &name, &content)).await;
        match kept {
            Ok(Ok(path)) => {
                self.daemon.feedback.show(Moment::Uploaded);
                tracing::info!(
                    target: log::PROGRAMS,
                    "{} is uploaded by {}",
                    path.display(),
                    self.client.peer
                );
            }
            Ok(Err(why)) => {
                tracing::warn!(target: log::PROGRAMS, "an upload by {} is refused: {why}", self.client.peer);
                self.error(&why);
            }
            Err(error) => self.error(&format!("{}{error}", news::UPLOAD_FAILED)),
        }
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

impl Handler for Control {
    async fn frame(&mut self, frame: &[u8]) {
        self.client.count();
        let request = Request::parse(frame);
        let begin = &frame[..frame.len().min(limits::LOG_REQUEST_BYTES)];
        tracing::debug!(
            target: log::CLIENTS,
            "control: {} asks: {}",
            self.client.peer,
            String::from_utf8_lossy(begin)
        );
        match request {
            Request::Keepalive | Request::Unknown => return,
            Request::Version => return self.client.outbox.send(VERSION),
            Request::ConfigVersion => {
                let answer = format!("configVersion: {}", self.daemon.settings.config_version);
                return self.client.outbox.send(answer.as_bytes());
            }
            Request::Status => return self.status().await,
            Request::Watch(is_wanted) => {
                let watching = if is_wanted {
                    Watching::Lines
                } else {
                    Watching::No
                };
                return self.client.watch(watching);
            }
            // Whoever sees danger may stop the robot.
            Request::Stop => return self.command(Command::Stop("a client")).await,
            _ => {}
        }
        if !self.may_control() {
            return;
        }
        match request {
            Request::File { name, content } => self.keep(name, content).await,
            Request::Run(name) => match scripts::find(&self.daemon.settings.scripts, name) {
                Ok(path) => self.command(Command::Run(path)).await,
                Err(why) => {
                    // What runs ends all the same: the person wants to see something else.
                    self.command(Command::Stop("a client")).await;
                    self.error(&why);
                }
            },
            Request::DirectScript(code) => self.command(Command::Script(text(code))).await,
            Request::Direct(code) => self.command(Command::Direct(text(code))).await,
            _ => {}
        }
    }

    fn complaint(&self, reason: &str) -> Option<Vec<u8>> {
        Some(format!("error: {reason}").into_bytes())
    }
}

/// Serves one client.
pub async fn serve(daemon: Rc<Daemon>, guest: Guest) {
    let outbox = Rc::new(Outbox::new(limits::OUTBOX_BYTES));
    let client = daemon.clients.add("control", guest.peer, outbox.clone());
    tracing::info!(target: log::CLIENTS, "control: {} has come", guest.peer);
    let frame_bytes = usize::from(daemon.settings.upload_mib) << 20;
    let mut handler = Control {
        daemon: daemon.clone(),
        client,
    };
    let why = connection::serve(
        guest.stream,
        frame_bytes,
        &daemon.held,
        &outbox,
        &mut handler,
    )
    .await;
    tracing::info!(target: log::CLIENTS, "control: {} has left: {why}", guest.peer);
    drop(guest.seat);
}
