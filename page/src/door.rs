//! Where connections come in: never too many, from one computer neither, and none that only sits there.
//!
//! Owns the time of each; `seats` has the choice. What is said over them is not known here.

use crate::guests::Guests;
use crate::limits;
use crate::seats::{Room, Seat, Seats, Whom};
use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use std::io;
use std::net::SocketAddr;
use std::pin::Pin;
use std::sync::Arc;
use std::task::{Context, Poll};
use tokio::io::{AsyncRead, AsyncWrite, ReadBuf};
use tokio::net::{TcpListener, TcpStream};
use tokio::time::{Instant, Sleep, sleep};

/// The other end of a connection; an address of IPv4 is shown as such.
#[derive(Clone, Copy, Debug)]
pub struct Peer(pub SocketAddr);

impl Connected<IncomingStream<'_, Door>> for Peer {
    fn connect_info(stream: IncomingStream<'_, Door>) -> Self {
        let address = stream.remote_addr();
        Self(SocketAddr::new(address.ip().to_canonical(), address.port()))
    }
}

/// How many connections there may be.
pub const ROOM: Room = Room {
    all: limits::CONNECTIONS_MAX,
    one: limits::CONNECTIONS_OF_ONE_MAX,
    kept: limits::CONNECTIONS_KEPT,
    stuck_time: limits::STUCK_TIME,
    mute_time: limits::MUTE_TIME,
    spares_idle: true,
};

/// Accepts connections.
pub struct Door {
    listener: TcpListener,
    seats: Arc<Seats>,
    guests: Arc<dyn Guests>,
}

impl Door {
    /// At this listener, with places that may be taken already.
    pub fn new(listener: TcpListener, seats: Arc<Seats>, guests: Arc<dyn Guests>) -> Self {
        Self {
            listener,
            seats,
            guests,
        }
    }
}

impl Listener for Door {
    type Io = Guest;
    type Addr = SocketAddr;

    async fn accept(&mut self) -> (Guest, SocketAddr) {
        loop {
            match self.listener.accept().await {
                // One that has no place is closed at once.
                Ok((stream, address)) => {
                    let ip = address.ip().to_canonical();
                    self.guests.comes(ip);
                    let whom = match ip.is_loopback() {
                        true => Whom::Own,
                        false => Whom::Anybody,
                    };
                    if let Ok(seat) = self.seats.take(ip, whom) {
                        // Without it small messages come late, and that is all.
                        let _ = stream.set_nodelay(true);
                        return (Guest::new(stream, seat), address);
                    }
                }
                // No more descriptors: one has to leave first.
                Err(_) => sleep(limits::RETURN_TIME).await,
            }
        }
    }

    fn local_addr(&self) -> io::Result<SocketAddr> {
        self.listener.local_addr()
    }
}

/// A connection, with its place among all.
pub struct Guest {
    stream: TcpStream,
    /// When nothing could be sent to it for too long: it asks nothing, or reads nothing, or asks for ever.
    idle: Pin<Box<Sleep>>,
    seat: Seat,
}

impl Guest {
    fn new(stream: TcpStream, seat: Seat) -> Self {
        Self {
            stream,
            idle: Box::pin(sleep(limits::IDLE_TIME)),
            seat,
        }
    }

    /// Whether the time is up, or another one has the place, as an error.
    fn patience<T>(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<T>> {
        if self.seat.poll_lost(cx).is_ready() {
            return Poll::Ready(Err(io::ErrorKind::ConnectionReset.into()));
        }
        let is_over = self.idle.as_mut().poll(cx);
        is_over.map(|()| Err(io::ErrorKind::TimedOut.into()))
    }
}

impl AsyncRead for Guest {
    fn poll_read(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &mut ReadBuf<'_>,
    ) -> Poll<io::Result<()>> {
        let before = buf.filled().len();
        match Pin::new(&mut self.stream).poll_read(cx, buf) {
            Poll::Ready(done) => {
                // What is whole is answered, which counts when it happens.
                let bytes = buf.filled().len() - before;
                self.seat.place().hears(bytes, false, true);
                Poll::Ready(done)
            }
            Poll::Pending => self.patience(cx),
        }
    }
}

impl AsyncWrite for Guest {
    fn poll_write(
        mut self: Pin<&mut Self>,
        cx: &mut Context<'_>,
        buf: &[u8],
    ) -> Poll<io::Result<usize>> {
        match Pin::new(&mut self.stream).poll_write(cx, buf) {
            Poll::Ready(done) => {
                self.idle.as_mut().reset(Instant::now() + limits::IDLE_TIME);
                self.seat.place().is_good();
                Poll::Ready(done)
            }
            Poll::Pending => self.patience(cx),
        }
    }

    fn poll_flush(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_flush(cx)
    }

    fn poll_shutdown(mut self: Pin<&mut Self>, cx: &mut Context<'_>) -> Poll<io::Result<()>> {
        Pin::new(&mut self.stream).poll_shutdown(cx)
    }
}
