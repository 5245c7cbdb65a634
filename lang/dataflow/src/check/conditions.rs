//! Conditions that are probably not meant: the same for every token, or a comparison of what is of different kinds.
//!
//! Owns what is looked for in a condition. That it is understood, and the types of its parts, are the business of `types`.

use super::found::Found;
use super::words;
use crate::blocks::Does;
use crate::program::{Program, Text};
use lang_expr::tree::{Binary, Id, Node as Part, Tree};
use lang_expr::value::number_of;
use lang_expr::{Names, Source, Type};

/// What one side of a comparison is.
#[derive(Clone, Copy, Debug, Eq, PartialEq)]
enum Side {
    Number,
    /// A text that nobody knows before; it may be a number.
    Text,
    /// A text that stands there and is no number.
    Word,
    List,
}

impl Side {
    /// Of a part of an expression; none if it is not known, or is compared with everything.
    fn of(part: Id, source: &Source, names: &Names) -> Option<Self> {
        if let Part::Text(text) = source.tree().node(part) {
            return Some(match number_of(text) {
                Some(_) => Self::Text,
                None => Self::Word,
            });
        }
        match source.type_of(part, names) {
            Type::Int | Type::Float => Some(Self::Number),
            Type::Text => Some(Self::Text),
            Type::Table(_) => Some(Self::List),
            Type::Any | Type::Open | Type::Bool | Type::Nil | Type::Function => None,
        }
    }

    /// Whether nothing of the one kind is anything of the other one.
    fn differs(self, other: Self) -> bool {
        match (self, other) {
            (Self::List, Self::List) => false,
            (Self::List, _) | (_, Self::List) => true,
            (Self::Number, Self::Word) | (Self::Word, Self::Number) => true,
            (Self::Number | Self::Text | Self::Word, _) => false,
        }
    }

    /// Whether neither comes before the other: a number and a text, even one that is a number.
    fn has_no_order(self, other: Self) -> bool {
        matches!(
            (self, other),
            (Self::Number, Self::Text) | (Self::Text, Self::Number)
        )
    }

    fn words(self) -> [&'static str; 2] {
        match self {
            Self::Number => words::A_NUMBER,
            Self::Text => words::A_TEXT,
            Self::Word => words::A_WORD,
            Self::List => words::A_LIST,
        }
    }
}

/// What is strange about a condition that is understood.
pub(super) fn look(
    program: &Program,
    text: &Text,
    (source, names): (&Source, &Names),
    found: &mut Found,
) {
    let tree = source.tree();
    if is_constant(tree) && !is_usual(program, text, tree) {
        let place = program.property_place(text.node, text.property, None);
        found.warn(place, words::constant_condition());
        return;
    }
    for (part, at) in tree.nodes.iter().zip(&tree.places) {
        let Part::Binary(operator, left, right) = part else {
            continue;
        };
        let sides = [*left, *right].map(|side| Side::of(side, source, names));
        if let [Some(one), Some(other)] = sides
            && compares(*operator)
            && one.differs(other)
        {
            let place = program.property_place(text.node, text.property, Some(*at));
            found.warn(place, words::kinds_differ(one.words(), other.words()));
        } else if let [Some(one), Some(other)] = sides
            && orders(*operator)
            && one.has_no_order(other)
        {
            let place = program.property_place(text.node, text.property, Some(*at));
            found.warn(place, words::no_order(operator.sign()));
        }
    }
}

/// Whether a condition reads nothing that could change: no token, variable, sensor or clock.
fn is_constant(tree: &Tree) -> bool {
    let reads = |part: &Part| matches!(part, Part::Name(_) | Part::Call { .. });
    !tree.statements().is_empty() && !tree.nodes.iter().any(reads)
}

/// Whether it is the `true` of a gate that has no condition, or of a way of a switch, as the last one often has.
fn is_usual(program: &Program, text: &Text, tree: &Tree) -> bool {
    let does = program.node(text.node).row.does;
    let statements = tree.statements();
    let is_true = statements.len() == 1 && *tree.node(statements[0]) == Part::Bool(true);
    is_true && matches!(does, Does::Filter | Does::Switch)
}

/// Whether an operator asks which of two is the smaller one.
fn orders(operator: Binary) -> bool {
    compares(operator) && !matches!(operator, Binary::Equal | Binary::NotEqual)
}

fn compares(operator: Binary) -> bool {
    matches!(
        operator,
        Binary::Equal
            | Binary::NotEqual
            | Binary::Less
            | Binary::LessEqual
            | Binary::Greater
            | Binary::GreaterEqual
    )
}
