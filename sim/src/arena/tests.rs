//! The arena against small programs that were run in the original, and against hostile worlds.

use lang_diagram::brick::{Brick, Command};
use lang_diagram::ports::Port;

use super::*;
use crate::field::{Sensor, Wall};
use crate::geometry::point;

fn port(name: &str) -> Port {
    Port::named(name).unwrap()
}

fn power(arena: &mut Arena, left: i32, right: i32) {
    for (motor, percent) in [("M4", left), ("M3", right)] {
        arena.robot(0).command(Command::Power {
            port: port(motor),
            percent,
        });
    }
}

/// Powers for so many ticks, then off; the arena stands still again afterwards.
fn drive(arena: &mut Arena, left: i32, right: i32, ticks: usize) {
    power(arena, left, right);
    for _ in 0..ticks {
        arena.tick();
    }
    power(arena, 0, 0);
    for _ in 0..3 {
        arena.tick();
    }
}

fn walled(x: f64) -> Field {
    Field {
        walls: vec![Wall::new(point(x, -200.0), point(x, 200.0))],
        ..Field::default()
    }
}

fn is_near(value: f64, expected: f64) {
    assert!((value - expected).abs() < 1e-4, "{value}, not {expected}");
}

#[test]
fn a_second_straight_on_and_on_the_spot_and_in_an_arc() {
    for (powers, x, y, degrees) in [
        ([100, 100], 76.7945, 0.0, 0.0),
        ([150, 150], 76.7945, 0.0, 0.0),
        ([100, -100], -29.0954, -5.1303, 200.0),
        ([100, 50], 45.2007, 35.0667, 50.0),
    ] {
        let mut arena = Arena::new(&Field::default(), Setup::default());
        drive(&mut arena, powers[0], powers[1], 100);
        let pose = arena.robots()[0].pose();
        is_near(pose.x, x);
        is_near(pose.y, y);
        is_near(pose.degrees, degrees);
    }
}

#[test]
fn encoders_count_550_degrees_in_a_second_and_only_those_of_wheels() {
    let mut arena = Arena::new(&Field::default(), Setup::default());
    arena.robot(0).command(Command::Power {
        port: port("M1"),
        percent: 100,
    });
    drive(&mut arena, 100, 100, 100);
    assert_eq!(arena.robot(0).scalar(port("E3")), Some(550));
    assert_eq!(arena.robot(0).scalar(port("E1")), Some(0));
    arena
        .robot(0)
        .command(Command::ResetEncoder { port: port("E3") });
    assert_eq!(arena.robot(0).scalar(port("E3")), Some(0));
}

#[test]
fn a_gyroscope_turns_over_at_180_degrees() {
    let mut arena = Arena::new(&Field::default(), Setup::default());
    drive(&mut arena, 100, -100, 100);
    let mut numbers = Vec::new();
    assert!(arena.robot(0).vector(port("GyroscopePort"), &mut numbers));
    assert_eq!(numbers[6], -160_000);
    arena.robot(0).command(Command::CalibrateGyroscope);
    numbers.clear();
    arena.robot(0).vector(port("GyroscopePort"), &mut numbers);
    assert_eq!(numbers[6], 0);
}

/// Four seconds against a wall at 200 px: the robot jitters at 144.4 px, and its encoder goes there and back.
#[test]
fn a_wall_takes_each_step_into_it_back() {
    let mut arena = Arena::new(&walled(200.0), Setup::default());
    drive(&mut arena, 100, 100, 400);
    let pose = arena.robots()[0].pose();
    assert!((143.6..145.2).contains(&pose.x), "{}", pose.x);
    let encoder = arena.robots()[0].encoder(port("E3"));
    assert!((encoder - 1039.0).abs() < 7.0, "{encoder}");
    let before = pose.x;
    drive(&mut arena, -100, -100, 10);
    assert!(arena.robots()[0].pose().x < before);
}

#[test]
fn a_sonar_stops_a_robot_where_the_recorded_one_stopped() {
    let mut field = walled(200.0);
    let mut robot = crate::field::Robot::default();
    let mut sonar = Sensor::new(port("D1"), SensorKind::Sonar);
    sonar.at = point(62.0, 25.0);
    robot.sensors.push(sonar);
    field.robots.push(robot);
    let mut arena = Arena::new(&field, Setup::default());
    assert_eq!(arena.robot(0).scalar(port("D1")), Some(47));
    assert_eq!(arena.robot(0).scalar(port("D2")), None);
    power(&mut arena, 100, 100);
    while arena.robot(0).scalar(port("D1")) >= Some(20) {
        arena.tick();
    }
    assert_eq!(arena.robot(0).scalar(port("D1")), Some(19));
    // Nearer than 19 cm to the face at 195: beyond x = 195 - 54.3 - 62.
    let x = arena.robots()[0].pose().x;
    assert!((78.7..79.5).contains(&x), "{x}");
}

