//! The view of ev3dev: motors, sensors and lights by the files that libraries of ev3dev know, with plain file operations.
//!
//! Judged by what the coprocessor of the virtual board has: the byte of a motor, the ticks of an encoder.

/// Its processes, and a tree that goes and comes back.
mod life;
/// The public library.
mod python;

use crate::rig::{Robot, robot};
use harness::eventually;
use harness::wait::SOON;
use std::fs::{self, File};
use std::io::{self, Read, Seek, Write};
use std::os::fd::AsFd;
use std::os::unix::fs::PermissionsExt;
use std::path::PathBuf;
use std::time::Instant;

const LEFT: &str = "tacho-motor/motor2";
const RIGHT: &str = "tacho-motor/motor3";

/// A view, wherever it is.
struct View(PathBuf);

impl View {
    /// That of a robot which was started with `--ev3dev`.
    fn of(robot: &Robot) -> Self {
        Self(robot.root.with_extension("ev3dev"))
    }

    fn read(&self, name: &str) -> io::Result<String> {
        fs::read_to_string(self.0.join(name)).map(|text| text.trim_end().to_owned())
    }

    fn text(&self, name: &str) -> String {
        self.read(name)
            .unwrap_or_else(|error| panic!("{name}: {error}"))
    }

    fn number(&self, name: &str) -> i32 {
        let text = self.text(name);
        text.parse().unwrap_or_else(|_| panic!("{name}: {text:?}"))
    }

    fn try_write(&self, name: &str, text: &str) -> io::Result<()> {
        let mut file = File::options().write(true).open(self.0.join(name))?;
        file.write_all(text.as_bytes())
    }

    fn write(&self, name: &str, text: &str) {
        self.try_write(name, text)
            .unwrap_or_else(|error| panic!("{text} to {name}: {error}"));
    }

    fn errno_of_read(&self, name: &str) -> i32 {
        errno(self.read(name).map(drop))
    }

    fn errno_of_write(&self, name: &str, text: &str) -> i32 {
        errno(self.try_write(name, text))
    }

    /// Setpoints, then a command.
    fn run(&self, motor: &str, setpoints: &[(&str, i32)], command: &str) {
        for (name, value) in setpoints {
            self.write(&format!("{motor}/{name}"), &value.to_string());
        }
        self.write(&format!("{motor}/command"), command);
    }

    fn state(&self, motor: &str) -> String {
        self.text(&format!("{motor}/state"))
    }

    fn until_done(&self, motor: &str) {
        eventually("the end of the run", || {
            !self.state(motor).contains("running")
        });
    }

    /// Waits until a shaft stands.
    fn until_still(&self, motor: &str) {
        eventually("a shaft that stands", || {
            self.number(&format!("{motor}/speed")) == 0
        });
    }
}

fn errno(result: io::Result<()>) -> i32 {
    result
        .err()
        .map_or(0, |error| error.raw_os_error().unwrap_or(-1))
}

fn seen() -> Option<(Robot, View)> {
    let robot = robot(&["--ev3dev"])?;
    let view = View::of(&robot);
    Some((robot, view))
}

#[test]
fn every_class_has_its_devices_with_the_modes_that_libraries_look_at() {
    let Some((_robot, view)) = seen() else { return };
    let list = |class: &str| {
        let entries = fs::read_dir(view.0.join(class)).expect(class);
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        let mut names: Vec<_> = names.collect();
        names.sort();
        names
    };
    assert_eq!(
        list(""),
        [
            "board-info",
            "dc-motor",
            "leds",
            "lego-sensor",
            "power_supply",
            "servo-motor",
            "tacho-motor"
        ]
    );
    assert_eq!(
        list("tacho-motor"),
        ["motor0", "motor1", "motor2", "motor3"]
    );
    assert_eq!((list("lego-sensor").len(), list("dc-motor").len()), (11, 0));
    assert_eq!(view.text("tacho-motor/motor2/address"), "ev3-ports:outC:M3");
    for (name, mode) in [("command", 0o220), ("state", 0o444), ("position", 0o664)] {
        let found = fs::metadata(view.0.join(LEFT).join(name)).unwrap();
        assert_eq!(found.permissions().mode() & 0o7777, mode, "{name}");
        assert_eq!(found.len(), 4096);
    }
    assert_eq!(view.errno_of_read(&format!("{LEFT}/command")), libc::EACCES);
    assert_eq!(
        view.errno_of_write(&format!("{LEFT}/state"), "x"),
        libc::EACCES
    );
    assert_eq!(view.errno_of_read("tacho-motor/motor9/state"), libc::ENOENT);
    assert!(
        fs::create_dir(view.0.join("x")).is_err()
            && fs::remove_file(view.0.join(LEFT).join("state")).is_err()
    );
}

