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
#[derive(Clone, Debug, Default)]
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
            values: (0..SENSORS.len()).map(nothing).collect(),
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

    /// Reads all that are named, but for those that somebody has locked.
    pub fn refresh(&mut self, brick: &mut dyn Brick) {
        for index in 0..self.used.len() {
            if self.used[index] && !is_locked(index, brick) {
                self.read(index, brick);
            }
        }
    }

    /// The value of a variable, if the program reads that sensor.
    pub fn known(&self, index: usize) -> Option<Value> {
        let is_used = self.used.get(index).copied().unwrap_or(false);
        is_used.then(|| self.values.get(index).cloned()).flatten()
    }

    /// A sensor was read for somebody else, or was given a reading: its variable shows it at once.
    pub fn put(&mut self, port: Port, numbers: &[i32]) {
        let name = port.variable();
        let index = name.and_then(|name| SENSORS.iter().position(|sensor| sensor.name == name));
        let Some(index) = index.filter(|&index| self.used[index]) else {
            return;
        };
        self.values[index] = match (SENSORS[index].shape, numbers) {
            (Shape::Number, [number, ..]) => Value::Int(*number),
            (Shape::Numbers(_), _) => Value::ints(numbers),
            (Shape::Number, []) => return,
        };
    }

    fn read(&mut self, index: usize, brick: &mut dyn Brick) {
        let sensor = &SENSORS[index];
        let port = Port::shown_by(sensor.name);
        let value = match sensor.shape {
            Shape::Number => match port.and_then(|port| brick.scalar(port)) {
                Some(reading) => Value::Int(reading),
                None => nothing(index),
            },
            Shape::Numbers(_) => {
                self.scratch.clear();
                match port.is_some_and(|port| brick.vector(port, &mut self.scratch)) {
                    true => Value::ints(&self.scratch),
                    false => nothing(index),
                }
            }
        };
        self.values[index] = value;
    }
}

/// What a variable is without a device, as in the original: 0, of several numbers the first one alone, and an unset text
/// where the camera looks for an object.
fn nothing(index: usize) -> Value {
    match SENSORS[index].shape {
        Shape::Number if SENSORS[index].name.starts_with("objectSensor") => Value::Unset,
        Shape::Number => Value::Int(0),
        Shape::Numbers(_) => Value::ints(&[0]),
    }
}

fn is_locked(index: usize, brick: &mut dyn Brick) -> bool {
    let port = Port::shown_by(SENSORS[index].name);
    port.is_some_and(|port| brick.locked(port).is_some())
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
        self.brick.command(Command::Console { text });
    }

    fn random(&mut self, below: i32) -> i32 {
        self.brick
            .random_of_function(0, below.saturating_sub(1).max(0))
    }
}

/// Whether a port has one number.
pub(super) fn is_scalar(port: Port) -> bool {
    port.sort() != Sort::Vector
}
