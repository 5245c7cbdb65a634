//! Speed that is held, heading and place on the virtual board: what the tree says against where the robot truly is.

use crate::rig::{Home, Robot, robot};
use harness::eventually;
use std::sync::Arc;
use std::time::Duration;

/// Both wheels, in deg/s.
fn order(robot: &Robot, left: i32, right: i32) {
    for (name, speed) in [("left", left), ("right", right)] {
        let file = format!("motors/{name}/speed");
        robot.write(&file, &speed.to_string()).expect(name);
    }
}

/// Orders again if the order was lost because this machine is too busy: a tree that comes to nothing for a second has to
/// bring the motors to rest. Nothing else may have ended it.
fn keep(robot: &Robot, left: i32, right: i32) {
    if !is_at_rest(robot) {
        return;
    }
    let log = robot.log();
    let ends: Vec<&str> = log
        .lines()
        .filter(|line| line.contains("comes to rest"))
        .collect();
    if ends.is_empty() {
        // The first step is made with the first sample.
        return;
    }
    let is_busy = |line: &&str| {
        line.contains("did not answer within") || line.contains("since the last tuple")
    };
    assert!(ends.iter().all(is_busy), "{log}");
    // The sample after the failure may have to come first.
    eventually("an order that is taken", || {
        let orders = [("left", left), ("right", right)];
        orders.iter().all(|(name, speed)| {
            let file = format!("motors/{name}/speed");
            robot.write(&file, &speed.to_string()).is_ok()
        })
    });
}

/// Waits until the wheels have turned against each other at this speed, by the file of the left one, for 0.4 simulated
/// seconds.
fn settles(robot: &Robot, speed: i32) {
    let wanted = f64::from(speed);
    let mut since = None;
    eventually("a held speed", || {
        keep(robot, speed, -speed);
        let now = robot.read("motors/left/speed").unwrap_or_default();
        let now: f64 = now.parse().unwrap_or(f64::NAN);
        let is_held = (now - wanted).abs() < 0.12 * wanted.abs();
        if !is_held {
            since = None;
            return false;
        }
        let time_s = robot.pose().time_s;
        time_s > *since.get_or_insert(time_s) + 0.4
    });
}

/// 300 deg/s of the wheels against each other are 108.4 deg/s of the robot, over more than half a simulated second.
fn turns_as_ordered(robot: &Robot, when: &str) {
    loop {
        settles(robot, -300);
        let before = robot.pose();
        let mut after = before;
        eventually("half a second of movement", || {
            after = robot.pose();
            after.time_s > before.time_s + 0.5 || is_at_rest(robot)
        });
        if !is_at_rest(robot) {
            let rate = (after.heading_deg - before.heading_deg) / (after.time_s - before.time_s);
            assert!((rate - 108.4).abs() < 9.0, "{rate} deg/s {when}");
            return;
        }
    }
}

fn is_at_rest(robot: &Robot) -> bool {
    [3, 4].map(|motor| robot.duty(motor).ok()) == [Some(0), Some(0)]
}

/// Wheels of 2.8 cm on a track of 15.5 cm: 300 deg/s against each other turn the robot by 108 deg/s. Three volts less
/// are a quarter less, if nobody holds the speed.
#[test]
fn a_speed_is_held_while_the_battery_sags() {
    let Some(robot) = robot(&[]) else { return };
    order(&robot, -300, 300);
    turns_as_ordered(&robot, "in the beginning");
    robot.fault(&["battery", "sag", "3"]);
    eventually("a weak battery", || robot.number("battery/value") < 10.0);
    turns_as_ordered(&robot, "with less voltage");

    // A reload that leaves the motors as they are leaves them running.
    let reloaded = robot.sh("echo '-- again' >> config; head -n 1 status; tail -n 1 config");
    let told = reloaded.good();
    assert!(
        told.starts_with("config ok") && told.ends_with("again\n"),
        "{told}"
    );
    turns_as_ordered(&robot, "after a reload");

    // What cannot be is refused, and what was ordered before is held on.
    for (wrong, errno) in [
        ("1201", nix::libc::ERANGE),
        ("-5000", nix::libc::ERANGE),
        ("fast", nix::libc::EINVAL),
    ] {
        let error = robot.write("motors/left/speed", wrong).expect_err(wrong);
        assert_eq!(error.raw_os_error(), Some(errno), "{wrong}");
    }
    turns_as_ordered(&robot, "after refusals");

    robot.write("stop", "1").expect("stop");
    assert!(is_at_rest(&robot));
    eventually("a standstill", || robot.number("motors/left/speed") == 0.0);
    assert!(is_at_rest(&robot), "nobody goes on");
}

#[test]
fn a_dead_encoder_stops_its_motor_and_says_why() {
    let Some(robot) = robot(&[]) else { return };
    let fault = || robot.read("motors/left/fault").expect("a text");
    robot.fault(&["E3", "stuck"]);
    order(&robot, 300, 300);
    eventually("a fault", || fault().contains("encoder stands still"));
    assert!(fault().starts_with("device: "), "{}", fault());
    eventually("a motor that is off", || {
        robot.duty(3).is_ok_and(|duty| duty == 0)
    });
    assert_ne!(
        robot.duty(4).expect("the bus"),
        0,
        "the other wheel is well"
    );
    // It is not forgotten before somebody drives again.
    assert!(robot.number("motors/left/value") == 0.0 && !fault().is_empty());
    robot.write("stop", "1").expect("stop");
    robot.fault(&["E3", "--clear"]);
    order(&robot, 100, -100);
    assert_eq!(fault(), "");
    settles(&robot, 100);
    // Nobody knows how fast it is when the coprocessor does not answer: the order ends.
    robot.fault(&["msp430", "nack"]);
    eventually("an error", || robot.errno("motors/left/speed") != 0);
    assert!(robot.write("motors/left/speed", "100").is_err());
    robot.fault(&["msp430", "--clear"]);
    // Of both: the wheels are asked one after the other, and each is measured again by itself.
    eventually("measured speeds", || {
        robot.errno("motors/left/speed") == 0 && robot.errno("motors/right/speed") == 0
    });
    assert!(fault().contains("0x48"), "{}", fault());
    order(&robot, 0, 0);
    assert!(is_at_rest(&robot));
}

