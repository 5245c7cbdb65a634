//! Faults that are put into devices at run time: which there are, what a text asks for, what is in force.
//!
//! A text has one fault in each line: a kind and, for some kinds, a number. Owns the table of devices and kinds; what a
//! fault does to its device is decided where the device is.

mod words;

use crate::limits::{MAX_NOISE, MAX_SAG_V, MAX_SLOW_MS};
use lang_text::problem::Words;
use std::fmt;

/// Index of the coprocessor.
pub const MSP430: usize = 0;
/// Index of bus 1; bus 2 follows.
pub const I2C: usize = 1;
/// Index of the accelerometer.
pub const ACCELEROMETER: usize = 3;
/// Index of the gyroscope.
pub const GYROSCOPE: usize = 4;
/// Index of the camera.
pub const CAMERA: usize = 5;
/// Index of the lidar.
pub const LIDAR: usize = 6;
/// Index of the battery.
pub const BATTERY: usize = 7;
/// Index of A1; the others follow.
pub const ANALOG: usize = 8;
/// Index of D1; the others follow.
pub const DIGITAL: usize = 14;
/// Index of E1; the others follow.
pub const ENCODER: usize = 17;
/// Index of M1; the others follow.
pub const MOTOR: usize = 21;
const COUNT: usize = 25;

const NAMES: [&str; COUNT] = [
    "msp430",
    "i2c-1",
    "i2c-2",
    "accelerometer",
    "gyroscope",
    "camera",
    "lidar",
    "battery",
    "A1",
    "A2",
    "A3",
    "A4",
    "A5",
    "A6",
    "D1",
    "D2",
    "D3",
    "E1",
    "E2",
    "E3",
    "E4",
    "M1",
    "M2",
    "M3",
    "M4",
];

/// Why a text is refused. Its author can change that.
#[derive(Debug, Clone, PartialEq)]
pub enum Refusal {
    /// It is no short text.
    NoText,
    /// No device has this name.
    NoDevice(String),
    /// A line of more than two words.
    TooManyWords(String),
    /// A kind that the device cannot have, and those that it can have.
    NoKind(String, &'static [&'static str]),
    /// A kind without the number that it needs, and the greatest one.
    NeedsNumber(String, f64),
    /// A kind with a number that it has not.
    HasNoNumber(String),
    /// A word instead of a number.
    NotNumber(String),
    /// A number beyond its bounds: the kind, the word, the greatest one.
    OutOfRange(String, String, f64),
}

impl fmt::Display for Refusal {
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NoText => out.write_str("is no short text"),
            Self::NoDevice(name) => {
                write!(out, "there is no device '{name}' on this board; there are")?;
                NAMES.iter().try_for_each(|name| write!(out, " {name}"))
            }
            Self::TooManyWords(line) => write!(
                out,
                "'{line}' has too many words; write a kind and at most one number"
            ),
            Self::NoKind(kind, kinds) => write!(
                out,
                "there is no fault '{kind}' here; possible are {}",
                kinds.join(", ")
            ),
            Self::NeedsNumber(kind, most) => {
                write!(out, "'{kind}' needs a number from 0 to {most}")
            }
            Self::HasNoNumber(kind) => write!(out, "'{kind}' has no number"),
            Self::NotNumber(word) => write!(out, "'{word}' is no number"),
            Self::OutOfRange(kind, word, most) => {
                write!(out, "{kind} {word} is not between 0 and {most}")
            }
        }
    }
}

impl Refusal {
    /// For a person.
    pub fn words(&self) -> Words {
        Words::new(self.to_string(), words::russian(self))
    }
}

impl std::error::Error for Refusal {}

/// What is wrong with one device.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Fault {
    /// It is not there.
    pub unplug: bool,
    /// It does not change any more.
    pub stuck: bool,
    /// Probability that it does not acknowledge.
    pub nack: f64,
    /// It takes so much longer.
    pub slow_ms: u32,
    /// Amplitude of what is added to its values, in its own unit.
    pub noise: f64,
    /// Probability that a sample or an answer is lost.
    pub drop: f64,
    /// It gives random bytes.
    pub garbage: bool,
    /// A battery gives so much less.
    pub sag_v: f64,
}

