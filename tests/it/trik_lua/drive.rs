//! Speed that is held, heading and place: numbers that were worked out by hand.

use super::run::{Robot, robot};

const CAR: &str =
    "{ port = 'M3', encoder = 'E3' }, { port = 'M4', encoder = 'E4', speed_max = 600 },
    { port = 'odometry', left = 'E3', right = 'E4', wheel_diameter_mm = 56, track_mm = 155 }";

fn numbers(values: &[i32]) -> Vec<u8> {
    let bytes = values.iter().flat_map(|value| value.to_le_bytes());
    bytes.collect()
}

fn power(percent: i32) -> Result<Vec<u8>, String> {
    Ok(numbers(&[percent]))
}

/// E3 counts backwards: 157 ticks less are 100 degrees more. In 20 ms 31 ticks are 987 deg/s, and with a time constant
/// of 60 ms a quarter of that is seen at once, then a quarter of what is missing.
#[test]
fn the_speed_is_that_of_the_encoder_through_a_low_pass() {
    let mut robot = robot(CAR);
    let mut speed = |ticks| robot.read("motors/M3/speed", &numbers(&[ticks, 20_000]));
    assert_eq!(speed(0), Ok("0".into()));
    assert_eq!(speed(-31), Ok("247".into()));
    assert_eq!(speed(-62), Ok("432".into()));
    // The counter was set to 0 and has counted 31 since.
    speed(-3000).unwrap();
    let before: i32 = speed(-3031).unwrap().parse().unwrap();
    let after: i32 = speed(-31).unwrap().parse().unwrap();
    assert!((after - before).abs() < before, "{before}, then {after}");
    // The counter of 32 bits ended and began again.
    let mut robot = Robot::new(&format!(
        "local trik = include 'trik.lua'\ntrikfs = trik.robot {{ {CAR} }}"
    ));
    let mut speed = |ticks| robot.read("motors/M4/speed", &numbers(&[ticks, 20_000]));
    assert_eq!(speed(i32::MAX - 10), Ok("0".into()));
    assert_eq!(speed(i32::MIN + 20), Ok("247".into()));
    let jumped = speed(1_000_000).unwrap_err();
    assert!(jumped.starts_with("ENODEV: the encoder jumped"), "{jumped}");
    assert_eq!(speed(1_000_000), Ok("0".into()));
}

/// 300 of 1200 deg/s are 25 percent, and 5 more for each 100 that are missing; after 20 ms in which 6 degrees were
/// ordered and 2 were made, 0.2 for each of the 4.
#[test]
fn the_power_is_what_the_law_says() {
    let mut robot = robot(CAR);
    let mut step = |ordered, measured| robot.step("motors/M3/speed", ordered, measured, 20_000);
    assert_eq!(step(300, 0), power(25 + 15));
    assert_eq!(step(300, 100), power(36), "25 + 10 + 0.8");
    assert_eq!(step(-1200, 0), power(-100));
    assert_eq!(step(0, 300), power(0));
    for wrong in [1201, -1201, i32::MAX, i32::MIN] {
        let reason = format!("ERANGE: speed is -1200 to 1200, not {wrong}");
        assert_eq!(step(wrong, 0), Err(reason));
    }
    let reason = Err("ERANGE: speed is -600 to 600, not 601".to_owned());
    assert_eq!(robot.step("motors/M4/speed", 601, 0, 20_000), reason);
    let mut step = || robot.step("motors/M4/speed", 300, 300, 20_000);
    step().unwrap();
    assert_eq!(step(), power(50), "half of 600, and nothing is missing");
}

/// The power of one step after another until the law fails: how many steps, and why.
fn until_it_fails(ordered: i32, measured: impl Fn(u32) -> i32) -> (u32, String) {
    let mut robot = robot(CAR);
    for step in 0..2000 {
        match robot.step("motors/M3/speed", ordered, measured(step), 20_000) {
            Ok(_) => {}
            Err(reason) => return (step, reason),
        }
    }
    (2000, String::new())
}

