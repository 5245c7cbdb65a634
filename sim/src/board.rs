//! The virtual board: a directory with the devices of a controller, alive while this is.
//!
//! Owns the order in which parts are made and ended; each part is a module of its own.
//! Threads: one for each I2C bus, and one for all files.

use crate::body::{Body, Power};
use crate::bus::Bus;
use crate::files::Files;
use crate::limits::{MAX_SPEED, MIN_SPEED};
use crate::machine::{BusCount, Machine};
use crate::root::Root;
use crate::shared::Shared;
use crate::show::Watcher;
use std::io;
use std::path::Path;
use std::sync::Arc;

/// How a board is made.
#[derive(Debug, Clone, Copy)]
pub struct Options {
    /// Simulated time for real time.
    pub speed: f64,
    /// Of all random numbers.
    pub seed: u64,
    /// If given, transactions on I2C take their time; the real bus has 100000.
    pub i2c_bits_per_second: Option<u32>,
}

impl Default for Options {
    fn default() -> Self {
        Self {
            speed: 1.0,
            seed: 1,
            i2c_bits_per_second: None,
        }
    }
}

/// What somebody who stands beside the robot can see.
#[derive(Debug, Clone, PartialEq)]
pub struct View {
    /// Simulated time since the start.
    pub time_s: f64,
    /// On the map, in metres.
    pub x_m: f64,
    /// On the map, in metres.
    pub y_m: f64,
    /// Counter-clockwise from the x axis, not limited to one turn.
    pub heading_deg: f64,
    /// M1 to M4: what they get, in percent; positive is forward. Nothing while one is braked, blocked or cut off.
    pub motors_percent: [Option<f64>; 4],
    /// E1 to E4: as the coprocessor counts them, positive is forward.
    pub encoders_deg: [f64; 4],
    /// At the battery.
    pub battery_v: f64,
    /// S1 to S6: length of the pulse, 0 when off.
    pub servos_ns: [u32; 6],
    /// Green and red.
    pub led: (bool, bool),
    /// D1 to D3: what an ultrasonic sensor there would hear.
    pub ultrasonic_m: [Option<f64>; 3],
    /// A1 to A6: what the converter would give without noise, where something is plugged in.
    pub analog_raw: [Option<u16>; 6],
    /// What went over I2C buses 1 and 2.
    pub i2c: [BusCount; 2],
    /// The last words that were said.
    pub said: String,
}

/// A running board.
pub struct Board {
    shared: Arc<Shared>,
    files: Option<Files>,
    root: Root,
}

impl Board {
    /// Makes the devices below `root`, which must be new, empty, or left over by a board that was killed.
    pub fn start(root: &Path, body: Box<dyn Body>, options: Options) -> io::Result<Self> {
        let speed = options.speed;
        if !(MIN_SPEED..=MAX_SPEED).contains(&speed) {
            let reason = format!("speed {speed} is not between {MIN_SPEED} and {MAX_SPEED}");
            return Err(io::Error::new(io::ErrorKind::InvalidInput, reason));
        }
        let root = Root::take(root)?;
        let machine = Machine::new(body, speed, options.seed);
        let shared = Arc::new(Shared::new(machine));
        std::fs::create_dir_all(root.path().join("dev"))?;
        let bus = |number: u8| {
            let path = root.path().join(format!("dev/i2c-{number}"));
            Bus::start(
                number,
                &path,
                Arc::clone(&shared),
                options.i2c_bits_per_second,
            )
        };
        let started = bus(1)
            .and_then(|first| Ok(vec![first, bus(2)?]))
            .and_then(|buses| Files::start(root.path(), Arc::clone(&shared), buses, options.seed));
        match started {
            Ok(files) => Ok(Self {
                shared,
                files: Some(files),
                root,
            }),
            Err(error) => {
                shared.stop();
                Err(error)
            }
        }
    }

    /// The directory.
    pub fn root(&self) -> &Path {
        self.root.path()
    }

    /// What was said since the last call, in order; of a great many only the newest.
    pub fn take_said(&self) -> Vec<String> {
        self.shared.machine().sayings.drain(..).collect()
    }

    /// For people who look at the world around it; nothing if there is none.
    pub fn watcher(&self) -> Option<Watcher> {
        Watcher::of(&self.shared)
    }

    /// How everything stands now.
    pub fn view(&self) -> View {
        let mut machine = self.shared.machine();
        machine.advance();
        let senses = machine.senses();
        let drive = machine.drive();
        View {
            time_s: machine.time_s(),
            x_m: senses.pose.at.x,
            y_m: senses.pose.at.y,
            heading_deg: senses.pose.heading_rad.to_degrees(),
            motors_percent: drive.motors.map(|power| match power {
                Power::Duty(duty) => Some(duty),
                Power::Brake | Power::Open | Power::Blocked => None,
            }),
            encoders_deg: machine.encoders_deg(),
            battery_v: senses.battery_v,
            servos_ns: drive.servos_ns,
            led: machine.led,
            ultrasonic_m: senses.ultrasonic_m,
            analog_raw: senses
                .analog
                .map(|raw| raw.map(|raw| raw.round().clamp(0.0, 1023.0) as u16)),
            i2c: machine.buses,
            said: machine.said.clone(),
        }
    }
}

impl Drop for Board {
    fn drop(&mut self) {
        self.shared.stop();
        // Threads end before their files go.
        self.files = None;
    }
}

#[cfg(test)]
mod tests;
