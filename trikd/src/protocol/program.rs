//! The channel between the daemon and a program: what either side says, as types, and the only place that knows how it
//! is written.
//!
//! Owns the words of both directions and their order within a payload; `mailbox` has the questions to the mailbox. A
//! payload travels in a frame ([`super::frame`]) on the program's standard input. Knows no sockets and no processes:
//! `program` is the daemon's end, `host` the program's, and `trik.py` speaks the same words in Python.

pub use lang_diagram::machine::patch::WhenGone;
pub use lang_diagram::mailbox;

use lang_text::problem::Locale;

/// Something that the daemon sends to a program.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum ToProgram<'a> {
    /// Begin with the program in this file; its absolute path.
    File(&'a str),
    /// Begin with this text.
    Script(&'a str),
    /// Begin without a program: direct texts will come.
    Start,
    /// The next direct text.
    Direct(&'a str),
    /// A message of the mailbox.
    Mail {
        /// Hull number of the sender, -1 if it is unknown.
        hull: i32,
        /// What it says.
        text: &'a str,
    },
    /// The answer to a question to the mailbox.
    Answer(&'a str),
    /// Asks for the variables that the program shows.
    Web,
    /// Whether somebody wants to see where the program is.
    Watch(bool),
    /// A new version of the diagram that runs is in this file.
    Patch {
        /// What becomes of threads at blocks that it does not have.
        when_gone: WhenGone,
        /// The language of the answer.
        locale: Locale,
        /// Its absolute path.
        path: &'a str,
    },
    /// An assignment by a person.
    Set {
        /// The language of the answer.
        locale: Locale,
        /// `NAME=EXPRESSION`.
        text: &'a str,
    },
    /// Begin with the diagram in this file, with a debugger attached and stopped before its first block; its absolute path.
    Debugged(&'a str),
    /// Begin with the Python program in this file under debugpy, which connects to this address.
    Debugpy {
        /// Address and port of who debugs it.
        address: &'a str,
        /// What it says there first, so that nobody else is taken for it.
        secret: Option<&'a str>,
        /// Its absolute path.
        path: &'a str,
    },
    /// An order to the debugger; the program answers each, in their order.
    Debug {
        /// Whose order it is.
        client: u32,
        /// What the client calls it.
        tag: u32,
        /// The language of the answer.
        locale: Locale,
        /// The order.
        order: &'a str,
    },
    /// The client that was in control of the debugger is gone.
    DebugLeft,
    /// What a person says to a question of the program.
    Reply {
        /// Which question.
        number: u32,
        /// The answer; none: nobody answers.
        text: Option<&'a str>,
    },
}

/// Something that a program sends to the daemon.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum FromProgram<'a> {
    /// Output, as it shall be shown, with its newline.
    Print(&'a str),
    /// A failure; the daemon puts nothing before it. Without a text it was told before.
    Error(&'a str),
    /// Something a person may want to know.
    Info(&'a str),
    /// The program is event-driven from now on: direct texts may come in between.
    Events,
    /// A question to the mailbox, as [`mailbox::Question`] is written.
    Mailbox(&'a str),
    /// The variables that the program shows, a JSON object.
    Web(&'a str),
    /// Where the program is.
    Watch {
        /// For people, without a newline.
        line: &'a str,
        /// For programs, a JSON object.
        json: &'a str,
    },
    /// What has become of a new version or an assignment.
    Changed {
        /// Whether it is in force.
        is_changed: bool,
        /// What has changed, or why nothing has, for people.
        text: &'a str,
    },
    /// The answer to an order, or a state of the program for all who debug.
    Debug {
        /// The client that is meant; [`ALL`].
        client: u32,
        /// A JSON object.
        json: &'a str,
    },
    /// Lines that breakpoints have written, a JSON object for all who debug.
    DebugLog(&'a str),
    /// A question to a person.
    Question {
        /// Names its answer.
        number: u32,
        /// The question, a JSON object.
        json: &'a str,
    },
    /// Where a debugger has stopped it, the line and the file; none: it goes on.
    Stopped(Option<(u32, &'a str)>),
}

/// Instead of a client in [`FromProgram::Debug`]: all that debug.
pub const ALL: u32 = 0;

/// Instead of a secret in [`ToProgram::Debugpy`]: none is wanted.
const NO_SECRET: &str = "-";

/// The words of [`ToProgram`], in the order of the document.
pub const TO_PROGRAM: [&str; 15] = [
    "file",
    "script",
    "start",
    "direct",
    "mail",
    "answer",
    "web",
    "watch",
    "patch",
    "set",
    "debug-file",
    "debugpy",
    "debug",
    "debug-left",
    "reply",
];

/// The words of [`FromProgram`], in the order of the document.
pub const FROM_PROGRAM: [&str; 12] = [
    "print",
    "error",
    "info",
    "events",
    "mailbox",
    "web",
    "watch",
    "changed",
    "debug",
    "debug-log",
    "question",
    "stopped",
];

impl<'a> ToProgram<'a> {
    /// The payload of its frame.
    pub fn encode(self) -> Vec<u8> {
        let text = match self {
            Self::File(path) => format!("file:{path}"),
            Self::Script(code) => format!("script:{code}"),
            Self::Start => "start:".to_owned(),
            Self::Direct(code) => format!("direct:{code}"),
            Self::Mail { hull, text } => format!("mail:{hull}:{text}"),
            Self::Answer(text) => format!("answer:{text}"),
            Self::Web => "web:".to_owned(),
            Self::Watch(is_wanted) => format!("watch:{}", u8::from(is_wanted)),
            Self::Patch {
                when_gone,
                locale,
                path,
            } => format!("patch:{}:{}:{path}", when_gone.word(), locale.name()),
            Self::Set { locale, text } => format!("set:{}:{text}", locale.name()),
            Self::Debugged(path) => format!("debug-file:{path}"),
            Self::Debugpy {
                address,
                secret,
                path,
            } => format!("debugpy:{address} {} {path}", secret.unwrap_or(NO_SECRET)),
            Self::Debug {
                client,
                tag,
                locale,
                order,
            } => format!("debug:{client} {tag} {} {order}", locale.name()),
            Self::DebugLeft => "debug-left:".to_owned(),
            Self::Reply { number, text } => match text {
                Some(text) => format!("reply:{number} {text}"),
                None => format!("reply:{number}"),
            },
        };
        text.into_bytes()
    }

    /// What a payload says. None: it is from a daemon that knows more than this program, which passes over it.
    pub fn parse(payload: &'a str) -> Option<Self> {
        let (word, rest) = split(payload);
        Some(match word {
            "file" => Self::File(rest),
            "script" => Self::Script(rest),
            "start" => Self::Start,
            "direct" => Self::Direct(rest),
            "mail" => {
                let (hull, text) = rest.split_once(':')?;
                Self::Mail {
                    hull: hull.parse().ok()?,
                    text,
                }
            }
            "answer" => Self::Answer(rest),
            "web" => Self::Web,
            "watch" => Self::Watch(rest == "1"),
            "patch" => {
                let (word, rest) = rest.split_once(':')?;
                let (name, path) = rest.split_once(':')?;
                Self::Patch {
                    when_gone: WhenGone::of(word)?,
                    locale: Locale::named(name)?,
                    path,
                }
            }
            "set" => {
                let (name, text) = rest.split_once(':')?;
                Self::Set {
                    locale: Locale::named(name)?,
                    text,
                }
            }
            "debug-file" => Self::Debugged(rest),
            "debugpy" => {
                let (address, rest) = rest.split_once(' ')?;
                let (secret, path) = rest.split_once(' ')?;
                Self::Debugpy {
                    address,
                    secret: (secret != NO_SECRET).then_some(secret),
                    path,
                }
            }
            "debug" => {
                let (client, rest) = rest.split_once(' ')?;
                let (tag, rest) = rest.split_once(' ')?;
                let (name, order) = rest.split_once(' ')?;
                Self::Debug {
                    client: client.parse().ok()?,
                    tag: tag.parse().ok()?,
                    locale: Locale::named(name)?,
                    order,
                }
            }
            "debug-left" => Self::DebugLeft,
            "reply" => {
                let (number, text) = match rest.split_once(' ') {
                    Some((number, text)) => (number, Some(text)),
                    None => (rest, None),
                };
                Self::Reply {
                    number: number.parse().ok()?,
                    text,
                }
            }
            _ => return None,
        })
    }
}

impl<'a> FromProgram<'a> {
    /// The payload of its frame.
    pub fn encode(self) -> Vec<u8> {
        let text = match self {
            Self::Print(text) => format!("print:{text}"),
            Self::Error(text) => format!("error:{text}"),
            Self::Info(text) => format!("info:{text}"),
            Self::Events => "events:".to_owned(),
            Self::Mailbox(question) => format!("mailbox:{question}"),
            Self::Web(json) => format!("web:{json}"),
            Self::Watch { line, json } => format!("watch:{line}\n{json}"),
            Self::Changed { is_changed, text } => {
                format!("changed:{}:{text}", u8::from(is_changed))
            }
            Self::Debug { client, json } => format!("debug:{client} {json}"),
            Self::DebugLog(json) => format!("debug-log:{json}"),
            Self::Question { number, json } => format!("question:{number} {json}"),
            Self::Stopped(Some((line, file))) => format!("stopped:{line} {file}"),
            Self::Stopped(None) => "stopped:".to_owned(),
        };
        text.into_bytes()
    }

    /// What a payload says. None: a program may write what it likes to its channel, and this means nothing.
    pub fn parse(payload: &'a str) -> Option<Self> {
        let (word, rest) = split(payload);
        Some(match word {
            "print" => Self::Print(rest),
            "error" => Self::Error(rest),
            "info" => Self::Info(rest),
            "events" => Self::Events,
            "mailbox" => Self::Mailbox(rest),
            "web" => Self::Web(rest),
            "watch" => {
                let (line, json) = rest.split_once('\n').unwrap_or((rest, "{}"));
                Self::Watch { line, json }
            }
            "changed" => {
                let (is_changed, text) = rest.split_once(':')?;
                Self::Changed {
                    is_changed: is_changed == "1",
                    text,
                }
            }
            "debug" => {
                let (client, json) = rest.split_once(' ')?;
                Self::Debug {
                    client: client.parse().ok()?,
                    json,
                }
            }
            "debug-log" => Self::DebugLog(rest),
            "question" => {
                let (number, json) = rest.split_once(' ')?;
                Self::Question {
                    number: number.parse().ok()?,
                    json,
                }
            }
            "stopped" if rest.is_empty() => Self::Stopped(None),
            "stopped" => {
                let (line, file) = rest.split_once(' ')?;
                Self::Stopped(Some((line.parse().ok()?, file)))
            }
            _ => return None,
        })
    }
}

/// The word of a payload and what follows its colon.
fn split(payload: &str) -> (&str, &str) {
    payload.split_once(':').unwrap_or((payload, ""))
}

#[cfg(test)]
mod tests {
    use super::mailbox::QUESTIONS;
    use super::*;
    use proptest::prelude::*;
    use std::collections::BTreeSet;

    proptest! {
        #[test]
        fn what_the_daemon_says_is_understood_by_programs(
            text in "(?s).{0,40}",
            hull: i32,
            is_wanted: bool,
            client: u32,
        ) {
            let text = text.as_str();
            let secret = is_wanted.then_some("s3cret");
            for said in [
                ToProgram::Debugpy { address: "[::1]:7", secret, path: text },
                ToProgram::File(text),
                ToProgram::Script(text),
                ToProgram::Start,
                ToProgram::Direct(text),
                ToProgram::Mail { hull, text },
                ToProgram::Answer(text),
                ToProgram::Web,
                ToProgram::Watch(is_wanted),
                ToProgram::Patch { when_gone: WhenGone::ALL[usize::from(is_wanted)], locale: Locale::ALL[usize::from(is_wanted)], path: text },
                ToProgram::Set { locale: Locale::ALL[usize::from(is_wanted)], text },
                ToProgram::Debugged(text),
                ToProgram::Debug { client, tag: client.wrapping_add(1), locale: Locale::Russian, order: text },
                ToProgram::DebugLeft,
                ToProgram::Reply { number: client, text: is_wanted.then_some(text) },
            ] {
                let payload = String::from_utf8(said.encode()).unwrap();
                prop_assert_eq!(ToProgram::parse(&payload), Some(said));
            }
        }

        #[test]
        fn what_programs_say_is_understood_by_the_daemon(text in "(?s).{0,40}", line in "[^\n]{0,40}") {
            let text = text.as_str();
            for said in [
                FromProgram::Print(text),
                FromProgram::Error(text),
                FromProgram::Info(text),
                FromProgram::Events,
                FromProgram::Mailbox(text),
                FromProgram::Web(text),
                FromProgram::Watch { line: &line, json: text },
                FromProgram::Changed { is_changed: text.len() % 2 == 0, text },
                FromProgram::Debug { client: u32::try_from(text.len()).unwrap(), json: text },
                FromProgram::DebugLog(text),
                FromProgram::Question { number: u32::try_from(text.len()).unwrap(), json: text },
                FromProgram::Stopped((text.len() % 2 == 0).then_some((7, text))),
            ] {
                let payload = String::from_utf8(said.encode()).unwrap();
                prop_assert_eq!(FromProgram::parse(&payload), Some(said));
            }
        }

        #[test]
        fn rubbish_is_passed_over_or_means_the_same_when_it_is_sent_again(payload in "(?s)[a-z]{0,8}:?.{0,40}") {
            crate::fuzz::fuzz_channel(payload.as_bytes());
        }
    }

    #[test]
    fn the_lists_of_words_are_whole() {
        for word in TO_PROGRAM {
            let second = match word {
                "patch" => "end:en:x",
                "set" => "en:x=1",
                "debug" => "1 2 en x",
                "reply" => "1 x",
                "debugpy" => "1 - x",
                _ => "1:x",
            };
            let payload = format!("{word}:{second}");
            assert!(ToProgram::parse(&payload).is_some(), "{word}");
        }
        for word in FROM_PROGRAM {
            let second = match word {
                "debug" | "question" | "stopped" => "1 x",
                _ => "1:x",
            };
            let payload = format!("{word}:{second}");
            assert!(FromProgram::parse(&payload).is_some(), "{word}");
        }
    }

    /// The first word after each mark in a text, up to a blank, a colon or a quotation mark.
    fn words_behind<'a>(text: &'a str, mark: &str) -> BTreeSet<&'a str> {
        let words = text.split(mark).skip(1);
        words
            .filter_map(|rest| rest.split([' ', ':', '\'', '"', '`']).next())
            .collect()
    }

    #[test]
    fn the_module_for_python_speaks_these_words_and_no_others() {
        let module = crate::program::python::MODULE;
        let said = words_behind(module, "_channel.send('");
        // A diagram alone tells where it is, is changed while it runs, has a debugger, and asks a person.
        let only_diagrams = ["watch", "changed", "debug", "debug-log", "question"];
        let expected: BTreeSet<_> = FROM_PROGRAM
            .into_iter()
            .filter(|word| !only_diagrams.contains(word))
            .collect();
        assert_eq!(said, expected);
        let heard = words_behind(module, "word == '");
        // All other first messages name a file, and nobody watches, changes, debugs or answers a program without blocks.
        let only_others = ["file", "script", "watch", "patch", "set", "reply"];
        let expected: BTreeSet<_> = TO_PROGRAM
            .into_iter()
            .filter(|word| !only_others.contains(word) && !word.starts_with("debug-"))
            .filter(|word| *word != "debug")
            .collect();
        assert_eq!(heard, expected);
        let asked = words_behind(module, "_ask('");
        assert_eq!(asked, BTreeSet::from(QUESTIONS));
    }

    #[test]
    fn the_scripts_for_javascript_ask_the_mailbox_what_it_answers() {
        let script = include_str!("../../js/talk.js");
        let asked = &words_behind(script, "ask('") | &words_behind(script, "flag('");
        assert_eq!(asked, BTreeSet::from(QUESTIONS));
    }

    #[test]
    fn the_document_lists_all_words() {
        let document = include_str!("../../../docs/maintainer/channel.md");
        let rows = |title: &str| -> Vec<&str> {
            let table = document.split(title).nth(1).unwrap_or_default();
            let table = table.split("\n#").next().unwrap_or_default();
            let rows = table.lines().filter_map(|line| line.strip_prefix("| `"));
            rows.filter_map(|row| row.split([':', ' ', '`']).next())
                .collect()
        };
        assert_eq!(rows("## Daemon to program"), TO_PROGRAM);
        assert_eq!(rows("## Program to daemon"), FROM_PROGRAM);
        let questions: BTreeSet<_> = rows("## Questions to the mailbox").into_iter().collect();
        assert_eq!(questions, BTreeSet::from(QUESTIONS));
    }
}
