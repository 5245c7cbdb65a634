//! Odometry of a differential drive: where a robot is, from the encoders of its two wheels.
//!
//! With the ways a and b of the left and right wheel since the tuple before, and the track w between the wheels:
//!   d = (a + b) / 2,  h = (b - a) / w / 2,  x += d (sin h / h) cos(p + h),  y += d (sin h / h) sin(p + h),  p += 2 h
//! the exponential map of SE(2) (Lynch and Park, Modern Robotics, 2017, section 13.4, "odometry"): exact whenever both speeds
//! keep their ratio between two tuples, in a straight line and on any circle.
//! The heading is computed from the whole counts since the beginning, so it gathers no rounding errors.
//! x points ahead at the beginning, y to the left; angles grow to the left (ROS REP 103).
//! Counters of 32 bits may wrap around. More than 10 turns of a wheel between two tuples are a counter that was set
//! back: a fault, and the robot is at the origin again, because where it went is unknown.
//! In f64: steps of micrometres would vanish in an f32 of metres. Cost: about 60 operations, one or two divisions.

use crate::clock::Elapsed;
use crate::fused::{Fusion, Layout};
use crate::lanes::overflow;
use crate::number::Number;
use crate::params::Params;
use crate::trig::{sin_cos, wrapped};
use converter::{Conversion, Fault, OpenInfo};
use std::ffi::CStr;

/// Counts of a whole turn of a wheel when the configuration does not say: encoders that give degrees.
pub const COUNTS_PER_TURN: f64 = 360.0;
/// Longest track and largest wheel.
pub const LENGTH_MM_MAX: f64 = 1e6;
/// Shortest track and smallest wheel.
pub const LENGTH_MM_MIN: f64 = 1e-3;
/// Most counts of a turn.
pub const COUNTS_PER_TURN_MAX: f64 = 1e6;
/// Turns of a wheel between two tuples that are still believed.
const STEP_TURNS_MAX: f64 = 10.0;
/// Below this half angle sin h / h is 1 - h^2 / 6 to the last bit.
const SMALL: f64 = 1e-4;

/// A pose that follows two wheels.
#[derive(Clone, Copy, Debug)]
pub struct Odometry {
    mm_per_count: f64,
    track_mm: f64,
    step_counts_max: f64,
    /// Counts of the tuple before, absent before the first.
    counts: Option<(i32, i32)>,
    /// Counts that the right wheel has gone more than the left one since the beginning.
    turned: i64,
    x_mm: f64,
    y_mm: f64,
}

impl Odometry {
    /// The heading in radians.
    fn heading(&self) -> f64 {
        self.turned as f64 * self.mm_per_count / self.track_mm
    }

    /// Follows the wheels by these counts.
    fn follow(&mut self, left: i32, right: i32) {
        let heading = self.heading();
        self.turned += i64::from(right) - i64::from(left);
        let half = (self.heading() - heading) / 2.0;
        let way = (f64::from(left) + f64::from(right)) / 2.0 * self.mm_per_count;
        let sinc = if half.abs() < SMALL {
            1.0 - half * half / 6.0
        } else {
            sin_cos(half).0 / half
        };
        let (sin, cos) = sin_cos(heading + half);
        self.x_mm += way * sinc * cos;
        self.y_mm += way * sinc * sin;
    }
}

impl Fusion for Odometry {
    type Input = i32;
    type Output = f32;
    const LAYOUT: Layout = Layout {
        name: "odometry",
        inputs: &[2],
        outputs: &[3],
        is_timed: false,
    };
    const DESCRIPTION: &'static CStr =
        c"x and y in mm and heading in degrees from two wheel encoders";

    fn open(info: &OpenInfo<'_>) -> Result<Self, Fault> {
        let params = Params::new(Self::LAYOUT.name, info);
        let lengths = LENGTH_MM_MIN..=LENGTH_MM_MAX;
        let wheel_diameter_mm = params.required("wheel_diameter_mm", lengths.clone())?;
        let track_mm = params.required("track_mm", lengths)?;
        let counts = params.real(
            "counts_per_turn",
            COUNTS_PER_TURN,
            1.0..=COUNTS_PER_TURN_MAX,
        )?;
        Ok(Self {
            mm_per_count: wheel_diameter_mm * std::f64::consts::PI / counts,
            track_mm,
            step_counts_max: counts * STEP_TURNS_MAX,
            counts: None,
            turned: 0,
            x_mm: 0.0,
            y_mm: 0.0,
        })
    }

    fn step(
        &mut self,
        values: &[i32],
        _: Elapsed,
        results: &mut [f32],
    ) -> Result<Conversion, Fault> {
        let (left, right) = (values[0], values[1]);
        let before = self.counts.replace((left, right)).unwrap_or((left, right));
        let ways = (left.wrapping_sub(before.0), right.wrapping_sub(before.1));
        for (wheel, way) in [("left", ways.0), ("right", ways.1)] {
            if f64::from(way).abs() > self.step_counts_max {
                return Err(Fault::new(format!(
                    "the {wheel} encoder jumped by {way}: was its counter set back?"
                )));
            }
        }
        self.follow(ways.0, ways.1);
        let heading_deg = wrapped(self.heading().to_degrees(), 360.0);
        for (result, real) in results.iter_mut().zip([self.x_mm, self.y_mm, heading_deg]) {
            *result = f32::from_real(real).ok_or_else(overflow)?;
        }
        Ok(Conversion::Produced)
    }

