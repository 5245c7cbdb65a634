//! Bytes of a file, a pipe or a recording through one converter, tuple by tuple, as raw bytes, hexadecimal or text.
//!
//! Owns the forms of input and output. What is there is converted at once, so that a pipe can be watched. Knows neither
//! configuration nor language.

use super::faults::{Faults, Place};
use super::timing::Timing;
use super::{Subject, convert};
use crate::convert::Pipeline;
use crate::device::replay;
use crate::errno::Error;
use crate::failure::Failure;
use crate::limits::{CONVERT_CHUNK_BYTES, RECORDING_BYTES_MAX};
use config::format::Format;
use converter::Conversion;
use converter::Direction;
use converter::trial::hex;
use std::io::{self, Read, Write};
use std::path::Path;
use std::time::Instant;

/// How results are written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shape {
    /// The bytes themselves.
    Raw,
    /// A line in hexadecimal for each tuple.
    Hex,
    /// A line for each tuple, as the file `value` of the node would have it.
    Text,
}

/// What is wished of a run.
#[derive(Clone, Copy, Debug)]
pub struct Wishes {
    /// How results are written.
    pub shape: Shape,
    /// Go on after a refused tuple and report at the end.
    pub keep_going: bool,
    /// Measure each conversion.
    pub timing: bool,
}

/// Where bytes come from.
pub enum Input<'a> {
    /// One tuple after the other.
    Bytes(&'a mut dyn Read, String),
    /// The lines of a recording, with their times.
    Recording(std::vec::IntoIter<replay::Record>),
}

impl Input<'_> {
    /// A recording as `replay` takes it: lines of time and hexadecimal bytes.
    ///
    /// # Errors
    /// The file with the line and what is wrong with it.
    pub fn recording(text: &mut dyn Read, name: &Path) -> Result<Self, Failure> {
        let mut read = String::new();
        let failed = |error: io::Error| Failure::file(name, error);
        text.take(RECORDING_BYTES_MAX as u64 + 1)
            .read_to_string(&mut read)
            .map_err(failed)?;
        if read.len() > RECORDING_BYTES_MAX {
            let why = format!("a recording may have {RECORDING_BYTES_MAX} bytes");
            return Err(Failure::file(name, why));
        }
        let records = replay::parse(name, &read);
        let records = records.map_err(|why| Failure::Refused(why.to_string()))?;
        Ok(Self::Recording(records.into_iter()))
    }

    /// Appends what comes next. None at the end, else the time of a recording's line in us.
    fn more(&mut self, pending: &mut Vec<u8>) -> Result<Option<Option<u32>>, Failure> {
        match self {
            Self::Recording(records) => Ok(records.next().map(|record| {
                pending.extend(record.bytes);
                Some(record.time_us)
            })),
            Self::Bytes(input, name) => {
                let start = pending.len();
                pending.resize(start + CONVERT_CHUNK_BYTES, 0);
                let got = loop {
                    match input.read(&mut pending[start..]) {
                        Err(error) if error.kind() == io::ErrorKind::Interrupted => {}
                        other => {
                            break other
                                .map_err(|error| Failure::file(Path::new(&*name), error))?;
                        }
                    }
                };
                pending.truncate(start + got);
                Ok((got > 0).then_some(None))
            }
        }
    }
}

/// Why a run ended before its input.
enum Stop {
    Failed(Failure),
    /// Nobody reads the output any more.
    Enough,
}

impl From<Failure> for Stop {
    fn from(failure: Failure) -> Self {
        Self::Failed(failure)
    }
}

impl From<io::Error> for Stop {
    fn from(error: io::Error) -> Self {
        match error.kind() {
            io::ErrorKind::BrokenPipe => Self::Enough,
            _ => Self::Failed(Failure::system("standard output", error)),
        }
    }
}

