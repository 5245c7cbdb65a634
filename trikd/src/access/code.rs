//! Pairing codes: digits that a person has who may open the robot's own socket, and types into a browser somewhere else.
//!
//! Owns how long a code counts and how many wrong ones are taken. A code is for one computer: it is gone once it was used.

use crate::limits;
use std::io::{self, Read};
use std::time::{Duration, Instant};

/// A code that can be used.
#[derive(Debug)]
pub(super) struct Code {
    digits: String,
    since: Instant,
    wrong: u32,
}

/// Why a computer is not paired by a code.
#[derive(Debug)]
pub enum Refused {
    /// It is not the code that was given out last, or none counts any more.
    Wrong,
    /// It is the code, but the computer cannot be paired.
    Unpaired(io::Error),
}

impl Code {
    /// A new one, of random digits.
    ///
    /// # Errors
    /// The system has no random numbers.
    pub(super) fn new() -> io::Result<Self> {
        let most = 10_u32.pow(limits::CODE_DIGITS);
        let mut bytes = [0; 4];
        let mut source = std::fs::File::open("/dev/urandom")?;
        let number = loop {
            source.read_exact(&mut bytes)?;
            let number = u32::from_le_bytes(bytes);
            // Beyond the last whole multiple some digits would come more often.
            if number < u32::MAX - u32::MAX % most {
                break number % most;
            }
        };
        let width = limits::CODE_DIGITS as usize;
        Ok(Self {
            digits: format!("{number:0width$}"),
            since: Instant::now(),
            wrong: 0,
        })
    }

    pub(super) fn digits(&self) -> &str {
        &self.digits
    }

    /// Whether it counts still.
    pub(super) fn is_fresh(&self) -> bool {
        self.wrong < limits::CODES_WRONG_MAX
            && self.since.elapsed() < Duration::from_millis(limits::CODE_MS)
    }

    /// Whether a person has typed it, perhaps with spaces; each other text makes it count shorter.
    pub(super) fn is(&mut self, typed: &str) -> bool {
        let typed = typed.chars().filter(|letter| !letter.is_whitespace());
        let is_it = self.is_fresh() && typed.eq(self.digits.chars());
        if !is_it {
            self.wrong += 1;
        }
        is_it
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_code_is_taken_as_people_write_it_and_only_so_often() {
        let mut code = Code::new().unwrap();
        assert_eq!(code.digits().len(), 6);
        assert!(code.digits().bytes().all(|digit| digit.is_ascii_digit()));
        let (first, last) = code.digits().split_at(3);
        let typed = format!(" {first} {last}\n");
        assert!(code.is(&typed));
        for wrong in ["", "1234567", "x", "\u{661}\u{662}\u{663}"] {
            assert!(!code.is(wrong) && code.is_fresh(), "{wrong}");
        }
        assert!(!code.is("also wrong"));
        assert!(!code.is_fresh() && !code.is(&typed));
        let old = Duration::from_millis(limits::CODE_MS);
        let mut code = Code::new().unwrap();
        if let Some(since) = code.since.checked_sub(old) {
            code.since = since;
            let typed = code.digits().to_owned();
            assert!(!code.is(&typed));
        }
    }

    #[test]
    fn codes_differ() {
        let all: std::collections::BTreeSet<_> = (0..20)
            .map(|_| Code::new().unwrap().digits().to_owned())
            .collect();
        assert!(all.len() > 15, "{all:?}");
    }
}
