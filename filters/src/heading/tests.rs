//! Tests of the heading.

use super::*;
use crate::fused::tests::{open, step};
use crate::inertial::tests::measured;
use crate::vector::Quaternion;

const PERIOD: [(&str, f64); 1] = [("period_ms", 10.0)];

#[test]
fn a_level_robot_turns_by_rate_times_time() {
    // By hand: 10 deg/s for 10 ms are 100 mdeg; 10.001 deg/s are 100.01, and a hundred of them 10001.
    let mut heading = open::<Heading>((6, 3), &PERIOD).unwrap();
    assert_eq!(
        step(&mut heading, &[0, 0, 10_000, 0, 0, 4096], None),
        Ok([0, 0, 0])
    );
    assert_eq!(
        step(&mut heading, &[0, 0, 10_000, 0, 0, 4096], None),
        Ok([100, 10_000, 0])
    );
    assert_eq!(
        step(&mut heading, &[0, 0, -10_000, 0, 0, 4096], None),
        Ok([0, -10_000, 0])
    );
    let mut heading = open::<Heading>((6, 1), &PERIOD).unwrap();
    let last = (0..=100)
        .map(|_| step::<_, 1>(&mut heading, &[0, 0, 10_001, 0, 0, 1], None))
        .last();
    assert_eq!(last, Some(Ok([10_001])));
}

#[test]
fn a_sensor_that_stands_on_edge_has_another_vertical_axis() {
    let mut heading = open::<Heading>((6, 3), &PERIOD).unwrap();
    assert_eq!(
        step(&mut heading, &[-20_000, 5, 7, -4096, 0, 0], None),
        Ok([0, 0, 90_000])
    );
    let [mdeg, mdps, tilt] = step(&mut heading, &[-20_000, 0, 0, -4096, 0, 0], None).unwrap();
    assert_eq!((mdeg, mdps, tilt), (200, 20_000, 90_000));
}

#[test]
fn after_half_a_turn_it_goes_on_from_the_other_side() {
    let turn = |params: &[(&str, f64)]| {
        let mut heading = open::<Heading>((6, 1), params).unwrap();
        let outputs =
            (0..6).map(|_| step::<_, 1>(&mut heading, &[0, 0, 90_000, 0, 0, 1], None).unwrap()[0]);
        outputs.collect::<Vec<_>>()
    };
    let period = ("period_ms", 1000.0);
    assert_eq!(turn(&[period]), [0, 90_000, -180_000, -90_000, 0, 90_000]);
    assert_eq!(
        turn(&[period, ("wrap", 0.0)]),
        [0, 90_000, 180_000, 270_000, 360_000, 450_000]
    );
}

/// A robot that turns about the vertical at 0.5 rad/s for 20 s while it also rolls and pitches like a boat.
fn drive(bias_mdps: i32, params: &[(&str, f64)]) -> f64 {
    let mut heading = open::<Heading>((6, 1), params).unwrap();
    let mut last = 0;
    let orientation = |t: f64| {
        let half = |angle: f64| ((angle / 2.0).cos() as f32, (angle / 2.0).sin() as f32);
        let (cw, sw) = half(0.5 * t);
        let (cx, sx) = half(0.25 * (1.3 * t).sin());
        let (cy, sy) = half(0.2 * (0.9 * t).sin());
        let yaw = Quaternion {
            w: cw,
            v: [0.0, 0.0, sw],
        };
        let roll = Quaternion {
            w: cx,
            v: [sx, 0.0, 0.0],
        };
        let pitch = Quaternion {
            w: cy,
            v: [0.0, sy, 0.0],
        };
        yaw.after(pitch).unwrap().after(roll).unwrap()
    };
    for n in 0..2200 {
        // 2 s at rest, then the motion; the rates are those between two samples.
        let t = (f64::from(n) * 0.01 - 2.0).max(0.0);
        let before = (f64::from(n - 1) * 0.01 - 2.0).max(0.0);
        let q = orientation(t);
        let old = orientation(before);
        let step_q = Quaternion {
            w: old.w,
            v: old.v.map(|part| -part),
        }
        .after(q)
        .unwrap();
        let rates = step_q.v.map(|part| 2.0 * part / 0.01);
        let mut values = measured(q, rates);
        for rate in &mut values[..3] {
            *rate += bias_mdps;
        }
        if let Ok([mdeg]) = step::<_, 1>(&mut heading, &values[..6], None) {
            last = mdeg;
        }
    }
    let truth = (0.5_f64 * 19.99).to_degrees();
    crate::trig::wrapped(f64::from(last) / 1000.0 - truth, 360.0).abs()
}

#[test]
fn a_rocking_robot_keeps_its_heading() {
    let error = drive(0, &PERIOD);
    assert!(error < 2.0, "{error}");
}

#[test]
fn a_bias_that_was_measured_at_rest_does_no_harm() {
    let params = [("period_ms", 10.0), ("bias_ms", 1500.0)];
    let error = drive(3000, &params);
    assert!(error < 2.0, "{error}");
    let error = drive(3000, &PERIOD);
    assert!(error > 30.0, "without it the error is large: {error}");
}

#[test]
fn the_bias_is_not_measured_while_the_robot_moves() {
    let params = [("period_ms", 10.0), ("bias_ms", 100.0)];
    let mut heading = open::<Heading>((6, 1), &params).unwrap();
    let mut first_output = 0;
    for n in 0..100 {
        // Until the 50th sample somebody carries the robot.
        let rate = if n < 50 { n % 2 * 5000 } else { 700 };
        if let Ok([mdeg]) = step::<_, 1>(&mut heading, &[0, 0, rate, 0, 0, 1], None) {
            assert_eq!(mdeg, 0, "the bias of 700 is gone");
            first_output = if first_output == 0 { n } else { first_output };
        }
    }
    assert!((60..64).contains(&first_output), "{first_output}");
}

#[test]
fn extremes_and_dead_sensors() {
    let mut heading = open::<Heading>((6, 3), &PERIOD).unwrap();
    assert_eq!(
        step::<_, 3>(&mut heading, &[0; 6], None).unwrap_err(),
        "heading: the accelerometer gives only zeros"
    );
    for values in [
        [i32::MAX; 6],
        [i32::MIN; 6],
        [i32::MIN, i32::MAX, 0, i32::MAX, 0, i32::MIN],
    ] {
        let results = step::<_, 3>(&mut heading, &values, None).unwrap();
        assert!(
            results[0].abs() <= 180_000 && results[2].abs() <= 180_000,
            "{results:?}"
        );
    }
    // Without a wrap the range of the result ends somewhere, and that is said.
    let params = [("period_ms", 1000.0), ("wrap", 0.0)];
    let mut heading = open::<Heading>((6, 1), &params).unwrap();
    let fast = [0, 0, i32::MAX, 0, 0, 1];
    let mut results = (0..3).map(|_| step::<_, 1>(&mut heading, &fast, None));
    assert_eq!(results.next(), Some(Ok([0])));
    assert!(results.any(|result| result.is_err_and(|text| text.contains("has left its range"))));
}
