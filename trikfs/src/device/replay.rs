//! Recorded bytes, given out again with the timing they were recorded with.
//!
//! Owns the format of a recording: lines `TIME_MS HEX`, times from the start and never falling, `#` to the end of
//! a line is a comment. `trikfs` reads such files; anything can write them.

use super::{Device, Got, Kind, Stream, Surroundings, device_error};
use crate::errno::Error;
use crate::limits;
use config::description::ReplayDescription;
use std::fmt;
use std::io::Read;
use std::os::fd::BorrowedFd;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

impl Kind for ReplayDescription {
    fn open(&self, _tuple_size: usize, _around: &Surroundings) -> Result<Device, Error> {
        Ok(Device::Stream(Box::new(Replay::open(self)?)))
    }

    fn is_shared(&self) -> Result<bool, Error> {
        Ok(true)
    }
}

/// A recording that runs.
pub struct Replay {
    records: Vec<Record>,
    at: usize,
    start: Instant,
    speed: f64,
    repeat: bool,
    offset: usize,
}

/// One line of a recording.
#[derive(Debug, PartialEq, Eq)]
pub struct Record {
    /// From the start.
    pub time_us: u32,
    /// What came then, no whole tuples necessarily.
    pub bytes: Vec<u8>,
}

/// A line of a recording that is none; the author of the recording has to act.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct BadRecording {
    path: PathBuf,
    /// From 1.
    line: usize,
    why: BadLine,
}

/// What is wrong with a line of a recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum BadLine {
    Form,
    Time,
    Range,
    Falls,
    Bytes,
    Odd,
}

impl fmt::Display for BadRecording {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let what = match self.why {
            BadLine::Form => "expected a time in ms and bytes in hex",
            BadLine::Time => "the time is not a number of ms",
            BadLine::Range => "the time is out of range",
            BadLine::Falls => "the time falls",
            BadLine::Bytes => "the bytes are not hex",
            BadLine::Odd => "an odd number of hex digits",
        };
        write!(f, "{}:{}: {what}", self.path.display(), self.line)
    }
}

impl std::error::Error for BadRecording {}

impl Replay {
    /// Reads the whole recording (at most [`limits::RECORDING_BYTES_MAX`]); its time starts now.
    pub fn open(description: &ReplayDescription) -> Result<Self, Error> {
        let path = &description.path;
        let file = std::fs::File::open(path).map_err(|error| device_error(path, &error))?;
        let mut text = String::new();
        let limit = limits::RECORDING_BYTES_MAX as u64;
        let read = file.take(limit + 1).read_to_string(&mut text);
        read.map_err(|error| Error::of_system(path.display().to_string(), &error))?;
        if text.len() as u64 > limit {
            return Err(Error::NoDevice(format!(
                "{}: a recording may have {limit} bytes",
                path.display()
            )));
        }
        let records = parse(path, &text).map_err(|why| Error::NoDevice(why.to_string()))?;
        Ok(Self {
            records,
            at: 0,
            start: Instant::now(),
            speed: description.speed,
            repeat: description.repeat,
            offset: 0,
        })
    }

    fn due(&self) -> Option<Instant> {
        let record = self.records.get(self.at)?;
        let after = f64::from(record.time_us) / 1e6 / self.speed;
        Some(self.start + Duration::try_from_secs_f64(after).unwrap_or(Duration::MAX / 4))
    }
}

/// The lines of a recording; `path` is for messages.
///
/// # Errors
/// The first line that is none, with its number.
pub fn parse(path: &Path, text: &str) -> Result<Vec<Record>, BadRecording> {
    let mut records: Vec<Record> = Vec::new();
    for (index, line) in text.lines().enumerate() {
        let bad = |why| BadRecording {
            path: path.to_owned(),
            line: index + 1,
            why,
        };
        let line = line.split('#').next().unwrap_or("").trim();
        let Some((time, hex)) = line.split_once(char::is_whitespace) else {
            if line.is_empty() {
                continue;
            }
            return Err(bad(BadLine::Form));
        };
        let time_ms: f64 = time.parse().map_err(|_| bad(BadLine::Time))?;
        if !(0.0..=f64::from(u32::MAX / 1000)).contains(&time_ms) {
            return Err(bad(BadLine::Range));
        }
        #[allow(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "the range was checked above"
        )]
        let time_us = (time_ms * 1000.0) as u32;
        if records.last().is_some_and(|last| last.time_us > time_us) {
            return Err(bad(BadLine::Falls));
        }
        let digits: Vec<u32> = hex
            .chars()
            .filter(|c| !c.is_whitespace())
            .map(|c| c.to_digit(16))
            .collect::<Option<_>>()
            .ok_or_else(|| bad(BadLine::Bytes))?;
        if !digits.len().is_multiple_of(2) {
            return Err(bad(BadLine::Odd));
        }
        #[allow(clippy::cast_possible_truncation, reason = "two hex digits are a byte")]
        let bytes = digits
            .chunks(2)
            .map(|pair| (pair[0] * 16 + pair[1]) as u8)
            .collect();
        records.push(Record { time_us, bytes });
    }
    Ok(records)
}

impl Stream for Replay {
    fn read(&mut self, buf: &mut [u8]) -> Result<Got, Error> {
        loop {
            let Some(due) = self.due() else {
                if !self.repeat || self.records.iter().all(|record| record.bytes.is_empty()) {
                    return Ok(Got::End);
                }
                self.start = Instant::now();
                self.at = 0;
                continue;
            };
            if Instant::now() < due {
                return Ok(Got::Nothing);
            }
            let rest = &self.records[self.at].bytes[self.offset..];
            let n = rest.len().min(buf.len());
            buf[..n].copy_from_slice(&rest[..n]);
            self.offset += n;
            if self.offset == self.records[self.at].bytes.len() {
                self.at += 1;
                self.offset = 0;
            }
            if n > 0 {
                return Ok(Got::Bytes(n));
            }
        }
    }

    fn fd(&self) -> Option<BorrowedFd<'_>> {
        None
    }

    fn wake_at(&self) -> Option<Instant> {
        self.due()
    }

    fn begins_anew(&self) -> bool {
        false
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_are_times_and_bytes() {
        let records = parse(Path::new("r"), "# a run\n0 0102\n\n1.5 ff 00 # late\n").unwrap();
        assert_eq!(records.len(), 2);
        assert_eq!(
            records[1],
            Record {
                time_us: 1500,
                bytes: vec![0xff, 0]
            }
        );
    }

    #[test]
    fn rubbish_is_refused_with_its_line() {
        for (text, reason) in [
            ("0 01\n5", "r:2: expected a time in ms and bytes in hex"),
            ("x 01", "r:1: the time is not a number of ms"),
            ("-1 01", "r:1: the time is out of range"),
            ("nan 01", "r:1: the time is out of range"),
            ("2 01\n1 02", "r:2: the time falls"),
            ("0 0g", "r:1: the bytes are not hex"),
            ("0 012", "r:1: an odd number of hex digits"),
        ] {
            assert_eq!(
                parse(Path::new("r"), text).map_err(|why| why.to_string()),
                Err(reason.to_owned()),
                "{text}"
            );
        }
    }
}
