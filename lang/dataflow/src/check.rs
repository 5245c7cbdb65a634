//! What types, periods, cycles and ends show of a program that could run: mistakes, and what is probably not meant.
//!
//! Owns the checks that look at several blocks at once; `lower` has those of one block with its edges. Each block is told
//! of once, however many instances it has. Knows no time.

mod conditions;
mod edges;
mod givers;
mod rates;
mod shape;
mod tokens;
mod types;
mod words;

#[cfg(test)]
mod tests;

use crate::lower::{Lowered, lower};
use crate::program::{NodeId, Program};
use crate::project::Project;
use lang_text::problem::{Place, Problem, Severity, Words, keep};
use std::collections::HashSet;

/// Makes a project ready to run, with everything that can be told without running it.
pub fn check(project: &Project) -> Lowered {
    let mut lowered = lower(project);
    if lowered.has_errors() {
        sort(&mut lowered.problems);
        return lowered;
    }
    let program = &lowered.program;
    let mut found = Found::default();
    let types = types::infer(program, &mut found);
    edges::look(program, &types, &mut found);
    shape::look(program, &mut found);
    rates::look(program, &mut found);
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

/// What was found, once for each block of the save.
#[derive(Debug, Default)]
struct Found {
    problems: Vec<Problem>,
    has_failed: bool,
    told: HashSet<(Option<String>, Option<String>, String)>,
}

impl Found {
    fn add(&mut self, place: Place, severity: Severity, words: Words) {
        let key = (
            place.object.clone(),
            place.property.clone(),
            words.english.clone(),
        );
        if self.told.insert(key) {
            let mut problem = Problem::error(words);
            problem.severity = severity;
            problem.place = place;
            keep(&mut self.problems, problem);
        }
    }

    fn error(&mut self, place: Place, words: Words) {
        self.has_failed = true;
        // There is always room for an error.
        self.problems.truncate(lang_text::limits::PROBLEMS_KEPT - 1);
        self.add(place, Severity::Error, words);
    }

    fn warn(&mut self, place: Place, words: Words) {
        self.add(place, Severity::Warning, words);
    }
}

/// Where a property of a node is, by its name in the save, for a problem.
fn property_place(program: &Program, id: NodeId, name: &str) -> Place {
    let property = program.node(id).row.property(name);
    let shown = property.map_or(name, |property| property.shown);
    program.property_place(id, shown, None)
}

/// Where a port of a node is, for a problem.
fn port_place(program: &Program, id: NodeId, port: u8) -> Place {
    let name = program.node(id).port_name(port);
    program.property_place(id, name, None)
}
