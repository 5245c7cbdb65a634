//! Questions and answers of multicast DNS (RFC 6762) and service discovery (RFC 6763), as far as one robot needs them.
//!
//! Owns the reading of names with their pointers, which strangers send, and the writing of answers.

use crate::limits;
use std::net::Ipv4Addr;

/// Types of records (RFC 1035, RFC 2782).
const A: u16 = 1;
const PTR: u16 = 12;
const TXT: u16 = 16;
const SRV: u16 = 33;
const ANY: u16 = 255;
/// The class of the Internet; the highest bit wants a direct answer in a question, and replaces others in an answer.
const INTERNET: u16 = 1;
const TOP_BIT: u16 = 0x8000;
/// Seconds that others may remember an answer.
const TTL_S: u32 = 120;

/// The kind of service.
pub const SERVICE: &str = "_trik._tcp.local";
/// The list of all kinds.
const KINDS: &str = "_services._dns-sd._udp.local";

/// What is told of the robot.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Robot {
    /// Its name, one label.
    pub name: String,
    /// Its address as the asking computer sees it.
    pub ip: Ipv4Addr,
    /// Its control port.
    pub port: u16,
    /// Words about it.
    pub about: Vec<String>,
}

struct Reader<'a> {
    bytes: &'a [u8],
    at: usize,
}

impl Reader<'_> {
    fn byte(&mut self) -> Option<u8> {
        let byte = *self.bytes.get(self.at)?;
        self.at += 1;
        Some(byte)
    }

    fn word(&mut self) -> Option<u16> {
        Some(u16::from_be_bytes([self.byte()?, self.byte()?]))
    }

    /// Labels joined by dots, in small letters.
    fn name(&mut self) -> Option<String> {
        let mut name = String::new();
        let mut end = None;
        for _ in 0..=limits::DNS_POINTERS_MAX {
            loop {
                match self.byte()? {
                    0 => {
                        self.at = end.unwrap_or(self.at);
                        return Some(name);
                    }
                    size if size & 0xc0 == 0 => {
                        let label = self.bytes.get(self.at..self.at + usize::from(size))?;
                        if !name.is_empty() {
                            name.push('.');
                        }
                        name.push_str(&String::from_utf8_lossy(label).to_lowercase());
                        self.at += usize::from(size);
                        if name.len() > limits::DNS_NAME_BYTES_MAX {
                            return None;
                        }
                    }
                    high if high & 0xc0 == 0xc0 => {
                        let low = self.byte()?;
                        end.get_or_insert(self.at);
                        self.at = usize::from(u16::from_be_bytes([high & 0x3f, low]));
                        break;
                    }
                    _ => return None,
                }
            }
        }
        None
    }
}

/// One question.
#[derive(Clone, Debug, Eq, PartialEq)]
pub struct Question {
    name: String,
    kind: u16,
    /// The answer shall come to the asker alone.
    pub wants_direct: bool,
}

/// Number of the message and its questions; nothing for answers and nonsense.
pub fn questions(bytes: &[u8]) -> Option<(u16, Vec<Question>)> {
    let mut reader = Reader { bytes, at: 0 };
    let (number, flags, count) = (reader.word()?, reader.word()?, reader.word()?);
    if flags & 0xf800 != 0 {
        return None;
    }
    reader.at = 12;
    let mut questions = Vec::new();
    for _ in 0..count.min(limits::DNS_QUESTIONS_MAX) {
        let name = reader.name()?;
        let (kind, class) = (reader.word()?, reader.word()?);
        if class & !TOP_BIT == INTERNET || class & !TOP_BIT == ANY {
            questions.push(Question {
                name,
                kind,
                wants_direct: class & TOP_BIT != 0,
            });
        }
    }
    Some((number, questions))
}

fn put_name(out: &mut Vec<u8>, name: &str) {
    for label in name.split('.').filter(|label| !label.is_empty()) {
        let label = &label.as_bytes()[..label.len().min(63)];
        out.push(u8::try_from(label.len()).unwrap_or(63));
        out.extend_from_slice(label);
    }
    out.push(0);
}

fn put_record(out: &mut Vec<u8>, name: &str, kind: u16, data: &[u8]) {
    put_name(out, name);
    out.extend_from_slice(&kind.to_be_bytes());
    // Several robots share the names of lists, all other names are ours alone.
    let class = if kind == PTR {
        INTERNET
    } else {
        INTERNET | TOP_BIT
    };
    out.extend_from_slice(&class.to_be_bytes());
    out.extend_from_slice(&TTL_S.to_be_bytes());
    out.extend_from_slice(&u16::try_from(data.len()).unwrap_or(u16::MAX).to_be_bytes());
    out.extend_from_slice(data);
}

fn encoded(name: &str) -> Vec<u8> {
    let mut bytes = Vec::new();
    put_name(&mut bytes, name);
    bytes
}

