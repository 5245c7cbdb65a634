//! Geometry of the plane as collisions need it: segments, how far they are apart, what lies inside a polygon.
//!
//! Owns the formulas. Knows no obstacle and no robot. Nothing here calls the C library, so that every machine finds the
//! same numbers.

/// A point, x and y.
pub type Point = [f64; 2];

/// Sine and cosine of an angle from -pi to pi, to the last few bits, the same on every processor.
pub fn sine_and_cosine(angle: f64) -> (f64, f64) {
    use std::f64::consts::FRAC_PI_2;
    let quarter = (angle / FRAC_PI_2).round();
    let rest = angle - quarter * FRAC_PI_2;
    let square = rest * rest;
    // Taylor's series; beyond pi/4 nothing is asked, where the first term left out is below 1e-17.
    let series = |first: f64| {
        let mut sum = 0.0;
        let mut of = first + 16.0;
        while of > first {
            sum = (1.0 + sum) * (-square / (of * (of - 1.0)));
            of -= 2.0;
        }
        1.0 + sum
    };
    let (sine, cosine) = (rest * series(1.0), series(0.0));
    match quarter.rem_euclid(4.0) {
        turn if turn < 0.5 => (sine, cosine),
        turn if turn < 1.5 => (cosine, -sine),
        turn if turn < 2.5 => (-sine, -cosine),
        _ => (-cosine, sine),
    }
}

/// The same angle in (-pi, pi].
pub fn wrapped(angle: f64) -> f64 {
    use std::f64::consts::{PI, TAU};
    if angle > -PI && angle <= PI {
        return angle;
    }
    let inside = angle - TAU * ((angle - PI) / TAU).ceil();
    // Rounding may leave it just outside.
    if inside <= -PI { PI } else { inside.min(PI) }
}

pub(super) fn minus(a: Point, b: Point) -> Point {
    [a[0] - b[0], a[1] - b[1]]
}

pub(super) fn cross(a: Point, b: Point) -> f64 {
    a[0] * b[1] - a[1] * b[0]
}

fn dot(a: Point, b: Point) -> f64 {
    a[0] * b[0] + a[1] * b[1]
}

/// Squared distance of a point to a segment.
pub(super) fn to_segment(at: Point, from: Point, to: Point) -> f64 {
    let along = minus(to, from);
    let length = dot(along, along);
    let share = if length > 0.0 {
        (dot(minus(at, from), along) / length).clamp(0.0, 1.0)
    } else {
        0.0
    };
    let foot = [from[0] + share * along[0], from[1] + share * along[1]];
    let away = minus(at, foot);
    dot(away, away)
}

/// Squared distance of two segments; 0 if they cross.
pub(super) fn between_segments(a: [Point; 2], b: [Point; 2]) -> f64 {
    let side = |of: [Point; 2], at: Point| cross(minus(of[1], of[0]), minus(at, of[0]));
    let (a0, a1) = (side(b, a[0]), side(b, a[1]));
    let (b0, b1) = (side(a, b[0]), side(a, b[1]));
    if ((a0 < 0.0 && a1 > 0.0) || (a0 > 0.0 && a1 < 0.0))
        && ((b0 < 0.0 && b1 > 0.0) || (b0 > 0.0 && b1 < 0.0))
    {
        return 0.0;
    }
    let of_a = to_segment(a[0], b[0], b[1]).min(to_segment(a[1], b[0], b[1]));
    let of_b = to_segment(b[0], a[0], a[1]).min(to_segment(b[1], a[0], a[1]));
    of_a.min(of_b)
}

/// Whether a point is inside a polygon by the even-odd rule.
pub(super) fn is_inside(at: Point, corners: &[Point]) -> bool {
    let mut inside = false;
    let Some(mut before) = corners.last().copied() else {
        return false;
    };
    for &corner in corners {
        if (before[1] > at[1]) != (corner[1] > at[1]) {
            let way = cross(minus(corner, before), minus(at, before));
            if (way > 0.0) == (corner[1] > before[1]) {
                inside = !inside;
            }
        }
        before = corner;
    }
    inside
}

/// Whether a point is inside a convex polygon whose corners go round counter-clockwise, or on its border.
pub(super) fn is_inside_convex(at: Point, corners: &[Point]) -> bool {
    let Some(mut before) = corners.last().copied() else {
        return false;
    };
    corners.iter().all(|&corner| {
        let left = cross(minus(corner, before), minus(at, before)) >= 0.0;
        before = corner;
        left
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::PI;

    #[test]
    fn sines_are_those_of_the_library_to_the_last_bits() {
        for step in -1000..=1000 {
            let angle = f64::from(step) / 1000.0 * PI;
            let (sine, cosine) = sine_and_cosine(angle);
            assert!((sine - angle.sin()).abs() < 5e-16, "{angle} {sine}");
            assert!((cosine - angle.cos()).abs() < 5e-16, "{angle} {cosine}");
        }
    }

    #[test]
    fn angles_wrap_to_half_a_turn_each_way() {
        assert_eq!(wrapped(PI), PI);
        assert_eq!(wrapped(-PI), PI);
        assert!((wrapped(7.0) - (7.0 - 2.0 * PI)).abs() < 1e-15);
        assert!((wrapped(-4.0) - (2.0 * PI - 4.0)).abs() < 1e-15);
        for angle in [1e17, -1e300, 3.0 * PI, -3.0 * PI] {
            let inside = wrapped(angle);
            assert!(inside > -4.0 && inside <= PI, "{angle}: {inside}");
        }
    }

    #[test]
    fn distances_by_hand() {
        assert_eq!(to_segment([1.0, 2.0], [0.0, 0.0], [4.0, 0.0]), 4.0);
        assert_eq!(to_segment([-3.0, 4.0], [0.0, 0.0], [4.0, 0.0]), 25.0);
        assert_eq!(to_segment([3.0, 4.0], [0.0, 0.0], [0.0, 0.0]), 25.0);
        let bar = [[0.0, 0.0], [4.0, 0.0]];
        assert_eq!(between_segments(bar, [[1.0, -1.0], [1.0, 1.0]]), 0.0);
        assert_eq!(between_segments(bar, [[1.0, 1.0], [1.0, 3.0]]), 1.0);
        assert_eq!(between_segments(bar, [[6.0, 0.0], [9.0, 0.0]]), 4.0);
        assert_eq!(between_segments(bar, [[0.0, 1.0], [4.0, 2.0]]), 1.0);
        let bay = [
            [0.0, 0.0],
            [4.0, 0.0],
            [4.0, 3.0],
            [3.0, 3.0],
            [3.0, 1.0],
            [1.0, 1.0],
            [1.0, 3.0],
            [0.0, 3.0],
        ];
        assert!(is_inside([0.5, 2.0], &bay));
        assert!(!is_inside([2.0, 2.0], &bay));
        assert!(!is_inside([0.5, 2.0], &[]));
        assert!(is_inside_convex(
            [1.0, 0.5],
            &[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]
        ));
        assert!(!is_inside_convex(
            [1.5, 1.5],
            &[[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]]
        ));
    }
}
