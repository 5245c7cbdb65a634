//! Diagrams that are not run: that nobody calls them, and what is wrong with the properties of their blocks.
//!
//! Owns what is told of them: warnings, because the program runs without them. Their types and periods nobody knows, as
//! nothing comes to them.

use super::{Lowered, Lowering};
use crate::program::Program;
use crate::project::{DiagramKind, Project};
use crate::sensors;
use crate::words;
use lang_expr::Source;
use lang_text::problem::{Place, Problem, Severity, keep};
use std::collections::VecDeque;

/// Adds what is told of diagrams that are not run.
pub(super) fn look(project: &Project, lowered: &mut Lowered) {
    let Some(main) = project.main else {
        return;
    };
    let reached = project.reached(main);
    if reached.iter().all(|is_reached| *is_reached) {
        return;
    }
    let runs = project.diagrams.get(main).map_or("", |one| &one.name);
    let mut aside = Lowering::new(project);
    let kit = aside.program.kit;
    for (at, diagram) in project.diagrams.iter().enumerate() {
        if reached[at] {
            continue;
        }
        let words = match diagram.kind {
            DiagramKind::Subprogram => words::never_called(),
            DiagramKind::Main => words::not_chosen(runs),
        };
        let place = Place {
            diagram: Some(diagram.name.clone()),
            ..Place::default()
        };
        let problem = Problem::warning(words);
        keep(&mut lowered.problems, Problem { place, ..problem });
        aside.program = Program {
            kit,
            ..Program::default()
        };
        (aside.edges, aside.bytes, aside.has_failed) = (0, 0, false);
        aside.chains.clear();
        // What it calls is looked at by itself.
        aside.instance(at, None, &mut VecDeque::new());
        let mut problems = std::mem::take(&mut aside.problems);
        unreadable(&aside.program, &mut problems);
        for mut problem in problems {
            problem.severity = problem.severity.min(Severity::Warning);
            keep(&mut lowered.problems, problem);
        }
    }
}

/// Adds what cannot be read in expressions.
fn unreadable(program: &Program, problems: &mut Vec<Problem>) {
    let mut names = None;
    for text in &program.formulas {
        let mut source = Source::new(&text.text, text.wanted);
        if source.tree().root.is_some() {
            continue;
        }
        let names = names.get_or_insert_with(|| sensors::names_of(program.kit));
        for problem in lang_expr::analyse(&mut source, names)
            .err()
            .unwrap_or_default()
        {
            let at = problem.place.position;
            let place = program.property_place(text.node, text.property, at);
            keep(problems, Problem { place, ..problem });
        }
    }
}
