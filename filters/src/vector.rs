//! Vectors of three and unit quaternions in f32, as the filters of orientation need them.
//!
//! f32 is enough: its 24 bits resolve an angle to 1e-7 rad, ten thousand times finer than the noise of the sensors, and on a
//! processor without a floating-point unit it costs half of f64.

/// Three components along x, y and z.
pub type Vector = [f32; 3];

/// Scalar product.
pub fn dot(a: Vector, b: Vector) -> f32 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Vector product.
pub fn cross(a: Vector, b: Vector) -> Vector {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// `a + factor * b`
pub fn plus(a: Vector, factor: f32, b: Vector) -> Vector {
    [
        a[0] + factor * b[0],
        a[1] + factor * b[1],
        a[2] + factor * b[2],
    ]
}

/// The same direction with the length 1; absent for a vector without a direction.
pub fn unit(v: Vector) -> Option<Vector> {
    let squared = dot(v, v);
    let factor = 1.0 / squared.sqrt();
    (squared > f32::MIN_POSITIVE && squared.is_finite()).then(|| v.map(|part| part * factor))
}

/// Numbers of a sensor as a vector.
pub fn from_counts(counts: &[i32]) -> Vector {
    [counts[0] as f32, counts[1] as f32, counts[2] as f32]
}

/// A rotation w + xi + yj + zk of the length 1 that turns vectors of the sensor into vectors of the earth.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Quaternion {
    /// Cosine of half of the angle.
    pub w: f32,
    /// Axis, times the sine of half of the angle.
    pub v: Vector,
}

impl Quaternion {
    /// No rotation.
    pub const IDENTITY: Self = Self {
        w: 1.0,
        v: [0.0; 3],
    };

    /// The quaternion of these four parts, brought to the length 1; absent if that is impossible.
    pub fn new(w: f32, v: Vector) -> Option<Self> {
        let squared = w * w + dot(v, v);
        let factor = 1.0 / squared.sqrt();
        let is_good = squared > f32::MIN_POSITIVE && squared.is_finite();
        is_good.then(|| Self {
            w: w * factor,
            v: v.map(|part| part * factor),
        })
    }

    /// First the rotation `other`, then this one.
    pub fn after(self, other: Self) -> Option<Self> {
        let v = plus(
            plus(cross(self.v, other.v), self.w, other.v),
            other.w,
            self.v,
        );
        Self::new(self.w * other.w - dot(self.v, other.v), v)
    }

    /// A vector of the sensor in the directions of the earth: v + 2 q x (q x v + w v).
    pub fn to_earth(self, v: Vector) -> Vector {
        plus(v, 2.0, cross(self.v, plus(cross(self.v, v), self.w, v)))
    }

    /// A vector of the earth in the directions of the sensor.
    pub fn to_sensor(self, v: Vector) -> Vector {
        Self {
            w: self.w,
            v: self.v.map(|part| -part),
        }
        .to_earth(v)
    }

    /// The quaternion after turning at `rates` rad/s for `seconds`, with `extra` added to the derivative: q + T (q w / 2 + e).
    pub fn turned(self, rates: Vector, extra: (f32, Vector), seconds: f32) -> Option<Self> {
        let w = -0.5 * dot(self.v, rates) + extra.0;
        let v = plus(cross(self.v, rates), self.w, rates);
        let v = plus(extra.1, 0.5, v);
        Self::new(self.w + seconds * w, plus(self.v, seconds, v))
    }

