//! What a bridge asks of a robot that takes programs: to run one, to end it, and the variables of a diagram.
//!
//! Owns the words. Each question has a connection of its own, so a robot that is gone and back needs nothing.

use super::fleet::ask;
use super::live::assign;
use super::target::Target;
use super::watch::look;
use crate::error::Error;
use bridge::foxglove::robot::{self, Refused};
use serde_json::Value;

/// The programs of one robot.
#[derive(Debug)]
pub(crate) struct Programs(pub Target);

fn refused(why: Error) -> Refused {
    Refused::Program(why.to_string())
}

impl Programs {
    fn order(&self, request: &[u8]) -> Result<(), Refused> {
        let answer = ask(&self.0, Some(request)).map_err(refused)?;
        match answer.errors.into_iter().next() {
            Some(why) => Err(Refused::Program(why)),
            None => Ok(()),
        }
    }
}

/// The value of a variable as a debugger tells it.
fn value_of(variable: &Value) -> Option<(String, Value)> {
    let text = |key: &str| variable.get(key).and_then(Value::as_str);
    let (name, kind, value) = (text("name")?, text("type")?, text("value")?);
    let value = match kind {
        "bool" => value.parse().map(Value::Bool).ok(),
        "int" => value.parse::<i64>().map(Value::from).ok(),
        "float" => value.parse::<f64>().map(Value::from).ok(),
        "nothing" => Some(Value::Null),
        _ => None,
    };
    let value = value.unwrap_or_else(|| text("value").unwrap_or_default().into());
    Some((name.to_owned(), value))
}

/// A value as an expression of diagrams; None if there is none for it.
fn expression(value: &Value) -> Option<String> {
    match value {
        Value::Bool(truth) => Some(truth.to_string()),
        Value::Number(number) => Some(number.to_string()),
        Value::String(text) if text.contains(['"', '\n', '\\']) => None,
        Value::String(text) => Some(format!("\"{text}\"")),
        Value::Null | Value::Array(_) | Value::Object(_) => None,
    }
}

impl robot::Programs for Programs {
    fn variables(&self) -> Vec<(String, Value)> {
        let told = self.0.connect().and_then(|mut link| look(&mut link, 1));
        // Without a diagram there are none.
        let told = told.unwrap_or_default();
        let variables = told.pointer("/program/variables").and_then(Value::as_array);
        let all = variables.into_iter().flatten();
        all.filter_map(value_of).collect()
    }

    fn assign(&self, name: &str, value: &Value) -> Result<(), Refused> {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        if name.is_empty() || !name.chars().all(is_name) {
            return Err(Refused::Absent(format!("diagram/{name}")));
        }
        let expression = expression(value).ok_or_else(|| Refused::Value(name.to_owned()))?;
        match assign(&self.0, &format!("{name}={expression}")).map_err(refused)? {
            (true, _) => Ok(()),
            (false, why) => Err(Refused::Program(why)),
        }
    }

    fn run(&self, file: &str) -> Result<(), Refused> {
        self.order(format!("run:{file}").as_bytes())
    }

    fn stop(&self) -> Result<(), Refused> {
        self.order(b"stop")
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::json;

    #[test]
    fn variables_are_values_and_back() {
        for (kind, text, value) in [
            ("int", "5", json!(5)),
            ("float", "0.5", json!(0.5)),
            ("bool", "true", json!(true)),
            ("text", "5", json!("5")),
            ("list", "{1, 2}", json!("{1, 2}")),
            ("nothing", "", json!(null)),
        ] {
            let told = json!({"name": "n", "type": kind, "value": text});
            assert_eq!(value_of(&told), Some(("n".to_owned(), value)));
        }
        assert_eq!(expression(&json!(-2.5)).as_deref(), Some("-2.5"));
        assert_eq!(expression(&json!("a b")).as_deref(), Some("\"a b\""));
        for value in [json!("a\"; stop(); \""), json!(null), json!([1])] {
            assert_eq!(expression(&value), None, "{value}");
        }
    }
}
