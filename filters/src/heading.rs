//! Heading of a robot from gyroscope and accelerometer: the rate about the vertical, whichever way the sensor is tilted.
//!
//! Up is followed by the gyroscope and pulled by the accelerometer,
//!   u <- u + T (u x w),  u <- u + (a/|a| - u) T / (tau + T),  u <- u/|u|,
//! the complementary filter of a direction (Hamel and Mahony, Attitude estimation on SO(3) based on direct inertial
//! measurements, ICRA 2006, section 3). The heading is where an axis e of the sensor points, seen from above, and grows by
//!   (w u - (w e) (e u)) / (1 - (e u)^2)
//! per second: e moves with w x e, of which the part across its horizontal projection counts. (w u alone would be wrong for
//! a robot that rocks: that integral depends on the way.) e is x, or y if x stands steep in the beginning.
//! Nothing corrects the heading itself, so it drifts with the bias of the gyroscope: `bias_ms` measures that in the
//! beginning, while the robot stands still. While e is nearly vertical there is no heading, and what it grows by is bounded.
//! Positive to the left, seen from above (ROS REP 103).
//! The directions are f32, see `vector.rs`; the heading is a sum of whole nanodegrees (mdps times us), because in an f32 of
//! degrees the steps of a slow turn would be rounded away. Cost: about 70 operations, two square roots, four divisions.

use crate::clock::Elapsed;
use crate::fused::{Fusion, Layout};
use crate::inertial::{Direction, MDPS_RAD, lost};
use crate::limits::{PERIOD_MS_MAX, REAL_MAX};
use crate::params::Params;
use crate::trig::atan2;
use crate::vector::{Vector, cross, dot, from_counts, plus, unit};
use converter::{Conversion, Fault, OpenInfo};
use std::ffi::CStr;

/// Time constant of up when the configuration does not say.
pub const TIME_CONSTANT_MS: f64 = 1000.0;
/// A whole turn: where the heading begins again when the configuration does not say.
pub const WRAP_MDEG: f64 = 360_000.0;
/// Most that the rates of a robot at rest may differ when the configuration does not say.
pub const STILL_MDPS: f64 = 2000.0;
/// Least squared length of the horizontal part of the axis whose heading it is: 13 degrees from the vertical.
const FLAT_MIN: f32 = 0.05;
/// Vertical part of x from which on y lies flatter, or flat enough.
const STEEP: f32 = 0.8;
/// Nanodegrees of a mdeg.
const MDEG_NDEG: i64 = 1_000_000;

/// A heading.
#[derive(Clone, Copy, Debug)]
pub struct Heading {
    time_constant_s: f32,
    wrap_ndeg: i64,
    still_mdps: i64,
    /// How long the bias is measured.
    bias_us: f64,
    /// The measured bias in mdps, absent until it has been.
    bias: Option<Vector>,
    rest: Rest,
    up: Option<Vector>,
    /// Number of the axis whose heading it is: 0 for x, 1 for y.
    axis: usize,
    heading_ndeg: i64,
    accelerometer: Direction,
}

/// What is known of a robot that should be at rest.
#[derive(Clone, Copy, Debug, Default)]
struct Rest {
    us: f64,
    count: i64,
    sum: [i64; 3],
    least: [i32; 3],
    greatest: [i32; 3],
}

impl Rest {
    /// Takes the rates of one tuple; begins again when they differ too much from the others.
    fn take(&mut self, rates: &[i32], elapsed: Elapsed, still_mdps: i64) {
        if let Elapsed::Us(us) = elapsed
            && self.count > 0
        {
            self.us += us;
        }
        let first = self.count == 0;
        for (axis, rate) in rates.iter().take(3).copied().enumerate() {
            self.sum[axis] += i64::from(rate);
            self.least[axis] = if first {
                rate
            } else {
                self.least[axis].min(rate)
            };
            self.greatest[axis] = if first {
                rate
            } else {
                self.greatest[axis].max(rate)
            };
        }
        self.count += 1;
        let spread = |axis: usize| i64::from(self.greatest[axis]) - i64::from(self.least[axis]);
        if (0..3).any(|axis| spread(axis) > still_mdps) {
            *self = Self::default();
        }
    }

    /// The mean.
    fn mean(&self) -> Vector {
        self.sum.map(|sum| (sum as f64 / self.count as f64) as f32)
    }
}

