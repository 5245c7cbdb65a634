//! A converter on trial: vectors that it must meet, and what must be true of every converter whatever bytes it gets.
//!
//! Owns the bytes that are tried and the comparisons. Knows no language and no file: it is given a function that opens
//! the converter, so that one in Lua, one in C and one in Rust are judged alike.

use crate::error::{Error, TrialFault};
use crate::limits::{TRIAL_REASONS_MAX, TRIAL_TUPLES_MAX};
use crate::vectors::{Expected, Vectors};
use crate::{Conversion, Converter, Direction, Fault, OpenInfo};
use std::collections::BTreeMap;
use std::fmt::Write;

/// One opened converter: input and output of the sizes of the opening.
pub type Opened = Box<dyn FnMut(&[u8], &mut [u8]) -> Result<Conversion, Fault>>;

/// Opens a new converter, or says why it refuses.
pub type Open<'a> = dyn FnMut() -> Result<Opened, Fault> + 'a;

/// What opens a converter in Rust, for the other functions of this module.
pub fn opener<C: Converter + 'static>(
    input_size: usize,
    output_size: usize,
    params: &BTreeMap<String, f64>,
) -> impl FnMut() -> Result<Opened, Fault> {
    let params = params.clone();
    move || {
        let info = OpenInfo {
            direction: Direction::Read,
            input_size,
            output_size,
            node: "trial",
            params: &params,
            log: &|text| println!("{text}"),
        };
        let mut converter = C::open(&info)?;
        Ok(Box::new(move |input: &[u8], output: &mut [u8]| {
            converter.convert(input, output)
        }))
    }
}

/// What a converter did with one tuple.
#[derive(Clone, PartialEq, Eq)]
enum Outcome {
    Output(Vec<u8>),
    Consumed,
    Fault(String),
}

impl Outcome {
    fn of(opened: &mut Opened, input: &[u8], output: &mut [u8]) -> Self {
        output.fill(0);
        match opened(input, output) {
            Ok(Conversion::Produced) => Self::Output(output.to_vec()),
            Ok(Conversion::Consumed) => Self::Consumed,
            Err(fault) => Self::Fault(fault.to_string()),
        }
    }

    /// As a file of vectors has it, with the text of a fault.
    fn show(&self) -> String {
        match self {
            Self::Output(bytes) => hex(bytes),
            Self::Consumed => "consumed".to_owned(),
            Self::Fault(text) => format!("fault ({text})"),
        }
    }

    /// The same number for the same outcome, and hardly ever for another.
    fn digest(&self) -> u64 {
        let (kind, bytes): (u8, &[u8]) = match self {
            Self::Output(bytes) => (0, bytes),
            Self::Consumed => (1, &[]),
            Self::Fault(text) => (2, text.as_bytes()),
        };
        // FNV-1a, 64 bits.
        let step = |hash: u64, byte: &u8| (hash ^ u64::from(*byte)).wrapping_mul(0x100_0000_01b3);
        bytes.iter().fold(step(0xcbf2_9ce4_8422_2325, &kind), step)
    }
}

/// Bytes in hexadecimal.
pub fn hex(bytes: &[u8]) -> String {
    bytes.iter().fold(String::new(), |mut text, byte| {
        let _ = write!(text, "{byte:02x}");
        text
    })
}

/// Opens the converter and gives it all vectors in order. Returns how many there were.
///
/// # Errors
/// The first vector that is not met, or why it cannot be opened.
pub fn check_vectors(vectors: &Vectors, open: &mut Open<'_>) -> Result<usize, Error> {
    let mut opened = open()?;
    let mut output = vec![0; vectors.output_size];
    for step in &vectors.steps {
        let outcome = Outcome::of(&mut opened, &step.input, &mut output);
        let expected = match &step.expected {
            Expected::Output(bytes) => hex(bytes),
            Expected::Consumed => "consumed".to_owned(),
            Expected::Fault => "fault".to_owned(),
        };
        let is_met = match (&outcome, &step.expected) {
            (Outcome::Output(got), Expected::Output(wanted)) => got == wanted,
            (Outcome::Consumed, Expected::Consumed) | (Outcome::Fault(_), Expected::Fault) => true,
            _ => false,
        };
        if !is_met {
            return Err(Error::Unmet {
                line: step.line,
                input: hex(&step.input),
                got: outcome.show(),
                expected,
            });
        }
    }
    Ok(vectors.steps.len())
}

