//! Calls of functions: what each one computes, and what it asks of the robot.
//!
//! Owns the meaning of every [`Function`]; the operators are in `run`.

use super::code::Span;
use super::reserved::{Function, SENSORS};
use super::run::Run;
use super::tree::Id;
use super::value::Value;
use super::words::What;

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
                let text = self.text(&value);
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
            _ => Value::Float(self.call_number(id, function, span)),
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
            Function::Min | Function::Max | Function::Atan2 => {
                let one = self.number(self.argument(span, 0));
                let two = self.number(self.argument(span, 1));
                match function {
                    Function::Min if one < two => one,
                    Function::Min => two,
                    Function::Max if one < two => two,
                    Function::Max => one,
                    _ => one.atan2(two),
                }
            }
            _ => {
                let number = self.number(self.argument(span, 0));
                match function {
                    Function::Sin => number.sin(),
                    Function::Cos => number.cos(),
                    Function::Ln => number.ln(),
                    Function::Exp => number.exp(),
                    Function::Asin => number.asin(),
                    Function::Acos => number.acos(),
                    Function::Atan => number.atan(),
                    Function::Sqrt => number.sqrt(),
                    _ => number.abs(),
                }
            }
        }
    }

    fn random(&mut self, id: Id, argument: Id) -> f64 {
        match self.whole(argument).checked_abs().unwrap_or(i32::MAX) {
            0 => {
                self.fault(What::RandomOfNothing, id);
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
                self.fault(What::Uninitialized(name), id);
                Value::Int(0)
            }
        }
    }
}
