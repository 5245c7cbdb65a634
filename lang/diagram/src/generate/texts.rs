//! All texts of a program that its functions use: parsed once, their variables found, kinds of variables settled.
//!
//! Owns the rounds until no kind changes. Knows no statements of a language.

use crate::limits;
use std::collections::BTreeMap;

use super::build::{Builder, Variables, Wrong};
use super::code::{Code, Kind, Typed};
use super::plan::Plan;
use super::words;
use crate::blocks::Type;
use crate::program::{ArgumentKind, AssignedKind, Leads, Node, Program, Source};
use lang_expr::parser::parse;
use lang_expr::tree::{Id, Node as Part, Tree};
use lang_expr::value::Compat;
use lang_text::problem::Problem;

/// Parsed texts and variables.
pub(super) struct Texts<'a> {
    pub(super) program: &'a Program,
    pub(super) compat: Compat,
    pub(super) variables: Variables,
    trees: BTreeMap<Source, Tree>,
    /// Variables that blocks assign, as trees of `name = 0`.
    targets: BTreeMap<(Node, u8), Tree>,
}

/// An assignment or a call in a text.
pub(super) enum Sentence {
    /// Computes something and does what that does.
    Value(Typed),
    /// A variable, indices into its table, and the value.
    Assign(usize, Vec<Code>, Typed),
}

/// The variable that a block assigns by itself, and what it gets.
fn variable(program: &Program, node: Node) -> Option<(&str, Kind)> {
    let (assignment, given) = program.given(node)?;
    let kind = match given {
        AssignedKind::Whole => Kind::Int,
        AssignedKind::Text => Kind::Text,
        AssignedKind::Any => Kind::Any,
        // Nobody answers a generated program: the plan has refused it.
        AssignedKind::Answer => return None,
    };
    Some((&assignment.variable, kind))
}

/// A problem at a text of a node.
fn problem(program: &Program, node: Node, source: Option<Source>, wrong: Wrong) -> Problem {
    let mut problem = Problem::error(wrong.words);
    problem.place = program.place(node);
    let text = source.and_then(|source| program.sources.get(source as usize));
    problem.place.property = text
        .map(|text| text.property.to_owned())
        .filter(|property| !property.is_empty());
    problem.place.position = Some(wrong.at);
    problem
}

impl<'a> Texts<'a> {
    /// All texts of the functions of a plan.
    pub(super) fn new(
        program: &'a Program,
        plan: &Plan,
        compat: Compat,
    ) -> Result<Self, Vec<Problem>> {
        let mut texts = Self {
            program,
            compat,
            variables: Variables::default(),
            trees: BTreeMap::new(),
            targets: BTreeMap::new(),
        };
        let mut nodes: Vec<Node> = plan
            .functions
            .iter()
            .flat_map(|function| function.nodes.iter().copied())
            .collect();
        nodes.sort_unstable();
        nodes.dedup();
        let mut problems = Vec::new();
        for &node in &nodes {
            problems.extend(texts.parse(node));
        }
        if !problems.is_empty() {
            return Err(problems);
        }
        texts.declare(&nodes);
        for _ in 0..limits::GENERATED_ROUNDS_MAX {
            texts.variables.changed = false;
            problems.clear();
            for &node in &nodes {
                problems.extend(texts.settle(node));
            }
            if !texts.variables.changed {
                break;
            }
        }
        if problems.is_empty() {
            Ok(texts)
        } else {
            Err(problems)
        }
    }

    fn parse(&mut self, node: Node) -> Vec<Problem> {
        let mut problems = Vec::new();
        let place = self.program.place(node);
        let mut read = |text: &str, property: &str| {
            let (tree, faults) = parse(text);
            for fault in faults {
                let mut problem = fault.problem();
                let position = problem.place.position;
                problem.place = place.clone();
                problem.place.position = position;
                problem.place.property = Some(property.to_owned()).filter(|name| !name.is_empty());
                problems.push(problem);
            }
            tree
        };
        for source in self.program.texts(node) {
            let text = &self.program.sources[source as usize];
            let tree = read(&text.text, text.property);
            self.trees.insert(source, tree);
        }
        if let Some((name, _)) = variable(self.program, node) {
            let tree = read(&format!("{name} = 0"), "");
            self.targets.insert((node, 0), tree);
        }
        problems
    }

    /// Gives numbers to all names that get values, in the order of the blocks.
    fn declare(&mut self, nodes: &[Node]) {
        for &node in nodes {
            for source in self.program.texts(node) {
                if let Some(tree) = self.trees.get(&source) {
                    for name in targets(tree) {
                        self.variables.declare(&name);
                    }
                }
            }
            if let Some(tree) = self.targets.get(&(node, 0)) {
                for name in targets(tree) {
                    self.variables.declare(&name);
                }
            }
            if let Some(Leads::Call(call, _)) = self.program.leads(node) {
                for argument in &call.arguments {
                    self.variables.declare(&argument.name);
                }
            }
        }
    }

