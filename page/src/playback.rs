//! A recording that is played below the tree, as the page shows it.
//!
//! Owns the border, and the form of what is told. Who plays is known to the program that serves the page.

use crate::world::Refused;
use std::time::Duration;

/// A recording that plays and takes orders. Its methods are called from the thread of the server and must not wait.
pub trait Playback: Send + Sync {
    /// Where it is.
    fn state(&self) -> State;

    /// Does what a person orders: `pause`, `go`, `seek 12.5`, `speed 2`, `loop on`.
    ///
    /// # Errors
    /// What is wrong with the words, for this person.
    fn order(&self, words: &str) -> Result<(), Refused>;
}

/// Where a recording is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct State {
    /// Since its beginning.
    pub position: Duration,
    /// From its beginning to its end.
    pub length: Duration,
    /// Seconds of the recording in a real one.
    pub speed: f64,
    /// It does not stand still.
    pub runs: bool,
    /// It begins again at its end.
    pub is_loop: bool,
}

impl State {
    /// As JSON; times are seconds.
    pub fn json(&self) -> String {
        serde_json::json!({
            "at_s": self.position.as_secs_f64(),
            "length_s": self.length.as_secs_f64(),
            "speed": self.speed,
            "runs": self.runs,
            "loop": self.is_loop,
        })
        .to_string()
    }
}
