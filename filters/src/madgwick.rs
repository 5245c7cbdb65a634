//! Madgwick's filter: orientation from gyroscope and accelerometer, and a magnetometer if there is one.
//!
//! q' = q w / 2 - beta g / |g|, where g is the gradient of |predicted - measured|^2 over the directions of gravity and of the
//! magnetic field: the gyroscope leads, one step of steepest descent pulls (Madgwick, An efficient orientation filter for
//! inertial and inertial/magnetic sensor arrays, 2010, equations 12, 20 to 34, 43, 44; Madgwick, Harrison and Vaidyanathan,
//! Estimation of IMU and MARG orientation using a gradient descent algorithm, 2011).
//! beta is the error of the gyroscope in rad/s that can be corrected. The predicted direction of d is that of the report,
//! p = d - 2 w v x d + 2 v x (v x d), and with f = p - measured its gradient is, written with vectors,
//!   dw = -2 (v x d) f,  dv = -2 w (d x f) + 2 (f (v d) + d (v f) - 2 v (d f))
//! which for d = z is equation 25. Begin: the orientation of a sensor at rest, instead of many samples of convergence.
//! Without a magnetometer the yaw begins at 0 and drifts with the gyroscope.
//! In f32, see `vector.rs`. Cost: about 120 operations, two square roots and two divisions; 100 more with a magnetometer;
//! the angles, if they are asked for, are three arc tangents in f64.

use crate::clock::Elapsed;
use crate::fused::{Fusion, Layout};
use crate::inertial::{Directions, MDPS_RAD, field_of_the_earth, fill, lost};
use crate::params::Params;
use crate::vector::{Quaternion, Vector, cross, dot, from_counts, plus};
use converter::{Conversion, Fault, OpenInfo};
use std::ffi::CStr;

/// `beta` in rad/s when the configuration does not say.
pub const BETA: f64 = 0.1;
/// Greatest `beta`.
pub const BETA_MAX: f64 = 10.0;

/// Madgwick's filter.
#[derive(Clone, Copy, Debug)]
pub struct Madgwick {
    beta: f32,
    orientation: Option<Quaternion>,
    directions: Directions,
}

/// Adds the gradient for a direction `d` of the earth that was `measured` by the sensor.
fn add_gradient(sum: &mut (f32, Vector), q: Quaternion, d: Vector, measured: Vector) {
    let f = plus(q.to_sensor(d), -1.0, measured);
    sum.0 += -2.0 * dot(cross(q.v, d), f);
    sum.1 = plus(sum.1, -2.0 * q.w, cross(d, f));
    sum.1 = plus(sum.1, 2.0 * dot(q.v, d), f);
    sum.1 = plus(sum.1, 2.0 * dot(q.v, f), d);
    sum.1 = plus(sum.1, -4.0 * dot(d, f), q.v);
}

impl Madgwick {
    /// The part of the derivative that pulls towards what was measured.
    fn pull(&self, q: Quaternion, up: Option<Vector>, north: Option<Vector>) -> (f32, Vector) {
        let mut gradient = (0.0, [0.0; 3]);
        if let Some(up) = up {
            add_gradient(&mut gradient, q, [0.0, 0.0, 1.0], up);
        }
        if let Some(north) = north {
            add_gradient(&mut gradient, q, field_of_the_earth(q, north), north);
        }
        let squared = gradient.0 * gradient.0 + dot(gradient.1, gradient.1);
        if squared <= f32::MIN_POSITIVE {
            return (0.0, [0.0; 3]);
        }
        let factor = -self.beta / squared.sqrt();
        (gradient.0 * factor, gradient.1.map(|part| part * factor))
    }
}

impl Fusion for Madgwick {
    type Input = i32;
    type Output = f32;
    const LAYOUT: Layout = Layout {
        name: "madgwick",
        inputs: &[6, 9],
        outputs: &[3, 4, 7],
        is_timed: true,
    };
    const DESCRIPTION: &'static CStr =
        c"Madgwick's orientation from rates, accelerations and perhaps a magnetic field";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::LAYOUT.name, info);
        Ok(Self {
            beta: params.real("beta", BETA, 0.0..=BETA_MAX)? as f32,
            orientation: None,
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
                q.turned(rates, self.pull(q, up, north), seconds as f32)
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
        self.directions = Directions::default();
    }
}

#[cfg(test)]
mod tests;
