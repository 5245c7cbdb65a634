//! Tapes under construction: each value once, and what is known already is computed.
//!
//! Owns sharing, folding and the removal of what nobody needs. What is simplified here gives the same number as before to
//! the last bit, signs of zeros too; only what is no number may be another one that is none. Knows no models.

use super::function::Function;
use super::lower::Refused;
use super::syntax::{Comparison, Operator};
use super::tape::{Operation, Tape, ValueId};
use crate::limits;
use std::collections::HashMap;

/// Operations that are told apart by their bits.
#[derive(Clone, Copy, Eq, PartialEq, Hash)]
enum Key {
    Constant(u64),
    Input(super::tape::Input),
    Negative(ValueId),
    Binary(Operator, ValueId, ValueId),
    Call(Function, ValueId, ValueId),
    Select(Comparison, [ValueId; 4]),
}

/// A tape that grows.
#[derive(Default)]
pub struct Builder {
    operations: Vec<Operation>,
    known: HashMap<Key, ValueId>,
}

impl Builder {
    /// An empty one.
    pub fn new() -> Self {
        Self::default()
    }

    /// The number of a value, if it is known now.
    pub fn number(&self, id: ValueId) -> Option<f64> {
        match self.operations.get(id as usize) {
            Some(Operation::Constant(number)) => Some(*number),
            _ => None,
        }
    }

    /// How a value comes about; not a number for a value that is not there.
    pub fn operation(&self, id: ValueId) -> Operation {
        let found = self.operations.get(id as usize);
        found.copied().unwrap_or(Operation::Constant(f64::NAN))
    }

    /// A number. Refused if it is not finite, or if there are too many operations.
    pub fn constant(&mut self, number: f64) -> Result<ValueId, Refused> {
        if !number.is_finite() {
            return Err(Refused::NotFinite(number));
        }
        self.push(Operation::Constant(number))
    }

    /// The opposite of a value.
    pub fn negative(&mut self, value: ValueId) -> Result<ValueId, Refused> {
        self.value(Operation::Negative(value))
    }

    /// Two values put together.
    pub fn binary(
        &mut self,
        operator: Operator,
        left: ValueId,
        right: ValueId,
    ) -> Result<ValueId, Refused> {
        self.value(Operation::Binary(operator, left, right))
    }

    /// A function of one value.
    pub fn call(&mut self, function: Function, x: ValueId) -> Result<ValueId, Refused> {
        self.value(Operation::Call(function, x, x))
    }

    /// What an operation gives: a value that is there already, a number, or a new value. Its operands are of this tape.
    /// Refused if there are too many operations.
    pub fn value(&mut self, operation: Operation) -> Result<ValueId, Refused> {
        if let Some(same) = self.same(operation) {
            return Ok(same);
        }
        match self.folded(operation) {
            Some(number) if number.is_finite() => self.push(Operation::Constant(number)),
            _ => self.turned(operation),
        }
    }

    /// A value that is there and equal to what the operation gives.
    fn same(&self, operation: Operation) -> Option<ValueId> {
        let is = |id, number: f64| {
            self.number(id)
                .is_some_and(|one| one.to_bits() == number.to_bits())
        };
        match operation {
            Operation::Negative(value) => match self.operations.get(value as usize) {
                Some(Operation::Negative(inner)) => Some(*inner),
                _ => None,
            },
            Operation::Binary(Operator::Add, left, right) if is(right, -0.0) => Some(left),
            Operation::Binary(Operator::Add, left, right) if is(left, -0.0) => Some(right),
            Operation::Binary(Operator::Subtract, left, right) if is(right, 0.0) => Some(left),
            Operation::Binary(Operator::Multiply | Operator::Divide, left, right)
                if is(right, 1.0) =>
            {
                Some(left)
            }
            Operation::Binary(Operator::Multiply, left, right) if is(left, 1.0) => Some(right),
            Operation::Select(_, [_, _, yes, no]) if yes == no => Some(yes),
            Operation::Select(comparison, [left, right, yes, no]) => {
                let is_known = (self.number(left)?, self.number(right)?);
                let holds = comparison.holds(is_known.0, is_known.1);
                Some(if holds { yes } else { no })
            }
            _ => None,
        }
    }

    /// The number that the operation gives, if its operands are numbers.
    fn folded(&self, operation: Operation) -> Option<f64> {
        match operation {
            Operation::Negative(value) => Some(-self.number(value)?),
            Operation::Binary(operator, left, right) => {
                Some(operator.apply(self.number(left)?, self.number(right)?))
            }
            Operation::Call(function, x, y) => {
                Some(function.apply(self.number(x)?, self.number(y)?))
            }
            _ => None,
        }
    }

