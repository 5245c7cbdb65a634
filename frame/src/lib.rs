//! Frames: a decimal count of bytes, a colon, that many bytes.
//!
//! Owns how a stream that is torn anywhere becomes frames again and how it finds its way back after nonsense. What is
//! in a frame is not known here.

#![forbid(unsafe_code)]

pub mod limits;

use std::fmt;

/// Beginning of a frame that no buffer will be kept for.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Violation {
    /// No colon in so many bytes.
    NoColon,
    /// The frame says that it is longer than the limit.
    TooLong {
        /// What it says.
        announced: usize,
        /// The limit.
        limit: usize,
    },
}

impl fmt::Display for Violation {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoColon => write!(
                out,
                "no colon in {} bytes: a message is its length in bytes, a colon and its bytes",
                limits::HEADER_BYTES
            ),
            Self::TooLong { announced, limit } => {
                write!(
                    out,
                    "a message of {announced} bytes: at most {limit} are taken"
                )
            }
        }
    }
}

impl std::error::Error for Violation {}

/// A stream of bytes on its way to frames.
#[derive(Debug)]
pub struct Decoder {
    buffer: Vec<u8>,
    /// Bytes of `buffer` that are done.
    done: usize,
    limit: usize,
    /// Texts that were no counts.
    nonsense: u32,
}

/// What stands before the colon: white space around it and a plus are fine.
fn count(text: &[u8]) -> Option<i32> {
    let text = text.trim_ascii();
    let digits = text
        .strip_prefix(b"+")
        .or(text.strip_prefix(b"-"))
        .unwrap_or(text);
    let plain = !digits.is_empty() && digits.iter().all(u8::is_ascii_digit);
    plain
        .then(|| std::str::from_utf8(text).ok()?.parse().ok())
        .flatten()
}

/// The usual head, a few digits and a colon, and how long it is. None: it is another one, or not whole yet.
fn plain_head(rest: &[u8]) -> Option<(usize, usize)> {
    // So many digits fit into 32 bits in any case.
    const DIGITS: usize = 9;
    let mut size = 0;
    for (index, byte) in rest.iter().take(DIGITS + 1).enumerate() {
        match byte {
            b'0'..=b'9' if index < DIGITS => size = size * 10 + usize::from(byte - b'0'),
            b':' if index > 0 => return Some((size, index + 1)),
            _ => return None,
        }
    }
    None
}

impl Decoder {
    /// For frames of at most `limit` bytes.
    pub fn new(limit: usize) -> Self {
        Self {
            buffer: Vec::new(),
            done: 0,
            limit,
            nonsense: 0,
        }
    }

    /// Takes the next bytes of the stream, in pieces of any size.
    pub fn feed(&mut self, bytes: &[u8]) {
        if self.done == self.buffer.len() {
            self.buffer.clear();
            self.done = 0;
            // What one large frame needed is not kept for all small ones after it.
            if self.buffer.capacity() > limits::BUFFER_KEPT_BYTES {
                self.buffer = Vec::new();
            }
        } else if self.done > self.buffer.len() / 2 {
            self.buffer.drain(..self.done);
            self.done = 0;
        }
        self.buffer.extend_from_slice(bytes);
    }

    /// The next whole frame. A count of zero is none; a negative one is an empty frame and takes no bytes with it; what
    /// is no count of 32 bits is dropped with its colon.
    ///
    /// # Errors
    /// The stream cannot be followed within the limits. It should be closed; every further call says the same.
    #[allow(clippy::should_implement_trait)]
    pub fn next(&mut self) -> Result<Option<&[u8]>, Violation> {
        loop {
            let rest = &self.buffer[self.done..];
            if let Some((size, head)) = plain_head(rest)
                && (1..=self.limit).contains(&size)
            {
                let from = self.done + head;
                if self.buffer.len() - from < size {
                    return Ok(None);
                }
                self.done = from + size;
                return Ok(Some(&self.buffer[from..from + size]));
            }
            let head = &rest[..rest.len().min(limits::HEADER_BYTES)];
            let Some(colon) = head.iter().position(|byte| *byte == b':') else {
                return if head.len() == limits::HEADER_BYTES {
                    Err(Violation::NoColon)
                } else {
                    Ok(None)
                };
            };
            let Some(count) = count(&head[..colon]) else {
                self.nonsense = self.nonsense.saturating_add(1);
                self.done += colon + 1;
                continue;
            };
            let from = self.done + colon + 1;
            let Ok(size) = usize::try_from(count) else {
                self.done = from;
                return Ok(Some(&[]));
            };
            if size > self.limit {
                return Err(Violation::TooLong {
                    announced: size,
                    limit: self.limit,
                });
            }
            if self.buffer.len() - from < size {
                return Ok(None);
            }
            self.done = from + size;
            if size > 0 {
                return Ok(Some(&self.buffer[from..from + size]));
            }
        }
    }

