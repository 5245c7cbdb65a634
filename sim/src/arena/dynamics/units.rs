//! Places, angles and lengths of a scene as the solver has them, and back.
//!
//! Owns the conversions with their order of rounding, which decides the last bits of a run. A metre of the solver is
//! 28.57 px: ten times a metre of the field, as in the original. Knows no bodies.

use std::f64::consts::PI;

use box2d_rust::math_functions::{Pos, Rot, Vec2, make_rot, rot_get_angle};

use crate::geometry::{Point, point};

/// Pixels in a hundredth of the solver's metre: a tenth, rounded to 32 bits, of a centimetre of the field.
const PX_PER_CM: f64 = 0.1_f32 as f64 * (16.0 / 5.6);

/// A length.
pub(super) fn metres(px: f64) -> f32 {
    (px / PX_PER_CM) as f32 / 100.0
}

/// An area: a length, converted twice.
pub(super) fn square_metres(px2: f64) -> f32 {
    metres(f64::from(metres(px2)))
}

/// A place or a shift; y goes up there.
pub(super) fn vector(at: Point) -> Vec2 {
    let one = |px: f64| (f64::from(px as f32) / PX_PER_CM) as f32 * 0.01;
    Vec2::new(one(at.x), one(-at.y))
}

/// A place or a shift back in the scene, in the 32 bits that it has there.
pub(super) fn pixels(at: Vec2) -> (f32, f32) {
    let one = |metres: f32| 100.0 * metres * PX_PER_CM as f32;
    (one(at.x), -one(at.y))
}

/// A place back in the scene.
pub(super) fn scene(at: Pos) -> Point {
    let (x, y) = pixels(at);
    point(f64::from(x), f64::from(y))
}

/// Degrees clockwise as an angle of the solver.
pub(super) fn radians(degrees: f64) -> f32 {
    (-degrees * PI / 180.0) as f32
}

/// An angle of the solver as degrees clockwise.
pub(super) fn degrees(radians: f32) -> f64 {
    -f64::from(radians) / PI * 180.0
}

/// Degrees clockwise as a rotation.
pub(super) fn rotation(degrees: f64) -> Rot {
    make_rot(radians(degrees))
}

/// The degrees clockwise by which an angle has changed; the change is at most half a turn.
pub(super) fn turn(from: Rot, to: Rot) -> f64 {
    let mut change = f64::from(rot_get_angle(to)) - f64::from(rot_get_angle(from));
    if change > PI {
        change -= 2.0 * PI;
    } else if change < -PI {
        change += 2.0 * PI;
    }
    degrees(change as f32)
}
