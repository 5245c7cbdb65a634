//! A program as indented sentences, from its structured form.
//!
//! Owns the sentences around blocks, and which blocks a line tells of; what blocks do is told by their names and
//! properties.

use std::collections::HashMap;

use super::words::Word;
use super::{details, name};
use crate::blocks::Row;
use crate::generate::plan::{For, Function, Owner, plan};
use crate::lower::{World, lower};
use crate::program::{Leads, Node, Op, Program, Test};
use crate::project::{Block, Diagram, DiagramKind, Project};
use crate::structure::{Jumps, structure};
use crate::tree::{Condition, Tree};
use lang_text::problem::{Locale, Problem};

/// A line of sentences.
#[derive(Clone, Debug, Default, Eq, PartialEq)]
pub struct Line {
    /// The sentence with its indentation.
    pub text: String,
    /// Ids of the blocks that it tells of. A block that several ways lead to may be told more than once.
    pub blocks: Vec<Box<str>>,
}

/// The program of a project in sentences, as one text.
///
/// # Errors
/// Those of [`lines`].
pub fn outline(project: &Project, locale: Locale) -> Result<String, Vec<Problem>> {
    let lines = lines(project, locale)?;
    Ok(lines.iter().flat_map(|line| [&line.text, "\n"]).collect())
}

/// The program of a project in sentences, line by line.
///
/// # Errors
/// What makes it unclear what the program does: links that are missing or too many, unclear threads.
pub fn lines(project: &Project, locale: Locale) -> Result<Vec<Line>, Vec<Problem>> {
    let lowered = lower(project, World::Robot).map_err(|problem| vec![problem])?;
    let program = &lowered.program;
    let plan = plan(program, For::Show)?;
    let blocks = project.diagrams.iter().flat_map(|diagram| &diagram.blocks);
    let mut writer = Writer {
        program,
        main: project.main.and_then(|main| project.diagrams.get(main)),
        blocks: blocks.map(|block| (block.id.as_str(), block)).collect(),
        locale,
        function: None,
        out: Vec::new(),
    };
    for function in &plan.functions {
        writer.function(function);
    }
    Ok(writer.out)
}

struct Writer<'a> {
    program: &'a Program,
    /// The diagram that is shown first; it may be a subprogram.
    main: Option<&'a Diagram>,
    blocks: HashMap<&'a str, &'a Block>,
    locale: Locale,
    function: Option<&'a Function>,
    out: Vec<Line>,
}

