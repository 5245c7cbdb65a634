//! Tells the service manager, if there is one, that the tree can be used: the protocol of sd_notify(3).
//!
//! Owns the message and its socket. Knows nothing of the tree.

use std::env;
use std::ffi::{OsStr, OsString};
use std::io;
use std::os::linux::net::SocketAddrExt;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::net::{SocketAddr, UnixDatagram};

/// Sends `READY=1` to the socket that `NOTIFY_SOCKET` names. Without the variable nothing happens; nor if nobody listens,
/// because a tree that can be used is no failure.
pub(super) fn ready() {
    if let Some(socket) = env::var_os("NOTIFY_SOCKET") {
        let _ = send(
            &socket,
            &format!("READY=1\nMAINPID={}\n", std::process::id()),
        );
    }
}

fn send(socket: &OsStr, message: &str) -> io::Result<()> {
    let address = match socket.as_bytes().strip_prefix(b"@") {
        Some(name) => SocketAddr::from_abstract_name(name)?,
        None => SocketAddr::from_pathname(OsString::from(socket))?,
    };
    let sender = UnixDatagram::unbound()?;
    // A full queue must not keep the guardian from its work.
    sender.set_nonblocking(true)?;
    sender.send_to_addr(message.as_bytes(), &address).map(drop)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scratch::Scratch;

    fn received(socket: &UnixDatagram) -> String {
        let mut buffer = [0; 100];
        let size = socket.recv(&mut buffer).expect("a message");
        String::from_utf8_lossy(&buffer[..size]).into_owned()
    }

    #[test]
    fn a_socket_in_the_file_system_gets_the_message() {
        let scratch = Scratch::new();
        let path = scratch.path("notify");
        let socket = UnixDatagram::bind(&path).expect("bound");
        send(path.as_os_str(), "READY=1").expect("sent");
        assert_eq!(received(&socket), "READY=1");
    }

    #[test]
    fn an_abstract_socket_gets_the_message() {
        let name = format!("trikfs-test-{}", std::process::id());
        let address = SocketAddr::from_abstract_name(&name).expect("address");
        let socket = UnixDatagram::bind_addr(&address).expect("bound");
        send(OsStr::new(&format!("@{name}")), "READY=1").expect("sent");
        assert_eq!(received(&socket), "READY=1");
    }

    #[test]
    fn a_socket_that_is_not_there_is_an_error_and_nothing_worse() {
        send(OsStr::new("/nonexistent/socket"), "READY=1").expect_err("nobody");
        send(OsStr::new(&"x".repeat(200)), "READY=1").expect_err("too long");
        send(OsStr::new(""), "READY=1").expect_err("no name");
    }
}
