//! Models in DCML on a whole virtual robot: they move its body, and they follow it from its encoders.

use crate::rig::{Home, Robot, robot};
use harness::eventually;
use std::sync::Arc;

/// Car, steered by a servo and driven by one motor.
const CAR: &str = "/** A car. */
BEGIN Car
ACTION: v /** speed of the rear axle in m/s, @port M3*0.03 */, steer /** @port S1*0.5 */;
PARAM: L;
CONFIG: x, y, theta;
d(x) = v * cos(theta);
d(y) = v * sin(theta);
d(theta) = v / L * tan(steer);
END;
";

/// Four wheels with rollers: they go to any side.
const MECANUM: &str = "BEGIN Mecanum
ACTION: M1, M2, M3, M4;
PARAM: r, l;
CONFIG: x, y, theta;
VAR: ahead, left;
ahead = r / 4 * (M1 + M2 + M3 + M4);
left = r / 4 * (M2 + M3 - M1 - M4);
d(x) = ahead * cos(theta) - left * sin(theta);
d(y) = ahead * sin(theta) + left * cos(theta);
d(theta) = r / (4 * l) * (M2 + M4 - M1 - M3);
END;
";

/// The usual robot, and its place by a model of its own choice.
const FOLLOWED: &str = "local trik = include 'trik.lua'
trikfs = trik.robot { { port = 'M3', type = 'motor100' }, { port = 'M4', type = 'motor100' }, { port = 'E3', name = 'left' } }
trikfs.pose = dcml { model = 'differential-drive', params = { L = 0.155, r = 0.028 }, actions = { u_l = 'd(encoders/E3)', u_r = 'd(encoders/E4)' } }
trikfs.turned = dcml { model = 'differential-drive', params = { L = 0.155, r = 0.028 }, heading = 'heading_deg', actions = { u_l = 'd(encoders/E3)', u_r = 'd(encoders/E4)' } }
trikfs.heading_deg = { src = { 'newest:gyroscope/heading' }, format = 'i32 heading', poll_ms = 10, converter = function(a_s, a, b_s, b) ba.i32(b, 0, -ba.i32(a, 0) / 1000) end }
";

/// Waits until a node has said the same for a row of looks that take longer than many samples.
fn rest(robot: &Robot, node: &str) -> [f64; 3] {
    let (mut last, mut same) = (Vec::new(), 0);
    eventually("a standstill", || {
        if robot.errno(node) != 0 {
            return false;
        }
        let now = robot.numbers(node);
        same = if now == last { same + 1 } else { 0 };
        last = now;
        same > 40
    });
    last.try_into().expect("x, y, theta")
}

/// Asserts that a node is where the robot truly is, which began at (0.8, 1) and looked along x.
fn is_there(robot: &Robot, node: &str, metres: f64, degrees: f64) {
    let [x, y, theta] = rest(robot, node);
    let truth = robot.pose();
    let away = (x + 0.8 - truth.x_m).hypot(y + 1.0 - truth.y_m);
    let turned = (theta.to_degrees() - truth.heading_deg + 180.0).rem_euclid(360.0) - 180.0;
    assert!(
        away < metres && turned.abs() < degrees,
        "{node}: {x} {y} {theta} instead of {truth:?}: {away} m, {turned} degrees"
    );
    assert_eq!(truth.bumps, 0.0, "a wall makes wheels slip");
}

/// Drives until the robot is so far from where it began.
fn drive_away(robot: &Robot, metres: f64, powers: &[(&str, &str)]) {
    let begun = robot.pose();
    for (motor, power) in powers {
        robot
            .write(&format!("motors/{motor}/value"), power)
            .expect("a motor");
    }
    eventually("a way", || robot.pose().away_from(&begun) > metres);
    for (motor, _) in powers {
        robot
            .write(&format!("motors/{motor}/value"), "0")
            .expect("a motor");
    }
}

