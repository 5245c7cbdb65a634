//! What Home Assistant reads to show a robot by itself: a sensor for each number, and a button that stops the robot.
//!
//! Owns those messages; their form is Home Assistant's *MQTT discovery*. They are retained below a prefix of its own.

use super::Message;
use super::topics::Topics;
use super::values::Values;
use crate::limits::DISCOVERED_MAX;
use serde_json::{Value, json};

/// Letters, digits, `_` and `-` are all that an id may have; others are told apart by their number.
fn id(parts: &[&str]) -> String {
    let mut id = String::from("trik");
    for part in parts {
        id.push('_');
        for byte in part.bytes() {
            match byte {
                b'a'..=b'z' | b'A'..=b'Z' | b'0'..=b'9' => id.push(byte.into()),
                other => id.push_str(&format!("-{other:02x}")),
            }
        }
    }
    id
}

/// All of them.
pub fn messages(prefix: &str, topics: &Topics, class: &str, values: &Values) -> Vec<Message> {
    let robot = id(&[class, topics.robot()]);
    let device = json!({
        "identifiers": [robot],
        "name": topics.robot(),
        "manufacturer": "TRIK",
        "model": "robot with trikfs",
    });
    let message = |kind: &str, id: &str, mut what: Value| {
        what["unique_id"] = id.into();
        what["availability_topic"] = topics.life().into();
        what["device"] = device.clone();
        let topic = format!("{prefix}/{kind}/{id}/config");
        Message::retained(topic, what.to_string())
    };
    let mut all = vec![message(
        "button",
        &id(&[class, topics.robot(), "stop"]),
        json!({ "name": "stop", "command_topic": topics.command("stop") }),
    )];
    for (node, units, fields, topic) in values.numbers() {
        for field in fields {
            if all.len() >= DISCOVERED_MAX {
                return all;
            }
            let id = id(&[class, topics.robot(), node, &field]);
            let mut what = json!({
                "name": format!("{node} {field}"),
                "state_topic": topic,
                "value_template": format!("{{{{ value_json.get('values', {{}}).get('{field}') }}}}"),
            });
            if !units.is_empty() {
                what["unit_of_measurement"] = units.into();
            }
            all.push(message("sensor", &id, what));
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use journal::node::Node;
    use recorder::entry::{Entry, Known};
    use std::collections::BTreeSet;
    use std::sync::Arc;
    use std::time::Duration;

    #[test]
    fn each_number_has_a_sensor_of_its_own_and_a_robot_a_button() {
        let topics = Topics::new("7b", "anna").unwrap();
        let mut values = Values::new(&topics, Duration::ZERO);
        for (path, format) in [("a/b_c", "u8 v"), ("a_b/c", "u8 v"), ("t", "text 4")] {
            let mut node = Node::sensor(path, format);
            node.units = "cm".to_owned();
            values.take(&[Entry::Node(Arc::new(Known { number: 1, node }))]);
        }
        let all = messages("homeassistant", &topics, "7b", &values);
        let topics: BTreeSet<&str> = all.iter().map(|message| &*message.topic).collect();
        let expected = [
            "homeassistant/button/trik_7b_anna_stop/config",
            "homeassistant/sensor/trik_7b_anna_a-2fb-5fc_v/config",
            "homeassistant/sensor/trik_7b_anna_a-5fb-2fc_v/config",
        ];
        assert_eq!(topics, BTreeSet::from(expected));
        let said: Value = serde_json::from_slice(&all[1].payload).unwrap();
        assert_eq!(said["state_topic"], "trik/7b/anna/tel/a/b_c");
        assert_eq!(said["unit_of_measurement"], "cm");
        assert_eq!(said["availability_topic"], "trik/7b/anna/life");
        assert_eq!(
            said["value_template"],
            "{{ value_json.get('values', {}).get('v') }}"
        );
    }
}
