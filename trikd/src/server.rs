//! Sockets: all listeners or none, who gets in, and which task serves whom.
//!
//! `control`, `telemetry`, `mailbox`, `gamepad`, `video` and `variables` are one port each; `datagrams` and `discovery`
//! are UDP, `page` is for browsers. What is said on a port is in `protocol`.

// A request, a message or a command that is forgotten must not pass in silence.
#![deny(clippy::wildcard_enum_match_arm)]

pub mod control;
pub mod datagrams;
pub mod discovery;
pub mod gamepad;
pub mod mailbox;
pub mod page;
pub mod recordings;
pub mod telemetry;
pub mod variables;
pub mod video;

use crate::access::Access;
use crate::error::Error;
use crate::protocol::mail::plain;
use crate::{limits, log};
use frame::encode;
use socket2::{Domain, Protocol, SockRef, Socket, Type};
use std::cell::RefCell;
use std::fmt;
use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};

/// What the official controller sets: interactive traffic first.
const TYPE_OF_SERVICE: u32 = 0x40;

/// The listeners of one port.
#[derive(Debug)]
pub struct Port {
    /// What it is for, in one word.
    pub name: &'static str,
    listeners: Vec<TcpListener>,
}

fn bind_one(address: SocketAddr) -> io::Result<TcpListener> {
    let socket = Socket::new(
        Domain::for_address(address),
        Type::STREAM,
        Some(Protocol::TCP),
    )?;
    socket.set_reuse_address(true)?;
    socket.set_nonblocking(true)?;
    if address.is_ipv6() {
        // With :: also those who come by IPv4.
        socket.set_only_v6(address.ip() != IpAddr::V6(Ipv6Addr::UNSPECIFIED))?;
    }
    socket.bind(&address.into())?;
    socket.listen(128)?;
    TcpListener::from_std(socket.into())
}

fn bind_all(addresses: &[IpAddr], port: u16) -> io::Result<Vec<TcpListener>> {
    if !addresses.is_empty() {
        let mut port = port;
        let mut listeners = Vec::new();
        for address in addresses {
            let listener = bind_one((*address, port).into())?;
            // A port that the system chose is the same at all addresses.
            port = listener.local_addr()?.port();
            listeners.push(listener);
        }
        return Ok(listeners);
    }
    match bind_one((Ipv6Addr::UNSPECIFIED, port).into()) {
        Err(error) if error.raw_os_error() == Some(libc::EAFNOSUPPORT) => {
            Ok(vec![bind_one((Ipv4Addr::UNSPECIFIED, port).into())?])
        }
        bound => Ok(vec![bound?]),
    }
}

impl Port {
    /// Listens at all addresses, or everywhere if there are none.
    ///
    /// # Errors
    /// It is taken, or may not be served.
    pub fn bind(name: &'static str, addresses: &[IpAddr], port: u16) -> Result<Self, Error> {
        let listeners =
            bind_all(addresses, port).map_err(|error| Error::Port(name, port, error.into()))?;
        Ok(Self { name, listeners })
    }

    /// The number of the port.
    pub fn number(&self) -> u16 {
        let first = self
            .listeners
            .first()
            .and_then(|listener| listener.local_addr().ok());
        first.map_or(0, |address| address.port())
    }

    /// Starts a task for each listener, which starts one for each connection that is admitted.
    pub fn serve<S, F>(
        self,
        admission: &Rc<Admission>,
        service: &Rc<S>,
        serve: impl Fn(Rc<S>, Guest) -> F + Clone + 'static,
    ) where
        S: 'static,
        F: Future<Output = ()> + 'static,
    {
        for listener in self.listeners {
            let (service, serve) = (service.clone(), serve.clone());
            let serve = move |guest| serve(service.clone(), guest);
            tokio::task::spawn_local(accept(self.name, listener, admission.clone(), serve));
        }
    }
}

/// Who gets in, at all ports.
#[derive(Debug)]
pub struct Admission {
    /// The allow-list.
    pub access: Arc<Access>,
    /// The connections that there are.
    pub seats: Rc<Seats>,
}

/// A connection that was let in.
#[derive(Debug)]
pub struct Guest {
    /// The connection.
    pub stream: TcpStream,
    /// Its other end; IPv4 is shown as such.
    pub peer: SocketAddr,
    /// Its place among all connections.
    pub seat: Seat,
}

