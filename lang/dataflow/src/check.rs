//! What types, periods, cycles and ends show of a program that could run: mistakes, and what is probably not meant.
//!
//! Owns the checks that look at several blocks at once; `lower` has those of one block with its edges. Each block is told
//! of once, however many instances it has. Knows no time.

mod arrivals;
mod components;
mod conditions;
mod constants;
mod edges;
mod fed;
mod first;
mod found;
mod givers;
mod instant;
mod names;
mod rates;
pub(crate) mod shape;
mod silent;
mod statements;
mod through;
mod tokens;
mod types;
mod unassigned;
mod units;
mod words;
mod writers;

#[cfg(test)]
mod tests;

use crate::lower::{Lowered, lower};
use crate::project::Project;
use arrivals::Arrivals;
use found::Found;
use lang_text::problem::{Problem, keep};

/// Makes a project ready to run, with everything that can be told without running it.
pub fn check(project: &Project) -> Lowered {
    let mut lowered = lower(project);
    if lowered.has_errors() {
        sort(&mut lowered.problems);
        return lowered;
    }
    let program = &lowered.program;
    let mut found = Found::default();
    names::look(program, &mut found);
    if !found.has_failed {
        let types = types::infer(program, &mut found);
        edges::look(program, &types, &mut found);
        let arrivals = Arrivals::of(program);
        shape::look(program, &arrivals, &mut found);
        silent::look(program, &arrivals, &mut found);
        rates::look(program, &mut found);
    }
    lowered.has_failed |= found.has_failed;
    sort(&mut found.problems);
    let room = lang_text::limits::PROBLEMS_KEPT.saturating_sub(found.problems.len());
    lowered.problems.truncate(room);
    for problem in found.problems {
        keep(&mut lowered.problems, problem);
    }
    sort(&mut lowered.problems);
    lowered
}

/// The worst first, and otherwise in the order in which they were found.
fn sort(problems: &mut [Problem]) {
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
}
