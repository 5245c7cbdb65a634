//! What the daemon and the process of an isolated converter say to each other: each request and each answer is one message.
//!
//! Owns the form of messages, and reads none beyond its end: what comes from the process is as hostile as its converter.
//! Numbers are little-endian, a text is its length and its bytes. Tuples of [`Request::Many`] are in shared memory.

use converter::Direction;
use std::collections::BTreeMap;

/// What the daemon wants.
#[derive(Debug, PartialEq)]
pub(super) enum Request<'a> {
    /// Say that you are there, before anything is loaded.
    Begin,
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

/// An answer to one kind of request. Of an answer to another kind [`Answer::read`] makes nothing.
pub(super) trait Answer<'a>: Sized {
    /// Appends it to a message.
    fn write(&self, out: &mut Vec<u8>);
    /// Reads a whole message; None: it is none.
    fn read(message: &'a [u8]) -> Option<Self>;
}

/// To [`Request::Begin`].
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Begun;

/// To [`Request::Load`].
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Loaded {
    Done,
    /// By whose fault, as [`super::blame_of`] has it, and why.
    Refused {
        blame: u8,
        why: String,
    },
}

/// To [`Request::Seal`].
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Sealed {
    /// The kernel holds the process to its few system calls.
    pub(super) is_confined: bool,
    /// A library has kept it from that.
    pub(super) is_resisted: bool,
}

/// To [`Request::Open`].
#[derive(Debug, PartialEq, Eq)]
pub(super) enum Opened {
    /// The number of the new state, and what the converter has logged.
    Done {
        instance: u32,
        log: Vec<String>,
    },
    Fault(String),
}

/// To [`Request::Close`].
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Closed;

/// To [`Request::One`].
#[derive(Debug, PartialEq, Eq)]
pub(super) enum One<'a> {
    /// The tuple was taken and gave nothing yet.
    Consumed,
    /// The tuple that came of it.
    Produced(&'a [u8]),
    Fault(String),
}

/// To [`Request::Many`].
#[derive(Debug, PartialEq, Eq)]
pub(super) struct Many {
    /// So many tuples were taken and made.
    pub(super) taken: u32,
    pub(super) made: u32,
    /// Why no more.
    pub(super) fault: Option<String>,
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
            Self::Begin => out.push(6),
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
            6 => Self::Begin,
            _ => return None,
        };
        rest.is_empty().then_some(request)
    }
}

impl Answer<'_> for Begun {
    fn write(&self, out: &mut Vec<u8>) {
        out.push(0);
    }

    fn read(message: &[u8]) -> Option<Self> {
        (message == [0]).then_some(Self)
    }
}

impl Answer<'_> for Loaded {
    fn write(&self, out: &mut Vec<u8>) {
        match self {
            Self::Done => out.push(10),
            Self::Refused { blame, why } => {
                out.extend([11, *blame]);
                put_text(out, why);
            }
        }
    }

    fn read(message: &[u8]) -> Option<Self> {
        let mut rest = Rest(message);
        let answer = match rest.byte()? {
            10 => Self::Done,
            11 => Self::Refused {
                blame: rest.byte()?,
                why: rest.text()?,
            },
            _ => return None,
        };
        rest.is_empty().then_some(answer)
    }
}

impl Answer<'_> for Sealed {
    fn write(&self, out: &mut Vec<u8>) {
        out.extend([20, u8::from(self.is_confined), u8::from(self.is_resisted)]);
    }

    fn read(message: &[u8]) -> Option<Self> {
        let mut rest = Rest(message);
        rest.tag(20)?;
        let answer = Self {
            is_confined: rest.byte()? != 0,
            is_resisted: rest.byte()? != 0,
        };
        rest.is_empty().then_some(answer)
    }
}

impl Answer<'_> for Opened {
    fn write(&self, out: &mut Vec<u8>) {
        match self {
            Self::Done { instance, log } => {
                out.push(30);
                put(out, *instance);
                put_length(out, log.len());
                for line in log {
                    put_text(out, line);
                }
            }
            Self::Fault(why) => {
                out.push(31);
                put_text(out, why);
            }
        }
    }

    fn read(message: &[u8]) -> Option<Self> {
        let mut rest = Rest(message);
        let answer = match rest.byte()? {
            30 => Self::Done {
                instance: rest.number()?,
                log: rest.texts()?,
            },
            31 => Self::Fault(rest.text()?),
            _ => return None,
        };
        rest.is_empty().then_some(answer)
    }
}

impl Answer<'_> for Closed {
    fn write(&self, out: &mut Vec<u8>) {
        out.push(40);
    }

    fn read(message: &[u8]) -> Option<Self> {
        (message == [40]).then_some(Self)
    }
}

