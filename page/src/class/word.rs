//! What a viewer of a class and this server say to each other: JSON objects, and files behind one.
//!
//! Owns their forms; `page/app/src/class/news.ts` has the other end. Pure.

use super::board::{Battery, Card, Commander, Reach, Sending, Stage, Stop};
use super::member::OwnPage;
use super::shared::Class;
use super::words::Refused;
use crate::limits;
use axum::body::Bytes;
use lang_text::problem::Locale;
use serde_json::{Value, json};
use std::net::SocketAddr;

/// What a viewer wants.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Order {
    /// Everything of these robots to rest.
    Stop(Vec<usize>),
    /// A program that these robots have shall run.
    Run(Vec<usize>, String),
}

/// A file for robots.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Send {
    /// To these.
    pub robots: Vec<usize>,
    /// Its name.
    pub name: String,
    /// It shall run.
    pub runs: bool,
    /// What is in it.
    pub content: Bytes,
}

impl Order {
    /// Reads one, for so many robots.
    ///
    /// # Errors
    /// It is none.
    pub fn parse(text: &str, count: usize) -> Result<Self, Refused> {
        if text.len() > limits::WORDS_BYTES_MAX {
            return Err(Refused::Words);
        }
        let value: Value = serde_json::from_str(text).map_err(|_| Refused::Words)?;
        let robots = robots(&value, count)?;
        match value.get("do").and_then(Value::as_str) {
            Some("stop") => Ok(Self::Stop(robots)),
            Some("run") => Ok(Self::Run(robots, name(&value)?)),
            Some(_) | None => Err(Refused::Words),
        }
    }
}

impl Send {
    /// Reads one, for so many robots: an object in one line, and behind that the file.
    ///
    /// # Errors
    /// It is none, or the file cannot be a program.
    pub fn parse(message: &Bytes, count: usize) -> Result<Self, Refused> {
        let head = message.iter().take(limits::WORDS_BYTES_MAX);
        let end = head.clone().position(|&byte| byte == b'\n');
        let end = end.ok_or(Refused::Words)?;
        let value: Value = serde_json::from_slice(&message[..end]).map_err(|_| Refused::Words)?;
        let content = message.slice(end + 1..);
        if content.is_empty() {
            return Err(Refused::Empty);
        }
        Ok(Self {
            robots: robots(&value, count)?,
            name: name(&value)?,
            runs: value
                .get("run")
                .and_then(Value::as_bool)
                .ok_or(Refused::Words)?,
            content,
        })
    }
}

/// The robots that are meant, each once.
fn robots(value: &Value, count: usize) -> Result<Vec<usize>, Refused> {
    let listed = value
        .get("robots")
        .and_then(Value::as_array)
        .ok_or(Refused::Words)?;
    let mut robots = Vec::new();
    for id in listed.iter().take(count.max(1) * 2) {
        let id = id.as_u64().and_then(|id| usize::try_from(id).ok());
        let id = id.filter(|id| *id < count).ok_or(Refused::Words)?;
        if !robots.contains(&id) {
            robots.push(id);
        }
    }
    match robots.is_empty() {
        true => Err(Refused::Nobody),
        false => Ok(robots),
    }
}

/// The name of a program, as robots take it.
fn name(value: &Value) -> Result<String, Refused> {
    let name = value
        .get("name")
        .and_then(Value::as_str)
        .ok_or(Refused::Words)?;
    let fits = |c: char| !c.is_control() && !":/\\".contains(c);
    let is_good = !name.trim().is_empty()
        && name.len() <= limits::CLASS_NAME_BYTES_MAX
        && !name.starts_with('.')
        && name.chars().all(fits);
    match is_good {
        true => Ok(name.to_owned()),
        false => Err(Refused::Name),
    }
}