#[test]
fn text_is_read_anew_from_the_start_and_rubbish_is_refused() {
    let Some((_robot, view)) = seen() else { return };
    let path = view.0.join(LEFT).join("speed_sp");
    let mut file = File::options().read(true).write(true).open(path).unwrap();
    let mut text = String::new();
    for speed in ["300", "-45"] {
        file.rewind().unwrap();
        file.write_all(speed.as_bytes()).unwrap();
        file.rewind().unwrap();
        text.clear();
        file.read_to_string(&mut text).unwrap();
        assert_eq!(text, format!("{speed}\n"));
    }
    for (name, bad) in [
        ("speed_sp", "fast"),
        ("speed_sp", "1001"),
        ("speed_sp", "10 20"),
        ("duty_cycle_sp", "-101"),
        ("position_sp", "0x10"),
        ("time_sp", "-5"),
        ("ramp_up_sp", "60001"),
        ("stop_action", "explode"),
        ("polarity", "sideways"),
        ("command", "fly"),
        ("hold_pid/Kp", "much"),
    ] {
        let name = format!("{LEFT}/{name}");
        assert_eq!(
            view.errno_of_write(&name, bad),
            libc::EINVAL,
            "{name} {bad}"
        );
    }
    assert_eq!(
        view.errno_of_write(&format!("{LEFT}/position_sp"), "99999999999"),
        libc::ERANGE
    );
    let long = "1".repeat(100_000);
    assert_eq!(
        view.errno_of_write(&format!("{LEFT}/speed_sp"), &long),
        libc::EINVAL
    );
    assert_eq!(view.number(&format!("{LEFT}/speed_sp")), -45);
    assert_eq!(view.state(LEFT), "");
}

#[test]
fn a_motor_runs_at_its_speed_and_stops_as_it_was_told() {
    let Some((robot, view)) = seen() else { return };
    let at = |name: &str| format!("{LEFT}/{name}");
    view.run(LEFT, &[("speed_sp", 400)], "run-forever");
    assert_eq!(view.state(LEFT), "running");
    // On a busy machine the loop that holds the speed is late now and then.
    eventually("the speed, with the power for it", || {
        let (speed, power) = (view.number(&at("speed")), view.number(&at("duty_cycle")));
        (380..=420).contains(&speed) && (20..50).contains(&power)
    });
    assert_ne!(robot.duty(3).unwrap(), 0);
    view.write(&at("stop_action"), "brake");
    view.write(&at("command"), "stop");
    assert_eq!(
        (view.state(LEFT).as_str(), robot.duty(3).unwrap()),
        ("", 127)
    );
    view.until_still(LEFT);
    view.run(LEFT, &[("duty_cycle_sp", -40)], "run-direct");
    let power = |wanted: f64| {
        // The tree reads the least power that has the same duty.
        let found = robot.number("motors/M3/value") / wanted;
        (0.9..=1.0).contains(&found)
    };
    assert!(power(-40.0));
    view.write(&at("duty_cycle_sp"), "-60");
    eventually("the new power", || power(-60.0));
    view.write(&at("stop_action"), "coast");
    view.write(&at("command"), "stop");
    assert_eq!(robot.duty(3).unwrap(), 0);
    // Without regulation it also has run out by itself when the encoder is as often sampled as before.
    eventually("the usual period", || {
        robot.number("encoders/E3/poll_ms") == 20.0
    });
}

