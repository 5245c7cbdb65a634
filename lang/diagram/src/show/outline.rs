//! A program as indented sentences, from its structured form.
//!
//! Owns the sentences around blocks; what blocks do is told by their names and properties.

use std::collections::HashMap;
use std::fmt::Write as _;

use super::words::Word;
use super::{details, name};
use crate::blocks::Row;
use crate::generate::plan::{Function, Owner, plan};
use crate::lower::{World, lower};
use crate::program::{Leads, Node, Op, Program, Test};
use crate::project::{Block, Diagram, DiagramKind, Project};
use crate::structure::{Jumps, structure};
use crate::tree::{Condition, Tree};
use lang_text::problem::{Locale, Problem};

/// The program of a project in sentences.
///
/// # Errors
/// What makes it unclear what the program does: links that are missing or too many, unclear threads.
pub fn outline(project: &Project, locale: Locale) -> Result<String, Vec<Problem>> {
    let lowered = lower(project, World::Robot).map_err(|problem| vec![problem])?;
    let program = &lowered.program;
    let plan = plan(program)?;
    let blocks = project.diagrams.iter().flat_map(|diagram| &diagram.blocks);
    let mut writer = Writer {
        program,
        main: project.main.and_then(|main| project.diagrams.get(main)),
        blocks: blocks.map(|block| (block.id.as_str(), block)).collect(),
        locale,
        function: None,
        out: String::new(),
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
    out: String,
}

impl<'a> Writer<'a> {
    fn word(&self, word: Word) -> &'static str {
        word.text(self.locale)
    }

    fn line(&mut self, depth: usize, text: &str) {
        let _ = writeln!(self.out, "{:width$}{text}", "", width = depth * 2);
    }

    fn subprogram(&self, name: &str) -> String {
        format!("{} {}", self.word(Word::Subprogram), super::shortened(name))
    }

    fn function(&mut self, function: &'a Function) {
        self.function = Some(function);
        let title = match &function.owner {
            Owner::Main => match self.main {
                Some(sheet) if sheet.kind == DiagramKind::Subprogram => {
                    self.subprogram(&sheet.name)
                }
                _ => self.word(Word::Program).to_owned(),
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
            self.out.push('\n');
        }
        self.line(0, &format!("{title}:"));
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

    fn body(&mut self, head: &str, list: &[Tree], depth: usize) {
        self.line(depth, &format!("{head}:"));
        self.list(list, depth + 1);
    }

    fn tree(&mut self, tree: &Tree, depth: usize) {
        match tree {
            Tree::Step(block) => self.step(*block, depth),
            Tree::If { when, yes, no } => {
                let head = format!("{} {}", self.word(Word::If), self.condition(when));
                self.body(&head, yes, depth);
                if !no.is_empty() {
                    self.body(self.word(Word::Otherwise), no, depth);
                }
            }
            Tree::Switch { on, branches } => self.switch(*on, branches, depth),
            Tree::Loop { body, .. } => self.body(self.word(Word::Forever), body, depth),
            Tree::While { when, body, .. } => {
                let head = match when {
                    Condition::Test(block) => self.head(*block),
                    Condition::Not(_) | Condition::And(..) | Condition::Or(..) => {
                        format!("{} {}", self.word(Word::While), self.condition(when))
                    }
                };
                self.body(&head, body, depth);
            }
            Tree::DoWhile { when, body, .. } => {
                self.body(self.word(Word::Repeat), body, depth);
                let foot = format!("{} {}", self.word(Word::Until), self.condition(when));
                self.line(depth, &foot);
            }
            Tree::Break(_) => self.line(depth, self.word(Word::Leave)),
            Tree::Continue(_) => self.line(depth, self.word(Word::Again)),
            Tree::End(_) => self.line(depth, self.word(Word::End)),
            Tree::Set { variable, value } => {
                let text = format!("{} {} = {value}", self.word(Word::Place), variable + 1);
                self.line(depth, &text);
            }
            Tree::Choice { variable, arms } => {
                for (value, body) in arms {
                    let (word, place) = (self.word(Word::If), self.word(Word::Place));
                    self.body(
                        &format!("{word} {place} {} = {value}", variable + 1),
                        body,
                        depth,
                    );
                }
            }
            Tree::Goto(_) | Tree::Label(_) => {}
        }
    }

    fn switch(&mut self, on: usize, branches: &[(Vec<usize>, Vec<Tree>)], depth: usize) {
        let head = format!("{} {}", self.word(Word::Depending), self.test(on));
        self.line(depth, &format!("{head}:"));
        let program = self.program;
        let guards = match self.node(on).and_then(|node| program.leads(node)) {
            Some(Leads::Switch(switch)) => &switch.branches[..],
            _ => &[],
        };
        for (ways, body) in branches {
            let named = ways.iter().filter_map(|&way| guards.get(way));
            let named: Vec<String> = named.map(|(guard, _)| super::shortened(guard)).collect();
            let head = if ways.contains(&guards.len()) {
                self.word(Word::Otherwise).to_owned()
            } else {
                format!("{} {}", self.word(Word::Case), named.join(", "))
            };
            self.body(&head, body, depth + 1);
        }
    }

    fn step(&mut self, block: usize, depth: usize) {
        let Some(node) = self.node(block) else {
            return;
        };
        if self.program.row(node).is_some_and(Row::is_mark) {
            return;
        }
        if let Some(begun) = self.function.and_then(|function| function.begun.get(&node)) {
            for (name, _) in begun {
                let text = format!("{} {}", self.word(Word::Begin), super::shortened(name));
                self.line(depth, &text);
            }
            return;
        }
        let Some(block) = self.block(block) else {
            return;
        };
        let mut said = name(block, self.locale);
        if let Op::Call { call, .. } = self.program.ops[node as usize] {
            let diagram = self.program.calls[call as usize].diagram;
            let sheet = diagram.and_then(|diagram| self.program.diagrams.get(diagram as usize));
            said = format!(
                "{said} {}",
                super::shortened(sheet.map_or("", |sheet| &sheet.name))
            );
        }
        let details = details(block);
        let colon = if details.is_empty() { "" } else { ": " };
        self.line(depth, &format!("{said}{colon}{details}"));
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
        self.block(block).map(details).unwrap_or_default()
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
