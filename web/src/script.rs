//! A program in a language with text whose questions come from outside: control turned round.
//!
//! The engine runs elsewhere, in JavaScript or Python of a browser, and asks; the world moves as far as the answer needs, and the
//! program is held between two questions. Owns that turn. What is answered is known in `studio::script`, what is seen in
//! `course`.

use crate::course::Course;
use crate::failure::Failure;
use crate::judged::{Refused, Wish, task};
use crate::project::Answer;
use crate::{limits, words};
use lang_diagram::brick::{Brick, Command};
use lang_diagram::machine::Status;
use lang_text::javascript::with_call_of_main;
use lang_text::problem::{Locale, Problem};
use serde_json::Value;
use sim::judge::{Clock, Group, Program, Running, Texts};
use std::io;
use std::path::Path;
use std::time::Duration;
use studio::limits::{SCRIPT_FRAME_BYTES, SCRIPT_REMARKS};
use studio::lint::unread;
use studio::script::asked::{Asked, Manner, START_MS, Turn};
use studio::script::refresh::Readings;

/// What the program is told when there is nothing to ask any more.
const OVER: &str = "over";
/// What it is told when the answer needs more ticks.
const LATER: &str = "later";
/// Numbers of failures, as Linux has them and Python knows them.
const ENOENT: u32 = 2;
const EIO: u32 = 5;
const EAGAIN: u32 = 11;

/// A program that asks from outside.
#[derive(Debug)]
struct Asking {
    asked: Asked,
    readings: Readings,
    began: Option<u32>,
    ended: Option<u32>,
    /// The moment of the step that is not finished: the program may ask in it.
    open: Option<u32>,
    question: Option<(String, String)>,
    answer: Option<io::Result<String>>,
}

/// There are no files in a browser.
fn beside(file: &str) -> io::Result<String> {
    let why = format!("{file}: a program that runs in a browser has no files beside it");
    Err(io::Error::new(io::ErrorKind::NotFound, why))
}

impl Asking {
    fn status(&self) -> Status {
        self.ended.map_or(Status::Running, |at| Status::Ended {
            at,
            with_errors: !self.asked.errors().is_empty(),
        })
    }

    /// What a turn has come to: the step stays open while the program has something to ask in it.
    fn take(&mut self, turn: Turn, now_ms: u32, robot: &mut dyn Brick) {
        self.open = None;
        match turn {
            Turn::Wait => {}
            Turn::End => {
                self.ended = Some(self.asked.now());
                robot.command(Command::Rest);
            }
            Turn::Listen => {
                self.open = Some(now_ms);
                self.answer = Some(Ok(String::new()));
            }
            Turn::Answer(answer) => {
                self.open = Some(now_ms);
                self.answer = Some(answer);
            }
        }
    }
}

impl Program for Asking {
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status {
        if self.ended.is_some() {
            return self.status();
        }
        let began = *self.began.get_or_insert(now_ms + START_MS);
        let Some(now) = now_ms.checked_sub(began) else {
            return Status::Running;
        };
        let mut readings = std::mem::take(&mut self.readings);
        if self.open != Some(now_ms) {
            let robot = &mut readings.of(robot, now + START_MS);
            let is_new = self.question.is_some();
            let turn = self.asked.begin(now, robot, &beside);
            match turn {
                // Nothing was open: what is asked first comes now.
                Turn::Listen if is_new => self.open = Some(now_ms),
                turn @ (Turn::Answer(_) | Turn::Listen | Turn::Wait | Turn::End) => {
                    self.take(turn, now_ms, robot);
                }
            }
        }
        if self.open.is_some()
            && let Some((word, text)) = self.question.take()
        {
            let robot = &mut readings.again(robot);
            let turn = self.asked.ask(&word, &text, robot, &beside);
            self.take(turn, now_ms, robot);
        }
        self.readings = readings;
        self.status()
    }

    fn is_held(&self) -> bool {
        self.open.is_some() && self.ended.is_none()
    }

    fn stop(&mut self, robot: &mut dyn Brick) {
        if self.ended.is_none() {
            self.ended = Some(self.asked.now());
            robot.command(Command::Rest);
        }
    }

    fn errors(&self) -> &[Problem] {
        self.asked.errors()
    }

    fn running(&self) -> Vec<Running> {
        let lines = self.asked.lines();
        lines.map_or_else(Vec::new, |lines| lines.running(self.asked.name()))
    }

    fn describe(&self, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
        if let Some(lines) = self.asked.lines() {
            lines.describe(locale, tell);
        }
    }
}

/// A program with text in its world.
pub struct Script {
    name: String,
    program: Asking,
    course: Course,
}

/// Which language a file is in, by its name.
fn manner(name: &str) -> Option<Manner> {
    match Path::new(name).extension()?.to_str()? {
        "py" => Some(Manner::Python),
        "js" => Some(Manner::JavaScript),
        _ => None,
    }
}