#[test]
fn positions_are_reached_by_the_ticks_of_the_encoder() {
    let Some((robot, view)) = seen() else { return };
    // Held, so a swing at the end of the move is soon over.
    let near = |encoder: u8, wanted: f64| {
        eventually(&format!("E{encoder} at {wanted}"), || {
            (robot.turned_deg(encoder) - wanted).abs() < 3.0
        });
    };
    view.write(&format!("{LEFT}/stop_action"), "hold");
    view.run(
        LEFT,
        &[("speed_sp", 600), ("position_sp", 360)],
        "run-to-rel-pos",
    );
    view.until_done(LEFT);
    assert_eq!(view.state(LEFT), "holding");
    near(3, 360.0);
    view.run(LEFT, &[("position_sp", -90)], "run-to-abs-pos");
    view.until_done(LEFT);
    near(3, -90.0);
    view.write(&format!("{LEFT}/position"), "1000");
    assert!((view.number(&format!("{LEFT}/position")) - 1000).abs() <= 3);
    view.run(LEFT, &[("position_sp", 1090)], "run-to-abs-pos");
    view.until_done(LEFT);
    near(3, 0.0);
    // Backwards by name, so the same wheel turns the other way.
    view.write(&format!("{RIGHT}/polarity"), "inversed");
    view.write(&format!("{RIGHT}/stop_action"), "hold");
    view.run(
        RIGHT,
        &[("speed_sp", 500), ("position_sp", 180)],
        "run-to-rel-pos",
    );
    view.until_done(RIGHT);
    near(4, -180.0);
    assert!((view.number(&format!("{RIGHT}/position")) - 180).abs() <= 3);
    for motor in [LEFT, RIGHT] {
        // What still turns when it is reset goes on a little after it.
        view.until_still(motor);
        view.write(&format!("{motor}/command"), "reset");
        assert_eq!(view.text(&format!("{motor}/stop_action")), "coast");
        assert_eq!(view.text(&format!("{motor}/polarity")), "normal");
        assert_eq!(view.number(&format!("{motor}/position_sp")), 0);
        view.until_still(motor);
        assert!(view.number(&format!("{motor}/position")).abs() <= 3);
    }
    assert_eq!((robot.duty(3).unwrap(), robot.duty(4).unwrap()), (0, 0));
}

#[test]
fn a_timed_run_ends_by_itself_and_ramps_are_told() {
    let Some((robot, view)) = seen() else { return };
    // Long enough to be seen on a busy machine.
    view.run(LEFT, &[("speed_sp", 500), ("time_sp", 4000)], "run-timed");
    assert_eq!(view.state(LEFT), "running");
    view.until_done(LEFT);
    assert!(robot.turned_deg(3) > 50.0);
    assert_eq!(robot.duty(3).unwrap(), 0);
    // A ramp begins at the speed of the shaft: one that still runs out would have none.
    view.until_still(LEFT);
    view.run(
        LEFT,
        &[("ramp_up_sp", 8000), ("ramp_down_sp", 8000)],
        "run-forever",
    );
    // Its next tick begins the ramp.
    eventually("the ramp up", || view.state(LEFT) == "running ramping");
    eventually("the end of the ramp", || view.state(LEFT) == "running");
    view.write(&format!("{LEFT}/command"), "stop");
    // Its next tick begins the ramp.
    eventually("the ramp down", || view.state(LEFT) == "running ramping");
    view.until_done(LEFT);
}

#[test]
fn a_motor_that_cannot_turn_is_stalled_until_it_can() {
    let Some((robot, view)) = seen() else { return };
    robot.fault(&["M3", "stuck"]);
    view.run(LEFT, &[("speed_sp", 500)], "run-forever");
    eventually("stalled", || view.state(LEFT).contains("stalled"));
    robot.fault(&["M3", "--clear"]);
    eventually("running freely", || view.state(LEFT) == "running");
}

#[test]
fn a_bus_that_fails_now_and_then_is_borne_and_a_dead_one_lets_the_motor_go() {
    let Some((robot, view)) = seen() else { return };
    view.run(LEFT, &[("speed_sp", 400)], "run-forever");
    robot.fault(&["msp430", "nack", "0.3"]);
    let from = robot.turned_deg(3);
    eventually("a long way", || robot.turned_deg(3) - from > 400.0);
    assert_eq!(view.state(LEFT), "running");
    robot.fault(&["msp430", "unplug"]);
    eventually("a motor that is let go", || view.state(LEFT).is_empty());
    assert!(view.text(&format!("{LEFT}/fault")).contains("3/value"));
    // The coprocessor has kept the power that it got last.
    robot.fault(&["msp430", "--clear"]);
    eventually("rest", || robot.duty(3).unwrap() == 0);
    view.write(&format!("{LEFT}/command"), "run-forever");
    assert_eq!(view.text(&format!("{LEFT}/fault")), "");
}

