//! The newest of each node, on its way to the broker.
//!
//! Owns the form of a message, and when a node has one: at most so many in a second, the newest of all, and none that only
//! repeats what was said, but for a sign of life now and then. Pictures and other long tuples are not sent. Knows no network.

use super::Message;
use super::topics::Topics;
use crate::limits::{FIELDS_MAX, REPEAT_TIME, TEXT_BYTES_MAX};
use journal::layout::{Layout, Number};
use nix::errno::Errno;
use recorder::entry::{Entry, Known};
use recorder::errno::LEFT;
use serde_json::{Map, Value};
use std::collections::BTreeMap;
use std::time::{Duration, Instant};

/// What is known of one node.
#[derive(Debug)]
struct NodeState {
    topic: String,
    units: String,
    layout: Option<Layout>,
    /// What is to be said; None: nothing is known yet.
    now: Option<Newest>,
    /// What was said last, and when.
    said: Option<(Map<String, Value>, Instant)>,
}

/// The newest of a node.
#[derive(Debug)]
struct Newest {
    at_ns: u64,
    body: Map<String, Value>,
}

/// The newest of all nodes.
#[derive(Debug)]
pub struct Values {
    topics: Topics,
    /// Between two messages of one node.
    pause: Duration,
    nodes: BTreeMap<String, NodeState>,
    /// Topics whose node is gone.
    gone: Vec<String>,
    /// Nodes have come, or have another layout.
    is_other: bool,
}

impl Values {
    /// None so far; of one node there is a message after such a pause at the soonest.
    pub fn new(topics: &Topics, pause: Duration) -> Self {
        Self {
            topics: topics.clone(),
            pause,
            nodes: BTreeMap::new(),
            gone: Vec::new(),
            is_other: false,
        }
    }

    /// Whether there are other numbers than at the last question.
    pub fn is_other(&mut self) -> bool {
        std::mem::take(&mut self.is_other)
    }

    /// Takes what has come of the tree.
    pub fn take(&mut self, entries: &[Entry]) {
        for entry in entries {
            match entry {
                Entry::Node(known) => drop(self.know(known)),
                Entry::Sample(known, at_ns, tuple) => {
                    if let Some(seen) = self.know(known)
                        && let Some(body) = seen.body(tuple)
                    {
                        seen.now = Some(Newest {
                            at_ns: *at_ns,
                            body,
                        });
                    }
                }
                // It was taken out of the configuration.
                Entry::Fault(known, _, LEFT, _) => {
                    if let Some(gone) = self.nodes.remove(&known.node.path) {
                        self.gone.push(gone.topic);
                    }
                }
                Entry::Fault(known, at_ns, errno, why) => {
                    if let Some(seen) = self.know(known) {
                        let body = failed(*errno, why);
                        seen.now = Some(Newest {
                            at_ns: *at_ns,
                            body,
                        });
                    }
                }
                Entry::Line(..) | Entry::Attachment(..) | Entry::Facts(..) => {}
            }
        }
    }

    /// Takes what another tree begins with: what the last one had and this one has not is gone.
    pub fn replace(&mut self, entries: &[Entry]) {
        let before = std::mem::take(&mut self.nodes);
        self.take(entries);
        self.is_other = true;
        let left = before
            .into_iter()
            .filter(|(path, _)| !self.nodes.contains_key(path));
        self.gone.extend(left.map(|(_, seen)| seen.topic));
    }

    /// A node whose format changes is another one. None: its path cannot be a topic.
    fn know(&mut self, known: &Known) -> Option<&mut NodeState> {
        let node = &known.node;
        if node.is_raw {
            return None;
        }
        if !self.nodes.contains_key(&node.path) {
            let seen = NodeState {
                topic: self.topics.value(&node.path)?,
                units: String::new(),
                layout: None,
                now: None,
                said: None,
            };
            self.nodes.insert(node.path.clone(), seen);
        }
        let seen = self.nodes.get_mut(&node.path)?;
        let layout = Layout::parse(&node.format).ok();
        let layout = layout.filter(|layout| match layout {
            Layout::Text(size) => *size <= TEXT_BYTES_MAX,
            Layout::Fields(_) | Layout::Bytes(_) => layout.names().len() <= FIELDS_MAX,
        });
        if seen.layout != layout {
            seen.layout = layout;
            seen.now = None;
            self.is_other = true;
        }
        seen.units.clone_from(&node.units);
        Some(seen)
    }

