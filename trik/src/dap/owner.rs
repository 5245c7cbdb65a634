//! Whose process is at the other end of a connection within this computer.
//!
//! Owns the reading of the kernel's table: a connection over loopback does not say which user has made it, and the kernel does.

use std::fs;
use std::net::{IpAddr, Ipv4Addr, Ipv6Addr, SocketAddr};

/// The state of a connection with both its ends (proc_net_tcp.rst, include/net/tcp_states.h). One that is being closed may
/// have no process any more, and then the kernel shows 0 as its user.
const ESTABLISHED: &str = "01";

/// The user whose process has made this connection; none if the kernel does not say, or it is being closed.
pub(super) fn of(peer: SocketAddr, own: SocketAddr) -> Option<u32> {
    // A socket of IPv6 may have made a connection of IPv4.
    let tables = ["/proc/net/tcp", "/proc/net/tcp6"];
    tables.into_iter().find_map(|path| {
        let table = fs::read_to_string(path).ok()?;
        in_table(&table, plain(peer), plain(own))
    })
}

/// Whether a process of this user may speak with one of ours: it is ours too, or it may do everything anyway.
pub(super) fn may_command(user: Option<u32>, own: u32) -> bool {
    user.is_some_and(|user| user == own || user == 0)
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
            assert_eq!(of(peer, own), Some(own_user()), "{address}");
            assert_eq!(of(own, own), None);
            drop(client);
            assert_eq!(of(peer, own), None, "nobody's any more");
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
    fn only_who_could_do_it_anyway_may_command() {
        assert!(may_command(Some(1000), 1000) && may_command(Some(0), 1000));
        for other in [None, Some(1001)] {
            assert!(!may_command(other, 1000) && !may_command(other, 0));
        }
    }
}
