//! Recordings over a connection: everything from now on, or the last minutes.
//!
//! Owns what is on its way to one client: one recording at a time, in pieces, as fast as the client reads. Ports 8888 and 9000
//! have it alike. What a recording has is known to `recorder`.

use crate::access::Access;
use crate::clients::Client;
use crate::limits;
use crate::outbox::Outbox;
use crate::protocol::news;
use crate::protocol::telemetry::STREAM;
use crate::record::{LIBRARY, Record};
use recorder::stream::{self, Stream, Took};
use std::io::Read;
use std::path::Path;
use std::rc::Rc;
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use tokio::sync::mpsc::{UnboundedReceiver, UnboundedSender, unbounded_channel};
use tokio::task::{AbortHandle, spawn_local};

/// What recordings are made of.
#[derive(Debug)]
pub struct Recordings {
    /// Which computers are paired.
    pub access: Arc<Access>,
    /// What has happened, and what happens.
    pub record: Rc<Record>,
}

/// What one client has asked for; it ends with its connection.
pub struct Sending {
    around: Rc<Recordings>,
    client: Rc<Client>,
    task: Option<AbortHandle>,
}

impl Drop for Sending {
    fn drop(&mut self) {
        if let Some(task) = &self.task {
            task.abort();
        }
    }
}

/// Bytes of a stream on their way from the thread that makes them.
struct Wire {
    out: UnboundedSender<Vec<u8>>,
    waiting: Arc<AtomicUsize>,
}

impl stream::Client for Wire {
    fn state(&mut self) -> Took {
        if self.out.is_closed() {
            return Took::Gone;
        }
        match self.waiting.load(Ordering::Relaxed) < limits::STREAM_BYTES {
            true => Took::All,
            false => Took::Full,
        }
    }

    fn send(&mut self, bytes: Vec<u8>) {
        self.waiting.fetch_add(bytes.len(), Ordering::Relaxed);
        // A client that has just gone is found out with the next call.
        let _ = self.out.send(bytes);
    }
}

impl Sending {
    /// Nothing is asked for yet.
    pub fn new(around: Rc<Recordings>, client: Rc<Client>) -> Self {
        Self {
            around,
            client,
            task: None,
        }
    }

    fn error(&self, why: impl std::fmt::Display) {
        self.client.outbox.send(format!("error: {why}").as_bytes());
    }

    /// Only one recording at a time comes over a connection.
    fn is_sending(&self) -> bool {
        let task = self.task.as_ref();
        let is_sending = task.is_some_and(|task| !task.is_finished());
        if is_sending {
            self.error("a recording is on its way already: take another connection");
        }
        is_sending
    }

    /// Everything from now on.
    pub fn stream(&mut self, wanted: &str) {
        let request = match stream::Request::parse(wanted) {
            Ok(request) => request,
            Err(error) => return self.error(error),
        };
        if self.is_sending() {
            return;
        }
        let (out, come) = unbounded_channel();
        let waiting = Arc::<AtomicUsize>::default();
        let wire = Box::new(Wire {
            out,
            waiting: waiting.clone(),
        });
        match Stream::begin(request, LIBRARY, wire) {
            Ok(stream) => self.around.record.listen(Box::new(stream)),
            Err(error) => return self.error(error),
        }
        let out = self.client.outbox.clone();
        let task = spawn_local(pass_on(come, waiting, out));
        self.task = Some(task.abort_handle());
    }

    /// The last minutes, from now back.
    pub fn last_minutes(&mut self) {
        if !self.around.access.may_control(self.client.peer.ip()) {
            return self.error(news::NOT_PAIRED);
        }
        if self.is_sending() {
            return;
        }
        let (record, out) = (self.around.record.clone(), self.client.outbox.clone());
        let task = spawn_local(async move {
            match record.save().await {
                Ok(path) => send_file(&path, &out).await,
                Err(error) => out.send(format!("error: {error}").as_bytes()),
            }
        });
        self.task = Some(task.abort_handle());
    }
}

/// Passes bytes of a stream on as fast as the client reads them.
async fn pass_on(mut come: UnboundedReceiver<Vec<u8>>, waiting: Arc<AtomicUsize>, out: Rc<Outbox>) {
    while let Some(bytes) = come.recv().await {
        for piece in bytes.chunks(limits::STREAM_PIECE_BYTES) {
            out.room().await;
            out.send(&[STREAM, piece].concat());
        }
        waiting.fetch_sub(bytes.len(), Ordering::Relaxed);
    }
    // The thread has no room for one more client, or is over.
    out.send(b"error: too many clients have a stream: try again later");
}

/// Sends a file; an empty piece is its end.
async fn send_file(path: &Path, out: &Outbox) {
    let mut file = match std::fs::File::open(path) {
        Ok(file) => file,
        Err(error) => {
            let text = format!("error: {}: {error}", path.display());
            return out.send(text.as_bytes());
        }
    };
    loop {
        out.room().await;
        let read = tokio::task::spawn_blocking(move || {
            let mut piece = Vec::new();
            let most = limits::STREAM_PIECE_BYTES as u64;
            let read = (&mut file).take(most).read_to_end(&mut piece);
            (file, read.map(|_| piece))
        });
        match read.await {
            Ok((same, Ok(piece))) => {
                file = same;
                out.send(&[STREAM, &piece].concat());
                if piece.is_empty() {
                    return;
                }
            }
            Ok((_, Err(error))) => return out.send(format!("error: {error}").as_bytes()),
            // trikd is ending.
            Err(_) => return,
        }
    }
}
