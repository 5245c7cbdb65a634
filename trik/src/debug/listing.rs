//! The text of a program of blocks that a person debugs, and where each block stands in it.
//!
//! Owns the lines: those of `trik show` where it is clear what the diagram does, else a line for each block. Every block has
//! a line, so that a program that is stopped can always be shown.

use crate::diagrams::flow;
use crate::diagrams::save::must;
use crate::limits;
use crate::refusal::Refusal;
use crate::terminal::harmless;
use lang_dataflow::blocks::Does;
use lang_dataflow::project::{Diagram as FlowDiagram, Project as Flow};
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
    /// Blocks of a data-flow program by their labels: each has one.
    labels: HashMap<String, Box<str>>,
    /// Where a diagram begins, by its name.
    begins: HashMap<String, Vec<Box<str>>>,
    /// Blocks by what is written at them, which others may have too.
    captions: HashMap<String, Vec<Box<str>>>,
    /// All blocks of a type, by its name in the save.
    kinds: HashMap<String, Vec<Box<str>>>,
}

/// What a text means that should mean a block.
#[derive(Clone, Debug, Eq, PartialEq)]
pub(crate) enum Meant {
    /// No block.
    Nothing,
    /// This one.
    Block(Box<str>),
    /// Any of these.
    Several(Vec<Box<str>>),
}

impl Meant {
    fn of(blocks: &[Box<str>]) -> Self {
        match blocks {
            [] => Self::Nothing,
            [one] => Self::Block(one.clone()),
            [..] => Self::Several(blocks.to_vec()),
        }
    }
}