/// An encoder that is mounted the other way round must not make the motor run away.
#[test]
fn an_encoder_that_counts_backwards_stops_its_motor() {
    let Some(home) = Home::new() else { return };
    let shipped = include_str!("../../../config/lua/robots/two-wheels.lua");
    let wrong = shipped.replace("port = 'E3',", "port = 'E3', polarity = 'inversed',");
    assert_ne!(wrong, shipped);
    home.0.file("wrong.lua", wrong);
    let robot = Robot::start(Arc::new(home), &["--config", "wrong.lua"]);
    order(&robot, 200, 0);
    eventually("a fault", || {
        let fault = robot.read("motors/left/fault").expect("a text");
        fault.contains("change the polarity")
    });
    eventually("rest", || is_at_rest(&robot));
}

#[test]
fn the_end_of_a_lease_and_of_a_program_ends_the_order() {
    let Some(robot) = robot(&[]) else { return };
    let output = robot.sh(
        "exec 3> motors/left/owner && until [ $(cat motors/left/speed) -ge 50 ]; do echo 200 > motors/left/speed; done && cat motors/left/owner && exec 3>&-",
    );
    let told = output.good();
    assert!(told.contains("priority 0"), "{told}");
    eventually("rest", || is_at_rest(&robot));
    eventually("a standstill", || robot.number("motors/left/speed") == 0.0);
    assert!(is_at_rest(&robot));
    // A program that is killed with the file open.
    let output = robot.sh(
        "sh -c 'exec 3> motors/left/speed; until [ $(cat motors/left/speed) -ge 50 ]; do echo 200 >&3; done; kill -9 $$' 2>/dev/null; echo done",
    );
    assert_eq!(output.good(), "done\n");
    eventually("rest", || is_at_rest(&robot));
}

#[test]
fn heading_and_place_follow_the_robot_and_stay_where_it_rests() {
    let Some(robot) = robot(&[]) else { return };
    let start = robot.pose();
    // The first reading waits for the calibration.
    let rest = robot.number("heading/value");
    assert!(rest.abs() < 0.5, "{rest}");
    assert_eq!(robot.read("heading/units").expect("a unit"), "deg");
    order(&robot, -150, 150);
    eventually("most of a turn to the left", || {
        keep(&robot, -150, 150);
        robot.pose().heading_deg > start.heading_deg + 300.0
    });
    order(&robot, 200, 200);
    eventually("ahead", || {
        keep(&robot, 200, 200);
        robot.pose().away_from(&start) > 0.15
    });
    order(&robot, 0, 0);
    let mut last = robot.pose();
    eventually("a standstill", || {
        let now = robot.pose();
        let stands = now.time_s == last.time_s && robot.number("motors/left/speed") == 0.0;
        last = now;
        std::thread::sleep(Duration::from_millis(50));
        stands
    });
    let turned = last.heading_deg - start.heading_deg;
    let wrong = |angle: f64| (angle - turned + 540.0).rem_euclid(360.0) - 180.0;
    let heading = robot.number("heading/value");
    assert!(wrong(heading).abs() < 3.0, "{heading}, truly {turned}");
    let place = robot.numbers("odometry/value");
    assert!(wrong(place[2]).abs() < 3.0, "{place:?}, truly {turned}");
    // The robot began at heading 0.
    let (x_mm, y_mm) = (
        (last.x_m - start.x_m) * 1000.0,
        (last.y_m - start.y_m) * 1000.0,
    );
    assert!(
        (place[0] - x_mm).hypot(place[1] - y_mm) < 15.0,
        "{place:?}, truly {x_mm} {y_mm}"
    );
    // At rest nothing drifts: two seconds are half of a calibration more.
    let began = std::time::Instant::now();
    eventually("three seconds", || began.elapsed() > Duration::from_secs(3));
    let later = robot.number("heading/value");
    assert!((later - heading).abs() < 0.5, "{heading}, then {later}");
    assert_eq!(robot.numbers("odometry/value"), place);
}

/// Wheels that turn by 1 deg/s against each other turn the robot by 0.36 deg/s: as slow as a gyroscope drifts.
#[test]
fn a_creep_is_no_drift() {
    let Some(robot) = robot(&[]) else { return };
    let start = robot.pose();
    assert!(robot.number("heading/value").abs() < 0.5);
    order(&robot, -1, 1);
    eventually("a creep by five degrees", || {
        keep(&robot, -1, 1);
        robot.pose().heading_deg > start.heading_deg + 5.0
    });
    order(&robot, 0, 0);
    let began = std::time::Instant::now();
    eventually("two windows of rest", || {
        began.elapsed() > Duration::from_secs(5)
    });
    let turned = robot.pose().heading_deg - start.heading_deg;
    let heading = robot.number("heading/value");
    assert!((heading - turned).abs() < 1.5, "{heading}, truly {turned}");
}