#[test]
fn a_node_follows_the_robot_by_a_model_in_one_line() {
    let Some(home) = Home::new() else { return };
    home.0.file("robot.lua", FOLLOWED);
    let robot = Robot::start(Arc::new(home), &["--config", "robot.lua"]);
    assert_eq!(
        robot.read("pose/format").expect("a format"),
        "f32 x, f32 y, f32 theta"
    );
    eventually("a calibrated gyroscope", || {
        robot.errno("turned/value") == 0
    });
    eventually("encoders", || robot.errno("pose/value") == 0);
    assert_eq!(robot.numbers("pose/value"), [0.0; 3]);
    // A circle of 0.23 m to the left, on which no wall is, however long it lasts; and back.
    drive_away(&robot, 0.25, &[("M3", "20"), ("M4", "40")]);
    drive_away(&robot, 0.1, &[("M3", "-20"), ("M4", "-40")]);
    // Encoders count whole degrees of a wheel: half a millimetre, and 0.18 degrees of the heading.
    is_there(&robot, "pose/value", 0.01, 1.5);
    // The gyroscope's heading has its noise and what was measured in whole degrees here.
    is_there(&robot, "turned/value", 0.02, 4.0);
    // A number of the model is a file.
    assert_eq!(robot.read("pose/params/L").expect("a param"), "0.155");
}

#[test]
fn a_car_of_a_model_is_steered_by_a_servo_and_followed_by_its_own_node() {
    let Some(home) = Home::new() else { return };
    home.0.file("car.dcml", CAR);
    let words = ["--robot", "car.dcml", "--params", "L=0.2"];
    let robot = Robot::start(Arc::new(home), &words);
    // While the servo is off nobody knows where the wheels point.
    assert_ne!(robot.errno("pose/value"), 0);
    robot.write("servos/steer/value", "60").expect("a servo");
    eventually("a place", || robot.errno("pose/value") == 0);
    drive_away(&robot, 0.2, &[("v", "40")]);
    let begun = robot.pose();
    // 60 degrees of the servo are 30 of the wheels: a circle of 0.2 / tan(30) = 0.35 m to the left.
    assert!(begun.heading_deg > 10.0 && begun.y_m > 1.01, "{begun:?}");
    is_there(&robot, "pose/value", 0.02, 4.0);
    assert!(robot.number("encoders/E3/value") > 100.0);
    assert!(robot.errno("motors/M4/value") == 0 && robot.errno("encoders/E4/value") == 0);
}

#[test]
fn four_wheels_with_rollers_go_to_the_side() {
    let Some(home) = Home::new() else { return };
    home.0.file("mecanum.dcml", MECANUM);
    let words = ["--robot=mecanum.dcml", "--params=r=0.03,l=0.2"];
    let robot = Robot::start(Arc::new(home), &words);
    eventually("a place", || robot.errno("pose/value") == 0);
    let to_the_left = [("M1", "-20"), ("M2", "20"), ("M3", "20"), ("M4", "-20")];
    drive_away(&robot, 0.2, &to_the_left);
    is_there(&robot, "pose/value", 0.02, 3.0);
    let pose = robot.pose();
    assert!(pose.y_m > 1.15, "{pose:?}");
    // The motors begin one after the other, so it turns a little.
    assert!(
        (pose.x_m - 0.8).abs() < 0.1 && pose.heading_deg.abs() < 20.0,
        "{pose:?}"
    );
}