/// What is tried with random bytes.
pub struct Trial<'a> {
    /// Bytes of an input tuple.
    pub input_size: usize,
    /// Bytes of an output tuple.
    pub output_size: usize,
    /// How many tuples; at most [`TRIAL_TUPLES_MAX`] are tried.
    pub tuples: usize,
    /// The same tuples for the same number.
    pub seed: u32,
    /// Recorded tuples, one after the other; some are tried as they are and with a few bits changed. May be empty.
    pub recorded: &'a [u8],
    /// What an output must be, for example that its floats are finite; see [`finite_f32`].
    pub check: &'a dyn Fn(&[u8]) -> Result<(), Fault>,
}

/// What became of the tuples.
#[derive(Debug, Default, PartialEq, Eq)]
pub struct Report {
    /// Tuples that gave an output.
    pub produced: usize,
    /// Tuples that were taken without one.
    pub consumed: usize,
    /// Faults by their text, the first [`TRIAL_REASONS_MAX`] texts; others are counted as `(others)`.
    pub faults: BTreeMap<String, usize>,
}

/// Bytes around an output that must not be touched.
const GUARD: usize = 64;
const GUARD_BYTE: u8 = 0xa5;

/// Gives the converter random tuples, zeros, ones, extreme and broken numbers, and recorded tuples that were damaged.
///
/// - It does not crash: that would end the program.
/// - Each output passes `check`.
/// - Nothing is written before or after an output.
/// - Opened again it does the same with the same tuples, while another opening gets other tuples in between: no state
///   is shared or left over.
///
/// # Errors
/// What was not true, of which tuple, and the seed; also a converter that refused every tuple, because then nothing was
/// tried.
pub fn check_properties(trial: &Trial<'_>, open: &mut Open<'_>) -> Result<Report, Error> {
    let failed = |why| Error::Trial {
        seed: trial.seed,
        why,
    };
    let tuples = trial.tuples.clamp(1, TRIAL_TUPLES_MAX);
    let mut report = Report::default();
    let mut digests = Vec::with_capacity(tuples);
    let mut output = vec![GUARD_BYTE; trial.output_size + 2 * GUARD];
    let (mut first, mut bytes) = (open()?, Bytes::new(trial, trial.seed));
    for number in 1..=tuples {
        let input = bytes.next_tuple();
        let inner = &mut output[GUARD..GUARD + trial.output_size];
        let outcome = Outcome::of(&mut first, &input, inner);
        let (before, rest) = output.split_at(GUARD);
        let behind = &rest[trial.output_size..];
        if before.iter().chain(behind).any(|&byte| byte != GUARD_BYTE) {
            return Err(failed(TrialFault::WroteOutside(number, hex(&input))));
        }
        digests.push(outcome.digest());
        match outcome {
            Outcome::Output(bytes) => {
                report.produced += 1;
                (trial.check)(&bytes).map_err(|why| {
                    failed(TrialFault::BadOutput {
                        tuple: number,
                        input: hex(&input),
                        output: hex(&bytes),
                        why,
                    })
                })?;
            }
            Outcome::Consumed => report.consumed += 1,
            Outcome::Fault(text) => report.count(text),
        }
    }
    repeat(trial, open, &digests)?;
    if report.produced + report.consumed == 0 {
        let reason = report.faults.keys().next().cloned();
        let reason = reason.unwrap_or_default();
        return Err(failed(TrialFault::NothingTried(tuples, reason)));
    }
    Ok(report)
}

impl Report {
    fn count(&mut self, text: String) {
        let is_new = !self.faults.contains_key(&text);
        let key = if is_new && self.faults.len() >= TRIAL_REASONS_MAX {
            "(others)".to_owned()
        } else {
            text
        };
        *self.faults.entry(key).or_default() += 1;
    }
}

