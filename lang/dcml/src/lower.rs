//! From a checked model to straight-line code.
//!
//! Owns which value each name has, and what is refused because it would be too large. How values are shared and folded is
//! `fold`'s part, how they are differentiated `jacobian`'s.

use super::fold::Builder;
use super::jacobian;
use super::model::{Condition, Expr, Model};
use super::syntax::Kind;
use super::tape::{Input, Lowered, Operation, Tape, ValueId};
use crate::limits;
use std::fmt;

/// Why there is no code.
#[derive(Clone, Debug, PartialEq)]
pub enum Refused {
    /// There would be more of these than this many.
    TooLarge(&'static str, usize),
    /// A number that is none, or has no end.
    NotFinite(f64),
    /// The model is none that a check has made; what is wrong.
    Malformed(String),
    /// There are as many parameters as the first number, but the second was given.
    Parameters(usize, usize),
    /// A parameter, by its name, with a number that is none, or has no end.
    Parameter(String, f64),
}

impl fmt::Display for Refused {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::TooLarge(what, limit) => {
                write!(f, "the model is too large: more than {limit} {what}")
            }
            Self::NotFinite(number) => write!(f, "{number} is no number that a model can have"),
            Self::Malformed(what) => f.write_str(what),
            Self::Parameters(wanted, given) => {
                write!(
                    f,
                    "the model has {wanted} parameters, and {given} were given"
                )
            }
            Self::Parameter(name, number) => {
                write!(f, "the parameter {name} cannot be {number}: give a number")
            }
        }
    }
}

impl std::error::Error for Refused {}

/// Code for all that a model can be asked for.
///
/// # Errors
///
/// [`Refused`] if it would be too large: [`limits::DCML_OPERATIONS_MAX`], [`limits::DCML_JACOBIAN_MAX`].
pub fn lower(model: &Model) -> Result<Lowered, Refused> {
    let Equations {
        derivative,
        outputs,
    } = equations(model)?;
    let states: Vec<Input> = (0..model.states().count() as u32)
        .map(Input::State)
        .collect();
    let actions: Vec<Input> = (0..model.of_kind(Kind::Action).count() as u32)
        .map(Input::Action)
        .collect();
    Ok(Lowered {
        state_jacobian: jacobian::jacobian(&derivative, &states)?,
        action_jacobian: jacobian::jacobian(&derivative, &actions)?,
        derivative,
        outputs,
    })
}

/// A model without its Jacobians, which are the larger part by far.
#[derive(Clone, Debug, PartialEq)]
pub struct Equations {
    /// One result for each state: its derivative.
    pub derivative: Tape,
    /// One result for each output.
    pub outputs: Tape,
}

/// Code for the derivatives and outputs of a model alone.
///
/// # Errors
///
/// [`Refused`] if it would be too large.
pub fn equations(model: &Model) -> Result<Equations, Refused> {
    let mut lowering = Lowering::of(model)?;
    let mut derivatives: Vec<Option<ValueId>> = vec![None; model.symbols.len()];
    for equation in &model.equations {
        let value = lowering.expr(&equation.value, 0)?;
        let values = if equation.is_derivative {
            &mut derivatives
        } else {
            &mut lowering.values
        };
        let Some(place) = values.get_mut(equation.target) else {
            return Err(Refused::Malformed("an equation is of no symbol".into()));
        };
        *place = Some(value);
    }
    let mut rates = Vec::new();
    let mut outputs = Vec::new();
    for (id, symbol) in model.symbols.iter().enumerate() {
        match (symbol.kind, derivatives[id], lowering.values[id]) {
            (Kind::Config, Some(rate), _) => rates.push(rate),
            (Kind::Config, None, Some(value)) => outputs.push(value),
            (Kind::Config, None, None) => {
                let name = &symbol.name;
                return Err(Refused::Malformed(format!("{name} has no equation")));
            }
            _ => (),
        }
    }
    Ok(Equations {
        derivative: lowering.builder.tape(&rates),
        outputs: lowering.builder.tape(&outputs),
    })
}

