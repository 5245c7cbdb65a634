//! Parts of a text as whole numbers: of 32 bits, as operators on bits and blocks take them.
//!
//! Owns what a number beyond 32 bits becomes, and the operators on whole numbers; all others are in `run`.

use super::code::Op;
use super::run::Run;
use super::tree::{Binary, Id};
use super::value::{Value, round};
use super::words::Reason;

/// What a number beyond 32 bits is as a whole one.
trait Beyond {
    fn number(number: f64) -> i32;
    fn value(value: &Value) -> i32;
}

/// Its low bits, as the real program's cast has it.
struct LowBits;

impl Beyond for LowBits {
    fn number(number: f64) -> i32 {
        round(number)
    }

    fn value(value: &Value) -> i32 {
        value.to_int()
    }
}

/// The end of the range: no power and no delay becomes another one by its size.
struct EndOfRange;

impl Beyond for EndOfRange {
    fn number(number: f64) -> i32 {
        Value::Float(number).to_bounded_int()
    }

    fn value(value: &Value) -> i32 {
        value.to_bounded_int()
    }
}

impl Run<'_> {
    /// As a whole number, with what is beyond 32 bits cut off.
    pub(super) fn whole(&mut self, id: Id) -> i32 {
        self.whole_with::<LowBits>(id)
    }

    /// As the whole number that a block gets.
    pub(super) fn whole_of_block(&mut self, id: Id) -> i32 {
        match self.names.keeps_low_bits {
            true => self.whole_with::<LowBits>(id),
            false => self.whole_with::<EndOfRange>(id),
        }
    }

    fn whole_with<B: Beyond>(&mut self, id: Id) -> i32 {
        let (operator, left, right) = match self.code.ops[id as usize] {
            Op::Int(number) => return number,
            Op::Variable(slot) => {
                return match self.store.get(slot) {
                    Some(value) => B::value(value),
                    None => {
                        self.uninitialized(slot, id);
                        0
                    }
                };
            }
            Op::Sensor(sensor) => return self.outside.sensor(sensor).to_int(),
            Op::BitNot(operand) => return !self.whole(operand),
            Op::Float(_) | Op::Minus(_) | Op::MinusNarrow(_) | Op::Steps(_) => {
                return B::number(self.number(id));
            }
            Op::Binary(operator, left, right) => (operator, left, right),
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
                return B::value(&value);
            }
        };
        match operator {
            Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Divide | Binary::Power => {
                B::number(self.number(id))
            }
            Binary::Join => B::value(&self.value(id)),
            Binary::DivideWhole => self.divided(id, left, right),
            Binary::Modulo => self.rest(id, left, right),
            Binary::BitAnd => self.bits(left, right, |left, right| left & right),
            Binary::BitOr => self.bits(left, right, |left, right| left | right),
            Binary::BitXor => self.bits(left, right, |left, right| left ^ right),
            Binary::ShiftLeft => {
                let is_fixed = self.is_fixed;
                self.bits(left, right, |left, right| match is_fixed {
                    true if !(0..32).contains(&right) => 0,
                    _ => left.wrapping_shl(right as u32),
                })
            }
            Binary::ShiftRight => {
                let is_fixed = self.is_fixed;
                self.bits(left, right, |left, right| match is_fixed {
                    true if !(0..32).contains(&right) => -i32::from(left < 0),
                    _ => left.wrapping_shr(right as u32),
                })
            }
            Binary::Or
            | Binary::And
            | Binary::Less
            | Binary::Greater
            | Binary::LessEqual
            | Binary::GreaterEqual
            | Binary::NotEqual
            | Binary::Equal => i32::from(self.truth(id)),
        }
    }

    fn bits(&mut self, left: Id, right: Id, operator: impl Fn(i32, i32) -> i32) -> i32 {
        let left = self.whole(left);
        operator(left, self.whole(right))
    }

    /// Dividend and divisor; nothing, and a fault, if that is 0.
    fn division(&mut self, id: Id, left: Id, right: Id) -> Option<(i32, i32)> {
        let left = self.whole(left);
        let right = self.whole(right);
        if right == 0 {
            self.fault(Reason::DivisionByZero, id);
            return None;
        }
        Some((left, right))
    }

    pub(super) fn divided(&mut self, id: Id, left: Id, right: Id) -> i32 {
        let Some((left, right)) = self.division(id, left, right) else {
            return 0;
        };
        let cut = left.wrapping_div(right);
        let is_above = left.wrapping_rem(right) != 0 && (left < 0) != (right < 0);
        cut - i32::from(self.is_fixed && is_above)
    }

    pub(super) fn rest(&mut self, id: Id, left: Id, right: Id) -> i32 {
        let Some((left, right)) = self.division(id, left, right) else {
            return 0;
        };
        let rest = left.wrapping_rem(right);
        if self.is_fixed && rest != 0 && (rest < 0) != (right < 0) {
            return rest + right;
        }
        rest
    }
}
