//! Recordings that come from a robot: what happens there from now on, and the last minutes of its black box.
//!
//! Owns the way from pieces of a connection to a file, and what a person is told meanwhile. What is in the pieces is known to
//! `journal`.

use super::link::{Link, Message, ms};
use super::target::{Target, target, the_one};
use crate::error::Error;
use crate::limits;
use crate::output::Output;
use crate::record::NO_RAW;
use crate::record::args::RecordArgs;
use crate::recording::fresh::Fresh;
use crate::refusal::{self, Refusal};
use crate::up::session::signals;
use clap::Args;
use journal::node::Node;
use journal::read::Reader;
use nix::sys::signalfd::SignalFd;
use std::cell::Cell;
use std::fs::File;
use std::io::{self, BufReader, BufWriter, IsTerminal, Read, Write};
use std::os::fd::AsFd;
use std::path::{Path, PathBuf};
use std::rc::Rc;
use std::time::{Duration, Instant};

/// What `trik box save` can be told.
#[derive(Args, Clone, Debug)]
pub(crate) struct SaveArgs {
    /// The recording, a new file.
    #[arg(long, short, value_name = "FILE.mcap", default_value = "box.mcap")]
    pub output: PathBuf,
    /// Overwrite the recording if it exists.
    #[arg(long)]
    pub force: bool,
    /// The robot: its name or address, with its port if that is not 8888, or where the tree of a virtual one is mounted, a
    /// path with a slash [default: the virtual robot that runs on this computer, or else 127.0.0.1].
    #[arg(long, value_name = "ROBOT", value_parser = target)]
    pub robot: Option<Target>,
}

/// Records what happens on a robot, until somebody stops it.
///
/// # Errors
/// The robot is not reached, does not send, or the file is there already or cannot be written.
pub(crate) fn record(args: &RecordArgs, robot: &Target) -> Result<u8, Refusal> {
    let mut wanted = args.only.join(",");
    if let Some(rate_hz) = args.hz {
        wanted.push_str(&format!(";hz={rate_hz}"));
    }
    if args.raw {
        wanted.push_str(";raw");
    }
    let seconds = args
        .seconds
        .map(|seconds| Duration::from_secs(seconds.into()));
    let mut pieces = Pieces::of(robot, &[b"stream:", wanted.as_bytes()], seconds)?;
    // A robot that refuses leaves no empty file.
    pieces.wait()?;
    say(&format!(
        "recording what {robot} sends into {}; Ctrl-C ends it\n",
        args.output.display()
    ))?;
    // It grows under its name, for programs that look at it meanwhile.
    let place = Output::recording(&args.output, args.force).make_room()?;
    let file = File::create_new(&place).map_err(|error| Error::file(&args.output, error))?;
    let hint = "; trik mend keeps what was written before";
    // Told at once: at the end it is too late to begin anew.
    let is_told = Rc::<Cell<bool>>::default();
    let (tells, name) = (is_told.clone(), args.output.clone());
    let is_wanted = args.raw;
    let begun = move |nodes: &[Node]| {
        if is_wanted && !nodes.iter().any(|node| node.is_raw) {
            tells.set(true);
            let why = Error::file(&name, format!("{NO_RAW}; all else is recorded"));
            refusal::say(&Refusal::from(why).lines);
        }
    };
    let kept = keep(pieces, &args.output, &file, (hint, begun))?;
    kept.tell()?;
    match args.raw && !has_raw(&args.output)? {
        true if is_told.get() => Err(Error::Reported.into()),
        // Nothing else is there either.
        true => Err(Error::file(&args.output, NO_RAW).into()),
        false => Ok(0),
    }
}

/// Whether a recording has anything of devices.
fn has_raw(path: &Path) -> Result<bool, Error> {
    let file = File::open(path).map_err(|error| Error::file(path, error))?;
    let reader = Reader::open(BufReader::new(file)).map_err(|why| Error::file(path, why))?;
    Ok(!reader.raws().is_empty())
}

/// Fetches the last minutes of a robot, which has saved them as well.
///
/// # Errors
/// The robot is not reached or keeps none, or the file is there already or cannot be written.
pub(crate) fn save(args: &SaveArgs) -> Result<u8, Refusal> {
    let output = Output::recording(&args.output, args.force);
    output.refuse_no_file()?;
    output.refuse_present()?;
    let robot = match &args.robot {
        Some(robot) => robot.clone(),
        None => the_one()?,
    };
    let mut pieces = Pieces::of(&robot, &[b"box"], None)?;
    pieces.wait()?;
    let fresh = Fresh::new(&args.output, Path::new(""), args.force)?;
    let kept = keep(pieces, &args.output, &fresh.file()?, ("", |_| {}))?;
    // A part is better than nothing, but not than what is there.
    if kept.failure.is_none() || !args.output.exists() {
        fresh.place()?;
    }
    kept.tell()
}

fn say(text: &str) -> Result<(), Refusal> {
    crate::output::standard(text.as_bytes())
}

/// What was put into a file.
struct Kept {
    line: String,
    /// Why it is not all.
    failure: Option<Error>,
}

