//! The questions of one program with text, answered one after the other at moments of model time.
//!
//! Owns which question is answered at once, which one later, and what questions cost: a program that asks
//! [`limits::SCRIPT_CALLS`] times without waiting, or computes for long, is charged one tick. A question is a word and a text.
//! How they travel is known to who runs the program; files beside it are handed in.

use super::drawing;
use super::failure::problem;
use super::input::{GAMEPAD, Input, KEYS, Record};
use super::lines::Lines;
use super::post;
use super::tree::Tree;
use crate::limits;
use lang_diagram::brick::{Answer, Brick, Command, Question};
use lang_text::problem::Problem;
use std::collections::{BTreeSet, VecDeque};
use std::io;

/// When a program begins, in milliseconds of model time: as late as a diagram does in the original's simulator, so that
/// what rules do at the beginning is done by then.
pub const START_MS: u32 = 30;
/// What its first thread is called.
const MAIN: &str = "main";
/// Messages that come in one step, and that wait, at most.
const MESSAGES: usize = 256;

/// How a program asks.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Manner {
    /// As Python: who has asked too often gets the answer in the next step.
    #[default]
    Python,
    /// As JavaScript: the question of who has asked too often is looked at in the next step, and events wait in a queue.
    JavaScript,
}

/// What becomes of a question.
#[derive(Debug)]
pub enum Turn {
    /// It is answered.
    Answer(io::Result<String>),
    /// It has no answer, and the next one may come.
    Listen,
    /// The answer comes in a later step.
    Wait,
    /// The program has ended.
    End,
}

/// A question that is answered in a later step.
#[derive(Debug)]
enum Pending {
    /// At a time; infinity: never.
    Wait(f64),
    /// At a time, or as soon as there is an event.
    Event(f64),
    /// In the next step: the answer is known, if there is one.
    Answer(Option<io::Result<String>>),
    /// In the next step, and only then it is looked at.
    Question(String, String),
    /// When a person has answered.
    Input(String),
}

/// Files beside the program, by their names.
pub type Files<'a> = &'a dyn Fn(&str) -> io::Result<String>;

/// A program with text between its questions.
#[derive(Debug, Default)]
pub struct Asked {
    name: String,
    manner: Manner,
    tree: Tree,
    input: Input,
    pending: Option<Pending>,
    /// Milliseconds since the program has begun.
    now: u32,
    calls: u32,
    hull: i32,
    remarks: Vec<String>,
    errors: Vec<Problem>,
    lines: Option<Lines>,
    /// Streams that are listened to, and what has come from them and by the mailbox.
    listens: BTreeSet<String>,
    events: VecDeque<(String, String)>,
    mail: VecDeque<String>,
}

impl Asked {
    /// A program in a file of this name, before its first question.
    pub fn new(name: &str, manner: Manner) -> Self {
        Self {
            name: name.to_owned(),
            manner,
            ..Self::default()
        }
    }

    /// It is kept from now on at which lines its threads wait and ask.
    pub fn watch(&mut self) {
        self.lines = Some(Lines::default());
    }

    /// Where its threads are, if that is kept.
    pub fn lines(&self) -> Option<&Lines> {
        self.lines.as_ref()
    }

    /// The name of its file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Milliseconds since the program has begun.
    pub fn now(&self) -> u32 {
        self.now
    }

    /// What a person may want to know of the run.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    /// What has ended it, if it has failed.
    pub fn errors(&self) -> &[Problem] {
        &self.errors
    }

    /// It has failed; only the first time counts.
    pub fn fail(&mut self, text: &str) {
        if self.errors.is_empty() {
            self.errors.push(problem(&self.name, text));
        }
    }

    /// A step begins, so many milliseconds after the program: what was asked before is answered, if it is time.
    pub fn begin(&mut self, now: u32, robot: &mut dyn Brick, files: Files<'_>) -> Turn {
        (self.now, self.calls) = (now, 0);
        if self.manner == Manner::JavaScript {
            self.hear(robot);
        }
        self.go_on(robot, files)
    }

    /// What comes from outside for a program that waits for events.
    fn hear(&mut self, robot: &mut dyn Brick) {
        for _ in 0..MESSAGES {
            let Some(text) = robot.mail() else { break };
            if self.mail.len() >= MESSAGES {
                self.mail.pop_front();
            }
            self.mail.push_back(text.clone());
            self.note("mail", text);
        }
        for path in [KEYS, GAMEPAD] {
            if self.listens.contains(path) {
                for record in self.records(path, robot) {
                    self.note(path, line(record));
                }
            }
        }
    }

    fn note(&mut self, source: &str, text: String) {
        if self.events.len() >= limits::SCRIPT_EVENTS {
            self.events.pop_front();
        }
        self.events.push_back((source.to_owned(), text));
    }

