//! A model that is known to be right: every name means one thing, and every value can be computed.
//!
//! Owns its shape. Made by `check` from a [`super::syntax::ModelText`] alone, lowered by `lower`; knows no text but names,
//! documentation and places.

use super::function::Function;
use super::syntax::{Comparison, Doc, Domain, Kind, Operator, Span};

/// A checked model. Its symbols are in the order of the text; names are different from each other.
#[derive(Clone, Debug, PartialEq)]
pub struct Model {
    /// Its name.
    pub name: String,
    /// Its package, with dots, or nothing.
    pub package: Option<String>,
    /// What is said of it.
    pub doc: Option<Doc>,
    /// All declared names.
    pub symbols: Vec<Symbol>,
    /// In an order in which each needs only what stands before it; those of derivatives are last, in the order of states.
    pub equations: Vec<Equation>,
}

/// The place of a symbol in [`Model::symbols`].
pub type SymbolId = usize;

/// A declared name.
#[derive(Clone, Debug, PartialEq)]
pub struct Symbol {
    /// The name.
    pub name: String,
    /// Where it is declared.
    pub span: Span,
    /// What it is.
    pub kind: Kind,
    /// What is said of it.
    pub doc: Option<Doc>,
    /// Its unit as written.
    pub unit: Option<String>,
    /// Where it may be.
    pub domain: Option<Domain>,
    /// The number of a constant; 0 for others.
    pub value: f64,
}

/// What gives a variable, a configuration or the derivative of one.
#[derive(Clone, Debug, PartialEq)]
pub struct Equation {
    /// Of what.
    pub target: SymbolId,
    /// Whether it gives the derivative.
    pub is_derivative: bool,
    /// How.
    pub value: Expr,
    /// Where it stands.
    pub span: Span,
}

/// An expression whose names are known, never deeper than [`crate::limits::DCML_DEPTH`].
#[derive(Clone, Debug, PartialEq)]
pub enum Expr {
    /// A number, `pi` and `e` too.
    Number(f64),
    /// The value of a symbol.
    Symbol(SymbolId),
    /// The opposite.
    Negative(Box<Expr>),
    /// Two values.
    Binary(Operator, Box<Expr>, Box<Expr>),
    /// A function, with as many arguments as it takes.
    Call(Function, Vec<Expr>),
    /// The value of the first condition that holds, or the last one.
    Piecewise(Vec<(Condition, Expr)>, Box<Expr>),
}

/// Two values compared. With what is not a number none holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Condition {
    /// How.
    pub comparison: Comparison,
    /// The left side.
    pub left: Expr,
    /// The right side.
    pub right: Expr,
}

impl Model {
    /// The symbols of a kind, in the order of the text.
    pub fn of_kind(&self, kind: Kind) -> impl Iterator<Item = &Symbol> {
        self.symbols.iter().filter(move |one| one.kind == kind)
    }

    /// The configuration that has derivatives, in the order of declaration: the state.
    pub fn states(&self) -> impl Iterator<Item = &Symbol> {
        self.configs(true)
    }

    /// The configuration that is computed from the rest, in the order of declaration: the outputs.
    pub fn outputs(&self) -> impl Iterator<Item = &Symbol> {
        self.configs(false)
    }

    fn configs(&self, is_state: bool) -> impl Iterator<Item = &Symbol> {
        // Once for all: there may be a great many of both.
        let mut has_derivative = vec![false; self.symbols.len()];
        for one in self.equations.iter().filter(|one| one.is_derivative) {
            if let Some(has) = has_derivative.get_mut(one.target) {
                *has = true;
            }
        }
        let all = self.symbols.iter().zip(has_derivative);
        all.filter(move |(one, has)| one.kind == Kind::Config && *has == is_state)
            .map(|(one, _)| one)
    }
}
