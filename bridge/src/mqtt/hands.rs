//! Carries commands out.
//!
//! Owns the leases of the actuators that are driven from afar. Each has the dead-man's clock of the filesystem: one who says no
//! more for so long, or whose bridge or broker is gone, drives no longer, whatever happens here.

use super::Message;
use super::inbox::{Letter, Next, Order, Untaken};
use super::topics::Topics;
use crate::foxglove::robot::{Refused, Robot};
use crate::limits::LEASES_MAX;
use journal::layout::Layout;
use journal::node::Node;
use recorder::nodes;
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::fmt;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// Why a command is not carried out.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Undone {
    /// The tree has no such node.
    Absent(String),
    /// The node only measures.
    Measures(String),
    /// Not what its `value` takes.
    Value(String, String),
    /// Another program drives it: who.
    Held(String, String),
    /// A stop came, and the one who drove goes on: for how long nothing may come, in ms.
    Stopped(String, u128),
    /// Too many actuators are driven at once.
    Many,
    /// The tree does not take it: why.
    Tree(String, String),
    /// The robot does not do it.
    Robot(Refused),
    /// It is not carried out any more.
    Untaken(Untaken),
}

impl fmt::Display for Undone {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Absent(node) => write!(f, "{node}: the tree has no such node"),
            Self::Measures(node) => write!(f, "{node}: it only measures; nothing can be written"),
            Self::Value(node, what) => write!(f, "{node}: it takes {what}"),
            Self::Held(node, who) => write!(f, "{node}: another program drives it: {who}"),
            Self::Stopped(node, ms) => write!(
                f,
                "{node}: it was stopped; it can be set again when nobody has set it for {ms} ms"
            ),
            Self::Many => write!(f, "more than {LEASES_MAX} actuators are driven at once"),
            Self::Tree(node, why) => write!(f, "{node}: {why}"),
            Self::Robot(why) => write!(f, "{why}"),
            Self::Untaken(why) => write!(f, "{why}"),
        }
    }
}

impl std::error::Error for Undone {}

/// The lease of one actuator.
#[derive(Debug)]
struct Lease {
    owner: File,
    /// When it ends if nothing more is said.
    until: Instant,
}

/// Those who carry out.
pub struct Hands {
    root: PathBuf,
    robot: Robot,
    topics: Topics,
    deadman: Duration,
    /// What was last known of the tree.
    nodes: Vec<Node>,
    leases: BTreeMap<String, Lease>,
    /// Actuators that were driven when a stop came, and until when nobody may go on with that.
    stopped: BTreeMap<String, Instant>,
}

impl Hands {
    /// For the tree at this place; an actuator rests when nothing is said for so long.
    pub fn new(root: PathBuf, robot: Robot, topics: &Topics, deadman: Duration) -> Self {
        Self {
            root,
            robot,
            topics: topics.clone(),
            deadman,
            nodes: Vec::new(),
            leases: BTreeMap::new(),
            stopped: BTreeMap::new(),
        }
    }

    /// Does what is next; what became of it is for all to see.
    pub fn take(&mut self, next: Next) -> Message {
        let (letter, done) = match next {
            Next::Overtaken(letter) => (letter, Err(Undone::Untaken(Untaken::Overtaken))),
            Next::Carry(letter) => {
                let done = self.carry(&letter);
                (letter, done)
            }
        };
        answer(
            &self.topics,
            &letter.order.words(),
            done.as_ref().map_err(|why| why as &dyn fmt::Display),
            letter.ticket,
        )
    }

    fn carry(&mut self, letter: &Letter) -> Result<(), Undone> {
        match &letter.order {
            Order::Stop => self.stop(),
            Order::Run(file) => self.robot.run(file).map_err(Undone::Robot),
            // The client that sent it may have gone since.
            Order::Set(..) | Order::Alive if letter.at.elapsed() >= self.deadman => {
                Err(Undone::Untaken(Untaken::Late))
            }
            Order::Set(node, text) => self.set(node, text),
            Order::Parameter(name, text) => self.parameter(name, text),
            Order::Alive => {
                self.go_on();
                Ok(())
            }
        }
    }

    /// Everything comes to rest, and the program ends. A client that goes on to drive is refused until it has been silent: a stop
    /// would last no longer than the pause between two commands.
    fn stop(&mut self) -> Result<(), Undone> {
        let until = Instant::now() + self.deadman;
        let driven = std::mem::take(&mut self.leases).into_keys();
        self.stopped.extend(driven.map(|node| (node, until)));
        self.robot.stop().map_err(Undone::Robot)
    }