#[test]
fn what_is_wrong_with_a_model_is_told_where_the_configuration_is_written() {
    let Some(robot) = robot(&[]) else { return };
    let before = robot.read("config").expect("the configuration");
    let refused = |dcml: &str| {
        let text = format!("{before}\ntrikfs.pose = dcml {{ {dcml} }}\n");
        let output = robot.sh(&format!(
            "cat > config <<'END'\n{text}END\nhead -n 1 status"
        ));
        assert_eq!(robot.read("config").expect("the configuration"), before);
        assert_eq!(robot.errno("pose/value"), libc::ENOENT);
        output.stdout
    };
    let actions =
        "params = { L = 1, r = 1 }, actions = { u_l = 'd(encoders/E3)', u_r = 'd(encoders/E4)' }";
    let line = before.lines().count() + 1;
    for (dcml, told) in [
        (format!("model = 'none.dcml', {actions}"), "model 'none.dcml' was not found in "),
        ("model = 'differential-drive', params = { L = 1, r = 1, R = 2 }".to_owned(), "params: the model has no parameter 'R'; it has L, r"),
        ("model = 'differential-drive', params = { L = 1 }".to_owned(), "params: the model needs the number 'r'"),
        ("model = 'differential-drive', params = { L = 1, r = 1 }, actions = { u_x = 'd(encoders/E3)' }".to_owned(), "actions: the model has no action 'u_x'; it has u_l, u_r"),
        ("model = 'differential-drive', params = { L = 1, r = 1 }, actions = { u_l = 'd(encoders/E3)' }".to_owned(), "actions: nothing is said of 'u_r'"),
        ("model = 'differential-drive', params = { L = 1, r = 1 }, actions = { u_l = 'd(encoders/E3)', u_r = 'd(pose)' }".to_owned(), "pose"),
        ("model = 'differential-drive', params = { L = 1, r = 1 }, actions = { u_l = 'd(encoders/E3)', u_r = { 'd(encoders/E4)', type = 'f32' } }".to_owned(), "the converter takes 'i32 u_l, f32 u_r, u32 interval_us', but the sources give 'i32 u_l, i32 u_r, u32 interval_us'"),
        (format!("wheels = 2, model = 'differential-drive', {actions}"), "there is no option 'wheels'; there are actions, heading, model, params, poll_ms, start"),
        ("model = [[BEGIN A ACTION: u; CONFIG: z; d(z) = u; END;]], actions = { u = 'd(encoders/E3)' }".to_owned(), "the model 'A' must have x, y and theta in its CONFIG; it has z"),
    ] {
        let said = refused(&dcml);
        assert!(
            said.starts_with(&format!("config refused: config:{line}: ")) && said.contains(told),
            "{dcml}\n{said}"
        );
    }
    let broken = "model = [[\nBEGIN A\nACTION: u;\nCONFIG: x, y, theta;\nd(x) = v;\nd(y) = u;\nd(theta) = u;\nEND;]]";
    let said = refused(broken);
    assert!(
        said.contains(&format!("config:{}:8: ", line + 4)) && said.contains("`v`"),
        "{said}"
    );
}

#[test]
fn a_model_that_moves_no_robot_is_refused_before_anything_starts() {
    let Some(home) = Home::new() else { return };
    home.0.file("car.dcml", CAR);
    home.0
        .file("point.dcml", "BEGIN P ACTION: u; CONFIG: x; d(x) = u; END;");
    home.0.file(
        "broken.dcml",
        "BEGIN P ACTION: u; CONFIG: x; d(x) = w; END;",
    );
    for (words, told) in [
        (&["--robot=none.dcml"] as &[&str], "none.dcml"),
        (
            &["--robot=car.dcml"],
            "the model needs numbers: --params L=...",
        ),
        (
            &["--robot=car.dcml", "--params=L=1,M=2"],
            "the model has no parameter 'M'; it has L",
        ),
        (
            &["--robot=point.dcml"],
            "nothing drives the action 'u': say --drive u=M3",
        ),
        (
            &["--robot=point.dcml", "--drive=u=M3"],
            "must have x, y and theta",
        ),
        (
            &["--robot=point.dcml", "--drive=u=M9"],
            "'M9' is no port: M1 to M4 or S1 to S6",
        ),
        (&["--robot=broken.dcml"], "`w`"),
        (&["--params=L=1"], "--params is for a model"),
        (&["--robot=tank"], "there is no such robot"),
    ] {
        let mut all = vec!["up", "--no-trikd", "--no-view"];
        all.extend(words);
        let output = home.run(&all);
        assert_ne!(output.code(), 0, "{words:?}");
        assert!(output.stderr.contains(told), "{words:?}: {}", output.stderr);
        assert!(!home.base().join("robot").exists());
    }
}