    /// Bytes that wait for the rest of their frame.
    pub fn buffered(&self) -> usize {
        self.buffer.len() - self.done
    }

    /// How often the stream had to be found again.
    pub fn nonsense(&self) -> u32 {
        self.nonsense
    }
}

/// The frame of a payload.
pub fn encode(payload: &[u8]) -> Vec<u8> {
    let mut frame = payload.len().to_string().into_bytes();
    frame.reserve(payload.len() + 1);
    frame.push(b':');
    frame.extend_from_slice(payload);
    frame
}

#[cfg(test)]
mod tests {
    use super::*;

    /// All frames of a stream that comes in pieces of `step` bytes, and how it ended.
    fn decoded(stream: &[u8], step: usize) -> (Vec<String>, Result<(), Violation>) {
        let mut decoder = Decoder::new(100);
        let mut frames = Vec::new();
        for piece in stream.chunks(step) {
            decoder.feed(piece);
            loop {
                match decoder.next() {
                    Ok(Some(frame)) => frames.push(String::from_utf8_lossy(frame).into_owned()),
                    Ok(None) => break,
                    Err(violation) => return (frames, Err(violation)),
                }
            }
        }
        (frames, Ok(()))
    }

    fn check(stream: &str, frames: &[&str]) {
        for step in [1, 2, 3, 7, 1000] {
            let (got, end) = decoded(stream.as_bytes(), step);
            assert_eq!(
                (got, end),
                (frames.iter().map(|&text| text.to_owned()).collect(), Ok(())),
                "{stream} by {step}"
            );
        }
    }

    #[test]
    fn frames_are_the_same_however_the_stream_is_torn() {
        check("9:keepalive7:version", &["keepalive", "version"]);
        check("5:a:b:c3:d", &["a:b:c"]);
        check("2:\u{e9}2:ok", &["\u{e9}", "ok"]);
        check(" 7 :version+2:ab\t3\n:abc", &["version", "ab", "abc"]);
    }

    #[test]
    fn a_stream_finds_its_way_back_after_nonsense() {
        check("abc:2:ab", &["ab"]);
        check(":::2:ab", &["ab"]);
        check("99999999999:2:ab", &["ab"]);
        check("2147483648:2:ab", &["ab"]);
        check("1.5:0x1:--1:+-1:+:-:2:ab", &["ab"]);
        check("0:0:2:ab", &["ab"]);
        check("-1:2:ab-0:", &["", "ab"]);
    }

    #[test]
    fn what_does_not_fit_is_refused_before_it_comes() {
        for step in [1, 1000] {
            let (frames, end) = decoded(b"2:ab101:x", step);
            assert_eq!(frames, ["ab"]);
            assert_eq!(
                end,
                Err(Violation::TooLong {
                    announced: 101,
                    limit: 100
                })
            );
            assert_eq!(decoded(&[b'1'; 2000], step).1, Err(Violation::NoColon));
        }
        let (_, end) = decoded(b"2147483647:", 1000);
        assert!(
            end.unwrap_err()
                .to_string()
                .contains("2147483647 bytes: at most 100")
        );
    }

    #[test]
    fn a_frame_that_was_made_here_is_read_here() {
        for payload in [&b"x"[..], b"1:2:3", &[0xff; 99]] {
            let mut decoder = Decoder::new(100);
            decoder.feed(&encode(payload));
            assert_eq!(decoder.next(), Ok(Some(payload)));
            assert_eq!(decoder.next(), Ok(None));
            assert_eq!(decoder.buffered(), 0);
        }
    }
}
