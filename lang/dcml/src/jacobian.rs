//! How the results of a tape change with what comes in, as a tape again: exact derivatives by the rules of calculus.
//!
//! Owns the rule of each operation and the walk through what depends on an input. Where a function has a corner the
//! derivative of one side is given: `abs` is level at zero, `min` and `max` follow their first argument where both are
//! equal and the other one where one is not a number, `sign` and `floor` are level everywhere, and `piecewise` follows the
//! branch that is taken. A factor that is zero by these rules makes a product or a quotient zero whatever the other one
//! is: behind `max(x, 0)` a root is level where x is negative, though its own slope is infinite there.

use super::fold::Builder;
use super::function::Function;
use super::lower::Refused;
use super::syntax::{Comparison, Operator};
use super::tape::{Input, Operation, Tape, ValueId};
use crate::limits;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The derivatives of all results of a tape by each of these inputs, row after row: a row for each result.
///
/// # Errors
///
/// [`Refused`] if it has more than [`limits::DCML_JACOBIAN_MAX`] elements, or takes too much work.
pub fn jacobian(tape: &Tape, inputs: &[Input]) -> Result<Tape, Refused> {
    let elements = tape.results.len().saturating_mul(inputs.len());
    if elements > limits::DCML_JACOBIAN_MAX {
        return Err(Refused::TooLarge(
            "elements of a Jacobian",
            limits::DCML_JACOBIAN_MAX,
        ));
    }
    let mut walk = Walk::over(tape)?;
    let zero = walk.builder.constant(0.0)?;
    let mut results = vec![zero; elements];
    for (column, input) in inputs.iter().enumerate() {
        walk.tangents_by(*input)?;
        for (row, result) in tape.results.iter().enumerate() {
            if let Some(tangent) = walk.tangent(*result) {
                results[row * inputs.len() + column] = tangent;
            }
        }
    }
    Ok(walk.builder.tape(&results))
}

/// One input after another through a tape, along what depends on it alone.
struct Walk<'a> {
    tape: &'a Tape,
    builder: Builder,
    /// Where each operation of the tape is among the new ones.
    place: Vec<ValueId>,
    /// For each operation those that need it, in rising order.
    users: Vec<Vec<ValueId>>,
    /// The derivative of each operation, where it is not zero.
    tangents: Vec<Option<ValueId>>,
    /// Those that were looked at for the last input.
    touched: Vec<ValueId>,
    /// How many were looked at for all of them.
    steps: usize,
}

impl<'a> Walk<'a> {
    fn over(tape: &'a Tape) -> Result<Self, Refused> {
        tape.ordered()?;
        let mut builder = Builder::new();
        let mut place: Vec<ValueId> = Vec::with_capacity(tape.operations.len());
        let mut users = vec![Vec::new(); tape.operations.len()];
        for (id, operation) in tape.operations.iter().enumerate() {
            operation.each_operand(|of| users[of as usize].push(id as ValueId));
            let placed = operation.with(|of| place[of as usize]);
            place.push(builder.value(placed)?);
        }
        Ok(Self {
            tape,
            builder,
            place,
            users,
            tangents: vec![None; tape.operations.len()],
            touched: Vec::new(),
            steps: 0,
        })
    }

    fn tangent(&self, id: ValueId) -> Option<ValueId> {
        self.tangents.get(id as usize).copied().flatten()
    }

    /// Finds the derivatives of everything by one input.
    fn tangents_by(&mut self, input: Input) -> Result<(), Refused> {
        for id in self.touched.drain(..) {
            self.tangents[id as usize] = None;
        }
        let mut all = self.tape.operations.iter();
        let Some(first) = all.position(|one| *one == Operation::Input(input)) else {
            return Ok(());
        };
        let mut waiting = BinaryHeap::from([Reverse(first as ValueId)]);
        let mut last = None;
        while let Some(Reverse(id)) = waiting.pop() {
            if last.replace(id) == Some(id) {
                continue;
            }
            self.steps += 1;
            if self.steps > limits::DCML_JACOBIAN_STEPS_MAX {
                return Err(Refused::TooLarge(
                    "steps of differentiation",
                    limits::DCML_JACOBIAN_STEPS_MAX,
                ));
            }
            let tangent = self.rule(id)?;
            if tangent.is_some_and(|one| self.builder.number(one) != Some(0.0)) {
                self.tangents[id as usize] = tangent;
                self.touched.push(id);
                waiting.extend(self.users[id as usize].iter().map(|one| Reverse(*one)));
            }
        }
        Ok(())
    }

