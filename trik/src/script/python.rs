//! Python under a judge: a child process whose every question about the robot and time comes here.
//!
//! Owns the process, its time and its end. `virtual.py` is the other side: it runs one thread at a time and asks when all
//! of them wait. What it may do on the computer is
//! known to `sandbox`.

use super::input::{GAMEPAD, Input, KEYS};
use super::lines::Lines;
use super::refresh::Readings;
use super::tree::Tree;
use super::{START_MS, drawing, problem};
use crate::error::Error;
use crate::limits;
use crate::sandbox::Sandbox;
use frame::{Decoder, encode};
use lang_diagram::brick::{Answer, Brick, Command, Question};
use lang_diagram::machine::Status;
use lang_text::problem::{Locale, Problem};
use sim::judge::{Group, Program, Running};
use std::io::{self, Read, Write};
use std::os::fd::OwnedFd;
use std::os::unix::net::UnixStream;
use std::os::unix::process::CommandExt;
use std::path::{Path, PathBuf};
use std::process::{Child, Stdio};
use std::time::{Duration, Instant};
use trikd::js::events::Record;
use trikd::program::python::MODULE;
use trikd::protocol::program::FromProgram;

const BOOT: &str = include_str!("virtual.py");
/// What its first thread is called.
const MAIN: &str = "main";

/// A question that is answered in a later step.
enum Pending {
    /// At a time; infinity: never.
    Wait(f64),
    /// In the next step: the answer is known, if there is one.
    Answer(Option<io::Result<String>>),
    /// When a person has answered.
    Input(String),
}

/// A Python program that is judged.
pub struct Python {
    name: String,
    file: PathBuf,
    text: String,
    seed: u32,
    longest: Duration,
    sandbox: Sandbox,
    child: Option<(Child, UnixStream)>,
    decoder: Decoder,
    until: Instant,
    tree: Tree,
    input: Input,
    pending: Option<Pending>,
    began: Option<u32>,
    now: u32,
    hull: i32,
    remarks: Vec<String>,
    readings: Readings,
    errors: Vec<Problem>,
    ended: Option<u32>,
    is_out_of_time: bool,
    /// At which lines threads are, if somebody looks on.
    lines: Option<Lines>,
}

impl Python {
    /// A program by its text and file; its process begins with the first step. After `longest` of real time without an
    /// end of the run it is ended.
    ///
    /// # Errors
    /// The file is nowhere.
    pub fn new(
        file: &Path,
        text: &str,
        seed: u32,
        longest: Duration,
        sandbox: Sandbox,
    ) -> Result<Self, Error> {
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let absolute = std::path::absolute(file)
            .map_err(|error| Error::file(file, format!("where is it? {error}")))?;
        Ok(Self {
            name: name.into_owned(),
            file: absolute,
            text: text.strip_prefix('\u{feff}').unwrap_or(text).to_owned(),
            seed,
            longest,
            sandbox,
            child: None,
            decoder: Decoder::new(limits::SCRIPT_FRAME_BYTES),
            until: Instant::now(),
            tree: Tree::default(),
            input: Input::default(),
            pending: None,
            began: None,
            now: 0,
            hull: 0,
            remarks: Vec::new(),
            readings: Readings::default(),
            errors: Vec::new(),
            ended: None,
            is_out_of_time: false,
            lines: None,
        })
    }

    /// The same, and it is kept at which lines its threads wait and ask.
    #[must_use]
    pub fn watched(mut self) -> Self {
        self.lines = Some(Lines::default());
        self
    }

    /// What a person may want to know of the run: standard error, and things that the simulated robot does not have.
    pub fn remarks(&self) -> &[String] {
        &self.remarks
    }