/// The same tuples to a fresh opening, with another one beside it that gets different tuples.
fn repeat(trial: &Trial<'_>, open: &mut Open<'_>, digests: &[u64]) -> Result<(), Error> {
    let seed = trial.seed;
    let mut output = vec![0; trial.output_size];
    let (mut again, mut same) = (open()?, Bytes::new(trial, seed));
    let (mut beside, mut other) = (open()?, Bytes::new(trial, !seed));
    for (index, &digest) in digests.iter().enumerate() {
        let _ = beside(&other.next_tuple(), &mut output);
        let input = same.next_tuple();
        let outcome = Outcome::of(&mut again, &input, &mut output);
        if outcome.digest() != digest {
            let why = TrialFault::NotRepeated {
                tuple: index + 1,
                input: hex(&input),
                got: outcome.show(),
            };
            return Err(Error::Trial { seed, why });
        }
    }
    Ok(())
}

/// A check for [`Trial`]: the output is a row of little-endian f32, all finite.
///
/// # Errors
/// Which number is not, and what it is.
pub fn finite_f32(output: &[u8]) -> Result<(), Fault> {
    let (numbers, _) = output.as_chunks::<4>();
    for (index, &bytes) in numbers.iter().enumerate() {
        let number = f32::from_le_bytes(bytes);
        if !number.is_finite() {
            return Err(Fault::new(format!("number {index} is {number}")));
        }
    }
    Ok(())
}

/// A seed: that of the variable `SEED`, to repeat a failure, else one from the clock.
pub fn seed() -> u32 {
    let given = std::env::var("SEED")
        .ok()
        .and_then(|text| text.parse().ok());
    let clock = std::time::SystemTime::now().duration_since(std::time::UNIX_EPOCH);
    given.unwrap_or_else(|| clock.map_or(1, |time| time.subsec_nanos() ^ time.as_secs() as u32))
}

/// Where tuples come from.
struct Bytes<'a> {
    state: u32,
    size: usize,
    recorded: &'a [u8],
}

/// Numbers at which converters break, as 32-bit words: 0, 1, the ends of i16 and i32, f32's infinities, NaN and least.
const WORDS: [u32; 12] = [
    0,
    1,
    u32::MAX,
    0x7fff,
    0x8000,
    0xffff,
    0x7fff_ffff,
    0x8000_0000,
    0x7f80_0000,
    0xff80_0000,
    0x7fc0_0000,
    0x0000_0080,
];

impl<'a> Bytes<'a> {
    fn new(trial: &Trial<'a>, seed: u32) -> Self {
        let whole = trial.recorded.len() / trial.input_size * trial.input_size;
        Self {
            // A generator of this kind never leaves zero.
            state: (seed ^ 0x9e37_79b9).max(1),
            size: trial.input_size,
            recorded: &trial.recorded[..whole],
        }
    }

    /// Marsaglia's xorshift with 32 bits, its words stirred by a multiplication. Its own, so that this crate, which
    /// libraries of others link, depends on none for four lines.
    fn next(&mut self) -> u32 {
        self.state ^= self.state << 13;
        self.state ^= self.state >> 17;
        self.state ^= self.state << 5;
        self.state.wrapping_mul(0x2545_f491).rotate_left(15)
    }

    fn below(&mut self, bound: usize) -> usize {
        self.next() as usize % bound
    }

    fn next_tuple(&mut self) -> Vec<u8> {
        let mut tuple = vec![0; self.size];
        match self.below(8) {
            0 => tuple.fill(if self.below(2) == 0 { 0 } else { 0xff }),
            1 | 2 => {
                for lane in tuple.chunks_mut(4) {
                    let word = WORDS[self.below(WORDS.len())].to_le_bytes();
                    lane.copy_from_slice(&word[..lane.len()]);
                }
            }
            kind @ 3..=5 if !self.recorded.is_empty() => {
                let at = self.below(self.recorded.len() / self.size) * self.size;
                tuple.copy_from_slice(&self.recorded[at..at + self.size]);
                if kind > 3 {
                    for _ in 0..=self.below(4) {
                        let bit = self.below(8 * self.size);
                        tuple[bit / 8] ^= 1 << (bit % 8);
                    }
                }
            }
            _ => tuple.fill_with(|| self.next() as u8),
        }
        tuple
    }
}

#[cfg(test)]
mod tests;
