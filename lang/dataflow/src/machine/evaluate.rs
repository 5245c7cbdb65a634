//! Tokens as numbers, and expressions with the robot as they see it.
//!
//! Owns where an error is: at a port, or in the text of a property. Knows no order of tokens.

use super::formulas::{Reason, Refused};
use super::sensors::Robot;
use super::{Env, Halt, Machine, values, words};
use crate::program::{Formula, Target};
use crate::sensors;
use lang_expr::{Value, Wanted};
use lang_text::problem::{Problem, Words};
use std::rc::Rc;

impl Machine {
    /// The whole number of a token, or an error at its port.
    pub(super) fn whole(&self, to: Target, value: &Value, env: &Env<'_>) -> Result<i32, Halt> {
        values::whole(value).map_err(|words| self.fault_at_port(to, words, env))
    }

    /// The value of an expression.
    pub(super) fn evaluate(&mut self, formula: Formula, env: &mut Env<'_>) -> Result<Value, Halt> {
        let mut value = Value::Nil;
        self.evaluate_to(formula, &mut value, env)?;
        Ok(value)
    }

    /// The same, written where it is wanted.
    pub(super) fn evaluate_to(
        &mut self,
        formula: Formula,
        into: &mut Value,
        env: &mut Env<'_>,
    ) -> Result<(), Halt> {
        let state = &self.states[self.formulas.node(formula) as usize];
        let mut robot = Robot {
            readings: &mut self.readings,
            brick: env.brick,
            now: self.now,
            missing: None,
        };
        let outcome = self
            .formulas
            .evaluate(env.program, formula, state, &mut robot, into);
        match (outcome, robot.missing) {
            (Ok(()), None) => Ok(()),
            (outcome, missing) => Err(self.explain(formula, outcome.err(), missing, env)),
        }
    }

    /// The truth of an expression.
    pub(super) fn truth(&mut self, formula: Formula, env: &mut Env<'_>) -> Result<bool, Halt> {
        let state = &self.states[self.formulas.node(formula) as usize];
        let mut robot = Robot {
            readings: &mut self.readings,
            brick: env.brick,
            now: self.now,
            missing: None,
        };
        let truth = self.formulas.truth(env.program, formula, state, &mut robot);
        match (truth, robot.missing) {
            (Ok(truth), None) => Ok(truth),
            (truth, missing) => Err(self.explain(formula, truth.err(), missing, env)),
        }
    }

    /// Where and why an expression failed: a sensor is missing, or there is another reason.
    #[cold]
    fn explain(
        &self,
        formula: Formula,
        reason: Option<Reason>,
        missing: Option<u16>,
        env: &Env<'_>,
    ) -> Halt {
        let (words, at) = match (missing, reason) {
            (Some(sensor), _) => (words::sensor_missing(sensors::name(sensor)), None),
            (None, Some(Reason::Unbound(name))) => (words::unbound(name), None),
            (None, Some(Reason::Unit(name))) => (words::unit_read(name), None),
            (None, Some(Reason::Problems(problems))) => {
                let first = problems.into_iter().next();
                let first = first.unwrap_or_else(|| Problem::error(Words::new("", "")));
                (first.words, first.place.position)
            }
            (None, None) => (Words::new("", ""), None),
        };
        let text = &env.program.formulas[formula as usize];
        let place = env.program.property_place(text.node, text.property, at);
        self.fault_at(place, words)
    }

    /// The text of an expression that came as a token.
    pub(super) fn evaluate_token(
        &mut self,
        to: Target,
        text: &str,
        env: &mut Env<'_>,
    ) -> Result<Rc<str>, Halt> {
        let mut robot = Robot {
            readings: &mut self.readings,
            brick: env.brick,
            now: self.now,
            missing: None,
        };
        let value = self.formulas.evaluate_text(text, Wanted::Text, &mut robot);
        if let Some(sensor) = robot.missing {
            let words = words::sensor_missing(sensors::name(sensor));
            return Err(self.fault_at_port(to, words, env));
        }
        match value {
            Ok(value) => self.at_port(to, values::text(&value), env),
            Err(Refused::Assigns) => Err(self.fault_at_port(to, words::assigning_text(), env)),
            Err(Refused::Unknown(name)) => {
                let words = words::unknown_in_text(&name);
                Err(self.fault_at_port(to, words, env))
            }
            Err(Refused::Problems(problems)) => {
                let first = problems.into_iter().next();
                let words = first.map_or_else(words::unit, |problem| problem.words);
                Err(self.fault_at_port(to, words, env))
            }
        }
    }
}
