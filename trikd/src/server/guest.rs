//! A connection on its way to the service of its port.
//!
//! Owns nothing but that: the stream, its place, and what is known of it before anything is served.

use ::page::seats::{Full, Seat};
use std::net::SocketAddr;
use tokio::net::TcpStream;

/// A connection that was let in.
#[derive(Debug)]
pub struct Guest {
    /// The connection.
    pub stream: TcpStream,
    /// Its other end; IPv4 is shown as such.
    pub peer: SocketAddr,
    /// Its place among all connections.
    pub seat: Seat,
    /// What it has sent already.
    pub begun: Vec<u8>,
    /// Why it has no place of its own, and stands in the lobby.
    pub full: Option<Full>,
}
