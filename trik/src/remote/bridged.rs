//! What a bridge asks of a robot that takes programs: to run one, to end it, and the variables of a diagram.
//!
//! Owns the words, and the connection by which variables are read. Each order has a connection of its own, so a robot that is
//! gone and back needs nothing.

use super::fleet::ask;
use super::link::{Link, ms};
use super::live::assign;
use super::target::Target;
use super::upload::start;
use super::watch::look;
use crate::error::Error;
use crate::limits;
use bridge::foxglove::robot::{self, Refused};
use lang_text::problem::Locale;
use serde_json::Value;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// The programs of one robot.
#[derive(Debug)]
pub(crate) struct Programs {
    target: Target,
    /// How long an answer may take.
    patience: Duration,
    seen: Mutex<Seen>,
}

/// What was read of variables.
#[derive(Debug, Default)]
struct Seen {
    /// The robot logs each client that comes and goes: one that looks each second stays connected.
    link: Option<Link>,
    /// The number of the last question.
    tag: u64,
    variables: Vec<(String, Value)>,
}

impl Seen {
    /// Reads them; of a robot that does not answer what it told last is known.
    fn read(&mut self, target: &Target) {
        // One that was kept may have ended meanwhile; a new one says whether the robot is there.
        let was_kept = self.link.is_some();
        let told = match self.ask(target) {
            Err(Error::Unreachable(_)) if was_kept => self.ask(target),
            told => told,
        };
        if let Ok(told) = told {
            let variables = told.pointer("/program/variables").and_then(Value::as_array);
            // Without a diagram there are none.
            let all = variables.into_iter().flatten();
            self.variables = all.filter_map(value_of).collect();
        }
    }

    fn ask(&mut self, target: &Target) -> Result<Value, Error> {
        let mut link = match self.link.take() {
            Some(link) => link,
            None => target.connect()?,
        };
        self.tag += 1;
        let told = look(&mut link, self.tag, &mut None)?;
        self.link = Some(link);
        Ok(told)
    }
}

fn refused(why: Error) -> Refused {
    Refused::Program(why.to_string())
}

