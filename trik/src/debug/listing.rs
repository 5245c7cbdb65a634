//! The text of a program of blocks that a person debugs, and where each block stands in it.
//!
//! Owns the lines: those of `trik show` where it is clear what the diagram does, else a line for each block. Every block has
//! a line, so that a program that is stopped can always be shown.

use crate::diagrams::flow;
use crate::diagrams::save::must;
use crate::refusal::Refusal;
use crate::terminal::harmless;
use lang_dataflow::project::Project as Flow;
use lang_dataflow::show;
use lang_diagram::blocks;
use lang_diagram::project::Project;
use lang_diagram::show::outline::{self, Line};
use lang_text::near::did_you_mean;
use lang_text::problem::{Locale, Words};
use std::collections::HashMap;
use std::path::Path;

/// The type of the block with which a diagram begins.
const BEGIN: &str = "InitialNode";

/// The text of the diagram or the data-flow program in a file. `diagram` is the main diagram that is run, if it is not the
/// first one.
///
/// # Errors
/// It cannot be read.
pub(crate) fn listing_of(
    file: &Path,
    diagram: Option<&str>,
    locale: Locale,
) -> Result<Listing, Refusal> {
    let program = must(flow::open(file, diagram), file, locale)?;
    Ok(Listing::of_program(&program, locale))
}

/// A diagram as lines.
#[derive(Debug, Default)]
pub(crate) struct Listing {
    lines: Vec<Line>,
    /// By block: its first line.
    places: HashMap<Box<str>, usize>,
    /// Blocks of a data-flow program by what people call them.
    callings: HashMap<String, Box<str>>,
    /// Blocks by a name of several: where a subprogram begins, all of a type.
    named: HashMap<String, Vec<Box<str>>>,
}

impl Listing {
    /// That of a file, whatever program it has.
    pub(crate) fn of_program(program: &flow::Program, locale: Locale) -> Self {
        match program {
            flow::Program::Diagram(opened) => Self::of(&opened.project, locale),
            flow::Program::Flow(flow, _) | flow::Program::Text(flow) => {
                Self::of_flow(&flow.project, locale)
            }
        }
    }

    pub(crate) fn of(project: &Project, locale: Locale) -> Self {
        let lines = outline::lines(project, locale);
        let mut listing = Self {
            lines: lines.unwrap_or_default(),
            ..Self::default()
        };
        listing.find_places();
        for diagram in &project.diagrams {
            for block in &diagram.blocks {
                if block.kind == BEGIN {
                    listing.name(&diagram.name, &block.id);
                }
                listing.name(&block.kind, &block.id);
            }
        }
        listing.add_others(project, locale);
        listing.find_places();
        listing
    }

    /// A data-flow program, whose blocks people may mean by their captions too: of several with one caption the one of the
    /// main diagram; those of subprograms also as DIAGRAM/CAPTION.
    pub(crate) fn of_flow(project: &Flow, locale: Locale) -> Self {
        let mut listing = Self::default();
        for line in show::lines(project, locale) {
            listing.lines.push(Line {
                text: line.text,
                blocks: line.block.iter().map(|id| id.as_str().into()).collect(),
            });
        }
        let main = project.main.and_then(|at| project.diagrams.get(at));
        for diagram in main.into_iter().chain(&project.diagrams) {
            for (block, name) in diagram.blocks.iter().zip(show::callings(diagram, locale)) {
                let id: Box<str> = block.id.as_str().into();
                listing.name(&block.element, &id);
                let long = format!("{}/{name}", diagram.name);
                listing.callings.entry(long).or_insert_with(|| id.clone());
                listing.callings.entry(name).or_insert(id);
            }
        }
        listing.find_places();
        listing
    }

    /// A block has a name that others may have too.
    fn name(&mut self, name: &str, block: &str) {
        let blocks = self.named.entry(name.to_owned()).or_default();
        // A diagram that is called as a type names none twice.
        if !blocks.iter().any(|one| **one == *block) {
            blocks.push(block.into());
        }
    }