    fn records(&mut self, path: &str, robot: &mut dyn Brick) -> Vec<Record> {
        match path {
            KEYS => self.input.keys(robot).into_iter().collect(),
            GAMEPAD => self.input.gamepad(robot),
            _ => Vec::new(),
        }
    }

    fn later(&mut self, pending: Pending) -> Turn {
        self.pending = Some(pending);
        Turn::Wait
    }

    fn go_on(&mut self, robot: &mut dyn Brick, files: Files<'_>) -> Turn {
        let now = f64::from(self.now);
        match self.pending.take() {
            None => Turn::Listen,
            Some(Pending::Wait(due)) if due > now => self.later(Pending::Wait(due)),
            Some(Pending::Wait(_)) => Turn::Answer(Ok(String::new())),
            Some(Pending::Event(due)) => match self.events.pop_front() {
                Some((source, text)) => Turn::Answer(Ok(format!("{source}\n{text}"))),
                None if due > now => self.later(Pending::Event(due)),
                None => Turn::Answer(Ok(String::new())),
            },
            Some(Pending::Answer(None)) => Turn::Listen,
            Some(Pending::Answer(Some(answer))) => Turn::Answer(answer),
            Some(Pending::Question(word, text)) => {
                let turn = self.consider(&word, &text, robot, files);
                self.charge(turn, false)
            }
            Some(Pending::Input(prompt)) => {
                let question = Question {
                    variable: "",
                    prompt: &prompt,
                    default: "",
                };
                match robot.ask(question) {
                    Answer::Waiting => self.later(Pending::Input(prompt)),
                    Answer::Text(text) => Turn::Answer(Ok(text)),
                    Answer::Cancelled => Turn::Answer(Err(io::Error::other("cancelled"))),
                }
            }
        }
    }

    /// Takes the next question; none is open.
    pub fn ask(&mut self, word: &str, text: &str, robot: &mut dyn Brick, files: Files<'_>) -> Turn {
        let cost = match word {
            // They wait for no answer and cost nothing: a watched run is the same run.
            "at" => {
                self.stand(text);
                return Turn::Listen;
            }
            "gone" => {
                self.gone(text);
                return Turn::Listen;
            }
            "end" => {
                self.gone(MAIN);
                if text != "0" {
                    self.fail("the program has ended itself with an error");
                }
                return Turn::End;
            }
            "wait" => {
                self.pending = Some(Pending::Wait(time(text)));
                return self.go_on(robot, files);
            }
            "input" => {
                self.pending = Some(Pending::Input(text.to_owned()));
                return self.go_on(robot, files);
            }
            "event" if !self.events.is_empty() => {
                self.pending = Some(Pending::Event(time(text)));
                return self.go_on(robot, files);
            }
            "listen" | "take" | "waiting" => 0,
            "info" if self.manner == Manner::JavaScript => 0,
            "look" => limits::SCRIPT_LOOK_CALLS,
            _ => 1,
        };
        self.calls += cost;
        let is_over = self.calls > limits::SCRIPT_CALLS;
        if is_over && self.manner == Manner::JavaScript {
            return self.later(Pending::Question(word.to_owned(), text.to_owned()));
        }
        let turn = self.consider(word, text, robot, files);
        self.charge(turn, is_over)
    }

    /// A program that asks and asks has used up its tick, and so has one that has cleared an encoder.
    fn charge(&mut self, turn: Turn, is_over: bool) -> Turn {
        let is_over = is_over || self.tree.has_cleared(self.now);
        match turn {
            Turn::Answer(answer) if is_over => self.later(Pending::Answer(Some(answer))),
            Turn::Listen if is_over => self.later(Pending::Answer(None)),
            turn @ (Turn::Answer(_) | Turn::Listen | Turn::Wait | Turn::End) => turn,
        }
    }

    /// Answers a question that is paid for.
    fn consider(
        &mut self,
        word: &str,
        text: &str,
        robot: &mut dyn Brick,
        files: Files<'_>,
    ) -> Turn {
        match word {
            "print" => {
                let text = text.strip_suffix('\n').unwrap_or(text);
                robot.command(Command::Console { text });
                return Turn::Listen;
            }
            "error" => {
                self.fail(text.trim_end());
                return Turn::Listen;
            }
            "info" => {
                if self.remarks.len() < limits::SCRIPT_REMARKS {
                    self.remarks.push(text.to_owned());
                }
                return Turn::Listen;
            }
            "event" => {
                self.pending = Some(Pending::Event(time(text)));
                return self.go_on(robot, files);
            }
            // Nobody talks to a judged program, looks at its variables and blocks, or debugs it so.
            "events" | "web" | "watch" | "changed" | "debug" | "debug-log" | "question"
            | "stopped" => return Turn::Listen,
            _ => {}
        }
        Turn::Answer(self.reply(word, text, robot, files))
    }