impl Fault {
    /// Both together, as for a device on a bus.
    pub fn with(self, other: Self) -> Self {
        Self {
            unplug: self.unplug || other.unplug,
            stuck: self.stuck || other.stuck,
            nack: self.nack.max(other.nack),
            slow_ms: self.slow_ms.saturating_add(other.slow_ms),
            noise: self.noise + other.noise,
            drop: self.drop.max(other.drop),
            garbage: self.garbage || other.garbage,
            sag_v: self.sag_v.max(other.sag_v),
        }
    }

    /// From a text; `kinds` are those that the device can have.
    pub fn parse(text: &str, kinds: &'static [&'static str]) -> Result<Self, Refusal> {
        let mut fault = Self::default();
        for line in text.lines().map(str::trim).filter(|line| !line.is_empty()) {
            let mut words = line.split_whitespace();
            let kind = words.next().unwrap_or_default();
            let number = words.next();
            if words.next().is_some() {
                return Err(Refusal::TooManyWords(line.to_owned()));
            }
            if !kinds.contains(&kind) {
                return Err(Refusal::NoKind(kind.to_owned(), kinds));
            }
            fault.add(kind, number)?;
        }
        Ok(fault)
    }

    fn add(&mut self, kind: &str, number: Option<&str>) -> Result<(), Refusal> {
        let value = |default: Option<f64>, most: f64| -> Result<f64, Refusal> {
            let Some(text) = number else {
                return default.ok_or_else(|| Refusal::NeedsNumber(kind.to_owned(), most));
            };
            let value: f64 = text
                .parse()
                .map_err(|_| Refusal::NotNumber(text.to_owned()))?;
            if (0.0..=most).contains(&value) {
                Ok(value)
            } else {
                Err(Refusal::OutOfRange(kind.to_owned(), text.to_owned(), most))
            }
        };
        match kind {
            "nack" => self.nack = value(Some(1.0), 1.0)?,
            "slow" => self.slow_ms = value(None, f64::from(MAX_SLOW_MS))? as u32,
            "noise" => self.noise = value(None, MAX_NOISE)?,
            "drop" => self.drop = value(None, 1.0)?,
            "sag" => self.sag_v = value(None, MAX_SAG_V)?,
            _ if number.is_some() => return Err(Refusal::HasNoNumber(kind.to_owned())),
            "unplug" => self.unplug = true,
            "stuck" => self.stuck = true,
            _ => self.garbage = true,
        }
        Ok(())
    }
}

impl fmt::Display for Fault {
    /// As a person would tell it, its parts with commas between them; nothing is wrong: nothing.
    fn fmt(&self, out: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut words: Vec<String> = Vec::new();
        let flags = [
            (self.unplug, "unplug"),
            (self.stuck, "stuck"),
            (self.garbage, "garbage"),
        ];
        words.extend(flags.iter().filter(|one| one.0).map(|one| one.1.to_owned()));
        let numbers = [
            ("nack", self.nack),
            ("slow", f64::from(self.slow_ms)),
            ("noise", self.noise),
            ("drop", self.drop),
            ("sag", self.sag_v),
        ];
        let told = numbers.iter().filter(|one| one.1 != 0.0);
        words.extend(told.map(|(kind, number)| format!("{kind} {number}")));
        out.write_str(&words.join(", "))
    }
}

/// The faults of all devices.
#[derive(Debug, Clone, Copy)]
pub struct Faults([Fault; COUNT]);

impl Default for Faults {
    fn default() -> Self {
        Self([Fault::default(); COUNT])
    }
}

impl std::ops::Index<usize> for Faults {
    type Output = Fault;

    fn index(&self, index: usize) -> &Fault {
        &self.0[index]
    }
}

impl Faults {
    /// Puts the faults of `text` into the device `name`; an empty text makes it whole.
    pub fn set(&mut self, name: &str, text: &str) -> Result<(), Refusal> {
        let Some(index) = NAMES.iter().position(|other| *other == name) else {
            return Err(Refusal::NoDevice(name.to_owned()));
        };
        self.0[index] = Fault::parse(text, kinds(index))?;
        Ok(())
    }

    /// Devices that are not whole, and what is wrong with each.
    pub fn in_force(&self) -> impl Iterator<Item = (&'static str, String)> {
        let all = NAMES.iter().zip(&self.0);
        all.filter(|(_, fault)| **fault != Fault::default())
            .map(|(name, fault)| (*name, fault.to_string()))
    }
}