/// What a viewer is told first.
pub fn hello(class: &Class, may_drive: bool) -> String {
    let robots: Vec<_> = class
        .board
        .titles
        .iter()
        .map(|one| json!({ "name": one.name, "group": one.group, "at": one.at }))
        .collect();
    json!({
        "is": "hello",
        "name": class.name,
        "version": env!("CARGO_PKG_VERSION"),
        "drives": may_drive,
        "marks": class.has_marks,
        "robots": robots,
    })
    .to_string()
}

/// The server is there: a page cannot see pings.
pub fn beat() -> String {
    json!({ "is": "beat" }).to_string()
}

/// An order was not carried out.
pub fn refused(why: Refused, locale: Locale) -> String {
    json!({ "is": "refused", "why": why.words().in_locale(locale) }).to_string()
}

/// The card of a robot.
pub fn card(id: usize, card: &Card, locale: Locale) -> String {
    let (reach, why) = match &card.reach {
        Reach::Unknown => ("unknown", None),
        Reach::There(_) => ("there", None),
        Reach::Absent(why) => ("absent", Some(why.words().in_locale(locale).to_owned())),
    };
    json!({
        "is": "robot",
        "id": id,
        "reach": reach,
        "why": why,
        "page": page(card),
        "runs": card.runs,
        "last": card.last,
        "error": card.error,
        "battery": card.battery.as_ref().map(battery),
        "commander": card.commander.as_ref().map(commander),
        "debugger": card.debugger,
        "stop": card.stop.as_ref().map(stop),
        "sending": card.sending.as_ref().map(|one| sending(one, locale)),
    })
    .to_string()
}

/// Where the page of the robot itself is, while it is there.
fn page(card: &Card) -> Option<String> {
    let Reach::There(at) = card.reach else {
        return None;
    };
    let address = match card.page? {
        OwnPage::At(address) => address,
        OwnPage::Port(port) => SocketAddr::new(at.ip(), port),
    };
    Some(format!("http://{address}/"))
}

/// With its age now: clocks of viewers are other ones.
fn battery(battery: &Battery) -> Value {
    let age = battery.at.elapsed().as_millis();
    json!({ "text": battery.text, "ageMs": u64::try_from(age).unwrap_or(u64::MAX) })
}

/// An address; empty: this program.
fn commander(who: &Commander) -> &str {
    match who {
        Commander::Own => "",
        Commander::Other(address) => address,
    }
}

fn stop(stop: &Stop) -> Value {
    match stop {
        Stop::Asked(_) => json!({ "is": "asked" }),
        Stop::Rests(ms) => json!({ "is": "rests", "ms": ms }),
        Stop::Failed(why) => json!({ "is": "failed", "why": why }),
        Stop::Missed => json!({ "is": "missed" }),
    }
}

fn sending(one: &Sending, locale: Locale) -> Value {
    let (is, done, why) = match &one.stage {
        Stage::Sending(done) => ("sending", *done, None),
        Stage::Sent => ("sent", one.bytes, None),
        Stage::Starts => ("starts", one.bytes, None),
        Stage::Runs => ("runs", one.bytes, None),
        Stage::Failed(why) => ("failed", 0, Some(why.words().in_locale(locale).to_owned())),
    };
    json!({ "name": one.name, "is": is, "done": done, "bytes": one.bytes, "why": why })
}

#[cfg(test)]
mod tests {
    use super::super::words::Why;
    use super::*;
    use tokio::time::Instant;

