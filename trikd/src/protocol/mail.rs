//! Messages between the mailboxes of robots, port 8889.

use std::fmt;
use std::net::{IpAddr, Ipv4Addr};

/// One message.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Message {
    /// First frame of the side that connects.
    Register {
        /// Port of its own server.
        port: u16,
        /// Its hull number.
        hull: i32,
    },
    /// This robot exists, or has changed its hull number.
    Connection {
        /// Address of its server.
        ip: IpAddr,
        /// Port of its server.
        port: u16,
        /// Its hull number.
        hull: i32,
    },
    /// Hull number of the one who says it.
    Own(i32),
    /// A text for programs.
    Data(String),
    /// Something else.
    Unknown,
}

impl Message {
    /// What a frame says; wrong counts of fields and what is no number make it unknown.
    pub fn parse(frame: &[u8]) -> Self {
        let text = String::from_utf8_lossy(frame);
        let (word, rest) = text.split_once(':').unwrap_or((&text, ""));
        let known = match word {
            "register" => register(rest),
            "connection" => connection(rest),
            "self" => rest.trim().parse().ok().map(Self::Own),
            "data" => Some(Self::Data(rest.to_owned())),
            _ => None,
        };
        known.unwrap_or(Self::Unknown)
    }
}

fn register(text: &str) -> Option<Message> {
    let (port, hull) = text.split_once(':')?;
    Some(Message::Register {
        port: port.trim().parse().ok()?,
        hull: hull.trim().parse().ok()?,
    })
}

/// Fields are counted from the end, so that addresses of IPv6 need no other form; the original robots ignore those.
fn connection(text: &str) -> Option<Message> {
    let mut fields = text.rsplitn(3, ':');
    let hull = fields.next()?.trim().parse().ok()?;
    let port = fields.next()?.trim().parse().ok()?;
    let ip = fields.next()?.trim().parse().ok()?;
    Some(Message::Connection { ip, port, hull })
}

impl fmt::Display for Message {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Register { port, hull } => write!(out, "register:{port}:{hull}"),
            Self::Connection { ip, port, hull } => write!(out, "connection:{ip}:{port}:{hull}"),
            Self::Own(hull) => write!(out, "self:{hull}"),
            Self::Data(text) => write!(out, "data:{text}"),
            Self::Unknown => Ok(()),
        }
    }
}

/// The same address however it came: IPv4 through a socket of IPv6 is IPv4.
pub fn plain(ip: IpAddr) -> IpAddr {
    match ip {
        IpAddr::V6(six) => six.to_ipv4_mapped().map_or(ip, IpAddr::V4),
        IpAddr::V4(_) => ip,
    }
}

/// Nobody's address.
pub const NOWHERE: IpAddr = IpAddr::V4(Ipv4Addr::UNSPECIFIED);

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_are_read_as_they_are_written() {
        for text in [
            "register:8889:7",
            "connection:127.0.0.1:8896:9",
            "connection:fe80::1:8889:-2",
            "self:0",
            "data:a:b\u{e9}",
            "data:",
        ] {
            let message = Message::parse(text.as_bytes());
            assert_ne!(message, Message::Unknown, "{text}");
            assert_eq!(message.to_string(), text);
        }
    }

    #[test]
    fn wrong_fields_make_nothing() {
        for text in [
            "register:1",
            "register:1:2:3",
            "register:a:1",
            "register:70000:1",
            "connection:1:2",
            "connection:x:1:2",
            "self:",
            "self:x",
            "hello",
            "",
        ] {
            assert_eq!(Message::parse(text.as_bytes()), Message::Unknown, "{text}");
        }
        assert_eq!(
            Message::parse(b"data:\xff"),
            Message::Data("\u{fffd}".to_owned())
        );
    }
}
