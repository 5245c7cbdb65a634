//! Runs compiled texts: values as TRIK Studio computes them.
//!
//! A part is asked for what its user needs (a number, a whole number, a truth, any value), so that numbers take no
//! memory. As in the real program, an error counts as 0 and the rest still runs; the errors come out at the end.

use super::code::{Base, Code, Op, Span};
use super::names::Names;
use super::reserved::SensorIndex;
use super::store::Store;
use super::tree::{Binary, Id};
use super::value::{Compat, List, ListError, Value, round};
use super::words::{Fault, What};
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
    is_fixed: bool,
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
    pub(super) fn fault(&mut self, what: What, id: Id) {
        if self.faults.len() < limits::EXPRESSION_PROBLEMS_MAX {
            let at = self.code.places[id as usize];
            self.faults.push(Fault::new(what, at));
        }
    }

    #[cold]
    fn list_fault(&mut self, error: ListError, id: Id) {
        let what = match error {
            ListError::Negative => What::NegativeIndex,
            ListError::TooLong => What::ValueTooLong,
            ListError::TooDeep => What::ValueTooDeep,
        };
        self.fault(what, id);
    }

    #[cold]
    fn uninitialized(&mut self, slot: u32, id: Id) {
        let name = self.names.name(slot).to_owned();
        self.fault(What::Uninitialized(name), id);
    }

    #[cold]
    fn broken(&mut self, index: u32, id: Id) {
        let what = self.code.faults.get(index as usize).cloned();
        self.fault(what.unwrap_or(What::NotInterpreted), id);
    }

    /// Pays for work on large values.
    fn pay(&mut self, cells: u32, id: Id) -> bool {
        if let Some(left) = self.cells.checked_sub(cells) {
            self.cells = left;
            return true;
        }
        self.fault(What::TooMuchWork, id);
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
            _ => self.value(id).to_float(),
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
                    self.fault(What::DivisionByZero, id);
                    return 0.0;
                }
                left / right
            }
            Binary::Power => {
                let left = self.number(left);
                left.powf(self.number(right))
            }
            Binary::Join => self.value(id).to_float(),
            Binary::DivideWhole
            | Binary::Modulo
            | Binary::BitAnd
            | Binary::BitOr
            | Binary::BitXor
            | Binary::ShiftLeft
            | Binary::ShiftRight => f64::from(self.whole(id)),
            _ => f64::from(u8::from(self.truth(id))),
        }
    }

    /// As a whole number.
    pub(super) fn whole(&mut self, id: Id) -> i32 {
        let (operator, left, right) = match self.code.ops[id as usize] {
            Op::Int(number) => return number,
            Op::Variable(slot) => {
                return match self.store.get(slot) {
                    Some(value) => value.to_int(),
                    None => {
                        self.uninitialized(slot, id);
                        0
                    }
                };
            }
            Op::Sensor(sensor) => return self.outside.sensor(sensor).to_int(),
            Op::BitNot(operand) => return !self.whole(operand),
            Op::Float(_) | Op::Minus(_) | Op::MinusNarrow(_) => return round(self.number(id)),
            Op::Binary(operator, left, right) => (operator, left, right),
            _ => return self.value(id).to_int(),
        };
        match operator {
            Binary::Add | Binary::Subtract | Binary::Multiply | Binary::Divide | Binary::Power => {
                round(self.number(id))
            }
            Binary::Join => self.value(id).to_int(),
            Binary::DivideWhole
            | Binary::Modulo
            | Binary::BitAnd
            | Binary::BitOr
            | Binary::BitXor
            | Binary::ShiftLeft
            | Binary::ShiftRight => {
                let left = self.whole(left);
                let right = self.whole(right);
                self.bits(id, operator, left, right)
            }
            _ => i32::from(self.truth(id)),
        }
    }

    fn bits(&mut self, id: Id, operator: Binary, left: i32, right: i32) -> i32 {
        match operator {
            Binary::DivideWhole | Binary::Modulo if right == 0 => {
                self.fault(What::DivisionByZero, id);
                0
            }
            Binary::DivideWhole if self.is_fixed => {
                let down = left.wrapping_div(right);
                down - i32::from(left.wrapping_rem(right) != 0 && (left < 0) != (right < 0))
            }
            Binary::DivideWhole => left.wrapping_div(right),
            Binary::Modulo if self.is_fixed => {
                let rest = left.wrapping_rem(right);
                if rest != 0 && (rest < 0) != (right < 0) {
                    rest + right
                } else {
                    rest
                }
            }
            Binary::Modulo => left.wrapping_rem(right),
            Binary::BitAnd => left & right,
            Binary::BitOr => left | right,
            Binary::BitXor => left ^ right,
            Binary::ShiftLeft if self.is_fixed && !(0..32).contains(&right) => 0,
            Binary::ShiftLeft => left.wrapping_shl(right as u32),
            Binary::ShiftRight if self.is_fixed && !(0..32).contains(&right) => {
                if left < 0 {
                    -1
                } else {
                    0
                }
            }
            _ => left.wrapping_shr(right as u32),
        }
    }

    /// As a truth: of a comparison, of `and` and `or`, or of any value as a condition takes it.
    pub(super) fn truth(&mut self, id: Id) -> bool {
        let (operator, left, right) = match self.code.ops[id as usize] {
            Op::Bool(truth) => return truth,
            Op::Not(operand) => return !self.truth(operand),
            Op::Binary(operator, left, right) => (operator, left, right),
            _ => return self.value_truth(id),
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
            _ => self.value_truth(id),
        }
    }

    fn value_truth(&mut self, id: Id) -> bool {
        let value = self.value(id);
        match value {
            Value::Float(number) if self.is_fixed => number != 0.0,
            _ => value.to_bool(),
        }
    }

    /// A side of `and` or `or`: goes through a whole number.
    fn side(&mut self, id: Id) -> bool {
        if self.is_fixed {
            return self.truth(id);
        }
        match self.code.ops[id as usize] {
            Op::Bool(_) | Op::Not(_) => self.truth(id),
            _ => self.whole(id) != 0,
        }
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
        let (left, right) = (self.value(left), self.value(right));
        match (&left, &right) {
            (Value::Text(one), Value::Text(two)) => texts(one.cmp(two)),
            _ => numbers(left.to_float(), right.to_float()),
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
            Op::Not(_) => Value::Bool(self.truth(id)),
            Op::BitNot(_) => Value::Int(self.whole(id)),
            Op::TextLength(operand) | Op::Length(operand) => {
                let value = self.value(operand);
                Value::Int(match &value {
                    Value::List(list) => i32::try_from(list.items().len()).unwrap_or(i32::MAX),
                    _ if !self.pay(value.cells(), id) => 0,
                    _ => length(&value.to_text()),
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
                    self.fault(What::StoreFull, id);
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
            _ => Value::Bool(self.truth(id)),
        }
    }

    fn join(&mut self, id: Id, left: Id, right: Id) -> Value {
        let left = self.value(left);
        let right = self.value(right);
        let (left, right) = (self.text(&left), self.text(&right));
        if left.len() + right.len() > limits::TEXT_MAX {
            self.fault(What::ValueTooLong, id);
            return Value::text("");
        }
        let joined = Value::text([&*left, &*right].concat());
        if !self.pay(joined.cells(), id) {
            return Value::text("");
        }
        joined
    }

    pub(super) fn text(&self, value: &Value) -> Rc<str> {
        match value {
            Value::Float(number) if self.is_fixed && number.is_finite() => {
                super::value::plain_text(*number).into()
            }
            _ => value.to_text(),
        }
    }

    fn base(&mut self, base: Base) -> Option<Rc<List>> {
        match base {
            Base::Variable(slot) => match self.store.get(slot) {
                Some(Value::List(list)) => Some(list.clone()),
                _ => None,
            },
            Base::Sensor(sensor) => match self.outside.sensor(sensor) {
                Value::List(list) => Some(list),
                _ => None,
            },
            Base::Constant => None,
        }
    }

    fn element(&mut self, id: Id, base: Base, index: Id) -> Value {
        let index = self.whole(index);
        if let Base::Variable(slot) = base
            && let Some(Value::List(list)) = self.store.get(slot)
            && let Ok(index) = usize::try_from(index)
        {
            return list.items().get(index).cloned().unwrap_or_default();
        }
        let list = self.base(base);
        self.element_of(id, list.as_deref(), index)
    }

    fn element_of(&mut self, id: Id, list: Option<&List>, index: i32) -> Value {
        let Ok(index) = usize::try_from(index) else {
            self.fault(What::NegativeIndex, id);
            return Value::Nil;
        };
        list.and_then(|list| list.items().get(index).cloned())
            .unwrap_or_default()
    }

    /// The indices of an element, computed from the last to the first, as the real program does.
    fn indices(&mut self, ids: &[Id]) -> ([i32; limits::LIST_DEPTH_MAX as usize], usize) {
        let mut path = [0; limits::LIST_DEPTH_MAX as usize];
        for (place, &id) in path.iter_mut().zip(ids).rev() {
            *place = self.whole(id);
        }
        (path, ids.len().min(path.len()))
    }

    fn elements(&mut self, id: Id, base: Base, span: Span) -> Value {
        let code = self.code;
        let (path, count) = self.indices(code.operands(span));
        let mut found = self.base(base).map_or(Value::Nil, Value::List);
        for &index in &path[..count] {
            let list = match found {
                Value::List(list) => Some(list),
                _ => None,
            };
            if list.is_none() && index >= 0 {
                return Value::Nil;
            }
            if index < 0 {
                self.fault(What::NegativeIndex, id);
                return Value::Nil;
            }
            found = self.element_of(id, list.as_deref(), index);
        }
        found
    }

    fn assign_element(&mut self, id: Id, base: Base, span: Span) {
        let code = self.code;
        let Some((&value, ids)) = code.operands(span).split_last() else {
            return;
        };
        let value = self.value(value);
        let (path, count) = self.indices(ids);
        let Base::Variable(slot) = base else {
            return;
        };
        let mut list = match self.store.remove(slot) {
            Some(Value::List(list)) => list,
            _ => Rc::default(),
        };
        // A list that somebody else has, too, is copied, and so may be a list in it.
        let may_copy = Rc::strong_count(&list) > 1 || count > 1;
        if may_copy && !self.pay(list.cells(), id) {
            let _ = self.store.set(slot, Value::List(list));
            return;
        }
        let before = list.cells();
        let outcome = Rc::make_mut(&mut list).put_at(&path[..count], value);
        let grown = list.cells().saturating_sub(before);
        if let Err(error) = outcome {
            self.list_fault(error, id);
        }
        self.pay(grown, id);
        if self.store.set(slot, Value::List(list)).is_err() {
            self.fault(What::StoreFull, id);
        }
    }

    fn table(&mut self, id: Id, span: Span) -> Value {
        let code = self.code;
        let pairs = code.operands(span);
        let mut list = List::default();
        for pair in pairs.chunks_exact(2) {
            let (key, value) = (pair[0], pair[1]);
            let outcome = if key == value {
                let value = self.value(value);
                let end = i32::try_from(list.items().len()).unwrap_or(i32::MAX);
                list.put(end, value, &Value::Nil)
            } else {
                let key = self.whole(key);
                let value = self.value(value);
                if self.is_fixed {
                    list.put(key, value, &Value::Nil)
                } else {
                    // The real program keeps texts here.
                    list.put(key, Value::Text(value.to_text()), &Value::text(""))
                }
            };
            if let Err(error) = outcome {
                self.list_fault(error, id);
                break;
            }
        }
        if !self.pay(list.cells(), id) {
            return Value::Nil;
        }
        Value::List(Rc::new(list))
    }
}

/// Characters of a text.
fn length(text: &str) -> i32 {
    i32::try_from(text.encode_utf16().count()).unwrap_or(i32::MAX)
}