    /// Whether it was stopped while somebody drove it, who goes on.
    fn is_stopped(&mut self, node: &str) -> bool {
        let now = Instant::now();
        self.stopped.retain(|_, until| now < *until);
        match self.stopped.get_mut(node) {
            Some(until) => {
                *until = now + self.deadman;
                true
            }
            None => false,
        }
    }

    /// Gives back the leases of those who have said nothing for so long; the filesystem has brought them to rest itself.
    pub fn let_go(&mut self, now: Instant) {
        self.leases.retain(|_, lease| now < lease.until);
    }

    fn parameter(&self, name: &str, text: &str) -> Result<(), Undone> {
        // A number, a truth or a text in quotes, or else a text as it is.
        let value = serde_json::from_str(text).unwrap_or_else(|_| Value::from(text));
        let refused = self.robot.set(&[(name.to_owned(), value)]).pop();
        refused.map_or(Ok(()), |why| Err(Undone::Robot(why)))
    }

    /// A node that can be written, with its format as it is now. The tree is looked at again for a name that is not known: only
    /// what it has is a path.
    fn node(&mut self, path: &str) -> Result<Node, Undone> {
        let known = |nodes: &[Node]| {
            let is_it =
                |node: &&Node| node.path == path || node.aliases.iter().any(|other| other == path);
            nodes.iter().find(is_it).cloned()
        };
        let format = |node: &Node| fs::read_to_string(self.root.join(&node.path).join("format"));
        let found = known(&self.nodes).and_then(|node| Some((format(&node).ok()?, node)));
        let found = match found {
            Some(found) => Some(found),
            None => {
                self.nodes = nodes::find(&self.root);
                known(&self.nodes).and_then(|node| Some((format(&node).ok()?, node)))
            }
        };
        match found {
            None => Err(Undone::Absent(path.to_owned())),
            Some((_, node)) if !node.is_written => Err(Undone::Measures(path.to_owned())),
            Some((format, node)) => Ok(Node { format, ..node }),
        }
    }

    fn set(&mut self, path: &str, text: &str) -> Result<(), Undone> {
        let node = self.node(path)?;
        let text = value(&node, text)?;
        if self.is_stopped(&node.path) {
            let ms = self.deadman.as_millis();
            return Err(Undone::Stopped(node.path, ms));
        }
        let directory = self.root.join(&node.path);
        let tree = |why: io::Error| Undone::Tree(node.path.clone(), why.to_string());
        // Whatever can drive has this file, also a node that stands for an actuator elsewhere.
        let owner = directory.join("owner");
        match fs::metadata(&owner) {
            Ok(_) => self.hold(&node, &owner)?,
            Err(why) if why.kind() == io::ErrorKind::NotFound => {}
            Err(why) => return Err(tree(why)),
        }
        let file = OpenOptions::new()
            .write(true)
            .truncate(true)
            .open(directory.join("value"));
        let written = file.and_then(|mut file| file.write_all(format!("{text}\n").as_bytes()));
        if let Err(why) = written {
            // One that was taken away is asked for anew with the next value.
            self.leases.remove(&node.path);
            return Err(tree(why));
        }
        if let Some(lease) = self.leases.get_mut(&node.path) {
            lease.until = Instant::now() + self.deadman;
        }
        Ok(())
    }

    /// Has the lease of an actuator.
    fn hold(&mut self, node: &Node, owner: &std::path::Path) -> Result<(), Undone> {
        self.let_go(Instant::now());
        if let Some(lease) = self.leases.get_mut(&node.path) {
            // A sign of life; one that has ended meanwhile is taken anew.
            if lease.owner.write_all(b"\n").is_ok() {
                return Ok(());
            }
            self.leases.remove(&node.path);
        }
        if self.leases.len() >= LEASES_MAX {
            return Err(Undone::Many);
        }
        let taken = OpenOptions::new().write(true).open(owner);
        let mut file = taken.map_err(|why| match why.raw_os_error() {
            Some(errno) if errno == nix::errno::Errno::EBUSY as i32 => {
                let who = fs::read_to_string(owner).unwrap_or_default();
                Undone::Held(node.path.clone(), who.trim().to_owned())
            }
            Some(_) | None => Undone::Tree(node.path.clone(), why.to_string()),
        })?;
        let clock = format!("deadman_ms {}\n", self.deadman.as_millis());
        file.write_all(clock.as_bytes())
            .map_err(|why| Undone::Tree(node.path.clone(), why.to_string()))?;
        let until = Instant::now() + self.deadman;
        let lease = Lease { owner: file, until };
        self.leases.insert(node.path.clone(), lease);
        Ok(())
    }

