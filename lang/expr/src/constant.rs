//! Numbers that are known without a run.
//!
//! Owns what is followed for that: numbers, `-`, `+`, `*` and `/` alone. Knows no names.

use super::literal;
use super::tree::{Binary, Id, Node, Tree, Unary};
use super::value::Compat;

/// The number that a part of a text is whatever runs, as it is written: of numbers, `-`, `+`, `*` and `/` alone.
pub fn constant(tree: &Tree, id: Id) -> Option<f64> {
    match tree.node(id) {
        Node::Int(text) => Some(literal::whole(text, Compat::Fixed).to_float()),
        Node::Float(text) => Some(literal::float(text, Compat::Fixed)),
        Node::Unary(Unary::Minus, operand) => constant(tree, *operand).map(|number| -number),
        Node::Binary(operator, left, right) => {
            let (left, right) = (constant(tree, *left)?, constant(tree, *right)?);
            match operator {
                Binary::Add => Some(left + right),
                Binary::Subtract => Some(left - right),
                Binary::Multiply => Some(left * right),
                Binary::Divide if right != 0.0 => Some(left / right),
                Binary::Divide
                | Binary::Power
                | Binary::Join
                | Binary::DivideWhole
                | Binary::Modulo
                | Binary::BitAnd
                | Binary::BitOr
                | Binary::BitXor
                | Binary::ShiftLeft
                | Binary::ShiftRight
                | Binary::Or
                | Binary::And
                | Binary::Less
                | Binary::Greater
                | Binary::LessEqual
                | Binary::GreaterEqual
                | Binary::NotEqual
                | Binary::Equal => None,
            }
        }
        Node::Nil
        | Node::Bool(_)
        | Node::Text(_)
        | Node::RawText(_)
        | Node::Name(_)
        | Node::Unary(Unary::Not | Unary::Length | Unary::BitNot, _)
        | Node::Index { .. }
        | Node::Call { .. }
        | Node::Method { .. }
        | Node::Table { .. }
        | Node::Assign { .. }
        | Node::Block(_) => None,
    }
}
