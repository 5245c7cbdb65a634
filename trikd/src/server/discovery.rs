//! Answers who looks for robots in the network (multicast DNS, port 5353).
//!
//! Owns one socket and its memberships. Without it everything else works: addresses can be typed.

use super::mailbox::local_ip;
use crate::limits;
use crate::protocol::dns::{Robot, label, questions};
use socket2::{Domain, InterfaceIndexOrAddress, Protocol, SockRef, Socket, Type};
use std::io;
use std::net::{IpAddr, Ipv4Addr, SocketAddr, SocketAddrV4};
use std::time::Duration;
use tokio::net::UdpSocket;
use tokio::time::{Instant, sleep_until};

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

/// How many questions are still looked at in this piece of time: a flood of them is somebody's mistake or malice, and each costs
/// a look at the ways in the network.
struct Budget {
    until: Instant,
    left: u32,
}

impl Default for Budget {
    fn default() -> Self {
        Self {
            until: Instant::now(),
            left: 0,
        }
    }
}

impl Budget {
    /// Waits until one more may be looked at, and counts it.
    async fn wait(&mut self) {
        if self.left == 0 {
            sleep_until(self.until).await;
            let window_ms = limits::QUESTIONS_WINDOW_MS;
            let pieces = u32::try_from(1000 / window_ms).unwrap_or(1);
            self.until = Instant::now() + Duration::from_millis(window_ms);
            self.left = limits::QUESTIONS_PER_SECOND / pieces;
        }
        self.left -= 1;
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
    /// The port of the page for browsers, if one is served there.
    pub page: Option<u16>,
}

impl About {
    /// What is told beside the name and the address.
    fn records(&self) -> Vec<String> {
        let page = self.page.map(|port| format!("page={port}"));
        let first = [
            "version=3.1.4".to_owned(),
            format!("config={}", self.config_version),
        ];
        first.into_iter().chain(page).collect()
    }
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
    let records = about.records();
    let name = label(&about.name.or_else(host).unwrap_or_default());
    let mut buffer = [0; 1500];
    let mut networks = tokio::time::interval(Duration::from_millis(JOIN_MS));
    let mut budget = Budget::default();
    loop {
        budget.wait().await;
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robot_with_a_page_tells_where_that_is() {
        let mut about = About {
            name: None,
            config_version: "model-2015".to_owned(),
            port: 8888,
            page: None,
        };
        assert_eq!(about.records(), ["version=3.1.4", "config=model-2015"]);
        about.page = Some(8000);
        assert_eq!(about.records()[2], "page=8000");
    }
}
