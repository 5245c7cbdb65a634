//! What the filters of orientation share: inertial tuples, sensors that have fallen silent, and the forms of the result.
//!
//! A tuple holds the rates about x, y and z in mdps (thousandths of a degree per second), the accelerations along x, y and z
//! in any unit, and if there is a magnetometer the field along x, y and z in any unit: i32 all of them, all in the directions
//! of one sensor, right-handed. At rest the accelerations point up, for an accelerometer feels what holds it.

use crate::clock::Elapsed;
use crate::limits::SILENCE_US_MAX;
use crate::vector::{Quaternion, Vector, from_counts, unit};
use converter::Fault;

/// Radians per second of one mdps.
pub const MDPS_RAD: f32 = std::f32::consts::PI / 180_000.0;

/// A sensor of a direction, and for how long it has given none.
#[derive(Clone, Copy, Debug)]
pub struct Direction {
    /// What it is, for messages.
    pub what: &'static str,
    silent_us: f64,
}

impl Direction {
    /// A sensor that has given nothing yet.
    pub fn new(what: &'static str) -> Self {
        Self {
            what,
            silent_us: 0.0,
        }
    }

    /// The direction of a measured vector. Zeros have none, as in free fall; that is absent for a while.
    ///
    /// # Errors
    /// Zeros in the first tuple, and zeros for too long: a dead sensor.
    pub fn of(&mut self, counts: &[i32], elapsed: Elapsed) -> Result<Option<Vector>, Fault> {
        let direction = unit(from_counts(counts));
        if direction.is_some() {
            self.silent_us = 0.0;
            return Ok(direction);
        }
        let Elapsed::Us(us) = elapsed else {
            return Err(Fault::new(format!("the {} gives only zeros", self.what)));
        };
        self.silent_us += us;
        if self.silent_us > f64::from(SILENCE_US_MAX) {
            let text = format!(
                "the {} has given only zeros for {SILENCE_US_MAX} us",
                self.what
            );
            return Err(Fault::new(text));
        }
        Ok(None)
    }

    /// Forgets the silence.
    pub fn reset(&mut self) {
        self.silent_us = 0.0;
    }
}

/// The two directions of a tuple.
#[derive(Clone, Copy, Debug)]
pub struct Directions {
    accelerometer: Direction,
    magnetometer: Direction,
}

impl Default for Directions {
    fn default() -> Self {
        Self {
            accelerometer: Direction::new("accelerometer"),
            magnetometer: Direction::new("magnetometer"),
        }
    }
}

impl Directions {
    /// Up and magnetic north with its inclination; the second is absent without a magnetometer.
    ///
    /// # Errors
    /// As [`Direction::of`].
    pub fn of(
        &mut self,
        values: &[i32],
        elapsed: Elapsed,
    ) -> Result<(Option<Vector>, Option<Vector>), Fault> {
        let up = self.accelerometer.of(&values[3..6], elapsed)?;
        let north = match values.get(6..9) {
            Some(counts) => self.magnetometer.of(counts, elapsed)?,
            None => None,
        };
        Ok((up, north))
    }
}

/// The direction of the earth's field that fits a measured one: as much up or down as measured, the rest to the north.
pub fn field_of_the_earth(q: Quaternion, measured: Vector) -> Vector {
    let [x, y, z] = q.to_earth(measured);
    [(x * x + y * y).sqrt(), 0.0, z]
}

/// The fault of an orientation that was lost in rounding.
pub fn lost() -> Fault {
    Fault::new("the orientation is lost: the sensors contradict each other")
}

/// Fills in what the size of the result asks for: w x y z, or roll pitch yaw in degrees, or both, one after the other.
pub fn fill(q: Quaternion, results: &mut [f32]) {
    let mut rest = results;
    if rest.len() >= 4 {
        let (parts, angles) = rest.split_at_mut(4);
        parts.copy_from_slice(&[q.w, q.v[0], q.v[1], q.v[2]]);
        rest = angles;
    }
    if rest.len() == 3 {
        rest.copy_from_slice(&q.roll_pitch_yaw_deg());
    }
}

#[cfg(test)]
pub(crate) mod tests {
    use super::*;

    /// Rates, accelerations and field of a sensor in this orientation that turns at `rates` rad/s.
    pub(crate) fn measured(q: Quaternion, rates: Vector) -> [i32; 9] {
        let mut values = [0; 9];
        let up = q.to_sensor([0.0, 0.0, 4096.0]);
        // Inclined by about 60 degrees, as in Northern Europe.
        let field = q.to_sensor([5000.0, 0.0, -9000.0]);
        let rates = rates.map(|rate| rate / MDPS_RAD);
        for (place, real) in values.iter_mut().zip(rates.iter().chain(&up).chain(&field)) {
            *place = real.round() as i32;
        }
        values
    }

    /// Degrees between two orientations.
    pub(crate) fn degrees_between(a: Quaternion, b: Quaternion) -> f64 {
        let inverse = Quaternion {
            w: b.w,
            v: b.v.map(|part| -part),
        };
        let difference = a.after(inverse).unwrap();
        let [x, y, z] = difference.v.map(f64::from);
        2.0 * (x * x + y * y + z * z).sqrt().min(1.0).asin().to_degrees()
    }

    #[test]
    fn zeros_are_borne_for_a_while() {
        let mut sensor = Direction::new("accelerometer");
        let refused = sensor.of(&[0, 0, 0], Elapsed::First).unwrap_err();
        assert_eq!(refused.text(), "the accelerometer gives only zeros");
        assert_eq!(
            sensor.of(&[0, 0, 9], Elapsed::First),
            Ok(Some([0.0, 0.0, 1.0]))
        );
        let half = Elapsed::Us(500_000.0);
        assert_eq!(sensor.of(&[0, 0, 0], half), Ok(None));
        assert_eq!(sensor.of(&[0, 0, 0], half), Ok(None));
        let refused = sensor.of(&[0, 0, 0], half).unwrap_err();
        assert_eq!(
            refused.text(),
            "the accelerometer has given only zeros for 1000000 us"
        );
    }
}
