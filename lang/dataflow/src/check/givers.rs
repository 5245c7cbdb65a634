//! Variables of a project: which texts give them values, which read them, and so which text has to wait for which.
//!
//! Owns the order in which texts are understood. What their types are is in `types`.

use super::fed::{Fed, fed, input};
use crate::program::{Flow, Op, Program};
use lang_expr::Source;
use lang_expr::tree::{Binary, Id, Node as Part, Tree};
use std::collections::{HashMap, HashSet};
use std::rc::Rc;

/// Whether the types of the names are known that an expression reads.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
pub(super) enum Known {
    /// Of all of them.
    All,
    /// Nothing comes to one of them, as far as it is known yet.
    NotYet,
    /// Of one of them nobody can know it.
    Never,
}

impl Known {
    /// What is known of two together.
    pub(super) fn and(self, other: Self) -> Self {
        match (self, other) {
            (Self::Never, _) | (_, Self::Never) => Self::Never,
            (Self::NotYet, _) | (_, Self::NotYet) => Self::NotYet,
            (Self::All, Self::All) => Self::All,
        }
    }
}

/// Who gives a variable its values, by what is known of them.
#[derive(Clone, Copy, Debug, Default)]
struct Givers {
    /// Expressions that are not understood yet.
    waiting: usize,
    /// Expressions of which nobody can know enough, and blocks *Variable* that get tokens where expressions give as well.
    unknown: usize,
}

impl Givers {
    /// Where an expression counts of which so much is known.
    fn of(&mut self, known: Known) -> Option<&mut usize> {
        match known {
            Known::All => None,
            Known::NotYet => Some(&mut self.waiting),
            Known::Never => Some(&mut self.unknown),
        }
    }

    fn add(&mut self, known: Known) {
        if let Some(count) = self.of(known) {
            *count += 1;
        }
    }

    fn take(&mut self, known: Known) {
        if let Some(count) = self.of(known) {
            *count = count.saturating_sub(1);
        }
    }
}

/// Who gives variables their values, and who waits for them.
pub(super) struct Variables {
    /// What was known for each expression when it was looked at last.
    pub(super) known: Vec<Known>,
    /// Variables that each expression gives values.
    gives: Vec<Vec<Rc<str>>>,
    /// Variables whose former values each expression reads, and whether it gives them values as well.
    reads: Vec<Vec<(Rc<str>, bool)>>,
    givers: HashMap<Rc<str>, Givers>,
    /// Variables that nothing but tokens gives values.
    pub(super) fed: Vec<Fed>,
    /// What is known of them.
    pub(super) known_fed: HashMap<Rc<str>, Known>,
    /// Whether texts are looked at that wait for what others give their variables.
    pub(super) is_forced: bool,
}

impl Variables {
    /// Those of a program, of whose texts nothing is known yet; `unsure`: variables whose type is not taken from tokens.
    pub(super) fn of(program: &Program, unsure: &HashSet<Rc<str>>) -> Self {
        let mut all = Self {
            known: vec![Known::NotYet; program.formulas.len()],
            gives: Vec::new(),
            reads: Vec::new(),
            givers: HashMap::new(),
            fed: Vec::new(),
            known_fed: HashMap::new(),
            is_forced: false,
        };
        all.find(program, unsure);
        all
    }

    /// Finds who reads and who gives variables.
    fn find(&mut self, program: &Program, unsure: &HashSet<Rc<str>>) {
        for text in &program.formulas {
            let source = Source::new(&text.text, text.wanted);
            let gives = gives(source.tree());
            for name in &gives {
                let givers = self.givers.entry(name.clone()).or_default();
                givers.add(Known::NotYet);
            }
            let reads = reads(source.tree()).into_iter();
            let variables = reads.filter(|name| !text.own.contains(&&**name));
            self.reads.push(
                variables
                    .map(|name| (name.clone(), gives.contains(&name)))
                    .collect(),
            );
            self.gives.push(gives.into_iter().collect());
        }
        self.fed = fed(program, |name| self.givers.contains_key(name), unsure);
        let fed = self.fed.iter();
        self.known_fed = fed.map(|one| (one.name.clone(), Known::NotYet)).collect();
        for node in &program.nodes {
            // With a name alone and no tokens it gives nothing.
            if let Op::Flow(Flow::Variable { names, run: None }) = &node.op
                && input(node.row).is_some_and(|port| node.is_linked(port))
            {
                for name in names {
                    let givers = self.givers.entry(name.clone()).or_default();
                    if !self.known_fed.contains_key(name) {
                        givers.add(Known::Never);
                    }
                }
            }
        }
    }