    #[test]
    fn orders_are_read_and_rubbish_is_none() {
        let stop = r#"{"do":"stop","robots":[0,2,0]}"#;
        assert_eq!(Order::parse(stop, 3), Ok(Order::Stop(vec![0, 2])));
        let run = r#"{"do":"run","robots":[1],"name":"a.py"}"#;
        assert_eq!(
            Order::parse(run, 3),
            Ok(Order::Run(vec![1], "a.py".to_owned()))
        );
        for (text, why) in [
            ("", Refused::Words),
            ("[]", Refused::Words),
            (r#"{"do":"stop"}"#, Refused::Words),
            (r#"{"do":"stop","robots":[3]}"#, Refused::Words),
            (r#"{"do":"stop","robots":[-1]}"#, Refused::Words),
            (r#"{"do":"stop","robots":[]}"#, Refused::Nobody),
            (r#"{"do":"fly","robots":[0]}"#, Refused::Words),
            (r#"{"do":"run","robots":[0],"name":"../a"}"#, Refused::Name),
            (r#"{"do":"run","robots":[0],"name":"a:b"}"#, Refused::Name),
            (r#"{"do":"run","robots":[0],"name":".a"}"#, Refused::Name),
            (r#"{"do":"run","robots":[0],"name":" "}"#, Refused::Name),
        ] {
            assert_eq!(Order::parse(text, 3), Err(why), "{text}");
        }
        let long = format!(
            r#"{{"do":"stop","robots":[0],"x":"{}"}}"#,
            "x".repeat(limits::WORDS_BYTES_MAX)
        );
        assert_eq!(Order::parse(&long, 3), Err(Refused::Words));
    }

    #[test]
    fn a_file_stands_behind_its_line() {
        let message = |text: &str| Bytes::copy_from_slice(text.as_bytes());
        let head = r#"{"robots":[1],"name":"a.py","run":true}"#;
        let send = Send::parse(&message(&format!("{head}\nprint(1)\n\n")), 2).unwrap();
        assert_eq!(&send.content[..], b"print(1)\n\n");
        assert_eq!(
            (send.robots, send.name.as_str(), send.runs),
            (vec![1], "a.py", true)
        );
        for (text, why) in [
            (head.to_owned(), Refused::Words),
            (format!("{head}\n"), Refused::Empty),
            ("\nx".to_owned(), Refused::Words),
            (
                r#"{"robots":[1],"name":"a.py"}"#.to_owned() + "\nx",
                Refused::Words,
            ),
            (
                r#"{"robots":[9],"name":"a.py","run":true}"#.to_owned() + "\nx",
                Refused::Words,
            ),
            (
                r#"{"robots":[1],"name":"a/b","run":true}"#.to_owned() + "\nx",
                Refused::Name,
            ),
        ] {
            assert_eq!(Send::parse(&message(&text), 2), Err(why), "{text}");
        }
    }

    #[test]
    fn a_card_is_json_in_the_language_of_the_viewer() {
        let at: SocketAddr = "192.168.77.1:8888".parse().unwrap();
        let mut one = Card {
            reach: Reach::There(at),
            page: Some(OwnPage::Port(8000)),
            runs: Some("a\"b".to_owned()),
            last: None,
            error: None,
            battery: Some(Battery {
                text: "11.8 V".to_owned(),
                at: Instant::now(),
            }),
            commander: Some(Commander::Own),
            debugger: Some("10.0.0.1".to_owned()),
            stop: Some(Stop::Rests(12)),
            sending: Some(Sending {
                name: "a.py".to_owned(),
                bytes: 7,
                runs: true,
                stage: Stage::Failed(Why::Stopped),
            }),
        };
        let value: Value = serde_json::from_str(&card(3, &one, Locale::English)).unwrap();
        assert_eq!(value["page"], "http://192.168.77.1:8000/");
        assert_eq!((&value["id"], &value["runs"]), (&json!(3), &json!("a\"b")));
        assert_eq!(value["battery"]["text"], "11.8 V");
        assert!(value["battery"]["ageMs"].is_u64(), "{value}");
        assert_eq!(
            (&value["commander"], &value["debugger"]),
            (&json!(""), &json!("10.0.0.1"))
        );
        assert_eq!(value["stop"], json!({ "is": "rests", "ms": 12 }));
        assert_eq!(value["sending"]["is"], "failed");
        one.reach = Reach::Absent(Why::Closed);
        let russian: Value = serde_json::from_str(&card(3, &one, Locale::Russian)).unwrap();
        assert_eq!(russian["why"], Why::Closed.words().russian.as_str());
        assert!(russian["page"].is_null(), "{russian}");
    }
}