#[test]
fn another_configuration_brings_other_devices() {
    let Some((robot, view)) = seen() else { return };
    let mut old = File::open(view.0.join("lego-sensor/sensor0/value0")).unwrap();
    assert!(old.read(&mut [0; 16]).is_ok());
    let config = fs::read_to_string(robot.path("config")).unwrap();
    let changed = config.replace("sharpGP2", "touch");
    assert_ne!(config, changed);
    fs::write(robot.path("config"), changed).unwrap();
    eventually("the new sensor", || {
        let driver = view.read("lego-sensor/sensor11/driver_name");
        driver.is_ok_and(|driver| driver == "lego-ev3-touch")
    });
    // The kernel keeps the name for a moment.
    eventually("the end of the old one", || {
        !view.0.join("lego-sensor/sensor0").exists()
    });
    assert_eq!(
        errno(old.rewind().and_then(|()| old.read(&mut [0; 16]).map(drop))),
        libc::ENODEV
    );
    // What has not changed is the same.
    assert_eq!(
        view.text("lego-sensor/sensor2/driver_name"),
        "lego-ev3-touch"
    );
}

/// Waits for POLLPRI as a library does; gives the events.
fn poll_pri(file: &File) -> nix::poll::PollFlags {
    use nix::poll::{PollFd, PollFlags, PollTimeout, poll};
    let mut watched = [PollFd::new(file.as_fd(), PollFlags::POLLPRI)];
    let patience = PollTimeout::try_from(SOON).expect("a timeout");
    poll(&mut watched, patience).expect("poll");
    watched[0].revents().expect("events")
}

#[test]
fn who_polls_the_state_is_woken_when_it_changes_and_not_before() {
    use nix::poll::PollFlags;
    let Some((_robot, view)) = seen() else { return };
    let mut file = File::open(view.0.join(LEFT).join("state")).unwrap();
    let read = |file: &mut File| {
        let mut text = String::new();
        file.rewind().unwrap();
        file.read_to_string(&mut text).unwrap();
        text.trim_end().to_owned()
    };
    assert!(
        poll_pri(&file).contains(PollFlags::POLLPRI),
        "nothing was read yet"
    );
    assert_eq!(read(&mut file), "");
    let mut watched = [nix::poll::PollFd::new(file.as_fd(), PollFlags::POLLPRI)];
    assert_eq!(
        nix::poll::poll(&mut watched, 0_u8),
        Ok(0),
        "nothing has changed"
    );
    let start = Instant::now();
    view.run(LEFT, &[("speed_sp", 300), ("time_sp", 4000)], "run-timed");
    assert!(poll_pri(&file).contains(PollFlags::POLLPRI | PollFlags::POLLERR));
    assert_eq!(read(&mut file), "running");
    // Woken by the end of the run, long before the time limit of the call.
    assert!(poll_pri(&file).contains(PollFlags::POLLPRI));
    assert_eq!(read(&mut file), "");
    assert!(start.elapsed() < SOON);
}

