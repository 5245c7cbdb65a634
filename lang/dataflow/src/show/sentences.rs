//! A program in sentences: each block with what it is, what is special about it, and where its tokens go.
//!
//! Owns the lines. What blocks are called is known to [`super`].

use super::words::Word;
use super::{callings, kind, port, said, shortened};
use crate::limits::SENTENCE_PROPERTY_MAX;
use crate::project::{Block, Diagram, DiagramKind, Edge, End, Policy, Project};
use lang_text::problem::Locale;

/// The program in words for pupils: diagrams, and in each its blocks in the order of the diagram. A line below a block is
/// an edge that begins there.
pub fn sentences(project: &Project, extent: Extent, locale: Locale) -> String {
    text_of(lines(project, extent, locale))
}

/// How much of a program is said.
#[derive(Clone, Copy, Debug, Default)]
pub struct Extent {
    /// Also properties that have their defaults.
    pub with_defaults: bool,
    /// This diagram alone, with the subprograms that it calls, instead of all diagrams.
    pub from: Option<usize>,
}

fn text_of(lines: Vec<Line>) -> String {
    lines
        .into_iter()
        .flat_map(|line| [line.text, "\n".to_owned()])
        .collect()
}

/// A line of the sentences.
#[derive(Clone, Debug, Default)]
pub struct Line {
    /// The sentence with its indentation.
    pub text: String,
    /// The id of the block of which it says what it is.
    pub block: Option<String>,
}

/// The sentences line by line.
pub fn lines(project: &Project, extent: Extent, locale: Locale) -> Vec<Line> {
    let count = project.diagrams.len();
    let mut writer = Writer {
        project,
        locale,
        with_defaults: extent.with_defaults,
        run: match project.main {
            Some(main) => project.reached(main),
            None => vec![false; count],
        },
        out: Vec::new(),
    };
    let wanted = extent.from.map(|from| project.reached(from));
    for at in 0..count {
        if wanted.as_ref().is_none_or(|wanted| wanted[at]) {
            writer.diagram(at);
        }
    }
    writer.out
}

struct Writer<'a> {
    project: &'a Project,
    locale: Locale,
    /// Whether properties are said that have their defaults.
    with_defaults: bool,
    /// Which diagrams are run.
    run: Vec<bool>,
    out: Vec<Line>,
}

impl Writer<'_> {
    fn word(&self, word: Word) -> &'static str {
        word.text(self.locale)
    }

    fn line(&mut self, depth: usize, text: &str) {
        self.out.push(Line {
            text: format!("{}{text}", "  ".repeat(depth)),
            block: None,
        });
    }

    fn diagram(&mut self, at: usize) {
        let diagram = &self.project.diagrams[at];
        if !self.out.is_empty() {
            self.out.push(Line::default());
        }
        let (word, idle) = match diagram.kind {
            DiagramKind::Main => (Word::Program, Word::NotRun),
            DiagramKind::Subprogram => (Word::Subprogram, Word::NotCalled),
        };
        let name = shortened(&diagram.name, SENTENCE_PROPERTY_MAX);
        let mut head = format!("{} \"{name}\"", self.word(word));
        if !self.run[at] {
            head += &format!(" ({})", self.word(idle));
        }
        self.line(0, &format!("{head}:"));
        let names = callings(diagram, self.locale);
        let mut leaving: Vec<Vec<&Edge>> = vec![Vec::new(); diagram.blocks.len()];
        let mut loose = Vec::new();
        for edge in &diagram.edges {
            match edge.from.and_then(|end| leaving.get_mut(end.block)) {
                Some(edges) => edges.push(edge),
                None => loose.push(edge),
            }
        }
        for ((block, name), edges) in diagram.blocks.iter().zip(&names).zip(leaving) {
            self.block(block, name);
            for edge in edges {
                self.edge(edge, diagram, &names, 2);
            }
        }
        for edge in loose {
            self.edge(edge, diagram, &names, 1);
        }
    }

    fn block(&mut self, block: &Block, name: &str) {
        let mut parts = Vec::new();
        if let Some(logical) = &block.calls {
            let called = self.project.called(logical);
            let called = called.and_then(|at| self.project.diagrams.get(at));
            let what = match called {
                Some(diagram) => format!("\"{}\"", shortened(&diagram.name, SENTENCE_PROPERTY_MAX)),
                None => self.word(Word::NotThere).to_owned(),
            };
            parts.push(format!("{} {what}", self.word(Word::Runs)));
        }
        for one in said(block, self.with_defaults) {
            let text = match one.text {
                "" => self.word(Word::Empty).to_owned(),
                "true" if one.is_flag => self.word(Word::Yes).to_owned(),
                "false" if one.is_flag => self.word(Word::No).to_owned(),
                text => shortened(text, SENTENCE_PROPERTY_MAX),
            };
            let name = shortened(one.name, SENTENCE_PROPERTY_MAX);
            parts.push(format!("{name} = {text}"));
        }
        let kind = kind(block, self.locale);
        let said = match block.name.trim() {
            // Its kind is its name already.
            "" => name.to_owned(),
            _ if name == kind => kind,
            _ => format!("{name} - {kind}"),
        };
        let colon = if parts.is_empty() { "" } else { ": " };
        self.line(1, &format!("{said}{colon}{}", parts.join(", ")));
        if let Some(line) = self.out.last_mut() {
            line.block = Some(block.id.clone());
        }
    }

    fn edge(&mut self, edge: &Edge, diagram: &Diagram, names: &[String], depth: usize) {
        let end = |end: Option<End>, nowhere| {
            let found = end.and_then(|end| Some((end, diagram.blocks.get(end.block)?)));
            match found {
                Some((end, block)) => format!("{}.{}", names[end.block], port(block, end.port)),
                None => self.word(nowhere).to_owned(),
            }
        };
        let from = end(edge.from, Word::FromNowhere);
        let mut text = format!("{from} -> {}", end(edge.to, Word::Nowhere));
        if let Some(capacity) = edge.capacity {
            text += &format!(", {}: {capacity}", self.word(Word::AtMost));
        }
        if let Some(policy) = edge.policy {
            let word = match policy {
                Policy::Fifo => Word::Fifo,
                Policy::Latest => Word::Latest,
                Policy::Error => Word::Error,
            };
            text += &format!(", {}", self.word(word));
        }
        self.line(depth, &text);
    }
}
