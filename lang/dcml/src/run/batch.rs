//! Many states at a time: each step for a block of them, in loops that a compiler makes wide.
//!
//! Owns the form of the data, a row for each part of the state, and the blocks. Results are those of one state at a time,
//! but for sines and cosines, which are within 1e-12.

use super::trig::sin_cos;
use super::{Program, Step};
use crate::function::Function;
use crate::limits;
use crate::lower::Refused;
use crate::syntax::Operator;
use crate::tape::Input;

/// How many states a step does at a time.
pub(super) const LANES: usize = 64;

type Row = Box<[f64; LANES]>;

/// A program with registers for a block of states.
#[derive(Clone, Debug)]
pub struct Batch {
    program: Program,
    rows: Vec<Row>,
    /// Where steps write, before it changes its place with a row.
    spare: [Row; 2],
}

impl Batch {
    /// For a program.
    ///
    /// # Errors
    ///
    /// [`Refused`] if it has more than [`limits::DCML_BATCH_ROWS_MAX`] registers.
    pub fn new(program: Program) -> Result<Self, Refused> {
        if program.registers > limits::DCML_BATCH_ROWS_MAX {
            return Err(Refused::TooLarge(
                "values at the same time",
                limits::DCML_BATCH_ROWS_MAX,
            ));
        }
        let empty = || Box::new([0.0; LANES]);
        let mut rows: Vec<Row> = (0..program.registers).map(|_| empty()).collect();
        for (row, constant) in rows.iter_mut().zip(&program.constants) {
            row.fill(*constant);
        }
        Ok(Self {
            program,
            rows,
            spare: [empty(), empty()],
        })
    }

    /// How many results each state has.
    pub fn results(&self) -> usize {
        self.program.results()
    }

    /// Computes the results of `count` states. All three are rows of `count` numbers: one for each part of a state, of an
    /// action, of the results. What is not given is not a number, and results without a place are dropped.
    pub fn run(&mut self, count: usize, states: &[f64], actions: &[f64], results: &mut [f64]) {
        let mut from = 0;
        while from < count {
            let lanes = LANES.min(count - from);
            for (input, register) in &self.program.loads {
                let (rows, at) = match *input {
                    Input::State(at) => (states, at),
                    Input::Action(at) => (actions, at),
                    Input::Param(at) => (&[] as &[f64], at),
                };
                let begin = at as usize * count + from;
                let row = &mut self.rows[*register as usize];
                match rows.get(begin..begin + lanes) {
                    Some(given) => row[..lanes].copy_from_slice(given),
                    None => row.fill(f64::NAN),
                }
            }
            for step in &self.program.steps {
                perform(step, &mut self.rows, &mut self.spare);
            }
            for (at, register) in self.program.results.iter().enumerate() {
                let begin = at * count + from;
                if let Some(place) = results.get_mut(begin..begin + lanes) {
                    place.copy_from_slice(&self.rows[*register as usize][..lanes]);
                }
            }
            from += lanes;
        }
    }
}

/// One step of a block. It writes into a spare row, which then changes its place with the one that it is for.
fn perform(step: &Step, rows: &mut [Row], [spare, beside]: &mut [Row; 2]) {
    let row = |at: u32| &*rows[at as usize];
    let to = match *step {
        Step::Negative(to, x) => {
            one(spare, row(x), |x| -x);
            to
        }
        Step::Binary(operator, to, [x, y]) => {
            let (x, y) = (row(x), row(y));
            match operator {
                Operator::Add => two(spare, x, y, |x, y| x + y),
                Operator::Subtract => two(spare, x, y, |x, y| x - y),
                Operator::Multiply => two(spare, x, y, |x, y| x * y),
                Operator::Divide => two(spare, x, y, |x, y| x / y),
            }
            to
        }
        Step::SinCos([sin, cos], x) => {
            sin_cos(row(x), spare, beside);
            std::mem::swap(beside, &mut rows[cos as usize]);
            sin
        }
        Step::Call(function, to, [x, y]) => {
            call(function, spare, beside, row(x), row(y));
            to
        }
        Step::Select(comparison, to, [left, right, yes, no]) => {
            let (left, right, yes, no) = (row(left), row(right), row(yes), row(no));
            for lane in 0..LANES {
                let holds = comparison.holds(left[lane], right[lane]);
                spare[lane] = if holds { yes[lane] } else { no[lane] };
            }
            to
        }
    };
    std::mem::swap(spare, &mut rows[to as usize]);
}

type Block = [f64; LANES];

#[inline(always)]
fn one(to: &mut Block, x: &Block, value: impl Fn(f64) -> f64) {
    for lane in 0..LANES {
        to[lane] = value(x[lane]);
    }
}

#[inline(always)]
fn two(to: &mut Block, x: &Block, y: &Block, value: impl Fn(f64, f64) -> f64) {
    for lane in 0..LANES {
        to[lane] = value(x[lane], y[lane]);
    }
}

/// Functions; those that a processor has itself are made wide.
fn call(function: Function, to: &mut Block, beside: &mut Block, x: &Block, y: &Block) {
    match function {
        Function::Sin => sin_cos(x, to, beside),
        Function::Cos => sin_cos(x, beside, to),
        Function::Sqrt => one(to, x, f64::sqrt),
        Function::Abs => one(to, x, f64::abs),
        Function::Sign => one(to, x, |x| Function::Sign.apply(x, x)),
        Function::Min => two(to, x, y, f64::min),
        Function::Max => two(to, x, y, f64::max),
        _ => two(to, x, y, |x, y| function.apply(x, y)),
    }
}
