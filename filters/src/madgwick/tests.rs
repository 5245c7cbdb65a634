//! Tests of Madgwick's filter, and with the same motions of Mahony's.

use super::*;
use crate::fused::Fused;
use crate::fused::tests::{open, step};
use crate::inertial::tests::{degrees_between, measured};
use crate::mahony::Mahony;

const PERIOD: [(&str, f64); 1] = [("period_ms", 10.0)];

fn quaternion(parts: [f32; 4]) -> Quaternion {
    Quaternion {
        w: parts[0],
        v: [parts[1], parts[2], parts[3]],
    }
}

/// Where a sensor is after turning from `begin` at constant rates: the exact exponential.
fn turned(begin: Quaternion, rates: Vector, seconds: f32) -> Quaternion {
    let speed = dot(rates, rates).sqrt();
    let half = speed * seconds / 2.0;
    let axis = rates.map(|rate| rate / speed * half.sin());
    begin
        .after(Quaternion {
            w: half.cos(),
            v: axis,
        })
        .unwrap()
}

#[test]
fn a_sensor_at_rest_is_exactly_where_its_accelerations_say() {
    // By hand: flat is no rotation; up along -y, the left side down, is a roll of -90 degrees: (1, -1, 0, 0) / sqrt 2.
    let mut filter = open::<Madgwick>((6, 7), &PERIOD).unwrap();
    for _ in 0..3 {
        let result = step(&mut filter, &[0, 0, 0, 0, 0, 4096], None);
        assert_eq!(result, Ok([1.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]));
    }
    let mut filter = open::<Madgwick>((6, 4), &PERIOD).unwrap();
    let half = 1.0 / 2.0_f32.sqrt();
    assert_eq!(
        step(&mut filter, &[0, 0, 0, 0, -4096, 0], None),
        Ok([half, -half, 0.0, 0.0])
    );
}

#[test]
fn the_gradient_is_that_of_the_report() {
    // Equation 25: J' f with J = [-2 q2, 2 q3, -2 q0, 2 q1; 2 q1, 2 q0, 2 q3, 2 q2; 0, -4 q1, -4 q2, 0].
    let q = Quaternion::new(0.3, [0.5, -0.4, 0.7]).unwrap();
    let (q0, [q1, q2, q3]) = (q.w, q.v);
    let a = [0.6, 0.0, 0.8];
    let f = [
        2.0 * (q1 * q3 - q0 * q2) - a[0],
        2.0 * (q0 * q1 + q2 * q3) - a[1],
        2.0 * (0.5 - q1 * q1 - q2 * q2) - a[2],
    ];
    let expected = [
        -2.0 * q2 * f[0] + 2.0 * q1 * f[1],
        2.0 * q3 * f[0] + 2.0 * q0 * f[1] - 4.0 * q1 * f[2],
        -2.0 * q0 * f[0] + 2.0 * q3 * f[1] - 4.0 * q2 * f[2],
        2.0 * q1 * f[0] + 2.0 * q2 * f[1],
    ];
    let mut gradient = (0.0, [0.0; 3]);
    add_gradient(&mut gradient, q, [0.0, 0.0, 1.0], a);
    let found = [gradient.0, gradient.1[0], gradient.1[1], gradient.1[2]];
    assert!(
        found
            .iter()
            .zip(expected)
            .all(|(a, b)| (a - b).abs() < 1e-6),
        "{found:?} {expected:?}"
    );
}

#[test]
fn the_gradient_of_a_field_is_that_of_the_report() {
    // Equation 32 for b = [bx 0 bz], as a difference quotient of the sum of squares.
    let (d, m) = ([0.6, 0.0, -0.8], [0.48, 0.64, -0.6]);
    let q = Quaternion::new(0.9, [0.1, -0.3, 0.2]).unwrap();
    let squares = |w: f64, v: [f64; 3]| {
        // The form of the report, quadratic in q: with 1 - 2 (yy + zz) and so on.
        let [x, y, z] = v;
        let [dx, dz] = [f64::from(d[0]), f64::from(d[2])];
        let p = [
            2.0 * dx * (0.5 - y * y - z * z) + 2.0 * dz * (x * z - w * y) - f64::from(m[0]),
            2.0 * dx * (x * y - w * z) + 2.0 * dz * (w * x + y * z) - f64::from(m[1]),
            2.0 * dx * (w * y + x * z) + 2.0 * dz * (0.5 - x * x - y * y) - f64::from(m[2]),
        ];
        p.iter().map(|part| part * part).sum::<f64>() / 2.0
    };
    let (w, v) = (f64::from(q.w), q.v.map(f64::from));
    let h = 1e-5;
    let slope = |lane: usize| {
        let moved = |by: f64| {
            let mut parts = [w, v[0], v[1], v[2]];
            parts[lane] += by;
            squares(parts[0], [parts[1], parts[2], parts[3]])
        };
        (moved(h) - moved(-h)) / (2.0 * h)
    };
    let mut gradient = (0.0, [0.0; 3]);
    add_gradient(&mut gradient, q, d, m);
    let found = [gradient.0, gradient.1[0], gradient.1[1], gradient.1[2]];
    for (lane, found) in found.into_iter().enumerate() {
        assert!(
            (f64::from(found) - slope(lane)).abs() < 1e-5,
            "{lane}: {found} {}",
            slope(lane)
        );
    }
}

