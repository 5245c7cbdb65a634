//! What a person computes and assigns while a program runs, between two instants.
//!
//! Owns what such an expression may not do: it reads no sensor and no random number, so that looking changes nothing.

use super::Machine;
use super::formulas::{Refused, assigns};
use super::{values, words};
use lang_expr::reserved::SensorIndex;
use lang_expr::{Outside, Source, Value, Wanted};
use lang_text::problem::Problem;

/// Nobody whom an expression could ask.
pub(super) struct Nobody {
    now: u32,
    /// Whether something was asked that only the robot knows.
    pub(super) is_asked: bool,
}

impl Nobody {
    /// At a moment of the program.
    pub(super) fn at(now: u32) -> Self {
        Self {
            now,
            is_asked: false,
        }
    }
}

impl Outside for Nobody {
    fn sensor(&mut self, _sensor: SensorIndex) -> Value {
        self.is_asked = true;
        Value::Nil
    }

    fn time(&mut self) -> i32 {
        i32::try_from(self.now).unwrap_or(i32::MAX)
    }

    fn print(&mut self, _text: &str) {
        self.is_asked = true;
    }

    fn random(&mut self, _below: i32) -> i32 {
        self.is_asked = true;
        0
    }
}

/// Words for the kind of a token with a value, in both languages; numbers are of one kind.
fn kind_of(token: &Value) -> Option<[&'static str; 2]> {
    match token {
        Value::Nil => None,
        Value::Bool(_) => Some(words::A_TRUTH),
        Value::Int(_) | Value::Float(_) => Some(words::A_NUMBER),
        Value::Text(_) | Value::Unset => Some(words::A_TEXT),
        Value::List(_) => Some(words::A_LIST),
    }
}

impl Machine {
    /// The value of an expression over the variables of the program, and at a stop over the token that comes next, `data`. It
    /// changes nothing.
    ///
    /// # Errors
    /// What is wrong with it.
    pub fn evaluate_aside(&mut self, text: &str) -> Result<Value, Vec<Problem>> {
        let mut nobody = Nobody::at(self.now);
        if let Some(token) = self.token_in(text) {
            let value = self
                .formulas
                .look((text, Wanted::Any), Some(&token), &mut nobody)?;
            return match value {
                _ if nobody.is_asked => Err(vec![Problem::error(words::asks_the_robot())]),
                Some(value) => Ok(value),
                None => Err(vec![Problem::error(words::no_value_yet())]),
            };
        }
        let value = self.formulas.evaluate_text(text, Wanted::Any, &mut nobody);
        match value {
            Ok(value) if !nobody.is_asked => Ok(value),
            Ok(_) => Err(vec![Problem::error(words::asks_the_robot())]),
            Err(Refused::Problems(problems)) => Err(problems),
            Err(Refused::Assigns) => Err(vec![Problem::error(words::assigns_aside())]),
            Err(Refused::Unknown(name)) => {
                let names: Vec<&str> = self.variables().map(|(name, _)| name).collect();
                Err(vec![Problem::error(words::no_variable(&name, &names))])
            }
        }
    }

    /// The token that comes next, if the program is stopped before one and a text reads it and assigns nothing.
    fn token_in(&self, text: &str) -> Option<Value> {
        let source = Source::new(text, Wanted::Any);
        if assigns(&source) {
            return None;
        }
        source
            .names()
            .find_map(|name| self.next_token(name))
            .cloned()
    }

    /// The token that comes next gets the value of an expression, of the same kind as its own.
    fn assign_token(&mut self, name: &str, token: &Value, text: &str) -> Result<(), Vec<Problem>> {
        let mut value = self.assignable(name, text)?;
        if let (Value::Int(_), &Value::Float(number)) = (token, &value) {
            // Blocks that read it were prepared for a whole number.
            let is_whole = number.fract() == 0.0 && f64::from(number as i32) == number;
            if !is_whole {
                return Err(vec![Problem::error(words::token_stays_whole())]);
            }
            value = Value::Int(number as i32);
        }
        let why = match (kind_of(token), kind_of(&value)) {
            (None, _) => words::unit_stays(),
            (Some(was), Some(is)) if was == is && values::fits(&value) => {
                self.change_next(&value);
                return Ok(());
            }
            (Some(was), Some(is)) if was == is => words::too_large_token(),
            (Some(was), _) => words::token_keeps_kind(was),
        };
        Err(vec![Problem::error(why)])
    }

    /// The value of an expression that a person assigns.
    fn assignable(&mut self, name: &str, text: &str) -> Result<Value, Vec<Problem>> {
        let value = self.evaluate_aside(text)?;
        match values::is_finite(&value) {
            true => Ok(value),
            false => Err(vec![Problem::error(words::not_finite(name))]),
        }
    }

    /// Gives a variable of the program, or at a stop the token that comes next, `data`, the value of an expression.
    ///
    /// # Errors
    /// The program has no such variable, what is wrong with the expression, or with a text of the program that could not
    /// be computed any more; the token is of another kind; nothing has changed then.
    pub fn assign_aside(&mut self, name: &str, text: &str) -> Result<(), Vec<Problem>> {
        if let Some(token) = self.next_token(name).cloned() {
            return self.assign_token(name, &token, text);
        }
        let names: Vec<&str> = self.variables().map(|(name, _)| name).collect();
        if !names.contains(&name) {
            return Err(vec![Problem::error(words::no_variable(name, &names))]);
        }
        let value = self.assignable(name, text)?;
        let mut formulas = self.formulas.clone();
        let assigned = formulas.assign(name, value);
        assigned.map_err(|words| vec![Problem::error(words)])?;
        // A number with a fraction may be one too many for a text that needs a whole one.
        formulas.check_all(&self.program, &self.states)?;
        self.formulas = formulas;
        self.look_again();
        Ok(())
    }
}
