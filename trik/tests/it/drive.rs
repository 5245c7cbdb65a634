//! The robot moves and its sensors see it: from a write to a file of the tree to the room and back.
//!
//! The room is 3 m by 2 m; two-wheels starts at (0.8, 1.0) and looks along its longer side.

use crate::rig::{Robot, robot};
use harness::eventually;

/// A number of a node, once its device has something to say.
fn number(robot: &Robot, name: &str) -> f64 {
    eventually(name, || robot.errno(name) == 0);
    robot.number(name)
}

/// Waits until the left encoder has given the same number for a row of looks that take longer than many samples.
fn stands_still(robot: &Robot) {
    let (mut last, mut same) = (f64::NAN, 0);
    eventually("a standstill", || {
        let now = robot.number("encoders/E3/value");
        same = if now == last { same + 1 } else { 0 };
        last = now;
        same > 20
    });
}

#[test]
fn driving_forward_turns_both_encoders_forward_and_stop_stops() {
    let Some(robot) = robot(&[]) else { return };
    let before = [
        number(&robot, "encoders/E3/value"),
        number(&robot, "encoders/E4/value"),
    ];
    robot.drive(30, 30);
    eventually("both wheels have turned", || {
        robot.number("encoders/E3/value") > before[0] + 100.0
            && robot.number("encoders/E4/value") > before[1] + 100.0
    });
    robot.write("stop", "1").expect("stop");
    assert_eq!(
        (
            robot.duty(3).expect("the bus"),
            robot.duty(4).expect("the bus")
        ),
        (0, 0)
    );
    // The wheels run out.
    stands_still(&robot);
}

#[test]
fn an_encoder_is_reset_by_writing_0() {
    let Some(robot) = robot(&[]) else { return };
    robot.drive(30, 30);
    eventually("a turn", || number(&robot, "encoders/E3/value") > 200.0);
    robot.drive(0, 0);
    stands_still(&robot);
    robot.write("encoders/E3/value", "0").expect("a reset");
    eventually("zero", || robot.number("encoders/E3/value").abs() < 3.0);
}

#[test]
fn a_wall_stops_the_robot_and_both_distance_sensors_saw_it_come() {
    let Some(robot) = robot(&["--speed", "2"]) else {
        return;
    };
    let far = number(&robot, "sensors/D1/value");
    let infrared = number(&robot, "sensors/A1/value");
    // Both look forward from nearly the same place.
    assert!((far - infrared).abs() < 12.0, "{far} cm, {infrared} cm");
    assert_eq!(number(&robot, "sensors/A3/value"), 0.0);
    robot.drive(40, 40);
    eventually("the bumper", || robot.number("sensors/A3/value") == 1.0);
    let near = number(&robot, "sensors/D1/value");
    assert!(near < far - 10.0 && near < 15.0, "{near} cm after {far} cm");
}

#[test]
fn turning_on_the_spot_is_seen_by_encoders_and_gyroscope() {
    let Some(robot) = robot(&[]) else { return };
    // It measures its bias first, while the robot stands still.
    eventually("a calibrated gyroscope", || {
        robot.errno("gyroscope/value") == 0 && robot.errno("gyroscope/heading") == 0
    });
    robot.drive(-20, 20);
    // Counter-clockwise, around the axis that points up.
    eventually("a turn to the left", || {
        robot.numbers("gyroscope/value")[2].abs() > 20_000.0
    });
    eventually("wheels in opposite directions", || {
        robot.number("encoders/E3/value") < -100.0 && robot.number("encoders/E4/value") > 100.0
    });
    let left = robot.numbers("gyroscope/value")[2];
    let heading = number(&robot, "gyroscope/heading");
    eventually("20 degrees more", || {
        (number(&robot, "gyroscope/heading") - heading).abs() > 20_000.0
    });
    robot.drive(20, -20);
    eventually("a turn to the right", || {
        let now = robot.numbers("gyroscope/value")[2];
        now.abs() > 20_000.0 && now.signum() == -left.signum()
    });
}

