//! The language of expressions: text in the properties of blocks, Lua in its looks, with TRIK Studio's own meanings.
//!
//! A [`Source`] is one text, read once; [`analyse`] infers types with what all texts of the project have taught
//! [`Names`], and compiles; [`evaluate`] runs it on the project's [`Store`]. Docs for users: docs/user/expressions.md.
//! Knows no blocks, no diagrams and no robot: the robot is the trait [`Outside`].

#![deny(clippy::wildcard_enum_match_arm)]
// Problems are rare, and their size costs nothing where none is.
#![allow(clippy::result_large_err)]

mod advice;
mod analyse;
mod call;
mod code;
mod constant;
mod elements;
mod escape;
mod flat;
pub mod fuzz;
mod lexer;
pub mod limits;
pub mod literal;
pub mod names;
pub mod parser;
pub mod reserved;
mod run;
pub mod store;
pub mod tree;
pub mod types;
pub mod value;
mod whole;
pub mod words;

pub use advice::{explained, refused};
pub use constant::constant;
pub use escape::{escape, unescape};
pub use names::{Kind, Names, Slot};
pub use reserved::Kit;
pub use run::Outside;
pub use store::Store;
pub use types::Type;
pub use value::{Compat, Value};

use analyse::{Analysis, PartType};
use code::Code;
use lang_text::problem::{Problem, Severity};
use run::Run;
use std::rc::Rc;
use tree::{Id, Tree};
use words::{Fault, Reason};

/// What a block asks an expression for.
#[derive(Clone, Copy, Debug, Default, Eq, Hash, PartialEq)]
pub enum Wanted {
    /// Nothing: statements are run for what they do.
    Statements,
    /// A truth.
    Bool,
    /// A whole number.
    Int,
    /// A number.
    Float,
    /// A text.
    Text,
    /// A list of texts, as of ports.
    List,
    /// Whatever it is.
    #[default]
    Any,
}

/// One text: its tree, what is known of its types, and its code. Belongs to the [`Names`] it was first analysed with.
#[derive(Clone, Debug)]
pub struct Source {
    text: Rc<str>,
    wanted: Wanted,
    tree: Tree,
    unreadable: Vec<Fault>,
    parts: Vec<PartType>,
    /// The number of this reading; 0: it has to be read anew.
    reading: u32,
    good_at: Option<u32>,
    faults: Vec<Fault>,
    code: Code,
}

impl Source {
    /// Reads a text. What is wrong with it is told by [`analyse`].
    pub fn new(text: &str, wanted: Wanted) -> Self {
        let (tree, unreadable) = parser::parse(text);
        Self {
            text: text.into(),
            wanted,
            tree,
            unreadable,
            parts: Vec::new(),
            reading: 0,
            good_at: None,
            faults: Vec::new(),
            code: Code::default(),
        }
    }

    /// The same text, read but not analysed.
    #[must_use]
    pub fn anew(&self) -> Self {
        Self {
            text: self.text.clone(),
            wanted: self.wanted,
            tree: self.tree.clone(),
            unreadable: self.unreadable.clone(),
            parts: Vec::new(),
            reading: 0,
            good_at: None,
            faults: Vec::new(),
            code: Code::default(),
        }
    }

    /// Reads a text in which some names are somebody's own: what `own` gives for a name stands for it, everywhere but where
    /// a function is called. Such a name is made by [`names::own_name`], so that no text can say it, and messages show it
    /// as it is written.
    pub fn with_own_names(
        text: &str,
        wanted: Wanted,
        own: &dyn Fn(&str) -> Option<Rc<str>>,
    ) -> Self {
        let mut source = Self::new(text, wanted);
        for node in &mut source.tree.nodes {
            if let tree::Node::Name(name) = node
                && let Some(other) = own(name)
            {
                *name = other;
            }
        }
        source
    }

    /// Forgets what is known of types: the next [`analyse`] begins anew, as after [`Names::retype`] of a name in it.
    pub fn reread(&mut self) {
        self.reading = 0;
        self.good_at = None;
    }

