//! A controller on a table: a battery, and nothing in any port.

use super::battery::Battery;
use super::{Body, Drive, Senses};
use crate::world::Colour;

/// What stands on the table.
#[derive(Debug, Default)]
pub struct Bench {
    battery: Battery,
}

impl Body for Bench {
    fn step(&mut self, dt_s: f64, _drive: &Drive) {
        self.battery.step(dt_s, 0.0);
    }

    fn weaken_battery(&mut self, volts: f64) {
        self.battery.sag_v = volts;
    }

    fn senses(&self) -> Senses {
        Senses {
            battery_v: self.battery.voltage_v(),
            acceleration_mps2: [0.0, 0.0, 9.81],
            ..Senses::default()
        }
    }

    fn shafts_deg(&self) -> [f64; 4] {
        [0.0; 4]
    }

    fn has_infrared_camera(&self) -> bool {
        false
    }

    fn has_lidar(&self) -> bool {
        false
    }

    fn range_m(&self, _clockwise_rad: f64) -> Option<f64> {
        None
    }

    fn pixel(&self, _right: f64, _down: f64) -> Option<Colour> {
        None
    }
}
