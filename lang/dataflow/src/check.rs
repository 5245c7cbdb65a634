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

use crate::blocks::Kind;
use crate::lower::{DATA, INPUTS, Lowered, lower};
use crate::project::Project;
use crate::sensors;
use arrivals::Arrivals;
use found::Found;
use lang_expr::{Names, Source};
use lang_text::problem::{Problem, Words, keep};
use std::collections::BTreeSet;
use types::Of;

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

/// Why tokens of an output of the first kind cannot be taken by an input of the second one, as far as the table of blocks
/// shows it.
pub fn refuses(gives: Kind, takes: Kind) -> Option<Words> {
    let of = Of::of_kind(gives);
    (!of.fits(takes)).then(|| edges::misfit(of, takes))
}

/// Names that can stand in expressions of a project: those of its kit, and variables, with those that tokens have in a
/// block.
pub fn names(project: &Project) -> (Names, BTreeSet<String>) {
    let program = lower(project).program;
    let names = sensors::names_of(program.kit);
    let local = INPUTS.iter().chain(DATA).copied();
    let mut variables: BTreeSet<String> = local.map(str::to_owned).collect();
    for text in &program.formulas {
        let source = Source::new(&text.text, text.wanted);
        let new = source.names();
        let new = new.filter(|name| names.find(name).is_none());
        variables.extend(new.map(str::to_owned));
    }
    (names, variables)
}

/// The worst first, and otherwise in the order in which they were found.
fn sort(problems: &mut [Problem]) {
    problems.sort_by_key(|problem| std::cmp::Reverse(problem.severity));
}
