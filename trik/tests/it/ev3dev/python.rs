//! The public library python-ev3dev2 drives the robot; what came of it is judged by the coprocessor of the board.
//!
//! Needs that library: `TRIK_EV3DEV_PYTHON` names a python that has it, else `python3` is asked. Without it the test is
//! skipped by name, or fails with `TRIK_REQUIRE_EV3DEV=1`.

use super::{View, seen};
use harness::tools;
use harness::wait::LIFE;
use needs::Need;
use std::process::Command;

/// What every program begins with.
const PRELUDE: &str = "\
import os, sys
import ev3dev2
ev3dev2.Device.DEVICE_ROOT_PATH = sys.argv[1]
from ev3dev2.motor import *
from ev3dev2.sensor import *
from ev3dev2.sensor.lego import *
";

fn python() -> Option<String> {
    let python = std::env::var("TRIK_EV3DEV_PYTHON").unwrap_or_else(|_| "python3".to_owned());
    let mut command = Command::new(&python);
    if tools::run(command.args(["-c", "import ev3dev2.motor"]), b"").code() == 0 {
        return Some(python);
    }
    Need::Ev3dev.missing(format_args!("{python} has no python-ev3dev2"));
    None
}

/// Runs a program to its good end; gives what it printed.
fn program(python: &str, view: &View, text: &str) -> String {
    let mut command = Command::new(python);
    command
        .args(["-c", &format!("{PRELUDE}{text}")])
        .arg(&view.0);
    tools::run_within(&mut command, b"", LIFE).good()
}

#[test]
fn a_large_motor_turns_by_degrees_and_for_seconds() {
    let Some(python) = python() else { return };
    let Some((robot, view)) = seen() else { return };
    let said = program(
        &python,
        &view,
        "
m = LargeMotor(OUTPUT_C)
m.reset()
m.on_for_degrees(40, 90)
print(m.is_holding, m.degrees)
m.on_for_rotations(SpeedRPM(60), -2)
print(m.is_holding)
try:
    m.on(SpeedDPS(20000))
except ValueError:
    print('refused')
try:
    m.speed_sp = 20000
except ValueError:
    print('refused')
",
    );
    // It is held there, so a swing at the end of the move is soon over.
    harness::eventually("the place", || {
        (robot.turned_deg(3) - (90.0 - 720.0)).abs() < 3.0
    });
    let turned = robot.turned_deg(3);
    assert!(
        said.starts_with("True ") && said.ends_with("True\nrefused\nrefused\n"),
        "{said}"
    );
    // It is held on after the program.
    assert_eq!(view.state("tacho-motor/motor2"), "holding");
    let said = program(
        &python,
        &view,
        "
m = LargeMotor('M3')
start = m.position
m.on_for_seconds(SpeedPercent(30), 0.5, brake=False)
print(m.state)
m.on_for_degrees(20, 400, block=False)
m.wait_until('running')
print(m.wait_until_not_moving(timeout=20000))
m.off(brake=False)
",
    );
    assert_eq!(said, "[]\nTrue\n");
    assert!(robot.turned_deg(3) > turned + 60.0);
    assert_eq!(robot.duty(3).unwrap(), 0);
}

#[test]
fn a_tank_drives_straight_and_turns_on_the_spot() {
    let Some(python) = python() else { return };
    let Some((robot, view)) = seen() else { return };
    // It calibrates while it stands.
    harness::eventually("the gyroscope", || robot.errno("gyroscope/heading") == 0);
    let cm = robot.number("sensors/D1/value");
    program(
        &python,
        &view,
        "
tank = MoveTank(OUTPUT_C, OUTPUT_D)
tank.on_for_rotations(40, 40, 1)
",
    );
    let both = || (robot.turned_deg(3), robot.turned_deg(4));
    harness::eventually("a turn of both wheels", || {
        let (left, right) = both();
        (left - 360.0).abs() < 3.0 && (right - 360.0).abs() < 3.0
    });
    let (left, right) = both();
    // A turn of a wheel of 28 mm is 17.6 cm.
    harness::eventually("a wall that is nearer", || {
        (cm - robot.number("sensors/D1/value") - 17.6).abs() < 3.0
    });
    let said = program(
        &python,
        &view,
        "
g = GyroSensor()
g.reset()
tank = MoveTank(OUTPUT_C, OUTPUT_D)
tank.on_for_degrees(20, -20, 249)
print(g.angle)
tank.off(brake=False)
",
    );
    // 249 degrees of wheels 155 mm apart.
    let turned = (robot.turned_deg(3) - left - robot.turned_deg(4) + right) * 28.0 / 155.0;
    assert!((turned - 90.0).abs() < 3.0, "{turned}");
    let angle: f64 = said.trim().parse().expect("an angle");
    assert!((angle - turned).abs() < 8.0, "{angle} for {turned}");
}

#[test]
fn sensors_lights_and_battery_are_found_and_say_the_truth() {
    let Some(python) = python() else { return };
    let Some((robot, view)) = seen() else { return };
    let said = program(
        &python,
        &view,
        "
from ev3dev2._platform import fake
fake.LEDS.update(red='led0:red:brick-status', green='led0:green:brick-status')
fake.LED_GROUPS['LEFT'] = ('red', 'green')
fake.LED_COLORS.update(RED=(1, 0), BLACK=(0, 0))
from ev3dev2.led import Leds
from ev3dev2.power import PowerSupply
leds = Leds()
leds.set_color('LEFT', 'RED')
print(UltrasonicSensor('D1').distance_centimeters)
print(InfraredSensor(INPUT_1).proximity)
print(ColorSensor('in5').reflected_light_intensity)
print(TouchSensor().is_pressed)
print(PowerSupply().measured_volts)
servo = ServoMotor('S1')
servo.run(position_sp=50)
print(servo.state)
",
    );
    let words: Vec<&str> = said.lines().collect();
    let number = |index: usize| -> f64 { words[index].parse().expect("a number") };
    assert!(
        (number(0) - robot.number("sensors/D1/value")).abs() <= 2.0,
        "{said}"
    );
    let proximity = robot.number("sensors/A1/value") / 0.7;
    assert!((number(1) - proximity.min(100.0)).abs() <= 4.0, "{said}");
    assert!(
        (number(2) - (100.0 - robot.number("sensors/A5/value"))).abs() <= 4.0,
        "{said}"
    );
    assert_eq!((words[3], words[5]), ("0", "['running']"));
    assert!(
        (number(4) - robot.number("battery/value")).abs() < 0.2,
        "{said}"
    );
    assert_eq!(
        (
            robot.number("led/red/value"),
            robot.number("led/green/value")
        ),
        (1.0, 0.0)
    );
    assert_eq!(robot.number("servos/S1/value"), 45.0);
}
