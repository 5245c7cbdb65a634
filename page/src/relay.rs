//! The connection of one browser to the control port of the robot.
//!
//! Owns frames, keepalives and coming back; what the frames say is known to the page in the browser. A browser that is slow slows
//! its own connection only: the robot leaves out what it cannot send.

use crate::limits;
use axum::body::Bytes;
use frame::{Decoder, encode};
use lang_text::problem::Locale;
use std::io;
use std::net::SocketAddr;
use std::sync::Arc;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::net::tcp::{OwnedReadHalf, OwnedWriteHalf};
use tokio::sync::{Notify, OwnedSemaphorePermit, mpsc, watch};
use tokio::time::{sleep, timeout};

/// What comes from the robot.
#[derive(Debug)]
pub enum Came {
    /// It is there.
    There,
    /// It is gone, or was not found; the next attempt follows.
    Gone(String),
    /// A message of it.
    Frame(Vec<u8>),
}

/// What a browser asks, with its share of the room for uploads.
#[derive(Debug)]
pub struct Request {
    /// As the control port takes it.
    pub bytes: Bytes,
    /// Given back when it is sent.
    pub room: Option<OwnedSemaphorePermit>,
}

/// What goes to the robot.
#[derive(Debug)]
pub struct Outgoing {
    /// In their order.
    pub requests: mpsc::Receiver<Request>,
    /// A stop, which overtakes what waits.
    pub stop: Arc<Notify>,
}

/// Connects until `came` is closed, and sends what comes while the robot is there; requests that come while it is not
/// are lost, and the browser knows of that by [`Came::Gone`]. The robot speaks this language, as far as it can.
pub async fn run(
    (mut address, locale): (watch::Receiver<Option<SocketAddr>>, Locale),
    mut outgoing: Outgoing,
    came: mpsc::Sender<Came>,
) {
    loop {
        let at = *address.borrow_and_update();
        let why = match at {
            None => "the robot does not take programs yet".to_owned(),
            Some(at) => match connect(at).await {
                Ok(stream) => {
                    while outgoing.requests.try_recv().is_ok() {}
                    if came.send(Came::There).await.is_err() {
                        return;
                    }
                    let (read, write) = stream.into_split();
                    let why = tokio::select! {
                        why = receive(read, &came) => why,
                        why = send(write, locale, &mut outgoing) => why,
                        _ = address.changed() => Ok(()),
                        () = came.closed() => return,
                    };
                    match why {
                        Ok(()) => "the robot has closed the connection".to_owned(),
                        Err(error) => error.to_string(),
                    }
                }
                Err(error) => format!("the control port of the robot, {at}: {error}"),
            },
        };
        if came.send(Came::Gone(why)).await.is_err() {
            return;
        }
        tokio::select! {
            () = sleep(limits::RETURN_TIME) => {}
            changed = address.changed() => if changed.is_err() { return },
            () = came.closed() => return,
        }
    }
}

async fn connect(at: SocketAddr) -> io::Result<TcpStream> {
    let stream = timeout(limits::RETURN_TIME, TcpStream::connect(at)).await??;
    stream.set_nodelay(true)?;
    Ok(stream)
}

async fn receive(mut read: OwnedReadHalf, came: &mpsc::Sender<Came>) -> io::Result<()> {
    let mut decoder = Decoder::new(limits::MESSAGE_BYTES_MAX);
    let mut buffer = vec![0; 16 << 10];
    loop {
        let size = read.read(&mut buffer).await?;
        if size == 0 {
            return Ok(());
        }
        decoder.feed(&buffer[..size]);
        while let Some(frame) = decoder.next().map_err(io::Error::other)? {
            if frame == b"keepalive" {
                continue;
            }
            if came.send(Came::Frame(frame.to_vec())).await.is_err() {
                return Ok(());
            }
        }
    }
}

async fn send(
    mut write: OwnedWriteHalf,
    locale: Locale,
    outgoing: &mut Outgoing,
) -> io::Result<()> {
    // What the robot says of programs of blocks is for this person.
    let language = format!("language:{}", locale.name());
    write.write_all(&encode(language.as_bytes())).await?;
    loop {
        let message = tokio::select! {
            biased;
            () = outgoing.stop.notified() => encode(b"stop"),
            next = timeout(limits::KEEPALIVE_TIME, outgoing.requests.recv()) => match next {
                Ok(Some(request)) => {
                    write.write_all(&encode(&request.bytes)).await?;
                    drop(request.room);
                    continue;
                }
                Ok(None) => return Ok(()),
                Err(_) => encode(b"keepalive"),
            },
        };
        write.write_all(&message).await?;
    }
}
