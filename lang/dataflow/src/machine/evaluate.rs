//! Tokens as numbers, and expressions with the robot as they see it.
//!
//! Owns where an error is: at a port, or in the text of a property. Knows no order of tokens.

use super::formulas::Reason;
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
        let state = &self.states[env.program.formulas[formula as usize].node as usize];
        let mut robot = Robot {
            readings: &mut self.readings,
            brick: env.brick,
            now: self.now,
            missing: None,
        };
        let value = self
            .formulas
            .evaluate(env.program, formula, state, &mut robot);
        let missing = robot.missing;
        self.checked(formula, value, missing, env)
    }

    /// The truth of an expression.
    pub(super) fn truth(&mut self, formula: Formula, env: &mut Env<'_>) -> Result<bool, Halt> {
        let state = &self.states[env.program.formulas[formula as usize].node as usize];
        let mut robot = Robot {
            readings: &mut self.readings,
            brick: env.brick,
            now: self.now,
            missing: None,
        };
        let truth = self.formulas.truth(env.program, formula, state, &mut robot);
        let missing = robot.missing;
        self.checked(formula, truth, missing, env)
    }

    /// What an expression gave, or where and why it failed.
    fn checked<T>(
        &self,
        formula: Formula,
        value: Result<T, Reason>,
        missing: Option<u16>,
        env: &Env<'_>,
    ) -> Result<T, Halt> {
        let (words, at) = match (missing, value) {
            (Some(sensor), _) => (words::sensor_missing(sensors::name(sensor)), None),
            (None, Ok(value)) => return Ok(value),
            (None, Err(Reason::Unbound(name))) => (words::unbound(name), None),
            (None, Err(Reason::Unit(name))) => (words::unit_read(name), None),
            (None, Err(Reason::Problems(problems))) => {
                let first = problems.into_iter().next();
                let first = first.unwrap_or_else(|| Problem::error(Words::new("", "")));
                (first.words, first.place.position)
            }
        };
        let text = &env.program.formulas[formula as usize];
        let place = env.program.property_place(text.node, text.property, at);
        Err(self.fault_at(place, words))
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
            Ok(Some(value)) => self.at_port(to, values::text(&value), env),
            Ok(None) => Err(self.fault_at_port(to, words::assigning_text(), env)),
            Err(problems) => {
                let first = problems.into_iter().next();
                let words = first.map_or_else(words::unit, |problem| problem.words);
                Err(self.fault_at_port(to, words, env))
            }
        }
    }
}