/// Runs the input through a fresh opening of the converter. Returns lines for standard error: that nothing came out of
/// a converter that took everything, and the time, if it was asked for.
///
/// # Errors
/// The refused tuples with their places, or what could not be read or written. The lines come with it.
pub fn run(
    subject: &Subject,
    wishes: Wishes,
    input: &mut Input<'_>,
    output: &mut dyn Write,
) -> (Vec<String>, Result<(), Failure>) {
    let node = subject.description().path.clone();
    let mut run = match Run::new(subject, wishes) {
        Ok(run) => run,
        Err(failure) => return (Vec::new(), Err(failure)),
    };
    let ended = run.all(input, output);
    let mut lines = Vec::new();
    if run.tuples > 0 && run.consumed == run.tuples {
        // Silence would look like a failure.
        let tuples = if run.tuples == 1 { "tuple" } else { "tuples" };
        lines.push(format!(
            "node {node}: {} {tuples} taken, no output yet",
            run.tuples
        ));
    }
    if let Some(timing) = &run.timing {
        lines.push(format!("node {node}: {}", timing.render()));
    }
    let faults = run.faults.render(run.tuples);
    let result = match ended {
        Ok(()) => faults.map_or(Ok(()), |faults| Err(Failure::Converter(faults))),
        Err(Stop::Enough) => Ok(()),
        // What was refused before is told as well.
        Err(Stop::Failed(failure)) => Err(match faults {
            Some(faults) => Failure::Converter(format!("{faults}\n  {failure}")),
            None => failure,
        }),
    };
    (
        lines,
        result.map_err(|failure| failure.at(format!("node {node}"))),
    )
}

struct Run<'a> {
    pipeline: Pipeline,
    direction: Direction,
    wishes: Wishes,
    format: &'a Format,
    input_size: usize,
    converted: Vec<u8>,
    line: String,
    tuples: u64,
    /// Those of them that gave no result.
    consumed: u64,
    faults: Faults,
    timing: Option<Timing>,
}

impl<'a> Run<'a> {
    fn new(subject: &'a Subject, wishes: Wishes) -> Result<Self, Failure> {
        let (input_size, output_size) = subject.sizes();
        Ok(Self {
            pipeline: subject
                .open()
                .map_err(|error| Failure::Opening(error.to_string()))?,
            direction: subject.direction,
            wishes,
            format: &subject.format,
            input_size,
            converted: vec![0; output_size],
            line: String::new(),
            tuples: 0,
            consumed: 0,
            faults: Faults::default(),
            timing: wishes.timing.then(Timing::default),
        })
    }

    fn all(&mut self, input: &mut Input<'_>, output: &mut dyn Write) -> Result<(), Stop> {
        let mut output = io::BufWriter::new(output);
        let mut pending = Vec::new();
        while let Some(time_us) = input.more(&mut pending)? {
            let whole = pending.len() / self.input_size * self.input_size;
            for tuple in pending[..whole].chunks_exact(self.input_size) {
                if let Err(stop) = self.one(tuple, time_us, &mut output) {
                    // What came before it counts.
                    output.flush()?;
                    return Err(stop);
                }
            }
            pending.drain(..whole);
            output.flush()?;
        }
        if pending.is_empty() {
            return Ok(());
        }
        Err(Stop::Failed(Failure::Refused(format!(
            "the input ends {} bytes into a tuple of {}",
            pending.len(),
            self.input_size
        ))))
    }

    fn one(
        &mut self,
        tuple: &[u8],
        time_us: Option<u32>,
        output: &mut dyn Write,
    ) -> Result<(), Stop> {
        let place = Place {
            number: self.tuples + 1,
            offset: self.tuples * self.input_size as u64,
            bytes: tuple,
        };
        self.tuples += 1;
        let start = self.timing.is_some().then(Instant::now);
        let outcome = convert(
            &mut self.pipeline,
            self.direction,
            tuple,
            &mut self.converted,
        );
        if let (Some(timing), Some(start)) = (&mut self.timing, start) {
            timing.add(start.elapsed());
        }
        match outcome.and_then(|conversion| self.render(conversion, time_us)) {
            Ok(false) => Ok(()),
            Ok(true) if self.wishes.shape == Shape::Raw => Ok(output.write_all(&self.converted)?),
            Ok(true) => Ok(output.write_all(self.line.as_bytes())?),
            Err(error) if self.wishes.keep_going => {
                self.faults.add(place, error.to_string());
                Ok(())
            }
            Err(error) => {
                let why = format!("{}: {error}", place.show());
                Err(Stop::Failed(Failure::Converter(why)))
            }
        }
    }

    /// Puts the line of a result together; false if there is no result.
    fn render(&mut self, conversion: Conversion, time_us: Option<u32>) -> Result<bool, Error> {
        if conversion == Conversion::Consumed {
            self.consumed += 1;
            return Ok(false);
        }
        self.line.clear();
        if let Some(time_us) = time_us {
            self.line
                .push_str(&format!("{} ", f64::from(time_us) / 1e3));
        }
        match self.wishes.shape {
            Shape::Raw => return Ok(true),
            Shape::Hex => self.line.push_str(&hex(&self.converted)),
            Shape::Text => self
                .format
                .render(&self.converted, &mut self.line)
                .map_err(|why| Error::Converter(why.to_string()))?,
        }
        self.line.push('\n');
        Ok(true)
    }
}
