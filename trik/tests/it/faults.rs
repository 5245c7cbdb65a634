//! Devices that fail on purpose: never a number, always a reason, and all is well again when they are.

use crate::rig::robot;
use harness::eventually;
use std::time::{Duration, Instant};

#[test]
fn an_unplugged_sensor_gives_an_error_and_comes_back() {
    let Some(robot) = robot(&[]) else { return };
    let value = "sensors/D1/value";
    eventually("a distance", || robot.errno(value) == 0);
    robot.fault(&["D1", "unplug"]);
    eventually("an error", || robot.errno(value) != 0);
    assert_ne!(robot.read("sensors/D1/fault").expect("a text"), "");
    robot.fault(&["D1", "--clear"]);
    eventually("a distance again", || robot.errno(value) == 0);
}

/// Each value of a robot that was just switched on, whatever is connected to it. The camera takes its first picture.
#[test]
fn what_has_never_spoken_on_a_fresh_robot_says_so_at_once() {
    let Some(robot) = robot(&[]) else { return };
    let timed = |name: &str| {
        let start = Instant::now();
        let errno = robot.errno(name);
        (errno, start.elapsed())
    };
    let silent = [
        "gamepad/buttons/value",
        "gamepad/pad1/value",
        "gamepad/pad2/value",
        "gamepad/text/value",
        "gamepad/wheel/value",
    ];
    // The least of some, for a machine that is busy; who waits for a sample that does not come waits for a second.
    let soon = |name: &str, all: &[(i32, Duration)]| {
        let least = all.iter().map(|(_, time)| *time).min();
        let limit = Duration::from_millis(500);
        assert!(least.is_some_and(|time| time <= limit), "{name}: {all:?}");
    };
    for name in silent {
        let all: Vec<_> = (0..5).map(|_| timed(name)).collect();
        let is_silent = |(errno, _): &(i32, Duration)| *errno == libc::ENODATA;
        assert!(all.iter().all(is_silent), "{name}: {all:?}");
        soon(name, &all);
        let fault = name.replace("value", "fault");
        assert_eq!(robot.read(&fault).expect("a text"), "", "{name}");
    }
    // The board tells of its keys now and then, so this one may have something to say.
    let keys = "input/platform-soc_1c00000_gpio-keys-event/value";
    let all: Vec<_> = (0..5).map(|_| timed(keys)).collect();
    let is_known = |(errno, _): &(i32, Duration)| matches!(*errno, 0 | libc::ENODATA);
    assert!(all.iter().all(is_known), "{keys}: {all:?}");
    soon(keys, &all);
    // Nothing of the tree is waited for in vain. The camera computes its first picture, as long as that takes.
    let names = robot.sh("ls -d */value */*/value").stdout;
    let names: Vec<_> = names
        .lines()
        .filter(|name| !name.starts_with("camera/"))
        .collect();
    assert!(
        names.contains(&"sensors/A1/value") && names.len() > 30,
        "{names:?}"
    );
    for name in names {
        robot.errno(name);
        let fault = robot.read(&name.replace("value", "fault")).expect("a text");
        assert!(!fault.contains("no sample within"), "{name}: {fault}");
    }
}

#[test]
fn a_lidar_that_is_silent_has_no_picture() {
    let Some(robot) = robot(&[]) else { return };
    let value = "lidar/value";
    eventually("a picture", || robot.errno(value) == 0);
    robot.fault(&["lidar", "unplug"]);
    eventually("an error", || robot.errno(value) == libc::ETIMEDOUT);
    robot.fault(&["lidar", "--clear"]);
    eventually("a picture again", || robot.errno(value) == 0);
}

#[test]
fn inertial_sensors_that_fall_silent_do_not_show_their_last_samples() {
    let Some(robot) = robot(&[]) else { return };
    let names = [
        "gyroscope/value",
        "gyroscope/heading",
        "accelerometer/value",
        "heading/value",
    ];
    for name in names {
        eventually(name, || robot.errno(name) == 0);
    }
    robot.fault(&["gyroscope", "drop", "1"]);
    robot.fault(&["accelerometer", "drop", "1"]);
    for name in names {
        eventually(name, || robot.errno(name) == libc::ETIMEDOUT);
    }
    robot.fault(&["gyroscope", "--clear"]);
    robot.fault(&["accelerometer", "--clear"]);
    for name in names {
        eventually(name, || robot.errno(name) == 0);
    }
}

#[test]
fn a_coprocessor_that_does_not_answer_fails_what_is_behind_it_and_nothing_else() {
    let Some(robot) = robot(&[]) else { return };
    let others = ["sensors/D1/value", "accelerometer/value"];
    let behind = ["encoders/E3/value", "battery/value", "sensors/A1/value"];
    for name in others.iter().chain(&behind) {
        eventually(name, || robot.errno(name) == 0);
    }
    robot.fault(&["msp430", "nack"]);
    for name in behind {
        eventually(name, || robot.errno(name) != 0);
    }
    assert!(robot.write("motors/M3/value", "10").is_err());
    let fault = robot.read("encoders/E3/fault").expect("a text");
    assert!(fault.contains("0x48"), "{fault}");
    for name in others {
        assert_eq!(robot.errno(name), 0, "{name}");
    }
    robot.fault(&["msp430", "--clear"]);
    for name in behind {
        eventually(name, || robot.errno(name) == 0);
    }
    robot.write("motors/M3/value", "10").expect("a motor");
}

#[test]
fn a_slow_bus_does_not_delay_what_is_not_on_it() {
    let Some(robot) = robot(&[]) else { return };
    eventually("a distance", || robot.errno("sensors/D1/value") == 0);
    robot.fault(&["i2c-2", "slow", "300"]);
    // A busy machine makes a read slow now and then; behind the bus one would be slow each time.
    eventually("reads beside a slow bus", || {
        let began = Instant::now();
        let mut motor = std::process::Command::new("sh")
            .args(["-c", "echo 10 > motors/M3/value"])
            .current_dir(&robot.root)
            .spawn()
            .expect("a shell");
        let mut slowest = Duration::ZERO;
        while motor.try_wait().expect("a child").is_none() {
            let start = Instant::now();
            assert_eq!(robot.errno("sensors/D1/value"), 0);
            slowest = slowest.max(start.elapsed());
        }
        assert!(
            began.elapsed() >= Duration::from_millis(250),
            "the bus was not slow"
        );
        slowest < Duration::from_millis(200)
    });
    robot.fault(&["i2c-2", "--clear"]);
}

#[test]
fn a_stuck_encoder_stands_still_while_the_other_turns() {
    let Some(robot) = robot(&[]) else { return };
    eventually("encoders", || robot.errno("encoders/E3/value") == 0);
    robot.fault(&["E3", "stuck"]);
    let list = robot.fault(&["--list"]);
    assert!(list.contains("in force: E3 stuck\n"), "{list}");
    // The fault is noticed within moments; what the wheel did until then is over when it stands.
    eventually("a fault in force", || {
        let before = robot.number("encoders/E3/value");
        robot.drive(30, 30);
        let other = robot.number("encoders/E4/value");
        eventually("the other wheel", || {
            robot.number("encoders/E4/value") > other + 100.0
        });
        robot.drive(0, 0);
        robot.number("encoders/E3/value") == before
    });
}
