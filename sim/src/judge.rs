//! One run of a solution in a world, judged: program, world and rules, tick by tick, to a verdict.
//!
//! Owns the order of one tick, the limits of a run and what is told of it. Knows neither files nor processes: texts in,
//! an outcome out. What a world does is in [`crate::arena`]; what a task demands is in `lang`.

pub mod json;
pub mod program;
pub mod trajectory;

pub use program::{Diagram, Program};
