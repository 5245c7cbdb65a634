//! Programs of data flow as converters of trikfs: in Lua, and in C as a library.
//!
//! Owns what such a converter is: its inputs are the sensors that the program reads, its outputs what it tells motors and
//! servos, and its variables; everything else that a robot can be told is refused. The order of events is that of
//! [`crate::machine`]: each tuple of inputs is one poll. Knows no files and no configuration.

mod code;
mod file;
mod language;
mod plan;
mod step;
mod steps;
mod target;
mod words;

#[cfg(test)]
mod tests;

use crate::program::Program;
use lang_text::problem::Problem;

pub use target::Target;

/// Writes a program that [`crate::check::check`] found good.
///
/// # Errors
/// All blocks and texts that a converter cannot have, with their places.
pub fn generate(program: &Program, target: Target) -> Result<String, Vec<Problem>> {
    let mut plan = plan::Plan::of(program, target);
    let body = steps::body(&mut plan);
    plan.settle();
    if !plan.problems.is_empty() {
        return Err(plan.problems);
    }
    Ok(file::assemble(&plan, &body))
}