    /// Every name in the text, as often as it is there; functions that it calls among them.
    pub fn names(&self) -> impl Iterator<Item = &str> {
        self.tree.nodes.iter().filter_map(|node| match node {
            tree::Node::Name(name) => Some(&**name),
            tree::Node::Nil
            | tree::Node::Bool(_)
            | tree::Node::Int(_)
            | tree::Node::Float(_)
            | tree::Node::Text(_)
            | tree::Node::RawText(_)
            | tree::Node::Unary(..)
            | tree::Node::Binary(..)
            | tree::Node::Index { .. }
            | tree::Node::Call { .. }
            | tree::Node::Method { .. }
            | tree::Node::Table { .. }
            | tree::Node::Assign { .. }
            | tree::Node::Block(_) => None,
        })
    }

    /// The text.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// What it is asked for.
    pub fn wanted(&self) -> Wanted {
        self.wanted
    }

    /// The tree; without a root if the text cannot be read.
    pub fn tree(&self) -> &Tree {
        &self.tree
    }

    /// All that the last analysis found, warnings too.
    pub fn faults(&self) -> &[Fault] {
        &self.faults
    }

    /// The warnings of the last analysis.
    pub fn warnings(&self) -> Vec<Problem> {
        self.faults
            .iter()
            .filter(|fault| fault.reason.severity() == Severity::Warning)
            .map(Fault::problem)
            .collect()
    }

    /// Numbers of the last analysis that count as something else than they say, as errors: of a text that somebody has just
    /// typed, which no outdated program relies on.
    pub fn odd_numbers(&self) -> Vec<Problem> {
        let is_odd = |fault: &&Fault| matches!(fault.reason, Reason::OddNumber(..));
        let odd = self.faults.iter().filter(is_odd);
        odd.map(|fault| Problem {
            severity: Severity::Error,
            ..fault.problem()
        })
        .collect()
    }

    /// That a block wants a whole number and the text is one, whatever runs, that does not fit in 32 bits; it would count
    /// as the end of the range.
    pub fn out_of_range(&self) -> Option<Problem> {
        let root = self.tree.root.filter(|_| self.wanted == Wanted::Int)?;
        let number = constant(&self.tree, root)?;
        let range = f64::from(i32::MIN)..=f64::from(i32::MAX);
        let reason = Reason::OutOfRange(number);
        (!range.contains(&number.round()))
            .then(|| Fault::new(reason, self.tree.place(root)).problem())
    }

    /// The settled type of a part after a good analysis, or [`Type::Any`].
    pub fn type_of(&self, part: Id, names: &Names) -> Type {
        let possible = match self.parts.get(part as usize) {
            Some(PartType::Same(other)) => self.parts.get(*other as usize),
            other => other,
        };
        let possible = match possible {
            Some(PartType::Own(possible)) => *possible,
            Some(PartType::Shared(variable)) => names.types.get(*variable),
            _ => return Type::Any,
        };
        if possible.is_settled() {
            possible.first()
        } else {
            Type::Any
        }
    }
}

#[cfg(test)]
mod tests;

fn problems(faults: &[Fault]) -> Vec<Problem> {
    faults.iter().map(Fault::problem).collect()
}

/// What an analysis found, with advice.
fn advised(source: &Source, names: &Names) -> Vec<Problem> {
    let faults = source.faults.iter();
    faults
        .map(|fault| explained(fault, &source.tree, names))
        .collect()
}

/// Infers the types of a text and prepares it for [`evaluate`]; cheap when no type has changed since the last time.
///
/// Errors come in the real program's order; texts with errors teach their types all the same, as there.
#[inline]
pub fn analyse(source: &mut Source, names: &mut Names) -> Result<(), Vec<Problem>> {
    if source.good_at == Some(names.epoch()) {
        return Ok(());
    }
    analyse_anew(source, names)
}

