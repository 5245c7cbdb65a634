//! Whole numbers that a block gets of an expression: beyond 32 bits they stay at the end of the range.
//!
//! Owns that no power and no delay becomes another one by its size, and which numbers are known without a run. Operators
//! on whole numbers keep the low bits; they are in `run`.

use super::code::Op;
use super::literal;
use super::run::Run;
use super::tree::{Binary, Id, Node, Tree, Unary};
use super::value::{Compat, Value};

impl Run<'_> {
    /// As the whole number that a block gets.
    pub(super) fn bounded(&mut self, id: Id) -> i32 {
        match self.code.ops[id as usize] {
            Op::Float(_)
            | Op::Minus(_)
            | Op::MinusNarrow(_)
            | Op::Steps(_)
            | Op::Binary(
                Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Divide | Binary::Power,
                ..,
            ) => Value::Float(self.number(id)).to_bounded_int(),
            Op::Variable(slot) => match self.store.get(slot) {
                Some(value) => value.to_bounded_int(),
                // It tells what is missing.
                None => self.whole(id),
            },
            Op::Binary(Binary::Join, ..) => self.value(id).to_bounded_int(),
            Op::Nil
            | Op::Bool(_)
            | Op::Constant(_)
            | Op::Not(_)
            | Op::TextLength(_)
            | Op::Length(_)
            | Op::Element(..)
            | Op::Elements(..)
            | Op::Call(..)
            | Op::Table(_)
            | Op::Block(_)
            | Op::Assign(..)
            | Op::AssignElement(..)
            | Op::Broken(_) => {
                let value = self.value(id);
                self.look_at_number(&value, id);
                value.to_bounded_int()
            }
            Op::Int(_)
            | Op::Sensor(_)
            | Op::BitNot(_)
            | Op::Binary(
                Binary::DivideWhole
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
                | Binary::Equal,
                ..,
            ) => self.whole(id),
        }
    }
}

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