#[test]
fn a_servo_gets_its_pulse_and_none_at_the_end() {
    let Some(robot) = robot(&[]) else { return };
    let attribute = |name: &str| {
        let path = robot.devices.join("sys/class/pwm/pwmchip2/pwm0").join(name);
        std::fs::read_to_string(path).expect(name).trim().to_owned()
    };
    robot.write("servos/S1/value", "0").expect("the middle");
    assert_eq!(
        (attribute("duty_cycle"), attribute("enable")),
        ("1425000".into(), "1".into())
    );
    robot.write("servos/S1/value", "90").expect("one end");
    assert_eq!(attribute("duty_cycle"), "2150000");
    assert_eq!(attribute("period"), "20000000");
    robot.write("stop", "1").expect("stop");
    assert_eq!(attribute("enable"), "0");
}

#[test]
fn the_light_shines() {
    let Some(robot) = robot(&[]) else { return };
    robot.write("led/red/value", "1").expect("red");
    let brightness = robot.devices.join("sys/class/leds/led_red/brightness");
    assert_eq!(
        std::fs::read_to_string(brightness).expect("a light").trim(),
        "1"
    );
    assert_eq!(number(&robot, "led/red/value"), 1.0);
}

#[test]
fn battery_and_accelerometer_have_values_in_physical_units() {
    let Some(robot) = robot(&[]) else { return };
    let volts = number(&robot, "battery/value");
    assert!((11.0..13.0).contains(&volts), "{volts} V");
    let gravity = "accelerometer/value";
    eventually(gravity, || robot.errno(gravity) == 0);
    assert_eq!(robot.read("accelerometer/units").expect("a unit"), "mg");
    let all = robot.numbers(gravity);
    assert!((950.0..1050.0).contains(&all[2]), "{all:?}");
    assert!(all[0].abs() < 50.0 && all[1].abs() < 50.0, "{all:?}");
}

#[test]
fn a_pressed_key_is_seen_until_it_is_released() {
    let Some(robot) = robot(&[]) else { return };
    let press = |words: &str| {
        let control = robot.devices.join("control/keys");
        std::fs::write(control, format!("{words}\n")).expect("keys");
    };
    let pressed = || {
        let names = robot.read("keys/format").expect("names");
        let place = names.split(", ").position(|name| name.ends_with(" up"));
        robot.numbers("keys/value")[place.expect("a key UP")]
    };
    eventually("keys", || robot.errno("keys/value") == 0);
    assert_eq!(pressed(), 0.0);
    press("press up");
    eventually("a pressed key", || pressed() == 1.0);
    press("release up");
    eventually("a released key", || pressed() == 0.0);
}

#[test]
fn the_line_sensor_starts_when_it_is_read_and_stops_afterwards() {
    let Some(robot) = robot(&[]) else { return };
    let fifo = robot.devices.join("run/line-sensor.out.fifo");
    assert!(!fifo.exists());
    let output = robot.sh("head -c 12 camera/line/device | wc -c");
    assert_eq!(output.good().trim(), "12");
    eventually("the end of the sensor", || !fifo.exists());
}

#[test]
fn a_write_out_of_range_is_refused_and_moves_nothing() {
    let Some(robot) = robot(&[]) else { return };
    assert!(robot.write("motors/M3/value", "300").is_err());
    assert!(robot.write("motors/M3/value", "fast").is_err());
    assert_eq!(robot.duty(3).expect("the bus"), 0);
}

#[test]
fn a_motor_reads_what_was_written_until_it_rests() {
    let Some(robot) = robot(&[]) else { return };
    // 30 and 27 percent of the greatest speed have the same duty.
    for power in ["30", "27", "-30", "127"] {
        robot.write("motors/M3/value", power).expect("a motor");
        assert_eq!(robot.read("motors/left/value").expect("a number"), power);
    }
    robot.write("motors/M3/value", "30").expect("a motor");
    robot.write("motors/M3/brake", "1").expect("a brake");
    assert_eq!(robot.number("motors/M3/value"), 127.0);
    robot.write("motors/M3/value", "30").expect("a motor");
    robot.write("stop", "1").expect("stop");
    assert_eq!(robot.number("motors/M3/value"), 0.0);
}

