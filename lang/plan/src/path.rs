//! A path: which action is held for how long, and where the robot is.
//!
//! Owns the data and its replay. Knows no planner.

use super::motion::Propagator;
use lang_dcml::system::System;

/// One action that is held.
#[derive(Clone, Debug, PartialEq)]
pub struct Piece {
    /// The action.
    pub action: Vec<f64>,
    /// For so many steps.
    pub steps: u32,
    /// The place (states, then outputs) at its end.
    pub end: Vec<f64>,
}

/// From a start through pieces.
#[derive(Clone, Debug, PartialEq)]
pub struct Path {
    /// The place where it begins.
    pub start: Vec<f64>,
    /// In order; none if the start is in the goal.
    pub pieces: Vec<Piece>,
    /// Seconds of a step.
    pub step: f64,
}

impl Path {
    /// Steps from the beginning to the end.
    pub fn steps(&self) -> u64 {
        self.pieces.iter().map(|piece| u64::from(piece.steps)).sum()
    }

    /// Seconds from the beginning to the end.
    pub fn duration(&self) -> f64 {
        self.steps() as f64 * self.step
    }

    /// Where it ends.
    pub fn end(&self) -> &[f64] {
        self.pieces.last().map_or(&self.start, |piece| &piece.end)
    }

    /// Goes along it again, each step in so many parts: with 1 exactly as it was planned. `visit` gets the seconds since
    /// the beginning, the place and the action that is held from there on; at the end the last action.
    pub fn replay<S: System + ?Sized>(
        &self,
        system: &mut S,
        parts: u32,
        mut visit: impl FnMut(f64, &[f64], &[f64]),
    ) {
        let parts = parts.max(1);
        let step = self.step / f64::from(parts);
        let states = system.states().min(self.start.len());
        let mut propagator = Propagator::new(system, step);
        let mut place = propagator.place(&self.start[..states]);
        let mut done = 0_u64;
        for piece in &self.pieces {
            for _ in 0..u64::from(piece.steps) * u64::from(parts) {
                visit(done as f64 * step, &place, &piece.action);
                propagator.advance(&mut place, &piece.action);
                done += 1;
            }
        }
        let rest = vec![0.0; propagator.actions()];
        let last = self.pieces.last().map_or(&rest, |piece| &piece.action);
        visit(done as f64 * step, &place, last);
    }
}