    /// Notes what is known of an expression.
    pub(super) fn note(&mut self, index: usize, known: Known) {
        let before = std::mem::replace(&mut self.known[index], known);
        if before == known {
            return;
        }
        for name in &self.gives[index] {
            if let Some(givers) = self.givers.get_mut(name) {
                givers.take(before);
                givers.add(known);
            }
        }
    }

    /// Whether something gives a variable values.
    pub(super) fn are_given(&self, name: &str) -> bool {
        self.givers.contains_key(name)
    }

    /// Variables that something gives values, as often as it does.
    pub(super) fn given(&self) -> impl Iterator<Item = &str> {
        let texts = self.gives.iter().flatten().map(|name| &**name);
        texts.chain(self.fed.iter().map(|one| &*one.name))
    }

    /// Whether a text reads the former value of one of these variables.
    pub(super) fn reads_any(&self, index: usize, names: &HashSet<Rc<str>>) -> bool {
        self.reads[index]
            .iter()
            .any(|(name, _)| names.contains(name))
    }

    /// What is known of a text whose own names are known so far, with the variables that it reads; `is_settled`: whether
    /// the type of one is known already. What others give it must be understood first: if it is read before, it is taken
    /// for any number, and stays that.
    pub(super) fn and(&self, index: usize, own: Known, is_settled: impl Fn(&str) -> bool) -> Known {
        let reads = self.reads[index].iter();
        let variables = reads.fold(Known::All, |known, (name, gives)| {
            known.and(match self.known_fed.get(name) {
                // Nothing comes there before this text is understood, so nobody can know its type.
                Some(Known::NotYet) if self.is_forced => Known::Never,
                Some(&known) => known,
                None if is_settled(name) => Known::All,
                None => self.variable(name, gives.then_some(index)),
            })
        });
        match variables {
            Known::NotYet if self.is_forced => own,
            Known::All | Known::NotYet | Known::Never => own.and(variables),
        }
    }

    /// What is known of a variable by those that give it values; `reader`: without this one.
    fn variable(&self, name: &str, reader: Option<usize>) -> Known {
        let mut givers = self.givers.get(name).copied().unwrap_or_default();
        if let Some(reader) = reader {
            givers.take(self.known[reader]);
        }
        match givers {
            Givers { unknown: 1.., .. } => Known::Never,
            Givers { waiting: 1.., .. } => Known::NotYet,
            // All are understood, and it is still without a type: then the reader is told so.
            Givers { .. } => Known::All,
        }
    }
}

/// Variables that a text gives values.
pub(super) fn gives(tree: &Tree) -> HashSet<Rc<str>> {
    let targets = tree.nodes.iter().filter_map(|part| {
        let Part::Assign { target, .. } = part else {
            return None;
        };
        assigned(tree, *target).cloned()
    });
    targets.collect()
}

/// The variable that an assignment to `target` changes, wholly or in part.
pub(super) fn assigned(tree: &Tree, target: Id) -> Option<&Rc<str>> {
    let mut at = target;
    while let Part::Index { table, .. } = tree.node(at) {
        at = *table;
    }
    let Part::Name(name) = tree.node(at) else {
        return None;
    };
    Some(name)
}

/// The names whose former values a text reads: all but those that it assigns before.
fn reads(tree: &Tree) -> HashSet<Rc<str>> {
    reads_by(tree, |id, visit| tree.children(id, visit))
}

/// The same, without those that stand where `and` and `or` may not come.
pub(super) fn surely_reads(tree: &Tree) -> HashSet<Rc<str>> {
    reads_by(tree, |id, visit| {
        if let Part::Binary(Binary::And | Binary::Or, left, _) = tree.node(id) {
            visit(*left);
        } else {
            tree.children(id, visit);
        }
    })
}

/// The same, where `children` calls for each part that is looked into.
fn reads_by(tree: &Tree, children: impl Fn(Id, &mut dyn FnMut(Id))) -> HashSet<Rc<str>> {
    let mut made: HashSet<Rc<str>> = HashSet::new();
    let mut read = HashSet::new();
    for statement in tree.statements() {
        let mut open = vec![statement];
        let mut makes = None;
        if let Part::Assign { target, value } = tree.node(statement)
            && let Part::Name(name) = tree.node(*target)
        {
            open = vec![*value];
            makes = Some(name.clone());
        }
        while let Some(id) = open.pop() {
            children(id, &mut |child| open.push(child));
            if let Part::Name(name) = tree.node(id)
                && !made.contains(name)
            {
                read.insert(name.clone());
            }
        }
        made.extend(makes);
    }
    read
}