/// The connections of all ports, each as the network that it comes from.
#[derive(Debug)]
pub struct Seats {
    taken: RefCell<Vec<IpAddr>>,
    /// Connections at once.
    limit: usize,
}

/// Why there is no place for a connection; the client is to blame.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Full {
    /// All of so many are taken.
    All(usize),
    /// One computer has so many, and no more are for it.
    One(usize),
}

impl fmt::Display for Full {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::All(limit) => write!(
                out,
                "there are {limit} connections already: close some, or wait"
            ),
            Self::One(most) => write!(
                out,
                "there are {most} connections from there already: close some"
            ),
        }
    }
}

/// Whose connections are counted together: an IPv6 computer has a whole network of addresses.
fn origin(ip: IpAddr) -> IpAddr {
    match ip {
        IpAddr::V6(six) => Ipv6Addr::from_bits(six.to_bits() >> 64 << 64).into(),
        IpAddr::V4(_) => ip,
    }
}

impl Seats {
    /// So many of them, all free.
    pub fn new(limit: usize) -> Self {
        Self {
            taken: RefCell::default(),
            limit,
        }
    }

    /// Lines for the status.
    pub fn describe(&self) -> String {
        let taken = self.taken.borrow().len();
        format!("connections {taken} of {}\n", self.limit)
    }

    /// A place. A quarter of them is out of reach for each computer, so that none keeps all others out.
    ///
    /// # Errors
    /// There is none.
    pub fn take(self: &Rc<Self>, ip: IpAddr) -> Result<Seat, Full> {
        let limit = self.limit;
        let mut taken = self.taken.borrow_mut();
        let ip = origin(ip);
        if taken.len() >= limit {
            return Err(Full::All(limit));
        }
        let most = limit - limit / limits::CONNECTIONS_OF_OTHERS;
        if taken.iter().filter(|other| **other == ip).count() >= most {
            return Err(Full::One(most));
        }
        taken.push(ip);
        Ok(Seat(self.clone(), ip))
    }
}

/// One of the connections that may be there at once.
#[derive(Debug)]
pub struct Seat(Rc<Seats>, IpAddr);

impl Drop for Seat {
    fn drop(&mut self) {
        let mut taken = self.0.taken.borrow_mut();
        if let Some(index) = taken.iter().position(|ip| *ip == self.1) {
            taken.swap_remove(index);
        }
    }
}

async fn accept<F>(
    name: &'static str,
    listener: TcpListener,
    admission: Rc<Admission>,
    serve: impl Fn(Guest) -> F,
) where
    F: Future<Output = ()> + 'static,
{
    loop {
        let (stream, peer) = match listener.accept().await {
            Ok(accepted) => accepted,
            Err(error) => {
                // Too many open files: those that close make room.
                tracing::warn!(target: log::CLIENTS, "{name}: {error}");
                tokio::time::sleep(Duration::from_millis(100)).await;
                continue;
            }
        };
        let peer = SocketAddr::new(plain(peer.ip()), peer.port());
        if !admission.access.admits(peer.ip()) {
            tracing::warn!(target: log::CLIENTS, "{name}: {peer} is not in the list of --allow");
            continue;
        }
        let seat = match admission.seats.take(peer.ip()) {
            Ok(seat) => seat,
            Err(why) => {
                tracing::warn!(target: log::CLIENTS, "{name}: {peer} is refused: {why}");
                if name == "control" {
                    // The only port on which people read; if it has no room for it, there is nobody to tell.
                    let _ = stream.try_write(&encode(format!("error: {why}").as_bytes()));
                }
                continue;
            }
        };
        prepare(&stream);
        tokio::task::spawn_local(serve(Guest { stream, peer, seat }));
    }
}

/// Options of an accepted socket; without them it works as well.
fn prepare(stream: &TcpStream) {
    let socket = SockRef::from(stream);
    let _ = socket.set_tcp_nodelay(true);
    let _ = socket.set_keepalive(true);
    let _ = socket.set_tos_v4(TYPE_OF_SERVICE);
    // What waits for a client that does not read stands in its outbox, which is bounded, and not in the kernel.
    let _ = socket.set_send_buffer_size(limits::SEND_BUFFER_BYTES);
}
