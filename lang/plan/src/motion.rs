//! Places that follow each other: a state moved one step on, with its outputs and its angles in order.
//!
//! Owns what a place is. The step itself is `solve`'s; knows no obstacle: who calls looks at each place.

use super::obstacles::flat::wrapped;
use lang_dcml::solve::propagate;
use lang_dcml::system::System;

/// A system that is moved step by step. Angles that the system wraps stay in (-pi, pi].
pub struct Propagator<'a, S: System + ?Sized> {
    system: &'a mut S,
    step: f64,
    states: usize,
    wraps: Vec<bool>,
    solver: propagate::Propagator,
}

impl<'a, S: System + ?Sized> Propagator<'a, S> {
    /// Steps of so many seconds.
    pub fn new(system: &'a mut S, step: f64) -> Self {
        let states = system.states();
        Self {
            step,
            states,
            wraps: (0..states).map(|state| system.wraps(state)).collect(),
            solver: propagate::Propagator::new(),
            system,
        }
    }

    /// The numbers of a place: states and outputs.
    pub fn parts(&self) -> usize {
        self.states + self.system.outputs()
    }

    /// The numbers of an action.
    pub fn actions(&self) -> usize {
        self.system.actions()
    }

    /// The place of a state, with the outputs under an action of zeros.
    pub fn place(&mut self, state: &[f64]) -> Vec<f64> {
        let mut place = state.to_vec();
        place.resize(self.parts(), 0.0);
        let rest = vec![0.0; self.actions()];
        self.finish(&mut place, &rest);
        place
    }

    /// One step from a place under an action: `place` becomes the next one.
    pub fn advance(&mut self, place: &mut [f64], action: &[f64]) {
        let (state, _) = place.split_at_mut(self.states);
        self.solver.run(self.system, state, action, self.step, 1);
        self.finish(place, action);
    }

    fn finish(&mut self, place: &mut [f64], action: &[f64]) {
        let (state, outputs) = place.split_at_mut(self.states);
        for (value, wraps) in state.iter_mut().zip(&self.wraps) {
            if *wraps {
                *value = wrapped(*value);
            }
        }
        if !outputs.is_empty() {
            self.system.output(state, action, outputs);
        }
    }
}
