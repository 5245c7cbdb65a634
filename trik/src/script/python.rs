//! Python under a judge: a child process whose every question about the robot and time comes here.
//!
//! Owns the process, its time and its end. `channel.py` and `virtual.py` are the other side, which runs one thread at a time and
//! asks when all of them wait. What is answered is known to `studio::script`, and what it may do on the computer to `sandbox`.

use crate::error::Error;
use crate::sandbox::Sandbox;
use frame::{Decoder, encode};
use lang_diagram::brick::{Brick, Command};
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
use studio::limits::SCRIPT_FRAME_BYTES;
use studio::script::asked::{Asked, Manner, START_MS, Turn};
use studio::script::refresh::Readings;
use trikd::program::python::MODULE;

/// What it begins with: the way to the judge, and the module `trik` in model time.
const BOOT: &str = concat!(include_str!("channel.py"), include_str!("virtual.py"));
/// A Python program that is judged.
pub struct Python {
    asked: Asked,
    file: PathBuf,
    text: String,
    seed: u32,
    longest: Duration,
    sandbox: Sandbox,
    child: Option<(Child, UnixStream)>,
    decoder: Decoder,
    until: Instant,
    began: Option<u32>,
    readings: Readings,
    ended: Option<u32>,
    is_out_of_time: bool,
    is_watched: bool,
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
            asked: Asked::new(&name, Manner::Python),
            file: absolute,
            text: text.strip_prefix('\u{feff}').unwrap_or(text).to_owned(),
            seed,
            longest,
            sandbox,
            child: None,
            decoder: Decoder::new(SCRIPT_FRAME_BYTES),
            until: Instant::now(),
            began: None,
            readings: Readings::default(),
            ended: None,
            is_out_of_time: false,
            is_watched: false,
        })
    }

    /// The same, and it is kept at which lines its threads wait and ask.
    #[must_use]
    pub fn watched(mut self) -> Self {
        self.is_watched = true;
        self.asked.watch();
        self
    }

    /// What a person may want to know of the run: standard error, and things that the simulated robot does not have.
    pub fn remarks(&self) -> &[String] {
        self.asked.remarks()
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
        let watched = if self.is_watched { "1" } else { "0" };
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
                    self.asked.fail(&told);
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
                    self.asked.fail(&format!(
                        "the program has taken {seconds} s of real time and does not wait"
                    ));
                    return None;
                }
                Err(_) => return None,
            }
        }
    }

    /// Answers the question that is open.
    fn answer(&mut self, answer: io::Result<String>) {
        let now = self.asked.now();
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

    /// The program is over, by itself or not.
    fn end(&mut self, robot: &mut dyn Brick) {
        self.ended = Some(self.asked.now());
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
            with_errors: !self.asked.errors().is_empty(),
        })
    }

    /// Answers questions until one has to wait for a later step; false: there will be no more.
    fn serve(&mut self, now: u32, robot: &mut dyn Brick) -> bool {
        let folder = self.file.parent().unwrap_or(Path::new("/")).to_owned();
        let files = |file: &str| super::beside(&folder, file).map_err(io::Error::other);
        let mut turn = self.asked.begin(now, robot, &files);
        loop {
            match turn {
                Turn::Answer(answer) => self.answer(answer),
                Turn::Listen => {}
                Turn::Wait => return true,
                Turn::End => return false,
            }
            let Some(frame) = self.hear() else {
                self.asked.fail(
                    "the program has broken off: is python3 whole, and was it ended by somebody?",
                );
                return false;
            };
            let (word, text) = frame.split_once(':').unwrap_or((&frame, ""));
            turn = self.asked.ask(word, text, robot, &files);
        }
    }
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
        if self.child.is_none()
            && let Err(error) = self.start()
        {
            self.asked.fail(&format!(
                "python3 cannot be started: {error}: is it installed?"
            ));
            self.end(robot);
            return self.status();
        }
        let mut readings = std::mem::take(&mut self.readings);
        if !self.serve(now, &mut readings.of(robot, now + START_MS)) {
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

    fn is_out_of_time(&self) -> bool {
        self.is_out_of_time
    }
}

impl Drop for Python {
    fn drop(&mut self) {
        self.kill();
    }
}
