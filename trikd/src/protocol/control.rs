//! Requests of the control port 8888.

use super::program::WhenGone;
use lang_text::problem::Locale;

/// What a client asks for. Prefixes are case sensitive, and the first that fits counts.
#[derive(Clone, Debug, Eq, PartialEq)]
pub enum Request<'a> {
    /// Nothing.
    Keepalive,
    /// The version of the protocol.
    Version,
    /// The model of the controller.
    ConfigVersion,
    /// Keep these bytes as a program.
    File {
        /// Its name.
        name: &'a [u8],
        /// Its content.
        content: &'a [u8],
    },
    /// Run a program that is there.
    Run(&'a [u8]),
    /// Run this text as a program in JavaScript.
    DirectScript(&'a [u8]),
    /// Evaluate this text after the ones before it.
    Direct(&'a [u8]),
    /// End the program and bring the robot to rest.
    Stop,
    /// Tell this client where the running diagram is, or no more.
    Watch(bool),
    /// Replace the diagram that runs by a program that is there.
    Patch {
        /// What becomes of threads at blocks that it does not have.
        when_gone: WhenGone,
        /// Its name.
        name: &'a [u8],
    },
    /// Assign a variable of the diagram that runs, `NAME=EXPRESSION`.
    Set(&'a [u8]),
    /// Something that is asked of the debugger of the diagram that runs.
    Debug {
        /// What the client calls it; none: it is no number.
        tag: Option<u32>,
        /// The order.
        order: &'a [u8],
    },
    /// The language of what is said about programs that this client runs, and about its changes and orders.
    Language(Locale),
    /// Whether this client answers questions of a diagram to a person.
    Questions(bool),
    /// What a person says to a question, by its number; none: nobody answers.
    Answer {
        /// Which question.
        number: u32,
        /// The answer.
        text: Option<&'a [u8]>,
    },
    /// What runs now, and how the last program ended, when everything asked for before is done.
    Status,
    /// Everything that happens, from now on, as a recording: which nodes, and how often.
    Stream(&'a str),
    /// The last minutes, as a recording.
    Box,
    /// Something else.
    Unknown,
}

impl<'a> Request<'a> {
    /// What a frame asks for.
    pub fn parse(frame: &'a [u8]) -> Self {
        if frame.starts_with(b"keepalive") {
            return Self::Keepalive;
        }
        match frame {
            b"version" => return Self::Version,
            b"configVersion" => return Self::ConfigVersion,
            b"stop" => return Self::Stop,
            b"status" => return Self::Status,
            b"box" => return Self::Box,
            b"watch" => return Self::Watch(true),
            b"unwatch" => return Self::Watch(false),
            b"questions" => return Self::Questions(true),
            b"noquestions" => return Self::Questions(false),
            _ => {}
        }
        if let Some(rest) = frame.strip_prefix(b"file:") {
            return match rest.iter().position(|byte| *byte == b':') {
                Some(colon) => Self::File {
                    name: &rest[..colon],
                    content: &rest[colon + 1..],
                },
                None => Self::Unknown,
            };
        }
        if let Some(name) = frame.strip_prefix(b"run:") {
            return Self::Run(name);
        }
        if let Some(text) = frame.strip_prefix(b"directScript:") {
            return Self::DirectScript(text);
        }
        if let Some(rest) = frame.strip_prefix(b"patch:") {
            return Self::patch(rest).unwrap_or(Self::Unknown);
        }
        if let Some(rest) = frame.strip_prefix(b"answer:") {
            return Self::answer(rest).unwrap_or(Self::Unknown);
        }
        if let Some(wanted) = frame.strip_prefix(b"stream:") {
            return std::str::from_utf8(wanted).map_or(Self::Unknown, Self::Stream);
        }
        if let Some(text) = frame.strip_prefix(b"set:") {
            return Self::Set(text);
        }
        if let Some(name) = frame.strip_prefix(b"language:") {
            let name = std::str::from_utf8(name).ok();
            let named = name.and_then(Locale::named);
            return named.map_or(Self::Unknown, Self::Language);
        }
        if let Some(rest) = frame.strip_prefix(b"debug:") {
            return Self::debug(rest);
        }
        match frame.strip_prefix(b"direct:") {
            Some(text) => Self::Direct(text),
            None => Self::Unknown,
        }
    }

    fn debug(rest: &'a [u8]) -> Self {
        let blank = rest.iter().position(|byte| *byte == b' ');
        let (number, order) = rest.split_at(blank.unwrap_or(rest.len()));
        let is_number = !number.is_empty() && number.iter().all(u8::is_ascii_digit);
        let number = std::str::from_utf8(number).ok().filter(|_| is_number);
        Self::Debug {
            tag: number.and_then(|number| number.parse().ok()),
            order: order.get(1..).unwrap_or_default(),
        }
    }

    /// `NUMBER:TEXT`, or `NUMBER` for no answer.
    fn answer(rest: &'a [u8]) -> Option<Self> {
        let colon = rest.iter().position(|byte| *byte == b':');
        let number = &rest[..colon.unwrap_or(rest.len())];
        Some(Self::Answer {
            number: std::str::from_utf8(number).ok()?.parse().ok()?,
            text: colon.map(|colon| &rest[colon + 1..]),
        })
    }

    fn patch(rest: &'a [u8]) -> Option<Self> {
        let colon = rest.iter().position(|byte| *byte == b':')?;
        let (word, name) = (&rest[..colon], &rest[colon + 1..]);
        Some(Self::Patch {
            when_gone: WhenGone::of(std::str::from_utf8(word).ok()?)?,
            name,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn requests_are_told_by_their_beginning() {
        let file = Request::File {
            name: b"a.js",
            content: b"x:\0y",
        };
        assert_eq!(Request::parse(b"file:a.js:x:\0y"), file);
        assert_eq!(Request::parse(b"file:a.js"), Request::Unknown);
        assert_eq!(Request::parse(b"run:"), Request::Run(b""));
        assert_eq!(
            Request::parse(b"directScript:a:b"),
            Request::DirectScript(b"a:b")
        );
        assert_eq!(Request::parse(b"direct:x"), Request::Direct(b"x"));
        assert_eq!(Request::parse(b"keepalive now"), Request::Keepalive);
        assert_eq!(Request::parse(b"status"), Request::Status);
        let patch = Request::Patch {
            when_gone: WhenGone::Refuse,
            name: b"a:b.qrs",
        };
        assert_eq!(Request::parse(b"patch:refuse:a:b.qrs"), patch);
        assert_eq!(Request::parse(b"patch:maybe:a.qrs"), Request::Unknown);
        assert_eq!(Request::parse(b"patch:a.qrs"), Request::Unknown);
        assert_eq!(Request::parse(b"set:n=5"), Request::Set(b"n=5"));
        let answer = |number, text| Request::Answer { number, text };
        assert_eq!(Request::parse(b"answer:3:a:b"), answer(3, Some(b"a:b")));
        assert_eq!(Request::parse(b"answer:3"), answer(3, None));
        assert_eq!(Request::parse(b"answer:x:1"), Request::Unknown);
        assert_eq!(Request::parse(b"questions"), Request::Questions(true));
        for locale in Locale::ALL {
            let frame = format!("language:{}", locale.name());
            assert_eq!(Request::parse(frame.as_bytes()), Request::Language(locale));
        }
        assert_eq!(Request::parse(b"language:ru_RU"), Request::Unknown);
        for (frame, tag, order) in [
            (
                &b"debug:7 break {b}\nif n > 3"[..],
                Some(7),
                &b"break {b}\nif n > 3"[..],
            ),
            (b"debug:0 look", Some(0), b"look"),
            (b"debug:7", Some(7), b""),
            (b"debug:7  look", Some(7), b" look"),
            (b"debug:look", None, b""),
            (b"debug:+7 look", None, b"look"),
            (b"debug:4294967296 look", None, b"look"),
            (b"debug:", None, b""),
        ] {
            assert_eq!(Request::parse(frame), Request::Debug { tag, order });
        }
        for unknown in [
            &b""[..],
            b"Stop",
            b"stop ",
            b"version\n",
            b"configVersion:",
            b"\xff\xfe",
        ] {
            assert_eq!(Request::parse(unknown), Request::Unknown);
        }
    }
}
