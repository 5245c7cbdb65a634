//! Port 8888: programs come, are started and stopped; what they say goes to all clients here. `debug` is the way to the
//! debugger of a diagram.

mod debug;

use super::Guest;
use super::recordings::{Recordings, Sending};
use crate::access::Access;
use crate::battery::Battery;
use crate::clients::{Client, Clients, Watching};
use crate::connection::{self, Handler, Held, VERSION};
use crate::feedback::{Feedback, Moment};
use crate::outbox::Outbox;
use crate::program::{Command, Heard, Programs};
use crate::protocol::control::Request;
use crate::protocol::news;
use crate::protocol::program::WhenGone;
use crate::{limits, log, panics, scripts};
use lang_text::problem::Locale;
use page::seats::Full;
use std::path::PathBuf;
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;
use tokio::sync::oneshot;

/// What this port works with.
#[derive(Debug)]
pub struct Control {
    /// Who is paired.
    pub access: Arc<Access>,
    /// The register of connections.
    pub clients: Rc<Clients>,
    /// Bytes of half frames.
    pub held: Rc<Held>,
    /// The part that runs programs.
    pub programs: Rc<Programs>,
    /// Who beeps after an upload.
    pub feedback: Rc<Feedback>,
    /// The folder of programs.
    pub scripts: PathBuf,
    /// The greatest frame.
    pub upload_bytes: usize,
    /// The model of the controller.
    pub config_version: String,
    /// The language of the robot.
    pub locale: Locale,
    /// What has happened, and what happens.
    pub recordings: Rc<Recordings>,
    /// What the battery has.
    pub battery: Rc<Battery>,
}

/// One connection.
struct Session {
    control: Rc<Control>,
    client: Rc<Client>,
    sending: Sending,
    /// The language that it has asked for; see [`Session::locale`].
    heard: Heard,
    /// Why it has no place: then it may only stop.
    full: Option<Full>,
}

impl Session {
    /// Whether somebody without a place may ask this; ends the connection if not.
    fn is_heard(&self, request: &Request) -> bool {
        let Some(why) = self.full else { return true };
        let is_heard = matches!(
            request,
            Request::Stop | Request::Status | Request::Version | Request::Keepalive
        );
        if !is_heard {
            self.error(&why.to_string());
            self.client.outbox.close();
        }
        is_heard
    }

    fn error(&self, text: &str) {
        self.client.outbox.send(format!("error: {text}").as_bytes());
    }

    /// The language of what this client alone is told: the one that it has asked for, or else that of the robot.
    fn locale(&self) -> Locale {
        self.heard.unwrap_or(self.control.locale)
    }

    /// Why a program is not kept or not run.
    fn refuse(&self, why: &scripts::Refusal) {
        self.error(why.words().in_locale(self.locale()));
    }

    /// Whether this computer may do more than look.
    fn is_paired(&self) -> bool {
        let may = self.control.access.may_control(self.client.peer.ip());
        if !may {
            tracing::warn!(target: log::CLIENTS, "control: {} is not paired", self.client.peer);
        }
        may
    }

    /// Whether this computer may do more than look; says so if not.
    fn may_control(&self) -> bool {
        let may = self.is_paired();
        if !may {
            self.error(news::NOT_PAIRED);
        }
        may
    }

    /// Programs in the order in which they came.
    async fn command(&self, command: Command) {
        self.control.clients.takes_control(self.client.peer);
        self.control.programs.send(command).await;
    }

    /// What runs, when everything is done that was asked for before.
    async fn status(&self) {
        let (answer, told) = oneshot::channel();
        self.control.programs.send(Command::Ask(answer)).await;
        if let Ok(mut text) = told.await {
            text.push_str(&self.control.battery.line());
            text.push_str(&self.control.clients.describe_control());
            self.client
                .outbox
                .send(format!("status: {text}").as_bytes());
        }
    }

    async fn run(&self, name: &[u8]) {
        match scripts::find(&self.control.scripts, name) {
            Ok(path) => self.command(Command::Run(path, self.heard)).await,
            Err(why) => {
                // What runs ends all the same: the person wants to see something else.
                self.command(Command::Stop("a client")).await;
                self.refuse(&why);
            }
        }
    }

    async fn patch(&self, when_gone: WhenGone, name: &[u8]) {
        if !self.may_control() {
            return;
        }
        match scripts::find(&self.control.scripts, name) {
            Ok(path) => {
                let asker = self.client.id();
                self.command(Command::Patch(asker, when_gone, path, self.heard))
                    .await
            }
            Err(why) => self.refuse(&why),
        }
    }

    /// This client is told where a diagram is, or no more.
    fn watch(&self, is_wanted: bool) {
        self.client.watch(match is_wanted {
            true => Watching::Lines,
            false => Watching::No,
        });
    }

