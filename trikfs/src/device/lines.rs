//! Lines of text from the named pipe of a sensor program, and lines to it; or pictures from such a pipe.
//!
//! Owns what a line is (what a picture is, `picture` knows), and the way from nothing to a running sensor: its program is
//! started, its pipe appears, lines come. Nothing waits for that: until there are lines, there is nothing to read. How
//! programs are run, `programs` knows.

pub mod answer;
mod picture;

use super::cutter::{Cut, Cutter, fill};
use super::{Device, Got, Kind, Patience, Sink, Stream, Surroundings, chardev, device_error, fifo};
use crate::errno::Error;
use crate::limits;
use crate::programs::{Commands, Programs, Progress, Use};
use crate::stats::Counter;
use answer::Answer;
use config::description::{AnswerDescription, LinesDescription};
use nix::sys::epoll::{Epoll, EpollCreateFlags, EpollEvent, EpollFlags, EpollTimeout};
use picture::Pictures;
use std::os::fd::{AsFd, BorrowedFd};
use std::os::unix::fs::FileTypeExt;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

impl Kind for LinesDescription {
    fn open(&self, tuple_size: usize, around: &Surroundings) -> Result<Device, Error> {
        let damaged = around.damaged.clone();
        let lines = Lines::open(self, tuple_size, &around.programs, damaged)?;
        Ok(Device::Stream(Box::new(lines)))
    }

    fn open_sink(&self, around: &Surroundings) -> Result<Box<dyn Sink>, Error> {
        let answer = around.answer.clone();
        Ok(Box::new(LinesSink::open(self, around.timeout_ms, answer)?))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(true)
    }
}

/// A sensor that is read.
pub struct Lines {
    path: PathBuf,
    pipe: Option<fifo::Fifo>,
    cutter: Cutter<Units>,
    /// Becomes readable with the pipe, which may come later.
    epoll: Epoll,
    /// Given up after the pipe, so that a program is stopped when nobody reads it.
    program: Option<Use>,
}

impl Lines {
    /// Opens the pipe, or begins to start the program that makes it.
    pub fn open(
        description: &LinesDescription,
        tuple_size: usize,
        programs: &Programs,
        damaged: Arc<Counter>,
    ) -> Result<Self, Error> {
        let failed = |errno: nix::Error| Error::Device(errno as i32, "epoll".to_owned());
        let path = description.path.clone();
        let program = match &description.start {
            None => None,
            Some(start) => {
                let commands = Commands {
                    start: start.clone(),
                    stop: description.stop.clone(),
                };
                Some(programs.use_one(&commands, is_fifo(&path))?)
            }
        };
        let units = if description.are_pictures {
            Units::Pictures(Pictures::default())
        } else {
            Units::Lines(Splitter::default())
        };
        let mut lines = Self {
            path,
            pipe: None,
            cutter: Cutter::new(units, tuple_size, limits::PORT_READ_BYTES, damaged),
            epoll: Epoll::new(EpollCreateFlags::EPOLL_CLOEXEC).map_err(failed)?,
            program,
        };
        if lines.program.is_none() {
            lines.open_pipe()?;
        }
        Ok(lines)
    }

    fn open_pipe(&mut self) -> Result<(), Error> {
        let pipe = fifo::Fifo::open(&self.path)?;
        if let Some(fd) = pipe.fd() {
            let event = EpollEvent::new(EpollFlags::EPOLLIN | EpollFlags::EPOLLET, 0);
            let failed = |errno: nix::Error| Error::Device(errno as i32, "epoll".to_owned());
            self.epoll.add(fd, event).map_err(failed)?;
        }
        if let Some(program) = &self.program {
            program.saw_it();
        }
        self.pipe = Some(pipe);
        Ok(())
    }

    /// Opens the pipe if the program is up and has made it. False: not yet.
    fn is_open(&mut self) -> Result<bool, Error> {
        let Some(program) = self.program.as_ref().filter(|_| self.pipe.is_none()) else {
            return Ok(true);
        };
        match program.progress() {
            Progress::Failed(reason) => Err(Error::NoDevice(reason)),
            Progress::Starting => Ok(false),
            Progress::Up(_) if self.path.exists() => self.open_pipe().map(|()| true),
            Progress::Up(since) => {
                if since.elapsed() < Duration::from_millis(limits::LINES_APPEAR_MS) {
                    return Ok(false);
                }
                let reason = format!(
                    "{}: the program was started, but the pipe did not appear within {} s",
                    self.path.display(),
                    limits::LINES_APPEAR_MS / 1000
                );
                program.give_up(&reason);
                Err(Error::NoDevice(reason))
            }
        }
    }
}

fn is_fifo(path: &Path) -> bool {
    std::fs::metadata(path).is_ok_and(|meta| meta.file_type().is_fifo())
}

