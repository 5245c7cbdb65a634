//! Runs compiled texts: values as TRIK Studio computes them.
//!
//! A part is asked for what its user needs (a number, a whole number, a truth, any value), so that numbers take no
//! memory. As in the real program, an error counts as 0 and the rest still runs; the errors come out at the end.

use super::code::{Code, Op};
use super::names::Names;
use super::reserved::SensorIndex;
use super::store::Store;
use super::tree::{Binary, Id};
use super::value::{Compat, Value};
use super::words::{Fault, Reason};
use crate::limits;
use std::rc::Rc;

/// What expressions ask of the robot.
pub trait Outside {
    /// The present value of a sensor variable (index into [`super::reserved::SENSORS`]): a whole number or a table of them.
    fn sensor(&mut self, sensor: SensorIndex) -> Value;

    /// ms since the program began.
    fn time(&mut self) -> i32;

    /// A line for the robot's console, without its end.
    fn print(&mut self, text: &str);

    /// A random number from 0 to `below - 1`; `below` is at least 1.
    fn random(&mut self, below: i32) -> i32;
}

pub(super) struct Run<'a> {
    pub(super) code: &'a Code,
    pub(super) names: &'a Names,
    pub(super) store: &'a mut Store,
    pub(super) outside: &'a mut dyn Outside,
    pub(super) is_fixed: bool,
    cells: u32,
    pub(super) faults: Vec<Fault>,
}

impl<'a> Run<'a> {
    pub(super) fn new(
        code: &'a Code,
        names: &'a Names,
        store: &'a mut Store,
        outside: &'a mut dyn Outside,
    ) -> Self {
        Self {
            code,
            names,
            store,
            outside,
            is_fixed: names.compat() == Compat::Fixed,
            cells: limits::EVALUATION_CELLS_MAX,
            faults: Vec::new(),
        }
    }

    #[cold]
    pub(super) fn fault(&mut self, reason: Reason, id: Id) {
        if self.faults.len() < limits::EXPRESSION_PROBLEMS_MAX {
            let at = self.code.places[id as usize];
            self.faults.push(Fault::new(reason, at));
        }
    }

    #[cold]
    pub(super) fn uninitialized(&mut self, slot: u32, id: Id) {
        let name = self.names.name(slot).to_owned();
        self.fault(Reason::Uninitialized(name), id);
    }

    #[cold]
    fn broken(&mut self, index: u32, id: Id) {
        let reason = self.code.faults.get(index as usize).cloned();
        self.fault(reason.unwrap_or(Reason::NotInterpreted), id);
    }

    /// Pays for work on large values.
    pub(super) fn pay(&mut self, cells: u32, id: Id) -> bool {
        if let Some(left) = self.cells.checked_sub(cells) {
            self.cells = left;
            return true;
        }
        self.fault(Reason::TooMuchWork, id);
        false
    }

    /// As a number.
    pub(super) fn number(&mut self, id: Id) -> f64 {
        match self.code.ops[id as usize] {
            Op::Float(number) => number,
            Op::Int(number) => f64::from(number),
            Op::Variable(slot) => match self.store.get(slot) {
                Some(value) => value.to_float(),
                None => {
                    self.uninitialized(slot, id);
                    0.0
                }
            },
            Op::Sensor(sensor) => self.outside.sensor(sensor).to_float(),
            Op::Minus(operand) => {
                let number = self.number(operand);
                if number == 0.0 { 0.0 } else { -number }
            }
            Op::MinusNarrow(operand) => -f64::from(self.number(operand) as f32),
            Op::Binary(operator, left, right) => self.binary_number(id, operator, left, right),
            Op::Call(function, span) => self.call_number(id, function, span),
            Op::Steps(span) => self.steps(span),
            Op::Nil
            | Op::Bool(_)
            | Op::Constant(_)
            | Op::Not(_)
            | Op::TextLength(_)
            | Op::Length(_)
            | Op::BitNot(_)
            | Op::Element(..)
            | Op::Elements(..)
            | Op::Table(_)
            | Op::Block(_)
            | Op::Assign(..)
            | Op::AssignElement(..)
            | Op::Broken(_) => {
                let value = self.value(id);
                self.look_at_number(&value, id);
                value.to_float()
            }
        }
    }

    /// Where names are strict, what is no number is an error and not 0.
    pub(super) fn look_at_number(&mut self, value: &Value, id: Id) {
        let is_number = match value {
            Value::Int(_) | Value::Float(_) | Value::Bool(_) => true,
            Value::Nil | Value::Text(_) | Value::Unset | Value::List(_) => false,
        };
        if self.names.is_strict && !is_number && self.faults.is_empty() {
            let what = value.brief();
            self.fault(Reason::NoNumber(what), id);
        }
    }

