//! A converter in machine code that is opened for one file and direction, with its state in the process of its node.
//!
//! Owns where that state is, what is asked of it, and what its caller is told when the process is lost. When another process is
//! started is known to `isolated`.

use super::memory::Shared;
use super::process::Lost;
use super::words::{Many, One, Opened, Request};
use super::{Apart, Life, Place};
use crate::convert::shared::OpenInfo;
use crate::errno::Error;
use crate::events::lock;
use crate::failure::Blame;
use crate::limits::{ISOLATED_BYTES, ISOLATED_LOG_LINES, ISOLATED_TUPLE_BYTES, ISOLATED_TUPLES};
use converter::{Conversion, Direction, Fault};
use std::collections::BTreeMap;
use std::sync::Arc;
use std::sync::atomic::Ordering;

impl Apart {
    /// Makes the converter's state for one open file and direction.
    ///
    /// # Errors
    /// The converter's own refusal, in its words, or what has become of its process.
    pub fn open(&self, info: &OpenInfo<'_>) -> Result<IsolatedStage, Error> {
        let mut stage = IsolatedStage {
            apart: self.clone(),
            direction: info.direction,
            input_size: info.input_size,
            output_size: info.output_size,
            params: info.params.clone(),
            log: Arc::clone(&info.log),
            place: None,
        };
        let apart = self.clone();
        stage.placed(&mut lock(&apart.process.life))?;
        Ok(stage)
    }
}

/// A native converter opened for one file and direction, in another process; dropping it closes it.
pub struct IsolatedStage {
    apart: Apart,
    direction: Direction,
    input_size: usize,
    output_size: usize,
    params: BTreeMap<String, f64>,
    log: Arc<dyn Fn(&str) + Send + Sync>,
    place: Option<Place>,
}

impl IsolatedStage {
    /// As `NativeStage::convert`; a process that dies of the tuple, or does not answer, is a fault as well.
    ///
    /// # Errors
    /// The fault in the converter's words, or what has become of its process, after the library's name.
    pub fn convert(&mut self, input: &[u8], output: &mut [u8]) -> Result<Conversion, Error> {
        if input.len().max(output.len()) > ISOLATED_TUPLE_BYTES {
            let (_, made, fault) = self.convert_many(input, output);
            return match fault {
                Some(fault) => Err(fault),
                None if made > 0 => Ok(Conversion::Produced),
                None => Ok(Conversion::Consumed),
            };
        }
        let process = Arc::clone(&self.apart.process);
        let mut life = lock(&process.life);
        let outcome = self.convert_in(&mut life, input, output);
        process.end_if_over(&mut life);
        outcome
    }

    /// One tuple that fits into a message.
    fn convert_in(
        &mut self,
        life: &mut Life,
        input: &[u8],
        output: &mut [u8],
    ) -> Result<Conversion, Error> {
        let instance = self.placed(life)?;
        let request = Request::One {
            instance,
            tuple: input,
        };
        let lost = match life.ask(&request, self.apart.process.patience, false) {
            Ok(One::Consumed) => return Ok(Conversion::Consumed),
            Ok(One::Produced(made)) if made.len() == output.len() => {
                output.copy_from_slice(made);
                return Ok(Conversion::Produced);
            }
            Ok(One::Produced(_)) => Lost::Rubbish,
            Ok(One::Fault(why)) => return Err(said(why)),
            Err(lost) => lost,
        };
        Err(self.lost(life, &lost))
    }

    /// As `NativeStage::convert_many`. Of a batch in which the process dies, what was converted before counts.
    pub fn convert_many(
        &mut self,
        input: &[u8],
        output: &mut [u8],
    ) -> (usize, usize, Option<Error>) {
        let (mut taken, mut made) = (0, 0);
        loop {
            let from = &input[taken * self.input_size..];
            let to = &mut output[made * self.output_size..];
            if from.len() < self.input_size || to.len() < self.output_size {
                return (taken, made, None);
            }
            let is_one = from.len() < 2 * self.input_size
                && self.input_size.max(self.output_size) <= ISOLATED_TUPLE_BYTES;
            let (newly_taken, newly_made, fault) = if is_one {
                match self.convert(&from[..self.input_size], &mut to[..self.output_size]) {
                    Ok(Conversion::Produced) => (1, 1, None),
                    Ok(Conversion::Consumed) => (1, 0, None),
                    Err(fault) => (1, 0, Some(fault)),
                }
            } else {
                self.batch(from, to)
            };
            taken += newly_taken;
            made += newly_made;
            if fault.is_some() {
                return (taken, made, fault);
            }
        }
    }