    /// The derivative of one operation from those of its operands; nothing is zero.
    fn rule(&mut self, id: ValueId) -> Result<Option<ValueId>, Refused> {
        let itself = self.place[id as usize];
        let placed = |id: ValueId| self.place[id as usize];
        let operation = self.tape.operations[id as usize];
        let tangent = |id: ValueId| self.tangents[id as usize];
        match operation {
            Operation::Constant(_) => Ok(None),
            Operation::Input(_) => self.builder.constant(1.0).map(Some),
            Operation::Negative(x) => self.opposite(tangent(x)),
            Operation::Binary(operator, x, y) => {
                let (dx, dy) = (tangent(x), tangent(y));
                let (x, y) = (placed(x), placed(y));
                match operator {
                    Operator::Add => self.sum(dx, dy),
                    Operator::Subtract => self.difference(dx, dy),
                    Operator::Multiply => {
                        let left = self.times(dx, y)?;
                        let right = self.times(dy, x)?;
                        self.sum(left, right)
                    }
                    Operator::Divide => {
                        let change = self.times(dy, itself)?;
                        let above = self.difference(dx, change)?;
                        self.over_value(above, y)
                    }
                }
            }
            Operation::Call(function, x, y) if function.arguments() == 2 => {
                let (dx, dy) = (tangent(x), tangent(y));
                let of = [placed(x), placed(y), itself];
                self.rule_of_two(function, of, dx, dy)
            }
            Operation::Call(function, x, _) => {
                let (x, dx) = (placed(x), tangent(x));
                let Some(dx) = dx else { return Ok(None) };
                self.rule_of_one(function, x, itself, dx)
            }
            Operation::Select(comparison, [left, right, yes, no]) => {
                let (yes, no) = (tangent(yes), tangent(no));
                let (left, right) = (placed(left), placed(right));
                self.either(comparison, [left, right], yes, no)
            }
        }
    }

    /// Functions of one argument, by the chain rule.
    fn rule_of_one(
        &mut self,
        function: Function,
        x: ValueId,
        itself: ValueId,
        dx: ValueId,
    ) -> Result<Option<ValueId>, Refused> {
        let change = Some(dx);
        match function {
            Function::Sin => {
                let slope = self.builder.call(Function::Cos, x)?;
                self.times(change, slope)
            }
            Function::Cos => {
                let slope = self.builder.call(Function::Sin, x)?;
                let product = self.times(change, slope)?;
                self.opposite(product)
            }
            Function::Tan => {
                let slope = self.one_and_square(Operator::Add, itself)?;
                self.times(change, slope)
            }
            Function::Asin | Function::Acos => {
                let square = self.one_and_square(Operator::Subtract, x)?;
                let root = self.builder.call(Function::Sqrt, square)?;
                let ratio = self.over_value(change, root)?;
                match function {
                    Function::Acos => self.opposite(ratio),
                    _ => Ok(ratio),
                }
            }
            Function::Atan => {
                let square = self.one_and_square(Operator::Add, x)?;
                self.over_value(change, square)
            }
            Function::Sqrt => {
                let twice = self.builder.binary(Operator::Add, itself, itself)?;
                self.over_value(change, twice)
            }
            Function::Exp => self.times(change, itself),
            Function::Log => self.over_value(change, x),
            Function::Abs => {
                let slope = self.builder.call(Function::Sign, x)?;
                self.times(change, slope)
            }
            _ => Ok(None),
        }
    }

    /// Functions of two arguments x and y with their value.
    fn rule_of_two(
        &mut self,
        function: Function,
        [x, y, itself]: [ValueId; 3],
        dx: Option<ValueId>,
        dy: Option<ValueId>,
    ) -> Result<Option<ValueId>, Refused> {
        match function {
            Function::Atan2 => {
                // The first argument is across, the second ahead.
                let left = self.times(dx, y)?;
                let right = self.times(dy, x)?;
                let above = self.difference(left, right)?;
                let xx = self.builder.binary(Operator::Multiply, x, x)?;
                let yy = self.builder.binary(Operator::Multiply, y, y)?;
                let below = self.builder.binary(Operator::Add, xx, yy)?;
                self.over_value(above, below)
            }
            Function::Min => self.follow(Comparison::Greater, [x, y], dx, dy),
            Function::Max => self.follow(Comparison::Less, [x, y], dx, dy),
            Function::Pow => {
                let by_base = self.power_by_base(x, y, dx)?;
                let by_exponent = self.power_by_exponent(x, itself, dy)?;
                self.sum(by_base, by_exponent)
            }
            _ => Ok(None),
        }
    }

    /// y x^(y-1) dx; the slope of a power of zero is zero, and a square has none of its own.
    fn power_by_base(
        &mut self,
        x: ValueId,
        y: ValueId,
        dx: Option<ValueId>,
    ) -> Result<Option<ValueId>, Refused> {
        let exponent = self.builder.number(y);
        if dx.is_none() || exponent == Some(0.0) {
            return Ok(None);
        }
        let one = self.builder.constant(1.0)?;
        let less = self.builder.binary(Operator::Subtract, y, one)?;
        let power = if exponent == Some(2.0) {
            x
        } else {
            self.builder
                .value(Operation::Call(Function::Pow, x, less))?
        };
        let slope = self.builder.binary(Operator::Multiply, y, power)?;
        self.times(dx, slope)
    }

