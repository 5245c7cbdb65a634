//! Which tuples a converter refused, where they stand, and why.
//!
//! Owns the report. Keeps at most `limits::FAULT_REASONS_MAX` reasons, so that a converter with an endless choice of
//! words costs no memory.

use crate::limits::{FAULT_REASONS_MAX, FAULT_SHOWN_BYTES};
use converter::trial::hex;
use std::fmt::Write;

/// A tuple of the input.
#[derive(Clone, Copy)]
pub struct Place<'a> {
    /// From 1.
    pub number: u64,
    /// Bytes of the input before it.
    pub offset: u64,
    /// Its bytes.
    pub bytes: &'a [u8],
}

impl Place<'_> {
    /// For messages.
    pub fn show(&self) -> String {
        let shown = hex(&self.bytes[..self.bytes.len().min(FAULT_SHOWN_BYTES)]);
        let more = if self.bytes.len() > FAULT_SHOWN_BYTES {
            "..."
        } else {
            ""
        };
        format!(
            "tuple {} at byte {} ({shown}{more})",
            self.number, self.offset
        )
    }
}

/// All refused tuples of one input.
#[derive(Default)]
pub struct Faults {
    refused: u64,
    reasons: Vec<Reason>,
    others: u64,
}

struct Reason {
    text: String,
    first: String,
    count: u64,
}

impl Faults {
    /// One refused tuple.
    pub fn add(&mut self, place: Place<'_>, text: String) {
        self.refused += 1;
        let is_full = self.reasons.len() >= FAULT_REASONS_MAX;
        match self.reasons.iter_mut().find(|reason| reason.text == text) {
            Some(reason) => reason.count += 1,
            None if !is_full => self.reasons.push(Reason {
                text,
                first: place.show(),
                count: 1,
            }),
            None => self.others += 1,
        }
    }

    /// The report on `tuples` tuples; None if nothing was refused.
    pub fn render(&self, tuples: u64) -> Option<String> {
        if self.refused == 0 {
            return None;
        }
        let mut text = format!("{} of {tuples} tuples were refused", self.refused);
        for Reason {
            text: why,
            first,
            count,
        } in &self.reasons
        {
            let _ = write!(text, "\n  {count} times, first {first}: {why}");
        }
        if self.others > 0 {
            let _ = write!(text, "\n  {} times for other reasons", self.others);
        }
        Some(text)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn place(number: u64, bytes: &[u8]) -> Place<'_> {
        let offset = (number - 1) * bytes.len() as u64;
        Place {
            number,
            offset,
            bytes,
        }
    }

    #[test]
    fn equal_reasons_are_one_line_with_the_first_place() {
        let mut faults = Faults::default();
        assert_eq!(faults.render(9), None);
        faults.add(place(2, &[0xff, 1]), "no answer".to_owned());
        faults.add(place(3, &[0; 20]), "zero".to_owned());
        faults.add(place(5, &[0xff, 2]), "no answer".to_owned());
        assert_eq!(
            faults.render(9).as_deref(),
            Some(
                "3 of 9 tuples were refused\n  2 times, first tuple 2 at byte 2 (ff01): no answer\n  1 times, first \
                 tuple 3 at byte 40 (00000000000000000000000000000000...): zero"
            )
        );
    }

    #[test]
    fn reasons_without_end_are_counted_together() {
        let mut faults = Faults::default();
        for number in 1..=100 {
            faults.add(place(number, &[1]), format!("reason {number}"));
        }
        let text = faults.render(100).unwrap();
        assert_eq!(text.lines().count(), FAULT_REASONS_MAX + 2);
        assert!(text.ends_with(&format!(
            "  {} times for other reasons",
            100 - FAULT_REASONS_MAX
        )));
    }
}