impl Robot {
    fn record(&self, kind: u16) -> (String, Vec<u8>) {
        let (host, instance) = (
            format!("{}.local", self.name),
            format!("{}.{SERVICE}", self.name),
        );
        match kind {
            A => (host, self.ip.octets().to_vec()),
            SRV => {
                let mut data = vec![0, 0, 0, 0];
                data.extend_from_slice(&self.port.to_be_bytes());
                data.extend(encoded(&host));
                (instance, data)
            }
            TXT => {
                let mut data = Vec::new();
                for word in &self.about {
                    let word = &word.as_bytes()[..word.len().min(255)];
                    data.push(u8::try_from(word.len()).unwrap_or(255));
                    data.extend_from_slice(word);
                }
                (instance, data)
            }
            _ => (SERVICE.to_owned(), encoded(&instance)),
        }
    }

    /// The answer to questions; None if none of them is about us.
    pub fn answer(&self, number: u16, questions: &[Question]) -> Option<Vec<u8>> {
        let mut kinds: Vec<u16> = Vec::new();
        let mut lists_kinds = false;
        for question in questions {
            let fits = |kind| question.kind == kind || question.kind == ANY;
            if question.name == SERVICE && fits(PTR) {
                kinds.extend([PTR, SRV, TXT, A]);
            }
            lists_kinds |= question.name == KINDS && fits(PTR);
            for kind in [SRV, TXT, A] {
                if self.record(kind).0.to_lowercase() == question.name && fits(kind) {
                    kinds.push(kind);
                }
            }
        }
        kinds.sort_unstable();
        kinds.dedup();
        let count = kinds.len() + usize::from(lists_kinds);
        if count == 0 {
            return None;
        }
        let mut out = Vec::new();
        // An answer with authority; no questions, the records, nothing else.
        for word in [number, 0x8400, 0, u16::try_from(count).unwrap_or(0), 0, 0] {
            out.extend_from_slice(&word.to_be_bytes());
        }
        if lists_kinds {
            put_record(&mut out, KINDS, PTR, &encoded(SERVICE));
        }
        for kind in kinds {
            let (name, data) = self.record(kind);
            put_record(&mut out, &name, kind, &data);
        }
        Some(out)
    }
}

/// One label out of any text: letters, digits and hyphens.
pub fn label(text: &str) -> String {
    let plain = text
        .chars()
        .map(|c| if c.is_ascii_alphanumeric() { c } else { '-' });
    let label: String = plain.take(60).collect();
    if label.trim_matches('-').is_empty() {
        "trik".to_owned()
    } else {
        label
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn question(name: &str, kind: u16) -> Vec<u8> {
        let mut bytes = vec![0, 7, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0];
        put_name(&mut bytes, name);
        bytes.extend_from_slice(&kind.to_be_bytes());
        bytes.extend_from_slice(&INTERNET.to_be_bytes());
        bytes
    }

    fn robot() -> Robot {
        Robot {
            name: "Trik-7".to_owned(),
            ip: Ipv4Addr::new(192, 168, 77, 1),
            port: 8888,
            about: vec!["v=1".to_owned()],
        }
    }

    #[test]
    fn who_looks_for_robots_finds_name_port_and_address() {
        let (number, questions) = questions(&question("_Trik._tcp.LOCAL", PTR)).unwrap();
        let answer = robot().answer(number, &questions).unwrap();
        assert_eq!(answer[..12], [0, 7, 0x84, 0, 0, 0, 0, 4, 0, 0, 0, 0]);
        let has = |part: &[u8]| answer.windows(part.len()).any(|window| window == part);
        assert!(has(b"\x06Trik-7\x05_trik\x04_tcp\x05local\0"));
        assert!(has(&[192, 168, 77, 1]) && has(&8888u16.to_be_bytes()) && has(b"\x03v=1"));
    }

    #[test]
    fn others_are_not_answered() {
        for name in ["_http._tcp.local", "trik-8.local", ""] {
            let (number, questions) = questions(&question(name, ANY)).unwrap();
            assert_eq!(robot().answer(number, &questions), None, "{name}");
        }
        let (_, one) = questions(&question("trik-7.local", A)).unwrap();
        assert_eq!(robot().answer(0, &one).unwrap()[7], 1);
        let mut answer = question(SERVICE, PTR);
        answer[2] = 0x84;
        assert_eq!(questions(&answer), None);
    }

    #[test]
    fn names_that_point_at_themselves_end() {
        let mut circle = vec![0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0];
        circle.extend_from_slice(&[0xc0, 12, 0, 12, 0, 1]);
        assert_eq!(questions(&circle), None);
        assert_eq!(questions(&[0; 5]), None);
        assert_eq!(label("my robot \u{e9}!"), "my-robot---");
        assert_eq!(label("..."), "trik");
    }
}
