//! What the daemon and the process of an isolated converter say to each other: each request and each answer is one message.
//!
//! Owns the form of messages, and reads none beyond its end: what comes from the process is as hostile as its converter.
//! Numbers are little-endian, a text is its length and its bytes. Tuples of [`Request::Many`] are in shared memory.

use converter::Direction;
use std::collections::BTreeMap;

/// What the daemon wants.
#[derive(Debug, PartialEq)]
pub(super) enum Request<'a> {
    /// Load a library, from a file of the cache; the next one loaded has the next number, from 0.
    Load(Load),
    /// Nothing is loaded any more: give up the right to open files.
    Seal,
    /// Make the state of one open file and direction.
    Open {
        library: u32,
        direction: Direction,
        input_size: u32,
        output_size: u32,
        node: String,
        params: BTreeMap<String, f64>,
    },
    /// Forget it.
    Close { instance: u32 },
    /// Convert this tuple.
    One { instance: u32, tuple: &'a [u8] },
    /// Convert the tuples that are in the input's memory, into so many bytes of the output's.
    Many {
        instance: u32,
        input_bytes: u32,
        output_bytes: u32,
    },
}

/// One library, as `Library::load_copy` wants it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct Load {
    pub(super) file: String,
    pub(super) shown: String,
    pub(super) short: String,
    pub(super) name: Option<String>,
}

/// What the process answers.
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Reply<'a> {
    /// It was done.
    Done,
    /// It was refused. Of a library: by whose fault, as [`super::blame_of`] has it.
    Refused { blame: u8, why: String },
    /// Whether the kernel holds the process to its few system calls, and whether a library has kept it from that.
    Sealed {
        is_confined: bool,
        is_resisted: bool,
    },
    /// The number of the new state, and what the converter has logged.
    Opened { instance: u32, log: Vec<String> },
    /// The tuple was taken and gave nothing yet.
    Consumed,
    /// The tuple that came of it.
    Produced(&'a [u8]),
    /// It could not be converted.
    Fault(String),
    /// So many tuples were taken and made, and why no more, if it was a fault.
    Many {
        taken: u32,
        made: u32,
        fault: Option<String>,
    },
}

impl<'a> Request<'a> {
    /// Appends it to a message.
    pub(super) fn write(&self, out: &mut Vec<u8>) {
        match self {
            Self::Load(load) => {
                out.push(0);
                for text in [&load.file, &load.shown, &load.short] {
                    put_text(out, text);
                }
                put_option(out, load.name.as_deref());
            }
            Self::Seal => out.push(1),
            Self::Open {
                library,
                direction,
                input_size,
                output_size,
                node,
                params,
            } => {
                out.push(2);
                put(out, *library);
                out.push(match direction {
                    Direction::Read => 0,
                    Direction::Write => 1,
                });
                put(out, *input_size);
                put(out, *output_size);
                put_text(out, node);
                put_length(out, params.len());
                for (name, value) in params {
                    put_text(out, name);
                    out.extend(value.to_bits().to_le_bytes());
                }
            }
            Self::Close { instance } => {
                out.push(3);
                put(out, *instance);
            }
            Self::One { instance, tuple } => {
                out.push(4);
                put(out, *instance);
                out.extend_from_slice(tuple);
            }
            Self::Many {
                instance,
                input_bytes,
                output_bytes,
            } => {
                out.push(5);
                for number in [instance, input_bytes, output_bytes] {
                    put(out, *number);
                }
            }
        }
    }

    /// Reads a whole message; None: it is none.
    pub(super) fn read(message: &'a [u8]) -> Option<Self> {
        let mut rest = Rest(message);
        let request = match rest.byte()? {
            0 => Self::Load(Load {
                file: rest.text()?,
                shown: rest.text()?,
                short: rest.text()?,
                name: rest.option()?,
            }),
            1 => Self::Seal,
            2 => Self::Open {
                library: rest.number()?,
                direction: match rest.byte()? {
                    0 => Direction::Read,
                    1 => Direction::Write,
                    _ => return None,
                },
                input_size: rest.number()?,
                output_size: rest.number()?,
                node: rest.text()?,
                params: rest.params()?,
            },
            3 => Self::Close {
                instance: rest.number()?,
            },
            4 => Self::One {
                instance: rest.number()?,
                tuple: rest.all(),
            },
            5 => Self::Many {
                instance: rest.number()?,
                input_bytes: rest.number()?,
                output_bytes: rest.number()?,
            },
            _ => return None,
        };
        rest.is_empty().then_some(request)
    }
}

impl<'a> Reply<'a> {
    /// Appends it to a message.
    pub(super) fn write(&self, out: &mut Vec<u8>) {
        match self {
            Self::Done => out.push(0),
            Self::Refused { blame, why } => {
                out.extend([1, *blame]);
                put_text(out, why);
            }
            Self::Sealed {
                is_confined,
                is_resisted,
            } => out.extend([2, u8::from(*is_confined), u8::from(*is_resisted)]),
            Self::Opened { instance, log } => {
                out.push(3);
                put(out, *instance);
                put_length(out, log.len());
                for line in log {
                    put_text(out, line);
                }
            }
            Self::Consumed => out.push(4),
            Self::Produced(tuple) => {
                out.push(5);
                out.extend_from_slice(tuple);
            }
            Self::Fault(why) => {
                out.push(6);
                put_text(out, why);
            }
            Self::Many { taken, made, fault } => {
                out.push(7);
                put(out, *taken);
                put(out, *made);
                put_option(out, fault.as_deref());
            }
        }
    }