impl<'a> Writer<'a> {
    fn word(&self, word: Word) -> &'static str {
        word.text(self.locale)
    }

    /// A line that tells of these blocks.
    fn line(&mut self, depth: usize, text: &str, blocks: &[usize]) {
        let nodes = blocks.iter().filter_map(|&block| self.node(block));
        let ids = nodes.filter_map(|node| self.program.id(node));
        let blocks = ids.map(Into::into).collect();
        let text = format!("{:width$}{text}", "", width = depth * 2);
        self.out.push(Line { text, blocks });
    }

    fn subprogram(&self, name: &str) -> String {
        format!("{} {}", self.word(Word::Subprogram), super::shortened(name))
    }

    fn function(&mut self, function: &'a Function) {
        self.function = Some(function);
        let title = match &function.owner {
            Owner::Main => match self.main {
                Some(Diagram {
                    kind: DiagramKind::Subprogram,
                    name,
                    ..
                }) => self.subprogram(name),
                Some(Diagram {
                    kind: DiagramKind::Main,
                    ..
                })
                | None => self.word(Word::Program).to_owned(),
            },
            Owner::Subprogram(diagram) => {
                let sheet = self.program.diagrams.get(*diagram as usize);
                self.subprogram(sheet.map_or("", |sheet| &sheet.name))
            }
            Owner::Thread(name, _) => {
                format!("{} {}", self.word(Word::Thread), super::shortened(name))
            }
        };
        if !self.out.is_empty() {
            self.out.push(Line::default());
        }
        let starts = (0..function.nodes.len()).filter(|&block| self.is_mark(block));
        let starts: Vec<usize> = starts.collect();
        self.line(0, &format!("{title}:"), &starts);
        let structured = structure(&function.graph, Jumps::Plain);
        self.list(&structured.body, 1);
    }

    fn node(&self, block: usize) -> Option<Node> {
        self.function?.nodes.get(block).copied()
    }

    fn block(&self, block: usize) -> Option<&'a Block> {
        let id = self.program.id(self.node(block)?)?;
        self.blocks.get(id).copied()
    }

    fn list(&mut self, list: &[Tree], depth: usize) {
        for tree in list {
            self.tree(tree, depth);
        }
    }

    fn body(&mut self, (head, blocks): (&str, &[usize]), list: &[Tree], depth: usize) {
        self.line(depth, &format!("{head}:"), blocks);
        self.list(list, depth + 1);
    }

    fn is_mark(&self, block: usize) -> bool {
        let row = self.node(block).and_then(|node| self.program.row(node));
        row.is_some_and(Row::is_mark)
    }

    fn tree(&mut self, tree: &Tree, depth: usize) {
        match tree {
            Tree::Step(block) => self.step(*block, depth),
            Tree::If { when, yes, no } => {
                let head = format!("{} {}", self.word(Word::If), self.condition(when));
                self.body((&head, &tests(when)), yes, depth);
                if !no.is_empty() {
                    self.body((self.word(Word::Otherwise), &[]), no, depth);
                }
            }
            Tree::Switch { on, branches } => self.switch(*on, branches, depth),
            Tree::Loop { body, .. } => self.body((self.word(Word::Forever), &[]), body, depth),
            Tree::While { when, body, .. } => {
                let head = match when {
                    Condition::Test(block) => self.head(*block),
                    Condition::Not(_) | Condition::And(..) | Condition::Or(..) => {
                        format!("{} {}", self.word(Word::While), self.condition(when))
                    }
                };
                self.body((&head, &tests(when)), body, depth);
            }
            Tree::DoWhile { when, body, .. } => {
                self.body((self.word(Word::Repeat), &[]), body, depth);
                let foot = format!("{} {}", self.word(Word::Until), self.condition(when));
                self.line(depth, &foot, &tests(when));
            }
            Tree::Break(_) => self.line(depth, self.word(Word::Leave), &[]),
            Tree::Continue(_) => self.line(depth, self.word(Word::Again), &[]),
            Tree::End(_) => self.line(depth, self.word(Word::End), &[]),
            Tree::Set { variable, value } => {
                let text = format!("{} {} = {value}", self.word(Word::Place), variable + 1);
                self.line(depth, &text, &[]);
            }
            Tree::Choice { variable, arms } => {
                for (value, body) in arms {
                    let (word, place) = (self.word(Word::If), self.word(Word::Place));
                    let head = format!("{word} {place} {} = {value}", variable + 1);
                    self.body((&head, &[]), body, depth);
                }
            }
            Tree::Goto(_) | Tree::Label(_) => {}
        }
    }

    fn switch(&mut self, on: usize, branches: &[(Vec<usize>, Vec<Tree>)], depth: usize) {
        let head = format!("{} {}", self.word(Word::Depending), self.test(on));
        self.line(depth, &format!("{head}:"), &[on]);
        let program = self.program;
        let guards = match self.node(on).and_then(|node| program.leads(node)) {
            Some(Leads::Switch(switch)) => &switch.branches[..],
            Some(
                Leads::End
                | Leads::Fault(_)
                | Leads::To(_)
                | Leads::Test(..)
                | Leads::Fork(_)
                | Leads::Join(..)
                | Leads::Call(..)
                | Leads::Ask(..),
            )
            | None => &[],
        };
        for (ways, body) in branches {
            let named = ways.iter().filter_map(|&way| guards.get(way));
            let named: Vec<String> = named.map(|(guard, _)| super::shortened(guard)).collect();
            let head = if ways.contains(&guards.len()) {
                self.word(Word::Otherwise).to_owned()
            } else {
                format!("{} {}", self.word(Word::Case), named.join(", "))
            };
            self.body((&head, &[]), body, depth + 1);
        }
    }

    fn step(&mut self, block: usize, depth: usize) {
        let Some(node) = self.node(block) else {
            return;
        };
        if self.is_mark(block) {
            return;
        }
        if let Some(begun) = self.function.and_then(|function| function.begun.get(&node)) {
            for (name, _) in begun {
                let text = format!("{} {}", self.word(Word::Begin), super::shortened(name));
                self.line(depth, &text, &[block]);
            }
            return;
        }
        let Some(shown) = self.block(block) else {
            return;
        };
        let mut said = name(shown, self.locale);
        if let Op::Call { call, .. } = self.program.ops[node as usize] {
            let diagram = self.program.calls[call as usize].diagram;
            let sheet = diagram.and_then(|diagram| self.program.diagrams.get(diagram as usize));
            said = format!(
                "{said} {}",
                super::shortened(sheet.map_or("", |sheet| &sheet.name))
            );
        }
        let details = details(shown);
        let colon = if details.is_empty() { "" } else { ": " };
        self.line(depth, &format!("{said}{colon}{details}"), &[block]);
    }

    /// The head of a loop that one block decides about.
    fn head(&self, block: usize) -> String {
        let word = match self.node(block).and_then(|node| self.program.test(node)) {
            Some(Test::Count(_)) => Word::Times,
            Some(Test::Truth(_)) | None => Word::While,
        };
        format!("{} {}", self.word(word), self.test(block))
    }

    /// What a block decides by.
    fn test(&self, block: usize) -> String {
        let Some(shown) = self.block(block) else {
            return String::new();
        };
        let node = self.node(block);
        match node.and_then(|node| self.program.leads(node)) {
            // Which way is taken is not in the block, but with who answers.
            Some(Leads::Ask(..)) => format!(
                "{} {}: {}",
                self.word(Word::Answered),
                name(shown, self.locale),
                details(shown)
            ),
            Some(
                Leads::End
                | Leads::Fault(_)
                | Leads::To(_)
                | Leads::Test(..)
                | Leads::Switch(_)
                | Leads::Fork(_)
                | Leads::Join(..)
                | Leads::Call(..),
            )
            | None => details(shown),
        }
    }

    fn condition(&self, when: &Condition) -> String {
        match when {
            Condition::Test(block) => self.test(*block),
            Condition::Not(inner) => {
                format!("{} ({})", self.word(Word::Not), self.condition(inner))
            }
            Condition::And(left, right) => self.both(left, Word::And, right),
            Condition::Or(left, right) => self.both(left, Word::Or, right),
        }
    }

    fn both(&self, left: &Condition, word: Word, right: &Condition) -> String {
        let (left, right) = (self.condition(left), self.condition(right));
        format!("({left}) {} ({right})", self.word(word))
    }
}

/// The blocks that a condition asks.
fn tests(when: &Condition) -> Vec<usize> {
    match when {
        Condition::Test(block) => vec![*block],
        Condition::Not(inner) => tests(inner),
        Condition::And(left, right) | Condition::Or(left, right) => {
            let mut all = tests(left);
            all.extend(tests(right));
            all
        }
    }
}
