//! Sine, cosine and arc tangent from nothing but + - * / and sqrt, whose results IEEE 754 fixes to the last bit.
//!
//! The functions of the C library differ in their last bits from one processor and one version to the next, so neither
//! golden vectors nor plots would be the same everywhere. These do not: Taylor series after reduction to a small argument,
//! which leaves errors below 1e-15 for sine and cosine and 1e-12 for the arc tangent (both tested against the C library).
//! Cost: about 20 multiplications and additions each.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI, TAU};

/// tan(pi / 8), up to which the series of the arc tangent is used.
const TAN_PI_8: f64 = std::f64::consts::SQRT_2 - 1.0;
/// 1, 1/3, 1/5, ...: the series of the arc tangent; TAN_PI_8^(2 * 15 + 1) / 31, the first that is missing, is 4e-14.
/// As constants, because a division costs several times as much as a multiplication.
const ATAN: [f64; 15] = {
    let mut terms = [1.0; 15];
    let mut n = 1;
    while n < terms.len() {
        terms[n] = 1.0 / (2 * n + 1) as f64;
        n += 1;
    }
    terms
};
/// 1 / (n (n + 1)) for n = 1 to 15: from one term of the series of cosine (odd n) and sine (even n) to the next.
const STEPS: [f64; 15] = {
    let mut steps = [1.0; 15];
    let mut n = 1;
    while n <= steps.len() {
        steps[n - 1] = 1.0 / (n * (n + 1)) as f64;
        n += 1;
    }
    steps
};

/// Sine and cosine of an angle in radians, which is finite.
pub fn sin_cos(radians: f64) -> (f64, f64) {
    // The remainder is exact, but TAU is not: 2.5e-16 for each turn.
    let turned = radians % TAU;
    let quadrant = (turned / FRAC_PI_2 + 0.5).floor();
    let r = turned - quadrant * FRAC_PI_2;
    let squared = r * r;
    // Horner's scheme over 1 - x^2/(2*3) (1 - x^2/(4*5) (...)).
    let (mut sin, mut cos) = (1.0, 1.0);
    for pair in STEPS[1..].as_chunks::<2>().0.iter().rev() {
        sin = 1.0 - squared * pair[0] * sin;
    }
    for step in STEPS.iter().step_by(2).rev() {
        cos = 1.0 - squared * step * cos;
    }
    let sin = r * sin;
    match (quadrant as i32).rem_euclid(4) {
        0 => (sin, cos),
        1 => (cos, -sin),
        2 => (-sin, -cos),
        _ => (-cos, sin),
    }
}

/// The angle of the point (x, y) in radians, from -pi to pi; 0 for the origin. Both are finite.
pub fn atan2(y: f64, x: f64) -> f64 {
    let (ax, ay) = (x.abs(), y.abs());
    if ax == 0.0 && ay == 0.0 {
        return 0.0;
    }
    // In the first octant, so that the quotient is at most 1.
    let angle = if ay <= ax {
        atan_to_one(ay / ax)
    } else {
        FRAC_PI_2 - atan_to_one(ax / ay)
    };
    let angle = if x < 0.0 { PI - angle } else { angle };
    if y < 0.0 { -angle } else { angle }
}

/// The arc sine of a number, which is moved to the range from -1 to 1.
pub fn asin(sine: f64) -> f64 {
    let sine = sine.clamp(-1.0, 1.0);
    atan2(sine, (1.0 - sine * sine).sqrt())
}

/// The arc tangent of a number from 0 to 1.
fn atan_to_one(tangent: f64) -> f64 {
    if tangent > TAN_PI_8 {
        return FRAC_PI_4 + atan_series((tangent - 1.0) / (tangent + 1.0));
    }
    atan_series(tangent)
}

fn atan_series(x: f64) -> f64 {
    let squared = x * x;
    let mut sum = 0.0;
    for term in ATAN.iter().rev() {
        sum = term - squared * sum;
    }
    x * sum
}

/// An angle moved by whole turns of `turn` into the range from -turn/2 to below turn/2.
pub fn wrapped(angle: f64, turn: f64) -> f64 {
    angle - turn * (angle / turn + 0.5).floor()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn they_agree_with_the_c_library() {
        for step in -20_000..20_000 {
            let radians = f64::from(step) * 1.234_567e-3;
            let (sin, cos) = sin_cos(radians);
            assert!((sin - radians.sin()).abs() < 3e-15, "sin {radians}: {sin}");
            assert!((cos - radians.cos()).abs() < 3e-15, "cos {radians}: {cos}");
            let (y, x) = (sin * 3.0, cos * 3.0);
            assert!((atan2(y, x) - y.atan2(x)).abs() < 1e-12, "atan2 {y} {x}");
            assert!((asin(sin) - sin.asin()).abs() < 1e-7, "asin {sin}");
        }
    }

    #[test]
    fn known_angles_are_exact_or_nearly() {
        assert_eq!(sin_cos(0.0), (0.0, 1.0));
        assert_eq!(sin_cos(FRAC_PI_2), (1.0, -0.0));
        assert_eq!(atan2(0.0, 0.0), 0.0);
        assert_eq!(atan2(0.0, -1.0), PI);
        assert_eq!(atan2(-1.0, 0.0), -FRAC_PI_2);
        assert!((atan2(1.0, 1.0) - FRAC_PI_4).abs() < 1e-15);
        assert_eq!(asin(2.0), FRAC_PI_2);
        // Ten thousand turns further.
        let (sin, cos) = sin_cos(1e4 * TAU + 1.0);
        assert!((sin - 1.0_f64.sin()).abs() < 1e-11 && (cos - 1.0_f64.cos()).abs() < 1e-11);
    }

    #[test]
    fn extremes_stay_finite() {
        for radians in [f64::MAX, f64::MIN, 1e300, f64::MIN_POSITIVE] {
            let (sin, cos) = sin_cos(radians);
            assert!(sin.abs() <= 1.0 && cos.abs() <= 1.0, "{radians}");
        }
        assert_eq!(atan2(f64::MAX, f64::MIN_POSITIVE), FRAC_PI_2);
        assert_eq!(
            (
                wrapped(190.0, 360.0),
                wrapped(-180.0, 360.0),
                wrapped(180.0, 360.0)
            ),
            (-170.0, -180.0, -180.0)
        );
    }
}
