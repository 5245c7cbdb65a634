//! Where connections come in: never too many, from one computer neither, and none that only sits there.
//!
//! Owns their number and the time of each. What is said over them is not known here.

use crate::limits;
use axum::extract::connect_info::Connected;
use axum::serve::{IncomingStream, Listener};
use std::collections::HashMap;
use std::io;
use std::net::{IpAddr, SocketAddr};
use std::pin::Pin;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
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

/// How many connections each computer has.
#[derive(Debug, Default)]
struct Seats(Mutex<HashMap<IpAddr, usize>>);

impl Seats {
    fn taken(&self) -> MutexGuard<'_, HashMap<IpAddr, usize>> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A place for a connection from there; None if there is none.
    fn take(self: &Arc<Self>, ip: IpAddr) -> Option<Seat> {
        let mut taken = self.taken();
        let all: usize = taken.values().sum();
        let own = taken.entry(ip).or_default();
        if all >= limits::CONNECTIONS_MAX || *own >= limits::CONNECTIONS_OF_ONE_MAX {
            return None;
        }
        *own += 1;
        drop(taken);
        Some(Seat {
            seats: Arc::clone(self),
            ip,
        })
    }
}

/// The place of one connection.
#[derive(Debug)]
struct Seat {
    seats: Arc<Seats>,
    ip: IpAddr,
}

impl Drop for Seat {
    fn drop(&mut self) {
        let mut taken = self.seats.taken();
        if let Some(own) = taken.get_mut(&self.ip) {
            *own -= 1;
            if *own == 0 {
                taken.remove(&self.ip);
            }
        }
    }
}

/// Accepts connections.
pub struct Door {
    listener: TcpListener,
    seats: Arc<Seats>,
}

impl Door {
    /// At this listener.
    pub fn new(listener: TcpListener) -> Self {
        Self {
            listener,
            seats: Arc::default(),
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
                    if let Some(seat) = self.seats.take(address.ip().to_canonical()) {
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
    _seat: Seat,
}

impl Guest {
    fn new(stream: TcpStream, seat: Seat) -> Self {
        Self {
            stream,
            idle: Box::pin(sleep(limits::IDLE_TIME)),
            _seat: seat,
        }
    }
}

impl Guest {
    /// Whether the time is up, as an error.
    fn patience<T>(&mut self, cx: &mut Context<'_>) -> Poll<io::Result<T>> {
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
        match Pin::new(&mut self.stream).poll_read(cx, buf) {
            Poll::Ready(done) => Poll::Ready(done),
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_computer_never_has_all_places_and_a_place_comes_back() {
        let seats = Arc::<Seats>::default();
        let (one, other): (IpAddr, IpAddr) = ([10, 0, 0, 1].into(), [10, 0, 0, 2].into());
        let mut taken = Vec::new();
        while let Some(seat) = seats.take(one) {
            taken.push(seat);
        }
        assert_eq!(taken.len(), limits::CONNECTIONS_OF_ONE_MAX);
        let mut others = Vec::new();
        while let Some(seat) = seats.take(other) {
            others.push(seat);
        }
        let left = limits::CONNECTIONS_MAX - limits::CONNECTIONS_OF_ONE_MAX;
        assert_eq!(others.len(), left);
        taken.pop();
        assert!(seats.take(other).is_some());
        drop((taken, others));
        assert!(seats.taken().is_empty());
    }
}