#[cold]
fn analyse_anew(source: &mut Source, names: &mut Names) -> Result<(), Vec<Problem>> {
    source.good_at = None;
    if !source.unreadable.is_empty() {
        source.faults.clone_from(&source.unreadable);
        return Err(problems(&source.faults));
    }
    if source.reading == 0 {
        source.reading = names.reading();
        source.parts.clear();
    }
    let mut analysis = Analysis::new(&source.tree, &mut source.parts, names, source.reading);
    analysis.run();
    let faults = std::mem::take(&mut analysis.faults);
    let is_good = faults
        .iter()
        .all(|fault| fault.reason.severity() != Severity::Error);
    if is_good {
        source.code = code::compile(&analysis);
        flat::flatten(&mut source.code);
        source.good_at = Some(names.epoch());
    } else {
        // As in the real program, which reads a text with errors anew each time.
        source.reading = 0;
    }
    source.faults = faults;
    if is_good {
        Ok(())
    } else {
        Err(advised(source, names))
    }
}

/// Runs a text that was analysed and gives the value that was wanted. Variables that were set before an error stay set.
pub fn evaluate(
    source: &Source,
    names: &Names,
    store: &mut Store,
    outside: &mut dyn Outside,
) -> Result<Value, Vec<Problem>> {
    let mut value = Value::Nil;
    evaluate_to(source, names, store, outside, &mut value)?;
    Ok(value)
}

/// The same, written where it is wanted, because handing a value through several calls costs more than its arithmetic.
pub fn evaluate_to(
    source: &Source,
    names: &Names,
    store: &mut Store,
    outside: &mut dyn Outside,
    into: &mut Value,
) -> Result<(), Vec<Problem>> {
    run(source, names, store, outside, |run, root| {
        // Each arm writes it: to move a value that was just written stalls the processor (see the benchmark `converter`).
        match source.wanted {
            Wanted::Statements | Wanted::Any => match run.number_alone(root) {
                Some(number) => *into = Value::Float(number),
                None => *into = run.value(root),
            },
            Wanted::Bool => *into = Value::Bool(run.truth(root)),
            Wanted::Int => *into = Value::Int(run.whole_of_block(root)),
            Wanted::Float => *into = Value::Float(run.number(root)),
            Wanted::Text => *into = run.value(root).into_text(),
            Wanted::List => {
                let texts = run.value(root).to_texts();
                let items = texts.into_iter().map(Value::Text).collect();
                *into = Value::List(Rc::new(value::List::new(items).unwrap_or_default()));
            }
        }
    })
}

/// Runs a text for a truth; takes no memory for numbers.
pub fn evaluate_bool(
    source: &Source,
    names: &Names,
    store: &mut Store,
    outside: &mut dyn Outside,
) -> Result<bool, Vec<Problem>> {
    run(source, names, store, outside, |run, root| run.truth(root))
}

/// Runs a text for a whole number, which beyond 32 bits stays at the end of the range, unless
/// [`Names::with_low_bits`]; takes no memory for numbers.
pub fn evaluate_int(
    source: &Source,
    names: &Names,
    store: &mut Store,
    outside: &mut dyn Outside,
) -> Result<i32, Vec<Problem>> {
    run(source, names, store, outside, |run, root| {
        run.whole_of_block(root)
    })
}

#[inline]
fn run<T>(
    source: &Source,
    names: &Names,
    store: &mut Store,
    outside: &mut dyn Outside,
    job: impl FnOnce(&mut Run<'_>, Id) -> T,
) -> Result<T, Vec<Problem>> {
    if source.good_at.is_none() {
        let not_analysed = Fault::new(
            Reason::NotAnalysed,
            lang_text::problem::Position { line: 1, column: 1 },
        );
        return Err(if source.faults.is_empty() {
            vec![not_analysed.problem()]
        } else {
            problems(&source.faults)
        });
    }
    let mut run = Run::new(&source.code, names, store, outside);
    let value = job(&mut run, source.code.root);
    if run.faults.is_empty() {
        Ok(value)
    } else {
        Err(problems(&run.faults))
    }
}
