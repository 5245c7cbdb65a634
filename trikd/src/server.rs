//! Sockets: all listeners or none, who gets in, and which task serves whom.
//!
//! `lobby` is for clients without a place. `control`, `telemetry`, `mailbox`, `gamepad`, `video` and `variables` are one port each; `datagrams` and `discovery`
//! are UDP, `page` is for browsers. What is said on a port is in `protocol`.

// A request, a message or a command that is forgotten must not pass in silence.
#![deny(clippy::wildcard_enum_match_arm)]

pub mod control;
pub mod datagrams;
pub mod discovery;
pub mod gamepad;
mod guest;
mod lobby;
pub mod mailbox;
pub mod page;
pub mod recordings;
pub mod telemetry;
pub mod variables;
pub mod video;

use crate::access::Access;
use crate::clients::Clients;
use crate::error::Error;
use crate::protocol::mail::plain;
use crate::{limits, log, panics};
use ::page::seats::{Room, Seats};
pub use guest::Guest;
use socket2::{Domain, Protocol, SockRef, Socket, Type};
use std::io;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};
use std::rc::Rc;
use std::sync::Arc;
use std::time::Duration;
use tokio::net::{TcpListener, TcpStream};

/// What the official controller sets: interactive traffic first.
const TYPE_OF_SERVICE: u32 = 0x40;

/// The port that robots are stopped at.
const CONTROL: &str = "control";

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
    socket.listen(limits::BACKLOG)?;
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
        let name = self.name;
        for listener in self.listeners.into_iter().map(Rc::new) {
            let (admission, service, serve) = (admission.clone(), service.clone(), serve.clone());
            let accept = move || {
                let (service, serve) = (service.clone(), serve.clone());
                let serve = move |guest| serve(service.clone(), guest);
                accept(name, listener.clone(), admission.clone(), serve)
            };
            tokio::task::spawn_local(panics::restart_task_on_panic(name, accept));
        }
    }
}

/// Who gets in, at all ports.
#[derive(Debug)]
pub struct Admission {
    access: Arc<Access>,
    clients: Rc<Clients>,
    seats: Arc<Seats>,
    lobby: Arc<Seats>,
}

impl Admission {
    /// By the allow-list, who is in control, and the connections that there are.
    pub fn new(access: Arc<Access>, clients: Rc<Clients>, seats: Arc<Seats>) -> Self {
        Self {
            access,
            clients,
            seats,
            lobby: lobby::seats(),
        }
    }
}

/// The connections of all ports.
pub fn seats(connections: usize) -> Arc<Seats> {
    Seats::new(Room {
        all: connections,
        // The others are out of reach for each computer, so that none keeps all others out.
        one: connections - connections / limits::CONNECTIONS_OF_OTHERS,
        kept: limits::CONNECTIONS_KEPT,
        stuck_time: Duration::from_millis(limits::STUCK_MS),
        mute_time: Duration::from_millis(limits::SILENCE_MS),
        spares_idle: true,
    })
}

async fn accept<F>(
    name: &'static str,
    listener: Rc<TcpListener>,
    admission: Rc<Admission>,
    serve: impl Fn(Guest) -> F + Clone + 'static,
) where
    F: Future<Output = ()> + 'static,
{
    let at_once = match name {
        CONTROL => limits::CONTROL_ACCEPTS,
        _ => limits::ACCEPTS,
    };
    let mut left = at_once;
    loop {
        if left == 0 {
            tokio::task::yield_now().await;
            left = at_once;
        }
        left -= 1;
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
        match admission
            .seats
            .take(peer.ip(), admission.clients.whom(peer.ip()))
        {
            Ok(seat) => {
                prepare(&stream);
                let guest = Guest {
                    stream,
                    peer,
                    seat,
                    begun: Vec::new(),
                    full: None,
                };
                tokio::task::spawn_local(serve(guest));
            }
            Err(why) => {
                tracing::warn!(target: log::CLIENTS, "{name}: {peer} is refused: {why}");
                // The only port on which robots are stopped, and on which people read.
                if name == CONTROL {
                    lobby::wait(&admission.lobby, stream, peer, why, serve.clone());
                }
            }
        }
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