/// The text of a program as its engine runs it.
pub fn runnable(name: &str, text: &str) -> String {
    match manner(name) {
        Some(Manner::JavaScript) => with_call_of_main(text.to_owned()),
        Some(Manner::Python) | None => text.strip_prefix('\u{feff}').unwrap_or(text).to_owned(),
    }
}

impl Script {
    /// A program in a file of this name, before it asks anything, in the world of this text; an empty one is an empty floor.
    /// Options are those of [`Wish::read`] without `field` and `debug`; the caller bounds real time.
    pub fn begin(name: &str, world: &str, options: &str) -> Answer<Self> {
        let mut locale = Locale::default();
        let begun = Wish::read(options, Clock::default(), &mut locale)
            .and_then(|wish| Self::of(name, world, wish));
        (begun, locale)
    }

    fn of(name: &str, world: &str, mut wish: Wish) -> Result<Self, Failure> {
        let Some(manner) = manner(name) else {
            return Err(Failure::Request(words::no_script()));
        };
        for (name, is_given) in [
            ("field", wish.field.is_some()),
            ("debug", wish.is_debugging),
        ] {
            if is_given {
                return Err(Failure::Request(words::no_option(name)));
            }
        }
        wish.settings.longest = Duration::MAX;
        wish.settings.is_showing = true;
        let texts = Texts {
            world,
            blobs: None,
            templates: None,
        };
        let (task, strange) =
            task(texts, wish.settings.locale).map_err(|why: Box<Refused>| why.failure)?;
        let mut asked = Asked::new(name, manner);
        asked.watch();
        let mut program = Asking {
            asked,
            readings: Readings::default(),
            began: None,
            ended: None,
            open: None,
            question: None,
            answer: None,
        };
        let course = Course::new(&task, strange, &mut program, wish.settings);
        Ok(Self {
            name: name.to_owned(),
            program,
            course,
        })
    }

    /// Takes a question of the program, and makes at most so many ticks of 10 ms until it is answered: `ok:NOW:TEXT` or
    /// `no:NOW:ERRNO:REASON`, with milliseconds since the program has begun; `later` if it needs more of them, and then
    /// [`Script::go_on`] comes next; `over` if the run is.
    pub fn ask(&mut self, word: &str, text: &str, ticks: u32) -> String {
        if word.len() + text.len() >= SCRIPT_FRAME_BYTES {
            return self.refuse();
        }
        self.program.question = Some((word.to_owned(), text.to_owned()));
        self.go_on(ticks)
    }

    /// The answer to a question that is none, or too long.
    pub fn refuse(&self) -> String {
        let most = SCRIPT_FRAME_BYTES >> 20;
        let why = format!("a program says at most {most} MiB at once, as text");
        self.told(Err(io::Error::other(why)))
    }

    /// Makes more ticks for the question that is not answered yet.
    pub fn go_on(&mut self, ticks: u32) -> String {
        let mut left = ticks.min(limits::TICKS_MAX);
        loop {
            if let Some(answer) = self.program.answer.take() {
                return self.told(answer);
            }
            if self.course.progress() == OVER {
                return OVER.to_owned();
            }
            // It is held until it asks something.
            if self.program.open.is_some() && self.program.question.is_none() {
                return self.told(Err(io::Error::other("nothing was asked")));
            }
            // A held program goes on in the same tick, which then is not a new one.
            if self.program.open.is_none() {
                let Some(fewer) = left.checked_sub(1) else {
                    return LATER.to_owned();
                };
                left = fewer;
            }
            self.course.tick(&mut self.program);
            self.course.settle(&mut self.program);
        }
    }

    fn told(&self, answer: io::Result<String>) -> String {
        let now = self.program.asked.now();
        match answer {
            Ok(text) => format!("ok:{now}:{text}"),
            Err(error) => {
                let number = match error.kind() {
                    io::ErrorKind::WouldBlock => EAGAIN,
                    io::ErrorKind::NotFound => ENOENT,
                    _ => EIO,
                };
                format!("no:{now}:{number}:{error}")
            }
        }
    }

    /// What there is to see of it.
    pub fn course(&self) -> &Course {
        &self.course
    }

    /// What moves in the world, and where the program is, as JSON.
    pub fn state(&self) -> String {
        self.course.state(&self.program)
    }

    /// What rules and program have said and printed since the last time.
    pub fn news(&mut self) -> Value {
        self.course.news()
    }

    /// What a person may want to know of the run: things that the simulated robot does not have.
    pub fn remarks(&self) -> Value {
        let remarks = self.program.asked.remarks().iter().take(SCRIPT_REMARKS);
        remarks.map(|remark| Value::from(remark.as_str())).collect()
    }

    /// Ends it as it is.
    pub fn end(&mut self) {
        self.course.end(&mut self.program);
    }

    /// What came out, as [`crate::judged::judge`] tells it; nothing before the end.
    pub fn outcome(&self) -> Option<Value> {
        let findings = unread(Path::new(&self.name));
        self.course.outcome(&self.name, findings)
    }
}
