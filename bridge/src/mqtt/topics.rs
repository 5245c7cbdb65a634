//! The topics of one robot, below `trik`, its class and its name.
//!
//! Owns every name, and which texts can be part of one. `life` says whether the robot is there, `tel/NODE` is the newest of a
//! node, commands come below `cmd/`, and `answer` says what became of them. Other bridges use the same words.

use crate::error::Error;
use crate::limits::TOPIC_PART_BYTES_MAX;

/// What all topics begin with.
const ROOT: &str = "trik";

/// Names below one robot.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Topics {
    class: String,
    robot: String,
}

/// The text can be a level of a topic: wildcards and separators of MQTT and of zenoh have a meaning of their own.
fn is_part(text: &str) -> bool {
    (1..=TOPIC_PART_BYTES_MAX).contains(&text.len())
        && !text.contains(['/', '*', '#', '+', '?', '$'])
        && !text.contains(char::is_control)
}

impl Topics {
    /// Those of the robot with this name in this class.
    ///
    /// # Errors
    /// One of the names cannot be part of a topic.
    pub fn new(class: &str, robot: &str) -> Result<Self, Error> {
        for name in [class, robot] {
            if !is_part(name) {
                return Err(Error::Name(name.to_owned()));
            }
        }
        Ok(Self {
            class: class.to_owned(),
            robot: robot.to_owned(),
        })
    }

    /// What the broker knows the bridge by: a second one of the same name takes the place of the first.
    pub fn client_id(&self) -> String {
        format!("{ROOT}-{}-{}", self.class, self.robot)
    }

    /// The name of the robot.
    pub fn robot(&self) -> &str {
        &self.robot
    }

    fn below(&self, rest: &str) -> String {
        format!("{ROOT}/{}/{}/{rest}", self.class, self.robot)
    }

    /// `online` or `offline`.
    pub fn life(&self) -> String {
        self.below("life")
    }

    /// Which bridge speaks for the robot.
    pub fn bridge(&self) -> String {
        self.below("bridge")
    }

    /// The newest of a node; None if its path cannot be part of a topic.
    pub fn value(&self, node: &str) -> Option<String> {
        let is_named = node.split('/').all(is_part);
        is_named.then(|| self.below(&format!("tel/{node}")))
    }

    /// What to subscribe to for commands.
    pub fn commands(&self) -> String {
        self.below("cmd/#")
    }

    /// The topic of one command.
    pub fn command(&self, words: &str) -> String {
        self.below(&format!("cmd/{words}"))
    }

    /// The words of a command; None if the topic is none of this robot's.
    pub fn command_of<'a>(&self, topic: &'a str) -> Option<&'a str> {
        topic.strip_prefix(&self.below("cmd/"))
    }

    /// What became of commands.
    pub fn answer(&self) -> String {
        self.below("answer")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_names_that_mean_themselves_are_part_of_a_topic() {
        let topics = Topics::new("7b", "anna").unwrap();
        assert_eq!(topics.life(), "trik/7b/anna/life");
        assert_eq!(
            topics.value("sensors/A1").unwrap(),
            "trik/7b/anna/tel/sensors/A1"
        );
        assert_eq!(topics.command_of("trik/7b/anna/cmd/set/a"), Some("set/a"));
        for stranger in ["trik/7b/boris/cmd/stop", "trik/7b/anna/tel/a", ""] {
            assert_eq!(topics.command_of(stranger), None, "{stranger}");
        }
        for bad in ["", "a/b", "#", "a+", "$SYS", "a\u{0}", "*", "?"] {
            assert_eq!(
                Topics::new(bad, "anna"),
                Err(Error::Name(bad.to_owned())),
                "{bad}"
            );
            assert!(Topics::new("7b", bad).is_err(), "{bad}");
        }
        assert_eq!(topics.value("sensors/#"), None);
        assert_eq!(topics.value("a//b"), None);
        let long = "n".repeat(TOPIC_PART_BYTES_MAX + 1);
        assert!(Topics::new(&long, "anna").is_err());
    }
}
