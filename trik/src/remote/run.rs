//! `trik run`: a program to a robot, what it says to this terminal, and how it ended as the exit code.
//!
//! Owns the person in front of it: progress, Ctrl-C, standard output and standard error.

use super::link::{Link, Message, ms};
use super::live::{Watched, gone};
use super::output::{Output, harmless, say};
use super::person::Person;
use super::target::{Target, target, the_one};
use super::upload::{Upload, start};
use crate::debug::target::words::told;
use crate::error::Error;
use crate::language;
use crate::limits;
use clap::Args;
use lang_text::problem::Locale;
use nix::sys::signal::{SigSet, Signal};
use nix::sys::signalfd::{SfdFlags, SignalFd};
use std::io::{self, IsTerminal, Write};
use std::os::fd::AsFd;
use std::path::PathBuf;
use std::time::{Duration, Instant};
use trikd::protocol::news::{self, End};
use trikd::protocol::program::WhenGone;

/// What `trik run` can be told.
#[derive(Args, Clone, Debug, PartialEq, Eq)]
pub(crate) struct RunArgs {
    /// The program: NAME.js, NAME.py, NAME.qrs (a diagram of TRIK Studio), NAME.flow (a data-flow program), NAME.lua, or a file that begins with #! or is
    /// compiled for the robot.
    pub file: PathBuf,
    /// The robot: its name or address, with its port if that is not 8888, or where the tree of a virtual one is mounted, a
    /// path with a slash [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "ROBOT", value_parser = target)]
    pub robot: Option<Target>,
    /// Run the main diagram of this name instead of the first one of the file.
    #[arg(long, value_name = "NAME")]
    pub diagram: Option<String>,
    /// Send the diagram again at each save, and change the one that runs without a stop: blocks that are still there keep
    /// their loops and waits, variables keep their values. A save with mistakes changes nothing.
    #[arg(long)]
    pub watch: bool,
    /// What becomes of threads at blocks that a save no longer has.
    #[arg(
        long,
        value_parser = gone(),
        default_value = WhenGone::End.word(),
        requires = "watch",
        value_name = "POLICY"
    )]
    pub gone: WhenGone,
    /// Language of sentences about the program: en or ru. What the program says is its own.
    #[arg(long, value_name = "LANGUAGE", default_value = "en", value_parser = language::locale)]
    pub language: Locale,
}

/// The program has failed, or was stopped.
const FAILED: u8 = 1;
/// It could not be run, or its end is not known.
const COULD_NOT: u8 = 2;

/// Runs a program on a robot until it ends. The exit code: 0 it has ended, 1 it has failed or was stopped, 2 it could not
/// be run, or nobody knows how it ended.
pub(crate) fn run(args: &RunArgs) -> u8 {
    follow(args).unwrap_or_else(|error| {
        say(&told(&error.to_string(), args.language));
        COULD_NOT
    })
}

fn follow(args: &RunArgs) -> Result<u8, Error> {
    let diagram = args.diagram.as_deref();
    let watched = match args.watch {
        true => Some(Watched::new(&args.file, diagram, args.gone, args.language)?),
        false => None,
    };
    let upload = Upload::read(&args.file, diagram, args.language)?;
    let target = match &args.robot {
        Some(target) => target.clone(),
        None => the_one()?,
    };
    let mut link = target.connect()?;
    let mut progress = Progress::new(&upload.name);
    let sent = upload.send(&mut link, |done, all| progress.show(done, all));
    progress.end();
    sent?;
    // Until here nothing runs, so Ctrl-C may end this process at once.
    let mask: SigSet = [Signal::SIGINT, Signal::SIGTERM, Signal::SIGHUP]
        .into_iter()
        .collect();
    let own = |error: nix::Error| Error::system("signals", error);
    mask.thread_block().map_err(own)?;
    let flags = SfdFlags::SFD_NONBLOCK | SfdFlags::SFD_CLOEXEC;
    let signals = SignalFd::with_flags(&mask, flags).map_err(own)?;
    // A question may be the first thing that it does.
    link.ask(&[b"questions"]);
    link.speak(args.language);
    start(&mut link, &upload.name, Some(signals.as_fd()))?;
    let mut session = Session {
        link,
        name: upload.name,
        output: Output::to(io::stdout()),
        signals,
        stopping: None,
        watched,
        person: Person::default(),
        locale: args.language,
    };
    let code = session.run();
    let Session {
        output, signals, ..
    } = session;
    output.finish(|| {
        std::thread::sleep(ms(limits::ROOM_MS));
        matches!(signals.read_signal(), Ok(Some(_)))
    });
    code
}

/// A program that runs.
struct Session {
    link: Link,
    name: String,
    output: Output,
    signals: SignalFd,
    /// It was told to stop, and has that long.
    stopping: Option<Instant>,
    /// Its file, if saves of it change the program.
    watched: Option<Watched>,
    /// Who answers its questions.
    person: Person,
    /// The language of who runs it.
    locale: Locale,
}