    fn start(&mut self) -> io::Result<()> {
        // A busy machine may take long to start it: that is of the time of the run, which others measure too.
        self.until = Instant::now() + self.longest;
        let (ours, theirs) = UnixStream::pair()?;
        let folder = self.file.parent().unwrap_or(Path::new("/"));
        let arguments = ["-s", "-B", "-c", BOOT];
        let child = self
            .sandbox
            .command(&arguments, folder, self.longest)?
            .stdin(Stdio::from(OwnedFd::from(theirs)))
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .process_group(0)
            .spawn()?;
        let mut channel = ours;
        channel.set_write_timeout(Some(self.longest))?;
        let program = format!("{}\n{}", self.file.display(), self.text);
        let watched = if self.lines.is_some() { "1" } else { "0" };
        let sent = [MODULE, &program, &self.seed.to_string(), watched]
            .iter()
            .try_for_each(|text| channel.write_all(&encode(text.as_bytes())));
        self.child = Some((child, channel));
        sent
    }

    /// The next thing that the program says; None: it is gone, or its time is over.
    fn hear(&mut self) -> Option<String> {
        loop {
            match self.decoder.next() {
                Ok(Some(frame)) => return Some(String::from_utf8_lossy(frame).into_owned()),
                Ok(None) => {}
                Err(violation) => {
                    let told = violation.to_string();
                    self.fail(&told);
                    return None;
                }
            }
            let (_, channel) = self.child.as_mut()?;
            let left = self.until.saturating_duration_since(Instant::now());
            let timed = !left.is_zero() && channel.set_read_timeout(Some(left)).is_ok();
            let mut buffer = [0; 8192];
            match if timed {
                channel.read(&mut buffer)
            } else {
                Err(io::ErrorKind::TimedOut.into())
            } {
                Ok(0) => return None,
                Ok(size) => self.decoder.feed(&buffer[..size]),
                Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                Err(error)
                    if [io::ErrorKind::WouldBlock, io::ErrorKind::TimedOut]
                        .contains(&error.kind()) =>
                {
                    self.is_out_of_time = true;
                    let seconds = self.longest.as_secs_f64();
                    self.fail(&format!(
                        "the program has taken {seconds} s of real time and does not wait"
                    ));
                    return None;
                }
                Err(_) => return None,
            }
        }
    }

    fn fail(&mut self, text: &str) {
        if self.errors.is_empty() {
            self.errors.push(problem(&self.name, text));
        }
    }

    /// Answers the question that is open.
    fn answer(&mut self, answer: io::Result<String>) {
        let now = self.now;
        let text = match answer {
            Ok(text) => format!("ok:{now}:{text}"),
            Err(error) => {
                let number = if error.kind() == io::ErrorKind::WouldBlock {
                    libc::EAGAIN
                } else if error.kind() == io::ErrorKind::NotFound {
                    libc::ENOENT
                } else {
                    libc::EIO
                };
                format!("no:{now}:{number}:{error}")
            }
        };
        if let Some((_, channel)) = &mut self.child {
            // A client that is gone says so when it is heard.
            let _ = channel.write_all(&encode(text.as_bytes()));
        }
    }

    /// Answers what was asked before, if it is time; false: not yet.
    fn go_on(&mut self, robot: &mut dyn Brick) -> bool {
        match self.pending.take() {
            None => true,
            Some(Pending::Wait(due)) if due > f64::from(self.now) => {
                self.pending = Some(Pending::Wait(due));
                false
            }
            Some(Pending::Wait(_)) => {
                self.answer(Ok(String::new()));
                true
            }
            Some(Pending::Answer(answer)) => {
                if let Some(answer) = answer {
                    self.answer(answer);
                }
                true
            }
            Some(Pending::Input(prompt)) => {
                let question = Question {
                    variable: "",
                    prompt: &prompt,
                    default: "",
                };
                match robot.ask(question) {
                    Answer::Waiting => {
                        self.pending = Some(Pending::Input(prompt));
                        return false;
                    }
                    Answer::Text(text) => self.answer(Ok(text)),
                    Answer::Cancelled => self.answer(Err(io::Error::other("cancelled"))),
                }
                true
            }
        }
    }

