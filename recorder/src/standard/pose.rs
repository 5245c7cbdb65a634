//! A place on the plane as `Odometry` and as a transform.
//!
//! Owns the speed, which is that between the last two places: a node of a place has none.

use crate::limits::STANDARD_OLD_NS;
use journal::standard::robot::{Odometry, Transform};
use std::f64::consts::PI;

/// The frame in which places are.
const WORLD: &str = "odom";
/// The frame of the robot, as tools expect it.
const ROBOT: &str = "base_link";

/// x and y in m, and the direction in rad.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Place {
    pub(super) x: f64,
    pub(super) y: f64,
    pub(super) heading: f64,
}

impl Place {
    /// That of three numbers, in units that are so many m and rad.
    pub(super) fn new(numbers: &[f64], length: f64, angle: f64) -> Self {
        let of = |at: usize| numbers.get(at).copied().unwrap_or(f64::NAN);
        Self {
            x: of(0) * length,
            y: of(1) * length,
            heading: of(2) * angle,
        }
    }
}

/// The places of one node.
#[derive(Debug, Default)]
pub(super) struct Track {
    last: Option<(u64, Place)>,
}

impl Track {
    /// The next place: None for the odometry of the first one, and after a pause, because a speed takes two.
    pub(super) fn go(
        &mut self,
        node: &str,
        unix_ns: u64,
        place: Place,
    ) -> (Option<Odometry>, Transform) {
        let child_frame = match node {
            "odometry" => ROBOT,
            other => other,
        };
        let half = place.heading / 2.0;
        let rotation = [0.0, 0.0, half.sin(), half.cos()];
        let transform = Transform {
            frame: WORLD.to_owned(),
            child_frame: child_frame.to_owned(),
            translation: [place.x, place.y, 0.0],
            rotation,
        };
        let odometry = self
            .speed(unix_ns, place)
            .map(|(ahead, left, turn)| Odometry {
                frame: WORLD.to_owned(),
                child_frame: child_frame.to_owned(),
                position: transform.translation,
                orientation: rotation,
                linear: [ahead, left, 0.0],
                angular: [0.0, 0.0, turn],
            });
        self.last = Some((unix_ns, place));
        (odometry, transform)
    }

    /// Ahead and to the left of the robot in m/s, and its turn in rad/s.
    fn speed(&self, unix_ns: u64, place: Place) -> Option<(f64, f64, f64)> {
        let (before_ns, before) = self.last?;
        let past_ns = unix_ns.checked_sub(before_ns)?;
        if past_ns == 0 || past_ns > STANDARD_OLD_NS {
            return None;
        }
        #[allow(clippy::cast_precision_loss, reason = "it is less than 2^53")]
        let past_s = past_ns as f64 / 1e9;
        let (dx, dy) = (place.x - before.x, place.y - before.y);
        let (sin, cos) = place.heading.sin_cos();
        // The shorter way around.
        let turn = (place.heading - before.heading + PI).rem_euclid(2.0 * PI) - PI;
        Some((
            (dx * cos + dy * sin) / past_s,
            (dy * cos - dx * sin) / past_s,
            turn / past_s,
        ))
    }
}