/// All devices by their names, with the kinds of faults that each can have.
pub fn devices() -> impl Iterator<Item = (&'static str, &'static [&'static str])> {
    let names = NAMES.iter().enumerate();
    names.map(|(index, name)| (*name, kinds(index)))
}

/// What the device of this index can have.
fn kinds(index: usize) -> &'static [&'static str] {
    match index {
        MSP430 => &[
            "unplug", "stuck", "nack", "slow", "noise", "drop", "garbage",
        ],
        1..=2 => &["unplug", "stuck", "nack", "slow", "drop", "garbage"],
        ACCELEROMETER | GYROSCOPE | CAMERA | LIDAR => {
            &["unplug", "stuck", "slow", "noise", "drop", "garbage"]
        }
        DIGITAL..ENCODER => &["unplug", "stuck", "slow", "noise", "drop", "garbage"],
        BATTERY => &["unplug", "stuck", "noise", "drop", "garbage", "sag"],
        MOTOR.. => &["unplug", "stuck", "noise"],
        _ => &["unplug", "stuck", "noise", "drop", "garbage"],
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_text_may_hold_several_faults() {
        let mut faults = Faults::default();
        faults.set("msp430", "nack 0.25\n\n slow 40 \n").unwrap();
        let expected = Fault {
            nack: 0.25,
            slow_ms: 40,
            ..Fault::default()
        };
        assert_eq!(faults[MSP430], expected);
        faults.set("msp430", "").unwrap();
        assert_eq!(faults[MSP430], Fault::default());
        faults.set("M4", "unplug").unwrap();
        assert!(faults[MOTOR + 3].unplug);
        faults.set("battery", "sag 2.5").unwrap();
        assert_eq!(faults[BATTERY].sag_v, 2.5);
        faults.set("D3", "noise 3").unwrap();
        assert_eq!(faults[DIGITAL + 2].noise, 3.0);
    }

    #[test]
    fn what_cannot_be_is_refused_and_changes_nothing() {
        let mut faults = Faults::default();
        faults.set("A1", "stuck").unwrap();
        for (name, text, reason) in [
            ("A7", "stuck", "there is no device 'A7' on this board"),
            (
                "A1",
                "nack",
                "there is no fault 'nack' here; possible are unplug, stuck, noise, drop, garbage",
            ),
            ("A1", "noise", "'noise' needs a number from 0 to 1000000"),
            ("A1", "noise lots", "'lots' is no number"),
            ("A1", "noise NaN", "noise NaN is not between 0 and 1000000"),
            ("A1", "drop 1.5", "drop 1.5 is not between 0 and 1"),
            ("A1", "stuck 3", "'stuck' has no number"),
            (
                "A1",
                "drop 1 2",
                "'drop 1 2' has too many words; write a kind and at most one number",
            ),
        ] {
            let got = faults.set(name, text).unwrap_err().to_string();
            assert!(got.starts_with(reason), "{got}");
        }
        assert!(faults[ANALOG].stuck);
    }

    /// Rows of the table in the manual: names in backquotes, then kinds.
    #[test]
    fn the_manual_names_every_device_and_its_faults() {
        let manual = include_str!("../../docs/user/simulator.md");
        let mut told: Vec<(&str, &str)> = Vec::new();
        for line in manual.lines().filter(|line| line.starts_with("| `")) {
            let mut cells = line.trim_matches('|').split('|').map(str::trim);
            let (names, kinds) = (cells.next().unwrap(), cells.next().unwrap());
            if kinds.starts_with("unplug stuck") {
                told.extend(
                    names
                        .split(", ")
                        .map(|name| (name.trim_matches('`'), kinds)),
                );
            }
        }
        told.sort_unstable();
        let mut real: Vec<(&str, String)> = devices()
            .map(|(name, kinds)| (name, kinds.join(" ")))
            .collect();
        real.sort_unstable();
        let real: Vec<(&str, &str)> = real.iter().map(|(name, kinds)| (*name, &**kinds)).collect();
        assert_eq!(told, real);
    }

    #[test]
    fn the_indices_are_those_of_the_names() {
        for (index, name) in [
            (MSP430, "msp430"),
            (I2C + 1, "i2c-2"),
            (BATTERY, "battery"),
            (ANALOG, "A1"),
            (DIGITAL, "D1"),
            (ENCODER, "E1"),
            (MOTOR, "M1"),
        ] {
            assert_eq!(NAMES[index], name);
        }
    }
}