    /// What drives may go on.
    fn go_on(&mut self) {
        let now = Instant::now();
        self.let_go(now);
        let until = now + self.deadman;
        self.leases.retain(|_, lease| {
            lease.until = until;
            lease.owner.write_all(b"\n").is_ok()
        });
    }
}

/// What `value` of a node gets: numbers as they are, also as JSON; a text if that is what it takes. Nothing else is written, so
/// no wrong number moves a motor; the tree refuses those that are too large.
fn value(node: &Node, text: &str) -> Result<String, Undone> {
    let layout = Layout::parse(&node.format).ok();
    if let Some(Layout::Text(_)) = layout {
        let is_line = !text.contains(char::is_control);
        return match is_line {
            true => Ok(text.to_owned()),
            false => Err(Undone::Value(
                node.path.clone(),
                "one line of text".to_owned(),
            )),
        };
    }
    let count = layout.map_or(1, |layout| layout.names().len());
    let numbers: Option<Vec<String>> = match serde_json::from_str(text) {
        Ok(Value::Array(all)) => all.iter().map(number).collect(),
        Ok(one @ Value::Number(_)) => number(&one).map(|one| vec![one]),
        Ok(Value::Null | Value::Bool(_) | Value::String(_) | Value::Object(_)) | Err(_) => {
            text.split_ascii_whitespace().map(finite).collect()
        }
    };
    match numbers {
        Some(numbers) if numbers.len() == count => Ok(numbers.join(" ")),
        Some(_) | None => {
            let what = match count {
                1 => "a number".to_owned(),
                count => format!("{count} numbers"),
            };
            Err(Undone::Value(node.path.clone(), what))
        }
    }
}

fn number(value: &Value) -> Option<String> {
    value.as_number().map(ToString::to_string)
}

/// A word that is a number.
fn finite(word: &str) -> Option<String> {
    let number: f64 = word.parse().ok()?;
    number.is_finite().then(|| word.to_owned())
}

/// What became of a command, for all to see.
pub fn answer(
    topics: &Topics,
    words: &str,
    done: Result<&(), &dyn fmt::Display>,
    ticket: Option<Vec<u8>>,
) -> Message {
    let said = match done {
        Ok(()) => json!({ "command": words, "ok": true }),
        Err(why) => json!({ "command": words, "ok": false, "why": why.to_string() }),
    };
    Message {
        topic: topics.answer(),
        payload: said.to_string().into_bytes(),
        is_retained: false,
        correlation: ticket,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn node(format: &str) -> Node {
        Node::sensor("motors/M3", format)
    }

    #[test]
    fn only_numbers_reach_an_actuator_that_takes_numbers() {
        let one = node("i8 power");
        for (text, written) in [("40", "40"), (" -7 ", "-7"), ("[40]", "40"), ("1.5", "1.5")] {
            assert_eq!(value(&one, text), Ok(written.to_owned()), "{text}");
        }
        for text in [
            "",
            "NaN",
            "inf",
            "-infinity",
            "1e999",
            "40 40",
            "[]",
            "[1,2]",
            "true",
            "\"40\"",
            "{\"power\":40}",
            "null",
            "forty",
            "40;",
            "[null]",
            "0x10",
        ] {
            assert_eq!(
                value(&one, text),
                Err(Undone::Value("motors/M3".to_owned(), "a number".to_owned())),
                "{text}"
            );
        }
        let two = node("i16 x, i16 y");
        assert_eq!(value(&two, "[1, -2]"), Ok("1 -2".to_owned()));
        assert_eq!(value(&two, "3 4"), Ok("3 4".to_owned()));
        assert!(value(&two, "3").is_err());
        let text = node("text 16");
        assert_eq!(value(&text, "40 is a text"), Ok("40 is a text".to_owned()));
        assert!(value(&text, "two\nlines").is_err());
    }
}
