//! Robots by name: a body, where it starts, and what is plugged into which port of the board.
//!
//! The ports are those of the file of the same name in the configurations of robots.
//!
//! | port | `two-wheels` and `line-follower` | type in trik.lua |
//! | --- | --- | --- |
//! | M3, E3 | left wheel, positive is forward | motor100, encoder95 |
//! | M4, E4 | right wheel, positive is forward | motor100, encoder95 |
//! | A1 | infrared distance, forward | sharpGP2 |
//! | A3 | bumper at the front | touch |
//! | A5 | light sensor, looks down, left of the middle | light |
//! | A6 | light sensor, looks down, right of the middle | light |
//! | D1 | ultrasonic distance, forward | ultrasonic |
//! | D2 | ultrasonic distance, left | ultrasonic |
//! | S1 | a servo | angularServomotor |
//! | S6 | a gripper | manipulatorServomotor |
//! | camera | looks forward and down | - |
//! | ir_camera | looks where the camera looks | - |
//! | lidar | on top, 0 degrees is forward, clockwise | - |
//!
//! M1, M2, E1, E2, A2, A4, D3, S2 to S5 are empty. `two-wheels` starts on the free floor, `line-follower` on the line.
//! `bare` has nothing in any port. A robot with a model of its own has the sensors of `two-wheels`, and in the other ports
//! what drives the model.

use crate::body::Body;
use crate::body::bench::Bench;
use crate::body::rolling::configuration::configuration;
use crate::body::rolling::{Overrides, Rolling};
use crate::body::two_wheels::TwoWheels;
use crate::geometry::{Pose, point};
use crate::world::World;

/// What is plugged into one port.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Plug {
    /// `M3`, `A1`, ...
    pub port: &'static str,
    /// The type of the device in the words of trik.lua; empty where a port has only one.
    pub kind: &'static str,
    /// What it is for.
    pub role: &'static str,
}

/// A robot that can be started.
#[derive(Debug, Clone, Copy)]
pub struct Robot {
    /// Its name.
    pub name: &'static str,
    /// What is plugged in, in the order of the ports.
    pub ports: &'static [Plug],
    /// Where the wheels stand; nothing for a board without any.
    start: Option<(f64, f64, f64)>,
}

const fn plug(port: &'static str, kind: &'static str, role: &'static str) -> Plug {
    Plug { port, kind, role }
}

const TWO_WHEELS: [Plug; 15] = [
    plug("M3", "motor100", "left wheel"),
    plug("M4", "motor100", "right wheel"),
    plug("E3", "encoder95", "left wheel"),
    plug("E4", "encoder95", "right wheel"),
    plug("A1", "sharpGP2", "distance forward"),
    plug("A3", "touch", "bumper"),
    plug("A5", "light", "left light sensor"),
    plug("A6", "light", "right light sensor"),
    plug("D1", "ultrasonic", "distance forward"),
    plug("D2", "ultrasonic", "distance left"),
    plug("S1", "angularServomotor", "servo"),
    plug("S6", "manipulatorServomotor", "gripper"),
    plug("camera", "", "line camera"),
    plug("ir_camera", "", "warmth ahead"),
    plug("lidar", "", "all around"),
];

const ROBOTS: [Robot; 3] = [
    Robot {
        name: "two-wheels",
        ports: &TWO_WHEELS,
        start: Some((0.8, 1.0, 0.0)),
    },
    Robot {
        name: "line-follower",
        ports: &TWO_WHEELS,
        start: Some((1.0, 0.4, 0.0)),
    },
    Robot {
        name: "bare",
        ports: &[],
        start: None,
    },
];

/// Where a robot with a model of its own begins: where `two-wheels` does.
pub const MODEL_START: Pose = Pose {
    at: point(0.8, 1.0),
    heading_rad: 0.0,
};

/// The usual body in the room on the wheels of a model, and the configuration that goes with it. `text` is that of the
/// model.
pub fn modelled(rolling: Rolling, text: &str, said: &Overrides) -> (Box<dyn Body>, String) {
    let lua = configuration(&rolling, text, said, &TWO_WHEELS);
    (Box::new(TwoWheels::on(World::room(), rolling)), lua)
}

/// The names of all robots.
pub fn names() -> impl Iterator<Item = &'static str> {
    ROBOTS.iter().map(|robot| robot.name)
}

/// The robot of this name.
pub fn by_name(name: &str) -> Option<Robot> {
    ROBOTS.into_iter().find(|robot| robot.name == name)
}

impl Robot {
    /// A new one of this kind at its start, in the room.
    pub fn body(&self) -> Box<dyn Body> {
        let Some((x, y, heading_rad)) = self.start else {
            return Box::new(Bench::default());
        };
        Box::new(TwoWheels::new(World::room(), Pose::new(x, y, heading_rad)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_robot_starts_on_free_floor() {
        for name in names() {
            let body = by_name(name).unwrap().body();
            let senses = body.senses();
            assert_ne!(senses.analog[2], Some(20.0), "{name} begins in a wall");
            assert!(senses.battery_v > 11.0);
        }
        assert!(by_name("three-wheels").is_none());
    }

    #[test]
    fn the_line_follower_starts_with_its_light_sensors_beside_the_line() {
        let senses = by_name("line-follower").unwrap().body().senses();
        for port in [4, 5] {
            let raw = senses.analog[port].unwrap();
            assert!((70.0..100.0).contains(&raw), "A{}: {raw}", port + 1);
        }
    }
}