    fn reset(&mut self) {
        self.counts = None;
        self.turned = 0;
        (self.x_mm, self.y_mm) = (0.0, 0.0);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::fused::tests::{open, step};

    /// A wheel of 1 mm of way for each count and a track of 100 mm.
    fn robot() -> crate::fused::Fused<Odometry> {
        let params = [
            ("wheel_diameter_mm", 360.0 / std::f64::consts::PI),
            ("track_mm", 100.0),
        ];
        open((2, 3), &params).unwrap()
    }

    fn near(found: [f32; 3], expected: [f32; 3]) {
        let close = found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-3);
        assert!(close, "{found:?} instead of {expected:?}");
    }

    #[test]
    fn a_straight_line_and_a_turn_on_the_spot() {
        // By hand: 300 mm ahead; a quarter turn on the spot is 100 pi / 4 = 78.54 mm on each wheel; then 100 to the left.
        let mut odometry = robot();
        near(
            step(&mut odometry, &[5, -5], None).unwrap(),
            [0.0, 0.0, 0.0],
        );
        near(
            step(&mut odometry, &[305, 295], None).unwrap(),
            [300.0, 0.0, 0.0],
        );
        let turned = step::<_, 3>(&mut odometry, &[305 - 79, 295 + 79], None).unwrap();
        near(turned, [300.0, 0.0, (158.0_f32 / 100.0).to_degrees()]);
    }

    #[test]
    fn an_arc_is_exact_however_few_samples_it_has() {
        // Radius 200: the left wheel at 150, the right one at 250; 1.5 rad: 225 and 375 mm. The end of the arc lies at
        // (200 sin 1.5, 200 (1 - cos 1.5)).
        let angle = 1.5_f32;
        let end = [
            200.0 * angle.sin(),
            200.0 * (1.0 - angle.cos()),
            angle.to_degrees(),
        ];
        for parts in [1, 3, 75] {
            let mut odometry = robot();
            let mut pose = [0.0; 3];
            for n in 0..=parts {
                pose = step(&mut odometry, &[225 * n / parts, 375 * n / parts], None).unwrap();
            }
            near(pose, end);
        }
    }

    #[test]
    fn a_closed_circle_ends_where_it_began_and_counters_may_pass_their_end() {
        let mut odometry = robot();
        let mut pose = [0.0; 3];
        // 360 steps of 1 and 3 counts: 720 counts more on the right side, 7.2 rad.
        for n in 0..=360_i32 {
            let counts = [
                (i32::MAX - 100).wrapping_add(n),
                (i32::MIN + 3).wrapping_sub(-3 * n),
            ];
            pose = step(&mut odometry, &counts, None).unwrap();
        }
        let heading = 7.2_f32;
        // Radius: 200 per 2 * 100 / 2 = 100 mm ahead for each rad.
        let expected = [
            100.0 * heading.sin(),
            100.0 * (1.0 - heading.cos()),
            heading.to_degrees() - 360.0,
        ];
        near(pose, expected);
    }

    #[test]
    fn driving_there_and_back_ends_at_the_origin() {
        let mut odometry = robot();
        let path: Vec<[i32; 2]> = (0..500)
            .map(|n| [n * 7 + n * n / 50, n * 3 - n * n / 90])
            .collect();
        for counts in path.iter().chain(path.iter().rev()) {
            step::<_, 3>(&mut odometry, counts, None).unwrap();
        }
        near(
            step(&mut odometry, &path[0], None).unwrap(),
            [0.0, 0.0, 0.0],
        );
    }

    #[test]
    fn a_counter_that_was_set_back_is_a_fault() {
        let mut odometry = robot();
        step::<_, 3>(&mut odometry, &[4000, 4000], None).unwrap();
        assert_eq!(
            step::<_, 3>(&mut odometry, &[0, 4001], None).unwrap_err(),
            "odometry: the left encoder jumped by -4000: was its counter set back?"
        );
        near(
            step(&mut odometry, &[1, 4002], None).unwrap(),
            [0.0, 0.0, 0.0],
        );
    }

    #[test]
    fn sizes_of_the_robot_must_be_given() {
        let refused =
            |params: &[(&str, f64)]| open::<Odometry>((2, 3), params).err().unwrap().to_string();
        assert_eq!(refused(&[]), "odometry: wheel_diameter_mm is missing");
        assert_eq!(
            refused(&[("wheel_diameter_mm", 56.0), ("track_mm", 0.0)]),
            "odometry: track_mm must be from 0.001 to 1000000, not 0"
        );
        let refused = open::<Odometry>((3, 3), &[]).err().unwrap();
        assert_eq!(
            refused.text(),
            "odometry: tuples of 12 to 12 bytes; it takes 8 and gives 12"
        );
    }
}
