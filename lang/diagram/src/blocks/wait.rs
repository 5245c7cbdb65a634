//! What a block that waits for a device does, in every part that asks: lowering, the machine, the generators, world
//! models and the tests.
//!
//! Owns the shape of one such row; the rows stand in `waits`. Knows neither expressions nor languages: a row names the
//! property with the expression, and the machine and the generators evaluate it.

use lang_text::problem::Words;

/// What a block waits for.
#[derive(Clone, Copy, Debug)]
pub struct Wait {
    /// Which port is asked.
    pub port: Asked,
    /// What of its reading counts.
    pub reading: Reading,
    /// Which readings end the wait.
    pub until: Until,
    /// How often the port is asked.
    pub every: Every,
    /// The sensor that has to be plugged in there, as world models name it; empty for what is part of the board.
    pub sensor: &'static str,
    /// What is said if nothing answers on the port, by its name.
    pub absent: fn(&str) -> Words,
}

/// Which port is asked.
#[derive(Clone, Copy, Debug)]
pub enum Asked {
    /// The one that this property names.
    Named(&'static str),
    /// Always this one.
    Fixed(&'static str),
    /// The one that the plain number in a property chooses from 1 on; the last one is the name of a port that is not
    /// there, for all other numbers.
    Numbered(&'static str, &'static [&'static str]),
}

/// What of a reading counts.
#[derive(Clone, Copy, Debug)]
pub enum Reading {
    /// Always this.
    Of(Measure),
    /// What the word in a property chooses; the first one for all other words.
    Chosen(&'static str, &'static [(&'static str, Measure)]),
}

/// A number of a reading.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Measure {
    /// The number of a port that has one.
    Only,
    /// One of several.
    At(usize),
    /// A thousandth of one of several, cut towards 0.
    ThousandthAt(usize),
    /// The length of the vector that the first three make, cut to a whole number.
    Length,
}

/// Which readings end a wait.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Until {
    /// Those that stand to the expression in this property as the property `Sign` says.
    Compared(&'static str),
    /// Those above 0.
    Positive,
    /// 0.
    Zero,
}

/// How often a port is asked.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub enum Every {
    /// In each step of the machine.
    Step,
    /// After so many milliseconds.
    Ms(i32),
}

impl Asked {
    /// The name of the port of a block, which may be wrong; asks for properties as text and as plain numbers.
    pub fn name<'a>(
        self,
        text: impl FnOnce(&'static str) -> &'a str,
        number: impl FnOnce(&'static str) -> i32,
    ) -> &'a str {
        match self {
            Self::Named(property) => text(property),
            Self::Fixed(name) => name,
            Self::Numbered(property, names) => {
                let at = usize::try_from(number(property)).ok();
                let (unknown, known) = names.split_last().unwrap_or((&"", &[]));
                let chosen = at.and_then(|at| known.get(at.checked_sub(1)?));
                chosen.unwrap_or(unknown)
            }
        }
    }
}

impl Reading {
    /// What counts for a block; asks for a property as text.
    pub fn measure<'a>(self, text: impl FnOnce(&'static str) -> &'a str) -> Measure {
        match self {
            Self::Of(measure) => measure,
            Self::Chosen(property, choices) => {
                let word = text(property);
                let chosen = choices.iter().find(|(choice, _)| *choice == word);
                let chosen = chosen.or(choices.first());
                chosen.map_or(Measure::Only, |&(_, measure)| measure)
            }
        }
    }
}

impl Measure {
    /// The number of a reading; what is missing there is 0.
    pub fn of(self, numbers: &[i32]) -> i32 {
        let number = |at: usize| numbers.get(at).copied().unwrap_or(0);
        match self {
            Self::Only => number(0),
            Self::At(at) => number(at),
            Self::ThousandthAt(at) => number(at) / 1000,
            Self::Length => {
                let squares = (0..3).map(|axis| f64::from(number(axis)).powi(2));
                squares.sum::<f64>().sqrt() as i32
            }
        }
    }
}