    /// Whether it is that of a data-flow program.
    pub(crate) fn is_flow(&self) -> bool {
        !self.callings.is_empty()
    }

    /// The blocks that a name of several means: where a subprogram begins, or all of a type; of a data-flow program also the
    /// one that a person calls so.
    pub(crate) fn named(&self, name: &str) -> Vec<Box<str>> {
        match (self.named.get(name), self.callings.get(name)) {
            (Some(blocks), _) => blocks.clone(),
            (None, Some(block)) => vec![block.clone()],
            (None, None) => Vec::new(),
        }
    }

    fn find_places(&mut self) {
        for (index, line) in self.lines.iter().enumerate() {
            for block in &line.blocks {
                self.places.entry(block.clone()).or_insert(index);
            }
        }
    }

    /// Blocks that the sentences do not tell of.
    fn add_others(&mut self, project: &Project, locale: Locale) {
        for diagram in &project.diagrams {
            let mut is_first = true;
            for block in &diagram.blocks {
                let row = blocks::find(&block.kind);
                let is_told = self.places.contains_key(block.id.as_str());
                if is_told || block.kind.contains("Comment") {
                    continue;
                }
                if is_first {
                    is_first = false;
                    if !self.lines.is_empty() {
                        self.lines.push(Line::default());
                    }
                    self.lines.push(Line {
                        text: format!("{}, other blocks:", diagram.name),
                        blocks: Vec::new(),
                    });
                }
                let name = row.map_or(block.kind.as_str(), |row| row.shown_in(locale));
                self.lines.push(Line {
                    text: format!("  {name}"),
                    blocks: vec![block.id.as_str().into()],
                });
            }
        }
    }

    /// How many lines there are.
    pub(crate) fn len(&self) -> usize {
        self.lines.len()
    }

    /// The line of a block, from 1; 1 if there is none.
    pub(crate) fn line_of(&self, block: &str) -> usize {
        self.places.get(block).map_or(1, |index| index + 1)
    }

    /// Whether there is a block with this id.
    pub(crate) fn has(&self, block: &str) -> bool {
        self.places.contains_key(block)
    }

    /// The id of a block that is meant by it, by its last part in braces, or by its caption in a data-flow program.
    pub(crate) fn id_of(&self, text: &str) -> Option<&str> {
        if let Some(id) = self.callings.get(text) {
            return Some(id);
        }
        if let Some((id, _)) = self.places.get_key_value(text) {
            return Some(id);
        }
        let mut ids = self.places.keys().map(|id| &**id);
        ids.find(|id| {
            let before = id.strip_suffix(text);
            text.starts_with('{') && before.is_some_and(|before| before.ends_with('/'))
        })
    }

    /// The label of a data-flow program that may be meant by a text which means no block, as a sentence to append; none: the
    /// program is a diagram, whose blocks have no labels.
    pub(crate) fn near_label(&self, text: &str) -> Option<Words> {
        let labels = self.callings.keys().map(String::as_str);
        (!self.callings.is_empty()).then(|| did_you_mean(text, labels))
    }

    /// The blocks of a line, from 1.
    pub(crate) fn blocks(&self, line: usize) -> &[Box<str>] {
        let line = line.checked_sub(1).and_then(|index| self.lines.get(index));
        line.map_or(&[], |line| &line.blocks)
    }

    /// The first line at or after this one that has a block, from 1.
    pub(crate) fn line_with_block(&self, from: usize) -> Option<usize> {
        (from.max(1)..=self.lines.len()).find(|line| !self.blocks(*line).is_empty())
    }

    /// A line, from 1, for a terminal.
    pub(crate) fn text(&self, line: usize) -> String {
        let line = line.checked_sub(1).and_then(|index| self.lines.get(index));
        line.map_or_else(String::new, |line| harmless(&line.text))
    }

    /// All lines as one text.
    pub(crate) fn whole(&self) -> String {
        let lines = self.lines.iter();
        lines
            .flat_map(|line| [harmless(&line.text), "\n".to_owned()])
            .collect()
    }
}