    /// What can be answered at once.
    fn reply(
        &mut self,
        word: &str,
        text: &str,
        robot: &mut dyn Brick,
        files: Files<'_>,
    ) -> io::Result<String> {
        let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
        let flag = |value: bool| Ok(u8::from(value).to_string());
        let nothing = |()| String::new();
        match word {
            "has" => flag(match text.trim_end_matches('/') {
                "display/device" => true,
                path => self.tree.has(robot, path),
            }),
            "names" => Ok(self.tree.names(robot, text).join(" ")),
            "read" => self.tree.read(robot, text),
            "write" => self.tree.write(robot, first, rest).map(nothing),
            "stream" => Ok(self.records(text, robot).into_iter().map(piece).collect()),
            "listen" if [KEYS, GAMEPAD].contains(&text) => {
                self.listens.insert(text.to_owned());
                Ok(String::new())
            }
            "listen" => Err(io::ErrorKind::NotFound.into()),
            "drain" => Ok(self.drain(text)),
            "draw" => drawing::order(text, |command| robot.command(command))
                .map(nothing)
                .map_err(io::Error::other),
            "mailbox" => Ok(post::answer(text, &mut self.hull, |command| {
                robot.command(command);
            })),
            "mail" => robot.mail().ok_or_else(|| io::ErrorKind::WouldBlock.into()),
            "take" => {
                let mail = self.mail.pop_front();
                mail.ok_or_else(|| io::ErrorKind::WouldBlock.into())
            }
            "waiting" => flag(!self.mail.is_empty()),
            "random" => Ok(random(text, robot)),
            "system" => {
                let (command, code) = (text, false);
                robot.command(Command::System { command, code });
                Ok("0".to_owned())
            }
            "append" => self.tree.append(robot, first, rest.as_bytes()).map(nothing),
            "remove" => {
                self.tree.remove(robot, text);
                Ok(String::new())
            }
            "file" => match self.tree.written(text) {
                Some(bytes) => Ok(String::from_utf8_lossy(bytes).into_owned()),
                None => files(text),
            },
            "include" => files(text),
            // They are only counted.
            "look" | "clock" => Ok(String::new()),
            _ => Err(io::Error::other(format!(
                "the judge knows no question '{word}'"
            ))),
        }
    }

    /// What has come from a stream, a line for each record.
    fn drain(&mut self, path: &str) -> String {
        let mut lines = Vec::new();
        self.events.retain(|(source, text)| {
            if source == path {
                lines.push(text.clone());
            }
            source != path
        });
        lines.join("\n")
    }

    /// Where a thread is: its name, the line, and the file if that is not the program's, each in a line.
    fn stand(&mut self, text: &str) {
        let at_ms = self.now + START_MS;
        let mut parts = text.split('\n');
        let name = named(parts.next().unwrap_or_default());
        if let (Some(lines), Some(line), Some(file)) = (&mut self.lines, parts.next(), parts.next())
            && let Ok(line) = line.parse()
        {
            lines.stand(&name, &named(file), line, at_ms);
        }
    }

    /// A thread has ended.
    fn gone(&mut self, name: &str) {
        if let Some(lines) = &mut self.lines {
            lines.end(&named(name), self.now + START_MS);
        }
    }
}

/// A moment; what is no number never comes.
fn time(text: &str) -> f64 {
    text.parse().unwrap_or(f64::INFINITY)
}

fn random(text: &str, robot: &mut dyn Brick) -> String {
    let (low, high) = text.split_once(' ').unwrap_or((text, text));
    let number = |text: &str| text.parse::<i64>().unwrap_or(0);
    let whole = |number: i64| number.clamp(i32::MIN.into(), i32::MAX.into()) as i32;
    let (low, high) = (whole(number(low)), whole(number(high)));
    robot.random(low, high.max(low)).to_string()
}

fn line(record: Record) -> String {
    match record {
        Record::Numbers(numbers) => {
            let words: Vec<_> = numbers.iter().map(ToString::to_string).collect();
            words.join(" ")
        }
        Record::Line(line) => line,
    }
}

/// A record as a stream has it.
fn piece(record: Record) -> String {
    match record {
        record @ Record::Numbers(_) => line(record),
        Record::Line(line) => line + "\n",
    }
}

/// The name of a thread or a file, as far as it is kept.
fn named(name: &str) -> String {
    name.chars().take(limits::SCRIPT_NAME_CHARS).collect()
}
