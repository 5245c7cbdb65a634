//! People who look at a running board and order its world something.
//!
//! Owns texts that are kept, so that many who look cost hardly more than one. It holds the machine only while it copies what is
//! there; texts are made after that. Nothing runs while nobody asks.

use super::text::{self, Beside};
use crate::body::BadOrder;
use crate::faults;
use crate::field::{Field, Locks};
use crate::limits;
use crate::shared::Shared;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Looks at the world of a board.
pub struct Watcher {
    shared: Arc<Shared>,
    kept: Mutex<Kept>,
}

/// Texts that serve everybody.
#[derive(Default)]
struct Kept {
    scene: Option<(u32, String)>,
    state: Option<(Instant, String)>,
}

impl Watcher {
    /// Of this board; nothing if there is no world around it.
    pub(crate) fn of(shared: &Arc<Shared>) -> Option<Self> {
        shared.machine().body().scene()?;
        Some(Self {
            shared: Arc::clone(shared),
            kept: Mutex::default(),
        })
    }

    fn kept(&self) -> MutexGuard<'_, Kept> {
        self.kept.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Changes whenever what stands still does.
    pub fn version(&self) -> u32 {
        self.shared.machine().body().version()
    }

    /// What stands still, as JSON, and its version.
    pub fn scene(&self) -> (u32, String) {
        let mut kept = self.kept();
        let machine = self.shared.machine();
        let version = machine.body().version();
        if let Some((of, text)) = &kept.scene
            && *of == version
        {
            return (version, text.clone());
        }
        let scene = machine.body().scene().unwrap_or_default();
        drop(machine);
        let devices: Vec<_> = faults::devices().collect();
        let text = text::scene(&scene, &devices);
        kept.scene = Some((version, text.clone()));
        (version, text)
    }

    /// What moves, as JSON: not older than a few milliseconds.
    pub fn state(&self) -> String {
        let mut kept = self.kept();
        let now = Instant::now();
        if let Some((made, text)) = &kept.state
            && now.duration_since(*made) < Duration::from_millis(limits::SHOWN_MS)
        {
            return text.clone();
        }
        let mut machine = self.shared.machine();
        machine.advance();
        let moving = machine.body().moving();
        let beside = Beside {
            led: machine.led,
            said: machine.said.clone(),
            faults: machine.faults.in_force().collect(),
        };
        drop(machine);
        let text = text::moving(&moving, &beside);
        kept.state = Some((now, text.clone()));
        text
    }

    /// Orders the world something, in words.
    ///
    /// # Errors
    /// Why it is not done, for the person.
    pub fn order(&self, words: &str) -> Result<(), BadOrder> {
        self.kept().state = None;
        let mut machine = self.shared.machine();
        machine.advance();
        machine.order(words)
    }

    /// Puts another world of TRIK Studio around the robot.
    ///
    /// # Errors
    /// The world of this robot stays as it is.
    pub fn enter(&self, field: &Field, locks: Locks) -> Result<(), BadOrder> {
        self.kept().state = None;
        let mut machine = self.shared.machine();
        machine.advance();
        machine.enter(field, locks)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::body::Body;
    use crate::body::bench::Bench;
    use crate::machine::Machine;
    use crate::robots;
    use serde_json::Value;

    /// So slow that no step is due by itself.
    fn shared(body: Box<dyn Body>) -> Arc<Shared> {
        Arc::new(Shared::new(Machine::new(body, 1e-9, 1)))
    }

    fn read(text: &str) -> Value {
        serde_json::from_str(text).unwrap()
    }

    #[test]
    fn a_controller_on_a_table_has_no_world() {
        assert!(Watcher::of(&shared(Box::<Bench>::default())).is_none());
    }

    #[test]
    fn a_hand_moves_robot_and_ball_and_reset_puts_them_back() {
        let shared = shared(robots::by_name("two-wheels").unwrap().body());
        let watcher = Watcher::of(&shared).unwrap();
        let (version, text) = watcher.scene();
        let scene = read(&text);
        assert_eq!(scene["things"].as_array().unwrap().len(), 1);
        assert_eq!(scene["start"], serde_json::json!([0.8, 1.0, 0.0]));
        let before = read(&watcher.state());
        assert_eq!(before["robots"][0]["at"], serde_json::json!([0.8, 1, 0]));
        let sensors = scene["robots"][0]["sensors"].as_array().unwrap().len();
        assert_eq!(
            before["robots"][0]["read"].as_array().unwrap().len(),
            sensors
        );
        watcher.order("robot 2 0.6 90").unwrap();
        watcher.order("thing 0 1 0.25").unwrap();
        let after = read(&watcher.state());
        assert_eq!(after["robots"][0]["at"], serde_json::json!([2, 0.6, 90]));
        assert_eq!(after["things"][0], serde_json::json!([1, 0.25, 0]));
        for words in [
            "robot 5 5 0",
            "thing 1 1 1",
            "thing 0 nan 0",
            "field x.xml",
            "rubbish",
        ] {
            assert!(watcher.order(words).is_err(), "{words}");
        }
        assert_eq!(read(&watcher.state()), after);
        watcher.order("reset").unwrap();
        assert_eq!(read(&watcher.state())["robots"], before["robots"]);
        assert_eq!(read(&watcher.state())["things"], before["things"]);
        assert_eq!(
            watcher.version(),
            version,
            "nothing that stands still has changed"
        );
    }

    #[test]
    fn faults_are_shown_as_they_are_told() {
        let shared = shared(robots::by_name("two-wheels").unwrap().body());
        let watcher = Watcher::of(&shared).unwrap();
        assert_eq!(read(&watcher.state())["faults"], serde_json::json!({}));
        shared.machine().faults.set("A1", "unplug").unwrap();
        shared
            .machine()
            .faults
            .set("msp430", "nack 0.25\nslow 40")
            .unwrap();
        shared.machine().faults.set("battery", "sag 2").unwrap();
        watcher.order("pause").unwrap();
        let state = read(&watcher.state());
        let told =
            serde_json::json!({"msp430": "nack 0.25, slow 40", "A1": "unplug", "battery": "sag 2"});
        assert_eq!(state["faults"], told);
        assert_eq!(state["paused"], true);
    }
}
