//! Robot files: the shipped ones are good, mistakes are refused at their line in words that help.

use super::run::{Robot, refused, robot};
use config::description::{Pace, SetupStep};

fn shipped() -> Vec<(String, String)> {
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../config/lua/robots");
    let entries = std::fs::read_dir(folder).unwrap();
    let files = entries.map(|entry| entry.unwrap().path());
    let mut found: Vec<_> = files
        .map(|path| {
            let text = std::fs::read_to_string(&path).unwrap();
            (path.display().to_string(), text)
        })
        .collect();
    found.sort();
    assert!(found.len() >= 2);
    found
}

#[test]
fn every_shipped_robot_has_every_port_and_says_what_everything_is() {
    for (file, text) in shipped() {
        let robot = Robot::new(&text);
        let config = &robot.loaded.config;
        for path in [
            "motors/M1",
            "motors/M4",
            "encoders/E1",
            "encoders/E4",
            "sensors/A1",
            "sensors/A6",
            "sensors/D1",
            "sensors/D3",
            "servos/S1",
            "servos/S6",
            "gyroscope",
            "accelerometer",
            "battery",
            "keys",
            "led/green",
            "led/red",
            "camera/line",
            "camera/object",
            "camera/color",
            "lidar",
            "ir_camera",
            "gamepad/pad1",
            "sound/volume",
            "sound/say",
            "gyroscope/tilt",
            "gyroscope/heading",
            "heading",
            "odometry",
            "display",
            "camera/picture",
        ] {
            robot.node(path);
        }
        for node in config
            .nodes
            .iter()
            .flat_map(|node| std::iter::once(node).chain(&node.attributes))
        {
            assert!(
                !node.about.is_empty(),
                "{file}: {} says nothing about itself",
                node.path
            );
        }
    }
}

#[test]
fn everything_that_moves_has_a_rest_and_inputs_are_sampled_fifty_times_a_second() {
    let robot = robot("");
    for node in &robot.loaded.config.nodes {
        let moves = node.path.starts_with("motors/") || node.path.starts_with("servos/");
        assert_eq!(node.rest.is_some(), moves, "{}", node.path);
        let sampled = node.path.starts_with("encoders/") || node.path.starts_with("sensors/A");
        let at_50_hz = node.pace
            == Pace::Every {
                period_ms: 20,
                always: false,
            };
        assert_eq!(at_50_hz, sampled, "{}", node.path);
    }
}

#[test]
fn a_name_is_a_second_name_of_the_port() {
    let robot = robot("{ port = 'M3', name = 'left' }, { port = 'A1', name = 'front' }");
    let aliases: Vec<_> = robot
        .loaded
        .config
        .aliases
        .iter()
        .map(|a| (a.path.as_str(), a.node.as_str()))
        .collect();
    assert_eq!(
        aliases,
        [
            ("motors/left", "motors/M3"),
            ("sensors/front", "sensors/A1")
        ]
    );
}

#[test]
fn the_periods_of_the_motors_and_the_power_of_the_connectors_are_set_up_once() {
    let robot = robot("{ port = 'M2', type = 'motor350' }, { port = 'ir_camera' }");
    let setup = &robot.loaded.config.setup;
    let sent: Vec<_> = setup
        .iter()
        .filter_map(|action| match &action.step {
            SetupStep::Send { to, bytes, .. } => Some((format!("{to:?}"), bytes.clone())),
            _ => None,
        })
        .collect();
    let of = |register: u32| {
        let word = format!(" register: {register},");
        sent.iter()
            .find(|(to, _)| to.contains(&word))
            .map(|(_, bytes)| bytes.clone())
    };
    assert_eq!(of(0x10), Some(vec![0x00, 0x10]), "4096");
    assert_eq!(of(0x11), Some(vec![0x10, 0x27]), "10000");
    assert_eq!(of(0x13), Some(vec![0x00, 0x10]));
    assert_eq!(
        of(0x800d),
        Some(vec![0x19, 0x81]),
        "4 pictures in a second, chess order"
    );
    assert_eq!(of(0x8000), Some(vec![0x00, 0x30]));
    let shown = format!("{setup:?}");
    for part in [
        "gpio62/value",
        "gpio94/direction",
        "gpio37",
        "/sbin/modprobe",
    ] {
        assert!(shown.contains(part), "{part}");
    }
}

#[test]
fn the_actions_of_a_robot_file_come_first() {
    let robot = Robot::new(
        "local trik = include 'trik.lua'
         setup = { { path = '/sys/own', write = '1' } }
         trikfs = trik.robot {}",
    );
    let first = format!("{:?}", robot.loaded.config.setup[0]);
    assert!(first.contains("/sys/own"), "{first}");
    assert!(robot.loaded.config.setup.len() > 5);
}

