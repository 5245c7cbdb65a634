//! Frames of the language server and debug adapter protocols: `Content-Length`, an empty line, so many bytes.
//!
//! Owns where a frame begins and ends, also after one that lied. Knows nothing of what is in it.

use crate::limits;
use serde_json::Value;
use std::fmt;
use std::io::{self, BufRead, Read, Write};

/// What comes next.
#[derive(Debug, PartialEq)]
pub enum Frame {
    /// The bytes of a message.
    Body(Vec<u8>),
    /// No message, and why. What follows is looked for.
    Bad(Bad),
}

/// Why bytes are no frame. The other side of the connection has to mend each of them. Shown, it is a sentence for it.
#[derive(Debug, PartialEq, Eq)]
pub enum Bad {
    /// A message is announced with a length above the limit; the length as it was written.
    Long(String),
    /// The length is no number; what was written instead, shortened.
    NoNumber(String),
    /// Bytes stand before the header: the message before is longer than it said.
    BytesBefore,
    /// A line where a header has to be, and it is none.
    NoHeader,
}

impl fmt::Display for Bad {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Long(length) => write!(
                f,
                "a message of {length} bytes is too long: at most {} are taken",
                limits::LSP_MESSAGE_BYTES
            ),
            Self::NoNumber(text) => {
                write!(f, "Content-Length is '{text}', which is no number")
            }
            Self::BytesBefore => f.write_str(
                "there are bytes before Content-Length: the message before is longer than it said",
            ),
            Self::NoHeader => {
                f.write_str("this is no header of a message: Content-Length is wanted")
            }
        }
    }
}

impl std::error::Error for Bad {}

/// The name of the one header that matters; others are passed over.
const LENGTH: &[u8] = b"content-length:";

/// Frames out of a stream of bytes.
#[derive(Debug)]
pub struct Frames<R> {
    from: R,
    /// What the header says until now.
    length: Option<u64>,
    /// Bytes are passed over until a header comes, which is told already.
    is_lost: bool,
}

impl<R: BufRead> Frames<R> {
    /// Of this stream.
    pub fn of(from: R) -> Self {
        Self {
            from,
            length: None,
            is_lost: false,
        }
    }

    /// The next one; nothing at the end of the stream, also if that cuts a frame short.
    ///
    /// # Errors
    /// The stream cannot be read.
    pub fn next(&mut self) -> io::Result<Option<Frame>> {
        while let Some(line) = self.line()? {
            if line.is_empty() {
                // One between frames harms nobody.
                if let Some(length) = self.length.take() {
                    return self.body(length);
                }
            } else if let Some(at) = begin_of_length(&line) {
                let had_lost = self.is_lost;
                match number(&line[at + LENGTH.len()..]) {
                    Ok(length) => (self.length, self.is_lost) = (Some(length), false),
                    Err(why) => return Ok(Some(self.lost(why))),
                }
                if at > 0 && !had_lost {
                    return Ok(Some(Frame::Bad(Bad::BytesBefore)));
                }
            } else if !self.is_lost && !is_header(&line) {
                return Ok(Some(self.lost(Bad::NoHeader)));
            }
        }
        Ok(None)
    }

    fn lost(&mut self, why: Bad) -> Frame {
        (self.length, self.is_lost) = (None, true);
        Frame::Bad(why)
    }

    fn body(&mut self, length: u64) -> io::Result<Option<Frame>> {
        // Grows with what comes, not with what is announced.
        let mut bytes = Vec::new();
        self.from.by_ref().take(length).read_to_end(&mut bytes)?;
        let is_whole = u64::try_from(bytes.len()) == Ok(length);
        Ok(is_whole.then_some(Frame::Body(bytes)))
    }

    /// A line without its end; of one that is too long for a header only the last part. Nothing at the end of the stream.
    fn line(&mut self) -> io::Result<Option<Vec<u8>>> {
        let mut line = Vec::new();
        loop {
            let come = self.from.fill_buf()?;
            if come.is_empty() {
                return Ok(None);
            }
            let end = come.iter().position(|byte| *byte == b'\n');
            let used = end.map_or(come.len(), |end| end + 1);
            line.extend_from_slice(&come[..end.unwrap_or(used)]);
            self.from.consume(used);
            if line.len() > 2 * limits::LSP_HEADER_BYTES {
                line.drain(..line.len() - limits::LSP_HEADER_BYTES);
            }
            if end.is_some() {
                if line.last() == Some(&b'\r') {
                    line.pop();
                }
                return Ok(Some(line));
            }
        }
    }
}