    /// Finds kinds by what a node assigns.
    fn settle(&mut self, node: Node) -> Vec<Problem> {
        let mut problems = Vec::new();
        for source in self.program.texts(node) {
            let wanted = self.program.sources[source as usize].wanted;
            let outcome = if wanted == Type::Statements {
                self.sentences(source).map(|_| ())
            } else {
                self.value(source).map(|_| ())
            };
            if let Err(wrong) = outcome {
                problems.push(problem(self.program, node, Some(source), wrong));
            }
        }
        match self.target(node) {
            Ok(Some((variable, path, kind))) => {
                let kind = path.iter().fold(kind, |kind, _| Kind::List(Box::new(kind)));
                self.variables.takes(variable, &kind);
            }
            Ok(None) => {}
            Err(wrong) => problems.push(problem(self.program, node, None, wrong)),
        }
        if let Some(Leads::Call(call, _)) = self.program.leads(node) {
            for argument in &call.arguments {
                let kind = match argument.kind {
                    ArgumentKind::Truth => Kind::Bool,
                    ArgumentKind::Whole => Kind::Int,
                    ArgumentKind::Number => Kind::Float,
                    ArgumentKind::Text => Kind::Text,
                };
                let variable = self.variables.declare(&argument.name);
                self.variables.takes(variable, &kind);
            }
        }
        problems
    }

    /// The variable that a block assigns by itself: its number, indices, and what it gets.
    pub(super) fn target(&mut self, node: Node) -> Result<Option<(usize, Vec<Code>, Kind)>, Wrong> {
        let (Some(tree), Some((_, kind))) = (
            self.targets.get(&(node, 0)).cloned(),
            variable(self.program, node),
        ) else {
            return Ok(None);
        };
        let statements = tree.statements();
        let Some(Part::Assign { target, .. }) = statements.first().map(|&id| tree.node(id)) else {
            return Ok(None);
        };
        let mut builder = self.builder(&tree);
        let (name, path) = builder.target(*target)?;
        Ok(Some((self.variables.declare(&name), path, kind)))
    }

    fn builder<'b>(&'b mut self, tree: &'b Tree) -> Builder<'b> {
        Builder {
            tree,
            variables: &mut self.variables,
            kit: self.program.kit,
            compat: self.compat,
        }
    }

    /// The value of a text: of the last statement, or a list of several expressions.
    pub(super) fn value(&mut self, source: Source) -> Result<Typed, Wrong> {
        let tree = self.trees.get(&source).cloned().unwrap_or_default();
        match tree.statements().last() {
            Some(&last) => self.builder(&tree).value(last),
            None => Ok(Typed {
                code: Code::Nil,
                kind: Kind::Any,
            }),
        }
    }

    /// The statements of a text.
    pub(super) fn sentences(&mut self, source: Source) -> Result<Vec<Sentence>, Wrong> {
        let tree = self.trees.get(&source).cloned().unwrap_or_default();
        let mut sentences = Vec::new();
        for id in tree.statements() {
            sentences.push(self.sentence(&tree, id)?);
        }
        Ok(sentences)
    }

    fn sentence(&mut self, tree: &Tree, id: Id) -> Result<Sentence, Wrong> {
        let Part::Assign { target, value } = tree.node(id) else {
            return Ok(Sentence::Value(self.builder(tree).value(id)?));
        };
        let mut builder = self.builder(tree);
        let (name, path) = builder.target(*target)?;
        let value = builder.value(*value)?;
        if crate::ports::Port::shown_by(&name).is_some() || &*name == "pi" {
            return Err(Wrong {
                words: words::read_only(&name),
                at: tree.place(*target),
            });
        }
        let variable = self.variables.declare(&name);
        let kind = path
            .iter()
            .fold(value.kind.clone(), |kind, _| Kind::List(Box::new(kind)));
        self.variables.takes(variable, &kind);
        Ok(Sentence::Assign(variable, path, value))
    }

    /// A problem at a text of a node.
    pub(super) fn problem(&self, node: Node, source: Option<Source>, wrong: Wrong) -> Problem {
        problem(self.program, node, source, wrong)
    }

    /// Which variables a node names in its texts.
    pub(super) fn names(&self, node: Node) -> Vec<usize> {
        let mut found = Vec::new();
        let trees = self
            .program
            .texts(node)
            .into_iter()
            .filter_map(|source| self.trees.get(&source));
        for tree in trees.chain(self.targets.get(&(node, 0))) {
            for part in &tree.nodes {
                if let Part::Name(name) = part {
                    found.extend(self.variables.find(name));
                }
            }
        }
        found
    }
}

/// Names that a text assigns to.
fn targets(tree: &Tree) -> Vec<std::rc::Rc<str>> {
    let mut found = Vec::new();
    for node in &tree.nodes {
        let Part::Assign { target, .. } = node else {
            continue;
        };
        let mut at = *target;
        while let Part::Index { table, .. } = tree.node(at) {
            at = *table;
        }
        if let Part::Name(name) = tree.node(at) {
            found.push(name.clone());
        }
    }
    found
}
