//! A state moved along under one action, as planners do it millions of times.
//!
//! Owns plain loops of the classical method of order four, for one state and for many. Times, errors and events are the
//! business of a [`super::Solver`].

use crate::run::batch::Batch;
use crate::system::System;

/// Room for the stages of a step.
#[derive(Clone, Debug, Default)]
pub struct Propagator {
    slope: Vec<f64>,
    sum: Vec<f64>,
    stage: Vec<f64>,
}

impl Propagator {
    /// Without room yet: it grows with the first use and stays.
    pub fn new() -> Self {
        Self::default()
    }

    /// Moves a state on for some seconds, in that many equal steps, under one action. Gives whether it is finite.
    pub fn run<S: System + ?Sized>(
        &mut self,
        system: &mut S,
        state: &mut [f64],
        action: &[f64],
        seconds: f64,
        steps: u32,
    ) -> bool {
        self.along(state, seconds, steps, |stage, slope| {
            system.derivative(stage, action, slope);
        })
    }

    /// The same for `count` states, each with its action, in rows as [`Batch::run`] has them.
    pub fn batch(
        &mut self,
        batch: &mut Batch,
        count: usize,
        states: &mut [f64],
        actions: &[f64],
        seconds: f64,
        steps: u32,
    ) -> bool {
        self.along(states, seconds, steps, |stage, slope| {
            batch.run(count, stage, actions, slope);
        })
    }

    fn along(
        &mut self,
        state: &mut [f64],
        seconds: f64,
        steps: u32,
        mut derivative: impl FnMut(&[f64], &mut [f64]),
    ) -> bool {
        let count = state.len();
        for room in [&mut self.slope, &mut self.sum, &mut self.stage] {
            room.resize(count, 0.0);
        }
        let (slope, sum, stage) = (
            self.slope.as_mut_slice(),
            self.sum.as_mut_slice(),
            self.stage.as_mut_slice(),
        );
        let size = seconds / f64::from(steps.max(1));
        for _ in 0..steps {
            derivative(state, slope);
            sum.copy_from_slice(slope);
            for (weight, part) in [(2.0, size / 2.0), (2.0, size / 2.0), (1.0, size)] {
                for ((to, from), rate) in stage.iter_mut().zip(&*state).zip(&*slope) {
                    *to = from + part * rate;
                }
                derivative(stage, slope);
                for (all, rate) in sum.iter_mut().zip(&*slope) {
                    *all += weight * rate;
                }
            }
            for (to, all) in state.iter_mut().zip(&*sum) {
                *to += size / 6.0 * all;
            }
        }
        state.iter().all(|one| one.is_finite())
    }
}
