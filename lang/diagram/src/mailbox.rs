//! The questions of a program to the mailbox, as types, and how they are written.
//!
//! Owns their words. What is answered is decided by the owner of a mailbox: the daemon, a program that runs alone, the
//! judge. Texts of programs stand in them, so what is no number is not refused but missing.

use std::fmt;

/// A question; what is no question but an order has an empty answer.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Question<'a> {
    /// Send a text to robots.
    Send {
        /// Hull number of the robots, -1 for all; None: it was no number.
        hull: Option<i32>,
        /// What is sent.
        text: &'a str,
    },
    /// Connect to a robot.
    Connect {
        /// Its address.
        address: &'a str,
        /// The port of its mailbox; None: that of our own.
        port: Option<u16>,
    },
    /// Connect to a robot, with a hull number of our own.
    Join {
        /// Its address.
        address: &'a str,
        /// The port of its mailbox; -1 for that of our own.
        port: i32,
        /// Our hull number; -1 for the one that we have.
        hull: i32,
    },
    /// Which hull number we have.
    Hull,
    /// Take this hull number.
    SetHull(i32),
    /// The address of the robot that was joined.
    Server,
    /// Our own address.
    Ip,
    /// Whether there is a connection to any robot: 0 or 1.
    Connected,
    /// Whether there is a mailbox at all: 0 or 1.
    Enabled,
    /// Look for our own address again, which is done at each [`Question::Ip`] anyway.
    Renew,
}

/// The words of [`Question`].
pub const QUESTIONS: [&str; 9] = [
    "send",
    "connect",
    "join",
    "hull",
    "server",
    "ip",
    "connected",
    "enabled",
    "renew",
];

impl<'a> Question<'a> {
    /// What the words of a program ask. None: nothing that has an answer.
    pub fn parse(words: &'a str) -> Option<Self> {
        let (word, rest) = words.split_once(' ').unwrap_or((words, ""));
        let mut fields = rest.split_ascii_whitespace();
        Some(match word {
            "send" => {
                let (hull, text) = rest.split_once(' ').unwrap_or((rest, ""));
                let hull = hull.parse().ok();
                Self::Send { hull, text }
            }
            "connect" => Self::Connect {
                address: fields.next().unwrap_or(""),
                port: fields.next().and_then(|port| port.parse().ok()),
            },
            "join" => {
                let address = fields.next().unwrap_or("");
                let mut number = || {
                    let field = fields.next();
                    field.and_then(|field| field.parse().ok()).unwrap_or(-1)
                };
                Self::Join {
                    address,
                    port: number(),
                    hull: number(),
                }
            }
            "hull" => match fields.next().map(str::parse) {
                Some(Ok(hull)) => Self::SetHull(hull),
                Some(Err(_)) | None => Self::Hull,
            },
            "server" => Self::Server,
            "ip" => Self::Ip,
            "connected" => Self::Connected,
            "enabled" => Self::Enabled,
            "renew" => Self::Renew,
            _ => return None,
        })
    }
}

impl fmt::Display for Question<'_> {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Send {
                hull: Some(hull),
                text,
            } => write!(out, "send {hull} {text}"),
            Self::Send { hull: None, text } => write!(out, "send - {text}"),
            Self::Connect {
                address,
                port: Some(port),
            } => write!(out, "connect {address} {port}"),
            Self::Connect {
                address,
                port: None,
            } => write!(out, "connect {address}"),
            Self::Join {
                address,
                port,
                hull,
            } => write!(out, "join {address} {port} {hull}"),
            Self::Hull => write!(out, "hull"),
            Self::SetHull(hull) => write!(out, "hull {hull}"),
            Self::Server => write!(out, "server"),
            Self::Ip => write!(out, "ip"),
            Self::Connected => write!(out, "connected"),
            Self::Enabled => write!(out, "enabled"),
            Self::Renew => write!(out, "renew"),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn a_question_is_understood_as_it_was_meant(
            text in "(?s).{0,40}",
            address in "[!-~]{1,20}",
            hull: i32,
            port: u16,
        ) {
            let (text, address) = (text.as_str(), address.as_str());
            for question in [
                Question::Send { hull: Some(hull), text },
                Question::Send { hull: None, text },
                Question::Connect { address, port: Some(port) },
                Question::Connect { address, port: None },
                Question::Join { address, port: port.into(), hull },
                Question::Hull,
                Question::SetHull(hull),
                Question::Server,
                Question::Ip,
                Question::Connected,
                Question::Enabled,
                Question::Renew,
            ] {
                let words = question.to_string();
                prop_assert_eq!(Question::parse(&words), Some(question));
            }
        }
    }

    #[test]
    fn what_is_no_number_is_missing() {
        let everybody = Question::Send {
            hull: None,
            text: "b",
        };
        assert_eq!(Question::parse("send a b"), Some(everybody));
        let join = Question::Join {
            address: "-",
            port: -1,
            hull: -1,
        };
        assert_eq!(Question::parse("join - 1e9"), Some(join));
        assert_eq!(Question::parse("hull many"), Some(Question::Hull));
        assert_eq!(Question::parse(""), None);
        assert_eq!(Question::parse("renewal"), None);
        for word in QUESTIONS {
            assert!(Question::parse(word).is_some(), "{word}");
        }
    }
}
