//! Pairing codes: digits that a person has who may open the robot's own socket, and types into a browser somewhere else.
//!
//! Owns how long a code counts and how many wrong ones are taken. A code is for one computer: it is gone once it was used.
//! Wrong ones are counted for each computer, so that one that guesses keeps no other one out.

use crate::limits;
use std::collections::BTreeMap;
use std::io::{self, Read};
use std::net::IpAddr;
use std::time::{Duration, Instant};

/// A code that can be used.
#[derive(Debug)]
pub(super) struct Code {
    digits: String,
    since: Instant,
    /// Wrong codes of each computer.
    wrong: BTreeMap<IpAddr, u32>,
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
            wrong: BTreeMap::new(),
        })
    }

    pub(super) fn digits(&self) -> &str {
        &self.digits
    }

    /// Whether it counts still, for a computer.
    fn is_fresh(&self, ip: IpAddr) -> bool {
        let own = self.wrong.get(&ip).copied().unwrap_or(0);
        own < limits::CODES_WRONG_MAX
            && (own > 0 || self.wrong.len() < limits::CODE_GUESSERS_MAX)
            && self.since.elapsed() < Duration::from_millis(limits::CODE_MS)
    }

    /// Whether a person has typed it there, perhaps with spaces; of each computer so many other texts are heard.
    pub(super) fn is(&mut self, ip: IpAddr, typed: &str) -> bool {
        if !self.is_fresh(ip) {
            return false;
        }
        let typed = typed.chars().filter(|letter| !letter.is_whitespace());
        let is_it = typed.eq(self.digits.chars());
        if !is_it {
            *self.wrong.entry(ip).or_default() += 1;
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
        let at = |last: u8| IpAddr::from([10, 0, 0, last]);
        assert!(code.is(at(1), &typed));
        for wrong in ["", "1234567", "x", "\u{661}\u{662}\u{663}", "also wrong"] {
            assert!(code.is_fresh(at(1)) && !code.is(at(1), wrong), "{wrong}");
        }
        assert!(!code.is(at(1), &typed));
        // Others are not kept out by that, unless there are very many who guess.
        assert!(code.is(at(2), &typed));
        for guesser in 3..100 {
            assert!(!code.is(at(guesser), "guess"));
        }
        assert!(code.wrong.len() == limits::CODE_GUESSERS_MAX && !code.is(at(2), &typed));
        assert!(code.is(at(3), &typed));
        let old = Duration::from_millis(limits::CODE_MS);
        let mut code = Code::new().unwrap();
        if let Some(since) = code.since.checked_sub(old) {
            code.since = since;
            let typed = code.digits().to_owned();
            assert!(!code.is(at(1), &typed));
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