impl Heading {
    /// Follows up; gives the rate of the heading in mdps.
    fn follow(
        &mut self,
        rates_mdps: Vector,
        measured: Option<Vector>,
        seconds: f32,
    ) -> Result<f32, Fault> {
        let up = match (self.up, measured) {
            (Some(up), _) => up,
            (None, Some(measured)) => {
                self.axis = usize::from(measured[0].abs() > STEEP);
                self.up = Some(measured);
                return Ok(0.0);
            }
            (None, None) => return Err(lost()),
        };
        let rates = rates_mdps.map(|rate| rate * MDPS_RAD);
        let mut followed = plus(up, seconds, cross(up, rates));
        if let Some(measured) = measured {
            let weight = seconds / (self.time_constant_s + seconds);
            followed = plus(followed, weight, plus(measured, -1.0, followed));
        }
        let followed = unit(followed).ok_or_else(lost)?;
        self.up = Some(followed);
        let steep = followed[self.axis];
        let across = dot(rates_mdps, followed) - rates_mdps[self.axis] * steep;
        Ok(across / (1.0 - steep * steep).max(FLAT_MIN))
    }

    /// Adds what was turned since the tuple before.
    fn turn(&mut self, rate_mdps: f32, us: f64) {
        self.heading_ndeg += (f64::from(rate_mdps) * us).round() as i64;
        if self.wrap_ndeg > 0 {
            let half = self.wrap_ndeg / 2;
            self.heading_ndeg = (self.heading_ndeg + half).rem_euclid(self.wrap_ndeg) - half;
        }
    }

    /// Heading in mdeg, its rate in mdps, tilt in mdeg, as many as are asked for.
    fn fill(&self, rate_mdps: f32, results: &mut [i32]) -> Result<(), Fault> {
        let heading = (self.heading_ndeg + MDEG_NDEG / 2).div_euclid(MDEG_NDEG);
        results[0] = i32::try_from(heading).map_err(|_| {
            Fault::new("the heading has left its range: it turned too often one way")
        })?;
        if let Some(rate) = results.get_mut(1) {
            *rate = rate_mdps.round() as i32;
        }
        if let (Some(tilt), Some([x, y, z])) =
            (results.get_mut(2), self.up.map(|up| up.map(f64::from)))
        {
            *tilt = (atan2((x * x + y * y).sqrt(), z).to_degrees() * 1000.0).round() as i32;
        }
        Ok(())
    }
}

impl Fusion for Heading {
    type Input = i32;
    type Output = i32;
    const LAYOUT: Layout = Layout {
        name: "heading",
        inputs: &[6],
        outputs: &[1, 2, 3],
        is_timed: true,
    };
    const DESCRIPTION: &'static CStr =
        c"heading in mdeg about the vertical, from rates and accelerations";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::LAYOUT.name, info);
        let times = 0.0..=PERIOD_MS_MAX;
        let time_constant_ms = params.real("time_constant_ms", TIME_CONSTANT_MS, times.clone())?;
        let bias_us = params.real("bias_ms", 0.0, times)? * 1000.0;
        let wrap = params.whole("wrap", WRAP_MDEG, 0.0..=REAL_MAX)?;
        let still = params.whole("still_mdps", STILL_MDPS, 0.0..=REAL_MAX)?;
        Ok(Self {
            time_constant_s: (time_constant_ms / 1000.0) as f32,
            wrap_ndeg: wrap as i64 * MDEG_NDEG,
            still_mdps: still as i64,
            bias_us,
            bias: (bias_us == 0.0).then_some([0.0; 3]),
            rest: Rest::default(),
            up: None,
            axis: 0,
            heading_ndeg: 0,
            accelerometer: Direction::new("accelerometer"),
        })
    }

    fn step(
        &mut self,
        values: &[i32],
        elapsed: Elapsed,
        results: &mut [i32],
    ) -> Result<Conversion, Fault> {
        let measured = self.accelerometer.of(&values[3..6], elapsed)?;
        let Some(bias) = self.bias else {
            self.rest.take(values, elapsed, self.still_mdps);
            if self.rest.us >= self.bias_us && self.rest.count > 0 {
                self.bias = Some(self.rest.mean());
            }
            return Ok(Conversion::Consumed);
        };
        let rates = plus(from_counts(values), -1.0, bias);
        let us = if let Elapsed::Us(us) = elapsed {
            us
        } else {
            0.0
        };
        let rate = self.follow(rates, measured, (us / 1e6) as f32)?;
        self.turn(rate, us);
        self.fill(rate, results)?;
        Ok(Conversion::Produced)
    }

    fn reset(&mut self) {
        self.bias = (self.bias_us == 0.0).then_some([0.0; 3]);
        self.rest = Rest::default();
        self.up = None;
        self.heading_ndeg = 0;
        self.accelerometer.reset();
    }
}

#[cfg(test)]
mod tests;
