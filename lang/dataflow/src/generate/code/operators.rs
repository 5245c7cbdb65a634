//! Which word an operator is.
//!
//! Owns two lists. Knows no operands.

use super::super::language::Word;
use lang_expr::tree::Binary;

/// The word of an operator that computes with numbers as they are.
pub(super) fn arithmetic(operator: Binary) -> Option<Word> {
    match operator {
        Binary::Add => Some(Word::Add),
        Binary::Subtract => Some(Word::Subtract),
        Binary::Multiply => Some(Word::Multiply),
        Binary::Divide => Some(Word::Divide),
        Binary::Power => Some(Word::Power),
        Binary::DivideWhole
        | Binary::Modulo
        | Binary::BitAnd
        | Binary::BitOr
        | Binary::BitXor
        | Binary::ShiftLeft
        | Binary::ShiftRight
        | Binary::Join
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

/// The word of an operator that computes with whole numbers.
pub(super) fn of_wholes(operator: Binary) -> Option<Word> {
    match operator {
        Binary::DivideWhole => Some(Word::DivideWhole),
        Binary::Modulo => Some(Word::Modulo),
        Binary::BitAnd => Some(Word::BitAnd),
        Binary::BitOr => Some(Word::BitOr),
        Binary::BitXor => Some(Word::BitXor),
        Binary::ShiftLeft => Some(Word::ShiftLeft),
        Binary::ShiftRight => Some(Word::ShiftRight),
        Binary::Add
        | Binary::Subtract
        | Binary::Multiply
        | Binary::Divide
        | Binary::Power
        | Binary::Join
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
