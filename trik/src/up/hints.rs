//! What to try first with each robot, as commands for a shell.
//!
//! Owns the texts; a test runs each of them on its robot.

use lang_diagram::ports::Port;
use sim::field::{Field, SensorKind};

/// A command for the directory of the tree, and what it does.
type Hint = (String, &'static str);

/// Commands for a robot, or for that of a world.
pub(super) fn of(robot: &str, world: Option<&Field>) -> Vec<Hint> {
    if let Some(field) = world {
        return in_world(field);
    }
    known(robot)
        .unwrap_or(&OF_A_MODEL)
        .iter()
        .map(|&(command, meaning)| (command.to_owned(), meaning))
        .collect()
}

/// For a robot with a model in DCML.
const OF_A_MODEL: [(&str, &str); 4] = [
    (
        "ls motors servos",
        "what drives it, named after the actions?",
    ),
    (
        "cat pose/value",
        "where is it by its model, in metres and radians?",
    ),
    ("grep . pose/params/*", "which numbers has the model?"),
    ("echo > stop", "bring everything to rest"),
];

/// For a robot with a name.
fn known(robot: &str) -> Option<&'static [(&'static str, &'static str)]> {
    Some(match robot {
        "two-wheels" => &[
            ("cat sensors/D1/value", "how far is the wall, in cm?"),
            ("cat heading/value", "where does it look, in degrees?"),
            (
                "echo 30 > motors/M3/value; echo 30 > motors/M4/value",
                "drive, in percent",
            ),
            ("cat encoders/E3/value", "how far has the wheel turned?"),
            ("echo -30 > motors/M3/value", "turn on the spot"),
            ("echo 300 > motors/left/speed", "hold a speed, in deg/s"),
            ("echo > stop", "bring everything to rest"),
        ],
        "line-follower" => &[
            (
                "cat sensors/floor_left/value",
                "how dark is the floor, in percent?",
            ),
            ("cat camera/line/value", "where is the line, -100 to 100?"),
            (
                "echo 30 > motors/M3/value; echo 30 > motors/M4/value",
                "drive, in percent",
            ),
            ("echo 440 500 > sound/tone/value", "play a tone: Hz, ms"),
            ("echo > stop", "bring everything to rest"),
        ],
        "bare" => &[("cat status", "what is there?")],
        _ => return None,
    })
}

/// Commands for what the robot of a world has.
fn in_world(field: &Field) -> Vec<Hint> {
    let robot = field.robot().cloned().unwrap_or_default();
    let mut hints = Vec::new();
    for sensor in &robot.sensors {
        let Some(name) = sensor.port.map(Port::name) else {
            continue;
        };
        let meaning = match (sensor.kind, name.as_bytes().first()) {
            (SensorKind::Infrared, Some(b'A')) | (SensorKind::Sonar, Some(b'D')) => {
                "how far is the wall, in cm?"
            }
            (SensorKind::Light, Some(b'A')) => "how dark is the floor, in percent?",
            (SensorKind::Touch, Some(b'A')) => "is it pressed?",
            _ => continue,
        };
        hints.push((format!("cat sensors/{name}/value"), meaning));
    }
    let wheels: Vec<&str> = [robot.left, robot.right]
        .iter()
        .filter_map(|wheel| wheel.map(Port::name))
        .collect();
    let drive: Vec<String> = wheels
        .iter()
        .map(|wheel| format!("echo 30 > motors/{wheel}/value"))
        .collect();
    if let Some(wheel) = wheels.first() {
        hints.push((drive.join("; "), "drive, in percent"));
        let encoder = wheel.replacen('M', "E", 1);
        hints.push((
            format!("cat encoders/{encoder}/value"),
            "how far has the wheel turned?",
        ));
    }
    hints.push(("echo > stop".to_owned(), "bring everything to rest"));
    hints
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_robot_with_a_name_has_hints_of_its_own() {
        for name in sim::robots::names() {
            assert!(known(name).is_some(), "{name}");
        }
        assert_eq!(known("arm.dcml"), None);
    }

    #[test]
    fn hints_of_a_world_are_of_what_it_has() {
        let mut robot = Box::new(sim::field::Robot::default());
        robot.left = Port::named("M1");
        for (port, kind) in [("A1", SensorKind::Light), ("D2", SensorKind::Sonar)] {
            let port = Port::named(port).unwrap();
            robot.sensors.push(sim::field::Sensor::new(port, kind));
        }
        let mut field = Field::default();
        field.robots.push(*robot);
        let hints = of("two-wheels", Some(&field));
        let commands: Vec<&str> = hints.iter().map(|(command, _)| &**command).collect();
        assert_eq!(
            commands,
            [
                "cat sensors/A1/value",
                "cat sensors/D2/value",
                "echo 30 > motors/M1/value; echo 30 > motors/M3/value",
                "cat encoders/E1/value",
                "echo > stop",
            ]
        );
    }
}
