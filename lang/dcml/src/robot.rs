//! A model with the parameters of one robot: the system that solvers and planners run.
//!
//! Owns what is known of each state and action. The numbers are `run`'s part.

use super::lower::{Refused, equations, lower};
use super::model::Model;
use super::run::batch::Batch;
use super::run::{Machine, Program};
use super::syntax::{Domain, Kind};
use super::system::System;

/// A robot: its derivatives and outputs.
#[derive(Clone, Debug)]
pub struct Robot {
    name: String,
    states: Vec<Part>,
    actions: Vec<Part>,
    outputs: Vec<Part>,
    derivative: Machine,
    output: Machine,
}

/// A state, action or output of a robot.
#[derive(Clone, Debug, PartialEq)]
pub struct Part {
    /// Its name in the model.
    pub name: String,
    /// Its unit, if the model says so.
    pub unit: Option<String>,
    /// Where it may be, if the model says so.
    pub domain: Option<Domain>,
}

impl Part {
    fn of(symbol: &super::model::Symbol) -> Self {
        Self {
            name: symbol.name.clone(),
            unit: symbol.unit.clone(),
            domain: symbol.domain,
        }
    }
}

impl Robot {
    /// A robot of a model, with a number for each parameter in the order of declaration.
    ///
    /// # Errors
    ///
    /// [`Refused`] if there are more or fewer parameters, one is not finite, or the model is too large.
    pub fn new(model: &Model, params: &[f64]) -> Result<Self, Refused> {
        checked(model, params)?;
        let code = equations(model)?;
        Ok(Self {
            name: model.name.clone(),
            states: model.states().map(Part::of).collect(),
            actions: model.of_kind(Kind::Action).map(Part::of).collect(),
            outputs: model.outputs().map(Part::of).collect(),
            derivative: Machine::new(Program::new(&code.derivative, params)?),
            output: Machine::new(Program::new(&code.outputs, params)?),
        })
    }

    /// The name of its model.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Its states, in the order of their numbers.
    pub fn state_parts(&self) -> &[Part] {
        &self.states
    }

    /// Its actions, in the order of their numbers.
    pub fn action_parts(&self) -> &[Part] {
        &self.actions
    }

    /// Its outputs, in the order of their numbers.
    pub fn output_parts(&self) -> &[Part] {
        &self.outputs
    }

    /// Computes the outputs, as many as there are [`Self::output_parts`].
    pub fn output(&mut self, state: &[f64], action: &[f64], outputs: &mut [f64]) {
        self.output.run(state, action, outputs);
    }

    /// The same derivatives for many states at a time.
    ///
    /// # Errors
    ///
    /// [`Refused`] if the model is too large for that.
    pub fn batch(&self) -> Result<Batch, Refused> {
        Batch::new(self.derivative.program().clone())
    }
}

impl System for Robot {
    fn states(&self) -> usize {
        self.states.len()
    }

    fn actions(&self) -> usize {
        self.actions.len()
    }

    fn wraps(&self, state: usize) -> bool {
        let part = self.states.get(state);
        part.is_some_and(|one| one.domain == Some(Domain::Circle))
    }

    fn action_range(&self, action: usize) -> Option<(f64, f64)> {
        match self.actions.get(action)?.domain? {
            Domain::Range(from, to) => Some((from, to)),
            Domain::Circle => None,
        }
    }

    fn outputs(&self) -> usize {
        self.outputs.len()
    }

    fn output(&mut self, state: &[f64], action: &[f64], outputs: &mut [f64]) {
        Self::output(self, state, action, outputs);
    }

    fn derivative(&mut self, state: &[f64], action: &[f64], derivative: &mut [f64]) {
        self.derivative.run(state, action, derivative);
    }
}

/// How the derivatives of a robot change with its state and its action.
#[derive(Clone, Debug)]
pub struct Jacobians {
    state: Machine,
    action: Machine,
}

impl Jacobians {
    /// Those of a model, with a number for each parameter.
    ///
    /// # Errors
    ///
    /// As [`Robot::new`]; Jacobians are larger than models.
    pub fn new(model: &Model, params: &[f64]) -> Result<Self, Refused> {
        checked(model, params)?;
        let code = lower(model)?;
        Ok(Self {
            state: Machine::new(Program::new(&code.state_jacobian, params)?),
            action: Machine::new(Program::new(&code.action_jacobian, params)?),
        })
    }

    /// df/dx, row after row: a row for each state, in it an element for each state.
    pub fn by_state(&mut self, state: &[f64], action: &[f64], elements: &mut [f64]) {
        self.state.run(state, action, elements);
    }

    /// df/du, row after row: a row for each state, in it an element for each action.
    pub fn by_action(&mut self, state: &[f64], action: &[f64], elements: &mut [f64]) {
        self.action.run(state, action, elements);
    }
}

/// Whether these can be the parameters of the model.
fn checked(model: &Model, params: &[f64]) -> Result<(), Refused> {
    let wanted = model.of_kind(Kind::Param).count();
    if wanted != params.len() {
        return Err(Refused::Parameters(wanted, params.len()));
    }
    for (symbol, number) in model.of_kind(Kind::Param).zip(params) {
        if !number.is_finite() {
            return Err(Refused::Parameter(symbol.name.clone(), *number));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests;
