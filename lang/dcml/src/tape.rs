//! Straight-line code: what a model computes, each value once, each after what it needs.
//!
//! Owns the form between `lower` and everything that runs or prints it, and the slow reference that says what it means.
//! Knows no names: values have numbers, inputs have places.

use super::function::Function;
use super::lower::Refused;
use super::syntax::{Comparison, Operator};

/// The number of a value: the place of its operation in [`Tape::operations`].
pub type ValueId = u32;

/// What comes from outside.
#[derive(Clone, Copy, Debug, Eq, PartialEq, Hash)]
pub enum Input {
    /// A part of the state: configuration with derivatives, in the order of declaration.
    State(u32),
    /// An action, in the order of declaration.
    Action(u32),
    /// A parameter, in the order of declaration.
    Param(u32),
}

/// How one value comes from values before it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Operation {
    /// A number; never one that is not finite.
    Constant(f64),
    /// From outside.
    Input(Input),
    /// The opposite.
    Negative(ValueId),
    /// Two values.
    Binary(Operator, ValueId, ValueId),
    /// A function; those of one argument have it twice.
    Call(Function, ValueId, ValueId),
    /// The third if the first two compare so, else the fourth.
    Select(Comparison, [ValueId; 4]),
}

/// Operations in an order in which each needs only what stands before it, and which values are asked for.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Tape {
    /// Each value once: no two are the same, and each is needed.
    pub operations: Vec<Operation>,
    /// The values that are the results; one may be asked for twice.
    pub results: Vec<ValueId>,
}

/// A model as tapes. States are what has derivatives, outputs the rest of the configuration.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Lowered {
    /// One result for each state: its derivative.
    pub derivative: Tape,
    /// One result for each output.
    pub outputs: Tape,
    /// The Jacobian df/dx, row after row: a result for each pair of derivative and state.
    pub state_jacobian: Tape,
    /// The Jacobian df/du, row after row: a result for each pair of derivative and action.
    pub action_jacobian: Tape,
}

impl Operation {
    /// Tells each value that it needs; one may come twice.
    pub fn each_operand(&self, mut told: impl FnMut(ValueId)) {
        match *self {
            Self::Constant(_) | Self::Input(_) => (),
            Self::Negative(value) => told(value),
            Self::Call(function, x, _) if function.arguments() == 1 => told(x),
            Self::Binary(_, x, y) | Self::Call(_, x, y) => {
                told(x);
                told(y);
            }
            Self::Select(_, of) => of.into_iter().for_each(told),
        }
    }

    /// The same operation with other operands.
    pub fn with(&self, mut place: impl FnMut(ValueId) -> ValueId) -> Self {
        match *self {
            Self::Constant(_) | Self::Input(_) => *self,
            Self::Negative(value) => Self::Negative(place(value)),
            Self::Binary(operator, left, right) => {
                Self::Binary(operator, place(left), place(right))
            }
            Self::Call(function, x, _) if function.arguments() == 1 => {
                let x = place(x);
                Self::Call(function, x, x)
            }
            Self::Call(function, x, y) => Self::Call(function, place(x), place(y)),
            Self::Select(comparison, of) => Self::Select(comparison, of.map(place)),
        }
    }
}

impl Comparison {
    /// Whether it holds.
    pub fn holds(self, left: f64, right: f64) -> bool {
        match self {
            Self::Less => left < right,
            Self::LessOrEqual => left <= right,
            Self::Greater => left > right,
            Self::GreaterOrEqual => left >= right,
        }
    }
}

impl Operator {
    /// Its value.
    pub fn apply(self, left: f64, right: f64) -> f64 {
        match self {
            Self::Add => left + right,
            Self::Subtract => left - right,
            Self::Multiply => left * right,
            Self::Divide => left / right,
        }
    }
}

impl Tape {
    /// Whether each operation needs only what stands before it, and each result is there.
    ///
    /// # Errors
    ///
    /// [`Refused::Malformed`] if not; what was lowered always is.
    pub fn ordered(&self) -> Result<(), Refused> {
        let mut is_right = true;
        for (id, operation) in self.operations.iter().enumerate() {
            operation.each_operand(|of| is_right &= (of as usize) < id);
        }
        let count = self.operations.len();
        is_right &= self.results.iter().all(|id| (*id as usize) < count);
        let wrong = || Refused::Malformed("a value is needed before it is there".into());
        is_right.then_some(()).ok_or_else(wrong)
    }

    /// What it means: the results, one operation after another. For tests and for callers that need one value; `run` is the
    /// fast way. An input that is not given is not a number.
    pub fn reference(&self, state: &[f64], action: &[f64], params: &[f64]) -> Vec<f64> {
        let mut values: Vec<f64> = Vec::with_capacity(self.operations.len());
        for operation in &self.operations {
            let of = |id: ValueId| values.get(id as usize).copied().unwrap_or(f64::NAN);
            let given = |all: &[f64], at: u32| all.get(at as usize).copied().unwrap_or(f64::NAN);
            values.push(match *operation {
                Operation::Constant(number) => number,
                Operation::Input(Input::State(at)) => given(state, at),
                Operation::Input(Input::Action(at)) => given(action, at),
                Operation::Input(Input::Param(at)) => given(params, at),
                Operation::Negative(value) => -of(value),
                Operation::Binary(operator, left, right) => operator.apply(of(left), of(right)),
                Operation::Call(function, x, y) => function.apply(of(x), of(y)),
                Operation::Select(comparison, [left, right, yes, no]) => {
                    of(if comparison.holds(of(left), of(right)) {
                        yes
                    } else {
                        no
                    })
                }
            });
        }
        let result = |id: &ValueId| values.get(*id as usize).copied().unwrap_or(f64::NAN);
        self.results.iter().map(result).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_computed_in_order() {
        let tape = Tape {
            operations: vec![
                Operation::Input(Input::State(0)),
                Operation::Call(Function::Cos, 0, 0),
                Operation::Input(Input::Param(0)),
                Operation::Binary(Operator::Divide, 1, 2),
                Operation::Select(Comparison::Less, [0, 2, 3, 0]),
            ],
            results: vec![3, 4, 4],
        };
        assert_eq!(tape.reference(&[0.0], &[], &[4.0]), [0.25, 0.25, 0.25]);
        assert_eq!(tape.reference(&[0.0], &[], &[-4.0]), [-0.25, 0.0, 0.0]);
        assert!(tape.reference(&[], &[], &[4.0])[0].is_nan());
    }
}