/// A block has a name that others may have too.
fn name(names: &mut HashMap<String, Vec<Box<str>>>, name: &str, block: &str) {
    let blocks = names.entry(name.to_owned()).or_default();
    if !blocks.iter().any(|one| **one == *block) {
        blocks.push(block.into());
    }
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
                if block.kind.contains("Comment") {
                    continue;
                }
                if block.kind == BEGIN {
                    name(&mut listing.begins, &diagram.name, &block.id);
                }
                name(&mut listing.kinds, &block.kind, &block.id);
                let row = blocks::find(&block.kind);
                let shown = row.map(|row| row.shown_in(locale));
                for caption in [block.name.trim(), shown.unwrap_or_default()] {
                    if !caption.is_empty() {
                        name(&mut listing.captions, caption, &block.id);
                    }
                }
            }
        }
        listing.add_others(project, locale);
        listing.find_places();
        listing
    }

    /// A data-flow program, whose blocks have labels: that of a block of a subprogram is also DIAGRAM/LABEL, and without the
    /// diagram it means a block of the main one first.
    pub(crate) fn of_flow(project: &Flow, locale: Locale) -> Self {
        let mut listing = Self::default();
        for line in show::lines(project, show::Extent::default(), locale) {
            listing.lines.push(Line {
                text: line.text,
                blocks: line.block.iter().map(|id| id.as_str().into()).collect(),
            });
        }
        for (index, diagram) in project.diagrams.iter().enumerate() {
            for (block, label) in diagram.blocks.iter().zip(show::callings(diagram, locale)) {
                let id: Box<str> = block.id.as_str().into();
                name(&mut listing.kinds, &block.element, &id);
                name(&mut listing.captions, &label, &id);
                name(&mut listing.captions, block.name.trim(), &id);
                let long = format!("{}/{label}", diagram.name);
                listing.labels.entry(long).or_insert_with(|| id.clone());
                if project.main == Some(index) {
                    listing.labels.insert(label, id);
                }
            }
            for block in first_blocks(diagram) {
                name(&mut listing.begins, &diagram.name, block);
            }
        }
        listing.captions.remove("");
        listing.find_places();
        listing
    }

    /// Whether it is that of a data-flow program.
    pub(crate) fn is_flow(&self) -> bool {
        !self.labels.is_empty()
    }

    /// The blocks that a name means which may be one of several: where a diagram begins, or all of a type; else what
    /// [`Listing::meant`] finds.
    ///
    /// # Errors
    /// It means one of these, and nobody knows which.
    pub(crate) fn named(&self, name: &str) -> Result<Vec<Box<str>>, Vec<Box<str>>> {
        if let Some(blocks) = self.begins.get(name).or_else(|| self.kinds.get(name)) {
            return Ok(blocks.clone());
        }
        match self.meant(name) {
            Meant::Nothing => Ok(Vec::new()),
            Meant::Block(block) => Ok(vec![block]),
            Meant::Several(blocks) => Err(blocks),
        }
    }

    /// The block that is meant by its label, its id, the last part of that in braces, the name of the diagram that begins
    /// with it, what is written at it, or its type.
    pub(crate) fn meant(&self, text: &str) -> Meant {
        if let Some(id) = self.labels.get(text) {
            return Meant::Block(id.clone());
        }
        if let Some((id, _)) = self.places.get_key_value(text) {
            return Meant::Block(id.clone());
        }
        let mut ids = self.places.keys();
        let id = ids.find(|id| {
            let before = id.strip_suffix(text);
            text.starts_with('{') && before.is_some_and(|before| before.ends_with('/'))
        });
        if let Some(id) = id {
            return Meant::Block(id.clone());
        }
        let names = [&self.begins, &self.captions, &self.kinds];
        let found = names.into_iter().find_map(|names| names.get(text));
        found.map_or(Meant::Nothing, |blocks| Meant::of(blocks))
    }

    /// How a person says which of several blocks is meant: by its line, with what stands there, or by its id if that line
    /// means another block.
    pub(crate) fn choices(&self, blocks: &[Box<str>]) -> String {
        let choice = |block: &str| {
            let line = self.line_of(block);
            if self.blocks(line).first().map(|first| &**first) != Some(block) {
                return harmless(block);
            }
            let mut text: String = self.text(line).trim().to_owned();
            if let Some((at, _)) = text.char_indices().nth(limits::CHOICE_CHARS_MAX) {
                text.truncate(at);
                text.push_str("...");
            }
            format!("{line} ({text})")
        };
        let shown = blocks.iter().take(limits::CHOICES_MAX);
        let shown = shown.map(|block| choice(block));
        let mut shown = shown.collect::<Vec<_>>().join(", ");
        if blocks.len() > limits::CHOICES_MAX {
            shown.push_str(", ...");
        }
        shown
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

    /// What blocks and diagrams are called; of a data-flow program labels, since its captions may be ambiguous.
    pub(crate) fn names(&self) -> Vec<String> {
        let labels = self.labels.keys().chain(self.begins.keys());
        let captions = self.captions.keys().filter(|_| !self.is_flow());
        labels.chain(captions).cloned().collect()
    }

    /// The name that may be meant by a text which means no block, as a sentence to append.
    pub(crate) fn near(&self, text: &str) -> Words {
        let labels = self.labels.keys();
        let names = [&self.begins, &self.captions];
        let names = names.into_iter().flat_map(HashMap::keys);
        did_you_mean(text, labels.chain(names).map(String::as_str))
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

/// Where tokens go first that come into a subprogram: the blocks behind its inputs. Of a diagram without inputs none.
fn first_blocks(diagram: &FlowDiagram) -> Vec<&str> {
    let is_input = |index: usize| {
        let row = diagram.blocks.get(index).and_then(|block| block.row);
        row.is_some_and(|row| matches!(row.does, Does::InPort))
    };
    let edges = diagram.edges.iter().filter_map(|edge| {
        let (from, to) = (edge.from?, edge.to?);
        is_input(from.block).then_some(to.block)
    });
    let blocks = edges.filter_map(|index| diagram.blocks.get(index));
    blocks.map(|block| block.id.as_str()).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use lang_diagram::sketch::Sketch;

    fn id(text: &str) -> Box<str> {
        text.into()
    }

    #[test]
    fn a_name_means_a_subprogram_a_block_or_one_of_several() {
        let mut sketch = Sketch::new();
        let twice = sketch.subprogram("twice", &[]);
        sketch.draw_on(twice);
        let begin = sketch.block("InitialNode", &[]);
        let double = sketch.block("Function", &[("Body", "m = n * 2")]);
        let back = sketch.block("FinalNode", &[]);
        sketch.chain(&[begin, double, back]);
        let main = sketch.main();
        sketch.draw_on(main);
        let start = sketch.block("InitialNode", &[]);
        let clear = sketch.block("Function", &[("Body", "n = 0")]);
        let call = sketch.call(twice, &[]);
        let wait = sketch.block("Timer", &[("Delay", "100")]);
        let end = sketch.block("FinalNode", &[]);
        sketch.chain(&[start, clear, call, wait, end]);
        let project = sketch.project();
        let ids = |kind: &str| -> Vec<Box<str>> {
            let blocks = project.diagrams.iter().flat_map(|one| &one.blocks);
            let blocks = blocks.filter(|block| block.kind == kind);
            blocks.map(|block| id(&block.id)).collect()
        };
        let listing = Listing::of(&project, Locale::English);
        assert_eq!(
            listing.meant("Timer"),
            Meant::Block(ids("Timer")[0].clone())
        );
        let Meant::Block(begin) = listing.meant("twice") else {
            panic!("{:?}", listing.meant("twice"));
        };
        assert!(ids("InitialNode").contains(&begin));
        let Meant::Several(functions) = listing.meant("Function") else {
            panic!("{:?}", listing.meant("Function"));
        };
        assert_eq!(functions.len(), 2);
        let choices = listing.choices(&functions);
        assert!(choices.contains(" (Function: n = 0)"), "{choices}");
        assert!(choices.contains(" (Function: m = n * 2)"), "{choices}");
        assert_eq!(listing.named("Function").map(|all| all.len()), Ok(2));
        assert_eq!(listing.meant("Tmier"), Meant::Nothing);
        assert_eq!(listing.near("Tmier").english, "; did you mean 'Timer'?");
        // In the words of the text.
        let russian = Listing::of(&project, Locale::Russian);
        let shown = "\u{422}\u{430}\u{439}\u{43c}\u{435}\u{440}";
        assert_eq!(russian.meant(shown), Meant::Block(ids("Timer")[0].clone()));
    }

    #[test]
    fn a_subprogram_of_data_flow_begins_behind_its_inputs() {
        let walls = include_str!("../../../examples/dataflow/walls.flow");
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("walls.flow");
        std::fs::write(&path, walls).unwrap();
        let listing = listing_of(&path, None, Locale::English).unwrap();
        let begins = listing.named("Keep to the wall").unwrap();
        assert!(!begins.is_empty());
        assert!(begins.iter().all(|block| listing.has(block)));
    }
}
