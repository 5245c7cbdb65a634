//! Connections to the control port for which there is no place: one that says `stop` is heard all the same.
//!
//! Owns the places of those who wait, of which the next one that comes may take any, and what they say first. It costs next to
//! nothing until that is a stop.

use super::guest::Guest;
use crate::limits;
use crate::protocol::control::Request;
use ::page::seats::{Full, Room, Seats, Whom};
use frame::{Decoder, encode};
use std::net::SocketAddr;
use std::sync::Arc;
use std::time::Duration;
use tokio::io::AsyncReadExt;
use tokio::net::TcpStream;
use tokio::time::timeout;

/// The places of those who wait.
pub fn seats() -> Arc<Seats> {
    Seats::new(Room {
        all: limits::LOBBY,
        one: limits::LOBBY,
        kept: 0,
        stuck_time: Duration::ZERO,
        mute_time: Duration::ZERO,
        spares_idle: false,
    })
}

/// Waits for what a connection says, and has it served if that is a stop.
pub fn wait<F>(
    lobby: &Arc<Seats>,
    mut stream: TcpStream,
    peer: SocketAddr,
    why: Full,
    serve: impl Fn(Guest) -> F + 'static,
) where
    F: Future<Output = ()> + 'static,
{
    // Somebody there may give way: there is always a place.
    let Ok(mut seat) = lobby.take(peer.ip(), Whom::Anybody) else {
        return;
    };
    let _ = stream.set_nodelay(true);
    tokio::task::spawn_local(async move {
        let time = Duration::from_millis(limits::LOBBY_MS);
        let stop = tokio::select! {
            begun = timeout(time, begins_with_stop(&mut stream)) => begun.ok().flatten(),
            () = seat.lost() => return,
        };
        match stop {
            Some(begun) => {
                seat.place().is_good();
                let full = Some(why);
                serve(Guest {
                    stream,
                    peer,
                    seat,
                    begun,
                    full,
                })
                .await;
            }
            // One for which the kernel has no room hears nothing.
            None => {
                let _ = stream.try_write(&encode(format!("error: {why}").as_bytes()));
            }
        }
    });
}

/// What it has sent, if that begins with a stop; None if it is something else.
async fn begins_with_stop(stream: &mut TcpStream) -> Option<Vec<u8>> {
    let mut begun = Vec::new();
    loop {
        let mut piece = [0; limits::LOBBY_BYTES];
        let size = stream
            .read(&mut piece)
            .await
            .ok()
            .filter(|size| *size > 0)?;
        begun.extend_from_slice(&piece[..size]);
        let mut decoder = Decoder::new(limits::SMALL_FRAME_BYTES);
        decoder.feed(&begun);
        loop {
            match decoder.next() {
                Ok(Some(frame)) => {
                    let request = Request::parse(frame);
                    if matches!(request, Request::Stop) {
                        return Some(begun);
                    }
                    if !matches!(request, Request::Keepalive) {
                        return None;
                    }
                }
                Ok(None) if begun.len() < limits::LOBBY_BYTES => break,
                Ok(None) | Err(_) => return None,
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::io::Write;

    /// What a connection with these bytes is taken for.
    fn judged(bytes: &[u8]) -> Option<Vec<u8>> {
        let runtime = tokio::runtime::Builder::new_current_thread()
            .enable_io()
            .build()
            .unwrap();
        let listener = std::net::TcpListener::bind("127.0.0.1:0").unwrap();
        let mut client = std::net::TcpStream::connect(listener.local_addr().unwrap()).unwrap();
        client.write_all(bytes).unwrap();
        drop(client);
        let (stream, _) = listener.accept().unwrap();
        stream.set_nonblocking(true).unwrap();
        runtime.block_on(async {
            let mut stream = TcpStream::from_std(stream).unwrap();
            begins_with_stop(&mut stream).await
        })
    }

    #[test]
    fn only_a_stop_is_heard_with_what_follows_it() {
        let heard = |text: &str| assert_eq!(judged(text.as_bytes()), Some(text.into()), "{text}");
        heard("4:stop");
        heard("4:stop6:status");
        heard("9:keepalive4:stop");
        for text in ["", "4:sto", "7:version4:stop", "3:run4:stop", "60000:stop"] {
            assert_eq!(judged(text.as_bytes()), None, "{text}");
        }
        assert_eq!(judged(&[b'7'; 1000]), None);
    }
}
