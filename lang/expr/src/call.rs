//! Calls of functions: what each one computes, and what it asks of the robot.
//!
//! Owns the meaning of every [`Function`]; the operators are in `run`.

use super::code::Span;
use super::reserved::{Function, SENSORS};
use super::run::Run;
use super::tree::Id;
use super::value::Value;
use super::words::Reason;

impl Run<'_> {
    fn argument(&self, span: Span, position: usize) -> Id {
        self.code
            .operands(span)
            .get(position)
            .copied()
            .unwrap_or_default()
    }

    pub(super) fn call(&mut self, id: Id, function: Function, span: Span) -> Value {
        match function {
            Function::Print => {
                let value = self.value(self.argument(span, 0));
                let text = match &value {
                    // TRIK Studio prints nothing of it.
                    Value::List(_) if self.names.is_strict => value.brief().into(),
                    Value::Nil
                    | Value::Bool(_)
                    | Value::Int(_)
                    | Value::Float(_)
                    | Value::Text(_)
                    | Value::Unset
                    | Value::List(_) => self.text(&value),
                };
                self.outside.print(&text);
                value
            }
            Function::Time => Value::Int(self.outside.time()),
            Function::Sensor => self.sensor(id, self.argument(span, 0)),
            Function::Sgn => {
                let number = self.number(self.argument(span, 0));
                Value::Int(i32::from(number > 0.0) - i32::from(number < 0.0))
            }
            Function::Ceil => Value::Int(self.number(self.argument(span, 0)).ceil() as i32),
            Function::Floor => Value::Int(self.number(self.argument(span, 0)).floor() as i32),
            Function::Sin
            | Function::Cos
            | Function::Ln
            | Function::Exp
            | Function::Asin
            | Function::Acos
            | Function::Atan
            | Function::Sqrt
            | Function::Abs
            | Function::Random
            | Function::Min
            | Function::Max
            | Function::Atan2 => Value::Float(self.call_number(id, function, span)),
        }
    }

    pub(super) fn call_number(&mut self, id: Id, function: Function, span: Span) -> f64 {
        match function {
            Function::Print | Function::Time | Function::Sensor => {
                self.call(id, function, span).to_float()
            }
            Function::Sgn | Function::Ceil | Function::Floor => {
                self.call(id, function, span).to_float()
            }
            Function::Random => self.random(id, self.argument(span, 0)),
            Function::Min => self.of_two(span, |one, two| if one < two { one } else { two }),
            Function::Max => self.of_two(span, |one, two| if one < two { two } else { one }),
            Function::Atan2 => self.of_two(span, libm::atan2),
            Function::Sin => self.of_one(span, libm::sin),
            Function::Cos => self.of_one(span, libm::cos),
            Function::Ln => self.of_one(span, libm::log),
            Function::Exp => self.of_one(span, libm::exp),
            Function::Asin => self.of_one(span, libm::asin),
            Function::Acos => self.of_one(span, libm::acos),
            Function::Atan => self.of_one(span, libm::atan),
            Function::Sqrt => self.of_one(span, f64::sqrt),
            Function::Abs => self.of_one(span, f64::abs),
        }
    }

    fn of_one(&mut self, span: Span, function: impl Fn(f64) -> f64) -> f64 {
        function(self.number(self.argument(span, 0)))
    }

    fn of_two(&mut self, span: Span, function: impl Fn(f64, f64) -> f64) -> f64 {
        let one = self.number(self.argument(span, 0));
        function(one, self.number(self.argument(span, 1)))
    }

    fn random(&mut self, id: Id, argument: Id) -> f64 {
        match self.whole(argument).checked_abs().unwrap_or(i32::MAX) {
            0 => {
                self.fault(Reason::RandomOfNothing, id);
                0.0
            }
            below => f64::from(self.outside.random(below)),
        }
    }

    /// `sensor(port)`: the variable whose name is `sensor` and the port.
    fn sensor(&mut self, id: Id, argument: Id) -> Value {
        let port = self.value(argument).to_text();
        if port.is_empty() {
            return Value::Int(0);
        }
        let known = (0..)
            .zip(&SENSORS)
            .find(|(_, sensor)| sensor.name.strip_prefix("sensor") == Some(&*port));
        if let Some((index, _)) = known {
            return Value::Int(self.outside.sensor(index).to_int());
        }
        let name = format!("sensor{port}");
        match self.names.find(&name).and_then(|slot| self.store.get(slot)) {
            Some(value) => Value::Int(value.to_int()),
            None => {
                self.fault(Reason::Uninitialized(name), id);
                Value::Int(0)
            }
        }
    }
}
