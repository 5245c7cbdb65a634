//! `trik class find`: robots in the network that answer by multicast DNS.
//!
//! Owns the question, and what of the answers is believed: they come from anybody, so names are made harmless and there is an end
//! to how many are listened to.

use super::FindArgs;
use crate::error::Error;
use crate::limits;
use crate::output::standard;
use crate::refusal::Refusal;
use mdns_sd::{IfKind, ResolvedService, ServiceDaemon, ServiceEvent};
use std::collections::{BTreeMap, BTreeSet};
use std::net::IpAddr;
use std::time::{Duration, Instant};

/// The kind of service that robots are.
const SERVICE: &str = "_trik._tcp.local.";
/// The port that is not said.
const PORT: u16 = 8888;

/// A robot that has answered.
#[derive(Clone, Debug, PartialEq, Eq)]
struct Answer {
    name: String,
    at: String,
    page: Option<u16>,
}

/// Looks for robots and lists them.
///
/// # Errors
/// None has answered, or this computer cannot ask.
pub(super) fn find(args: &FindArgs) -> Result<u8, Refusal> {
    let fail = |error: mdns_sd::Error| {
        Error::system("looking for robots (multicast DNS, port 5353)", error)
    };
    let daemon = ServiceDaemon::new().map_err(fail)?;
    // Robots have addresses of IPv4.
    daemon.disable_interface(IfKind::IPv6).map_err(fail)?;
    let events = daemon.browse(SERVICE).map_err(fail)?;
    let end = Instant::now() + Duration::from_secs(args.seconds.into());
    let mut all: BTreeMap<String, Answer> = BTreeMap::new();
    let mut heard = 0;
    while heard < limits::FOUND_EVENTS_MAX && all.len() < limits::FLEET_MAX {
        let Ok(event) = events.recv_timeout(end.saturating_duration_since(Instant::now())) else {
            break;
        };
        heard += 1;
        if let ServiceEvent::ServiceResolved(service) = event
            && let Some(answer) = answer(&service)
        {
            all.insert(answer.at.clone(), answer);
        }
    }
    // It ends with this process, too.
    let _ = daemon.shutdown();
    if all.is_empty() {
        return Err(Refusal::new(format!(
            "no robot has answered within {} s: is this computer in their network?",
            args.seconds
        )));
    }
    standard(text(all.into_values()).as_bytes()).map(|()| 0)
}

/// What an answer says that can be used.
fn answer(service: &ResolvedService) -> Option<Answer> {
    let ip = service
        .get_addresses_v4()
        .into_iter()
        .map(IpAddr::V4)
        .find(|ip| !ip.is_unspecified() && !ip.is_multicast())?;
    if service.get_port() == 0 {
        return None;
    }
    let page = service.get_property_val_str("page");
    let full = service.get_fullname();
    let name = full.strip_suffix(SERVICE).unwrap_or(full);
    Some(Answer {
        name: name_of(name.trim_end_matches('.')),
        at: match service.get_port() {
            PORT => ip.to_string(),
            port => format!("{ip}:{port}"),
        },
        page: page
            .and_then(|port| port.parse().ok())
            .filter(|port| *port > 0),
    })
}

/// A name of a stranger as a word of a file of a class; there is room for a number behind it.
fn name_of(text: &str) -> String {
    let fits = |c: char| c.is_alphanumeric() || "-_.".contains(c);
    let mut name = String::new();
    for c in text.chars().map(|c| if fits(c) { c } else { '-' }) {
        if name.len() + c.len_utf8() > limits::FOUND_NAME_BYTES_MAX {
            break;
        }
        name.push(c);
    }
    match name.is_empty() {
        true => "robot".to_owned(),
        false => name,
    }
}

/// A line for each, in columns; a name that several have gets a number.
fn text(all: impl Iterator<Item = Answer>) -> String {
    let mut lines = Vec::new();
    let mut names = BTreeSet::new();
    for answer in all {
        let mut name = answer.name.clone();
        let mut number = 1;
        while !names.insert(name.clone()) {
            number += 1;
            name = format!("{}-{number}", answer.name);
        }
        let page = answer
            .page
            .map_or_else(String::new, |port| format!("  page={port}"));
        lines.push((name, format!("{}{page}", answer.at)));
    }
    let width = lines
        .iter()
        .map(|(name, _)| name.chars().count())
        .max()
        .unwrap_or(0);
    let line = |(name, rest): &(String, String)| format!("{name:<width$}  {rest}\n");
    lines.iter().map(line).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_name_of_a_stranger_is_a_harmless_word() {
        for (text, name) in [
            ("trik-1a2b", "trik-1a2b"),
            ("a b\u{1b}[2J#", "a-b--2J-"),
            ("x/../y, z:1", "x-..-y--z-1"),
            ("", "robot"),
        ] {
            assert_eq!(name_of(text), name);
        }
        for letter in ["x", "\u{65e5}"] {
            let name = name_of(&letter.repeat(1000));
            assert_eq!(name.len(), limits::FOUND_NAME_BYTES_MAX / 3 * 3);
        }
    }

    #[test]
    fn what_was_found_is_a_file_of_a_class() {
        let answer = |name: &str, at: &str, page| Answer {
            name: name.to_owned(),
            at: at.to_owned(),
            page,
        };
        let all = [
            answer("trik", "192.168.77.1", Some(8000)),
            answer("trik", "192.168.77.2:9", None),
            answer("trik-2", "192.168.77.3", None),
        ];
        let told = text(all.into_iter());
        assert_eq!(
            told,
            "trik      192.168.77.1  page=8000\ntrik-2    192.168.77.2:9\ntrik-2-2  192.168.77.3\n"
        );
        let home = tempfile::tempdir().expect("a directory");
        let file = home.path().join("found.txt");
        std::fs::write(&file, told).expect("a file");
        let class = crate::remote::roster::class(&file.display().to_string()).expect("a class");
        assert_eq!(class.robots.len(), 3);
    }
}