impl Session {
    fn run(&mut self) -> Result<u8, Error> {
        loop {
            while self.output.has_room()
                && let Some(message) = self.link.next()
            {
                if let Some(code) = self.hear(message) {
                    return Ok(code);
                }
            }
            // One in each turn, which sends what the last one has asked for.
            if let Ok(Some(_)) = self.signals.read_signal() {
                if self.stopping.is_some() {
                    self.tell(&format!(
                        "left; {} may still run on {}: trik stop ends it",
                        self.name,
                        self.link.name()
                    ));
                    return Ok(FAILED);
                }
                self.tell(&format!(
                    "stopping {} on {}; a second Ctrl-C does not wait",
                    self.name,
                    self.link.name()
                ));
                self.stop();
            }
            // As a program on this computer ends whose output nobody takes.
            if self.output.is_closed() && self.stopping.is_none() {
                self.stop();
            }
            if self.stopping.is_some_and(|until| Instant::now() >= until) {
                return Err(Error::Robot(format!(
                    "{} does not say that {} has stopped: look at the robot",
                    self.link.name(),
                    self.name
                )));
            }
            if self.stopping.is_none()
                && let Some(requests) = self.watched.as_mut().and_then(Watched::save)
            {
                requests
                    .iter()
                    .for_each(|request| self.link.ask(&[request]));
            }
            if let Some(request) = self.person.answer() {
                self.link.ask(&[&request]);
            }
            self.turn()?;
        }
    }

    fn tell(&self, text: &str) {
        say(&told(text, self.locale));
    }

    fn turn(&mut self) -> Result<(), Error> {
        let listens = self.output.has_room();
        let pause = ms(if listens {
            limits::TURN_MS
        } else {
            limits::ROOM_MS
        });
        let turned = self.link.turn(pause, Some(self.signals.as_fd()), listens);
        turned.map_err(|why| {
            Error::Unreachable(format!(
                "{why}; {} may still run: trik stop ends it, once the robot can be reached",
                self.name
            ))
        })
    }

    fn stop(&mut self) {
        self.link.ask(&[b"stop"]);
        self.link.ask(&[b"status"]);
        self.stopping = Some(Instant::now() + ms(limits::ANSWER_MS));
    }

    /// The exit code if that was the end.
    fn hear(&mut self, message: Message) -> Option<u8> {
        match message {
            Message::Print(bytes) => self.output.put(bytes),
            Message::Error(text) | Message::Info(text) => {
                if let Some(end) = news::ended(&text, &self.name) {
                    return Some(self.judge(end, &text));
                }
                if text.ends_with(news::SLOW_READER) {
                    // The end may have been among what was left out.
                    self.link.ask(&[b"status"]);
                }
                if text != news::started(&self.name) {
                    let text = match &self.watched {
                        Some(watched) => watched.told(&text),
                        None => told(&text, self.locale),
                    };
                    let text = harmless(&text);
                    let _ = writeln!(io::stderr(), "{}", text.trim_end());
                }
            }
            Message::Status(text) => return self.compare(&text),
            Message::Question(json) => {
                self.person.ask(&json);
            }
            Message::Version | Message::Debug(_) | Message::Stream(_) => {}
        }
        None
    }

    /// What runs now. None if that is still this program.
    fn compare(&self, text: &str) -> Option<u8> {
        let status = news::status(text);
        if status.is_of(&self.name) {
            return None;
        }
        let last = status.last.unwrap_or_default();
        Some(match news::ended(last, &self.name) {
            Some(end) => self.judge(end, last),
            None => {
                self.tell(&format!("{} does not run any more", self.name));
                FAILED
            }
        })
    }

    fn judge(&self, end: End, text: &str) -> u8 {
        if end == End::Well {
            return 0;
        }
        // A reader that has closed the output knows that.
        if !self.output.is_closed() {
            self.tell(text);
        }
        FAILED
    }
}

/// How far a large program is, in one line of a terminal.
struct Progress<'a> {
    name: &'a str,
    shows: bool,
    shown: Option<Instant>,
}

impl<'a> Progress<'a> {
    fn new(name: &'a str) -> Self {
        Self {
            name,
            shows: io::stderr().is_terminal(),
            shown: None,
        }
    }

    fn show(&mut self, done: usize, all: usize) {
        let is_time = self
            .shown
            .is_none_or(|shown| shown.elapsed() >= Duration::from_millis(limits::VIEW_MS.into()));
        if self.shows && all >= limits::PROGRESS_BYTES && (is_time || done == all) {
            self.shown = Some(Instant::now());
            let _ = write!(io::stderr(), "\r{}: {} %", self.name, percent(done, all));
        }
    }

    fn end(&self) {
        if self.shown.is_some() {
            let _ = writeln!(io::stderr());
        }
    }
}

/// How much of it, rounded down.
pub(super) fn percent(done: usize, all: usize) -> usize {
    done.saturating_mul(100) / all.max(1)
}
