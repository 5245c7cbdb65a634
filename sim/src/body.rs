//! What moves in a world: the border between the virtual board and whatever physics is behind it.
//!
//! The board asks a [`Body`] for signals at the connectors (volts, angles, distances as the sensor there sees them) and
//! gives it what drives the motors and servos. It knows no world; a body knows no registers and no files.

pub mod battery;
pub mod bench;
pub mod motor;
mod order;
mod pace;
pub mod rolling;
pub mod studio;
pub mod two_wheels;

pub use order::{BadOrder, Order};

use crate::field::{Field, Locks};
use crate::geometry::Pose;
use crate::show::{Moving, Scene};
use crate::world::Colour;

/// What one power motor gets.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Power {
    /// Share of the supply in percent, positive is forward.
    Duty(f64),
    /// Both ends at one potential.
    Brake,
    /// Nothing is connected.
    Open,
    /// The shaft is held.
    Blocked,
}

/// Everything that the board drives.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Drive {
    /// M1 to M4.
    pub motors: [Power; 4],
    /// S1 to S6: length of the pulse in nanoseconds, 0 when off.
    pub servos_ns: [u32; 6],
}

impl Default for Drive {
    fn default() -> Self {
        Self {
            motors: [Power::Duty(0.0); 4],
            servos_ns: [0; 6],
        }
    }
}

/// What the connectors carry now.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Senses {
    /// On the map.
    pub pose: Pose,
    /// E1 to E4: angle of the shaft in degrees, positive is forward.
    pub encoders_deg: [f64; 4],
    /// A1 to A6: what the converter of 10 bits would give, unrounded; nothing where nothing is plugged in.
    pub analog: [Option<f64>; 6],
    /// D1 to D3: what an ultrasonic sensor sees, in metres; nothing where none is plugged in or nothing is near.
    pub ultrasonic_m: [Option<f64>; 3],
    /// At the connector of the battery.
    pub battery_v: f64,
    /// Specific force forward, to the left and up, in m/s2: at rest (0, 0, 9.81).
    pub acceleration_mps2: [f64; 3],
    /// Rates around the same axes, in degrees per second.
    pub rate_dps: [f64; 3],
    /// How often it has run into a wall. No sensor counts them.
    pub bumps: u32,
}

/// What lies still feels that.
const GRAVITY_MPS2: f64 = 9.81;

impl Senses {
    /// While time stands still nothing turns and nothing is pushed.
    #[must_use]
    pub fn paused(self, is_paused: bool) -> Self {
        if !is_paused {
            return self;
        }
        Self {
            acceleration_mps2: [0.0, 0.0, GRAVITY_MPS2],
            rate_dps: [0.0; 3],
            ..self
        }
    }
}

/// A robot in its world.
pub trait Body: Send {
    /// Time goes on; `dt_s` is at most [`crate::limits::STEP_S`].
    fn step(&mut self, dt_s: f64, drive: &Drive);

    /// The battery gives so much less than a good one.
    fn weaken_battery(&mut self, volts: f64);

    /// What the connectors carry now.
    fn senses(&self) -> Senses;

    /// The angles of [`Senses::encoders_deg`] alone: they are asked for after each step.
    fn shafts_deg(&self) -> [f64; 4];

    /// Whether there is a lidar on the serial line.
    fn has_lidar(&self) -> bool;

    /// What a lidar sees at this angle, clockwise from straight ahead; nothing without a lidar or an echo.
    fn range_m(&self, clockwise_rad: f64) -> Option<f64>;

    /// Whether there is an infrared camera on bus 1; it looks where the other one looks.
    fn has_infrared_camera(&self) -> bool;

    /// Does what a person orders the world itself, in words that [`Order`] reads.
    ///
    /// # Errors
    /// What is wrong with the words, for this person.
    fn order(&mut self, _words: &str) -> Result<(), BadOrder> {
        Err(BadOrder::NoOrders)
    }

    /// Puts another world of TRIK Studio around the robot, and the robot to where that has it.
    ///
    /// # Errors
    /// This world stays as it is.
    fn enter(&mut self, _field: &Field, _locks: Locks) -> Result<(), BadOrder> {
        Err(BadOrder::NoOrders)
    }

    /// What stands still around it, for people; nothing without a world.
    fn scene(&self) -> Option<Scene> {
        None
    }

    /// Changes whenever what stands still does.
    fn version(&self) -> u32 {
        0
    }

    /// What moves, for people. Looking changes nothing.
    fn moving(&self) -> Moving {
        Moving::default()
    }

    /// What a camera sees: `right` and `down` from -1 to 1 across its picture. Nothing without a camera.
    fn pixel(&self, right: f64, down: f64) -> Option<Colour>;
}