impl Programs {
    /// Those of this robot.
    pub(crate) fn new(target: Target) -> Self {
        Self {
            target,
            patience: ms(limits::ANSWER_MS),
            seen: Mutex::default(),
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
        // What is no number has no form in JSON: its text is told.
        "float" => value
            .parse::<f64>()
            .ok()
            .filter(|value| value.is_finite())
            .map(Value::from),
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
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        seen.read(&self.target);
        seen.variables.clone()
    }

    fn rest(&self) {
        let mut seen = self.seen.lock().unwrap_or_else(PoisonError::into_inner);
        // What a program prints goes to all who are connected, and nobody would read it.
        seen.link = None;
    }

    fn assign(&self, name: &str, value: &Value) -> Result<(), Refused> {
        let is_name = |c: char| c.is_alphanumeric() || c == '_';
        if name.is_empty() || !name.chars().all(is_name) {
            return Err(Refused::Absent(format!("diagram/{name}")));
        }
        let expression = expression(value).ok_or_else(|| Refused::Value(name.to_owned()))?;
        match assign(
            &self.target,
            &format!("{name}={expression}"),
            Locale::English,
        )
        .map_err(refused)?
        {
            (true, _) => Ok(()),
            (false, why) => Err(Refused::Program(why)),
        }
    }

    fn run(&self, file: &str) -> Result<(), Refused> {
        let mut link = self.target.connect().map_err(refused)?;
        start(&mut link, file, None).map_err(refused)
    }

    fn stop(&self) -> Result<(), Refused> {
        let answer = ask(&self.target, Some(b"stop"), self.patience).map_err(refused)?;
        match answer.of_stop() {
            (true, _) => Ok(()),
            (false, why) => Err(Refused::Program(format!("{}: {why}", self.target))),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use bridge::foxglove::robot::Programs as _;
    use serde_json::json;
    use std::io::{Read, Write};
    use std::net::TcpListener;
    use std::sync::Arc;
    use std::sync::atomic::{AtomicUsize, Ordering};
    use std::thread;

    /// Programs of a robot that answers a request with these frames, one for each connection that comes.
    fn robot(
        answers: impl Fn(&str) -> Vec<String> + Send + 'static,
    ) -> (Programs, Arc<AtomicUsize>) {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut programs = Programs::new(listener.local_addr().unwrap().into());
        programs.patience = Duration::from_millis(200);
        let count = Arc::new(AtomicUsize::new(0));
        let counted = count.clone();
        thread::spawn(move || {
            for client in listener.incoming() {
                counted.fetch_add(1, Ordering::AcqRel);
                let (mut client, mut bytes) = (client.unwrap(), [0; 1024]);
                while let Ok(size @ 1..) = client.read(&mut bytes) {
                    let frames = answers(&String::from_utf8_lossy(&bytes[..size]));
                    // None at all: it ends the connection.
                    if frames.is_empty() {
                        break;
                    }
                    for frame in frames {
                        let _ = client.write_all(format!("{}:{frame}", frame.len()).as_bytes());
                    }
                }
            }
        });
        (programs, count)
    }

    #[test]
    fn a_robot_that_does_not_answer_is_not_said_to_have_stopped() {
        let listener = TcpListener::bind("127.0.0.1:0").unwrap();
        let mut silent = Programs::new(listener.local_addr().unwrap().into());
        silent.patience = Duration::from_millis(50);
        let why = silent.stop().unwrap_err().to_string();
        assert!(why.contains("does not say whether it has"), "{why}");
    }

    #[test]
    fn errors_of_a_program_are_no_refusal_of_a_stop_and_those_of_a_start_are() {
        let frames = |text: &str| [text, "status: no program"].map(str::to_owned).to_vec();
        let (failing, _) = robot(move |_| frames("error: TypeError: x is not defined"));
        assert_eq!(failing.stop(), Ok(()));
        let why = failing.run("x.js").unwrap_err().to_string();
        assert!(why.contains("does not run x.js: TypeError"), "{why}");
        let (moving, _) = robot(move |_| frames("error: not everything is at rest: M1"));
        let why = moving.stop().unwrap_err().to_string();
        assert!(why.contains("not everything is at rest: M1"), "{why}");
        let (good, _) = robot(move |_| frames("info: x.js has started"));
        assert_eq!(good.run("x.js"), Ok(()));
    }

    #[test]
    fn who_looks_again_stays_connected_and_remembers_what_a_robot_told_that_is_gone() {
        let asked = AtomicUsize::new(0);
        let (programs, count) = robot(move |request| {
            let tag = request
                .split_once("debug:")
                .and_then(|(_, rest)| rest.split(' ').next());
            let told = json!({
                "to": tag.and_then(|tag| tag.parse::<u64>().ok()),
                "program": {"variables": [{"name": "n", "type": "int", "value": "5"}]},
            });
            match asked.fetch_add(1, Ordering::AcqRel) {
                0..=2 | 4 => vec![format!("debug: {told}")],
                _ => Vec::new(),
            }
        });
        let five = [("n".to_owned(), json!(5))];
        for _ in 0..3 {
            assert_eq!(programs.variables(), five);
        }
        assert_eq!(count.load(Ordering::Acquire), 1, "one connection");
        // The robot ends it, and takes a new one.
        assert_eq!(programs.variables(), five);
        assert_eq!(count.load(Ordering::Acquire), 2);
        // It answers nothing any more.
        assert_eq!(programs.variables(), five);
        programs.rest();
        assert_eq!(programs.variables(), five);
        assert!(count.load(Ordering::Acquire) > 2);
    }

    #[test]
    fn variables_are_values_and_back() {
        for (kind, text, value) in [
            ("int", "5", json!(5)),
            ("float", "0.5", json!(0.5)),
            ("float", "nan", json!("nan")),
            ("float", "-inf", json!("-inf")),
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
