//! What a solver, a planner or a simulator knows of a robot: states, actions, and how the first change under the second.
//!
//! Owns the border. Knows no model: one of DCML with its parameters is a system, and so is anything else that implements
//! the trait.

/// A controlled differential equation x' = f(x, u).
pub trait System {
    /// How many numbers a state has.
    fn states(&self) -> usize;

    /// How many numbers an action has.
    fn actions(&self) -> usize;

    /// Whether a part of the state is an angle that wraps at a whole turn.
    fn wraps(&self, _state: usize) -> bool {
        false
    }

    /// From where to where an action may be, if it is said.
    fn action_range(&self, _action: usize) -> Option<(f64, f64)> {
        None
    }

    /// How many numbers are computed from a state beside it, as the pose of a robot whose state is that of its wheels.
    fn outputs(&self) -> usize {
        0
    }

    /// Computes them. The slices are as long as [`Self::states`], [`Self::actions`] and [`Self::outputs`] say.
    fn output(&mut self, _state: &[f64], _action: &[f64], _outputs: &mut [f64]) {}

    /// Computes f(x, u). The slices are as long as [`Self::states`], [`Self::actions`] and [`Self::states`] say.
    fn derivative(&mut self, state: &[f64], action: &[f64], derivative: &mut [f64]);
}