/// Where the name of the header begins in a line; the last time, since bytes of a lost message may be before it.
fn begin_of_length(line: &[u8]) -> Option<usize> {
    let mut all = line.windows(LENGTH.len());
    all.rposition(|part| part.eq_ignore_ascii_case(LENGTH))
}

/// Whether a line is a header at all: a name, a colon.
fn is_header(line: &[u8]) -> bool {
    let name = line.split(|byte| *byte == b':').next().unwrap_or_default();
    let is_name = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'-';
    line.len() <= limits::LSP_HEADER_BYTES
        && !name.is_empty()
        && name.len() < line.len()
        && name.iter().all(is_name)
}

fn number(digits: &[u8]) -> Result<u64, Bad> {
    let text = String::from_utf8_lossy(digits);
    let text = text.trim();
    let shown = || text.chars().take(30).collect();
    match text.parse::<u64>() {
        Ok(length) if length <= limits::LSP_MESSAGE_BYTES => Ok(length),
        Ok(_) => Err(Bad::Long(shown())),
        Err(_) => Err(Bad::NoNumber(shown())),
    }
}

/// Writes a message as a frame.
///
/// # Errors
/// The stream cannot be written.
pub fn write(to: &mut impl Write, message: &Value) -> io::Result<()> {
    let body = message.to_string();
    write!(to, "Content-Length: {}\r\n\r\n{body}", body.len())?;
    to.flush()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn all(bytes: &[u8]) -> Vec<Frame> {
        let mut frames = Frames::of(bytes);
        let mut found = Vec::new();
        while let Some(frame) = frames.next().unwrap() {
            found.push(frame);
        }
        found
    }

    fn body(text: &str) -> Frame {
        Frame::Body(text.as_bytes().to_vec())
    }

    fn bad(frame: &Frame) -> String {
        match frame {
            Frame::Bad(why) => why.to_string(),
            Frame::Body(_) => panic!("{frame:?}"),
        }
    }

    #[test]
    fn frames_come_one_after_another_with_any_headers_beside() {
        let bytes = b"Content-Length: 2\r\n\r\n{}content-length:3\nContent-Type: x\n\n[1]\r\n";
        assert_eq!(all(bytes), [body("{}"), body("[1]")]);
        let mut written = Vec::new();
        write(&mut written, &serde_json::json!({"a": "\u{3b8}"})).unwrap();
        assert_eq!(all(&written), [body("{\"a\":\"\u{3b8}\"}")]);
    }

    #[test]
    fn a_length_that_is_too_small_costs_what_follows_up_to_the_next_header() {
        let found = all(b"Content-Length: 1\r\n\r\n{}Content-Length: 2\r\n\r\n[]");
        assert_eq!(found[0], body("{"));
        assert!(bad(&found[1]).contains("longer than it said"));
        assert_eq!(found[2..], [body("[]")]);
    }

    #[test]
    fn what_is_no_header_is_told_once_and_passed_over() {
        let mut bytes = b"GET / HTTP/1.1\r\n\r\nno\nno\n".to_vec();
        bytes.extend(std::iter::repeat_n(b'x', 1 << 20));
        bytes.extend(b"Content-Length: 2\r\n\r\n{}");
        let found = all(&bytes);
        assert!(bad(&found[0]).contains("no header"));
        assert_eq!(found[1..], [body("{}")]);
    }

    #[test]
    fn lengths_that_cannot_be_are_refused_without_memory() {
        for length in ["-1", "", "1e3", "99999999999", "18446744073709551616"] {
            let text = format!("Content-Length: {length}\r\n\r\n{{}}Content-Length: 2\r\n\r\n[]");
            let found = all(text.as_bytes());
            let why = bad(&found[0]);
            assert!(why.contains(length), "{why}");
            assert_eq!(found[1..], [body("[]")]);
        }
        assert_eq!(all(b"Content-Length: 100000000\r\n\r\n{}"), []);
    }
}
