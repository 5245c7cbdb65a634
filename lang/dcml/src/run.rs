//! The register machine: tapes with the parameters of one robot, made to be run often.
//!
//! Owns the compact form, with few registers that are used again, and the run of one state at a time, which allocates
//! nothing. Many states at a time are `run/batch`'s part. Results are those of [`Tape::reference`] to the last bit.

pub mod batch;
mod trig;

use super::fold::Builder;
use super::function::Function;
use super::lower::Refused;
use super::syntax::{Comparison, Operator};
use super::tape::{Input, Operation, Tape, ValueId};

/// The place of a number in the machine.
type Register = u32;

/// One step: registers to registers. Where it writes may be where it reads.
#[derive(Clone, Copy, Debug)]
enum Step {
    Negative(Register, Register),
    Binary(Operator, Register, [Register; 2]),
    Call(Function, Register, [Register; 2]),
    /// Sine and cosine of one angle, which come together nearly always.
    SinCos([Register; 2], Register),
    Select(Comparison, Register, [Register; 4]),
}

/// A tape that is ready to be run.
#[derive(Clone, Debug)]
pub struct Program {
    /// Numbers that never change: the first registers.
    constants: Vec<f64>,
    /// What comes from outside, and where it goes.
    loads: Vec<(Input, Register)>,
    steps: Vec<Step>,
    results: Vec<Register>,
    registers: usize,
}

impl Program {
    /// A tape with numbers for its parameters: what depends on nothing else is computed now.
    ///
    /// # Errors
    ///
    /// [`Refused`] if a parameter is not finite or missing, or the tape is none that was lowered.
    pub fn new(tape: &Tape, params: &[f64]) -> Result<Self, Refused> {
        let tape = bound(tape, params)?;
        let mut making = Making::of(&tape);
        for id in 0..tape.operations.len() {
            making.operation(id);
        }
        let place = |id: &ValueId| making.places[*id as usize];
        Ok(Self {
            results: tape.results.iter().map(place).collect(),
            registers: making.next as usize,
            constants: making.constants,
            loads: making.loads,
            steps: making.steps,
        })
    }

    /// How many results it gives.
    pub fn results(&self) -> usize {
        self.results.len()
    }

    /// How many numbers it keeps at the same time.
    pub fn registers(&self) -> usize {
        self.registers
    }
}

/// The tape with numbers for its parameters, folded again.
fn bound(tape: &Tape, params: &[f64]) -> Result<Tape, Refused> {
    tape.ordered()?;
    let mut builder = Builder::new();
    let mut place: Vec<ValueId> = Vec::with_capacity(tape.operations.len());
    for operation in &tape.operations {
        let value = match operation.with(|of| place[of as usize]) {
            Operation::Constant(number) => builder.constant(number)?,
            Operation::Input(Input::Param(at)) => {
                let missing = Refused::Parameters(at as usize + 1, params.len());
                builder.constant(*params.get(at as usize).ok_or(missing)?)?
            }
            // A quotient by a power of two is a product, to the last bit.
            Operation::Binary(Operator::Divide, x, y) => {
                match builder.number(y).and_then(inverse) {
                    Some(inverse) => {
                        let inverse = builder.constant(inverse)?;
                        builder.binary(Operator::Multiply, x, inverse)?
                    }
                    None => builder.binary(Operator::Divide, x, y)?,
                }
            }
            other => builder.value(other)?,
        };
        place.push(value);
    }
    let results: Vec<ValueId> = tape.results.iter().map(|id| place[*id as usize]).collect();
    Ok(builder.tape(&results))
}

/// The inverse of a power of two, where it is one without loss.
fn inverse(number: f64) -> Option<f64> {
    let inverse = number.recip();
    let is_power = number.to_bits() << 12 == 0 && number.is_normal() && inverse.is_normal();
    is_power.then_some(inverse)
}

/// Registers are given out here: constants first, then inputs, then those that are used again and again.
struct Making<'a> {
    tape: &'a Tape,
    /// By whom each value is needed last; results by nobody, which is never.
    last: Vec<usize>,
    /// The partner of each sine and cosine.
    partner: Vec<Option<ValueId>>,
    places: Vec<Register>,
    is_done: Vec<bool>,
    free: Vec<Register>,
    next: Register,
    constants: Vec<f64>,
    loads: Vec<(Input, Register)>,
    steps: Vec<Step>,
}

impl<'a> Making<'a> {
    fn of(tape: &'a Tape) -> Self {
        let count = tape.operations.len();
        let mut last = vec![0; count];
        for (id, operation) in tape.operations.iter().enumerate() {
            operation.each_operand(|of| last[of as usize] = id);
        }
        for id in &tape.results {
            last[*id as usize] = usize::MAX;
        }
        let mut making = Self {
            tape,
            last,
            partner: partners(tape),
            places: vec![0; count],
            is_done: vec![false; count],
            free: Vec::new(),
            next: 0,
            constants: Vec::new(),
            loads: Vec::new(),
            steps: Vec::new(),
        };
        for (id, operation) in tape.operations.iter().enumerate() {
            if let Operation::Constant(number) = operation {
                making.places[id] = making.fresh();
                making.constants.push(*number);
            }
        }
        for (id, operation) in tape.operations.iter().enumerate() {
            if let Operation::Input(input) = operation {
                making.places[id] = making.fresh();
                making.loads.push((*input, making.places[id]));
            }
        }
        making
    }