    #[inline]
    fn binary_number(&mut self, id: Id, operator: Binary, left: Id, right: Id) -> f64 {
        match operator {
            Binary::Add => self.number(left) + self.number(right),
            Binary::Subtract => self.number(left) - self.number(right),
            Binary::Multiply => self.number(left) * self.number(right),
            Binary::Divide => {
                let (left, right) = (self.number(left), self.number(right));
                if right == 0.0 {
                    self.fault(Reason::DivisionByZero, id);
                    return 0.0;
                }
                left / right
            }
            Binary::Power => {
                let left = self.number(left);
                libm::pow(left, self.number(right))
            }
            Binary::Join => self.value(id).to_float(),
            Binary::DivideWhole
            | Binary::Modulo
            | Binary::BitAnd
            | Binary::BitOr
            | Binary::BitXor
            | Binary::ShiftLeft
            | Binary::ShiftRight => f64::from(self.whole(id)),
            Binary::Or
            | Binary::And
            | Binary::Less
            | Binary::Greater
            | Binary::LessEqual
            | Binary::GreaterEqual
            | Binary::NotEqual
            | Binary::Equal => f64::from(u8::from(self.truth(id))),
        }
    }

    /// As a truth: of a comparison, of `and` and `or`, or of any value as a condition takes it.
    pub(super) fn truth(&mut self, id: Id) -> bool {
        let (operator, left, right) = match self.code.ops[id as usize] {
            Op::Bool(truth) => return truth,
            Op::Not(operand) => return !self.truth(operand),
            Op::Binary(operator, left, right) => (operator, left, right),
            Op::Nil
            | Op::Int(_)
            | Op::Float(_)
            | Op::Constant(_)
            | Op::Variable(_)
            | Op::Sensor(_)
            | Op::Minus(_)
            | Op::MinusNarrow(_)
            | Op::TextLength(_)
            | Op::Length(_)
            | Op::BitNot(_)
            | Op::Element(..)
            | Op::Elements(..)
            | Op::Call(..)
            | Op::Table(_)
            | Op::Block(_)
            | Op::Assign(..)
            | Op::AssignElement(..)
            | Op::Steps(_)
            | Op::Broken(_) => return self.value_truth(id),
        };
        match operator {
            Binary::And => self.side(left) && self.side(right),
            Binary::Or => self.side(left) || self.side(right),
            Binary::Less => self.ordered(left, right, |one, two| one < two, |order| order.is_lt()),
            Binary::Greater => {
                self.ordered(left, right, |one, two| one > two, |order| order.is_gt())
            }
            Binary::LessEqual => {
                self.ordered(left, right, |one, two| one <= two, |order| order.is_le())
            }
            Binary::GreaterEqual => {
                self.ordered(left, right, |one, two| one >= two, |order| order.is_ge())
            }
            Binary::Equal => self.equal(id, left, right),
            Binary::NotEqual => !self.equal(id, left, right),
            Binary::BitOr
            | Binary::BitXor
            | Binary::BitAnd
            | Binary::ShiftLeft
            | Binary::ShiftRight
            | Binary::Join
            | Binary::Add
            | Binary::Subtract
            | Binary::Multiply
            | Binary::Divide
            | Binary::DivideWhole
            | Binary::Modulo
            | Binary::Power => self.value_truth(id),
        }
    }

    fn value_truth(&mut self, id: Id) -> bool {
        let value = self.value(id);
        if let Value::Float(number) = value
            && self.is_fixed
        {
            return number != 0.0;
        }
        value.to_bool()
    }

    /// A side of `and` or `or`: goes through a whole number.
    fn side(&mut self, id: Id) -> bool {
        if self.is_fixed {
            return self.truth(id);
        }
        if let Op::Bool(_) | Op::Not(_) = self.code.ops[id as usize] {
            return self.truth(id);
        }
        self.whole(id) != 0
    }

    fn ordered(
        &mut self,
        left: Id,
        right: Id,
        numbers: fn(f64, f64) -> bool,
        texts: fn(std::cmp::Ordering) -> bool,
    ) -> bool {
        if !self.is_fixed {
            let left = self.number(left);
            return numbers(left, self.number(right));
        }
        if let (Some(left), Some(right)) = (self.at_hand(left), self.at_hand(right)) {
            return numbers(left, right);
        }
        let at = left;
        let (left, right) = (self.value(left), self.value(right));
        match (&left, &right) {
            (Value::Text(_) | Value::Unset, Value::Text(_) | Value::Unset) => {
                texts(left.to_text().cmp(&right.to_text()))
            }
            (
                Value::Nil
                | Value::Bool(_)
                | Value::Int(_)
                | Value::Float(_)
                | Value::Text(_)
                | Value::Unset
                | Value::List(_),
                _,
            ) => {
                self.look_at_number(&left, at);
                self.look_at_number(&right, at);
                numbers(left.to_float(), right.to_float())
            }
        }
    }