#[test]
fn sensors_lights_servos_and_battery_show_what_the_board_has() {
    let Some((robot, view)) = seen() else { return };
    let sensor = |driver: &str| {
        let find =
            |number: &u32| view.text(&format!("lego-sensor/sensor{number}/driver_name")) == driver;
        let number = (0..11).find(find).unwrap_or_else(|| panic!("no {driver}"));
        format!("lego-sensor/sensor{number}")
    };
    let us = sensor("lego-ev3-us");
    assert_eq!(view.text(&format!("{us}/mode")), "US-DIST-CM");
    let cm = robot.number("sensors/D1/value");
    assert!((f64::from(view.number(&format!("{us}/value0"))) / 10.0 - cm).abs() <= 2.0);
    assert_eq!(view.errno_of_read(&format!("{us}/value1")), libc::ENODEV);
    view.write(&format!("{us}/mode"), "US-DIST-IN\n");
    assert!((f64::from(view.number(&format!("{us}/value0"))) * 0.254 - cm).abs() <= 2.0);
    assert_eq!(
        view.errno_of_write(&format!("{us}/mode"), "US-LISTEN"),
        libc::EINVAL
    );
    robot.fault(&["D1", "unplug"]);
    eventually("the plug", || {
        view.errno_of_read(&format!("{us}/value0")) == libc::ENODEV
    });
    robot.fault(&["D1", "--clear"]);
    eventually("the sensor again", || {
        view.read(&format!("{us}/value0")).is_ok()
    });
    assert_eq!(
        view.number(&format!("{}/value0", sensor("lego-ev3-touch"))),
        0
    );
    assert!(view.number(&format!("{}/value0", sensor("lego-ev3-color"))) > 80);
    view.write("leds/led0:red:brick-status/brightness", "1");
    assert_eq!(robot.number("led/red/value"), 1.0);
    assert_eq!(view.number("leds/led1:red:brick-status/brightness"), 1);
    let volts = f64::from(view.number("power_supply/trik-battery/voltage_now")) / 1e6;
    assert!((volts - robot.number("battery/value")).abs() < 0.2);
    let servo = "servo-motor/motor0";
    assert_eq!(view.text(&format!("{servo}/state")), "");
    view.write(&format!("{servo}/position_sp"), "50");
    assert_eq!(view.text(&format!("{servo}/state")), "");
    view.write(&format!("{servo}/command"), "run");
    assert_eq!(
        (
            robot.number("servos/S1/value"),
            view.text(&format!("{servo}/state"))
        ),
        (45.0, "running".to_owned())
    );
    view.write(&format!("{servo}/position_sp"), "-100");
    assert_eq!(robot.number("servos/S1/value"), -90.0);
    view.write(&format!("{servo}/command"), "float");
    assert_eq!(robot.number("servos/S1/power"), 0.0);
    // The gripper on S6 has no place for less than 0.
    let gripper = "servo-motor/motor5";
    view.write(&format!("{gripper}/position_sp"), "-10");
    assert_eq!(
        view.errno_of_write(&format!("{gripper}/command"), "run"),
        libc::EINVAL
    );
}

#[test]
fn the_gyroscope_turns_clockwise_as_the_robot_does() {
    let Some((robot, view)) = seen() else { return };
    let gyro = "lego-sensor/sensor9";
    assert_eq!(view.text(&format!("{gyro}/driver_name")), "lego-ev3-gyro");
    let mut angle = File::open(view.0.join(gyro).join("value0")).unwrap();
    let mut value = || -> Option<i32> {
        let mut text = String::new();
        angle.rewind().ok()?;
        angle.read_to_string(&mut text).ok()?;
        text.trim_end().parse().ok()
    };
    // Rates and angles calibrate each for themselves, while it stands.
    eventually("the calibration", || {
        value().is_some() && robot.errno("gyroscope/value") == 0
    });
    let start = value().expect("an angle");
    // On the spot: the left wheel forwards is clockwise. More than a whole turn, slowly enough to follow.
    for (motor, way) in [(LEFT, 1200), (RIGHT, -1200)] {
        view.write(&format!("{motor}/stop_action"), "hold");
        view.run(
            motor,
            &[("speed_sp", 400), ("position_sp", way)],
            "run-to-rel-pos",
        );
    }
    eventually("the end of the turn", || {
        value();
        !view.state(LEFT).contains("running") && !view.state(RIGHT).contains("running")
    });
    // Wheels of 28 mm, 155 mm apart.
    let turned = (robot.turned_deg(3) - robot.turned_deg(4)) * 28.0 / 155.0;
    assert!(turned > 400.0, "{turned}");
    eventually("the whole angle", || {
        value().is_some_and(|now| (f64::from(now - start) - turned).abs() < 8.0)
    });
    view.write(&format!("{gyro}/mode"), "GYRO-RATE");
    for (motor, power) in [(LEFT, 20), (RIGHT, -20)] {
        view.run(motor, &[("duty_cycle_sp", power)], "run-direct");
    }
    eventually("a rate", || value().is_some_and(|rate| rate > 20));
}
