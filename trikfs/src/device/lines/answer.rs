//! The last answer of a sensor program, for readers that come after it.
//!
//! Owns when it is forgotten: when the question is asked anew, so that an old answer is never taken for the new one.

use crate::events::lock;
use config::description::{AnswerDescription, SourceDescription};
use std::sync::Mutex;

/// The answer of one node's program, as a whole tuple.
#[derive(Default)]
pub struct Answer(Mutex<Option<Vec<u8>>>);

impl Answer {
    /// Looks whether the answer is among these tuples of the source.
    pub fn note(&self, source: &SourceDescription, tuples: &[u8], tuple_size: usize) {
        let Some(answer) = source.kept_answer() else {
            return;
        };
        let mut newest_first = tuples.chunks_exact(tuple_size).rev();
        if let Some(line) = newest_first.find(|line| line.starts_with(answer.as_bytes())) {
            *lock(&self.0) = Some(line.to_vec());
        }
    }

    /// A line is about to go to the program.
    pub fn forget_if_asked(&self, expected: Option<&AnswerDescription>, line: &[u8]) {
        if expected.is_some_and(|expected| expected.question.as_bytes() == line) {
            *lock(&self.0) = None;
        }
    }

    /// The answer that nobody has asked for again.
    pub fn tuple(&self) -> Option<Vec<u8>> {
        lock(&self.0).clone()
    }
}