impl<'a> Answer<'a> for One<'a> {
    fn write(&self, out: &mut Vec<u8>) {
        match self {
            Self::Consumed => out.push(50),
            Self::Produced(tuple) => {
                out.push(51);
                out.extend_from_slice(tuple);
            }
            Self::Fault(why) => {
                out.push(52);
                put_text(out, why);
            }
        }
    }

    fn read(message: &'a [u8]) -> Option<Self> {
        let mut rest = Rest(message);
        let answer = match rest.byte()? {
            50 => Self::Consumed,
            51 => Self::Produced(rest.all()),
            52 => Self::Fault(rest.text()?),
            _ => return None,
        };
        rest.is_empty().then_some(answer)
    }
}

impl Answer<'_> for Many {
    fn write(&self, out: &mut Vec<u8>) {
        out.push(60);
        put(out, self.taken);
        put(out, self.made);
        put_option(out, self.fault.as_deref());
    }

    fn read(message: &[u8]) -> Option<Self> {
        let mut rest = Rest(message);
        rest.tag(60)?;
        let answer = Self {
            taken: rest.number()?,
            made: rest.number()?,
            fault: rest.option()?,
        };
        rest.is_empty().then_some(answer)
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

    /// The byte that this kind of message begins with.
    fn tag(&mut self, wanted: u8) -> Option<()> {
        (self.byte()? == wanted).then_some(())
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
            Request::Begin,
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

    #[test]
    fn each_request_is_read_as_it_was_written() {
        for request in requests() {
            let mut message = Vec::new();
            request.write(&mut message);
            assert_eq!(Request::read(&message), Some(request), "{message:?}");
        }
    }

    /// It comes back, and is nothing without its end or with more; of a tuple each end is one.
    fn check<'a, A: Answer<'a> + PartialEq + std::fmt::Debug>(answer: &A, is_tuple: bool) {
        let mut message = Vec::new();
        answer.write(&mut message);
        let message: &'static [u8] = message.leak();
        let longer: &'static [u8] = [message, &[0]].concat().leak();
        assert_eq!(A::read(message).as_ref(), Some(answer));
        if !is_tuple {
            assert_eq!(A::read(&message[..message.len() - 1]), None, "{answer:?}");
            assert_eq!(A::read(longer), None, "{answer:?}");
        }
    }

    #[test]
    fn each_answer_is_read_as_it_was_written_and_not_without_its_end() {
        let why = || "no echo".to_owned();
        check(&Begun, false);
        check(&Loaded::Done, false);
        check(
            &Loaded::Refused {
                blame: 2,
                why: why(),
            },
            false,
        );
        for (is_confined, is_resisted) in [(true, false), (false, true)] {
            let sealed = Sealed {
                is_confined,
                is_resisted,
            };
            check(&sealed, false);
        }
        let log = vec!["a line".to_owned(), String::new()];
        check(&Opened::Done { instance: 9, log }, false);
        check(&Opened::Fault(why()), false);
        check(&Closed, false);
        check(&One::Consumed, false);
        check(&One::Produced(&[0, 255]), true);
        check(&One::Fault(why()), false);
        for fault in [None, Some(why())] {
            let many = Many {
                taken: 5,
                made: 4,
                fault,
            };
            check(&many, false);
        }
    }

    #[test]
    fn an_answer_to_another_request_is_none() {
        let mut message = Vec::new();
        Closed.write(&mut message);
        assert_eq!(Begun::read(&message), None);
        assert_eq!(Loaded::read(&message), None);
        assert_eq!(Sealed::read(&message), None);
        assert_eq!(Opened::read(&message), None);
        assert_eq!(One::read(&message), None);
        assert_eq!(Many::read(&message), None);
    }

    /// What is a message is written as it was read.
    fn comes_back<'a, A: Answer<'a>>(bytes: &'a [u8]) -> bool {
        A::read(bytes).is_none_or(|answer| {
            let mut again = Vec::new();
            answer.write(&mut again);
            again.len() == bytes.len()
        })
    }

    proptest! {
        #[test]
        fn bytes_of_a_converter_are_an_answer_or_nothing(tag in 0..70_u8, rest: Vec<u8>) {
            let bytes = [&[tag][..], &rest].concat();
            prop_assert!(comes_back::<Begun>(&bytes));
            prop_assert!(comes_back::<Loaded>(&bytes) && comes_back::<Sealed>(&bytes));
            prop_assert!(comes_back::<Opened>(&bytes) && comes_back::<Closed>(&bytes));
            prop_assert!(comes_back::<One>(&bytes) && comes_back::<Many>(&bytes));
        }
    }
}