struct Lowering<'a> {
    model: &'a Model,
    builder: Builder,
    /// Of each symbol, when it has one.
    values: Vec<Option<ValueId>>,
}

impl<'a> Lowering<'a> {
    /// With values of all that is given: actions, parameters, constants, states.
    fn of(model: &'a Model) -> Result<Self, Refused> {
        let mut builder = Builder::new();
        let mut is_state = vec![false; model.symbols.len()];
        for equation in model.equations.iter().filter(|one| one.is_derivative) {
            if let Some(one) = is_state.get_mut(equation.target) {
                *one = true;
            }
        }
        let (mut states, mut actions, mut params) = (0.., 0.., 0..);
        let mut values = Vec::with_capacity(model.symbols.len());
        for (symbol, is_state) in model.symbols.iter().zip(is_state) {
            let input = match symbol.kind {
                Kind::Action => actions.next().map(Input::Action),
                Kind::Param => params.next().map(Input::Param),
                Kind::Config if is_state => states.next().map(Input::State),
                Kind::Const | Kind::Config | Kind::Var => None,
            };
            values.push(match input {
                Some(input) => Some(builder.value(Operation::Input(input))?),
                None if symbol.kind == Kind::Const => Some(builder.constant(symbol.value)?),
                None => None,
            });
        }
        Ok(Self {
            model,
            builder,
            values,
        })
    }

    fn expr(&mut self, expr: &Expr, depth: usize) -> Result<ValueId, Refused> {
        if depth > limits::DCML_DEPTH {
            return Err(Refused::TooLarge(
                "expressions in each other",
                limits::DCML_DEPTH,
            ));
        }
        let deeper = depth + 1;
        match expr {
            Expr::Number(number) => self.builder.constant(*number),
            Expr::Symbol(id) => self.symbol(*id),
            Expr::Negative(value) => {
                let value = self.expr(value, deeper)?;
                self.builder.negative(value)
            }
            Expr::Binary(operator, left, right) => {
                let left = self.expr(left, deeper)?;
                let right = self.expr(right, deeper)?;
                self.builder.binary(*operator, left, right)
            }
            Expr::Call(function, arguments) => {
                let given: Result<Vec<ValueId>, Refused> =
                    arguments.iter().map(|one| self.expr(one, deeper)).collect();
                match (function.arguments(), given?.as_slice()) {
                    (1, [x]) => self.builder.value(Operation::Call(*function, *x, *x)),
                    (2, [x, y]) => self.builder.value(Operation::Call(*function, *x, *y)),
                    _ => {
                        let name = function.name();
                        Err(Refused::Malformed(format!(
                            "{name} has the wrong number of arguments"
                        )))
                    }
                }
            }
            Expr::Piecewise(branches, otherwise) => self.piecewise(branches, otherwise, deeper),
        }
    }

    fn symbol(&self, id: usize) -> Result<ValueId, Refused> {
        self.values.get(id).copied().flatten().ok_or_else(|| {
            let name = self.model.symbols.get(id).map(|one| one.name.as_str());
            let name = name.unwrap_or("a symbol");
            Refused::Malformed(format!("{name} is used before it has a value"))
        })
    }

    /// Branches from the last to the first, each with the ones after it as its other side.
    fn piecewise(
        &mut self,
        branches: &[(Condition, Expr)],
        otherwise: &Expr,
        depth: usize,
    ) -> Result<ValueId, Refused> {
        let mut lowered = Vec::with_capacity(branches.len());
        for (condition, value) in branches {
            let left = self.expr(&condition.left, depth)?;
            let right = self.expr(&condition.right, depth)?;
            lowered.push((condition.comparison, left, right, self.expr(value, depth)?));
        }
        let mut rest = self.expr(otherwise, depth)?;
        for (comparison, left, right, value) in lowered.into_iter().rev() {
            let select = Operation::Select(comparison, [left, right, value, rest]);
            rest = self.builder.value(select)?;
        }
        Ok(rest)
    }
}

#[cfg(test)]
mod tests;
