//! One connection with frames: reading, writing, both keepalive clocks, and its end.
//!
//! Owns everything that is the same on the three ports with frames. What frames mean is the handler's.

use crate::limits;
use crate::outbox::Outbox;
use crate::protocol::news::SLOW_READER;
use frame::{Decoder, encode};
use page::seats::{Place, Seat};
use std::cell::Cell;
use std::io;
use std::rc::Rc;
use std::time::Duration;
use tokio::io::{AsyncReadExt, AsyncWriteExt};
use tokio::net::TcpStream;
use tokio::net::tcp::{ReadHalf, WriteHalf};
use tokio::time::{Instant, timeout, timeout_at};

/// The answer to `version` on every port; desktop programs compare it with a text of their own.
pub const VERSION: &[u8] = b"version: 3.1.4";

/// What frames mean.
pub trait Handler {
    /// Does what a frame asks for. The next frame of this connection waits for the end of it.
    fn frame(&mut self, frame: &[u8]) -> impl Future<Output = ()>;

    /// What a client is told before its connection ends because of what it sent.
    fn complaint(&self, reason: &str) -> Option<Vec<u8>> {
        let _ = reason;
        None
    }
}

/// Bytes of half frames that all connections hold together.
#[derive(Debug, Default)]
pub struct Held(Cell<usize>);

/// The share of one connection.
struct Share<'a>(&'a Held, usize);

impl Share<'_> {
    /// False: there is no room for so many.
    fn set(&mut self, bytes: usize) -> bool {
        let all = self.0.0.get() - self.1 + bytes;
        self.0.0.set(all);
        let grows = bytes > self.1;
        self.1 = bytes;
        !grows || bytes <= limits::HELD_FREE_BYTES || all <= limits::HELD_BYTES
    }
}

impl Drop for Share<'_> {
    fn drop(&mut self) {
        self.0.0.set(self.0.0.get() - self.1);
    }
}

/// Serves a connection, of which these bytes have come already, to its end. `frame_bytes` is the greatest frame. Returns why it ended, in words.
pub async fn serve(
    mut stream: TcpStream,
    begun: &[u8],
    seat: &mut Seat,
    frame_bytes: usize,
    held: &Held,
    outbox: &Rc<Outbox>,
    handler: &mut impl Handler,
) -> String {
    let reason = {
        let (reader, mut writer) = stream.split();
        let handler = &mut *handler;
        let place = seat.place();
        tokio::select! {
            // First what comes: then its answers go in the same turn.
            biased;
            reason = read(reader, begun, &place, frame_bytes, held, handler) => reason,
            // Others may be about to come in thousands: nothing is waited for.
            () = seat.lost() => return "another one needs its place".to_owned(),
            error = write(&mut writer, outbox) => match error {
                Ok(()) => Reason::Plain("closed by this side".to_owned()),
                Err(error) => Reason::Plain(format!("cannot send: {error}")),
            },
        }
    };
    if let Reason::Complaint(text) = &reason
        && let Some(payload) = handler.complaint(text)
    {
        let _ = timeout(
            Duration::from_millis(limits::FAREWELL_MS),
            stream.write_all(&encode(&payload)),
        )
        .await;
    }
    farewell(stream).await;
    match reason {
        Reason::Plain(text) | Reason::Complaint(text) => text,
    }
}

/// Why a connection ends.
enum Reason {
    /// Nothing to say to the client.
    Plain(String),
    /// The client did something that it should hear of.
    Complaint(String),
}

/// The text about frames that a slow client lost.
fn note(count: u32) -> Vec<u8> {
    format!("info: {count} messages were left out: {SLOW_READER}").into_bytes()
}

async fn read(
    mut reader: ReadHalf<'_>,
    mut begun: &[u8],
    place: &Place,
    frame_bytes: usize,
    held: &Held,
    handler: &mut impl Handler,
) -> Reason {
    let mut decoder = Decoder::new(frame_bytes);
    let mut share = Share(held, 0);
    let mut buffer = vec![0; limits::READ_BYTES];
    let mut half_since: Option<Instant> = None;
    let silence = Duration::from_millis(limits::SILENCE_MS);
    loop {
        let size = match timeout(silence, begun.chain(&mut reader).read(&mut buffer)).await {
            Err(_) => return Reason::Plain(format!("silent for {} ms", limits::SILENCE_MS)),
            Ok(Err(error)) => return Reason::Plain(error.to_string()),
            Ok(Ok(0)) => return Reason::Plain("closed by the client".to_owned()),
            Ok(Ok(size)) => size,
        };
        begun = &begun[begun.len().min(size)..];
        decoder.feed(&buffer[..size]);
        let mut moved = false;
        loop {
            match decoder.next() {
                Ok(None) => break,
                Ok(Some(frame)) => {
                    moved = true;
                    // A client that said something whole keeps its place while that is done.
                    place.is_good();
                    handler.frame(frame).await;
                }
                Err(violation) => return Reason::Complaint(violation.to_string()),
            }
        }
        place.hears(size, moved, decoder.buffered() > 0);
        if !share.set(decoder.buffered()) {
            return Reason::Complaint(
                "too many bytes of unfinished messages: try again later".to_owned(),
            );
        }
        if decoder.buffered() == 0 {
            half_since = None;
        } else if moved || half_since.is_none() {
            half_since = Some(Instant::now());
        }
        let limit = Duration::from_millis(limits::FRAME_MS);
        if half_since.is_some_and(|since| since.elapsed() > limit) {
            return Reason::Complaint(format!(
                "a message was not whole after {} s",
                limits::FRAME_MS / 1000
            ));
        }
    }
}

/// Sends what is in the outbox, and a keepalive when nothing was sent for a while.
async fn write(writer: &mut WriteHalf<'_>, outbox: &Outbox) -> io::Result<()> {
    let quiet = Duration::from_millis(limits::KEEPALIVE_MS);
    let mut sent = Instant::now();
    loop {
        match timeout_at(sent + quiet, outbox.next()).await {
            Ok(Some(frame)) => writer.write_all(&frame).await?,
            Ok(None) => return Ok(()),
            Err(_) => writer.write_all(&encode(b"keepalive")).await?,
        }
        if let Some(count) = outbox.take_dropped() {
            writer.write_all(&encode(&note(count))).await?;
        }
        sent = Instant::now();
    }
}

/// Ends a connection so that the last words arrive: what the client still sends is read for a moment, because unread
/// bytes would make the kernel reset the connection.
async fn farewell(mut stream: TcpStream) {
    let wait = Duration::from_millis(limits::FAREWELL_MS);
    let ended = async {
        stream.shutdown().await?;
        let mut buffer = [0; 4096];
        let mut left = limits::FAREWELL_BYTES;
        while left > 0 {
            match stream.read(&mut buffer).await? {
                0 => break,
                size => left = left.saturating_sub(size),
            }
        }
        io::Result::Ok(())
    };
    let _ = timeout(wait, ended).await;
}