    /// x^y log(x) dy, which is zero where the power is.
    fn power_by_exponent(
        &mut self,
        x: ValueId,
        itself: ValueId,
        dy: Option<ValueId>,
    ) -> Result<Option<ValueId>, Refused> {
        if dy.is_none() {
            return Ok(None);
        }
        let zero = self.builder.constant(0.0)?;
        let log = self.builder.call(Function::Log, x)?;
        let slope = self.builder.binary(Operator::Multiply, itself, log)?;
        let size = self.builder.call(Function::Abs, itself)?;
        let select = Operation::Select(Comparison::LessOrEqual, [size, zero, zero, slope]);
        let slope = self.builder.value(select)?;
        self.times(dy, slope)
    }

    /// 1 + x x, or 1 - x x.
    fn one_and_square(&mut self, operator: Operator, x: ValueId) -> Result<ValueId, Refused> {
        let one = self.builder.constant(1.0)?;
        let square = self.builder.binary(Operator::Multiply, x, x)?;
        self.builder.binary(operator, one, square)
    }

    fn opposite(&mut self, x: Option<ValueId>) -> Result<Option<ValueId>, Refused> {
        x.map(|x| self.builder.negative(x)).transpose()
    }

    fn sum(&mut self, x: Option<ValueId>, y: Option<ValueId>) -> Result<Option<ValueId>, Refused> {
        match (x, y) {
            (Some(x), Some(y)) => self.builder.binary(Operator::Add, x, y).map(Some),
            (one, other) => Ok(one.or(other)),
        }
    }

    fn difference(
        &mut self,
        x: Option<ValueId>,
        y: Option<ValueId>,
    ) -> Result<Option<ValueId>, Refused> {
        match (x, y) {
            (Some(x), Some(y)) => self.builder.binary(Operator::Subtract, x, y).map(Some),
            (None, y) => self.opposite(y),
            (x, None) => Ok(x),
        }
    }

    fn times(&mut self, x: Option<ValueId>, by: ValueId) -> Result<Option<ValueId>, Refused> {
        match x {
            Some(_) if self.builder.number(by) == Some(0.0) => Ok(None),
            Some(x) => self.scaled(Operator::Multiply, x, by).map(Some),
            None => Ok(None),
        }
    }

    fn over_value(&mut self, x: Option<ValueId>, by: ValueId) -> Result<Option<ValueId>, Refused> {
        x.map(|x| self.scaled(Operator::Divide, x, by)).transpose()
    }

    /// A derivative times or over a value: where a branch of it is zero it stays zero, also beside what is infinite.
    fn scaled(&mut self, operator: Operator, x: ValueId, by: ValueId) -> Result<ValueId, Refused> {
        // Branches in branches are turned as deep as a person writes them.
        self.scaled_within(operator, x, by, 4)
    }

    fn scaled_within(
        &mut self,
        operator: Operator,
        x: ValueId,
        by: ValueId,
        depth: u32,
    ) -> Result<ValueId, Refused> {
        if self.builder.number(x) == Some(0.0) {
            return Ok(x);
        }
        if depth > 0 && self.has_zero_branch(x, depth) {
            match self.builder.operation(x) {
                Operation::Select(comparison, [left, right, yes, no]) => {
                    let yes = self.scaled_within(operator, yes, by, depth - 1)?;
                    let no = self.scaled_within(operator, no, by, depth - 1)?;
                    let select = Operation::Select(comparison, [left, right, yes, no]);
                    return self.builder.value(select);
                }
                Operation::Negative(inner) => {
                    let inner = self.scaled_within(operator, inner, by, depth - 1)?;
                    return self.builder.negative(inner);
                }
                _ => {}
            }
        }
        match operator {
            Operator::Multiply => self.builder.binary(operator, by, x),
            _ => self.builder.binary(operator, x, by),
        }
    }

    fn has_zero_branch(&self, x: ValueId, depth: u32) -> bool {
        match self.builder.operation(x) {
            Operation::Constant(number) => number == 0.0,
            Operation::Negative(inner) if depth > 0 => self.has_zero_branch(inner, depth - 1),
            Operation::Select(_, [_, _, yes, no]) if depth > 0 => {
                self.has_zero_branch(yes, depth - 1) || self.has_zero_branch(no, depth - 1)
            }
            _ => false,
        }
    }

    /// The derivative of the lesser or greater of two: of the second where the comparison holds or the first is not a
    /// number, else of the first.
    fn follow(
        &mut self,
        second: Comparison,
        [x, y]: [ValueId; 2],
        dx: Option<ValueId>,
        dy: Option<ValueId>,
    ) -> Result<Option<ValueId>, Refused> {
        let first = if self.builder.number(x).is_some() {
            dx
        } else {
            // What is not a number does not equal itself.
            self.either(Comparison::GreaterOrEqual, [x, x], dx, dy)?
        };
        self.either(second, [x, y], dy, first)
    }

    fn either(
        &mut self,
        comparison: Comparison,
        [left, right]: [ValueId; 2],
        yes: Option<ValueId>,
        no: Option<ValueId>,
    ) -> Result<Option<ValueId>, Refused> {
        if yes.is_none() && no.is_none() {
            return Ok(None);
        }
        let zero = self.builder.constant(0.0)?;
        let of = [left, right, yes.unwrap_or(zero), no.unwrap_or(zero)];
        let select = Operation::Select(comparison, of);
        self.builder.value(select).map(Some)
    }
}

#[cfg(test)]
mod tests;