/// Tilts the filter's idea of the world by a wrong start, then lets it see the truth at rest; degrees that remain.
fn remaining<F: Fusion<Input = i32, Output = f32>>(
    filter: &mut Fused<F>,
    inputs: usize,
    samples: u32,
) -> f64 {
    let wrong = Quaternion::new(0.8, [0.3, -0.4, 0.3]).unwrap();
    let truth = Quaternion::new(0.9, [-0.2, 0.1, 0.4]).unwrap();
    let mut parts = step::<F, 4>(filter, &measured(wrong, [0.0; 3])[..inputs], None).unwrap();
    for _ in 0..samples {
        parts = step(filter, &measured(truth, [0.0; 3])[..inputs], None).unwrap();
    }
    let found = quaternion(parts);
    if inputs == 9 {
        degrees_between(found, truth)
    } else {
        // Only up can be known.
        let up = found.to_sensor([0.0, 0.0, 1.0]);
        f64::from(
            dot(up, truth.to_sensor([0.0, 0.0, 1.0]))
                .min(1.0)
                .acos()
                .to_degrees(),
        )
    }
}

#[test]
fn a_wrong_orientation_is_corrected() {
    for (inputs, most) in [(6, 0.3), (9, 0.3)] {
        let mut madgwick = open::<Madgwick>((inputs, 4), &PERIOD).unwrap();
        let error = remaining(&mut madgwick, inputs, 3000);
        assert!(error < most, "madgwick, {inputs} inputs: {error}");
        let mut mahony = open::<Mahony>((inputs, 4), &PERIOD).unwrap();
        let error = remaining(&mut mahony, inputs, 6000);
        assert!(error < most, "mahony, {inputs} inputs: {error}");
    }
}

/// The greatest error in degrees while turning at constant rates, with rates that are wrong by `bias` rad/s; the second
/// half of the time counts.
fn error_while_turning<F: Fusion<Input = i32, Output = f32>>(
    filter: &mut Fused<F>,
    bias: f32,
) -> f64 {
    let begin = Quaternion::new(0.9, [0.2, 0.1, -0.3]).unwrap();
    let rates = [0.5, -0.3, 0.8];
    let mut greatest: f64 = 0.0;
    for n in 0..4000_u16 {
        let truth = turned(begin, rates, f32::from(n) * 0.01);
        let values = measured(truth, rates.map(|rate| rate + bias));
        let parts = step::<F, 4>(filter, &values, None).unwrap();
        if n > 2000 {
            greatest = greatest.max(degrees_between(quaternion(parts), truth));
        }
    }
    greatest
}

#[test]
fn a_turning_sensor_is_followed() {
    // Both compare what is measured with where the sensor was a sample ago: 1 rad/s * 10 ms = 0.57 degrees.
    let error = error_while_turning(&mut open::<Madgwick>((9, 4), &PERIOD).unwrap(), 0.0);
    assert!(error < 0.8, "madgwick: {error}");
    let error = error_while_turning(&mut open::<Mahony>((9, 4), &PERIOD).unwrap(), 0.0);
    assert!(error < 0.8, "mahony: {error}");
}

#[test]
fn a_bias_of_the_gyroscope_is_borne_and_mahony_learns_it() {
    let bias = 0.05;
    let error = error_while_turning(&mut open::<Madgwick>((9, 4), &PERIOD).unwrap(), bias);
    assert!(error < 4.0, "madgwick: {error}");
    let plain = error_while_turning(&mut open::<Mahony>((9, 4), &PERIOD).unwrap(), bias);
    let params = [("period_ms", 10.0), ("ki", 0.3)];
    let learned = error_while_turning(&mut open::<Mahony>((9, 4), &params).unwrap(), bias);
    assert!(
        learned < 1.5 && plain > 2.0 * learned,
        "mahony: {plain} {learned}"
    );
}

#[test]
fn a_dead_accelerometer_is_a_fault_and_free_fall_is_none() {
    let mut filter = open::<Madgwick>((6, 4), &PERIOD).unwrap();
    let fault = step::<_, 4>(&mut filter, &[0, 0, 0, 0, 0, 0], None).unwrap_err();
    assert_eq!(fault, "madgwick: the accelerometer gives only zeros");
    assert!(step::<_, 4>(&mut filter, &[0, 0, 0, 0, 0, 1], None).is_ok());
    for _ in 0..100 {
        assert!(step::<_, 4>(&mut filter, &[9000, 0, 0, 0, 0, 0], None).is_ok());
    }
    let fault = step::<_, 4>(&mut filter, &[9000, 0, 0, 0, 0, 0], None).unwrap_err();
    assert_eq!(
        fault,
        "madgwick: the accelerometer has given only zeros for 1000000 us"
    );
}

#[test]
fn extremes_give_an_orientation_or_a_fault() {
    let extremes = [i32::MIN, i32::MAX, 0, 1, -1, 100_000];
    let mut madgwick = open::<Madgwick>((10, 7), &[("beta", 10.0)]).unwrap();
    let mut mahony = open::<Mahony>((10, 7), &[("kp", 100.0), ("ki", 100.0)]).unwrap();
    for n in 0..2000_u32 {
        let values: [i32; 9] = std::array::from_fn(|lane| {
            extremes[(n as usize * 7 + lane * 5 + (n as usize >> lane)) % extremes.len()]
        });
        for result in [
            step::<_, 7>(&mut madgwick, &values, Some(n * 900_000)),
            step::<_, 7>(&mut mahony, &values, Some(n * 900_000)),
        ] {
            let Ok(parts) = result else { continue };
            let length = parts[..4].iter().map(|part| part * part).sum::<f32>();
            assert!((length - 1.0).abs() < 1e-5, "{parts:?}");
            assert!(parts.iter().all(|part| part.is_finite()), "{parts:?}");
        }
    }
}