    /// The orientation of a sensor that is at rest, from the measured direction of up and, if there is one, of magnetic
    /// north; without one the x axis of the sensor points as far to the earth's x axis as the shortest rotation lets it.
    pub fn at_rest(up: Vector, north: Option<Vector>) -> Option<Self> {
        // The shortest rotation from up to z: 1 + cos, axis up x z. Upside down any axis is as short: take x.
        let level = if up[2] > -0.999_999 {
            Self::new(1.0 + up[2], [up[1], 0.0 - up[0], 0.0])?
        } else {
            Self {
                w: 0.0,
                v: [1.0, 0.0, 0.0],
            }
        };
        let Some(north) = north else {
            return Some(level);
        };
        let north = level.to_earth(north);
        // North lies on the magnetic field without its vertical part: turn it to x by half angles.
        let Some(flat) = unit([north[0], north[1], 0.0]) else {
            return Some(level);
        };
        let cos = ((1.0 + flat[0]).max(0.0) / 2.0).sqrt();
        let sin = ((1.0 - flat[0]).max(0.0) / 2.0).sqrt();
        let sin = if flat[1] > 0.0 { -sin } else { sin };
        Self::new(cos, [0.0, 0.0, sin])?.after(level)
    }

    /// Roll, pitch and yaw in degrees: the turns about x, then y, then z of the earth that make the rotation.
    pub fn roll_pitch_yaw_deg(self) -> [f32; 3] {
        let w = f64::from(self.w);
        let [x, y, z] = self.v.map(f64::from);
        let roll = crate::trig::atan2(2.0 * (w * x + y * z), 1.0 - 2.0 * (x * x + y * y));
        let pitch = crate::trig::asin(2.0 * (w * y - z * x));
        let yaw = crate::trig::atan2(2.0 * (w * z + x * y), 1.0 - 2.0 * (y * y + z * z));
        [roll, pitch, yaw].map(|angle| angle.to_degrees() as f32)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn near(a: Vector, b: Vector) {
        assert!(
            a.iter().zip(b).all(|(a, b)| (a - b).abs() < 2e-6),
            "{a:?} {b:?}"
        );
    }

    #[test]
    fn quarter_turns_turn_axes_into_axes() {
        let half = 0.5_f32.sqrt();
        let about_z = Quaternion {
            w: half,
            v: [0.0, 0.0, half],
        };
        near(about_z.to_earth([1.0, 0.0, 0.0]), [0.0, 1.0, 0.0]);
        near(about_z.to_sensor([0.0, 1.0, 0.0]), [1.0, 0.0, 0.0]);
        near(about_z.roll_pitch_yaw_deg(), [0.0, 0.0, 90.0]);
        let about_x = Quaternion {
            w: half,
            v: [half, 0.0, 0.0],
        };
        near(
            about_x.after(about_z).unwrap().to_earth([1.0, 0.0, 0.0]),
            [0.0, 0.0, 1.0],
        );
        let angles = Quaternion {
            w: half,
            v: [0.0, half, 0.0],
        }
        .roll_pitch_yaw_deg();
        assert!((angles[1] - 90.0).abs() < 0.05, "{angles:?}");
    }

    #[test]
    fn a_sensor_at_rest_knows_up_and_north() {
        let directions = [
            ([0.0, 0.0, 1.0], [1.0, 0.0, -1.0]),
            ([0.0, 0.0, -1.0], [0.0, 1.0, 0.2]),
            ([1.0, 0.0, 0.0], [0.3, 1.0, 0.0]),
            ([-0.6, 0.64, 0.48], [1.0, -0.1, 0.7]),
            ([0.0, 0.0, 1.0], [-1.0, 0.0, 0.0]),
        ];
        for (up, north) in directions {
            let up = unit(up).unwrap();
            let q = Quaternion::at_rest(up, Some(north)).unwrap();
            near(q.to_earth(up), [0.0, 0.0, 1.0]);
            let north = q.to_earth(north);
            assert!(north[1].abs() < 1e-6 && north[0] > 0.0, "{up:?}: {north:?}");
            let q = Quaternion::at_rest(up, None).unwrap();
            near(q.to_earth(up), [0.0, 0.0, 1.0]);
        }
    }

    #[test]
    fn nothing_has_no_direction() {
        assert_eq!(unit([0.0; 3]), None);
        assert_eq!(unit([f32::MAX; 3]), None);
        assert_eq!(unit([f32::NAN, 0.0, 1.0]), None);
        assert_eq!(Quaternion::new(0.0, [0.0; 3]), None);
        assert_eq!(unit([0.0, -2.0, 0.0]), Some([0.0, -1.0, 0.0]));
    }
}
