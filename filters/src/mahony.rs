//! Mahony's filter: orientation from gyroscope and accelerometer, and a magnetometer if there is one.
//!
//! e = sum of measured x predicted over the directions of gravity and of the magnetic field;
//! b <- b + ki e T;  q' = q (w + kp e + b) / 2
//! (Mahony, Hamel and Pflimlin, Nonlinear Complementary Filters on the Special Orthogonal Group, IEEE Transactions on Automatic
//! Control 53, 2008, section IV.B, the explicit complementary filter, equations 48). With ki it learns the bias of the
//! gyroscope, which is bounded by 0.5 rad/s, so that a long contradiction cannot make it run away.
//! Begin: the orientation of a sensor at rest. Without a magnetometer the yaw begins at 0 and drifts with the gyroscope.
//! In f32, see `vector.rs`. Cost: about 90 operations, two square roots and two divisions; 60 more with a magnetometer; the
//! angles, if they are asked for, are three arc tangents in f64.

use crate::clock::Elapsed;
use crate::fused::{Fusion, Layout};
use crate::inertial::{Directions, MDPS_RAD, field_of_the_earth, fill, lost};
use crate::params::Params;
use crate::vector::{Quaternion, Vector, cross, from_counts, plus};
use converter::{Conversion, Fault, OpenInfo};
use std::ffi::CStr;

/// `kp` in rad/s when the configuration does not say.
pub const KP: f64 = 1.0;
/// Greatest `kp` and `ki`.
pub const GAIN_MAX: f64 = 100.0;
/// Largest bias of each axis in rad/s, about 29 degrees per second.
const BIAS_MAX: f32 = 0.5;

/// Mahony's filter.
#[derive(Clone, Copy, Debug)]
pub struct Mahony {
    kp: f32,
    ki: f32,
    orientation: Option<Quaternion>,
    /// What has to be added to the rates, rad/s.
    bias: Vector,
    directions: Directions,
}

impl Mahony {
    /// The orientation `seconds` after `q`.
    fn follow(
        &mut self,
        q: Quaternion,
        rates: Vector,
        up: Option<Vector>,
        north: Option<Vector>,
        seconds: f32,
    ) -> Option<Quaternion> {
        let mut error = [0.0; 3];
        if let Some(up) = up {
            error = plus(error, 1.0, cross(up, q.to_sensor([0.0, 0.0, 1.0])));
        }
        if let Some(north) = north {
            let predicted = q.to_sensor(field_of_the_earth(q, north));
            error = plus(error, 1.0, cross(north, predicted));
        }
        self.bias =
            plus(self.bias, self.ki * seconds, error).map(|bias| bias.clamp(-BIAS_MAX, BIAS_MAX));
        let rates = plus(plus(rates, self.kp, error), 1.0, self.bias);
        q.turned(rates, (0.0, [0.0; 3]), seconds)
    }
}

impl Fusion for Mahony {
    type Input = i32;
    type Output = f32;
    const LAYOUT: Layout = Layout {
        name: "mahony",
        inputs: &[6, 9],
        outputs: &[3, 4, 7],
        is_timed: true,
    };
    const DESCRIPTION: &'static CStr =
        c"Mahony's orientation from rates, accelerations and perhaps a magnetic field";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::LAYOUT.name, info);
        Ok(Self {
            kp: params.real("kp", KP, 0.0..=GAIN_MAX)? as f32,
            ki: params.real("ki", 0.0, 0.0..=GAIN_MAX)? as f32,
            orientation: None,
            bias: [0.0; 3],
            directions: Directions::default(),
        })
    }

    fn step(
        &mut self,
        values: &[i32],
        elapsed: Elapsed,
        results: &mut [f32],
    ) -> Result<Conversion, Fault> {
        let (up, north) = self.directions.of(values, elapsed)?;
        let q = match (self.orientation, elapsed.seconds()) {
            (Some(q), Some(seconds)) => {
                let rates = from_counts(values).map(|rate| rate * MDPS_RAD);
                self.follow(q, rates, up, north, seconds as f32)
            }
            _ => up.and_then(|up| Quaternion::at_rest(up, north)),
        };
        let q = q.ok_or_else(lost)?;
        self.orientation = Some(q);
        fill(q, results);
        Ok(Conversion::Produced)
    }

    fn reset(&mut self) {
        self.orientation = None;
        self.bias = [0.0; 3];
        self.directions = Directions::default();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fused::tests::{open, step};

    // Motion and convergence are tested beside Madgwick's filter, with the same samples.

    #[test]
    fn the_error_turns_the_shortest_way() {
        // By hand: level, then up seems to lie along y for a second at kp = 1: e = y x z = x, so q turns by 1/2 about x and
        // is (1, 1/2, 0, 0) / sqrt(5/4).
        let mut filter = open::<Mahony>((6, 4), &[("period_ms", 1000.0)]).unwrap();
        assert_eq!(
            step(&mut filter, &[0, 0, 0, 0, 0, 7], None),
            Ok([1.0, 0.0, 0.0, 0.0])
        );
        let [w, x, y, z] = step(&mut filter, &[0, 0, 0, 0, 7, 0], None).unwrap();
        let length = 1.25_f32.sqrt();
        assert!(
            (w - 1.0 / length).abs() < 1e-6 && (x - 0.5 / length).abs() < 1e-6,
            "{w} {x}"
        );
        assert_eq!((y, z), (0.0, 0.0));
    }

    #[test]
    fn gains_have_limits() {
        let refused = open::<Mahony>((6, 4), &[("period_ms", 1.0), ("ki", -1.0)])
            .err()
            .unwrap();
        assert_eq!(refused.text(), "mahony: ki must be from 0 to 100, not -1");
        let refused = open::<Mahony>((8, 4), &[]).err().unwrap();
        assert_eq!(
            refused.text(),
            "mahony: tuples of 32 to 16 bytes; it takes 24 or 36, 4 more with a time_us, and gives 12 or 16 or 28"
        );
    }
}