    /// As many whole tuples as the shared memory holds, and at least one.
    fn batch(&mut self, input: &[u8], output: &mut [u8]) -> (usize, usize, Option<Error>) {
        let fitting = |bytes: usize, size: usize| {
            let most = bytes.min(ISOLATED_BYTES) / size;
            most.min(ISOLATED_TUPLES)
        };
        let tuples = fitting(input.len(), self.input_size);
        let room = fitting(output.len(), self.output_size);
        let input = &input[..tuples * self.input_size];
        let output = &mut output[..room * self.output_size];
        let process = Arc::clone(&self.apart.process);
        let mut life = lock(&process.life);
        let outcome = self.batch_in(&mut life, input, output);
        process.end_if_over(&mut life);
        outcome
    }

    /// What fits into the shared memory.
    fn batch_in(
        &mut self,
        life: &mut Life,
        input: &[u8],
        output: &mut [u8],
    ) -> (usize, usize, Option<Error>) {
        let tuples = input.len() / self.input_size;
        let room = output.len() / self.output_size;
        let instance = match self.placed(life) {
            Ok(instance) => instance,
            Err(fault) => return (1, 0, Some(fault)),
        };
        let word = |number| u32::try_from(number).unwrap_or(u32::MAX);
        let request = Request::Many {
            instance,
            input_bytes: word(input.len()),
            output_bytes: word(output.len()),
        };
        if let Some(shared) = life.shared() {
            shared.put_input(input);
        }
        let counts = |taken: usize, made: usize| {
            (taken <= tuples && made <= room && made <= taken).then_some((taken, made))
        };
        let lost = match life.ask(&request, self.apart.process.patience, true) {
            Ok(Many { taken, made, fault }) => match counts(taken as usize, made as usize) {
                // A batch without a fault ends where the tuples or the room do.
                Some((taken, made)) if fault.is_some() || taken == tuples || made == room => {
                    life.take_output(&mut output[..made * self.output_size]);
                    return (taken, made, fault.map(said));
                }
                Some(_) | None => Lost::Rubbish,
            },
            Err(lost) => lost,
        };
        // What was whole before stays; the tuple after those that were taken is the one that it died of.
        let told = life.shared().map(Shared::progress);
        let (taken, made) = told
            .and_then(|(taken, made)| counts(taken, made))
            .unwrap_or((0, 0));
        life.take_output(&mut output[..made * self.output_size]);
        let fault = self.lost(life, &lost);
        ((taken + 1).min(tuples), made, Some(fault))
    }

    /// The number of its state in the present process, which is started if there is none.
    fn placed(&mut self, life: &mut Life) -> Result<u32, Error> {
        if self.apart.process.is_over.load(Ordering::SeqCst) {
            return Err(Error::Stale);
        }
        if !lock(&self.apart.process.left).is_empty() {
            self.apart.process.leave(life);
        }
        let started = life.start();
        started.map_err(|refused| self.failure(refused.blame, &refused))?;
        if let Some((generation, instance)) = self.place
            && generation == life.generation
        {
            return Ok(instance);
        }
        let request = Request::Open {
            library: self.apart.library,
            direction: self.direction,
            input_size: u32::try_from(self.input_size).unwrap_or(u32::MAX),
            output_size: u32::try_from(self.output_size).unwrap_or(u32::MAX),
            node: self.apart.process.node.clone(),
            params: self.params.clone(),
        };
        let lost = match life.ask(&request, self.apart.process.patience, false) {
            Ok(Opened::Done { instance, log }) => {
                self.place = Some((life.generation, instance));
                for line in log.iter().take(ISOLATED_LOG_LINES) {
                    (self.log)(line);
                }
                return Ok(instance);
            }
            Ok(Opened::Fault(why)) => return Err(Error::Converter(why)),
            Err(lost) => lost,
        };
        Err(self.lost(life, &lost))
    }

    /// The process is gone, as this caller is told.
    fn lost(&self, life: &mut Life, lost: &Lost) -> Error {
        life.forget(lost);
        let why = format_args!("{lost}, and its states begin anew");
        self.failure(lost.blame(), &why)
    }

    fn failure(&self, blame: Blame, why: &dyn std::fmt::Display) -> Error {
        let text = format!("{}: {why}", self.apart.label);
        match blame {
            Blame::Machine => Error::System(text),
            Blame::Person | Blame::Configuration | Blame::Converter | Blame::Ours => {
                Error::Converter(text)
            }
        }
    }
}

impl Drop for IsolatedStage {
    fn drop(&mut self) {
        let Some(place) = self.place else { return };
        lock(&self.apart.process.left).push(place);
        // Nobody waits for a busy converter in order to close a file: the next tuple of another one does it.
        if let Ok(mut life) = self.apart.process.life.try_lock() {
            self.apart.process.leave(&mut life);
        }
    }
}

/// What a converter said there.
fn said(why: String) -> Error {
    Error::of_converter(&Fault::new(why))
}
