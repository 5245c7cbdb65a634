//! Tests of robots that move by a model.

use super::*;
use crate::geometry::point;

const CAR: &str =
    "BEGIN Car ACTION: v /** @port M3*0.03 */, steer in -0.5 .. 0.5 /** @port S1*0.5 */;
PARAM: L; CONFIG: x, y, theta;
d(x) = v * cos(theta); d(y) = v * sin(theta); d(theta) = v / L * tan(steer); END;";

fn model(text: &str) -> Model {
    let mut understood = lang_dcml::understand(text);
    let found = understood.models.pop();
    found.unwrap_or_else(|| panic!("{:?}", understood.diagnostics))
}

fn said(params: &[(&str, f64)], drive: &[(&str, &str)]) -> Overrides {
    Overrides {
        params: params
            .iter()
            .map(|(name, number)| ((*name).to_owned(), *number))
            .collect(),
        drive: drive
            .iter()
            .map(|(name, port)| ((*name).to_owned(), Actuator::read(port).unwrap()))
            .collect(),
        start: Vec::new(),
    }
}

fn refused(text: &str, said: &Overrides) -> String {
    Rolling::new(&model(text), said, Pose::default())
        .err()
        .unwrap()
        .to_string()
}

/// A motor that turns at 10 rad/s, for so many seconds.
fn go(rolling: &mut Rolling, seconds: f64, pulse_ns: u32) {
    for _ in 0..(seconds * 1000.0) as u32 {
        rolling.roll(0.001, [0.0, 0.0, 0.01, 0.0], [pulse_ns, 0, 0, 0, 0, 0]);
    }
}

/// 0.3 m/s on a circle of 0.2 / tan(0.4) = 0.473 m: 90 * 0.4 / (pi / 4) degrees of the servo, and its pulse.
#[test]
fn a_car_drives_the_circle_that_its_servo_says() {
    let start = Pose::new(1.0, 2.0, FRAC_PI_2);
    let mut car = Rolling::new(&model(CAR), &said(&[("L", 0.2)], &[]), start).unwrap();
    let pulse = (1_425_000.0 + 725_000.0 * 0.4 / (FRAC_PI_2 / 2.0)) as u32;
    // The servo takes its time: it stands before the car goes.
    for _ in 0..500 {
        car.roll(0.001, [0.0; 4], [pulse, 0, 0, 0, 0, 0]);
    }
    assert_eq!(car.pose(), start);
    go(&mut car, 2.0, pulse);
    let radius = 0.2 / 0.4_f64.tan();
    let angle = 0.6 / radius;
    let end = car.pose();
    assert!(
        (end.heading_rad - FRAC_PI_2 - angle).abs() < 1e-5,
        "{end:?}"
    );
    // Ahead is up on the map, and left of that to the left.
    assert!(
        (end.at.y - 2.0 - radius * angle.sin()).abs() < 1e-5,
        "{end:?}"
    );
    assert!(
        (end.at.x - 1.0 + radius * (1.0 - angle.cos())).abs() < 1e-5,
        "{end:?}"
    );
}

#[test]
fn an_action_stays_in_its_range_and_a_servo_without_pulses_where_it_is() {
    let run = |pulses: [u32; 2]| {
        let mut car =
            Rolling::new(&model(CAR), &said(&[("L", 0.2)], &[]), Pose::default()).unwrap();
        for _ in 0..500 {
            car.roll(0.001, [0.0; 4], [pulses[0], 0, 0, 0, 0, 0]);
        }
        go(&mut car, 1.0, pulses[1]);
        car.pose().heading_rad
    };
    // 45 degrees of the wheels are more than 0.5 rad.
    let most = 0.3 / 0.2 * 0.5_f64.tan();
    assert!((run([2_150_000, 2_150_000]) - most).abs() < 1e-9);
    assert!((run([700_000, 0]) + most).abs() < 1e-9);
}

#[test]
fn a_place_that_is_computed_begins_where_the_robot_stands_and_is_pushed_by_walls() {
    // The front axle has the state; the place is 0.1 m behind it, and the heading wraps.
    let text = "BEGIN Front ACTION: M3; CONFIG: x, y, theta, fx, fy, h;
d(fx) = M3 * cos(h); d(fy) = M3 * sin(h); d(h) = M3 / 2;
x = fx - 0.1 * cos(h); y = fy - 0.1 * sin(h); theta = atan2(sin(h), cos(h)); END;";
    let start = Pose::new(0.8, 1.0, 0.0);
    let mut rolling = Rolling::new(&model(text), &said(&[], &[]), start).unwrap();
    assert_eq!(rolling.pose(), start);
    // 20 rad of the wheel are 10 rad of the heading: it goes through whole turns.
    for _ in 0..2000 {
        rolling.roll(0.001, [0.0, 0.0, 0.01, 0.0], [0; 6]);
    }
    assert!((rolling.pose().heading_rad - 10.0).abs() < 1e-9);
    let before = rolling.pose();
    rolling.push(point(before.at.x - 0.5, before.at.y + 0.25));
    rolling.roll(0.001, [0.0; 4], [0; 6]);
    let after = rolling.pose();
    assert!((after.at.x - before.at.x + 0.5).abs() < 1e-12);
    assert!((after.at.y - before.at.y - 0.25).abs() < 1e-12);
}

