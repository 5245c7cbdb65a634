//! The running world of TRIK Studio's simulator: a field, its robots, and time in ticks of 10 ms.
//!
//! Owns the order of one tick (physics at the speeds chosen before, then noise, pose, gyroscope and encoders) and what
//! changes while it runs. Knows no programs and no rules: a program is given [`Arena::robot`], a judge reads the state.
//!
//! Facts are those of the original's simulator: ideal physics that takes its last step back when the robot touches
//! something, sensors that look at walls and solids in the order and with the roundings of its paths.

mod brick;
mod outline;
mod ranges;
mod robot;
mod solids;
mod timeline;

pub use brick::Handle;
pub use outline::{Bounds, Outline};
pub use robot::{Dice, Gamepad, Marker, Pad, Robot};
pub use solids::Solids;
pub use timeline::Timeline;

use std::collections::VecDeque;

use lang::diagram::devices;
use lang::diagram::machine::STEP_MS;
use lang::diagram::ports::Port;
use lang::diagram::program::Program;
use lang::diagram::stand_in::{Motion, motion};

use crate::field::{self, Field, SensorKind};
use crate::limits;

/// How a field is set going.
#[derive(Clone, Debug, Default)]
pub struct Setup {
    /// Of all noise and random numbers.
    pub seed: u64,
    /// Sensors that a program needs; they go onto ports that are empty.
    pub sensors: Vec<(Port, SensorKind)>,
    /// Robots beside that of the field.
    pub others: Vec<field::Robot>,
    /// What a person answers when a program asks, in order.
    pub answers: VecDeque<String>,
}

impl Setup {
    /// With the sensors that a program waits for.
    pub fn of(program: &Program) -> Self {
        let kind = |sensor| match sensor {
            devices::Sensor::Infrared => SensorKind::Infrared,
            devices::Sensor::Sonar => SensorKind::Sonar,
            devices::Sensor::Light => SensorKind::Light,
            devices::Sensor::Touch => SensorKind::Touch,
            devices::Sensor::Other => SensorKind::Other,
        };
        Self {
            sensors: devices::needed(program)
                .into_iter()
                .map(|(port, sensor)| (port, kind(sensor)))
                .collect(),
            ..Self::default()
        }
    }
}

/// A field on which robots drive.
#[derive(Debug)]
pub struct Arena {
    field: Field,
    seed: u64,
    now: u32,
    solids: Solids,
    robots: Vec<Robot>,
    answers: VecDeque<String>,
    /// Room for outlines that live for one call.
    scratch: Outline,
}

impl Arena {
    /// A field before its first tick.
    pub fn new(field: &Field, setup: Setup) -> Self {
        let mut first = field.robot().cloned().unwrap_or_else(|| field::Robot {
            // Another kit's robot: only where it stands is ours.
            sensors: Vec::new(),
            ..field.robots.first().cloned().unwrap_or_default()
        });
        for &(port, kind) in &setup.sensors {
            if first.sensor(port).is_none() {
                first.sensors.push(field::Sensor::new(port, kind));
            }
        }
        let others = setup.others.into_iter().take(limits::FIELD_ROBOTS);
        let robots = std::iter::once(first)
            .chain(others)
            .enumerate()
            .map(|(index, robot)| Robot::new(robot, index, setup.seed))
            .collect();
        Self {
            solids: Solids::of(field),
            field: field.clone(),
            seed: setup.seed,
            now: 0,
            robots,
            answers: setup.answers,
            scratch: Outline::default(),
        }
    }

    /// One tick: 10 ms of the world. A program's step at the same time comes after it.
    pub fn tick(&mut self) {
        self.now = self.now.saturating_add(STEP_MS);
        for robot in &mut self.robots {
            robot.outline_into(&mut self.scratch);
            let moved = if self.solids.meets(&self.scratch) {
                robot.is_stuck = true;
                let Motion { shift, turn } = robot.motion;
                Motion {
                    shift: (-shift.0, -shift.1),
                    turn: -turn,
                }
            } else {
                robot.is_stuck = false;
                motion(robot.chosen, robot.pose.degrees)
            };
            robot.motion = moved;
            robot.advance(&self.field.settings);
        }
    }

    /// Milliseconds since the beginning.
    pub fn now(&self) -> u32 {
        self.now
    }

    /// The seed that it was made with.
    pub fn seed(&self) -> u64 {
        self.seed
    }

    /// The field as it is now: solids are where they have been pushed.
    pub fn field(&self) -> &Field {
        &self.field
    }

    /// Changes the field while it runs: walls, colours, regions. Robots stay where they are.
    pub fn edit(&mut self, change: impl FnOnce(&mut Field)) {
        change(&mut self.field);
        self.solids = Solids::of(&self.field);
    }

    /// What robots and rays run into.
    pub fn solids(&self) -> &Solids {
        &self.solids
    }

    /// All robots as they are now; the first one is that of the field.
    pub fn robots(&self) -> &[Robot] {
        &self.robots
    }

    /// A robot, to be changed from outside its program: keys pressed, a gamepad, another place.
    pub fn robot_mut(&mut self, index: usize) -> Option<&mut Robot> {
        self.robots.get_mut(index)
    }

    /// A robot as its program sees it.
    ///
    /// # Panics
    /// If there is no such robot.
    pub fn robot(&mut self, index: usize) -> Handle<'_> {
        assert!(index < self.robots.len(), "no robot number {index}");
        Handle { arena: self, index }
    }
}

#[cfg(test)]
mod tests;
