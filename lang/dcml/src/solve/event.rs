//! Where a value along a solution goes through zero.
//!
//! Owns the search within one step. A value that touches zero and turns back between two of its samples is not seen.

use super::Solver;

/// How often a step is looked at, to see what goes through zero and back within it.
const SAMPLES: u32 = 4;
/// Halvings of a quarter of a step: finer than numbers are.
const HALVINGS: u32 = 60;

/// Which way a value must go to count.
#[derive(Clone, Copy, Debug, Default, Eq, PartialEq)]
pub enum Direction {
    /// Both.
    #[default]
    Any,
    /// From below zero to zero or more.
    Rising,
    /// From above zero to zero or less.
    Falling,
}

impl Direction {
    /// Whether it counts. What begins at zero has not gone through it.
    fn counts(self, from: f64, to: f64) -> bool {
        let rises = from < 0.0 && to >= 0.0;
        let falls = from > 0.0 && to <= 0.0;
        match self {
            Self::Any => rises || falls,
            Self::Rising => rises,
            Self::Falling => falls,
        }
    }
}

/// What is looked for.
pub struct Event<'a> {
    /// Of time in s and state.
    pub value: &'a mut dyn FnMut(f64, &[f64]) -> f64,
    /// Which way it goes.
    pub direction: Direction,
    /// Whether the solution ends with it.
    pub is_terminal: bool,
}

impl Event<'_> {
    /// The first time in the last step at which it happens: the value has changed its side there, and not just before.
    pub(super) fn first_in(&mut self, solver: &Solver, state: &mut [f64]) -> Option<f64> {
        let (begin, end) = (solver.before(), solver.time());
        let mut at = |time: f64| {
            solver.between(time, state);
            (self.value)(time, state)
        };
        let mut from = (begin, at(begin));
        for sample in 1..=SAMPLES {
            let time = match sample {
                SAMPLES => end,
                _ => begin + (end - begin) * f64::from(sample) / f64::from(SAMPLES),
            };
            let to = (time, at(time));
            if self.direction.counts(from.1, to.1) {
                let mut around = (from.0, to.0);
                for _ in 0..HALVINGS {
                    let middle = around.0 + (around.1 - around.0) / 2.0;
                    if middle <= around.0 || middle >= around.1 {
                        break;
                    }
                    if self.direction.counts(from.1, at(middle)) {
                        around.1 = middle;
                    } else {
                        around.0 = middle;
                    }
                }
                return Some(around.1);
            }
            from = to;
        }
        None
    }
}