impl Stream for Lines {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        if !self.is_open()? {
            return Ok(Got::Nothing);
        }
        let Some(pipe) = &mut self.pipe else {
            return Ok(Got::Nothing);
        };
        loop {
            let got = self.cutter.read(pipe, buf)?;
            if got != Got::Nothing {
                return Ok(got);
            }
            // Take the edge off our own descriptor, then look once more.
            let mut events = [EpollEvent::empty(); 1];
            let rung = self.epoll.wait(&mut events, EpollTimeout::ZERO);
            if rung.unwrap_or(0) == 0 || self.cutter.wake_at().is_some() {
                return Ok(Got::Nothing);
            }
        }
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        Some(self.epoll.0.as_fd())
    }

    fn wake_at(&self) -> Option<Instant> {
        if self.pipe.is_none() {
            return Some(Instant::now() + Duration::from_millis(limits::LINES_LOOK_MS));
        }
        self.cutter.wake_at()
    }

    /// A program that was started for us speaks by itself; without one, somebody has to write first.
    fn is_silent(&self, open: Duration, patience: Patience) -> bool {
        match (&self.program, &self.pipe) {
            (None, Some(pipe)) => self.wake_at().is_none() && pipe.is_silent(open, patience),
            (None, None) | (Some(_), _) => self.wake_at().is_none() && open >= patience.by_itself,
        }
    }

    fn is_still_there(&self) -> bool {
        self.pipe.as_ref().is_none_or(Stream::is_still_there)
    }
}

/// What is cut out of the bytes.
enum Units {
    Lines(Splitter),
    Pictures(Pictures),
}

impl Cut for Units {
    fn cut(&mut self, input: &[u8], is_end: bool, tuple: &mut [u8]) -> (usize, bool) {
        match self {
            Self::Lines(lines) => lines.cut(input, is_end, tuple),
            Self::Pictures(pictures) => pictures.cut(input, is_end, tuple),
        }
    }

    fn take_damaged(&mut self) -> u32 {
        match self {
            Self::Lines(lines) => lines.take_damaged(),
            Self::Pictures(pictures) => pictures.take_damaged(),
        }
    }
}

/// Bytes to lines.
#[derive(Default)]
struct Splitter {
    line: Vec<u8>,
    /// The line that is coming in is no good.
    is_damaged: bool,
    damaged: u32,
}

impl Splitter {
    /// Whether the line that has just ended is to be given.
    fn is_good(&mut self) -> bool {
        let is_damaged = std::mem::take(&mut self.is_damaged);
        self.damaged += u32::from(is_damaged);
        !is_damaged
    }
}

impl Cut for Splitter {
    fn cut(&mut self, input: &[u8], is_end: bool, tuple: &mut [u8]) -> (usize, bool) {
        for (index, &byte) in input.iter().enumerate() {
            match byte {
                b'\n' => {
                    let is_good = self.is_good();
                    if is_good {
                        fill(tuple, &self.line);
                    }
                    self.line.clear();
                    if is_good {
                        return (index + 1, true);
                    }
                }
                b'\r' => {}
                b'\t' | b' '..=b'~' if self.line.len() < tuple.len() => self.line.push(byte),
                _ => self.is_damaged = true,
            }
        }
        if is_end {
            // The writer has left inside a line: the next one begins anew.
            self.is_damaged |= !self.line.is_empty();
            self.is_good();
            self.line.clear();
        }
        (input.len(), false)
    }

    fn take_damaged(&mut self) -> u32 {
        std::mem::take(&mut self.damaged)
    }
}

/// The way to a sensor program. Its pipe is opened for each line, since programs come and go.
pub struct LinesSink {
    path: PathBuf,
    timeout_ms: u32,
    /// It runs while somebody reads it.
    is_started: bool,
    expected: Option<AnswerDescription>,
    answer: Arc<Answer>,
}

impl LinesSink {
    /// Opens nothing yet.
    pub fn open(
        description: &LinesDescription,
        timeout_ms: u32,
        answer: Arc<Answer>,
    ) -> Result<Self, Error> {
        let path = description.input.clone().ok_or(Error::AccessDenied)?;
        Ok(Self {
            path,
            timeout_ms,
            is_started: description.start.is_some(),
            expected: description.answer.clone(),
            answer,
        })
    }
}

impl Sink for LinesSink {
    fn write(&mut self, tuple: &[u8], waits: bool) -> Result<(), Error> {
        let end = tuple.iter().rposition(|&byte| byte != 0);
        let text = &tuple[..end.map_or(0, |last| last + 1)];
        let text = text.strip_suffix(b"\n").unwrap_or(text);
        if !text.iter().all(|byte| matches!(byte, b'\t' | b' '..=b'~')) {
            let what = "a line for a sensor is one line of printable ASCII";
            return Err(Error::Invalid(what.to_owned()));
        }
        let not_running = |reason: &str| {
            let path = self.path.display();
            let what = format!("{path}: the sensor is not running ({reason})");
            if self.is_started {
                let advice = "keep one of its files open for reading";
                Error::NotRunning(format!("{what}: {advice}"))
            } else {
                Error::NoDevice(what)
            }
        };
        let meta = std::fs::metadata(&self.path);
        match meta.map_err(|error| device_error(&self.path, &error)) {
            Err(Error::NoDevice(_)) => return Err(not_running("its pipe is missing")),
            Err(error) => return Err(error),
            Ok(meta) if !meta.file_type().is_fifo() => {
                return Err(not_running("what is there is no named pipe"));
            }
            Ok(_) => {}
        }
        let mut sink = match chardev::CharSink::open(&self.path, self.timeout_ms) {
            Err(Error::NoDevice(_)) => return Err(not_running("nobody reads its pipe")),
            other => other?,
        };
        self.answer.forget_if_asked(self.expected.as_ref(), text);
        let mut line = text.to_vec();
        line.push(b'\n');
        sink.write(&line, waits)
    }
}

#[cfg(test)]
mod tests;
