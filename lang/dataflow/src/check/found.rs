//! What the checks find: problems, each told once, and where they are.
//!
//! Owns that an error is never lost among warnings. Knows no check.

use crate::program::{NodeId, Program};
use lang_text::problem::{Place, Problem, Severity, Words, keep};
use std::collections::HashSet;

/// What was found, once for each block of the save.
#[derive(Debug, Default)]
pub(super) struct Found {
    pub(super) problems: Vec<Problem>,
    pub(super) has_failed: bool,
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

    pub(super) fn error(&mut self, place: Place, words: Words) {
        self.has_failed = true;
        // There is always room for an error.
        self.problems.truncate(lang_text::limits::PROBLEMS_KEPT - 1);
        self.add(place, Severity::Error, words);
    }

    pub(super) fn warn(&mut self, place: Place, words: Words) {
        self.add(place, Severity::Warning, words);
    }
}

/// Where a property of a node is, by its name in the save, for a problem.
pub(super) fn property_place(program: &Program, id: NodeId, name: &str) -> Place {
    let property = program.node(id).row.property(name);
    let shown = property.map_or(name, |property| property.shown);
    program.property_place(id, shown, None)
}

/// Where a port of a node is, for a problem.
pub(super) fn port_place(program: &Program, id: NodeId, port: u8) -> Place {
    let name = program.node(id).port_name(port);
    program.property_place(id, name, None)
}