#[test]
fn a_mistake_of_the_caller_is_no_fault_of_the_motor() {
    let Some(robot) = robot(&[]) else { return };
    let refused = robot.write("motors/left/value", "200").expect_err("200 %");
    assert_eq!(refused.raw_os_error(), Some(libc::ERANGE));
    assert_eq!(robot.read("motors/left/fault").expect("a text"), "");
    let reason = "motors/M3: caller: duty_cycle is -100 to 100, not 200";
    let log = robot.log();
    assert!(log.contains(reason), "{log}");
}

#[test]
fn the_line_follower_stands_over_its_line_and_sees_it() {
    let Some(robot) = robot(&["--robot", "line-follower"]) else {
        return;
    };
    // White on both sides of a line that the camera has before it.
    for sensor in ["sensors/floor_left/value", "sensors/floor_right/value"] {
        assert!(number(&robot, sensor) < 30.0, "{sensor}");
    }
    let line = robot.numbers("camera/line/value");
    assert!(line[0].abs() < 20.0 && line[2] > 5.0, "{line:?}");
    robot.drive(30, 30);
    let way = number(&robot, "encoders/left/value");
    eventually("a drive", || {
        robot.number("encoders/left/value") > way + 100.0
    });
}

#[test]
fn the_colour_that_was_measured_is_there_for_who_reads_later() {
    let Some(robot) = robot(&["--robot", "line-follower"]) else {
        return;
    };
    let output = robot.sh("set -e
cat camera/line/device > /dev/null & reader=$!
cat camera/line/value > /dev/null
echo 1 > camera/line/detect
cat camera/line/hsv camera/line/hsv
kill $reader; wait $reader || :
cat camera/line/hsv");
    let said = output.good();
    let lines: Vec<&str> = said.lines().collect();
    assert_eq!(lines.len(), 3, "{said}");
    assert_eq!(lines[0].split(' ').count(), 6, "{said}");
    assert!(lines.iter().all(|line| *line == lines[0]), "{said}");
}

#[test]
fn a_tone_is_played_and_one_that_nobody_hears_is_refused() {
    let Some(robot) = robot(&[]) else { return };
    robot.write("sound/tone/value", "440 500").expect("a tone");
    robot
        .write("sound/tone/value1", "100")
        .expect("a shorter one");
    for wrong in ["-440 500", "440 20000", "440", "440 500 1", "a b"] {
        assert!(robot.write("sound/tone/value", wrong).is_err(), "{wrong}");
    }
    assert!(robot.read("sound/tone/value").is_err());
    assert_eq!(robot.read("sound/tone/fault").expect("a text"), "");
}

#[test]
fn a_servo_port_measures_pulses_if_the_robot_file_says_so() {
    let Some(home) = crate::rig::Home::new() else {
        return;
    };
    let text = "local trik = include 'trik.lua'\ntrikfs = trik.robot { { port = 'S1', type = 'pwmCapture', name = 'receiver' } }\n";
    home.0.file("robot.lua", text);
    let robot = Robot::start(std::sync::Arc::new(home), &["--config", "robot.lua"]);
    assert_eq!(robot.errno("servos/receiver/value"), libc::ETIMEDOUT);
    let fault = robot.read("servos/S1/fault").expect("a text");
    assert_eq!(fault, "device: no pulses");
    let control = robot.devices.join("control/pulses/S1");
    std::fs::write(control, "50 7\n").expect("pulses");
    eventually("pulses", || {
        robot.read("servos/S1/value").is_ok_and(|hz| hz == "50")
    });
    eventually("a duty", || {
        robot
            .read("servos/S1/duty_cycle")
            .is_ok_and(|duty| duty == "7")
    });
    assert_eq!(robot.numbers("servos/S1/raw"), [50.0; 3]);
    assert_eq!(robot.errno("servos/S2/value"), libc::EIO, "that is a servo");
}