/// Entries that are wrong, and the reason.
const MISTAKES: &[(&str, &str)] = &[
    (
        "{ port = 'M1' }, { port = 'M1' }",
        "entry 2 (port 'M1'): the port is used already by entry 1",
    ),
    (
        "{ port = 'A1', type = 'angularServomotor' }",
        "entry 1 (port 'A1'): port A1 takes generic, light, sharpGP2, touch, not angularServomotor, which belongs to servos",
    ),
    (
        "{ port = 'A1', type = 'sharp' }",
        "entry 1 (port 'A1'): port A1 takes generic, light, sharpGP2, touch, not sharp",
    ),
    (
        "{ port = 'M1', type = 5 }",
        "entry 1 (port 'M1'): port M1 takes motor100, motor350, motor95, powerMotor; type must be one of these words",
    ),
    (
        "{ type = 'touch' }",
        "entry 1 (no port): the port is missing, for example port = 'M1'",
    ),
    (
        "{ port = 'M1', speed = 5 }",
        "entry 1 (port 'M1'): unknown option 'speed', there are: encoder, measures, name, polarity, port, speed_max, type",
    ),
    (
        "{ port = 'M1', polarity = 'wrong' }",
        "entry 1 (port 'M1'): polarity must be 'normal' or 'inversed', not 'wrong'",
    ),
    (
        "{ port = 'M1', name = 'M2' }",
        "entry 1 (port 'M1'): the name 'M2' is that of a port",
    ),
    (
        "{ port = 'M1', name = 'a/b' }",
        "entry 1 (port 'M1'): name must be a word of letters, digits, _ and -, not 'a/b'",
    ),
    (
        "{ port = 'M1', name = 'x' }, { port = 'M2', name = 'x' }",
        "entry 2 (port 'M2'): the name 'x' is used twice in motors",
    ),
    (
        "{ port = 'battery', type = 'x' }",
        "entry 1 (port 'battery'): 'battery' is part of the board and has no type",
    ),
    (
        "{ port = 'keys', name = 'x' }",
        "entry 1 (port 'keys'): 'keys' is part of the board and takes no name",
    ),
    (
        "{ port = 'A1', median3 = 1 }",
        "entry 1 (port 'A1'): median3 must be true or false, not 1",
    ),
    (
        "{ port = 'gyroscope', calibration_ms = 0 }",
        "entry 1 (port 'gyroscope'): calibration_ms must be a number from 100 to 60000, not 0",
    ),
    (
        "{ port = 'gyroscope', bias = { 1, 2 } }",
        "entry 1 (port 'gyroscope'): bias must be a list of 3 numbers",
    ),
    (
        "{ port = 'A1', type = 'sharpGP2', points = { {1, 2} } }",
        "entry 1 (port 'A1'): points must be a list of 3 pairs of whole numbers from 0 to 1000000",
    ),
    (
        "{ port = 'A1', type = 'sharpGP2', points = { {1, 2}, {1, 2}, {1, 2} } }",
        "entry 1 (port 'A1'): points must be three points of a falling curve",
    ),
    (
        "{ port = 'M1', measures = { {0, 0}, {50, 9}, {100, 9} } }",
        "entry 1 (port 'M1'): measures must rise from point to point",
    ),
    (
        "{ port = 'lidar', path = 'ttyS1' }",
        "entry 1 (port 'lidar'): path must be a path that begins with a slash, not 'ttyS1'",
    ),
    (
        "{ port = 'M1', encoder = 'M1' }",
        "entry 1 (port 'M1'): encoder must be 'E1', 'E2', 'E3' or 'E4', not 'M1'",
    ),
    (
        "{ port = 'M1', encoder = true }",
        "entry 1 (port 'M1'): encoder must be 'E1', 'E2', 'E3' or 'E4', not true",
    ),
    (
        "{ port = 'M1', encoder = 'E1' }, { port = 'M2', encoder = 'E1' }",
        "entry 2 (port 'M2'): encoder 'E1' measures motor M1 already",
    ),
    (
        "{ port = 'M1', speed_max = 500 }",
        "entry 1 (port 'M1'): speed_max is for a motor with an encoder: name it, for example encoder = 'E1'",
    ),
    (
        "{ port = 'M1', encoder = 'E1', speed_max = 0 }",
        "entry 1 (port 'M1'): speed_max must be a number from 1 to 100000, not 0",
    ),
    (
        "{ port = 'odometry', left = 'E1' }",
        "entry 1 (port 'odometry'): right must be the encoder of the right wheel: 'E1', 'E2', 'E3' or 'E4', not nothing",
    ),
    (
        "{ port = 'odometry', left = 'E1', right = 'E1' }",
        "entry 1 (port 'odometry'): left and right are the same encoder, 'E1'",
    ),
    (
        "{ port = 'odometry', left = 'E1', right = 'E2', track_mm = 155 }",
        "entry 1 (port 'odometry'): wheel_diameter_mm must be a number from 1 to 1000, not nothing",
    ),
    ("'M1'", "entry 1 is not a table but a string"),
    (
        "M1 = {}",
        "trik.robot takes a list of ports: { port = 'M1', ... }, { ... }; 'M1' does not belong there",
    ),
];

#[test]
fn mistakes_in_a_robot_file_are_refused_at_its_line() {
    for (entries, reason) in MISTAKES {
        assert_eq!(
            refused(entries),
            format!("robot.lua:3: {reason}"),
            "{entries}"
        );
    }
    let unknown = refused("{ port = 'M5' }");
    assert!(
        unknown.starts_with(
            "robot.lua:3: entry 1 (port 'M5'): there is no such port; there are M1, M2,"
        ),
        "{unknown}"
    );
}