#[test]
fn a_motor_that_does_not_do_what_it_should_fails_the_law() {
    // 6 degrees in each step: 180 are more than 30 steps.
    let (steps, reason) = until_it_fails(300, |_| 0);
    assert!(
        reason.starts_with("ENODEV: the encoder stands still"),
        "{reason}"
    );
    assert_eq!(steps, 30);
    // Turning against more than half of the power for more than a fifth of a second.
    let (steps, reason) = until_it_fails(300, |_| -500);
    assert!(
        reason.starts_with("ENODEV: the encoder counts against"),
        "{reason}"
    );
    assert!((10..15).contains(&steps), "{steps}");
    // Very slow, and slower than it should be, is no failure; nor is a turn that takes a moment.
    assert_eq!(until_it_fails(10, |_| 9).0, 2000);
    assert_eq!(until_it_fails(1200, |_| 700).0, 2000);
    assert_eq!(
        until_it_fails(1200, |step| (25 * step as i32 - 500).min(1200)).0,
        2000
    );
    assert_eq!(until_it_fails(0, |_| 0).0, 2000);
}

/// With wheels of 56 mm one turn is 175.9 mm; 249 degrees of each wheel against the other are 89.96 degrees.
#[test]
fn the_place_follows_the_wheels() {
    let mut robot = robot(CAR);
    let mut place = |left, right| robot.read("odometry", &numbers(&[left, right]));
    assert_eq!(place(0, 0), Ok("0 0 0".into()));
    assert_eq!(place(-249, 249), Ok("0 0 89.96".into()));
    assert_eq!(place(111, 609), Ok("0.1 175.9 89.96".into()));
    // One encoder was set to 0, then the other: the robot has not moved.
    assert_eq!(place(0, 609), Ok("0.1 175.9 89.96".into()));
    assert_eq!(place(0, 0), Ok("0.1 175.9 89.96".into()));
    let lost = place(0, 4000).unwrap_err();
    assert!(lost.contains("begins anew at 0 0"), "{lost}");
    assert_eq!(place(0, 4000), Ok("0 0 0".into()));
}

#[test]
fn the_heading_counts_to_the_left_in_degrees() {
    let mut robot = robot("");
    for (mdeg, shown) in [(0, "0"), (12_345, "-12.345"), (-90_000, "90")] {
        assert_eq!(robot.read("heading", &numbers(&[mdeg])), Ok(shown.into()));
    }
}

/// The angle of the gyroscope in mdeg, both encoders, and 10 ms since the tuple before.
fn looks(robot: &mut Robot, mdeg: i32, left: i32, right: i32) -> f64 {
    let shown = robot.read("heading", &numbers(&[mdeg, left, right, 10_000]));
    shown.unwrap().parse().unwrap()
}

/// A window of 100 ms are ten tuples. 2 mdeg in a tuple are 200 mdeg/s: drift while no wheel moves, a turn if one does.
#[test]
fn what_the_heading_turns_by_while_the_wheels_stand_still_is_drift() {
    let gyroscope = "{ port = 'gyroscope', calibration_ms = 100 }";
    let mut robot = robot(&format!("{CAR}, {gyroscope}"));
    let first = looks(&mut robot, 90_000, 5, 5);
    assert_eq!(first, -90.0, "that of the gyroscope");
    for step in 1..=9 {
        assert_eq!(
            looks(&mut robot, 90_000 + 2 * step, 5, 5),
            -90.0 - 0.002 * f64::from(step)
        );
    }
    // The first window is over: it is taken back, and the same drift is taken off from now on.
    for step in 10..=30 {
        assert_eq!(looks(&mut robot, 90_000 + 2 * step, 5, 5), -90.0, "{step}");
    }
    // A creep: each fifth tuple a wheel has turned by a degree. 4 mdeg in a tuple are 2 of drift and 2 of the robot.
    let mut last = 0.0;
    for step in 1..=1000 {
        last = looks(&mut robot, 90_060 + 4 * step, 5 + step / 5, 5);
    }
    assert_eq!(last, -92.0);
    // Somebody turns it by hand, faster than any drift: 60 mdeg in 100 ms.
    for step in 1..=1000 {
        last = looks(&mut robot, 94_060 + 6 * step, 205, 5);
    }
    assert_eq!(last, -96.0);
    // Through the end of the circle: from 100.06 to 190 degrees are 89.94, without 2 mdeg of drift; 96 more are 185.938.
    assert_eq!(looks(&mut robot, -170_000, 206, 5), 174.062);
}

#[test]
fn the_heading_looks_at_the_encoders_that_the_robot_file_names() {
    let size = |entries: &str| robot(entries).node("heading").input_tuple_size;
    assert_eq!(size(""), 4);
    assert_eq!(size("{ port = 'M3' }, { port = 'A1', name = 'front' }"), 4);
    assert_eq!(size("{ port = 'E2' }"), 12);
    assert_eq!(size("{ port = 'M3', encoder = 'E3' }, { port = 'E3' }"), 12);
    assert_eq!(size(CAR), 16);
}