#[test]
fn a_robot_without_finite_numbers_stays() {
    let text = "BEGIN P ACTION: M3; CONFIG: x, y, theta; d(x) = log(0.001 - x) * M3; d(y) = 0 * M3; d(theta) = 0 * M3; END;";
    let mut rolling = Rolling::new(&model(text), &said(&[], &[]), Pose::default()).unwrap();
    go(&mut rolling, 1.0, 0);
    let there = rolling.pose();
    assert!(there.at.x.is_finite());
    let text = "BEGIN P ACTION: M3; CONFIG: x, y, theta; d(x) = sqrt(0.05 - M3) + M3; d(y) = 0 * M3; d(theta) = 0 * M3; END;";
    let mut rolling = Rolling::new(&model(text), &said(&[], &[]), Pose::default()).unwrap();
    go(&mut rolling, 0.1, 0);
    assert_eq!(rolling.pose(), Pose::default());
}

#[test]
fn what_is_missing_or_unknown_is_told_with_what_to_do() {
    assert_eq!(
        refused(CAR, &said(&[], &[])),
        "the model needs numbers: --params L=..."
    );
    assert_eq!(
        refused(CAR, &said(&[("L", 1.0), ("W", 1.0)], &[])),
        "the model has no parameter 'W'; it has L"
    );
    assert_eq!(
        refused(CAR, &said(&[("L", 1.0)], &[("u", "M3")])),
        "the model has no action 'u'; it has v, steer"
    );
    let point = "BEGIN P ACTION: u; CONFIG: x; d(x) = u; END;";
    assert_eq!(
        refused(point, &said(&[], &[])),
        "nothing drives the action 'u': say --drive u=M3, or write @port M3 into its documentation"
    );
    assert_eq!(
        refused(point, &said(&[], &[("u", "M3")])),
        "the model 'P' must have x, y and theta in its CONFIG: they are the place on the map"
    );
    let wrong = CAR.replace("@port S1*0.5", "@port T1");
    assert_eq!(
        refused(&wrong, &said(&[("L", 1.0)], &[])),
        "@port of the action 'steer': 'T1' is no port: M1 to M4 or S1 to S6"
    );
    for words in [
        "", "M0", "M5", "S7", "M3*", "M3*x", "M3*inf", "M3*0", "M", "\u{439}3",
    ] {
        assert!(Actuator::read(words).is_err(), "{words}");
    }
}

#[test]
fn the_configuration_names_motors_servos_and_the_model() {
    let rolling = Rolling::new(&model(CAR), &said(&[("L", 0.2)], &[]), Pose::default()).unwrap();
    let (_, lua) = crate::robots::modelled(rolling, "x]] y", &said(&[("L", 0.2)], &[]));
    for line in [
        "  { port = 'M3', type = 'motor100', encoder = 'E3', name = 'v' },\n",
        "  { port = 'S1', type = 'angularServomotor', name = 'steer' },\n",
        "  { port = 'A1', type = 'sharpGP2' },\n",
        "params = { L = 0.2 }",
        "v = { 'd(encoders/E3)', scale = 0.0005235987755982988 }, steer = { 'servos/S1', scale = 0.008726646259971648 }",
        "model = [=[\nx]] y\n]=]",
    ] {
        assert!(lua.contains(line), "{line} in {lua}");
    }
}

/// What is left out comes from the model, or is there without a plug.
#[test]
fn every_sensor_that_is_plugged_in_is_in_the_configuration_of_a_model() {
    let rolling = Rolling::new(&model(CAR), &said(&[("L", 0.2)], &[]), Pose::default()).unwrap();
    let (_, lua) = crate::robots::modelled(rolling, "x", &said(&[("L", 0.2)], &[]));
    let plugs = crate::robots::by_name("two-wheels").unwrap().ports;
    let is_left_out =
        |port: &str| port.starts_with(['M', 'E', 'S']) || ["camera", "ir_camera"].contains(&port);
    for plug in plugs.iter().filter(|plug| !is_left_out(plug.port)) {
        let entry = format!("  {{ port = '{}'", plug.port);
        assert!(lua.contains(&entry), "{entry} in {lua}");
    }
}
