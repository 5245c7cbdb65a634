//! Whose process is at the other end of a connection within this computer.
//!
//! Owns the reading of the kernel's table: a connection over loopback does not say which user has made it, and the kernel does.

use std::fs;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

/// The state of a connection with both its ends (proc_net_tcp.rst, include/net/tcp_states.h). One that is being closed may
/// have no process any more, and then the kernel shows 0 as its user.
const ESTABLISHED: &str = "01";

/// Whose process has made a connection.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Owner {
    /// A process of this user.
    User(u32),
    /// Nobody any more: it is closed.
    Gone,
    /// The kernel does not say.
    Unknown,
}

/// The owner of a connection of a client.
pub(super) fn of(peer: SocketAddr, own: SocketAddr) -> Owner {
    // A socket of IPv6 may have made a connection of IPv4.
    let tables = ["/proc/net/tcp", "/proc/net/tcp6"];
    let tables: Vec<String> = tables
        .into_iter()
        .filter_map(|path| fs::read_to_string(path).ok())
        .collect();
    let mut users = tables.iter();
    match users.find_map(|table| in_table(table, plain(peer), plain(own))) {
        Some(user) => Owner::User(user),
        None if tables.is_empty() => Owner::Unknown,
        None => Owner::Gone,
    }
}

/// Why a client may not speak with a process of the user `own`; none: it is a process of the same user, or one that may do
/// everything anyway.
pub(super) fn why_not(client: Owner, own: u32) -> Option<&'static str> {
    match client {
        Owner::User(user) if user == own || user == 0 => None,
        Owner::User(_) => Some("is turned away: a program of another user"),
        Owner::Gone => Some("has closed its connection before it was known whose program it is"),
        Owner::Unknown => Some("is turned away: the system does not say whose program it is"),
    }
}

fn plain(address: SocketAddr) -> (IpAddr, u16) {
    (address.ip().to_canonical(), address.port())
}

fn in_table(table: &str, peer: (IpAddr, u16), own: (IpAddr, u16)) -> Option<u32> {
    table.lines().find_map(|line| {
        let mut words = line.split_whitespace().skip(1);
        let from = place(words.next()?)?;
        let to = place(words.next()?)?;
        let state = words.next()?;
        let user = words.nth(3)?;
        let is_it = state == ESTABLISHED && from == peer && to == own;
        is_it.then(|| user.parse().ok())?
    })
}

/// `0100007F:1F90`: words of 32 bits as the processor has them in memory, then the port.
fn place(text: &str) -> Option<(IpAddr, u16)> {
    let (address, port) = text.split_once(':')?;
    let port = u16::from_str_radix(port, 16).ok()?;
    let mut bytes = Vec::new();
    for at in (0..address.len()).step_by(8) {
        let word = u32::from_str_radix(address.get(at..at + 8)?, 16).ok()?;
        bytes.extend(word.to_ne_bytes());
    }
    let ip = match <[u8; 4]>::try_from(bytes.as_slice()) {
        Ok(four) => Ipv4Addr::from(four).into(),
        Err(_) => IpAddr::from(Ipv6Addr::from(<[u8; 16]>::try_from(bytes).ok()?)).to_canonical(),
    };
    Some((ip, port))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::net::{TcpListener, TcpStream};

    fn own_user() -> u32 {
        nix::unistd::getuid().as_raw()
    }

    #[test]
    fn the_owner_of_a_connection_is_known_as_long_as_it_is_open() {
        for address in ["127.0.0.1:0", "[::1]:0"] {
            // A computer without IPv6 has nothing to ask about.
            let Ok(listener) = TcpListener::bind(address) else {
                continue;
            };
            let own = listener.local_addr().expect("an address");
            let client = TcpStream::connect(own).expect("a connection");
            let (_stream, peer) = listener.accept().expect("a client");
            assert_eq!(of(peer, own), Owner::User(own_user()), "{address}");
            assert_eq!(of(own, own), Owner::Gone);
            drop(client);
            assert_eq!(of(peer, own), Owner::Gone, "nobody's any more");
        }
    }

    #[test]
    fn tables_are_read_as_the_kernel_writes_them() {
        let little = cfg!(target_endian = "little");
        let head = "  sl  local_address rem_address   st tx_queue rx_queue tr tm->when retrnsmt   uid  timeout inode\n";
        let line = |from: &str, to: &str, state: &str, user: u32| {
            format!(
                "   1: {from} {to} {state} 00000000:00000000 00:00000000 00000000 {user:5}        0 25 1 0000 20 4 30 10 -1\n"
            )
        };
        let (from, to) = match little {
            true => ("0100007F:9C40", "0100007F:1267"),
            false => ("7F000001:9C40", "7F000001:1267"),
        };
        let loopback = IpAddr::from(Ipv4Addr::LOCALHOST);
        let (peer, own) = ((loopback, 40_000), (loopback, 4711));
        let mapped = |place: &str| match little {
            true => format!("0000000000000000FFFF0000{place}"),
            false => format!("00000000000000000000FFFF{place}"),
        };
        for (table, user) in [
            (
                line(to, from, "01", 7) + &line(from, to, "01", 1001),
                Some(1001),
            ),
            (line(&mapped(from), &mapped(to), "01", 5), Some(5)),
            // Closed by a process that is gone, which is shown as of root.
            (line(from, to, "04", 0), None),
            (line(from, to, "06", 0), None),
            (String::new(), None),
            (
                "rubbish : 7\n1: 00: :00 01\n1: 0:0 zz:zz 01 1 1 1 1\n".to_owned(),
                None,
            ),
        ] {
            assert_eq!(
                in_table(&(head.to_owned() + &table), peer, own),
                user,
                "{table}"
            );
        }
    }

    #[test]
    fn only_who_could_do_it_anyway_may_command_and_others_are_told_apart() {
        let why = |client| why_not(client, 1000);
        assert_eq!((why(Owner::User(1000)), why(Owner::User(0))), (None, None));
        for (client, said) in [
            (Owner::User(1001), "a program of another user"),
            (Owner::Gone, "has closed its connection"),
            (Owner::Unknown, "the system does not say"),
        ] {
            let why = why(client).expect("a reason");
            assert!(why.contains(said), "{why}");
        }
        assert!(why_not(Owner::User(1001), 0).is_some());
    }
}