    /// What a person says to a question of the diagram.
    async fn answer(&self, number: u32, said: Option<&[u8]>) {
        if self.may_control() {
            self.command(Command::Reply(number, said.map(text))).await;
        }
    }

    async fn store(&self, name: &[u8], content: &[u8]) {
        let folder = self.control.scripts.clone();
        let (name, content) = (name.to_owned(), content.to_owned());
        // A disk may be slow; everybody else is served meanwhile.
        let kept =
            tokio::task::spawn_blocking(move || scripts::store(&folder, &name, &content)).await;
        match kept {
            Ok(Ok(path)) => {
                self.control.feedback.show(Moment::Uploaded);
                tracing::info!(
                    target: log::PROGRAMS,
                    "{} is uploaded by {}",
                    path.display(),
                    self.client.peer
                );
            }
            Ok(Err(why)) => {
                tracing::warn!(target: log::PROGRAMS, "an upload by {} is refused: {why}", self.client.peer);
                self.refuse(&why);
            }
            Err(error) => self.error(&format!("{}{error}", news::UPLOAD_FAILED)),
        }
    }
}

fn text(bytes: &[u8]) -> String {
    String::from_utf8_lossy(bytes).into_owned()
}

impl Handler for Session {
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
        if !self.is_heard(&request) {
            return;
        }
        panics::seam("control", || frame == b"panic");
        match request {
            // What is unknown has no answer, as on the original robots.
            Request::Keepalive | Request::Unknown => {}
            Request::Malformed(why) => self.error(&why.to_string()),
            Request::Version => self.client.outbox.send(VERSION),
            Request::ConfigVersion => {
                let answer = format!("configVersion: {}", self.control.config_version);
                self.client.outbox.send(answer.as_bytes());
            }
            Request::Status => self.status().await,
            Request::Stream(wanted) => self.sending.stream(wanted),
            Request::Box => self.sending.last_minutes(),
            Request::Watch(is_wanted) => self.watch(is_wanted),
            // Anyone who sees danger may stop the robot.
            Request::Stop => self.command(Command::Stop("a client")).await,
            Request::File { name, content } => {
                if self.may_control() {
                    self.store(name, content).await;
                }
            }
            Request::Run(name) => {
                if self.may_control() {
                    self.run(name).await;
                }
            }
            Request::Patch { when_gone, name } => self.patch(when_gone, name).await,
            Request::Set(assignment) => {
                if self.may_control() {
                    let asker = self.client.id();
                    self.command(Command::Set(asker, text(assignment), self.heard))
                        .await;
                }
            }
            Request::Language(locale) => self.heard = Some(locale),
            Request::Questions(is_wanted) => {
                // An answer changes what a program does.
                if self.may_control() {
                    self.client.answers(is_wanted);
                }
            }
            Request::Answer { number, text } => self.answer(number, text).await,
            Request::Debug { tag, order } => self.debug(tag, &text(order)).await,
            Request::DirectScript(code) => {
                if self.may_control() {
                    self.command(Command::Script(text(code))).await;
                }
            }
            Request::Direct(code) => {
                if self.may_control() {
                    self.command(Command::Direct(text(code))).await;
                }
            }
        }
    }

    fn complaint(&self, reason: &str) -> Option<Vec<u8>> {
        let text = match self.full {
            Some(why) => format!("error: {why}"),
            None => format!("error: {reason}"),
        };
        Some(text.into_bytes())
    }
}

/// Tells a client without a place so, after its time to say `stop`.
async fn dismiss(outbox: &Outbox, full: Option<Full>) {
    if let Some(why) = full {
        tokio::time::sleep(Duration::from_millis(limits::LOBBY_MS)).await;
        outbox.send(format!("error: {why}").as_bytes());
        outbox.close();
    }
    std::future::pending().await
}

/// Serves one client.
pub async fn serve(control: Rc<Control>, mut guest: Guest) {
    let outbox = Rc::new(Outbox::new(limits::OUTBOX_BYTES));
    let (peer, full) = (guest.peer, guest.full);
    let client = control.clients.add("control", peer, outbox.clone());
    if full.is_none() {
        tracing::info!(target: log::CLIENTS, "control: {peer} has come");
    }
    let mut handler = Session {
        control: control.clone(),
        sending: Sending::new(control.recordings.clone(), client.clone()),
        client,
        heard: None,
        full,
    };
    let frame_bytes = match full {
        None => control.upload_bytes,
        Some(_) => limits::SMALL_FRAME_BYTES,
    };
    let served = connection::serve(
        guest.stream,
        &guest.begun,
        &mut guest.seat,
        frame_bytes,
        &control.held,
        &outbox,
        &mut handler,
    );
    let why = tokio::select! {
        why = served => why,
        () = dismiss(&outbox, full) => return,
    };
    handler.leave_debugger().await;
    if full.is_none() {
        tracing::info!(target: log::CLIENTS, "control: {peer} has left: {why}");
    }
    drop(guest.seat);
}
