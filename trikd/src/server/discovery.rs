//! Answers who looks for robots in the network (multicast DNS, port 5353).
//!
//! Owns one socket and its memberships. Without it everything else works: addresses can be typed.

use super::mailbox::local_ip;
use crate::protocol::dns::{Robot, label, questions};
use socket2::{Domain, InterfaceIndexOrAddress, Protocol, SockRef, Socket, Type};
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, SocketAddrV4};
use std::time::Duration;
use tokio::net::UdpSocket;

const GROUP: Ipv4Addr = Ipv4Addr::new(224, 0, 0, 251);
const PORT: u16 = 5353;
/// Milliseconds between two looks for networks that have come up.
const JOIN_MS: u64 = 10_000;

fn open() -> io::Result<UdpSocket> {
    let socket = Socket::new(Domain::IPV4, Type::DGRAM, Some(Protocol::UDP))?;
    socket.set_reuse_address(true)?;
    // Others on this machine may answer as well.
    socket.set_reuse_port(true)?;
    socket.set_nonblocking(true)?;
    socket.bind(&SocketAddr::from((Ipv4Addr::UNSPECIFIED, PORT)).into())?;
    socket.set_multicast_ttl_v4(255)?;
    UdpSocket::from_std(socket.into())
}

/// Joins the group on every network that is there; it is no failure to be a member already.
fn join(socket: &UdpSocket) {
    let Ok(networks) = std::fs::read_dir("/sys/class/net") else {
        return;
    };
    for network in networks.flatten() {
        let index = std::fs::read_to_string(network.path().join("ifindex"));
        if let Some(index) = index.ok().and_then(|index| index.trim().parse().ok()) {
            let _ = SockRef::from(socket)
                .join_multicast_v4_n(&GROUP, &InterfaceIndexOrAddress::Index(index));
        }
    }
}

/// What is told of this robot.
#[derive(Clone, Debug)]
pub struct About {
    /// Its name; None: the name of the host.
    pub name: Option<String>,
    /// The model of the controller.
    pub config_version: String,
    /// The control port.
    pub port: u16,
}

/// Answers for ever.
///
/// # Errors
/// There is no socket.
pub async fn answer(about: About) -> io::Result<()> {
    let socket = open()?;
    let host = || {
        let name = std::fs::read_to_string("/proc/sys/kernel/hostname").ok()?;
        Some(name.trim().to_owned())
    };
    let name = label(&about.name.or_else(host).unwrap_or_default());
    let records = vec![
        "version=3.1.4".to_owned(),
        format!("config={}", about.config_version),
    ];
    let mut buffer = [0; 1500];
    let mut networks = tokio::time::interval(Duration::from_millis(JOIN_MS));
    loop {
        let (size, from) = tokio::select! {
            _ = networks.tick() => {
                join(&socket);
                continue;
            }
            received = socket.recv_from(&mut buffer) => match received {
                Ok(received) => received,
                Err(_) => continue,
            },
        };
        let Some((number, asked)) = questions(&buffer[..size]) else {
            continue;
        };
        let Some(IpAddr::V4(ip)) = local_ip(from.ip()) else {
            continue;
        };
        let robot = Robot {
            name: name.clone(),
            ip,
            port: about.port,
            about: records.clone(),
        };
        // Who asks from another port is no responder and takes an answer with the number of its question (RFC 6762, 6.7).
        let is_simple = from.port() != PORT;
        if let Some(answer) = robot.answer(if is_simple { number } else { 0 }, &asked) {
            let is_direct = is_simple || asked.iter().all(|question| question.wants_direct);
            let to = if is_direct {
                from
            } else {
                SocketAddr::V4(SocketAddrV4::new(GROUP, PORT))
            };
            let _ = socket.send_to(&answer, to).await;
        }
    }
}
