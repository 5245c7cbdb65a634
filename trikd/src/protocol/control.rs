//! Requests of the control port 8888.

use super::program::WhenGone;
use lang_text::near::nearest;
use lang_text::problem::Locale;
use std::fmt;

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
    /// Nearly a request of those that the original robots do not have.
    Malformed(Malformed),
    /// Something else.
    Unknown,
}

/// A request that is not written as it has to be. Those that the original robots know are not here: they pass over such
/// a one, and so do we.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Malformed {
    /// How this one is written.
    Form(&'static str),
    /// Its word is none, and this one is near.
    Near(&'static str),
}

/// Words of requests that the original robots do not have, and how these are written.
const FORMS: [(&str, &str); 12] = [
    ("patch", "patch:end:NAME or patch:refuse:NAME"),
    ("set", "set:NAME=EXPRESSION"),
    ("watch", "watch, with nothing behind it"),
    ("unwatch", "unwatch, with nothing behind it"),
    ("questions", "questions, with nothing behind it"),
    ("noquestions", "noquestions, with nothing behind it"),
    ("answer", "answer:NUMBER:TEXT or answer:NUMBER"),
    ("debug", "debug:NUMBER ORDER"),
    ("language", "language:en or language:ru"),
    ("status", "status, with nothing behind it"),
    (
        "stream",
        "stream:PATTERN,PATTERN;hz=NUMBER or stream:PATTERN,PATTERN;raw",
    ),
    ("box", "box, with nothing behind it"),
];

impl fmt::Display for Malformed {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Form(form) => write!(out, "this request is written {form}"),
            Self::Near(word) => write!(out, "there is no such request; did you mean '{word}'?"),
        }
    }
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
            return Self::patch(rest).unwrap_or_else(|| Self::strange(frame));
        }
        if let Some(rest) = frame.strip_prefix(b"answer:") {
            return Self::answer(rest).unwrap_or_else(|| Self::strange(frame));
        }
        if let Some(wanted) = frame.strip_prefix(b"stream:") {
            let wanted = std::str::from_utf8(wanted);
            return wanted.map_or_else(|_| Self::strange(frame), Self::Stream);
        }
        if let Some(text) = frame.strip_prefix(b"set:") {
            let name = text.split(|byte| *byte == b'=').next().unwrap_or_default();
            return match name.trim_ascii().is_empty() {
                true => Self::strange(frame),
                false => Self::Set(text),
            };
        }
        if let Some(name) = frame.strip_prefix(b"language:") {
            let name = std::str::from_utf8(name).ok();
            let named = name.and_then(Locale::named);
            return named.map_or_else(|| Self::strange(frame), Self::Language);
        }
        if let Some(rest) = frame.strip_prefix(b"debug:") {
            return Self::debug(rest);
        }
        match frame.strip_prefix(b"direct:") {
            Some(text) => Self::Direct(text),
            None => Self::strange(frame),
        }
    }

    /// What is no request, but may be meant as one.
    fn strange(frame: &'a [u8]) -> Self {
        let letters = frame.iter().take_while(|byte| byte.is_ascii_alphabetic());
        let word = &frame[..letters.count()];
        let Ok(word) = std::str::from_utf8(word) else {
            return Self::Unknown;
        };
        let mut forms = FORMS.iter();
        match forms.find(|(known, _)| known.eq_ignore_ascii_case(word)) {
            // Those who debug read no other answers.
            Some(("debug", _)) => Self::Debug {
                tag: None,
                order: b"",
            },
            Some((_, form)) => Self::Malformed(Malformed::Form(form)),
            None => {
                let near = nearest(word, FORMS.iter().map(|(known, _)| *known));
                near.map_or(Self::Unknown, |word| Self::Malformed(Malformed::Near(word)))
            }
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
    fn what_is_nearly_a_request_of_ours_is_malformed_and_what_old_robots_pass_over_is_not() {
        for (frame, form) in [
            (&b"patch:maybe:a.qrs"[..], "patch:end:NAME"),
            (b"patch:a.qrs", "patch:end:NAME"),
            (b"patch:", "patch:end:NAME"),
            (b"patch", "patch:end:NAME"),
            (b"patch:\xff\xfe:a", "patch:end:NAME"),
            (b"set", "set:NAME=EXPRESSION"),
            (b"set:", "set:NAME=EXPRESSION"),
            (b"set: =5", "set:NAME=EXPRESSION"),
            (b"watch:on", "watch, with nothing"),
            (b"watch\n", "watch, with nothing"),
            (b"Watch", "watch, with nothing"),
            (b"unwatch:", "unwatch, with nothing"),
            (b"questions 1", "questions, with nothing"),
            (b"noquestions:", "noquestions, with nothing"),
            (b"answer:x:1", "answer:NUMBER:TEXT"),
            (b"answer:", "answer:NUMBER:TEXT"),
            (b"status ", "status, with nothing"),
            (b"stream:\xff", "stream:PATTERN"),
            (b"stream", "stream:PATTERN"),
            (b"box:1", "box, with nothing"),
        ] {
            let request = Request::parse(frame);
            let Request::Malformed(why) = request else {
                panic!("{request:?}");
            };
            let told = why.to_string();
            assert!(
                told.starts_with(&format!("this request is written {form}")),
                "{told}"
            );
        }
        for (frame, meant) in [
            (&b"pacth:end:a.qrs"[..], "patch"),
            (b"wacth", "watch"),
            (b"anwser:1:2", "answer"),
            (b"debgu:1 look", "debug"),
        ] {
            let near = Request::Malformed(Malformed::Near(meant));
            assert_eq!(Request::parse(frame), near);
        }
        let nothing = Request::Debug {
            tag: None,
            order: b"",
        };
        assert_eq!(Request::parse(b"debug"), nothing);
        assert_eq!(Request::parse(b"debug look"), nothing);
        for old in [
            &b"run"[..],
            b"run x.js",
            b"stop ",
            b"Stop",
            b"stop:",
            b"version:",
            b"file",
            b"file:a.js",
            b"direct",
            b"directScript",
            b"data",
            b"ports",
            b"sensor:A1",
            b"hello",
            b"register:1:2",
            b"self",
        ] {
            let text = String::from_utf8_lossy(old);
            assert_eq!(Request::parse(old), Request::Unknown, "{text}");
        }
    }

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
        assert_eq!(Request::parse(b"set:n=5"), Request::Set(b"n=5"));
        let answer = |number, text| Request::Answer { number, text };
        assert_eq!(Request::parse(b"answer:3:a:b"), answer(3, Some(b"a:b")));
        assert_eq!(Request::parse(b"answer:3"), answer(3, None));
        assert_eq!(Request::parse(b"questions"), Request::Questions(true));
        for locale in Locale::ALL {
            let frame = format!("language:{}", locale.name());
            assert_eq!(Request::parse(frame.as_bytes()), Request::Language(locale));
        }
        let form = Malformed::Form("language:en or language:ru");
        assert_eq!(Request::parse(b"language:ru_RU"), Request::Malformed(form));
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