    fn fresh(&mut self) -> Register {
        self.next += 1;
        self.next - 1
    }

    fn taken(&mut self) -> Register {
        self.free.pop().unwrap_or_else(|| self.fresh())
    }

    fn operation(&mut self, id: usize) {
        let operation = self.tape.operations[id];
        let is_given = matches!(operation, Operation::Constant(_) | Operation::Input(_));
        if is_given || self.is_done[id] {
            return;
        }
        let placed = operation.with(|of| self.places[of as usize]);
        let mut ended = Vec::new();
        operation.each_operand(|of| {
            if self.last[of as usize] == id && !ended.contains(&of) {
                ended.push(of);
            }
        });
        for of in ended {
            let before = self.tape.operations[of as usize];
            if !matches!(before, Operation::Constant(_) | Operation::Input(_)) {
                self.free.push(self.places[of as usize]);
            }
        }
        let to = self.taken();
        self.places[id] = to;
        self.is_done[id] = true;
        let step = match placed {
            Operation::Negative(x) => Step::Negative(to, x),
            Operation::Binary(operator, x, y) => Step::Binary(operator, to, [x, y]),
            Operation::Call(function, x, y) => match self.partner[id] {
                Some(other) => {
                    let beside = self.taken();
                    self.places[other as usize] = beside;
                    self.is_done[other as usize] = true;
                    match function {
                        Function::Sin => Step::SinCos([to, beside], x),
                        _ => Step::SinCos([beside, to], x),
                    }
                }
                None => Step::Call(function, to, [x, y]),
            },
            Operation::Select(comparison, of) => Step::Select(comparison, to, of),
            Operation::Constant(_) | Operation::Input(_) => return,
        };
        self.steps.push(step);
    }
}

/// For each sine the cosine of the same value, and the other way round.
fn partners(tape: &Tape) -> Vec<Option<ValueId>> {
    let count = tape.operations.len();
    let mut sines = vec![None; count];
    let mut partner = vec![None; count];
    for pass in [Function::Sin, Function::Cos] {
        for (id, operation) in tape.operations.iter().enumerate() {
            match *operation {
                Operation::Call(function, x, _) if function == pass && pass == Function::Sin => {
                    sines[x as usize] = Some(id as ValueId);
                }
                Operation::Call(function, x, _) if function == pass => {
                    if let Some(sine) = sines[x as usize] {
                        partner[id] = Some(sine);
                        partner[sine as usize] = Some(id as ValueId);
                    }
                }
                _ => (),
            }
        }
    }
    partner
}

/// A program with registers of its own, for one state at a time.
#[derive(Clone, Debug)]
pub struct Machine {
    program: Program,
    registers: Vec<f64>,
}

impl Machine {
    /// A machine for a program.
    pub fn new(program: Program) -> Self {
        let mut registers = vec![0.0; program.registers];
        for (register, constant) in registers.iter_mut().zip(&program.constants) {
            *register = *constant;
        }
        Self { program, registers }
    }

    /// What it runs.
    pub fn program(&self) -> &Program {
        &self.program
    }

    /// Computes the results; what is not given is not a number, and results without a place are dropped.
    pub fn run(&mut self, state: &[f64], action: &[f64], results: &mut [f64]) {
        let registers = self.registers.as_mut_slice();
        for (input, register) in &self.program.loads {
            let given = match *input {
                Input::State(at) => state.get(at as usize),
                Input::Action(at) => action.get(at as usize),
                Input::Param(_) => None,
            };
            registers[*register as usize] = given.copied().unwrap_or(f64::NAN);
        }
        for step in &self.program.steps {
            perform(step, registers);
        }
        for (result, register) in results.iter_mut().zip(&self.program.results) {
            *result = registers[*register as usize];
        }
    }
}

#[inline]
fn perform(step: &Step, registers: &mut [f64]) {
    match *step {
        Step::Negative(to, x) => registers[to as usize] = -registers[x as usize],
        Step::Binary(operator, to, [x, y]) => {
            registers[to as usize] = operator.apply(registers[x as usize], registers[y as usize]);
        }
        Step::SinCos([sin, cos], x) => {
            let both = libm::sincos(registers[x as usize]);
            registers[sin as usize] = both.0;
            registers[cos as usize] = both.1;
        }
        Step::Call(function, to, [x, y]) => {
            registers[to as usize] = function.apply(registers[x as usize], registers[y as usize]);
        }
        Step::Select(comparison, to, [left, right, yes, no]) => {
            let holds = comparison.holds(registers[left as usize], registers[right as usize]);
            registers[to as usize] = registers[if holds { yes } else { no } as usize];
        }
    }
}

#[cfg(test)]
mod tests;