#[test]
fn robots_send_each_other_messages_and_have_numbers_of_their_own() {
    let setup = Setup {
        others: vec![crate::field::Robot::default(); 2],
        ..Setup::default()
    };
    let mut arena = Arena::new(&Field::default(), setup);
    arena.robot(1).command(Command::Join {
        address: "",
        port: 0,
        hull: 7,
    });
    arena.robot(0).command(Command::Send {
        message: "all",
        hull: None,
    });
    arena.robot(0).command(Command::Send {
        message: "seven",
        hull: Some(7),
    });
    assert_eq!(arena.robot(0).mail(), None);
    assert_eq!(arena.robot(1).mail().as_deref(), Some("all"));
    assert_eq!(arena.robot(1).mail().as_deref(), Some("seven"));
    assert_eq!(arena.robot(2).mail().as_deref(), Some("all"));
    assert_eq!(arena.robot(2).mail(), None);
}

/// Only walls and things that can be pushed are solid there.
#[test]
fn robots_pass_through_each_other_in_ideal_physics_and_their_sensors_see_nobody() {
    let mut first = crate::field::Robot::default();
    let mut sonar = Sensor::new(port("D1"), SensorKind::Sonar);
    sonar.at = point(62.0, 25.0);
    first.sensors.push(sonar);
    let field = Field {
        robots: vec![first],
        ..Field::default()
    };
    let other = crate::field::Robot {
        position: point(100.0, 0.0),
        ..crate::field::Robot::default()
    };
    let setup = Setup {
        others: vec![other],
        ..Setup::default()
    };
    let mut arena = Arena::new(&field, setup);
    assert_eq!(arena.robot(0).scalar(port("D1")), Some(300));
    drive(&mut arena, 100, 100, 100);
    is_near(arena.robots()[0].pose().x, 76.7945);
    is_near(arena.robots()[1].pose().x, 100.0);
    assert!(!arena.robots()[0].is_stuck());
}

#[test]
fn keys_and_gamepads_are_what_a_person_makes_of_them() {
    let mut arena = Arena::new(&Field::default(), Setup::default());
    assert_eq!(arena.robot(0).scalar(port("Enter")), Some(0));
    arena.robot_mut(0).unwrap().press(28, true);
    assert_eq!(arena.robot(0).scalar(port("Enter")), Some(1));
    assert_eq!(arena.robot(0).scalar(port("GamepadWheelPort")), None);
    let mut gamepad = Gamepad {
        wheel: -30,
        ..Gamepad::default()
    };
    gamepad.pads[1] = Pad {
        x: 10,
        y: -20,
        is_pressed: true,
    };
    gamepad.buttons[2] = true;
    arena.robot_mut(0).unwrap().set_gamepad(Some(gamepad));
    for (name, value) in [
        ("GamepadWheelPort", -30),
        ("GamepadPad2PressedPort", 1),
        ("GamepadPad1PressedPort", 0),
        ("GamepadButton3Port", 1),
        ("GamepadButton1Port", 0),
        ("GamepadConnectionIndicatorPort", 1),
    ] {
        assert_eq!(arena.robot(0).scalar(port(name)), Some(value), "{name}");
    }
    let mut numbers = Vec::new();
    assert!(
        arena
            .robot(0)
            .vector(port("GamepadPad2PosPort"), &mut numbers)
    );
    assert_eq!(numbers, [10, -20]);
}

#[test]
fn a_wall_that_is_built_while_it_runs_stops_the_robot() {
    let mut arena = Arena::new(&Field::default(), Setup::default());
    power(&mut arena, 100, 100);
    for _ in 0..50 {
        arena.tick();
    }
    arena.edit(|field| {
        let wall = Wall::new(point(150.0, -200.0), point(150.0, 200.0));
        field.walls.push(wall);
    });
    for _ in 0..200 {
        arena.tick();
    }
    assert!(arena.robots()[0].pose().x < 96.0);
}

#[test]
fn noise_and_random_numbers_are_those_of_the_seed() {
    let mut field = Field::default();
    field.settings.realistic_motors = true;
    let end = |seed: u64| {
        let mut arena = Arena::new(
            &field,
            Setup {
                seed,
                ..Setup::default()
            },
        );
        drive(&mut arena, 90, 90, 100);
        let number = arena.robot(0).random(1, 1_000_000);
        (arena.robots()[0].pose(), number)
    };
    assert_eq!(end(1), end(1));
    assert_ne!(end(1), end(2));
    let mut arena = Arena::new(&field, Setup::default());
    for _ in 0..100 {
        assert!((3..=5).contains(&arena.robot(0).random(3, 5)));
        let whole = arena.robot(0).random(i32::MIN, i32::MAX);
        assert_eq!(arena.robots()[0].dice.last, whole);
    }
    arena.robot_mut(0).unwrap().dice.fixed = Some(42);
    assert_eq!(arena.robot(0).random(0, 10), 42);
}