    /// Reads a whole message; None: it is none.
    pub(super) fn read(message: &'a [u8]) -> Option<Self> {
        let mut rest = Rest(message);
        let reply = match rest.byte()? {
            0 => Self::Done,
            1 => Self::Refused {
                blame: rest.byte()?,
                why: rest.text()?,
            },
            2 => Self::Sealed {
                is_confined: rest.byte()? != 0,
                is_resisted: rest.byte()? != 0,
            },
            3 => Self::Opened {
                instance: rest.number()?,
                log: rest.texts()?,
            },
            4 => Self::Consumed,
            5 => Self::Produced(rest.all()),
            6 => Self::Fault(rest.text()?),
            7 => Self::Many {
                taken: rest.number()?,
                made: rest.number()?,
                fault: rest.option()?,
            },
            _ => return None,
        };
        rest.is_empty().then_some(reply)
    }
}

fn put(out: &mut Vec<u8>, number: u32) {
    out.extend(number.to_le_bytes());
}

/// Of something that a message has room for; a greater one makes the message unreadable, and nothing worse.
fn put_length(out: &mut Vec<u8>, length: usize) {
    put(out, u32::try_from(length).unwrap_or(u32::MAX));
}

fn put_text(out: &mut Vec<u8>, text: &str) {
    put_length(out, text.len());
    out.extend_from_slice(text.as_bytes());
}

fn put_option(out: &mut Vec<u8>, text: Option<&str>) {
    out.push(u8::from(text.is_some()));
    if let Some(text) = text {
        put_text(out, text);
    }
}

/// What of a message has not been read.
struct Rest<'a>(&'a [u8]);

impl<'a> Rest<'a> {
    fn is_empty(&self) -> bool {
        self.0.is_empty()
    }

    fn all(&mut self) -> &'a [u8] {
        std::mem::take(&mut self.0)
    }

    fn bytes(&mut self, count: usize) -> Option<&'a [u8]> {
        let (bytes, rest) = self.0.split_at_checked(count)?;
        self.0 = rest;
        Some(bytes)
    }

    fn byte(&mut self) -> Option<u8> {
        self.bytes(1)?.first().copied()
    }

    fn number(&mut self) -> Option<u32> {
        Some(u32::from_le_bytes(self.bytes(4)?.try_into().ok()?))
    }

    fn text(&mut self) -> Option<String> {
        let length = self.number()? as usize;
        String::from_utf8(self.bytes(length)?.to_vec()).ok()
    }

    fn option(&mut self) -> Option<Option<String>> {
        match self.byte()? {
            0 => Some(None),
            1 => self.text().map(Some),
            _ => None,
        }
    }

    /// Each takes bytes of the message, so a great count ends where the message does.
    fn texts(&mut self) -> Option<Vec<String>> {
        (0..self.number()?).map(|_| self.text()).collect()
    }

    fn params(&mut self) -> Option<BTreeMap<String, f64>> {
        (0..self.number()?)
            .map(|_| {
                let name = self.text()?;
                let bits = u64::from_le_bytes(self.bytes(8)?.try_into().ok()?);
                Some((name, f64::from_bits(bits)))
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn requests() -> Vec<Request<'static>> {
        let text = |text: &str| text.to_owned();
        vec![
            Request::Load(Load {
                file: text("/c/lib-1.so"),
                shown: text("a/libx.so"),
                short: text("libx.so"),
                name: Some(text("half")),
            }),
            Request::Seal,
            Request::Open {
                library: 3,
                direction: Direction::Write,
                input_size: 4,
                output_size: 8,
                node: text("sensors/A1"),
                params: BTreeMap::from([(text("gain"), -0.5), (text("zero"), 0.0)]),
            },
            Request::Close { instance: 7 },
            Request::One {
                instance: 1,
                tuple: &[1, 2, 3],
            },
            Request::Many {
                instance: 1,
                input_bytes: 64,
                output_bytes: 32,
            },
        ]
    }

    fn replies() -> Vec<Reply<'static>> {
        vec![
            Reply::Done,
            Reply::Refused {
                blame: 2,
                why: "no such library".to_owned(),
            },
            Reply::Sealed {
                is_confined: true,
                is_resisted: false,
            },
            Reply::Opened {
                instance: 9,
                log: vec!["a line".to_owned(), String::new()],
            },
            Reply::Consumed,
            Reply::Produced(&[0, 255]),
            Reply::Fault("no echo".to_owned()),
            Reply::Many {
                taken: 5,
                made: 4,
                fault: Some("no echo".to_owned()),
            },
        ]
    }

    #[test]
    fn each_message_is_read_as_it_was_written_and_not_without_its_end() {
        for request in requests() {
            let mut message = Vec::new();
            request.write(&mut message);
            assert_eq!(Request::read(&message), Some(request), "{message:?}");
        }
        for reply in replies() {
            let mut message = Vec::new();
            reply.write(&mut message);
            assert_eq!(Reply::read(&message), Some(reply), "{message:?}");
            let is_tuple = matches!(message[0], 5);
            let cut = Reply::read(&message[..message.len() - 1]);
            assert!(is_tuple || cut.is_none(), "{message:?}");
            let mut longer = message.clone();
            longer.push(0);
            assert!(is_tuple || Reply::read(&longer).is_none(), "{message:?}");
        }
    }

    proptest! {
        /// Whatever is no message is refused, and what is one is written as it was read.
        #[test]
        fn bytes_of_a_converter_are_a_message_or_nothing(bytes: Vec<u8>) {
            if let Some(reply) = Reply::read(&bytes) {
                let mut again = Vec::new();
                reply.write(&mut again);
                prop_assert_eq!(again.len(), bytes.len());
            }
        }
    }
}