    /// All is said anew: the connection is another one, and a broker may have forgotten.
    pub fn begin_anew(&mut self) {
        for seen in self.nodes.values_mut() {
            seen.said = None;
        }
    }

    /// Hands over what is due, until `send` says that there is no room; the rest is due the next time.
    pub fn due(&mut self, now: Instant, mut send: impl FnMut(Message) -> bool) {
        while let Some(topic) = self.gone.last() {
            if !send(Message::retained(topic.clone(), "")) {
                return;
            }
            self.gone.pop();
        }
        for seen in self.nodes.values_mut() {
            let Some(newest) = &seen.now else { continue };
            let is_due = seen.said.as_ref().is_none_or(|(body, at)| {
                let passed = now.saturating_duration_since(*at);
                passed >= REPEAT_TIME || (passed >= self.pause && *body != newest.body)
            });
            if !is_due {
                continue;
            }
            if !send(Message::retained(seen.topic.clone(), newest.text())) {
                return;
            }
            seen.said = Some((newest.body.clone(), now));
        }
    }

    /// Names, units and the topic of each node's numbers.
    pub fn numbers(&self) -> impl Iterator<Item = (&str, &str, Vec<String>, &str)> {
        self.nodes.iter().filter_map(|(path, seen)| {
            let names = match seen.layout.as_ref()? {
                layout @ (Layout::Fields(_) | Layout::Bytes(_)) => layout.names(),
                Layout::Text(_) => return None,
            };
            Some((
                path.as_str(),
                seen.units.as_str(),
                names,
                seen.topic.as_str(),
            ))
        })
    }
}

impl NodeState {
    /// What a tuple says; None if it is too long, or no tuple of this node.
    fn body(&self, tuple: &[u8]) -> Option<Map<String, Value>> {
        let layout = self.layout.as_ref()?;
        let mut body = Map::new();
        match layout {
            Layout::Text(_) => drop(body.insert("text".to_owned(), layout.show(tuple).into())),
            Layout::Fields(_) | Layout::Bytes(_) => {
                let numbers = layout.numbers(tuple).into_iter().map(number);
                let values: Map<String, Value> = layout.names().into_iter().zip(numbers).collect();
                if values.is_empty() {
                    return None;
                }
                body.insert("values".to_owned(), values.into());
            }
        }
        if !self.units.is_empty() {
            body.insert("unit".to_owned(), self.units.clone().into());
        }
        Some(body)
    }
}

impl Newest {
    fn text(&self) -> String {
        let mut all = self.body.clone();
        all.insert("time".to_owned(), seconds(self.at_ns).into());
        Value::Object(all).to_string()
    }
}

/// What is said of a node that fails: it has no values.
fn failed(errno: i32, why: &str) -> Map<String, Value> {
    let name = format!("{:?}", Errno::from_raw(errno));
    let said = [
        ("errno", errno.into()),
        ("error", name.into()),
        ("why", why.into()),
    ];
    said.map(|(key, value): (&str, Value)| (key.to_owned(), value))
        .into_iter()
        .collect()
}

/// A number as JSON has it; null for one that is not finite.
fn number(number: Number) -> Value {
    match number {
        Number::Signed(number) => number.into(),
        Number::Unsigned(number) => number.into(),
        // Its own digits, and not those of the nearest number of 64 bits.
        Number::Single(number) => number
            .to_string()
            .parse::<f64>()
            .map_or(Value::Null, Value::from),
        Number::Double(number) => number.into(),
    }
}

