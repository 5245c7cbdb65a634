//! Sensor variables: refreshed every 20 ms from the robot, and the same in between.
//!
//! Owns the values and the time of the next refresh. What no expression names is not read.

use super::formulas::Formulas;
use crate::brick::{Brick, Command};
use crate::ports::{Port, Sort};
use lang_expr::reserved::{SENSORS, SensorIndex, Shape};
use lang_expr::{Outside, Value};

/// How often sensor variables are refreshed, in milliseconds.
const REFRESH_MS: u32 = 20;

/// Values of sensor variables.
#[derive(Debug, Default)]
pub(super) struct Sensors {
    /// By index of the variable; those that somebody names.
    used: Vec<bool>,
    values: Vec<Value>,
    past: u32,
    scratch: Vec<i32>,
}

impl Sensors {
    pub fn new(formulas: &Formulas) -> Self {
        let mut used = vec![false; SENSORS.len()];
        for index in formulas.sensors() {
            used[index] = true;
        }
        Self {
            used,
            values: vec![Value::Nil; SENSORS.len()],
            ..Self::default()
        }
    }

    /// Lets time pass.
    pub fn are_due(&mut self, elapsed: u32) -> bool {
        self.past = self.past.saturating_add(elapsed);
        let is_due = self.past >= REFRESH_MS;
        if is_due {
            self.past = 0;
        }
        is_due
    }

    /// Reads all that are named.
    pub fn refresh(&mut self, brick: &mut dyn Brick) {
        for index in 0..self.used.len() {
            if self.used[index] {
                self.read(index, brick);
            }
        }
    }

    fn read(&mut self, index: usize, brick: &mut dyn Brick) {
        let sensor = &SENSORS[index];
        let port = Port::shown_by(sensor.name);
        let value = match sensor.shape {
            // Without a device it is 0, or empty, as in the original.
            Shape::Number => Value::Int(port.and_then(|port| brick.scalar(port)).unwrap_or(0)),
            Shape::Numbers(_) => {
                self.scratch.clear();
                if let Some(port) = port
                    && !brick.vector(port, &mut self.scratch)
                {
                    self.scratch.clear();
                }
                Value::ints(&self.scratch)
            }
        };
        self.values[index] = value;
    }
}

/// The robot as expressions see it.
pub(super) struct Robot<'a> {
    pub sensors: &'a mut Sensors,
    pub brick: &'a mut dyn Brick,
    pub now: u32,
}

impl Outside for Robot<'_> {
    fn sensor(&mut self, sensor: SensorIndex) -> Value {
        let index = usize::from(sensor);
        if let Some(used) = self.sensors.used.get_mut(index)
            && !std::mem::replace(used, true)
        {
            // Named only by a text that was put together while running.
            self.sensors.read(index, self.brick);
        }
        self.sensors.values.get(index).cloned().unwrap_or_default()
    }

    fn time(&mut self) -> i32 {
        i32::try_from(self.now).unwrap_or(i32::MAX)
    }

    fn print(&mut self, text: &str) {
        self.brick.tell(Command::Console { text });
    }

    fn random(&mut self, below: i32) -> i32 {
        self.brick.random(0, below.saturating_sub(1).max(0))
    }
}

/// Whether a port has one number.
pub(super) fn is_scalar(port: Port) -> bool {
    port.sort() != Sort::Vector
}