    /// What every program says to its runner; only a question to the mailbox has an answer.
    fn hear_message(
        &mut self,
        message: FromProgram<'_>,
        robot: &mut dyn Brick,
    ) -> Option<io::Result<String>> {
        match message {
            FromProgram::Print(text) => {
                let text = text.strip_suffix('\n').unwrap_or(text);
                robot.command(Command::Console { text });
            }
            FromProgram::Error(text) => self.fail(text.trim_end()),
            FromProgram::Info(text) => {
                if self.remarks.len() < limits::SCRIPT_REMARKS {
                    self.remarks.push(text.to_owned());
                }
            }
            FromProgram::Mailbox(question) => return Some(Ok(self.mailbox(question, robot))),
            // Nobody talks to a judged program, looks at its variables and blocks, or debugs it so.
            FromProgram::Events
            | FromProgram::Web(_)
            | FromProgram::Watch { .. }
            | FromProgram::Changed { .. }
            | FromProgram::Debug { .. }
            | FromProgram::DebugLog(_)
            | FromProgram::Question { .. }
            | FromProgram::Stopped(_) => {}
        }
        None
    }

    /// What can be answered at once; what has no answer gives None.
    fn reply(
        &mut self,
        word: &str,
        text: &str,
        robot: &mut dyn Brick,
    ) -> Option<io::Result<String>> {
        let (first, rest) = text.split_once('\n').unwrap_or((text, ""));
        let flag = |value: bool| Ok(u8::from(value).to_string());
        Some(match word {
            "has" => flag(match text.trim_end_matches('/') {
                "display/device" => true,
                path => self.tree.has(robot, path),
            }),
            "names" => Ok(self.tree.names(robot, text).join(" ")),
            "read" => self.tree.read(robot, text),
            "write" => self.tree.write(robot, first, rest).map(|()| String::new()),
            "stream" => Ok(self.stream(text, robot)),
            "draw" => drawing::order(text, |command| robot.command(command))
                .map(|()| String::new())
                .map_err(io::Error::other),
            "mail" => robot.mail().ok_or_else(|| io::ErrorKind::WouldBlock.into()),
            "random" => {
                let (low, high) = text.split_once(' ').unwrap_or((text, text));
                let number = |text: &str| text.parse::<i64>().unwrap_or(0);
                let whole = |number: i64| number.clamp(i32::MIN.into(), i32::MAX.into()) as i32;
                let (low, high) = (whole(number(low)), whole(number(high)));
                Ok(robot.random(low, high.max(low)).to_string())
            }
            "system" => {
                let (command, code) = (text, false);
                robot.command(Command::System { command, code });
                Ok("0".to_owned())
            }
            "append" => {
                let done = self.tree.append(robot, first, rest.as_bytes());
                done.map(|()| String::new())
            }
            "remove" => {
                self.tree.remove(robot, text);
                Ok(String::new())
            }
            "file" => self.read_file(text),
            // It is only counted.
            "look" => Ok(String::new()),
            _ => Err(io::Error::other(format!(
                "the judge knows no question '{word}'"
            ))),
        })
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

    fn read_file(&self, file: &str) -> io::Result<String> {
        if let Some(bytes) = self.tree.written(file) {
            return Ok(String::from_utf8_lossy(bytes).into_owned());
        }
        let folder = self.file.parent().unwrap_or(Path::new("/"));
        super::beside(folder, file).map_err(io::Error::other)
    }

    fn stream(&mut self, path: &str, robot: &mut dyn Brick) -> String {
        let records = match path {
            KEYS => self.input.keys(robot).into_iter().collect(),
            GAMEPAD => self.input.gamepad(robot),
            _ => Vec::new(),
        };
        let texts = records.into_iter().map(|record| match record {
            Record::Numbers(numbers) => {
                let words: Vec<_> = numbers.iter().map(ToString::to_string).collect();
                words.join(" ")
            }
            Record::Line(line) => line + "\n",
        });
        texts.collect()
    }

    fn mailbox(&mut self, words: &str, robot: &mut dyn Brick) -> String {
        super::mailbox(words, &mut self.hull, |command| robot.command(command))
    }

    /// The program is over, by itself or not.
    fn end(&mut self, robot: &mut dyn Brick) {
        self.ended = Some(self.now);
        self.kill();
        robot.command(Command::Rest);
    }

    fn kill(&mut self) {
        let Some((mut child, channel)) = self.child.take() else {
            return;
        };
        drop(channel);
        // What it has started goes with it.
        if let Ok(group) = i32::try_from(child.id()) {
            let group = nix::unistd::Pid::from_raw(group);
            let _ = nix::sys::signal::killpg(group, nix::sys::signal::Signal::SIGKILL);
        }
        let _ = child.kill();
        let _ = child.wait();
        self.sandbox.leave(child.id());
    }

    fn status(&self) -> Status {
        self.ended.map_or(Status::Running, |at| Status::Ended {
            at,
            with_errors: !self.errors.is_empty(),
        })
    }

    /// Answers questions until one has to wait for a later step; false: there will be no more.
    fn serve(&mut self, robot: &mut dyn Brick) -> bool {
        let mut calls = 0;
        if !self.go_on(robot) {
            return true;
        }
        loop {
            let Some(frame) = self.hear() else {
                self.fail(
                    "the program has broken off: is python3 whole, and was it ended by somebody?",
                );
                return false;
            };
            let (word, text) = frame.split_once(':').unwrap_or((&frame, ""));
            match word {
                // They wait for no answer and cost nothing: a watched run is the same run.
                "at" => {
                    self.stand(text);
                    continue;
                }
                "gone" => {
                    self.gone(text);
                    continue;
                }
                "end" => {
                    self.gone(MAIN);
                    if text != "0" {
                        self.fail("the program has ended itself with an error");
                    }
                    return false;
                }
                "wait" => {
                    let due = text.parse().unwrap_or(f64::INFINITY);
                    self.pending = Some(Pending::Wait(due));
                    if !self.go_on(robot) {
                        return true;
                    }
                    continue;
                }
                "input" => {
                    self.pending = Some(Pending::Input(text.to_owned()));
                    if !self.go_on(robot) {
                        return true;
                    }
                    continue;
                }
                "look" => calls += limits::SCRIPT_LOOK_CALLS,
                _ => calls += 1,
            }
            let answer = match FromProgram::parse(&frame) {
                Some(message) => self.hear_message(message, robot),
                None => self.reply(word, text, robot),
            };
            if calls > limits::SCRIPT_CALLS || self.tree.has_cleared(self.now) {
                // A program that asks and asks has used up its tick.
                self.pending = Some(Pending::Answer(answer));
                return true;
            }
            if let Some(answer) = answer {
                self.answer(answer);
            }
        }
    }
}

/// The name of a thread or a file, as far as it is kept.
fn named(name: &str) -> String {
    name.chars().take(limits::SCRIPT_NAME_CHARS).collect()
}

impl Program for Python {
    fn step(&mut self, now_ms: u32, robot: &mut dyn Brick) -> Status {
        if self.ended.is_some() {
            return self.status();
        }
        let began = *self.began.get_or_insert(now_ms + START_MS);
        let Some(now) = now_ms.checked_sub(began) else {
            return Status::Running;
        };
        self.now = now;
        if self.child.is_none()
            && let Err(error) = self.start()
        {
            self.fail(&format!(
                "python3 cannot be started: {error}: is it installed?"
            ));
            self.end(robot);
            return self.status();
        }
        let mut readings = std::mem::take(&mut self.readings);
        if !self.serve(&mut readings.of(robot, now + START_MS)) {
            self.end(robot);
        }
        self.readings = readings;
        self.status()
    }

    fn stop(&mut self, robot: &mut dyn Brick) {
        if self.ended.is_none() {
            self.end(robot);
        }
    }

    fn errors(&self) -> &[Problem] {
        &self.errors
    }

    fn running(&self) -> Vec<Running> {
        let lines = self.lines.as_ref();
        lines.map_or_else(Vec::new, |lines| lines.running(&self.name))
    }

    fn describe(&self, locale: Locale, tell: &mut dyn FnMut(Group, &str, &str)) {
        if let Some(lines) = &self.lines {
            lines.describe(locale, tell);
        }
    }

    fn is_out_of_time(&self) -> bool {
        self.is_out_of_time
    }
}

impl Drop for Python {
    fn drop(&mut self) {
        self.kill();
    }
}