/// Seconds since 1970, to the millisecond.
#[allow(clippy::cast_precision_loss, reason = "milliseconds fit for millennia")]
fn seconds(at_ns: u64) -> f64 {
    (at_ns / 1_000_000) as f64 / 1e3
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::node::Node;
    use serde_json::json;
    use std::sync::Arc;

    const PAUSE: Duration = Duration::from_millis(200);

    fn known(path: &str, format: &str) -> Arc<Known> {
        let mut node = Node::sensor(path, format);
        node.units = "cm".to_owned();
        Arc::new(Known { number: 1, node })
    }

    fn values() -> Values {
        Values::new(&Topics::new("7b", "anna").unwrap(), PAUSE)
    }

    fn due(values: &mut Values, at: Instant) -> Vec<(String, Value)> {
        let mut all = Vec::new();
        values.due(at, |message| {
            assert!(message.is_retained);
            let value = serde_json::from_slice(&message.payload).unwrap_or(Value::Null);
            all.push((message.topic, value));
            true
        });
        all
    }

    #[test]
    fn the_newest_is_said_at_the_rate_that_is_wanted_and_never_twice() {
        let (mut values, begin) = (values(), Instant::now());
        let node = known("sensors/D1", "u16 distance");
        let sample = |number: u8, ms: u64| {
            Entry::Sample(node.clone(), ms * 1_000_000, vec![number, 0].into())
        };
        values.take(&[sample(80, 1500)]);
        let said = json!({ "time": 1.5, "unit": "cm", "values": { "distance": 80 } });
        let topic = "trik/7b/anna/tel/sensors/D1".to_owned();
        assert_eq!(due(&mut values, begin), [(topic.clone(), said)]);
        // Two that come soon: the newest of them, when the pause is over.
        values.take(&[sample(81, 1600), sample(82, 1650)]);
        assert_eq!(due(&mut values, begin + PAUSE / 2), []);
        let said = json!({ "time": 1.65, "unit": "cm", "values": { "distance": 82 } });
        assert_eq!(due(&mut values, begin + PAUSE), [(topic.clone(), said)]);
        // The same value is not said, until a sign of life is due.
        values.take(&[sample(82, 1700)]);
        assert_eq!(due(&mut values, begin + PAUSE * 3), []);
        assert_eq!(due(&mut values, begin + PAUSE + REPEAT_TIME).len(), 1);
        values.begin_anew();
        assert_eq!(due(&mut values, begin + PAUSE + REPEAT_TIME).len(), 1);
    }

    #[test]
    fn a_failure_has_no_values_and_a_node_that_is_gone_takes_its_message_back() {
        let (mut values, begin) = (values(), Instant::now());
        let node = known("sensors/D1", "u16 distance");
        values.take(&[
            Entry::Sample(node.clone(), 1, vec![80, 0].into()),
            Entry::Fault(node.clone(), 2_000_000_000, 19, "unplugged".into()),
        ]);
        let said = json!({ "time": 2.0, "errno": 19, "error": "ENODEV", "why": "unplugged" });
        assert_eq!(due(&mut values, begin)[0].1, said);
        values.take(&[Entry::Fault(node, 3, LEFT, "".into())]);
        let topic = "trik/7b/anna/tel/sensors/D1".to_owned();
        assert_eq!(due(&mut values, begin), [(topic, Value::Null)]);
        assert_eq!(due(&mut values, begin), []);
    }

    #[test]
    fn another_tree_takes_back_what_only_the_last_one_had() {
        let (mut values, begin) = (values(), Instant::now());
        for path in ["a", "b"] {
            values.take(&[Entry::Sample(known(path, "u8 v"), 1, vec![7].into())]);
        }
        assert_eq!(due(&mut values, begin).len(), 2);
        values.replace(&[Entry::Node(known("b", "u8 v"))]);
        let gone = [("trik/7b/anna/tel/a".to_owned(), Value::Null)];
        assert_eq!(due(&mut values, begin + REPEAT_TIME), gone);
    }

    #[test]
    fn what_has_no_room_is_due_the_next_time() {
        let (mut values, begin) = (values(), Instant::now());
        for path in ["a", "b", "c"] {
            values.take(&[Entry::Sample(known(path, "u8 v"), 1, vec![7].into())]);
        }
        let mut room = 1;
        values.due(begin, |_| {
            room -= 1;
            room >= 0
        });
        assert_eq!(due(&mut values, begin).len(), 2);
    }

    #[test]
    fn pictures_and_names_with_wildcards_are_left_out_and_texts_and_floats_are_told() {
        let (mut values, begin) = (values(), Instant::now());
        let size = FIELDS_MAX + 1;
        values.take(&[
            Entry::Sample(
                known("photo", &format!("u8 x {size}")),
                1,
                vec![0; size].into(),
            ),
            Entry::Sample(known("a#", "u8 v"), 1, vec![1].into()),
            Entry::Sample(known("says", "text 8"), 1, b"hello\0\0\0"[..].into()),
            Entry::Sample(
                known("f", "f32 x, f64 y"),
                1,
                [&0.1_f32.to_le_bytes()[..], &f64::NAN.to_le_bytes()]
                    .concat()
                    .into(),
            ),
        ]);
        let all = due(&mut values, begin);
        assert_eq!(all.len(), 2);
        assert_eq!(all[0].1["values"], json!({ "x": 0.1, "y": null }));
        assert_eq!(all[1].1["text"], "hello");
    }
}
