//! Problems of one file for people and programs: in order, each once, as JSON.
//!
//! Owns the order, and the names of JSON that `trik lint --json` writes. Lines for a terminal are made where the terminal is
//! known.

use crate::program::Flow;
use lang_dataflow::text::Places;
use lang_diagram::project::{Block, Project};
use lang_text::problem::{Locale, Position, Problem, Severity};
use serde_json::{Value, json};
use std::cmp::Reverse;
use std::collections::HashMap;

/// What lines and columns of a file are known.
enum Lines<'a> {
    /// None: a save is an archive.
    None,
    /// Those that problems have: nobody could read the text.
    OfProblems,
    /// Those of the objects in a text.
    OfObjects(Places<'a>),
}

/// What is known of the places in one file.
pub struct Findings<'a> {
    lines: Lines<'a>,
    blocks: HashMap<&'a str, (usize, usize, &'a Block)>,
}

impl<'a> Findings<'a> {
    /// For a save or a world, with its project if there is one and it could be read.
    pub fn new(project: Option<&'a Project>) -> Self {
        let mut blocks = HashMap::new();
        for (at, diagram) in project
            .iter()
            .flat_map(|one| one.diagrams.iter().enumerate())
        {
            for (place, block) in diagram.blocks.iter().enumerate() {
                blocks.entry(&*block.id).or_insert((at, place, block));
            }
        }
        Self {
            lines: Lines::None,
            blocks,
        }
    }

    /// For a text that could not be read: an editor can go to the places of its problems.
    pub fn of_unread_text() -> Self {
        Self {
            lines: Lines::OfProblems,
            ..Self::new(None)
        }
    }

    /// For a data-flow program: an editor can go to the places of what is wrong with its text, if it has one.
    pub fn of_flow(flow: &'a Flow) -> Self {
        let text = flow.text.as_deref();
        Self {
            lines: text.map_or(Lines::None, |text| {
                Lines::OfObjects(Places::of(text, &flow.project))
            }),
            ..Self::new(None)
        }
    }

    /// The places of problems in the file.
    pub fn in_file(&self, problems: &[Problem]) -> Vec<Option<Position>> {
        match &self.lines {
            Lines::None => vec![None; problems.len()],
            Lines::OfProblems => problems.iter().map(|one| one.place.position).collect(),
            Lines::OfObjects(places) => places.locate(problems),
        }
    }

    /// The worst first, then diagram after diagram, block after block, and each only once.
    pub fn sort(&self, problems: &mut Vec<Problem>) {
        let place = |problem: &Problem| {
            let block = self.found(problem);
            let (diagram, at) = block.map_or((usize::MAX, 0), |&(diagram, at, _)| (diagram, at));
            (diagram, at, problem.place.position)
        };
        problems.sort_by_key(|problem| (Reverse(problem.severity), place(problem)));
        problems.dedup();
    }

    /// An object for each: level and message as in the results of `trik check`, and where it is.
    pub fn json(&self, file: &str, problems: &[Problem], locale: Locale) -> Vec<Value> {
        let one = |(problem, in_file): (&Problem, Option<Position>)| {
            let place = &problem.place;
            let at = place.position;
            let mut one = json!({
                "file": file,
                "level": level(problem.severity),
                "message": problem.said(locale),
                "part": place.file,
                "diagram": place.diagram,
                "object": place.object,
                "block": place.block,
                "property": place.property,
                "line": at.map(|at| at.line),
                "column": at.map(|at| at.column),
            });
            if let Some(at) = in_file {
                one["fileLine"] = at.line.into();
                one["fileColumn"] = at.column.into();
            }
            one
        };
        let places = problems.iter().zip(self.in_file(problems));
        places.map(one).collect()
    }

    /// The block that a problem is at.
    pub fn block(&self, problem: &Problem) -> Option<&'a Block> {
        self.found(problem).map(|(_, _, block)| *block)
    }

    fn found(&self, problem: &Problem) -> Option<&(usize, usize, &'a Block)> {
        self.blocks.get(problem.place.object.as_deref()?)
    }
}

fn level(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    }
}