    /// A number that nobody has to be asked for.
    #[inline]
    fn at_hand(&self, id: Id) -> Option<f64> {
        let value = match self.code.ops[id as usize] {
            Op::Int(number) => return Some(f64::from(number)),
            Op::Float(number) => return Some(number),
            Op::Variable(slot) => self.store.get(slot)?,
            Op::Nil
            | Op::Bool(_)
            | Op::Constant(_)
            | Op::Sensor(_)
            | Op::Minus(_)
            | Op::MinusNarrow(_)
            | Op::Not(_)
            | Op::TextLength(_)
            | Op::Length(_)
            | Op::BitNot(_)
            | Op::Binary(..)
            | Op::Element(..)
            | Op::Elements(..)
            | Op::Call(..)
            | Op::Table(_)
            | Op::Block(_)
            | Op::Assign(..)
            | Op::AssignElement(..)
            | Op::Steps(_)
            | Op::Broken(_) => return None,
        };
        match value {
            Value::Int(number) => Some(f64::from(*number)),
            Value::Float(number) => Some(*number),
            Value::Nil | Value::Bool(_) | Value::Text(_) | Value::Unset | Value::List(_) => None,
        }
    }

    fn equal(&mut self, id: Id, left: Id, right: Id) -> bool {
        let (left, right) = (self.value(left), self.value(right));
        let is_long = |value: &Value| matches!(value, Value::List(_) | Value::Text(_));
        if is_long(&left) && is_long(&right) && !self.pay(left.cells().min(right.cells()), id) {
            return false;
        }
        left.equals(&right)
    }

    /// As it is.
    pub(super) fn value(&mut self, id: Id) -> Value {
        match self.code.ops[id as usize] {
            Op::Nil => Value::Nil,
            Op::Bool(truth) => Value::Bool(truth),
            Op::Int(number) => Value::Int(number),
            Op::Float(number) => Value::Float(number),
            Op::Constant(index) => self.code.constants[index as usize].clone(),
            Op::Variable(slot) => match self.store.get(slot) {
                Some(value) => value.clone(),
                None => {
                    self.uninitialized(slot, id);
                    Value::Nil
                }
            },
            Op::Sensor(sensor) => self.outside.sensor(sensor),
            Op::Minus(_) | Op::MinusNarrow(_) => Value::Float(self.number(id)),
            Op::Steps(span) => Value::Float(self.steps(span)),
            Op::Not(_) => Value::Bool(self.truth(id)),
            Op::BitNot(_) => Value::Int(self.whole(id)),
            Op::TextLength(operand) | Op::Length(operand) => {
                let value = self.value(operand);
                Value::Int(if let Value::List(list) = &value {
                    i32::try_from(list.items().len()).unwrap_or(i32::MAX)
                } else if self.pay(value.cells(), id) {
                    length(&value.to_text())
                } else {
                    0
                })
            }
            Op::Binary(operator, left, right) => self.binary(id, operator, left, right),
            Op::Element(base, index) => self.element(id, base, index),
            Op::Elements(base, span) => self.elements(id, base, span),
            Op::Call(function, span) => self.call(id, function, span),
            Op::Table(span) => self.table(id, span),
            Op::Block(span) => {
                let mut last = Value::Nil;
                for &statement in self.code.operands(span) {
                    last = self.value(statement);
                }
                last
            }
            Op::Assign(slot, value) => {
                let value = self.value(value);
                if self.store.set(slot, value).is_err() {
                    self.fault(Reason::StoreFull, id);
                }
                Value::Nil
            }
            Op::AssignElement(base, span) => {
                self.assign_element(id, base, span);
                Value::Nil
            }
            Op::Broken(index) => {
                self.broken(index, id);
                Value::Nil
            }
        }
    }

    fn binary(&mut self, id: Id, operator: Binary, left: Id, right: Id) -> Value {
        match operator {
            Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Divide | Binary::Power => {
                Value::Float(self.binary_number(id, operator, left, right))
            }
            Binary::DivideWhole
            | Binary::Modulo
            | Binary::BitAnd
            | Binary::BitOr
            | Binary::BitXor
            | Binary::ShiftLeft
            | Binary::ShiftRight => Value::Int(self.whole(id)),
            Binary::Join => self.join(id, left, right),
            Binary::Or
            | Binary::And
            | Binary::Less
            | Binary::Greater
            | Binary::LessEqual
            | Binary::GreaterEqual
            | Binary::NotEqual
            | Binary::Equal => Value::Bool(self.truth(id)),
        }
    }

    fn join(&mut self, id: Id, left: Id, right: Id) -> Value {
        let left = self.value(left);
        let right = self.value(right);
        let (left, right) = (self.text(&left), self.text(&right));
        if left.len() + right.len() > limits::TEXT_MAX {
            self.fault(Reason::ValueTooLong, id);
            return Value::text("");
        }
        let joined = Value::text([&*left, &*right].concat());
        if !self.pay(joined.cells(), id) {
            return Value::text("");
        }
        joined
    }

    pub(super) fn text(&self, value: &Value) -> Rc<str> {
        if let Value::Float(number) = value
            && self.is_fixed
            && number.is_finite()
        {
            return super::value::plain_text(*number).into();
        }
        value.to_text()
    }
}

/// Characters of a text.
fn length(text: &str) -> i32 {
    i32::try_from(text.encode_utf16().count()).unwrap_or(i32::MAX)
}
