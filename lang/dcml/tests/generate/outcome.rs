//! What a model gives, by the reference: and how far another program may be from it.
//!
//! A function of another library may differ by some units in the last place, and what follows can make that larger
//! without limit. So the reference is computed again and again with its functions a little off: how far the results move
//! is how far they may be.

use lang_dcml::function::Function;
use lang_dcml::lower::lower;
use lang_dcml::model::Model;
use lang_dcml::syntax::{Domain, Kind};
use lang_dcml::tape::{Input, Lowered, Operation, Tape};
use needs::Random;
use std::f64::consts::PI;

/// The length of a step.
pub const DT: f64 = 0.01;
const TRIALS: u32 = 6;
/// How far functions may be off, in units of the last place.
const OFF: f64 = 5.0;

/// One state, action and set of parameters.
#[derive(Clone, Debug)]
pub struct Case {
    pub state: Vec<f64>,
    pub action: Vec<f64>,
    pub params: Vec<f64>,
}

/// Cases for a model.
pub fn cases(model: &Model, count: usize) -> Vec<Case> {
    let mut dice = Random::new(model.name.len() as u32 + 11);
    let mut several = |count: usize, size: f64| (0..count).map(|_| dice.signed() * size).collect();
    let (states, actions) = (model.states().count(), model.of_kind(Kind::Action).count());
    let params = model.of_kind(Kind::Param).count();
    let mut case = |_| Case {
        state: several(states, 4.0),
        action: several(actions, 3.0),
        params: several(params, 2.0),
    };
    (0..count).map(&mut case).collect()
}

/// A tape whose functions are `off(value)`.
fn walk(tape: &Tape, case: &Case, state: &[f64], off: &mut dyn FnMut(f64) -> f64) -> Vec<f64> {
    let mut values: Vec<f64> = Vec::new();
    for operation in &tape.operations {
        let of = |id: u32| values[id as usize];
        values.push(match *operation {
            Operation::Constant(number) => number,
            Operation::Input(Input::State(at)) => state[at as usize],
            Operation::Input(Input::Action(at)) => case.action[at as usize],
            Operation::Input(Input::Param(at)) => case.params[at as usize],
            Operation::Negative(value) => -of(value),
            Operation::Binary(operator, left, right) => operator.apply(of(left), of(right)),
            Operation::Call(function, x, y) => {
                let value = function.apply(of(x), of(y));
                let is_exact = matches!(
                    function,
                    Function::Sqrt
                        | Function::Abs
                        | Function::Min
                        | Function::Max
                        | Function::Sign
                        | Function::Floor
                );
                if is_exact { value } else { off(value) }
            }
            Operation::Select(comparison, [left, right, yes, no]) => {
                of(if comparison.holds(of(left), of(right)) {
                    yes
                } else {
                    no
                })
            }
        });
    }
    tape.results.iter().map(|id| values[*id as usize]).collect()
}

/// Everything that a generated program prints for a case: derivative, outputs, both Jacobians, the state after a step.
fn all(model: &Model, lowered: &Lowered, case: &Case, off: &mut dyn FnMut(f64) -> f64) -> Vec<f64> {
    let mut out = Vec::new();
    let tapes = [
        &lowered.derivative,
        &lowered.outputs,
        &lowered.state_jacobian,
        &lowered.action_jacobian,
    ];
    for tape in tapes {
        out.extend(walk(tape, case, &case.state, off));
    }
    let shifted = |k: &[f64], part: f64| -> Vec<f64> {
        case.state
            .iter()
            .zip(k)
            .map(|(x, k)| x + part * k)
            .collect()
    };
    let mut rate = |state: &[f64]| walk(&lowered.derivative, case, state, off);
    let k1 = rate(&case.state);
    let k2 = rate(&shifted(&k1, DT / 2.0));
    let k3 = rate(&shifted(&k2, DT / 2.0));
    let k4 = rate(&shifted(&k3, DT));
    for (at, symbol) in model.states().enumerate() {
        let slopes = k1[at] + 2.0 * k2[at] + 2.0 * k3[at] + k4[at];
        let next = case.state[at] + DT / 6.0 * slopes;
        out.push(match symbol.domain {
            Some(Domain::Circle) => next - 2.0 * PI * ((next - PI) / (2.0 * PI)).ceil(),
            _ => next,
        });
    }
    out
}

/// A result and how far it may be off; `None` if any value is as good as another.
pub struct Expected {
    pub value: f64,
    pub tolerance: Option<f64>,
}

/// What a program has to print for a case.
pub fn expected(model: &Model, case: &Case) -> Vec<Expected> {
    let lowered = lower(model).unwrap();
    let exact = all(model, &lowered, case, &mut |value| value);
    let reference = lowered
        .derivative
        .reference(&case.state, &case.action, &case.params);
    let same = |(one, other): (&f64, &f64)| {
        one.to_bits() == other.to_bits() || one.is_nan() && other.is_nan()
    };
    assert!(
        reference.iter().zip(&exact).all(same),
        "the walk is not the reference"
    );
    let mut expected: Vec<Expected> = exact
        .iter()
        .map(|value| Expected {
            value: *value,
            tolerance: Some(if value.is_finite() {
                value.abs() * 1e-12
            } else {
                0.0
            }),
        })
        .collect();
    let mut dice = Random::new(17);
    for _ in 0..TRIALS {
        let mut off = |value: f64| value + dice.signed() * OFF * f64::EPSILON * value;
        for (one, moved) in expected
            .iter_mut()
            .zip(all(model, &lowered, case, &mut off))
        {
            let is_known = one.value.is_finite() == moved.is_finite()
                && (one.value.is_finite()
                    || one.value == moved
                    || one.value.is_nan() && moved.is_nan());
            let distance = (one.value - moved).abs();
            one.tolerance = match one.tolerance {
                _ if !is_known || distance > 1e-6 * one.value.abs() => None,
                Some(old) if one.value.is_finite() => Some(old.max(8.0 * distance)),
                old => old,
            };
        }
    }
    expected
}

impl Expected {
    /// Whether a printed number is this one.
    pub fn is(&self, got: f64) -> bool {
        match self.tolerance {
            None => true,
            Some(_) if self.value.is_nan() => got.is_nan(),
            Some(_) if self.value.is_infinite() => got == self.value,
            // Below the smallest normal number there are few digits.
            Some(tolerance) => (got - self.value).abs() <= tolerance.max(f64::MIN_POSITIVE),
        }
    }
}