    /// The operation itself; sums with an opposite are differences, and the other way round.
    fn turned(&mut self, operation: Operation) -> Result<ValueId, Refused> {
        let opposite = |id: ValueId| match self.operations.get(id as usize) {
            Some(Operation::Negative(inner)) => Some(*inner),
            _ => None,
        };
        let turned = match operation {
            Operation::Binary(Operator::Add, left, right) => {
                match (opposite(left), opposite(right)) {
                    (_, Some(inner)) => Operation::Binary(Operator::Subtract, left, inner),
                    (Some(inner), None) => Operation::Binary(Operator::Subtract, right, inner),
                    _ => operation,
                }
            }
            Operation::Binary(Operator::Subtract, left, right) => match opposite(right) {
                Some(inner) => Operation::Binary(Operator::Add, left, inner),
                None => operation,
            },
            _ => operation,
        };
        self.push(turned)
    }

    fn push(&mut self, operation: Operation) -> Result<ValueId, Refused> {
        let key = match operation {
            Operation::Constant(number) => Key::Constant(number.to_bits()),
            Operation::Input(input) => Key::Input(input),
            Operation::Negative(value) => Key::Negative(value),
            Operation::Binary(operator @ (Operator::Add | Operator::Multiply), left, right) => {
                Key::Binary(operator, left.min(right), left.max(right))
            }
            Operation::Binary(operator, left, right) => Key::Binary(operator, left, right),
            Operation::Call(function, x, y) => Key::Call(function, x, y),
            Operation::Select(comparison, of) => Key::Select(comparison, of),
        };
        if let Some(id) = self.known.get(&key) {
            return Ok(*id);
        }
        let next = self.operations.len();
        if next >= limits::DCML_OPERATIONS_MAX {
            return Err(Refused::TooLarge("operations", limits::DCML_OPERATIONS_MAX));
        }
        // The limit is far below what 32 bits count.
        let id = next as ValueId;
        self.operations.push(operation);
        self.known.insert(key, id);
        Ok(id)
    }

    /// The tape that gives these results, and nothing that they do not need.
    pub fn tape(&self, results: &[ValueId]) -> Tape {
        let mut is_needed = vec![false; self.operations.len()];
        for id in results {
            if let Some(one) = is_needed.get_mut(*id as usize) {
                *one = true;
            }
        }
        for (id, operation) in self.operations.iter().enumerate().rev() {
            if is_needed[id] {
                operation.each_operand(|of| is_needed[of as usize] = true);
            }
        }
        let mut place: Vec<ValueId> = vec![0; self.operations.len()];
        let mut operations = Vec::new();
        for (id, operation) in self.operations.iter().enumerate() {
            if is_needed[id] {
                place[id] = operations.len() as ValueId;
                operations.push(operation.with(|of| place[of as usize]));
            }
        }
        let placed = |id: &ValueId| place.get(*id as usize).copied().unwrap_or(ValueId::MAX);
        Tape {
            operations,
            results: results.iter().map(placed).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tape::Input;

    #[test]
    fn what_is_equal_is_there_once() -> Result<(), Refused> {
        let mut builder = Builder::new();
        let x = builder.value(Operation::Input(Input::State(0)))?;
        let y = builder.value(Operation::Input(Input::State(1)))?;
        let sum = builder.binary(Operator::Add, x, y)?;
        assert_eq!(builder.binary(Operator::Add, y, x)?, sum);
        let one = builder.constant(1.0)?;
        assert_eq!(builder.binary(Operator::Multiply, one, sum)?, sum);
        let turned = builder.negative(sum)?;
        assert_eq!(builder.negative(turned)?, sum);
        let less = builder.binary(Operator::Subtract, x, sum)?;
        assert_eq!(builder.binary(Operator::Add, x, turned)?, less);
        let tape = builder.tape(&[less]);
        assert_eq!(tape.operations.len(), 4, "the number one is not needed");
        assert_eq!(tape.reference(&[3.0, 5.0], &[], &[]), [-5.0]);
        Ok(())
    }

    #[test]
    fn nothing_that_could_change_a_number_is_folded() -> Result<(), Refused> {
        let mut builder = Builder::new();
        let x = builder.value(Operation::Input(Input::State(0)))?;
        let zero = builder.constant(0.0)?;
        let one = builder.constant(1.0)?;
        let product = builder.binary(Operator::Multiply, zero, x)?;
        let sum = builder.binary(Operator::Add, x, zero)?;
        let endless = builder.binary(Operator::Divide, one, zero)?;
        let root = builder.call(Function::Sqrt, one)?;
        assert_eq!(builder.number(endless), None);
        assert_eq!(builder.number(root), Some(1.0));
        let found = builder
            .tape(&[product, sum, endless])
            .reference(&[-0.0], &[], &[]);
        assert_eq!(found[1].to_bits(), 0.0_f64.to_bits());
        assert_eq!(found[2], f64::INFINITY);
        let found = builder
            .tape(&[product])
            .reference(&[f64::INFINITY], &[], &[]);
        assert!(found[0].is_nan());
        assert_eq!(
            builder.constant(f64::INFINITY),
            Err(Refused::NotFinite(f64::INFINITY))
        );
        Ok(())
    }
}