impl Kept {
    fn tell(self) -> Result<u8, Refusal> {
        say(&self.line)?;
        self.failure.map_or(Ok(0), |error| Err(error.into()))
    }
}

/// Puts all pieces into a file that has this name for a person; the first is there. With a hint if the disk takes no more, and
/// for one who hears which nodes there are.
fn keep(
    mut pieces: Pieces,
    name: &Path,
    file: &File,
    (hint, begun): (&str, impl FnOnce(&[Node]) + 'static),
) -> Result<Kept, Error> {
    let begin = Instant::now();
    let saved = journal::mend::follow(&mut pieces, BufWriter::new(file), begun);
    if pieces.is_watched {
        // A terminal that is gone has nothing to clear.
        let _ = write!(io::stderr(), "\r\x1b[K");
    }
    let saved = saved.map_err(|error| {
        let is_full = matches!(error, journal::error::Error::Output(_));
        let hint = if is_full { hint } else { "" };
        Error::file(name, format!("{error}{hint}"))
    })?;
    let size = file.metadata().map_or(0, |file| file.len());
    let line = format!(
        "{}: {}; {:.1} s, {} messages, {} KiB\n",
        name.display(),
        pieces.end.as_deref().unwrap_or("all is there"),
        begin.elapsed().as_secs_f64(),
        saved.messages,
        size / 1024
    );
    Ok(Kept {
        line,
        failure: pieces.failure,
    })
}

/// Pieces of a recording as they come, until the robot, the person or the time ends it.
struct Pieces {
    link: Link,
    signals: SignalFd,
    until: Option<Instant>,
    piece: Vec<u8>,
    /// What of it is taken.
    taken: usize,
    bytes: u64,
    is_over: bool,
    /// Why it ended, if it was not whole.
    end: Option<String>,
    failure: Option<Error>,
    is_watched: bool,
    shown: Instant,
}

impl Pieces {
    fn of(robot: &Target, request: &[&[u8]], seconds: Option<Duration>) -> Result<Self, Error> {
        let signals = signals().map_err(|error| Error::system("signals", error))?;
        let mut link = robot.connect()?;
        link.ask(request);
        Ok(Self {
            link,
            signals,
            until: seconds.map(|seconds| Instant::now() + seconds),
            piece: Vec::new(),
            taken: 0,
            bytes: 0,
            is_over: false,
            end: None,
            failure: None,
            is_watched: io::stderr().is_terminal(),
            shown: Instant::now(),
        })
    }

    /// Waits for the first piece.
    fn wait(&mut self) -> Result<(), Error> {
        while self.taken == self.piece.len() && !self.is_over {
            self.turn();
        }
        match self.failure.take() {
            Some(error) => Err(error),
            None if self.bytes == 0 => Err(Error::Robot(format!(
                "{} has sent nothing: its trikd may be older than this program",
                self.link.name()
            ))),
            None => Ok(()),
        }
    }

    fn ends(&mut self, why: &str) {
        self.is_over = true;
        self.end = Some(why.to_owned());
    }

    /// Takes what comes next, or waits a moment for it.
    fn turn(&mut self) {
        if let Ok(Some(_)) = self.signals.read_signal() {
            return self.ends("stopped");
        }
        if self.until.is_some_and(|until| Instant::now() >= until) {
            return self.ends("the time is over");
        }
        match self.link.next() {
            Some(Message::Stream(piece)) if piece.is_empty() => self.is_over = true,
            Some(Message::Stream(piece)) => {
                self.bytes += piece.len() as u64;
                (self.piece, self.taken) = (piece, 0);
                self.show();
            }
            // On this connection nothing was asked for but a recording; errors of programs come to all.
            Some(Message::Error(text)) if self.bytes == 0 => {
                self.is_over = true;
                self.failure = Some(Error::Robot(format!("{}: {text}", self.link.name())));
            }
            Some(
                Message::Print(_)
                | Message::Error(_)
                | Message::Info(_)
                | Message::Version
                | Message::Status(_)
                | Message::Debug(_)
                | Message::Question(_),
            ) => {}
            None => {
                let also = Some(self.signals.as_fd());
                if let Err(error) = self.link.turn(ms(limits::TURN_MS), also, true) {
                    self.ends("the robot has ended it");
                    self.failure = Some(error);
                }
            }
        }
    }

    fn show(&mut self) {
        if self.is_watched && self.shown.elapsed() >= Duration::from_secs(1) {
            self.shown = Instant::now();
            // A terminal that is gone is no reason to stop.
            let _ = write!(io::stderr(), "\r{} KiB\x1b[K", self.bytes / 1024);
        }
    }
}

impl Read for Pieces {
    fn read(&mut self, out: &mut [u8]) -> io::Result<usize> {
        while self.taken == self.piece.len() {
            if self.is_over {
                return Ok(0);
            }
            self.turn();
        }
        let left = &self.piece[self.taken..];
        let count = left.len().min(out.len());
        out[..count].copy_from_slice(&left[..count]);
        self.taken += count;
        Ok(count)
    }
}
